//! One row of the claimed figures of the whole: labels, and the figures that they are of.

use std::ops::ControlFlow;

use crate::claim::{Claimed, Understood};
use crate::printed::{Place, Printed};
use crate::read::columns::{self, Role};
use crate::read::conditions;
use crate::read::coverage;
use crate::read::footer::{self, Whole};
use crate::read::notes;
use crate::read::words::has;
use crate::sheet::Grid;
use crate::units;

use super::labels;
use super::located::Located;
use super::raw::positive;
use super::relative::Relative;

/// The claimed figures of a row; those that are relative to the result wait for it. Whether there are some.
pub(super) fn read(
    grid: &Grid,
    at: (usize, usize),
    located: &Located,
    claimed: &mut Claimed,
    relative: &mut Vec<Relative>,
) -> bool {
    let (sheet, row) = at;
    let cells: Vec<(usize, String)> = grid
        .filled(row)
        .map(|(column, cell)| (column, cell.text.clone()))
        .collect();
    let of_row = |text: &str| {
        let mut rows = claimed.rows.iter();
        rows.any(|row| !row.symbol.is_empty() && row.symbol == text)
    };
    // `U | Expanded uncertainty`: of the whole, though a voltage has the same symbol.
    let is_called = |(_, text): &(usize, String)| {
        let whole = footer::label(text, "").filter(|whole| *whole != Whole::Y);
        whole.is_some() && text.contains(' ')
    };
    let is_of_row = || of_row(&cells[0].1) && !is_called(&cells[1]);
    let is_claim = || cells.iter().any(|(column, _)| is_claim(grid, row, *column));
    if cells.len() < 2 || is_of_row() || is_claim() {
        return false;
    }
    let surroundings = Surroundings::of(grid, row, &cells, located, &claimed.measurand);
    let mut reading = Reading {
        around: &surroundings,
        claimed,
        relative,
        open: None,
        behind_factor: None,
        is_relative: false,
        is_report: false,
        found: false,
    };
    for position in order(&cells, &surroundings.measurand) {
        let (column, text) = &cells[position];
        let place = Place {
            sheet,
            row,
            column: *column,
        };
        let figure = grid.cell(row, *column).figure();
        // `2u | 0.42`: no figure in the unit u.
        let is_multiple = position == 0 && footer::multiple_alone(text).is_some();
        match figure.filter(|_| !is_multiple) {
            None => reading.words(place, text),
            // The figure of the label is one that the file does not keep, and no other.
            Some(_) if surroundings.lacks_value_in_front(position) => reading.open = None,
            Some(figure) => {
                if reading.figure(position, figure.at(place), text).is_break() {
                    break;
                }
            }
        }
    }
    reading.found || labels::across(grid, sheet, row, claimed)
}

/// The order in which the cells of a row say what they say: a label may stand behind its figures, in the column of the names of the
/// sources: `0.295 |  | u_c`.
fn order(cells: &[(usize, String)], measurand: &str) -> Vec<usize> {
    let is_figure = |position: &usize| Printed::parse(&cells[*position].1).is_some();
    let is_of_whole = |text: &str| {
        let whole = footer::label(text, measurand);
        let is_open = !footer::without_condition(text).contains('=');
        whole.is_some_and(|whole| whole != Whole::Y) && is_open
    };
    let mut order: Vec<usize> = (0..cells.len()).collect();
    let (last, front) = (cells.len() - 1, 0..cells.len() - 1);
    if is_of_whole(&cells[last].1) && front.clone().all(|position| is_figure(&position)) {
        order.rotate_right(1);
    } else if is_figure(&0)
        && is_of_whole(&cells[1].1)
        && !(2..cells.len()).any(|position| is_figure(&position))
    {
        order.swap(0, 1);
    }
    order
}

/// Notes what a text was understood as.
pub(super) fn understood(claimed: &mut Claimed, at: Place, text: &str, whole: Whole) {
    claimed.understood.push(Understood {
        at,
        text: text.into(),
        role: whole.name(),
    });
}

