//! Tables: one description, fitted to a terminal's width or left natural for Markdown.

use std::borrow::Cow;

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// Spaces between columns, and what is left of them on a narrow page.
const GAP: usize = 2;
const NARROW_GAP: usize = 1;

/// A table.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Table {
    pub(super) columns: Vec<Column>,
    pub(super) rows: Vec<Row>,
}

/// A column: its head and how it behaves.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    pub(super) head: String,
    pub(super) kind: ColumnKind,
}

/// How a column is set, and what it gives up when the page is narrow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColumnKind {
    /// Words, to the left; cut with an ellipsis when there is no other way.
    Words,
    /// Names, to the left; never cut, continued on further lines when there is no other way.
    Names,
    /// Numbers, to the right; never cut.
    Numbers,
    /// Words, to the left, on several lines when the page is narrow.
    Wrapped,
    /// A bar for a share; narrowed first, then dropped.
    Bar,
}

/// A line of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Row {
    /// One cell per column; missing ones are empty.
    Cells(Vec<Cell>),
    /// A line across.
    Rule,
    /// Words that run over all columns.
    Across(String),
}

/// The content of one place.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cell {
    /// Words or a number.
    Text(String),
    /// A part of the row above.
    Part(String),
    /// A share of one, drawn as a bar.
    Share(f64),
    /// Nothing.
    Empty,
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Cell::Text(text.into())
    }
}

impl Table {
    /// A table without rows.
    pub(super) fn new<const N: usize>(columns: [(&str, ColumnKind); N]) -> Self {
        let columns = columns
            .into_iter()
            .map(|(head, kind)| Column {
                head: head.to_string(),
                kind,
            })
            .collect();
        Table {
            columns,
            rows: Vec::new(),
        }
    }

    /// Adds a row of cells.
    pub(super) fn push(&mut self, cells: Vec<Cell>) {
        self.rows.push(Row::Cells(cells));
    }

    /// Drops the columns in which no row has anything.
    pub(super) fn without_empty_columns(mut self) -> Self {
        for i in (0..self.columns.len()).rev() {
            let blank = |row: &Row| match row {
                Row::Cells(cells) => cells
                    .get(i)
                    .is_none_or(|c| *c == Cell::Empty || *c == Cell::Text(String::new())),
                Row::Rule | Row::Across(_) => true,
            };
            if !self.rows.iter().all(blank) {
                continue;
            }
            self.columns.remove(i);
            for row in &mut self.rows {
                if let Row::Cells(cells) = row
                    && i < cells.len()
                {
                    cells.remove(i);
                }
            }
        }
        self
    }

    /// The lines of the table within `width` columns of the terminal where that is possible: the
    /// head, a rule, the rows. A matrix that is wider continues below, a blank line between.
    pub(super) fn lines(&self, width: usize) -> Vec<String> {
        let parts: Vec<Vec<String>> = self
            .bands(width)
            .iter()
            .map(|band| band.drawn(width))
            .collect();
        parts.join(&[String::new()][..])
    }

