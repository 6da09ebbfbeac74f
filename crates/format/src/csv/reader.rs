//! From a CSV file to the columns that a procedure asks for.

use std::collections::HashMap;
use std::io::{Error, ErrorKind, Read};
use std::ops::Range;
use std::path::Path;

use super::column_unit::unit_of;
use super::doubts::{Sign, mend_of_overload, not_a, same_name, two_signs};
use super::encoding::{NoText, Undecodable, decode};
use super::faults::{NO_COLUMN, NOT_A_NUMBER, NOT_UTF8, UNIT_CLASH, UNREADABLE};
use super::field::{Field, Instant, is_like_a_time, is_overload, may_mark_thousands, mend};
use super::heading::Heading;
use super::request::{Content, Request};
use super::sheet::{Row, SHOWN, Sheet};
use super::size::{fits_as_columns, fits_as_text};
use super::summary::summary;
use super::{Column, Data, Labels, Recording};
use crate::files::Files;
use gumption_core::quantity::{Unit, UnitTable};
use gumption_core::statistics::Dd;
use gumption_fault::{Fault, Rejection, Said, nearest, say};

impl Recording {
    /// Reads the columns asked for from a file.
    ///
    /// `path` is looked up in `files` as it stands; `units` knows the units of the headers.
    ///
    /// # Errors
    /// All faults of the file at once, each at its place in the text.
    pub fn open(
        files: Files,
        path: &Path,
        requests: &[Request],
        units: &UnitTable,
    ) -> Result<Recording, Rejection> {
        let name = path.display().to_string();
        let text = text_of(files, path, &name)?;
        Recording::read(&name, &text, requests, units)
    }

    /// Reads the columns asked for from a text; `name` is that of the file, for messages.
    ///
    /// # Errors
    /// All faults of the text at once, each at its place in it.
    pub fn read(
        name: &str,
        text: &str,
        requests: &[Request],
        units: &UnitTable,
    ) -> Result<Recording, Rejection> {
        let reject = |faults| Rejection::new(name, text, faults);
        let (sheet, headings) = headed(text, units).map_err(|fault| reject(vec![*fault]))?;
        fits_as_columns(name, text, requests.len())
            .map_err(|fault| Rejection::new(name, "", vec![*fault]))?;
        let mut faults = Vec::new();
        let mut drafts: Vec<Draft> = requests
            .iter()
            .filter_map(|request| {
                Draft::new(&sheet, &headings, request)
                    .map_err(|fault| faults.push(*fault))
                    .ok()
            })
            .collect();
        let undecided: Vec<usize> = (0..drafts.len())
            .filter(|i| drafts[*i].content == Content::Either)
            .collect();
        if !undecided.is_empty() {
            let mut numeric = vec![false; drafts.len()];
            let mut texts = vec![false; drafts.len()];
            // The faults of rows come with the second reading.
            let _ = sheet.visit(|row| {
                let fields: Vec<&str> = row.fields().collect();
                for i in &undecided {
                    let field = fields.get(drafts[*i].place).copied();
                    match Field::read(field.unwrap_or_default(), &sheet).and_then(Field::number) {
                        Some(value) => numeric[*i] |= !value.is_nan(),
                        None => texts[*i] = true,
                    }
                }
            });
            for i in undecided {
                drafts[i].content = match numeric[i] && !texts[i] {
                    true => Content::Numbers,
                    false => Content::Labels,
                };
            }
        }
        for draft in &mut drafts {
            draft.settle_unit(&mut faults);
        }
        let mut lines = Vec::new();
        let visited = sheet.visit(|row| {
            lines.push(row.line);
            // A row is walked through once: it finds a field by counting those in front of it.
            let fields: Vec<&str> = row.fields().collect();
            for draft in &mut drafts {
                let field = fields.get(draft.place).copied();
                draft.take(&sheet, row, field.unwrap_or_default());
            }
        });
        faults.extend(visited.err().unwrap_or_default());
        faults.extend(two_decimal_signs(&sheet, &headings, &drafts));
        if faults.is_empty() {
            faults.extend(summary(&sheet));
        }
        for draft in &mut drafts {
            draft.settle_clock(units.parse("s").ok());
            faults.extend(draft.take_faults());
        }
        if !faults.is_empty() {
            return Err(reject(faults));
        }
        Ok(Recording {
            name: name.to_owned(),
            columns: drafts.into_iter().map(Draft::finish).collect(),
            lines,
        })
    }

    /// Reads all columns that have a name. The role of each is its name without the unit, or the whole
    /// text of the header where others have that name too.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_all(name: &str, text: &str, units: &UnitTable) -> Result<Recording, Rejection> {
        let headings =
            headings(text, units).map_err(|fault| Rejection::new(name, text, vec![*fault]))?;
        let alone = |heading: &Heading| {
            headings
                .iter()
                .filter(|other| other.name == heading.name)
                .count()
                == 1
        };
        let requests: Vec<Request> = headings
            .iter()
            .filter(|heading| !heading.text.is_empty())
            .map(|heading| {
                let role = if alone(heading) {
                    &heading.name
                } else {
                    &heading.text
                };
                Request {
                    content: Content::Either,
                    ..Request::numbers(role, &heading.text)
                }
            })
            .collect();
        Recording::read(name, text, &requests, units)
    }
}

