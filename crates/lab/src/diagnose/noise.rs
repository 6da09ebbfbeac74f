//! What is known about the noise, for every observation.

use std::sync::Arc;

use nalgebra::DVector;

use super::case::{Case, Origin};
use super::design::Design;
use super::evidence::{Correlation, Covariance, Noise, Tails};
use super::fit::{Fit, Weights};
use super::noise_correlation::{Correlated, Memory};
use super::noise_growth::Growth;
use super::noise_labels::ByLabel;
use super::noise_outputs::Together;
use super::noise_rounding::{self, Rounded, Rounding, Unrounded};
use super::reduced::reduced;

/// The noise of the observations.
#[derive(Debug, Clone, PartialEq)]
pub struct Claimed {
    /// Standard uncertainty of every observation.
    pub u: DVector<f64>,
    /// Degrees of freedom with which its scale is known; 0 if it is not.
    pub dof: f64,
    /// Where it comes from.
    pub origin: Origin,
    /// How the observations are correlated; `None` if they are independent.
    pub correlated: Option<Correlated>,
    /// How noise that was estimated, or that replicates show, grows with the reading, for each response;
    /// empty where it is claimed.
    pub growth: Vec<Option<Growth>>,
    /// How estimated noise differs from label to label, for each response; empty where it is claimed.
    pub by_label: Vec<Option<ByLabel>>,
    /// Standard uncertainties as they may be beside `u`, drawn from what the recording leaves open about how
    /// they grow and differ; empty where they do not.
    pub draws: Vec<DVector<f64>>,
    /// Probability that replicates scatter as unevenly from group to group by chance, where it is so small
    /// that the claim does not describe them.
    pub uneven: Option<f64>,
    /// Outputs whose errors in the same row go together, although they count as independent.
    pub together: Option<Together>,
    /// How heavy their tails are, where the size of the noise is estimated.
    pub tails: Tails,
    /// The row that is farthest off, where they are heavy beyond doubt.
    pub farthest: Option<String>,
    /// The rounding of the readings in `u` and `correlated`, where readings of the same input have it in common or the claim is
    /// without it.
    pub rounding: Option<Rounding>,
}

impl Claimed {
    /// Independent errors that do not grow with the reading.
    pub(super) fn plain(u: DVector<f64>, dof: f64, origin: Origin) -> Claimed {
        Claimed {
            u,
            dof,
            origin,
            correlated: None,
            growth: Vec::new(),
            by_label: Vec::new(),
            draws: Vec::new(),
            uneven: None,
            together: None,
            tails: Tails::default(),
            farthest: None,
            rounding: None,
        }
    }

    /// For the examination of a model. Of a constant that the model should give, such as a norm, it is in units of what the model
    /// gives: in units of the constant all is noise that wanders where the scale of the readings goes to zero.
    pub fn noise(&self, design: &Design<'_>, fit: &Fit) -> Noise {
        let tails = &self.tails.draws;
        Noise {
            // Open independently of the rest: a step that meets every pair.
            tails: (0..tails.len())
                .map(|at| tails[(5 * at) % tails.len()])
                .collect(),
            ..self.of_normal_errors(design, fit)
        }
    }

    fn of_normal_errors(&self, design: &Design<'_>, fit: &Fit) -> Noise {
        let own = design.observed_column(|response| {
            let ratios = design.over_constant(&fit.linear, response);
            ratios.unwrap_or_else(|| vec![1.0; design.case.rows])
        });
        let in_own = |u: &DVector<f64>| u.component_mul(&own);
        let Some(correlated) = &self.correlated else {
            let diagonal = |u: &DVector<f64>| Covariance::Diagonal(in_own(u).map(|u| u * u));
            return Noise {
                draws: self.draws.iter().map(diagonal).collect(),
                ..Noise::with_scale_dof(diagonal(&self.u), self.dof)
            };
        };
        let scaled = |correlation: &Arc<Correlation>, u: &DVector<f64>| Covariance::Correlated {
            u: in_own(u),
            correlation: Arc::clone(correlation),
        };
        let draw = |(at, draw): (usize, &Arc<Correlation>)| {
            // The two are open independently of each other: a step that meets every pair.
            let u = self.draws.get((7 * at) % self.draws.len().max(1));
            scaled(draw, u.unwrap_or(&self.u))
        };
        Noise {
            draws: correlated.draws.iter().enumerate().map(draw).collect(),
            ..Noise::with_scale_dof(scaled(&correlated.correlation, &self.u), self.dof)
        }
    }

    /// Logarithm of the probability of its correlation beforehand, and of what its tails add, but for a constant.
    pub fn log_prior(&self) -> f64 {
        let correlated = self.correlated.as_ref();
        correlated.map_or(0.0, |correlated| correlated.log_prior) + self.tails.gain
    }

    /// The same with standard uncertainties that are multiplied, each observation's by its own factor.
    pub(super) fn times(self, factor: impl Fn(usize) -> f64) -> Claimed {
        let times = |u: DVector<f64>| DVector::from_fn(u.len(), |at, _| factor(at) * u[at]);
        Claimed {
            u: times(self.u),
            draws: self.draws.into_iter().map(times).collect(),
            ..self
        }
    }

    /// The same with another correlation, and no doubt about it.
    pub fn with(&self, correlated: Option<Correlated>) -> Claimed {
        Claimed {
            correlated,
            draws: Vec::new(),
            ..self.clone()
        }
    }

