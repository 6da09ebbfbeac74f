//! The joint result of several measurands.

use super::matrix::matrix;
use gumption_format::machine::Number;
use gumption_format::machine::record;
use gumption_gum::propagate::JointResult;

record! {
    /// Joint result (JCGM 102).
    JointJson {
        /// Covariance matrix, GUM.
        covariance: Vec<Vec<Number>>,
        /// Correlation matrix, GUM.
        correlation: Vec<Vec<Number>>,
        /// Covariance matrix, Monte Carlo.
        monte_carlo_covariance: Option<Vec<Vec<Number>>>,
        /// Correlation matrix, Monte Carlo.
        monte_carlo_correlation: Option<Vec<Vec<Number>>>,
        /// Degrees of freedom of the covariance matrix.
        degrees_of_freedom: Number,
        /// Factor of the elliptical region, GUM.
        ellipsoid_factor: Number,
        /// Factor of the hyper-rectangle, GUM.
        rectangle_factor: Number,
        /// Coverage regions from Monte Carlo.
        regions: Option<RegionsJson>,
        /// Whether a measurand is a linear function of the others.
        degenerate: bool,
    }

    /// Coverage regions from Monte Carlo.
    RegionsJson {
        /// Factor of the ellipsoid.
        ellipsoid_factor: Number,
        /// Factor of the hyper-rectangle.
        rectangle_factor: Number,
        /// Area or volume of the ellipsoid.
        ellipsoid_volume: Number,
        /// Area or volume of the smallest region.
        smallest_volume: Option<Number>,
        /// Cells of the smallest region.
        smallest_cells: Option<u64>,
    }
}

pub(super) fn joint(joint: &JointResult) -> JointJson {
    JointJson {
        covariance: matrix(&joint.covariance),
        correlation: matrix(&joint.correlation),
        monte_carlo_covariance: joint.monte_carlo_covariance.as_ref().map(matrix),
        monte_carlo_correlation: joint.monte_carlo_correlation.as_ref().map(matrix),
        degrees_of_freedom: Number(joint.dof.value()),
        ellipsoid_factor: Number(joint.k_ellipsoid),
        rectangle_factor: Number(joint.k_rectangle),
        regions: joint.regions.as_ref().map(|r| RegionsJson {
            ellipsoid_factor: Number(r.k_ellipsoid),
            rectangle_factor: Number(r.k_rectangle),
            ellipsoid_volume: Number(r.ellipsoid_volume),
            smallest_volume: r.smallest_volume.map(Number),
            smallest_cells: r.smallest_cells.map(|n| n as u64),
        }),
        degenerate: joint.degenerate,
    }
}
