//! The tables of a fleet.

use gumption_fault::say;
use gumption_fleet::{Consistency, Drift, Measurand};
use gumption_format::document::ColumnKind::{Marks, Names, Numbers, Words};
use gumption_format::document::{Cell, Column, ColumnKind, Row, Table};

use super::Shown;
use crate::number::{NONE, TABLE_DIGITS, aligned, grouped, in_unit, percent, significant};
use crate::symbol;

/// A sign beside what is named.
const NAMED: &str = "●";

impl Shown<'_> {
    pub fn fields(self) -> Vec<(String, String)> {
        let l = self.l;
        let faulty = self.fleet.groups.iter().flat_map(|group| &group.faulty);
        let faulty: usize = faulty.map(|(_, rows)| rows).sum();
        let field = |name: &str, value: String| (name.to_owned(), value);
        let mut fields = vec![
            field(l.pick("Rows", "行数"), grouped(self.fleet.rows as u64)),
            field(l.pick("Without a result", "无结果"), grouped(faulty as u64)),
        ];
        if !self.fleet.by.is_empty() {
            let groups = grouped(self.fleet.groups.len() as u64);
            let by = self.fleet.by.join(", ");
            let groups = say!("{groups}, by {by}").in_language(l);
            fields.push(field(l.pick("Groups", "分组"), groups));
        }
        fields
    }

    pub fn estimates_table(self, one: &Measurand) -> Table {
        let l = self.l;
        let unit = symbol(&one.unit);
        let head = |text: &str| in_unit(text, &unit);
        let mut table = table(&[
            (&self.group_head(), Names),
            (l.pick("n", "n"), Numbers),
            (&head(l.pick("mean", "平均值")), Numbers),
            (&head(l.pick("smallest", "最小值")), Numbers),
            (&head(l.pick("largest", "最大值")), Numbers),
            (&head("s"), Numbers),
            (&head("u"), Numbers),
            (l.pick("Birge", "Birge 比"), Numbers),
            ("p(χ²)", Numbers),
            (&head("x̄"), Numbers),
            (&head("u(x̄)"), Numbers),
        ]);
        self.for_groups(&mut table, |at| {
            let group = &one.groups[at];
            let scale = if group.u > 0.0 {
                group.u
            } else {
                group.s.unwrap_or_default()
            };
            let digits = |x: f64| aligned(x, scale, TABLE_DIGITS);
            let some = |x: Option<f64>| x.map_or(NONE.to_owned(), |x| significant(x, TABLE_DIGITS));
            let known = group.values > 0;
            let number = |x: f64| if known { digits(x) } else { NONE.to_owned() };
            let weighted = |of: fn(&Consistency) -> String| {
                group.consistency.as_ref().map_or(NONE.to_owned(), of)
            };
            vec![vec![
                self.group(at),
                grouped(group.values as u64),
                number(group.mean),
                number(group.range[0]),
                number(group.range[1]),
                some(group.s),
                some(Some(group.u).filter(|u| u.is_finite())),
                weighted(|one| significant(one.birge, TABLE_DIGITS)),
                weighted(|one| probability(one.p_larger)),
                weighted(|one| aligned(one.mean, one.u, TABLE_DIGITS)),
                weighted(|one| significant(one.u, TABLE_DIGITS)),
            ]]
        });
        table
    }

    pub fn apart_table(self, one: &Measurand) -> Table {
        let l = self.l;
        let unit = symbol(&one.unit);
        let other = match &one.reference {
            Some(name) => name.as_str(),
            None => l.pick("the others", "其余器件"),
        };
        let mut table = table(&[
            (l.pick("device", "器件"), Names),
            (&self.group_head(), Names),
            (l.pick("row", "行"), Numbers),
            (&in_unit(&one.name, &unit), Numbers),
            (&in_unit(other, &unit), Numbers),
            ("E_n", Numbers),
            (l.pick("p over all", "总体 p"), Numbers),
            ("", Marks),
        ]);
        for apart in one.agreement.apart.iter().take(super::MOST_GROUPS) {
            let scale = one.groups[apart.group].u;
            let mark = if apart.is_named() { NAMED } else { "" };
            table.push(cells(vec![
                apart.device.clone(),
                self.group(apart.group),
                grouped(apart.row as u64),
                aligned(apart.estimate, scale, TABLE_DIGITS),
                aligned(apart.other, scale, TABLE_DIGITS),
                significant(apart.en, TABLE_DIGITS),
                probability(apart.probability),
                mark.to_owned(),
            ]));
        }
        self.more(
            &mut table,
            one.agreement.beyond.saturating_sub(super::MOST_GROUPS),
        );
        without_groups(table, self.fleet.by.is_empty(), 1)
    }

    pub fn drift_table(self, one: &Measurand, drift: &Drift) -> Table {
        let l = self.l;
        let unit = per_year(&symbol(&one.unit));
        let mut table = table(&[
            (&self.group_head(), Names),
            (l.pick("devices", "器件数"), Numbers),
            (&in_unit(l.pick("mean rate", "平均速率"), &unit), Numbers),
            (&in_unit("s", &unit), Numbers),
            (&in_unit("u", &unit), Numbers),
            (l.pick("beyond U", "超出 U"), Numbers),
            (l.pick("expected", "期望数"), Numbers),
            (l.pick("pairs", "相邻对"), Numbers),
            ("|E_n| > 1", Numbers),
        ]);
        self.for_groups(&mut table, |at| {
            let group = &drift.groups[at];
            if group.devices == 0 {
                return Vec::new();
            }
            let s = group
                .s
                .map_or(NONE.to_owned(), |s| significant(s, TABLE_DIGITS));
            vec![vec![
                self.group(at),
                grouped(group.devices as u64),
                aligned(group.mean, group.u, TABLE_DIGITS),
                s,
                significant(group.u, TABLE_DIGITS),
                grouped(group.beyond as u64),
                expected(group.expected),
                grouped(group.pairs as u64),
                grouped(group.pairs_beyond as u64),
            ]]
        });
        table
    }

    pub fn drifting_table(self, one: &Measurand, drift: &Drift) -> Table {
        let l = self.l;
        let unit = per_year(&symbol(&one.unit));
        let mut table = table(&[
            (l.pick("device", "器件"), Names),
            (&self.group_head(), Names),
            (l.pick("dates", "次数"), Numbers),
            (&in_unit(l.pick("rate", "速率"), &unit), Numbers),
            (&in_unit("U", &unit), Numbers),
            (l.pick("largest E_n", "最大 E_n"), Numbers),
            (l.pick("p over all", "总体 p"), Numbers),
            ("", Marks),
        ]);
        for one in drift.apart.iter().take(super::MOST_GROUPS) {
            let mark = if one.is_named() { NAMED } else { "" };
            table.push(cells(vec![
                one.device.clone(),
                self.group(one.group),
                grouped(one.calibrations as u64),
                aligned(one.rate, one.u, TABLE_DIGITS),
                significant(one.expanded, TABLE_DIGITS),
                significant(one.en, TABLE_DIGITS),
                probability(one.probability),
                mark.to_owned(),
            ]));
        }
        self.more(&mut table, drift.beyond.saturating_sub(super::MOST_GROUPS));
        without_groups(table, self.fleet.by.is_empty(), 1)
    }

    pub fn components_table(self, one: &Measurand) -> Table {
        let l = self.l;
        let mut table = table(&[
            (&self.group_head(), Names),
            (l.pick("input", "输入量"), Names),
            (l.pick("largest in", "居首行数"), Numbers),
            (l.pick("% of rows", "占行数 %"), Numbers),
            (l.pick("median share / %", "份额中位数 / %"), Numbers),
        ]);
        self.for_groups(&mut table, |at| {
            let group = &one.groups[at];
            let mut all: Vec<_> = group.components.iter().collect();
            all.retain(|one| one.median_share.is_finite());
            all.sort_by(|a, b| b.median_share.total_cmp(&a.median_share));
            let row = |one: &&gumption_fleet::Component| {
                vec![
                    self.group(at),
                    one.name.clone(),
                    grouped(one.dominates as u64),
                    percent(one.dominates as f64 / group.values as f64),
                    percent(one.median_share),
                ]
            };
            all.iter().map(row).collect()
        });
        table
    }

    /// Faults, findings and verdicts of the groups.
    pub fn counts(self) -> Table {
        let l = self.l;
        let mut table = table(&[
            (&self.group_head(), Names),
            (l.pick("what", "类别"), Words),
            (l.pick("code", "代码"), Names),
            (l.pick("rows", "行数"), Numbers),
        ]);
        self.for_groups(&mut table, |at| {
            let group = &self.fleet.groups[at];
            let row = |what: &str, (code, rows): &(String, usize)| {
                vec![
                    self.group(at),
                    what.to_owned(),
                    code.clone(),
                    grouped(*rows as u64),
                ]
            };
            let faulty = group
                .faulty
                .iter()
                .map(|one| row(l.pick("no result", "无结果"), one));
            let findings = group
                .findings
                .iter()
                .map(|one| row(l.pick("finding", "提示"), one));
            let verdicts = group.verdicts.iter().flat_map(|(name, all)| {
                let what = say!("verdict {name}").in_language(l);
                all.iter().map(move |one| row(&what, one))
            });
            faulty.chain(findings).chain(verdicts).collect()
        });
        table
    }

    /// Adds the rows of each group, a line between those of one and the next where there are several.
    fn for_groups(self, table: &mut Table, rows: impl Fn(usize) -> Vec<Vec<String>>) {
        let (groups, more) = self.groups();
        for at in groups {
            let rows = rows(at);
            if rows.len() > 1 && !table.rows.is_empty() {
                table.rows.push(Row::Rule);
            }
            rows.into_iter().for_each(|row| table.push(cells(row)));
        }
        self.more(table, more);
    }

    fn more(self, table: &mut Table, more: usize) {
        if more > 0 {
            let more = grouped(more as u64);
            table.rows.push(Row::Across(
                say!("{more} more: see --json").in_language(self.l),
            ));
        }
    }
}

