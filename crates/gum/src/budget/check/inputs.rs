//! Inputs and shared sources: estimates, and the components that doubt them.

use std::ops::Range;

use super::amounts::Share;
use super::checker::Checker;
use super::draft::{Context, Draft, Drafts, Location, show};
use super::entries::entries;
use super::register::{InputEntry, Register, blank};
use super::type_a::all_equal;
use super::ways::{Way, expectation};
use crate::budget::faults::{LIMITS, NAME_TWICE, NO_DOUBT, NO_ESTIMATE, TWO_ESTIMATES, TWO_WAYS};
use crate::budget::tables::{ComponentTable, FileTable, InputTable, ResolutionWord};
use crate::budget::variants::ReadingsOf;
use crate::budget::{Follows, Owner};
use gumption_core::quantity::{Unit, show_apart};
use gumption_fault::{Fault, say};
use gumption_format::toml::{Slot, Stated};
use smallvec::{SmallVec, smallvec};
use smol_str::{SmolStr, format_smolstr};

/// A reason for doubt of one input.
pub(super) enum Piece {
    Own(Box<Draft>),
    Shared {
        component: usize,
        coefficient: f64,
        follows: Option<Follows>,
    },
}

/// The reasons for doubt of an input, mostly one.
pub(super) type Pieces = SmallVec<[Piece; 1]>;

/// A component of the file, and the way it is stated.
pub(super) struct Entry<'f> {
    pub table: &'f ComponentTable,
    pub way: Way,
    pub place: Range<usize>,
}

/// The components of an input or source, mostly one.
pub(super) type Entries<'f> = SmallVec<[Entry<'f>; 1]>;

