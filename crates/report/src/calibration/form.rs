//! A calibration and a plan for machines: exact numbers, stable names.

use nalgebra::DMatrix;
use serde_json::Value;

use crate::language::Language;
use gumption_core::quantity::Unit;
use gumption_format::machine::{self, Machine, Number, all, form};
use gumption_lab::calibrate::{
    Alias, Apart, Calibration, Campaign, Cause, Coefficient, Combination, Contradicted,
    Contribution, Figures, Identifiability, Limit, Misfit, NearAlias, Omitted, Origin, Pattern,
    PatternTest, Plan, Residual, ResponseScatter, Scatter, ScatterTest,
};
use gumption_lab::experiment::{Scope, Words};
use gumption_lab::recording::Finding;

use super::causes::cause_name;
use super::misfit;
use super::sections::said;
use super::trouble::in_words;

form! {
    /// Coefficients from a recording and measurement equations.
    CalibrationForm<'a> of (campaign: &'a Campaign, found: &'a Calibration, l: Language) {
        /// What a plan has as well.
        #[serde(flatten)]
        common: Common<'a> = Common::of(campaign, Some(&found.figures), &found.identifiability, &found.aliases, l),
        /// `calibration`.
        kind: &'static str = "calibration",
        /// Number of readings used.
        readings: usize = found.readings,
        /// Readings left out, because a value is missing.
        left_out: usize = found.left_out,
        /// Pairs of points or labels whose readings look exchanged.
        swapped: Vec<[&'a str; 2]> = all(&found.swapped, |[a, b]| [said(a, l), said(b, l)]),
        /// Coefficients with another sign than those like them.
        reversed: &'a [String] = &found.reversed,
        /// Points that stand apart from all others.
        apart: Vec<ApartForm<'a>> = all(&found.apart, |one| ApartForm::of(one, l)),
        /// Parameters of which the readings say something else than what is stated of them.
        contradicted: Vec<ContradictedForm<'a>> = all(&found.contradicted, ContradictedForm::of),
        /// Values at which readings stay that should differ.
        limits: Vec<LimitForm<'a>> = all(&found.limits, |one| LimitForm::of(one, l)),
        /// Responses whose residuals are no scatter.
        residual_patterns: Vec<PatternForm<'a>> = all(&found.patterns, PatternForm::of),
        /// Whether the equations are linear in the parameters.
        linear: bool = found.linear,
        /// Steps of the search; 0 for linear equations.
        iterations: usize = found.iterations,
        /// What tells the scatter of the readings: `residuals`, `dwells` or `stated`.
        scatter: &'static str = match found.scatter {
            Scatter::Residuals => "residuals",
            Scatter::Dwells => "dwells",
            Scatter::Stated => "stated",
        },
        /// The scatter of each response.
        responses: Vec<ResponseForm<'a>> = {
            let pairs = found.responses.iter().zip(campaign.experiment.equations.responses());
            pairs.map(|(one, quantity)| ResponseForm::of(one, &quantity.unit)).collect()
        },
        /// What is left of each reading; of more than 100 000 readings the most conspicuous.
        residuals: Vec<ResidualForm<'a>> = {
            let listed = misfit::listed(found).into_iter();
            listed.map(|one| ResidualForm::of(campaign, one, l)).collect()
        },
        /// Coefficients of parts of the recording, where the file wants them one by one.
        parts: Vec<PartForm<'a>> = all(&found.parts, |(label, part)| PartForm::of(label, &part.figures, l)),
        /// What is doubtful in the recording.
        findings: Vec<FindingForm> = all(&campaign.points.findings, |one| FindingForm::of(one, l)),
        /// Rows that were left out with their reasons, and what the file states in vain.
        remarks: Vec<String> = all(&campaign.experiment.remarks, |remark| remark.in_language(l)),
    }

    /// What a schedule would tell, before anything is measured.
    PlanForm<'a> of (campaign: &'a Campaign, plan: &'a Plan, l: Language) {
        /// What a calibration has as well.
        #[serde(flatten)]
        common: Common<'a> = Common::of(campaign, plan.figures.as_ref(), &plan.identifiability, &plan.aliases, l),
        /// `plan`.
        kind: &'static str = "plan",
        /// Number of readings.
        readings: usize = plan.readings,
        /// Parameters whose value is not stated and was taken as zero.
        assumed_zero: &'a [String] = &plan.assumed,
    }

    /// What calibrations and plans have in common.
    Common<'a> of (
        campaign: &'a Campaign,
        figures: Option<&'a Figures>,
        identifiability: &'a Identifiability,
        aliases: &'a [Alias],
        l: Language
    ) {
        /// Title.
        title: &'a str = said(&campaign.experiment.heading.title, l),
        /// Procedure of the library.
        procedure: Option<&'a str> = campaign.experiment.heading.procedure.as_deref(),
        /// Where the method comes from.
        reference: Option<&'a str> = campaign.experiment.heading.reference.as_deref(),
        /// What is calibrated.
        object: Option<&'a str> = campaign.experiment.heading.object.as_deref(),
        /// Who did it.
        author: Option<&'a str> = campaign.experiment.heading.author.as_deref(),
        /// When.
        date: Option<&'a str> = campaign.experiment.heading.date.as_deref(),
        /// Statements that all equations see.
        statements: Vec<&'a str> = campaign.experiment.equations.shared().lines().collect(),
        /// Measurement equations.
        equations: Vec<&'a str> = {
            let equations = &campaign.experiment.equations;
            (0..equations.responses().len()).map(|response| equations.text(response)).collect()
        },
        /// Probability of the coverage intervals.
        coverage_probability: Number = Number(campaign.experiment.conventions.coverage_probability),
        /// Parameters, then results; of a plan with the values that were assumed, and none where the schedule does not
        /// determine all of them.
        coefficients: Vec<CoefficientForm<'a>> = figures.map_or_else(Vec::new, |figures| coefficients(figures, l)),
        /// Covariance matrix of the coefficients.
        covariance: Vec<Vec<Number>> = figures.map_or_else(Vec::new, |figures| rows(&figures.covariance)),
        /// Correlation matrix of the coefficients.
        correlation: Vec<Vec<Number>> = figures.map_or_else(Vec::new, |figures| rows(&figures.correlation())),
        /// What the uncertainties come from.
        causes: Vec<CauseForm<'a>> = figures.map_or_else(Vec::new, |figures| {
            all(&figures.causes, |one| CauseForm::of(one, figures, l))
        }),
        /// What the readings tell apart.
        identifiability: IdentifiabilityForm<'a> = IdentifiabilityForm::of(identifiability, l),
        /// Effects outside the equations.
        omitted: Vec<OmittedForm<'a>> = {
            let pairs = campaign.omitted.iter().zip(aliases);
            pairs.map(|(omitted, alias)| OmittedForm::of(omitted, alias, campaign, l)).collect()
        },
    }

    /// A coefficient.
    CoefficientForm<'a> of (one: &'a Coefficient, l: Language) {
        /// As the equations call it.
        name: &'a str = &one.name,
        /// What it is.
        description: Option<&'a str> = one.description.as_ref().map(|words| said(words, l)),
        /// Unit of value, u and U.
        unit: &'a str = &one.unit.symbol,
        /// Estimate.
        value: Number = Number(one.value),
        /// Standard uncertainty.
        u: Number = Number(one.u),
        /// Effective degrees of freedom.
        dof: Number = Number(one.dof),
        /// Coverage factor.
        k: Number = Number(one.k),
        /// Expanded uncertainty.
        #[serde(rename = "U")]
        expanded: Number = Number(one.k * one.u),
        /// Probability that a coefficient that is zero comes out as far from it (two-sided t test).
        p_value: Number = Number(one.p_value),
        /// Whether it differs from zero beyond chance (p < 0.05); null where no test says so.
        significant: Option<bool> = one.is_significant(),
    }

    /// A cause of doubt.
    CauseForm<'a> of (cause: &'a Cause, figures: &'a Figures, l: Language) {
        /// What it is.
        name: String = cause_name(cause, l),
        /// `stated`, `residuals`, `samples` or `prior`.
        kind: &'static str = match &cause.origin {
            Origin::Stated { .. } => "stated",
            Origin::Residuals { .. } => "residuals",
            Origin::Samples { .. } => "samples",
            Origin::Prior { .. } => "prior",
        },
        /// On which points one of its errors acts: `common`, `each` or `by COLUMN`.
        scope: String = match &cause.origin {
            Origin::Stated { scope: Scope::By(column), .. } => format!("by {column}"),
            Origin::Stated { scope: Scope::Common, .. } | Origin::Prior { .. } => "common".into(),
            _ => "each".into(),
        },
        /// How its standard uncertainty was found.
        how: &'a str = &cause.how,
        /// What it does to each coefficient.
        contributions: Vec<ContributionForm<'a>> = {
            let all = figures.coefficients.iter().enumerate();
            all.map(|(at, one)| ContributionForm::of(&one.name, cause.contributes(at, one.u))).collect()
        },
    }

    /// What a cause does to a coefficient.
    ContributionForm<'a> of (name: &'a str, part: Contribution<'_>) {
        /// The coefficient.
        coefficient: &'a str = name,
        /// Part of its standard uncertainty.
        u: Number = Number(part.u),
        /// Change by one standard uncertainty, with its sign, where the cause is one error.
        effect: Option<Number> = part.effect.map(Number),
        /// Share of the variance.
        share: Number = Number(part.share),
        /// Degrees of freedom.
        dof: Number = Number(part.dof),
    }

    /// What the readings tell apart.
    IdentifiabilityForm<'a> of (found: &'a Identifiability, l: Language) {
        /// Number of independent combinations of parameters that they determine.
        rank: usize = found.rank,
        /// Number of parameters.
        parameters: usize = found.parameters,
        /// Condition number of the scaled equations.
        condition: Number = Number(found.condition),
        /// Combinations that no reading shows.
        undetermined: Vec<UndeterminedForm<'a>> = all(&found.undetermined, |one| UndeterminedForm::of(one, l)),
        /// Parameters that others imitate nearly.
        near: Vec<NearForm<'a>> = all(&found.near, NearForm::of),
    }

    /// A combination of parameters that changes no reading.
    UndeterminedForm<'a> of (combination: &'a Combination, l: Language) {
        /// In words.
        words: String = in_words(combination, l),
        /// Changes that cancel.
        changes: Vec<ChangeForm<'a>> = all(&combination.changes, ChangeForm::of),
    }

    /// A parameter that others imitate nearly.
    NearForm<'a> of (near: &'a NearAlias) {
        /// The parameter.
        parameter: &'a str = &near.parameter,
        /// By how much larger its standard uncertainty is than if the others were known.
        inflation: Number = Number(near.inflation),
        /// Changes that nearly cancel.
        changes: Vec<ChangeForm<'a>> = all(&near.combination.changes, ChangeForm::of),
    }

    /// A change of a parameter.
    ChangeForm<'a> of (change: &'a (String, f64, String)) {
        /// The parameter.
        parameter: &'a str = &change.0,
        /// The change.
        change: Number = Number(change.1),
        /// Its unit.
        unit: &'a str = &change.2,
    }

    /// An effect outside the equations.
    OmittedForm<'a> of (omitted: &'a Omitted, alias: &'a Alias, campaign: &'a Campaign, l: Language) {
        /// Its name.
        name: &'a str = &alias.name,
        /// What it would add to an equation.
        term: &'a str = &omitted.term,
        /// Its unit.
        unit: &'a str = &omitted.unit.symbol,
        /// What it is.
        description: Option<&'a str> = omitted.description.as_ref().map(|words| said(words, l)),
        /// Its usual size.
        typical: Option<Number> = omitted.typical.map(Number),
        /// Whether it acts on any reading.
        acts: bool = alias.acts,
        /// Share of it that the residuals would show.
        visible: Number = Number(alias.visible),
        /// What it does to each coefficient.
        shifts: Vec<ShiftForm<'a>> = {
            let parameters = campaign.experiment.parameters.iter().map(|one| (&one.name, &one.unit));
            let results = campaign.results.iter().map(|one| (&one.name, &one.unit));
            let all = parameters.chain(results).zip(&alias.shifts);
            all.map(|((name, unit), shift)| ShiftForm::of(name, unit, *shift)).collect()
        },
    }

    /// What an omitted effect does to a coefficient.
    ShiftForm<'a> of (name: &'a str, own: &'a Unit, shift: f64) {
        /// The coefficient.
        coefficient: &'a str = name,
        /// Change for each unit of the effect.
        per_unit: Number = Number(shift),
        /// Unit of the coefficient.
        unit: &'a str = &own.symbol,
    }

    /// A point that stands apart.
    ApartForm<'a> of (one: &'a Apart, l: Language) {
        /// The response.
        response: &'a str = &one.response,
        /// The point.
        point: &'a str = said(&one.point, l),
        /// Its residual over the standard deviation that those of the others give it.
        t: Number = Number(one.t),
        /// Probability that the largest residual is as far out.
        p_value: Number = Number(one.p_value),
    }

    /// A parameter of which the readings say something else than what is stated of it.
    ContradictedForm<'a> of (one: &'a Contradicted) {
        /// Its name.
        parameter: &'a str = &one.parameter,
        /// What is stated of it.
        stated: Number = Number(one.stated[0]),
        /// Its standard uncertainty.
        u_stated: Number = Number(one.stated[1]),
        /// What the readings give without that.
        found: Number = Number(one.found[0]),
        /// Its standard uncertainty.
        u_found: Number = Number(one.found[1]),
        /// Probability of a difference as large, of all such parameters together.
        p_value: Number = Number(one.p_value),
    }

    /// A value at which readings stay.
    LimitForm<'a> of (limit: &'a Limit, l: Language) {
        /// The response.
        response: &'a str = &limit.response,
        /// The value.
        value: Number = Number(limit.value),
        /// Where it is read.
        points: Vec<&'a str> = all(&limit.points, |point: &Words| said(point, l)),
    }

    /// A response whose residuals are no scatter.
    PatternForm<'a> of (one: &'a Pattern) {
        /// The response.
        response: &'a str = &one.response,
        /// What tells: `parts`, `repeats`, `runs` or `follows`.
        by: &'static str = match &one.by {
            PatternTest::Parts { .. } => "parts",
            PatternTest::Repeats { .. } => "repeats",
            PatternTest::Runs { .. } => "runs",
            PatternTest::Follows { .. } => "follows",
        },
        /// Of repeated readings: standard deviation among themselves, in the unit of the response (of unit weight where they have weights); null for others.
        within: Option<Number> = repeats(one).map(|[within, ..]| Number(within)),
        /// The same from their means about the equation.
        between: Option<Number> = repeats(one).map(|[_, between]| Number(between)),
        /// Ratio of their squares; of `parts` that of what all points leave beyond the parts to what the parts leave.
        f: Option<Number> = match one.by {
            PatternTest::Parts { f, .. } | PatternTest::Repeats { f, .. } => Some(Number(f)),
            _ => None,
        },
        /// How many runs of equal signs there are; null for others.
        runs: Option<usize> = signs(one).map(|[runs, _]| runs),
        /// Of so many residuals.
        residuals: Option<usize> = signs(one).map(|[_, residuals]| residuals),
        /// The column that the residuals follow, or that tells the parts apart; null where it is none.
        column: Option<&'a str> = match &one.by {
            PatternTest::Follows { column } | PatternTest::Parts { column, .. } => Some(column),
            _ => None,
        },
        /// Probability of residuals like that, were they scatter.
        p_value: Number = Number(one.p_value),
    }

    /// The scatter of a response.
    ResponseForm<'a> of (one: &'a ResponseScatter, own: &'a Unit) {
        /// The response.
        name: &'a str = &one.response,
        /// Its unit.
        unit: &'a str = &own.symbol,
        /// Number of readings.
        readings: usize = one.readings,
        /// Root mean square of the residuals.
        rms: Number = Number(one.rms),
        /// Standard deviation of a reading, or of one of unit weight.
        s: Number = Number(one.s),
        /// Its degrees of freedom.
        dof: Number = Number(one.dof),
        /// The residuals against the known errors of the readings, where these are known.
        test: Option<TestForm> = one.test.map(TestForm::of),
    }

    /// Whether residuals are as large as the known errors let expect.
    TestForm of (test: ScatterTest) {
        /// Residual standard deviation to expect.
        expected: Number = Number(test.expected),
        /// Σ(r/u)².
        chi_squared: Number = Number(test.chi_squared),
        /// Degrees of freedom.
        dof: Number = Number(test.dof),
        /// Probability of a larger χ².
        p_value: Number = Number(test.p_value),
        /// `between dwells` where something changes from dwell to dwell, `larger` or `smaller` than the errors let
        /// expect; null where neither.
        misfit: Option<&'static str> = test.misfit.map(|misfit| match misfit {
            Misfit::BetweenDwells => "between dwells",
            Misfit::Larger => "larger",
            Misfit::Smaller => "smaller",
        }),
    }

    /// What is left of a reading.
    ResidualForm<'a> of (campaign: &'a Campaign, one: &Residual, l: Language) {
        /// The point.
        point: String = said(&campaign.points.names.of(one.point), l).to_owned(),
        /// The response.
        response: &'a str = campaign.experiment.equations.responses().get(one.response).map_or("", |r| &r.name),
        /// What was read.
        observed: Number = Number(one.observed),
        /// What the equation gives.
        fitted: Number = Number(one.fitted),
        /// Their difference.
        residual: Number = Number(one.observed - one.fitted),
        /// The difference over its standard deviation.
        standardised: Number = Number(one.standardised),
    }

    /// A part of the recording.
    PartForm<'a> of (name: &'a str, figures: &'a Figures, l: Language) {
        /// Its label.
        label: &'a str = name,
        /// Its coefficients.
        coefficients: Vec<CoefficientForm<'a>> = coefficients(figures, l),
    }

    /// Something doubtful in the recording.
    FindingForm of (finding: &Finding, l: Language) {
        /// What.
        message: String = finding.said().in_language(l),
        /// What to do.
        advice: String = finding.mend().in_language(l),
        /// Line of the file; 0 for the whole.
        line: usize = finding.line,
        /// How often.
        count: usize = finding.count,
    }
}

