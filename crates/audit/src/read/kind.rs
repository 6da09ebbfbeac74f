//! What is known of a quantity, from the words that a sheet has for it.

use crate::claim::{Relative, Shape, Stated};
use crate::printed::Printed;
use crate::units;

use super::converter;
use super::words::{
    count_after, count_before, figure_after, figure_before, has, signed_pair, sole_figure,
    trailing_count,
};

/// Everything that a row says of what is known.
#[derive(Debug, Clone, Copy)]
pub struct Evidence<'a> {
    /// Name, remarks and notes: true.
    pub words: &'a str,
    /// The laboratory's columns of distribution and type.
    pub columns: &'a str,
    /// The ± column.
    pub used: Option<&'a Printed>,
    /// Words in the head of the ± column.
    pub used_head: &'a str,
    /// The column of the standard uncertainty.
    pub u: Option<&'a Printed>,
    /// The divisor.
    pub divisor: Option<f64>,
    /// The number of readings in a column of its own.
    pub readings: Option<f64>,
    /// Whether the ± column is what was used, and not what is stated.
    pub full: bool,
    /// Readings behind the reported value, where a note says it for all rows.
    pub mean_of: Option<f64>,
}

/// Families of words.
#[rustfmt::skip]
mod family {
    pub const RANGE: &[&str] = &["range method", "range of the readings", "range of readings", "range r", "range of", "极差", "max-min", "max - min"];
    pub const ALIKE: &[&str] = &["readings are equal", "readings were equal", "equal readings", "readings are alike", "readings were alike", "readings are identical", "readings were identical", "identical readings", "no scatter", "读数完全相同", "读数相同", "读数均相同", "示值相同", "示值完全相同", "读数完全一致", "读数一致", "示值一致"];
    pub const POOLED: &[&str] = &["pooled", "合并样本", "合并标准", "合并实验", "合并"];
    pub const DEVIATION: &[&str] = &["standard deviation", "repeatability", "type a", "标准偏差", "标准差", "重复性", "s of", "s =", "s=", "a类", "experimental", "scatter", "readings agree", "readings are equal", "equal readings", "贝塞尔", "bessel", "次测量", "repeated"];
    pub const CERTIFICATE: &[&str] = &["certificate", "calibration certificate", "expanded", "证书", "扩展不确定度", "cert.", "calibration of", "calibrated", "u(k", "u (k", "k=2", "k = 2"];
    pub const FULL_WIDTH: &[&str] = &["full width", "total width", "whole width", "full range", "full interval", "peak-to-peak", "peak to peak", "全宽", "总宽", "全区间", "峰峰", "峰-峰", "区间宽度", "区间全", "width of the interval", "total span", "interval of width", "overall width", "全范围"];
    pub const STEP: &[&str] = &["resolution", "digital step", "step", "increment", "scale interval", "scale division", "division", "graduation", "least significant", "last digit", "digit", "分辨力", "分辨率", "步进", "分度值", "末位", "lsb", "量化", "quantisation", "quantization", "least count", "readability", "最小分度", "数字化", "刻度"];
    pub const CYCLING: &[&str] = &["cycling", "cyclic", "cycles", "amplitude", "sinusoid", "arcsine", "u-shaped", "u shaped", "oscillat", "幅值", "振幅", "周期", "正弦", "反正弦", "u形", "循环"];
    pub const LIMITS: &[&str] = &["limit", "limits", "maximum permissible", "mpe", "tolerance", "specification", "accuracy", "within", "bound", "允许误差", "允差", "误差限", "极限", "最大允许", "界限", "半宽", "half-width", "half width", "rectang", "uniform", "均匀", "矩形", "spec.", "±", "不超过", "at most", "准确度", "误差范围", "范围"];
    pub const STANDARD: &[&str] = &["standard uncertainty", "标准不确定度"];
    pub const TRIANGULAR: &[&str] = &["triang", "三角"];
    pub const TRAPEZOID: &[&str] = &["trapez", "梯形"];
    pub const NORMAL: &[&str] = &["normal", "gauss", "正态"];
    pub const TWO_POINT: &[&str] = &["two-point", "two point", "dirac", "两点"];
    pub const RECTANGULAR: &[&str] = &["rect", "uniform", "均匀", "矩形"];
    pub const READINGS: &[&str] = &["reading", "measurement", "observation", "repeat", "determination", "indications", "values", "runs", "次"];
    pub const MEAN: &[&str] = &["mean of", "average of", "averages of", "means of", "mean over", "m =", "m=", "reported as mean of", "averaged over", "取平均"];
}

