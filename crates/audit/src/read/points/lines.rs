//! A row for each point: standard uncertainties of the sources side by side, and u_c or U behind them.

use crate::read::columns::{Role, apart, role};
use crate::read::footer::{self, Whole};
use crate::sheet::{Cell, Grid, Head};

use super::{names_points, rows_below};

/// A column of the table.
struct Column {
    index: usize,
    name: String,
    unit: String,
    /// Which figure of the whole it holds; nothing for a source.
    whole: Option<Whole>,
    /// Whether its head says that its figures are standard uncertainties.
    is_said: bool,
}

/// The sheet with one table, the usual way round, for each of the rows below these heads.
pub(super) fn parted(grid: &Grid, head: usize) -> Option<Vec<Grid>> {
    let mut heads = grid.filled(head);
    let (point, cell) = heads.next()?;
    let (_, point_unit) = apart(&cell.text);
    let columns: Vec<Column> = heads
        .map(|(index, cell)| column(index, &cell.text))
        .collect::<Option<_>>()?;
    let (sources, whole): (Vec<&Column>, Vec<&Column>) =
        columns.iter().partition(|column| column.whole.is_none());
    let unit = &sources.first()?.unit;
    let one_unit = sources.iter().all(|source| source.unit == *unit);
    // Asked before the rows are read: each line of a long recording would else be held against all that follow it.
    if sources.len() < 2 || !one_unit || whole.is_empty() {
        return None;
    }
    let rows = rows_below(grid, head);
    // Where the heads do not say what the figures are, sums do, of which one alone may be chance.
    let are_said = names_points(&cell.text) && sources.iter().all(|source| source.is_said);
    let fits = |row: &&usize| match are_said {
        true => is_complete(grid, **row, &sources),
        false => is_sum(grid, **row, &sources, &whole),
    };
    let fewest = if are_said { 1 } else { 2 };
    let met = rows.iter().filter(fits).count();
    if met < fewest || 2 * met <= rows.len() {
        return None;
    }
    let part = |row: &usize| {
        let mut part = Grid {
            name: grid.name.clone(),
            rows: grid.rows[..head].to_vec(),
            point: format!("{} {point_unit}", grid.cell(*row, point).text)
                .trim()
                .to_owned(),
            ..Grid::default()
        };
        let own = sources.iter().map(|column| Head {
            row: head,
            column: column.index,
            text: grid.cell(head, column.index).text.clone(),
            role: Role::U.name(),
        });
        part.heads.insert(head, own.collect());
        part.rows
            .push(["Source", "Unit", "u_i"].map(Cell::new).to_vec());
        for column in sources.iter().chain(&whole) {
            let (named, unit) = match column.whole {
                Some(_) => (grid.cell(head, column.index).clone(), Cell::default()),
                None => (Cell::new(&column.name), Cell::new(&column.unit)),
            };
            let at = part.rows.len();
            part.origins.insert((at, 0), (head, column.index));
            part.origins.insert((at, 2), (*row, column.index));
            let figure = grid.cell(*row, column.index).clone();
            part.rows.push(vec![named, unit, figure]);
        }
        part
    };
    Some(rows.iter().map(part).collect())
}

/// A column of a source or of the whole; nothing for one of anything else.
fn column(index: usize, head: &str) -> Option<Column> {
    let (name, unit) = apart(head);
    let whole = footer::label(head, "").filter(|whole| *whole != Whole::Y);
    let is_u = name.starts_with(['u', 'U'])
        && name
            .chars()
            .nth(1)
            .is_some_and(|c| "_(0123456789 ".contains(c));
    let role = role(head).map(|(role, _)| role);
    let is_said = is_u || role == Some(Role::U);
    // The name of a source alone: what its figures are, the sums show.
    let is_name = matches!(role, None | Some(Role::Name | Role::Remark));
    (whole.is_some() || is_said || is_name).then_some(Column {
        index,
        name,
        unit,
        whole,
        is_said,
    })
}

/// Whether a row has a figure of each source.
fn is_complete(grid: &Grid, row: usize, sources: &[&Column]) -> bool {
    let mut cells = sources.iter().map(|source| grid.cell(row, source.index));
    cells.all(|cell| cell.figure().is_some())
}

/// Whether u_c, or U over its k, is the root of the sum of squares of the sources.
fn is_sum(grid: &Grid, row: usize, sources: &[&Column], whole: &[&Column]) -> bool {
    let figure = |column: &Column| grid.cell(row, column.index).figure();
    let of = |wanted: Whole| {
        let column = whole.iter().find(|column| column.whole == Some(wanted))?;
        figure(column)
    };
    let k = of(Whole::Factor).map_or(2.0, |k| k.value);
    let u_c = of(Whole::Combined).map(|u_c| (u_c.value, u_c.half));
    let u_c = u_c.or_else(|| of(Whole::Expanded).map(|u| (u.value / k, u.half / k)));
    let squares = sources
        .iter()
        .map(|source| figure(source).map(|u| u.value * u.value));
    let sum: Option<f64> = squares.sum();
    u_c.zip(sum)
        .is_some_and(|((u_c, half), sum)| (libm::sqrt(sum) - u_c).abs() <= half + 0.02 * u_c)
}
