//! Why a result has no mean or no standard deviation, as sentences.

use gumption_gum::propagate::{Consequence, FewReadings, MissingMoments, Reason, Side};

use super::language::Language;
use super::number::{freedom, print, significant};

/// In English, with what to do.
pub(super) fn in_english(reason: &MissingMoments) -> String {
    const GIVEN: &str = "Monte Carlo gives median and coverage interval instead.";
    match reason {
        MissingMoments::HeavyComponent { name, dof } => {
            let missing = if *dof > 1.0 {
                "no standard deviation"
            } else {
                "neither a mean nor a standard deviation"
            };
            let degrees = if *dof == 1.0 { "degree" } else { "degrees" };
            format!(
                "The distribution of the output has {missing}: `{name}` has a t-distribution with {} {degrees} of freedom, which has none, and the output depends on it linearly. {GIVEN} More readings behind `{name}` would help; a standard deviation exists above 2 degrees of freedom.",
                freedom(*dof)
            )
        }
        MissingMoments::JointReadings { inputs, readings } => {
            let (n, many) = (readings, inputs.len());
            let names = Language::English.list(inputs);
            let missing = if n - many.min(*n) > 1 {
                "no standard deviation"
            } else {
                "neither a mean nor a standard deviation"
            };
            format!(
                "The distribution of the output has {missing}: {n} simultaneous readings of {many} inputs ({names}) leave ν = n − N = {n} − {many} = {} for their multivariate t-distribution in Monte Carlo (JCGM 102, 5.3.2), which has no standard deviation for ν ≤ 2. {GIVEN} More simultaneous readings would help; a standard deviation exists from {} on.",
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
                "The {side} tail of the Monte Carlo trials falls off like the power −{} of the distance from the median, so that {then}. {GIVEN} Check whether an input with very few degrees of freedom, or a divisor that may be zero, is meant.",
                exponent(*index)
            )
        }
        MissingMoments::FewTrials { relative_error } => format!(
            "A handful of far trials decides the standard deviation of the Monte Carlo result (its own relative standard error is {} %), so that another seed would give another u. {GIVEN} Check whether a divisor comes close to zero, or an input has very few degrees of freedom.",
            percent(*relative_error)
        ),
    }
}

/// In Chinese.
pub(super) fn in_chinese(reason: &MissingMoments) -> String {
    const GIVEN: &str = "因此蒙特卡洛法给出中位数和包含区间。";
    match reason {
        MissingMoments::HeavyComponent { name, dof } => {
            let missing = if *dof > 1.0 {
                "标准差不存在"
            } else {
                "均值和标准差均不存在"
            };
            format!(
                "输出量分布的{missing}：`{name}` 服从自由度为 {} 的 t 分布，该分布的{missing}，而输出量线性地依赖于它。{GIVEN}增加 `{name}` 的测量次数可改善；自由度大于 2 时标准差才存在。",
                freedom(*dof)
            )
        }
        MissingMoments::JointReadings { inputs, readings } => {
            let (n, many) = (readings, inputs.len());
            let names = Language::Chinese.list(inputs);
            let missing = if n - many.min(*n) > 1 {
                "标准差不存在"
            } else {
                "均值和标准差均不存在"
            };
            format!(
                "输出量分布的{missing}：{many} 个输入量（{names}）同时重复测量 {n} 次，蒙特卡洛法所用的多元 t 分布的自由度为 ν = n − N = {n} − {many} = {}（JCGM 102 的 5.3.2），ν ≤ 2 时其标准差不存在。{GIVEN}增加同时测量的次数可改善；不少于 {} 次时标准差才存在。",
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
                "蒙特卡洛试验值分布的{side}尾部按与中位数之距的 −{} 次幂衰减，{then}，{GIVEN}请检查是否有自由度极小的输入量，或可能为零的除数。",
                exponent(*index)
            )
        }
        MissingMoments::FewTrials { relative_error } => format!(
            "蒙特卡洛结果的标准差由少数远离中心的试验决定（其自身的相对标准误差为 {} %），更换种子将得到不同的 u，{GIVEN}请检查除数是否可能接近零，或输入量的自由度是否过小。",
            percent(*relative_error)
        ),
    }
}

/// What Monte Carlo adds for few readings, in English.
pub(super) fn few_in_english(components: &[FewReadings], reported: Reason) -> String {
    let wider = |few: &FewReadings| {
        let (name, nu) = (&few.component, freedom(few.dof));
        match few.dof > 2.0 {
            true => format!(
                "`{name}` has ν = {nu}, and that is {} times s/√n",
                significant((few.dof / (few.dof - 2.0)).sqrt(), 3)
            ),
            false => {
                format!("`{name}` has ν = {nu}, for which there is none (it exists for ν > 2)")
            }
        }
    };
    let named: Vec<String> = components.iter().map(wider).collect();
    let follows = match reported {
        Reason::FewReadings | Reason::NotValidatedFewReadings | Reason::MomentsAgree => {
            " The profile multiplies u = s/√n (GUM 4.2.3) by its k, and so does the statement."
        }
        Reason::NotValidated => " The statement takes the result of Monte Carlo.",
        _ => " The statement takes the GUM result, whose k allows for the few degrees of freedom.",
    };
    format!(
        "Few readings: Monte Carlo draws their mean from a t-distribution (JCGM 101, 6.4.9), whose standard deviation is larger than s/√n: {}.{follows} More readings would bring both together.",
        Language::English.list(&named)
    )
}

/// Likewise in Chinese.
pub(super) fn few_in_chinese(components: &[FewReadings], reported: Reason) -> String {
    let wider = |few: &FewReadings| {
        let (name, nu) = (&few.component, freedom(few.dof));
        match few.dof > 2.0 {
            true => format!(
                "`{name}` 的自由度为 {nu}，标准差为 s/√n 的 {} 倍",
                significant((few.dof / (few.dof - 2.0)).sqrt(), 3)
            ),
            false => format!("`{name}` 的自由度为 {nu}，标准差不存在（自由度大于 2 时才存在）"),
        }
    };
    let named: Vec<String> = components.iter().map(wider).collect();
    let follows = match reported {
        Reason::FewReadings | Reason::NotValidatedFewReadings | Reason::MomentsAgree => {
            "规范以 u = s/√n（GUM 4.2.3）乘以 k，证书用语亦然。"
        }
        Reason::NotValidated => "证书用语采用蒙特卡洛法的结果。",
        _ => "证书用语采用 GUM 法的结果，其 k 已考虑自由度小的影响。",
    };
    format!(
        "重复测量次数少：蒙特卡洛法对其均值取 t 分布（JCGM 101 的 6.4.9），其标准差大于 s/√n：{}。{follows}增加测量次数可使两者接近。",
        named.join("；")
    )
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
