//! Whether quasi-random points took the place of random trials, in words.

use gumption_fault::{Between, Said, say};
use gumption_gum::propagate::{Quasi, QuasiRun, Run, WhyRandom};

use super::language::Language;
use super::number::{grouped, significant};
use super::remarks::tolerance;

/// `4096 quasi-random points, seed 1, stable to δ = 0.05: yes`.
pub(super) fn points(run: &Run, quasi: &QuasiRun, language: Language) -> String {
    let (count, seed, delta) = (grouped(run.trials), run.seed, tolerance(quasi.delta));
    let said = match quasi.reached {
        true => say!("{count} quasi-random points, seed {seed}, stable to δ = {delta}: yes"),
        false => say!("{count} quasi-random points, seed {seed}, stable to δ = {delta}: no"),
    };
    said.in_language(language)
}

/// What the points gained, or why there are none.
pub(super) fn sentence(quasi: &Quasi, language: Language) -> String {
    let said = match quasi {
        Quasi::Used(run) => gained(run),
        Quasi::Refused(why) => say!(
            "Quasi-random points were asked for, but random trials were run (JCGM 101): {}.",
            reason(why)
        ),
    };
    said.in_language(language)
}

fn gained(run: &QuasiRun) -> Said {
    let (trials, scrambles) = (run.equivalent_trials, run.replicates);
    let gain = match trials.is_finite() {
        true => say!(
            "; their scatter tells the errors, which {} random trials would have, too",
            significant(trials, 2)
        ),
        false => say!("; they agree to the last digit"),
    };
    let averaged = match run.averaged.is_empty() {
        true => Said::default(),
        false => say!(". Not drawn, but averaged over: {}", listed(&run.averaged)),
    };
    say!(
        "Quasi-random points: {scrambles} independent scrambles of a Sobol' sequence{gain}{averaged}."
    )
}

/// The first names of components.
fn listed(names: &[String]) -> Said {
    const MOST: usize = 6;
    let shown = Said::row(Between::Comma, names.iter().take(MOST).cloned());
    match names.len().saturating_sub(MOST) {
        0 => shown,
        rest => say!("{shown} and {rest} more"),
    }
}

fn reason(why: &WhyRandom) -> Said {
    match why {
        WhyRandom::SeveralMeasurands => say!("the budget has several measurands"),
        WhyRandom::TrialsAreCounted => {
            say!("the conformity assessment or the characteristic limits count trials")
        }
        WhyRandom::Discrete { component } => {
            say!("{component} has single values, not an interval of them")
        }
        WhyRandom::HeavyTail { component } => say!("{component} has no standard deviation"),
        WhyRandom::NearSingular => say!(
            "a divisor or the argument of a function may come near a pole or the end of its domain"
        ),
        WhyRandom::NotFinite => say!("the model has no finite value at some points"),
        WhyRandom::OutputTail => say!("the tails of the output are too heavy"),
        WhyRandom::NoGain { gain } => say!(
            "a point would replace only {} random trials, for more than their time",
            significant(*gain, 2)
        ),
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
