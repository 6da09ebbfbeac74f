//! The report as a sequence of blocks, in the order in which it is read.

use gumption_core::quantity::Rounding;
use gumption_fault::say;
use gumption_gum::budget::{CoverageRule, TScale};
use gumption_gum::propagate::CoverageBasis;

use crate::language::{Language, Word};
use crate::number::{exact, probability};
use crate::phrase::plural;
use crate::{
    Report, analyses, budget_table, claim, comparison, decisions, fits, indices, joint, remarks,
    statement,
};
use gumption_format::document::Block;

/// All blocks of a report.
pub(super) fn compose(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let mut blocks = heading(report);
    blocks.extend(model(report));
    blocks.extend(taken(report));
    blocks.extend(budget_table::constants(report));
    blocks.extend(fits::blocks(report));
    let several = report.evaluation.results.len() > 1;
    for m in 0..report.evaluation.results.len() {
        let name = report.measurand(m).0;
        blocks.push(Block::Section(
            say!("Uncertainty budget of {name}").in_language(l),
        ));
        blocks.extend(budget_table::blocks(report, m));
        let head = Word::SideBySide.of(l);
        blocks.push(Block::Section(if several {
            l.with_head(name, head)
        } else {
            head.to_string()
        }));
        blocks.extend(comparison::blocks(report, m));
        blocks.extend(indices::blocks(report, m));
    }
    blocks.extend(joint::blocks(report));
    blocks.extend(decisions::blocks(report));
    blocks.extend(budget_table::origins(report));
    blocks.extend(analyses::blocks(report));
    blocks.extend(budget_table::correlated(report));
    blocks.extend(claim::blocks(report));
    let remarks = remarks::remarks(report);
    if !remarks.is_empty() {
        blocks.push(Block::Section(Word::Remarks.of(l).to_string()));
        blocks.push(Block::Findings(remarks));
    }
    let sentences = statement::statement(report);
    if !sentences.is_empty() {
        blocks.push(Block::Section(Word::Statement.of(l).to_string()));
        blocks.push(Block::Statement(sentences));
    }
    blocks.push(Block::Footer(footer(report)));
    blocks
}

fn heading(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let heading = &report.budget.heading;
    let title = match report.label {
        Some(label) => format!("{} · {label}", report.title()),
        None => report.title(),
    };
    let mut fields: Vec<(String, String)> = [
        (Word::Method, &heading.method),
        (Word::Object, &heading.object),
        (Word::Author, &heading.author),
        (Word::Date, &heading.date),
        (Word::Source, &heading.reference),
        (Word::Note, &heading.note),
    ]
    .into_iter()
    .filter_map(|(word, text)| Some((word.of(l).to_string(), text.clone()?)))
    .collect();
    for measurand in &report.budget.measurands {
        if let Some(description) = &measurand.description {
            fields.push((
                Word::Measurand.of(l).to_string(),
                format!("{}: {description}", measurand.name),
            ));
        }
    }
    let mut blocks = vec![Block::Title(title)];
    if !fields.is_empty() {
        blocks.push(Block::Fields(fields));
    }
    blocks
}

fn model(report: &Report<'_>) -> Vec<Block> {
    let mut lines: Vec<String> = Vec::new();
    for output in report.budget.model.outputs() {
        // Several measurands of one model share their first statements.
        for line in output.equation.lines() {
            // A parameter of a fit that is reported as it is needs no equation.
            let itself = line == format!("{0} = {0}", output.name);
            if !itself && !lines.iter().any(|l| l == line) {
                lines.push(line.to_string());
            }
        }
    }
    if lines.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![
        Block::Section(Word::Model.of(report.language).to_string()),
        Block::Formula(lines),
    ];
    let words: Vec<(String, String)> = report
        .budget
        .inputs
        .iter()
        .filter_map(|i| Some((i.name.to_string(), i.description.clone()?)))
        .collect();
    /// A longer list of words says nothing that the file does not say better.
    const MOST: usize = 40;
    if !words.is_empty() && words.len() <= MOST {
        blocks.push(Block::Fields(words));
    }
    blocks
}

