//! Effective degrees of freedom of a sum, and the sizes that it rests on.
//!
//! Fourth powers of what a user writes in m leave the range of doubles where the same in fm would not: everything here is divided
//! by a size of its own first, so that the unit decides nothing.

/// ν_eff = u⁴/Σ u_k⁴/ν_k of independent contributions (u_k, ν_k), u² being Σ u_k² (Welch–Satterthwaite, JCGM 100, equation (G.2b)).
/// Infinite where nothing is uncertain.
pub fn effective_freedom(parts: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    effective_freedom_of(norm(parts.clone().map(|(u, _)| u)), parts)
}

/// As [`effective_freedom`], of a `u` that is more or other than the root of the sum of their squares.
pub fn effective_freedom_of(u: f64, parts: impl Iterator<Item = (f64, f64)>) -> f64 {
    if u == 0.0 || !u.is_finite() {
        return f64::INFINITY;
    }
    let sum: f64 = parts.map(|(part, dof)| (part / u).powi(4) / dof).sum();
    1.0 / sum
}

/// Length of a vector, without overflow or underflow of its squares; infinite or NaN entries pass through.
pub fn norm(values: impl Iterator<Item = f64> + Clone) -> f64 {
    root_mean_square(values, 1.0)
}

/// √(Σ x²/count), without overflow or underflow of the squares; infinite or NaN entries pass through. NaN of none of none.
pub fn root_mean_square(values: impl Iterator<Item = f64> + Clone, count: f64) -> f64 {
    let larger = |a: f64, v: f64| match a.is_nan() || v.is_nan() {
        true => f64::NAN,
        false => a.max(v.abs()),
    };
    let largest = values.clone().fold(0.0, larger);
    if !largest.is_finite() {
        return largest;
    }
    if largest == 0.0 {
        return (0.0 / count).sqrt();
    }
    let squares: f64 = values.map(|v| (v / largest).powi(2)).sum();
    largest * (squares / count).sqrt()
}

/// The power of two that is next below the size of a number: a division by it is exact. Of zero, infinity and NaN it is one.
pub fn power_of_two(x: f64) -> f64 {
    /// The bits of the exponent of a double.
    const EXPONENT: u64 = 0x7ff << 52;
    match x.is_finite() && x != 0.0 {
        true => f64::from_bits(x.to_bits() & EXPONENT).max(f64::MIN_POSITIVE),
        false => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALES: [i32; 4] = [-600, -40, 60, 600];

    fn of(parts: &[(f64, f64)]) -> f64 {
        effective_freedom(parts.iter().copied())
    }

    /// 3² + 4² = 5²: ν_eff = 5⁴/(3⁴/4).
    #[test]
    fn two_contributions_by_hand() {
        let found = of(&[(3.0, 4.0), (4.0, f64::INFINITY)]);
        assert!((found / (625.0 / (81.0 / 4.0)) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn equal_parts_add_their_degrees_of_freedom() {
        for n in 1..20_u8 {
            let parts = vec![(0.3, 4.5); n.into()];
            assert!((of(&parts) / (f64::from(n) * 4.5) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn the_unit_changes_no_bit() {
        let scaled = |unit: f64| [(0.1 * unit, 4.0), (0.7 * unit, 2.5), (3.3 * unit, 50.0)];
        for exponent in SCALES {
            let unit = 2.0_f64.powi(exponent);
            assert_eq!(of(&scaled(unit)), of(&scaled(1.0)), "2^{exponent}");
            let length = |unit: f64| norm(scaled(unit).into_iter().map(|(u, _)| u));
            assert_eq!(length(unit), unit * length(1.0), "2^{exponent}");
        }
    }

    #[test]
    fn what_is_exact_has_no_end_of_freedom() {
        for parts in [&[][..], &[(0.0, 3.0)], &[(1.0, f64::INFINITY)]] {
            assert_eq!(of(parts), f64::INFINITY);
        }
    }

    #[test]
    fn sizes_at_the_ends_of_the_range() {
        for x in [5e-324, 1e-310, f64::MIN_POSITIVE, 0.3, 1.0, 1.9, f64::MAX] {
            let unit = power_of_two(-x);
            assert!(x / unit < 2.0 && unit * (x / unit) == x, "{x}");
            assert_eq!(norm([x].into_iter()), x);
        }
        let unit = 2.0_f64.powi(900);
        assert_eq!(norm([3.0 * unit, 4.0 * unit].into_iter()), 5.0 * unit);
        assert!(norm([1.0, f64::NAN].into_iter()).is_nan());
        assert_eq!(norm([1.0, f64::NEG_INFINITY].into_iter()), f64::INFINITY);
        assert_eq!(norm([0.0, -0.0].into_iter()), 0.0);
        assert_eq!(norm(std::iter::empty()), 0.0);
        assert!(root_mean_square(std::iter::empty(), 0.0).is_nan());
        // Four numbers of size 2, of which one was spent on the mean.
        assert_eq!(
            root_mean_square([2.0_f64, -2.0, 2.0, 0.0].into_iter(), 3.0),
            2.0
        );
    }
}
