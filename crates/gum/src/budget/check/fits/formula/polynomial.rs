//! A formula given by its degree.

use super::super::super::checker::Checker;
use super::parts::{Formula, Parameter, Scope, Shape};
use crate::budget::faults::{FIT, MISSING_KEY, MODIFIER, UNIT_CLASH, UNUSED};
use crate::budget::tables::FitParameterTable;
use gumption_core::least_squares::{Polynomial, Response};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::{Slot, Stated};

/// The highest degree of a polynomial.
const HIGHEST: u64 = 30;

/// A polynomial between two columns.
struct Between<'f> {
    fit: &'f Scope<'f>,
    response: usize,
    predictor: usize,
    polynomial: Polynomial,
}

impl Checker<'_> {
    /// The formula that `polynomial` states.
    pub(super) fn fit_polynomial(
        &mut self,
        fit: &Scope<'_>,
        degree: &Stated<u64>,
    ) -> Option<Formula> {
        let table = &fit.stated.value;
        let response = self.fit_side(fit, "response", &table.response);
        let predictor = self.fit_side(fit, "predictor", &table.predictor);
        let (response, predictor) = (response?, predictor?);
        if degree.value > HIGHEST {
            return self.refuse(too_high(degree));
        }
        if let Some(idle) = (0..fit.columns.len()).find(|i| *i != response && *i != predictor) {
            return self.refuse(idle_column(fit, idle));
        }
        let between = Between {
            fit,
            response,
            predictor,
            polynomial: Polynomial {
                degree: usize::try_from(degree.value).ok()?,
                intercept: table.intercept.as_ref().is_none_or(|stated| stated.value),
            },
        };
        if let Some(fault) = between.wrong_count(degree) {
            return self.refuse(fault);
        }
        let parameters: Option<Vec<Parameter>> = (0..between.polynomial.parameters())
            .map(|place| self.fit_coefficient(&between, place))
            .collect();
        let parameters = parameters?;
        Some(Formula {
            response,
            predictors: vec![predictor],
            equation: between.equation(&parameters),
            parameters,
            shape: Shape::Polynomial(between.polynomial),
            model: None,
            place: degree.span.clone(),
        })
    }

    /// The column that `response` or `predictor` names.
    fn fit_side(&mut self, fit: &Scope<'_>, key: &str, side: &Slot<String>) -> Option<usize> {
        match side {
            Some(side) => fit.column(&side.value).or_else(|| {
                let place = side.span.clone();
                self.refuse(fit.no_such_column(&side.value, place, |near| format!("\"{near}\"")))
            }),
            None if fit.stated.value.refused => None,
            None => self.refuse(missing_side(fit, key)),
        }
    }

    /// One coefficient, with the unit that the columns give it.
    fn fit_coefficient(&mut self, between: &Between<'_>, place: usize) -> Option<Parameter> {
        let (fit, power) = (between.fit, place + between.lowest());
        let entry = fit.declared().and_then(|list| list.get(place));
        let unit = between.unit(power)?;
        let name = entry.map_or_else(
            || format!("{}_{power}", fit.name),
            |(name, _)| name.to_string(),
        );
        if let Some((_, stated)) = entry {
            self.check_fit_coefficient(&name, &stated.value, &unit)?;
        }
        let description = entry.and_then(|(_, stated)| stated.value.description.as_ref());
        Some(Parameter {
            name,
            place: entry.map_or(fit.stated.key.clone(), |(_, stated)| stated.key.clone()),
            unit: Some(unit),
            start: None,
            description: description.map(|text| text.value.clone()),
            stated: None,
        })
    }

    /// Refuses another unit than that which the columns give, and a start value.
    fn check_fit_coefficient(
        &mut self,
        name: &str,
        table: &FitParameterTable,
        natural: &Unit,
    ) -> Option<()> {
        if let Some(unit) = &table.unit {
            let found = self.unit(&Some(unit.clone()))?;
            let same = found
                .conversion_to(natural)
                .is_some_and(|conversion| conversion.is_identity());
            if !same {
                let message = say!("{name} is in {}, not in {}", natural.symbol, found.symbol);
                return self.refuse(
                    Fault::new(UNIT_CLASH, unit.span.clone(), message)
                        .label(say!("expected {}", natural.symbol))
                        .help(say!("the units of the columns determine those of the coefficients; leave it out")),
                );
            }
        }
        if let Some(start) = &table.start {
            let message = say!("a polynomial needs no start values");
            self.report(
                Fault::new(MODIFIER, start.key.clone(), message)
                    .label(say!("no meaning here"))
                    .help(say!("leave it out")),
            );
        }
        Some(())
    }
}

