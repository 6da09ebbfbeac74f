//! The sentence for the certificate, per profile and per basis.
//!
//! U goes to one or two significant digits and y to the same last place (GUM 7.2.6, ILAC-P14). A
//! result that rests on Monte Carlo states half the width of its coverage interval as U where that
//! interval is symmetric about y, and the interval itself where it is not.

use gumption_fault::{Said, say};
use gumption_gum::budget::{Conventions, StatementForm, profile_named};
use gumption_gum::propagate::{
    Basis, CoverageBasis, FindingKind, Freedom, Gum, IntervalKind, Reason, ReportedUncertainty,
    StatedProbability,
};

use super::figures::Figures;
use super::language::Language;
use super::number::{NONE, at_place, grouped, probability};
use super::{Report, decisions};

/// One sentence (or a few) per measurand, one for the correlation of several, and one per decision.
pub fn statement(report: &Report<'_>) -> Vec<String> {
    let mut sentences: Vec<String> = (0..report.evaluation.results.len())
        .filter_map(|m| of_measurand(report, m))
        .collect();
    let evaluated = match sentences.is_empty() {
        true => None,
        false => certified(std::slice::from_ref(report)),
    };
    sentences.extend(correlations(report));
    sentences.extend(decisions::sentences(report));
    sentences.extend(evaluated);
    sentences
}

/// How the uncertainty was evaluated, as the profile has it said, and by which guide where Monte Carlo gave a result.
pub(super) fn certified(rows: &[Report<'_>]) -> Option<String> {
    const OF_MONTE_CARLO: &str = "JCGM 101";
    let first = rows.first()?;
    let language = first.language;
    let profile = profile_named(&first.budget.conventions.profile)?;
    let sentence = language.pick(profile.certified_en, profile.certified_zh);
    let is_by_trials = |report: &Report<'_>| {
        let measurands = 0..report.evaluation.results.len();
        let mut stated = measurands.filter(|measurand| states_result(report, *measurand));
        stated.any(|m| Figures::new(report, m).reported.basis == Basis::MonteCarlo)
    };
    let also = !sentence.contains(OF_MONTE_CARLO) && rows.iter().any(is_by_trials);
    let also = also.then(|| {
        say!("Results of the Monte Carlo method are stated in accordance with JCGM 101:2008.")
            .in_language(language)
    });
    let sentences: Vec<String> = std::iter::once(sentence.to_string()).chain(also).collect();
    Some(sentences.join(language.pick(" ", "")))
}

/// Whether what was measured is stated as y with its uncertainty: not where nothing was measured, nor where ISO 11929
/// has a sentence of its own.
pub(super) fn states_result(report: &Report<'_>, measurand: usize) -> bool {
    let budget = report.budget;
    let mut conformity = budget.conformity.iter();
    let planned = conformity.any(|c| c.planning && c.measurand == measurand);
    let own_sentence = budget.detection.iter().any(|d| d.measurand == measurand);
    !(planned || own_sentence)
}

fn of_measurand(report: &Report<'_>, measurand: usize) -> Option<String> {
    if !states_result(report, measurand) {
        return None;
    }
    let subject = Subject {
        figures: Figures::new(report, measurand),
        gum: &report.evaluation.results[measurand].gum,
        trials: grouped(report.evaluation.run.as_ref().map_or(0, |run| run.trials)),
        failed: failed(report, measurand),
        is_slow: is_slow(report, measurand),
        conventions: &report.budget.conventions,
        language: report.language,
    };
    Some(subject.sentence())
}

fn failed(report: &Report<'_>, measurand: usize) -> u64 {
    let found = report.evaluation.results[measurand].monte_carlo.as_ref();
    found.map_or(0, |found| found.failed)
}

/// Whether the distribution has a standard deviation, which the trials do not settle on.
fn is_slow(report: &Report<'_>, measurand: usize) -> bool {
    let mut findings = report.evaluation.findings.iter();
    findings.any(|finding| match &finding.kind {
        FindingKind::MomentsMissing { reason } => {
            finding.measurand == Some(measurand) && reason.leave_a_deviation()
        }
        _ => false,
    })
}

