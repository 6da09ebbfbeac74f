//! What an adopted effect has beside sizes: a time constant, a knee, a width, a period; and how well the recording knows it.
//!
//! Shapes are found on a grid that closes in, and the adopted model is fitted with them in place. What is not known of them is
//! not known of the sizes and the parameters either. With D the slopes of the observations by the shapes, at the sizes that were
//! found, s the standard deviations of uniform distributions over the values that were tried, and A what the noise and the unknowns
//! leave of D·s, the shapes have the covariance matrix C = s(I + AᵀA)⁻¹s, and the unknowns have G·C·Gᵀ beside that of the fit,
//! G = ∂unknowns/∂shapes (JCGM 102, 6.2.1, with the shapes as further input quantities).

use nalgebra::{DMatrix, DVector};

use super::adopt::{Extended, Free};
use super::candidates::{Candidates, baseline};
use super::catalogue::{Node, ShapeParameter, Variation};
use super::confirm::{Estimated, degrees, scale};
use super::design::Design;
use super::evidence;
use super::fit::Fit;
use super::noise::Claimed;

/// A shape of an adopted effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The index of the effect among the adopted ones.
    pub effect: usize,
    /// Its value, under the symbol that it has in formulas.
    pub estimated: Estimated,
}

/// The shapes of the adopted effects.
#[derive(Debug, Clone, Default)]
pub struct Shapes {
    /// Of those effects that have one.
    pub all: Vec<Shape>,
    /// What they add to the covariance matrix of the unknowns, in the order of these; nothing where no effect has a shape.
    beside: Option<DMatrix<f64>>,
}

/// A shape as it was found, with its slopes.
struct Slope {
    effect: usize,
    shape: ShapeParameter,
    /// Of the observations.
    slope: DVector<f64>,
    /// Standard deviation of the values that were tried.
    tried: f64,
}

