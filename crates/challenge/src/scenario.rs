//! What may be concealed: the scenarios, and drawing a case of one.

use serde::{Deserialize, Serialize};

use super::effect::{Concealed, Physics, Shape};
use super::random::{Stream, log_between, source};
use super::rig::Rig;
use super::simulate::Setup;
use super::strength::Visible;

/// What kind of answer a scenario deserves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// Nothing is concealed.
    Null,
    /// One effect.
    Single,
    /// Two.
    Double,
    /// Three.
    Triple,
    /// Two that resemble each other, with opposite signs.
    Masked,
    /// Something that no catalogue names.
    Outside,
    /// A temperature effect, and the thermometer was not recorded.
    Hidden,
}

impl Class {
    /// The classes that a study counts, with their words on the command line.
    pub const COUNTED: [(Class, &'static str); 4] = [
        (Class::Null, "null"),
        (Class::Single, "single"),
        (Class::Double, "double"),
        (Class::Outside, "outside"),
    ];

    /// The word on the command line for the class that a study counts it with.
    pub fn name(self) -> &'static str {
        let is_it = |(class, _): &&(Class, &'static str)| *class == self.counted();
        Class::COUNTED
            .iter()
            .find(is_it)
            .map_or("", |(_, name)| name)
    }

    /// The class that a study counts it with: nothing, one effect, several, or what no catalogue names.
    pub fn counted(self) -> Class {
        match self {
            Class::Triple | Class::Masked => Class::Double,
            Class::Hidden => Class::Outside,
            other => other,
        }
    }
}

/// A rig with what is concealed on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scenario {
    /// The rig.
    pub rig: Rig,
    /// What kind it is.
    pub class: Class,
    /// What is concealed.
    pub effects: &'static [Physics],
}

impl Scenario {
    /// The name on the command line: rig and effects.
    pub fn name(&self) -> String {
        let mut parts = vec![self.rig.name().to_string()];
        match self.class {
            Class::Null => parts.push("none".into()),
            Class::Hidden => parts.push("hidden-temperature".into()),
            _ => parts.extend(self.effects.iter().map(|effect| effect.name())),
        }
        parts.join("+")
    }

    /// All scenarios.
    pub fn all() -> Vec<Scenario> {
        RIGS.iter()
            .flat_map(|(rig, rows)| {
                rows.iter().map(|(class, effects)| Scenario {
                    rig: *rig,
                    class: *class,
                    effects,
                })
            })
            .collect()
    }
}

