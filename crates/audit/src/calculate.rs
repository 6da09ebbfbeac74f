//! The calculation that a sheet states: from the lowest level of every row to U.

use std::cell::RefCell;
use std::collections::HashMap;

use gumption_core::model::{MeasurandSource, Model, Request, Role, Symbol, compile};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_core::special::{normal_two_sided_quantile, student_t_two_sided_quantile};

use crate::claim::{Claimed, Correlation, Coverage, Relative, Row, Shape, Stated};
use crate::units;

/// What is known, computed once.
#[derive(Debug, Clone)]
pub struct Case<'a> {
    /// The claim.
    pub claimed: &'a Claimed,
    /// The right calculation.
    pub right: Calculation,
    /// Derivatives of the model by the rows, where there is a model that is understood.
    pub derivatives: Option<Vec<f64>>,
    /// Rows whose derivative depends on estimates that the sheet does not state.
    pub unknown_slopes: Vec<bool>,
    /// The value of the model at the estimates.
    pub y: Option<f64>,
    /// How the estimates enter the model, text by text: why it was not understood.
    pub trouble: Option<String>,
}

/// A calculation of U, right or with slips in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Calculation {
    /// The rows.
    pub lines: Vec<Line>,
    /// Correlations that are taken into account.
    pub correlations: Vec<Correlation>,
    /// How contributions are combined.
    pub combined: Combined,
    /// How ν_eff is found.
    pub freedom: Freedom,
    /// How k is found.
    pub factor: Factor,
    /// How U is made of k and u_c, and reported.
    pub report: Report,
}

/// One row of a calculation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Standard uncertainty.
    pub u: f64,
    /// Sensitivity coefficient.
    pub c: f64,
    /// What c·u is multiplied by to be in the unit of the result.
    pub to_y: f64,
    /// Degrees of freedom.
    pub dof: f64,
    /// Whether it enters the sum.
    pub counted: bool,
    /// A contribution that was typed in, instead of c·u.
    pub typed: Option<f64>,
}

/// How contributions are combined.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Combined {
    /// Root of the sum of squares and products.
    #[default]
    Root,
    /// Sum.
    Linear,
    /// Sum of squares.
    Squares,
    /// As `Root`, of contributions rounded to one digit.
    Rounded,
    /// As `Root`, the signs lost in the products.
    Unsigned,
    /// A number that was typed in.
    Typed(f64),
}

/// How ν_eff is found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Freedom {
    /// Welch–Satterthwaite, cut to a whole number.
    #[default]
    Welch,
    /// The same, rounded up.
    Up,
    /// Something else.
    Given(f64),
}

/// How k is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Factor {
    /// A number.
    Fixed(f64),
    /// t at ν_eff.
    StudentT(f64),
    /// t at other degrees of freedom: probability, ν.
    At(f64, f64),
    /// 1.65 where one rectangle dominates, else 2.
    Rectangle,
}

/// How U is made of k and u_c, and reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// Power of k in U.
    pub power: i32,
    /// A factor of units that does not belong there.
    pub scale: f64,
    /// Whether the CMC is heeded.
    pub cmc: bool,
    /// Whether U may be rounded down against the rule.
    pub down: bool,
    /// Whether U may have more digits than two.
    pub long: bool,
    /// Digits exchanged: in u_c, in U (which pair, from the front), or none.
    pub exchanged: Option<(Printout, usize)>,
}

/// A final figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Printout {
    /// u_c.
    Combined,
    /// U.
    Expanded,
}

impl Default for Report {
    fn default() -> Self {
        Report {
            power: 1,
            scale: 1.0,
            cmc: true,
            down: false,
            long: false,
            exchanged: None,
        }
    }
}

/// Figures of the whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// Combined standard uncertainty.
    pub u_c: f64,
    /// Effective degrees of freedom, not cut.
    pub nu_eff: f64,
    /// Coverage factor, not rounded.
    pub k: f64,
    /// Expanded uncertainty, before rounding.
    pub expanded: f64,
}

impl Line {
    /// Contribution, with its sign.
    pub fn contribution(&self) -> f64 {
        self.typed.unwrap_or(self.c * self.u * self.to_y)
    }
}

