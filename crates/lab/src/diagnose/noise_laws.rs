//! What the course of the noise may be beside a fit: white noise, noise that wanders, the rounding of readings; and which of them a
//! recording shows.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::catalogue::signal;
use super::design::Design;
use super::evidence::{self, Correlation, Refusal};
use super::fit::Fit;
use super::noise::Claimed;
use super::noise_correlation::{Correlated, Courses, Memory};
use super::noise_growth::{Quantity, Spread};
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
        let even = self.even(design, fit);
        let with = |correlated: Option<Correlated>| {
            let memory = correlated.as_ref().map(|correlated| correlated.memory);
            let own = match memory.is_some_and(Memory::is_of_scale) {
                true => &even,
                false => self,
            };
            own.with(correlated).noise(design, fit)
        };
        laws.courses.seen(design, fit, &with)
    }

    /// With the law that has the greatest of these logarithms of the probability, and with the doubt that the others leave.
    pub(super) fn likeliest(
        &self,
        design: &Design<'_>,
        fit: &Fit,
        laws: &Laws,
        log_posterior: &[f64],
    ) -> Claimed {
        let Some((best, drawn)) = laws.courses.likely(log_posterior) else {
            return self.uncorrelated();
        };
        let (memory, correlation) = laws.courses.law(best);
        if memory.is_of_scale() {
            return self.taken_for_scale(design, fit, &laws.courses, (best, &drawn));
        }
        let is_chosen = |one: &&Rounded| {
            let own = one.correlated.as_ref();
            own.is_some_and(|own| Arc::ptr_eq(&own.correlation, correlation))
        };
        let rounded = laws.rounded.iter().find(is_chosen);
        let rounding = rounded.map(|one| one.rounding.clone());
        let rounding = rounding.or_else(|| self.rounding.clone());
        let even = self.even(design, fit);
        let relative = even.u.component_div(&self.u);
        let draw = |at: usize| match laws.courses.law(at) {
            (memory, own) if memory.is_of_scale() => multiplied(own, &relative),
            (_, own) => Arc::clone(own),
        };
        let draws = drawn.into_iter().map(draw).collect();
        Claimed {
            correlated: Some(laws.courses.correlated(best, draws)),
            rounding,
            ..self.clone()
        }
    }

    /// With the likeliest of the scales that wander.
    ///
    /// # Errors
    /// When the recording does not determine the parameters.
    pub(super) fn of_scale(
        &self,
        design: &Design<'_>,
        fit: &Fit,
        courses: &Courses,
    ) -> Result<Claimed, Refusal> {
        let laws = Laws {
            courses: courses.of_kind(Memory::is_of_scale),
            rounded: Vec::new(),
        };
        let seen = self.seen_with(design, fit, &laws)?;
        let likely: Vec<f64> = seen.iter().map(evidence::Course::log_posterior).collect();
        Ok(self.likeliest(design, fit, &laws, &likely))
    }

    /// With one of the courses, in which the scale wanders: all noise that grows with the signal is that. Those that are drawn are
    /// relative to it.
    fn taken_for_scale(
        &self,
        design: &Design<'_>,
        fit: &Fit,
        courses: &Courses,
        (best, drawn): (usize, &[usize]),
    ) -> Claimed {
        let even = self.even(design, fit);
        let (memory, correlation) = courses.law(best);
        let factors = correlation.matrix().diagonal().map(f64::sqrt);
        let u = even.u.component_mul(&factors);
        let over_own = factors.map(|factor| 1.0 / factor);
        let draw = |at: &usize| match courses.law(*at) {
            (memory, own) if memory.is_of_scale() => multiplied(own, &over_own),
            (_, own) => multiplied(own, &self.u.component_div(&u)),
        };
        let correlated = Correlated {
            correlation: multiplied(correlation, &over_own),
            ..courses.correlated(best, drawn.iter().map(draw).collect())
        };
        let responses = 0..design.case.responses.len();
        let growth = |response: usize| {
            let signal = design.reduced(&signal(design, fit, response));
            let unit = design.case.responses[response].unit.typeset();
            let mean = even.u[response * design.blocks.len()];
            let spread = Spread::of(memory.share(), &signal);
            Some(spread.growth(Quantity::Signal, mean, unit))
        };
        Claimed {
            correlated: Some(correlated),
            growth: responses.clone().map(growth).collect(),
            by_label: responses.map(|_| None).collect(),
            u,
            ..even
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

/// A matrix with every row and every column multiplied by a factor of its own.
fn multiplied(correlation: &Correlation, factors: &DVector<f64>) -> Arc<Correlation> {
    let matrix = correlation.matrix();
    let element = |i: usize, j: usize| matrix[(i, j)] * factors[i] * factors[j];
    let size = factors.len();
    Arc::new(Correlation::new(DMatrix::from_fn(size, size, element)))
}
