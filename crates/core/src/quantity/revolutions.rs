//! Revolutions, which are an angle in `r/min` and counted in `Hz`: conversions that would silently hold 2π.

use gumption_fault::{Said, say};

use super::dimension::{Dimension, STEPS};
use super::symbol::terms;
use super::table::UnitTable;
use super::unit::Unit;

const RATE: Dimension = Dimension::of([0, 0, -1, 0, 0, 0, 0, 0]);
const PERIOD: Dimension = Dimension::of([0, 0, 1, 0, 0, 0, 0, 0]);

/// How a rate, or a time for each, takes revolutions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Manner {
    /// Revolutions or degrees per time, `rpm`, `°/s`, `min/r`: an angle, of 2π for each revolution.
    Turning,
    /// `rad/s`.
    Radians,
    /// `Hz`.
    Cycles,
    /// `1/min`, `ms`, `number/min`.
    Count,
    /// `1/s`, in which SI has the radian per second as well.
    Coherent,
}

/// What to write where a conversion would silently hold 2π: revolutions are an angle, 2π each, but `Hz`, `1/min` and
/// a period in seconds count them. `None` where the conversion is harmless; `text` is what is converted.
///
/// Only units of angle and time alone are asked: what the radian per second stands for in `W/(°/s)` or in
/// a noise density is no count.
pub fn revolutions_as_angle(found: &Unit, wanted: &Unit, text: &str) -> Option<Said> {
    use Manner::{Coherent, Count, Cycles, Radians, Turning};
    if found.dimension != wanted.dimension {
        return None;
    }
    let is_rate = found.dimension == RATE;
    let (into_count, into_angle) = if is_rate { ("/", "*") } else { ("*", "/") };
    let (angle, count) = (&found.symbol, &wanted.symbol);
    match (manner(found)?, manner(wanted)?) {
        (Turning, Cycles | Count | Coherent) | (Radians, Cycles | Count) => Some(say!(
            "a revolution is an angle, 2π, in {angle}: count revolutions by `{text} {into_count} (1 'r')`"
        )),
        (Cycles, Turning | Radians) => Some(say!(
            "a revolution is an angle, 2π, in {count}: write `{text} {into_angle} (1 'r')` for revolutions that are counted in {angle}"
        )),
        (Count, Turning | Radians) | (Coherent, Turning) => Some(say!(
            "a revolution is an angle, 2π, in {count}: write `{text} {into_angle} (1 'r')` where revolutions are counted, `{text} {into_angle} (1 'rad')` where radians are"
        )),
        _ => None,
    }
}

/// Whether a rate or a time for each has no angle in its unit.
pub(crate) fn counts(unit: &Unit) -> bool {
    !matches!(manner(unit), Some(Manner::Turning | Manner::Radians) | None)
}

/// What a result in such a unit may state in place of a count, to follow what [`revolutions_as_angle`] says.
pub(crate) fn unit_of_angle(found: &Unit) -> Option<Said> {
    let (rate, period) = (
        say!("write `unit = \"rad/s\"` for the angular velocity"),
        say!("write `unit = \"s/rad\"` for the reciprocal of the angular velocity"),
    );
    let is_rate = found.dimension == RATE;
    let is_angle = matches!(manner(found), Some(Manner::Turning | Manner::Radians));
    is_angle.then_some(if is_rate { rate } else { period })
}

/// The power in which a unit holds revolutions, `r`, `rev` and `rpm`, that no radian or degree takes away.
pub(crate) fn revolutions_in(unit: &Unit) -> i32 {
    // A revolution has π in its factor, and parsing takes its time.
    let known = (unit.factor.pi != 0).then(|| terms(&unit.symbol));
    let Some(terms) = known.flatten() else {
        return 0;
    };
    let has_other_angle = terms
        .iter()
        .any(|(name, _)| is_degree(name) || is_radian(name));
    let revolutions = terms.iter().filter(|(name, _)| is_revolution(name));
    let power: i32 = revolutions.map(|(_, exponent)| exponent).sum();
    match has_other_angle {
        true => 0,
        false => power / STEPS,
    }
}

