//! Fractions of the trials between given limits: conformance probabilities (JCGM 106 clause 7).

use super::budget_source::BudgetSource;
use super::engine::{Layout, Source, parallel_map};
use crate::budget::{Budget, Interval};

/// For every output and interval the fraction of its finite trials inside, with the limits; `None` where no
/// trial is finite. The trials are those of a run with this seed, drawn again.
pub(crate) fn fractions(
    budget: &Budget,
    (seed, trials): (u64, u64),
    asked: &[(usize, Interval)],
    threads: usize,
) -> Vec<Option<f64>> {
    let source = BudgetSource::new(budget, seed);
    let layout = Layout::new(trials);
    let chunks: Vec<u64> = layout.chunks(0..1).collect();
    let counts = parallel_map(
        chunks,
        threads,
        || (source.worker(), vec![Vec::new(); source.outputs()]),
        |(worker, columns), chunk| {
            let length = layout.trials_in(chunk);
            for column in columns.iter_mut() {
                column.resize(length, 0.0);
            }
            let mut places: Vec<&mut [f64]> = columns.iter_mut().map(Vec::as_mut_slice).collect();
            source.draw(worker, chunk, &mut places);
            asked
                .iter()
                .map(|(output, interval)| count(columns.get(*output), *interval))
                .collect::<Vec<_>>()
        },
    );
    let sum = |index: usize| {
        let pairs = counts.iter().filter_map(|chunk| chunk.get(index));
        pairs.fold((0, 0), |(a, b), (inside, all)| (a + inside, b + all))
    };
    (0..asked.len())
        .map(sum)
        .map(|(inside, all)| (all > 0).then(|| inside as f64 / all as f64))
        .collect()
}

/// Finite values inside, and all finite values.
fn count(column: Option<&Vec<f64>>, interval: Interval) -> (u64, u64) {
    let values = column
        .into_iter()
        .flatten()
        .filter(|value| value.is_finite());
    values.fold((0, 0), |(inside, all), value| {
        (inside + u64::from(interval.contains(*value)), all + 1)
    })
}
