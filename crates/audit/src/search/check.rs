//! A calculation held against the claimed figures of the whole.

use std::iter;

use crate::calculate::{Calculation, Case, Combined, Factor, Figures, Freedom, Printout, t};
use crate::claim::{RoundingStated, Stated};
use crate::printed::Printed;
use crate::slips::{Act, Change};

use super::met::{factor, freedom, is_rounded, unexchanged};

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

    /// Whether it changes how k is found, and nothing else.
    pub(super) fn changes_factor(&self) -> bool {
        matches!(self.change, Change::Factor(_) | Change::Freedom(_))
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
    Held::new(case, calculation, printed).checked()
}

/// A calculation beside a claim.
struct Held<'a> {
    case: &'a Case<'a>,
    calculation: &'a Calculation,
    /// What it gives without rounding.
    exact: Figures,
    /// What it gives from the contributions as they are printed, where they are.
    of_printed: Option<Figures>,
    /// What it gives with the coefficients that the laboratory rounded.
    of_coefficients: Option<Figures>,
    /// What it gives with the divisors that the laboratory rounded, `1.73` for √3.
    of_divisors: Option<Figures>,
    /// What it gives as the root of a sum of squares, where u_c is the sum itself, made of rounded contributions, or an old number: ν_eff
    /// may have been found from what was there before.
    of_root: Option<Figures>,
    /// u_c as it is claimed.
    u_c: Option<Printed>,
    /// By how much, relatively, u_c may differ because the coefficients are known as they are shown.
    coarse: f64,
    /// By how much, relatively, the contribution of a row that has few degrees of freedom may, at most.
    coarse_of_few: f64,
    /// By how much u_c may differ because the sheet computed with more digits than it states.
    open: f64,
}

impl<'a> Held<'a> {
    fn new(case: &'a Case<'_>, calculation: &'a Calculation, printed: &[Option<f64>]) -> Self {
        let cmc = case.claimed.cmc.as_ref().map(|cmc| cmc.value);
        let exact = calculation.figures(&[], cmc);
        let any_printed = printed.iter().any(Option::is_some)
            && !matches!(calculation.combined, Combined::Rounded(_));
        let mut rows = case.claimed.rows.iter();
        let is_bare = !any_printed || rows.all(|row| row.contribution.is_none());
        let own = || with_claimed_coefficients(case, calculation);
        let coefficients = is_bare.then(own).flatten();
        let rooted = || Calculation {
            combined: Combined::Root,
            ..calculation.clone()
        };
        let is_after = matches!(
            calculation.combined,
            Combined::Squares | Combined::Rounded(_) | Combined::Typed(_)
        );
        let u_c = case.claimed.footer.u_c.as_ref();
        Held {
            case,
            calculation,
            exact,
            of_printed: any_printed.then(|| calculation.figures(printed, cmc)),
            of_coefficients: coefficients.map(|own| own.figures(&[], cmc)),
            of_divisors: with_claimed_divisors(case, calculation).map(|own| own.figures(&[], cmc)),
            of_root: is_after.then(|| rooted().figures(&[], cmc)),
            u_c: u_c.map(|figure| unexchanged(figure, calculation, Printout::Combined)),
            coarse: coarseness(case, calculation),
            coarse_of_few: coarseness_of_few(case, calculation),
            open: left_open(case, calculation, exact.u_c),
        }
    }

    fn checked(&self) -> Checked {
        let u_c = self.meets_u_c();
        let nu_eff = self.meets_freedom(u_c);
        let factors = self.factors(nu_eff);
        let k = self.meets_factor(&factors);
        Checked {
            u_c,
            nu_eff,
            k,
            expanded: self.meets_expanded(u_c, &factors, k),
            figures: self.exact,
            of_printed: self.of_printed.or(self.of_coefficients),
            open: self.open + self.coarse * self.exact.u_c,
        }
    }

    /// Everything that the calculation gives.
    fn all(&self) -> impl Iterator<Item = &Figures> {
        let others = [&self.of_printed, &self.of_coefficients, &self.of_divisors];
        iter::once(&self.exact).chain(others.into_iter().flatten())
    }

    fn is_near_u_c(&self, figure: &Printed, u_c: f64) -> bool {
        let half = figure.half_of_digits() + self.coarse * figure.value + self.open;
        figure.is_met_within(u_c, half)
    }

    fn meets_u_c(&self) -> bool {
        let is_met = |figure: &Printed| self.all().any(|f| self.is_near_u_c(figure, f.u_c));
        self.u_c.as_ref().is_none_or(is_met)
    }

