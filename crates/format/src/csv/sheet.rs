//! The text of a CSV file as rows of fields, with the place of every field. This is the crate's plain
//! reading of CSV: it knows columns by their number and nothing of what they mean.

use std::borrow::Cow;
use std::io::Cursor;
use std::ops::Range;
use std::sync::Arc;

use ::csv::{Position, Reader, ReaderBuilder, StringRecord, Trim};
use memchr::{memchr_iter, memchr3};

use super::faults::{NO_HEADER, NO_ROWS, ROW_LENGTH};
use super::preamble;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Said, say};

/// A CSV text whose first line was read.
///
/// Columns are separated by `,`, `;` or tab: whichever occurs as often in the first row as in the line of
/// names, and of these the one that occurs most. Empty lines and lines that begin with `#` do not count.
#[derive(Debug, Clone)]
pub struct Sheet<'a> {
    text: &'a str,
    /// Where the text begins in the table: its line, and the rows in it that are no data.
    line: usize,
    skipped: usize,
    separator: u8,
    header: Row<'a>,
    /// Where the names of the columns stand. Any of them may be asked for, and there may be thousands.
    names: Arc<[Range<usize>]>,
    /// Of each column, where a line below that of the names holds them.
    units: Vec<Option<Unit>>,
}

/// A row that was read.
#[derive(Debug, Clone)]
pub struct Row<'a> {
    fields: Fields<'a>,
    len: usize,
    start: usize,
    /// Its line in the text, the first being 1.
    pub line: usize,
}

/// The fields of a row.
#[derive(Debug, Clone)]
enum Fields<'a> {
    /// A line without quotes, and what separates them in it.
    Line(&'a str, u8),
    /// Of a row with quotes, or of no text at all.
    Quoted(StringRecord),
}

/// Longer lists of faults of one kind are cut, with their number.
pub(super) const SHOWN: usize = 5;

/// A row that has another length than the first line, or does not end.
#[derive(Debug, Clone)]
pub struct BadRow<'a> {
    /// What is wrong with it.
    pub fault: Fault,
    /// Its fields, where it ends.
    pub row: Option<Row<'a>>,
}

impl<'a> Sheet<'a> {
    /// Reads the first line.
    ///
    /// # Errors
    /// When there is none, or when it holds numbers instead of names.
    pub fn new(text: &'a str) -> Result<Sheet<'a>, Box<Fault>> {
        let first = start_of_record(text, 0);
        let line = text[first..].lines().next().unwrap_or_default();
        let separator = separator(text, first, line);
        let whole = first..first + line.len();
        let missing = |message: Said, label: Said| {
            Box::new(
                Fault::new(NO_HEADER, whole.clone(), message)
                    .label(label)
                    .help(say!(
                        "name the columns in the first line, with their units: time [s],U [mV]"
                    )),
            )
        };
        if let Some(names) = preamble::names_below(&text[first..]) {
            let names = names + text[..first].lines().count();
            let message =
                say!("the names of the columns stand in line {names}, not in the first line");
            let fault = Fault::new(NO_HEADER, whole.clone(), message);
            let help = say!("delete the lines above line {names}, or begin each of them with #");
            return Err(Box::new(fault.label(say!("expected names")).help(help)));
        }
        let header = Rows::new(text, separator, 1)
            .next()
            .ok_or_else(|| missing(say!("the table is empty"), say!("no names of columns")))?
            .map_err(|message| missing(message.into(), say!("cannot be read")))?;
        let numbers = header.fields().filter(|field| field.parse::<f64>().is_ok());
        if numbers.count() > header.len() / 2 {
            return Err(missing(
                say!("the first line holds numbers, not the names of the columns"),
                say!("expected names"),
            ));
        }
        let names = extents(text, separator, header.start);
        Ok(Sheet {
            text,
            line: 1,
            skipped: 1,
            separator,
            names: names.map(|name| trimmed_place(text, name)).collect(),
            header,
            units: Vec::new(),
        })
    }

    /// Further rows of the same table, from this line on.
    pub fn below<'b>(&self, text: &'b str, line: usize) -> Sheet<'b>
    where
        'a: 'b,
    {
        Sheet {
            text,
            line,
            skipped: 0,
            separator: self.separator,
            header: self.header.clone(),
            names: Arc::clone(&self.names),
            units: self.units.clone(),
        }
    }

