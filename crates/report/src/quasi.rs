//! Whether quasi-random points took the place of random trials, in words.

use gumption_gum::propagate::{Quasi, QuasiRun, Run, WhyRandom};

use super::language::Language;
use super::number::{grouped, significant};
use super::remarks::tolerance;

/// `4096 quasi-random points, seed 1, stable to δ = 0.05: yes`.
pub(super) fn points(run: &Run, quasi: &QuasiRun, language: Language) -> String {
    let (count, seed, delta) = (grouped(run.trials), run.seed, tolerance(quasi.delta));
    match language {
        Language::English => format!(
            "{count} quasi-random points, seed {seed}, stable to δ = {delta}: {}",
            if quasi.reached { "yes" } else { "no" }
        ),
        Language::Chinese => format!(
            "{count} 个拟随机点，种子 {seed}，数值容差 δ = {delta}：{}",
            if quasi.reached { "达到" } else { "未达到" }
        ),
    }
}

/// What the points gained, or why there are none.
pub(super) fn sentence(quasi: &Quasi, language: Language) -> String {
    match (quasi, language) {
        (Quasi::Used(run), _) => gained(run, language),
        (Quasi::Refused(why), Language::English) => format!(
            "Quasi-random points were asked for, but random trials were run (JCGM 101): {}.",
            english(why)
        ),
        (Quasi::Refused(why), Language::Chinese) => {
            format!(
                "虽指定使用拟随机点，但实际运行的是随机试验（JCGM 101）：{}。",
                chinese(why)
            )
        }
    }
}

fn gained(run: &QuasiRun, language: Language) -> String {
    let trials = run.equivalent_trials;
    let scrambles = run.replicates;
    let known = trials.is_finite();
    let trials = significant(trials, 2);
    match language {
        Language::English => {
            let points = format!(
                "Quasi-random points: {scrambles} independent scrambles of a Sobol' sequence"
            );
            let gain = if known {
                format!(
                    "; their scatter tells the errors, which {trials} random trials would have, too"
                )
            } else {
                "; they agree to the last digit".to_string()
            };
            let averaged = match listed(&run.averaged, language) {
                Some(names) => format!(". Not drawn, but averaged over: {names}"),
                None => String::new(),
            };
            format!("{points}{gain}{averaged}.")
        }
        Language::Chinese => {
            let points = format!("拟随机点：Sobol' 序列的 {scrambles} 次独立置乱");
            let gain = if known {
                format!("，由其离散程度得出的误差相当于 {trials} 次随机试验")
            } else {
                "，各次结果完全一致".to_string()
            };
            let averaged = match listed(&run.averaged, language) {
                Some(names) => format!("。不抽样而直接求平均的分量：{names}"),
                None => String::new(),
            };
            format!("{points}{gain}{averaged}。")
        }
    }
}

/// The first names of components; `None` if there are none.
fn listed(names: &[String], language: Language) -> Option<String> {
    const MOST: usize = 6;
    let shown = names.iter().take(MOST).map(String::as_str);
    let rest = names.len().saturating_sub(MOST);
    let (comma, more) = match language {
        Language::English => (", ", format!(" and {rest} more")),
        Language::Chinese => ("、", format!("等 {} 个", names.len())),
    };
    let list = shown.collect::<Vec<_>>().join(comma);
    let more = if rest > 0 { more } else { String::new() };
    (!names.is_empty()).then(|| list + &more)
}

fn english(why: &WhyRandom) -> String {
    match why {
        WhyRandom::SeveralMeasurands => "the budget has several measurands".into(),
        WhyRandom::TrialsAreCounted => {
            "the conformity assessment or the characteristic limits count trials".into()
        }
        WhyRandom::Discrete { component } => {
            format!("{component} has single values, not an interval of them")
        }
        WhyRandom::HeavyTail { component } => format!("{component} has no standard deviation"),
        WhyRandom::NearSingular => {
            "a divisor or the argument of a function may come near a pole or the end of its domain"
                .into()
        }
        WhyRandom::NotFinite => "the model has no finite value at some points".into(),
        WhyRandom::OutputTail => "the tails of the output are too heavy".into(),
        WhyRandom::NoGain { gain } => format!(
            "a point would replace only {} random trials, for more than their time",
            significant(*gain, 2)
        ),
    }
}

fn chinese(why: &WhyRandom) -> String {
    match why {
        WhyRandom::SeveralMeasurands => "有多个被测量".into(),
        WhyRandom::TrialsAreCounted => "合格评定或特征限需要对试验计数".into(),
        WhyRandom::Discrete { component } => format!("{component} 只取离散值"),
        WhyRandom::HeavyTail { component } => format!("{component} 的标准差不存在"),
        WhyRandom::NearSingular => "除数或函数的自变量可能接近极点或定义域的边界".into(),
        WhyRandom::NotFinite => "模型在某些点上没有有限值".into(),
        WhyRandom::OutputTail => "输出量分布的尾部过重".into(),
        WhyRandom::NoGain { gain } => {
            format!(
                "每个点仅相当于 {} 次随机试验，而耗时更多",
                significant(*gain, 2)
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_says_what_it_gained() {
        let run = QuasiRun {
            replicates: 16,
            averaged: vec!["V.calibration".into()],
            digits: 2,
            delta: 0.05,
            reached: true,
            equivalent_trials: 3.14e6,
            shortest_errors: [0.0; 2],
        };
        let used = Quasi::Used(run);
        let english = sentence(&used, Language::English);
        assert!(
            english.contains("V.calibration") && english.contains("random trials"),
            "{english}"
        );
        assert!(sentence(&used, Language::Chinese).ends_with("V.calibration。"));
    }

    #[test]
    fn every_reason_is_a_sentence_in_both_languages() {
        let component = || "a".to_string();
        for why in [
            WhyRandom::SeveralMeasurands,
            WhyRandom::TrialsAreCounted,
            WhyRandom::Discrete {
                component: component(),
            },
            WhyRandom::HeavyTail {
                component: component(),
            },
            WhyRandom::NearSingular,
            WhyRandom::NotFinite,
            WhyRandom::OutputTail,
            WhyRandom::NoGain { gain: 1.25 },
        ] {
            let refused = Quasi::Refused(why);
            assert!(sentence(&refused, Language::English).ends_with('.'));
            assert!(sentence(&refused, Language::Chinese).ends_with('。'));
        }
    }
}
