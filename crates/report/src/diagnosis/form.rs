//! A diagnosis for machines: exact numbers, stable names.

use serde_json::Value;

use crate::language::Language;
use gumption_format::machine::{self, Machine, Number, all, form, numbers};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::catalogue::Term;
use gumption_lab::diagnose::evidence::{
    self, Against, Alternative, Beside, Instead, Level, Located, Rival, Slot, State, Variant,
    Verdict, Worth,
};
use gumption_lab::diagnose::{
    Account, Addition, Adopted, ByLabel, Claimed, Diagnosis, Extra, Growth, HeldOutQuality,
    IfIndependent, Listed, ModelVersion, Prediction, Quality, Quantity, Separating, Shape,
    Standing, Trouble, Unsettled,
};

use super::accounts::nowhere;
use super::labels::spoken;
use super::names::Names;
use super::noise::{noise, unclaimed_steps};
use super::parts::{ByUnknown, EstimateForm, MeasureForm, OmittedForm, by_unknown};
use super::statement::statement;
use super::words::{measure, unsettled};

/// More places are of no use to anybody.
const PLACES: usize = 20;
/// Less probable variants are of no use to anybody.
const VARIANTS: usize = 5;

form! {
    /// What a recording shows of a declared model.
    DiagnosisForm<'a> of (case: &'a Case, d: &'a Diagnosis, names: Names<'a>) {
        /// Title.
        title: &'a str = &case.title,
        /// `none`, `identified`, `acts-like`, `ambiguous`, `partly` or `unexplained`.
        verdict: &'static str = match d.examination.verdict {
            Verdict::None => "none",
            Verdict::Identified => "identified",
            Verdict::Like => "acts-like",
            Verdict::Ambiguous => "ambiguous",
            Verdict::Partly => "partly",
            Verdict::Unexplained => "unexplained",
        },
        /// The verdict in a sentence, with what else it may be where noise that wanders stands in it.
        statement: String = statement(d, names.l),
        /// Equations of the declared model.
        model: &'a [String] = &case.model,
        /// The noise that was used.
        noise: NoiseForm<'a> = NoiseForm::of(case, &d.noise, names.l),
        /// Rows of the recording.
        rows: usize = case.rows,
        /// Rows, or means of rows, of all outputs.
        observations: usize = d.fit.residuals.len(),
        /// Probability of a false alarm that was asked for.
        alpha: Number = Number(case.settings.alpha),
        /// Seed of the random numbers.
        seed: u64 = case.settings.seed,
        /// Tests for a further effect: without any, after the first, …
        levels: Vec<LevelForm> = all(&d.examination.levels, |one| LevelForm::of(one, d, names)),
        /// Where the mismatch sits, the most conspicuous first; 20 at most.
        located: Vec<LocatedForm<'a>> = d.located.iter().take(PLACES).map(LocatedForm::of).collect(),
        /// One for each effect found.
        effects: Vec<EffectForm<'a>> = all(&d.examination.slots, |one| EffectForm::of(one, case, d, names)),
        /// What is found in place of noise that wanders if successive rows are independent; null where that is no matter, or out of the question.
        if_independent: Option<IfIndependentForm<'a>> = d.if_independent.as_ref().map(|found| IfIndependentForm::of(found, case, d, names)),
        /// Fits on which a reader should not rely.
        unsettled_fits: Vec<UnsettledForm> = all(&d.unsettled, |one| UnsettledForm::of(one, case, names.l)),
        /// Probability that an effect without a name is there.
        generic_probability: Number = Number(d.examination.generic_probability),
        /// The declared model.
        before: QualityForm = QualityForm::of(&d.before),
        /// The model with the adopted physics.
        after: Option<QualityForm> = d.adopted.as_ref().map(|adopted| QualityForm::of(&adopted.quality)),
        /// Parameters of the declared model.
        parameters: Vec<EstimateForm<'a>> = all(&d.unknowns, EstimateForm::of),
        /// The model with the adopted physics, if any was adopted.
        improved: Option<ImprovedForm<'a>> = d.adopted.as_ref().map(|adopted| ImprovedForm::of(adopted, d, names)),
        /// What effects cost that were not adopted and may be there all the same, the dearest first.
        omitted: Vec<OmittedForm<'a>> = all(&d.omitted, |line| OmittedForm::of(line, &d.unknowns, names)),
        /// How well the held-out recording is predicted.
        held_out: Option<HeldOutForm<'a>> = d.held_out.as_ref().map(|held| HeldOutForm::of(held, names)),
        /// For each effect with several explanations what the choice between them costs each parameter.
        choices: Vec<ByUnknown<'a>> = all(&d.choices, |u| by_unknown(&d.unknowns, u)),
        /// Standard uncertainties of the parameters with all that may be there unseen.
        u_with_unseen: ByUnknown<'a> = by_unknown(&d.unknowns, &d.u_with_unseen()),
        /// Explanations that the recording cannot tell apart, and what would.
        separating: Vec<SeparatingForm> = all(&d.separating, |one| SeparatingForm::of(one, names)),
        /// What speaks against effects that were asked about; none where none were.
        accounts: Vec<AccountForm<'a>> = all(&d.accounts, |one| AccountForm::of(one, case, d, names)),
    }

    /// Why an effect is not the answer.
    AccountForm<'a> of (account: &'a Account, case: &'a Case, d: &'a Diagnosis, names: Names<'a>) {
        /// Identifier of the catalogue; of a column that nothing follows its name.
        id: &'a str = match account {
            Account::NothingAlong(column) => column,
            Account::LeftOut(id) | Account::NothingToActOn(id) | Account::OfNoise(id) => id.as_str(),
            Account::Impossible(cell) => names.cell(*cell).effect.id.as_str(),
            Account::Considered(against) => names.cell(against.candidate).effect.id.as_str(),
        },
        /// Name.
        name: String = match account {
            Account::NothingAlong(column) => column.clone(),
            Account::LeftOut(id) | Account::NothingToActOn(id) | Account::OfNoise(id) => nowhere(*id, names.l),
            Account::Impossible(cell) => names.full(*cell),
            Account::Considered(against) => names.full(against.candidate),
        },
        /// `named`, `tentative`, `absorbed`, `excluded`, `less-likely`, `not-seen`, `impossible`, `of-noise`, `left-out` or `nothing-to-act-on`.
        standing: &'static str = match account {
            Account::LeftOut(_) => "left-out",
            Account::NothingToActOn(_) | Account::NothingAlong(_) => "nothing-to-act-on",
            Account::OfNoise(_) => "of-noise",
            Account::Impossible(_) => "impossible",
            Account::Considered(against) => match d.standing(against) {
                Standing::Named(_) => "named",
                Standing::Tentative(_) => "tentative",
                Standing::Absorbed => "absorbed",
                Standing::Excluded => "excluded",
                Standing::LessLikely => "less-likely",
                Standing::NotSeen => "not-seen",
            },
        },
        /// It in the place of an effect of the answer, or of what has no name.
        instead: Option<InsteadForm<'a>> = {
            let instead = considered(account).and_then(|against| against.instead.as_ref());
            instead.map(|instead| InsteadForm::of(instead, case, d, names))
        },
        /// It beside the answer.
        beside: Option<BesideForm<'a>> = {
            let beside = considered(account).and_then(|against| against.beside.as_ref());
            beside.map(|beside| BesideForm::of(beside, case, d, names))
        },
    }

    /// An effect in the place of another.
    InsteadForm<'a> of (instead: &'a Instead, case: &'a Case, d: &'a Diagnosis, names: Names<'a>) {
        /// The effect that gives way; null for something without a name.
        of: Option<String> = instead.of.map(|of| names.plain(of)),
        /// Sizes and strength, with the probability that the answer leaves it.
        effect: AlternativeForm<'a> = AlternativeForm::of(&instead.own, case, d, names),
        /// χ² of what is left.
        chi_squared: Number = Number(instead.chi_squared),
        /// Its degrees of freedom.
        dof: usize = instead.dof,
        /// By what the claimed noise would have to be multiplied for it not to be excluded; null where it is not, or nothing is claimed.
        noise_factor: Option<Number> = instead.noise.map(Number),
        /// What explains most of what is left.
        strongest: Option<String> = instead.strongest.map(|atom| names.variant(d.atoms[atom])),
        /// Probability of as much by chance.
        p: Number = Number(instead.p),
        /// Simulated recordings behind it.
        draws: usize = instead.draws,
    }

    /// An effect beside the answer.
    BesideForm<'a> of (beside: &'a Beside, case: &'a Case, d: &'a Diagnosis, names: Names<'a>) {
        /// Sizes and strength, with the probability against none.
        effect: AlternativeForm<'a> = AlternativeForm::of(&beside.own, case, d, names),
        /// The size from which on it is detected mostly, for an effect with one size.
        detectable: Option<Number> = beside.detectable.map(Number),
    }

    /// The noise that was used.
    NoiseForm<'a> of (case: &'a Case, claimed: &'a Claimed, l: Language) {
        /// Where it comes from.
        origin: String = noise(case, claimed, l),
        /// Degrees of freedom of its scale; 0 where the residuals tell it.
        dof: Number = Number(claimed.dof),
        /// For each output how it grows with the reading; none where it does not.
        growth: Vec<Option<GrowthForm<'a>>> = all(&claimed.growth, |one| one.as_ref().map(GrowthForm::of)),
        /// For each output how it differs from label to label; none where it does not.
        by_label: Vec<Option<ByLabelForm<'a>>> = all(&claimed.by_label, |one| one.as_ref().map(ByLabelForm::of)),
        /// For each output the step of its readings, where their rounding is beside what is claimed, or a part of what is estimated; none where it is not.
        steps: Vec<Option<Number>> = all(unclaimed_steps(claimed), |step| step.map(Number)),
        /// Degrees of freedom of Student's distribution where its tails are heavier than normal ones beyond doubt; else null.
        tails_dof: Option<Number> = claimed.tails.heavy.map(Number),
        /// The row that is farthest off, where tails are heavy.
        farthest: Option<String> = claimed.farthest.as_deref().map(|row| spoken(row, l)),
    }

    /// Noise that grows with the reading y: u² = a² + (b·y)².
    GrowthForm<'a> of (growth: &'a Growth) {
        /// What y is: "reading", or "signal", the reading without the constant terms of the model, or "applied", without what that gives where nothing is applied.
        with: &'static str = match growth.with {
            Quantity::Reading => "reading",
            Quantity::Signal => "signal",
            Quantity::Applied => "applied",
        },
        /// a.
        constant: Number = Number(growth.constant),
        /// b.
        proportional: Number = Number(growth.proportional),
        /// The unit of a.
        unit: &'a str = &growth.unit,
    }

    /// Noise that differs from label to label.
    ByLabelForm<'a> of (by: &'a ByLabel) {
        /// The column of the labels.
        column: &'a str = &by.column,
        /// Standard uncertainty of one row, as the mean over the rows; where it grows too, at the root mean square of the modelled values.
        mean: Number = Number(by.mean),
        /// Its unit.
        unit: &'a str = &by.unit,
        /// The labels.
        labels: Vec<FactorForm<'a>> = all(&by.factors, FactorForm::of),
    }

    /// The noise of one label.
    FactorForm<'a> of (one: &'a (String, f64)) {
        /// The label.
        label: &'a str = &one.0,
        /// Its standard uncertainty over the mean.
        factor: Number = Number(one.1),
    }

    /// The test for a further effect.
    LevelForm of (level: &Level, d: &Diagnosis, names: Names<'_>) {
        /// Effects that are adopted already.
        adopted: Vec<String> = all(&level.adopted, |atom| names.variant(d.atoms[*atom])),
        /// What explains most of the rest.
        strongest: String = names.variant(d.atoms[level.strongest]),
        /// Probability of as much if nothing is left.
        p: Number = Number(level.p),
        /// Simulated recordings behind it.
        draws: usize = level.draws,
    }

    /// A place of the mismatch.
    LocatedForm<'a> of (place: &'a (evidence::Cell, Located)) {
        /// Quantity of the model.
        node: &'a str = &place.0.node,
        /// What divides the recording.
        factor: String = place.0.factor.to_string(),
        /// Which part.
        level: String = place.0.level.to_string(),
        /// Size of the disturbance there.
        size: Number = Number(place.1.size),
        /// Its standard uncertainty.
        u: Number = Number(place.1.u),
        /// By how much χ² falls with it.
        delta_chi_squared: Number = Number(place.1.chi_squared),
        /// Probability that the strongest place stands out as much by chance.
        p: Number = Number(place.1.p),
    }

    /// An effect that was found.
    EffectForm<'a> of (slot: &'a Slot, case: &'a Case, d: &'a Diagnosis, names: Names<'a>) {
        /// `identified`, `acts-like`, `ambiguous` or `unexplained`.
        state: &'static str = match slot.state {
            State::Identified => "identified",
            State::Like => "acts-like",
            State::Ambiguous => "ambiguous",
            State::Unexplained => "unexplained",
        },
        /// Its names, most probable first.
        named: Vec<AlternativeForm<'a>> = all(&slot.named, |one| AlternativeForm::of(one, case, d, names)),
        /// Competitors without a name, most probable first.
        unnamed: Vec<AlternativeForm<'a>> = all(&slot.generic, |one| AlternativeForm::of(one, case, d, names)),
        /// Probability of the competitors without a name.
        unnamed_share: Number = Number(slot.generic_share),
        /// The family with the greatest probability.
        family: Option<FamilyForm<'a>> = slot.family.as_ref().map(FamilyForm::of),
    }

    /// What is found in place of noise that wanders if successive rows are independent.
    IfIndependentForm<'a> of (found: &'a IfIndependent, case: &'a Case, d: &'a Diagnosis, names: Names<'a>) {
        /// How many times as likely its likeliest explanation is as all noise that remembers.
        odds: Number = Number(found.odds),
        /// One for each effect found.
        effects: Vec<EffectForm<'a>> = all(&found.examination.slots, |one| EffectForm::of(one, case, d, names)),
    }

    /// A fit on which a reader should not rely.
    UnsettledForm of (found: &Unsettled, case: &Case, l: Language) {
        /// `declared` or `improved`.
        model: &'static str = match found.model {
            ModelVersion::Declared => "declared",
            ModelVersion::Improved => "improved",
        },
        /// `no_minimum` where the search ended elsewhere, `no_fit` where there was none.
        trouble: &'static str = match found.trouble {
            Trouble::NoMinimum { .. } => "no_minimum",
            Trouble::NoFit(_) => "no_fit",
        },
        /// Steps of the search that ended.
        steps: Option<usize> = match found.trouble {
            Trouble::NoMinimum { steps } => Some(steps),
            Trouble::NoFit(_) => None,
        },
        /// What that means, and what to do.
        message: String = unsettled(case, found, l),
    }

    /// A family of effects.
    FamilyForm<'a> of (family: &'a (String, f64)) {
        /// Its name.
        name: &'a str = &family.0,
        /// Its probability among the named.
        probability: Number = Number(family.1),
    }

    /// A possible explanation of an effect.
    AlternativeForm<'a> of (one: &'a Alternative, case: &'a Case, d: &'a Diagnosis, names: Names<'a>) {
        /// Identifier of the catalogue.
        id: &'a str = names.cell(one.candidate).effect.id.as_str(),
        /// Name.
        name: String = names.plain(one.candidate),
        /// Family of the catalogue.
        family: &'a str = &names.cell(one.candidate).effect.family,
        /// What it is.
        prose: String = names.prose(one.candidate),
        /// What it adds to the model.
        formula: String = names.in_english().formula(case, d, one),
        /// Quantity of the model that is disturbed.
        node: &'a str = &names.cell(one.candidate).place.node,
        /// What the disturbance follows.
        along: &'a str = &names.cell(one.candidate).place.along,
        /// Posterior probability.
        probability: Number = Number(one.probability),
        /// Whether it does what the first of its list does only together with others of the list.
        jointly: bool = one.jointly,
        /// Its variants, most probable first; 5 at most.
        variants: Vec<VariantForm<'a>> = {
            let variants = one.variants.iter().take(VARIANTS);
            variants.map(|variant| VariantForm::of(variant, d, names)).collect()
        },
        /// What each size multiplies.
        terms: Vec<TermForm<'a>> = d.terms(one).into_iter().map(|term| TermForm::of(term, case)).collect(),
        /// Identifier of the effect on the scale that would be the same here, where the readings hardly vary.
        on_scale: Option<&'static str> = d.same_on_scale(one).map(|id| id.as_str()),
        /// Sizes; null where the recording does not determine one.
        size: Vec<Option<Number>> = one.estimate.iter().copied().map(finite).collect(),
        /// Their standard uncertainties.
        u: Vec<Option<Number>> = one.u().iter().copied().map(finite).collect(),
        /// Coverage factor of their 95 % intervals.
        coverage_factor: Option<Number> = finite(one.coverage_factor()),
        /// Strength over the noise.
        lambda: Number = Number(one.lambda),
        /// The candidate that is hardest to tell from it.
        nearest: Option<RivalForm> = one.nearest.as_ref().map(|rival| RivalForm::of(rival, names)),
    }

    /// A variant of an explanation.
    VariantForm<'a> of (variant: &Variant, d: &'a Diagnosis, names: Names<'a>) {
        /// Identifier of the catalogue.
        id: &'a str = names.cell(d.atoms[variant.atom].0).effect.id.as_str(),
        /// What distinguishes it.
        label: &'a str = names.label(d.atoms[variant.atom]),
        /// Share of the probability.
        share: Number = Number(variant.share),
    }

    /// What a size multiplies.
    TermForm<'a> of (term: &'a Term, case: &Case) {
        /// A formula of columns as numbers in their own units.
        multiplies: &'a str = &term.written().text,
        /// Unit of the size.
        unit: String = term.unit_of_size(case).typeset(),
    }

    /// A candidate that resembles an explanation.
    RivalForm of (rival: &Rival, names: Names<'_>) {
        /// Its name.
        name: String = names.plain(rival.candidate),
        /// Separability.
        kappa: Number = Number(rival.kappa),
        /// Whether no recording of this design tells the two apart.
        alias: bool = rival.alias,
        /// Probability that a recording like this one decides.
        resolved: Number = Number(rival.resolved),
    }

    /// How well a model describes the recording.
    QualityForm of (quality: &Quality) {
        /// χ² with the claimed noise.
        chi_squared: Number = Number(quality.chi_squared),
        /// Its degrees of freedom.
        dof: Number = Number(quality.dof),
        /// Root mean square of the residuals of each output.
        residual_rms: Vec<Number> = numbers(&quality.residual),
        /// Root mean square of the claimed noise of each output.
        expected_noise: Vec<Number> = numbers(&quality.expected),
        /// Root mean square of the errors of predictions of left-out rows of each output.
        held_out_rms: Vec<Number> = numbers(&quality.held_out),
    }

    /// The model with the adopted physics.
    ImprovedForm<'a> of (adopted: &'a Adopted, d: &'a Diagnosis, names: Names<'a>) {
        /// Its equations.
        model: &'a [String] = &adopted.extended.case.model,
        /// Effects in it.
        effects: Vec<String> = all(&adopted.atoms, |atom| names.variant(d.atoms[*atom])),
        /// Terms of the effects.
        additions: Vec<AdditionForm<'a>> = all(&adopted.extended.additions, AdditionForm::of),
        /// Their sizes.
        coefficients: Vec<EstimateForm<'a>> = all(&adopted.coefficients, EstimateForm::of),
        /// What the effects have beside sizes: time constants, knees, widths, periods.
        shapes: Vec<ShapeForm<'a>> = all(&adopted.shapes.all, ShapeForm::of),
        /// The parameters of the declared model, now.
        parameters: Vec<EstimateForm<'a>> = all(&adopted.unknowns, EstimateForm::of),
        /// χ² that the linear prediction promised.
        promised_chi_squared: Number = Number(adopted.confirmation.promised),
        /// The first size in parts of the recording.
        parts: Vec<PartForm<'a>> = all(&adopted.confirmation.parts, PartForm::of),
        /// Probability that the parts differ as much by chance.
        agreement: Option<Number> = adopted.confirmation.agreement.map(Number),
    }

    /// A term of an effect.
    AdditionForm<'a> of (addition: &'a Addition) {
        /// Its size.
        parameter: &'a str = &addition.parameter,
        /// Column that holds what the size multiplies; none where the size stands by itself.
        column: Option<&'a str> = addition.column.as_deref(),
        /// The same as a formula.
        modifier: &'a str = &addition.text,
        /// Unit of it.
        unit_of_modifier: String = addition.unit.typeset(),
    }

    /// What an effect has beside a size.
    ShapeForm<'a> of (shape: &'a Shape) {
        /// The place of the effect among those in the model, from 0.
        effect: usize = shape.effect,
        /// Its estimate, under the symbol that it has in formulas.
        estimate: EstimateForm<'a> = EstimateForm::of(&shape.estimated),
    }

    /// A size in a part of the recording.
    PartForm<'a> of (one: &'a (String, f64, f64)) {
        /// The part.
        part: &'a str = &one.0,
        /// The size.
        value: Number = Number(one.1),
        /// Its standard uncertainty.
        u: Number = Number(one.2),
    }

    /// How well the held-out recording is predicted.
    HeldOutForm<'a> of (held: &'a HeldOutQuality, names: Names<'a>) {
        /// Its file.
        file: &'a str = &held.file,
        /// Its rows, or means of rows.
        observations: usize = held.observations,
        /// Root mean square of the claimed noise of each output.
        expected_noise: Vec<Number> = numbers(&held.expected),
        /// By the declared model.
        before: PredictionForm = PredictionForm::of(&held.before),
        /// With the adopted physics.
        after: Option<PredictionForm> = held.after.as_ref().map(PredictionForm::of),
        /// By each explanation of the lists, in the place of the first.
        listed: Vec<ListedForm> = all(&held.listed, |one| ListedForm::of(one, names)),
    }

    /// The prediction by an explanation of a list.
    ListedForm of (one: &Listed, names: Names<'_>) {
        /// Its effect, as of `effects`, from 0.
        effect: usize = one.slot,
        /// The name of the explanation.
        name: String = names.plain(one.candidate),
        /// None where what it does in that recording does not follow from the columns.
        prediction: Option<PredictionForm> = one.prediction.as_ref().map(PredictionForm::of),
    }

    /// A prediction against what was observed.
    PredictionForm of (prediction: &Prediction) {
        /// Root mean square of the errors of each output.
        rms: Vec<Number> = numbers(&prediction.rms),
        /// Sum of the squares of the errors over their variances.
        chi_squared: Number = Number(prediction.chi_squared),
        /// Probability of errors that large by chance; none where successive rows are correlated.
        p: Option<Number> = prediction.p.map(Number),
    }

    /// Explanations of one effect that the recording cannot tell apart.
    SeparatingForm of (of: &Separating, names: Names<'_>) {
        /// Place among the effects.
        effect: usize = of.slot,
        /// Names.
        rivals: Vec<String> = all(&of.rivals, |cell| names.plain(*cell)),
        /// A number for each; those that share one say the same of every measurement.
        classes: Vec<usize> = of.classes.clone(),
        /// Separability of the two that are most alike.
        kappa: Number = Number(of.kappa),
        /// Further measurements, the most useful first.
        measurements: Vec<WorthForm> = all(&of.extras, |(extra, worth)| WorthForm::of(extra, worth, names.l)),
    }

    /// What a further measurement decides.
    WorthForm of (extra: &Extra, worth: &Worth, l: Language) {
        /// What is done.
        name: String = measure(&extra.measure, l),
        /// The same for machines.
        measure: MeasureForm = MeasureForm::of(&extra.measure),
        /// Effort; one is that of the recording.
        cost: Number = Number(extra.cost),
        /// Separability with it.
        kappa: Number = Number(worth.kappa),
        /// Probability that it decides.
        resolved: Number = Number(worth.resolved),
        /// How often it has to be done to decide as good as always.
        repeats: Number = Number(worth.repeats),
    }
}

impl Machine for DiagnosisForm<'_> {
    const KIND: &'static str = "diagnosis";
    const VERSION: u32 = 2;
}

/// JSON Schema of the output of `gumption diagnose --json`.
pub fn diagnosis_schema() -> Value {
    machine::schema::<DiagnosisForm<'_>>("gumption diagnose --json")
}

/// A number, where there is one.
fn finite(x: f64) -> Option<Number> {
    x.is_finite().then_some(Number(x))
}

/// What speaks against an effect, where it was considered.
fn considered(account: &Account) -> Option<&Against> {
    match account {
        Account::Considered(against) => Some(against),
        _ => None,
    }
}