impl Between<'_> {
    /// Exponent of the first term.
    fn lowest(&self) -> usize {
        usize::from(!self.polynomial.intercept)
    }

    /// Unit of the coefficient of a power: that of the response over that of the power.
    fn unit(&self, power: usize) -> Option<Unit> {
        let columns = self.fit.columns;
        let (x, y) = (&columns[self.predictor].unit, &columns[self.response].unit);
        let natural = match power {
            0 => y.clone(),
            1 => y.quotient(x),
            _ => y.quotient(&x.powr(i32::try_from(power).ok()?, 1)?),
        };
        let plain = natural == Unit::one().quotient(&Unit::one());
        Some(if plain { Unit::one() } else { natural })
    }

    /// A list of parameters of another length, or a polynomial without any.
    fn wrong_count(&self, degree: &Stated<u64>) -> Option<Fault> {
        let count = self.polynomial.parameters();
        let listed = self.fit.declared().map(<[_]>::len);
        let wrong = listed.filter(|found| *found != count);
        if count > 0 && wrong.is_none() {
            return None;
        }
        let parameters = self.fit.stated.value.parameters.as_ref();
        let place = parameters.map_or(degree.span.clone(), |stated| stated.span.clone());
        let with = if self.polynomial.intercept {
            say!("with")
        } else {
            say!("without")
        };
        let message = say!(
            "{} parameters for a polynomial of degree {} {with} constant term",
            wrong.unwrap_or(count),
            degree.value,
        );
        Some(Fault::new(FIT, place, message).label(say!("expected {} parameters", count.max(1))))
    }

    /// In printed form.
    fn equation(&self, parameters: &[Parameter]) -> String {
        let columns = self.fit.columns;
        let (x, y) = (columns[self.predictor].name, columns[self.response].name);
        let terms: Vec<String> = parameters
            .iter()
            .enumerate()
            .map(|(place, parameter)| match place + self.lowest() {
                0 => parameter.name.clone(),
                1 => format!("{} * {x}", parameter.name),
                power => format!("{} * {x}^{power}", parameter.name),
            })
            .collect();
        format!("{y} = {}", terms.join(" + "))
    }
}

fn too_high(degree: &Stated<u64>) -> Fault {
    let message = say!("a polynomial of degree {}", degree.value);
    Fault::new(FIT, degree.span.clone(), message).label(say!("expected {HIGHEST} at most"))
}

fn idle_column(fit: &Scope<'_>, idle: usize) -> Fault {
    let column = &fit.columns[idle];
    let message = say!("the polynomial does not use the column {}", column.name);
    Fault::new(UNUSED, column.key.clone(), message)
        .label(say!("not used"))
        .help(say!("remove it"))
}

fn missing_side(fit: &Scope<'_>, key: &str) -> Fault {
    let known: Vec<&str> = fit.columns.iter().map(|column| column.name).collect();
    let message = say!("the polynomial of the fit {} has no `{key}`", fit.name);
    Fault::new(MISSING_KEY, fit.stated.key.clone(), message)
        .label(say!("`{key}` is missing"))
        .help(say!("write {key} = \"…\" with one of {}", known.join(", ")))
}
