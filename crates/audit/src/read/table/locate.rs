//! Where a table stands, and which rows of the sheet are its rows.

use std::collections::BTreeSet;

use crate::printed::Printed;
use crate::read::columns::{self, Role};
use crate::read::footer;
use crate::read::mapping::Mapping;
use crate::read::words::has;
use crate::sheet::Grid;
use crate::units;

use super::content::{by_content, nameless_figures, with_coefficient};
use super::head::{head, is_matrix, line_above, second_line};
use super::labels;
use super::located::Located;
use super::pages::joined;
use super::relative_columns::take_relative;
use super::sources;

/// Every table of a sheet that is a budget.
pub fn locate(grid: &Grid, mapping: &Mapping) -> Vec<Located> {
    let mut found: Vec<Located> = Vec::new();
    let mut row = 0;
    while row < grid.rows.len() {
        match head(grid, row, mapping) {
            Some(columns) => {
                let mut located = Located {
                    head: row,
                    end: row + 1,
                    columns,
                    unit: String::new(),
                    rows: Vec::new(),
                    used: BTreeSet::from([row]),
                };
                line_above(grid, &mut located);
                second_line(grid, &mut located, mapping);
                body(grid, &mut located, mapping);
                row = located.end.max(row + 1);
                by_content(grid, &mut located);
                nameless_figures(grid, &mut located);
                with_coefficient(grid, &mut located);
                take_relative(grid, &mut located);
                if !located.rows.is_empty() {
                    let unit = located.unit(Role::Contribution);
                    let is_power = units::power_of_ten(unit).is_some();
                    located.unit = if is_power { "" } else { unit }.to_string();
                    found.push(located);
                }
            }
            None => row += 1,
        }
    }
    joined(grid, found)
}

fn body(grid: &Grid, located: &mut Located, mapping: &Mapping) {
    /// Lines of other kinds that may stand between the rows of one table: a blank one, a subheading.
    const STRANGE: usize = 3;
    let mut strange = 0;
    // Below U and a line of words another table begins.
    let (mut has_expanded, mut is_over) = (false, false);
    let mut is_summed = false;
    for row in (located.end..grid.rows.len()).filter(|row| !grid.left_out.contains(row)) {
        // A row with the symbol A and a unit may look like a head.
        let repeated = figures(grid, row, located) == 0 && head(grid, row, mapping).is_some();
        if repeated || is_matrix(grid, row) || labels::are_across(grid, row, "") {
            break;
        }
        let what = match what(grid, row, located, strange == 0) {
            What::Footer if sources::is_source(grid, row, located) => What::Row,
            What::Row if sources::is_total(grid, row, located) => What::Footer,
            What::Row if is_summed && sources::lacks_inputs(grid, row, located) => What::Footer,
            what => what,
        };
        match what {
            What::Row if is_over => break,
            What::Row => {
                located.rows.push(row);
                located.used.insert(row);
            }
            What::Footer => {
                has_expanded |= !located.rows.is_empty() && states_expanded(grid, row);
                is_summed |= !located.rows.is_empty() && sources::is_sum(grid, row);
            }
            What::Other => {
                is_over |= has_expanded && grid.filled(row).next().is_some();
                strange += 1;
                if strange > STRANGE {
                    break;
                }
                continue;
            }
        }
        strange = 0;
        located.end = row + 1;
    }
}

/// Whether a row states the expanded uncertainty of the whole.
fn states_expanded(grid: &Grid, row: usize) -> bool {
    let mut cells = grid.filled(row);
    cells.any(|(_, cell)| footer::label(&cell.text, "") == Some(footer::Whole::Expanded))
}

/// How many of the columns of figures hold one in a row.
fn figures(grid: &Grid, row: usize, located: &Located) -> usize {
    let is_figure = |role: &&Role| {
        let column = located.column(**role).filter(|_| role.is_figure());
        column.is_some_and(|c| Printed::parse(&grid.cell(row, c.index).text).is_some())
    };
    Role::ALL.iter().filter(is_figure).count()
}

