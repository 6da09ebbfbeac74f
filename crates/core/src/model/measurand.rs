//! The value of each measurand: where it comes from, whether it fits the unit that is wanted.

use std::rc::Rc;

use super::catalogue;
use super::check::{Check, Outcome, reserved};
use super::faults::{self, Wording};
use super::graph::Id;
use super::lower::{Binding, Kind, Value};
use super::printer;
use super::syntax::{Expr, Statement};
use super::units::in_words;
use super::{MeasurandSource, Place};
use crate::quantity::{Dimension, Unit, hint_for_clash, unit_of_angle};
use gumption_fault::{Fault, Said, say};

/// A measurand may be a vector of up to so many elements.
const MOST_ELEMENTS: usize = 100;

impl Check<'_> {
    /// The value of a measurand.
    pub fn measurand(&mut self, index: usize, measurand: &MeasurandSource<'_>) -> Option<Outcome> {
        let outcome = match measurand.model {
            Some(text) => self.own_model(index, measurand, text),
            None => self.shared_model(index, measurand),
        };
        let Some(outcome) = outcome else {
            if self.l.binding(measurand.name).is_none() {
                let name = measurand.name.to_string();
                self.l.scope.insert(name, Binding::Faulty);
            }
            return None;
        };
        // Later measurands may use this one.
        if self.l.binding(measurand.name).is_none() && !catalogue::is_reserved(measurand.name) {
            let value = Value {
                elements: outcome.ids.as_slice().into(),
                vector: outcome.vector,
                kind: Kind::Quantity(outcome.unit.clone()),
                zero: false,
                literal: false,
            };
            self.l
                .scope
                .insert(measurand.name.to_string(), Binding::Value(value));
            self.defined
                .insert(measurand.name.to_string(), outcome.statement);
            self.spans
                .insert(measurand.name.to_string(), (Place::Measurand(index), 0..0));
        }
        Some(outcome)
    }

    fn own_model(
        &mut self,
        index: usize,
        measurand: &MeasurandSource<'_>,
        text: &str,
    ) -> Option<Outcome> {
        let place = Place::Measurand(index);
        if catalogue::is_reserved(measurand.name) {
            self.l.place = Place::Entry(index);
            self.l.report(reserved(measurand.name, 0..0));
        }
        // An input may be reported as it is: `y1`, a parameter of a fit.
        let itself = text.trim() == measurand.name;
        if self.l.symbol(measurand.name).is_some() && !itself {
            self.l.place = Place::Entry(index);
            let name = measurand.name;
            self.l.report(
                Fault::new(
                    faults::DEFINED_TWICE,
                    0..0,
                    say!("`{name}` is a measurand and an input or constant at once"),
                )
                .label(say!("also an input or constant"))
                .help(say!("choose another name for one of them")),
            );
        }
        self.added.clear();
        self.l.defining = Some(measurand.name.to_string());
        let own = self.text(text, place, true);
        self.l.defining = None;
        let outcome = own
            .last()
            .copied()
            .and_then(|statement| self.outcome(index, measurand, statement, own, place));
        // The names of this text are its own.
        for name in std::mem::take(&mut self.added) {
            self.l.scope.remove(&name);
            self.l.provenances.remove(&name);
            self.defined.remove(&name);
            self.spans.remove(&name);
        }
        outcome
    }

    /// The value of a statement as that of the measurand; `own` are the statements of its own text.
    fn outcome(
        &mut self,
        index: usize,
        measurand: &MeasurandSource<'_>,
        statement: usize,
        own: Vec<usize>,
        place: Place,
    ) -> Option<Outcome> {
        let text = Rc::clone(&self.statements[statement].statement);
        let (value, expr) = self.statement_value(&text, statement)?;
        let (ids, unit) = self.result(index, measurand, &value, expr, place)?;
        self.l.note_provenance(measurand.name, expr);
        self.l.scaled_once(measurand.name, &value, expr, &unit)?;
        Some(Outcome {
            ids,
            vector: value.vector,
            unit,
            statement,
            own,
        })
    }

    fn statement_value<'s>(
        &mut self,
        text: &'s Statement,
        statement: usize,
    ) -> Option<(Value, &'s Expr)> {
        match text {
            Statement::Value(expr) => Some((self.last.take()?, expr)),
            Statement::Assign { name, value }
                if self.defined.get(&name.text) == Some(&statement) =>
            {
                match self.l.binding(&name.text)? {
                    Binding::Value(found) => Some((found.clone(), value)),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    fn shared_model(&mut self, index: usize, measurand: &MeasurandSource<'_>) -> Option<Outcome> {
        let name = measurand.name;
        let statement = self.defined.get(name).copied();
        match (self.l.binding(name), statement) {
            (Some(Binding::Value(_)), Some(statement)) => {
                let place = self.statements[statement].place;
                self.outcome(index, measurand, statement, Vec::new(), place)
            }
            (Some(Binding::Faulty), _) if self.l.symbol(name).is_none() => None,
            _ => {
                self.l.place = Place::Entry(index);
                self.l.report(
                    Fault::new(faults::NO_MODEL, 0..0, say!("the measurand `{name}` has no model"))
                        .label(say!("no model"))
                        .help(say!("add `model = \"…\"` here, or define `{name} = …` in the model at the top of the file")),
                );
                None
            }
        }
    }

    /// Checks the value of a measurand and brings it to its unit.
    fn result(
        &mut self,
        index: usize,
        measurand: &MeasurandSource<'_>,
        value: &Value,
        expr: &Expr,
        place: Place,
    ) -> Option<(Vec<Id>, Unit)> {
        self.l.place = place;
        let found = self.l.quantity(value, expr)?;
        if value.elements.len() > MOST_ELEMENTS {
            let text = printer::expression(expr);
            self.l.report(
                Fault::new(
                    faults::VECTOR_RESULT,
                    expr.span.clone(),
                    say!(
                        "`{}` is a vector of {} elements",
                        measurand.name,
                        value.elements.len()
                    ),
                )
                .label(say!("expected at most {MOST_ELEMENTS}"))
                .help(say!("reduce it, `mean({text})`, or take one element")),
            );
            return None;
        }
        let Some(wanted) = &measurand.unit else {
            if found.dimension == Dimension::NONE {
                let out = self.l.converted(value, &Unit::one())?;
                return Some((out.elements.into_vec(), Unit::one()));
            }
            self.l.place = Place::Entry(index);
            self.l.report(
                Fault::new(
                    faults::RESULT_NEEDS_UNIT,
                    0..0,
                    say!(
                        "the measurand `{}` has no unit, but its model gives {}",
                        measurand.name,
                        found.symbol
                    ),
                )
                .label(say!("the value is in {}", found.symbol))
                .help(say!(
                    "add `unit = \"{}\"`, or another unit of this dimension",
                    found.symbol
                )),
            );
            return None;
        };
        let value = value.with_unit_if_zero(wanted);
        let found = value.unit().unwrap_or(found);
        if found.dimension != wanted.dimension {
            let message = say!(
                "the value is {}, but `{}` should be {}",
                in_words(found),
                measurand.name,
                in_words(wanted)
            );
            let help = self.result_help(expr, found, wanted);
            self.l.report(
                Fault::new(faults::RESULT_UNIT, expr.span.clone(), message)
                    .label(in_words(found))
                    .help(help),
            );
            return None;
        }
        if found.is_point() != wanted.is_point() {
            self.point_result(measurand.name, expr, found, wanted);
            return None;
        }
        let turn = self.l.hidden_turn(expr, found, wanted);
        let turn = turn.map(|help| match unit_of_angle(found) {
            Some(other) => say!("{help}, or {other}"),
            None => help,
        });
        let hidden = turn.or_else(|| self.l.hidden_portion(expr, found, wanted));
        if let Some(help) = hidden {
            let message = say!(
                "the value is {}, but `{}` should be {}",
                in_words(found),
                measurand.name,
                in_words(wanted)
            );
            self.l.report(
                Fault::new(faults::REVOLUTIONS, expr.span.clone(), message)
                    .label(in_words(found))
                    .help(help),
            );
            return None;
        }
        let out = self.l.converted(&value, wanted)?;
        Some((out.elements.into_vec(), wanted.clone()))
    }

    fn result_help(&self, expr: &Expr, found: &Unit, wanted: &Unit) -> Said {
        if found.is_one() && wanted.is_point() {
            let (symbol, step) = (&wanted.symbol, wanted.difference().symbol.clone());
            let text = printer::expression(expr);
            return say!(
                "if the formula gives the number of {symbol}, write `0 '{symbol}' + 1 '{step}' * ({text})`"
            );
        }
        if let Some(hint) = hint_for_clash(wanted, found) {
            return hint;
        }
        let Wording {
            measurand: whom,
            unit: whose,
            ..
        } = faults::OF_BUDGETS;
        if let Some((name, unit)) = self.l.forgotten(expr, found, wanted) {
            return say!(
                "`{name}` has no unit; if it was forgotten, state it (`unit = \"{}\"` would fit), or correct {whose}",
                unit.symbol
            );
        }
        let names = expr.names();
        match names.iter().find(|name| self.l.has_no_unit(name)) {
            Some(name) => {
                say!("`{name}` has no unit; if it was forgotten, state it, or correct {whose}")
            }
            None if found.is_one() => say!(
                "correct the formula, or write `unit = \"1\"` for {whom}; a formula of numbers, as of `value_in`, is multiplied by `1 '{}'`",
                wanted.symbol
            ),
            None => say!(
                "correct the formula, or write `unit = \"{}\"` for {whom}",
                found.symbol
            ),
        }
    }

    /// How a difference becomes a temperature on a scale, if it is not meant as a difference.
    fn onto_scale(&self, name: &str, expr: &Expr, wanted: &Unit) -> Said {
        let (scale, step) = (&wanted.symbol, wanted.difference().symbol.clone());
        let text = printer::expression(expr);
        let added = match scale.as_str() {
            "°C" => say!(
                "a thermodynamic temperature is on the scale as `0 '°C' + ({text} - 273.15 'K')`, a difference from 0 °C as `0 '°C' + ({text})`"
            ),
            _ => say!("a difference from 0 {scale} is on the scale as `0 '{scale}' + ({text})`"),
        };
        let is_point = |name: &&str| self.l.symbol(name).is_some_and(|s| s.unit.is_point());
        match expr.names().iter().any(is_point) {
            true => say!(
                "write `unit = \"{step}\"` for `{name}` if it is an error or a correction: two quantities on the {scale} scale that are subtracted leave a difference. If one of the two is a correction, that one has `unit = \"{step}\"`, even if its value is zero; {added}"
            ),
            false => say!(
                "{added}; if `{name}` is an error or a correction, write `unit = \"{step}\"` for it"
            ),
        }
    }

    fn point_result(&mut self, name: &str, expr: &Expr, found: &Unit, wanted: &Unit) {
        if found.is_point() {
            self.l.point_fault(expr, found);
            return;
        }
        let help = self.onto_scale(name, expr, wanted);
        self.l.report(
            Fault::new(
                faults::POINT,
                expr.span.clone(),
                say!(
                    "the value is a difference in {}, but `{name}` should be on the {} scale",
                    found.symbol,
                    wanted.symbol
                ),
            )
            .label(say!("a difference in {}", found.symbol))
            .help(help),
        );
    }
}
