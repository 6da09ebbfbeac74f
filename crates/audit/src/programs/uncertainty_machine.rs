//! The NIST Uncertainty Machine: lines `key=value`, inputs as `variableN=name;type;parameters…`, the model in R.

use gumption_fault::say;

use super::Program;
use super::formula::{Spelling, formula, name};
use super::numbers::{number, positive, whole};
use super::statement::{Equation, Input, Known, Part, Statement};
use super::trouble::{Piece, Trouble};
use crate::claim::Shape;

pub(super) const PROGRAM: Program = Program {
    name: "the NIST Uncertainty Machine",
    endings: &["um"],
    signs: &["nbVar=", "variable", "expression="],
    is_western: false,
    read,
};

/// R, as far as it is arithmetic.
const SPELLING: Spelling = Spelling {
    functions: &[("log", "ln"), ("log2", "log2")],
    ignores_case: false,
};

fn read(text: &str) -> Result<Vec<Statement>, Trouble> {
    let mut file = File::default();
    for line in Piece::lines(text).map(Piece::trimmed) {
        if !line.text.is_empty() {
            file.take(line)?;
        }
    }
    file.statement().map(|statement| vec![statement])
}

#[derive(Default)]
struct File<'t> {
    inputs: Vec<Input>,
    lines: Vec<Piece<'t>>,
    count: Option<Piece<'t>>,
    trials: Option<u64>,
    seed: Option<u64>,
    is_correlated: bool,
    is_t: bool,
    correlations: Option<Piece<'t>>,
}

impl<'t> File<'t> {
    fn take(&mut self, line: Piece<'t>) -> Result<(), Trouble> {
        let Some((key, value)) = line.split_once('=') else {
            return Err(line.trouble(say!("`key=value` was expected here")));
        };
        match key.text {
            // How results are shown, and where they are kept, is no part of a budget.
            "version" | "outputFile" | "symmetrical" => {}
            "copulaValue" => {}
            "seed" => self.seed = Some(whole(value)?),
            "nbVar" => self.count = Some(value),
            "nbReal" => self.trials = Some(whole(value)?),
            "expression" => self.lines.push(value),
            "correlation" => self.is_correlated = truth(value)?,
            "copula" => self.is_t = whole(value)? != 0,
            "correlationValue" => self.correlations = Some(value),
            other if other.starts_with("variable") => self.inputs.push(variable(value)?),
            other => return Err(key.trouble(say!("the key `{other}` is not understood"))),
        }
        Ok(())
    }

    fn statement(self) -> Result<Statement, Trouble> {
        let nowhere = Piece {
            text: "",
            line: 1,
            column: 1,
        };
        if let Some(count) = self.count
            && whole(count)? != self.inputs.len() as u64
        {
            let (said, found) = (count.text, self.inputs.len());
            return Err(count.trouble(say!(
                "{said} variables are announced, and {found} stand in the file"
            )));
        }
        let mut statement = Statement {
            correlations: self.correlations()?,
            trials: self.trials,
            seed: self.seed,
            equations: equations(&self.lines, &self.inputs, nowhere)?,
            inputs: self.inputs,
            ..Statement::default()
        };
        if self.is_correlated && self.is_t {
            statement.remarks.push(
                say!("The source joins its inputs by a t copula; here they are joined by the correlation coefficients alone."),
            );
        }
        statement.in_order()
    }

    /// The upper triangle of the matrix, row by row.
    fn correlations(&self) -> Result<Vec<(String, String, f64)>, Trouble> {
        let Some(piece) = self.correlations.filter(|_| self.is_correlated) else {
            return Ok(Vec::new());
        };
        let values: Vec<Piece<'_>> = piece
            .split(';')
            .into_iter()
            .filter(|value| !value.text.is_empty())
            .collect();
        let n = self.inputs.len();
        let wanted = n * n.saturating_sub(1) / 2;
        if values.len() != wanted {
            let found = values.len();
            return Err(piece.trouble(say!(
                "{wanted} coefficients were expected, one for each pair of variables, and {found} stand here"
            )));
        }
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let mut found = Vec::new();
        for ((i, j), value) in pairs.zip(values) {
            let r = number(value)?;
            if r != 0.0 {
                found.push((self.inputs[i].name.clone(), self.inputs[j].name.clone(), r));
            }
        }
        Ok(found)
    }
}

fn truth(piece: Piece<'_>) -> Result<bool, Trouble> {
    match piece.text.to_lowercase().as_str() {
        "true" | "1" => Ok(true),
        "false" | "0" | "" => Ok(false),
        _ => Err(piece.trouble(say!("true or false was expected here"))),
    }
}

