//! Noise that remembers: how the errors of rows that follow each other are correlated, judged together with what is
//! found.
//!
//! The family is white noise beside a process that forgets within a time constant (autoregressive of the first order; with
//! the longest one, the span of the recording, a random walk), or beside such processes over all time constants in equal parts (flicker). All of them
//! have the same standard deviation in every row, so that a stated one stays true. Beforehand white noise is as likely as
//! all others together.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::blocks::{MOST_COMPARED, MOST_IN_COMMON};
use super::catalogue::FittedModel;
use super::catalogue::norm::Norm;
use super::chance::in_proportion;
use super::design::Design;
use super::evidence::{self, Correlation, Noise, Refusal};
use super::fit::Fit;
use super::reduced::reduced;

/// Fewer degrees of freedom cannot tell white from correlated noise.
const LEAST: usize = 8;
/// Matrices that stand for the posterior distribution.
pub(super) const DRAWS: usize = 16;
/// Noise is taken for white unless it is so with less than this probability: what is stated of it has to be true. What is open
/// is in the draws.
const DOUBT: f64 = 0.05;
/// Shares of the variance that is remembered. All of it would make rows of the same moment one; beside a random walk over the
/// whole recording the last leaves white noise of less than the steps of the walk in up to 400 rows.
pub(super) const SHARES: [f64; 4] = [0.3, 0.6, 0.95, 0.995];
/// Ratio of successive time constants: between two of them no recording tells.
const RATIO: f64 = 3.0;
/// Time constants at most.
const CONSTANTS: usize = 8;

/// How the observations are correlated.
#[derive(Debug, Clone, PartialEq)]
pub struct Correlated {
    /// Correlation matrix of the observations.
    pub correlation: Arc<Correlation>,
    /// Other matrices that the recording allows, as likely as they occur.
    pub draws: Vec<Arc<Correlation>>,
    /// Its law, where it was found in the recording.
    pub memory: Memory,
    /// The unit of its times.
    pub unit: String,
    /// Logarithm of its probability beforehand, but for a constant.
    pub log_prior: f64,
}

impl Correlated {
    /// Which of so many outputs have errors in the same row in common.
    pub fn outputs_in_common(&self, outputs: usize) -> Vec<usize> {
        let matrix = self.correlation.matrix();
        let each = matrix.nrows() / outputs;
        let meets =
            |one: usize, other: usize| one != other && matrix[(one * each, other * each)] != 0.0;
        let meets_any = |one: &usize| (0..outputs).any(|other| meets(*one, other));
        (0..outputs).filter(meets_any).collect()
    }

    /// The mean of the matrices that the recording allows. Variances of estimates are linear in the matrix, so that theirs
    /// are the means of what each law gives.
    pub(super) fn expected(&self) -> DMatrix<f64> {
        match self.draws.split_first() {
            None => self.correlation.matrix().clone(),
            Some((first, others)) => {
                let sum = others
                    .iter()
                    .fold(first.matrix().clone(), |sum, one| sum + one.matrix());
                sum / self.draws.len() as f64
            }
        }
    }
}

/// A law of correlation; times are those of the clock of the case, or rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Memory {
    /// None.
    White,
    /// As a recording at rest or the case say.
    Claimed,
    /// Readings of nearly the same are rounded alike.
    Rounded,
    /// This share of the variance is forgotten within a time constant.
    Fading {
        /// Share of the variance.
        share: f64,
        /// Time constant.
        time_constant: f64,
    },
    /// This share of the variance is forgotten over all times alike.
    Flicker {
        /// Share of the variance.
        share: f64,
    },
    /// This share of the mean variance is of the scale, which is forgotten.
    OfScale {
        /// Share of the mean variance.
        share: f64,
        /// Time constant; `None` where it is forgotten over all times alike.
        time_constant: Option<f64>,
    },
    /// Outputs have this share of the variance in common, row by row.
    InCommon {
        /// Share of the variance.
        share: f64,
    },
}

/// What is as likely beforehand as white noise, all of it together.
#[derive(PartialEq)]
enum Kind {
    White,
    Wandering,
    OfScale,
    Rounding,
    InCommon,
}

/// What the noise of a recording may be.
#[derive(Clone)]
pub(super) struct Courses {
    /// The unit of their times.
    unit: String,
    /// The first is white.
    all: Vec<(Memory, Arc<Correlation>)>,
}

/// Matrices that so many observations have at most: one for each law, and one where there are too many for laws.
pub(super) fn laws(observations: usize) -> usize {
    let in_common = match observations > MOST_IN_COMMON {
        true => 0,
        // Of the outputs that go together, and of all.
        false => 2 * SHARES.len(),
    };
    let remembered = match observations > MOST_COMPARED {
        true => 0,
        // On the response, and on its scale or the readings of a norm.
        false => 2 * SHARES.len() * (CONSTANTS + 1),
    };
    1 + in_common + remembered
}

