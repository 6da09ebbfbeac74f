//! Why a result has no mean or no standard deviation, and what few readings do, as sentences.

use gumption_core::special::student_t_two_sided_quantile;
use gumption_core::statistics::relative_scatter_of_s;
use gumption_gum::budget::CoverageRule;
use gumption_gum::propagate::{
    Consequence, CoverageBasis, FewReadings, MeasurandResult, MissingMoments, Reason, Side,
};

use super::Report;
use super::language::Language;
use super::number::{exact, freedom, print, probability, significant};

/// In English, with what to do.
pub(super) fn in_english(reason: &MissingMoments) -> String {
    let given = match reason.leave_a_mean() {
        true => "Monte Carlo gives mean and coverage interval, and no u.",
        false => "Monte Carlo gives median and coverage interval instead.",
    };
    match reason {
        MissingMoments::HeavyComponent { name, dof, power } => {
            let missing = if reason.leave_a_mean() {
                "no standard deviation"
            } else {
                "neither a mean nor a standard deviation"
            };
            let degrees = if *dof == 1.0 { "degree" } else { "degrees" };
            let grows = match is_first(*power) {
                true => "follows it in proportion".to_string(),
                false => format!("grows like its power {}", exponent(*power)),
            };
            format!(
                "The distribution of the output has {missing}: `{name}` has a t-distribution with {nu} {degrees} of freedom, which has moments of order below {nu} only, and the output {grows} as far as the trials reach. {given} More readings behind `{name}` would help; a standard deviation exists above {} degrees of freedom.",
                exponent(2.0 * power),
                nu = freedom(*dof),
            )
        }
        MissingMoments::JointReadings { inputs, readings } => {
            let (n, many) = (readings, inputs.len());
            let names = Language::English.list(inputs);
            let missing = if reason.leave_a_mean() {
                "no standard deviation"
            } else {
                "neither a mean nor a standard deviation"
            };
            format!(
                "The distribution of the output has {missing}: {n} simultaneous readings of {many} inputs ({names}) leave ν = n − N = {n} − {many} = {} for their multivariate t-distribution in Monte Carlo (JCGM 102, 5.3.2), which has no standard deviation for ν ≤ 2. {given} More simultaneous readings would help; a standard deviation exists from {} on.",
                n - many.min(*n),
                many + 3
            )
        }
        MissingMoments::Tail {
            side,
            index,
            consequence,
        } => {
            let side = match side {
                Side::Lower => "lower",
                Side::Upper => "upper",
            };
            let then = match consequence {
                Consequence::NoMean => "neither mean nor standard deviation exists",
                Consequence::SlowMean => {
                    "the mean does not settle and the standard deviation does not exist"
                }
                Consequence::NoDeviation => "the standard deviation does not exist",
                Consequence::SlowDeviation => {
                    "the standard deviation does not settle: ten times the trials would not halve its error"
                }
            };
            format!(
                "The {side} tail of the Monte Carlo trials falls off like the power −{} of the distance from the median, so that {then}. {given} Check whether an input with very few degrees of freedom, or a divisor that may be zero, is meant.",
                exponent(*index)
            )
        }
        MissingMoments::FewTrials { relative_error } => format!(
            "A handful of far trials decides the standard deviation of the Monte Carlo result (its own relative standard error is {} %), so that another seed would give another u. {given} Check whether a divisor comes close to zero, or an input has very few degrees of freedom.",
            percent(*relative_error)
        ),
    }
}

