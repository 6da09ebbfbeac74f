//! Which way a component states its uncertainty, and which keys go with it.

use std::ops::Range;

use super::amounts::Share;
use super::checker::Checker;
use super::draft::{Context, Core, Draft, Kind, Location, show};
use crate::budget::distributions::DistributionEntry;
use crate::budget::faults::{MISSING_KEY, MODIFIER, NO_DOUBT, TWO_WAYS};
use crate::budget::tables::{CertificateTable, ComponentTable};
use crate::budget::{Certificate, Evaluation, Follows};
use gumption_core::distribution::Distribution as Shape;
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::{Date, Slot};
use smallvec::SmallVec;
use smol_str::{SmolStr, format_smolstr};

/// Declares the ways in which a component can state its uncertainty: the key that states it, what the component is called
/// in the budget table where the file gives it no name, whether the way determines the estimate by itself, and which other
/// keys go with it.
macro_rules! ways {
    ($($name:ident $key:literal $label:literal $($locates:ident)? [$($with:ident)*],)*) => {
        /// How a component states its uncertainty.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(super) enum Way {
            $($name,)*
        }

        impl Way {
            /// The way that a key states.
            fn of(key: &str) -> Option<Way> {
                match key {
                    $($key => Some(Way::$name),)*
                    _ => None,
                }
            }

            fn label(self) -> &'static str {
                match self {
                    $(Way::$name => $label,)*
                }
            }

            /// Whether the way determines the estimate by itself.
            pub(super) fn locates(self) -> bool {
                match self {
                    $(Way::$name => !stringify!($($locates)?).is_empty(),)*
                }
            }

            /// Whether a modifier goes with it.
            fn goes_with(self, modifier: &str) -> bool {
                match self {
                    $(Way::$name => [$(stringify!($with)),*].contains(&modifier),)*
                }
            }
        }
    };
}

ways! {
    U "u" "standard uncertainty" [beta d distribution dof reliability relative type gum_u common],
    HalfWidth "half_width" "limits" [beta d p distribution dof reliability relative type gum_u common],
    Limits "limits" "limits" locates [beta d p distribution dof reliability type gum_u],
    PlusMinus "plus" "limits" [beta d distribution dof reliability relative type gum_u common],
    Certificate "certificate" "certificate" [beta d distribution dof reliability relative type gum_u common],
    Readings "readings" "repeatability" locates [of pooled autocorrelated significance outlier_test],
    Groups "groups" "groups" locates [of between significance],
    GroupSummary "group_summary" "groups" locates [of between significance],
    Pooled "pooled" "repeatability" [relative of pooled common],
    Specification "specification" "specification" [beta d p distribution dof reliability type gum_u common],
    Step "step" "resolution" [beta d p distribution dof reliability gum_u common],
    Bits "bits" "quantisation" [range dof reliability gum_u common],
    Source "source" "source" [relative sensitivity],
    Sample "sample" "sample" locates [type gum_u],
    Distribution "distribution" "distribution" locates [beta d distribution dof reliability type gum_u common],
    Count "count" "count" locates [prior],
    Successes "successes" "proportion" locates [prior trials],
    ResidualOf "residual_of" "scatter of a reading" [of],
}

use Way::{
    Bits, Count, Distribution, GroupSummary, Groups, HalfWidth, Limits, PlusMinus, Pooled,
    Readings, ResidualOf, Sample, Source, Specification, Step, Successes, U,
};

