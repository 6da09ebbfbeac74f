//! How far the form of an effect may depart from that of the catalogue: nature does not have its forms to the last digit.
//!
//! An effect of strength λ whose form departs by a share d of itself leaves d·λ, which adds ½(d·λ)² to the logarithm of a
//! likelihood. As much is taken from what is found beside it before that counts against it, in so far as it resembles the
//! effect: a curved drift may be a departure from a straight one, a yearly wave beside it is not.

/// A departure by this share is the effect as listed …
pub(super) const FORM: f64 = 0.1;
/// … and by this share still that effect: something that acts like it.
pub const LIKENESS: f64 = 0.3;

/// What a part of an effect of this strength that its form leaves adds to the logarithm of a likelihood.
pub(super) fn left(share: f64, strength: f64) -> f64 {
    0.5 * (share * strength) * (share * strength)
}