/// The headings of a CSV text, in the order of its columns.
///
/// # Errors
/// When the text has no line of names.
pub fn headings(text: &str, units: &UnitTable) -> Result<Vec<Heading>, Box<Fault>> {
    headed(text, units).map(|(_, headings)| headings)
}

/// The rows of a CSV text below its headings.
fn headed<'t>(text: &'t str, units: &UnitTable) -> Result<(Sheet<'t>, Vec<Heading>), Box<Fault>> {
    let sheet = Sheet::new(text)?.above_units(units);
    let columns = 0..sheet.header().len();
    let headings = columns.map(|at| sheet.heading(at, |name| Heading::read(name, units)));
    let headings = headings.collect();
    Ok((sheet, headings))
}

/// The text of a table that another file names, in whichever encoding it was saved.
///
/// # Errors
/// It is not there, may not be read, or is no text.
pub fn text_of(files: Files, path: &Path, name: &str) -> Result<String, Rejection> {
    let refuse = |code, message: Said, help: Said| {
        Rejection::new(name, "", vec![Fault::new(code, 0..0, message).help(help)])
    };
    if let Some(bytes) = files.length(path) {
        fits_as_text(name, bytes).map_err(|fault| Rejection::new(name, "", vec![*fault]))?;
    }
    let bytes = files.read(path).map_err(|error| {
        let mut fault = unreadable(files, path, name, &error);
        if fault.help.is_none() {
            fault = fault.help(say!(
                "the path starts from the folder of the file that names it"
            ));
        }
        Rejection::new(name, "", vec![fault])
    })?;
    if let Some(other) = NoText::of(&bytes) {
        return Err(refuse(NOT_UTF8, say!("{name} is no CSV"), other.mend()));
    }
    let decoded = decode(&bytes).map_err(|error| {
        let Undecodable { byte, line } = error;
        let message =
            say!("{name} is neither UTF-8, UTF-16 nor GBK from byte {byte} on, in line {line}");
        refuse(
            NOT_UTF8,
            message,
            say!("save it as CSV in UTF-8: spreadsheets call it “CSV UTF-8”; or convert it, `iconv -f LATIN1 -t UTF-8 old.csv > new.csv`"),
        )
    })?;
    match is_table(&decoded.text) {
        true => Ok(decoded.text),
        false => Err(refuse(
            UNREADABLE,
            say!("{name} is no table of values: no line below its first has a number"),
            say!("name a CSV file with the names of columns in its first line"),
        )),
    }
}

/// A table that is read piece by piece.
///
/// # Errors
/// It is not there, or may not be read.
pub fn open<'f>(
    files: Files<'f>,
    path: &Path,
    name: &str,
) -> Result<Box<dyn Read + 'f>, Rejection> {
    let opened = match files.is_folder(path) {
        true => Err(ErrorKind::IsADirectory.into()),
        false => files.open(path),
    };
    opened.map_err(|error| Rejection::new(name, "", vec![unreadable(files, path, name, &error)]))
}

fn unreadable(files: Files<'_>, path: &Path, name: &str, error: &Error) -> Fault {
    let message = match error.kind() {
        _ if files.is_folder(path) => say!("{name} is a folder, not a file"),
        ErrorKind::NotFound => say!("there is no file {name}"),
        ErrorKind::PermissionDenied => say!("{name} may not be read"),
        _ => say!("{name} cannot be read: {error}"),
    };
    let fault = Fault::new(UNREADABLE, 0..0, message);
    let near = (error.kind() == ErrorKind::NotFound).then(|| files.near(path));
    match near.flatten() {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault,
    }
}

/// Whether a text may be a table of values; nothing is quoted of one that cannot be, as it may be anything.
fn is_table(text: &str) -> bool {
    /// Lines that are looked at.
    const MOST: usize = 1000;
    let number = |field: &str| {
        let field = field.trim().trim_matches('"');
        let time = |c: char| c.is_ascii_digit() || ":.-+TZ/ ".contains(c);
        field.parse::<f64>().is_ok()
            || (field.starts_with(|c: char| c.is_ascii_digit()) && field.chars().all(time))
    };
    let mut lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    lines.next().is_none()
        || lines
            .take(MOST)
            .any(|line| line.split([',', ';', '\t']).any(number))
}

/// A column that is being read.
struct Draft<'a> {
    request: &'a Request,
    heading: &'a Heading,
    place: usize,
    span: Range<usize>,
    content: Content,
    unit: Option<Unit>,
    numbers: Vec<f64>,
    decimals: Vec<Dd>,
    labels: Labels,
    levels: HashMap<String, u32>,
    faults: Vec<Fault>,
    refused: usize,
    style: Style,
    /// Whether every decimal sign so far may mark thousands.
    only_thousands: bool,
}

/// How the numbers of a column are written so far.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Style {
    Unknown,
    Whole,
    Point,
    Comma,
    /// As times, with the first of them.
    Clock(Instant),
}

