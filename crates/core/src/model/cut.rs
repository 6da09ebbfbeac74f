//! A formula cut where many inputs meet in one value.
//!
//! In √(Σ (xᵢ − x̄)²/(n − 1)) everything depends on everything, but only through two values, the mean and what
//! the root is taken of. Such a value is an *intermediate*: many inputs meet in it, and it does not only go on into sums.
//! With the intermediates as inputs of their own, what is left of the formula joins few inputs at a time, and has few
//! second derivatives.

use std::ops::Range;

use super::graph::{Graph, Id, Op};
use super::interaction::{Neighbours, varying_operands};
use super::jet::Jet;
use super::{Along, points};

/// Most intermediates.
const MOST: usize = 8;

/// Most inputs and intermediates in one nonlinear operation.
const FEW: usize = 16;

/// An output f(x, s) of n inputs x and r intermediates s, and the intermediates s_k(x, s) with intermediates before them.
#[derive(Debug)]
pub struct Cut<'m> {
    graph: Graph,
    /// s at the point x comes from here.
    whole: &'m Graph,
    intermediates: Vec<Id>,
    inputs: usize,
}

impl<'m> Cut<'m> {
    pub(super) fn new(graph: &'m Graph, inputs: usize, of: Id) -> Option<Self> {
        let intermediates = intermediates(graph, inputs, of)?;
        Some(Cut {
            graph: graph.cut(of, &intermediates, inputs),
            whole: graph,
            intermediates,
            inputs,
        })
    }

    /// n.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// r.
    pub fn intermediates(&self) -> usize {
        self.intermediates.len()
    }

    /// x and s, where the inputs are x.
    pub fn point(&self, x: &[f64]) -> Vec<f64> {
        let values = self.whole.evaluate(&points(x));
        let intermediates = self
            .intermediates
            .iter()
            .map(|id| values[*id as usize].value());
        x.iter().copied().chain(intermediates).collect()
    }

    /// The places of the inputs and intermediates that an intermediate is made of.
    pub fn made_of(&self, intermediate: usize) -> impl Iterator<Item = usize> {
        self.graph.inputs_of(self.graph.outputs[intermediate + 1])
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
        Neighbours::new(&self.graph, self.inputs + self.intermediates.len())
    }
}

/// What an operation is made of.
#[derive(Debug, Clone, PartialEq)]
enum Cone {
    /// Inputs and intermediates: this part of a list of them, in rising order.
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
    /// Takes an operation for an input or intermediate.
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

/// The intermediates of an output, in rising order.
fn intermediates(graph: &Graph, inputs: usize, of: Id) -> Option<Vec<Id>> {
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
    let mut intermediates: Vec<Id> = Vec::new();
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
        let mut make_intermediate = |a: Id, cones: &mut Cones| {
            cones.set(a, inputs + intermediates.len());
            intermediates.push(a);
        };
        for a in &operands {
            if cones.of[*a as usize] == Cone::Many && (bends || uses[*a as usize] > 1) {
                make_intermediate(*a, &mut cones);
            }
        }
        let mut cone = cones.union(&operands);
        while bends && cone == Cone::Many {
            let widest = operands.iter().copied().max_by_key(|a| cones.width(*a));
            let widest = widest.filter(|a| cones.width(*a) > 1)?;
            make_intermediate(widest, &mut cones);
            cone = cones.union(&operands);
        }
        cones.of[id as usize] = cone;
        if intermediates.len() > MOST {
            return None;
        }
    }
    intermediates.sort_unstable();
    Some(intermediates)
}
