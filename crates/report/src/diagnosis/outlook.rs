//! A plan as blocks and for machines: what an experiment can see and tell apart.

use serde_json::{Value, json};

use crate::diagnose::case::Case;
use crate::diagnose::{Outlook, Promise, Prospect};
use crate::document::Block;
use crate::document::{ColumnKind, Table};
use crate::language::Language;
use crate::number::{NONE, percent, significant};

use super::json::{estimates, finite, measure_json};
use super::open;
use super::words::{self, assumed_noise, full_name, label, measure, name};

/// Name and version of the format.
pub const FORMAT: &str = "gumption-outlook-1";

/// The whole report.
pub(super) fn blocks(case: &Case, outlook: &Outlook, language: Language) -> Vec<Block> {
    let mut blocks = vec![
        Block::Title(case.title.clone()),
        Block::Statement(vec![statement(outlook, language)]),
        Block::Fields(fields(case, outlook, language)),
        Block::Section(language.pick("What it would see", "可见的影响").into()),
        Block::Table(effects(outlook, language)),
        Block::Paragraph(
            language
                .pick(
                    "Sizes are the largest shift of the output. “detected” is seen as good as always (λ = 6), “told apart” is told from the nearest rival as good as always (κ = 5), “usual” would not surprise.",
                    "大小为输出的最大偏移。“可检出”指几乎总能发现（λ = 6），“可区分”指几乎总能与最接近的解释区分（κ = 5），“常见”为不足为奇的大小。",
                )
                .to_owned(),
        ),
    ];
    blocks.extend(classes(outlook, language));
    blocks.extend(open::omitted(
        &outlook.cells,
        &outlook.omitted,
        &outlook.unknowns,
        language,
    ));
    blocks.extend(parameters(outlook, language));
    blocks.extend(extras(outlook, language));
    blocks
}

/// What would help most, in one sentence.
fn statement(outlook: &Outlook, language: Language) -> String {
    let seen = outlook.effects.len();
    let hidden = outlook
        .omitted
        .iter()
        .filter(|line| line.is_invisible())
        .count();
    let close = outlook.pairs.len();
    let best = outlook.extras.first().filter(|promise| useful(promise));
    let advice = best.map_or(String::new(), |promise| {
        let what = measure(&promise.extra.measure, language);
        language.pick(
            format!(" Most useful beside it: {what}."),
            format!("最有用的补充测量：{what}。"),
        )
    });
    language.pick(
        format!("This experiment shows {seen} of the effects in the catalogue and cannot show {hidden}; {close} pairs are hard or impossible to tell apart.{advice}"),
        format!("此试验可显示目录中的 {seen} 种影响，{hidden} 种无法显示；{close} 对难以或不能区分。{advice}"),
    )
}

fn useful(promise: &Promise) -> bool {
    !promise.resolved.is_empty() || !promise.revealed.is_empty()
}

fn fields(case: &Case, outlook: &Outlook, language: Language) -> Vec<(String, String)> {
    let mut fields = vec![
        (
            language.pick("Declared model", "声明的模型").into(),
            case.model.join("; "),
        ),
        (
            language.pick("Design", "设计").into(),
            language.pick(
                format!("{} rows, {} observations", case.rows, outlook.observations),
                format!("{} 行，{} 个观测值", case.rows, outlook.observations),
            ),
        ),
        (
            language.pick("Noise", "噪声").into(),
            assumed_noise(case, &outlook.noise, language),
        ),
    ];
    if !outlook.assumed.is_empty() {
        let names = outlook.assumed.join(", ");
        fields.push((
            language.pick("Taken as 1", "取为 1").into(),
            language.pick(
                format!("{names}; state `start` below [parameter] where slopes depend on them"),
                format!("{names}；若斜率与其有关，请在 [parameter] 中给出 start"),
            ),
        ));
    }
    fields
}

