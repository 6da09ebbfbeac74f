//! Results from the values at the points, as JCGM 101 clause 7 takes them from trials.

use std::ops::Range;

use super::super::existence::{Tail, Verdict};
use super::super::histogram::histogram;
use super::super::interval::{Ordered, Ranked, Ranks, symmetric_ends};
use super::super::moments::{Moments, Pivot};
use super::super::thread_pool::parallel_map;
use super::points::Points;
use super::pooled::{Figures, Pooled, REPLICATES, Trouble, threads_for};
use crate::propagate::result::Histogram;

/// Values at the points of every scramble.
pub(super) struct Counted<'p, 'b> {
    points: &'p Points<'b>,
    pivot: Pivot,
    p: f64,
    /// One per scramble.
    values: Vec<Vec<f64>>,
}

impl<'p, 'b> Counted<'p, 'b> {
    /// Nothing drawn yet.
    pub(super) fn new(points: &'p Points<'b>, pivot: Pivot, p: f64) -> Self {
        Counted {
            points,
            pivot,
            p,
            values: vec![Vec::new(); REPLICATES],
        }
    }

    /// Draws further blocks of every scramble.
    pub(super) fn extend(
        &mut self,
        blocks: Range<u64>,
        bits: u32,
        threads: usize,
    ) -> Result<(), Trouble> {
        let work: Vec<(u64, Vec<f64>)> = (0..).zip(std::mem::take(&mut self.values)).collect();
        let (values, _) = parallel_map(
            work,
            threads_for(&blocks, threads),
            || self.points.scratch(),
            |scratch, (replicate, mut values)| {
                self.points.begin(scratch, replicate, bits);
                for block in blocks.clone() {
                    self.points.draw(scratch, block);
                    scratch.trial.move_all();
                    values.extend_from_slice(&scratch.trial.value().0);
                }
                values
            },
            |_| (),
        );
        self.values = values;
        if self.values.iter().flatten().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(Trouble::NotFinite)
        }
    }

    /// The results of every scramble so far.
    pub(super) fn replicates(&self, threads: usize) -> Vec<Figures> {
        self.each(threads, |values| {
            let moments = Moments::of(values, self.pivot);
            Figures {
                mean: moments.mean(),
                u: moments.sd(),
                symmetric: symmetric_ends(&mut values.clone(), self.p),
            }
        })
    }

    /// The shortest interval of every scramble.
    pub(super) fn shortest(&self, threads: usize) -> Vec<[f64; 2]> {
        self.each(threads, |values| {
            let ranks = Ranks::new(values.len(), self.p);
            Ordered::by_selection(values.clone(), ranks.last).shortest(ranks)
        })
    }

    fn each<T: Send>(&self, threads: usize, of: impl Fn(&Vec<f64>) -> T + Sync) -> Vec<T> {
        let values = self.values.iter().collect();
        parallel_map(values, threads, || (), |(), values| of(values), |()| ()).0
    }

    /// The results of all points.
    pub(super) fn pooled(&self) -> Result<Pooled, Trouble> {
        let all = self.values.concat();
        let ranks = Ranks::new(all.len(), self.p);
        let depth = ranks.last.max(Tail::reach(all.len()) + 2).min(all.len());
        let moments = Moments::of(&all, self.pivot);
        let order = Ordered::by_selection(all, depth);
        if !Verdict::new(None, &Tail::heavier(&order)).has_deviation() {
            return Err(Trouble::HeavyTail);
        }
        Ok(Pooled {
            median: order.median(),
            symmetric: order.symmetric(ranks),
            shortest: order.shortest(ranks),
            plain_errors: [
                moments.mean_error(),
                moments.sd_error(),
                order.standard_error(ranks.symmetric),
                order.standard_error(ranks.symmetric + ranks.covered),
            ],
            moments,
        })
    }

    /// The picture of all values.
    pub(super) fn picture(&self, interval: [f64; 2], threads: usize) -> Histogram {
        let all = self.values.concat();
        let range = all.iter().fold(
            [f64::INFINITY, f64::NEG_INFINITY],
            |[least, most], value| [least.min(*value), most.max(*value)],
        );
        histogram(&all, range, interval, threads)
    }
}
