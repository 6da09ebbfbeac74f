//! A calculation held against the claimed figures of the whole.

use crate::calculate::{Calculation, Case, Combined, Factor, Figures, Freedom, Printout, t};
use crate::claim::{RoundingStated, Stated};
use crate::printed::Printed;
use crate::slips::{Act, Change};

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
    /// What it gives from the contributions as they are printed, where they are.
    pub of_printed: Option<Figures>,
    /// By how much u_c may differ because the sheet computed with more digits than it states.
    pub open: f64,
}

/// A figure of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Broken {
    /// Standard uncertainty.
    U,
    /// Sensitivity coefficient.
    C,
    /// Contribution.
    Contribution,
    /// Degrees of freedom.
    Dof,
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
    pub(super) fn meets_all(&self) -> bool {
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
    pub(super) fn changes_contribution(&self) -> bool {
        matches!(self.change, Change::U(_) | Change::Scaled(_) | Change::C(_))
    }

    /// Whether it leaves u_c as it is.
    pub(super) fn acts_behind_sum(&self) -> bool {
        matches!(
            self.change,
            Change::Factor(_) | Change::Freedom(_) | Change::Report(_)
        )
    }

    /// Whether a printed figure shows it by itself.
    pub fn is_read(&self) -> bool {
        use crate::slips::Reporting;
        matches!(self.change, Change::Report(Reporting::Long))
    }

    /// Whether it changes what is stated, and no uncertainty: the result itself, the unit of U, or its rounding.
    pub(super) fn changes_statement(&self) -> bool {
        use crate::slips::Reporting;
        matches!(
            self.change,
            Change::Result(_) | Change::Report(Reporting::Scale(1.0) | Reporting::Down)
        )
    }
}

