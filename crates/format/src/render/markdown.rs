//! A document as Markdown (GitHub's tables).

use super::format::{Format, Page};
use super::text::{bar, plot_lines};
use crate::document::{Block, Cell, ColumnKind, Document, Row, Table};

pub(super) const FORMAT: Format = Format {
    name: "markdown",
    about: "Print Markdown",
    ending: "md",
    media_type: "text/markdown; charset=utf-8",
    render: |document, _| markdown(document).into_bytes(),
};

/// A document as Markdown, a blank line between its blocks.
pub fn markdown(document: &Document) -> String {
    let parts: Vec<String> = document.blocks.iter().map(draw_block).collect();
    format!("{}\n", parts.join("\n\n"))
}

fn draw_block(block: &Block) -> String {
    match block {
        Block::Title(title) => format!("# {}", escaped(title)),
        Block::Section(title) => format!("## {}", escaped(title)),
        Block::Fields(fields) => lined(fields, |(name, text)| labelled(name, text)),
        Block::Figures(figures) => lined(figures, |f| labelled(&f.name, &f.text())),
        Block::Paragraph(text) => escaped(text),
        Block::Formula(lines) => fenced(lines),
        Block::Table(table) => draw_table(table),
        Block::Plot(plot) => fenced(&plot_lines(plot, Page::default().width)),
        Block::List(items) => lined(items, |item| format!("- {}", escaped(item))),
        Block::Findings(findings) => lined(findings, |f| format!("- {}", escaped(&f.text))),
        Block::Statement(sentences) => sentences
            .iter()
            .map(|s| format!("> {}", escaped(s)))
            .collect::<Vec<_>>()
            .join("\n>\n"),
        Block::Closing(lines) => on_lines(lines),
        Block::Footer(lines) => format!("---\n\n{}", on_lines(lines)),
    }
}

/// Text whose lines stay lines.
fn on_lines(lines: &[String]) -> String {
    lines
        .iter()
        .map(|l| escaped(l))
        .collect::<Vec<_>>()
        .join("  \n")
}

fn lined<T>(items: &[T], line: impl Fn(&T) -> String) -> String {
    items.iter().map(line).collect::<Vec<_>>().join("\n")
}

fn labelled(name: &str, text: &str) -> String {
    format!("- **{}**: {}", escaped(name), escaped(text))
}

fn fenced(lines: &[String]) -> String {
    format!("```text\n{}\n```", lines.join("\n"))
}

fn draw_table(table: &Table) -> String {
    let heads: Vec<String> = table.columns.iter().map(|c| escaped(&c.head)).collect();
    let marks: Vec<&str> = table
        .columns
        .iter()
        .map(|c| {
            if c.kind == ColumnKind::Numbers {
                "---:"
            } else {
                ":---"
            }
        })
        .collect();
    let mut lines = vec![row(&heads), row(&marks)];
    for line in &table.rows {
        match line {
            Row::Cells(cells) => {
                let mut texts: Vec<String> = cells.iter().map(cell).collect();
                texts.resize(table.columns.len(), String::new());
                lines.push(row(&texts));
            }
            // A rule has no counterpart inside a Markdown table.
            Row::Rule => {}
            Row::Across(text) => {
                let mut texts = vec![format!("*{}*", escaped(text))];
                texts.resize(table.columns.len(), String::new());
                lines.push(row(&texts));
            }
        }
    }
    lines.join("\n")
}

fn row<S: AsRef<str>>(cells: &[S]) -> String {
    let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
    format!("| {} |", cells.join(" | "))
}

fn cell(cell: &Cell) -> String {
    match cell {
        Cell::Text(text) => escaped(text),
        Cell::Part(text) => format!("&emsp;{}", escaped(text)),
        Cell::Share(share) => bar(*share, 10),
        Cell::Empty => String::new(),
    }
}

/// Text that Markdown leaves as it is. An underscore inside a word is safe.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut inside_word = false;
    let mut chars = text.chars().peekable();
    let mut code = false;
    while let Some(c) = chars.next() {
        let next_is_word = chars.peek().is_some_and(|n| n.is_alphanumeric());
        match c {
            // Text between backquotes is set as code by Markdown too.
            '`' => code = !code,
            // A soft hyphen belongs to the narrow columns of a terminal.
            '\u{AD}' => continue,
            '|' => out.push('\\'),
            '\\' | '*' | '<' | '~' if !code => out.push('\\'),
            '_' if !code && (!inside_word || !next_is_word) => out.push('\\'),
            _ => {}
        }
        out.push(if c == '\n' { ' ' } else { c });
        inside_word = c.is_alphanumeric();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_markdown_would_eat_is_escaped() {
        assert_eq!(escaped("a*b | <c> x_"), "a\\*b \\| \\<c> x\\_");
        assert_eq!(escaped("u_c of `half_width*`"), "u_c of `half_width*`");
    }

    #[test]
    fn a_table_has_one_cell_per_column() {
        let mut table = Table::new([("a", ColumnKind::Words), ("b", ColumnKind::Numbers)]);
        table.push(vec![Cell::Part("x|y".to_string())]);
        table.rows.push(Row::Rule);
        table.rows.push(Row::Across("rest".to_string()));
        assert_eq!(
            draw_table(&table),
            "| a | b |\n| :--- | ---: |\n| &emsp;x\\|y |  |\n| *rest* |  |"
        );
    }
}
