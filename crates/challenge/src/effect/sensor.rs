//! What the sensor itself does to its input.

use super::{Part, Physics, Process};
use crate::schedule::Dwell;
use crate::world::{Vector, World};

pub(super) fn process(physics: Physics, part: Part, _dwells: &[Dwell]) -> Box<dyn Process> {
    match physics {
        Physics::Saturation => Box::new(Saturation { part }),
        Physics::CoarseReadout => Box::new(CoarseReadout { part }),
        Physics::CrossProduct | Physics::CrossSquare => Box::new(Across { part, physics }),
        _ => Box::new(Curve { part, physics }),
    }
}

/// A characteristic of one axis that is not a straight line.
struct Curve {
    part: Part,
    physics: Physics,
}

impl Curve {
    fn bend(&self, u: f64) -> f64 {
        match self.physics {
            // A proof mass in a field that weakens towards the ends of its way.
            Physics::SecondOrder => u * u * (1.0 - 0.05 * u * u),
            // A spring that stiffens: sinh(pu)/p − u, with the third power in front made 1.
            Physics::ThirdOrder => {
                const P: f64 = 0.6;
                (libm::sinh(P * u) / P - u) * 6.0 / (P * P)
            }
            // Two forcers of unequal strength, handing over smoothly around zero.
            Physics::Asymmetry => libm::sqrt(u * u + 9e-4),
            // Friction that swallows small inputs: a smoothed step.
            _ => -libm::tanh(u / 0.02),
        }
    }
}

impl Process for Curve {
    fn output(&self, world: &World, output: &mut Vector) {
        let part = &self.part;
        part.add(output, |axis| self.bend(part.own(&world.input, axis)));
    }
}

/// The pendulum swings out under load, and its axis points elsewhere.
struct Across {
    part: Part,
    physics: Physics,
}

impl Process for Across {
    fn output(&self, world: &World, output: &mut Vector) {
        let force = &world.input.force;
        for (axis, out) in output.iter_mut().enumerate() {
            let (own, other) = (force[axis], force[(axis + 1) % 3]);
            let size = self.part.at(axis);
            *out += if self.physics == Physics::CrossProduct {
                let swing = size * own;
                own * (libm::cos(swing) - 1.0) + other * libm::sin(swing)
            } else {
                size * other * other
            };
        }
    }
}

/// An amplifier that runs into its rails: L·tanh(y/L), which at full scale lacks about the size.
struct Saturation {
    part: Part,
}

impl Process for Saturation {
    fn readout(&self, reading: &mut Vector) {
        let full = self.part.rig.full_scale();
        for (axis, y) in reading.iter_mut().enumerate() {
            let lack = (self.part.size * self.part.shape.gains[axis]).abs();
            if lack > 0.0 {
                let limit = full / libm::sqrt(3.0 * lack);
                *y = limit * libm::tanh(*y / limit);
            }
        }
    }
}

/// A display with too few digits.
struct CoarseReadout {
    part: Part,
}

impl Process for CoarseReadout {
    fn readout(&self, reading: &mut Vector) {
        let axes = self.part.rig.axes();
        for (axis, y) in reading.iter_mut().enumerate().take(axes) {
            let step = self.part.at(axis).abs();
            if step > 0.0 {
                *y = (*y / step).round() * step;
            }
        }
    }
}
