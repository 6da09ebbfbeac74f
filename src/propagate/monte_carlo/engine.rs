//! Chunks of trials, shared among threads.
//!
//! A chunk is the unit of randomness: its streams are seeded from (seed, chunk, component), so any
//! chunk can be drawn by any thread, or again later. Everything that is summed is summed within a
//! chunk first and then over chunks in their order; results are therefore the same bits for any
//! number of threads. Trials go block by block from a [`Source`] to a [`Sink`] and are not kept.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use gumption_lanes::{Block, LANES};

use crate::propagate::progress;

/// Most trials in a chunk: 64 blocks of 256.
pub(super) const CHUNK: u64 = 1 << 14;

/// Draws model values; the budget's own in production, known samples in tests.
pub(super) trait Source: Sync {
    /// Scratch space of one thread.
    type Worker;

    /// Number of measurands.
    fn outputs(&self) -> usize;

    /// Scratch space for one thread.
    fn worker(&self) -> Self::Worker;

    /// Begins a chunk.
    fn start(&self, worker: &mut Self::Worker, chunk: u64);

    /// The next trials of the chunk, one block per output.
    fn next(&self, worker: &mut Self::Worker, outputs: &mut [Block]);
}

/// Takes trials in; every thread has one of its own.
pub(super) trait Sink: Send {
    /// What a chunk leaves behind.
    type Chunk: Send;

    /// The next trials of a chunk: the first `lanes` lanes of one block per output.
    fn take(&mut self, outputs: &[Block], lanes: usize);

    /// Ends a chunk.
    fn close(&mut self) -> Self::Chunk;

    /// After the last chunk: what a thread can do before all sinks are together.
    fn end(&mut self) {}
}

/// How trials are cut: batches (the "applications of MCM" of JCGM 101 7.9.4) of whole chunks, the last
/// chunk of a batch shortened so that a batch has exactly the trials asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    batch: u64,
}

impl Layout {
    /// Batches of `batch` trials (at least one).
    pub(super) fn new(batch: u64) -> Self {
        Layout {
            batch: batch.max(1),
        }
    }

    /// Trials of one batch.
    pub(super) fn batch(self) -> u64 {
        self.batch
    }

    fn chunks_per_batch(self) -> u64 {
        self.batch.div_ceil(CHUNK)
    }

    /// The chunks that make up some batches.
    pub(super) fn chunks(self, batches: Range<u64>) -> Range<u64> {
        batches.start * self.chunks_per_batch()..batches.end * self.chunks_per_batch()
    }

    /// Trials in a chunk.
    pub(super) fn trials_in(self, chunk: u64) -> usize {
        let before = (chunk % self.chunks_per_batch()) * CHUNK;
        // At most CHUNK, so that the conversion is exact.
        (self.batch - before).min(CHUNK) as usize
    }
}

/// Draws some chunks on `threads` threads. Returns what every chunk left behind, in their order, and
/// the sinks, in no order: what these hold must not depend on which of them took which chunk.
pub(super) fn simulate<S: Source, K: Sink>(
    source: &S,
    layout: Layout,
    chunks: Range<u64>,
    threads: usize,
    sink: impl Fn() -> K + Sync,
) -> (Vec<K::Chunk>, Vec<K>) {
    let scratch = || {
        let outputs = vec![Block::ZERO; source.outputs()];
        (source.worker(), outputs, sink())
    };
    parallel_map(
        chunks.collect(),
        threads,
        scratch,
        |(worker, outputs, sink), chunk| {
            source.start(worker, chunk);
            let trials = layout.trials_in(chunk);
            for start in (0..trials).step_by(LANES) {
                source.next(worker, outputs);
                sink.take(outputs, LANES.min(trials - start));
            }
            progress::count(trials as u64);
            sink.close()
        },
        |(_, _, mut sink)| {
            sink.end();
            sink
        },
    )
}

