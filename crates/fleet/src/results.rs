//! A table of results as columns of numbers: nothing is kept of a row but these, its group and the name of its device.

use std::collections::HashMap;
use std::io::Read;
use std::ops::Range;

use gumption_core::quantity::{Decimal, Unit};
use gumption_fault::{Fault, Rejection, say};
use gumption_format::csv::faults::{NO_HEADER, NO_ROWS, NOT_A_NUMBER};
use gumption_format::csv::{self, Columns, Piece, Pieces, Row, Sheet};

use crate::faults::{DISAGREE, NOT_A_DATE, SIGN};
use crate::layout::{Layout, NumberColumn, StatedColumns, layout};
use crate::wanted::Wanted;

/// The columns of a table.
#[derive(Debug)]
pub(crate) struct Results {
    pub rows: usize,
    pub measurands: Vec<MeasurandValues>,
    pub devices: Texts,
    /// The values of the columns by which rows are grouped.
    pub groups: Levels,
    /// Days since 1970-01-01; NaN where there is none.
    pub dates: Option<Vec<f64>>,
    pub verdicts: Vec<(String, Levels)>,
    pub findings: Levels,
    /// The code of the fault of each row; empty for a good one.
    pub errors: Levels,
}

/// What the rows say of a measurand.
#[derive(Debug)]
pub(crate) struct MeasurandValues {
    pub name: String,
    pub unit: Unit,
    pub values: Values,
    pub shares: Vec<(String, Vec<f64>)>,
    pub reference: Option<(String, Values)>,
}

/// A quantity with its uncertainty, row by row; NaN where there is none.
#[derive(Debug, Default)]
pub(crate) struct Values {
    pub estimate: Vec<f64>,
    pub u: Vec<f64>,
    pub dof: Vec<f64>,
    pub expanded: Vec<f64>,
}

/// Texts one behind the other.
#[derive(Debug, Default)]
pub(crate) struct Texts {
    text: String,
    ends: Vec<usize>,
}

/// Texts of which there are few, each stored once.
#[derive(Debug, Default)]
pub(crate) struct Levels {
    pub names: Vec<String>,
    known: HashMap<String, u32>,
    pub of_row: Vec<u32>,
}

/// What stands between the values of several columns in a level.
pub(crate) const BETWEEN: char = '\u{1f}';

impl Texts {
    fn push(&mut self, text: &str) {
        self.text.push_str(text);
        self.ends.push(self.text.len());
    }

    /// The text of a row; its number where it has none.
    pub fn name(&self, row: usize) -> String {
        match self.get(row) {
            "" => (row + 1).to_string(),
            name => name.to_owned(),
        }
    }

    /// The text of a row.
    pub fn get(&self, row: usize) -> &str {
        let end = |row: usize| self.ends.get(row).copied().unwrap_or_default();
        let start = row.checked_sub(1).map_or(0, end);
        &self.text[start..end(row).max(start)]
    }
}

impl Levels {
    /// The text of a row.
    pub fn get(&self, row: usize) -> &str {
        &self.names[self.of_row[row] as usize]
    }

    fn push(&mut self, text: &str) {
        let level = match self.known.get(text) {
            Some(level) => *level,
            None => {
                let level = self.names.len() as u32;
                self.names.push(text.to_owned());
                self.known.insert(text.to_owned(), level);
                level
            }
        };
        self.of_row.push(level);
    }
}

/// Reads a table piece by piece; `name` is that of the table, for messages.
///
/// # Errors
/// All faults of its first line, or some of its rows.
pub(crate) fn read(source: impl Read, name: &str, wanted: &Wanted) -> Result<Results, Rejection> {
    let mut pieces = Pieces::new(source);
    let refused = |fault: Box<Fault>| Rejection::new(name, "", vec![*fault]);
    let none = || {
        let fault = Fault::new(NO_HEADER, 0..0, say!("the table is empty"));
        Err(Box::new(fault))
    };
    let first = pieces.next().unwrap_or_else(none).map_err(refused)?;
    let in_first = |faults| Rejection::new(name, &first.text, faults);
    let head = Sheet::new(&first.text).map_err(|fault| in_first(vec![*fault]))?;
    let layout = layout(&head, wanted).map_err(in_first)?;
    let is_number = |at| layout.numbers().any(|one| one == at);
    let doubts = csv::two_decimal_signs(&head, is_number).into_iter();
    let doubts: Vec<Fault> = doubts
        .chain(csv::summary_of_rows(&head, is_number))
        .collect();
    if !doubts.is_empty() {
        return Err(in_first(doubts));
    }
    let mut results = Results::of(&layout);
    results.add(&head, &layout).map_err(in_first)?;
    for piece in pieces {
        let Piece { text, line } = piece.map_err(refused)?;
        let sheet = head.below(&text, line);
        // The lines of a later piece are not those of the file.
        let refused = |mut faults: Vec<Fault>| {
            faults
                .iter_mut()
                .for_each(|fault| (fault.span, fault.related) = (0..0, Vec::new()));
            Rejection::new(name, "", faults)
        };
        results.add(&sheet, &layout).map_err(refused)?;
    }
    results.some(&head).map_err(in_first)
}

