//! From the text of a calibration file to its tables, with those of its procedure below them.

use std::collections::HashSet;

use super::entries::Short;
use super::faults::NO_PROCEDURE;
use super::hints::HINTS;
use super::procedure::{PROCEDURES, procedure_named};
use super::tables::ExperimentTable;
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Named;
use gumption_format::toml::tables_of;
use gumption_format::toml::{Slot, Stated, Table};
use gumption_gum::budget::faults::UNUSED;
use smol_str::SmolStr;

/// The tables of a file over those of its procedure.
pub(crate) struct Source {
    /// The text of the file, and behind it that of the procedure: places refer to this.
    pub text: String,
    /// Length of the user's part.
    pub own: usize,
    pub table: ExperimentTable,
    /// Names that the file itself lists as parameters and as inputs, before those of the procedure.
    pub listed: Listed,
    /// The procedure's name and its place.
    pub procedure: Slot<String>,
    pub faults: Vec<Fault>,
}

/// Names by their tables.
#[derive(Debug, Clone, Default)]
pub(crate) struct Listed {
    pub parameters: HashSet<String>,
    pub inputs: HashSet<String>,
}

/// Reads a file and the procedure that it names.
pub(crate) fn read(text: &str) -> Result<Source, Vec<Fault>> {
    let (own, mut faults) = tables_of::<ExperimentTable>(text, "an experiment", &HINTS, UNUSED)?;
    let listed = Listed {
        parameters: names(&own.parameter),
        inputs: names(&own.input),
    };
    let procedure = own.procedure.clone();
    let below = match &procedure {
        Some(stated) => procedure_named(&stated.value)
            .map(|found| found.text)
            .or_else(|| {
                faults.push(no_procedure(stated));
                None
            }),
        None => None,
    };
    let Some(below) = below else {
        return Ok(Source {
            text: text.to_owned(),
            own: text.len(),
            table: own,
            listed,
            procedure,
            faults,
        });
    };
    // Places in the procedure follow those in the file.
    let padded = format!("{}\n{below}", " ".repeat(text.len()));
    let (base, wrong) = tables_of::<ExperimentTable>(&padded, "a procedure", &HINTS, UNUSED)?;
    faults.extend(wrong);
    Ok(Source {
        text: format!("{text}\n{below}"),
        own: text.len(),
        table: merged(own, base, &listed),
        listed,
        procedure,
        faults,
    })
}

/// The named entries of an optional table.
pub(crate) fn entries<T>(named: &Slot<Named<T>>) -> &[(SmolStr, Stated<T>)] {
    named.as_ref().map_or(&[], |stated| &stated.value.entries)
}

fn names<T>(named: &Slot<Named<T>>) -> HashSet<String> {
    let entries = named.iter().flat_map(|stated| &stated.value.entries);
    entries.map(|(name, _)| name.to_string()).collect()
}

fn no_procedure(stated: &Stated<String>) -> Fault {
    let known = || PROCEDURES.iter().map(|procedure| procedure.name);
    let fault = Fault::new(
        NO_PROCEDURE,
        stated.span.clone(),
        say!("there is no procedure \"{}\"", stated.value),
    )
    .label(say!("not in the library"));
    match nearest(&stated.value, known()) {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault.help(say!(
            "the procedures are {}; without one, state `equations`",
            known().collect::<Vec<_>>().join(", ")
        )),
    }
}

/// The file's tables over those of the procedure, entry by entry and key by key.
fn merged(mut own: ExperimentTable, base: ExperimentTable, listed: &Listed) -> ExperimentTable {
    in_both_languages(&mut own);
    change_places(&mut own, &base);
    let moved = |own: &HashSet<String>, other: &HashSet<String>, name: &str| {
        other.contains(name) && !own.contains(name)
    };
    let (mut parameter, mut input) = (base.parameter.clone(), base.input.clone());
    // What the file knows is not estimated, what it estimates is not known.
    if let Some(stated) = &mut parameter {
        let keep = |name: &str| !moved(&listed.parameters, &listed.inputs, name);
        stated.value.entries.retain(|(name, _)| keep(name));
    }
    if let Some(stated) = &mut input {
        let keep = |name: &str| !moved(&listed.inputs, &listed.parameters, name);
        stated.value.entries.retain(|(name, _)| keep(name));
    }
    ExperimentTable {
        columns: entries_over(own.columns.clone(), base.columns.clone()),
        parameter: entries_over(own.parameter.clone(), parameter),
        input: entries_over(own.input.clone(), input),
        reading: entries_over(own.reading.clone(), base.reading.clone()),
        source: entries_over(own.source.clone(), base.source.clone()),
        result: entries_over(own.result.clone(), base.result.clone()),
        omitted: entries_over(own.omitted.clone(), base.omitted.clone()),
        positions: over(own.positions.clone(), base.positions.clone()),
        noise: over(own.noise.clone(), base.noise.clone()),
        recording: over(own.recording.clone(), base.recording.clone()),
        constant: named_or(own.constant.clone(), base.constant.clone()),
        unit: named_or(own.unit.clone(), base.unit.clone()),
        ..own.over(base)
    }
}

/// What the file says in one language only takes the place of what the procedure says in either.
fn in_both_languages(own: &mut ExperimentTable) {
    fill(&mut own.title_zh, &own.title);
    fill(&mut own.description_zh, &own.description);
    for (_, entry) in entries_mut(&mut own.parameter) {
        fill(&mut entry.value.description_zh, &entry.value.description);
    }
    for (_, entry) in entries_mut(&mut own.input) {
        fill(
            &mut entry.value.description_zh,
            &entry.value.input.description,
        );
    }
}

