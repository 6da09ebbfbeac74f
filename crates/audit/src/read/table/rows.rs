//! The rows of a table with their figures.

use crate::claim::{Figure, Row};
use crate::printed::{Place, Printed};
use crate::read::columns::Role;
use crate::read::words::has;
use crate::sheet::Grid;
use crate::units;

use super::located::Located;

/// A row with what is needed to interpret it.
#[derive(Debug, Clone)]
pub struct Raw {
    /// Its figures.
    pub row: Row,
    pub(super) columns_text: String,
    pub(super) used_head: String,
    pub(super) readings: Option<f64>,
    /// The ± column stands in a table of what is known, apart from the evaluation.
    pub(super) stated_apart: bool,
}

/// The rows of a table with their figures.
pub fn rows(grid: &Grid, sheet: usize, located: &Located) -> Vec<Raw> {
    let mut above = String::new();
    let mut rows: Vec<Raw> = located
        .rows
        .iter()
        .map(|&row| {
            let raw = raw(grid, sheet, row, located, &above);
            if !raw.row.name.is_empty() {
                above.clone_from(&raw.row.name);
            }
            raw
        })
        .collect();
    let columns: [fn(&mut Row) -> &mut Option<Printed>; 3] = [
        |row| &mut row.used,
        |row| &mut row.u,
        |row| &mut row.contribution,
    ];
    for column in columns {
        zeros_are_digits(
            rows.iter_mut()
                .filter_map(|raw| column(&mut raw.row).as_mut())
                .collect(),
        );
    }
    rows
}

/// The zeros of `100` are digits as far as the other figures of its column show some.
fn zeros_are_digits(column: Vec<&mut Printed>) {
    let most = column.iter().map(|figure| figure.digits).max().unwrap_or(0);
    for figure in column
        .into_iter()
        .filter(|figure| figure.half == 0.5 && figure.digits > 0)
    {
        let places = libm::floor(libm::log10(figure.value.abs())) as usize + 1;
        figure.digits = figure.digits.max(most.min(places));
    }
}

fn raw(grid: &Grid, sheet: usize, row: usize, located: &Located, above: &str) -> Raw {
    let text = |role: Role| -> String {
        let cells = located
            .columns
            .iter()
            .filter(|c| c.role == role)
            .map(|c| grid.cell(row, c.index).text.as_str());
        let cells: Vec<&str> = cells.filter(|text| !text.is_empty()).collect();
        cells.join("; ")
    };
    let unit_cell = text(Role::Unit);
    let figure = |role: Role| -> Option<Printed> {
        let column = located.column(role)?;
        let cell = grid.cell(row, column.index);
        let mut figure = cell.figure()?.at(Place {
            sheet,
            row,
            column: column.index,
        });
        if figure.unit.is_empty() {
            figure.unit.clone_from(&column.unit);
        }
        if figure.unit.is_empty() && matches!(role, Role::Value | Role::Used | Role::U) {
            figure.unit = unit_cell
                .split(';')
                .next()
                .unwrap_or_default()
                .trim()
                .to_string();
        }
        if units::parse(&figure.unit).is_none() && !matches!(role, Role::C) {
            figure.unit.clear();
        }
        Some(figure)
    };
    let formula = |role: Role, which: Figure| {
        let column = located.column(role)?;
        grid.cell(row, column.index)
            .formula
            .clone()
            .map(|formula| (which, formula))
    };
    let symbol = text(Role::Symbol);
    let mut name = text(Role::Name);
    if name.is_empty() && symbol.is_empty() {
        name = above.to_string();
    }
    // `Mass of the standard m_S` in a column of quantities is a name.
    let (symbol, name) = if name.is_empty() && (symbol.contains(' ') || symbol.chars().count() > 12)
    {
        (String::new(), symbol)
    } else {
        (symbol, name)
    };
    let used_text = located
        .column(Role::Used)
        .map_or("", |c| grid.cell(row, c.index).text.as_str());
    // `0.0060 (s of 10 readings, mean reported)`: figure and what it is.
    let bracketed = crate::printed::leading(used_text)
        .filter(|(_, behind)| behind.trim_start().starts_with('('));
    let remark_of_used = match &bracketed {
        Some((_, behind)) if units::parse(behind.trim().trim_matches(['(', ')'])).is_none() => {
            *behind
        }
        _ if Printed::parse(used_text).is_none() => used_text,
        _ => "",
    };
    let used = figure(Role::Used).or_else(|| {
        let column = located.column(Role::Used)?.index;
        let (figure, _) = bracketed.clone()?;
        let unit = unit_cell
            .split(';')
            .next()
            .unwrap_or_default()
            .trim()
            .to_string();
        Some(Printed { unit, ..figure }.at(Place { sheet, row, column }))
    });
    let words = [name.as_str(), &text(Role::Remark), remark_of_used]
        .iter()
        .filter(|t| !t.is_empty())
        .copied()
        .collect::<Vec<_>>()
        .join("; ");
    let words = if name.is_empty() {
        [symbol.as_str(), &words].join("; ")
    } else {
        words
    };
    Raw {
        columns_text: [text(Role::Distribution), text(Role::Type)].join(" ; "),
        used_head: located
            .column(Role::Used)
            .map(|c| c.head.clone())
            .unwrap_or_default(),
        readings: figure(Role::Readings).map(|n| n.value),
        stated_apart: false,
        row: Row {
            at: Place {
                sheet,
                row,
                column: grid.filled(row).next().map_or(0, |(i, _)| i),
            },
            value: figure(Role::Value),
            used: used.map(positive),
            divisor: figure(Role::Divisor),
            u: figure(Role::U).map(positive),
            c: figure(Role::C),
            contribution: figure(Role::Contribution),
            dof: figure(Role::Dof),
            unit: unit_cell,
            is_hidden: grid.hidden_rows.contains(&row),
            distribution: text(Role::Distribution),
            share: share(grid, row, located),
            formulas: [
                formula(Role::U, Figure::U),
                formula(Role::Contribution, Figure::Contribution),
            ]
            .into_iter()
            .flatten()
            .collect(),
            symbol,
            name,
            words,
            ..Row::default()
        },
    }
}