impl Calculation {
    /// The figures, with these contributions in the place of the computed ones where there are some.
    pub fn figures(&self, printed: &[Option<f64>], cmc: Option<f64>) -> Figures {
        let contribution = |i: usize| -> f64 {
            let line = &self.lines[i];
            if !line.counted {
                return 0.0;
            }
            let computed = line.contribution();
            let one_digit = |x: f64| {
                use gumption_core::quantity::{Decimal, Rounding};
                Decimal::from_f64(x)
                    .round_to_significant(1, Rounding::HalfUp)
                    .to_f64()
            };
            let x = printed
                .get(i)
                .copied()
                .flatten()
                .map_or(computed, |p| p.abs().copysign(computed));
            if self.combined == Combined::Rounded {
                one_digit(x)
            } else {
                x
            }
        };
        let parts: Vec<f64> = (0..self.lines.len()).map(contribution).collect();
        let u_c = self.combine(&parts);
        let nu_eff = match self.freedom {
            Freedom::Given(nu) => nu,
            _ => welch(
                u_c,
                parts
                    .iter()
                    .zip(&self.lines)
                    .map(|(part, line)| (*part, line.dof)),
            ),
        };
        let k = self.factor.value(self.whole(nu_eff), &parts, u_c);
        let expanded = libm::pow(k, f64::from(self.report.power)) * u_c;
        let floor = cmc.filter(|_| self.report.cmc).unwrap_or(0.0);
        Figures {
            u_c,
            nu_eff,
            k,
            expanded: expanded.max(floor) * self.report.scale,
        }
    }

    /// ν_eff as k is looked up.
    pub fn whole(&self, nu_eff: f64) -> f64 {
        match self.freedom {
            // What is printed as a whole number within a few units of the last digits of doubles is that number.
            Freedom::Welch | Freedom::Given(_) => libm::floor(nu_eff * (1.0 + 1e-9)).max(1.0),
            Freedom::Up => libm::ceil(nu_eff),
        }
    }

    fn combine(&self, parts: &[f64]) -> f64 {
        if let Combined::Typed(u_c) = self.combined {
            return u_c;
        }
        if self.combined == Combined::Linear {
            return parts.iter().map(|x| x.abs()).sum();
        }
        let mut sum: f64 = parts.iter().map(|x| x * x).sum();
        for Correlation { a, b, r } in &self.correlations {
            let product = parts[*a] * parts[*b];
            sum += 2.0
                * r
                * if self.combined == Combined::Unsigned {
                    product.abs()
                } else {
                    product
                };
        }
        let sum = sum.max(0.0);
        if self.combined == Combined::Squares {
            sum
        } else {
            libm::sqrt(sum)
        }
    }
}

/// Effective degrees of freedom (JCGM 100, G.4.1).
pub fn welch(u_c: f64, parts: impl Iterator<Item = (f64, f64)>) -> f64 {
    let sum: f64 = parts
        .filter(|(_, dof)| dof.is_finite() && *dof > 0.0)
        .map(|(part, dof)| libm::pow(part, 4.0) / dof)
        .sum();
    if sum > 0.0 {
        libm::pow(u_c, 4.0) / sum
    } else {
        f64::INFINITY
    }
}

impl Factor {
    fn value(self, nu: f64, parts: &[f64], u_c: f64) -> f64 {
        match self {
            Factor::Fixed(k) => k,
            Factor::StudentT(p) => t(p, nu),
            Factor::At(p, nu) => t(p, nu),
            Factor::Rectangle => {
                let largest = parts.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
                if dominates(largest, u_c) { 1.65 } else { 2.0 }
            }
        }
    }
}

/// Whether the rest is at most 0.3 of the largest contribution (EA-4/02 M:2022, S9.14).
pub fn dominates(largest: f64, u_c: f64) -> bool {
    let rest = libm::sqrt((u_c * u_c - largest * largest).max(0.0));
    rest <= 0.3 * largest
}

