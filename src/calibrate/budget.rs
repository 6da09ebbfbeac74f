//! Coefficients as the measurands of a budget file.
//!
//! Near its estimate a coefficient is the sum of what each error does to it: estimate + Σ c·e. The file
//! says so with the errors as inputs, so that `gumption eval` finds the same standard uncertainty by both
//! methods, and the covariances of coefficients that share a file.

use std::fmt::Write;

use super::calibration::Calibration;
use super::causes::{Cause, Origin};
use super::experiment::{Doubt, Experiment, Scope};
use crate::budget::writing::{key, quoted};
use crate::distribution::Distribution;
use crate::quantity::Unit;

/// More errors of one cause than these are summed up as one, of normal distribution.
const LONGEST: usize = 100;

/// A budget file whose measurands are some of the coefficients, by their places.
pub fn budget(experiment: &Experiment, found: &Calibration, coefficients: &[usize]) -> String {
    let figures = &found.figures;
    let coefficients: Vec<usize> = coefficients
        .iter()
        .copied()
        .filter(|index| *index < figures.coefficients.len())
        .collect();
    let mut text = head(experiment, found, &coefficients);
    let inputs: Vec<InputOfCause> = figures
        .causes
        .iter()
        .enumerate()
        .filter(|(_, cause)| {
            coefficients
                .iter()
                .any(|index| cause.contribution(*index) > 0.0)
        })
        .flat_map(|(number, cause)| {
            InputOfCause::of(experiment, found, cause, number, &coefficients)
        })
        .collect();
    for index in &coefficients {
        measurand(&mut text, found, *index, &inputs);
    }
    for input in &inputs {
        text += &input.text;
    }
    text
}

fn head(experiment: &Experiment, found: &Calibration, coefficients: &[usize]) -> String {
    let names: Vec<&str> = coefficients
        .iter()
        .map(|index| found.figures.coefficients[*index].name.as_str())
        .collect();
    let title = &experiment.heading.title.en;
    let title = if title.is_empty() {
        "Calibration"
    } else {
        title
    };
    let mut text = String::from(
        "# Written by `gumption calibrate`: coefficients, linear in the errors of the calibration.\n",
    );
    let mut line = |key: &str, value: &str| {
        let _ = writeln!(text, "{key} = {}", quoted(value));
    };
    line("title", &format!("{title}: {}", names.join(", ")));
    let heading = &experiment.heading;
    for (key, value) in [
        ("object", &heading.object),
        ("author", &heading.author),
        ("date", &heading.date),
        ("reference", &heading.reference),
    ] {
        if let Some(value) = value {
            line(key, value);
        }
    }
    let p = experiment.coverage_probability;
    let _ = write!(
        text,
        "\n[conventions]\ncoverage_probability = {p:?}\nt_scale = \"standard-deviation\"\n"
    );
    let mut own = experiment.own_units.clone();
    own.sort();
    if !own.is_empty() {
        text += "\n[unit]\n";
        for (name, definition) in own {
            let _ = writeln!(text, "{} = {}", quoted(&name), quoted(&definition));
        }
    }
    text
}

fn measurand(text: &mut String, found: &Calibration, index: usize, inputs: &[InputOfCause]) {
    let one = &found.figures.coefficients[index];
    let estimate = format!("{}_fitted", one.name);
    let mut model = estimate.clone();
    for input in inputs {
        if let Some((_, term)) = input.terms.iter().find(|(own, _)| *own == index) {
            model += " + ";
            model += term;
        }
    }
    let unit = unit_line(&one.unit);
    let description = one.description.as_ref().map_or(String::new(), |words| {
        format!("description = {}\n", quoted(&words.en))
    });
    let _ = write!(
        text,
        "\n[measurand.{}]\nmodel = {}\n{unit}{description}\n[constant.{estimate}]\nvalue = {:?}\n{unit}",
        key(&one.name),
        quoted(&model),
        one.value
    );
}

/// A cause as an input, with the term that it adds to each coefficient.
struct InputOfCause {
    terms: Vec<(usize, String)>,
    text: String,
}