type Row = (Class, &'static [Physics]);

const RIGS: [(Rig, &[Row]); 4] = [
    (Rig::Tumble, TUMBLE),
    (Rig::Remount, REMOUNT),
    (Rig::Triad, TRIAD),
    (Rig::RateTable, RATE_TABLE),
];

use Class::{Double, Hidden, Masked, Null, Outside, Single, Triple};
use Physics as P;

const TUMBLE: &[Row] = &[
    (Null, &[]),
    (Single, &[P::SecondOrder]),
    (Single, &[P::ThirdOrder]),
    (Single, &[P::Eccentricity]),
    (Single, &[P::TemperatureBias]),
    (Single, &[P::Settling]),
    (Single, &[P::Backlash]),
    (Single, &[P::Drift]),
    (Single, &[P::LoadHeating]),
    (Double, &[P::SecondOrder, P::TemperatureBias]),
    (Outside, &[P::LocalRub]),
    (Hidden, &[P::TemperatureBias]),
];

const REMOUNT: &[Row] = &[
    (Null, &[]),
    (Single, &[P::SecondOrder]),
    (Single, &[P::ThirdOrder]),
    (Single, &[P::CrossProduct]),
    (Single, &[P::Asymmetry]),
    (Single, &[P::Eccentricity]),
    (Single, &[P::Ellipticity]),
    (Single, &[P::TemperatureBias]),
    (Single, &[P::TemperatureScale]),
    (Single, &[P::WarmUp]),
    (Single, &[P::Drift]),
    (Single, &[P::ScaleDrift]),
    (Single, &[P::Settling]),
    (Single, &[P::Hysteresis]),
    (Single, &[P::Backlash]),
    (Single, &[P::Flexure]),
    (Single, &[P::Supply]),
    (Single, &[P::Vibration]),
    (Single, &[P::RunShift]),
    (Single, &[P::Knock]),
    (Single, &[P::SwappedLabel]),
    (Double, &[P::SecondOrder, P::Eccentricity]),
    (Double, &[P::TemperatureBias, P::ThirdOrder]),
    (Double, &[P::Settling, P::Drift]),
    (Triple, &[P::ThirdOrder, P::TemperatureBias, P::Supply]),
    (Masked, &[P::Asymmetry, P::SecondOrder]),
    (Masked, &[P::Drift, P::TemperatureBias]),
    (Outside, &[P::LocalRub]),
    (Single, &[P::Ripple]),
    (Outside, &[P::Popcorn]),
    (Outside, &[P::WrongUnit]),
    (Hidden, &[P::TemperatureBias]),
];

const TRIAD: &[Row] = &[
    (Null, &[]),
    (Single, &[P::SecondOrder]),
    (Single, &[P::ThirdOrder]),
    (Single, &[P::Asymmetry]),
    (Single, &[P::CrossProduct]),
    (Single, &[P::TemperatureBias]),
    (Single, &[P::TemperatureScale]),
    (Single, &[P::WarmUp]),
    (Single, &[P::Settling]),
    (Single, &[P::Eccentricity]),
    (Single, &[P::ElevationEccentricity]),
    (Single, &[P::Supply]),
    (Single, &[P::Knock]),
    (Double, &[P::TemperatureBias, P::SecondOrder]),
    (Double, &[P::Supply, P::ElevationEccentricity]),
    (Triple, &[P::TemperatureScale, P::CrossProduct, P::Knock]),
    (Masked, &[P::TemperatureBias, P::Drift]),
    (Outside, &[P::Popcorn]),
    (Single, &[P::Ripple]),
    (Hidden, &[P::TemperatureBias]),
];

const RATE_TABLE: &[Row] = &[
    (Null, &[]),
    (Single, &[P::SecondOrder]),
    (Single, &[P::ThirdOrder]),
    (Single, &[P::Asymmetry]),
    (Single, &[P::Saturation]),
    (Single, &[P::DeadBand]),
    (Single, &[P::TemperatureBias]),
    (Single, &[P::TemperatureScale]),
    (Single, &[P::Drift]),
    (Single, &[P::Supply]),
    (Single, &[P::Magnetic]),
    (Single, &[P::EarthRate]),
    (Single, &[P::GSensitivity]),
    (Single, &[P::RateRipple]),
    (Single, &[P::Wobble]),
    (Double, &[P::EarthRate, P::TemperatureBias]),
    (Double, &[P::GSensitivity, P::SecondOrder]),
    (Triple, &[P::ThirdOrder, P::TemperatureScale, P::EarthRate]),
    (Outside, &[P::Resonance]),
    (Outside, &[P::MotorPickup]),
];

/// How the noise is claimed in the case, and whether it is what a claim takes for granted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseKnowledge {
    /// As figures, which are true.
    Stated,
    /// As a standard deviation, which is true of every row, while the rows are correlated.
    StatedCorrelated,
    /// Not at all; rows are independent.
    Estimated,
    /// Not at all; rows are correlated.
    EstimatedCorrelated,
    /// By a recording at rest, which also holds flicker; for rigs.
    AtRest,
}

impl NoiseKnowledge {
    /// All of them, with what is said of them in tables.
    pub const ALL: [(NoiseKnowledge, &'static str); 5] = [
        (NoiseKnowledge::Stated, "stated"),
        (NoiseKnowledge::StatedCorrelated, "stated-correlated"),
        (NoiseKnowledge::Estimated, "estimated"),
        (NoiseKnowledge::EstimatedCorrelated, "estimated-correlated"),
        (NoiseKnowledge::AtRest, "at-rest"),
    ];

    /// The word in files, tables and on the command line.
    pub fn name(self) -> &'static str {
        let is_it = |(one, _): &&(NoiseKnowledge, &'static str)| *one == self;
        NoiseKnowledge::ALL
            .iter()
            .find(is_it)
            .map_or("", |(_, name)| name)
    }

    /// Whether a standard deviation is stated.
    pub(super) fn is_stated(self) -> bool {
        matches!(
            self,
            NoiseKnowledge::Stated | NoiseKnowledge::StatedCorrelated
        )
    }

    /// Whether rows are correlated though nothing says so.
    pub(super) fn is_correlated(self) -> bool {
        matches!(
            self,
            NoiseKnowledge::StatedCorrelated | NoiseKnowledge::EstimatedCorrelated
        )
    }
}

/// A drawn case: everything that its recordings follow from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Drawn {
    pub scenario: Scenario,
    pub setup: Setup,
    pub knowledge: NoiseKnowledge,
    /// The effects with their visible strengths.
    pub effects: Vec<(Concealed, f64)>,
}