    /// The same table, of which the first row is no data either: it holds units.
    #[must_use]
    pub(super) fn with_units(mut self, units: Vec<Option<Unit>>) -> Sheet<'a> {
        self.skipped += 1;
        self.units = units;
        self
    }

    /// The unit of a column in a line of units.
    pub(super) fn unit_below(&self, column: usize) -> Option<&Unit> {
        self.units.get(column)?.as_ref()
    }

    /// The text.
    pub fn text(&self) -> &'a str {
        self.text
    }

    /// The first line.
    pub fn header(&self) -> &Row<'a> {
        &self.header
    }

    /// Whether a comma in a field can be a decimal sign: where it separates no columns.
    pub fn has_decimal_commas(&self) -> bool {
        self.separator != b','
    }

    /// The place of a field of a row in the text, without white space around it; the end of the row
    /// for a field that it lacks.
    pub fn place(&self, row: &Row<'_>, column: usize) -> Range<usize> {
        let mut end = row.start;
        for (number, field) in extents(self.text, self.separator, row.start).enumerate() {
            if number == column {
                return trimmed_place(self.text, field);
            }
            end = field.end;
        }
        end..end
    }

    /// The place of the name of a column.
    pub fn name_place(&self, column: usize) -> Range<usize> {
        let end = self.names.last().map_or(0, |name| name.end);
        self.names.get(column).cloned().unwrap_or(end..end)
    }

    /// The place of all names.
    pub fn header_place(&self) -> Range<usize> {
        self.name_place(0).start..self.name_place(self.header.len().saturating_sub(1)).end
    }

    /// Goes through the rows below the first line; returns how many there are.
    ///
    /// # Errors
    /// Rows of another length than the first line (a few, with the number of all), or no rows. The
    /// visitor sees the good rows in any case, so that their faults can be told as well.
    pub fn visit(&self, mut visitor: impl FnMut(&Row<'_>)) -> Result<usize, Vec<Fault>> {
        let mut faults = Vec::new();
        let (mut good, mut bad) = (0, 0);
        for row in self.rows() {
            match row {
                Ok(row) => {
                    good += 1;
                    visitor(&row);
                }
                Err(bad_row) => {
                    bad += 1;
                    if faults.len() < SHOWN {
                        faults.push(bad_row.fault);
                    }
                }
            }
        }
        if let Some(last) = faults.last_mut().filter(|_| bad > SHOWN) {
            last.message = say!("{}; {} more rows like this", last.message, bad - SHOWN);
        }
        if good + bad == 0 && faults.is_empty() {
            let place = self.name_place(0);
            faults.push(
                Fault::new(NO_ROWS, place, say!("the table has no rows"))
                    .label(say!("nothing follows this line")),
            );
        }
        if faults.is_empty() {
            Ok(good)
        } else {
            Err(faults)
        }
    }

    /// The rows below the first line; a fault in place of one that has another length than the first line.
    pub fn rows(&self) -> impl Iterator<Item = Result<Row<'a>, Box<BadRow<'a>>>> + '_ {
        let mut broken = false;
        let rows = Rows::new(self.text, self.separator, self.line).skip(self.skipped);
        rows.map_while(move |row| match row {
            _ if broken => None,
            Ok(row) if row.len() == self.header.len() => Some(Ok(row)),
            // Loggers end every line with a separator: what follows it is no column.
            Ok(row) if row.len() == self.header.len() + 1 && row.ends_in_nothing() => {
                Some(Ok(row.without_last()))
            }
            Ok(row) => Some(Err(Box::new(BadRow {
                fault: self.wrong_length(&row),
                row: Some(row),
            }))),
            Err(message) => {
                broken = true;
                let end = self.text.len();
                let fault = Fault::new(ROW_LENGTH, end..end, message);
                Some(Err(Box::new(BadRow { fault, row: None })))
            }
        })
    }

    fn wrong_length(&self, row: &Row<'_>) -> Fault {
        let (found, expected) = (row.len(), self.header.len());
        let plural = if found == 1 { "" } else { "s" };
        let message = say!(
            "line {} has {found} field{plural}, the first line {expected}",
            row.line
        );
        let place = self.place(row, 0).start..self.place(row, found.saturating_sub(1)).end;
        let fault = Fault::new(ROW_LENGTH, place, message).label(say!("expected {expected}"));
        let comma = self.separator == b',' && found > expected;
        fault.help(match comma {
            true => say!(
                "numbers have a decimal point; a text that holds a comma stands in double quotes"
            ),
            false => say!("complete the row, or delete it"),
        })
    }
}

