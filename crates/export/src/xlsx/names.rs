//! Names of sheets: at most 31 characters, none of seven, each once.

use std::collections::BTreeSet;

/// The names that were given.
#[derive(Default)]
pub(super) struct Names(BTreeSet<String>);

/// Characters that a name can have.
const MOST: usize = 31;

impl Names {
    /// A name like this one that no other sheet has.
    pub(super) fn like(&mut self, wanted: &str) -> String {
        let fit = |c: char| match c {
            '[' | ']' | ':' | '*' | '?' | '/' | '\\' => ' ',
            c if c.is_control() => ' ',
            c => c,
        };
        let words: String = wanted.replace('\u{AD}', "").chars().map(fit).collect();
        let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
        let words = words.trim_matches('\'');
        // Excel keeps this name for itself.
        let words = match words {
            "" => "Sheet",
            name if name.eq_ignore_ascii_case("history") => "History of it",
            name => name,
        };
        let numbers = std::iter::once(String::new()).chain((2..).map(|n| format!(" ({n})")));
        let mut names = numbers.map(|number| shortened(words, MOST - number.len()) + &number);
        // There are more numbers than sheets.
        let free = names.find(|name| self.0.insert(name.to_lowercase()));
        free.unwrap_or_default()
    }
}

/// The first characters, as many as spreadsheets count (UTF-16).
fn shortened(words: &str, most: usize) -> String {
    let mut left = most;
    let fits = |c: &char| {
        let fits = c.len_utf16() <= left;
        left = left.saturating_sub(c.len_utf16());
        fits
    };
    let short: String = words.chars().take_while(fits).collect();
    short.trim_end_matches([' ', '\'']).to_string()
}

#[cfg(test)]
mod tests {
    use super::Names;

    #[test]
    fn names_are_short_plain_and_different() {
        let mut names = Names::default();
        let long = "Where the standard uncertainties come from";
        assert_eq!(names.like(long), "Where the standard uncertaintie");
        assert_eq!(names.like(long), "Where the standard uncertai (2)");
        assert_eq!(names.like("a/b:[c]"), "a b c");
        assert_eq!(names.like("A B C"), "A B C (2)");
        assert_eq!(names.like("''"), "Sheet");
        assert_eq!(names.like("测量不确定度"), "测量不确定度");
    }
}