/// Results of other files that are inputs here.
fn taken(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let results = &report.budget.chain.taken;
    if results.is_empty() {
        return Vec::new();
    }
    let stop = l.semicolon();
    let fields = results.iter().map(|taken| {
        let row = taken.row.iter().map(|row| format!("[{row}]"));
        let what = format!("{}{}", taken.measurand, row.collect::<String>());
        let file = &taken.file;
        let mut words = say!("{what} of {file}").in_language(l);
        if !taken.title.is_empty() {
            words.push_str(stop);
            words.push_str(&taken.title);
        }
        match &taken.equation {
            Some(equation) => {
                let lines: Vec<&str> = equation.lines().collect();
                words.push_str(stop);
                words.push_str(&lines.join(stop));
            }
            None => words.push_str(l.pick("; saved, in linear form", "；已保存的线性形式")),
        }
        (taken.input.clone(), words)
    });
    vec![
        Block::Section(
            l.pick("Results of other budgets", "引用的其他评定结果")
                .to_string(),
        ),
        Block::Fields(fields.collect()),
    ]
}

/// Where k comes from, and its probability.
fn coverage(report: &Report<'_>) -> String {
    let conventions = &report.budget.conventions;
    let l = report.language;
    let p = probability(conventions.coverage_probability);
    let of_output = probability(conventions.output_probability);
    let results = || report.evaluation.results.iter();
    let from_output = results()
        .filter(|result| matches!(result.gum.coverage.basis, CoverageBasis::Output { .. }))
        .count();
    match conventions.coverage_factor {
        CoverageRule::Fixed(k) => {
            let k = exact(k);
            match conventions.state_probability {
                true => say!("p = {p}, k = {k}").in_language(l),
                false => say!("k = {k}, no probability stated (intervals in this report are for {p})").in_language(l),
            }
        }
        CoverageRule::Normal => say!("p = {p}, k from the normal distribution").in_language(l),
        CoverageRule::StudentT => say!("p = {p}, k from the t-distribution").in_language(l),
        // A probability of its own, for all that is reported here.
        CoverageRule::Output if of_output != p && from_output == results().count() => say!("p = {of_output}, k from the distribution of the result, in which a few components dominate (intervals in this report are for {p})").in_language(l),
        CoverageRule::Output if of_output != p && from_output > 0 => say!("p = {p}, k from t, or for {of_output} from the distribution of the result where a few components dominate").in_language(l),
        CoverageRule::Output => say!("p = {p}, k from t, or from the distribution of the result where a few components dominate").in_language(l),
    }
}

/// Profile, what the file changed in it, and the version.
fn footer(report: &Report<'_>) -> Vec<String> {
    let conventions = &report.budget.conventions;
    let l = report.language;
    let digits = conventions.digits;
    let rounding = match (conventions.rounding, l) {
        (Rounding::HalfEven, Language::English) => "rounding to nearest, ties to even",
        (Rounding::HalfEven, Language::Chinese) => "四舍六入五成双",
        (Rounding::HalfUp, Language::English) => "rounding to nearest, ties up",
        (Rounding::HalfUp, Language::Chinese) => "四舍五入",
        (Rounding::Up, Language::English) => "U always rounded up",
        (Rounding::Up, Language::Chinese) => "U 只进不舍",
    };
    let scale = match (conventions.t_scale, l) {
        (TScale::Scale, Language::English) => "u is the scale of t",
        (TScale::Scale, Language::Chinese) => "u 为 t 分布的尺度参数",
        (TScale::StandardDeviation, Language::English) => {
            "u is the standard deviation of t (its scale where ν ≤ 2)"
        }
        (TScale::StandardDeviation, Language::Chinese) => {
            "u 为 t 分布的标准差（ν ≤ 2 时为尺度参数）"
        }
    };
    let profile = &conventions.profile;
    let k = coverage(report);
    let plural = plural(digits.into());
    let mut lines = vec![
        say!(
            "Profile {profile}: {k}, {digits} digit{plural} of U, {rounding}, Monte Carlo: {scale}."
        )
        .in_language(l),
    ];
    if !conventions.overrides.is_empty() {
        let changes = conventions.overrides.join(", ");
        lines.push(say!("Changed by the file: {changes}.").in_language(l));
    }
    lines.push(format!("gumption {}", env!("CARGO_PKG_VERSION")));
    lines
}
