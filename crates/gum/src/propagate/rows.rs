//! Many budgets that differ in numbers alone, at once: what is reported of each, in columns.
//!
//! A row gets here what [`evaluate`](super::evaluate()) gives, to the last bit, or nothing. The figures are computed by the
//! same operations on 256 rows at a time. Of all that the general evaluation looks for (poles in reach, second-order terms,
//! coefficients that vanish, figures that the arithmetic does not resolve) bounds show that there is nothing to be found;
//! where they do not show it, the row is left to the general evaluation.

use std::ops::Range;

use gumption_core::distribution::Distribution;
use gumption_core::model::RowRunner;
use gumption_lanes::linear::{self, Contest, Entrant, Sight, Tolerated};
use gumption_lanes::{Block, LANES, Level, level};

use super::findings::{NEGLIGIBLE, REACH, RESIDUE, VANISHED};
use super::reported::Figures;
use super::resolution::{HARMLESS, NUDGE};
use super::result::FindingKind;
use super::second_order::moments;
use super::shape::Shape;
use super::{coverage, findings};
use crate::budget::{Budget, CoverageRule, DofRule, Rows, Term};

/// Bounds are computed with errors of some 1e-14, and fulfilled with more to spare.
const SPARE: f64 = 1.01;

/// k of so many ν is kept: as many as tables of t have; real degrees of freedom are all different.
const KEPT: usize = 4096;

/// Rows of a block that were evaluated, one after the other: what is reported of each measurand, and that its degrees of freedom
/// are few, where they are: there are no other findings.
#[derive(Debug, Clone)]
pub struct BlockFigures<'a> {
    of: &'a RowEvaluation,
    rows: &'a Rows,
    lanes: Range<usize>,
}

/// One of them.
#[derive(Debug, Clone, Copy)]
pub struct RowFigures<'a> {
    of: &'a RowEvaluation,
    rows: &'a Rows,
    lane: usize,
}

/// What is reported of a measurand of rows, as columns; what a row has not is nothing.
#[derive(Debug, Clone, Copy)]
pub struct FigureColumns<'a> {
    /// As of [`Figures`].
    pub estimate: &'a [f64],
    /// u.
    pub u: &'a [f64],
    /// ν_eff of u as t is entered by it, whatever k comes from.
    pub dof: &'a [f64],
    /// k.
    pub k: &'a [f64],
    /// U.
    pub expanded: &'a [f64],
    /// y − U and y + U.
    pub ends: [&'a [f64]; 2],
}

/// A component as it enters the measurands.
#[derive(Debug)]
struct Entry {
    component: usize,
    input: usize,
    coefficient: f64,
}

/// What is found of a measurand.
#[derive(Debug)]
struct Measurand {
    /// Whether it depends on an input at all: one on which it does not has no coefficient that could vanish.
    uses: Vec<bool>,
    gradient: Vec<Block>,
    /// Of the entries, u times derivative.
    weights: Vec<Block>,
    estimate: Block,
    u: Block,
    dof: Block,
    /// ν by which k is entered.
    entered: Block,
    k: Block,
    expanded: Block,
    ends: [Block; 2],
}

/// Evaluates rows of a budget.
#[derive(Debug)]
pub struct RowEvaluation {
    budget: Budget,
    runner: RowRunner,
    level: Level,
    /// In the order of the components.
    entries: Vec<Entry>,
    /// How many entries each input has.
    parts: Vec<usize>,
    /// Entries with a certificate, and the k of its U.
    references: Vec<(usize, f64)>,
    /// Whether a component that is not normal may dominate.
    other_shapes: bool,
    /// What second-order terms may add.
    tolerated: Tolerated,
    /// ν and its k, by the whole part of ν.
    factors: Vec<[f64; 2]>,
    u: Vec<Block>,
    measurands: Vec<Measurand>,
    /// Marks the rows that the general evaluation must see.
    doubt: Block,
    bends: Vec<Block>,
    nudged: Vec<Block>,
    moved: Vec<Block>,
}

