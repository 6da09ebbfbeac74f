//! Units of parameters that are no plain factors of a term, as in `R0*(1 + A*T + B*T^2)` and
//! `K0 + K1*sin(head + d0)`.
//!
//! What is known of a part says what the rest is: the terms of a sum have one unit, a product has that of
//! its factors together, and `sin` or `exp` takes a pure number (or an angle) and gives a pure number.

use super::{Check, Outline, is_plain};
use crate::model::operation::{DimensionRule, unary};
use crate::model::syntax::{Expr, Infix, Node, Statement};
use crate::model::{Role, Symbol};
use crate::quantity::{Dimension, Unit, UnitTable};

impl Outline {
    /// Completes the units of parameters: `known` are those that are stated or known already, in the order of
    /// `parameters`. What the formula leaves open stays `None`; so does what stands beside a temperature
    /// with an origin, where a sum may be a point or a difference.
    pub fn completed_units(
        &self,
        parameters: &[String],
        known: Vec<Option<Unit>>,
        symbols: &[Symbol],
        result: &Unit,
        units: &UnitTable,
    ) -> Vec<Option<Unit>> {
        let mut found = known;
        let Some((Statement::Assign { value, .. }, before)) = self.statements.split_last() else {
            return found;
        };
        loop {
            let mut symbols = symbols.to_vec();
            let mut open = Vec::new();
            for (name, unit) in parameters.iter().zip(&found) {
                match unit {
                    Some(unit) => symbols.push(Symbol {
                        name: name.as_str().into(),
                        unit: unit.clone(),
                        // Not as a constant: a power with it has no unit of its own.
                        role: Role::Input(symbols.len()),
                    }),
                    None => open.push(name.as_str()),
                }
            }
            let mut check = Check::new(&symbols, units);
            for statement in before {
                check.preceding(statement.clone());
            }
            let mut inference = Inference {
                check,
                open,
                arguments: Arguments::Known,
            };
            let next = inference.find(value, Some(result.clone())).or_else(|| {
                inference.arguments = Arguments::Plain;
                inference.find(value, Some(result.clone()))
            });
            let place = next.and_then(|(name, unit)| {
                let place = parameters.iter().position(|p| *p == name)?;
                Some((place, unit))
            });
            let Some((place, unit)) = place else {
                return found;
            };
            found[place] = Some(unit);
        }
    }
}

/// Which arguments of `sin` or `exp` say something about the parameters in them.
enum Arguments {
    /// Those of which a term has a known unit: `sin(head + d0)`.
    Known,
    /// All: `sin(omega*t + phi)` takes a pure number.
    Plain,
}

/// A search for the next parameter whose unit follows.
struct Inference<'r> {
    check: Check<'r>,
    /// Parameters of which no unit is known.
    open: Vec<&'r str>,
    arguments: Arguments,
}

impl Inference<'_> {
    fn is_open(&self, expr: &Expr) -> bool {
        expr.names().iter().any(|name| self.open.contains(name))
    }

    /// The unit of an expression, as far as it follows from what is known.
    fn unit(&mut self, expr: &Expr) -> Option<Unit> {
        if !self.is_open(expr) {
            let value = self.check.l.value(expr)?;
            // Zero is of every unit.
            return value.unit().filter(|_| !value.zero).cloned();
        }
        match &expr.node {
            Node::Minus(inner) => self.unit(inner),
            Node::Call { name, .. } if takes_a_number(&name.text) => Some(Unit::one()),
            Node::Power { base, .. } => self.unit(base).filter(Unit::is_one),
            Node::Chain { first, rest } if is_sum(rest) => {
                let known: Vec<Unit> = operands(first, rest)
                    .filter_map(|(_, term)| self.unit(term))
                    .collect();
                let point = known.iter().any(Unit::is_point);
                known.into_iter().next().filter(|_| !point)
            }
            Node::Chain { first, rest } if is_product(rest) => {
                let factors: Vec<_> = operands(first, rest).collect();
                self.product(&factors)
            }
            _ => None,
        }
    }

    /// The unit of a product of factors that are all known.
    fn product(&mut self, factors: &[(Infix, &Expr)]) -> Option<Unit> {
        factors.iter().try_fold(Unit::one(), |unit, (infix, e)| {
            let factor = self.unit(e).filter(|factor| !factor.is_point())?;
            Some(match infix {
                Infix::Div => unit.quotient(&factor),
                _ => unit.product(&factor),
            })
        })
    }

    /// The first open parameter whose unit follows where the expression is `wanted` in a unit.
    fn find(&mut self, expr: &Expr, wanted: Option<Unit>) -> Option<(String, Unit)> {
        if !self.is_open(expr) {
            return None;
        }
        let wanted = wanted
            .or_else(|| self.unit(expr))
            .filter(|unit| !unit.is_point());
        match &expr.node {
            Node::Name(name) => Some((name.to_string(), wanted?)),
            Node::Minus(inner) => self.find(inner, wanted),
            Node::Call { name, arguments } if takes_a_number(&name.text) => {
                arguments.iter().find_map(|argument| {
                    let unit = self.unit(argument).or_else(|| self.argument(argument));
                    self.find(argument, unit)
                })
            }
            Node::Power { base, exponent } => self
                .find(base, None)
                .or_else(|| self.find(exponent, Some(Unit::one()))),
            Node::Chain { first, rest } if is_sum(rest) => {
                operands(first, rest).find_map(|(_, term)| self.find(term, wanted.clone()))
            }
            Node::Chain { first, rest } if is_product(rest) => {
                let factors: Vec<_> = operands(first, rest).collect();
                self.factor(&factors, wanted)
            }
            _ => expr
                .children()
                .into_iter()
                .find_map(|child| self.find(child, None)),
        }
    }

    /// The same for a product: what the other factors leave to the only one that is not known.
    fn factor(
        &mut self,
        factors: &[(Infix, &Expr)],
        wanted: Option<Unit>,
    ) -> Option<(String, Unit)> {
        let unknown: Vec<usize> = (0..factors.len())
            .filter(|i| self.unit(factors[*i].1).is_none())
            .collect();
        let left = match (unknown.as_slice(), wanted) {
            (&[only], Some(wanted)) => {
                let mut others = factors.to_vec();
                let (infix, _) = others.remove(only);
                self.product(&others).map(|others| match infix {
                    Infix::Div => plain(others.quotient(&wanted)),
                    _ => plain(wanted.quotient(&others)),
                })
            }
            _ => None,
        };
        (0..factors.len()).find_map(|i| {
            let wanted = left.clone().filter(|_| unknown.contains(&i));
            self.find(factors[i].1, wanted)
        })
    }

    /// The unit of an argument that must be a pure number or an angle: in `sin(n*head + d0)` that of head,
    /// so that n counts.
    fn argument(&mut self, argument: &Expr) -> Option<Unit> {
        if matches!(self.arguments, Arguments::Known) {
            return None;
        }
        let terms = super::terms(argument);
        let angle = terms.into_iter().find_map(|term| {
            let Node::Chain { first, rest } = &term.node else {
                return None;
            };
            let known: Vec<_> = operands(first, rest)
                .filter(|(infix, e)| matches!(infix, Infix::Mul | Infix::Div) && !self.is_open(e))
                .collect();
            let unit = self.product(&known)?;
            (unit.dimension == Dimension::NONE).then_some(unit)
        });
        angle.or_else(|| Some(Unit::one()))
    }
}

