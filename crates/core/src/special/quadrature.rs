//! Gauss–Legendre quadrature.

/// Positive nodes and weights of the 16-point rule on ±1.
const RULE: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_4, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_7, 0.149_595_988_816_576_73),
    (0.755_404_408_355_003, 0.124_628_971_255_533_87),
    (0.865_631_202_387_831_7, 0.095_158_511_682_492_78),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_89),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_095),
];

/// Nodes and weights of the 16-point Gauss–Legendre rule on `low … high`, exact for polynomials
/// up to degree 31.
pub fn gauss_legendre(low: f64, high: f64) -> impl Iterator<Item = (f64, f64)> {
    let middle = 0.5 * (low + high);
    let half = 0.5 * (high - low);
    RULE.into_iter().flat_map(move |(node, weight)| {
        [
            (middle - half * node, half * weight),
            (middle + half * node, half * weight),
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_for_polynomials() {
        for degree in 0..=31 {
            let found: f64 = gauss_legendre(0.0, 1.0)
                .map(|(x, w)| w * x.powi(degree))
                .sum();
            assert!(
                (found * f64::from(degree + 1) - 1.0).abs() < 1e-14,
                "{degree}: {found}"
            );
        }
    }
}
