//! What a certificate claims beside what the evaluation gives.

use crate::budget::Claim;
use crate::quantity::Decimal;

use super::Report;
use super::document::Block;
use super::language::{Language, Word};
use super::number::{NONE, at_place, exact, print, significant};
use super::table::{Cell, ColumnKind, Row, Table};

/// One claimed figure against one obtained figure.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Comparison {
    /// `value`, `u`, `U`, `k`, `dof`, `p`, `low`, `high`.
    pub(super) figure: Figure,
    pub(super) method: Method,
    pub(super) claimed: f64,
    pub(super) obtained: Option<f64>,
}

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Figure {
    Value,
    StandardUncertainty,
    Expanded,
    CoverageFactor,
    DegreesOfFreedom,
    IntervalLow,
    IntervalHigh,
}

/// Which method gave the obtained figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    Gum,
    MonteCarlo,
}

impl Figure {
    /// Stable name for machines.
    pub(super) fn code(self) -> &'static str {
        match self {
            Figure::Value => "value",
            Figure::StandardUncertainty => "standard_uncertainty",
            Figure::Expanded => "expanded_uncertainty",
            Figure::CoverageFactor => "coverage_factor",
            Figure::DegreesOfFreedom => "effective_degrees_of_freedom",
            Figure::IntervalLow => "interval_low",
            Figure::IntervalHigh => "interval_high",
        }
    }

    fn label(self, language: Language) -> &'static str {
        match self {
            Figure::Value => language.word(Word::Estimate),
            Figure::StandardUncertainty => language.word(Word::StandardUncertainty),
            Figure::Expanded => language.word(Word::ExpandedUncertainty),
            Figure::CoverageFactor => language.word(Word::CoverageFactor),
            Figure::DegreesOfFreedom => language.word(Word::FreedomEffective),
            Figure::IntervalLow => language.pick("interval, lower end", "包含区间下限"),
            Figure::IntervalHigh => language.pick("interval, upper end", "包含区间上限"),
        }
    }
}

impl Method {
    /// Stable name for machines.
    pub(super) fn code(self) -> &'static str {
        match self {
            Method::Gum => "gum",
            Method::MonteCarlo => "monte_carlo",
        }
    }

    fn label(self, language: Language) -> &'static str {
        match self {
            Method::Gum => language.word(Word::Gum),
            Method::MonteCarlo => language.word(Word::MonteCarlo),
        }
    }
}

impl Comparison {
    /// Whether the obtained figure, rounded to the last digit that the claim states, is the claim.
    pub(super) fn agrees(&self) -> Option<bool> {
        self.last_digits().map(|n| n == 0.0)
    }

    /// Obtained minus claimed in units of the last digit that the claim states.
    pub(super) fn last_digits(&self) -> Option<f64> {
        let place = self.last_place()?;
        let rounded = at_place(self.obtained.filter(|o| o.is_finite())?, place);
        Some(
            (rounded.shifted(-place).to_f64()
                - Decimal::from_f64(self.claimed).shifted(-place).to_f64())
            .round(),
        )
    }

    /// Power of ten of the last digit that the claim states. k = 2 is meant as 2.00.
    fn last_place(&self) -> Option<i32> {
        let place = Decimal::from_f64(self.claimed).place()?;
        Some(if self.figure == Figure::CoverageFactor {
            place.min(-2)
        } else {
            place
        })
    }

    /// Obtained divided by claimed.
    pub(super) fn ratio(&self) -> Option<f64> {
        self.obtained
            .filter(|_| self.claimed != 0.0)
            .map(|o| o / self.claimed)
            .filter(|r| r.is_finite())
    }

    fn verdict(&self, language: Language) -> String {
        let Some(last) = self.last_digits() else {
            return NONE.to_string();
        };
        if last == 0.0 {
            return language.pick("agrees", "一致").to_string();
        }
        /// Beyond this many units of the last digit the percentage says more.
        const FEW: f64 = 9.0;
        if last.abs() <= FEW {
            let signed = if last > 0.0 {
                format!("+{last}")
            } else {
                format!("{last}")
            };
            return language.pick(format!("differs by {signed}"), format!("相差 {signed}"));
        }
        match self.ratio() {
            Some(ratio) if (0.5..2.0).contains(&ratio) => {
                let percent = significant(100.0 * (ratio - 1.0), 2);
                language.pick(
                    format!("differs by {percent} %"),
                    format!("相差 {percent} %"),
                )
            }
            Some(ratio) => {
                let times = significant(ratio, 3);
                language.pick(
                    format!("is {times} times the claim"),
                    format!("为声称值的 {times} 倍"),
                )
            }
            None => language.pick("differs", "不一致").to_string(),
        }
    }
}