/// The operands of a chain, each with the operator before it; the first counts as added or multiplied.
fn operands<'e>(
    first: &'e Expr,
    rest: &'e [(Infix, Expr)],
) -> impl Iterator<Item = (Infix, &'e Expr)> {
    let opening = if is_sum(rest) { Infix::Add } else { Infix::Mul };
    std::iter::once((opening, first)).chain(rest.iter().map(|(infix, e)| (*infix, e)))
}

fn is_sum(rest: &[(Infix, Expr)]) -> bool {
    rest.iter()
        .all(|(infix, _)| matches!(infix, Infix::Add | Infix::Sub))
}

fn is_product(rest: &[(Infix, Expr)]) -> bool {
    rest.iter()
        .all(|(infix, _)| matches!(infix, Infix::Mul | Infix::Div))
}

/// Whether a function takes a pure number or an angle, and gives a pure number.
fn takes_a_number(function: &str) -> bool {
    unary(function).is_some_and(|row| {
        matches!(
            row.dimension,
            DimensionRule::One | DimensionRule::Angle | DimensionRule::ToAngle
        )
    })
}

fn plain(unit: Unit) -> Unit {
    if is_plain(&unit) { Unit::one() } else { unit }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::outline;

    /// Units of the parameters of a formula for an output in mV over head in °, t in s, T in K and x in mm.
    fn units_of<const N: usize>(text: &str, parameters: [&str; N]) -> [String; N] {
        let units = UnitTable::default();
        let unit = |text: &str| units.parse(text).expect("a unit");
        let symbols =
            [("head", "deg"), ("t", "s"), ("T", "K"), ("x", "mm")].map(|(name, of)| Symbol {
                name: name.into(),
                unit: unit(of),
                role: Role::Constant(1.0),
            });
        let outline = outline(text, &units).expect("well formed");
        let names = parameters.map(String::from);
        let found = outline.completed_units(&names, vec![None; N], &symbols, &unit("mV"), &units);
        let shown: Vec<String> = found
            .into_iter()
            .map(|unit| unit.map_or("open".into(), |unit| unit.symbol.clone()))
            .collect();
        shown.try_into().expect("one for each")
    }

    #[test]
    fn a_factor_before_a_polynomial() {
        let found = units_of("y = R0*(1 + A*T + B*T^2 + C*x)", ["R0", "A", "B", "C"]);
        assert_eq!(found, ["mV", "1/K", "1/K^2", "1/mm"]);
    }

    #[test]
    fn an_angle_added_to_an_angle() {
        let found = units_of("y = K0 + K1*sin(head + d0)", ["K0", "K1", "d0"]);
        assert_eq!(found, ["mV", "mV", "deg"]);
        let found = units_of("y = K1*sin(d0 + n*head)", ["K1", "n", "d0"]);
        assert_eq!(found, ["mV", "1", "deg"]);
    }

    #[test]
    fn arguments_are_pure_numbers() {
        let found = units_of(
            "y = a*exp(-t/tau) + b*cos(w*t + phi)",
            ["a", "tau", "b", "w", "phi"],
        );
        assert_eq!(found, ["mV", "s", "mV", "1/s", "1"]);
    }

    #[test]
    fn two_open_factors_stay_open() {
        assert_eq!(units_of("y = a*b*x", ["a", "b"]), ["open", "open"]);
        assert_eq!(units_of("y = a*x^n", ["a", "n"]), ["open", "1"]);
    }
}
