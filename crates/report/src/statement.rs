//! The sentence for the certificate, per profile and per basis.
//!
//! U goes to one or two significant digits and y to the same last place (GUM 7.2.6, ILAC-P14). A
//! result that rests on Monte Carlo states half the width of its coverage interval as U where that
//! interval is symmetric about y, and the interval itself where it is not.

use gumption_core::quantity::{Decimal, Rounded, Unit, space_before};
use gumption_gum::budget::{Conventions, CoverageRule, StatementForm};
use gumption_gum::propagate::{
    Basis, Coverage, CoverageBasis, Freedom, IntervalKind, MonteCarlo, Reported,
    ReportedUncertainty, StatedProbability,
};

use super::language::Language;
use super::number::{
    NONE, STYLE, at_place, exact, freedom, grouped, print, probability, significant,
};
use super::{Report, decisions, difference_symbol, symbol};

/// One sentence (or a few) per measurand, one for the correlation of several, and one per decision.
pub fn statement(report: &Report<'_>) -> Vec<String> {
    let mut sentences: Vec<String> = (0..report.evaluation.results.len())
        .map(|m| of_measurand(report, m))
        .collect();
    sentences.extend(correlations(report));
    sentences.extend(decisions::sentences(report));
    sentences
}

fn of_measurand(report: &Report<'_>, measurand: usize) -> String {
    let result = &report.evaluation.results[measurand];
    let conventions = &report.budget.conventions;
    let Some(reported) = report.evaluation.reported(measurand, conventions) else {
        return String::new();
    };
    let subject = Subject::new(report, measurand, reported);
    match (reported.basis, &result.monte_carlo) {
        (Basis::MonteCarlo, Some(monte_carlo)) => subject.monte_carlo_sentence(monte_carlo),
        _ => subject.gum_sentence(
            result.gum.estimate,
            result.gum.u,
            &result.gum.coverage,
            &result.gum.freedom,
        ),
    }
}

/// What a sentence about one measurand needs.
struct Subject<'a> {
    report: &'a Report<'a>,
    reported: Reported,
    name: &'a str,
    unit: &'a Unit,
    conventions: &'a Conventions,
    language: Language,
}

impl<'a> Subject<'a> {
    fn new(report: &'a Report<'a>, measurand: usize, reported: Reported) -> Self {
        let (name, unit) = report.measurand(measurand);
        Subject {
            report,
            reported,
            name,
            unit,
            conventions: &report.budget.conventions,
            language: report.language,
        }
    }

    /// Without a probability, the coverage factor has to be beside U.
    fn form(&self) -> StatementForm {
        match self.conventions.state_probability {
            true => self.conventions.statement,
            false => StatementForm::Apart,
        }
    }

    fn gum_sentence(&self, estimate: f64, u: f64, coverage: &Coverage, dof: &Freedom) -> String {
        let ReportedUncertainty::Multiple { expanded, .. } = self.reported.uncertainty else {
            return self.without_uncertainty(estimate);
        };
        let pair = self.conventions.rounding_rule().align(estimate, expanded);
        let u = self.small(u);
        let k = self.factor(coverage);
        match self.form() {
            StatementForm::PlusMinus => {
                let space = self.language.pick(" ", "");
                format!(
                    "{}{space}{}",
                    self.equation(&pair),
                    self.explained(&self.amount(&pair.uncertainty), &u, &k, coverage, dof)
                )
            }
            StatementForm::Apart => self.apart(&pair, &u, &k, coverage, dof),
        }
    }

    /// `I = (9.9990 ± 0.0017) mA.`
    fn equation(&self, pair: &Rounded) -> String {
        format!(
            "{} = {}{}",
            self.name,
            pair.plus_minus_unit(&symbol(self.unit), STYLE),
            self.language.pick(".", "。")
        )
    }

    fn explained(
        &self,
        expanded: &str,
        u: &str,
        k: &str,
        coverage: &Coverage,
        dof: &Freedom,
    ) -> String {
        let reason = self.reason(k, coverage, dof);
        match self.language {
            Language::English => format!(
                "The number after ± is the expanded uncertainty U = {expanded}, the combined standard uncertainty u_c = {u} times the coverage factor k = {k}{reason}."
            ),
            Language::Chinese => format!(
                "其中 ± 号后的数为扩展不确定度 U = {expanded}，由合成标准不确定度 u_c = {u} 乘以包含因子 k = {k} 得到{reason}。"
            ),
        }
    }

