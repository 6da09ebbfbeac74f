//! Profile, conventions and the settings of the Monte Carlo method.

use super::checker::Checker;
use super::factors::no_factor;
use crate::budget::faults::{CONVENTIONS, NOT_POSITIVE, PROBABILITY, TRIALS};
use crate::budget::profile::{PROFILES, profile_named};
use crate::budget::tables::{
    ConventionsTable, FactorWord, FileTable, MonteCarloTable, ResolutionWord, RoundingWord,
};
use crate::budget::variants::TrialsEntry;
use crate::budget::{Adaptive, Conventions, CoverageRule, MonteCarloSettings, Points, Trials};
use gumption_core::quantity::Rounding;
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Stated;
use gumption_format::toml::faults::UNKNOWN_WORD;

/// Trials when the file says nothing: 10⁶ gives two stable digits of a 95 % interval (JCGM 101 7.2.3).
const DEFAULT_TRIALS: u64 = 1_000_000;

/// Trials where those leave the verdict of clause 8 open.
const DECISIVE_TRIALS: u64 = 10_000_000;
/// Fewer trials than this give no meaningful interval.
const FEWEST_TRIALS: u64 = 1000;
const DEFAULT_MAX_TRIALS: u64 = 100_000_000;

/// The conventions of the file's profile with its overrides, the treatment of resolution, and faults.
pub(super) fn conventions(file: &FileTable) -> (Conventions, ResolutionWord, Vec<Fault>) {
    let mut faults = Vec::new();
    let name = file
        .profile
        .as_ref()
        .map_or("GUM", |stated| stated.value.as_str());
    let profile = profile_named(name);
    if let (None, Some(stated)) = (profile, &file.profile) {
        faults.push(unknown_profile(stated));
    }
    let mut conventions = profile.unwrap_or(&PROFILES[0]).conventions();
    let Some(stated) = &file.conventions else {
        return (conventions, ResolutionWord::Add, faults);
    };
    let table = &stated.value;
    numbers(table, &mut conventions, &mut faults);
    choices(table, &mut conventions);
    conventions.overrides = overrides(table);
    (
        conventions,
        table
            .resolution
            .as_ref()
            .map_or(ResolutionWord::Add, |word| word.value),
        faults,
    )
}

fn unknown_profile(stated: &Stated<String>) -> Fault {
    let names: Vec<&str> = PROFILES.iter().map(|profile| profile.name).collect();
    let fault = Fault::new(
        UNKNOWN_WORD,
        stated.span.clone(),
        say!("there is no profile \"{}\"", stated.value),
    )
    .label(say!("expected one of {}", names.join(", ")));
    let written = stated.value.to_uppercase();
    let begins = || {
        let mut names = names.iter().copied();
        names.find(|name| written.starts_with(&name.to_uppercase()))
    };
    match nearest(&stated.value, names.iter().copied()).or_else(begins) {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault,
    }
}

fn numbers(table: &ConventionsTable, conventions: &mut Conventions, faults: &mut Vec<Fault>) {
    if let Some(p) = &table.coverage_probability {
        if p.value > 0.0 && p.value < 1.0 {
            conventions.coverage_probability = p.value;
            conventions.output_probability = p.value;
        } else {
            faults.push(
                Fault::new(
                    PROBABILITY,
                    p.span.clone(),
                    say!("a coverage probability of {}", p.value),
                )
                .label(say!("expected a number between 0 and 1"))
                .help(say!("for 95 % write 0.95")),
            );
        }
    }
    if let Some(k) = &table.coverage_factor {
        if let Some(fault) = no_factor(k, f64::INFINITY, "coverage_probability") {
            faults.push(fault);
        } else if k.value > 0.0 {
            conventions.coverage_factor = CoverageRule::Fixed(k.value);
        } else {
            faults.push(
                Fault::new(
                    NOT_POSITIVE,
                    k.span.clone(),
                    say!("a coverage factor of {}", k.value),
                )
                .label(say!("must be greater than zero")),
            );
        }
    }
    if let (Some(k), Some(rule)) = (&table.coverage_factor, &table.coverage_factor_from) {
        faults.push(
            Fault::new(
                CONVENTIONS,
                rule.key.clone(),
                say!("the coverage factor is stated in two ways"),
            )
            .label(say!("as a rule here"))
            .related(k.key.clone(), say!("as a number here"))
            .help(say!("leave out one")),
        );
    }
    if let Some(digits) = &table.digits {
        match digits.value {
            1 => conventions.digits = 1,
            2 => conventions.digits = 2,
            other => faults.push(
                Fault::new(
                    CONVENTIONS,
                    digits.span.clone(),
                    say!("{other} significant digits"),
                )
                .label(say!("expected 1 or 2"))
                .help(say!(
                    "an uncertainty is reported to at most two significant digits (GUM 7.2.6)"
                )),
            ),
        }
    }
}

fn choices(table: &ConventionsTable, conventions: &mut Conventions) {
    if let Some(rule) = &table.coverage_factor_from {
        conventions.coverage_factor = match rule.value {
            FactorWord::Output => CoverageRule::Output,
            FactorWord::StudentT => CoverageRule::StudentT,
            FactorWord::Normal => CoverageRule::Normal,
        };
    }
    if table.coverage_factor_from.is_some() || table.coverage_probability.is_some() {
        conventions.state_probability = true;
    }
    if let Some(shape) = &table.output_distribution {
        conventions.output_shape = shape.value;
    }
    if let Some(freedom) = &table.degrees_of_freedom {
        conventions.degrees_of_freedom = freedom.value;
    }
    if let Some(rounding) = &table.rounding {
        conventions.rounding = match rounding.value {
            RoundingWord::HalfEven => Rounding::HalfEven,
            RoundingWord::HalfUp => Rounding::HalfUp,
            RoundingWord::Up => Rounding::Up,
        };
    }
    if let Some(scale) = &table.t_scale {
        conventions.t_scale = scale.value;
    }
}

