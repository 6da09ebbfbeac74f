//! The head of a table: one line, or two.

use crate::printed::Printed;
use crate::read::blocks;
use crate::read::columns::{self, Role};
use crate::read::footer;
use crate::read::mapping::Mapping;
use crate::sheet::Grid;
use crate::units;

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
    let is_table = filled.len() >= 2 && figures * 3 <= filled.len() && longest <= 90;
    if !is_table || is_matrix(grid, row) {
        return None;
    }
    let names = |index: usize| told_below(grid, row, index);
    let mut columns = roles(&filled, mapping, &names);
    if let Some(column) = nameless_names(&columns, grid, &names, &filled) {
        columns.push(column);
    }
    relative_contributions(grid, row, &mut columns);
    let has = |roles: &[Role]| columns.iter().any(|c| roles.contains(&c.role));
    let identity = has(&[Role::Symbol, Role::Name]);
    let figure = has(&[Role::Used, Role::U, Role::Contribution])
        || has(&[Role::Remark]) && has(&[Role::Value, Role::C]);
    let enough = match filled.len() {
        2 => is_list(grid, row, &columns),
        count => columns.len() >= 3 && columns.len() * 2 >= count,
    };
    (identity && figure && enough).then_some(columns)
}

/// Whether the rows below a head are called as its columns are: a matrix of coefficients.
pub(super) fn is_matrix(grid: &Grid, head: usize) -> bool {
    let columns: Vec<&str> = grid
        .filled(head)
        .map(|(_, cell)| cell.text.as_str())
        .collect();
    let rows = (head + 1..grid.rows.len()).filter_map(|row| grid.filled(row).next());
    // A rule below the head is no row.
    let rows = rows.filter(|(_, cell)| cell.text.contains(char::is_alphanumeric));
    let names = |count: usize| rows.clone().map(|(_, cell)| cell.text.as_str()).take(count);
    // In front of the columns may stand what the figures are.
    [0, 1].into_iter().any(|front| {
        let columns = columns.get(front..).unwrap_or_default();
        columns.len() >= 2 && names(columns.len()).eq(columns.iter().copied())
    })
}

/// Whether two heads stand above a list of sources with their uncertainties, and nothing else.
fn is_list(grid: &Grid, head: usize, columns: &[Column]) -> bool {
    let is_uncertainty = |c: &&Column| match c.role {
        Role::U | Role::Contribution => true,
        Role::Used => columns::is_bare_uncertainty(&c.head),
        _ => false,
    };
    let Some(figures) = columns.iter().find(is_uncertainty) else {
        return false;
    };
    let is_entry = |row: usize| {
        let figure = grid.cell(row, figures.index).figure();
        figure.is_some() && grid.filled(row).count() == 2
    };
    // A block of one type of evaluation may have a single source.
    let entries = if blocks::is_titled(grid, head) { 1 } else { 2 };
    columns.len() == 2 && (head + 1..=head + entries).all(is_entry)
}

/// `Contribution %` is the share in the variance where the figures total 100, else the contribution to a relative result.
/// Beside u and a coefficient, of which it would be computed, it is a contribution only where they give it.
fn relative_contributions(grid: &Grid, head: usize, columns: &mut [Column]) {
    let of = |role: Role| columns.iter().find(|c| c.role == role).map(|c| c.index);
    let (u, c) = (of(Role::U), of(Role::C));
    if of(Role::Contribution).is_some() || u.is_some() && c.is_none() {
        return;
    }
    let is_meant = |column: &&mut Column| {
        let words = ["contribution", "beitrag", "分量"];
        let head = column.head.to_lowercase();
        column.role == Role::Derived && words.iter().any(|word| head.starts_with(word))
    };
    let Some(column) = columns.iter_mut().find(is_meant) else {
        return;
    };
    let figure = |row: usize, column: usize| Some(grid.cell(row, column).figure()?.value);
    let rows = head + 1..grid.rows.len();
    let below = rows.map_while(|row| Some((row, figure(row, column.index)?)));
    let figures: Vec<(usize, f64)> = below.collect();
    let total: f64 = figures.iter().map(|(_, figure)| figure).sum();
    // Shares are printed in whole percent, and may miss 100 by half of one each.
    let is_whole = (total - 100.0).abs() <= 0.5 * figures.len() as f64;
    let made = figures.iter().filter_map(|(row, made)| {
        let product = (figure(*row, u?)? * figure(*row, c?)?).abs();
        Some((product - made.abs()).abs() <= 0.05 * made.abs())
    });
    let made: Vec<bool> = made.collect();
    let met = made.iter().filter(|is_met| **is_met).count();
    let is_computed = u.is_none() || 2 * met > made.len();
    if figures.len() >= 2 && !is_whole && is_computed {
        (column.role, column.unit) = (Role::Contribution, "%".into());
    }
}

