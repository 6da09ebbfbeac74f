//! Effects that a case can conceal. Each acts where its physics acts (on the way the rig points, on
//! what the sensor meets, on its output, on the readout, on the protocol) and has states that are
//! integrated in time. Sizes are fractions of full scale unless a shape says otherwise.
//!
//! | chapter | holds |
//! |---|---|
//! | `sensor` | curvature, asymmetry, cross products, saturation, dead band, coarse digits |
//! | `thermal` | temperature of bias and scale, self-heating, heating of the load, ageing |
//! | `memory` | settling, hysteresis, play |
//! | `geometry` | eccentricity, ellipticity, flexure, rub, ripple, wobble |
//! | `field` | supply, vibration, magnetic field, the Earth's rate, sensitivity to g, motor |
//! | `event` | shifts, knocks, popcorn, wrong labels and units |

mod event;
mod field;
mod geometry;
mod memory;
mod sensor;
mod thermal;

use serde::{Deserialize, Serialize};

use super::random::Random;
use super::rig::Rig;
use super::schedule::Dwell;
use super::simulate::Row;
use super::world::{Input, Pose, Vector, World};

/// An effect at work: its states, and where it acts. What it leaves alone it need not mention.
pub(super) trait Process {
    /// Lets `dt` seconds pass at the end of which the world is as given.
    fn advance(&mut self, _world: &World, _dt: f64) {}
    /// Changes the pose that the rig takes instead of the commanded one.
    fn pose(&self, _world: &World, _pose: &mut Pose) {}
    /// Changes what the sensor meets in that pose.
    fn input(&self, _world: &World, _input: &mut Input) {}
    /// Adds to the output, in units of the input.
    fn output(&self, _world: &World, _output: &mut Vector) {}
    /// Changes the reading, after the noise.
    fn readout(&self, _reading: &mut Vector) {}
    /// Changes what the protocol says.
    fn record(&self, _rows: &mut [Row]) {}
}

/// What is concealed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum Physics {
    SecondOrder,
    ThirdOrder,
    CrossProduct,
    CrossSquare,
    Asymmetry,
    Saturation,
    DeadBand,
    CoarseReadout,
    TemperatureBias,
    TemperatureScale,
    WarmUp,
    LoadHeating,
    Drift,
    ScaleDrift,
    Settling,
    Hysteresis,
    Backlash,
    Eccentricity,
    Ellipticity,
    ElevationEccentricity,
    Flexure,
    Wobble,
    RateRipple,
    Supply,
    Vibration,
    Magnetic,
    EarthRate,
    GSensitivity,
    GSquared,
    RunShift,
    RunScale,
    Knock,
    SwappedLabel,
    LocalRub,
    Ripple,
    Resonance,
    MotorPickup,
    Popcorn,
    WrongUnit,
}

/// How an effect of a kind looks in one case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// Share of each axis of the sensor.
    pub gains: Vector,
    /// Phase around a circle, radians.
    pub phase: f64,
    /// From 0, quick, to 1, slow; each effect states what it makes of it.
    pub pace: f64,
    /// From 0, the beginning, to 1, the end of the campaign; or a place around a circle.
    pub moment: f64,
}

/// Which members of a shape an effect depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Uses {
    pub phase: bool,
    pub pace: bool,
    pub moment: bool,
}

/// An effect in a case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Concealed {
    /// What it is.
    pub physics: Physics,
    /// How large: a fraction of full scale, or radians for angles.
    pub size: f64,
    /// How it looks.
    pub shape: Shape,
}

