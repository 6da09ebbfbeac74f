//! What distinguishes variants, places and parts of a recording, in the language of the report.
//!
//! The diagnosis writes these labels itself, from a few forms; names of columns and levels in them are the
//! user's and stay as they are.

use crate::language::Language;

/// A label in the language of the report.
pub(super) fn spoken(label: &str, language: Language) -> String {
    match language {
        Language::English => label.to_owned(),
        Language::Chinese => label
            .split(", ")
            .map(chinese)
            .collect::<Vec<_>>()
            .join("，"),
    }
}

/// Labels that are always the same.
const FIXED: [(&str, &str); 36] = [
    ("with a constant", "含常数项"),
    ("about zero", "以零点为中心"),
    ("with its half", "含其半周期"),
    ("anew in each run", "每次运行重新开始"),
    ("not in balance at the start", "起始时未平衡"),
    ("engaged at the start", "起始时已啮合"),
    ("reversed at the start", "起始时刚换向"),
    ("bent beyond the recording", "在记录之外弯曲"),
    ("levelling off", "趋于饱和"),
    ("at once", "即时"),
    ("in proportion to the signal", "与信号成比例"),
    ("one row late", "晚一行"),
    ("one row early", "早一行"),
    ("two widths", "两种宽度"),
    ("row", "行"),
    ("rows", "行"),
    ("first half", "前半段"),
    ("second half", "后半段"),
    ("square alone", "仅平方项"),
    ("with a linear part", "含线性项"),
    ("with a square and a linear part", "含平方项和线性项"),
    ("with its rate of change", "含变化率"),
    ("with its square", "含平方项"),
    ("with the root of time", "随时间的平方根"),
    ("slowing down", "逐渐变缓"),
    ("bent", "弯曲"),
    ("all", "全部"),
    ("of the whole reading", "整个读数"),
    ("each with a sensitivity of its own", "各有各的灵敏度"),
    ("each with a size of its own", "各有各的大小"),
    ("several widths", "多种宽度"),
    ("widest in the middle", "中间最宽"),
    ("of the next movement at rest", "停住时取随后的方向"),
    ("on rising values only", "仅上行"),
    ("on falling values only", "仅下行"),
    ("1 year", "1 年"),
];

/// Labels around a figure or a name: what stands before and after it, and the same in Chinese.
const FORMS: [([&str; 2], [&str; 2]); 24] = [
    (["", " % of the range"], ["", " % 量程"]),
    (["half at ", ""], ["半值点 ", ""]),
    (["period ", ""], ["周期 ", ""]),
    (["by about ", ""], ["约 ", ""]),
    (["about ", ""], ["", " 附近"]),
    (["w = ", ""], ["特征宽度 ", ""]),
    (["", " per turn"], ["每转 ", " 次"]),
    (["above ", " of the largest"], ["超过最大值的 ", " 倍"]),
    (["above ", ""], ["高于 ", ""]),
    (["below ", ""], ["低于 ", ""]),
    (["within ", ""], ["±", " 以内"]),
    (["width ", ""], ["宽度 ", ""]),
    (["gap ", ""], ["间隙 ", ""]),
    (["step ", ""], ["步距 ", ""]),
    (["other axis ", ""], ["另一轴 ", ""]),
    (["dying away over ", ""], ["衰减，特征宽度 ", ""]),
    (["growing over ", ""], ["增长，特征宽度 ", ""]),
    (["over ", ""], ["特征宽度 ", ""]),
    (["towards ", ""], ["趋向 ", ""]),
    (["row ", ""], ["第 ", " 行"]),
    (["rows ", ""], ["第 ", " 行"]),
    (["from ", " on"], ["自 ", " 起"]),
    (["only in ", ""], ["仅限 ", ""]),
    (["another size in each ", ""], ["每个 ", " 大小各异"]),
];

/// Words in the formulas of effects, phrases before the words in them.
const WORDS: [(&str, &str); 14] = [
    ("on a temperature of the model", "作用于模型中的温度时"),
    (
        "times the signal where it acts on the scale",
        "作用于标度时再乘以信号",
    ),
    ("the reading before the stretch", "该段之前的读数"),
    ("noise larger by a factor", "噪声增大若干倍"),
    ("signal along the axis", "沿轴的信号"),
    ("model at ", "模型代入 "),
    ("model", "模型"),
    ("mean", "均值"),
    ("signal", "信号"),
    ("direction", "方向"),
    ("shape", "形状"),
    ("axis", "轴"),
    ("row", "行"),
    ("or", "或"),
];

/// The formula of an effect, before names of columns are put in, in the language of the report.
pub(super) fn formula_in(formula: &str, language: Language) -> String {
    match language {
        Language::English => formula.to_owned(),
        Language::Chinese => WORDS
            .iter()
            .fold(listed(formula), |text, (english, chinese)| {
                replaced(&text, english, chinese)
            }),
    }
}