/// From where to where each field of the row goes that begins here.
fn extents(text: &str, separator: u8, start: usize) -> impl Iterator<Item = Range<usize>> + '_ {
    let bytes = text.as_bytes();
    let mut next = Some(start);
    std::iter::from_fn(move || {
        let from = next?;
        let rest = bytes.get(from..).unwrap_or_default();
        // As the reader has it: inside a field a quotation mark is a character as others are.
        let is_quoted = rest.first() == Some(&b'"');
        let mut is_open = false;
        let length = rest.iter().position(|byte| {
            is_open ^= is_quoted && *byte == b'"';
            !is_open && (*byte == separator || *byte == b'\n' || *byte == b'\r')
        });
        let end = from + length.unwrap_or(rest.len());
        next = (bytes.get(end) == Some(&separator)).then_some(end + 1);
        Some(from..end)
    })
}

/// A place without the white space around what stands there.
fn trimmed_place(text: &str, whole: Range<usize>) -> Range<usize> {
    let field = &text[whole.clone()];
    let start = whole.start + field.len() - field.trim_start().len();
    start..(whole.start + field.trim_end().len()).max(start)
}

impl Row<'_> {
    /// Of fields that are at hand.
    pub(super) fn of(fields: &[Cow<'_, str>], line: usize) -> Row<'static> {
        Row {
            fields: Fields::Quoted(fields.iter().collect()),
            len: fields.len(),
            start: 0,
            line,
        }
    }

    /// Number of fields.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether it has no field.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    fn ends_in_nothing(&self) -> bool {
        self.fields().last().is_none_or(str::is_empty)
    }

    /// Without its last field.
    fn without_last(self) -> Self {
        let len = self.len - 1;
        let fields = match self.fields {
            Fields::Line(line, separator) => {
                let end = line.rfind(char::from(separator)).unwrap_or(line.len());
                Fields::Line(&line[..end], separator)
            }
            Fields::Quoted(mut fields) => {
                fields.truncate(len);
                Fields::Quoted(fields)
            }
        };
        Row {
            fields,
            len,
            ..self
        }
    }

    /// A field without white space around it; empty for a field that the row lacks.
    pub fn field(&self, column: usize) -> &str {
        self.fields().nth(column).unwrap_or_default()
    }

    /// All fields.
    pub fn fields(&self) -> RowFields<'_> {
        match &self.fields {
            Fields::Line(line, separator) => RowFields::Line(Some(line), *separator),
            Fields::Quoted(fields) => RowFields::Quoted(fields, 0),
        }
    }
}