impl Checker<'_> {
    /// Reads `[input.X]`.
    pub(super) fn inputs(
        &mut self,
        file: &FileTable,
        resolution: ResolutionWord,
        register: &mut Register,
    ) {
        let inputs = entries(&file.input);
        register.inputs.reserve(inputs.len());
        register.components.reserve(inputs.len());
        register.entries.reserve(inputs.len());
        for (name, stated) in inputs {
            let table = &stated.value;
            if let Some(from) = &table.from {
                self.taken(name, stated, from, register);
                continue;
            }
            // A misspelt or unreadable `unit` must not be judged as dimension one.
            let hidden = table.unknown || table.present.iter().any(|(key, _)| *key == "unit");
            let unit = match &table.unit {
                None if hidden => None,
                stated => self.unit_or_of_value(stated, &table.value),
            };
            let start = register.inputs.len();
            let values = table
                .values
                .as_ref()
                .map(|list| list.value.iter().map(|value| value.value).collect());
            let values: Option<Vec<f64>> = values.or_else(|| self.element_means(table));
            let vector = values.is_some();
            let count = values.as_ref().map_or(1, Vec::len);
            for element in 0..count {
                register.inputs.push(blank(
                    name,
                    table,
                    unit.as_ref(),
                    values.as_ref().map(|_| element),
                ));
            }
            let filled = match (&unit, values) {
                (Some(unit), Some(values)) => {
                    self.vector(name, stated, unit, &values, register, start)
                }
                (Some(unit), None) => self.scalar(name, stated, unit, resolution, register, start),
                (None, _) => None,
            };
            register.incomplete |= filled.is_none();
            // What was refused may have held the unit: formulas are not judged by dimension one.
            let silent = table.unit.is_none() && (table.refused || table.component.refused);
            register.entries.push(InputEntry {
                name: name.clone(),
                place: stated.key.clone(),
                places: start..start + count,
                vector,
                unit: unit.filter(|_| !silent),
                formula: None,
            });
        }
    }

    /// The components of an input or source with their ways; all faults are reported.
    pub(super) fn ways<'f>(
        &mut self,
        name: &str,
        list: &'f Slot<Vec<Stated<ComponentTable>>>,
        direct: &'f ComponentTable,
        place: &Range<usize>,
        unit: &Unit,
    ) -> Option<Entries<'f>> {
        if let (Some(list), Some((key, span))) = (list, direct.present.first()) {
            return self.refuse(
                Fault::new(
                    TWO_WAYS,
                    span.clone(),
                    say!("{name} has `components` and the key `{key}` beside them"),
                )
                .label(say!("not inside a component"))
                .related(list.key.clone(), say!("the components of the input"))
                .help(match *key {
                    "name" => {
                        say!("{name} is named by its heading; what it is stands in `description`")
                    }
                    key => say!("move `{key}` into one of the `components`"),
                }),
            );
        }
        let listed = list.as_ref().map_or(&[][..], |list| &list.value);
        let alone = list.as_ref().map_or(place, |list| &list.span);
        let alone = listed.is_empty().then_some((direct, alone));
        let listed = listed.iter().map(|item| (&item.value, &item.span));
        let mut entries = Entries::new();
        let mut complete = true;
        for (table, place) in alone.into_iter().chain(listed) {
            let context = Context::new(name, None, unit, place.clone());
            match self.way(table, &context) {
                Some(way) => entries.push(Entry {
                    table,
                    way,
                    place: place.clone(),
                }),
                None => complete = false,
            }
        }
        complete.then_some(entries)
    }

    pub(super) fn entries_of<'f>(
        &mut self,
        name: &str,
        stated: &'f Stated<InputTable>,
        unit: &Unit,
        register: &Register,
    ) -> Option<Entries<'f>> {
        let table = &stated.value;
        let bare = table.components.is_none() && table.component.present.is_empty();
        if register.by_matrix.iter().any(|by_matrix| by_matrix == name) {
            if bare {
                return Some(Entries::new());
            }
            // A list of components adds other reasons for doubt; a bare u states the same one again.
            if let Some((key, span)) = table.component.present.first() {
                return self.refuse(
                    Fault::new(
                        TWO_WAYS,
                        span.clone(),
                        say!("the uncertainty of {name} is stated twice, by `{key}` and by the `covariance` of a [[joint]]"),
                    )
                    .label(say!("the covariance matrix states it already"))
                    .help(say!(
                        "leave out `{key}`; if it is another reason for doubt, write components = [{{ name = \"…\", {key} = … }}]"
                    )),
                );
            }
        }
        // What stood in the place of the value, as in `1.0 ± 0.1`, or of the joint statement may have stated it.
        let meant = table.refused || register.by_refused.iter().any(|joint| joint == name);
        if bare && meant {
            return None;
        }
        // The list itself was refused; what is in it is unknown.
        if bare && table.refused && table.present.iter().any(|(key, _)| *key == "components") {
            return None;
        }
        if let (true, Some(values)) = (bare, &table.values) {
            return self.refuse(values_without_doubt(name, values.key.clone()));
        }
        self.ways(
            name,
            &table.components,
            &table.component,
            &stated.span,
            unit,
        )
    }

    fn scalar(
        &mut self,
        name: &SmolStr,
        stated: &Stated<InputTable>,
        unit: &Unit,
        resolution: ResolutionWord,
        register: &mut Register,
        place: usize,
    ) -> Option<()> {
        let table = &stated.value;
        let list = self.entries_of(name, stated, unit, register)?;
        let value = match &table.value {
            Some(value) => Some(self.quantity(value, unit, name)?),
            None => None,
        };
        let base = match value {
            Some(value) => value,
            None => self.estimate(name, stated, &list, unit)?,
        };
        let mut pieces = Pieces::new();
        let mut complete = true;
        for entry in &list {
            let context = Context::new(name, Some(base), unit, entry.place.clone());
            match self.piece(entry, &context, &list, register) {
                Some(found) => pieces.extend(found),
                None => complete = false,
            }
        }
        if !complete {
            return None;
        }
        let mut estimate = base;
        for piece in &pieces {
            if let Piece::Own(draft) = piece {
                estimate += self.shift(name, draft, value, &table.value)?;
            }
        }
        if let Some(input) = register.inputs.get_mut(place) {
            input.estimate = estimate;
        }
        self.enter(name, pieces, unit, resolution, register, place);
        Some(())
    }

    /// The estimate of an input that states no value.
    fn estimate(
        &mut self,
        name: &str,
        stated: &Stated<InputTable>,
        list: &[Entry<'_>],
        unit: &Unit,
    ) -> Option<f64> {
        if stated.value.present.iter().any(|(key, _)| *key == "value") {
            return None;
        }
        let mut found: Vec<(f64, Range<usize>)> = Vec::new();
        for entry in list
            .iter()
            .filter(|entry| entry.way.locates() && !single(entry.table))
        {
            let context = Context::new(name, None, unit, entry.place.clone());
            if let Some(mean) = self.constant_readings(entry, unit, list) {
                found.push((mean, entry.place.clone()));
                continue;
            }
            let location = self.draft(entry.table, entry.way, &context)?.location;
            found.extend(expectation(location).map(|mean| (mean, entry.place.clone())));
        }
        if found.is_empty() {
            // Readings that tell the scatter of a single one still tell where the quantity is.
            let of_readings = [Way::Readings, Way::Groups, Way::GroupSummary];
            for entry in list.iter().filter(|entry| of_readings.contains(&entry.way)) {
                let context = Context::new(name, None, unit, entry.place.clone());
                let mean = self.mean_of_readings(entry.table, entry.way, &context)?;
                found.push((mean, entry.place.clone()));
            }
        }
        match found.as_slice() {
            [(mean, _)] => Some(*mean),
            [] => self.refuse(
                Fault::new(NO_ESTIMATE, stated.span.clone(), say!("{name} has no value"))
                    .label(say!("`value` is missing"))
                    .help(say!("add `value`, in {}; readings or a distribution with a stated location would do too", unit.symbol)),
            ),
            [(_, first), (_, second), ..] => self.refuse(
                Fault::new(TWO_ESTIMATES, second.clone(), say!("two components of {name} state where it is"))
                    .label(say!("second estimate"))
                    .related(first.clone(), say!("first estimate"))
                    .help(say!("add `value`: the estimate that is reported")),
            ),
        }
    }

    /// The mean of readings, whatever they are evaluated for.
    fn mean_of_readings(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
    ) -> Option<f64> {
        let of_mean = ComponentTable {
            of: None,
            ..table.clone()
        };
        let location = self.draft(&of_mean, way, context)?.location;
        expectation(location)
    }

    /// The common value of readings that do not scatter beside a stated resolution: their scatter is
    /// below it and left to it.
    fn constant_readings(
        &mut self,
        entry: &Entry<'_>,
        unit: &Unit,
        list: &[Entry<'_>],
    ) -> Option<f64> {
        let readings = entry
            .table
            .readings
            .as_ref()
            .filter(|_| entry.table.pooled.is_none())?;
        if !list
            .iter()
            .any(|other| matches!(other.way, Way::Step | Way::Bits))
        {
            return None;
        }
        let numbers = self.numbers(readings, Some(unit))?;
        (numbers.len() > 1 && all_equal(&numbers)).then(|| numbers[0])
    }

    fn piece(
        &mut self,
        entry: &Entry<'_>,
        context: &Context<'_>,
        list: &[Entry<'_>],
        register: &mut Register,
    ) -> Option<Pieces> {
        if entry.way == Way::Source {
            if entry.table.share() == Share::OfValue && context.value() == Some(0.0) {
                let owner = context.owner;
                self.remark(say!("A relative error of {owner}, whose value is 0, is nothing. State how the source acts by its `sensitivity`, without `relative`."));
            }
            return self.shared_pieces(entry, context, register);
        }
        if let Some(value) = self.constant_readings(entry, context.unit, list) {
            let owner = context.owner;
            self.remark(say!("{owner}: all readings are {value}; their scatter is below the resolution and left to it."));
            return Some(Pieces::new());
        }
        let mut draft = self.draft_following(entry.table, entry.way, context)?;
        draft.readings = match &entry.table.readings {
            Some(readings) if entry.table.pooled.is_none() => {
                self.numbers(readings, Some(context.unit))
            }
            _ => None,
        };
        Some(smallvec![Piece::Own(draft)])
    }

    /// How far a component moves the estimate, with a remark when it does.
    fn shift(
        &mut self,
        name: &str,
        draft: &Draft,
        value: Option<f64>,
        stated: &Slot<gumption_format::toml::Amount>,
    ) -> Option<f64> {
        let place = stated
            .as_ref()
            .map_or(draft.place.clone(), |stated| stated.span.clone());
        let (old, new) = match (draft.location, value) {
            (Location::Shift(shift), _) if shift != 0.0 => {
                let old = value.unwrap_or(0.0);
                (old, old + shift)
            }
            (Location::Mean(mean), Some(value)) if (mean - value).abs() > 1e-9 * draft.u => {
                let [value, mean] = show_apart(value, mean);
                self.remark(say!(
                    "{name}: the stated value {value} is used; the mean of its readings is {mean}."
                ));
                return Some(0.0);
            }
            (Location::Between { lower, upper, .. }, Some(value))
                if !(lower..=upper).contains(&value) =>
            {
                return self.refuse(
                    Fault::new(LIMITS, draft.stated.clone(), say!("the limits {lower} and {upper} do not contain the value of {name}, {value}"))
                        .label(say!("limits of the quantity itself"))
                        .related(place, say!("the value"))
                        .help(say!("for limits of a deviation write `half_width`, or `plus` and `minus`")),
                );
            }
            (Location::Between { expectation, .. }, Some(value))
                if (expectation - value).abs() > 1e-9 * draft.u =>
            {
                (value, expectation)
            }
            (Location::Expectation(mean), Some(value)) if (mean - value).abs() > 1e-9 * draft.u => {
                return self.refuse(
                    Fault::new(TWO_ESTIMATES, place, say!("the value of {name} is {value}, the expectation of its distribution {}", show(mean)))
                        .label(say!("another estimate than that of the distribution"))
                        .related(draft.stated.clone(), say!("expectation {}", show(mean)))
                        .help(say!("leave out `value`, or make the deviation an input of its own in the model")),
                );
            }
            _ => return Some(0.0),
        };
        self.remark(say!("{name}: the estimate moves from {} to {}, the expectation between asymmetric limits (GUM 4.3.8).", show(old), show(new)));
        Some(new - old)
    }

    /// Enters the components of a scalar input.
    fn enter(
        &mut self,
        name: &SmolStr,
        pieces: Pieces,
        unit: &Unit,
        resolution: ResolutionWord,
        register: &mut Register,
        place: usize,
    ) {
        let alone = pieces.len() == 1;
        let mut drafts = Drafts::new();
        for piece in pieces {
            match piece {
                Piece::Own(draft) => drafts.push(draft),
                Piece::Shared {
                    component,
                    coefficient,
                    follows,
                } => {
                    register.follow(place, component, coefficient, follows);
                    register.act(place, component, coefficient);
                }
            }
        }
        self.label_uniquely(name, &mut drafts);
        for mut draft in self.absorb(name, unit, drafts, resolution) {
            let (follows, readings) = (draft.follows, draft.readings.take());
            let component = register.add(Owner::Input(place), name, unit, draft, alone);
            register.follow(place, component, 1.0, follows);
            register.act(place, component, 1.0);
            if let Some(readings) = readings {
                register.readings.insert(component, readings);
            }
        }
    }

    /// Gives components without a name different labels; reports names that are stated twice.
    pub(super) fn label_uniquely(&mut self, owner: &str, drafts: &mut [Box<Draft>]) {
        for index in 1..drafts.len() {
            let (before, rest) = drafts.split_at_mut(index);
            let Some(draft) = rest.first_mut() else {
                continue;
            };
            let Some(first) = before.iter().find(|other| other.label == draft.label) else {
                continue;
            };
            if let (Some(name), Some(earlier)) = (&draft.named, &first.named) {
                self.report(
                    Fault::new(
                        NAME_TWICE,
                        name.clone(),
                        say!("two components of {owner} are called \"{}\"", draft.label),
                    )
                    .label(say!("second one"))
                    .related(earlier.clone(), say!("first one"))
                    .help(say!("give each component a name of its own")),
                );
            }
            let same = before
                .iter()
                .filter(|other| other.label.starts_with(draft.label.as_str()))
                .count();
            draft.label = format_smolstr!("{} {}", draft.label, same + 1);
        }
    }
}

/// Whether readings only say how the value scatters.
pub(super) fn single(table: &ComponentTable) -> bool {
    table
        .of
        .as_ref()
        .is_some_and(|of| of.value != ReadingsOf::Mean)
}

/// A vector without uncertainties is mostly a list of readings.
fn values_without_doubt(name: &str, place: Range<usize>) -> Fault {
    Fault::new(NO_DOUBT, place, say!("{name} has no uncertainty"))
        .label(say!("the elements of a vector"))
        .help(say!(
            "repeated readings of one quantity are `readings = […]`; the elements of a vector need `u`, `half_width` … beside them"
        ))
}
