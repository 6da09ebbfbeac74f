//! What the reader of spreadsheets does not tell of an OpenDocument sheet: how far it spans, which rows and columns are
//! hidden, and what its numbers show.

use std::collections::BTreeMap;
use std::io::{BufReader, Cursor};

use gumption_fault::{Said, say};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use zip::ZipArchive;

use super::hidden::{Hidden, attribute};
use super::{MOST_CELLS, Unreadable};

/// One sheet.
#[derive(Debug, Default)]
pub(super) struct Told {
    pub hidden: Hidden,
    /// The texts of cells that hold numbers.
    pub shown: BTreeMap<(usize, usize), String>,
}

/// The sheets of a document by name; nothing for other files. A sheet whose cells would not fit is refused before any of
/// them is kept: a few bytes may repeat a cell a milliard times.
pub(super) fn told(bytes: &[u8]) -> Result<BTreeMap<String, Told>, Unreadable> {
    let Ok(mut archive) = ZipArchive::new(Cursor::new(bytes)) else {
        return Ok(BTreeMap::new());
    };
    let Ok(content) = archive.by_name("content.xml") else {
        return Ok(BTreeMap::new());
    };
    let mut walk = Walk::default();
    let mut reader = Reader::from_reader(BufReader::new(content));
    let mut buffer = Vec::new();
    loop {
        buffer.clear();
        let event = reader.read_event_into(&mut buffer);
        match event.map_err(|error| Unreadable(Said::quoted(error.to_string())))? {
            Event::Start(element) => walk.open(&element)?,
            Event::Empty(element) => {
                walk.open(&element)?;
                walk.close(element.name().as_ref());
            }
            Event::End(element) => walk.close(element.name().as_ref()),
            Event::Text(text) if walk.is_text() => {
                walk.text.push_str(text.as_ref());
            }
            Event::Eof => return Ok(walk.sheets),
            _ => {}
        }
    }
}

#[derive(Default)]
struct Walk {
    sheets: BTreeMap<String, Told>,
    name: String,
    sheet: Told,
    /// Columns that were declared.
    declared: usize,
    row: usize,
    column: usize,
    /// How often the open row and the open cell stand there.
    rows: usize,
    columns: usize,
    /// The first row and the last column that hold anything.
    first: Option<usize>,
    last: usize,
    is_cell: bool,
    is_number: bool,
    comments: usize,
    text: String,
}

impl Walk {
    fn is_text(&self) -> bool {
        self.is_cell && self.comments == 0
    }

    fn open(&mut self, element: &BytesStart<'_>) -> Result<(), Unreadable> {
        let number =
            |key: &str| attribute(element, key).and_then(|text| text.parse::<usize>().ok());
        let is_hidden = attribute(element, "table:visibility").is_some_and(|v| v != "visible");
        match element.name().as_ref() {
            "table:table" => {
                let name = attribute(element, "table:name").unwrap_or_default();
                *self = Walk {
                    sheets: std::mem::take(&mut self.sheets),
                    name,
                    ..Walk::default()
                };
            }
            "table:table-column" => {
                let repeated = number("table:number-columns-repeated").unwrap_or(1);
                let end = self.declared.saturating_add(repeated);
                if is_hidden {
                    self.sheet
                        .hidden
                        .columns
                        .extend(self.declared..end.min(FARTHEST));
                }
                self.declared = end;
            }
            "table:table-row" => {
                self.rows = number("table:number-rows-repeated").unwrap_or(1);
                self.column = 0;
                if is_hidden {
                    let end = self.row.saturating_add(self.rows).min(FARTHEST);
                    self.sheet.hidden.rows.extend(self.row..end);
                }
            }
            "table:table-cell" | "table:covered-table-cell" => {
                self.columns = number("table:number-columns-repeated").unwrap_or(1);
                self.is_cell = true;
                self.is_number = attribute(element, "office:value").is_some();
                self.text.clear();
                let kept = self.is_number
                    || attribute(element, "office:value-type").is_some()
                    || attribute(element, "table:formula").is_some();
                if kept {
                    self.spans()?;
                }
            }
            "office:annotation" => self.comments += 1,
            _ => {}
        }
        Ok(())
    }

    /// A cell that is kept: the sheet is as wide and as high as that.
    fn spans(&mut self) -> Result<(), Unreadable> {
        let first = *self.first.get_or_insert(self.row);
        self.last = self.last.max(self.column.saturating_add(self.columns));
        let rows = self.row.saturating_add(self.rows) - first;
        if (rows as u64).saturating_mul(self.last as u64) > MOST_CELLS {
            let sheet = &self.name;
            return Err(Unreadable(say!(
                "the sheet \"{sheet}\" spans more than {MOST_CELLS} cells; delete what stands far from the budget"
            )));
        }
        Ok(())
    }

    fn close(&mut self, name: &str) {
        match name {
            "table:table" => {
                let sheet = std::mem::take(&mut self.sheet);
                self.sheets.insert(std::mem::take(&mut self.name), sheet);
            }
            "table:table-row" => self.row = self.row.saturating_add(self.rows),
            "table:table-cell" | "table:covered-table-cell" => {
                self.is_cell = false;
                if self.is_number && self.rows == 1 && self.columns == 1 {
                    let text = std::mem::take(&mut self.text);
                    self.sheet.shown.insert((self.row, self.column), text);
                }
                self.column = self.column.saturating_add(self.columns);
            }
            "office:annotation" => self.comments = self.comments.saturating_sub(1),
            _ => {}
        }
    }
}

/// Hidden columns farther than this, and more hidden rows than this, are of no budget.
const FARTHEST: usize = 16_384;
