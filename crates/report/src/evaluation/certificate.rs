//! What a series puts on the certificate: a table of its points for each measurand, and what is to be said of it.

use gumption_fault::say;
use gumption_format::document::{Block, Cell, Column, ColumnKind, Table};
use gumption_gum::propagate::{Basis, ReportedUncertainty, StatedProbability};

use crate::decisions::{self, Decided};
use crate::figures::Figures;
use crate::language::{Language, Word};
use crate::number::{in_unit, probability};
use crate::{Report, statement, symbol};

/// The section; none where no row states a result.
pub(super) fn blocks(rows: &[Report<'_>]) -> Vec<Block> {
    let Some(first) = rows.first() else {
        return Vec::new();
    };
    let l = first.language;
    let mut blocks = vec![Block::Section(Word::Statement.of(l).to_string())];
    let mut sentences: Vec<String> = Vec::new();
    for measurand in 0..first.evaluation.results.len() {
        if !statement::states_result(first, measurand) {
            continue;
        }
        let points = Points::new(rows, measurand);
        blocks.push(Block::Table(points.table().without_empty_columns()));
        let said = points.sentences();
        sentences.extend(
            said.into_iter()
                .filter(|one| !sentences.contains(one))
                .collect::<Vec<_>>(),
        );
    }
    if sentences.is_empty() {
        return Vec::new();
    }
    sentences.extend(statement::certified(rows));
    blocks.push(Block::Statement(sentences));
    blocks
}

/// The sentences of that section.
pub(super) fn sentences(rows: &[Report<'_>]) -> Vec<String> {
    let statement = blocks(rows).into_iter().find_map(|block| match block {
        Block::Statement(sentences) => Some(sentences),
        _ => None,
    });
    statement.unwrap_or_default()
}

/// One measurand at all points.
struct Points<'a> {
    measurand: usize,
    l: Language,
    all: Vec<Point<'a>>,
}

/// One point.
struct Point<'a> {
    report: &'a Report<'a>,
    figures: Figures<'a>,
    decided: Vec<Decided<'a>>,
}

/// What is said of the figures of a point.
#[derive(Clone, Copy, PartialEq)]
enum Found {
    /// U = k·u of the GUM method.
    Multiple,
    /// U = k·u with the u of Monte Carlo.
    MultipleOfTrials,
    /// Half the width of an interval.
    HalfWidth,
    /// An interval.
    Interval,
    /// No uncertainty.
    Nothing,
}

