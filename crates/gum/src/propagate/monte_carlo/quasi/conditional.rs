//! Results from conditional distribution functions: one quantity is not drawn but averaged over.
//!
//! Where the measurand is an affine or quadratic function of a quantity t while the others are held, a point of the
//! others gives the whole distribution of Y = a + bt + ct², and not just one value. The average over
//! points is smooth in them, and needs far fewer than a count of values for an endpoint of the same error
//! (Griewank, Kuo, Leövey and Sloan, J. Comput. Appl. Math. 344 (2018), call this preintegration).

use std::ops::Range;

use gumption_lanes::kernel::{Paths, power_sums};
use gumption_lanes::moments::all_finite;
use gumption_lanes::{Block, LANES, Level, ops};

use super::super::moments::{Moments, Pivot};
use super::super::thread_pool::parallel_map;
use super::averaging::{Averaged, LEAST_PART};
use super::points::{Points, Scratch};
use super::pooled::{Figures, Pooled, REPLICATES, Trouble, threads_for};
use super::tails::Tails;
use crate::budget::Budget;
use crate::propagate::result::Histogram;

/// Places where the distribution function is found: in either tail, and about the median.
const TAIL: usize = 10;
const MIDDLE: usize = 2;

/// Places at which a first look over the whole range finds the tails, and a second look into these finds the places.
const LOOK: usize = 32;

/// Standard deviations of t that the first look regards.
const REGARDED: f64 = 6.0;

/// How far the slope of a sum may be from the one that its distribution was made for.
const CHANGE: f64 = 0.01;

/// Averages over points of every scramble.
pub(super) struct Conditional<'p, 'b> {
    points: &'p Points<'b>,
    averaged: &'p Averaged,
    /// That the averaged components act on.
    moving: Vec<usize>,
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

/// a, b, c of 256 points.
struct Lines {
    start: Block,
    slope: Block,
    bend: Option<Block>,
}

impl Lines {
    fn paths(&self) -> Paths<'_> {
        Paths {
            start: &self.start,
            slope: &self.slope,
            bend: self.bend.as_ref(),
        }
    }

    /// The value at one t of one point.
    fn at(&self, lane: usize, t: f64) -> f64 {
        let bend = self.bend.as_ref().map_or(0.0, |bend| bend.0[lane]);
        self.start.0[lane] + t * (self.slope.0[lane] + t * bend)
    }

    /// The value at the vertex, if there is one.
    fn vertex(&self, lane: usize) -> Option<f64> {
        let bend = self.bend.as_ref()?.0[lane];
        let vertex = -0.5 * self.slope.0[lane] / bend;
        (vertex.abs() < REGARDED).then(|| self.at(lane, vertex))
    }

    fn finite(&self, level: Level) -> bool {
        let all = [Some(&self.start), Some(&self.slope), self.bend.as_ref()];
        all.into_iter()
            .flatten()
            .all(|block| all_finite(level, block))
    }
}

impl<'p, 'b> Conditional<'p, 'b> {
    /// Nothing drawn yet.
    pub(super) fn new(
        budget: &Budget,
        points: &'p Points<'b>,
        averaged: &'p Averaged,
        pivot: Pivot,
    ) -> Self {
        let acts = |input: &&usize| {
            let terms = &budget.inputs[**input].terms;
            let of = |component| {
                averaged
                    .direction
                    .iter()
                    .any(|(member, _)| *member == component)
            };
            terms
                .iter()
                .any(|term| term.coefficient != 0.0 && of(term.component))
        };
        let inputs: Vec<usize> = (0..budget.inputs.len()).collect();
        Conditional {
            points,
            averaged,
            moving: inputs.iter().filter(acts).copied().collect(),
            pivot,
            p: budget.conventions.coverage_probability,
            places: Vec::new(),
            tallies: vec![Tally::default(); REPLICATES],
        }
    }

