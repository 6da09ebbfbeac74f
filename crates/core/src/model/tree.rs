//! Derivatives of second and third order where every input is used once.
//!
//! Such a formula is a tree: the arguments of every operation depend on different inputs. All that its
//! surroundings have to tell an operation is then how the output changes with the operation's own value
//! s, and one pass from the output to the inputs finds, for a hundred thousand inputs as for ten, what
//! would otherwise take one sweep for each of them. With ψ the operation above s, r one of its arguments
//! and q the other, for example, ∂²f/∂r² = ∂²f/∂s² ψ_r² + ∂f/∂s ψ_rr.

use super::graph::{Graph, Id, Op};
use super::jet::Jet;
use super::operation;

/// What a measurand, divided by its unit, does when one of its inputs changes. V_i is the variance of an
/// input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leaf {
    /// The place of the input.
    pub input: usize,
    /// f_i
    pub slope: f64,
    /// f_ii
    pub second: f64,
    /// f_iii
    pub third: f64,
    /// Σ f_ij² V_j over the other inputs.
    pub mixed: f64,
    /// Σ f_iij f_j V_j over all inputs.
    pub drift: f64,
}

/// Derivatives of the output with respect to the value of an operation.
#[derive(Debug, Clone, Copy, Default)]
struct Node {
    slope: f64,
    second: f64,
    third: f64,
    mixed: f64,
    /// Change of `slope` and of `second` along the direction Σ f_j V_j.
    slope_drift: f64,
    second_drift: f64,
}

/// An operation seen from one of its arguments, r; the other is q.
#[derive(Debug, Clone, Copy, Default)]
struct Edge {
    /// ψ_r, ψ_rr, ψ_rrr
    own: [f64; 3],
    /// ψ_rq, ψ_rrq
    mixed: [f64; 2],
    /// ψ_q
    other: f64,
}

/// The leaves for the inputs of positive variance that an output uses, in no particular order. Nothing
/// where an input is used twice, where an equation is to be solved, and where numbers are so large or so
/// small that squares of them could be lost.
pub fn leaves(graph: &Graph, x: &[f64], of: Id, variances: &[f64], unit: f64) -> Option<Vec<Leaf>> {
    let points: Vec<Jet<1>> = x.iter().map(|x| Jet::constant(*x)).collect();
    let values = graph.evaluate(&points);
    let tree = Tree {
        graph,
        values: values.iter().map(Jet::value).collect(),
    };
    let spread = tree.variances(of, variances)?;
    let mut nodes = vec![Node::default(); of as usize + 1];
    nodes[of as usize].slope = 1.0 / unit;
    let mut leaves = Vec::new();
    for id in (0..=of).rev().filter(|id| spread[*id as usize] > 0.0) {
        let node = nodes[id as usize];
        if !ordinary(node.slope) || !ordinary(spread[id as usize]) {
            return None;
        }
        if let Op::Input(place) = graph.ops[id as usize] {
            leaves.push(Leaf {
                input: place as usize,
                slope: node.slope,
                second: node.second,
                third: node.third,
                mixed: node.mixed,
                drift: node.second_drift,
            });
        }
        for (r, q, edge) in tree.edges(id, &spread) {
            let other = q.map_or(0.0, |q| spread[q as usize]);
            nodes[r as usize] = node.below(&edge, spread[r as usize], other);
        }
    }
    Some(leaves)
}

impl Node {
    /// The derivatives with respect to the argument r of an operation; `own` and `other` are the
    /// variances of r and q.
    fn below(&self, edge: &Edge, own: f64, other: f64) -> Node {
        let [first, second, third] = edge.own;
        let [cross, bend] = edge.mixed;
        let slope = self.slope * first;
        // The direction Σ f_j V_j moves every operation by its slope times its variance.
        let (along, across) = (slope * own, self.slope * edge.other * other);
        let first_drift = second * along + cross * across;
        let second_drift = third * along + bend * across;
        let cross = self.second * first * edge.other + self.slope * cross;
        Node {
            slope,
            second: self.second * first * first + self.slope * second,
            third: self.third * first.powi(3)
                + 3.0 * self.second * first * second
                + self.slope * third,
            mixed: self.mixed * first * first + cross * cross * other,
            slope_drift: self.slope_drift * first + self.slope * first_drift,
            second_drift: self.second_drift * first * first
                + 2.0 * self.second * first * first_drift
                + self.slope_drift * second
                + self.slope * second_drift,
        }
    }
}

/// A graph with its values.
struct Tree<'g> {
    graph: &'g Graph,
    values: Vec<f64>,
}

