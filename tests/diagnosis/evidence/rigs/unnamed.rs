//! Competitors without a name: curves over a covariate, Fourier series over an angle, levels of a
//! factor, each on a quantity of the model.

use nalgebra::DMatrix;

use gumption::diagnose::evidence::Shape;

/// Cosines of a curve.
const COSINES: usize = 8;
/// Length over which a curve bends, over the range of its covariate.
const LENGTH: f64 = 0.2;

/// A smooth function of the covariate `along`, times `slope`: the derivative of the output by the
/// quantity of the model that the function disturbs (1 for an offset of the output).
///
/// A process with the squared exponential covariance of a fifth of the range of the covariate, in
/// eight cosines. A covariate that does not vary gives a constant.
pub fn curve(slope: &[f64], along: &[f64]) -> Shape {
    let low = along.iter().copied().fold(f64::INFINITY, f64::min);
    let high = along.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let range = if high > low { high - low } else { 1.0 };
    let pi = std::f64::consts::PI;
    let features = DMatrix::from_fn(along.len(), COSINES + 1, |row, k| {
        let x = (along[row] - low) / range;
        slope[row] * libm::cos(k as f64 * pi * x)
    });
    let spectrum = (0..=COSINES)
        .map(|k| {
            let bend = k as f64 * pi * LENGTH;
            libm::exp(-0.5 * bend * bend).max(1e-3)
        })
        .collect();
    Shape::Smooth { features, spectrum }
}

/// A periodic function of an angle in radians with this many harmonics, times `slope` as in
/// [`curve`]. Harmonic k has the variance 1/k².
pub fn periodic(slope: &[f64], angle: &[f64], harmonics: usize) -> Shape {
    let features = DMatrix::from_fn(angle.len(), 2 * harmonics, |row, column| {
        let phase = (column / 2 + 1) as f64 * angle[row];
        let wave = if column % 2 == 0 {
            libm::sin(phase)
        } else {
            libm::cos(phase)
        };
        slope[row] * wave
    });
    let spectrum = (0..2 * harmonics)
        .map(|column| {
            let k = (column / 2 + 1) as f64;
            1.0 / (k * k)
        })
        .collect();
    Shape::Smooth { features, spectrum }
}

/// A value of its own for each level of a factor, times `slope` as in [`curve`]; `levels`
/// holds a number for each row, from 0.
pub fn levels(slope: &[f64], levels: &[usize]) -> Shape {
    let count = levels.iter().max().map_or(0, |top| top + 1);
    let features = DMatrix::from_fn(levels.len(), count, |row, level| {
        if levels[row] == level {
            slope[row]
        } else {
            0.0
        }
    });
    Shape::Smooth {
        features,
        spectrum: vec![1.0; count],
    }
}
