//! What is remarked about readings, and says nothing of how large a quantity may be.

use super::words::has;

/// Words without the sentences that say nothing of the quantity: of an autocorrelation of its readings, the limits of which are none
/// of it, and what a reader is asked to look for.
pub fn stating(words: &str) -> String {
    const AUTOCORRELATION: &[&str] = &["autocorrelat", "自相关", "lag 1", "lag-1"];
    const ASKING: &[&str] = &[
        "look for",
        "check whether",
        "check for",
        "please check",
        "请检查",
        "请核对",
        "请查",
    ];
    let remarks = |sentence: &&str| {
        let lower = sentence.to_lowercase();
        has(&lower, AUTOCORRELATION) || has(&lower, ASKING)
    };
    let sentences = words.split_inclusive([';', '；', '。']);
    sentences.filter(|sentence| !remarks(sentence)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_of_an_autocorrelation_are_none_of_the_quantity() {
        for (words, stated) in [
            (
                "s = 0.02 mm; autocorrelation -0.58, outside ±0.52",
                "s = 0.02 mm;",
            ),
            (
                "一阶自相关系数 -0.58，超出 ±0.52；最大允许误差 ±0.2 mm",
                "最大允许误差 ±0.2 mm",
            ),
            ("请检查是否存在周期性干扰。", ""),
            ("正弦温度波动 ±0.2 ℃", "正弦温度波动 ±0.2 ℃"),
        ] {
            assert_eq!(stating(words), stated);
        }
    }
}