/// The column of names in front of the first head, where nothing stands above it.
fn nameless_names(
    columns: &[Column],
    grid: &Grid,
    names: &dyn Fn(usize) -> Option<Role>,
    filled: &[(usize, &str)],
) -> Option<Column> {
    let is_named = columns
        .iter()
        .any(|c| matches!(c.role, Role::Symbol | Role::Name));
    let first = filled.iter().map(|(index, _)| *index).min()?;
    let index = first
        .checked_sub(1)
        .filter(|_| !is_named && !columns.is_empty())?;
    let is_name = |role: &Role| *role != Role::Derived && !grid.hidden_columns.contains(&index);
    let role = names(index).filter(is_name)?;
    let (head, unit) = (String::new(), String::new());
    Some(Column {
        index,
        role,
        head,
        unit,
    })
}

/// What the cells of a column say that it is, where its head promises computed figures.
fn told_below(grid: &Grid, head: usize, index: usize) -> Option<Role> {
    let are_shares = || are_shares(grid, head, index).then_some(Role::Derived);
    names_below(grid, head, index).or_else(are_shares)
}

/// Whether the figures of a column total 100, which one of them may be below the others: shares of one whole, in percent.
fn are_shares(grid: &Grid, head: usize, index: usize) -> bool {
    let figure = |row: usize| grid.cell(row, index).figure();
    let below: Vec<Printed> = (head + 1..grid.rows.len()).map_while(figure).collect();
    let is_whole = |shares: &[Printed]| {
        let total: f64 = shares.iter().map(|share| share.value).sum();
        // Each is rounded for itself.
        let open: f64 = shares.iter().map(|share| share.half).sum();
        shares.len() >= 2 && (total - 100.0).abs() <= open
    };
    let without_total = || below.split_last().map_or(&below[..0], |(_, shares)| shares);
    is_whole(&below) || is_whole(without_total())
}

/// What a column is whose head promises figures and which holds none below it: `标准不确定度分量` above `u(m_1)` names
/// the rows.
fn names_below(grid: &Grid, head: usize, index: usize) -> Option<Role> {
    /// Rows below the head that are looked at: units or symbols may stand in the first.
    const BELOW: usize = 6;
    let rows = head + 1..grid.rows.len().min(head + 1 + BELOW);
    let cells: Vec<&str> = rows
        .map(|row| grid.cell(row, index).text.as_str())
        .filter(|text| !text.is_empty())
        .collect();
    let words = cells.len() >= 2 && cells.iter().all(|text| Printed::parse(text).is_none());
    let short = cells.iter().all(|text| text.chars().count() <= 12);
    words.then_some(if short { Role::Symbol } else { Role::Name })
}