    /// The table in pieces that fit the page: a matrix (names, then numbers only) in as many as it
    /// takes, each with the names; any other table as it is.
    fn bands(&self, page: usize) -> Vec<Cow<'_, Table>> {
        /// Fewer columns are no matrix.
        const LEAST: usize = 4;
        /// Width that the head over the names keeps.
        const BROKEN_HEAD: usize = 14;
        let matrix = self.columns.len() > LEAST
            && (self.columns.iter().enumerate())
                .all(|(i, column)| (i == 0) == (column.kind != ColumnKind::Numbers));
        let mut widths = self.natural();
        if !matrix || total(&widths, NARROW_GAP) <= page {
            return vec![Cow::Borrowed(self)];
        }
        // The head over the names may go on several lines.
        widths[0] = widths[0].min(self.natural_body()[0].max(BROKEN_HEAD));
        let mut bands = Vec::new();
        let mut band = vec![0];
        let mut used = widths[0];
        for (i, width) in widths.iter().enumerate().skip(1) {
            if used + GAP + width > page && band.len() > 1 {
                bands.push(Cow::Owned(self.selected(&band)));
                band = vec![0];
                used = widths[0];
            }
            used += GAP + width;
            band.push(i);
        }
        bands.push(Cow::Owned(self.selected(&band)));
        bands
    }

    /// Some of the columns.
    fn selected(&self, columns: &[usize]) -> Table {
        let rows = self.rows.iter().map(|row| match row {
            Row::Cells(cells) => Row::Cells(
                columns
                    .iter()
                    .map(|i| cells.get(*i).cloned().unwrap_or(Cell::Empty))
                    .collect(),
            ),
            other => other.clone(),
        });
        Table {
            columns: columns.iter().map(|i| self.columns[*i].clone()).collect(),
            rows: rows.collect(),
        }
    }

    fn drawn(&self, width: usize) -> Vec<String> {
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

    fn natural(&self) -> Vec<usize> {
        let heads = self.columns.iter().map(|c| c.head.width());
        heads
            .zip(self.natural_body())
            .map(|(head, body)| head.max(body))
            .collect()
    }

    /// The widths without the heads.
    fn natural_body(&self) -> Vec<usize> {
        let mut widths = vec![0; self.columns.len()];
        for row in &self.rows {
            let Row::Cells(cells) = row else { continue };
            for (width, cell) in widths.iter_mut().zip(cells) {
                *width = (*width).max(cell.width());
            }
        }
        widths
    }

    /// Column widths and gap that fit the page; a width of zero drops a column. What gives way, in
    /// this order: bars, space between columns, wrapped words, other words, names.
    fn fitted(&self, page: usize) -> (Vec<usize>, usize) {
        let mut widths = self.natural();
        for gap in [GAP, NARROW_GAP] {
            let mut with_bars = widths.clone();
            self.shrink(ColumnKind::Bar, SHORTEST_BAR, page, gap, &mut with_bars);
            if total(&with_bars, gap) <= page {
                return (with_bars, gap);
            }
        }
        for (width, column) in widths.iter_mut().zip(&self.columns) {
            if column.kind == ColumnKind::Bar {
                *width = 0;
            }
        }
        self.shrink(ColumnKind::Wrapped, 24, page, GAP, &mut widths);
        if total(&widths, NARROW_GAP) > page {
            self.break_heads(&mut widths);
        }
        if total(&widths, GAP) <= page {
            return (widths, GAP);
        }
        self.shrink(ColumnKind::Words, 8, page, NARROW_GAP, &mut widths);
        self.shrink(ColumnKind::Wrapped, 16, page, NARROW_GAP, &mut widths);
        self.shrink(ColumnKind::Words, 5, page, NARROW_GAP, &mut widths);
        self.shrink(ColumnKind::Names, 10, page, NARROW_GAP, &mut widths);
        (widths, NARROW_GAP)
    }

    /// Gives columns of numbers the width of their numbers; heads that are wider go on two lines.
    fn break_heads(&self, widths: &mut [usize]) {
        let body = self.natural_body();
        for ((width, column), body) in widths.iter_mut().zip(&self.columns).zip(body) {
            if column.kind == ColumnKind::Numbers && *width > body {
                *width = body.max(width.div_ceil(2));
            }
        }
    }

    /// Takes from the widest columns of a kind until the table fits or they are down to `least`.
    fn shrink(
        &self,
        kind: ColumnKind,
        least: usize,
        page: usize,
        gap: usize,
        widths: &mut [usize],
    ) {
        while total(widths, gap) > page {
            let widest = (0..widths.len())
                .filter(|i| self.columns[*i].kind == kind)
                .max_by_key(|i| widths[*i]);
            let Some(i) = widest.filter(|i| widths[*i] > least) else {
                return;
            };
            widths[i] -= 1;
        }
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

/// Width of a table with these columns.
fn total(widths: &[usize], gap: usize) -> usize {
    widths
        .iter()
        .filter(|w| **w > 0)
        .map(|w| w + gap)
        .sum::<usize>()
        .saturating_sub(gap)
}

/// Natural width of a bar, and the least that still says something.
const BAR: usize = 10;
const SHORTEST_BAR: usize = 4;

impl Cell {
    fn width(&self) -> usize {
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
pub(super) fn bar(share: f64, width: usize) -> String {
    const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let units = (share.clamp(0.0, 1.0) * 8.0 * width as f64).round() as usize;
    format!("{}{}", "█".repeat(units / 8), EIGHTHS[units % 8])
}

/// The text cut to a width, with an ellipsis where something is missing.
fn cut(text: &str, width: usize) -> String {
    if text.width() <= width {
        return text.to_string();
    }
    let mut kept = String::new();
    for c in text.chars() {
        if kept.width() + c.width().unwrap_or(0) + 1 > width {
            break;
        }
        kept.push(c);
    }
    kept.push('…');
    kept
}

/// A name on lines of at most `width`, broken behind `_`, `.`, `-` or a space where there is one; further
/// lines are set in a little.
fn broken(text: &str, width: usize) -> Vec<String> {
    const INDENT: &str = "    ";
    let mut lines = Vec::new();
    let mut line = String::new();
    let mut seam = None;
    for c in text.chars() {
        if line.width() + c.width().unwrap_or(0) > width && line.trim_start() != "" {
            let rest = line.split_off(seam.unwrap_or(line.len()));
            lines.push(std::mem::replace(&mut line, format!("{INDENT}{rest}")));
            seam = None;
        }
        line.push(c);
        if matches!(c, '_' | '.' | '-' | ' ') && !line.trim_start().is_empty() {
            seam = Some(line.len());
        }
    }
    lines.push(line);
    lines
}

/// The text on lines of at most `width`, broken at spaces and between Chinese characters; a single
/// word that is longer stands alone on its line.
pub(super) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for piece in pieces(text) {
        if !line.is_empty() && line.width() + piece.trim_end().width() > width {
            lines.push(line.trim_end().to_string());
            line.clear();
        }
        line.push_str(piece);
    }
    lines.push(line.trim_end().to_string());
    lines
}

/// Smallest parts that stay on one line: words with the space after them, single wide characters
/// with the punctuation that must not begin a line.
fn pieces(text: &str) -> Vec<&str> {
    let mut cuts = vec![0];
    let mut before = [' '; 2];
    for (i, c) in text.char_indices() {
        if i > 0 && may_break(before, &text[i..]) {
            cuts.push(i);
        }
        before = [before[1], c];
    }
    cuts.push(text.len());
    cuts.dedup();
    cuts.windows(2).map(|w| &text[w[0]..w[1]]).collect()
}

/// Whether a line may end before `next`. `U = 0.12`, `1 000 000`, `95 %` and `94 nm` stay together.
fn may_break([second, last]: [char; 2], rest: &str) -> bool {
    /// Letters of a unit; longer words may be parted from their number.
    const UNIT: usize = 5;
    let Some(next) = rest.chars().next() else {
        return false;
    };
    const ENDS: &str = "，。；：、）”！？)";
    const BINDS: &str = "=±≈<≤/−";
    if last == ' ' {
        let word = rest
            .split([' ', ',', ';', ':', '.'])
            .next()
            .unwrap_or_default();
        let unit = next.is_alphanumeric() || "%°µΩ".contains(next);
        let number = second.is_ascii_digit() && unit && word.chars().count() <= UNIT;
        return next != ' ' && !number && !BINDS.contains(next) && !BINDS.contains(second);
    }
    (is_wide(last) || is_wide(next))
        && next != ' '
        && last != '（'
        && last != '“'
        && !ENDS.contains(next)
}

fn is_wide(c: char) -> bool {
    c.width() == Some(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Table {
        let mut table = Table::new([
            ("quantity", ColumnKind::Words),
            ("u", ColumnKind::Numbers),
            ("how", ColumnKind::Wrapped),
            ("", ColumnKind::Bar),
        ]);
        table.push(vec![
            "V".into(),
            "0.12".into(),
            "half-width of the interval divided by the root of three".into(),
            Cell::Share(0.5),
        ]);
        table.push(vec![
            Cell::Part("校准".to_string()),
            "1.5".into(),
            "U/k".into(),
            Cell::Share(1.0),
        ]);
        table.rows.push(Row::Rule);
        table
    }

    #[test]
    fn keeps_every_column_on_a_wide_page() {
        let lines = sample().lines(100);
        assert_eq!(
            lines[2],
            "V         0.12  half-width of the interval divided by the root of three  █████"
        );
        assert_eq!(
            lines[3],
            "  校准     1.5  U/k                                                      ██████████"
        );
    }

    #[test]
    fn a_narrow_page_drops_the_bar_and_wraps_words() {
        let lines = sample().lines(44);
        assert!(lines.iter().all(|l| l.width() <= 44), "{lines:#?}");
        assert!(lines.iter().all(|l| !l.contains('█')));
        assert!(
            lines
                .iter()
                .any(|l| l.trim() == "divided by the root of three"),
            "{lines:#?}"
        );
    }

    #[test]
    fn a_wide_matrix_continues_below() {
        let mut table = Table::new([
            ("", ColumnKind::Names),
            ("alpha", ColumnKind::Numbers),
            ("beta", ColumnKind::Numbers),
            ("gamma", ColumnKind::Numbers),
            ("delta", ColumnKind::Numbers),
        ]);
        table.push(vec![
            "alpha".into(),
            "1.00".into(),
            "0.20".into(),
            "0.30".into(),
            "0.40".into(),
        ]);
        assert_eq!(table.lines(40).len(), 3);
        assert_eq!(
            table.lines(20),
            [
                "       alpha  beta",
                "──────────────────",
                "alpha   1.00  0.20",
                "",
                "       gamma  delta",
                "───────────────────",
                "alpha   0.30   0.40",
            ]
        );
    }

    #[test]
    fn names_are_whole_on_any_page() {
        assert_eq!(broken("short", 10), ["short"]);
        assert_eq!(
            broken("  conductivity_of_rod", 16),
            ["  conductivity_", "    of_rod"]
        );
        assert_eq!(broken("abcdefghijklmno", 10), ["abcdefghij", "    klmno"]);
    }

    #[test]
    fn bars_have_eighths() {
        assert_eq!(bar(1.0, 4), "████");
        assert_eq!(bar(0.53, 4), "██▏");
        assert_eq!(bar(-0.2, 4), "");
        assert_eq!(bar(1.7, 2), "██");
    }

    #[test]
    fn chinese_breaks_between_characters_but_not_before_a_stop() {
        assert_eq!(
            wrapped("扩展不确定度。包含因子", 12),
            ["扩展不确定", "度。包含因子"]
        );
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
    }
}
