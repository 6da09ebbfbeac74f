//! What U would need: the uncertainty that each input would have to have, alone, and of all together at the least cost.

use gumption_fault::say;
use gumption_format::document::{Block, Cell, ColumnKind, Document, Table};
use gumption_format::machine::{Machine, Number, record};
use gumption_gum::propagate::{
    Improvement, MOST_MULTIPLE, Needed, Requirement, Requirements, Together,
};

use crate::language::Word;
use crate::number::{NONE, TABLE_DIGITS, significant};
use crate::{Report, symbol};

/// The document of what U would need of every input alone, and of all together.
pub fn requirements(report: &Report<'_>, found: &Requirements, together: &Together) -> Document {
    let mut blocks = alone(report, found);
    blocks.extend(at_least_cost(report, together));
    let form = form(report, found, together);
    Document::new(&form, report.language, blocks)
}

record! {
    /// What every input would have to be, alone, so that U of a measurand is not above what is wished for.
    RequirementsJson<'a> {
        /// The measurand.
        measurand: &'a str,
        /// Unit of U.
        unit: String,
        /// U as it is.
        expanded: Number,
        /// U that is wished for.
        wished: Number,
        /// Inputs that contribute, the largest contribution first.
        inputs: Vec<RequirementJson<'a>>,
        /// What becomes better where all do together, the largest cost first.
        together: Vec<ImprovementJson<'a>>,
        /// What is left of U where everything that may become better is known exactly and U is still above what is wished for.
        together_floor: Option<Number>,
    }

    /// What U would need of one input alone.
    RequirementJson<'a> {
        /// The input.
        input: &'a str,
        /// Unit of its uncertainty.
        unit: String,
        /// Its standard uncertainty.
        u: Number,
        /// What it would have to be at most; null where it cannot be, or need not be anything.
        needed: Option<Number>,
        /// What is left of U where the input is known exactly and U is still above what is wished for.
        floor: Option<Number>,
    }

    /// What an input would have to be where all become better together.
    ImprovementJson<'a> {
        /// The input.
        input: &'a str,
        /// Unit of its uncertainty.
        unit: String,
        /// Its standard uncertainty.
        u: Number,
        /// What it would have to be.
        needed: Number,
        /// What that costs, in the unit of the costs of halving.
        cost: Number,
    }
}

impl Machine for RequirementsJson<'_> {
    const KIND: &'static str = "requirements";
    const VERSION: u32 = 1;
}

fn form<'a>(
    report: &Report<'a>,
    found: &Requirements,
    together: &Together,
) -> RequirementsJson<'a> {
    let (name, unit) = report.measurand(found.measurand);
    let inputs = found.inputs.iter().map(|one| {
        let input = &report.budget.inputs[one.input];
        let (needed, floor) = match one.needed {
            Needed::Below(u) => (Some(Number(u)), None),
            Needed::Floor(floor) => (None, Some(Number(floor))),
            Needed::Any => (None, None),
        };
        RequirementJson {
            input: &input.name,
            unit: symbol(&input.unit),
            u: Number(one.u),
            needed,
            floor,
        }
    });
    RequirementsJson {
        measurand: name,
        unit: symbol(unit),
        expanded: Number(found.expanded),
        wished: Number(found.wished),
        inputs: inputs.collect(),
        together: improvements(together)
            .iter()
            .map(|one| {
                let input = &report.budget.inputs[one.input];
                ImprovementJson {
                    input: &input.name,
                    unit: symbol(&input.unit),
                    u: Number(one.u),
                    needed: Number(one.needed),
                    cost: Number(one.cost),
                }
            })
            .collect(),
        together_floor: match together {
            Together::Floor(floor) => Some(Number(*floor)),
            _ => None,
        },
    }
}

fn improvements(together: &Together) -> &[Improvement] {
    match together {
        Together::Improved(improved) => improved,
        _ => &[],
    }
}

