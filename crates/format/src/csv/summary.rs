//! Lines at the end of a table that sum up the rows above.

use std::ops::Range;

use super::columns::Columns;
use super::faults::NOT_A_NUMBER;
use super::field::{number, says_missing};
use super::sheet::{Row, Sheet};
use gumption_core::quantity::Decimal;
use gumption_core::statistics::range;
use gumption_fault::{Fault, say};

/// What a line of means is called.
const MEANS: [&str; 9] = [
    "mean",
    "average",
    "avg",
    "mittelwert",
    "mittel",
    "moyenne",
    "media",
    "平均",
    "均值",
];

/// What a line of sums is called.
const SUMS: [&str; 9] = [
    "total", "sum", "subtotal", "summe", "gesamt", "somme", "合计", "总计", "总和",
];

/// What a line makes of the numbers above it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Made {
    Means,
    Sums,
}

impl Made {
    /// Of so many numbers with this sum.
    fn of(self, sum: f64, count: usize) -> f64 {
        match self {
            Made::Means => sum / count as f64,
            Made::Sums => sum,
        }
    }

    fn words(self) -> &'static [&'static str] {
        match self {
            Made::Means => &MEANS,
            Made::Sums => &SUMS,
        }
    }
}

/// Rows above of which numbers are no accident, and lines that sum up at most.
const ROWS: usize = 3;
const LINES: usize = 5;

/// Lines at the end that sum up the rows above, such as their mean: in a column in which all of those have numbers they have a word.
/// Taken for rows they would count as readings, also where that column is not read.
pub(super) fn summary(sheet: &Sheet<'_>) -> Option<Fault> {
    let last = sheet.rows().filter_map(Result::ok).last()?;
    let words = last.fields().enumerate();
    let mut words = words.filter(|(_, text)| is_word(text));
    words.find_map(|(column, _)| summary_in(sheet, column))
}

/// The same by the words of one column.
fn summary_in(sheet: &Sheet<'_>, column: usize) -> Option<Fault> {
    let mut rows = sheet.rows().filter_map(Result::ok);
    let is_number = |row: &Row<'_>| number(row.field(column), sheet).is_some_and(f64::is_finite);
    let mut numbers = 0;
    let first = rows.by_ref().find(|row| {
        numbers += 1;
        !is_number(row)
    })?;
    let mut lines = rows.by_ref().take(LINES);
    let are_words = is_word(first.field(column)) && lines.all(|row| is_word(row.field(column)));
    if numbers <= ROWS || !are_words || rows.next().is_some() {
        return None;
    }
    let (head, word) = (sheet.header().field(column), first.field(column));
    let message = say!(
        "line {}, column \"{head}\": \"{word}\" where all rows above have a number",
        first.line
    );
    let fault = Fault::new(NOT_A_NUMBER, sheet.place(&first, column), message);
    let fault = fault.label(say!("does this line sum up the rows above?"));
    Some(fault.help(say!(
        "delete it: what sums up rows is none of them; if it is one, leave this field empty"
    )))
}

/// A line at the end whose numbers are the means or the sums of those above, in a table of which each row is something of its own: where no
/// column but those of numbers tells its rows apart, it has a word in one of the others. One that is called so may have few
/// digits, and two rows above.
pub fn summary_of_rows(sheet: &Sheet<'_>, has_numbers: impl Fn(usize) -> bool) -> Option<Fault> {
    let rows = || sheet.rows().filter_map(Result::ok);
    let place = |row: &Row<'_>, column| sheet.place(row, column);
    summary_among((sheet, has_numbers), rows().last()?, rows, place)
}

/// The same of a table in memory, of which `head` is the line of names: there a line has no place but below them.
pub fn summary_of_columns(
    columns: &Columns<'_>,
    head: &Sheet<'_>,
    has_numbers: impl Fn(usize) -> bool,
) -> Option<Fault> {
    /// A file is looked at as far as its first piece goes.
    const MOST: usize = 1 << 15;
    let count = columns.rows();
    let last = count.checked_sub(1).filter(|last| *last < MOST)?;
    let rows = || (0..count).map(|at| columns.row(at));
    let place = |_: &Row<'_>, column| head.name_place(column);
    summary_among((head, has_numbers), columns.row(last), rows, place)
}