/// Every figure of a claim against both methods.
pub(super) fn compare(report: &Report<'_>, claim: &Claim) -> Vec<Comparison> {
    let Some(result) = report.evaluation.results.get(claim.measurand) else {
        return Vec::new();
    };
    let (gum, monte_carlo) = (&result.gum, result.monte_carlo.as_ref());
    let mut comparisons = Vec::new();
    let mut add =
        |figure, claimed: Option<f64>, first: Option<f64>, trials: Option<Option<f64>>| {
            let Some(claimed) = claimed else { return };
            comparisons.push(Comparison {
                figure,
                method: Method::Gum,
                claimed,
                obtained: first,
            });
            if let Some(obtained) = trials {
                comparisons.push(Comparison {
                    figure,
                    method: Method::MonteCarlo,
                    claimed,
                    obtained,
                });
            }
        };
    let half = gum.coverage.half_width_for_p;
    let width = monte_carlo.map(|mc| (mc.symmetric[1] - mc.symmetric[0]) / 2.0);
    add(
        Figure::Value,
        claim.value,
        Some(gum.estimate),
        monte_carlo.map(|mc| mc.estimate),
    );
    add(
        Figure::StandardUncertainty,
        claim.u,
        Some(gum.u),
        monte_carlo.map(|mc| mc.u),
    );
    // A claimed U with its own k is compared for that k: what differs is then u, not the convention.
    let expanded = claim.k.map_or(gum.coverage.expanded, |k| k * gum.u);
    let from_trials = match claim.k {
        Some(k) => monte_carlo.map(|mc| mc.u.map(|u| k * u)),
        None => width.map(Some),
    };
    add(
        Figure::Expanded,
        claim.expanded,
        Some(expanded),
        from_trials,
    );
    add(Figure::CoverageFactor, claim.k, Some(gum.coverage.k), None);
    add(
        Figure::DegreesOfFreedom,
        claim.dof,
        Some(gum.freedom.value()),
        None,
    );
    let [low, high] = claim
        .interval
        .map_or([None, None], |[a, b]| [Some(a), Some(b)]);
    add(
        Figure::IntervalLow,
        low,
        Some(gum.estimate - half),
        monte_carlo.map(|mc| Some(mc.symmetric[0])),
    );
    add(
        Figure::IntervalHigh,
        high,
        Some(gum.estimate + half),
        monte_carlo.map(|mc| Some(mc.symmetric[1])),
    );
    comparisons
}

/// Whether the claimed figures of a measurand agree with GUM, for a series table.
pub(super) fn summary(report: &Report<'_>, measurand: usize) -> Option<String> {
    let claims = report
        .budget
        .claims
        .iter()
        .filter(|c| c.measurand == measurand);
    let all: Vec<Comparison> = claims
        .flat_map(|c| compare(report, c))
        .filter(|c| c.method == Method::Gum)
        .collect();
    if all.is_empty() {
        return None;
    }
    let differing: Vec<String> = all
        .iter()
        .filter(|c| c.agrees() != Some(true))
        .map(|c| {
            let ratio = c
                .ratio()
                .map_or_else(|| NONE.to_string(), |r| significant(r, 3));
            format!("{} ×{ratio}", c.figure.label(report.language))
        })
        .collect();
    Some(if differing.is_empty() {
        report.language.pick("agrees", "一致").to_string()
    } else {
        differing.join(", ")
    })
}

/// The table of all claims.
pub(super) fn blocks(report: &Report<'_>) -> Vec<Block> {
    let l = report.language;
    let several = report.evaluation.results.len() > 1 || report.budget.claims.len() > 1;
    let mut table = Table::new([
        ("", ColumnKind::Words),
        (l.word(Word::Claimed), ColumnKind::Numbers),
        ("", ColumnKind::Words),
        (l.word(Word::Obtained), ColumnKind::Numbers),
        (l.word(Word::Ratio), ColumnKind::Numbers),
        (
            l.pick("in the last digit claimed", "在声称值的末位上"),
            ColumnKind::Wrapped,
        ),
    ]);
    for (n, claim) in report.budget.claims.iter().enumerate() {
        if several {
            if n > 0 {
                table.rows.push(Row::Rule);
            }
            table.rows.push(Row::Across(title(report, claim)));
        }
        for comparison in compare(report, claim) {
            push(&mut table, &comparison, l);
        }
    }
    if table.rows.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![Block::Section(l.word(Word::Claim).to_string())];
    if let ([claim], false) = (report.budget.claims.as_slice(), several) {
        let words: Vec<&str> = claim
            .source
            .iter()
            .chain(&claim.note)
            .map(String::as_str)
            .collect();
        if !words.is_empty() {
            blocks.push(Block::Paragraph(words.join(l.pick("; ", "；"))));
        }
    }
    blocks.push(Block::Table(table));
    blocks
}

fn title(report: &Report<'_>, claim: &Claim) -> String {
    let name = report
        .measurand(
            claim
                .measurand
                .min(report.evaluation.results.len().saturating_sub(1)),
        )
        .0;
    let words: Vec<&str> = std::iter::once(name)
        .chain(claim.source.iter().chain(&claim.note).map(String::as_str))
        .collect();
    words.join(report.language.pick("; ", "；"))
}

fn push(table: &mut Table, comparison: &Comparison, language: Language) {
    let repeated = comparison.method == Method::MonteCarlo;
    let claimed: Cell = if repeated {
        Cell::Empty
    } else {
        exact(comparison.claimed).into()
    };
    let label: Cell = if repeated {
        Cell::Empty
    } else {
        comparison.figure.label(language).into()
    };
    // Two digits beyond the claim's last show what rounding hides.
    let obtained = comparison.obtained.map_or_else(
        || NONE.to_string(),
        |o| {
            let place = comparison.last_place().unwrap_or(0);
            let rounded = at_place(o, place - 2);
            if rounded.is_zero() {
                significant(o, 3)
            } else {
                print(&rounded)
            }
        },
    );
    let ratio = comparison
        .ratio()
        .map_or_else(|| NONE.to_string(), |r| significant(r, 4));
    table.push(vec![
        label,
        claimed,
        comparison.method.label(language).into(),
        obtained.into(),
        ratio.into(),
        comparison.verdict(language).into(),
    ]);
}