/// The cheapest way, or that there is none; nothing where none is needed.
fn at_least_cost(report: &Report<'_>, together: &Together) -> Vec<Block> {
    let l = report.language;
    let title = Block::Section(say!("Together, at the least cost").in_language(l));
    let improved = match together {
        Together::Reached => return Vec::new(),
        Together::Floor(floor) => {
            let floor = significant(*floor, TABLE_DIGITS);
            return vec![
                title,
                Block::Paragraph(say!("Impossible: U = {floor} is left where everything that may become better is known exactly.").in_language(l)),
            ];
        }
        Together::Improved(improved) => improved,
    };
    let mut table = Table::new([
        (Word::Quantity.of(l), ColumnKind::Names),
        (Word::Unit.of(l), ColumnKind::Words),
        ("u", ColumnKind::Numbers),
        (l.pick("needed u", "所需 u"), ColumnKind::Numbers),
        (l.pick("cost", "代价"), ColumnKind::Numbers),
    ]);
    for one in improved {
        let input = &report.budget.inputs[one.input];
        table.push(vec![
            input.name.as_str().into(),
            symbol(&input.unit).into(),
            significant(one.u, TABLE_DIGITS).into(),
            significant(one.needed, TABLE_DIGITS).into(),
            significant(one.cost, TABLE_DIGITS).into(),
        ]);
    }
    let cost = significant(improved.iter().map(|one| one.cost).sum(), TABLE_DIGITS);
    vec![
        title,
        Block::Paragraph(say!("Every u may become smaller; to halve it costs what is written beside it (1 where nothing else is), to halve it again twice as much. Altogether this costs {cost}; what is not listed stays as it is.").in_language(l)),
        Block::Table(table),
    ]
}

fn alone(report: &Report<'_>, found: &Requirements) -> Vec<Block> {
    let l = report.language;
    let (name, unit) = report.measurand(found.measurand);
    let unit = symbol(unit);
    let with_unit = |x: f64| {
        format!("{} {unit}", significant(x, TABLE_DIGITS))
            .trim()
            .to_owned()
    };
    let (now, wished) = (with_unit(found.expanded), with_unit(found.wished));
    let mut table = Table::new([
        (Word::Quantity.of(l), ColumnKind::Names),
        (Word::Unit.of(l), ColumnKind::Words),
        ("u", ColumnKind::Numbers),
        (l.pick("needed u", "所需 u"), ColumnKind::Numbers),
        (l.pick("alone", "单独改变时"), ColumnKind::Wrapped),
    ]);
    for one in &found.inputs {
        table.push(row(report, one, &with_unit));
    }
    let reached = found
        .inputs
        .iter()
        .any(|one| !matches!(one.needed, Needed::Floor(_)));
    let mut blocks = vec![
        Block::Title(say!("What U({name}) = {wished} would need").in_language(l)),
        Block::Paragraph(say!("By the law of propagation of uncertainty U is {now} now. Each line changes one input and keeps all others; k follows the degrees of freedom.").in_language(l)),
        Block::Table(table),
    ];
    if !reached {
        blocks.push(Block::Closing(vec![
            say!("No input alone can do it: several have to become better together.")
                .in_language(l),
        ]));
    }
    blocks
}

fn row(report: &Report<'_>, one: &Requirement, with_unit: &dyn Fn(f64) -> String) -> Vec<Cell> {
    let l = report.language;
    let input = &report.budget.inputs[one.input];
    let (needed, words) = match one.needed {
        Needed::Below(u) => {
            let times = significant(u / one.u, TABLE_DIGITS);
            let words = say!("{times} times what it is").in_language(l);
            (significant(u, TABLE_DIGITS), words)
        }
        Needed::Floor(floor) => {
            let floor = with_unit(floor);
            let words =
                say!("impossible: {floor} is left where it is known exactly").in_language(l);
            (NONE.to_owned(), words)
        }
        Needed::Any => {
            let words = say!("more than {MOST_MULTIPLE} times what it is would do").in_language(l);
            (NONE.to_owned(), words)
        }
    };
    vec![
        input.name.as_str().into(),
        symbol(&input.unit).into(),
        significant(one.u, TABLE_DIGITS).into(),
        needed.into(),
        words.into(),
    ]
}
