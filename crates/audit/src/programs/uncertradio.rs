//! UncertRadio: sections that begin with `@`, grids whose fields end with `#`, formulas from the result downwards.

use gumption_fault::{Said, say};

use super::Program;
use super::formula::{Spelling, formula, name};
use super::numbers::{number, positive};
use super::statement::{Equation, Input, Known, Part, Statement};
use super::trouble::{Piece, Trouble};
use super::units;
use crate::claim::Shape;

pub(super) const PROGRAM: Program = Program {
    name: "UncertRadio",
    endings: &["txp"],
    signs: &["@Formeltext", "@Unc-Grid"],
    is_western: true,
    read,
};

const SPELLING: Spelling = Spelling {
    functions: &[("log", "ln")],
    ignores_case: true,
};

/// What stands in a grid where nothing was put in.
const MISSING: f64 = -999.0;

#[derive(Default)]
struct File<'t> {
    title: Vec<&'t str>,
    formulas: Vec<Piece<'t>>,
    symbols: Vec<Piece<'t>>,
    uncertainties: Vec<Piece<'t>>,
    covariances: Vec<Piece<'t>>,
    settings: Vec<Piece<'t>>,
}

fn read(text: &str) -> Result<Vec<Statement>, Trouble> {
    let file = File::of(text);
    let symbols: Vec<Symbol<'_>> = file
        .symbols
        .iter()
        .map(|line| Symbol::of(*line))
        .collect::<Result<_, _>>()?;
    if let Some(pair) = file
        .covariances
        .iter()
        .find(|line| line.text.chars().any(char::is_alphanumeric))
    {
        return Err(pair.trouble(say!(
            "covariances of this program are not read; delete the lines of @Covar-Grid, and state the correlations in the imported budget"
        )));
    }
    let mut statement = Statement {
        title: file
            .title
            .first()
            .map(ToString::to_string)
            .unwrap_or_default(),
        factor: file.factor()?,
        ..Statement::default()
    };
    let computed = |symbol: &Symbol<'_>| symbol.kind == "a";
    let known: Vec<String> = symbols.iter().map(|symbol| symbol.name.clone()).collect();
    for line in &file.formulas {
        let (left, right) = line
            .split_once('=')
            .ok_or_else(|| line.trouble(say!("`name = formula` was expected here")))?;
        let left = name(left.text);
        let symbol = symbols
            .iter()
            .find(|symbol| symbol.is(&left))
            .ok_or_else(|| {
                line.trouble(say!(
                    "`{left}` is in the formula, and the file says nothing of it"
                ))
            })?;
        statement.equations.push(Equation {
            name: symbol.name.clone(),
            formula: formula(right, SPELLING, &known)?,
            // The first equation gives the result; those below it are its steps.
            is_result: statement.equations.is_empty(),
            unit: symbol.unit.clone(),
            description: symbol.meaning.into(),
            at: (right.line, right.column),
        });
    }
    if statement.equations.is_empty() {
        let start = Piece {
            text: "",
            line: 1,
            column: 1,
        };
        return Err(start.trouble(say!("the section @Formeltext has no formula")));
    }
    for symbol in symbols.iter().filter(|symbol| !computed(symbol)) {
        let line = file.uncertainties.iter().find(|line| {
            let first = line.text.split('#').next().unwrap_or_default();
            symbol.is(&name(first))
        });
        let line = line.copied().unwrap_or(symbol.at);
        statement
            .inputs
            .push(symbol.input(line, &mut statement.remarks)?);
    }
    statement.in_order().map(|statement| vec![statement])
}

impl<'t> File<'t> {
    fn of(text: &'t str) -> File<'t> {
        let mut file = File::default();
        let mut section = "";
        for line in Piece::lines(text).map(Piece::trimmed) {
            if let Some(head) = line.text.strip_prefix('@') {
                section = head.trim_end_matches([':', ' ']);
            } else if !line.text.is_empty() {
                match section.to_lowercase().as_str() {
                    "titeltext" => file.title.push(line.text.trim_matches(['#', ' '])),
                    "formeltext" => file.formulas.push(line),
                    "symbole-grid" => file.symbols.push(line),
                    "unc-grid" => file.uncertainties.push(line),
                    "covar-grid" => file.covariances.push(line),
                    "sonstige" => file.settings.push(line),
                    // Descriptions, and grids of fits, whose functions the formulas would call.
                    _ => {}
                }
            }
        }
        file
    }

    fn factor(&self) -> Result<Option<f64>, Trouble> {
        let setting = |line: &&Piece<'_>| line.text.to_lowercase().starts_with("coverf");
        let Some(line) = self.settings.iter().find(setting) else {
            return Ok(None);
        };
        let (_, value) = line
            .split_once('=')
            .ok_or_else(|| line.trouble(say!("`key=value` was expected here")))?;
        let value = value.split('#').first().copied().unwrap_or(value);
        positive(value).map(Some)
    }
}

struct Symbol<'t> {
    name: String,
    kind: &'t str,
    unit: String,
    meaning: &'t str,
    at: Piece<'t>,
}