impl Tree<'_> {
    /// The variance of every operation that the output follows, of first order; `None` where one of
    /// them is used twice.
    fn variances(&self, of: Id, inputs: &[f64]) -> Option<Vec<f64>> {
        let count = of as usize + 1;
        let mut followed = vec![false; count];
        followed[of as usize] = true;
        for id in (0..=of).rev().filter(|id| *id <= of) {
            if followed[id as usize] {
                self.followed(id, |a| followed[a as usize] = true);
            }
        }
        let mut spread = vec![0.0; count];
        let mut used = vec![false; count];
        for id in (0..=of).filter(|id| followed[*id as usize]) {
            let mut once = true;
            self.followed(id, |a| {
                let moves = spread[a as usize] > 0.0;
                once &= !(moves && std::mem::replace(&mut used[a as usize], true));
            });
            if !once {
                return None;
            }
            spread[id as usize] = match self.graph.ops[id as usize] {
                Op::Input(place) => inputs[place as usize],
                Op::Solve(_) => {
                    let mut moves = false;
                    self.followed(id, |a| moves |= spread[a as usize] > 0.0);
                    if moves {
                        return None;
                    }
                    0.0
                }
                _ => {
                    let edges = self.edges(id, &spread);
                    let part = |(r, _, edge): (Id, Option<Id>, Edge)| {
                        edge.own[0] * edge.own[0] * spread[r as usize]
                    };
                    // What has no slope here still moves: it keeps a place in the tree.
                    let moved = edges.clone().count() > 0;
                    let sum: f64 = edges.map(part).sum();
                    if moved {
                        sum.max(f64::MIN_POSITIVE)
                    } else {
                        0.0
                    }
                }
            };
        }
        Some(spread)
    }

    /// The operands whose changes an operation passes on.
    fn followed(&self, id: Id, mut visit: impl FnMut(Id)) {
        match self.graph.ops[id as usize] {
            Op::Select(c, a, b) => visit(if self.values[c as usize] != 0.0 { a } else { b }),
            op => self.graph.operands(op, visit),
        }
    }

    /// The arguments that move, each with the other one if that moves, too.
    fn edges(
        &self,
        id: Id,
        spread: &[f64],
    ) -> impl Iterator<Item = (Id, Option<Id>, Edge)> + Clone + use<> {
        let at = |id: Id| self.values[id as usize];
        let moves = |id: Id| spread[id as usize] > 0.0;
        let alone = |own: [f64; 3]| Edge {
            own,
            ..Edge::default()
        };
        let mut found = [None, None];
        match self.graph.ops[id as usize] {
            Op::Unary(row, a) if moves(a) => {
                let [_, first, second, third] = (row.derivatives)(at(a));
                found[0] = Some((a, None, alone([first, second, third])));
            }
            Op::Power(a, c) if moves(a) => {
                let [_, first, second, third] =
                    operation::power_derivatives(at(a), f64::from_bits(c));
                found[0] = Some((a, None, alone([first, second, third])));
            }
            Op::Select(c, a, b) => {
                let chosen = if at(c) != 0.0 { a } else { b };
                if moves(chosen) {
                    found[0] = Some((chosen, None, alone([1.0, 0.0, 0.0])));
                }
            }
            Op::Binary(row, a, b) => {
                let still = |id: Id| Jet::<3>::constant(at(id));
                let moving = |id: Id| Jet::<3>::line(at(id), 1.0);
                let along_a = row.slopes(moving(a), still(b));
                let along_b = row.slopes(still(a), moving(b));
                let ends = [(a, b, along_a.0.0), (b, a, along_b.1.0)];
                // ∂ψ/∂b moves along a by the mixed derivative, and with the square of that by the third.
                let cross = along_a.1.0[1];
                let bends = [along_a.1.0[2], along_b.0.0[2]];
                let slopes = [along_b.1.0[0], along_a.0.0[0]];
                for (place, (r, q, own)) in ends.into_iter().enumerate() {
                    if !moves(r) {
                        continue;
                    }
                    let both = moves(q);
                    found[place] = Some((
                        r,
                        both.then_some(q),
                        Edge {
                            own,
                            mixed: if both {
                                [cross, bends[place]]
                            } else {
                                [0.0; 2]
                            },
                            other: if both { slopes[place] } else { 0.0 },
                        },
                    ));
                }
            }
            _ => {}
        }
        found.into_iter().flatten()
    }
}

/// Whether squares and products of three such numbers neither overflow nor vanish.
fn ordinary(number: f64) -> bool {
    number == 0.0 || (1e-50..1e50).contains(&number.abs())
}