fn effects(outlook: &Outlook, language: Language) -> Table {
    let mut table = Table::new([
        (language.pick("effect", "影响"), ColumnKind::Wrapped),
        (language.pick("visible", "可见"), ColumnKind::Numbers),
        (language.pick("detected", "可检出"), ColumnKind::Numbers),
        (language.pick("told apart", "可区分"), ColumnKind::Numbers),
        (language.pick("usual", "常见"), ColumnKind::Numbers),
        (
            language.pick("nearest rival", "最接近的解释"),
            ColumnKind::Wrapped,
        ),
    ]);
    for prospect in &outlook.effects {
        let rival = prospect.rival.map_or(String::new(), |(cell, _)| {
            full_name(&outlook.cells[cell], language)
        });
        let alone = prospect.rival.is_none();
        let separable = match prospect.separable {
            Some(size) => significant(size, 2),
            None if alone => String::new(),
            None => NONE.to_owned(),
        };
        table.push(vec![
            prospect_name(outlook, prospect, language).into(),
            format!("{} %", percent(prospect.visibility)).into(),
            significant(prospect.detectable, 2).into(),
            separable.into(),
            prospect
                .typical
                .map_or(String::new(), |s| significant(s, 2))
                .into(),
            rival.into(),
        ]);
    }
    table
}

fn prospect_name(outlook: &Outlook, prospect: &Prospect, language: Language) -> String {
    let cell = &outlook.cells[prospect.cell];
    let label = label(&cell.variants[prospect.variation], language);
    let own = name(cell, language);
    if label.is_empty() {
        own
    } else {
        format!("{own} ({label})")
    }
}

fn classes(outlook: &Outlook, language: Language) -> Vec<Block> {
    if outlook.classes.is_empty() {
        return Vec::new();
    }
    let lines = outlook.classes.iter().map(|class| {
        let names = class
            .iter()
            .map(|cell| full_name(&outlook.cells[*cell], language));
        names.collect::<Vec<_>>().join(" = ")
    });
    vec![
        Block::Section(
            language
                .pick("One and the same in this experiment", "在此试验中完全等效")
                .into(),
        ),
        Block::List(lines.collect()),
    ]
}

fn parameters(outlook: &Outlook, language: Language) -> Vec<Block> {
    let mut table = Table::new([
        (language.pick("parameter", "参数"), ColumnKind::Names),
        (language.pick("expected u", "预期 u"), ColumnKind::Numbers),
        (language.pick("unit", "单位"), ColumnKind::Names),
    ]);
    for unknown in outlook.unknowns.iter().take(30) {
        table.push(vec![
            words::unknown(&unknown.name, language).into(),
            significant(unknown.u, 2).into(),
            unknown.unit.as_str().into(),
        ]);
    }
    vec![
        Block::Section(language.pick("Parameters", "参数").into()),
        Block::Table(table.without_empty_columns()),
    ]
}

fn extras(outlook: &Outlook, language: Language) -> Vec<Block> {
    let mut table = Table::new([
        (
            language.pick("further measurement", "补充测量"),
            ColumnKind::Wrapped,
        ),
        (language.pick("cost", "代价"), ColumnKind::Numbers),
        (language.pick("tells apart", "可区分"), ColumnKind::Wrapped),
        (
            language.pick("makes visible", "使之可见"),
            ColumnKind::Wrapped,
        ),
    ]);
    for promise in &outlook.extras {
        table.push(vec![
            measure(&promise.extra.measure, language).into(),
            significant(promise.extra.cost, 2).into(),
            told_apart(outlook, promise, language).into(),
            revealed(outlook, promise, language).into(),
        ]);
    }
    vec![
        Block::Section(
            language
                .pick("Which further measurement helps most", "最有用的补充测量")
                .into(),
        ),
        Block::Table(table),
    ]
}

