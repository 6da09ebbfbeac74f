//! Numbers and amounts as people write them, and as TOML wants them.

use gumption_fault::{Said, say};

/// Whether a value without quotes is numbers with operators between them.
pub(super) fn is_calculation(text: &str) -> bool {
    let text = text.trim().replace("sqrt", "").replace('√', "");
    let sign = |c: char| c.is_ascii_digit() || "+-*/^(). eE".contains(c);
    let operator = text
        .trim_start_matches(['+', '-'])
        .contains(['*', '/', '^', '+', '-', '(']);
    text.chars().all(sign) && operator && text.ends_with(|c: char| c.is_ascii_digit() || c == ')')
}

/// What a quotient of two numbers is.
pub(super) fn quotient(text: &str) -> Option<f64> {
    let (dividend, divisor) = text.split_once('/')?;
    let root = |text: &str| {
        let behind = text
            .strip_prefix('√')
            .or_else(|| text.strip_prefix("sqrt"))?;
        let inside = behind
            .strip_prefix('(')
            .and_then(|text| text.strip_suffix(')'));
        let number: f64 = inside.unwrap_or(behind).trim().parse().ok()?;
        Some(number.sqrt())
    };
    let number = |text: &str| {
        let text = text.trim();
        text.parse().ok().or_else(|| root(text))
    };
    Some(number(dividend)? / number(divisor)?).filter(|result| result.is_finite())
}

/// The value of the concise notation 12.50(3) of a value with its standard uncertainty (GUM 7.2.2).
pub(super) fn concise(text: &str) -> Option<&str> {
    let (number, digits) = text.trim().strip_suffix(')')?.split_once('(')?;
    let all_digits = !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit() || c == '.');
    (all_digits && number.parse::<f64>().is_ok()).then_some(number)
}

/// What is written in place of the concise notation.
pub(super) fn of_concise(number: &str) -> Said {
    say!(
        "the value and its uncertainty have keys of their own: value = \"{number} …\" and u = …; the digits in brackets are in units of the last digit"
    )
}

/// What stands in front of ± and behind it, also where keyboards have none: `1.00 +/- 0.05`.
pub(super) fn parted_by_plus_minus(text: &str) -> Option<(&str, &str)> {
    let parts = ["±", "+/-", "+-"]
        .iter()
        .find_map(|sign| text.split_once(sign))?;
    Some((parts.0.trim(), parts.1.trim()))
}

/// How to mend limits that are written with their sign.
pub(super) fn without_sign(amount: &str) -> Said {
    let quotes = match amount.parse::<f64>() {
        Ok(_) => "",
        Err(_) => "\"",
    };
    say!(
        "leave out the ± where the key says it, as in half_width = {quotes}{amount}{quotes}; a value has one sign"
    )
}

/// What is written in place of a range.
pub(super) fn of_range((lower, upper, unit): (String, String, String)) -> Said {
    match unit.as_str() {
        "" => say!("two limits are limits = [{lower}, {upper}]"),
        unit => say!("two limits are limits = [\"{lower} {unit}\", \"{upper} {unit}\"]"),
    }
}

/// What is written in place of a number whose decimal point is a prefix; `R` stands for no prefix.
pub(super) fn of_prefix_for_point((number, prefix, unit): (String, char, &str)) -> Said {
    let unit = match unit {
        "" => "ohm",
        unit => unit,
    };
    match prefix {
        'R' => say!("write \"{number} {unit}\""),
        prefix => say!("write \"{number} {prefix}{unit}\""),
    }
}

/// Whether a number has an exponent with a decimal point: `1e2.5`.
pub(super) fn has_fractional_exponent(text: &str) -> bool {
    let parts = text.trim().split_once(['e', 'E']);
    parts.is_some_and(|(mantissa, exponent)| {
        let digits = |c: char| c.is_ascii_digit() || "+-.".contains(c);
        let number = &exponent[..exponent.len() - exponent.trim_start_matches(digits).len()];
        let is_number = |text: &str| text.parse::<f64>().is_ok();
        is_number(mantissa) && number.contains('.') && is_number(number)
    })
}

