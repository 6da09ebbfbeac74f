//! Findings as sentences: what was found, what follows from it, what to do.

use gumption_format::document::{Finding as Remark, Severity};
use gumption_gum::budget::FitDoubt;
use gumption_gum::propagate::{EvaluationError, FindingKind, Reason, is_residue};

use super::fits::{doubtful_fit, test_figures};
use super::language::Language;
use super::number::{aligned, exact, freedom, grouped, probability, significant};
use super::{Report, meant, moments};

/// All findings and the budget's remarks, each one paragraph; what is found alike of several
/// measurands stands once.
pub(super) fn remarks(report: &Report<'_>) -> Vec<Remark> {
    let l = report.language;
    let several = report.evaluation.results.len() > 1;
    let mut found: Vec<(Remark, Vec<String>)> = Vec::new();
    for finding in &report.evaluation.findings {
        let remark = Remark {
            id: code(&finding.kind).to_string(),
            severity: finding.kind.severity(),
            text: finding_sentence(report, finding.measurand, &finding.kind),
        };
        let name = finding
            .measurand
            .filter(|_| several)
            .map(|m| report.measurand(m).0.to_string());
        match found.iter_mut().find(|(known, _)| *known == remark) {
            Some((_, names)) => names.extend(name),
            None => found.push((remark, Vec::from_iter(name))),
        }
    }
    let findings = found.into_iter().map(|(mut remark, names)| {
        if !names.is_empty() {
            let (names, text) = (l.list(&names), &remark.text);
            remark.text = l.pick(format!("{names}: {text}"), format!("{names}：{text}"));
        }
        remark
    });
    let of_budget = report.budget.remarks.iter().map(|remark| Remark {
        id: REMARK.to_string(),
        severity: Severity::Note,
        text: l.pick(&remark.en, &remark.zh).clone(),
    });
    findings.chain(of_budget).collect()
}

/// What remarks of the budget are called, for machines.
pub(super) const REMARK: &str = "remark";

/// A stable name of the kind, for machines.
pub(super) fn code(kind: &FindingKind) -> &'static str {
    match kind {
        FindingKind::VanishingSensitivity { .. } => "vanishing_sensitivity",
        FindingKind::SecondOrderMatters { .. } => "second_order_matters",
        FindingKind::NotValidated => "not_validated",
        FindingKind::Undecided { .. } => "undecided",
        FindingKind::NeedsMonteCarlo => "needs_monte_carlo",
        FindingKind::TrialsUnresolved { .. } => "trials_unresolved",
        FindingKind::SlopesUnresolved => "slopes_unresolved",
        FindingKind::Cancelled => "cancelled",
        FindingKind::MomentsMissing { .. } => "moments_missing",
        FindingKind::FewReadings { .. } => "few_readings",
        FindingKind::FailedTrials { .. } => "failed_trials",
        FindingKind::NotConverged { .. } => "not_converged",
        FindingKind::FreedomRefused { .. } => "freedom_refused",
        FindingKind::FewDegreesOfFreedom { .. } => "few_degrees_of_freedom",
        FindingKind::Irregular { .. } => "irregular",
        FindingKind::NearSingular { .. } => "near_singular",
        FindingKind::PhaseWraps { .. } => "phase_wraps",
        FindingKind::PhaseUnknown { .. } => "phase_unknown",
        FindingKind::Unseen { .. } => "unseen",
        FindingKind::LargeUncertainty { .. } => "large_uncertainty",
        FindingKind::BelowReference { .. } => "below_reference",
        FindingKind::ErrorMeant { .. } => "error_meant",
        FindingKind::IndicationMeant { .. } => "indication_meant",
        FindingKind::CoarseStep { .. } => "coarse_step",
        FindingKind::Extrapolated { .. } => "extrapolated",
        FindingKind::LackOfFit { .. } => "lack_of_fit",
        FindingKind::ResidualsTooSmall { .. } => "residuals_too_small",
        FindingKind::ExactFit { .. } => "exact_fit",
        FindingKind::DoubtfulFit { doubt, .. } => match doubt {
            FitDoubt::Pattern { .. } => "residual_pattern",
            FitDoubt::Pole { .. } => "pole_between_points",
            FitDoubt::BetterMinimum { .. } => "better_minimum",
        },
        FindingKind::Asymmetric => "asymmetric",
    }
}