use family::*;

/// What is stated, and whether it is relative.
pub fn stated(e: &Evidence<'_>) -> (Stated, Relative) {
    let text = e.words.to_lowercase();
    let columns = e.columns.to_lowercase();
    let stated = by_words(e, &text, &columns).or_else(|| by_columns(e, &columns));
    let stated = stated.unwrap_or_else(|| match e.u {
        Some(u) => Stated::Standard {
            u: u.clone(),
            dof: None,
        },
        None => e.used.map_or(Stated::Nothing, |used| Stated::Standard {
            u: used.clone(),
            dof: None,
        }),
    });
    let relative = relative(&stated, &text, e);
    (stated, relative)
}

fn by_words(e: &Evidence<'_>, text: &str, columns: &str) -> Option<Stated> {
    // What the heads and the laboratory's columns call a distribution is its own; words decide.
    if let Some(unequal) = unequal(e.words) {
        return Some(unequal);
    }
    if let Some(step) = converter::step(e.words) {
        return Some(Stated::Step { step });
    }
    let shape = shape(text);
    if has(text, RANGE)
        && (has(text, &["极差"]) || count(text, e).is_some())
        && !has(text, &["full range", "measuring range"])
    {
        let range = in_text(e.words, &["range method", "range r", "range", "极差"])
            .or_else(|| e.used.cloned())?;
        return Some(Stated::Range {
            range,
            n: count(text, e)?,
            m: mean(text, e).unwrap_or(1.0),
        });
    }
    if has(text, FULL_WIDTH) {
        let width = in_text(
            e.words,
            &[
                "full width",
                "total width",
                "whole width",
                "overall width",
                "interval of width",
                "full interval",
                "width",
                "peak-to-peak",
                "peak to peak",
                "全宽",
                "总宽",
                "宽度",
                "峰峰值",
                "峰-峰值",
                "total span",
                "span",
            ],
        );
        let used = || {
            e.used.map(|used| {
                if e.full {
                    used.clone().scaled(2.0)
                } else {
                    used.clone()
                }
            })
        };
        let shape = shape.unwrap_or(Shape::Rectangular);
        return width
            .or_else(used)
            .map(|width| Stated::FullWidth { width, shape });
    }
    if has(text, ALIKE) {
        // No scatter: what is left is the step of the indication, which the words have.
        return Some(Stated::Deviation {
            s: Printed::exact(0.0, "0"),
            n: None,
            m: 1.0,
            pooled: None,
        });
    }
    let reading = has(text, DEVIATION) || count_before(text, &["reading", "observation"]).is_some();
    let certificate = has(text, CERTIFICATE) && !has(text, &["specification", "允许误差", "limit"]);
    // `resolution contained in the repeatability` is about a resolution: what comes first is the subject.
    let first = |keys: &[&str]| {
        keys.iter()
            .filter_map(|key| super::words::find(text, key, 0))
            .min()
    };
    let step_first = first(STEP).is_some_and(|step| {
        first(DEVIATION).is_none_or(|s| step < s) && first(CERTIFICATE).is_none_or(|c| step < c)
    });
    let about_step = first(STEP)
        .map(|at| text[at..].split([';', '(', ',']).next().unwrap_or_default())
        .unwrap_or_default();
    if step_first
        && !has(
            about_step,
            &[
                "half the",
                "half of",
                "half a step =",
                "half step",
                "1/2",
                "半宽",
                "半个",
            ],
        )
    {
        return step(e, text);
    }
    if certificate && (!reading || first(CERTIFICATE) < first(DEVIATION)) {
        return self::certificate(e, text);
    }
    if reading && !(has(text, LIMITS) && first(LIMITS) < first(DEVIATION)) {
        return deviation(e, text, columns);
    }
    if has(text, CYCLING) {
        let half_width = in_text(
            e.words,
            &[
                "amplitude",
                "±",
                "幅值",
                "振幅",
                "cycling",
                "within",
                "limits",
            ],
        )
        .or_else(|| e.used.cloned())?;
        return Some(Stated::Limits {
            half_width,
            shape: Shape::Arcsine,
            shape_stated: true,
        });
    }
    if has(text, LIMITS) || shape.is_some() {
        return limits(e, text, shape);
    }
    if has(text, STANDARD) {
        let u = in_text(e.words, STANDARD)
            .or_else(|| e.used.cloned())
            .or_else(|| e.u.cloned())?;
        return Some(Stated::Standard { u, dof: None });
    }
    None
}

