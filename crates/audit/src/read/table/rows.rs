//! The rows of a table with their figures.

use crate::claim::{Figure, Row};
use crate::printed::{Place, Printed};
use crate::read::columns::{Role, names_factor};
use crate::read::footer::{self, Whole};
use crate::read::words::{alone, has};
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
    pub(super) divisor_is_factor: bool,
    pub(super) readings: Option<f64>,
    /// Its number in the list, as the sheet has it.
    number: String,
    /// The ± column stands in a table of what is known, apart from the evaluation.
    pub(super) stated_apart: bool,
    /// u/x, where a column beside u has it.
    pub(super) relative: Option<Printed>,
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
                // The row of the result has digits of its own.
                .filter(|raw| raw.is_input())
                .filter_map(|raw| column(&mut raw.row).as_mut())
                .collect(),
        );
    }
    for column in &columns[1..] {
        let inputs = rows.iter_mut().filter(|raw| raw.is_input());
        let figures = inputs.filter_map(|raw| column(&mut raw.row).as_mut());
        whole_figures_have_decimals(figures.filter(|figure| figure.value != 0.0).collect());
    }
    for Raw { row, .. } in &mut rows {
        let figures = [
            &mut row.value,
            &mut row.used,
            &mut row.u,
            &mut row.c,
            &mut row.contribution,
        ];
        for figure in figures {
            *figure = figure.take().map(units::with_power);
        }
    }
    parts_are_not_counted(&mut rows);
    rows
}

/// Rows 1.1 and 1.2, or u_11 and u_12, below a row 1 that is the root of the sum of their squares, or the larger of them,
/// are in it already; so are rows without estimate and coefficient right below one that has them, and is the root.
fn parts_are_not_counted(rows: &mut [Raw]) {
    for whole in 0..rows.len() {
        let numbered = (whole + 1..rows.len()).filter(|part| rows[*part].is_part_of(&rows[whole]));
        let mut parts: Vec<usize> = numbered.collect();
        let by_place =
            parts.is_empty() && rows[whole].row.value.is_some() && rows[whole].row.c.is_some();
        if by_place {
            let is_bare = |part: &usize| {
                let row = &rows[*part].row;
                row.value.is_none() && row.c.is_none()
            };
            parts = (whole + 1..rows.len()).take_while(is_bare).collect();
        }
        let u = |i: usize| rows[i].row.u.as_ref().map(|u| (u.value, u.half));
        let (Some((own, half)), Some(of_parts)) = (
            u(whole),
            parts.iter().map(|i| u(*i)).collect::<Option<Vec<_>>>(),
        ) else {
            continue;
        };
        let root = libm::sqrt(of_parts.iter().map(|(u, _)| u * u).sum());
        let largest = match by_place {
            true => root,
            false => of_parts.iter().map(|(u, _)| *u).fold(0.0, f64::max),
        };
        let open = half + of_parts.iter().map(|(_, half)| *half).fold(0.0, f64::max);
        if parts.len() >= 2 && [root, largest].iter().any(|u| (u - own).abs() <= open) {
            let why = format!("in row {}", rows[whole].row.label());
            let c = rows[whole].row.c.clone().filter(|_| by_place);
            for part in parts {
                let row = &mut rows[part].row;
                row.not_counted = Some(why.clone());
                // Its coefficient is that of the quantity.
                row.c = row.c.take().or_else(|| c.clone());
            }
        }
    }
}

/// Who writes `0.577` and `6.1` in a column does not mean 1.4 by `1`: a cell without a format has lost the zeros behind the
/// point. Figures of one whole digit have as many decimals as the others that have some, if these are more.
fn whole_figures_have_decimals(column: Vec<&mut Printed>) {
    let (whole, others): (Vec<&mut Printed>, Vec<&mut Printed>) = column
        .into_iter()
        .partition(|figure| figure.half == 0.5 && figure.value < 10.0);
    let others = others.iter().filter(|figure| figure.half < 0.5);
    let others: Vec<f64> = others.map(|figure| figure.half).collect();
    let fewest = others.iter().copied().fold(0.0, f64::max);
    if others.len() <= whole.len() || fewest <= 0.0 {
        return;
    }
    for figure in whole {
        let decimals = libm::round(libm::log10(figure.half / fewest)) as usize;
        figure.half = fewest;
        figure.digits += decimals;
    }
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
    let unit_beside = |index: usize| unit_beside(grid, row, located, index);
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
            figure.unit = unit_beside(column.index).to_string();
        }
        figure.unit = alone(&figure.unit).to_string();
        let is_power = units::power_of_ten(&figure.unit).is_some();
        if units::parse(&figure.unit).is_none() && !is_power && !matches!(role, Role::C) {
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
    // `Mass of the standard m_S` in a column of quantities is a name, `d_acquisition` is not.
    let is_identifier =
        symbol.contains('_') && symbol.chars().all(|c| c.is_alphanumeric() || c == '_');
    let long = symbol.contains(' ') || symbol.chars().count() > 12 && !is_identifier;
    let (symbol, name) = if name.is_empty() && long {
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
        let unit = unit_beside(column).to_string();
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
        divisor_is_factor: located
            .column(Role::Divisor)
            .is_some_and(|c| names_factor(&c.head)),
        readings: figure(Role::Readings).map(|n| n.value),
        number: text(Role::Number),
        stated_apart: false,
        relative: derived(grid, row, located, footer::is_relative),
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
            dof: figure(Role::Dof).map(as_infinite),
            unit: alone(unit_beside(0)).to_string(),
            is_hidden: grid.hidden_rows.contains(&row),
            distribution: text(Role::Distribution),
            share: derived(grid, row, located, is_share),
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

/// The unit that the columns of units have for a figure: of several the one behind it, else the last in front of it.
fn unit_beside<'g>(grid: &'g Grid, row: usize, located: &Located, index: usize) -> &'g str {
    let units = located.columns.iter().filter(|c| c.role == Role::Unit);
    let mut units: Vec<usize> = units.map(|c| c.index).collect();
    units.sort_unstable();
    let behind = units.iter().find(|unit| **unit == index + 1);
    let in_front = || units.iter().rev().find(|unit| **unit < index);
    let unit = behind.or_else(in_front).or(units.first());
    unit.map_or("", |unit| grid.cell(row, *unit).text.trim())
}

