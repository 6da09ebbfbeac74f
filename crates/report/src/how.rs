//! How a standard uncertainty was found, in the report's language.
//!
//! What a budget says of it is nearly a formula, with few words between: those are translated here.

use super::language::Language;

/// English phrases with `{}` for what stands between their words, and the same in Chinese, which
/// keeps the order of what is between.
const PHRASES: &[(&str, &str)] = &[
    (
        "nested analysis of variance of {} readings in {} subgroups of {} groups; groups {}, subgroups {}",
        "嵌套方差分析：{} 个读数，{} 个子组，{} 个组；组间{}，子组间{}",
    ),
    (
        "analysis of variance of {} readings in {} groups, which {}",
        "方差分析：{} 个读数，{} 个组，组间{}",
    ),
    (
        "least squares, n = {}, u of the data as stated",
        "最小二乘法，n = {}，数据的 u 按给出值",
    ),
    (
        "least squares, n = {}, u of the data times {}",
        "最小二乘法，n = {}，数据的 u 乘以 {}",
    ),
    (
        "least squares, n = {}, s = {}",
        "最小二乘法，n = {}，s = {}",
    ),
    (
        "{} about the fit {}, s = {}",
        "{}，s 为拟合 {} 的残差标准差，s = {}",
    ),
    ("{} of {}, B({})", "{} 次成功，共 {} 次试验，B({})"),
];

/// English words and what they are called in Chinese; longer ones first, where one holds another.
const WORDS: &[(&str, &str)] = &[
    (
        "√ of the variance in the covariance matrix",
        "协方差矩阵中方差的平方根",
    ),
    ("do not differ significantly (pooled)", "差异不显著（合并）"),
    ("do not differ (pooled)", "无差异（合并）"),
    ("differ (included)", "有差异（一并合成）"),
    ("are taken as one population", "视为同一总体"),
    ("GUM: u as stated", "GUM 法：按给出的 u"),
    ("u as stated", "直接给出 u"),
    ("specification a", "技术指标 a"),
    ("sample of ", "样本，容量 "),
    ("pooled s", "合并样本标准差 s"),
    ("stated s", "给出的 s"),
    ("limits ", "界限 "),
    ("shape = ", "形状参数 = "),
    ("scale = ", "尺度参数 = "),
    ("mean = ", "均值 = "),
    ("sd = ", "标准差 = "),
];

/// The words in the language of the report, powers of ten as everywhere in it.
pub(super) fn how(text: &str, language: Language) -> String {
    let text = with_powers(text);
    match language {
        Language::English => text,
        Language::Chinese => chinese(&text),
    }
}

/// `4×10^-5` for `4e-5`.
fn with_powers(text: &str) -> String {
    let mut written = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('e') {
        let (before, after) = (&rest[..at], &rest[at + 1..]);
        let digits = after.strip_prefix('-').unwrap_or(after);
        let name = before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
        let is_power = before.len() > name.len()
            && !name.ends_with(|c: char| c.is_alphanumeric() || c == '_')
            && digits.starts_with(|c: char| c.is_ascii_digit());
        written.push_str(before);
        written.push_str(if is_power { "×10^" } else { "e" });
        rest = after;
    }
    written + rest
}

fn chinese(text: &str) -> String {
    let phrase = PHRASES
        .iter()
        .find_map(|(english, chinese)| Some((between(text, english)?, chinese)));
    match phrase {
        Some((between, chinese)) => between.iter().fold(chinese.to_string(), |phrase, part| {
            phrase.replacen("{}", &translated(part), 1)
        }),
        None => translated(text),
    }
}

fn translated(text: &str) -> String {
    WORDS
        .iter()
        .fold(text.to_string(), |text, (en, zh)| text.replace(en, zh))
}

/// What stands in a text at the places `{}` of a phrase; nothing if it is not that phrase.
fn between<'a>(text: &'a str, phrase: &str) -> Option<Vec<&'a str>> {
    let mut words = phrase.split("{}");
    let mut rest = text.strip_prefix(words.next()?)?;
    let mut parts = Vec::new();
    let mut words = words.peekable();
    while let Some(word) = words.next() {
        let at = match (word, words.peek()) {
            (_, None) => rest.len().checked_sub(word.len())?,
            (word, Some(_)) => rest.find(word)?,
        };
        let (part, further) = rest.split_at_checked(at)?;
        parts.push(part);
        rest = further.strip_prefix(word)?;
    }
    Some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_stay_and_words_are_translated() {
        let zh = |text: &str| how(text, Language::Chinese);
        assert_eq!(zh("a/√3, a = 0.5"), "a/√3, a = 0.5");
        assert_eq!(zh("u as stated"), "直接给出 u");
        assert_eq!(zh("s/√n, pooled s = 0.1"), "s/√n, 合并样本标准差 s = 0.1");
        assert_eq!(zh("s/√4, stated s = 0.1"), "s/√4, 给出的 s = 0.1");
        assert_eq!(
            zh("√(a²/3 + d²/9), a = 1, d = 0.1 (GUM: u as stated)"),
            "√(a²/3 + d²/9), a = 1, d = 0.1 (GUM 法：按给出的 u)"
        );
    }

    #[test]
    fn powers_of_ten_are_written_as_such() {
        let en = |text: &str| how(text, Language::English);
        assert_eq!(en("U/k = 4e-5/2"), "U/k = 4×10^-5/2");
        assert_eq!(en("s = 1.9e12, n = 5"), "s = 1.9×10^12, n = 5");
        assert_eq!(en("about the fit x1e5, s = 1"), "about the fit x1e5, s = 1");
    }

    #[test]
    fn phrases_keep_what_stands_between_their_words() {
        let zh = |text: &str| how(text, Language::Chinese);
        assert_eq!(
            zh("least squares, n = 11, s = 0.0035"),
            "最小二乘法，n = 11，s = 0.0035"
        );
        assert_eq!(
            zh("least squares, n = 6, u of the data as stated"),
            "最小二乘法，n = 6，数据的 u 按给出值"
        );
        assert_eq!(
            zh("analysis of variance of 15 readings in 3 groups, which differ (included)"),
            "方差分析：15 个读数，3 个组，组间有差异（一并合成）"
        );
        assert_eq!(
            zh("s/√3 about the fit line, s = 0.01"),
            "s/√3，s 为拟合 line 的残差标准差，s = 0.01"
        );
        assert_eq!(
            zh("48 of 50, B(49, 3)"),
            "48 次成功，共 50 次试验，B(49, 3)"
        );
    }
}
