//! A claimed budget as a budget file: what the sheet states, not what it computes.

use std::fmt::Write as _;

use crate::calculate::{Case, Factor, Freedom, t};
use crate::claim::{Claimed, Coverage, Relative, RoundingStated, Row, Shape, Stated};
use crate::printed::Printed;
use crate::read::is_of_type;
use crate::units;
use gumption_core::model::is_reserved;
use gumption_fault::language::Language;
use gumption_fault::{Said, say};
use gumption_format::toml::writing::quoted;

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
    if units::parse(&unit).is_some() {
        let _ = writeln!(text, "unit = {}", quoted(&unit));
    }
    for (i, row) in claimed.rows.iter().enumerate() {
        let input = Input {
            case,
            row,
            line: i,
            name: &names[i],
            of_model: model.is_some(),
            language,
        };
        text += &input.text(&unit);
    }
    for pair in &claimed.correlations {
        let _ = write!(
            text,
            "\n[[correlation]]\nbetween = [{}, {}]\nr = {}\n",
            quoted(&names[pair.a]),
            quoted(&names[pair.b]),
            pair.r
        );
    }
    text
}

/// Whether every row is an input of the model, and only one is.
fn has_all(claimed: &Claimed, model: &str) -> bool {
    let rows = claimed.rows.iter().enumerate();
    rows.clone().all(|(i, row)| {
        let others = rows.clone().filter(|(j, _)| *j != i);
        let alone = others
            .map(|(_, other)| &other.symbol)
            .all(|symbol| *symbol != row.symbol);
        alone && row.not_counted.is_none() && crate::read::has_symbol(model, &row.symbol)
    })
}

/// The title of a file, or what stands for one.
pub(crate) fn title(stated: &str, language: Language) -> String {
    match stated.is_empty() {
        true => say!("Imported budget").in_language(language),
        false => stated.to_owned(),
    }
}

/// What a reader should know, as a comment in a line of its own.
fn remark(said: Said, language: Language) -> String {
    format!("# {}\n", comment(&said.in_language(language)))
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

/// One input of the file.
struct Input<'a> {
    case: &'a Case<'a>,
    row: &'a Row,
    line: usize,
    name: &'a str,
    of_model: bool,
    language: Language,
}

