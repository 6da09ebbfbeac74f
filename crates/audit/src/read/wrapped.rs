//! Sentences that go on in the next line.

use super::prose;
use super::words::has;

/// Whether a line is the rest of the one above it: that one cannot end where it does, or this one cannot begin so.
pub(super) fn goes_on(above: &str, text: &str) -> bool {
    let above = above.trim_end();
    let is_closed = above.ends_with(['.', ';', ':', '!', '?', '。', '；', '：', '！', '？']);
    !is_closed && (is_open(above) || is_sentence(above) && is_rest(text))
}

/// Whether something is still to come: a bracket is open, or the last sign or word needs another one.
fn is_open(text: &str) -> bool {
    const LAST: [&str; 19] = [
        "is", "are", "was", "were", "of", "to", "with", "and", "the", "a", "an", "by", "for", "in",
        "than", "from", "has", "within", "at",
    ];
    let brackets = text.matches('(').count() > text.matches(')').count();
    let sign = text.ends_with(['=', '±', '≈', ',', '，', '、', '为']);
    let word = text
        .rsplit(' ')
        .next()
        .filter(|word| word.len() < text.len());
    brackets || sign || word.is_some_and(|word| LAST.contains(&word))
}

/// Whether a line begins as sentences do, and says something.
fn is_sentence(text: &str) -> bool {
    const VERBS: [&str; 8] = [
        "is",
        "are",
        "was",
        "were",
        "has",
        "have",
        "corresponds",
        "gives",
    ];
    text.starts_with(char::is_uppercase) && has(&text.to_lowercase(), &VERBS)
}

/// Whether a line begins within a sentence, with a small word or a bracket, and is no item of a list.
fn is_rest(text: &str) -> bool {
    let mut words = text.split(' ');
    let first = words.next().unwrap_or_default().trim_end_matches(',');
    let is_word = first.len() > 1 && first.bytes().all(|b| b.is_ascii_lowercase());
    let is_assigned = words
        .next()
        .is_some_and(|second| second.starts_with(['=', ':']));
    let bracket = text
        .strip_prefix('(')
        .is_some_and(|rest| rest.starts_with(char::is_alphabetic));
    let is_item = || prose::row(text, crate::printed::Place::default()).is_some();
    (bracket || is_word && !is_assigned) && !is_item()
}

#[cfg(test)]
mod tests {
    use super::goes_on;

    #[test]
    fn a_wrapped_sentence_is_one() {
        for (above, text) in [
            (
                "The expanded uncertainty is U = 0.12 mm",
                "(k = 2), for about 95 %.",
            ),
            (
                "The combined standard uncertainty is u_c =",
                "0.065 N·m. The expanded",
            ),
            ("The resolution of the gauge is", "0.02 kPa, so that"),
            (
                "The standard deviation was 0.3 mm for ten",
                "readings of the dial.",
            ),
            ("K1 = det(e1, q1) / (R", "* g_local)"),
            ("Readings: 1.2, 1.3,", "1.4, 1.5"),
            ("扩展不确定度为", "0.12 mm"),
        ] {
            assert!(goes_on(above, text), "{above} | {text}");
        }
    }

    #[test]
    fn lines_of_their_own_stay_so() {
        for (above, text) in [
            ("The budget is below.", "resolution 0.01 mm"),
            ("Budget of a caliper", "resolution: limits ±0.01 mm"),
            ("The bath is stable", "u_c = 0.3 K"),
            ("The bath is stable", "uc = 0.3 K"),
            (
                "The gauge is one of class 1",
                "(2) bath ±0.02 °C, u = 0.0115 °C",
            ),
            ("u_c = 0.3 mm", "U = 0.6 mm"),
        ] {
            assert!(!goes_on(above, text), "{above} | {text}");
        }
    }
}
