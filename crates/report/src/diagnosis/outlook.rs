//! A plan as blocks: what an experiment can see and tell apart.

use crate::language::Language;
use crate::number::{NONE, percent, significant};
use crate::phrase::{section, table};
use gumption_fault::say;
use gumption_format::document::{
    Block,
    ColumnKind::{Names as NamesColumn, Numbers, Wrapped},
    Table,
};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::{Outlook, Promise};

use super::names::{Names, unknown};
use super::noise::assumed_noise;
use super::open;
use super::words::measure;

/// The whole report.
pub(super) fn blocks(case: &Case, outlook: &Outlook, l: Language) -> Vec<Block> {
    let names = Names::of_outlook(outlook, l);
    let mut blocks = vec![
        Block::Title(case.title.clone()),
        Block::Statement(vec![statement(outlook, l)]),
        Block::Fields(fields(case, outlook, l)),
        section(l, "What it would see", "可见的影响"),
        Block::Table(effects(outlook, names)),
        Block::Paragraph(say!("Sizes are the largest shift of the output. “detected” is seen as good as always (λ = 6), “told apart” is told from the nearest rival as good as always (κ = 5), “usual” would not surprise.").in_language(l)),
    ];
    blocks.extend(classes(outlook, names));
    blocks.extend(open::unseen(&outlook.unseen(), &outlook.unknowns, names));
    blocks.extend(parameters(outlook, l));
    blocks.push(section(
        l,
        "Which further measurement helps most",
        "最有用的补充测量",
    ));
    blocks.push(Block::Table(extras(outlook, names)));
    blocks
}

/// What would help most, in one sentence.
pub(super) fn statement(outlook: &Outlook, l: Language) -> String {
    let (seen, hidden) = (outlook.effects.len(), outlook.invisible());
    let close = outlook.pairs.len();
    let advice = outlook.best().map_or(String::new(), |promise| {
        let what = measure(&promise.extra.measure, l);
        say!(" Most useful beside it: {what}.").in_language(l)
    });
    say!("This experiment shows {seen} of the effects in the catalogue and cannot show {hidden}; {close} pairs are hard or impossible to tell apart.{advice}").in_language(l)
}

fn fields(case: &Case, outlook: &Outlook, l: Language) -> Vec<(String, String)> {
    let (rows, observations) = (case.rows, outlook.observations);
    let design = say!("{rows} rows, {observations} observations").in_language(l);
    let mut fields = vec![
        (
            l.pick("Declared model", "声明的模型").into(),
            case.model_lines().join("; "),
        ),
        (l.pick("Design", "设计").into(), design),
        (
            l.pick("Noise", "噪声").into(),
            assumed_noise(case, &outlook.noise, l),
        ),
    ];
    if !outlook.assumed.is_empty() {
        let names = outlook.assumed.join(", ");
        let assumed = say!("{names}; state `start` below [parameter] where slopes depend on them")
            .in_language(l);
        fields.push((l.pick("Taken as 1", "取为 1").into(), assumed));
    }
    fields
}

fn effects(outlook: &Outlook, names: Names<'_>) -> Table {
    let mut table = table(
        names.l,
        [
            ("effect", "影响", Wrapped),
            ("visible", "可见", Numbers),
            ("detected", "可检出", Numbers),
            ("told apart", "可区分", Numbers),
            ("usual", "常见", Numbers),
            ("nearest rival", "最接近的解释", Wrapped),
        ],
    );
    let size = |size: Option<f64>| size.map(|size| significant(size, 2));
    for prospect in &outlook.effects {
        let separable = match prospect.rival {
            None => String::new(),
            Some(_) => size(prospect.separable).unwrap_or_else(|| NONE.to_owned()),
        };
        let rival = prospect.rival.map(|(cell, _)| names.full(cell));
        table.push(vec![
            names.variant((prospect.cell, prospect.variation)).into(),
            format!("{} %", percent(prospect.visibility)).into(),
            significant(prospect.detectable, 2).into(),
            separable.into(),
            size(prospect.typical).unwrap_or_default().into(),
            rival.unwrap_or_default().into(),
        ]);
    }
    table
}

fn classes(outlook: &Outlook, names: Names<'_>) -> Vec<Block> {
    if outlook.classes.is_empty() {
        return Vec::new();
    }
    let lines = outlook.classes.iter().map(|class| {
        let names = class.iter().map(|cell| names.full(*cell));
        names.collect::<Vec<_>>().join(" = ")
    });
    vec![
        section(
            names.l,
            "One and the same in this experiment",
            "在此试验中完全等效",
        ),
        Block::List(lines.collect()),
    ]
}

fn parameters(outlook: &Outlook, l: Language) -> Vec<Block> {
    /// Longer lists, one for each label, are in the JSON.
    const MOST: usize = 30;
    let columns = [
        ("parameter", "参数", NamesColumn),
        ("expected u", "预期 u", Numbers),
        ("unit", "单位", NamesColumn),
    ];
    let mut table = table(l, columns);
    for own in outlook.unknowns.iter().take(MOST) {
        table.push(vec![
            unknown(&own.name, l).into(),
            significant(own.u, 2).into(),
            own.unit.as_str().into(),
        ]);
    }
    vec![
        section(l, "Parameters", "参数"),
        Block::Table(table.without_empty_columns()),
    ]
}

fn extras(outlook: &Outlook, names: Names<'_>) -> Table {
    let mut table = table(
        names.l,
        [
            ("further measurement", "补充测量", Wrapped),
            ("cost", "代价", Numbers),
            ("tells apart", "可区分", Wrapped),
            ("makes visible", "使之可见", Wrapped),
        ],
    );
    for promise in &outlook.extras {
        let revealed = promise.revealed.iter().map(|cell| names.full(*cell));
        table.push(vec![
            measure(&promise.extra.measure, names.l).into(),
            significant(promise.extra.cost, 2).into(),
            told_apart(outlook, promise, names).into(),
            shortened(revealed.collect(), names.l).into(),
        ]);
    }
    table
}

/// How many pairs, and some of those that the fewest measurements tell apart.
fn told_apart(outlook: &Outlook, promise: &Promise, names: Names<'_>) -> String {
    let (count, all) = (promise.resolved.len(), outlook.pairs.len());
    let pairs = outlook.rarest_first(promise).into_iter();
    let pairs = shortened(pairs.map(|at| pair(outlook, at, names)).collect(), names.l);
    match count {
        0 => NONE.to_owned(),
        _ => say!("{count} of {all}: {pairs}").in_language(names.l),
    }
}

/// Both of a pair that is hard to tell apart.
pub(super) fn pair(outlook: &Outlook, at: usize, names: Names<'_>) -> String {
    let (a, b) = outlook.pairs[at];
    format!("{} | {}", names.full(a), names.full(b))
}

/// A few of a list, and how many there are.
fn shortened(list: Vec<String>, l: Language) -> String {
    const SHOWN: usize = 2;
    if list.is_empty() {
        return NONE.to_owned();
    }
    let shown = list[..list.len().min(SHOWN)].join("; ");
    match list.len().saturating_sub(SHOWN) {
        0 => shown,
        rest => say!("{shown}; {rest} more").in_language(l),
    }
}
