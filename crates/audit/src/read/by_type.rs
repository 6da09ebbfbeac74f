//! Tables with a column of figures for each type of evaluation: `Type A (µm) | Type B (µm)`.

use crate::printed::Printed;
use crate::sheet::{Cell, Grid, Head};

use super::columns::{self, Role};
use super::footer::{self, Whole};
use super::words::compact;

/// The sheet with these figures in one column, and beside each of which type it is; as it is where no head has both.
pub fn joined(grid: &Grid) -> Grid {
    let found = (0..grid.rows.len()).find_map(|head| Some((head, Types::of(grid, head)?)));
    found.map_or_else(|| grid.clone(), |(head, types)| types.joined(grid, head))
}

/// The columns of the two types, and the head of the one that they make.
struct Types {
    columns: [usize; 2],
    head: String,
}

/// What the types are called in a column of their own.
const NAMES: [&str; 2] = ["A", "B"];

impl Types {
    fn of(grid: &Grid, head: usize) -> Option<Types> {
        let column = |name: &str| {
            let mut of_type = grid
                .filled(head)
                .filter(|(_, cell)| is_of_type(&cell.text, name));
            let first = of_type.next()?;
            of_type.next().is_none().then_some(first)
        };
        let (a, b) = (column("a")?, column("b")?);
        let units = [a, b].map(|(_, cell)| columns::apart(&cell.text).1);
        let types = Types {
            columns: [a.0, b.0],
            head: head_of_both(grid, head, [a.0, b.0], &units[0]),
        };
        let parted = types.rows(grid, head);
        let parted = parted.filter(|row| types.figures(grid, *row).len() == 1);
        (units[0] == units[1] && parted.count() >= 2).then_some(types)
    }

    /// The rows of the table: up to a blank one.
    fn rows<'g>(&self, grid: &'g Grid, head: usize) -> impl Iterator<Item = usize> + use<'g> {
        (head + 1..grid.rows.len()).take_while(|row| grid.filled(*row).next().is_some())
    }

    /// The figures of a row, each with its type.
    fn figures<'g>(&self, grid: &'g Grid, row: usize) -> Vec<(usize, &'g Cell)> {
        let cells = self.columns.map(|column| grid.cell(row, column));
        let figures = cells.into_iter().enumerate();
        figures
            .filter(|(_, cell)| cell.figure().is_some())
            .collect()
    }

    fn joined(&self, grid: &Grid, head: usize) -> Grid {
        let mut made = Grid {
            rows: Vec::new(),
            ..grid.clone()
        };
        made.origins.clear();
        let end = self.rows(grid, head).last().map_or(head, |row| row + 1);
        let mut squares = [0.0; 2];
        for row in 0..grid.rows.len() {
            let figures = match (head + 1..end).contains(&row) {
                true => self.figures(grid, row),
                false => Vec::new(),
            };
            match figures.as_slice() {
                [] => self.push(&mut made, grid, row, None),
                // What each type comes to is no figure of the whole.
                [_, _] if is_of_whole(grid, row) || self.are_roots(grid, row, squares) => {
                    self.push(&mut made, grid, row, Some(None));
                }
                all => {
                    for (of_type, cell) in all {
                        let figure = cell.figure().map_or(0.0, |figure| figure.value);
                        squares[*of_type] += figure * figure;
                        self.push(&mut made, grid, row, Some(Some(*of_type)));
                    }
                }
            }
            if row == head
                && let Some(cells) = made.rows.last_mut()
            {
                cells[self.columns[0]] = Cell::new(&self.head);
                cells[self.columns[1]] = Cell::new("Type");
                let at = made.rows.len() - 1;
                made.heads.insert(at, self.heads(grid, head));
            }
        }
        made
    }

    /// The heads of the sheet itself, and as what they are taken.
    fn heads(&self, grid: &Grid, head: usize) -> Vec<Head> {
        let joined = columns::role(&self.head).map_or("?", |(role, _)| role.name());
        let role = |column: usize, text: &str| match self.columns.contains(&column) {
            true => joined,
            false => columns::role(text).map_or("?", |(role, _)| role.name()),
        };
        let heads = grid.filled(head).map(|(column, cell)| Head {
            row: head,
            column,
            text: cell.text.clone(),
            role: role(column, &cell.text),
        });
        heads.collect()
    }

    /// Whether the figures of a row are what both types above it come to.
    fn are_roots(&self, grid: &Grid, row: usize, squares: [f64; 2]) -> bool {
        let mut figures = self.figures(grid, row).into_iter();
        figures.all(|(of_type, cell)| {
            let root = libm::sqrt(squares[of_type]);
            let is_root = |figure: Printed| figure.is_met_within(root, 2.0 * figure.half);
            root > 0.0 && cell.figure().is_some_and(is_root)
        })
    }

    /// Adds a row of the sheet: as it is, or with the figure of one type, or of none.
    fn push(&self, made: &mut Grid, grid: &Grid, row: usize, of_type: Option<Option<usize>>) {
        let at = made.rows.len();
        let mut cells = grid.rows[row].clone();
        let origin = |column| {
            let place = crate::printed::Place {
                sheet: 0,
                row,
                column,
            };
            let origin = grid.origin(place);
            (origin.row, origin.column)
        };
        made.origins
            .extend((0..cells.len()).map(|column| ((at, column), origin(column))));
        if let Some(of_type) = of_type {
            let [first, second] = self.columns;
            let needed = first.max(second) + 1;
            cells.resize(cells.len().max(needed), Cell::default());
            let figure = of_type.map(|of_type| self.columns[of_type]);
            cells[first] =
                figure.map_or_else(Cell::default, |column| grid.cell(row, column).clone());
            let is_source = of_type.filter(|_| !is_of_whole(grid, row));
            cells[second] =
                is_source.map_or_else(Cell::default, |of_type| Cell::new(NAMES[of_type]));
            if let Some(column) = figure {
                made.origins.insert((at, first), origin(column));
            }
        }
        made.rows.push(cells);
    }
}

