//! An answer about a claimed budget held against the truth.

use super::case::SheetTruth;

/// What an auditor says of a file, in the neutral answer form.
#[derive(Debug, Clone, PartialEq, serde::Deserialize)]
pub struct SheetAnswer {
    /// `sound`, `slips` or `unexplained`.
    pub verdict: String,
    /// Sets of slips, best first.
    #[serde(default)]
    pub candidates: Vec<Vec<String>>,
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

/// Grades.
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
