//! What machine forms of diagnoses and of plans have in common.

use std::collections::BTreeMap;

use gumption_format::machine::{Number, form};
use gumption_lab::diagnose::{Estimated, Measure, Omitted};

use super::names::Names;

/// Numbers by the names of the unknowns.
pub(super) type ByUnknown<'a> = BTreeMap<&'a str, Number>;

pub(super) fn by_unknown<'a>(unknowns: &'a [Estimated], values: &[f64]) -> ByUnknown<'a> {
    let pairs = unknowns.iter().zip(values);
    let pairs = pairs.map(|(unknown, value)| (unknown.name.as_str(), Number(*value)));
    pairs.collect()
}

form! {
    /// A fitted quantity.
    EstimateForm<'a> of (one: &'a Estimated) {
        /// Name.
        name: &'a str = &one.name,
        /// Unit.
        unit: &'a str = &one.unit,
        /// Value; of a plan there is none.
        #[serde(skip_serializing_if = "Option::is_none")]
        value: Option<Number> = Some(Number(one.value)),
        /// Standard uncertainty.
        u: Number = Number(one.u),
    }

    /// What an effect costs that is not in the model.
    OmittedForm<'a> of (line: &'a Omitted, unknowns: &'a [Estimated], names: Names<'a>) {
        /// Name.
        effect: String = names.full(line.cell),
        /// Identifier of the catalogue.
        id: &'a str = names.cell(line.cell).effect.id.as_str(),
        /// Its variant that costs most.
        variant: &'a str = names.label((line.cell, line.variation)),
        /// Whether the recording cannot show it.
        invisible: bool = line.is_invisible(),
        /// Share of it that the parameters do not absorb.
        visibility: Number = Number(line.visibility),
        /// Largest shift of the output that would not surprise.
        usual_shift: Option<Number> = line.shift.map(Number),
        /// Change of each parameter for a largest shift of one.
        gain: ByUnknown<'a> = by_unknown(unknowns, &line.after.gain),
        /// Standard uncertainty that it adds to each parameter of the declared model.
        u_declared: ByUnknown<'a> = by_unknown(unknowns, &line.before.u),
        /// The same with the adopted physics in the model.
        u: ByUnknown<'a> = by_unknown(unknowns, &line.after.u),
    }

    /// A further measurement.
    MeasureForm of (measure: &Measure) {
        /// `own`, `again`, `reversed`, `set`, `between`, `opposite` or `exchanged`.
        kind: &'static str = match measure {
            Measure::Own(_) => "own",
            Measure::Again => "again",
            Measure::Reversed => "reversed",
            Measure::Set { .. } => "set",
            Measure::Between(_) => "between",
            Measure::Opposite(_) => "opposite",
            Measure::Exchanged(_) => "exchanged",
        },
        /// Name of a measurement of the user's own.
        #[serde(skip_serializing_if = "Option::is_none")]
        name: Option<String> = match measure {
            Measure::Own(name) => Some(name.clone()),
            _ => None,
        },
        /// The column that is set otherwise.
        #[serde(skip_serializing_if = "Option::is_none")]
        column: Option<String> = match measure {
            Measure::Set { column, .. }
            | Measure::Between(column)
            | Measure::Opposite(column)
            | Measure::Exchanged(column) => Some(column.clone()),
            Measure::Own(_) | Measure::Again | Measure::Reversed => None,
        },
        /// The value to which it is set.
        #[serde(skip_serializing_if = "Option::is_none")]
        value: Option<Number> = match measure {
            Measure::Set { value, .. } => Some(Number(*value)),
            _ => None,
        },
        /// Its unit.
        #[serde(skip_serializing_if = "Option::is_none")]
        unit: Option<String> = match measure {
            Measure::Set { unit, .. } => Some(unit.clone()),
            _ => None,
        },
    }
}

impl EstimateForm<'_> {
    /// Of a plan, which knows no value.
    pub(super) fn without_value(self) -> Self {
        EstimateForm {
            value: None,
            ..self
        }
    }
}
