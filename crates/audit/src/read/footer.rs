//! Claimed figures of the whole: lines below a table, and sentences.

use gumption_core::letters::is_chinese;

use crate::claim::Footer;
use crate::printed::{Place, Printed, leading};

use super::conditions;
use super::factor::{is_factor, is_fixed};
use super::family::{FACTOR, NU_EFF};
use super::statement;
use super::words::{compact, find, has};

/// How far below u_c U may stand: between them ν_eff, k and the probability.
pub(super) const ROWS_TO_EXPANDED: usize = 4;

/// A figure of the whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whole {
    /// The result.
    Y,
    /// Combined standard uncertainty.
    Combined,
    /// Effective degrees of freedom.
    Freedom,
    /// Coverage factor.
    Factor,
    /// Expanded uncertainty.
    Expanded,
}

impl Whole {
    /// Its name in the list of what was understood.
    pub const fn name(self) -> &'static str {
        match self {
            Whole::Y => "y",
            Whole::Combined => "u_c",
            Whole::Freedom => "nu_eff",
            Whole::Factor => "k",
            Whole::Expanded => "U",
        }
    }
}

/// Words that stand for a figure of the whole; longer ones first where one is in another.
#[rustfmt::skip]
const WORDS: &[(Whole, &[&str])] = &[
    (Whole::Freedom, &["effective degrees of freedom", "effektiver freiheitsgrad", "effektive freiheitsgrade", "degrés de liberté effectifs", "effective number of degrees", "effective dof", "有效自由度", "deg. of freedom (eff"]),
    (Whole::Freedom, NU_EFF),
    (Whole::Factor, &["coverage factor", "erweiterungsfaktor", "facteur d'élargissement", "包含因子", "覆盖因子", "扩展因子", "k-factor", "k ="]),
    (Whole::Expanded, &["erweiterte messunsicherheit", "erweiterte unsicherheit", "incertitude élargie", "expanded uncertainty", "expanded measurement uncertainty", "扩展不确定度", "reported uncertainty", "u95", "u_95", "expanded unc", "总不确定度", "expanded", "erweitert", "扩展"]),
    (Whole::Combined, &["kombinierte standard", "kombinierte unsicherheit", "incertitude-type composée", "incertitude composée", "combined standard uncertainty", "combined uncertainty", "合成标准不确定度", "合成不确定度", "合成uc", "合成u_c", "standard uncertainty of the result", "standard uncertainty of y", "combined std", "combined standard", "root sum of squares", "root sum square", "root-sum-square", "rss", "comb. std", "comb. unc", "gesamtstandard", "beigeordnete standard", "combined", "kombiniert", "total standard uncertainty"]),
    (Whole::Y, &["measurement result", "测量结果", "result", "结果", "measured value", "value of the measurand", "被测量值", "reported value", "被测量"]),
];

/// Symbols that stand alone in a cell.
fn symbol(text: &str) -> Option<Whole> {
    let name = without_condition(text);
    let name = name
        .split(['=', ':', '/', '['])
        .next()
        .unwrap_or_default()
        .trim();
    let name = name.split_once(" (").map_or(name, |(name, _)| name);
    let name = name.split_once(" in ").map_or(name, |(name, _)| name);
    // `u_c(E)`, `U(E)`: of whatever the result is called.
    let of_result = name.split_once('(').filter(|(_, rest)| rest.ends_with(')'));
    let name = match of_result {
        Some((lead @ ("U" | "W" | "uc" | "u_c" | "w_c"), _)) => lead,
        _ => name,
    };
    if matches!(
        name,
        "U" | "U95" | "U_95" | "U99" | "U_99" | "Uexp" | "U_exp"
    ) {
        return Some(Whole::Expanded);
    }
    // `W` alone may be the watt; with a condition or a unit behind it, it is the relative one of ISO 376.
    if name == "W" && name != text {
        return Some(Whole::Expanded);
    }
    match compact(name).as_str() {
        "uc" | "wc" | "w(y)" | "u(y)" | "u(c)" | "ucombined" | "uccombined" | "uy" | "u"
        | "rss" => Some(Whole::Combined),
        _ if is_bare_sum(name) => Some(Whole::Combined),
        "νeff" | "veff" | "nueff" | "νeff(y)" => Some(Whole::Freedom),
        "k" | "kp" | "k95" | "k(95%)" | "k(95.45%)" | "k(p)" => Some(Whole::Factor),
        "y" => Some(Whole::Y),
        _ => None,
    }
}