impl Drawn {
    /// Effects without their strengths.
    pub(super) fn concealed(&self) -> Vec<Concealed> {
        self.effects.iter().map(|(effect, _)| *effect).collect()
    }
}

/// Strengths are drawn between these, evenly in the logarithm.
pub(super) const STRENGTHS: [f64; 2] = [2.0, 30.0];
/// Largest size that still is a small error: fraction of full scale, or radians.
const LARGEST: f64 = 0.02;

/// Draws a case of a scenario.
pub(super) fn draw(scenario: Scenario, knowledge: NoiseKnowledge, seed: u64) -> Drawn {
    let mut random = source(seed, Stream::Effect, 0);
    let rig = scenario.rig;
    let white = rig.noise().white / libm::sqrt(rig.samples() as f64);
    let noise = match knowledge {
        NoiseKnowledge::Stated | NoiseKnowledge::Estimated => rig.noise().without_walk(),
        // As much variance in correlated parts as half of the white one.
        NoiseKnowledge::StatedCorrelated | NoiseKnowledge::EstimatedCorrelated => {
            rig.noise().without_walk().with_flicker(0.35 * white)
        }
        NoiseKnowledge::AtRest => rig.noise().with_flicker(0.15 * white),
    };
    let setup = Setup { rig, seed, noise };
    let mut effects: Vec<(Concealed, f64)> = Vec::new();
    if !scenario.effects.is_empty() {
        let visible = Visible::new(&setup);
        let common = log_between(&mut random, STRENGTHS[0], STRENGTHS[1]).max(8.0);
        for &physics in scenario.effects {
            let shape = Shape::draw(rig, &mut random);
            let target = log_between(&mut random, STRENGTHS[0], STRENGTHS[1]);
            let target = if scenario.class == Class::Masked {
                common
            } else {
                target
            };
            let size = if physics.scalable() {
                physics.usual_size()
            } else {
                1.0
            };
            let effect = Concealed {
                physics,
                size,
                shape,
            };
            effects.push(visible.sized(effect, target, LARGEST));
        }
        if scenario.class == Class::Masked {
            mask(&visible, &mut effects);
        }
    }
    Drawn {
        scenario,
        setup,
        knowledge,
        effects,
    }
}

/// Two effects on the same axes that cancel as far as they resemble each other.
fn mask(visible: &Visible<'_>, effects: &mut [(Concealed, f64)]) {
    let [(first, _), (second, strength)] = effects else {
        return;
    };
    second.shape.gains = first.shape.gains;
    let target = *strength;
    (*second, *strength) = visible.sized(*second, target, LARGEST);
    let together = visible.trace(&[*first]).dot(&visible.trace(&[*second]));
    if together > 0.0 {
        second.size = -second.size;
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn there_are_enough_scenarios_of_every_class() {
        let all = Scenario::all();
        let names: BTreeSet<String> = all.iter().map(Scenario::name).collect();
        assert_eq!(names.len(), all.len());
        assert!(all.len() >= 40);
        for class in [Null, Single, Double, Triple, Masked, Outside, Hidden] {
            assert!(all.iter().any(|s| s.class == class), "{class:?}");
        }
        for scenario in &all {
            for effect in scenario.effects {
                assert!(effect.occurs(scenario.rig), "{}", scenario.name());
                let nameable = scenario.class != Class::Outside;
                assert_eq!(effect.nameable(), nameable, "{}", scenario.name());
            }
        }
    }

    #[test]
    fn a_case_has_the_strengths_that_it_states() {
        let scenario = Scenario::all()
            .into_iter()
            .find(|s| s.name() == "remount+second-order+eccentricity")
            .unwrap();
        let drawn = draw(scenario, NoiseKnowledge::Stated, 5);
        let visible = Visible::new(&drawn.setup);
        for (effect, strength) in &drawn.effects {
            assert!((visible.trace(&[*effect]).norm() - strength).abs() < 1e-9 * strength);
            assert!((2.0..31.0).contains(strength));
        }
        assert_eq!(drawn, draw(scenario, NoiseKnowledge::Stated, 5));
        assert_ne!(drawn, draw(scenario, NoiseKnowledge::Stated, 6));
    }
}
