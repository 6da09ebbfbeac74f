//! What is known, computed once: the right calculation of a claim.

use gumption_core::quantity::Unit;
use gumption_fault::Said;

use crate::claim::{Claimed, Coverage, K_OF_RECTANGLE, Row, Stated};
use crate::printed::Printed;
use crate::read::{FIXED, probability_of_factor, states_usual_level, unusual_level, usual_levels};
use crate::units;

use super::calculation::{Calculation, Combined, Factor, Freedom, Line, Report, t};
use super::model::{
    Differentiated, differentiate, relative_to_estimate, unit_of_estimate, unit_of_y, unit_of_zero,
};

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
    /// Whether the model holds with the units of its estimates.
    pub by_units: bool,
    /// The value of the model at the estimates.
    pub y: Option<f64>,
    /// The terms of second order in the variance, by that of first order (JCGM 100, 5.1.2, note).
    pub second_order: Option<f64>,
    /// How the estimates enter the model, text by text: why it was not understood.
    pub trouble: Option<Said>,
}

impl<'a> Case<'a> {
    /// The right calculation of what is claimed.
    pub fn of(claimed: &'a Claimed) -> Case<'a> {
        let mut unknown_slopes = vec![false; claimed.rows.len()];
        let (mut by_units, mut is_converted) = (false, false);
        let mut second_order = None;
        let mut of_model = vec![false; claimed.rows.len()];
        let (derivatives, y, trouble) = match differentiate(claimed) {
            Ok(Some(known)) => {
                let slopes = in_unit_of_result(claimed, &known);
                of_model.clone_from(&known.of_model);
                unknown_slopes = known.unknown;
                (by_units, is_converted) = (known.by_units, known.is_converted);
                second_order = known.second_order;
                (Some(slopes), known.y, None)
            }
            Ok(None) => (None, None, None),
            Err(trouble) => (None, None, Some(trouble)),
        };
        let lines = claimed.rows.iter().enumerate().map(|(i, row)| {
            // What stands in for a slope that the model does not give is the laboratory's coefficient.
            let own = derivatives.as_ref().filter(|_| of_model[i]);
            let slope = own.map(|d| Slope {
                value: d[i],
                is_converted,
            });
            line(claimed, row, slope)
        });
        let mut right = Calculation {
            lines: lines.collect(),
            correlations: claimed.correlations.clone(),
            combined: Combined::Root,
            freedom: Freedom::Welch,
            factor: factors(claimed)[0],
            report: Report::default(),
        };
        right.freedom = freedom(claimed, &right);
        Case {
            claimed,
            right,
            derivatives,
            unknown_slopes,
            by_units,
            y,
            second_order,
            trouble,
        }
    }
}

/// Derivatives in the unit of the contributions, where that is percent: those of a ratio, with the hundred in them where most
/// coefficients of the sheet have it, or those of a relative result, where more of them are.
fn in_unit_of_result(claimed: &Claimed, known: &Differentiated) -> Vec<f64> {
    let slopes = &known.slopes;
    let Some(fraction) = units::fraction(&claimed.unit) else {
        return slopes.clone();
    };
    let of_model = |made: &dyn Fn(&Row, f64) -> f64| -> Vec<f64> {
        let rows = claimed.rows.iter().zip(slopes).zip(&known.of_model);
        rows.map(|((row, slope), of_model)| match of_model {
            true => made(row, *slope),
            // What the laboratory states is in its unit.
            false => *slope,
        })
        .collect()
    };
    let hundred = of_model(&|_, slope| slope / fraction);
    let stated = |i: usize| {
        let c = claimed.rows[i].c.as_ref()?.value;
        (known.of_model[i] && c != 0.0 && slopes[i] != 0.0).then_some(c)
    };
    let stated: Vec<(usize, f64)> = (0..slopes.len())
        .filter_map(|i| Some((i, stated(i)?)))
        .collect();
    let scaled = |(i, c): &&(usize, f64)| far(*c, hundred[*i]) < far(*c, slopes[*i]);
    let ratio = match 2 * stated.iter().filter(scaled).count() > stated.len() {
        true => hundred,
        false => slopes.clone(),
    };
    let relative = known.y.filter(|y| *y != 0.0).map(|y| {
        of_model(&|row, slope| match relative_to_estimate(row) {
            Some((_, value)) => slope * value / y,
            None => slope / (y * fraction),
        })
    });
    let met = |all: &[f64]| {
        stated
            .iter()
            .filter(|(i, c)| far(*c, all[*i]) < 0.05)
            .count()
    };
    match relative {
        Some(relative) if met(&relative) > met(&ratio) => relative,
        _ => ratio,
    }
}

/// How ν_eff is to be found. Where no row tells its degrees of freedom, one that is stated cannot be computed again: it is taken
/// as it stands, if it is not below what one degree in each open row would give. So is one of correlated readings, for which
/// the formula of Welch and Satterthwaite does not hold (JCGM 100, G.4.1).
fn freedom(claimed: &Claimed, welch: &Calculation) -> Freedom {
    let Some(stated) = &claimed.footer.nu_eff else {
        return Freedom::Welch;
    };
    let is_few = |row: usize| welch.lines[row].dof.is_finite();
    let mut pairs = claimed.correlations.iter();
    if pairs.any(|pair| pair.r != 0.0 && is_few(pair.a) && is_few(pair.b)) {
        return Freedom::Given(stated.value);
    }
    let rows = || welch.lines.iter().zip(&claimed.rows);
    let is_told = |(line, _): (&Line, &Row)| line.counted && line.dof.is_finite();
    if rows().any(is_told) {
        return Freedom::Welch;
    }
    let mut least = welch.clone();
    for (line, row) in least.lines.iter_mut().zip(&claimed.rows) {
        if row.leaves_freedom_open() {
            line.dof = 1.0;
        }
    }
    match stated.value + stated.half >= libm::floor(least.figures(&[], None).nu_eff) {
        true => Freedom::Given(stated.value),
        false => Freedom::Welch,
    }
}

/// The rules for k that the sheet allows; the first is the usual one.
pub fn factors(claimed: &Claimed) -> Vec<Factor> {
    match claimed.coverage {
        Coverage::Fixed(2.0) if claims_too_much_of_two(claimed) => usual_factors(claimed),
        Coverage::Fixed(k) => vec![Factor::Fixed(k)],
        Coverage::StudentT(p) => vec![Factor::StudentT(p)],
        Coverage::Rectangle => vec![Factor::Rectangle],
        Coverage::OfRectangle => vec![Factor::Fixed(K_OF_RECTANGLE)],
        Coverage::Unstated => match unusual_level(claimed) {
            Some(level) => factors_of(level, claimed),
            None => usual_factors(claimed),
        },
    }
}

/// The rules for k where the sheet states a probability: t, and the fixed factor of its statement that covers as much.
fn factors_of(level: f64, claimed: &Claimed) -> Vec<Factor> {
    let least = t(level, f64::INFINITY);
    let covers = |k: &Printed| k.value + k.half >= least;
    let stated = claimed.footer.k.as_ref().filter(|k| covers(k));
    let fixed = stated.and_then(usual_factor).map(Factor::Fixed);
    fixed.into_iter().chain([Factor::StudentT(level)]).collect()
}

/// The rules for k where the sheet states neither one nor a probability other than the usual.
fn usual_factors(claimed: &Claimed) -> Vec<Factor> {
    let stated = claimed.footer.k.as_ref().and_then(usual_factor);
    let levels = usual_levels(&claimed.words);
    let levels = levels.chain(probability_of_factor(&claimed.words));
    let levels = levels.chain(stated.and_then(level_of_factor));
    let two = Some(2.0).filter(|_| !claims_too_much_of_two(claimed));
    let fixed = stated.into_iter().chain(two).map(Factor::Fixed);
    let looked_up = levels.map(Factor::StudentT);
    let own = as_stated(claimed).map(Factor::Fixed);
    match looks_up(claimed) {
        true => looked_up.chain(fixed).chain(own).collect(),
        false => fixed.chain(looked_up).chain(own).collect(),
    }
}

/// The factor that a sheet states without a rule, where it has no degrees of freedom by which that could be judged, and U is the product:
/// 1.83 of two rectangles (EA-4/02 M:2022, S10), 2.13 of readings that nobody counts.
fn as_stated(claimed: &Claimed) -> Option<f64> {
    let footer = &claimed.footer;
    let k = footer
        .k
        .as_ref()
        .filter(|k| k.value > 1.0 && k.value < 5.0)?;
    let (expanded, u_c) = footer.expanded.as_ref().zip(footer.u_c.as_ref())?;
    let open = 2.0 * expanded.half_of_expanded() + k.value * u_c.half_of_digits();
    let is_product = (expanded.value - k.value * u_c.value).abs() <= open;
    let is_few = |row: &Row| {
        let stated = row.stated.standard().map(|(_, dof)| dof);
        let dof = row.dof.as_ref().map(|dof| dof.value).or(stated);
        dof.is_some_and(f64::is_finite)
    };
    let is_judged = footer.nu_eff.is_some() || claimed.rows.iter().any(is_few);
    (is_product && !is_judged).then_some(k.value)
}

/// Whether a sheet states a probability of about 95 % for its U or k, and degrees of freedom at which k = 2 does not have it:
/// fewer than ten (rule 39; EA-4/02 M:2022, annex E; JCGM 100, G.6.6, which asks for more than ten). A laboratory that states
/// k = 2 and no probability claims nothing that would be wrong.
fn claims_too_much_of_two(claimed: &Claimed) -> bool {
    let states_none = |line: &str| {
        let lower = line.to_lowercase();
        SAYS_NONE.iter().any(|words| lower.contains(words))
    };
    if claimed.words.lines().any(states_none) {
        return false;
    }
    let nu = claimed.footer.nu_eff.as_ref();
    let is_few = nu.is_some_and(|nu| nu.value + nu.half < FEW_DEGREES);
    is_few && states_usual_level(&claimed.words)
}

/// How a sheet says that its factor has no probability.
const SAYS_NONE: [&str; 3] = [
    "no probability stated",
    "no coverage probability",
    "不注明包含概率",
];

/// Degrees of freedom below which k = 2 is too small for 95 %.
const FEW_DEGREES: f64 = 10.0;

/// Whether a sheet states its degrees of freedom, and a k that nobody fixes: it was looked up.
fn looks_up(claimed: &Claimed) -> bool {
    let footer = &claimed.footer;
    let is_finite = footer
        .nu_eff
        .as_ref()
        .is_some_and(|nu| nu.value.is_finite());
    let k = footer.k.as_ref();
    is_finite && k.is_some_and(|k| k.value != 2.0 && usual_factor(k).is_none())
}

/// The probability whose normal quantile is printed as this factor.
fn level_of_factor(k: f64) -> Option<f64> {
    let is_printed = |p: &f64| (t(*p, f64::INFINITY) - k).abs() <= 0.005;
    [0.9, 0.99, 0.9973].into_iter().find(is_printed)
}

/// A stated factor that laboratories fix, other than 2; a workbook may hold the quantile with all its digits.
fn usual_factor(k: &Printed) -> Option<f64> {
    let printed = libm::round(100.0 * k.value) / 100.0;
    FIXED.contains(&printed).then_some(k.value)
}

/// What the model gives for a row.
#[derive(Clone, Copy)]
struct Slope {
    value: f64,
    /// Whether it is in the units of the estimates.
    is_converted: bool,
}

fn line(claimed: &Claimed, row: &Row, slope: Option<Slope>) -> Line {
    let derivative = slope.map(|slope| slope.value);
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
    let to_y = slope.map_or_else(
        || to_y(claimed, row),
        |slope| to_y_of_model(claimed, row, slope),
    );
    let mut c = derivative
        .or(row.c.as_ref().map(|c| c.value))
        .or_else(|| shown_coefficient(claimed, row))
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
    // A coefficient with a unit of its own is the derivative in that unit.
    if let Some((derivative, own)) = derivative.zip(by_unit_of_c(claimed, row)) {
        (c, rest) = (derivative * to_y / own, own);
    }
    if row.stated == Stated::Nothing && c * rest != 0.0 {
        // The contribution has the coefficient in it.
        u /= (c * rest).abs();
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

/// The coefficient that the contribution of a row shows, where the sheet states none and no factor leads from the unit of u to that of
/// the result.
fn shown_coefficient(claimed: &Claimed, row: &Row) -> Option<f64> {
    let (u, made) = (row.u.as_ref()?, row.contribution.as_ref()?);
    let ratio = (made.value / u.value).abs();
    let is_shown = ratio.is_finite() && units::leads_nowhere(&row.unit, &claimed.unit);
    is_shown.then_some(ratio)
}

/// The step of an indication whose readings are all equal.
fn silent_step(row: &Row) -> Option<f64> {
    let is_zero = matches!(&row.stated, Stated::Deviation { s, .. } if s.value == 0.0);
    is_zero
        .then(|| crate::read::figure_after(&row.words, crate::read::STEP).map(|step| step.value))?
}

/// From the unit of a derivative times u, which is that of the model, to that of the contributions.
fn to_y_of_model(claimed: &Claimed, row: &Row, slope: Slope) -> f64 {
    let y_unit = claimed.unit.as_str();
    let of = |from: &str, to: &str| {
        if from.is_empty() || to.is_empty() {
            1.0
        } else {
            units::factor(from, to).unwrap_or(1.0)
        }
    };
    let of_zero = unit_of_zero(claimed, row).filter(|_| slope.is_converted);
    let value = of_zero.unwrap_or(unit_of_estimate(claimed, row));
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
    of(&row.unit, value) * of(unit_of_y(claimed), y_unit)
}

/// From the unit of c·u to that of the result, where units are written that say so.
fn to_y(claimed: &Claimed, row: &Row) -> f64 {
    let y_unit = claimed.unit.as_str();
    if y_unit.is_empty() {
        return 1.0;
    }
    let is_known = row.unit.is_empty() || units::parse(&row.unit).is_some();
    if unit_of_c(row).is_some() && is_known {
        return by_unit_of_c(claimed, row).unwrap_or(1.0);
    }
    if row.unit.is_empty() {
        return 1.0;
    }
    if let Some(factor) = by_named_length(claimed, row) {
        return factor;
    }
    let factor = units::factor(&row.unit, y_unit).unwrap_or(1.0);
    // `1000` between mm and µm: the coefficient is the conversion. So is `100/x` of a ratio x for a result in percent.
    let of_value = |c: &Printed| {
        let value = row.value.as_ref().map_or(0.0, |x| x.value.abs());
        (c.value.abs() * value / factor - 1.0).abs() <= 1e-3
    };
    let converts = |c: &Printed| c.is_met_by(factor.copysign(c.value)) || of_value(c);
    match row.c.as_ref().is_some_and(converts) || coefficients_convert(claimed) {
        true => 1.0,
        false => factor,
    }
}

/// Whether the coefficients of most rows in another unit than the result hold the conversion: their contributions are c·u as
/// it is printed. Of a single row that may be a factor which was lost.
fn coefficients_convert(claimed: &Claimed) -> bool {
    let made = |row: &Row| {
        let factor = units::factor(&row.unit, &claimed.unit).filter(|factor| *factor != 1.0)?;
        let (u, c) = (row.u.as_ref()?, row.c.as_ref()?);
        let made = row.contribution.as_ref().filter(|made| made.value != 0.0)?;
        let ratio = (c.value * u.value / made.value).abs();
        Some((ratio - 1.0).abs() < (ratio * factor - 1.0).abs())
    };
    let made: Vec<bool> = claimed.rows.iter().filter_map(made).collect();
    let held = made.iter().filter(|held| **held).count();
    made.len() >= 2 && 2 * held > made.len()
}

/// The unit that is written behind the coefficient of a row.
fn unit_of_c(row: &Row) -> Option<Unit> {
    let unit = &row.c.as_ref()?.unit;
    units::parse(unit).filter(|_| unit != "1")
}

/// From the unit of c·u to that of the result, where c has one and they agree.
fn by_unit_of_c(claimed: &Claimed, row: &Row) -> Option<f64> {
    // An estimate without a unit is a number, and so is its uncertainty.
    let u = match row.unit.as_str() {
        "" => Unit::one(),
        unit => units::parse(unit)?,
    };
    let target = units::parse(&claimed.unit)?;
    let product = unit_of_c(row)?.product(&u.difference());
    let conversion = product.conversion_to(&target.difference())?;
    Some(conversion.apply(1.0) - conversion.apply(0.0))
}

/// From the unit of c·u to that of the result, where u is in ppm, the result is not, and the coefficient is a bare number
/// which the sheet names with its unit somewhere else: `1000` beside `laser interferometer, 1000 mm`.
fn by_named_length(claimed: &Claimed, row: &Row) -> Option<f64> {
    let fraction = units::fraction(&row.unit)?;
    let c = row
        .c
        .as_ref()
        .filter(|c| c.unit.is_empty() && c.value != 0.0)?;
    let value = row.value.iter().cloned();
    let texts = [&claimed.title, &claimed.words]
        .into_iter()
        .chain([&row.words]);
    let mut named = value.chain(texts.flat_map(|text| crate::read::figures_with_units(text)));
    named.find_map(|figure| {
        let is_it = (figure.value.abs() / c.value.abs() - 1.0).abs() < 1e-9;
        let factor = units::factor(&figure.unit, &claimed.unit).filter(|_| is_it);
        factor.map(|factor| fraction * factor)
    })
}

/// How far two figures are apart, as a ratio.
fn far(a: f64, b: f64) -> f64 {
    libm::log(a.abs() / b.abs()).abs()
}