/// The name in front of the condition under which a figure holds: `U` of `U(k = 2)`, `U, k = 2`, `U: k=2` and `U k=2`.
pub(super) fn without_condition(text: &str) -> &str {
    let front = text.split('=').next().unwrap_or_default().trim_end();
    let is_condition = front.len() < text.trim_end().len();
    let factor = ["k", "k_p", "p", "P"].iter().find_map(|name| {
        let front = front.strip_suffix(name).filter(|_| is_condition)?;
        let name = front.trim_end_matches([' ', ',', ';', ':', '(', '[']);
        (name.len() < front.len() && !name.is_empty()).then_some(name)
    });
    // `U (95 %, k = 2)`
    let bracket = text
        .split_once('(')
        .filter(|(_, inner)| inner.contains('='));
    bracket.map(|(name, _)| name).or(factor).unwrap_or(text)
}

/// `combined relative standard uncertainty` is called by the words for the absolute one.
fn absolute(text: &str) -> String {
    RELATIVE
        .iter()
        .fold(text.to_string(), |text, word| text.replace(word, ""))
}

const RELATIVE: [&str; 4] = ["relative ", "Relative ", "rel. ", "相对"];

/// Whether a label is that of a figure relative to the result, by its words or as `u(c)/c`.
pub fn is_relative(label: &str) -> bool {
    let divided = label.split_once(")/").and_then(|(front, by)| {
        let (_, name) = front.split_once('(')?;
        Some(by.trim().starts_with(name.trim()))
    });
    divided == Some(true) || RELATIVE.iter().any(|word| label.contains(word))
}

/// Names of the two types of evaluation.
pub(super) const TYPES: [&str; 8] = [
    "type a", "type b", "type-a", "type-b", "a类", "b类", "a 类", "b 类",
];

/// Whether a head, in small letters, calls what stands below it somebody's claim, which a report holds against its own.
pub fn calls_claim(lower: &str) -> bool {
    matches!(lower, "claimed" | "声称值")
}

/// Whether a text labels what some of the rows come to, which is neither a source nor a figure of the whole.
pub fn is_subtotal(text: &str) -> bool {
    const WORDS: [&str; 6] = [
        "subtotal",
        "sub-total",
        "sub total",
        "小计",
        "zwischensumme",
        "sous-total",
    ];
    has(&text.to_lowercase(), &WORDS)
}

/// What a cell labels, if it labels a figure of the whole.
pub fn label(text: &str, measurand: &str) -> Option<Whole> {
    if is_capital_result(text, measurand) {
        return Some(Whole::Y);
    }
    let own = conditions::without_point(text);
    let text = own.as_ref();
    if let Some(whole) = by_factor(text) {
        return Some(whole);
    }
    if let Some(whole) = symbol(text) {
        return Some(whole);
    }
    if !measurand.is_empty() && text.trim() == measurand {
        return Some(Whole::Y);
    }
    let lower = absolute(&text.to_lowercase());
    if is_expanded_by_factor(&lower) {
        return Some(Whole::Expanded);
    }
    if is_named_u_c(&lower) {
        return Some(Whole::Combined);
    }
    if let Some(whole) = named_as_result(text) {
        return Some(whole);
    }
    // `Sum u(m_X)`, `Total u`, `Total u_c`; `Total type A` of a block.
    let total = ["sum ", "sum of ", "total ", "total of ", "合计 "]
        .iter()
        .filter_map(|word| lower.strip_prefix(word))
        .chain(
            [" total", " sum", "合计"]
                .iter()
                .filter_map(|word| lower.strip_suffix(word)),
        );
    if total.into_iter().any(|rest| {
        matches!(rest, "u" | "uc")
            || rest.starts_with("u(")
            || rest.starts_with("u_")
            || TYPES.contains(&rest.trim())
    }) {
        return Some(Whole::Combined);
    }
    let at = |keys: &[&str]| keys.iter().filter_map(|key| find(&lower, key, 0)).min();
    let found = WORDS
        .iter()
        .filter_map(|(whole, keys)| Some((at(keys)?, *whole)));
    // `expanded uncertainty U = k·u_c`: what stands first is what is labelled.
    let first = found.min_by_key(|(at, _)| *at)?;
    let short = first.0 <= 12 || text.chars().count() < 40;
    short.then_some(first.1)
}

