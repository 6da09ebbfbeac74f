//! The measurement model of a sheet: its value and its derivatives at the estimates.

use gumption_core::model::{MeasurandSource, Model, Request, Role, Symbol, compile};
use gumption_core::quantity::{Unit, UnitTable};

use gumption_fault::language::Language;
use gumption_fault::{Said, say};

use crate::claim::{Claimed, Row};
use crate::printed::Printed;
use crate::units;

/// The unit of the result itself, which its uncertainty need not be in.
pub(crate) fn unit_of_y(claimed: &Claimed) -> &str {
    let own = claimed.footer.y.as_ref().map_or("", |y| y.unit.as_str());
    if own.is_empty() { &claimed.unit } else { own }
}

/// The estimate of the quantity of a row: several rows of one symbol are reasons to doubt one input, and its estimate
/// stands in one of them.
pub(crate) fn estimate<'a>(claimed: &'a Claimed, row: &'a Row) -> Option<&'a Printed> {
    let of_symbol = || {
        let mut rows = claimed.rows.iter().filter(|_| !row.symbol.is_empty());
        rows.find_map(|other| other.value.as_ref().filter(|_| other.symbol == row.symbol))
    };
    row.value.as_ref().or_else(of_symbol)
}

/// The unit of an estimate; of one that only a note knows, that of its uncertainty.
pub(super) fn unit_of_estimate<'a>(claimed: &'a Claimed, row: &'a Row) -> &'a str {
    match estimate(claimed, row) {
        Some(value) => &value.unit,
        None if row.is_absent => &row.unit,
        None => "",
    }
}

/// The unit of a deviation that is zero, of which nobody writes one: that of its uncertainty.
pub(super) fn unit_of_zero<'a>(claimed: &Claimed, row: &'a Row) -> Option<&'a str> {
    let is_zero = |value: &Printed| value.value == 0.0 && value.unit.is_empty();
    let has_unit = !row.unit.is_empty() && units::fraction(&row.unit).is_none();
    estimate(claimed, row).filter(|value| is_zero(value) && has_unit)?;
    Some(&row.unit)
}

/// What a model gives at the estimates.
pub(super) struct Differentiated {
    pub(super) slopes: Vec<f64>,
    /// Which slopes depend on estimates that are not stated; the claimed coefficients stand in their places.
    pub(super) unknown: Vec<bool>,
    /// Which slopes are those of the model.
    pub(super) of_model: Vec<bool>,
    pub(super) y: Option<f64>,
    /// Whether the model holds with the units of its estimates.
    pub(super) by_units: bool,
    /// Whether the slopes are in the units of the estimates.
    pub(super) is_converted: bool,
    /// The terms of second order in the variance, by that of first order; none where estimates are not stated.
    pub(super) second_order: Option<f64>,
}