fn roles(
    filled: &[(usize, &str)],
    mapping: &Mapping,
    names: &dyn Fn(usize) -> Option<Role>,
) -> Vec<Column> {
    let mut columns: Vec<Column> = Vec::new();
    let said = |index: usize, text: &str| {
        let (role, unit) = columns::role(text)?;
        let computed = matches!(role, Role::U | Role::C | Role::Contribution);
        // `Contribution (%)`: what else totals 100 may do so by chance.
        let may_be_share = role == Role::Contribution && units::fraction(&unit) == Some(0.01);
        let is_meant = |told: &Role| *told != Role::Derived || may_be_share;
        let of_cells = names(index).filter(|told| computed && is_meant(told));
        Some(of_cells.map_or((role, unit), |role| (role, String::new())))
    };
    let contributions = filled.iter().any(|(index, text)| {
        said(*index, text).is_some_and(|(role, _)| role == Role::Contribution)
    });
    for (index, text) in filled {
        let named = mapping
            .role(text)
            .map(|role| (role, columns::apart(text).1))
            .or_else(|| said(*index, text));
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
        if role == Role::Used {
            estimate_beside_used(&mut columns);
        }
        if role == Role::Contribution {
            value_in_front_of_u(&mut columns);
        }
        let taken = |role: Role| columns.iter().any(|c: &Column| c.role == role);
        let of_first = columns.iter().find(|c: &&Column| c.role == Role::U);
        let is_share = |unit: &str| units::fraction(unit).is_some();
        let is_again = of_first.is_some_and(|first| is_share(&first.unit) != is_share(&unit));
        let role = match role {
            // `u / kPa | u / %`, `u | relative u`: the same again, as a part of the value.
            Role::U if is_again && !unit.is_empty() && !taken(Role::C) => Role::Derived,
            Role::U if taken(Role::U) && !taken(Role::C) && footer::is_relative(text) => {
                Role::Derived
            }
            // `c_i | u_i`: a bare u behind the coefficient is what comes of both.
            Role::U if taken(Role::C) && !contributions && columns::is_bare_u(text) => {
                Role::Contribution
            }
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

/// `分量值 | k | u(x_i) | |c_i|·u(x_i)`: what stands in front of u is no contribution, which comes of it, where another column is
/// one.
fn value_in_front_of_u(columns: &mut [Column]) {
    let at = |role: Role| columns.iter().position(|c| c.role == role);
    let (contribution, u, used) = (at(Role::Contribution), at(Role::U), at(Role::Used));
    if let (Some(contribution), Some(u), None) = (contribution, u, used)
        && contribution < u
    {
        columns[contribution].role = Role::Used;
    }
}

/// `数值 | 半宽`: a figure of which the head says no more is the estimate, beside one of which it does.
fn estimate_beside_used(columns: &mut [Column]) {
    const OPEN: [&str; 5] = ["数值", "figure", "magnitude", "size", "amount"];
    if columns.iter().any(|c| c.role == Role::Value) {
        return;
    }
    let is_open = |c: &&mut Column| {
        c.role == Role::Used && OPEN.contains(&columns::apart(&c.head).0.to_lowercase().as_str())
    };
    if let Some(column) = columns.iter_mut().find(is_open) {
        column.role = Role::Value;
    }
}

/// A line above the head whose words name what the head leaves open: `|c_i|u(x_i)` above `/kPa`.
pub(super) fn line_above(grid: &Grid, located: &mut Located) {
    let Some(row) = located.head.checked_sub(1) else {
        return;
    };
    let filled = grid.filled(row).count();
    let figures = |text: &str| Printed::parse(text).is_some();
    if filled < 3 || grid.filled(row).any(|(_, cell)| figures(&cell.text)) {
        return;
    }
    let mut named = false;
    for (index, cell) in grid.filled(row) {
        let own = grid.cell(located.head, index).text.as_str();
        let unit = own.trim_matches(['(', ')', '[', ']', '/', ' ']);
        let open = own.is_empty() || columns::is_unit(unit);
        let known = located.columns.iter().any(|c| c.index == index);
        let said = columns::role(&cell.text).filter(|_| open && !known);
        let free = |role: Role| located.columns.iter().all(|c| c.role != role);
        if let Some((role, of_words)) = said.filter(|(role, _)| free(*role)) {
            let unit = if columns::is_unit(unit) {
                unit
            } else {
                &of_words
            };
            let column = Column {
                index,
                role,
                head: format!("{} {own}", cell.text).trim_end().into(),
                unit: unit.into(),
            };
            located.columns.push(column);
            named = true;
        }
    }
    if named {
        located.used.insert(row);
    }
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
    let named = roles(&filled, mapping, &|_| None).len();
    let figures = filled
        .iter()
        .filter(|(_, text)| Printed::parse(text).is_some() && *text != "1")
        .count();
    if figures > 0 {
        return;
    }
    // The upper of both may have fewer cells.
    let all = 0..grid.rows[located.head].len().max(grid.rows[row].len());
    // `Standard` above `uncertainty`: each column has its words one below the other.
    let joined: Vec<(usize, String)> = all
        .clone()
        .map(|column| {
            let both = [located.head, row].map(|row| grid.cell(row, column).text.as_str());
            (column, both.join(" ").trim().to_string())
        })
        .filter(|(_, text)| !text.is_empty())
        .collect();
    let joined: Vec<(usize, &str)> = joined.iter().map(|(i, text)| (*i, text.as_str())).collect();
    let together = roles(&joined, mapping, &|index| told_below(grid, row, index));
    let evaluated = |columns: &[Column]| {
        let of = |role: Role| columns.iter().any(|c| c.role == role);
        [Role::U, Role::Contribution, Role::Dof]
            .into_iter()
            .filter(|role| of(*role))
            .count()
    };
    let below_merged = below_merged(grid, located.head, &filled, mapping);
    // Below `标准不确定度评定`, which spans them, `半宽 (g)` is what it says, and no standard uncertainty.
    let below_alone = || {
        evaluated(&roles(&filled, mapping, &|index| {
            told_below(grid, row, index)
        }))
    };
    let says_as_much = below_merged.is_some() && below_alone() >= evaluated(&together);
    let gained = evaluated(&together) > evaluated(&located.columns) && !says_as_much;
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
    } else if let Some(below) = below_merged {
        let words = all.map(|index| {
            let own = below.iter().find(|(column, _)| *column == index);
            let above = || grid.cell(located.head, index).text.as_str();
            (index, own.map_or_else(above, |(_, text)| *text))
        });
        let words: Vec<(usize, &str)> = words.filter(|(_, text)| !text.is_empty()).collect();
        let mut columns = roles(&words, mapping, &|index| told_below(grid, row, index));
        relative_contributions(grid, row, &mut columns);
        // Names without a head.
        for column in located.columns.drain(..) {
            if columns
                .iter()
                .all(|c| c.index != column.index && c.role != column.role)
            {
                columns.push(column);
            }
        }
        located.columns = columns;
    } else if named * 2 > filled.len() && named >= 3 {
        for column in roles(&filled, mapping, &|index| told_below(grid, row, index)) {
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

/// The words below merged heads that say more than these: `分布` and `包含因子 k` below `分布及包含因子`. All words of the
/// line name a column, and one at least stands behind the first column of a head that spans several.
fn below_merged<'g>(
    grid: &Grid,
    head: usize,
    filled: &[(usize, &'g str)],
    mapping: &Mapping,
) -> Option<Vec<(usize, &'g str)>> {
    let row = head + 1;
    let columns = roles(filled, mapping, &|index| told_below(grid, row, index));
    let spanned = |index: usize| {
        let above = |column: usize| !grid.cell(head, column).is_empty();
        index > 0
            && !above(index)
            && (above(index - 1) || filled.iter().any(|(i, _)| i + 1 == index))
    };
    let is_head = columns.len() == filled.len() && filled.iter().any(|(i, _)| spanned(*i));
    // `数值 | 单位` below a head of figures says no more of them than that.
    let says = |(index, text): &(usize, &str)| {
        let role = columns.iter().find(|c| c.index == *index).map(|c| c.role);
        match role {
            Some(Role::Used) => columns::names_limits(text),
            Some(Role::Value | Role::Derived) | None => false,
            Some(_) => true,
        }
    };
    is_head.then(|| filled.iter().filter(|both| says(both)).copied().collect())
}
