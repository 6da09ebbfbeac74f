//! What was found, missed and made up, and the points for it.

use serde::{Deserialize, Serialize};

use super::answer::{Answer, AnsweredEffect, State};
use super::vocabulary::{accepts, accepts_or_alias, tells_both};
use crate::truth::{TrueEffect, Truth};

/// What became of a concealed effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// Named, and nothing else.
    Identified,
    /// Said to act like it, and nothing else.
    ActsLike,
    /// In a list of so many names.
    Listed(usize),
    /// Reported as something without a name.
    Unexplained,
    /// Not found.
    Missed,
}

/// A concealed effect and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct GradedEffect {
    /// The truth.
    pub truth: TrueEffect,
    /// What became of it.
    pub finding: Finding,
    /// A unique name was asserted although the recording cannot tell it from another.
    pub overclaimed: bool,
    /// Points.
    pub points: f64,
    /// How large it is in the residuals, where the answer says that.
    pub answered_size: Option<f64>,
}

/// A graded diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub struct Graded {
    /// The scenario.
    pub scenario: String,
    /// The verdict of the diagnosis.
    pub verdict: String,
    /// Every concealed effect.
    pub effects: Vec<GradedEffect>,
    /// Identified names for which there is nothing.
    pub wrong_names: Vec<String>,
    /// Names that it is said to act like, and for which there is nothing.
    pub wrong_likes: Vec<String>,
    /// Lists without anything that is there.
    pub wrong_lists: Vec<Vec<String>>,
    /// Something was found where nothing is concealed.
    pub false_alarm: bool,
    /// Points of the prediction: a quarter if half of what can be gained is gained.
    pub prediction_points: f64,
    /// All points.
    pub points: f64,
    /// The most that could have been reached.
    pub attainable: f64,
}

/// An effect weaker than this need not be found.
pub const FAINT: f64 = 4.0;
/// Lists among explanations closer than this are no fault.
const INSEPARABLE: f64 = 4.0;
/// An effect without a name has to be noticed from this strength on, though it may have had one.
const STRONG: f64 = 8.0;

/// Holds a diagnosis against the truth.
pub fn grade(truth: &Truth, answer: &Answer) -> Graded {
    let (matches, left_over) = matched(truth, answer);
    let open = open_remainder(answer);
    let effects: Vec<GradedEffect> = truth
        .effects
        .iter()
        .zip(&matches)
        .map(|(effect, found)| graded(effect, *found, answer, open))
        .collect();
    let names = |effect: &AnsweredEffect| -> Vec<String> {
        effect.named.iter().map(|name| name.id.clone()).collect()
    };
    let of_state = |state| {
        let all = left_over.iter().map(|at| &answer.effects[*at]);
        all.filter(move |effect| effect.state == state).map(names)
    };
    let first = |state| of_state(state).filter_map(|names| names.into_iter().next());
    let wrong_names: Vec<String> = first(State::Identified).collect();
    let wrong_likes: Vec<String> = first(State::ActsLike).collect();
    let wrong_lists: Vec<Vec<String>> = of_state(State::OneOf).collect();
    let false_alarm = truth.effects.is_empty() && answer.has_noticed();
    let prediction_points = if gained(answer) { 0.25 } else { 0.0 };
    let faint = |effect: &&GradedEffect| {
        effect.truth.lambda_beside >= FAINT || effect.finding != Finding::Missed
    };
    let penalty = wrong_names.len() as f64
        + 0.5 * wrong_likes.len() as f64
        + if false_alarm { 1.0 } else { 0.0 };
    let points =
        effects.iter().map(|effect| effect.points).sum::<f64>() + prediction_points - penalty;
    let expected = effects.iter().filter(faint).count() as f64;
    Graded {
        scenario: truth.scenario.clone(),
        verdict: answer.verdict.clone(),
        // A prediction can only be improved by an answer that predicts.
        attainable: match (expected > 0.0, answer.before.is_some()) {
            (true, true) => expected + 0.25,
            _ => expected,
        },
        effects,
        wrong_names,
        wrong_likes,
        wrong_lists,
        false_alarm,
        prediction_points,
        points,
    }
}

/// For each concealed effect the answered one that names it, and the answered ones that name nothing.
fn matched(truth: &Truth, answer: &Answer) -> (Vec<Option<usize>>, Vec<usize>) {
    let mut matches = vec![None; truth.effects.len()];
    let mut left_over = Vec::new();
    for (at, effect) in answer.effects.iter().enumerate() {
        if effect.state == State::Unexplained || effect.named.is_empty() {
            continue;
        }
        // The name that stands first decides, where it can.
        let fitting = effect.named.iter().find_map(|name| {
            let fits =
                |(k, t): &(usize, &TrueEffect)| matches[*k].is_none() && accepts_or_alias(t, name);
            truth.effects.iter().enumerate().find(fits).map(|(k, _)| k)
        });
        match fitting {
            Some(k) => matches[k] = Some(at),
            None => {
                // A second name for what has one already is no invention: two wrong readings make a
                // swapped pair.
                let again =
                    |t: &TrueEffect| effect.named.first().is_some_and(|name| accepts(t, name));
                if !truth.effects.iter().any(again) {
                    left_over.push(at);
                }
            }
        }
    }
    (matches, left_over)
}

/// Whether the diagnosis says that something without a name is left.
fn open_remainder(answer: &Answer) -> bool {
    let mut effects = answer.effects.iter();
    answer.verdict == "unexplained" || effects.any(|effect| effect.state == State::Unexplained)
}

