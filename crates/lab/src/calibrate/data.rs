//! The points of a calibration file: from its recording, or from its schedule.

use std::collections::HashSet;
use std::path::Path;

use super::definer::Definer;
use super::dwells::{Dwelling, DwellsBy};
use super::faults::{NO_DATA, RECORDING, UNKNOWN_SYMBOL};
use super::label_columns::label_columns;
use super::names::Names;
use super::points::Points;
use super::positions::{expected, optional};
use super::purpose::Purpose;
use super::schedule::scheduled;
use crate::experiment::entries::{AverageEntry, RoleWord, Short};
use crate::experiment::source::entries;
use crate::experiment::tables::{ColumnTable, RecordingTable};
use crate::recording::{
    Checks, Finding, Heading, Problem, Recording, Request, Settling, Severity, check, headings,
    text_of,
};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest};
use gumption_format::toml::Stated;
use gumption_gum::budget::{Files, Rejection};

/// The points; `None` after faults of the calibration file.
pub(super) fn points(
    definer: &mut Definer<'_>,
    names: &Names,
    folder: &Path,
    purpose: Purpose,
) -> Result<Option<Points>, Box<Rejection>> {
    let table = &definer.source.table;
    let recording = table.recording.as_ref();
    let file = recording.and_then(|recording| recording.value.0.file.as_ref());
    let points = match (file, &table.schedule, purpose) {
        (_, Some(_), Purpose::Plan) => scheduled(definer, names),
        (Some(file), _, _) => recorded(definer, names, file, folder, purpose)?,
        (None, _, _) => {
            if !table.refused && !recording.is_some_and(|recording| recording.value.0.refused) {
                definer.faults.push(no_data(purpose));
            }
            None
        }
    };
    let together = recording.and_then(|stated| stated.value.0.together.as_ref());
    let Some((points, together)) = points.as_ref().zip(together) else {
        return Ok(points);
    };
    let columns: Vec<&str> = texts(&together.value);
    Ok(Some(points.together(&columns)))
}

fn texts(list: &[Stated<String>]) -> Vec<&str> {
    list.iter().map(|stated| stated.value.as_str()).collect()
}

fn no_data(purpose: Purpose) -> Fault {
    match purpose {
        Purpose::Calibrate => Fault::new(NO_DATA, 0..0, "the calibration has no recording")
            .help("name it: [recording], file = \"run.csv\"; before there are readings, `gumption plan` says what a [schedule] would tell"),
        Purpose::Plan => Fault::new(NO_DATA, 0..0, "the plan has no schedule")
            .help("list its points: [schedule], \"theta [deg]\" = [0, 90, 180, 270]; or name a CSV file of them: [recording], file = \"schedule.csv\""),
    }
}

/// Whether the first line of the recording can be read, where a file names one.
pub(super) fn readable(definer: &Definer<'_>, folder: &Path) -> Result<(), Box<Rejection>> {
    let recording = definer.source.table.recording.as_ref();
    let Some(file) = recording.and_then(|recording| recording.value.0.file.as_ref()) else {
        return Ok(());
    };
    let path = folder.join(&file.value);
    let shown = path.display().to_string();
    let text = text_of(Files::Disk, &path, &shown)?;
    headings(&text, &definer.units)
        .map(|_| ())
        .map_err(|fault| Box::new(Rejection::new(&shown, &text, vec![*fault])))
}

fn recorded(
    definer: &mut Definer<'_>,
    names: &Names,
    file: &Stated<String>,
    folder: &Path,
    purpose: Purpose,
) -> Result<Option<Points>, Box<Rejection>> {
    let path = folder.join(&file.value);
    let shown = path.display().to_string();
    let text = text_of(Files::Disk, &path, &shown)?;
    let found = headings(&text, &definer.units)
        .map_err(|fault| Box::new(Rejection::new(&shown, &text, vec![*fault])))?;
    let Some(stated) = definer.source.table.recording.as_ref() else {
        return Ok(None);
    };
    let Some(requests) = requests(definer, names, &stated.value.0, &found) else {
        return Ok(None);
    };
    let recording =
        Recording::open(Files::Disk, &path, &requests, &definer.units).map_err(Box::new)?;
    Ok(averaged(definer, names, &recording, stated, purpose))
}

/// What the file says of a column.
fn column<'t>(definer: &Definer<'t>, role: &str) -> Option<&'t ColumnTable> {
    let mut columns = entries(&definer.source.table.columns).iter();
    let (_, entry) = columns.find(|(name, _)| name == role)?;
    Some(&entry.value.0)
}

