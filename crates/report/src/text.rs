//! The report for a terminal.

use unicode_width::UnicodeWidthStr;

use super::Report;
use super::compose::compose;
use super::document::Block;
use super::table::wrapped;

/// What the text is drawn on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Page {
    /// Columns; lines are at most this wide wherever words allow it.
    pub width: usize,
    /// Whether headings may be bold and small print dim (ANSI escapes).
    pub styled: bool,
}

impl Default for Page {
    fn default() -> Self {
        Page {
            width: 100,
            styled: false,
        }
    }
}

impl Page {
    fn bold(self, text: &str) -> String {
        self.escaped("1", text)
    }

    fn dim(self, text: &str) -> String {
        self.escaped("2", text)
    }

    fn escaped(self, code: &str, text: &str) -> String {
        if self.styled {
            format!("\x1b[{code}m{text}\x1b[0m")
        } else {
            text.to_string()
        }
    }
}

/// The report as lines for a terminal.
pub fn text(report: &Report<'_>, page: Page) -> String {
    draw(&compose(report), page)
}

/// Blocks as lines, a blank line between them.
pub(super) fn draw(blocks: &[Block], page: Page) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut below_section = false;
    for block in blocks {
        if !lines.is_empty() && !below_section {
            lines.push(String::new());
        }
        below_section = matches!(block, Block::Section(_));
        draw_block(block, page, &mut lines);
    }
    let mut text = lines.join("\n");
    text.push('\n');
    text
}

fn draw_block(block: &Block, page: Page, lines: &mut Vec<String>) {
    match block {
        Block::Title(title) => {
            let title = wrapped(title, page.width);
            let width = title.iter().map(|line| line.width()).max().unwrap_or(0);
            lines.extend(title.iter().map(|line| page.bold(line)));
            lines.push(page.dim(&"━".repeat(width)));
        }
        Block::Section(title) => lines.push(page.bold(title)),
        Block::Fields(fields) => {
            let label = fields
                .iter()
                .map(|(label, _)| label.width())
                .max()
                .unwrap_or(0);
            for (name, text) in fields {
                let space = " ".repeat(label - name.width());
                hanging(&format!("  {name}{space}  "), text, page, lines);
            }
        }
        Block::Paragraph(text) => hanging("  ", text, page, lines),
        Block::Formula(formulas) => formulas
            .iter()
            .for_each(|formula| equation(formula, page, lines)),
        Block::Table(table) => lines.extend(
            table
                .lines(page.width.saturating_sub(2))
                .into_iter()
                .map(|l| format!("  {l}").trim_end().to_string()),
        ),
        Block::List(items) => items
            .iter()
            .for_each(|item| hanging("  • ", item, page, lines)),
        Block::Statement(sentences) => sentences
            .iter()
            .for_each(|s| hanging("  ┃ ", s, page, lines)),
        Block::Footer(small) => {
            for line in small.iter().flat_map(|s| wrapped(s, page.width)) {
                lines.push(page.dim(&line));
            }
        }
    }
}

/// A formula, its further lines set in.
fn equation(formula: &str, page: Page, lines: &mut Vec<String>) {
    const INDENT: &str = "    ";
    // As much as the first line has of its own, and as much again for the further ones.
    let own = formula.len() - formula.trim_start().len();
    let width = page.width.saturating_sub(2 * INDENT.len() + own).max(20);
    for (i, line) in wrapped(formula.trim_start(), width).iter().enumerate() {
        let further = if i == 0 { "" } else { INDENT };
        lines.push(format!("{INDENT}{}{further}{line}", &formula[..own]));
    }
}

/// Text after a mark, its further lines below its first one; the bar of a statement goes on.
fn hanging(mark: &str, text: &str, page: Page, lines: &mut Vec<String>) {
    let further = if mark.contains('┃') {
        mark.to_string()
    } else {
        " ".repeat(mark.width())
    };
    let width = page.width.saturating_sub(mark.width()).max(20);
    for (i, line) in text.lines().flat_map(|l| wrapped(l, width)).enumerate() {
        lines.push(format!("{}{line}", if i == 0 { mark } else { &further }));
    }
}
