//! Revolutions, an angle of 2π each, where a formula counts them or holds their 2π itself.

use super::catalogue::{FunctionInfo, find, is_pi};
use super::digits;
use super::faults;
use super::lower::{Lowering, Provenance};
use super::printer;
use super::syntax::{Expr, Infix, Node};
use super::{Role, Symbol};
use crate::quantity::{Dimension, Unit, counts, revolutions_as_angle, revolutions_in};
use gumption_fault::{Fault, Said, say};
use std::f64::consts::PI;

/// A factor of a product.
struct Factor<'e> {
    expr: &'e Expr,
    /// 1 above the line, -1 below.
    power: i32,
    unit: Unit,
    /// The value of a number without a unit.
    constant: Option<f64>,
}

const LENGTH: Dimension = Dimension::of([1, 0, 0, 0, 0, 0, 0, 0]);
const AREA: Dimension = Dimension::of([2, 0, 0, 0, 0, 0, 0, 0]);
const VOLUME: Dimension = Dimension::of([3, 0, 0, 0, 0, 0, 0, 0]);
const MASS: Dimension = Dimension::of([0, 1, 0, 0, 0, 0, 0, 0]);

impl Lowering<'_> {
    /// What to write where what an expression gives would be brought to a unit with a hidden 2π. What holds π converts
    /// by itself, and a count that comes of lengths or angles is one of radians.
    pub fn hidden_turn(&self, expr: &Expr, found: &Unit, wanted: &Unit) -> Option<Said> {
        let help = revolutions_as_angle(found, wanted, &printer::factor(expr))?;
        let may_be_angle = counts(found) && !self.is_counted(expr);
        (!may_be_angle && !self.holds_pi(expr)).then_some(help)
    }

    /// What to write where the volume of a revolution would be given as that of a radian.
    pub fn hidden_portion(&self, expr: &Expr, found: &Unit, wanted: &Unit) -> Option<Said> {
        let is_volume = found.dimension == VOLUME && revolutions_in(found) == -1;
        let has_angle = wanted.symbol.contains("rad") || wanted.factor.pi != 0;
        let text = printer::factor(expr);
        (is_volume && !has_angle && !self.holds_pi(expr)).then(|| {
            say!(
                "a revolution is an angle, 2π, in {}: write `{text} * (1 'r')` for the volume of a revolution, `{text} * (1 'rad')` for that of a radian",
                found.symbol
            )
        })
    }

    /// As [`hidden_turn`](Self::hidden_turn), for two quantities that meet.
    pub fn hidden_turn_between(&self, sides: [(&Expr, &Unit); 2]) -> Option<Said> {
        let [(left, a), (right, b)] = sides;
        let help = self.hidden_turn(right, b, a)?;
        self.hidden_turn(left, a, b).map(|_| help)
    }

    /// Notes what a name stands for, for the formulas that use it.
    pub fn note_provenance(&mut self, name: &str, expr: &Expr) {
        let provenance = Provenance {
            holds_pi: self.holds_pi(expr),
            is_counted: self.is_counted(expr),
        };
        self.provenances.insert(name.to_owned(), provenance);
    }

    /// Whether π is in an expression, by name or as a number.
    fn holds_pi(&self, expr: &Expr) -> bool {
        match &expr.node {
            Node::Number {
                value,
                text,
                unit: None,
            } => is_of_pi(*value, digits::tolerance(text)),
            Node::Name(name) if is_pi(name) => true,
            Node::Name(name) => match (self.provenances.get(name.as_str()), self.symbol(name)) {
                (Some(provenance), _) => provenance.holds_pi,
                (None, Some(symbol)) => is_constant_of_pi(symbol),
                (None, None) => false,
            },
            _ => expr.children().into_iter().any(|part| self.holds_pi(part)),
        }
    }

    /// Whether an expression is made of times, and of what is counted or comes in portions, by arithmetic alone.
    fn is_counted(&self, expr: &Expr) -> bool {
        match &expr.node {
            Node::Number {
                unit: Some(unit), ..
            } => {
                let unit = self.units.parse(&unit.text);
                unit.is_ok_and(|unit| is_countable(unit.dimension))
            }
            Node::Number { .. } => true,
            Node::Name(name) => match (self.provenances.get(name.as_str()), self.symbol(name)) {
                (Some(provenance), _) => provenance.is_counted,
                (None, Some(symbol)) => is_countable(symbol.unit.dimension),
                (None, None) => false,
            },
            Node::Call { name, .. } if !find(&name.text).is_some_and(FunctionInfo::keeps_unit) => {
                false
            }
            _ => {
                let parts = expr.children();
                parts.into_iter().all(|part| self.is_counted(part))
            }
        }
    }

    /// Refuses a product that counts revolutions although one of its quantities has them as an angle: the 2π of the formula would
    /// be there twice, `2*pi*n*M`, or a volume for each revolution be taken as one for each radian, `n*V`.
    pub fn turned_once(
        &mut self,
        whole: &Expr,
        first: &Expr,
        rest: &[(Infix, Expr)],
    ) -> Option<()> {
        let is_product = |(infix, _): &(Infix, Expr)| matches!(infix, Infix::Mul | Infix::Div);
        if !self.has_revolutions || !rest.iter().all(is_product) {
            return Some(());
        }
        let factors = self.factors(first, rest)?;
        let unit = factors
            .iter()
            .fold(Unit::one(), |unit, factor| match factor.power {
                1 => unit.product(&factor.unit),
                _ => unit.quotient(&factor.unit),
            });
        let turning = revolutions_in(&unit);
        let mut turns = factors.iter().filter(|f| revolutions_in(&f.unit) != 0);
        let (Some(turn), None, 1 | -1) = (turns.next(), turns.next(), turning) else {
            return Some(());
        };
        let fault = if is_doubled(&factors, turn, turning) {
            doubled_turn(whole, turn)
        } else if let Some(portion) = portion(&factors, turn, turning) {
            portion_for_radian(whole, turn, portion)
        } else {
            return Some(());
        };
        self.report(fault);
        None
    }

    fn factors<'e>(
        &mut self,
        first: &'e Expr,
        rest: &'e [(Infix, Expr)],
    ) -> Option<Vec<Factor<'e>>> {
        let parts = rest.iter().map(|(infix, e)| match infix {
            Infix::Div => (-1, e),
            _ => (1, e),
        });
        let parts = std::iter::once((1, first)).chain(parts);
        parts.map(|(power, e)| self.factor(power, e)).collect()
    }

    fn factor<'e>(&mut self, power: i32, expr: &'e Expr) -> Option<Factor<'e>> {
        let value = self.value(expr)?;
        let unit = value.unit()?.clone();
        let id = value.elements.first().filter(|_| value.literal);
        let constant = id.and_then(|id| self.builder.constant_at(*id));
        Some(Factor {
            expr,
            power,
            unit,
            constant,
        })
    }
}

