//! From counts to exact order statistics.
//!
//! [`super::decisive_cells`] says which values decide. They are among those that were kept, or they are drawn
//! again; where they are too many to be kept at once, they are first counted in a finer grid. The
//! results are those of a full sort of all values, to the last bit.

use std::cmp::Reverse;
use std::ops::Range;

use gumption_lanes::bins::{BINS, Grid, Grids};
use gumption_lanes::separate::{self, Stretch};
use gumption_lanes::{Block, LANES, level};

use super::decisive_cells::{Cell, Slack, Wanted, cell_of, for_each_pair};
use super::engine::{Layout, Sink, Source, simulate};
use super::interval::{Ranked, Ranks};
use super::order_counts::OrderCounts;
use super::thread_counts::MOST_KEPT;
use super::thread_pool::ThreadPool;

/// Values that are sorted without a look at finer counts.
const SORTED: u64 = 1 << 12;

/// Values that are sorted without a further look where finer bins have put them in order roughly.
const SORTED_IN_BINS: u64 = 1 << 14;

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
pub(super) trait Again<'env> {
    /// Shows all values to sinks, one per thread.
    fn show<K: Sink + 'env>(&self, sink: impl Fn() -> K) -> Vec<K>;

    /// Who works on them.
    fn pool(&self) -> &ThreadPool<'env>;
}

/// Trials that are drawn again.
pub(super) struct Redraw<'a, 'env, S> {
    pub(super) pool: &'a ThreadPool<'env>,
    pub(super) source: &'env S,
    pub(super) layout: Layout,
    pub(super) chunks: u64,
}

impl<'env, S: Source> Again<'env> for Redraw<'_, 'env, S> {
    fn show<K: Sink + 'env>(&self, sink: impl Fn() -> K) -> Vec<K> {
        simulate(self.pool, self.source, self.layout, 0..self.chunks, sink).1
    }

    fn pool(&self) -> &ThreadPool<'env> {
        self.pool
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
    /// What the counts have kept is used up.
    pub(super) fn new<'env>(
        order_counts: &mut OrderCounts,
        wanted: &Wanted,
        depth: usize,
        output: usize,
        again: &impl Again<'env>,
    ) -> Self {
        let (mut cells, rows) = order_counts.cells();
        let needed = wanted.cells(&cells, Slack::NONE);
        let chosen = rows.iter().zip(&needed).filter(|(_, needed)| **needed);
        let kept = order_counts.take_kept(chosen.flat_map(|(row, _)| row.clone()));
        let mut runs = runs(&cells, &needed);
        for run in &mut runs {
            let at = |rank| &rows[cell_of(&cells, rank)];
            let (first, last) = (at(run.below + 1), at(run.below + run.count));
            [run.low, run.high] = order_counts.span(*first.start()..=*last.end());
        }
        let mut known = Vec::new();
        let mut held = kept.map(Kept::Fresh);
        // Whether finer counts would not help much further.
        let mut stuck = false;
        loop {
            let total: u64 = runs.iter().map(|run| run.count).sum();
            let few = match held {
                Some(Kept::Counted(_)) => SORTED_IN_BINS,
                Some(Kept::Fresh(_)) | None => SORTED,
            };
            let sorts = stuck || total <= few;
            if held.is_none() && (sorts || total <= MOST_KEPT as u64) {
                held = Some(Kept::Fresh(gathered(&runs, output, again)));
            }
            cells = match held.take() {
                Some(kept) if sorts => {
                    let values = kept.in_order(&runs, again.pool());
                    return Resolved::holding(values, &runs, known, wanted.count, depth);
                }
                Some(kept) => {
                    let counted = kept.counted(&runs, again.pool());
                    let cells = counted.finer.cells();
                    held = Some(Kept::Counted(counted));
                    cells
                }
                None => {
                    let watches = again.show(|| Watch::new(output, Finer::new(&runs)));
                    let counts = watches.into_iter().map(|watch| watch.keeper);
                    Finer::of_all(counts, &runs).cells()
                }
            };
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
        }
    }

    /// Holds the values of the runs, in order.
    fn holding(
        values: Vec<f64>,
        runs: &[Run],
        known: Vec<Cell>,
        count: u64,
        depth: usize,
    ) -> Resolved {
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
            // Zero has no sign: which of two came first depends on the threads.
            None => self.cells[cell].low + 0.0,
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

    fn visit(&self, first: usize, last: usize, mut see: impl FnMut(f64)) {
        let (mut rank, last) = (first as u64, last as u64);
        for cell in cell_of(&self.cells, rank)..self.cells.len() {
            while rank <= last.min(self.cells[cell].end()) {
                see(self.value(cell, rank));
                rank += 1;
            }
        }
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
                consider(symmetric.max(first).min(last));
            } else {
                (first..=last).for_each(consider);
            }
        });
        interval
    }
}

