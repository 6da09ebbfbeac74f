//! One figure: wherever a document names y, u, ν, k, U or the interval of a result, it is the reported value, rounded
//! by the rules. Over the library and generated budgets, every profile, language and format.

use std::path::Path;

use gumption::budget::{self, Budget, CoverageRule, Heading, PROFILES, Trials};
use gumption::document::{Block, Document};
use gumption::propagate::{
    self, Evaluation, MonteCarloChoice, Options, Reported, ReportedUncertainty,
};
use gumption::quantity::Rounding;
use gumption::render::{FORMATS, Page};
use gumption::report::{self, Language, Report};

use crate::common::{self, Noise};

/// Enough for either verdict of clause 8 on some budget.
const TRIALS: u64 = 20_000;

/// A printed number, with the place of its last digit.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Printed {
    value: f64,
    unit: f64,
    digits: usize,
    /// Zeros at the end of a whole number, which may only fill up to the decimal marker.
    zeros: usize,
}

impl Printed {
    /// The number at the start of a text: `-1.20×10^-5`, `∞`.
    fn at_start(text: &str) -> Option<Printed> {
        if text.starts_with('∞') {
            let value = f64::INFINITY;
            return Some(Printed {
                value,
                unit: 0.0,
                digits: 0,
                zeros: 0,
            });
        }
        let taken = |text: &str| {
            let more = text.char_indices().find(|(at, c)| {
                !(c.is_ascii_digit() || *c == '.' || *at == 0 && "-−".contains(*c))
            });
            more.map_or(text.len(), |(at, _)| at)
        };
        let end = taken(text);
        let mantissa = text[..end].trim_end_matches('.').replace('−', "-");
        let mut exponent = 0;
        if let Some(power) = text[end..].strip_prefix("×10^") {
            let power = power[..taken(power)].trim_end_matches('.');
            exponent = power.replace('−', "-").parse().ok()?;
        }
        let decimals = mantissa.split_once('.').map_or(0, |(_, after)| after.len());
        let significant = mantissa.trim_start_matches(['-', '0', '.']);
        Some(Printed {
            value: format!("{mantissa}e{exponent}").parse().ok()?,
            unit: 10f64.powi(exponent - i32::try_from(decimals).ok()?),
            digits: significant.chars().filter(char::is_ascii_digit).count(),
            zeros: match mantissa.contains('.') {
                true => 0,
                false => significant.len() - significant.trim_end_matches('0').len(),
            },
        })
    }

    /// The same with no more digits than these, as far as zeros at its end may only fill up.
    fn of_digits(self, digits: usize) -> Printed {
        let filling = self.digits.saturating_sub(digits).min(self.zeros);
        Printed {
            unit: self.unit * 10f64.powi(filling as i32),
            digits: self.digits - filling,
            zeros: self.zeros - filling,
            ..self
        }
    }

    /// Whether it is the number, rounded to nearest.
    fn is_nearest(&self, x: f64) -> bool {
        self.value == x
            || (self.value - x).abs() <= 0.5 * self.unit * (1.0 + 1e-6) + 1e-14 * x.abs()
    }

    /// Whether it is the number, rounded up.
    fn is_next(&self, x: f64) -> bool {
        let more = self.value - x;
        more >= -1e-9 * self.unit - 1e-14 * x.abs() && more < self.unit * (1.0 + 1e-6)
    }
}

/// What may be named, and what is reported under it.
struct Expected<'a> {
    budget: &'a Budget,
    reported: Vec<Reported>,
    /// ν_eff as the formula gives it, beside the one that gave k.
    freedom: Vec<f64>,
}

