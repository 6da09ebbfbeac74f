//! The points of a calibration file: from its recording, or from its schedule.

use super::dwells::{Dwelling, DwellsBy};
use super::points::Points;
use super::schedule::scheduled;
use crate::experiment::checker::Checker;
use crate::experiment::columns::Column;
use crate::experiment::entries::{AverageEntry, RoleWord, Short};
use crate::experiment::faults::{NO_DATA, RECORDING};
use crate::experiment::labels::label_columns;
use crate::experiment::names::Names;
use crate::experiment::positions::{expected, optional};
use crate::experiment::source::entries;
use crate::experiment::tables::{ColumnTable, RecordingTable};
use crate::experiment::{Doubt, Purpose};
use crate::recording::{Checks, Finding, Problem, Recording, Request, Settling, Severity, check};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::{Named, Slot, Stated};
use gumption_gum::budget::Rejection;
use std::collections::HashSet;

/// The points as they were recorded or scheduled; `None` after faults of the calibration file.
pub(super) fn points(
    checker: &mut Checker<'_>,
    names: &Names,
) -> Result<Option<Points>, Box<Rejection>> {
    let table = &checker.source.table;
    let recording = table.recording.as_ref();
    let file = recording.and_then(|recording| recording.value.0.file.as_ref());
    match (file, &table.schedule, checker.purpose) {
        (_, Some(_), Purpose::Plan) => Ok(scheduled(checker, names)),
        (Some(file), _, _) => recorded(checker, names, file),
        (None, _, _) => {
            if !table.refused && !recording.is_some_and(|recording| recording.value.0.refused) {
                checker.faults.push(no_data(checker.purpose));
            }
            Ok(None)
        }
    }
}

/// The points as they are used: those that the procedure averages, averaged.
pub(super) fn together(checker: &Checker<'_>, points: Points, doubts: &[Doubt]) -> Points {
    let recording = checker.source.table.recording.as_ref();
    match recording.and_then(|stated| stated.value.0.together.as_ref()) {
        None => points,
        Some(columns) => {
            let uncertainties = doubts.iter().filter_map(|doubt| doubt.by.as_deref());
            points.together(&texts(&columns.value), &uncertainties.collect::<Vec<_>>())
        }
    }
}

fn texts(list: &[Stated<String>]) -> Vec<&str> {
    list.iter().map(|stated| stated.value.as_str()).collect()
}

fn owned(list: &[Stated<String>]) -> Vec<String> {
    list.iter().map(|stated| stated.value.clone()).collect()
}

fn no_data(purpose: Purpose) -> Fault {
    match purpose {
        Purpose::Calibrate => Fault::new(NO_DATA, 0..0, say!("the calibration has no recording"))
            .help(say!("name it: [recording], file = \"run.csv\"; before there are readings, `gumption plan` says what a [schedule] would tell")),
        Purpose::Plan => Fault::new(NO_DATA, 0..0, say!("the plan has no schedule"))
            .help(say!("list its points: [schedule], \"theta [deg]\" = [0, 90, 180, 270]; or name a CSV file of them: [recording], file = \"schedule.csv\"")),
    }
}

/// Whether the first line of the recording can be read, where a file names one; that it cannot is told.
pub(super) fn readable(checker: &mut Checker<'_>) -> Result<bool, Box<Rejection>> {
    let recording = checker.source.table.recording.as_ref();
    match recording.and_then(|recording| recording.value.0.file.as_ref()) {
        Some(file) => Ok(checker.headings(file)?.is_some()),
        None => Ok(true),
    }
}

fn recorded(
    checker: &mut Checker<'_>,
    names: &Names,
    file: &Stated<String>,
) -> Result<Option<Points>, Box<Rejection>> {
    let Some(found) = checker.headings(file)? else {
        return Ok(None);
    };
    let Some(stated) = checker.source.table.recording.as_ref() else {
        return Ok(None);
    };
    let Some(columns) = checker.columns(names, &found) else {
        return Ok(None);
    };
    let requests = requests(checker, names, &columns, &stated.value.0);
    let path = checker.folder.join(&file.value);
    let recording = checker.recording(&path, &requests).map_err(Box::new)?;
    Ok(averaged(checker, names, &recording, stated))
}

/// The declared columns of a role.
pub(super) fn of_role(
    columns: &Slot<Named<Short<ColumnTable>>>,
    wanted: RoleWord,
) -> impl Iterator<Item = &str> {
    let has_role = move |table: &ColumnTable| {
        let role = table.role.as_ref();
        role.is_some_and(|role| role.value == wanted)
    };
    let found = entries(columns).iter();
    let found = found.filter(move |(_, entry)| has_role(&entry.value.0));
    found.map(|(name, _)| name.as_str())
}