/// Values that have been kept, in parts.
enum Kept {
    Fresh(Vec<Vec<f64>>),
    Counted(Counted),
}

/// The same, counted in finer bins.
struct Counted {
    parts: Vec<Part>,
    finer: Finer,
}

/// Values, and the finer bin of each.
struct Part {
    values: Vec<f64>,
    places: Vec<u32>,
}

impl Kept {
    /// Leaves those values that lie in runs, which may be rows of cells of the finer counts so far, and counts them
    /// anew.
    fn counted(self, runs: &[Run], pool: &ThreadPool) -> Counted {
        let own = runs.to_vec();
        let begin = {
            let own = own.clone();
            move || Finer::new(&own)
        };
        let (parts, counts) = match self {
            Kept::Fresh(parts) => {
                of_each(parts, Vec::len, pool, begin, move |finer, mut values| {
                    keep_inside(&mut values, &own);
                    let places = Vec::new();
                    Part { values, places }.counted(finer)
                })
            }
            Kept::Counted(Counted { parts, finer }) => {
                let chosen = finer.chosen(runs);
                of_each(parts, Part::len, pool, begin, move |finer, mut part| {
                    part.keep(&chosen);
                    part.counted(finer)
                })
            }
        };
        Counted {
            parts,
            finer: Finer::of_all(counts, runs),
        }
    }

    /// The values that lie in runs, ascending.
    fn in_order(self, runs: &[Run], pool: &ThreadPool) -> Vec<f64> {
        match self {
            Kept::Fresh(mut parts) => {
                parts
                    .iter_mut()
                    .for_each(|values| keep_inside(values, runs));
                let mut values = parts.concat();
                values.sort_unstable_by(f64::total_cmp);
                values
            }
            Kept::Counted(Counted { parts, finer }) => {
                let chosen = finer.chosen(runs);
                let own = chosen.clone();
                let keep = move |(): &mut (), mut part: Part| {
                    part.keep(&own);
                    part
                };
                let (parts, _) = of_each(parts, Part::len, pool, || (), keep);
                finer.in_order(&parts, &chosen)
            }
        }
    }
}

impl Part {
    fn len(&self) -> usize {
        self.values.len()
    }

    /// Leaves the values of chosen bins.
    fn keep(&mut self, chosen: &[bool]) {
        let mut kept = 0;
        for index in 0..self.values.len() {
            let place = self.places[index];
            // Every value is moved: a branch on what cannot be foreseen would cost more.
            self.values[kept] = self.values[index];
            self.places[kept] = place;
            kept += usize::from(chosen[place as usize]);
        }
        self.values.truncate(kept);
        self.places.truncate(kept);
    }

    /// Counts the values in new bins.
    fn counted(mut self, finer: &mut Finer) -> Part {
        self.places.resize(self.values.len(), 0);
        let rows = self.places.chunks_mut(LANES);
        for (values, places) in self.values.chunks(LANES).zip(rows) {
            finer.count(values, places);
        }
        self
    }
}

