//! What the course of the noise may be beside a fit: white noise, noise that wanders, the rounding of readings; and which of them a
//! recording shows.

use std::sync::Arc;

use nalgebra::DVector;

use super::design::Design;
use super::evidence::{self, Refusal};
use super::fit::Fit;
use super::noise::Claimed;
use super::noise_correlation::Courses;
use super::noise_rounding::{self, Rounded, Rounding};
use super::reduced::reduced;
use gumption_core::special::chi_squared_sf;

/// What the course of the noise may be beside a fit.
pub(super) struct Laws {
    courses: Courses,
    /// Those of the courses that are rounding.
    rounded: Vec<Rounded>,
}

impl Laws {
    /// Whether rounding of the readings may be a part of it: its errors jump from one step to the next.
    pub(super) fn may_jump(&self) -> bool {
        !self.rounded.is_empty()
    }
}

impl Claimed {
    /// What its course may be beside a fit.
    pub(super) fn laws(&self, design: &Design<'_>, fit: &Fit, courses: &Courses) -> Laws {
        let is_open = self.is_estimated() && self.rounding.is_none();
        let rounded = match is_open && noise_rounding::is_compared(design) {
            true => noise_rounding::estimated(design, fit),
            false => Vec::new(),
        };
        let correlated = rounded.iter().filter_map(|one| one.correlated.as_ref());
        let correlations = correlated.map(|one| Arc::clone(&one.correlation));
        Laws {
            courses: courses.or_rounded(correlations),
            rounded,
        }
    }

    /// The recording seen with each law.
    ///
    /// # Errors
    /// When the recording does not determine the parameters.
    pub(super) fn seen_with(
        &self,
        design: &Design<'_>,
        fit: &Fit,
        laws: &Laws,
    ) -> Result<Vec<evidence::Course>, Refusal> {
        let with = |correlated| self.with(correlated).noise(design, fit);
        laws.courses.seen(design, fit, &with)
    }

    /// With the law that has the greatest of these logarithms of the probability, and with the doubt that the others leave.
    pub(super) fn likeliest(&self, laws: &Laws, log_posterior: &[f64]) -> Claimed {
        let correlated = laws.courses.likely(log_posterior);
        let is_chosen = |one: &&Rounded| match (&one.correlated, &correlated) {
            (Some(one), Some(chosen)) => Arc::ptr_eq(&one.correlation, &chosen.correlation),
            _ => false,
        };
        let rounded = laws.rounded.iter().find(is_chosen);
        let rounding = rounded.map(|one| one.rounding.clone());
        let rounding = rounding.or_else(|| self.rounding.clone());
        Claimed {
            correlated,
            rounding,
            ..self.clone()
        }
    }

    /// For each response the probability at most that the recording would be as it is without the rounding in the noise. A claim has
    /// a χ². Where the size is estimated, a ratio of likelihoods exceeds 1/p by chance with a probability of p at most (Markov's
    /// inequality); the likeliest of n laws counts with the n-th part of its likelihood, which is no more than the mean of all.
    pub(super) fn unrounded_by_chance(
        &self,
        design: &Design<'_>,
        fit: &Fit,
        rounding: &Rounding,
    ) -> Vec<f64> {
        let responses = 0..rounding.steps.len();
        if self.is_estimated() {
            let likelihood = |claimed: &Claimed| {
                let seen = reduced(design, fit, &claimed.noise(design, fit)).ok()?;
                Some(seen.log_likelihood() + claimed.log_prior())
            };
            let gained = likelihood(self).zip(likelihood(&self.uncorrelated()));
            let p = gained.map_or(1.0, |(with, without)| libm::exp(without - with));
            return responses.map(|_| p).collect();
        }
        let blocks = design.blocks.len();
        // Responses share the degrees of freedom of all.
        let parameters = design.unknowns.len() as f64 / rounding.steps.len() as f64;
        let p = |response: usize| {
            let own = |of: &DVector<f64>| of.rows(response * blocks, blocks).into_owned();
            let left = own(&fit.residuals).component_div(&own(&rounding.without.u));
            chi_squared_sf(left.norm_squared(), (blocks as f64 - parameters).max(1.0))
        };
        responses.map(p).collect()
    }
}