    /// How the measurand depends on t at 256 points.
    fn lines(&self, scratch: &mut Scratch<'b>, block: u64) -> Result<Lines, Trouble> {
        let level = self.points.level;
        self.points.draw(scratch, block);
        let trial = &mut scratch.trial;
        if let Some(coordinate) = &self.averaged.coordinate {
            let mut along = Block::ZERO;
            for (component, weight) in coordinate {
                ops::axpy(level, *weight, &trial.deviations[*component], &mut along);
            }
            for (component, change) in &self.averaged.direction {
                ops::axpy(level, -change, &along, &mut trial.deviations[*component]);
            }
        }
        trial.move_all();
        let start = *trial.value();
        let mut step = |steps: f64| {
            for (component, change) in &self.averaged.direction {
                let deviation = &mut trial.deviations[*component];
                deviation.0.iter_mut().for_each(|x| *x += steps * change);
            }
            trial.move_some(&self.moving);
            *trial.value()
        };
        let up = step(1.0);
        let mut lines = Lines {
            start,
            slope: Block::ZERO,
            bend: None,
        };
        if self.averaged.bent {
            let down = step(-2.0);
            let mut bend = Block::ZERO;
            for (lane, start) in start.0.iter().enumerate() {
                lines.slope.0[lane] = 0.5 * (up.0[lane] - down.0[lane]);
                bend.0[lane] = 0.5 * (up.0[lane] + down.0[lane]) - start;
            }
            lines.bend = Some(bend);
        } else {
            ops::sub(level, &up, &start, &mut lines.slope);
        }
        if self.averaged.coordinate.is_none() {
            for (component, _) in &self.averaged.direction {
                trial.deviations[*component] = Block::ZERO;
            }
        }
        if !lines.finite(level) {
            return Err(Trouble::NotFinite);
        }
        let change = |expected: f64| {
            let far = |slope: &f64| (slope - expected).abs() > CHANGE * expected;
            lines.slope.0.iter().any(far)
        };
        if self.averaged.slope.is_some_and(change) {
            return Err(Trouble::Flat);
        }
        Ok(lines)
    }

    /// Chooses the places from some points, and makes sure that t matters at all of them.
    fn look_around(&mut self, bits: u32) -> Result<(), Trouble> {
        let mut scratch = self.points.scratch();
        self.points.begin(&mut scratch, 0, bits);
        let lines = self.lines(&mut scratch, 0)?;
        let far = self.averaged.law.kernel.reach().min(REGARDED);
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut least = f64::INFINITY;
        for lane in 0..LANES {
            let ends = [lines.at(lane, -far), lines.at(lane, far)];
            for y in ends.into_iter().chain(lines.vertex(lane)) {
                range = [range[0].min(y), range[1].max(y)];
            }
            let ways = [lines.at(lane, -1.0), lines.at(lane, 1.0)];
            let moved = ways.map(|y| (y - lines.start.0[lane]).abs());
            least = least.min(moved[0].max(moved[1]));
        }
        let level = self.points.level;
        let kernel = &self.averaged.law.kernel;
        let powers = self.powers(&lines);
        let sd = Moments::from_sums(self.pivot, LANES as u64, 0, powers).sd();
        if least < LEAST_PART * sd {
            return Err(Trouble::Flat);
        }
        let look = |grid: &[f64]| {
            let mut sums = vec![[0.0; 2]; grid.len()];
            kernel.add(level, lines.paths(), grid, &mut sums);
            Tails::new(grid, &sums, LANES as f64)
        };
        let whole = look(&equidistant(range, LOOK));
        let [_, inner] = shares(self.p);
        let mut tails = equidistant([range[0], whole.quantile(inner)], LOOK / 2);
        tails.extend(equidistant(
            [whole.quantile(1.0 - inner), range[1]],
            LOOK / 2,
        ));
        self.places = places(&look(&tails), self.p);
        Ok(())
    }

