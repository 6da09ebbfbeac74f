//! Which effects, left out of a model, does a recording show? The statistics of diagnosis: matrices
//! in, findings out. Files, names of quantities and prose are other modules' business.
//!
//! # The space in which everything is decided
//!
//! Residuals r = y − f(θ₀) of n rows, with the Jacobian J of p free parameters and the covariance
//! matrix Σ = LLᵀ, are whitened, W = L⁻¹, and projected on what no change of the parameters can
//! produce: z = P W r, P = I − QQᵀ, WJ = QR. An effect of size β that adds hβ to the output adds
//! Aβ to z, A = P W h. Two numbers decide, before any data are taken: the visible strength
//! λ = |β|·‖A‖ whether the effect is detected, and the separability κ, what is left of λ after the
//! best rival is fitted, whether it is named.
//!
//! Mathematically z lives in m = n − p dimensions; it is kept as a vector of n whose component
//! along Q is zero, which gives the same inner products and costs no basis of the complement.
//!
//! # Words
//!
//! An *atom* is one variant of a candidate; a *block* is an atom as orthonormal directions in the space of z; a
//! *frame* is an orthonormal basis of a set of blocks; a *remainder* is what is left of a block beside a frame; a
//! *ladder* holds the eigenvalues of a smooth discrepancy. A *slot* is an effect that was found, with the
//! candidates that may stand for it; a *generic* is a competitor without a name.
//!
//! # Chapters
//!
//! | chapter | holds |
//! |---|---|
//! | `noise` | covariance matrices of the rows and how well they are known |
//! | `triangular` | the factor of a covariance matrix, and its inverse |
//! | `baseline` | whitening, projection, what the data say of the declared parameters |
//! | `question` | candidates, atoms, settings: what is asked |
//! | `refusal` | the reasons not to answer |
//! | `findings` | verdict, slots, alternatives: what is answered |
//! | `examine` | the examination from end to end |
//! | `closed_form` | Bayes factors |
//! | `directions` | columns as directions: what of them is visible, and which are free beside others |
//! | `space` | atoms as directions in the space of z, and sets of them |
//! | `remainders` | all directions beside a set |
//! | `null` | simulated recordings that the model alone explains |
//! | `departure` | how far the form of an effect may depart from that of the catalogue |
//! | `detection` | the test whether an effect is left |
//! | `contest` | correlated noise as the rival of every effect |
//! | `pairs` | two effects that mask each other, or are noise to each other |
//! | `search` | the set of effects that explains a recording |
//! | `slots` | which candidates could stand for each effect |
//! | `grades` | whether a name is more than a likeness |
//! | `choice` | what sizes owe to the choice between explanations of the others |
//! | `sequential` | simulated tests that end when they are settled |
//! | `selection` | what sizes owe to having been found |
//! | `fit` | estimates, strength, distance to rivals |
//! | `look_alikes` | effects that are the shape of another, aliases, mixtures |
//! | `unlisted` | effects outside the catalogue that look like what is in it |
//! | `tails` | errors with heavier tails than normal ones |
//! | `unsteady` | whether what is taken for noise is as noise is |
//! | `locate` | where the mismatch sits |
//! | `plan` | without data: what an experiment can see and tell apart |
//! | `separate` | which extra measurement tells rivals apart |
//! | `against` | what speaks against candidates that the answer does not name |
//! | `outputs` | what the rows of one output show by themselves |
//! | `omitted` | what effects that are not adopted do to the uncertainty |

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "negated comparisons turn NaN away"
)]

mod against;
mod baseline;
mod choice;
mod closed_form;
mod contest;
mod departure;
mod detection;
mod directions;
mod examine;
mod findings;
mod fit;
#[cfg(test)]
pub(super) mod fixture;
mod grades;
mod locate;
mod look_alikes;
mod noise;
mod null;
mod omitted;
mod outputs;
mod pairs;
mod plan;
mod question;
mod refusal;
mod remainders;
mod search;
mod selection;
mod separate;
mod sequential;
mod slots;
mod space;
mod tails;
mod triangular;
mod unlisted;
mod unsteady;

pub use against::{Against, Beside, Instead, against};
pub use baseline::{Baseline, Prior, Spread};
pub use closed_form::{log_sum, maximum};
pub use contest::{Contest, Course, contest};
pub use departure::LIKENESS;
pub use directions::{
    TRACE, all, determined, inverse, left, left_beside, over_noise, side_by_side, span,
};
pub(super) use directions::{orthonormal, without};
pub use examine::examine;
pub use findings::{
    Alternative, COVERAGE, Examination, Fitted, Level, Rival, Slot, State, Variant, Verdict,
};
pub use fit::singles;
pub use grades::{Likeness, Nature, is_severe, likeness};
pub use locate::{Cell, Located, locate};
pub use noise::{Correlation, Covariance, Noise};
pub use omitted::{narrowed, omitted};
pub use outputs::shrunk;
pub use plan::{Pair, Plan, Seen, visibility};
pub use question::{Atom, Candidate, Chance, Kind, Place, Question, Settings, Shape};
pub use refusal::Refusal;
pub use separate::{SEPARATED, Separability, Standing, Worth, apart, doubt};
pub use tails::Tails;
pub use unsteady::unsteadiness;
