//! The table of the further measurements.

use std::collections::BTreeMap;

use super::further::{Decision, PROMISED, Sequel};
use super::report::{Study, table};
use crate::further::Further;

impl Study<'_> {
    /// What became of the lists for which a further measurement was asked.
    pub(super) fn sequels(&self) -> impl Iterator<Item = Sequel> {
        self.singles().filter_map(|(record, _)| record.further)
    }

    /// The lists by the measurement that was recommended.
    pub(super) fn further(&self) -> String {
        let mut by_measure: BTreeMap<Sequel, usize> = BTreeMap::new();
        let mut made: BTreeMap<Further, Vec<Decision>> = BTreeMap::new();
        for sequel in self.sequels() {
            match sequel {
                Sequel::Made(further, decision) => made.entry(further).or_default().push(decision),
                other => *by_measure.entry(other).or_default() += 1,
            }
        }
        let mut rows: Vec<Vec<String>> = made
            .into_iter()
            .map(|(further, decisions)| {
                let count = |wanted| decisions.iter().filter(|d| **d == wanted).count();
                let mut row = vec![further.to_string(), decisions.len().to_string()];
                row.extend(Decision::ALL.iter().map(|(d, _)| count(*d).to_string()));
                row
            })
            .collect();
        let without = [
            (
                Sequel::Same,
                "none: all names say the same of every measurement",
            ),
            (Sequel::Unpromised, "none that promises it"),
            (Sequel::Impossible, "one that the simulator cannot make"),
        ];
        for (sequel, words) in without {
            let count = by_measure.get(&sequel).copied().unwrap_or_default();
            let mut row = vec![words.to_owned(), count.to_string()];
            row.extend(Decision::ALL.iter().map(|_| String::new()));
            rows.push(row);
        }
        table(
            "Lists, and the measurement that was recommended",
            &format!(
                "One effect of λ ≥ 8 whose right name is in a list. The best measurement that promises, with a \
                 probability of {:.0} % or more, to decide was made by the simulator in the same life of the \
                 device, and the whole recording was diagnosed anew.",
                100.0 * PROMISED
            ),
            &[
                "recommended",
                "lists",
                "then named rightly",
                "or with names that say the same",
                "still listed",
                "a wrong name",
                "no name",
            ],
            &rows,
        )
    }
}
