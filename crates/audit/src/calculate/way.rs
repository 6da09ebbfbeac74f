//! Rows from which nothing leads to the result: c_i is neither stated nor given by a model (JCGM 100, 5.1.3).

use crate::claim::{Claimed, Row};
use crate::units::leads_nowhere;

use super::case::Case;

impl Case<'_> {
    /// Rows in the unit of another quantity than the result, of which the sheet states neither a coefficient nor a contribution,
    /// and which no model has; and those with a coefficient that is not understood.
    pub fn without_way(&self) -> Vec<usize> {
        if self.derivatives.is_some() {
            return Vec::new();
        }
        let target = target(self.claimed);
        let rows = self.claimed.rows.iter().enumerate();
        let is_unknown = |row: &Row| row.unread_c.is_some() || leads_nowhere(&row.unit, target);
        let open = rows.filter(|(_, row)| is_open(row) && is_unknown(row));
        open.map(|(i, _)| i).collect()
    }
}

/// The unit in which contributions are summed; that of the first row where the sheet does not say it.
fn target(claimed: &Claimed) -> &str {
    let units = claimed.rows.iter().map(|row| row.unit.as_str());
    let mut units = [claimed.unit.as_str()].into_iter().chain(units);
    units.find(|unit| !unit.is_empty()).unwrap_or_default()
}

fn is_open(row: &Row) -> bool {
    row.not_counted.is_none() && row.c.is_none() && row.contribution.is_none()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::printed::Printed;

    fn rows_without_way(unit: &str, rows: [Row; 2]) -> Vec<usize> {
        let claimed = Claimed {
            unit: unit.into(),
            rows: rows.into(),
            ..Claimed::default()
        };
        Case::of(&claimed).without_way()
    }

    #[test]
    fn a_row_of_another_quantity_needs_a_coefficient() {
        let row = |u: &str, unit: &str| Row {
            u: Printed::parse(u),
            unit: unit.into(),
            ..Row::default()
        };
        let with_coefficient = || Row {
            c: Printed::parse("2.1"),
            ..row("0.3", "°C")
        };
        assert_eq!(
            rows_without_way("mm", [row("0.1", "µm"), row("0.3", "°C")]),
            [1]
        );
        assert_eq!(
            rows_without_way("", [row("0.1", "g"), row("0.3", "mL")]),
            [1]
        );
        let none: [usize; 0] = [];
        assert_eq!(
            rows_without_way("mm", [row("0.1", "µm"), with_coefficient()]),
            none
        );
        assert_eq!(
            rows_without_way("K", [row("0.1", "mK"), row("0.3", "°C")]),
            none
        );
        assert_eq!(
            rows_without_way("mm", [row("0.1", ""), row("0.3", "digits")]),
            none
        );
    }
}