    fn powers(&self, lines: &Lines) -> [f64; 4] {
        let moments = &self.averaged.law.moments;
        power_sums(
            self.points.level,
            lines.paths(),
            moments,
            self.pivot.coordinates(),
        )
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
        let mut work: Vec<(u64, Tally)> = (0..).zip(std::mem::take(&mut self.tallies)).collect();
        if self.points.are_one() {
            work.truncate(1);
        }
        let (tallies, _) = parallel_map(
            work,
            threads_for(&blocks, threads),
            || self.points.scratch(),
            |scratch, (replicate, mut tally)| {
                self.points.begin(scratch, replicate, bits);
                for block in blocks.clone() {
                    self.add(scratch, block, &mut tally)?;
                }
                Ok(tally)
            },
            |_| (),
        );
        self.tallies = tallies.into_iter().collect::<Result<_, Trouble>>()?;
        if let ([one], true) = (self.tallies.as_slice(), self.points.are_one()) {
            self.tallies = vec![one.clone(); REPLICATES];
        }
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

    /// Adds a block of points.
    fn add(&self, scratch: &mut Scratch<'b>, block: u64, tally: &mut Tally) -> Result<(), Trouble> {
        let lines = self.lines(scratch, block)?;
        let kernel = &self.averaged.law.kernel;
        kernel.add(
            self.points.level,
            lines.paths(),
            &self.places,
            &mut tally.places,
        );
        for (all, some) in tally.powers.iter_mut().zip(self.powers(&lines)) {
            *all += some;
        }
        tally.points += LANES as u64;
        Ok(())
    }

    /// The results of every scramble so far.
    pub(super) fn replicates(&self) -> Vec<Figures> {
        let replicates = self.tallies.iter().map(|tally| {
            let moments = self.moments(tally);
            Figures {
                mean: moments.mean(),
                u: moments.sd(),
                symmetric: self.symmetric(&self.tails(tally)),
            }
        });
        replicates.collect()
    }

    /// The shortest interval of every scramble, which is near that of all points.
    pub(super) fn shortest(&self, [low, _]: [f64; 2]) -> Vec<[f64; 2]> {
        let of = |tally: &Tally| {
            let tails = self.tails(tally);
            tails.covering(tails.shortest_near(tails.below(low), self.p), self.p)
        };
        if self.points.are_one() {
            return vec![of(&self.tallies[0]); REPLICATES];
        }
        self.tallies.iter().map(of).collect()
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
        Tails::new(&self.places, &tally.places, tally.points as f64)
    }

    /// The picture: what of `points` trials falls into equal bins over the central range, from the first block of the
    /// first scramble.
    pub(super) fn picture(&self, [low, high]: [f64; 2], points: u64) -> Histogram {
        const BINS: usize = 64;
        let margin = 0.3 * (high - low);
        let (start, width) = (low - margin, (high - low + 2.0 * margin) / BINS as f64);
        let edge = |i: usize| start + i as f64 * width;
        // Every other edge; the distribution function is smooth enough in between.
        let places: Vec<f64> = (0..=BINS / 2).map(|i| edge(2 * i)).collect();
        let mut sums = vec![[0.0; 2]; places.len()];
        let mut scratch = self.points.scratch();
        self.points.begin(&mut scratch, 0, 8);
        // Finite here, as these are points that were summed.
        if let Ok(lines) = self.lines(&mut scratch, 0) {
            let kernel = &self.averaged.law.kernel;
            kernel.add(self.points.level, lines.paths(), &places, &mut sums);
        }
        let tails = Tails::new(&places, &sums, LANES as f64);
        let share = |i: usize| tails.below(edge(i + 1)) - tails.below(edge(i));
        let count = |i: usize| (share(i) * points as f64).round().max(0.0) as u64;
        Histogram {
            start,
            width,
            counts: (0..BINS).map(count).collect(),
        }
    }
}

/// Places in both tails and about the median, from a rough distribution function: its ends, places beyond which
/// probabilities grow by equal factors, from a fiftieth of what the interval leaves out, and two close about each end
/// of the symmetric interval, where errors of the densities at them hardly matter.
fn places(rough: &Tails, p: f64) -> Vec<f64> {
    const SPREAD: usize = TAIL - 3;
    let [outer, inner] = shares(p);
    let share = |i: usize| outer * libm::pow(inner / outer, i as f64 / (SPREAD - 1) as f64);
    let mut tail: Vec<f64> = (0..SPREAD).map(share).collect();
    tail.extend([0.45 * (1.0 - p), 0.55 * (1.0 - p), 0.0]);
    tail.sort_by(f64::total_cmp);
    let upper = tail.iter().rev().map(|share| 1.0 - share);
    let shares = tail
        .iter()
        .copied()
        .chain(equidistant([0.4, 0.6], MIDDLE))
        .chain(upper);
    let mut places: Vec<f64> = shares.map(|share| rough.quantile(share)).collect();
    places.dedup_by(|next, before| *next <= *before);
    places
}

/// The least and the greatest probability beyond places in a tail, its end apart.
fn shares(p: f64) -> [f64; 2] {
    let outside = 1.0 - p;
    [0.02 * outside, (0.01 + 1.5 * outside).min(0.3)]
}

fn equidistant([from, to]: [f64; 2], count: usize) -> Vec<f64> {
    let step = (to - from) / (count - 1) as f64;
    (0..count).map(|i| from + i as f64 * step).collect()
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
