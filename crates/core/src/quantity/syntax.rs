//! The syntax of unit texts: text → named factors with exponents and spans.
//!
//! ```text
//! product  = [operand] (("·" | "*" | "." | " " | "/") operand)*
//! operand  = ["√"] primary [power]
//! primary  = name | number | "(" product ")" | "sqrt(" product ")"
//! power    = ("^" | "**") (number | "(" number ["/" number] ")") | superscript | "-" number
//! ```
//!
//! Only a solidus may begin a product without an operand: `/K`. A digit behind a name is a power where the name with it is
//! no unit, which the table of units decides: `m3`.

use std::ops::Range;

use gumption_fault::{Said, say};

use super::dimension::STEPS;
use super::factor::Factor;
use super::faults::{
    AMBIGUOUS_SOLIDUS, BAD_EXPONENT, EMPTY_UNIT, MALFORMED_UNIT, NUMBER_IN_UNIT, UnitError,
};
use super::token::{Kind, Token, tokens};

/// Parentheses deeper than this are a mistake, and the parser recurses.
const DEEPEST: usize = 32;

/// Largest exponent that may be written.
const LARGEST_EXPONENT: i32 = 60;

/// Powers of ten that are units.
const NAMED_RATIOS: [(i32, &str); 4] = [(-2, "%"), (-3, "‰"), (-6, "ppm"), (-9, "ppb")];

/// A unit text taken apart.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parsed {
    /// Named factors from left to right, not merged.
    pub terms: Vec<NamedTerm>,
    /// Product of all numbers.
    pub number: Factor,
    /// Whether the text is one name and nothing else, so that a point unit (°C) keeps its origin.
    pub bare: bool,
}

/// A name with its exponent.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NamedTerm {
    /// The name, with look-alike characters unified.
    pub name: String,
    /// Where it stands in the text.
    pub span: Range<usize>,
    /// Exponent in sixtieths.
    pub exponent: i32,
    /// Whether it stands with neither exponent nor root, so that a digit at its end may be the exponent: `m3`.
    pub plain: bool,
}

impl NamedTerm {
    /// The letters of the name and the digit behind them, which is a power if the name is no unit: `m3`.
    pub fn power_behind(&self) -> Option<(&str, i32)> {
        let name = self.name.as_str();
        let letters = name.strip_suffix(|c: char| ('2'..='9').contains(&c))?;
        let power = i32::from(name.as_bytes()[letters.len()] - b'0');
        let plain = self.plain && !letters.ends_with(|c: char| c.is_ascii_digit());
        plain.then_some((letters, power))
    }
}

/// Which numbers may occur.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Numbers {
    /// Only 1: the unit of a quantity.
    OneOnly,
    /// Any: the definition of a unit.
    Any,
}

/// Takes a unit text apart.
pub(super) fn parse(text: &str, numbers: Numbers) -> Result<Parsed, UnitError> {
    let tokens = tokens(text)?;
    if tokens.is_empty() || ["-", "–", "—"].contains(&text.trim()) {
        return Err(
            UnitError::new(EMPTY_UNIT, 0..text.len(), say!("the unit is empty"))
                .help(say!("write \"1\" for a quantity of dimension one")),
        );
    }
    let bare = matches!(
        tokens.as_slice(),
        [Token {
            kind: Kind::Name(_),
            ..
        }]
    );
    let mut parser = Parser {
        text,
        tokens: &tokens,
        next: 0,
        numbers,
        below: false,
    };
    let product = parser.product(0)?;
    if let Some(token) = parser.peek() {
        if matches!(token.kind, Kind::Power | Kind::Superscript(_)) {
            let message = say!("this is a second exponent");
            return Err(UnitError::new(BAD_EXPONENT, token.span.clone(), message)
                .help(say!("put what it raises in parentheses, as in `(m^2)^3`")));
        }
        return Err(UnitError::new(
            MALFORMED_UNIT,
            token.span.clone(),
            say!("this parenthesis is not open"),
        )
        .help(say!(
            "remove it, or open it before the unit it should enclose"
        )));
    }
    Ok(Parsed {
        terms: product.terms,
        number: product.number,
        bare,
    })
}

