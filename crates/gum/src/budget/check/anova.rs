//! Readings in groups: analysis of variance (GUM H.5).

use std::ops::Range;

use super::amounts::Share;
use super::checker::Checker;
use super::csv::{decimals, lacks};
use super::draft::{Context, Core, show};
use super::type_a::Evaluated;
use super::ways::Way;
use crate::budget::faults::{GROUPS, MISSING_KEY, NO_SCATTER};
use crate::budget::tables::{BetweenWord, ComponentTable, GroupColumnTable, GroupSummaryTable};
use crate::budget::variants::{Groups, ReadingsOf};
use crate::budget::{Anova, Finding, NestedAnova};
use gumption_core::quantity::Unit;
use gumption_core::statistics::{Dd, Group, Nested, Of, OneWay, Policy, Uncertainty, Verdict};
use gumption_fault::{Fault, Said, say};
use gumption_format::csv::{Column, Data, Request as Asked};
use gumption_format::toml::Stated;

/// Groups, or groups of subgroups.
enum Design {
    OneWay(Vec<Group>),
    Nested(Vec<Vec<Group>>),
}

/// Things under the names that a column gives them, in the order in which they occur.
type Labelled<T> = Vec<(String, T)>;

/// How the file wants them evaluated.
struct Request<'c> {
    policy: Policy,
    significance: f64,
    of: Of,
    owner: &'c str,
    place: Range<usize>,
}

/// A reading of which nothing tells the group: those of several groups would be taken for one.
fn no_label(file: &str, line: usize, column: &Stated<String>) -> Fault {
    let message = say!("line {line} of {file} has no {}", column.value);
    Fault::new(GROUPS, column.span.clone(), message)
        .label(say!("tells the group of each reading"))
        .help(say!(
            "write the label into every line, also where it is that of the line above"
        ))
}

