//! GUM Workbench: text in sections, the model as quoted lines, one section for each quantity.

use std::collections::BTreeMap;

use gumption_fault::say;

use super::Program;
use super::formula::{Spelling, formula, name};
use super::numbers::{freedom, number, positive, whole};
use super::statement::{Equation, Input, Known, Part, Statement, uses};
use super::trouble::{Piece, Trouble};
use super::units;
use crate::claim::Shape;
use crate::printed::Printed;

pub(super) const PROGRAM: Program = Program {
    name: "GUM Workbench",
    endings: &["smu"],
    signs: &["[Header]", "Format=SMU"],
    is_western: true,
    read,
};

const SPELLING: Spelling = Spelling {
    functions: &[
        ("log", "log10"),
        ("arcsin", "asin"),
        ("arccos", "acos"),
        ("arctan", "atan"),
    ],
    ignores_case: false,
};

/// The keys of a section with their values.
#[derive(Default)]
struct Section<'t> {
    keys: BTreeMap<&'t str, Piece<'t>>,
    head: Option<Piece<'t>>,
}

fn read(text: &str) -> Result<Vec<Statement>, Trouble> {
    let sections = sections(text)?;
    let section = |name: &str| sections.get(name);
    let start = Piece {
        text: "",
        line: 1,
        column: 1,
    };
    let header =
        section("Header").ok_or_else(|| start.trouble(say!("the section [Header] is missing")))?;
    let form = header.keys.get("Format").copied().unwrap_or(start);
    if form.text != "SMU" {
        return Err(form.trouble(say!("`Format=SMU` was expected in [Header]")));
    }
    if let Some(correlations) = section("Correlations")
        && let Some(value) = correlations
            .keys
            .values()
            .find(|value| number(**value) != Ok(0.0))
    {
        return Err(value.trouble(say!(
            "how this program writes correlations is not known; delete the lines of [Correlations], and state them in the imported budget"
        )));
    }
    let model =
        section("Model").ok_or_else(|| start.trouble(say!("the section [Model] is missing")))?;
    let names = numbered(section("Components"), "Comp")?;
    let mut statement = Statement {
        title: section("Title")
            .and_then(|title| title.keys.get("Title"))
            .map_or(String::new(), |title| bare(*title).text.into()),
        ..Statement::default()
    };
    let mut results: Vec<(String, Kept)> = Vec::new();
    for (i, title) in names.iter().enumerate() {
        let titles = [format!("COMP {i}"), format!("COMP {}", title.text)];
        let quantity = titles
            .iter()
            .find_map(|title| section(title))
            .ok_or_else(|| {
                let name = title.text;
                title.trouble(say!("the quantity `{name}` has no section of its own"))
            })?;
        let symbol = symbol(*title);
        match quantity.kind(*title)? {
            Kind::Result => results.push((symbol, quantity.result()?)),
            kind => statement.inputs.push(quantity.input(symbol, kind, *title)?),
        }
    }
    let equations = equations(model)?;
    let mut known: Vec<String> = results.iter().map(|(name, _)| name.clone()).collect();
    known.extend(statement.inputs.iter().map(|input| input.name.clone()));
    known.extend(equations.iter().map(|(left, _)| left.clone()));
    for (left, right) in equations {
        let result = results.iter().find(|(name, _)| *name == left);
        let result = result.map(|(_, result)| result.clone()).unwrap_or_default();
        statement.equations.push(Equation {
            is_result: true,
            formula: formula(right, SPELLING, &known)?,
            unit: result.unit,
            description: result.definition,
            at: (right.line, right.column),
            name: left,
        });
    }
    // What another equation uses is a step on the way.
    let steps: Vec<String> = statement
        .equations
        .iter()
        .filter(|one| {
            statement
                .equations
                .iter()
                .any(|other| uses(&other.formula, &one.name))
        })
        .map(|step| step.name.clone())
        .collect();
    for equation in &mut statement.equations {
        equation.is_result = !steps.contains(&equation.name);
    }
    results.retain(|(name, _)| !steps.contains(name));
    // What the program kept of the only result is what it computed.
    if let [(_, result)] = results.as_slice() {
        statement.factor = result.factor;
        statement.computed.y.clone_from(&result.value);
        statement.computed.u_c.clone_from(&result.u);
    }
    statement.in_order().map(|statement| vec![statement])
}

fn sections(text: &str) -> Result<BTreeMap<&str, Section<'_>>, Trouble> {
    let mut sections: BTreeMap<&str, Section<'_>> = BTreeMap::new();
    let mut open = None;
    for line in Piece::lines(text).map(Piece::trimmed) {
        let head = line
            .text
            .strip_prefix('[')
            .and_then(|rest| rest.strip_suffix(']'));
        match (head, line.split_once('=')) {
            (Some(head), _) => {
                let section = sections.entry(head.trim()).or_default();
                section.head = Some(line);
                open = Some(head.trim());
            }
            (None, _) if line.text.is_empty() || line.text.starts_with(';') => {}
            (None, Some((key, value))) if open.is_some() => {
                let section = sections.entry(open.unwrap_or_default()).or_default();
                if section.keys.insert(key.text, value).is_some() {
                    let key = key.text;
                    return Err(line.trouble(say!("the key `{key}` stands here a second time")));
                }
            }
            _ => return Err(line.trouble(say!("`[section]` or `key=value` was expected here"))),
        }
    }
    Ok(sections)
}