/// Keys that go with some ways only, and what to say where they stand with others.
static MODIFIERS: [(&str, Said); 20] = [
    ("prior", say!("`prior` goes with `count` or `successes`")),
    ("range", say!("`range` goes with `bits`")),
    ("trials", say!("`trials` goes with `successes`")),
    (
        "beta",
        say!("`beta` goes with distribution = \"trapezoidal\""),
    ),
    (
        "d",
        say!("`d` goes with distribution = \"curvilinear-trapezoid\""),
    ),
    (
        "p",
        say!(
            "`p` goes with a normal `half_width`; inside a certificate write certificate = {{ U = …, p = … }}"
        ),
    ),
    (
        "distribution",
        say!("the distribution follows from the way the uncertainty is stated"),
    ),
    (
        "dof",
        say!("the degrees of freedom follow from the way the uncertainty is stated"),
    ),
    (
        "reliability",
        say!("the degrees of freedom follow from the way the uncertainty is stated"),
    ),
    (
        "relative",
        say!(
            "`relative` goes with `u`, `half_width`, `plus` and `minus`, `certificate` or `source`"
        ),
    ),
    (
        "of",
        say!("`of` goes with `readings`, `groups`, `pooled` or `residual_of`"),
    ),
    (
        "pooled",
        say!("`pooled` takes the place of the scatter of `readings`"),
    ),
    (
        "autocorrelated",
        say!("`autocorrelated` goes with `readings`"),
    ),
    (
        "between",
        say!("`between` goes with `groups` or `group_summary`"),
    ),
    (
        "significance",
        say!("`significance` goes with `groups`, or with `readings` and their `outlier_test`"),
    ),
    ("outlier_test", say!("`outlier_test` goes with `readings`")),
    (
        "type",
        say!("the type follows from the way the uncertainty is stated"),
    ),
    (
        "sensitivity",
        say!(
            "`sensitivity` goes with `source`; a cause of its own is an input that the model adds"
        ),
    ),
    (
        "gum_u",
        say!("`gum_u` goes with a distribution of known shape"),
    ),
    (
        "common",
        say!("the component cannot be shared by the elements of a vector"),
    ),
];

/// Whether a key states an uncertainty, alone or with others.
pub(in crate::budget) fn states_uncertainty(key: &str) -> bool {
    key == "minus" || Way::of(key).is_some()
}

/// Whether what stands under a key determines the estimate by itself.
pub(in crate::budget) fn states_estimate(key: &str) -> bool {
    Way::of(key).is_some_and(Way::locates)
}

/// The ways in which a component states its uncertainty, with their keys; one, where nothing is wrong.
pub(super) fn stated_ways(
    table: &ComponentTable,
) -> impl Iterator<Item = (Way, &'static str, &Range<usize>)> {
    let full = matches!(
        table.distribution.as_ref().map(|d| &d.value),
        Some(DistributionEntry::Full(_))
    );
    let expanded = table
        .certificate
        .as_ref()
        .is_some_and(|c| c.value.present.iter().any(|(key, _)| *key == "U"));
    let has = |wanted: &str| table.present.iter().any(|(key, _)| *key == wanted);
    let way = move |key: &str| match key {
        "minus" if !has("plus") => Some(PlusMinus),
        "certificate" if !expanded => None,
        "pooled" if has("readings") => None,
        "distribution" if !full => None,
        _ => Way::of(key),
    };
    let present = table.present.iter();
    present.filter_map(move |(key, span)| way(key).map(|way| (way, *key, span)))
}

/// An entry of `components` for each way, with the stated keys that go with it: of several ways the one behind which the
/// key stands.
fn entries(table: &ComponentTable, ways: &[(Way, &str, &Range<usize>)]) -> Vec<String> {
    let goes = |way: Way, key: &str| way.goes_with(key) || way == PlusMinus && key == "minus";
    let owner = |key: &str, place: &Range<usize>| {
        let taking = || ways.iter().filter(|(way, ..)| goes(*way, key));
        let in_front = taking().filter(|(.., way)| way.start < place.start);
        let nearest = in_front.max_by_key(|(.., way)| way.start);
        nearest.or_else(|| taking().next()).map(|(_, own, _)| *own)
    };
    let entry = |(_, own, _): &(Way, &str, &Range<usize>)| {
        let is_way = |key: &str| ways.iter().any(|(_, way, _)| *way == key);
        let present = table.present.iter();
        let with = present.filter(|(key, place)| !is_way(key) && owner(key, place) == Some(*own));
        let keys = [*own].into_iter().chain(with.map(|(key, _)| *key));
        let keys: Vec<String> = keys.map(|key| format!("{key} = …")).collect();
        format!("{{ {} }}", keys.join(", "))
    };
    ways.iter().map(entry).collect()
}

