//! Trials as they come: the first ones are kept, and tell how to take the rest without keeping it.

use std::iter::repeat_with;
use std::mem::replace;
use std::ops::Range;

use gumption_lanes::moments::{PowerSums, all_finite};
use gumption_lanes::{Block, LANES, Level, level};

use super::comoments::CoMoments;
use super::decisive_cells::Wanted;
use super::engine::{CHUNK, Drawing, Layout, Sink, Source, simulate, start};
use super::interval::{Ordered, Ranked};
use super::moments::{Moments, Pivot};
use super::order_counts::OrderCounts;
use super::thread_counts::ThreadCounts;
use super::thread_pool::ThreadPool;

/// Trials that are kept before the others are only counted and summed.
pub(super) const PILOT: u64 = CHUNK;

/// Fewest values that tell which ones will matter.
const FEWEST: u64 = 1 << 12;

/// Trials after a look at what is to be kept, for each one before. Seldom looks let more be kept than need be,
/// frequent ones take time themselves.
const GROWTH: u64 = 3;

/// Chunks that every helper draws while the look is taken.
const AHEAD: u64 = 4;

/// Most chunks between two looks.
const MOST_CHUNKS: u64 = 1 << 10;

/// Says which order statistics of so many values will be wanted.
pub(super) type Ask<'a> = dyn Fn(u64) -> Wanted + 'a;

/// How trials are drawn and what is wanted of them.
pub(super) struct Plan<'a, 'env, S> {
    pub(super) pool: &'a ThreadPool<'env>,
    pub(super) source: &'env S,
    pub(super) layout: Layout,
    /// Per output.
    pub(super) pivots: &'a [Pivot],
    /// p of the intervals.
    pub(super) p: f64,
    pub(super) ask: &'a Ask<'a>,
}

/// What is held of the trials so far.
pub(super) enum Held {
    /// All of them, one column per output.
    Columns(Vec<Vec<f64>>),
    /// Their counts and sums.
    Summed(Box<Summed>),
}

impl Held {
    /// Means and covariances of several outputs.
    pub(super) fn joint_moments(&self) -> Option<CoMoments> {
        match self {
            Held::Summed(summed) => summed.joint.clone(),
            Held::Columns(columns) => (columns.len() > 1).then(|| CoMoments::of(columns)),
        }
    }
}

/// Counts and sums of trials.
pub(super) struct Summed {
    /// Per output.
    pub(super) order_counts: Vec<OrderCounts>,
    /// Per output.
    pub(super) moments: Vec<Moments>,
    /// Of several outputs.
    pub(super) joint: Option<CoMoments>,
    pivots: Vec<Pivot>,
}

/// Draws trials and holds what matters of them.
pub(super) struct Collector<'a, 'env, S> {
    plan: Plan<'a, 'env, S>,
    held: Held,
    chunks: u64,
    trials: u64,
}

impl<'a, 'env, S: Source> Collector<'a, 'env, S> {
    /// Nothing drawn yet.
    pub(super) fn new(plan: Plan<'a, 'env, S>) -> Self {
        let columns = vec![Vec::new(); plan.source.outputs()];
        Collector {
            plan,
            held: Held::Columns(columns),
            chunks: 0,
            trials: 0,
        }
    }

    /// Trials so far.
    pub(super) fn trials(&self) -> u64 {
        self.trials
    }

    /// Chunks so far.
    pub(super) fn chunks(&self) -> u64 {
        self.chunks
    }

    /// What is held.
    pub(super) fn into_held(self) -> Held {
        self.held
    }

    /// The moments of every output over all trials so far.
    pub(super) fn moments(&self) -> Vec<Moments> {
        match &self.held {
            Held::Columns(columns) => columns
                .iter()
                .zip(self.plan.pivots)
                .map(|(column, pivot)| Moments::of(column, *pivot))
                .collect(),
            Held::Summed(summed) => summed.moments.clone(),
        }
    }

    /// Draws trials until there are so many chunks.
    pub(super) fn extend(&mut self, chunks: u64) {
        while self.chunks < chunks && matches!(self.held, Held::Columns(_)) {
            let next = self.chunks..chunks.min(self.chunks + PILOT / CHUNK);
            let values = self.draw(next.clone());
            self.commit(next, values);
        }
        if let Held::Summed(summed) = &mut self.held
            && self.chunks < chunks
        {
            let new = self.chunks..chunks;
            summed.extend(&self.plan, new.clone());
            self.drawn(new);
        }
    }

