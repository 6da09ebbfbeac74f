//! Every table of a calibration file, as users and the procedures of the library write it.

use serde_json::{Value, json};

use super::procedure::PROCEDURES;
use crate::budget::tables::ConstantEntry;
use crate::budget::tables::{
    ConventionsTable, CorrelationTable, InputTable, MonteCarloTable, SourceTable,
};
use gumption_format::toml::{Amount, Cell, Date, Named, OneOrMany};
use gumption_format::toml::{FromToml, Stated, table, words};

type List<T> = Vec<Stated<T>>;

/// JSON Schema (draft-07) of calibration files, for editors.
pub fn schema() -> Value {
    let mut schema = CalibrationTable::schema();
    if let Value::Object(entries) = &mut schema {
        let draft = "http://json-schema.org/draft-07/schema#";
        entries.insert("$schema".into(), json!(draft));
        entries.insert("title".into(), json!("gumption calibration"));
        if let Some(Value::Object(properties)) = entries.get_mut("properties")
            && let Some(Value::Object(procedure)) = properties.get_mut("procedure")
        {
            let names = PROCEDURES.iter().map(|procedure| procedure.name);
            procedure.insert("enum".into(), names.collect());
        }
    }
    schema
}

table! {
    /// A calibration: equations, what is known of references, a recording or a schedule.
    CalibrationTable "a calibration" {
        /// What is calibrated, as a heading.
        title: String,
        /// The heading in Chinese.
        title_zh: String,
        /// What the procedure is for and what it needs.
        description: String,
        /// The same in Chinese.
        description_zh: String,
        /// Clause of the standard, or publication.
        reference: String,
        /// The item that is calibrated.
        object: String,
        /// Who evaluated the calibration.
        author: String,
        /// Date of the calibration; certificates past due on it are remarked on.
        date: Date,
        /// Anything the reader should know.
        note: String,
        /// A procedure of the library, on which the rest of the file builds.
        procedure: String,
        /// Statements before the equations that all of them see: intermediate quantities, functions.
        model: String,
        /// One equation for each response: `U = K*omega*(1 + e_rate) + b`.
        equations: List<String>,
        /// Name of a profile, the conventions on which guides differ (`gumption explain profiles`); GUM when left out.
        profile: String,
        /// Changes to single conventions of the profile.
        conventions: ConventionsTable,
        /// How the Monte Carlo method of the written budgets is run.
        monte_carlo: MonteCarloTable,
        /// Units of the file's own: `count = "1"`.
        unit: Named<String>,
        /// Exactly known quantities.
        constant: Named<ConstantEntry>,
        /// Quantities that differ from row to row: roles that columns of the recording play.
        column: Named<ColumnTable>,
        /// What the labels of a column stand for.
        positions: PositionsTable,
        /// What the calibration estimates.
        parameter: Named<ParameterTable>,
        /// Parameters of which one that has another sign than the others is doubtful.
        same_sign: List<String>,
        /// Errors of references (their value is zero) and quantities of the set-up, with their uncertainty.
        input: Named<KnownTable>,
        /// Further errors of the readings of a column, with the keys of a budget's components.
        reading: Named<KnownTable>,
        /// Causes of uncertainty that several inputs and readings share.
        source: Named<SharedTable>,
        /// Correlation coefficients of inputs, readings, sources or single components.
        correlation: OneOrMany<CorrelationTable>,
        /// Functions of the parameters that are reported besides them.
        result: Named<ResultTable>,
        /// Effects that the equations leave out, to learn what each would shift.
        omitted: Named<OmittedTable>,
        /// The recording.
        recording: RecordingTable,
        /// The points of an experiment that is planned, column by column.
        schedule: Named<List<Cell>>,
        /// What tells the scatter of the readings.
        scatter: ScatterWord,
        /// How the points are weighted.
        weights: WeightsWord,
        /// A column of labels: the rows of each label are evaluated by themselves and compared.
        separately: String,
    }
}

table! {
    /// A quantity that differs from row to row.
    ColumnTable "[column]" {
        /// What it is.
        description: String,
        /// The same in Chinese.
        description_zh: String,
        /// Its unit where the header states none; equations see the numbers in the unit of the header.
        unit: String,
        /// A unit of the dimension that it must have; any dimension where left out.
        like: String,
        /// What it holds.
        holds: HoldsWord,
    }
}

