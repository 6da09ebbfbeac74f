//! What the statistical analysis of readings found (GUM 4.2, H.5), for the report and for claims.

use super::NamedFigure;
use gumption_core::quantity::Unit;
use gumption_core::statistics::{
    Nested, OneWay, OutlierTest, Policy, Ratio, Suspect, Verdict, Verdicts,
};

/// An analysis of the readings behind one component.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Analysis {
    /// Name of the component, unique: `V`, or `V.repeatability` beside others.
    pub name: String,
    /// Unit of the readings.
    pub unit: Unit,
    /// What was analysed, and how.
    pub found: Finding,
}

/// The kinds of analysis.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// Statistics of one series of readings.
    Readings(Statistics),
    /// Readings in groups.
    Anova(Anova),
    /// Readings in subgroups of groups.
    Nested(NestedAnova),
    /// A test of the most outlying reading.
    Outlier(Outlier),
}

/// Statistics of one series of readings.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Number of readings.
    pub n: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// Experimental standard deviation of a single reading.
    pub s: f64,
    /// Smallest reading.
    pub min: f64,
    /// Largest reading.
    pub max: f64,
    /// Autocorrelation of successive readings.
    pub lag1: f64,
    /// Effective number of independent readings, where u was corrected for their correlation.
    pub effective: Option<f64>,
}

/// One-way analysis of variance, and what followed from it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Anova {
    /// The table.
    pub table: OneWay,
    /// What the file asks for.
    pub policy: Policy,
    /// Level of significance of the F test.
    pub significance: f64,
    /// What was done.
    pub verdict: Verdict,
}

/// Nested analysis of variance, and what followed from it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NestedAnova {
    /// The table.
    pub table: Nested,
    /// What the file asks for.
    pub policy: Policy,
    /// Level of significance of the F tests.
    pub significance: f64,
    /// What was done.
    pub verdicts: Verdicts,
}

/// A test of the most outlying reading.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Outlier {
    /// Which test.
    pub test: OutlierTest,
    /// Level of significance, for the tests that have one.
    pub significance: Option<f64>,
    /// The most outlying reading.
    pub value: f64,
    /// What the test says of it.
    pub suspect: Suspect,
}

/// Probabilities for which critical values of F are given beside that of the level of significance.
const CRITICAL: [(&str, f64); 3] = [("0.95", 0.95), ("0.975", 0.975), ("0.99", 0.99)];

/// A name without its owner, the number, and the power of the readings' unit that it has.
type Entry = (String, f64, i32);

impl Analysis {
    /// The figures by name: `V.mean`, `V.anova.F`, `V.outlier.p`.
    pub fn figures(&self) -> Vec<NamedFigure> {
        let entries = match &self.found {
            Finding::Readings(found) => found.entries(),
            Finding::Anova(found) => found.entries(),
            Finding::Nested(found) => found.entries(),
            Finding::Outlier(found) => found.entries(),
        };
        let difference = self.unit.difference();
        let unit = |figure: &str, power: i32| match (figure, power) {
            ("mean" | "min" | "max" | "outlier.value", _) => self.unit.clone(),
            (_, 0) => Unit::one(),
            (_, 1) => difference.clone(),
            _ => difference.powr(power, 1).unwrap_or_else(Unit::one),
        };
        entries
            .into_iter()
            .map(|(figure, value, power)| NamedFigure {
                unit: unit(&figure, power),
                name: format!("{}.{figure}", self.name),
                value,
            })
            .collect()
    }
}

fn entry(name: impl Into<String>, value: f64, power: i32) -> Entry {
    (name.into(), value, power)
}

impl Statistics {
    fn entries(&self) -> Vec<Entry> {
        let mut entries = vec![
            entry("n", self.n as f64, 0),
            entry("mean", self.mean, 1),
            entry("s", self.s, 1),
            entry("min", self.min, 1),
            entry("max", self.max, 1),
            entry("lag1", self.lag1, 0),
        ];
        entries.extend(self.effective.map(|n| entry("n_effective", n, 0)));
        entries
    }
}

