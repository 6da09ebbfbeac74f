//! The head of a table: one line, or two.

use crate::printed::Printed;
use crate::read::columns::{self, Role};
use crate::read::mapping::Mapping;
use crate::sheet::Grid;

use super::located::{Column, Located};

/// The columns of a row that is a head.
pub(super) fn head(grid: &Grid, row: usize, mapping: &Mapping) -> Option<Vec<Column>> {
    let mut filled: Vec<(usize, &str)> = grid
        .filled(row)
        .map(|(i, cell)| (i, cell.text.as_str()))
        .collect();
    // What is hidden gives way to what is shown.
    filled.sort_by_key(|(column, _)| grid.hidden_columns.contains(column));
    let figures = filled
        .iter()
        .filter(|(_, text)| Printed::parse(text).is_some())
        .count();
    let longest = filled
        .iter()
        .map(|(_, text)| text.chars().count())
        .max()
        .unwrap_or(0);
    if filled.len() < 3 || figures * 3 > filled.len() || longest > 90 {
        return None;
    }
    let columns = roles(&filled, mapping);
    let has = |roles: &[Role]| columns.iter().any(|c| roles.contains(&c.role));
    let identity = has(&[Role::Symbol, Role::Name]);
    let figure = has(&[Role::Used, Role::U, Role::Contribution])
        || has(&[Role::Remark]) && has(&[Role::Value, Role::C]);
    let enough = columns.len() >= 3 && columns.len() * 2 >= filled.len();
    (identity && figure && enough).then_some(columns)
}

fn roles(filled: &[(usize, &str)], mapping: &Mapping) -> Vec<Column> {
    let mut columns: Vec<Column> = Vec::new();
    let contributions = filled
        .iter()
        .any(|(_, text)| columns::role(text).is_some_and(|(role, _)| role == Role::Contribution));
    for (index, text) in filled {
        let named = mapping
            .role(text)
            .map(|role| (role, columns::apart(text).1))
            .or_else(|| columns::role(text));
        let Some((role, unit)) = named else {
            continue;
        };
        // `Quantity | Symbol`: the first is the name after all.
        let explicit = ["symbol", "符号", "代号"]
            .iter()
            .any(|word| text.to_lowercase().contains(word));
        if role == Role::Symbol
            && explicit
            && let Some(before) = columns.iter_mut().find(|c| c.role == Role::Symbol)
        {
            before.role = Role::Name;
        }
        let taken = |role: Role| columns.iter().any(|c: &Column| c.role == role);
        let role = match role {
            // A second column of the same kind is what comes next in the calculation.
            Role::U if taken(Role::U) && !contributions && !taken(Role::Contribution) => {
                Role::Contribution
            }
            Role::Symbol if taken(Role::Symbol) => Role::Name,
            Role::Name if taken(Role::Name) && !taken(Role::Symbol) => Role::Remark,
            Role::Value if taken(Role::Value) && !taken(Role::Used) => Role::Used,
            Role::Used if taken(Role::Used) => Role::Derived,
            role if taken(role)
                && role != Role::Remark
                && role != Role::Derived
                && role != Role::Unit =>
            {
                continue;
            }
            role => role,
        };
        columns.push(Column {
            index: *index,
            role,
            head: (*text).into(),
            unit,
        });
    }
    columns
}

/// A second line of the head: symbols below words, or units.
pub(super) fn second_line(grid: &Grid, located: &mut Located, mapping: &Mapping) {
    let row = located.head + 1;
    let filled: Vec<(usize, &str)> = grid
        .filled(row)
        .map(|(i, cell)| (i, cell.text.as_str()))
        .collect();
    if filled.len() < 2 {
        return;
    }
    let bare = |text: &str| {
        text.trim_matches(['(', ')', '[', ']', '/', ' '])
            .to_string()
    };
    let units = filled
        .iter()
        .filter(|(_, text)| columns::is_unit(&bare(text)) || matches!(*text, "-" | "1" | "/"))
        .count();
    let named = roles(&filled, mapping).len();
    let figures = filled
        .iter()
        .filter(|(_, text)| Printed::parse(text).is_some() && *text != "1")
        .count();
    if figures > 0 {
        return;
    }
    // `Standard` above `uncertainty`: each column has its words one below the other.
    let joined: Vec<(usize, String)> = (0..grid.rows[located.head].len())
        .map(|column| {
            let both = [located.head, row].map(|row| grid.cell(row, column).text.as_str());
            (column, both.join(" ").trim().to_string())
        })
        .filter(|(_, text)| !text.is_empty())
        .collect();
    let joined: Vec<(usize, &str)> = joined.iter().map(|(i, text)| (*i, text.as_str())).collect();
    let together = roles(&joined, mapping);
    let evaluated = |columns: &[Column]| {
        let of = |role: Role| columns.iter().any(|c| c.role == role);
        [Role::U, Role::Contribution, Role::Dof]
            .into_iter()
            .filter(|role| of(*role))
            .count()
    };
    let gained = evaluated(&together) > evaluated(&located.columns);
    if gained && together.len() >= located.columns.len() && units * 2 <= filled.len() {
        located.columns = together;
    } else if units * 2 > filled.len() {
        for (index, text) in &filled {
            let unit = bare(text);
            if let Some(column) = located
                .columns
                .iter_mut()
                .find(|c| c.index == *index && c.unit.is_empty())
                && columns::is_unit(&unit)
            {
                column.unit = unit;
            }
        }
    } else if named * 2 > filled.len() && named >= 3 {
        for column in roles(&filled, mapping) {
            let free = !located
                .columns
                .iter()
                .any(|c| c.index == column.index || c.role == column.role);
            if free {
                located.columns.push(column);
            }
        }
    } else {
        return;
    }
    located.used.insert(row);
    located.end = row + 1;
}
