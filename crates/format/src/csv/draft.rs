//! A column that is being read, field by field.

use std::collections::HashMap;
use std::ops::Range;

use super::column_unit::unit_of;
use super::doubts::{Sign, mend_of_overload, not_a};
use super::faults::{NOT_A_NUMBER, UNIT_CLASH};
use super::field::{Field, Instant, is_like_a_time, is_overload, may_mark_thousands, mend};
use super::heading::Heading;
use super::request::{Content, Request};
use super::sheet::{Row, SHOWN, Sheet};
use super::{Column, Data, Labels};
use gumption_core::quantity::Unit;
use gumption_core::statistics::Dd;
use gumption_fault::{Fault, Said, say};

/// A column that is being read.
pub(super) struct Draft<'a> {
    request: &'a Request,
    heading: &'a Heading,
    pub(super) place: usize,
    span: Range<usize>,
    pub(super) content: Content,
    unit: Option<Unit>,
    numbers: Vec<f64>,
    decimals: Vec<Dd>,
    labels: Labels,
    levels: HashMap<String, u32>,
    faults: Vec<Fault>,
    refused: usize,
    /// The first field that was refused.
    first_refused: Option<String>,
    pub(super) style: Style,
    /// Whether every decimal sign so far may mark thousands.
    pub(super) only_thousands: bool,
}

/// How the numbers of a column are written so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Style {
    Unknown,
    Whole,
    Point,
    Comma,
    /// As times, with the first of them.
    Clock(Instant),
}

