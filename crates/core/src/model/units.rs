//! The rules of units: where two units meet, which conversion joins them, and what does not go.

use std::borrow::Cow;

use smallvec::smallvec;

use super::faults;
use super::graph::Id;
use super::lower::{Kind, Lowering, Value};
use super::printer;
use super::syntax::{Expr, Infix, Node, Span};
use crate::quantity::{Dimension, Factor, Unit, bare_coulomb, hint_for_clash, revolutions_in};
use gumption_fault::{Fault, Said, say};

/// A quantity and the expression it came from.
#[derive(Clone, Copy)]
pub struct Operand<'a> {
    pub value: &'a Value,
    pub expr: &'a Expr,
}

/// Two operands in one unit.
pub struct Joined<'v> {
    pub left: Cow<'v, Value>,
    pub right: Cow<'v, Value>,
    /// The common unit.
    pub unit: Unit,
}

impl Lowering<'_> {
    /// The same quantity, its numbers in another unit of its dimension.
    pub fn converted(&mut self, value: &Value, unit: &Unit) -> Option<Value> {
        self.in_unit(value, unit).map(Cow::into_owned)
    }

    /// As [`converted`](Self::converted); what has the unit already is not copied.
    fn in_unit<'v>(&mut self, value: &'v Value, unit: &Unit) -> Option<Cow<'v, Value>> {
        if value.unit()? == unit {
            return Some(Cow::Borrowed(value));
        }
        let conversion = value.unit()?.conversion_to(unit)?;
        let mut out = value.clone();
        for id in &mut out.elements {
            *id = self.builder.scale(*id, conversion.factor);
            if conversion.offset != 0.0 {
                let offset = self.builder.constant(conversion.offset);
                *id = self.builder.add(*id, offset);
            }
        }
        out.kind = Kind::Quantity(unit.clone());
        Some(Cow::Owned(out))
    }

    /// The quantity of a value that must not be a truth.
    pub fn quantity<'v>(&mut self, value: &'v Value, expr: &Expr) -> Option<&'v Unit> {
        match &value.kind {
            Kind::Quantity(unit) => Some(unit),
            Kind::Truth => {
                let text = printer::expression(expr);
                self.report(
                    Fault::new(
                        faults::TRUTH_AS_NUMBER,
                        expr.span.clone(),
                        say!("`{text}` is true or false, not a number"),
                    )
                    .label(say!("a condition"))
                    .help(say!("choose between two values: `if({text}, 1, 0)`")),
                );
                None
            }
        }
    }

    /// A condition.
    pub fn truth(&mut self, value: &Value, expr: &Expr) -> Option<()> {
        if value.kind == Kind::Truth {
            return Some(());
        }
        let text = printer::expression(expr);
        self.report(
            Fault::new(
                faults::NUMBER_AS_TRUTH,
                expr.span.clone(),
                say!("`{text}` is a number, not a condition"),
            )
            .label(say!("expected a comparison"))
            .help(say!("compare it, as in `{text} > 0`")),
        );
        None
    }

    /// The unit of a quantity that must not have an origin.
    pub fn difference<'v>(&mut self, operand: Operand<'v>) -> Option<&'v Unit> {
        let unit = self.quantity(operand.value, operand.expr)?;
        if unit.is_point() {
            self.point_fault(operand.expr, unit);
            return None;
        }
        Some(unit)
    }

    /// A quantity of dimension one as a plain number (% divided by 100, ° converted to rad).
    pub fn number(&mut self, operand: Operand<'_>, taker: Said) -> Option<Value> {
        let unit = self.quantity(operand.value, operand.expr)?;
        if operand.value.zero || unit.dimension == Dimension::NONE {
            return self.converted(&operand.value.with_unit_if_zero(&Unit::one()), &Unit::one());
        }
        if unit.is_point() {
            self.point_fault(operand.expr, unit);
            return None;
        }
        let text = printer::expression(operand.expr);
        let symbol = &unit.symbol;
        let help = hint_for_clash(&Unit::one(), unit)
            .unwrap_or_else(|| with_coulomb(self.number_help(operand.expr, unit), [unit]));
        self.report(
            Fault::new(
                faults::NOT_ONE,
                operand.expr.span.clone(),
                say!("{taker} needs a number, but `{text}` is in {symbol}"),
            )
            .label(say!("in {symbol}"))
            .help(help),
        );
        None
    }

    /// How what has a unit becomes a number. A unit that was forgotten comes first: taking the number of what is left would
    /// give another result, and nobody would see it.
    fn number_help(&self, expr: &Expr, unit: &Unit) -> Said {
        let (text, symbol) = (printer::expression(expr), &unit.symbol);
        let Some((name, forgotten)) = self.forgotten(expr, unit, &Unit::one()) else {
            return say!(
                "divide by a reference quantity, or write `value_in({text}, '{symbol}')` for its number in {symbol}"
            );
        };
        let stated = faults::OF_BUDGETS.stated;
        say!(
            "`{name}` has no unit; if it was forgotten, state it {stated} (`unit = \"{}\"` would fit); otherwise divide by a reference quantity, or write `value_in({text}, '{symbol}')` for the number in {symbol}",
            forgotten.symbol
        )
    }

    /// Brings two operands to the unit of the left one, for comparing, choosing and joining.
    pub fn join<'v>(
        &mut self,
        left: Operand<'v>,
        right: Operand<'v>,
        what: &Said,
    ) -> Option<Joined<'v>> {
        let a = self.quantity(left.value, left.expr);
        let b = self.quantity(right.value, right.expr);
        let (a, b) = (a?, b?);
        if a.is_point() != b.is_point() {
            let (point, unit) = if a.is_point() { (left, a) } else { (right, b) };
            self.point_fault(point.expr, unit);
            return None;
        }
        let (to, zeros) = match (left.value.zero, right.value.zero) {
            (_, true) => (a.clone(), true),
            (true, false) => (b.clone(), true),
            (false, false) => (self.common_unit(left, right, a, b, what)?, false),
        };
        if zeros {
            return Some(Joined {
                left: Cow::Owned(left.value.with_unit_if_zero(&to)),
                right: Cow::Owned(right.value.with_unit_if_zero(&to)),
                unit: to,
            });
        }
        let left = self.in_unit(left.value, &to)?;
        let right = self.in_unit(right.value, &to)?;
        Some(Joined {
            left,
            right,
            unit: to,
        })
    }

    /// In which unit two quantities meet: that of the left one, but plain numbers where a number
    /// meets %, ppm and the like.
    fn common_unit(
        &mut self,
        left: Operand<'_>,
        right: Operand<'_>,
        a: &Unit,
        b: &Unit,
        what: &Said,
    ) -> Option<Unit> {
        if a == b {
            return Some(a.clone());
        }
        if a.dimension != b.dimension {
            self.clash(left, right, what);
            return None;
        }
        let sides = [(left.expr, a), (right.expr, b)];
        if let Some(help) = self.hidden_turn_between(sides) {
            self.counted_revolutions(left.expr, right.expr, [a, b], help);
            return None;
        }
        self.term_once(right.expr, b, a)?;
        self.term_once(left.expr, a, b)?;
        if a.dimension != Dimension::NONE || a.factor == b.factor {
            return Some(a.clone());
        }
        for (number, angle, unit) in [(left, right, b), (right, left, a)] {
            if number.value.literal && unit.factor.pi != 0 {
                self.bare_angle(number.expr, angle.expr, unit);
                return None;
            }
        }
        let plain = a.factor == Factor::ONE || b.factor == Factor::ONE;
        Some(if plain { Unit::one() } else { a.clone() })
    }

    /// The fault of two dimensions that meet.
    pub fn clash(&mut self, left: Operand<'_>, right: Operand<'_>, what: &Said) {
        let (Some(a), Some(b)) = (left.value.unit().cloned(), right.value.unit().cloned()) else {
            return;
        };
        let (left_text, right_text) = (
            printer::expression(left.expr),
            printer::expression(right.expr),
        );
        let help = with_coulomb(self.clash_help(left, right, &a, &b), [&a, &b]);
        self.report(
            Fault::new(
                faults::CLASH,
                right.expr.span.clone(),
                say!(
                    "`{left_text}` ({}) and `{right_text}` ({}) cannot be {what}",
                    in_words(&a),
                    in_words(&b)
                ),
            )
            .label(in_words(&b))
            .related(left.expr.span.clone(), in_words(&a))
            .help(help),
        );
    }

    fn clash_help(&self, left: Operand<'_>, right: Operand<'_>, a: &Unit, b: &Unit) -> Said {
        let sides = [(left, a, right, b), (right, b, left, a)];
        for (number, _, other, unit) in sides {
            let Node::Number { text, value, .. } = &number.expr.node else {
                continue;
            };
            if !number.value.literal {
                continue;
            }
            if *value != 1.0 {
                return say!("give the number a unit: `{text} '{}'`", unit.symbol);
            }
            return match self.forgotten(other.expr, unit, &Unit::one()) {
                Some((name, unit)) => if_forgotten(name, &unit),
                None => say!(
                    "what stands beside 1 is a plain number: the units of `{}` must cancel; correct that of one of its quantities",
                    printer::expression(other.expr)
                ),
            };
        }
        if let Some(hint) = hint_for_clash(a, b) {
            return hint;
        }
        for (suspect, own, _, wanted) in sides {
            if let Some((name, unit)) = self.forgotten(suspect.expr, own, wanted) {
                return if_forgotten(name, &unit);
            }
        }
        say!(
            "both must be of one dimension; check the formula and the units {} and {}",
            a.symbol,
            b.symbol
        )
    }

    fn bare_angle(&mut self, number: &Expr, angle: &Expr, unit: &Unit) {
        let text = printer::expression(number);
        self.report(
            Fault::new(
                faults::BARE_ANGLE,
                number.span.clone(),
                say!(
                    "`{text}` has no unit, but meets `{}`, an angle in {}",
                    printer::expression(angle),
                    unit.symbol
                ),
            )
            .label(say!("would be radians"))
            .related(angle.span.clone(), say!("in {}", unit.symbol))
            .help(angle_help(&text, angle, unit)),
        );
    }

    /// The fault of revolutions that are an angle on one side and counted on the other.
    fn counted_revolutions(&mut self, left: &Expr, right: &Expr, [a, b]: [&Unit; 2], help: Said) {
        let (left_text, right_text) = (printer::expression(left), printer::expression(right));
        self.report(
            Fault::new(
                faults::REVOLUTIONS,
                right.span.clone(),
                say!(
                    "`{left_text}` ({}) and `{right_text}` ({}) differ by 2π for each revolution",
                    in_words(a),
                    in_words(b)
                ),
            )
            .label(in_words(b))
            .related(left.span.clone(), in_words(a))
            .help(help),
        );
    }

    /// base^exponent.
    pub fn powered(
        &mut self,
        base: Operand<'_>,
        exponent: Operand<'_>,
        span: Span,
    ) -> Option<Value> {
        let unit = self.difference(base);
        let exponents = self.exponent(exponent);
        let (unit, exponents) = (unit?, exponents?);
        if unit.dimension == Dimension::NONE {
            let bases = self.converted(base.value, &Unit::one())?;
            let one = Kind::Quantity(Unit::one());
            return self.elementwise(&bases, &exponents, one, span, |b, x, y| {
                match b.constant_at(y) {
                    Some(c) => b.power(x, c),
                    None => b.call_binary("^", x, y),
                }
            });
        }
        let constant = match exponents.elements[..] {
            [id] if !exponents.vector => self.builder.constant_at(id),
            _ => None,
        };
        let powered = constant.and_then(|c| {
            let (num, den) = rational(c)?;
            Some((c, unit.powr(num, den)?))
        });
        let Some((c, powered)) = powered else {
            self.exponent_fault(base.expr, exponent.expr, unit, constant);
            return None;
        };
        let mut out = base.value.clone();
        for id in &mut out.elements {
            *id = self.builder.power(*id, c);
        }
        out.kind = Kind::Quantity(powered);
        Some(out)
    }

    fn exponent(&mut self, exponent: Operand<'_>) -> Option<Value> {
        let unit = self.quantity(exponent.value, exponent.expr)?;
        if unit.dimension == Dimension::NONE {
            return self.converted(exponent.value, &Unit::one());
        }
        let text = printer::expression(exponent.expr);
        self.report(
            Fault::new(
                faults::EXPONENT,
                exponent.expr.span.clone(),
                say!("the exponent `{text}` is in {}", unit.symbol),
            )
            .label(say!("expected a number"))
            .help(
                hint_for_clash(&Unit::one(), unit)
                    .unwrap_or_else(|| say!("divide the exponent by a quantity of the same kind")),
            ),
        );
        None
    }

    fn exponent_fault(&mut self, base: &Expr, exponent: &Expr, unit: &Unit, constant: Option<f64>) {
        let (base_text, text) = (printer::expression(base), printer::expression(exponent));
        let symbol = &unit.symbol;
        let why = match constant {
            Some(c) => say!("{symbol} has no power {c}"),
            None => say!(
                "the unit of the power of `{base_text}` (in {symbol}) would depend on `{text}`"
            ),
        };
        self.report(
            Fault::new(faults::EXPONENT, exponent.span.clone(), why)
                .label(say!("expected a constant simple fraction"))
                .related(base.span.clone(), say!("in {symbol}"))
                .help(say!("divide the base by a reference quantity: `({base_text} / (1 '{symbol}'))^{text}`")),
        );
    }

    /// The quantity of an expression that states no unit, which may simply have been forgotten, with the one by which the expression would be in the wanted unit.
    pub fn forgotten<'e>(
        &self,
        expr: &'e Expr,
        own: &Unit,
        wanted: &Unit,
    ) -> Option<(&'e str, Unit)> {
        let names = expr.names().into_iter();
        let mut silent = names.filter(|name| self.has_no_unit(name));
        silent.find_map(|name| {
            let unit = match side(expr, name)? {
                Side::Factor => wanted.quotient(own),
                Side::Divisor => own.quotient(wanted),
            };
            Some((name, unit))
        })
    }

    /// Whether this is a quantity that was stated without a unit.
    pub fn has_no_unit(&self, name: &str) -> bool {
        self.symbol(name).is_some_and(|s| s.unit.is_one())
    }
}

