//! How a standard uncertainty was found, in the report's language.
//!
//! What a budget says of it is nearly a formula, with few words between: those are translated here.

use super::language::Language;

/// English words and what they are called in Chinese; longer ones first, where one holds another.
const WORDS: &[(&str, &str)] = &[
    (
        "√ of the variance in the covariance matrix",
        "协方差矩阵中方差的平方根",
    ),
    ("GUM: u as stated", "GUM 法：按给出的 u"),
    ("u as stated", "直接给出 u"),
    ("specification a", "技术指标 a"),
    ("from a sample of ", "样本，容量 "),
    ("sample of ", "样本，容量 "),
    ("pooled s", "合并样本标准差 s"),
    ("limits ", "界限 "),
    ("shape = ", "形状参数 = "),
    ("scale = ", "尺度参数 = "),
    ("mean = ", "均值 = "),
    ("sd = ", "标准差 = "),
    (" values", " 个值"),
];

/// The words in the language of the report.
pub(super) fn how(text: &str, language: Language) -> String {
    match language {
        Language::English => text.to_string(),
        Language::Chinese => WORDS
            .iter()
            .fold(text.to_string(), |text, (en, zh)| text.replace(en, zh)),
    }
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
        assert_eq!(
            zh("√(a²/3 + d²/9), a = 1, d = 0.1 (GUM: u as stated)"),
            "√(a²/3 + d²/9), a = 1, d = 0.1 (GUM 法：按给出的 u)"
        );
    }
}
