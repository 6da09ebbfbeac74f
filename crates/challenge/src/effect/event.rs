//! What happens once, or at random.

use rand::RngExt;
use rand_distr::Exp1;

use super::{Part, Physics, Process};
use crate::random::{Stream, source};
use crate::schedule::Dwell;
use crate::world::{Pose, Row, Vector, World};

pub(super) fn process(physics: Physics, part: Part, dwells: &[Dwell]) -> Box<dyn Process> {
    let runs = dwells.last().map_or(1, |d| d.run + 1);
    let end = dwells.last().map_or(1.0, Dwell::end);
    // Any run but the first, and any time but the edges.
    let run = 1 + ((part.shape.moment * (runs.max(2) - 1) as f64) as usize).min(runs.max(2) - 2);
    let time = end * (0.12 + 0.76 * part.shape.moment);
    match physics {
        Physics::SwappedLabel => Box::new(SwappedLabel { part }),
        Physics::Popcorn => Box::new(Popcorn::new(part, end)),
        _ => Box::new(Shift {
            part,
            physics,
            run,
            time,
        }),
    }
}

/// A change that stays.
struct Shift {
    part: Part,
    physics: Physics,
    run: usize,
    time: f64,
}

impl Process for Shift {
    fn pose(&self, world: &World, pose: &mut Pose) {
        // Minutes of arc written as hundredths of a degree, in one run. Size: radians.
        if self.physics == Physics::WrongUnit && world.around.run == self.run {
            pose.outer += self.part.size;
        }
    }

    fn output(&self, world: &World, output: &mut Vector) {
        let part = &self.part;
        let (now, run) = (world.around.time, world.around.run);
        match self.physics {
            Physics::RunShift if run >= self.run => part.add(output, |_| 1.0),
            Physics::RunScale if run >= self.run => {
                part.add(output, |axis| part.own(&world.input, axis));
            }
            Physics::Knock if now > self.time => part.add(output, |_| 1.0),
            _ => {}
        }
    }
}

/// A defect in the silicon that traps and frees a charge: two levels, at random times.
struct Popcorn {
    part: Part,
    /// Moments when the level changes.
    flips: Vec<f64>,
}

impl Popcorn {
    fn new(part: Part, end: f64) -> Popcorn {
        let seed = part.shape.moment.to_bits();
        let mut random = source(seed, Stream::Effect, 1);
        let mut flips = Vec::new();
        let mut time = 0.0;
        while time < end {
            let wait: f64 = random.sample(Exp1);
            time += 700.0 * wait;
            flips.push(time);
        }
        Popcorn { part, flips }
    }
}

impl Process for Popcorn {
    fn output(&self, world: &World, output: &mut Vector) {
        let passed = self
            .flips
            .iter()
            .filter(|&&t| t < world.around.time)
            .count();
        self.part.add(output, |_| (passed % 2) as f64);
    }
}

/// Two neighbouring lines of the protocol were written the wrong way round.
struct SwappedLabel {
    part: Part,
}

impl Process for SwappedLabel {
    fn record(&self, rows: &mut [Row]) {
        let Some(last) = rows.len().checked_sub(2) else {
            return;
        };
        let first = ((self.part.shape.moment * (last + 1) as f64) as usize).min(last);
        let pose = rows[first].pose;
        rows[first].pose = rows[first + 1].pose;
        rows[first + 1].pose = pose;
    }
}