/// One finding in the report's language.
pub(super) fn finding_sentence(
    report: &Report<'_>,
    measurand: Option<usize>,
    kind: &FindingKind,
) -> String {
    match report.language {
        Language::English => english(report, measurand, kind),
        Language::Chinese => chinese(report, measurand, kind),
    }
}

fn english(report: &Report<'_>, measurand: Option<usize>, kind: &FindingKind) -> String {
    match kind {
        FindingKind::VanishingSensitivity { inputs, shift, u_effect } => {
            unseen_in_english(report, measurand, (inputs, *shift, *u_effect))
        }
        FindingKind::SecondOrderMatters { shift, u_first, u_second } => format!(
            "The model is noticeably nonlinear over the uncertainties of its inputs: second-order terms {} and {}. Do not use the first-order figures alone.",
            match is_residue(*shift, *u_second) {
                true => "leave the estimate as it is".to_string(),
                false => format!("move the estimate by {}", amount(report, measurand, significant(*shift, 2))),
            },
            match (significant(*u_first, 3), significant(*u_second, 3)) {
                (first, second) if first == second => "leave u as it is".to_string(),
                (first, second) => format!("change u from {first} to {}", amount(report, measurand, second)),
            },
        ),
        FindingKind::NotValidated => not_validated_in_english(report, measurand),
        FindingKind::Undecided { trials } => format!(
            "Monte Carlo neither validates nor refutes the GUM result (JCGM 101, clause 8): with so many trials the ends of its interval are not known well enough to compare them to within δ. The statement uses the GUM result. For a verdict set trials to about {}, or take trials = \"adaptive\".",
            grouped(*trials),
        ),
        FindingKind::NeedsMonteCarlo => "First order is doubtful for this budget and Monte Carlo was not run, so nothing checks the result. Run the evaluation with Monte Carlo before using it.".to_string(),
        FindingKind::TrialsUnresolved { error } => format!(
            "The model takes large numbers from one another. The estimate is computed with twice the digits and holds; the trials of Monte Carlo are doubles, which know y only to {}, not to the tolerance of JCGM 101, clause 8. Monte Carlo was left out, and nothing validates the GUM result. For a validation take the common part out of the inputs, and write it as a difference.",
            amount(report, measurand, significant(*error, 2)),
        ),
        FindingKind::SlopesUnresolved => "The sensitivity coefficients are what rounding left of larger numbers: a change of the estimates in their last digits changes u in the digits that are printed. Write the formula so that large terms do not cancel: write it as a difference.".to_string(),
        FindingKind::Cancelled => "The contributions of the inputs cancel and leave u = 0. Trials would scatter by the rounding of the computer alone; they are not used. No measurement is without uncertainty: add what the inputs do not have in common, or state a correlation below 1.".to_string(),
        FindingKind::MomentsMissing { reason } => moments::in_english(reason),
        FindingKind::FewReadings { components, dof } => moments::few_readings(report, measurand, (components, *dof)),
        FindingKind::FailedTrials { failed, trials } => format!(
            "In {} of {} Monte Carlo trials the model had no finite value (for example a division by zero or the root of a negative number). The results leave these trials out. Check whether the distributions of the inputs reach values that are physically impossible.",
            grouped(*failed),
            grouped(*trials),
        ),
        FindingKind::NotConverged { trials } => format!(
            "The adaptive Monte Carlo procedure stopped at its maximum of {} trials before the results were stable to the numerical tolerance asked for. The last digit shown may change with the seed. Raise `max_trials` or ask for fewer digits.",
            grouped(*trials),
        ),
        FindingKind::FreedomRefused { members, lower_bound } => format!(
            "The effective degrees of freedom are not defined, because {} are correlated and have different finite degrees of freedom: the Welch–Satterthwaite formula is for independent terms. k is taken for the smallest of them, ν = {}, which as a rule makes U too large rather than too small. State a common `dof`, or replace the correlation by a shared source.",
            Language::English.list(members),
            freedom(*lower_bound),
        ),
        FindingKind::FewDegreesOfFreedom { dof } => moments::few_degrees(report, measurand, *dof),
        FindingKind::Irregular { what } => format!(
            "The model is not smooth at the estimates: {}. A derivative says little there, so the GUM figures may be wrong. Rely on Monte Carlo.",
            what.english(),
        ),
        FindingKind::NearSingular { what } => format!(
            "The model comes close to a point where it has no value: {}. The output may have very long tails, and neither u nor k then describes it well. Look at the coverage interval, and check the uncertainty of that quantity.",
            what.english(),
        ),
        FindingKind::PhaseWraps { what } => format!(
            "The distribution of a phase reaches the place where phases jump from π to -π: {}. A phase is a point of a circle: every trial is taken on the turn around the estimate, so that estimate, u and interval are those of directions. An end beyond ±π is the direction on the other side of the cut (less or plus a full turn).",
            what.english(),
        ),
        FindingKind::PhaseUnknown { what } => format!(
            "The direction is hardly known: {}, and its distribution reaches all round the circle. Trials are taken on the turn around the estimate; u and interval then say little. Report real and imaginary part (or both components) in place of the phase.",
            what.english(),
        ),
        FindingKind::Unseen { what } => format!(
            "Monte Carlo was not run, and the GUM method does not see that the model changes within the reach of its inputs: {}. Run the evaluation with Monte Carlo before using the result.",
            what.english(),
        ),
        FindingKind::LargeUncertainty { input, ratio } => format!(
            "The uncertainty of {input} contributes {} times as much as all others together. Check its unit, and whether a relative uncertainty is meant.",
            significant(*ratio, 2),
        ),
        FindingKind::BelowReference { component, k, reference } => format!(
            "The expanded uncertainty U is smaller than what {component} alone contributes with the k = {} of its certificate, {}: a result is not known better than its reference. Check k.",
            exact(*k),
            amount(report, measurand, significant(*reference, 2)),
        ),
        FindingKind::ErrorMeant { .. } | FindingKind::IndicationMeant { .. } => meant::sentence(report, measurand, kind),
        FindingKind::CoarseStep { what } => format!(
            "The GUM method replaces a rounding by the straight line through its steps, which leaves out what the rounding does: {}. State the rounding as a component of its own (`step`), or run Monte Carlo, which rounds every trial.",
            what.english(),
        ),
        FindingKind::Extrapolated { what } => format!(
            "A table is used beyond its ends: {}. The last straight line of the table was continued, with no allowance for what the quantity does out there. Extend the table, or add a component for the extrapolation.",
            what.english(),
        ),
        FindingKind::LackOfFit { fit, test } => format!(
            "The curve of the fit {fit} does not describe its data ({}): deviations as large come about in fewer than one of twenty cases if curve and uncertainties are right. The uncertainties of its parameters do not cover that. Look at the residuals for a pattern or a single wrong point; try another formula, or state larger uncertainties of the data.",
            test_figures(Language::English, test),
        ),
        FindingKind::ResidualsTooSmall { fit, test } => format!(
            "The data of the fit {fit} lie closer to the curve than their stated uncertainties let expect ({}). Perhaps these are too large, or contain a part that all points have in common: state that as a component with common = true.",
            test_figures(Language::English, test),
        ),
        FindingKind::DoubtfulFit { fit, doubt } => doubtful_fit(Language::English, fit, doubt),
        FindingKind::ExactFit { fit } => format!(
            "The curve of the fit {fit} passes through all its points, so that the residuals tell no uncertainty of its parameters: they enter as exact. State the uncertainties of the data."
        ),
        FindingKind::Asymmetric => "The distribution of the output is asymmetric, so that the probabilistically symmetric and the shortest coverage interval differ. Do not write the result as estimate ± U; state the interval.".to_string(),
    }
}