impl Checker<'_> {
    /// The component that readings in groups state.
    pub(super) fn grouped(
        &mut self,
        table: &ComponentTable,
        way: Way,
        context: &Context<'_>,
    ) -> Option<Core> {
        let (design, place, key) = match way {
            Way::Groups => {
                let stated = table.groups.as_ref()?;
                let design = self.design(stated, context.unit)?;
                (design, stated.span.clone(), stated.key.clone())
            }
            _ => {
                let stated = table.group_summary.as_ref()?;
                let groups = self.group_summary(&stated.value, &stated.span, context)?;
                (
                    Design::OneWay(groups),
                    stated.span.clone(),
                    stated.key.clone(),
                )
            }
        };
        let of = table.of.as_ref().map_or(ReadingsOf::Mean, |of| of.value);
        let request = Request {
            policy: match table.between.as_ref().map(|word| word.value) {
                None | Some(BetweenWord::Include) => Policy::Include,
                Some(BetweenWord::Test) => Policy::Test,
                Some(BetweenWord::None) => Policy::Ignore,
            },
            significance: self.significance(table)?,
            of: match of {
                ReadingsOf::Mean => Of::Mean,
                ReadingsOf::Single => Of::Later(1.0),
                ReadingsOf::Several(count) => Of::Later(count as f64),
            },
            owner: context.owner,
            place,
        };
        let evaluated = match design {
            Design::OneWay(groups) => self.one_way(&groups, &request),
            Design::Nested(groups) => self.nested(&groups, &request),
        }?;
        self.scattered(evaluated, &key, of)
    }

    fn one_way(&mut self, groups: &[Group], request: &Request<'_>) -> Option<Evaluated> {
        self.comparable(groups, request)?;
        if groups.len() < 2 {
            return self.refuse(too_few(
                request,
                say!("a single group"),
                say!("two groups or more"),
            ));
        }
        let table = OneWay::new(groups);
        if table.within.ss == 0.0 {
            return self.refuse(no_scatter(request));
        }
        let (verdict, uncertainty) =
            OneWay::uncertainty(groups, request.policy, request.significance, request.of);
        let words = say!("between groups");
        self.verdict_remark(verdict, words, &table.ratio(), request);
        let how = format!(
            "analysis of variance of {} readings in {} groups, which {}",
            table.readings,
            table.groups,
            outcome(verdict),
        );
        let mean = table.mean;
        let finding = Finding::Anova(Anova {
            table,
            policy: request.policy,
            significance: request.significance,
            verdict,
        });
        Some(evaluated(uncertainty, how, mean, finding))
    }

    fn nested(&mut self, groups: &[Vec<Group>], request: &Request<'_>) -> Option<Evaluated> {
        let cells: Vec<Group> = groups.iter().flatten().copied().collect();
        self.comparable(&cells, request)?;
        if groups.len() < 2 || cells.len() == groups.len() || groups.iter().any(Vec::is_empty) {
            return self.refuse(too_few(
                request,
                say!("too few groups or subgroups"),
                say!("two groups or more, one of which has two subgroups at least"),
            ));
        }
        let table = Nested::new(groups);
        if table.within.ss == 0.0 {
            return self.refuse(no_scatter(request));
        }
        let (verdicts, uncertainty) =
            Nested::uncertainty(groups, request.policy, request.significance, request.of);
        let middle = say!("between subgroups");
        self.verdict_remark(verdicts.middle, middle, &table.middle_ratio(), request);
        let top = say!("between groups");
        self.verdict_remark(verdicts.top, top, &table.top_ratio(), request);
        let how = format!(
            "nested analysis of variance of {} readings in {} subgroups of {} groups; groups {}, subgroups {}",
            table.readings,
            table.subgroups,
            table.groups,
            outcome(verdicts.top),
            outcome(verdicts.middle),
        );
        let mean = table.mean;
        let finding = Finding::Nested(NestedAnova {
            table,
            policy: request.policy,
            significance: request.significance,
            verdicts,
        });
        Some(evaluated(uncertainty, how, mean, finding))
    }

    /// Every group has readings, and one at least has two.
    fn comparable(&mut self, groups: &[Group], request: &Request<'_>) -> Option<()> {
        if groups.iter().any(|group| group.count == 0) {
            return self.refuse(
                Fault::new(
                    GROUPS,
                    request.place.clone(),
                    say!("a group of {} has no readings", request.owner),
                )
                .label(say!("an empty list among them")),
            );
        }
        if !groups.is_empty() && groups.iter().all(|group| group.count < 2) {
            return self.refuse(
                Fault::new(
                    GROUPS,
                    request.place.clone(),
                    say!("no group of {} has two readings", request.owner),
                )
                .label(say!("the scatter within groups is not known"))
                .help(say!("a single reading a day is `readings = […]`")),
            );
        }
        Some(())
    }

    fn verdict_remark(
        &mut self,
        verdict: Verdict,
        between: Said,
        ratio: &gumption_core::statistics::Ratio,
        request: &Request<'_>,
    ) {
        let owner = request.owner;
        let f = format!("{:.2}", ratio.f);
        let critical = format!("{:.2}", ratio.critical(1.0 - request.significance));
        let level = show(100.0 * request.significance);
        match verdict {
            Verdict::Negative => self.remark(say!("{owner}: the variance {between} comes out negative and is taken as zero: their means scatter less than the readings within them make expect. The readings are pooled.")),
            Verdict::Ignored if ratio.f > ratio.critical(1.0 - request.significance) => self.remark(say!("{owner}: between = \"none\", but there is a difference {between} (F = {f}, critical value {critical} at {level} %). u leaves it out.")),
            Verdict::Included | Verdict::NotSignificant | Verdict::Ignored => {}
        }
    }

    fn design(&mut self, stated: &Stated<Groups>, unit: &Unit) -> Option<Design> {
        Some(match &stated.value {
            Groups::OneWay(lists) => Design::OneWay(
                lists
                    .iter()
                    .map(|list| Group::new(&self.exact(&list.value)))
                    .collect(),
            ),
            Groups::Nested(groups) => {
                let cells = |list: &Stated<Vec<Stated<Vec<Stated<f64>>>>>| {
                    let cell =
                        |cell: &Stated<Vec<Stated<f64>>>| Group::new(&self.exact(&cell.value));
                    list.value.iter().map(cell).collect()
                };
                Design::Nested(groups.iter().map(cells).collect())
            }
            Groups::Column(table) if table.refused => return None,
            Groups::Column(table) => self.grouped_column(table, &stated.span, unit)?,
        })
    }

    /// Readings of a CSV file, in the groups that one or two further columns name, in the order in which
    /// the groups occur.
    fn grouped_column<'t>(
        &mut self,
        table: &'t GroupColumnTable,
        place: &Range<usize>,
        unit: &Unit,
    ) -> Option<Design> {
        let (Some(file), Some(column), Some(group)) = (&table.file, &table.column, &table.group)
        else {
            let missing = match (&table.file, &table.column) {
                (None, _) => "file",
                (_, None) => "column",
                _ => "group",
            };
            let example = "{ file = \"readings.csv\", column = \"V\", group = \"day\" }";
            return self.refuse(lacks(missing, place, example));
        };
        let names = &group.value.0;
        if names.is_empty() || names.len() > 2 {
            return self.refuse(
                Fault::new(
                    GROUPS,
                    group.span.clone(),
                    say!("groups named by {} columns", names.len()),
                )
                .label(say!("expected one column, or two for groups and subgroups")),
            );
        }
        let labels = |name: &'t Stated<String>| (name, Asked::labels("group", &name.value));
        let columns: Vec<_> = std::iter::once((&**column, decimals(column, Some(unit))))
            .chain(names.iter().map(labels))
            .collect();
        let found = self.csv(file, &columns)?;
        let (readings, names_of) = found.columns.split_first()?;
        let level = |column: Option<&Column>, row: usize| match column.map(|column| &column.data) {
            Some(Data::Labels(labels)) => labels.text(row).to_owned(),
            _ => String::new(),
        };
        for (name, labels) in names.iter().zip(names_of) {
            let nameless = |row: &usize| level(Some(labels), *row).is_empty();
            if let Some(row) = (0..found.rows()).find(nameless) {
                return self.refuse(no_label(&file.value, found.line(row), name));
            }
        }
        let mut groups: Labelled<Labelled<Vec<Dd>>> = Vec::new();
        for (row, reading) in readings.decimals.iter().flatten().enumerate() {
            let group = entry(&mut groups, level(names_of.first(), row));
            entry(group, level(names_of.get(1), row)).push(*reading);
        }
        let cells = |cells: &Labelled<Vec<Dd>>| -> Vec<Group> {
            cells.iter().map(|(_, list)| Group::new(list)).collect()
        };
        Some(if names.len() == 2 {
            Design::Nested(groups.iter().map(|(_, list)| cells(list)).collect())
        } else {
            Design::OneWay(groups.iter().flat_map(|(_, list)| cells(list)).collect())
        })
    }

    /// Groups of which means, standard deviations and numbers of readings are stated.
    fn group_summary(
        &mut self,
        table: &GroupSummaryTable,
        place: &Range<usize>,
        context: &Context<'_>,
    ) -> Option<Vec<Group>> {
        let (Some(means), Some(s), Some(n)) = (&table.means, &table.s, &table.n) else {
            if table.refused {
                return None;
            }
            let missing = match (&table.means, &table.s) {
                (None, _) => "means",
                (_, None) => "s",
                _ => "n",
            };
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    place.clone(),
                    say!("the summary of the groups lacks `{missing}`"),
                )
                .label(say!("`{missing}` is missing"))
                .help(say!(
                    "write group_summary = {{ means = […], s = […], n = 5 }}"
                )),
            );
        };
        let groups = means.value.len();
        let counts = &n.value.0;
        for (key, length, span) in [("s", s.value.len(), &s.span), ("n", counts.len(), &n.span)] {
            if length != groups && !(key == "n" && length == 1) {
                return self.refuse(
                    Fault::new(
                        GROUPS,
                        span.clone(),
                        say!("`{key}` has {length} entries for {groups} means"),
                    )
                    .label(say!("expected {groups} entries")),
                );
            }
        }
        let mut found = Vec::new();
        for (index, (mean, s)) in means.value.iter().zip(&s.value).enumerate() {
            let count = counts.get(index).or(counts.first())?;
            let mean = self.quantity(mean, context.unit, context.owner)?;
            let s = self.deviation(s, context, Share::Unsaid)?;
            if count.value < 2 || s < 0.0 {
                let (span, what) = match count.value < 2 {
                    true => (&count.span, say!("two readings or more in every group")),
                    false => (
                        &table.s.as_ref()?.value[index].span,
                        say!("no negative standard deviation"),
                    ),
                };
                return self.refuse(
                    Fault::new(
                        GROUPS,
                        span.clone(),
                        say!("group {} of {} cannot be", index + 1, context.owner),
                    )
                    .label(say!("expected {what}")),
                );
            }
            let count = usize::try_from(count.value).ok()?;
            found.push(Group::summary(Dd::from(mean), s, count));
        }
        Some(found)
    }
}

