//! The further measurement that a diagnosis recommends for a list of names, made by the simulator, and what
//! the longer recording says.

use serde::{Deserialize, Serialize};

use super::trial::Trial;
use crate::further::Further;
use crate::grade::{self, Answer, Finding, Graded, GradedEffect};
use crate::rig::Rig;

/// Promises from here on are held to.
pub const PROMISED: f64 = 0.95;
/// Lists of weaker effects are left alone.
const STRONG: f64 = 8.0;

/// What a diagnosis recommends: a part of what `gumption diagnose --json` prints.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Advice {
    /// For each effect with several names.
    separating: Vec<ForEffect>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct ForEffect {
    /// Place among the effects.
    effect: usize,
    /// Numbers of its names; those that share one say the same of every measurement.
    classes: Vec<usize>,
    /// The best first.
    measurements: Vec<Measurement>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Measurement {
    measure: Measure,
    resolved: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Measure {
    kind: String,
    #[serde(default)]
    column: String,
    #[serde(default)]
    value: f64,
    #[serde(default)]
    unit: String,
}

impl Measure {
    /// What the simulator can do of it.
    fn on(&self, rig: Rig) -> Option<Further> {
        let words = match self.kind.as_str() {
            "again" | "reversed" => self.kind.clone(),
            "set" if self.unit == "°" => format!("{}={}", self.column, self.value),
            "between" => format!("{} between", self.column),
            _ => return None,
        };
        let further: Further = words.parse().ok()?;
        further.is_possible(rig).then_some(further)
    }
}

/// What became of a list for which a further measurement was asked.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sequel {
    /// All names of the list say the same of every measurement.
    Same,
    /// No measurement promises to decide.
    Unpromised,
    /// Only such as the simulator cannot make.
    Impossible,
    /// A measurement was made.
    Made(String, Decision),
}

/// What a longer recording says of a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Decision {
    /// The right name, alone.
    Resolved,
    /// The right name, and others that say the same of every measurement.
    Class,
    /// Still a list with the right name.
    Listed,
    /// A wrong name, alone.
    Wrong,
    /// No name.
    Unnamed,
}

/// A further measurement to make, or why there is none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Request {
    /// Not asked: no list, or of a faint effect.
    None,
    /// Asked in vain.
    InVain(Sequel),
    /// To be made.
    Make(Further),
}

/// Which further measurement a graded answer calls for: one effect of λ ≥ 8, whole, its right name in a list.
/// It is the best of those that promise to decide and that the simulator can make.
pub fn request(trial: &Trial, graded: &Graded, answer: &Answer, advice: &Advice) -> Request {
    let [effect] = graded.effects.as_slice() else {
        return Request::None;
    };
    let Some(rig) = trial.bench.rig().filter(|_| trial.is_single()) else {
        return Request::None;
    };
    let asked =
        effect.truth.lambda_beside >= STRONG && matches!(effect.finding, Finding::Listed(_));
    if !asked {
        return Request::None;
    }
    let Some(list) = advice.on(effect, answer) else {
        return Request::InVain(Sequel::Unpromised);
    };
    if list.is_one_class(answer) {
        return Request::InVain(Sequel::Same);
    }
    let promising: Vec<&Measurement> = (list.measurements.iter())
        .filter(|one| one.resolved.is_some_and(|p| p >= PROMISED))
        .collect();
    let possible = promising.iter().find_map(|one| one.measure.on(rig));
    match possible {
        Some(further) => Request::Make(further),
        None if promising.is_empty() => Request::InVain(Sequel::Unpromised),
        None => Request::InVain(Sequel::Impossible),
    }
}

/// What a graded answer to the longer recording says.
pub fn decision(graded: &Graded, answer: &Answer, advice: &Advice) -> Decision {
    let Some(effect) = graded.effects.first() else {
        return Decision::Unnamed;
    };
    if !(graded.wrong_names.is_empty() && graded.wrong_likes.is_empty()) {
        return Decision::Wrong;
    }
    let same = || {
        let list = advice.on(effect, answer);
        list.is_some_and(|list| list.is_one_class(answer))
    };
    match effect.finding {
        Finding::Identified | Finding::ActsLike => Decision::Resolved,
        Finding::Listed(_) if same() => Decision::Class,
        Finding::Listed(_) => Decision::Listed,
        Finding::Unexplained | Finding::Missed => Decision::Unnamed,
    }
}

impl Advice {
    /// What is said of the list that holds the right name.
    fn on(&self, effect: &GradedEffect, answer: &Answer) -> Option<&ForEffect> {
        let right = |list: &&ForEffect| {
            let mut names = answer
                .effects
                .get(list.effect)
                .into_iter()
                .flat_map(|e| &e.named);
            names.any(|name| grade::accepts(&effect.truth, name))
        };
        self.separating.iter().find(right)
    }
}

impl ForEffect {
    /// Whether all names of the list say the same of every measurement.
    fn is_one_class(&self, answer: &Answer) -> bool {
        let listed = answer.effects.get(self.effect).map_or(0, |e| e.named.len());
        listed == self.classes.len() && self.classes.iter().all(|class| *class == 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_measurement_that_can_be_made_is_taken() {
        let text = r#"{"separating": [{"effect": 0, "rivals": [], "classes": [0, 1], "kappa": 0.1, "measurements": [
            {"name": "a", "measure": {"kind": "opposite", "column": "temperature"}, "resolved": 0.99},
            {"name": "b", "measure": {"kind": "set", "column": "mount", "value": 45.0, "unit": "°"}, "resolved": 0.4},
            {"name": "c", "measure": {"kind": "set", "column": "mount", "value": 90.0, "unit": "°"}, "resolved": 0.99},
            {"name": "d", "measure": {"kind": "again"}, "resolved": null}]}]}"#;
        let advice: Advice = serde_json::from_str(text).unwrap();
        let of: Vec<Option<Further>> = advice.separating[0]
            .measurements
            .iter()
            .map(|one| one.measure.on(Rig::Tumble))
            .collect();
        let words: Vec<Option<String>> = of.iter().map(|f| f.map(|f| f.to_string())).collect();
        let some = |word: &str| Some(word.to_owned());
        assert_eq!(
            words,
            [None, some("mount=45"), some("mount=90"), some("again")]
        );
        let mount = &advice.separating[0].measurements[2].measure;
        assert_eq!(mount.on(Rig::RateTable), None);
    }
}
