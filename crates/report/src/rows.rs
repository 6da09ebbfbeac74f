//! Results as rows of numbers, for spreadsheets and scripts.

use std::io::Write;

use super::{Report, decisions};
use gumption_core::model::Output;
use gumption_core::quantity::Unit;
use gumption_gum::budget::Budget;
use gumption_gum::propagate::Figures;

/// One line for every row, exact, as comma-separated values: label, and for every measurand what is reported of it, with its
/// unit in the head; for every assessment its verdict and conformance probability; for every characteristic limit whether the effect is
/// recognised, the limits and the best estimate. What a row has not is empty.
///
/// # Errors
/// Only where the text cannot be put together, which memory alone could prevent.
pub fn rows(rows: &[Report<'_>]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    if let Some(first) = rows.first() {
        let heads = heads(first.budget).into_iter().map(|head| head.name);
        writer.write_record(heads)?;
    }
    for row in rows {
        let mut record = csv::ByteRecord::from(vec![row.label.unwrap_or_default()]);
        let mut text = Vec::new();
        cells(row, |cell| {
            text.clear();
            cell.push(&mut text);
            record.push_field(&text);
        });
        writer.write_byte_record(&record)?;
    }
    writer
        .into_inner()
        .map_err(|error| error.into_error().into())
}

/// The head of a column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Head {
    pub name: String,
    /// Whether there are numbers below it, and not texts.
    pub numbers: bool,
}

impl Head {
    pub fn numbers(name: String) -> Head {
        Head {
            name,
            numbers: true,
        }
    }

    pub fn texts(name: impl Into<String>) -> Head {
        Head {
            name: name.into(),
            numbers: false,
        }
    }
}

pub(super) fn heads(budget: &Budget) -> Vec<Head> {
    let in_unit = |head: String, unit: &Unit| Head::numbers(in_unit(head, unit));
    let mut heads = vec![Head::texts("label")];
    for Output { name, unit, .. } in budget.model.outputs() {
        let deviation = unit.difference();
        heads.push(in_unit(name.clone(), unit));
        heads.push(in_unit(format!("u({name})"), &deviation));
        heads.push(Head::numbers(format!("nu({name})")));
        heads.push(Head::numbers(format!("k({name})")));
        heads.push(in_unit(format!("U({name})"), &deviation));
        heads.push(in_unit(format!("lower({name})"), unit));
        heads.push(in_unit(format!("upper({name})"), unit));
    }
    for assessment in &budget.conformity {
        heads.push(Head::texts(format!("verdict({})", assessment.name)));
        heads.push(Head::numbers(format!("p_c({})", assessment.name)));
    }
    for detection in &budget.detection {
        let Output { name, unit, .. } = &budget.model.outputs()[detection.measurand];
        heads.push(Head::texts(format!("verdict(detection of {name})")));
        for figure in ["decision_threshold", "detection_limit", "best", "u_best"] {
            heads.push(in_unit(format!("{figure}({name})"), unit));
        }
    }
    heads
}

/// A head with its unit.
pub(super) fn in_unit(head: String, unit: &Unit) -> String {
    match unit.is_one() {
        true => head,
        false => format!("{head} [{}]", unit.symbol),
    }
}

/// What stands in a column behind the label.
#[derive(Debug, Clone, Copy)]
pub(super) enum Cell<'a> {
    /// Exact; nothing for what there is not.
    Number(Option<f64>),
    /// A seed; nothing where there were no trials.
    Seed(Option<u64>),
    /// A label, a word, codes, an error.
    Text(&'a str),
}

impl Cell<'_> {
    /// Adds it to a text.
    pub fn push(self, text: &mut Vec<u8>) {
        match self {
            Cell::Number(Some(x)) => push_number(text, x),
            // Writing to memory does not fail.
            Cell::Seed(Some(seed)) => drop(write!(text, "{seed}")),
            Cell::Number(None) | Cell::Seed(None) => {}
            Cell::Text(words) => text.extend_from_slice(words.as_bytes()),
        }
    }
}

/// Adds a number: a shortest decimal that is read as the same double.
fn push_number(text: &mut Vec<u8>, x: f64) {
    text.extend_from_slice(zmij::Buffer::new().format(x).as_bytes());
}

/// Gives the cells of the columns behind the label, in their order.
pub(super) fn cells(report: &Report<'_>, mut give: impl FnMut(Cell<'_>)) {
    for result in &report.evaluation.results {
        let found = result.reported(&report.budget.conventions);
        figures(&found.figures(), &mut give);
    }
    for found in &report.evaluation.conformity {
        give(Cell::Text(
            found.verdict.map_or("", decisions::verdict_code),
        ));
        let known = found.conformance.as_ref();
        give(Cell::Number(known.and_then(|known| known.probability)));
    }
    for found in &report.evaluation.detection {
        give(Cell::Text(match found.recognised() {
            Some(true) => decisions::RECOGNISED,
            Some(false) => decisions::NOT_RECOGNISED,
            None => "",
        }));
        let limits = found.limits;
        let limit = limits.and_then(|limits| limits.detection_limit.value());
        give(Cell::Number(limits.map(|limits| limits.decision_threshold)));
        give(Cell::Number(limit));
        give(Cell::Number(Some(found.best.value)));
        give(Cell::Number(Some(found.best.u)));
    }
}

/// Gives the cells of what is reported of a measurand.
pub(super) fn figures(found: &Figures, mut give: impl FnMut(Cell<'_>)) {
    let numbers = [
        Some(found.estimate),
        found.u,
        found.dof,
        found.k,
        found.expanded,
        found.ends.map(|ends| ends[0]),
        found.ends.map(|ends| ends[1]),
    ];
    numbers.into_iter().for_each(|x| give(Cell::Number(x)));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the printer of the standard library, which finds a shortest decimal as well.
    #[test]
    fn numbers_are_short_and_read_as_what_they_are() {
        let digits = |text: &str| {
            let mantissa = text.split('e').next().unwrap_or_default();
            let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
            digits.trim_matches('0').len()
        };
        let check = |x: f64| {
            let mut text = Vec::new();
            push_number(&mut text, x);
            let text = String::from_utf8_lossy(&text);
            let read: f64 = text.parse().expect("a number");
            assert!(read.to_bits() == x.to_bits() || x.is_nan(), "{x:?}: {text}");
            assert_eq!(digits(&text), digits(&format!("{x:?}")), "{x:?}: {text}");
        };
        let edges = [0.0, 1e-5, 1e-4, 1e16, f64::MIN_POSITIVE, f64::MAX, 5e-324];
        for x in edges.into_iter().chain([f64::INFINITY, f64::NAN]) {
            [x, -x, x * 1.1, x * 0.9].into_iter().for_each(check);
        }
        // Half-way between two decimals.
        (0..5000).for_each(|k| check(f64::from(2 * k + 1) / 131_072.0 + 1.0));
        // SplitMix64: all doubles, and such as results are.
        let mut state = 1u64;
        for _ in 0..200_000 {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            let z = z ^ (z >> 31);
            check(f64::from_bits(z));
            check((z % 1_000_000_007) as f64 * 10f64.powi((z >> 40) as i32 % 40 - 24));
        }
    }
}
