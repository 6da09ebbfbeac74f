//! What a formula says before it is compiled: which name it gives, which names it needs, and the units
//! that free parameters must have in it.

mod degree;
mod inference;

use std::collections::{BTreeSet, HashMap};

use super::Symbol;
use super::catalogue;
use super::check::{Check, unknowns};
use super::parser;
use super::printer;
use super::syntax::{Expr, Infix, Name, Node, Span, Statement};
use crate::quantity::{Dimension, Unit, UnitTable};
use gumption_fault::Fault;

/// A text of statements, the last of which gives a quantity a value: `b = y1 + y2*(t - t0)`.
#[derive(Debug, Clone)]
pub struct Outline {
    /// The name on the left of the last statement; `None` where that is no assignment.
    pub gives: Option<(String, Span)>,
    /// Names of values that the text does not define itself, each where it stands first.
    pub needs: Vec<(String, Span)>,
    /// The text as it is printed elsewhere, one statement per line.
    pub printed: String,
    statements: Vec<Statement>,
}

/// Reads a text.
///
/// # Errors
/// It is not well formed; all faults.
pub fn outline(text: &str, units: &UnitTable) -> Result<Outline, Vec<Fault>> {
    let mut faults = Vec::new();
    let reading = parser::parse(text, &|name| units.parse(name).is_ok(), &mut faults);
    if !faults.is_empty() {
        return Err(faults);
    }
    let statements = reading.statements;
    let mut own: BTreeSet<String> = BTreeSet::new();
    let mut needs: Vec<(String, Span)> = Vec::new();
    let mut needed: BTreeSet<String> = BTreeSet::new();
    for statement in &statements {
        let (expr, parameters): (&Expr, &[Name]) = match statement {
            Statement::Assign { value, .. } | Statement::Value(value) => (value, &[]),
            Statement::Function {
                parameters, body, ..
            } => (body, parameters),
        };
        let bound: Vec<String> = parameters.iter().map(|p| p.text.clone()).collect();
        let unknowns: BTreeSet<String> = unknowns(expr).into_iter().collect();
        for (name, span) in values(expr) {
            let known = own.contains(&name)
                || bound.contains(&name)
                || unknowns.contains(&name)
                || catalogue::is_pi(&name);
            if !known && needed.insert(name.clone()) {
                needs.push((name, span));
            }
        }
        if let Statement::Assign { name, .. } | Statement::Function { name, .. } = statement {
            own.insert(name.text.clone());
        }
    }
    let gives = match statements.last() {
        Some(Statement::Assign { name, .. }) => Some((name.text.clone(), name.span.clone())),
        _ => None,
    };
    let lines: Vec<String> = statements
        .iter()
        .map(|statement| printer::statement(statement, ""))
        .collect();
    Ok(Outline {
        gives,
        needs,
        printed: lines.join("\n"),
        statements,
    })
}

impl Outline {
    /// Whether the value is linear in a name, as far as the last statement tells.
    pub fn is_linear_in(&self, name: &str) -> bool {
        match self.statements.last() {
            Some(Statement::Assign { value, .. } | Statement::Value(value)) => {
                degree::degree(value, name).is_some_and(|degree| degree <= 1)
            }
            _ => true,
        }
    }

    /// The units that parameters must have where the value is a sum of terms and each is a factor of
    /// one: in `b = y1 + y2*(t - t0)`, y1 has the unit of b, y2 that of b divided by that of t - t0.
    /// `None` where a parameter stands in any other place.
    pub fn parameter_units(
        &self,
        parameters: &[String],
        symbols: &[Symbol],
        result: &Unit,
        units: &UnitTable,
    ) -> Vec<Option<Unit>> {
        let Some((Statement::Assign { value, .. }, before)) = self.statements.split_last() else {
            return vec![None; parameters.len()];
        };
        let mut check = Check::new(symbols, units);
        for statement in before {
            check.preceding(statement.clone());
        }
        let terms = terms(value);
        parameters
            .iter()
            .map(|parameter| {
                let (term, left) = terms.iter().find_map(|term| {
                    let left = without(term, parameter, parameters)?;
                    Some((*term, left))
                })?;
                if matches!(&term.node, Node::Name(_)) {
                    return Some(result.clone());
                }
                let factor = check.l.value(&left)?.unit()?.clone();
                let unit = result.quotient(&factor);
                Some(if is_plain(&unit) { Unit::one() } else { unit })
            })
            .collect()
    }
}

/// Whether a unit, however it is written, is that of pure numbers.
fn is_plain(unit: &Unit) -> bool {
    unit.dimension == Dimension::NONE && unit.factor == Unit::one().factor
}

/// Names that stand for values, with their places, in the order of the text.
fn values(expr: &Expr) -> Vec<(String, Span)> {
    let mut found = Vec::new();
    let mut open = vec![expr];
    while let Some(e) = open.pop() {
        if let Node::Name(name) = &e.node {
            found.push((name.to_string(), e.span.clone()));
        }
        open.extend(e.children().into_iter().rev());
    }
    found
}

