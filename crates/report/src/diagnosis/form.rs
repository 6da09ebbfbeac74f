//! A diagnosis and a plan for machines: exact numbers, stable names.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::diagnose::case::Case;
use crate::diagnose::evidence::{Alternative, Slot, State, Verdict};
use crate::diagnose::{
    Adopted, Diagnosis, Estimated, HeldOutQuality, Measure, Omitted, Outlook, Prediction, Promise,
    Prospect, Quality, Separating,
};
use crate::language::Language;
use crate::machine::{self, Machine, Number, numbers, record};

use super::names::Names;
use super::noise::{assumed_noise, noise};
use super::outlook::{pair, statement};
use super::statement::verdict;
use super::words::measure;

/// Numbers by the names of the unknowns.
type ByUnknown<'a> = BTreeMap<&'a str, Number>;

record! {
    /// What a recording shows of a declared model.
    DiagnosisForm<'a> {
        /// Title.
        title: &'a str,
        /// `none`, `identified`, `ambiguous`, `partly`, `contested` or `unexplained`.
        verdict: &'static str,
        /// The verdict in one sentence.
        statement: String,
        /// Equations of the declared model.
        model: &'a [String],
        /// The noise that was used.
        noise: NoiseForm,
        /// Rows of the recording.
        rows: usize,
        /// Rows, or means of rows, of all outputs.
        observations: usize,
        /// Probability of a false alarm that was asked for.
        alpha: Number,
        /// Seed of the random numbers.
        seed: u64,
        /// Tests for a further effect: without any, after the first, …
        levels: Vec<LevelForm>,
        /// Where the mismatch sits, the most conspicuous first; 20 at most.
        located: Vec<LocatedForm<'a>>,
        /// One for each effect found.
        effects: Vec<EffectForm<'a>>,
        /// Share of the excess χ² that the named effects explain.
        explained: Number,
        /// Probability that an effect without a name is there.
        generic_probability: Number,
        /// By how much the named effects are better than an unlisted one: logarithm of a Bayes factor.
        margin: Number,
        /// The declared model.
        before: QualityForm,
        /// The model with the adopted physics.
        after: Option<QualityForm>,
        /// Parameters of the declared model.
        parameters: Vec<EstimateForm<'a>>,
        /// The model with the adopted physics, if any was adopted.
        improved: Option<ImprovedForm<'a>>,
        /// What effects cost that were not adopted and may be there all the same, the dearest first.
        omitted: Vec<OmittedForm<'a>>,
        /// How well the held-out recording is predicted.
        held_out: Option<HeldOutForm<'a>>,
        /// For each effect with several explanations what the choice between them costs each parameter.
        choices: Vec<ByUnknown<'a>>,
        /// Standard uncertainties of the parameters with all that may be there unseen.
        u_with_unseen: ByUnknown<'a>,
        /// Explanations that the recording cannot tell apart, and what would.
        separating: Vec<SeparatingForm>,
    }

    /// The noise that was used.
    NoiseForm {
        /// Where it comes from.
        origin: String,
        /// Degrees of freedom of its scale; 0 where the residuals tell it.
        dof: Number,
    }

    /// The test for a further effect.
    LevelForm {
        /// Effects that are adopted already.
        adopted: Vec<String>,
        /// What explains most of the rest.
        strongest: String,
        /// Probability of as much if nothing is left.
        p: Number,
        /// Simulated recordings behind it.
        draws: usize,
    }

    /// A place of the mismatch.
    LocatedForm<'a> {
        /// Quantity of the model.
        node: &'a str,
        /// What divides the recording.
        factor: &'a str,
        /// Which part.
        level: &'a str,
        /// Size of the disturbance there.
        size: Number,
        /// Its standard uncertainty.
        u: Number,
        /// By how much χ² falls with it.
        delta_chi_squared: Number,
        /// Probability that the strongest place stands out as much by chance.
        p: Number,
    }

    /// An effect that was found.
    EffectForm<'a> {
        /// `identified`, `ambiguous` or `unexplained`.
        state: &'static str,
        /// Its names, most probable first.
        named: Vec<AlternativeForm<'a>>,
        /// Competitors without a name, most probable first.
        unnamed: Vec<AlternativeForm<'a>>,
        /// Probability of the competitors without a name.
        unnamed_share: Number,
        /// The family with the greatest probability.
        family: Option<FamilyForm<'a>>,
    }

    /// A family of effects.
    FamilyForm<'a> {
        /// Its name.
        name: &'a str,
        /// Its probability among the named.
        probability: Number,
    }

    /// A possible explanation of an effect.
    AlternativeForm<'a> {
        /// Identifier of the catalogue.
        id: &'a str,
        /// Name.
        name: String,
        /// Family of the catalogue.
        family: &'a str,
        /// What it is.
        prose: String,
        /// What it adds to the model.
        formula: String,
        /// Quantity of the model that is disturbed.
        node: &'a str,
        /// What the disturbance follows.
        along: &'a str,
        /// Posterior probability.
        probability: Number,
        /// Its variants, most probable first; 5 at most.
        variants: Vec<VariantForm<'a>>,
        /// What each size multiplies.
        terms: Vec<TermForm<'a>>,
        /// Sizes; null where the recording does not determine one.
        size: Vec<Option<Number>>,
        /// Their standard uncertainties.
        u: Vec<Option<Number>>,
        /// Coverage factor of their 95 % intervals.
        coverage_factor: Option<Number>,
        /// Strength over the noise.
        lambda: Number,
        /// The candidate that is hardest to tell from it.
        nearest: Option<RivalForm>,
    }

    /// A variant of an explanation.
    VariantForm<'a> {
        /// Identifier of the catalogue.
        id: &'a str,
        /// What distinguishes it.
        label: &'a str,
        /// Share of the probability.
        share: Number,
    }

    /// What a size multiplies.
    TermForm<'a> {
        /// A formula of columns as numbers in their own units.
        multiplies: &'a str,
        /// Unit of the size.
        unit: String,
    }

    /// A candidate that resembles an explanation.
    RivalForm {
        /// Its name.
        name: String,
        /// Separability.
        kappa: Number,
        /// Whether no recording of this design tells the two apart.
        alias: bool,
        /// Probability that a recording like this one decides.
        resolved: Number,
    }

    /// How well a model describes the recording.
    QualityForm {
        /// χ² with the claimed noise.
        chi_squared: Number,
        /// Its degrees of freedom.
        dof: Number,
        /// Root mean square of the residuals of each output.
        residual_rms: Vec<Number>,
        /// Root mean square of the claimed noise of each output.
        expected_noise: Vec<Number>,
        /// Root mean square of the errors of predictions of left-out rows of each output.
        held_out_rms: Vec<Number>,
    }

    /// A fitted quantity.
    EstimateForm<'a> {
        /// Name.
        name: &'a str,
        /// Unit.
        unit: &'a str,
        /// Value; of a plan there is none.
        #[serde(skip_serializing_if = "Option::is_none")]
        value: Option<Number>,
        /// Standard uncertainty.
        u: Number,
    }

    /// The model with the adopted physics.
    ImprovedForm<'a> {
        /// Its equations.
        model: &'a [String],
        /// Effects in it.
        effects: Vec<String>,
        /// Terms of the effects.
        additions: Vec<AdditionForm<'a>>,
        /// Their sizes.
        coefficients: Vec<EstimateForm<'a>>,
        /// The parameters of the declared model, now.
        parameters: Vec<EstimateForm<'a>>,
        /// χ² that the linear prediction promised.
        promised_chi_squared: Number,
        /// The first size in parts of the recording.
        parts: Vec<PartForm<'a>>,
        /// Probability that the parts differ as much by chance.
        agreement: Option<Number>,
    }

    /// A term of an effect.
    AdditionForm<'a> {
        /// Its size.
        parameter: &'a str,
        /// Column that holds what the size multiplies.
        column: &'a str,
        /// The same as a formula.
        modifier: &'a str,
        /// Unit of it.
        unit_of_modifier: String,
    }

    /// A size in a part of the recording.
    PartForm<'a> {
        /// The part.
        part: &'a str,
        /// The size.
        value: Number,
        /// Its standard uncertainty.
        u: Number,
    }

    /// What an effect costs that is not in the model.
    OmittedForm<'a> {
        /// Name.
        effect: String,
        /// Identifier of the catalogue.
        id: &'a str,
        /// Its variant that costs most.
        variant: &'a str,
        /// Whether the recording cannot show it.
        invisible: bool,
        /// Share of it that the parameters do not absorb.
        visibility: Number,
        /// Largest shift of the output that would not surprise.
        usual_shift: Option<Number>,
        /// Change of each parameter for a largest shift of one.
        gain: ByUnknown<'a>,
        /// Standard uncertainty that it adds to each parameter of the declared model.
        u_declared: ByUnknown<'a>,
        /// The same with the adopted physics in the model.
        u: ByUnknown<'a>,
    }

    /// How well the held-out recording is predicted.
    HeldOutForm<'a> {
        /// Its file.
        file: &'a str,
        /// Its rows, or means of rows.
        observations: usize,
        /// Root mean square of the claimed noise of each output.
        expected_noise: Vec<Number>,
        /// By the declared model.
        before: PredictionForm,
        /// With the adopted physics.
        after: Option<PredictionForm>,
    }

    /// A prediction against what was observed.
    PredictionForm {
        /// Root mean square of the errors of each output.
        rms: Vec<Number>,
        /// Sum of the squares of the errors over their variances.
        chi_squared: Number,
    }

    /// Explanations of one effect that the recording cannot tell apart.
    SeparatingForm {
        /// Place among the effects.
        effect: usize,
        /// Names.
        rivals: Vec<String>,
        /// A number for each; those that share one say the same of every measurement.
        classes: Vec<usize>,
        /// Separability of the two that are most alike.
        kappa: Number,
        /// Further measurements, the most useful first.
        measurements: Vec<WorthForm>,
    }

    /// What a further measurement decides.
    WorthForm {
        /// What is done.
        name: String,
        /// The same for machines.
        measure: MeasureForm,
        /// Effort; one is that of the recording.
        cost: Number,
        /// Separability with it.
        kappa: Number,
        /// Probability that it decides.
        resolved: Number,
        /// How often it has to be done to decide as good as always.
        repeats: Number,
    }

    /// A further measurement.
    MeasureForm {
        /// `own`, `again`, `reversed`, `set`, `between`, `opposite` or `exchanged`.
        kind: &'static str,
        /// Name of a measurement of the user's own.
        #[serde(skip_serializing_if = "Option::is_none")]
        name: Option<String>,
        /// The column that is set otherwise.
        #[serde(skip_serializing_if = "Option::is_none")]
        column: Option<String>,
        /// The value to which it is set.
        #[serde(skip_serializing_if = "Option::is_none")]
        value: Option<Number>,
        /// Its unit.
        #[serde(skip_serializing_if = "Option::is_none")]
        unit: Option<String>,
    }

    /// What an experiment can see and tell apart.
    OutlookForm<'a> {
        /// Title.
        title: &'a str,
        /// The outcome in one sentence.
        statement: String,
        /// Equations of the declared model.
        model: &'a [String],
        /// Rows of the design.
        rows: usize,
        /// Rows, or means of rows, of all outputs.
        observations: usize,
        /// The noise that was assumed.
        noise: AssumedNoiseForm,
        /// Parameters that were taken as one.
        assumed: &'a [String],
        /// Parameters with the standard uncertainties to expect.
        parameters: Vec<EstimateForm<'a>>,
        /// What can be seen of each effect.
        effects: Vec<ProspectForm<'a>>,
        /// Effects that are one in this experiment.
        classes: Vec<Vec<String>>,
        /// What effects cost that may be there and are not in the model, the dearest first.
        omitted: Vec<OmittedForm<'a>>,
        /// Pairs of effects that are hard to tell apart.
        pairs: Vec<String>,
        /// Further measurements, the most useful first.
        measurements: Vec<PromiseForm>,
    }

    /// The noise that was assumed.
    AssumedNoiseForm {
        /// Whether it is claimed; else one row has the standard uncertainty one.
        claimed: bool,
        /// Where it comes from.
        origin: String,
    }

    /// What can be seen of an effect; sizes are the largest shift of the output.
    ProspectForm<'a> {
        /// Identifier of the catalogue.
        id: &'a str,
        /// Name.
        name: String,
        /// The variant that stands for it.
        variant: &'a str,
        /// Share that the parameters do not absorb.
        visibility: Number,
        /// Smallest size that is detected as good as always.
        detectable: Number,
        /// Smallest size that is told from its rival as good as always.
        separable: Option<Number>,
        /// The largest size that would not surprise.
        usual: Option<Number>,
        /// The effect that resembles it most.
        rival: Option<LikenessForm<'a>>,
    }

    /// An effect that resembles another.
    LikenessForm<'a> {
        /// Identifier of the catalogue.
        id: &'a str,
        /// Name.
        name: String,
        /// Cosine of the angle between the two.
        cosine: Number,
    }

    /// What a further measurement gives.
    PromiseForm {
        /// What is done.
        name: String,
        /// The same for machines.
        measure: MeasureForm,
        /// Effort; one is that of the recording.
        cost: Number,
        /// Its rows.
        rows: usize,
        /// Pairs that it tells apart.
        tells_apart: Vec<String>,
        /// Effects that it makes visible.
        makes_visible: Vec<String>,
    }
}