/// Formulas one after the other with Chinese commas between them; those between the arguments of a function stay.
fn listed(formulas: &str) -> String {
    let mut depth = 0_i32;
    let parts = formulas.split_inclusive(", ").map(|part| {
        let inside = |c: char| i32::from(c == '(') - i32::from(c == ')');
        depth += part.chars().map(inside).sum::<i32>();
        match part.strip_suffix(", ") {
            Some(formula) if depth == 0 => format!("{formula}，"),
            _ => part.to_owned(),
        }
    });
    parts.collect()
}

/// A text with a word replaced where it is no part of another.
fn replaced(text: &str, word: &str, by: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(word) {
        let (before, after) = (&rest[..at], &rest[at + word.len()..]);
        let letter = |c: char| c.is_ascii_alphanumeric();
        let begins = word.starts_with(letter) && before.ends_with(letter);
        let goes_on = word.ends_with(letter) && after.starts_with(letter);
        out += before;
        out += if begins || goes_on { word } else { by };
        rest = after;
    }
    out + rest
}

fn chinese(label: &str) -> String {
    if let Some((_, fixed)) = FIXED.iter().find(|(english, _)| *english == label) {
        return (*fixed).to_owned();
    }
    for ([before, after], [opens, closes]) in FORMS {
        let within = label
            .strip_prefix(before)
            .and_then(|rest| rest.strip_suffix(after));
        if let Some(within) = within.filter(|within| !within.is_empty()) {
            return format!("{opens}{}{closes}", chinese(within));
        }
    }
    // Where a slope changes: `at 4.17 V`.
    match label.strip_prefix("at ") {
        Some(place) => format!("在 {place} 处"),
        None => ranges(label),
    }
}

/// Two figures: `3.5 to 7.1 h`, `τ = 0.5 and 2 h`, `V between 3 and 5`; ends of ranges: `abs(V) above 3, 8`; two names:
/// `ax with gy`; a number of rows.
fn ranges(text: &str) -> String {
    let is_name = |part: &str| !part.contains(' ');
    match text.split_once(" with ") {
        Some((first, second)) if is_name(first) && is_name(second) => {
            return format!("{first} 与 {second}");
        }
        _ => {}
    }
    if let Some(rows) = text.strip_suffix(" row")
        && rows.parse::<f64>().is_ok()
    {
        return format!("{rows} 行");
    }
    for (english, chinese) in [(" between ", " 介于 "), (" above ", " 高于 ")] {
        if let Some((name, figures)) = text.split_once(english) {
            return format!("{name}{chinese}{}", ranges(figures));
        }
    }
    for (english, chinese) in [(" to ", " 至 "), (" and ", " 与 ")] {
        if let Some((first, second)) = text.split_once(english) {
            let figure = first.rsplit(' ').next().unwrap_or(first);
            let begins = second.split(' ').next().unwrap_or(second);
            if figure.parse::<f64>().is_ok() && begins.parse::<f64>().is_ok() {
                return format!("{first}{chinese}{second}");
            }
        }
    }
    text.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_of_functions_stay() {
        let told = |formula: &str| formula_in(formula, Language::Chinese);
        assert_eq!(
            told("{y} = model + β·max({x} − x₀, 0)"),
            "{y} = 模型 + β·max({x} − x₀, 0)"
        );
        assert_eq!(told("β·t, ln(1 + t/t₀) or √t"), "β·t，ln(1 + t/t₀) 或 √t");
    }

    #[test]
    fn labels_are_told_in_chinese() {
        for (english, chinese) in [
            ("2 per turn", "每转 2 次"),
            ("τ = 4.2 and 16.8 h", "τ = 4.2 与 16.8 h"),
            ("3.5 to 7.1 h", "3.5 至 7.1 h"),
            ("growing over 8 K", "增长，特征宽度 8 K"),
            ("about 340.2 mm, w = 20 mm", "340.2 mm 附近，特征宽度 20 mm"),
            ("V between -27 and -9", "V 介于 -27 与 -9"),
            ("abs(V) above 3, 8", "abs(V) 高于 3，8"),
            ("rows 3 and 4", "第 3 与 4 行"),
            ("rows 61 to 80", "第 61 至 80 行"),
            ("width 15 % of the range", "宽度 15 % 量程"),
            ("levelling off, half at 3 h", "趋于饱和，半值点 3 h"),
            ("place front", "place front"),
            ("ax with gy", "ax 与 gy"),
            ("period 10.993 row", "周期 10.993 行"),
            ("from run 3 on", "自 run 3 起"),
            ("τ = 3 s, only in run 3", "τ = 3 s，仅限 run 3"),
            ("above 0.9 of the largest", "超过最大值的 0.9 倍"),
            ("deflection, above 4.2 V", "deflection，高于 4.2 V"),
            ("slowing down, t₀ = 3 h", "逐渐变缓，t₀ = 3 h"),
            // Names of the user's own stay.
            ("salt and pepper", "salt and pepper"),
            ("up to", "up to"),
        ] {
            assert_eq!(spoken(english, Language::Chinese), chinese);
            assert_eq!(spoken(english, Language::English), english);
        }
    }
}
