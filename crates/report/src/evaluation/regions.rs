//! Pictures of joint coverage regions (JCGM 102): ellipses of both methods, and the intervals that hold together.

use gumption_fault::say;
use gumption_format::document::{Axis, Layer, Marks, Panel, Plot, Tone};
use nalgebra::{DMatrix, Matrix2, Vector2};

use crate::number::probability;
use crate::{Report, symbol};

/// Pairs of measurands that have pictures.
const MOST_PAIRS: usize = 3;
/// Points of an ellipse.
const POINTS: i32 = 120;

/// A picture of each of the first pairs of measurands.
pub(super) fn plots(report: &Report<'_>) -> Vec<Plot> {
    let defined = report.evaluation.joint.as_ref();
    if !defined.is_some_and(|joint| !joint.degenerate && joint.k_ellipsoid.is_finite()) {
        return Vec::new();
    }
    let count = report.evaluation.results.len();
    let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
    let plots = pairs.take(MOST_PAIRS).filter_map(|pair| {
        let panel = panel(report, pair)?;
        let names = pair.map(|m| report.measurand(m).0).join("_");
        let row = report.label.unwrap_or_default();
        let id = format!("region_{names}_{row}");
        Some(Plot::new(id.trim_end_matches('_'), vec![panel]))
    });
    plots.collect()
}

fn panel(report: &Report<'_>, [a, b]: [usize; 2]) -> Option<Panel> {
    let l = report.language;
    let joint = report.evaluation.joint.as_ref()?;
    let results = [a, b].map(|m| &report.evaluation.results[m]);
    let centre = Vector2::from(results.map(|result| result.gum.estimate));
    let by_gum = ellipse(centre, &joint.covariance, [a, b], joint.k_ellipsoid)?;
    let half = results.map(|result| joint.k_rectangle * result.gum.u);
    let corners = [
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [-1.0, -1.0],
    ];
    let corners = corners.map(|[x, y]| [centre.x + x * half[0], centre.y + y * half[1]]);
    let together = l.pick("intervals that hold together", "同时成立的区间");
    let mut layers: Vec<Layer> = vec![Layer::new(
        together,
        Tone::Quiet,
        Marks::Line(corners.to_vec()),
    )];
    layers.push(Layer::new(
        l.pick("GUM", "GUM 法"),
        Tone::Contrast,
        Marks::Line(by_gum),
    ));
    let means = results.map(|result| result.monte_carlo.as_ref()?.estimate);
    if let ([Some(x), Some(y)], Some(matrix), Some(regions)) = (
        means,
        joint.monte_carlo_covariance.as_ref(),
        joint.regions.as_ref(),
    ) {
        let region = ellipse(Vector2::new(x, y), matrix, [a, b], regions.k_ellipsoid)?;
        let name = l.pick("Monte Carlo", "蒙特卡洛法");
        layers.push(Layer::new(name, Tone::Main, Marks::Line(region)));
    }
    let estimate = vec![[centre.x, centre.y]];
    layers.push(Layer::new("", Tone::Quiet, Marks::Points(estimate)));
    let [(x, x_unit), (y, y_unit)] = [a, b].map(|m| report.measurand(m));
    let p = probability(report.coverage_probability());
    let title = match report.evaluation.results.len() {
        2 => say!("Joint coverage region of {x} and {y}, {p}").in_language(l),
        n => say!("Joint coverage region of all {n} measurands, {p}, seen along {x} and {y}")
            .in_language(l),
    };
    Some(Panel {
        title,
        x: Axis::linear(x, symbol(x_unit)),
        y: Axis::linear(y, symbol(y_unit)),
        layers,
    })
}

/// The edge of an ellipsoid as it is seen along two of its axes: centre + k·L·(cos t, sin t), where L·Lᵀ is the covariance
/// of the two.
fn ellipse(
    centre: Vector2<f64>,
    covariance: &DMatrix<f64>,
    [a, b]: [usize; 2],
    k: f64,
) -> Option<Vec<[f64; 2]>> {
    let of = |row: usize, column: usize| covariance.get((row, column)).copied();
    let block = Matrix2::new(of(a, a)?, of(a, b)?, of(b, a)?, of(b, b)?);
    let root = block.cholesky()?.l();
    let points = (0..=POINTS).map(|n| {
        let t = 2.0 * std::f64::consts::PI * f64::from(n) / f64::from(POINTS);
        let at = centre + k * root * Vector2::new(libm::cos(t), libm::sin(t));
        [at.x, at.y]
    });
    Some(points.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_edge_is_k_away_in_the_metric_of_the_covariance() {
        let covariance = DMatrix::from_row_slice(2, 2, &[4.0, 1.5, 1.5, 1.0]);
        let centre = Vector2::new(10.0, -3.0);
        let edge = ellipse(centre, &covariance, [0, 1], 2.45).expect("an ellipse");
        let inverse = covariance.try_inverse().expect("a regular matrix");
        for [x, y] in edge {
            let away = nalgebra::DVector::from_vec(vec![x - centre.x, y - centre.y]);
            let square = (away.transpose() * &inverse * &away)[0];
            assert!((square.sqrt() - 2.45).abs() < 1e-12);
        }
    }
}