    /// Draws chunks without taking them over: per chunk and output the values.
    pub(super) fn draw(&self, chunks: Range<u64>) -> Vec<Vec<Vec<f64>>> {
        let Plan {
            pool,
            source,
            layout,
            ..
        } = self.plan;
        let keep = || Keep {
            columns: vec![Vec::new(); source.outputs()],
            room: layout.batch().min(CHUNK) as usize,
        };
        simulate(pool, source, layout, chunks, keep).0
    }

    /// Takes over the next chunks, whose values are at hand.
    pub(super) fn commit(&mut self, chunks: Range<u64>, values: Vec<Vec<Vec<f64>>>) {
        match &mut self.held {
            Held::Columns(columns) => {
                let mut values = values.into_iter();
                // Most runs that are kept have one chunk.
                if columns.iter().all(Vec::is_empty)
                    && let Some(first) = values.next()
                {
                    *columns = first;
                }
                for (output, column) in columns.iter_mut().enumerate() {
                    let more = values.as_slice().iter().map(|chunk| chunk[output].len());
                    column.reserve(more.sum());
                }
                for chunk in values {
                    for (column, part) in columns.iter_mut().zip(chunk) {
                        column.extend(part);
                    }
                }
                self.drawn(chunks);
                self.count_if_many();
            }
            Held::Summed(summed) => {
                for chunk in values {
                    summed.take(&chunk, self.plan.ask);
                }
                self.drawn(chunks);
            }
        }
    }

    fn drawn(&mut self, chunks: Range<u64>) {
        let sizes = chunks.clone().map(|c| self.plan.layout.trials_in(c) as u64);
        self.trials += sizes.sum::<u64>();
        self.chunks = chunks.end;
    }

    /// From keeping to counting, when there are enough values to tell how.
    fn count_if_many(&mut self) {
        if let Held::Columns(columns) = &mut self.held
            && self.trials >= PILOT
        {
            let columns = std::mem::take(columns);
            let summed = Summed::holding(columns, self.plan.pivots, self.plan.p);
            self.held = Held::Summed(Box::new(summed));
        }
    }
}

impl Summed {
    /// Takes over values, which tell how to count further ones.
    fn holding(mut columns: Vec<Vec<f64>>, pivots: &[Pivot], p: f64) -> Self {
        let (pivots, orders): (Vec<Pivot>, Vec<Ordered>) = columns
            .iter()
            .zip(pivots)
            .map(|(column, pivot)| pilot(column, *pivot, p))
            .unzip();
        let mut summed = Summed {
            moments: pivots.iter().map(|pivot| Moments::empty(*pivot)).collect(),
            joint: (pivots.len() > 1).then(|| CoMoments::new(&pivots)),
            order_counts: Vec::new(),
            pivots,
        };
        let sums = Sums::new(&summed).of_columns(&columns);
        columns.iter_mut().for_each(only_finite);
        let order_counts = columns.into_iter().zip(&orders);
        summed.order_counts = order_counts
            .map(|(column, order)| OrderCounts::holding(column, order, p))
            .collect();
        summed.absorb(sums, Vec::new());
        summed
    }

    /// Draws some chunks.
    ///
    /// While one thread plans what to keep of the next round, the others draw the first chunks of that round by the
    /// plan before. More is kept of them than need be; what becomes known is the same.
    fn extend<S: Source>(&mut self, plan: &Plan<S>, chunks: Range<u64>) {
        let last = chunks.end;
        let helpers = plan.pool.threads() as u64 - 1;
        let mut drawn = chunks.start;
        let mut begun = drawn..drawn;
        let mut ahead = self.start(plan, begun.clone(), 0);
        while drawn < last {
            self.plan(plan.ask);
            let end = end_of_round(drawn, last);
            let rest = begun.end..end;
            let others = (rest.end - rest.start).saturating_sub(1);
            let round = self.start(plan, rest, others);
            begun = end..end_of_round(end, last).min(end + AHEAD * helpers);
            let next = self.start(plan, begun.clone(), begun.end - begun.start);
            let results = round.join(Tally::new(self));
            for (moments, tallies) in [replace(&mut ahead, next).wait(), results] {
                self.absorb(moments, tallies);
            }
            drawn = end;
        }
    }

