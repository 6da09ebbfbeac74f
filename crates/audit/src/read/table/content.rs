//! What stands in a column, where its head is doubtful.

use crate::printed::Printed;
use crate::read::columns::{self, Role};
use crate::sheet::Grid;

use super::located::{Column, Located};

/// What stands in a column decides where its head is doubtful: figures below a name are what was put in, running numbers
/// are no names, and words below a head that says nothing are remarks.
pub(super) fn by_content(grid: &Grid, located: &mut Located) {
    let column = |index: usize| Cells {
        grid,
        rows: &located.rows,
        index,
    };
    let mut roles: Vec<(usize, Role)> = located.columns.iter().map(|c| (c.index, c.role)).collect();
    for place in 0..roles.len() {
        let (index, role) = roles[place];
        let cells = column(index);
        let is_name = |role: Role| matches!(role, Role::Symbol | Role::Name);
        let other_name = roles.iter().any(|(other, role)| {
            *other != index && is_name(*role) && !column(*other).mostly(is_figure)
        });
        let said = |role: Role| {
            move |c: &&Column| columns::role(&c.head).is_some_and(|(said, _)| said == role)
        };
        let free = |wanted: Role| roles.iter().all(|(_, role)| *role != wanted);
        // The head of another column that was passed over because this one had its role.
        let passed_over = |wanted: Role| {
            let others = located.columns.iter().filter(|c| c.index != index);
            others.filter(said(wanted)).map(|c| c.index).next()
        };
        if is_name(role) && cells.are_running() {
            roles[place].1 = Role::Number;
            let name = passed_over(Role::Name)
                .or(passed_over(Role::Symbol))
                .filter(|_| !other_name);
            if let Some(other) = roles.iter_mut().find(|(index, _)| Some(*index) == name) {
                other.1 = role;
            }
        } else if matches!(role, Role::Type | Role::Derived) && cells.mostly(is_words) {
            roles[place].1 = Role::Remark;
        } else if role == Role::Used && cells.mostly(is_words) {
            roles[place].1 = Role::Remark;
            let used = passed_over(Role::Used);
            if let Some(other) = roles
                .iter_mut()
                .find(|(index, role)| Some(*index) == used && *role == Role::Derived)
            {
                other.1 = Role::Used;
            }
        } else if (is_name(role) || matches!(role, Role::Remark | Role::Type))
            && cells.mostly(is_figure)
            && other_name
        {
            let open = [Role::Used, Role::Value]
                .into_iter()
                .find(|role| free(*role));
            roles[place].1 = open.unwrap_or(Role::Derived);
        }
    }
    for (column, (_, role)) in located.columns.iter_mut().zip(roles) {
        column.role = role;
    }
    value_is_used(grid, located);
    nameless_words(grid, located);
}

/// The cells of a column in the rows of a table.
struct Cells<'g> {
    grid: &'g Grid,
    rows: &'g [usize],
    index: usize,
}

fn is_figure(text: &str) -> bool {
    Printed::parse(text).is_some()
}

fn is_words(text: &str) -> bool {
    !is_figure(text) && text.chars().count() >= 8 && !text.starts_with(|c: char| c.is_ascii_digit())
}

impl Cells<'_> {
    fn texts(&self) -> impl Iterator<Item = &str> {
        let rows = self.rows.iter();
        rows.map(|row| self.grid.cell(*row, self.index).text.as_str())
    }

    fn mostly(&self, is: fn(&str) -> bool) -> bool {
        2 * self.texts().filter(|text| is(text)).count() > self.rows.len()
    }

    /// 1, 2, 3 …
    fn are_running(&self) -> bool {
        let number = |text: &str| text.trim_end_matches(['.', ')']).parse::<usize>().ok();
        let numbers: Vec<usize> = self.texts().filter_map(number).collect();
        numbers.len() >= 2
            && numbers[0] <= 1
            && 2 * numbers.len() > self.rows.len()
            && numbers.windows(2).all(|two| two[1] == two[0] + 1)
    }
}