impl Machine for CalibrationForm<'_> {
    const KIND: &'static str = "calibration";
    const VERSION: u32 = 1;
}

impl Machine for PlanForm<'_> {
    const KIND: &'static str = "calibration-plan";
    const VERSION: u32 = 1;
}

/// JSON Schema of the output of `gumption calibrate --json`.
pub fn calibration_schema() -> Value {
    machine::schema::<CalibrationForm<'_>>("gumption calibrate --json")
}

/// JSON Schema of the output of `gumption plan --json` for a calibration.
pub fn plan_schema() -> Value {
    machine::schema::<PlanForm<'_>>("gumption plan --json")
}

/// What repeated readings tell: within and between.
fn repeats(one: &Pattern) -> Option<[f64; 2]> {
    match one.by {
        PatternTest::Repeats {
            within, between, ..
        } => Some([within, between]),
        _ => None,
    }
}

/// What signs tell: how many runs, of how many residuals.
fn signs(one: &Pattern) -> Option<[usize; 2]> {
    match one.by {
        PatternTest::Runs { runs, readings } => Some([runs, readings]),
        _ => None,
    }
}

fn coefficients(figures: &Figures, l: Language) -> Vec<CoefficientForm<'_>> {
    all(&figures.coefficients, |one| CoefficientForm::of(one, l))
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<Number>> {
    let rows = matrix.row_iter();
    rows.map(|row| row.iter().copied().map(Number).collect())
        .collect()
}
