//! A statement as claims: what an audit computes again.

use crate::claim::{Claimed, Correlation, Coverage, Row, Stated, Understood};
use crate::printed::{Place, Printed};
use crate::read::symbol_at;
use gumption_core::special::{normal_two_sided_quantile, student_t_two_sided_quantile};
use gumption_core::statistics::mean_and_deviation;

use super::statement::{Equation, Input, Known, Part, Statement, uses};

/// A claim for each result.
pub fn claims(statement: &Statement) -> Vec<Claimed> {
    let one = |result: &Equation| claim(statement, result);
    statement.results().map(one).collect()
}

fn claim(statement: &Statement, result: &Equation) -> Claimed {
    let formula = statement.whole_formula(result);
    let has_units = statement.inputs.iter().any(|input| !input.unit.is_empty());
    let mut rows: Vec<Row> = Vec::new();
    let mut first = Vec::new();
    for input in &statement.inputs {
        first.push((input.name.as_str(), rows.len()));
        if uses(&formula, &input.name) {
            let is_correlated = statement
                .correlations
                .iter()
                .any(|(a, b, _)| *a == input.name || *b == input.name);
            rows.extend(self::rows(input, is_correlated, has_units));
        }
    }
    let place = |name: &str| {
        let (_, row) = first.iter().find(|(input, _)| *input == name)?;
        rows.get(*row)
            .filter(|found| found.symbol == name)
            .map(|_| *row)
    };
    let correlations = statement.correlations.iter().filter_map(|(a, b, r)| {
        let (a, b, r) = (place(a)?, place(b)?, *r);
        Some(Correlation { a, b, r, open: 0.0 })
    });
    let unit = if has_units && result.unit.is_empty() {
        "1"
    } else {
        &result.unit
    };
    let (line, column) = result.at;
    Claimed {
        title: statement.title.clone(),
        measurand: result.name.clone(),
        unit: unit.into(),
        correlations: correlations.collect(),
        coverage: statement.factor.map_or(Coverage::Unstated, Coverage::Fixed),
        footer: statement.computed.clone(),
        understood: vec![Understood {
            at: Place {
                sheet: 0,
                row: line.saturating_sub(1),
                column: column.saturating_sub(1),
            },
            text: format!("{} = {formula}", result.name),
            role: "model",
        }],
        model: Some(formula),
        rows,
        ..Claimed::default()
    }
}

/// A row for each reason for doubt; a single one where correlations are of the input as a whole.
fn rows(input: &Input, is_correlated: bool, has_units: bool) -> Vec<Row> {
    let unit = if has_units && input.unit.is_empty() {
        "1"
    } else {
        &input.unit
    };
    let figure = |x: f64| {
        let mut figure = Printed::exact(x, &x.to_string());
        figure.unit = unit.into();
        figure
    };
    let row = |name: &str, stated: Stated| Row {
        symbol: input.name.clone(),
        name: name.into(),
        words: name.into(),
        unit: unit.into(),
        value: input.value.map(figure),
        stated,
        ..Row::default()
    };
    let standard = |u: f64, dof: Option<f64>| Stated::Standard { u: figure(u), dof };
    match input.parts.as_slice() {
        // A constant is no reason for doubt, but the model uses it.
        [] => vec![row(&input.description, standard(0.0, None))],
        [_, _, ..] if is_correlated => {
            let (u, dof) = input.together();
            vec![row(
                &input.description,
                standard(u, Some(dof).filter(|dof| dof.is_finite())),
            )]
        }
        parts => parts
            .iter()
            .map(|part| {
                let name = match (input.description.as_str(), part.name.as_str()) {
                    (whole, "") | ("", whole) => whole.to_string(),
                    (whole, part) => format!("{whole}: {part}"),
                };
                // Limits and steps are stated without theirs.
                let dof = match part.known {
                    Known::Limits(..) | Known::Step(_) => part.dof,
                    _ => None,
                };
                Row {
                    dof: dof.map(|dof| Printed::exact(dof, &dof.to_string())),
                    ..row(&name, part.stated(&figure))
                }
            })
            .collect(),
    }
}

impl Input {
    /// Standard uncertainty and degrees of freedom of all parts together.
    fn together(&self) -> (f64, f64) {
        let parts: Vec<(f64, f64)> = self.parts.iter().map(Part::standard).collect();
        let square: f64 = parts.iter().map(|(u, _)| u * u).sum();
        let fourth: f64 = parts.iter().map(|(u, dof)| u * u * u * u / dof).sum();
        (libm::sqrt(square), square * square / fourth)
    }
}

impl Part {
    /// Standard uncertainty and degrees of freedom.
    fn standard(&self) -> (f64, f64) {
        let zero = |x: f64| Printed::exact(x, "");
        let (u, dof) = self
            .stated(&zero)
            .standard()
            .unwrap_or((0.0, f64::INFINITY));
        (u, self.dof.unwrap_or(dof))
    }

    fn stated(&self, figure: &dyn Fn(f64) -> Printed) -> Stated {
        let standard = |u: f64| Stated::Standard {
            u: figure(u),
            dof: self.dof,
        };
        match &self.known {
            Known::Standard(u) => standard(*u),
            Known::Expanded(expanded, k) if self.dof.is_none() => Stated::Certificate {
                expanded: figure(*expanded),
                k: *k,
                k_stated: true,
            },
            Known::Expanded(expanded, k) => standard(expanded / k),
            Known::Covered(expanded, p) => standard(
                expanded
                    / match self.dof {
                        Some(dof) => student_t_two_sided_quantile(*p, dof),
                        None => normal_two_sided_quantile(*p),
                    },
            ),
            Known::Limits(half, shape) => Stated::Limits {
                half_width: figure(*half),
                shape: *shape,
                shape_stated: true,
            },
            // JCGM 101, 6.4.3.4.
            Known::VagueLimits(half, d) => standard(libm::sqrt(half * half / 3.0 + d * d / 9.0)),
            Known::Triangle(a, c, b) => {
                let square = (a * a + b * b + c * c - a * b - a * c - b * c) / 18.0;
                standard(libm::sqrt(square))
            }
            Known::Student(scale, nu) => standard(scale * libm::sqrt(nu / (nu - 2.0))),
            Known::Step(step) => Stated::Step {
                step: figure(*step),
            },
            Known::Readings(readings, of) => {
                let n = readings.len() as f64;
                Stated::Deviation {
                    s: figure(mean_and_deviation(readings).1),
                    n: Some(n),
                    m: of.unwrap_or(n),
                    pooled: None,
                }
            }
        }
    }
}

impl Statement {
    /// The formula of a result in its inputs alone.
    pub(super) fn whole_formula(&self, result: &Equation) -> String {
        let mut formula = result.formula.clone();
        let others = self.equations.iter().rev();
        for equation in others.filter(|other| other.name != result.name) {
            let mut from = 0;
            while let Some(at) = symbol_at(&formula, &equation.name, from) {
                // What grows beyond all bounds would do so further.
                if formula.len() > LONGEST {
                    return formula;
                }
                let inner = format!("({})", equation.formula);
                formula.replace_range(at..at + equation.name.len(), &inner);
                from = at + inner.len();
            }
        }
        formula
    }
}

/// Bytes of a formula.
const LONGEST: usize = 20_000;