/// How y and U are stated: without a probability, the coverage factor has to be beside U.
pub(super) fn form(conventions: &Conventions) -> StatementForm {
    match conventions.state_probability {
        true => conventions.statement,
        false => StatementForm::Apart,
    }
}

/// What a sentence about one measurand needs.
struct Subject<'a> {
    figures: Figures<'a>,
    gum: &'a Gum,
    /// Trials of the run.
    trials: String,
    /// Those of them in which the model has no value.
    failed: u64,
    /// Whether its standard deviation exists, and is not known by the trials.
    is_slow: bool,
    conventions: &'a Conventions,
    language: Language,
}

impl Subject<'_> {
    fn sentence(&self) -> String {
        let sentence = self.with_uncertainty();
        match self.left_out() {
            Some(left_out) => [sentence, left_out].join(self.language.pick(" ", "")),
            None => sentence,
        }
    }

    /// The trials that the figures of Monte Carlo do not rest on.
    fn left_out(&self) -> Option<String> {
        let failed = grouped(self.failed);
        let counts = self.failed > 0 && self.figures.reported.basis == Basis::MonteCarlo;
        counts.then(|| {
            say!("In {failed} of these trials the model has no value; they are left out.")
                .in_language(self.language)
        })
    }

    fn with_uncertainty(&self) -> String {
        let reported = &self.figures.reported;
        match (reported.uncertainty, reported.basis) {
            (ReportedUncertainty::Multiple { .. }, Basis::Gum) => self.gum_sentence(),
            (ReportedUncertainty::Multiple { .. }, Basis::MonteCarlo) => self.fixed_multiple(),
            (ReportedUncertainty::HalfWidth { .. }, _) => match reported.u {
                Some(_) => self.half_interval(),
                None => self.half_interval_alone(),
            },
            (ReportedUncertainty::Interval { kind, .. }, _) => self.interval(kind),
            (ReportedUncertainty::None, _) => self.without_uncertainty(),
        }
    }

    fn form(&self) -> StatementForm {
        form(self.conventions)
    }

    /// U with its unit.
    fn expanded(&self) -> String {
        let expanded = self.figures.expanded();
        self.figures.amount(expanded.as_deref().unwrap_or(NONE))
    }

    /// u with its unit.
    fn u(&self) -> String {
        let u = self.figures.u();
        self.figures.amount(u.as_deref().unwrap_or(NONE))
    }

    fn k(&self) -> String {
        self.figures.k().unwrap_or_else(|| NONE.to_string())
    }

    fn gum_sentence(&self) -> String {
        match self.form() {
            StatementForm::PlusMinus => {
                let space = self.language.pick(" ", "");
                format!("{}{space}{}", self.equation(), self.explained())
            }
            StatementForm::Apart => self.apart(),
        }
    }

    /// `I = (9.9990 ± 0.0017) mA.`
    fn equation(&self) -> String {
        let equation = self.figures.plus_minus().unwrap_or_default();
        format!("{equation}{}", self.language.pick(".", "。"))
    }

    fn explained(&self) -> String {
        let (expanded, u, k, reason) = (self.expanded(), self.u(), self.k(), self.reason());
        say!("The number after ± is the expanded uncertainty U = {expanded}, the combined standard uncertainty u_c = {u} times the coverage factor k = {k}{reason}.").in_language(self.language)
    }

    /// `= 9`; a lower bound where ν_eff is not defined.
    fn freedom(&self) -> String {
        let relation = match self.gum.freedom {
            Freedom::Refused { .. } => "≥",
            _ => "=",
        };
        format!("{relation} {}", self.figures.freedom().unwrap_or_default())
    }

    /// Why k has this value, and what it covers.
    fn reason(&self) -> String {
        let k = self.k();
        let p = match self.figures.reported.probability {
            StatedProbability::Of(p) => probability(p),
            StatedProbability::Unnamed => return String::new(),
            StatedProbability::Refuted => {
                return say!(", a fixed factor, for which no coverage probability is stated")
                    .in_language(self.language);
            }
        };
        match (self.gum.coverage.named_basis(), self.language) {
            (CoverageBasis::Normal, Language::English) => {
                format!(
                    ", which for a normal distribution corresponds to a coverage probability of about {p}"
                )
            }
            (CoverageBasis::Normal, Language::Chinese) => {
                format!("；对于正态分布，包含概率约为 {p}")
            }
            (CoverageBasis::StudentT { .. }, Language::English) => format!(
                ", which for a t-distribution with ν_eff {} effective degrees of freedom corresponds to a coverage probability of about {p}",
                self.freedom(),
            ),
            (CoverageBasis::StudentT { .. }, Language::Chinese) => {
                format!(
                    "；按有效自由度 ν_eff {} 的 t 分布，包含概率约为 {p}",
                    self.freedom()
                )
            }
            (CoverageBasis::Output { dominant, shape }, Language::English) => format!(
                ", found from the assumed {} distribution of the result, in which {} dominate{}, for a coverage probability of {p}",
                shape.name(self.language),
                self.language.list(dominant),
                if dominant.len() == 1 { "s" } else { "" },
            ),
            (CoverageBasis::Output { dominant, shape }, Language::Chinese) => format!(
                "；{} 占优势，被测量的分布按{}处理，k = {k} 对应的包含概率为 {p}",
                self.language.list(dominant),
                shape.name(self.language),
            ),
            (CoverageBasis::Fixed, Language::English) => {
                format!(", a fixed factor, for which the coverage probability is about {p}")
            }
            (CoverageBasis::Fixed, Language::Chinese) => format!("；k 取约定值，包含概率约为 {p}"),
        }
    }

    /// `y = …, U = …, k = 2` or, where p is stated, `U_95 = …, k_95 = 2.26, ν_eff = 9`.
    fn apart(&self) -> String {
        let (name, y, expanded) = (self.figures.name, self.figures.value(), self.expanded());
        let (u, k) = (self.u(), self.k());
        let index = match self.figures.reported.probability {
            StatedProbability::Of(p) => format!("_{}", probability(p).trim_end_matches(" %")),
            _ => String::new(),
        };
        let nu = match self.gum.coverage.named_basis() {
            CoverageBasis::StudentT { .. } => {
                format!("{}ν_eff {}", self.language.comma(), self.freedom())
            }
            _ => String::new(),
        };
        let shape = match (&self.gum.coverage.basis, self.language) {
            (CoverageBasis::Output { dominant, shape }, Language::English) => {
                format!(
                    " k was found from the {} distribution that {} give{} the result.",
                    shape.name(self.language),
                    self.language.list(dominant),
                    if dominant.len() == 1 { "s" } else { "" }
                )
            }
            (CoverageBasis::Output { dominant, shape }, Language::Chinese) => {
                format!(
                    "{} 占优势，k 按{}确定。",
                    self.language.list(dominant),
                    shape.name(self.language)
                )
            }
            _ => String::new(),
        };
        say!("{name} = {y}; U{index} = {expanded}, k{index} = {k}{nu}. The expanded uncertainty is the combined standard uncertainty u_c = {u} multiplied by the coverage factor.{shape}").in_language(self.language)
    }

    /// The probability of an interval; `95 %`.
    fn probability(&self) -> String {
        match self.figures.reported.probability {
            StatedProbability::Of(p) => probability(p),
            _ => probability(self.conventions.coverage_probability),
        }
    }

    /// Why there is no standard uncertainty: a t-distribution has one of u·√(ν/(ν − 2)) for ν > 2 (JCGM 101, 6.4.9.4), which
    /// trials with so few degrees of freedom do not show.
    fn why_no_deviation(&self) -> Said {
        match self.is_slow {
            true => say!("the standard deviation of the trials does not converge"),
            false => say!("the distribution of the result has no standard deviation"),
        }
    }

    /// y and U = half the width of the interval where the distribution has no standard deviation, hence
    /// no k: a few readings.
    fn half_interval_alone(&self) -> String {
        let (p, trials, expanded) = (self.probability(), &self.trials, self.expanded());
        let (name, y) = (self.figures.name, self.figures.value());
        let index = p.trim_end_matches(" %");
        let which = match (self.figures.median, self.language) {
            (true, Language::English) => " The estimate is the median.",
            (true, Language::Chinese) => "估计值为中位数。",
            (false, _) => "",
        };
        let head = match (self.form(), self.language) {
            (StatementForm::PlusMinus, Language::English) => format!(
                "{} The number after ± is the expanded uncertainty U = {expanded},",
                self.equation()
            ),
            (StatementForm::Apart, Language::English) => {
                format!("{name} = {y}; U_{index} = {expanded}. The expanded uncertainty is")
            }
            (StatementForm::PlusMinus, Language::Chinese) => format!(
                "{}其中 ± 号后的数为扩展不确定度 U = {expanded}，即",
                self.equation()
            ),
            (StatementForm::Apart, Language::Chinese) => {
                format!("{name} = {y}；U_{index} = {expanded}。扩展不确定度为")
            }
        };
        let why = self.why_no_deviation();
        say!("{head} half the width of the {p} coverage interval found by the Monte Carlo method (JCGM 101, {trials} trials).{which} No standard uncertainty and no coverage factor are stated, because {why}.").in_language(self.language)
    }

    /// y and U = k·u with the u of Monte Carlo, where k is that of the profile.
    fn fixed_multiple(&self) -> String {
        let (name, y, expanded) = (self.figures.name, self.figures.value(), self.expanded());
        let (u, k, trials) = (self.u(), self.k(), &self.trials);
        let few = self.figures.reported.reason == Reason::NotValidatedFewReadings;
        let found = match few {
            true => say!(
                "found by the Monte Carlo method (JCGM 101) with the standard uncertainties of the inputs as their standard deviations"
            ),
            false => say!("found by the Monte Carlo method (JCGM 101, {trials} trials)"),
        };
        say!("{name} = {y}; U = {expanded}, k = {k}. The expanded uncertainty is the standard uncertainty u = {u}, {found}, multiplied by the coverage factor. The result of the GUM method was not validated against it.").in_language(self.language)
    }

    /// y and U = half the width of the Monte Carlo interval, with the k that this implies.
    fn half_interval(&self) -> String {
        let (p, k, expanded, u) = (self.probability(), self.k(), self.expanded(), self.u());
        let trials = &self.trials;
        match (self.form(), self.language) {
            (StatementForm::PlusMinus, Language::English) => format!(
                "{} The number after ± is the expanded uncertainty U = {expanded}, half the width of the {p} coverage interval found by the Monte Carlo method (JCGM 101, {trials} trials); with the standard uncertainty u = {u} this is a coverage factor k = U/u = {k}. The result of the GUM method was not validated against it.",
                self.equation()
            ),
            (StatementForm::PlusMinus, Language::Chinese) => format!(
                "{}其中 ± 号后的数为扩展不确定度 U = {expanded}，即蒙特卡洛法（JJF 1059.2，{trials} 次试验）所得 {p} 包含区间的半宽；标准不确定度 u = {u}，相应的包含因子 k = U/u = {k}。GUM 法的结果未通过其验证。",
                self.equation()
            ),
            (StatementForm::Apart, language) => {
                let (name, y) = (self.figures.name, self.figures.value());
                let index = p.trim_end_matches(" %");
                say!("{name} = {y}; U_{index} = {expanded}, k_{index} = {k}. The expanded uncertainty is half the width of the {p} coverage interval found by the Monte Carlo method (JCGM 101, {trials} trials), with the standard uncertainty u = {u}. The result of the GUM method was not validated against it.").in_language(language)
            }
        }
    }

    fn interval(&self, kind: IntervalKind) -> String {
        let (p, trials) = (self.probability(), &self.trials);
        let which = match kind {
            IntervalKind::Shortest => self.language.pick("shortest", "最短"),
            IntervalKind::Symmetric => {
                let symmetric = "probabilistically symmetric";
                self.language.pick(symmetric, "概率对称")
            }
        };
        let ends = self.figures.interval().unwrap_or_default();
        let [low, high] = ends.map(|end| self.figures.of_value(&end));
        let (name, value, u) = (self.figures.name, self.figures.value(), self.u());
        let what = match self.figures.median {
            true => self.language.pick("median", "中位数"),
            false => self.language.pick("estimate", "估计值"),
        };
        let why = self.why_no_deviation().in_language(self.language);
        match (self.figures.reported.u, self.language) {
            (Some(_), Language::English) => format!(
                "{name}: {what} {value}, standard uncertainty u = {u}, {which} {p} coverage interval from {low} to {high}. These figures were found by the Monte Carlo method (JCGM 101) with {trials} trials, against which the result of the GUM method could not be validated."
            ),
            (Some(_), Language::Chinese) => format!(
                "{name}：{what} {value}，标准不确定度 u = {u}，包含概率 {p} 的{which}包含区间为 {low} 至 {high}。以上结果由蒙特卡洛法（JJF 1059.2，{trials} 次试验）得到，GUM 法的结果未通过其验证。"
            ),
            (None, Language::English) => format!(
                "{name}: {what} {value}, {which} {p} coverage interval from {low} to {high}, found by the Monte Carlo method with {trials} trials. No standard uncertainty is stated, because {why}."
            ),
            (None, Language::Chinese) => format!(
                "{name}：{what} {value}，包含概率 {p} 的{which}包含区间为 {low} 至 {high}，由蒙特卡洛法（{trials} 次试验）得到。{why}，故不给出标准不确定度。"
            ),
        }
    }

    fn without_uncertainty(&self) -> String {
        let (name, value) = (self.figures.name, self.figures.value());
        say!("{name} = {value}. No uncertainty can be stated: the evaluation gives none.")
            .in_language(self.language)
    }
}

