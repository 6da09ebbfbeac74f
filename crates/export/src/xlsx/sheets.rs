//! Sheets of tables, and sheets that calculate.

use rust_xlsxwriter::{Chart, ChartType, Formula, Workbook, Worksheet, XlsxError};
use unicode_width::UnicodeWidthStr;

use super::looks::Looks;
use super::names::Names;
use super::numbers::printed;
use super::report::cut;
use gumption_format::document::{Cell, ColumnKind, Entry, Held, Row, Sheet, Table};

/// A table of the document: numbers as numbers that show the digits of the report.
pub(super) fn table(
    heading: &str,
    table: &Table,
    workbook: &mut Workbook,
    looks: &Looks,
    names: &mut Names,
) -> Result<(), XlsxError> {
    let sheet = workbook.add_worksheet();
    sheet.set_name(names.like(heading))?;
    page(sheet)?;
    let columns: Vec<_> = table
        .columns
        .iter()
        .enumerate()
        // Bars repeat the shares beside them.
        .filter(|(_, column)| column.kind != ColumnKind::Bar)
        .collect();
    for ((_, column), at) in columns.iter().zip(0u16..) {
        let head = column.head.replace('\u{AD}', "");
        sheet.write_string_with_format(0, at, &head, &looks.head)?;
        sheet.set_column_width(at, width(table, at as usize, &head))?;
    }
    sheet.set_freeze_panes(1, 0)?;
    let (mut at, mut ruled) = (1, false);
    for row in &table.rows {
        let look = if ruled { &looks.ruled } else { &looks.words };
        match row {
            Row::Rule => {
                ruled = true;
                continue;
            }
            Row::Across(text) => {
                sheet.write_string_with_format(at, 0, cut(text), look)?;
            }
            Row::Cells(cells) => {
                for ((place, _), column) in columns.iter().zip(0u16..) {
                    let cell = cells.get(*place).unwrap_or(&Cell::Empty);
                    write_cell(sheet, (at, column), cell, look)?;
                }
            }
        }
        ruled = false;
        at += 1;
    }
    Ok(())
}

fn write_cell(
    sheet: &mut Worksheet,
    (row, column): (u32, u16),
    cell: &Cell,
    look: &rust_xlsxwriter::Format,
) -> Result<(), XlsxError> {
    match cell {
        Cell::Text(text) => match printed(text) {
            Some(number) => {
                let look = look.clone().set_num_format(number.format);
                sheet.write_number_with_format(row, column, number.value, &look)?
            }
            None => sheet.write_string_with_format(row, column, cut(text), look)?,
        },
        Cell::Part(text) => {
            let look = look.clone().set_indent(1);
            sheet.write_string_with_format(row, column, cut(text), &look)?
        }
        Cell::Share(share) => {
            let look = look.clone().set_num_format("0.0%");
            sheet.write_number_with_format(row, column, *share, &look)?
        }
        Cell::Empty => sheet.write_blank(row, column, look)?,
    };
    Ok(())
}

/// Characters that a column needs, within reason.
fn width(table: &Table, column: usize, head: &str) -> f64 {
    const MOST: usize = 60;
    let texts = table.rows.iter().filter_map(|row| match row {
        Row::Cells(cells) => match cells.get(column)? {
            Cell::Text(text) | Cell::Part(text) => Some(text.width()),
            _ => None,
        },
        _ => None,
    });
    let head = head.split(' ').map(|word| word.width()).max().unwrap_or(0);
    let widest = texts.chain([head, 6]).max().unwrap_or(6);
    (widest.min(MOST) + 2) as f64
}

fn page(sheet: &mut Worksheet) -> Result<(), XlsxError> {
    sheet
        .set_paper_size(9)
        .set_landscape()
        .set_print_fit_to_pages(1, 0);
    Ok(())
}

/// A sheet that calculates, with its chart.
pub(super) fn calculating(
    of: &Sheet,
    workbook: &mut Workbook,
    looks: &Looks,
    names: &mut Names,
) -> Result<(), XlsxError> {
    let name = names.like(&of.name);
    let sheet = workbook.add_worksheet();
    sheet.set_name(&name)?;
    page(sheet)?;
    for (row, entries) in of
        .rows
        .iter()
        .zip(0u32..)
        .map(|(entries, row)| (row, entries))
    {
        for (entry, column) in entries.iter().zip(0u16..) {
            write_entry(sheet, (row, column), entry, looks)?;
        }
    }
    let columns = of.rows.iter().map(Vec::len).max().unwrap_or(0);
    for column in 0..u16::try_from(columns).unwrap_or(u16::MAX) {
        sheet.set_column_width(column, if column == 0 { 38.0 } else { 15.0 })?;
    }
    let Some(bars) = &of.bars else {
        return Ok(());
    };
    let range = |column: usize| {
        let [first, last] = bars.rows.map(|row| u32::try_from(row).unwrap_or(0));
        let column = u16::try_from(column).unwrap_or(0);
        (name.as_str(), first, column, last, column)
    };
    let mut chart = Chart::new(ChartType::Bar);
    chart
        .add_series()
        .set_categories(range(bars.names))
        .set_values(range(bars.lengths))
        .set_gap(40);
    chart.title().set_name(&bars.title);
    chart.legend().set_hidden();
    // The first component on top.
    chart.y_axis().set_reverse();
    let lines = bars.rows[1] - bars.rows[0] + 1;
    chart
        .set_width(560)
        .set_height(u32::try_from(120 + 22 * lines.min(40)).unwrap_or(400));
    let right = u16::try_from(columns.min(14) + 1).unwrap_or(15);
    sheet.insert_chart(1, right, &chart)?;
    Ok(())
}

fn write_entry(
    sheet: &mut Worksheet,
    (row, column): (u32, u16),
    entry: &Entry,
    looks: &Looks,
) -> Result<(), XlsxError> {
    match entry {
        Entry::Empty => {}
        Entry::Title(text) => {
            sheet.write_string_with_format(row, column, cut(text), &looks.section)?;
        }
        Entry::Head(text) => {
            sheet.write_string_with_format(row, column, cut(text), &looks.head)?;
        }
        Entry::Words(text) => {
            sheet.write_string_with_format(row, column, cut(text), &looks.words)?;
        }
        Entry::Given(x) => number(sheet, (row, column), *x, &looks.given)?,
        Entry::Fixed(x) => number(sheet, (row, column), *x, &looks.number)?,
        Entry::Formula(text, held) => {
            let result = match held {
                Held::Number(x) if x.is_finite() => format!("{x:?}"),
                Held::Number(_) => "#NUM!".to_string(),
                Held::Words(words) => words.clone(),
            };
            let formula = Formula::new(text).set_result(result);
            sheet.write_formula_with_format(row, column, formula, &looks.number)?;
        }
    }
    Ok(())
}

/// Cells hold finite numbers.
fn number(
    sheet: &mut Worksheet,
    (row, column): (u32, u16),
    x: f64,
    look: &rust_xlsxwriter::Format,
) -> Result<(), XlsxError> {
    match x.is_finite() {
        true => sheet.write_number_with_format(row, column, x, look)?,
        false => sheet.write_string_with_format(row, column, format!("{x}"), look)?,
    };
    Ok(())
}