/// Whether a row is labelled as what its column comes to.
fn is_of_whole(grid: &Grid, row: usize) -> bool {
    let mut cells = grid.filled(row);
    cells.any(|(_, cell)| {
        let is_whole = matches!(
            footer::label(&cell.text, ""),
            Some(Whole::Combined | Whole::Expanded)
        );
        is_whole || footer::is_subtotal(&cell.text)
    })
}

/// What the figures of both types are: standard uncertainties, where their heads say so; else what was divided, where a divisor
/// or what it gave stands in a column of its own.
fn head_of_both(grid: &Grid, head: usize, own: [usize; 2], unit: &str) -> String {
    let says_u = |column: usize| {
        let role = columns::role(&grid.cell(head, column).text);
        role.is_some_and(|(role, _)| role == Role::U)
    };
    let holds_figures = |column: usize| grid.cell(head + 1, column).figure().is_some();
    let figures = grid
        .filled(head)
        .filter(|(column, _)| holds_figures(*column) && !own.contains(column));
    let mut roles = figures.filter_map(|(_, cell)| Some(columns::role(&cell.text)?.0));
    let divided = roles.any(|role| matches!(role, Role::Divisor | Role::U | Role::Contribution));
    let name = match divided && !own.into_iter().all(says_u) {
        true => "Value ±",
        false => "u(x_i)",
    };
    match unit {
        "" => name.to_owned(),
        unit => format!("{name} ({unit})"),
    }
}

/// Whether a head is of one type of evaluation and not of both: `Type A (µm)`, `A类 u/µm`, `u_A`.
fn is_of_type(head: &str, name: &str) -> bool {
    let text = compact(&columns::apart(head).0);
    let says = |name: &str| {
        [
            format!("type{name}"),
            format!("type-{name}"),
            format!("typ{name}"),
            format!("{name}类"),
        ]
        .iter()
        .any(|word| text.contains(word))
            || text == format!("u{name}")
    };
    let other = if name == "a" { "b" } else { "a" };
    let of_both = ["a/b", "aorb", "a,b", "或"]
        .iter()
        .any(|both| text.contains(both));
    says(name) && !says(other) && !of_both
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_with_both_types_is_two() {
        let joined = joined(&Grid::of_rows(&[
            "Source|Type A (µm)|Type B (µm)",
            "Repeatability|0.3|",
            "Block||0.2",
            "Setting|0.1|0.4",
            "Root sum of squares|0.32|0.45",
            "",
            "Combined||0.55",
        ]));
        let rows: Vec<Vec<&str>> = joined
            .rows
            .iter()
            .map(|row| row.iter().map(|cell| cell.text.as_str()).collect())
            .collect();
        assert_eq!(rows[0], ["Source", "u(x_i) (µm)", "Type"]);
        assert_eq!(rows[1], ["Repeatability", "0.3", "A"]);
        assert_eq!(rows[2], ["Block", "0.2", "B"]);
        assert_eq!(rows[3], ["Setting", "0.1", "A"]);
        assert_eq!(rows[4], ["Setting", "0.4", "B"]);
        assert_eq!(rows[5], ["Root sum of squares", "", ""]);
        assert_eq!(rows[7], ["Combined", "", "0.55"]);
        assert_eq!(joined.origins.get(&(4, 1)), Some(&(3, 2)));
    }

    #[test]
    fn a_column_of_both_types_stays() {
        let sheet = Grid::of_rows(&["Source|Type A/B|u", "a|A|0.1", "b|B|0.2"]);
        assert_eq!(joined(&sheet).rows, sheet.rows);
    }
}