/// What uncertainties are called in the languages of laboratories.
const UNCERTAINTY: [&str; 9] = [
    "uncert",
    "unsicher",
    "incert",
    "nejist",
    "niepewn",
    "osäkerhet",
    "onzeker",
    "неопредел",
    "不确定",
];

/// Whether a text in small letters is the name of an uncertainty and behind it u_c: `Standardunsicherheit u_c`.
fn is_named_u_c(lower: &str) -> bool {
    let named = lower.trim().rsplit_once(' ');
    named.is_some_and(|(name, symbol)| {
        let is_u_c = matches!(
            symbol.trim_matches(['(', ')', ',']),
            "u_c" | "uc" | "u_c(y)"
        );
        is_u_c && !name.contains('=') && UNCERTAINTY.iter().any(|word| name.contains(word))
    })
}

/// u_c and U behind the word that calls them those of the result: `Result U (k = 2)`, `结果 u_c`.
fn named_as_result(text: &str) -> Option<Whole> {
    const RESULTS: [&str; 8] = [
        "result",
        "final result",
        "final",
        "reported",
        "ergebnis",
        "résultat",
        "结果",
        "测量结果",
    ];
    let (name, symbol) = without_condition(text).trim().rsplit_once(' ')?;
    let is_result = RESULTS.contains(&name.trim().to_lowercase().as_str());
    match symbol {
        "U" | "U95" | "U_95" => is_result.then_some(Whole::Expanded),
        "u_c" | "uc" => is_result.then_some(Whole::Combined),
        _ => None,
    }
}

/// What an uncertainty is called that nothing else is said of.
const BARE: [&str; 10] = [
    "uncertainty",
    "measurement uncertainty",
    "total uncertainty",
    "overall uncertainty",
    "mu",
    "messunsicherheit",
    "incertitude",
    "incertidumbre",
    "不确定度",
    "测量不确定度",
];

/// What the factor behind a bare name makes of it: `u (k = 1)` and `Uncertainty (1 sigma)` are standard uncertainties, `u (k = 2)`,
/// `Uncertainty (2 sigma)` and `2u` expanded ones.
fn by_factor(text: &str) -> Option<Whole> {
    if multiple_alone(text).is_some() {
        return Some(Whole::Expanded);
    }
    let is_bare = |name: &str| name == "u" || BARE.contains(&name.to_lowercase().as_str());
    let of = |k: f64| match k == 1.0 {
        true => Whole::Combined,
        false => Whole::Expanded,
    };
    if let Some((k, name)) = conditions::multiple(text) {
        return is_bare(&name).then(|| of(k.value));
    }
    // `Overall uncertainty, coverage factor 2`
    let name = without_condition(text).trim();
    let in_words = || {
        let lower = text.to_lowercase();
        let name = lower.split_once("coverage factor")?.0;
        let name = name.trim_end_matches([' ', ',', ';', ':', '(']);
        is_bare(name).then(|| factor_of_label(text))?
    };
    if let Some(k) = in_words() {
        return Some(of(k.value));
    }
    let is_open = name.len() == text.trim().len() || !is_bare(name);
    let k = (!is_open).then(|| super::words::figure_after(text, &["k"]))??;
    (k.value == 1.0 || is_factor(k.value)).then(|| of(k.value))
}

