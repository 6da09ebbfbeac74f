//! Many budgets that differ in numbers alone, at once: what is reported of each, in columns.
//!
//! A row gets here what [`evaluate`](super::evaluate()) gives, to the last bit, or nothing. The figures are computed by the
//! same operations on 256 rows at a time. Of all that the general evaluation looks for (poles in reach, second-order terms,
//! coefficients that vanish, figures that the arithmetic does not resolve) bounds show that there is nothing to be found;
//! where they do not show it, the row is left to the general evaluation.

use std::collections::HashMap;

use gumption_core::distribution::Distribution;
use gumption_core::model::RowRunner;
use gumption_lanes::{Block, LANES};

use super::findings::{NEGLIGIBLE, REACH, RESIDUE, VANISHED};
use super::gum::settle;
use super::reported::Figures;
use super::resolution::{HARMLESS, NUDGE};
use super::result::FindingKind;
use super::second_order::moments;
use super::shape::Shape;
use super::{coverage, findings};
use crate::budget::{Budget, CoverageRule, Rows, Term};

/// Bounds are computed with errors of some 1e-14, and fulfilled with more to spare.
const SPARE: f64 = 1.01;

/// A row of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct RowFigures {
    /// What is reported of each measurand, and that its degrees of freedom are few, where they are: there are no other
    /// findings.
    pub measurands: Vec<(Figures, Option<FindingKind>)>,
    /// Of each measurand the share of each input in u²(y).
    pub shares: Vec<Vec<f64>>,
}

/// A component as it enters the measurands.
#[derive(Debug)]
struct Entry {
    component: usize,
    input: usize,
    coefficient: f64,
}

