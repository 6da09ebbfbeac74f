//! The sections of the report of a calibration.

use nalgebra::DMatrix;

use super::super::joint::matrix;
use super::super::language::{Language, Word};
use super::super::number::{NONE, aligned, freedom, in_unit, probability, significant};
use super::super::symbol;
use crate::calibrate::{Calibration, Coefficient, Experiment, Figures, Words};
use crate::document::Block;
use crate::document::{Cell, Column, ColumnKind, Row, Table};

/// Digits of standard uncertainties.
pub(super) const DIGITS: u8 = 3;

pub(super) fn said(words: &Words, l: Language) -> String {
    l.pick(words.en.clone(), words.zh.clone())
}

pub(super) fn heading(experiment: &Experiment, l: Language) -> Vec<Block> {
    let heading = &experiment.heading;
    let title = match said(&heading.title, l) {
        none if none.is_empty() => l.pick("Calibration", "校准").to_owned(),
        title => title,
    };
    let mut fields: Vec<(String, String)> = Vec::new();
    let mut row = |label: &str, text: Option<String>| {
        fields.extend(text.map(|text| (label.to_owned(), text)));
    };
    row(l.pick("Procedure", "程序"), heading.procedure.clone());
    row(
        Word::Method.of(l),
        heading.description.as_ref().map(|words| said(words, l)),
    );
    row(Word::Source.of(l), heading.reference.clone());
    row(Word::Object.of(l), heading.object.clone());
    row(Word::Author.of(l), heading.author.clone());
    row(Word::Date.of(l), heading.date.clone());
    row(Word::Note.of(l), heading.note.clone());
    let mut blocks = vec![Block::Title(title)];
    if !fields.is_empty() {
        blocks.push(Block::Fields(fields));
    }
    blocks
}

pub(super) fn equations(experiment: &Experiment, l: Language) -> Vec<Block> {
    let count = experiment.equations.responses().len();
    let lines: Vec<String> = (0..count)
        .flat_map(|response| {
            experiment
                .equations
                .text(response)
                .lines()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        })
        .collect();
    vec![
        Block::Section(l.pick("Measurement equations", "测量方程").to_owned()),
        Block::Formula(lines),
    ]
}

pub(super) fn coefficients(experiment: &Experiment, figures: &Figures, l: Language) -> Vec<Block> {
    let p = probability(experiment.coverage_probability);
    let expanded = format!("U ({p})");
    let mut table = Table::new([
        (l.pick("coefficient", "系数"), ColumnKind::Names),
        (Word::Estimate.of(l), ColumnKind::Numbers),
        (l.pick("u", "标准不确定度 u"), ColumnKind::Numbers),
        (Word::Unit.of(l), ColumnKind::Names),
        ("ν", ColumnKind::Numbers),
        ("k", ColumnKind::Numbers),
        (&expanded, ColumnKind::Numbers),
        (l.pick("significant?", "显著性"), ColumnKind::Names),
        (l.pick("what it is", "含义"), ColumnKind::Wrapped),
    ]);
    for one in &figures.coefficients {
        let expanded = one.k * one.u;
        table.push(vec![
            one.name.as_str().into(),
            aligned(one.value, one.u, DIGITS).into(),
            shown_u(one.u).into(),
            symbol(&one.unit).into(),
            freedom(one.dof).into(),
            significant(one.k, 3).into(),
            shown_u(expanded).into(),
            significance(one, l).into(),
            described(one, l).into(),
        ]);
    }
    vec![
        Block::Section(l.pick("Coefficients", "系数").to_owned()),
        Block::Table(table.without_empty_columns()),
        Block::Paragraph(l.pick(
            "significant: a coefficient that is zero would come out as far from it with the probability p (two-sided t test).",
            "显著性：系数真值为零时得到如此偏离的概率 p（双侧 t 检验）。",
        ).to_owned()),
    ]
}

/// What a coefficient is, if anybody says so.
fn described(one: &Coefficient, l: Language) -> String {
    let words = one.description.as_ref();
    words.map(|words| said(words, l)).unwrap_or_default()
}

/// What a schedule lets expect.
pub(super) fn predictions(figures: &Figures, l: Language) -> Vec<Block> {
    let mut table = Table::new([
        (l.pick("coefficient", "系数"), ColumnKind::Names),
        (l.pick("assumed value", "假定值"), ColumnKind::Numbers),
        (
            l.pick("u to expect", "预期标准不确定度 u"),
            ColumnKind::Numbers,
        ),
        (Word::Unit.of(l), ColumnKind::Names),
        (l.pick("what it is", "含义"), ColumnKind::Wrapped),
    ]);
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
        Block::Section(l.pick("Uncertainties to expect", "预期不确定度").to_owned()),
        Block::Table(table.without_empty_columns()),
    ]
}

pub(super) fn shown_u(u: f64) -> String {
    if u.is_finite() {
        significant(u, DIGITS)
    } else {
        NONE.to_owned()
    }
}

