//! What stands alone: numbers, units, names.

use super::{Binding, Lowering, Value};
use crate::letters::{narrow, told_apart};
use crate::model::MeasurandSource;
use crate::model::catalogue;
use crate::model::faults;
use crate::model::syntax::{Expr, Span, UnitText};
use crate::quantity::Unit;
use gumption_fault::{Fault, nearest, say};

impl Lowering<'_> {
    pub fn literal(&mut self, value: f64, unit: Option<&UnitText>) -> Option<Value> {
        let parsed = match unit {
            Some(text) => self.unit(text)?,
            None => Unit::one(),
        };
        let id = self.builder.constant(value);
        let bare = unit.is_none();
        Some(Value {
            zero: bare && value == 0.0,
            literal: bare,
            ..Value::scalar(id, parsed)
        })
    }

    /// Reads a unit text.
    pub fn unit(&mut self, text: &UnitText) -> Option<Unit> {
        match self.units.parse(&text.text) {
            Ok(unit) => Some(unit),
            Err(error) => {
                let start = text.span.start;
                self.report(Fault::from(error).moved(|s| s.start + start..s.end + start));
                None
            }
        }
    }

    pub fn stray_unit(&mut self, e: &Expr, unit: &UnitText) -> Option<Value> {
        self.report(
            Fault::new(
                faults::UNIT_TEXT,
                e.span.clone(),
                say!("a unit must stand right after a number"),
            )
            .label(say!("no number before this unit"))
            .help(match unit.text.trim().split_once(' ') {
                Some((number, unit)) if number.parse::<f64>().is_ok() => {
                    say!("write `{number} '{}'`", unit.trim())
                }
                _ => say!("write `1 '{}'`", unit.text),
            }),
        );
        None
    }

    pub fn name(&mut self, name: &str, span: &Span) -> Option<Value> {
        if let Some(value) = self.locals.last().and_then(|frame| frame.get(name)) {
            return Some(value.clone());
        }
        match self.binding(name) {
            Some(Binding::Value(value)) => {
                let value = value.clone();
                self.spend(value.elements.len() - 1, span).then_some(value)
            }
            Some(Binding::Faulty) => None,
            Some(Binding::Function(function)) => {
                let list: Vec<&str> = function
                    .parameters
                    .iter()
                    .map(|p| p.text.as_str())
                    .collect();
                let signature = format!("{name}({})", list.join(", "));
                self.function_as_value(name, &signature, span);
                None
            }
            None if catalogue::is_pi(name) => {
                let id = self.builder.constant(std::f64::consts::PI);
                Some(Value {
                    literal: true,
                    ..Value::scalar(id, Unit::one())
                })
            }
            None => {
                self.unknown_name(name, span);
                None
            }
        }
    }

    fn function_as_value(&mut self, name: &str, signature: &str, span: &Span) {
        self.report(
            Fault::new(
                faults::FUNCTION_AS_VALUE,
                span.clone(),
                say!("`{name}` is a function and needs arguments"),
            )
            .label(say!("no arguments"))
            .help(say!("write `{signature}`")),
        );
    }

    /// Reports a name that stands for nothing.
    pub fn unknown_name(&mut self, name: &str, span: &Span) {
        if let Some(info) = catalogue::find(name) {
            let signature = info.signature;
            self.function_as_value(name, signature, span);
            return;
        }
        let comes_later = |m: &MeasurandSource<'_>| m.name == name && m.model.is_some();
        let used_before = if self.later.iter().any(|n| n == name) {
            Some([
                say!("not defined yet"),
                say!(
                    "move the definition of `{name}` above this line; if `{name}` depends on itself, use `solve(equation, {name}, start)`"
                ),
            ])
        } else if self.later_measurands.iter().any(comes_later) {
            Some([
                say!("its formula comes later"),
                say!(
                    "formulas of measurands see those above them: move `[measurand.{name}]` up; or define `{name} = …` in a `model` at the top of the file, and leave out the formula there"
                ),
            ])
        } else {
            None
        };
        if let Some([label, help]) = used_before {
            let message = say!("`{name}` is used before it is defined");
            let fault = Fault::new(faults::USED_BEFORE, span.clone(), message);
            self.report(fault.label(label).help(help));
            return;
        }
        let mut known: Vec<&str> = self
            .scope
            .keys()
            .map(String::as_str)
            .chain(self.symbols.iter().map(|symbol| symbol.name.as_str()))
            .chain(["pi"])
            .collect();
        known.extend(
            self.locals
                .last()
                .into_iter()
                .flat_map(|frame| frame.keys().map(String::as_str)),
        );
        known.sort_unstable();
        let product = product(name, &known);
        let plain = full_width(name).filter(|plain| known.binary_search(&plain.as_str()).is_ok());
        let alike = known
            .iter()
            .find_map(|known| Some((*known, told_apart(name, known)?)));
        let help = match nearest(name, known) {
            _ if let Some((known, [own, other])) = alike => say!(
                "write `{known}`, which looks the same: a letter of `{name}` is {own} of Unicode, that of `{known}` {other}"
            ),
            _ if self.defining.as_deref() == Some(name) => say!(
                "`{name}` is what this formula gives; an equation with `{name}` on both sides is written `solve({name} == …, {name}, start)`"
            ),
            _ if let Some((first, second)) = product => {
                say!("a product has its sign: {first} * {second}")
            }
            _ if let Some(plain) = plain => say!("did you mean `{plain}`?"),
            near if is_of_uncertainty(name) && !near.is_some_and(is_of_uncertainty) => say!(
                "an uncertainty is stated at its input and is no quantity of the model; a figure that somebody states is a constant: [constant.{name}]"
            ),
            Some(near) => say!("did you mean `{near}`?"),
            None if name == "e" => say!("write `exp(1)` for the base of natural logarithms"),
            None => say!(
                "state it as `[input.{name}]` or `[constant.{name}]`, or define `{name} = …` above"
            ),
        };
        self.report(
            Fault::new(
                faults::UNKNOWN_NAME,
                span.clone(),
                say!("`{name}` is not known"),
            )
            .label(say!("no input, constant or quantity of this name"))
            .help(help),
        );
    }
}

/// Whether a name is that of an uncertainty, `u_x` or `U_lab`, where nothing is so called.
fn is_of_uncertainty(name: &str) -> bool {
    name.starts_with("U_") || name.starts_with("u_")
}

/// A name in the letters of another keyboard in plain ones: `Ｖ`.
fn full_width(name: &str) -> Option<String> {
    let plain: String = name.chars().map(narrow).collect();
    (plain != name).then_some(plain)
}

/// The two names of `mg` for `m * g`.
fn product<'n>(name: &'n str, known: &[&str]) -> Option<(&'n str, &'n str)> {
    let cuts = name.char_indices().skip(1);
    let mut pairs = cuts.map(|(at, _)| name.split_at(at));
    pairs.find(|(first, second)| {
        let is_known = |part: &str| known.binary_search(&part).is_ok();
        first != second && is_known(first) && is_known(second)
    })
}