/// Evaluates rows of a budget.
#[derive(Debug)]
pub struct RowEvaluation {
    budget: Budget,
    runner: RowRunner,
    /// In the order of the components.
    entries: Vec<Entry>,
    /// Entries with a certificate, and the k of its U.
    references: Vec<(usize, f64)>,
    /// The largest standardised moments of the components: |μ3|, μ4.
    moments: [f64; 2],
    /// k by the bits of ν.
    factors: HashMap<u64, f64>,
    u: Vec<Block>,
    gradient: Vec<Block>,
    weights: Vec<Block>,
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
        let mut largest = [0.0_f64, 3.0];
        for component in &budget.components {
            let found = moments(&component.distribution);
            largest = [
                largest[0].max(found.third.abs()),
                largest[1].max(found.fourth),
            ];
        }
        let (inputs, count) = (budget.inputs.len(), entries.len());
        Some(RowEvaluation {
            references: references(budget, &entries),
            budget: budget.clone(),
            runner: RowRunner::new(&budget.model)?,
            entries,
            moments: largest,
            factors: HashMap::new(),
            u: vec![Block::ZERO; inputs],
            gradient: vec![Block::ZERO; inputs],
            weights: vec![Block::ZERO; count],
            nudged: vec![Block::ZERO; inputs],
            moved: vec![Block::ZERO; inputs],
        })
    }

    /// Evaluates the first `count` rows; nothing for those that the general evaluation must see.
    pub fn evaluate(&mut self, rows: &Rows, count: usize) -> Vec<Option<RowFigures>> {
        self.input_uncertainties(rows);
        self.runner.evaluate(&rows.estimates);
        self.runner.look_around(&self.u, REACH);
        let sure = |lane: usize| self.runner.doubt().0[lane] == 0.0;
        let empty = || RowFigures {
            measurands: Vec::with_capacity(self.budget.model.outputs().len()),
            shares: Vec::new(),
        };
        let mut found: Vec<Option<RowFigures>> =
            (0..count).map(|lane| sure(lane).then(empty)).collect();
        for measurand in 0..self.budget.model.outputs().len() {
            self.measurand(measurand, rows, &mut found);
        }
        found
    }

    /// As [`Covariance::uncertainty`](super::covariance::Covariance::uncertainty) of each input.
    fn input_uncertainties(&mut self, rows: &Rows) {
        let mut largest = vec![Block::ZERO; self.u.len()];
        for entry in &self.entries {
            let u = &rows.u[entry.component];
            for (largest, u) in largest[entry.input].0.iter_mut().zip(&u.0) {
                *largest = f64::max(*largest, (entry.coefficient * u).abs());
            }
        }
        self.u.fill(Block::ZERO);
        for entry in &self.entries {
            let (u, largest) = (&rows.u[entry.component], &largest[entry.input]);
            for lane in 0..LANES {
                let part = entry.coefficient * u.0[lane] / largest.0[lane];
                self.u[entry.input].0[lane] += part * part;
            }
        }
        for (u, largest) in self.u.iter_mut().zip(&largest) {
            for (u, largest) in u.0.iter_mut().zip(&largest.0) {
                *u = if *largest == 0.0 {
                    0.0
                } else {
                    largest * u.sqrt()
                };
            }
        }
    }

    fn measurand(&mut self, measurand: usize, rows: &Rows, found: &mut [Option<RowFigures>]) {
        self.runner.gradient(measurand, &mut self.gradient);
        let (u, dof) = self.first_order(rows);
        let values = *self.runner.values(measurand);
        let mut doubt = self.beyond_first_order(measurand, rows, &u);
        self.arithmetic(measurand, rows, &u, &mut doubt);
        for (lane, row) in found.iter_mut().enumerate() {
            let known = self.runner.known(measurand).at(lane);
            let mut value = values.0[lane];
            let sure = doubt.0[lane] == 0.0 && row.is_some() && value.is_finite();
            settle(&mut value, known.value[0], known.error);
            let figures = match sure {
                true => self.figures(value, u.0[lane], dof.0[lane], lane),
                false => None,
            };
            let Some((one, figures)) = row.as_mut().zip(figures) else {
                *row = None;
                continue;
            };
            one.measurands
                .push((figures, findings::few_degrees(dof.0[lane])));
            one.shares.push(self.shares(rows, u.0[lane], lane));
        }
    }

    /// The weights of the components, u(y) as [`norm`](super::covariance::norm) has it, and ν by Welch and Satterthwaite.
    fn first_order(&mut self, rows: &Rows) -> (Block, Block) {
        let mut largest = Block::ZERO;
        for (entry, weight) in self.entries.iter().zip(&mut self.weights) {
            let (c, u) = (&self.gradient[entry.input], &rows.u[entry.component]);
            for lane in 0..LANES {
                let one = (c.0[lane] * entry.coefficient) * u.0[lane];
                weight.0[lane] = one;
                // Of what is not a number u is none.
                largest.0[lane] = match one.is_nan() {
                    true => f64::NAN,
                    false if largest.0[lane] < one.abs() => one.abs(),
                    false => largest.0[lane],
                };
            }
        }
        let [mut u, mut sum] = [Block::ZERO; 2];
        for weight in &self.weights {
            for lane in 0..LANES {
                let part = weight.0[lane] / largest.0[lane];
                u.0[lane] += part * part;
            }
        }
        for (u, largest) in u.0.iter_mut().zip(&largest.0) {
            *u = largest * u.sqrt();
        }
        for (entry, weight) in self.entries.iter().zip(&self.weights) {
            let dof = &rows.dof[entry.component];
            for lane in 0..LANES {
                let part = weight.0[lane].abs() / u.0[lane];
                let square = part * part;
                sum.0[lane] += square * square / dof.0[lane];
            }
        }
        sum.0.iter_mut().for_each(|sum| *sum = 1.0 / *sum);
        (u, sum)
    }

    /// Marks the rows in which there may be something beyond first order: second-order terms that matter, a coefficient
    /// that vanishes, an input that is by far too large, references that are not covered.
    fn beyond_first_order(&self, measurand: usize, rows: &Rows, u: &Block) -> Block {
        let mut doubt = Block::ZERO;
        let bounds = self.runner.bounds(measurand);
        let [third, fourth] = self.moments.map(|moment| moment * SPARE);
        let (curved, drifting) = ((0.25 * (fourth - 1.0)).max(0.5), (fourth / 3.0).max(1.0));
        // δ of two digits is u/200 at least; u changes by half of what is added to u², or less than that and a little more.
        const TOLERATED: f64 = 0.005 / SPARE;
        for lane in 0..LANES {
            let u = u.0[lane];
            let of = |bound: &Block| bound.0[lane] / u;
            let (bend, drift) = (of(&bounds.second), of(&bounds.third));
            let added = third * bend + curved * bend * bend + drifting * drift;
            let nothing = 0.5 * of(&bounds.diagonal) <= TOLERATED
                && added <= 2.0 * TOLERATED / SPARE
                && u > 0.0
                && u < f64::MAX;
            doubt.0[lane] = f64::from(u8::from(!nothing));
        }
        let mut bends = vec![Block::ZERO; self.u.len()];
        for (inputs, factor, second) in self.runner.bends(measurand) {
            for input in inputs {
                for (lane, bend) in bends[*input].0.iter_mut().enumerate() {
                    *bend += factor.0[lane].abs() * second.0[lane];
                }
            }
        }
        let [mut largest, mut others, mut exceeds] = [Block::ZERO; 3];
        for (input, bend) in bends.iter().enumerate() {
            for lane in 0..LANES {
                let (c, own) = (self.gradient[input].0[lane], self.u[input].0[lane]);
                let x = rows.estimates[input].0[lane].abs();
                let (part, bend) = ((c * own).abs() / u.0[lane], bend.0[lane] / u.0[lane]);
                let seen = part > RESIDUE * SPARE
                    && (part >= VANISHED * SPARE * bend || bend * SPARE <= NEGLIGIBLE);
                if !(seen || own == 0.0) || !c.is_finite() {
                    doubt.0[lane] = 1.0;
                }
                others.0[lane] += part.min(largest.0[lane]);
                largest.0[lane] = part.max(largest.0[lane]);
                if own > x && x > 0.0 {
                    exceeds.0[lane] = 1.0;
                }
            }
        }
        // The length of the others is not less than this part of their sum.
        let part = 1.0 / (SPARE * (bends.len() as f64).sqrt());
        for lane in 0..LANES {
            let (largest, others) = (largest.0[lane], part * others.0[lane]);
            let limit = match exceeds.0[lane] == 0.0 {
                true => findings::BEYOND_DOUBT,
                false => findings::LARGE,
            };
            if others > 0.0 && largest > limit * others {
                doubt.0[lane] = 1.0;
            }
        }
        doubt
    }

    /// Marks the rows whose figures the arithmetic may not resolve.
    fn arithmetic(&mut self, measurand: usize, rows: &Rows, u: &Block, doubt: &mut Block) {
        // δ is at least this part of u.
        let digits = i32::from(self.budget.conventions.digits.max(1));
        let tolerated = 0.5 * 10f64.powi(-digits) / SPARE;
        let known = self.runner.known(measurand);
        let mut lossy = Block::ZERO;
        let mut any = false;
        for lane in 0..LANES {
            let known = known.at(lane);
            let limit = tolerated * u.0[lane];
            if !(known.error <= limit && known.doubles <= limit) {
                doubt.0[lane] = 1.0;
            }
            let harmless = known.doubles * SPARE <= HARMLESS * known.value[0].abs();
            if !harmless && doubt.0[lane] == 0.0 {
                lossy.0[lane] = 1.0;
                any = true;
            }
        }
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
                let gradients = self.moved.iter().zip(&self.gradient).zip(&self.u);
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

    /// What is reported, where k follows from a t-distribution or is fixed and no reference is known worse than the result.
    fn figures(&mut self, estimate: f64, u: f64, dof: f64, lane: usize) -> Option<Figures> {
        let conventions = &self.budget.conventions;
        let entered = conventions.degrees_of_freedom.entered(dof);
        let (k, dof) = match conventions.coverage_factor {
            CoverageRule::Fixed(k) => (k, None),
            CoverageRule::Normal => (self.factor(f64::INFINITY), Some(f64::INFINITY)),
            CoverageRule::Output if dof >= coverage::MANY && self.dominates(u, lane) => {
                return None;
            }
            CoverageRule::Output | CoverageRule::StudentT => (self.factor(entered), Some(entered)),
        };
        let expanded = k * u;
        let reference = |(entry, k): &(usize, f64)| k * self.weights[*entry].0[lane].abs();
        let covered = self
            .references
            .iter()
            .map(reference)
            .all(|one| one <= expanded);
        let whole = estimate.is_finite() && expanded > 0.0 && expanded.is_finite();
        (covered && whole).then_some(Figures {
            estimate,
            u: Some(u),
            dof,
            k: Some(k),
            expanded: Some(expanded),
            ends: Some([estimate - expanded, estimate + expanded]),
        })
    }

    /// The budget, of which the words hold and not the numbers.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    fn factor(&mut self, dof: f64) -> f64 {
        /// As many as tables of t have; real degrees of freedom are all different.
        const KEPT: usize = 4096;
        let p = self.budget.conventions.coverage_probability;
        if self.factors.len() > KEPT {
            self.factors.clear();
        }
        let factor = self.factors.entry(dof.to_bits());
        *factor.or_insert_with(|| Shape::student_t(dof).half_width(p))
    }

    /// Whether one component that is not normal, or two rectangles, may dominate.
    fn dominates(&self, u: f64, lane: usize) -> bool {
        let mut rectangles = [0.0_f64; 2];
        for (entry, weight) in self.entries.iter().zip(&self.weights) {
            let part = weight.0[lane].abs() / u;
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

    /// As [`Linear::input_lines`](super::gum::Linear::input_lines).
    fn shares(&self, rows: &Rows, u: f64, lane: usize) -> Vec<f64> {
        // The sum of no shares is zero, not −0.
        let mut shares = vec![0.0; self.u.len()];
        for (entry, standard) in self.entries.iter().zip(&self.weights) {
            let own = entry.coefficient * rows.u[entry.component].0[lane];
            let weight = self.gradient[entry.input].0[lane] * own;
            if weight != 0.0 && self.u[entry.input].0[lane] > 0.0 {
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

#[cfg(test)]
mod tests {
    use super::super::draft::Draft;
    use super::super::{MonteCarloChoice, Options, evaluate};
    use super::*;
    use gumption_core::distribution::{Normal, Uniform};

    /// SplitMix64 on (0, 1).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }

        /// With six decimals, or with all digits.
        fn between(&mut self, low: f64, high: f64) -> f64 {
            let x = low + (high - low) * self.next();
            if self.next() < 0.7 {
                (x * 1e6).round() / 1e6
            } else {
                x
            }
        }
    }

    /// A budget with normal components, the last with limits.
    fn budget(model: &str) -> Budget {
        let names = ["a", "b", "c", "d", "e"];
        let add = |draft: Draft, (at, name): (usize, &&str)| match at {
            4 => draft.rectangle(name, 1.5, 0.02, f64::INFINITY),
            _ => draft.normal(name, 1.5, 0.01, 5.0 + at as f64),
        };
        let draft = names.iter().enumerate().fold(Draft::new(), add);
        draft.budget(0.95, &[("y", model)])
    }

    /// Rows of all kinds: most with small uncertainties, some whose uncertainties are large, or whose values nearly cancel.
    fn rows(budget: &Budget, numbers: &mut Numbers) -> Rows {
        let mut rows = Rows::of(budget);
        for lane in 0..LANES {
            let wide = if lane % 8 == 7 { 0.5 } else { 0.005 };
            for at in 0..budget.inputs.len() {
                rows.estimates[at].0[lane] = numbers.between(0.2, 9.0);
                rows.u[at].0[lane] = numbers.between(1e-6, wide);
            }
            rows.dof[0].0[lane] = numbers.between(2.0, 200.0);
            if lane % 8 == 3 {
                rows.estimates[1].0[lane] =
                    rows.estimates[0].0[lane] + numbers.between(-1e-6, 1e-6);
            }
        }
        rows
    }

    /// The budget with a row written into it.
    fn written(budget: &Budget, rows: &Rows, lane: usize) -> Budget {
        let mut budget = budget.clone();
        for (input, x) in budget.inputs.iter_mut().zip(&rows.estimates) {
            input.estimate = x.0[lane];
        }
        for (at, component) in budget.components.iter_mut().enumerate() {
            (component.u, component.dof) = (rows.u[at].0[lane], rows.dof[at].0[lane]);
            let half = component.u * 3f64.sqrt();
            component.distribution = match component.distribution {
                Distribution::Uniform(_) => Distribution::Uniform(Uniform {
                    lower: -half,
                    upper: half,
                }),
                _ => Distribution::Normal(Normal {
                    mean: 0.0,
                    sd: component.u,
                }),
            };
        }
        budget
    }

    #[test]
    fn rows_are_what_the_general_evaluation_gives_to_the_last_bit() {
        let models = [
            ("a * b / c + d * e", 0.7),
            ("a - b + 0.001 * c + d - e", 0.7),
            ("a * b * c * d * e", 0.7),
            ("(a - b) / c + d^2 + 1 / e", 0.5),
            ("sqrt(a * b) + ln(c) - sin(d) + exp(-e)", 0.5),
            ("a^3 / (b + c)^2 - d^0.5 + e", 0.5),
            ("a * b + a * c + d / a + e", 0.5),
            ("((a + b) * c)^2 / (d + e) + a", 0.5),
        ];
        let mut numbers = Numbers(1);
        let options = Options {
            monte_carlo: MonteCarloChoice::Off,
            threads: 1,
            ..Options::default()
        };
        for (model, least) in models {
            let budget = budget(model);
            let mut rows_of = RowEvaluation::new(&budget).expect("a budget for rows");
            let (mut taken, mut all) = (0, 0);
            for _ in 0..4 {
                let rows = rows(&budget, &mut numbers);
                for (lane, found) in rows_of.evaluate(&rows, LANES).into_iter().enumerate() {
                    all += 1;
                    let Some(found) = found else { continue };
                    taken += 1;
                    let budget = written(&budget, &rows, lane);
                    let expected = evaluate(&budget, &options).expect("a value");
                    let result = &expected.results[0];
                    let reported = result.reported(&budget.conventions).figures();
                    let place = format!("{model}, lane {lane}");
                    assert_eq!(found.measurands[0].0, reported, "{place}");
                    let kinds: Vec<_> = expected.findings.into_iter().map(|one| one.kind).collect();
                    let only: Vec<_> = found.measurands[0].1.iter().cloned().collect();
                    assert_eq!(kinds, only, "{place}");
                    let shares: Vec<f64> =
                        result.gum.inputs.iter().map(|line| line.share).collect();
                    assert_eq!(found.shares[0], shares, "{place}");
                }
            }
            // Else the bounds are worth nothing.
            assert!(
                f64::from(taken) > least * f64::from(all),
                "{model}: {taken} of {all}"
            );
        }
    }
}
