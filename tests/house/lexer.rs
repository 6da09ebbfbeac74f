//! Rust as far as names go: words, signs and texts, without comments and tests.

/// A word (identifier, keyword or number), a sign, where `::` is one, or a text with its quotation marks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Token(pub String);

impl Token {
    /// Whether it is this word or sign.
    pub fn is(&self, what: &str) -> bool {
        self.0 == what
    }

    /// Whether it is a word.
    pub fn is_word(&self) -> bool {
        self.0.starts_with(is_word)
    }
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The tokens of a source, without items for tests alone. Gives also the modules that are for tests alone.
pub fn tokens(source: &str) -> (Vec<Token>, Vec<String>) {
    without_tests(&all(source))
}

fn all(source: &str) -> Vec<Token> {
    let mut found = Vec::new();
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(length) = text(rest) {
            found.push(Token(rest[..length].to_owned()));
            length
        } else if first == '\'' {
            character(rest)
        } else {
            let length = if is_word(first) {
                rest.find(|c| !is_word(c)).unwrap_or(rest.len())
            } else if rest.starts_with("::") {
                2
            } else {
                first.len_utf8()
            };
            if !first.is_whitespace() {
                found.push(Token(rest[..length].to_owned()));
            }
            length
        };
        rest = &rest[length..];
    }
    found
}

/// Length of a text, raw or not, at the beginning.
fn text(rest: &str) -> Option<usize> {
    let prefix = rest.len() - rest.trim_start_matches(['b', 'c', 'r']).len();
    let raw = rest[..prefix].contains('r');
    let hashes = rest[prefix..].len() - rest[prefix..].trim_start_matches('#').len();
    let body = rest[prefix + hashes..].strip_prefix('"')?;
    let start = rest.len() - body.len();
    if raw {
        let end = format!("\"{}", "#".repeat(hashes));
        return Some(start + body.find(&end).map_or(body.len(), |at| at + end.len()));
    }
    if hashes > 0 {
        return None;
    }
    let mut escaped = false;
    for (at, c) in body.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return Some(start + at + 1),
            _ => {}
        }
    }
    Some(rest.len())
}

/// Length of a character or of the apostrophe of a lifetime.
fn character(rest: &str) -> usize {
    let mut chars = rest.char_indices().skip(1);
    match (chars.next(), chars.next()) {
        (Some((_, '\\')), Some((next, c))) => {
            let after = next + c.len_utf8();
            rest[after..].find('\'').map_or(1, |end| after + end + 1)
        }
        (Some(_), Some((end, '\''))) => end + 1,
        _ => 1,
    }
}

const TEST: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];

fn without_tests(tokens: &[Token]) -> (Vec<Token>, Vec<String>) {
    let (mut kept, mut tests) = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < tokens.len() {
        let marked = tokens[at..].len() > TEST.len()
            && tokens[at..]
                .iter()
                .zip(TEST)
                .all(|(token, word)| token.is(word));
        if !marked {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        let item = &tokens[at + TEST.len()..];
        let length = item_length(item);
        tests.extend(declared_module(&item[..length]));
        at += TEST.len() + length;
    }
    (kept, tests)
}

/// Tokens up to the end of an item: a semicolon, or the brace that closes its body.
fn item_length(item: &[Token]) -> usize {
    let import = item.iter().take(6).any(|token| token.is("use"));
    let mut depth = 0;
    for (at, token) in item.iter().enumerate() {
        match token.0.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" if depth == 1 && !import => return at + 1,
            "}" | ")" | "]" => depth -= 1,
            ";" if depth == 0 => return at + 1,
            _ => {}
        }
    }
    item.len()
}

/// The name of `mod name;`.
fn declared_module(item: &[Token]) -> Option<String> {
    match item {
        [.., keyword, name, end] if keyword.is("mod") && end.is(";") => Some(name.0.clone()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::tokens;

    fn words(source: &str) -> String {
        let (found, _) = tokens(source);
        found
            .into_iter()
            .map(|token| token.0)
            .collect::<Vec<_>>()
            .join(" ")
    }

    #[test]
    fn comments_and_characters_are_no_names_and_texts_stay_whole() {
        let source =
            "let a = \"crate::x\"; // crate::y\nlet b = r#\"super::\"z\"#; '\"' '\\'' &'a self::w";
        assert_eq!(
            words(source),
            "let a = \"crate::x\" ; let b = r#\"super::\"z\"# ; & a self :: w"
        );
    }

    #[test]
    fn what_is_for_tests_alone_is_left_out() {
        let source =
            "use a; #[cfg(test)] use b::{c, d}; #[cfg(test)] mod tests { fn f() {} } fn g() {}";
        assert_eq!(words(source), "use a ; fn g ( ) { }");
        assert_eq!(tokens("#[cfg(test)]\nmod tests;").1, ["tests"]);
    }
}
