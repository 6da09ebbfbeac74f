//! Correlated noise as the rival of every effect: what wanders through a recording may be either.
//!
//! Each course of the noise (white, forgetting within a time, flickering) has a restricted likelihood of its own, without
//! an effect and with the best one, or the best two where each is noise to the other. The gain, both maximised over the
//! courses, is compared with what recordings have that nothing but noise of the likely courses made: with the same choice of
//! course and effects in each. Where the size of the noise is estimated, errors with heavier tails than normal ones make their share
//! of these recordings: as large as they are likely without an effect, over normal ones with all effects that were found.

use std::sync::Arc;

use gumption_lanes::LANES;

use super::baseline::Baseline;
use super::closed_form::{Scale, maximum};
use super::detection::Panel;
use super::noise::{Covariance, Factor};
use super::null::{Laws, Simulated};
use super::pairs::Singles;
use super::question::{Atom, Candidate, Chance, Question, Settings};
use super::refusal::Refusal;
use super::sequential;
use super::space::{Frame, Space};
use super::tails;
use crate::diagnose::chance::in_proportion;
use crate::diagnose::parallel::side_by_side;

/// Simulated recordings behind the probability, at most: at 1 % its standard error is 0.3 %.
const DRAWS: usize = 1024;
/// Courses from which recordings are simulated, in proportion to their probability.
const COURSES: usize = 16;
/// Logarithm of the odds beyond which a course is out of the question.
const HOPELESS: f64 = 9.0;

/// A recording seen with one course of its noise, and the logarithm of what stands for that course beforehand.
#[derive(Debug, Clone)]
pub struct Course {
    /// The residuals, whitened.
    pub baseline: Baseline,
    /// The covariance matrix as L with Σ = LLᵀ.
    lower: Arc<Factor>,
    /// Logarithm of its probability beforehand.
    pub log_prior: f64,
    /// Whether its errors may have heavier tails than normal ones. Not where the size of the noise is known, and wild readings with it;
    /// nor where rows remember others: what comes in jumps is no noise.
    has_open_tails: bool,
}

/// Courses of the noise with and without an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Contest {
    /// How likely it is that effects gain as much where there is nothing but correlated noise.
    pub chance: Chance,
    /// For each course the logarithm of its probability without an effect, but for a constant …
    pub alone: Vec<f64>,
    /// … and with the best one.
    pub with: Vec<f64>,
}

impl Course {
    /// A course with its covariance matrix.
    ///
    /// # Errors
    /// A matrix that is no covariance matrix.
    pub fn new(
        baseline: Baseline,
        covariance: &Covariance,
        log_prior: f64,
    ) -> Result<Course, Refusal> {
        let lower = Arc::new(Factor::of(covariance)?);
        let is_free = baseline.scale_dof() == 0.0 && matches!(*lower, Factor::Diagonal(_));
        Ok(Course {
            has_open_tails: is_free && tails::are_open(baseline.residuals().as_slice()),
            baseline,
            lower,
            log_prior,
        })
    }

    /// Logarithm of the probability of the course without an effect, but for a constant.
    pub fn log_posterior(&self) -> f64 {
        self.log_prior + self.baseline.log_likelihood()
    }

    /// Whether its errors may have heavier tails than normal ones.
    pub(super) fn has_open_tails(&self) -> bool {
        self.has_open_tails
    }

    /// The course with normal errors, beside an effect that gains so much, and with heavier tails where they are open: degrees of
    /// freedom and the logarithm of the probability.
    fn laws(&self, effect: f64) -> Vec<(&Course, f64, f64)> {
        let whole = self.log_posterior();
        let heavy = tails::laws(self.baseline.residuals().as_slice())
            .skip(1)
            .filter(|_| self.has_open_tails);
        let normal = std::iter::once((f64::INFINITY, effect));
        let laws = normal.chain(heavy);
        laws.map(|(dof, log)| (self, dof, whole + log)).collect()
    }
}

/// One course, with all candidates seen through it.
struct Seen<'c> {
    at: usize,
    course: &'c Course,
    space: Space<'c>,
    /// No effect.
    frame: Frame,
    alone: f64,
    with: f64,
}

/// Whether effects beat correlated noise.
pub fn contest(
    courses: &[Course],
    candidates: &[Candidate],
    atoms: &[Atom],
    settings: &Settings,
    found: f64,
) -> Contest {
    let alone: Vec<f64> = courses.iter().map(Course::log_posterior).collect();
    let top = maximum(&alone);
    let see = |at: usize| {
        let question = Question {
            baseline: &courses[at].baseline,
            candidates,
            atoms,
            settings: settings.clone(),
        };
        let space = Space::new(&question);
        let frame = space.empty();
        let strongest = Panel::new(&space, &frame).observed(&space, 0.0);
        let each = strongest.into_iter().flatten().map(|one| one.statistic);
        let gain = each.fold(0.0, f64::max);
        let two = Singles::new(&space).observed(&space);
        Seen {
            at,
            course: &courses[at],
            alone: alone[at],
            with: alone[at] + gain.max(two).max(0.0),
            space,
            frame,
        }
    };
    let mut with = vec![f64::NEG_INFINITY; courses.len()];
    let likely = likely(&alone, see, &mut with);
    let most = maximum(&with);
    // Which law makes the recordings: that normal errors need effects does not speak for heavy tails.
    let effect = found.max(most - top);
    let laws: Vec<(&Course, f64, f64)> = (courses.iter())
        .flat_map(|course| course.laws(effect))
        .collect();
    let highest = laws
        .iter()
        .map(|law| law.2)
        .fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = laws.iter().map(|law| libm::exp(law.2 - highest)).collect();
    let drawn = in_proportion(&laws, &weights, COURSES).into_iter();
    let (draws, tails): (Vec<Arc<Factor>>, Vec<f64>) = drawn
        .map(|(course, dof, _)| (Arc::clone(&course.lower), *dof))
        .unzip();
    let laws = Laws {
        draws: &draws,
        tails: &tails,
    };
    let benches: Vec<Bench<'_>> = likely.iter().map(|one| Bench::new(one, laws)).collect();
    let observed = most - top;
    Contest {
        chance: chance(&benches, observed, settings),
        alone,
        with,
    }
}