/// The column of time.
fn time<'t>(checker: &Checker<'t>) -> Option<&'t str> {
    of_role(&checker.source.table.columns, RoleWord::Time).next()
}

/// The columns that may act on the readings whether an equation has them or not.
pub(super) fn conditions<'t>(checker: &Checker<'t>) -> impl Iterator<Item = &'t str> + use<'t> {
    let columns = &checker.source.table.columns;
    of_role(columns, RoleWord::Covariate).chain(time(checker))
}

/// The columns that a calibration asks the recording for, each once.
fn requests(
    checker: &Checker<'_>,
    names: &Names,
    columns: &[Column<'_>],
    table: &RecordingTable,
) -> Vec<Request> {
    let labels = label_columns(checker);
    let steps = table.steps.iter().flat_map(|list| texts(&list.value.0));
    let numbers = names.columns.iter().map(|(name, _)| name);
    let named = numbers.chain(&names.optional);
    let named = named.chain(labels.iter().map(|label| &label.name));
    let noise = checker.source.table.noise.as_ref();
    let replicates = noise.and_then(|noise| noise.value.replicates.as_ref());
    let replicates = replicates.iter().flat_map(|list| texts(&list.value.0));
    // Of rows that are averaged it says nothing.
    let rows = checker.purpose != Purpose::Calibrate || !table.holds_samples();
    let of_rows = of_role(&checker.source.table.columns, RoleWord::Uncertainty);
    let of_rows = of_rows.filter(|_| rows);
    let counts = of_role(&checker.source.table.columns, RoleWord::Count);
    let wanted = named
        .map(String::as_str)
        .chain(conditions(checker))
        .chain(steps);
    let wanted = wanted.chain(replicates).chain(of_rows).chain(counts);
    let mut requests: Vec<Request> = Vec::new();
    for name in wanted {
        let column = columns.iter().find(|column| column.name == name);
        let asked = requests.iter().any(|request| request.role == name);
        if let (Some(column), false) = (column.filter(|column| column.is_there), asked) {
            requests.push(column.request());
        }
    }
    requests
}

/// The points of a recording: its rows, or the averages of its dwells.
fn averaged(
    checker: &mut Checker<'_>,
    names: &Names,
    recording: &Recording,
    stated: &Stated<Short<RecordingTable>>,
) -> Option<Points> {
    let table = &stated.value.0;
    let findings = findings(checker, names, recording, table);
    let grave = findings
        .iter()
        .filter(|finding| finding.severity() == Severity::Error);
    let mut refused = false;
    for finding in grave {
        refused = true;
        let place = table
            .file
            .as_ref()
            .map_or(stated.key.clone(), |file| file.span.clone());
        checker.faults.push(
            Fault::new(
                RECORDING,
                place,
                say!("{}: {}", recording.name, finding.said()),
            )
            .label(say!("this recording"))
            .help(finding.mend()),
        );
    }
    if refused {
        return None;
    }
    let samples = table.holds_samples();
    let mut points = if checker.purpose == Purpose::Plan || !samples {
        Points::of_rows(recording)
    } else {
        let dwelling = dwelling(checker, names, recording, table)?;
        let (points, lost) = Points::of_dwells(recording, &dwelling);
        for dwell in &lost {
            let name = match &dwell.label {
                Some(label) => format!("{label} "),
                None => String::new(),
            };
            let line = recording.line(dwell.rows.start);
            let rows = dwell.rows.len();
            let place = stated.key.clone();
            checker.faults.push(
                Fault::new(RECORDING, place, say!(
                    "{}: the dwell {name}from line {line} on has too few samples: {rows} before settling is left out", recording.name))
                    .label(say!("too few samples are left"))
                    .help(say!("record longer, shorten `settle`, or lower `fewest`")),
            );
        }
        if points.names.is_empty() && lost.is_empty() {
            checker.faults.push(
                Fault::new(
                    RECORDING,
                    stated.key.clone(),
                    say!(
                        "{}: nothing stays at one value long enough for a dwell",
                        recording.name
                    ),
                )
                .label(say!("no dwells"))
                .help(say!("shorten `settle` or lower `fewest`; or state `tolerance`, how far apart the values of the stimulus in one dwell may be")),
            );
        }
        points
    };
    points.findings.splice(..0, findings);
    Some(points)
}

fn dwelling(
    checker: &mut Checker<'_>,
    names: &Names,
    recording: &Recording,
    table: &RecordingTable,
) -> Option<Dwelling> {
    let time = time(checker).map(str::to_owned);
    let unit = time
        .as_ref()
        .and_then(|role| recording.column(role))
        .and_then(|column| column.unit.clone())
        .unwrap_or_else(Unit::one);
    let mut in_time = |stated: &Slot<gumption_format::toml::Amount>| match stated {
        Some(amount) => checker.amount(amount, &unit).map(Some),
        None => Some(None),
    };
    let (settle, dwell) = (in_time(&table.settle), in_time(&table.dwell));
    if time.is_none() && (settle.is_none() || dwell.is_none()) {
        let help = say!(
            "without a column of the role \"time\" this is a number of rows; name that column: [columns] \"t [s]\" = \"time\""
        );
        if let Some(fault) = checker.faults.pop() {
            checker.faults.push(fault.help(help));
        }
    }
    let (settle, dwell) = (settle?.unwrap_or(0.0), dwell?);
    let fewest = table.fewest.as_ref().map_or(2, |stated| stated.value);
    Some(Dwelling {
        by: dwells_by(names, table),
        stimuli: set(checker, names),
        time,
        settling: Settling {
            settle,
            dwell,
            fewest: usize::try_from(fewest).unwrap_or(usize::MAX).max(2),
        },
    })
}

/// The columns that equations have on their right sides, and what is called a stimulus, but for covariates and the time.
fn set(checker: &Checker<'_>, names: &Names) -> Vec<String> {
    let columns = &checker.source.table.columns;
    let stimuli = of_role(columns, RoleWord::Stimulus);
    let others: Vec<&str> = conditions(checker)
        .chain(names.responses.iter().map(String::as_str))
        .collect();
    let used = names.columns.iter().map(|(name, _)| name.as_str());
    let used = used.filter(|name| !others.contains(name));
    let mut all: Vec<String> = stimuli.chain(used).map(str::to_owned).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Labels before steps, and these before rest.
fn dwells_by(names: &Names, table: &RecordingTable) -> DwellsBy {
    match (&table.dwells, &table.steps, &table.still) {
        (None, Some(stimuli), _) => DwellsBy::Steps {
            stimuli: owned(&stimuli.value.0),
            tolerance: table.tolerance.as_ref().map(|stated| stated.value),
        },
        (None, None, Some(rows)) => DwellsBy::Rest {
            outputs: names.columns.iter().map(|(role, _)| role.clone()).collect(),
            rows: usize::try_from(rows.value).unwrap_or(usize::MAX),
        },
        (labels, ..) => DwellsBy::Labels(
            labels
                .as_ref()
                .map_or_else(Vec::new, |list| owned(&list.value.0)),
        ),
    }
}

impl RecordingTable {
    /// Whether something tells dwells apart.
    fn tells_dwells(&self) -> bool {
        self.dwells.is_some() || self.steps.is_some() || self.still.is_some()
    }

    /// Whether its rows are samples.
    pub(super) fn holds_samples(&self) -> bool {
        let average = self.average.as_ref().map(|stated| stated.value);
        average != Some(AverageEntry::Nothing) && self.tells_dwells()
    }
}

/// More rows than these are hardly averages that somebody has forgotten to call so.
const MANY: usize = 100;

/// What is doubtful in the recording.
fn findings(
    checker: &Checker<'_>,
    names: &Names,
    recording: &Recording,
    table: &RecordingTable,
) -> Vec<Finding> {
    let mut outputs: Vec<&str> = names.responses.iter().map(String::as_str).collect();
    let ranges: Vec<(&str, [f64; 2])> = entries(&checker.source.table.columns)
        .iter()
        .filter_map(
            |(role, entry)| match entry.value.0.range.as_ref()?.value.as_slice() {
                [low, high] => Some((role.as_str(), [low.value, high.value])),
                _ => None,
            },
        )
        .collect();
    let positions = checker.source.table.positions.as_ref();
    let expected: Vec<&str> = positions.map_or_else(Vec::new, |stated| expected(&stated.value));
    let column = positions.and_then(|stated| stated.value.column.as_ref());
    let samples = table.holds_samples();
    if !samples {
        // Averages may be equal; only a stated range tells their limit.
        outputs.retain(|output| ranges.iter().any(|(role, _)| role == output));
    }
    let dwells = table.dwells.as_ref().filter(|_| samples);
    let mut findings = check(
        recording,
        &Checks {
            time: time(checker),
            outputs: &outputs,
            ranges: &ranges,
            dwells: &dwells.map_or_else(Vec::new, |list| texts(&list.value.0)),
            expected: column.map(|column| (column.value.as_str(), expected.as_slice())),
            fewest: 1,
        },
    );
    let optional = positions.map_or_else(HashSet::new, |stated| optional(&stated.value));
    findings.retain(|finding| match &finding.problem {
        Problem::LabelUnknown { label, .. } => !optional.contains(label.as_str()),
        _ => true,
    });
    if !samples && table.average.is_none() && recording.rows() > MANY {
        findings.push(Finding {
            problem: Problem::EachRow,
            column: None,
            line: 0,
            count: recording.rows(),
        });
    }
    findings
}
