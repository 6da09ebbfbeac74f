//! What an experiment states in two ways, and what it states that a calibration does not use.

use super::points::Points;
use crate::experiment::checker::Checker;
use crate::experiment::entries::{AverageEntry, RoleWord};
use crate::experiment::faults::KEY;
use crate::experiment::names::{Kind, Names};
use crate::experiment::source::entries;
use crate::experiment::tables::{ExperimentTable, NoiseTable, RecordingTable};
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
    let [names, first] = silent(experiment)?;
    Some(say!(
        "Nothing states how the readings of {names} will scatter, and what is expected leaves it out. State it: [noise] u = …, or [reading.{first}] u = …."
    ))
}

/// Where the stated errors are all there is, readings without one of their own are taken as free of scatter.
pub(super) fn stated_without_scatter(experiment: &Experiment) -> Option<Said> {
    let [names, first] = silent(experiment)?;
    Some(say!(
        "The stated errors are taken for all there is, and none is stated of each reading of {names}: the uncertainties leave its scatter out. State it: [noise] u = …, or [reading.{first}] u = …; or leave out `from`, and the residuals tell it."
    ))
}

/// The outputs of which no reading has an error of its own, and the first of them.
fn silent(experiment: &Experiment) -> Option<[String; 2]> {
    let observed = experiment
        .observed
        .iter()
        .filter_map(|observed| match observed {
            Observed::Column(name) => Some(name.as_str()),
            _ => None,
        });
    let scatters = |name: &str| experiment.doubts.iter().any(|doubt| doubt.is_of_each(name));
    let silent: Vec<&str> = observed.filter(|name| !scatters(name)).collect();
    let first = (*silent.first()?).to_owned();
    Some([silent.join(", "), first])
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
    let of_noise = keys.iter().filter(|(_, is_there)| *is_there).map(|(key, _)| say!("`{key}` of [noise] is used by `diagnose` and `simulate` only; state such an error of the readings below [reading.NAME]."));
    let of_columns = columns.iter().map(|(name, entry)| {
        let column = &entry.value.0;
        let role = column.role.as_ref().map(|role| role.value);
        let is_averaged = samples && role == Some(RoleWord::Uncertainty);
        let by = |key: &str| say!("`{key}` of the column {name} is used by `diagnose` and `simulate` only; state the error of its readings below [reading.NAME].");
        let common = || say!("`u_common` of the column {name} is used by `diagnose` only; state the error that its readings share below [reading.NAME], with scope = \"common\".");
        let has_u = is_averaged || column.u.is_some();
        let of_u = has_u.then(|| by("u"));
        let of_resolution = column.resolution.is_some().then(|| by("resolution"));
        let of_common = column.u_common.is_some().then(common);
        [of_u, of_common, of_resolution].into_iter().flatten()
    });
    let unused = columns.iter().filter_map(|(name, entry)| {
        let role = entry.value.0.role.as_ref()?.value;
        let is_used = names.kind(name) == Some(Kind::Column);
        (role == RoleWord::Stimulus && !is_used).then(|| say!("No equation has the stimulus {name}: what it does to the readings is taken for scatter. `gumption diagnose` tests whether it acts."))
    });
    let of_noise = of_noise.chain(of_columns.flatten());
    of_noise
        .chain(unused)
        .chain(of_rows(recording.map(|stated| &stated.value.0)))
        .collect()
}

/// What a recording states of averages that are not formed.
fn of_rows(recording: Option<&RecordingTable>) -> Vec<Said> {
    let Some(table) = recording else {
        return Vec::new();
    };
    let cuts = [
        ("settle", table.settle.is_some()),
        ("dwell", table.dwell.is_some()),
        ("fewest", table.fewest.is_some()),
        ("tolerance", table.tolerance.is_some()),
    ];
    let cuts = cuts
        .iter()
        .filter(|(_, is_there)| *is_there && !table.holds_samples());
    let cuts: Vec<String> = cuts.map(|(key, _)| format!("`{key}`")).collect();
    let in_vain = (!cuts.is_empty()).then(|| {
        let keys = cuts.join(", ");
        say!("{keys} of [recording] is used where dwells are averaged; here each row is a point. Say what tells dwells apart: dwells = [\"position\"], steps or still.")
    });
    let rows = table.average.as_ref().map(|stated| stated.value);
    let of_rows = match rows {
        Some(AverageEntry::AtMost(_)) => Some(say!(
            "`average` of [recording] is used by `diagnose` only; here each row is a point."
        )),
        _ => None,
    };
    in_vain
        .into_iter()
        .chain(of_rows)
        .chain(told_twice(table))
        .collect()
}

/// One thing tells dwells apart: labels before steps, and these before rest.
fn told_twice(table: &RecordingTable) -> Option<Said> {
    let ways = [
        ("dwells", table.dwells.is_some()),
        ("steps", table.steps.is_some()),
        ("still", table.still.is_some()),
    ];
    let mut stated = ways
        .iter()
        .filter(|(_, is_there)| *is_there)
        .map(|(key, _)| key);
    let (first, other) = (stated.next()?, stated.next()?);
    Some(say!(
        "`{other}` of [recording] is not used: `{first}` tells the dwells apart."
    ))
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
