//! The model of a budget: where it stands, and what its names say of the rows.

use crate::claim::{Claimed, Row, Understood};
use crate::printed::Place;

use gumption_core::letters::is_chinese;
use gumption_core::model::is_reserved;

use super::lines::Line;
use super::mapping::Mapping;
use super::{columns, footer, notes, table, words};

/// Finds the model of the result, which the table may call by its symbol.
pub(super) fn find_model(
    all: &[&Line],
    result: Option<&str>,
    claimed: &mut Claimed,
    mapping: &Mapping,
) {
    if let Some(model) = &mapping.model {
        let (left, right) = model.split_once('=').unwrap_or(("y", model));
        claimed.measurand = left.trim().into();
        claimed.model = Some(right.trim().into());
        return;
    }
    let equations = all.iter().filter_map(|line| {
        let parts = |text: &str| parts(text, result, claimed);
        let of_part = line.text.split(" ; ").find_map(parts);
        of_part
            .or_else(|| parts(&line.text))
            .map(|model| (line.at, line.text.clone(), model))
    });
    let found = of_result(equations.collect(), result, claimed);
    if let Some((at, text, (left, right))) = found {
        claimed.understood.push(Understood {
            at,
            text,
            role: "model",
        });
        claimed.measurand = left;
        claimed.model = Some(right);
    }
}

/// An equation: where it stands, as it stands, and its two sides.
type Equation = (Place, String, (String, String));

/// The equation of the result with those of its intermediate quantities put in: of `M = 8·A_C + 5·A_H` and `c = m/(M·V)` the
/// second. Where none has the left side of another in it, the first. Of several results it is the one that the table is of.
fn of_result(
    mut equations: Vec<Equation>,
    result: Option<&str>,
    claimed: &Claimed,
) -> Option<Equation> {
    let is_row = |name: &str| claimed.rows.iter().any(|row| row.symbol == name);
    let uses = |one: &Equation, other: &Equation| {
        let (name, own) = (&other.2.0, &one.2.0);
        name != own && !is_row(name) && words::has_symbol(&one.2.1, name)
    };
    let is_last = |one: &Equation| {
        let mut others = equations.iter();
        equations.iter().any(|other| uses(one, other)) && !others.any(|other| uses(other, one))
    };
    let named = equations
        .iter()
        .position(|one| Some(one.2.0.as_str()) == result);
    let Some(last) = named.or_else(|| equations.iter().position(is_last)) else {
        return (!equations.is_empty()).then(|| equations.swap_remove(0));
    };
    let (at, text, (left, mut right)) = equations.swap_remove(last);
    // Each is put in once: in a circle of definitions none is the last.
    for _ in 0..equations.len() {
        let next = equations
            .iter()
            .position(|(_, _, (name, _))| !is_row(name) && words::has_symbol(&right, name));
        let Some(next) = next else {
            break;
        };
        let (_, _, (name, formula)) = equations.swap_remove(next);
        right = put_in(&right, &name, &formula);
    }
    Some((at, text, (left, right)))
}

/// A formula with another one, in brackets, in the place of a name.
fn put_in(formula: &str, name: &str, by: &str) -> String {
    let mut out = String::new();
    let mut rest = 0;
    while let Some(at) = words::symbol_at(formula, name, rest) {
        out += &formula[rest..at];
        out += &format!("({by})");
        rest = at + name.len();
    }
    out + &formula[rest..]
}