/// A row and the table to which it belongs.
struct Surroundings<'a> {
    grid: &'a Grid,
    row: usize,
    cells: &'a [(usize, String)],
    located: &'a Located,
    measurand: String,
    /// Whether it is a row of the table, so that the heads of its columns hold for it.
    is_inside: bool,
    /// How many of its cells are labels, and how many are figures.
    labels: usize,
    figures: usize,
}

impl<'a> Surroundings<'a> {
    fn of(
        grid: &'a Grid,
        row: usize,
        cells: &'a [(usize, String)],
        located: &'a Located,
        measurand: &str,
    ) -> Self {
        let count = |is: &dyn Fn(&str) -> bool| cells.iter().filter(|(_, text)| is(text)).count();
        Surroundings {
            grid,
            row,
            cells,
            located,
            measurand: measurand.to_string(),
            is_inside: located.used.contains(&row) || row < located.end,
            labels: count(&|text| footer::label(text, measurand).is_some()),
            figures: count(&|text| Printed::parse(text).is_some()),
        }
    }

    fn role(&self, column: usize) -> Option<Role> {
        let mut columns = self.located.columns.iter().filter(|_| self.is_inside);
        columns.find(|c| c.index == column).map(|c| c.role)
    }

    /// Whether the cells between a cell and the one in front of it hold a formula without its value.
    fn lacks_value_in_front(&self, position: usize) -> bool {
        let column = |position: usize| self.cells.get(position).map_or(0, |(column, _)| *column);
        let from = position.checked_sub(1).map_or(0, column);
        (from + 1..column(position)).any(|column| self.grid.cell(self.row, column).lacks_value())
    }

    /// Whether a row below it states U.
    fn has_expanded_below(&self) -> bool {
        let below = self.row + 1..=self.row + footer::ROWS_TO_EXPANDED;
        let mut labels = below.filter_map(|row| self.grid.filled(row).next());
        labels.any(|(_, cell)| {
            let is_expanded = footer::label(&cell.text, &self.measurand) == Some(Whole::Expanded);
            is_expanded && !footer::is_total(&cell.text)
        })
    }

    /// Whether a figure stands in the column of the contributions.
    fn has_contribution(&self) -> bool {
        let contribution = self.located.column(Role::Contribution);
        let column = contribution.or(self.located.column(Role::U));
        column.is_some_and(|column| {
            let mut cells = self.cells.iter();
            cells.any(|(i, text)| *i == column.index && Printed::parse(text).is_some())
        })
    }

    /// Whether it is the sum of a column.
    fn is_sum(&self) -> bool {
        let mut texts = self.cells.iter().map(|(_, text)| text.to_lowercase());
        texts.any(|text| {
            has(
                &text,
                &[
                    "sum", "summe", "somme", "total", "σ", "合计", "总和", "求和",
                ],
            )
        })
    }

    /// The unit of a figure that has none itself: that of its label, of the cell behind it, of the row, of the column.
    fn unit(&self, position: usize, role: Option<Role>, of_label: &str) -> String {
        let next = self.cells.get(position + 1).map(|(_, text)| text.as_str());
        let next = next.filter(|text| columns::is_unit(text) && Printed::parse(text).is_none());
        let of_row = self.located.column(Role::Unit).filter(|_| self.is_inside);
        let of_row = of_row.map(|c| self.grid.cell(self.row, c.index).text.trim());
        let of_row = of_row.filter(|unit| units::parse(unit).is_some());
        let head = role.filter(|role| matches!(role, Role::Contribution | Role::U));
        let head = head.map(|role| self.located.unit(role));
        let said = [Some(of_label), next, of_row, head];
        let unit = said.into_iter().flatten().find(|unit| !unit.is_empty());
        unit.unwrap_or_default().to_string()
    }
}

/// What waits for a figure on the way through a row, and what was found.
struct Reading<'a> {
    around: &'a Surroundings<'a>,
    claimed: &'a mut Claimed,
    relative: &'a mut Vec<Relative>,
    /// What the last label calls, and the unit in it.
    open: Option<(Whole, String)>,
    /// What a label called before that of the factor came.
    behind_factor: Option<(Whole, String)>,
    is_relative: bool,
    /// Whether the last label calls what is reported, in the place of a figure that the sheet computes above it.
    is_report: bool,
    found: bool,
}

