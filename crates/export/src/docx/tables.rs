//! Tables of three lines, their columns as wide as their contents need, and names with their texts.

use gumption_format::document::{Cell, ColumnKind, Row, Table};
use gumption_format::render::drawing;
use gumption_format::render::inline::{Run, runs};

use super::parts::{WIDTH, value};
use super::words::{of_style, runs_of};
use crate::columns::widths;
use crate::xml::{Element, element};

/// Left and right of the words of a cell.
const MARGIN: f32 = 70.0;
/// The words of the cells of a table.
#[derive(Clone, Copy)]
struct Look {
    /// Their style.
    style: &'static str,
    /// Their size, as the style has it.
    size: f32,
}
const CELL: Look = Look {
    style: "Cell",
    size: 9.0 * 20.0,
};
/// Of a table whose numbers would be broken otherwise.
const SMALL: Look = Look {
    style: "SmallCell",
    size: 7.5 * 20.0,
};
/// How far parts stand to the right of what they are parts of.
const INDENT: f32 = 200.0;

/// Names and texts in two columns without lines.
pub(super) fn of_pairs(pairs: impl Iterator<Item = [String; 2]>) -> Element {
    let pairs: Vec<[String; 2]> = pairs.collect();
    /// The parts of the width that names take at least and at most.
    const LEAST: f32 = 0.2;
    const MOST: f32 = 0.4;
    let names = pairs.iter().map(|[name, _]| CELL.wide(name, false));
    let names = names.fold(LEAST * WIDTH, f32::max).min(MOST * WIDTH);
    let sizes = [names, WIDTH - names];
    let rows = pairs.iter().map(|pair| {
        let cells = pair.iter().zip(sizes);
        let cells = cells.map(|(words, width)| cell(words, CELL.of_side("left"), width, false));
        element("w:tr").with_all(cells)
    });
    table(&sizes, false).with_all(rows)
}

/// A table without its bars, which repeat the shares beside them.
pub(super) fn of_table(table_of: &Table) -> Element {
    let shown: Vec<usize> = (0..table_of.columns.len())
        .filter(|at| table_of.columns[*at].kind != ColumnKind::Bar)
        .collect();
    let (sizes, look) = match sizes(table_of, &shown, CELL) {
        (sizes, true) => (sizes, CELL),
        (_, false) => (sizes(table_of, &shown, SMALL).0, SMALL),
    };
    let side = |at: usize| match table_of.columns[at].kind {
        ColumnKind::Numbers => "right",
        _ => "left",
    };
    let head = shown.iter().zip(&sizes).map(|(at, width)| {
        let words = &table_of.columns[*at].head;
        headed(words, look.of_side(side(*at)), *width)
    });
    let head = element("w:tr")
        .with(
            element("w:trPr")
                .with(element("w:cantSplit"))
                .with(element("w:tblHeader")),
        )
        .with_all(head);
    let mut rows = vec![head];
    let mut ruled = false;
    for row in &table_of.rows {
        let made = element("w:tr").with(element("w:trPr").with(element("w:cantSplit")));
        match row {
            Row::Rule => {
                ruled = true;
                continue;
            }
            Row::Across(words) => {
                let span = element("w:tcPr").with(value("w:gridSpan", shown.len().to_string()));
                let inside = element("w:p")
                    .with(of_style(look.style))
                    .with_all(runs_of(words, true));
                rows.push(made.with(element("w:tc").with(span).with(inside)));
            }
            Row::Cells(cells) => {
                let cells = shown.iter().zip(&sizes).map(|(at, width)| {
                    let of = cells.get(*at).unwrap_or(&Cell::Empty);
                    let looks = match of {
                        Cell::Part(_) => look.indented(),
                        _ => look.of_side(side(*at)),
                    };
                    cell(words_of(of), looks, *width, ruled)
                });
                rows.push(made.with_all(cells));
            }
        }
        ruled = false;
    }
    table(&sizes, true).with_all(rows)
}

fn words_of(cell: &Cell) -> &str {
    match cell {
        Cell::Text(words) | Cell::Part(words) => words,
        Cell::Share(_) | Cell::Empty => "",
    }
}

/// Widths of the columns that are shown, and whether no word of theirs is broken.
fn sizes(table: &Table, shown: &[usize], look: Look) -> (Vec<f32>, bool) {
    let columns = shown.iter().map(|at| {
        let numbers = table.columns[*at].kind == ColumnKind::Numbers;
        let head = &table.columns[*at].head;
        let (mut least, mut most) = (look.longest_word(head, true), look.wide(head, true));
        for row in &table.rows {
            if let Row::Cells(cells) = row {
                let of = cells.get(*at).unwrap_or(&Cell::Empty);
                let (words, indent) = match of {
                    Cell::Part(words) => (words.as_str(), INDENT),
                    other => (words_of(other), 0.0),
                };
                let all = indent + look.wide(words, false);
                most = most.max(all);
                least = least.max(match numbers {
                    true => all,
                    false => indent + look.longest_word(words, false),
                });
            }
        }
        (least, most.max(least))
    });
    let (least, most): (Vec<f32>, Vec<f32>) = columns.unzip();
    widths(&least, &most, WIDTH)
}