fn chinese(report: &Report<'_>, measurand: Option<usize>, kind: &FindingKind) -> String {
    match kind {
        FindingKind::VanishingSensitivity { inputs, shift, u_effect } => {
            unseen_in_chinese(report, measurand, (inputs, *shift, *u_effect))
        }
        FindingKind::SecondOrderMatters { shift, u_first, u_second } => format!(
            "在输入量的不确定度范围内，测量模型的非线性明显：二阶项{}，{}。不应单独使用一阶结果。",
            match is_residue(*shift, *u_second) {
                true => "不改变估计值".to_string(),
                false => format!("使估计值移动 {}", amount(report, measurand, significant(*shift, 2))),
            },
            match (significant(*u_first, 3), significant(*u_second, 3)) {
                (first, second) if first == second => "标准不确定度不变".to_string(),
                (first, second) => format!("标准不确定度由 {first} 变为 {}", amount(report, measurand, second)),
            },
        ),
        FindingKind::NotValidated => not_validated_in_chinese(report, measurand),
        FindingKind::Undecided { trials } => format!(
            "蒙特卡洛法既未验证也未否定 GUM 法的结果（JJF 1059.2、JCGM 101 第 8 章）：按现有试验次数，区间端点的数值误差太大，不足以与数值容差 δ 比较。证书用语采用 GUM 法的结果。如需结论，请将 trials 增至约 {}，或取 trials = \"adaptive\"。",
            grouped(*trials),
        ),
        FindingKind::NeedsMonteCarlo => "一阶近似对本评定是否适用存疑，而蒙特卡洛法未运行，结果没有得到验证。使用前应运行蒙特卡洛法。".to_string(),
        FindingKind::TrialsUnresolved { error } => format!(
            "模型中大数相减。估计值以双倍精度计算，是可靠的；蒙特卡洛试验用双精度数计算，y 只能分辨到 {}，达不到 JCGM 101 第 8 章的数值容差。因此未采用蒙特卡洛法，GUM 结果没有得到验证。如需验证，请把输入量中的公共部分提出，以差值表示。",
            amount(report, measurand, significant(*error, 2)),
        ),
        FindingKind::SlopesUnresolved => "灵敏系数是大数相消后的舍入残余：估计值末位的变动会改变所给 u 的有效数字。请改写公式，避免大数相消，以差值表示。".to_string(),
        FindingKind::Cancelled => "各输入量的贡献完全抵消，u = 0。此时蒙特卡洛试验的分散只反映计算机的舍入，故不采用。测量不可能没有不确定度：请补充各输入量不共有的分量，或给出小于 1 的相关系数。".to_string(),
        FindingKind::MomentsMissing { reason } => moments::in_chinese(reason),
        FindingKind::FewReadings { components, dof } => moments::few_readings(report, measurand, (components, *dof)),
        FindingKind::FailedTrials { failed, trials } => format!(
            "{} 次蒙特卡洛试验中有 {} 次模型没有有限值（例如除以零或对负数开方），这些试验未计入结果。请检查输入量的分布是否包含物理上不可能的值。",
            grouped(*trials),
            grouped(*failed),
        ),
        FindingKind::NotConverged { trials } => format!(
            "自适应蒙特卡洛法达到最大试验次数 {} 时，结果仍未稳定到所要求的数值容差，末位数字可能随随机种子变化。请增大 `max_trials` 或减少要求的位数。",
            grouped(*trials),
        ),
        FindingKind::FreedomRefused { members, lower_bound } => format!(
            "{}相关且自由度（有限）各不相同，韦尔奇-萨特思韦特公式只适用于相互独立的分量，故有效自由度没有定义。k 按其中最小的自由度 ν = {} 取值，所得 U 偏大而不会偏小。请给出共同的 `dof`，或用共同来源代替相关系数。",
            Language::Chinese.list(members),
            freedom(*lower_bound),
        ),
        FindingKind::FewDegreesOfFreedom { dof } => moments::few_degrees(report, measurand, *dof),
        FindingKind::Irregular { what } => format!("测量模型在估计值处不光滑（{}）。此处的导数意义不大，GUM 法的结果可能不正确，应以蒙特卡洛法为准。", what.chinese()),
        FindingKind::NearSingular { what } => format!(
            "测量模型接近无定义的点（{}，u 为该量的标准不确定度）。输出量的分布可能有很长的尾部，标准不确定度和包含因子不能很好地描述它。请看包含区间，并核对该量的不确定度。",
            what.chinese(),
        ),
        FindingKind::PhaseWraps { what } => format!(
            "相位的分布到达由 π 跳变到 -π 之处（{}）。相位是圆周上的点：每次试验都取估计值所在一周内的值，估计值、标准不确定度和区间因而都是方向的。超出 ±π 的端点即跳变另一侧的方向（相差一整周）。",
            what.chinese(),
        ),
        FindingKind::PhaseUnknown { what } => format!(
            "方向几乎未知：{}，其分布遍及整个圆周。试验值取估计值所在一周内的值，此时标准不确定度和区间意义不大。请报告实部和虚部（或两个分量），而不是相位。",
            what.chinese(),
        ),
        FindingKind::Unseen { what } => format!(
            "未运行蒙特卡洛法，而 GUM 法看不到模型在输入量所及范围内的变化：{}。使用结果前应运行蒙特卡洛法。",
            what.chinese(),
        ),
        FindingKind::LargeUncertainty { input, ratio } => format!(
            "{input} 的不确定度的贡献为其余各量合计的 {} 倍。请核对其单位，以及是否应为相对不确定度。",
            significant(*ratio, 2),
        ),
        FindingKind::BelowReference { component, k, reference } => format!(
            "扩展不确定度 U 小于 {component} 单独按其证书 k = {} 的贡献 {}：结果不可能比其标准更准确。请核对 k。",
            exact(*k),
            amount(report, measurand, significant(*reference, 2)),
        ),
        FindingKind::ErrorMeant { .. } | FindingKind::IndicationMeant { .. } => meant::sentence(report, measurand, kind),
        FindingKind::CoarseStep { what } => format!(
            "GUM 法以穿过各台阶的直线代替修约，没有计入修约本身的影响（{}）。请把修约作为一个分量给出（`step`），或运行蒙特卡洛法，它对每次试验值进行修约。",
            what.chinese(),
        ),
        FindingKind::Extrapolated { what } => format!(
            "表的使用超出其范围（{}）。计算时延长了表的最后一段直线，未计入该量在表外变化的影响。请扩展表的范围，或为外推增加一个分量。",
            what.chinese(),
        ),
        FindingKind::LackOfFit { fit, test } => format!(
            "拟合 {fit} 的曲线与数据不符（{}）：若曲线和不确定度正确，出现如此大偏差的机会不到二十分之一。参数的不确定度不包含这一影响。请检查残差是否有规律或个别点有误，改用其他公式，或给出更大的数据不确定度。",
            test_figures(Language::Chinese, test),
        ),
        FindingKind::ResidualsTooSmall { fit, test } => format!(
            "拟合 {fit} 的数据比所给不确定度的预期更接近曲线（{}）。不确定度可能偏大，或含有各点共有的部分：请将该部分写成 common = true 的分量。",
            test_figures(Language::Chinese, test),
        ),
        FindingKind::DoubtfulFit { fit, doubt } => doubtful_fit(Language::Chinese, fit, doubt),
        FindingKind::ExactFit { fit } => format!(
            "拟合 {fit} 的曲线通过所有数据点，残差不能给出参数的不确定度，参数按精确值处理。请给出数据的不确定度。"
        ),
        FindingKind::Asymmetric => "输出量的分布不对称，概率对称包含区间与最短包含区间不同。不要写成估计值 ± U 的形式，应给出包含区间。".to_string(),
    }
}

