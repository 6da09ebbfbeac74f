//! A document as one HTML page that stands alone: nothing is loaded, nothing runs; it prints as A4.

use std::fmt::Write;

use super::format::Format;
use super::inline::{Run, runs};
use super::parts::{Part, parts};
use super::svg::{escaped, svg};
use crate::document::{Block, Cell, ColumnKind, Document, Finding, Math, Plot, Row, Table};
use gumption_fault::language::Language;

/// The format.
pub const FORMAT: Format = Format {
    name: "html",
    about: "Print a page of HTML that stands alone",
    ending: "html",
    media_type: "text/html; charset=utf-8",
    render: |document, _| Ok(html(document).into_bytes()),
};

/// A document as an HTML page. What goes on a certificate stands first in its part; plots beside the text come last.
fn html(document: &Document) -> String {
    let parts = parts(document.blocks());
    let title = parts
        .iter()
        .find_map(|part| part.title)
        .unwrap_or("gumption");
    let mut page = Page {
        language: document.language,
        html: String::new(),
        sections: 0,
    };
    let plots = document.words("Plots", "图");
    let plots = (!document.beside.is_empty()).then_some(plots.as_str());
    page.contents(&parts, plots);
    for part in &parts {
        page.part(part);
    }
    if let Some(heading) = plots {
        page.plots_beside(heading, &document.beside);
    }
    let language = match document.language {
        Language::English => "en",
        Language::Chinese => "zh-Hans",
    };
    format!(
        "<!doctype html>\n<html lang=\"{language}\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
        escaped(title),
        page.html
    )
}

/// The page while it is written.
struct Page {
    language: Language,
    html: String,
    /// Headings so far; their number is the name of their place.
    sections: usize,
}

