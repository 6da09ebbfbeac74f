//! Measurement equations over rows of data: `U = K*omega*(1 + e_rate) + b`.
//!
//! An equation has a response on its left, the name of something that was observed, and on its right the
//! formula for it: quantities that vary from row to row, parameters, errors of references, constants. They
//! are texts of the model language; compiled, each gives its value and its derivatives by every symbol at
//! any row. What a symbol stands for is the business of whoever fills the vector of values.
//!
//! ```
//! use gumption_core::equations::{EquationText, Equations, Quantity};
//! use gumption_core::quantity::UnitTable;
//!
//! let units = UnitTable::default();
//! let quantity = |name: &str, unit: &str| {
//!     let unit = units.parse(unit).map_err(|error| error.message.to_string())?;
//!     Ok::<_, String>(Quantity { name: name.into(), unit })
//! };
//! let symbols = [quantity("omega", "deg/s")?, quantity("K", "mV/(deg/s)")?, quantity("b", "mV")?];
//! let responses = [quantity("U", "mV")?];
//! let text = EquationText { text: "U = K * omega + b", at: 0..0 };
//! let equations = Equations::compile(&[text], &symbols, &responses, &[], &units)
//!     .map_err(|faults| faults[0].message.to_string())?;
//! let mut slopes = [0.0; 3];
//! assert_eq!(equations.at(0, &[10.0, 2.0, 0.5], &mut slopes), 20.5);
//! assert_eq!(slopes, [2.0, 10.0, 1.0]);
//! # Ok::<(), String>(())
//! ```

pub mod faults;

use std::ops::Range;

use crate::model::faults::{LEFT_SIDE, Wording};
use crate::model::{
    self, MeasurandSource, Model, ModelFault, Place, Request, Role, Symbol, compile, outline,
};
use crate::quantity::{Unit, UnitTable};
use gumption_fault::{Fault, nearest, say};
use smol_str::format_smolstr;

use faults::{NO_RESPONSE, TWO_EQUATIONS};

/// What a symbol is.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// As the equations call it.
    pub name: String,
    /// Unit of its numbers.
    pub unit: Unit,
}

/// An equation, or statements that several share, and the place in the user's file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EquationText<'a> {
    /// The text.
    pub text: &'a str,
    /// Its place in the user's file, with or without the quotes around it.
    pub at: Range<usize>,
}

/// Compiled equations, in the order of their texts.
#[derive(Debug, Clone)]
pub struct Equations {
    equations: Vec<Equation>,
    responses: Vec<Quantity>,
    symbols: usize,
    shared: String,
}

/// One compiled equation.
#[derive(Debug, Clone)]
struct Equation {
    model: Model,
    uses: Vec<usize>,
    text: String,
}