impl Factor<'_> {
    /// Whether it is no number, known or not.
    fn has_dimension(&self) -> bool {
        !self.unit.dimension.is_none()
    }

    fn is_power(&self) -> bool {
        matches!(self.expr.node, Node::Power { .. })
    }
}

/// Whether the π of a product is the one that a revolution has already. Areas and volumes have a π of their own, but more than
/// one length beside it, or other numbers: `pi/4 * d^2 * n`, `4*pi*h*n`.
fn is_doubled(factors: &[Factor<'_>], turn: &Factor<'_>, turning: i32) -> bool {
    let numbers = || factors.iter().filter_map(|f| Some((f, f.constant?)));
    let of_pi: i32 = numbers().map(|(f, _)| f.power * power_of_pi(f.expr)).sum();
    if of_pi != turning {
        return false;
    }
    let number: f64 = numbers()
        .map(|(f, value)| value.powi(f.power * turning))
        .product();
    let others = || {
        factors
            .iter()
            .filter(|f| f.constant.is_none() && !is_same(f, turn))
    };
    let mut quantities = others().filter(|f| f.has_dimension());
    match (quantities.next(), quantities.next()) {
        _ if others().next().is_none() => true,
        (None, _) => is_among(number / PI, &[1.0, 2.0]),
        (Some(one), None) => !one.is_power() && is_among(number / PI, &[1.0, 2.0]),
        _ => leads(factors, turn) && is_among(number / PI, &[2.0]),
    }
}

/// Whether nothing but numbers stands before a factor, as in `2*pi*n*F*l`.
fn leads(factors: &[Factor<'_>], turn: &Factor<'_>) -> bool {
    let mut before = factors.iter().take_while(|f| !is_same(f, turn));
    turn.power == 1 && before.all(|f| f.constant.is_some())
}

/// Whether a number is one of some, but for minutes and the prefixes of a unit.
fn is_among(number: f64, wanted: &[f64]) -> bool {
    let scales = [1.0, 60.0, 1e3, 60e3, 1e6];
    let mut pairs = wanted.iter().flat_map(|w| scales.map(|scale| w / scale));
    pairs.any(|expected| (number / expected - 1.0).abs() < digits::NEAR)
}

/// The volume or mass that comes with each revolution. Beside lengths and areas a volume may be anything.
fn portion<'f, 'e>(
    factors: &'f [Factor<'e>],
    turn: &Factor<'_>,
    turning: i32,
) -> Option<&'f Factor<'e>> {
    let others = || {
        factors
            .iter()
            .filter(|f| f.has_dimension() && !is_same(f, turn))
    };
    let is_portion = |f: &&Factor<'_>| f.power == turning && !f.is_power();
    let mut volumes = others().filter(|f| f.unit.dimension == VOLUME);
    match (volumes.next().filter(is_portion), volumes.next()) {
        (Some(volume), None) if !others().any(|f| [LENGTH, AREA].contains(&f.unit.dimension)) => {
            Some(volume)
        }
        _ => {
            let mut quantities = others();
            let only = quantities.next().filter(|_| quantities.next().is_none());
            only.filter(is_portion).filter(|f| f.unit.dimension == MASS)
        }
    }
}

fn is_same(a: &Factor<'_>, b: &Factor<'_>) -> bool {
    std::ptr::eq(a.expr, b.expr)
}

/// In which power π is in a number.
fn power_of_pi(e: &Expr) -> i32 {
    match &e.node {
        Node::Name(_) => 1,
        Node::Number { value, text, .. } => i32::from(is_of_pi(*value, digits::tolerance(text))),
        Node::Minus(inner) => power_of_pi(inner),
        Node::Chain { first, rest } => {
            let sign = |infix: &Infix| if *infix == Infix::Div { -1 } else { 1 };
            let rest = rest.iter().map(|(infix, e)| sign(infix) * power_of_pi(e));
            power_of_pi(first) + rest.sum::<i32>()
        }
        Node::Power { base, exponent } => match exponent.node {
            Node::Number { value, .. } => power_of_pi(base) * value as i32,
            _ => 0,
        },
        _ => 0,
    }
}

/// Whether a number is π, or 2π, by its digits, also for minutes.
fn is_of_pi(number: f64, tolerance: f64) -> bool {
    let mut known = [1.0, 2.0, 4.0, 0.5, 60.0, 120.0, 1.0 / 30.0].into_iter();
    known.any(|k| (number / (k * PI) - 1.0).abs() <= tolerance)
}

fn is_constant_of_pi(symbol: &Symbol) -> bool {
    match symbol.role {
        Role::Constant(value) => symbol.unit.is_one() && is_of_pi(value, digits::NEAR),
        _ => false,
    }
}

/// Times, and what is counted or comes in portions.
fn is_countable(dimension: Dimension) -> bool {
    [Dimension::NONE, VOLUME, MASS].into_iter().any(|portion| {
        let mut powers = -2..=2;
        powers.any(|n| dimension == portion.product(Dimension::of([0, 0, n, 0, 0, 0, 0, 0])))
    })
}

/// What to write in place of a quantity in which revolutions are an angle.
fn counted(turn: &Factor<'_>) -> String {
    let operator = if revolutions_in(&turn.unit) > 0 {
        "/"
    } else {
        "*"
    };
    format!("({} {operator} (1 'r'))", printer::factor(turn.expr))
}

fn doubled_turn(whole: &Expr, turn: &Factor<'_>) -> Fault {
    let (text, symbol) = (printer::expression(turn.expr), &turn.unit.symbol);
    Fault::new(
        faults::REVOLUTIONS,
        whole.span.clone(),
        say!(
            "`{}` holds 2π twice: in {symbol} a revolution is an angle, 2π",
            printer::expression(whole)
        ),
    )
    .label(say!("π beside {symbol}"))
    .related(turn.expr.span.clone(), say!("in {symbol}"))
    .help(say!(
        "where the formula counts revolutions, write `{}` in place of `{text}`",
        counted(turn)
    ))
}

fn portion_for_radian(whole: &Expr, turn: &Factor<'_>, portion: &Factor<'_>) -> Fault {
    let (text, symbol) = (printer::expression(turn.expr), &turn.unit.symbol);
    let amount = printer::expression(portion.expr);
    Fault::new(
        faults::REVOLUTIONS,
        whole.span.clone(),
        say!("`{amount}` would be an amount for each radian: in {symbol} a revolution is an angle, 2π"),
    )
    .label(say!("holds 2π"))
    .related(turn.expr.span.clone(), say!("in {symbol}"))
    .help(say!(
        "write `{}` in place of `{text}` if `{amount}` is for each revolution, `({amount} / (1 'rad'))` in place of `{amount}` if it is for each radian",
        counted(turn)
    ))
}