/// The header of a role: as the file says, else the role's own name.
fn header<'t>(definer: &Definer<'t>, role: &'t str) -> &'t str {
    let stated = column(definer, role).and_then(|table| table.column.as_ref());
    stated.map_or(role, |header| header.value.as_str())
}

/// The column of time.
fn time<'t>(definer: &Definer<'t>) -> Option<&'t str> {
    let mut columns = entries(&definer.source.table.columns).iter();
    let is_time = |table: &ColumnTable| {
        let role = table.role.as_ref();
        role.is_some_and(|role| role.value == RoleWord::Time)
    };
    let (name, _) = columns.find(|(_, entry)| is_time(&entry.value.0))?;
    Some(name)
}

fn is_there(found: &[Heading], header: &str) -> bool {
    let wanted = header.trim();
    found
        .iter()
        .any(|heading| heading.name == wanted || heading.text == wanted)
}

/// What to ask the recording for. Names that are neither declared nor recorded are faults of the file.
fn requests(
    definer: &mut Definer<'_>,
    names: &Names,
    table: &RecordingTable,
    found: &[Heading],
) -> Option<Vec<Request>> {
    let before = definer.faults.len();
    let mut requests = Vec::new();
    for (role, place) in &names.columns {
        let header = header(definer, role);
        let entry = column(definer, role);
        let mapped = entry.is_some_and(|entry| entry.column.is_some());
        if !mapped && !is_there(found, header) {
            let declared = entry.is_some();
            definer
                .faults
                .push(not_recorded(role, place.clone(), declared, found, names));
            continue;
        }
        let mut request = Request::numbers(role, header);
        if let Some(unit) = entry.and_then(|entry| entry.unit.as_ref()) {
            request = request.in_unit(definer.unit(unit)?);
        }
        if let Some(like) = entry.and_then(|entry| entry.like.as_ref()) {
            request = request.like(definer.unit(like)?);
        }
        requests.push(request);
    }
    let declared = entries(&definer.source.table.columns).iter();
    for (role, entry) in declared {
        let is_named = names.columns.iter().any(|(name, _)| name == role)
            || names.responses.contains(role)
            || definer.given().contains(role);
        let is_own = !definer.source.is_base(&entry.key);
        if is_own && !is_named && !is_there(found, header(definer, role)) {
            let fault = not_recorded(role, entry.key.clone(), true, found, names);
            definer.faults.push(fault);
        }
    }
    for role in &names.optional {
        let header = header(definer, role);
        let known = requests.iter().any(|request| request.role == *role);
        if !known && is_there(found, header) {
            requests.push(Request::numbers(role, header));
        }
    }
    for role in label_columns(definer) {
        requests.push(Request::labels(&role, header(definer, &role)));
    }
    let steps = table.steps.as_ref().map(|steps| steps.value.as_str());
    for role in [time(definer), steps].into_iter().flatten() {
        if !requests.iter().any(|request| request.role == role) {
            requests.push(Request::numbers(role, header(definer, role)));
        }
    }
    (definer.faults.len() == before).then_some(requests)
}

fn not_recorded(
    role: &str,
    place: std::ops::Range<usize>,
    declared: bool,
    found: &[Heading],
    names: &Names,
) -> Fault {
    let headers: Vec<&str> = found.iter().map(|heading| heading.name.as_str()).collect();
    let listed = headers.join(", ");
    if declared {
        return Fault::new(
            UNKNOWN_SYMBOL,
            place,
            format!("the recording has no column {role}"),
        )
        .label("a column of the recording")
        .help(format!(
            "say which column it is: [columns] {role} = {{ column = \"…\" }}; there are {listed}"
        ));
    }
    let fault = Fault::new(
        UNKNOWN_SYMBOL,
        place,
        format!("{role} is neither a parameter, an input nor a constant, and the recording has no such column"),
    )
    .label("not known");
    let near = nearest(
        role,
        names.known().filter(|name| *name != role).chain(headers),
    );
    match near {
        Some(near) => fault.help(format!("did you mean `{near}`?")),
        None => fault.help(format!(
            "list it under [parameter] if it is to be found, under [input] or [constant] if it is known; the columns are {listed}"
        )),
    }
}