impl<'a> Draft<'a> {
    fn new(
        sheet: &Sheet,
        headings: &'a [Heading],
        request: &'a Request,
    ) -> Result<Draft<'a>, Box<Fault>> {
        let place = find(sheet, headings, &request.column)?;
        Ok(Draft {
            request,
            heading: &headings[place],
            place,
            span: sheet.place(sheet.header(), place),
            content: request.content,
            unit: None,
            numbers: Vec::new(),
            decimals: Vec::new(),
            labels: Labels::default(),
            levels: HashMap::new(),
            faults: Vec::new(),
            refused: 0,
            style: Style::Unknown,
            only_thousands: true,
        })
    }

    /// The unit that the header and the asker agree on. Labels have none.
    fn settle_unit(&mut self, faults: &mut Vec<Fault>) {
        if self.content == Content::Labels {
            return;
        }
        match unit_of(self.heading, self.request, &self.span) {
            Ok(unit) => self.unit = unit,
            Err(fault) => faults.push(*fault),
        }
    }

    fn take(&mut self, sheet: &Sheet, row: &Row, field: &str) {
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
        // Times that cannot be read are so in every row of the column: one says it.
        let is_time = read.is_none() && is_like_a_time(field);
        let (shown, expected) = match is_time {
            true => (1, "a time of a known form"),
            false => (SHOWN, "a number"),
        };
        if self.faults.len() < shown {
            let help = match read {
                Some(_) => say!(
                    "write all numbers of a column alike: all with a decimal point, all with a decimal comma, or all as times"
                ),
                None => mend(field),
            };
            let fault = self.no_number(sheet, row, expected.into(), help);
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
    fn number(&mut self, field: Field) -> Option<f64> {
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
    fn settle_clock(&mut self, second: Option<Unit>) {
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

    fn take_faults(&mut self) -> Vec<Fault> {
        let more = self.refused.saturating_sub(self.faults.len());
        if let Some(last) = self.faults.last_mut().filter(|_| more > 0) {
            last.message = say!(
                "{}; {more} more fields of the column are no numbers",
                last.message
            );
        }
        std::mem::take(&mut self.faults)
    }

    fn finish(mut self) -> Column {
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
            data: match self.content {
                Content::Labels => Data::Labels(self.labels),
                _ => Data::Numbers(numbers),
            },
            decimals: (self.content == Content::Decimals).then_some(self.decimals),
        }
    }
}

/// Columns with decimal points beside columns with decimal commas; beside the columns asked for any other of the
/// table counts where the sign may mark thousands.
fn two_decimal_signs(sheet: &Sheet, headings: &[Heading], drafts: &[Draft]) -> Option<Fault> {
    let column = |at: usize| {
        let text = headings[at].text.as_str();
        (text, sheet.place(sheet.header(), at))
    };
    let asked = |style: Style| Some(drafts.iter().find(|draft| draft.style == style)?.place);
    let beside = |style: Style, other: Sign| {
        let doubtful = |draft: &&Draft| draft.style == style && draft.only_thousands;
        let draft = drafts.iter().find(doubtful)?;
        Some((draft.place, other.first_in(sheet, |_| true)?))
    };
    let both = asked(Style::Point).zip(asked(Style::Comma));
    let both = both.or_else(|| beside(Style::Point, Sign::Comma));
    let swapped = || beside(Style::Comma, Sign::Point).map(|(commas, points)| (points, commas));
    let (points, commas) = both.or_else(swapped)?;
    Some(two_signs(column(points), column(commas)))
}

/// The column of a name.
fn find(sheet: &Sheet, headings: &[Heading], wanted: &str) -> Result<usize, Box<Fault>> {
    let wanted = wanted.trim();
    let those = |key: fn(&Heading) -> &str| -> Vec<usize> {
        (0..headings.len())
            .filter(|i| key(&headings[*i]) == wanted)
            .collect()
    };
    let exact = those(|heading| &heading.text);
    let matching = if exact.is_empty() {
        those(|heading| &heading.name)
    } else {
        exact
    };
    let span = |i: usize| sheet.place(sheet.header(), i);
    match matching[..] {
        [only] => Ok(only),
        [first, second, ..] => Err(Box::new(same_name(wanted, span(first), span(second)).help(
            say!("give each column a name of its own, or ask for it with its unit"),
        ))),
        [] => {
            let texts: Vec<&str> = headings
                .iter()
                .map(|heading| heading.text.as_str())
                .collect();
            let names = headings.iter().map(|heading| heading.name.as_str());
            let near = nearest(wanted, names.chain(texts.iter().copied()));
            let list = texts.join(", ");
            let help = match near {
                Some(near) => say!("did you mean \"{near}\"? The columns are: {list}"),
                None => say!("the columns are: {list}"),
            };
            let whole = span(0).start..span(headings.len().saturating_sub(1)).end;
            let message = say!("there is no column \"{wanted}\"");
            Err(Box::new(
                Fault::new(NO_COLUMN, whole, message)
                    .label(say!("the columns of the table"))
                    .help(help),
            ))
        }
    }
}