/// As [`read`], of a table in memory.
///
/// # Errors
/// As of [`read`].
pub(crate) fn read_columns(
    columns: &Columns<'_>,
    name: &str,
    wanted: &Wanted,
) -> Result<Results, Rejection> {
    let text = columns.head();
    let refused = |faults| Rejection::new(name, &text, faults);
    let head = Sheet::new(&text).map_err(|fault| refused(vec![*fault]))?;
    let layout = layout(&head, wanted).map_err(refused)?;
    let is_number = |at| layout.numbers().any(|one| one == at);
    if let Some(doubt) = csv::summary_of_columns(columns, &head, is_number) {
        return Err(refused(vec![doubt]));
    }
    let mut results = Results::of(&layout);
    let rows = (0..columns.rows()).map(|at| columns.row(at)).map(Ok);
    // What is wrong with a row stands in no text.
    let nowhere = |_: &Row<'_>, _| 0..0;
    let added = results.add_rows(rows, &head, &layout, nowhere);
    added.map_err(|faults| Rejection::new(name, "", faults))?;
    results.some(&head).map_err(refused)
}

/// Faults of rows that are told at once.
const SHOWN: usize = 5;

impl Results {
    fn of(layout: &Layout) -> Results {
        let measurands = layout.measurands.iter().map(|columns| MeasurandValues {
            name: columns.stated.name.clone(),
            unit: columns.stated.unit.clone(),
            values: Values::default(),
            shares: columns
                .shares
                .iter()
                .map(|(name, _)| (name.clone(), Vec::new()))
                .collect(),
            reference: columns
                .reference
                .as_ref()
                .map(|one| (one.name.clone(), Values::default())),
        });
        let verdicts = layout.verdicts.iter();
        Results {
            rows: 0,
            measurands: measurands.collect(),
            devices: Texts::default(),
            groups: Levels::default(),
            dates: layout.date.map(|_| Vec::new()),
            verdicts: verdicts
                .map(|(name, _)| (name.clone(), Levels::default()))
                .collect(),
            findings: Levels::default(),
            errors: Levels::default(),
        }
    }

    fn add(&mut self, sheet: &Sheet<'_>, layout: &Layout) -> Result<(), Vec<Fault>> {
        let place = |row: &Row<'_>, at| sheet.place(row, at);
        let rows = sheet.rows();
        let rows = rows.map(|row| row.map_err(|bad| Box::new(bad.fault)));
        self.add_rows(rows, sheet, layout, place)
    }

    fn add_rows<'r>(
        &mut self,
        rows: impl Iterator<Item = Result<Row<'r>, Box<Fault>>>,
        sheet: &Sheet<'_>,
        layout: &Layout,
        place: impl Fn(&Row<'r>, usize) -> Range<usize>,
    ) -> Result<(), Vec<Fault>> {
        let mut faults = Vec::new();
        for row in rows {
            let added = row.and_then(|row| {
                let fields: Vec<&str> = row.fields().collect();
                let place = |at| (place(&row, at), row.line);
                self.push(
                    &Fields {
                        fields: &fields,
                        sheet,
                        place: &place,
                    },
                    layout,
                )
            });
            if let Err(fault) = added {
                faults.push(*fault);
                if faults.len() == SHOWN {
                    break;
                }
            }
        }
        match faults.is_empty() {
            true => Ok(()),
            false => Err(faults),
        }
    }

    /// The devices of rows that have dates, as numbers: such a table has the same device several times. A row without a name is one
    /// of its own.
    pub fn numbered_devices(&self) -> Option<Vec<u32>> {
        self.dates.as_ref()?;
        let mut known: HashMap<&str, u32> = HashMap::new();
        let numbered = (0..self.rows).map(|row| {
            let own = row as u32;
            match self.devices.get(row) {
                "" => own,
                name => *known.entry(name).or_insert(own),
            }
        });
        Some(numbered.collect())
    }