/// The shapes of the effects that were adopted as these atoms, and are fitted.
pub(super) fn shapes(
    candidates: &Candidates<'_>,
    atoms: &[usize],
    extended: &Extended,
    (design, fit): (&Design<'_>, &Fit),
    claimed: &Claimed,
) -> Shapes {
    let sizes = |effect: usize| -> Vec<f64> {
        let own = extended.additions.iter().filter(|one| one.effect == effect);
        own.filter_map(|one| Some(fit.unknowns[design.named(&one.parameter)?]))
            .collect()
    };
    let effects = atoms.iter().zip(&extended.effects).enumerate();
    let slopes = effects.filter_map(|(effect, (atom, free))| {
        slope(candidates, *atom, effect, free, &sizes(effect))
    });
    let slopes: Vec<Slope> = slopes
        .filter(|one| one.slope.len() == design.observations())
        .collect();
    let (false, Ok(beside)) = (slopes.is_empty(), baseline(design, fit, claimed)) else {
        return Shapes::default();
    };
    let columns: Vec<DVector<f64>> = slopes.iter().map(|one| &one.slope * one.tried).collect();
    let columns = DMatrix::from_columns(&columns);
    let shown = &columns / scale(design, fit, claimed);
    let Some(known) = evidence::narrowed(&beside, &shown) else {
        return Shapes::default();
    };
    let gain = beside.gain(&columns);
    let dof = match claimed.is_estimated() {
        true => degrees(design),
        false => claimed.dof,
    };
    let all = slopes.into_iter().enumerate().map(|(at, one)| Shape {
        effect: one.effect,
        estimated: Estimated {
            name: one.shape.symbol.to_owned(),
            unit: one.shape.unit,
            value: one.shape.value,
            u: one.tried * known[(at, at)].sqrt(),
            dof,
        },
    });
    Shapes {
        all: all.collect(),
        beside: Some(&gain * known * gain.transpose()),
    }
}

impl Shapes {
    /// The covariance matrix of the unknowns with what is not known of the shapes.
    pub(super) fn with(&self, covariance: DMatrix<f64>) -> DMatrix<f64> {
        match &self.beside {
            Some(beside) => covariance + beside,
            None => covariance,
        }
    }

    /// Unknowns of the fit with what is not known of the shapes.
    pub(super) fn widened(&self, mut unknowns: Vec<Estimated>) -> Vec<Estimated> {
        let Some(beside) = &self.beside else {
            return unknowns;
        };
        for (unknown, variance) in unknowns.iter_mut().zip(beside.diagonal().iter()) {
            unknown.u = libm::hypot(unknown.u, variance.max(0.0).sqrt());
        }
        unknowns
    }
}

/// The slopes of the observations by the shape of an effect with these sizes; nothing where it has none, or no other value of it was
/// tried.
fn slope(
    candidates: &Candidates<'_>,
    atom: usize,
    effect: usize,
    free: &Free,
    sizes: &[f64],
) -> Option<Slope> {
    let own = candidates.variation(atom);
    let shape = own.shape.clone().filter(|shape| shape.size.is_none())?;
    let alike = (candidates.cell(atom).variants.iter()).filter(|other| differ_in_shape(own, other));
    let mut tried: Vec<(f64, &Variation)> = alike
        .filter_map(|other| Some((other.shape.as_ref()?.value, other)))
        .collect();
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = tried.partition_point(|(value, _)| *value < shape.value);
    let below = tried[..at].last().copied();
    let above = tried[at..].iter().find(|(value, _)| *value > shape.value);
    let itself = (shape.value, own);
    let (low, high) = (below.unwrap_or(itself), above.copied().unwrap_or(itself));
    let (least, most) = (tried.first()?.0, tried.last()?.0);
    if high.0 <= low.0 {
        return None;
    }
    let [above, below] = [high.1, low.1].map(|one| one.columns(&candidates.fitted));
    let columns = (above - below) / (high.0 - low.0);
    let mut slope = DVector::zeros(columns.nrows());
    for (coefficient, size) in free.coefficients.iter().zip(sizes) {
        slope += columns.column(*coefficient) * *size;
    }
    let tried = (most - least) / 12.0_f64.sqrt();
    let is_known = slope.iter().all(|x| x.is_finite());
    is_known.then_some(Slope {
        effect,
        shape,
        slope,
        tried,
    })
}

/// Whether two variants of a candidate are one but for the value of their shape: the same law on the same quantities.
fn differ_in_shape(one: &Variation, other: &Variation) -> bool {
    let symbol = |variation: &Variation| variation.shape.as_ref().map(|shape| shape.symbol);
    let places = |variation: &Variation| -> Vec<(Node, Option<usize>, bool)> {
        let terms = variation.terms.iter();
        terms
            .map(|term| (term.node, term.response, term.tied))
            .collect()
    };
    symbol(one) == symbol(other)
        && places(one) == places(other)
        && words(&one.label) == words(&other.label)
        && parts_apart(&one.label, &other.label) <= 1
}

/// In how many of their parts labels differ: one of them tells the value of the shape.
fn parts_apart(one: &str, other: &str) -> usize {
    let parts = one.split(", ").zip(other.split(", "));
    parts.filter(|(one, other)| one != other).count()
}

/// What a label says beside figures: "anew in each run", "below" a knee.
fn words(label: &str) -> Vec<&str> {
    let all = label.split(' ');
    all.filter(|word| word.parse::<f64>().is_err()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::catalogue::{Modifier, Term};

    #[test]
    fn shapes_of_another_law_are_no_neighbours() {
        let law = |label: &str, tau: f64| {
            let term = Term::new(Node::Output, Modifier::unnamed(vec![tau]));
            Variation::one(label, term).shaped("τ", tau, "h")
        };
        let own = law("τ = 0.5 h", 0.5);
        assert!(differ_in_shape(&own, &law("τ = 0.6 h", 0.6)));
        assert!(!differ_in_shape(
            &own,
            &law("τ = 0.6 h, anew in each run", 0.6)
        ));
        let bell = |place: f64, w: f64| law(&format!("about {place} V, w = {w} V"), w);
        assert!(differ_in_shape(&bell(3.0, 0.5), &bell(3.0, 1.0)));
        assert!(!differ_in_shape(&bell(3.0, 0.5), &bell(4.0, 1.0)));
        let mut other = law("τ = 0.6 h", 0.6);
        other.terms[0].response = Some(1);
        assert!(!differ_in_shape(&own, &other));
    }
}