/// How many pairs, and some of those that the fewest measurements tell apart.
fn told_apart(outlook: &Outlook, promise: &Promise, language: Language) -> String {
    let (count, all) = (promise.resolved.len(), outlook.pairs.len());
    if count == 0 {
        return NONE.to_owned();
    }
    let helpers = |at: usize| {
        let with = outlook.extras.iter().filter(|p| p.resolved.contains(&at));
        with.count()
    };
    let mut pairs = promise.resolved.clone();
    pairs.sort_by_key(|at| helpers(*at));
    let names = pairs.iter().map(|at| pair(outlook, *at, language));
    let names = shortened(names.collect(), language);
    language.pick(
        format!("{count} of {all}: {names}"),
        format!("{all} 对中的 {count} 对：{names}"),
    )
}

fn revealed(outlook: &Outlook, promise: &Promise, language: Language) -> String {
    let names = promise.revealed.iter();
    let names = names.map(|cell| full_name(&outlook.cells[*cell], language));
    shortened(names.collect(), language)
}

fn pair(outlook: &Outlook, at: usize, language: Language) -> String {
    let (a, b) = outlook.pairs[at];
    let of = |cell: usize| full_name(&outlook.cells[cell], language);
    format!("{} | {}", of(a), of(b))
}

/// A few of a list, and how many there are.
fn shortened(list: Vec<String>, language: Language) -> String {
    const SHOWN: usize = 2;
    if list.is_empty() {
        return NONE.to_owned();
    }
    let rest = list.len().saturating_sub(SHOWN);
    let mut text = list[..list.len().min(SHOWN)].join("; ");
    if rest > 0 {
        text += &language.pick(format!("; {rest} more"), format!("；另 {rest} 项"));
    }
    text
}

/// Everything, for machines.
pub fn json(case: &Case, outlook: &Outlook, language: Language) -> Value {
    let cell = |at: usize| &outlook.cells[at];
    let unknowns = || outlook.unknowns.iter().map(|u| u.name.clone()).collect();
    json!({
        "format": FORMAT,
        "title": case.title,
        "statement": statement(outlook, language),
        "model": case.model,
        "rows": case.rows,
        "observations": outlook.observations,
        "noise": { "claimed": !outlook.relative, "origin": assumed_noise(case, &outlook.noise, language) },
        "assumed": outlook.assumed,
        "parameters": estimates(&outlook.unknowns).into_iter().map(|mut one| {
            if let Some(fields) = one.as_object_mut() { fields.remove("value"); }
            one
        }).collect::<Vec<_>>(),
        "effects": outlook.effects.iter().map(|p| json!({
            "id": cell(p.cell).effect.id.as_str(),
            "name": name(cell(p.cell), language),
            "variant": cell(p.cell).variants[p.variation].label,
            "visibility": finite(p.visibility),
            "detectable": finite(p.detectable),
            "separable": p.separable,
            "usual": p.typical,
            "rival": p.rival.map(|(rival, cosine)| json!({ "id": cell(rival).effect.id.as_str(), "name": name(cell(rival), language), "cosine": finite(cosine) })),
        })).collect::<Vec<_>>(),
        "classes": outlook.classes.iter().map(|class| class.iter().map(|at| full_name(cell(*at), language)).collect::<Vec<_>>()).collect::<Vec<_>>(),
        "omitted": outlook.omitted.iter().map(|line| open::omitted_json(&outlook.cells, line, unknowns(), language)).collect::<Vec<_>>(),
        "pairs": (0..outlook.pairs.len()).map(|at| pair(outlook, at, language)).collect::<Vec<_>>(),
        "measurements": outlook.extras.iter().map(|promise| json!({
            "name": measure(&promise.extra.measure, language),
            "measure": measure_json(&promise.extra.measure),
            "cost": promise.extra.cost,
            "rows": promise.extra.rows.count,
            "tells_apart": promise.resolved.iter().map(|at| pair(outlook, *at, language)).collect::<Vec<_>>(),
            "makes_visible": promise.revealed.iter().map(|at| full_name(cell(*at), language)).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
    })
}
