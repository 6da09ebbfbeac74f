//! Claimed budgets in which slips are concealed, as sheets.
//!
//! Nothing here knows how an audit reads or searches: slips happen in a working of its own, which is then written down.
//!
//! | chapter | holds |
//! |---|---|
//! | `words` | words and figures on sheets |
//! | `statement` | what a sheet says of what is known |
//! | `quantity` | what is known of a quantity, and what follows from it |
//! | `laboratory` | right budgets of several fields |
//! | `working` | the calculation of a laboratory |
//! | `spoil` | slips, as they happen in a working |
//! | `page` | a working on paper, in the layouts that are in use |
//! | `paper` | pages as files |
//! | `case` | a sealed budget from a seed |
//! | `grade` | an answer held against the truth |
//! | `sealed` | sealed budgets as a folder |
//! | `document` | graded answers as a document |

mod case;
mod document;
mod grade;
mod laboratory;
mod page;
mod paper;
mod quantity;
mod sealed;
mod spoil;
mod statement;
mod words;
mod working;

pub use case::{Sheet, SheetTruth, sheet};
pub use document::{sheet_grades_document, sheet_grades_schema};
pub use grade::{GradedSheet, SheetAnswer, SheetGrade, grade, grade_sheets, read_sheet_answers};
pub use sealed::{SealedSheet, SealedSheets, SheetsTruth, sealed_sheets, sealed_sheets_truth};
