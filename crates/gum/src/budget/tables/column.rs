//! Columns of CSV files.

use gumption_format::toml::{OneOrMany, table};

table! {
    /// A column of a CSV file whose rows belong to groups.
    GroupColumnTable "a CSV column in groups" {
        /// Path of the file.
        file: String,
        /// Name of the column with the readings.
        column: String,
        /// Name of the column that tells the group; two names for groups and subgroups.
        group: OneOrMany<String>,
    }
}

table! {
    /// A column of a CSV file; the file is looked up from the folder of the budget.
    ColumnTable "a CSV column" {
        /// Path of the file.
        file: String,
        /// Name of the column in its first line.
        column: String,
    }
}