    /// These results, if there are any.
    fn some(self, head: &Sheet<'_>) -> Result<Results, Vec<Fault>> {
        if self.rows > 0 {
            return Ok(self);
        }
        let place = head.name_place(0);
        let fault = Fault::new(NO_ROWS, place, say!("the table has no rows"));
        Err(vec![fault.label(say!("nothing follows this line"))])
    }

    fn push(&mut self, row: &Fields<'_>, layout: &Layout) -> Result<(), Box<Fault>> {
        self.rows += 1;
        let text = |at: Option<usize>| at.map_or("", |at| row.fields[at]);
        let error = text(layout.error);
        self.errors.push(code(error));
        self.findings.push(text(layout.findings));
        for ((_, levels), (_, at)) in self.verdicts.iter_mut().zip(&layout.verdicts) {
            levels.push(row.fields[*at]);
        }
        if let Some(device) = layout.device {
            self.devices.push(row.fields[device]);
        }
        match layout.by[..] {
            [] => self.groups.push(""),
            [one] => self.groups.push(row.fields[one]),
            _ => {
                let mut key = String::new();
                for (at, column) in layout.by.iter().enumerate() {
                    key.extend((at > 0).then_some(BETWEEN));
                    key.push_str(row.fields[*column]);
                }
                self.groups.push(&key);
            }
        }
        if let (Some(dates), Some(at)) = (&mut self.dates, layout.date) {
            dates.push(row.date(at)?);
        }
        let is_good = error.is_empty();
        for (found, columns) in self.measurands.iter_mut().zip(&layout.measurands) {
            found.values.push(row, &columns.stated, is_good, f64::NAN)?;
            let k = found.values.last_k();
            if let (Some((_, values)), Some(columns)) = (&mut found.reference, &columns.reference) {
                values.push(row, columns, is_good, k)?;
            }
            for ((_, shares), (_, at)) in found.shares.iter_mut().zip(&columns.shares) {
                shares.push(if is_good { row.number(*at)? } else { f64::NAN });
            }
        }
        Ok(())
    }
}

/// The code with which an error begins; its beginning, where it has none.
fn code(error: &str) -> &str {
    let code = error.split_once(':').map_or(error, |(code, _)| code);
    match code.char_indices().nth(24) {
        Some((end, _)) => &code[..end],
        None => code,
    }
}

/// The fields of a row, and their places and line.
struct Fields<'r> {
    fields: &'r [&'r str],
    sheet: &'r Sheet<'r>,
    place: &'r dyn Fn(usize) -> (std::ops::Range<usize>, usize),
}

