//! Margins of a Gaussian copula: the value of a distribution that has the same rank as z among standard normals.

use gumption_core::distribution::{Distribution, Normal};
use gumption_core::special::{normal_cdf, normal_pdf, normal_sf};
use gumption_lanes::quantile::{OfScore, Quantile};
use gumption_lanes::{Block, LANES, Level, level, ops};

/// Mean square deviation of a table, in standard deviations of the margin, at which nothing shows: u is within 10⁻⁶ of
/// itself (Cauchy and Schwarz), which the scatter u/√(2M) of M trials hides up to M = 5·10¹¹.
const TOLERANCE: f64 = 1e-6;

/// From normal scores to values.
#[derive(Debug)]
pub(super) enum Margin {
    /// By a table, where the quantile has no closed form and a table follows it.
    Curve(OfScore),
    /// By the quantile of each number.
    Exact(Distribution),
}

impl Margin {
    pub(super) fn of(distribution: &Distribution) -> Margin {
        match distribution.block_quantile() {
            Some(Quantile::OfScore(curve)) if follows(&curve, distribution) => Margin::Curve(curve),
            _ => Margin::Exact(distribution.clone()),
        }
    }

    /// Replaces normal scores by values.
    pub(super) fn apply(&self, level: Level, block: &mut Block) {
        match self {
            Margin::Curve(OfScore::Normal { mean, sd }) => {
                let scores = *block;
                ops::affine(level, &scores, *sd, *mean, block);
            }
            Margin::Curve(curve) => curve.apply(level, block),
            Margin::Exact(margin) => block.0.iter_mut().for_each(|z| *z = exact(margin, *z)),
        }
    }
}

/// Whether a curve is the quantile between its nodes, too: in the middles of its cells.
fn follows(curve: &OfScore, distribution: &Distribution) -> bool {
    /// Beyond lies a probability of 10⁻¹⁷.
    const REACH: f64 = 8.5;
    let step = 2.0 * REACH / LANES as f64;
    let middles: [f64; LANES] = std::array::from_fn(|i| (i as f64 + 0.5) * step - REACH);
    let mut values = Block(middles);
    curve.apply(level(), &mut values);
    let squares = middles.iter().zip(&values.0).map(|(z, value)| {
        let off = value - exact(distribution, *z);
        off * off * normal_pdf(*z) * step
    });
    let sd = distribution.standard_deviation();
    sd.is_some_and(|sd| squares.sum::<f64>().sqrt() <= TOLERANCE * sd)
}

/// From the nearer tail, where probabilities keep their digits.
fn exact(margin: &Distribution, z: f64) -> f64 {
    match *margin {
        Distribution::Normal(Normal { mean, sd }) => sd.mul_add(z, mean),
        _ if z <= 0.0 => margin.quantile(normal_cdf(z)),
        _ => margin.upper_quantile(normal_sf(z)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::kinds;
    use super::*;
    use gumption_core::distribution::StudentT;
    use gumption_lanes::quantile::Curve;

    /// The nodes of the table are right, and between them a cubic through values and slopes is off by h⁴/384 T⁗, h the
    /// width of a cell; h⁴ T⁗ is the fourth difference of the quantile.
    #[test]
    fn t_is_tabulated_and_right() {
        let h = 17.0 / (Curve::NODES - 1) as f64;
        let mut tabulated = Vec::new();
        for dof in [1.0, 2.0, 2.1, 2.5, 3.0, 3.5, 4.0, 9.0, 60.0] {
            let t = Distribution::StudentT(StudentT {
                location: 5.0,
                scale: 0.1,
                dof,
            });
            if matches!(Margin::of(&t), Margin::Curve(_)) {
                tabulated.push(dof);
            }
            let scores = std::array::from_fn(|i| (i as f64 / LANES as f64 - 0.5) * 9.7);
            let mut values = Block(scores);
            Margin::of(&t).apply(level(), &mut values);
            let fourth = |z: f64| {
                let weights = [1.0, -4.0, 6.0, -4.0, 1.0];
                let at = |i: usize| exact(&t, z + (i as f64 - 2.0) * h);
                (0..5).map(|i| weights[i] * at(i)).sum::<f64>().abs()
            };
            for (z, value) in scores.iter().zip(&values.0) {
                let between = fourth(z - h).max(fourth(z + h)) / 384.0;
                let bound = between + 1e-9 * (0.1 + (exact(&t, *z) - 5.0).abs());
                let error = (value - exact(&t, *z)).abs();
                assert!(error <= bound, "ν = {dof}, z = {z}: {error} {bound}");
            }
        }
        // Means of four readings and more, which are what tables are for.
        assert!(
            tabulated.ends_with(&[3.0, 3.5, 4.0, 9.0, 60.0]),
            "{tabulated:?}"
        );
    }

    /// Every kind is followed to the tolerance, by a table or by itself.
    #[test]
    fn all_kinds_keep_their_moments() {
        for distribution in kinds() {
            let margin = Margin::of(&distribution);
            let (mut mean, mut square) = (0.0, 0.0);
            // 2¹⁶ equal steps of the score.
            let step = 17.0 / 65_536.0;
            for part in 0..256 {
                let place = |i: usize| ((part * LANES + i) as f64 + 0.5) * step - 8.5;
                let mut values = Block(std::array::from_fn(place));
                margin.apply(level(), &mut values);
                for (i, value) in values.0.iter().enumerate() {
                    let weight = normal_pdf(place(i)) * step;
                    mean += weight * value;
                    square += weight * value * value;
                }
            }
            let sd = distribution.standard_deviation().expect("one");
            let expected = distribution.mean().expect("one");
            assert!(
                (mean - expected).abs() < 1e-4 * sd,
                "{distribution:?} {mean}"
            );
            let found = (square - mean * mean).sqrt();
            assert!(
                (found - sd).abs() < 1e-4 * sd,
                "{distribution:?} {found} {sd}"
            );
        }
    }
}
