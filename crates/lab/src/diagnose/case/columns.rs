//! The columns that take part, and their rows.

use std::ops::Range;

use super::checker::Checker;
use super::{Column, Data, Purpose};
use crate::diagnose::faults::{TOO_FEW, UNKNOWN_NAME};
use crate::experiment::entries::RoleWord;
use crate::experiment::tables::{ColumnTable, ExperimentTable, HoldsWord};
use crate::recording::{Content, Heading, Labels, Recording, Request};
use gumption_core::model::Symbol;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest};
use gumption_format::toml::Stated;
use gumption_format::toml::{Amount, OneOrMany};
use gumption_gum::budget::writing::key;

impl Checker<'_> {
    /// The columns that take part: the declared ones, and those that only the model names.
    pub fn wanted(
        &mut self,
        file: &ExperimentTable,
        models: &Stated<OneOrMany<String>>,
        headings: &[Heading],
        constants: &[Symbol],
    ) -> Vec<Wanted> {
        let mut wanted = Vec::new();
        let declared = file
            .columns
            .as_ref()
            .map_or(&[][..], |named| named.value.entries.as_slice());
        for (name, stated) in declared {
            let table = &stated.value.0;
            let role = match &table.role {
                Some(role) => role.value,
                None => self.role_in(models, name, table),
            };
            if role == RoleWord::Ignore {
                continue;
            }
            let header = table.column.as_ref().map_or(name, |column| &column.value);
            let present = headings
                .iter()
                .any(|h| h.text == *header || h.name == *header);
            let expected = self.purpose == Purpose::Plan && role == RoleWord::Output;
            // What a procedure can use need not be there.
            let offered = self.source.is_base(&stated.key)
                && matches!(role, RoleWord::Covariate | RoleWord::Factor);
            if !present && offered {
                continue;
            }
            if !present && !expected {
                let asked = table.column.as_ref();
                let span = asked.map_or(&stated.key, |column| &column.span).clone();
                let renamed = asked.is_none().then(|| {
                    let role = role.word();
                    format!("{} = {{ role = \"{role}\", column = \"…\" }}", key(name))
                });
                self.faults
                    .push(no_column(header, span, headings, renamed.as_deref()));
                continue;
            }
            let unit = match &table.unit {
                Some(unit) => self.unit(Some(unit)),
                None => None,
            };
            wanted.push(Wanted::new(
                name,
                header,
                role,
                unit,
                present,
                Some((stated.key.clone(), table.clone())),
            ));
        }
        let known = |name: &str, wanted: &[Wanted]| {
            constants.iter().any(|constant| constant.name == name)
                || wanted.iter().any(|w| w.name == name)
                || declared.iter().any(|(declared, _)| declared == name)
        };
        for model in &models.value.0 {
            let Ok(outline) = gumption_core::model::outline(&model.value, &self.units) else {
                continue;
            };
            let given = outline
                .gives
                .iter()
                .map(|(name, _)| (name, RoleWord::Output));
            let needed = outline
                .needs
                .iter()
                .map(|(name, _)| (name, RoleWord::Stimulus));
            for (name, role) in given.chain(needed) {
                let heading = headings.iter().any(|h| h.text == *name || h.name == *name);
                if heading && !known(name, &wanted) {
                    wanted.push(Wanted::new(name, name, role, None, true, None));
                }
            }
        }
        wanted
    }

    /// The role that a column has by its place in the equations.
    fn role_in(
        &self,
        models: &Stated<OneOrMany<String>>,
        name: &str,
        table: &ColumnTable,
    ) -> RoleWord {
        let outlines = models.value.0.iter();
        let outlines: Vec<_> = outlines
            .filter_map(|model| gumption_core::model::outline(&model.value, &self.units).ok())
            .collect();
        let holds = table.holds.as_ref().map(|word| word.value);
        if holds == Some(HoldsWord::Labels) {
            RoleWord::Factor
        } else if outlines
            .iter()
            .any(|outline| outline.gives.iter().any(|(given, _)| given == name))
        {
            RoleWord::Output
        } else if outlines
            .iter()
            .any(|outline| outline.needs.iter().any(|(needed, _)| needed == name))
        {
            RoleWord::Stimulus
        } else {
            RoleWord::Covariate
        }
    }

    /// The columns without the rows that lack a value.
    pub fn columns(
        &mut self,
        wanted: &[Wanted],
        recorded: &Recording,
    ) -> (Vec<Column>, usize, usize) {
        let all = recorded.rows();
        let complete: Vec<usize> = (0..all)
            .filter(|row| {
                wanted.iter().all(|w| match recorded.numbers(&w.name) {
                    Some(numbers) => !w.present || numbers[*row].is_finite(),
                    None => true,
                })
            })
            .collect();
        let mut columns = Vec::new();
        for w in wanted {
            let column = recorded.column(&w.name);
            let unit = match (column.and_then(|c| c.unit.clone()), &w.unit) {
                (_, Some(unit)) => unit.clone(),
                (Some(unit), None) => unit,
                (None, None) => Unit::one(),
            };
            let data = if !w.present {
                Data::Absent
            } else if let Some(numbers) = recorded.numbers(&w.name) {
                Data::Numbers(complete.iter().map(|row| numbers[*row]).collect())
            } else if let Some(labels) = recorded.labels(&w.name) {
                Data::Labels(Labels {
                    levels: labels.levels.clone(),
                    of_row: complete.iter().map(|row| labels.of_row[*row]).collect(),
                })
            } else {
                Data::Absent
            };
            let table = w.stated.as_ref().map(|(_, table)| table);
            let mut amount = |of: fn(&ColumnTable) -> &Option<Stated<Amount>>| {
                let stated = of(table?).as_ref()?;
                self.spread(stated, &unit)
            };
            let (u, u_common) = (amount(|t| &t.u), amount(|t| &t.u_common));
            let full_scale = amount(|t| &t.full_scale);
            let resolution = amount(|t| &t.resolution);
            columns.push(Column {
                name: w.name.clone(),
                header: column.map_or_else(|| w.header.clone(), |c| c.header.clone()),
                role: w.role,
                unit,
                data,
                u,
                u_common,
                full_scale,
                resolution,
                as_difference: false,
            });
        }
        (columns, complete.len(), all - complete.len())
    }

    /// A column that a key names.
    pub fn known(&mut self, name: &Stated<String>, columns: &[Column]) -> Option<usize> {
        let found = columns.iter().position(|column| column.name == name.value);
        if found.is_none() {
            let names = columns.iter().map(|column| column.name.as_str());
            let fault = Fault::new(
                UNKNOWN_NAME,
                name.span.clone(),
                format!("the experiment has no column {}", name.value),
            )
            .label("not a column of this experiment");
            self.faults.push(match nearest(&name.value, names) {
                Some(near) => fault.help(format!("did you mean \"{near}\"?")),
                None => fault.help("declare it below [columns]"),
            });
        }
        found
    }
}

