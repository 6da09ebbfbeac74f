//! A document as lines for a terminal.

mod fit;
mod lines;
mod plot;
mod table;

use unicode_width::UnicodeWidthStr;

use super::format::{Format, Page};
use crate::document::{Block, Document};

use lines::wrapped;
pub(super) use plot::lines as plot_lines;
pub(super) use table::bar;

/// The format.
pub const FORMAT: Format = Format {
    name: "text",
    about: "Print text",
    ending: "txt",
    media_type: "text/plain; charset=utf-8",
    render: |document, page| Ok(text(document, *page).into_bytes()),
};

/// A document as text.
pub fn text(document: &Document, page: Page) -> String {
    draw(document.blocks(), page)
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

/// Blocks as lines: a blank line between them, two before a further title, none below a head.
fn draw(blocks: &[Block], page: Page) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut below_section = false;
    for block in blocks {
        if !lines.is_empty() && !below_section {
            lines.push(String::new());
        }
        if !lines.is_empty() && matches!(block, Block::Title(_)) {
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
        Block::Section(title) => {
            lines.extend(wrapped(title, page.width).iter().map(|l| page.bold(l)));
        }
        Block::Fields(fields) => {
            let fields = fields
                .iter()
                .map(|(name, text)| (name.as_str(), text.clone()));
            labelled(&fields.collect::<Vec<_>>(), page, lines);
        }
        Block::Figures(figures) => {
            let figures = figures.iter().map(|f| (f.name.as_str(), f.text()));
            labelled(&figures.collect::<Vec<_>>(), page, lines);
        }
        Block::Paragraph(text) => hanging("  ", text, page, lines),
        Block::Formula(formulas) => formulas
            .iter()
            .for_each(|formula| equation(formula, page, lines)),
        Block::Table(table) => {
            let drawn = table::lines(table, page.width.saturating_sub(2));
            lines.extend(
                drawn
                    .iter()
                    .map(|l| format!("  {l}").trim_end().to_string()),
            );
        }
        Block::Plot(plot) => lines.extend(plot::lines(plot, page.width)),
        Block::List(items) => items
            .iter()
            .for_each(|item| hanging("  • ", item, page, lines)),
        Block::Findings(findings) => findings
            .iter()
            .for_each(|finding| hanging("  • ", &finding.text, page, lines)),
        Block::Statement(sentences) => sentences
            .iter()
            .for_each(|s| hanging("  ┃ ", s, page, lines)),
        Block::Closing(all) => lines.extend(all.iter().flat_map(|s| wrapped(s, page.width))),
        Block::Footer(small) => {
            for line in small.iter().flat_map(|s| wrapped(s, page.width)) {
                lines.push(page.dim(&line));
            }
        }
    }
}

/// Texts behind their names, which are as wide as the longest.
fn labelled(fields: &[(&str, String)], page: Page, lines: &mut Vec<String>) {
    let label = fields
        .iter()
        .map(|(name, _)| name.width())
        .max()
        .unwrap_or(0);
    for (name, text) in fields {
        let space = " ".repeat(label - name.width());
        hanging(&format!("  {name}{space}  "), text, page, lines);
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
