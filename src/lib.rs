//! Measurement uncertainty from a budget file: the law of propagation of uncertainty (GUM,
//! JCGM 100) and the propagation of distributions by Monte Carlo (GUM-S1, JCGM 101; S2,
//! JCGM 102 for several measurands), each validating the other.
//!
//! Data flows one way, and the modules stand in that order: text → [`budget`] → [`model`] →
//! [`propagate`] → [`report`]. What a file knows only as data (readings, points of a calibration
//! line, results of other files) becomes inputs in [`budget`], with [`statistics`] and
//! [`least_squares`].
//!
//! | module | holds |
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
//! | [`budget`] | the file format and the checked budget |
//! | [`propagate`] | GUM and Monte Carlo evaluation of a budget; verdicts; comparison with claims |
//! | [`recording`] | recordings of instruments: columns, dwells, averages, Allan deviation |
//! | [`calibrate`] | recordings and measurement equations → coefficients |
//! | [`diagnose`] | which physics a measurement model left out of a recording |
//! | [`challenge`] | sealed cases with something concealed, and the grading of a diagnosis |
//! | [`verify`] | published examples held against their published figures |
//! | [`document`] | what every command composes: blocks for people, a typed form for machines |
//! | [`render`] | text, Markdown, JSON: the formats of a document |
//! | [`report`] | documents of everything above, the certificate's sentence, saved results, the dossier |
//!
//! # A tour
//!
//! Text in, figures out. [`budget::read`] gives every fault of the text at once, or one
//! [`budget::Budget`] (one for each row of a series); [`propagate::evaluate`] runs both methods;
//! [`report::Report`] joins the two for the renderers.
//!
//! ```
//! use gumption::budget;
//! use gumption::propagate::{self, Options};
//! use gumption::report::{self, Language, Report};
//!
//! let text = r#"
//!     title = "Current through a resistor"
//!
//!     [measurand.I]
//!     model = "V / R"
//!     unit = "mA"
//!
//!     [input]
//!     V = { value = 1.0001, unit = "V", u = 0.0003 }
//!     R = { value = 100.02, unit = "ohm", half_width = 0.01 }
//! "#;
//!
//! // CSV files that a budget names are looked up from the folder.
//! let loaded = budget::read(text, "current.toml", "".as_ref())
//!     .map_err(|rejection| rejection.render(false))?;
//! let budget = &loaded.rows[0].budget;
//!
//! let evaluation = propagate::evaluate(budget, &Options::default())
//!     .map_err(|error| report::failure(&error, Language::English))?;
//! let gum = &evaluation.results[0].gum;
//! println!("y = {} mA, u = {} mA, k = {}", gum.estimate, gum.u, gum.coverage.k);
//! assert!((gum.estimate - 9.999).abs() < 1e-6);
//! assert!((gum.u - 3.0546e-3).abs() < 1e-6);
//! assert!((gum.coverage.k - 1.96).abs() < 1e-4);
//!
//! let report = Report { budget, evaluation: &evaluation, label: None, language: Language::English };
//! for sentence in report::statement(&report) {
//!     println!("{sentence}");
//! }
//! # Ok::<(), String>(())
//! ```

pub use gumption_challenge as challenge;
pub use gumption_core::{
    distribution, equations, least_squares, model, quantity, special, statistics,
};
pub use gumption_fault as fault;
pub use gumption_fault::language;
pub use gumption_format::{document, files, machine, render};
pub use gumption_gum::{budget, propagate};
pub use gumption_lab::{calibrate, diagnose, recording};
pub use gumption_report as report;
pub use gumption_verify as verify;
