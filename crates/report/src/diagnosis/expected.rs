//! A plan of an experiment for machines: exact numbers, stable names.

use serde_json::Value;

use crate::language::Language;
use gumption_format::machine::{self, Machine, Number, all, form};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::{Claimed, Outlook, Promise, Prospect};

use super::names::Names;
use super::noise::assumed_noise;
use super::outlook::{pair, statement};
use super::parts::{EstimateForm, MeasureForm, OmittedForm};
use super::words::measure;

form! {
    /// What an experiment can see and tell apart.
    OutlookForm<'a> of (case: &'a Case, o: &'a Outlook, names: Names<'a>) {
        /// Title.
        title: &'a str = &case.title,
        /// The outcome in one sentence.
        statement: String = statement(o, names.l),
        /// Equations of the declared model.
        model: &'a [String] = &case.model,
        /// Rows of the design.
        rows: usize = case.rows,
        /// Rows, or means of rows, of all outputs.
        observations: usize = o.observations,
        /// The noise that was assumed.
        noise: AssumedNoiseForm = AssumedNoiseForm::of(case, &o.noise, !o.relative, names.l),
        /// Parameters that were taken as one.
        assumed: &'a [String] = &o.assumed,
        /// Parameters with the standard uncertainties to expect.
        parameters: Vec<EstimateForm<'a>> = all(&o.unknowns, |one| EstimateForm::of(one).without_value()),
        /// What can be seen of each effect.
        effects: Vec<ProspectForm<'a>> = all(&o.effects, |one| ProspectForm::of(one, names)),
        /// Effects that are one in this experiment.
        classes: Vec<Vec<String>> = all(&o.classes, |class| all(class, |cell| names.full(*cell))),
        /// What effects cost that may be there and are not in the model, the dearest first.
        omitted: Vec<OmittedForm<'a>> = all(&o.omitted, |line| OmittedForm::of(line, &o.unknowns, names)),
        /// Pairs of effects that are hard to tell apart.
        pairs: Vec<String> = (0..o.pairs.len()).map(|at| pair(o, at, names)).collect(),
        /// Further measurements, the most useful first.
        measurements: Vec<PromiseForm> = all(&o.extras, |one| PromiseForm::of(one, o, names)),
    }

    /// The noise that was assumed.
    AssumedNoiseForm of (case: &Case, noise: &Claimed, known: bool, l: Language) {
        /// Whether it is claimed; else one row has the standard uncertainty one.
        claimed: bool = known,
        /// Where it comes from.
        origin: String = assumed_noise(case, noise, l),
    }

    /// What can be seen of an effect; sizes are the largest shift of the output.
    ProspectForm<'a> of (p: &'a Prospect, names: Names<'a>) {
        /// Identifier of the catalogue.
        id: &'a str = names.cell(p.cell).effect.id.as_str(),
        /// Name.
        name: String = names.plain(p.cell),
        /// The variant that stands for it.
        variant: &'a str = names.label((p.cell, p.variation)),
        /// Share that the parameters do not absorb.
        visibility: Number = Number(p.visibility),
        /// Smallest size that is detected as good as always.
        detectable: Number = Number(p.detectable),
        /// Smallest size that is told from its rival as good as always.
        separable: Option<Number> = p.separable.map(Number),
        /// The largest size that would not surprise.
        usual: Option<Number> = p.typical.map(Number),
        /// The effect that resembles it most.
        rival: Option<LikenessForm<'a>> = p.rival.map(|(cell, cosine)| LikenessForm::of(cell, cosine, names)),
    }

    /// An effect that resembles another.
    LikenessForm<'a> of (cell: usize, cosine_of_angle: f64, names: Names<'a>) {
        /// Identifier of the catalogue.
        id: &'a str = names.cell(cell).effect.id.as_str(),
        /// Name.
        name: String = names.plain(cell),
        /// Cosine of the angle between the two.
        cosine: Number = Number(cosine_of_angle),
    }

    /// What a further measurement gives.
    PromiseForm of (promise: &Promise, o: &Outlook, names: Names<'_>) {
        /// What is done.
        name: String = measure(&promise.extra.measure, names.l),
        /// The same for machines.
        measure: MeasureForm = MeasureForm::of(&promise.extra.measure),
        /// Effort; one is that of the recording.
        cost: Number = Number(promise.extra.cost),
        /// Its rows.
        rows: usize = promise.extra.rows.count,
        /// Pairs that it tells apart.
        tells_apart: Vec<String> = all(&promise.resolved, |at| pair(o, *at, names)),
        /// Effects that it makes visible.
        makes_visible: Vec<String> = all(&promise.revealed, |cell| names.full(*cell)),
    }
}

impl Machine for OutlookForm<'_> {
    const KIND: &'static str = "outlook";
    const VERSION: u32 = 1;
}

/// JSON Schema of the output of `gumption plan --json` for a case.
pub fn outlook_schema() -> Value {
    machine::schema::<OutlookForm<'_>>("gumption plan --json")
}
