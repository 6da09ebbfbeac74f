//! What stands in a column, where its head is doubtful.

use crate::printed::Printed;
use crate::read::columns::{self, Role};
use crate::sheet::Grid;
use crate::units;

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
        } else if (is_name(role)
            || role == Role::Type
            || role == Role::Remark && may_be_used(grid, located, index))
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
    uncertainty_is_divided(grid, located);
    value_is_used(grid, located);
    u_is_used(grid, located);
    without_coefficient(grid, located);
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

/// Words, or what they come to without any: `s = 0.004 mm`.
fn is_statement(text: &str) -> bool {
    is_words(text) || text.contains('=')
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

/// `Value | Divisor | Uncertainty`: what is called an uncertainty, and not which, is u where the divisor makes it of the figures of
/// another column, which are what was put in.
fn uncertainty_is_divided(grid: &Grid, located: &mut Located) {
    let bare = located
        .columns
        .iter()
        .find(|column| columns::is_bare_uncertainty(&column.head));
    let (Some(divisor), Some(of), false) = (
        at(located, Role::Divisor),
        bare.map(|column| column.index),
        located.has(Role::U),
    ) else {
        return;
    };
    let role = |index: usize| {
        let mut columns = located.columns.iter();
        columns.find(|column| column.index == index).map(|c| c.role)
    };
    let may_be_put_in = |index: &usize| {
        let open = [Role::Value, Role::Used, Role::Derived, Role::Remark];
        *index != of && role(*index).is_none_or(|role| open.contains(&role))
    };
    let made = Made {
        of,
        coefficient: None,
    };
    let is_divided = |index: &usize| {
        let figure = |row: &usize, index: usize| grid.cell(*row, index).figure();
        let changes = |row: &usize| {
            let pair = figure(row, *index).zip(figure(row, of));
            pair.is_some_and(|(a, u)| a.value != u.value)
        };
        made.comes_of(grid, located, *index, divisor) && located.rows.iter().any(changes)
    };
    let heads = grid.filled(located.head).map(|(index, _)| index);
    let Some(used) = heads.filter(may_be_put_in).find(is_divided) else {
        return;
    };
    let head = grid.cell(located.head, used).text.clone();
    let unit = columns::apart(&head).1;
    located.columns.retain(|column| column.index != used);
    for column in &mut located.columns {
        if column.index == of {
            column.role = Role::U;
        } else if column.role == Role::Used {
            column.role = Role::Derived;
        }
    }
    located.columns.push(Column {
        index: used,
        role: Role::Used,
        head,
        unit,
    });
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

/// `u | Divisor | Contribution`: what is called u was divided, where every contribution shows it, and is no contribution as it
/// stands.
fn u_is_used(grid: &Grid, located: &mut Located) {
    let roles = [Role::U, Role::Divisor, Role::Contribution];
    let indices: Vec<usize> = roles.iter().filter_map(|role| at(located, *role)).collect();
    let [u, divisor, made] = indices[..] else {
        return;
    };
    if located.has(Role::Used) {
        return;
    }
    let c = at(located, Role::C);
    let row = |row: &usize| {
        let figure = |index: usize| grid.cell(*row, index).figure();
        let c = match c {
            Some(c) => figure(c)?.value,
            None => 1.0,
        };
        let (u, divisor, made) = (figure(u)?, figure(divisor)?, figure(made)?);
        let meets = |x: f64| made.is_met_within(x.copysign(made.value), 2.0 * made.half);
        Some((meets(c * u.value / divisor.value), meets(c * u.value)))
    };
    // The row of the result has no divisor.
    let rows: Vec<(bool, bool)> = located.rows.iter().filter_map(row).collect();
    let is_divided = rows.iter().all(|(divided, _)| *divided) && rows.iter().any(|(_, own)| !own);
    let mut columns = located.columns.iter_mut();
    if let Some(column) = columns.find(|column| is_divided && column.index == u) {
        column.role = Role::Used;
    }
}

/// `c_i | u_i`: what is behind the coefficient is the contribution, unless the ± and the divisor give it without the
/// coefficient.
fn without_coefficient(grid: &Grid, located: &mut Located) {
    let roles = [Role::Used, Role::Divisor, Role::C, Role::Contribution];
    let indices: Vec<usize> = roles.iter().filter_map(|role| at(located, *role)).collect();
    let [used, divisor, c, made] = indices[..] else {
        return;
    };
    if located.has(Role::U) {
        return;
    }
    let gives = |with_coefficient: bool| {
        let met = located.rows.iter().filter(|row| {
            let value = |index: usize| Some(grid.cell(**row, index).figure()?.value);
            let product = || {
                let c = value(c).filter(|_| with_coefficient).unwrap_or(1.0);
                Some((
                    (c * value(used)? / value(divisor)?).abs(),
                    value(made)?.abs(),
                ))
            };
            product().is_some_and(|(x, made)| (x - made).abs() <= 0.05 * made)
        });
        met.count()
    };
    let is_u = gives(false) > gives(true);
    let mut columns = located.columns.iter_mut();
    if let Some(column) = columns.find(|c| is_u && c.index == made && columns::is_bare_u(&c.head)) {
        column.role = Role::U;
    }
}

/// `Divisor | c_i | Std. unc. (µm)`: what is called u is the contribution where the ± and the divisor give it with the
/// coefficient, and in no row without.
pub(super) fn with_coefficient(grid: &Grid, located: &mut Located) {
    let roles = [Role::Used, Role::Divisor, Role::C, Role::U];
    let indices: Vec<usize> = roles.iter().filter_map(|role| at(located, *role)).collect();
    let [used, divisor, c, u_column] = indices[..] else {
        return;
    };
    if located.has(Role::Contribution) {
        return;
    }
    let is_made = |row: &usize| {
        let figure = |index: usize| grid.cell(*row, index).figure();
        let (a, divisor, c, u) = (
            figure(used)?,
            figure(divisor)?,
            figure(c)?,
            figure(u_column)?,
        );
        let unit_of = |index: usize| located.unit_in(grid, *row, index);
        let to_u = units::factor(&unit_of(used), &unit_of(u_column)).unwrap_or(1.0);
        let is_u = |x: f64| u.is_met_within(x.abs(), u.half + 0.01 * u.value.abs());
        // The coefficient may hold the conversion of units.
        let gives = |x: f64| is_u(x) || is_u(to_u * x);
        let alone = a.value / divisor.value;
        Some((gives(c.value * alone), gives(alone)))
    };
    let rows: Vec<(bool, bool)> = located.rows.iter().filter_map(is_made).collect();
    let shows = |with: bool| rows.contains(&(with, !with));
    let is_contribution = shows(true) && !shows(false);
    let mut columns = located.columns.iter_mut();
    if let Some(column) = columns.find(|column| is_contribution && column.index == u_column) {
        column.role = Role::Contribution;
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
        let role = if cells.mostly(is_statement) {
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
    let only = (open.len() == 1 && may_be_divided(grid, located, open[0])).then(|| &open[0]);
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

/// Columns from which a ± column tells itself: what was made of it, and the coefficient that is in that.
struct Made {
    of: usize,
    coefficient: Option<usize>,
}

impl Made {
    fn of(located: &Located) -> Option<Made> {
        let coefficient = at(located, Role::C).filter(|_| !located.has(Role::U));
        let of = at(located, Role::U).or(at(located, Role::Contribution))?;
        Some(Made { of, coefficient })
    }

    /// c·a of a row in the unit of what was made of it, and that, where both units are known.
    fn converted(
        &self,
        grid: &Grid,
        located: &Located,
        row: usize,
        index: usize,
    ) -> Option<(f64, f64)> {
        let unit_of = |index: usize| located.unit_in(grid, row, index);
        let factor = units::factor(&unit_of(index), &unit_of(self.of))?;
        let (a, made) = self.pair(grid, row, index)?;
        Some((a * factor, made))
    }

    /// Whether it comes of the figures of a column by the divisors of another.
    fn comes_of(&self, grid: &Grid, located: &Located, index: usize, divisor: usize) -> bool {
        let divides = |row: &&usize| {
            let divisor = grid
                .cell(**row, divisor)
                .figure()
                .map(Printed::into_divisor);
            let mut pairs = [
                self.pair(grid, **row, index),
                self.converted(grid, located, **row, index),
            ]
            .into_iter()
            .flatten();
            let is_u =
                |(a, u): (f64, f64), divisor: &Printed| (a / divisor.value - u).abs() <= 0.05 * u;
            divisor.is_some_and(|divisor| pairs.any(|pair| is_u(pair, &divisor)))
        };
        // An estimate that happens to do so is rare: half of the rows are enough, as one of two of which the other has a slip.
        let count = located.rows.iter().filter(divides).count();
        count > 0 && 2 * count >= located.rows.len()
    }

    /// c·a of a row, and what was made of it, as far as their units allow to compare them.
    fn pair(&self, grid: &Grid, row: usize, index: usize) -> Option<(f64, f64)> {
        let figure = |index: usize| grid.cell(row, index).figure();
        let (a, made) = (figure(index)?, figure(self.of)?);
        let c = self.coefficient.and_then(figure);
        let units = [&a.unit, &made.unit];
        let alike = units.iter().any(|unit| unit.is_empty())
            || c.is_some()
            || units::factor(units[0], units[1]) == Some(1.0);
        let product = a.value * c.map_or(1.0, |c| c.value);
        alike.then_some((product.abs(), made.value.abs()))
    }
}

/// Whether the figures of a column are what the laboratory went on with: by its divisors, where it has some.
fn may_be_used(grid: &Grid, located: &Located, index: usize) -> bool {
    match located.has(Role::Divisor) && located.is_evaluated() {
        true => gives_u(grid, located, index),
        false => may_be_divided(grid, located, index),
    }
}

/// Whether a divisor may have made the other figures of those of a column: not more than they are, and not less than a
/// tenth. A relative column beside an absolute one is none that was divided.
fn may_be_divided(grid: &Grid, located: &Located, index: usize) -> bool {
    let Some(made) = Made::of(located) else {
        return true;
    };
    let divided = |row: &&usize| {
        let pair = made.pair(grid, **row, index);
        pair.is_some_and(|(a, u)| (0.99..=10.1).contains(&(a / u)))
    };
    2 * located.rows.iter().filter(divided).count() > located.rows.len()
}

/// Whether the figures of a column give those of u by the divisor, or those of the contribution by the coefficient, too.
fn gives_u(grid: &Grid, located: &Located, index: usize) -> bool {
    let pair = at(located, Role::Divisor).zip(Made::of(located));
    pair.is_some_and(|(divisor, made)| made.comes_of(grid, located, index, divisor))
}