/// Holds a calculation against the claim. `printed` are the contributions that the rows print.
pub fn check(case: &Case<'_>, calculation: &Calculation, printed: &[Option<f64>]) -> Checked {
    let cmc = case.claimed.cmc.as_ref().map(|cmc| cmc.value);
    let exact = calculation.figures(&[], cmc);
    let any_printed = printed.iter().any(Option::is_some)
        && !matches!(calculation.combined, Combined::Rounded(_));
    let mut of = vec![exact];
    if any_printed {
        of.push(calculation.figures(printed, cmc));
    }
    let mut rows = case.claimed.rows.iter();
    if (!any_printed || rows.all(|row| row.contribution.is_none()))
        && let Some(coefficients) = with_claimed_coefficients(case, calculation)
    {
        of.push(coefficients.figures(&[], cmc));
    }
    let footer = &case.claimed.footer;
    let claimed_u = footer
        .u_c
        .as_ref()
        .map(|figure| unexchanged(figure, calculation, Printout::Combined));
    // Coefficients that no model gives are known as they are shown.
    let shown = |row: &crate::claim::Row| row.c.as_ref().map_or(0.0, Printed::coarseness);
    let coarse = match case.derivatives {
        Some(_) => 0.0,
        None => case.claimed.rows.iter().map(shown).fold(0.0, f64::max),
    };
    let open = left_open(case, calculation, exact.u_c);
    let u_c = claimed_u.as_ref().is_none_or(|figure| {
        let half = figure.half_of_digits() + coarse * figure.value + open;
        of.iter().any(|f| figure.is_met_within(f.u_c, half))
    });
    let rooted = Calculation {
        combined: Combined::Root,
        ..calculation.clone()
    };
    // Where u_c is the sum of squares, or made of rounded contributions, ν_eff may have been found from what was there
    // before.
    let is_after = matches!(
        calculation.combined,
        Combined::Squares | Combined::Rounded(_)
    );
    let before = is_after.then(|| rooted.figures(&[], cmc));
    let nu_eff = footer.nu_eff.as_ref().is_none_or(|figure| {
        let mut all = of.iter().chain(&before);
        // Where it was found from u_c as it is printed, that enters with its fourth power.
        let of_printed_u = |f: &Figures| {
            let ratio = claimed_u.as_ref().filter(|_| u_c).map(|u| u.value / f.u_c);
            ratio.map(|ratio| f.nu_eff * libm::pow(ratio, 4.0))
        };
        all.any(|f| {
            let found = [Some(f.nu_eff), of_printed_u(f)];
            let mut found = found.into_iter().flatten();
            let coarse = coarse.max(open / exact.u_c);
            found.any(|nu| freedom(figure, nu, calculation, coarse))
        })
    });
    let mut factors: Vec<f64> = of.iter().chain(&before).map(|f| f.k).collect();
    let claimed_k = footer.k.as_ref();
    if let Some(nu) = footer.nu_eff.as_ref().filter(|_| nu_eff) {
        let looked_up = Calculation {
            freedom: Freedom::Given(nu.value),
            lines: Vec::new(),
            correlations: Vec::new(),
            ..calculation.clone()
        };
        if let Factor::StudentT(p) = calculation.factor {
            factors.push(looked_up.figures(&[], None).k);
            factors.push(t(p, nu.value));
        }
    }
    let is_fixed = matches!(calculation.factor, Factor::Fixed(_));
    let k = claimed_k.is_none_or(|figure| factors.iter().any(|k| factor(figure, *k, is_fixed)));
    let expanded = footer.expanded.as_ref().is_none_or(|figure| {
        let figure = unexchanged(figure, calculation, Printout::Expanded);
        // U is made of the u_c that is claimed, where one is.
        let fits = |f: &&Figures| {
            let near = |figure: &Printed| {
                figure.is_met_within(
                    f.u_c,
                    figure.half_of_digits() + coarse * figure.value + open,
                )
            };
            claimed_u.as_ref().is_none_or(|figure| !u_c || near(figure))
        };
        let mut us: Vec<f64> = of.iter().filter(fits).map(|f| f.u_c).collect();
        if claimed_u.is_none() && open > 0.0 {
            us.extend([exact.u_c - open, exact.u_c + open]);
        }
        // Of what is rounded up, the rounded u_c is no part.
        let again = u_c && case.claimed.rounding != RoundingStated::Up;
        let printed = [claimed_u.as_ref(), footer.u_c.as_ref()];
        us.extend(
            printed
                .into_iter()
                .flatten()
                .filter(|_| again)
                .map(|figure| figure.value),
        );
        let mut ks = factors.clone();
        ks.extend(factors.iter().map(|k| libm::round(100.0 * k) / 100.0));
        ks.extend(claimed_k.filter(|_| k).map(|k| k.value));
        let report = calculation.report;
        let floor = cmc.filter(|_| report.cmc).unwrap_or(0.0);
        let product = |k: f64, u: f64| (report.multiple(k) * u).max(floor) * report.scale;
        // Who prints too many digits has not rounded to two by the rule.
        let rule = if report.long {
            RoundingStated::Unstated
        } else {
            case.claimed.rounding
        };
        let rounded = |x: f64| is_rounded(&figure, x, rule, report.down);
        let long = figure.is_long();
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
        of_printed: of.get(1).copied(),
        open: open + coarse * exact.u_c,
    }
}

/// The calculation with the coefficients that the laboratory states, where it has used derivatives that it rounded: rule 6
/// leaves a percent.
fn with_claimed_coefficients(case: &Case<'_>, calculation: &Calculation) -> Option<Calculation> {
    let mut own = calculation.clone();
    for (line, row) in own.lines.iter_mut().zip(&case.claimed.rows) {
        let claimed = row.c.as_ref().map(|c| c.value.abs());
        if let Some(c) = claimed.filter(|c| (c - line.c.abs()).abs() <= 0.01 * line.c.abs()) {
            line.c = c.copysign(line.c);
        }
    }
    (own != *calculation).then_some(own)
}

/// The figures of a calculation as they are reported: k has two decimals, or those of the claimed one, where that is met.
pub fn reported(case: &Case<'_>, calculation: &Calculation, printed: &[Option<f64>]) -> Figures {
    let checked = check(case, calculation, printed);
    let exact = checked.figures;
    let claimed = case.claimed.footer.k.as_ref().filter(|_| checked.k);
    let k = claimed.map_or_else(|| libm::round(100.0 * exact.k) / 100.0, |k| k.value);
    let ratio = calculation.report.multiple(k) / calculation.report.multiple(exact.k);
    let floor = case.claimed.cmc.as_ref().filter(|_| calculation.report.cmc);
    let floor = floor.map_or(0.0, |cmc| cmc.value) * calculation.report.scale;
    Figures {
        k,
        expanded: if exact.expanded > floor {
            (exact.expanded * ratio).max(floor)
        } else {
            exact.expanded
        },
        ..exact
    }
}

/// Whether U, or u_c where no U is claimed, would be printed as it is claimed: rounded as the laboratory rounded what it
/// `made`, to nearest or up, whichever of them its own figure shows. u_c is `open` by so much.
pub fn is_printed(case: &Case<'_>, right: &Figures, made: &Figures, open: f64) -> bool {
    let footer = &case.claimed.footer;
    let Some(expanded) = &footer.expanded else {
        let met = |u_c: &Printed| u_c.is_met_within(right.u_c, u_c.half_of_digits() + open);
        return footer.u_c.as_ref().is_none_or(met);
    };
    let half = expanded.half_that_decides();
    let open = open * right.expanded / right.u_c;
    let tolerance = 1e-6 * (half + expanded.value.abs());
    let nearest = |x: f64, open: f64| expanded.is_met_within(x, half + open);
    let up = |x: f64, open: f64| {
        let above = expanded.value - x;
        above >= -open - tolerance && above < 2.0 * half + open + tolerance
    };
    match (nearest(made.expanded, 0.0), up(made.expanded, 0.0)) {
        (true, false) => nearest(right.expanded, open),
        (false, true) => up(right.expanded, open),
        _ => nearest(right.expanded, open) || up(right.expanded, open),
    }
}

/// By how much u_c may differ because rows state no more than a standard uncertainty or a contribution, as it is printed:
/// the sheet went on with more digits.
fn left_open(case: &Case<'_>, calculation: &Calculation, u_c: f64) -> f64 {
    if case.claimed.computed {
        return 0.0;
    }
    let rows = case.claimed.rows.iter().zip(&calculation.lines);
    let open = rows.filter(|(_, line)| line.counted).map(|(row, line)| {
        let of_u = row.u.as_ref().filter(|own| match &row.stated {
            Stated::Standard { u, .. } => row.used.is_none() && own.at == u.at,
            _ => false,
        });
        let is_only = of_u.is_some() || row.stated == Stated::Nothing;
        let printed = [of_u, row.contribution.as_ref().filter(|_| is_only)];
        let widths = printed.into_iter().flatten();
        let widths = widths.map(|figure| figure.half_of_digits() / figure.value.abs());
        let widths: Vec<f64> = widths.collect();
        // Of two figures the one with more digits leaves less open; they may lie apart by what the other leaves.
        let relative = widths.iter().copied().reduce(f64::min).unwrap_or(0.0);
        let contribution = line.contribution();
        let made = row.contribution.as_ref().filter(|_| is_only);
        let apart = made.map_or(0.0, |made| ((made.value / contribution).abs() - 1.0).abs());
        let apart = Some(apart).filter(|apart| *apart <= widths.iter().sum());
        let relative = relative.max(apart.unwrap_or(0.0));
        if relative.is_finite() {
            contribution * contribution * relative
        } else {
            0.0
        }
    });
    let square: f64 = open.sum();
    if u_c > 0.0 { square / u_c } else { 0.0 }
}

/// The figure as it was before two of its digits were exchanged.
pub fn unexchanged(figure: &Printed, calculation: &Calculation, which: Printout) -> Printed {
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
fn freedom(figure: &Printed, nu: f64, calculation: &Calculation, coarse: f64) -> bool {
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
        || if whole {
            figure.value == cut
        } else {
            figure.is_met_by(nu) && calculation.freedom != Freedom::Up || figure.value == cut
        }
}

/// Whether a factor is printed like this. One with two decimals or less has been rounded to two, whatever zeros its cell
/// adds, and a rule for a fixed one states it with no more.
fn factor(figure: &Printed, k: f64, is_fixed: bool) -> bool {
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
