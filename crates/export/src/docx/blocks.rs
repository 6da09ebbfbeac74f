//! The text: one paragraph or table for each block, in the order in which a report is read.

use gumption_format::document::{Block, Document, Math};

use super::parts::root;
use super::pictures::Pictures;
use super::tables;
use super::words::{of_style, run, runs_of};
use crate::xml::{Element, element, text};

/// The main part, and the pictures in it.
pub(super) fn document(document: &Document) -> (Element, Pictures) {
    let mut pictures = Pictures::default();
    let blocks = document.blocks();
    // Small print stays at the end, behind the plots.
    let is_text = |block: &Block| !matches!(block, Block::Footer(_));
    let end = blocks.iter().rposition(is_text).map_or(0, |last| last + 1);
    let (text, small) = blocks.split_at(end);
    let mut blocks: Vec<Element> = Vec::new();
    for block in text {
        blocks.extend(of_block(block, &mut pictures));
    }
    if !document.beside.is_empty() {
        blocks.push(paragraph("Heading1", &document.words("Plots", "图")));
    }
    for plot in &document.beside {
        blocks.extend(pictures.of(plot));
    }
    for block in small {
        blocks.extend(of_block(block, &mut pictures));
    }
    let footer = element("w:footerReference")
        .attribute("w:type", "default")
        .attribute("r:id", "rId2");
    let size = element("w:pgSz")
        .attribute("w:w", "11906")
        .attribute("w:h", "16838");
    let mut margins = element("w:pgMar");
    for side in [
        "w:top", "w:right", "w:bottom", "w:left", "w:header", "w:footer",
    ] {
        margins = margins.attribute(side, if side.ends_with("er") { "600" } else { "1134" });
    }
    let section = element("w:sectPr").with(footer).with(size).with(margins);
    let body = element("w:body").with_all(blocks).with(section);
    (root("w:document").with(body), pictures)
}

fn of_block(block: &Block, pictures: &mut Pictures) -> Vec<Element> {
    match block {
        Block::Title(words) => vec![paragraph("Title", words)],
        Block::Section(words) => vec![paragraph("Heading1", words)],
        Block::Fields(fields) => {
            let pairs = fields
                .iter()
                .map(|(name, words)| [name.clone(), words.clone()]);
            vec![tables::of_pairs(pairs), empty()]
        }
        Block::Figures(figures) => {
            let pairs = figures
                .iter()
                .map(|figure| [figure.name.clone(), figure.text()]);
            vec![tables::of_pairs(pairs), empty()]
        }
        Block::Paragraph(words) => vec![paragraph("Normal", words)],
        Block::Formula(lines) => lines.iter().map(|line| formula(line)).collect(),
        Block::Table(table) => vec![tables::of_table(table), empty()],
        Block::Plot(plot) => pictures.of(plot),
        Block::List(items) => items.iter().map(|item| bullet("", item)).collect(),
        Block::Findings(findings) => findings
            .iter()
            .map(|finding| bullet(finding.caution(), &finding.text))
            .collect(),
        Block::Statement(sentences) => sentences
            .iter()
            .map(|words| paragraph("Statement", words))
            .collect(),
        Block::Closing(lines) => lines
            .iter()
            .map(|words| paragraph("Normal", words))
            .collect(),
        Block::Footer(lines) => lines
            .iter()
            .map(|words| paragraph("Small", words))
            .collect(),
    }
}

fn paragraph(style: &str, words: &str) -> Element {
    element("w:p")
        .with(of_style(style))
        .with_all(runs_of(words, false))
}

/// Between tables, which would be one without it.
fn empty() -> Element {
    element("w:p").with(of_style("Cell"))
}

fn bullet(first: &str, words: &str) -> Element {
    element("w:p")
        .with(of_style("ListBullet"))
        .with(run("•  ", None))
        .with_all((!first.is_empty()).then(|| run(first, Some(element("w:b")))))
        .with_all(runs_of(words, false))
}

/// A formula as mathematics, on a line of its own.
fn formula(line: &str) -> Element {
    let inside = match Math::of(line) {
        Some(math) => omml(&math),
        None => vec![run_of_mathematics(line)],
    };
    let mathematics = element("m:oMath").with_all(inside);
    element("w:p").with(element("m:oMathPara").with(mathematics))
}

fn run_of_mathematics(words: &str) -> Element {
    element("m:r").with(text("m:t", words).attribute("xml:space", "preserve"))
}

/// A part of a formula.
fn omml(math: &Math) -> Vec<Element> {
    let one = |name: &'static str, part: &Math| element(name).with_all(omml(part));
    match math {
        Math::Name(base, None) => vec![run_of_mathematics(base)],
        Math::Name(base, Some(index)) => {
            let base = element("m:e").with(run_of_mathematics(base));
            let index = element("m:sub").with(run_of_mathematics(index));
            vec![element("m:sSub").with(base).with(index)]
        }
        Math::Number(number) => vec![run_of_mathematics(number)],
        Math::Sign(sign) => vec![run_of_mathematics(sign)],
        Math::Words(words) => {
            let upright = element("m:rPr").with(element("m:nor"));
            let words = text("m:t", words).attribute("xml:space", "preserve");
            vec![element("m:r").with(upright).with(words)]
        }
        Math::Row(parts) => parts.iter().flat_map(omml).collect(),
        Math::Group(open, inside, close) => {
            let bracket = |name: &'static str, sign: &str| element(name).attribute("m:val", sign);
            let properties = element("m:dPr")
                .with(bracket("m:begChr", open))
                .with(bracket("m:endChr", close));
            vec![element("m:d").with(properties).with(one("m:e", inside))]
        }
        Math::Fraction(above, below) => {
            vec![
                element("m:f")
                    .with(one("m:num", above))
                    .with(one("m:den", below)),
            ]
        }
        Math::Power(base, exponent) => {
            vec![
                element("m:sSup")
                    .with(one("m:e", base))
                    .with(one("m:sup", exponent)),
            ]
        }
        Math::Root(inside) => {
            let hidden = element("m:radPr").with(element("m:degHide").attribute("m:val", "1"));
            let root = element("m:rad").with(hidden).with(element("m:deg"));
            vec![root.with(one("m:e", inside))]
        }
    }
}
