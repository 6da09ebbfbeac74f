//! Sums that one instruction forms: a pass over blocks mostly moves numbers about, so that several
//! additions, and the products among their terms, are best done in one.

use gumption_lanes::Block;
use gumption_lanes::sum;
use smallvec::SmallVec;

use super::graph::{Graph, Id, Op};
use super::operation::Rule;

/// Most terms of a sum; those that are no inputs wait in registers for it.
pub(super) const MOST: usize = 4;

/// A term of a sum, of operations or of their places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Term<T> {
    Plus(T),
    Minus(T),
    PlusProduct(T, T),
    MinusProduct(T, T),
}

impl<T: Copy> Term<T> {
    fn negated(self) -> Self {
        match self {
            Term::Plus(a) => Term::Minus(a),
            Term::Minus(a) => Term::Plus(a),
            Term::PlusProduct(a, b) => Term::MinusProduct(a, b),
            Term::MinusProduct(a, b) => Term::PlusProduct(a, b),
        }
    }

    /// The same of what a function makes of the operands.
    pub(super) fn map<U>(self, mut f: impl FnMut(T) -> U) -> Term<U> {
        match self {
            Term::Plus(a) => Term::Plus(f(a)),
            Term::Minus(a) => Term::Minus(f(a)),
            Term::PlusProduct(a, b) => Term::PlusProduct(f(a), f(b)),
            Term::MinusProduct(a, b) => Term::MinusProduct(f(a), f(b)),
        }
    }
}

impl<'a> Term<&'a Block> {
    /// As the kernel takes it.
    pub(super) fn of_blocks(self) -> sum::Term<'a> {
        match self {
            Term::Plus(a) => sum::Term::Plus(a),
            Term::Minus(a) => sum::Term::Minus(a),
            Term::PlusProduct(a, b) => sum::Term::PlusProduct(a, b),
            Term::MinusProduct(a, b) => sum::Term::MinusProduct(a, b),
        }
    }
}

/// Finds the sums of a graph.
pub(super) struct Sums<'g> {
    graph: &'g Graph,
    /// How often the outputs and what they need use each operation.
    uses: Vec<usize>,
}

impl<'g> Sums<'g> {
    /// Looks at who uses what.
    pub(super) fn new(graph: &'g Graph) -> Self {
        let mut uses = vec![0; graph.ops.len()];
        graph.outputs.iter().for_each(|id| uses[*id as usize] += 1);
        let needed = graph.needed(&graph.outputs);
        for (op, _) in graph.ops.iter().zip(needed).filter(|(_, needed)| *needed) {
            graph.operands(*op, |a| uses[a as usize] += 1);
        }
        Sums { graph, uses }
    }

    /// The terms of a sum, to be added in their order; `None` where single operations do as well.
    pub(super) fn terms(&self, id: Id) -> Option<SmallVec<[Term<Id>; MOST]>> {
        let mut terms = SmallVec::new();
        let mut sum = Some(self.parts(id)?);
        // From the last term to the first.
        while let Some((rest, last)) = sum {
            terms.push(last);
            let room = terms.len() + 2 <= MOST;
            sum = self.parts(rest).filter(|_| room && self.is_inner(rest));
            if sum.is_none() {
                terms.push(self.term(rest));
            }
        }
        terms.reverse();
        let plain = |term: &Term<Id>| matches!(term, Term::Plus(_) | Term::Minus(_));
        (terms.len() > 2 || !terms.iter().all(plain)).then_some(terms)
    }

    /// What comes first in a sum of two, and the second term.
    fn parts(&self, id: Id) -> Option<(Id, Term<Id>)> {
        let (rule, a, b) = self.binary(id)?;
        let is_sum = |id| {
            let sum = matches!(self.binary(id), Some((Rule::Add | Rule::Sub, ..)));
            sum && self.is_inner(id)
        };
        match rule {
            Rule::Add if is_sum(b) && !is_sum(a) => Some((b, self.term(a))),
            Rule::Add => Some((a, self.term(b))),
            Rule::Sub => Some((a, self.term(b).negated())),
            _ => None,
        }
    }

    fn term(&self, id: Id) -> Term<Id> {
        match (self.graph.ops[id as usize], self.binary(id)) {
            (Op::Unary(row, a), _) if row.name == "^2" && self.is_inner(id) => {
                Term::PlusProduct(a, a)
            }
            (_, Some((Rule::Mul, a, b))) if self.is_inner(id) => Term::PlusProduct(a, b),
            _ => Term::Plus(id),
        }
    }

    /// An operation of two operands that are no constants.
    fn binary(&self, id: Id) -> Option<(Rule, Id, Id)> {
        let Op::Binary(row, a, b) = self.graph.ops[id as usize] else {
            return None;
        };
        let variable = |id| self.graph.constant(id).is_none();
        (variable(a) && variable(b)).then_some((row.rule, a, b))
    }

    /// Whether an operation has one use only, so that nobody misses its result.
    fn is_inner(&self, id: Id) -> bool {
        self.uses[id as usize] == 1
    }
}
