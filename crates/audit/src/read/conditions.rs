//! What a label of a figure of the whole says beside its name: at which point of the range the figure holds, and how many standard
//! uncertainties it is.

use std::borrow::Cow;

use crate::printed::{Printed, leading};

use super::columns::is_unit;
use super::factor::is_factor;
use super::words::alone;

/// Nouns behind an amount that make it a point of the range, or the range itself.
const NOUNS: [&str; 16] = [
    "full scale",
    "range",
    "load",
    "point",
    "level",
    "setting",
    "测量点",
    "校准点",
    "量程",
    "载荷",
    "处",
    "点",
    "档",
    "时",
    "bereich",
    "messpunkt",
];

/// A text without the amounts that are points at which its figure holds: `Expanded uncertainty (k = 2)` of `Expanded uncertainty at 23 °C
/// (k = 2)`, `U` of `U @ 20 kN`, `扩展不确定度(k=2)` of `扩展不确定度(20 kN 点,k=2)`.
pub(super) fn without_point(text: &str) -> Cow<'_, str> {
    if !text.contains(|c: char| c.is_ascii_digit()) {
        return Cow::Borrowed(text);
    }
    let mut kept: Option<String> = None;
    loop {
        let own = kept.as_deref().unwrap_or(text);
        let Some((from, to)) = point(own) else {
            break;
        };
        let front = own[..from].trim_end();
        let behind = own[to..].trim_start();
        // What parted the point from the rest parts nothing any more.
        let behind = match front.ends_with('(') {
            true => behind.trim_start_matches([',', ';', ' ']),
            false => behind,
        };
        let joined = match (front.strip_suffix('('), behind.strip_prefix(')')) {
            (Some(front), Some(behind)) => format!("{}{behind}", front.trim_end()),
            _ if front.ends_with('(') || behind.starts_with([')', ',', ';', ':']) => {
                format!("{front}{behind}")
            }
            _ => format!("{front} {behind}"),
        };
        kept = Some(joined.trim().to_owned());
    }
    kept.map_or(Cow::Borrowed(text), Cow::Owned)
}

/// Where the first point stands, with the words that make it one.
fn point(text: &str) -> Option<(usize, usize)> {
    let starts = text.char_indices().filter(|(at, c)| {
        let before = text[..*at].chars().next_back();
        let is_sign = matches!(c, '+' | '-' | '±');
        let next = text[at + c.len_utf8()..].chars().next();
        let begins = c.is_ascii_digit() || is_sign && next.is_some_and(|c| c.is_ascii_digit());
        begins
            && before.is_none_or(|c| !c.is_alphanumeric() && !"._+-±^".contains(c) || !c.is_ascii())
    });
    starts.map(|(at, _)| at).find_map(|at| {
        let (_, behind) = leading(&text[at..])?;
        let unit = behind.trim_start();
        let ends = |c: char| c.is_whitespace() || ",;:()=@".contains(c) || is_noun(c);
        let end = unit.find(ends).unwrap_or(unit.len());
        if !is_unit(alone(&unit[..end])) {
            return None;
        }
        let (from, is_led) = lead(&text[..at]);
        let rest = unit[end..].trim_start();
        let noun = NOUNS.iter().find(|noun| {
            let lower = rest.get(..noun.len()).map(str::to_lowercase);
            lower.as_deref() == Some(*noun)
        });
        let to = text.len() - noun.map_or(unit.len() - end, |noun| rest.len() - noun.len());
        (is_led || noun.is_some()).then_some((from, to))
    })
}

fn is_noun(c: char) -> bool {
    matches!(c, '处' | '点' | '档' | '时' | '量' | '测' | '校' | '载')
}

