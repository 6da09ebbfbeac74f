//! Which way a component states its uncertainty, and which keys go with it.

use std::ops::Range;

use super::checker::Checker;
use super::draft::{Context, Core, Draft, Kind, Location, show};
use crate::budget::distributions::DistributionEntry;
use crate::budget::faults::{MISSING_KEY, MODIFIER, NO_DOUBT, TWO_WAYS};
use crate::budget::tables::{CertificateTable, ComponentTable, TypeWord};
use crate::budget::{Certificate, Evaluation, Follows};
use crate::distribution::Distribution as Shape;
use crate::fault::Fault;

/// How a component states its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    U,
    HalfWidth,
    Limits,
    PlusMinus,
    Certificate,
    Readings,
    Groups,
    GroupSummary,
    Pooled,
    Specification,
    Step,
    Bits,
    Source,
    Sample,
    Distribution,
    Count,
    Successes,
    ResidualOf,
}

use Way::{
    Bits, Count, Distribution, GroupSummary, Groups, HalfWidth, Limits, PlusMinus, Pooled,
    Readings, ResidualOf, Sample, Source, Specification, Step, Successes, U,
};

/// Which ways a modifier goes with, and what to say otherwise.
const MODIFIERS: [(&str, &[Way], &str); 20] = [
    (
        "prior",
        &[Count, Successes],
        "`prior` goes with `count` or `successes`",
    ),
    ("range", &[Bits], "`range` goes with `bits`"),
    ("trials", &[Successes], "`trials` goes with `successes`"),
    (
        "beta",
        SHAPED,
        "`beta` goes with distribution = \"trapezoidal\"",
    ),
    (
        "d",
        SHAPED,
        "`d` goes with distribution = \"curvilinear-trapezoid\"",
    ),
    (
        "p",
        &[HalfWidth, Limits, Specification],
        "`p` goes with a normal `half_width`; inside a certificate write certificate = { U = …, p = … }",
    ),
    (
        "distribution",
        SHAPED,
        "the distribution follows from the way the uncertainty is stated",
    ),
    (
        "dof",
        WITH_DOF,
        "the degrees of freedom follow from the way the uncertainty is stated",
    ),
    (
        "reliability",
        WITH_DOF,
        "the degrees of freedom follow from the way the uncertainty is stated",
    ),
    (
        "relative",
        &[U, HalfWidth, PlusMinus, Way::Certificate, Source, Pooled],
        "`relative` goes with `u`, `half_width`, `plus` and `minus`, `certificate` or `source`",
    ),
    (
        "of",
        &[Readings, Groups, GroupSummary, Pooled, ResidualOf],
        "`of` goes with `readings`, `groups`, `pooled` or `residual_of`",
    ),
    (
        "pooled",
        &[Readings, Pooled],
        "`pooled` takes the place of the scatter of `readings`",
    ),
    (
        "autocorrelated",
        &[Readings],
        "`autocorrelated` goes with `readings`",
    ),
    (
        "between",
        &[Groups, GroupSummary],
        "`between` goes with `groups` or `group_summary`",
    ),
    (
        "significance",
        &[Readings, Groups, GroupSummary],
        "`significance` goes with `groups`, or with `readings` and their `outlier_test`",
    ),
    (
        "outlier_test",
        &[Readings],
        "`outlier_test` goes with `readings`",
    ),
    (
        "type",
        WITH_TYPE,
        "the type follows from the way the uncertainty is stated",
    ),
    ("sensitivity", &[Source], "`sensitivity` goes with `source`"),
    (
        "gum_u",
        WITH_GUM_U,
        "`gum_u` goes with a distribution of known shape",
    ),
    (
        "common",
        WITH_COMMON,
        "the component cannot be shared by the elements of a vector",
    ),
];

const SHAPED: &[Way] = &[
    U,
    HalfWidth,
    Limits,
    PlusMinus,
    Way::Certificate,
    Specification,
    Distribution,
];
const WITH_DOF: &[Way] = &[
    U,
    HalfWidth,
    Limits,
    PlusMinus,
    Way::Certificate,
    Specification,
    Step,
    Bits,
    Distribution,
];
const WITH_TYPE: &[Way] = &[
    U,
    HalfWidth,
    Limits,
    PlusMinus,
    Way::Certificate,
    Specification,
    Distribution,
    Sample,
];
const WITH_GUM_U: &[Way] = &[
    U,
    HalfWidth,
    Limits,
    PlusMinus,
    Way::Certificate,
    Specification,
    Distribution,
    Sample,
    Step,
    Bits,
];
const WITH_COMMON: &[Way] = &[
    U,
    HalfWidth,
    PlusMinus,
    Way::Certificate,
    Specification,
    Step,
    Bits,
    Distribution,
    Pooled,
];

