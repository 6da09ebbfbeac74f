//! The text: one paragraph or table for each block, in the order in which a report is read.

use gumption_fault::language::Language;
use gumption_format::document::{Block, Cell, ColumnKind, Document, Math, Row, Severity, Table};
use gumption_format::render::inline::{Run, runs};

use super::parts::{root, value};
use crate::xml::{Element, element, text};

/// The main part.
pub(super) fn document(document: &Document) -> Element {
    let blocks = document.blocks.iter();
    let blocks = blocks.flat_map(|block| of_block(block, document.language));
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
    root("w:document").with(element("w:body").with_all(blocks).with(section))
}

fn of_block(block: &Block, language: Language) -> Vec<Element> {
    match block {
        Block::Title(words) => vec![paragraph("Title", words)],
        Block::Section(words) => vec![paragraph("Heading1", words)],
        Block::Fields(fields) => {
            let pairs = fields
                .iter()
                .map(|(name, words)| [name.clone(), words.clone()]);
            vec![pairs_of(pairs), empty()]
        }
        Block::Figures(figures) => {
            let pairs = figures
                .iter()
                .map(|figure| [figure.name.clone(), figure.text()]);
            vec![pairs_of(pairs), empty()]
        }
        Block::Paragraph(words) => vec![paragraph("Normal", words)],
        Block::Formula(lines) => lines.iter().map(|line| formula(line)).collect(),
        Block::Table(table) => vec![of_table(table), empty()],
        // Pictures are in the formats that draw.
        Block::Plot(_) => Vec::new(),
        Block::List(items) => items.iter().map(|item| bullet("", item)).collect(),
        Block::Findings(findings) => findings
            .iter()
            .map(|finding| {
                let word = match finding.severity {
                    Severity::Note => "",
                    Severity::Warning => language.pick("Caution: ", "注意："),
                    Severity::Failure => language.pick("Not to be used: ", "不可采用："),
                };
                bullet(word, &finding.text)
            })
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

fn of_style(style: &str) -> Element {
    element("w:pPr").with(value("w:pStyle", style))
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

/// A text between backquotes of equal widths, powers of ten raised.
fn runs_of(words: &str, bold: bool) -> Vec<Element> {
    let runs = runs(words).into_iter().map(|one| match one {
        Run::Plain(words) => run(words, bold.then(|| element("w:b"))),
        Run::Code(words) => {
            let fonts = element("w:rFonts")
                .attribute("w:ascii", "Courier New")
                .attribute("w:hAnsi", "Courier New");
            run(words, Some(fonts))
        }
        Run::Raised(words) => {
            let words = words.replace('-', "−");
            run(&words, Some(value("w:vertAlign", "superscript")))
        }
    });
    runs.collect()
}

fn run(words: &str, looks: Option<Element>) -> Element {
    // Word processors part words where they like.
    let words = words.replace(['\u{ad}', '\u{200b}', '\u{2060}'], "");
    element("w:r")
        .with_all(looks.map(|looks| element("w:rPr").with(looks)))
        .with(text("w:t", words).attribute("xml:space", "preserve"))
}

/// Names and texts in two columns without lines.
fn pairs_of(pairs: impl Iterator<Item = [String; 2]>) -> Element {
    let rows = pairs.map(|[name, words]| {
        element("w:tr")
            .with(cell(&name, "left", "2400"))
            .with(cell(&words, "left", "7200"))
    });
    element("w:tbl")
        .with(properties(false))
        .with(grid(2))
        .with_all(rows)
}

fn grid(columns: usize) -> Element {
    element("w:tblGrid").with_all((0..columns).map(|_| element("w:gridCol")))
}

/// As wide as the text; the lines of a table of three lines.
fn properties(ruled: bool) -> Element {
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
    element("w:tblPr")
        .with(
            element("w:tblW")
                .attribute("w:w", "5000")
                .attribute("w:type", "pct"),
        )
        .with_all(borders)
        .with(element("w:tblLayout").attribute("w:type", "autofit"))
}

fn of_table(table: &Table) -> Element {
    let shown: Vec<usize> = (0..table.columns.len())
        .filter(|at| table.columns[*at].kind != ColumnKind::Bar)
        .collect();
    let side = |at: usize| match table.columns[at].kind {
        ColumnKind::Numbers => "right",
        _ => "left",
    };
    let head = shown.iter().map(|at| {
        let words = &table.columns[*at].head;
        headed(words, side(*at))
    });
    let head = element("w:tr")
        .with(
            element("w:trPr")
                .with(element("w:cantSplit"))
                .with(element("w:tblHeader")),
        )
        .with_all(head);
    let mut rows = vec![head];
    for row in &table.rows {
        let made = element("w:tr").with(element("w:trPr").with(element("w:cantSplit")));
        match row {
            // The rows below it stand out by their words.
            Row::Rule => continue,
            Row::Across(words) => {
                let span = element("w:tcPr").with(value("w:gridSpan", shown.len().to_string()));
                let inside = element("w:p")
                    .with(of_style("Cell"))
                    .with_all(runs_of(words, true));
                rows.push(made.with(element("w:tc").with(span).with(inside)));
            }
            Row::Cells(cells) => {
                let cells = shown.iter().map(|at| {
                    let words = match cells.get(*at) {
                        Some(Cell::Text(words)) => words.clone(),
                        Some(Cell::Part(words)) => format!("\u{2003}{words}"),
                        _ => String::new(),
                    };
                    cell(&words, side(*at), "")
                });
                rows.push(made.with_all(cells));
            }
        }
    }
    element("w:tbl")
        .with(properties(true))
        .with(grid(shown.len()))
        .with_all(rows)
}

/// A head, with the line below it.
fn headed(words: &str, side: &str) -> Element {
    let line = element("w:bottom")
        .attribute("w:val", "single")
        .attribute("w:sz", "4")
        .attribute("w:space", "0")
        .attribute("w:color", "000000");
    let properties = element("w:tcPr")
        .with(element("w:tcBorders").with(line))
        .with(value("w:vAlign", "bottom"));
    let looks = of_style("Cell").with(value("w:jc", side));
    let inside = element("w:p").with(looks).with_all(runs_of(words, true));
    element("w:tc").with(properties).with(inside)
}

fn cell(words: &str, side: &str, width: &str) -> Element {
    let width = (!width.is_empty()).then(|| {
        element("w:tcPr").with(
            element("w:tcW")
                .attribute("w:w", width)
                .attribute("w:type", "dxa"),
        )
    });
    let looks = of_style("Cell").with(value("w:jc", side));
    let inside = element("w:p").with(looks).with_all(runs_of(words, false));
    element("w:tc").with_all(width).with(inside)
}