/// A column that the recording does not have; `renamed` declares another one under its name.
fn no_column(name: &str, span: Range<usize>, headings: &[Heading], renamed: Option<&str>) -> Fault {
    let names: Vec<&str> = headings.iter().map(|h| h.name.as_str()).collect();
    let texts = headings.iter().map(|h| h.text.as_str());
    let near = nearest(name, names.iter().copied().chain(texts));
    let help = match (near, renamed) {
        (Some(near), _) => format!("did you mean \"{near}\"?"),
        (None, None) => format!("its columns are: {}", names.join(", ")),
        (None, Some(renamed)) => format!(
            "its columns are: {}; to call one of them {name}, write {renamed}",
            names.join(", ")
        ),
    };
    Fault::new(
        UNKNOWN_NAME,
        span,
        format!("the recording has no column \"{name}\""),
    )
    .label("not in the first line of the recording")
    .help(help)
}

/// No row has all that the case declares: the column that lacks most of it.
pub(super) fn nothing_left(
    file: &Stated<String>,
    wanted: &[Wanted],
    recorded: &Recording,
) -> Fault {
    let lacks = |one: &Wanted| {
        let numbers = recorded.numbers(&one.name).unwrap_or_default();
        numbers.iter().filter(|x| !x.is_finite()).count()
    };
    let fault = Fault::new(
        TOO_FEW,
        file.span.clone(),
        format!(
            "no row of {} has a number in every declared column",
            file.value
        ),
    )
    .label("this recording");
    let emptiest = wanted
        .iter()
        .filter(|one| one.present)
        .max_by_key(|one| lacks(one));
    match emptiest {
        Some(one) if lacks(one) > 0 => fault.help(format!(
            "`{}` has none in {} of {} rows; a column that does not matter may have the role \"ignore\"",
            one.name,
            lacks(one),
            recorded.rows()
        )),
        _ => fault,
    }
}

/// A column that is asked of the recording.
pub(super) struct Wanted {
    name: String,
    header: String,
    role: RoleWord,
    unit: Option<Unit>,
    pub present: bool,
    stated: Option<(Range<usize>, ColumnTable)>,
    pub request: Request,
}

impl Wanted {
    fn new(
        name: &str,
        header: &str,
        role: RoleWord,
        unit: Option<Unit>,
        present: bool,
        stated: Option<(Range<usize>, ColumnTable)>,
    ) -> Wanted {
        let content = match role {
            RoleWord::Run
            | RoleWord::Factor
            | RoleWord::Position
            | RoleWord::Axis
            | RoleWord::Direction => Content::Labels,
            _ => Content::Numbers,
        };
        let request = Request {
            content,
            unit: unit.clone(),
            ..Request::numbers(name, header)
        };
        Wanted {
            name: name.to_owned(),
            header: header.to_owned(),
            role,
            unit,
            present,
            stated,
            request,
        }
    }
}
