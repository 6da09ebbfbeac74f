//! Whole numbers that count: readings, and of how many a mean is.

use super::words::find;

/// The whole number in front of one of these words, with at most one other word between: `10 repeated readings`.
pub fn count_before(lower: &str, words: &[&str]) -> Option<f64> {
    for word in words {
        let mut from = 0;
        while let Some(at) = lower.get(from..).and_then(|rest| rest.find(word)) {
            let front = lower[..from + at].trim_end();
            if let Some(n) =
                trailing_count(front).or_else(|| trailing_count(front.rsplit_once(' ')?.0))
            {
                return Some(n);
            }
            from += at + word.len();
        }
    }
    None
}

/// The whole number at the end of a text.
pub fn trailing_count(front: &str) -> Option<f64> {
    let front = front.trim_end();
    let digits = front.bytes().rev().take_while(u8::is_ascii_digit).count();
    if digits == 0 {
        let word = front.rsplit(|c: char| !c.is_ascii_alphabetic()).next()?;
        const NUMBERS: [&str; 11] = [
            "", "", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        ];
        return NUMBERS
            .iter()
            .position(|n| !n.is_empty() && *n == word)
            .map(|n| n as f64);
    }
    let mut before = front[..front.len() - digits].chars().rev();
    // A marker between digits makes it a decimal number.
    let decimal = before.next().is_some_and(|c| {
        c == '-' || ".,".contains(c) && before.next().is_some_and(|c| c.is_ascii_digit())
    });
    let whole = digits <= 4 && !decimal;
    whole.then(|| front[front.len() - digits..].parse().ok())?
}

/// The whole number behind one of these keys: `n = 10`, `mean of 5`.
pub fn count_after(lower: &str, keys: &[&str]) -> Option<f64> {
    for key in keys {
        let mut from = 0;
        while let Some(at) = find(lower, key, from) {
            from = at + key.len();
            let rest = lower[from..]
                .trim_start()
                .trim_start_matches(['=', ':', '(', '为'])
                .trim_start();
            let rest = ["the last ", "the ", "all ", "of "]
                .iter()
                .fold(rest, |rest, word| rest.strip_prefix(word).unwrap_or(rest));
            let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
            let next = rest[digits..].chars().next();
            if digits > 0
                && digits <= 4
                && !next.is_some_and(|c| {
                    c == '.' && rest[digits + 1..].starts_with(|c: char| c.is_ascii_digit())
                })
            {
                return rest[..digits].parse().ok();
            }
            let word = rest
                .split(|c: char| !c.is_ascii_alphabetic())
                .next()
                .unwrap_or_default();
            if let Some(n) = trailing_count(word) {
                return Some(n);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_are_counted() {
        assert_eq!(count_before("s of 10 readings", &["reading"]), Some(10.0));
        assert_eq!(count_before("重复测量10次", &["次"]), Some(10.0));
        assert_eq!(count_after("mean of 5 readings", &["mean of"]), Some(5.0));
        assert_eq!(count_after("n = 10", &["n"]), Some(10.0));
    }
}
