//! Standard uncertainties from what is known.

use crate::claim::{Relative, Row, Shape, Stated};
use crate::units;

/// C(n) of the range method for n = 2 … 9 and the degrees of freedom (JJF 1059.1-2012, table 1).
pub const RANGE: [(f64, f64); 8] = [
    (1.13, 0.9),
    (1.69, 1.8),
    (2.06, 2.7),
    (2.33, 3.6),
    (2.53, 4.5),
    (2.70, 5.3),
    (2.85, 6.0),
    (2.97, 6.8),
];

/// C(n) and ν of the range method; those of 9 beyond the table.
pub fn range_factor(n: f64) -> (f64, f64) {
    let place = (n as usize).clamp(2, 9) - 2;
    RANGE[place]
}

impl Stated {
    /// Standard uncertainty and degrees of freedom, in the unit of what is stated.
    pub fn standard(&self) -> Option<(f64, f64)> {
        let b = |u: f64| Some((u, f64::INFINITY));
        match self {
            Stated::Nothing => None,
            Stated::Certificate { expanded, k, .. } => b(expanded.value / k),
            Stated::Limits {
                half_width, shape, ..
            } => b(half_width.value / shape.divisor()),
            Stated::FullWidth { width, shape } => b(width.value / 2.0 / shape.divisor()),
            Stated::Step { step } => b(step.value / libm::sqrt(12.0)),
            Stated::Unequal { plus, minus } => b((plus.value + minus.value) / libm::sqrt(12.0)),
            Stated::Deviation { s, n, m, pooled } => {
                let dof = pooled.or(n.map(|n| n - 1.0)).unwrap_or(f64::INFINITY);
                Some((s.value / libm::sqrt(*m), dof))
            }
            Stated::Range { range, n, m } => {
                let (c, dof) = range_factor(*n);
                Some((range.value / c / libm::sqrt(*m), dof))
            }
            Stated::Standard { u, dof } => Some((u.value, dof.unwrap_or(f64::INFINITY))),
        }
    }

    /// Whether it is evaluated from readings.
    pub fn is_type_a(&self) -> bool {
        matches!(self, Stated::Deviation { .. } | Stated::Range { .. })
    }
}

impl Row {
    /// What a stated relative figure is multiplied by to be in the unit of the row.
    pub fn relative_factor(&self) -> f64 {
        match (self.relative, &self.value) {
            (Relative::OfValue(fraction), Some(value)) => {
                let to_unit = units::factor(&value.unit, &self.unit);
                fraction * value.value.abs() * to_unit.unwrap_or(1.0)
            }
            (Relative::OfFullScale(fraction, scale), _) => fraction * scale,
            _ => 1.0,
        }
    }
}

/// The factor that the sheet's shape of a row has; for the list of understood rows.
pub fn shape_of(stated: &Stated) -> Option<Shape> {
    match stated {
        Stated::Limits { shape, .. } | Stated::FullWidth { shape, .. } => Some(*shape),
        Stated::Step { .. } | Stated::Unequal { .. } => Some(Shape::Rectangular),
        _ => None,
    }
}
