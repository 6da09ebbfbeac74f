//! Every table of an experiment, as users and the procedures of the library write it.

use gumption_fault::{Said, say};
use gumption_format::toml::{Amount, Cell, Date, Dof, Named, OneOrMany, Stated, table, words};

use super::entries::{AverageEntry, RoleWord, RowsEntry, Short, Shorthand};
use gumption_gum::budget::tables::{
    ConstantEntry, ConventionsTable, CorrelationTable, InputTable, MonteCarloTable, SourceTable,
};

type List<T> = Vec<Stated<T>>;

table! {
    /// An experiment: equations, what is known of references and instruments, a recording or a schedule.
    ExperimentTable "an experiment" {
        /// What is calibrated or measured, as a heading.
        title: String,
        /// The heading in Chinese.
        title_zh: String,
        /// What the procedure is for and what it needs.
        description: String,
        /// The same in Chinese.
        description_zh: String,
        /// Where the recording comes from; clause of the standard, or publication.
        reference: String,
        /// The item that is calibrated.
        object: String,
        /// Who evaluated the experiment.
        author: String,
        /// Date of the experiment; certificates past due on it are remarked on.
        date: Date,
        /// Anything the reader should know.
        note: String,
        /// A procedure of the library, on which the rest of the file builds.
        procedure: String,
        /// Statements before the equations that all of them see: intermediate quantities, functions.
        model: String,
        /// One equation for each response, `"U = K*omega*(1 + e_rate) + b"`, or a list of them: on the left an output, a constant or an input.
        equations: OneOrMany<String>,
        /// Name of a profile, the conventions on which guides differ (`gumption explain profiles`); GUM when left out.
        profile: String,
        /// Changes to single conventions of the profile.
        conventions: ConventionsTable,
        /// How the Monte Carlo method of the written budgets is run.
        monte_carlo: MonteCarloTable,
        /// Units of the file's own: `count = "1"`, `div = "0.5 mV"`.
        unit: Named<String>,
        /// The recording: the path of a CSV file, or a table that says how its rows are averaged.
        recording: Short<RecordingTable>,
        /// Rows of the recording that are left out, and why.
        left_out: OneOrMany<LeftOutTable>,
        /// What each column of the recording is: NAME = "role", or a table. A column that the equations name and nothing declares is an output on their left, a stimulus on their right.
        columns: Named<Short<ColumnTable>>,
        /// What the labels of a column stand for.
        positions: PositionsTable,
        /// What is estimated. Without this table, every name of the equations that is no column, constant or input.
        parameter: Named<ParameterTable>,
        /// Parameters of which one that has another sign than the others is doubtful.
        same_sign: List<String>,
        /// Exactly known quantities.
        constant: Named<ConstantEntry>,
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
        /// Effects that the equations leave out: what each would shift, and whether the recording shows it.
        omitted: Named<OmittedTable>,
        /// What tells the noise of the readings.
        noise: NoiseTable,
        /// How the points are weighted.
        weights: WeightsWord,
        /// A column of labels: the rows of each label are evaluated by themselves and compared.
        separately: String,
        /// The points of an experiment that is planned, column by column.
        schedule: Named<List<Cell>>,
        /// A recording of the same columns that the fit does not see and that it is to predict.
        held_out: HeldOutTable,
        /// Further measurements that could be made, for the ranking of what would tell explanations apart.
        action: OneOrMany<ActionTable>,
        /// How a diagnosis is run.
        diagnosis: DiagnosisTable,
    }
}

table! {
    /// The recording.
    RecordingTable "[recording]" {
        /// Path of the CSV file, from the folder of this one.
        file: String,
        /// How rows are averaged that nothing else parts: "none" where each row counts by itself (an average already), the largest number of means to keep, or "auto" (default).
        average: AverageEntry,
        /// Columns of labels that tell the dwells apart: consecutive rows with the same labels are averaged.
        dwells: OneOrMany<String>,
        /// The column whose steps tell the dwells apart, or several: a step of any of them begins a new one.
        steps: OneOrMany<String>,
        /// Without labels and steps: dwells are stretches at rest, in which no column of the equations scatters more than it does at its quietest, over so many rows.
        still: u64,
        /// How far apart values of `steps` in one dwell may be, in its unit.
        tolerance: f64,
        /// The part at the beginning of each dwell that is left out, while the instrument settles: a time; rows where no column has the role "time".
        settle: Amount,
        /// The part after it that is used; all of it where left out.
        dwell: Amount,
        /// The fewest samples of a dwell.
        fewest: u64,
        /// Columns of labels: points with the same labels in all of them are averaged to one.
        together: List<String>,
    }
}