fn graded(truth: &TrueEffect, found: Option<usize>, answer: &Answer, open: bool) -> GradedEffect {
    let found = found.and_then(|at| answer.effects.get(at));
    let finding = match found {
        Some(effect) if effect.state == State::Identified => Finding::Identified,
        Some(effect) if effect.state == State::ActsLike => Finding::ActsLike,
        Some(effect) => Finding::Listed(effect.named.len()),
        None if open => Finding::Unexplained,
        None => Finding::Missed,
    };
    let name = found.and_then(|effect| effect.named.first());
    let overclaimed = finding == Finding::Identified
        && !truth.aliases.is_empty()
        && !name.is_some_and(|name| tells_both(truth, name));
    GradedEffect {
        points: points(truth, finding, overclaimed),
        answered_size: found.and_then(|effect| effect.in_residuals),
        truth: truth.clone(),
        finding,
        overclaimed,
    }
}

fn points(truth: &TrueEffect, finding: Finding, overclaimed: bool) -> f64 {
    match finding {
        Finding::Identified if overclaimed => -0.5,
        Finding::Identified | Finding::ActsLike => 1.0,
        Finding::Listed(_) if truth.kappa < INSEPARABLE => 1.0,
        Finding::Listed(count) => (1.1 - 0.1 * count as f64).max(0.0),
        Finding::Unexplained if !truth.nameable => 1.0,
        Finding::Unexplained if truth.lambda_beside >= STRONG => 0.3,
        Finding::Unexplained => 0.5,
        Finding::Missed => 0.0,
    }
}

/// Whether at least half of the excess of the prediction error over the noise is gone.
fn gained(answer: &Answer) -> bool {
    let error =
        |quality: &Option<super::Quality>| quality.as_ref().and_then(super::Quality::held_out);
    match (error(&answer.before), error(&answer.after)) {
        (Some(before), Some(after)) if before > 1.1 => before - after >= 0.5 * (before - 1.0),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Accepted, Class, NoiseKnowledge, Request, Scenario, challenge};

    fn truth(name: &str) -> Truth {
        let scenario = Scenario::all().into_iter().find(|s| s.name() == name);
        let request = Request {
            seed: 3,
            scenario,
            noise: Some(NoiseKnowledge::Stated),
            ..Request::default()
        };
        challenge(&request).truth
    }

    fn answer(verdict: &str, effects: &[(&str, &[(&str, &str)])]) -> Answer {
        let effects: Vec<String> = effects
            .iter()
            .map(|(state, names)| {
                let names: Vec<String> = names
                    .iter()
                    .map(|(id, along)| format!(r#"{{"id":"{id}","along":"{along}"}}"#))
                    .collect();
                format!(r#"{{"state":"{state}","named":[{}]}}"#, names.join(","))
            })
            .collect();
        let text = format!(
            r#"{{"verdict":"{verdict}","effects":[{}],"before":null,"after":null}}"#,
            effects.join(",")
        );
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn a_right_name_counts_one_and_a_wrong_one_costs_one() {
        let truth = truth("remount+supply");
        let right = grade(
            &truth,
            &answer(
                "identified",
                &[("identified", &[("sensitivity", "supply")])],
            ),
        );
        assert_eq!(right.effects[0].finding, Finding::Identified);
        assert_eq!(right.points, 1.0);
        let wrong = grade(
            &truth,
            &answer(
                "identified",
                &[("identified", &[("sensitivity", "humidity")])],
            ),
        );
        assert_eq!(wrong.wrong_names.len(), 1);
        assert_eq!(wrong.points, -1.0);
    }

    #[test]
    fn one_of_two_names_for_the_same_recording_is_an_overclaim() {
        let mut truth = truth("tumble+second-order");
        truth.effects[0].aliases = vec![Accepted {
            id: "cross-square".into(),
            along: Vec::new(),
        }];
        let unique = grade(
            &truth,
            &answer("identified", &[("identified", &[("quadratic", "head")])]),
        );
        assert!(unique.effects[0].overclaimed);
        let both: &[(&str, &str)] = &[("quadratic", "head"), ("cross-square", "head")];
        truth.effects[0].kappa = 0.0;
        let listed = grade(&truth, &answer("one-of", &[("one-of", both)]));
        assert_eq!(
            (listed.effects[0].finding, listed.points),
            (Finding::Listed(2), 1.0)
        );
    }

    #[test]
    fn what_no_catalogue_names_is_to_be_called_unexplained() {
        let truth = truth("tumble+local-rub");
        let open = grade(
            &truth,
            &answer("unexplained", &[("unexplained", &[("outlier", "")])]),
        );
        assert_eq!(
            (open.effects[0].finding, open.points),
            (Finding::Unexplained, 1.0)
        );
        let named = grade(
            &truth,
            &answer("identified", &[("identified", &[("outlier", "")])]),
        );
        assert_eq!((named.wrong_names.len(), named.points), (1, -1.0));
    }

    #[test]
    fn silence_is_right_where_nothing_is_concealed() {
        let truth = truth("tumble+none");
        assert_eq!(truth.class, Class::Null);
        assert_eq!(grade(&truth, &answer("none", &[])).points, 0.0);
        let alarm = grade(
            &truth,
            &answer("identified", &[("identified", &[("drift", "time")])]),
        );
        assert!(alarm.false_alarm && alarm.points == -2.0);
    }
}
