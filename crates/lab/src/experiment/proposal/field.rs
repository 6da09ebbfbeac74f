//! Three axes and nothing that was set: they may have been turned in a field that stays.

use gumption_fault::language::Language;
use gumption_fault::say;
use gumption_format::csv::{Column, Data};

use super::guess::Guess;

/// Whether three axes keep their length while each goes its way: it varies by less than a third as much as they do. Of three
/// that have nothing to do with each other it varies by half as much (uniform ones about zero) or by two thirds (normal ones).
pub(super) fn is_constant(outputs: &[&Guess<'_>]) -> bool {
    let columns = outputs.iter().map(|guess| guess.column);
    let axes: Option<Vec<&[f64]>> = columns.map(numbers).collect();
    let Some([x, y, z]) = axes.as_deref() else {
        return false;
    };
    let rows = x.iter().zip(*y).zip(*z);
    let length: Vec<f64> = rows
        .map(|((x, y), z)| libm::sqrt(x * x + y * y + z * z))
        .collect();
    let of_axes = [*x, *y, *z].map(variance).into_iter();
    let least = of_axes.fold(f64::INFINITY, f64::min);
    9.0 * variance(&length) < least
}

fn numbers(column: &Column) -> Option<&[f64]> {
    match &column.data {
        Data::Numbers(numbers) => Some(numbers),
        Data::Labels(_) => None,
    }
}

fn variance(of: &[f64]) -> f64 {
    let known = || of.iter().filter(|x| x.is_finite());
    let n = known().count() as f64;
    let mean = known().sum::<f64>() / n;
    known().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n
}

/// The equation of that field, as a comment.
pub(super) fn equation(x: &Guess<'_>, y: &Guess<'_>, z: &Guess<'_>, language: Language) -> String {
    let unit = x
        .column
        .unit
        .as_ref()
        .map_or_else(String::new, |unit| format!(" {}", unit.typeset()));
    let asked = say!("Turned in a field of constant strength F? Then the axes are stimuli, and");
    let accelerometers = say!(
        "an accelerometer triad that is turned by hand has a procedure: gumption new --recording … --procedure accelerometer-norm"
    );
    format!(
        "# {}\n\
         # equations = \"F = sqrt(({} - b1)^2 + ({} - b2)^2 + ({} - b3)^2)\"\n\
         # constant.F = \"…{unit}\"\n\
         # {}\n",
        asked.in_language(language),
        x.name,
        y.name,
        z.name,
        accelerometers.in_language(language)
    )
}
