//! Standard uncertainties from what is known.

use crate::claim::{Relative, Row, Shape, Stated, range_factor};
use crate::units;

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
    /// Whether nothing on the sheet tells its degrees of freedom: neither a figure, nor readings, nor that it is of type B.
    pub fn leaves_freedom_open(&self) -> bool {
        let open = matches!(
            self.stated,
            Stated::Nothing
                | Stated::Standard { dof: None, .. }
                | Stated::Deviation {
                    n: None,
                    pooled: None,
                    ..
                }
        );
        open && self.dof.is_none()
    }

    /// What a stated relative figure is multiplied by to be in the unit of the row.
    pub(crate) fn relative_factor(&self) -> f64 {
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
pub(crate) fn shape_of(stated: &Stated) -> Option<Shape> {
    match stated {
        Stated::Limits { shape, .. } | Stated::FullWidth { shape, .. } => Some(*shape),
        Stated::Step { .. } | Stated::Unequal { .. } => Some(Shape::Rectangular),
        _ => None,
    }
}
