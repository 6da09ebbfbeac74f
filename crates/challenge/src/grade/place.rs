//! Whether a name comes with the right axis or the right moment.

use super::answer::Name;
use crate::truth::TrueEffect;

/// Part of a dwell by which a moment may be missed: a jump within one dwell shows in the next.
const DWELLS: f64 = 1.5;

/// Whether the most probable variant of a right name is said of the axis on which the effect acts, or of the
/// moment at which it happened; nothing where it is said of all axes and of no moment. `outputs` belong to an axis
/// each, `dwell` is the mean
/// time from one reading to the next, in hours.
pub fn located(outputs: &[String], dwell: f64, truth: &TrueEffect, name: &Name) -> Option<bool> {
    let label = &name.variants.first()?.label;
    let words = || label.split([',', ' ']).filter(|word| !word.is_empty());
    let axis = words().find_map(|word| outputs.iter().position(|output| output == word));
    if let (Some(axis), false) = (axis, truth.axes.is_empty()) {
        return Some(truth.axes.contains(&axis));
    }
    let happened = truth.happened_h.filter(|_| name.id == "step")?;
    let moment = words().find_map(|word| word.parse::<f64>().ok())?;
    Some((moment - happened).abs() <= DWELLS * dwell)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, Scenario, challenge};

    fn effect(scenario: &str) -> TrueEffect {
        let all = Scenario::all();
        let request = Request {
            seed: 4,
            scenario: all.into_iter().find(|one| one.name() == scenario),
            ..Request::default()
        };
        challenge(&request).truth.effects.remove(0)
    }

    fn name(id: &str, label: &str) -> Name {
        let variant = format!(r#"[{{"label":"{label}","share":1}}]"#);
        let text = format!(r#"{{"id":"{id}","variants":{variant}}}"#);
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn the_axis_that_is_stated_has_to_be_one_of_the_effect() {
        let truth = TrueEffect {
            axes: vec![1],
            ..effect("triad+supply")
        };
        let axes = ["ax", "ay", "az"].map(String::from);
        let said = |label| located(&axes, 0.1, &truth, &name("sensitivity", label));
        assert_eq!(said("ay"), Some(true));
        assert_eq!(said("ax, τ = 0.2 h"), Some(false));
        assert_eq!(said(""), None);
    }

    #[test]
    fn a_jump_is_placed_within_a_dwell() {
        let truth = TrueEffect {
            happened_h: Some(1.25),
            ..effect("remount+knock")
        };
        let said = |label| located(&[], 0.1, &truth, &name("step", label));
        assert_eq!(said("at time = 1.3 h"), Some(true));
        assert_eq!(said("at time = 1.9 h"), Some(false));
    }
}
