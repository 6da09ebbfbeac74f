//! Fields and supplies that reach the sensor.

use super::{Part, Physics, Process};
use crate::schedule::Dwell;
use crate::world::{EARTH_RATE, FIELD, Input, LATITUDE, Vector, World, about_z, apply};

pub(super) fn process(physics: Physics, part: Part, _dwells: &[Dwell]) -> Box<dyn Process> {
    match physics {
        Physics::EarthRate => Box::new(EarthRate),
        _ => Box::new(Pickup { part, physics }),
    }
}

/// Something that the output picks up.
struct Pickup {
    part: Part,
    physics: Physics,
}

impl Process for Pickup {
    fn output(&self, world: &World, output: &mut Vector) {
        let part = &self.part;
        let force = &world.input.force;
        match self.physics {
            // Size: per volt.
            Physics::Supply => part.add(output, |_| world.around.supply),
            // The mean of a quadratic characteristic over the vibration. Size: at 0.03 g rms.
            Physics::Vibration => {
                let rms = world.around.vibration / 0.03;
                part.add(output, |_| rms * rms);
            }
            // Size: at 0.5 gauss along the axis.
            Physics::Magnetic => {
                let field = apply(
                    &world.input.attitude,
                    &apply(&about_z(part.shape.phase), &FIELD),
                );
                part.add(output, |axis| field[axis] / 0.5);
            }
            // Every axis feels g along each, differently. Size: per g.
            Physics::GSensitivity => part.add(output, |axis| {
                force[axis] + 0.6 * force[(axis + 1) % 3] - 0.4 * force[(axis + 2) % 3]
            }),
            Physics::GSquared => part.add(output, |axis| force[axis] * force[axis]),
            // The stand resonates when the drive turns at one of its rates, 8° per second wide.
            Physics::Resonance => {
                let rate = [40.0, 90.0, 160.0][((part.shape.moment * 3.0) as usize).min(2)];
                let away = (world.pose.rate.abs() - rate) / 8.0;
                part.add(output, |_| 1.0 / (1.0 + away * away));
            }
            // Brushes and slip rings: noise that rises with the root of the rate and is rectified.
            _ => {
                let level = libm::sqrt(world.pose.rate.abs() / part.rig.full_scale());
                part.add(output, |_| level);
            }
        }
    }
}

/// A gyroscope measures the turning of the Earth as well.
struct EarthRate;

impl Process for EarthRate {
    fn input(&self, _world: &World, input: &mut Input) {
        let earth = [
            0.0,
            EARTH_RATE * libm::cos(LATITUDE),
            EARTH_RATE * libm::sin(LATITUDE),
        ];
        for (rate, add) in input.rate.iter_mut().zip(apply(&input.attitude, &earth)) {
            *rate += add;
        }
    }
}
