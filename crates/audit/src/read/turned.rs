//! Tables whose rows and columns are exchanged: heads down the first column, one quantity in each column behind it.

use crate::sheet::{Cell, Grid};

use super::columns::{self, Role};
use super::footer;
use super::simulated::MONTE_CARLO;

/// The fewest heads below one another that are no chance.
const FEWEST: usize = 4;

/// The sheet with such a table the usual way round; as it is where there is none.
pub fn upright(grid: &Grid) -> Grid {
    let Some((start, end, first)) = (0..grid.rows.len()).find_map(|start| heads_below(grid, start))
    else {
        return grid.clone();
    };
    let width = (start..end)
        .map(|row| grid.rows[row].len())
        .max()
        .unwrap_or(0);
    let mut upright = Grid {
        name: grid.name.clone(),
        point: grid.point.clone(),
        rows: grid.rows[..start].to_vec(),
        ..Grid::default()
    };
    let is_filled = |column: &usize| (start..end).any(|row| !grid.cell(row, *column).is_empty());
    for column in (first..width).filter(is_filled) {
        let at = upright.rows.len();
        let origin = |(place, row): (usize, usize)| ((at, place), (row, column));
        upright.origins.extend((start..end).enumerate().map(origin));
        let cells = (start..end).map(|row| grid.cell(row, column).clone());
        upright.rows.push(cells.collect());
    }
    // Figures below the table stand behind their labels, and in none of its columns.
    let gap = vec![Cell::default(); end - start];
    let moved = |column: usize| match column <= first {
        true => column,
        false => column + gap.len(),
    };
    for (row, cells) in grid.rows.iter().enumerate().skip(end) {
        let at = upright.rows.len();
        let origin = |column: usize| ((at, moved(column)), (row, column));
        upright.origins.extend((0..cells.len()).map(origin));
        let (label, figures) = cells.split_at(cells.len().min(first + 1));
        upright.rows.push([label, &gap, figures].concat());
    }
    upright
}

/// Rows from here on that begin with heads of different columns, one of which names a quantity and one of which is a
/// figure of its uncertainty, and the column of these heads.
fn heads_below(grid: &Grid, start: usize) -> Option<(usize, usize, usize)> {
    let (first, _) = grid.filled(start).next()?;
    // Names of the quantities side by side, and nothing in the corner before them.
    let corner = grid.filled(start + 1).next();
    let corner = corner
        .map(|(column, _)| column)
        .filter(|column| *column < first);
    let (mut roles, mut end) = match corner {
        Some(_) if are_names(grid, start) => (vec![Role::Name], start + 1),
        _ => (Vec::new(), start),
    };
    let heads = if end > start {
        corner.unwrap_or(first)
    } else {
        first
    };
    while let Some((column, cell)) = grid.filled(end).next() {
        let Some((role, _)) = columns::role(&cell.text) else {
            break;
        };
        // A figure of the whole stands alone behind its label.
        let is_whole = grid.filled(end).count() == 2
            && grid.filled(start).count() > 2
            && footer::label(&cell.text, "").is_some();
        if column != heads || is_whole || roles.contains(&role) || grid.filled(end).count() < 2 {
            break;
        }
        roles.push(role);
        end += 1;
    }
    let below = (start..end).filter_map(|row| Some(grid.filled(row).next()?.1.text.as_str()));
    // Quantities called a, b, c below a usual head are no heads.
    let across = grid.filled(start).map(|(_, cell)| cell.text.as_str());
    let across: Vec<&str> = across.collect();
    let across_roles = across
        .iter()
        .filter_map(|text| Some(columns::role(text)?.0));
    let across_roles: Vec<Role> = across_roles.collect();
    let (of_words, of_words_below) = (words(across.iter().copied()), words(below.clone()));
    // Quantities A, B and C below a head of letters, `Symbol | u | c`: those of columns are small ones.
    let are_capital = || capitals(below.skip(1)) && !capitals(across.iter().copied().skip(1));
    let is_usual = (is_head(&across_roles) || is_head_of_summary(&across_roles))
        && (of_words > of_words_below || of_words == of_words_below && are_capital());
    let mut names = grid.filled(start).map(|(_, cell)| cell.text.as_str());
    let is_compared = names.any(is_of_comparison);
    // One column of figures behind the heads would be one quantity, and no budget.
    let are_several = grid.filled(start).count() > 2;
    let is_turned =
        roles.len() >= FEWEST && is_head(&roles) && !is_usual && !is_compared && are_several;
    is_turned.then_some((start, end, heads))
}

/// Whether names are capital letters, each alone.
fn capitals<'t>(mut names: impl Iterator<Item = &'t str>) -> bool {
    names.all(|name| name.chars().count() == 1 && name.chars().all(char::is_uppercase))
}

/// Whether a column is that of one of several calculations of a result, or of what somebody claims of it.
fn is_of_comparison(head: &str) -> bool {
    let lower = head.to_lowercase();
    footer::calls_claim(&lower) || MONTE_CARLO.iter().any(|name| lower.starts_with(name))
}

/// Whether a row holds names alone.
fn are_names(grid: &Grid, row: usize) -> bool {
    grid.filled(row).all(|(_, cell)| cell.figure().is_none())
}

/// Whether heads name a quantity and a figure of its uncertainty.
fn is_head(roles: &[Role]) -> bool {
    let has = |wanted: &[Role]| roles.iter().any(|role| wanted.contains(role));
    has(&[Role::Symbol, Role::Name]) && has(&[Role::Used, Role::U, Role::Contribution])
}

/// Whether heads name a quantity and what is known of it.
fn is_head_of_summary(roles: &[Role]) -> bool {
    let has = |wanted: &[Role]| roles.iter().any(|role| wanted.contains(role));
    has(&[Role::Symbol, Role::Name]) && has(&[Role::Remark]) && has(&[Role::Value, Role::C])
}

/// How many heads are words, and not letters that a quantity may be called by.
fn words<'t>(heads: impl Iterator<Item = &'t str>) -> usize {
    let is_word = |text: &&str| {
        let name = text.split(['(', '/', '_', ' ']).next().unwrap_or_default();
        name.chars().count() >= 3 || !name.is_ascii() && name.chars().count() >= 2
    };
    let known = heads.filter(|text| columns::role(text).is_some());
    known.filter(is_word).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_in_the_first_column_are_turned() {
        let turned = upright(&Grid::of_rows(&[
            "Budget",
            "",
            "Symbol|a|b",
            "Divisor|2|√3",
            "u(x_i)|0.1|0.2",
            "c_i|1|-1",
            "",
            "U = 0.4",
        ]));
        assert_eq!(turned.rows[2][2].text, "u(xi)".replace("xi", "x_i"));
        assert_eq!(turned.rows[4][1].text, "√3");
        assert_eq!(turned.rows.len(), 7);
        let usual = Grid::of_rows(&["Symbol|u(x_i)|c_i", "a|0.1|1", "b|0.2|1"]);
        assert_eq!(upright(&usual), usual);
    }
}
