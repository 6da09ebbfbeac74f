//! Lines of a table whose widths are known.

use unicode_width::UnicodeWidthStr;

use super::fit::total;
use super::text::{broken, cut, wrapped};
use super::{Cell, ColumnKind, Row, Table};

/// Natural width of a bar.
const BAR: usize = 10;

impl Table {
    pub(super) fn drawn(&self, width: usize) -> Vec<String> {
        let (widths, gap) = self.fitted(width);
        let full = total(&widths, gap);
        let rule = "─".repeat(full);
        let mut lines = Vec::with_capacity(self.rows.len() + 2);
        if self.columns.iter().any(|c| !c.head.is_empty()) {
            self.draw_heads(&widths, gap, &mut lines);
            lines.push(rule.clone());
        }
        for row in &self.rows {
            match row {
                Row::Cells(cells) => self.draw(cells, &widths, gap, &mut lines),
                Row::Rule => lines.push(rule.clone()),
                Row::Across(text) => lines.extend(wrapped(text, full.max(40).min(width))),
            }
        }
        lines
    }

    fn draw(&self, cells: &[Cell], widths: &[usize], gap: usize, lines: &mut Vec<String>) {
        let texts = self.columns.iter().zip(widths).enumerate();
        let texts = texts.map(|(i, (column, width))| {
            let cell = cells.get(i).unwrap_or(&Cell::Empty);
            cell.set(column.kind, *width)
        });
        self.side_by_side(texts.collect(), widths, gap, lines);
    }

    fn draw_heads(&self, widths: &[usize], gap: usize, lines: &mut Vec<String>) {
        let texts = self.columns.iter().zip(widths);
        let texts = texts.map(|(column, width)| match column.kind {
            ColumnKind::Numbers | ColumnKind::Names => wrapped(&column.head, *width),
            kind => Cell::Text(column.head.clone()).set(kind, *width),
        });
        self.side_by_side(texts.collect(), widths, gap, lines);
    }

    /// Draws cells that are already broken into lines; columns of no width are left out.
    fn side_by_side(
        &self,
        cells: Vec<Vec<String>>,
        widths: &[usize],
        gap: usize,
        lines: &mut Vec<String>,
    ) {
        let columns: Vec<(usize, ColumnKind, Vec<String>)> = self
            .columns
            .iter()
            .zip(widths)
            .zip(cells)
            .filter(|((_, width), _)| **width > 0)
            .map(|((column, width), set)| (*width, column.kind, set))
            .collect();
        let height = columns
            .iter()
            .map(|(_, _, set)| set.len())
            .max()
            .unwrap_or(0);
        for h in 0..height {
            let parts: Vec<String> = columns
                .iter()
                .map(|(width, kind, set)| {
                    let text = set.get(h).map_or("", String::as_str);
                    let space = " ".repeat(width.saturating_sub(text.width()));
                    if *kind == ColumnKind::Numbers {
                        format!("{space}{text}")
                    } else {
                        format!("{text}{space}")
                    }
                })
                .collect();
            lines.push(parts.join(&" ".repeat(gap)).trim_end().to_string());
        }
    }
}

impl Cell {
    pub(super) fn width(&self) -> usize {
        match self {
            Cell::Text(text) => text.width(),
            Cell::Part(text) => text.width() + 2,
            Cell::Share(_) => BAR,
            Cell::Empty => 0,
        }
    }

    /// The cell's lines in a column of this width.
    fn set(&self, kind: ColumnKind, width: usize) -> Vec<String> {
        let text = match self {
            Cell::Text(text) => text.clone(),
            Cell::Part(text) => format!("  {text}"),
            Cell::Share(share) => bar(*share, width),
            Cell::Empty => String::new(),
        };
        match kind {
            ColumnKind::Names => broken(&text, width),
            ColumnKind::Words => vec![cut(&text, width)],
            ColumnKind::Wrapped => wrapped(&text, width),
            ColumnKind::Numbers | ColumnKind::Bar => vec![text],
        }
    }
}

/// A bar of eighths of a character; a share that is not between nothing and all fills what it can.
pub(crate) fn bar(share: f64, width: usize) -> String {
    const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let units = (share.clamp(0.0, 1.0) * 8.0 * width as f64).round() as usize;
    format!("{}{}", "█".repeat(units / 8), EIGHTHS[units % 8])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_have_eighths() {
        assert_eq!(bar(1.0, 4), "████");
        assert_eq!(bar(0.53, 4), "██▏");
        assert_eq!(bar(-0.2, 4), "");
        assert_eq!(bar(1.7, 2), "██");
    }
}
