//! From columns to a file.

use std::sync::Arc;

use ::parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use ::parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use ::parquet::errors::ParquetError;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use ::parquet::schema::types::{Type, TypePtr};
use gumption_fault::{Said, say};
use gumption_format::csv::Cells;

/// Writes a table, a row group for all rows that are added together.
#[derive(Default)]
pub struct Writer {
    /// As soon as rows have told what its columns are.
    file: Option<SerializedFileWriter<Vec<u8>>>,
}

/// The heads of columns and what they hold.
type Table<'t> = [(String, Cells<'t>)];

impl Writer {
    /// The bytes that these rows add. A number that is none and an empty text are nothing; whole numbers are those of the columns
    /// called `whole`.
    ///
    /// # Errors
    /// As the library says.
    pub fn add(&mut self, table: &Table<'_>, whole: &[&str]) -> Result<Vec<u8>, Said> {
        self.added(table, whole).map_err(unwritten)
    }

    fn added(&mut self, table: &Table<'_>, whole: &[&str]) -> Result<Vec<u8>, ParquetError> {
        let file = match &mut self.file {
            Some(file) => file,
            None => self.file.insert(begun(table, whole)?),
        };
        let rows = table.iter().map(|(_, cells)| cells.count()).max();
        if rows.unwrap_or(0) == 0 {
            file.flush()?;
            return Ok(std::mem::take(file.inner_mut()));
        }
        let mut group = file.next_row_group()?;
        for (_, cells) in table {
            let Some(mut column) = group.next_column()? else {
                break;
            };
            fill(&mut column, cells)?;
            column.close()?;
        }
        group.close()?;
        file.flush()?;
        Ok(std::mem::take(file.inner_mut()))
    }

    /// The bytes with which the file ends.
    ///
    /// # Errors
    /// As the library says.
    pub fn end(self) -> Result<Vec<u8>, Said> {
        let rest = self.file.map(SerializedFileWriter::into_inner).transpose();
        rest.map(Option::unwrap_or_default).map_err(unwritten)
    }
}

fn begun(table: &Table<'_>, whole: &[&str]) -> Result<SerializedFileWriter<Vec<u8>>, ParquetError> {
    let field = |(name, cells): &(String, Cells<'_>)| -> Result<TypePtr, ParquetError> {
        let (physical, logical) = match cells {
            Cells::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Cells::Numbers(_) if whole.contains(&name.as_str()) => (Physical::INT64, None),
            Cells::Numbers(_) => (Physical::DOUBLE, None),
        };
        let field = Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(logical);
        Ok(Arc::new(field.build()?))
    };
    let fields = table.iter().map(field).collect::<Result<_, _>>()?;
    let schema = Type::group_type_builder("schema")
        .with_fields(fields)
        .build()?;
    let properties = WriterProperties::builder()
        .set_created_by(format!("gumption {}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::SNAPPY);
    // Figures hardly ever repeat.
    let numbers = table
        .iter()
        .filter(|(_, cells)| matches!(cells, Cells::Numbers(_)));
    let properties = numbers.fold(properties, |properties, (name, _)| {
        properties.set_column_dictionary_enabled(vec![name.clone()].into(), false)
    });
    SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties.build()))
}

fn fill(column: &mut SerializedColumnWriter<'_>, cells: &Cells<'_>) -> Result<(), ParquetError> {
    use ::parquet::column::writer::ColumnWriter::{ByteArrayColumnWriter, Int64ColumnWriter};
    match (cells, column.untyped()) {
        (Cells::Texts(texts), ByteArrayColumnWriter(_)) => {
            let levels: Vec<i16> = texts
                .iter()
                .map(|text| i16::from(!text.is_empty()))
                .collect();
            let there = texts.iter().filter(|text| !text.is_empty());
            let there: Vec<ByteArray> = there.map(|text| ByteArray::from(text.as_str())).collect();
            column
                .typed::<ByteArrayType>()
                .write_batch(&there, Some(&levels), None)?;
        }
        (Cells::Numbers(numbers), other) => {
            let is_whole = matches!(other, Int64ColumnWriter(_));
            let levels: Vec<i16> = numbers.iter().map(|x| i16::from(!x.is_nan())).collect();
            let there = numbers.iter().copied().filter(|x| !x.is_nan());
            if is_whole {
                let there: Vec<i64> = there.map(|x| x as i64).collect();
                column
                    .typed::<Int64Type>()
                    .write_batch(&there, Some(&levels), None)?;
            } else {
                let there: Vec<f64> = there.collect();
                column
                    .typed::<DoubleType>()
                    .write_batch(&there, Some(&levels), None)?;
            }
        }
        (Cells::Texts(_), _) => {
            let why = "a column of numbers has become one of texts";
            return Err(ParquetError::General(why.into()));
        }
    }
    Ok(())
}

fn unwritten(error: ParquetError) -> Said {
    say!("the table cannot be written as Parquet: {error}")
}
