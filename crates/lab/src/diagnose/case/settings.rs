//! How rows are averaged, and how the diagnosis is run.

use super::columns::nearly;
use super::rows::interval;
use super::{Asked, Averaging, Blocks, Column, Role, Settings};
use crate::diagnose::catalogue::{Effect, Kind, effects};
use crate::diagnose::faults::{ROLE, SETTING, UNKNOWN_NAME};
use crate::experiment::checker::Checker;
use crate::experiment::entries::AverageEntry;
use crate::experiment::tables::{DiagnosisTable, ExperimentTable};
use gumption_fault::{Fault, say};
use gumption_format::toml::{Amount, Stated};

impl Checker<'_> {
    pub(super) fn averaging(&mut self, file: &ExperimentTable, columns: &[Column]) -> Averaging {
        let table = file.recording.as_ref().map(|stated| stated.value.0.clone());
        let table = table.unwrap_or_default();
        let settle = self.settle(table.settle.as_deref(), columns);
        let blocks = match (&table.dwells, &table.average) {
            (Some(names), _) => {
                let mut found = Vec::new();
                for name in &names.value.0 {
                    let Some(column) = self.known(name, columns) else {
                        continue;
                    };
                    if columns[column].labels().is_none() {
                        let message = say!("{} holds numbers, not labels", name.value);
                        let expected = say!("expected a run, factor or position");
                        self.wrong(ROLE, &name.span, message, expected);
                    }
                    found.push(column);
                }
                Blocks::Dwells(found)
            }
            (None, None) => Blocks::Auto,
            (None, Some(stated)) => match stated.value {
                AverageEntry::Auto => Blocks::Auto,
                AverageEntry::Nothing => Blocks::Rows,
                AverageEntry::AtMost(most) => Blocks::AtMost(most.max(1) as usize),
            },
        };
        Averaging { blocks, settle }
    }

    /// Rows that are left out at the beginning of each dwell; a time counts by the usual interval.
    fn settle(&mut self, stated: Option<&Stated<Amount>>, columns: &[Column]) -> usize {
        let Some(stated) = stated else { return 0 };
        let timed = columns.iter().find(|column| column.role == Role::Time);
        let Some((column, times)) = timed.and_then(|c| c.numbers().map(|times| (c, times))) else {
            if stated.value.unit.is_some() {
                let message = say!("a time to settle needs a column with the role \"time\"");
                let fault = Fault::new(SETTING, stated.span.clone(), message);
                self.faults.push(
                    fault
                        .label(say!("no column of time"))
                        .help(say!("state rows: settle = 5")),
                );
            }
            return stated.value.number.max(0.0) as usize;
        };
        let rows = |settle: f64| (settle / interval(times)).ceil().max(0.0) as usize;
        self.amount(stated, &column.unit).map_or(0, rows)
    }

    pub(super) fn settings(&mut self, file: &ExperimentTable) -> Settings {
        let table = file.diagnosis.as_ref().map(|stated| stated.value.clone());
        let table = table.unwrap_or_default();
        let alpha = table.alpha.as_ref();
        let is_small = |alpha: f64| alpha > 0.0 && alpha < 0.5;
        if let Some(stated) = alpha.filter(|alpha| !is_small(alpha.value)) {
            let alpha = stated.value;
            let message = say!("alpha = {alpha} is not a small probability");
            let expected = say!("expected a number between 0 and 0.5");
            self.wrong(SETTING, &stated.span, message, expected);
        }
        let excluded = table.exclude.as_ref();
        Settings {
            alpha: alpha.map_or(0.01, |alpha| alpha.value),
            catalogue: table.catalogue.as_ref().map(|list| self.in_catalogue(list)),
            exclude: excluded.map_or_else(Vec::new, |list| self.in_catalogue(list)),
            seed: table.seed.as_ref().map_or(1, |seed| seed.value),
            draws: self.draws(&table),
            typical: self.typical(&table),
            asked: Asked::Nothing,
        }
    }

    /// Simulated recordings for the false-alarm rate: enough for alpha, and done in a reasonable time.
    fn draws(&mut self, table: &DiagnosisTable) -> usize {
        const RANGE: std::ops::RangeInclusive<u64> = 200..=100_000;
        let Some(draws) = &table.draws else {
            return 2000;
        };
        if !RANGE.contains(&draws.value) {
            let message = say!("draws = {} is too few or too many", draws.value);
            let (least, most) = (RANGE.start(), RANGE.end());
            let expected = say!("expected a number from {} to {}", least, most);
            self.wrong(SETTING, &draws.span, message, expected);
        }
        draws.value.min(*RANGE.end()) as usize
    }

    /// Names of families and effects, all of which the catalogue must have.
    fn in_catalogue(&mut self, list: &Stated<Vec<Stated<String>>>) -> Vec<String> {
        let known = || {
            let all = effects().iter();
            all.flat_map(|effect| [effect.id.as_str(), effect.family.as_str()])
        };
        for name in &list.value {
            if known().any(|known| known == name.value) {
                continue;
            }
            let message = say!("the catalogue has no family or effect {}", name.value);
            let fault =
                Fault::new(UNKNOWN_NAME, name.span.clone(), message).label(say!("not known"));
            let lists = say!(
                "docs/diagnose.md lists the families; `gumption plan` lists the effects that a case can have"
            );
            self.faults.push(nearly(fault, &name.value, known(), lists));
        }
        list.value.iter().map(|name| name.value.clone()).collect()
    }

    /// Shares of full scale, by the identifiers of effects.
    fn typical(&mut self, table: &DiagnosisTable) -> Vec<(String, f64)> {
        let entries = table.typical.as_ref().map_or(&[][..], |t| &t.value.entries);
        let mut sizes = Vec::new();
        for (id, share) in entries {
            let ids = effects().iter().map(|effect| effect.id.as_str());
            if !ids.clone().any(|known| known == id) {
                let message = say!("the catalogue has no effect {id}");
                let fault =
                    Fault::new(UNKNOWN_NAME, share.key.clone(), message).label(say!("not known"));
                let lists = say!("`gumption plan` lists the effects that a case can have");
                self.faults.push(nearly(fault, id, ids, lists));
            } else if !(share.value > 0.0 && share.value.is_finite()) {
                let message = say!("a typical size is positive");
                let expected = say!("expected a share of full scale such as 1e-4");
                self.wrong(SETTING, &share.span, message, expected);
            } else {
                sizes.push((id.to_string(), share.value));
            }
        }
        sizes
    }
}

impl Settings {
    /// Whether an effect is considered; explanations of the user's own are, unless they are excluded.
    pub fn admits(&self, effect: &Effect) -> bool {
        let named = |word: &String| *word == effect.id.as_str() || *word == effect.family;
        let chosen = (self.catalogue.as_ref()).is_none_or(|list| list.iter().any(named));
        (chosen || effect.kind == Kind::Own) && !self.exclude.iter().any(named)
    }
}
