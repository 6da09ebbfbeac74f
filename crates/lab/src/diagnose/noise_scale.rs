//! A scale that wanders: errors that are remembered, in proportion to the signal.
//!
//! Noise that wanders adds to a row what it adds to its neighbours. A scale that wanders multiplies: where the signal changes its
//! sign the error does, and where there is no signal there is no error. Both are seen with all times after which they may be forgotten
//! and all shares of the variance; a ratio of mean likelihoods exceeds 1/p by chance with a probability of p at most (Markov's
//! inequality).

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::catalogue::FittedModel;
use super::catalogue::norm::Norm;
use super::design::Design;
use super::evidence::{Correlation, Course, Covariance, Noise, Refusal, log_sum};
use super::fit::Fit;
use super::noise::Claimed;
use super::noise_correlation::{Courses, Memory, SHARES, Wandering};
use super::noise_growth::Spread;
use super::reduced::reduced;

/// Rows that have a signal, of which the scale may wander.
pub(super) struct Scales {
    wandering: Wandering,
    /// The signal of each observation over the root mean square of its response.
    relative: DVector<f64>,
}

/// What the errors of the rows may be made of, relative to what they are in the mean.
#[derive(Clone, Copy)]
struct Law<'l> {
    /// How the part that is remembered is forgotten.
    memory: Memory,
    /// Its size in each row.
    remembered: &'l DVector<f64>,
    /// The size of the white part in each row.
    white: &'l DVector<f64>,
}

impl Scales {
    /// `None` where no scale is to be told from a shift. Of a constant, such as a norm, the scale is what is fitted.
    pub(super) fn of(fitted: &FittedModel<'_>) -> Option<Scales> {
        let design = fitted.design;
        let mut responses = 0..design.case.responses.len();
        let is_constant = Norm::of(fitted).is_some() || responses.any(|at| fitted.is_implicit(at));
        let wandering = Wandering::of(fitted).filter(|_| !is_constant && fitted.has_signal())?;
        let signals = design.observed_column(|response| fitted.signal(response).to_vec());
        let levels = design.root_mean_squares(&signals);
        let rows = wandering.rows();
        let is_there = levels.iter().all(|level| *level > 0.0);
        is_there.then(|| Scales {
            relative: DVector::from_fn(signals.len(), |at, _| signals[at] / levels[at / rows]),
            wandering,
        })
    }

    /// All that are compared: covariance over the mean variance of a response.
    pub(super) fn laws(&self) -> Vec<(Memory, Arc<Correlation>)> {
        let one = self.one();
        let laws = self.each(&self.relative, &one).into_iter();
        let of_scale = |law: Law<'_>| {
            let time_constant = match law.memory {
                Memory::Fading { time_constant, .. } => Some(time_constant),
                _ => None,
            };
            let memory = Memory::OfScale {
                share: law.memory.share(),
                time_constant,
            };
            (memory, self.correlation(&law))
        };
        laws.map(of_scale).collect()
    }

    /// Probability at most that estimated errors which neighbours have in common, or which grow with the signal, look as much like one
    /// of these scales that wander as a recording does.
    ///
    /// # Errors
    /// When the recording does not determine the parameters.
    pub(super) fn by_chance(
        &self,
        laws: &[(Memory, Arc<Correlation>)],
        design: &Design<'_>,
        fit: &Fit,
        claimed: &Claimed,
        shifts: &Courses,
    ) -> Result<f64, Refusal> {
        let even = claimed.even(design, fit);
        let mean = |correlations: &[Arc<Correlation>]| {
            let seen = |correlation: &Arc<Correlation>| {
                let covariance = Covariance::Correlated {
                    u: even.u.clone(),
                    correlation: Arc::clone(correlation),
                };
                let noise = Noise::with_scale_dof(covariance, 0.0);
                Ok(reduced(design, fit, &noise)?.log_likelihood())
            };
            let each: Result<Vec<f64>, Refusal> = correlations.iter().map(seen).collect();
            Ok(log_sum(each?.iter().copied()) - libm::log(correlations.len() as f64))
        };
        let seen = even.laws(design, fit, shifts);
        let seen = even.seen_with(design, fit, &seen)?;
        let seen: Vec<f64> = seen.iter().map(Course::log_posterior).collect();
        // Each kind is as likely beforehand as a scale that wanders.
        let mut others = vec![log_sum(seen.into_iter())];
        let grown = claimed.u.component_div(&even.u);
        others.push(mean(&self.independent(&grown))?);
        if claimed.is_spread_out() {
            others.push(mean(&self.beside(&grown))?);
        }
        let scales: Vec<_> = laws.iter().map(|(_, scale)| Arc::clone(scale)).collect();
        Ok(libm::exp(log_sum(others.into_iter()) - mean(&scales)?))
    }

    /// Errors of independent rows that grow with the signal, or as they seem to.
    fn independent(&self, grown: &DVector<f64>) -> Vec<Arc<Correlation>> {
        let growing = SHARES.map(|share| {
            let spread = Spread::of(share, self.relative.as_slice());
            self.relative.map(|signal| spread.at(signal))
        });
        let one = self.one();
        let law = |white| Law {
            memory: Memory::White,
            remembered: &one,
            white,
        };
        let laws = growing.iter().chain([grown]).map(law);
        laws.map(|law| self.correlation(&law)).collect()
    }

    /// Shifts that are remembered, beside errors of independent rows as they seem to grow.
    fn beside(&self, grown: &DVector<f64>) -> Vec<Arc<Correlation>> {
        let one = self.one();
        let laws = self.each(&one, grown).into_iter();
        laws.map(|law| self.correlation(&law)).collect()
    }

    fn one(&self) -> DVector<f64> {
        DVector::from_element(self.relative.len(), 1.0)
    }

    /// Each way of forgetting, with these sizes.
    fn each<'l>(&self, remembered: &'l DVector<f64>, white: &'l DVector<f64>) -> Vec<Law<'l>> {
        let law = |memory: Memory| Law {
            memory,
            remembered,
            white,
        };
        self.wandering.laws().into_iter().map(law).collect()
    }

    /// Covariance of all observations, in which those of different responses are independent.
    fn correlation(&self, law: &Law<'_>) -> Arc<Correlation> {
        let (rows, all) = (self.wandering.rows(), self.relative.len());
        let (remembered, white) = (law.remembered, law.white);
        let share = law.memory.share();
        let matrix = DMatrix::from_fn(all, all, |a, b| match a == b {
            true => share * remembered[a].powi(2) + (1.0 - share) * white[a].powi(2),
            false if a / rows != b / rows => 0.0,
            false => {
                let in_common = (self.wandering).in_common(law.memory, a % rows, b % rows);
                in_common * remembered[a] * remembered[b]
            }
        });
        Arc::new(Correlation::new(matrix))
    }
}
