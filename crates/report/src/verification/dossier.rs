//! The dossier: what was verified, with what, how, the result; then every example.

use crate::language::Language;
use crate::phrase::section;
use gumption_fault::say;
use gumption_format::document::Block;
use gumption_format::document::{Cell, ColumnKind, Table};
use gumption_verify::{Verdict, Verification};

use super::{example, words};

pub(super) fn blocks(verification: &Verification, l: Language) -> Vec<Block> {
    let environment = &verification.environment;
    let mut blocks = vec![
        Block::Title(say!("Verification of gumption {}", environment.version).in_language(l)),
        Block::Fields(identification(verification, l)),
        section(l, "Result", "结果"),
        Block::List(words::closing(verification, l)),
        section(l, "Purpose", "目的与范围"),
    ];
    blocks.extend(purpose(l).into_iter().map(Block::Paragraph));
    blocks.push(section(l, "How the figures were compared", "比较方法"));
    blocks.push(Block::List(method(l)));
    blocks.push(section(l, "Contents", "目录"));
    blocks.push(Block::Table(contents(verification, l)));
    blocks.extend(not_gating(verification, l));
    for (index, one) in verification.examples.iter().enumerate() {
        blocks.extend(example::blocks(index + 1, one, l));
    }
    blocks.push(section(l, "Record of the laboratory", "实验室记录"));
    blocks.push(Block::Table(record(l)));
    blocks.push(Block::Footer(vec![format!(
        "gumption {}, {}",
        environment.version, environment.date
    )]));
    blocks
}

fn identification(verification: &Verification, l: Language) -> Vec<(String, String)> {
    let environment = &verification.environment;
    let seeds: Vec<String> = verification.seeds().iter().map(u64::to_string).collect();
    let seeds = match seeds.as_slice() {
        [] => say!("none: Monte Carlo was not run").in_language(l),
        list => list.join(", "),
    };
    let field =
        |english: &str, chinese: &str, text: String| (l.pick(english, chinese).to_string(), text);
    vec![
        field(
            "Program",
            "程序",
            format!("gumption {}", environment.version),
        ),
        field("Date", "日期", environment.date.clone()),
        field(
            "Platform (operating system, architecture, instruction set)",
            "平台（操作系统、处理器架构、指令集）",
            format!(
                "{}, {}, {}",
                environment.os, environment.architecture, environment.instruction_set
            ),
        ),
        field("Seed of the random numbers", "随机数种子", seeds),
    ]
}

/// What the dossier shows, and what it does not.
pub(super) fn purpose(l: Language) -> Vec<String> {
    [
say!("ISO/IEC 17025:2017, 7.11.2 requires a laboratory to validate the functioning of its information management systems, calculation software included, before it uses them. This document records that the program named above, on the platform named above, was run on published examples of uncertainty evaluation and on certified data sets, and holds every figure that it obtained against the published one."),
say!("It does not validate the laboratory's own budgets: their models and data remain to be reviewed for each measurement. It holds for this version on this kind of computer; after a change of either, `gumption verify --report DIR` makes it anew."),
].map(|said| said.in_language(l)).to_vec()
}

/// How the figures were compared.
pub(super) fn method(l: Language) -> Vec<String> {
    [
say!("Each example is a budget file that describes a measurement and states, as claims, the figures of its source. The program evaluates it as it would a user's own file, by the law of propagation of uncertainty (GUM, JCGM 100) and by the Monte Carlo method (JCGM 101 and JCGM 102). Claims are compared with what is obtained and never used in obtaining it."),
say!("A figure agrees when it differs from the published one by no more than the tolerance: half a unit of the last digit published, or what the file states where the source rounded intermediate results or took its figure from a Monte Carlo run of its own. An expanded uncertainty agrees also when it becomes the published one by rounding as the conventions of the file say."),
say!("Where the tolerance is a number of digits, correct significant digits are counted as the log relative error, -log10(|obtained - published| / |published|), up to the 16 that double precision has."),
say!("An example passes when all of its figures agree, in every row of a series. Figures whose source is known in part only (confidence `low` in the file) are shown and marked as not gating: no verdict depends on them. Files without claims do not count."),
say!("Monte Carlo results follow from the seed alone; they depend neither on the number of threads nor on the instruction set."),
].map(|said| said.in_language(l)).to_vec()
}

fn contents(verification: &Verification, l: Language) -> Table {
    let mut table = Table::new([
        (l.pick("no.", "序号"), ColumnKind::Numbers),
        (l.pick("example", "示例"), ColumnKind::Wrapped),
        (l.pick("file", "文件"), ColumnKind::Names),
        (l.pick("source", "来源"), ColumnKind::Wrapped),
        (l.pick("figures", "数值个数"), ColumnKind::Numbers),
        (l.pick("verdict", "结论"), ColumnKind::Words),
    ]);
    for (index, one) in verification.examples.iter().enumerate() {
        let number = index + 1;
        table.push(vec![
            number.to_string().into(),
            one.heading.titled(l).into(),
            one.file.clone().into(),
            one.heading.reference.clone().unwrap_or_default().into(),
            one.figures().count().to_string().into(),
            words::verdict(one.verdict(), l).into(),
        ]);
    }
    table
}

/// What decided nothing, and why.
fn not_gating(verification: &Verification, l: Language) -> Vec<Block> {
    let mut items = Vec::new();
    for (index, one) in verification.examples.iter().enumerate() {
        let shown = one.figures().filter(|(row, c)| !row.gates(c)).count();
        if shown > 0 {
            let heading = words::heading(index + 1, l);
            let file = &one.file;
            let all = one.verdict() == Verdict::NotGating;
            items.push(match (all, l) {
                (true, Language::English) => format!("{heading}, {file}: all {shown} figures"),
                (true, Language::Chinese) => format!("{heading}，{file}：全部 {shown} 个数值"),
                (false, Language::English) => {
                    format!("{heading}, {file}: {shown} of its figures")
                }
                (false, Language::Chinese) => format!("{heading}，{file}：其中 {shown} 个数值"),
            });
        }
    }
    for file in &verification.without_claims {
        items.push(say!("{file}: states no claim").in_language(l));
    }
    if items.is_empty() {
        items.push(
            l.pick("Nothing: every figure decides.", "无：所有数值均作判据。")
                .to_string(),
        );
    }
    vec![
        section(l, "Shown, but not gating", "仅列出、不作判据的内容"),
        Block::List(items),
    ]
}

/// Room for names and dates.
fn record(l: Language) -> Table {
    let mut table = Table::new([
        ("", ColumnKind::Names),
        (l.pick("name", "姓名"), ColumnKind::Words),
        (l.pick("date", "日期"), ColumnKind::Words),
        (l.pick("signature", "签名"), ColumnKind::Words),
    ]);
    for role in [
        l.pick("verified by", "验证人"),
        l.pick("reviewed by", "审核人"),
        l.pick("approved for use by", "批准人"),
    ] {
        table.push(vec![role.into(), Cell::Empty, Cell::Empty, Cell::Empty]);
    }
    table
}