impl Fields<'_> {
    fn number(&self, at: usize) -> Result<f64, Box<Fault>> {
        let field = self.fields[at];
        if let Some(number) = csv::number(field, self.sheet) {
            return Ok(number);
        }
        let (place, line) = (self.place)(at);
        let message = say!("line {line}: \"{field}\" is not a number");
        let fault = Fault::new(NOT_A_NUMBER, place, message).label(say!("expected a number"));
        Err(Box::new(fault.help(say!(
            "leave the field empty where there is none; a row without a result says why in the column `error`"
        ))))
    }

    fn number_in(&self, column: NumberColumn) -> Result<f64, Box<Fault>> {
        Ok(column.converted(self.number(column.at)?))
    }

    /// A number that is none of those that cannot be.
    fn size(&self, at: usize, cannot_be: impl Fn(f64) -> bool) -> Result<f64, Box<Fault>> {
        let number = self.number(at)?;
        if !cannot_be(number) {
            return Ok(number);
        }
        let (place, line) = (self.place)(at);
        let (column, field) = (self.sheet.header().field(at), self.fields[at]);
        let message = say!("line {line}: {column} cannot be {field}");
        let label = say!("not negative; coverage factors and degrees of freedom greater than zero");
        let fault = Fault::new(SIGN, place, message).label(label);
        Err(Box::new(fault.help(say!(
            "correct the number, or leave the field empty where there is none"
        ))))
    }

    /// An uncertainty; NaN where there is no such column.
    fn spread(&self, column: Option<NumberColumn>) -> Result<f64, Box<Fault>> {
        let Some(column) = column else {
            return Ok(f64::NAN);
        };
        Ok(column.converted(self.size(column.at, |number| number < 0.0)?))
    }

    /// A coverage factor; NaN where there is none.
    fn factor(&self, at: Option<usize>) -> Result<f64, Box<Fault>> {
        at.map_or(Ok(f64::NAN), |at| self.size(at, |number| number <= 0.0))
    }

    /// Refuses U, k and u that contradict each other beyond what they may be rounded by.
    fn agree(&self, columns: &StatedColumns) -> Result<(), Box<Fault>> {
        let (Some(u), Some(k), Some(expanded)) = (columns.u, columns.k, columns.expanded) else {
            return Ok(());
        };
        let plain = NumberColumn { at: k, into: None };
        // From the least to the largest that is written so.
        let range = |column: NumberColumn, most: f64| -> Option<[f64; 2]> {
            let number = self.number(column.at).ok()?;
            let written = Decimal::from_text(&self.fields[column.at].replace(',', "."));
            let half = 0.5 * 10f64.powi(written.and_then(|written| written.place())?);
            let half = half.min(most);
            Some([number - half, number + half].map(|end| column.converted(end)))
        };
        // A k without decimals is not rounded by more than its tenths: 2 may be 1.96.
        let (Some([least_u, most_u]), Some([least_k, most_k]), Some([least, most])) = (
            range(u, f64::INFINITY),
            range(plain, 0.05),
            range(expanded, f64::INFINITY),
        ) else {
            return Ok(());
        };
        if least <= most_u * most_k && least_u.max(0.0) * least_k.max(0.0) <= most {
            return Ok(());
        }
        let (place, line) = (self.place)(expanded.at);
        let name = &columns.name;
        let [u, k, expanded] = [u.at, k, expanded.at].map(|at| self.fields[at]);
        let message = say!("line {line}: U({name}) = {expanded} is not k·u = {k}·{u}");
        let fault = Fault::new(DISAGREE, place, message)
            .label(say!("k({name}) times u({name}) is another number"));
        Err(Box::new(fault.help(say!(
            "correct the one that is wrong, or leave a column out: two of u({name}), k({name}) and U({name}) are enough"
        ))))
    }

    /// Degrees of freedom: infinite where nothing says how many.
    fn dof(&self, at: Option<usize>) -> Result<f64, Box<Fault>> {
        let dof = at.map_or(Ok(f64::NAN), |at| self.size(at, |number| number <= 0.0))?;
        Ok(if dof.is_nan() { f64::INFINITY } else { dof })
    }

    /// Days since 1970-01-01; NaN where there is none.
    fn date(&self, at: usize) -> Result<f64, Box<Fault>> {
        let field = self.fields[at];
        if field.is_empty() {
            return Ok(f64::NAN);
        }
        csv::days(field).ok_or_else(|| {
            let (place, line) = (self.place)(at);
            let message = say!("line {line}: \"{field}\" is not a date");
            let fault = Fault::new(NOT_A_DATE, place, message).label(say!("expected a date"));
            Box::new(fault.help(match csv::date_meant(field) {
                Some(meant) => say!("write {meant}"),
                None => {
                    say!("write it as 2026-03-01, or leave the field empty where it is not known")
                }
            }))
        })
    }
}

impl Values {
    /// Adds what a row says; `k` is that of a value whose own is not stated.
    fn push(
        &mut self,
        row: &Fields<'_>,
        columns: &StatedColumns,
        is_good: bool,
        k: f64,
    ) -> Result<(), Box<Fault>> {
        let mut stated = [f64::NAN; 3];
        let (mut estimate, mut dof) = (f64::NAN, f64::INFINITY);
        if is_good {
            estimate = row.number_in(columns.value)?;
            dof = row.dof(columns.dof)?;
            let own = row.factor(columns.k)?;
            let k = if own.is_nan() { k } else { own };
            stated = [row.spread(columns.u)?, k, row.spread(columns.expanded)?];
            let [u, k, expanded] = stated;
            // What is missing contradicts nothing.
            if (expanded - k * u).abs() > 1e-9 * expanded {
                row.agree(columns)?;
            }
        }
        let [u, k, expanded] = stated;
        self.estimate.push(estimate);
        self.dof.push(dof);
        self.u.push(if u.is_nan() { expanded / k } else { u });
        self.expanded
            .push(if expanded.is_nan() { k * u } else { expanded });
        Ok(())
    }

    /// The coverage factor of a row.
    pub fn k(&self, row: usize) -> f64 {
        self.expanded[row] / self.u[row]
    }

    /// That of the row added last: rows with faults are in the count of all and not here.
    fn last_k(&self) -> f64 {
        let last = self.expanded.last().zip(self.u.last());
        last.map_or(f64::NAN, |(expanded, u)| expanded / u)
    }

    /// Whether a row has an estimate with an uncertainty that weighs it.
    pub fn weighs(&self, row: usize) -> bool {
        self.estimate[row].is_finite() && self.u[row] > 0.0 && self.u[row].is_finite()
    }
}