/// Inputs, shift and effect on u of [`FindingKind::VanishingSensitivity`].
type Unseen<'a> = (&'a [String], f64, f64);

fn unseen_in_english(report: &Report<'_>, measurand: Option<usize>, unseen: Unseen<'_>) -> String {
    let (inputs, shift, u_effect) = unseen;
    let names = Language::English.first_of(inputs);
    let (coefficient, verb) = match inputs.len() {
        1 => ("sensitivity coefficient", "vanishes"),
        _ => ("sensitivity coefficients", "vanish"),
    };
    let first = format!(
        "First order sees next to nothing of the uncertainty of {names}: the {coefficient} {verb} at the estimates."
    );
    if shift == 0.0 && u_effect == 0.0 {
        return format!(
            "{first} Second order does not see it either, although the measurand depends on it. Only Monte Carlo tells what it does."
        );
    }
    if !u_effect.is_finite() {
        return format!(
            "{first} The second derivatives do not exist there. Only Monte Carlo tells what it does."
        );
    }
    let amount = |x: f64| amount(report, measurand, significant(x, 2));
    let whose = if inputs.len() == 1 { "Its" } else { "Their" };
    let moved = if is_residue(shift, u_effect) {
        String::new()
    } else {
        format!(" and move the estimate by {}", amount(shift))
    };
    let found = format!(
        "{whose} second-order terms add {} to u in quadrature{moved}",
        amount(u_effect)
    );
    format!(
        "{first} {found}: the first-order result is wrong. Rely on Monte Carlo, and on second order where it agrees with it."
    )
}