/// What a number beside an angle lacks. What turns in a time that another quantity counts, `n/f`, is counted itself.
fn angle_help(number: &str, angle: &Expr, unit: &Unit) -> Said {
    let operator = if unit.factor.pi > 0 { "/" } else { "*" };
    match unit.full_turn() {
        None if revolutions_in(unit) != 0 => say!(
            "in {} a revolution is an angle, 2π: count revolutions by `{} {operator} (1 'r')`",
            unit.symbol,
            printer::factor(angle)
        ),
        _ => say!(
            "write `{number} '{}'`, or `{number} 'rad'` if radians are meant",
            unit.symbol
        ),
    }
}

/// A mend, behind what is to be known first where a unit has the coulomb in it.
fn with_coulomb<'u>(help: Said, units: impl IntoIterator<Item = &'u Unit>) -> Said {
    match bare_coulomb(units) {
        Some(hint) if !help.to_string().contains("coulomb") => say!("{hint}; {help}"),
        _ => help,
    }
}

/// What to write if a unit was forgotten.
fn if_forgotten(name: &str, unit: &Unit) -> Said {
    say!(
        "if `{name}` has a unit, state it: `unit = \"{}\"`",
        unit.symbol
    )
}

/// How a quantity takes part in a product.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Factor,
    Divisor,
}

