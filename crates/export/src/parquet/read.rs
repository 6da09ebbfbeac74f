//! From a file to columns.

use std::borrow::Cow;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use ::parquet::basic::{ConvertedType, LogicalType, Repetition, TimeUnit, Type as Physical};
use ::parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use ::parquet::data_type::DoubleType;
use ::parquet::errors::ParquetError;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::record::reader::RowIter;
use ::parquet::record::{Field, Row};
use ::parquet::schema::types::{Type, TypePtr};
use gumption_core::calendar::{Day, SECONDS_OF_A_DAY};
use gumption_fault::{Fault, say};
use gumption_format::contained::contained;
use gumption_format::csv::faults::UNREADABLE;
use gumption_format::csv::{Cells, Columns};
use gumption_format::files::Files;

/// The rows of a file, some at a time.
pub struct Rows {
    columns: Vec<Column>,
    /// Reads the columns of doubles, row group by row group.
    file: SerializedFileReader<File>,
    /// Reads the others, through all row groups.
    others: Option<RowIter<'static>>,
    /// The row group that is being read, and its rows that are not read yet.
    group: usize,
    left: usize,
    doubles: Vec<ColumnReaderImpl<DoubleType>>,
    /// Rows that are read at a time.
    stretch: usize,
    /// Whether something was read: a table without rows has heads.
    begun: bool,
}

/// A column of the table.
struct Column {
    name: String,
    /// Its place among the leaves of the file, where it holds doubles.
    double: Option<usize>,
    /// Whether it holds times with nanoseconds, of which the library makes whole numbers.
    nanoseconds: bool,
}

type Result<T> = std::result::Result<T, Box<Fault>>;

impl Rows {
    /// Opens a file, of which so many rows will be read at a time.
    ///
    /// # Errors
    /// It is no such file, or has columns that are no columns of a table.
    pub fn open(path: &Path, stretch: usize) -> Result<Rows> {
        guarded(|| Rows::opened(path, stretch))
    }

    fn opened(path: &Path, stretch: usize) -> Result<Rows> {
        let reader = || {
            let file = Files::Disk.handle(path).map_err(ParquetError::from);
            file.and_then(SerializedFileReader::new).map_err(unreadable)
        };
        let file = reader()?;
        let metadata = file.metadata().file_metadata();
        let schema = metadata.schema_descr();
        let fields = schema.root_schema().get_fields();
        let mut leaf = 0;
        let columns = fields.iter().map(|field| {
            let at = leaf;
            leaf += leaves(field);
            Column::of(field, at)
        });
        let columns = columns.collect::<Result<Vec<Column>>>()?;
        let others = fields.iter().zip(&columns);
        let others: Vec<TypePtr> = others
            .filter(|(_, column)| column.double.is_none())
            .map(|(field, _)| Arc::clone(field))
            .collect();
        let others = match others.is_empty() {
            true => None,
            false => {
                let name = schema.root_schema().name();
                let part = Type::group_type_builder(name).with_fields(others).build();
                let rows = RowIter::from_file_into(Box::new(reader()?));
                let rows = part.and_then(|part| rows.project(Some(part)));
                Some(rows.map_err(unreadable)?)
            }
        };
        Ok(Rows {
            columns,
            file,
            others,
            group: 0,
            left: 0,
            doubles: Vec::new(),
            stretch,
            begun: false,
        })
    }

    /// How many rows there are.
    pub fn rows(&self) -> u64 {
        let rows = self.file.metadata().file_metadata().num_rows();
        u64::try_from(rows).unwrap_or(0)
    }