    /// Why k has this value, and what it covers.
    fn reason(&self, k: &str, coverage: &Coverage, dof: &Freedom) -> String {
        let p = match self.reported.probability {
            StatedProbability::Of(p) => probability(p),
            StatedProbability::Unnamed => return String::new(),
            StatedProbability::Refuted => {
                let words = self.language.pick(
                    ", a fixed factor, for which no coverage probability is stated",
                    "；k 取约定值，不注明包含概率",
                );
                return words.to_string();
            }
        };
        match (&coverage.basis, self.language) {
            (CoverageBasis::Normal, Language::English) => {
                format!(
                    ", which for a normal distribution corresponds to a coverage probability of about {p}"
                )
            }
            (CoverageBasis::Normal, Language::Chinese) => {
                format!("；对于正态分布，包含概率约为 {p}")
            }
            (CoverageBasis::StudentT { dof: used }, Language::English) => format!(
                ", which for a t-distribution with ν_eff {} effective degrees of freedom corresponds to a coverage probability of about {p}",
                shown_freedom(*used, dof),
            ),
            (CoverageBasis::StudentT { dof: used }, Language::Chinese) => {
                format!(
                    "；按有效自由度 ν_eff {} 的 t 分布，包含概率约为 {p}",
                    shown_freedom(*used, dof)
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
    fn apart(
        &self,
        pair: &Rounded,
        u: &str,
        k: &str,
        coverage: &Coverage,
        dof: &Freedom,
    ) -> String {
        let name = self.name;
        let (y, expanded) = (self.value(&pair.estimate), self.amount(&pair.uncertainty));
        let index = match self.reported.probability {
            StatedProbability::Of(p) => format!("_{}", probability(p).trim_end_matches(" %")),
            _ => String::new(),
        };
        let nu = match &coverage.basis {
            CoverageBasis::StudentT { dof: used } => {
                format!(", ν_eff {}", shown_freedom(*used, dof))
            }
            _ => String::new(),
        };
        let shape = match (&coverage.basis, self.language) {
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
        match self.language {
            Language::English => format!(
                "{name} = {y}; U{index} = {expanded}, k{index} = {k}{nu}. The expanded uncertainty is the combined standard uncertainty u_c = {u} multiplied by the coverage factor.{shape}"
            ),
            Language::Chinese => format!(
                "{name} = {y}；U{index} = {expanded}，k{index} = {k}{}。扩展不确定度由合成标准不确定度 u_c = {u} 乘以包含因子得到。{shape}",
                nu.replace(", ", "，"),
            ),
        }
    }

    /// k as the profile states it: a fixed one as it was given, others to two decimals.
    fn factor(&self, coverage: &Coverage) -> String {
        match (&coverage.basis, self.conventions.coverage_factor) {
            (CoverageBasis::Fixed, CoverageRule::Fixed(k)) => exact(k),
            _ => two_decimals(coverage.k),
        }
    }

    /// A result of Monte Carlo: y ± U where the interval is symmetric about y, else the interval.
    fn monte_carlo_sentence(&self, monte_carlo: &MonteCarlo) -> String {
        let Reported { estimate, u, .. } = self.reported;
        match (self.reported.uncertainty, u) {
            (ReportedUncertainty::Multiple { k, .. }, Some(u)) => {
                self.fixed_multiple(estimate, u, k)
            }
            (ReportedUncertainty::HalfWidth { expanded }, Some(u)) => {
                self.half_interval(estimate, u, expanded)
            }
            (ReportedUncertainty::HalfWidth { expanded }, None) => {
                self.half_interval_alone(monte_carlo, expanded)
            }
            (ReportedUncertainty::Interval { ends, kind }, _) => self.interval(ends, kind),
            _ => self.without_uncertainty(estimate),
        }
    }

    /// y and U = half the width of the interval where the distribution has no standard deviation, hence
    /// no k: a few readings.
    fn half_interval_alone(&self, monte_carlo: &MonteCarlo, half: f64) -> String {
        let rule = self.conventions.rounding_rule();
        let pair = rule.align(monte_carlo.centre(), half);
        let p = probability(self.report.coverage_probability());
        let expanded = self.amount(&pair.uncertainty);
        let trials = self.trials();
        let median = monte_carlo.estimate.is_none();
        let (name, y) = (self.name, self.value(&pair.estimate));
        let index = p.trim_end_matches(" %");
        let which = match (median, self.language) {
            (true, Language::English) => " The estimate is the median.",
            (true, Language::Chinese) => "估计值为中位数。",
            (false, _) => "",
        };
        match self.language {
            Language::English => {
                let head = match self.form() {
                    StatementForm::PlusMinus => format!(
                        "{} The number after ± is the expanded uncertainty U = {expanded},",
                        self.equation(&pair)
                    ),
                    StatementForm::Apart => {
                        format!("{name} = {y}; U_{index} = {expanded}. The expanded uncertainty is")
                    }
                };
                format!(
                    "{head} half the width of the {p} coverage interval found by the Monte Carlo method (JCGM 101, {trials} trials).{which} No standard uncertainty and no coverage factor are stated, because the distribution of the result has no standard deviation."
                )
            }
            Language::Chinese => {
                let head = match self.form() {
                    StatementForm::PlusMinus => format!(
                        "{}其中 ± 号后的数为扩展不确定度 U = {expanded}，即",
                        self.equation(&pair)
                    ),
                    StatementForm::Apart => {
                        format!("{name} = {y}；U_{index} = {expanded}。扩展不确定度为")
                    }
                };
                format!(
                    "{head}蒙特卡洛法（JJF 1059.2，{trials} 次试验）所得 {p} 包含区间的半宽。{which}该分布的标准差不存在，故不给出标准不确定度和包含因子。"
                )
            }
        }
    }

    /// y and U = k·u with the u of Monte Carlo, where the profile fixes k and names no probability.
    fn fixed_multiple(&self, estimate: f64, u: f64, k: f64) -> String {
        let pair = self.conventions.rounding_rule().align(estimate, k * u);
        let (name, y) = (self.name, self.value(&pair.estimate));
        let (expanded, u) = (self.amount(&pair.uncertainty), self.small(u));
        let (k, trials) = (exact(k), self.trials());
        match self.language {
            Language::English => format!(
                "{name} = {y}; U = {expanded}, k = {k}. The expanded uncertainty is the standard uncertainty u = {u}, found by the Monte Carlo method (JCGM 101, {trials} trials), multiplied by the coverage factor. The result of the GUM method was not validated against it."
            ),
            Language::Chinese => format!(
                "{name} = {y}；U = {expanded}，k = {k}。扩展不确定度由蒙特卡洛法（JJF 1059.2，{trials} 次试验）所得的标准不确定度 u = {u} 乘以包含因子得到。GUM 法的结果未通过其验证。"
            ),
        }
    }

    /// y and U = half the width of the Monte Carlo interval, with the k that this implies.
    fn half_interval(&self, estimate: f64, u: f64, half: f64) -> String {
        let pair = self.conventions.rounding_rule().align(estimate, half);
        let p = probability(self.report.coverage_probability());
        let k = two_decimals(half / u);
        let (expanded, u) = (self.amount(&pair.uncertainty), self.small(u));
        let trials = self.trials();
        match (self.form(), self.language) {
            (StatementForm::PlusMinus, Language::English) => format!(
                "{} The number after ± is the expanded uncertainty U = {expanded}, half the width of the {p} coverage interval found by the Monte Carlo method (JCGM 101, {trials} trials); with the standard uncertainty u = {u} this is a coverage factor k = U/u = {k}. The result of the GUM method was not validated against it.",
                self.equation(&pair)
            ),
            (StatementForm::PlusMinus, Language::Chinese) => format!(
                "{}其中 ± 号后的数为扩展不确定度 U = {expanded}，即蒙特卡洛法（JJF 1059.2，{trials} 次试验）所得 {p} 包含区间的半宽；标准不确定度 u = {u}，相应的包含因子 k = U/u = {k}。GUM 法的结果未通过其验证。",
                self.equation(&pair)
            ),
            (StatementForm::Apart, language) => {
                let (name, y) = (self.name, self.value(&pair.estimate));
                let index = p.trim_end_matches(" %");
                match language {
                    Language::English => format!(
                        "{name} = {y}; U_{index} = {expanded}, k_{index} = {k}. The expanded uncertainty is half the width of the {p} coverage interval found by the Monte Carlo method (JCGM 101, {trials} trials), with the standard uncertainty u = {u}. The result of the GUM method was not validated against it."
                    ),
                    Language::Chinese => format!(
                        "{name} = {y}；U_{index} = {expanded}，k_{index} = {k}。扩展不确定度为蒙特卡洛法（JJF 1059.2，{trials} 次试验）所得 {p} 包含区间的半宽，标准不确定度 u = {u}。GUM 法的结果未通过其验证。"
                    ),
                }
            }
        }
    }

    /// Trials of the run.
    fn trials(&self) -> String {
        let run = self.report.evaluation.run.as_ref();
        grouped(run.map_or(0, |run| run.trials))
    }

    fn interval(&self, interval: [f64; 2], kind: IntervalKind) -> String {
        let p = probability(self.report.coverage_probability());
        let which = match kind {
            IntervalKind::Shortest => self.language.pick("shortest", "最短"),
            IntervalKind::Symmetric => {
                let symmetric = "probabilistically symmetric";
                self.language.pick(symmetric, "概率对称")
            }
        };
        let Reported { estimate, u, .. } = self.reported;
        let scale = u.unwrap_or((interval[1] - interval[0]) / 4.0);
        let rule = self.conventions.rounding_rule();
        let pair = rule.align(estimate, scale);
        let [low, high] = interval.map(|end| self.value(&rule.to_place_of(&pair, end)));
        let value = self.value(&pair.estimate);
        let trials = self.trials();
        let name = self.name;
        match (u, self.language) {
            (Some(_), Language::English) => format!(
                "{name}: estimate {value}, standard uncertainty u = {u}, {which} {p} coverage interval from {low} to {high}. These figures were found by the Monte Carlo method (JCGM 101) with {trials} trials, against which the result of the GUM method could not be validated.",
                u = self.amount(&pair.uncertainty),
            ),
            (Some(_), Language::Chinese) => format!(
                "{name}：估计值 {value}，标准不确定度 u = {u}，包含概率 {p} 的{which}包含区间为 {low} 至 {high}。以上结果由蒙特卡洛法（JJF 1059.2，{trials} 次试验）得到，GUM 法的结果未通过其验证。",
                u = self.amount(&pair.uncertainty),
            ),
            (None, Language::English) => format!(
                "{name}: median {value}, {which} {p} coverage interval from {low} to {high}, found by the Monte Carlo method with {trials} trials. No standard uncertainty is stated, because the distribution of the result has none."
            ),
            (None, Language::Chinese) => format!(
                "{name}：中位数 {value}，包含概率 {p} 的{which}包含区间为 {low} 至 {high}，由蒙特卡洛法（{trials} 次试验）得到。该分布的标准差不存在，故不给出标准不确定度。"
            ),
        }
    }

    fn without_uncertainty(&self, estimate: f64) -> String {
        let value = with_unit(&exact(estimate), &symbol(self.unit));
        match self.language {
            Language::English => format!(
                "{} = {value}. No uncertainty can be stated: the evaluation gives none.",
                self.name
            ),
            Language::Chinese => format!(
                "{} = {value}。本评定未得到不确定度，无法给出扩展不确定度。",
                self.name
            ),
        }
    }

    /// A value of the measurand with its unit.
    fn value(&self, number: &Decimal) -> String {
        with_unit(&print(number), &symbol(self.unit))
    }

    /// A lone uncertainty with its unit.
    fn amount(&self, number: &Decimal) -> String {
        with_unit(&print(number), &difference_symbol(self.unit))
    }

    /// A standard uncertainty beside U: two digits whatever the profile says about U.
    fn small(&self, u: f64) -> String {
        with_unit(&significant(u, 2), &difference_symbol(self.unit))
    }
}

/// ν as it was used for k; a lower bound where ν_eff is not defined.
fn shown_freedom(used: f64, found: &Freedom) -> String {
    let relation = if matches!(found, Freedom::Refused { .. }) {
        "≥"
    } else {
        "="
    };
    format!("{relation} {}", freedom(used))
}

fn two_decimals(k: f64) -> String {
    print(&at_place(k, -2))
}

fn with_unit(number: &str, unit: &str) -> String {
    match unit {
        "" => number.to_string(),
        _ => format!("{number}{}{unit}", space_before(unit)),
    }
}

fn correlations(report: &Report<'_>) -> Option<String> {
    let joint = report.evaluation.joint.as_ref()?;
    let from_trials = report
        .evaluation
        .results
        .iter()
        .any(|r| r.basis == Basis::MonteCarlo);
    let matrix = match &joint.monte_carlo_correlation {
        Some(matrix) if from_trials => matrix,
        _ => &joint.correlation,
    };
    let n = report.evaluation.results.len();
    let mut pairs = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            if let Some(r) = matrix.get((i, j)) {
                pairs.push(format!(
                    "r({}, {}) = {}",
                    report.measurand(i).0,
                    report.measurand(j).0,
                    coefficient(*r)
                ));
            }
        }
    }
    /// More pairs belong in a table.
    const MOST: usize = 10;
    if pairs.is_empty() {
        return None;
    }
    if pairs.len() > MOST {
        return Some(match report.language {
            Language::English => "The estimates are correlated; the correlation coefficients are given in the table of the joint result.".to_string(),
            Language::Chinese => "各估计值相关，相关系数见联合结果表。".to_string(),
        });
    }
    Some(match report.language {
        Language::English => format!("Correlation of the estimates: {}.", pairs.join(", ")),
        Language::Chinese => format!("各估计值之间的相关系数：{}。", pairs.join("，")),
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
        at_place(r, place).print_plain(STYLE)
    } else {
        NONE.to_string()
    }
}
