//! suncal: projects in YAML, a list of components of which those of the mode `uncertainty` are budgets.

use gumption_core::special::normal_two_sided_quantile;
use gumption_fault::{Said, say};

use super::formula::{Spelling, formula, name};
use super::numbers::{freedom, number, positive, whole};
use super::statement::{Equation, Input, Known, Part, Statement};
use super::trouble::{Piece, Trouble};
use super::yaml::{self, Is, Node};
use super::{Program, units};
use crate::claim::Shape;
use crate::units::factor;

pub(super) const PROGRAM: Program = Program {
    name: "suncal",
    endings: &["yaml", "yml"],
    signs: &["mode: uncertainty", "functions:", "inputs:"],
    is_western: false,
    read,
};

const SPELLING: Spelling = Spelling {
    functions: &[
        ("log", "ln"),
        ("log2", "log2"),
        ("arcsin", "asin"),
        ("arccos", "acos"),
        ("arctan", "atan"),
        ("radians", "(pi/180)*"),
    ],
    ignores_case: false,
};

fn read(text: &str) -> Result<Vec<Statement>, Trouble> {
    let project = yaml::parsed(text)?;
    let components = match &project.is {
        Is::Map(_) => std::slice::from_ref(&project),
        _ => project.list()?,
    };
    let mut modes = Vec::new();
    let mut statements = Vec::new();
    for component in components {
        component.map()?;
        let mode = match component.get("mode") {
            Some(mode) => mode.text()?.map_or("", |mode| mode.text),
            None => "uncertainty",
        };
        match mode {
            "uncertainty" => statements.push(statement(component)?),
            other => modes.push(other),
        }
    }
    if statements.is_empty() {
        let modes = modes.join(", ");
        return Err(project.trouble(say!(
            "no component has the mode `uncertainty`; those of this project are: {modes}"
        )));
    }
    Ok(statements)
}

fn statement(component: &Node) -> Result<Statement, Trouble> {
    const KEYS: [&str; 11] = [
        "name",
        "mode",
        "desc",
        "description",
        "functions",
        "inputs",
        "correlations",
        "samples",
        "seed",
        "unitdefs",
        "wizard",
    ];
    component.only(&KEYS)?;
    if let Some(own) = component.get("unitdefs") {
        return Err(own.trouble(say!(
            "units that a project defines itself are not read; write its values in units of the SI"
        )));
    }
    let members = |key: &str| match component.get(key) {
        Some(node) => node.list(),
        None => Ok(&[][..]),
    };
    let mut statement = Statement {
        title: text(component, "name")?,
        ..Statement::default()
    };
    for node in members("inputs")? {
        statement.inputs.push(input(node, &mut statement.remarks)?);
    }
    equations(members("functions")?, component, &mut statement)?;
    for node in members("correlations")? {
        node.only(&["var1", "var2", "cor"])?;
        let of = |key: &str| Ok(name(required(node, key)?.text));
        let r = number(required(node, "cor")?)?;
        statement.correlations.push((of("var1")?, of("var2")?, r));
    }
    let count = |key: &str| {
        component
            .get(key)
            .map(|node| whole(single(node)?))
            .transpose()
    };
    (statement.trials, statement.seed) = (count("samples")?, count("seed")?);
    statement.in_order()
}

fn equations(
    functions: &[Node],
    component: &Node,
    statement: &mut Statement,
) -> Result<(), Trouble> {
    if functions.is_empty() {
        return Err(component.trouble(say!("a budget needs its `functions`")));
    }
    // The name of a function stands in a key, or in front of the equals sign of its expression.
    let mut sides = Vec::new();
    for node in functions {
        node.only(&[
            "name",
            "expr",
            "desc",
            "units",
            "tolerance",
            "kind",
            "show",
            "report",
        ])?;
        let whole = required(node, "expr")?;
        let (left, right) = match whole.split_once('=') {
            Some((left, right)) => (left, right),
            None => (required(node, "name")?, whole),
        };
        sides.push((node, name(left.text), right));
    }
    let mut known: Vec<String> = sides.iter().map(|(_, name, _)| name.clone()).collect();
    known.extend(statement.inputs.iter().map(|input| input.name.clone()));
    for (node, name, right) in sides {
        let unit = match node.get("units") {
            Some(node) => unit(single(node)?)?,
            None => String::new(),
        };
        statement.equations.push(Equation {
            name,
            formula: formula(right, SPELLING, &known)?,
            is_result: true,
            unit,
            description: text(node, "desc")?,
            at: (right.line, right.column),
        });
    }
    Ok(())
}