    /// The next rows, of one row group; nothing behind the last.
    fn some(&mut self) -> Result<Option<Columns<'static>>> {
        while self.left == 0 {
            if self.group == self.file.num_row_groups() {
                return match self.begun {
                    true => Ok(None),
                    false => self.read(0).map(Some),
                };
            }
            self.begin_group().map_err(unreadable)?;
        }
        let rows = self.left.min(self.stretch);
        self.left -= rows;
        self.read(rows).map(Some)
    }

    fn begin_group(&mut self) -> std::result::Result<(), ParquetError> {
        let group = self.file.get_row_group(self.group)?;
        self.group += 1;
        self.left = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        let doubles = self.columns.iter().filter_map(|column| column.double);
        let doubles = doubles.map(|leaf| match group.get_column_reader(leaf)? {
            ColumnReader::DoubleColumnReader(reader) => Ok(reader),
            _ => Err(ParquetError::General(format!(
                "column {leaf} holds no doubles"
            ))),
        });
        self.doubles = doubles.collect::<std::result::Result<_, ParquetError>>()?;
        Ok(())
    }

    fn read(&mut self, rows: usize) -> Result<Columns<'static>> {
        self.begun = true;
        let mut texts: Vec<Vec<String>> = Vec::new();
        texts.resize_with(self.columns.len() - self.doubles_count(), || {
            Vec::with_capacity(rows)
        });
        if let Some(others) = &mut self.others {
            let heads: Vec<&Column> = self
                .columns
                .iter()
                .filter(|one| one.double.is_none())
                .collect();
            for _ in 0..rows {
                let row = others
                    .next()
                    .unwrap_or_else(|| Err(ParquetError::EOF("rows are missing".into())));
                push(&row.map_err(unreadable)?, &heads, &mut texts)?;
            }
        }
        let mut doubles = self.doubles.iter_mut();
        let mut texts = texts.into_iter();
        let mut cells = |column: &Column| -> Result<Cells<'static>> {
            Ok(match column.double {
                // Without a row group there are no readers.
                Some(_) => {
                    let column = doubles.next().map(|reader| numbers(reader, rows));
                    Cells::Numbers(Cow::Owned(column.transpose()?.unwrap_or_default()))
                }
                None => Cells::Texts(texts.next().unwrap_or_default()),
            })
        };
        let columns = self.columns.iter();
        let columns = columns.map(|column| Ok((column.name.clone(), cells(column)?)));
        let columns = columns.collect::<Result<Vec<_>>>()?;
        let short = || unreadable(ParquetError::EOF("columns have different lengths".into()));
        Columns::new(columns).ok_or_else(short)
    }

    fn doubles_count(&self) -> usize {
        self.columns
            .iter()
            .filter(|one| one.double.is_some())
            .count()
    }
}

impl Iterator for Rows {
    type Item = Result<Columns<'static>>;

    fn next(&mut self) -> Option<Self::Item> {
        let some = guarded(|| self.some());
        if some.is_err() {
            // After a fault nothing can be found any more.
            (self.group, self.left, self.begun) = (self.file.num_row_groups(), 0, true);
        }
        some.transpose()
    }
}

impl Column {
    /// Of a field of the file, whose first leaf has this place.
    fn of(field: &TypePtr, leaf: usize) -> Result<Column> {
        let name = field.name().to_owned();
        let info = field.get_basic_info();
        let once = !info.has_repetition() || info.repetition() != Repetition::REPEATED;
        let logical = info.logical_type_ref();
        let is_double =
            field.is_primitive() && once && field.get_physical_type() == Physical::DOUBLE;
        // DuckDB writes the older of the two ways to say so.
        let is_list = matches!(logical, Some(LogicalType::List))
            || info.converted_type() == ConvertedType::LIST;
        if field.is_group() && !is_list {
            let message = say!("the column \"{name}\" is a structure");
            let fault = Fault::new(UNREADABLE, 0..0, message);
            return Err(Box::new(fault.help(say!(
                "columns hold numbers, texts, dates or lists of numbers: give its parts columns of their own"
            ))));
        }
        Ok(Column {
            name,
            double: is_double.then_some(leaf),
            nanoseconds: matches!(logical, Some(LogicalType::Timestamp(time)) if time.unit == TimeUnit::NANOS),
        })
    }

