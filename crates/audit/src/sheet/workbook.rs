//! Workbooks: values as cached, formulas beside them.

use std::io::Cursor;

use calamine::{Data, DataRef, Reader, SheetVisible, Sheets, open_workbook_auto_from_rs};

use gumption_fault::say;

use super::{Cell, Grid, MOST_CELLS, Unreadable, open_document, shown, stale, uncached};
use gumption_format::contained::contained;

/// Every sheet of a workbook. Hidden ones come last: what is hidden is read, but does not stand in front.
pub(super) fn grids(bytes: &[u8]) -> Result<Vec<Grid>, Unreadable> {
    // The library trusts the sizes that a file states of its own parts, and panics where one is cut off.
    contained(|| sheets(bytes)).unwrap_or_else(|| {
        Err(Unreadable(say!(
            "it is damaged, or was not copied to its end; open it in the program that wrote it, and save it again"
        )))
    })
}

/// What the cells of a sheet show of a number: row, column, the number.
type Look = Box<dyn Fn(usize, usize, f64) -> Option<String>>;

fn sheets(bytes: &[u8]) -> Result<Vec<Grid>, Unreadable> {
    let mut documents = open_document::told(bytes)?;
    // The library tries all kinds in turn, and says of the last one only that it is none.
    let mut book = open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(|_| {
        Unreadable(say!(
            "it is no workbook that can be read (.xlsx, .xls, .ods): damaged, locked by a password, or another kind of file; open it in the program that wrote it, and save it again"
        ))
    })?;
    let mut sheets = book.sheets_metadata().to_vec();
    sheets.sort_by_key(|sheet| sheet.visible != SheetVisible::Visible);
    let mut hidden = super::hidden::hidden(bytes);
    let (mut grids, mut looks): (Vec<Grid>, Vec<Look>) = (Vec::new(), Vec::new());
    for sheet in sheets {
        is_of_a_size(&mut book, &sheet.name)?;
        let Ok(values) = book.worksheet_range(&sheet.name) else {
            continue;
        };
        let document = documents.remove(&sheet.name).unwrap_or_default();
        let hidden = hidden.remove(&sheet.name).unwrap_or(document.hidden);
        let styles = book.worksheet_style(&sheet.name).ok();
        let mut grid = Grid {
            name: sheet.name.clone(),
            hidden_columns: hidden.columns,
            hidden_rows: hidden.rows,
            ..Grid::default()
        };
        let shows = move |row: usize, column: usize, x: f64| {
            let place = (u32::try_from(row).ok()?, u32::try_from(column).ok()?);
            let of_style = styles.as_ref().and_then(|styles| {
                let style = styles.get(place);
                match style.and_then(|style| style.number_format.as_ref()) {
                    Some(format) => shown::formatted(x, &format.format_code),
                    None => shown::general(x),
                }
            });
            let of_document = document.shown.get(&(row, column));
            of_document.cloned().or(of_style)
        };
        let (top, left) = values.start().unwrap_or((0, 0));
        for (row, column, value) in values.used_cells() {
            let (row, column) = (top as usize + row, left as usize + column);
            *cell(&mut grid, row, column) = of_value(value, |x| shows(row, column, x));
        }
        if let Ok(formulas) = book.worksheet_formula(&sheet.name) {
            let (top, left) = formulas.start().unwrap_or((0, 0));
            for (row, column, formula) in formulas.used_cells().filter(|(_, _, f)| !f.is_empty()) {
                let cell = cell(&mut grid, top as usize + row, left as usize + column);
                cell.formula = Some(formula.trim_start_matches('=').to_string());
            }
        }
        grids.push(grid);
        looks.push(Box::new(shows));
    }
    uncached::compute(&mut grids, |at, x| looks[at.sheet](at.row, at.column, x));
    stale::mark(&mut grids);
    Ok(grids)
}

/// Looks at the places of the cells of a sheet before they are kept. A sheet in
/// OpenDocument has been looked at before; the oldest form cannot span more by itself.
fn is_of_a_size(book: &mut Sheets<Cursor<&[u8]>>, sheet: &str) -> Result<(), Unreadable> {
    match book {
        Sheets::Xlsx(book) => match book.worksheet_cells_reader(sheet) {
            Ok(mut cells) => spans_few(|| told(&cells.next_cell().ok().flatten()?), sheet),
            Err(_) => Ok(()),
        },
        Sheets::Xlsb(book) => match book.worksheet_cells_reader(sheet) {
            Ok(mut cells) => spans_few(|| told(&cells.next_cell().ok().flatten()?), sheet),
            Err(_) => Ok(()),
        },
        Sheets::Xls(_) | Sheets::Ods(_) => Ok(()),
    }
}

/// A cell of a workbook, as far as its size matters: where it stands, where it holds anything. A style without a value
/// is painted, and kept nowhere.
type Told = Option<(u32, u32)>;

fn told(cell: &calamine::Cell<DataRef<'_>>) -> Option<Told> {
    let is_filled = !matches!(cell.get_value(), DataRef::Empty);
    Some(is_filled.then(|| cell.get_position()))
}

