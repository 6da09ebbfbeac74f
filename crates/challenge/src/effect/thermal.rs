//! Heat and age.

use super::{Part, Physics, Process};
use crate::schedule::Dwell;
use crate::world::{Vector, World};

pub(super) fn process(physics: Physics, part: Part, dwells: &[Dwell]) -> Box<dyn Process> {
    match physics {
        Physics::TemperatureBias | Physics::TemperatureScale => Box::new(Core {
            part,
            on_scale: physics == Physics::TemperatureScale,
            lag: part.between(20.0, 1200.0),
            core: None,
        }),
        Physics::WarmUp => Box::new(WarmUp {
            part,
            chip: Node::new(part.between(150.0, 700.0)),
            case: Node::new(part.between(600.0, 3000.0)),
        }),
        Physics::LoadHeating => Box::new(LoadHeating {
            part,
            body: Node::new(part.between(4.0, 120.0)),
        }),
        _ => Box::new(Ageing {
            part,
            on_scale: physics == Physics::ScaleDrift,
            span: dwells.last().map_or(1.0, Dwell::end),
        }),
    }
}

/// One thermal mass behind one resistance, exact for a constant drive.
struct Node {
    value: f64,
    lag: f64,
}

impl Node {
    fn new(lag: f64) -> Node {
        Node { value: 0.0, lag }
    }

    fn advance(&mut self, drive: f64, dt: f64) {
        self.value += (drive - self.value) * -libm::expm1(-dt / self.lag);
    }
}

/// The sensor's core follows the fixture behind a mass of its own, while the thermometer sits outside.
/// Size: fraction of full scale, or of the scale, per kelvin.
struct Core {
    part: Part,
    on_scale: bool,
    lag: f64,
    core: Option<Node>,
}

impl Process for Core {
    fn advance(&mut self, world: &World, dt: f64) {
        let fixture = world.around.fixture;
        // The device lay in the room before it was switched on.
        let core = self.core.get_or_insert(Node {
            value: fixture,
            lag: self.lag,
        });
        core.advance(fixture, dt);
    }

    fn output(&self, world: &World, output: &mut Vector) {
        let part = &self.part;
        let warmth = self
            .core
            .as_ref()
            .map_or(world.around.fixture, |node| node.value);
        part.add(output, |axis| {
            warmth
                * if self.on_scale {
                    part.own(&world.input, axis)
                } else {
                    1.0
                }
        });
    }
}

/// Power-on warms the chip quickly and the case slowly.
struct WarmUp {
    part: Part,
    chip: Node,
    case: Node,
}

impl Process for WarmUp {
    fn advance(&mut self, _world: &World, dt: f64) {
        self.chip.advance(1.0, dt);
        self.case.advance(1.0, dt);
    }

    fn output(&self, _world: &World, output: &mut Vector) {
        let reached = 0.7 * self.chip.value + 0.3 * self.case.value;
        self.part.add(output, |_| reached - 1.0);
    }
}

/// The current heats the resistor that it is measured with.
struct LoadHeating {
    part: Part,
    body: Node,
}

impl Process for LoadHeating {
    fn advance(&mut self, world: &World, dt: f64) {
        let current = self.part.own(&world.input, 0);
        self.body.advance(current * current, dt);
    }

    fn output(&self, world: &World, output: &mut Vector) {
        let part = &self.part;
        part.add(output, |axis| {
            part.own(&world.input, axis) * self.body.value
        });
    }
}

/// Ageing: with the root of time, with its logarithm, or evenly, by the pace. Size: over the campaign.
struct Ageing {
    part: Part,
    on_scale: bool,
    span: f64,
}

impl Ageing {
    fn age(&self, time: f64) -> f64 {
        let t = time / self.span;
        match (self.part.shape.pace * 3.0) as usize {
            0 => libm::sqrt(t),
            1 => {
                let begun = libm::pow(10.0, 6.0 * self.part.shape.pace - 4.0);
                libm::log1p(t / begun) / libm::log1p(1.0 / begun)
            }
            _ => t,
        }
    }
}

impl Process for Ageing {
    fn output(&self, world: &World, output: &mut Vector) {
        let part = &self.part;
        let age = self.age(world.around.time);
        part.add(output, |axis| {
            age * if self.on_scale {
                part.own(&world.input, axis)
            } else {
                1.0
            }
        });
    }
}