fn limits(e: &Evidence<'_>, text: &str, shape: Option<Shape>) -> Option<Stated> {
    const KEYS: &[&str] = &[
        "±",
        "+/-",
        "limits",
        "limit",
        "mpe",
        "maximum permissible error",
        "tolerance",
        "accuracy",
        "within",
        "half-width",
        "half width",
        "允许误差",
        "最大允差",
        "允差",
        "误差限",
        "极限",
        "界限",
        "半宽",
        "不超过",
        "specification",
        "bound",
        "范围",
        "误差",
    ];
    let half_width = in_text(e.words, KEYS).or_else(|| e.used.cloned())?;
    let level = has(
        text,
        &[
            "95 %",
            "95%",
            "confidence of",
            "level of confidence",
            "置信",
        ],
    ) && !has(
        text,
        &[
            "no level",
            "without a level",
            "nothing else",
            "without level",
            "未给出置信",
            "无置信",
        ],
    );
    let shape = shape.or_else(|| level.then(|| Shape::Normal(normal_factor(e, text))));
    Some(Stated::Limits {
        half_width,
        shape: shape.unwrap_or(Shape::Rectangular),
        shape_stated: shape.is_some(),
    })
}

/// The factor that limits at 95 % stand for: as stated, else 1.96 or 2, as the laboratory has it.
fn normal_factor(e: &Evidence<'_>, text: &str) -> f64 {
    let stated = figure_after(text, &["k"])
        .map(|k| k.value)
        .filter(|k| (1.0..5.0).contains(k));
    stated.unwrap_or(if e.divisor == Some(2.0) { 2.0 } else { 1.96 })
}

fn step(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    const KEYS: &[&str] = &[
        "digital step",
        "step",
        "resolution",
        "increment",
        "scale interval",
        "scale division",
        "division",
        "graduation",
        "readability",
        "least count",
        "最小分度",
        "最小刻度",
        "刻度",
        "分辨力",
        "分辨率",
        "步进",
        "分度值",
        "末位",
        "量化单位",
        "lsb",
        "digit",
    ];
    if let Some(step) = in_text(e.words, KEYS) {
        // `resolution ± 0.005` is half of it.
        let half = step.text.trim_start().starts_with('±')
            || text.contains(&format!("± {}", step.text))
            || text.contains(&format!("±{}", step.text));
        let shape = (Shape::Rectangular, true);
        return Some(if half {
            Stated::Limits {
                half_width: step,
                shape: shape.0,
                shape_stated: shape.1,
            }
        } else {
            Stated::Step { step }
        });
    }
    let used = e.used?.clone();
    let by_twice_root3 = e
        .divisor
        .is_some_and(|d| (d - 2.0 * libm::sqrt(3.0)).abs() < 0.02);
    let whole = !e.full || by_twice_root3;
    Some(if whole {
        Stated::Step { step: used }
    } else {
        Stated::Step {
            step: used.scaled(2.0),
        }
    })
}

fn certificate(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    const KEYS: &[&str] = &[
        "expanded uncertainty",
        "扩展不确定度",
        "u =",
        "u=",
        "u(k=2)",
        "u95",
        "u",
        "uncertainty",
        "不确定度",
    ];
    let expanded = in_text(e.words, KEYS).or_else(|| e.used.cloned())?;
    let stated = figure_after(text, &["k =", "k=", "k", "coverage factor", "包含因子"])
        .map(|k| k.value)
        .filter(|k| (1.0..5.0).contains(k));
    let head = figure_after(&e.used_head.to_lowercase(), &["k"])
        .map(|k| k.value)
        .filter(|k| (1.0..5.0).contains(k));
    let by_divisor = e
        .divisor
        .filter(|d| (1.6..3.5).contains(d) && (d - libm::sqrt(3.0)).abs() > 0.01);
    let k = stated.or(head).unwrap_or_else(|| by_divisor.unwrap_or(2.0));
    Some(Stated::Certificate {
        expanded,
        k,
        k_stated: stated.or(head).is_some(),
    })
}

