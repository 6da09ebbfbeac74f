//! What remembers where it came from.

use super::{Part, Physics, Process};
use crate::schedule::Dwell;
use crate::world::{Pose, Vector, World};

pub(super) fn process(physics: Physics, part: Part, _dwells: &[Dwell]) -> Box<dyn Process> {
    match physics {
        Physics::Settling => {
            let quick = part.between(40.0, 300.0);
            Box::new(Settling {
                part,
                lags: [quick, 4.0 * quick],
                strains: None,
            })
        }
        Physics::Hysteresis => Box::new(Hysteresis {
            part,
            plays: [[0.0; 3]; LOOPS],
        }),
        _ => Box::new(Backlash { part, head: None }),
    }
}

/// Two Maxwell elements beside the spring: after a step the output creeps to its value.
struct Settling {
    part: Part,
    lags: [f64; 2],
    /// Of each element and axis; they start relaxed.
    strains: Option<[Vector; 2]>,
}

/// Shares of the two elements.
const SHARES: [f64; 2] = [0.65, 0.35];

impl Process for Settling {
    fn advance(&mut self, world: &World, dt: f64) {
        let own = [0, 1, 2].map(|axis| self.part.own(&world.input, axis));
        let strains = self.strains.get_or_insert([own; 2]);
        for (strain, lag) in strains.iter_mut().zip(self.lags) {
            let step = -libm::expm1(-dt / lag);
            for (x, u) in strain.iter_mut().zip(own) {
                *x += (u - *x) * step;
            }
        }
    }

    fn output(&self, world: &World, output: &mut Vector) {
        let Some(strains) = &self.strains else { return };
        let part = &self.part;
        part.add(output, |axis| {
            let u = part.own(&world.input, axis);
            let lacking = |(strain, share): (&Vector, f64)| share * (strain[axis] - u);
            strains.iter().zip(SHARES).map(lacking).sum()
        });
    }
}

/// Loops that a hysteresis is made of.
const LOOPS: usize = 6;

/// Prandtl and Ishlinskii: a sum of plays of growing width on the input.
struct Hysteresis {
    part: Part,
    plays: [Vector; LOOPS],
}

impl Process for Hysteresis {
    fn advance(&mut self, world: &World, _dt: f64) {
        for (k, play) in self.plays.iter_mut().enumerate() {
            let half_width = 0.12 * (k + 1) as f64;
            for (axis, x) in play.iter_mut().enumerate() {
                *x = follow(*x, self.part.own(&world.input, axis), half_width);
            }
        }
    }

    fn output(&self, world: &World, output: &mut Vector) {
        let part = &self.part;
        part.add(output, |axis| {
            let u = part.own(&world.input, axis);
            self.plays
                .iter()
                .map(|play| (u - play[axis]) / LOOPS as f64)
                .sum()
        });
    }
}

/// The head lags half the play of its worm. Size: half width, radians.
struct Backlash {
    part: Part,
    head: Option<f64>,
}

impl Process for Backlash {
    fn advance(&mut self, world: &World, _dt: f64) {
        let commanded = world.pose.outer;
        let before = self.head.unwrap_or(commanded);
        self.head = Some(follow(before, commanded, self.part.size.abs()));
    }

    fn pose(&self, world: &World, pose: &mut Pose) {
        // Relative to what was commanded, so that errors of other parts of the rig stay.
        if let Some(head) = self.head {
            pose.outer += head - world.pose.outer;
        }
    }
}

/// The play operator: stays until pushed.
fn follow(state: f64, push: f64, half_width: f64) -> f64 {
    state.max(push - half_width).min(push + half_width)
}