impl Expected<'_> {
    fn of<'a>(budget: &'a Budget, evaluation: &Evaluation) -> Expected<'a> {
        let results = || evaluation.results.iter();
        Expected {
            budget,
            reported: results().map(|r| r.reported(&budget.conventions)).collect(),
            freedom: results().map(|r| r.gum.freedom.value()).collect(),
        }
    }

    /// Whether what stands behind a symbol is the figure of one of the measurands.
    fn holds(&self, symbol: &str, printed: Printed) -> bool {
        let mut all = self.reported.iter().zip(&self.freedom);
        let outputs = self.budget.model.outputs().iter().zip(&self.reported);
        // Measurands may have the name of a symbol.
        let mut called = outputs.filter(|(output, _)| output.name == symbol);
        let is_value = called.any(|(_, reported)| printed.is_nearest(reported.estimate));
        is_value
            || all.any(|(reported, freedom)| match symbol {
                "U" => reported
                    .expanded()
                    .is_some_and(|u| self.is_expanded(printed, u)),
                "u" | "u_c" => reported.u.is_some_and(|u| {
                    // Beside an interval u has the last place of y.
                    let beside =
                        matches!(reported.uncertainty, ReportedUncertainty::Interval { .. });
                    printed.is_nearest(u) && (matches!(printed.digits, 2 | 3) || u == 0.0)
                        || beside && self.is_expanded(printed, u)
                }),
                "k" => reported
                    .coverage_factor()
                    .is_some_and(|k| printed.is_nearest(k)),
                _ => {
                    is_freedom(printed, *freedom)
                        || reported.dof.is_some_and(|nu| is_freedom(printed, nu))
                }
            })
    }

    fn is_expanded(&self, printed: Printed, expanded: f64) -> bool {
        let conventions = &self.budget.conventions;
        let printed = printed.of_digits(usize::from(conventions.digits));
        let rounded = match conventions.rounding {
            Rounding::Up => printed.is_next(expanded),
            _ => {
                printed.is_nearest(expanded)
                    || conventions.up_if_lowered_by_5_percent && printed.is_next(expanded)
            }
        };
        // A unit of the last digit may be of a number that is rounded up to the next power of ten.
        rounded && printed.digits == usize::from(conventions.digits)
    }

    /// Whether U is k times u_c as a sentence prints all three; where k was rounded, both may be off by half their last digit.
    fn multiplies(&self, sentence: &str) -> bool {
        let named = named(sentence);
        let figure = |symbol| {
            // The measurand, which stands first, may have the name of a symbol.
            let found = named.iter().rfind(|(name, ..)| *name == symbol);
            found.map(|(_, printed, _)| *printed)
        };
        let (Some(expanded), Some(k), Some(u)) = (figure("U"), figure("k"), figure("u_c")) else {
            return true;
        };
        let slack = match self.budget.conventions.coverage_factor {
            CoverageRule::Fixed(_) => 0.0,
            _ => 0.5,
        };
        let gives = |k: f64, u: f64| self.is_expanded(expanded, k * u);
        let multiplies = [-slack, 0.0, slack]
            .into_iter()
            .any(|off| gives(k.value + off * k.unit, u.value + off * u.unit));
        // A third digit stands only where two do not do; halfway between two roundings either may.
        let nearly = |u: f64| [1.0 - 1e-5, 1.0 + 1e-5].map(|by| by * u);
        let two = |u: f64| format!("{u:.1e}").parse::<f64>().expect("a number");
        let all = self.reported.iter().filter_map(|reported| reported.u);
        let mut own = all.filter(|of_one| u.is_nearest(*of_one));
        // A rule that may round up or down gives what is nearest for certain.
        let surely = |u: f64| match self.budget.conventions.rounding {
            Rounding::Up => gives(k.value, u),
            _ => expanded.is_nearest(k.value * u) && gives(k.value, u),
        };
        let needless = u.digits == 3 && own.any(|u| nearly(two(u)).into_iter().all(surely));
        multiplies && !needless
    }

    /// Whether y ± U is the result of a measurand, with one last place.
    fn holds_pair(&self, y: Printed, half: Printed) -> bool {
        let half = half.of_digits(usize::from(self.budget.conventions.digits));
        let finer = (half.unit / y.unit).log10().round() as usize;
        let mut y = y.of_digits(y.digits.saturating_sub(finer));
        if y.digits == 0 && y.unit == 1.0 {
            // A nought has the place of U, whose noughts fill up.
            y.unit = half.unit.max(1.0);
        }
        self.reported.iter().any(|reported| {
            let expanded = reported.expanded();
            let expanded = expanded.is_some_and(|u| self.is_expanded(half, u));
            expanded && y.is_nearest(reported.estimate) && (y.unit / half.unit - 1.0).abs() < 1e-9
        })
    }
}

/// Whether it is so many degrees of freedom: ∞ stands for more than 10 000, too, on which k does not depend.
fn is_freedom(printed: Printed, nu: f64) -> bool {
    printed.is_nearest(nu) || printed.value.is_infinite() && nu > 1e4
}

