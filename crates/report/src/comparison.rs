//! GUM and Monte Carlo side by side, with the verdict of JCGM 101 clause 8.

use gumption_core::quantity::Unit;
use gumption_fault::say;
use gumption_gum::propagate::{
    Clause8, Coverage, CoverageBasis, FindingKind, MeasurandResult, Quasi, Run, Validation,
};

use super::figures::Figures;
use super::language::{Language, Word};
use super::number::{
    NONE, TABLE_DIGITS, aligned, at_place, exact, freedom, grouped, in_unit, print, probability,
    significant,
};
use super::quasi;
use super::remarks::tolerance;
use super::{Report, symbol};
use crate::phrase::plural;
use gumption_format::document::Block;
use gumption_format::document::{Cell, ColumnKind, Table};

/// The table and the verdict for one measurand.
pub(super) fn blocks(report: &Report<'_>, measurand: usize) -> Vec<Block> {
    let result = &report.evaluation.results[measurand];
    let mut blocks = vec![Block::Table(table(report, measurand, result))];
    let run = report.evaluation.run.as_ref();
    if let Some(quasi) = run.and_then(|run| run.quasi.as_ref()) {
        blocks.push(Block::Paragraph(quasi::sentence(quasi, report.language)));
    }
    let reason = Figures::new(report, measurand).reason(report.language);
    blocks.push(Block::Paragraph(reason.to_string()));
    if let Some(validation) = &result.validation {
        blocks.push(Block::List(
            validation
                .iter()
                .map(|v| verdict(report, measurand, v))
                .collect(),
        ));
    }
    blocks
}

fn table(report: &Report<'_>, measurand: usize, result: &MeasurandResult) -> Table {
    let l = report.language;
    let unit = &report.measurand(measurand).1;
    let head = match symbol(unit) {
        none if none.is_empty() => none,
        unit => l.pick(format!("in {unit}"), format!("单位：{unit}")),
    };
    let mut both = SideBySide {
        report,
        measurand,
        result,
        scale: scale(result),
        table: Table::new([
            (head.as_str(), ColumnKind::Wrapped),
            (Word::Gum.of(l), ColumnKind::Numbers),
            (Word::MonteCarlo.of(l), ColumnKind::Numbers),
        ]),
    };
    both.moments(unit);
    both.second_order();
    both.median();
    both.intervals();
    both.shape();
    both.trials();
    both.table
}

/// What values are rounded beside: intervals need a scale to be rounded to even where u does not exist.
fn scale(result: &MeasurandResult) -> f64 {
    let u = result.gum.u;
    let scale = match &result.monte_carlo {
        Some(mc) => mc.u.unwrap_or((mc.symmetric[1] - mc.symmetric[0]) / 4.0),
        None => u,
    };
    if u > 0.0 {
        u.min(if scale > 0.0 { scale } else { u })
    } else {
        scale
    }
}

/// The table while it is filled.
struct SideBySide<'a> {
    report: &'a Report<'a>,
    measurand: usize,
    result: &'a MeasurandResult,
    scale: f64,
    table: Table,
}

impl SideBySide<'_> {
    fn row(&mut self, label: String, gum: String, trials: Option<String>) {
        self.table.push(vec![
            Cell::Text(label),
            gum.into(),
            trials.map_or(Cell::Empty, Cell::Text),
        ]);
    }

    fn value(&self, x: f64) -> String {
        aligned(x, self.scale, TABLE_DIGITS)
    }

    fn interval(&self, [low, high]: [f64; 2]) -> String {
        format!("[{}, {}]", self.value(low), self.value(high))
    }

    /// Estimate and standard uncertainty.
    fn moments(&mut self, unit: &Unit) {
        let (l, gum, mc) = (
            self.report.language,
            &self.result.gum,
            self.result.monte_carlo.as_ref(),
        );
        let estimate = mc.map(|mc| optional(mc.estimate, |y| self.value(y)));
        self.row(
            Word::Estimate.of(l).into(),
            self.value(gum.estimate),
            estimate,
        );
        self.row(
            in_unit(Word::StandardUncertainty.of(l), &symbol(unit)),
            three(gum.u),
            mc.map(|mc| optional(mc.u, three)),
        );
    }

    /// Where it changes the result.
    fn second_order(&mut self) {
        let (l, gum) = (self.report.language, &self.result.gum);
        let unseen = self.report.finds(self.measurand, |kind| {
            matches!(kind, FindingKind::VanishingSensitivity { .. })
        });
        let second = self.result.second_order.as_ref();
        if let Some(second) = second.filter(|s| s.matters || unseen) {
            let estimate = self.value(gum.estimate + second.shift);
            self.row(Word::SecondOrderShift.of(l).into(), estimate, None);
            self.row(Word::SecondOrderU.of(l).into(), three(second.u), None);
        }
    }

    /// In place of moments that do not exist.
    fn median(&mut self) {
        let l = self.report.language;
        let mc = self.result.monte_carlo.as_ref();
        if let Some(mc) = mc.filter(|mc| mc.estimate.is_none() || mc.u.is_none()) {
            let median = self.value(mc.median);
            self.row(Word::Median.of(l).into(), String::new(), Some(median));
        }
    }

    /// Coverage factor and coverage intervals.
    fn intervals(&mut self) {
        let (l, gum, mc) = (
            self.report.language,
            &self.result.gum,
            self.result.monte_carlo.as_ref(),
        );
        // The factor that the Monte Carlo interval would need: what k means there.
        let implied = mc.and_then(|mc| {
            mc.u.filter(|u| *u > 0.0)
                .map(|u| (mc.symmetric[1] - mc.symmetric[0]) / (2.0 * u))
        });
        // ISO 11929 has an interval of its own; that of Monte Carlo stands beside it.
        if self.result.not_negative.is_some() {
            return;
        }
        self.row(
            Word::CoverageFactor.of(l).into(),
            three(gum.coverage.k),
            mc.map(|_| optional(implied, three)),
        );
        let p = probability(self.report.coverage_probability());
        let half = gum.coverage.half_width_for_p;
        self.row(
            say!("{p} interval, symmetric").in_language(l),
            self.interval([gum.estimate - half, gum.estimate + half]),
            mc.map(|mc| self.interval(mc.symmetric)),
        );
        if let Some(mc) = mc {
            self.row(
                say!("{p} interval, shortest").in_language(l),
                String::new(),
                Some(self.interval(mc.shortest)),
            );
        }
    }

    /// Skewness and excess kurtosis.
    fn shape(&mut self) {
        let l = self.report.language;
        let mc = self.result.monte_carlo.as_ref();
        let Some((skewness, kurtosis)) = mc.and_then(|mc| mc.skewness.zip(mc.excess_kurtosis))
        else {
            return;
        };
        let text = format!(
            "{}, {}",
            print(&at_place(skewness, -2)),
            print(&at_place(kurtosis, -2))
        );
        let label = [Word::Skewness.of(l), Word::Kurtosis.of(l)].join(l.list_comma());
        self.row(label, String::new(), Some(text));
    }

    fn trials(&mut self) {
        let l = self.report.language;
        if let Some(run) = &self.report.evaluation.run {
            let text = match &run.quasi {
                Some(Quasi::Used(quasi)) => quasi::points(run, quasi, l),
                _ => trials(run, self.measurand, l),
            };
            self.row(Word::Trials.of(l).into(), String::new(), Some(text));
        }
    }
}

