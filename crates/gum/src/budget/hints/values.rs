//! Values that writers of budgets mistake: of the wrong type, or where a table is expected.

use gumption_fault::{Said, say};
use gumption_format::toml::DeValue;

/// What to write for a value of the wrong type at this key.
pub fn wrong_type(key: &str, found: &str) -> Option<Said> {
    let number = found.trim_matches(['"', '\'']);
    match (key, number.starts_with('[')) {
        ("input" | "measurand" | "constant" | "source" | "fit", true) => {
            return Some(say!(
                "single brackets, and its name behind a dot: [{key}.NAME] is the header of each"
            ));
        }
        ("measurand", false) | ("model", true) => {
            let is_name = |c: char| c.is_alphanumeric() || c == '_';
            let name = number.split('=').next().unwrap_or_default().trim();
            let name = match name.chars().all(is_name) {
                true => name,
                false => "NAME",
            };
            return Some(say!(
                "its name stands in the header, its formula is the model: [measurand.{name}], model = \"…\""
            ));
        }
        _ if number == format!("[{key}]") => {
            return Some(say!(
                "it is a line above the first header in brackets: {key} = \"…\""
            ));
        }
        ("dof", _)
            if ["infinite", "infinity", "∞", "无穷", "无穷大"]
                .contains(&number.to_lowercase().as_str()) =>
        {
            return Some(say!("write {key} = inf"));
        }
        ("between", _) if !number.contains(',') => {
            return Some(say!(
                "two names are wanted: between = [\"{number}\", \"…\"]"
            ));
        }
        ("readings", _) if number.to_lowercase().ends_with(".csv") => {
            return Some(say!(
                "the column of a file is readings = {{ file = \"{number}\", column = \"…\" }}"
            ));
        }
        ("limits", _) if let Some((lower, upper)) = both_ends(number) => {
            return Some(say!("two limits are limits = [{lower}, {upper}]"));
        }
        ("readings" | "values", false) if let Some(list) = listed(number) => return Some(list),
        _ => {}
    }
    let begins = number.starts_with(|c: char| c.is_ascii_digit() || "+-.±".contains(c));
    if !begins || number.contains([',', ';', '，', '、']) {
        return None;
    }
    let number = number.trim_start_matches(['±', '+', '-']);
    let signed = |sign: &str| match found.starts_with(['"', '\'']) {
        true => format!("\"{sign}{number}\""),
        false => format!("{sign}{number}"),
    };
    let (width, below) = (signed(""), signed("-"));
    match key {
        "limits" => Some(say!(
            "two limits are limits = [lower, upper]; a distance from the value, the same on both sides, is half_width = {width}"
        )),
        "range" => Some(say!(
            "a range has two ends: range = [0, {width}] or range = [{below}, {width}]; the range R of n readings tells their s: pooled = {{ s = R/C, dof = ν }}, of = n, with C and ν for n (2.06 and 2.7 for n = 4)"
        )),
        "readings" => Some(say!(
            "one reading is value = {found}, with its uncertainty beside it; readings = […] are two or more"
        )),
        _ => None,
    }
}

/// Both ends of a text such as `1.9 .. 2.1`.
fn both_ends(text: &str) -> Option<(&str, &str)> {
    let mut signs = ["...", "..", "…", "~", "～", " to ", "至"].into_iter();
    let (lower, upper) = signs.find_map(|sign| text.split_once(sign))?;
    let (lower, upper) = (lower.trim(), upper.trim());
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    (is_number(lower) && is_number(upper)).then_some((lower, upper))
}

/// A list of numbers for a text that has them, and may have a unit behind the last one.
fn listed(text: &str) -> Option<Said> {
    let parts = text.split([',', ';', '，', '、', ' ', '\t']);
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    let (unit, numbers) = parts.split_last()?;
    let is_number = |part: &str| part.parse::<f64>().is_ok();
    let has_decimal_comma = text
        .split(',')
        .skip(1)
        .any(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    if parts.len() > 1 && !has_decimal_comma && parts.iter().all(|part| is_number(part)) {
        let numbers = parts.join(", ");
        return Some(say!("numbers stand in brackets: [{numbers}]"));
    }
    if is_number(unit) || numbers.len() < 2 || !numbers.iter().all(|part| is_number(part)) {
        return None;
    }
    let numbers = numbers.join(", ");
    Some(say!(
        "numbers stand in brackets, their unit apart: [{numbers}], and unit = \"{unit}\""
    ))
}

/// What to write in place of a value that stands where a table is expected.
pub fn no_table(title: &str, found: &DeValue<'_>) -> Option<Said> {
    match (title, found) {
        ("[fit.NAME.data]", DeValue::Array(_)) => Some(say!(
            "a column of data is a table, as it may have a unit and an uncertainty: {{ values = […] }}"
        )),
        ("[input]", DeValue::Array(list))
            if matches!(
                list.first().map(|element| element.get_ref()),
                Some(DeValue::Table(_))
            ) =>
        {
            Some(say!(
                "single brackets, and its name behind a dot: [input.NAME] is the header of each"
            ))
        }
        ("[input]", DeValue::Array(_)) => Some(say!("readings are {{ readings = […] }}")),
        ("[input]", DeValue::String(_) | DeValue::Integer(_) | DeValue::Float(_)) => Some(say!(
            "an input has a value and a reason for doubt: {{ value = …, u = … }}; what is exactly known stands below [constant]"
        )),
        ("[measurand]", DeValue::String(_)) => Some(say!(
            "its name stands in the header, its formula is the model: [measurand.NAME], model = \"…\""
        )),
        ("[monte_carlo]", _) => Some(say!(
            "[monte_carlo] is a header, with trials = … below it; every budget is checked by Monte Carlo, unless --no-mc (in Python, `monte_carlo=False`) is given"
        )),
        ("certificate", DeValue::String(_) | DeValue::Integer(_) | DeValue::Float(_)) => {
            Some(say!("a certificate is {{ U = …, k = 2, number = \"…\" }}"))
        }
        ("specification", DeValue::String(text)) => Some(say!(
            "its parts stand by themselves: {{ {} }}",
            parts_of(text)
        )),
        ("specification", DeValue::Integer(_) | DeValue::Float(_)) => {
            Some(say!("its parts stand by themselves: {{ {} }}", "fixed = …"))
        }
        _ => None,
    }
}

/// The keys of a specification as data sheets write it: `0.5 % of reading + 0.1 % of range + 2 digits`, `0.015 % + 0.004 %`.
fn parts_of(specification: &str) -> String {
    let mut is_first_share = true;
    let parts = specification.trim_start_matches(['±', '(']).split('+');
    let keys = parts.map(|part| {
        let part = part.trim().trim_end_matches(')').trim();
        let lower = part.to_lowercase();
        let says = |words: &[&str]| words.iter().any(|word| lower.contains(word));
        let share = part.find('%').map(|end| &part[..=end]);
        let number = part.split_whitespace().next().unwrap_or("…");
        match share {
            Some(share)
                if says(&["rang", "fs", "f.s", "full", "span", "量程", "满"])
                    || !std::mem::take(&mut is_first_share) =>
            {
                format!("range = \"{share}\", span = \"…\"")
            }
            Some(share) => format!("reading = \"{share}\""),
            // A `d` alone is a digit of the display, and no day.
            None if says(&["digit", "dgt", "count", "lsd", "字"])
                || lower.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ') == "d" =>
            {
                let number = number.trim_end_matches(char::is_alphabetic);
                format!("counts = {number}, step = \"…\"")
            }
            None => format!("fixed = \"{part}\""),
        }
    });
    keys.collect::<Vec<_>>().join(", ")
}