impl Equations {
    /// Compiles equations over `symbols`, whose order is that of the vector that [`Equations::at`] takes.
    /// The left sides are names of `responses`, each at most once; their unit is that of the response.
    ///
    /// # Errors
    /// All faults of all texts, with their places in the file.
    pub fn compile(
        texts: &[EquationText<'_>],
        symbols: &[Quantity],
        responses: &[Quantity],
        constants: &[Symbol],
        units: &UnitTable,
    ) -> Result<Equations, Vec<Fault>> {
        Equations::compile_after(None, texts, symbols, responses, constants, units)
    }

    /// As [`Equations::compile`], with statements before the equations that all of them see: intermediate
    /// quantities and functions.
    ///
    /// # Errors
    /// All faults of all texts, with their places in the file.
    pub fn compile_after(
        shared: Option<&EquationText<'_>>,
        texts: &[EquationText<'_>],
        symbols: &[Quantity],
        responses: &[Quantity],
        constants: &[Symbol],
        units: &UnitTable,
    ) -> Result<Equations, Vec<Fault>> {
        let all: Vec<Symbol> = constants.iter().cloned().chain(inputs(symbols)).collect();
        let mut faults = Vec::new();
        let mut compiled = Equations {
            equations: Vec::new(),
            responses: Vec::new(),
            symbols: symbols.len(),
            shared: shared.map_or_else(String::new, |text| printed(text, units)),
        };
        let mut places: Vec<Range<usize>> = Vec::new();
        for text in texts {
            let Some(response) = left_side(text, responses, units, &mut faults) else {
                continue;
            };
            if let Some(first) = compiled.responses.iter().position(|r| r == response) {
                faults.push(
                    Fault::new(
                        TWO_EQUATIONS,
                        text.at.clone(),
                        say!("{} has two equations", response.name),
                    )
                    .label(say!("second equation"))
                    .related(places[first].clone(), say!("first equation"))
                    .help(say!("keep one, or give the second a response of its own")),
                );
                continue;
            }
            match equation(text, response, shared, &all, units) {
                Ok(equation) => {
                    compiled.equations.push(equation);
                    compiled.responses.push(response.clone());
                    places.push(text.at.clone());
                }
                // Faults of shared statements appear once for each equation.
                Err(found) => {
                    let new = found.into_iter().filter(|fault| !faults.contains(fault));
                    let new: Vec<Fault> = new.collect();
                    faults.extend(new);
                }
            }
        }
        if faults.is_empty() {
            Ok(compiled)
        } else {
            Err(faults)
        }
    }

    /// The responses, in the order of the equations.
    pub fn responses(&self) -> &[Quantity] {
        &self.responses
    }

    /// Number of symbols.
    pub fn symbols(&self) -> usize {
        self.symbols
    }

    /// Which symbols an equation uses, ascending.
    pub fn uses(&self, response: usize) -> &[usize] {
        self.equations.get(response).map_or(&[], |one| &one.uses)
    }

    /// The value of an equation, in the unit of its response, at the values of all symbols; writes
    /// ∂f/∂symbol to `slopes`, which has the length of `values`. NaN where it is not defined.
    pub fn at(&self, response: usize, values: &[f64], slopes: &mut [f64]) -> f64 {
        slopes.fill(f64::NAN);
        let Some(equation) = self.equations.get(response) else {
            return f64::NAN;
        };
        if values.len() != self.symbols {
            return f64::NAN;
        }
        equation.model.value_and_slopes(values, slopes)
    }

    /// The value of an equation alone; see [`Equations::at`].
    pub fn value(&self, response: usize, values: &[f64]) -> f64 {
        match self.equations.get(response) {
            Some(equation) if values.len() == self.symbols => equation.model.values(values)[0],
            _ => f64::NAN,
        }
    }

    /// Whether every equation is an affine function of these symbols while the others are held.
    pub fn are_affine_in(&self, symbols: &[usize]) -> bool {
        let affine = |equation: &Equation| equation.model.is_affine_in(symbols);
        self.equations.iter().all(affine)
    }

    /// The power through which alone an equation depends on a symbol, and whether it is in proportion to that.
    pub fn exponent_of(&self, symbol: usize, response: usize) -> Option<(f64, bool)> {
        self.equations.get(response)?.model.exponent_of(symbol, 0)
    }

    /// Printed form of the statements that all equations see; empty where there are none.
    pub fn shared(&self) -> &str {
        &self.shared
    }

    /// Printed form of an equation.
    pub fn text(&self, response: usize) -> &str {
        self.equations.get(response).map_or("", |one| &one.text)
    }
}

fn inputs(symbols: &[Quantity]) -> impl Iterator<Item = Symbol> {
    symbols.iter().enumerate().map(|(place, quantity)| Symbol {
        name: quantity.name.as_str().into(),
        unit: quantity.unit.clone(),
        role: Role::Input(place),
    })
}

/// The response that an equation is for.
fn left_side<'r>(
    text: &EquationText<'_>,
    responses: &'r [Quantity],
    units: &UnitTable,
    faults: &mut Vec<Fault>,
) -> Option<&'r Quantity> {
    let gives = match outline(text.text, units) {
        Ok(outline) => outline.gives,
        Err(found) => {
            faults.extend(found.into_iter().map(|fault| placed(fault, text)));
            return None;
        }
    };
    let known: Vec<&str> = responses.iter().map(|r| r.name.as_str()).collect();
    let Some((name, span)) = gives else {
        faults.push(
            Fault::new(
                LEFT_SIDE,
                text.at.clone(),
                say!("the equation has no left side"),
            )
            .label(say!("expected a response, `=` and the formula for it"))
            .help(say!(
                "write for example \"{} = …\"",
                known.first().unwrap_or(&"U")
            )),
        );
        return None;
    };
    let found = responses.iter().find(|response| response.name == name);
    if found.is_none() {
        let fault = Fault::new(NO_RESPONSE, span, say!("{name} is not observed"))
            .label(say!("not the name of a response"));
        let help = match nearest(&name, known.iter().copied()) {
            Some(near) => say!("did you mean `{near}`?"),
            None => say!("what may stand on the left: {}", known.join(", ")),
        };
        faults.push(placed(fault.help(help), text));
    }
    found
}

fn equation(
    text: &EquationText<'_>,
    response: &Quantity,
    shared: Option<&EquationText<'_>>,
    symbols: &[Symbol],
    units: &UnitTable,
) -> Result<Equation, Vec<Fault>> {
    let own: Vec<Symbol> = symbols
        .iter()
        .filter(|symbol| symbol.name != response.name)
        .cloned()
        .collect();
    let model = compile(&Request {
        symbols: &with_gaps(own, symbols),
        shared: shared.map(|shared| shared.text),
        measurands: &[MeasurandSource {
            name: &response.name,
            model: Some(text.text),
            unit: Some(response.unit.clone()),
        }],
        units,
    })
    .map_err(|faults| {
        let place = |ModelFault { place, fault }| match (place, shared) {
            (Place::Shared, Some(shared)) => placed(fault, shared),
            (Place::Measurand(_), _) => placed(reworded(fault, &response.name), text),
            _ => reworded(fault, &response.name).moved(|_| text.at.clone()),
        };
        faults.into_iter().map(place).collect::<Vec<Fault>>()
    })?;
    let used = model.inputs_of(0);
    Ok(Equation {
        uses: (0..used.len()).filter(|place| used[*place]).collect(),
        text: printed(text, units),
        model,
    })
}