impl Checker<'_> {
    /// The one way in which a component states its uncertainty; nothing if it was refused already.
    pub(super) fn way(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Way> {
        let ways: SmallVec<[_; 2]> = stated_ways(table).collect();
        match ways[..] {
            [(way, key, span)] => {
                self.modifiers(table, way, key, span);
                Some(way)
            }
            [] if table.refused => None,
            [] if table.certificate.is_some() => {
                let place = table
                    .certificate
                    .as_ref()
                    .map_or(context.place.clone(), |stated| stated.span.clone());
                self.refuse(
                    Fault::new(
                        MISSING_KEY,
                        place,
                        say!("the certificate of {} states no uncertainty", context.owner),
                    )
                    .label(say!("`U` is missing"))
                    .help(say!("add U and k: certificate = {{ U = …, k = 2 }}")),
                )
            }
            [] => self.refuse(
                Fault::new(
                    NO_DOUBT,
                    context.place.clone(),
                    say!("{} has no uncertainty", context.owner),
                )
                .label(say!("nothing here states an uncertainty"))
                .help(say!(
                    "state it by `u`, `half_width`, `certificate`, `readings`, `step` …; \
                         a number that is exact belongs into [constant]"
                )),
            ),
            [(_, _, first), (_, _, second), ref more @ ..] => {
                let keys: Vec<String> = ways.iter().map(|(_, key, _)| format!("`{key}`")).collect();
                let entries = entries(table, &ways);
                let message = say!(
                    "the uncertainty of {} is stated in {} ways, {}",
                    context.owner,
                    keys.len(),
                    keys.join(", "),
                );
                let mut fault = Fault::new(TWO_WAYS, second.clone(), message)
                    .label(say!("stated again here"))
                    .related(first.clone(), say!("first stated here"))
                    .help(say!(
                        "keep one; where they are different reasons for doubt, make each an entry: components = [{}]",
                        entries.join(", ")
                    ));
                for (_, _, span) in more {
                    fault = fault.related((*span).clone(), say!("and here"));
                }
                self.refuse(fault)
            }
        }
    }

    /// Reports keys that do not go with the way.
    fn modifiers(
        &mut self,
        table: &ComponentTable,
        way: Way,
        way_key: &str,
        way_span: &Range<usize>,
    ) {
        for (key, span) in &table.present {
            let Some((_, help)) = MODIFIERS.iter().find(|(modifier, _)| modifier == key) else {
                continue;
            };
            if !way.goes_with(key) && *key != way_key {
                self.report(
                    Fault::new(
                        MODIFIER,
                        span.clone(),
                        say!("`{key}` does not go with `{way_key}`"),
                    )
                    .label(say!("no meaning here"))
                    .related(way_span.clone(), say!("the uncertainty is stated here"))
                    .help(help.clone()),
                );
            }
        }
    }

    /// Drafts a component that is stated in any way but `source`.
    pub(super) fn draft(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
    ) -> Option<Box<Draft>> {
        if table.refused {
            return None;
        }
        let core = match way {
            Readings | Pooled => self.type_a(table, context),
            Groups | GroupSummary => self.grouped(table, way, context),
            U | HalfWidth | Limits | PlusMinus | Way::Certificate | Specification | Step | Bits => {
                self.type_b(table, way, context)
            }
            Sample | Distribution | Count | Successes => self.given(table, way, context),
            ResidualOf => self.residual_of(table, context),
            Source => None,
        }?;
        self.finish(table, way, context, core)
    }

    /// The same, with the rule by which the uncertainty follows the estimate, where it was made of that: found by
    /// drafting the component once more for twice the estimate.
    pub(super) fn draft_following(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
    ) -> Option<Box<Draft>> {
        let mut draft = self.draft(table, way, context)?;
        draft.follows = match (way, context.used()) {
            (Count, _) => Some(Follows::Root),
            (U | HalfWidth | PlusMinus | Way::Certificate | Specification, Some(value))
                if value != 0.0 =>
            {
                let double = context.at(Some(2.0 * value));
                let told = (self.messages.faults.len(), self.messages.remarks.len());
                let doubled = self.draft(table, way, &double);
                // What would be wrong with twice the estimate is no fault of the file, and nothing to be told.
                self.messages.faults.truncate(told.0);
                self.messages.remarks.truncate(told.1);
                doubled.and_then(|doubled| proportion(doubled.u / draft.u - 1.0))
            }
            _ => None,
        };
        Some(draft)
    }

    fn finish(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
        core: Core,
    ) -> Option<Box<Draft>> {
        let mut core = core;
        if let Some(gum_u) = &table.gum_u {
            core.u = self.positive_deviation(gum_u, "gum_u", context, Share::Unsaid)?;
            core.how = format_smolstr!("{} (GUM: u as stated)", core.how);
        }
        let certificate = table
            .certificate
            .as_ref()
            .map(|stated| self.certificate(&stated.value, context).into());
        let kind = match way {
            Readings | Groups | GroupSummary | Pooled => Kind::Repeatability,
            Step | Bits => Kind::Resolution,
            // A study of readings that was evaluated elsewhere is one of readings.
            U if table.kind.as_ref().map(|word| word.value) == Some(Evaluation::TypeA) => {
                Kind::Repeatability
            }
            ResidualOf => self.fit_named(table).map_or(Kind::Other, Kind::Scatter),
            _ => Kind::Other,
        };
        self.limits_without_freedom(&core, context);
        let name = table.name.as_ref().map(|name| name.value.as_str().into());
        Some(Box::new(Draft {
            label: name.unwrap_or_else(|| SmolStr::new_static(way.label())),
            named: table.name.as_ref().map(|name| name.span.clone()),
            distribution: core.distribution,
            u: core.u,
            dof: core.dof,
            evaluation: match table.kind.as_ref().map(|word| word.value) {
                Some(stated) => stated,
                None if matches!(kind, Kind::Repeatability | Kind::Scatter(_)) => Evaluation::TypeA,
                None => Evaluation::TypeB,
            },
            how: core.how,
            location: core.location,
            findings: core.findings,
            kind,
            follows: None,
            certificate,
            reference: table.reference.as_ref().map(|text| text.value.clone()),
            place: context.place.clone(),
            stated: stated_ways(table)
                .next()
                .map_or(&context.place, |(_, _, key)| key)
                .clone(),
            readings: None,
        }))
    }

    /// Remarks on finite ν of a shape that has no place for it.
    fn limits_without_freedom(&mut self, core: &Core, context: &Context<'_>) {
        let shape = &core.distribution;
        if core.dof.is_infinite() || matches!(shape, Shape::StudentT { .. }) {
            return;
        }
        let (owner, dof) = (context.owner, show(core.dof));
        self.remark(say!("{owner}: ν = {dof} enters the effective degrees of freedom of the GUM method only. Monte Carlo draws the stated shape as exactly known, and its interval does not widen for the doubt about u."));
    }

    fn certificate(&mut self, table: &CertificateTable, context: &Context<'_>) -> Certificate {
        let date = |date: &Slot<Date>| date.as_ref().map(|date| date.value.0.clone());
        let text = |text: &Slot<String>| text.as_ref().map(|text| text.value.clone());
        let certificate = Certificate {
            number: text(&table.number),
            laboratory: text(&table.laboratory),
            date: date(&table.date),
            due: date(&table.due),
            k: table.k.as_ref().map(|k| k.value),
        };
        if let (Some(due), Some(date)) = (&certificate.due, self.source.date.clone())
            && due[..10] < date[..10]
        {
            let owner = context.owner;
            self.remark(match &certificate.number {
                Some(number) => say!("The certificate {number} of {owner} was due on {due}, before the measurement on {date}."),
                None => say!("The certificate of {owner} was due on {due}, before the measurement on {date}."),
            });
        }
        certificate
    }
}

/// The rule for a share that grows with the estimate, cleaned of rounding.
fn proportion(share: f64) -> Option<Follows> {
    /// Of the doubles that make the share.
    const ROUNDING: f64 = 1e-12;
    let share = if (share - 1.0).abs() < ROUNDING {
        1.0
    } else {
        share
    };
    (share > ROUNDING).then_some(Follows::Proportion { share })
}

/// Whether the draft states where its quantity is, apart from a shift.
pub(super) fn expectation(location: Location) -> Option<f64> {
    match location {
        Location::Mean(value) | Location::Expectation(value) => Some(value),
        Location::Between { expectation, .. } => Some(expectation),
        Location::None | Location::Shift(_) => None,
    }
}