/// The share of a row in the variance, where a column has it.
fn share(grid: &Grid, row: usize, located: &Located) -> Option<Printed> {
    let is_share = |head: &str| {
        let head = head.to_lowercase();
        has(&head, &["share", "index", "percent"])
            || head.contains(['%', '％'])
            || has(&head, &["贡献率", "占比", "百分比"])
    };
    let mut columns = located.columns.iter();
    let column = columns.find(|c| c.role == Role::Derived && is_share(&c.head))?;
    Printed::parse(&grid.cell(row, column.index).text)
}

pub(super) fn positive(mut figure: Printed) -> Printed {
    figure.value = figure.value.abs();
    figure
}

impl Raw {
    /// A row that is told in words alone.
    pub fn told(row: Row) -> Raw {
        Raw {
            row,
            columns_text: String::new(),
            used_head: String::new(),
            readings: None,
            stated_apart: true,
        }
    }

    /// Whether both are about one quantity.
    pub fn is_of(&self, other: &Raw) -> bool {
        let same = |a: &str, b: &str| !a.is_empty() && a == b;
        same(&self.row.symbol, &other.row.symbol)
            || (self.row.symbol.is_empty() || other.row.symbol.is_empty())
                && same(&self.row.name, &other.row.name)
    }

    /// Takes over what a table of what is known says of the quantity.
    pub fn absorb(&mut self, input: &Raw) {
        let (row, known) = (&mut self.row, &input.row);
        row.value = row.value.take().or_else(|| known.value.clone());
        row.divisor = row.divisor.take().or_else(|| known.divisor.clone());
        if row.used.is_none() && known.used.is_some() {
            row.used.clone_from(&known.used);
            self.used_head.clone_from(&input.used_head);
            self.stated_apart = true;
        }
        for (own, other) in [(&mut row.name, &known.name), (&mut row.unit, &known.unit)] {
            if own.is_empty() {
                own.clone_from(other);
            }
        }
        row.words.push_str("; ");
        row.words.push_str(&known.words);
        self.readings = self.readings.or(input.readings);
        if self.columns_text.trim() == ";" {
            self.columns_text.clone_from(&input.columns_text);
        }
    }

    /// Whether the row is that of the result: its name, or nothing that an input has.
    pub fn is_result(&self, measurand: &str, is_last: bool) -> bool {
        let row = &self.row;
        let named = !measurand.is_empty() && row.symbol == measurand;
        let input = row.used.is_some() || row.c.is_some() || row.divisor.is_some();
        let y = matches!(row.symbol.as_str(), "y" | "Y")
            || has(
                &row.name.to_lowercase(),
                &["result", "measurand", "结果", "被测量"],
            );
        // The last row has what no input lacks, and nothing of what an input has.
        let closing =
            is_last && row.contribution.is_some() && row.u.is_none() && row.value.is_some();
        (named || y || closing)
            && !input
            && (row.contribution.is_some() || row.u.is_some() || row.value.is_some())
    }
}
