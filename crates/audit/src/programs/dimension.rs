//! Whether the units of a statement hold in its formulas, and those of results that the file leaves open.

use gumption_core::model::{MeasurandSource, Request, Role, Symbol, compile};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::say;

use super::statement::{Equation, Statement};

/// Units of results that a file leaves to its program, beside those of its inputs.
const USUAL: [&str; 30] = [
    "m", "m^2", "m^3", "s", "1/s", "m/s", "m/s^2", "kg", "kg/m^3", "m^3/kg", "N", "N*m", "Pa", "J",
    "W", "W/m^2", "A", "V", "ohm", "S", "F", "H", "T", "Wb", "C", "K", "1/K", "mol", "mol/m^3",
    "Bq",
];

impl Statement {
    /// With units that hold: those of results are found where the file leaves them open; where units do not hold in the
    /// formulas, none is left, and a remark says so.
    pub(super) fn with_units_that_hold(mut self) -> Statement {
        let is_bare = self.inputs.iter().all(|input| input.unit.is_empty())
            && self.results().all(|result| result.unit.is_empty());
        if is_bare {
            return self;
        }
        let units: Option<Vec<(String, String)>> = self
            .results()
            .map(|result| Some((result.name.clone(), self.unit_of(result)?)))
            .collect();
        match units {
            Some(units) => {
                for equation in &mut self.equations {
                    let unit = units.iter().find(|(name, _)| *name == equation.name);
                    if let Some((_, unit)) = unit {
                        equation.unit.clone_from(unit);
                    }
                }
            }
            None => {
                self.inputs.iter_mut().for_each(|input| input.unit.clear());
                self.equations
                    .iter_mut()
                    .for_each(|equation| equation.unit.clear());
                self.remarks.push(
                    say!("The units of the source do not hold in its formulas, which are of numbers: they are left out."),
                );
            }
        }
        self
    }

    fn unit_of(&self, result: &Equation) -> Option<String> {
        let open = result.unit.is_empty();
        let own = [result.unit.clone()];
        let inputs = self.inputs.iter().map(|input| input.unit.clone());
        let usual = USUAL.iter().map(ToString::to_string);
        let found = own.into_iter().chain(inputs.chain(usual).filter(|_| open));
        let mut found = found.filter(|unit| self.holds(result, unit));
        found.next()
    }

    /// Whether a result is in a unit.
    fn holds(&self, result: &Equation, unit: &str) -> bool {
        let parsed = |unit: &str| {
            if unit.is_empty() {
                Some(Unit::one())
            } else {
                crate::units::parse(unit)
            }
        };
        let inputs = self.inputs.iter().enumerate().map(|(i, input)| {
            let (name, role) = (input.name.clone(), Role::Input(i));
            parsed(&input.unit).map(|unit| Symbol {
                name: name.into(),
                unit,
                role,
            })
        });
        let (Some(symbols), Some(unit)) = (inputs.collect::<Option<Vec<_>>>(), parsed(unit)) else {
            return false;
        };
        let formula = self.whole_formula(result);
        let measurand = MeasurandSource {
            name: "result__",
            model: Some(&formula),
            unit: Some(unit),
        };
        let request = Request {
            symbols: &symbols,
            shared: None,
            measurands: &[measurand],
            units: &UnitTable::default(),
        };
        compile(&request).is_ok()
    }
}