/// Which correlation coefficients go with the estimates and uncertainties that are reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Coefficients {
    /// All results are those of the GUM, and so are the coefficients.
    Gum,
    /// Some or all results are those of Monte Carlo, and all coefficients.
    MonteCarlo,
    /// Some or all results are those of Monte Carlo, which has no correlation coefficients.
    GumForWantOfMoments,
}

impl Coefficients {
    /// Those of a report.
    pub(super) fn of(report: &Report<'_>) -> Coefficients {
        let conventions = &report.budget.conventions;
        let mut results = report.evaluation.results.iter();
        let joint = report.evaluation.joint.as_ref();
        let found = joint.is_some_and(|joint| joint.monte_carlo_correlation.is_some());
        match results.any(|r| r.reported(conventions).basis == Basis::MonteCarlo) {
            false => Coefficients::Gum,
            true if found => Coefficients::MonteCarlo,
            true => Coefficients::GumForWantOfMoments,
        }
    }

    /// The method, where it is not that of every result.
    fn method(self, l: Language) -> &'static str {
        match self {
            Coefficients::Gum => "",
            Coefficients::MonteCarlo => l.pick(", by the Monte Carlo method", "（蒙特卡洛法）"),
            Coefficients::GumForWantOfMoments => l.pick(", by the GUM method", "（GUM 法）"),
        }
    }
}