    fn meets_freedom(&self, meets_u_c: bool) -> bool {
        let of_coefficients = self.coarse + self.coarse_of_few;
        let coarse = of_coefficients.max(self.open / self.exact.u_c);
        // Where it was found from u_c as it is printed, that enters with its fourth power.
        let of_printed_u = |f: &Figures| {
            let ratio = self.u_c.as_ref().filter(|_| meets_u_c);
            ratio.map(|u| f.nu_eff * libm::pow(u.value / f.u_c, 4.0))
        };
        let is_met = |figure: &Printed| {
            let found = self.all().chain(&self.of_root);
            let mut found = found
                .flat_map(|f| [Some(f.nu_eff), of_printed_u(f)])
                .flatten();
            found.any(|nu| freedom(figure, nu, self.calculation, coarse))
        };
        self.case.claimed.footer.nu_eff.as_ref().is_none_or(is_met)
    }

    /// The coverage factors that belong to it; of the claimed ν_eff, too, where that is met.
    fn factors(&self, meets_freedom: bool) -> Vec<f64> {
        let mut factors: Vec<f64> = self.all().chain(&self.of_root).map(|f| f.k).collect();
        let claimed = self.case.claimed.footer.nu_eff.as_ref();
        if let Some(nu) = claimed.filter(|_| meets_freedom)
            && let Factor::StudentT(p) = self.calculation.factor
        {
            let looked_up = Calculation {
                freedom: Freedom::Given(nu.value),
                lines: Vec::new(),
                correlations: Vec::new(),
                ..self.calculation.clone()
            };
            factors.push(looked_up.figures(&[], None).k);
            factors.push(t(p, nu.value));
        }
        factors
    }

    fn meets_factor(&self, factors: &[f64]) -> bool {
        let is_fixed = matches!(self.calculation.factor, Factor::Fixed(_));
        let is_met = |figure: &Printed| factors.iter().any(|k| factor(figure, *k, is_fixed));
        self.case.claimed.footer.k.as_ref().is_none_or(is_met)
    }

    fn meets_expanded(&self, meets_u_c: bool, factors: &[f64], meets_factor: bool) -> bool {
        let Some(figure) = &self.case.claimed.footer.expanded else {
            return true;
        };
        let figure = unexchanged(figure, self.calculation, Printout::Expanded);
        let claimed_k = self.case.claimed.footer.k.as_ref();
        let mut ks = factors.to_vec();
        ks.extend(factors.iter().map(|k| libm::round(100.0 * k) / 100.0));
        ks.extend(claimed_k.filter(|_| meets_factor).map(|k| k.value));
        let us = self.u_of_expanded(meets_u_c);
        let report = self.calculation.report;
        let cmc = self.case.claimed.cmc.as_ref().filter(|_| report.cmc);
        let floor = cmc.map_or(0.0, |cmc| cmc.value);
        let product = |k: f64, u: f64| (report.multiple(k) * u).max(floor) * report.scale;
        // Who prints too many digits has not rounded to two by the rule.
        let rule = if report.long {
            RoundingStated::Unstated
        } else {
            self.case.claimed.rounding
        };
        let is_rounded = |x: f64| is_rounded(&figure, x, rule, report.down);
        let is_of = |k: &f64| us.iter().any(|u| is_rounded(product(*k, *u)));
        figure.is_long() == report.long && ks.iter().any(is_of)
    }

    /// The standard uncertainties of which U may be made: of the u_c that is claimed, where one is.
    fn u_of_expanded(&self, meets_u_c: bool) -> Vec<f64> {
        let fits = |f: &&Figures| {
            let claimed = self.u_c.as_ref().filter(|_| meets_u_c);
            claimed.is_none_or(|figure| self.is_near_u_c(figure, f.u_c))
        };
        let mut us: Vec<f64> = self.all().filter(fits).map(|f| f.u_c).collect();
        if self.open > 0.0 {
            let ends = [-self.open, self.open].map(|open| self.exact.u_c + open);
            let claimed = self.u_c.as_ref().filter(|_| meets_u_c);
            // What is claimed as u_c narrows it, as far as its own digits go.
            us.extend(ends.map(|u| match claimed {
                Some(figure) => {
                    let half = figure.half_of_digits();
                    u.max(figure.value - half).min(figure.value + half)
                }
                None => u,
            }));
        }
        // Of what is rounded up, the rounded u_c is no part.
        if meets_u_c && self.case.claimed.rounding != RoundingStated::Up {
            let printed = [self.u_c.as_ref(), self.case.claimed.footer.u_c.as_ref()];
            us.extend(printed.into_iter().flatten().map(|figure| figure.value));
        }
        us
    }
}

/// What the coefficients leave open of each row, as a ratio: those that no model gives are known as they are shown.
fn shown<'a>(case: &'a Case<'_>) -> impl Iterator<Item = f64> + 'a {
    let rows = case.claimed.rows.iter();
    rows.map(|row| match (&case.derivatives, &row.c) {
        (None, Some(c)) => c.coarseness(),
        _ => 0.0,
    })
}

