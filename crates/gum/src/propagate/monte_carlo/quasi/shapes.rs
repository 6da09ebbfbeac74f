//! Quantile functions in the form that blocks of points take.

use std::sync::Arc;

use gumption_lanes::quantile::OfScore;

use gumption_core::distribution::{Gamma, Univariate, score};

/// √(ν/χ²), what makes normal variables a multivariate t (JCGM 102, 5.3.2.4).
pub(super) fn mixing(dof: f64) -> OfScore {
    let half_chi_squared = Gamma {
        origin: 0.0,
        shape: dof / 2.0,
        scale: 1.0,
    };
    let factor = |g: f64| (dof / (2.0 * g)).sqrt();
    let table = score::of_score(
        |p| factor(half_chi_squared.quantile(p)),
        |q| factor(half_chi_squared.upper_quantile(q)),
    );
    OfScore::Tabulated {
        table: Arc::new(table),
        location: 0.0,
        scale: 1.0,
    }
}

#[cfg(test)]
mod tests {
    use gumption_lanes::{Block, LANES, level};

    use super::super::super::samples::kinds;
    use super::*;

    #[test]
    fn quantile_functions_are_those_of_the_distributions() {
        for distribution in kinds() {
            let mut block = Block::ZERO;
            for (i, u) in block.0.iter_mut().enumerate() {
                *u = (i as f64 + 0.5) / LANES as f64;
            }
            // Two numbers far out.
            (block.0[0], block.0[LANES - 1]) = (1e-7, 1.0 - 1e-7);
            let uniform = block;
            distribution
                .block_quantile()
                .unwrap()
                .apply(level(), &mut block);
            let sd = distribution.standard_deviation().unwrap();
            for (u, x) in uniform.0.iter().zip(&block.0) {
                let exact = distribution.quantile(*u);
                let error = (x - exact).abs() / (sd + exact.abs());
                // One part in 10⁴ of so small a probability shows there.
                let allowed = if (1e-3..=0.999).contains(u) {
                    5e-5
                } else {
                    1e-4
                };
                assert!(error < allowed, "{distribution:?} at {u}: {x} {exact}");
            }
        }
    }

    #[test]
    fn the_mixing_variable_has_the_median_of_its_chi_squared() {
        // Median of χ² with 8 degrees of freedom: 7.344121.
        let mut block = Block::ZERO;
        mixing(8.0).apply(level(), &mut block);
        assert!((block.0[0] - (8.0_f64 / 7.344_121).sqrt()).abs() < 1e-6);
    }
}
