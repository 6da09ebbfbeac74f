//! Keys of an experiment that may be set to values of more than one type.

use gumption_fault::{Said, say};
use gumption_format::toml::faults::WRONG_TYPE;
use gumption_format::toml::{
    Cell, FromToml, KeyRow, Named, OneOrMany, Raw, Reader, Stated, Table, words,
};
use serde_json::{Value, json};
use toml::de::DeValue;

/// A table of which one key may stand alone.
pub trait Shorthand: Table + FromToml {
    /// What that key is set to.
    type Word: FromToml;

    /// What is expected, in words with the article.
    fn either() -> Said;

    /// The table that states this key only.
    fn of(word: Stated<Self::Word>) -> Self;

    /// What to write where a text is no such word.
    fn otherwise(_text: &str) -> Option<Said> {
        None
    }
}

/// A table, or its most important key alone.
#[derive(Debug, Clone, Default)]
pub struct Short<T>(pub T);

impl<T: Shorthand> FromToml for Short<T> {
    fn expected() -> Said {
        T::either()
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        if matches!(value.get_ref(), DeValue::Table(_)) {
            return T::read(value, reader).map(Short);
        }
        let before = reader.faults.len();
        let Some(word) = T::Word::read(value, reader) else {
            let fault = reader.faults.get_mut(before);
            if let (Some(fault), DeValue::String(text)) = (fault, value.get_ref())
                && fault.help.is_none()
            {
                fault.help = T::otherwise(text);
            }
            return None;
        };
        Some(Short(T::of(Stated {
            value: word,
            span: value.span(),
            key: value.span(),
        })))
    }

    fn schema() -> Value {
        json!({ "oneOf": [T::Word::schema(), T::schema()] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        T::tables(path, rows);
    }
}

/// How consecutive rows are averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AverageEntry {
    /// Long recordings in time are averaged in blocks.
    Auto,
    /// Every row counts by itself.
    Nothing,
    /// In blocks, at most so many.
    AtMost(u64),
}

impl FromToml for AverageEntry {
    fn expected() -> Said {
        say!("\"auto\", \"none\" or the largest number of means to keep")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(text) if text == "auto" => Some(AverageEntry::Auto),
            DeValue::String(text) if text == "none" => Some(AverageEntry::Nothing),
            DeValue::Integer(_) => u64::read(value, reader).map(AverageEntry::AtMost),
            _ => reader.wrong_type(WRONG_TYPE, value, Self::expected()),
        }
    }

    fn schema() -> Value {
        json!({ "type": ["string", "integer"] })
    }
}

words! {
    /// What a column is.
    RoleWord {
        /// What the instrument showed; the left side of a model.
        Output "output",
        /// What was applied to the instrument; on the right of a model.
        Stimulus "stimulus" | "input",
        /// A condition that was recorded and that the model may or may not use.
        Covariate "covariate" | "condition",
        /// A term that was found, row by row: the model takes it in as it stands, and nothing else depends on it.
        Term "term",
        /// An angle of a head, table or phase, whose harmonics may matter.
        Angle "angle",
        /// When a row was recorded.
        Time "time",
        /// Which row came first, where there is no time.
        Order "order",
        /// Runs, series, days, mounts: what was repeated as a whole.
        Run "run" | "series" | "mount" | "day",
        /// Instruments, operators, specimens, units: what has no order.
        Factor "factor" | "operator" | "instrument" | "specimen" | "unit" | "label",
        /// Positions, poses, points.
        Position "position" | "pose",
        /// Axes of a sensor.
        Axis "axis",
        /// The direction from which a point was reached.
        Direction "direction",
        /// Standard uncertainty of the output in this row.
        Uncertainty "u",
        /// Number of readings of which the output of this row is the mean.
        Count "count",
        /// Not used.
        Ignore "ignore",
    }
}

/// The rows of a further measurement.
#[derive(Debug, Clone)]
pub enum RowsEntry {
    /// The path of a CSV file.
    File(String),
    /// Values of columns, a list or one for all rows.
    Lists(Named<OneOrMany<Cell>>),
}

impl FromToml for RowsEntry {
    fn expected() -> Said {
        say!("the path of a CSV file, or a table of columns")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        if matches!(value.get_ref(), DeValue::Table(_)) {
            return Named::read(value, reader).map(RowsEntry::Lists);
        }
        String::read(value, reader).map(RowsEntry::File)
    }

    fn schema() -> Value {
        json!({ "oneOf": [String::schema(), Named::<OneOrMany<Cell>>::schema()] })
    }
}
