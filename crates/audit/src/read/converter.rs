//! The step of an analogue-to-digital converter, from its bits and its range.

use crate::printed::{Printed, leading};

use super::family::FULL_SCALE;
use super::words::{figure_after, find, has, lowered, signed_pair};

/// `16-bit converter, range ±10 V`: the span divided by 2^N. A unipolar converter spans 0 … FS, a bipolar one twice FS.
pub fn step(words: &str) -> Option<Printed> {
    let lower = lowered(words);
    let bits = bits(&lower)?;
    let span = span(words, &lower)?;
    let step = span.value / libm::exp2(bits);
    Some(Printed {
        value: step,
        half: 0.0,
        ..span
    })
}

fn bits(lower: &str) -> Option<f64> {
    const CONVERTERS: &[&str] = &[
        "adc",
        "a/d",
        "d/a",
        "dac",
        "converter",
        "bit",
        "bits",
        "daq",
        "转换",
        "采集",
        "模数",
        "量化",
    ];
    if !has(lower, CONVERTERS) {
        return None;
    }
    let words = ["bit", "位"];
    let places = words.iter().flat_map(|word| lower.match_indices(word));
    let counts = places.filter_map(|(at, _)| {
        let front = lower[..at].trim_end_matches(['-', ' ']);
        let start = front.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        front[start..].parse::<f64>().ok()
    });
    counts.into_iter().find(|bits| (4.0..=32.0).contains(bits))
}

fn span(words: &str, lower: &str) -> Option<Printed> {
    let doubled = |figure: Printed| figure.scaled(2.0);
    // Limits of what the converter does are no range.
    if has(
        lower,
        &[
            "limit",
            "极限",
            "误差",
            "error",
            "within",
            "half-width",
            "半宽",
        ],
    ) {
        return None;
    }
    if let Some(figure) = figure_after(words, &["±", "+/-"]) {
        return Some(doubled(figure));
    }
    if let Some((plus, minus)) = signed_pair(words) {
        return Some(Printed {
            value: plus.value + minus.value,
            ..plus
        });
    }
    let from_zero = [
        "0 to ", "0 … ", "0…", "0 ... ", "0...", "0 ~ ", "0~", "0-", "0 - ", "0至", "0 至 ", "0到",
    ];
    let upper = from_zero.iter().find_map(|key| {
        let at = find(lower, key, 0)?;
        let free = !lower[..at].ends_with(|c: char| c.is_ascii_digit() || c == '.');
        let (figure, behind) = leading(&words[at + key.len()..]).filter(|_| free)?;
        let unit = behind.trim_start().split([' ', ',', ';', ')', '。']).next();
        Some(Printed {
            unit: unit.unwrap_or_default().into(),
            ..figure
        })
    });
    if upper.is_some() {
        return upper;
    }
    let figure = figure_after(words, &[FULL_SCALE, &["range", "输入范围"]].concat())?;
    let bipolar = has(lower, &["bipolar", "双极"]);
    Some(if bipolar { doubled(figure) } else { figure })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_of_both_kinds() {
        let read = |text: &str| step(text).map(|step| (step.value, step.unit));
        let lsb = |span: f64, bits: f64| Some((span / libm::exp2(bits), "V".to_string()));
        for (text, expected) in [
            ("16-bit converter, range ±10 V", lsb(20.0, 16.0)),
            ("12 bit ADC, unipolar, full scale 10 V", lsb(10.0, 12.0)),
            ("İ 16-bit ADC, 0-10 V", lsb(10.0, 16.0)),
            ("İ 16-bit ADC, 0-", None),
            ("14-bit bipolar converter, full scale 5 V", lsb(10.0, 14.0)),
            ("quantisation of the 16-bit ADC, 0 to 5 V", lsb(5.0, 16.0)),
            ("16 位 A/D 转换器，量程 ±10 V", lsb(20.0, 16.0)),
            ("digital step 0.01 V", None),
            ("数据采集 12 位，极限 ±2.4414E-4", None),
        ] {
            assert_eq!(read(text), expected, "{text}");
        }
    }
}
