//! Coefficients as the measurands of a budget file.
//!
//! Near its estimate a coefficient is the sum of what each error does to it: estimate + Σ c·e. The file
//! says so with the errors as inputs, so that `gumption eval` finds the same standard and expanded uncertainties, and the
//! covariances of coefficients that share a file.

use std::fmt::Write;

use super::calibration::Calibration;
use super::campaign::Campaign;
use super::cause::{Cause, Origin};
use super::coefficient::Coefficient;
use crate::experiment::written::{own_units, unit_line};
use crate::experiment::{Doubt, Scope};
use gumption_core::distribution::{Distribution, Normal, Uniform, Univariate};
use gumption_core::least_squares::lower_factor;
use gumption_core::quantity::{Unit, to_digits};
use gumption_fault::language::Language;
use gumption_format::toml::writing::{key, quoted};
use gumption_gum::budget::{Certificate, Evaluation};

/// More errors of one cause than these are summed up as one, of normal distribution.
const LONGEST: usize = 100;

/// A budget file whose measurands are some of the coefficients, by their places.
pub fn budget(
    campaign: &Campaign,
    found: &Calibration,
    coefficients: &[usize],
    language: Language,
) -> String {
    let figures = &found.figures;
    let coefficients: Vec<usize> = coefficients
        .iter()
        .copied()
        .filter(|index| *index < figures.coefficients.len())
        .collect();
    let mut text = head(campaign, language);
    let inputs: Vec<InputOfCause> = figures
        .causes
        .iter()
        .enumerate()
        .filter(|(_, cause)| {
            coefficients
                .iter()
                .any(|index| matters(cause.contribution(*index), &figures.coefficients[*index]))
        })
        .flat_map(|(number, cause)| inputs(campaign, found, (cause, number), &coefficients))
        .collect();
    for index in &coefficients {
        measurand(&mut text, found, *index, &inputs);
    }
    for input in &inputs {
        text += &input.text;
    }
    text
}

fn head(campaign: &Campaign, language: Language) -> String {
    let experiment = &campaign.experiment;
    let heading = &experiment.heading;
    let title = match language.pick(&heading.title.en, &heading.title.zh).as_str() {
        "" => language.pick("Calibration", "校准"),
        title => title,
    };
    let mut text = format!(
        "# {}\n",
        language.pick(
            "Written by `gumption calibrate`: coefficients, linear in the errors of the calibration.",
            "由 `gumption calibrate` 写出：各系数是校准误差的线性函数。",
        )
    );
    let mut line = |key: &str, value: &str| {
        let _ = writeln!(text, "{key} = {}", quoted(value));
    };
    line("title", title);
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
    let conventions = &experiment.conventions;
    line("profile", &conventions.profile);
    if !conventions.overrides.is_empty() {
        text += "\n[conventions]\n";
    }
    for stated in &conventions.overrides {
        let _ = writeln!(text, "{stated}");
    }
    let mut own = experiment.own_units.clone();
    own.sort();
    text + &own_units(&own)
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

/// A coefficient of a budget: its place in the calibration, and the coefficient itself.
type Place<'f> = (usize, &'f Coefficient);

/// The inputs of a cause; scatter that is not one error for all coefficients is a vector, of which they take their parts.
fn inputs(
    campaign: &Campaign,
    found: &Calibration,
    (cause, number): (&Cause, usize),
    coefficients: &[usize],
) -> Vec<InputOfCause> {
    let of_place = |index: &usize| (*index, &found.figures.coefficients[*index]);
    let places: Vec<Place<'_>> = coefficients.iter().map(of_place).collect();
    let name = name_of(cause, number);
    let count = cause.effects.ncols();
    match doubt_of(campaign, cause) {
        Some(doubt) if count == 1 || (count <= LONGEST && doubt.dof.is_infinite()) => {
            vec![stated(cause, doubt, &name, &places)]
        }
        _ if cause.dof.len() == count && (2..=LONGEST).contains(&count) => {
            with_own_dof(cause, &name, &places)
        }
        _ => vec![independent(cause, &name, &places)],
    }
}