impl Look {
    /// Words at a side of their cell.
    fn of_side(self, side: &str) -> Element {
        of_style(self.style).with(value("w:jc", side))
    }

    /// Words of what is a part of the row above.
    fn indented(self) -> Element {
        let indent = element("w:ind").attribute("w:left", twentieths(INDENT));
        of_style(self.style).with(indent)
    }

    /// Room that words take in a cell.
    fn wide(self, words: &str, bold: bool) -> f32 {
        let shown: String = runs(words)
            .into_iter()
            .map(|run| match run {
                Run::Plain(words) | Run::Code(words) | Run::Raised(words) => words,
            })
            .collect();
        /// Fonts of templates may be wider.
        const RESERVE: f32 = 1.15;
        RESERVE * self.size * drawing::width(&shown, bold) as f32 + 2.0 * MARGIN
    }

    /// Room for the longest part that no line should break in: Chinese breaks anywhere.
    fn longest_word(self, words: &str, bold: bool) -> f32 {
        let breaks = |c: char| c == ' ' || drawing::advance(c, bold) >= 1.0 && !c.is_ascii();
        let words = words.split(breaks).map(|word| self.wide(word, bold));
        words.fold(self.size + 2.0 * MARGIN, f32::max)
    }
}

/// A table of these columns; the lines of a table of three lines.
fn table(sizes: &[f32], ruled: bool) -> Element {
    let line = |name: &'static str| {
        element(name)
            .attribute("w:val", "single")
            .attribute("w:sz", "8")
            .attribute("w:space", "0")
            .attribute("w:color", "000000")
    };
    let borders = ruled.then(|| {
        element("w:tblBorders")
            .with(line("w:top"))
            .with(line("w:bottom"))
    });
    let margin = |name: &'static str| width_of(name, MARGIN);
    let properties = element("w:tblPr")
        .with(width_of("w:tblW", sizes.iter().sum()))
        .with_all(borders)
        .with(element("w:tblLayout").attribute("w:type", "fixed"))
        .with(
            element("w:tblCellMar")
                .with(margin("w:left"))
                .with(margin("w:right")),
        );
    let columns = sizes
        .iter()
        .map(|size| element("w:gridCol").attribute("w:w", twentieths(*size)));
    element("w:tbl")
        .with(properties)
        .with(element("w:tblGrid").with_all(columns))
}

fn width_of(name: &'static str, width: f32) -> Element {
    element(name)
        .attribute("w:w", twentieths(width))
        .attribute("w:type", "dxa")
}

fn twentieths(width: f32) -> String {
    format!("{width:.0}")
}

/// A head, with the line below it.
fn headed(words: &str, looks: Element, width: f32) -> Element {
    let properties = element("w:tcPr")
        .with(width_of("w:tcW", width))
        .with(element("w:tcBorders").with(thin("w:bottom")))
        .with(value("w:vAlign", "bottom"));
    let inside = element("w:p").with(looks).with_all(runs_of(words, true));
    element("w:tc").with(properties).with(inside)
}

/// A cell; the first row below a rule has it above its words.
fn cell(words: &str, looks: Element, width: f32, ruled: bool) -> Element {
    let properties = element("w:tcPr")
        .with(width_of("w:tcW", width))
        .with_all(ruled.then(|| element("w:tcBorders").with(thin("w:top"))));
    let inside = element("w:p").with(looks).with_all(runs_of(words, false));
    element("w:tc").with(properties).with(inside)
}

fn thin(side: &'static str) -> Element {
    element(side)
        .attribute("w:val", "single")
        .attribute("w:sz", "4")
        .attribute("w:space", "0")
        .attribute("w:color", "000000")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of so many columns of numbers.
    fn numbers<const N: usize>() -> Table {
        let mut table = Table::new([("c", ColumnKind::Numbers); N]);
        table.push(vec![Cell::Text("-1.2345×10^-12".into()); N]);
        table
    }

    #[test]
    fn numbers_that_do_not_fit_are_smaller_and_not_broken() {
        let shown: Vec<usize> = (0..7).collect();
        assert!(!sizes(&numbers::<7>(), &shown, CELL).1);
        assert!(sizes(&numbers::<7>(), &shown, SMALL).1);
        let style = |table: &Table| {
            let text = of_table(table).document().expect("a document");
            String::from_utf8(text)
                .expect("UTF-8")
                .contains(SMALL.style)
        };
        assert!(style(&numbers::<7>()) && !style(&numbers::<4>()));
    }
}
