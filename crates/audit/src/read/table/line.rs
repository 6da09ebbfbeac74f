//! One row of a table, as it stands on the sheet.

use crate::claim::{Figure, Row, Unplaced};
use crate::printed::{self, Place, Printed};
use crate::read::amounts;
use crate::read::columns::{Role, is_unit, is_unit_of_coefficients, names_factor};
use crate::read::footer;
use crate::read::kind::{names_distribution, spelled};
use crate::read::words::{alone, has};
use crate::sheet::Grid;
use crate::units;

use super::coefficient;
use super::freedom;
use super::located::{Column, Located};
use super::raw::{Raw, positive};

/// A row of the sheet that is one of a table.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    grid: &'a Grid,
    sheet: usize,
    row: usize,
    located: &'a Located,
}

impl<'a> Line<'a> {
    pub(super) fn new(grid: &'a Grid, sheet: usize, row: usize, located: &'a Located) -> Self {
        Line {
            grid,
            sheet,
            row,
            located,
        }
    }

    /// Its figures; `above` is the name of the row above, which holds where there is none.
    pub(super) fn raw(self, above: &str) -> Raw {
        let (symbol, name) = self.called(above);
        let (used, remark) = self.used();
        let head = |role: Role| self.located.column(role).map(|c| c.head.as_str());
        let formulas = [
            (Role::U, Figure::U),
            (Role::Contribution, Figure::Contribution),
        ];
        let formula = |(role, figure)| Some((figure, self.formula(role)?));
        Raw {
            columns_text: [self.distribution(), self.text(Role::Type)].join(" ; "),
            used_head: head(Role::Used).unwrap_or_default().to_string(),
            divisor_is_factor: head(Role::Divisor).is_some_and(names_factor),
            readings: self.figure(Role::Readings).map(|n| n.value),
            number: self.text(Role::Number),
            stated_apart: false,
            relative: self.derived(footer::is_relative),
            has_relative_u: head(Role::U).is_some_and(footer::is_relative),
            is_root: false,
            row: Row {
                at: self.place(self.grid.filled(self.row).next().map_or(0, |(i, _)| i)),
                value: self
                    .figure(Role::Value)
                    .or_else(|| Some(self.with_estimate()?.0)),
                used: used.map(positive),
                divisor: self.figure(Role::Divisor),
                u: self.figure(Role::U).map(positive),
                c: self.coefficient().or_else(|| self.shown_coefficient()),
                unread_c: self.unread_coefficient(),
                contribution: self.figure(Role::Contribution),
                dof: self.dof(),
                unit: alone(self.unit_beside(0)).to_string(),
                unread_unit: self.unread_unit(),
                unread_distribution: self.unread_distribution(),
                unread_used: self.unread_used(),
                is_hidden: self.grid.hidden_rows.contains(&self.row),
                distribution: self.distribution(),
                evaluation: self.text(Role::Type),
                share: self.derived(is_share),
                formulas: formulas.into_iter().filter_map(formula).collect(),
                words: self.words(&symbol, &name, remark),
                symbol,
                name,
                ..Row::default()
            },
        }
    }

    fn place(self, column: usize) -> Place {
        Place {
            sheet: self.sheet,
            row: self.row,
            column,
        }
    }

