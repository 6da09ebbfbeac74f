//! Units that are converted by hand, although they are converted without it: angles to radians, `sin(phi*pi/180)`, and
//! values to the wanted unit.

use super::catalogue::{FunctionInfo, find};
use super::digits::{NEAR, tolerance};
use super::faults;
use super::lower::{Lowering, Value};
use super::printer;
use super::syntax::{Expr, Infix, Node};
use super::{Role, Symbol};
use crate::quantity::{Dimension, Unit};
use gumption_fault::{Fault, Said, say};

/// A number of a formula, with how far it may have been rounded, relative to itself.
#[derive(Clone, Copy)]
struct Written {
    value: f64,
    tolerance: f64,
}

impl Written {
    fn is(self, factor: f64) -> bool {
        (self.value / factor - 1.0).abs() <= self.tolerance.max(4.0 * f64::EPSILON)
    }
}

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
        if let Some((term, number)) = self.scaled_by_hand(value, expr, wanted) {
            self.report(scaled_twice(term, number, name, &wanted.symbol));
            return None;
        }
        let mut open = vec![expr];
        while let Some(e) = open.pop() {
            if let Some((quantity, unit, number)) = self.factor_of_unit(e) {
                self.report(factor_twice(e, number, quantity, &unit.symbol));
                return None;
            }
            open.extend(in_proportion(e));
        }
        Some(())
    }

    /// Refuses a term that converts itself by a number to the unit of another that it meets: `L + d/1000`, `1 - p/100`.
    pub fn term_once(&mut self, term: &Expr, own: &Unit, other: &Unit) -> Option<()> {
        let Some(factor) = own.conversion_to(other).map(|c| c.factor) else {
            return Some(());
        };
        let product = match &term.node {
            Node::Minus(inner) => inner,
            _ => term,
        };
        let (Node::Chain { first, rest }, false) = (&product.node, factor == 1.0) else {
            return Some(());
        };
        let number = self.number_of(first, rest);
        let Some(number) = number.filter(|number| number.is(factor)) else {
            return Some(());
        };
        let text = printer::expression(product);
        self.report(scaled_twice(product, number.value, &text, &other.symbol));
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
        let mut open = vec![expr];
        while let Some(e) = open.pop() {
            let number = match &e.node {
                Node::Number {
                    value, unit: None, ..
                } if wanted.factor.pi == 0 => Some(Written {
                    value: *value,
                    tolerance: 0.0,
                }),
                Node::Chain { first, rest } => self.number_of(first, rest),
                _ => None,
            };
            if let Some(number) = number.filter(|n| factors.iter().any(|f| n.is(*f))) {
                return Some((e, number.value));
            }
            open.extend(in_proportion(e));
        }
        None
    }

    /// The quantity of a product whose unit has the very factor that the numbers of the product make, `h / 100 * e` with h in
    /// percent, its unit and that factor; not where the unit cancels, nor where the quantity is alone with the number.
    fn factor_of_unit<'e>(&mut self, e: &'e Expr) -> Option<(&'e str, Unit, f64)> {
        let Node::Chain { first, rest } = &e.node else {
            return None;
        };
        let number = self.number_of(first, rest)?;
        if (number.value - 1.0).abs() <= NEAR {
            return None;
        }
        let factors =
            std::iter::once((Infix::Mul, &**first)).chain(rest.iter().map(|(i, e)| (*i, e)));
        let mut quantities = Vec::new();
        for (infix, factor) in factors {
            let is_number = self.constant(factor).is_some();
            let unit = self.value(factor)?.unit()?.clone();
            if !is_number && !unit.is_one() {
                quantities.push((infix, factor, unit));
            }
        }
        let is_it = |(infix, factor, unit): &(Infix, &'e Expr, Unit)| {
            let own = match infix {
                Infix::Div => 1.0 / unit.factor.value(),
                _ => unit.factor.value(),
            };
            let mut others = quantities.iter();
            let is_cancelled = others.any(|(i, _, u)| i != infix && u.dimension == unit.dimension);
            match &factor.node {
                Node::Name(name) if (own - 1.0).abs() > NEAR && number.is(own) && !is_cancelled => {
                    Some((name.as_str(), unit.clone(), number.value))
                }
                _ => None,
            }
        };
        let is_alone = quantities.len() < 2;
        quantities.iter().find_map(is_it).filter(|_| !is_alone)
    }

    /// The numbers of a product taken together, if it has other factors besides.
    fn number_of(&mut self, first: &Expr, rest: &[(Infix, Expr)]) -> Option<Written> {
        let factors = std::iter::once((Infix::Mul, first)).chain(rest.iter().map(|(i, e)| (*i, e)));
        let (mut value, mut tolerance, mut others) = (1.0, 0.0, false);
        for (infix, factor) in factors {
            let constant = self.constant(factor);
            match (infix, constant) {
                (Infix::Mul, Some(constant)) => value *= constant,
                (Infix::Div, Some(constant)) => value /= constant,
                (Infix::Mul | Infix::Div, None) => others = true,
                _ => return None,
            }
            if constant.is_some() {
                tolerance += rounding(factor);
            }
        }
        others.then_some(Written { value, tolerance })
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

/// How far the numbers of a factor may have been rounded altogether.
fn rounding(e: &Expr) -> f64 {
    match &e.node {
        Node::Number { text, .. } => tolerance(text),
        _ => e.children().into_iter().map(rounding).sum(),
    }
}

/// The fault of a number that converts what units convert already.
fn scaled_twice(term: &Expr, number: f64, what: &str, symbol: &str) -> Fault {
    let symbol = match symbol {
        "1" => say!("a number without unit"),
        symbol => Said::from(symbol.to_owned()),
    };
    let message = say!(
        "the factor {number} would convert `{what}` to {symbol} a second time: units are converted without it"
    );
    Fault::new(faults::SCALED_TWICE, term.span.clone(), message)
        .label(say!("a conversion to {symbol}"))
        .help(left_out(term, number))
}

/// The fault of a number that is in the unit of a quantity already.
fn factor_twice(term: &Expr, number: f64, quantity: &str, symbol: &str) -> Fault {
    let message = say!(
        "the factor {number} is in {symbol}, the unit of `{quantity}`, already: units are converted without it"
    );
    Fault::new(faults::SCALED_TWICE, term.span.clone(), message)
        .label(say!("the factor is in the unit already"))
        .help(left_out(term, number))
}

fn left_out(term: &Expr, number: f64) -> Said {
    let text = printer::expression(term);
    say!(
        "leave {number} out of `{text}`; if it belongs to the measurement, as a dilution does, state it by name in [constant], or write `{number} '1'`"
    )
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
