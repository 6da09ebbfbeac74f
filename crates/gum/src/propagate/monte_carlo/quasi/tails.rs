//! A distribution function known at some places, with its density: quantiles and the shortest interval.
//!
//! Between two places it is the cubic with these values and slopes.

/// A place, the probability of a value below, and the density there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub(super) y: f64,
    pub(super) below: f64,
    pub(super) density: f64,
}

/// A distribution function at ascending places.
#[derive(Debug, Clone)]
pub(super) struct Tails(pub(super) Vec<Node>);

impl Tails {
    /// From sums of probabilities and densities over so many points.
    pub(super) fn new(places: &[f64], sums: &[[f64; 2]], points: f64) -> Tails {
        let node = |(y, [below, density]): (&f64, &[f64; 2])| Node {
            y: *y,
            below: below / points,
            density: density / points,
        };
        Tails(places.iter().zip(sums).map(node).collect())
    }

    /// The place below which a fraction p lies; the first or last node where p is beyond them.
    pub(super) fn quantile(&self, p: f64) -> f64 {
        let after = self.0.partition_point(|node| node.below < p);
        match (
            after.checked_sub(1).and_then(|before| self.0.get(before)),
            self.0.get(after),
        ) {
            (Some(a), Some(b)) => Cubic::new(*a, *b).inverse(p),
            (Some(end), None) | (None, Some(end)) => end.y,
            (None, None) => f64::NAN,
        }
    }

    /// The probability below a place; that of the first or last node beyond them.
    pub(super) fn below(&self, y: f64) -> f64 {
        match self.around(y) {
            (Some(a), Some(b)) => Cubic::new(a, b).at((y - a.y) / (b.y - a.y)),
            (Some(end), None) | (None, Some(end)) => end.below,
            (None, None) => f64::NAN,
        }
    }

    /// The density at a place.
    pub(super) fn density(&self, y: f64) -> f64 {
        match self.around(y) {
            (Some(a), Some(b)) => Cubic::new(a, b).slope((y - a.y) / (b.y - a.y)),
            (Some(end), None) | (None, Some(end)) => end.density,
            (None, None) => f64::NAN,
        }
    }

    /// The nodes before and after a place.
    fn around(&self, y: f64) -> (Option<Node>, Option<Node>) {
        let after = self.0.partition_point(|node| node.y < y);
        let before = after.checked_sub(1).and_then(|before| self.0.get(before));
        (before.copied(), self.0.get(after).copied())
    }

    /// The least fraction that the shortest interval can leave below it, for a coverage p, and the greatest.
    fn room(&self, p: f64) -> [f64; 2] {
        let (first, last) = (
            self.0.first().map_or(0.0, |n| n.below),
            self.0.last().map_or(1.0, |n| n.below),
        );
        [first.max(0.0), (last.min(1.0) - p).max(first.max(0.0))]
    }

    fn interval(&self, below: f64, p: f64) -> [f64; 2] {
        [self.quantile(below), self.quantile(below + p)]
    }

    /// The fraction below the shortest interval that covers p (JCGM 101, 5.3.4).
    pub(super) fn shortest(&self, p: f64) -> f64 {
        /// Intervals that are compared before the best is refined.
        const LOOK: usize = 24;
        let [least, most] = self.room(p);
        let at = |i: usize| least + (most - least) * i as f64 / LOOK as f64;
        let width = |i: usize| {
            let [low, high] = self.interval(at(i), p);
            high - low
        };
        let widths: Vec<f64> = (0..=LOOK).map(width).collect();
        let best = (0..=LOOK)
            .min_by(|a, b| widths[*a].total_cmp(&widths[*b]))
            .unwrap_or(0);
        self.refined([at(best.saturating_sub(1)), at((best + 1).min(LOOK))], p)
    }

    /// The same near a fraction that is known to be near the best one.
    pub(super) fn shortest_near(&self, below: f64, p: f64) -> f64 {
        let [least, most] = self.room(p);
        let reach = (most - least) / 4.0;
        self.refined([(below - reach).max(least), (below + reach).min(most)], p)
    }