impl Shorthand for RecordingTable {
    type Word = String;

    fn either() -> Said {
        say!("the path of a CSV file, or a table")
    }

    fn of(file: Stated<String>) -> Self {
        RecordingTable {
            file: Some(Box::new(file)),
            ..RecordingTable::default()
        }
    }
}

table! {
    /// Rows of the recording that are left out; the report says which, and why.
    LeftOutTable "[[left_out]]" {
        /// Lines of the CSV file, the first line being 1, or ranges of them: [12, "20-25"].
        lines: List<Cell>,
        /// Why they tell nothing about what is measured.
        reason: String,
    }
}

table! {
    /// A column of the recording: a quantity that differs from row to row.
    ColumnTable "[columns]" {
        /// What it is; as the equations use it where left out.
        role: RoleWord,
        /// Its name in the first line of the file, where the equations call it otherwise.
        column: String,
        /// Its unit, where the first line states none; equations see the numbers in the unit of the first line.
        unit: String,
        /// A unit of the dimension that it must have; any dimension where left out.
        like: String,
        /// What it holds, where its role does not tell.
        holds: HoldsWord,
        /// Of a stimulus: standard uncertainty of each value, independent from row to row.
        u: Amount,
        /// Standard uncertainty of an error that all rows share.
        u_common: Amount,
        /// Of an output: the largest value that it can show, to which usual sizes of effects refer; the largest value of the equations if left out.
        full_scale: Amount,
        /// Of an output: the step of its numbers (one unit of the last digit, one LSB).
        resolution: Amount,
        /// Least and greatest value that its instrument can give, in its unit: `[-10, 10]`.
        range: List<f64>,
        /// What it is, in words.
        description: String,
        /// The same in Chinese.
        description_zh: String,
    }
}

impl Shorthand for ColumnTable {
    type Word = RoleWord;

    fn either() -> Said {
        say!("a role such as \"output\", or a table")
    }

    fn of(role: Stated<RoleWord>) -> Self {
        ColumnTable {
            role: Some(Box::new(role)),
            ..ColumnTable::default()
        }
    }

    fn otherwise(text: &str) -> Option<Said> {
        Some(say!(
            "this is what the column is; its name in the first line stands in a table: {{ column = \"{text}\" }}"
        ))
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
    /// What is estimated.
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
        /// What is known of it beforehand, with `u`.
        value: Amount,
        /// Standard uncertainty of `value`.
        u: Amount,
        /// A column of labels for each of which it has a value of its own.
        per: String,
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
        /// In place of `term`: what it adds per unit of its size, a formula of columns, parameters and constants; they count as numbers where their units do not fit together.
        formula: String,
        /// With `formula`: the parameter, stimulus or output that it changes; the output if left out.
        node: String,
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
    /// What tells the noise of the readings.
    NoiseTable "[noise]" {
        /// What tells it, where nothing below is stated: "residuals" (default), "dwells" or "stated".
        from: NoiseWord,
        /// Standard uncertainty of the output of one row (of one reading, with a column of counts); without a unit in that of the outputs.
        u: Amount,
        /// Degrees of freedom of `u`; infinite if left out.
        dof: Dof,
        /// With `u`: random walk of the output per root of an hour, by the column of time.
        walk: Amount,
        /// With `u`: the step of the output's numbers; its u is added.
        resolution: Amount,
        /// Columns that say which rows are replicates: rows that agree in all of them differ by noise only.
        replicates: OneOrMany<String>,
        /// A recording at rest, from which the noise is taken.
        at_rest: StaticTable,
        /// A budget whose combined standard uncertainty is the noise of one row.
        budget: String,
    }
}

words! {
    /// What tells the noise where no number does.
    NoiseWord {
        /// The residuals, after the effects that are found.
        Residuals "residuals" | "estimated",
        /// The samples of each dwell.
        Dwells "dwells",
        /// Nothing: the stated errors of the readings are all there is.
        Stated "stated",
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
    /// How the points are weighted.
    WeightsWord {
        /// All points of a response alike.
        Equal "equal",
        /// By the standard uncertainty of each reading.
        Readings "readings",
    }
}