impl InputOfCause {
    /// The input of a cause; scatter that is not one error for all coefficients has one for each
    /// coefficient, tied to the others by its covariance.
    fn of(
        experiment: &Experiment,
        found: &Calibration,
        cause: &Cause,
        number: usize,
        coefficients: &[usize],
    ) -> Vec<InputOfCause> {
        let doubt = doubt_of(experiment, cause);
        let name = name_of(cause, number);
        match (doubt, cause.effects.ncols()) {
            (Some(doubt), 1) => vec![single(found, cause, doubt, &name, coefficients)],
            (Some(doubt), count) if count <= LONGEST && doubt.dof.is_infinite() => {
                vec![vector(found, cause, doubt, &name, coefficients)]
            }
            _ => independent(found, cause, &name, coefficients),
        }
    }
}

fn doubt_of<'e>(experiment: &'e Experiment, cause: &Cause) -> Option<&'e Doubt> {
    let Origin::Stated { name, .. } = &cause.origin else {
        return None;
    };
    experiment
        .doubts
        .iter()
        .find(|doubt| doubt.name == *name && doubt.u > 0.0)
}

/// One error that acts on all coefficients.
fn single(
    found: &Calibration,
    cause: &Cause,
    doubt: &Doubt,
    name: &str,
    coefficients: &[usize],
) -> InputOfCause {
    let mut text = String::new();
    let mut terms = Vec::new();
    for index in coefficients {
        let effect = cause.effects[(*index, 0)];
        if effect == 0.0 {
            continue;
        }
        let one = &found.figures.coefficients[*index];
        let slope = format!("{}_by_{name}", one.name);
        let unit = unit_line(&quotient(&one.unit, &doubt.unit));
        let _ = write!(
            text,
            "\n[constant.{}]\nvalue = {:?}\n{unit}",
            key(&slope),
            effect / doubt.u
        );
        terms.push((*index, format!("{slope} * {name}")));
    }
    let unit = unit_line(&doubt.unit);
    let width = width(&doubt.distribution, doubt.u, doubt.dof);
    let _ = write!(text, "\n[input.{}]\nvalue = 0\n{unit}{width}", key(name));
    InputOfCause { terms, text }
}

/// Independent errors of the points.
fn vector(
    found: &Calibration,
    cause: &Cause,
    doubt: &Doubt,
    name: &str,
    coefficients: &[usize],
) -> InputOfCause {
    let mut text = String::new();
    let mut terms = Vec::new();
    for index in coefficients {
        if cause.contribution(*index) == 0.0 {
            continue;
        }
        let one = &found.figures.coefficients[*index];
        let slope = format!("{}_by_{name}", one.name);
        let values: Vec<String> = cause
            .effects
            .row(*index)
            .iter()
            .map(|effect| format!("{:?}", effect / doubt.u))
            .collect();
        let unit = unit_line(&quotient(&one.unit, &doubt.unit));
        let _ = write!(
            text,
            "\n[constant.{}]\nvalues = [{}]\n{unit}",
            key(&slope),
            values.join(", ")
        );
        terms.push((*index, format!("dot({slope}, {name})")));
    }
    let zeros = vec!["0"; cause.effects.ncols()].join(", ");
    let unit = unit_line(&doubt.unit);
    let width = width(&doubt.distribution, doubt.u, doubt.dof);
    let _ = write!(
        text,
        "\n[input.{}]\nvalues = [{zeros}]\n{unit}{width}",
        key(name)
    );
    InputOfCause { terms, text }
}

