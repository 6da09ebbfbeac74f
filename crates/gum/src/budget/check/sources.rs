//! Shared sources: one cause of error that acts on several inputs.

use super::amounts::Share;
use super::checker::Checker;
use super::draft::{Context, Drafts, Location, show};
use super::inputs::{Entry, Piece, Pieces};
use super::register::{Register, SourceEntry};
use super::ways::Way;
use crate::budget::faults::{TWO_ESTIMATES, UNIT_CLASH, UNKNOWN_NAME, UNUSED, VECTOR};
use crate::budget::tables::SourceTable;
use crate::budget::{Follows, Owner};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Said, nearest, say};
use gumption_format::toml::Stated;
use smol_str::SmolStr;

impl Checker<'_> {
    /// Reads `[source.S]`.
    pub(super) fn sources(
        &mut self,
        sources: &[(SmolStr, Stated<SourceTable>)],
        register: &mut Register,
    ) {
        for (name, stated) in sources {
            let table = &stated.value;
            let hidden = table.unknown || table.present.iter().any(|(key, _)| *key == "unit");
            let unit = match &table.unit {
                None if hidden => None,
                stated => self.unit(stated),
            };
            let mut entry = SourceEntry {
                name: name.to_string(),
                unit: unit.clone(),
                components: Vec::new(),
                used: false,
            };
            if let Some(unit) = unit {
                let drafts = self.source_drafts(name, stated, &unit);
                register.incomplete |= drafts.is_none();
                let drafts = drafts.unwrap_or_default();
                let alone = drafts.len() == 1;
                for draft in drafts {
                    let owner = Owner::Source(name.to_string());
                    entry
                        .components
                        .push(register.add(owner, name, &unit, draft, alone));
                }
            }
            register.sources.push(entry);
        }
    }

    fn source_drafts(
        &mut self,
        name: &str,
        stated: &Stated<SourceTable>,
        unit: &Unit,
    ) -> Option<Drafts> {
        let table = &stated.value;
        let list = self.ways(
            name,
            &table.components,
            &table.component,
            &stated.span,
            unit,
        )?;
        let mut drafts = Drafts::new();
        for entry in list {
            let context = Context::new(name, None, unit, entry.place.clone());
            if entry.way == Way::Source {
                return self.refuse(
                    Fault::new(
                        VECTOR,
                        entry.place,
                        say!("the source {name} refers to another source"),
                    )
                    .label(say!("a source states its own uncertainty")),
                );
            }
            let draft = self.draft(entry.table, entry.way, &context)?;
            let moved = match draft.location {
                Location::None | Location::Mean(_) => 0.0,
                Location::Shift(shift) => shift,
                Location::Expectation(mean)
                | Location::Between {
                    expectation: mean, ..
                } => mean,
            };
            if moved.abs() > 1e-9 * draft.u {
                return self.refuse(
                    Fault::new(
                        TWO_ESTIMATES,
                        entry.place,
                        say!(
                            "the source {name} has the expectation {}, not 0",
                            show(moved)
                        ),
                    )
                    .label(say!("a source is an error about zero"))
                    .help(say!(
                        "correct the inputs for the known part, and state limits about zero here"
                    )),
                );
            }
            drafts.push(draft);
        }
        self.label_uniquely(name, &mut drafts);
        Some(drafts)
    }

    /// Reports sources that no input refers to.
    pub(super) fn unused_sources(
        &mut self,
        sources: &[(SmolStr, Stated<SourceTable>)],
        register: &Register,
    ) {
        for (name, stated) in sources {
            if register
                .sources
                .iter()
                .any(|source| source.name == *name && !source.used)
            {
                self.report(
                    Fault::new(UNUSED, stated.key.clone(), say!("no input refers to the source {name}"))
                        .label(say!("not used"))
                        .help(say!("add source = \"{name}\" to the components of the inputs that it acts on, or remove it")),
                );
            }
        }
    }

    pub(super) fn shared_pieces(
        &mut self,
        entry: &Entry<'_>,
        context: &Context<'_>,
        register: &mut Register,
    ) -> Option<Pieces> {
        let stated = entry.table.source.as_ref()?;
        if entry.table.refused {
            return None;
        }
        let names: Vec<String> = register
            .sources
            .iter()
            .map(|source| source.name.clone())
            .collect();
        let Some(source) = register
            .sources
            .iter_mut()
            .find(|source| source.name == stated.value)
        else {
            let help = match nearest(&stated.value, names.iter().map(String::as_str)) {
                Some(near) => say!("did you mean \"{near}\"?"),
                None => say!(
                    "declare it: [source.{}]; where a number comes from is `reference`",
                    stated.value
                ),
            };
            return self.refuse(
                Fault::new(
                    UNKNOWN_NAME,
                    stated.span.clone(),
                    say!("there is no source \"{}\"", stated.value),
                )
                .label(say!("not declared"))
                .help(help),
            );
        };
        source.used = true;
        let (unit, components) = (source.unit.clone()?, source.components.clone());
        let coefficient = self.coefficient(entry, context, &unit)?;
        let relative = entry.table.share() == Share::OfValue;
        let follows = relative.then_some(Follows::Proportion { share: 1.0 });
        Some(
            components
                .into_iter()
                .map(|component| Piece::Shared {
                    component,
                    coefficient,
                    follows,
                })
                .collect(),
        )
    }

    /// How a source acts on an input in its unit.
    fn of_sensitivity(
        &self,
        entry: &Entry<'_>,
        context: &Context<'_>,
        source: &Unit,
        target: &Unit,
    ) -> Said {
        let wanted = target.quotient(&source.difference()).symbol.clone();
        let Some(stated) = &entry.table.sensitivity else {
            return match source.is_one() {
                true => say!(
                    "add relative = true if it is a relative error of the value, else the sensitivity: sensitivity = \"… {wanted}\""
                ),
                false => say!("add the sensitivity: sensitivity = \"… {wanted}\""),
            };
        };
        // Behind `1.15 µm/K` stands the unit that the source should have.
        let units = |text: &str| self.names.units.parse(text).ok();
        let missing = stated.value.unit.as_ref().and_then(|(text, _)| {
            let (_, of_source) = text.rsplit_once('/')?;
            let acts_in = units(text)?.product(&units(of_source)?.difference());
            acts_in.conversion_to(target).map(|_| of_source.to_owned())
        });
        match (missing, &entry.table.source) {
            (Some(missing), Some(name)) if source.is_one() => {
                say!("add unit = \"{missing}\" to [source.{}]", name.value)
            }
            _ => say!(
                "it is the change of {} per unit of the source: sensitivity = \"… {wanted}\"",
                context.owner
            ),
        }
    }

    /// Change of the input per unit of the source.
    fn coefficient(
        &mut self,
        entry: &Entry<'_>,
        context: &Context<'_>,
        source: &Unit,
    ) -> Option<f64> {
        let relative = entry.table.share() == Share::OfValue;
        let whole = if relative {
            context.value().unwrap_or(0.0)
        } else {
            1.0
        };
        let target = if relative {
            Unit::one()
        } else {
            context.unit.difference()
        };
        let (number, unit, place) = match &entry.table.sensitivity {
            Some(sensitivity) => match &sensitivity.value.unit {
                // A number goes with the units of both; of the same kind it is a ratio, as 1 is that is left out.
                None => {
                    let ratio = source.difference().conversion_to(&target);
                    let factor = ratio.map_or(1.0, |ratio| ratio.factor);
                    return Some(whole * sensitivity.value.number * factor);
                }
                Some((text, span)) => {
                    let text = Box::new(Stated {
                        value: text.clone(),
                        span: span.clone(),
                        key: span.clone(),
                    });
                    (
                        sensitivity.value.number,
                        self.unit(&Some(text))?.product(source),
                        span.clone(),
                    )
                }
            },
            None => (1.0, source.difference(), entry.place.clone()),
        };
        match unit.conversion_to(&target) {
            Some(conversion) => Some(whole * number * conversion.factor),
            None => self.refuse(
                Fault::new(
                    UNIT_CLASH,
                    place,
                    say!(
                        "the source acts in {}, {} is in {}",
                        unit.symbol,
                        context.owner,
                        target.symbol
                    ),
                )
                .label(say!("units do not fit"))
                .help(self.of_sensitivity(entry, context, source, &target)),
            ),
        }
    }
}