/// The factor of a label that is nothing but a multiple of u: `2u`, `2·u_c`.
pub(super) fn multiple_alone(text: &str) -> Option<Printed> {
    let (factor, behind) = leading(text.trim())?;
    let name = behind.trim_start_matches([' ', '·', '×', '*', '⋅']);
    let is_joined = name.len() < behind.len() && !behind.trim_start().starts_with('u')
        || name.len() == behind.len();
    let is_u = matches!(name, "u" | "uc" | "u_c" | "u(y)" | "u_c(y)");
    (is_factor(factor.value) && is_u && is_joined).then_some(factor)
}

/// Whether a text says no more than that something is a sum.
pub fn is_bare_sum(text: &str) -> bool {
    const WORDS: [&str; 6] = ["sum", "summe", "total", "gesamt", "合成", "合计"];
    WORDS.contains(&compact(text).as_str())
}

/// Whether a label calls an uncertainty a total, which is U alone, and u_c above a U that is stated below it.
pub(super) fn is_total(label: &str) -> bool {
    let name = without_condition(label).trim();
    name.len() == label.trim().len()
        && matches!(
            name,
            "总不确定度" | "Total uncertainty" | "Overall uncertainty"
        )
}

/// Whether a text has a figure beside those of points, coverage factor and probability.
pub(super) fn has_other_figure(text: &str) -> bool {
    let own = conditions::without_point(text);
    conditions::without_coverage(&own).contains(|c: char| c.is_ascii_digit())
}

/// Whether a text in small letters is nothing but `uncertainty` with a factor, `Messunsicherheit (k=2)`, which makes it expanded.
fn is_expanded_by_factor(lower: &str) -> bool {
    let name = without_condition(lower).trim();
    let factor = super::words::figure_after(lower, &["k"]);
    let is_one = |k: &Printed| k.value == 1.0;
    name.len() < lower.trim().len() && BARE.contains(&name) && !factor.is_some_and(|k| is_one(&k))
}

/// Whether what stands below u_c is called as an expanded uncertainty may be: it names an uncertainty, U, its factor, or a multiple of
/// u_c.
pub fn may_be_expanded(text: &str) -> bool {
    const LIMITS: [&str; 7] = ["cmc", "limit", "toleran", "mpe", "target", "允", "限"];
    let lower = text.to_lowercase();
    let is_named = |keys: &[&str]| keys.iter().any(|key| lower.contains(key));
    let is_multiple = || leading(text).is_some_and(|(_, behind)| names_u(behind));
    let by_factor = || without_condition(text).len() < text.len();
    let by_symbol = || super::words::has_symbol(text, "U");
    let is_uncertainty = is_named(&UNCERTAINTY) || is_named(&["expand"]);
    !is_named(&LIMITS) && (is_uncertainty || is_multiple() || by_factor() || by_symbol())
}

/// The coverage factor that the label of U names in words: `Expanded uncertainty, coverage factor 3`.
pub fn factor_of_label(text: &str) -> Option<Printed> {
    let multiple = conditions::multiple(text).map(|(k, _)| k);
    if let Some(factor) = multiple_alone(text).or(multiple) {
        return is_factor(factor.value).then_some(factor);
    }
    let of_factor = WORDS.iter().find(|(whole, _)| *whole == Whole::Factor);
    let (_, keys) = of_factor?;
    let figure = super::words::figure_after(text, keys)?;
    (is_factor(figure.value) && figure.unit.is_empty()).then_some(figure)
}

/// Whether a text is or begins with the name of a result whose small letter is the coverage factor: a scale factor K.
pub fn is_capital_result(text: &str, measurand: &str) -> bool {
    let name = text.split('=').next().unwrap_or_default();
    let name = name.rsplit([':', '：']).next().unwrap_or(name).trim();
    name == measurand && name == "K"
}

