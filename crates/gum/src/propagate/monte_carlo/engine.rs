//! Chunks of trials, shared among threads.
//!
//! A chunk is the unit of randomness: its streams are seeded from (seed, chunk, component), so any
//! chunk can be drawn by any thread, or again later. Everything that is summed is summed within a
//! chunk first and then over chunks in their order; results are therefore the same bits for any
//! number of threads. Trials go block by block from a [`Source`] to a [`Sink`] and are not kept.

use std::iter::repeat_with;
use std::ops::Range;

use gumption_lanes::{Block, LANES};

use super::thread_pool::{Started, ThreadPool};

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

    /// Whether nobody waits for further trials: of a chunk that has not begun, one block without values is enough then.
    fn is_over(&self) -> bool {
        false
    }

    /// Hears how many trials a thread has drawn.
    fn drawn(&self, _trials: u64) {}

    /// Hears that all trials have been drawn once: from here on each has the values that it had. Whether somebody has
    /// stopped the run before, so that some have none.
    fn settle(&self) -> bool {
        false
    }
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

/// Draws some chunks. Returns what every chunk left behind, in their order, and the sinks, in no order: what these
/// hold must not depend on which of them took which chunk.
pub(super) fn simulate<'env, S: Source, K: Sink + 'env>(
    pool: &ThreadPool<'env>,
    source: &'env S,
    layout: Layout,
    chunks: Range<u64>,
    mut sink: impl FnMut() -> K,
) -> (Vec<K::Chunk>, Vec<K>) {
    let others = (chunks.end - chunks.start).saturating_sub(1) as usize;
    let sinks = repeat_with(&mut sink).take(others);
    let drawing = start(pool, source, layout, chunks, sinks);
    drawing.join(sink())
}

/// Chunks that helpers draw.
pub(super) type Drawing<'env, K> = Started<'env, K, <K as Sink>::Chunk, K>;

/// Lets helpers begin to draw some chunks, each with one of the sinks. Results as of [`simulate`].
pub(super) fn start<'env, S: Source, K: Sink + 'env>(
    pool: &ThreadPool<'env>,
    source: &'env S,
    layout: Layout,
    chunks: Range<u64>,
    sinks: impl Iterator<Item = K>,
) -> Drawing<'env, K> {
    pool.start(
        chunks.collect(),
        sinks,
        |sink| {
            let outputs = vec![Block::ZERO; source.outputs()];
            (source.worker(), outputs, sink)
        },
        move |(worker, outputs, sink), chunk| {
            source.start(worker, chunk);
            let trials = match source.is_over() {
                true => LANES.min(layout.trials_in(chunk)),
                false => layout.trials_in(chunk),
            };
            for start in (0..trials).step_by(LANES) {
                source.next(worker, outputs);
                sink.take(outputs, LANES.min(trials - start));
            }
            source.drawn(trials as u64);
            sink.close()
        },
        |(_, _, mut sink)| {
            sink.end();
            sink
        },
    )
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
}