impl Input<'_> {
    fn text(&self, y_unit: &str) -> String {
        let row = self.row;
        let mut text = String::new();
        if let Some(why) = &row.not_counted {
            let label = row.label();
            return format!("\n{}", self.remark(say!("{label} is not counted: {why}")));
        }
        // Of what is known exactly no uncertainty is stated.
        let kind = match self.is_exact() {
            true => "constant",
            false => "input",
        };
        let _ = write!(text, "\n[{kind}.{}]\n", self.name);
        let description = if row.name.is_empty() {
            row.label()
        } else {
            &row.name
        };
        let _ = writeln!(text, "description = {}", quoted(description));
        let said = comment(&row.words);
        if !said.is_empty() && said != *description {
            text += &self.remark(say!("The sheet: {said}"));
        }
        let unit = self.unit(y_unit);
        let value = row.value.as_ref().filter(|_| self.of_model);
        let _ = writeln!(
            text,
            "value = {}",
            value.map_or("0".into(), |v| number(v.value))
        );
        if units::parse(&unit).is_some() {
            let _ = writeln!(text, "unit = {}", quoted(&unit));
        }
        match self.is_exact() {
            true => text,
            false => text + &self.knowledge(&unit),
        }
    }

    /// Whether the sheet states neither a figure of its uncertainty nor one from which that follows.
    fn is_exact(&self) -> bool {
        self.row.stated == Stated::Nothing && self.case.right.lines[self.line].u == 0.0
    }

    /// The unit of the estimate, or of the result for a contribution.
    fn unit(&self, y_unit: &str) -> String {
        if !self.of_model {
            return y_unit.to_string();
        }
        let value = self
            .row
            .value
            .as_ref()
            .map_or("", |value| value.unit.as_str());
        if value.is_empty() {
            self.row.unit.clone()
        } else {
            value.to_string()
        }
    }

    fn remark(&self, said: Said) -> String {
        remark(said, self.language)
    }

    /// What a figure of the row is multiplied by to be in the unit of the input.
    fn factor(&self, unit: &str) -> f64 {
        let line = &self.case.right.lines[self.line];
        if self.of_model {
            units::factor(&self.row.unit, unit).unwrap_or(1.0)
        } else {
            let to_result = units::factor(&self.case.claimed.unit, unit).unwrap_or(1.0);
            (line.c * line.to_y).abs() * to_result
        }
    }

    fn knowledge(&self, unit: &str) -> String {
        let factor = self.factor(unit) * self.row.relative_factor();
        let scaled = |figure: &Printed| number(figure.value * factor);
        let line = &self.case.right.lines[self.line];
        let mut text = String::new();
        if self.row.relative != Relative::No {
            text += &self.remark(say!("Relative on the sheet."));
        }
        let dof = match line.dof.is_finite() {
            true => format!("dof = {}\n", number(line.dof)),
            false => String::new(),
        };
        let standard = || format!("u = {}\n{dof}", number(line.u * self.factor(unit)));
        let limits = |half: f64, shape: Shape| {
            let distribution = match shape {
                Shape::Rectangular => String::new(),
                Shape::Triangular => "distribution = \"triangular\"\n".into(),
                Shape::Arcsine => "distribution = \"arcsine\"\n".into(),
                Shape::Trapezoidal(beta) => {
                    format!("distribution = \"trapezoidal\"\nbeta = {beta}\n")
                }
                Shape::Normal(_) | Shape::TwoPoint => return standard(),
            };
            let half = number(half * factor);
            format!("half_width = {half}\n{distribution}{dof}")
        };
        text += &match &self.row.stated {
            Stated::Certificate {
                expanded,
                k,
                k_stated,
            } => {
                let open = match k_stated {
                    true => String::new(),
                    false => self.remark(say!("The sheet does not state k.")),
                };
                let expanded = scaled(expanded);
                let dof = match dof.trim_end() {
                    "" => String::new(),
                    dof => format!(", {dof}"),
                };
                format!("{open}certificate = {{ U = {expanded}, k = {k:?}{dof} }}\n")
            }
            Stated::Limits {
                half_width,
                shape,
                shape_stated,
            } => {
                let open = match shape_stated {
                    true => String::new(),
                    false => self.remark(say!("Nothing but limits is stated: rectangular.")),
                };
                format!("{open}{}", limits(half_width.value, *shape))
            }
            Stated::FullWidth { width, shape } => limits(width.value / 2.0, *shape),
            Stated::Step { step } => format!("step = {}\n{dof}", scaled(step)),
            Stated::Unequal { plus, minus } => {
                let value = self
                    .row
                    .value
                    .as_ref()
                    .filter(|_| self.of_model)
                    .map_or(0.0, |v| v.value);
                let (low, high) = (value - minus.value * factor, value + plus.value * factor);
                format!("limits = [{}, {}]\n{dof}", number(low), number(high))
            }
            Stated::Deviation { m, .. } | Stated::Range { m, .. } => {
                let of = match *m {
                    1.0 => say!("Of a single reading."),
                    m => say!("Of the mean of {m} readings."),
                };
                format!("{}{}type = \"A\"\n", self.remark(of), standard())
            }
            Stated::Standard { .. } | Stated::Nothing => {
                let remark = self.remark(say!("The sheet states no more than this figure."));
                let is_of_type_a = is_of_type(&self.row.evaluation.to_lowercase(), "a");
                let of_type = if is_of_type_a { "type = \"A\"\n" } else { "" };
                format!("{remark}{}{of_type}", standard())
            }
        };
        text
    }
}

pub(crate) fn comment(text: &str) -> String {
    let plain: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    plain.trim_matches([' ', ';']).to_string()
}

/// A number as it was typed: no digits that a product of doubles adds.
pub(crate) fn number(x: f64) -> String {
    let rounded: f64 = format!("{x:.12e}").parse().unwrap_or(x);
    if rounded != 0.0 && !(1e-4..1e9).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}