impl Machine for DiagnosisForm<'_> {
    const KIND: &'static str = "diagnosis";
    const VERSION: u32 = 1;
}

impl Machine for OutlookForm<'_> {
    const KIND: &'static str = "outlook";
    const VERSION: u32 = 1;
}

/// JSON Schema of the output of `gumption diagnose --json`.
pub fn diagnosis_schema() -> Value {
    machine::schema::<DiagnosisForm<'_>>("gumption diagnose --json")
}

/// JSON Schema of the output of `gumption plan --json` for a case.
pub fn outlook_schema() -> Value {
    machine::schema::<OutlookForm<'_>>("gumption plan --json")
}

/// Everything that a diagnosis found.
pub(super) fn diagnosis<'a>(case: &'a Case, d: &'a Diagnosis, l: Language) -> DiagnosisForm<'a> {
    /// More places are of no use to anybody.
    const PLACES: usize = 20;
    let names = Names::of_diagnosis(d, l);
    let examination = &d.examination;
    let atom = |atom: usize| names.variant(d.atoms[atom]);
    let levels = examination.levels.iter().map(|level| LevelForm {
        adopted: level.adopted.iter().map(|at| atom(*at)).collect(),
        strongest: atom(level.strongest),
        p: Number(level.p),
        draws: level.draws,
    });
    let located = d
        .located
        .iter()
        .take(PLACES)
        .map(|(cell, located)| LocatedForm {
            node: &cell.node,
            factor: &cell.factor,
            level: &cell.level,
            size: Number(located.size),
            u: Number(located.u),
            delta_chi_squared: Number(located.chi_squared),
            p: Number(located.p),
        });
    DiagnosisForm {
        title: &case.title,
        verdict: match examination.verdict {
            Verdict::None => "none",
            Verdict::Identified => "identified",
            Verdict::Ambiguous => "ambiguous",
            Verdict::Partly => "partly",
            Verdict::Contested => "contested",
            Verdict::Unexplained => "unexplained",
        },
        statement: verdict(d, l),
        model: &case.model,
        noise: NoiseForm {
            origin: noise(&d.noise, l),
            dof: Number(d.noise.dof),
        },
        rows: case.rows,
        observations: d.residuals.len(),
        alpha: Number(case.settings.alpha),
        seed: case.settings.seed,
        levels: levels.collect(),
        located: located.collect(),
        effects: examination
            .slots
            .iter()
            .map(|slot| effect(case, d, slot, names))
            .collect(),
        explained: Number(examination.explained),
        generic_probability: Number(examination.generic_probability),
        margin: Number(examination.margin),
        before: quality(&d.before),
        after: d.adopted.as_ref().map(|adopted| quality(&adopted.quality)),
        parameters: estimates(&d.unknowns),
        improved: d.adopted.as_ref().map(|adopted| improved(adopted, &atom)),
        omitted: omitted(&d.omitted, &d.unknowns, names),
        held_out: d.held_out.as_ref().map(held_out),
        choices: d
            .choices
            .iter()
            .map(|u| by_unknown(&d.unknowns, u))
            .collect(),
        u_with_unseen: by_unknown(&d.unknowns, &d.u_with_unseen()),
        separating: d
            .separating
            .iter()
            .map(|of| separating(of, names))
            .collect(),
    }
}