/// How what wanders through the rows of a recording may be forgotten.
pub(super) struct Wandering {
    /// When the rows were read.
    times: Vec<f64>,
    /// Time constants.
    constants: Vec<f64>,
}

impl Wandering {
    /// For a recording with a time or an order, and rows that tell.
    pub(super) fn of(fitted: &FittedModel<'_>) -> Option<Wandering> {
        let design = fitted.design;
        let count = design.observations();
        let freedom = count.saturating_sub(design.unknowns.len());
        let open = fitted.clock.column.is_some();
        if !open || freedom < LEAST || count > MOST_COMPARED {
            return None;
        }
        let times = design.reduced(&fitted.clock.values);
        let span = fitted.clock.span();
        let interval = span / times.len() as f64;
        (interval > 0.0).then(|| Wandering {
            constants: super::catalogue::modifiers::grid(interval, span, RATIO, CONSTANTS),
            times,
        })
    }

    /// All that are compared.
    pub(super) fn laws(&self) -> Vec<Memory> {
        let fading = self.constants.iter().flat_map(|time_constant| {
            SHARES.map(|share| Memory::Fading {
                share,
                time_constant: *time_constant,
            })
        });
        let flicker = SHARES.map(|share| Memory::Flicker { share });
        fading.chain(flicker).collect()
    }

    /// Rows.
    pub(super) fn rows(&self) -> usize {
        self.times.len()
    }

    /// The part of the variance that a law has in common to two different rows.
    pub(super) fn in_common(&self, law: Memory, i: usize, j: usize) -> f64 {
        law.correlation((self.times[i] - self.times[j]).abs(), &self.constants)
    }
}

impl Courses {
    /// For a recording with a time or an order.
    pub(super) fn of(fitted: &FittedModel<'_>) -> Option<Courses> {
        let wandering = Wandering::of(fitted)?;
        let responses = fitted.design.case.responses.len();
        let matrix = |law: Memory, in_common: Option<&DMatrix<f64>>| {
            let rows = |i: usize, j: usize| match i == j {
                true => 1.0,
                false => {
                    let share = in_common.map_or(1.0, |in_common| in_common[(i, j)]);
                    share * wandering.in_common(law, i, j)
                }
            };
            let size = wandering.rows();
            let own = DMatrix::from_fn(size, size, rows);
            (law, Arc::new(Correlation::new(of_all(&own, responses))))
        };
        // What wanders is the response, or each of the readings of which it is the length.
        let readings = Norm::of(fitted).map(|norm| norm.in_common(fitted));
        let wherever = std::iter::once(None).chain(readings.iter().map(Some));
        let wanders = wandering.laws();
        let each = wherever.flat_map(|own| wanders.iter().map(move |law| (*law, own)));
        let laws = std::iter::once((Memory::White, None)).chain(each);
        Some(Courses {
            unit: fitted.time_unit(),
            all: laws.map(|(law, own)| matrix(law, own)).collect(),
        })
    }

    /// Where no other is asked for.
    pub(super) fn white(observations: usize) -> Courses {
        // Beyond these no other is compared with it.
        let size = match observations > MOST_IN_COMMON {
            true => 0,
            false => observations,
        };
        Courses {
            unit: String::new(),
            all: vec![(
                Memory::White,
                Arc::new(Correlation::new(DMatrix::identity(size, size))),
            )],
        }
    }

    /// Whether rows may remember others.
    pub(super) fn remember(&self) -> bool {
        self.all.iter().any(|(memory, _)| memory.fades())
    }

    /// Whether outputs may have errors in common.
    pub(super) fn are_of_outputs(&self) -> bool {
        let mut all = self.all.iter();
        all.any(|(memory, _)| memory.kind() == Kind::InCommon)
    }

    /// These, and what readings have in common by their rounding.
    pub(super) fn or_rounded(
        &self,
        correlations: impl IntoIterator<Item = Arc<Correlation>>,
    ) -> Courses {
        let mut courses = self.clone();
        let rounded = correlations.into_iter();
        (courses.all).extend(rounded.map(|correlation| (Memory::Rounded, correlation)));
        courses
    }

    /// These, and others.
    pub(super) fn or(mut self, others: Vec<(Memory, Arc<Correlation>)>) -> Courses {
        self.all.extend(others);
        self
    }

    /// Those of some laws.
    pub(super) fn of_kind(&self, is_kind: impl Fn(Memory) -> bool) -> Courses {
        let all = self.all.iter().filter(|(memory, _)| is_kind(*memory));
        Courses {
            unit: self.unit.clone(),
            all: all.cloned().collect(),
        }
    }

