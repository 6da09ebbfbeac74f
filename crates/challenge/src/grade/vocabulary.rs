//! Which names of the catalogue are right for which physics. Where two mechanisms give the same
//! function of the same quantities, either name is right: a saturation far below its rails is a cubic
//! error, a resistor in its own heat is one as well.

use super::answer::{Name, Variant};
use crate::effect::Physics;

/// Whether a name is right for a physics.
pub fn accepts(physics: Physics, name: &Name) -> bool {
    accepted(physics).iter().any(|(id, along)| {
        (name.id == *id || holds(name, id))
            && (along.is_empty() || along.iter().any(|column| mentions(&name.along, column)))
    })
}

/// Whether a name leaves open that it is an effect in another order.
fn holds(name: &Name, id: &str) -> bool {
    /// An order with less than this share is ruled out.
    const OPEN: f64 = 0.01;
    let order = |variant: &Variant| variant.id == id && variant.share >= OPEN;
    name.variants.iter().any(order)
}

/// Identifiers of the catalogue that can be right for a physics.
pub fn accepted_ids(physics: Physics) -> impl Iterator<Item = &'static str> {
    accepted(physics).iter().map(|(id, _)| *id)
}

/// Whether a list of columns mentions one.
fn mentions(along: &str, column: &str) -> bool {
    along
        .split(|c: char| !c.is_alphanumeric())
        .any(|word| word == column)
}

/// Identifiers of the catalogue, each with the columns that it has to follow; none = any.
fn accepted(physics: Physics) -> &'static [(&'static str, &'static [&'static str])] {
    use Physics as P;
    match physics {
        P::SecondOrder => &[("quadratic", &[]), ("axis-quadratic", &[])],
        P::ThirdOrder => &[("cubic", &[]), ("axis-cubic", &[])],
        P::CrossProduct => &[("cross-product", &[])],
        P::CrossSquare => &[("cross-square", &[])],
        P::Asymmetry => &[("asymmetry", &[]), ("axis-asymmetry", &[])],
        P::Saturation => &[("saturation", &[]), ("cubic", &[])],
        P::DeadBand => &[("zero-step", &[])],
        P::CoarseReadout => &[("quantisation", &[])],
        P::TemperatureBias => &[("tempco-bias", &["temperature"])],
        P::TemperatureScale => &[("tempco-scale", &["temperature"])],
        P::WarmUp => &[("warm-up", &[])],
        P::LoadHeating => &[("cubic", &[]), ("self-heating", &[]), ("lag", &[])],
        P::Drift => &[("drift", &[])],
        P::ScaleDrift => &[("drift-scale", &[])],
        P::Settling => &[("lag", &[])],
        P::Hysteresis => &[("hysteresis", &[])],
        P::Backlash => &[("play", &["head"])],
        P::Eccentricity | P::Ellipticity | P::Ripple => &[("eccentricity", &["head", "azimuth"])],
        P::ElevationEccentricity => &[("eccentricity", &["elevation"])],
        P::Flexure => &[("eccentricity", &["head"]), ("cross-product", &[])],
        P::Wobble => &[("periodic", &["table"]), ("axis-wobble", &["table"])],
        P::RateRipple => &[("periodic", &["table"]), ("periodic-scale", &["table"])],
        P::Magnetic | P::EarthRate => &[("periodic", &["table"]), ("laboratory-field", &["table"])],
        P::Supply => &[("sensitivity", &["supply"])],
        P::Vibration => &[
            ("sensitivity", &["vibration"]),
            ("sensitivity-quadratic", &["vibration"]),
        ],
        P::GSensitivity | P::GSquared => &[("cross-sensitivity", &["cx", "cy", "cz"])],
        // A jump between two runs is a shift of the runs, whatever made it.
        P::RunShift | P::Knock => &[("level-shift", &["run"]), ("step", &[])],
        P::RunScale => &[("level-scale", &["run"]), ("step-scale", &[])],
        P::SwappedLabel => &[("swapped", &[]), ("outlier", &[])],
        P::LocalRub | P::Resonance | P::MotorPickup | P::Popcorn | P::WrongUnit => &[],
    }
}

/// Whether two physics have a right name in common.
pub(crate) fn share_a_name(a: Physics, b: Physics) -> bool {
    accepted(a)
        .iter()
        .any(|(id, _)| accepted(b).iter().any(|(other, _)| id == other))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(id: &str, along: &str) -> Name {
        let text = format!(r#"{{"id":"{id}","family":"","along":"{along}","probability":1}}"#);
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn the_column_matters_where_it_makes_the_physics() {
        assert!(accepts(Physics::Supply, &name("sensitivity", "supply")));
        assert!(!accepts(Physics::Supply, &name("sensitivity", "humidity")));
        assert!(accepts(Physics::ThirdOrder, &name("cubic", "head")));
        assert!(!accepts(Physics::LocalRub, &name("cubic", "head")));
    }

    #[test]
    fn everything_nameable_has_a_name() {
        for physics in Physics::ALL {
            assert_eq!(
                physics.nameable(),
                !accepted(physics).is_empty(),
                "{physics:?}"
            );
        }
    }
}