/// Whether a head of what was computed from others is that of shares in the variance.
fn is_share(head: &str) -> bool {
    let lower = head.to_lowercase();
    let said = has(&lower, &["share", "index", "percent"])
        || lower.contains(['%', '％'])
        || has(&lower, &["贡献率", "占比", "百分比"]);
    said && !footer::is_relative(head)
}

/// The figure of a row in the first column of what was computed from others whose head is so called.
fn derived(grid: &Grid, row: usize, located: &Located, is: fn(&str) -> bool) -> Option<Printed> {
    let mut columns = located.columns.iter();
    let column = columns.find(|c| c.role == Role::Derived && is(&c.head))?;
    let figure = Printed::parse(&grid.cell(row, column.index).text)?;
    let unit = match figure.unit.as_str() {
        "" => column.unit.clone(),
        _ => figure.unit.clone(),
    };
    Some(Printed { unit, ..figure })
}

/// Degrees of freedom from here on are as good as infinitely many: spreadsheets write `1E+99`.
fn as_infinite(dof: Printed) -> Printed {
    const MANY: f64 = 1e5;
    let value = if dof.value >= MANY {
        f64::INFINITY
    } else {
        dof.value
    };
    Printed { value, ..dof }
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
            divisor_is_factor: false,
            readings: None,
            number: String::new(),
            stated_apart: true,
            relative: None,
        }
    }

    /// Whether the number of a row, or the index of its symbol, is one below that of another.
    fn is_part_of(&self, whole: &Raw) -> bool {
        let index = |raw: &Raw| {
            let index = raw.row.symbol.strip_prefix('u')?.trim_start_matches('_');
            let is_index = !index.is_empty() && index.bytes().all(|b| b.is_ascii_digit());
            is_index.then(|| index.to_string())
        };
        let numbered = |part: &str, whole: &str| {
            let below = part.strip_prefix(whole).unwrap_or_default();
            !whole.is_empty() && below.strip_prefix('.').is_some_and(|n| !n.is_empty())
        };
        let indexed =
            |part: String, whole: String| part.len() == whole.len() + 1 && part.starts_with(&whole);
        numbered(&self.number, &whole.number)
            || index(self)
                .zip(index(whole))
                .is_some_and(|(part, whole)| indexed(part, whole))
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
        if row.divisor.is_none() {
            row.divisor.clone_from(&known.divisor);
            self.divisor_is_factor = input.divisor_is_factor;
        }
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

    /// Whether the row is called the result, and has nothing that an input has.
    pub fn is_result(&self, measurand: &str) -> bool {
        let row = &self.row;
        let named = !measurand.is_empty() && row.symbol == measurand;
        let y = matches!(row.symbol.as_str(), "y" | "Y")
            || has(
                &row.name.to_lowercase(),
                &[
                    "result",
                    "measurand",
                    "ergebnis",
                    "résultat",
                    "结果",
                    "被测量",
                ],
            );
        let input = row.used.is_some() || row.c.is_some() || row.divisor.is_some();
        let figure = row.contribution.is_some() || row.u.is_some() || row.value.is_some();
        (named || y) && !input && figure
    }

    /// What an input has and a result has not: how it is distributed, what it was divided by, how it enters.
    fn is_input(&self) -> bool {
        let row = &self.row;
        let said = self.columns_text.contains(|c: char| c.is_alphanumeric());
        said || row.used.is_some() || row.c.is_some() || row.divisor.is_some()
    }

    /// The contribution that its row states, without its sign.
    fn part(&self) -> Option<f64> {
        let row = &self.row;
        let c = row.c.as_ref().map_or(1.0, |c| c.value);
        let of_u = row.u.as_ref().map(|u| c * u.value);
        let part = row.contribution.as_ref().map(|part| part.value).or(of_u);
        part.map(f64::abs)
    }
}

