//! Units that are converted by hand, although they are converted without it: angles to radians, `sin(phi*pi/180)`, and
//! values to the wanted unit.

use super::catalogue::{FunctionInfo, find};
use super::faults;
use super::lower::{Lowering, Value};
use super::printer;
use super::syntax::{Expr, Infix, Node};
use super::{Role, Symbol};
use crate::quantity::{Dimension, Unit};
use gumption_fault::{Fault, say};

/// Rounding of 0.01745 or 57.3 by the user.
const NEAR: f64 = 1e-3;

impl Lowering<'_> {
    /// Refuses a formula that converts its value to the wanted unit by a number, although units are converted without it:
    /// a factor of a hundred for percent, of a thousand from mL to L, of 180/π for degrees.
    pub fn scaled_once(
        &mut self,
        name: &str,
        value: &Value,
        expr: &Expr,
        wanted: &Unit,
    ) -> Option<()> {
        let Some((term, number)) = self.scaled_by_hand(value, expr, wanted) else {
            return Some(());
        };
        let (text, symbol) = (printer::expression(term), &wanted.symbol);
        self.report(
            Fault::new(
                faults::SCALED_TWICE,
                term.span.clone(),
                say!("the factor {number} would convert `{name}` to {symbol} a second time: units are converted without it"),
            )
            .label(say!("a conversion to {symbol}"))
            .help(say!(
                "leave {number} out of `{text}`; if it belongs to the measurement, as a dilution does, state it by name in [constant], or write `{number} '1'`"
            )),
        );
        None
    }

    /// The term and its number.
    fn scaled_by_hand<'e>(
        &mut self,
        value: &Value,
        expr: &'e Expr,
        wanted: &Unit,
    ) -> Option<(&'e Expr, f64)> {
        let factor = value.unit()?.conversion_to(wanted)?.factor;
        if factor == 1.0 {
            return None;
        }
        // π is written with some digits only.
        let near = if wanted.factor.pi == 0 { 0.0 } else { NEAR };
        // A purity in percent has a factor of its own beside the one from mg and mL to mg/L.
        let names = expr
            .names()
            .into_iter()
            .filter_map(|name| self.symbol(name));
        let ratios = names.filter(|symbol| symbol.unit.dimension == Dimension::NONE);
        let of_ratio = |symbol: &Symbol| {
            let ratio = symbol.unit.factor.value();
            [factor / ratio, factor * ratio]
        };
        let mut factors = vec![factor, 1.0 / factor];
        factors.extend(ratios.flat_map(of_ratio));
        // One converts nothing: the percent of the result is that of the ratio.
        factors.retain(|factor| (factor - 1.0).abs() > NEAR);
        let is_it = |number: f64| {
            let mut factors = factors.iter();
            factors.any(|f| (number / f - 1.0).abs() <= near.max(f64::EPSILON))
        };
        let mut open = vec![expr];
        while let Some(e) = open.pop() {
            let number = match &e.node {
                Node::Number {
                    value, unit: None, ..
                } if near == 0.0 => Some(*value),
                Node::Chain { first, rest } => self.number_of(first, rest),
                _ => None,
            };
            if let Some(number) = number.filter(|number| is_it(*number)) {
                return Some((e, number));
            }
            open.extend(in_proportion(e));
        }
        None
    }

    /// The numbers of a product taken together, if it has other factors besides.
    fn number_of(&mut self, first: &Expr, rest: &[(Infix, Expr)]) -> Option<f64> {
        let factors = std::iter::once((Infix::Mul, first)).chain(rest.iter().map(|(i, e)| (*i, e)));
        let (mut number, mut others) = (1.0, false);
        for (infix, factor) in factors {
            let constant = self.constant(factor);
            match (infix, constant) {
                (Infix::Mul, Some(constant)) => number *= constant,
                (Infix::Div, Some(constant)) => number /= constant,
                (Infix::Mul | Infix::Div, None) => others = true,
                _ => return None,
            }
        }
        others.then_some(number)
    }

    /// The value of a number of the formula that has no name and no unit, which would say that it is meant.
    fn constant(&mut self, factor: &Expr) -> Option<f64> {
        let named = |name: &&str| self.symbol(name).is_some();
        if !is_simple(factor) || has_unit(factor) || factor.names().iter().any(named) {
            return None;
        }
        let value = self.value(factor)?;
        let is_one = value.unit()?.is_one();
        let id = value.elements.first().filter(|_| is_one)?;
        self.builder.constant_at(*id)
    }

    /// Reports terms of the argument of `sin`, `cos` or `tan` that hold the factor of their unit once more.
    pub fn converted_once(&mut self, argument: &Expr) -> Option<()> {
        match &argument.node {
            Node::Minus(inner) => self.converted_once(inner),
            Node::Chain { first, rest } => match rest.first()?.0 {
                Infix::Add | Infix::Sub => {
                    let once = self.converted_once(first);
                    rest.iter()
                        .fold(once, |once, (_, term)| self.converted_once(term).and(once))
                }
                Infix::Mul | Infix::Div => self.converted_by_hand(argument, first, rest),
                _ => Some(()),
            },
            _ => Some(()),
        }
    }

    /// Refuses an exactly known number without a unit as an angle of more than a turn: `cos(30)` would be of 30 rad.
    pub fn plain_turns(&mut self, argument: &Expr) -> Option<()> {
        let (number, mend) = match &argument.node {
            Node::Minus(inner) => return self.plain_turns(inner),
            Node::Number {
                value, unit: None, ..
            } => (*value, None),
            Node::Name(name) => match self.plain_symbol(name).map(|symbol| &symbol.role) {
                Some(Role::Constant(value)) => (*value, Some(name.clone())),
                _ => return Some(()),
            },
            _ => return Some(()),
        };
        if number.abs() <= std::f64::consts::TAU {
            return Some(());
        }
        let text = printer::expression(argument);
        let help = match mend {
            Some(name) => {
                say!(
                    "state the unit of `{name}`: unit = \"°\", or unit = \"rad\" if radians are meant"
                )
            }
            None => say!("write `{text} '°'`, or `{text} 'rad'` if radians are meant"),
        };
        self.report(
            Fault::new(
                faults::BARE_ANGLE,
                argument.span.clone(),
                say!("`{text}` has no unit, and as radians it would be more than a turn"),
            )
            .label(say!("would be radians"))
            .help(help),
        );
        None
    }

    /// The symbol of a name, where it has no unit and is none of a definition.
    fn plain_symbol(&self, name: &str) -> Option<&Symbol> {
        let is_local = self.locals.iter().any(|names| names.contains_key(name));
        let symbol = self.symbol(name).filter(|_| !is_local);
        symbol.filter(|symbol| symbol.unit.symbol == Unit::one().symbol)
    }

    /// Notes an input without a unit that is an angle by its place alone.
    pub fn note_plain_angle(&mut self, argument: &Expr) {
        let Node::Name(name) = &argument.node else {
            return;
        };
        if let Some(Role::Input(place)) = self.plain_symbol(name).map(|symbol| &symbol.role) {
            self.plain_angles.push(*place);
        }
    }

    fn converted_by_hand(
        &mut self,
        term: &Expr,
        first: &Expr,
        rest: &[(Infix, Expr)],
    ) -> Option<()> {
        let (mut number, mut unit, mut quantities) = (1.0, Unit::one(), Vec::new());
        let factors = std::iter::once((Infix::Mul, first)).chain(rest.iter().map(|(i, e)| (*i, e)));
        for (infix, factor) in factors {
            if !is_simple(factor) {
                return Some(());
            }
            let value = self.value(factor)?;
            let own = value.unit()?.clone();
            let constant = value.elements.first().filter(|_| own.is_one());
            let constant = constant.and_then(|id| self.builder.constant_at(*id));
            match (constant, infix) {
                (Some(constant), Infix::Div) => number /= constant,
                (Some(constant), _) => number *= constant,
                (None, _) => {
                    unit = match infix {
                        Infix::Div => unit.quotient(&own),
                        _ => unit.product(&own),
                    };
                    quantities.push((infix, factor.clone()));
                }
            }
        }
        let factor = unit.factor.value();
        let by_hand = (number / factor - 1.0).abs() < NEAR;
        let is_angle = unit.dimension == Dimension::NONE && unit.factor.pi != 0;
        if !(is_angle && by_hand) {
            return Some(());
        }
        let angle = product(quantities, term);
        let (text, symbol) = (printer::expression(&angle), &unit.symbol);
        self.report(
            Fault::new(
                faults::CONVERTED_TWICE,
                term.span.clone(),
                say!(
                    "`{}` converts `{text}` to radians twice: sin, cos and tan convert {symbol} themselves",
                    printer::expression(term)
                ),
            )
            .label(say!("the factor is in the unit already"))
            .help(say!(
                "write `{text}` without the factor, or `value_in({text}, '{symbol}')` for its number"
            )),
        );
        None
    }
}

