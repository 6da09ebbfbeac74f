//! Every text of a document, in one walk.

use std::borrow::Cow;

use gumption_fault::harmless;

use super::{Block, Cell, Entry, Marks, Plot, Row, Sheet, Table};

/// Shows what a terminal or a page would obey.
pub(super) fn made_harmless(text: &mut String) {
    if let Cow::Owned(shown) = harmless(text) {
        *text = shown;
    }
}

/// The texts of a walk.
fn all(walk: impl FnOnce(&mut dyn FnMut(&mut String))) -> Vec<String> {
    let mut texts = Vec::new();
    walk(&mut |text| texts.push(text.clone()));
    texts
}

impl Block {
    /// Every text.
    pub(super) fn texts_of(&mut self) -> Vec<String> {
        all(|work| self.texts(work))
    }

    /// Does something to every text.
    pub(super) fn texts(&mut self, work: &mut dyn FnMut(&mut String)) {
        match self {
            Block::Title(text) | Block::Section(text) | Block::Paragraph(text) => work(text),
            Block::Fields(fields) => {
                for (name, text) in fields {
                    work(name);
                    work(text);
                }
            }
            Block::Figures(figures) => {
                for figure in figures {
                    work(&mut figure.name);
                    work(&mut figure.value);
                    work(&mut figure.unit);
                }
            }
            Block::Formula(texts)
            | Block::List(texts)
            | Block::Statement(texts)
            | Block::Closing(texts)
            | Block::Footer(texts) => texts.iter_mut().for_each(work),
            Block::Table(table) => table.texts(work),
            Block::Plot(plot) => plot.texts(work),
            Block::Findings(findings) => findings.iter_mut().for_each(|one| work(&mut one.text)),
        }
    }
}

impl Table {
    fn texts(&mut self, work: &mut dyn FnMut(&mut String)) {
        self.columns.iter_mut().for_each(|one| work(&mut one.head));
        for row in &mut self.rows {
            match row {
                Row::Cells(cells) => {
                    for cell in cells {
                        if let Cell::Text(text) | Cell::Part(text) = cell {
                            work(text);
                        }
                    }
                }
                Row::Across(text) => work(text),
                Row::Rule => {}
            }
        }
    }
}

impl Plot {
    /// Every text.
    pub(super) fn texts_of(&mut self) -> Vec<String> {
        all(|work| self.texts(work))
    }

    /// Does something to every text.
    pub(super) fn texts(&mut self, work: &mut dyn FnMut(&mut String)) {
        for panel in &mut self.panels {
            work(&mut panel.title);
            for axis in [&mut panel.x, &mut panel.y] {
                work(&mut axis.quantity);
                work(&mut axis.unit);
            }
            for layer in &mut panel.layers {
                work(&mut layer.name);
                if let Marks::Bars(bars) = &mut layer.marks {
                    bars.iter_mut().for_each(|bar| work(&mut bar.name));
                }
            }
        }
    }
}

impl Sheet {
    /// Every text that is no formula.
    pub(super) fn texts_of(&mut self) -> Vec<String> {
        all(|work| self.texts(work))
    }

    /// Does something to every text that is no formula; formulas are made of numbers and names of cells.
    pub(super) fn texts(&mut self, work: &mut dyn FnMut(&mut String)) {
        work(&mut self.name);
        if let Some(bars) = &mut self.bars {
            work(&mut bars.title);
        }
        for entry in self.rows.iter_mut().flatten() {
            if let Entry::Title(text) | Entry::Head(text) | Entry::Words(text) = entry {
                work(text);
            }
        }
    }
}