fn printed(text: &EquationText<'_>, units: &UnitTable) -> String {
    outline(text.text, units).map_or_else(|_| text.text.to_owned(), |outline| outline.printed)
}

/// The input vector keeps its length when the response, which its own equation may not use, stands last
/// in it: a nameless symbol takes its place.
fn with_gaps(mut own: Vec<Symbol>, all: &[Symbol]) -> Vec<Symbol> {
    if own.len() < all.len()
        && let Some(missing) = all
            .iter()
            .find(|symbol| !own.iter().any(|o| o.name == symbol.name))
    {
        own.push(Symbol {
            name: format_smolstr!("observed {}", missing.name),
            ..missing.clone()
        });
    }
    own
}

/// A fault of a text at its place in the file.
fn placed(fault: Fault, text: &EquationText<'_>) -> Fault {
    let length = text.text.len();
    let quotes = match text.at.len().checked_sub(length) {
        Some(0) => 0,
        Some(2) => 1,
        // Escapes, or several lines: the whole text is marked.
        _ => return fault.moved(|_| text.at.clone()),
    };
    let start = text.at.start + quotes;
    fault.moved(|span| start + span.start.min(length)..start + span.end.min(length))
}

/// A fault of the model language in the words of equations.
fn reworded(fault: Fault, response: &str) -> Fault {
    let own = Wording {
        measurand: response.into(),
        unit: say!("the unit of {response}"),
        given: say!("a column, parameter, reference or constant"),
        stated: say!("in its own table"),
    };
    model::faults::reworded(fault, &own)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quantity(name: &str, unit: &str) -> Quantity {
        Quantity {
            name: name.into(),
            unit: UnitTable::default().parse(unit).expect("a unit"),
        }
    }

    fn at(text: &str) -> EquationText<'_> {
        EquationText {
            text,
            at: 10..12 + text.len(),
        }
    }

    fn compiled(texts: &[EquationText<'_>]) -> Result<Equations, Vec<Fault>> {
        let symbols = [
            quantity("omega", "deg/s"),
            quantity("K", "mV/(rad/s)"),
            quantity("b", "V"),
            quantity("U", "mV"),
        ];
        let responses = [quantity("U", "mV"), quantity("W", "mV")];
        Equations::compile(texts, &symbols, &responses, &[], &UnitTable::default())
    }

    #[test]
    fn units_are_converted_in_values_and_slopes() {
        let equations = compiled(&[at("U = K*omega + b"), at("W = 2*U")]).expect("good");
        let x = [180.0, 2.0, 0.001, 7.0];
        let mut slopes = [0.0; 4];
        let value = equations.at(0, &x, &mut slopes);
        let pi = std::f64::consts::PI;
        assert!((value - (2.0 * pi + 1.0)).abs() < 1e-12);
        let expected = [2.0 * pi / 180.0, pi, 1000.0, 0.0];
        for (found, expected) in slopes.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{slopes:?}");
        }
        assert_eq!(equations.value(1, &x), 14.0);
        assert_eq!(equations.uses(0), [0, 1, 2]);
        assert_eq!(equations.uses(1), [3]);
        assert!(equations.are_affine_in(&[1, 2]) && !equations.are_affine_in(&[0, 1]));
        assert_eq!(equations.text(1), "W = 2 * U");
    }

    #[test]
    fn faults_have_places_in_the_file() {
        let faults = compiled(&[
            at("V = K*omega"),
            at("U = K*omeg + b"),
            at("W = b"),
            at("W = b"),
        ])
        .expect_err("faults");
        let found: Vec<_> = faults
            .iter()
            .map(|fault| (fault.code.id, fault.span.clone()))
            .collect();
        assert_eq!(found[0], (NO_RESPONSE.id, 11..12));
        assert_eq!(found[1].1, 17..21);
        assert_eq!(found[2].0, TWO_EQUATIONS.id);
        let unequal = compiled(&[at("U = K + b")]).expect_err("a dimension too many");
        assert!(!unequal.is_empty());
        assert!(compiled(&[at("K*omega")]).is_err());
    }

    #[test]
    fn what_is_undefined_is_not_a_number() {
        let equations = compiled(&[at("U = b / (omega / 1 'deg/s')")]).expect("good");
        let mut slopes = [0.0; 4];
        assert!(
            !equations
                .at(0, &[0.0, 1.0, 1.0, 1.0], &mut slopes)
                .is_finite()
        );
        assert!(equations.at(7, &[0.0; 4], &mut slopes).is_nan());
        assert!(equations.at(0, &[0.0; 3], &mut slopes).is_nan());
    }
}
