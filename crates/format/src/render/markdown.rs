//! A document as Markdown (GitHub's tables).

use std::ops::Range;

use super::format::{Format, Page};
use super::text::{bar, plot_lines};
use crate::document::{Block, Cell, ColumnKind, Document, Row, Table};

/// The format.
pub const FORMAT: Format = Format {
    name: "markdown",
    about: "Print Markdown",
    ending: "md",
    media_type: "text/markdown; charset=utf-8",
    render: |document, _| Ok(markdown(document).into_bytes()),
};

/// A document as Markdown, a blank line between its blocks.
pub fn markdown(document: &Document) -> String {
    let parts: Vec<String> = document.blocks().iter().map(draw_block).collect();
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

/// Lines as they are, between fences longer than any run of backquotes in them.
fn fenced(lines: &[String]) -> String {
    let text = lines.join("\n");
    let runs = text.split(|c| c != '`').map(str::len);
    let fence = "`".repeat(runs.max().unwrap_or(0).max(2) + 1);
    format!("{fence}text\n{text}\n{fence}")
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

/// Text that Markdown leaves as it is, wherever it stands.
fn escaped(text: &str) -> String {
    let text = text.trim_start();
    let mut out = String::with_capacity(text.len());
    let mut before = ' ';
    let opening = opening_mark(text);
    let mut code = code_spans(text).into_iter().peekable();
    for (at, c) in text.char_indices() {
        let _ = code.next_if(|span| span.end < at);
        let in_code = code.peek().is_some_and(|span| span.contains(&at));
        match c {
            // A soft hyphen belongs to the narrow columns of a terminal.
            '\u{AD}' => continue,
            // A table ends its cells even inside code.
            '|' => out.push('\\'),
            _ if in_code => {}
            _ if opening == Some(at) || is_special(c, before, &text[at + c.len_utf8()..]) => {
                out.push('\\');
            }
            _ => {}
        }
        out.push(if c == '\n' { ' ' } else { c });
        before = c;
    }
    out
}

/// Texts between single backquotes, with these, which Markdown sets as code as well; longer runs of them have
/// another meaning there and are none.
fn code_spans(text: &str) -> Vec<Range<usize>> {
    let single = |at: &usize| {
        let rest = text[at + 1..].starts_with('`');
        !rest && !text[..*at].ends_with('`')
    };
    let marks: Vec<usize> = text
        .match_indices('`')
        .map(|(at, _)| at)
        .filter(single)
        .collect();
    let spans = marks.chunks_exact(2).map(|pair| pair[0]..pair[1] + 1);
    spans.collect()
}

/// Whether Markdown would take a character within a line for more than itself. An underscore inside a word is safe,
/// and so are brackets that no link follows.
fn is_special(c: char, before: char, rest: &str) -> bool {
    let next = rest.chars().next();
    let word = |c: char| c.is_alphanumeric();
    match c {
        '\\' | '*' | '<' | '~' | '$' | '`' => true,
        '_' => !word(before) || !next.is_some_and(word),
        ']' => next.is_some_and(|next| "([:".contains(next)),
        '&' => next.is_some_and(|next| next == '#' || next.is_ascii_alphabetic()),
        _ => false,
    }
}

/// The character by which Markdown would take the beginning of a line for a heading, a quotation, a list, a task or a
/// rule.
fn opening_mark(text: &str) -> Option<usize> {
    let digits = text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let mut marks = text[digits..].chars();
    let (mark, next) = (marks.next()?, marks.next());
    let alone = next.is_none_or(|c| " -=+xX".contains(c));
    let opens = match mark {
        '#' | '>' => digits == 0,
        '-' | '+' | '=' | '[' => digits == 0 && alone,
        '.' | ')' => digits > 0 && alone,
        _ => false,
    };
    opens.then_some(digits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_markdown_would_eat_is_escaped() {
        assert_eq!(escaped("a*b | <c> x_"), "a\\*b \\| \\<c> x\\_");
        assert_eq!(escaped("u_c of `half_width*`"), "u_c of `half_width*`");
        assert_eq!(
            escaped("&lt;b&gt; R & D $x$"),
            "\\&lt;b\\&gt; R & D \\$x\\$"
        );
        assert_eq!(escaped("![a](b) v[1] [x]: y"), "![a\\](b) v[1] [x\\]: y");
    }

    #[test]
    fn what_is_no_code_for_markdown_is_escaped() {
        assert_eq!(escaped("a ` <b>"), "a \\` \\<b>");
        assert_eq!(escaped("```<i>`"), "\\`\\`\\`\\<i>\\`");
        assert_eq!(escaped("`<i>` <b>"), "`<i>` \\<b>");
        assert_eq!(
            fenced(&["a ```` b".to_string()]),
            "`````text\na ```` b\n`````"
        );
    }

    #[test]
    fn no_line_begins_a_block() {
        for (text, escaped_text) in [
            ("# a", "\\# a"),
            ("> a", "\\> a"),
            ("  - a", "\\- a"),
            ("---", "\\---"),
            ("-5 V", "-5 V"),
            ("[ ] a", "\\[ ] a"),
            ("2. a", "2\\. a"),
            ("2.5 V", "2.5 V"),
        ] {
            assert_eq!(escaped(text), escaped_text);
        }
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
