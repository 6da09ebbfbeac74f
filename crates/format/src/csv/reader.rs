//! From a CSV file to the columns that a procedure asks for.

use std::collections::HashMap;
use std::path::Path;

use super::Recording;
use super::doubts::{Sign, same_name, two_signs};
use super::draft::{Draft, Style};
use super::faults::NO_COLUMN;
use super::field::Field;
use super::heading::Heading;
use super::request::{Content, Request};
use super::sheet::Sheet;
use super::size::fits_as_columns;
use super::source::text_of;
use super::summary::summary;
use crate::files::Files;
use gumption_core::quantity::UnitTable;
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
        let places = Places::of(&headings);
        let mut drafts: Vec<Draft> = requests
            .iter()
            .filter_map(|request| {
                let found = places.find(&sheet, &request.column);
                let at = found.map_err(|fault| faults.push(*fault)).ok()?;
                let place = sheet.name_place(at);
                Some(Draft::new(request, &headings[at], at, place))
            })
            .collect();
        decide(&mut drafts, &sheet);
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
        let mut of_fields: Vec<Fault> = Vec::new();
        for draft in &mut drafts {
            draft.settle_clock(units.parse("s").ok());
            of_fields.extend(draft.take_faults());
        }
        // A field that is written otherwise than those above it is told itself.
        if of_fields.is_empty() {
            faults.extend(two_decimal_signs(&sheet, &headings, &drafts));
        }
        if faults.is_empty() {
            faults.extend(summary(&sheet));
        }
        faults.extend(of_fields);
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
        let places = Places::of(&headings);
        let requests: Vec<Request> = headings
            .iter()
            .filter(|heading| !heading.text.is_empty())
            .map(|heading| {
                let role = match places.of_name[heading.name.as_str()].len() {
                    1 => &heading.name,
                    _ => &heading.text,
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

/// What is said of a column that a table lacks.
pub fn no_column(name: &str) -> Said {
    say!("there is no column \"{name}\"")
}

/// The rows of a CSV text below its headings.
fn headed<'t>(text: &'t str, units: &UnitTable) -> Result<(Sheet<'t>, Vec<Heading>), Box<Fault>> {
    let sheet = Sheet::new(text)?.above_units(units);
    let headings = sheet.headings(|name| Heading::read(name, units)).collect();
    Ok((sheet, headings))
}

/// Of columns that may hold either, those that hold numbers alone are numbers.
fn decide(drafts: &mut [Draft], sheet: &Sheet) {
    let is_undecided = |i: &usize| drafts[*i].content == Content::Either;
    let undecided: Vec<usize> = (0..drafts.len()).filter(is_undecided).collect();
    if undecided.is_empty() {
        return;
    }
    let mut numeric = vec![false; drafts.len()];
    let mut texts = vec![false; drafts.len()];
    // The faults of rows come with the second reading.
    let _ = sheet.visit(|row| {
        let fields: Vec<&str> = row.fields().collect();
        for i in &undecided {
            let field = fields.get(drafts[*i].place).copied();
            match Field::read(field.unwrap_or_default(), sheet).and_then(Field::number) {
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

/// Columns with decimal points beside columns with decimal commas; beside the columns asked for any other of the
/// table counts where the sign may mark thousands.
fn two_decimal_signs(sheet: &Sheet, headings: &[Heading], drafts: &[Draft]) -> Option<Fault> {
    let column = |at: usize| {
        let text = headings[at].text.as_str();
        (text, sheet.name_place(at))
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

/// Where headings stand in a table: by their text, and by their name without the unit.
struct Places<'h> {
    headings: &'h [Heading],
    of_text: HashMap<&'h str, Vec<usize>>,
    of_name: HashMap<&'h str, Vec<usize>>,
}

impl<'h> Places<'h> {
    fn of(headings: &'h [Heading]) -> Places<'h> {
        let mut places = Places {
            headings,
            of_text: HashMap::new(),
            of_name: HashMap::new(),
        };
        for (at, heading) in headings.iter().enumerate() {
            places.of_text.entry(&heading.text).or_default().push(at);
            places.of_name.entry(&heading.name).or_default().push(at);
        }
        places
    }

    /// The column of a name.
    fn find(&self, sheet: &Sheet, wanted: &str) -> Result<usize, Box<Fault>> {
        let wanted = wanted.trim();
        let exact = self.of_text.get(wanted);
        let matching = exact.or_else(|| self.of_name.get(wanted));
        match matching.map_or(&[][..], Vec::as_slice) {
            [only] => Ok(*only),
            [first, second, ..] => {
                let (first, second) = (sheet.name_place(*first), sheet.name_place(*second));
                Err(Box::new(same_name(wanted, first, second).help(say!(
                    "give each column a name of its own, or ask for it with its unit"
                ))))
            }
            [] => Err(self.lacking(sheet, wanted)),
        }
    }

    fn lacking(&self, sheet: &Sheet, wanted: &str) -> Box<Fault> {
        let texts = self.headings.iter().map(|heading| heading.text.as_str());
        let names = self.headings.iter().map(|heading| heading.name.as_str());
        let near = nearest(wanted, names.chain(texts.clone()));
        let list = texts.collect::<Vec<_>>().join(", ");
        let help = match near {
            Some(near) => say!("did you mean \"{near}\"? The columns are: {list}"),
            None => say!("the columns are: {list}"),
        };
        Box::new(
            Fault::new(NO_COLUMN, sheet.header_place(), no_column(wanted))
                .label(say!("the columns of the table"))
                .help(help),
        )
    }
}
