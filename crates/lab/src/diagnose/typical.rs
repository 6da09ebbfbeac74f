//! Sizes that would not surprise: how far an effect of the catalogue usually shifts the output at most.
//!
//! An effect that a recording cannot show costs uncertainty all the same. Its size is taken as uniformly
//! distributed between −a and a (JCGM 100, 4.3.7), a being the upper end of what the catalogue calls usual,
//! or what the case states below `[diagnosis] typical`.

use nalgebra::{DMatrix, DVector};

use super::case::{Case, Observed};
use super::catalogue::modifiers::{largest, range};
use super::catalogue::{Cell, FittedModel, Node, Usual, Variation};
use gumption_core::quantity::UnitTable;

/// Columns of a variation in units in which each shifts the output by one unit at most.
pub struct Unified {
    /// Observations × coefficients.
    pub columns: DMatrix<f64>,
    /// What a coefficient of one shifts an observation by at most.
    pub peaks: Vec<f64>,
}

/// The columns of a variation; nothing where one is not finite or does nothing.
pub fn unified(mut columns: DMatrix<f64>) -> Option<Unified> {
    let peaks: Vec<f64> = columns.column_iter().map(|column| column.amax()).collect();
    if peaks.is_empty() || !peaks.iter().all(|peak| peak.is_finite() && *peak > 0.0) {
        return None;
    }
    for (mut column, peak) in columns.column_iter_mut().zip(&peaks) {
        column /= *peak;
    }
    Some(Unified { columns, peaks })
}

/// Full scale of each observation: what the case states for the output, else the largest value of the
/// model, for points on a scale of temperature its range.
pub fn full_scales(fitted: &FittedModel<'_>) -> DVector<f64> {
    let case = fitted.case();
    fitted.design.observed_column(|response| {
        let stated = match case.responses[response].observed {
            Observed::Column(column) => case.columns[column].full_scale,
            Observed::Constant(_) => None,
        };
        let values = &fitted.fit.linear.values[response];
        let (least, most) = range(values);
        let own = match case.responses[response].unit.is_point() {
            true => most - least,
            false => largest(values),
        };
        vec![stated.unwrap_or(own); case.rows]
    })
}

/// The largest shift of the output that would not surprise; nothing where nothing is known.
pub fn shift(
    fitted: &FittedModel<'_>,
    cell: &Cell,
    variation: &Variation,
    unified: &Unified,
    full_scales: &DVector<f64>,
) -> Option<f64> {
    let case = fitted.case();
    // A shift by one unit at most, as a share of full scale.
    let share = (0..unified.columns.nrows())
        .filter(|row| full_scales[*row] > 0.0)
        .map(|row| unified.columns.row(row).amax() / full_scales[row])
        .fold(0.0, f64::max);
    let of_share = |wanted: f64| (share > 0.0).then(|| wanted / share);
    let mut stated = case.settings.typical.iter();
    if let Some((_, wanted)) = stated.find(|(id, _)| cell.effect.id.as_str() == id) {
        return of_share(*wanted);
    }
    if let Some(own) = cell.typical {
        return unified.peaks.first().map(|peak| own.abs() * peak);
    }
    match cell.effect.usual.as_ref()? {
        Usual::Share(wanted) => of_share(*wanted),
        Usual::PerKelvin(wanted) => of_share(wanted * excursion(case, &cell.words.x)?),
        Usual::PerSquareKelvin(wanted) => {
            of_share(wanted * excursion(case, &cell.words.x)?.powi(2))
        }
        Usual::Geometric { angle, length } => {
            let Node::Column(column) = variation.terms.first()?.node else {
                return None;
            };
            let unit = &case.columns[column].unit;
            let in_unit = |text: &str, size: f64| {
                let own = UnitTable::default().parse(text).ok()?;
                Some(own.conversion_to(&unit.difference())?.apply(size))
            };
            let size = match unit.is_one() {
                true => *angle,
                false => in_unit("m", *length).or_else(|| in_unit("rad", *angle))?,
            };
            unified.peaks.first().map(|peak| size * peak)
        }
    }
}

/// Half the range of a temperature in K.
fn excursion(case: &Case, column: &str) -> Option<f64> {
    let column = &case.columns[case.column(column)?];
    let numbers = column.numbers()?;
    let kelvin = UnitTable::default().parse("K").ok()?;
    let factor = column.unit.difference().conversion_to(&kelvin)?.apply(1.0);
    let (least, most) = range(numbers);
    Some(0.5 * (most - least) * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_unified_by_their_largest_value() {
        let unified = unified(DMatrix::from_column_slice(2, 1, &[1.0, -4.0])).unwrap();
        assert_eq!(unified.peaks, [4.0]);
        assert_eq!(unified.columns[(1, 0)], -1.0);
        assert!(super::unified(DMatrix::zeros(2, 1)).is_none());
    }
}
