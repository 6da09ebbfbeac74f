//! A statement as a budget file.

use std::fmt::Write as _;

use gumption_core::distribution::Entry;
use gumption_format::toml::writing::{self, key, line, quoted};

use crate::claim::Shape;
use crate::import::{comment, number, title};
use gumption_fault::language::Language;

use super::statement::{Equation, Input, Known, Part, Statement};

/// The budget file, with what a reader should know of the source as comments.
pub(crate) fn budget_file(statement: &Statement, language: Language) -> String {
    let title = title(&statement.title, language);
    let mut text = format!("title = {}\n", quoted(&title));
    for remark in &statement.remarks {
        let _ = writeln!(text, "# {}", comment(&remark.in_language(language)));
    }
    if let Some(k) = statement.factor {
        let _ = write!(text, "\n[conventions]\ncoverage_factor = {k:?}\n");
    }
    if statement.trials.is_some() || statement.seed.is_some() {
        text += "\n[monte_carlo]\n";
        let of = |key: &str, count: Option<u64>| {
            count.map_or(String::new(), |n| format!("{key} = {n}\n"))
        };
        text += &of("trials", statement.trials);
        text += &of("seed", statement.seed);
    }
    for result in statement.results() {
        text += &measurand(statement, result);
    }
    for input in &statement.inputs {
        text += &quantity(input);
    }
    for (a, b, r) in &statement.correlations {
        text += &writing::correlation([a, b], *r);
    }
    text
}

fn measurand(statement: &Statement, result: &Equation) -> String {
    let mut text = format!("\n[measurand.{}]\n", key(&result.name));
    text += &line("description", &result.description);
    let steps = statement.steps_of(result);
    if steps.is_empty() {
        let _ = writeln!(text, "model = {}", quoted(&result.formula));
    } else {
        let lines = steps
            .iter()
            .map(|step| format!("{} = {}\n", step.name, step.formula));
        let _ = writeln!(
            text,
            "model = \"\"\"\n{}{}\"\"\"",
            lines.collect::<String>(),
            result.formula
        );
    }
    text + &line("unit", &result.unit)
}

fn quantity(input: &Input) -> String {
    let table = if input.parts.is_empty() {
        "constant"
    } else {
        "input"
    };
    let mut text = format!("\n[{table}.{}]\n", key(&input.name));
    text += &line("description", &input.description);
    // Readings give their mean themselves.
    let from_readings = input
        .parts
        .iter()
        .any(|part| matches!(part.known, Known::Readings(_, None)));
    if let Some(value) = input.value.filter(|_| !from_readings) {
        let _ = writeln!(text, "value = {}", writing::number(value));
    }
    text += &line("unit", &input.unit);
    match input.parts.as_slice() {
        [] => {}
        [part] => {
            for line in part.lines() {
                let _ = writeln!(text, "{line}");
            }
        }
        parts => {
            text += "components = [\n";
            for part in parts {
                let _ = writeln!(text, "  {{ {} }},", part.lines().join(", "));
            }
            text += "]\n";
        }
    }
    text
}

impl Part {
    /// Its keys with their values.
    fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if !self.name.is_empty() {
            lines.push(format!("name = {}", quoted(&self.name)));
        }
        let mut dof = self.dof;
        let key = |key: &str, x: f64| format!("{key} = {}", number(x));
        let shaped = |name: &str| {
            let key = Entry::named(name).map_or(name, |entry| entry.kind.key);
            format!("distribution = {}", quoted(key))
        };
        lines.extend(match &self.known {
            Known::Standard(u) => vec![key("u", *u)],
            Known::Expanded(expanded, k) if dof.is_some() => vec![key("u", expanded / k)],
            Known::Expanded(expanded, k) => {
                vec![format!(
                    "certificate = {{ {}, k = {k:?} }}",
                    key("U", *expanded)
                )]
            }
            Known::Covered(expanded, p) => {
                let dof = dof
                    .take()
                    .map_or(String::new(), |dof| format!(", {}", key("dof", dof)));
                vec![format!(
                    "certificate = {{ {}, p = {p}{dof} }}",
                    key("U", *expanded)
                )]
            }
            Known::Limits(half, Shape::Triangular) => {
                vec![key("half_width", *half), shaped("triangular")]
            }
            Known::Limits(half, Shape::Arcsine) => {
                vec![key("half_width", *half), shaped("arcsine")]
            }
            Known::Limits(half, _) => vec![key("half_width", *half)],
            Known::VagueLimits(half, d) => {
                vec![key("half_width", *half), shaped("ctrap"), key("d", *d)]
            }
            Known::Triangle(lower, mode, upper) => {
                let limits = [
                    key("lower", *lower),
                    key("mode", *mode),
                    key("upper", *upper),
                ]
                .join(", ");
                vec![format!("distribution = {{ triangular = {{ {limits} }} }}")]
            }
            Known::Student(scale, nu) => {
                let parameters = [key("scale", *scale), key("dof", *nu)].join(", ");
                vec![format!("distribution = {{ t = {{ {parameters} }} }}")]
            }
            Known::Step(step) => vec![key("step", *step)],
            Known::Readings(readings, of) => {
                let list: Vec<String> = readings.iter().map(|x| writing::number(*x)).collect();
                let of = of.map(|of| match of {
                    1.0 => "of = \"single\"".into(),
                    m => format!("of = {m}"),
                });
                [format!("readings = [{}]", list.join(", "))]
                    .into_iter()
                    .chain(of)
                    .collect()
            }
        });
        if let Some(dof) = dof {
            lines.push(format!("dof = {}", number(dof)));
        }
        lines
    }
}
