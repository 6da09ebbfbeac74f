//! A document on pages: what goes on a certificate first in each part, as on screens.

use gumption_format::document::{Block, Document, Math};
use gumption_format::render::parts::{Part, parts};

use super::flow::{BLACK, BLUE, Flow, GREY, PAGE, PALE, WIDTH, at_least};
use super::fonts::Style;
use super::{formula, picture, table, text};

/// Size of running text.
const SIZE: f32 = 9.5;
const LEADING: f32 = 13.2;

/// Lays a document out.
pub(super) fn lay(flow: &mut Flow<'_>, document: &Document) {
    for (at, part) in parts(document.blocks()).iter().enumerate() {
        if at > 0 {
            flow.begin_page();
        }
        lay_part(flow, part);
    }
    if !document.beside.is_empty() {
        heading(flow, &document.words("Plots", "图"));
        for plot in &document.beside {
            picture::draw(flow, plot);
        }
    }
}

fn lay_part(flow: &mut Flow<'_>, part: &Part<'_>) {
    if let Some(title) = part.title {
        let letters = flow.set(title, Style::Bold, 17.0);
        flow.lines(&letters, [flow.left(), WIDTH], 22.0, BLACK);
        flow.y += 6.0;
    }
    part.head.iter().for_each(|block| lay_block(flow, block));
    for section in &part.sections {
        heading(flow, section.heading);
        let blocks = section.blocks.iter();
        blocks.for_each(|block| lay_block(flow, block));
    }
    part.foot.iter().for_each(|block| lay_block(flow, block));
}

/// The head of a section, with room for what begins below it.
fn heading(flow: &mut Flow<'_>, words: &str) {
    flow.skip(10.0);
    flow.room(70.0);
    let letters = flow.set(words, Style::Bold, 12.0);
    flow.lines(&letters, [flow.left(), WIDTH], 16.0, BLACK);
    flow.y += 3.0;
}

fn lay_block(flow: &mut Flow<'_>, block: &Block) {
    match block {
        Block::Title(words) | Block::Section(words) => heading(flow, words),
        Block::Fields(fields) => pairs(
            flow,
            fields
                .iter()
                .map(|(name, text)| (name.as_str(), text.clone())),
        ),
        Block::Figures(figures) => {
            let figures = figures
                .iter()
                .map(|figure| (figure.name.as_str(), figure.text()));
            figures_of(flow, figures);
        }
        Block::Paragraph(words) => paragraph(flow, words, Style::Regular),
        Block::Formula(lines) => {
            for line in lines {
                let drawn = Math::of(line).is_some_and(|math| formula::draw(flow, &math));
                if !drawn {
                    let letters = flow.plain(line, Style::Mono, 8.8);
                    flow.lines(&letters, [flow.left() + 10.0, WIDTH - 10.0], 12.0, BLACK);
                }
            }
            flow.y += 5.0;
        }
        Block::Table(one) => table::draw(flow, one),
        Block::Plot(plot) => picture::draw(flow, plot),
        Block::List(items) => items.iter().for_each(|item| item_of(flow, item, "")),
        Block::Findings(findings) => {
            for finding in findings {
                item_of(flow, &finding.text, finding.caution());
            }
        }
        Block::Statement(sentences) => statement(flow, sentences),
        Block::Closing(lines) => lines
            .iter()
            .for_each(|line| paragraph(flow, line, Style::Bold)),
        Block::Footer(lines) => {
            flow.skip(4.0);
            for line in lines {
                let letters = flow.set(line, Style::Regular, 7.5);
                flow.lines(&letters, [flow.left(), WIDTH], 10.0, GREY);
            }
        }
    }
}

fn paragraph(flow: &mut Flow<'_>, words: &str, style: Style) {
    let letters = flow.set(words, style, SIZE);
    flow.lines(&letters, [flow.left(), WIDTH], LEADING, BLACK);
    flow.y += 5.0;
}

/// Names at the left, texts beside them.
fn pairs<'t>(flow: &mut Flow<'_>, pairs: impl Iterator<Item = (&'t str, String)>) {
    rows(flow, pairs, 130.0, (Style::Regular, SIZE));
}