/// A figure with a coverage factor in a bracket behind it is an expanded uncertainty: `59 mg (k = 2)`.
pub fn with_factor(text: &str) -> Option<Printed> {
    let (front, condition) = text.split_once('(')?;
    let condition = condition.trim_start();
    let is_factor = condition.starts_with('k') && condition.contains('=');
    Printed::parse(front).filter(|_| is_factor)
}

/// Sets a figure that is not there yet.
pub fn set(footer: &mut Footer, whole: Whole, figure: Printed) -> bool {
    let slot = match whole {
        Whole::Y => &mut footer.y,
        Whole::Combined => &mut footer.u_c,
        Whole::Freedom => &mut footer.nu_eff,
        Whole::Factor => &mut footer.k,
        Whole::Expanded => &mut footer.expanded,
    };
    let free = slot.is_none();
    if free {
        *slot = Some(figure);
    }
    free
}

/// Sets U as it is reported, in the place of one of the same unit that the sheet computes.
pub fn set_reported(footer: &mut Footer, reported: Printed) -> bool {
    let computed = footer.expanded.as_ref();
    let is_other = computed.is_some_and(|own| !own.unit.is_empty() && own.unit != reported.unit);
    if !is_other {
        footer.expanded = Some(reported);
    }
    !is_other
}

/// Whether a label calls what is reported: `Reported U (k = 2)`, `Reported`, `扩展不确定度（修约后）`.
pub fn is_report(label: &str) -> bool {
    const WORDS: [&str; 8] = [
        "reported",
        "rounded",
        "gerundet",
        "angegeben",
        "arrondi",
        "报告",
        "修约",
        "取整",
    ];
    let lower = label.to_lowercase();
    WORDS.iter().any(|word| lower.contains(word))
}

/// U as a statement has it in the place of the one that the sheet computes with more digits, where it is that, rounded.
fn report(footer: &mut Footer, reported: Printed) {
    let Some(computed) = footer.expanded.as_ref().filter(|own| own.is_long()) else {
        return;
    };
    let same_unit = computed.unit.is_empty() || computed.unit == reported.unit;
    let of_it = reported.is_met_within(computed.value, 2.0 * reported.half);
    if same_unit && of_it && !reported.is_long() {
        footer.expanded = Some(reported);
    }
}

