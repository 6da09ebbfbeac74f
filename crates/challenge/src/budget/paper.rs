//! Pages as files.

use rust_xlsxwriter::{Format, Formula, Workbook, XlsxError};

use super::page::{Cell, Page};

/// Kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Paper {
    Workbook {
        decimal_comma: bool,
    },
    Separated {
        separator: char,
        decimal_comma: bool,
        gbk: bool,
    },
    Markdown,
    Plain,
}

impl Paper {
    pub(super) const ALL: [Paper; 8] = [
        Paper::Workbook {
            decimal_comma: false,
        },
        Paper::Workbook {
            decimal_comma: true,
        },
        Paper::Separated {
            separator: ',',
            decimal_comma: false,
            gbk: false,
        },
        Paper::Separated {
            separator: ';',
            decimal_comma: true,
            gbk: false,
        },
        Paper::Separated {
            separator: '\t',
            decimal_comma: false,
            gbk: false,
        },
        Paper::Separated {
            separator: ',',
            decimal_comma: false,
            gbk: true,
        },
        Paper::Markdown,
        Paper::Plain,
    ];

    pub(super) fn ending(self) -> &'static str {
        match self {
            Paper::Workbook { .. } => "xlsx",
            Paper::Separated {
                separator: '\t', ..
            } => "tsv",
            Paper::Separated { .. } => "csv",
            Paper::Markdown => "md",
            Paper::Plain => "txt",
        }
    }

    /// The bytes of a file.
    pub(super) fn bytes(self, pages: &[Page]) -> Vec<u8> {
        match self {
            Paper::Workbook { decimal_comma } => workbook(pages, decimal_comma).unwrap_or_default(),
            Paper::Separated {
                separator,
                decimal_comma,
                gbk,
            } => separated(pages, separator, decimal_comma, gbk),
            Paper::Markdown => strokes(pages).into_bytes(),
            Paper::Plain => plain(pages).into_bytes(),
        }
    }
}

fn shown(cell: &Cell, decimal_comma: bool) -> String {
    match cell {
        Cell::Empty => String::new(),
        Cell::Text(text) => text.clone(),
        Cell::Figure(text, ..) if decimal_comma => text.replace('.', ","),
        Cell::Figure(text, ..) => text.clone(),
    }
}

fn workbook(pages: &[Page], decimal_comma: bool) -> Result<Vec<u8>, XlsxError> {
    let mut book = Workbook::new();
    for page in pages {
        let sheet = book.add_worksheet();
        sheet.set_name(&page.name)?;
        for (row, cells) in page.rows.iter().enumerate() {
            for (column, cell) in cells.iter().enumerate() {
                let (row, column) = (row as u32, column as u16);
                match cell {
                    Cell::Empty => {}
                    Cell::Figure(_, value, Some(formula)) if !decimal_comma => {
                        let formula =
                            Formula::new(format!("={formula}")).set_result(value.to_string());
                        sheet.write_formula(row, column, formula)?;
                    }
                    Cell::Figure(text, ..) if !decimal_comma && text.parse::<f64>().is_ok() => {
                        let (digits, power) = text
                            .split_once('E')
                            .map_or((&**text, ""), |(x, _)| (x, "E+00"));
                        let places = digits.split('.').nth(1).map_or(0, str::len);
                        let point = if places == 0 { "" } else { "." };
                        let format = format!("0{point}{}{power}", "0".repeat(places));
                        let value: f64 = text.parse().unwrap_or(0.0);
                        sheet.write_number_with_format(
                            row,
                            column,
                            value,
                            &Format::new().set_num_format(format),
                        )?;
                    }
                    _ => {
                        sheet.write_string(row, column, shown(cell, decimal_comma))?;
                    }
                }
            }
            if row == 0 {
                let title = cells
                    .first()
                    .map(|cell| shown(cell, false))
                    .unwrap_or_default();
                sheet.merge_range(0, 0, 0, 7, &title, &Format::new().set_bold())?;
            }
        }
    }
    book.save_to_buffer()
}

fn separated(pages: &[Page], separator: char, decimal_comma: bool, gbk: bool) -> Vec<u8> {
    let mut text = String::new();
    for page in pages {
        let width = page.rows.iter().map(Vec::len).max().unwrap_or(0);
        for row in &page.rows {
            let mut fields: Vec<String> = row
                .iter()
                .map(|cell| {
                    let field = shown(cell, decimal_comma);
                    let quoted = field.contains([separator, '"', '\n']);
                    if quoted {
                        format!("\"{}\"", field.replace('"', "\"\""))
                    } else {
                        field
                    }
                })
                .collect();
            // Spreadsheets write all lines with all separators.
            fields.resize(width, String::new());
            text += &(fields.join(&separator.to_string()) + "\r\n");
        }
        text += "\r\n";
    }
    if gbk {
        let (bytes, _, lost) = encoding_rs::GBK.encode(&text);
        if !lost {
            return bytes.into_owned();
        }
    }
    if decimal_comma {
        format!("\u{feff}{text}").into_bytes()
    } else {
        text.into_bytes()
    }
}

fn strokes(pages: &[Page]) -> String {
    let mut text = String::new();
    for page in pages {
        let mut in_table = false;
        for (i, row) in page.rows.iter().enumerate() {
            let filled: Vec<String> = row.iter().map(|cell| shown(cell, false)).collect();
            if filled.len() <= 1 {
                let line = filled.concat();
                text += &match i {
                    0 => format!("# {line}\n\n"),
                    _ if line.is_empty() => "\n".into(),
                    _ => format!("{line}\n\n"),
                };
                in_table = false;
                continue;
            }
            text += &format!(
                "| {} |\n",
                filled
                    .iter()
                    .map(|f| f.replace('|', "\\|"))
                    .collect::<Vec<_>>()
                    .join(" | ")
            );
            if !in_table {
                text += &format!("|{}\n", "---|".repeat(filled.len()));
                in_table = true;
            }
        }
        text.push('\n');
    }
    text
}

fn plain(pages: &[Page]) -> String {
    let mut text = String::new();
    for page in pages {
        let mut widths: Vec<usize> = Vec::new();
        for row in page.rows.iter().filter(|row| row.len() > 2) {
            for (i, cell) in row.iter().enumerate() {
                if widths.len() <= i {
                    widths.push(0);
                }
                widths[i] = widths[i].max(shown(cell, false).chars().count());
            }
        }
        for row in &page.rows {
            let line: Vec<String> = row
                .iter()
                .enumerate()
                .map(|(i, cell)| {
                    let shown = shown(cell, false);
                    if row.len() <= 2 {
                        return shown;
                    }
                    let shown = if shown.is_empty() {
                        "-".to_string()
                    } else {
                        shown
                    };
                    let pad = widths[i] - shown.chars().count().min(widths[i]);
                    format!("{shown}{}", " ".repeat(pad))
                })
                .collect();
            text += &(line.join("   ").trim_end().to_string() + "\n");
        }
        text.push('\n');
    }
    text
}
