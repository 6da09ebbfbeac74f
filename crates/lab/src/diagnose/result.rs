//! The parameters as the measurands of a budget: their fit, and a line for each effect that may be there
//! unseen and for each choice between explanations.
//!
//! Each line is one error that moves all parameters: uniform between −1 and 1, in units of the usual size of
//! the effect, times what it does to each parameter as far as the recording leaves it open.

use std::fmt::Write;

use super::case::Case;
use super::confirm::{self, Estimated};
use super::design::{Design, UnknownKind};
use super::fit::Fit;
use super::improved::title;
use super::omitted::Omitted;
use super::run::Diagnosis;
use crate::experiment::written::{own_units, unit_line};
use gumption_core::quantity::Unit;
use gumption_format::toml::writing::{key, quoted};

/// Lines that are smaller than this part of every parameter's u are left out.
const MATTERS: f64 = 0.01;

/// The budget file of the parameters of a diagnosed case, with the adopted physics in the model if there
/// is any; `None` for a model without parameters.
pub fn budget(case: &Case, diagnosis: &Diagnosis) -> Option<String> {
    let (model, fit) = match &diagnosis.adopted {
        Some(adopted) => (&adopted.extended.case, &adopted.fit),
        None => (case, &diagnosis.fit),
    };
    let estimates = diagnosis.estimates();
    let design = Design::new(model);
    let results = results(&design, estimates);
    if results.is_empty() {
        return None;
    }
    // What correlates has degrees of freedom in common: the fewest.
    let dofs = estimates.iter().map(|estimate| estimate.dof);
    let dof = dofs.fold(f64::INFINITY, f64::min);
    let mut text = String::from(
        "# Written by `gumption diagnose`: the parameters, with what may be there unseen.\n",
    );
    text += &title(case, &case.title);
    text += &own_units(&case.own_units);
    let lines = lines(diagnosis, estimates);
    for result in &results {
        measurand(&mut text, result, &lines);
    }
    for result in &results {
        input(&mut text, result, dof);
    }
    for line in &lines {
        let (name, description) = (&line.name, quoted(&line.description));
        text += &format!("\n[input.{name}]\ndescription = {description}\n");
        text += "value = 0\nhalf_width = 1\n";
    }
    Some(text + &correlations(&design, fit, diagnosis, &results))
}

/// A parameter that is reported.
struct ResultOf<'r> {
    /// Its name in formulas.
    name: String,
    /// Its place among the estimates.
    place: usize,
    unit: Unit,
    estimate: &'r Estimated,
}

fn results<'r>(design: &Design<'_>, estimates: &'r [Estimated]) -> Vec<ResultOf<'r>> {
    let of = |(place, estimate): (usize, &'r Estimated)| {
        let unknown = &design.unknowns[design.named(&estimate.name)?];
        let UnknownKind::Parameter(parameter) = unknown.kind else {
            return None;
        };
        Some(ResultOf {
            name: identifier(&estimate.name),
            place,
            unit: design.case.parameters[parameter].unit.clone(),
            estimate,
        })
    };
    estimates.iter().enumerate().filter_map(of).collect()
}

/// A name that formulas accept: `offset[run 1]` becomes `offset_run_1`.
fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() { c } else { '_' };
    let text: String = name.chars().map(plain).collect();
    text.trim_end_matches('_').to_owned()
}

/// One line of the budget.
struct Line {
    name: String,
    description: String,
    /// What an error of one does to each estimate, in its unit.
    slopes: Vec<f64>,
}