/// What is said of an exponent with a decimal point.
pub(super) fn of_fractional_exponent() -> Said {
    say!("an exponent is a whole number, as in 3.2e2")
}

/// What is written in place of a value with ± and its uncertainty, which may stand in a bracket in front of their unit.
pub(super) fn of_plus_minus(number: &str, rest: &str) -> Said {
    let (number, rest) = match number.strip_prefix(['(', '（']) {
        Some(number) => (number.trim(), rest.replacen([')', '）'], "", 1)),
        None => (number, rest.to_owned()),
    };
    let (value, uncertainty) = (as_stated(number, &rest), as_stated(&rest, number));
    say!(
        "the value and its uncertainty have keys of their own: value = {value}, and u = {uncertainty}, half_width = {uncertainty} or certificate = {{ U = {uncertainty}, k = 2 }}, whichever it is"
    )
}

/// An amount as a file states it: a bare number with the unit of the other one, if that has any.
fn as_stated(text: &str, other: &str) -> String {
    match (text.parse::<f64>(), amount(other)) {
        (Ok(_), Some((_, unit))) => format!("\"{text} {unit}\""),
        (Ok(_), None) => text.to_owned(),
        (Err(_), _) => format!("\"{text}\""),
    }
}

/// What to write for a number with a comma, between `quotes`: a decimal point, or nothing where the comma
/// may part thousands.
pub(super) fn without_comma(number: &str, quotes: &str) -> Said {
    let number = &number.replace('，', ",");
    // Points in front of the comma part thousands: `1.234,5`.
    if let Some((thousands, decimals)) = number.split_once(',')
        && thousands.contains('.')
    {
        let whole = thousands.replace('.', "");
        return say!("write {quotes}{whole}.{decimals}{quotes}");
    }
    let point = number.replacen(',', ".", 1);
    let behind = number.split_once(',').map_or("", |(_, behind)| behind);
    let places = behind.bytes().take_while(u8::is_ascii_digit).count();
    let joined = number.replace(',', "");
    // No thousand begins with a nought.
    let is_decimal = places != 3 || number.trim_start_matches(['-', '+']).starts_with('0');
    if is_decimal {
        say!("write a decimal point: {quotes}{point}{quotes}")
    } else if behind[places..].starts_with(['.', ',']) {
        say!("write it without commas: {quotes}{joined}{quotes}")
    } else {
        say!(
            "write {quotes}{joined}{quotes}, or {quotes}{point}{quotes} if the comma is a decimal one"
        )
    }
}

/// Numbers with nothing but blanks between them.
pub(super) fn several_numbers(text: &str) -> Option<Vec<&str>> {
    let is_number = |text: &&str| {
        text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
            && text.parse::<f64>().is_ok()
    };
    let words: Vec<&str> = text.split_whitespace().collect();
    (words.len() > 1 && words.iter().all(is_number)).then_some(words)
}

/// Number and unit of an amount that was written without quotes.
pub(super) fn amount(text: &str) -> Option<(&str, &str)> {
    let of_number = |c: char| c.is_ascii_digit() || "+-._eE".contains(c);
    let most = text.len() - text.trim_start_matches(of_number).len();
    let ends = (1..=most).rev();
    let mut ends =
        ends.filter(|end| text[..*end].ends_with(|c: char| c.is_ascii_digit() || c == '.'));
    let end = ends.find(|end| text[..*end].parse::<f64>().is_ok())?;
    let (number, unit) = text.split_at(end);
    let unit = unit.trim();
    let is_unit =
        !unit.is_empty() && !unit.contains(' ') && !unit.starts_with(['/', '*', '^', '√']);
    is_unit.then_some((number, unit))
}

/// How an amount is written that stands without quotes.
pub(super) fn quoted(number: &str, unit: &str) -> Said {
    let share: Option<f64> = number.parse().ok().filter(|_| unit == "%");
    match share {
        Some(share) => say!(
            "write \"{number} {unit}\" for a relative amount, and {} where a fraction is wanted",
            share / 100.0
        ),
        None => say!("write \"{number} {unit}\""),
    }
}
