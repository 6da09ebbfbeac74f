//! Numbers along an axis.

use crate::document::Scale;
use gumption_core::letters;

/// Places inside the limits with their labels: a few round numbers, or powers of ten.
pub(super) fn ticks([low, high]: [f64; 2], scale: Scale) -> Vec<(f64, String)> {
    match scale {
        Scale::Linear => round_numbers([low, high]),
        Scale::Logarithmic => powers([low, high]),
    }
}

fn round_numbers([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let rough = (high - low) / 5.0;
    let decade = libm::pow(10.0, libm::log10(rough).floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|m| m * decade)
        .into_iter()
        .find(|step| *step >= rough)
        .unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    let places = (first..=last).map(|k| k as f64 * step);
    places.map(|tick| (tick, label(tick, step))).collect()
}

/// Powers of ten; over few of them with two and five times each.
fn powers([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    const MOST: f64 = 8.0;
    const FEW: f64 = 3.0;
    let step = ((high - low) / MOST).ceil().max(1.0);
    let factors: &[u8] = match high - low < FEW {
        true => &[1, 2, 5],
        false => &[1],
    };
    let first = (low / step).floor() as i64;
    let last = (high / step).floor() as i64;
    let powers = (first..=last).map(|k| k as f64 * step);
    let all = powers.flat_map(|power| factors.iter().map(move |factor| (power, *factor)));
    let placed = all.map(|(power, factor)| {
        let base = match factor {
            1 => "10".to_owned(),
            factor => format!("{factor}×10"),
        };
        let place = power + libm::log10(f64::from(factor));
        (place, raised(&base, power as i32))
    });
    placed
        .filter(|(place, _)| (low..=high).contains(place))
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
    let exponent = exponent.to_string();
    let raised = exponent.chars().map(letters::raised);
    base.chars().chain(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(limits: [f64; 2], scale: Scale) -> Vec<String> {
        let ticks = ticks(limits, scale).into_iter();
        ticks.map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_numbers_inside_the_limits() {
        let linear = |low, high| labels([low, high], Scale::Linear);
        assert_eq!(linear(-0.3, 1.1), ["0", "0.5", "1.0"]);
        let small = ["−0.0010", "−0.0005", "0", "0.0005", "0.0010"];
        assert_eq!(linear(-0.0012, 0.0011), small);
        assert_eq!(linear(0.0, 4e6), ["0", "1×10⁶", "2×10⁶", "3×10⁶", "4×10⁶"]);
    }

    #[test]
    fn over_few_powers_of_ten_there_are_numbers_between_them() {
        let powers = |low, high| labels([low, high], Scale::Logarithmic);
        assert_eq!(powers(-0.2, 0.8), ["10⁰", "2×10⁰", "5×10⁰"]);
        assert_eq!(powers(-4.1, -2.9), ["10⁻⁴", "2×10⁻⁴", "5×10⁻⁴", "10⁻³"]);
        assert_eq!(powers(0.0, 4.0), ["10⁰", "10¹", "10²", "10³", "10⁴"]);
        assert!(powers(0.0, 40.0).len() <= 9);
    }
}