fn effect<'a>(case: &Case, d: &'a Diagnosis, slot: &'a Slot, names: Names<'a>) -> EffectForm<'a> {
    let all = |list: &'a [Alternative]| {
        list.iter()
            .map(|one| alternative(case, d, one, names))
            .collect()
    };
    EffectForm {
        state: match slot.state {
            State::Identified => "identified",
            State::Ambiguous => "ambiguous",
            State::Unexplained => "unexplained",
        },
        named: all(&slot.named),
        unnamed: all(&slot.generic),
        unnamed_share: Number(slot.generic_share),
        family: slot.family.as_ref().map(|(name, p)| FamilyForm {
            name,
            probability: Number(*p),
        }),
    }
}

fn alternative<'a>(
    case: &Case,
    d: &'a Diagnosis,
    one: &'a Alternative,
    names: Names<'a>,
) -> AlternativeForm<'a> {
    /// Less probable variants are of no use to anybody.
    const VARIANTS: usize = 5;
    let cell = names.cell(one.candidate);
    let variants = one.variants.iter().take(VARIANTS).map(|variant| {
        let (cell, variation) = d.atoms[variant.atom];
        let cell = names.cell(cell);
        let label = &cell.variants[variation].label;
        VariantForm {
            id: &cell.effect.id,
            label,
            share: Number(variant.share),
        }
    });
    let terms = d.terms(one).into_iter().map(|term| TermForm {
        multiplies: &term.written().text,
        unit: term.unit_of_size(case).typeset(),
    });
    AlternativeForm {
        id: &cell.effect.id,
        name: names.plain(one.candidate),
        family: &cell.effect.family,
        prose: names.prose(one.candidate),
        formula: Names::of_diagnosis(d, Language::English).formula(d, one),
        node: &cell.place.node,
        along: &cell.place.along,
        probability: Number(one.probability),
        variants: variants.collect(),
        terms: terms.collect(),
        size: one.estimate.iter().copied().map(finite).collect(),
        u: one.u().iter().copied().map(finite).collect(),
        coverage_factor: finite(one.coverage_factor()),
        lambda: Number(one.lambda),
        nearest: one.nearest.as_ref().map(|rival| RivalForm {
            name: names.plain(rival.candidate),
            kappa: Number(rival.kappa),
            alias: rival.alias,
            resolved: Number(rival.resolved),
        }),
    }
}

