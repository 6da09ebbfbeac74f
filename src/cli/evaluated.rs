//! The evaluation of a budget file as arguments ask for it.

use std::path::Path;

use super::output::Complaint;
use clap::{Args as _, FromArgMatches};
use gumption::Files;
use gumption::budget::{self, Budget, Points, Profile, Trials, Wanted};
use gumption::document::Document;
use gumption::fault::say;
use gumption::propagate::{self, EvaluatedRow, MonteCarloChoice, Options};
use gumption::report::{self, Language, Report};

/// What changes the file's own settings.
#[derive(Debug, clap::Args)]
pub(super) struct Settings {
    /// Do not run Monte Carlo
    #[arg(long, conflicts_with_all = ["trials", "seed"])]
    no_mc: bool,
    /// Monte Carlo trials, or `adaptive` to run until the results are stable
    #[arg(long, value_name = "N|adaptive", value_parser = parse_trials)]
    trials: Option<Trials>,
    /// Seed of the random numbers; the same seed gives the same result to the last bit
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// `quasi-random`: scrambled Sobol' points until the results are stable, where they are far more accurate
    /// than random trials; `random` as in JCGM 101 [default: as the file says, else random]
    #[arg(long, value_name = "KIND", value_parser = parse_points, conflicts_with = "no_mc")]
    points: Option<Points>,
    /// Give Sobol' sensitivity indices, too: the part of the variance that each input makes
    #[arg(long, conflicts_with = "no_mc")]
    indices: bool,
    /// Evaluate under this profile in place of the file's (`gumption explain` lists them); what the
    /// file's [conventions] change still holds
    #[arg(long, value_name = "NAME", value_parser = parse_profile)]
    pub profile: Option<&'static Profile>,
}

impl Settings {
    /// The arguments that ask for these.
    pub fn arguments(&self) -> Vec<String> {
        let mut arguments = Vec::new();
        let mut flag = |name: &str, value: Option<String>| {
            arguments.extend(value.map(|value| format!("--{name}={value}")))
        };
        flag(
            "trials",
            self.trials.as_ref().map(|trials| match trials {
                Trials::Fixed(n) => n.to_string(),
                _ => "adaptive".to_owned(),
            }),
        );
        flag("seed", self.seed.map(|seed| seed.to_string()));
        flag(
            "points",
            self.points.map(|points| match points {
                Points::Random => "random".to_owned(),
                Points::QuasiRandom => "quasi-random".to_owned(),
            }),
        );
        flag(
            "profile",
            self.profile.map(|profile| profile.name.to_owned()),
        );
        let switches = [("--no-mc", self.no_mc), ("--indices", self.indices)];
        let asked = switches.into_iter().filter(|(_, asked)| *asked);
        arguments.extend(asked.map(|(name, _)| name.to_owned()));
        arguments
    }

    /// The settings that arguments ask for.
    pub fn of<'a>(arguments: impl Iterator<Item = &'a str>) -> Result<Self, Complaint> {
        let command = Settings::augment_args(clap::Command::new("eval").no_binary_name(true));
        let matches = command.try_get_matches_from(arguments);
        let settings = matches.and_then(|matches| Settings::from_arg_matches(&matches));
        settings.map_err(|error| {
            let error = error.to_string();
            say!("its arguments are not understood: {error}").into()
        })
    }
}

/// What an archive holds of a result: the machine form, from these files alone.
pub(super) fn machine(
    files: Files<'_>,
    path: &Path,
    settings: &Settings,
) -> Result<Document, Complaint> {
    let name = path.display();
    let loaded = budget::load_from(files, path, settings.profile)
        .map_err(|rejection| say!("{name} is refused: {}", rejection.render(false)))?;
    let mut rows = Vec::with_capacity(loaded.rows.len());
    for budget::Row { label, budget } in loaded.rows {
        let options = options(settings, None, &budget, &propagate::Progress::default());
        let evaluation = propagate::evaluate(&budget, &options)
            .map_err(|error| say!("{name} gives no result: {}", error.said()))?;
        rows.push(EvaluatedRow {
            label,
            budget,
            evaluation,
        });
    }
    of_rows(&rows, Language::English, 1).ok_or_else(|| say!("{name} has no rows").into())
}

/// The document of rows in one language; none of none.
pub(super) fn of_rows(
    rows: &[EvaluatedRow],
    language: Language,
    in_full: usize,
) -> Option<Document> {
    let reports: Vec<Report<'_>> = rows.iter().map(|row| Report::of(row, language)).collect();
    report::evaluations(&reports, in_full)
}

/// What the arguments change in the budget's own settings.
pub(super) fn options(
    args: &Settings,
    threads: Option<u16>,
    budget: &Budget,
    progress: &propagate::Progress,
) -> Options {
    let monte_carlo = if args.no_mc {
        MonteCarloChoice::Off
    } else {
        MonteCarloChoice::With(budget.monte_carlo.with(&Wanted {
            seed: args.seed,
            trials: args.trials.clone(),
            points: args.points,
            indices: args.indices,
        }))
    };
    let every_core = Options::default().threads;
    Options {
        monte_carlo,
        threads: threads.map_or(every_core, usize::from),
        progress: progress.clone(),
    }
}

/// `1000000`, `1_000_000`, `1e6`, `adaptive`.
pub(super) fn parse_trials(text: &str) -> Result<Trials, Complaint> {
    /// Fewer say nothing about an interval; more would run for days.
    const RANGE: std::ops::RangeInclusive<f64> = 1e3..=1e12;
    if text == "adaptive" {
        return Ok(Trials::ADAPTIVE);
    }
    let number: f64 = text
        .replace('_', "")
        .parse()
        .map_err(|_| say!("write a number such as 1_000_000 or 1e6, or `adaptive`"))?;
    if !RANGE.contains(&number) || number.fract() != 0.0 {
        return Err(say!("write a whole number of trials from 1000 to 1e12, or `adaptive`").into());
    }
    Ok(Trials::Fixed(number as u64))
}

pub(super) fn parse_points(text: &str) -> Result<Points, Complaint> {
    match text {
        "random" => Ok(Points::Random),
        "quasi-random" => Ok(Points::QuasiRandom),
        _ => Err(say!("write `random` or `quasi-random`").into()),
    }
}

pub(super) fn parse_profile(text: &str) -> Result<&'static Profile, Complaint> {
    budget::profile_named(text).ok_or_else(|| {
        let names: Vec<&str> = budget::PROFILES.iter().map(|p| p.name).collect();
        say!("the profiles are {}", names.join(", ")).into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trials_are_written_in_several_ways() {
        assert_eq!(parse_trials("1_000_000"), Ok(Trials::Fixed(1_000_000)));
        assert_eq!(parse_trials("2e5"), Ok(Trials::Fixed(200_000)));
        assert!(matches!(
            parse_trials("adaptive"),
            Ok(Trials::Adaptive { .. })
        ));
        assert!(
            ["10", "-1", "1.5e3x", "1e13", "nan", "1000.5", ""]
                .iter()
                .all(|t| parse_trials(t).is_err())
        );
    }
}
