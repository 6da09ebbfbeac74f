//! A calculation held against the claimed figures of the whole.

use crate::calculate::{Calculation, Case, Combined, Figures, Freedom, Printout};
use crate::claim::RoundingStated;
use crate::printed::Printed;
use crate::slips::{Act, Change};

use super::row::Broken;

/// Which claimed figures a calculation gives; true where none is claimed.
#[derive(Debug, Clone, Copy)]
pub struct Checked {
    /// Combined standard uncertainty.
    pub u_c: bool,
    /// Effective degrees of freedom.
    pub nu_eff: bool,
    /// Coverage factor.
    pub k: bool,
    /// Expanded uncertainty.
    pub expanded: bool,
    /// What the calculation gives without rounding.
    pub figures: Figures,
}

/// Where a claim departs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gap {
    /// In a row.
    Row(usize, Broken),
    /// Between the rows and u_c.
    Sum,
    /// At ν_eff.
    Freedom,
    /// At k.
    Factor,
    /// Between u_c, k and U.
    Expanded,
}

impl Checked {
    /// Whether every claimed figure is met.
    pub fn meets_all(&self) -> bool {
        self.u_c && self.nu_eff && self.k && self.expanded
    }

    /// Where it departs.
    pub fn gaps(&self) -> Vec<Gap> {
        let all = [
            (self.u_c, Gap::Sum),
            (self.nu_eff, Gap::Freedom),
            (self.k, Gap::Factor),
            (self.expanded, Gap::Expanded),
        ];
        all.into_iter()
            .filter(|(met, _)| !met)
            .map(|(_, gap)| gap)
            .collect()
    }
}

impl Act {
    /// Whether what the row prints as its contribution is not what enters the sum.
    pub fn changes_contribution(&self) -> bool {
        matches!(self.change, Change::U(_) | Change::Scaled(_) | Change::C(_))
    }
}

/// Holds a calculation against the claim. `printed` are the contributions that the rows print.
pub fn check(case: &Case<'_>, calculation: &Calculation, printed: &[Option<f64>]) -> Checked {
    let cmc = case.claimed.cmc.as_ref().map(|cmc| cmc.value);
    let exact = calculation.figures(&[], cmc);
    let any_printed =
        printed.iter().any(Option::is_some) && calculation.combined != Combined::Rounded;
    let of = if any_printed {
        vec![exact, calculation.figures(printed, cmc)]
    } else {
        vec![exact]
    };
    let footer = &case.claimed.footer;
    let claimed_u = footer
        .u_c
        .as_ref()
        .map(|figure| unexchanged(figure, calculation, Printout::Combined));
    let u_c = claimed_u
        .as_ref()
        .is_none_or(|figure| of.iter().any(|f| figure.is_met_by(f.u_c)));
    let nu_eff = footer
        .nu_eff
        .as_ref()
        .is_none_or(|figure| of.iter().any(|f| freedom(figure, f.nu_eff, calculation)));
    let mut factors: Vec<f64> = of.iter().map(|f| f.k).collect();
    let claimed_k = footer.k.as_ref();
    if let Some(nu) = footer.nu_eff.as_ref().filter(|_| nu_eff) {
        let looked_up = Calculation {
            freedom: Freedom::Given(nu.value),
            lines: Vec::new(),
            correlations: Vec::new(),
            ..calculation.clone()
        };
        if matches!(calculation.factor, crate::calculate::Factor::StudentT(_)) {
            factors.push(looked_up.figures(&[], None).k);
        }
    }
    let k = claimed_k.is_none_or(|figure| factors.iter().any(|k| factor(figure, *k)));
    let expanded = footer.expanded.as_ref().is_none_or(|figure| {
        let figure = unexchanged(figure, calculation, Printout::Expanded);
        let mut us: Vec<f64> = of.iter().map(|f| f.u_c).collect();
        us.extend(
            claimed_u
                .as_ref()
                .filter(|_| u_c)
                .map(|figure| figure.value),
        );
        us.extend(
            footer
                .u_c
                .as_ref()
                .filter(|_| u_c)
                .map(|figure| figure.value),
        );
        let mut ks = factors.clone();
        ks.extend(factors.iter().map(|k| libm::round(100.0 * k) / 100.0));
        ks.extend(claimed_k.filter(|_| k).map(|k| k.value));
        let report = calculation.report;
        let floor = cmc.filter(|_| report.cmc).unwrap_or(0.0);
        let product =
            |k: f64, u: f64| (libm::pow(k, f64::from(report.power)) * u * report.scale).max(floor);
        let rounded = |x: f64| is_rounded(&figure, x, case.claimed.rounding, report.down);
        let long = (3..=8).contains(&figure.digits);
        long == report.long
            && ks
                .iter()
                .any(|k| us.iter().any(|u| rounded(product(*k, *u))))
    });
    Checked {
        u_c,
        nu_eff,
        k,
        expanded,
        figures: exact,
    }
}

/// The figure as it was before two of its digits were exchanged.
fn unexchanged(figure: &Printed, calculation: &Calculation, which: Printout) -> Printed {
    match calculation.report.exchanged {
        Some((place, pair)) if place == which => {
            let own = Printed::parse(&figure.text).map_or(figure.value, |p| p.value.abs());
            let scale = if own == 0.0 { 1.0 } else { figure.value / own };
            let found = crate::slips::exchanged_digits(&figure.text)
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
fn freedom(figure: &Printed, nu: f64, calculation: &Calculation) -> bool {
    const MANY: f64 = 100.0;
    if nu.is_infinite() || figure.value.is_infinite() {
        // From a thousand on k has the two decimals of the normal distribution.
        return nu >= 10.0 * MANY && figure.value >= 10.0 * MANY;
    }
    let whole = figure.half >= 0.5;
    let cut = match calculation.freedom {
        Freedom::Up => libm::ceil(nu),
        _ => libm::floor(nu * (1.0 + 1e-9)),
    };
    let near =
        nu >= MANY && calculation.freedom != Freedom::Up && (nu - figure.value).abs() <= 0.01 * nu;
    near || if whole {
        figure.value == cut
    } else {
        figure.is_met_by(nu) && calculation.freedom != Freedom::Up || figure.value == cut
    }
}

/// Whether a factor is printed like this. A whole number has been rounded to two decimals before.
fn factor(figure: &Printed, k: f64) -> bool {
    let half = if figure.half >= 0.5 {
        0.005
    } else {
        figure.half
    };
    figure.is_met_within(k, half)
}

/// Whether `x` is rounded to the figure by the rule of the sheet.
fn is_rounded(figure: &Printed, x: f64, rule: RoundingStated, down: bool) -> bool {
    // Two digits of a whole number may have zeros behind them: 2300.
    let places = libm::floor(libm::log10(figure.value.max(1.0))) - 1.0;
    let zeros = figure.half >= 0.5 && figure.digits <= 2 && places > 0.0;
    let half = if zeros {
        0.5 * libm::exp10(places)
    } else {
        figure.half
    };
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