/// A number, where there is one.
fn finite(x: f64) -> Option<Number> {
    x.is_finite().then_some(Number(x))
}

fn quality(quality: &Quality) -> QualityForm {
    QualityForm {
        chi_squared: Number(quality.chi_squared),
        dof: Number(quality.dof),
        residual_rms: numbers(&quality.residual),
        expected_noise: numbers(&quality.expected),
        held_out_rms: numbers(&quality.held_out),
    }
}

fn estimates(list: &[Estimated]) -> Vec<EstimateForm<'_>> {
    let of = list.iter().map(|one| EstimateForm {
        name: &one.name,
        unit: &one.unit,
        value: Some(Number(one.value)),
        u: Number(one.u),
    });
    of.collect()
}

fn improved<'a>(adopted: &'a Adopted, name: &dyn Fn(usize) -> String) -> ImprovedForm<'a> {
    let additions = adopted
        .extended
        .additions
        .iter()
        .map(|addition| AdditionForm {
            parameter: &addition.parameter,
            column: &addition.column,
            modifier: &addition.text,
            unit_of_modifier: addition.unit.typeset(),
        });
    let confirmation = &adopted.confirmation;
    let parts = confirmation.parts.iter().map(|(part, value, u)| PartForm {
        part,
        value: Number(*value),
        u: Number(*u),
    });
    ImprovedForm {
        model: &adopted.extended.case.model,
        effects: adopted.atoms.iter().map(|atom| name(*atom)).collect(),
        additions: additions.collect(),
        coefficients: estimates(&adopted.coefficients),
        parameters: estimates(&adopted.unknowns),
        promised_chi_squared: Number(confirmation.promised),
        parts: parts.collect(),
        agreement: confirmation.agreement.map(Number),
    }
}

