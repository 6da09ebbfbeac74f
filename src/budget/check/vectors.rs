//! Vector inputs: one error for each element, or one that all share.

use super::Checker;
use super::draft::{Context, Location};
use super::inputs::{Entry, Piece, element_name, single};
use super::register::Register;
use super::ways::{Way, locates};
use crate::budget::Owner;
use crate::budget::faults::VECTOR;
use crate::budget::table::Stated;
use crate::budget::tables::{ComponentTable, InputTable};
use crate::budget::variants::Amounts;
use crate::fault::Fault;
use crate::quantity::Unit;

/// Elements of a vector. More of them would keep the Monte Carlo method busy for hours.
const MOST_ELEMENTS: usize = 10_000;

impl Checker<'_> {
    pub(super) fn vector(
        &mut self,
        name: &str,
        stated: &Stated<InputTable>,
        unit: &Unit,
        values: &[f64],
        register: &mut Register,
        start: usize,
    ) -> Option<()> {
        let table = &stated.value;
        if let (Some(value), Some(values)) = (&table.value, &table.values) {
            return self.refuse(
                Fault::new(
                    VECTOR,
                    values.key.clone(),
                    format!("{name} has `value` and `values`"),
                )
                .label("values of a vector")
                .related(value.key.clone(), "value of a scalar")
                .help("leave out one"),
            );
        }
        if values.is_empty() {
            let place = table
                .values
                .as_ref()
                .map_or(stated.span.clone(), |values| values.span.clone());
            return self.refuse(
                Fault::new(VECTOR, place, format!("{name} has no values")).label("an empty vector"),
            );
        }
        if values.len() > MOST_ELEMENTS {
            let place = table
                .values
                .as_ref()
                .map_or(stated.span.clone(), |values| values.key.clone());
            return self.refuse(
                Fault::new(VECTOR, place, format!("{name} has {} values", values.len()))
                    .label(format!("expected {MOST_ELEMENTS} at most"))
                    .help("each element is an input of its own; repeated readings of one quantity are `readings`"),
            );
        }
        let list = self.entries_of(name, stated, unit, register)?;
        for (place, value) in (start..).zip(values) {
            if let Some(input) = register.inputs.get_mut(place) {
                input.estimate = *value;
            }
        }
        let alone = list.len() == 1;
        let mut complete = true;
        let mut labels: Vec<String> = Vec::new();
        for entry in &list {
            let done = self.vector_component(
                name,
                entry,
                unit,
                values,
                register,
                start,
                alone,
                &mut labels,
            );
            complete &= done.is_some();
        }
        complete.then_some(())
    }

    #[allow(clippy::too_many_arguments)]
    fn vector_component(
        &mut self,
        name: &str,
        entry: &Entry<'_>,
        unit: &Unit,
        values: &[f64],
        register: &mut Register,
        start: usize,
        alone: bool,
        labels: &mut Vec<String>,
    ) -> Option<()> {
        if entry.way == Way::Source {
            for (place, value) in (start..).zip(values) {
                let context = Context {
                    owner: name,
                    value: Some(*value),
                    unit,
                    place: entry.place.clone(),
                };
                for piece in self.shared_pieces(entry, &context, register)? {
                    if let Piece::Shared {
                        component,
                        coefficient,
                    } = piece
                    {
                        register.act(place, component, coefficient);
                    }
                }
            }
            return Some(());
        }
        if locates(entry.way) && !single(entry.table) && entry.way != Way::Distribution {
            return self.refuse(
                Fault::new(
                    VECTOR,
                    entry.place.clone(),
                    format!("this component would state one estimate for all elements of {name}"),
                )
                .label("not for a vector")
                .help(
                    "state a deviation: `u`, `half_width`, `step`, readings with of = \"single\" …",
                ),
            );
        }
        self.one_for_each(name, entry.table, values.len())?;
        let relative = self.acts_in_proportion(entry, unit);
        let common = entry
            .table
            .common
            .as_ref()
            .is_some_and(|stated| stated.value);
        let mut first: Option<(usize, f64)> = None;
        let mut label = None;
        for (element, value) in values.iter().enumerate() {
            // A fraction of zero is zero: this element has no such doubt.
            if relative && *value == 0.0 {
                continue;
            }
            let context = Context {
                owner: name,
                value: Some(*value),
                unit,
                place: entry.place.clone(),
            };
            let mut draft = match of_element(entry.table, element) {
                Some(table) => self.draft(&table, entry.way, &context)?,
                None => self.draft(entry.table, entry.way, &context)?,
            };
            if !matches!(draft.location, Location::None | Location::Mean(_)) {
                return self.refuse(
                    Fault::new(
                        VECTOR,
                        entry.place.clone(),
                        format!("this component would move the elements of {name}"),
                    )
                    .label("only symmetric deviations for a vector"),
                );
            }
            let label = label.get_or_insert_with(|| another(labels, &draft.label));
            draft.label.clone_from(label);
            let (component, coefficient) = match first {
                Some((component, u)) if common => (component, draft.u / u),
                _ => {
                    let owner_name = if common {
                        name.to_string()
                    } else {
                        element_name(name, element)
                    };
                    let u = draft.u * if relative { value.signum() } else { 1.0 };
                    let component = register.add(
                        Owner::Input(start + element),
                        &owner_name,
                        unit,
                        draft,
                        alone,
                    );
                    first = Some((component, u));
                    register.act(start + element, component, 1.0);
                    continue;
                }
            };
            let sign = if relative { value.signum() } else { 1.0 };
            register.act(start + element, component, sign * coefficient);
        }
        Some(())
    }

    /// Checks that lists for elements are as long as the vector.
    pub(super) fn one_for_each(
        &mut self,
        name: &str,
        table: &ComponentTable,
        length: usize,
    ) -> Option<()> {
        for (key, stated) in [("u", &table.u), ("half_width", &table.half_width)] {
            let Some(Stated {
                value: Amounts::Each(list),
                span,
                ..
            }) = stated
            else {
                continue;
            };
            if list.len() != length {
                return self.refuse(
                    Fault::new(
                        VECTOR,
                        span.clone(),
                        format!(
                            "`{key}` has {} entries, {name} has {length} values",
                            list.len()
                        ),
                    )
                    .label(format!("expected {length} entries"))
                    .help("state one for each element, or a single one for all"),
                );
            }
        }
        Some(())
    }

    /// Whether the component is a fraction of the value alone.
    pub(super) fn acts_in_proportion(&mut self, entry: &Entry<'_>, unit: &Unit) -> bool {
        let table = entry.table;
        let stated = table.relative.as_ref().is_some_and(|stated| stated.value);
        let certificate = table
            .certificate
            .as_ref()
            .and_then(|certificate| certificate.value.U.as_ref());
        let stated_amount = table.u.as_ref().or(table.half_width.as_ref());
        let first = stated_amount.and_then(|amounts| amounts.of_element(0));
        let of_dimension_one = first
            .as_ref()
            .or(certificate)
            .and_then(|amount| amount.value.unit.as_ref())
            .and_then(|(text, _)| self.units.parse(text).ok())
            .is_some_and(|own| own.dimension == Unit::one().dimension);
        stated || (of_dimension_one && unit.dimension != Unit::one().dimension)
    }
}

/// The component as it stands for one element, if it lists an amount for each.
pub(super) fn of_element(table: &ComponentTable, element: usize) -> Option<ComponentTable> {
    let one = |stated: &Option<Stated<Amounts>>| {
        let amount = stated.as_ref()?.of_element(element)?;
        Some(amount.map(|amount| Amounts::One(amount.clone())))
    };
    let listed = |stated: &Option<Stated<Amounts>>| {
        matches!(
            stated,
            Some(Stated {
                value: Amounts::Each(_),
                ..
            })
        )
    };
    (listed(&table.u) || listed(&table.half_width)).then(|| ComponentTable {
        u: one(&table.u),
        half_width: one(&table.half_width),
        ..table.clone()
    })
}

/// A label that no other component of the vector has.
fn another(labels: &mut Vec<String>, label: &str) -> String {
    let same = labels
        .iter()
        .filter(|other| other.starts_with(label))
        .count();
    let label = if same == 0 {
        label.to_string()
    } else {
        format!("{label} {}", same + 1)
    };
    labels.push(label.clone());
    label
}