/// Errors of which each has degrees of freedom of its own, as the averages of dwells have: a vector for those that have as many, of
/// which each is stated by itself.
fn with_own_dof(cause: &Cause, name: &str, places: &[Place<'_>]) -> Vec<InputOfCause> {
    let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
    for (column, dof) in cause.dof.iter().map(|dof| counted(*dof)).enumerate() {
        match groups.iter_mut().find(|(own, _)| *own == dof) {
            Some((_, columns)) => columns.push(column),
            None => groups.push((dof, vec![column])),
        }
    }
    let is_alone = groups.len() == 1;
    let input = |(number, (dof, columns)): (usize, (f64, Vec<usize>))| {
        let name = match is_alone {
            true => name.to_owned(),
            false => format!("{name}_{}", number + 1),
        };
        let mut input = InputOfCause {
            terms: Vec::new(),
            text: String::new(),
        };
        for (index, one) in places {
            let slopes = columns
                .iter()
                .map(|column| cause.effects[(*index, *column)]);
            let slopes: Vec<f64> = slopes.collect();
            if slopes.iter().any(|slope| matters(*slope, one)) {
                input.act((*index, one), &slopes, &name, &one.unit.difference());
            }
        }
        let mut width = match columns.as_slice() {
            [_] => "u = 1.0\n".to_owned(),
            columns => format!("u = [{}]\n", vec!["1.0"; columns.len()].join(", ")),
        };
        if dof.is_finite() {
            let _ = writeln!(width, "dof = {dof:?}");
        }
        width += type_line(cause.evaluation, &width);
        let _ = write!(
            input.text,
            "\n[input.{}]\n{}\n{width}",
            key(&name),
            zeros(columns.len())
        );
        input
    };
    let inputs = groups.into_iter().enumerate().map(input);
    inputs.filter(|input| !input.terms.is_empty()).collect()
}

impl InputOfCause {
    /// Adds what errors of the name `errors` do to a coefficient, per unit of each of them.
    fn act(&mut self, (index, one): Place<'_>, slopes: &[f64], errors: &str, unit: &Unit) {
        let name = format!("{}_by_{errors}", one.name);
        let (values, term) = match slopes {
            [slope] => (format!("value = {slope:?}"), format!("{name} * {errors}")),
            slopes => (
                format!("values = {slopes:?}"),
                format!("dot({name}, {errors})"),
            ),
        };
        let unit = unit_line(unit);
        let _ = write!(self.text, "\n[constant.{}]\n{values}\n{unit}", key(&name));
        self.terms.push((index, term));
    }
}

fn doubt_of<'e>(campaign: &'e Campaign, cause: &Cause) -> Option<&'e Doubt> {
    let Origin::Stated { name, .. } = &cause.origin else {
        return None;
    };
    campaign
        .experiment
        .doubts
        .iter()
        .find(|doubt| doubt.name == *name && doubt.u > 0.0)
}

