//! A series: the same budget once per row, as compact tables: results, claims, repetitions.

use gumption_fault::say;
use gumption_gum::budget::{Conformity, Figure};
use gumption_gum::propagate::{Clause8, Comparison};

use crate::figures::Figures;
use crate::language::Word;
use crate::number::{
    NONE, STYLE, TABLE_DIGITS, aligned, at_place, exact, freedom, print, probability, significant,
};
use crate::{Report, claim, decisions, remarks, symbol};
use gumption_format::document::{Block, Cell, Column, ColumnKind, Finding, Table};

/// The rows of a series.
pub(super) fn blocks(rows: &[Report<'_>]) -> Vec<Block> {
    let Some(first) = rows.first() else {
        return Vec::new();
    };
    let l = first.language;
    let mut blocks = vec![Block::Title(first.title())];
    for measurand in 0..first.evaluation.results.len() {
        let (name, unit) = first.measurand(measurand);
        let unit = symbol(unit);
        let titled = |words: &str| {
            let words = if words.is_empty() {
                String::new()
            } else {
                l.with_head("", words)
            };
            Block::Section(if unit.is_empty() {
                format!("{name}{words}")
            } else {
                say!("{name}{words}, in {unit}").in_language(l)
            })
        };
        let series = Series {
            rows,
            measurand,
            judged: rows.iter().map(|r| claim::judged(r, measurand)).collect(),
        };
        blocks.push(titled(""));
        blocks.push(Block::Table(series.results().without_empty_columns()));
        blocks.extend(series.below().map(Block::Paragraph));
        if series.judged.iter().any(|claims| !claims.is_empty()) {
            let title = Word::Claim.of(l);
            blocks.push(match series.one_figure() {
                Some(figure) => titled(&[title, &figure].join(l.comma())),
                None => Block::Section(l.with_head(name, title)),
            });
            blocks.push(Block::Table(series.claims().without_empty_columns()));
        }
        let repetitions = series.repetitions();
        if first.budget.heading.repetitions && !repetitions.rows.is_empty() {
            blocks.push(titled(l.pick("repetitions", "重复性")));
            blocks.push(Block::Table(repetitions));
        }
    }
    let common = common_remarks(rows);
    if !common.is_empty() {
        blocks.push(Block::Section(Word::Remarks.of(l).to_string()));
        blocks.push(Block::Findings(common));
    }
    blocks
}

/// One measurand in all rows.
struct Series<'a> {
    rows: &'a [Report<'a>],
    measurand: usize,
    /// The judged claims of each row.
    judged: Vec<Vec<Comparison>>,
}

