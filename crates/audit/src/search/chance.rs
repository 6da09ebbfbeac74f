//! How likely a match is an accident.
//!
//! A claim has two figures that are independent of one another: u_c, and the ratio of U to it. One that does not follow
//! from what is stated may, for all that is known, be any number nearby. Every combination of slips that was open
//! covers the width of its rounding there; the share of the neighbourhood that all of them cover together is the
//! probability that a number which has nothing to do with slips is matched all the same.

use crate::calculate::{Calculation, Case, Figures, Printout};
use crate::claim::RoundingStated;
use crate::printed::Printed;

use super::check::Checked;
use super::met::unexchanged;

/// How far about a figure its neighbourhood reaches at most, in logarithms on either side: a figure that has nothing to
/// do with slips is known to a factor of two, as what it should be is known.
pub const WIDEST: f64 = std::f64::consts::LN_2;

/// Where combinations are many, they are counted no farther than this many of them reach: their density at the figure is
/// what matters, and so many give it to a fifth.
const NEAREST: usize = 30;

/// What one combination gives, as the logarithm of its ratio to the claim, and what the rounding of the claim leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    fn about(value: f64, claimed: f64, below: f64, above: f64) -> Interval {
        let at = libm::log(value / claimed);
        Interval {
            low: at - below.max(1e-9),
            high: at + above.max(1e-9),
        }
    }

    fn is_met(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }

    /// How far its middle is from the figure.
    fn distance(self) -> f64 {
        (0.5 * (self.low + self.high)).abs()
    }

    /// The share of a neighbourhood that it covers.
    fn share(self, near: f64) -> f64 {
        (self.high.min(near) - self.low.max(-near)).max(0.0) / (2.0 * near)
    }
}

/// How far the nearest reach, and not less than the widths of a few of them.
fn reach(mut distances: Vec<f64>, width: f64) -> f64 {
    distances.sort_by(f64::total_cmp);
    let nearest = distances.get(NEAREST - 1).copied().unwrap_or(WIDEST);
    nearest.max(10.0 * width).min(WIDEST)
}

/// The share of the neighbourhood that intervals cover together.
fn covered(mut intervals: Vec<Interval>) -> f64 {
    let Some(width) = intervals.first().map(|one| one.high - one.low) else {
        return 0.0;
    };
    let near = reach(intervals.iter().map(|one| one.distance()).collect(), width);
    intervals.retain(|interval| interval.share(near) > 0.0);
    intervals.sort_by(|a, b| a.low.total_cmp(&b.low));
    let (mut share, mut reached) = (0.0, -near);
    for Interval { low, high } in intervals {
        let part = Interval {
            low: low.max(reached),
            high,
        };
        share += part.share(near);
        reached = high.max(reached);
    }
    share
}

/// Combinations about the claim: what they give for u_c, and for the ratio of U to it.
#[derive(Debug, Clone, Default)]
pub struct Chance {
    points: Vec<[Option<Interval>; 2]>,
    /// Which of the two follows without a further slip.
    follows: [bool; 2],
}

impl Chance {
    /// Notes a combination; `further` says whether it has slips that the rows do not show.
    pub fn count(&mut self, case: &Case<'_>, made: &Calculation, checked: &Checked, further: bool) {
        // A claim may follow from unrounded contributions or from the printed ones: both were open.
        for figures in [Some(checked.figures), checked.of_printed]
            .into_iter()
            .flatten()
        {
            self.add(case, made, figures, checked.nu_eff && checked.k, further);
        }
    }