fn manner(unit: &Unit) -> Option<Manner> {
    if ![RATE, PERIOD].contains(&unit.dimension) {
        return None;
    }
    let terms = terms(&unit.symbol)?;
    let others = || terms.iter().map(|(name, _)| name.as_str());
    let turns = |name: &str| is_revolution(name) || is_degree(name);
    if unit.factor.pi.abs() == 1 {
        let is_turning = others().any(turns) && others().all(|name| turns(name) || is_time(name));
        return is_turning.then_some(Manner::Turning);
    }
    if unit.factor.pi != 0 {
        return None;
    }
    match terms.as_slice() {
        [(name, _)] if name.ends_with("Hz") => return Some(Manner::Cycles),
        [(name, _)] if name == "s" => return Some(Manner::Coherent),
        _ => {}
    }
    let radians = terms.iter().filter(|(name, _)| is_radian(name));
    let power: i32 = radians.map(|(_, exponent)| exponent).sum();
    if power.abs() == STEPS && others().all(|name| is_radian(name) || is_time(name)) {
        return Some(Manner::Radians);
    }
    let is_count = others().all(|name| is_time(name) || is_number(name));
    is_count.then_some(Manner::Count)
}

fn is_revolution(name: &str) -> bool {
    ["r", "rev", "rpm"].contains(&name)
}

fn is_degree(name: &str) -> bool {
    ["°", "deg"].contains(&name)
}

fn is_radian(name: &str) -> bool {
    name.ends_with("rad")
}

fn is_time(name: &str) -> bool {
    ["s", "ms", "µs", "us", "ns", "min", "h", "d"].contains(&name)
}

/// What is counted: a unit of dimension one, or a name of the file's own.
fn is_number(name: &str) -> bool {
    let builtin = UnitTable::default().parse(name);
    !is_radian(name) && builtin.map_or(true, |unit| unit.dimension.is_none())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> Unit {
        UnitTable::default().parse(text).expect(text)
    }

    #[test]
    fn revolutions_are_not_counted_in_silence() {
        let lost = |a: &str, b: &str| revolutions_as_angle(&unit(a), &unit(b), "n");
        for (a, b, mend) in [
            ("r/min", "Hz", "n / (1 'r')"),
            ("rpm", "1/min", "n / (1 'r')"),
            ("°/s", "kHz", "n / (1 'r')"),
            ("min/r", "s", "n * (1 'r')"),
            ("Hz", "r/min", "n * (1 'r')"),
            ("1/min", "r/min", "n * (1 'rad')"),
            ("1/ms", "rpm", "n * (1 'r')"),
            ("s^-1", "r/min", "n * (1 'r')"),
            ("ms", "min/r", "n / (1 'r')"),
            ("rad/s", "Hz", "n / (1 'r')"),
            ("rad/s", "1/min", "n / (1 'r')"),
            ("kHz", "rad/s", "n * (1 'r')"),
            ("1/min", "rad/s", "n * (1 'r')"),
        ] {
            let help = lost(a, b).unwrap_or_default().to_string();
            assert!(help.contains(mend), "{a} to {b}: {help}");
        }
        for (a, b) in [
            ("r/min", "rad/s"),
            ("r/min", "°/s"),
            ("rad/(s·r)", "Hz"),
            ("r/(min·rad)", "Hz"),
            ("r·Hz", "r/min"),
            ("rad/s", "1/s"),
            ("1/s", "rad/s"),
            ("m/(s·mm)", "rad/s"),
            ("m/(s·mm)", "r/min"),
            ("Hz", "1/s"),
            ("N·m·r/min", "W"),
            ("°", "1"),
            ("(°/s)^2/Hz", "(°/h)^2/Hz"),
            ("(°/h)^2/Hz", "(°/h)^2/Hz"),
            ("rad·s/°", "s"),
            ("mN·m·s/(°·kg·m^2)", "1/s"),
        ] {
            assert_eq!(lost(a, b), None, "{a} to {b}");
        }
    }

    #[test]
    fn revolutions_of_a_unit_are_those_that_are_left() {
        for (text, power) in [
            ("r/min", 1),
            ("rpm", 1),
            ("min/r", -1),
            ("mL/r", -1),
            ("r·mL/(min·r)", 0),
            ("r/(min·rad)", 0),
            ("rad/s", 0),
        ] {
            assert_eq!(revolutions_in(&unit(text)), power, "{text}");
        }
    }
}
