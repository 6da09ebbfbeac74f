//! Published examples, evaluated and held against their published figures: what ISO/IEC 17025:2017, 7.11.2 asks
//! a laboratory to do with its software before it relies on it.
//!
//! An [`Example`] is a budget file with claims. It passes when every claimed figure agrees with the figure obtained
//! within the tolerance of the claim, in every row of its series. [`LIBRARY`] holds the published examples that the
//! program carries with it.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod environment;
mod library;

use std::path::Path;

pub use environment::Environment;
pub use library::LIBRARY;

use gumption_gum::budget::{self, Budget, Confidence, Files, Heading, Rejection};
use gumption_gum::propagate::{
    self, Comparison, Evaluation, EvaluationError, Options, compare_claims,
};

/// What was verified, and where.
#[derive(Debug, Clone)]
pub struct Verification {
    /// The program and the computer.
    pub environment: Environment,
    /// Every file with claims, in the order in which they were given.
    pub examples: Vec<Example>,
    /// Files without claims, which do not count.
    pub without_claims: Vec<String>,
}

/// One file with claims.
#[derive(Debug, Clone)]
pub struct Example {
    /// Its name, as the report calls it.
    pub file: String,
    /// What it says about itself; empty for a file that was refused.
    pub heading: Heading,
    /// Its rows with their figures (one row where the file has no series), or why there are none.
    pub rows: Result<Vec<Row>, Problem>,
}

/// One evaluation of an example.
#[derive(Debug, Clone)]
pub struct Row {
    /// The row of the file's series.
    pub label: Option<String>,
    /// What was evaluated.
    pub budget: Budget,
    /// What was found.
    pub evaluation: Evaluation,
    /// Every claimed figure against the figure obtained by the method that the claim names.
    pub comparisons: Vec<Comparison>,
}

/// Why an example has no figures.
#[derive(Debug, Clone)]
pub enum Problem {
    /// The file has faults.
    Refused(Rejection),
    /// A row has no value.
    NoResult {
        /// The row of the file's series.
        label: Option<String>,
        /// Why.
        error: EvaluationError,
    },
}

/// How an example ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every figure that decides agrees.
    Passed,
    /// A figure that decides differs, or there is no figure.
    Failed,
    /// All claims are of low confidence: shown, never counted.
    NotGating,
}

/// A number of figures, and of examples by their verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Examples that passed.
    pub passed: usize,
    /// Examples that failed.
    pub failed: usize,
    /// Examples that are shown only.
    pub not_gating: usize,
    /// Figures that decide.
    pub figures: usize,
    /// Those among them that differ.
    pub differing: usize,
    /// Figures that are shown only.
    pub figures_not_gating: usize,
}

impl Row {
    /// Whether the verdict depends on a comparison: not where its claim is of low confidence.
    pub fn gates(&self, comparison: &Comparison) -> bool {
        self.budget
            .claims
            .get(comparison.claim)
            .is_none_or(|claim| claim.confidence != Confidence::Low)
    }

    /// Correct significant digits that the claim asks for, where it asks for digits.
    pub fn digits_wanted(&self, comparison: &Comparison) -> Option<u8> {
        self.budget.claims.get(comparison.claim)?.digits
    }
}

impl Example {
    /// Evaluates a file, which is read from `files` and called `name` in the report; `None` when it states no
    /// claim.
    pub fn evaluate(files: Files<'_>, path: &Path, name: &str, options: &Options) -> Option<Self> {
        let example = |heading, rows| {
            Some(Example {
                file: name.to_string(),
                heading,
                rows,
            })
        };
        let loaded = match budget::load_from(files, path, None) {
            Ok(loaded) => loaded,
            Err(rejection) => {
                return example(Heading::default(), Err(Problem::Refused(rejection)));
            }
        };
        if loaded.rows.iter().all(|row| row.budget.claims.is_empty()) {
            return None;
        }
        let rows = loaded.rows.into_iter().map(|row| evaluated(row, options));
        example(loaded.heading, rows.collect())
    }

    /// Every figure, with the row that it belongs to.
    pub fn figures(&self) -> impl Iterator<Item = (&Row, &Comparison)> {
        self.rows
            .iter()
            .flatten()
            .flat_map(|row| row.comparisons.iter().map(move |c| (row, c)))
    }