impl Reading<'_> {
    fn is_open(&self, whole: Whole) -> bool {
        matches!(self.open, Some((open, _)) if open == whole)
    }

    fn words(&mut self, place: Place, text: &str) {
        // A kelvin in the column of units is no coverage factor.
        if self.around.role(place.column) == Some(Role::Unit) && columns::is_unit(text) {
            return;
        }
        if let Some(figure) = footer::with_factor(text) {
            self.take(Whole::Expanded, figure.at(place), text);
        }
        if self.sentence(place, text) {
            return;
        }
        // `R | Sum | 300.03`: what the result is called, behind its symbol.
        if self.is_open(Whole::Y) && footer::is_bare_sum(text) {
            return;
        }
        let of_force = || (text == "W" && self.around.labels == 0).then_some(Whole::Expanded);
        match footer::label(text, &self.around.measurand).or_else(of_force) {
            // `总不确定度 | 0.208` above `U | 0.42` is u_c.
            Some(Whole::Expanded) if footer::is_total(text) && self.around.has_expanded_below() => {
                self.label(Whole::Combined, place, text);
            }
            Some(whole) => self.label(whole, place, text),
            // `Expanded | 0.184` above `Reported | 0.19`
            None if footer::is_report(text) && self.claimed.footer.expanded.is_some() => {
                self.label(Whole::Expanded, place, text);
            }
            // `k | p = 95 %, t-distribution | 2.03`
            None if self.is_open(Whole::Factor) => coverage::rule_of_label(text, self.claimed),
            None => {}
        }
    }

    /// `U (k = 2)`, `k = 2.05`: the words hold figures. Whether the one that they call is among them, so that the label is
    /// settled.
    fn sentence(&mut self, place: Place, text: &str) -> bool {
        if !text.contains('=') || footer_words_only(text) {
            return false;
        }
        let measurand = &self.around.measurand;
        let here = footer::sentence(text, measurand, place, &mut self.claimed.footer);
        self.found |= !here.is_empty();
        if let Some(first) = here.first() {
            understood(self.claimed, place, text, *first);
        }
        if here.contains(&Whole::Factor) {
            coverage::rule_of_reason(text, self.claimed);
        }
        // `U | Expanded uncertainty | k = 2 | 0.056`: U is still open behind its k.
        let own = footer::label(text, measurand).filter(|own| here.contains(own));
        if own.is_some_and(|own| self.is_open(own)) {
            self.open = None;
        }
        own.is_some()
    }

    fn label(&mut self, whole: Whole, place: Place, text: &str) {
        self.is_relative = footer::is_relative(text);
        self.is_report = footer::is_report(text);
        let at_point = conditions::without_point(text);
        // The point is an amount of which a relative figure may be a part.
        if at_point != text {
            self.claimed.words.push_str(text);
            self.claimed.words.push('\n');
        }
        // `Expanded uncertainty | k = | 2 | 0.6`: behind its factor U is still open.
        if whole == Whole::Factor && !self.is_open(whole) {
            self.behind_factor = self.open.take();
        }
        let unit = match whole {
            Whole::Factor => {
                coverage::rule_of_label(text, self.claimed);
                String::new()
            }
            Whole::Freedom => String::new(),
            Whole::Expanded => {
                coverage::level_of_label(text, self.claimed);
                if let Some(k) = footer::factor_of_label(text) {
                    self.take(Whole::Factor, k.at(place), text);
                }
                notes::rounding(&text.to_lowercase(), self.claimed);
                columns::apart(&at_point).1
            }
            _ => columns::apart(&at_point).1,
        };
        // `U | Expanded uncertainty`: symbol and words of the same figure.
        self.open = Some((whole, unit));
    }

    /// A figure; breaks where the row has said what it says.
    fn figure(&mut self, position: usize, figure: Printed, text: &str) -> ControlFlow<()> {
        let role = self.around.role(figure.at.column);
        let Some(whole) = self.whole(role, figure.value) else {
            return ControlFlow::Continue(());
        };
        let figure = units::with_power(self.with_unit(position, role, figure));
        let figure = match whole {
            Whole::Y => figure,
            _ => positive(figure),
        };
        if self.is_relative && matches!(whole, Whole::Combined | Whole::Expanded) {
            self.relative.push(Relative { whole, figure });
            self.found = true;
        } else {
            self.take(whole, figure, text);
        }
        if whole == Whole::Factor && self.behind_factor.is_some() {
            self.open = self.behind_factor.take();
            return ControlFlow::Continue(());
        }
        match (role, self.around.labels) {
            (Some(_), _) => ControlFlow::Continue(()),
            (None, 2..) => {
                self.open = None;
                ControlFlow::Continue(())
            }
            (None, _) => ControlFlow::Break(()),
        }
    }

    /// What a figure is, by the label in front of it and the column in which it stands.
    fn whole(&self, role: Option<Role>, value: f64) -> Option<Whole> {
        let open = self.open.as_ref().map(|(whole, _)| *whole);
        match (open, role) {
            (Some(Whole::Y), Some(Role::Contribution | Role::U)) => Some(Whole::Combined),
            (Some(Whole::Y | Whole::Combined | Whole::Expanded), Some(Role::Dof)) => {
                Some(Whole::Freedom)
            }
            (Some(Whole::Expanded), Some(Role::Divisor)) => Some(Whole::Factor),
            // Beside a sum of squares stands u_c; a figure alone in its row is what the label says.
            (Some(Whole::Combined | Whole::Expanded), Some(Role::Derived | Role::Number))
                if self.around.figures > 1 || self.around.is_sum() =>
            {
                None
            }
            (Some(Whole::Combined), Some(Role::Value)) if self.around.has_contribution() => {
                Some(Whole::Y)
            }
            // `m_X | 10 000.025 g | U = 59 mg (k = 2)`
            (None, Some(Role::Value)) if self.around.labels > 0 && value != 0.0 => Some(Whole::Y),
            (open, _) => open,
        }
    }

    fn with_unit(&self, position: usize, role: Option<Role>, mut figure: Printed) -> Printed {
        if !figure.unit.is_empty() {
            return figure;
        }
        let of_label = self.open.as_ref().map_or("", |(_, unit)| unit.as_str());
        let unit = self.around.unit(position, role, of_label);
        // A unit in a label, other than that of the contributions, is called with its figure.
        if unit == of_label && !unit.is_empty() && unit != self.around.located.unit {
            figure.text = format!("{} {unit}", figure.text);
            if let Some(shown) = &mut figure.shown {
                shown.push(' ');
                shown.push_str(&unit);
            }
        }
        figure.unit = unit;
        figure
    }

    fn take(&mut self, whole: Whole, figure: Printed, text: &str) {
        let place = figure.at;
        let footer = &mut self.claimed.footer;
        let is_taken = match whole {
            Whole::Expanded if self.is_report => footer::set_reported(footer, figure),
            _ => footer::set(footer, whole, figure),
        };
        if is_taken {
            understood(self.claimed, place, text, whole);
            self.found = true;
        }
    }
}

/// Whether a figure stands below a head that calls it somebody's claim, which a report holds against its own.
fn is_claim(grid: &Grid, row: usize, column: usize) -> bool {
    if grid.cell(row, column).figure().is_none() {
        return false;
    }
    let above = (0..row).rev().map(|row| grid.cell(row, column));
    let mut heads = above.filter(|cell| !cell.text.is_empty() && cell.figure().is_none());
    let head = heads.next().map(|cell| cell.text.to_lowercase());
    head.is_some_and(|head| footer::calls_claim(&head))
}

/// Whether an equation in a label only says how it is computed: `U = k·u_c`.
fn footer_words_only(text: &str) -> bool {
    text.rsplit('=').next().is_some_and(|right| {
        Printed::parse(right).is_none() && crate::printed::leading(right).is_none()
    })
}
