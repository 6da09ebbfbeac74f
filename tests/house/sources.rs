//! What no source does: take what is computed for limits of `clamp`, which panics where they are no numbers or
//! reversed; and read or write files but in the one place that knows what may be.

use super::lexer::Token;
use super::walks::token_lists;

#[test]
fn limits_of_clamp_are_written_out() {
    let mut computed = Vec::new();
    for (file, tokens) in token_lists() {
        for (at, _) in tokens
            .windows(3)
            .enumerate()
            .filter(|(_, w)| w[0].is(".") && w[1].is("clamp") && w[2].is("("))
        {
            let limits = inside(&tokens[at + 3..]);
            if !limits.iter().all(is_written_out) {
                let words: Vec<&str> = limits.iter().map(|token| token.0.as_str()).collect();
                computed.push(format!("{file}: clamp({})", words.join(" ")));
            }
        }
    }
    assert!(
        computed.is_empty(),
        "write `.max(low).min(high)`:\n{}",
        computed.join("\n")
    );
}

/// Numbers, constants and signs between them.
fn is_written_out(token: &Token) -> bool {
    let lower = |c: char| c.is_lowercase();
    let first = token.0.chars().next().unwrap_or(' ');
    let path = ["f64", "gumption_lanes"].contains(&token.0.as_str());
    !token.is_word() || first.is_ascii_digit() || path || !token.0.chars().any(lower)
}

/// The tokens up to the bracket that closes.
fn inside(tokens: &[Token]) -> &[Token] {
    let mut depth = 1;
    for (at, token) in tokens.iter().enumerate() {
        match token.0.as_str() {
            "(" => depth += 1,
            ")" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return &tokens[..at];
        }
    }
    tokens
}

#[test]
fn files_are_read_and_written_in_one_place() {
    /// Its own files, and what is not published: sealed cases with their study, and programs that build.
    const ALLOWED: [&str; 3] = [
        "crates/format/src/files/",
        "crates/challenge/src/",
        "crates/lab/build.rs",
    ];
    /// What opens a file, as it is called behind `fs::` or `File::`.
    const OPENS: [&str; 10] = [
        "read",
        "read_to_string",
        "write",
        "rename",
        "remove_file",
        "copy",
        "open",
        "create",
        "create_new",
        "options",
    ];
    let mut strangers = Vec::new();
    for (file, tokens) in token_lists() {
        let opens = tokens.windows(3).any(|w| {
            ["fs", "File"].contains(&w[0].0.as_str())
                && w[1].is("::")
                && OPENS.contains(&w[2].0.as_str())
        });
        if opens && !ALLOWED.iter().any(|folder| file.starts_with(folder)) {
            strangers.push(file);
        }
    }
    assert!(
        strangers.is_empty(),
        "use `Files` or `files::write`: {strangers:?}"
    );
}
