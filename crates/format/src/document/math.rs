//! Formulas as they are set in mathematics: fractions, powers, roots and indices, from a line of the model language. A line
//! that is none stays as it is written.

/// A part of a formula.
#[derive(Debug, Clone, PartialEq)]
pub enum Math {
    /// A name with its index: `V_ref` is V with the index ref.
    Name(String, Option<String>),
    /// A number as it is written.
    Number(String),
    /// A sign.
    Sign(&'static str),
    /// Words that stand upright, with the room about them: a unit, `and`, a comment.
    Words(String),
    /// Parts side by side.
    Row(Vec<Math>),
    /// A part in brackets: which bracket opens, what stands inside, which closes.
    Group(&'static str, Box<Math>, &'static str),
    /// One part over another.
    Fraction(Box<Math>, Box<Math>),
    /// A power.
    Power(Box<Math>, Box<Math>),
    /// A square root.
    Root(Box<Math>),
}

impl Math {
    /// The formula of a line; `None` where the line is no formula.
    pub fn of(line: &str) -> Option<Math> {
        let tokens = tokens(line)?;
        let mut parser = Parser {
            tokens: &tokens,
            at: 0,
            depth: 0,
        };
        let formula = parser.condition()?;
        match &tokens[parser.at..] {
            [] => Some(formula),
            [Token::Comment(comment)] => {
                let comment = Math::Words(format!("{SPACE}{SPACE}{comment}"));
                Some(row(vec![formula, comment]))
            }
            _ => None,
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Name(String),
    Number(String),
    Sign(&'static str),
    /// A unit without its quotes.
    Unit(String),
    /// The rest of the line behind `#`, and that.
    Comment(String),
}

/// Signs as they are written and as they are set; longer ones first.
const SIGNS: &[(&str, &str)] = &[
    ("**", "^"),
    ("==", "="),
    ("<=", "≤"),
    (">=", "≥"),
    ("!=", "≠"),
    ("+", "+"),
    ("-", "−"),
    ("−", "−"),
    ("*", "·"),
    ("·", "·"),
    ("×", "·"),
    ("/", "/"),
    ("^", "^"),
    ("=", "="),
    ("<", "<"),
    (">", ">"),
    ("(", "("),
    (")", ")"),
    ("[", "["),
    ("]", "]"),
    (",", ","),
];

fn tokens(line: &str) -> Option<Vec<Token>> {
    let mut tokens = Vec::new();
    let mut rest = line.trim();
    while let Some(first) = rest.chars().next() {
        if let Some(quoted) = rest.strip_prefix('\'') {
            let (unit, behind) = quoted.split_once('\'')?;
            tokens.push(Token::Unit(unit.to_owned()));
            rest = behind;
        } else if first == '#' {
            tokens.push(Token::Comment(rest.to_owned()));
            rest = "";
        } else if let Some((sign, set)) = SIGNS.iter().find(|(sign, _)| rest.starts_with(sign)) {
            tokens.push(Token::Sign(set));
            rest = &rest[sign.len()..];
        } else if first.is_ascii_digit() || first == '.' {
            let end = number_end(rest);
            tokens.push(Token::Number(rest[..end].to_owned()));
            rest = &rest[end..];
        } else if first.is_alphabetic() || first == '_' {
            let part = |c: char| c.is_alphanumeric() || "_'′.".contains(c);
            let end = rest.find(|c| !part(c)).unwrap_or(rest.len());
            tokens.push(Token::Name(rest[..end].to_owned()));
            rest = &rest[end..];
        } else {
            return None;
        }
        rest = rest.trim_start();
    }
    Some(tokens)
}

/// Room that does not end a line.
const SPACE: char = '\u{a0}';

/// Where a number ends: `1.5e-3`.
fn number_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        let more = bytes[from..].iter();
        from + more
            .take_while(|b| b.is_ascii_digit() || **b == b'.' || **b == b'_')
            .count()
    };
    let end = digits(0);
    if !matches!(bytes.get(end), Some(b'e' | b'E')) {
        return end;
    }
    let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
    match bytes.get(end + 1 + sign) {
        Some(digit) if digit.is_ascii_digit() => digits(end + 1 + sign),
        _ => end,
    }
}

struct Parser<'t> {
    tokens: &'t [Token],
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn sign(&self) -> Option<&'static str> {
        match self.tokens.get(self.at)? {
            Token::Sign(sign) => Some(sign),
            _ => None,
        }
    }

