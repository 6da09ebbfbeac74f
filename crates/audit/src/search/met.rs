//! Whether a printed figure is met.

use crate::calculate::{Calculation, Factor, Freedom, Printout, t};
use crate::claim::RoundingStated;
use crate::printed::Printed;
use crate::slips::exchanged_digits;

/// The figure as it was before two of its digits were exchanged.
pub fn unexchanged(figure: &Printed, calculation: &Calculation, which: Printout) -> Printed {
    match calculation.report.exchanged {
        Some((place, pair)) if place == which => {
            let own = Printed::parse(&figure.text).map_or(figure.value, |p| p.value.abs());
            let scale = if own == 0.0 { 1.0 } else { figure.value / own };
            let found = exchanged_digits(&figure.text)
                .into_iter()
                .find(|(p, _)| *p == pair);
            Printed {
                value: found.map_or(figure.value, |(_, x)| x * scale),
                ..figure.clone()
            }
        }
        _ => figure.clone(),
    }
}

/// Whether ν_eff, cut to a whole number or printed with decimals, is what is claimed. Beyond a hundred the fourth
/// powers of rounded contributions decide nothing.
pub(super) fn freedom(figure: &Printed, nu: f64, calculation: &Calculation, coarse: f64) -> bool {
    const MANY: f64 = 100.0;
    if nu.is_infinite() || figure.value.is_infinite() {
        // From a thousand on k has the two decimals of the normal distribution.
        return nu >= 10.0 * MANY && figure.value >= 10.0 * MANY;
    }
    let whole = figure.half >= 0.5;
    let cut = match calculation.freedom {
        Freedom::Up => libm::ceil(nu),
        _ => libm::floor(nu * (1.0 + 1e-9)).max(1.0),
    };
    // Coefficients are known as they are shown, and enter with their fourth powers.
    let same = (nu - figure.value).abs() <= 4.0 * coarse * nu;
    let raised = whole && !same && figure.value == libm::ceil(nu);
    let near = nu >= MANY
        && !raised
        && calculation.freedom != Freedom::Up
        && (nu - figure.value).abs() <= 0.01 * nu;
    // A figure that is rounded to the nearest, where k is the same for either, is shown and not used.
    let k = |nu: f64| match calculation.factor {
        Factor::StudentT(p) => libm::round(100.0 * t(p, nu)),
        _ => 0.0,
    };
    let unused = whole && (nu - figure.value).abs() <= 0.5 && k(figure.value) == k(cut);
    near || same
        || unused
        || is_of_table(figure, nu)
        || if whole {
            figure.value == cut
        } else {
            figure.is_met_by(nu) && calculation.freedom != Freedom::Up || figure.value == cut
        }
}

/// Whether degrees of freedom are those of the next lower row of the table of t, where k was looked up (JCGM 100, G.4.1 and
/// table G.2).
fn is_of_table(figure: &Printed, nu: f64) -> bool {
    const OF_GUIDE: &[f64] = &[20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 100.0];
    const OF_BOOKS: &[f64] = &[30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 120.0, 200.0];
    [OF_GUIDE, OF_BOOKS].iter().any(|rows| {
        let below = rows.iter().rev().find(|row| **row <= nu);
        below == Some(&figure.value)
    })
}

/// Whether a factor is printed like this. One with two decimals or less has been rounded to two, whatever zeros its cell
/// adds, and a rule for a fixed one states it with no more.
pub(super) fn factor(figure: &Printed, k: f64, is_fixed: bool) -> bool {
    /// Half a unit of the second decimal.
    const TWO_DECIMALS: f64 = 0.005;
    let hundredths = 100.0 * figure.value;
    let is_short = (hundredths - libm::round(hundredths)).abs() < 1e-9;
    let half = match figure.half >= 0.5 {
        true => TWO_DECIMALS,
        false if is_fixed || is_short => figure.half.max(TWO_DECIMALS),
        false => figure.half,
    };
    figure.is_met_within(k, half)
}

/// Whether `x` is rounded to the figure by the rule of the sheet.
pub(super) fn is_rounded(figure: &Printed, x: f64, rule: RoundingStated, down: bool) -> bool {
    let half = figure.half_of_expanded();
    let tolerance = 1e-6 * half + 1e-9 * x.abs();
    let above = figure.value - x;
    let nearest = above.abs() <= half + tolerance;
    let up = above >= -tolerance && above < 2.0 * half + tolerance;
    let cut = above < -tolerance && above > -2.0 * half - tolerance;
    match (down, rule) {
        (false, RoundingStated::Up) => up,
        (false, RoundingStated::Nearest) => nearest,
        (false, RoundingStated::Unstated) => nearest || up,
        (true, RoundingStated::Up) => cut,
        (true, _) => cut && !nearest,
    }
}
