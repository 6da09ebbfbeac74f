//! Units that are written out in Chinese, 毫米 for `mm`: what to write instead.

use super::builtin::{BuiltinUnit, Prefixes, UNITS};

/// The text of a unit for its Chinese name, with a prefix, a square or a cube if it has one.
pub(super) fn by_chinese_name(name: &str) -> Option<String> {
    let power = |word, exponent| Some((name.strip_prefix(word)?, exponent));
    match power("平方", 2).or_else(|| power("立方", 3)) {
        // A square degree Celsius is nothing.
        Some((base, exponent)) => prefixed(base)
            .filter(|symbol| symbol != "°C")
            .map(|symbol| format!("{symbol}^{exponent}")),
        None => prefixed(name),
    }
}

fn prefixed(name: &str) -> Option<String> {
    // 分 is the minute and 千克 the kilogram before their first characters are prefixes.
    whole(name).map(str::to_owned).or_else(|| {
        PREFIXES.iter().find_map(|(word, prefix)| {
            let symbol = whole(name.strip_prefix(word)?)?;
            let takes_prefix =
                |unit: &BuiltinUnit| unit.symbol == symbol && unit.prefixes == Prefixes::All;
            UNITS
                .iter()
                .any(takes_prefix)
                .then(|| format!("{prefix}{symbol}"))
        })
    })
}

fn whole(name: &str) -> Option<&'static str> {
    let short = SHORT.iter().find(|(word, _)| *word == name);
    short
        .map(|(_, symbol)| *symbol)
        .or_else(|| Some(UNITS.iter().find(|unit| unit.name_zh == name)?.symbol))
}

const PREFIXES: [(&str, &str); 12] = [
    ("毫", "m"),
    ("微", "µ"),
    ("纳", "n"),
    ("皮", "p"),
    ("飞", "f"),
    ("厘", "c"),
    ("分", "d"),
    ("百", "h"),
    ("千", "k"),
    ("兆", "M"),
    ("吉", "G"),
    ("太", "T"),
];

/// Short and everyday names beside the full ones of the table.
const SHORT: [(&str, &str); 30] = [
    ("公斤", "kg"),
    ("公里", "km"),
    ("公尺", "m"),
    ("公分", "cm"),
    ("安", "A"),
    ("伏", "V"),
    ("欧", "Ω"),
    ("瓦", "W"),
    ("焦", "J"),
    ("帕", "Pa"),
    ("赫", "Hz"),
    ("法", "F"),
    ("亨", "H"),
    ("特", "T"),
    ("开", "K"),
    ("牛", "N"),
    ("库", "C"),
    ("摩", "mol"),
    ("坎", "cd"),
    ("流", "lm"),
    ("韦", "Wb"),
    ("西", "S"),
    ("戈", "Gy"),
    ("希", "Sv"),
    ("贝可", "Bq"),
    ("分钟", "min"),
    ("时", "h"),
    ("天", "d"),
    ("年", "a"),
    ("公升", "L"),
];

#[cfg(test)]
mod tests {
    use super::super::UnitTable;
    use super::*;

    #[test]
    fn names_become_symbols_that_are_read() {
        for (name, symbol) in [
            ("毫米", "mm"),
            ("米", "m"),
            ("千克", "kg"),
            ("公斤", "kg"),
            ("克", "g"),
            ("毫克", "mg"),
            ("摄氏度", "°C"),
            ("微伏", "µV"),
            ("兆帕", "MPa"),
            ("千牛顿", "kN"),
            ("分", "min"),
            ("分贝", "dB"),
            ("毫升", "mL"),
            ("平方毫米", "mm^2"),
            ("立方米", "m^3"),
            ("小时", "h"),
        ] {
            assert_eq!(by_chinese_name(name).as_deref(), Some(symbol), "{name}");
            assert!(UnitTable::default().parse(symbol).is_ok(), "{symbol}");
        }
        for none in ["个", "毫千克", "千天", "平方平方米", "平方摄氏度"] {
            assert_eq!(by_chinese_name(none), None, "{none}");
        }
    }

    #[test]
    fn short_names_are_symbols_that_are_read() {
        for (name, symbol) in SHORT {
            assert!(UnitTable::default().parse(symbol).is_ok(), "{name}");
        }
    }
}