/// The terms of a sum.
fn terms(expr: &Expr) -> Vec<&Expr> {
    match &expr.node {
        Node::Chain { first, rest }
            if rest
                .iter()
                .all(|(infix, _)| matches!(infix, Infix::Add | Infix::Sub)) =>
        {
            let mut all = terms(first);
            for (_, term) in rest {
                all.extend(terms(term));
            }
            all
        }
        Node::Minus(inner) => terms(inner),
        _ => vec![expr],
    }
}

/// A term with 1 in the place of a parameter that is a plain factor of it; `None` where it is not, or
/// another parameter is in the term.
fn without(term: &Expr, parameter: &str, parameters: &[String]) -> Option<Expr> {
    let one = |span: &Span| Expr {
        span: span.clone(),
        node: Node::Number {
            value: 1.0,
            text: "1".into(),
            unit: None,
        },
    };
    let is_it = |e: &Expr| matches!(&e.node, Node::Name(name) if name == parameter);
    let mentions = |e: &Expr| {
        e.names()
            .iter()
            .any(|name| parameters.iter().any(|p| p == name))
    };
    match &term.node {
        Node::Name(_) if is_it(term) => Some(one(&term.span)),
        Node::Minus(inner) => Some(Expr {
            span: term.span.clone(),
            node: Node::Minus(Box::new(without(inner, parameter, parameters)?)),
        }),
        Node::Chain { first, rest }
            if rest
                .iter()
                .all(|(infix, _)| matches!(infix, Infix::Mul | Infix::Div)) =>
        {
            let mut out = term.clone();
            let Node::Chain {
                first: new_first,
                rest: new_rest,
            } = &mut out.node
            else {
                return None;
            };
            let mut places = 0;
            if is_it(first) {
                **new_first = one(&first.span);
                places += 1;
            } else if mentions(first) {
                **new_first = without(first, parameter, parameters)?;
                places += 1;
            }
            for ((infix, old), (_, new)) in rest.iter().zip(new_rest.iter_mut()) {
                if is_it(old) && *infix == Infix::Mul {
                    *new = one(&old.span);
                    places += 1;
                } else if mentions(old) {
                    return None;
                }
            }
            (places == 1).then_some(out)
        }
        _ => None,
    }
}

impl<'r> Check<'r> {
    /// A check of single expressions over these symbols.
    fn new(symbols: &'r [Symbol], units: &'r UnitTable) -> Self {
        let mut check = Check {
            l: super::lower::Lowering::new(symbols, units, super::expressions::lowered),
            statements: Vec::new(),
            defined: HashMap::new(),
            spans: HashMap::new(),
            added: Vec::new(),
            last: None,
        };
        check.symbols(symbols);
        check
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Role;

    fn symbol(name: &str, unit: &str, place: usize) -> Symbol {
        Symbol {
            name: name.into(),
            unit: UnitTable::default().parse(unit).expect("a unit"),
            role: Role::Input(place),
        }
    }

    #[test]
    fn names_and_units_of_a_line() {
        let units = UnitTable::default();
        let outline = outline("b = y1 + y2*(t - t0)", &units).expect("well formed");
        let needs: Vec<&str> = outline
            .needs
            .iter()
            .map(|(name, _)| name.as_str())
            .collect();
        assert_eq!(needs, ["y1", "y2", "t", "t0"]);
        assert_eq!(
            outline.gives.as_ref().map(|(name, _)| name.as_str()),
            Some("b")
        );
        let symbols = [symbol("t", "°C", 0), symbol("t0", "°C", 1)];
        let parameters = ["y1".to_string(), "y2".to_string()];
        let found = outline.parameter_units(
            &parameters,
            &symbols,
            &units.parse("mV").expect("a unit"),
            &units,
        );
        let names: Vec<String> = found
            .into_iter()
            .map(|unit| unit.map_or("none".into(), |unit| unit.symbol.clone()))
            .collect();
        assert_eq!(names, ["mV", "mV/K"]);
    }

    #[test]
    fn units_follow_only_from_plain_factors() {
        let units = UnitTable::default();
        let text = "z = x/2\ny = -a*z^2/x + b*c - exp(-k*x)*d";
        let outline = outline(text, &units).expect("well formed");
        let parameters = ["a", "b", "c", "d", "k"].map(String::from);
        let symbols = [symbol("x", "s", 0)];
        let found = outline.parameter_units(
            &parameters,
            &symbols,
            &units.parse("m").expect("a unit"),
            &units,
        );
        let names: Vec<String> = found
            .into_iter()
            .map(|unit| unit.map_or("none".into(), |unit| unit.symbol.clone()))
            .collect();
        assert_eq!(names, ["m/s", "none", "none", "none", "none"]);
    }
}
