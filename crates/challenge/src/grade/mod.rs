//! A diagnosis held against the truth.
//!
//! | chapter | holds |
//! |---|---|
//! | `answer` | what the grader reads of a diagnosis |
//! | `vocabulary` | whether a name is right for a physics |
//! | `place` | whether axis and moment are right |
//! | `score` | what was found, missed, made up, and the points |
//! | `document` | the same as a document |

mod answer;
mod document;
mod place;
mod score;
mod vocabulary;

use std::path::{Path, PathBuf};

pub use answer::{Answer, AnsweredEffect, HeldOut, Name, Prediction, Quality, State, Variant};
pub use document::{document, grade_schema};
pub use place::located;
pub use score::{Finding, Graded, GradedEffect, grade};
pub use vocabulary::accepts;

use gumption_fault::{Said, of_system};
use gumption_format::files::Files;

use super::files::CASE;
use super::truth::{Truth, seal};

/// Why a case cannot be graded.
#[derive(Debug, Clone, PartialEq)]
pub enum Refused {
    /// A file that cannot be read, with the reason.
    Unreadable(PathBuf, Said),
    /// The truth is not the one that the experiment was sealed with.
    BrokenSeal,
    /// A file of the case was changed after it was sealed.
    Changed(String),
    /// The diagnosis is not in a form that is known.
    NoDiagnosis(String),
    /// The answers about budgets are not in a form that is known.
    NoAnswer(String),
}

/// Reads the truth of a folder that `challenge` wrote, and makes sure that neither it nor the case was
/// changed since.
///
/// # Errors
/// When a file is missing, or a seal does not hold.
pub fn sealed_truth(folder: &Path) -> Result<Truth, Refused> {
    let read = |path: PathBuf| {
        let bytes = Files::Disk.read(&path);
        let text = bytes.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        text.map_err(|error| Refused::Unreadable(path, of_system(&error)))
    };
    let truth_path = folder.join("truth.json");
    let truth_text = read(truth_path.clone())?;
    let handed_out = folder.join("case");
    if !read(handed_out.join(CASE))?.contains(&seal(&truth_text)) {
        return Err(Refused::BrokenSeal);
    }
    let truth: Truth = serde_json::from_str(&truth_text)
        .map_err(|error| Refused::Unreadable(truth_path, error.to_string().into()))?;
    for (name, hash) in &truth.files {
        if seal(&read(handed_out.join(name))?) != *hash {
            return Err(Refused::Changed(name.clone()));
        }
    }
    Ok(truth)
}

/// Reads a diagnosis as `gumption diagnose --json` prints it.
///
/// # Errors
/// When the text is no diagnosis.
pub fn read_answer(text: &str) -> Result<Answer, Refused> {
    serde_json::from_str(text).map_err(|error| Refused::NoDiagnosis(error.to_string()))
}
