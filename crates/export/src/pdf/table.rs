//! Tables: columns as wide as their contents need, lines in cells where they must be, the head again on every page.

use gumption_format::document::{Cell, ColumnKind, Row, Table};

use super::flow::{BLACK, BLUE, Flow, Op, PALE, WIDTH};
use super::fonts::Style;
use super::text::{self, Letter};
use crate::columns::widths;

/// Sizes that are tried, the most legible first.
const SIZES: [f32; 5] = [8.5, 8.0, 7.5, 7.0, 6.3];
/// Between columns.
const GAP: f32 = 7.0;
/// Width of a bar.
const BAR: f32 = 42.0;
/// Height of a line as a part of the size.
const LEADING: f32 = 1.32;

/// A table with its glyphs at one size.
struct Laid {
    size: f32,
    kinds: Vec<ColumnKind>,
    widths: Vec<f32>,
    head: Vec<Vec<Letter>>,
    rows: Vec<LaidRow>,
}

enum LaidRow {
    Cells(Vec<LaidCell>),
    Across(Vec<Letter>),
    Rule,
}

enum LaidCell {
    Letters(Vec<Letter>),
    Bar(f64),
}

/// Draws a table.
pub(super) fn draw(flow: &mut Flow<'_>, table: &Table) {
    let narrow = without_bars(table);
    let mut laid = None;
    for (at, size) in SIZES.into_iter().enumerate() {
        // Bars repeat the shares beside them, and go first.
        let shown = if at == 0 { table } else { &narrow };
        let (candidate, fits) = lay(flow, shown, size);
        laid = Some(candidate);
        if fits {
            break;
        }
    }
    if let Some(laid) = laid {
        laid.draw(flow);
    }
}

fn without_bars(table: &Table) -> Table {
    let mut narrow = table.clone();
    for at in (0..narrow.columns.len()).rev() {
        if narrow.columns[at].kind != ColumnKind::Bar {
            continue;
        }
        narrow.columns.remove(at);
        for row in &mut narrow.rows {
            if let Row::Cells(cells) = row
                && at < cells.len()
            {
                cells.remove(at);
            }
        }
    }
    narrow
}

/// Ems of a term that stays on one line: Chinese ones have up to four characters, each an em wide.
const TERM: f32 = 4.05;

/// The glyphs of a table at a size, and whether every word fits.
fn lay(flow: &mut Flow<'_>, table: &Table, size: f32) -> (Laid, bool) {
    let kinds: Vec<ColumnKind> = table.columns.iter().map(|column| column.kind).collect();
    let head: Vec<Vec<Letter>> = table
        .columns
        .iter()
        .map(|column| flow.set(&column.head, Style::Bold, size))
        .collect();
    let rows: Vec<LaidRow> = table
        .rows
        .iter()
        .map(|row| lay_row(flow, row, size))
        .collect();
    let mut least = Vec::new();
    let mut most = Vec::new();
    for (at, kind) in kinds.iter().enumerate() {
        let whole = matches!(kind, ColumnKind::Numbers);
        let unbroken = |letters: &[Letter]| {
            let width = text::width(letters);
            match width <= TERM * size {
                true => width,
                false => text::widest_part(letters),
            }
        };
        let mut narrowest = unbroken(&head[at]);
        let mut widest = text::width(&head[at]);
        for row in &rows {
            match row {
                LaidRow::Cells(cells) => match cells.get(at) {
                    Some(LaidCell::Letters(letters)) => {
                        let width = text::width(letters);
                        widest = widest.max(width);
                        narrowest = narrowest.max(match whole {
                            true => width,
                            false => unbroken(letters),
                        });
                    }
                    Some(LaidCell::Bar(_)) => {
                        widest = widest.max(BAR);
                        narrowest = narrowest.max(BAR);
                    }
                    None => {}
                },
                LaidRow::Across(_) | LaidRow::Rule => {}
            }
        }
        least.push(narrowest);
        most.push(widest.max(narrowest));
    }
    let room = WIDTH - GAP * kinds.len().saturating_sub(1) as f32;
    let (widths, fits) = widths(&least, &most, room);
    let laid = Laid {
        size,
        kinds,
        widths,
        head,
        rows,
    };
    (laid, fits)
}