/// Where the words in front of an amount begin that make it a point, `at`, `@`, `for the`, `在`; a verb in front of them makes it the
/// figure itself: `is estimated at 0.05 mm`.
fn lead(front: &str) -> (usize, bool) {
    const LEADS: [&str; 7] = ["at", "for", "bei", "pour", "à", "für", "in"];
    let own = front.trim_end();
    if let Some(own) = own.strip_suffix(['@', '在']) {
        return (own.len(), true);
    }
    let word = |text: &str| {
        let start = text
            .rfind(|c: char| c.is_whitespace() || "(,;:".contains(c))
            .map_or(0, |at| {
                at + text[at..].chars().next().map_or(1, char::len_utf8)
            });
        (start, text[start..].to_lowercase())
    };
    let (mut start, mut last) = word(own);
    if matches!(last.as_str(), "the" | "a" | "nominal" | "range") {
        (start, last) = word(own[..start].trim_end());
    }
    let before = own[..start].trim_end();
    let (_, verb) = word(before);
    let is_verb = verb.ends_with("ed")
        && !matches!(
            verb.as_str(),
            "expanded" | "combined" | "reported" | "claimed"
        )
        || ["is", "was", "given", "taken", "set", "lies", "be"].contains(&verb.as_str());
    // `U in 10 V range`: alone it would be the unit in which U is.
    let is_lead = LEADS.contains(&last.as_str()) && last != "in";
    (start, is_lead && !is_verb && !before.is_empty())
}

/// A text without what it says of its coverage, `k = 2`, `p = 95 %` and `95 %`, with the marks that part that from the rest: `U: 9.9 ppm` of
/// `U, 95 %, k = 2: 9.9 ppm`.
pub(super) fn without_coverage(text: &str) -> Cow<'_, str> {
    let mut kept = Cow::Borrowed(text);
    // Each round is shorter.
    while let Some((from, to)) = coverage(&kept) {
        let front = kept[..from].trim_end_matches([' ', ',', ';']);
        let behind = kept[to..].trim_start();
        let joined = match (front.strip_suffix('('), behind.strip_prefix(')')) {
            (Some(front), Some(behind)) => format!("{}{behind}", front.trim_end()),
            (Some(front), None) => {
                format!("{front}({}", behind.trim_start_matches([',', ';', ' ']))
            }
            _ if behind.starts_with([')', ',', ';', ':']) => format!("{front}{behind}"),
            _ => format!("{front} {behind}"),
        };
        kept = Cow::Owned(joined);
    }
    kept
}

/// Where a text states a coverage factor or a probability of its coverage.
fn coverage(text: &str) -> Option<(usize, usize)> {
    let factor = ["k", "k_p", "kp", "p", "P"].iter().find_map(|name| {
        let at = super::words::symbol_at(text, name, 0)?;
        let behind = text[at + name.len()..].trim_start().strip_prefix('=')?;
        let (_, rest) = leading(behind)?;
        // `k = 2 × 0.03 = 0.06` is more than a factor.
        let rest = rest.trim_start();
        let rest = rest.strip_prefix('%').unwrap_or(rest);
        let goes_on = super::words::starts_product(rest) || rest.starts_with('=');
        (!goes_on).then_some((at, text.len() - rest.len()))
    });
    let level = || {
        let mut signs = text.match_indices('%').map(|(at, _)| at);
        signs.find_map(|at| {
            let front = text[..at].trim_end();
            let start = front
                .rfind(|c: char| !c.is_ascii_digit() && c != '.')
                .map_or(0, |i| {
                    i + front[i..].chars().next().map_or(1, char::len_utf8)
                });
            let level: f64 = front[start..].parse().ok()?;
            let is_apart = front[..start].trim_end().ends_with([',', ';', '(']);
            let is_end = text[at + 1..]
                .trim_start()
                .starts_with([',', ';', ')', ':']);
            let is_level = (90.0..100.0).contains(&level) && is_apart && is_end;
            is_level.then_some((start, at + 1))
        })
    };
    factor.or_else(level)
}