table! {
    /// What the labels of a column stand for.
    PositionsTable "[positions]" {
        /// The column of labels.
        column: String,
        /// The quantities that each label gives values to.
        gives: List<String>,
        /// Their units; all of dimension one where left out.
        units: List<String>,
        /// The values, by label: `"x up" = [1, 0, 0]`.
        at: Named<List<f64>>,
        /// Labels that may be missing; all others must occur in the recording.
        optional: List<String>,
    }
}

table! {
    /// What the calibration estimates.
    ParameterTable "[parameter]" {
        /// What it is.
        description: String,
        /// The same in Chinese.
        description_zh: String,
        /// Its unit; found from the equations where they determine it.
        unit: String,
        /// Its unit as a formula of columns and other quantities: `U/omega`.
        like: String,
        /// Where the search begins. Parameters without it must enter linearly once the others are held.
        start: Amount,
    }
}

table! {
    /// An error of a reference, or a quantity of the set-up.
    KnownTable "an input" {
        /// Its description in Chinese.
        description_zh: String,
        /// Its unit as a formula of columns and other quantities: `U`.
        like: String,
        /// Whether one error acts on all points, or each point has its own.
        scope: ScopeWord,
        /// A column of labels: points with the same label share one error.
        by: String,
        /// Whether the file must state it; for procedures.
        required: bool,
        with input: InputTable
    }
}

table! {
    /// A cause of uncertainty that several inputs and readings share; its value is zero.
    SharedTable "[source]" {
        /// Whether one error acts on all points, or each point has its own.
        scope: ScopeWord,
        /// A column of labels: points with the same label share one error.
        by: String,
        with source: SourceTable
    }
}

table! {
    /// A function of the parameters that is reported besides them.
    ResultTable "[result]" {
        /// The formula.
        model: String,
        /// What it is.
        description: String,
        /// The same in Chinese.
        description_zh: String,
        /// Its unit; dimension one when left out.
        unit: String,
        /// Its unit as a formula of columns and other quantities.
        like: String,
    }
}

table! {
    /// An effect that the equations leave out.
    OmittedTable "[omitted]" {
        /// The term that it would add to the equation, linear in its own name: `k2*omega^2`.
        term: String,
        /// The response whose equation it belongs to; may be left out where there is one.
        response: String,
        /// Unit of the coefficient; found from the term where it determines it.
        unit: String,
        /// Its unit as a formula of columns and other quantities.
        like: String,
        /// Its physics.
        description: String,
        /// The same in Chinese.
        description_zh: String,
        /// A usual size, positive.
        typical: Amount,
    }
}

table! {
    /// The recording.
    RecordingTable "[recording]" {
        /// Path of the CSV file, from the folder of this one.
        file: String,
        /// The columns that play the roles, where they have other names: `omega = "rate"`.
        columns: Named<String>,
        /// Whether each row is an average already; otherwise rows are samples, to be averaged in dwells.
        averages: bool,
        /// The column of time, for settling times and drift.
        time: String,
        /// Columns of labels that tell the dwells apart.
        dwells: List<String>,
        /// The column whose steps tell the dwells apart.
        steps: String,
        /// Without labels and steps: dwells are stretches at rest, in which no column of the equations scatters more than it does at its quietest, over so many rows.
        still: u64,
        /// How far apart values of `steps` in one dwell may be, in its unit.
        tolerance: f64,
        /// The part at the beginning of each dwell that is left out.
        settle: Amount,
        /// The part after it that is used; all of it where left out.
        dwell: Amount,
        /// The fewest samples of a dwell.
        fewest: u64,
        /// Columns of labels: points with the same labels in all of them are averaged to one.
        together: List<String>,
        /// Least and greatest value that the instrument of a column can give, in its unit: `U = [-10, 10]`.
        ranges: Named<List<f64>>,
    }
}

words! {
    /// What a column holds.
    HoldsWord {
        /// Numbers.
        Numbers "numbers",
        /// Texts, also if they look like numbers.
        Labels "labels",
    }
}

words! {
    /// On which points one error acts.
    ScopeWord {
        /// One error acts on all points.
        Common "common",
        /// Each point has an error of its own.
        Each "each",
    }
}

words! {
    /// What tells the scatter of the readings.
    ScatterWord {
        /// The residuals.
        Residuals "residuals",
        /// The samples of each dwell.
        Dwells "dwells",
        /// Nothing: the stated errors are all there is.
        Stated "stated",
    }
}

words! {
    /// How the points are weighted.
    WeightsWord {
        /// All points of a response alike.
        Equal "equal",
        /// By the standard uncertainty of each reading.
        Readings "readings",
    }
}
