//! What writers of experiments mistake: keys of an uncertainty, and wordings of former versions.

use gumption_fault::{Said, say};
use gumption_format::toml::{DeValue, Hints, Table};

use super::tables::{ExperimentTable, NoiseWord};
use gumption_gum::budget::hints as budget;

/// The mistakes of writers of experiments.
pub static HINTS: Hints = Hints {
    whole: say!("an experiment"),
    synonyms: &budget::SYNONYMS,
    top: ExperimentTable::keys,
    unknown_key,
    no_table,
    wrong_type: budget::wrong_type,
    list_of_amounts: say!("quantities that differ from row to row are columns of the recording"),
};

/// Wordings of former versions, and of reports: the table, the key, and how it is written.
static OTHERWISE: [(&str, &str, Said); 12] = [
    (
        "an experiment",
        "scatter",
        say!(
            "the scatter of the readings is now their noise: noise = {{ from = \"dwells\" }}, or from = \"residuals\" or \"stated\""
        ),
    ),
    (
        "an experiment",
        "column",
        say!(
            "columns of the recording are now listed as [columns]: U = {{ role = \"output\", unit = \"V\" }}, or [columns.U]"
        ),
    ),
    (
        "an experiment",
        "candidate",
        say!(
            "explanations of your own are now omitted effects: [omitted.NAME] with term = \"NAME * …\", or with formula = \"…\" and node = \"…\""
        ),
    ),
    (
        "[recording]",
        "columns",
        say!(
            "the name in the first line of the recording now stands with the column: [columns] omega = {{ column = \"rate\" }}"
        ),
    ),
    (
        "[recording]",
        "time",
        say!("the time is now a column of this role: [columns] t = \"time\""),
    ),
    (
        "[recording]",
        "ranges",
        say!(
            "the range of an instrument now stands with its column: [columns] U = {{ range = [-10, 10] }}"
        ),
    ),
    (
        "[recording]",
        "averages",
        say!(
            "rows that are averages already are now told by average = \"none\"; samples need `dwells`, `steps` or `still`"
        ),
    ),
    (
        "[recording]",
        "settle_rows",
        say!("write settle = …: a time, or rows where no column has the role \"time\""),
    ),
    (
        "[[left_out]]",
        "rows",
        say!(
            "write lines = […], which count from the top of the file: with one line of names, row 3 of a report stands in line 4"
        ),
    ),
    (
        "[[left_out]]",
        "row",
        say!(
            "write lines = […], which count from the top of the file: with one line of names, row 3 of a report stands in line 4"
        ),
    ),
    (
        "[noise]",
        "scatter",
        say!("write from = \"residuals\", \"dwells\" or \"stated\""),
    ),
    (
        "[omitted]",
        "name",
        say!("the name of an omitted effect is that of its table: [omitted.NAME]"),
    ),
];

/// What to write where one value stands in the place of a table.
fn no_table(title: &str, found: &DeValue<'_>) -> Option<Said> {
    match (title, found) {
        ("[noise]", DeValue::String(text)) if NoiseWord::named(text).is_some() => {
            Some(say!("write noise = {{ from = \"{text}\" }}"))
        }
        ("[noise]", DeValue::String(text)) => Some(say!(
            "a standard uncertainty is noise = {{ u = \"{text}\" }}; what tells it is from = \"residuals\", \"dwells\" or \"stated\""
        )),
        ("[noise]", DeValue::Float(_) | DeValue::Integer(_)) => Some(say!(
            "the standard uncertainty of a reading is noise = {{ u = … }}, in the unit of the output"
        )),
        _ => budget::no_table(title, found),
    }
}

fn unknown_key(key: &str, table: &str, known: &[&'static str]) -> Option<Said> {
    let mut otherwise = OTHERWISE.iter();
    otherwise
        .find(|(place, word, _)| *place == table && *word == key)
        .map(|(_, _, now)| now.clone())
        .or_else(|| budget::unknown_key(key, table, known))
}
