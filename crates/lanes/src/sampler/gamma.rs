//! Gamma and beta variables.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::shapes::{minus_two_ln, normal_pair, square_radius};
use crate::elementary::{exp, ln_normal};
use crate::generator::open_unit;
use crate::{Generator, LANES};

/// `factor`·G + `offset` for gamma variables G of scale 1.
#[inline(always)]
pub(super) fn gammas<S: Simd>(
    simd: S,
    generator: &mut Generator,
    shape: f64,
    [factor, offset]: [f64; 2],
    out: &mut [f64; LANES],
) {
    if shape < 1.0 {
        log_gammas(simd, generator, shape, out);
        for out in out.iter_mut() {
            *out = exp(*out);
        }
    } else {
        accepted_gammas(simd, generator, shape, out);
    }
    for out in out {
        *out = factor.mul_add(*out, offset);
    }
}

/// `factor`·B + `offset` for beta variables B on 0 … 1: x/(x + y) of two gamma variables; with small
/// shapes from their logarithms, because both may be too small for a number.
#[inline(always)]
pub(super) fn betas<S: Simd>(
    simd: S,
    generator: &mut Generator,
    [alpha, beta]: [f64; 2],
    [factor, offset]: [f64; 2],
    out: &mut [f64; LANES],
) {
    let mut other = [0.0; LANES];
    if alpha < 1.0 || beta < 1.0 {
        log_gammas(simd, generator, alpha, out);
        log_gammas(simd, generator, beta, &mut other);
        for (out, y) in out.iter_mut().zip(other) {
            *out = factor.mul_add(1.0 / (1.0 + exp(y - *out)), offset);
        }
    } else {
        accepted_gammas(simd, generator, alpha, out);
        accepted_gammas(simd, generator, beta, &mut other);
        for (out, y) in out.iter_mut().zip(other) {
            *out = factor.mul_add(*out / (*out + y), offset);
        }
    }
}

/// Logarithms of gamma variables of scale 1.
///
/// Below shape 1: G(shape) = G(shape + 1)·u^(1/shape), which may be too small for a number while
/// its logarithm is not.
#[inline(always)]
fn log_gammas<S: Simd>(simd: S, generator: &mut Generator, shape: f64, out: &mut [f64; LANES]) {
    let boosted = shape < 1.0;
    accepted_gammas(
        simd,
        generator,
        if boosted { shape + 1.0 } else { shape },
        out,
    );
    for out in out.iter_mut() {
        *out = ln_normal(*out);
    }
    if boosted {
        let mut ln_u = [0.0; LANES];
        generator.fill_with(
            &mut ln_u,
            #[inline(always)]
            |word| ln_normal(open_unit(word)),
        );
        for (out, ln_u) in out.iter_mut().zip(ln_u) {
            *out += ln_u / shape;
        }
    }
}

/// Lanes that are looked at together.
const ROW: usize = 8;

/// Lanes that are drawn at a time to replace the few rejected ones.
const REFILL: usize = 32;

/// Gamma variables of shape ≥ 1: a whole block of candidates, then small batches until the block
/// is full. Between 95 % (shape 1) and nearly all candidates are accepted.
#[inline(always)]
fn accepted_gammas<S: Simd>(
    simd: S,
    generator: &mut Generator,
    shape: f64,
    out: &mut [f64; LANES],
) {
    let mut accepted = [0.0; LANES + ROW];
    let mut filled = candidates::<S, LANES>(simd, generator, shape, &mut accepted);
    out.copy_from_slice(&accepted[..LANES]);
    while filled < LANES {
        let mut accepted = [0.0; REFILL + ROW];
        let count = candidates::<S, REFILL>(simd, generator, shape, &mut accepted);
        let fitting = count.min(LANES - filled);
        out[filled..filled + fitting].copy_from_slice(&accepted[..fitting]);
        filled += fitting;
    }
}

/// Marsaglia and Tsang, *A simple method for generating gamma variables*, ACM TOMS 26 (2000).
/// Draws N candidates, puts the accepted ones in front, in their order, and returns how many.
#[inline(always)]
fn candidates<S: Simd, const N: usize>(
    simd: S,
    generator: &mut Generator,
    shape: f64,
    out: &mut [f64],
) -> usize {
    let d = shape - 1.0 / 3.0;
    let c = 1.0 / (9.0 * d).sqrt();
    let (mut gamma, mut surplus) = ([0.0; N], [0.0; N]);
    generator.fill_with_pairs(&mut gamma, normal_pair);
    generator.fill_with(&mut surplus, square_radius);
    for (gamma, surplus) in gamma.iter_mut().zip(&mut surplus) {
        let z = *gamma;
        let root = c.mul_add(z, 1.0);
        let v = root * root * root;
        // Twice z²/2 + d(1 − v + ln v) − ln u, which has to be positive.
        let shape = d * (2.0 - 2.0 * v - minus_two_ln(v));
        *surplus += z.mul_add(z, shape);
        *gamma = if root > 0.0 { d * v } else { -1.0 };
    }
    let mut filled = 0;
    for (gamma, surplus) in gamma
        .as_chunks::<ROW>()
        .0
        .iter()
        .zip(surplus.as_chunks::<ROW>().0)
    {
        let [gamma, surplus] = [gamma, surplus].map(|row| f64x8::from_slice(simd, row));
        let zero = f64x8::splat(simd, 0.0);
        let accepted: mask64x8<S> = gamma.simd_gt(zero) & surplus.simd_gt(zero);
        gamma
            .compress(accepted)
            .store_slice(&mut out[filled..filled + ROW]);
        filled += accepted.to_bitmask().count_ones() as usize;
    }
    filled
}
