//! Workbooks: values as cached, formulas beside them.

use std::io::Cursor;

use calamine::{Data, Reader, SheetVisible, Sheets, open_workbook_auto_from_rs};
use gumption_core::quantity::{Decimal, Grouping, PowerStyle, Style};

use super::{Cell, Grid, Unreadable};

/// Every sheet of a workbook. Hidden ones come last: what is hidden is read, but does not stand in front.
pub(super) fn grids(bytes: &[u8]) -> Result<Vec<Grid>, Unreadable> {
    let unreadable = |error: &dyn std::fmt::Display| Unreadable(error.to_string());
    let mut book = open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(|e| unreadable(&e))?;
    let mut sheets = book.sheets_metadata().to_vec();
    sheets.sort_by_key(|sheet| sheet.visible != SheetVisible::Visible);
    let mut hidden = super::hidden::hidden(bytes);
    let mut grids = Vec::new();
    for sheet in sheets {
        is_of_a_size(&mut book, &sheet.name)?;
        let Ok(values) = book.worksheet_range(&sheet.name) else {
            continue;
        };
        let hidden = hidden.remove(&sheet.name).unwrap_or_default();
        let mut grid = Grid {
            name: sheet.name.clone(),
            hidden_columns: hidden.columns,
            hidden_rows: hidden.rows,
            ..Grid::default()
        };
        let (top, left) = values.start().unwrap_or((0, 0));
        for (row, column, value) in values.used_cells() {
            *cell(&mut grid, top as usize + row, left as usize + column) = Cell::new(&text(value));
        }
        if let Ok(formulas) = book.worksheet_formula(&sheet.name) {
            let (top, left) = formulas.start().unwrap_or((0, 0));
            for (row, column, formula) in formulas.used_cells().filter(|(_, _, f)| !f.is_empty()) {
                let cell = cell(&mut grid, top as usize + row, left as usize + column);
                cell.formula = Some(formula.trim_start_matches('=').to_string());
            }
        }
        grids.push(grid);
    }
    Ok(grids)
}

/// A sheet spans no more cells than this: a budget has some hundred, and a sheet is kept as a rectangle, so that two cells
/// at its far corners would take hundreds of gigabytes.
const MOST_CELLS: u64 = 1 << 20;

/// Looks at the places of the cells of a sheet before they are kept. The older forms cannot span more by themselves.
fn is_of_a_size(book: &mut Sheets<Cursor<&[u8]>>, sheet: &str) -> Result<(), Unreadable> {
    match book {
        Sheets::Xlsx(book) => match book.worksheet_cells_reader(sheet) {
            Ok(mut cells) => spans_few(
                || Some(cells.next_cell().ok().flatten()?.get_position()),
                sheet,
            ),
            Err(_) => Ok(()),
        },
        Sheets::Xlsb(book) => match book.worksheet_cells_reader(sheet) {
            Ok(mut cells) => spans_few(
                || Some(cells.next_cell().ok().flatten()?.get_position()),
                sheet,
            ),
            Err(_) => Ok(()),
        },
        Sheets::Xls(_) | Sheets::Ods(_) => Ok(()),
    }
}

fn spans_few(mut next: impl FnMut() -> Option<(u32, u32)>, sheet: &str) -> Result<(), Unreadable> {
    let (mut first, mut last) = ((u32::MAX, u32::MAX), (0, 0));
    while let Some((row, column)) = next() {
        first = (first.0.min(row), first.1.min(column));
        last = (last.0.max(row), last.1.max(column));
        let side = |from: u32, to: u32| u64::from(to - from) + 1;
        if side(first.0, last.0) * side(first.1, last.1) > MOST_CELLS {
            return Err(Unreadable(format!(
                "the sheet \"{sheet}\" spans more than {MOST_CELLS} cells; delete what stands far from the budget"
            )));
        }
    }
    Ok(())
}

fn cell(grid: &mut Grid, row: usize, column: usize) -> &mut Cell {
    if grid.rows.len() <= row {
        grid.rows.resize(row + 1, Vec::new());
    }
    let cells = &mut grid.rows[row];
    if cells.len() <= column {
        cells.resize(column + 1, Cell::default());
    }
    &mut cells[column]
}

/// A value as text. A double that is the nearest to a decimal of fifteen digits was typed as that decimal: a
/// spreadsheet keeps no more.
fn text(value: &Data) -> String {
    const PLAIN: Style = Style {
        grouping: Grouping::None,
        power: PowerStyle::Caret,
    };
    match value {
        Data::Float(x) => {
            let shortest = Decimal::from_f64(*x);
            shortest.print_plain(PLAIN)
        }
        Data::Int(n) => n.to_string(),
        Data::String(text) | Data::DateTimeIso(text) | Data::DurationIso(text) => text.clone(),
        Data::Bool(b) => b.to_string(),
        Data::DateTime(date) => date.to_string(),
        Data::Error(_) | Data::Empty => String::new(),
    }
}
