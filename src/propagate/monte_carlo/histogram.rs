//! The picture of an output distribution.

use crate::propagate::Histogram;

/// Bins of the picture.
const BINS: usize = 64;

/// Counts the values in equal bins over the symmetric interval widened by 30 % on either side, or the
/// range of the values where that is narrower. Values outside are left out of the picture.
pub(super) fn histogram(values: &[f64], interval: [f64; 2]) -> Histogram {
    let margin = 0.3 * (interval[1] - interval[0]);
    let (least, most) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), v| {
            (l.min(*v), m.max(*v))
        });
    let start = (interval[0] - margin).max(least);
    let width = ((interval[1] + margin).min(most) - start) / BINS as f64;
    let mut counts = vec![0; BINS];
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
    Histogram {
        start,
        width,
        counts,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounded_values_fill_the_bins_evenly() {
        let values: Vec<f64> = (0..=6400).map(|i| f64::from(i) / 100.0).collect();
        let h = histogram(&values, [1.6, 62.4]);
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
        let h = histogram(&values, [25.0, 975.0]);
        assert_eq!(h.counts.iter().sum::<u64>(), 1000);
        assert_eq!(h.start, 0.0);
    }

    #[test]
    fn a_constant_is_one_bin_without_width() {
        let h = histogram(&[7.0; 20], [7.0, 7.0]);
        assert_eq!((h.start, h.width, h.counts[0]), (7.0, 0.0, 20));
    }
}
