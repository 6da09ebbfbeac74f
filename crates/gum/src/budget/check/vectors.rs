//! Vector inputs: one error for each element, or one that all share.

use super::amounts::Share;
use super::checker::Checker;
use super::draft::{Context, Draft, Location, show};
use super::inputs::{Entry, Piece, single};
use super::register::{Register, element_name};
use super::type_a::two_turns;
use super::ways::Way;
use crate::budget::Owner;
use crate::budget::faults::VECTOR;
use crate::budget::tables::{ComponentTable, InputTable};
use crate::budget::variants::{Amounts, Numbers};
use gumption_core::quantity::{Unit, show_apart};
use gumption_core::statistics::Series;
use gumption_fault::{Fault, say};
use gumption_format::toml::{Slot, Stated};

/// Elements of a vector. More of them would keep the Monte Carlo method busy for hours.
const MOST_ELEMENTS: usize = 10_000;

/// Elements that are drawn together for their common ν; the effort grows with their square.
const LARGEST_FAMILY: usize = 200;

/// A vector input while its components are entered.
struct Vector<'v> {
    name: &'v str,
    unit: &'v Unit,
    values: &'v [f64],
    /// Place of its first element among the inputs.
    start: usize,
    /// Whether it has one component only.
    alone: bool,
    /// Labels of the components so far.
    labels: Vec<String>,
}

impl<'v> Vector<'v> {
    fn context(&self, entry: &Entry<'_>, element: usize) -> Context<'v> {
        Context::new(
            self.name,
            Some(self.values[element]),
            self.unit,
            entry.place.clone(),
        )
    }
}

impl Checker<'_> {
    pub(super) fn vector(
        &mut self,
        name: &str,
        stated: &Stated<InputTable>,
        unit: &Unit,
        values: &[f64],
        register: &mut Register,
        start: usize,
    ) -> Option<()> {
        let table = &stated.value;
        if let (Some(value), Some(values)) = (&table.value, &table.values) {
            return self.refuse(
                Fault::new(
                    VECTOR,
                    values.key.clone(),
                    say!("{name} has `value` and `values`"),
                )
                .label(say!("values of a vector"))
                .related(value.key.clone(), say!("value of a scalar"))
                .help(say!("leave out one")),
            );
        }
        if values.is_empty() {
            let place = table
                .values
                .as_ref()
                .map_or(stated.span.clone(), |values| values.span.clone());
            return self.refuse(
                Fault::new(VECTOR, place, say!("{name} has no values"))
                    .label(say!("an empty vector")),
            );
        }
        if values.len() > MOST_ELEMENTS {
            let place = table
                .values
                .as_ref()
                .map_or(stated.span.clone(), |values| values.key.clone());
            return self.refuse(
                Fault::new(VECTOR, place, say!("{name} has {} values", values.len()))
                    .label(say!("expected {MOST_ELEMENTS} at most"))
                    .help(say!("each element is an input of its own; repeated readings of one quantity are `readings`")),
            );
        }
        if let Some([first, other, beside]) = two_turns(values, unit) {
            let (first, other, beside) = (show(first), show(other), show(beside));
            let unit = &unit.symbol;
            self.remark(say!("{name}: {first} {unit} and {other} {unit} lie beside each other on the circle, but a sum, a mean or a line takes the way around. If the model has one, write {beside} in place of {other}."));
        }
        let list = self.entries_of(name, stated, unit, register)?;
        for (place, value) in (start..).zip(values) {
            if let Some(input) = register.inputs.get_mut(place) {
                input.estimate = *value;
            }
        }
        let mut vector = Vector {
            name,
            unit,
            values,
            start,
            alone: list.len() == 1,
            labels: Vec::new(),
        };
        let mut complete = true;
        for entry in &list {
            let done = self.vector_component(&mut vector, entry, register);
            complete &= done.is_some();
        }
        complete.then_some(())
    }

    fn vector_component(
        &mut self,
        vector: &mut Vector<'_>,
        entry: &Entry<'_>,
        register: &mut Register,
    ) -> Option<()> {
        if entry.way == Way::Source {
            return self.source_of_vector(vector, entry, register);
        }
        if states_one_estimate(entry) {
            return self.refuse(one_estimate(vector.name, entry));
        }
        let listed = self.with_columns(entry.table, vector.unit);
        let entry = &Entry {
            table: listed.as_ref().unwrap_or(entry.table),
            way: entry.way,
            place: entry.place.clone(),
        };
        self.one_for_each(vector.name, entry.table, vector.values.len())?;
        let family = self.elements(vector, entry, register)?;
        if of_element(entry.table, 0).is_none() && entry.way != Way::Distribution {
            self.family(vector.name, family, register);
        }
        Some(())
    }

