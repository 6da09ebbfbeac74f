//! A formula written out: `column = …`.

use std::ops::Range;

use super::super::super::checker::Checker;
use super::super::columns::Column;
use super::parts::{Formula, Parameter, Scope};
use crate::budget::faults::{FIT, MODIFIER};
use gumption_core::model::faults::LEFT_SIDE;
use gumption_core::model::{Outline, outline};
use gumption_fault::{Fault, say};
use gumption_format::toml::{Slot, Stated};

/// A formula that was read, and whose left side is a column.
pub(super) struct Written<'f> {
    pub fit: &'f Scope<'f>,
    pub text: &'f Stated<String>,
    pub outline: &'f Outline,
    /// Column on the left.
    pub response: usize,
}

impl<'f> Written<'f> {
    /// Whether the formula names it.
    pub fn uses(&self, name: &str) -> bool {
        self.outline.needs.iter().any(|(needed, _)| needed == name)
    }

    /// The column on the left.
    pub fn left(&self) -> &'f Column<'f> {
        &self.fit.columns[self.response]
    }
}

impl Checker<'_> {
    /// The formula that `model` states.
    pub(super) fn fit_text(
        &mut self,
        fit: &Scope<'_>,
        text: &Stated<String>,
    ) -> Result<Formula, Vec<Parameter>> {
        self.keys_of_polynomials(fit);
        let outline = self.fit_outline(text).ok_or_else(Vec::new)?;
        let needs = outline.needs.iter().map(|(name, _)| name.clone());
        self.names.used_by_fits.extend(needs);
        let response = self
            .fit_response(fit, text, &outline)
            .ok_or_else(Vec::new)?;
        let written = Written {
            fit,
            text,
            outline: &outline,
            response,
        };
        let parameters = self.fit_parameters(&written).ok_or_else(Vec::new)?;
        self.fit_compiled(&written, parameters)
    }

    /// The place in the file of a part of a formula.
    pub(super) fn part_of_formula(
        &self,
        text: &Stated<String>,
        part: &Range<usize>,
    ) -> Range<usize> {
        let fault = Fault::new(FIT, part.clone(), "");
        self.in_formula(fault, Some(text)).span
    }

    /// Refuses the keys that say what a formula says by itself.
    fn keys_of_polynomials(&mut self, fit: &Scope<'_>) {
        let table = &fit.stated.value;
        let key = |stated: &Slot<String>| stated.as_ref().map(|stated| stated.key.clone());
        let intercept = table.intercept.as_ref().map(|stated| stated.key.clone());
        for (name, place) in [
            ("response", key(&table.response)),
            ("predictor", key(&table.predictor)),
            ("intercept", intercept),
        ] {
            self.messages.faults.extend(place.map(|place| {
                Fault::new(
                    MODIFIER,
                    place,
                    say!("`{name}` does not go with `model`"),
                )
                .label(say!("no meaning here"))
                .help(say!("it belongs to `polynomial`; a formula says by itself what it gives and from what"))
            }));
        }
    }

    fn fit_outline(&mut self, text: &Stated<String>) -> Option<Outline> {
        match outline(&text.value, &self.names.units) {
            Ok(outline) => Some(outline),
            Err(faults) => {
                for fault in faults {
                    let placed = self.in_formula(left_side(fault), Some(text));
                    self.report(placed);
                }
                None
            }
        }
    }

    /// The column on the left of a formula.
    fn fit_response(
        &mut self,
        fit: &Scope<'_>,
        text: &Stated<String>,
        outline: &Outline,
    ) -> Option<usize> {
        let Some((given, part)) = &outline.gives else {
            return self.refuse(without_left_side(fit, text, outline));
        };
        fit.column(given).or_else(|| {
            let place = self.part_of_formula(text, part);
            self.refuse(fit.no_such_column(given, place, |near| format!("`{near}`")))
        })
    }
}

fn without_left_side(fit: &Scope<'_>, text: &Stated<String>, outline: &Outline) -> Fault {
    let place = text.span.clone();
    // `ln(y) = …` reads as the definition of a function.
    let last = outline.printed.lines().last().unwrap_or_default();
    let defined = last.split_once(" = ");
    if let Some((before, _)) = defined.filter(|(before, _)| !before.is_empty()) {
        let message = say!("`{before}` cannot be defined");
        return left_side(Fault::new(LEFT_SIDE, place, message));
    }
    let message = say!("the formula of the fit {} has no left side", fit.name);
    Fault::new(FIT, place, message)
        .label(say!("expected a column, `=` and the formula for it"))
        .help(say!(
            "write for example \"{} = …\"",
            fit.columns.last().map_or("y", |column| column.name)
        ))
}

/// An expression left of `=`, in words of a fit: there stands a column, not a measurand.
fn left_side(mut fault: Fault) -> Fault {
    if fault.code == LEFT_SIDE {
        fault.message = say!("`{before}` is no column", before = "").with_values_of(fault.message);
        fault.label = say!("only the name of a column may stand left of `=`");
        fault.help = Some(say!(
            "solve the formula for a column (a predictor may have the larger uncertainty, too), or give the transformed values a column of their own"
        ));
    }
    fault
}