/// What says that a figure is that of the mean already.
const OF_THE_MEAN: &[&str] = &[
    "deviation of the mean",
    "deviation of mean",
    "s of mean",
    "s of the mean",
    "esdm",
    "平均值的标准",
    "平均值的实验标准",
    "均值的标准",
];

fn deviation(e: &Evidence<'_>, text: &str, columns: &str) -> Option<Stated> {
    const KEYS: &[&str] = &[
        "standard deviation",
        "s_p =",
        "s_p",
        "sp =",
        "s(x)",
        "s =",
        "s=",
        "s",
        "标准偏差",
        "标准差",
        "重复性",
        "repeatability",
    ];
    let s = in_text(e.words, KEYS).or_else(|| e.used.cloned());
    let s = s.or_else(|| {
        has(text, &["equal", "all alike", "相同", "一致"]).then(|| Printed::exact(0.0, "0"))
    })?;
    let n = count(text, e);
    let pooled = has(text, POOLED).then(|| pooled_freedom(text, n)).flatten();
    let mut m = mean(text, e);
    if m.is_none()
        && has(text, &["mean", "average", "平均", "均值"])
        && !has(text, &["single", "单次"])
    {
        m = n;
    }
    let squared = e
        .divisor
        .map(|d| d * d)
        .filter(|m| *m > 1.2 && (m - libm::round(*m)).abs() < 0.03 * m);
    // Nothing is stated of how many readings are behind the value: the laboratory's own divisor is all there is.
    let unsaid = n.is_none() && !has(text, &["single", "单次"]);
    let m = has(text, OF_THE_MEAN)
        .then_some(1.0)
        .or(m)
        .or(e.mean_of)
        .or_else(|| squared.filter(|_| unsaid).map(libm::round))
        .unwrap_or(1.0);
    let _ = columns;
    Some(Stated::Deviation { s, n, m, pooled })
}

/// Degrees of freedom of a pooled standard deviation: as stated, or series × (readings − 1).
fn pooled_freedom(text: &str, n: Option<f64>) -> Option<f64> {
    let stated = figure_after(text, &["degrees of freedom", "ν", "dof", "自由度"]).map(|p| p.value);
    let before = || count_before(text, &["degrees of freedom", "dof"]);
    let series = || {
        count_before(
            text,
            &[
                "series", "sets", "groups", "组", "系列", "days", "天", "runs",
            ],
        )
    };
    stated
        .or_else(before)
        .or_else(|| Some(series()? * (n? - 1.0)))
}

/// Readings from which s was computed.
fn count(text: &str, e: &Evidence<'_>) -> Option<f64> {
    const OF: &[&str] = &[
        "n =",
        "n=",
        "series of",
        "sets of",
        "组每组",
        "每组",
        "each of",
        "from",
        "s of",
        "study of",
        "of",
    ];
    let mean = MEAN
        .iter()
        .filter_map(|key| super::words::find(text, key, 0))
        .min();
    let before_mean = mean.map_or(text, |at| &text[..at]);
    let direct = count_after(text, &["n =", "n=", "n"]);
    let each = || count_after(text, &["series of", "sets of", "每组"]).filter(|n| *n > 1.0);
    let counted = || {
        count_before(before_mean, READINGS)
            .or_else(|| count_after(before_mean, OF).filter(|_| has(before_mean, READINGS)))
    };
    direct
        .or_else(each)
        .or_else(counted)
        .or_else(|| after_mean(text, mean))
        .or(e.readings)
        .filter(|n| *n > 1.0)
}

/// `mean of 5 readings; s from 10 readings`: a count behind that of the mean.
fn after_mean(text: &str, mean: Option<usize>) -> Option<f64> {
    let rest = text.get(mean?..)?;
    let clause = rest.find([';', ',', '。', '('])?;
    count_before(&rest[clause..], READINGS)
}