/// The same of these rows, of which the last is at hand; `place` is where a field of a row stands.
fn summary_among<'r, R: Iterator<Item = Row<'r>>>(
    (sheet, has_numbers): (&Sheet<'_>, impl Fn(usize) -> bool),
    last: Row<'r>,
    rows: impl Fn() -> R,
    place: impl Fn(&Row<'r>, usize) -> Range<usize>,
) -> Option<Fault> {
    /// By chance a row is so rarely the mean of the others.
    const RARE: f64 = 0.001;
    let (numbers, names): (Vec<usize>, Vec<usize>) =
        (0..sheet.header().len()).partition(|at| has_numbers(*at));
    let word = |row: &Row<'_>| names.iter().copied().find(|at| is_word(row.field(*at)));
    word(&last)?;
    let rows: Vec<Row<'r>> = rows().collect();
    let is_made = |at: usize, made: Made| {
        let (above, own) = (&rows[..at], &rows[at]);
        let is_called = word(own).is_some_and(|column| is_called(own.field(column), made));
        let (fewest, rare) = if is_called { (2, 1.0) } else { (ROWS, RARE) };
        let chance = || chance((above, fewest, made), own, &numbers, sheet);
        rows[at..].iter().all(|row| word(row).is_some())
            && above.len() >= fewest
            && chance().is_some_and(|chance| chance < rare)
    };
    let first = rows.len().saturating_sub(LINES);
    let made = |at: usize| {
        let mut ways = [Made::Means, Made::Sums].into_iter();
        Some((at, ways.find(|made| is_made(at, *made))?))
    };
    let (at, made) = (first..rows.len()).find_map(made)?;
    let own = &rows[at];
    let column = word(own)?;
    let (line, text) = (own.line, own.field(column));
    let message = match made {
        Made::Means => {
            say!("line {line}, \"{text}\": its numbers are the means of those of all rows above")
        }
        Made::Sums => {
            say!("line {line}, \"{text}\": its numbers are the sums of those of all rows above")
        }
    };
    let fault = Fault::new(NOT_A_NUMBER, place(own, column), message);
    let fault = fault.label(say!("does this line sum up the rows above?"));
    Some(fault.help(say!(
        "delete it: what sums up rows is none of them; if it is one, give it a name with a number"
    )))
}

/// Whether a text calls its line the mean or the sum of others: `Mean`, `平均值`, `Total`.
fn is_called(text: &str, made: Made) -> bool {
    let lower = text.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphabetic());
    words.any(|word| made.words().contains(&word.trim_end_matches('值')))
}

/// How likely numbers anywhere between those above are their means, or as far away as these their sums, to the digits that a row has;
/// nothing where its numbers are not. Fewer rows above than `fewest` say nothing.
fn chance(
    (above, fewest, made): (&[Row<'_>], usize, Made),
    own: &Row<'_>,
    columns: &[usize],
    sheet: &Sheet<'_>,
) -> Option<f64> {
    let of = |column: usize| {
        let (text, read) = (own.field(column), |row: &Row<'_>| {
            number(row.field(column), sheet)
        });
        let numbers: Option<Vec<f64>> = above.iter().map(read).collect();
        let mut numbers = numbers.unwrap_or_default();
        numbers.retain(|number| number.is_finite());
        // What is missing, or is no number, says nothing.
        let Some(value) = read(own).filter(|own| own.is_finite() && numbers.len() >= fewest) else {
            return Some(1.0);
        };
        let place = Decimal::from_text(&text.replace(',', ".")).and_then(|own| own.place());
        let digit = 10f64.powi(place.unwrap_or(0));
        let (least, most) = range(numbers.iter().copied());
        let range = most - least;
        let mean = made.of(numbers.iter().sum::<f64>(), numbers.len());
        // Half a digit, beside what the sum is rounded by.
        let is_mean = (value - mean).abs() <= 0.5 * digit + 1e-12 * mean.abs();
        is_mean.then(|| if range > digit { digit / range } else { 1.0 })
    };
    columns.iter().map(|column| of(*column)).product()
}

fn is_word(text: &str) -> bool {
    text.contains(char::is_alphabetic) && !text.contains(char::is_numeric) && !says_missing(text)
}

#[cfg(test)]
mod tests {
    use super::super::columns::Cells;
    use super::*;

    #[test]
    fn what_sums_up_rows_is_none_of_them() {
        let found = |text: &str| {
            summary(&Sheet::new(text).expect("a table")).map(|fault| text[fault.span].to_owned())
        };
        assert_eq!(
            found("n,V\n1,1.0\n2,1.1\n3,1.2\nmean,1.1\n").as_deref(),
            Some("mean")
        );
        assert_eq!(
            found("n;V\n1;1,0\n2;1,1\n3;1,2\n平均;1,1\n标准差;0,1\n").as_deref(),
            Some("平均")
        );
        for rows in [
            "n,V\n1,1.0\n2,1.1\n3,1.2\n,1.1\n",
            "n,V\nA,1.0\nB,1.1\n3,1.2\nC,1.1\n",
            "n,V\n1,1.0\n2,1.1\n3,1.2\n4a,1.1\n",
            "n,V\n1,1.0\nmean,1.1\n",
            "n,V\n1,1.0\n2,1.1\n3,1.2\n4,NA\n",
        ] {
            assert_eq!(found(rows), None, "{rows}");
        }
    }

    #[test]
    fn a_line_of_means_is_told_by_its_numbers_and_its_name() {
        let found = |text: &str| {
            let sheet = Sheet::new(text).expect("a table");
            let fault = summary_of_rows(&sheet, |at| at > 0);
            fault.map(|fault| text[fault.span].to_owned())
        };
        let rows = "label,V,R\nS1,1.001,100.01\nS2,1.004,100.02\nS3,1.002,100.06\n";
        // (1.001 + 1.004 + 1.002)/3 = 1.00233, (100.01 + 100.02 + 100.06)/3 = 100.03.
        for (lines, wanted) in [
            ("mean,1.0023,100.030\n", Some("mean")),
            ("平均值,1.0023,100.030\ns,0.0015,0.026\n", Some("平均值")),
            ("mean,1.002333,\n", Some("mean")),
            // Another one, one that is hardly told from the others, one that has a number as the others have.
            ("Ref,1.0023,100.031\n", None),
            ("Ref,1.002,100.0\n", None),
            ("S4,1.0023,100.030\n", None),
            ("mean,1.0023,100.030\nS5,1.003,100.04\n", None),
        ] {
            let text = format!("{rows}{lines}");
            assert_eq!(found(&text).as_deref(), wanted, "{lines}");
        }
        // What is called a mean may have few digits, and two rows above.
        for (lines, wanted) in [
            (
                "A,1.0,10.0\nB,1.1,10.2\nC,1.2,10.1\nMean,1.1,10.1\n",
                Some("Mean"),
            ),
            ("A,1.0,10.0\nB,1.1,10.2\nC,1.2,10.1\nD,1.1,10.1\n", None),
            (
                "A,1.001,10.01\nB,1.005,10.03\n平均值,1.003,10.02\n",
                Some("平均值"),
            ),
            ("A,1.001,10.01\nB,1.005,10.03\nmean,1.002,10.02\n", None),
            ("A,1.001,10.01\nB,1.005,10.03\nMedian,1.003,10.02\n", None),
        ] {
            let text = format!("label,V,R\n{lines}");
            assert_eq!(found(&text).as_deref(), wanted, "{lines}");
        }

        // Sums, which are as rare by chance.
        for (lines, wanted) in [
            ("A,1.0,10.0\nB,1.1,10.2\nTotal,2.1,20.2\n", Some("Total")),
            ("A,1.0,10.0\nB,1.1,10.2\n合计,2.1,20.2\n", Some("合计")),
            ("A,1.0,10.0\nB,1.1,10.2\nTotal,2.2,20.2\n", None),
            (
                "A,12.345,101.2\nB,45.678,204.9\nC,78.123,150.5\nall,136.146,456.6\n",
                Some("all"),
            ),
            ("A,1,10\nB,1,12\nC,1,11\nD,3,33\n", None),
        ] {
            let text = format!("label,V,R\n{lines}");
            assert_eq!(found(&text).as_deref(), wanted, "{lines}");
        }

        // As columns, which have their numbers as they are computed.
        let numbers = |last: f64| Cells::Numbers(vec![100.0, 203.0, 151.0, 170.0, last].into());
        let found = |name: &str, last| {
            let names = ["d1", "d2", "d3", "d4", name].map(str::to_owned);
            let labels = ("label".to_owned(), Cells::Texts(names.into()));
            let columns = Columns::new(vec![labels, ("R".to_owned(), numbers(last))]);
            let (columns, head) = (columns.expect("of equal length"), "label,R\n");
            let head = Sheet::new(head).expect("names");
            summary_of_columns(&columns, &head, |at| at > 0).map(|fault| fault.span)
        };
        assert_eq!(found("mean", 156.0), Some(0..5));
        assert_eq!((found("d5", 156.0), found("mean", 157.0)), (None, None));
    }
}