fn unseen_in_chinese(report: &Report<'_>, measurand: Option<usize>, unseen: Unseen<'_>) -> String {
    let (inputs, shift, u_effect) = unseen;
    let names = Language::Chinese.first_of(inputs);
    let first = format!(
        "{names} 存在不确定度，但在估计值处其灵敏系数为零（或近于零），一阶 GUM 法反映不出其影响。"
    );
    if shift == 0.0 && u_effect == 0.0 {
        return format!(
            "{first}二阶项也反映不出，而被测量确实随之变化，只有蒙特卡洛法能给出其影响。"
        );
    }
    if !u_effect.is_finite() {
        return format!("{first}该处二阶导数不存在，只有蒙特卡洛法能给出其影响。");
    }
    let amount = |x: f64| amount(report, measurand, significant(x, 2));
    let moved = if is_residue(shift, u_effect) {
        String::new()
    } else {
        format!("，使估计值移动 {}", amount(shift))
    };
    let found = format!(
        "其二阶项对标准不确定度的贡献为 {}（按方和根合成）{moved}",
        amount(u_effect)
    );
    format!("{first}{found}，一阶结果因而不正确，应以蒙特卡洛法为准；二阶结果仅在与之一致时可用。")
}

/// Why the statement takes its method.
fn reported(report: &Report<'_>, measurand: Option<usize>) -> Reason {
    let results = &report.evaluation.results;
    let result = measurand.and_then(|m| results.get(m));
    result.map_or(Reason::NotValidated, |result| {
        result.reported(&report.budget.conventions).reason
    })
}