impl RowEvaluation {
    /// `None` for a budget that asks for more than its measurands, whose components correlate or are shared, or whose model
    /// has more than [`RowRunner`] takes.
    pub fn new(budget: &Budget) -> Option<Self> {
        let more = !budget.groups.is_empty()
            || !budget.conformity.is_empty()
            || !budget.detection.is_empty()
            || !budget.fits.is_empty()
            || !budget.claims.is_empty();
        if more {
            return None;
        }
        let terms = budget.inputs.iter().enumerate();
        let mut entries: Vec<Entry> = terms
            .flat_map(|(input, one)| {
                let entry = move |term: &Term| Entry {
                    component: term.component,
                    input,
                    coefficient: term.coefficient,
                };
                one.terms.iter().map(entry)
            })
            .collect();
        entries.sort_by_key(|entry| entry.component);
        let mut pairs = entries.windows(2);
        if pairs.any(|pair| pair[0].component == pair[1].component) {
            return None;
        }
        let (inputs, count) = (budget.inputs.len(), entries.len());
        let measurand = |at: usize| Measurand {
            uses: budget.model.inputs_of(at),
            gradient: vec![Block::ZERO; inputs],
            weights: vec![Block::ZERO; count],
            estimate: Block::ZERO,
            u: Block::ZERO,
            dof: Block::ZERO,
            entered: Block::ZERO,
            k: Block::ZERO,
            expanded: Block::ZERO,
            ends: [Block::ZERO; 2],
        };
        let blocks = || vec![Block::ZERO; inputs];
        Some(RowEvaluation {
            references: references(budget, &entries),
            other_shapes: entries.iter().any(|entry| !is_bell(budget, entry)),
            tolerated: tolerated(budget),
            budget: budget.clone(),
            runner: RowRunner::new(&budget.model)?,
            level: level(),
            parts: budget.inputs.iter().map(|one| one.terms.len()).collect(),
            entries,
            factors: vec![[f64::NAN; 2]; KEPT],
            u: blocks(),
            measurands: (0..budget.model.outputs().len()).map(measurand).collect(),
            doubt: Block::ZERO,
            bends: blocks(),
            nudged: blocks(),
            moved: blocks(),
        })
    }

    /// Evaluates the first `count` rows.
    pub fn evaluate(&mut self, rows: &Rows, count: usize) {
        self.input_uncertainties(rows);
        self.runner.evaluate(&rows.estimates);
        self.runner.look_around(&self.u, REACH);
        self.doubt = *self.runner.doubt();
        for at in 0..self.measurands.len() {
            self.measurand(at, rows, count);
        }
    }

    /// The budget, of which the words hold and not the numbers.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Marks the rows that the general evaluation must see.
    pub fn doubt(&self) -> &Block {
        &self.doubt
    }

    /// What was found of rows without doubt.
    pub fn figures<'a>(&'a self, rows: &'a Rows, lanes: Range<usize>) -> BlockFigures<'a> {
        let of = self;
        BlockFigures { of, rows, lanes }
    }

    /// As [`Covariance::uncertainty`](super::covariance::Covariance::uncertainty) of each input.
    fn input_uncertainties(&mut self, rows: &Rows) {
        let mut largest = vec![Block::ZERO; self.u.len()];
        let level = self.level;
        let of = |entry: &Entry| (entry.coefficient, &rows.u[entry.component]);
        for entry in &self.entries {
            let (coefficient, u) = of(entry);
            linear::raise(level, coefficient, u, &mut largest[entry.input]);
        }
        // The length of one number is its size.
        let several = |input: usize| self.parts[input] > 1;
        self.u.fill(Block::ZERO);
        for entry in self.entries.iter().filter(|entry| several(entry.input)) {
            let ((coefficient, u), input) = (of(entry), entry.input);
            linear::add_square(level, coefficient, u, &largest[input], &mut self.u[input]);
        }
        for (input, (u, largest)) in self.u.iter_mut().zip(&largest).enumerate() {
            match several(input) {
                true => linear::length(level, largest, u),
                false => *u = *largest,
            }
        }
    }

    fn measurand(&mut self, at: usize, rows: &Rows, count: usize) {
        self.runner.gradient(at, &mut self.measurands[at].gradient);
        self.first_order(at, rows);
        self.measurands[at].estimate = *self.runner.values(at);
        self.beyond_first_order(at, rows);
        self.arithmetic(at, rows);
        let (level, known) = (self.level, self.runner.known(at));
        let estimate = &mut self.measurands[at].estimate;
        linear::settle(level, estimate, known, &mut self.doubt);
        self.coverage(at, count);
    }

