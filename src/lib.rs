//! Measurement uncertainty: budgets by the law of propagation of uncertainty (GUM, JCGM 100) and by Monte Carlo
//! (GUM-S1, JCGM 101; S2, JCGM 102 for several measurands), each validating the other; calibrations from recordings;
//! and diagnoses of what a measurement model left out.
//!
//! # A budget from a string
//!
//! Every fault of a text comes out at once, each with its place, its code and a hint.
//!
//! ```
//! let budget = gumption::budget(r#"
//!     title = "Current through a resistor"
//!
//!     [measurand.I]
//!     model = "V / R"
//!     unit = "mA"
//!
//!     [input]
//!     V = { value = 1.0001, unit = "V", u = 0.0003 }
//!     R = { value = 100.02, unit = "ohm", half_width = 0.01 }
//! "#)?;
//! let evaluation = gumption::evaluate(&budget)?;
//! let gum = &evaluation.results[0].gum;
//! assert!((gum.estimate - 9.999).abs() < 1e-6);
//! assert!((gum.u - 3.0546e-3).abs() < 1e-6);
//! assert!((gum.coverage.k - 1.96).abs() < 1e-4);
//!
//! println!("{}", gumption::statement(&budget, &evaluation));
//! # Ok::<(), gumption::Error>(())
//! ```
//!
//! # Files in memory
//!
//! A budget may name other files: readings in CSV, other budgets, saved results; an experiment names its recording. They
//! are looked up on the disk (`Files::Disk`), or in a library in memory.
//!
//! ```
//! use gumption::Files;
//!
//! let files = Files::Library(&[
//!     ("readings.csv", b"U\n1.0001\n1.0003\n1.0000\n1.0002\n".as_slice()),
//!     ("voltage.toml", r#"
//!         title = "Mean voltage"
//!         [measurand.U]
//!         model = "V"
//!         unit = "V"
//!         [input.V]
//!         unit = "V"
//!         readings = { file = "readings.csv", column = "U" }
//!     "#.as_bytes()),
//! ]);
//! let budgets = gumption::read(files, "voltage.toml")?;
//! let evaluation = gumption::evaluate(&budgets[0])?;
//! assert!((evaluation.results[0].gum.estimate - 1.00015).abs() < 1e-12);
//! # Ok::<(), gumption::Error>(())
//! ```
//!
//! # Samples of Monte Carlo
//!
//! The same trials on every machine and on any number of threads.
//!
//! ```
//! let budget = gumption::budget(r#"
//!     title = "Sum of squares"
//!     [measurand.Y]
//!     model = "a^2 + b^2"
//!     unit = "1"
//!     [input]
//!     a = { value = 0, u = 1 }
//!     b = { value = 0, u = 1 }
//! "#)?;
//! let samples = gumption::samples(&budget, 20_000);
//! let y = &samples[0];
//! let mean = y.iter().sum::<f64>() / y.len() as f64;
//! assert!((mean - 2.0).abs() < 0.1);
//! assert_eq!(samples, gumption::samples(&budget, 20_000));
//! # Ok::<(), gumption::Error>(())
//! ```
//!
//! # A calibration
//!
//! From a recording and measurement equations, or a procedure of the library, to coefficients with their covariance.
//!
//! ```
//! use gumption::Files;
//!
//! let files = Files::Library(&[
//!     ("run.csv", b"omega [deg/s],U [V]\n-20,-0.1999\n-10,-0.0999\n0,0.0002\n10,0.1001\n20,0.2003\n".as_slice()),
//!     ("gyro.toml", r#"
//!         recording = { file = "run.csv", average = "none" }
//!         equations = "U = K*omega + b"
//!     "#.as_bytes()),
//! ]);
//! let calibration = gumption::calibrate(files, "gyro.toml")?;
//! let k = &calibration.figures.coefficients[0];
//! assert!((k.value - 0.010).abs() < 3.0 * k.u && k.u < 1e-5);
//! # Ok::<(), gumption::Error>(())
//! ```
//!
//! # A diagnosis
//!
//! Whether a recording agrees with its model, and what was left out.
//!
//! ```
//! use gumption::Files;
//!
//! let mut recording = String::from("x,y [V]\n");
//! for k in 0..40 {
//!     let x = f64::from(k % 20) / 10.0 - 1.0;
//!     let noise = 1e-3 * f64::from((7 * k) % 11 - 5) / 3.0;
//!     recording += &format!("{x},{}\n", 1.0 + 2.0 * x + 0.02 * x * x + noise);
//! }
//! let files = [
//!     ("recording.csv", recording.as_bytes()),
//!     ("line.toml", r#"
//!         recording = "recording.csv"
//!         equations = "y = a + b*x"
//!         [columns]
//!         x = "stimulus"
//!         y = "output"
//!         [noise]
//!         u = "1 mV"
//!     "#.as_bytes()),
//! ];
//! let diagnosis = gumption::diagnose(Files::Library(&files), "line.toml")?;
//! assert!(diagnosis.adopted.is_some(), "the square is missing");
//! # Ok::<(), gumption::Error>(())
//! ```
//!
//! # The rooms
//!
//! What stands behind these functions, for those who need more of it; each is a crate or a part of one.
//!
//! | room | holds |
//! |---|---|
//! | [`language`] | the languages of reports and faults |
//! | [`fault`] | what is wrong in a user's file, and where; the file refused |
//! | [`files`] | where files are read from: a disk, or a library in memory |
//! | [`quantity`] | units, dimensions, rounding of decimal numbers |
//! | [`special`] | special functions for quantiles and coverage factors |
//! | [`statistics`] | statistics of readings: scatter, serial correlation, analysis of variance |
//! | [`distribution`] | the distributions an input may have |
//! | [`least_squares`] | parameters of a response from observed points |
//! | [`model`] | the model language: text → checked program → values, derivatives, blocks |
//! | [`equations`] | measurement equations over rows of data |
//! | [`mod@budget`] | the file format and the checked budget |
//! | [`batch`] | one budget for every row of a table |
//! | [`mod@fleet`] | what the results of many devices say together |
//! | [`propagate`] | GUM and Monte Carlo evaluation of a budget; verdicts; comparison with claims |
//! | [`csv`] | the one reader of tables |
//! | [`recording`] | recordings of instruments: columns, dwells, averages, Allan deviation |
//! | [`mod@calibrate`] | recordings and measurement equations → coefficients |
//! | [`mod@diagnose`] | which physics a measurement model left out of a recording |
//! | `challenge` | sealed cases with something concealed, and the grading of a diagnosis (feature `challenge`) |
//! | [`verify`] | published examples held against their published figures |
//! | [`document`] | what every command composes: blocks for people, a typed form for machines |
//! | [`render`] | the formats of a document: text, Markdown, HTML, JSON, spreadsheets … |
//! | [`report`] | documents of everything above, the certificate's sentence, saved results, the dossier |