/// What each way is called in the budget table when the file gives the component no name.
fn label(way: Way) -> &'static str {
    match way {
        U => "standard uncertainty",
        HalfWidth | Limits | PlusMinus => "limits",
        Way::Certificate => "certificate",
        Readings | Pooled => "repeatability",
        Groups | GroupSummary => "groups",
        Specification => "specification",
        Step => "resolution",
        Bits => "quantisation",
        Source => "source",
        Sample => "sample",
        Distribution => "distribution",
        Count => "count",
        Successes => "proportion",
        ResidualOf => "scatter of a reading",
    }
}

/// Whether the way determines the estimate by itself.
pub(super) fn locates(way: Way) -> bool {
    matches!(
        way,
        Limits | Readings | Groups | GroupSummary | Sample | Distribution | Count | Successes
    )
}

fn stated_ways(table: &ComponentTable) -> Vec<(Way, &'static str, Range<usize>)> {
    let full = matches!(
        table.distribution.as_ref().map(|d| &d.value),
        Some(DistributionEntry::Full(_))
    );
    let expanded = table
        .certificate
        .as_ref()
        .is_some_and(|c| c.value.present.iter().any(|(key, _)| *key == "U"));
    let has = |wanted: &str| table.present.iter().any(|(key, _)| *key == wanted);
    let way = |key: &str| match key {
        "u" => Some(U),
        "half_width" => Some(HalfWidth),
        "limits" => Some(Limits),
        "plus" => Some(PlusMinus),
        "minus" if !has("plus") => Some(PlusMinus),
        "certificate" if expanded => Some(Way::Certificate),
        "readings" => Some(Readings),
        "groups" => Some(Groups),
        "group_summary" => Some(GroupSummary),
        "pooled" if !has("readings") => Some(Pooled),
        "specification" => Some(Specification),
        "step" => Some(Step),
        "bits" => Some(Bits),
        "source" => Some(Source),
        "sample" => Some(Sample),
        "distribution" if full => Some(Distribution),
        "count" => Some(Count),
        "successes" => Some(Successes),
        "residual_of" => Some(ResidualOf),
        _ => None,
    };
    table
        .present
        .iter()
        .filter_map(|(key, span)| way(key).map(|way| (way, *key, span.clone())))
        .collect()
}