    fn add(
        &mut self,
        case: &Case<'_>,
        made: &Calculation,
        figures: Figures,
        met: bool,
        further: bool,
    ) {
        let footer = &case.claimed.footer;
        // A figure whose digits were exchanged is matched by what it was before.
        let before = |figure: &Option<Printed>, which: Printout| {
            figure
                .as_ref()
                .map(|figure| unexchanged(figure, made, which))
        };
        let whole = before(&footer.u_c, Printout::Combined);
        let expanded = before(&footer.expanded, Printout::Expanded);
        let u_c = whole.as_ref().map(|claimed| {
            let half = claimed.half_of_digits() / claimed.value;
            Interval::about(figures.u_c, claimed.value, half, half)
        });
        let ratio = expanded.as_ref().map(|expanded| {
            // Where no u_c is claimed, U is all there is.
            let whole = whole.as_ref();
            let (value, claimed) = match whole {
                Some(u_c) => (figures.expanded / figures.u_c, expanded.value / u_c.value),
                None => (figures.expanded, expanded.value),
            };
            let of_u_c = whole.map_or(0.0, Printed::relative_half);
            let half = expanded.half_of_expanded() / expanded.value;
            let up = match case.claimed.rounding {
                RoundingStated::Nearest => half,
                RoundingStated::Up | RoundingStated::Unstated => 2.0 * half,
            };
            Interval::about(value, claimed, half + of_u_c, up + of_u_c)
        });
        let point = [u_c, ratio];
        if further {
            if met {
                self.points.push(point);
            }
            return;
        }
        for (follows, interval) in self.follows.iter_mut().zip(point) {
            *follows |= interval.is_none_or(Interval::is_met);
        }
    }

    /// Whether u_c follows without a further slip, and U does not.
    pub fn is_behind(&self) -> bool {
        self.follows == [true, false]
    }

    /// The probability that a claim which has nothing to do with slips would be matched.
    pub fn accident(&self) -> f64 {
        let met = |interval: Option<Interval>| interval.is_none_or(Interval::is_met);
        let along = |which: usize| {
            let others_met = self.points.iter().filter(|point| met(point[1 - which]));
            covered(others_met.filter_map(|point| point[which]).collect())
        };
        match self.follows {
            [true, true] => 0.0,
            [false, true] => along(0),
            [true, false] => along(1),
            [false, false] => {
                let mut different = self.points.clone();
                let low =
                    |point: &[Option<Interval>; 2]| point.map(|one| one.map_or(0.0, |one| one.low));
                different.sort_by(|a, b| {
                    low(a)[0]
                        .total_cmp(&low(b)[0])
                        .then(low(a)[1].total_cmp(&low(b)[1]))
                });
                different.dedup();
                let farthest = |point: &[Option<Interval>; 2]| {
                    point
                        .iter()
                        .flatten()
                        .map(|one| one.distance())
                        .fold(0.0, f64::max)
                };
                let width = different.first().map_or(0.0, |point| {
                    let widths = point.iter().flatten().map(|one| one.high - one.low);
                    widths.fold(0.0, f64::max)
                });
                let near = reach(different.iter().map(farthest).collect(), width);
                let share = |point: &[Option<Interval>; 2]| {
                    point
                        .iter()
                        .flatten()
                        .map(|one| one.share(near))
                        .product::<f64>()
                };
                -libm::expm1(-different.iter().map(share).sum::<f64>())
            }
        }
    }
}

/// The probability that a figure of a row which has nothing to do with slips would be matched by one of those that give
/// `values`.
pub fn of_row(figure: &Printed, values: impl Iterator<Item = f64>) -> f64 {
    let half = figure.half_of_digits() / figure.value;
    let interval = |value: f64| Interval::about(value, figure.value, half, half);
    covered(values.filter(|value| *value > 0.0).map(interval).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_covered_twice_counts_once() {
        let interval = |low, high| Interval { low, high };
        let share = covered(vec![
            interval(0.0, 0.05),
            interval(0.03, 0.08),
            interval(-0.9, WIDEST - 1.0),
            interval(0.8, 0.9),
        ]);
        assert!((share - (0.08 + 2.0 * WIDEST - 1.0) / (2.0 * WIDEST)).abs() < 1e-12);
        // A thousand about the figure: their density there, and not that of the whole neighbourhood.
        let many = (0..1000).map(|i| f64::from(i - 500) * 2e-4);
        let dense = covered(many.map(|x| interval(x - 1e-5, x + 1e-5)).collect());
        assert!((dense - 0.1).abs() < 0.01, "{dense}");
        assert_eq!(covered(Vec::new()), 0.0);
    }
}