impl Series<'_> {
    fn figures(&self) -> impl Iterator<Item = Figures<'_>> {
        self.rows
            .iter()
            .map(|row| Figures::new(row, self.measurand))
    }

    /// The one k of all rows, if it is one.
    fn one_factor(&self) -> Option<String> {
        let mut all = self.figures().map(|figures| figures.k());
        let first = all.next()??;
        all.all(|k| k.as_ref() == Some(&first)).then_some(first)
    }

    fn results(&self) -> Table {
        let first = &self.rows[0];
        let l = first.language;
        let p = probability(first.coverage_probability());
        let reported = say!("{p} interval").in_language(l);
        let interval = say!("{p} interval, Monte Carlo").in_language(l);
        let mut table = Table::new([
            (Word::Row.of(l), ColumnKind::Names),
            ("y", ColumnKind::Numbers),
            ("u", ColumnKind::Numbers),
            ("k", ColumnKind::Numbers),
            ("U", ColumnKind::Numbers),
            (reported.as_str(), ColumnKind::Numbers),
            (interval.as_str(), ColumnKind::Numbers),
            (l.pick("validated", "通过验证"), ColumnKind::Words),
        ]);
        let assessed = first.budget.conformity.iter().enumerate();
        let assessed = assessed.filter(|(_, stated)| stated.measurand == self.measurand);
        let assessed: Vec<(usize, &Conformity)> = assessed.collect();
        let (name, _) = first.measurand(self.measurand);
        table
            .columns
            .extend(assessed.iter().map(|(_, stated)| Column {
                head: match stated.name == name {
                    true => l.pick("verdict", "结论").to_string(),
                    false => say!("verdict, {}", stated.name).in_language(l),
                },
                kind: ColumnKind::Words,
            }));
        let several_factors = self.one_factor().is_none();
        let cell = |text: Option<String>| text.map_or(Cell::Empty, Cell::from);
        for (report, figures) in self.rows.iter().zip(self.figures()) {
            let result = &report.evaluation.results[self.measurand];
            let brackets = |[low, high]: [String; 2]| format!("[{low}, {high}]");
            let trials = result.monte_carlo.as_ref().map_or(Cell::Empty, |mc| {
                let scale = mc.u.unwrap_or(result.gum.u);
                brackets(mc.symmetric.map(|x| aligned(x, scale, TABLE_DIGITS))).into()
            });
            let digits = report.budget.conventions.digits.clamp(1, 2);
            let verdict = result
                .validation
                .iter()
                .flatten()
                .find(|v| v.digits == digits)
                .map_or("", |v| verdict_word(report, v.verdict));
            let k = figures.k().filter(|_| several_factors);
            let decided = assessed.iter().map(|(index, _)| {
                let found = report.evaluation.conformity.get(*index);
                let verdict = found.and_then(|found| found.verdict);
                cell(verdict.map(|verdict| decisions::verdict_word(l, verdict).to_string()))
            });
            let mut cells = vec![
                report.label.unwrap_or_default().into(),
                figures.estimate().into(),
                cell(figures.u()),
                cell(k),
                cell(figures.expanded()),
                cell(figures.interval().map(brackets)),
                trials,
                verdict.into(),
            ];
            cells.extend(decided);
            table.push(cells);
        }
        table
    }

    /// What the table has no column for.
    fn below(&self) -> Option<String> {
        let first = &self.rows[0];
        let l = first.language;
        let digits = first.budget.conventions.digits;
        let mut sentences = Vec::new();
        if let Some(k) = self.one_factor() {
            sentences.push(say!("U = k·u with k = {k} in every row.").in_language(l));
        }
        let result = |r: &Report<'_>| r.evaluation.results[self.measurand].validation.is_some();
        if self.rows.iter().any(result) {
            let plural = if digits == 1 { "" } else { "s" };
            sentences.push(
                say!("Validated: JCGM 101 clause 8 at {digits} significant digit{plural} of u_c.")
                    .in_language(l),
            );
        }
        (!sentences.is_empty()).then(|| sentences.join(l.pick(" ", "")))
    }

    /// The one figure in the unit of the measurand that all rows claim, if it is one.
    fn one_figure(&self) -> Option<String> {
        let mut all = self.judged.iter().flatten().map(|c| &c.claimed.what);
        let first = all.next()?;
        let in_unit = matches!(
            first,
            Figure::Estimate | Figure::StandardUncertainty | Figure::ExpandedUncertainty
        );
        (in_unit && all.all(|what| what == first)).then(|| claim::label(&self.rows[0], first))
    }

    fn claims(&self) -> Table {
        let one_figure = self.one_figure().is_some();
        let l = self.rows[0].language;
        let largest = self
            .judged
            .iter()
            .flatten()
            .filter_map(|one| one.difference())
            .fold(0.0, |most: f64, d| most.max(d.abs()));
        let ten = power_of_thousand(largest);
        let difference_head = match ten {
            0 => l.pick("difference", "差值").to_string(),
            _ => format!(
                "{} ({})",
                l.pick("difference", "差值"),
                STYLE.power(ten).trim_start_matches('×')
            ),
        };
        let mut table = Table::new([
            (Word::Row.of(l), ColumnKind::Names),
            (l.pick("figure", "量"), ColumnKind::Wrapped),
            (Word::Claimed.of(l), ColumnKind::Numbers),
            (Word::Obtained.of(l), ColumnKind::Numbers),
            (difference_head.as_str(), ColumnKind::Numbers),
            (l.pick("agrees", "一致"), ColumnKind::Wrapped),
        ]);
        for (report, claims) in self.rows.iter().zip(&self.judged) {
            for (n, comparison) in claims.iter().enumerate() {
                let what = &comparison.claimed.what;
                let place = claim::last_place(comparison);
                let number = |x: f64, place: i32| claim::number(what, x, place, l);
                table.push(vec![
                    match n {
                        0 => report.label.unwrap_or_default().into(),
                        _ => Cell::Empty,
                    },
                    if one_figure {
                        Cell::Empty
                    } else {
                        claim::label(report, what).into()
                    },
                    number(comparison.claimed.value, place).into(),
                    comparison
                        .obtained
                        .map_or_else(|| NONE.to_string(), |x| number(x, place - 1))
                        .into(),
                    comparison.difference().map_or(Cell::Empty, |d| {
                        print(&at_place(d, place - 1).shifted(-ten)).into()
                    }),
                    yes_or_no(report, comparison.agrees()).into(),
                ]);
            }
        }
        table
    }

    /// Mean and standard deviation over rows that repeat one another: those whose labels differ in a
    /// last number only, and all where each row is one of them.
    fn repetitions(&self) -> Table {
        let l = self.rows[0].language;
        let mut table = Table::new([
            (l.pick("rows", "行"), ColumnKind::Names),
            ("n", ColumnKind::Numbers),
            (l.pick("mean of y", "y 的均值"), ColumnKind::Numbers),
            (l.pick("s of y", "y 的标准差"), ColumnKind::Numbers),
            (l.pick("mean claimed", "声称值均值"), ColumnKind::Numbers),
            (l.pick("s claimed", "声称值标准差"), ColumnKind::Numbers),
        ]);
        let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
        for (row, report) in self.rows.iter().enumerate() {
            let stem = stem(report.label.unwrap_or_default());
            match groups.iter_mut().find(|(known, _)| *known == stem) {
                Some((_, members)) => members.push(row),
                None => groups.push((stem, vec![row])),
            }
        }
        let repeats = |(stem, members): &(&str, Vec<usize>)| !stem.is_empty() && members.len() > 1;
        if groups.len() > 1 {
            for (stem, members) in groups.iter().filter(|group| repeats(group)) {
                table.push(self.statistics(format!("{stem} …"), members));
            }
        }
        if groups.iter().all(repeats) {
            let everything: Vec<usize> = (0..self.rows.len()).collect();
            table.push(self.statistics(l.pick("all", "全部").to_string(), &everything));
        }
        table.without_empty_columns()
    }

    fn statistics(&self, name: String, members: &[usize]) -> Vec<Cell> {
        let obtained: Vec<f64> = members
            .iter()
            .map(|row| {
                let row = &self.rows[*row];
                let result = &row.evaluation.results[self.measurand];
                result.reported(&row.budget.conventions).estimate
            })
            .collect();
        let claimed: Vec<f64> = members
            .iter()
            .filter_map(|row| {
                let estimate = |c: &&Comparison| c.claimed.what == Figure::Estimate;
                self.judged[*row].iter().find(estimate)
            })
            .map(|c| c.claimed.value)
            .collect();
        let mut cells = vec![name.into(), freedom(members.len() as f64).into()];
        cells.extend(mean_and_deviation(&obtained));
        if claimed.len() == members.len() {
            cells.extend(mean_and_deviation(&claimed));
        }
        cells
    }
}

