//! Where a table stands, its rows and its footer.

use std::collections::BTreeSet;
use std::ops::Range;

use super::mapping::Mapping;
use crate::claim::{Claimed, Figure, Relative, Row, Stated, Understood};
use crate::printed::{Place, Printed};
use crate::sheet::Grid;
use crate::units;

use super::columns::{self, Role};
use super::footer::{self, Whole};
use super::kind::{self, Evidence};
use super::words::has;

/// A table that was found.
#[derive(Debug, Clone)]
pub struct Located {
    /// Row of its head.
    pub head: usize,
    /// Behind its last row.
    pub end: usize,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Unit of the contributions, where the head has one.
    pub unit: String,
    /// Rows of the sheet that are rows of the budget.
    rows: Vec<usize>,
    /// Rows that are the head, a row of the budget or its footer.
    used: BTreeSet<usize>,
}

/// A column that was understood.
#[derive(Debug, Clone)]
pub struct Column {
    index: usize,
    role: Role,
    head: String,
    unit: String,
}

/// A row with what is needed to interpret it.
#[derive(Debug, Clone)]
pub struct Raw {
    /// Its figures.
    pub row: Row,
    columns_text: String,
    used_head: String,
    readings: Option<f64>,
    /// The ± column stands in a table of what is known, apart from the evaluation.
    stated_apart: bool,
}

impl Located {
    /// Rows that are no text beside the table.
    pub fn is_used(&self, row: usize) -> bool {
        self.used.contains(&row)
    }

    /// How its columns were understood.
    pub fn understood(&self, grid: &Grid, sheet: usize) -> Vec<Understood> {
        let place = |column: usize| Place {
            sheet,
            row: self.head,
            column,
        };
        let known = self.columns.iter().map(|c| Understood {
            at: place(c.index),
            text: c.head.clone(),
            role: c.role.name(),
        });
        let unknown = grid
            .filled(self.head)
            .filter(|(i, _)| !self.columns.iter().any(|c| c.index == *i));
        let unknown = unknown.map(|(i, cell)| Understood {
            at: place(i),
            text: cell.text.clone(),
            role: "?",
        });
        known.chain(unknown).collect()
    }

    fn column(&self, role: Role) -> Option<&Column> {
        self.columns.iter().find(|column| column.role == role)
    }

    /// Whether it has figures that were computed for each row.
    pub fn is_evaluated(&self) -> bool {
        self.has(Role::U) || self.has(Role::Contribution)
    }

    fn has(&self, role: Role) -> bool {
        self.column(role).is_some()
    }

    fn unit(&self, role: Role) -> &str {
        self.column(role).map_or("", |column| &column.unit)
    }
}

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
                second_line(grid, &mut located, mapping);
                body(grid, &mut located, mapping);
                row = located.end.max(row + 1);
                by_content(grid, &mut located);
                nameless_figures(grid, &mut located);
                if !located.rows.is_empty() {
                    located.unit = located.unit(Role::Contribution).to_string();
                    found.push(located);
                }
            }
            None => row += 1,
        }
    }
    found
}

