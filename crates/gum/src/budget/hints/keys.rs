//! Keys that a table does not have, and what whoever wrote them wants to say.

use gumption_core::distribution::Entry;
use gumption_fault::{Said, nearest, say};
use gumption_format::toml::Table;

use super::words::SYNONYMS;
use crate::budget::tables::{ConventionsTable, FileTable, MonteCarloTable};

/// What to write in place of this key of a table, beyond the known key that it resembles.
pub fn unknown_key(key: &str, table: &str, known: &[&'static str]) -> Option<Said> {
    let distribution = Entry::named(table);
    distribution
        .and_then(|entry| (entry.in_place_of)(key))
        .or_else(|| of_limits(key, known))
        .or_else(|| of_expanded(key, known))
        .or_else(|| of_this_table(key, table, known))
        .or_else(|| of_any_table(key, known))
        .or_else(|| beside(key, table))
}

/// The ends `a` and `b` of a distribution in formulas; `a` is its half-width there as well.
fn of_limits(key: &str, known: &[&'static str]) -> Option<Said> {
    let has_limits = known.contains(&"lower") && known.contains(&"half_width");
    let is_end = ["a", "b", "min", "max", "low", "high", "left", "right"].contains(&key);
    (has_limits && is_end).then(|| {
        say!("the ends are lower = … and upper = …; the half of their distance is half_width = …")
    })
}

/// `U` must not be taken for a misspelt `u`: they differ by the coverage factor.
fn of_expanded(key: &str, known: &[&'static str]) -> Option<Said> {
    if !known.contains(&"certificate") {
        return None;
    }
    match key {
        "U"
        | "U95"
        | "U_95"
        | "k95"
        | "expanded"
        | "expanded_uncertainty"
        | "coverage_factor"
        | "扩展不确定度"
        | "包含因子" => Some(say!(
            "an expanded uncertainty stands with its k: certificate = {{ U = …, k = 2 }}"
        )),
        "k" | "divisor" | "除数" => Some(say!(
            "an expanded uncertainty stands with its k: certificate = {{ U = …, k = 2 }}; the divisor of limits follows from their distribution"
        )),
        _ => None,
    }
}

/// What is mistaken in tables of one kind alone.
fn of_this_table(key: &str, table: &str, known: &[&'static str]) -> Option<Said> {
    let word = key.to_lowercase();
    let is_near = || nearest(key, known.iter().copied()).is_some();
    match table {
        "certificate" => of_certificate(&word).or_else(|| of_unit(&word)),
        "[input]" => of_reason(key, &word, known).or_else(|| of_knowledge(&word, known)),
        "a component" => of_knowledge(&word, known).or_else(|| of_unit(&word)),
        "[source]" if key == "value" => Some(say!(
            "a source is an error about zero: its value, where it has one, is a correction of the inputs on which it acts"
        )),
        "[source]" => of_reason(key, &word, known),
        "[constant]" if ["u", "half_width", "certificate", "components", "U", "k"].contains(&key) => {
            Some(say!(
                "a constant is exact; what is uncertain stands below [input]"
            ))
        }
        "[measurand]" => of_measurand(key, &word).or_else(|| an_input(key, known)),
        "[conformity]" => of_conformity(&word).or_else(|| of_unit(&word)),
        "specification" | "pooled" => of_unit(&word),
        "distribution" => of_distribution(&word),
        "[[correlation]]" => of_correlation(key, &word, is_near),
        "[[joint]]" => (word == "readings").then(|| {
            say!(
                "the readings stand with each input, in the same order: [input.V] readings = […], [input.I] readings = […]"
            )
        }),
        "a CSV column in groups" => Some(say!(
            "groups are lists of readings, one for each group: groups = [[…], […]]"
        )),
        "a CSV column" => of_csv_column(&word, is_near),
        "[series]" => (!is_near()).then(|| {
            say!(
                "the columns of a series are named once, its rows follow: columns = [\"{key}\"], rows = [[…], […]]"
            )
        }),
        "[fit]" => (key.len() == 1).then(|| {
            say!("columns of data stand below `data`: [fit.NAME.data], {key} = {{ values = […] }}")
        }),
        _ => None,
    }
}

fn of_certificate(word: &str) -> Option<Said> {
    match word {
        "u" | "standard_uncertainty" | "标准不确定度" => Some(say!(
            "a certificate states U with its k; the standard uncertainty that one states stands alone: u = …"
        )),
        "half_width" | "limits" | "accuracy" | "mpe" | "tolerance" | "class" | "允差"
        | "最大允许误差" => Some(say!(
            "limits ±a are no expanded uncertainty: half_width = … in the place of `certificate`"
        )),
        "u_rel" | "urel" | "u_r" | "rel_u" | "relative" | "relative_u" => Some(say!(
            "a relative expanded uncertainty has its unit: U = \"0.1 %\", or \"50 ppm\"; of a quantity that is itself a ratio write certificate = {{ U = 0.001, k = 2 }} and relative = true beside it"
        )),
        _ => None,
    }
}

fn of_unit(word: &str) -> Option<Said> {
    (word == "unit").then(|| {
        say!(
            "a plain number is in the unit of the quantity; another unit stands with its number: \"0.1 mg\""
        )
    })
}

/// Reasons for doubt by their names, in inputs and sources.
fn of_reason(key: &str, word: &str, known: &[&'static str]) -> Option<Said> {
    match word {
        "repeatability" | "reproducibility" | "drift" | "stability" | "calibration"
        | "temperature" | "linearity" | "hysteresis" | "uniformity" | "重复性" | "复现性"
        | "漂移" | "稳定性" | "校准" | "温度" | "线性" | "滞后" | "均匀性"
            if known.contains(&"components") =>
        {
            Some(say!(
                "reasons for doubt are entries of a list: components = [{{ name = \"{key}\", half_width = … }}, …], what is known of each in its own way"
            ))
        }
        "u_a" | "u_b" | "ua" | "ub" | "a类" | "b类" if known.contains(&"components") => {
            Some(say!(
                "types A and B are components side by side: components = [{{ readings = […] }}, {{ u = 0.02 }}]"
            ))
        }
        _ => None,
    }
}

/// What is known of an input, or of one of its components.
fn of_knowledge(word: &str, known: &[&'static str]) -> Option<Said> {
    match word {
        "accuracy" | "accuracy_class" | "class" | "mpe" | "spec" | "tolerance" | "error"
        | "error_limit" | "limit_error" | "max_error" | "允差" | "误差限" | "最大允许误差"
        | "准确度等级"
            if known.contains(&"specification") =>
        {
            Some(say!(
                "limits ±a are half_width = …; those of an instrument that depend on its reading specification = {{ reading = \"0.05 %\", counts = 2, step = … }}"
            ))
        }
        "c" | "ci" | "c_i" | "sensitivity_coefficient" | "灵敏系数" => Some(say!(
            "sensitivity coefficients follow from the model; one that is known is a factor in it"
        )),
        "correlation" | "correlated" | "相关系数" => Some(say!(
            "write [[correlation]], between = [\"A\", \"B\"] with the names of two inputs, and r = …"
        )),
        "s" | "n" | "standard_deviation" | "std_dev" | "stddev" | "标准差" | "标准偏差"
        | "实验标准差"
            if known.contains(&"pooled") =>
        {
            Some(say!(
                "s of n readings that are not listed: pooled = {{ s = …, dof = n - 1 }}, of = n"
            ))
        }
        _ => None,
    }
}

fn of_measurand(key: &str, word: &str) -> Option<Said> {
    match word {
        "limit" | "limits" | "lower" | "upper" | "mpe" | "nominal" | "tolerance" | "允差"
        | "最大允许误差" => Some(say!(
            "what the result has to keep to stands below [conformity]: lower = … and upper = …, or mpe = … about a nominal = …, and the rule"
        )),
        "value" | "readings" | "u" | "half_width" | "certificate" => Some(say!(
            "what is known of a quantity stands with an input: model = \"x\", and below [input.x] {key} = …"
        )),
        "name" | "symbol" => Some(say!("its name stands in the header: [measurand.NAME]")),
        "functions" | "function" | "model2" | "equations" => Some(say!(
            "functions and intermediate quantities are lines of the `model`, above its last one: f(x) = …"
        )),
        "digits" | "rounding" | "coverage" => Some(of_conventions()),
        _ => for_all_results(word),
    }
}

fn of_conformity(word: &str) -> Option<Said> {
    matches!(word, "tolerance" | "limits" | "limit")
        .then(|| say!("a tolerance is lower = … and upper = …, or mpe = … about a nominal = …"))
}

fn of_distribution(word: &str) -> Option<Said> {
    matches!(word, "type" | "name" | "kind" | "shape").then(|| {
        say!("the shape that goes with another way is a text: distribution = \"triangular\"")
    })
}

fn of_correlation(key: &str, word: &str, is_near: impl Fn() -> bool) -> Option<Said> {
    if let "matrix" | "correlation" | "coefficients" | "covariance" = word {
        return Some(say!(
            "a matrix stands in [[joint]]: inputs = [\"a\", \"b\"] and correlation = [[1, 0.3], [0.3, 1]], or covariance = [[…], […]]"
        ));
    }
    match key.split_once(',') {
        Some((one, other)) => {
            let (one, other) = (one.trim(), other.trim());
            Some(say!(
                "write [[correlation]], between = [\"{one}\", \"{other}\"] and r = …"
            ))
        }
        None if is_near() => None,
        None => Some(say!(
            "write [[correlation]], between = [\"A\", \"B\"] with the names of two inputs, and r = …"
        )),
    }
}

fn of_csv_column(word: &str, is_near: impl Fn() -> bool) -> Option<Said> {
    match word {
        "k" | "u" | "p" | "dof" => Some(say!(
            "an expanded uncertainty is stated as certificate = {{ U = …, k = 2 }}, a standard uncertainty as a number: u = 0.1, dof = 9"
        )),
        _ if is_near() => None,
        _ => Some(say!(
            "a number or a list stands without braces, and other keys beside it: u = 0.1, dof = 9; in braces stands a column of a file"
        )),
    }
}

/// What is mistaken in every table that has such keys.
fn of_any_table(key: &str, known: &[&'static str]) -> Option<Said> {
    let has = |wanted: &str| known.contains(&wanted);
    match key.to_lowercase().as_str() {
        "u_rel" | "urel" | "u_r" | "rel_u" | "relative_u" | "relative_uncertainty"
            if has("relative") =>
        {
            Some(say!(
                "a relative uncertainty is u = \"0.1 %\", or u = 0.001 with relative = true"
            ))
        }
        "upper" | "lower" | "min" | "max" if has("limits") => Some(say!(
            "limits of the quantity itself are limits = [lower, upper], distances from its value plus = … and minus = …"
        )),
        shape if has("distribution") && has_limits(shape) => Some(say!(
            "a shape goes with what it spreads over: half_width = …, distribution = \"{shape}\""
        )),
        word if has("conventions") => of_whole(key, word, known),
        _ => None,
    }
}

/// What is mistaken at the top of a file.
fn of_whole(key: &str, word: &str, known: &[&'static str]) -> Option<Said> {
    match word {
        "language" | "lang" | "语言" => Some(say!(
            "the language of a report is chosen where it is asked for: --lang en, zh or both (in Python, `language=\"zh\"`); a Chinese title is title_zh = …"
        )),
        "procedure" | "recording" | "equations" | "columns" | "noise" | "positions" => Some(say!(
            "`{key}` belongs to an experiment, which `gumption calibrate`, `plan`, `simulate` and `diagnose` read"
        )),
        "certificate" | "laboratory" | "customer" | "item" => Some(say!(
            "data of a certificate stand in a file of their own: --certificate FILE (in Python, `certified(FILE)`); the U and k of a reference stand with its input, certificate = {{ U = …, k = 2 }}"
        )),
        _ => for_all_results(word)
            .or_else(|| header_of(key))
            .or_else(|| {
                let is_budget = known.contains(&"measurand");
                is_budget.then(|| an_input(key, known)).flatten()
            }),
    }
}

fn for_all_results(word: &str) -> Option<Said> {
    matches!(
        word,
        "coverage_probability" | "p" | "confidence" | "confidence_level" | "k" | "coverage_factor"
    )
    .then(of_conventions)
}

fn of_conventions() -> Said {
    say!(
        "what holds for all results stands below [conventions]: coverage_probability = 0.95, or coverage_factor = 2"
    )
}

/// Where a key stands that whoever wrote it has put at the top of the file.
fn header_of(key: &str) -> Option<Said> {
    let below = [
        ("[conventions]", ConventionsTable::keys()),
        ("[monte_carlo]", MonteCarloTable::keys()),
    ];
    let (header, _) = below.into_iter().find(|(_, keys)| keys.contains(&key))?;
    Some(say!("`{key}` stands below the header {header}"))
}

/// A name that resembles no key is that of an input, whose header is missing.
fn an_input(key: &str, known: &[&'static str]) -> Option<Said> {
    let plain = key.to_lowercase().replace(['-', ' '], "_");
    let is_key = FileTable::keys().contains(&key)
        || SYNONYMS
            .iter()
            .any(|(word, meant)| *word == plain && known.contains(meant))
        || nearest(&plain, known.iter().copied()).is_some();
    (!is_key).then(|| {
        say!(
            "an input stands below a header of its own: [input.{key}]; known keys: {}",
            known.join(", ")
        )
    })
}

/// Whether this names a distribution between limits.
fn has_limits(name: &str) -> bool {
    let parameters = Entry::named(name).map(|entry| entry.parameters);
    parameters.is_some_and(|all| all.iter().any(|rule| rule.key == "half_width"))
}

/// What stands beside a table and not in it.
fn beside(key: &str, table: &str) -> Option<Said> {
    if (key, table) == ("k", "specification") {
        return Some(say!(
            "the parts of a specification are limits: where it states a level of confidence, p = 0.95 stands beside it; a U with its k is a certificate, U = a + b·L with k = 2 certificate = {{ U = \"a\", reading = \"b\", k = 2 }}"
        ));
    }
    let beside = ["specification", "certificate"].contains(&table)
        && ["p", "k", "dof", "distribution", "name"].contains(&key);
    beside.then(|| say!("`{key}` stands beside `{table}`, not in it"))
}
