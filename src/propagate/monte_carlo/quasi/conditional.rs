//! Results from conditional distribution functions: one component is not drawn but averaged over.
//!
//! Where the measurand is an affine function of a component E while the others are held, Y = a + bE, a point
//! of the others gives the whole distribution function G((y − a)/b) and not just one value. The average over
//! points is smooth in them, and needs far fewer than a count of values for an endpoint of the same error
//! (Griewank, Kuo, Leövey and Sloan, J. Comput. Appl. Math. 344 (2018), call this preintegration).

use std::ops::Range;

use gumption_lanes::kernel::{Kernel, Lines, power_sums};
use gumption_lanes::{Block, LANES};

use super::super::engine::parallel_map;
use super::super::moments::{Moments, Pivot};
use super::points::{Points, Scratch};
use super::tails::{Node, Tails};
use super::{Figures, Pooled, REPLICATES, Trouble, shapes, threads_for};
use crate::budget::Budget;
use crate::propagate::Histogram;

/// Places where the distribution function is found: in either tail, and about the median.
const TAIL: usize = 12;
const MIDDLE: usize = 3;

/// Scrambles whose first block shows where the tails are.
const SCOUTS: u64 = 4;

/// The least part of u(y) that the component must make up at every point, or there is nothing to smooth with.
const LEAST_PART: f64 = 0.05;

/// Averages over points of every scramble.
pub(super) struct Conditional<'p, 'b> {
    points: &'p Points<'b>,
    component: usize,
    /// A standard uncertainty of the component.
    step: f64,
    kernel: Kernel,
    /// Second, third and fourth; those that do not exist as zero.
    central: [f64; 3],
    pivot: Pivot,
    p: f64,
    /// Where the distribution function is found.
    places: Vec<f64>,
    /// One per scramble.
    tallies: Vec<Tally>,
}

/// Sums over the points of one scramble.
#[derive(Debug, Clone, Default)]
struct Tally {
    points: u64,
    powers: [f64; 4],
    /// Probability below each place, and the density there.
    places: Vec<[f64; 2]>,
}

/// The component that moves the measurand most among those that can be averaged over.
pub(super) fn candidate(budget: &Budget, points: &Points<'_>) -> Option<usize> {
    let effects = points.effects();
    let mut order: Vec<usize> = points.independent().collect();
    order.sort_by(|a, b| effects[*b].total_cmp(&effects[*a]));
    let total = order
        .iter()
        .map(|c| effects[*c] * effects[*c])
        .sum::<f64>()
        .sqrt();
    order
        .into_iter()
        .take_while(|component| effects[*component] > LEAST_PART * total)
        .filter(|component| shapes::averages(&budget.components[*component].distribution))
        .find(|component| {
            let of = |input: &crate::budget::Input| {
                input
                    .terms
                    .iter()
                    .any(|term| term.component == *component && term.coefficient != 0.0)
            };
            let inputs: Vec<usize> = (0..budget.inputs.len())
                .filter(|i| of(&budget.inputs[*i]))
                .collect();
            budget.model.is_affine_in(&inputs)
        })
}

impl<'p, 'b> Conditional<'p, 'b> {
    /// Nothing drawn yet; `None` for a component that cannot be averaged over.
    pub(super) fn new(
        budget: &Budget,
        points: &'p Points<'b>,
        component: usize,
        pivot: Pivot,
    ) -> Option<Self> {
        let distribution = &budget.components[component].distribution;
        Some(Conditional {
            points,
            component,
            step: budget.components[component].u,
            kernel: shapes::kernel(distribution)?,
            central: [
                distribution.variance()?,
                distribution.third_central_moment().unwrap_or(0.0),
                distribution.fourth_central_moment().unwrap_or(0.0),
            ],
            pivot,
            p: budget.conventions.coverage_probability,
            places: Vec::new(),
            tallies: vec![Tally::default(); REPLICATES],
        })
    }

