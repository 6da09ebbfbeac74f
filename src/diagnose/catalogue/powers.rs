//! Squares and cubes of what the model takes in, about the zero that the declared model has for it: so its
//! offset, its slope and its further coefficients keep their meaning beside the new term.

use super::ground::{Ground, Node, varies};
use super::modifiers::{map, mean, middle, range, rounded};
use super::response::crosses_zero;
use super::zero::Absorbed;
use super::{Modifier, Term};

/// A power, as the search takes it and as the improved model has it.
pub(super) struct Power {
    /// Differs from the other by a line at most, which the parameters absorb then.
    pub searched: Modifier,
    /// About the zero of the model.
    pub written: Modifier,
}

/// The square and the cube of a column.
pub(super) fn of(ground: &Ground<'_>, column: usize) -> [Power; 2] {
    /// Powers about a zero that is farther away than the range over this are lines and constants up to
    /// the rounding of the numbers.
    const FAR: f64 = 0.05;
    let x = ground.numbers(column);
    let (least, most) = range(x);
    let within =
        |zero: f64, part: f64| most - least > part * (least - zero).abs().max((most - zero).abs());
    if !absorbs_lines(ground, column) {
        let zero = free_zero(ground, column, within);
        return [2, 3].map(|exponent| {
            let power = about(ground, column, zero, exponent);
            Power {
                searched: power.clone(),
                written: power,
            }
        });
    }
    // Numbers about the middle lie at right angles to constant and slope; what that changes is a line.
    let centre = middle(x);
    let zero = own_zero(ground, column);
    let searched = [2, 3].map(|exponent| about(ground, column, centre, exponent));
    if !within(zero, FAR) {
        return searched.map(|power| Power {
            searched: power.clone(),
            written: power,
        });
    }
    // (d + a)³ = d³ + 3 a d² and a line, with d = x − centre and a = centre − zero.
    let [square, mut cube] = searched;
    let shift = centre - zero;
    cube.values = map(x, |x| {
        let d = x - centre;
        d * d * (d + 3.0 * shift)
    });
    let power = |searched: Modifier, exponent: i32| Power {
        searched,
        written: about(ground, column, zero, exponent),
    };
    [power(square, 2), power(cube, 3)]
}

fn about(ground: &Ground<'_>, column: usize, zero: f64, exponent: i32) -> Modifier {
    let unit = ground.step_unit(column);
    let unit = (1..exponent).fold(unit.clone(), |power, _| power.product(&unit));
    let values = map(ground.numbers(column), |x| (x - zero).powi(exponent));
    let text = format!("{}^{exponent}", ground.less(column, zero));
    Modifier::new(values, text, unit)
}

/// Whether offset and slope of every output by a column are free parameters.
fn absorbs_lines(ground: &Ground<'_>, column: usize) -> bool {
    let case = ground.case();
    if case
        .parameters
        .iter()
        .any(|parameter| parameter.prior.is_some())
    {
        return false;
    }
    let absorbed = Absorbed::by_parameters(ground);
    let x = ground.numbers(column);
    let lines = [vec![1.0; x.len()], x.to_vec()];
    (0..case.responses.len()).all(|response| {
        lines.iter().all(|line| {
            let term = Term::new(Node::Output, Modifier::unnamed(line.clone())).on(response);
            !absorbed.leaves(&ground.column(&term))
        })
    })
}

/// Where the offset of the model is its value: the zero of a line by which a parameter multiplies, 20 °C in
/// `R = R_20*(1 + alpha*(T - 20 '°C'))`; that nearest to the recording, if there are several.
fn own_zero(ground: &Ground<'_>, column: usize) -> f64 {
    let x = ground.numbers(column);
    let (least, most) = range(x);
    let zeros = (0..ground.case().parameters.len()).filter_map(|parameter| {
        let slope = ground.slope(Node::Parameter(parameter), 0);
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
    let (mean_x, mean_y) = (mean(x), mean(y));
    let squares: f64 = x.iter().map(|x| (x - mean_x).powi(2)).sum();
    let products: f64 = (x.iter().zip(y))
        .map(|(x, y)| (x - mean_x) * (y - mean_y))
        .sum();
    let slope = products / squares;
    let (least, most) = range(y);
    let straight = x.iter().zip(y).all(|(x, y)| {
        let line = mean_y + slope * (x - mean_x);
        (y - line).abs() <= STRAIGHT * (most - least)
    });
    let zero = mean_x - mean_y / slope;
    (straight && zero.is_finite()).then_some(zero)
}

/// Without offset and slope in the model: the zero of the quantity, unless its scale begins anywhere or the
/// recording is far from it.
fn free_zero(ground: &Ground<'_>, column: usize, within: impl Fn(f64, f64) -> bool) -> f64 {
    /// Range over largest value.
    const NEAR: f64 = 0.2;
    let x = ground.numbers(column);
    let has_zero = !ground.case().columns[column].unit.is_point() && within(0.0, NEAR);
    if has_zero || crosses_zero(x) {
        0.0
    } else {
        middle(x)
    }
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