impl Checker<'_> {
    /// The one way in which a component states its uncertainty; nothing if it was refused already.
    pub(super) fn way(&mut self, table: &ComponentTable, context: &Context<'_>) -> Option<Way> {
        let ways = stated_ways(table);
        match ways.as_slice() {
            [(way, key, span)] => {
                self.modifiers(table, *way, key, span);
                Some(*way)
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
                        format!("the certificate of {} states no uncertainty", context.owner),
                    )
                    .label("`U` is missing")
                    .help("add U and k: certificate = { U = …, k = 2 }"),
                )
            }
            [] => self.refuse(
                Fault::new(
                    NO_DOUBT,
                    context.place.clone(),
                    format!("{} has no uncertainty", context.owner),
                )
                .label("nothing here states an uncertainty")
                .help(
                    "state it by `u`, `half_width`, `certificate`, `readings`, `step` …; \
                         a number that is exact belongs into [constant]",
                ),
            ),
            [(_, _, first), (_, _, second), more @ ..] => {
                let keys: Vec<String> = ways.iter().map(|(_, key, _)| format!("`{key}`")).collect();
                let entries: Vec<String> = ways
                    .iter()
                    .map(|(_, key, _)| format!("{{ {key} = … }}"))
                    .collect();
                let message = format!(
                    "the uncertainty of {} is stated in {} ways, {}",
                    context.owner,
                    keys.len(),
                    keys.join(" and "),
                );
                let mut fault = Fault::new(TWO_WAYS, second.clone(), message)
                    .label("stated again here")
                    .related(first.clone(), "first stated here")
                    .help(format!(
                        "keep one; where they are different reasons for doubt, make each an entry: components = [{}]",
                        entries.join(", ")
                    ));
                for (_, _, span) in more {
                    fault = fault.related(span.clone(), "and here");
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
            let Some((_, ways, help)) = MODIFIERS.iter().find(|(modifier, ..)| modifier == key)
            else {
                continue;
            };
            if !ways.contains(&way) && *key != way_key {
                self.report(
                    Fault::new(
                        MODIFIER,
                        span.clone(),
                        format!("`{key}` does not go with `{way_key}`"),
                    )
                    .label("no meaning here")
                    .related(way_span.clone(), "the uncertainty is stated here")
                    .help(*help),
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
    ) -> Option<Draft> {
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

    /// The same, with the rule by which the uncertainty follows the estimate: found by drafting the component
    /// once more for twice the estimate.
    pub(super) fn draft_following(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
    ) -> Option<Draft> {
        let mut draft = self.draft(table, way, context)?;
        draft.follows = match (way, context.value) {
            (Count, _) => Some(Follows::Root),
            (U | HalfWidth | PlusMinus | Way::Certificate | Specification, Some(value))
                if value != 0.0 =>
            {
                let double = Context {
                    value: Some(2.0 * value),
                    ..context.clone()
                };
                let share = self.draft(table, way, &double)?.u / draft.u - 1.0;
                proportion(share)
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
    ) -> Option<Draft> {
        let mut core = core;
        if let Some(gum_u) = &table.gum_u {
            core.u = self.positive_deviation(gum_u, "gum_u", context, false)?;
            core.how = format!("{} (GUM: u as stated)", core.how);
        }
        let certificate = table
            .certificate
            .as_ref()
            .map(|stated| self.certificate(&stated.value, context));
        let kind = match way {
            Readings | Groups | GroupSummary | Pooled => Kind::Repeatability,
            Step | Bits => Kind::Resolution,
            ResidualOf => self.fit_named(table).map_or(Kind::Other, Kind::Scatter),
            _ => Kind::Other,
        };
        self.limits_without_freedom(&core, context);
        let name = table.name.as_ref().map(|name| name.value.clone());
        Some(Draft {
            label: name.unwrap_or_else(|| label(way).to_string()),
            named: table.name.as_ref().map(|name| name.span.clone()),
            distribution: core.distribution,
            u: core.u,
            dof: core.dof,
            evaluation: match table.kind.as_ref().map(|word| word.value) {
                Some(TypeWord::A) => Evaluation::TypeA,
                Some(TypeWord::B) => Evaluation::TypeB,
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
                .into_iter()
                .next()
                .map_or(context.place.clone(), |(_, _, key)| key),
        })
    }

    /// Remarks on finite ν of a shape that has no place for it.
    fn limits_without_freedom(&mut self, core: &Core, context: &Context<'_>) {
        let shape = &core.distribution;
        if core.dof.is_infinite() || matches!(shape, Shape::StudentT { .. }) {
            return;
        }
        let (owner, dof) = (context.owner, show(core.dof));
        self.remark(
            format!("{owner}: ν = {dof} enters the effective degrees of freedom of the GUM method only. Monte Carlo draws the stated shape as exactly known, and its interval does not widen for the doubt about u."),
            format!("{owner}：自由度 ν = {dof} 仅用于 GUM 法的有效自由度；蒙特卡洛法按给定的分布抽样，其包含区间不因 u 的不可靠性而加宽。"),
        );
    }

    fn certificate(&mut self, table: &CertificateTable, context: &Context<'_>) -> Certificate {
        let date = |date: &Option<gumption_format::toml::Stated<gumption_format::toml::Date>>| {
            date.as_ref().map(|date| date.value.0.clone())
        };
        let text = |text: &Option<gumption_format::toml::Stated<String>>| {
            text.as_ref().map(|text| text.value.clone())
        };
        let certificate = Certificate {
            number: text(&table.number),
            laboratory: text(&table.laboratory),
            date: date(&table.date),
            due: date(&table.due),
        };
        if let (Some(due), Some(date)) = (&certificate.due, self.source.date.clone())
            && due[..10] < date[..10]
        {
            let (number, owner) = (
                certificate.number.clone().unwrap_or_default(),
                context.owner,
            );
            self.remark(
                format!("The certificate {number} of {owner} was due on {due}, before the measurement on {date}."),
                format!("{owner} 所用证书 {number} 的有效期至 {due}，早于测量日期 {date}。"),
            );
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