impl Concealed {
    /// The effect at work on a rig through a campaign.
    pub(super) fn process(&self, rig: Rig, dwells: &[Dwell]) -> Box<dyn Process> {
        let part = Part {
            rig,
            size: self.size,
            shape: self.shape,
        };
        use Physics as P;
        match self.physics {
            P::SecondOrder
            | P::ThirdOrder
            | P::CrossProduct
            | P::CrossSquare
            | P::Asymmetry
            | P::Saturation
            | P::DeadBand
            | P::CoarseReadout => sensor::process(self.physics, part),
            P::TemperatureBias
            | P::TemperatureScale
            | P::WarmUp
            | P::LoadHeating
            | P::Drift
            | P::ScaleDrift => thermal::process(self.physics, part, dwells),
            P::Settling | P::Hysteresis | P::Backlash => memory::process(self.physics, part),
            P::Eccentricity
            | P::Ellipticity
            | P::ElevationEccentricity
            | P::Flexure
            | P::LocalRub
            | P::Ripple
            | P::Wobble
            | P::RateRipple => geometry::process(self.physics, part),
            P::Supply
            | P::Vibration
            | P::Magnetic
            | P::EarthRate
            | P::GSensitivity
            | P::GSquared
            | P::Resonance
            | P::MotorPickup => field::process(self.physics, part),
            P::RunShift | P::RunScale | P::Knock | P::SwappedLabel | P::Popcorn | P::WrongUnit => {
                event::process(self.physics, part, dwells)
            }
        }
    }
}

/// What the chapters build a process from.
#[derive(Debug, Clone, Copy)]
struct Part {
    rig: Rig,
    size: f64,
    shape: Shape,
}

impl Part {
    /// What an axis meets of its own kind, as a fraction of full scale.
    fn own(&self, input: &Input, axis: usize) -> f64 {
        match self.rig {
            Rig::RateTable => input.rate[axis] / self.rig.full_scale(),
            _ => input.force[axis],
        }
    }

    /// Size at an axis in units of the input.
    fn at(&self, axis: usize) -> f64 {
        self.size * self.shape.gains[axis] * self.rig.full_scale()
    }

    /// A time constant between two, by the pace of the shape.
    fn between(&self, quick: f64, slow: f64) -> f64 {
        quick * libm::pow(slow / quick, self.shape.pace)
    }

    /// Adds the same signal to every axis by its share.
    fn add(&self, output: &mut Vector, signal: impl Fn(usize) -> f64) {
        for (axis, out) in output.iter_mut().enumerate() {
            *out += self.at(axis) * signal(axis);
        }
    }
}

impl Physics {
    /// All of them.
    pub const ALL: [Physics; 39] = [
        Physics::SecondOrder,
        Physics::ThirdOrder,
        Physics::CrossProduct,
        Physics::CrossSquare,
        Physics::Asymmetry,
        Physics::Saturation,
        Physics::DeadBand,
        Physics::CoarseReadout,
        Physics::TemperatureBias,
        Physics::TemperatureScale,
        Physics::WarmUp,
        Physics::LoadHeating,
        Physics::Drift,
        Physics::ScaleDrift,
        Physics::Settling,
        Physics::Hysteresis,
        Physics::Backlash,
        Physics::Eccentricity,
        Physics::Ellipticity,
        Physics::ElevationEccentricity,
        Physics::Flexure,
        Physics::Wobble,
        Physics::RateRipple,
        Physics::Supply,
        Physics::Vibration,
        Physics::Magnetic,
        Physics::EarthRate,
        Physics::GSensitivity,
        Physics::GSquared,
        Physics::RunShift,
        Physics::RunScale,
        Physics::Knock,
        Physics::SwappedLabel,
        Physics::LocalRub,
        Physics::Ripple,
        Physics::Resonance,
        Physics::MotorPickup,
        Physics::Popcorn,
        Physics::WrongUnit,
    ];

    /// The name in files and on the command line.
    pub fn name(self) -> String {
        match serde_json::to_value(self) {
            Ok(serde_json::Value::String(name)) => name,
            _ => format!("{self:?}"),
        }
    }

