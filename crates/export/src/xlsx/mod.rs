//! A document as a workbook: the report, a sheet for each table, the sheets that calculate, and the data of the plots with
//! charts of the spreadsheet's own.

mod charts;
mod looks;
mod names;
mod numbers;
mod report;
mod sheets;

use rust_xlsxwriter::{DocProperties, ExcelDateTime, Workbook, XlsxError};

use gumption_fault::say;
use gumption_format::document::{Block, Document};
use gumption_format::render::{Format, Page, Unfit};

use looks::Looks;
use names::Names;

/// The format.
pub const FORMAT: Format = Format {
    name: "xlsx",
    about: "Write a workbook for spreadsheets, with formulas that follow changed cells",
    ending: "xlsx",
    media_type: "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    render,
};

fn render(document: &Document, _: &Page) -> Result<Vec<u8>, Unfit> {
    workbook(document).map_err(|error| {
        let error = error.to_string();
        Unfit(say!("the document does not fit into a workbook: {error}"))
    })
}

fn workbook(document: &Document) -> Result<Vec<u8>, XlsxError> {
    let mut workbook = Workbook::new();
    let title = document.blocks().iter().find_map(|block| match block {
        Block::Title(title) => Some(title.as_str()),
        _ => None,
    });
    // The same document gives the same bytes: no clock is read.
    let properties = DocProperties::new()
        .set_title(
            title
                .unwrap_or_default()
                .chars()
                .take(200)
                .collect::<String>(),
        )
        .set_creation_datetime(&ExcelDateTime::from_ymd(2000, 1, 1)?);
    workbook.set_properties(&properties);
    let (looks, mut names) = (Looks::new(), Names::default());
    let tables = report::report(document, &mut workbook, &looks, &mut names)?;
    for sheet in &document.sheets {
        sheets::calculating(sheet, &mut workbook, &looks, &mut names)?;
    }
    for (heading, table) in tables {
        sheets::table(heading, table, &mut workbook, &looks, &mut names)?;
    }
    charts::plots(document, &mut workbook, &looks, &mut names)?;
    workbook.save_to_buffer()
}