/// Whether the whole expression is proportional to a name, or inversely so, as far as is plain to see.
fn side(expr: &Expr, name: &str) -> Option<Side> {
    match &expr.node {
        Node::Name(own) if own == name => Some(Side::Factor),
        Node::Minus(inner) => side(inner, name),
        Node::Chain { first, rest } => {
            let occurs = |e: &Expr| e.names().contains(&name);
            let mut factors = std::iter::once((Infix::Mul, &**first))
                .chain(rest.iter().map(|(infix, e)| (*infix, e)));
            if !factors
                .clone()
                .all(|(infix, _)| matches!(infix, Infix::Mul | Infix::Div))
            {
                return None;
            }
            let (infix, only) = factors.find(|(_, e)| occurs(e))?;
            if factors.any(|(_, e)| occurs(e)) {
                return None;
            }
            match (infix, side(only, name)?) {
                (Infix::Mul, side) => Some(side),
                (_, Side::Factor) => Some(Side::Divisor),
                (_, Side::Divisor) => Some(Side::Factor),
            }
        }
        _ => None,
    }
}

impl Value {
    /// A literal 0 fits any unit.
    pub fn with_unit_if_zero(&self, unit: &Unit) -> Value {
        match self.zero {
            true => self.clone().with_kind(Kind::Quantity(unit.clone())),
            false => self.clone(),
        }
    }