use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;

pub use gumption_audit as audit;
#[cfg(feature = "challenge")]
pub use gumption_challenge as challenge;
pub use gumption_core::{
    distribution, equations, least_squares, model, quantity, special, statistics,
};
pub use gumption_export as render;
pub use gumption_fault as fault;
pub use gumption_fault::language;
pub use gumption_fleet as fleet;
pub use gumption_format::{csv, document, files, machine};
pub use gumption_gum::{batch, budget, propagate, versions};
pub use gumption_lab::{calibrate, diagnose, experiment, recording};
pub use gumption_report as report;
pub use gumption_verify as verify;

pub use gumption_fault::Rejection;
pub use gumption_fault::language::Language;
pub use gumption_format::files::Files;
pub use gumption_gum::budget::Budget;
pub use gumption_gum::propagate::{Evaluation, EvaluationError, Options};
pub use gumption_lab::calibrate::{Calibration, Trouble};
pub use gumption_lab::diagnose::{Diagnosis, Failure};

/// Why there is no result.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read, or has faults.
    Rejected(Box<Rejection>),
    /// A budget has no value.
    Evaluation(EvaluationError),
    /// A recording does not give the coefficients.
    Calibration(Trouble),
    /// A recording could not be held against its model; with the reason in English.
    Diagnosis(Failure, String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Rejected(rejection) => f.write_str(&rejection.render(false)),
            Error::Evaluation(error) => error.fmt(f),
            Error::Calibration(trouble) => {
                f.write_str(&report::calibration_trouble(trouble, Language::English))
            }
            Error::Diagnosis(_, why) => f.write_str(why),
        }
    }
}