/// Whether a text is the symbol of a figure of the whole: `u_c / N`, `U (k = 2)`. A `U / V` may be a voltage, and a `k / (N/m)`
/// a stiffness; u_c has the unit of the result.
fn is_symbol_of_whole(label: &str) -> bool {
    let condition = label.split_once('(').filter(|(_, rest)| rest.contains('='));
    let name = condition.map_or(label, |(name, _)| name).trim();
    let combined = columns::apart(name).0;
    matches!(combined.as_str(), "u_c" | "uc" | "u(c)" | "u_c(y)")
        || matches!(name, "U" | "k" | "ν_eff" | "νeff")
}

enum What {
    Row,
    Footer,
    Other,
}

/// What a row of the sheet is; `joined` to the rows above it without a gap.
fn what(grid: &Grid, row: usize, located: &Located, joined: bool) -> What {
    let text = |role: Role| {
        located
            .column(role)
            .map_or("", |c| grid.cell(row, c.index).text.as_str())
    };
    let figure = |role: Role| Printed::parse(text(role)).is_some();
    let named = !text(Role::Symbol).is_empty() || !text(Role::Name).is_empty();
    let count = figures(grid, row, located);
    // Words about a row, its figures, their unit (K) and its distribution label nothing.
    let labels = |column: usize| {
        use Role::{Distribution, Remark, Unit, Used, Value};
        let role = located.columns.iter().find(|c| c.index == column);
        role.is_none_or(|c| !matches!(c.role, Remark | Value | Used | Unit | Distribution))
    };
    let first = grid.filled(row).next().map_or(0, |(column, _)| column);
    let labelled = grid.filled(row).take(3).any(|(column, cell)| {
        (column == first || labels(column))
            && footer::label(&cell.text, "").is_some()
            && Printed::parse(&cell.text).is_none()
    });
    let called = [Role::Symbol, Role::Name, Role::Number].map(text);
    let inputs = figure(Role::Used) || figure(Role::C);
    let explained = !text(Role::Distribution).is_empty()
        && !text(Role::Distribution).to_lowercase().contains("k")
        || text(Role::Type).len() == 1;
    // A row with the inputs of a source, and a name that says nothing of the whole, may have any letter for its symbol.
    let is_named = !text(Role::Name).is_empty() && footer::label(text(Role::Name), "").is_none();
    let is_quantity =
        |symbol: &str| symbol.chars().count() == 1 && is_named && (inputs || explained);
    let strong = called.iter().any(|t| {
        let lower = t.to_lowercase();
        has(
            &lower,
            &[
                "combined",
                "kombinierte",
                "composée",
                "élargie",
                "expanded uncertainty u",
                "effective degrees",
                "coverage factor",
                "合成标准不确定度",
                "合成不确定度",
                "有效自由度",
                "包含因子",
            ],
        ) || lower.starts_with("expanded u")
            || lower.starts_with("erweiterte")
            || lower.starts_with("sum u(")
            || lower.starts_with("扩展不确定度")
            || is_symbol_of_whole(t) && !is_quantity(t)
    });
    // Of `Expanded uncertainty | k = | 2 | 0.6` the factor stands where the others have a coefficient.
    let factor = located.column(Role::C).is_some_and(|c| {
        let in_front = grid.filled(row).filter(|(column, _)| *column < c.index);
        let label = in_front.last().map(|(_, cell)| cell.text.as_str());
        label.and_then(|text| footer::label(text, "")) == Some(footer::Whole::Factor)
    });
    let coefficient = figure(Role::C) && !factor;
    // A voltage U, or a scale factor K, with its estimate and what that is known to is the result, and no figure of the whole.
    let made = figure(Role::Contribution) || figure(Role::U);
    let is_letter = called.iter().any(|name| matches!(*name, "U" | "K"));
    if is_letter && figure(Role::Value) && made {
        return What::Row;
    }
    let is_subtotal = called.iter().any(|text| footer::is_subtotal(text));
    if is_subtotal || labelled && (strong && !coefficient || !inputs && !explained) {
        return What::Footer;
    }
    let told = joined && !text(Role::Remark).is_empty() && grid.filled(row).count() >= 2;
    if named && (count >= if joined { 1 } else { 2 } || told) {
        return What::Row;
    }
    // A merged cell: the name stands above.
    if !named && count >= 3 && !located.rows.is_empty() {
        return What::Row;
    }
    What::Other
}