/// Figures inside a sentence: `u_c = 0.027 mm, ν_eff = 35, k = 2, U = 0.054 mm`.
pub fn sentence(text: &str, measurand: &str, at: Place, footer: &mut Footer) -> Vec<Whole> {
    let mut found = Vec::new();
    let mut stated = None;
    let y = footer.y.clone();
    // `Combined uncertainty (k = 1)`: a standard uncertainty, of which nothing is said of the coverage factor.
    let is_standard = label(text, measurand) != Some(Whole::Expanded);
    let mut take = |whole: Whole, figure: Printed| {
        let is_none = whole == Whole::Factor && is_standard && figure.value == 1.0;
        if !is_none && set(footer, whole, figure.at(at)) {
            found.push(whole);
        }
    };
    // Of a voltage U, `U = 10.0001 V` is the result.
    let is_result = |name: &str, figure: &Printed| {
        let is_met = |y: &Printed| figure.is_met_within(y.value, figure.half.max(y.half));
        name == measurand && y.as_ref().is_some_and(is_met)
    };
    // `U at 10 V, k = 2: 61 µV`: between a name and its figure may stand under which conditions it holds.
    let at_point = conditions::without_point(text);
    let bare = conditions::without_coverage(&at_point);
    for (whole, names) in NAMES {
        let text = match whole {
            Whole::Combined | Whole::Expanded => bare.as_ref(),
            _ => text,
        };
        for name in *names {
            if let Some(figure) = assigned(text, name).filter(|figure| !is_result(name, figure)) {
                take(*whole, figure);
            }
        }
    }
    let of_name = || conditions::multiple(text).map(|(k, _)| k);
    let factor = multiple_of_u(text).or_else(|| factor_of_product(text, measurand));
    let factor = factor.or_else(|| of_name().filter(|k| is_factor(k.value)));
    if let Some(factor) = &factor {
        take(Whole::Factor, factor.clone());
    }
    if !measurand.is_empty()
        && let Some(figure) = assigned(text, measurand)
    {
        take(Whole::Y, figure);
    }
    if let Some((result, reported)) = statement::of_result(text, y.as_ref()) {
        take(Whole::Y, result);
        take(Whole::Expanded, reported.clone());
        stated = Some(reported.at(at));
    }
    let (text, bare) = (&absolute(text), absolute(&bare));
    let lower = text.to_lowercase();
    let is_claim = |whole: Whole| match whole {
        Whole::Y => false,
        Whole::Factor => !divides_by_factor(&lower) && !is_capital_result(text, measurand),
        _ => true,
    };
    for (whole, keys) in WORDS.iter().filter(|(whole, _)| is_claim(*whole)) {
        let text = match whole {
            Whole::Combined | Whole::Expanded => &bare,
            _ => text,
        };
        let figure = super::words::figure_after(text, keys);
        let is_factor = |figure: &Printed| factor.as_ref().is_some_and(|k| k.text == figure.text);
        if let Some(figure) = figure.filter(|figure| has(&lower, keys) && !is_factor(figure)) {
            take(*whole, figure);
        }
    }
    if let Some(reported) = stated {
        report(footer, reported);
    }
    found
}

/// `u = U/k = 2.4/2`: the calculation of a row, whose k is that of a certificate.
pub fn divides_by_factor(lower: &str) -> bool {
    has(lower, &["u/k", "u / k"])
}

/// The factor of `k = t95(νeff) = 2.36`, which was looked up.
pub fn looked_up(text: &str) -> Option<Printed> {
    let is_of_t = FACTOR.iter().find(|name| {
        let behind = super::words::symbol_at(text, name, 0).map(|at| &text[at + name.len()..]);
        let right = behind.and_then(|behind| behind.trim_start().strip_prefix('='));
        right.is_some_and(|right| right.trim_start().starts_with('t'))
    });
    assigned(text, is_of_t?)
}

/// The factor of `U = 2·u_c`.
fn multiple_of_u(text: &str) -> Option<Printed> {
    let sides: Vec<&str> = text.split('=').collect();
    let mut pairs = sides.windows(2);
    pairs.find_map(|sides| {
        let name = sides[0].trim_end();
        let (factor, behind) = leading(sides[1])?;
        let of_u = names_u(behind) || name.ends_with('U') && is_u_alone(behind);
        (is_factor(factor.value) && of_u).then_some(factor)
    })
}

/// The factor of `U = 3 × 29.3 mg = 88 mg`: the number without a unit in front of what it multiplies.
fn factor_of_product(text: &str, measurand: &str) -> Option<Printed> {
    if label(text, measurand) != Some(Whole::Expanded) {
        return None;
    }
    let sides: Vec<&str> = text.split(['=', '≈']).collect();
    let mut pairs = sides.windows(2);
    pairs.find_map(|sides| {
        let (factor, behind) = leading(sides[0])?;
        let behind = behind.trim_start();
        let is_product = super::words::starts_product(behind);
        let second = behind.trim_start_matches(['×', '*', '·', 'x', 'X', ' ']);
        let (_, rest) = leading(second).filter(|_| is_product)?;
        let is_last = !super::words::starts_product(rest.trim_start());
        let is_made = is_last && leading(sides[1]).is_some();
        // Any other one was looked up: U itself shows it.
        (is_fixed(factor.value) && is_made).then_some(factor)
    })
}

/// Whether nothing but u stands behind a factor, up to an equals sign: `U = 2 u = 1.3 mg`, where u is no unit of mass.
fn is_u_alone(behind: &str) -> bool {
    let own = behind.split('=').next().unwrap_or_default();
    own.trim() == "u"
}

