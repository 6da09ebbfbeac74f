//! Rows on several threads.

use std::panic::resume_unwind;
use std::thread;

/// Rows whose figures are in memory at a time: far more than starting a thread takes, and little beside the table.
const STRETCH: usize = 1 << 16;

/// Rows for which no thread of their own is worth starting.
const FEW: usize = 1 << 10;

/// Computes something of each of these, on so many threads, and takes it in their order: what becomes of it does not depend on how
/// many threads there are.
pub(crate) fn in_order<I: Copy + Sync, T: Send>(
    items: &[I],
    threads: usize,
    compute: impl Fn(I) -> T + Sync,
    mut take: impl FnMut(I, T),
) {
    for stretch in items.chunks(STRETCH) {
        let part = stretch.len().div_ceil(threads.max(1)).max(FEW);
        let parts = stretch.chunks(part);
        thread::scope(|scope| {
            let compute = &compute;
            let all = |part: &[I]| part.iter().map(|one| compute(*one)).collect::<Vec<T>>();
            // The last part is this thread's.
            let others = parts.clone().take(parts.len() - 1);
            let running: Vec<_> = others.map(|part| scope.spawn(move || all(part))).collect();
            let own = parts.clone().last().map(all);
            let done = running.into_iter();
            let done = done.map(|part| part.join().unwrap_or_else(|panic| resume_unwind(panic)));
            for (part, found) in parts.zip(done.chain(own)) {
                for (item, found) in part.iter().zip(found) {
                    take(*item, found);
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::in_order;

    #[test]
    fn everything_comes_in_order_on_any_number_of_threads() {
        for count in [0, 1, 7, 5000, 200_001] {
            let items: Vec<usize> = (0..count).collect();
            for threads in [0, 1, 2, 3, 16] {
                let mut taken = Vec::new();
                in_order(
                    &items,
                    threads,
                    |x| 3 * x,
                    |x, triple| taken.push((x, triple)),
                );
                let expected: Vec<_> = items.iter().map(|x| (*x, 3 * x)).collect();
                assert_eq!(taken, expected, "{count} on {threads}");
            }
        }
    }
}
