//! A formula cut where many inputs meet in one value.
//!
//! In √(Σ (xᵢ − x̄)²/(n − 1)) everything depends on everything, but only through two values, the mean and what
//! the root is taken of. Such a value is a *hub*: many inputs meet in it, and it does not only go on into sums.
//! With the hubs as inputs of their own, what is left of the formula joins few inputs at a time, and has few
//! second derivatives.

use std::ops::Range;

use super::graph::{Graph, Id, Op};
use super::interaction::{Neighbours, varying_operands};
use super::jet::Jet;
use super::{Along, points};

/// Most hubs.
const MOST: usize = 8;

/// Most inputs and hubs in one nonlinear operation.
const FEW: usize = 16;

/// An output f(x, s) of n inputs x and r hubs s, and the hubs s_k(x, s) with hubs before them.
#[derive(Debug)]
pub struct Cut<'m> {
    graph: Graph,
    /// s at the point x comes from here.
    whole: &'m Graph,
    hubs: Vec<Id>,
    inputs: usize,
}

impl<'m> Cut<'m> {
    pub(super) fn new(graph: &'m Graph, inputs: usize, of: Id) -> Option<Self> {
        let hubs = hubs(graph, inputs, of)?;
        Some(Cut {
            graph: graph.cut(of, &hubs, inputs),
            whole: graph,
            hubs,
            inputs,
        })
    }

    /// n.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// r.
    pub fn hubs(&self) -> usize {
        self.hubs.len()
    }

    /// x and s, where the inputs are x.
    pub fn point(&self, x: &[f64]) -> Vec<f64> {
        let values = self.whole.evaluate(&points(x));
        let hubs = self.hubs.iter().map(|id| values[*id as usize].value());
        x.iter().copied().chain(hubs).collect()
    }

    /// The places of the inputs and hubs that a hub is made of.
    pub fn made_of(&self, hub: usize) -> impl Iterator<Item = usize> {
        self.graph.inputs_of(self.graph.outputs[hub + 1])
    }

    /// First derivatives of f and then of each s_k by x and s, which are taken for independent.
    pub fn gradients(&self, point: &[f64]) -> Vec<Vec<f64>> {
        let values = self.graph.evaluate(&points(point));
        let gradient = |id: &Id| self.graph.gradient(&values, *id, point.len());
        let all = self.graph.outputs.iter().map(gradient);
        all.map(|gradient| gradient.iter().map(Jet::value).collect())
            .collect()
    }

    /// Derivatives of f and then of each s_k along a direction of x and s, which are taken for independent.
    pub fn along(&self, point: &[f64], direction: &[f64]) -> Vec<Along> {
        self.graph.along(point, direction)
    }

    /// Third derivatives of f and the s_k, added with weights, twice along a direction.
    pub fn third_along(&self, point: &[f64], direction: &[f64], weights: &[f64]) -> Vec<f64> {
        self.graph.third_along(point, direction, weights)
    }

    /// For each of x and s those with which it may have mixed derivatives; `None` where they are not few.
    pub fn neighbours(&self) -> Option<Neighbours> {
        Neighbours::new(&self.graph, self.inputs + self.hubs.len())
    }
}

/// What an operation is made of.
#[derive(Debug, Clone, PartialEq)]
enum Cone {
    /// Inputs and hubs: this part of a list of them, in rising order.
    Few(Range<usize>),
    /// A sum of many.
    Many,
}

impl Cone {
    fn width(&self) -> usize {
        match self {
            Cone::Few(part) => part.len(),
            Cone::Many => usize::MAX,
        }
    }
}

/// The cones of all operations.
struct Cones {
    of: Vec<Cone>,
    list: Vec<usize>,
}

impl Cones {
    /// Takes an operation for an input or hub.
    fn set(&mut self, id: Id, place: usize) {
        let start = self.list.len();
        self.list.push(place);
        self.of[id as usize] = Cone::Few(start..start + 1);
    }

    fn width(&self, id: Id) -> usize {
        self.of[id as usize].width()
    }

    /// What some operations are made of together.
    fn union(&mut self, operands: &[Id]) -> Cone {
        if let [one] = operands {
            return self.of[*one as usize].clone();
        }
        let start = self.list.len();
        for id in operands {
            let Cone::Few(part) = self.of[*id as usize].clone() else {
                self.list.truncate(start);
                return Cone::Many;
            };
            self.list.extend_from_within(part);
        }
        self.list[start..].sort_unstable();
        let mut end = start;
        for at in start..self.list.len() {
            let place = self.list[at];
            if end == start || self.list[end - 1] != place {
                self.list[end] = place;
                end += 1;
            }
        }
        if end - start > FEW {
            self.list.truncate(start);
            return Cone::Many;
        }
        self.list.truncate(end);
        Cone::Few(start..end)
    }
}

/// The hubs of an output, in rising order.
fn hubs(graph: &Graph, inputs: usize, of: Id) -> Option<Vec<Id>> {
    let needed = graph.needed(&[of]);
    let ids = || (0..=of).filter(|id| needed[*id as usize]);
    let mut uses = vec![0; of as usize + 1];
    for id in ids() {
        graph.operands(graph.ops[id as usize], |a| uses[a as usize] += 1);
    }
    let mut cones = Cones {
        of: vec![Cone::Few(0..0); of as usize + 1],
        list: Vec::new(),
    };
    let mut hubs: Vec<Id> = Vec::new();
    let mut operands = Vec::new();
    for id in ids() {
        let op = graph.ops[id as usize];
        if let Op::Input(place) = op {
            cones.set(id, place as usize);
            continue;
        }
        operands.clear();
        let mut bends = false;
        varying_operands(graph, op, |a, nonlinear| {
            operands.push(a);
            bends |= nonlinear;
        });
        let mut make_hub = |a: Id, cones: &mut Cones| {
            cones.set(a, inputs + hubs.len());
            hubs.push(a);
        };
        for a in &operands {
            if cones.of[*a as usize] == Cone::Many && (bends || uses[*a as usize] > 1) {
                make_hub(*a, &mut cones);
            }
        }
        let mut cone = cones.union(&operands);
        while bends && cone == Cone::Many {
            let widest = operands.iter().copied().max_by_key(|a| cones.width(*a));
            let widest = widest.filter(|a| cones.width(*a) > 1)?;
            make_hub(widest, &mut cones);
            cone = cones.union(&operands);
        }
        cones.of[id as usize] = cone;
        if hubs.len() > MOST {
            return None;
        }
    }
    hubs.sort_unstable();
    Some(hubs)
}