fn omitted<'a>(
    lines: &'a [Omitted],
    unknowns: &'a [Estimated],
    names: Names<'a>,
) -> Vec<OmittedForm<'a>> {
    let of = lines.iter().map(|line| {
        let cell = names.cell(line.cell);
        OmittedForm {
            effect: names.full(line.cell),
            id: &cell.effect.id,
            variant: &cell.variants[line.variation].label,
            invisible: line.is_invisible(),
            visibility: Number(line.visibility),
            usual_shift: line.shift.map(Number),
            gain: by_unknown(unknowns, &line.after.gain),
            u_declared: by_unknown(unknowns, &line.before.u),
            u: by_unknown(unknowns, &line.after.u),
        }
    });
    of.collect()
}

fn by_unknown<'a>(unknowns: &'a [Estimated], values: &[f64]) -> ByUnknown<'a> {
    let pairs = unknowns.iter().zip(values);
    pairs
        .map(|(unknown, value)| (unknown.name.as_str(), Number(*value)))
        .collect()
}

fn held_out(held: &HeldOutQuality) -> HeldOutForm<'_> {
    let prediction = |p: &Prediction| PredictionForm {
        rms: numbers(&p.rms),
        chi_squared: Number(p.chi_squared),
    };
    HeldOutForm {
        file: &held.file,
        observations: held.observations,
        expected_noise: numbers(&held.expected),
        before: prediction(&held.before),
        after: held.after.as_ref().map(prediction),
    }
}