fn table(columns: &[(&str, ColumnKind)]) -> Table {
    let column = |(head, kind): &(&str, ColumnKind)| Column {
        head: (*head).to_owned(),
        kind: *kind,
    };
    Table {
        columns: columns.iter().map(column).collect(),
        rows: Vec::new(),
    }
}

fn cells(texts: Vec<String>) -> Vec<Cell> {
    texts.into_iter().map(Cell::from).collect()
}

/// Without the column of groups where there is one group only.
fn without_groups(mut table: Table, alone: bool, column: usize) -> Table {
    if alone {
        table.columns.remove(column);
        for row in &mut table.rows {
            if let Row::Cells(cells) = row {
                cells.remove(column);
            }
        }
    }
    table
}

/// A probability: two digits, and what is too small to be one as such.
pub(super) fn probability(p: f64) -> String {
    /// Beyond it tails say nothing of real distributions.
    const SMALLEST: f64 = 1e-6;
    match p < SMALLEST {
        true => "< 10^-6".to_owned(),
        false => significant(p, 2),
    }
}

/// How many chance lets expect: whole ones where there are many.
pub(super) fn expected(count: f64) -> String {
    /// Below it two digits have a decimal.
    const MANY: f64 = 10.0;
    match count < MANY {
        true => significant(count, 2),
        false => grouped(count.round() as u64),
    }
}

/// The unit of a rate.
pub(super) fn per_year(unit: &str) -> String {
    match unit {
        "" => "1/a".to_owned(),
        compound if compound.contains(['/', '·', ' ']) => format!("({compound})/a"),
        simple => format!("{simple}/a"),
    }
}
