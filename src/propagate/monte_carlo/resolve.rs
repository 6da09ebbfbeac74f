//! From counts to exact order statistics.
//!
//! [`super::cells`] says which values decide. They are among those that were kept, or they are drawn
//! again; where they are too many to be kept at once, they are first counted in a finer grid. The
//! results are those of a full sort of all values, to the last bit.

use std::ops::Range;

use gumption_lanes::bins::{BINS, Grid, Grids};
use gumption_lanes::sift::{self, Stretch};
use gumption_lanes::{Block, LANES, level};

use super::cells::{Cell, Slack, Wanted, cell_of, for_each_pair};
use super::engine::{Layout, Sink, Source, parallel_map, simulate};
use super::interval::{Ranked, Ranks};
use super::sieve::{MOST_KEPT, Sieve};

/// Values that are sorted without a look at finer counts.
const SORTED: u64 = 1 << 14;

/// Consecutive values between two numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Run {
    low: f64,
    high: f64,
    below: u64,
    count: u64,
}

impl Run {
    fn stretch(&self) -> Stretch {
        [self.low, self.high]
    }
}

/// Where values can be had again.
pub(super) trait Again {
    /// Shows all values to sinks, one per thread.
    fn show<K: Sink>(&self, sink: impl Fn() -> K + Sync) -> Vec<K>;

    /// How many threads there are.
    fn threads(&self) -> usize;
}

/// Trials that are drawn again.
pub(super) struct Redraw<'s, S> {
    pub(super) source: &'s S,
    pub(super) layout: Layout,
    pub(super) chunks: u64,
    pub(super) threads: usize,
}

impl<S: Source> Again for Redraw<'_, S> {
    fn show<K: Sink>(&self, sink: impl Fn() -> K + Sync) -> Vec<K> {
        simulate(self.source, self.layout, 0..self.chunks, self.threads, sink).1
    }

    fn threads(&self) -> usize {
        self.threads
    }
}

/// The order statistics that were wanted.
#[derive(Debug)]
pub(super) struct Resolved {
    count: u64,
    depth: u64,
    /// Ascending, with gaps.
    cells: Vec<Cell>,
    /// Per cell the place of its first value, or `None` if all are the same.
    starts: Vec<Option<usize>>,
    /// The values of the cells, in order.
    values: Vec<f64>,
}

impl Resolved {
    /// Finds what is wanted of one output's values; `depth` extreme ranks at either end are counted
    /// as a tail.
    ///
    /// What the sieve has kept is used up.
    pub(super) fn new(
        sieve: &mut Sieve,
        wanted: &Wanted,
        depth: usize,
        output: usize,
        again: &impl Again,
    ) -> Self {
        let (mut cells, rows) = sieve.cells();
        let needed = wanted.cells(&cells, Slack::NONE);
        let chosen = rows.iter().zip(&needed).filter(|(_, needed)| **needed);
        let kept = sieve.take_kept(chosen.flat_map(|(row, _)| row.clone()));
        let mut runs = runs(&cells, &needed);
        for run in &mut runs {
            let at = |rank| &rows[cell_of(&cells, rank)];
            let (first, last) = (at(run.below + 1), at(run.below + run.count));
            [run.low, run.high] = sieve.span(*first.start()..=*last.end());
        }
        let mut known = Vec::new();
        let mut held = kept;
        let mut finer: Option<Finer> = None;
        // Whether finer counts would not help much further.
        let mut stuck = false;
        loop {
            let total: u64 = runs.iter().map(|run| run.count).sum();
            let sorts = stuck || total <= SORTED;
            if held.is_none() && (sorts || total <= MOST_KEPT as u64) {
                held = Some(gathered(&runs, output, again));
                finer = None;
            }
            let counts = match held.take() {
                Some(parts) if sorts => {
                    let parts = narrowed(parts, &runs, finer.as_ref(), again.threads());
                    return Resolved::sorted(parts, &runs, known, wanted.count, depth);
                }
                Some(parts) => {
                    let (parts, counts) = counted(parts, &runs, finer.as_ref(), again.threads());
                    held = Some(parts);
                    counts
                }
                None => {
                    let watches = again.show(|| Watch::new(output, Finer::new(&runs)));
                    watches.into_iter().map(|watch| watch.keeper).collect()
                }
            };
            let all =
                (counts.into_iter().reduce(Finer::merged)).unwrap_or_else(|| Finer::new(&runs));
            cells = all.cells();
            cells.append(&mut known);
            cells.sort_unstable_by_key(|cell| cell.below);
            let needed = wanted.cells(&cells, Slack::NONE);
            let pairs = cells.iter().zip(&needed);
            known = pairs
                .filter(|(cell, needed)| **needed && cell.is_known())
                .map(|(cell, _)| *cell)
                .collect();
            let open: Vec<bool> = cells
                .iter()
                .zip(needed)
                .map(|(cell, needed)| needed && !cell.is_known())
                .collect();
            runs = self::runs(&cells, &open);
            let left: u64 = runs.iter().map(|run| run.count).sum();
            stuck = left > total / 2;
            finer = Some(all);
        }
    }

