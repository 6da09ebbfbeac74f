//! Squares and cubes of what the model takes in, about the zero that the declared model has for it: so its
//! offset, its slope and its further coefficients keep their meaning beside the new term.

use super::building::on_output;
use super::fitted::{FittedModel, Node, varies};
use super::heating::heats;
use super::modifiers::{
    crosses_zero, largest, line_through, map, map2, mean, middle, range, rounded,
};
use super::{Modifier, Term, Variation};

/// The square and the cube of a column; without those that a model has, beside an offset that it takes as exact, about its own
/// zero: `R_0*(1 + A*T + B*T^2)` with R_0 known. The heat of a current bends what it does as its cube about zero, which is
/// another one than that about the middle by a square.
pub(super) fn of(fitted: &FittedModel<'_>, column: usize) -> [Vec<Variation>; 2] {
    let lines = absorbs(fitted, column, 1);
    let declared = |exponent| !lines && declares(fitted, column, exponent);
    let [searched, zero] = match lines {
        true => [search_zero(fitted, column), own_zero(fitted, column)],
        false if declared(1) => [own_zero(fitted, column); 2],
        false => [free_zero(fitted, column); 2],
    };
    // A power about another zero differs by the lower powers.
    let squares = lines && absorbs(fitted, column, 2);
    let near = is_within(fitted.numbers(column), zero, FAR);
    [(2, lines), (3, squares)].map(|(exponent, absorbed)| {
        // What is printed and fitted differs from what is searched by what the parameters absorb.
        let written = if absorbed && near { zero } else { searched };
        let about = |zero: f64| about(fitted, column, zero, exponent);
        let usual = on_output(about(searched)).written_as(about(written));
        let usual = (!declared(exponent)).then(|| Variation::one("", usual));
        let natural = free_zero(fitted, column);
        let heated = lines && !absorbed && natural != searched && heats(fitted, column);
        let heated = heated.then(|| Variation::one("about zero", on_output(about(natural))));
        usual.into_iter().chain(heated).collect()
    })
}

/// Whether a power about the model's own zero is a free parameter of every output.
fn declares(fitted: &FittedModel<'_>, column: usize, exponent: i32) -> bool {
    let zero = own_zero(fitted, column);
    absorbs_all(fitted, &[about(fitted, column, zero, exponent)])
}

/// Powers about a zero that is farther away than the range over this are lines and constants up to the
/// rounding of the numbers.
const FAR: f64 = 0.05;

/// Whether a range is more than a part of the distance from a zero to its farther end.
fn is_within(x: &[f64], zero: f64, part: f64) -> bool {
    let (least, most) = range(x);
    most - least > part * (least - zero).abs().max((most - zero).abs())
}

/// Numbers about the middle lie at right angles to constant and slope.
fn search_zero(fitted: &FittedModel<'_>, column: usize) -> f64 {
    let x = fitted.numbers(column);
    if crosses_zero(x) { 0.0 } else { middle(x) }
}

fn about(fitted: &FittedModel<'_>, column: usize, zero: f64, exponent: i32) -> Modifier {
    let unit = fitted.step_unit(column);
    let unit = (1..exponent).fold(unit.clone(), |power, _| power.product(&unit));
    let values = map(fitted.numbers(column), |x| (x - zero).powi(exponent));
    let text = format!("{}^{exponent}", fitted.less(column, zero));
    Modifier::new(values, text, unit)
}

/// Whether the powers of a column up to an exponent are free parameters of every output.
fn absorbs(fitted: &FittedModel<'_>, column: usize, exponent: i32) -> bool {
    let centre = middle(fitted.numbers(column));
    let powers: Vec<Modifier> = (0..=exponent)
        .map(|exponent| about(fitted, column, centre, exponent))
        .collect();
    absorbs_all(fitted, &powers)
}

/// Whether what follows these is a free parameter of every output.
fn absorbs_all(fitted: &FittedModel<'_>, powers: &[Modifier]) -> bool {
    let case = fitted.case();
    if case.parameters.iter().any(|p| p.prior.is_some()) {
        return false;
    }
    (0..case.responses.len()).all(|response| {
        powers.iter().all(|power| {
            let term = Term::new(Node::Output, power.clone()).on(response);
            !fitted.leaves(&term)
        })
    })
}

/// Where the offset of the model is its value: the zero of a line by which a parameter multiplies, 20 °C in
/// `R = R_20*(1 + alpha*(T - 20 '°C'))`; that nearest to the recording, if there are several.
fn own_zero(fitted: &FittedModel<'_>, column: usize) -> f64 {
    let x = fitted.numbers(column);
    let (least, most) = range(x);
    let zeros = (0..fitted.case().parameters.len()).filter_map(|parameter| {
        let slope = fitted.slope(Node::Parameter(parameter), 0);
        zero_of_line(x, &slope)
    });
    let zeros: Vec<f64> = zeros
        .map(|zero| rounded(zero, 1e-6 * (most - least)))
        .collect();
    let centre = mean(x);
    let far = |zero: &f64| (zero - centre).abs();
    let nearest = zeros
        .iter()
        .copied()
        .min_by(|a, b| far(a).total_cmp(&far(b)));
    match nearest {
        Some(zero) if !zeros.contains(&0.0) => zero,
        _ => 0.0,
    }
}

/// Where a line crosses zero; nothing for what is constant or no line.
fn zero_of_line(x: &[f64], y: &[f64]) -> Option<f64> {
    /// Largest distance from the line, as a part of the range.
    const STRAIGHT: f64 = 1e-9;
    if !varies(y) || !varies(x) {
        return None;
    }
    let (slope, offset, _) = line_through(x, y);
    let (least, most) = range(y);
    let off = map2(x, y, |x, y| y - offset - slope * x);
    let straight = largest(&off) <= STRAIGHT * (most - least);
    let zero = -offset / slope;
    (straight && zero.is_finite()).then_some(zero)
}

/// Without offset and slope in the model: the zero of the quantity, unless its scale begins anywhere or the
/// recording is far from it.
fn free_zero(fitted: &FittedModel<'_>, column: usize) -> f64 {
    match zero_near(fitted, column) {
        true => 0.0,
        false => search_zero(fitted, column),
    }
}

/// Whether a quantity has a zero of its own, and the recording is not far from it.
pub(super) fn zero_near(fitted: &FittedModel<'_>, column: usize) -> bool {
    /// Range over largest value.
    const NEAR: f64 = 0.2;
    let has_zero = !fitted.case().columns[column].unit.is_point();
    has_zero && is_within(fitted.numbers(column), 0.0, NEAR)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_a_zero() {
        let x = [20.0, 25.0, 31.0];
        let zero = zero_of_line(&x, &map(&x, |x| 3.0 * (x - 20.0))).unwrap();
        assert!((zero - 20.0).abs() < 1e-9);
        assert_eq!(zero_of_line(&x, &[1.0; 3]), None);
        assert_eq!(zero_of_line(&x, &map(&x, |x| x * x)), None);
    }
}