/// The columns of a row that is a head.
fn head(grid: &Grid, row: usize, mapping: &Mapping) -> Option<Vec<Column>> {
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
fn second_line(grid: &Grid, located: &mut Located, mapping: &Mapping) {
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
    if units * 2 > filled.len() {
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

fn body(grid: &Grid, located: &mut Located, mapping: &Mapping) {
    /// Lines of other kinds that may stand between the rows of one table: a blank one, a subheading.
    const STRANGE: usize = 2;
    let mut strange = 0;
    for row in located.end..grid.rows.len() {
        let repeated = head(grid, row, mapping).is_some();
        if repeated || labels_across(grid, row, "") {
            break;
        }
        match what(grid, row, located, strange == 0) {
            What::Row => {
                located.rows.push(row);
                located.used.insert(row);
            }
            What::Footer => {}
            What::Other => {
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

/// What stands in a column decides where its head is doubtful: figures below a name are what was put in, running numbers
/// are no names, and words below a head that says nothing are remarks.
fn by_content(grid: &Grid, located: &mut Located) {
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
    if located.has(Role::Used) {
        return;
    }
    let (Some(value), Some(divisor), Some(u)) = (
        at(located, Role::Value),
        at(located, Role::Divisor),
        at(located, Role::U),
    ) else {
        return;
    };
    let figure =
        |row: usize, index: usize| Printed::parse(&grid.cell(row, index).text).map(|p| p.value);
    let divides = |row: &&usize| {
        let pair = figure(**row, value).zip(figure(**row, divisor));
        let quotient = pair.map(|(a, d)| a / d);
        let pair = quotient.zip(figure(**row, u));
        pair.is_some_and(|(q, u)| (q - u).abs() <= 0.05 * u.abs())
    };
    if 2 * located.rows.iter().filter(divides).count() > located.rows.len() {
        let mut columns = located.columns.iter_mut();
        if let Some(column) = columns.find(|c| c.index == value) {
            column.role = Role::Used;
        }
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
        let short = |text: &str| !text.is_empty() && text.chars().count() <= 8 && !is_figure(text);
        let role = if cells.mostly(is_words) {
            Role::Remark
        } else if head.is_empty() && !located.has(Role::Symbol) && cells.mostly(short) {
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

/// A column of figures whose head says nothing that is known is the ± column, if there is none and it is the only one.
fn nameless_figures(grid: &Grid, located: &mut Located) {
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
    let mut open = grid
        .filled(located.head)
        .filter(|(i, _)| !known(*i) && numeric(*i));
    if let (Some((index, cell)), None) = (open.next(), open.next()) {
        let (head, unit) = (cell.text.clone(), columns::apart(&cell.text).1);
        located.columns.push(Column {
            index,
            role: Role::Used,
            head,
            unit,
        });
    }
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
    let count = Role::ALL
        .iter()
        .filter(|role| role.is_figure() && figure(**role))
        .count();
    // Words about a row, its figures and its distribution label nothing.
    let labels = |column: usize| {
        use Role::{Distribution, Remark, Used, Value};
        let role = located.columns.iter().find(|c| c.index == column);
        role.is_none_or(|c| !matches!(c.role, Remark | Value | Used | Distribution))
    };
    let first = grid.filled(row).next().map_or(0, |(column, _)| column);
    let labelled = grid.filled(row).take(3).any(|(column, cell)| {
        (column == first || labels(column))
            && footer::label(&cell.text, "").is_some()
            && Printed::parse(&cell.text).is_none()
    });
    let inputs = figure(Role::Used) || figure(Role::C);
    let explained = !text(Role::Distribution).is_empty()
        && !text(Role::Distribution).to_lowercase().contains("k")
        || text(Role::Type).len() == 1;
    let strong = [text(Role::Symbol), text(Role::Name), text(Role::Number)]
        .iter()
        .any(|t| {
            let lower = t.to_lowercase();
            has(
                &lower,
                &[
                    "combined",
                    "expanded uncertainty u",
                    "effective degrees",
                    "coverage factor",
                    "合成标准不确定度",
                    "合成不确定度",
                    "有效自由度",
                    "包含因子",
                ],
            ) || lower.starts_with("expanded uncertainty")
                || lower.starts_with("扩展不确定度")
                || matches!(
                    t.trim(),
                    "u_c" | "uc" | "U" | "k" | "u_c(y)" | "ν_eff" | "νeff"
                )
        });
    if labelled && (strong && !figure(Role::C) || !inputs && !explained) {
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

/// The rows of a table with their figures.
pub fn rows(grid: &Grid, sheet: usize, located: &Located) -> Vec<Raw> {
    let mut above = String::new();
    located
        .rows
        .iter()
        .map(|&row| {
            let raw = raw(grid, sheet, row, located, &above);
            if !raw.row.name.is_empty() {
                above.clone_from(&raw.row.name);
            }
            raw
        })
        .collect()
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
    let unit_cell = text(Role::Unit);
    let figure = |role: Role| -> Option<Printed> {
        let column = located.column(role)?;
        let cell = grid.cell(row, column.index);
        let mut figure = Printed::parse(&cell.text)?.at(Place {
            sheet,
            row,
            column: column.index,
        });
        if figure.unit.is_empty() {
            figure.unit.clone_from(&column.unit);
        }
        if figure.unit.is_empty() && matches!(role, Role::Value | Role::Used | Role::U) {
            figure.unit = unit_cell
                .split(';')
                .next()
                .unwrap_or_default()
                .trim()
                .to_string();
        }
        if units::parse(&figure.unit).is_none() && !matches!(role, Role::C) {
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
    // `Mass of the standard m_S` in a column of quantities is a name.
    let (symbol, name) = if name.is_empty() && (symbol.contains(' ') || symbol.chars().count() > 12)
    {
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
        let unit = unit_cell
            .split(';')
            .next()
            .unwrap_or_default()
            .trim()
            .to_string();
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
        readings: figure(Role::Readings).map(|n| n.value),
        stated_apart: false,
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
            dof: figure(Role::Dof),
            unit: unit_cell,
            is_hidden: grid.hidden_rows.contains(&row),
            distribution: text(Role::Distribution),
            share: share(grid, row, located),
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

/// The share of a row in the variance, where a column has it.
fn share(grid: &Grid, row: usize, located: &Located) -> Option<Printed> {
    let is_share = |head: &str| {
        let head = head.to_lowercase();
        has(&head, &["share", "index", "percent"])
            || head.contains(['%', '％'])
            || has(&head, &["贡献率", "占比", "百分比"])
    };
    let mut columns = located.columns.iter();
    let column = columns.find(|c| c.role == Role::Derived && is_share(&c.head))?;
    Printed::parse(&grid.cell(row, column.index).text)
}

fn positive(mut figure: Printed) -> Printed {
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
            readings: None,
            stated_apart: true,
        }
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
        row.divisor = row.divisor.take().or_else(|| known.divisor.clone());
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

    /// Whether the row is that of the result: its name, or nothing that an input has.
    pub fn is_result(&self, measurand: &str, is_last: bool) -> bool {
        let row = &self.row;
        let named = !measurand.is_empty() && row.symbol == measurand;
        let input = row.used.is_some() || row.c.is_some() || row.divisor.is_some();
        let y = matches!(row.symbol.as_str(), "y" | "Y")
            || has(
                &row.name.to_lowercase(),
                &["result", "measurand", "结果", "被测量"],
            );
        // The last row has what no input lacks, and nothing of what an input has.
        let closing =
            is_last && row.contribution.is_some() && row.u.is_none() && row.value.is_some();
        (named || y || closing)
            && !input
            && (row.contribution.is_some() || row.u.is_some() || row.value.is_some())
    }
}

/// The claimed figures in some rows of the sheet. Rows that were used are no text any more.
pub fn footers(
    grid: &Grid,
    sheet: usize,
    located: &mut Located,
    rows: Range<usize>,
    skip: impl Fn(usize) -> bool,
    claimed: &mut Claimed,
) {
    for row in rows {
        let of_table = located.rows.contains(&row) || row == located.head;
        if !of_table && !skip(row) && footer_row(grid, sheet, row, located, claimed) {
            located.used.insert(row);
        }
    }
}

fn footer_row(
    grid: &Grid,
    sheet: usize,
    row: usize,
    located: &Located,
    claimed: &mut Claimed,
) -> bool {
    let cells: Vec<(usize, String)> = grid
        .filled(row)
        .map(|(i, cell)| (i, cell.text.clone()))
        .collect();
    let of_row = |text: &str| {
        let mut rows = claimed.rows.iter();
        rows.any(|row| !row.symbol.is_empty() && row.symbol == text)
    };
    if cells.len() < 2 || of_row(&cells[0].1) {
        return false;
    }
    let inside = located.used.contains(&row) || row < located.end;
    let contribution = located
        .column(Role::Contribution)
        .or(located.column(Role::U))
        .map(|c| c.index);
    let measurand = claimed.measurand.clone();
    let (mut open, mut open_unit, mut found): (Option<Whole>, String, bool) =
        (None, String::new(), false);
    let labels = cells
        .iter()
        .filter(|(_, text)| footer::label(text, &measurand).is_some())
        .count();
    for (position, (column, text)) in cells.iter().enumerate() {
        let place = Place {
            sheet,
            row,
            column: *column,
        };
        let figure = Printed::parse(text);
        if figure.is_none() {
            // `U (k = 2)`, `k = 2.05`: the words hold figures.
            if text.contains('=') && !footer_words_only(text) {
                let found_here = footer::sentence(text, &measurand, place, &mut claimed.footer);
                found |= !found_here.is_empty();
                understood(claimed, place, text, found_here.first().copied());
                // `U | Expanded uncertainty | k = 2 | 0.056`: U is still open behind its k.
                let own = footer::label(text, &measurand);
                if own.is_some_and(|own| found_here.contains(&own)) {
                    if open == own {
                        open = None;
                    }
                    continue;
                }
            }
            if let Some(whole) = footer::label(text, &measurand) {
                // `U | Expanded uncertainty`: symbol and words of the same figure.
                open = Some(whole);
                open_unit = columns::apart(text).1;
            }
            continue;
        }
        let Some(mut figure) = figure else { continue };
        let by_column = located
            .columns
            .iter()
            .find(|c| c.index == *column)
            .filter(|_| inside)
            .map(|c| c.role);
        let whole = match (open, by_column) {
            (Some(Whole::Y), Some(Role::Contribution | Role::U)) => Some(Whole::Combined),
            (Some(Whole::Y), Some(Role::Dof)) => Some(Whole::Freedom),
            (Some(Whole::Combined), Some(Role::Dof)) => Some(Whole::Freedom),
            (Some(Whole::Expanded), Some(Role::Dof)) => Some(Whole::Freedom),
            (Some(Whole::Expanded), Some(Role::Divisor)) => Some(Whole::Factor),
            (Some(Whole::Combined | Whole::Expanded), Some(Role::Derived | Role::Number)) => None,
            (Some(Whole::Combined), Some(Role::Value))
                if contribution.is_some_and(|c| {
                    cells
                        .iter()
                        .any(|(i, t)| *i == c && Printed::parse(t).is_some())
                }) =>
            {
                Some(Whole::Y)
            }
            (open, _) => open,
        };
        let Some(whole) = whole else { continue };
        if figure.unit.is_empty() {
            let next = cells
                .get(position + 1)
                .map(|(_, t)| t.as_str())
                .filter(|t| units::parse(t).is_some() && Printed::parse(t).is_none());
            let head = by_column
                .filter(|role| matches!(role, Role::Contribution | Role::U))
                .map(|role| located.unit(role));
            figure.unit = [open_unit.as_str(), next.unwrap_or(""), head.unwrap_or("")]
                .into_iter()
                .find(|u| !u.is_empty())
                .unwrap_or_default()
                .to_string();
        }
        let figure = if whole == Whole::Y {
            figure
        } else {
            positive(figure)
        };
        if footer::set(&mut claimed.footer, whole, figure.at(place)) {
            understood(claimed, place, text, Some(whole));
            found = true;
        }
        let keeps = by_column.is_some() && inside;
        if !keeps && labels > 1 {
            open = None;
        } else if !keeps {
            break;
        }
    }
    found || across(grid, sheet, row, &cells, claimed)
}

/// Whether an equation in a label only says how it is computed: `U = k·u_c`.
fn footer_words_only(text: &str) -> bool {
    text.rsplit('=').next().is_some_and(|right| {
        Printed::parse(right).is_none() && crate::printed::leading(right).is_none()
    })
}

/// Whether a row is of labels side by side with their figures in the row below.
fn labels_across(grid: &Grid, row: usize, measurand: &str) -> bool {
    let labelled: Vec<usize> = grid
        .filled(row)
        .filter(|(_, cell)| footer::label(&cell.text, measurand).is_some())
        .map(|(column, _)| column)
        .collect();
    let figure = |column: &usize| Printed::parse(&grid.cell(row + 1, *column).text).is_some();
    let no_figures = grid
        .filled(row)
        .all(|(_, cell)| Printed::parse(&cell.text).is_none());
    labelled.len() >= 2
        && labelled.len() * 2 >= grid.filled(row).count()
        && no_figures
        && labelled.iter().any(figure)
}

/// Labels side by side with their figures in the row below.
fn across(
    grid: &Grid,
    sheet: usize,
    row: usize,
    cells: &[(usize, String)],
    claimed: &mut Claimed,
) -> bool {
    if !labels_across(grid, row, &claimed.measurand) {
        return false;
    }
    let labels: Vec<(usize, Whole)> = cells
        .iter()
        .filter_map(|(i, text)| Some((*i, footer::label(text, &claimed.measurand)?)))
        .collect();
    let below = |column: usize| Printed::parse(&grid.cell(row + 1, column).text);
    for (column, whole) in labels {
        if let Some(mut figure) = below(column) {
            if figure.unit.is_empty() {
                figure.unit = columns::apart(&grid.cell(row, column).text).1;
            }
            footer::set(
                &mut claimed.footer,
                whole,
                figure.at(Place {
                    sheet,
                    row: row + 1,
                    column,
                }),
            );
        }
    }
    true
}

fn understood(claimed: &mut Claimed, at: Place, text: &str, whole: Option<Whole>) {
    if let Some(whole) = whole {
        claimed.understood.push(Understood {
            at,
            text: text.into(),
            role: whole.name(),
        });
    }
}

/// Turns words and columns of each row into what is known of it, and its figures into one unit.
pub fn interpret(raw: &[Raw], full: bool, claimed: &mut Claimed) {
    let mean_of = claimed.reported_mean_of;
    let y_unit = claimed.unit.clone();
    for (raw, row) in raw.iter().zip(&mut claimed.rows) {
        let evidence = Evidence {
            words: &row.words,
            columns: &raw.columns_text,
            used: row.used.as_ref(),
            used_head: &raw.used_head,
            u: row.u.as_ref(),
            divisor: row.divisor.as_ref().map(|d| d.value),
            readings: raw.readings,
            full: full && !raw.stated_apart,
            mean_of,
        };
        (row.stated, row.relative) = kind::stated(&evidence);
        row.not_counted = not_counted(&row.words);
        row.convert_to_one_unit(&y_unit);
    }
    add_absent(claimed);
    for figure in [
        &mut claimed.footer.u_c,
        &mut claimed.footer.expanded,
        &mut claimed.cmc,
    ]
    .into_iter()
    .flatten()
    {
        if let Some(factor) = units::factor(&figure.unit, &y_unit)
            .filter(|_| !figure.unit.is_empty() && !y_unit.is_empty())
        {
            *figure = figure.clone().scaled(factor);
        }
    }
}

/// What a note knows of a quantity that no row has, unless a row has its figure.
fn add_absent(claimed: &mut Claimed) {
    let known = |row: &Row| {
        let figure = row.stated.figure().map(|figure| figure.value);
        claimed
            .rows
            .iter()
            .filter(|other| matches!(other.stated, Stated::Certificate { .. }))
            .any(|other| other.stated.figure().map(|f| f.value) == figure)
    };
    let absent: Vec<Row> = std::mem::take(&mut claimed.absent)
        .into_iter()
        .filter(|row| !known(row))
        .collect();
    let y_unit = claimed.unit.clone();
    for mut row in absent {
        row.convert_to_one_unit(&y_unit);
        row.is_absent = true;
        claimed.rows.push(row);
    }
}

fn not_counted(words: &str) -> Option<String> {
    let lower = words.to_lowercase();
    let of_clause = |lower: &str| {
        let said = has(
            lower,
            &[
                "contained in",
                "already contained",
                "already included",
                "included in",
                "is not counted",
                "not counted",
                "left out",
                "for information only",
                "not added",
                "已包含",
                "包含在",
                "已含",
                "不再计",
                "不计入",
                "不重复计",
                "不另计",
                "已计入",
                "略去",
                "不予计",
                "不单独",
            ],
        );
        let counted = has(
            lower,
            &[
                "an indication of its own",
                "counted beside",
                "not contained",
                "not included",
                "独立示值",
                "单独计入",
                "另行计入",
                "另计",
            ],
        ) && !has(lower, &["不另计"]);
        said && !counted
    };
    // `r is left out; z is counted beside it`: each clause is about one thing.
    lower
        .split([';', '。'])
        .any(of_clause)
        .then(|| words.to_string())
}

impl Row {
    /// Figures of ± and of what is stated in the unit of u, where all units are known.
    fn convert_to_one_unit(&mut self, y_unit: &str) {
        let stated_unit = self
            .stated
            .figure()
            .map(|f| f.unit.clone())
            .unwrap_or_default();
        let unit_of =
            |figure: &Option<Printed>| figure.as_ref().map(|f| f.unit.clone()).unwrap_or_default();
        let (u, used, value) = (unit_of(&self.u), unit_of(&self.used), unit_of(&self.value));
        let relative_y = units::fraction(y_unit).is_some();
        let fraction = units::fraction(&stated_unit).is_some();
        let candidates = if fraction && !relative_y {
            [&u, &value, &self.unit, &used]
        } else {
            [&u, &used, &self.unit, &value]
        };
        let known = candidates
            .into_iter()
            .find(|unit| !unit.is_empty())
            .cloned();
        // Nothing but the percentage has a unit: it is of the value, which has none.
        let bare = known.is_none() && fraction && !relative_y && self.relative != Relative::No;
        let target = match known {
            Some(unit) => unit,
            None if bare => String::new(),
            None => stated_unit.clone(),
        };
        let of_value = matches!(self.relative, Relative::OfValue(_));
        if units::fraction(&target).is_some() {
            if of_value {
                self.relative = Relative::No;
            }
        } else if of_value && self.value.is_none() {
            // A percentage of a value that the sheet does not state: what was used of it is all there is.
            self.relative = Relative::No;
            if let Some(used) = self.used.clone().or_else(|| {
                self.u
                    .clone()
                    .zip(self.divisor.as_ref())
                    .map(|(u, d)| u.scaled(d.value))
            }) {
                self.stated.replace_figure(used);
            }
        }
        let convert = |figure: &mut Printed| {
            let factor = units::factor(&figure.unit, &target)
                .filter(|_| !figure.unit.is_empty() && !target.is_empty());
            // A percentage of a value is converted by the value.
            if let Some(factor) = factor.filter(|_| {
                units::fraction(&figure.unit).is_none() || units::fraction(&target).is_some()
            }) {
                *figure = figure.clone().scaled(factor);
            }
        };
        for figure in self.stated.figures_mut() {
            if figure.unit.is_empty() {
                figure.unit.clone_from(&used);
            }
            convert(figure);
        }
        if let Some(used) = &mut self.used {
            convert(used);
        }
        self.unit = target;
    }
}

impl Stated {
    fn replace_figure(&mut self, figure: Printed) {
        if let [own] = self.figures_mut().as_mut_slice() {
            **own = figure;
        }
    }

    fn figures_mut(&mut self) -> Vec<&mut Printed> {
        match self {
            Stated::Nothing => Vec::new(),
            Stated::Certificate { expanded: x, .. }
            | Stated::Limits { half_width: x, .. }
            | Stated::FullWidth { width: x, .. }
            | Stated::Step { step: x }
            | Stated::Deviation { s: x, .. }
            | Stated::Range { range: x, .. }
            | Stated::Standard { u: x, .. } => vec![x],
            Stated::Unequal { plus, minus } => vec![plus, minus],
        }
    }
}
