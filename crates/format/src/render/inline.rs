//! Marks inside running text: what stands between backquotes, and exponents of powers of ten.

/// A stretch of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Run<'a> {
    /// As it is.
    Plain(&'a str),
    /// Names and text of files.
    Code(&'a str),
    /// An exponent.
    Raised(&'a str),
}

/// The stretches of a text.
pub fn runs(text: &str) -> Vec<Run<'_>> {
    let mut runs = Vec::new();
    let parts: Vec<&str> = text.split('`').collect();
    // A backquote without a partner is one.
    if parts.len().is_multiple_of(2) {
        powers(text, &mut runs);
        return runs;
    }
    for (at, part) in parts.iter().enumerate() {
        match at % 2 {
            0 => powers(part, &mut runs),
            _ => runs.push(Run::Code(part)),
        }
    }
    runs
}

/// Text in which `10^-6` has its exponent raised.
fn powers<'a>(text: &'a str, runs: &mut Vec<Run<'a>>) {
    let mut rest = text;
    let mut from = 0;
    while let Some(found) = rest[from..].find("10^") {
        let start = from + found + "10^".len();
        let sign = usize::from(rest[start..].starts_with('-'));
        let digits = rest[start + sign..].bytes().take_while(u8::is_ascii_digit);
        let digits = digits.count();
        if digits == 0 {
            from = start;
            continue;
        }
        let end = start + sign + digits;
        runs.push(Run::Plain(&rest[..start - 1]));
        runs.push(Run::Raised(&rest[start..end]));
        rest = &rest[end..];
        from = 0;
    }
    if !rest.is_empty() {
        runs.push(Run::Plain(rest));
    }
}

#[cfg(test)]
mod tests {
    use super::{Run, runs};

    #[test]
    fn marks_are_found() {
        use Run::{Code, Plain, Raised};
        assert_eq!(
            runs("u = 2×10^-6 `a ^ b` 10^x"),
            [
                Plain("u = 2×10"),
                Raised("-6"),
                Plain(" "),
                Code("a ^ b"),
                Plain(" 10^x")
            ]
        );
        assert_eq!(runs("a ` b"), [Plain("a ` b")]);
        assert!(runs("").is_empty());
    }
}