    /// A cause that other inputs share, for each element.
    fn source_of_vector(
        &mut self,
        vector: &Vector<'_>,
        entry: &Entry<'_>,
        register: &mut Register,
    ) -> Option<()> {
        for element in 0..vector.values.len() {
            let context = vector.context(entry, element);
            for piece in self.shared_pieces(entry, &context, register)? {
                if let Piece::Shared {
                    component,
                    coefficient,
                    follows,
                } = piece
                {
                    let place = vector.start + element;
                    register.follow(place, component, coefficient, follows);
                    register.act(place, component, coefficient);
                }
            }
        }
        Some(())
    }

    /// Enters a component of every element, or the one that all share. Gives those that have one ν together.
    fn elements(
        &mut self,
        vector: &mut Vector<'_>,
        entry: &Entry<'_>,
        register: &mut Register,
    ) -> Option<Vec<usize>> {
        let relative = self.acts_in_proportion(entry, vector.unit);
        let common = is_common(entry.table);
        let mut first: Option<(usize, f64)> = None;
        let mut label = None;
        let mut family = Vec::new();
        for (element, value) in vector.values.iter().enumerate() {
            // A fraction of zero is zero: this element has no such doubt.
            if relative && *value == 0.0 {
                continue;
            }
            let mut draft = self.element_draft(vector, entry, element)?;
            let label = label.get_or_insert_with(|| another(&mut vector.labels, &draft.label));
            draft.label = label.as_str().into();
            let sign = if relative { value.signum() } else { 1.0 };
            let (follows, dof, u) = (draft.follows, draft.dof, draft.u);
            let (component, coefficient) = match first {
                Some((component, first)) if common => (component, sign * (u / first)),
                _ => {
                    let component = self.enter_element(vector, entry, element, draft, register);
                    if !common && dof.is_finite() {
                        family.push(component);
                    }
                    first = Some((component, u * sign));
                    (component, 1.0)
                }
            };
            register.follow(vector.start + element, component, coefficient, follows);
            register.act(vector.start + element, component, coefficient);
        }
        Some(family)
    }

    /// What the component says about one element.
    fn element_draft(
        &mut self,
        vector: &Vector<'_>,
        entry: &Entry<'_>,
        element: usize,
    ) -> Option<Box<Draft>> {
        let context = vector.context(entry, element);
        let draft = match of_element(entry.table, element) {
            Some(table) => self.draft_following(&table, entry.way, &context)?,
            None => self.draft_following(entry.table, entry.way, &context)?,
        };
        if !matches!(draft.location, Location::None | Location::Mean(_)) {
            let message = say!("this component would move the elements of {}", vector.name);
            return self.refuse(
                Fault::new(VECTOR, entry.place.clone(), message)
                    .label(say!("only symmetric deviations for a vector")),
            );
        }
        self.other_mean(vector.name, element, vector.values[element], &draft);
        Some(draft)
    }

    /// Enters the component of an element, or of all of them.
    fn enter_element(
        &self,
        vector: &Vector<'_>,
        entry: &Entry<'_>,
        element: usize,
        draft: Box<Draft>,
        register: &mut Register,
    ) -> usize {
        let owner = if is_common(entry.table) {
            vector.name.into()
        } else {
            element_name(vector.name, element).into()
        };
        let place = Owner::Input(vector.start + element);
        let component = register.add(place, &owner, vector.unit, draft, vector.alone);
        if let Some(readings) = self.readings_of(entry.table, element) {
            register.readings.insert(component, readings);
        }
        component
    }

    /// Elements whose u comes from one statement share the doubt about it: they have one ν together.
    fn family(&mut self, name: &str, family: Vec<usize>, register: &mut Register) {
        match family.len() {
            0 | 1 => {}
            2..=LARGEST_FAMILY => register.families.push(family),
            count => self.remark(say!("{name}: ν is taken for each of the {count} elements by itself, although they share one u; more than {LARGEST_FAMILY} are not evaluated together.")),
        }
    }

    /// The readings of one element.
    fn readings_of(&self, table: &ComponentTable, element: usize) -> Option<Vec<f64>> {
        let Numbers::Lists(lists) = &table.readings.as_ref()?.value else {
            return None;
        };
        let list = lists.get(element)?;
        (table.pooled.is_none()).then(|| list.value.iter().map(|reading| reading.value).collect())
    }

    /// Remarks on a stated value that is not the mean of the element's readings.
    fn other_mean(&mut self, name: &str, element: usize, value: f64, draft: &Draft) {
        let Location::Mean(mean) = draft.location else {
            return;
        };
        if (mean - value).abs() <= 1e-9 * draft.u {
            return;
        }
        let name = element_name(name, element);
        let [value, mean] = show_apart(value, mean);
        self.remark(say!(
            "{name}: the stated value {value} is used; the mean of its readings is {mean}."
        ));
    }