impl<'a> Draft<'a> {
    /// A column with its number in the table and the place of its name.
    pub(super) fn new(
        request: &'a Request,
        heading: &'a Heading,
        place: usize,
        span: Range<usize>,
    ) -> Draft<'a> {
        Draft {
            request,
            heading,
            place,
            span,
            content: request.content,
            unit: None,
            numbers: Vec::new(),
            decimals: Vec::new(),
            labels: Labels::default(),
            levels: HashMap::new(),
            faults: Vec::new(),
            refused: 0,
            first_refused: None,
            style: Style::Unknown,
            only_thousands: true,
        }
    }

    /// The unit that the header and the asker agree on. Labels have none.
    pub(super) fn settle_unit(&mut self, faults: &mut Vec<Fault>) {
        if self.content == Content::Labels {
            return;
        }
        match unit_of(self.heading, self.request, &self.span) {
            Ok(unit) => self.unit = unit,
            Err(fault) => faults.push(*fault),
        }
    }

    pub(super) fn take(&mut self, sheet: &Sheet, row: &Row, field: &str) {
        if self.content == Content::Labels {
            let levels = &mut self.labels.levels;
            let next = levels.len() as u32;
            let level = match self.levels.get(field) {
                Some(level) => *level,
                None => {
                    levels.push(field.to_owned());
                    self.levels.insert(field.to_owned(), next);
                    next
                }
            };
            self.labels.of_row.push(level);
            return;
        }
        let read = Field::read(field, sheet);
        if read.and_then(Sign::of).is_some() {
            self.only_thousands &= may_mark_thousands(field);
        }
        if self.content == Content::Decimals {
            return self.take_decimal(sheet, row, read);
        }
        if let Some(number) = read.and_then(|read| self.number(read)) {
            self.numbers.push(number);
            return;
        }
        self.refused += 1;
        self.first_refused.get_or_insert_with(|| field.to_owned());
        // Times that cannot be read are so in every row of the column: one says it.
        let is_time = read.is_none() && is_like_a_time(field);
        let (shown, expected) = match is_time {
            true => (1, say!("a time of a known form")),
            false => (SHOWN, say!("a number")),
        };
        if self.faults.len() < shown {
            let help = match read {
                Some(_) => say!(
                    "write all numbers of a column alike: all with a decimal point, all with a decimal comma, or all as times"
                ),
                None => mend(field),
            };
            let fault = self.no_number(sheet, row, expected, help);
            self.faults.push(fault);
        }
    }

    /// A field of a column in which every row has its decimal.
    fn take_decimal(&mut self, sheet: &Sheet, row: &Row, read: Option<Field>) {
        let field = row.field(self.place);
        let written = match read {
            Some(Field::Comma(_)) => field.replace(',', "."),
            _ => field.to_owned(),
        };
        let clock = matches!(read, Some(Field::Clock(_)));
        let number = read.filter(|_| !clock).and_then(|read| self.number(read));
        let exact = number.filter(|number| number.is_finite());
        if let Some(exact) = exact.and_then(|_| Dd::parse(&written)) {
            self.decimals.push(exact);
            return;
        }
        self.refused += 1;
        if self.faults.len() < SHOWN {
            let help = if field.is_empty() {
                say!("every row needs a number there; remove the rows that are empty")
            } else if is_overload(field) {
                mend_of_overload()
            } else {
                match read {
                    Some(_) if number.is_some() => say!("every row needs a number there"),
                    Some(_) if !clock => say!(
                        "write all numbers of a column alike: all with a decimal point, or all with a decimal comma"
                    ),
                    // Here an empty field would be refused, too.
                    None if !field.contains(char::is_alphanumeric) => {
                        say!("every row needs a number there; remove the rows that are empty")
                    }
                    _ => mend(field),
                }
            };
            let fault = self.no_number(sheet, row, say!("a number"), help);
            self.faults.push(fault);
        }
    }

    fn no_number(&self, sheet: &Sheet, row: &Row, expected: Said, help: Said) -> Fault {
        let (line, column, field) = (row.line, &self.heading.text, row.field(self.place));
        let message = not_a(column, line, field, &expected);
        Fault::new(NOT_A_NUMBER, sheet.place(row, self.place), message)
            .label(say!("expected {expected}"))
            .related(self.span.clone(), say!("the column"))
            .help(help)
    }

    /// Decimals in the unit that is asked for.
    fn convert(&mut self) {
        let Some(into) = &self.request.into else {
            return;
        };
        let found = self.unit.replace(into.clone());
        let conversion = found.and_then(|found| found.conversion_to(into));
        if let Some(conversion) = conversion.filter(|conversion| !conversion.is_identity()) {
            let factor = Dd::from_decimal(conversion.factor);
            let offset = Dd::from_decimal(conversion.offset);
            for decimal in &mut self.decimals {
                *decimal = *decimal * factor + offset;
            }
        }
    }

    /// The number of a field, if it is written as those before it are. Times count from the first one.
    pub(super) fn number(&mut self, field: Field) -> Option<f64> {
        self.style = match (self.style, field) {
            (_, Field::Whole(value)) if value.is_nan() => return Some(value),
            (Style::Unknown, Field::Whole(_)) => Style::Whole,
            (style @ (Style::Whole | Style::Point | Style::Comma), Field::Whole(_)) => style,
            (Style::Unknown | Style::Whole | Style::Point, Field::Point(_)) => Style::Point,
            (Style::Unknown | Style::Whole | Style::Comma, Field::Comma(_)) => Style::Comma,
            (Style::Unknown, Field::Clock(first)) => Style::Clock(first),
            (style @ Style::Clock(_), Field::Clock(_)) => style,
            _ => return None,
        };
        match (field, self.style) {
            (Field::Clock(instant), Style::Clock(first)) => Some(instant.since(first)),
            (field, _) => field.number(),
        }
    }

    /// Times of the calendar are in seconds.
    pub(super) fn settle_clock(&mut self, second: Option<Unit>) {
        if !matches!(self.style, Style::Clock(_)) {
            return;
        }
        match &self.unit {
            None => self.unit = second,
            Some(unit) if Some(unit) == second.as_ref() => {}
            Some(unit) => {
                let (text, unit) = (&self.heading.text, &unit.symbol);
                let message =
                    say!("column \"{text}\" is in {unit}, and holds times of the calendar");
                let help =
                    say!("leave the unit out: such times count in seconds from the first one");
                self.faults.push(
                    Fault::new(UNIT_CLASH, self.span.clone(), message)
                        .label(say!("in {unit}"))
                        .help(help),
                );
            }
        }
    }

    /// Whether a column that should hold numbers has words in all its rows.
    fn holds_words(&self) -> bool {
        /// One word is a slip, and two may be; nothing but the words of the message depends on it.
        const SEVERAL: usize = 3;
        let has_none = self.numbers.iter().all(|number| number.is_nan());
        let is_number_with_more = |text: &str| text.starts_with(|c: char| c.is_ascii_digit());
        let first = self.first_refused.as_deref();
        self.content == Content::Numbers
            && has_none
            && self.refused >= SEVERAL
            && first.is_some_and(|text| !is_number_with_more(text))
    }

    pub(super) fn take_faults(&mut self) -> Vec<Fault> {
        if self.holds_words() {
            self.faults.truncate(1);
            for fault in &mut self.faults {
                let name = &self.heading.name;
                fault.help = Some(say!(
                    "no field of this column is a number: if they are labels, declare it so (in an experiment `[columns] {name} = \"run\"`, \"factor\", \"position\" …), else name the column of the numbers"
                ));
            }
        }
        let more = self.refused.saturating_sub(self.faults.len());
        if let Some(last) = self.faults.last_mut().filter(|_| more > 0) {
            last.message = say!(
                "{}; {more} more fields of the column are no numbers",
                last.message
            );
        }
        std::mem::take(&mut self.faults)
    }

    pub(super) fn finish(mut self) -> Column {
        self.convert();
        let numbers = match self.content {
            Content::Decimals => self.decimals.iter().map(|exact| exact.value()).collect(),
            _ => self.numbers,
        };
        Column {
            role: self.request.role.clone(),
            header: self.heading.text.clone(),
            name: self.heading.name.clone(),
            unit: self.unit,
            decimal_comma: self.style == Style::Comma,
            epoch: match self.style {
                Style::Clock(first) => Some(first.epoch()),
                _ => None,
            },
            data: match self.content {
                Content::Labels => Data::Labels(self.labels),
                _ => Data::Numbers(numbers),
            },
            decimals: (self.content == Content::Decimals).then_some(self.decimals),
        }
    }
}