fn figures_of<'t>(flow: &mut Flow<'_>, pairs: impl Iterator<Item = (&'t str, String)>) {
    rows(flow, pairs, 190.0, (Style::Bold, SIZE + 1.0));
}

/// Rows of a name and a text, the names in a column of this width. A list of up to a quarter of a page stays on one.
fn rows<'t>(
    flow: &mut Flow<'_>,
    pairs: impl Iterator<Item = (&'t str, String)>,
    names: f32,
    (style, size): (Style, f32),
) {
    let set: Vec<Beside> = pairs
        .map(|(name, words)| {
            let name = flow.set(name, Style::Regular, SIZE);
            let words = flow.set(&words, style, size);
            Beside::new(name, words, names)
        })
        .collect();
    let height: f32 = set.iter().map(|row| row.height).sum();
    if height <= 0.25 * PAGE[1] {
        flow.room(height);
    }
    set.iter().for_each(|row| row.draw(flow));
    flow.y += 6.0;
}

/// A name with a text beside it.
struct Beside {
    name: Vec<text::Letter>,
    words: Vec<text::Letter>,
    names: f32,
    height: f32,
}

impl Beside {
    fn new(name: Vec<text::Letter>, words: Vec<text::Letter>, names: f32) -> Beside {
        let of_name = text::lines(&name, names).len();
        let of_words = text::lines(&words, Beside::room(names)).len();
        Beside {
            height: of_name.max(of_words) as f32 * LEADING,
            name,
            words,
            names,
        }
    }

    /// What is left for the text.
    fn room(names: f32) -> f32 {
        WIDTH - names - 8.0
    }

    fn draw(&self, flow: &mut Flow<'_>) {
        flow.room(self.height.min(120.0));
        let (page, top) = (flow.pages.len(), flow.y);
        flow.lines(&self.name, [flow.left(), self.names], LEADING, GREY);
        let after = flow.y;
        if flow.pages.len() == page {
            flow.y = top;
        }
        let page = flow.pages.len();
        let column = [flow.left() + self.names + 8.0, Beside::room(self.names)];
        flow.lines(&self.words, column, LEADING, BLACK);
        if flow.pages.len() == page {
            flow.y = flow.y.max(after);
        }
    }
}

fn item_of(flow: &mut Flow<'_>, words: &str, first: &str) {
    const INDENT: f32 = 12.0;
    let mut letters = flow.plain(first, Style::Bold, SIZE);
    letters.extend(flow.set(words, Style::Regular, SIZE));
    let lines = text::lines(&letters, WIDTH - INDENT).len();
    flow.room(at_least(lines) as f32 * LEADING);
    let mark = flow.plain("•", Style::Regular, SIZE);
    let y = flow.y;
    flow.lines(&mark, [flow.left(), INDENT], LEADING, BLUE);
    flow.y = y;
    flow.lines(
        &letters,
        [flow.left() + INDENT, WIDTH - INDENT],
        LEADING,
        BLACK,
    );
    flow.y += 3.0;
}

/// Sentences for the certificate, with a line at their left.
fn statement(flow: &mut Flow<'_>, sentences: &[String]) {
    const INDENT: f32 = 12.0;
    for sentence in sentences {
        let letters = flow.set(sentence, Style::Regular, SIZE + 0.5);
        let leading = LEADING + 1.0;
        let height = text::lines(&letters, WIDTH - INDENT).len() as f32 * leading;
        flow.room(height.min(200.0));
        let (page, top) = (flow.pages.len(), flow.y);
        flow.lines(
            &letters,
            [flow.left() + INDENT, WIDTH - INDENT],
            leading,
            BLACK,
        );
        if flow.pages.len() == page {
            let (x, bottom) = (flow.left() + 2.0, flow.y);
            flow.rule([x, top + 1.0], [x, bottom], PALE, 3.0);
        }
        flow.y += 4.0;
    }
    flow.y += 4.0;
}
