//! What was found, missed and made up, and the points for it.

use super::answer::{Answer, AnsweredEffect, Name, State};
use super::vocabulary::accepts;
use crate::effect::Physics;
use crate::truth::{TrueEffect, Truth};

/// What became of a concealed effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finding {
    /// Named, and nothing else.
    Unique,
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
    /// Posterior probability of the right name, where it was named.
    pub probability: Option<f64>,
    /// Estimate of the size less its true value, over the standard uncertainty: where the effect has its
    /// own name and the size is the same quantity in the simulator and in the catalogue.
    pub deviation: Option<f64>,
    /// Points.
    pub points: f64,
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
    /// Unique names for which there is nothing, with their probabilities.
    pub wrong_names: Vec<(String, f64)>,
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
/// Rivals that leave less than this share of an effect are the same in this recording.
const ALIAS: f64 = 0.05;
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
        left_over
            .iter()
            .map(|at| &answer.effects[*at])
            .filter(move |e| e.state == state)
    };
    let wrong_names: Vec<(String, f64)> = of_state(State::Identified)
        .filter_map(|effect| effect.named.first())
        .map(|name| (name.id.clone(), name.probability))
        .collect();
    let wrong_lists: Vec<Vec<String>> = of_state(State::Ambiguous).map(names).collect();
    let false_alarm = truth.effects.is_empty() && answer.verdict != "none";
    let prediction_points = if gained(answer) { 0.25 } else { 0.0 };
    let faint = |effect: &&GradedEffect| {
        effect.truth.lambda_beside >= FAINT || effect.finding != Finding::Missed
    };
    let penalty = wrong_names.len() as f64 + if false_alarm { 1.0 } else { 0.0 };
    let points =
        effects.iter().map(|effect| effect.points).sum::<f64>() + prediction_points - penalty;
    let expected = effects.iter().filter(faint).count() as f64;
    Graded {
        scenario: truth.scenario.clone(),
        verdict: answer.verdict.clone(),
        attainable: if expected > 0.0 { expected + 0.25 } else { 0.0 },
        effects,
        wrong_names,
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
            let fits = |(k, t): &(usize, &TrueEffect)| {
                matches[*k].is_none() && t.nameable && names(t, name)
            };
            truth.effects.iter().enumerate().find(fits).map(|(k, _)| k)
        });
        match fitting {
            Some(k) => matches[k] = Some(at),
            None => {
                // A second name for what has one already is no invention: two wrong readings make a
                // swapped pair.
                let again = |t: &TrueEffect| {
                    t.nameable
                        && effect
                            .named
                            .first()
                            .is_some_and(|name| accepts(t.physics, name))
                };
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
    matches!(
        answer.verdict.as_str(),
        "unexplained" | "partly" | "contested"
    ) || answer
        .effects
        .iter()
        .any(|effect| effect.state == State::Unexplained)
}

fn graded(truth: &TrueEffect, found: Option<usize>, answer: &Answer, open: bool) -> GradedEffect {
    let slot = found.map(|at| &answer.effects[at]);
    let finding = match slot {
        Some(effect) if effect.state == State::Identified => Finding::Unique,
        Some(effect) => Finding::Listed(effect.named.len()),
        None if open => Finding::Unexplained,
        None => Finding::Missed,
    };
    let right = |effect: &AnsweredEffect| {
        effect
            .named
            .iter()
            .find(|name| names(truth, name))
            .map(|name| name.probability)
    };
    let overclaimed = finding == Finding::Unique && aliases(truth).next().is_some();
    GradedEffect {
        points: points(truth, finding, overclaimed),
        probability: slot.and_then(right),
        deviation: slot
            .filter(|effect| effect.state == State::Identified)
            .and_then(|effect| deviation(truth, effect.named.first()?)),
        truth: truth.clone(),
        finding,
        overclaimed,
    }
}

fn deviation(truth: &TrueEffect, name: &Name) -> Option<f64> {
    let (Some(size), Some(u), [_]) = ((*name.size.first()?), (*name.u.first()?), &name.size[..])
    else {
        return None;
    };
    Some((size - truth.coefficient?) / u)
}

/// Whether a name is right for an effect, or for another that gives the same recording: which of the
/// two it was, nobody can know.
fn names(truth: &TrueEffect, name: &Name) -> bool {
    accepts(truth.physics, name) || aliases(truth).any(|alias| accepts(alias, name))
}

/// Physics that would have given the same recording, under other names.
fn aliases(truth: &TrueEffect) -> impl Iterator<Item = Physics> + '_ {
    truth
        .rivals
        .iter()
        .filter(|(rival, left)| rival.nameable() && *left < ALIAS * truth.lambda_beside)
        .map(|(rival, _)| *rival)
}

fn points(truth: &TrueEffect, finding: Finding, overclaimed: bool) -> f64 {
    match finding {
        Finding::Unique if overclaimed => -0.5,
        Finding::Unique => 1.0,
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

/// What names without lists, probabilities or remainder are worth: `none`, `right` if every effect has its
/// name and there is no other, `wrong` if a name is there for nothing, else `part`.
pub fn grade_names(truth: &Truth, given: &[Name]) -> &'static str {
    if given.is_empty() {
        return "none";
    }
    let right = |name: &Name| truth.effects.iter().any(|t| t.nameable && names(t, name));
    if !given.iter().all(right) {
        return "wrong";
    }
    let found = |t: &TrueEffect| given.iter().any(|name| names(t, name));
    if truth.effects.iter().all(found) {
        "right"
    } else {
        "part"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Class, NoiseKnowledge, Physics, Request, Scenario, challenge};

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
        let effects: Vec<String> =
            effects
                .iter()
                .map(|(state, names)| {
                    let names: Vec<String> = names
                    .iter()
                    .map(|(id, along)| format!(
                        r#"{{"id":"{id}","family":"f","along":"{along}","probability":0.9}}"#
                    ))
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
        assert_eq!(right.effects[0].finding, Finding::Unique);
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
        truth.effects[0].rivals = vec![(Physics::CrossSquare, 0.0)];
        let unique = grade(
            &truth,
            &answer("identified", &[("identified", &[("quadratic", "head")])]),
        );
        assert!(unique.effects[0].overclaimed);
        let both: &[(&str, &str)] = &[("quadratic", "head"), ("cross-square", "head")];
        truth.effects[0].kappa = 0.0;
        let listed = grade(&truth, &answer("ambiguous", &[("ambiguous", both)]));
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
