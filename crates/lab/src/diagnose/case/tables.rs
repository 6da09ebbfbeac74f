//! Every table of a case file, as the user writes it.

use serde_json::{Value, json};
use toml::de::DeValue;

use crate::budget::tables::ConstantEntry;
use gumption_format::toml::faults::WRONG_TYPE;
use gumption_format::toml::{Amount, Cell, Named, OneOrMany};
use gumption_format::toml::{FromToml, KeyRow, Raw, Reader, Stated, table, words};

type List<T> = Vec<Stated<T>>;

table! {
    /// A declared model, a recording, and what is claimed about both.
    CaseTable "a case" {
        /// What was measured, as a heading.
        title: String,
        /// Where the recording comes from.
        reference: String,
        /// Anything the reader should know.
        note: String,
        /// The CSV file, alone or with how its rows are averaged.
        recording: RecordingEntry,
        /// What each column is: NAME = "role", or a table. NAME is the name in the first line of the file, without its unit.
        columns: Named<ColumnEntry>,
        /// The declared model: an output on the left, on the right columns, parameters and constants. A list for several outputs.
        model: OneOrMany<String>,
        /// What is known of the parameters before the recording: unit, start of the search, value with u.
        parameter: Named<ParameterTable>,
        /// Exactly known quantities.
        constant: Named<ConstantEntry>,
        /// Units of the file's own: `div = "0.5 mV"`.
        unit: Named<String>,
        /// What is claimed about the noise of one row; without it the noise is estimated from the recording.
        noise: NoiseTable,
        /// Explanations of the user's own, as formulas.
        candidate: OneOrMany<CandidateTable>,
        /// Further measurements that could be made, for the ranking of what would tell explanations apart.
        action: OneOrMany<ActionTable>,
        /// A recording of the same columns that the fit does not see and that it is to predict.
        held_out: HeldOutTable,
        /// How the diagnosis is run.
        diagnosis: DiagnosisTable,
    }
}

table! {
    /// The recording.
    RecordingTable "recording" {
        /// Path of the CSV file, from the folder of the case.
        file: String,
        /// How consecutive rows are averaged: "auto" (default), "none", or the largest number of means to keep.
        average: AverageEntry,
        /// Columns whose labels tell dwells: consecutive rows with the same labels are averaged.
        dwells: OneOrMany<String>,
        /// Rows at the beginning of each dwell that are left out, while the instrument settles; 0 if left out.
        settle_rows: u64,
    }
}

/// The path of a CSV file, or a table.
#[derive(Debug, Clone)]
pub struct RecordingEntry(pub RecordingTable);

impl FromToml for RecordingEntry {
    fn expected() -> String {
        "the path of a CSV file, or a table".into()
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        if matches!(value.get_ref(), DeValue::Table(_)) {
            return RecordingTable::read(value, reader).map(RecordingEntry);
        }
        let file = String::read(value, reader)?;
        Some(RecordingEntry(RecordingTable {
            file: Some(here(file, value)),
            ..RecordingTable::default()
        }))
    }

