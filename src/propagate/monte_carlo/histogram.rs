//! The picture of an output distribution.

use super::engine::parallel_map;
use crate::propagate::Histogram;

/// Bins of the picture.
const BINS: usize = 64;

/// Values that one thread takes at a time.
const PART: usize = 1 << 16;

/// Counts the values in equal bins over the symmetric interval widened by 30 % on either side, or their
/// `range` where that is narrower. Values outside are left out of the picture.
pub(super) fn histogram(
    values: &[f64],
    [least, most]: [f64; 2],
    interval: [f64; 2],
    threads: usize,
) -> Histogram {
    let margin = 0.3 * (interval[1] - interval[0]);
    let start = (interval[0] - margin).max(least);
    let width = ((interval[1] + margin).min(most) - start) / BINS as f64;
    let parts = values.chunks(PART).collect();
    let parts = parallel_map(parts, threads, || (), |(), part| count(part, start, width));
    let mut counts = vec![0; BINS];
    for part in parts {
        counts.iter_mut().zip(part).for_each(|(all, n)| *all += n);
    }
    Histogram {
        start,
        width,
        counts,
    }
}

fn count(values: &[f64], start: f64, width: f64) -> [u64; BINS] {
    let mut counts = [0; BINS];
    if width > 0.0 {
        for value in values {
            let place = (value - start) / width;
            // The right edge of the last bin belongs to it.
            if (0.0..=BINS as f64).contains(&place) {
                counts[(place as usize).min(BINS - 1)] += 1;
            }
        }
    } else {
        counts[0] = values.iter().filter(|v| **v == start).count() as u64;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounded_values_fill_the_bins_evenly() {
        let values: Vec<f64> = (0..=6400).map(|i| f64::from(i) / 100.0).collect();
        let h = histogram(&values, [0.0, 64.0], [1.6, 62.4], 2);
        assert_eq!((h.start, h.width), (0.0, 1.0));
        assert_eq!(h.counts.iter().sum::<u64>(), 6401);
        assert!(
            h.counts.iter().all(|c| (99..=102).contains(c)),
            "{:?}",
            h.counts
        );
    }

    #[test]
    fn far_values_are_left_out() {
        let mut values: Vec<f64> = (0..1000).map(f64::from).collect();
        values.push(1e9);
        let h = histogram(&values, [0.0, 1e9], [25.0, 975.0], 1);
        assert_eq!(h.counts.iter().sum::<u64>(), 1000);
        assert_eq!(h.start, 0.0);
    }

    #[test]
    fn a_constant_is_one_bin_without_width() {
        let h = histogram(&[7.0; 20], [7.0; 2], [7.0; 2], 1);
        assert_eq!((h.start, h.width, h.counts[0]), (7.0, 0.0, 20));
    }
}