    fn take(&mut self, signs: &[&str]) -> Option<&'static str> {
        let sign = self.sign().filter(|sign| signs.contains(sign))?;
        self.at += 1;
        Some(sign)
    }

    /// A word of the language, with room on both sides.
    fn keyword(&mut self, keywords: &[&str]) -> Option<Math> {
        match self.tokens.get(self.at)? {
            Token::Name(name) if keywords.contains(&name.as_str()) => {
                self.at += 1;
                Some(Math::Words(format!("{SPACE}{name}{SPACE}")))
            }
            _ => None,
        }
    }

    /// Relations with `and` and `or` between them.
    fn condition(&mut self) -> Option<Math> {
        let mut parts = vec![self.relation()?];
        while let Some(word) = self.keyword(&["and", "or"]) {
            parts.push(word);
            parts.push(self.relation()?);
        }
        Some(row(parts))
    }

    /// Sums with signs of relation between them.
    fn relation(&mut self) -> Option<Math> {
        let mut parts = vec![self.sum()?];
        while let Some(sign) = self.take(&["=", "<", ">", "≤", "≥", "≠"]) {
            parts.push(Math::Sign(sign));
            parts.push(self.sum()?);
        }
        Some(row(parts))
    }

    fn sum(&mut self) -> Option<Math> {
        let mut parts = Vec::new();
        if let Some(sign) = self.take(&["+", "−"]) {
            parts.push(Math::Sign(sign));
        }
        parts.push(self.product()?);
        while let Some(sign) = self.take(&["+", "−"]) {
            parts.push(Math::Sign(sign));
            parts.push(self.product()?);
        }
        Some(row(parts))
    }

    fn product(&mut self) -> Option<Math> {
        let (before, mut parts) = (self.depth, vec![self.power()?]);
        while let Some(sign) = self.take(&["·", "/"]) {
            let next = self.power()?;
            if sign == "/" {
                self.deeper()?;
                // All that stands before is divided: a·b/c is (a·b)/c.
                let above = bare(row(std::mem::take(&mut parts)));
                parts.push(Math::Fraction(Box::new(above), Box::new(bare(next))));
            } else {
                parts.extend([Math::Sign("·"), next]);
            }
        }
        self.depth = before;
        Some(row(parts))
    }

    fn power(&mut self) -> Option<Math> {
        let before = self.depth;
        self.deeper()?;
        let power = self.raised();
        self.depth = before;
        power
    }

    /// One part inside another.
    fn deeper(&mut self) -> Option<()> {
        /// Deeper formulas are not read by people, either.
        const DEEPEST: usize = 40;
        self.depth += 1;
        (self.depth <= DEEPEST).then_some(())
    }

    fn raised(&mut self) -> Option<Math> {
        if self.take(&["−"]).is_some() {
            return Some(row(vec![Math::Sign("−"), self.power()?]));
        }
        let base = self.primary()?;
        if self.take(&["^"]).is_none() {
            return Some(base);
        }
        let exponent = bare(self.power()?);
        Some(Math::Power(Box::new(base), Box::new(exponent)))
    }

    fn primary(&mut self) -> Option<Math> {
        if let Some(not) = self.keyword(&["not"]) {
            return Some(row(vec![not, self.power()?]));
        }
        let token = self.tokens.get(self.at)?.clone();
        self.at += 1;
        match token {
            Token::Name(name) if name == "if" && self.sign() != Some("(") => self.choice(),
            Token::Comment(_) => None,
            Token::Unit(unit) => Some(Math::Words(unit)),
            Token::Number(number) => Some(match self.tokens.get(self.at) {
                Some(Token::Unit(unit)) => {
                    let unit = Math::Words(format!("{SPACE}{unit}"));
                    self.at += 1;
                    row(vec![Math::Number(number), unit])
                }
                _ => Math::Number(number),
            }),
            Token::Sign("(") => self.inside("(", ")"),
            Token::Sign("[") => self.inside("[", "]"),
            Token::Sign(_) => None,
            Token::Name(name) => match self.take(&["(", "["]) {
                None => Some(named(&name)),
                Some("(") => {
                    let arguments = self.inside("(", ")")?;
                    Some(match (name.as_str(), arguments) {
                        ("sqrt", Math::Group(_, inside, _)) => Math::Root(inside),
                        (_, arguments) => row(vec![named(&name), arguments]),
                    })
                }
                Some(_) => {
                    let index = self.inside("[", "]")?;
                    Some(row(vec![named(&name), index]))
                }
            },
        }
    }

    /// `if c then a else b`, behind its first word.
    fn choice(&mut self) -> Option<Math> {
        let condition = self.condition()?;
        let then = self.keyword(&["then"])?;
        let holds = self.condition()?;
        let otherwise = self.keyword(&["else"])?;
        let first = Math::Words(format!("if{SPACE}"));
        Some(row(vec![
            first,
            condition,
            then,
            holds,
            otherwise,
            self.condition()?,
        ]))
    }

    /// What stands between brackets, the first of which is taken already; several parts with commas.
    fn inside(&mut self, open: &'static str, close: &'static str) -> Option<Math> {
        let mut parts = Vec::new();
        if self.take(&[close]).is_none() {
            loop {
                parts.push(self.condition()?);
                match self.take(&[",", close])? {
                    "," => parts.push(Math::Sign(",")),
                    _ => break,
                }
            }
        }
        Some(Math::Group(open, Box::new(row(parts)), close))
    }
}