/// The blocks in which the program speaks; what users wrote and tables of both methods, under their names, are left
/// out.
fn spoken(document: &Document) -> Document {
    let mut spoken = document.clone();
    spoken.edit(|blocks| {
        blocks.retain(|block| match block {
            Block::Fields(fields) => fields
                .iter()
                .any(|(_, text)| text.contains("u_c = ") || text.contains("U = ")),
            Block::Statement(_) | Block::Paragraph(_) | Block::List(_) | Block::Figures(_) => true,
            Block::Closing(_) | Block::Findings(_) => true,
            _ => false,
        });
        for block in blocks {
            if let Block::Findings(findings) = block {
                // They speak of the k of a certificate, or of the k that another distribution would have.
                let other = ["below_reference", "few_degrees_of_freedom", "remark"];
                findings.retain(|finding| !other.contains(&finding.id.as_str()));
            }
        }
    });
    spoken
}

/// The words of a written document on one line: without its marks, tags and escapes.
fn plain(format: &str, written: &[u8]) -> String {
    let text = String::from_utf8_lossy(written);
    let text = match format {
        "html" => {
            let body = text.split_once("</head>").map_or(&*text, |(_, body)| body);
            let body = body.replace("<sup>", "^").replace("</sup>", "");
            let body = body.replace("<sub>", "_").replace("</sub>", "");
            let mut words = String::new();
            let mut inside = false;
            for c in body.chars() {
                match c {
                    '<' => inside = true,
                    '>' => {
                        inside = false;
                        words.push(' ');
                    }
                    c if !inside => words.push(c),
                    _ => {}
                }
            }
            words
                .replace("&lt;", "<")
                .replace("&gt;", ">")
                .replace("&amp;", "&")
        }
        "markdown" => text.replace(['\\', '*', '>'], ""),
        _ => text.replace('┃', " "),
    };
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Every figure that a text names, with the words around it.
fn named(text: &str) -> Vec<(&str, Printed, String)> {
    let mut found = Vec::new();
    let symbols: [(&str, &[&str]); 5] = [
        ("U", &["U = ", "U_95 = ", "U_95.45 = "]),
        ("u_c", &["u_c = "]),
        ("u", &["u = "]),
        ("k", &["k = ", "k_95 = ", "k_95.45 = ", "k = U/u = "]),
        ("ν", &["ν_eff = ", "ν_eff ≥ "]),
    ];
    for (symbol, marks) in symbols {
        for mark in marks {
            for (at, _) in text.match_indices(mark) {
                let before = text[..at].chars().next_back();
                let own = before
                    .is_none_or(|c| !(c.is_alphanumeric() && c.is_ascii() || "/_·".contains(c)));
                let after = &text[at + mark.len()..];
                if let (true, Some(printed)) = (own, Printed::at_start(after)) {
                    let start = text[..at]
                        .char_indices()
                        .rev()
                        .nth(40)
                        .map_or(0, |(at, _)| at);
                    let around = text[start..].chars().take(120).collect();
                    found.push((symbol, printed, around));
                }
            }
        }
    }
    found
}

/// Every `(y ± U)`, with its power of ten.
fn pairs(text: &str) -> Vec<(Printed, Printed, String)> {
    let scaled = |number: Printed, power: &str| {
        let one = Printed::at_start(&format!("1{power}"));
        let factor = one.map_or(1.0, |one| one.value);
        Printed {
            value: number.value * factor,
            unit: number.unit * factor,
            ..number
        }
    };
    let mut found = Vec::new();
    for (at, _) in text.match_indices(" ± ") {
        let before = &text[..at];
        let start = before.rfind(|c: char| !(c.is_ascii_digit() || ".-−".contains(c)));
        let start = start.map_or(0, |at| {
            at + before[at..].chars().next().map_or(1, char::len_utf8)
        });
        let after = &text[at + " ± ".len()..];
        let half = after.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        let power = half.strip_prefix(')');
        let power = power
            .filter(|power| power.starts_with("×10^"))
            .unwrap_or_default();
        if let (Some(y), Some(half)) = (
            Printed::at_start(&before[start..]),
            Printed::at_start(after),
        ) {
            let around = text[start..].chars().take(80).collect();
            found.push((scaled(y, power), scaled(half, power), around));
        }
    }
    found
}

/// Holds every document of a budget against what is reported.
fn hold(budget: &Budget, what: &str) -> usize {
    // Notes may name any figure.
    let budget = &Budget {
        heading: Heading::default(),
        claims: Vec::new(),
        ..budget.clone()
    };
    let Ok(evaluation) = propagate::evaluate(
        budget,
        &Options {
            monte_carlo: MonteCarloChoice::AsBudget,
            ..Options::default()
        },
    ) else {
        return 0;
    };
    let expected = Expected::of(budget, &evaluation);
    let mut count = 0;
    for language in [Language::English, Language::Chinese] {
        let report = Report {
            budget,
            evaluation: &evaluation,
            label: None,
            language,
        };
        let document = report::evaluation(&report);
        decisions_and_machine(&expected, &evaluation, &document, what);
        let spoken = spoken(&document);
        for format in FORMATS.iter().filter(|f| f.is_text() && f.name != "json") {
            let written = (format.render)(&spoken, &Page::default()).expect("every document fits");
            let written = plain(format.name, &written);
            for (symbol, printed, around) in named(&written) {
                assert!(
                    expected.holds(symbol, printed),
                    "{what}, {}: {symbol} is {printed:?}, reported is {:?}\n…{around}…",
                    format.name,
                    expected.reported
                );
                count += 1;
            }
            for (y, half, around) in pairs(&written) {
                assert!(
                    expected.holds_pair(y, half),
                    "{what}, {}: {y:?} ± {half:?}, reported is {:?}\n…{around}…",
                    format.name,
                    expected.reported
                );
                count += 1;
            }
            for sentence in report::statement(&report) {
                let sentence = sentence.split_whitespace().collect::<Vec<_>>().join(" ");
                assert!(expected.multiplies(&sentence), "{what}: {sentence}");
                assert!(
                    squeezed(&written).contains(&squeezed(&sentence)),
                    "{what}, {}: {sentence}\nis not in\n{written}",
                    format.name
                );
            }
        }
    }
    count
}

/// Without spaces, which lines break at, and marks that a format writes in its own way.
fn squeezed(text: &str) -> String {
    let marks = "\\*_>`^\u{2060}\u{200b}&;";
    let text = text.replace('−', "-").replace("&quot;", "\"");
    let kept = text
        .chars()
        .filter(|c| !(c.is_whitespace() || marks.contains(*c)));
    kept.collect()
}

/// Decisions rest on the reported figures, and machines are told the same.
fn decisions_and_machine(
    expected: &Expected<'_>,
    evaluation: &Evaluation,
    document: &Document,
    what: &str,
) {
    let conformity = expected
        .budget
        .conformity
        .iter()
        .zip(&evaluation.conformity);
    for (stated, found) in conformity.filter(|(stated, _)| !stated.planning) {
        let reported = &expected.reported[stated.measurand];
        assert_eq!(
            (found.estimate, found.expanded),
            (reported.estimate, reported.half_width()),
            "{what}: decided on other figures"
        );
    }
    let number = |x: Option<f64>| match x {
        None => serde_json::Value::Null,
        Some(x) if x.is_infinite() => "inf".into(),
        Some(x) => x.into(),
    };
    let machine = document.machine.value();
    for (place, reported) in expected.reported.iter().enumerate() {
        let told = &machine["measurands"][place]["reported"];
        assert_eq!(told["estimate"], number(Some(reported.estimate)), "{what}");
        assert_eq!(told["standard_uncertainty"], number(reported.u), "{what}");
        assert_eq!(
            told["expanded_uncertainty"],
            number(reported.expanded()),
            "{what}"
        );
        assert_eq!(
            told["coverage_factor"],
            number(reported.coverage_factor()),
            "{what}"
        );
        assert_eq!(told["degrees_of_freedom"], number(reported.dof), "{what}");
    }
}

/// The text of a budget under another profile.
fn under(text: &str, profile: &str) -> String {
    let others = text.lines().filter(|line| !line.starts_with("profile ="));
    format!(
        "profile = \"{profile}\"\n{}\n",
        others.collect::<Vec<_>>().join("\n")
    )
}

/// The budgets of a text under every profile, each with few trials.
fn under_every_profile(text: &str, folder: &Path, what: &str) -> usize {
    /// Of a long series the first rows.
    const MOST: usize = 3;
    let of = |profile: &str| {
        let Ok(loaded) = budget::read(&under(text, profile), "test.toml", folder) else {
            return 0;
        };
        let rows = loaded.rows.into_iter().take(MOST);
        rows.map(|mut row| {
            row.budget.monte_carlo.trials = Trials::Fixed(TRIALS);
            hold(&row.budget, &format!("{what}, {profile}"))
        })
        .sum()
    };
    PROFILES.iter().map(|profile| of(profile.name)).sum()
}

#[test]
fn the_library_names_one_figure_under_every_profile() {
    let files = common::files("budgets", "toml");
    let count: usize = files
        .iter()
        .map(|path| {
            let text = std::fs::read_to_string(path).expect("a readable budget");
            let folder = path.parent().expect("a folder");
            under_every_profile(&text, folder, &common::relative(path))
        })
        .sum();
    assert!(
        count > 100 * files.len(),
        "{count} figures in {} budgets",
        files.len()
    );
}

/// A budget of what makes results of every kind: few readings, lopsided limits, factors near zero, correlations,
/// directions, several measurands, limits of conformity.
fn generated(noise: &mut Noise) -> String {
    let pick = |noise: &mut Noise, all: &[&str]| {
        let place = (noise.uniform() * all.len() as f64) as usize;
        all[place].to_string()
    };
    let inputs = 2 + (noise.uniform() * 3.0) as usize;
    let names: Vec<String> = ["a", "b", "c", "d"][..inputs]
        .iter()
        .map(|name| name.to_string())
        .collect();
    let mut text = String::from("title = \"Generated\"\n");
    let mut models = String::new();
    let measurands = 1 + (noise.uniform() * 2.4) as usize;
    for m in 0..measurands {
        let mut model = names[(noise.uniform() * inputs as f64) as usize].clone();
        for name in &names {
            model = match pick(noise, &["+", "-", "*", "/", "square", "phase", "root", ""]).as_str()
            {
                "square" => format!("{model} + ({name} - 10)^2"),
                "phase" => format!("({model}) + atan2({name} - 10, {name} - 9.99)"),
                "root" => format!("sqrt(({model})^2 + {name}^2)"),
                "" => model,
                operation => format!("({model}) {operation} {name}"),
            };
        }
        models += &format!("[measurand.y{m}]\nmodel = \"{model}\"\n");
    }
    text += &models;
    for name in &names {
        let value = 10.0 + noise.normal();
        let u = 10f64.powf(-3.0 * noise.uniform());
        let scatter = |noise: &mut Noise, n: usize| {
            let all = (0..n).map(|_| format!("{:.4}", value + u * noise.normal()));
            all.collect::<Vec<_>>().join(", ")
        };
        let kind = pick(
            noise,
            &[
                "two",
                "three",
                "five",
                "t",
                "rectangle",
                "lopsided",
                "certificate",
                "normal",
            ],
        );
        text += &match kind.as_str() {
            "two" => format!("[input.{name}]\nreadings = [{}]\n", scatter(noise, 2)),
            "three" => format!("[input.{name}]\nreadings = [{}]\n", scatter(noise, 3)),
            "five" => format!("[input.{name}]\nreadings = [{}]\n", scatter(noise, 5)),
            "t" => format!(
                "[input.{name}]\nvalue = {value:.3}\nu = {u:.4}\ndof = {}\n",
                1 + (noise.uniform() * 9.0) as u32
            ),
            "rectangle" => format!("[input.{name}]\nvalue = {value:.3}\nhalf_width = {u:.4}\n"),
            "lopsided" => format!(
                "[input.{name}]\nvalue = {value:.3}\nplus = {u:.4}\nminus = {:.4}\n",
                0.2 * u + 1e-4
            ),
            "certificate" => format!(
                "[input.{name}]\nvalue = {value:.3}\ncertificate = {{ U = {u:.4}, k = 2 }}\n"
            ),
            _ => format!("[input.{name}]\nvalue = {value:.3}\nu = {u:.4}\n"),
        };
    }
    if noise.uniform() < 0.4 {
        text += &format!(
            "[[correlation]]\nbetween = [\"a\", \"b\"]\nr = {:.2}\n",
            1.8 * noise.uniform() - 0.9
        );
    }
    if noise.uniform() < 0.5 {
        text += &format!(
            "[conventions]\ndigits = {}\nrounding = \"{}\"\n",
            1 + u32::from(noise.uniform() < 0.5),
            pick(noise, &["half-even", "half-up", "up"])
        );
    }
    if noise.uniform() < 0.5 {
        text += &format!(
            "[conformity]\nmeasurand = \"y0\"\nupper = {:.3}\nrule = \"{}\"\n",
            20.0 * noise.uniform(),
            pick(noise, &["simple", "guarded-acceptance"])
        );
    }
    text
}

#[test]
fn generated_budgets_name_one_figure_under_every_profile() {
    let (mut count, mut read) = (0, 0);
    for seed in 0..32 {
        let text = generated(&mut Noise(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed + 1)));
        let found = under_every_profile(&text, Path::new(""), &format!("seed {seed}\n{text}"));
        count += found;
        read += usize::from(found > 0);
    }
    assert!(
        read >= 20 && count > 4_000,
        "{read} budgets read, {count} figures"
    );
}