    /// Where the densities at both ends are equal, or the end of the range that is nearer to it: the width
    /// grows with the fraction below by 1/f(high) − 1/f(low). By the rule of false position, halving the value of an
    /// end that stays (Illinois).
    fn refined(&self, [mut least, mut most]: [f64; 2], p: f64) -> f64 {
        let enough = 1e-5 * (most - least);
        let excess = |below: f64| {
            let [low, high] = self.interval(below, p);
            self.density(high) - self.density(low)
        };
        let (mut at_least, mut at_most) = (excess(least), excess(most));
        if at_least <= 0.0 {
            return least;
        }
        if at_most >= 0.0 {
            return most;
        }
        let (mut middle, mut rose) = (least, None);
        for _ in 0..40 {
            let before = middle;
            middle = (least * at_most - most * at_least) / (at_most - at_least);
            if (middle - before).abs() < enough {
                break;
            }
            let at_middle = excess(middle);
            let rises = at_middle > 0.0;
            if rises {
                (least, at_least) = (middle, at_middle);
            } else {
                (most, at_most) = (middle, at_middle);
            }
            if rose == Some(rises) {
                let stays = if rises { &mut at_most } else { &mut at_least };
                *stays *= 0.5;
            }
            rose = Some(rises);
        }
        middle
    }

    /// The interval that leaves this fraction below it.
    pub(super) fn covering(&self, below: f64, p: f64) -> [f64; 2] {
        self.interval(below, p)
    }
}

/// The cubic between two nodes; its argument runs from 0 to 1.
struct Cubic {
    start: f64,
    width: f64,
    coefficients: [f64; 4],
}

impl Cubic {
    fn new(a: Node, b: Node) -> Cubic {
        let width = b.y - a.y;
        let rise = b.below - a.below;
        // A cubic rises throughout where neither slope exceeds three times the mean one.
        let limit = 3.0 * rise;
        let (d0, d1) = (
            (a.density * width).min(limit),
            (b.density * width).min(limit),
        );
        Cubic {
            start: a.y,
            width,
            coefficients: [
                a.below,
                d0,
                3.0 * rise - 2.0 * d0 - d1,
                d0 + d1 - 2.0 * rise,
            ],
        }
    }

    fn at(&self, t: f64) -> f64 {
        let [c0, c1, c2, c3] = self.coefficients;
        c0 + t * (c1 + t * (c2 + t * c3))
    }

    fn slope(&self, t: f64) -> f64 {
        let [_, c1, c2, c3] = self.coefficients;
        (c1 + t * (2.0 * c2 + t * 3.0 * c3)) / self.width
    }

    /// Where it is p, by Newton's method kept within a shrinking bracket.
    fn inverse(&self, p: f64) -> f64 {
        let [c0, c1, c2, c3] = self.coefficients;
        let rise = c1 + c2 + c3;
        let (mut least, mut most) = (0.0, 1.0);
        let mut t = if rise > 0.0 { (p - c0) / rise } else { 0.5 };
        for _ in 0..40 {
            let excess = self.at(t) - p;
            if excess > 0.0 {
                most = t
            } else {
                least = t
            }
            let step = excess / (self.slope(t) * self.width);
            if step.abs() < 1e-12 || most - least < 1e-14 {
                break;
            }
            let next = t - step;
            t = if next > least && next < most {
                next
            } else {
                0.5 * (least + most)
            };
        }
        self.start + t * self.width
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_core::special::{normal_cdf, normal_pdf, normal_quantile};

    fn tails(places: &[f64], below: impl Fn(f64) -> f64, density: impl Fn(f64) -> f64) -> Tails {
        let node = |y: &f64| Node {
            y: *y,
            below: below(*y),
            density: density(*y),
        };
        Tails(places.iter().map(node).collect())
    }

    #[test]
    fn normal_quantiles_and_interval() {
        let places: Vec<f64> = (-20..=20).map(|i| f64::from(i) * 0.2).collect();
        let normal = tails(&places, normal_cdf, normal_pdf);
        for p in [0.001, 0.025, 0.3, 0.975] {
            assert!(
                (normal.quantile(p) - normal_quantile(p)).abs() < 1e-4,
                "{p}"
            );
        }
        assert!((normal.shortest(0.95) - 0.025).abs() < 1e-4);
        assert!((normal.shortest_near(0.03, 0.95) - 0.025).abs() < 1e-4);
    }

    /// An exponential distribution has its shortest interval at the origin.
    #[test]
    fn one_sided_interval() {
        let places: Vec<f64> = (0..=60).map(|i| f64::from(i) * 0.1).collect();
        let exponential = tails(&places, |y| 1.0 - (-y).exp(), |y| (-y).exp());
        let below = exponential.shortest(0.95);
        let [low, high] = exponential.covering(below, 0.95);
        assert!(
            low < 1e-4 && (high - 20.0_f64.ln()).abs() < 1e-3,
            "{low} {high}"
        );
    }

    #[test]
    fn beyond_the_nodes_it_stays() {
        let normal = tails(&[-1.0, 0.0, 1.0], normal_cdf, normal_pdf);
        assert_eq!((normal.quantile(0.0), normal.quantile(1.0)), (-1.0, 1.0));
        assert!(Tails(Vec::new()).quantile(0.5).is_nan());
    }
}