    /// Sorts values, all of which lie in the runs.
    fn sorted(
        parts: Vec<Vec<f64>>,
        runs: &[Run],
        known: Vec<Cell>,
        count: u64,
        depth: usize,
    ) -> Resolved {
        let mut values = parts.concat();
        values.sort_unstable_by(f64::total_cmp);
        let mut start = 0;
        let mut cells: Vec<(Cell, Option<usize>)> = Vec::new();
        for run in runs {
            let cell = Cell {
                low: run.low,
                high: run.high,
                below: run.below,
                count: run.count,
            };
            cells.push((cell, Some(start)));
            start += run.count as usize;
        }
        cells.extend(known.into_iter().map(|cell| (cell, None)));
        cells.sort_unstable_by_key(|(cell, _)| cell.below);
        let (cells, starts) = cells.into_iter().unzip();
        Resolved {
            count,
            depth: depth as u64,
            cells,
            starts,
            values,
        }
    }

    fn value(&self, cell: usize, rank: u64) -> f64 {
        match self.starts[cell] {
            Some(start) => self.values[start + (rank - 1 - self.cells[cell].below) as usize],
            None => self.cells[cell].low,
        }
    }
}

impl Ranked for Resolved {
    fn count(&self) -> usize {
        self.count as usize
    }

    fn depth(&self) -> usize {
        self.depth as usize
    }

    fn at(&self, rank: usize) -> f64 {
        let rank = rank as u64;
        self.value(cell_of(&self.cells, rank), rank)
    }

    fn median(&self) -> f64 {
        let lower = self.at(self.count().div_ceil(2));
        let upper = self.at(self.count() / 2 + 1);
        lower + (upper - lower) / 2.0
    }

    fn shortest(&self, ranks: Ranks) -> [f64; 2] {
        let symmetric = ranks.symmetric as u64;
        let covered = ranks.covered as u64;
        let [low, high] = self.symmetric(ranks);
        let (mut best, mut least) = (symmetric, high - low);
        let mut interval = [low, high];
        for_each_pair(&self.cells, ranks, |a, b| {
            let (low, high) = (&self.cells[a], &self.cells[b]);
            let first = (low.below + 1).max((high.below + 1).saturating_sub(covered));
            let last = low.end().min(high.end() - covered).min(ranks.last as u64);
            let mut consider = |r: u64| {
                let ends = [self.value(a, r), self.value(b, r + covered)];
                let width = ends[1] - ends[0];
                let nearer = r.abs_diff(symmetric) < best.abs_diff(symmetric);
                if width < least || (width == least && nearer) {
                    (best, least, interval) = (r, width, ends);
                }
            };
            if self.starts[a].is_none() && self.starts[b].is_none() {
                consider(symmetric.clamp(first, last));
            } else {
                (first..=last).for_each(consider);
            }
        });
        interval
    }
}

/// What a task makes of each part of some values.
fn of_each<T: Send>(
    parts: Vec<Vec<f64>>,
    threads: usize,
    task: impl Fn(Vec<f64>) -> T + Sync,
) -> Vec<T> {
    /// Fewer values are done before another thread has begun.
    const LEAST: usize = 1 << 15;
    let values: usize = parts.iter().map(Vec::len).sum();
    let threads = if values < LEAST { 1 } else { threads };
    parallel_map(parts, threads, || (), |(), part| task(part), |()| ()).0
}

/// Those of some values that lie in runs, which may be rows of cells of finer counts of the values.
fn narrowed(
    parts: Vec<Vec<f64>>,
    runs: &[Run],
    finer: Option<&Finer>,
    threads: usize,
) -> Vec<Vec<f64>> {
    of_each(parts, threads, |part| narrow(part, runs, finer))
}

/// The same, and the counts of each part.
fn counted(
    parts: Vec<Vec<f64>>,
    runs: &[Run],
    finer: Option<&Finer>,
    threads: usize,
) -> (Vec<Vec<f64>>, Vec<Finer>) {
    let both = of_each(parts, threads, |part| {
        let part = narrow(part, runs, finer);
        let mut counts = Finer::new(runs);
        part.chunks(LANES).for_each(|values| counts.add(values));
        (part, counts)
    });
    both.into_iter().unzip()
}

fn narrow(values: Vec<f64>, runs: &[Run], finer: Option<&Finer>) -> Vec<f64> {
    match finer {
        Some(finer) => finer.inside(runs, values),
        None => inside(runs, values),
    }
}

/// Rows of neighbouring cells that are all chosen.
fn runs(cells: &[Cell], chosen: &[bool]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (cell, _) in cells.iter().zip(chosen).filter(|(_, chosen)| **chosen) {
        match runs.last_mut() {
            Some(run) if run.below + run.count == cell.below => {
                run.high = cell.high;
                run.count += cell.count;
            }
            _ => runs.push(Run {
                low: cell.low,
                high: cell.high,
                below: cell.below,
                count: cell.count,
            }),
        }
    }
    runs
}

/// The values that lie in runs.
fn inside(runs: &[Run], mut values: Vec<f64>) -> Vec<f64> {
    sift::keep_inside(level(), &mut values, 0, &stretches(runs));
    values
}

