//! The first sheet: what a person reads, the statement first; tables have sheets of their own.

use rust_xlsxwriter::{Workbook, Worksheet, XlsxError};
use unicode_width::UnicodeWidthStr;

use super::looks::Looks;
use super::names::Names;
use gumption_format::document::{Block, Document, Table};

/// Width of the column of words, in characters.
const WORDS: usize = 90;
const LABELS: usize = 34;

/// Writes the report; its tables with their headings are left.
pub(super) fn report<'d>(
    document: &'d Document,
    workbook: &mut Workbook,
    looks: &Looks,
    names: &mut Names,
) -> Result<Vec<(&'d str, &'d Table)>, XlsxError> {
    let language = document.language;
    let sheet = workbook.add_worksheet();
    sheet.set_name(names.like(language.pick("Report", "报告")))?;
    sheet.set_paper_size(9).set_print_fit_to_pages(1, 0);
    sheet.set_column_width(0, LABELS as f64)?;
    sheet.set_column_width(1, WORDS as f64)?;
    let mut page = Sheet {
        sheet,
        looks,
        row: 0,
    };
    let mut tables = Vec::new();
    let mut heading = language.pick("Table", "表");
    // A heading above nothing but tables is on their sheets.
    let mut waiting: Option<&str> = None;
    for block in document.blocks() {
        match block {
            Block::Section(title) => {
                heading = title;
                waiting = Some(title);
                continue;
            }
            Block::Table(table) => {
                tables.push((heading, table));
                continue;
            }
            Block::Plot(_) => continue,
            _ => {}
        }
        if let (Some(title), false) = (waiting.take(), matches!(block, Block::Title(_))) {
            page.row += 1;
            page.line(title, &looks.section)?;
        }
        page.block(block)?;
    }
    Ok(tables)
}

struct Sheet<'w> {
    sheet: &'w mut Worksheet,
    looks: &'w Looks,
    row: u32,
}

impl Sheet<'_> {
    fn line(&mut self, text: &str, format: &rust_xlsxwriter::Format) -> Result<(), XlsxError> {
        self.sheet
            .write_string_with_format(self.row, 0, cut(text), format)?;
        self.row += 1;
        Ok(())
    }

    /// Words over both columns.
    fn across(&mut self, text: &str, format: &rust_xlsxwriter::Format) -> Result<(), XlsxError> {
        self.sheet
            .merge_range(self.row, 0, self.row, 1, &cut(text), format)?;
        self.height(text, LABELS + WORDS)?;
        self.row += 1;
        Ok(())
    }

    fn pair(&mut self, name: &str, text: &str) -> Result<(), XlsxError> {
        let wrapped = &self.looks.wrapped;
        self.sheet
            .write_string_with_format(self.row, 0, cut(name), wrapped)?;
        match super::numbers::printed(text) {
            Some(number) => {
                let format = wrapped.clone().set_num_format(number.format);
                let format = format.set_align(rust_xlsxwriter::FormatAlign::Left);
                self.sheet
                    .write_number_with_format(self.row, 1, number.value, &format)?;
            }
            None => {
                self.sheet
                    .write_string_with_format(self.row, 1, cut(text), wrapped)?;
            }
        }
        self.height(text, WORDS)?;
        self.row += 1;
        Ok(())
    }

    /// Merged cells do not grow by themselves.
    fn height(&mut self, text: &str, width: usize) -> Result<(), XlsxError> {
        let lines: usize = text.lines().map(|line| 1 + line.width() / width).sum();
        if lines > 1 {
            self.sheet.set_row_height(self.row, 15.5 * lines as f64)?;
        }
        Ok(())
    }

    fn block(&mut self, block: &Block) -> Result<(), XlsxError> {
        let looks = self.looks;
        match block {
            Block::Title(text) => {
                if self.row > 0 {
                    self.row += 2;
                }
                self.line(text, &looks.title)?;
            }
            Block::Section(text) => self.line(text, &looks.section)?,
            Block::Fields(fields) => {
                for (name, text) in fields {
                    self.pair(name, text)?;
                }
            }
            Block::Figures(figures) => {
                for figure in figures {
                    self.pair(&figure.name, &figure.text())?;
                }
            }
            Block::Paragraph(text) => self.across(text, &looks.wrapped)?,
            Block::Formula(lines) => {
                for line in lines {
                    self.line(line, &looks.words)?;
                }
            }
            Block::List(items) => {
                for item in items {
                    self.across(&format!("• {item}"), &looks.wrapped)?;
                }
            }
            Block::Findings(findings) => {
                for finding in findings {
                    let words = format!("• {}{}", finding.caution(), finding.text);
                    self.across(&words, &looks.wrapped)?;
                }
            }
            Block::Statement(sentences) => {
                for sentence in sentences {
                    self.across(sentence, &looks.emphasis)?;
                }
            }
            Block::Closing(lines) => {
                for line in lines {
                    self.across(line, &looks.wrapped)?;
                }
            }
            Block::Footer(lines) => {
                self.row += 1;
                for line in lines {
                    self.across(line, &looks.small)?;
                }
            }
            Block::Table(_) | Block::Plot(_) => {}
        }
        Ok(())
    }
}

/// As much of a text as a cell holds.
pub(super) fn cut(text: &str) -> String {
    const MOST: usize = 32_767;
    match text.encode_utf16().count() <= MOST {
        true => text.to_string(),
        false => text.chars().take(MOST / 2).chain(['…']).collect(),
    }
}
