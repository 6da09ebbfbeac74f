//! Where the rig really points and how it really turns.

use super::{Part, Physics, Process};
use crate::schedule::Dwell;
use crate::world::{Input, Pose, World, apply};

pub(super) fn process(physics: Physics, part: Part, _dwells: &[Dwell]) -> Box<dyn Process> {
    match physics {
        Physics::Wobble => Box::new(Wobble { part }),
        Physics::RateRipple => Box::new(RateRipple { part }),
        _ => Box::new(AngleError { part, physics }),
    }
}

/// An error of a scale that the angle is read from. Size: radians.
struct AngleError {
    part: Part,
    physics: Physics,
}

impl AngleError {
    fn of(&self, angle: f64, force: f64) -> f64 {
        let (size, phase) = (self.part.size, self.part.shape.phase);
        let x = angle - phase;
        match self.physics {
            // A circle that is read from beside its centre.
            Physics::Eccentricity | Physics::ElevationEccentricity => {
                libm::atan2(size * libm::sin(x), 1.0 + size * libm::cos(x))
            }
            // A circle that is an ellipse.
            Physics::Ellipticity => {
                let (s, c) = (libm::sin(x), libm::cos(x));
                libm::atan2(
                    (1.0 + 2.0 * size) * s * c - s * c,
                    c * c + (1.0 + 2.0 * size) * s * s,
                )
            }
            // The arm bends under the weight of the payload, whose lever points along the phase.
            Physics::Flexure => size * libm::cos(x) * (1.0 + 0.1 * force),
            // Three bearings.
            Physics::Ripple => size * libm::sin(3.0 * x),
            // A cable touches over some degrees.
            _ => {
                let place = self.place();
                let away = (angle - place + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
                    - std::f64::consts::PI;
                let width = 9.0_f64.to_radians();
                size * libm::exp(-0.5 * (away / width) * (away / width))
            }
        }
    }

    /// Near one of twelve positions.
    fn place(&self) -> f64 {
        let twelfth = std::f64::consts::TAU / 12.0;
        (self.part.shape.moment * 12.0).floor() * twelfth + 2.0_f64.to_radians()
    }
}

impl Process for AngleError {
    fn pose(&self, world: &World, pose: &mut Pose) {
        let force = libm::sin(world.pose.outer);
        if self.physics == Physics::ElevationEccentricity {
            pose.inner += self.of(world.pose.inner, force);
        } else {
            pose.outer += self.of(world.pose.outer, force);
        }
    }
}

/// The table's axis leans by an angle that stays in the laboratory while the sensor turns under it.
/// Size: radians.
struct Wobble {
    part: Part,
}

impl Process for Wobble {
    fn input(&self, world: &World, input: &mut Input) {
        let (s, c) = (
            libm::sin(self.part.shape.phase),
            libm::cos(self.part.shape.phase),
        );
        let lean = self.part.size;
        let across = world.pose.rate * libm::sin(lean);
        let error = [
            across * c,
            across * s,
            world.pose.rate * (libm::cos(lean) - 1.0),
        ];
        for (rate, add) in input.rate.iter_mut().zip(apply(&input.attitude, &error)) {
            *rate += add;
        }
    }
}

/// The drive's tachometer is eccentric: the rate ripples once in a turn. Size: fraction of the rate.
struct RateRipple {
    part: Part,
}

impl Process for RateRipple {
    fn pose(&self, world: &World, pose: &mut Pose) {
        let ripple = self.part.size * libm::sin(world.pose.table + self.part.shape.phase);
        pose.rate /= 1.0 - ripple;
    }
}