/// The model in a line: left side and right side, where the left side is the result of the table or the right side names rows.
fn parts(text: &str, result: Option<&str>, claimed: &Claimed) -> Option<(String, String)> {
    let (left, right) = text.split_once('=')?;
    let left = left.rsplit([':', '\u{ff1a}']).next().unwrap_or(left).trim();
    let left = left.rsplit(char::is_whitespace).next().unwrap_or(left);
    let right = right
        .split([';', '。'])
        .next()
        .unwrap_or(right)
        .trim()
        .trim_end_matches('.');
    let right = right
        .split(", where")
        .next()
        .unwrap_or(right)
        .split(", 其中")
        .next()
        .unwrap_or(right)
        .split(",其中")
        .next()
        .unwrap_or(right)
        .trim();
    let right = without_unit(before_next(right), claimed);
    let named = claimed
        .rows
        .iter()
        .filter(|row| notes::names_of(row).any(|name| words::has_symbol(right, name)))
        .count();
    let is_few = claimed.rows.len() <= 2 || result == Some(left);
    let enough = named >= 2 || named == 1 && is_few;
    // `… is 0.2 N (k = 2), giving …` is a sentence.
    let is_closed = left.matches('(').count() == left.matches(')').count();
    let short = !left.is_empty() && left.chars().count() <= 24;
    let identifier = short && is_closed && !left.contains([',', '|']);
    // `u_c = sqrt(u1^2 + …)`, `U = k·u_c`, `k = 2` are no models.
    let of_claim = footer::label(left, left).is_some_and(|whole| whole != footer::Whole::Y);
    let about_u = of_claim
        || left.starts_with("u_")
        || left.starts_with("u(")
        || left.starts_with("r(")
        || is_coefficient(left, claimed)
        || left.starts_with('∂')
        || left.starts_with('ν');
    (enough && identifier && !about_u && !is_amount(right))
        .then(|| (left.to_string(), right.to_string()))
}

/// Whether a right side is a number, or one with its unit: `s_r = 0.2 V` is no model of a voltage V.
fn is_amount(right: &str) -> bool {
    let behind = crate::printed::leading(right).map(|(_, rest)| rest.trim());
    behind.is_some_and(|rest| rest.is_empty() || columns::is_unit(rest))
}

/// A formula without the equations that follow it behind commas: `V_x - V_s, k = 2`.
fn before_next(formula: &str) -> &str {
    let mut commas = formula.match_indices(", ");
    let next = commas.find(|(at, comma)| {
        let behind = &formula[at + comma.len()..];
        behind
            .split(", ")
            .next()
            .is_some_and(|part| part.contains('='))
    });
    next.map_or(formula, |(at, _)| &formula[..at])
}

/// A formula without the unit of its value in a bracket behind it: `1000·m·P/V  [mg/L]`.
fn without_unit<'t>(formula: &'t str, claimed: &Claimed) -> &'t str {
    let bracket = |[open, close]: [char; 2]| formula.strip_suffix(close)?.rsplit_once(open);
    let Some((front, unit)) = [['[', ']'], ['(', ')']].into_iter().find_map(bracket) else {
        return formula;
    };
    // `a (b)` is a product where b has its row.
    let is_row = claimed.rows.iter().any(|row| row.symbol == unit);
    let is_behind = front.ends_with(' ') && !front.trim_end().ends_with(is_operator);
    match is_behind && !is_row && columns::is_unit(unit) {
        true => front.trim_end(),
        false => formula,
    }
}

fn is_operator(c: char) -> bool {
    matches!(c, '+' | '-' | '−' | '*' | '·' | '×' | '/' | '÷' | '^' | '=')
}

/// `c_1`, `c_i`, `c_m` beside a quantity m: a sensitivity coefficient, where `c_Cd` is a concentration.
fn is_coefficient(name: &str, claimed: &Claimed) -> bool {
    name.strip_prefix("c_").is_some_and(|of| {
        let is_index = of == "i" || of.chars().all(|c| c.is_ascii_digit());
        is_index
            || claimed
                .rows
                .iter()
                .any(|row| notes::names_of(row).any(|name| name == of))
    })
}

/// Rows without a symbol take that word of their name which the model uses.
pub(super) fn symbols_of_model(raw: &mut [table::Raw], claimed: &mut Claimed) {
    for (raw, row) in raw.iter_mut().zip(&mut claimed.rows) {
        if !row.symbol.is_empty() {
            continue;
        }
        let model = claimed.model.clone().unwrap_or_default();
        let in_model = notes::names_of(row).find(|word| words::has_symbol(&model, word));
        // What a bracket says in Chinese words is a remark.
        let bracketed = || {
            row.name
                .rsplit_once('(')
                .and_then(|(_, tail)| tail.strip_suffix(')'))
                .filter(|s| s.chars().count() <= 12 && words::may_be_symbol(s))
                .filter(|s| !s.starts_with(is_chinese))
        };
        let first = || {
            row.name
                .split_once([':', ','])
                .map(|(first, _)| first.trim())
                .filter(|s| s.chars().count() <= 8 && words::may_be_symbol(s))
        };
        let symbol = in_model
            .or_else(bracketed)
            .or_else(first)
            .map(str::to_string);
        let short = || {
            (row.name.chars().count() <= 10 && !row.name.contains(' ')).then(|| row.name.clone())
        };
        row.symbol = symbol.or_else(short).unwrap_or_default();
        raw.row.symbol = row.symbol.clone();
    }
}