impl Page {
    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        let _ = writeln!(self.html, "{line}");
    }

    fn word(&self, english: &'static str, chinese: &'static str) -> &'static str {
        self.language.pick(english, chinese)
    }

    /// Links to the headings, where there are enough to need them.
    fn contents(&mut self, parts: &[Part<'_>], plots: Option<&str>) {
        /// A reader sees as many headings at once.
        const AT_A_GLANCE: usize = 3;
        let mut headings: Vec<&str> = parts
            .iter()
            .flat_map(|part| &part.sections)
            .map(|section| section.heading)
            .collect();
        headings.extend(plots);
        if headings.len() <= AT_A_GLANCE {
            return;
        }
        let label = self.word("Contents", "目录");
        self.line(format_args!("<nav aria-label=\"{label}\">\n<ul>"));
        for (at, heading) in headings.iter().enumerate() {
            let heading = escaped(heading);
            self.line(format_args!(
                "<li><a href=\"#s{}\">{heading}</a></li>",
                at + 1
            ));
        }
        self.line(format_args!("</ul>\n</nav>"));
    }

    fn part(&mut self, part: &Part<'_>) {
        self.line(format_args!("<article>"));
        if let Some(title) = part.title {
            self.line(format_args!("<h1>{}</h1>", inline(title)));
        }
        part.head
            .iter()
            .for_each(|block| self.block(block, part.title));
        for section in &part.sections {
            self.heading(section.heading);
            let label = Some(section.heading);
            section
                .blocks
                .iter()
                .for_each(|block| self.block(block, label));
            self.line(format_args!("</section>"));
        }
        part.foot.iter().for_each(|block| self.block(block, None));
        self.line(format_args!("</article>"));
    }

    fn heading(&mut self, heading: &str) {
        self.sections += 1;
        let (at, heading) = (self.sections, inline(heading));
        self.line(format_args!("<section id=\"s{at}\">\n<h2>{heading}</h2>"));
    }

    fn plots_beside(&mut self, heading: &str, plots: &[Plot]) {
        self.heading(heading);
        plots.iter().for_each(|plot| self.plot(plot));
        self.line(format_args!("</section>"));
    }

    /// A block under a heading, which names what can be moved about in it.
    fn block(&mut self, block: &Block, heading: Option<&str>) {
        match block {
            Block::Title(title) => self.line(format_args!("<h1>{}</h1>", inline(title))),
            Block::Section(title) => self.line(format_args!("<h2>{}</h2>", inline(title))),
            Block::Fields(fields) => {
                let fields = fields
                    .iter()
                    .map(|(name, text)| (name.as_str(), text.clone()));
                self.pairs("fields", fields);
            }
            Block::Figures(figures) => {
                let figures = figures.iter().map(|f| (f.name.as_str(), f.text()));
                self.pairs("figures", figures);
            }
            Block::Paragraph(text) => self.line(format_args!("<p>{}</p>", inline(text))),
            Block::Formula(lines) => {
                let formulas: Option<Vec<Math>> = lines.iter().map(|line| Math::of(line)).collect();
                match formulas {
                    Some(formulas) => self.formulas(lines, &formulas),
                    None => {
                        let lines = escaped(&lines.join("\n"));
                        self.line(format_args!("<pre tabindex=\"0\">{lines}</pre>"));
                    }
                }
            }
            Block::Table(table) => self.table(table, heading),
            Block::Plot(plot) => self.plot(plot),
            Block::List(items) => self.list(items.iter().map(|item| inline(item))),
            Block::Findings(findings) => {
                let items: Vec<String> = findings.iter().map(|f| self.finding(f)).collect();
                self.list(items);
            }
            Block::Statement(sentences) => {
                self.line(format_args!("<blockquote>"));
                for sentence in sentences {
                    self.line(format_args!("<p>{}</p>", inline(sentence)));
                }
                self.line(format_args!("</blockquote>"));
            }
            Block::Closing(lines) => self.lines("closing", lines),
            Block::Footer(lines) => self.lines("small", lines),
        }
    }

    /// Formulas one below the other, which move sideways where the page is too narrow for them.
    fn formulas(&mut self, lines: &[String], formulas: &[Math]) {
        self.line(format_args!("<div class=\"formulas\" tabindex=\"0\">"));
        for (line, formula) in lines.iter().zip(formulas) {
            let (alternative, formula) = (escaped(line), mathml(formula));
            self.line(format_args!(
                "<math display=\"block\" alttext=\"{alternative}\">{formula}</math>"
            ));
        }
        self.line(format_args!("</div>"));
    }

    /// A finding, with a word before what is more than a note.
    fn finding(&self, finding: &Finding) -> String {
        let text = inline(&finding.text);
        match finding.caution() {
            "" => text,
            word => {
                let bold = word.trim_end();
                format!("<strong>{bold}</strong>{}{text}", &word[bold.len()..])
            }
        }
    }

    fn pairs<'t>(&mut self, class: &str, pairs: impl Iterator<Item = (&'t str, String)>) {
        self.line(format_args!("<dl class=\"{class}\">"));
        for (name, text) in pairs {
            let (name, text) = (inline(name), inline(&text));
            self.line(format_args!("<div><dt>{name}</dt><dd>{text}</dd></div>"));
        }
        self.line(format_args!("</dl>"));
    }

    fn list(&mut self, items: impl IntoIterator<Item = String>) {
        self.line(format_args!("<ul>"));
        for item in items {
            self.line(format_args!("<li>{item}</li>"));
        }
        self.line(format_args!("</ul>"));
    }

    fn lines(&mut self, class: &str, lines: &[String]) {
        let lines: Vec<String> = lines.iter().map(|line| inline(line)).collect();
        let lines = lines.join("<br>\n");
        self.line(format_args!("<p class=\"{class}\">{lines}</p>"));
    }

    fn plot(&mut self, plot: &Plot) {
        self.line(format_args!("<figure>\n{}</figure>", svg(plot)));
    }

    /// A table, which moves sideways where the page is too narrow for it.
    fn table(&mut self, table: &Table, heading: Option<&str>) {
        let label = escaped(heading.unwrap_or(self.word("Table", "表")));
        let wide = class_of_table(table.columns.len());
        self.line(format_args!(
            "<div {wide} role=\"group\" aria-label=\"{label}\" tabindex=\"0\">\n<table>\n<thead><tr>"
        ));
        for column in &table.columns {
            let head = inline(&column.head);
            // A column of bars repeats the shares beside it.
            if head.is_empty() {
                self.line(format_args!("<td></td>"));
            } else {
                let class = class(column.kind);
                self.line(format_args!("<th scope=\"col\"{class}>{head}</th>"));
            }
        }
        self.line(format_args!("</tr></thead>\n<tbody>"));
        let mut ruled = "";
        for row in &table.rows {
            match row {
                Row::Rule => {
                    ruled = " class=\"ruled\"";
                    continue;
                }
                Row::Across(text) => {
                    let (span, text) = (table.columns.len(), inline(text));
                    self.line(format_args!(
                        "<tr{ruled}><td class=\"across\" colspan=\"{span}\">{text}</td></tr>"
                    ));
                }
                Row::Cells(cells) => {
                    self.line(format_args!("<tr{ruled}>"));
                    for (at, column) in table.columns.iter().enumerate() {
                        let cell = cells.get(at).unwrap_or(&Cell::Empty);
                        self.line(format_args!("{}", draw_cell(cell, column.kind)));
                    }
                    self.line(format_args!("</tr>"));
                }
            }
            ruled = "";
        }
        self.line(format_args!("</tbody>\n</table>\n</div>"));
    }
}