fn spans_few(mut next: impl FnMut() -> Option<Told>, sheet: &str) -> Result<(), Unreadable> {
    let (mut first, mut last) = ((u32::MAX, u32::MAX), (0, 0));
    while let Some(told) = next() {
        let Some((row, column)) = told else { continue };
        first = (first.0.min(row), first.1.min(column));
        last = (last.0.max(row), last.1.max(column));
        let side = |from: u32, to: u32| u64::from(to - from) + 1;
        if side(first.0, last.0) * side(first.1, last.1) > MOST_CELLS {
            return Err(Unreadable(say!(
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

/// The cell of a value. A double that is the nearest to a decimal of fifteen digits was typed as that decimal: a
/// spreadsheet keeps no more.
fn of_value(value: &Data, shows: impl Fn(f64) -> Option<String>) -> Cell {
    match value {
        Data::Float(x) => shown::cell(*x, shows(*x).as_deref()),
        Data::Int(n) => shown::cell(*n as f64, None),
        Data::String(text) | Data::DateTimeIso(text) | Data::DurationIso(text) => Cell::new(text),
        Data::Bool(b) => Cell::new(&b.to_string()),
        Data::DateTime(date) => Cell::new(&date.to_string()),
        Data::Error(_) | Data::Empty => Cell::default(),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use zip::write::{SimpleFileOptions, ZipWriter};

    use super::*;

    /// One sheet with formulas, formats that hide digits, a merged title and a hidden row, as LibreOffice saves it.
    const BOOKS: [(&str, &[u8]); 3] = [
        (
            "xlsx",
            include_bytes!("../../tests/workbooks/gauge-block.xlsx"),
        ),
        (
            "ods",
            include_bytes!("../../tests/workbooks/gauge-block.ods"),
        ),
        (
            "xls",
            include_bytes!("../../tests/workbooks/gauge-block.xls"),
        ),
    ];

    #[test]
    fn one_sheet_is_read_the_same_from_all_forms() {
        let read = BOOKS.map(|(_, bytes)| grids(bytes).unwrap().remove(0));
        assert_eq!(read[0], without_style_of_formulas(&read[1], &read[0]));
        assert_eq!(read[0].hidden_rows.iter().collect::<Vec<_>>(), [&8]);
        let [xlsx, _, xls] = &read;
        for (row, cells) in xlsx.rows.iter().enumerate() {
            for (column, cell) in cells.iter().enumerate() {
                // The oldest form does not tell its formats: values alone are the same.
                let (a, b) = (cell.figure(), xls.cell(row, column).figure());
                let value =
                    |figure: Option<crate::printed::Printed>| figure.map(|figure| figure.value);
                match (value(a), value(b)) {
                    (Some(a), Some(b)) => {
                        assert!(a == b || (a - b).abs() <= 1e-14 * a.abs(), "{a} {b}")
                    }
                    _ => assert_eq!(cell.text, xls.cell(row, column).text),
                }
            }
        }
    }

    /// Formulas are written in another way in OpenDocument.
    fn without_style_of_formulas(grid: &Grid, like: &Grid) -> Grid {
        let mut grid = grid.clone();
        for (row, cells) in grid.rows.iter_mut().enumerate() {
            for (column, cell) in cells.iter_mut().enumerate() {
                let other = &like.cell(row, column).formula;
                assert_eq!(cell.formula.is_some(), other.is_some());
                cell.formula.clone_from(other);
            }
        }
        grid
    }

    #[test]
    fn figures_have_the_value_that_is_held_and_the_name_that_is_shown() {
        for (_, bytes) in &BOOKS[..2] {
            let grid = grids(bytes).unwrap().remove(0);
            let figure = grid.cell(10, 6).figure().unwrap();
            assert_eq!((figure.as_read(), figure.read().digits), ("0.09", 1));
            assert!((figure.value - 0.085_322_916).abs() < 1e-9);
            assert_eq!(grid.cell(5, 6).text, "0.030");
        }
    }

    /// A style far from the budget is painted, and kept nowhere.
    #[test]
    fn painted_cells_span_nothing() {
        let far = calamine::Cell::new((1_048_575, 16_383), DataRef::Empty);
        let near = calamine::Cell::new((3, 4), DataRef::Float(1.0));
        let spans = |cells: &[&calamine::Cell<DataRef<'_>>]| {
            let mut cells = cells.iter();
            spans_few(|| told(cells.next()?), "Budget")
        };
        assert!(spans(&[&near, &far]).is_ok());
        let far = calamine::Cell::new((1_048_575, 16_383), DataRef::Float(1.0));
        assert!(spans(&[&near, &far]).is_err());
    }

    /// A few bytes that would be milliards of cells.
    #[test]
    fn repeated_cells_are_counted_before_they_are_kept() {
        let cell = |rows: u32, columns: u32| {
            let content = format!(
                r#"<office:document-content xmlns:office="o" xmlns:table="t" xmlns:text="x"><office:body><office:spreadsheet>
                <table:table table:name="Budget"><table:table-row table:number-rows-repeated="{rows}"><table:table-cell
                table:number-columns-repeated="{columns}" office:value-type="float" office:value="1"><text:p>1</text:p></table:table-cell>
                </table:table-row></table:table></office:spreadsheet></office:body></office:document-content>"#
            );
            let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
            archive
                .start_file("content.xml", SimpleFileOptions::default())
                .unwrap();
            archive.write_all(content.as_bytes()).unwrap();
            open_document::told(&archive.finish().unwrap().into_inner())
        };
        let why = cell(1_048_576, 16_384).unwrap_err().0.to_string();
        assert!(
            why.contains("\"Budget\" spans more than 1048576 cells"),
            "{why}"
        );
        assert!(cell(100, 100).is_ok());
    }
}