fn mean_and_deviation(xs: &[f64]) -> [Cell; 2] {
    let (mean, s) = gumption_core::statistics::mean_and_deviation(xs);
    if xs.len() < 2 {
        return [exact(mean).into(), NONE.into()];
    }
    // What rounding leaves of equal numbers is no deviation.
    if s <= 1e-14 * mean.abs() {
        return [aligned(mean, mean, 8).into(), "0".into()];
    }
    [
        aligned(mean, s, 2).into(),
        significant(s, TABLE_DIGITS).into(),
    ]
}

/// The power of a thousand that a column with this largest number is best written in.
fn power_of_thousand(largest: f64) -> i32 {
    if (1e-3..1e4).contains(&largest) || largest <= 0.0 || !largest.is_finite() {
        return 0;
    }
    3 * (libm::log10(largest) / 3.0).floor() as i32
}

/// A label without the number at its end.
fn stem(label: &str) -> &str {
    label
        .trim_end_matches(|c: char| c.is_ascii_digit())
        .trim_end()
}

fn yes_or_no(report: &Report<'_>, yes: bool) -> &'static str {
    if yes {
        report.language.pick("yes", "是")
    } else {
        report.language.pick("no", "否")
    }
}

fn verdict_word(report: &Report<'_>, verdict: Clause8) -> &'static str {
    match verdict {
        Clause8::Validated => report.language.pick("yes", "是"),
        Clause8::NotValidated => report.language.pick("no", "否"),
        Clause8::Undecided => report.language.pick("undecided", "未定"),
    }
}

/// A remark of one or more rows, in the words of the first of them.
struct Common {
    remark: Finding,
    labels: Vec<String>,
    /// Whether the figures in it are those of the first row only.
    varies: bool,
}

/// What is to be known of the rows; remarks that differ in their figures only stand once.
fn common_remarks(rows: &[Report<'_>]) -> Vec<Finding> {
    let mut found: Vec<Common> = Vec::new();
    for report in rows {
        for remark in remarks::remarks(report) {
            let label = report.label.unwrap_or_default().to_string();
            let kind = without_figures(&remark.text);
            match found
                .iter_mut()
                .find(|c| without_figures(&c.remark.text) == kind)
            {
                Some(common) => {
                    common.labels.push(label);
                    common.varies |= common.remark != remark;
                }
                None => found.push(Common {
                    remark,
                    labels: vec![label],
                    varies: false,
                }),
            }
        }
    }
    let l = rows[0].language;
    let sentence = |common: Common| {
        let Common {
            mut remark,
            labels,
            varies,
        } = common;
        if varies {
            let first = &labels[0];
            remark.text += &say!(" (The figures are those of {first}.)").in_language(l);
        }
        if labels.len() != rows.len() {
            let (labels, text) = (l.list(&labels), &remark.text);
            remark.text = l.with_head(&labels, text);
        }
        remark
    };
    found.into_iter().map(sentence).collect()
}

/// A sentence without its numbers, by which remarks of several rows are recognised as alike.
fn without_figures(text: &str) -> String {
    let kept = |word: &&str| !word.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    text.split_whitespace()
        .filter(kept)
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_that_differ_in_a_number_repeat_one_another() {
        assert_eq!(stem("001 run 12"), "001 run");
        assert_eq!(stem("001"), "");
        assert_eq!(stem("east"), "east");
    }

    #[test]
    fn a_column_of_small_numbers_has_one_power_of_ten() {
        assert_eq!(power_of_thousand(1.7e-5), -6);
        assert_eq!(power_of_thousand(0.02), 0);
        assert_eq!(power_of_thousand(4.4e5), 3);
        assert_eq!(power_of_thousand(0.0), 0);
    }

    #[test]
    fn mean_and_deviation_of_repetitions() {
        let [mean, s] = mean_and_deviation(&[1.0, 2.0, 3.0, 4.0]);
        // s = √(5/3).
        assert_eq!((mean, s), ("2.5".into(), "1.29".into()));
    }
}