/// Columns of numbers that stand side by side on a page of A4; the style sheet makes more of them smaller on paper, where nothing moves
/// sideways. A page is 178 mm wide between its margins, a number of three digits with its power of ten 5.7 times the size of its letters.
const ABREAST: usize = 10;

fn class_of_table(columns: usize) -> String {
    match columns > ABREAST {
        true => format!("class=\"wide many\" style=\"--columns: {columns}\""),
        false => "class=\"wide\"".into(),
    }
}

fn class(kind: ColumnKind) -> &'static str {
    match kind {
        ColumnKind::Numbers => " class=\"number\"",
        _ => "",
    }
}

fn draw_cell(cell: &Cell, kind: ColumnKind) -> String {
    match cell {
        Cell::Text(text) if kind == ColumnKind::Marks && !text.is_empty() => {
            format!("<td class=\"mark\">{}</td>", inline(text))
        }
        Cell::Text(text) => format!("<td{}>{}</td>", class(kind), inline(text)),
        Cell::Part(text) => format!("<td class=\"part\">{}</td>", inline(text)),
        Cell::Share(share) => {
            let percent = 100.0 * share.clamp(0.0, 1.0);
            format!("<td class=\"share\"><i style=\"width:{percent:.1}%\"></i></td>")
        }
        Cell::Empty => "<td></td>".to_owned(),
    }
}

/// Text between backquotes is set as code, powers of ten are raised.
fn inline(text: &str) -> String {
    let drawn = runs(text).into_iter().map(|run| match run {
        Run::Plain(text) => escaped(text),
        Run::Code(text) => format!("<code>{}</code>", escaped(text)),
        Run::Raised(text) => format!("<sup>{}</sup>", text.replace('-', "−")),
    });
    drawn.collect()
}

/// A formula in MathML Core.
fn mathml(math: &Math) -> String {
    let name = |text: &str| format!("<mi>{}</mi>", escaped(text));
    match math {
        Math::Name(base, None) => name(base),
        Math::Name(base, Some(index)) => {
            format!(
                "<msub>{}<mtext>{}</mtext></msub>",
                name(base),
                escaped(index)
            )
        }
        Math::Number(number) => format!("<mn>{}</mn>", escaped(number)),
        Math::Sign(sign) => format!("<mo>{}</mo>", escaped(sign)),
        Math::Words(words) => format!("<mtext>{}</mtext>", escaped(words)),
        Math::Row(parts) => {
            let parts: String = parts.iter().map(mathml).collect();
            format!("<mrow>{parts}</mrow>")
        }
        Math::Group(open, inside, close) => {
            format!(
                "<mrow><mo>{open}</mo>{}<mo>{close}</mo></mrow>",
                mathml(inside)
            )
        }
        Math::Fraction(above, below) => {
            format!("<mfrac>{}{}</mfrac>", mathml(above), mathml(below))
        }
        Math::Power(base, exponent) => {
            format!("<msup>{}{}</msup>", mathml(base), mathml(exponent))
        }
        Math::Root(inside) => format!("<msqrt>{}</msqrt>", mathml(inside)),
    }
}

