//! The sections of the report of a calibration.

use nalgebra::DMatrix;

use super::super::document::Block;
use super::super::joint::matrix;
use super::super::language::{Language, Word};
use super::super::number::{NONE, aligned, freedom, percent, probability, significant};
use super::super::symbol;
use super::super::table::{Cell, Column, ColumnKind, Row, Table};
use super::trouble::in_words;
use crate::calibrate::{
    Alias, Calibration, Cause, Coefficient, Combination, Experiment, Figures, Identifiability,
    Origin, Plan, ResponseScatter, Scatter, Scope, Words,
};

/// Digits of standard uncertainties.
const DIGITS: u8 = 3;

/// More coefficients than these share one table of causes.
const SINGLE_BUDGETS: usize = 6;

/// Contributions smaller than this share of u are rounding errors, or might as well be.
const NOTHING: f64 = 1e-6;

/// More residuals than these are not listed.
const RESIDUALS: usize = 12;

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
        l.word(Word::Method),
        heading.description.as_ref().map(|words| said(words, l)),
    );
    row(l.word(Word::Source), heading.reference.clone());
    row(l.word(Word::Object), heading.object.clone());
    row(l.word(Word::Author), heading.author.clone());
    row(l.word(Word::Date), heading.date.clone());
    row(l.word(Word::Note), heading.note.clone());
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
    let described = l.pick("what it is", "含义");
    let mut table = Table::new([
        (l.pick("coefficient", "系数"), ColumnKind::Names),
        (l.word(Word::Estimate), ColumnKind::Numbers),
        (l.pick("u", "标准不确定度 u"), ColumnKind::Numbers),
        (l.word(Word::Unit), ColumnKind::Names),
        ("ν", ColumnKind::Numbers),
        ("k", ColumnKind::Numbers),
        (&expanded, ColumnKind::Numbers),
        (l.pick("significant?", "显著性"), ColumnKind::Names),
        (described, ColumnKind::Wrapped),
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
            one.description
                .as_ref()
                .map(|words| said(words, l))
                .unwrap_or_default()
                .into(),
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

/// What a schedule lets expect.
pub(super) fn predictions(figures: &Figures, l: Language) -> Vec<Block> {
    let mut table = Table::new([
        (l.pick("coefficient", "系数"), ColumnKind::Names),
        (l.pick("assumed value", "假定值"), ColumnKind::Numbers),
        (
            l.pick("u to expect", "预期标准不确定度 u"),
            ColumnKind::Numbers,
        ),
        (l.word(Word::Unit), ColumnKind::Names),
        (l.pick("what it is", "含义"), ColumnKind::Wrapped),
    ]);
    for one in &figures.coefficients {
        table.push(vec![
            one.name.as_str().into(),
            significant(one.value, 6).into(),
            shown_u(one.u).into(),
            symbol(&one.unit).into(),
            one.description
                .as_ref()
                .map(|words| said(words, l))
                .unwrap_or_default()
                .into(),
        ]);
    }
    vec![
        Block::Section(l.pick("Uncertainties to expect", "预期不确定度").to_owned()),
        Block::Table(table.without_empty_columns()),
    ]
}

fn shown_u(u: f64) -> String {
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

fn column(head: &str, kind: ColumnKind) -> Column {
    Column {
        head: head.to_owned(),
        kind,
    }
}

/// Name and unit of a coefficient, as the head of a column.
fn head_of(one: &Coefficient) -> String {
    match symbol(&one.unit) {
        none if none.is_empty() => one.name.clone(),
        unit => format!("{} / {unit}", one.name),
    }
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
    let mut table = matrix(l, &names, &correlation(figures), "");
    // The section says it.
    table.columns[0].head = String::new();
    vec![
        Block::Section(l.word(Word::Correlation).to_owned()),
        Block::Table(table),
    ]
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

/// What a cause is, and on which points one error acts.
pub(super) fn cause_words(cause: &Cause, l: Language) -> (String, String) {
    match &cause.origin {
        Origin::Stated { name, scope } => (
            name.clone(),
            match scope {
                Scope::Common => l.pick("all points", "各点共有").to_owned(),
                Scope::Each => l.pick("each point", "各点独立").to_owned(),
                Scope::By(column) => l.pick(format!("by {column}"), format!("按 {column}")),
            },
        ),
        Origin::Residuals { response } => (
            l.pick(
                format!("scatter of {response}"),
                format!("{response} 的分散性"),
            ),
            l.pick("each point", "各点独立").to_owned(),
        ),
        Origin::Samples { column } => (
            l.pick(format!("samples of {column}"), format!("{column} 的采样")),
            l.pick("each point", "各点独立").to_owned(),
        ),
        Origin::Prior { parameter } => (
            l.pick(
                format!("what was known of {parameter}"),
                format!("{parameter} 的已知信息"),
            ),
            String::new(),
        ),
    }
}

/// Budget of every coefficient by cause.
pub(super) fn budgets(figures: &Figures, l: Language) -> Vec<Block> {
    if figures.causes.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![Block::Section(
        l.pick("Uncertainty by cause", "不确定度来源").to_owned(),
    )];
    if figures.coefficients.len() > SINGLE_BUDGETS {
        blocks.push(Block::Table(all_budgets(figures, l)));
        return blocks;
    }
    for (index, one) in figures.coefficients.iter().enumerate() {
        blocks.push(Block::Table(budget(figures, index, one, l)));
    }
    blocks
}

fn budget(figures: &Figures, index: usize, one: &Coefficient, l: Language) -> Table {
    let unit = symbol(&one.unit);
    let head = l.pick(format!("u({})", one.name), format!("u({})", one.name));
    let head = if unit.is_empty() {
        head
    } else {
        format!("{head} / {unit}")
    };
    let mut table = Table::new([
        (l.pick("cause", "来源"), ColumnKind::Names),
        (l.pick("one error acts on", "作用范围"), ColumnKind::Words),
        (&head, ColumnKind::Numbers),
        ("ν", ColumnKind::Numbers),
        ("%", ColumnKind::Numbers),
        ("", ColumnKind::Bar),
    ]);
    let mut causes: Vec<&Cause> = figures.causes.iter().collect();
    causes.sort_by(|a, b| b.contribution(index).total_cmp(&a.contribution(index)));
    for cause in causes {
        let contribution = cause.contribution(index);
        if contribution <= NOTHING * one.u {
            continue;
        }
        let share = (contribution / one.u).powi(2);
        let (name, scope) = cause_words(cause, l);
        table.push(vec![
            name.into(),
            scope.into(),
            significant(cause.effect(index).unwrap_or(contribution), DIGITS).into(),
            freedom(cause.contribution_dof(index)).into(),
            percent(share).into(),
            Cell::Share(share),
        ]);
    }
    table.rows.push(Row::Rule);
    table.push(vec![
        l.word(Word::CombinedUncertainty).into(),
        "".into(),
        shown_u(one.u).into(),
        freedom(one.dof).into(),
    ]);
    table
}

fn all_budgets(figures: &Figures, l: Language) -> Table {
    let mut table = Table {
        columns: vec![column(l.pick("cause", "来源"), ColumnKind::Names)],
        rows: Vec::new(),
    };
    let heads = figures.coefficients.iter().map(head_of);
    table
        .columns
        .extend(heads.map(|head| column(&head, ColumnKind::Numbers)));
    for cause in &figures.causes {
        let (name, scope) = cause_words(cause, l);
        let head = if scope.is_empty() {
            name
        } else {
            format!("{name} ({scope})")
        };
        let mut cells: Vec<Cell> = vec![head.into()];
        cells.extend(figures.coefficients.iter().enumerate().map(|(index, one)| {
            match cause.contribution(index) {
                small if small <= NOTHING * one.u => Cell::Text("0".to_owned()),
                contribution => Cell::Text(significant(
                    cause.effect(index).unwrap_or(contribution),
                    DIGITS,
                )),
            }
        }));
        table.push(cells);
    }
    table.rows.push(Row::Rule);
    let mut cells: Vec<Cell> = vec![l.word(Word::CombinedUncertainty).into()];
    cells.extend(
        figures
            .coefficients
            .iter()
            .map(|one| Cell::Text(shown_u(one.u))),
    );
    table.push(cells);
    table
}

pub(super) fn residuals(experiment: &Experiment, found: &Calibration, l: Language) -> Vec<Block> {
    let mut scatter = Table::new([
        (l.pick("response", "响应量"), ColumnKind::Names),
        (l.pick("readings", "读数"), ColumnKind::Numbers),
        (l.pick("RMS residual", "残差均方根"), ColumnKind::Numbers),
        ("s", ColumnKind::Numbers),
        ("ν", ColumnKind::Numbers),
        (l.pick("s to expect", "预期 s"), ColumnKind::Numbers),
        ("χ²/ν", ColumnKind::Numbers),
        ("p", ColumnKind::Numbers),
        (l.word(Word::Unit), ColumnKind::Names),
    ]);
    for (one, quantity) in found.responses.iter().zip(experiment.equations.responses()) {
        let test = one.test;
        let of_test = |value: &dyn Fn(crate::calibrate::ScatterTest) -> String| {
            test.map(value).unwrap_or_default()
        };
        scatter.push(vec![
            one.response.as_str().into(),
            one.readings.to_string().into(),
            shown_u(one.rms).into(),
            shown_u(one.s).into(),
            freedom(one.dof).into(),
            of_test(&|test| significant(test.expected, DIGITS)).into(),
            of_test(&|test| significant(test.chi_squared / test.dof, DIGITS)).into(),
            of_test(&|test| significant(test.p_value, 2)).into(),
            symbol(&quantity.unit).into(),
        ]);
    }
    let mut worst: Vec<_> = found.residuals.iter().collect();
    worst.sort_by(|a, b| {
        let size = |r: &crate::calibrate::Residual| {
            if r.standardised.is_nan() {
                (r.observed - r.fitted).abs()
            } else {
                r.standardised.abs()
            }
        };
        size(b).total_cmp(&size(a))
    });
    let mut table = Table::new([
        (l.pick("point", "测量点"), ColumnKind::Names),
        (l.pick("response", "响应量"), ColumnKind::Names),
        (l.pick("observed", "观测值"), ColumnKind::Numbers),
        (l.pick("equation", "方程值"), ColumnKind::Numbers),
        (l.pick("residual", "残差"), ColumnKind::Numbers),
        (l.pick("residual/s", "标准化残差"), ColumnKind::Numbers),
    ]);
    for one in worst.iter().take(RESIDUALS) {
        let s = found
            .responses
            .iter()
            .find(|r| r.response == one.response)
            .map_or(f64::NAN, |r| if r.rms > 0.0 { r.rms } else { f64::NAN });
        let residual = one.observed - one.fitted;
        table.push(vec![
            one.point.as_str().into(),
            one.response.as_str().into(),
            aligned(one.observed, s, DIGITS).into(),
            aligned(one.fitted, s, DIGITS).into(),
            significant(residual, DIGITS).into(),
            if one.standardised.is_nan() {
                NONE.to_owned()
            } else {
                significant(one.standardised, 3)
            }
            .into(),
        ]);
    }
    let way = match found.scatter {
        Scatter::Residuals => l.pick(
            "The scatter of the readings in the uncertainties above is the part of the residuals that the stated errors do not explain.",
            "上列不确定度中的读数分散性取残差中已给出误差不能解释的部分。",
        ),
        Scatter::Dwells => l.pick(
            "The scatter of the readings in the uncertainties above is that of the samples of each dwell; compare it with the residuals.",
            "上列不确定度中的读数分散性取自各驻留段的采样；请与残差比较。",
        ),
        Scatter::Stated => l.pick(
            "The uncertainties above contain the stated errors only; the residuals do not enter.",
            "上列不确定度仅含所给出的误差，未计入残差。",
        ),
    };
    let mut blocks = vec![
        Block::Section(l.pick("Residuals", "残差").to_owned()),
        Block::Table(scatter.without_empty_columns()),
        Block::Paragraph(way.to_owned()),
        Block::Table(table),
    ];
    if found.residuals.len() > RESIDUALS {
        blocks.push(Block::Paragraph(l.pick(
            format!(
                "The {RESIDUALS} largest of {}; --json has all.",
                found.residuals.len()
            ),
            format!(
                "共 {} 个残差，列出最大的 {RESIDUALS} 个；全部见 --json。",
                found.residuals.len()
            ),
        )));
    }
    blocks
}

pub(super) fn schedule(plan: &Plan, l: Language) -> Vec<Block> {
    vec![Block::Paragraph(l.pick(
        format!(
            "The schedule gives {} readings for {} parameters.",
            plan.readings, plan.identifiability.parameters
        ),
        format!(
            "该测量安排给出 {} 个读数，待求参数 {} 个。",
            plan.readings, plan.identifiability.parameters
        ),
    ))]
}

/// What the experiment tells apart.
pub(super) fn identifiability(found: &Identifiability, l: Language) -> Vec<Block> {
    let mut items = Vec::new();
    let (rank, count) = (found.rank, found.parameters);
    if rank == count {
        let condition = significant(found.condition, 3);
        items.push(l.pick(
            format!("The readings determine all {count} parameters (rank {rank}; condition number of the scaled equations {condition})."),
            format!("读数确定全部 {count} 个参数（秩 {rank}；归一化方程条件数 {condition}）。"),
        ));
    } else {
        items.push(l.pick(
            format!("The readings determine {rank} combinations of {count} parameters: not all can be found."),
            format!("读数只确定 {count} 个参数的 {rank} 个组合，不能求出全部参数。"),
        ));
    }
    let undetermined = |combination: &Combination| {
        l.pick(
            format!("Not determined: {}.", in_words(combination, l)),
            format!("不可确定：{}。", in_words(combination, l)),
        )
    };
    items.extend(found.undetermined.iter().map(undetermined));
    for near in &found.near {
        let times = significant(near.inflation, 3);
        let changes = super::trouble::changes(&near.combination);
        items.push(l.pick(
            format!("{} is nearly hidden: {changes} together change the readings by little, and its standard uncertainty is {times} times what it would be if the others were known.", near.parameter),
            format!("{} 几乎被掩盖：{changes} 同时变化时读数变化很小，其标准不确定度为其余参数已知时的 {times} 倍。", near.parameter),
        ));
    }
    vec![
        Block::Section(
            l.pick("What the experiment tells apart", "可辨识性")
                .to_owned(),
        ),
        Block::List(items),
    ]
}

/// What omitted effects would shift.
pub(super) fn aliases(
    experiment: &Experiment,
    aliases: &[Alias],
    figures: Option<&Figures>,
    l: Language,
) -> Vec<Block> {
    if aliases.is_empty() {
        return Vec::new();
    }
    let names: Vec<String> = experiment
        .parameters
        .iter()
        .map(|one| (one.name.clone(), symbol(&one.unit)))
        .chain(
            experiment
                .results
                .iter()
                .map(|one| (one.name.clone(), symbol(&one.unit))),
        )
        .map(|(name, unit)| {
            if unit.is_empty() {
                name
            } else {
                format!("{name} / {unit}")
            }
        })
        .collect();
    let mut items = Vec::new();
    for alias in aliases {
        let Some(omitted) = experiment.omitted.iter().find(|one| one.name == alias.name) else {
            continue;
        };
        let size = omitted.typical.unwrap_or(1.0);
        let unit = symbol(&omitted.unit);
        let unit = if unit.is_empty() {
            unit
        } else {
            format!(" {unit}")
        };
        let amount = format!("{} = {}{unit}", alias.name, significant(size, 3));
        let physics = omitted
            .description
            .as_ref()
            .map(|words| said(words, l))
            .unwrap_or_default();
        let physics = if physics.is_empty() {
            format!(" [{}]", omitted.term)
        } else {
            l.pick(
                format!(" ({physics}) [{}]", omitted.term),
                format!("（{physics}）[{}]", omitted.term),
            )
        };
        if !alias.acts {
            items.push(l.pick(
                format!(
                    "{}{physics}: acts on no reading of this schedule.",
                    alias.name
                ),
                format!("{}{physics}：在本安排中不影响任何读数。", alias.name),
            ));
            continue;
        }
        let largest = alias.shifts.iter().enumerate().map(|(index, shift)| {
            let u = figures.map_or(0.0, |figures| figures.coefficients[index].u);
            (
                index,
                shift * size,
                if u > 0.0 {
                    (shift * size / u).abs()
                } else {
                    f64::NAN
                },
            )
        });
        let shifts: Vec<String> = largest
            .filter(|(index, ..)| is_felt(alias, *index))
            .map(|(index, shift, ratio)| {
                let (name, unit) = names[index]
                    .split_once(" / ")
                    .unwrap_or((&names[index], ""));
                let unit = if unit.is_empty() {
                    String::new()
                } else {
                    format!(" {unit}")
                };
                let sign = if shift < 0.0 { '−' } else { '+' };
                let times = if ratio.is_nan() {
                    String::new()
                } else {
                    l.pick(
                        format!(" ({} u)", significant(ratio, 2)),
                        format!("（{} u）", significant(ratio, 2)),
                    )
                };
                format!("{name} {sign} {}{unit}{times}", significant(shift.abs(), 3))
            })
            .collect();
        let hidden = match alias.visible {
            0.0 => l.pick(
                "the residuals show nothing of it".to_owned(),
                "残差完全不显示".to_owned(),
            ),
            share => l.pick(
                format!("the residuals show {} % of it", percent(share)),
                format!("残差显示其 {} %", percent(share)),
            ),
        };
        let shifts = if shifts.is_empty() {
            l.pick(
                "shifts no coefficient".to_owned(),
                "不使系数偏移".to_owned(),
            )
        } else {
            l.pick(
                format!("shifts {}", shifts.join(", ")),
                format!("使 {}", shifts.join("，")),
            )
        };
        items.push(l.pick(
            format!("{amount}{physics} {shifts}; {hidden}."),
            format!("{amount}{physics} {shifts}；{hidden}。"),
        ));
    }
    vec![
        Block::Section(
            l.pick(
                "What effects outside the equations would shift",
                "方程未计入的效应会引起的偏移",
            )
            .to_owned(),
        ),
        Block::List(items),
    ]
}

/// Shifts that are no rounding noise of the largest one.
fn is_felt(alias: &Alias, index: usize) -> bool {
    let largest = alias
        .shifts
        .iter()
        .fold(0.0_f64, |most, s| most.max(s.abs()));
    alias.shifts[index].abs() > 1e-9 * largest
}

/// Residuals that are larger or smaller than the known errors of the readings let expect. Where the
/// residuals tell the scatter themselves, they may be larger.
fn misfit(one: &ResponseScatter, way: Scatter, sampled: bool, l: Language) -> Option<String> {
    /// Probability of a χ² as far out.
    const RARE: f64 = 0.005;
    let test = one.test?;
    let ratio = significant(test.chi_squared / test.dof, 3);
    let response = &one.response;
    if test.p_value < RARE && way == Scatter::Residuals && sampled {
        let times = significant((test.chi_squared / test.dof).sqrt(), 2);
        Some(l.pick(
            format!("The residuals of {response} are {times} times as large as the samples of the dwells let expect: something changes from dwell to dwell that is still within each, labels or reference values are wrong, or the equations leave something out."),
            format!("{response} 的残差为驻留段采样预期的 {times} 倍：可能有在驻留段内稳定、段间变化的因素，标签或参考值有误，或方程有遗漏。"),
        ))
    } else if test.p_value < RARE && way != Scatter::Residuals {
        let p = significant(test.p_value, 2);
        Some(l.pick(
            format!("The residuals of {response} are larger than the errors of its readings let expect (χ²/ν = {ratio}, p = {p}): the equations leave something out, or the errors are larger than stated. The uncertainties above do not contain this."),
            format!("{response} 的残差大于其读数误差的预期（χ²/ν = {ratio}，p = {p}）：方程有遗漏，或误差大于所给出的值。上列不确定度未包含这一差异。"),
        ))
    } else if test.p_value > 1.0 - RARE {
        Some(l.pick(
            format!("The residuals of {response} are smaller than the errors of its readings let expect (χ²/ν = {ratio}): these errors may be stated too large, or be common to the readings."),
            format!("{response} 的残差小于其读数误差的预期（χ²/ν = {ratio}）：误差可能给得过大，或为各读数共有。"),
        ))
    } else {
        None
    }
}

/// What a reader must know.
pub(super) fn remarks(
    experiment: &Experiment,
    found: Option<&Calibration>,
    assumed: &[String],
    l: Language,
) -> Vec<Block> {
    let mut items: Vec<String> = Vec::new();
    for finding in &experiment.points.findings {
        items.push(format!("{}; {}.", finding.message(), finding.advice()));
    }
    if let Some(found) = found {
        if found.left_out > 0 {
            items.push(l.pick(
                format!(
                    "{} readings were left out, because a value is missing.",
                    found.left_out
                ),
                format!("有 {} 个读数因缺值而未使用。", found.left_out),
            ));
        }
        if let Some([first, second]) = &found.swapped {
            items.push(l.pick(
                format!("The readings of {first} and {second} look exchanged: with each in the other's place the residuals would be less than a tenth of what they are. Check their labels before using these figures."),
                format!("{first} 与 {second} 的读数疑似互换：交换后残差不到现在的十分之一。使用结果前请核对其标签。"),
            ));
        }
        let columns = &experiment.points.columns;
        let sampled = columns.iter().any(|column| !column.averages.is_empty());
        let misfit = |one: &ResponseScatter| misfit(one, found.scatter, sampled, l);
        items.extend(found.responses.iter().filter_map(misfit));
    }
    if !assumed.is_empty() {
        let names = assumed.join(", ");
        items.push(l.pick(
            format!("No values of {names} are stated, and zero was assumed: effects that are proportional to them are not seen. State roughly what is expected: [parameter.{}] start = ….", assumed[0]),
            format!("{names} 未给出数值，按零计算：与之成比例的效应未体现。请给出预期值：[parameter.{}] start = …。", assumed[0]),
        ));
    }
    let said = experiment
        .remarks
        .iter()
        .map(|remark| l.pick(remark.en.clone(), remark.zh.clone()));
    items.extend(said);
    if items.is_empty() {
        return Vec::new();
    }
    vec![
        Block::Section(l.word(Word::Remarks).to_owned()),
        Block::List(items),
    ]
}