fn three(x: f64) -> String {
    significant(x, TABLE_DIGITS)
}

fn optional(x: Option<f64>, form: impl Fn(f64) -> String) -> String {
    x.map_or_else(|| NONE.to_string(), form)
}

/// `1 000 000, seed 1`, and for an adaptive run what it reached.
fn trials(run: &Run, measurand: usize, language: Language) -> String {
    let count = grouped(run.trials);
    let seed = run.seed;
    let base = say!("{count}, seed {seed}").in_language(language);
    let Some(adaptive) = &run.adaptive else {
        return base;
    };
    let delta = adaptive
        .delta
        .get(measurand)
        .map_or_else(|| NONE.to_string(), |d| tolerance(*d));
    let reached = match adaptive.reached {
        true => language.pick("yes", "达到"),
        false => language.pick("no", "未达到"),
    };
    say!("{base}, stable to δ = {delta}: {reached}").in_language(language)
}

/// One line of JCGM 101 clause 8.
fn verdict(report: &Report<'_>, measurand: usize, v: &Validation) -> String {
    let unit = symbol(report.measurand(measurand).1);
    let unit = if unit.is_empty() {
        unit
    } else {
        format!(" {unit}")
    };
    let error = significant(v.error, 2);
    let (low, high, delta) = (
        significant(v.d_low, 2),
        significant(v.d_high, 2),
        exact(v.delta),
    );
    let found = match v.verdict {
        Clause8::Validated => say!("GUM is validated"),
        Clause8::NotValidated => say!("GUM is not validated"),
        Clause8::Undecided => say!(
            "GUM is neither validated nor refuted, as the Monte Carlo ends have a standard error of {error}{unit}"
        ),
    };
    let (digits, plural) = (v.digits, plural(v.digits as usize));
    say!("Clause 8, {digits} digit{plural} of u: d_low = {low}, d_high = {high}, δ = {delta}{unit}: {found}").in_language(report.language)
}

/// Where k came from, in a few words.
pub(super) fn basis_of_k(coverage: &Coverage, language: Language) -> String {
    match (coverage.named_basis(), language) {
        (CoverageBasis::Normal, Language::English) => "normal distribution".to_string(),
        (CoverageBasis::Normal, Language::Chinese) => "正态分布".to_string(),
        (CoverageBasis::StudentT { dof }, Language::English) => {
            format!("t-distribution, ν = {}", freedom(*dof))
        }
        (CoverageBasis::StudentT { dof }, Language::Chinese) => {
            format!("t 分布，ν = {}", freedom(*dof))
        }
        (CoverageBasis::Output { dominant, shape }, Language::English) => {
            format!(
                "{} distribution, dominated by {}",
                shape.name(language),
                language.list(dominant)
            )
        }
        (CoverageBasis::Output { dominant, shape }, Language::Chinese) => {
            format!(
                "{}，{} 占优势",
                shape.name(language),
                language.list(dominant)
            )
        }
        (CoverageBasis::Fixed, Language::English) => "fixed".to_string(),
        (CoverageBasis::Fixed, Language::Chinese) => "约定值".to_string(),
    }
}