    /// a and b at the current point of the other components.
    fn lines(&self, scratch: &mut Scratch<'b>) -> Result<(Block, Block), Trouble> {
        let start = self.points.value_at(scratch, self.component, 0.0);
        let mut slope = self.points.value_at(scratch, self.component, self.step);
        for (slope, start) in slope.0.iter_mut().zip(&start.0) {
            *slope = (*slope - start) / self.step;
        }
        if start.0.iter().chain(&slope.0).any(|x| !x.is_finite()) {
            return Err(Trouble::NotFinite);
        }
        Ok((start, slope))
    }

    /// Chooses the places from some values, and makes sure that the component matters everywhere.
    fn look_around(&mut self, bits: u32) -> Result<(), Trouble> {
        let mut scratch = self.points.scratch();
        let mut values = Vec::new();
        let mut least = f64::INFINITY;
        for replicate in 0..SCOUTS {
            self.points.begin(&mut scratch, replicate, bits);
            self.points.draw(&mut scratch, 0);
            let deviations = scratch.deviations(self.component);
            let (start, slope) = self.lines(&mut scratch)?;
            for lane in 0..LANES {
                values.push(start.0[lane] + slope.0[lane] * deviations.0[lane]);
                least = least.min(slope.0[lane].abs());
            }
        }
        values.sort_unstable_by(f64::total_cmp);
        if least * self.step < LEAST_PART * Moments::of(&values, self.pivot).sd() {
            return Err(Trouble::Flat);
        }
        let at =
            |share: f64| values[((share * values.len() as f64) as usize).min(values.len() - 1)];
        let inner = 0.01 + 1.5 * (1.0 - self.p);
        let (least, middle, most) = (at(0.0), at(0.5), at(1.0));
        let spread = |from: f64, to: f64, count: usize| {
            (0..count).map(move |i| from + (to - from) * i as f64 / (count - 1) as f64)
        };
        let (low, high) = (at(inner.min(0.3)), at(1.0 - inner.min(0.3)));
        let mut places: Vec<f64> = spread(least - 0.4 * (middle - least), low, TAIL).collect();
        places.extend(spread(at(0.35), at(0.65), MIDDLE));
        places.extend(spread(high, most + 0.4 * (most - middle), TAIL));
        self.places = places;
        Ok(())
    }

    /// Draws further blocks of every scramble.
    pub(super) fn extend(
        &mut self,
        blocks: Range<u64>,
        bits: u32,
        threads: usize,
    ) -> Result<(), Trouble> {
        if self.places.is_empty() {
            self.look_around(bits)?;
            self.tallies
                .iter_mut()
                .for_each(|tally| tally.places = vec![[0.0; 2]; self.places.len()]);
        }
        let work: Vec<(u64, Tally)> = (0..).zip(std::mem::take(&mut self.tallies)).collect();
        let (tallies, _) = parallel_map(
            work,
            threads_for(&blocks, threads),
            || self.points.scratch(),
            |scratch, (replicate, mut tally)| {
                self.points.begin(scratch, replicate, bits);
                for block in blocks.clone() {
                    self.points.draw(scratch, block);
                    let (start, slope) = self.lines(scratch)?;
                    let lines = Lines {
                        start: &start,
                        slope: &slope,
                    };
                    self.kernel
                        .add(self.points.level, lines, &self.places, &mut tally.places);
                    let powers = power_sums(
                        self.points.level,
                        lines,
                        self.central,
                        self.pivot.coordinates(),
                    );
                    tally
                        .powers
                        .iter_mut()
                        .zip(powers)
                        .for_each(|(all, some)| *all += some);
                    tally.points += LANES as u64;
                }
                Ok(tally)
            },
            |_| (),
        );
        self.tallies = tallies.into_iter().collect::<Result<_, Trouble>>()?;
        let finite = |tally: &Tally| {
            tally
                .places
                .iter()
                .flatten()
                .chain(&tally.powers)
                .all(|s| s.is_finite())
        };
        if self.tallies.iter().all(finite) {
            Ok(())
        } else {
            Err(Trouble::NotFinite)
        }
    }