fn stretches(runs: &[Run]) -> Vec<Stretch> {
    runs.iter().map(Run::stretch).collect()
}

/// Takes values, also such as are not finite.
trait Keeper: Send {
    fn add(&mut self, values: &[f64]);
}

/// Keeps the values of some runs.
struct Gather {
    stretches: Vec<Stretch>,
    values: Vec<f64>,
}

impl Gather {
    fn new(runs: &[Run]) -> Self {
        Gather {
            stretches: stretches(runs),
            values: Vec::new(),
        }
    }
}

impl Keeper for Gather {
    fn add(&mut self, values: &[f64]) {
        let first = self.values.len();
        self.values.extend_from_slice(values);
        sift::keep_inside(level(), &mut self.values, first, &self.stretches);
    }
}

/// The values of some runs, in parts.
fn gathered(runs: &[Run], output: usize, again: &impl Again) -> Vec<Vec<f64>> {
    let watches = again.show(|| Watch::new(output, Gather::new(runs)));
    let values = watches.into_iter().map(|watch| watch.keeper.values);
    values.collect()
}

/// Values in a finer bin, on average, where there are enough bins.
const PER_BIN: usize = 8;

/// Counts of some runs in finer bins.
struct Finer {
    /// With the numbers of their bins.
    runs: Vec<(Run, Range<usize>)>,
    grids: Grids,
    /// Count, smallest and largest value; the last bin is for values of no run.
    bins: Vec<(u64, f64, f64)>,
    /// The bins of the values at hand.
    places: Vec<u32>,
}

impl Finer {
    fn new(runs: &[Run]) -> Self {
        let mut grids = Grids::default();
        let mut grid = |run: &Run| {
            let (first, bins) = (grids.bins(), (run.count as usize / PER_BIN).clamp(2, BINS));
            let steps = (bins - 1) as f64;
            let width = run.high / steps - run.low / steps;
            let grid = Grid::new(run.low, width.max(4.0 * f64::MIN_POSITIVE));
            grids.push(run.stretch(), grid, bins);
            (*run, first..grids.bins())
        };
        Finer {
            runs: runs.iter().map(&mut grid).collect(),
            bins: vec![(0, f64::INFINITY, f64::NEG_INFINITY); grids.bins() + 1],
            grids,
            places: Vec::new(),
        }
    }

    fn merged(mut self, other: Finer) -> Finer {
        for (all, bin) in self.bins.iter_mut().zip(&other.bins) {
            *all = (all.0 + bin.0, all.1.min(bin.1), all.2.max(bin.2));
        }
        self
    }

    /// Those of the values that were added that lie in some `runs` of its cells.
    fn inside(&self, runs: &[Run], mut values: Vec<f64>) -> Vec<f64> {
        let mut runs = runs.iter().peekable();
        let mut chosen = vec![false; self.bins.len()];
        let filled = chosen.iter_mut().zip(&self.bins[..self.grids.bins()]);
        for (chosen, &(_, low, high)) in filled.filter(|(_, bin)| bin.0 > 0) {
            while runs.next_if(|run| run.high < low).is_some() {}
            *chosen = runs
                .peek()
                .is_some_and(|run| run.low <= low && high <= run.high);
        }
        let mut places = Vec::new();
        let mut kept = 0;
        for start in (0..values.len()).step_by(LANES) {
            let end = values.len().min(start + LANES);
            self.grids.places(level(), &values[start..end], &mut places);
            for (index, place) in (start..end).zip(&places) {
                // Every value is moved: a branch on what cannot be foreseen would cost more.
                values[kept] = values[index];
                kept += usize::from(chosen[*place as usize]);
            }
        }
        values.truncate(kept);
        values
    }

    fn cells(&self) -> Vec<Cell> {
        let filled = self.bins.iter().filter(|(count, ..)| *count > 0);
        let mut cells = Vec::with_capacity(filled.count());
        for (run, bins) in &self.runs {
            let mut below = run.below;
            let bins = &self.bins[bins.clone()];
            for &(count, low, high) in bins.iter().filter(|(count, ..)| *count > 0) {
                cells.push(Cell {
                    low,
                    high,
                    below,
                    count,
                });
                below += count;
            }
        }
        cells
    }
}

impl Keeper for Finer {
    fn add(&mut self, values: &[f64]) {
        self.grids.places(level(), values, &mut self.places);
        for (place, &value) in self.places.iter().zip(values) {
            let bin = &mut self.bins[*place as usize];
            *bin = (bin.0 + 1, bin.1.min(value), bin.2.max(value));
        }
    }
}

/// Shows the values of one output to a keeper.
struct Watch<T> {
    output: usize,
    keeper: T,
}

impl<T> Watch<T> {
    fn new(output: usize, keeper: T) -> Self {
        Watch { output, keeper }
    }
}

impl<T: Keeper> Sink for Watch<T> {
    type Chunk = ();

    fn take(&mut self, outputs: &[Block], lanes: usize) {
        self.keeper.add(&outputs[self.output].0[..lanes.min(LANES)]);
    }

    fn close(&mut self) {}
}
