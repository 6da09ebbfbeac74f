//! A claimed budget as a budget file: what the sheet states, not what it computes.

mod input;
mod writing;

use std::fmt::Write as _;

use crate::calculate::{Case, Factor, Freedom, t};
use crate::claim::{Claimed, Coverage, RoundingStated, Stated};
use crate::units;
use gumption_core::model::is_reserved;
use gumption_fault::language::Language;
use gumption_fault::say;
use gumption_format::toml::writing::{correlation, quoted};

use input::Input;
pub(crate) use writing::{comment, number};
use writing::{line_of_unit, of_symbol, remark};

/// A budget file, with remarks as comments, in a language, where the sheet leaves something open.
pub(crate) fn budget_file(case: &Case<'_>, language: Language) -> String {
    let claimed = case.claimed;
    let names = names(claimed);
    let mut text = String::new();
    let _ = writeln!(text, "title = {}", quoted(&title(&claimed.title, language)));
    text += &conventions(case, language);
    let measurand = identifier(&claimed.measurand, "y");
    let unit = unit_of_result(claimed);
    // A model needs the estimates of all its inputs; without them, contributions are added.
    let model = claimed
        .model
        .as_ref()
        .filter(|model| case.y.is_some() && case.by_units && has_all(claimed, model));
    let unit = match model {
        Some(_) => unit,
        None => of_difference(unit),
    };
    let _ = write!(text, "\n[measurand.{measurand}]\n");
    match model {
        Some(model) => {
            let formula = crate::calculate::formula(model, claimed, &names);
            let _ = writeln!(text, "model = {}", quoted(&formula));
        }
        None => {
            let counted = claimed
                .rows
                .iter()
                .zip(&names)
                .filter(|(row, _)| row.not_counted.is_none());
            let sum: Vec<&str> = counted.map(|(_, name)| name.as_str()).collect();
            text += &remark(
                say!(
                    "The sheet has no model that holds with its estimates and their units: inputs are contributions to the result, coefficients included."
                ),
                language,
            );
            let _ = writeln!(text, "model = {}", quoted(&sum.join(" + ")));
        }
    }
    text += &line_of_unit(&unit);
    for (line, name) in names.iter().enumerate() {
        let input = Input {
            case,
            line,
            name,
            of_model: model.is_some(),
            language,
        };
        text += &input.text(&unit);
    }
    for pair in &claimed.correlations {
        let between = [pair.a, pair.b].map(|i| reason(claimed, &names, i, model.is_some()));
        text += &correlation([&between[0], &between[1]], pair.r);
    }
    text
}

/// Whether every row is an input of the model, or a reason to doubt one.
fn has_all(claimed: &Claimed, model: &str) -> bool {
    claimed.rows.iter().enumerate().all(|(i, row)| {
        let alike = of_symbol(claimed, i);
        let is_counted = |j: &usize| claimed.rows[*j].not_counted.is_none();
        // Limits that are not equal say where the estimate is, which several rows do not.
        let is_component = alike.len() == 1 || !matches!(row.stated, Stated::Unequal { .. });
        alike.iter().any(is_counted) && is_component && crate::read::has_symbol(model, &row.symbol)
    })
}

/// What the file calls a row: an input, or one of several components of it.
fn reason(claimed: &Claimed, names: &[String], i: usize, of_model: bool) -> String {
    match of_symbol(claimed, i).as_slice() {
        [first, _, ..] if of_model => {
            format!("{}.{}", names[*first], input::component_name(claimed, i))
        }
        _ => names[i].clone(),
    }
}

/// The title of a file, or what stands for one.
pub(crate) fn title(stated: &str, language: Language) -> String {
    match stated.is_empty() {
        true => say!("Imported budget").in_language(language),
        false => stated.to_owned(),
    }
}

fn conventions(case: &Case<'_>, language: Language) -> String {
    let mut lines = vec![coverage(case, language)];
    match case.claimed.rounding {
        RoundingStated::Up => lines.push("rounding = \"up\"".into()),
        RoundingStated::Nearest | RoundingStated::Unstated => {}
    }
    format!("\n[conventions]\n{}\n", lines.join("\n"))
}

/// The rule for k with which the sheet is recomputed.
fn coverage(case: &Case<'_>, language: Language) -> String {
    let fixed = |k: f64| format!("coverage_factor = {k:?}");
    let open = match states_rule(case) {
        true => String::new(),
        false => remark(say!("The sheet states no rule for k."), language),
    };
    let rule = match (case.claimed.coverage, case.right.factor, case.right.freedom) {
        (Coverage::OfRectangle, ..) | (_, Factor::Rectangle, _) => {
            "output_distribution = \"dominant\"".into()
        }
        (_, Factor::Fixed(k), _) => fixed(k),
        // The inputs of the file do not give what the sheet states of the whole.
        (_, Factor::StudentT(p), Freedom::Given(nu)) | (_, Factor::At(p, nu), _) => {
            let of_freedom = say!("k is that of ν_eff = {nu}, which the sheet states.");
            let k = libm::round(100.0 * t(p, case.right.whole(nu))) / 100.0;
            remark(of_freedom, language) + &fixed(k)
        }
        (_, Factor::StudentT(p), _) => {
            format!("coverage_probability = {p}\ncoverage_factor_from = \"t\"")
        }
    };
    open + &rule
}

/// Whether the sheet says how k is found: by a rule, by k itself, or by the probability beside it.
fn states_rule(case: &Case<'_>) -> bool {
    let claimed = case.claimed;
    let k = claimed.footer.k.as_ref();
    match case.right.factor {
        _ if claimed.coverage != Coverage::Unstated => true,
        Factor::Fixed(factor) => k.is_some_and(|k| k.is_met_by(factor)),
        Factor::StudentT(p) => {
            let unusual = crate::read::unusual_level(claimed);
            crate::read::names_level(&claimed.words, p) || unusual == Some(p)
        }
        Factor::At(..) | Factor::Rectangle => false,
    }
}

fn unit_of_result(claimed: &Claimed) -> String {
    let own = claimed.footer.y.as_ref().map_or("", |y| y.unit.as_str());
    if own.is_empty() {
        claimed.unit.clone()
    } else {
        own.to_string()
    }
}

/// The unit of contributions, which are differences: two points of the Celsius scale have no sum.
fn of_difference(unit: String) -> String {
    let known = units::parse(&unit).filter(gumption_core::quantity::Unit::is_point);
    known.map_or(unit, |known| known.difference().symbol.clone())
}

/// Names that the model language takes, one for each row.
fn names(claimed: &Claimed) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (i, row) in claimed.rows.iter().enumerate() {
        let wanted = identifier(&row.symbol, &format!("x_{}", i + 1));
        let result = identifier(&claimed.measurand, "y");
        let is_free = |name: &String| !names.contains(name) && *name != result;
        let numbered = (i + 1..).map(|number| format!("x_{number}"));
        let name = std::iter::once(wanted).chain(numbered).find(is_free);
        names.extend(name);
    }
    names
}

/// A symbol as an identifier; another name where it is none.
fn identifier(symbol: &str, otherwise: &str) -> String {
    let plain = symbol
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == '_');
    let begins = symbol.starts_with(|c: char| c.is_ascii_alphabetic());
    match plain && begins && !is_reserved(symbol) {
        true => symbol.to_string(),
        false => otherwise.to_string(),
    }
}
