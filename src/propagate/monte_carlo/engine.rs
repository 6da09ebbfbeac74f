//! Chunks of trials, shared among threads.
//!
//! A chunk is the unit of randomness: its streams are seeded from (seed, chunk, component), so any
//! chunk can be drawn by any thread, or again later. Everything that is summed is summed within a
//! chunk first and then over chunks in their order; results are therefore the same bits for any
//! number of threads. Every chunk is drawn into its own place among the trials that are kept, so
//! that nothing is copied and no thread waits for another.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use super::moments::{Moments, Pivot};
use super::store::Store;

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

    /// Fills each column with the first values of that output in `chunk`; all columns are of one
    /// length.
    fn draw(&self, worker: &mut Self::Worker, chunk: u64, columns: &mut [&mut [f64]]);
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

/// Draws `batches` on `threads` threads and adds them to what `store` holds.
pub(super) fn simulate<S: Source>(
    source: &S,
    layout: Layout,
    batches: Range<u64>,
    pivots: &[Pivot],
    threads: usize,
    store: &mut Store,
) {
    let sizes = layout
        .chunks(batches)
        .map(|chunk| (chunk, layout.trials_in(chunk)));
    let moments = {
        let mut free = store.extend(sizes.clone().map(|(_, trials)| trials).sum());
        let pieces: Vec<_> = sizes
            .map(|(chunk, trials)| (chunk, split_off(&mut free, trials)))
            .collect();
        parallel_map(
            pieces,
            threads,
            || source.worker(),
            |worker, (chunk, mut columns)| {
                source.draw(worker, chunk, &mut columns);
                let pairs = columns.iter().zip(pivots);
                pairs.map(|(c, pivot)| Moments::of(c, *pivot)).collect()
            },
        )
    };
    store.add_moments(moments);
}

/// The first `count` places of every column; the columns keep the rest.
fn split_off<'c>(columns: &mut [&'c mut [f64]], count: usize) -> Vec<&'c mut [f64]> {
    let first = |column: &mut &'c mut [f64]| {
        let (first, rest) = std::mem::take(column).split_at_mut(count);
        *column = rest;
        first
    };
    columns.iter_mut().map(first).collect()
}

/// `task` of every item on several threads, each with a scratch space; results in the order of the
/// items.
pub(super) fn parallel_map<I: Send, W, T: Send>(
    items: Vec<I>,
    threads: usize,
    scratch: impl Fn() -> W + Sync,
    task: impl Fn(&mut W, I) -> T + Sync,
) -> Vec<T> {
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
        done
    };
    let mut done = std::thread::scope(|scope| {
        let helpers: Vec<_> = (0..helpers).map(|_| scope.spawn(work)).collect();
        let mut done = work();
        for helper in helpers {
            match helper.join() {
                Ok(theirs) => done.extend(theirs),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        done
    });
    done.sort_unstable_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::super::samples::Sampled;
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
    fn any_number_of_threads_gives_the_same_bits() {
        let source = Sampled::normal(7, 2);
        let pivots = [Pivot::new(0.0, 1.0); 2];
        let run = |threads| {
            let mut store = Store::new(2);
            simulate(
                &source,
                Layout::new(150_001),
                0..2,
                &pivots,
                threads,
                &mut store,
            );
            assert_eq!(store.trials(), 300_002);
            let bits: Vec<Vec<u64>> = store
                .columns()
                .iter()
                .map(|c| c.iter().map(|v| v.to_bits()).collect())
                .collect();
            let moments: Vec<_> = (0..2).map(|o| store.moments(o)).collect();
            (bits, moments)
        };
        let one = run(1);
        for threads in [2, 3, 8, 100] {
            assert_eq!(run(threads), one, "{threads} threads");
        }
    }

    #[test]
    fn parallel_map_keeps_order() {
        let items: Vec<usize> = (0..50).collect();
        let squares: Vec<usize> = (0..50).map(|i| i * i).collect();
        assert_eq!(parallel_map(items, 4, || (), |_, i| i * i), squares);
    }
}