struct Parser<'t> {
    text: &'t str,
    tokens: &'t [Token],
    next: usize,
    numbers: Numbers,
    /// Whether what is read stands below a solidus.
    below: bool,
}

/// A partial result.
struct Product {
    terms: Vec<NamedTerm>,
    number: Factor,
}

impl Product {
    fn one() -> Product {
        Product {
            terms: Vec::new(),
            number: Factor::ONE,
        }
    }

    fn append(&mut self, other: Product) {
        self.terms.extend(other.terms);
        self.number = self.number.product(other.number);
    }

    /// Raises to `sixtieths`/60; `None` where an exponent gets out of range.
    fn raised(mut self, sixtieths: i32) -> Option<Product> {
        for term in &mut self.terms {
            let exponent = term.exponent * sixtieths;
            let in_range =
                exponent % STEPS == 0 && (exponent / STEPS).abs() <= LARGEST_EXPONENT * STEPS;
            term.exponent = in_range.then_some(exponent / STEPS)?;
        }
        self.number = self.number.powr(sixtieths, STEPS);
        Some(self)
    }
}

impl Parser<'_> {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next)
    }

    fn eat(&mut self, kind: &Kind) -> Option<Range<usize>> {
        let token = self.peek().filter(|token| token.kind == *kind)?;
        let span = token.span.clone();
        self.next += 1;
        Some(span)
    }

    /// The empty range after the last token read.
    fn here(&self) -> Range<usize> {
        let end = self
            .next
            .checked_sub(1)
            .and_then(|i| self.tokens.get(i))
            .map_or(0, |t| t.span.end);
        end..end
    }

    fn product(&mut self, depth: usize) -> Result<Product, UnitError> {
        let start = self
            .peek()
            .map_or(self.here().start, |token| token.span.start);
        let reciprocal = self.peek().is_some_and(|token| token.kind == Kind::Over);
        let mut result = match reciprocal {
            true => Product::one(),
            false => self.operand(depth)?,
        };
        let mut divided_by_name = None;
        loop {
            if let Some(solidus) = self.eat(&Kind::Over) {
                let divisor_start = self.peek().map_or(solidus.end, |token| token.span.start);
                self.below = !self.below;
                let divisor = self.operand(depth)?;
                self.below = !self.below;
                if !divisor.terms.is_empty() {
                    divided_by_name = Some(divisor_start);
                }
                let inverse = divisor
                    .raised(-STEPS)
                    .ok_or_else(|| self.too_large(solidus))?;
                result.append(inverse);
            } else if let Some(operator) = self.times() {
                if let Some(divisor_start) = divided_by_name {
                    return Err(self.ambiguous(start, divisor_start, operator, depth));
                }
                let factor = self.operand(depth)?;
                result.append(factor);
            } else {
                return Ok(result);
            }
        }
    }

    /// A multiplication sign, or the mere gap before another operand.
    fn times(&mut self) -> Option<Range<usize>> {
        if let Some(span) = self.eat(&Kind::Times) {
            return Some(span);
        }
        let token = self.peek()?;
        let starts_operand = !matches!(token.kind, Kind::Close | Kind::Over | Kind::Power);
        starts_operand.then_some(token.span.start..token.span.start)
    }

    fn ambiguous(
        &mut self,
        start: usize,
        divisor: usize,
        operator: Range<usize>,
        depth: usize,
    ) -> UnitError {
        let before = self.text[start..divisor].trim_end();
        let first = self.text[divisor..operator.start].trim_end();
        let second_start = self.peek().map_or(operator.end, |token| token.span.start);
        let readable = self.operand(depth).is_ok();
        let span = start..self.here().end.max(operator.end);
        let error = UnitError::new(
            AMBIGUOUS_SOLIDUS,
            span.clone(),
            say!("`{}` can be read in two ways", &self.text[span.clone()]),
        );
        if !readable {
            return error.help(say!("put what stands below the solidus in parentheses"));
        }
        let second = &self.text[second_start..span.end];
        let numerator = before.trim_end_matches(['/', '⁄', '∕', '／']).trim_end();
        let one = if numerator.is_empty() { "1" } else { numerator };
        let below = format!("`{one}/({first}·{second})`");
        match numerator {
            "" | "1" => error.help(say!("write {below} or `{second}/{first}`")),
            _ if numerator.contains('/') => {
                error.help(say!("write {below}, or negative exponents"))
            }
            _ => error.help(say!("write {below} or `{numerator}·{second}/{first}`")),
        }
    }

    fn operand(&mut self, depth: usize) -> Result<Product, UnitError> {
        if let Some(root) = self.eat(&Kind::Root) {
            let radicand = self.primary(depth)?;
            if let Some(power) = self
                .peek()
                .filter(|t| matches!(t.kind, Kind::Power | Kind::Superscript(_)))
            {
                return Err(UnitError::new(
                    BAD_EXPONENT,
                    power.span.clone(),
                    say!("is this power under the root or not?"),
                )
                .help(say!(
                    "put what stands under the root in parentheses, as in `√(m^3)`"
                )));
            }
            return radicand
                .raised(STEPS / 2)
                .ok_or_else(|| self.too_large(root));
        }
        let is_name = |token: &Token| matches!(&token.kind, Kind::Name(name) if name != "sqrt");
        let named = self.peek().is_some_and(is_name);
        let mut base = self.primary(depth)?;
        match self.exponent()? {
            Some((sixtieths, span)) => base.raised(sixtieths).ok_or_else(|| self.too_large(span)),
            None => {
                base.terms.iter_mut().for_each(|term| term.plain |= named);
                Ok(base)
            }
        }
    }

    fn primary(&mut self, depth: usize) -> Result<Product, UnitError> {
        let Some(token) = self.peek().cloned() else {
            return Err(self.missing_operand(self.here()));
        };
        self.next += 1;
        match token.kind {
            Kind::Name(name)
                if name == "sqrt" && self.peek().is_some_and(|t| t.kind == Kind::Open) =>
            {
                let radicand = self.primary(depth)?;
                radicand
                    .raised(STEPS / 2)
                    .ok_or_else(|| self.too_large(token.span))
            }
            Kind::Name(name) if self.numbers == Numbers::Any && (name == "pi" || name == "π") => {
                Ok(Product {
                    number: Factor::PI,
                    ..Product::one()
                })
            }
            Kind::Name(name) => {
                let term = NamedTerm {
                    name,
                    span: token.span,
                    exponent: STEPS,
                    plain: false,
                };
                Ok(Product {
                    terms: vec![term],
                    ..Product::one()
                })
            }
            Kind::Number => self.number(token.span),
            Kind::Open => self.parenthesis(token.span, depth),
            Kind::Minus => {
                Err(
                    UnitError::new(MALFORMED_UNIT, token.span, say!("a unit has no minus sign"))
                        .help(say!(
                            "write a product as `N·m`, a negative exponent as `s^-1`"
                        )),
                )
            }
            _ => Err(self.missing_operand(token.span)),
        }
    }

    fn number(&self, span: Range<usize>) -> Result<Product, UnitError> {
        let text = &self.text[span.clone()];
        let factor = Factor::from_decimal(text).ok_or_else(|| {
            UnitError::new(
                NUMBER_IN_UNIT,
                span.clone(),
                say!("`{text}` cannot be a factor of a unit"),
            )
            .help(say!("use a positive number of at most fifteen digits"))
        })?;
        if self.numbers == Numbers::OneOnly && text != "1" {
            let help = self
                .named_ratio(factor, &span)
                .unwrap_or_else(|| self.without_number());
            return Err(UnitError::new(
                NUMBER_IN_UNIT,
                span,
                say!("the number {text} does not belong in a unit"),
            )
            .help(help));
        }
        Ok(Product {
            number: factor,
            ..Product::one()
        })
    }

    /// What becomes of a number that stands in a unit: below a solidus, `g/100g`, it divides.
    fn without_number(&self) -> Said {
        let before = self.tokens[..self.next].iter().rev().skip(1);
        let kinds: Vec<&Kind> = before.map(|token| &token.kind).take(3).collect();
        match kinds[..] {
            [Kind::Over, Kind::Number, Kind::Power] => say!(
                "fractional exponents need parentheses, as in `Hz^(1/2)`; otherwise leave the number out, and divide the value by it"
            ),
            _ if self.below => say!(
                "it stands below the solidus: leave it out, and divide the value by it; or define a unit of your own in the [unit] table"
            ),
            _ => say!(
                "leave it out, and multiply the value by it; or define a unit of your own in the [unit] table"
            ),
        }
    }

    /// The unit that a power of ten is, which was read last: `10^-6/K` is `ppm/K`.
    fn named_ratio(&self, number: Factor, span: &Range<usize>) -> Option<Said> {
        let mut ahead = Parser { ..*self };
        let (sixtieths, _) = ahead.exponent().ok()?.unwrap_or((STEPS, 0..0));
        let factor = number.powr(sixtieths, STEPS);
        let (_, name) = NAMED_RATIOS
            .iter()
            .find(|(ten, _)| factor == Factor::power_of_ten(*ten))?;
        let end = ahead.here().end;
        let (before, power, behind) = (
            &self.text[..span.start],
            &self.text[span.start..end],
            &self.text[end..],
        );
        Some(say!(
            "{power} is the unit {name}: write \"{before}{name}{behind}\""
        ))
    }

    fn parenthesis(&mut self, open: Range<usize>, depth: usize) -> Result<Product, UnitError> {
        if depth >= DEEPEST {
            return Err(UnitError::new(
                MALFORMED_UNIT,
                open,
                say!("the parentheses are nested too deeply"),
            )
            .help(say!("write the unit as a plain product of powers")));
        }
        let inner = self.product(depth + 1)?;
        match self.eat(&Kind::Close) {
            Some(_) => Ok(inner),
            None => Err(UnitError::new(
                MALFORMED_UNIT,
                open,
                say!("this parenthesis is never closed"),
            )
            .help(say!("add `)`"))),
        }
    }

    /// The exponent after an operand, in sixtieths, with its span.
    fn exponent(&mut self) -> Result<Option<(i32, Range<usize>)>, UnitError> {
        if let Some(Token {
            kind: Kind::Superscript(exponent),
            span,
        }) = self.peek().cloned()
        {
            self.next += 1;
            let exponent = exponent.filter(|e| e.unsigned_abs() <= LARGEST_EXPONENT.unsigned_abs());
            let exponent = exponent.ok_or_else(|| self.too_large(span.clone()))?;
            return Ok(Some((exponent * STEPS, span)));
        }
        let caret = match self.eat(&Kind::Power) {
            Some(caret) => caret,
            None => match self.negative_power() {
                Some(start) => start..start,
                None => return Ok(None),
            },
        };
        let value = if self.eat(&Kind::Open).is_some() {
            let numerator = self.signed_number(&caret)?;
            let denominator = match self.eat(&Kind::Over) {
                Some(_) => self.signed_number(&caret)?,
                None => 1.0,
            };
            if self.eat(&Kind::Close).is_none() {
                let span = caret.start..self.here().end;
                return Err(UnitError::new(
                    BAD_EXPONENT,
                    span,
                    say!("this exponent has no closing parenthesis"),
                )
                .help(say!("write it as in `Hz^(1/2)`")));
            }
            numerator / denominator
        } else {
            self.signed_number(&caret)?
        };
        let span = caret.start..self.here().end;
        let sixtieths = value * f64::from(STEPS);
        let whole = (sixtieths - sixtieths.round()).abs() < 1e-9;
        if !whole || value.abs() > f64::from(LARGEST_EXPONENT) {
            return Err(UnitError::new(
                BAD_EXPONENT,
                span.clone(),
                say!(
                    "`{}` is not an exponent that a unit can have",
                    &self.text[span]
                ),
            )
            .help(say!(
                "use a whole number or a simple fraction such as (1/2) or (2/3)"
            )));
        }
        Ok(Some((sixtieths.round() as i32, span)))
    }

    /// Where `-3` begins right behind an operand, as in `kg·m-3`.
    fn negative_power(&self) -> Option<usize> {
        let behind = self.here().end;
        match self.tokens.get(self.next..self.next + 2)? {
            [minus, number]
                if minus.kind == Kind::Minus
                    && number.kind == Kind::Number
                    && minus.span.start == behind
                    && minus.span.end == number.span.start =>
            {
                Some(behind)
            }
            _ => None,
        }
    }

    fn signed_number(&mut self, caret: &Range<usize>) -> Result<f64, UnitError> {
        let sign = if self.eat(&Kind::Minus).is_some() {
            -1.0
        } else {
            1.0
        };
        let number = self.peek().filter(|token| token.kind == Kind::Number);
        let value = number.and_then(|token| self.text[token.span.clone()].parse::<f64>().ok());
        let Some(value) = value else {
            let span = caret.start..self.here().end;
            return Err(UnitError::new(
                BAD_EXPONENT,
                span,
                say!("a number is missing in the exponent"),
            )
            .help(say!("write it as in `m^2`, `s^-1` or `Hz^(1/2)`")));
        };
        self.next += 1;
        Ok(sign * value)
    }

    fn missing_operand(&self, span: Range<usize>) -> UnitError {
        let message = match self.text[span.clone()].trim() {
            "" => say!("a unit is missing at the end"),
            found => say!("a unit is missing before `{found}`"),
        };
        let help = self
            .ratio_behind(&span)
            .unwrap_or_else(|| say!("write a unit as in `m/s^2` or `1/K`"));
        UnitError::new(MALFORMED_UNIT, span, message).help(help)
    }

    /// The unit that a power of ten behind a sign of multiplication is, where nothing stands in front of it: `×10^-6/K` is
    /// `ppm/K`.
    fn ratio_behind(&self, sign: &Range<usize>) -> Option<Said> {
        let is_product = &self.text[sign.clone()] != "/";
        let number = self
            .peek()
            .filter(|token| is_product && token.kind == Kind::Number)?;
        let factor = Factor::from_decimal(&self.text[number.span.clone()])?;
        let behind = Parser {
            next: self.next + 1,
            ..*self
        };
        behind.named_ratio(factor, &(sign.start..number.span.end))
    }

    fn too_large(&self, span: Range<usize>) -> UnitError {
        UnitError::new(
            BAD_EXPONENT,
            span,
            say!("this makes an exponent that no unit can have"),
        )
        .help(say!(
            "exponents are simple fractions between -{LARGEST_EXPONENT} and {LARGEST_EXPONENT}"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terms(text: &str) -> String {
        let parsed = parse(text, Numbers::OneOnly).unwrap();
        parsed
            .terms
            .iter()
            .map(|t| format!("{}:{} ", t.name, f64::from(t.exponent) / 60.0))
            .collect()
    }

    fn error(text: &str) -> (Range<usize>, String, String) {
        let error = parse(text, Numbers::OneOnly).unwrap_err();
        (
            error.span,
            error.message.to_string(),
            error.help.unwrap_or_default().to_string(),
        )
    }

    #[test]
    fn exponents_have_an_end() {
        for text in ["m⁶¹", "m^-61", "m⁻²¹⁴⁷⁴⁸³⁶⁴⁸"] {
            let (_, message, _) = error(text);
            assert!(message.contains("exponent"), "{text}: {message}");
        }
    }

    #[test]
    fn all_spellings_of_an_acceleration_are_the_same() {
        for text in [
            "m/s^2",
            "m·s^-2",
            "m*s**-2",
            "m s^-2",
            "m/s²",
            "m·s⁻²",
            "m⋅s^(-2)",
            "m/s/s",
            "m/(s s)",
            "m/(s^2)",
            " m / s ^ 2 ",
            "m s⁻²",
            "m×s^-2.0",
            "m／s²",
            "(m/s^2)",
            "m·s^−2",
            "m.s-2",
            "m s−2",
        ] {
            let total: i32 = parse(text, Numbers::OneOnly)
                .unwrap()
                .terms
                .iter()
                .map(|t| t.exponent)
                .sum();
            assert_eq!(total, -STEPS, "{text}");
        }
        assert_eq!(terms("m/s^2"), "m:1 s:-2 ");
    }

    #[test]
    fn roots_and_fractions() {
        for text in [
            "V/√Hz",
            "V/sqrt(Hz)",
            "V/Hz^(1/2)",
            "V/Hz^0.5",
            "V·Hz^-0.5",
            "V Hz^(-1/2)",
            "V/√(Hz)",
        ] {
            assert_eq!(terms(text), "V:1 Hz:-0.5 ", "{text}");
        }
        assert_eq!(terms("(m^2/s)^(1/2)"), "m:1 s:-0.5 ");
        assert_eq!(terms("m/s²/√Hz"), "m:1 s:-2 Hz:-0.5 ");
    }

    #[test]
    fn one_is_a_numerator_or_stands_alone() {
        assert_eq!(terms("1"), "");
        assert_eq!(terms("1/K"), "K:-1 ");
        assert_eq!(terms("/K"), "K:-1 ");
        assert_eq!(terms("W/(/K)"), "W:1 K:1 ");
        assert!(parse("°C", Numbers::OneOnly).unwrap().bare);
        assert!(!parse("1/°C", Numbers::OneOnly).unwrap().bare);
    }

    #[test]
    fn definitions_may_hold_numbers() {
        let parsed = parse("1/65536 V", Numbers::Any).unwrap();
        assert_eq!(parsed.number.value(), 1.0 / 65536.0);
        assert_eq!(parsed.terms.len(), 1);
        assert_eq!(
            parse("2 pi rad", Numbers::Any).unwrap().number.value(),
            std::f64::consts::TAU
        );
        assert_eq!(parse("10^-6 m", Numbers::Any).unwrap().number.value(), 1e-6);
    }

    #[test]
    fn a_product_below_the_solidus_needs_parentheses() {
        let (span, message, help) = error("W/m·K");
        assert_eq!(span, 0..6);
        assert_eq!(message, "`W/m·K` can be read in two ways");
        assert_eq!(help, "write `W/(m·K)` or `W·K/m`");
        assert_eq!(error("J/kg K").2, "write `J/(kg·K)` or `J·K/kg`");
        assert_eq!(error("1/s m").2, "write `1/(s·m)` or `m/s`");
        assert_eq!(
            error("J/kg·").2,
            "put what stands below the solidus in parentheses"
        );
    }

    #[test]
    fn faults_point_at_their_place() {
        assert_eq!(error("").2, "write \"1\" for a quantity of dimension one");
        assert_eq!(error("-").2, "write \"1\" for a quantity of dimension one");
        assert_eq!(error("  ").0, 0..2);
        assert_eq!(error("m/").1, "a unit is missing at the end");
        assert_eq!(error("/").0, 1..1);
        assert_eq!(error("m//s").0, 2..3);
        assert_eq!(error("/K·m").2, "write `1/(K·m)` or `m/K`");
        assert_eq!(error("m/(s").0, 2..3);
        assert_eq!(error("m)").0, 1..2);
        assert_eq!(error("m^x").1, "a number is missing in the exponent");
        assert_eq!(error("m^0.7123").0, 1..8);
        assert_eq!(error("m^(1/0)").0, 1..7);
        assert_eq!(error("m^999").0, 1..5);
        assert_eq!(error("(m^60)^60").0, 6..9);
        assert_eq!(error("10 V").1, "the number 10 does not belong in a unit");
        for text in [
            "1e-6/K",
            "10^-6/K",
            "10⁻⁶/K",
            "10-6/K",
            "0.000001/K",
            "×10^-6/K",
            "·10⁻⁶/K",
        ] {
            assert!(error(text).2.ends_with("write \"ppm/K\""), "{text}");
        }
        assert_eq!(error("m//10^-6").2, "write a unit as in `m/s^2` or `1/K`");
        assert_eq!(
            error("m/10^3/K").2,
            "it stands below the solidus: leave it out, and divide the value by it; or define a unit of your own in the [unit] table"
        );
        for (text, what) in [
            ("g/100g", "divide the value"),
            ("L/(100km)", "divide the value"),
            ("m/(s/100g)", "multiply the value"),
            ("100 g/L", "multiply the value"),
            ("m^2/100 g", "divide the value"),
        ] {
            assert!(error(text).2.contains(what), "{text}: {}", error(text).2);
        }
        assert_eq!(error("s^1/2").0, 4..5);
        assert!(error("s^1/2").2.starts_with("fractional exponents"));
        assert_eq!(
            error("N-m").2,
            "write a product as `N·m`, a negative exponent as `s^-1`"
        );
        assert_eq!(error("√Hz^2").0, 5..6);
        assert_eq!(error("m&s").0, 1..2);
        assert_eq!(
            error("m^(1/2").1,
            "this exponent has no closing parenthesis"
        );
        assert!(error(&"(".repeat(100_000)).1.contains("nested too deeply"));
    }
}