    /// Lets so many helpers, at most, begin to draw some chunks.
    fn start<'env, S: Source>(
        &mut self,
        plan: &Plan<'_, 'env, S>,
        chunks: Range<u64>,
        helpers: u64,
    ) -> Drawing<'env, Tally> {
        let tallies = repeat_with(|| Tally::new(self)).take(helpers as usize);
        start(plan.pool, plan.source, plan.layout, chunks, tallies)
    }

    /// Takes values that are at hand.
    fn take(&mut self, columns: &[Vec<f64>], ask: &Ask) {
        self.plan(ask);
        let mut tally = Tally::new(self);
        let chunks = each_chunk(columns, &mut tally);
        self.absorb(chunks, vec![tally]);
    }

    /// Before further values come: decides which of them to keep.
    fn plan(&mut self, ask: &Ask) {
        // From fewer values nothing can be planned; they are few enough to be kept.
        for order_counts in self.order_counts.iter_mut().filter(|s| s.count() >= FEWEST) {
            order_counts.plan(&ask(order_counts.count()));
        }
    }

    /// Takes over what some chunks left behind.
    fn absorb(&mut self, chunks: Vec<ChunkSums>, tallies: Vec<Tally>) {
        for chunk in chunks {
            for (all, moments) in self.moments.iter_mut().zip(&chunk.moments) {
                *all = all.merge(moments);
            }
            if let (Some(all), Some(joint)) = (&mut self.joint, &chunk.joint) {
                all.merge(joint);
            }
        }
        for tally in tallies {
            for (order_counts, thread_counts) in
                self.order_counts.iter_mut().zip(tally.thread_counts)
            {
                order_counts.absorb(thread_counts.finish());
            }
        }
    }
}

/// The last of so many chunks after those that have been `drawn` until the next look.
fn end_of_round(drawn: u64, last: u64) -> u64 {
    last.min(drawn + (GROWTH * drawn).min(MOST_CHUNKS))
}

/// Sums over a chunk.
pub(super) struct ChunkSums {
    moments: Vec<Moments>,
    joint: Option<CoMoments>,
}

/// Origin and scale for the moments of values like these, and their order, from those that are finite.
fn pilot(column: &[f64], pivot: Pivot, p: f64) -> (Pivot, Ordered) {
    let mut failed = Vec::new();
    let mut finite = column;
    if !column.iter().all(|value| value.is_finite()) {
        failed.extend_from_slice(column);
        only_finite(&mut failed);
        if failed.is_empty() {
            // Anything will do; later trials may have values.
            failed.push(0.0);
        }
        finite = &failed;
    }
    let order = OrderCounts::order(finite, p);
    // The moments' own origin need not be the mean; a constant's has to be exact.
    let pivot = pivot.moved(order.median());
    (Pivot::new(order.median(), sd(finite, pivot)), order)
}

/// Standard deviation of finite values, of which the pivot is near the mean.
fn sd(values: &[f64], pivot: Pivot) -> f64 {
    let mut sums = OutputSums::new(&pivot);
    let (blocks, rest) = values.as_chunks();
    for block in blocks {
        sums.add(level(), &Block(*block));
    }
    sums.add_each(rest);
    sums.close().sd()
}

fn only_finite(column: &mut Vec<f64>) {
    column.retain(|value| value.is_finite());
}

/// Shows values to a sink, as they are when they are drawn.
fn each_chunk<K: Sink>(columns: &[Vec<f64>], sink: &mut K) -> Vec<K::Chunk> {
    let trials = columns.first().map_or(0, Vec::len);
    let mut blocks = vec![Block::ZERO; columns.len()];
    let mut chunks = Vec::new();
    for start in (0..trials).step_by(LANES) {
        let end = trials.min(start + LANES);
        for (block, column) in blocks.iter_mut().zip(columns) {
            block.0[..end - start].copy_from_slice(&column[start..end]);
        }
        sink.take(&blocks, end - start);
        if end == trials || end.is_multiple_of(CHUNK as usize) {
            chunks.push(sink.close());
        }
    }
    chunks
}

/// Sums over a part of a chunk.
struct Sums {
    level: Level,
    outputs: Vec<OutputSums>,
    joint: Option<CoMoments>,
}

