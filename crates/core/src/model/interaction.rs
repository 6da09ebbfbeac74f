//! Which inputs can have mixed derivatives with one another.
//!
//! An operation is *bent* where its value goes, directly or through others, into an operation that
//! is not linear in it. All that reaches one nonlinear operation may interact; what only meets in
//! sums does not. In y = x₁² + x₂x₃ + x₄ the blocks are {x₁}, {x₂, x₃}, and x₄ has none: derivatives
//! of second and higher order with respect to inputs of different blocks are zero, so that one
//! sweep may run along a direction in every block at once.

use std::ops::Range;

use super::graph::{Graph, Id, Op};

/// The block of each input; `None` for inputs in which every output is linear.
pub fn blocks(graph: &Graph, inputs: usize) -> Vec<Option<usize>> {
    let mut bent = vec![false; graph.ops.len()];
    let mut sets = Sets::new(graph.ops.len());
    let mut out = vec![None; inputs];
    for i in (0..graph.ops.len()).rev() {
        let above = bent[i];
        varying_operands(graph, graph.ops[i], |id, nonlinear| {
            if above || nonlinear {
                bent[id as usize] = true;
                sets.unite(i, id as usize);
            }
        });
    }
    for (i, op) in graph.ops.iter().enumerate() {
        if let (Op::Input(place), true) = (op, bent[i]) {
            out[*place as usize] = Some(sets.of(i));
        }
    }
    out
}

/// Operations that are looked at, and pairs that are listed, per operation and input of the model at most.
const FEW: usize = 64;

/// For each input those with which it may have mixed derivatives, itself included. Of a formula cut at intermediates, these are
/// inputs, too.
#[derive(Debug, Clone, PartialEq)]
pub struct Neighbours {
    /// Where the list of each input ends.
    ends: Vec<usize>,
    /// The lists, one behind the other, each in rising order.
    lists: Vec<usize>,
}

impl Neighbours {
    /// Within a block these are fewer where terms overlap, as in x₁x₂ + x₂x₃ + x₃x₄. `None` where they are not few.
    pub(super) fn new(graph: &Graph, inputs: usize) -> Option<Self> {
        let mut bent = vec![false; graph.ops.len()];
        let mut seen = vec![usize::MAX; graph.ops.len()];
        // Sets of inputs that meet in an operation, one behind the other, and where each ends.
        let (mut met, mut ends) = (Vec::new(), Vec::new());
        let (mut looks, mut pairs) = (0, 0);
        let mut open = Vec::new();
        for i in (0..graph.ops.len()).rev() {
            let above = bent[i];
            varying_operands(graph, graph.ops[i], |id, nonlinear| {
                bent[id as usize] |= above || nonlinear;
                if nonlinear && !above {
                    open.push(id);
                }
            });
            // All that reaches the outermost nonlinear operation may interact.
            let start = met.len();
            while let Some(id) = open.pop() {
                if std::mem::replace(&mut seen[id as usize], i) == i {
                    continue;
                }
                looks += 1;
                match graph.ops[id as usize] {
                    Op::Input(place) => met.push(place as usize),
                    op => varying_operands(graph, op, |id, _| open.push(id)),
                }
            }
            let together = met.len() - start;
            pairs += together * together;
            if looks > FEW * graph.ops.len() || pairs > FEW * inputs {
                return None;
            }
            if together > 0 {
                ends.push(met.len());
            }
        }
        Some(Self::of_sets(inputs, &met, &ends))
    }

    fn of_sets(inputs: usize, met: &[usize], ends: &[usize]) -> Self {
        let starts = std::iter::once(&0).chain(ends);
        let sets = || {
            starts
                .clone()
                .zip(ends)
                .map(|(start, end)| &met[*start..*end])
        };
        // Where the next entry of each input goes.
        let mut next = vec![0; inputs + 1];
        for set in sets() {
            set.iter().for_each(|input| next[input + 1] += set.len());
        }
        for input in 0..inputs {
            next[input + 1] += next[input];
        }
        let mut lists = vec![0; next[inputs]];
        for set in sets() {
            for input in set {
                lists[next[*input]..][..set.len()].copy_from_slice(set);
                next[*input] += set.len();
            }
        }
        let mut neighbours = Neighbours {
            ends: next[..inputs].to_vec(),
            lists,
        };
        neighbours.retain(|_| true);
        neighbours
    }

    /// How many inputs there are.
    pub fn inputs(&self) -> usize {
        self.ends.len()
    }

