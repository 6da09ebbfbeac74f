//! The sections of the report of a calibration.

use crate::figures::with_unit;
use crate::joint::matrix;
use crate::language::{Language, Word};
use crate::number::{NONE, aligned, effective, exact, in_unit, probability, significant};
use crate::phrase::{named_row, numbers_beside, section, table};
use crate::symbol;
use gumption_core::model::{Role, Symbol};
use gumption_fault::say;
use gumption_format::document::{
    Block,
    ColumnKind::{Names, Numbers, Wrapped},
    Row,
};
use gumption_gum::budget::CoverageRule;
use gumption_lab::calibrate::{Calibration, Campaign, Coefficient, Figures, PartScatter};
use gumption_lab::experiment::Words;

/// Digits of standard uncertainties.
pub(super) const DIGITS: u8 = 3;

pub(super) fn said(words: &Words, l: Language) -> &str {
    l.pick(&words.en, &words.zh)
}

pub(super) fn heading(campaign: &Campaign, l: Language) -> Vec<Block> {
    let heading = &campaign.experiment.heading;
    let title = match said(&heading.title, l) {
        "" => l.pick("Calibration", "校准"),
        title => title,
    };
    let method = heading.description.as_ref().map(|words| said(words, l));
    let fields = [
        (
            l.pick("Procedure", "校准程序"),
            heading.procedure.as_deref(),
        ),
        (Word::Method.of(l), method),
        (Word::Source.of(l), heading.reference.as_deref()),
        (Word::Object.of(l), heading.object.as_deref()),
        (Word::Author.of(l), heading.author.as_deref()),
        (Word::Date.of(l), heading.date.as_deref()),
        (Word::Note.of(l), heading.note.as_deref()),
    ];
    let stated = fields
        .into_iter()
        .filter_map(|(label, text)| Some((label.into(), text?.into())));
    let fields: Vec<(String, String)> = stated.collect();
    let mut blocks = vec![Block::Title(title.to_owned())];
    if !fields.is_empty() {
        blocks.push(Block::Fields(fields));
    }
    blocks
}

pub(super) fn equations(campaign: &Campaign, l: Language) -> Vec<Block> {
    let all = 0..campaign.experiment.equations.responses().len();
    let equations = &campaign.experiment.equations;
    let lines = all.flat_map(|response| equations.text(response).lines());
    let lines = equations.shared().lines().chain(lines).map(str::to_owned);
    let mut blocks = vec![
        section(l, "Measurement equations", "测量方程"),
        Block::Formula(lines.collect()),
    ];
    let constants = campaign.experiment.constants.iter().filter_map(constant);
    let constants: Vec<String> = constants.collect();
    if !constants.is_empty() {
        let constants = constants.join(l.comma());
        blocks.push(Block::Paragraph(say!("with {constants}").in_language(l)));
    }
    blocks
}

/// What an equation takes as exactly known: `Rn = 100 Ω`.
fn constant(symbol: &Symbol) -> Option<String> {
    let value = match &symbol.role {
        Role::Constant(value) => exact(*value),
        Role::ConstantVector(values) => {
            let values: Vec<String> = values.iter().map(|value| exact(*value)).collect();
            format!("[{}]", values.join(", "))
        }
        _ => return None,
    };
    let name = &symbol.name;
    Some(with_unit(
        &format!("{name} = {value}"),
        &symbol.unit.typeset(),
    ))
}

/// The degrees of freedom of a coefficient that gave its k.
pub(super) fn entered(campaign: &Campaign, one: &Coefficient) -> String {
    let rule = campaign.experiment.conventions.degrees_of_freedom;
    effective(rule.entered(one.dof))
}

pub(super) fn coefficients(campaign: &Campaign, figures: &Figures, l: Language) -> Vec<Block> {
    let conventions = &campaign.experiment.conventions;
    let fixed = matches!(conventions.coverage_factor, CoverageRule::Fixed(_));
    // JJF 1059.1: k without a probability.
    let expanded = match fixed && !conventions.state_probability {
        true => "U".to_owned(),
        false => format!("U ({})", probability(conventions.coverage_probability)),
    };
    let estimate = Word::Estimate.of(l);
    let mut table = table(
        l,
        [
            ("coefficient", "系数", Names),
            (estimate, estimate, Numbers),
            ("u", "标准不确定度 u", Numbers),
            ("unit", Word::Unit.of(l), Names),
            ("ν", "ν", Numbers),
            ("k", "k", Numbers),
            (&expanded, &expanded, Numbers),
            ("significant?", "显著性", Names),
            ("what it is", "含义", Wrapped),
        ],
    );
    for one in &figures.coefficients {
        table.push(vec![
            one.name.as_str().into(),
            aligned(one.value, one.u, DIGITS).into(),
            shown_u(one.u).into(),
            symbol(&one.unit).into(),
            entered(campaign, one).into(),
            significant(one.k, 3).into(),
            shown_u(one.k * one.u).into(),
            significance(one, l).into(),
            described(one, l).into(),
        ]);
    }
    let profile = &conventions.profile;
    vec![
        section(l, "Coefficients", "系数"),
        Block::Table(table.without_empty_columns()),
        Block::Paragraph(say!("significant: a coefficient that is zero would come out as far from it with the probability p (two-sided t test).").in_language(l)),
        Block::Paragraph(
            say!("U = k·u, with k by the profile {profile} for a normal or t-distribution.")
                .in_language(l),
        ),
    ]
}