impl<'t> Symbol<'t> {
    /// `name # type # unit # meaning`.
    fn of(line: Piece<'t>) -> Result<Symbol<'t>, Trouble> {
        let fields = line.split('#');
        let [title, kind, unit, rest @ ..] = fields.as_slice() else {
            return Err(line.trouble(say!("`name # type # unit # meaning` was expected here")));
        };
        if !matches!(kind.text, "a" | "u" | "p" | "m") {
            let text = kind.text;
            return Err(kind.trouble(say!("the type `{text}` is not known; a, u, m and p are")));
        }
        Ok(Symbol {
            name: name(title.text),
            kind: kind.text,
            // Formulas of the program are of numbers: a unit that is not known is none.
            unit: units::unit(unit.text).unwrap_or_default(),
            meaning: rest.first().map_or("", |meaning| meaning.text),
            at: line,
        })
    }

    fn is(&self, other: &str) -> bool {
        self.name.to_lowercase() == other.to_lowercase()
    }

    /// `name # value # type # formula of u # u # half-width # absolute or relative # standard uncertainty #`.
    fn input(&self, line: Piece<'_>, remarks: &mut Vec<Said>) -> Result<Input, Trouble> {
        let fields = line.split('#');
        let [_, value, kind, sd_formula, sd, half, mode, result, ..] = fields.as_slice() else {
            let name = &self.name;
            return Err(line.trouble(say!("`{name}` needs eight fields in @Unc-Grid")));
        };
        let given = |piece: Piece<'_>| -> Result<Option<f64>, Trouble> {
            if piece.text.is_empty() {
                return Ok(None);
            }
            number(piece).map(|x| Some(x).filter(|x| *x != MISSING))
        };
        let estimate =
            given(*value)?.ok_or_else(|| value.trouble(say!("a value was expected here")))?;
        let scale = match mode.text {
            "2" => estimate.abs(),
            "1" | "" => 1.0,
            text => {
                return Err(mode.trouble(say!(
                    "1 (absolute) or 2 (relative) was expected here, not `{text}`"
                )));
            }
        };
        let code = given(*kind)?.unwrap_or(1.0);
        let (sd, half, u) = (given(*sd)?, given(*half)?, given(*result)?);
        let known = match (
            sd.filter(|sd| *sd > 0.0),
            half.filter(|half| *half > 0.0),
            u.filter(|u| *u > 0.0),
        ) {
            (_, Some(half), _) if code == 2.0 => {
                Some(Known::Limits(half * scale, Shape::Rectangular))
            }
            (_, Some(half), _) if code == 3.0 => {
                Some(Known::Limits(half * scale, Shape::Triangular))
            }
            // A formula for u was evaluated by the program, which keeps what it came to.
            (_, _, Some(u)) if !sd_formula.text.is_empty() => Some(Known::Standard(u)),
            (Some(sd), ..) => Some(Known::Standard(sd * scale)),
            (None, None, Some(u)) => Some(Known::Standard(u)),
            _ if !sd_formula.text.is_empty() => {
                return Err(sd_formula.trouble(say!(
                    "the standard uncertainty that this formula gives is missing; compute the project, and save it"
                )));
            }
            _ => None,
        };
        let named = match code as i64 {
            1..=3 => None,
            4 => Some(say!("a count with the (N + x) rule")),
            5 => Some(say!("a lognormal distribution")),
            6 => Some(say!("a gamma distribution")),
            7 => Some(say!("a binomial and Poisson distribution")),
            8 | 10 => Some(say!("a beta distribution")),
            9 => Some(say!("a t distribution")),
            11 => Some(say!("a preset count")),
            _ => {
                let text = kind.text;
                return Err(kind.trouble(say!("the distribution of type `{text}` is not known")));
            }
        };
        if let Some(named) = named.filter(|_| known.is_some()) {
            let name = &self.name;
            remarks.push(say!(
                "{name} is {named} in the source; here a normal distribution with the same standard uncertainty."
            ));
        }
        let part = |known: Known| Part {
            name: String::new(),
            known,
            dof: None,
        };
        Ok(Input {
            name: self.name.clone(),
            description: self.meaning.into(),
            value: Some(estimate),
            unit: self.unit.clone(),
            parts: known.map(part).into_iter().collect(),
        })
    }
}