/// Draws some chunks on `threads` threads, and appends the values of each output to its column.
pub(super) fn append<S: Source>(
    source: &S,
    layout: Layout,
    chunks: Range<u64>,
    threads: usize,
    columns: &mut [Vec<f64>],
) {
    let sizes: Vec<usize> = chunks.clone().map(|c| layout.trials_in(c)).collect();
    let mut places: Vec<Vec<&mut [f64]>> = sizes.iter().map(|_| Vec::new()).collect();
    for column in columns {
        let start = column.len();
        let end = start + sizes.iter().sum::<usize>();
        if start == 0 {
            // Memory that nothing is written to before the values.
            *column = vec![0.0; end];
        } else {
            column.resize(end, 0.0);
        }
        let mut rest = &mut column[start..];
        for (places, size) in places.iter_mut().zip(&sizes) {
            let (place, others) = rest.split_at_mut(*size);
            places.push(place);
            rest = others;
        }
    }
    parallel_map(
        chunks.zip(places).collect(),
        threads,
        || (source.worker(), vec![Block::ZERO; source.outputs()]),
        |(worker, outputs), (chunk, mut places)| {
            source.start(worker, chunk);
            let trials = layout.trials_in(chunk);
            for start in (0..trials).step_by(LANES) {
                source.next(worker, outputs);
                for (place, output) in places.iter_mut().zip(&*outputs) {
                    let place = &mut place[start..trials.min(start + LANES)];
                    place.copy_from_slice(&output.0[..place.len()]);
                }
            }
            progress::count(trials as u64);
        },
        |_| (),
    );
}

/// `task` of every item on several threads, each with a scratch space; results in the order of the
/// items, and what `finish` makes of the scratch spaces in no order.
pub(super) fn parallel_map<I: Send, W, T: Send, R: Send>(
    items: Vec<I>,
    threads: usize,
    scratch: impl Fn() -> W + Sync,
    task: impl Fn(&mut W, I) -> T + Sync,
    finish: impl Fn(W) -> R + Sync,
) -> (Vec<T>, Vec<R>) {
    let helpers = threads.clamp(1, items.len().max(1)) - 1;
    let queue = Mutex::new(items.into_iter().enumerate());
    let work = || {
        let mut scratch = scratch();
        let mut done = Vec::new();
        loop {
            // Whoever panics while taking an item leaves the queue consistent.
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((index, item)) = next else { break };
            done.push((index, task(&mut scratch, item)));
        }
        (done, finish(scratch))
    };
    let (mut done, rest) = std::thread::scope(|scope| {
        let helpers: Vec<_> = (0..helpers).map(|_| scope.spawn(work)).collect();
        let (mut done, own) = work();
        let mut rest = vec![own];
        for helper in helpers {
            match helper.join() {
                Ok((theirs, other)) => {
                    done.extend(theirs);
                    rest.push(other);
                }
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        (done, rest)
    });
    done.sort_unstable_by_key(|(index, _)| *index);
    let done = done.into_iter().map(|(_, result)| result).collect();
    (done, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layout_cuts_batches_exactly() {
        let layout = Layout::new(40_000);
        assert_eq!(layout.chunks(1..3), 3..9);
        let sizes: Vec<_> = (3..6).map(|c| layout.trials_in(c)).collect();
        assert_eq!(sizes, [16_384, 16_384, 7_232]);
        assert_eq!(Layout::new(CHUNK).trials_in(5), CHUNK as usize);
        assert_eq!(Layout::new(1).trials_in(5), 1);
    }

    #[test]
    fn parallel_map_keeps_order() {
        let items: Vec<usize> = (0..50).collect();
        let squares: Vec<usize> = (0..50).map(|i| i * i).collect();
        let (done, counts) = parallel_map(
            items,
            4,
            || 0,
            |count, i| {
                *count += 1;
                i * i
            },
            |count| count,
        );
        assert_eq!(done, squares);
        assert_eq!((counts.len(), counts.iter().sum::<i32>()), (4, 50));
    }
}
