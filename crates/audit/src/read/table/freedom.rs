//! Degrees of freedom as laboratories write them: `50`, `>50`, `50+`, `ca. 50`, `1E+99`.

use crate::claim::{Claimed, Understood, Unplaced};
use crate::printed::{Place, Printed};
use crate::read::columns::Role;
use crate::sheet::Grid;

use super::located::Located;

/// Marks in front of a number that there is at least, or about.
const IN_FRONT: [&str; 17] = [
    ">=",
    ">",
    "≥",
    "⩾",
    "≧",
    "~",
    "≈",
    "at least",
    "about",
    "approximately",
    "approx.",
    "circa",
    "ca.",
    "ca",
    "不小于",
    "大于",
    "约",
];

/// The number that there is at least, or about: the figure that is stated is the one to compute with.
pub(super) fn about(text: &str) -> Option<Printed> {
    let lower = text.trim().to_lowercase();
    let behind = IN_FRONT.iter().find_map(|mark| lower.strip_prefix(mark));
    let number = behind.unwrap_or(&lower).trim().trim_end_matches('+');
    let figure = Printed::parse(number).filter(|_| number != lower)?;
    let text = text.trim().to_string();
    Some(Printed { text, ..figure })
}

/// Degrees of freedom from here on are as good as infinitely many: spreadsheets write `1E+99`.
pub(super) fn as_infinite(dof: Printed) -> Printed {
    const MANY: f64 = 1e5;
    let value = if dof.value >= MANY {
        f64::INFINITY
    } else {
        dof.value
    };
    Printed { value, ..dof }
}

/// Says of the cells of a table in what words degrees of freedom were understood, and in what words not.
pub fn of_cells(grid: &Grid, sheet: usize, located: &Located, claimed: &mut Claimed) {
    let Some(column) = located.column(Role::Dof).map(|column| column.index) else {
        return;
    };
    for row in &located.rows {
        let text = grid.cell(*row, column).text.trim().to_string();
        let at = Place {
            sheet,
            row: *row,
            column,
        };
        let is_silent = !text.contains(char::is_alphanumeric);
        if is_silent || Printed::parse(&text).is_some() {
            continue;
        }
        match about(&text) {
            Some(_) => claimed.understood.push(Understood {
                at,
                text,
                role: Role::Dof.name(),
            }),
            None => claimed.unplaced.push(Unplaced { at, text }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_taken_as_they_stand() {
        for text in ["50+", ">50", "≥ 50", "~50", "ca. 50", "about 50", "约50"] {
            let dof = about(text).unwrap();
            assert_eq!((dof.value, dof.text.as_str()), (50.0, text));
        }
        for text in ["many", "50", "-", ""] {
            assert_eq!(about(text), None, "{text}");
        }
    }
}