/// `Comp=2`, `Comp[0]=…`, `Comp[1]=…`.
fn numbered<'t>(section: Option<&Section<'t>>, key: &str) -> Result<Vec<Piece<'t>>, Trouble> {
    let Some(section) = section else {
        return Ok(Vec::new());
    };
    let Some(count) = section.keys.get(key) else {
        return Ok(Vec::new());
    };
    let mut found = Vec::new();
    for i in 0..whole(*count)? {
        let member = section.keys.get(format!("{key}[{i}]").as_str());
        found.push(*member.ok_or_else(|| {
            count.trouble(say!("`{key}[{i}]` is missing, which this number announces"))
        })?);
    }
    Ok(found)
}

/// Left and right sides. Equations end with a semicolon, and what stands in braces is for the reader.
fn equations<'t>(model: &Section<'t>) -> Result<Vec<(String, Piece<'t>)>, Trouble> {
    let mut found = Vec::new();
    for line in numbered(Some(model), "Model")? {
        for equation in bare(line).split(';') {
            let end = equation.text.find('{').unwrap_or(equation.text.len());
            let equation = equation.part(0, end).trimmed();
            if equation.text.is_empty() {
                continue;
            }
            let (left, right) = equation
                .split_once('=')
                .ok_or_else(|| equation.trouble(say!("`name = formula` was expected here")))?;
            found.push((symbol(left), right));
        }
    }
    Ok(found)
}

/// Without quotation marks.
fn bare(piece: Piece<'_>) -> Piece<'_> {
    let inner = piece.text.len() >= 2 && piece.text.starts_with('\'') && piece.text.ends_with('\'');
    if inner {
        piece.part(1, piece.text.len() - 1).trimmed()
    } else {
        piece
    }
}

/// The program writes an underscore behind the names of quantities.
fn symbol(piece: Piece<'_>) -> String {
    name(bare(piece).text.trim_end_matches('_'))
}

/// Types of quantities that are known.
#[derive(Clone, Copy)]
enum Kind {
    Result,
    TypeA,
    Rectangular,
}

/// What the program keeps of a result.
#[derive(Clone, Default)]
struct Kept {
    unit: String,
    definition: String,
    factor: Option<f64>,
    value: Option<Printed>,
    u: Option<Printed>,
}

impl<'t> Section<'t> {
    fn get(&self, key: &str) -> Option<Piece<'t>> {
        let value = bare(*self.keys.get(key)?);
        (!value.text.is_empty()).then_some(value)
    }

    fn required(&self, key: &str, of: Piece<'_>) -> Result<Piece<'t>, Trouble> {
        let name = of.text;
        self.get(key).ok_or_else(|| {
            let head = self.head.unwrap_or(of);
            head.trouble(say!("the quantity `{name}` needs the key `{key}`"))
        })
    }

    fn kind(&self, of: Piece<'_>) -> Result<Kind, Trouble> {
        let kind = self.required("Type", of)?;
        match kind.text {
            "Result" => Ok(Kind::Result),
            "TypASum" => Ok(Kind::TypeA),
            "TypBRectang" => Ok(Kind::Rectangular),
            other => Err(kind.trouble(say!(
                "the type `{other}` is not known; Result, TypASum and TypBRectang are"
            ))),
        }
    }

    fn unit(&self) -> Result<String, Trouble> {
        match self.get("Unit") {
            None => Ok(String::new()),
            Some(unit) => {
                let text = unit.text;
                units::unit(text)
                    .ok_or_else(|| unit.trouble(say!("the unit `{text}` is not known")))
            }
        }
    }

    fn definition(&self) -> String {
        self.get("Definition")
            .map_or(String::new(), |text| text.text.into())
    }

    fn result(&self) -> Result<Kept, Trouble> {
        let figure = |key: &str| {
            let piece = self.get(key)?;
            Printed::parse(piece.text).filter(|figure| figure.value != 0.0)
        };
        let factor = self.get("Fcov").map(number).transpose()?;
        Ok(Kept {
            unit: self.unit()?,
            definition: self.definition(),
            factor: factor.filter(|factor| *factor > 0.0),
            value: figure("Vnom"),
            u: figure("Ustd"),
        })
    }

    fn input(&self, symbol: String, kind: Kind, of: Piece<'_>) -> Result<Input, Trouble> {
        let value = Some(number(self.required("Vnom", of)?)?);
        let known = match kind {
            Kind::Rectangular => {
                Known::Limits(positive(self.required("Hlim", of)?)?, Shape::Rectangular)
            }
            _ => Known::Standard(positive(self.required("Ustd", of)?)?),
        };
        let dof = match (kind, self.get("Neff")) {
            (Kind::TypeA, Some(dof)) => freedom(dof)?,
            _ => None,
        };
        let name = String::new();
        Ok(Input {
            name: symbol,
            description: self.definition(),
            unit: self.unit()?,
            value,
            parts: vec![Part { name, known, dof }],
        })
    }
}