fn significance(one: &Coefficient, l: Language) -> String {
    match one.p_value {
        p if p.is_nan() => NONE.to_owned(),
        p if p < 1e-4 => l.pick("yes, p < 0.0001", "显著，p < 0.0001").to_owned(),
        p if p < 0.05 => l.pick(
            format!("yes, p = {}", significant(p, 2)),
            format!("显著，p = {}", significant(p, 2)),
        ),
        p => l.pick(
            format!("no, p = {}", significant(p, 2)),
            format!("不显著，p = {}", significant(p, 2)),
        ),
    }
}

/// Results of parts, and how they scatter.
pub(super) fn parts(found: &Calibration, l: Language) -> Vec<Block> {
    if found.parts.is_empty() {
        return Vec::new();
    }
    let coefficients = &found.figures.coefficients;
    let mut table = Table {
        columns: vec![column("", ColumnKind::Names)],
        rows: Vec::new(),
    };
    let heads = coefficients.iter().map(head_of);
    table
        .columns
        .extend(heads.map(|head| column(&head, ColumnKind::Numbers)));
    let statistics: Vec<Statistics> = (0..coefficients.len())
        .map(|index| {
            let values = found
                .parts
                .iter()
                .map(|(_, part)| part.figures.coefficients[index].value);
            Statistics::of(&values.collect::<Vec<_>>())
        })
        .collect();
    for (label, part) in &found.parts {
        let values = part.figures.coefficients.iter().zip(&statistics);
        let mut cells: Vec<Cell> = vec![label.as_str().into()];
        cells.extend(values.map(|(one, all)| Cell::Text(aligned(one.value, all.s, DIGITS))));
        table.push(cells);
    }
    table.rows.push(Row::Rule);
    let mut row = |label: &str, shown: &dyn Fn(&Statistics) -> String| {
        let mut cells: Vec<Cell> = vec![label.into()];
        cells.extend(statistics.iter().map(|one| Cell::Text(shown(one))));
        table.push(cells);
    };
    row(l.pick("mean", "平均值"), &|one| {
        aligned(one.mean, one.s, DIGITS)
    });
    row(l.pick("standard deviation", "标准偏差"), &|one| {
        shown_u(one.s)
    });
    row(l.pick("range", "极差"), &|one| shown_u(one.range));
    vec![
        Block::Section(l.pick("One by one", "分别计算").to_owned()),
        Block::Table(table),
        Block::Paragraph(l.pick(
            "The coefficients above are those of all points together; the scatter between the parts is in their residuals.",
            "上列系数由全部测量点一并求得；各部分之间的分散已含在残差中。",
        ).to_owned()),
    ]
}

/// How the results of parts scatter.
struct Statistics {
    mean: f64,
    s: f64,
    range: f64,
}

impl Statistics {
    fn of(values: &[f64]) -> Statistics {
        let (mean, s) = mean_and_deviation(values);
        let extreme = |better: fn(f64, f64) -> f64| values.iter().copied().reduce(better);
        let range = extreme(f64::max)
            .zip(extreme(f64::min))
            .map_or(f64::NAN, |(a, b)| a - b);
        Statistics { mean, s, range }
    }
}

pub(super) fn column(head: &str, kind: ColumnKind) -> Column {
    Column {
        head: head.to_owned(),
        kind,
    }
}

/// Name and unit of a coefficient, as the head of a column.
pub(super) fn head_of(one: &Coefficient) -> String {
    in_unit(&one.name, &symbol(&one.unit))
}

fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (n - 1.0)).sqrt())
}

pub(super) fn correlations(figures: &Figures, l: Language) -> Vec<Block> {
    if figures.coefficients.len() < 2 || figures.causes.is_empty() {
        return Vec::new();
    }
    let names: Vec<&str> = figures
        .coefficients
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let r = correlation(figures);
    let heading = Block::Section(Word::Correlation.of(l).to_owned());
    let is_zero =
        |(place, r): (usize, &f64)| place / names.len() == place % names.len() || r.abs() < 0.005;
    if r.iter().enumerate().all(is_zero) {
        let none = l.pick(
            "All are 0.00; --json has the covariances.",
            "均为 0.00；协方差见 --json。",
        );
        return vec![heading, Block::Paragraph(none.to_owned())];
    }
    let mut table = matrix(l, &names, &r, "");
    // The section says it.
    table.columns[0].head = String::new();
    vec![heading, Block::Table(table)]
}

/// Correlation coefficients from a covariance matrix.
pub(super) fn correlation(figures: &Figures) -> DMatrix<f64> {
    let v = &figures.covariance;
    DMatrix::from_fn(v.nrows(), v.ncols(), |i, j| {
        let scale = (v[(i, i)] * v[(j, j)]).sqrt();
        match i == j {
            true => 1.0,
            false if scale > 0.0 => v[(i, j)] / scale,
            false => 0.0,
        }
    })
}
