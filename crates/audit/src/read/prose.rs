//! Budgets without a table: one line for each quantity, `m_S = 100 g: certificate, U = 0.05 g, k = 2`.

use crate::claim::{Row, Stated};
use crate::printed::{Place, Printed, leading};

use super::footer;
use super::kind::{self, Evidence};
use super::words::has;

/// A line that says what is known of a quantity, as a row.
pub fn row(text: &str, at: Place) -> Option<Row> {
    let text = unnumbered(text);
    let end = [text.find([':', '=', ';']), text.find(" - ")]
        .into_iter()
        .flatten()
        .min()?;
    let head = text[..end].trim();
    let mut rest = text[end..]
        .trim_start_matches([':', '=', ';', ' ', '-'])
        .trim_start();
    let of_the_whole = [
        "cmc",
        "correlat",
        "相关",
        "model",
        "equation",
        "模型",
        "coverage",
        "包含因子",
        "修约",
        "round",
        "note",
        "注",
    ];
    if has(&head.to_lowercase(), &of_the_whole) {
        return None;
    }
    let long = head.chars().count() > 48;
    if head.is_empty() || long || footer::label(head, "").is_some() {
        return None;
    }
    let mut value = None;
    if text[end..].starts_with('=') {
        let (figure, behind) = leading(rest)?;
        let stop = behind.find([':', ';', ',', '(']).unwrap_or(behind.len());
        let unit = behind[..stop].trim();
        if !unit.is_empty() && crate::units::parse(unit).is_none() {
            return None;
        }
        rest = behind[stop..].trim_start_matches([':', ';', ',', ' ']);
        let unit = unit.to_string();
        value = Some(crate::printed::Printed { unit, ..figure }.at(at));
    }
    let is_symbol = !head.contains(' ') && head.chars().count() <= 12;
    let (symbol, name) = if is_symbol { (head, "") } else { ("", head) };
    let (rest, u) = result_of(rest);
    let u = u.map(|u| u.at(at));
    let words = if is_symbol {
        rest.to_string()
    } else {
        format!("{head}; {rest}")
    };
    let (stated, _) = kind::stated(&Evidence {
        words: &words,
        ..Evidence::default()
    });
    let c = coefficient(&words).map(|c| c.at(at));
    let known = !matches!(stated, Stated::Nothing);
    known.then(|| Row {
        symbol: symbol.into(),
        name: name.into(),
        at,
        value,
        u,
        c,
        words,
        ..Row::default()
    })
}

/// The sensitivity coefficient, where a clause states one.
fn coefficient(words: &str) -> Option<Printed> {
    const NAMES: [&str; 5] = [
        "sensitivity coefficient",
        "sensitivity",
        "灵敏系数",
        "c_i =",
        "c =",
    ];
    let clauses = words.split([';', ',']).map(str::trim);
    let behind = |clause: &str| {
        let name = NAMES
            .iter()
            .find(|name| clause.to_lowercase().starts_with(**name))?;
        let rest = clause.get(name.len()..)?;
        let figure = rest
            .rsplit_once(['=', ':'])
            .map_or(rest, |(_, figure)| figure);
        leading(figure.trim_start()).map(|(figure, _)| figure)
    };
    clauses.filter_map(behind).next()
}

/// What leads to a standard uncertainty, and the uncertainty: `step 0.01 bar -> 0.0029 bar`.
fn result_of(text: &str) -> (&str, Option<Printed>) {
    const ARROWS: [&str; 5] = ["->", "=>", "→", "⇒", "➔"];
    let arrow = ARROWS
        .iter()
        .find_map(|arrow| text.rsplit_once(*arrow))
        .and_then(|(front, behind)| {
            // `-> u = 0.0029 bar`
            let figure = behind.rsplit_once('=').map_or(behind, |(_, figure)| figure);
            Some((front, Printed::parse(figure.trim())?))
        });
    arrow.map_or((text, None), |(front, u)| (front, Some(u)))
}

/// A line without the mark or the number of a list.
fn unnumbered(text: &str) -> &str {
    let text = text.trim_start_matches(['-', '*', '•', ' ']);
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    let behind = &text[digits..];
    let numbered =
        digits > 0 && digits <= 2 && behind.starts_with(['.', ')']) && behind[1..].starts_with(' ');
    if numbered {
        behind[1..].trim_start()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_rows() {
        let read = |text: &str| row(text, Place::default());
        let standard =
            read("m_S = 100.0005 g: mass of the standard, certificate U = 0.05 g, k = 2").unwrap();
        assert_eq!(
            (standard.symbol.as_str(), standard.value.unwrap().value),
            ("m_S", 100.0005)
        );
        assert!(read("2. dT: limits ±0.3 K").is_some());
        assert!(read("u_c = 0.05 g").is_none() && read("Model: m = m_S + dT").is_none());
        assert!(read("Coverage factor: k = 2").is_none() && read("A budget").is_none());
    }
}