    /// The weights of the components, u(y) as [`norm`](super::covariance::norm) has it, and ν by Welch and Satterthwaite.
    fn first_order(&mut self, at: usize, rows: &Rows) {
        let (of, level) = (&mut self.measurands[at], self.level);
        let mut largest = Block::ZERO;
        for (entry, weight) in self.entries.iter().zip(&mut of.weights) {
            let factors = [&of.gradient[entry.input], &rows.u[entry.component]];
            linear::weigh(level, factors, entry.coefficient, weight, &mut largest);
        }
        (of.u, of.dof) = (Block::ZERO, Block::ZERO);
        for weight in &of.weights {
            linear::add_square(level, 1.0, weight, &largest, &mut of.u);
        }
        linear::length(level, &largest, &mut of.u);
        for (entry, weight) in self.entries.iter().zip(&of.weights) {
            let dof = &rows.dof[entry.component];
            linear::add_freedom(level, [weight, &of.u, dof], &mut of.dof);
        }
        linear::invert(level, &mut of.dof);
    }

    /// Marks the rows in which there may be something beyond first order: second-order terms that matter, a coefficient
    /// that vanishes, an input that is by far too large.
    fn beyond_first_order(&mut self, measurand: usize, rows: &Rows) {
        let Measurand {
            uses, gradient, u, ..
        } = &self.measurands[measurand];
        let (doubt, level) = (&mut self.doubt, self.level);
        let bounds = self.runner.bounds(measurand);
        linear::bends(level, bounds, u, self.tolerated, doubt);
        self.bends.fill(Block::ZERO);
        for (inputs, factor, second) in self.runner.bends(measurand) {
            for input in inputs {
                linear::add_size(level, factor, second, &mut self.bends[*input]);
            }
        }
        let sight = Sight {
            least: RESIDUE * SPARE,
            vanished: VANISHED * SPARE,
            negligible: NEGLIGIBLE / SPARE,
        };
        let mut contest = Contest::OPEN;
        for (input, bend) in self
            .bends
            .iter()
            .enumerate()
            .filter(|(input, _)| uses[*input])
        {
            let entrant = Entrant {
                x: &rows.estimates[input],
                own: &self.u[input],
                derivative: &gradient[input],
                bend,
                u,
            };
            contest.add(level, entrant, sight, doubt);
        }
        // The length of the others is not less than this part of their sum.
        let part = 1.0 / (SPARE * (self.bends.len() as f64).sqrt());
        let limits = [findings::BEYOND_DOUBT, findings::LARGE];
        contest.end(level, part, limits, doubt);
    }

    /// Marks the rows whose figures the arithmetic may not resolve.
    fn arithmetic(&mut self, measurand: usize, rows: &Rows) {
        let Measurand { gradient, u, .. } = &self.measurands[measurand];
        let (doubt, level) = (&mut self.doubt, self.level);
        // δ is at least this part of u.
        let digits = i32::from(self.budget.conventions.digits.max(1));
        let tolerated = 0.5 * 10f64.powi(-digits) / SPARE;
        let limits = [tolerated, HARMLESS / SPARE];
        let known = self.runner.known(measurand);
        let mut lossy = Block::ZERO;
        let any = linear::resolves(level, known, u, limits, doubt, &mut lossy);
        let bent = self.runner.bends(measurand);
        let straight = bent
            .into_iter()
            .all(|(_, _, second)| second == &Block::ZERO);
        if !any || straight {
            return;
        }
        for step in [1.0, -1.0, 2.0] {
            for (nudged, x) in self.nudged.iter_mut().zip(&rows.estimates) {
                for (nudged, x) in nudged.0.iter_mut().zip(&x.0) {
                    *nudged = x * (1.0 + step * NUDGE);
                }
            }
            self.runner.evaluate(&self.nudged);
            self.runner.gradient(measurand, &mut self.moved);
            for lane in (0..LANES).filter(|lane| lossy.0[*lane] != 0.0) {
                let gradients = self.moved.iter().zip(gradient).zip(&self.u);
                let moved =
                    gradients.map(|((moved, c), u)| (moved.0[lane] - c.0[lane]).abs() * u.0[lane]);
                let moved: f64 = moved.sum();
                let stays = moved <= tolerated * u.0[lane];
                if !stays {
                    doubt.0[lane] = 1.0;
                }
            }
        }
        self.runner.evaluate(&rows.estimates);
    }

