//! A formula cut where many inputs meet in one value.
//!
//! In √(Σ (xᵢ − x̄)²/(n − 1)) everything depends on everything, but only through two values, the mean and what
//! the root is taken of. Such a value is a *hub*: many inputs meet in it, and it does not only go on into sums.
//! With the hubs as inputs of their own, what is left of the formula joins few inputs at a time, and has few
//! second derivatives.

use super::graph::{Graph, Id, Op};
use super::interaction::{neighbours, varying_operands};
use super::jet::Jet;
use super::{Along, points};

/// Most hubs.
const MOST: usize = 8;

/// Most inputs and hubs in one nonlinear operation.
const FEW: usize = 16;

/// An output f(x, s) of n inputs x and r hubs s, and the hubs s_k(x, s) with hubs before them.
#[derive(Debug)]
pub(crate) struct Cut<'m> {
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
    pub(crate) fn inputs(&self) -> usize {
        self.inputs
    }

    /// r.
    pub(crate) fn hubs(&self) -> usize {
        self.hubs.len()
    }

    /// x and s, where the inputs are x.
    pub(crate) fn point(&self, x: &[f64]) -> Vec<f64> {
        let values = self.whole.evaluate(&points(x));
        let hubs = self.hubs.iter().map(|id| values[*id as usize].value());
        x.iter().copied().chain(hubs).collect()
    }

    /// The places of the inputs and hubs that a hub is made of.
    pub(crate) fn made_of(&self, hub: usize) -> impl Iterator<Item = usize> {
        self.graph.inputs_of(self.graph.outputs[hub + 1])
    }

    /// First derivatives of f and then of each s_k by x and s, which are taken for independent.
    pub(crate) fn gradients(&self, point: &[f64]) -> Vec<Vec<f64>> {
        let values = self.graph.evaluate(&points(point));
        let gradient = |id: &Id| self.graph.gradient(&values, *id, point.len());
        let all = self.graph.outputs.iter().map(gradient);
        all.map(|gradient| gradient.iter().map(Jet::value).collect())
            .collect()
    }

    /// Derivatives of f and then of each s_k along a direction of x and s, which are taken for independent.
    pub(crate) fn along(&self, point: &[f64], direction: &[f64]) -> Vec<Along> {
        self.graph.along(point, direction)
    }

    /// The same of f and the s_k, added with weights.
    pub(crate) fn sum_along(&self, point: &[f64], direction: &[f64], weights: &[f64]) -> Along {
        self.graph.sum_along(point, direction, weights)
    }

    /// For each of x and s those with which it may have mixed derivatives; `None` where they are not few.
    pub(crate) fn neighbours(&self) -> Option<Vec<Vec<usize>>> {
        neighbours(&self.graph, self.inputs + self.hubs.len())
    }
}

/// What an operation is made of.
#[derive(Debug, Clone, PartialEq)]
enum Cone {
    /// These inputs and hubs, in rising order.
    Few(Vec<usize>),
    /// A sum of many.
    Many,
}

/// The hubs of an output, in rising order.
fn hubs(graph: &Graph, inputs: usize, of: Id) -> Option<Vec<Id>> {
    let needed = graph.needed(&[of]);
    let ids = || (0..=of).filter(|id| needed[*id as usize]);
    let mut uses = vec![0; of as usize + 1];
    for id in ids() {
        graph.operands(graph.ops[id as usize], |a| uses[a as usize] += 1);
    }
    let mut cones = vec![Cone::Few(Vec::new()); of as usize + 1];
    let mut hubs: Vec<Id> = Vec::new();
    for id in ids() {
        let op = graph.ops[id as usize];
        if let Op::Input(place) = op {
            cones[id as usize] = Cone::Few(vec![place as usize]);
            continue;
        }
        let mut operands = Vec::new();
        let mut bends = false;
        varying_operands(graph, op, |a, nonlinear| {
            operands.push(a);
            bends |= nonlinear;
        });
        let mut make_hub = |a: Id, cones: &mut [Cone]| {
            cones[a as usize] = Cone::Few(vec![inputs + hubs.len()]);
            hubs.push(a);
        };
        for a in &operands {
            if cones[*a as usize] == Cone::Many && (bends || uses[*a as usize] > 1) {
                make_hub(*a, &mut cones);
            }
        }
        let mut cone = union(&operands, &cones);
        while bends && cone == Cone::Many {
            let widest = operands.iter().max_by_key(|a| width(&cones[**a as usize]));
            let widest = widest.filter(|a| width(&cones[**a as usize]) > 1)?;
            make_hub(*widest, &mut cones);
            cone = union(&operands, &cones);
        }
        cones[id as usize] = cone;
        if hubs.len() > MOST {
            return None;
        }
    }
    hubs.sort_unstable();
    Some(hubs)
}

fn width(cone: &Cone) -> usize {
    match cone {
        Cone::Few(places) => places.len(),
        Cone::Many => usize::MAX,
    }
}

fn union(operands: &[Id], cones: &[Cone]) -> Cone {
    let mut all = Vec::new();
    for a in operands {
        match &cones[*a as usize] {
            Cone::Few(places) => all.extend(places),
            Cone::Many => return Cone::Many,
        }
    }
    all.sort_unstable();
    all.dedup();
    if all.len() > FEW {
        Cone::Many
    } else {
        Cone::Few(all)
    }
}
