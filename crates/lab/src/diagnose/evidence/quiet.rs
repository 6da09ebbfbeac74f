//! How little noise a part of the observations may have, such as those of one response, beside an effect that it alone has.
//!
//! Where noise is estimated, its size in each response is that of what the model leaves of it. An effect on one response then
//! passes for the noise of that one: it is held against itself, while the scale that all share hardly changes.

use std::ops::Range;

use nalgebra::DMatrix;

use super::baseline::Baseline;
use super::directions::{own, visible};
use super::question::{Atom, Kind};

/// The standard deviation that the strongest named effect on these observations alone leaves of theirs, as a part of what it is
/// without: one where it takes no more than the best of as many does by chance.
pub fn quiet(baseline: &Baseline, atoms: &[Atom], part: Range<usize>) -> f64 {
    let z = baseline.residuals();
    let before = z.rows(part.start, part.len()).norm_squared();
    let absorbed = baseline.absorbed();
    let absorbed = absorbed.rows(part.start, part.len()).norm_squared();
    let freedom = part.len() as f64 - absorbed;
    let named = atoms.iter().filter(|atom| atom.shape.kind() == Kind::Named);
    let columns = named.filter_map(|atom| atom.shape.columns());
    let fits: Vec<(f64, usize)> = columns
        .filter_map(|columns| {
            let on_part = DMatrix::from_fn(columns.nrows(), columns.ncols(), |row, at| {
                if part.contains(&row) {
                    columns[(row, at)]
                } else {
                    0.0
                }
            });
            let (seen, lengths) = visible(baseline, &on_part);
            let (basis, kept) = own(seen, lengths);
            (!kept.is_empty()).then(|| (basis.tr_mul(z).norm_squared(), kept.len()))
        })
        .collect();
    // The greatest of m squares of normal numbers is 2 ln m (Fisher, Tippett).
    let by_chance = 2.0 * libm::log(fits.len().max(1) as f64);
    let left = fits.iter().map(|(fit, sizes)| {
        let free = freedom - *sizes as f64 - by_chance;
        if free >= 1.0 {
            (before - fit).max(0.0) / free
        } else {
            f64::INFINITY
        }
    });
    let least = left.fold(f64::INFINITY, f64::min);
    (least * freedom / before).sqrt().min(1.0)
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::super::baseline::Prior;
    use super::super::fixture::{shape, white};
    use super::*;

    /// Two responses of 40 rows with an offset each; a wave of six standard deviations in the second.
    #[test]
    fn a_response_is_as_quiet_as_its_effect_leaves_it() {
        let of = |response: usize, f: &dyn Fn(f64) -> f64| {
            DVector::from_fn(80, |row, _| match row / 40 == response {
                true => f((row % 40) as f64),
                false => 0.0,
            })
        };
        let wave = |row: f64| libm::sin(0.9 * row);
        let noise = |row: f64| {
            if (row as usize * 7) % 5 < 2 {
                1.2
            } else {
                -0.8
            }
        };
        let offsets = DMatrix::from_columns(&[of(0, &|_| 1.0), of(1, &|_| 1.0)]);
        let atoms: Vec<Atom> = (1..12)
            .map(|k| {
                let both = [0, 1].map(|at| of(at, &|row| libm::sin(0.3 * f64::from(k) * row)));
                Atom {
                    candidate: 0,
                    variant: String::new(),
                    shape: shape(&both[0] + &both[1]),
                    share: 1.0,
                }
            })
            .collect();
        let part = |size: f64| {
            let residuals = of(0, &noise) + of(1, &noise) + of(1, &wave) * size;
            let known = white(80);
            let none = Prior::none(2);
            let seen = Baseline::new(&offsets, &residuals, &known, &none).unwrap();
            [quiet(&seen, &atoms, 0..40), quiet(&seen, &atoms, 40..80)]
        };
        assert_eq!(part(0.0), [1.0, 1.0]);
        let [first, second] = part(6.0);
        // σ = 1 beside 6/√2.
        assert!(
            first == 1.0 && (0.2..0.3).contains(&second),
            "{first} {second}"
        );
    }
}
