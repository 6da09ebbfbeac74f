//! `gumption schema`: JSON Schema for editors and for readers of what the program writes.

use gumption::{budget, challenge, experiment, report};

use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Which schema
    #[arg(value_enum, default_value_t = Which::Budget)]
    which: Which,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Which {
    /// Budget files
    Budget,
    /// The data of a certificate: the files of `gumption eval --certificate`
    Certificate,
    /// The output of `gumption eval --json`
    Evaluation,
    /// What `gumption eval --save` writes
    Result,
    /// Experiments: the files of `gumption calibrate`, `plan`, `simulate` and `diagnose`
    Experiment,
    /// The output of `gumption calibrate --json`
    CalibrationResult,
    /// The output of `gumption plan --json` for a calibration
    CalibrationPlan,
    /// The output of `gumption diagnose --json`
    Diagnosis,
    /// The output of `gumption plan --json` for a case
    Outlook,
    /// The output of `gumption allan --json`
    Allan,
    /// The output of `gumption fleet --json`
    Fleet,
    /// The output of `gumption grade --json`
    Grade,
    /// The output of `gumption audit --json`
    Audit,
    /// The output of `gumption grade --audit --json`
    SheetGrades,
    /// The output of `gumption verify --json`
    Verification,
}

pub(super) fn run(args: &Args) -> Outcome {
    let schema = match args.which {
        Which::Budget => budget::schema(),
        Which::Certificate => report::certificate_schema(),
        Which::Evaluation => report::evaluation_schema(),
        Which::Result => budget::result_schema(),
        Which::Experiment => experiment::schema(),
        Which::CalibrationResult => report::calibration_schema(),
        Which::CalibrationPlan => report::plan_schema(),
        Which::Diagnosis => report::diagnosis_schema(),
        Which::Outlook => report::outlook_schema(),
        Which::Allan => report::allan_schema(),
        Which::Fleet => report::fleet_schema(),
        Which::Grade => challenge::grade::grade_schema(),
        Which::Audit => report::audit_schema(),
        Which::SheetGrades => challenge::budget::sheet_grades_schema(),
        Which::Verification => report::verification_schema(),
    };
    output::print(format!("{schema:#}\n"))
}