    /// Whether it can occur on a rig.
    pub(super) fn occurs(self, rig: Rig) -> bool {
        use Physics as P;
        let tumble = matches!(rig, Rig::Tumble | Rig::Remount);
        let table = rig == Rig::RateTable;
        match self {
            P::CrossSquare
            | P::CrossProduct
            | P::Eccentricity
            | P::Ellipticity
            | P::LocalRub
            | P::Ripple => !table,
            P::LoadHeating | P::Backlash | P::Flexure => tumble,
            P::ElevationEccentricity => rig == Rig::Triad,
            P::Saturation
            | P::DeadBand
            | P::Wobble
            | P::RateRipple
            | P::Magnetic
            | P::EarthRate
            | P::GSensitivity
            | P::GSquared
            | P::Resonance
            | P::MotorPickup => table,
            P::WrongUnit => tumble,
            P::SwappedLabel => !table,
            _ => true,
        }
    }

    /// Whether its size is free; some are what they are.
    pub(super) fn scalable(self) -> bool {
        !matches!(self, Physics::SwappedLabel | Physics::EarthRate)
    }

    /// A size that a twin shows well and that is small enough to be proportional: fraction of full
    /// scale, or radians.
    pub(super) fn usual_size(self) -> f64 {
        match self {
            Physics::CoarseReadout => 1e-4,
            _ => 1e-5,
        }
    }

    /// Members of the shape that matter.
    pub(super) fn uses(self) -> Uses {
        use Physics as P;
        let none = Uses::default();
        match self {
            P::Eccentricity
            | P::Ellipticity
            | P::ElevationEccentricity
            | P::Flexure
            | P::Wobble
            | P::RateRipple
            | P::Magnetic
            | P::Ripple => Uses {
                phase: true,
                ..none
            },
            P::TemperatureBias
            | P::TemperatureScale
            | P::WarmUp
            | P::LoadHeating
            | P::Drift
            | P::ScaleDrift
            | P::Settling => Uses { pace: true, ..none },
            P::RunShift
            | P::RunScale
            | P::Knock
            | P::SwappedLabel
            | P::LocalRub
            | P::Resonance
            | P::Popcorn
            | P::WrongUnit => Uses {
                moment: true,
                ..none
            },
            _ => none,
        }
    }

    /// Whether it follows a condition that is recorded.
    pub(super) fn follows_conditions(self) -> bool {
        use Physics as P;
        matches!(
            self,
            P::TemperatureBias | P::TemperatureScale | P::Supply | P::Vibration
        )
    }

    /// Whether it comes from the rig and reaches all axes alike.
    pub(super) fn of_the_rig(self) -> bool {
        use Physics as P;
        matches!(
            self,
            P::Eccentricity
                | P::Ellipticity
                | P::ElevationEccentricity
                | P::Flexure
                | P::Backlash
                | P::LocalRub
                | P::Ripple
                | P::Wobble
                | P::RateRipple
                | P::EarthRate
                | P::SwappedLabel
                | P::WrongUnit
        )
    }

    /// Whether knowledge of the trade has a name for it that a diagnosis can be expected to give.
    /// The others are to be called unexplained.
    pub fn nameable(self) -> bool {
        use Physics as P;
        !matches!(
            self,
            P::LocalRub | P::Resonance | P::MotorPickup | P::Popcorn | P::WrongUnit
        )
    }
}

impl Shape {
    /// A shape by chance. A single sensor has all on its axis; of a triad either one axis or all.
    pub(super) fn draw(rig: Rig, random: &mut Random) -> Shape {
        let gains = if rig.axes() == 1 {
            [random.sign(), 0.0, 0.0]
        } else if random.chance(0.6) {
            let mut one = [0.0; 3];
            one[random.index(3)] = random.sign();
            one
        } else {
            [(); 3].map(|()| random.between(0.5, 1.2) * random.sign())
        };
        Shape {
            gains,
            phase: random.between(0.0, std::f64::consts::TAU),
            pace: random.uniform(),
            moment: random.uniform(),
        }
    }
}

#[cfg(test)]
mod tests;
