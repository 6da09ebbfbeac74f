//! The picture of an output distribution.

use gumption_lanes::bins::Grid;

use super::thread_pool::parallel_map;
use crate::propagate::result::Histogram;

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
    let parts = parallel_map(
        parts,
        threads,
        || (),
        |(), part| count(part, start, width),
        |()| (),
    )
    .0;
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

/// The same from counts in a finer grid, whose edges the bins of the picture keep to.
pub(super) fn from_grid(
    grid: &Grid,
    counts: &[u64],
    [least, most]: [f64; 2],
    interval: [f64; 2],
) -> Histogram {
    let margin = 0.3 * (interval[1] - interval[0]);
    let first = grid.bin((interval[0] - margin).max(least));
    let last = grid.bin((interval[1] + margin).min(most));
    let step = (last + 1 - first).div_ceil(BINS).max(1);
    let start = first.min(counts.len().saturating_sub(BINS * step));
    let inside = counts.iter().skip(start).take(BINS * step);
    let inside: Vec<u64> = inside.copied().collect();
    if least == most {
        let mut counts = vec![0; BINS];
        counts[0] = inside.iter().sum();
        return Histogram {
            start: least,
            width: 0.0,
            counts,
        };
    }
    Histogram {
        start: grid.edge(start),
        width: step as f64 * grid.width(),
        counts: inside.chunks(step).map(|bins| bins.iter().sum()).collect(),
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
    fn a_finer_grid_gives_a_picture_too() {
        // Middles −5, −4.99, … of 4096 bins, a count of one in each.
        let grid = Grid::new(-5.0, 0.01);
        let h = from_grid(&grid, &[1; 4096], [-5.0, 35.95], [0.0, 20.0]);
        // From −6 or rather −5 to 26: 3101 bins, 49 in each of the 64.
        assert_eq!(h.counts, [49; 64]);
        assert!((h.start + 5.005).abs() < 1e-12 && (h.width - 0.49).abs() < 1e-12);
        let h = from_grid(&grid, &[1; 4096], [30.0, 35.95], [31.0, 35.0]);
        assert_eq!((h.counts.len(), h.counts[0]), (64, 10));
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