impl Sums {
    fn new(summed: &Summed) -> Self {
        Sums {
            level: level(),
            outputs: summed.pivots.iter().map(OutputSums::new).collect(),
            joint: summed.joint.as_ref().map(CoMoments::emptied),
        }
    }

    fn of_columns(mut self, columns: &[Vec<f64>]) -> Vec<ChunkSums> {
        each_chunk(columns, &mut self)
    }

    fn take_joint(&mut self, outputs: &[Block], lanes: usize) {
        if let Some(joint) = &mut self.joint {
            joint.take(self.level, outputs, lanes);
        }
    }
}

impl Sink for Sums {
    type Chunk = ChunkSums;

    fn take(&mut self, outputs: &[Block], lanes: usize) {
        for (sums, block) in self.outputs.iter_mut().zip(outputs) {
            if lanes == LANES && all_finite(self.level, block) {
                sums.add(self.level, block);
            } else {
                sums.add_each(&block.0[..lanes]);
            }
        }
        self.take_joint(outputs, lanes);
    }

    fn close(&mut self) -> ChunkSums {
        ChunkSums {
            moments: self.outputs.iter_mut().map(OutputSums::close).collect(),
            joint: self.joint.as_mut().map(CoMoments::close),
        }
    }
}

/// Sums of one output.
struct OutputSums {
    pivot: Pivot,
    sums: PowerSums,
    count: u64,
    failed: u64,
}

impl OutputSums {
    fn new(pivot: &Pivot) -> Self {
        OutputSums {
            pivot: *pivot,
            sums: PowerSums::default(),
            count: 0,
            failed: 0,
        }
    }

    /// Adds a block that is all finite.
    fn add(&mut self, level: Level, block: &Block) {
        self.sums.add(level, block, self.pivot.coordinates());
        self.count += LANES as u64;
    }

    fn add_each(&mut self, values: &[f64]) {
        for &value in values {
            if value.is_finite() {
                self.sums.add_one(value, self.pivot.coordinates());
                self.count += 1;
            } else {
                self.failed += 1;
            }
        }
    }

    fn close(&mut self) -> Moments {
        let sums = std::mem::take(&mut self.sums).totals();
        let count = std::mem::take(&mut self.count);
        let failed = std::mem::take(&mut self.failed);
        Moments::from_sums(self.pivot, count, failed, sums)
    }
}

/// Counts and sums of what one thread draws.
struct Tally {
    sums: Sums,
    /// Per output.
    thread_counts: Vec<ThreadCounts>,
}

impl Tally {
    fn new(summed: &mut Summed) -> Self {
        Tally {
            sums: Sums::new(summed),
            thread_counts: summed
                .order_counts
                .iter_mut()
                .map(OrderCounts::thread_counts)
                .collect(),
        }
    }
}

impl Sink for Tally {
    type Chunk = ChunkSums;

    fn take(&mut self, outputs: &[Block], lanes: usize) {
        let Sums {
            level,
            outputs: sums,
            ..
        } = &mut self.sums;
        for ((sums, thread_counts), block) in
            sums.iter_mut().zip(&mut self.thread_counts).zip(outputs)
        {
            if lanes == LANES && thread_counts.take(block) {
                sums.add(*level, block);
            } else {
                thread_counts.take_each(&block.0[..lanes]);
                sums.add_each(&block.0[..lanes]);
            }
        }
        self.sums.take_joint(outputs, lanes);
    }

    fn close(&mut self) -> ChunkSums {
        self.sums.close()
    }

    fn end(&mut self) {
        self.thread_counts.iter_mut().for_each(ThreadCounts::settle);
    }
}

/// Keeps everything.
struct Keep {
    columns: Vec<Vec<f64>>,
    /// Most trials of a chunk.
    room: usize,
}

impl Sink for Keep {
    type Chunk = Vec<Vec<f64>>;

    fn take(&mut self, outputs: &[Block], lanes: usize) {
        for (column, block) in self.columns.iter_mut().zip(outputs) {
            if column.is_empty() {
                column.reserve_exact(self.room);
            }
            column.extend_from_slice(&block.0[..lanes]);
        }
    }

    fn close(&mut self) -> Vec<Vec<f64>> {
        self.columns.iter_mut().map(std::mem::take).collect()
    }
}