/// Readings behind the reported value.
fn mean(text: &str, e: &Evidence<'_>) -> Option<f64> {
    // `取 3 次测量的平均值`: a count with 平均 behind it in the same clause.
    let chinese = || {
        let counts = text.match_indices('次').filter(|(at, _)| {
            let behind = text[at + '次'.len_utf8()..].split([',', ';', '。', '、', '(']);
            behind
                .take(1)
                .any(|clause| clause.contains("平均") || clause.contains("均值"))
        });
        counts
            .filter_map(|(at, _)| trailing_count(&text[..at]))
            .last()
    };
    let single = has(
        text,
        &[
            "single reading is reported",
            "one reading",
            "单次测量结果",
            "单次测得",
        ],
    )
    .then_some(1.0);
    chinese()
        .or_else(|| count_after(text, MEAN))
        .or_else(|| {
            count_before(
                text,
                &[
                    "readings are averaged",
                    "readings averaged",
                    "readings behind",
                    "readings reported",
                ],
            )
        })
        .or(single)
        .or(e.mean_of)
}

/// `+0.03 / −0.01`, as positive numbers; limits where both are the same.
fn unequal(text: &str) -> Option<Stated> {
    let (plus, minus) = signed_pair(text)?;
    Some(if plus.value == minus.value {
        let shape = shape(text);
        Stated::Limits {
            half_width: plus,
            shape: shape.unwrap_or(Shape::Rectangular),
            shape_stated: shape.is_some(),
        }
    } else {
        Stated::Unequal { plus, minus }
    })
}

fn shape(text: &str) -> Option<Shape> {
    let beta = || figure_after(text, &["β", "beta"]).map_or(0.5, |b| b.value);
    if has(text, TRIANGULAR) {
        Some(Shape::Triangular)
    } else if has(text, TRAPEZOID) {
        Some(Shape::Trapezoidal(beta()))
    } else if has(text, &["arcsine", "u-shaped", "u shaped", "反正弦", "u形"]) {
        Some(Shape::Arcsine)
    } else if has(text, TWO_POINT) {
        Some(Shape::TwoPoint)
    } else {
        has(text, RECTANGULAR).then_some(Shape::Rectangular)
    }
}

/// Where words say nothing, the laboratory's own columns are what there is.
fn by_columns(e: &Evidence<'_>, columns: &str) -> Option<Stated> {
    let used = e.used?.clone();
    if let Some(shape) = shape(columns) {
        return Some(Stated::Limits {
            half_width: used,
            shape,
            shape_stated: true,
        });
    }
    let type_a = columns
        .split(|c: char| !c.is_alphanumeric())
        .any(|word| word == "a" || word == "a类" || word == "t");
    if type_a {
        return deviation(e, "", columns);
    }
    if has(columns, NORMAL) {
        let k = figure_after(columns, &["k"]).map(|k| k.value);
        let k_stated = k.is_some();
        // A divisor of 1 under a normal distribution is a standard uncertainty.
        let k = k.or(e.divisor).unwrap_or(2.0);
        return Some(match k {
            1.0 => Stated::Standard { u: used, dof: None },
            k => Stated::Certificate {
                expanded: used,
                k,
                k_stated,
            },
        });
    }
    let divisor = e.divisor?;
    let close = |x: f64| (divisor - x).abs() < 0.01 * x;
    let limits = |shape| {
        Some(Stated::Limits {
            half_width: used.clone(),
            shape,
            shape_stated: false,
        })
    };
    match () {
        () if close(libm::sqrt(3.0)) => limits(Shape::Rectangular),
        () if close(libm::sqrt(6.0)) => limits(Shape::Triangular),
        () if close(2.0 * libm::sqrt(3.0)) => Some(Stated::Step { step: used }),
        () if close(libm::sqrt(2.0)) => limits(Shape::Arcsine),
        () if close(1.0) => Some(Stated::Standard { u: used, dof: None }),
        () => Some(Stated::Certificate {
            expanded: used,
            k: divisor,
            k_stated: false,
        }),
    }
}

/// A figure of the words; its half unit counts as that of a printed figure.
fn in_text(text: &str, keys: &[&str]) -> Option<Printed> {
    let of_clause = || {
        let clauses = text.split(';').rev();
        let said = clauses.filter(|clause| has(&clause.to_lowercase(), keys));
        said.filter_map(sole_figure).next()
    };
    figure_after(text, keys)
        .or_else(|| figure_before(text, keys))
        .or_else(|| sole_figure(text))
        .or_else(of_clause)
}