    /// A recording seen with each of them, as the noise with such a correlation; `fit` is of any model with the same rows.
    ///
    /// # Errors
    /// When the recording does not determine the parameters.
    pub(super) fn seen(
        &self,
        design: &Design<'_>,
        fit: &Fit,
        noise_with: &dyn Fn(Option<Correlated>) -> Noise,
    ) -> Result<Vec<evidence::Course>, Refusal> {
        let course = |(at, (law, _)): (usize, &(Memory, Arc<Correlation>))| {
            let correlated = (*law != Memory::White).then(|| self.correlated(at, Vec::new()));
            let noise = noise_with(correlated);
            let baseline = reduced(design, fit, &noise)?;
            evidence::Course::new(baseline, &noise.covariance, self.log_prior(at))
        };
        self.all.iter().enumerate().map(course).collect()
    }

    /// With these logarithms of the probability of each course the one that is taken for the noise, and those that stand for what is
    /// open; `None` where it is white without doubt.
    pub(super) fn likely(&self, log_posterior: &[f64]) -> Option<(usize, Vec<usize>)> {
        let top = log_posterior
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = (log_posterior.iter()).map(|l| libm::exp(l - top)).collect();
        let places: Vec<usize> = (0..weights.len()).collect();
        let drawn = in_proportion(&places, &weights, DRAWS);
        let is_white = |at: &usize| self.all[*at].0 == Memory::White;
        if drawn.iter().all(|at| is_white(at)) {
            return None;
        }
        let whole: f64 = weights.iter().sum();
        let may_be_white = |at: &usize| is_white(at) && weights[*at] > DOUBT * whole;
        let white = places.iter().copied().find(may_be_white);
        let best = white.or_else(|| weights.iter().position(|weight| *weight >= 1.0))?;
        Some((best, drawn.into_iter().copied().collect()))
    }

    /// The law of one of them, and its matrix.
    pub(super) fn law(&self, at: usize) -> (Memory, &Arc<Correlation>) {
        let (memory, correlation) = &self.all[at];
        (*memory, correlation)
    }

    /// The noise with one of the courses, and with matrices that are as likely as they occur.
    pub(super) fn correlated(&self, at: usize, draws: Vec<Arc<Correlation>>) -> Correlated {
        Correlated {
            correlation: Arc::clone(&self.all[at].1),
            draws,
            memory: self.all[at].0,
            unit: self.unit.clone(),
            log_prior: self.log_prior(at),
        }
    }

    /// White noise is as likely beforehand as all shifts that fade together, as all scales that do, as rounding of readings that
    /// come in steps, and as all that outputs have in common.
    fn log_prior(&self, at: usize) -> f64 {
        let kind = self.all[at].0.kind();
        let is_alike = |(other, _): &&(Memory, Arc<Correlation>)| other.kind() == kind;
        -libm::log(self.all.iter().filter(is_alike).count() as f64)
    }
}

/// The matrix of all observations; responses are independent of each other.
fn of_all(own: &DMatrix<f64>, responses: usize) -> DMatrix<f64> {
    let size = own.nrows();
    let mut whole = DMatrix::zeros(size * responses, size * responses);
    for response in 0..responses {
        let first = response * size;
        whole.view_mut((first, first), (size, size)).copy_from(own);
    }
    whole
}

impl Memory {
    /// Whether rows have in common what is near in time.
    pub fn fades(self) -> bool {
        matches!(self.kind(), Kind::Wandering | Kind::OfScale)
    }

    /// Whether it is the scale that fades.
    pub fn is_of_scale(self) -> bool {
        self.kind() == Kind::OfScale
    }

    fn kind(self) -> Kind {
        match self {
            Memory::White | Memory::Claimed => Kind::White,
            Memory::Fading { .. } | Memory::Flicker { .. } => Kind::Wandering,
            Memory::OfScale { .. } => Kind::OfScale,
            Memory::Rounded => Kind::Rounding,
            Memory::InCommon { .. } => Kind::InCommon,
        }
    }

    /// The part of the variance that is remembered.
    pub(super) fn share(self) -> f64 {
        match self {
            Memory::White | Memory::Claimed | Memory::Rounded => 0.0,
            Memory::Fading { share, .. }
            | Memory::Flicker { share }
            | Memory::OfScale { share, .. }
            | Memory::InCommon { share } => share,
        }
    }

    /// Correlation of two different rows.
    fn correlation(self, apart: f64, constants: &[f64]) -> f64 {
        match self {
            Memory::White
            | Memory::Claimed
            | Memory::Rounded
            | Memory::OfScale { .. }
            | Memory::InCommon { .. } => 0.0,
            Memory::Fading {
                share,
                time_constant,
            } => share * libm::exp(-apart / time_constant),
            Memory::Flicker { share } => {
                let each = constants.iter().map(|t| libm::exp(-apart / t));
                share * each.sum::<f64>() / constants.len() as f64
            }
        }
    }
}
