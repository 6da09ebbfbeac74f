//! What an experiment states in two ways, and what it states that a calibration does not use.

use super::points::Points;
use crate::experiment::checker::Checker;
use crate::experiment::entries::RoleWord;
use crate::experiment::faults::KEY;
use crate::experiment::names::{Kind, Names};
use crate::experiment::source::entries;
use crate::experiment::tables::{ExperimentTable, NoiseTable};
use crate::experiment::{Experiment, Observed, Scope};
use gumption_fault::{Fault, Said, say};

/// Faults of keys that would change the result of a calibration, and cannot.
pub(super) fn check(checker: &mut Checker<'_>) {
    let table = &checker.source.table;
    let per = entries(&table.parameter)
        .iter()
        .filter_map(|(name, entry)| Some((name, entry.value.per.as_ref()?)));
    let faults: Vec<Fault> = per
        .map(|(name, column)| {
            let message = say!("a calibration finds one value of {name} for all rows");
            Fault::new(KEY, column.span.clone(), message)
                .label(say!("`per` is used by `diagnose` and `simulate`"))
                .help(say!(
                    "write separately = \"{}\" at the top of the file: the rows of each label are calibrated by themselves",
                    column.value
                ))
        })
        .collect();
    checker.faults.extend(faults);
}

/// A plan of readings that nothing lets scatter expects less than there will be.
pub(super) fn without_scatter(experiment: &Experiment) -> Option<Said> {
    let observed = experiment
        .observed
        .iter()
        .filter_map(|observed| match observed {
            Observed::Column(name) => Some(name.as_str()),
            _ => None,
        });
    let scatters = |name: &str| experiment.doubts.iter().any(|doubt| doubt.is_of_each(name));
    let silent: Vec<&str> = observed.filter(|name| !scatters(name)).collect();
    let first = silent.first()?;
    let names = silent.join(", ");
    Some(say!(
        "Nothing states how the readings of {names} will scatter, and what is expected leaves it out. State it: [noise] u = …, or [reading.{first}] u = …."
    ))
}

/// Remarks on what is stated and not used by a calibration: of the noise, and stimuli that no equation has.
pub(super) fn remarks(table: &ExperimentTable, names: &Names) -> Vec<Said> {
    let noise = table.noise.as_ref().map(|noise| &noise.value);
    let of_noise = |is_there: fn(&NoiseTable) -> bool| noise.is_some_and(is_there);
    let columns = entries(&table.columns);
    let recording = table.recording.as_ref();
    let samples = recording.is_some_and(|recording| recording.value.0.holds_samples());
    let keys = [
        ("walk", of_noise(|noise| noise.walk.is_some())),
        ("resolution", of_noise(|noise| noise.resolution.is_some())),
    ];
    let of_noise = keys.iter().filter(|(_, is_there)| *is_there).map(|(key, _)| say!("`{key}` of [noise] is used by `diagnose` only; state such an error of the readings below [reading.NAME]."));
    let of_columns = columns.iter().filter_map(|(name, entry)| {
        let column = &entry.value.0;
        let role = column.role.as_ref().map(|role| role.value);
        let is_averaged = samples && role == Some(RoleWord::Uncertainty);
        let used = [
            (is_averaged, "u"),
            (column.u.is_some(), "u"),
            (column.u_common.is_some(), "u_common"),
        ];
        let (_, key) = used.iter().find(|(is_there, _)| *is_there)?;
        Some(say!("`{key}` of the column {name} is used by `diagnose` and `simulate` only; state the error of its readings below [reading.NAME]."))
    });
    let unused = columns.iter().filter_map(|(name, entry)| {
        let role = entry.value.0.role.as_ref()?.value;
        let is_used = names.kind(name) == Some(Kind::Column);
        (role == RoleWord::Stimulus && !is_used).then(|| say!("No equation has the stimulus {name}: what it does to the readings is taken for scatter. `gumption diagnose` tests whether it acts."))
    });
    of_noise.chain(of_columns).chain(unused).collect()
}

/// Errors that points with the same label share, of columns that hold measured numbers instead of labels: hardly two points have
/// the same.
pub(super) fn numbers_as_labels(experiment: &Experiment, points: &Points) -> Vec<Said> {
    let mut columns: Vec<&String> = experiment
        .doubts
        .iter()
        .filter_map(|doubt| match &doubt.scope {
            Scope::By(column) => Some(column),
            _ => None,
        })
        .collect();
    columns.sort();
    columns.dedup();
    let of_column = |column: &String| {
        let labels = points.labels(column)?;
        let numbers: Option<Vec<f64>> = labels.levels.iter().map(|l| l.parse().ok()).collect();
        let is_measured = numbers?.iter().any(|number| number.fract() != 0.0);
        let (levels, all) = (labels.levels.len(), labels.of_row.len());
        (is_measured && 2 * levels > all).then(|| say!("{column} has {levels} different numbers in {all} points: an error by {column} is hardly shared by any. Name a column whose values repeat, or write scope = \"each\"."))
    };
    columns.into_iter().filter_map(of_column).collect()
}