/// The overrides as the file could spell them, in the order of the file.
fn overrides(table: &ConventionsTable) -> Vec<String> {
    let value = |key: &str| -> Option<String> {
        Some(match key {
            "coverage_probability" => table.coverage_probability.as_ref()?.value.to_string(),
            "coverage_factor" => table.coverage_factor.as_ref()?.value.to_string(),
            "coverage_factor_from" => {
                format!("\"{}\"", table.coverage_factor_from.as_ref()?.value.word())
            }
            "output_distribution" => {
                format!("\"{}\"", table.output_distribution.as_ref()?.value.word())
            }
            "degrees_of_freedom" => {
                format!("\"{}\"", table.degrees_of_freedom.as_ref()?.value.word())
            }
            "digits" => table.digits.as_ref()?.value.to_string(),
            "rounding" => format!("\"{}\"", table.rounding.as_ref()?.value.word()),
            "t_scale" => format!("\"{}\"", table.t_scale.as_ref()?.value.word()),
            "resolution" => format!("\"{}\"", table.resolution.as_ref()?.value.word()),
            _ => return None,
        })
    };
    table
        .present
        .iter()
        .filter_map(|(key, _)| value(key).map(|value| format!("{key} = {value}")))
        .collect()
}

impl Checker<'_> {
    /// Reads `[monte_carlo]`.
    pub(super) fn monte_carlo(&mut self, file: &FileTable) -> MonteCarloSettings {
        let none = MonteCarloTable::default();
        let table = file
            .monte_carlo
            .as_ref()
            .map_or(&none, |stated| &stated.value);
        let seed = table.seed.as_ref().map_or(1, |seed| seed.value);
        let points = table
            .points
            .as_ref()
            .map_or(Points::Random, |word| word.value);
        let trials = match table.trials.as_deref() {
            Some(Stated {
                value: TrialsEntry::Adaptive,
                ..
            }) => self.adaptive(table),
            None if points == Points::QuasiRandom => self.adaptive(table),
            stated => {
                self.fixed_only(table, stated);
                let decisive = Trials::Decisive {
                    least: DEFAULT_TRIALS,
                    most: DECISIVE_TRIALS,
                };
                stated.map_or(decisive, |stated| Trials::Fixed(fixed(stated)))
            }
        };
        MonteCarloSettings {
            seed,
            trials,
            points,
            indices: table.indices.as_ref().is_some_and(|stated| stated.value),
        }
    }

    fn fixed_only(&mut self, table: &MonteCarloTable, trials: Option<&Stated<TrialsEntry>>) {
        for (key, span) in &table.present {
            if ["procedure", "digits", "max_trials"].contains(key) {
                let fault = Fault::new(
                    TRIALS,
                    span.clone(),
                    say!("`{key}` goes with trials = \"adaptive\""),
                )
                .label(say!("no meaning for a fixed number of trials"));
                let fault = match trials {
                    Some(trials) => {
                        fault.related(trials.span.clone(), say!("a fixed number of trials"))
                    }
                    None => fault,
                };
                self.messages
                    .faults
                    .push(fault.help(say!("add trials = \"adaptive\", or remove it")));
            }
        }
        if let Some(trials) = trials.filter(|trials| fixed(trials) < FEWEST_TRIALS) {
            self.report(
                Fault::new(
                    TRIALS,
                    trials.span.clone(),
                    say!("{} trials are too few", fixed(trials)),
                )
                .label(say!("expected at least {FEWEST_TRIALS}"))
                .help(say!(
                    "write 1_000_000, which takes a moment and gives two stable digits"
                )),
            );
        }
    }

    fn adaptive(&mut self, table: &MonteCarloTable) -> Trials {
        let procedure = table
            .procedure
            .as_ref()
            .map_or(Adaptive::Stein, |word| word.value);
        let digits = match table.digits.as_ref().map(|digits| digits.value) {
            Some(1) => 1,
            Some(2) | None => 2,
            Some(other) => {
                let span = table
                    .digits
                    .as_ref()
                    .map_or(0..0, |digits| digits.span.clone());
                self.report(
                    Fault::new(TRIALS, span, say!("{other} significant digits"))
                        .label(say!("expected 1 or 2")),
                );
                2
            }
        };
        if let Some(max) = table
            .max_trials
            .as_ref()
            .filter(|max| max.value < FEWEST_TRIALS)
        {
            self.report(
                Fault::new(
                    TRIALS,
                    max.span.clone(),
                    say!("at most {} trials are too few", max.value),
                )
                .label(say!("expected at least {FEWEST_TRIALS}")),
            );
        }
        let max = table
            .max_trials
            .as_ref()
            .map_or(DEFAULT_MAX_TRIALS, |max| max.value);
        Trials::Adaptive {
            procedure,
            digits,
            max,
        }
    }
}

fn fixed(trials: &Stated<TrialsEntry>) -> u64 {
    match trials.value {
        TrialsEntry::Fixed(count) => count,
        TrialsEntry::Adaptive => DEFAULT_TRIALS,
    }
}