/// Screen and A4, light and dark; contrast at least 7 : 1.
const STYLE: &str = include_str!("page.css");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::{Machine, record};

    record! {
        /// Nothing.
        Nothing {
            /// Nothing.
            none: bool,
        }
    }

    impl Machine for Nothing {
        const KIND: &'static str = "nothing";
        const VERSION: u32 = 1;
    }

    fn page(blocks: Vec<Block>) -> String {
        html(&Document::new(
            &Nothing { none: true },
            Language::English,
            blocks,
        ))
    }

    #[test]
    fn texts_stay_texts() {
        let evil = "</title><script>alert(\"1\")</script>";
        let mut table = Table::new([(evil, ColumnKind::Words)]);
        table.push(vec![evil.into()]);
        let page = page(vec![
            Block::Title(evil.into()),
            Block::Section(evil.into()),
            Block::Fields(vec![(evil.into(), evil.into())]),
            Block::Formula(vec![evil.into()]),
            Block::Table(table),
            Block::Statement(vec![evil.into(), format!("`{evil}`")]),
        ]);
        assert!(!page.contains("<script"), "{page}");
        assert_eq!(page.matches("</title>").count(), 1);
    }

    #[test]
    fn the_statement_stands_first_and_headings_are_linked() {
        let section = |name: &str| Block::Section(name.into());
        let text = |text: &str| Block::Paragraph(text.into());
        let page = page(vec![
            Block::Title("T".into()),
            text("about"),
            section("One"),
            text("1"),
            section("Two"),
            text("2"),
            section("Three"),
            text("3"),
            section("Words"),
            Block::Statement(vec!["U = 1".into()]),
        ]);
        let at = |needle: &str| {
            page.find(needle)
                .unwrap_or_else(|| panic!("{needle}: {page}"))
        };
        assert!(at("<p>about") < at("U = 1") && at("U = 1") < at("<p>1</p>"));
        assert!(at("<li><a href=\"#s1\">Words</a>") < at("<section id=\"s1\">\n<h2>Words</h2>"));
    }

    #[test]
    fn powers_of_ten_are_raised() {
        assert_eq!(inline("6.3×10^-6 V"), "6.3×10<sup>−6</sup> V");
        assert_eq!(
            inline("10^n <x^2> `10^3`"),
            "10^n &lt;x^2&gt; <code>10^3</code>"
        );
    }

    #[test]
    fn documents_of_several_parts_keep_each_statement_in_its_part() {
        let part = |name: &str| {
            [
                Block::Title(name.into()),
                Block::Section("Budget".into()),
                Block::Paragraph(format!("budget of {name}")),
                Block::Section("Statement".into()),
                Block::Statement(vec![format!("statement of {name}")]),
            ]
        };
        let page = page([part("a"), part("b")].concat());
        let at = |needle: &str| page.find(needle).expect("a part");
        assert!(at("statement of a") < at("budget of a"));
        assert!(at("budget of a") < at("statement of b"));
        assert!(at("statement of b") < at("budget of b"));
    }

    /// On paper a table cannot be moved sideways: one of many columns has smaller letters there.
    #[test]
    fn many_columns_fit_on_paper() {
        let of = |table: Table| page(vec![Block::Table(table)]);
        let number = ("c·u", ColumnKind::Numbers);
        let many = of(Table::new([number; 13]));
        assert!(many.contains("class=\"wide many\" style=\"--columns: 13\""));
        assert!(!of(Table::new([number; 9])).contains("wide many\""));
    }
}