/// The list under a name, made when it is not there yet.
fn entry<T: Default>(list: &mut Labelled<T>, name: String) -> &mut T {
    let place = list.iter().position(|(other, _)| *other == name);
    let place = place.unwrap_or_else(|| {
        list.push((name, T::default()));
        list.len() - 1
    });
    &mut list[place].1
}

fn evaluated(uncertainty: Uncertainty, how: String, mean: f64, finding: Finding) -> Evaluated {
    Evaluated {
        u: uncertainty.u,
        dof: uncertainty.dof,
        how,
        mean: Some(mean),
        findings: vec![finding],
    }
}

/// What was done with a difference, for the column that says how u was found.
fn outcome(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Included => "differ (included)",
        Verdict::Negative => "do not differ (pooled)",
        Verdict::NotSignificant => "do not differ significantly (pooled)",
        Verdict::Ignored => "are taken as one population",
    }
}

fn too_few(request: &Request<'_>, found: Said, expected: Said) -> Fault {
    Fault::new(
        GROUPS,
        request.place.clone(),
        say!("{found} of readings of {}", request.owner),
    )
    .label(say!("expected {expected}"))
    .help(say!("readings that are not in groups are `readings = […]`"))
}

fn no_scatter(request: &Request<'_>) -> Fault {
    Fault::new(
        NO_SCATTER,
        request.place.clone(),
        say!("the readings of {} do not scatter within their groups", request.owner),
    )
    .label(say!("equal within every group"))
    .help(say!("the scatter is below the resolution: state the means as `readings`, and the resolution, {{ step = … }}, beside them"))
}