/// The factor of a two-sided interval.
pub fn t(p: f64, nu: f64) -> f64 {
    // A search looks the same few factors up thousands of times.
    thread_local!(static KNOWN: RefCell<HashMap<(u64, u64), f64>> = RefCell::default());
    let quantile = || {
        if nu.is_finite() {
            student_t_two_sided_quantile(p, nu.max(1.0))
        } else {
            normal_two_sided_quantile(p)
        }
    };
    KNOWN.with_borrow_mut(|known| {
        *known
            .entry((p.to_bits(), nu.to_bits()))
            .or_insert_with(quantile)
    })
}

/// C(n) of the range method for n = 2 … 9 and the degrees of freedom (JJF 1059.1-2012, table 1).
pub const RANGE: [(f64, f64); 8] = [
    (1.13, 0.9),
    (1.69, 1.8),
    (2.06, 2.7),
    (2.33, 3.6),
    (2.53, 4.5),
    (2.70, 5.3),
    (2.85, 6.0),
    (2.97, 6.8),
];

/// C(n) and ν of the range method; those of 9 beyond the table.
pub fn range_factor(n: f64) -> (f64, f64) {
    let place = (n as usize).clamp(2, 9) - 2;
    RANGE[place]
}

impl Stated {
    /// Standard uncertainty and degrees of freedom, in the unit of what is stated.
    pub fn standard(&self) -> Option<(f64, f64)> {
        let b = |u: f64| Some((u, f64::INFINITY));
        match self {
            Stated::Nothing => None,
            Stated::Certificate { expanded, k, .. } => b(expanded.value / k),
            Stated::Limits {
                half_width, shape, ..
            } => b(half_width.value / shape.divisor()),
            Stated::FullWidth { width, shape } => b(width.value / 2.0 / shape.divisor()),
            Stated::Step { step } => b(step.value / libm::sqrt(12.0)),
            Stated::Unequal { plus, minus } => b((plus.value + minus.value) / libm::sqrt(12.0)),
            Stated::Deviation { s, n, m, pooled } => {
                let dof = pooled.or(n.map(|n| n - 1.0)).unwrap_or(f64::INFINITY);
                Some((s.value / libm::sqrt(*m), dof))
            }
            Stated::Range { range, n, m } => {
                let (c, dof) = range_factor(*n);
                Some((range.value / c / libm::sqrt(*m), dof))
            }
            Stated::Standard { u, dof } => Some((u.value, dof.unwrap_or(f64::INFINITY))),
        }
    }

    /// Whether it is evaluated from readings.
    pub fn is_type_a(&self) -> bool {
        matches!(self, Stated::Deviation { .. } | Stated::Range { .. })
    }
}

impl Row {
    /// What a stated relative figure is multiplied by.
    pub fn relative_factor(&self) -> f64 {
        match (self.relative, &self.value) {
            (Relative::OfValue(fraction), Some(value)) => fraction * value.value.abs(),
            (Relative::OfFullScale(fraction, scale), _) => fraction * scale,
            _ => 1.0,
        }
    }
}