fn lay_row(flow: &mut Flow<'_>, row: &Row, size: f32) -> LaidRow {
    match row {
        Row::Rule => LaidRow::Rule,
        Row::Across(words) => LaidRow::Across(flow.set(words, Style::Bold, size)),
        Row::Cells(cells) => {
            let cells = cells.iter().map(|cell| match cell {
                Cell::Text(words) => LaidCell::Letters(flow.set(words, Style::Regular, size)),
                Cell::Part(words) => {
                    LaidCell::Letters(flow.set(&format!("  {words}"), Style::Regular, size))
                }
                Cell::Share(share) => LaidCell::Bar(*share),
                Cell::Empty => LaidCell::Letters(Vec::new()),
            });
            LaidRow::Cells(cells.collect())
        }
    }
}

impl Laid {
    fn leading(&self) -> f32 {
        LEADING * self.size
    }

    fn draw(&self, flow: &mut Flow<'_>) {
        let head_height = self.height(&self.head) + 4.0;
        flow.room(head_height + 3.0 * self.leading());
        self.draw_head(flow);
        for row in &self.rows {
            match row {
                LaidRow::Rule => {
                    let (left, y) = (flow.left(), flow.y + 1.0);
                    flow.rule([left, y], [left + self.total(), y], PALE, 0.6);
                    flow.y += 2.0;
                }
                LaidRow::Across(letters) => {
                    let lines = text::lines(letters, WIDTH).len() as f32;
                    if flow.room(lines * self.leading() + 2.0) {
                        self.draw_head(flow);
                    }
                    flow.lines(letters, [flow.left(), WIDTH], self.leading(), BLACK);
                }
                LaidRow::Cells(cells) => self.draw_cells(flow, cells),
            }
        }
        let (left, y) = (flow.left(), flow.y + 1.0);
        flow.rule([left, y], [left + self.total(), y], BLACK, 0.8);
        flow.y += 9.0;
    }

    fn total(&self) -> f32 {
        self.widths.iter().sum::<f32>() + GAP * self.widths.len().saturating_sub(1) as f32
    }

    fn height(&self, cells: &[Vec<Letter>]) -> f32 {
        let lines = cells.iter().zip(&self.widths);
        let lines = lines.map(|(letters, width)| text::lines(letters, *width).len());
        lines.max().unwrap_or(1) as f32 * self.leading()
    }

    fn draw_head(&self, flow: &mut Flow<'_>) {
        let (left, top) = (flow.left(), flow.y);
        flow.rule([left, top], [left + self.total(), top], BLACK, 0.8);
        let height = self.height(&self.head);
        let mut x = left;
        for (at, letters) in self.head.iter().enumerate() {
            let lines = text::lines(letters, self.widths[at]);
            // Heads of fewer lines stand at the bottom.
            let down = height - lines.len() as f32 * self.leading();
            self.put(flow, [x, top + 2.0 + down], at, &lines);
            x += self.widths[at] + GAP;
        }
        flow.y = top + height + 3.0;
        let y = flow.y;
        flow.rule([left, y], [left + self.total(), y], BLACK, 0.5);
        flow.y += 1.5;
    }

    fn draw_cells(&self, flow: &mut Flow<'_>, cells: &[LaidCell]) {
        let lines: Vec<Vec<Vec<Letter>>> = cells
            .iter()
            .zip(&self.widths)
            .map(|(cell, width)| match cell {
                LaidCell::Letters(letters) => text::lines(letters, *width),
                LaidCell::Bar(_) => Vec::new(),
            })
            .collect();
        let most = lines.iter().map(Vec::len).max().unwrap_or(1).max(1);
        if flow.room(most as f32 * self.leading() + 1.0) {
            self.draw_head(flow);
        }
        let (mut x, top) = (flow.left(), flow.y);
        for (at, cell) in cells.iter().enumerate().take(self.widths.len()) {
            match cell {
                LaidCell::Letters(_) => self.put(flow, [x, top], at, &lines[at]),
                LaidCell::Bar(share) => {
                    let length = BAR * share.clamp(0.0, 1.0) as f32;
                    let height = 0.6 * self.size;
                    flow.rectangle(
                        [x, top + 0.35 * self.leading()],
                        [length.max(0.3), height],
                        BLUE,
                    );
                }
            }
            x += self.widths[at] + GAP;
        }
        flow.y = top + most as f32 * self.leading() + 1.0;
    }

    fn put(&self, flow: &mut Flow<'_>, [x, top]: [f32; 2], column: usize, lines: &[Vec<Letter>]) {
        let right = self.kinds[column] == ColumnKind::Numbers;
        for (at, line) in lines.iter().enumerate() {
            let shift = match right {
                true => (self.widths[column] - text::width(line)).max(0.0),
                false => 0.0,
            };
            let y = top + (at as f32 + 0.78) * self.leading();
            flow.draw(Op::Letters {
                at: [x + shift, y],
                letters: line.clone(),
                colour: BLACK,
            });
        }
    }
}