/// In Chinese.
pub(super) fn in_chinese(reason: &MissingMoments) -> String {
    let given = match reason.leave_a_mean() {
        true => "因此蒙特卡洛法给出均值和包含区间，不给出标准不确定度。",
        false => "因此蒙特卡洛法给出中位数和包含区间。",
    };
    match reason {
        MissingMoments::HeavyComponent { name, dof, power } => {
            let missing = if reason.leave_a_mean() {
                "标准差不存在"
            } else {
                "均值和标准差均不存在"
            };
            let grows = match is_first(*power) {
                true => "与之成比例".to_string(),
                false => format!("按其 {} 次幂增长", exponent(*power)),
            };
            format!(
                "输出量分布的{missing}：`{name}` 服从自由度为 {nu} 的 t 分布，该分布只有阶数小于 {nu} 的矩，而在试验值所及范围内输出量{grows}。{given}增加 `{name}` 的测量次数可改善；自由度大于 {} 时标准差才存在。",
                exponent(2.0 * power),
                nu = freedom(*dof),
            )
        }
        MissingMoments::JointReadings { inputs, readings } => {
            let (n, many) = (readings, inputs.len());
            let names = Language::Chinese.list(inputs);
            let missing = if reason.leave_a_mean() {
                "标准差不存在"
            } else {
                "均值和标准差均不存在"
            };
            format!(
                "输出量分布的{missing}：{many} 个输入量（{names}）同时重复测量 {n} 次，蒙特卡洛法所用的多元 t 分布的自由度为 ν = n − N = {n} − {many} = {}（JCGM 102 的 5.3.2），ν ≤ 2 时其标准差不存在。{given}增加同时测量的次数可改善；不少于 {} 次时标准差才存在。",
                n - many.min(*n),
                many + 3
            )
        }
        MissingMoments::Tail {
            side,
            index,
            consequence,
        } => {
            let side = match side {
                Side::Lower => "下侧",
                Side::Upper => "上侧",
            };
            let then = match consequence {
                Consequence::NoMean => "均值和标准差均不存在",
                Consequence::SlowMean => "均值不收敛，标准差不存在",
                Consequence::NoDeviation => "标准差不存在",
                Consequence::SlowDeviation => "标准差不收敛（试验次数增至十倍，其误差也不能减半）",
            };
            format!(
                "蒙特卡洛试验值分布的{side}尾部按与中位数之距的 −{} 次幂衰减，{then}，{given}请检查是否有自由度极小的输入量，或可能为零的除数。",
                exponent(*index)
            )
        }
        MissingMoments::FewTrials { relative_error } => format!(
            "蒙特卡洛结果的标准差由少数远离中心的试验决定（其自身的相对标准误差为 {} %），更换种子将得到不同的 u，{given}请检查除数是否可能接近零，或输入量的自由度是否过小。",
            percent(*relative_error)
        ),
    }
}

/// What few readings do: to ν_eff, where that is small, and to Monte Carlo; and what the statement makes of it.
pub(super) fn few_readings(
    report: &Report<'_>,
    measurand: Option<usize>,
    (components, dof): (&[FewReadings], Option<f64>),
) -> String {
    let l = report.language;
    let wider = |few: &FewReadings| {
        let (name, nu) = (&few.component, freedom(few.dof));
        match few.dof > 2.0 {
            true => {
                let times = significant((few.dof / (few.dof - 2.0)).sqrt(), 3);
                l.pick(
                    format!("`{name}` has ν = {nu}, and that is {times} times u"),
                    format!("`{name}` 的自由度为 {nu}，标准差为 u 的 {times} 倍"),
                )
            }
            false => l.pick(
                format!("`{name}` has ν = {nu}, for which there is none (it exists for ν > 2)"),
                format!("`{name}` 的自由度为 {nu}，标准差不存在（自由度大于 2 时才存在）"),
            ),
        }
    };
    let named: Vec<String> = components.iter().map(wider).collect();
    let drawn = l.pick(
        format!(
            "Monte Carlo draws from a t-distribution (JCGM 101, 6.4.9), whose standard deviation is larger than u: {}.",
            Language::English.list(&named)
        ),
        format!(
            "蒙特卡洛法取 t 分布（JCGM 101 的 6.4.9），其标准差大于 u：{}。",
            named.join("；")
        ),
    );
    let result = measurand.and_then(|m| report.evaluation.results.get(m));
    let reason = result.map(|result| result.reported(&report.budget.conventions).reason);
    let refuted = reason.map_or_else(String::new, |reason| of_reason(report, reason));
    let space = l.pick(" ", "");
    let parts = match (dof, result) {
        (Some(dof), _) => [few_degrees(report, measurand, dof), drawn, refuted],
        (None, result) => {
            let few = l.pick("Few degrees of freedom:", "自由度小：");
            let factor = result.filter(|_| refuted.is_empty());
            let follows = factor.map_or(refuted, |result| of_factor(report, result, components));
            let more = l.pick(
                "More readings would bring both together.",
                "增加测量次数可使两者接近。",
            );
            [format!("{few}{space}{drawn}"), follows, more.to_string()]
        }
    };
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    parts.join(space)
}