/// One error that acts on all coefficients, or the independent errors of the points.
fn stated(cause: &Cause, doubt: &Doubt, name: &str, places: &[Place<'_>]) -> InputOfCause {
    let mut input = InputOfCause {
        terms: Vec::new(),
        text: String::new(),
    };
    for (index, one) in places {
        if !matters(cause.contribution(*index), one) {
            continue;
        }
        let effects = cause.effects.row(*index);
        let slopes: Vec<f64> = effects.iter().map(|effect| effect / doubt.u).collect();
        input.act(
            (*index, one),
            &slopes,
            name,
            &quotient(&one.unit.difference(), &doubt.unit.difference()),
        );
    }
    let estimate = zeros(cause.effects.ncols());
    let unit = unit_line(&doubt.unit.difference());
    let mut width = width(&doubt.distribution, doubt.u, doubt.dof);
    width += type_line(doubt.evaluation, &width);
    width += &doubt
        .certificate
        .as_deref()
        .map_or_else(String::new, certificate_line);
    let _ = write!(
        input.text,
        "\n[input.{}]\n{estimate}\n{unit}{width}",
        key(name)
    );
    input
}

/// Many errors, summed up: independent variables, of which each coefficient takes its part by the Cholesky factor of the
/// covariance matrix that the cause makes. One s is behind all of them, as behind the scatter about a line: whatever
/// is formed of them has its degrees of freedom.
fn independent(cause: &Cause, name: &str, places: &[Place<'_>]) -> InputOfCause {
    let has_part = |(index, one): &Place<'_>| matters(cause.contribution(*index), one);
    let places: Vec<Place<'_>> = places.iter().copied().filter(has_part).collect();
    let indices: Vec<usize> = places.iter().map(|(index, _)| *index).collect();
    let rows = cause.effects.select_rows(&indices);
    let factor = lower_factor(&(&rows * rows.transpose()));
    let is_needed = |column: &usize| factor.column(*column).norm() > 0.0;
    let columns: Vec<usize> = (0..factor.ncols()).filter(is_needed).collect();
    let mut input = InputOfCause {
        terms: Vec::new(),
        text: String::new(),
    };
    for (row, place) in places.iter().enumerate() {
        let slopes: Vec<f64> = columns
            .iter()
            .map(|column| factor[(row, *column)])
            .collect();
        input.act(*place, &slopes, name, &place.1.unit.difference());
    }
    // Where each error has its own, the coefficients differ by a little; the least promises too much to none.
    let dofs = indices.iter().map(|index| cause.contribution_dof(*index));
    let normal = Distribution::Normal(Normal { mean: 0.0, sd: 1.0 });
    let mut width = width(&normal, 1.0, dofs.fold(f64::INFINITY, f64::min));
    width += type_line(cause.evaluation, &width);
    let _ = write!(
        input.text,
        "\n[input.{}]\n{}\n{width}",
        key(name),
        zeros(columns.len())
    );
    input
}

/// The estimate of so many errors.
fn zeros(count: usize) -> String {
    match count {
        1 => "value = 0".to_owned(),
        count => format!("values = [{}]", vec!["0"; count].join(", ")),
    }
}

/// Says of a stated u that it was evaluated from readings.
fn type_line(evaluation: Evaluation, width: &str) -> &'static str {
    match evaluation {
        Evaluation::TypeA if width.starts_with("u = ") => "type = \"A\"\n",
        _ => "",
    }
}

/// Where an uncertainty comes from.
fn certificate_line(certificate: &Certificate) -> String {
    let fields = [
        ("number", &certificate.number),
        ("laboratory", &certificate.laboratory),
        ("date", &certificate.date),
        ("due", &certificate.due),
    ];
    let stated: Vec<String> = fields
        .into_iter()
        .filter_map(|(key, text)| Some(format!("{key} = {}", quoted(text.as_ref()?))))
        .collect();
    match stated.as_slice() {
        [] => String::new(),
        stated => format!("certificate = {{ {} }}\n", stated.join(", ")),
    }
}

/// Contributions to a coefficient that are more than rounding errors.
fn matters(contribution: f64, one: &Coefficient) -> bool {
    contribution.abs() > 1e-12 * one.u
}

/// The keys that state how wide an error is spread.
fn width(distribution: &Distribution, u: f64, dof: f64) -> String {
    let shape = distribution.kind();
    match distribution.half_width() {
        // The shape that a half-width has where none is stated.
        Some(half) if *shape == Uniform::KIND => format!("half_width = {half:?}\n"),
        Some(half) => format!("half_width = {half:?}\ndistribution = \"{}\"\n", shape.key),
        _ if dof.is_infinite() => format!("u = {u:?}\n"),
        _ => format!("u = {u:?}\ndof = {:?}\n", counted(dof)),
    }
}

/// Degrees of freedom without what sums of doubles add: 31 in place of 30.999999999999996.
fn counted(dof: f64) -> f64 {
    to_digits(dof, 12)
}

fn quotient(unit: &Unit, by: &Unit) -> Unit {
    if by.is_one() {
        unit.clone()
    } else {
        unit.quotient(by)
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
    let words: Vec<&str> = name
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    let name = words.join("_");
    if name.is_empty() {
        format!("{prefix}{number}")
    } else {
        format!("{prefix}{name}")
    }
}