/// What the procedure says of an input holds of the parameter that the file makes of it, and the other way
/// round: its unit and what it is.
fn change_places(own: &mut ExperimentTable, base: &ExperimentTable) {
    let known = names(&own.input);
    let (inputs, parameters) = (entries(&base.input), entries(&base.parameter));
    for (name, entry) in entries_mut(&mut own.parameter) {
        if let Some(below) = of_name(inputs, name) {
            let (table, below) = (&mut entry.value, &below.value);
            let texts = [
                (&mut table.description, &below.input.description),
                (&mut table.description_zh, &below.description_zh),
            ];
            texts.into_iter().for_each(|(own, below)| fill(own, below));
            // A value that is known besides brings its own unit.
            if !known.contains(name.as_str()) && table.unit.is_none() && table.like.is_none() {
                fill(&mut table.unit, &below.input.unit);
                fill(&mut table.like, &below.like);
            }
        }
    }
    for (name, entry) in entries_mut(&mut own.input) {
        if let Some(below) = of_name(parameters, name) {
            let (table, below) = (&mut entry.value, &below.value);
            let texts = [
                (&mut table.input.description, &below.description),
                (&mut table.description_zh, &below.description_zh),
            ];
            texts.into_iter().for_each(|(own, below)| fill(own, below));
            if table.input.unit.is_none() && table.like.is_none() {
                fill(&mut table.input.unit, &below.unit);
                fill(&mut table.like, &below.like);
            }
        }
    }
}

fn fill<T: Clone>(own: &mut Option<T>, below: &Option<T>) {
    if own.is_none() {
        own.clone_from(below);
    }
}

fn of_name<'t, T>(entries: &'t [(SmolStr, Stated<T>)], name: &str) -> Option<&'t Stated<T>> {
    let found = entries.iter().find(|(other, _)| other == name);
    found.map(|(_, entry)| entry)
}

fn entries_mut<T>(named: &mut Slot<Named<T>>) -> &mut [(SmolStr, Stated<T>)] {
    named
        .as_mut()
        .map_or(&mut [], |stated| stated.value.entries.as_mut_slice())
}

/// What stands above what a procedure states.
trait Over {
    /// What this states, and where it states nothing, what `below` states.
    fn laid_over(self, below: Self) -> Self;
}

impl<T: Table> Over for T {
    fn laid_over(self, below: Self) -> Self {
        self.over(below)
    }
}

impl<T: Table> Over for Short<T> {
    fn laid_over(self, below: Self) -> Self {
        Short(self.0.over(below.0))
    }
}

/// What either states, or what both state joined.
fn both<T>(own: Option<T>, base: Option<T>, join: impl FnOnce(T, T) -> T) -> Option<T> {
    match (own, base) {
        (Some(own), Some(base)) => Some(join(own, base)),
        (own, base) => own.or(base),
    }
}

fn over<T: Over>(own: Slot<T>, base: Slot<T>) -> Slot<T> {
    both(own, base, |own, base| Box::new(stated_over(*own, *base)))
}

fn stated_over<T: Over>(own: Stated<T>, base: Stated<T>) -> Stated<T> {
    Stated {
        value: own.value.laid_over(base.value),
        span: own.span,
        key: own.key,
    }
}

/// Entries of the procedure first, in its order, each under what the file says of it.
fn entries_over<T: Over>(own: Slot<Named<T>>, base: Slot<Named<T>>) -> Slot<Named<T>> {
    both(own, base, |mut own, base| {
        let mut entries = Vec::new();
        for (name, below) in base.value.entries {
            let mut places = own.value.entries.iter();
            let at = places.position(|(other, _)| *other == name);
            let entry = match at.map(|at| own.value.entries.remove(at).1) {
                Some(above) => stated_over(above, below),
                None => below,
            };
            entries.push((name, entry));
        }
        entries.append(&mut own.value.entries);
        own.value.entries = entries;
        own
    })
}

/// Entries of both; one of the file replaces that of the procedure as a whole.
fn named_or<T>(own: Slot<Named<T>>, base: Slot<Named<T>>) -> Slot<Named<T>> {
    both(own, base, |mut own, base| {
        for (name, entry) in base.value.entries {
            if !own.value.entries.iter().any(|(other, _)| *other == name) {
                own.value.entries.push((name, entry));
            }
        }
        own
    })
}

impl Source {
    /// Whether a place is in the procedure's part.
    pub fn is_base(&self, place: &std::ops::Range<usize>) -> bool {
        place.start > self.own
    }

    /// A fault inside the procedure's text, at the place of the procedure's name.
    pub fn in_own_text(&self, mut fault: Fault) -> Fault {
        let own = |span: &std::ops::Range<usize>| span.start <= self.own;
        fault.related.retain(|(span, _)| own(span));
        let Some(procedure) = self.procedure.as_ref().filter(|_| !own(&fault.span)) else {
            return fault;
        };
        let line = self.text[..fault.span.start]
            .rfind('\n')
            .map_or(0, |at| at + 1);
        let said = self.text[line..].lines().next().unwrap_or_default().trim();
        // One of a list of equations.
        let entry = said.trim_end_matches(',').strip_prefix('"');
        let said = entry
            .and_then(|entry| entry.strip_suffix('"'))
            .unwrap_or(said);
        fault.message = say!(
            "{}, in the procedure {}: {said}",
            fault.message,
            procedure.value
        );
        fault.span = procedure.span.clone();
        fault
    }
}
