//! A table that was found: its head, its columns and its rows on the sheet.

use std::collections::BTreeSet;

use crate::claim::Understood;
use crate::printed::Place;
use crate::read::columns::{self, Role};
use crate::sheet::{Cell, Grid, Head};

/// A table that was found.
#[derive(Debug, Clone)]
pub struct Located {
    /// Row of its head.
    pub head: usize,
    /// Behind its last row.
    pub end: usize,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Unit of the contributions, where the head has one.
    pub unit: String,
    /// Rows of the sheet that are rows of the budget.
    pub(super) rows: Vec<usize>,
    /// Rows that are the head, a row of the budget or its footer.
    pub(super) used: BTreeSet<usize>,
}

/// A column that was understood.
#[derive(Debug, Clone)]
pub struct Column {
    pub(super) index: usize,
    pub(super) role: Role,
    pub(super) head: String,
    pub(super) unit: String,
}

impl Located {
    /// The place of a table on a sheet that has none: below everything.
    pub(super) fn below(grid: &Grid) -> Self {
        Located {
            head: grid.rows.len(),
            end: 0,
            columns: Vec::new(),
            unit: String::new(),
            rows: Vec::new(),
            used: BTreeSet::new(),
        }
    }

    /// Whether figures of which the head says no more than `u_i` stand where contributions would, and nothing else tells
    /// what they were made of.
    pub fn has_bare_u_behind_c(&self) -> bool {
        let is_bare = self
            .column(Role::Contribution)
            .is_some_and(|c| columns::is_bare_u(&c.head));
        is_bare && self.has(Role::C) && !self.has(Role::U) && !self.has(Role::Divisor)
    }

    /// The head of the column of figures where it says no more than `Uncertainty`, and no other column says what they are
    /// or were divided by.
    pub fn open_uncertainty(&self) -> Option<&str> {
        let used = self.column(Role::Used)?;
        let told = [
            Role::U,
            Role::Contribution,
            Role::Divisor,
            Role::Distribution,
        ];
        let is_told = told.into_iter().any(|role| self.has(role));
        (!is_told && columns::is_bare_uncertainty(&used.head)).then_some(&used.head)
    }

    /// Rows that are no text beside the table.
    pub fn is_used(&self, row: usize) -> bool {
        self.used.contains(&row)
    }

    /// What stands in the rows of the table behind its last column.
    pub fn beside(&self, grid: &Grid) -> Grid {
        // Labels beside a table stand below no head.
        let headed = self.columns.iter().filter(|c| !c.head.is_empty());
        let last = headed.map(|column| column.index).max();
        let is_beside = |row: usize, column: usize| {
            let of_table = row == self.head || self.is_row(row);
            of_table && last.is_some_and(|last| column > last)
        };
        let rows = grid.rows.iter().enumerate().map(|(row, cells)| {
            let cells = cells.iter().enumerate();
            let kept = cells.map(|(column, cell)| match is_beside(row, column) {
                true => cell.clone(),
                false => Cell::default(),
            });
            kept.collect()
        });
        Grid {
            rows: rows.collect(),
            ..Grid::default()
        }
    }

    /// Whether a row of the sheet stands between rows of the budget.
    pub fn is_inside(&self, row: usize) -> bool {
        let last = self.rows.last().copied().unwrap_or(0);
        (self.head + 1..last).contains(&row)
    }

    /// Whether a row of the sheet is a row of the budget.
    pub fn is_row(&self, row: usize) -> bool {
        self.rows.contains(&row)
    }

    /// How its columns were understood.
    pub fn understood(&self, grid: &Grid, sheet: usize) -> Vec<Understood> {
        if let Some(heads) = grid.heads.get(&self.head) {
            let understood = |head: &Head| Understood {
                at: Place {
                    sheet,
                    row: head.row,
                    column: head.column,
                },
                text: head.text.clone(),
                role: head.role,
            };
            return heads.iter().map(understood).collect();
        }
        let place = |column: usize| Place {
            sheet,
            row: self.head,
            column,
        };
        let known = self.columns.iter().map(|c| Understood {
            at: place(c.index),
            text: c.head.clone(),
            role: c.role.name(),
        });
        let unknown = grid
            .filled(self.head)
            .filter(|(i, _)| !self.columns.iter().any(|c| c.index == *i));
        let unknown = unknown.map(|(i, cell)| Understood {
            at: place(i),
            text: cell.text.clone(),
            role: "?",
        });
        known.chain(unknown).collect()
    }

    /// The unit of a figure of the table: its own, that of the head of its column, or that of the column of units.
    pub(super) fn unit_in(&self, grid: &Grid, row: usize, index: usize) -> String {
        let own = grid.cell(row, index).figure().map(|figure| figure.unit);
        let column = self.columns.iter().find(|column| column.index == index);
        let of_head = column.map(|column| column.unit.clone());
        let of_row = self
            .column(Role::Unit)
            .map(|unit| grid.cell(row, unit.index));
        let of_row = of_row.map(|cell| cell.text.trim().to_string());
        let mut units = [own, of_head, of_row].into_iter().flatten();
        units.find(|unit| !unit.is_empty()).unwrap_or_default()
    }

    pub(super) fn column(&self, role: Role) -> Option<&Column> {
        self.columns.iter().find(|column| column.role == role)
    }

    /// Whether it has figures that were computed for each row.
    pub fn is_evaluated(&self) -> bool {
        self.has(Role::U) || self.has(Role::Contribution)
    }

    /// Whether it has a column of what its rows contribute.
    pub fn has_contributions(&self) -> bool {
        self.has(Role::Contribution)
    }

    /// Whether it has u of its rows, and nothing of how they were found or of what they make.
    pub fn is_list(&self) -> bool {
        let made = [
            Role::Used,
            Role::Divisor,
            Role::Distribution,
            Role::Contribution,
        ];
        self.has(Role::U) && !made.into_iter().any(|role| self.has(role))
    }

    pub(super) fn has(&self, role: Role) -> bool {
        self.column(role).is_some()
    }

    pub(super) fn unit(&self, role: Role) -> &str {
        self.column(role).map_or("", |column| &column.unit)
    }
}