    /// The means of an input that has no `values` but a list of readings for each element.
    pub(super) fn element_means(&mut self, table: &InputTable) -> Option<Vec<f64>> {
        if table.value.is_some() || table.present.iter().any(|(key, _)| *key == "values") {
            return None;
        }
        let components = table.components.as_ref().map(|list| &list.value);
        let inner = components.into_iter().flatten().map(|item| &item.value);
        let lists = inner
            .chain(std::iter::once(&table.component))
            .find_map(|component| match &component.readings.as_ref()?.value {
                Numbers::Lists(lists) => Some(lists),
                _ => None,
            })?;
        let means = lists.iter().map(|list| {
            let readings = self.exact(&list.value);
            Series::new(&readings).mean()
        });
        Some(means.collect())
    }

    /// Checks that lists for elements are as long as the vector.
    pub(super) fn one_for_each(
        &mut self,
        name: &str,
        table: &ComponentTable,
        length: usize,
    ) -> Option<()> {
        let amounts = |stated: &Slot<Amounts>| match stated.as_deref() {
            Some(Stated {
                value: Amounts::Each(list),
                span,
                ..
            }) => Some((list.len(), span.clone())),
            _ => None,
        };
        let readings = match table.readings.as_deref() {
            Some(Stated {
                value: Numbers::Lists(lists),
                span,
                ..
            }) => Some((lists.len(), span.clone())),
            _ => None,
        };
        for (key, found) in [
            ("u", amounts(&table.u)),
            ("half_width", amounts(&table.half_width)),
            ("readings", readings),
        ] {
            let Some((entries, span)) = found else {
                continue;
            };
            if entries != length {
                return self.refuse(
                    Fault::new(
                        VECTOR,
                        span,
                        say!("`{key}` has {entries} entries, {name} has {length} values"),
                    )
                    .label(say!("expected {length} entries"))
                    .help(say!("state one for each element, or a single one for all")),
                );
            }
        }
        Some(())
    }

    /// Whether the component is a fraction of the value alone.
    pub(super) fn acts_in_proportion(&mut self, entry: &Entry<'_>, unit: &Unit) -> bool {
        let table = entry.table;
        let stated = table.share() == Share::OfValue;
        let certificate = table
            .certificate
            .as_ref()
            .and_then(|certificate| certificate.value.U.as_deref());
        let stated_amount = table.u.as_ref().or(table.half_width.as_ref());
        let first = stated_amount.and_then(|amounts| Amounts::of_element(amounts, 0));
        let of_dimension_one = first
            .as_ref()
            .or(certificate)
            .and_then(|amount| amount.value.unit.as_ref())
            .and_then(|(text, _)| self.names.units.parse(text).ok())
            .is_some_and(|own| own.dimension == Unit::one().dimension);
        stated || (of_dimension_one && unit.dimension != Unit::one().dimension)
    }
}

/// Whether all elements share one error.
fn is_common(table: &ComponentTable) -> bool {
    table.common.as_ref().is_some_and(|stated| stated.value)
}

/// Whether the component would state one estimate for all elements.
fn states_one_estimate(entry: &Entry<'_>) -> bool {
    let listed = entry.table.readings.as_ref();
    let by_element = listed.is_some_and(|stated| matches!(stated.value, Numbers::Lists(_)));
    entry.way.locates() && !single(entry.table) && !by_element && entry.way != Way::Distribution
}

fn one_estimate(name: &str, entry: &Entry<'_>) -> Fault {
    let message = say!("this component would state one estimate for all elements of {name}");
    Fault::new(VECTOR, entry.place.clone(), message)
        .label(say!("not for a vector"))
        .help(say!("state a deviation (`u`, `half_width`, `step` …), or readings for each element: readings = [[…], […]]"))
}

/// The component as it stands for one element, if it lists an amount for each.
pub(super) fn of_element(table: &ComponentTable, element: usize) -> Option<ComponentTable> {
    let one = |stated: &Slot<Amounts>| {
        let amount = Amounts::of_element(stated.as_ref()?, element)?;
        Some(Box::new(amount.map(|amount| Amounts::One(amount.clone()))))
    };
    let listed = |stated: &Slot<Amounts>| {
        matches!(
            stated.as_deref(),
            Some(Stated {
                value: Amounts::Each(_),
                ..
            })
        )
    };
    let readings = |stated: &Slot<Numbers>| match stated.as_deref() {
        Some(Stated {
            value: Numbers::Lists(lists),
            ..
        }) => lists
            .get(element)
            .map(|list| Box::new(list.map(|list| Numbers::List(list.clone())))),
        _ => stated.clone(),
    };
    let by_readings = matches!(
        table.readings.as_deref(),
        Some(Stated {
            value: Numbers::Lists(_),
            ..
        })
    );
    (by_readings || listed(&table.u) || listed(&table.half_width)).then(|| ComponentTable {
        readings: readings(&table.readings),
        u: one(&table.u),
        half_width: one(&table.half_width),
        ..table.clone()
    })
}

/// A label that no other component of the vector has.
fn another(labels: &mut Vec<String>, label: &str) -> String {
    let same = labels
        .iter()
        .filter(|other| other.starts_with(label))
        .count();
    let label = if same == 0 {
        label.to_string()
    } else {
        format!("{label} {}", same + 1)
    };
    labels.push(label.clone());
    label
}