/// `Value` and a divisor that give u: the value is what was put in.
fn value_is_used(grid: &Grid, located: &mut Located) {
    let value = at(located, Role::Value)
        .filter(|value| !located.has(Role::Used) && gives_u(grid, located, *value));
    let mut columns = located.columns.iter_mut();
    if let Some(column) = columns.find(|c| Some(c.index) == value) {
        column.role = Role::Used;
    }
}

/// Columns of words whose heads say nothing: short ones in front are symbols, long ones are remarks.
fn nameless_words(grid: &Grid, located: &mut Located) {
    let width = grid.rows[located.head].len();
    for index in 0..width {
        if located.columns.iter().any(|c| c.index == index) {
            continue;
        }
        let cells = Cells {
            grid,
            rows: &located.rows,
            index,
        };
        let head = grid.cell(located.head, index).text.clone();
        let in_front = |index: usize| located.columns.iter().all(|c| index <= c.index);
        let short = |text: &str| !text.is_empty() && text.chars().count() <= 8 && !is_figure(text);
        let role = if cells.mostly(is_words) {
            Role::Remark
        } else if !located.has(Role::Symbol)
            && !located.has(Role::Type)
            && cells.mostly(short)
            && in_front(index)
        {
            Role::Symbol
        } else {
            continue;
        };
        located.columns.push(Column {
            index,
            role,
            head,
            unit: String::new(),
        });
    }
}

fn at(located: &Located, role: Role) -> Option<usize> {
    located.column(role).map(|column| column.index)
}

/// A column of figures whose head says nothing that is known is the ± column, if there is none and it is the only one, or
/// gives u by the divisor.
pub(super) fn nameless_figures(grid: &Grid, located: &mut Located) {
    if located.has(Role::Used) {
        return;
    }
    let numeric = |index: usize| {
        let figures = located
            .rows
            .iter()
            .filter(|row| Printed::parse(&grid.cell(**row, index).text).is_some());
        2 * figures.count() > located.rows.len()
    };
    let known = |index: usize| located.columns.iter().any(|c| c.index == index);
    let open: Vec<usize> = grid
        .filled(located.head)
        .map(|(i, _)| i)
        .filter(|i| !known(*i) && numeric(*i) && !grid.hidden_columns.contains(i))
        .collect();
    let divided = open.iter().find(|index| gives_u(grid, located, **index));
    let only = (open.len() == 1).then(|| &open[0]);
    if let Some(&index) = divided.or(only) {
        let head = grid.cell(located.head, index).text.clone();
        let unit = columns::apart(&head).1;
        located.columns.push(Column {
            index,
            role: Role::Used,
            head,
            unit,
        });
    }
}

/// Whether the figures of a column give those of u by the divisor, or those of the contribution by the coefficient, too.
fn gives_u(grid: &Grid, located: &Located, index: usize) -> bool {
    let coefficient = at(located, Role::C).filter(|_| !located.has(Role::U));
    let made = at(located, Role::U).or(at(located, Role::Contribution));
    let (Some(divisor), Some(u)) = (at(located, Role::Divisor), made) else {
        return false;
    };
    let figure = |row: usize, index: usize| {
        Printed::parse(&grid.cell(row, index).text).map(|figure| figure.value)
    };
    let divides = |row: &&usize| {
        let pair = figure(**row, index).zip(figure(**row, divisor));
        let c = coefficient.and_then(|c| figure(**row, c)).unwrap_or(1.0);
        let quotient = pair.map(|(a, d)| (c * a / d).abs());
        let pair = quotient.zip(figure(**row, u).map(f64::abs));
        pair.is_some_and(|(q, u)| (q - u).abs() <= 0.05 * u)
    };
    2 * located.rows.iter().filter(divides).count() > located.rows.len()
}