/// Whether u_c is what a figure in front of this is multiplied with, also without a sign: `2u_c`. A bare u behind a blank
/// begins what is said next: `k = 2 u = 0.5`.
fn names_u(behind: &str) -> bool {
    let gap = behind.trim_start();
    let sign = ["·", "⋅", "×", "*", "x ", "times ", "\\cdot", "\\times"]
        .iter()
        .find_map(|sign| gap.strip_prefix(sign));
    let name = sign.unwrap_or(gap).trim_start();
    let is_alone = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    ["u_c", "uc", "u("].iter().any(|own| name.starts_with(own))
        || (sign.is_some() || gap.len() == behind.len())
            && name.strip_prefix('u').is_some_and(is_alone)
}

/// Whether a line, in small letters, says what u_c, ν_eff or U are.
pub fn states_figures(lower: &str) -> bool {
    let of_u = ["u_c", "uc", "u(y)", "u", "u_rel", "urel", "u95", "u_95"];
    let mut names = of_u.iter().chain(NU_EFF);
    names.any(|name| assigned(lower, name).is_some()) || lower.contains('±')
}

/// Names that are followed by `=`, in their own case.
const NAMES: &[(Whole, &[&str])] = &[
    (
        Whole::Combined,
        &[
            "u_c", "uc", "u(y)", "u_crel", "u_c,rel", "ucrel", "u_cr", "u_c_rel", "w_c", "wc",
        ],
    ),
    (Whole::Freedom, NU_EFF),
    (Whole::Factor, FACTOR),
    (
        Whole::Expanded,
        &[
            "U", "U95", "U_95", "U99", "U_99", "U_rel", "Urel", "U_95rel", "U_r", "W",
        ],
    ),
    (Whole::Y, &["y"]),
];

/// The figure behind `name =`.
pub fn assigned(text: &str, name: &str) -> Option<Printed> {
    let mut from = 0;
    while let Some(at) = super::words::symbol_at(text, name, from) {
        from = at + name.len();
        // `u = U/k = 2.4/2` gives a value to the quotient.
        if text[..at].trim_end().ends_with('/') {
            continue;
        }
        let mut rest = text[from..].trim_start();
        // `u_c(m) = 0.3`
        if let Some(inner) = rest.strip_prefix('(')
            && let Some((argument, behind)) = inner.split_once(')')
            && argument.chars().count() <= 12
        {
            rest = behind.trim_start();
        }
        // `U = k·u_c = 0.054`: the last of a chain of equations.
        while let Some(right) = rest
            .strip_prefix('=')
            .or_else(|| rest.strip_prefix('≈'))
            .or_else(|| rest.strip_prefix(':'))
        {
            let right = right.trim_start();
            let is_factor = |behind: &str| name == "U" && is_u_alone(behind);
            if let Some((figure, behind)) = leading(right)
                && !is_factor(behind)
                && !super::words::starts_product(behind.trim_start())
                && !super::words::starts_quotient(behind.trim_start())
                && !names_u(behind)
            {
                // `U = 11.6 µm ≈ 12 µm`: what it is rounded to.
                if let Some((between, _)) = behind.split_once('≈')
                    && (between.trim().is_empty() || super::columns::is_unit(between.trim()))
                {
                    rest = &behind[between.len()..];
                    continue;
                }
                let unit = behind
                    .trim_start()
                    .split(|c: char| c.is_whitespace() || ",;()。、".contains(c))
                    .next()
                    .unwrap_or_default();
                let unit = unit.trim_end_matches('.');
                let unit = if super::columns::is_unit(unit) || unit == "%" {
                    unit
                } else {
                    ""
                };
                return Some(Printed {
                    unit: unit.into(),
                    ..figure
                });
            }
            let Some(next) = outside_brackets(right).filter(|next| is_formula(&right[..*next]))
            else {
                break;
            };
            // `U: k=2`: what is assigned is the factor.
            if matches!(right[..next].trim_end(), "k" | "k_p" | "p" | "P") {
                break;
            }
            rest = &right[next..];
        }
    }
    None
}