    /// Finds k, where it follows from a t-distribution or is fixed, U and the interval; marks the rows in which that is not so, or
    /// a reference is known worse than the result.
    fn coverage(&mut self, at: usize, count: usize) {
        let (level, conventions) = (self.level, &self.budget.conventions);
        let of = &mut self.measurands[at];
        match conventions.degrees_of_freedom {
            DofRule::Truncated => linear::cut_all(level, &of.dof, &mut of.entered),
            _ => of.entered = of.dof,
        }
        match conventions.coverage_factor {
            CoverageRule::Fixed(k) => of.k = Block([k; LANES]),
            CoverageRule::Normal => {
                self.measurands[at].k = Block([self.factor(f64::INFINITY); LANES]);
            }
            rule @ (CoverageRule::Output | CoverageRule::StudentT) => {
                let shaped = matches!(rule, CoverageRule::Output) && self.other_shapes;
                self.student(at, count, shaped);
            }
        }
        let of = &mut self.measurands[at];
        let (figures, doubt) = ([&of.estimate, &of.u, &of.k], &mut self.doubt);
        linear::intervals(level, figures, &mut of.expanded, &mut of.ends, doubt);
        for (entry, k) in &self.references {
            linear::covers(level, &of.weights[*entry], *k, &of.expanded, doubt);
        }
    }

    /// k of a t-distribution; a row is marked where that of another shape may dominate.
    fn student(&mut self, at: usize, count: usize, shaped: bool) {
        for lane in 0..count {
            if self.doubt.0[lane] != 0.0 {
                continue;
            }
            let dof = self.measurands[at].dof.0[lane];
            if shaped && dof >= coverage::MANY && self.dominates(at, lane) {
                self.doubt.0[lane] = 1.0;
                continue;
            }
            let k = self.factor(self.measurands[at].entered.0[lane]);
            self.measurands[at].k.0[lane] = k;
        }
    }

    fn factor(&mut self, dof: f64) -> f64 {
        let p = self.budget.conventions.coverage_probability;
        let [known, k] = &mut self.factors[dof.min(KEPT as f64 - 1.0) as usize];
        if *known != dof {
            [*known, *k] = [dof, Shape::student_t(dof).half_width(p)];
        }
        *k
    }

    /// Whether one component that is not normal, or two rectangles, may dominate.
    fn dominates(&self, at: usize, lane: usize) -> bool {
        let Measurand { weights, u, .. } = &self.measurands[at];
        let mut rectangles = [0.0_f64; 2];
        for (entry, weight) in self.entries.iter().zip(weights) {
            let part = weight.0[lane].abs() / u.0[lane];
            match self.budget.components[entry.component].distribution {
                Distribution::Normal(_) | Distribution::StudentT(_) => continue,
                Distribution::Uniform(_) if part > rectangles[0] => {
                    rectangles = [part, rectangles[0]];
                }
                Distribution::Uniform(_) => rectangles[1] = rectangles[1].max(part),
                _ => {}
            }
            if coverage::is_dominated_by(part * SPARE) {
                return true;
            }
        }
        let [first, second] = rectangles.map(|part| part * SPARE);
        second > 0.0 && coverage::is_dominated_by_pair(first, second)
    }
}

impl RowEvaluation {
    fn columns(&self, measurand: usize, lanes: Range<usize>) -> FigureColumns<'_> {
        let of = &self.measurands[measurand];
        FigureColumns {
            estimate: &of.estimate.0[lanes.clone()],
            u: &of.u.0[lanes.clone()],
            dof: &of.entered.0[lanes.clone()],
            k: &of.k.0[lanes.clone()],
            expanded: &of.expanded.0[lanes.clone()],
            ends: [&of.ends[0].0[lanes.clone()], &of.ends[1].0[lanes]],
        }
    }
}

impl<'a> BlockFigures<'a> {
    /// How many rows there are.
    pub fn count(&self) -> usize {
        self.lanes.len()
    }