/// Value and derivatives of the model at the estimates. `None` without a model.
pub(super) fn differentiate(claimed: &Claimed) -> Result<Option<Differentiated>, Said> {
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
    let missing = |i: usize| used[i] && estimate(claimed, &rows[i]).is_none();
    let any_missing = (0..rows.len()).any(missing);
    // Each unknown estimate on a way of its own, so that ratios of them move, too.
    let at = |power: f64| -> Vec<f64> {
        let value = |(i, row): (usize, &Row)| match estimate(claimed, row) {
            Some(value) => value.value,
            None => libm::pow(1.3 + 0.37 * i as f64, power),
        };
        rows.iter().enumerate().map(value).collect()
    };
    let values = at(1.0);
    if !used.iter().any(|used| *used) {
        return Ok(None);
    }
    let formula = renamed(text, claimed);
    let unit_stated = |row: &Row| units::parse(unit_of_estimate(claimed, row));
    let of_zero = |row: &Row| Some(units::parse(unit_of_zero(claimed, row)?)?.difference());
    let unit_of = |row: &Row| unit_stated(row).or_else(|| of_zero(row));
    // Among estimates that have units, one that has none is a number.
    let is_number = |row: &Row| {
        let value = estimate(claimed, row);
        value.is_some_and(|v| v.unit.is_empty()) && of_zero(row).is_none()
    };
    let bare_sheet = rows.iter().all(|row| unit_stated(row).is_none());
    let have_units = !bare_sheet
        && !unit_of_y(claimed).is_empty()
        && rows
            .iter()
            .zip(&used)
            .all(|(row, used)| !used || unit_of(row).is_some() || is_number(row));
    let units = rows
        .iter()
        .map(|row| unit_of(row).unwrap_or_else(Unit::one));
    let units: Vec<Unit> = units.collect();
    let plain = vec![Unit::one(); units.len()];
    let bare = |formula: &str| compiled(formula, &plain, Unit::one(), &used);
    let target = units::parse(unit_of_y(claimed)).unwrap_or_else(Unit::one);
    let by = |units: &[Unit]| compiled(&formula, units, target.clone(), &used).ok();
    let with_units = have_units.then(|| by(&units)).flatten();
    let by_units = with_units.is_some() || bare_sheet;
    let with_units = with_units.or_else(|| {
        let some = have_units
            .then(|| beside_numbers(&units, &used, by))
            .into_iter()
            .flatten();
        some.max_by_key(|model| agreement(claimed, &values, &used, model))
    });
    let is_converted = with_units.is_some();
    let model = with_units.map_or_else(|| bare(&formula), Ok);
    let mut model = model.map_err(|message| as_written(message, claimed))?;
    // Without a unit, an angle may be in degrees: the claimed coefficients and y tell.
    let any_number = rows
        .iter()
        .zip(&used)
        .any(|(row, used)| *used && is_number(row));
    let in_degrees = in_degrees(&formula);
    let degrees = match is_converted {
        true => any_number.then(|| compiled(&in_degrees, &units, target, &used)),
        false => Some(bare(&in_degrees)),
    };
    if let Some(Ok(degrees)) = degrees {
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
        return Err(say!(
            "the model names inputs whose estimates the sheet does not state"
        ));
    }
    // All reasons to doubt an input together.
    let mut doubt = vec![0.0; rows.len()];
    for i in (0..rows.len()).filter(|i| used[*i]) {
        let doubt_of_row = doubt_of_estimate(claimed, &rows[i]);
        doubt[first(i)] = libm::hypot(doubt[first(i)], doubt_of_row);
    }
    let second_order = (!any_missing)
        .then(|| second_order(&model, &values, &doubt))
        .flatten();
    Ok(Some(Differentiated {
        second_order,
        slopes: (0..rows.len()).map(derivative).collect(),
        y: (!any_missing).then(|| model.values(&values)[0]),
        of_model: (0..rows.len()).map(|i| used[i] && !unknown[i]).collect(),
        unknown,
        by_units,
        is_converted,
    }))
}

/// The models in which one input is a number, or two are where one is not enough: numbers of a formula may have units that
/// nobody wrote, as in `1 + 11.5e-6*(t - 20)`.
fn beside_numbers(
    units: &[Unit],
    used: &[bool],
    by: impl Fn(&[Unit]) -> Option<Model>,
) -> Vec<Model> {
    let with_numbers = |numbers: &[usize]| {
        let mut units = units.to_vec();
        for i in numbers {
            units[*i] = Unit::one();
        }
        by(&units)
    };
    let inputs: Vec<usize> = (0..units.len()).filter(|i| used[*i]).collect();
    let one = inputs.iter().filter_map(|i| with_numbers(&[*i]));
    let one: Vec<Model> = one.collect();
    if !one.is_empty() {
        return one;
    }
    let pairs = inputs
        .iter()
        .flat_map(|a| inputs.iter().map(move |b| [*a, *b]));
    let pairs = pairs.filter(|[a, b]| a < b);
    pairs.filter_map(|pair| with_numbers(&pair)).collect()
}

/// The standard uncertainty of an estimate, in the unit of the estimate.
fn doubt_of_estimate(claimed: &Claimed, row: &Row) -> f64 {
    let u = row
        .stated
        .standard()
        .map_or(0.0, |(u, _)| u * row.relative_factor());
    let to_estimate = match relative_to_estimate(row) {
        Some((fraction, value)) => Some(fraction * value.abs()),
        None => units::factor(&row.unit, unit_of_estimate(claimed, row)),
    };
    match row.not_counted {
        None => u * to_estimate.unwrap_or(1.0),
        Some(_) => 0.0,
    }
}

/// The estimate that the uncertainty of a row is relative to, and as what fraction: in percent beside an estimate in kg.
pub(super) fn relative_to_estimate(row: &Row) -> Option<(f64, f64)> {
    let fraction = units::fraction(&row.unit)?;
    let value = row.value.as_ref()?;
    let is_other = !value.unit.is_empty() && units::fraction(&value.unit).is_none();
    is_other.then_some((fraction, value.value))
}