/// Goes through the fields of a row.
#[derive(Debug)]
pub enum RowFields<'r> {
    /// What is left of a line, unless it has ended, and what separates the fields in it.
    Line(Option<&'r str>, u8),
    /// Fields that are at hand, and the number of the next one.
    Quoted(&'r StringRecord, usize),
}

impl<'r> RowFields<'r> {
    /// What the next field holds, if `read` finds it at the beginning of a text and, with the number of bytes that it
    /// tells, the field ends. Otherwise the field stays the next one. So a line is gone through once for its fields and for
    /// what they hold.
    #[inline]
    pub fn read<T>(&mut self, read: impl Fn(&str) -> Option<(T, usize)>) -> Option<T> {
        let RowFields::Line(line, separator) = self else {
            return None;
        };
        let rest = (*line)?;
        let (found, end) = read(rest)?;
        *line = match rest.as_bytes().get(end) {
            None => None,
            Some(byte) if byte == separator => Some(&rest[end + 1..]),
            Some(_) => return None,
        };
        Some(found)
    }
}

impl<'r> Iterator for RowFields<'r> {
    type Item = &'r str;

    #[inline]
    fn next(&mut self) -> Option<&'r str> {
        match self {
            RowFields::Line(line, separator) => {
                let rest = (*line)?;
                // Fields are too short for a search by words to pay.
                let end = rest.bytes().position(|byte| byte == *separator);
                *line = end.map(|end| &rest[end + 1..]);
                Some(trimmed(&rest[..end.unwrap_or(rest.len())]))
            }
            RowFields::Quoted(fields, next) => {
                *next += 1;
                fields.get(*next - 1)
            }
        }
    }
}

/// Without white space around it, which most fields do not have.
#[inline]
fn trimmed(field: &str) -> &str {
    let bare = |byte: Option<&u8>| byte.is_none_or(|byte| (b'!'..=b'~').contains(byte));
    match bare(field.as_bytes().first()) && bare(field.as_bytes().last()) {
        true => field,
        false => field.trim(),
    }
}

/// The rows of a text, that of the names first.
struct Rows<'a> {
    text: &'a str,
    separator: u8,
    /// Where the next row is looked for.
    from: usize,
    /// How far lines were counted: byte and line.
    counted: (usize, usize),
    /// Reads rows with quotes.
    reader: Option<Reader<Cursor<&'a [u8]>>>,
}

impl<'a> Rows<'a> {
    fn new(text: &'a str, separator: u8, line: usize) -> Rows<'a> {
        Rows {
            text,
            separator,
            from: 0,
            counted: (0, line),
            reader: None,
        }
    }

    /// The fields of the row that begins here, in which there are quotes, and where it ends.
    fn quoted(&mut self, start: usize) -> Result<(StringRecord, usize), ::csv::Error> {
        let (text, separator) = (self.text, self.separator);
        let reader = self.reader.get_or_insert_with(|| {
            ReaderBuilder::new()
                .has_headers(false)
                .flexible(true)
                .comment(Some(b'#'))
                .delimiter(separator)
                .trim(Trim::All)
                .from_reader(Cursor::new(text.as_bytes()))
        });
        // Nothing happens where it stands there already.
        let mut position = Position::new();
        position.set_byte(start as u64);
        reader.seek(position)?;
        let mut fields = StringRecord::new();
        reader.read_record(&mut fields)?;
        Ok((fields, reader.position().byte() as usize))
    }
}

impl<'a> Iterator for Rows<'a> {
    type Item = Result<Row<'a>, String>;