/// The parts whose scale is that of the whole: the 10 of `ln(10)` and of `10^x` converts nothing.
fn in_proportion(e: &Expr) -> Vec<&Expr> {
    match &e.node {
        Node::Chain { .. } | Node::Minus(_) | Node::Vector(_) => e.children(),
        Node::Index { vector, .. } => vec![vector],
        Node::If { yes, no, .. } => vec![yes, no],
        Node::Call { name, .. } if find(&name.text).is_some_and(FunctionInfo::keeps_unit) => {
            e.children()
        }
        _ => Vec::new(),
    }
}

/// The product of some factors of a term, without the others.
fn product(mut factors: Vec<(Infix, Expr)>, term: &Expr) -> Expr {
    let part = |node: Node| Expr {
        span: term.span.clone(),
        node,
    };
    let multiplied = factors.iter().position(|(infix, _)| *infix == Infix::Mul);
    let first = match multiplied {
        Some(at) => factors.remove(at).1,
        None => part(Node::Number {
            value: 1.0,
            text: "1".into(),
            unit: None,
        }),
    };
    part(Node::Chain {
        first: Box::new(first),
        rest: factors,
    })
}

/// Whether an expression is made of numbers and names only.
fn is_simple(e: &Expr) -> bool {
    let operators = matches!(
        e.node,
        Node::Number { .. } | Node::Name(_) | Node::Minus(_) | Node::Chain { .. }
    );
    operators && e.children().into_iter().all(is_simple)
}

/// Whether a number of the expression has a unit.
fn has_unit(e: &Expr) -> bool {
    matches!(e.node, Node::Number { unit: Some(_), .. }) || e.children().into_iter().any(has_unit)
}
