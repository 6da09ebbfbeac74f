//! A series: the same budget once per row, as one compact table.

use super::Report;
use super::document::Block;
use super::language::Word;
use super::number::{TABLE_DIGITS, aligned, probability, significant};
use super::table::{Cell, ColumnKind, Row, Table};
use super::text::{Page, draw};
use super::{claim, markdown, remarks, symbol};

/// The rows of a series for a terminal.
pub fn series_text(rows: &[Report<'_>], page: Page) -> String {
    draw(&blocks(rows), page)
}

/// The rows of a series as Markdown.
pub fn series_markdown(rows: &[Report<'_>]) -> String {
    markdown::draw(&blocks(rows))
}

fn blocks(rows: &[Report<'_>]) -> Vec<Block> {
    let Some(first) = rows.first() else {
        return Vec::new();
    };
    let mut blocks = vec![Block::Title(first.budget.heading.title.clone())];
    for measurand in 0..first.evaluation.results.len() {
        let (name, unit) = first.measurand(measurand);
        let unit = symbol(unit);
        let title = if unit.is_empty() {
            name.to_string()
        } else {
            format!("{name} / {unit}")
        };
        blocks.push(Block::Section(title));
        blocks.push(Block::Table(table(rows, measurand).without_empty_columns()));
    }
    let common = common_remarks(rows);
    if !common.is_empty() {
        blocks.push(Block::Section(
            first.language.word(Word::Remarks).to_string(),
        ));
        blocks.push(Block::List(common));
    }
    blocks
}

fn table(rows: &[Report<'_>], measurand: usize) -> Table {
    let l = rows[0].language;
    let p = probability(rows[0].coverage_probability());
    let interval = l.pick(
        format!("Monte Carlo {p} interval"),
        format!("蒙特卡洛法 {p} 区间"),
    );
    let mut table = Table::new([
        (l.word(Word::Row), ColumnKind::Words),
        ("y", ColumnKind::Numbers),
        ("u_c", ColumnKind::Numbers),
        ("k", ColumnKind::Numbers),
        ("U", ColumnKind::Numbers),
        (interval.as_str(), ColumnKind::Numbers),
        (l.pick("clause 8", "验证"), ColumnKind::Words),
        (l.pick("claim", "声称值"), ColumnKind::Wrapped),
    ]);
    for report in rows {
        let result = &report.evaluation.results[measurand];
        let gum = &result.gum;
        let scale = result
            .monte_carlo
            .as_ref()
            .and_then(|mc| mc.u)
            .unwrap_or(gum.u);
        let interval = result
            .monte_carlo
            .as_ref()
            .map(|mc| mc.symmetric.map(|x| aligned(x, scale, TABLE_DIGITS)));
        let verdict = result
            .validation
            .map_or("", |v| match v.map(|v| v.validated) {
                [true, _] | [_, true] => l.pick("validated", "通过"),
                _ => l.pick("not validated", "未通过"),
            });
        let claim = claim::summary(report, measurand);
        table.rows.push(Row::Cells(vec![
            report.label.unwrap_or_default().into(),
            aligned(gum.estimate, gum.u, 2).into(),
            significant(gum.u, TABLE_DIGITS).into(),
            significant(gum.coverage.k, TABLE_DIGITS).into(),
            significant(gum.coverage.expanded, TABLE_DIGITS).into(),
            interval.map_or(Cell::Empty, |[low, high]| format!("[{low}, {high}]").into()),
            verdict.into(),
            claim.unwrap_or_default().into(),
        ]));
    }
    table
}

/// Remarks of all rows, each with the rows that it concerns.
fn common_remarks(rows: &[Report<'_>]) -> Vec<String> {
    let mut found: Vec<(String, Vec<String>)> = Vec::new();
    for report in rows {
        for remark in remarks::remarks(report) {
            let label = report.label.unwrap_or_default().to_string();
            match found.iter_mut().find(|(text, _)| *text == remark) {
                Some((_, labels)) => labels.push(label),
                None => found.push((remark, vec![label])),
            }
        }
    }
    let l = rows[0].language;
    let everywhere = |labels: &[String]| labels.len() == rows.len();
    found
        .into_iter()
        .map(|(text, labels)| match everywhere(&labels) {
            true => text,
            false => l.pick(
                format!("{}: {text}", l.list(&labels)),
                format!("{}：{text}", l.list(&labels)),
            ),
        })
        .collect()
}
