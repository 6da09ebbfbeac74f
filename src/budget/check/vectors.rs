//! Vector inputs: one error for each element, or one that all share.

use super::Checker;
use super::draft::{Context, Draft, Location, show};
use super::inputs::{Entry, Piece, element_name, single};
use super::register::Register;
use super::ways::{Way, locates};
use crate::budget::Owner;
use crate::budget::faults::VECTOR;
use crate::budget::table::Stated;
use crate::budget::tables::{ComponentTable, InputTable};
use crate::budget::variants::{Amounts, Numbers};
use crate::fault::Fault;
use crate::quantity::Unit;
use crate::statistics::Series;

/// Elements of a vector. More of them would keep the Monte Carlo method busy for hours.
const MOST_ELEMENTS: usize = 10_000;

/// Elements that are drawn together for their common ν; the effort grows with their square.
const LARGEST_FAMILY: usize = 200;

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
                    format!("{name} has `value` and `values`"),
                )
                .label("values of a vector")
                .related(value.key.clone(), "value of a scalar")
                .help("leave out one"),
            );
        }
        if values.is_empty() {
            let place = table
                .values
                .as_ref()
                .map_or(stated.span.clone(), |values| values.span.clone());
            return self.refuse(
                Fault::new(VECTOR, place, format!("{name} has no values")).label("an empty vector"),
            );
        }
        if values.len() > MOST_ELEMENTS {
            let place = table
                .values
                .as_ref()
                .map_or(stated.span.clone(), |values| values.key.clone());
            return self.refuse(
                Fault::new(VECTOR, place, format!("{name} has {} values", values.len()))
                    .label(format!("expected {MOST_ELEMENTS} at most"))
                    .help("each element is an input of its own; repeated readings of one quantity are `readings`"),
            );
        }
        let list = self.entries_of(name, stated, unit, register)?;
        for (place, value) in (start..).zip(values) {
            if let Some(input) = register.inputs.get_mut(place) {
                input.estimate = *value;
            }
        }
        let alone = list.len() == 1;
        let mut complete = true;
        let mut labels: Vec<String> = Vec::new();
        for entry in &list {
            let done = self.vector_component(
                name,
                entry,
                unit,
                values,
                register,
                start,
                alone,
                &mut labels,
            );
            complete &= done.is_some();
        }
        complete.then_some(())
    }

    #[allow(clippy::too_many_arguments)]
    fn vector_component(
        &mut self,
        name: &str,
        entry: &Entry<'_>,
        unit: &Unit,
        values: &[f64],
        register: &mut Register,
        start: usize,
        alone: bool,
        labels: &mut Vec<String>,
    ) -> Option<()> {
        if entry.way == Way::Source {
            for (place, value) in (start..).zip(values) {
                let context = Context {
                    owner: name,
                    value: Some(*value),
                    unit,
                    place: entry.place.clone(),
                };
                for piece in self.shared_pieces(entry, &context, register)? {
                    if let Piece::Shared {
                        component,
                        coefficient,
                        follows,
                    } = piece
                    {
                        register.follow(place, component, coefficient, follows);
                        register.act(place, component, coefficient);
                    }
                }
            }
            return Some(());
        }
        let listed = entry.table.readings.as_ref();
        let by_element = listed.is_some_and(|stated| matches!(stated.value, Numbers::Lists(_)));
        if locates(entry.way)
            && !single(entry.table)
            && !by_element
            && entry.way != Way::Distribution
        {
            return self.refuse(
                Fault::new(
                    VECTOR,
                    entry.place.clone(),
                    format!("this component would state one estimate for all elements of {name}"),
                )
                .label("not for a vector")
                .help(
                    "state a deviation (`u`, `half_width`, `step` …), or readings for each element: readings = [[…], […]]",
                ),
            );
        }
        let listed = self.with_columns(entry.table);
        let entry = &Entry {
            table: listed.as_ref().unwrap_or(entry.table),
            way: entry.way,
            place: entry.place.clone(),
        };
        self.one_for_each(name, entry.table, values.len())?;
        let relative = self.acts_in_proportion(entry, unit);
        let common = entry
            .table
            .common
            .as_ref()
            .is_some_and(|stated| stated.value);
        let mut first: Option<(usize, f64)> = None;
        let mut label = None;
        let mut family = Vec::new();
        for (element, value) in values.iter().enumerate() {
            // A fraction of zero is zero: this element has no such doubt.
            if relative && *value == 0.0 {
                continue;
            }
            let context = Context {
                owner: name,
                value: Some(*value),
                unit,
                place: entry.place.clone(),
            };
            let mut draft = match of_element(entry.table, element) {
                Some(table) => self.draft_following(&table, entry.way, &context)?,
                None => self.draft_following(entry.table, entry.way, &context)?,
            };
            if !matches!(draft.location, Location::None | Location::Mean(_)) {
                return self.refuse(
                    Fault::new(
                        VECTOR,
                        entry.place.clone(),
                        format!("this component would move the elements of {name}"),
                    )
                    .label("only symmetric deviations for a vector"),
                );
            }
            self.other_mean(name, element, *value, &draft);
            let dof = draft.dof;
            let label = label.get_or_insert_with(|| another(labels, &draft.label));
            draft.label.clone_from(label);
            let follows = draft.follows;
            let (component, coefficient) = match first {
                Some((component, u)) if common => (component, draft.u / u),
                _ => {
                    let owner_name = if common {
                        name.to_string()
                    } else {
                        element_name(name, element)
                    };
                    let u = draft.u * if relative { value.signum() } else { 1.0 };
                    let component = register.add(
                        Owner::Input(start + element),
                        &owner_name,
                        unit,
                        draft,
                        alone,
                    );
                    if !common && dof.is_finite() {
                        family.push(component);
                    }
                    if let Some(readings) = self.readings_of(entry.table, element) {
                        register.readings.insert(component, readings);
                    }
                    first = Some((component, u));
                    register.follow(start + element, component, 1.0, follows);
                    register.act(start + element, component, 1.0);
                    continue;
                }
            };
            let sign = if relative { value.signum() } else { 1.0 };
            register.follow(start + element, component, sign * coefficient, follows);
            register.act(start + element, component, sign * coefficient);
        }
        if of_element(entry.table, 0).is_none() && entry.way != Way::Distribution {
            self.family(name, family, register);
        }
        Some(())
    }

    /// Elements whose u comes from one statement share the doubt about it: they have one ν together.
    fn family(&mut self, name: &str, family: Vec<usize>, register: &mut Register) {
        match family.len() {
            0 | 1 => {}
            2..=LARGEST_FAMILY => register.families.push(family),
            count => self.remark(
                format!("{name}: ν is taken for each of the {count} elements by itself, although they share one u; more than {LARGEST_FAMILY} are not evaluated together."),
                format!("{name}：{count} 个元素虽共用一个 u，但自由度按各元素独立处理；超过 {LARGEST_FAMILY} 个元素时不作联合评定。"),
            ),
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
        let (value, mean) = (show(value), show(mean));
        self.remark(
            format!(
                "{name}: the stated value {value} is used; the mean of its readings is {mean}."
            ),
            format!("{name}：采用给出的值 {value}；读数的平均值为 {mean}。"),
        );
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
        let amounts = |stated: &Option<Stated<Amounts>>| match stated {
            Some(Stated {
                value: Amounts::Each(list),
                span,
                ..
            }) => Some((list.len(), span.clone())),
            _ => None,
        };
        let readings = match &table.readings {
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
                        format!("`{key}` has {entries} entries, {name} has {length} values"),
                    )
                    .label(format!("expected {length} entries"))
                    .help("state one for each element, or a single one for all"),
                );
            }
        }
        Some(())
    }

    /// Whether the component is a fraction of the value alone.
    pub(super) fn acts_in_proportion(&mut self, entry: &Entry<'_>, unit: &Unit) -> bool {
        let table = entry.table;
        let stated = table.relative.as_ref().is_some_and(|stated| stated.value);
        let certificate = table
            .certificate
            .as_ref()
            .and_then(|certificate| certificate.value.U.as_ref());
        let stated_amount = table.u.as_ref().or(table.half_width.as_ref());
        let first = stated_amount.and_then(|amounts| amounts.of_element(0));
        let of_dimension_one = first
            .as_ref()
            .or(certificate)
            .and_then(|amount| amount.value.unit.as_ref())
            .and_then(|(text, _)| self.units.parse(text).ok())
            .is_some_and(|own| own.dimension == Unit::one().dimension);
        stated || (of_dimension_one && unit.dimension != Unit::one().dimension)
    }
}

/// The component as it stands for one element, if it lists an amount for each.
pub(super) fn of_element(table: &ComponentTable, element: usize) -> Option<ComponentTable> {
    let one = |stated: &Option<Stated<Amounts>>| {
        let amount = stated.as_ref()?.of_element(element)?;
        Some(amount.map(|amount| Amounts::One(amount.clone())))
    };
    let listed = |stated: &Option<Stated<Amounts>>| {
        matches!(
            stated,
            Some(Stated {
                value: Amounts::Each(_),
                ..
            })
        )
    };
    let readings = |stated: &Option<Stated<Numbers>>| match stated {
        Some(Stated {
            value: Numbers::Lists(lists),
            ..
        }) => lists
            .get(element)
            .map(|list| list.map(|list| Numbers::List(list.clone()))),
        other => other.clone(),
    };
    let by_readings = matches!(
        table.readings,
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