fn input(node: &Node, remarks: &mut Vec<Said>) -> Result<Input, Trouble> {
    node.only(&[
        "name",
        "mean",
        "desc",
        "units",
        "uncerts",
        "typea",
        "typea_uncert",
        "numnewmeas",
        "autocorrelate",
    ])?;
    let mut input = Input {
        name: name(required(node, "name")?.text),
        description: text(node, "desc")?,
        unit: match node.get("units") {
            Some(node) => unit(single(node)?)?,
            None => String::new(),
        },
        ..Input::default()
    };
    if let Some(stated) = node.get("typea") {
        let readings: Vec<f64> = stated
            .list()?
            .iter()
            .map(|reading| number(single(reading)?))
            .collect::<Result<_, _>>()?;
        if readings.len() < 2 {
            return Err(stated.trouble(say!(
                "a standard deviation takes two readings; state what is known otherwise as one of `uncerts`"
            )));
        }
        let of = node
            .get("numnewmeas")
            .map(|node| positive(single(node)?))
            .transpose()?;
        let of = of.filter(|of| *of != readings.len() as f64);
        // The estimate is the mean of the readings, also where later ones are expected.
        input.value = Some(readings.iter().sum::<f64>() / readings.len() as f64);
        let (name, dof) = ("repeatability".into(), None);
        let known = Known::Readings(readings, of);
        input.parts.push(Part { name, known, dof });
    } else if let Some(u) = node.get("typea_uncert") {
        let (name, dof) = ("Type A".into(), None);
        let known = Known::Standard(positive(single(u)?)?);
        input.parts.push(Part { name, known, dof });
    }
    if input.value.is_none() {
        input.value = Some(match node.get("mean") {
            Some(mean) => number(single(mean)?)?,
            // As the program does.
            None => 0.0,
        });
    }
    let parts = node
        .get("uncerts")
        .map(Node::list)
        .transpose()?
        .unwrap_or(&[]);
    for part in parts {
        let part = uncertainty(part, &input, remarks)?;
        input.parts.push(part);
    }
    Ok(input)
}

fn uncertainty(node: &Node, input: &Input, remarks: &mut Vec<Said>) -> Result<Part, Trouble> {
    const KEYS: [&str; 14] = [
        "name", "desc", "dist", "units", "degf", "df", "unc", "std", "scale", "k", "conf", "a",
        "d", "median",
    ];
    node.only(&KEYS)?;
    let own = match node.get("units") {
        Some(node) => {
            let piece = single(node)?;
            let unit = unit(piece)?;
            factor(&unit, &input.unit)
                .or_else(|| (unit == input.unit).then_some(1.0))
                .ok_or_else(|| {
                    let (own, of) = (piece.text, &input.unit);
                    piece.trouble(say!(
                        "an uncertainty in `{own}` does not go with a value in `{of}`"
                    ))
                })?
        }
        None => 1.0,
    };
    if let Some(median) = node.get("median")
        && number(single(median)?)? != 0.0
    {
        return Err(median.trouble(say!(
            "an uncertainty with a median of its own is not read; put the correction into the value"
        )));
    }
    let figure = |key: &str| -> Result<f64, Trouble> {
        let node = node
            .get(key)
            .ok_or_else(|| node.trouble(say!("the key `{key}` is missing here")))?;
        // A percentage is of the value, which is in the unit of the input.
        amount(single(node)?, input.value.unwrap_or(0.0) / own).map(|x| x * own)
    };
    let has = |key: &str| node.get(key).is_some();
    let plain = |key: &str| positive(required(node, key)?);
    let probability = || {
        let piece = required(node, "conf")?;
        match positive(piece)? {
            p if p < 1.0 => Ok(p),
            _ => Err(piece.trouble(say!(
                "a probability between 0 and 1 is expected here, such as 0.95"
            ))),
        }
    };
    let dof = match node.get("degf").or_else(|| node.get("df")) {
        Some(node) => freedom(single(node)?)?,
        None => None,
    };
    let dist = match node.get("dist") {
        Some(node) => single(node)?,
        None => Piece {
            text: "normal",
            line: node.line,
            column: node.column,
        },
    };
    let label = text(node, "name")?;
    let known = match dist.text {
        "normal" | "gaussian" | "norm" | "t" if has("unc") => {
            let expanded = figure("unc")?;
            if has("conf") {
                if dist.text != "t" && dof.is_some() {
                    let of = &input.name;
                    remarks.push(say!(
                        "{of}, {label}: suncal divides U by the factor of the normal distribution, and keeps the degrees of freedom."
                    ));
                    let p = probability()?;
                    Known::Standard(expanded / normal_two_sided_quantile(p))
                } else {
                    Known::Covered(expanded, probability()?)
                }
            } else if has("k") {
                Known::Expanded(expanded, plain("k")?)
            } else {
                Known::Standard(expanded)
            }
        }
        "normal" | "gaussian" | "norm" | "t" if has("std") => Known::Standard(figure("std")?),
        "normal" | "gaussian" | "norm" => Known::Standard(figure("scale")?),
        "uniform" => Known::Limits(figure("a")?, Shape::Rectangular),
        "triangular" => Known::Limits(figure("a")?, Shape::Triangular),
        "arcsine" => Known::Limits(figure("a")?, Shape::Arcsine),
        "resolution" => Known::Step(figure("a")?),
        "curvtrap" => Known::VagueLimits(figure("a")?, figure("d")?),
        other => {
            return Err(dist.trouble(say!(
                "the distribution `{other}` is not read; known are normal, t, uniform, triangular, arcsine, resolution, curvtrap"
            )));
        }
    };
    Ok(Part {
        name: label,
        known,
        dof,
    })
}