    /// The same numbers as another kind of thing.
    pub fn with_kind(self, kind: Kind) -> Value {
        Value { kind, ..self }
    }

    /// Its unit, unless it is a condition.
    pub fn unit(&self) -> Option<&Unit> {
        match &self.kind {
            Kind::Quantity(unit) => Some(unit),
            Kind::Truth => None,
        }
    }

    /// A single quantity.
    pub fn scalar(id: Id, unit: Unit) -> Value {
        Value {
            elements: smallvec![id],
            vector: false,
            kind: Kind::Quantity(unit),
            zero: false,
            literal: false,
        }
    }
}

/// `in mm`, or `a number without unit`.
pub fn in_words(unit: &Unit) -> Said {
    if unit.is_one() {
        say!("a number without unit")
    } else {
        say!("in {}", unit.symbol)
    }
}

/// c as a fraction whose denominator divides 60.
fn rational(c: f64) -> Option<(i32, i32)> {
    [1, 2, 3, 4, 5, 6, 10, 12, 15, 20, 30, 60]
        .into_iter()
        .find_map(|den| {
            let num = c * f64::from(den);
            let near = (num - num.round()).abs() <= 1e-12 * num.abs().max(1.0);
            (near && num.abs() < 1e6).then_some((num.round() as i32, den))
        })
}