    fn text_in(self, column: &Column) -> &'a str {
        self.grid.cell(self.row, column.index).text.as_str()
    }

    /// What stands in the columns of a role.
    fn text(self, role: Role) -> String {
        let columns = self.located.columns.iter().filter(|c| c.role == role);
        let texts = columns.map(|column| self.text_in(column));
        let texts: Vec<&str> = texts.filter(|text| !text.is_empty()).collect();
        texts.join("; ")
    }

    /// What its column calls the distribution, in full.
    fn distribution(self) -> String {
        spelled(&self.text(Role::Distribution), self.divided_by())
    }

    /// By what the figure that is known was divided: its divisor, or what u or the contribution shows.
    fn divided_by(self) -> Option<f64> {
        let value = |role: Role| self.figure(role).map(|figure| figure.value.abs());
        let c = value(Role::C).unwrap_or(1.0);
        let of_u = || Some(value(Role::Used)? / value(Role::U)?);
        let of_contribution = || Some(c * value(Role::Used)? / value(Role::Contribution)?);
        value(Role::Divisor).or_else(of_u).or_else(of_contribution)
    }

    fn figure(self, role: Role) -> Option<Printed> {
        let mut figure = self.written(role)?;
        if role != Role::C && !is_unit(&figure.unit) {
            figure.unit.clear();
        }
        Some(figure)
    }

    /// A figure with what stands in the place of its unit.
    fn written(self, role: Role) -> Option<Printed> {
        let column = self.located.column(role)?;
        let figure = self.grid.cell(self.row, column.index).figure()?;
        let figure = match role {
            Role::Divisor => figure.into_divisor(),
            _ => figure,
        };
        Some(self.in_column(column, figure))
    }

    /// A figure of a column in its unit, or that of the column, or the one that stands beside it.
    fn in_column(self, column: &Column, mut figure: Printed) -> Printed {
        if figure.unit.is_empty() {
            figure.unit.clone_from(&column.unit);
        }
        if figure.unit.is_empty() && matches!(column.role, Role::Value | Role::Used | Role::U) {
            figure.unit = self.unit_beside(column.index).to_string();
        }
        if figure.unit.is_empty() && column.role == Role::C {
            figure.unit = self.unit_of_coefficient().to_string();
        }
        figure.unit = alone(&figure.unit).to_string();
        figure.at(self.place(column.index))
    }

    /// The sensitivity coefficient: a figure, or a product of figures that the cell writes out, `150 mm×11.5×10⁻⁶/℃`.
    fn coefficient(self) -> Option<Printed> {
        let column = self.located.column(Role::C)?;
        let text = self.text_in(column);
        let made = coefficient::product(text).map(|made| {
            let unit = match made.unit.as_str() {
                "" => column.unit.clone(),
                unit => unit.to_owned(),
            };
            Printed { unit, ..made }.at(self.place(column.index))
        });
        // What is behind the first number of a product is no unit of it.
        let is_product = text.contains(['=', '×', '*', '·', '⋅']);
        let is_own =
            |figure: &Printed| !is_product || figure.unit.is_empty() || is_unit(&figure.unit);
        let figure = self.figure(Role::C).filter(is_own);
        match (figure, made) {
            // The same, with the digits that it has.
            (Some(figure), Some(made)) if made.is_met_within(figure.value, 0.0) => Some(figure),
            (figure, made) => made.or(figure),
        }
    }

    /// The coefficient that u and the contribution of the row show, where its cell has a formula that is not understood: `L·α`.
    fn shown_coefficient(self) -> Option<Printed> {
        let unread = self.unread_coefficient()?;
        let (u, made) = (self.figure(Role::U)?, self.figure(Role::Contribution)?);
        let factor = units::factor(&u.unit, &made.unit).unwrap_or(1.0);
        let sign = if unread.text.starts_with('-') {
            -1.0
        } else {
            1.0
        };
        let value = sign * (made.value / (factor * u.value)).abs();
        let half = value.abs() * (made.relative_half() + u.relative_half());
        let shown = Printed {
            half,
            ..Printed::exact(value, &unread.text)
        };
        value.is_finite().then(|| shown.at(unread.at))
    }

    /// What stands in the column of coefficients and is no number.
    fn unread_coefficient(self) -> Option<Unplaced> {
        let column = self.located.column(Role::C)?;
        let text = self.text_in(column);
        let is_unread = self.coefficient().is_none() && coefficient::is_formula(text);
        is_unread.then(|| Unplaced {
            at: self.place(column.index),
            text: text.to_owned(),
        })
    }

    /// The first of what stands in the place of a unit and is none that is known.
    fn unread_unit(self) -> Option<Unplaced> {
        let roles = [Role::Value, Role::Used, Role::U, Role::Contribution];
        let mut figures = roles.into_iter().filter_map(|role| self.written(role));
        let unread =
            |figure: &Printed| figure.unit.contains(char::is_alphabetic) && !is_unit(&figure.unit);
        figures.find(unread).map(|figure| Unplaced {
            at: figure.at,
            text: figure.unit,
        })
    }

    /// What stands in the column of distributions and is neither one, nor a type of evaluation.
    fn unread_distribution(self) -> Option<Unplaced> {
        let column = self.located.column(Role::Distribution)?;
        let text = self.text_in(column);
        // Longer ones are remarks, or say how the figure came about.
        let is_word = text.contains(char::is_alphabetic) && !text.contains(char::is_whitespace);
        let is_unread = is_word && !names_distribution(&self.distribution());
        is_unread.then(|| Unplaced {
            at: self.place(column.index),
            text: text.to_owned(),
        })
    }

    /// Degrees of freedom, if need be those that there are at least or about.
    fn dof(self) -> Option<Printed> {
        let stated = || {
            let column = self.located.column(Role::Dof)?;
            let place = self.place(column.index);
            Some(freedom::about(self.text_in(column))?.at(place))
        };
        let dof = self.figure(Role::Dof).or_else(stated);
        dof.map(freedom::as_infinite)
    }

    fn formula(self, role: Role) -> Option<String> {
        let column = self.located.column(role)?;
        self.grid.cell(self.row, column.index).formula.clone()
    }

    /// Its symbol and its name. `Mass of the standard m_S` in a column of quantities is a name, `d_acquisition` is not.
    fn called(self, above: &str) -> (String, String) {
        const LONGEST: usize = 12;
        let (symbol, name) = (self.text(Role::Symbol), self.text(Role::Name));
        if symbol.is_empty() && name.is_empty() {
            return (symbol, above.to_string());
        }
        let is_identifier =
            symbol.contains('_') && symbol.chars().all(|c| c.is_alphanumeric() || c == '_');
        let is_long = symbol.contains(' ') || symbol.chars().count() > LONGEST && !is_identifier;
        match name.is_empty() && is_long {
            true => (String::new(), symbol),
            false => (symbol, name),
        }
    }

    /// The figure that is known, and what its cell says beside it: `0.0060 (s of 10 readings, mean reported)`.
    fn used(self) -> (Option<Printed>, &'a str) {
        let column = self.located.column(Role::Used);
        let text = column.map_or("", |column| self.text_in(column));
        // `100.00 mV ± 0.30 mV`: the estimate stands in front of what is known.
        if let Some((_, half)) = self.with_estimate() {
            return (Some(half), "");
        }
        if column.is_none()
            && let Some(figure) = self.remarked()
        {
            return (Some(figure), "");
        }
        let is_plain = Printed::parse(text).is_some_and(|figure| is_plain(&figure.unit));
        let made = amounts::limit(text).filter(|_| !is_plain);
        if let Some((column, (figure, remark))) = column.zip(made) {
            return (Some(self.in_column(column, figure)), remark);
        }
        let bracketed = printed::leading(text);
        let bracketed = bracketed.filter(|(_, behind)| behind.trim_start().starts_with('('));
        let remark = match &bracketed {
            Some((_, behind)) if units::parse(behind.trim().trim_matches(['(', ')'])).is_none() => {
                *behind
            }
            _ if Printed::parse(text).is_none() => text,
            _ => "",
        };
        let in_front = || {
            let column = column?.index;
            let unit = self.unit_beside(column).to_string();
            let (figure, _) = bracketed?;
            Some(Printed { unit, ..figure }.at(self.place(column)))
        };
        (self.figure(Role::Used).or_else(in_front), remark)
    }

    /// What the column of limits says, where that is no figure, and more than that there is none.
    fn unread_used(self) -> Option<Unplaced> {
        let column = self.located.column(Role::Used)?;
        let text = self.text_in(column);
        let is_unread = self.used().0.is_none() && says_something(text);
        is_unread.then(|| Unplaced {
            at: self.place(column.index),
            text: text.to_owned(),
        })
    }

    /// The estimate and the ± of a cell that has both.
    fn with_estimate(self) -> Option<(Printed, Printed)> {
        let column = self.located.column(Role::Used)?;
        let (value, half) = self.text_in(column).split_once(['±'])?;
        let (value, mut half) = (Printed::parse(value)?, Printed::parse(half)?);
        for unit in [&value.unit, &column.unit] {
            if half.unit.is_empty() {
                half.unit.clone_from(unit);
            }
        }
        let at = self.place(column.index);
        (is_unit(&half.unit) || half.unit.is_empty()).then(|| (value.at(at), half.at(at)))
    }

    /// The figure of a row whose remark is nothing else, where the row says by what it was divided, and no column is one of limits.
    fn remarked(self) -> Option<Printed> {
        let u = self.figure(Role::U)?;
        self.figure(Role::Divisor)?;
        let mut columns = self
            .located
            .columns
            .iter()
            .filter(|c| c.role == Role::Remark);
        columns.find_map(|column| {
            let figure = Printed::parse(self.text_in(column))?;
            let is_alike = units::factor(&figure.unit, &u.unit).is_some();
            is_alike.then(|| figure.at(self.place(column.index)))
        })
    }

    /// Everything that it says in words.
    fn words(self, symbol: &str, name: &str, remark: &str) -> String {
        let remarks = self.text(Role::Remark);
        let said = [name, &remarks, remark];
        let said: Vec<&str> = said.into_iter().filter(|text| !text.is_empty()).collect();
        let said = said.join("; ");
        match name.is_empty() {
            true => [symbol, &said].join("; "),
            false => said,
        }
    }

    /// The unit that the columns of units have for a figure: of several the one behind it, else the last in front of it.
    fn unit_beside(self, index: usize) -> &'a str {
        let is_own = |c: &&Column| c.role == Role::Unit && !is_unit_of_coefficients(&c.head);
        let units = self.located.columns.iter().filter(is_own);
        let mut units: Vec<usize> = units.map(|c| c.index).collect();
        units.sort_unstable();
        let behind = units.iter().find(|unit| **unit == index + 1);
        let in_front = || units.iter().rev().find(|unit| **unit < index);
        let unit = behind.or_else(in_front).or(units.first());
        unit.map_or("", |unit| self.grid.cell(self.row, *unit).text.trim())
    }

    /// What a column of their units has for the sensitivity coefficient.
    fn unit_of_coefficient(self) -> &'a str {
        let mut columns = self.located.columns.iter();
        let column = columns.find(|c| c.role == Role::Unit && is_unit_of_coefficients(&c.head));
        column.map_or("", |column| {
            self.grid.cell(self.row, column.index).text.trim()
        })
    }

    /// The figure in the first column of what was computed from others whose head is so called.
    fn derived(self, is: fn(&str) -> bool) -> Option<Printed> {
        let mut columns = self.located.columns.iter();
        let column = columns.find(|c| c.role == Role::Derived && is(&c.head))?;
        let figure = Printed::parse(self.text_in(column))?;
        let unit = match figure.unit.as_str() {
            "" => column.unit.clone(),
            _ => figure.unit.clone(),
        };
        Some(Printed { unit, ..figure })
    }
}

/// Whether nothing but a unit stands behind a figure.
fn is_plain(unit: &str) -> bool {
    unit.is_empty() || is_unit(unit)
}

/// Whether a cell says more than that it has nothing to say.
fn says_something(text: &str) -> bool {
    const NOTHING: [&str; 8] = [
        "n/a",
        "na",
        "none",
        "negligible",
        "not applicable",
        "无",
        "忽略",
        "可忽略",
    ];
    let lower = text.to_lowercase();
    text.contains(char::is_alphanumeric) && !NOTHING.contains(&lower.as_str())
}

/// Whether a head of what was computed from others is that of shares in the variance.
fn is_share(head: &str) -> bool {
    let lower = head.to_lowercase();
    let said = has(&lower, &["share", "index", "percent"])
        || lower.contains(['%', '％'])
        || has(&lower, &["贡献率", "占比", "百分比"]);
    said && !footer::is_relative(head)
}
