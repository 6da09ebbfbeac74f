//! The statistics of a fleet as a document.

mod machine;
mod plots;
mod tables;
mod words;

use gumption_fault::say;
use gumption_fleet::{Fleet, Measurand};
use gumption_format::document::{Block, Document};
use gumption_format::machine as forms;
use serde_json::Value;

use crate::language::Language;
use machine::FleetJson;

/// The document of a fleet; `table` is the name of its table.
pub fn fleet(fleet: &Fleet, table: &str, language: Language) -> Document {
    let shown = Shown { fleet, l: language };
    let machine = FleetJson::of(table, fleet);
    Document::new(&machine, language, shown.blocks(table))
}

/// JSON Schema of the output of `gumption fleet --json`.
pub fn fleet_schema() -> Value {
    forms::schema::<FleetJson>("gumption fleet --json")
}

/// Groups that a reader takes in; the machine form has all of them.
const MOST_GROUPS: usize = 60;

/// Whether the items differ from each other by so much that no mean of them is a reference.
fn differ(one: &Measurand) -> bool {
    one.reference.is_none() && !one.agreement.is_the_rule()
}

/// A fleet in a language.
#[derive(Clone, Copy)]
struct Shown<'f> {
    fleet: &'f Fleet,
    l: Language,
}

impl Shown<'_> {
    fn blocks(self, table: &str) -> Vec<Block> {
        let l = self.l;
        let mut blocks = vec![
            Block::Title(say!("What the results say together: {table}").in_language(l)),
            Block::Fields(self.fields()),
        ];
        for one in &self.fleet.measurands {
            blocks.extend(self.estimates(one));
            blocks.extend(self.agreement(one));
            blocks.extend(self.drift(one));
            blocks.extend(self.components(one));
        }
        let counts = self.counts();
        if !counts.rows.is_empty() {
            let head = l.pick("Faults, findings, verdicts", "错误、提示与判定");
            blocks.push(Block::Section(head.into()));
            blocks.push(Block::Table(counts));
        }
        blocks.push(Block::Footer(self.sources()));
        blocks
    }

    /// Where the estimates lie, and whether they scatter as u says.
    fn estimates(self, one: &Measurand) -> Vec<Block> {
        let l = self.l;
        let head = say!("Estimates of {}, and their scatter", one.name).in_language(l);
        let mut blocks = vec![
            Block::Section(head),
            Block::Table(self.estimates_table(one)),
        ];
        blocks.push(Block::List(self.consistency(one)));
        blocks.extend(self.estimates_plot(one).map(Block::Plot));
        blocks.extend(self.deviations_plot(one).map(Block::Plot));
        blocks
    }

    fn agreement(self, one: &Measurand) -> Vec<Block> {
        if one.agreement.tested == 0 {
            return Vec::new();
        }
        let head = say!("E_n of {}", one.name).in_language(self.l);
        let mut blocks = vec![
            Block::Section(head),
            Block::Paragraph(self.agreement_words(one)),
        ];
        if !one.agreement.apart.is_empty() && !differ(one) {
            blocks.push(Block::Table(self.apart_table(one)));
        }
        blocks
    }

    fn drift(self, one: &Measurand) -> Vec<Block> {
        let Some(drift) = &one.drift else {
            return Vec::new();
        };
        let head = say!("Drift of {}", one.name).in_language(self.l);
        let mut blocks = vec![
            Block::Section(head),
            Block::Paragraph(self.drift_words(drift)),
        ];
        if drift.devices > 0 {
            blocks.push(Block::Table(self.drift_table(one, drift)));
        }
        if !drift.apart.is_empty() {
            blocks.push(Block::Table(self.drifting_table(one, drift)));
        }
        blocks.extend(self.drift_plot(one, drift).map(Block::Plot));
        blocks
    }

    fn components(self, one: &Measurand) -> Vec<Block> {
        if one.groups.iter().all(|group| group.components.is_empty()) {
            return Vec::new();
        }
        let head = say!("What dominates u({})", one.name).in_language(self.l);
        let mut blocks = vec![
            Block::Section(head),
            Block::Table(self.components_table(one)),
        ];
        blocks.extend(self.components_plot(one).map(Block::Plot));
        blocks
    }

    /// The name of a group.
    fn group(self, at: usize) -> String {
        let key = &self.fleet.groups[at].key;
        match key.iter().all(String::is_empty) {
            true if self.fleet.by.is_empty() => self.l.pick("all", "全部").to_owned(),
            true => crate::number::NONE.to_owned(),
            false => key.join(" / "),
        }
    }

    /// The head of the column of groups.
    fn group_head(self) -> String {
        match self.fleet.by.is_empty() {
            true => self.l.pick("group", "组").to_owned(),
            false => self.fleet.by.join(" / "),
        }
    }

    /// The places of the groups that are shown, and how many more there are.
    fn groups(self) -> (std::ops::Range<usize>, usize) {
        let all = self.fleet.groups.len();
        (0..all.min(MOST_GROUPS), all.saturating_sub(MOST_GROUPS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_fleet::Wanted;

    #[test]
    fn items_that_differ_are_not_named_one_by_one() {
        let row = |at: i32, y: f64| format!("D{at},{y},0.01,2\n");
        let table = |y: &dyn Fn(i32) -> f64| -> String {
            let rows = (0..41).map(|at| row(at, y(at)));
            std::iter::once("label,y,u(y),k(y)\n".to_owned())
                .chain(rows)
                .collect()
        };
        let of = |table: String| {
            gumption_fleet::fleet((table.as_bytes(), "table"), &Wanted::default()).expect("results")
        };
        let differing = of(table(&|at| 0.02 * f64::from(at - 20)));
        let shown = Shown {
            fleet: &differing,
            l: Language::English,
        };
        let blocks = shown.agreement(&differing.measurands[0]);
        assert!(!blocks.iter().any(|block| matches!(block, Block::Table(_))));
        assert!(
            shown
                .agreement_words(&differing.measurands[0])
                .contains("none is named")
        );
        let alike = of(table(&|at| if at == 3 { 1.0 } else { 0.0 }));
        let shown = Shown {
            fleet: &alike,
            l: Language::English,
        };
        assert!(shown.agreement_words(&alike.measurands[0]).contains("D3"));
    }
}
