//! The declared model with effects in it: further columns for the modifiers, further parameters for the
//! sizes, and the equations that contain them; its fit, its coefficients, how well it does.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::case::{Case, Column, Data, Parameter, Role};
use super::catalogue::{FittedModel, Node, Term, Variation};
use super::design::{Design, UnknownKind};
use super::evidence::{Baseline, TRACE};
use gumption_core::quantity::Unit;

/// A case with effects in its model.
#[derive(Debug)]
pub struct Extended {
    /// The case.
    pub case: Case,
    /// What was added, one for each coefficient.
    pub additions: Vec<Addition>,
    /// The effects that were added.
    pub effects: Vec<Free>,
    /// The columns that were added.
    pub(super) columns: Vec<Following>,
}

/// A column that was added: what effects follow.
#[derive(Debug)]
pub(super) struct Following {
    pub name: String,
    /// Index of the first effect that follows it.
    pub effect: usize,
    /// Its first term that does.
    pub term: Term,
}

impl Extended {
    /// The columns that were added, with the formulas that define them.
    pub fn definitions(&self) -> impl Iterator<Item = (&str, &str)> {
        let columns = self.columns.iter();
        columns.map(|column| (column.name.as_str(), column.term.written().text.as_str()))
    }

    /// Whether an unknown is a coefficient that was added.
    pub(super) fn adds(&self, unknown: &str) -> bool {
        (self.additions.iter()).any(|addition| addition.parameter == unknown)
    }
}

/// What of an effect is free beside the declared parameters. A term that they absorb, but for the rounding of
/// recorded values, is theirs: a coefficient of its own could take any value.
#[derive(Debug)]
pub struct Free {
    /// The effect with its free terms.
    pub variation: Variation,
    /// Which of its coefficients are free.
    pub coefficients: Vec<usize>,
    /// What the examination found for each of these; NaN where it did not determine it.
    pub sizes: Vec<f64>,
}

impl Free {
    /// From an effect and the sizes of all its coefficients.
    pub(super) fn of(
        fitted: &FittedModel<'_>,
        baseline: &Baseline,
        variation: &Variation,
        sizes: &[f64],
    ) -> Free {
        let shares = baseline.visibilities(&variation.columns(fitted));
        let shows = shares.iter().any(|share| *share > TRACE);
        let is_free = |at: &usize| !shows || shares[*at] > TRACE;
        let coefficients: Vec<usize> = (0..shares.len()).filter(is_free).collect();
        let terms = variation.numbered();
        let terms = terms.filter(|(coefficient, _)| coefficients.contains(coefficient));
        Free {
            variation: Variation {
                terms: terms.map(|(_, term)| term.clone()).collect(),
                ..variation.clone()
            },
            sizes: coefficients.iter().map(|at| sizes[*at]).collect(),
            coefficients,
        }
    }
}

/// One coefficient that was added.
#[derive(Debug, Clone)]
pub struct Addition {
    /// Name of the parameter.
    pub parameter: String,
    /// Name of the column that holds the modifier, the first if there are several; `None` where the size stands by
    /// itself.
    pub column: Option<String>,
    /// The modifier as a formula.
    pub text: String,
    /// The unit of the modifier.
    pub unit: Unit,
    /// Index of the effect.
    pub effect: usize,
    /// Which of the coefficients of the effect it is.
    pub coefficient: usize,
}

