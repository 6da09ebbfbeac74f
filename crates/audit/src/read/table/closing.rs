//! The row of the result, which closes a table.

use crate::claim::Row;
use crate::printed::Printed;
use crate::read::footer::Whole;

use super::raw::Raw;

/// The last row, where it has nothing of what the others have and its figures come of theirs: it closes the table.
pub fn closing(rows: &[Raw]) -> Option<usize> {
    let (last, others) = rows.split_last()?;
    let inputs = others.iter().filter(|raw| raw.is_input()).count();
    let row = &last.row;
    // A result that is its only input is called the same.
    let is_again = others.iter().any(|raw| raw.row.label() == row.label());
    let few = others.len() < 2 && !is_again && !repeats(row, others);
    if few || 2 * inputs <= others.len() || last.is_input() {
        return None;
    }
    // `u(E)` below names that are no symbols of uncertainties.
    let of_result = |row: &Row| row.label().starts_with("u(") || row.label().starts_with("u_c(");
    let is_symbol = of_result(row) && !others.iter().any(|raw| of_result(&raw.row));
    let is_called = is_standard(row) && !others.iter().any(|raw| is_standard(&raw.row));
    let has_both = row.value.is_some() && row.contribution.is_some() && row.u.is_none();
    let figures = [&row.value, &row.u, &row.contribution];
    let is_made = figures
        .into_iter()
        .flatten()
        .any(|figure| times(figure, others).is_some());
    let is_plain = is_made || is_added(row, others);
    let closes = has_both || is_plain || is_symbol || is_called || is_sum(row, others);
    closes.then_some(others.len())
}

/// Whether the last row, by nothing but a value and a contribution, is the result: a row of the sum below it says that it is
/// one of its sources.
pub fn is_like_source(rows: &[Raw]) -> bool {
    let Some((last, others)) = rows.split_last() else {
        return false;
    };
    let figures = [&last.row.value, &last.row.contribution];
    let are_both = figures.iter().all(|figure| figure.is_some());
    let mut made = figures.into_iter().flatten();
    are_both && made.all(|figure| times(figure, others).is_none()) && !is_sum(&last.row, others)
}

/// The symbol of the last row, where it may be that of the result: it has nothing of what most others have.
pub fn symbol_of_result(rows: &[Raw]) -> Option<&str> {
    let (last, others) = rows.split_last()?;
    let inputs = others.iter().filter(|raw| raw.is_input()).count();
    let is_open = 2 * inputs > others.len() && !last.is_input();
    let symbol = last.row.symbol.as_str();
    (is_open && !symbol.is_empty()).then_some(symbol)
}

/// Whether u or the contribution of a row is the contribution of the only other one, which has a coefficient.
fn repeats(row: &Row, others: &[Raw]) -> bool {
    let [only] = others else {
        return false;
    };
    let part = row.contribution.as_ref().or(row.u.as_ref());
    let part = part.map(|part| part.value.abs());
    only.row.c.is_some() && part.is_some() && part == only.part()
}

/// Whether a row is called a standard uncertainty, as that of the whole is in short.
fn is_standard(row: &Row) -> bool {
    const WORDS: [&str; 6] = [
        "standard uncertainty",
        "standardunsicherheit",
        "standardmessunsicherheit",
        "incertitude-type",
        "incertitude type",
        "标准不确定度",
    ];
    let label = row.label().to_lowercase();
    WORDS.iter().any(|word| label.starts_with(word))
}

/// Whether the estimate of a row is made of those of others: their sum with any signs, or the largest of them with small
/// corrections.
fn is_sum(row: &Row, others: &[Raw]) -> bool {
    let values = others.iter().filter_map(|raw| raw.row.value.as_ref());
    let values: Vec<f64> = values.map(|value| value.value.abs()).collect();
    let largest = values.iter().copied().fold(0.0_f64, f64::max);
    let rest: f64 = values.iter().sum::<f64>() - largest;
    let near = |value: &Printed| (value.value.abs() - largest).abs() <= rest + value.half;
    // What is made of all is not known better than the worst of them.
    let worst = others.iter().filter_map(Raw::part).fold(0.0_f64, f64::max);
    let made = [&row.u, &row.contribution].into_iter().flatten();
    if made.into_iter().any(|figure| figure.value.abs() < worst) {
        return false;
    }
    let first = row.value.as_ref();
    first.is_some_and(|value| value.value != 0.0 && rest < 0.5 * largest && near(value))
}

/// Whether the contribution of a row is the plain sum of those of others, which is no way to u_c, but a usual slip.
fn is_added(row: &Row, others: &[Raw]) -> bool {
    let sum: f64 = others.iter().filter_map(Raw::part).sum();
    let own = row.contribution.as_ref().filter(|_| row.u.is_none());
    others.len() > 1 && own.is_some_and(|own| own.is_met_within(sum, own.half_of_digits()))
}

/// How many times the root of the sum of squares of other rows a figure is: once for u_c, k times for U.
fn times(figure: &Printed, others: &[Raw]) -> Option<f64> {
    let counted = others.iter().filter(|raw| raw.row.not_counted.is_none());
    let squares = counted.map(|raw| raw.part().map_or(0.0, |part| part * part));
    let root = libm::sqrt(squares.sum());
    let open = 0.02 + figure.relative_half().min(0.05);
    let near = |k: &f64| (figure.value / (k * root) - 1.0).abs() <= open;
    [1.0, 2.0, 3.0].into_iter().find(near)
}

/// What the figures of the row of the result are.
pub fn figures_of_result(row: Row, others: &[Raw]) -> Vec<(Whole, Printed)> {
    let u = row.contribution.or(row.u);
    let of_u = |figure: &Printed| match times(figure, others) {
        Some(k) if k > 1.0 => Whole::Expanded,
        _ => Whole::Combined,
    };
    // `V_X | 0.000055 V`: what alone stands in the column of estimates may be u_c.
    let of_value = |value: &Printed| match times(value, others) {
        Some(_) if u.is_none() => of_u(value),
        _ => Whole::Y,
    };
    let value = row.value.map(|value| (of_value(&value), value));
    let u = u.map(|u| (of_u(&u), u));
    let dof = row.dof.map(|dof| (Whole::Freedom, dof));
    [value, u, dof].into_iter().flatten().collect()
}
