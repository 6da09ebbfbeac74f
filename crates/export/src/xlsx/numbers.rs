//! Numbers as they are printed, read back so that a cell holds a number and shows the same digits.

/// A printed number with the format in which a spreadsheet shows it alike.
#[derive(Debug, PartialEq)]
pub(super) struct Printed {
    pub value: f64,
    pub format: String,
}

/// The number that a text is and nothing else: `-0.0250`, `1.20×10^-5`, `1 000 000`.
pub(super) fn printed(text: &str) -> Option<Printed> {
    let (mantissa, exponent) = match text.split_once("×10^") {
        Some((mantissa, exponent)) => (mantissa, Some(exponent.parse::<i32>().ok()?)),
        None => (text, None),
    };
    let mantissa = mantissa.replace('−', "-");
    let (whole, digits) = mantissa.split_once('.').unwrap_or((&mantissa, ""));
    let bare = whole.strip_prefix('-').unwrap_or(whole);
    let grouped = bare.split(' ').skip(1).all(|group| group.len() == 3);
    let all_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let plain = bare.replace(' ', "");
    // Fifteen digits are what a cell keeps.
    let kept = plain.trim_start_matches('0').len() + digits.len() <= 15;
    if plain.is_empty() || !all_digits(&plain) || !all_digits(digits) || !grouped || !kept {
        return None;
    }
    let sign = if whole.starts_with('-') { "-" } else { "" };
    let number = format!("{sign}{plain}.{digits}e{}", exponent.unwrap_or(0));
    let value: f64 = number.parse().ok().filter(|x: &f64| x.is_finite())?;
    let zeros = "0".repeat(digits.len());
    let point = if digits.is_empty() { "" } else { "." };
    let power = if exponent.is_some() { "E+0" } else { "" };
    let head = match bare.contains(' ') {
        true => "# ##0",
        false => "0",
    };
    Some(Printed {
        value,
        format: format!("{head}{point}{zeros}{power}"),
    })
}

#[cfg(test)]
mod tests {
    use super::{Printed, printed};

    #[test]
    fn what_is_printed_as_a_number_is_one() {
        for (text, value, format) in [
            ("0", 0.0, "0"),
            ("-0.0250", -0.025, "0.0000"),
            ("1.20×10^-5", 1.2e-5, "0.00E+0"),
            ("1 000 000", 1e6, "# ##0"),
            ("95.4", 95.4, "0.0"),
        ] {
            let format = format.to_string();
            assert_eq!(printed(text), Some(Printed { value, format }), "{text}");
        }
        for text in [
            "",
            "-",
            "∞",
            "<0.1",
            "1 2",
            "0x1",
            "1e5",
            "=1",
            "—",
            "1.2.3",
            "12 mm",
            "1234567890123456",
        ] {
            assert_eq!(printed(text), None, "{text}");
        }
    }
}
