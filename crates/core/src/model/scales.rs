//! Temperature scales: units with an origin of their own, on which points and differences are told apart.

use std::borrow::Cow;

use super::faults;
use super::lower::{Kind, Lowering};
use super::printer;
use super::syntax::{Expr, Infix, Node};
use super::units::{Joined, Operand};
use crate::quantity::Unit;
use gumption_fault::{Fault, Said, say};

impl Lowering<'_> {
    /// Sum or difference with the arithmetic of temperature scales: point - point is a difference,
    /// point ± difference is a point.
    pub fn sum<'v>(
        &mut self,
        left: Operand<'v>,
        infix: Infix,
        right: Operand<'v>,
    ) -> Option<Joined<'v>> {
        let a = self.quantity(left.value, left.expr);
        let b = self.quantity(right.value, right.expr);
        let (a, b) = (a?, b?);
        let what = match infix {
            Infix::Add => say!("added"),
            _ => say!("subtracted"),
        };
        match (a.is_point(), infix, b.is_point()) {
            (false, _, false) => self.join(left, right, &what),
            (true, Infix::Sub, true) => {
                let joined = self.join(left, right, &what)?;
                Some(Joined {
                    unit: a.difference(),
                    ..joined
                })
            }
            (true, _, false) => {
                self.no_zero_of_kelvin(left, a, right)?;
                self.no_bare_number(left, infix, right, a)?;
                let step = left.value.clone().with_kind(Kind::Quantity(a.difference()));
                let joined = self.join(
                    Operand {
                        value: &step,
                        ..left
                    },
                    right,
                    &what,
                )?;
                Some(Joined {
                    left: Cow::Borrowed(left.value),
                    right: Cow::Owned(joined.right.into_owned()),
                    unit: a.clone(),
                })
            }
            (false, Infix::Add, true) => {
                self.no_zero_of_kelvin(right, b, left)?;
                self.no_bare_number(right, infix, left, b)?;
                let step = right
                    .value
                    .clone()
                    .with_kind(Kind::Quantity(b.difference()));
                // The other way round, so that the conversion is to the scale of the point.
                let joined = self.join(
                    Operand {
                        value: &step,
                        ..right
                    },
                    left,
                    &what,
                )?;
                Some(Joined {
                    left: Cow::Owned(joined.right.into_owned()),
                    right: Cow::Borrowed(right.value),
                    unit: b.clone(),
                })
            }
            (true, Infix::Add, true) => {
                self.sum_of_points(left.expr, right.expr, b);
                None
            }
            // What is no temperature is not mended by making the other a difference.
            _ if a.dimension != b.dimension && !left.value.zero => {
                self.clash(left, right, &what);
                None
            }
            _ => {
                self.point_fault(right.expr, b);
                None
            }
        }
    }

    /// The fault of two temperatures in °C that are added, mostly for their mean.
    fn sum_of_points(&mut self, left: &Expr, right: &Expr, unit: &Unit) {
        let (a, b) = (printer::expression(left), printer::expression(right));
        let (symbol, difference) = (&unit.symbol, unit.difference().symbol.clone());
        self.report(
            Fault::new(
                faults::POINT,
                right.span.clone(),
                say!("`{a}` and `{b}` are both points on a scale, and have no sum"),
            )
            .label(say!("a point on the {symbol} scale"))
            .related(left.span.clone(), say!("a point on the {symbol} scale"))
            .help(say!(
                "their mean is `mean([{a}, {b}])`; where one of them is a difference or a correction, its unit is {difference}: `unit = \"{difference}\"`; thermodynamic temperatures are `kelvin({a}) + kelvin({b})`"
            )),
        );
    }

    /// Refuses 273.15 K added to a temperature in °C, or taken from it: the sum stays on the scale of °C,
    /// and `kelvin` would add the same once more.
    fn no_zero_of_kelvin(
        &mut self,
        point: Operand<'_>,
        unit: &Unit,
        step: Operand<'_>,
    ) -> Option<()> {
        let exact = match step.value.elements[..] {
            [id] => self.builder.constant_at(id),
            _ => None,
        };
        let of_kelvin = match step.value.unit() {
            Some(own) if own.is_one() => unit.factor.value(),
            Some(own) => own.factor.value(),
            None => return Some(()),
        };
        let is_zero = exact
            .zip(unit.origin)
            .is_some_and(|(value, origin)| (value * of_kelvin - origin).abs() < 1e-9 * origin);
        if !is_zero {
            return Some(());
        }
        let (text, number) = (
            printer::expression(point.expr),
            printer::expression(step.expr),
        );
        let symbol = &unit.symbol;
        self.report(
            Fault::new(
                faults::POINT,
                step.expr.span.clone(),
                say!("`{number}` would move `{text}` along the scale of {symbol}, not to kelvin"),
            )
            .label(say!("the zero of {symbol}"))
            .related(point.expr.span.clone(), say!("in {symbol}"))
            .help(say!(
                "`kelvin({text})` is the thermodynamic temperature of `{text}`"
            )),
        );
        None
    }

    /// Refuses a number without unit beside a temperature in °C: `t - 20` may mean the difference from
    /// 20 °C, a temperature that is 20 K lower, or a formula that takes temperatures as numbers.
    fn no_bare_number(
        &mut self,
        point: Operand<'_>,
        infix: Infix,
        step: Operand<'_>,
        unit: &Unit,
    ) -> Option<()> {
        if step.value.zero || !step.value.unit()?.is_one() {
            return Some(());
        }
        let text = printer::expression(point.expr);
        let (symbol, difference) = (&unit.symbol, unit.difference().symbol.clone());
        let number = match &step.expr.node {
            Node::Number { text, .. } if step.value.literal => text,
            Node::Name(name) if self.has_no_unit(name) => {
                let help = match infix {
                    Infix::Sub => say!(
                        "state it: `unit = \"{symbol}\"` for a temperature, `unit = \"{difference}\"` for a difference of temperatures; a formula for the number of `{text}` in {symbol} takes `value_in({text}, '{symbol}')`"
                    ),
                    _ => {
                        say!(
                            "state it: `unit = \"{difference}\"` for a difference of temperatures; a formula for the number of `{text}` in {symbol} takes `value_in({text}, '{symbol}')`"
                        )
                    }
                };
                self.bare_beside_point(step.expr, point.expr, symbol, help);
                return None;
            }
            _ => return Some(()),
        };
        let help = match infix {
            Infix::Sub => say!(
                "the difference from {number} {symbol} is `{text} - {number} '{symbol}'`, a temperature {number} {difference} lower `{text} - {number} '{difference}'`"
            ),
            _ => say!(
                "a temperature {number} {difference} higher is `{text} + {number} '{difference}'`"
            ),
        };
        let help = say!(
            "{help}; a formula for the number of `{text}` in {symbol} takes `value_in({text}, '{symbol}')`"
        );
        self.bare_beside_point(step.expr, point.expr, symbol, help);
        None
    }

    fn bare_beside_point(&mut self, bare: &Expr, point: &Expr, symbol: &str, help: Said) {
        let (bare_text, text) = (printer::expression(bare), printer::expression(point));
        self.report(
            Fault::new(
                faults::CLASH,
                bare.span.clone(),
                say!("`{bare_text}` has no unit, but meets `{text}`, a temperature in {symbol}"),
            )
            .label(say!("a number without unit"))
            .related(point.span.clone(), say!("in {symbol}"))
            .help(help),
        );
    }

    /// The fault of a point temperature in a product, function or sum of points.
    pub fn point_fault(&mut self, expr: &Expr, unit: &Unit) {
        let text = printer::expression(expr);
        let symbol = &unit.symbol;
        let difference = unit.difference().symbol.clone();
        let apart = match subtracted_step(expr) {
            Some((point, number)) => {
                say!("the difference from {number} {symbol}, `{point} - {number} '{symbol}'`")
            }
            None => say!(
                "the difference from 0 {symbol}, `{text} - 0 '{symbol}'`, or from another reference, `{text} - 20 '{symbol}'`"
            ),
        };
        self.report(
            Fault::new(
                faults::POINT,
                expr.span.clone(),
                say!("`{text}` is in {symbol}, a scale with an arbitrary zero, and cannot be used as an amount"),
            )
            .label(say!("a point on the {symbol} scale"))
            .help(match is_called_a_difference(&text) {
                _ if text.starts_with(|c: char| c.is_ascii_digit()) => say!(
                    "a difference is in {difference}: write `{}`",
                    text.replace(symbol.as_str(), &difference)
                ),
                true => say!(
                    "a difference or a correction is stated in {difference}: `unit = \"{difference}\"` for {text}, with the same numbers"
                ),
                false => say!(
                    "of a temperature write `kelvin({text})`, {apart}, or its number without unit, `value_in({text}, '{symbol}')`; a difference or a correction is stated in {difference}: `unit = \"{difference}\"`"
                ),
            }),
        );
    }
}

/// Whether a name says that it is a difference: `Δt`, `δt_a`, `dT`, `delta_t`.
fn is_called_a_difference(name: &str) -> bool {
    let lower = name.to_lowercase();
    let short = name
        .strip_prefix('d')
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_uppercase() || "tθ_".contains(c)));
    short || lower.starts_with(['δ', '∆']) || lower.starts_with("delta")
}

/// `t` and `20` of `t - 20 'K'`, which is a point where the difference from one was meant.
fn subtracted_step(expr: &Expr) -> Option<(String, &str)> {
    let Node::Chain { first, rest } = &expr.node else {
        return None;
    };
    match rest.as_slice() {
        [(Infix::Sub, right)] => match &right.node {
            Node::Number {
                text,
                unit: Some(unit),
                ..
            } if unit.text == "K" => Some((printer::expression(first), text)),
            _ => None,
        },
        _ => None,
    }
}
