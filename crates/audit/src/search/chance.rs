//! How many combinations would match by accident: those near the claimed figures that do not match them say how dense the
//! grammar is there.
//!
//! A claim has two figures that are independent of one another: u_c, and the ratio of U to it. A combination may match
//! either by what it does, or by accident.

use crate::calculate::Case;

use super::check::Checked;

/// Combinations near the claim.
#[derive(Debug, Clone, Copy, Default)]
pub struct Chance {
    expected: f64,
}

/// How far about a figure the density of combinations is counted, as a ratio on either side: it should hold many and be
/// the density at the figure. Twice or half as much changes what is expected little.
const NEAR: f64 = 0.2;

/// Whether a figure is met, or only near, and then the share of the neighbourhood that its digits cover.
enum Nearness {
    Met,
    Near(f64),
    Far,
}

impl Nearness {
    fn of(value: f64, claimed: f64, relative_half: f64) -> Nearness {
        let distance = (value / claimed - 1.0).abs();
        let within = relative_half.max(1e-9);
        match distance {
            distance if distance <= within => Nearness::Met,
            distance if distance <= NEAR => Nearness::Near((within / NEAR).min(1.0)),
            _ => Nearness::Far,
        }
    }
}

impl Chance {
    /// Counts a combination by the probability that it would match by accident, if it meets ν_eff and k.
    pub fn count(&mut self, case: &Case<'_>, checked: &Checked) {
        let footer = &case.claimed.footer;
        if !(checked.nu_eff && checked.k) {
            return;
        }
        let figures = checked.figures;
        let nearness = match (&footer.u_c, &footer.expanded) {
            (Some(u_c), Some(expanded)) => [
                Nearness::of(figures.u_c, u_c.value, u_c.relative_half()),
                Nearness::of(
                    figures.expanded / figures.u_c,
                    expanded.value / u_c.value,
                    u_c.relative_half() + expanded.relative_half(),
                ),
            ],
            (Some(one), None) => [
                Nearness::of(figures.u_c, one.value, one.relative_half()),
                Nearness::Met,
            ],
            (None, Some(one)) => [
                Nearness::of(figures.expanded, one.value, one.relative_half()),
                Nearness::Met,
            ],
            (None, None) => return,
        };
        self.expected += match nearness {
            [Nearness::Met, Nearness::Met] | [Nearness::Far, _] | [_, Nearness::Far] => 0.0,
            [Nearness::Near(a), Nearness::Near(b)] => a * b,
            [Nearness::Near(share), Nearness::Met] | [Nearness::Met, Nearness::Near(share)] => {
                share
            }
        };
    }

    /// Combinations that are expected to match by accident.
    pub fn expected(&self) -> f64 {
        self.expected
    }
}
