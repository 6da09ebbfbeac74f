//! Units: names, prefixes, conversion.

use super::Dimension;

/// Ratio of a unit to the coherent SI unit: `numerator / denominator · 10^ten · π^pi`, kept apart so
/// that ratios between units are exact in double precision wherever they can be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factor {
    pub numerator: f64,
    pub denominator: f64,
    pub ten: i32,
    pub pi: i32,
}

/// A unit of measurement.
///
/// A temperature scale with an origin (°C) is a *point* unit: `origin` holds its zero in kelvin.
/// Differences of point quantities are in K.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    pub dimension: Dimension,
    pub factor: Factor,
    pub origin: Option<f64>,
    /// As it is to be printed, e.g. `mA/V`, `°/s`, `1`.
    pub symbol: String,
}

/// The units known to a file: the built-in ones and those of its `[unit]` table.
#[derive(Debug, Clone, Default)]
pub struct UnitTable;

/// Why a unit text was refused.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitError {
    /// Bytes of the unit text.
    pub span: std::ops::Range<usize>,
    pub message: String,
    pub help: Option<String>,
}