    fn schema() -> Value {
        json!({ "oneOf": [String::schema(), RecordingTable::schema()] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        RecordingTable::tables(path, rows);
    }
}

fn here<T>(inner: T, value: &Raw<'_>) -> Stated<T> {
    Stated {
        value: inner,
        span: value.span(),
        key: value.span(),
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
    fn expected() -> String {
        "\"auto\", \"none\" or the largest number of means to keep".into()
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        match value.get_ref() {
            DeValue::String(text) if text == "auto" => Some(AverageEntry::Auto),
            DeValue::String(text) if text == "none" => Some(AverageEntry::Nothing),
            DeValue::Integer(_) => u64::read(value, reader).map(AverageEntry::AtMost),
            _ => reader.wrong_type(WRONG_TYPE, value, &Self::expected()),
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
        /// An angle of a head, table or phase, whose harmonics may matter.
        Angle "angle",
        /// When a row was recorded.
        Time "time",
        /// Which row came first, where there is no time.
        Order "order",
        /// Runs, series, days, mounts: what was repeated as a whole.
        Run "run" | "series" | "mount",
        /// Instruments, operators, specimens: what has no order.
        Factor "factor" | "operator" | "instrument",
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

table! {
    /// A column of the recording.
    ColumnTable "[columns]" {
        /// What it is.
        role: RoleWord,
        /// Its name in the first line of the file, where models call it otherwise.
        column: String,
        /// Its unit, where the first line states none.
        unit: String,
        /// Standard uncertainty of each value, independent from row to row.
        u: Amount,
        /// Standard uncertainty of an error that all rows share.
        u_common: Amount,
        /// Of an output: the largest value that it can show, to which usual sizes of effects refer; the largest value of the model if left out.
        full_scale: Amount,
        /// Of an output: the step of its numbers (one unit of the last digit, one LSB).
        resolution: Amount,
        /// What it is, in words.
        description: String,
    }
}

/// A role, or a table.
#[derive(Debug, Clone)]
pub struct ColumnEntry(pub ColumnTable);

impl FromToml for ColumnEntry {
    fn expected() -> String {
        "a role such as \"output\", or a table".into()
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        if matches!(value.get_ref(), DeValue::Table(_)) {
            return ColumnTable::read(value, reader).map(ColumnEntry);
        }
        let role = RoleWord::read(value, reader)?;
        Some(ColumnEntry(ColumnTable {
            role: Some(here(role, value)),
            ..ColumnTable::default()
        }))
    }

    fn schema() -> Value {
        json!({ "oneOf": [RoleWord::schema(), ColumnTable::schema()] })
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        ColumnTable::tables(path, rows);
    }
}

table! {
    /// A parameter of the model.
    ParameterTable "[parameter]" {
        /// Its unit; where it is left out, the one that follows from the model if that is linear in it.
        unit: String,
        /// Where the search begins.
        start: Amount,
        /// What is known of it beforehand, with `u`.
        value: Amount,
        /// Standard uncertainty of `value`.
        u: Amount,
        /// A column of labels for each of which the parameter has a value of its own.
        per: String,
        /// What it is, in words.
        description: String,
    }
}

table! {
    /// What is claimed about the noise of the output.
    NoiseTable "[noise]" {
        /// Standard uncertainty of the output of one row (of one reading, with a column of counts).
        u: Amount,
        /// Degrees of freedom of `u`; infinite if left out.
        dof: f64,
        /// With `u`: random walk of the output per root of an hour, by the column `time`.
        walk: Amount,
        /// With `u`: the step of the output's numbers; its u is added.
        resolution: Amount,
        /// Columns that say which rows are replicates: rows that agree in all of them differ by noise only.
        replicates: OneOrMany<String>,
        /// A recording at rest, from which the noise is taken.
        at_rest: StaticTable,
        /// A budget whose combined standard uncertainty is the noise of one row.
        budget: String,
        /// "estimated": from what the model leaves, after the effects that are found.
        from: NoiseWord,
    }
}

words! {
    /// Where the noise is taken from when nothing is claimed.
    NoiseWord {
        /// From the residuals.
        Estimated "estimated",
    }
}

table! {
    /// A recording at rest.
    StaticTable "at_rest" {
        /// Path of the CSV file.
        file: String,
        /// Name of the column in it; that of the output if left out.
        column: String,
    }
}

table! {
    /// An explanation of the user's own.
    CandidateTable "[[candidate]]" {
        /// Its name.
        name: String,
        /// What it adds to the output, per unit of its size, as a formula of columns, parameters and constants.
        formula: String,
        /// With `formula`: the parameter, stimulus or output that it changes; the output if left out.
        node: String,
        /// A size that would not surprise.
        typical: f64,
        /// A sentence that explains it.
        description: String,
    }
}

table! {
    /// A recording that is to be predicted.
    HeldOutTable "held_out" {
        /// Path of the CSV file, with the same columns as the recording.
        file: String,
    }
}

table! {
    /// A further measurement that could be made.
    ActionTable "[[action]]" {
        /// Its name.
        name: String,
        /// Effort, in any unit; 1 if left out.
        cost: f64,
        /// The rows that would be recorded: a CSV file, or `{ COLUMN = [values], … }`. Outputs are left out.
        rows: RowsEntry,
        /// Instead of `rows`: the rows of the recording once more, with these columns at another value.
        again: Named<Cell>,
        /// With `again`: the order of the rows, "as recorded" (default) or "reversed".
        order: OrderWord,
    }
}

words! {
    /// In which order the rows of a recording are taken again.
    OrderWord {
        /// As they were recorded.
        Recorded "as recorded",
        /// The last one first.
        Reversed "reversed",
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
    fn expected() -> String {
        "the path of a CSV file, or a table of columns".into()
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

table! {
    /// How the diagnosis is run.
    DiagnosisTable "[diagnosis]" {
        /// Probability of a false alarm; 0.01 if left out.
        alpha: f64,
        /// Families or effects of the catalogue that are considered; all if left out.
        catalogue: List<String>,
        /// Families or effects that are not considered.
        exclude: List<String>,
        /// Seed of the random numbers; 1 if left out.
        seed: u64,
        /// Simulated recordings without any effect, for the false-alarm rate: 200 to 100000; 2000 if left out.
        draws: u64,
        /// By the identifier of an effect: the largest shift of the output that would not surprise, as a share of full scale.
        typical: Named<f64>,
    }
}
