//! An answer about a claimed budget held against the truth.

use super::case::SheetTruth;
use super::sealed::{SealedSheet, SheetsTruth};
use crate::grade::Refused;

/// What an auditor says of a file, in the neutral answer form.
#[derive(Debug, Clone, PartialEq, Default, serde::Deserialize)]
pub struct SheetAnswer {
    /// The file.
    pub file: String,
    /// `sound`, `slips` or `unexplained`.
    pub verdict: String,
    /// Sets of slips, best first.
    #[serde(default)]
    pub candidates: Vec<Vec<String>>,
    /// The combined standard uncertainty that it holds right.
    #[serde(default)]
    pub u_c: Option<f64>,
    /// The expanded uncertainty that it holds right, rounded or not.
    #[serde(default, rename = "U")]
    pub expanded: Option<f64>,
}

impl SheetAnswer {
    /// Whether both right figures are given, to two digits.
    pub fn has_right_figures(&self, truth: &SheetTruth) -> bool {
        let near = |given: Option<f64>, right: f64| {
            let unit = libm::exp10(libm::floor(libm::log10(right)) - 1.0);
            // Rounded up it may be a whole unit away.
            given.is_some_and(|x| (x - right).abs() <= unit)
        };
        near(self.u_c, truth.u_c) && near(self.expanded, truth.expanded)
    }
}

/// What an answer is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SheetGrade {
    /// The truth, and first where there are several.
    Exact,
    /// The truth among others.
    Listed,
    /// Something else.
    Wrong,
    /// Something was concealed, and nothing named.
    Missed,
    /// Nothing was concealed, or nothing that has a name, and something was named.
    FalseAlarm,
}

impl SheetGrade {
    /// Its word in files.
    pub const fn name(self) -> &'static str {
        match self {
            SheetGrade::Exact => "exact",
            SheetGrade::Listed => "listed",
            SheetGrade::Wrong => "wrong",
            SheetGrade::Missed => "missed",
            SheetGrade::FalseAlarm => "false alarm",
        }
    }
}

/// What became of one budget.
#[derive(Debug, Clone, PartialEq)]
pub struct GradedSheet {
    /// The budget.
    pub sheet: SealedSheet,
    /// The answer; an empty one where there is none.
    pub answer: SheetAnswer,
    /// What it is worth.
    pub grade: SheetGrade,
}

/// Grades of all budgets of a folder.
pub fn grade_sheets(truth: &SheetsTruth, answers: &[SheetAnswer]) -> Vec<GradedSheet> {
    let base = |name: &str| name.rsplit(['/', '\\']).next().unwrap_or(name).to_string();
    let graded = |sheet: &SealedSheet| {
        let of = answers
            .iter()
            .find(|answer| base(&answer.file) == sheet.file);
        let answer = of.cloned().unwrap_or_default();
        GradedSheet {
            grade: grade(&sheet.truth, &answer),
            sheet: sheet.clone(),
            answer,
        }
    };
    truth.sheets.iter().map(graded).collect()
}

/// Grade of one answer.
pub fn grade(truth: &SheetTruth, answer: &SheetAnswer) -> SheetGrade {
    let sorted = |set: &[String]| {
        let mut set = set.to_vec();
        set.sort();
        set
    };
    let slips = sorted(&truth.slips);
    let place = answer
        .candidates
        .iter()
        .position(|set| sorted(set) == slips);
    match (truth.verdict.as_str(), answer.verdict.as_str()) {
        ("slips", "slips") => match place {
            Some(0) => SheetGrade::Exact,
            Some(_) => SheetGrade::Listed,
            None => SheetGrade::Wrong,
        },
        ("slips", _) => SheetGrade::Missed,
        (truth, answer) if truth == answer => SheetGrade::Exact,
        (_, "slips") => SheetGrade::FalseAlarm,
        _ => SheetGrade::Wrong,
    }
}

/// Reads answers about budgets: one, or a list of them.
///
/// # Errors
/// When the text is neither.
pub fn read_sheet_answers(text: &str) -> Result<Vec<SheetAnswer>, Refused> {
    let one = |text: &str| serde_json::from_str(text).map(|answer| vec![answer]);
    let list = serde_json::from_str(text).or_else(|error| one(text).map_err(|_| error));
    list.map_err(|error| Refused::NoAnswer(error.to_string()))
}