/// Adds effects to the model of a case. Nothing if the equations cannot be written, which only unusual ones
/// cannot.
pub(super) fn extended(fitted: &FittedModel<'_>, effects: Vec<Free>) -> Option<Extended> {
    let mut case = fitted.design.recording().clone();
    let mut additions: Vec<Addition> = Vec::new();
    let texts = (0..case.responses.len()).map(|response| case.equations.text(response));
    let mut equations: Vec<Extending> = texts.map(Extending::of).collect();
    let mut columns: Vec<Following> = Vec::new();
    let mut places = effects.iter().enumerate().flat_map(|(effect, free)| {
        let coefficients = free.coefficients.iter();
        coefficients.map(move |coefficient| (effect, *coefficient))
    });
    let terms = effects.iter().enumerate();
    let terms =
        terms.flat_map(|(at, free)| free.variation.terms.iter().map(move |term| (at, term)));
    for (effect, term) in terms {
        let written = term.written();
        let has_column = !stands_alone(term) && term.exact("").is_none();
        let column = has_column.then(|| {
            // Several outputs may follow the same, each by a size of its own.
            let known = columns.iter().find(|own| own.term.written() == written);
            known.map(|own| own.name.clone()).unwrap_or_else(|| {
                let name = free(&case, "effect", columns.len() + 1);
                columns.push(Following {
                    name: name.clone(),
                    effect,
                    term: term.clone(),
                });
                name
            })
        });
        let shared = additions.last().filter(|_| term.tied);
        let parameter = match shared {
            Some(addition) => addition.parameter.clone(),
            None => free(&case, "beta", additions.len() + 1),
        };
        let is_new = shared.is_none();
        for (response, equation) in equations.iter_mut().enumerate() {
            if term.response.is_none_or(|only| only == response) {
                let product = term.exact(&parameter).unwrap_or_else(|| {
                    let columns = column.iter();
                    columns.fold(parameter.clone(), |p, column| p + "*" + column)
                });
                equation.insert(fitted, response, term, &product);
            }
        }
        if is_new {
            case.parameters.push(Parameter {
                name: parameter.clone(),
                unit: term.unit_of_size(fitted.case()),
                start: None,
                prior: None,
                per: None,
            });
            let (effect, coefficient) = places.next()?;
            additions.push(Addition {
                parameter,
                column,
                text: written.text.clone(),
                unit: written.unit.clone(),
                effect,
                coefficient,
            });
        }
    }
    case.columns.extend(columns.iter().map(|column| {
        let written = column.term.written();
        let data = Data::Numbers(fitted.design.spread(&written.values));
        Column::new(&column.name, Role::Term, &written.unit, data)
    }));
    let texts = equations.iter().enumerate();
    let texts = texts.map(|(response, equation)| equation.text(fitted, response));
    let texts: Vec<String> = texts.collect();
    case.equations = case.compiled(&texts)?;
    case.model = texts;
    Some(Extended {
        case,
        additions,
        effects,
        columns,
    })
}

/// Whether the modifier of a term is one, in every row.
fn stands_alone(term: &Term) -> bool {
    term.written().values.iter().all(|value| *value == 1.0)
}

/// Takes the coefficients of some effects as scattered about zero, with the scatter that was found.
pub(super) fn scattered(extended: &mut Extended, is_scattered: impl Fn(usize) -> bool) {
    let first = extended.case.parameters.len() - extended.additions.len();
    let added = extended.case.parameters[first..].iter_mut();
    for (parameter, addition) in added.zip(&extended.additions) {
        let sizes = extended.effects[addition.effect].sizes.iter();
        let own: Vec<f64> = sizes.copied().filter(|size| size.is_finite()).collect();
        let squares: f64 = own.iter().map(|size| size * size).sum();
        let scatter = (squares / own.len().max(1) as f64).sqrt();
        let is_known = scatter > 0.0 && is_scattered(addition.effect);
        parameter.prior = is_known.then_some((0.0, scatter));
    }
}

/// Where the search begins: the declared fit, with the coefficients that the examination found.
pub fn start(fitted: &FittedModel<'_>, design: &Design<'_>, effects: &[Free]) -> DVector<f64> {
    let declared = fitted.case().parameters.len();
    let mut sizes = effects.iter().flat_map(|free| &free.sizes);
    let mut own = fitted.fit.unknowns.iter();
    let of = design.unknowns.iter().map(|unknown| match unknown.kind {
        UnknownKind::Parameter(parameter) if parameter >= declared => sizes.next(),
        _ => own.next(),
    });
    let values = of.map(|value| value.copied().filter(|x| x.is_finite()).unwrap_or(0.0));
    DVector::from_vec(values.collect())
}

fn free(case: &Case, stem: &str, number: usize) -> String {
    let is_known = |name: &String| {
        let column = |column: &Column| [&column.name, &column.header].contains(&name);
        case.parameters.iter().any(|own| own.name == *name) || case.columns.iter().any(column)
    };
    let mut name = format!("{stem}_{number}");
    while is_known(&name) {
        name.push('_');
    }
    name
}

/// An equation to which effects are added.
struct Extending {
    /// Statements before the last, in which the declared equation ends.
    before: Vec<String>,
    left: String,
    right: String,
    /// Effects on parameters and columns, by their names.
    inside: BTreeMap<String, Vec<String>>,
    /// Effects on everything but constant terms.
    gains: Vec<String>,
    /// Effects on everything.
    factors: Vec<String>,
    /// Effects on the output.
    offsets: Vec<String>,
    /// Effects on the output that are parts of it.
    parts: Vec<String>,
}

