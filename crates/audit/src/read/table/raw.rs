//! A row with what is needed to interpret it.

use crate::claim::Row;
use crate::printed::Printed;
use crate::read::words::has;

/// A row with what is needed to interpret it.
#[derive(Debug, Clone)]
pub struct Raw {
    /// Its figures.
    pub row: Row,
    pub(super) columns_text: String,
    pub(super) used_head: String,
    pub(super) divisor_is_factor: bool,
    pub(super) readings: Option<f64>,
    /// Its number in the list, as the sheet has it.
    pub(super) number: String,
    /// The ± column stands in a table of what is known, apart from the evaluation.
    pub(super) stated_apart: bool,
    /// u/x, where a column beside u has it.
    pub(super) relative: Option<Printed>,
    /// Whether the head of the column of u says that it is relative.
    pub(super) has_relative_u: bool,
    /// Whether rows below it are its parts, of which its u is the root of the sum of squares.
    pub(super) is_root: bool,
}

impl Raw {
    /// A row that is told in words alone.
    pub fn told(row: Row) -> Raw {
        Raw {
            row,
            columns_text: String::new(),
            used_head: String::new(),
            divisor_is_factor: false,
            readings: None,
            number: String::new(),
            stated_apart: true,
            relative: None,
            has_relative_u: false,
            is_root: false,
        }
    }

    /// Whether the number of a row, or the index of its symbol, is one below that of another.
    pub(super) fn is_part_of(&self, whole: &Raw) -> bool {
        let index = |raw: &Raw| {
            let index = raw.row.symbol.strip_prefix('u')?.trim_start_matches('_');
            let is_index = !index.is_empty() && index.bytes().all(|b| b.is_ascii_digit());
            is_index.then(|| index.to_string())
        };
        let numbered = |part: &str, whole: &str| {
            let below = part.strip_prefix(whole).unwrap_or_default();
            !whole.is_empty() && below.strip_prefix('.').is_some_and(|n| !n.is_empty())
        };
        let indexed =
            |part: String, whole: String| part.len() == whole.len() + 1 && part.starts_with(&whole);
        numbered(&self.number, &whole.number)
            || index(self)
                .zip(index(whole))
                .is_some_and(|(part, whole)| indexed(part, whole))
    }

    /// Whether both are about one quantity.
    pub fn is_of(&self, other: &Raw) -> bool {
        let same = |a: &str, b: &str| !a.is_empty() && a == b;
        same(&self.row.symbol, &other.row.symbol)
            || (self.row.symbol.is_empty() || other.row.symbol.is_empty())
                && same(self.row.label(), other.row.label())
    }

    /// Whether the longer name of both begins with the shorter: `Repeatability` and `Repeatability, s of the mean`.
    pub fn is_like(&self, other: &Raw) -> bool {
        let (own, other) = (self.row.label(), other.row.label());
        let begins = |long: &str, short: &str| {
            let behind = long.strip_prefix(short).filter(|_| !short.is_empty());
            behind.is_some_and(|behind| !behind.starts_with(char::is_alphanumeric))
        };
        begins(own, other) || begins(other, own)
    }

    /// Takes over what a table of what is known says of the quantity.
    pub fn absorb(&mut self, input: &Raw) {
        let (row, known) = (&mut self.row, &input.row);
        row.value = row.value.take().or_else(|| known.value.clone());
        if row.divisor.is_none() {
            row.divisor.clone_from(&known.divisor);
            self.divisor_is_factor = input.divisor_is_factor;
        }
        if row.used.is_none() && known.used.is_some() {
            row.used.clone_from(&known.used);
            self.used_head.clone_from(&input.used_head);
            self.stated_apart = true;
        }
        for (own, other) in [(&mut row.name, &known.name), (&mut row.unit, &known.unit)] {
            if own.is_empty() {
                own.clone_from(other);
            }
        }
        row.words.push_str("; ");
        row.words.push_str(&known.words);
        self.readings = self.readings.or(input.readings);
        if self.columns_text.trim() == ";" {
            self.columns_text.clone_from(&input.columns_text);
        }
    }

    /// Whether the row is called the result, and has nothing that an input has.
    pub fn is_result(&self, measurand: &str) -> bool {
        let row = &self.row;
        let named = !measurand.is_empty() && row.symbol == measurand;
        let y = matches!(row.symbol.as_str(), "y" | "Y")
            || has(
                &row.name.to_lowercase(),
                &[
                    "result",
                    "measurand",
                    "ergebnis",
                    "résultat",
                    "结果",
                    "被测量",
                ],
            );
        let input = row.used.is_some() || row.c.is_some() || row.divisor.is_some();
        let figure = row.contribution.is_some() || row.u.is_some() || row.value.is_some();
        (named || y) && !input && figure
    }

    /// What an input has and a result has not: how it is distributed, what it was divided by, how it enters.
    pub(super) fn is_input(&self) -> bool {
        let row = &self.row;
        let said = self.columns_text.contains(|c: char| c.is_alphanumeric());
        said || row.used.is_some() || row.c.is_some() || row.divisor.is_some()
    }

    /// The contribution that its row states, without its sign.
    pub(super) fn part(&self) -> Option<f64> {
        let row = &self.row;
        let c = row.c.as_ref().map_or(1.0, |c| c.value);
        let of_u = row.u.as_ref().map(|u| c * u.value);
        let part = row.contribution.as_ref().map(|part| part.value).or(of_u);
        part.map(f64::abs)
    }
}

/// A figure without its sign: an uncertainty has none.
pub(super) fn positive(mut figure: Printed) -> Printed {
    figure.value = figure.value.abs();
    figure
}
