//! Distributions that the first letters of their names stand for, as `N`, `R` and `U` in the forms of M3003.

use crate::claim::Shape;

use super::limits::shape;

/// What distributions are called, and the word for each that is read elsewhere.
const NAMES: &[(&str, &str)] = &[
    ("normal", "normal"),
    ("gaussian", "normal"),
    ("rectangular", "rectangular"),
    ("rechteck", "rectangular"),
    ("uniform", "rectangular"),
    ("square", "rectangular"),
    ("triangle", "triangle"),
    ("dreieck", "triangle"),
    ("trapezoid", "trapezoid"),
    ("u-shaped", "u-shaped"),
    ("u-form", "u-shaped"),
    ("u-verteilung", "u-shaped"),
    ("t-distribution", "t"),
];

/// The text of a column of distributions with its abbreviated name in full, as far as one name alone begins so; of several,
/// the one by whose divisor `ratio`, what was divided to what came of it, was found.
pub(crate) fn spelled(text: &str, ratio: Option<f64>) -> String {
    if shape(&text.to_lowercase()).is_some() {
        return text.to_owned();
    }
    let begins = |c: char| c.is_whitespace() || matches!(c, '(' | ',' | ';');
    let (word, behind) = text.split_at(text.find(begins).unwrap_or(text.len()));
    let short = word.trim_end_matches('.').to_lowercase();
    let named = |name: &str| {
        let mut meant = NAMES.iter().filter(|(full, _)| full.starts_with(&short));
        meant.any(|(_, word)| *word == name)
    };
    let full = match short.as_str() {
        "" => None,
        _ => meant(&named, ratio),
    };
    full.map_or_else(|| text.to_owned(), |full| format!("{full}{behind}"))
}

/// The word that is meant, of those that an abbreviation names.
fn meant(named: &dyn Fn(&str) -> bool, ratio: Option<f64>) -> Option<&'static str> {
    let words = NAMES.iter().map(|(_, word)| *word);
    let mut open: Vec<&'static str> = words.filter(|word| named(word)).collect();
    open.dedup();
    match open.as_slice() {
        [one] => Some(one),
        _ => open.into_iter().find(|word| {
            let divisor = divisor(word);
            divisor
                .zip(ratio)
                .is_some_and(|(d, ratio)| is_near(ratio, d))
        }),
    }
}

/// Half-width to standard uncertainty of a distribution that has no other parameter.
fn divisor(word: &str) -> Option<f64> {
    let shape = match word {
        "rectangular" => Shape::Rectangular,
        "triangle" => Shape::Triangular,
        "u-shaped" => Shape::Arcsine,
        _ => return None,
    };
    Some(shape.divisor())
}

/// Within what two digits of u leave open, which is less than the divisors are apart.
fn is_near(ratio: f64, divisor: f64) -> bool {
    (ratio / divisor - 1.0).abs() < 0.05
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_the_first_of_names() {
        for (text, ratio, full) in [
            ("R", None, "rectangular"),
            ("N (k=2)", None, "normal (k=2)"),
            ("n.", None, "normal"),
            ("square", None, "rectangular"),
            ("U-shaped", None, "U-shaped"),
            ("U", Some(1.41), "u-shaped"),
            ("U", Some(1.74), "rectangular"),
            ("Un", None, "rectangular"),
            ("T", Some(2.45), "triangle"),
            // Of which nothing tells, is left as it is.
            ("U", Some(1.0), "U"),
            ("T", None, "T"),
            ("N/A", None, "N/A"),
            ("A", None, "A"),
            ("B", None, "B"),
            ("", None, ""),
            ("均匀", None, "均匀"),
        ] {
            assert_eq!(spelled(text, ratio), full, "{text}");
        }
    }
}