/// The courses that are not out of the question, in their order; of all of them the logarithm of the probability `with` the best effect.
/// Candidates seen through one course take much room: the likeliest come first, so that few others are kept for long.
fn likely<'c>(
    alone: &[f64],
    see: impl Fn(usize) -> Seen<'c> + Sync,
    with: &mut [f64],
) -> Vec<Seen<'c>> {
    /// Courses that are looked at side by side.
    const AT_ONCE: usize = 8;
    let top = maximum(alone);
    let mut order: Vec<usize> = (0..alone.len()).collect();
    order.sort_by(|a, b| alone[*b].total_cmp(&alone[*a]));
    let mut kept: Vec<Seen<'c>> = Vec::new();
    let mut most = f64::NEG_INFINITY;
    for next in order.chunks(AT_ONCE) {
        for one in side_by_side(next.len(), |place| see(next[place])) {
            with[one.at] = one.with;
            most = most.max(one.with);
            kept.push(one);
        }
        kept.retain(|one| one.alone > top - HOPELESS || one.with > most - HOPELESS);
    }
    kept.sort_by_key(|one| one.at);
    kept
}

/// How likely it is that the best effect gains as much in recordings with nothing but noise, the course chosen anew in each.
fn chance(benches: &[Bench<'_>], observed: f64, settings: &Settings) -> Chance {
    let chunks = settings.draws.min(DRAWS).div_ceil(LANES).max(1);
    let mut as_much = 0;
    let (p, draws) = sequential::probability(chunks, settings.alpha, |next| {
        // All courses of one chunk, then those of the next.
        let each = side_by_side(next.len() * benches.len(), |at| {
            benches[at % benches.len()].simulated(next.start + at / benches.len())
        });
        for chunk in each.chunks(benches.len()) {
            let gain = |draw: usize| {
                let [alone, with] = [0, 1].map(|which| {
                    let own = chunk.iter().map(|own| own[draw][which]);
                    own.fold(f64::NEG_INFINITY, f64::max)
                });
                with - alone
            };
            as_much += (0..LANES).filter(|draw| gain(*draw) >= observed).count();
        }
        as_much
    });
    Chance { p, draws }
}

/// A course with recordings to try it on.
struct Bench<'s> {
    seen: &'s Seen<'s>,
    simulated: Simulated<'s>,
    panel: Panel<'s>,
    singles: Singles,
}

impl<'s> Bench<'s> {
    fn new(seen: &'s Seen<'s>, laws: Laws<'s>) -> Bench<'s> {
        let draws = seen.space.question.settings.draws.min(DRAWS);
        Bench {
            seen,
            simulated: Simulated::by(&seen.space, laws, draws),
            panel: Panel::new(&seen.space, &seen.frame),
            singles: Singles::new(&seen.space),
        }
    }

    /// Logarithms of the probability of this course without an effect and with the best one or two, for each recording of
    /// a chunk.
    fn simulated(&self, chunk: usize) -> Vec<[f64; 2]> {
        let recordings = self.simulated.drawn(chunk);
        let gains = self.panel.simulated(&recordings);
        let pairs = self.singles.simulated(&self.seen.space, &recordings);
        let each = recordings.chi_squared().iter().zip(gains).zip(pairs);
        let both = each.map(|((sum, [few, many]), two)| {
            let course = self.seen.course;
            let alone = course.log_prior + course.baseline.log_likelihood_of(*sum);
            [alone, alone + few.max(many).max(two).max(0.0)]
        });
        both.collect()
    }
}

impl Baseline {
    /// Logarithm of the restricted likelihood of the declared model, but for a constant.
    pub fn log_likelihood(&self) -> f64 {
        self.log_likelihood_of(self.chi_squared())
    }

    /// Logarithm of the restricted likelihood, but for a constant, of residuals with this sum of squares: the parameters
    /// are integrated over, and so is the scale of the noise where it is not known.
    fn log_likelihood_of(&self, chi_squared: f64) -> f64 {
        let squares = match Scale::new(self.dof(), self.scale_dof()) {
            Scale::Known => 0.5 * chi_squared,
            Scale::Estimated { total } => {
                let known = self.scale_dof();
                0.5 * total * libm::log((chi_squared + known).max(f64::MIN_POSITIVE))
            }
        };
        self.log_determinant() - squares
    }
}