    /// The results of every scramble so far.
    pub(super) fn replicates(&self) -> Vec<Figures> {
        let below = self.tails(&self.total()).shortest(self.p);
        let replicates = self.tallies.iter().map(|tally| {
            let (tails, moments) = (self.tails(tally), self.moments(tally));
            Figures {
                mean: moments.mean(),
                u: moments.sd(),
                symmetric: self.symmetric(&tails),
                shortest: tails.covering(tails.shortest_near(below, self.p), self.p),
            }
        });
        replicates.collect()
    }

    /// The results of all points.
    pub(super) fn pooled(&self) -> Pooled {
        let total = self.total();
        let tails = self.tails(&total);
        let moments = self.moments(&total);
        let symmetric = self.symmetric(&tails);
        let outside = 0.5 * (1.0 - self.p);
        let binomial = (outside * (1.0 - outside) / total.points as f64).sqrt();
        let errors = symmetric.map(|end| binomial / tails.density(end));
        Pooled {
            median: tails.quantile(0.5),
            symmetric,
            shortest: tails.covering(tails.shortest(self.p), self.p),
            plain_errors: [
                moments.mean_error(),
                moments.sd_error(),
                errors[0],
                errors[1],
            ],
            moments,
        }
    }

    /// The sums over all scrambles.
    fn total(&self) -> Tally {
        let none = Tally {
            places: vec![[0.0; 2]; self.places.len()],
            ..Tally::default()
        };
        self.tallies.iter().fold(none, |all, tally| all.plus(tally))
    }

    fn symmetric(&self, tails: &Tails) -> [f64; 2] {
        let outside = 0.5 * (1.0 - self.p);
        [tails.quantile(outside), tails.quantile(1.0 - outside)]
    }

    fn moments(&self, tally: &Tally) -> Moments {
        Moments::from_sums(self.pivot, tally.points, 0, tally.powers)
    }

    fn tails(&self, tally: &Tally) -> Tails {
        let n = tally.points as f64;
        let nodes = self.places.iter().zip(&tally.places);
        Tails(
            nodes
                .map(|(y, [below, density])| Node {
                    y: *y,
                    below: below / n,
                    density: density / n,
                })
                .collect(),
        )
    }

    /// The picture: what of `points` trials falls into equal bins over the central range, from the first block of the
    /// first scrambles.
    pub(super) fn picture(&self, [low, high]: [f64; 2], points: u64) -> Histogram {
        const BINS: usize = 64;
        let margin = 0.3 * (high - low);
        let (start, width) = (low - margin, (high - low + 2.0 * margin) / BINS as f64);
        let edges: Vec<f64> = (0..=BINS).map(|i| start + i as f64 * width).collect();
        let mut sums = vec![[0.0; 2]; edges.len()];
        let mut scratch = self.points.scratch();
        for replicate in 0..2 {
            self.points.begin(&mut scratch, replicate, 8);
            self.points.draw(&mut scratch, 0);
            // Finite here, as these are points that were summed.
            if let Ok((start, slope)) = self.lines(&mut scratch) {
                self.kernel.add(
                    self.points.level,
                    Lines {
                        start: &start,
                        slope: &slope,
                    },
                    &edges,
                    &mut sums,
                );
            }
        }
        let of = |sum: f64| sum / (2 * LANES) as f64 * points as f64;
        let count = |pair: &[[f64; 2]]| (of(pair[1][0]) - of(pair[0][0])).round().max(0.0) as u64;
        Histogram {
            start,
            width,
            counts: sums.windows(2).map(count).collect(),
        }
    }
}

impl Tally {
    fn plus(&self, other: &Tally) -> Tally {
        let sum = |(a, b): (&[f64; 2], &[f64; 2])| [a[0] + b[0], a[1] + b[1]];
        Tally {
            points: self.points + other.points,
            powers: std::array::from_fn(|k| self.powers[k] + other.powers[k]),
            places: self.places.iter().zip(&other.places).map(sum).collect(),
        }
    }
}