impl<'a> Points<'a> {
    fn new(rows: &'a [Report<'a>], measurand: usize) -> Self {
        let point = |report: &'a Report<'a>| Point {
            report,
            figures: Figures::new(report, measurand),
            decided: decisions::decided(report, measurand),
        };
        Points {
            measurand,
            l: rows[0].language,
            all: rows.iter().map(point).collect(),
        }
    }

    fn table(&self) -> Table {
        let (l, first) = (self.l, &self.all[0]);
        let (name, unit) = first.report.measurand(self.measurand);
        let expanded = format!("U({name})");
        let mut table = Table::new([
            (Word::Row.of(l), ColumnKind::Names),
            (&in_unit(name, &symbol(unit)), ColumnKind::Numbers),
            (&in_unit(&expanded, &symbol(unit)), ColumnKind::Numbers),
            ("k", ColumnKind::Numbers),
            ("ν_eff", ColumnKind::Numbers),
            ("p", ColumnKind::Numbers),
            (
                &in_unit(Word::Interval.of(l), &symbol(unit)),
                ColumnKind::Numbers,
            ),
        ]);
        for decided in &first.decided {
            let of = match decided.name == name {
                true => String::new(),
                false => format!("{}{}", l.comma(), decided.name),
            };
            let head = |word: &str, kind| Column {
                head: format!("{word}{of}"),
                kind,
            };
            table.columns.extend([
                head(l.pick("tolerance", "容许区间"), ColumnKind::Words),
                head(l.pick("accepted", "接受区间"), ColumnKind::Words),
                head(l.pick("verdict", "结论"), ColumnKind::Words),
            ]);
        }
        let one_probability = self.one(|point| point.probability()).is_some();
        let cell = |text: Option<String>| text.map_or(Cell::Empty, Cell::from);
        for point in &self.all {
            let figures = &point.figures;
            // ν goes with a k that follows from it.
            let freedom = figures.freedom().filter(|freedom| freedom != "∞");
            let mut cells = vec![
                point.report.label.unwrap_or_default().into(),
                point.estimate(l).into(),
                cell(figures.expanded()),
                cell(figures.k()),
                cell(freedom.filter(|_| figures.k().is_some())),
                cell(point.probability().filter(|_| !one_probability)),
                cell(
                    figures
                        .interval()
                        .map(|[low, high]| format!("[{low}, {high}]")),
                ),
            ];
            for decided in &point.decided {
                let verdict = decided.verdict;
                cells.push(decided.tolerance.clone().into());
                cells.push(cell(decided.accepted.clone()));
                cells.push(cell(
                    verdict.map(|v| decisions::verdict_word(l, v).to_string()),
                ));
            }
            table.push(cells);
        }
        table
    }

    fn sentences(&self) -> Vec<String> {
        let l = self.l;
        let p = self.one(|point| point.probability());
        let covers = p.map_or(String::new(), |p| {
            say!(", for a coverage probability of about {p}").in_language(l)
        });
        let kinds = [
            (
                Found::Multiple,
                say!("U is the expanded uncertainty: the combined standard uncertainty multiplied by the coverage factor k{covers}.").in_language(l),
            ),
            (
                Found::MultipleOfTrials,
                say!("U is the standard uncertainty found by the Monte Carlo method (JCGM 101) multiplied by the coverage factor k.").in_language(l),
            ),
            (
                Found::HalfWidth,
                say!("U is half the width of the coverage interval found by the Monte Carlo method (JCGM 101){covers}; k = U/u.").in_language(l),
            ),
            (
                Found::Interval,
                say!("The coverage interval stands in the place of y ± U, because the result does not lie in its middle{covers}.").in_language(l),
            ),
            (
                Found::Nothing,
                say!("No uncertainty can be stated.").in_language(l),
            ),
        ];
        let mut sentences: Vec<String> = kinds
            .into_iter()
            .filter_map(|(kind, sentence)| self.said(sentence, |point| point.found() == kind))
            .collect();
        sentences.extend(self.rules());
        sentences
    }

    /// The decision rules, each with the points that it decides.
    fn rules(&self) -> Vec<String> {
        let l = self.l;
        let mut rules: Vec<&str> = Vec::new();
        for decided in self.all.iter().flat_map(|point| &point.decided) {
            if !rules.contains(&decided.rule.as_str()) {
                rules.push(&decided.rule);
            }
        }
        let sentences = rules.into_iter().filter_map(|rule| {
            let sentence = say!("Decision rule: {rule}.").in_language(l);
            self.said(sentence, |point| {
                point.decided.iter().any(|decided| decided.rule == rule)
            })
        });
        sentences.collect()
    }

    /// A sentence about the points that are so, named unless all of them are; nothing about none.
    fn said(&self, sentence: String, are: impl Fn(&Point<'a>) -> bool) -> Option<String> {
        /// More names are found faster in the table.
        const MOST: usize = 8;
        let l = self.l;
        let so: Vec<String> = self
            .all
            .iter()
            .filter(|point| are(point))
            .map(|point| point.report.label.unwrap_or_default().to_string())
            .collect();
        if so.is_empty() || so.len() == self.all.len() {
            return (!so.is_empty()).then_some(sentence);
        }
        let names = match so.len() > MOST {
            false => l.list(&so),
            true => {
                let (first, n) = (so[..MOST].join(l.list_comma()), so.len());
                say!("{first} … ({n} rows)").in_language(l)
            }
        };
        Some(l.with_head(&names, &sentence))
    }

    /// What is the same at all points.
    fn one(&self, of: impl Fn(&Point<'a>) -> Option<String>) -> Option<String> {
        let first = of(&self.all[0])?;
        let mut others = self.all[1..].iter();
        others
            .all(|point| of(point).as_ref() == Some(&first))
            .then_some(first)
    }
}

impl Point<'_> {
    /// y as it is rounded, and in full where a decision needs that.
    fn estimate(&self, l: Language) -> String {
        let in_full = self.decided.iter().find_map(|one| one.in_full.as_deref());
        decisions::with_unrounded(&self.figures.estimate(), in_full, l)
    }

    fn probability(&self) -> Option<String> {
        match self.figures.reported.probability {
            StatedProbability::Of(p) => Some(probability(p)),
            _ => None,
        }
    }

    fn found(&self) -> Found {
        let reported = &self.figures.reported;
        match (reported.uncertainty, reported.basis) {
            (ReportedUncertainty::Multiple { .. }, Basis::Gum) => Found::Multiple,
            (ReportedUncertainty::Multiple { .. }, Basis::MonteCarlo) => Found::MultipleOfTrials,
            (ReportedUncertainty::HalfWidth { .. }, _) => Found::HalfWidth,
            (ReportedUncertainty::Interval { .. }, _) => Found::Interval,
            (ReportedUncertainty::None, _) => Found::Nothing,
        }
    }
}
