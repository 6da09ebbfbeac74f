//! The dossier: what was verified, with what, how, the result; then every example.

use crate::language::Language;
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
        section("Result", "结果", l),
        Block::List(words::closing(verification, l)),
        section("Purpose", "目的与范围", l),
    ];
    blocks.extend(
        purpose(l)
            .into_iter()
            .map(|text| Block::Paragraph(text.to_string())),
    );
    blocks.push(section("How the figures were compared", "比较方法", l));
    blocks.push(Block::List(
        method(l).into_iter().map(String::from).collect(),
    ));
    blocks.push(section("Contents", "目录", l));
    blocks.push(Block::Table(contents(verification, l)));
    blocks.extend(not_gating(verification, l));
    for (index, one) in verification.examples.iter().enumerate() {
        blocks.extend(example::blocks(index + 1, one, l));
    }
    blocks.push(section("Record of the laboratory", "实验室记录", l));
    blocks.push(Block::Table(record(l)));
    blocks.push(Block::Footer(vec![format!(
        "gumption {}, {}",
        environment.version, environment.date
    )]));
    blocks
}

fn section(english: &str, chinese: &str, l: Language) -> Block {
    Block::Section(l.pick(english, chinese).to_string())
}

fn identification(verification: &Verification, l: Language) -> Vec<(String, String)> {
    let environment = &verification.environment;
    let seeds: Vec<String> = verification.seeds().iter().map(u64::to_string).collect();
    let seeds = match seeds.as_slice() {
        [] => l
            .pick("none: Monte Carlo was not run", "未运行蒙特卡洛法")
            .to_string(),
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
pub(super) fn purpose(l: Language) -> Vec<&'static str> {
    l.pick(
        vec![
            "ISO/IEC 17025:2017, 7.11.2 requires a laboratory to validate the functioning of its information management systems, calculation software included, before it uses them. This document records that the program named above, on the platform named above, was run on published examples of uncertainty evaluation and on certified data sets, and holds every figure that it obtained against the published one.",
            "It does not validate the laboratory's own budgets: their models and data remain to be reviewed for each measurement. It holds for this version on this kind of computer; after a change of either, `gumption verify --report DIR` makes it anew.",
        ],
        vec![
            "ISO/IEC 17025:2017 第 7.11.2 条要求实验室在使用信息管理系统（包括计算软件）之前确认其功能。本报告记录：上述程序在上述平台上对公开发表的不确定度评定示例和有证数据集进行了计算，并将得到的每个数值与发表值逐一比较。",
            "本报告不能替代对实验室自己的评定文件的审核：每项测量的测量模型和数据仍须另行审核。本报告只对该版本和该类计算机有效；二者之一改变后，应运行 `gumption verify --report DIR` 重新验证。",
        ],
    )
}

/// How the figures were compared.
pub(super) fn method(l: Language) -> Vec<&'static str> {
    l.pick(
        vec![
            "Each example is a budget file that describes a measurement and states, as claims, the figures of its source. The program evaluates it as it would a user's own file, by the law of propagation of uncertainty (GUM, JCGM 100) and by the Monte Carlo method (JCGM 101 and JCGM 102). Claims are compared with what is obtained and never used in obtaining it.",
            "A figure agrees when it differs from the published one by no more than the tolerance: half a unit of the last digit published, or what the file states where the source rounded intermediate results or took its figure from a Monte Carlo run of its own. An expanded uncertainty agrees also when it becomes the published one by rounding as the conventions of the file say.",
            "Where the tolerance is a number of digits, correct significant digits are counted as the log relative error, -log10(|obtained - published| / |published|), up to the 16 that double precision has.",
            "An example passes when all of its figures agree, in every row of a series. Figures whose source is known in part only (confidence `low` in the file) are shown and marked as not gating: no verdict depends on them. Files without claims do not count.",
            "Monte Carlo results follow from the seed alone; they depend neither on the number of threads nor on the instruction set.",
        ],
        vec![
            "每个示例是一个评定文件，其中描述测量过程，并以声称值（claim）给出来源文献中的数值。程序像计算用户文件一样，按不确定度传播律（GUM，JCGM 100）和蒙特卡洛法（JCGM 101、JCGM 102）进行计算。声称值只用于比较，从不参与计算。",
            "计算值与发表值之差不超过允差时为一致。允差为发表值末位的半个单位；来源文献对中间结果作过修约，或其数值出自其自身的蒙特卡洛计算时，允差由文件给出。扩展不确定度按文件所定的规则修约后等于发表值的，也为一致。",
            "允差以位数表示时，正确有效位数为对数相对误差 -log10(|计算值 - 发表值| / |发表值|)，最多取双精度数的 16 位。",
            "示例的所有数值（系列文件的每一行）均一致时，该示例通过。来源不完整的数值（文件中 confidence 为 `low`）仅列出并注明“不作判据”，不影响结论。没有声称值的文件不计入。",
            "蒙特卡洛法的结果只取决于种子，与线程数和指令集无关。",
        ],
    )
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
        section("Shown, but not gating", "仅列出、不作判据的内容", l),
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