    /// What is reported of a measurand.
    pub fn columns(&self, measurand: usize) -> FigureColumns<'a> {
        self.of.columns(measurand, self.lanes.clone())
    }

    /// Of each row.
    pub fn rows(&self) -> impl Iterator<Item = RowFigures<'a>> + use<'a> {
        let (of, rows) = (self.of, self.rows);
        self.lanes
            .clone()
            .map(move |lane| RowFigures { of, rows, lane })
    }

    /// The share of each input in u²(y).
    pub fn shares(&self, measurand: usize) -> Vec<Vec<f64>> {
        let mut shares = vec![Vec::with_capacity(self.count()); self.of.u.len()];
        for row in self.rows() {
            let of_row = row.shares(measurand).into_iter();
            shares
                .iter_mut()
                .zip(of_row)
                .for_each(|(all, one)| all.push(one));
        }
        shares
    }

    /// Whether any of them has few degrees of freedom.
    pub fn have_few_degrees(&self, measurand: usize) -> bool {
        let dof = &self.of.measurands[measurand].dof.0[self.lanes.clone()];
        dof.iter().any(|dof| findings::few_degrees(*dof).is_some())
    }

    /// c·u of each component, with sign.
    pub fn contributions(&self, measurand: usize) -> Vec<&'a [f64]> {
        const NOTHING: &Block = &Block::ZERO;
        let mut contributions = vec![&NOTHING.0[self.lanes.clone()]; self.rows.u.len()];
        let weights = &self.of.measurands[measurand].weights;
        for (entry, weight) in self.of.entries.iter().zip(weights) {
            contributions[entry.component] = &weight.0[self.lanes.clone()];
        }
        contributions
    }
}

impl RowFigures<'_> {
    /// What is reported of a measurand.
    pub fn figures(&self, measurand: usize) -> Figures {
        let of = self.of.columns(measurand, self.lane..self.lane + 1);
        Figures {
            estimate: of.estimate[0],
            u: Some(of.u[0]),
            dof: Some(of.dof[0]),
            k: Some(of.k[0]),
            expanded: Some(of.expanded[0]),
            ends: Some(of.ends.map(|end| end[0])),
        }
    }

    /// That its degrees of freedom are few.
    pub fn few_degrees(&self, measurand: usize) -> Option<FindingKind> {
        findings::few_degrees(self.of.measurands[measurand].dof.0[self.lane])
    }

    /// c·u of each component, with sign.
    pub fn contributions(&self, measurand: usize) -> Vec<f64> {
        let mut contributions = vec![0.0; self.rows.u.len()];
        let weights = &self.of.measurands[measurand].weights;
        for (entry, weight) in self.of.entries.iter().zip(weights) {
            contributions[entry.component] = weight.0[self.lane];
        }
        contributions
    }

    /// The share of each input in u²(y), as the lines of the inputs of one budget have it.
    pub fn shares(&self, measurand: usize) -> Vec<f64> {
        let (of, lane) = (&self.of.measurands[measurand], self.lane);
        let u = of.u.0[lane];
        // The sum of no shares is zero, not −0.
        let mut shares = vec![0.0; self.of.u.len()];
        for (entry, standard) in self.of.entries.iter().zip(&of.weights) {
            let own = entry.coefficient * self.rows.u[entry.component].0[lane];
            let weight = of.gradient[entry.input].0[lane] * own;
            if weight != 0.0 && self.of.u[entry.input].0[lane] > 0.0 {
                shares[entry.input] += (weight / u) * (standard.0[lane] / u);
            }
        }
        shares
    }
}

/// The entries with a certificate, with the k of its U.
fn references(budget: &Budget, entries: &[Entry]) -> Vec<(usize, f64)> {
    let entries = entries.iter().enumerate();
    let references = entries.filter_map(|(at, entry)| {
        let certificate = budget.components[entry.component].certificate.as_ref()?;
        Some((at, findings::certified_factor(certificate.k)))
    });
    references.collect()
}

/// Whether a component is normal, or of a t-distribution.
fn is_bell(budget: &Budget, entry: &Entry) -> bool {
    let distribution = &budget.components[entry.component].distribution;
    matches!(
        distribution,
        Distribution::Normal(_) | Distribution::StudentT(_)
    )
}

/// What second-order terms may add, where nothing is to be found.
fn tolerated(budget: &Budget) -> Tolerated {
    // The largest standardised moments of the components: |μ3|, μ4.
    let [mut third, mut fourth] = [0.0_f64, 3.0];
    for component in &budget.components {
        let found = moments(&component.distribution);
        third = third.max(found.third.abs());
        fourth = fourth.max(found.fourth);
    }
    let [third, fourth] = [third, fourth].map(|moment| moment * SPARE);
    // δ of two digits is u/200 at least; u changes by half of what is added to u², or less than that and a little more.
    const SHIFT: f64 = 0.005 / SPARE;
    Tolerated {
        factors: [
            third,
            (0.25 * (fourth - 1.0)).max(0.5),
            (fourth / 3.0).max(1.0),
        ],
        shift: SHIFT,
        added: 2.0 * SHIFT / SPARE,
    }
}

#[cfg(test)]
mod tests;