impl Extending {
    fn of(text: &str) -> Extending {
        let mut before: Vec<String> = text.lines().map(str::to_owned).collect();
        let last = before.pop().unwrap_or_default();
        let (left, right) = last.split_once(" = ").unwrap_or(("", last.as_str()));
        Extending {
            left: left.to_owned(),
            right: right.to_owned(),
            before,
            inside: BTreeMap::new(),
            gains: Vec::new(),
            factors: Vec::new(),
            offsets: Vec::new(),
            parts: Vec::new(),
        }
    }

    fn insert(&mut self, fitted: &FittedModel<'_>, response: usize, term: &Term, product: &str) {
        match term.node {
            Node::Output
                if fitted
                    .design
                    .over_constant(&fitted.fit.linear, response)
                    .is_some() =>
            {
                self.parts.push(product.to_owned())
            }
            Node::Output => self.offsets.push(product.to_owned()),
            Node::Gain => self.gains.push(product.to_owned()),
            Node::Reading => self.factors.push(product.to_owned()),
            Node::Parameter(_) | Node::Column(_) => {
                let on_name = self.inside.entry(fitted.name(term.node));
                on_name.or_default().push(product.to_owned());
            }
        }
    }

    /// A formula with the effects on its parameters and columns.
    fn disturbed(&self, formula: &str) -> String {
        let effects = self.inside.iter();
        effects.fold(formula.to_owned(), |formula, (name, products)| {
            let with = format!("({name} + {})", products.join(" + "));
            replaced(&formula, name, &with)
        })
    }

    fn text(&self, fitted: &FittedModel<'_>, response: usize) -> String {
        let right = self.disturbed(&self.right);
        let before = self.before.iter().map(|line| match line.split_once(" = ") {
            Some((left, right)) => format!("{left} = {}", self.disturbed(right)),
            None => self.disturbed(line),
        });
        let mut last = format!("{} = {right}", self.left);
        if !self.gains.is_empty() {
            let parameters = &fitted.case().parameters;
            let constants = fitted.constant_terms(response).into_iter();
            let signal = constants.fold(right.clone(), |signal, constant| {
                less(&signal, &parameters[constant].name)
            });
            let signal = format!("({signal})");
            last += &match self.gains.as_slice() {
                [one] => format!(" + {one}*{signal}"),
                several => format!(" + ({})*{signal}", several.join(" + ")),
            };
        }
        for factor in &self.factors {
            last += &format!(" + {factor}*({right})");
        }
        for part in &self.parts {
            last += &format!(" + {part}*({right})/{}", self.left);
        }
        for offset in &self.offsets {
            last += &format!(" + {offset}");
        }
        before.chain([last]).collect::<Vec<_>>().join("\n")
    }
}

/// A formula less a name: without it where it is its first or last term.
fn less(formula: &str, name: &str) -> String {
    let is_sum = !formula.contains(['<', '>', '=']) && !formula.contains("if");
    let first = || formula.strip_prefix(&format!("{name} + "));
    let last = || formula.strip_suffix(&format!(" + {name}"));
    let rest = is_sum.then(|| first().or_else(last)).flatten();
    rest.map_or_else(|| format!("{formula} - {name}"), str::to_owned)
}

/// A formula with a name replaced, outside of quoted units.
fn replaced(text: &str, name: &str, with: &str) -> String {
    let mut out = String::new();
    let mut word = String::new();
    let mut quoted = false;
    let flush = |word: &mut String, out: &mut String| {
        out.push_str(if word == name { with } else { word });
        word.clear();
    };
    for c in text.chars() {
        let part = c.is_alphanumeric() || c == '_';
        if part && !quoted {
            word.push(c);
            continue;
        }
        flush(&mut word, &mut out);
        quoted ^= c == '\'';
        out.push(c);
    }
    flush(&mut word, &mut out);
    out
}

#[cfg(test)]
mod tests {
    use super::{less, replaced};

    #[test]
    fn a_first_or_last_term_is_left_out() {
        assert_eq!(less("U0 + S * M", "U0"), "S * M");
        assert_eq!(less("S * M^2 + U0", "U0"), "S * M^2");
        assert_eq!(less("S * (M + U0)", "U0"), "S * (M + U0) - U0");
        assert_eq!(less("S * M + k * U0", "U0"), "S * M + k * U0 - U0");
        assert_eq!(less("U00 + S", "U0"), "U00 + S - U0");
    }

    #[test]
    fn names_are_replaced_as_a_whole() {
        assert_eq!(
            replaced("T*T_0 + 3 'T' + sin(T)", "T", "(T + b*m)"),
            "(T + b*m)*T_0 + 3 'T' + sin((T + b*m))"
        );
    }
}
