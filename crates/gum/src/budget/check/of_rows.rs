//! The faults of the rows of a series: which row has those that not all of them have.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use gumption_fault::{Fault, say};

/// Where the file has a row, and its label or number.
pub(super) type Place = Option<(Range<usize>, String)>;

/// A fault, the first row that has it, and in how many it is.
struct Found {
    fault: Fault,
    place: Place,
    times: usize,
}

/// The faults of rows, each once, and with the first row that has it unless all of them do or it stands in the row itself.
pub(super) fn of_rows(rows: Vec<(Place, Vec<Fault>)>) -> Vec<Fault> {
    let number = rows.len();
    let mut found: BTreeMap<(usize, usize, String), Found> = BTreeMap::new();
    for (place, mut faults) in rows {
        faults.dedup();
        for fault in faults {
            let key = (fault.span.start, fault.span.end, fault.message.to_string());
            match found.entry(key) {
                Entry::Occupied(mut entry) => entry.get_mut().times += 1,
                Entry::Vacant(entry) => {
                    entry.insert(Found {
                        fault,
                        place: place.clone(),
                        times: 1,
                    });
                }
            }
        }
    }
    found
        .into_values()
        .map(|found| match found.place {
            Some((place, row)) if found.times < number && !holds(&place, &found.fault.span) => {
                found.fault.related(place, say!("as in row {row}"))
            }
            _ => found.fault,
        })
        .collect()
}

fn holds(place: &Range<usize>, span: &Range<usize>) -> bool {
    place.start <= span.start && span.end <= place.end
}
