//! Tests of the model language as its users see it.

mod conversions;
mod derivatives;
mod library;
mod messages;
mod random;
mod values;

use super::{BlockRunner, MeasurandSource, Model, ModelFault, Request, Role, Symbol, compile};
use crate::quantity::{Unit, UnitTable};
use gumption_lanes::{Block, LANES};

pub fn unit(text: &str) -> Unit {
    UnitTable::default()
        .parse(text)
        .unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

/// Scalar inputs `name` or `name:unit`, vectors `name[3]:unit`, separated by spaces.
pub fn symbols(text: &str) -> Vec<Symbol> {
    let mut next = 0;
    let mut out = Vec::new();
    for word in text.split_whitespace() {
        let (name, unit_text) = word.split_once(':').unwrap_or((word, "1"));
        let (name, role) = match name.split_once('[') {
            Some((name, len)) => {
                let len: usize = len.trim_end_matches(']').parse().unwrap();
                next += len;
                (name, Role::InputVector(next - len..next))
            }
            None => {
                next += 1;
                (name, Role::Input(next - 1))
            }
        };
        out.push(Symbol {
            name: name.into(),
            unit: unit(unit_text),
            role,
        });
    }
    out
}

/// One measurand Y with its own model; an empty unit text means none is stated.
pub(super) fn try_model(inputs: &str, model: &str, wanted: &str) -> Result<Model, Vec<ModelFault>> {
    let units = UnitTable::default();
    let symbols = symbols(inputs);
    let unit = (!wanted.is_empty()).then(|| unit(wanted));
    let measurands = [MeasurandSource {
        name: "Y",
        model: Some(model),
        unit,
    }];
    compile(&Request {
        symbols: &symbols,
        shared: None,
        measurands: &measurands,
        units: &units,
    })
}

pub fn model(inputs: &str, text: &str, wanted: &str) -> Model {
    try_model(inputs, text, wanted).unwrap_or_else(|faults| panic!("{text}: {faults:#?}"))
}

/// The value of Y, which scalar evaluation and blocks must agree on.
pub fn value(inputs: &str, text: &str, wanted: &str, x: &[f64]) -> f64 {
    let model = model(inputs, text, wanted);
    let y = model.values(x)[0];
    let blocks: Vec<Block> = x.iter().map(|v| Block([*v; LANES])).collect();
    let mut out = [Block::ZERO];
    BlockRunner::new(&model).run(&blocks, &mut out);
    for lane in [0, LANES - 1] {
        close(out[0].0[lane], y, 1e-13, text);
    }
    y
}

pub fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let fits = (found - expected).abs() <= tolerance * expected.abs().max(1e-3)
        || (found.is_nan() && expected.is_nan());
    assert!(fits, "{what}: {found} instead of {expected}");
}
