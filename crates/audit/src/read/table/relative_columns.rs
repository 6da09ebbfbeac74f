//! Budgets of a product in relative figures, with the absolute ones beside them: `Value | u(x) | u_rel (%) | Exponent | Contribution (%)`.

use crate::printed::Printed;
use crate::read::columns::{self, Role};
use crate::read::footer;
use crate::sheet::Grid;
use crate::units;

use super::located::{Column, Located};

/// The relative standard uncertainties in the place of the absolute ones, where the contributions are made of them, and not of those.
pub(super) fn take_relative(grid: &Grid, located: &mut Located) {
    let at = |role: Role| located.column(role).map(|column| column.index);
    let (Some(u), Some(made)) = (at(Role::U), at(Role::Contribution)) else {
        return;
    };
    let is_relative = |column: &&Column| {
        let is_u = columns::role(&column.head).is_some_and(|(role, _)| role == Role::U);
        column.role == Role::Derived && (is_u || footer::is_relative(&column.head))
    };
    let Some(relative) = located.columns.iter().find(is_relative) else {
        return;
    };
    let relative = relative.index;
    let c = at(Role::C);
    let estimate = [Role::Value, Role::Used].into_iter().filter_map(at);
    let mut estimate = estimate.filter(|x| {
        mostly(located, |row| {
            is_part(grid, located, row, [u, *x, relative])
        })
    });
    let Some(estimate) = estimate.next() else {
        return;
    };
    let is_made = |row: usize, of: usize| {
        let figure = |column: usize| grid.cell(row, column).figure();
        let c = c.map_or(Some(1.0), |c| Some(figure(c)?.value))?;
        let (of, made) = (figure(of)?, figure(made)?);
        let open = made.half + (c * of.half).abs() + 0.01 * made.value.abs();
        Some(((c * of.value).abs() - made.value.abs()).abs() <= open)
    };
    if !mostly(located, |row| is_made(row, relative)) || mostly(located, |row| is_made(row, u)) {
        return;
    }
    for column in &mut located.columns {
        match column.index {
            index if index == u => column.role = Role::Derived,
            index if index == relative => {
                column.role = Role::U;
                if column.unit.is_empty() {
                    column.unit = "%".into();
                }
            }
            index if index == estimate => column.role = Role::Value,
            _ => {}
        }
    }
}

/// Whether most rows of a table are so.
fn mostly(located: &Located, is: impl Fn(usize) -> Option<bool>) -> bool {
    let met = located.rows.iter().filter(|row| is(**row) == Some(true));
    2 * met.count() > located.rows.len()
}

/// Whether the relative figure of a row is u as a part of the estimate.
fn is_part(grid: &Grid, located: &Located, row: usize, columns: [usize; 3]) -> Option<bool> {
    let figure = |column: usize| grid.cell(row, column).figure();
    let [u, x, relative] = columns;
    let unit = located.unit_in(grid, row, relative);
    let fraction = units::fraction(&unit).unwrap_or(1.0);
    let (u, x, relative): (Printed, Printed, Printed) = (figure(u)?, figure(x)?, figure(relative)?);
    let factor = units::factor(&u.unit, &x.unit).unwrap_or(1.0);
    let part = factor * u.value / (fraction * x.value.abs());
    let open = relative.half + part * (u.relative_half().min(0.02)) + 0.02 * relative.value;
    Some((part - relative.value).abs() <= open)
}