/// An input of the model that no row has and no line gives a value to, where everything else of the model has its row.
pub(super) fn missing_input(claimed: &Claimed, all: &[&Line]) -> Option<Row> {
    // As laboratories write them, besides those of the model language.
    const FUNCTIONS: [&str; 4] = ["log", "lg", "arcsin", "arctan"];
    let is_function = |word: &&str| FUNCTIONS.contains(word) || is_reserved(word);
    let model = claimed.model.as_deref()?;
    let named = |row: &Row| words::has_symbol(model, &row.symbol);
    if claimed.rows.len() < 2 || !claimed.rows.iter().all(named) {
        return None;
    }
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
    let is_name = |word: &&str| {
        word.starts_with(char::is_alphabetic) && !word.contains(is_chinese) && !is_function(word)
    };
    let known = |word: &&str| {
        let of = |rows: &[Row]| rows.iter().any(|row| row.symbol == *word);
        of(&claimed.rows) || of(&claimed.absent) || *word == claimed.measurand
    };
    let mut open: Vec<&str> = model.split(|c: char| !part(c)).filter(is_name).collect();
    open.retain(|word| !known(word));
    open.sort_unstable();
    open.dedup();
    let [symbol] = open.as_slice() else {
        return None;
    };
    let given = |line: &&Line| {
        notes::is_assigned(&line.text, symbol) || is_called_exact(&line.text, symbol)
    };
    // `y = x + 0.5 mm`: what stands behind a number is its unit.
    if behind_numbers(model, symbol) {
        return None;
    }
    (!all.iter().any(given)).then(|| Row {
        symbol: (*symbol).into(),
        is_absent: true,
        ..Row::default()
    })
}

/// Whether a text says of a symbol that it is exact, nominal or a constant.
fn is_called_exact(text: &str, symbol: &str) -> bool {
    const WORDS: [&str; 14] = [
        "exact",
        "nominal",
        "constant",
        "by definition",
        "defined",
        "conventional",
        "标称",
        "公称",
        "常数",
        "常量",
        "准确值",
        "约定",
        "定义值",
        "名义",
    ];
    let lower = text.to_lowercase();
    words::has_symbol(text, symbol) && WORDS.iter().any(|word| lower.contains(word))
}

/// Whether a name is a unit that stands nowhere but behind numbers.
fn behind_numbers(formula: &str, name: &str) -> bool {
    let mut from = 0;
    let mut is_some = false;
    while let Some(at) = words::symbol_at(formula, name, from) {
        let front = formula[..at].trim_end();
        if !front.ends_with(|c: char| c.is_ascii_digit()) || !columns::is_unit(name) {
            return false;
        }
        is_some = true;
        from = at + name.len();
    }
    is_some
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_name_rows() {
        let row = |symbol: &str| Row {
            symbol: symbol.into(),
            ..Row::default()
        };
        let claimed = Claimed {
            rows: vec![row("m_S"), row("dm")],
            ..Claimed::default()
        };
        let right = |text: &str| parts(text, None, &claimed).map(|(_, right)| right);
        let sum = Some("m_S + dm".to_owned());
        assert_eq!(
            parts("Model: m = m_S + dm", None, &claimed),
            Some(("m".into(), "m_S + dm".into()))
        );
        assert_eq!(right("测量模型：m = m_S + dm"), sum);
        assert_eq!(right("U = k·u_c"), None);
        for unit in ["m = m_S + dm  [mg]", "m = m_S + dm (g)"] {
            assert_eq!(right(unit), sum, "{unit}");
        }
        let product = "m_S*2 (dm)";
        assert_eq!(right(&format!("m = {product}")).as_deref(), Some(product));
    }
}