/// What the coefficients leave open of u_c, as a ratio: of each as much as its contribution is a part of it. With correlations
/// the parts may be larger than the whole, and the most that is open of any coefficient stands for all. So it does for what is
/// right: a claim is not doubted for a last digit, but a slip is only named that gives the figures.
fn coarseness(case: &Case<'_>, calculation: &Calculation) -> f64 {
    let right = &case.right;
    let is_right = calculation.lines == right.lines && calculation.combined == right.combined;
    if is_right || !calculation.correlations.is_empty() {
        return shown(case).fold(0.0, f64::max);
    }
    let power = match calculation.combined {
        Combined::Linear => 1.0,
        _ => 2.0,
    };
    let (mut whole, mut open) = (0.0, 0.0);
    let lines = calculation.lines.iter().zip(shown(case));
    for (line, shown) in lines.filter(|(line, _)| line.counted) {
        let part = libm::pow(line.contribution().abs(), power);
        whole += part;
        open += shown * part;
    }
    // A sum of squares without its root moves twice as much.
    let times = match calculation.combined {
        Combined::Squares => 2.0,
        _ => 1.0,
    };
    if whole > 0.0 {
        times * open / whole
    } else {
        0.0
    }
}

/// The most that a coefficient leaves open of a row with degrees of freedom that count in ν_eff.
fn coarseness_of_few(case: &Case<'_>, calculation: &Calculation) -> f64 {
    let all = calculation.lines.iter().zip(shown(case));
    let few = all.filter(|(line, _)| line.counted && line.dof.is_finite());
    few.map(|(_, open)| open).fold(0.0, f64::max)
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

/// The calculation with the divisors that the laboratory states, where they are those of the shapes, rounded.
fn with_claimed_divisors(case: &Case<'_>, calculation: &Calculation) -> Option<Calculation> {
    let mut own = calculation.clone();
    for (line, row) in own.lines.iter_mut().zip(&case.claimed.rows) {
        let Stated::Limits { shape, .. } = &row.stated else {
            continue;
        };
        let exact = shape.divisor();
        let is_rounded = |claimed: &&Printed| claimed.value != exact && claimed.is_met_by(exact);
        if let Some(claimed) = row.divisor.as_ref().filter(is_rounded) {
            line.u *= exact / claimed.value;
        }
    }
    (own != *calculation).then_some(own)
}

/// The figures of a calculation as they are reported: k has two decimals, or those of the claimed one, where that is met.
pub fn reported(case: &Case<'_>, calculation: &Calculation, printed: &[Option<f64>]) -> Figures {
    let checked = check(case, calculation, printed);
    let exact = checked.figures;
    let claimed = case.claimed.footer.k.as_ref().filter(|_| checked.k);
    let usual = claimed.map_or_else(|| libm::round(100.0 * exact.k) / 100.0, |k| k.value);
    let ratio = |k: f64| calculation.report.multiple(k) / calculation.report.multiple(exact.k);
    // U may have been made of a k with all its digits: 2.576 of the one that is printed as 2.58.
    let is_made = |k: &f64| {
        let expanded = case.claimed.footer.expanded.as_ref();
        expanded.is_none_or(|figure| figure.is_met_by(exact.expanded * ratio(*k)))
    };
    let k = [usual, exact.k].into_iter().find(is_made).unwrap_or(usual);
    let floor = case.claimed.cmc.as_ref().filter(|_| calculation.report.cmc);
    let floor = floor.map_or(0.0, |cmc| cmc.value) * calculation.report.scale;
    Figures {
        k,
        expanded: if exact.expanded > floor {
            (exact.expanded * ratio(k)).max(floor)
        } else {
            exact.expanded
        },
        ..exact
    }
}

/// Whether U, or u_c where no U is claimed, would be printed as it is claimed: rounded by the rule of the sheet, else as the
/// laboratory rounded what it `made`, to nearest or up, whichever of them its own figure shows. u_c is `open` by so much.
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
    match case.claimed.rounding {
        RoundingStated::Nearest => return nearest(right.expanded, open),
        RoundingStated::Up => return up(right.expanded, open),
        RoundingStated::Unstated => {}
    }
    match (nearest(made.expanded, 0.0), up(made.expanded, 0.0)) {
        (true, false) => nearest(right.expanded, open),
        (false, true) => up(right.expanded, open),
        _ => nearest(right.expanded, open) || up(right.expanded, open),
    }
}

/// By how much u_c may differ because rows state no more than a standard uncertainty or a contribution, as it is printed, and
/// correlations no more than a rounded r: the sheet went on with more digits.
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
    let of_r = calculation.correlations.iter().map(|pair| {
        let [a, b] = [pair.a, pair.b].map(|row| calculation.lines[row]);
        match a.counted && b.counted {
            true => pair.open * (a.contribution() * b.contribution()).abs(),
            false => 0.0,
        }
    });
    // Half of what the sum of squares is open by.
    let square: f64 = open.sum::<f64>() + of_r.sum::<f64>();
    match calculation.combined {
        Combined::Squares => 2.0 * square,
        _ if u_c > 0.0 => square / u_c,
        _ => 0.0,
    }
}
