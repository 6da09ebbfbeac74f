//! What a file states that a diagnosis does not use: it is said, not passed over.

use crate::experiment::source::Source;
use crate::experiment::tables::{ExperimentTable, RecordingTable};
use gumption_format::toml::Slot;
use gumption_gum::budget::Remark;

/// Remarks on keys of the file itself that only calibrations use.
pub(super) fn remarks(source: &Source, file: &ExperimentTable) -> Vec<Remark> {
    let default = RecordingTable::default();
    let recording = file.recording.as_ref().map_or(&default, |r| &r.value.0);
    let keys = [
        ("`steps` of the recording", place(&recording.steps)),
        ("`still` of the recording", place(&recording.still)),
        ("`dwell` of the recording", place(&recording.dwell)),
        ("`together` of the recording", place(&recording.together)),
        ("`separately`", place(&file.separately)),
        ("`weights`", place(&file.weights)),
        ("[[correlation]]", place(&file.correlation)),
    ];
    keys.into_iter()
        .filter(|(_, place)| place.as_ref().is_some_and(|place| !source.is_base(place)))
        .map(|(key, _)| Remark {
            en: format!("{key} is used by `calibrate` only"),
            zh: format!("{key} 仅用于 `calibrate`"),
        })
        .collect()
}

fn place<T>(stated: &Slot<T>) -> Option<std::ops::Range<usize>> {
    stated.as_ref().map(|stated| stated.span.clone())
}