/// One part alone is no row.
fn row(mut parts: Vec<Math>) -> Math {
    match parts.len() {
        1 => parts.remove(0),
        _ => Math::Row(parts),
    }
}

/// Without brackets that a fraction or an exponent makes needless.
fn bare(math: Math) -> Math {
    match math {
        Math::Group("(", inside, _) => *inside,
        other => other,
    }
}

/// A name with what stands behind its first underscore as index.
fn named(name: &str) -> Math {
    match name.split_once('_') {
        Some((base, index)) if !base.is_empty() && !index.is_empty() => {
            Math::Name(base.to_owned(), Some(index.to_owned()))
        }
        _ => Math::Name(name.to_owned(), None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A formula on one line, brackets for every part that is set apart.
    fn told(math: &Math) -> String {
        match math {
            Math::Name(name, None) => name.clone(),
            Math::Name(name, Some(index)) => format!("{name}_{{{index}}}"),
            Math::Number(number) => number.clone(),
            Math::Sign(sign) => (*sign).to_owned(),
            Math::Words(words) => words.clone(),
            Math::Row(parts) => parts.iter().map(told).collect(),
            Math::Group(open, inside, close) => format!("{open}{}{close}", told(inside)),
            Math::Fraction(above, below) => format!("{{{}|{}}}", told(above), told(below)),
            Math::Power(base, exponent) => format!("{}^{{{}}}", told(base), told(exponent)),
            Math::Root(inside) => format!("√{{{}}}", told(inside)),
        }
    }

    #[test]
    fn formulas_are_set() {
        for (line, set) in [
            ("R = V / I", "R={V|I}"),
            ("R_x = a*b/c/d", "R_{x}={{a·b|c}|d}"),
            ("y = (a + b) / (c - d)", "y={a+b|c−d}"),
            ("y = sqrt(x^2 + 1.5e-3)", "y=√{x^{2}+1.5e-3}"),
            ("y = -x^-2 * (a/b)^n", "y=−x^{−2}·({a|b})^{n}"),
            ("f(x, t) = mean(x[1])", "f(x,t)=mean(x[1])"),
            ("长度 = a_1", "长度=a_{1}"),
            ("y = a * (t - 20 '°C')", "y=a·(t−20\u{a0}°C)"),
            ("z = value_in(x, 'mm') / 2", "z={value_{in}(x,mm)|2}"),
            ("y = a + b  # of both", "y=a+b\u{a0}\u{a0}# of both"),
            (
                "y = if not (a > 0 and b > 0) then a else 2 * b",
                "y=if\u{a0}\u{a0}not\u{a0}(a>0\u{a0}and\u{a0}b>0)\u{a0}then\u{a0}a\u{a0}else\u{a0}2·b",
            ),
        ] {
            assert_eq!(
                Math::of(line).as_ref().map(told).as_deref(),
                Some(set),
                "{line}"
            );
        }
    }

    #[test]
    fn other_lines_stay_as_they_are() {
        for line in [
            "",
            "a b",
            "see above: y",
            "(a",
            "a +",
            "y = {x}",
            "# of nothing",
            "y = 'mm",
            "\"a\"",
            "a // b",
        ] {
            assert_eq!(Math::of(line), None, "{line}");
        }
        let deep = format!("{}x{}", "(".repeat(5000), ")".repeat(5000));
        assert_eq!(Math::of(&deep), None);
        assert_eq!(Math::of(&format!("{}x", "-".repeat(100_000))), None);
        assert_eq!(Math::of(&format!("x{}", "^x".repeat(100_000))), None);
        assert_eq!(Math::of(&format!("x{}", "/x".repeat(100_000))), None);
    }
}
