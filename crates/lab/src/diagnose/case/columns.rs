//! The columns of a case, and their rows.

use super::{Column, Data};
use crate::diagnose::faults::{TOO_FEW, UNKNOWN_NAME};
use crate::experiment::checker::Checker;
use crate::experiment::columns::Column as Wanted;
use crate::experiment::entries::RoleWord;
use crate::experiment::tables::ColumnTable;
use crate::recording::Recording;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Said, nearest, say};
use gumption_format::toml::{Amount, Slot, Stated};

impl Checker<'_> {
    /// A column that a key names.
    pub(super) fn known(&mut self, name: &Stated<String>, columns: &[Column]) -> Option<usize> {
        let found = columns.iter().position(|column| column.name == name.value);
        if found.is_none() {
            let names = columns.iter().map(|column| column.name.as_str());
            let message = say!("the experiment has no column {}", name.value);
            let fault = Fault::new(UNKNOWN_NAME, name.span.clone(), message)
                .label(say!("not a column of this experiment"));
            let declare = say!("declare it below [columns]");
            self.faults.push(nearly(fault, &name.value, names, declare));
        }
        found
    }

    /// The columns without the rows that lack a value, how many rows are left, and how many are not.
    pub(super) fn rows_of(
        &mut self,
        wanted: &[Wanted<'_>],
        recorded: &Recording,
    ) -> (Vec<Column>, usize, usize) {
        let all = recorded.rows();
        let there = wanted.iter().filter(|w| w.is_there);
        let there: Vec<&[f64]> = there.filter_map(|w| recorded.numbers(&w.name)).collect();
        let is_complete = |row: &usize| there.iter().all(|numbers| numbers[*row].is_finite());
        let complete: Vec<usize> = (0..all).filter(is_complete).collect();
        let mut columns = Vec::new();
        for w in wanted {
            let column = recorded.column(&w.name);
            let unit = match (column.and_then(|c| c.unit.clone()), &w.unit) {
                (_, Some(unit)) => unit.clone(),
                (Some(unit), None) => unit,
                // A plan has no readings; the unit of its responses is stated, or follows.
                (None, None) if !w.is_there => self.planned_unit(&w.name).unwrap_or_else(Unit::one),
                (None, None) => Unit::one(),
            };
            let data = match (recorded.numbers(&w.name), recorded.labels(&w.name)) {
                _ if !w.is_there => Data::Absent,
                (Some(numbers), _) => Data::Numbers(numbers.to_vec()),
                (None, Some(labels)) => Data::Labels(labels.clone()),
                (None, None) => Data::Absent,
            };
            let mut amount = |of: fn(&ColumnTable) -> &Slot<Amount>| {
                let stated = of(w.table?).as_ref()?;
                self.spread(stated, &unit)
            };
            let (u, u_common) = (amount(|t| &t.u), amount(|t| &t.u_common));
            let full_scale = amount(|t| &t.full_scale);
            let resolution = amount(|t| &t.resolution);
            columns.push(Column {
                header: column.map_or_else(|| w.header.clone(), |c| c.header.clone()),
                u,
                u_common,
                full_scale,
                resolution,
                epoch: column.and_then(|column| column.epoch),
                ..Column::new(&w.name, w.role, &unit, data.taken(&complete))
            });
        }
        (columns, complete.len(), all - complete.len())
    }
}

impl Column {
    /// A column of which nothing else is stated.
    pub(in crate::diagnose) fn new(name: &str, role: RoleWord, unit: &Unit, data: Data) -> Column {
        Column {
            name: name.to_owned(),
            header: name.to_owned(),
            role,
            unit: unit.clone(),
            data,
            u: None,
            u_common: None,
            full_scale: None,
            resolution: None,
            epoch: None,
            as_difference: false,
        }
    }

    /// A stimulus that no instrument recorded: a set input, a quantity that positions give.
    pub(super) fn applied(name: &str, unit: &Unit, values: Vec<f64>) -> Column {
        Column::new(name, RoleWord::Stimulus, unit, Data::Numbers(values))
    }
}

/// No row has all that the case declares: the column that lacks most of it.
pub(super) fn nothing_left(
    file: &Stated<String>,
    wanted: &[Wanted<'_>],
    recorded: &Recording,
) -> Fault {
    let lacks = |one: &Wanted<'_>| {
        let numbers = recorded.numbers(&one.name).unwrap_or_default();
        numbers.iter().filter(|x| !x.is_finite()).count()
    };
    let message = say!(
        "no row of {} has a number in every declared column",
        file.value
    );
    let fault = Fault::new(TOO_FEW, file.span.clone(), message).label(say!("this recording"));
    let there = wanted.iter().filter(|one| one.is_there);
    match there.max_by_key(|one| lacks(one)) {
        Some(one) if lacks(one) > 0 => fault.help(say!(
            "`{}` has none in {} of {} rows; a column that does not matter may have the role \"ignore\"",
            one.name,
            lacks(one),
            recorded.rows()
        )),
        _ => fault,
    }
}

/// A name that is not known, with the one of the known names that it is nearly; with other help where there is none.
pub(super) fn nearly<'k>(
    fault: Fault,
    name: &str,
    known: impl Iterator<Item = &'k str>,
    otherwise: Said,
) -> Fault {
    match nearest(name, known) {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault.help(otherwise),
    }
}
