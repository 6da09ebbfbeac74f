//! Budgets without a table: one line for each quantity, `m_S = 100 g: certificate, U = 0.05 g, k = 2`, or a sentence.

use crate::claim::{Row, Stated};
use crate::printed::{Place, Printed, leading};

use super::footer;
use super::kind::{self, Evidence};
use super::words::{figure_after, figures_with_units, has, lowered};

/// Heads of lines that are about the whole.
const OF_THE_WHOLE: [&str; 12] = [
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

/// Symbols of what is known of a quantity.
const KNOWN: [&str; 8] = ["U", "u", "U95", "s", "s_p", "a", "d", "MPE"];

/// The longest head of a line.
const HEAD: usize = 48;

/// A line that says what is known of a quantity, as a row.
pub fn row(text: &str, at: Place) -> Option<Row> {
    let text = unnumbered(text);
    if let Some(row) = bracketed(text, at) {
        return Some(row);
    }
    let (text, u) = match (result_of(text), concluded(text)) {
        ((_, None), Some((words, u))) if !begins_with_symbol(words) => {
            let calculation = text.get(words.len()..).unwrap_or_default();
            return of_conclusion(words, u.at(at), at).map(|row| with_product(row, calculation));
        }
        ((_, None), Some((words, u))) => (words, Some(u)),
        ((words, Some(u)), _) if is_named_in_words(words) => {
            return of_conclusion(words, u.at(at), at);
        }
        (of_arrow, _) => of_arrow,
    };
    let u = u.map(|u| u.at(at));
    let end = end_of_head(text)?;
    let head = text[..end].trim();
    let mut rest = text[end..]
        .trim_start_matches([':', '=', ';', ' ', '-'])
        .trim_start();
    if !is_name(head) {
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
    let is_symbol = is_symbol(head);
    let (symbol, name) = if is_symbol { (head, "") } else { ("", head) };
    let words = if is_symbol {
        rest.to_string()
    } else {
        format!("{head}; {rest}")
    };
    let (stated, _) = kind::stated(&Evidence {
        words: &words,
        u: u.as_ref(),
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

/// `u1 (reference standard, U = 0.010 kPa, k = 2) = 0.0050 kPa`: what is known stands in the bracket, u behind it.
fn bracketed(text: &str, at: Place) -> Option<Row> {
    let (symbol, rest) = text.split_once('(')?;
    let (words, behind) = rest.rsplit_once(')')?;
    let u = Printed::parse(behind.trim_start().strip_prefix('=')?.trim())?;
    let symbol = symbol.trim();
    let of_row =
        symbol.starts_with('u') && is_symbol(symbol) && footer::label(symbol, "").is_none();
    let evidence = Evidence {
        words,
        u: Some(&u),
        ..Evidence::default()
    };
    let (stated, _) = kind::stated(&evidence);
    (of_row && !matches!(stated, Stated::Nothing)).then(|| Row {
        symbol: symbol.into(),
        at,
        words: words.into(),
        u: Some(u.at(at)),
        ..Row::default()
    })
}

/// Where the head of a line ends.
fn end_of_head(text: &str) -> Option<usize> {
    let ends = [text.find([':', '=', ';']), text.find(" - ")];
    ends.into_iter().flatten().min()
}

/// Whether a line names its quantity in words behind which stands what is known, and no estimate: `repeatability, s = 0.12 N of 5
/// readings`, `resolution 0.2 N`.
fn is_named_in_words(text: &str) -> bool {
    let Some(end) = end_of_head(text) else {
        return text.starts_with(char::is_alphabetic);
    };
    let of_estimate = || {
        let mut words = text[..end]
            .split([' ', ','])
            .filter(|word| !word.is_empty());
        let last = words.next_back();
        words.next().is_none() || !last.is_some_and(|last| KNOWN.contains(&last))
    };
    text[end..].starts_with('=') && !of_estimate()
}

fn is_symbol(head: &str) -> bool {
    !head.contains([' ', ',']) && head.chars().count() <= 12
}

fn begins_with_symbol(text: &str) -> bool {
    end_of_head(text).is_some_and(|end| is_symbol(text[..end].trim()))
}

/// Whether what a line begins with may be the name of a quantity.
fn is_name(head: &str) -> bool {
    let long = head.chars().count() > HEAD;
    let of_the_whole = has(&head.to_lowercase(), &OF_THE_WHOLE);
    // `The resolution is 0.5 N; half of it …`: a sentence.
    let verbs = [" is ", " are ", " was ", " has ", " have "];
    let is_sentence = verbs.iter().any(|verb| head.contains(verb));
    let is_label = footer::label(head, "").is_some();
    !head.is_empty() && !long && !of_the_whole && !is_sentence && !is_label
}

/// A line that ends in the standard uncertainty which it comes to, as a row.
fn of_conclusion(words: &str, u: Printed, at: Place) -> Option<Row> {
    let ends = |c: char| ":,;=±(".contains(c) || c.is_ascii_digit();
    let name = &words[..words.find(ends).unwrap_or(words.len())];
    // `天平分辨力引入的标准不确定度`: about the resolution.
    let of_u = ["引入的标准不确定度", "的标准不确定度"];
    let end = of_u.iter().find_map(|words| name.find(words));
    let name = name[..end.unwrap_or(name.len())].trim();
    // `standard U = 0.1 g` is about the standard.
    let mut called = KNOWN.iter();
    let called = called.find_map(|symbol| name.strip_suffix(symbol)?.strip_suffix(' '));
    let name = called.unwrap_or(name);
    // `The comparator has an error limit of ±0.030 µm: u2 = …` is about the comparator.
    let name = match is_name(name) {
        true => name,
        false => subject(words)?,
    };
    let row = Row {
        name: name.into(),
        at,
        c: coefficient(words).map(|c| c.at(at)),
        words: words.into(),
        u: Some(u),
        ..Row::default()
    };
    is_name(name).then_some(row)
}

/// The row whose u is the product with its coefficient, as its calculation says, `u3 = 0.05/√3 × 1.15 = 0.0332`: that is the
/// contribution.
fn with_product(row: Row, calculation: &str) -> Row {
    let Some(c) = &row.c else {
        return row;
    };
    let is_c = |text: &str| leading(text.trim()).is_some_and(|(figure, _)| figure.value == c.value);
    let is_product = ['×', '·', '*'].iter().any(|mark| {
        let mut factors = calculation.split(*mark);
        let first = factors.next().unwrap_or_default();
        // The first factor stands behind the name.
        let first = first.rsplit('=').next().unwrap_or_default();
        calculation.contains(*mark) && (is_c(first) || factors.any(is_c))
    });
    match is_product {
        true => Row {
            contribution: row.u.clone(),
            u: None,
            ..row
        },
        false => row,
    }
}

/// A sentence that says what is known of a quantity, as a row: it has a figure, and what the figure is.
pub fn sentence(text: &str, at: Place) -> Option<Row> {
    const MARKS: [&str; 8] = [
        "resolution",
        "分辨力",
        "within",
        "standard deviation",
        "standard uncertainty",
        "half-width",
        "标准差",
        "标准不确定度",
    ];
    const OF_U: [&str; 2] = ["standard uncertainty", "标准不确定度"];
    let lower = lowered(text);
    let marked = lower.contains(['=', '±']) || has(&lower, &MARKS);
    let whole = ["combined", "合成", "result", "结果"];
    if !marked || has(&lower, &whole) || figure_after(text, &["expanded uncertainty is"]).is_some()
    {
        return None;
    }
    let u = figure_after(text, &OF_U).filter(|u| crate::units::parse(&u.unit).is_some());
    // What leads to a standard uncertainty says what is known, and not the clause that has it.
    let conclusion = u
        .as_ref()
        .and_then(|_| OF_U.iter().find_map(|key| lower.find(key)));
    let front = conclusion.and_then(|at| text.get(..text.get(..at)?.rfind([',', ';'])?));
    let evidence = Evidence {
        words: front.unwrap_or(text),
        u: u.as_ref(),
        ..Evidence::default()
    };
    let (stated, _) = kind::stated(&evidence);
    let name = subject(text)?;
    let known = !matches!(stated, Stated::Nothing) && is_name(name);
    known.then(|| Row {
        name: name.into(),
        at,
        u: u.map(|u| u.at(at)),
        words: front.unwrap_or(text).into(),
        ..Row::default()
    })
}

/// What a sentence is about: `The expanded uncertainty of the standard is …` is about the standard.
fn subject(text: &str) -> Option<&str> {
    const LEADS: [&str; 9] = [
        " is ", " are ", " was ", " has ", " have ", " may ", " of ", "为", "的",
    ];
    const OF: [&str; 3] = [
        "expanded uncertainty of ",
        "half-width of ",
        "standard uncertainty of ",
    ];
    let text = text.strip_prefix("The ").unwrap_or(text);
    let lower = text.to_lowercase();
    let lead = OF.iter().find(|kind| lower.starts_with(**kind));
    let text = lead.and_then(|kind| text.get(kind.len()..)).unwrap_or(text);
    let text = text.strip_prefix("the ").unwrap_or(text);
    let end = LEADS.iter().filter_map(|lead| text.find(lead)).min()?;
    Some(text[..end].trim())
}

/// Whether a sentence states an uncertainty, whatever it is of.
pub fn states_uncertainty(text: &str) -> bool {
    const WORDS: [&str; 6] = [
        "uncertainty",
        "deviation",
        "half-width",
        "不确定度",
        "标准差",
        "偏差",
    ];
    has(&text.to_lowercase(), &WORDS)
        && figures_with_units(text).any(|figure| !figure.unit.is_empty())
}

/// The sentences of a line.
pub fn sentences(line: &str) -> impl Iterator<Item = &str> {
    let parts = line.split_inclusive(['。']).flat_map(|part| {
        let mut rest = Some(part);
        std::iter::from_fn(move || {
            let text = rest?;
            let end = text.match_indices(". ").map(|(at, _)| at + 1).next();
            rest = end.map(|end| text[end..].trim_start());
            Some(&text[..end.unwrap_or(text.len())])
        })
    });
    parts.map(str::trim).filter(|text| !text.is_empty())
}

/// What leads to a standard uncertainty in the last clause, and the uncertainty:
/// `limits ±0.02 °C, u(t) = 0.02/√3 = 0.0115 °C`. U of a certificate in small letters has its k behind it.
fn concluded(text: &str) -> Option<(&str, Printed)> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut names = text.match_indices('u').filter_map(|(at, _)| {
        let length = text[at..].find(|c| !is_part(c))?;
        let name = &text[at..at + length];
        let free = !text[..at].chars().next_back().is_some_and(is_part);
        let index = name[1..].trim_start_matches('_');
        let is_index = index.len() < name.len() - 1 && index.len() <= 4
            || index.bytes().all(|b| b.is_ascii_digit())
            || index.len() == 1 && index.bytes().all(|b| b.is_ascii_uppercase());
        let of_the_whole = footer::label(name, "").is_some() && name != "u" || index == "95";
        (free && is_index && !of_the_whole).then_some((at, name))
    });
    let (at, name) = names.next_back()?;
    let behind = &text[at..];
    let has_factor = ["k=", "k ="].iter().any(|k| behind.contains(k));
    let figure = footer::assigned(behind, name).filter(|_| !has_factor)?;
    let leads = |c: char| ",;:. (则故得".contains(c);
    Some((text[..at].trim_end_matches(leads), figure))
}

/// Whether a line is nothing but the equation of a standard uncertainty: `u_B = 0.0045/√3 = 0.0026 V`.
pub(super) fn is_conclusion(text: &str) -> bool {
    let lead = concluded(text).map(|(front, _)| front);
    lead.is_some_and(|front| front.trim().is_empty()) && !text.contains([',', ';', ':'])
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
    let bracketed = text
        .strip_prefix('(')
        .and_then(|rest| rest.split_once(')'))
        .filter(|(number, _)| (1..=2).contains(&number.len()));
    if let Some((_, behind)) = bracketed {
        return behind.trim_start();
    }
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.');
    let (number, behind) = text.split_at(end.unwrap_or(text.len()));
    let closed = number.ends_with('.') || behind.starts_with([')', '、']);
    let levels = number.trim_end_matches('.').split('.');
    let are_short = levels.clone().all(|level| (1..=2).contains(&level.len()));
    let behind = behind.trim_start_matches([')', '、']);
    // `3.1 Resolution`, and no `0.5 mm`.
    let is_section = || {
        let word = behind.split_whitespace().next().unwrap_or_default();
        levels.count() > 1 && crate::units::parse(word).is_none()
    };
    if are_short && behind.starts_with(' ') && (closed || is_section()) {
        behind.trim_start()
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

    #[test]
    fn lines_may_end_in_their_standard_uncertainty() {
        let read = |text: &str| row(text, Place::default()).unwrap();
        let bath = read("(3) 恒温槽均匀性 ±0.02 °C,按均匀分布,u = 0.02/√3 = 0.0115 °C;");
        assert_eq!(bath.u.as_ref().unwrap().value, 0.0115);
        assert_eq!(bath.words, "恒温槽均匀性 ±0.02 °C,按均匀分布");
        let standard =
            read("(2) Standard: certificate, U = 0.012 °C, k = 2, u(t_s) = 0.012/2 = 0.006 °C");
        assert_eq!(
            (standard.label(), standard.u.as_ref().unwrap().value),
            ("Standard", 0.006)
        );
        let section = read(
            "3.2 天平分辨力引入的标准不确定度 u(P2):d = 0.1 mg,均匀分布,u(P2) = 0.1/(2√3) = 0.029 mg",
        );
        assert_eq!(
            (section.label(), section.u.as_ref().unwrap().value),
            ("天平分辨力", 0.029)
        );
        let certificate = read("t_s: certificate, u = 0.012 °C (k = 2)");
        assert!(certificate.u.is_none());
    }

    #[test]
    fn sentences_are_rows() {
        let read = |text: &str| sentence(text, Place::default());
        let standard = read("The standard weight has U = 0.75 mg (k = 2) on its certificate.");
        assert_eq!(standard.unwrap().name, "standard weight");
        assert!(read("Buoyancy is within limits of ±0.15 mg.").is_some());
        assert!(read("The budget of a 500 g weight.").is_none());
        assert!(read("The combined standard uncertainty is u = 0.4 mg.").is_none());
        let parts: Vec<&str> = sentences("One is ±0.5 mg. Two is 3 mg.").collect();
        assert_eq!(parts, ["One is ±0.5 mg.", "Two is 3 mg."]);
    }
}
