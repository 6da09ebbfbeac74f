//! Chunks of trials, shared among threads and handed on in order.
//!
//! A chunk is the unit of randomness: its streams are seeded from (seed, chunk, component), so any
//! chunk can be drawn by any thread, or again later. Everything that is summed is summed within a
//! chunk first and then over chunks in their order; results are therefore the same bits for any
//! number of threads.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::moments::{Moments, Pivot};

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

    /// Replaces each column by the first `trials` values of that output in `chunk`.
    fn draw(&self, worker: &mut Self::Worker, chunk: u64, trials: usize, columns: &mut [Vec<f64>]);
}

/// Receives the chunks in order.
///
/// This is the only place where trials are kept, so a sink that counts instead of storing can
/// replace [`super::store::Store`] without a change elsewhere in the engine.
pub(super) trait Sink: Send {
    /// Takes the next chunk: the values of every output and their moments.
    fn absorb(&mut self, columns: &[Vec<f64>], moments: Vec<Moments>);
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

    fn trials_in(self, chunk: u64) -> usize {
        let before = (chunk % self.chunks_per_batch()) * CHUNK;
        // At most CHUNK, so that the conversion is exact.
        (self.batch - before).min(CHUNK) as usize
    }
}

/// Draws `batches` on `threads` threads and hands them to `sink` in order.
pub(super) fn simulate<S: Source>(
    source: &S,
    layout: Layout,
    batches: Range<u64>,
    pivots: &[Pivot],
    threads: usize,
    sink: &mut impl Sink,
) {
    let chunks = layout.chunks(batches);
    let next = AtomicU64::new(chunks.start);
    let queue = Mutex::new(Queue {
        expected: chunks.start,
        waiting: BTreeMap::new(),
        spare: Vec::new(),
        sink,
    });
    let work = || {
        let mut worker = source.worker();
        loop {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            if chunk >= chunks.end {
                break;
            }
            let mut columns = lock(&queue)
                .spare
                .pop()
                .unwrap_or_else(|| vec![Vec::new(); source.outputs()]);
            source.draw(&mut worker, chunk, layout.trials_in(chunk), &mut columns);
            let moments = columns
                .iter()
                .zip(pivots)
                .map(|(c, pivot)| Moments::of(c, *pivot))
                .collect();
            lock(&queue).push(chunk, columns, moments);
        }
    };
    let helpers = (threads.max(1) as u64)
        .min(chunks.end.saturating_sub(chunks.start))
        .max(1)
        - 1;
    std::thread::scope(|scope| {
        for _ in 0..helpers {
            scope.spawn(work);
        }
        work();
    });
}

/// A panic in another thread is propagated by the scope; the queue itself stays consistent.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Puts finished chunks back into order.
struct Queue<'s, K> {
    expected: u64,
    waiting: BTreeMap<u64, (Vec<Vec<f64>>, Vec<Moments>)>,
    /// Buffers to be used again.
    spare: Vec<Vec<Vec<f64>>>,
    sink: &'s mut K,
}

impl<K: Sink> Queue<'_, K> {
    fn push(&mut self, chunk: u64, columns: Vec<Vec<f64>>, moments: Vec<Moments>) {
        self.waiting.insert(chunk, (columns, moments));
        while let Some((columns, moments)) = self.waiting.remove(&self.expected) {
            self.sink.absorb(&columns, moments);
            self.spare.push(columns);
            self.expected += 1;
        }
    }
}

/// `task(0..count)` on several threads, results in order.
pub(super) fn parallel_map<T: Send>(
    tasks: Vec<Box<dyn FnOnce() -> T + Send + '_>>,
    threads: usize,
) -> Vec<T> {
    let helpers = threads.clamp(1, tasks.len().max(1)) - 1;
    let queue = Mutex::new(tasks.into_iter().enumerate());
    let done = Mutex::new(BTreeMap::new());
    let work = || {
        loop {
            let task = lock(&queue).next();
            let Some((index, task)) = task else { break };
            let result = task();
            lock(&done).insert(index, result);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..helpers {
            scope.spawn(work);
        }
        work();
    });
    done.into_inner()
        .unwrap_or_else(PoisonError::into_inner)
        .into_values()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::samples::Sampled;
    use super::super::store::Store;
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
        let tasks: Vec<Box<dyn FnOnce() -> usize + Send>> = (0..50_usize)
            .map(|i| Box::new(move || i * i) as Box<_>)
            .collect();
        let squares: Vec<usize> = (0..50).map(|i| i * i).collect();
        assert_eq!(parallel_map(tasks, 4), squares);
    }
}
