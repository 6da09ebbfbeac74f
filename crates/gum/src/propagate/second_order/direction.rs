//! Directions in the space of the inputs in which one standard coordinate changes.

use super::super::covariance::Covariance;
use crate::budget::{Component, Input};
use gumption_core::distribution::Distribution;

/// Third and fourth standardised moment of a coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::propagate) struct Moments {
    pub third: f64,
    pub fourth: f64,
}

/// Those of the normal distribution.
pub(super) const NORMAL: Moments = Moments {
    third: 0.0,
    fourth: 3.0,
};

/// A unit step of one standard coordinate, in the space of the inputs.
#[derive(Debug, Clone)]
pub(super) struct Direction {
    pub coordinate: usize,
    /// (input, change).
    pub steps: Vec<(usize, f64)>,
    pub moments: Moments,
}

/// Per input the direction that moves it, where each moves one input only.
pub(super) fn movers(directions: &[Direction], inputs: usize) -> Option<Vec<Option<&Direction>>> {
    let mut movers: Vec<Option<&Direction>> = vec![None; inputs];
    for direction in directions {
        let [(input, _)] = direction.steps[..] else {
            return None;
        };
        if movers[input].replace(direction).is_some() {
            return None;
        }
    }
    Some(movers)
}

/// The directions in which one of the marked inputs changes.
pub(super) fn directions(
    covariance: &Covariance,
    inputs: &[Input],
    components: &[Component],
    blocks: &[Option<usize>],
) -> Vec<Direction> {
    let mut steps: Vec<Vec<(usize, f64)>> = vec![Vec::new(); covariance.coordinates()];
    for (place, input) in inputs.iter().enumerate() {
        if blocks[place].is_none() {
            continue;
        }
        let form = covariance.form(input.terms.iter().map(|t| (t.component, t.coefficient)));
        for (coordinate, change) in covariance.standard(&form) {
            if change != 0.0 {
                steps[coordinate].push((place, change));
            }
        }
    }
    let alone = covariance.alone();
    steps
        .into_iter()
        .enumerate()
        .filter(|(_, steps)| !steps.is_empty())
        .map(|(coordinate, steps)| {
            let moments =
                alone[coordinate].map_or(NORMAL, |c| moments(&components[c].distribution));
            Direction {
                coordinate,
                steps,
                moments,
            }
        })
        .collect()
}

/// The moments with which a component enters.
pub(in crate::propagate) fn moments(distribution: &Distribution) -> Moments {
    if matches!(distribution, Distribution::StudentT(_)) {
        return NORMAL;
    }
    let of = |d: &Distribution| {
        let (sd, third, fourth) = (
            d.standard_deviation()?,
            d.third_central_moment()?,
            d.fourth_central_moment()?,
        );
        (sd > 0.0).then(|| Moments {
            third: third / sd.powi(3),
            fourth: fourth / sd.powi(4),
        })
    };
    of(distribution)
        .filter(|m| m.third.is_finite() && m.fourth.is_finite())
        .unwrap_or(NORMAL)
}