fn not_validated_in_english(report: &Report<'_>, measurand: Option<usize>) -> String {
    let p = probability(report.coverage_probability());
    let differs = format!(
        "The {p} interval of the GUM differs from the Monte Carlo interval by more than the tolerance δ (JCGM 101, clause 8)"
    );
    let take = format!("Take the Monte Carlo interval wherever a {p} interval is needed.");
    match reported(report, measurand) {
        Reason::NotValidatedFewReadings => format!(
            "{differs}, and y and u differ also where what has few degrees of freedom has u itself as its standard deviation, because the model is nonlinear. The statement takes y and u of that Monte Carlo run, and the k of the profile. {take}"
        ),
        Reason::MomentsAgree => format!(
            "{differs}, but estimate and standard uncertainty agree within δ. The statement claims these and the k of the profile; it therefore uses the GUM result. {take}"
        ),
        Reason::NotNegative => format!(
            "{differs}. The statement gives the interval of ISO 11929; that of Monte Carlo stands beside it."
        ),
        _ => format!(
            "The GUM result is not validated by Monte Carlo (JCGM 101, clause 8): its {p} interval differs from the Monte Carlo interval by more than the tolerance. The statement therefore uses the Monte Carlo result."
        ),
    }
}

fn not_validated_in_chinese(report: &Report<'_>, measurand: Option<usize>) -> String {
    let p = probability(report.coverage_probability());
    let differs = format!(
        "GUM 法与蒙特卡洛法的 {p} 包含区间端点之差超过数值容差 δ（JJF 1059.2、JCGM 101 第 8 章）"
    );
    let take = format!("需要 {p} 包含区间时，应取蒙特卡洛法的区间。");
    match reported(report, measurand) {
        Reason::NotValidatedFewReadings => format!(
            "{differs}，并且由于模型非线性，自由度小的分量以 u 本身为标准差时 y 和 u 仍不一致。证书用语采用该次蒙特卡洛法的 y 和 u 以及规范的 k。{take}"
        ),
        Reason::MomentsAgree => format!(
            "{differs}，但估计值和标准不确定度之差均不超过 δ。证书用语只给出估计值、标准不确定度和规范的 k，因此仍采用 GUM 法的结果。{take}"
        ),
        Reason::NotNegative => {
            format!("{differs}。证书用语给出 ISO 11929 的区间，蒙特卡洛法的区间列于其旁。")
        }
        _ => format!(
            "GUM 法的结果未通过蒙特卡洛法验证（JJF 1059.2、JCGM 101 第 8 章）：两种方法的 {p} 包含区间端点之差超过数值容差。证书用语因此采用蒙特卡洛法的结果。"
        ),
    }
}

