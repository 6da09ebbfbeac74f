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

use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::random::{Random, sign};
use super::rig::Rig;
use super::schedule::Dwell;
use super::world::{Input, Pose, Row, Vector, World};

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

/// Builds an effect for its part in a case, through the dwells of a campaign.
type Build = fn(Physics, Part, &[Dwell]) -> Box<dyn Process>;

/// What is known of a kind of effect.
struct Kind {
    build: Build,
    rigs: Rigs,
    depends: Member,
    remarks: &'static [Remark],
}

/// Rigs on which an effect can occur.
enum Rigs {
    Every,
    /// All but the rate table.
    Still,
    /// Those with a dividing head.
    Head,
    Triad,
    Table,
}

/// The member of a shape, beside the gains, on which an effect depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Member {
    Nothing,
    Phase,
    Pace,
    Moment,
}

/// What else there is to say of an effect.
#[derive(PartialEq)]
enum Remark {
    /// It comes from the rig and reaches all axes alike.
    OfTheRig,
    /// The trade has no name for it.
    Nameless,
}

macro_rules! physics {
    ($($name:ident: $chapter:ident, $rigs:ident, $member:ident $(, $($remark:ident)+)?;)*) => {
        /// What is concealed.
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize,
        )]
        #[serde(rename_all = "kebab-case")]
        #[allow(missing_docs)]
        pub enum Physics {
            $($name),*
        }

        impl Physics {
            /// All of them.
            pub const ALL: &[Physics] = &[$(Physics::$name),*];

            fn kind(self) -> Kind {
                match self {
                    $(Physics::$name => Kind {
                        build: $chapter::process,
                        rigs: Rigs::$rigs,
                        depends: Member::$member,
                        remarks: &[$($(Remark::$remark),+)?],
                    }),*
                }
            }
        }
    };
}

// Name: chapter, rigs, member of the shape, remarks.
physics! {
    SecondOrder: sensor, Every, Nothing;
    ThirdOrder: sensor, Every, Nothing;
    CrossProduct: sensor, Still, Nothing;
    CrossSquare: sensor, Still, Nothing;
    Asymmetry: sensor, Every, Nothing;
    Saturation: sensor, Table, Nothing;
    DeadBand: sensor, Table, Nothing;
    CoarseReadout: sensor, Every, Nothing;
    TemperatureBias: thermal, Every, Pace;
    TemperatureScale: thermal, Every, Pace;
    WarmUp: thermal, Every, Pace;
    LoadHeating: thermal, Head, Pace;
    Drift: thermal, Every, Pace;
    ScaleDrift: thermal, Every, Pace;
    Settling: memory, Every, Pace;
    Hysteresis: memory, Every, Nothing;
    Backlash: memory, Head, Nothing, OfTheRig;
    Eccentricity: geometry, Still, Phase, OfTheRig;
    Ellipticity: geometry, Still, Phase, OfTheRig;
    ElevationEccentricity: geometry, Triad, Phase, OfTheRig;
    Flexure: geometry, Head, Phase, OfTheRig;
    Wobble: geometry, Table, Phase, OfTheRig;
    RateRipple: geometry, Table, Phase, OfTheRig;
    Supply: field, Every, Nothing;
    Vibration: field, Every, Nothing;
    Magnetic: field, Table, Phase;
    EarthRate: field, Table, Nothing, OfTheRig;
    GSensitivity: field, Table, Nothing;
    GSquared: field, Table, Nothing;
    RunShift: event, Every, Moment;
    RunScale: event, Every, Moment;
    Knock: event, Every, Moment;
    SwappedLabel: event, Still, Moment, OfTheRig;
    LocalRub: geometry, Still, Moment, OfTheRig Nameless;
    Ripple: geometry, Still, Phase, OfTheRig;
    Resonance: field, Table, Moment, Nameless;
    MotorPickup: field, Table, Nothing, Nameless;
    Popcorn: event, Every, Moment, Nameless;
    WrongUnit: event, Head, Moment, OfTheRig Nameless;
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
        (self.physics.kind().build)(self.physics, part, dwells)
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
    /// The name in files and on the command line.
    pub fn name(self) -> String {
        match serde_json::to_value(self) {
            Ok(serde_json::Value::String(name)) => name,
            _ => format!("{self:?}"),
        }
    }

    /// Whether it can occur on a rig.
    pub(super) fn occurs(self, rig: Rig) -> bool {
        match self.kind().rigs {
            Rigs::Every => true,
            Rigs::Still => rig != Rig::RateTable,
            Rigs::Head => matches!(rig, Rig::Tumble | Rig::Remount),
            Rigs::Triad => rig == Rig::Triad,
            Rigs::Table => rig == Rig::RateTable,
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

    /// The member of the shape that matters, beside the gains.
    pub(super) fn depends(self) -> Member {
        self.kind().depends
    }

    /// Whether it comes from the rig and reaches all axes alike.
    pub(super) fn of_the_rig(self) -> bool {
        self.kind().remarks.contains(&Remark::OfTheRig)
    }

    /// Whether knowledge of the trade has a name for it that a diagnosis can be expected to give.
    /// The others are to be called unexplained.
    pub fn nameable(self) -> bool {
        !self.kind().remarks.contains(&Remark::Nameless)
    }
}

impl Shape {
    /// A shape by chance. A single sensor has all on its axis; of a triad either one axis or all.
    pub(super) fn draw(rig: Rig, random: &mut Random) -> Shape {
        let gains = if rig.axes() == 1 {
            [sign(random), 0.0, 0.0]
        } else if random.random_bool(0.6) {
            let mut one = [0.0; 3];
            one[random.random_range(0..3)] = sign(random);
            one
        } else {
            [(); 3].map(|()| random.random_range(0.5..1.2) * sign(random))
        };
        Shape {
            gains,
            phase: random.random_range(0.0..std::f64::consts::TAU),
            pace: random.random(),
            moment: random.random(),
        }
    }
}

#[cfg(test)]
mod tests;