/// What a coefficient is, if anybody says so.
fn described(one: &Coefficient, l: Language) -> &str {
    one.description.as_ref().map_or("", |words| said(words, l))
}

/// What a schedule lets expect.
pub(super) fn predictions(figures: &Figures, l: Language) -> Vec<Block> {
    let mut table = table(
        l,
        [
            ("coefficient", "系数", Names),
            ("assumed value", "假定值", Numbers),
            ("u to expect", "预期标准不确定度 u", Numbers),
            ("unit", Word::Unit.of(l), Names),
            ("what it is", "含义", Wrapped),
        ],
    );
    for one in &figures.coefficients {
        table.push(vec![
            one.name.as_str().into(),
            significant(one.value, 6).into(),
            shown_u(one.u).into(),
            symbol(&one.unit).into(),
            described(one, l).into(),
        ]);
    }
    vec![
        section(l, "Uncertainties to expect", "预期不确定度"),
        Block::Table(table.without_empty_columns()),
    ]
}

pub(super) fn shown_u(u: f64) -> String {
    match u.is_finite() {
        true => significant(u, DIGITS),
        false => NONE.to_owned(),
    }
}

pub(super) fn p_of(p: f64) -> String {
    match p {
        p if p < 1e-4 => "p < 0.0001".to_owned(),
        p => format!("p = {}", significant(p, 2)),
    }
}

fn significance(one: &Coefficient, l: Language) -> String {
    let p = p_of(one.p_value);
    match one.is_significant() {
        None => NONE.to_owned(),
        Some(true) => say!("yes, {p}").in_language(l),
        Some(false) => say!("no, {p}").in_language(l),
    }
}

/// Results of parts, and how they scatter.
pub(super) fn parts(found: &Calibration, l: Language) -> Vec<Block> {
    if found.parts.is_empty() {
        return Vec::new();
    }
    let scatter = found.scatter_of_parts();
    let mut table = numbers_beside("", found.figures.coefficients.iter().map(head_of));
    for (label, part) in &found.parts {
        let values = part.figures.coefficients.iter().zip(&scatter);
        let values = values.map(|(one, all)| aligned(one.value, all.s, DIGITS));
        table.rows.push(named_row(label.as_str(), values));
    }
    table.rows.push(Row::Rule);
    let of = |label: &str, shown: fn(&PartScatter) -> String| {
        named_row(label, scatter.iter().map(shown))
    };
    table.rows.extend([
        of(l.pick("mean", "平均值"), |one| {
            aligned(one.mean, one.s, DIGITS)
        }),
        of(l.pick("standard deviation", "标准偏差"), |one| {
            shown_u(one.s)
        }),
        of(l.pick("range", "极差"), |one| shown_u(one.range)),
    ]);
    vec![
        section(l, "One by one", "分别计算"),
        Block::Table(table),
        Block::Paragraph(say!("The coefficients above are those of all points together; the scatter between the parts is in their residuals.").in_language(l)),
    ]
}

/// Name and unit of a coefficient, as the head of a column.
pub(super) fn head_of(one: &Coefficient) -> String {
    in_unit(&one.name, &symbol(&one.unit))
}

pub(super) fn correlations(figures: &Figures, l: Language) -> Vec<Block> {
    /// What is smaller is printed as zero.
    const PRINTED: f64 = 0.005;
    let all = &figures.coefficients;
    if all.len() < 2 || figures.causes.is_empty() {
        return Vec::new();
    }
    let heading = Block::Section(Word::Correlation.of(l).to_owned());
    let r = figures.correlation();
    let off_diagonal = || (0..all.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    if off_diagonal().all(|at| r[at].abs() < PRINTED) {
        return vec![
            heading,
            Block::Paragraph(say!("All are 0.00; --json has the covariances.").in_language(l)),
        ];
    }
    let names: Vec<&str> = all.iter().map(|one| one.name.as_str()).collect();
    let mut table = matrix(l, &names, &r, "");
    // The section says it.
    table.columns[0].head = String::new();
    vec![heading, Block::Table(table)]
}