fn correlations(report: &Report<'_>) -> Option<String> {
    let joint = report.evaluation.joint.as_ref()?;
    let which = Coefficients::of(report);
    let matrix = match (&joint.monte_carlo_correlation, which) {
        (Some(matrix), Coefficients::MonteCarlo) => matrix,
        _ => &joint.correlation,
    };
    let n = report.evaluation.results.len();
    let mut pairs = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            if let Some(r) = matrix.get((i, j)) {
                let (first, second) = (report.measurand(i).0, report.measurand(j).0);
                pairs.push(format!("r({first}, {second}) = {}", coefficient(*r)));
            }
        }
    }
    /// More pairs belong in a table.
    const MOST: usize = 10;
    if pairs.is_empty() {
        return None;
    }
    let l = report.language;
    let method = which.method(l);
    Some(match pairs.len() > MOST {
        true => say!("The estimates are correlated; the table of the joint result gives the correlation coefficients{method}.").in_language(l),
        false => {
            let pairs = pairs.join(l.comma());
            say!("Correlation of the estimates{method}: {pairs}.").in_language(l)
        }
    })
}

/// A correlation coefficient: two decimals, more digits near ±1 (GUM 7.2.6).
pub(super) fn coefficient(r: f64) -> String {
    let place = if r.abs() < 0.9 || r.abs() == 1.0 {
        -2
    } else {
        (libm::log10(1.0 - r.abs()).floor() as i32 - 1).clamp(-6, -3)
    };
    if r.is_finite() {
        at_place(r, place).print_plain()
    } else {
        NONE.to_string()
    }
}
