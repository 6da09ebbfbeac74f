//! Subcommands, exit codes and output.

mod allan;
mod archive;
mod arguments;
mod audit;
mod batch;
mod calibrate;
mod challenge;
mod concepts;
mod date;
mod diagnose;
mod eval;
mod evaluated;
mod explain;
mod fleet;
mod form;
mod grade;
mod import;
mod interrupt;
mod language;
mod new;
mod no_command;
mod other_kind;
mod output;
mod plan;
mod progress;
mod schema;
mod serve;
mod simulate;
mod verify;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use gumption::files;

/// How a run ended; the process's exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// All went well: 0.
    Done,
    /// A budget was read but has no value or no result, an example failed, or an item does not conform: 1.
    Negative,
    /// A file or an argument is wrong: 2.
    BadInput,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        ExitCode::from(outcome as u8)
    }
}

/// Measurement uncertainty: a budget file in, an uncertainty statement out.
#[derive(Debug, Parser)]
#[command(
    name = "gumption",
    version,
    propagate_version = true,
    max_term_width = 100,
    after_help = "Exit codes: 0 all went well, 1 a budget gives no result, an example failed or an item does not conform, 2 a file or an argument is wrong.\n\nStart with `gumption new my-budget.toml`, edit the file, then `gumption eval my-budget.toml`."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Evaluate budget files: budget table, GUM and Monte Carlo, statement for the certificate
    Eval(eval::Args),
    /// Evaluate one budget for every row of a table of devices
    Batch(batch::Args),
    /// Say what many results say together: scatter against u, E_n, drift
    Fleet(fleet::Args),
    /// Recompute a claimed budget from its sheet, and name the slip behind its figures
    Audit(audit::Args),
    /// Write a budget file from a laboratory's spreadsheet
    Import(import::Args),
    /// Confront a model with a recording: do they agree, and what was left out
    Diagnose(diagnose::Args),
    /// Write the recording that a declared model and its claimed noise predict
    Simulate(simulate::Args),
    /// Hold published examples, or your own files with claims, against their figures
    Verify(verify::Args),
    /// Allan deviation of a recording at rest: white noise, bias instability, random walk
    Allan(allan::Args),
    /// Find coefficients with their covariance from a recording and measurement equations
    Calibrate(calibrate::Args),
    /// Say what a calibration or an experiment would tell, from its design alone
    Plan(plan::Args),
    /// Write a commented budget file to start from
    New(new::Args),
    /// Open the workbench: budgets of a folder edited and seen in the browser
    Serve(serve::Args),
    /// Make a sealed case: simulated recordings in which something is concealed
    Challenge(challenge::Args),
    /// Hold a diagnosis against the truth of a sealed case
    Grade(grade::Args),
    /// Print the JSON Schema of budget files or of what the program writes
    Schema(schema::Args),
    /// Explain a distribution, function, profile, error code or concept
    Explain(explain::Args),
}

/// Runs the program.
pub(crate) fn run() -> ExitCode {
    let command = arguments::parse::<Cli>().command;
    files::remember_reads();
    interrupt::say_so();
    let outcome = match command {
        Command::Eval(args) => eval::run(&args),
        Command::Batch(args) => batch::run(&args),
        Command::Fleet(args) => fleet::run(&args),
        Command::Audit(args) => audit::run(&args),
        Command::Import(args) => import::run(&args),
        Command::Diagnose(args) => diagnose::run(&args),
        Command::Simulate(args) => simulate::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Allan(args) => allan::run(&args),
        Command::Calibrate(args) => calibrate::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::New(args) => new::run(&args),
        Command::Serve(args) => serve::run(&args),
        Command::Challenge(args) => challenge::run(&args),
        Command::Grade(args) => grade::run(&args),
        Command::Schema(args) => schema::run(&args),
        Command::Explain(args) => explain::run(&args),
    };
    outcome.into()
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    /// What Chinese users read of these arguments.
    fn in_chinese(arguments: &[&str]) -> String {
        let arguments = ["gumption"].iter().chain(arguments);
        let error = arguments::try_parse::<Cli>(arguments).expect_err("a fault");
        arguments::in_chinese(&error).unwrap_or_default()
    }

    #[test]
    fn faults_of_arguments_are_chinese() {
        for (arguments, expected) in [
            (&["evl"][..], "没有子命令 `evl`\n  是否为："),
            (&["eval"], "缺少必需的参数：<FILE>..."),
            (&["eval", "--foo", "x"], "没有参数 `--foo`"),
            (&["eval", "x", "--threads", "0"], "：0 不在 1..=1024 之内"),
            (&["eval", "x", "--threads", "a"], "：应为不带正负号的整数"),
            (
                &["eval", "x", "--seed", "-3"],
                "值 `-3` 有误：应为不带正负号的整数",
            ),
            (&["eval", "-o"], "`--output <FILE>` 缺少值"),
        ] {
            let text = in_chinese(arguments);
            assert!(text.contains(expected), "{text}");
            assert!(!text.contains("error"), "{text}");
        }
        assert_eq!(in_chinese(&["--help"]), "");
    }

    #[test]
    fn a_number_that_is_none_is_told_in_words_of_the_program() {
        for (value, expected) in [
            ("abc", ": expected a whole number without a sign\n"),
            ("-3", ": expected a whole number without a sign\n"),
            ("99999999999999999999", ": the number is too large\n"),
        ] {
            let error = arguments::try_parse::<Cli>(["gumption", "eval", "x", "--seed", value]);
            let text = arguments::in_english(&error.expect_err("a fault"));
            assert!(
                text.as_ref().is_some_and(|text| text.contains(expected)),
                "{text:?}"
            );
        }
    }

    #[test]
    fn an_option_that_there_is_not_is_no_value() {
        let error = arguments::try_parse::<Cli>(["gumption", "new", "-x", "x"]);
        let text = arguments::in_english(&error.expect_err("a fault"));
        let text = text.unwrap_or_default();
        assert!(text.contains("'-x'") && !text.contains("-- -x"), "{text}");
        assert!(text.contains("Usage:"), "{text}");
    }

    #[test]
    fn a_file_or_an_option_without_a_command_is_told_what_to_write() {
        for (arguments, expected) in [
            (&["budgets/mass/ea-s2.toml"][..], "`gumption eval"),
            (&["lost.toml"], "a command is missing: `gumption eval"),
            (
                &["experiments/gyro-scale-factor.toml"],
                "`gumption calibrate",
            ),
            (&["sheet.xlsx"], "`gumption audit sheet.xlsx`"),
            (&["table.csv"], "`gumption fleet table.csv`"),
            (&["budgets"], "`gumption serve budgets`"),
            (&["--lang", "zh", "eval", "a.toml"], "the option --lang"),
            (
                &["diagnose", "a.toml", "b.toml"],
                "b.toml is one too many for `gumption diagnose",
            ),
        ] {
            let arguments = ["gumption"].iter().chain(arguments);
            let error = arguments::try_parse::<Cli>(arguments).expect_err("a fault");
            let said = arguments::instead(&error).expect("what to write");
            assert!(said.to_string().contains(expected), "{said}");
        }
        for arguments in [
            &["gumption", "evl"][..],
            &["gumption", "eval", "--foo", "x"],
        ] {
            let error = arguments::try_parse::<Cli>(arguments).expect_err("a fault");
            assert_eq!(arguments::instead(&error), None);
        }
    }

    #[test]
    fn the_arguments_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_worse_outcome_wins() {
        assert!(Outcome::BadInput > Outcome::Negative && Outcome::Negative > Outcome::Done);
    }
}