    /// The same with the tails that the residuals show.
    pub fn with_tails(self, design: &Design<'_>, fit: &Fit) -> Claimed {
        let plain = Tails::default();
        let normal = Claimed {
            tails: plain,
            farthest: None,
            ..self
        };
        // What comes in jumps and is remembered is no noise; errors of rounding jump, and not far.
        let is_bounded = normal.rounding.is_some();
        if !normal.is_estimated() || normal.wanders() || is_bounded {
            return normal;
        }
        let seen = reduced(design, fit, &normal.noise(design, fit));
        let tails = seen.map(|seen| Tails::of(seen.residuals().as_slice()));
        let tails = tails.unwrap_or_default();
        let far = fit.residuals.component_div(&normal.u).iamax() % design.blocks.len();
        let rows = &design.blocks[far];
        let farthest = (tails.heavy).map(|_| design.called(rows[0], rows[rows.len() - 1]));
        Claimed {
            tails,
            farthest,
            ..normal
        }
    }

    /// The weights of a fit: no correlation.
    pub fn uncorrelated(&self) -> Claimed {
        Claimed {
            correlated: None,
            ..self.clone()
        }
    }

    /// What weights a fit: each observation by itself, and what outputs have in common, beside which an effect in one of them is known
    /// much better. Noise that wanders takes hardly anything from a fit without it.
    pub(super) fn of_fit(&self) -> Claimed {
        match self.in_common() {
            None => self.uncorrelated(),
            Some(correlated) => self.with(Some(Correlated {
                draws: Vec::new(),
                ..correlated.clone()
            })),
        }
    }

    /// The same as weights.
    pub(super) fn weights(&self) -> Weights<'_> {
        Weights {
            u: &self.u,
            correlation: self.in_common().map(|one| one.correlation.as_ref()),
        }
    }

    /// Whether a recording seen with either says the same: where the size of the noise is not claimed, only the ratios of
    /// its standard uncertainties matter.
    pub fn weighs_alike(&self, other: &Claimed) -> bool {
        /// What rounding makes of equal ratios.
        const ROUNDING: f64 = 1e-9;
        if !self.is_estimated() || !other.is_estimated() {
            return self == other;
        }
        let ratio = self.u[0] / other.u[0];
        let mut pairs = self.u.iter().zip(&other.u);
        let is_scaled = |(own, other): (&f64, &f64)| (own / other / ratio - 1.0).abs() < ROUNDING;
        let is_steady = self.draws.is_empty() && other.draws.is_empty();
        is_steady
            && self.tails == other.tails
            && self.correlated == other.correlated
            && pairs.all(is_scaled)
    }

    /// Whether the recording shows that successive rows are correlated.
    pub fn wanders(&self) -> bool {
        let correlated = self.correlated.as_ref();
        correlated.is_some_and(|one| one.memory.fades())
    }

    /// Whether what wanders is the scale.
    pub fn is_of_scale(&self) -> bool {
        let correlated = self.correlated.as_ref();
        correlated.is_some_and(|one| one.memory.is_of_scale())
    }

    /// What outputs have in common in each row, where the recording shows it.
    pub(super) fn in_common(&self) -> Option<&Correlated> {
        let correlated = self.correlated.as_ref();
        correlated.filter(|one| matches!(one.memory, Memory::InCommon { .. }))
    }

    /// Whether it is left open that successive rows are correlated, though the recording does not show it.
    pub fn may_be_correlated(&self) -> bool {
        let correlated = self.correlated.as_ref();
        correlated.is_some_and(|one| matches!(one.memory, Memory::White) && !one.draws.is_empty())
    }

    /// Whether it grows with the reading, or differs from label to label.
    pub(super) fn is_spread_out(&self) -> bool {
        self.growth.iter().any(Option::is_some) || self.by_label.iter().any(Option::is_some)
    }

    /// With the rounding that it may be without, where a test of all readings at the level `alpha` would show that it is.
    pub(super) fn with_rounding(
        &self,
        design: &Design<'_>,
        fit: &Fit,
        alpha: f64,
    ) -> Option<Claimed> {
        if self.is_estimated() || self.rounding.is_some() {
            return None;
        }
        let rounded = noise_rounding::possible(design, fit, self.before_rounding(), alpha)?;
        Some(self.clone().rounded(Some(rounded)))
    }

    /// What is claimed about other readings of the same instrument, with the rounding that was found in some.
    pub(super) fn rounded_like(self, design: &Design<'_>, fit: &Fit, found: &Claimed) -> Claimed {
        let found = found.rounding.as_ref().filter(|found| !found.is_stated);
        let rounded = found.map(|found| {
            let rounding = Rounding {
                without: self.before_rounding(),
                ..found.clone()
            };
            noise_rounding::beside(design, fit, rounding)
        });
        self.rounded(rounded)
    }

    pub(super) fn before_rounding(&self) -> Unrounded {
        Unrounded {
            u: self.u.clone(),
            correlated: self.correlated.clone(),
        }
    }

    pub(super) fn rounded(self, rounded: Option<Rounded>) -> Claimed {
        let Some(rounded) = rounded else { return self };
        Claimed {
            u: rounded.u,
            correlated: rounded.correlated,
            rounding: Some(rounded.rounding),
            draws: Vec::new(),
            ..self
        }
    }

    /// Whether the rounding of this output is a part of it.
    pub(super) fn rounds(&self, case: &Case, output: &str) -> bool {
        let steps = self.rounding.iter().flat_map(|rounding| &rounding.steps);
        let mut responses = case.responses.iter().zip(steps);
        responses.any(|(response, step)| response.name == output && step.is_some())
    }

    /// Whether there is none but the rounding of numbers in the computer.
    pub fn is_of_arithmetic(&self) -> bool {
        self.origin == Origin::Arithmetic
    }

    /// Whether the size of the noise follows from the residuals alone.
    pub fn is_estimated(&self) -> bool {
        self.dof == 0.0
    }
}