/// `name;type;parameters…`.
fn variable(value: Piece<'_>) -> Result<Input, Trouble> {
    let parts = value.split(';');
    let [title, kind, parameters @ ..] = parts.as_slice() else {
        return Err(value.trouble(say!("`name;type;parameters` was expected here")));
    };
    let parameters: Vec<Piece<'_>> = parameters
        .iter()
        .filter(|p| !p.text.is_empty())
        .copied()
        .collect();
    let wanted = |n: usize| {
        if parameters.len() == n {
            return Ok(());
        }
        let (kind, found) = (kind.text, parameters.len());
        Err(value.trouble(say!(
            "type {kind} has {n} parameters, and {found} stand here"
        )))
    };
    let code = whole(*kind)?;
    wanted(match code {
        20 => 1,
        7 | 9 | 10 | 13 | 14 | 16 | 17 => 2,
        11 | 12 | 15 => 3,
        _ => {
            return Err(kind.trouble(say!(
                "the distribution of type {code} is not read; known are 7 (normal), 9, 10, 16, 17 (rectangular), 11, 12 (t), 13 to 15 (triangular), 20 (constant)"
            )));
        }
    })?;
    let at = |i: usize| parameters.get(i).copied().unwrap_or(value);
    let first = number(at(0))?;
    let root = |square: f64, shape: Shape| -> Result<(f64, Option<Known>), Trouble> {
        // The half-width that gives the standard deviation.
        Ok((
            first,
            Some(Known::Limits(positive(at(1))? * libm::sqrt(square), shape)),
        ))
    };
    let limits = |last: usize| -> Result<f64, Trouble> {
        let upper = number(at(last))?;
        if upper > first {
            return Ok(upper);
        }
        Err(at(last).trouble(say!("the right limit must be above the left one")))
    };
    let (estimate, known) = match code {
        20 => (first, None),
        7 => (first, Some(Known::Standard(positive(at(1))?))),
        9 | 16 => root(3.0, Shape::Rectangular)?,
        13 => root(6.0, Shape::Triangular)?,
        10 | 17 | 14 => {
            let upper = limits(1)?;
            let shape = if code == 14 {
                Shape::Triangular
            } else {
                Shape::Rectangular
            };
            (
                0.5 * (first + upper),
                Some(Known::Limits(0.5 * (upper - first), shape)),
            )
        }
        15 => {
            let (mode, upper) = (number(at(1))?, limits(2)?);
            if !(first..=upper).contains(&mode) {
                return Err(at(1).trouble(say!("the most likely value must be between the limits")));
            }
            (
                (first + mode + upper) / 3.0,
                Some(Known::Triangle(first, mode, upper)),
            )
        }
        _ => {
            let (width, nu) = (positive(at(1))?, positive(at(2))?);
            if nu <= 2.0 {
                return Err(at(2).trouble(say!(
                    "a t distribution of so few degrees of freedom has no standard deviation"
                )));
            }
            // Type 11 states the standard deviation of the distribution, type 12 its scale.
            let scale = if code == 11 {
                width * libm::sqrt((nu - 2.0) / nu)
            } else {
                width
            };
            (first, Some(Known::Student(scale, nu)))
        }
    };
    let part = |known: Known| Part {
        name: String::new(),
        known,
        dof: None,
    };
    Ok(Input {
        name: name(title.text),
        value: Some(estimate),
        parts: known.map(part).into_iter().collect(),
        ..Input::default()
    })
}

/// The lines of the model: assignments, and an expression as the last, which is the result.
fn equations(
    lines: &[Piece<'_>],
    inputs: &[Input],
    nowhere: Piece<'_>,
) -> Result<Vec<Equation>, Trouble> {
    let statements: Vec<Piece<'_>> = lines
        .iter()
        .flat_map(|line| line.split(';'))
        .filter(|line| !line.text.is_empty())
        .collect();
    let mut known: Vec<String> = inputs.iter().map(|input| input.name.clone()).collect();
    let mut equations = Vec::new();
    for (place, line) in statements.iter().enumerate() {
        let is_last = place + 1 == statements.len();
        let arrow = line
            .text
            .find("<-")
            .map(|at| (line.part(0, at), line.part(at + 2, line.text.len())));
        let sides = arrow.or_else(|| line.split_once('='));
        let (left, right) = match sides {
            Some((left, right)) => (name(left.text), right.trimmed()),
            None if is_last => ("y".into(), *line),
            None => {
                return Err(line.trouble(say!(
                    "a line of the model that is not the last must be `name = formula`"
                )));
            }
        };
        if known.contains(&left) {
            return Err(line.trouble(say!("`{left}` gets a value a second time")));
        }
        equations.push(Equation {
            formula: formula(right, SPELLING, &known)?,
            is_result: is_last,
            unit: String::new(),
            description: String::new(),
            at: (right.line, right.column),
            name: left.clone(),
        });
        known.push(left);
    }
    if equations.is_empty() {
        return Err(nowhere.trouble(say!("the file has no `expression`")));
    }
    Ok(equations)
}