fn relative(stated: &Stated, text: &str, e: &Evidence<'_>) -> Relative {
    let unit = stated.figure().map_or("", |figure| figure.unit.as_str());
    let Some(fraction) = units::fraction(unit) else {
        return Relative::No;
    };
    let full_scale = figure_after(
        text,
        &[
            "full scale of",
            "full scale",
            "fs =",
            "f.s.",
            "fs",
            "range of",
            "满量程",
            "满度",
            "量程",
        ],
    );
    let of_full_scale = has(
        text,
        &[
            "of full scale",
            "full scale",
            "f.s.",
            "fs",
            "满量程",
            "满度",
            "量程",
            "of range",
            "of the range",
        ],
    );
    let _ = e;
    match full_scale {
        Some(scale) if of_full_scale => Relative::OfFullScale(fraction, scale.value),
        _ => Relative::OfValue(fraction),
    }
}

impl Stated {
    /// The figure that is stated; the larger one of unequal limits.
    pub fn figure(&self) -> Option<&Printed> {
        match self {
            Stated::Nothing => None,
            Stated::Certificate { expanded, .. } => Some(expanded),
            Stated::Limits { half_width, .. } => Some(half_width),
            Stated::FullWidth { width, .. } => Some(width),
            Stated::Step { step } => Some(step),
            Stated::Unequal { plus, minus } => Some(if plus.value >= minus.value {
                plus
            } else {
                minus
            }),
            Stated::Deviation { s, .. } => Some(s),
            Stated::Range { range, .. } => Some(range),
            Stated::Standard { u, .. } => Some(u),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(words: &str, used: Option<f64>, full: bool) -> Stated {
        let used = used.map(|x| Printed::parse(&x.to_string()).unwrap());
        let e = Evidence {
            words,
            columns: "",
            used: used.as_ref(),
            used_head: "",
            u: None,
            divisor: None,
            readings: None,
            full,
            mean_of: None,
        };
        stated(&e).0
    }

    #[test]
    fn kinds_in_english_and_chinese() {
        let certificate = |words: &str| match read(words, None, true) {
            Stated::Certificate { expanded, k, .. } => (expanded.value, k),
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(
            certificate("certificate M-12: U = 0.05 g, k = 2"),
            (0.05, 2.0)
        );
        assert_eq!(
            certificate("标准砝码证书给出扩展不确定度 U=0.05 g，k=2.13"),
            (0.05, 2.13)
        );
        let step = |words: &str, used| match read(words, used, false) {
            Stated::Step { step } => step.value,
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(step("digital step 0.01 mm", None), 0.01);
        assert_eq!(step("数显分辨力", Some(0.01)), 0.01);
        let deviation = |words: &str| match read(words, Some(0.012), true) {
            Stated::Deviation { s, n, m, pooled } => (s.value, n, m, pooled),
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(
            deviation("s of 10 readings, mean of 4 reported"),
            (0.012, Some(10.0), 4.0, None)
        );
        assert_eq!(
            deviation("repeatability: standard deviation of 10 readings, the mean is reported"),
            (0.012, Some(10.0), 10.0, None)
        );
        assert_eq!(
            deviation("重复测量10次的实验标准偏差，取4次平均值"),
            (0.012, Some(10.0), 4.0, None)
        );
        assert_eq!(
            deviation("pooled s from 6 series of 5 readings, mean of 3 readings"),
            (0.012, Some(5.0), 3.0, Some(24.0))
        );
        let shape = |words: &str| match read(words, Some(0.3), true) {
            Stated::Limits {
                half_width, shape, ..
            } => (half_width.value, shape),
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(shape("limits ±0.5 °C"), (0.5, Shape::Rectangular));
        assert_eq!(
            shape("cycling of the air conditioning, amplitude 0.4 °C"),
            (0.4, Shape::Arcsine)
        );
        assert_eq!(shape("最大允许误差 ±0.2 mV"), (0.2, Shape::Rectangular));
        assert_eq!(
            shape("within the limits, triangular"),
            (0.3, Shape::Triangular)
        );
        assert!(matches!(
            read("tolerance +0.03/-0.01 mm", None, true),
            Stated::Unequal { .. }
        ));
        assert!(matches!(
            read("total width 0.4 K", None, true),
            Stated::FullWidth { .. }
        ));
        assert!(matches!(
            read("极差法，n=4", Some(0.3), true),
            Stated::Range { n: 4.0, .. }
        ));
    }
}