/// The factor that a label has in front of u, `2u`, `2·u_c`, or as so many standard deviations, `(2 sigma)`, `2σ`; with what is left of
/// the label.
pub(super) fn multiple(label: &str) -> Option<(Printed, String)> {
    let signs = label.char_indices().filter(|(at, c)| {
        let before = label[..*at].chars().next_back();
        c.is_ascii_digit() && before.is_none_or(|c| " (,;[".contains(c))
    });
    signs.map(|(at, _)| at).find_map(|at| {
        let (figure, behind) = leading(&label[at..])?;
        let behind = behind.trim_start_matches([' ', '-']);
        let rest = ["sigma", "σ", "倍标准差", "standard deviations"]
            .iter()
            .find_map(|name| behind.strip_prefix(name))?;
        let is_whole = rest.chars().next().is_none_or(|c| " ),;]:".contains(c));
        let front = label[..at].trim_end_matches([' ', '(', ',', ';', '[']);
        let rest = rest.trim_start_matches([' ', ')', ']', ',', ';']);
        let left = format!("{front} {rest}").trim().to_owned();
        let may_be = figure.value == 1.0 || is_factor(figure.value);
        (is_whole && may_be).then_some((figure, left))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_no_figures() {
        for (text, kept) in [
            (
                "Expanded uncertainty at 23 °C (k=2)",
                "Expanded uncertainty (k=2)",
            ),
            (
                "Expanded uncertainty at 50 % load (k=2)",
                "Expanded uncertainty (k=2)",
            ),
            (
                "Expanded uncertainty for 10 V range (k=2)",
                "Expanded uncertainty (k=2)",
            ),
            (
                "Expanded uncertainty in the 10 V range (k=2)",
                "Expanded uncertainty (k=2)",
            ),
            ("扩展不确定度(20 kN 点,k=2)", "扩展不确定度(k=2)"),
            ("扩展不确定度(在20 kN处)", "扩展不确定度"),
            ("扩展不确定度(k=2, 100 °C)", "扩展不确定度(k=2, 100 °C)"),
            ("uc @20kN", "uc"),
            ("U @20kN k=2", "U k=2"),
            ("U at -20 °C, k=2", "U, k=2"),
            ("Result U at 20 kN (k=2)", "Result U (k=2)"),
            ("U = 61 µV at 10 V (k = 2)", "U = 61 µV (k = 2)"),
            ("U (k=2) at 10 V: 99 µV", "U (k=2): 99 µV"),
            (
                "The expanded uncertainty is estimated at 0.05 mm",
                "The expanded uncertainty is estimated at 0.05 mm",
            ),
            ("U (k = 2) = 0.05 mm", "U (k = 2) = 0.05 mm"),
            ("u_c = 0.3 mm, U = 0.6 mm", "u_c = 0.3 mm, U = 0.6 mm"),
            ("U in mm", "U in mm"),
        ] {
            assert_eq!(without_point(text), kept, "{text}");
        }
    }

    #[test]
    fn coverage_parts_no_figure_from_its_name() {
        for (text, kept) in [
            (
                "Expanded uncertainty, 95 %, k = 2: 9.9 ppm",
                "Expanded uncertainty: 9.9 ppm",
            ),
            ("U (k=2): 99 µV", "U: 99 µV"),
            ("U (95 %, k = 2) = 3 g", "U = 3 g"),
            ("U = 0.05 mm, k = 2", "U = 0.05 mm"),
            ("U = k·u_c = 2 × 0.03 = 0.06", "U = k·u_c = 2 × 0.03 = 0.06"),
            ("U = 95 %", "U = 95 %"),
        ] {
            assert_eq!(without_coverage(text).trim(), kept, "{text}");
        }
    }

    #[test]
    fn standard_deviations_are_factors() {
        let of = |text: &str| multiple(text).map(|(k, left)| (k.value, left));
        let pair = |k: f64, left: &str| Some((k, left.to_owned()));
        assert_eq!(of("Uncertainty (2 sigma)"), pair(2.0, "Uncertainty"));
        assert_eq!(of("uncertainty 1σ"), pair(1.0, "uncertainty"));
        assert_eq!(of("U (k = 2)"), None);
        assert_eq!(of("2 sigmas of x"), None);
    }
}