impl<'a> Case<'a> {
    /// The right calculation of what is claimed.
    pub fn of(claimed: &'a Claimed) -> Case<'a> {
        let mut unknown_slopes = vec![false; claimed.rows.len()];
        let (derivatives, y, trouble) = match differentiate(claimed) {
            Ok(Some(known)) => {
                unknown_slopes = known.unknown;
                (Some(known.slopes), known.y, None)
            }
            Ok(None) => (None, None, None),
            Err(trouble) => (None, None, Some(trouble)),
        };
        let lines = claimed
            .rows
            .iter()
            .enumerate()
            .map(|(i, row)| line(claimed, row, derivatives.as_ref().map(|d| d[i])));
        let right = Calculation {
            lines: lines.collect(),
            correlations: claimed.correlations.clone(),
            combined: Combined::Root,
            freedom: Freedom::Welch,
            factor: factors(claimed)[0],
            report: Report::default(),
        };
        Case {
            claimed,
            right,
            derivatives,
            unknown_slopes,
            y,
            trouble,
        }
    }
}

/// The rules for k that the sheet allows; the first is the usual one.
pub fn factors(claimed: &Claimed) -> Vec<Factor> {
    match claimed.coverage {
        Coverage::Fixed(k) => vec![Factor::Fixed(k)],
        Coverage::StudentT(p) => vec![Factor::StudentT(p)],
        Coverage::Rectangle => vec![Factor::Rectangle],
        Coverage::Unstated => {
            let mut rules = vec![
                Factor::Fixed(2.0),
                Factor::StudentT(0.95),
                Factor::StudentT(0.9545),
            ];
            let usual = claimed
                .footer
                .k
                .as_ref()
                .map(|k| k.value)
                .filter(|k| [1.96, 3.0, 2.58, 1.65].contains(k));
            if let Some(k) = usual {
                rules.insert(0, Factor::Fixed(k));
            }
            rules
        }
    }
}

fn line(claimed: &Claimed, row: &Row, derivative: Option<f64>) -> Line {
    let (u, stated_dof) = row.stated.standard().unwrap_or((0.0, f64::INFINITY));
    let mut u = u * row.relative_factor();
    if u == 0.0
        && let Some(step) = silent_step(row)
    {
        u = step / libm::sqrt(12.0);
    }
    if row.stated == Stated::Nothing {
        // Only the contribution is stated.
        u = row.contribution.as_ref().map_or(0.0, |p| p.value.abs());
    }
    let to_y = to_y(claimed, row, derivative.is_some());
    let mut c = derivative
        .or(row.c.as_ref().map(|c| c.value))
        .unwrap_or(1.0);
    let mut rest = to_y;
    // A sheet may have its coefficients for contributions in another unit than the result, and say it or not.
    if let (Some(derivative), Some(claimed_c)) = (derivative, &row.c)
        && (to_y - 1.0).abs() > 1e-12
        && far(claimed_c.value, derivative * to_y) < far(claimed_c.value, derivative)
    {
        c = derivative * to_y;
        rest = 1.0;
    }
    let given = row
        .dof
        .as_ref()
        .map(|dof| dof.value)
        .filter(|dof| *dof > 0.0);
    let open = !row.stated.is_type_a()
        || matches!(
            row.stated,
            Stated::Deviation {
                n: None,
                pooled: None,
                ..
            }
        );
    let dof = if open {
        given.unwrap_or(stated_dof)
    } else {
        stated_dof
    };
    Line {
        u,
        c,
        to_y: rest,
        dof,
        counted: row.not_counted.is_none(),
        typed: None,
    }
}

/// The step of an indication whose readings are all equal.
fn silent_step(row: &Row) -> Option<f64> {
    let is_zero = matches!(&row.stated, Stated::Deviation { s, .. } if s.value == 0.0);
    let keys = ["step", "resolution", "分辨力", "步进", "分度值"];
    is_zero.then(|| crate::read::figure_after(&row.words, &keys).map(|step| step.value))?
}

/// From the unit of c·u to that of the result, where units are written that say so.
fn to_y(claimed: &Claimed, row: &Row, from_model: bool) -> f64 {
    let y_unit = claimed.unit.as_str();
    if from_model {
        // The derivative is in the units of the estimates.
        let of = |from: &str, to: &str| {
            if from.is_empty() || to.is_empty() {
                1.0
            } else {
                units::factor(from, to).unwrap_or(1.0)
            }
        };
        let value = row.value.as_ref().map_or("", |v| v.unit.as_str());
        let bare_c = row
            .c
            .as_ref()
            .is_none_or(|c| units::parse(&c.unit).is_none());
        // A zero without a unit, among estimates in the unit of the result.
        if value.is_empty()
            && bare_c
            && let Some(factor) = units::factor(&row.unit, y_unit)
        {
            return factor;
        }
        return of(&row.unit, value) * of(unit_of_y(claimed), y_unit);
    }
    if row.unit.is_empty() || y_unit.is_empty() {
        return 1.0;
    }
    let c_unit = row.c.as_ref().map_or("", |c| c.unit.as_str());
    let product = if c_unit.is_empty() || c_unit == "1" {
        None
    } else {
        units::parse(c_unit).zip(units::parse(&row.unit))
    };
    match product {
        Some((c, u)) => {
            let target = units::parse(y_unit);
            let conversion = target.and_then(|target| {
                c.product(&u.difference())
                    .conversion_to(&target.difference())
            });
            conversion.map_or(1.0, |conversion| {
                conversion.apply(1.0) - conversion.apply(0.0)
            })
        }
        None => units::factor(&row.unit, y_unit).unwrap_or(1.0),
    }
}

/// The unit of the result itself, which its uncertainty need not be in.
fn unit_of_y(claimed: &Claimed) -> &str {
    let own = claimed.footer.y.as_ref().map_or("", |y| y.unit.as_str());
    if own.is_empty() { &claimed.unit } else { own }
}

/// What a model gives at the estimates.
struct Differentiated {
    slopes: Vec<f64>,
    /// Which slopes depend on estimates that are not stated; the claimed coefficients stand in their places.
    unknown: Vec<bool>,
    y: Option<f64>,
}

/// Value and derivatives of the model at the estimates. `None` without a model.
fn differentiate(claimed: &Claimed) -> Result<Option<Differentiated>, String> {
    let Some(text) = &claimed.model else {
        return Ok(None);
    };
    let rows = &claimed.rows;
    let used: Vec<bool> = rows
        .iter()
        .map(|row| crate::read::has_symbol(text, &row.symbol))
        .collect();
    // Several rows of one symbol are reasons to doubt one input.
    let first = |i: usize| {
        (0..i)
            .find(|j| rows[*j].symbol == rows[i].symbol)
            .unwrap_or(i)
    };
    let missing = |i: usize| used[i] && rows[first(i)].value.is_none();
    let any_missing = (0..rows.len()).any(missing);
    let at = |unknown: f64| -> Vec<f64> {
        let value = |(i, row): (usize, &Row)| match &row.value {
            Some(value) => value.value,
            None => unknown * (1.0 + 0.37 * i as f64),
        };
        rows.iter().enumerate().map(value).collect()
    };
    let values = at(1.0);
    if !used.iter().any(|used| *used) {
        return Ok(None);
    }
    let formula = renamed(text, claimed);
    let unit_of = |row: &Row| row.value.as_ref().and_then(|v| units::parse(&v.unit));
    let with_units = !unit_of_y(claimed).is_empty()
        && rows
            .iter()
            .zip(&used)
            .all(|(row, used)| !used || unit_of(row).is_some());
    let units: Vec<Unit> = rows
        .iter()
        .map(|row| {
            unit_of(row)
                .filter(|_| with_units)
                .unwrap_or_else(Unit::one)
        })
        .collect();
    let target = units::parse(unit_of_y(claimed))
        .filter(|_| with_units)
        .unwrap_or_else(Unit::one);
    let plain = vec![Unit::one(); units.len()];
    let bare = |formula: &str| compiled(formula, &plain, Unit::one(), &used);
    let mut model = compiled(&formula, &units, target, &used).or_else(|_| bare(&formula))?;
    // Without units, an angle may be in degrees: the claimed coefficients and y tell.
    if !with_units && let Ok(degrees) = bare(&in_degrees(&formula)) {
        let fit = |model: &Model| agreement(claimed, &values, &used, model);
        if fit(&degrees) > fit(&model) {
            model = degrees;
        }
    }
    let slopes = model.gradients(&values);
    // A slope that is the same wherever the unknown estimates are does not need them.
    let elsewhere = model.gradients(&at(2.9));
    let moves = |i: usize| {
        any_missing && (slopes[(0, i)] - elsewhere[(0, i)]).abs() > 1e-9 * slopes[(0, i)].abs()
    };
    let unknown: Vec<bool> = (0..rows.len())
        .map(|i| used[i] && moves(first(i)))
        .collect();
    let derivative = |i: usize| {
        if used[i] && !unknown[i] {
            slopes[(0, first(i))]
        } else {
            rows[i].c.as_ref().map_or(1.0, |c| c.value)
        }
    };
    if (0..rows.len()).all(|i| !used[i] || unknown[i]) {
        return Err("the model names inputs whose estimates the sheet does not state".into());
    }
    Ok(Some(Differentiated {
        slopes: (0..rows.len()).map(derivative).collect(),
        y: (!any_missing).then(|| model.values(&values)[0]),
        unknown,
    }))
}

/// How many of the claimed coefficients, and of y, a model gives to a percent.
fn agreement(claimed: &Claimed, values: &[f64], used: &[bool], model: &Model) -> usize {
    let close = |a: f64, b: f64| (a.abs() - b.abs()).abs() <= 0.01 * b.abs();
    let slopes = model.gradients(values);
    let rows = claimed.rows.iter().enumerate().filter(|(i, _)| used[*i]);
    let coefficients = rows
        .filter(|(i, row)| {
            row.c
                .as_ref()
                .is_some_and(|c| close(c.value, slopes[(0, *i)]))
        })
        .count();
    let y = claimed.footer.y.as_ref();
    coefficients + usize::from(y.is_some_and(|y| close(y.value, model.values(values)[0])))
}

/// The formula with the arguments of its circular functions in degrees.
fn in_degrees(formula: &str) -> String {
    let mut out = String::new();
    let mut rest = formula;
    while let Some((at, name)) = ["sin(", "cos(", "tan("]
        .iter()
        .filter_map(|name| Some((rest.find(name)?, *name)))
        .min()
    {
        let inner = &rest[at + name.len()..];
        let mut depth = 1;
        let end = inner.char_indices().find_map(|(i, c)| {
            depth += match c {
                '(' => 1,
                ')' => -1,
                _ => 0,
            };
            (depth == 0).then_some(i)
        });
        let Some(end) = end else { break };
        out.push_str(&rest[..at]);
        out.push_str(&format!("{name}(pi/180)*({}))", in_degrees(&inner[..end])));
        rest = &inner[end + 1..];
    }
    out + rest
}

fn compiled(formula: &str, units: &[Unit], target: Unit, used: &[bool]) -> Result<Model, String> {
    let symbols: Vec<Symbol> = units
        .iter()
        .enumerate()
        .filter(|(i, _)| used[*i])
        .map(|(i, unit)| Symbol {
            name: format!("x_{i}_"),
            unit: unit.clone(),
            role: Role::Input(i),
        })
        .collect();
    let measurand = MeasurandSource {
        name: "y__",
        model: Some(formula),
        unit: Some(target),
    };
    let table = UnitTable::default();
    let request = Request {
        symbols: &symbols,
        shared: None,
        measurands: &[measurand],
        units: &table,
    };
    compile(&request).map_err(|faults| {
        faults
            .first()
            .map_or(String::new(), |fault| fault.fault.message.to_string())
    })
}

/// The formula in the model language, its symbols by number: what a sheet writes is no identifier.
fn renamed(text: &str, claimed: &Claimed) -> String {
    let mut order: Vec<usize> = (0..claimed.rows.len())
        .filter(|i| !claimed.rows[*i].symbol.is_empty())
        .collect();
    order.sort_by_key(|i| (std::cmp::Reverse(claimed.rows[*i].symbol.len()), *i));
    let mut out = text.to_string();
    for i in order {
        let symbol = &claimed.rows[i].symbol;
        let first = (0..i)
            .find(|j| claimed.rows[*j].symbol == *symbol)
            .unwrap_or(i);
        let mut from = 0;
        while let Some(at) = crate::read::symbol_at(&out, symbol, from) {
            let name = format!("x_{first}_");
            out.replace_range(at..at + symbol.len(), &name);
            from = at + name.len();
        }
    }
    out.replace(['·', '×', '⋅'], "*")
        .replace('÷', "/")
        .replace("**", "^")
        .replace('√', "sqrt")
        .replace(['[', '{'], "(")
        .replace([']', '}'], ")")
        .replace('π', "pi")
}

/// The factor that the sheet's shape of a row has; for the list of understood rows.
pub fn shape_of(stated: &Stated) -> Option<Shape> {
    match stated {
        Stated::Limits { shape, .. } | Stated::FullWidth { shape, .. } => Some(*shape),
        Stated::Step { .. } | Stated::Unequal { .. } => Some(Shape::Rectangular),
        _ => None,
    }
}

/// How far two figures are apart, as a ratio.
fn far(a: f64, b: f64) -> f64 {
    libm::log(a.abs() / b.abs()).abs()
}