    /// Of one input, in rising order.
    pub fn of(&self, input: usize) -> &[usize] {
        &self.lists[self.places(input)]
    }

    /// Where the list of an input stands among all.
    pub fn places(&self, input: usize) -> Range<usize> {
        let start = input.checked_sub(1).map_or(0, |before| self.ends[before]);
        start..self.ends[input]
    }

    /// Length of all lists: pairs of inputs, each in both orders.
    pub fn pairs(&self) -> usize {
        self.lists.len()
    }

    /// Where, among all, a neighbour stands in the list of an input.
    pub fn place(&self, input: usize, neighbour: usize) -> Option<usize> {
        let places = self.places(input);
        let place = self.lists[places.clone()].binary_search(&neighbour).ok()?;
        Some(places.start + place)
    }

    /// Those of the first inputs, among these.
    pub fn among_first(mut self, inputs: usize) -> Self {
        self.ends.truncate(inputs);
        self.retain(|place| place < inputs);
        self
    }

    /// Leaves in the lists, each in rising order, what is to be kept, once.
    fn retain(&mut self, keep: impl Fn(usize) -> bool) {
        let (mut start, mut kept) = (0, 0);
        for end in &mut self.ends {
            let list = start..std::mem::replace(end, 0);
            start = list.end;
            self.lists[list.clone()].sort_unstable();
            let first = kept;
            for place in list {
                let neighbour = self.lists[place];
                let known = kept > first && self.lists[kept - 1] == neighbour;
                if !known && keep(neighbour) {
                    self.lists[kept] = neighbour;
                    kept += 1;
                }
            }
            *end = kept;
        }
        self.lists.truncate(kept);
    }
}

/// Shows the operands that are not constant, and whether the operation is nonlinear in them.
pub(super) fn varying_operands(graph: &Graph, op: Op, mut show: impl FnMut(Id, bool)) {
    let varies = |id: Id| graph.constant(id).is_none();
    let mut meets = |id: Id, nonlinear: bool| {
        if varies(id) {
            show(id, nonlinear);
        }
    };
    match op {
        Op::Unary(row, a) => meets(a, row.name != "-"),
        Op::Binary(row, a, b) => {
            let (in_a, in_b) = match row.name {
                "+" | "-" => (false, false),
                "*" => (varies(b), varies(a)),
                "/" | "quantize" => (varies(b), true),
                _ => (true, true),
            };
            meets(a, in_a);
            meets(b, in_b);
        }
        Op::Select(c, a, b) => {
            meets(c, true);
            meets(a, false);
            meets(b, false);
        }
        _ => graph.operands(op, |a| meets(a, true)),
    }
}

/// The degree, up to the second, of the polynomials that all outputs are of the given inputs together while the
/// others are held; `None` where an output is none, or of higher degree, or may not be.
pub fn degree(graph: &Graph, inputs: &[usize]) -> Option<u8> {
    let mut degrees: Vec<u8> = Vec::with_capacity(graph.ops.len());
    for op in &graph.ops {
        let of = |id: Id| degrees[id as usize];
        let degree = match *op {
            Op::Input(place) => u8::from(inputs.contains(&(place as usize))),
            Op::Constant(_) | Op::Unknown(_) => 0,
            Op::Unary(row, a) => match row.name {
                "-" => of(a),
                "^2" => 2 * of(a),
                _ => held(of(a) == 0)?,
            },
            Op::Binary(row, a, b) => match row.name {
                "+" | "-" => of(a).max(of(b)),
                "*" => of(a) + of(b),
                "/" if of(b) == 0 => of(a),
                _ => held(of(a).max(of(b)) == 0)?,
            },
            Op::Power(a, _) => held(of(a) == 0)?,
            Op::Select(c, a, b) => held(of(c) == 0)? + of(a).max(of(b)),
            Op::Solve(_) => {
                let mut all = 0;
                graph.operands(*op, |a| all |= of(a));
                held(all == 0)?
            }
        };
        if degree > 2 {
            return None;
        }
        degrees.push(degree);
    }
    graph.outputs.iter().map(|id| degrees[*id as usize]).max()
}

/// Degree zero, of what is the same wherever the inputs are.
fn held(all: bool) -> Option<u8> {
    all.then_some(0)
}

/// Disjoint sets with path halving.
struct Sets {
    parent: Vec<usize>,
}

impl Sets {
    fn new(count: usize) -> Self {
        Sets {
            parent: (0..count).collect(),
        }
    }

    fn of(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.parent[a] = b;
    }
}
