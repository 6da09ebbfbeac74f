//! Units that are written out in Chinese, 毫米 for `mm`: their symbols.

use super::builtin::{BuiltinUnit, Prefixes, UNITS};
use crate::letters::is_chinese;

/// A unit of which names are written out in Chinese, in symbols: `kN·m` of 千牛·米, `m/s^2` of 米每二次方秒, `mg/L` of `mg/升`.
/// `None` where none are, or one is the name of no unit.
pub fn unit_of_chinese(text: &str) -> Option<String> {
    text.contains(is_chinese).then_some(())?;
    let factors = text.split_inclusive(['/', '·', '*']);
    let symbols = factors.map(|factor| {
        let end = factor.trim_end_matches(['/', '·', '*']).len();
        let (factor, sign) = factor.split_at(end);
        let name = factor.trim_end_matches(|c: char| c.is_ascii_digit() || "^-−".contains(c));
        let symbol = match name.contains(is_chinese) {
            true => by_chinese_name(name.trim())?,
            false => name.to_owned(),
        };
        Some(format!("{symbol}{}{sign}", &factor[name.len()..]))
    });
    symbols.collect()
}

/// The text of a unit for its Chinese name, with a prefix, a square or a cube if it has one; a quotient is read with 每.
pub(super) fn by_chinese_name(name: &str) -> Option<String> {
    powered(name).or_else(|| {
        let (above, below) = name.split_once('每')?;
        Some(format!("{}/{}", product(above)?, below_solidus(below)?))
    })
}

/// 千克开尔文 in 焦耳每千克开尔文.
fn below_solidus(name: &str) -> Option<String> {
    let product = product(name)?;
    match product.contains('·') {
        true => Some(format!("({product})")),
        false => Some(product),
    }
}

/// One unit, or two of which the names stand beside each other, as they do only above and below 每: elsewhere 分度 is no
/// minute times degree.
fn product(name: &str) -> Option<String> {
    let two = |at: usize| {
        Some(format!(
            "{}·{}",
            powered(&name[..at])?,
            powered(&name[at..])?
        ))
    };
    let ends = || name.char_indices().map(|(at, _)| at).filter(|at| *at > 0);
    powered(name).or_else(|| ends().rev().find_map(two))
}

fn powered(name: &str) -> Option<String> {
    let power = POWERS
        .iter()
        .find_map(|(word, exponent)| Some((name.strip_prefix(word)?, exponent)));
    match power {
        // A square degree Celsius is nothing.
        Some((base, exponent)) => prefixed(base)
            .filter(|symbol| symbol != "°C")
            .map(|symbol| format!("{symbol}^{exponent}")),
        None => prefixed(name),
    }
}

/// 平方米 is an area, and 米每二次方秒 an acceleration.
const POWERS: [(&str, u8); 4] = [("平方", 2), ("二次方", 2), ("立方", 3), ("三次方", 3)];

fn prefixed(name: &str) -> Option<String> {
    // The division of a scale, of which nobody means the tenth of a degree.
    if name == "分度" {
        return None;
    }
    // 分 is the minute and 千克 the kilogram before their first characters are prefixes.
    whole(name).map(str::to_owned).or_else(|| {
        PREFIXES.iter().find_map(|(word, prefix)| {
            let symbol = whole(name.strip_prefix(word)?)?;
            // That of a product is the prefix of its first unit.
            let first = symbol.split('·').next()?;
            let takes_prefix =
                |unit: &BuiltinUnit| unit.symbol == first && unit.prefixes == Prefixes::All;
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
const SHORT: [(&str, &str); 34] = [
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
    ("帕秒", "Pa·s"),
    ("帕斯卡秒", "Pa·s"),
    ("牛米", "N·m"),
    ("牛顿米", "N·m"),
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
        for none in [
            "个",
            "毫千克",
            "千天",
            "平方平方米",
            "平方摄氏度",
            "分度",
            "天平",
            "每次",
            "时每",
        ] {
            assert_eq!(by_chinese_name(none), None, "{none}");
        }
    }

    #[test]
    fn units_are_read_as_gb_3100_names_them() {
        for (text, symbols) in [
            ("千帕", "kPa"),
            ("牛·米", "N·m"),
            ("千牛米", "kN·m"),
            ("毫帕秒", "mPa·s"),
            ("mg/升", "mg/L"),
            ("牛/毫米2", "N/mm2"),
            ("米每二次方秒", "m/s^2"),
            ("立方米每小时", "m^3/h"),
            ("摩尔每升", "mol/L"),
            ("转每分", "rpm"),
            ("转/分", "r/min"),
            ("瓦每平方米开尔文", "W/(m^2·K)"),
            ("焦耳每千克开尔文", "J/(kg·K)"),
        ] {
            assert_eq!(unit_of_chinese(text).as_deref(), Some(symbols), "{text}");
            assert!(UnitTable::default().parse(symbols).is_ok(), "{symbols}");
        }
        for none in ["kPa", "千帕/次", "测量/分", "牛 米", ""] {
            assert_eq!(unit_of_chinese(none), None, "{none}");
        }
    }

    #[test]
    fn short_names_are_symbols_that_are_read() {
        for (name, symbol) in SHORT {
            assert!(UnitTable::default().parse(symbol).is_ok(), "{name}");
        }
    }
}