/// `0.1`, `1%`, `5ppm`, `.001% + .01%range(10)`: percentages of the value, or of a range.
fn amount(piece: Piece<'_>, value: f64) -> Result<f64, Trouble> {
    let mut sum = 0.0;
    let mut start = 0;
    let bytes = piece.text.as_bytes();
    let ends = bytes.iter().enumerate().filter(|(i, byte)| {
        // The sign of an exponent joins, and does not part.
        **byte == b'+' && *i > 0 && !matches!(bytes[i - 1], b'e' | b'E')
    });
    let ends: Vec<usize> = ends.map(|(i, _)| i).chain([bytes.len()]).collect();
    for end in ends {
        sum += term(piece.part(start, end).trimmed(), value)?;
        start = end + 1;
    }
    if sum > 0.0 {
        Ok(sum)
    } else {
        let text = piece.text;
        Err(piece.trouble(say!(
            "a number greater than zero was expected here, not `{text}`"
        )))
    }
}

fn term(piece: Piece<'_>, value: f64) -> Result<f64, Trouble> {
    for (mark, fraction) in [("%", 1e-2), ("ppm", 1e-6), ("ppb", 1e-9)] {
        if let Some(at) = piece.text.find(mark) {
            let share = number(piece.part(0, at).trimmed())? * fraction;
            let behind = piece.part(at + mark.len(), piece.text.len()).trimmed();
            let range = behind
                .text
                .strip_prefix("range(")
                .and_then(|rest| rest.strip_suffix(')'));
            return match range {
                Some(range) => {
                    let start = "range(".len();
                    Ok(share * number(behind.part(start, start + range.len()).trimmed())?)
                }
                None if behind.text.is_empty() => Ok(share * value.abs()),
                None => {
                    let text = behind.text;
                    Err(behind.trouble(say!(
                        "`range(…)` or nothing was expected here, not `{text}`"
                    )))
                }
            };
        }
    }
    number(piece)
}

fn unit(piece: Piece<'_>) -> Result<String, Trouble> {
    let text = piece.text;
    units::unit(text).ok_or_else(|| piece.trouble(say!("the unit `{text}` is not known")))
}

fn single(node: &Node) -> Result<Piece<'_>, Trouble> {
    let text = node.text()?;
    text.ok_or_else(|| node.trouble(say!("a single value was expected here")))
}

fn required<'n>(node: &'n Node, key: &str) -> Result<Piece<'n>, Trouble> {
    match node.get(key) {
        Some(node) => single(node),
        None => Err(node.trouble(say!("the key `{key}` is missing here"))),
    }
}

fn text(node: &Node, key: &str) -> Result<String, Trouble> {
    let text = match node.get(key) {
        Some(node) => node.text()?,
        None => None,
    };
    Ok(text.map(|piece| piece.text.to_string()).unwrap_or_default())
}
