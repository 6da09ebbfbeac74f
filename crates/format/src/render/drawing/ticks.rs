//! Numbers along an axis.

use crate::document::Scale;

/// Places inside the limits with their labels: four to eight round numbers, or powers of ten.
pub(super) fn ticks([low, high]: [f64; 2], scale: Scale) -> Vec<(f64, String)> {
    /// Fewer powers of ten need numbers between them, which a linear scale of places would not give.
    const POWERS: f64 = 8.0;
    let rough = (high - low) / 5.0;
    let decade = libm::pow(10.0, libm::log10(rough).floor());
    let step = match scale {
        Scale::Logarithmic => ((high - low) / POWERS).ceil(),
        Scale::Linear => [1.0, 2.0, 5.0, 10.0]
            .map(|m| m * decade)
            .into_iter()
            .find(|step| *step >= rough)
            .unwrap_or(rough),
    };
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    let places = (first..=last).map(|k| k as f64 * step);
    places
        .map(|tick| match scale {
            Scale::Linear => (tick, label(tick, step)),
            Scale::Logarithmic => (tick, raised("10", tick as i32)),
        })
        .collect()
}

/// A multiple of the step with no more digits than the step needs.
fn label(tick: f64, step: f64) -> String {
    let exponent = |x: f64| libm::log10(x.abs() * (1.0 + 1e-9)).floor() as i32;
    let last_place = exponent(step);
    if tick == 0.0 {
        "0".to_owned()
    } else if tick.abs() < 1e5 && last_place >= -5 {
        let decimals = usize::try_from(-last_place).unwrap_or(0);
        format!("{tick:.decimals$}").replace('-', "−")
    } else {
        let power = exponent(tick);
        let digits = usize::try_from(power - last_place).unwrap_or(0);
        let mantissa = tick / libm::pow(10.0, f64::from(power));
        raised(&format!("{mantissa:.digits$}×10").replace('-', "−"), power)
    }
}

/// A power as it is printed in a figure: `1×10⁶`.
fn raised(base: &str, exponent: i32) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let exponent = exponent.to_string();
    let raised = exponent.chars().map(|c| match c.to_digit(10) {
        Some(digit) => RAISED[digit as usize],
        None => '⁻',
    });
    base.chars().chain(raised).collect()
}