/// Sum of squares, degrees of freedom and mean square of a line of the table.
fn line(name: &str, line: &gumption_core::statistics::Line) -> [Entry; 3] {
    [
        entry(format!("anova.ss_{name}"), line.ss, 2),
        entry(format!("anova.df_{name}"), line.df, 0),
        entry(format!("anova.ms_{name}"), line.ms, 2),
    ]
}

/// F, its probability and critical values; `of` tells several ratios apart.
fn ratio(of: &str, ratio: &Ratio, significance: f64) -> Vec<Entry> {
    let mut entries = vec![
        entry(format!("anova.F{of}"), ratio.f, 0),
        entry(format!("anova.p{of}"), ratio.p(), 0),
        entry(
            format!("anova.F_critical{of}"),
            ratio.critical(1.0 - significance),
            0,
        ),
    ];
    entries.extend(
        CRITICAL
            .iter()
            .map(|(text, p)| entry(format!("anova.F{of}({text})"), ratio.critical(*p), 0)),
    );
    entries
}

impl Anova {
    /// Standard deviation between the groups; zero where the variance would be negative.
    pub fn s_between(&self) -> f64 {
        self.table.between_variance().max(0.0).sqrt()
    }

    /// Standard deviation of a single reading in a group taken at random (ISO 5725: s_R).
    pub fn reproducibility(&self) -> f64 {
        (self.table.between_variance().max(0.0) + self.table.within.ms).sqrt()
    }

    fn entries(&self) -> Vec<Entry> {
        let table = &self.table;
        let mut entries = vec![
            entry("n", table.readings as f64, 0),
            entry("mean", table.mean, 1),
            entry("anova.groups", table.groups as f64, 0),
        ];
        entries.extend(line("between", &table.between));
        entries.extend(line("within", &table.within));
        entries.extend(ratio("", &table.ratio(), self.significance));
        entries.extend([
            entry("anova.n_0", table.effective_count, 0),
            entry("anova.s_means", table.s_of_means, 1),
            entry("anova.s_a", table.between.ms.sqrt(), 1),
            entry("anova.s_b", table.within.ms.sqrt(), 1),
            entry("anova.s_B", self.s_between(), 1),
            entry("anova.s_R", self.reproducibility(), 1),
            entry("anova.residual_sd", table.within.ms.sqrt(), 1),
            entry("anova.r_squared", table.r_squared(), 0),
        ]);
        entries
    }
}

impl NestedAnova {
    /// Standard deviations between groups, between subgroups, and within them; zero where a variance would
    /// be negative.
    pub fn standard_deviations(&self) -> [f64; 3] {
        [
            self.table.top_variance().max(0.0).sqrt(),
            self.table.middle_variance().max(0.0).sqrt(),
            self.table.within.ms.sqrt(),
        ]
    }

    fn entries(&self) -> Vec<Entry> {
        let table = &self.table;
        let mut entries = vec![
            entry("n", table.readings as f64, 0),
            entry("mean", table.mean, 1),
            entry("anova.groups", table.groups as f64, 0),
            entry("anova.subgroups", table.subgroups as f64, 0),
        ];
        entries.extend(line("groups", &table.top));
        entries.extend(line("subgroups", &table.middle));
        entries.extend(line("within", &table.within));
        entries.extend(ratio("_groups", &table.top_ratio(), self.significance));
        entries.extend(ratio(
            "_subgroups",
            &table.middle_ratio(),
            self.significance,
        ));
        let names = ["s_groups", "s_subgroups", "s_within"];
        entries.extend(
            names
                .iter()
                .zip(self.standard_deviations())
                .map(|(name, s)| entry(format!("anova.{name}"), s, 1)),
        );
        entries
    }
}

impl Outlier {
    fn entries(&self) -> Vec<Entry> {
        let mut entries = vec![
            entry("outlier.place", self.suspect.place as f64 + 1.0, 0),
            entry("outlier.value", self.value, 1),
            entry("outlier.statistic", self.suspect.statistic, 0),
            entry("outlier.critical", self.suspect.critical, 0),
        ];
        entries.extend(self.suspect.p.map(|p| entry("outlier.p", p, 0)));
        entries
    }
}
