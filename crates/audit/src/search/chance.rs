//! How many combinations would match by accident: those near the claimed figure that do not match it say how dense the
//! grammar is there.

use crate::calculate::Case;

use super::check::Checked;

/// Combinations near the claim.
#[derive(Debug, Clone, Copy, Default)]
pub struct Chance {
    near: usize,
    /// Share of the neighbourhood that the printed digits cover.
    covered: f64,
}

/// What counts as near, on either side, as a ratio: wide enough for many combinations, narrow enough that their density
/// is that at the claim.
const NEAR: f64 = 0.2;

impl Chance {
    /// Counts a combination if it is near, and meets what else is claimed.
    pub fn count(&mut self, case: &Case<'_>, checked: &Checked) {
        let footer = &case.claimed.footer;
        let (figure, value) = match (&footer.u_c, &footer.expanded) {
            (Some(u_c), Some(expanded)) if expanded.relative_half() < 0.5 * u_c.relative_half() => {
                (expanded, checked.figures.expanded)
            }
            (Some(u_c), _) => (u_c, checked.figures.u_c),
            (None, Some(expanded)) => (expanded, checked.figures.expanded),
            (None, None) => return,
        };
        let distance = (value / figure.value - 1.0).abs();
        let within = figure.relative_half().max(1e-9);
        self.covered = (within / NEAR).min(1.0);
        let others = checked.nu_eff && checked.k;
        if distance <= NEAR && distance > within && others {
            self.near += 1;
        }
    }

    /// Combinations that are expected to match by accident.
    pub fn expected(&self) -> f64 {
        self.near as f64 * self.covered
    }
}