    fn next(&mut self) -> Option<Self::Item> {
        let start = start_of_record(self.text, self.from);
        let bytes = self.text.as_bytes();
        let passed = memchr_iter(b'\n', &bytes[self.counted.0..start]).count();
        self.counted = (start, self.counted.1 + passed);
        let rest = &bytes[start..];
        let stop = memchr3(b'\n', b'\r', b'"', rest).unwrap_or(rest.len());
        if rest.is_empty() {
            return None;
        }
        let (fields, len) = if rest.get(stop) == Some(&b'"') {
            match self.quoted(start) {
                Ok((fields, end)) => {
                    self.from = end;
                    let len = fields.len();
                    (Fields::Quoted(fields), len)
                }
                Err(error) => return Some(Err(error.to_string())),
            }
        } else {
            self.from = start + stop;
            // There is no end of a line within it.
            self.counted.0 = self.from;
            let line = &self.text[start..self.from];
            let separators = memchr_iter(self.separator, line.as_bytes()).count();
            (Fields::Line(line, self.separator), separators + 1)
        };
        Some(Ok(Row {
            fields,
            len,
            start,
            line: self.counted.1,
        }))
    }
}

/// The separator of the columns of a text.
pub(super) fn separator_of(text: &str) -> u8 {
    let first = start_of_record(text, 0);
    separator(
        text,
        first,
        text[first..].lines().next().unwrap_or_default(),
    )
}

/// The separator of a text whose line of names begins at `first`.
fn separator(text: &str, first: usize, names: &str) -> u8 {
    let second = start_of_record(text, first + names.len());
    let row = text[second..].lines().next().unwrap_or_default();
    let count = |line: &str, separator: u8| line.bytes().filter(|byte| *byte == separator).count();
    let evidence = |separator: u8| {
        let in_names = count(names, separator);
        (in_names > 0 && count(row, separator) == in_names, in_names)
    };
    // The last of equal ones wins.
    [b'\t', b';', b',']
        .into_iter()
        .max_by_key(|separator| evidence(*separator))
        .unwrap_or(b',')
}

/// Where the next line begins that is neither empty nor a comment, nor the `sep=;` of a spreadsheet.
fn start_of_record(text: &str, from: usize) -> usize {
    let mut at = from.min(text.len());
    if at == 0 && text.starts_with('\u{feff}') {
        at = '\u{feff}'.len_utf8();
    }
    let bytes = text.as_bytes();
    let sep = |line: &[u8]| line.len() == 5 && line[..4].eq_ignore_ascii_case(b"sep=");
    if from == 0 && bytes.get(at..at + 5).is_some_and(sep) {
        at += 5;
    }
    loop {
        match bytes.get(at) {
            Some(b'\n' | b'\r') => at += 1,
            Some(b'#') => {
                let rest = &bytes[at..];
                at += rest
                    .iter()
                    .position(|byte| *byte == b'\n')
                    .unwrap_or(rest.len());
            }
            _ => return at,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Vec<(usize, Vec<String>)> {
        let sheet = Sheet::new(text).expect("a header");
        let mut rows = Vec::new();
        let count = sheet.visit(|row| {
            rows.push((row.line, row.fields().map(str::to_owned).collect()));
        });
        assert_eq!(count, Ok(rows.len()));
        rows
    }

    #[test]
    fn comments_and_empty_lines_do_not_count() {
        let text = "\u{feff}# logger 7\n\na,b\r\n1, 2\r\n\r\n# break\r\n3,4";
        let strings = |texts: [&str; 2]| texts.map(str::to_owned).to_vec();
        assert_eq!(
            rows(text),
            [(4, strings(["1", "2"])), (7, strings(["3", "4"]))]
        );
    }

    #[test]
    fn other_separators() {
        assert_eq!(rows("a;b,c\n1;2")[0].1, ["1", "2"]);
        assert_eq!(rows("a\tb\n1\t\n")[0].1, ["1", ""]);
        assert_eq!(rows("a\n1\n").len(), 1);
    }

    #[test]
    fn a_mark_inside_a_field_opens_nothing() {
        let text = "a,b,c\n1,5\" pipe,abc\n\"x, y\",\"5\"\"\",d\n";
        let sheet = Sheet::new(text).expect("a header");
        let mut last = Vec::new();
        let count = sheet.visit(|row| last.push(&text[sheet.place(row, 2)]));
        assert_eq!((count, last), (Ok(2), vec!["abc", "d"]));
    }

    /// Lines without quotes are split here, rows with quotes by the crate `csv`: both as that crate does it alone.
    #[test]
    fn rows_are_those_of_the_reader_of_csv() {
        let fields = [
            "1",
            " 2.5 ",
            "\"a, b\"",
            "\"two\nlines\"",
            "5\" pipe",
            "\u{3000}x",
            "",
            "\"\"\"q\"\"\"",
            "#",
        ];
        let ends = ["\n", "\r\n", "\n\n", "\n# \"comment\n", "\r"];
        let mut text = String::from("a,b,c\n");
        for row in 0..400 {
            let field = |k: usize| fields[(row * (k + 1) + row / 7 + k) % fields.len()];
            // A row that begins with # is none.
            let first = if field(0).starts_with('#') {
                "1"
            } else {
                field(0)
            };
            text += &[first, field(1), field(2)].join(",");
            text += ends[row % ends.len()];
        }
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .trim(Trim::All)
            .from_reader(text.as_bytes());
        let expected: Vec<StringRecord> = reader.records().map(Result::unwrap).collect();
        let found: Vec<StringRecord> = Rows::new(&text, b',', 1)
            .map(|row| row.expect("a row").fields().collect())
            .collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn places_of_fields() {
        let text = "a,b,c\n1,\"x, \"\"y\"\"\nz\", 3 \n4,5,6";
        let sheet = Sheet::new(text).expect("a header");
        let mut places = Vec::new();
        sheet
            .visit(|row| places.extend((0..3).map(|column| &text[sheet.place(row, column)])))
            .expect("rows");
        assert_eq!(places, ["1", "\"x, \"\"y\"\"\nz\"", "3", "4", "5", "6"]);
    }

    #[test]
    fn rows_of_another_length() {
        let text = "a,b\n1,2\n1,5,2\n3";
        let sheet = Sheet::new(text).expect("a header");
        let faults = sheet.visit(|_| ()).expect_err("bad rows");
        let seen: Vec<&str> = faults
            .iter()
            .map(|fault| &text[fault.span.clone()])
            .collect();
        assert_eq!(seen, ["1,5,2", "3"]);
        assert_eq!(faults[0].message, "line 3 has 3 fields, the first line 2");
        let many = format!("a,b\n{}", "1\n".repeat(8));
        let faults = Sheet::new(&many)
            .expect("a header")
            .visit(|_| ())
            .expect_err("bad rows");
        assert!(
            faults.len() == 5
                && faults[4]
                    .message
                    .to_string()
                    .ends_with("; 3 more rows like this")
        );
    }

    #[test]
    fn a_separator_at_the_end_of_rows_makes_no_column() {
        let text = "a,b\n1,2,\n\"3\",4, \n5,6\n7,8,9\n";
        let sheet = Sheet::new(text).expect("a header");
        let rows: Vec<Vec<String>> = sheet
            .rows()
            .flatten()
            .map(|row| row.fields().map(str::to_owned).collect())
            .collect();
        assert_eq!(rows, [["1", "2"], ["3", "4"], ["5", "6"]]);
        let faults = sheet.visit(|_| ()).expect_err("a bad row");
        assert_eq!(faults.len(), 1);
    }

    #[test]
    fn what_is_read_from_the_front_is_a_whole_field() {
        let sheet = Sheet::new("a,b,c,d\n12,12 ,x,34\n").expect("a header");
        let row = sheet.rows().next().expect("a row").expect("four fields");
        let whole = |text: &str| {
            let end = text.bytes().take_while(u8::is_ascii_digit).count();
            (end > 0).then(|| (text[..end].to_owned(), end))
        };
        let mut fields = row.fields();
        assert_eq!(fields.read(whole).as_deref(), Some("12"));
        assert_eq!((fields.read(whole), fields.next()), (None, Some("12")));
        assert_eq!((fields.read(whole), fields.next()), (None, Some("x")));
        assert_eq!(fields.read(whole).as_deref(), Some("34"));
        assert_eq!((fields.read(whole), fields.next()), (None, None));
    }

    #[test]
    fn nothing_to_read() {
        assert_eq!(Sheet::new("# only\n\n").expect_err("empty").code, NO_HEADER);
        assert_eq!(Sheet::new("1,2\n3,4").expect_err("numbers").code, NO_HEADER);
        let sheet = Sheet::new("a,b\n").expect("a header");
        assert_eq!(sheet.visit(|_| ()).expect_err("no rows")[0].code, NO_ROWS);
    }
}
