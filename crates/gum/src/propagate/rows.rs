//! Many budgets that differ in numbers alone, at once: what is reported of each, in columns.
//!
//! A row gets here what [`evaluate`](super::evaluate()) gives, to the last bit, or nothing. The figures are computed by the
//! same operations on 256 rows at a time. Of all that the general evaluation looks for (poles in reach, second-order terms,
//! coefficients that vanish, figures that the arithmetic does not resolve) bounds show that there is nothing to be found;
//! where they do not show it, the row is left to the general evaluation.

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

/// k of so many ν is kept: as many as tables of t have; real degrees of freedom are all different.
const KEPT: usize = 4096;

/// A row of a block that was evaluated: what is reported of each measurand, and that its degrees of freedom are few, where
/// they are: there are no other findings.
#[derive(Debug, Clone, Copy)]
pub struct RowFigures<'a> {
    of: &'a RowEvaluation,
    rows: &'a Rows,
    lane: usize,
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
    gradient: Vec<Block>,
    /// Of the entries, u times derivative.
    weights: Vec<Block>,
    estimate: Block,
    u: Block,
    dof: Block,
    k: Block,
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
    /// ν and its k, by the whole part of ν.
    factors: Vec<[f64; 2]>,
    u: Vec<Block>,
    measurands: Vec<Measurand>,
    /// Marks the rows that the general evaluation must see.
    doubt: Block,
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
        let measurand = |_| Measurand {
            gradient: vec![Block::ZERO; inputs],
            weights: vec![Block::ZERO; count],
            estimate: Block::ZERO,
            u: Block::ZERO,
            dof: Block::ZERO,
            k: Block::ZERO,
        };
        Some(RowEvaluation {
            references: references(budget, &entries),
            budget: budget.clone(),
            runner: RowRunner::new(&budget.model)?,
            entries,
            moments: largest,
            factors: vec![[f64::NAN; 2]; KEPT],
            u: vec![Block::ZERO; inputs],
            measurands: budget.model.outputs().iter().map(measurand).collect(),
            doubt: Block::ZERO,
            nudged: vec![Block::ZERO; inputs],
            moved: vec![Block::ZERO; inputs],
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

    /// What was found of a row; nothing where the general evaluation must see it.
    pub fn row<'a>(&'a self, rows: &'a Rows, lane: usize) -> Option<RowFigures<'a>> {
        let of = self;
        (self.doubt.0[lane] == 0.0).then_some(RowFigures { of, rows, lane })
    }

    /// As [`Covariance::uncertainty`](super::covariance::Covariance::uncertainty) of each input.
    fn input_uncertainties(&mut self, rows: &Rows) {
        let mut largest = vec![Block::ZERO; self.u.len()];
        for entry in &self.entries {
            let (u, coefficient) = (&rows.u[entry.component], entry.coefficient);
            for (largest, u) in largest[entry.input].0.iter_mut().zip(&u.0) {
                *largest = f64::max(*largest, (coefficient * u).abs());
            }
        }
        self.u.fill(Block::ZERO);
        for entry in &self.entries {
            let (u, largest) = (&rows.u[entry.component], &largest[entry.input]);
            let (coefficient, sum) = (entry.coefficient, &mut self.u[entry.input]);
            for lane in 0..LANES {
                let part = coefficient * u.0[lane] / largest.0[lane];
                sum.0[lane] += part * part;
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

    fn measurand(&mut self, at: usize, rows: &Rows, count: usize) {
        self.runner.gradient(at, &mut self.measurands[at].gradient);
        self.first_order(at, rows);
        self.measurands[at].estimate = *self.runner.values(at);
        self.beyond_first_order(at, rows);
        self.arithmetic(at, rows);
        for lane in 0..count {
            if self.doubt.0[lane] != 0.0 {
                continue;
            }
            let known = self.runner.known(at).at(lane);
            let value = &mut self.measurands[at].estimate.0[lane];
            let sure = value.is_finite();
            settle(value, known.value[0], known.error);
            if !(sure && self.covers(at, lane)) {
                self.doubt.0[lane] = 1.0;
            }
        }
    }

    /// The weights of the components, u(y) as [`norm`](super::covariance::norm) has it, and ν by Welch and Satterthwaite.
    fn first_order(&mut self, at: usize, rows: &Rows) {
        let of = &mut self.measurands[at];
        let mut largest = Block::ZERO;
        for (entry, weight) in self.entries.iter().zip(&mut of.weights) {
            let (c, u) = (&of.gradient[entry.input], &rows.u[entry.component]);
            let coefficient = entry.coefficient;
            for lane in 0..LANES {
                let one = (c.0[lane] * coefficient) * u.0[lane];
                weight.0[lane] = one;
                // Of what is not a number u is none.
                let (size, before) = (one.abs(), largest.0[lane]);
                let larger = (before < size) | size.is_nan();
                largest.0[lane] = if larger { size } else { before };
            }
        }
        let [mut u, mut sum] = [Block::ZERO; 2];
        for weight in &of.weights {
            for lane in 0..LANES {
                let part = weight.0[lane] / largest.0[lane];
                u.0[lane] += part * part;
            }
        }
        for (u, largest) in u.0.iter_mut().zip(&largest.0) {
            *u = largest * u.sqrt();
        }
        for (entry, weight) in self.entries.iter().zip(&of.weights) {
            let dof = &rows.dof[entry.component];
            for lane in 0..LANES {
                let part = weight.0[lane].abs() / u.0[lane];
                let square = part * part;
                sum.0[lane] += square * square / dof.0[lane];
            }
        }
        sum.0.iter_mut().for_each(|sum| *sum = 1.0 / *sum);
        (of.u, of.dof) = (u, sum);
    }

    /// Marks the rows in which there may be something beyond first order: second-order terms that matter, a coefficient
    /// that vanishes, an input that is by far too large, references that are not covered.
    fn beyond_first_order(&mut self, measurand: usize, rows: &Rows) {
        let Measurand { gradient, u, .. } = &self.measurands[measurand];
        let doubt = &mut self.doubt;
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
            if !nothing {
                doubt.0[lane] = 1.0;
            }
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
            let (gradient, own, x) = (&gradient[input], &self.u[input], &rows.estimates[input]);
            for lane in 0..LANES {
                let (c, own, x) = (gradient.0[lane], own.0[lane], x.0[lane].abs());
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
    }

    /// Marks the rows whose figures the arithmetic may not resolve.
    fn arithmetic(&mut self, measurand: usize, rows: &Rows) {
        let Measurand { gradient, u, .. } = &self.measurands[measurand];
        let doubt = &mut self.doubt;
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

    /// Finds k, where it follows from a t-distribution or is fixed and no reference is known worse than the result; false
    /// where that is not so.
    fn covers(&mut self, at: usize, lane: usize) -> bool {
        let conventions = &self.budget.conventions;
        let of = &self.measurands[at];
        let (u, dof) = (of.u.0[lane], of.dof.0[lane]);
        let k = match conventions.coverage_factor {
            CoverageRule::Fixed(k) => k,
            CoverageRule::Normal => self.factor(f64::INFINITY),
            CoverageRule::Output if dof >= coverage::MANY && self.dominates(at, lane) => {
                return false;
            }
            CoverageRule::Output | CoverageRule::StudentT => {
                self.factor(conventions.degrees_of_freedom.entered(dof))
            }
        };
        let of = &mut self.measurands[at];
        of.k.0[lane] = k;
        let expanded = k * u;
        let reference = |(entry, k): &(usize, f64)| k * of.weights[*entry].0[lane].abs();
        let mut references = self.references.iter().map(reference);
        let covered = references.all(|one| one <= expanded);
        covered && of.estimate.0[lane].is_finite() && expanded > 0.0 && expanded.is_finite()
    }

    /// The budget, of which the words hold and not the numbers.
    pub fn budget(&self) -> &Budget {
        &self.budget
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

impl RowFigures<'_> {
    /// What is reported of a measurand.
    pub fn figures(&self, measurand: usize) -> Figures {
        let (of, lane) = (&self.of.measurands[measurand], self.lane);
        let (estimate, u, k) = (of.estimate.0[lane], of.u.0[lane], of.k.0[lane]);
        let conventions = &self.of.budget.conventions;
        let expanded = k * u;
        Figures {
            estimate,
            u: Some(u),
            dof: match conventions.coverage_factor {
                CoverageRule::Fixed(_) => None,
                CoverageRule::Normal => Some(f64::INFINITY),
                CoverageRule::Output | CoverageRule::StudentT => {
                    Some(conventions.degrees_of_freedom.entered(of.dof.0[lane]))
                }
            },
            k: Some(k),
            expanded: Some(expanded),
            ends: Some([estimate - expanded, estimate + expanded]),
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
                rows_of.evaluate(&rows, LANES);
                for lane in 0..LANES {
                    all += 1;
                    let Some(found) = rows_of.row(&rows, lane) else {
                        continue;
                    };
                    taken += 1;
                    let budget = written(&budget, &rows, lane);
                    let expected = evaluate(&budget, &options).expect("a value");
                    let result = &expected.results[0];
                    let reported = result.reported(&budget.conventions).figures();
                    let place = format!("{model}, lane {lane}");
                    assert_eq!(found.figures(0), reported, "{place}");
                    let kinds: Vec<_> = expected.findings.into_iter().map(|one| one.kind).collect();
                    let only: Vec<_> = found.few_degrees(0).into_iter().collect();
                    assert_eq!(kinds, only, "{place}");
                    let shares: Vec<f64> =
                        result.gum.inputs.iter().map(|line| line.share).collect();
                    assert_eq!(found.shares(0), shares, "{place}");
                    let components = result.gum.components.iter();
                    let contributions: Vec<f64> = components.map(|one| one.contribution).collect();
                    assert_eq!(found.contributions(0), contributions, "{place}");
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