/// Σ (½ f_ij² + f_i f_ijj) u_i² u_j² by Σ f_i² u_i² (JCGM 100, 5.1.2, note). Derivatives of gradients are taken over a
/// standard uncertainty either way: on that scale the model is asked for.
fn second_order(model: &Model, x: &[f64], u: &[f64]) -> Option<f64> {
    /// Inputs that bend the model; of more, the differences would take seconds.
    const MOST: usize = 64;
    let slopes = model.gradients(x);
    let inputs = slopes.ncols();
    let bent = model.nonlinear_inputs();
    let bent: Vec<usize> = (0..inputs)
        .filter(|j| u[*j] > 0.0 && bent.get(*j).copied().unwrap_or(true))
        .collect();
    let square = |x: f64| x * x;
    let first: f64 = (0..inputs).map(|i| square(slopes[(0, i)] * u[i])).sum();
    if bent.len() > MOST || first <= 0.0 {
        return None;
    }
    let mut second = 0.0;
    for j in bent {
        let at = |step: f64| {
            let mut moved = x.to_vec();
            moved[j] += step * u[j];
            model.gradients(&moved)
        };
        let (up, down) = (at(1.0), at(-1.0));
        for i in (0..inputs).filter(|i| u[*i] > 0.0) {
            let (a, b, c) = (up[(0, i)], slopes[(0, i)], down[(0, i)]);
            // With u_j in the steps, f_ij u_j and f_ijj u_j².
            let (bend, third) = ((a - c) / 2.0, a - 2.0 * b + c);
            second += (0.5 * square(bend) + b * third) * square(u[i]);
        }
    }
    let share = second / first;
    share.is_finite().then_some(share)
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

fn compiled(formula: &str, units: &[Unit], target: Unit, used: &[bool]) -> Result<Model, Said> {
    let symbols: Vec<Symbol> = units
        .iter()
        .enumerate()
        .filter(|(i, _)| used[*i])
        .map(|(i, unit)| Symbol {
            name: numbered(i).into(),
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
            .map_or_else(Said::default, |fault| fault.fault.message.clone())
    })
}

/// The name of a symbol by its number: what a sheet writes is no identifier.
fn numbered(i: usize) -> String {
    format!("x_{i}_")
}

/// The formula in the model language, its symbols by number.
fn renamed(text: &str, claimed: &Claimed) -> String {
    let names: Vec<String> = (0..claimed.rows.len()).map(numbered).collect();
    formula(text, claimed, &names)
}

/// A message about such a formula, with the symbols of the sheet.
fn as_written(message: Said, claimed: &Claimed) -> Said {
    let said = |language: Language| {
        let rows = claimed.rows.iter().enumerate();
        rows.fold(message.in_language(language), |text, (i, row)| {
            text.replace(&numbered(i), &row.symbol)
        })
    };
    Said::pair(said(Language::English), said(Language::Chinese))
}

/// The formula in the model language, its symbols by these names.
pub(crate) fn formula(text: &str, claimed: &Claimed, names: &[String]) -> String {
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
            let name = &names[first];
            out.replace_range(at..at + symbol.len(), name);
            from = at + name.len();
        }
    }
    let out = out
        .replace(['·', '×', '⋅'], "*")
        .replace('÷', "/")
        .replace("**", "^")
        .replace('√', "sqrt")
        .replace(['[', '{'], "(")
        .replace([']', '}'], ")")
        .replace('π', "pi");
    with_products(&out, names)
}

/// The formula with a sign where two factors stand beside each other with a blank between: `m/(ρ t)`, `2 π r`.
fn with_products(formula: &str, names: &[String]) -> String {
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
    let is_factor = |word: &str| {
        word == "pi" || word.parse::<f64>().is_ok() || names.iter().any(|name| name == word)
    };
    let word_at = |from: usize| {
        let rest = &formula[from..];
        &rest[..rest.find(|c| !is_word(c)).unwrap_or(rest.len())]
    };
    let mut out = String::new();
    let (mut at, mut is_behind_factor) = (0, false);
    while let Some(c) = formula[at..].chars().next() {
        let word = word_at(at);
        let token = if word.is_empty() {
            &formula[at..at + c.len_utf8()]
        } else {
            word
        };
        let is_call = !word.is_empty() && formula[at + word.len()..].starts_with('(');
        let begins = token == "(" || is_factor(word) || is_call;
        if is_behind_factor && begins && out.ends_with(' ') {
            out.push_str("* ");
        }
        out.push_str(token);
        if token != " " {
            is_behind_factor = token == ")" || is_factor(word);
        }
        at += token.len();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::with_products;

    #[test]
    fn factors_beside_each_other_are_multiplied() {
        let names = ["a", "b", "c"].map(String::from);
        for (text, formula) in [
            ("a/(b c)", "a/(b * c)"),
            ("2 pi a", "2 * pi * a"),
            ("2 sin(a) (b + c)", "2 * sin(a) * (b + c)"),
            ("sin (a) + b - c", "sin (a) + b - c"),
            ("a d", "a d"),
        ] {
            assert_eq!(with_products(text, &names), formula);
        }
    }
}
