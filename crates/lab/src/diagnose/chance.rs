//! Draws: without chance from what is weighed, and random numbers that are the same for every run.

use gumption_lanes::{Block, Generator, LANES};

/// Items in proportion to their weights, without chance: those at the middle of equal parts of the cumulated
/// weight.
pub(super) fn in_proportion<'t, T>(items: &'t [T], weights: &[f64], draws: usize) -> Vec<&'t T> {
    let total: f64 = weights.iter().sum();
    let at = |draw: usize| {
        let mut left = (draw as f64 + 0.5) / draws as f64 * total;
        items.iter().zip(weights).find_map(|(item, weight)| {
            left -= weight;
            (left <= 0.0).then_some(item)
        })
    };
    (0..draws).filter_map(at).collect()
}

/// So many random numbers of a stream, as `fill` draws them block by block.
pub(super) fn numbers(
    seed: u64,
    stream: u64,
    count: usize,
    fill: impl Fn(&mut Generator, &mut Block),
) -> Vec<f64> {
    let mut numbers = Vec::with_capacity(count + LANES);
    let mut block = Block::ZERO;
    for chunk in 0..count.div_ceil(LANES) {
        fill(&mut Generator::new(seed, chunk as u64, stream), &mut block);
        numbers.extend_from_slice(&block.0);
    }
    numbers.truncate(count);
    numbers
}