/// The last row, where it has nothing of what the others have and its figures come of theirs: it closes the table.
pub fn closing(rows: &[Raw]) -> Option<usize> {
    let (last, others) = rows.split_last()?;
    let inputs = others.iter().filter(|raw| raw.is_input()).count();
    let row = &last.row;
    // A result that is its only input is called the same.
    let is_again = others.iter().any(|raw| raw.row.label() == row.label());
    let few = others.len() < 2 && !is_again && !repeats(row, others);
    if few || 2 * inputs <= others.len() || last.is_input() {
        return None;
    }
    // `u(E)` below names that are no symbols of uncertainties.
    let of_result = |row: &Row| row.label().starts_with("u(") || row.label().starts_with("u_c(");
    let is_symbol = of_result(row) && !others.iter().any(|raw| of_result(&raw.row));
    let is_called = is_standard(row) && !others.iter().any(|raw| is_standard(&raw.row));
    let has_both = row.value.is_some() && row.contribution.is_some() && row.u.is_none();
    let figures = [&row.value, &row.u, &row.contribution];
    let is_made = figures
        .into_iter()
        .flatten()
        .any(|figure| times(figure, others).is_some());
    let closes = has_both || is_made || is_symbol || is_called || is_sum(row, others);
    closes.then_some(others.len())
}

/// Whether u or the contribution of a row is the contribution of the only other one, which has a coefficient.
fn repeats(row: &Row, others: &[Raw]) -> bool {
    let [only] = others else {
        return false;
    };
    let part = row.contribution.as_ref().or(row.u.as_ref());
    let part = part.map(|part| part.value.abs());
    only.row.c.is_some() && part.is_some() && part == only.part()
}

/// Whether a row is called a standard uncertainty, as that of the whole is in short.
fn is_standard(row: &Row) -> bool {
    const WORDS: [&str; 4] = [
        "standard uncertainty",
        "standardunsicherheit",
        "incertitude-type",
        "标准不确定度",
    ];
    let label = row.label().to_lowercase();
    WORDS.iter().any(|word| label.starts_with(word))
}

/// Whether the estimate of a row is made of those of others: their sum with any signs, or the largest of them with small
/// corrections.
fn is_sum(row: &Row, others: &[Raw]) -> bool {
    let values = others.iter().filter_map(|raw| raw.row.value.as_ref());
    let values: Vec<f64> = values.map(|value| value.value.abs()).collect();
    let largest = values.iter().copied().fold(0.0_f64, f64::max);
    let rest: f64 = values.iter().sum::<f64>() - largest;
    let near = |value: &Printed| (value.value.abs() - largest).abs() <= rest + value.half;
    // What is made of all is not known better than the worst of them.
    let worst = others.iter().filter_map(Raw::part).fold(0.0_f64, f64::max);
    let made = [&row.u, &row.contribution].into_iter().flatten();
    if made.into_iter().any(|figure| figure.value.abs() < worst) {
        return false;
    }
    let first = row.value.as_ref();
    first.is_some_and(|value| value.value != 0.0 && rest < 0.5 * largest && near(value))
}

/// How many times the root of the sum of squares of other rows a figure is: once for u_c, k times for U.
fn times(figure: &Printed, others: &[Raw]) -> Option<f64> {
    let counted = others.iter().filter(|raw| raw.row.not_counted.is_none());
    let squares = counted.map(|raw| raw.part().map_or(0.0, |part| part * part));
    let root = libm::sqrt(squares.sum());
    let open = 0.02 + figure.relative_half().min(0.05);
    let near = |k: &f64| (figure.value / (k * root) - 1.0).abs() <= open;
    [1.0, 2.0, 3.0].into_iter().find(near)
}

/// What the figures of the row of the result are.
pub fn figures_of_result(row: Row, others: &[Raw]) -> Vec<(Whole, Printed)> {
    let u = row.contribution.or(row.u);
    let of_u = |figure: &Printed| match times(figure, others) {
        Some(k) if k > 1.0 => Whole::Expanded,
        _ => Whole::Combined,
    };
    // `V_X | 0.000055 V`: what alone stands in the column of estimates may be u_c.
    let of_value = |value: &Printed| match times(value, others) {
        Some(_) if u.is_none() => of_u(value),
        _ => Whole::Y,
    };
    let value = row.value.map(|value| (of_value(&value), value));
    let u = u.map(|u| (of_u(&u), u));
    let dof = row.dof.map(|dof| (Whole::Freedom, dof));
    [value, u, dof].into_iter().flatten().collect()
}