fn separating(of: &Separating, names: Names<'_>) -> SeparatingForm {
    let measurements = of.extras.iter().map(|(extra, worth)| WorthForm {
        name: measure(&extra.measure, names.l),
        measure: measure_form(&extra.measure),
        cost: Number(extra.cost),
        kappa: Number(worth.kappa),
        resolved: Number(worth.resolved),
        repeats: Number(worth.repeats),
    });
    SeparatingForm {
        effect: of.slot,
        rivals: of.rivals.iter().map(|cell| names.plain(*cell)).collect(),
        classes: of.classes.clone(),
        kappa: Number(of.kappa),
        measurements: measurements.collect(),
    }
}

/// What is done, for machines.
fn measure_form(measure: &Measure) -> MeasureForm {
    let (kind, name, column) = match measure {
        Measure::Own(name) => ("own", Some(name), None),
        Measure::Again => ("again", None, None),
        Measure::Reversed => ("reversed", None, None),
        Measure::Set { column, .. } => ("set", None, Some(column)),
        Measure::Between { column } => ("between", None, Some(column)),
        Measure::Opposite { column } => ("opposite", None, Some(column)),
        Measure::Exchanged { column } => ("exchanged", None, Some(column)),
    };
    let (value, unit) = match measure {
        Measure::Set { value, unit, .. } => (Some(Number(*value)), Some(unit.clone())),
        _ => (None, None),
    };
    MeasureForm {
        kind,
        name: name.cloned(),
        column: column.cloned(),
        value,
        unit,
    }
}

/// Everything that a plan found.
pub(super) fn outlook<'a>(case: &'a Case, o: &'a Outlook, l: Language) -> OutlookForm<'a> {
    let names = Names::of_outlook(o, l);
    let full = |cells: &[usize]| cells.iter().map(|cell| names.full(*cell)).collect();
    let pairs = |pairs: &[usize]| pairs.iter().map(|at| pair(o, *at, names)).collect();
    let prospect = |p: &'a Prospect| ProspectForm {
        id: &names.cell(p.cell).effect.id,
        name: names.plain(p.cell),
        variant: &names.cell(p.cell).variants[p.variation].label,
        visibility: Number(p.visibility),
        detectable: Number(p.detectable),
        separable: p.separable.map(Number),
        usual: p.typical.map(Number),
        rival: p.rival.map(|(rival, cosine)| LikenessForm {
            id: &names.cell(rival).effect.id,
            name: names.plain(rival),
            cosine: Number(cosine),
        }),
    };
    let promise = |promise: &Promise| PromiseForm {
        name: measure(&promise.extra.measure, l),
        measure: measure_form(&promise.extra.measure),
        cost: Number(promise.extra.cost),
        rows: promise.extra.rows.count,
        tells_apart: pairs(&promise.resolved),
        makes_visible: full(&promise.revealed),
    };
    let unnumbered = |one| EstimateForm { value: None, ..one };
    OutlookForm {
        title: &case.title,
        statement: statement(o, l),
        model: &case.model,
        rows: case.rows,
        observations: o.observations,
        noise: AssumedNoiseForm {
            claimed: !o.relative,
            origin: assumed_noise(case, &o.noise, l),
        },
        assumed: &o.assumed,
        parameters: estimates(&o.unknowns).into_iter().map(unnumbered).collect(),
        effects: o.effects.iter().map(prospect).collect(),
        classes: o.classes.iter().map(|class| full(class)).collect(),
        omitted: omitted(&o.omitted, &o.unknowns, names),
        pairs: pairs(&(0..o.pairs.len()).collect::<Vec<_>>()),
        measurements: o.extras.iter().map(promise).collect(),
    }
}