    /// A field as a file of texts has it.
    fn text(&self, field: &Field) -> Result<String> {
        const NANOSECONDS: i64 = 1_000_000_000;
        Ok(match field {
            Field::Null => String::new(),
            Field::Long(count) if self.nanoseconds => instant(*count, NANOSECONDS),
            Field::TimestampMicros(count) => instant(*count, NANOSECONDS / 1000),
            Field::TimestampMillis(count) => instant(*count, NANOSECONDS / 1_000_000),
            Field::Date(days) => date(i64::from(*days)),
            Field::Str(text) => text.clone(),
            Field::Bytes(bytes) => {
                let text = bytes.as_utf8();
                text.map_err(unreadable)?.to_owned()
            }
            Field::Float16(x) => number(x.to_f64()),
            Field::Float(x) => number(f64::from(*x)),
            Field::Double(x) => number(*x),
            Field::ListInternal(list) => {
                let elements = list.elements().iter();
                let texts = elements.map(|one| self.text(one));
                let texts = texts.collect::<Result<Vec<String>>>()?;
                format!("[{}]", texts.join(", "))
            }
            other => other.to_string(),
        })
    }
}

fn push(row: &Row, heads: &[&Column], texts: &mut [Vec<String>]) -> Result<()> {
    let fields = row.get_column_iter().map(|(_, field)| field);
    for ((field, head), texts) in fields.zip(heads).zip(texts) {
        texts.push(head.text(field)?);
    }
    Ok(())
}

/// A number with all of its digits; what is none is missing.
fn number(x: f64) -> String {
    match x.is_nan() {
        true => String::new(),
        false => format!("{x:?}"),
    }
}

/// A day, counted from the beginning of 1970; one that no four digits of a year have is a number.
fn date(days: i64) -> String {
    Day::at(days).map_or_else(|| days.to_string(), |day| day.to_string())
}

/// A time in so many parts of a second since the beginning of 1970, as ISO 8601 has it; a date where it is midnight.
fn instant(count: i64, parts: i64) -> String {
    let (seconds, rest) = (count.div_euclid(parts), count.rem_euclid(parts));
    let day = date(seconds.div_euclid(SECONDS_OF_A_DAY));
    let second = seconds.rem_euclid(SECONDS_OF_A_DAY);
    if (second, rest) == (0, 0) {
        return day;
    }
    let [hour, minute, second] = [second / 3600, second / 60 % 60, second % 60];
    let whole = format!("{day}T{hour:02}:{minute:02}:{second:02}");
    match rest {
        0 => whole,
        _ => {
            let digits = parts.ilog10() as usize;
            let fraction = format!("{rest:0digits$}");
            format!("{whole}.{}", fraction.trim_end_matches('0'))
        }
    }
}

/// So many numbers of a column; none where one is missing.
fn numbers(reader: &mut ColumnReaderImpl<DoubleType>, rows: usize) -> Result<Vec<f64>> {
    let (mut values, mut levels) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
    let mut read = 0;
    while read < rows {
        let some = reader.read_records(rows - read, Some(&mut levels), None, &mut values);
        match some.map_err(unreadable)? {
            (0, ..) => return Err(unreadable(ParquetError::EOF("values are missing".into()))),
            (some, ..) => read += some,
        }
    }
    if values.len() == rows {
        return Ok(values);
    }
    let mut there = values.into_iter();
    let number = |level: i16| {
        (level > 0)
            .then(|| there.next())
            .flatten()
            .unwrap_or(f64::NAN)
    };
    Ok(levels.into_iter().map(number).collect())
}

/// Columns of the file that a field has.
fn leaves(field: &Type) -> usize {
    match field {
        Type::PrimitiveType { .. } => 1,
        Type::GroupType { fields, .. } => fields.iter().map(|field| leaves(field)).sum(),
    }
}

/// What the library does at a damaged file is no end of the program.
fn guarded<T>(read: impl FnOnce() -> Result<T>) -> Result<T> {
    let gave_up = || unreadable(ParquetError::General("it is damaged".into()));
    contained(read).unwrap_or_else(|| Err(gave_up()))
}

fn unreadable(error: ParquetError) -> Box<Fault> {
    let message = say!("the table cannot be read as Parquet: {error}");
    Box::new(Fault::new(UNREADABLE, 0..0, message))
}