/// Many errors, summed up: independent normal variables, of which each coefficient takes its part by the
/// Cholesky factor of the covariance matrix that the cause makes.
fn independent(
    found: &Calibration,
    cause: &Cause,
    name: &str,
    coefficients: &[usize],
) -> Vec<InputOfCause> {
    let rows = cause.effects.select_rows(coefficients);
    let covariance = &rows * rows.transpose();
    let factor = lower_factor(&covariance);
    let mut inputs = Vec::new();
    for column in 0..coefficients.len() {
        let entries: Vec<(usize, f64)> = (0..coefficients.len())
            .map(|row| (coefficients[row], factor[(row, column)]))
            .filter(|(_, entry)| *entry != 0.0)
            .collect();
        if entries.is_empty() {
            continue;
        }
        let name = if coefficients.len() == 1 {
            name.to_owned()
        } else {
            format!("{name}_{}", column + 1)
        };
        let mut text = String::new();
        let mut terms = Vec::new();
        for (index, entry) in entries {
            let one = &found.figures.coefficients[index];
            let part = format!("{}_by_{name}", one.name);
            let unit = unit_line(&one.unit);
            let _ = write!(
                text,
                "\n[constant.{}]\nvalue = {entry:?}\n{unit}",
                key(&part)
            );
            terms.push((index, format!("{part} * {name}")));
        }
        let dof = cause.contribution_dof(coefficients[column]);
        let normal = Distribution::Normal { mean: 0.0, sd: 1.0 };
        let width = width(&normal, 1.0, dof);
        let _ = write!(text, "\n[input.{}]\nvalue = 0\n{width}", key(&name));
        inputs.push(InputOfCause { terms, text });
    }
    inputs
}

/// Cholesky factor of a matrix that may be singular.
fn lower_factor(matrix: &nalgebra::DMatrix<f64>) -> nalgebra::DMatrix<f64> {
    let n = matrix.nrows();
    let mut factor = nalgebra::DMatrix::<f64>::zeros(n, n);
    for column in 0..n {
        let own: f64 = (0..column).map(|k| factor[(column, k)].powi(2)).sum();
        let rest = matrix[(column, column)] - own;
        if rest <= 1e-12 * matrix[(column, column)] {
            continue;
        }
        let pivot = rest.sqrt();
        factor[(column, column)] = pivot;
        for row in column + 1..n {
            let sum: f64 = (0..column)
                .map(|k| factor[(row, k)] * factor[(column, k)])
                .sum();
            factor[(row, column)] = (matrix[(row, column)] - sum) / pivot;
        }
    }
    factor
}

/// The keys that state how wide an error is spread.
fn width(distribution: &Distribution, u: f64, dof: f64) -> String {
    let half_width = |half: f64, shape: &str| format!("half_width = {half:?}\n{shape}");
    match distribution {
        Distribution::Uniform { lower, upper } => half_width(0.5 * (upper - lower), ""),
        Distribution::Triangular { lower, mode, upper }
            if (lower + upper - 2.0 * mode).abs() <= 1e-12 * (upper - lower) =>
        {
            half_width(0.5 * (upper - lower), "distribution = \"triangular\"\n")
        }
        Distribution::Arcsine { lower, upper } => {
            half_width(0.5 * (upper - lower), "distribution = \"arcsine\"\n")
        }
        _ if dof.is_infinite() => format!("u = {u:?}\n"),
        // A t distribution of so few degrees of freedom has no standard deviation for Monte Carlo.
        _ if dof <= 2.0 => format!("u = {u:?}\ndof = {dof:?}\ndistribution = \"normal\"\n"),
        _ => format!("u = {u:?}\ndof = {dof:?}\n"),
    }
}

fn quotient(unit: &Unit, by: &Unit) -> Unit {
    if by.is_one() {
        unit.clone()
    } else {
        unit.quotient(by)
    }
}

fn unit_line(unit: &Unit) -> String {
    if unit.is_one() {
        String::new()
    } else {
        format!("unit = {}\n", quoted(&unit.symbol))
    }
}

/// A name for a cause that a model can use.
fn name_of(cause: &Cause, number: usize) -> String {
    let (prefix, name) = match &cause.origin {
        Origin::Stated { name, scope } => match scope {
            Scope::Common => ("error_of_", name),
            Scope::Each | Scope::By(_) => ("errors_of_", name),
        },
        Origin::Residuals { response } => ("scatter_of_", response),
        Origin::Samples { column } => ("samples_of_", column),
        Origin::Prior { parameter } => ("knowledge_of_", parameter),
    };
    let name = name.strip_prefix("e_").unwrap_or(name);
    let letters = name
        .chars()
        .map(|c| if c.is_alphanumeric() { c } else { '_' });
    let name: String = letters.collect();
    let name = name.trim_matches('_');
    if name.is_empty() {
        format!("{prefix}{number}")
    } else {
        format!("{prefix}{name}")
    }
}