/// What a task makes of each part of some values, in no order, and of what every thread begins with.
fn of_each<'env, I: Send + 'env, W: Send + 'env, T: Send + 'env>(
    mut parts: Vec<I>,
    values: impl Fn(&I) -> usize,
    pool: &ThreadPool<'env>,
    begin: impl Fn() -> W + Send + Sync + 'env,
    task: impl Fn(&mut W, I) -> T + Send + Sync + 'env,
) -> (Vec<T>, Vec<W>) {
    /// Fewer values are done before another thread is awake.
    const LEAST: usize = 1 << 14;
    if parts.iter().map(&values).sum::<usize>() < LEAST {
        let mut scratch = begin();
        let done = parts.into_iter().map(|part| task(&mut scratch, part));
        return (done.collect(), vec![scratch]);
    }
    // The small ones last, so that no thread waits long for another.
    parts.sort_by_key(|part| Reverse(values(part)));
    pool.map(parts, || (), move |()| begin(), task, |scratch| scratch)
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

/// Leaves the values that lie in runs.
fn keep_inside(values: &mut Vec<f64>, runs: &[Run]) {
    separate::keep_inside(level(), values, 0, &stretches(runs));
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
        separate::keep_inside(level(), &mut self.values, first, &self.stretches);
    }
}

/// The values of some runs, in parts.
fn gathered<'env>(runs: &[Run], output: usize, again: &impl Again<'env>) -> Vec<Vec<f64>> {
    let watches = again.show(|| Watch::new(output, Gather::new(runs)));
    let values = watches.into_iter().map(|watch| watch.keeper.values);
    values.collect()
}

/// Values in a finer bin, on average, where there are enough bins.
const PER_BIN: usize = 16;

/// Counts of some runs in finer bins.
struct Finer {
    /// With the numbers of their bins.
    runs: Vec<(Run, Range<usize>)>,
    grids: Grids,
    /// Count, smallest and largest value; the last bin is for values of no run.
    bins: Vec<(u64, f64, f64)>,
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
        }
    }

    /// Counts of the same runs together.
    fn of_all(counts: impl IntoIterator<Item = Finer>, runs: &[Run]) -> Finer {
        let counts = counts.into_iter();
        counts
            .reduce(Finer::merged)
            .unwrap_or_else(|| Finer::new(runs))
    }

    fn merged(mut self, other: Finer) -> Finer {
        for (all, bin) in self.bins.iter_mut().zip(&other.bins) {
            *all = (all.0 + bin.0, all.1.min(bin.1), all.2.max(bin.2));
        }
        self
    }

    /// Counts some values, and tells the bin of each.
    fn count(&mut self, values: &[f64], places: &mut [u32]) {
        self.grids.places(level(), values, places);
        for (place, &value) in places.iter().zip(values) {
            let bin = &mut self.bins[*place as usize];
            bin.0 += 1;
            // Minimum and maximum in one instruction each: what is not a number lies in no run.
            bin.1 = if value < bin.1 { value } else { bin.1 };
            bin.2 = if value > bin.2 { value } else { bin.2 };
        }
    }

    /// Which bins lie in `runs` of its cells.
    fn chosen(&self, runs: &[Run]) -> Vec<bool> {
        let mut runs = runs.iter().peekable();
        let mut chosen = vec![false; self.bins.len()];
        let filled = chosen.iter_mut().zip(&self.bins[..self.grids.bins()]);
        for (chosen, &(_, low, high)) in filled.filter(|(_, bin)| bin.0 > 0) {
            while runs.next_if(|run| run.high < low).is_some() {}
            *chosen = runs
                .peek()
                .is_some_and(|run| run.low <= low && high <= run.high);
        }
        chosen
    }

    /// Sorts the values of the chosen bins: each into its bin, the bins in themselves.
    fn in_order(&self, parts: &[Part], chosen: &[bool]) -> Vec<f64> {
        let counts = self.bins.iter().zip(chosen);
        let counts = counts.map(|((count, ..), chosen)| if *chosen { *count as usize } else { 0 });
        let mut total = 0;
        let mut next: Vec<usize> = Vec::with_capacity(self.bins.len());
        for count in counts {
            next.push(total);
            total += count;
        }
        let mut values = vec![0.0; total];
        for part in parts {
            for (value, place) in part.values.iter().zip(&part.places) {
                let next = &mut next[*place as usize];
                values[*next] = *value;
                *next += 1;
            }
        }
        let mut start = 0;
        for end in next {
            values[start..end].sort_unstable_by(f64::total_cmp);
            start = end;
        }
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
        self.count(values, &mut [0; LANES][..values.len()]);
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