    /// How it ended.
    pub fn verdict(&self) -> Verdict {
        if self.rows.is_err() {
            return Verdict::Failed;
        }
        let mut gating = self.figures().filter(|(row, c)| row.gates(c)).peekable();
        if gating.peek().is_none() {
            Verdict::NotGating
        } else if gating.all(|(_, comparison)| comparison.agrees()) {
            Verdict::Passed
        } else {
            Verdict::Failed
        }
    }
}

fn evaluated(row: budget::Row, options: &Options) -> Result<Row, Problem> {
    let budget::Row { label, budget } = row;
    match propagate::evaluate(&budget, options) {
        Ok(evaluation) => {
            let mut comparisons = compare_claims(&budget, &evaluation);
            comparisons.retain(|comparison| comparison.judged);
            Ok(Row {
                label,
                budget,
                evaluation,
                comparisons,
            })
        }
        Err(error) => Err(Problem::NoResult { label, error }),
    }
}

impl Verification {
    /// How many figures and examples there are.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for example in &self.examples {
            match example.verdict() {
                Verdict::Passed => counts.passed += 1,
                Verdict::Failed => counts.failed += 1,
                Verdict::NotGating => counts.not_gating += 1,
            }
            for (row, comparison) in example.figures() {
                if row.gates(comparison) {
                    counts.figures += 1;
                    counts.differing += usize::from(!comparison.agrees());
                } else {
                    counts.figures_not_gating += 1;
                }
            }
        }
        counts
    }

    /// The seeds of the random numbers that were used, each once, in ascending order.
    pub fn seeds(&self) -> Vec<u64> {
        let mut seeds: Vec<u64> = self
            .examples
            .iter()
            .flat_map(|example| example.rows.iter().flatten())
            .filter_map(|row| row.evaluation.run.as_ref().map(|run| run.seed))
            .collect();
        seeds.sort_unstable();
        seeds.dedup();
        seeds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_gum::propagate::MonteCarloChoice;

    const SUM: &str =
        "title = \"Sum\"\n[measurand.Y]\nmodel = \"X\"\n[input.X]\nvalue = 1\nu = 0.1\n";

    fn verified(claims: &str) -> Option<Example> {
        let text = format!("{SUM}{claims}");
        let files = [("sum.toml", text.as_bytes())];
        let options = Options {
            monte_carlo: MonteCarloChoice::Off,
            ..Options::default()
        };
        Example::evaluate(
            Files::Library(&files),
            Path::new("sum.toml"),
            "sum.toml",
            &options,
        )
    }

    fn verdict(claims: &str) -> Verdict {
        verified(claims).expect("claims").verdict()
    }

    #[test]
    fn an_example_passes_when_all_figures_that_decide_agree() {
        assert_eq!(verdict("[claim]\nvalue = 1\nu = 0.1\n"), Verdict::Passed);
        assert_eq!(verdict("[claim]\nvalue = 1\nu = 0.2\n"), Verdict::Failed);
        let low = "[[claim]]\nu = 0.2\nconfidence = \"low\"\n";
        assert_eq!(verdict(low), Verdict::NotGating);
        assert_eq!(
            verdict(&format!("[[claim]]\nvalue = 1\n{low}")),
            Verdict::Passed
        );
    }

    #[test]
    fn a_file_without_claims_does_not_count_and_one_with_faults_fails() {
        assert!(verified("").is_none());
        assert_eq!(verdict("[claim]\nvalu = 1\n"), Verdict::Failed);
        assert_eq!(
            verdict(
                "[claim]\nvalue = 1\n[series]\ncolumns = [\"X\", \"claim.value\"]\nrows = [[1, 1], [2, 1]]\n"
            ),
            Verdict::Failed
        );
    }

    #[test]
    fn figures_and_examples_are_counted() {
        let claims = [
            "[claim]\nvalue = 1\nu = 0.1\n",
            "[[claim]]\nvalue = 2\n[[claim]]\nu = 0.2\nconfidence = \"low\"\n",
        ];
        let verification = Verification {
            environment: Environment::here("2026-01-01".into()),
            examples: claims.iter().filter_map(|c| verified(c)).collect(),
            without_claims: Vec::new(),
        };
        let expected = Counts {
            passed: 1,
            failed: 1,
            not_gating: 0,
            figures: 3,
            differing: 1,
            figures_not_gating: 1,
        };
        assert_eq!(verification.counts(), expected);
        assert!(verification.seeds().is_empty());
    }
}