impl std::error::Error for Error {}

impl From<Rejection> for Error {
    fn from(rejection: Rejection) -> Error {
        Error::Rejected(Box::new(rejection))
    }
}

impl From<EvaluationError> for Error {
    fn from(error: EvaluationError) -> Error {
        Error::Evaluation(error)
    }
}

impl From<Trouble> for Error {
    fn from(trouble: Trouble) -> Error {
        Error::Calibration(trouble)
    }
}

/// The budget of a text that names no other files; of a series the budget of its first row.
///
/// # Errors
/// All faults of the text.
pub fn budget(text: &str) -> Result<Budget, Error> {
    let files: &[(&str, &[u8])] = &[("budget.toml", text.as_bytes())];
    let mut budgets = read(Files::Library(files), "budget.toml")?;
    // A file that is accepted has a row.
    Ok(budgets.swap_remove(0))
}

/// The budgets of a file: one, or one for each row of its series.
///
/// # Errors
/// The file, or one that it names, cannot be read or has faults.
pub fn read(files: Files<'_>, path: impl AsRef<Path>) -> Result<Vec<Budget>, Error> {
    let loaded = budget::load_from(files, path.as_ref(), None)?;
    Ok(loaded.rows.into_iter().map(|row| row.budget).collect())
}

/// Evaluates a budget by the GUM and by Monte Carlo, as it says; [`propagate::evaluate`] has options.
///
/// # Errors
/// The model has no finite value or derivative at the estimates.
pub fn evaluate(budget: &Budget) -> Result<Evaluation, Error> {
    Ok(propagate::evaluate(budget, &Options::default())?)
}

/// Values of the measurands in trials of the Monte Carlo method, each in its unit: one list for each measurand, and
/// the n-th values of all lists are of one trial. A trial in which the model has no value is NaN.
pub fn samples(budget: &Budget, trials: u64) -> Vec<Vec<f64>> {
    propagate::samples(budget, trials, &Options::default())
}

/// The sentences of a certificate, in English; [`report`] has everything that can be said, in both languages.
pub fn statement(budget: &Budget, evaluation: &Evaluation) -> String {
    let report = report::Report {
        budget,
        evaluation,
        label: None,
        language: Language::English,
    };
    report::statement(&report).join("\n")
}

/// Calibrates with the recording and the equations, or the procedure, that a file names.
///
/// # Errors
/// The file or its recording has faults, or the recording does not give the coefficients.
pub fn calibrate(files: Files<'_>, path: impl AsRef<Path>) -> Result<Calibration, Error> {
    let purpose = experiment::Purpose::Calibrate;
    let campaign = calibrate::load_from(files, path.as_ref(), purpose)?;
    Ok(calibrate::calibrate(&campaign)?)
}

/// Holds a recording against the model that a file declares.
///
/// # Errors
/// The file or its recording has faults, or the model cannot be fitted.
pub fn diagnose(files: Files<'_>, path: impl AsRef<Path>) -> Result<Diagnosis, Error> {
    use diagnose::case::{Case, Purpose};
    let case = Case::load_from(files, path.as_ref(), Purpose::Diagnosis)?;
    diagnose::diagnose(&case, &|_| ControlFlow::Continue(())).map_err(|failure| {
        let why = report::diagnosis_failure(&case, &failure, Language::English);
        Error::Diagnosis(failure, why)
    })
}