/// What the reason why the statement takes its method has to do with few readings; nothing where another finding tells
/// the reason, or the factor k tells it.
fn of_reason(report: &Report<'_>, reason: Reason) -> String {
    let l = report.language;
    let p = probability(report.coverage_probability());
    match reason {
        Reason::FewReadings => l.pick(
            format!("The {p} interval of Monte Carlo therefore differs from that of the GUM by more than the tolerance δ (clause 8), while the statement is u itself (GUM 4.2.3) times the k of the profile. Take the Monte Carlo interval wherever a {p} interval is needed."),
            format!("因此蒙特卡洛法与 GUM 法的 {p} 包含区间之差超过数值容差 δ（JJF 1059.2、JCGM 101 第 8 章），而证书用语为 u 本身（GUM 4.2.3）乘以规范的 k。需要 {p} 包含区间时，应取蒙特卡洛法的区间。"),
        ),
        Reason::NotNegative => l.pick(
            "The statement takes the interval of ISO 11929, which rests on u itself (GUM 4.2.3).".to_string(),
            "证书用语采用 ISO 11929 的区间，该区间由 u 本身（GUM 4.2.3）得到。".to_string(),
        ),
        _ => String::new(),
    }
}

/// Whether the k of the GUM result that the statement takes allows for few degrees of freedom: that follows from how k
/// was made.
fn of_factor(report: &Report<'_>, result: &MeasurandResult, components: &[FewReadings]) -> String {
    let l = report.language;
    let reported = result.reported(&report.budget.conventions);
    // Where clause 8 refutes the GUM, the finding about that tells what is taken.
    if !matches!(
        reported.reason,
        Reason::NotChecked | Reason::Validated | Reason::Undecided
    ) {
        return String::new();
    }
    let coverage = &result.gum.coverage;
    let of_u = percent(components.iter().map(|few| few.share).sum());
    let k = exact(coverage.k);
    match &coverage.basis {
        CoverageBasis::StudentT { .. } => l.pick(
            "The statement takes the GUM result, whose k from the t-distribution allows for the few degrees of freedom.".to_string(),
            "证书用语采用 GUM 法的结果，其 k 按 t 分布取值，已考虑自由度小的影响。".to_string(),
        ),
        CoverageBasis::Fixed => l.pick(
            format!("The statement takes the GUM result, whose k = {k} is fixed whatever the degrees of freedom; they are {of_u} % of u²."),
            format!("证书用语采用 GUM 法的结果，其 k = {k} 为约定值，不随自由度改变；这些分量占 u² 的 {of_u} %。"),
        ),
        CoverageBasis::Normal => l.pick(
            format!("The statement takes the GUM result, whose k is that of a normal distribution; they are {of_u} % of u²."),
            format!("证书用语采用 GUM 法的结果，其 k 按正态分布取值；这些分量占 u² 的 {of_u} %。"),
        ),
        CoverageBasis::Output { .. } => l.pick(
            format!("The statement takes the GUM result, whose k comes from the components that dominate; they are {of_u} % of u²."),
            format!("证书用语采用 GUM 法的结果，其 k 由占优势的分量确定；这些分量占 u² 的 {of_u} %。"),
        ),
    }
}