fn lines(diagnosis: &Diagnosis, estimates: &[Estimated]) -> Vec<Line> {
    let u: Vec<f64> = estimates.iter().map(|estimate| estimate.u).collect();
    let matters = |costs: &[f64]| costs.iter().zip(&u).any(|(cost, u)| *cost > MATTERS * u);
    let unseen = diagnosis.omitted.iter();
    let unseen = unseen.filter(|line| line.shift.is_some() && matters(&line.after.u));
    let mut lines: Vec<Line> = unseen
        .enumerate()
        .map(|(at, line)| of_effect(diagnosis, line, at + 1))
        .collect();
    let choices = diagnosis.choices.iter().enumerate();
    for (at, choice) in choices.filter(|(_, u)| matters(u)) {
        lines.push(Line {
            name: format!("choice_{}", at + 1),
            description: "which of several explanations is right".to_owned(),
            slopes: choice.iter().map(|u| u * 3.0_f64.sqrt()).collect(),
        });
    }
    lines
}

fn of_effect(diagnosis: &Diagnosis, line: &Omitted, number: usize) -> Line {
    let cell = &diagnosis.cells[line.cell];
    let name = cell.words.fill(&cell.effect.name.en);
    let variant = match cell.variants[line.variation].label.as_str() {
        "" => String::new(),
        label => format!(" ({label})"),
    };
    let slopes = line.after.gain.iter().zip(&line.after.u);
    Line {
        name: format!("unseen_{number}"),
        description: format!("{name}{variant}, in units of its usual size"),
        slopes: slopes
            .map(|(gain, u)| gain.signum() * u * 3.0_f64.sqrt())
            .collect(),
    }
}

fn measurand(text: &mut String, result: &ResultOf<'_>, lines: &[Line]) {
    let name = &result.name;
    let mut model = format!("{name}_fitted");
    let mut constants = String::new();
    for line in lines {
        let slope = line.slopes.get(result.place).copied().unwrap_or(0.0);
        // What rounding leaves of a symmetric design is no effect.
        if !slope.is_finite() || slope.abs() <= 1e-6 * result.estimate.u {
            continue;
        }
        let constant = format!("{name}_by_{}", line.name);
        let _ = write!(model, " + {constant} * {}", line.name);
        let _ = write!(
            constants,
            "\n[constant.{constant}]\nvalue = {slope:?}\n{}",
            unit_line(&result.unit.difference())
        );
    }
    let _ = write!(
        text,
        "\n[measurand.{}]\nmodel = {}\n{}{constants}",
        key(name),
        quoted(&model),
        unit_line(&result.unit)
    );
}

fn input(text: &mut String, result: &ResultOf<'_>, dof: f64) {
    let name = format!("{}_fitted", result.name);
    let estimate = result.estimate;
    let _ = write!(
        text,
        "\n[input.{}]\ndescription = \"fit to the recording\"\nvalue = {:?}\nu = {:?}\n{}",
        key(&name),
        estimate.value,
        estimate.u,
        unit_line(&result.unit)
    );
    if dof.is_finite() {
        let _ = writeln!(text, "dof = {dof:?}\ndistribution = \"normal\"");
    }
}

/// Correlations of the fitted parameters.
fn correlations(
    design: &Design<'_>,
    fit: &Fit,
    diagnosis: &Diagnosis,
    results: &[ResultOf<'_>],
) -> String {
    let place = |result: &ResultOf<'_>| design.named(&result.estimate.name);
    let covariance = confirm::covariance(design, fit, &diagnosis.noise);
    let covariance = match &diagnosis.adopted {
        Some(adopted) => adopted.shapes.with(covariance),
        None => covariance,
    };
    let mut text = String::new();
    for (at, a) in results.iter().enumerate() {
        for b in &results[at + 1..] {
            let (Some(i), Some(j)) = (place(a), place(b)) else {
                continue;
            };
            let r = covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
            if r.is_finite() && r.abs() > 1e-9 {
                let [a, b] = [a, b].map(|one| quoted(&format!("{}_fitted", one.name)));
                let r = r.clamp(-1.0, 1.0);
                let _ = write!(text, "\n[[correlation]]\nbetween = [{a}, {b}]\nr = {r:?}\n");
            }
        }
    }
    text
}
