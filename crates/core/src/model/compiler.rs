//! Compiling the same formulas again: rows of a table replace numbers, of which a compiled model knows nothing.

use super::check::compile;
use super::{MeasurandSource, Model, ModelFault, Request, Role, Symbol};
use crate::quantity::{Unit, UnitTable};

/// Compiles requests, and keeps the last model with what it was made of.
#[derive(Debug, Default)]
pub struct Compiler {
    last: Option<(Source, Model)>,
}

impl Compiler {
    /// As [`compile`]; a request like the last one gets the model of that.
    ///
    /// # Errors
    /// As of [`compile`].
    pub fn compile(&mut self, request: &Request<'_>) -> Result<Model, Vec<ModelFault>> {
        if let Some((source, model)) = &self.last
            && source.is_of(request)
        {
            return Ok(model.clone());
        }
        let model = compile(request)?;
        self.last = Some((Source::of(request), model.clone()));
        Ok(model)
    }
}

/// A request that was compiled.
#[derive(Debug)]
struct Source {
    symbols: Vec<Symbol>,
    shared: Option<String>,
    measurands: Vec<(String, Option<String>, Option<Unit>)>,
    units: UnitTable,
}

impl Source {
    fn of(request: &Request<'_>) -> Source {
        let owned = |one: &MeasurandSource<'_>| {
            (
                one.name.to_owned(),
                one.model.map(str::to_owned),
                one.unit.clone(),
            )
        };
        Source {
            symbols: request.symbols.to_vec(),
            shared: request.shared.map(str::to_owned),
            measurands: request.measurands.iter().map(owned).collect(),
            units: request.units.clone(),
        }
    }

    fn is_of(&self, request: &Request<'_>) -> bool {
        let symbols = self.symbols.iter().zip(request.symbols);
        let measurands = self.measurands.iter().zip(request.measurands);
        self.symbols.len() == request.symbols.len()
            && self.measurands.len() == request.measurands.len()
            && self.shared.as_deref() == request.shared
            && symbols.into_iter().all(|(one, other)| is_same(one, other))
            && measurands.into_iter().all(|((name, model, unit), other)| {
                name == other.name && model.as_deref() == other.model && *unit == other.unit
            })
            && self.units == *request.units
    }
}

/// Whether a model cannot tell two symbols apart. Numbers are compared bit by bit, since they become part of it.
fn is_same(one: &Symbol, other: &Symbol) -> bool {
    let bits = |list: &[f64]| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let roles = match (&one.role, &other.role) {
        (Role::Input(a), Role::Input(b)) => a == b,
        (Role::InputVector(a), Role::InputVector(b)) => a == b,
        (Role::Constant(a), Role::Constant(b)) => a.to_bits() == b.to_bits(),
        (Role::ConstantVector(a), Role::ConstantVector(b)) => bits(a) == bits(b),
        // Another model is not looked into.
        _ => false,
    };
    roles && one.name == other.name && one.unit == other.unit
}

#[cfg(test)]
mod tests {
    use super::*;

    fn symbol(name: &str, role: Role) -> Symbol {
        Symbol {
            name: name.into(),
            unit: Unit::one(),
            role,
        }
    }

    /// The value of `text` where x is 3, compiled by this compiler.
    fn value(compiler: &mut Compiler, text: &str, c: f64) -> f64 {
        let symbols = [symbol("x", Role::Input(0)), symbol("c", Role::Constant(c))];
        let measurands = [MeasurandSource {
            name: "y",
            model: Some(text),
            unit: None,
        }];
        let request = Request {
            symbols: &symbols,
            shared: None,
            measurands: &measurands,
            units: &UnitTable::default(),
        };
        compiler.compile(&request).expect("a model").values(&[3.0])[0]
    }

    #[test]
    fn what_differs_is_compiled_anew() {
        let compiler = &mut Compiler::default();
        assert_eq!(value(compiler, "c * x", 2.0), 6.0);
        assert_eq!(value(compiler, "c * x", 2.0), 6.0);
        assert_eq!(value(compiler, "c * x", 5.0), 15.0);
        assert_eq!(value(compiler, "c + x", 5.0), 8.0);
        assert_eq!(value(compiler, "x / c", 0.0), f64::INFINITY);
        assert_eq!(value(compiler, "x / c", -0.0), f64::NEG_INFINITY);
    }
}