/// Only few effective degrees of freedom, and whether k allows for them.
pub(super) fn few_degrees(report: &Report<'_>, measurand: Option<usize>, dof: f64) -> String {
    let l = report.language;
    let of_u = percent(relative_scatter_of_s(dof));
    let rule = report.budget.conventions.degrees_of_freedom;
    let (nu, entered) = (freedom(dof), rule.entered(dof));
    let degrees = if dof == 1.0 { "degree" } else { "degrees" };
    // What stands beside k is the ν that gave it.
    let (cut_en, cut_zh) = match freedom(entered) {
        same if same == nu => (String::new(), String::new()),
        cut => (
            format!(" (for k they are cut to {cut}, GUM G.4.1)"),
            format!("（求 k 时舍去小数取 {cut}，GUM G.4.1）"),
        ),
    };
    let first = l.pick(
        format!(
            "Only {nu} effective {degrees} of freedom{cut_en}: u itself is uncertain by about {of_u} %"
        ),
        format!("有效自由度仅为 {nu}{cut_zh}：标准不确定度本身的相对不确定度约为 {of_u} %"),
    );
    let Some(result) = measurand.and_then(|m| report.evaluation.results.get(m)) else {
        return first;
    };
    let coverage = &result.gum.coverage;
    let p = report.coverage_probability();
    let of_t = significant(student_t_two_sided_quantile(p, entered), 3);
    let p = probability(p);
    match (&coverage.basis, report.budget.conventions.coverage_factor) {
        (CoverageBasis::StudentT { .. }, _) => l.pick(
            format!("{first}, for which a k from the t-distribution allows. More readings of the dominant input would lower U."),
            format!("{first}，按 t 分布取包含因子时已考虑这一点。增加主要输入量的重复测量次数可减小 U。"),
        ),
        (CoverageBasis::Fixed, _) | (CoverageBasis::Normal, CoverageRule::Normal) => {
            let k = match report.budget.conventions.coverage_factor {
                CoverageRule::Fixed(k) => exact(k),
                _ => significant(coverage.k, 3),
            };
            l.pick(
                format!("{first}. k = {k} makes no allowance for that; for {p} that of the t-distribution is {of_t}. More readings of the dominant input would help; coverage_factor_from = \"t\" in [conventions] takes the k of the t-distribution."),
                format!("{first}。k = {k} 未考虑这一点；p = {p} 时按 t 分布为 {of_t}。可增加主要输入量的重复测量次数，或在 [conventions] 中写 coverage_factor_from = \"t\"，按 t 分布取 k。"),
            )
        }
        (CoverageBasis::Normal | CoverageBasis::Output { .. }, _) => l.pick(
            format!("{first}. k, from the distribution of the result, makes no allowance for that; for {p} that of the t-distribution is {of_t}. More readings would help."),
            format!("{first}。由输出量分布所得的 k 未考虑这一点；p = {p} 时按 t 分布为 {of_t}。增加重复测量次数可改善。"),
        ),
    }
}

/// Whether a power is the first, within what it is known to.
fn is_first(power: f64) -> bool {
    (power - 1.0).abs() < 0.05
}

/// A tail index is known to one decimal at best.
fn exponent(index: f64) -> String {
    print(&super::number::at_place(index, -1))
}

/// A fraction in percent, to the nearest whole number.
fn percent(fraction: f64) -> String {
    format!("{:.0}", 100.0 * fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_few_simultaneous_readings_are_counted() {
        let reason = |readings| MissingMoments::JointReadings {
            inputs: ["V", "I", "phi"].map(String::from).to_vec(),
            readings,
        };
        let five = in_english(&reason(5));
        assert!(five.contains("has no standard deviation: 5 simultaneous readings of 3 inputs (V, I and phi) leave ν = n − N = 5 − 3 = 2"), "{five}");
        assert!(five.contains("from 6 on"), "{five}");
        assert!(in_english(&reason(4)).contains("neither a mean nor"));
    }

    #[test]
    fn chinese_is_chinese() {
        let tail = |consequence| MissingMoments::Tail {
            side: Side::Lower,
            index: 1.04,
            consequence,
        };
        for consequence in [
            Consequence::NoMean,
            Consequence::SlowMean,
            Consequence::NoDeviation,
            Consequence::SlowDeviation,
        ] {
            let sentence = in_chinese(&tail(consequence));
            assert!(sentence.contains("−1.0 次幂"), "{sentence}");
            assert!(
                !sentence.contains(|c: char| c.is_ascii_alphabetic()),
                "{sentence}"
            );
        }
    }
}