/// An amount in the unit of the measurand's differences.
fn amount(report: &Report<'_>, measurand: Option<usize>, number: String) -> String {
    let unit = measurand
        .map(|m| super::symbol(report.measurand(m).1))
        .unwrap_or_default();
    if unit.is_empty() {
        number
    } else {
        format!("{number} {unit}")
    }
}

/// Why a budget could not be evaluated, and what to do.
pub fn failure(error: &EvaluationError, language: Language) -> String {
    if language == Language::English {
        return error.to_string();
    }
    match error {
        EvaluationError::NoValue { measurand } => format!(
            "在输入量的估计值处，{measurand} 的测量模型没有有限值（例如除以零或对负数开方）。请核对估计值和公式。"
        ),
        EvaluationError::NoDerivative { measurand, input } => format!(
            "在估计值处，{measurand} 的测量模型对 {input} 的导数不是有限值，GUM 法不适用，而蒙特卡洛法被关闭。请运行蒙特卡洛法。"
        ),
        EvaluationError::Unresolved { measurand, error } => format!(
            "{measurand} 的估计值只能计算到 {error:.1e}，其误差超过不确定度所允许的范围：模型中大数或函数值相减，剩下的有效位数太少。请把公共部分从公式中提出，以差值表示：直接以小的差值作为输入量，或利用恒等式，例如 a^2 - b^2 = (a - b)*(a + b)。"
        ),
        EvaluationError::AllTrialsFailed { measurand } => {
            format!("所有蒙特卡洛试验都没有得到 {measurand} 的有限值。请核对输入量的分布和公式。")
        }
        EvaluationError::Stopped => "计算在完成之前被停止。".to_owned(),
    }
}

/// The bound that clause 8 compares with, for a table: `δ = 0.0005`.
pub(super) fn tolerance(delta: f64) -> String {
    aligned(delta, delta, 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures;
    use gumption_gum::budget::CoverageRule;
    use gumption_gum::propagate::CoverageBasis;

    fn texts(remarks: &[Remark]) -> String {
        let texts: Vec<&str> = remarks.iter().map(|remark| remark.text.as_str()).collect();
        texts.join("\n")
    }

    #[test]
    fn a_fixed_factor_makes_no_allowance_for_few_readings() {
        let mut case = fixtures::refused_freedom();
        let of = |case: &fixtures::Case| texts(&remarks(&case.report(Language::English)));
        assert!(of(&case).contains("for which a k from the t-distribution allows"));
        case.budget.conventions.coverage_factor = CoverageRule::Fixed(2.0);
        case.evaluation.results[0].gum.coverage.basis = CoverageBasis::Fixed;
        // t_0.9545(4) = 2.869.
        assert!(of(&case).contains(
            "k = 2 makes no allowance for that; for 95.45 % that of the t-distribution is 2.87"
        ));
        let chinese = texts(&remarks(&case.report(Language::Chinese)));
        assert!(chinese.contains("按 t 分布为 2.87"), "{chinese}");
    }
}
