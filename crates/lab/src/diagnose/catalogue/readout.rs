//! What the readout and the protocol do: rounding to a step, outputs in the wrong line.

use super::building::{on_output, plain};
use super::fitted::{FittedModel, varies};
use super::{Cell, EffectId, Modifier, Variation, tied};

/// Cells of the readout.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells: Vec<Cell> = (0..fitted.case().responses.len())
        .filter_map(|response| quantisation(fitted, response))
        .collect();
    cells.extend(shifted(fitted));
    cells
}

/// Rounding of the model's output to the step in which readings come: an error of known size.
fn quantisation(fitted: &FittedModel<'_>, response: usize) -> Option<Cell> {
    let observed = fitted.design.observed(response);
    if fitted.is_implicit(response) || fitted.design.blocks.len() < fitted.rows() {
        return None;
    }
    let Steps { step, origin } = steps(&observed)?;
    let model = &fitted.fit.linear.values[response];
    let shift = |y: f64| ((y - origin) / step).round() * step + origin - y;
    let name = &fitted.case().responses[response].name;
    let unit = fitted.case().responses[response].unit.typeset();
    let shown = super::modifiers::figure(step);
    let text = match origin == 0.0 {
        true => format!("(round({name}/{shown})*{shown} - {name})"),
        false => {
            format!("(round(({name} - {origin})/{shown})*{shown} - ({name} - {origin}))")
        }
    };
    let term = on_output(Modifier::new(
        super::modifiers::map(model, shift),
        text,
        fitted.case().responses[response].unit.difference(),
    ));
    let label = format!("step {shown} {unit}");
    let mut cell = plain(
        fitted,
        EffectId::Quantisation,
        name,
        vec![Variation::one(label, term.on(response))],
    );
    cell.words.y = name.clone();
    Some(cell)
}

/// Equal steps in which readings come.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Steps {
    step: f64,
    /// One of the readings that are possible; zero where zero is.
    origin: f64,
}

/// The equal steps in which readings come, if they are coarse. The file may round the readings once more, to its digits.
fn steps(readings: &[f64]) -> Option<Steps> {
    /// Probability that readings lie on equal steps by chance, at most.
    const CHANCE: f64 = 1e-3;
    /// Where the digits of the file are the steps: the share of the readings that are different from all others, at most.
    const ALIKE: f64 = 0.7;
    // Rows that are still to be recorded have none.
    let readings: Vec<f64> = (readings.iter().copied())
        .filter(|x| x.is_finite())
        .collect();
    let values = super::modifiers::levels_of(&readings);
    if values.len() < 3 {
        return None;
    }
    let digit = digit(&values)?;
    let step = spacing(&values, digit)?;
    // Of the readings that the file can hold, so many lie next to a step, on either side.
    let near = (2.0 * digit / step).min(1.0);
    let by_chance = libm::pow(near, (values.len() - 2) as f64);
    let again = values.len() as f64 <= ALIKE * readings.len() as f64;
    if by_chance > CHANCE && !again {
        return None;
    }
    let from_zero = |x: &f64| (x - (x / step).round() * step).abs() <= digit;
    let origin = match values.iter().all(from_zero) {
        true => 0.0,
        false => values[0],
    };
    Some(Steps { step, origin })
}

/// The unit of the last decimal place of numbers.
fn digit(values: &[f64]) -> Option<f64> {
    /// A double has no more.
    const PLACES: i32 = 15;
    let size = super::modifiers::largest(values);
    let is_whole = |place: &i32| {
        let times = libm::pow(10.0, f64::from(*place));
        // What is left of a number of 53 bits.
        let rounding = 4.0 * f64::EPSILON * size * times;
        let is_whole = |x: &f64| (x * times - (x * times).round()).abs() <= rounding;
        rounding < 0.01 && values.iter().all(is_whole)
    };
    let place = (-PLACES..=PLACES).find(is_whole)?;
    Some(libm::pow(10.0, f64::from(-place)))
}

/// The largest step of which all distances of ascending values are multiples, each value rounded to a digit. Longer and longer
/// distances from the first narrow it down.
fn spacing(values: &[f64], digit: f64) -> Option<f64> {
    // A bound is met by rounding as well.
    let slack = digit * (1.0 + 1e-6);
    let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let least = gaps.fold(f64::INFINITY, f64::min);
    let (mut low, mut high) = ((least - slack).max(digit / 2.0), least + slack);
    for value in &values[1..] {
        let far = value - values[0];
        let times = (far / (0.5 * (low + high))).round().max(1.0);
        low = low.max((far - slack) / times);
        high = high.min((far + slack) / times);
        if low > high {
            return None;
        }
    }
    let step = 0.5 * (low + high);
    // A step of few digits is meant where it is possible.
    let short = super::modifiers::rounded(step, high - low);
    Some(if (low..=high).contains(&short) {
        short
    } else {
        step
    })
}

/// Every output stands one row too late or too early.
fn shifted(fitted: &FittedModel<'_>) -> Option<Cell> {
    let single = fitted.design.blocks.iter().all(|rows| rows.len() == 1);
    if !single || !fitted.has_signal() || fitted.rows() < 8 {
        return None;
    }
    let last = fitted.rows() - 1;
    let variant = |label: &str, other: &dyn Fn(usize) -> usize| {
        let terms = (0..fitted.case().responses.len()).map(|response| {
            let model = &fitted.fit.linear.values[response];
            let modifier = (0..=last).map(|row| model[other(row)] - model[row]);
            let unit = fitted.case().responses[response].unit.difference();
            let text = format!("outputs {label}");
            on_output(Modifier::new(modifier.collect(), text, unit)).on(response)
        });
        let terms = terms.filter(|term| varies(&term.modifier.values));
        Variation::of(label, tied(terms.collect()))
    };
    let variants = vec![
        variant("one row late", &|row| row.saturating_sub(1)),
        variant("one row early", &|row| (row + 1).min(last)),
    ];
    Some(plain(fitted, EffectId::Shifted, "row", variants))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarse_display_has_a_step() {
        let course: Vec<f64> = (0..60).map(|k| f64::from(k) * 0.013).collect();
        let shown = |step: f64, digit: f64, x: f64| {
            let shown = (x / step).round() * step;
            (shown / digit).round() * digit
        };
        let of =
            |step, digit| -> Vec<f64> { course.iter().map(|x| shown(step, digit, *x)).collect() };
        let found = steps(&of(0.05, 0.01)).unwrap();
        assert!((found.step - 0.05).abs() < 1e-9 && found.origin == 0.0);
        // A step of many digits, in a file of few.
        let found = steps(&of(0.023_47, 1e-3)).unwrap();
        assert!((found.step - 0.023_47).abs() < 1e-4, "{found:?}");
        let fine: Vec<f64> = course.iter().map(|x| libm::sin(37.0 * x)).collect();
        assert_eq!(steps(&fine), None);
        let digits: Vec<f64> = fine.iter().map(|x| (x * 1e5).round() / 1e5).collect();
        assert_eq!(steps(&digits), None);
    }
}
