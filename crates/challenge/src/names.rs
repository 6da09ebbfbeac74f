//! Which names of the catalogue are right for which physics. Where two mechanisms give the same
//! function of the same quantities, either name is right: a saturation far below its rails is a cubic
//! error, a resistor in its own heat is one as well.

use super::effect::Physics;
use serde::{Deserialize, Serialize};

/// A name of the catalogue that is right.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Accepted {
    /// Identifier of the catalogue.
    pub id: String,
    /// Columns one of which it has to follow; none = any.
    pub along: Vec<String>,
}

impl Accepted {
    /// Whether a diagnosis that gives one of them can have given the other.
    pub(super) fn meets(&self, other: &Accepted) -> bool {
        let follows = || self.along.iter().any(|column| other.along.contains(column));
        self.id == other.id && (self.along.is_empty() || other.along.is_empty() || follows())
    }
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

/// Names that are right for a physics.
pub(super) fn names(physics: Physics) -> Vec<Accepted> {
    let one = |(id, along): &(&str, &[&str])| Accepted {
        id: (*id).into(),
        along: along.iter().map(|column| (*column).into()).collect(),
    };
    accepted(physics).iter().map(one).collect()
}

/// Whether two physics have a right name in common.
pub(super) fn share_a_name(a: Physics, b: Physics) -> bool {
    let (a, b) = (names(a), names(b));
    a.iter().any(|one| b.iter().any(|other| one.id == other.id))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_nameable_has_a_name() {
        for physics in Physics::ALL {
            assert_eq!(
                physics.nameable(),
                !accepted(*physics).is_empty(),
                "{physics:?}"
            );
        }
    }
}