/// Where the next equals sign stands that is in no bracket: `k·u_c (k = 2)` has none.
fn outside_brackets(text: &str) -> Option<usize> {
    let mut depth = 0_i32;
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            '=' | '≈' if depth == 0 => return Some(at),
            _ => {}
        }
    }
    None
}

/// Whether a text is a product and no sentence: `k·u_c` and `k \cdot u_c`, and not `k·u_c with k`.
fn is_formula(text: &str) -> bool {
    let word = |part: &str| {
        part.chars().count() >= 3
            && part.chars().all(|c| c.is_ascii_alphabetic())
            && !["sqrt", "cdot", "times"].contains(&part)
            && !super::columns::is_unit(part)
    };
    let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    let decimal =
        |at: usize| digit(text[..at].chars().next_back()) && digit(text[at + 1..].chars().next());
    !text.contains(';')
        && text.match_indices(',').all(|(at, _)| decimal(at))
        && !text.contains(is_chinese)
        && !text
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .any(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_in_both_languages() {
        for (text, whole) in [
            ("Combined standard uncertainty u_c", Whole::Combined),
            ("合成标准不确定度 uc", Whole::Combined),
            ("Standardunsicherheit u_c", Whole::Combined),
            ("Incertitude-type uc", Whole::Combined),
            ("有效自由度 νeff", Whole::Freedom),
            ("U", Whole::Expanded),
            ("扩展不确定度 U (k=2)", Whole::Expanded),
            ("k", Whole::Factor),
            ("Coverage factor", Whole::Factor),
            ("m", Whole::Y),
        ] {
            assert_eq!(label(text, "m"), Some(whole), "{text}");
        }
    }

    #[test]
    fn sentences_hold_figures() {
        let mut footer = Footer::default();
        sentence(
            "m = (100.0215 ± 0.0008) g; u_c = 0.00035 g, ν_eff = 9, k = 2.26",
            "m",
            Place::default(),
            &mut footer,
        );
        let value = |figure: &Option<Printed>| figure.as_ref().unwrap().value;
        assert_eq!(value(&footer.y), 100.0215);
        assert_eq!(value(&footer.expanded), 0.0008);
        assert_eq!(footer.expanded.as_ref().unwrap().unit, "g");
        assert_eq!(
            [value(&footer.u_c), value(&footer.nu_eff), value(&footer.k)],
            [0.00035, 9.0, 2.26]
        );
        let mut footer = Footer::default();
        sentence(
            "U = k × u_c = 2 × 0.027 = 0.054 mm",
            "",
            Place::default(),
            &mut footer,
        );
        assert_eq!(value(&footer.expanded), 0.054);
        let mut footer = Footer::default();
        let text = "Expanded uncertainty: U = k x u(e) = 2 x 0.00121 MPa = 0.0024 MPa";
        sentence(text, "", Place::default(), &mut footer);
        assert_eq!(value(&footer.expanded), 0.0024);
        for (text, k) in [
            ("U = 2·u_c", Some(2.0)),
            ("U95=1.96 uc", Some(1.96)),
            ("扩展不确定度 U = 2 × u(y)", Some(2.0)),
            ("U = 2 × 0.027 mm", None),
            ("扩展不确定度 U=2u_c /mΩ", Some(2.0)),
        ] {
            let mut footer = Footer::default();
            sentence(text, "", Place::default(), &mut footer);
            assert_eq!(footer.k.map(|k| k.value), k, "{text}");
            assert_eq!(footer.expanded, None, "{text}");
        }
        let text = "Relative combined standard uncertainty w = 0.35 %";
        sentence(text, "", Place::default(), &mut footer);
        assert_eq!(value(&footer.u_c), 0.35);
    }
}
