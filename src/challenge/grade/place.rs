//! Whether a name comes with the right axis or the right moment.

use super::answer::Name;
use crate::challenge::rig::Rig;
use crate::challenge::truth::TrueEffect;

/// Part of a dwell by which a moment may be missed: a jump within one dwell shows in the next.
const DWELLS: f64 = 1.5;

/// Whether the most probable variant of a right name is said of the axis on which the effect acts, or of the
/// moment at which it happened; nothing where it is said of all axes and of no moment. `dwell` is the mean
/// time from one reading to the next, in hours.
pub fn located(rig: Rig, dwell: f64, truth: &TrueEffect, name: &Name) -> Option<bool> {
    let label = &name.variants.first()?.label;
    let words = || label.split([',', ' ']).filter(|word| !word.is_empty());
    let axis = words().find_map(|word| outputs(rig).iter().position(|output| *output == word));
    if let (Some(axis), false) = (axis, truth.axes.is_empty()) {
        return Some(truth.axes.contains(&axis));
    }
    let happened = truth.happened_h.filter(|_| name.id == "step")?;
    let moment = words().find_map(|word| word.parse::<f64>().ok())?;
    Some((moment - happened).abs() <= DWELLS * dwell)
}

/// Outputs that belong to an axis each.
fn outputs(rig: Rig) -> &'static [&'static str] {
    match rig {
        Rig::Tumble | Rig::Remount => &[],
        Rig::Triad => &["ax", "ay", "az"],
        Rig::RateTable => &["wx", "wy", "wz"],
    }
}