/// The points of a recording: its rows, or the averages of its dwells.
fn averaged(
    definer: &mut Definer<'_>,
    names: &Names,
    recording: &Recording,
    stated: &Stated<Short<RecordingTable>>,
    purpose: Purpose,
) -> Option<Points> {
    let table = &stated.value.0;
    let findings = findings(definer, names, recording, table);
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
        definer.faults.push(
            Fault::new(
                RECORDING,
                place,
                format!("{}: {}", recording.name, finding.message()),
            )
            .label("this recording")
            .help(finding.advice()),
        );
    }
    if refused {
        return None;
    }
    let samples = table.holds_samples();
    let mut points = if purpose == Purpose::Plan || !samples {
        Points::of_rows(recording)
    } else {
        let dwelling = dwelling(definer, names, recording, table)?;
        let (points, lost) = Points::of_dwells(recording, &dwelling);
        for dwell in &lost {
            let name = match &dwell.label {
                Some(label) => format!("{label} "),
                None => String::new(),
            };
            let line = recording.line(dwell.rows.start);
            let rows = dwell.rows.len();
            let place = stated.key.clone();
            definer.faults.push(
                Fault::new(RECORDING, place, format!(
                    "{}: the dwell {name}from line {line} on has too few samples: {rows} before settling is left out", recording.name))
                    .label("too few samples are left")
                    .help("record longer, shorten `settle`, or lower `fewest`"),
            );
        }
        if points.names.is_empty() && lost.is_empty() {
            definer.faults.push(
                Fault::new(
                    RECORDING,
                    stated.key.clone(),
                    format!(
                        "{}: nothing stays at one value long enough for a dwell",
                        recording.name
                    ),
                )
                .label("no dwells")
                .help("shorten `settle` or lower `fewest`; or state `tolerance`, how far apart the values of the stimulus in one dwell may be"),
            );
        }
        points
    };
    points.findings.splice(..0, findings);
    Some(points)
}

fn dwelling(
    definer: &mut Definer<'_>,
    names: &Names,
    recording: &Recording,
    table: &RecordingTable,
) -> Option<Dwelling> {
    let time = time(definer).map(str::to_owned);
    let unit = time
        .as_ref()
        .and_then(|role| recording.column(role))
        .and_then(|column| column.unit.clone())
        .unwrap_or_else(Unit::one);
    let mut in_time = |stated: &Option<Stated<gumption_format::toml::Amount>>| match stated {
        Some(amount) => definer.amount(amount, &unit).map(Some),
        None => Some(None),
    };
    let settle = in_time(&table.settle)?.unwrap_or(0.0);
    let dwell = in_time(&table.dwell)?;
    let fewest = table.fewest.as_ref().map_or(2, |stated| stated.value);
    Some(Dwelling {
        by: dwells_by(names, table),
        time,
        settling: Settling {
            settle,
            dwell,
            fewest: usize::try_from(fewest).unwrap_or(usize::MAX).max(2),
        },
    })
}

/// Labels before steps, and these before rest.
fn dwells_by(names: &Names, table: &RecordingTable) -> DwellsBy {
    match (&table.dwells, &table.steps, &table.still) {
        (None, Some(stimulus), _) => DwellsBy::Steps {
            stimulus: stimulus.value.clone(),
            tolerance: table.tolerance.as_ref().map(|stated| stated.value),
        },
        (None, None, Some(rows)) => DwellsBy::Rest {
            outputs: names.columns.iter().map(|(role, _)| role.clone()).collect(),
            rows: usize::try_from(rows.value).unwrap_or(usize::MAX),
        },
        (labels, ..) => {
            let labels = labels.iter().flat_map(|list| texts(&list.value.0));
            DwellsBy::Labels(labels.map(str::to_owned).collect())
        }
    }
}

impl RecordingTable {
    /// Whether something tells dwells apart.
    fn tells_dwells(&self) -> bool {
        self.dwells.is_some() || self.steps.is_some() || self.still.is_some()
    }

    /// Whether its rows are samples.
    fn holds_samples(&self) -> bool {
        let average = self.average.as_ref().map(|stated| stated.value);
        average != Some(AverageEntry::Nothing) && self.tells_dwells()
    }
}

/// More rows than these are hardly averages that somebody has forgotten to call so.
const MANY: usize = 100;

/// What is doubtful in the recording.
fn findings(
    definer: &Definer<'_>,
    names: &Names,
    recording: &Recording,
    table: &RecordingTable,
) -> Vec<Finding> {
    let mut outputs: Vec<&str> = names.responses.iter().map(String::as_str).collect();
    let ranges: Vec<(&str, [f64; 2])> = entries(&definer.source.table.columns)
        .iter()
        .filter_map(
            |(role, entry)| match entry.value.0.range.as_ref()?.value.as_slice() {
                [low, high] => Some((role.as_str(), [low.value, high.value])),
                _ => None,
            },
        )
        .collect();
    let positions = definer.source.table.positions.as_ref();
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
            time: time(definer),
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
