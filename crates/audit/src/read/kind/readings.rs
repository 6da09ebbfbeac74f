//! What is known from readings: their standard deviation, how many they were, and how many are behind the value.

use crate::claim::{Stated, range_factor};
use crate::printed::Printed;
use crate::read::counts::{count_after, count_before, trailing_count};
use crate::read::family::*;
use crate::read::words::{figure_after, find, has};

use super::evidence::Evidence;
use super::limits::shape;

/// What says that a figure is that of the mean already.
const OF_THE_MEAN: &[&str] = &[
    "deviation of the mean",
    "deviation of mean",
    "dev. of the mean",
    "dev. of mean",
    "dev of the mean",
    "dev of mean",
    "error of the mean",
    "standard error",
    "std of mean",
    "std of the mean",
    "std. of mean",
    "std. of the mean",
    "sd of mean",
    "sd of the mean",
    "sdom",
    "sdm",
    "s of mean",
    "s of the mean",
    "esdm",
    "平均值的标准",
    "平均值的实验标准",
    "均值的标准",
];

/// The same, as the formula of what the figure is.
const OF_ROOT: &[&str] = &["s/√", "s / √", "s/sqrt", "s/sqrt("];

/// What says that a figure is that of single readings.
const OF_SINGLE: &[&str] = &[
    "s =",
    "s=",
    "s of",
    "s from",
    "s(",
    "s)",
    ", s",
    "s_p",
    "pooled",
    "std",
    "sd",
    "deviation",
    "scatter of",
    "s von",
    "standardabweichung",
    "experimental",
    "bessel",
    "标准偏差",
    "标准差",
    "贝塞尔",
    "合并",
    "单次",
];

pub(super) fn deviation(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    const KEYS: &[&str] = &[
        "standard deviation",
        "s_p =",
        "s_p=",
        "s_p",
        "sp =",
        "s(x)",
        "s pooled",
        "pooled s",
        "s =",
        "s=",
        "s",
        "标准偏差",
        "标准差",
        "重复性",
        "repeatability",
    ];
    let n = count(text, e);
    // `repeatability of 5`: how many they were, beside another figure that was used.
    let is_count = |s: &Printed| {
        let used = e.used.or(e.u).filter(|used| used.value != s.value);
        s.unit.is_empty() && Some(s.value) == n && used.is_some()
    };
    let named = e.figure(KEYS).filter(|s| !is_count(s));
    let s = named.or_else(|| e.used.cloned()).or_else(|| {
        has(text, &["equal", "all alike", "相同", "一致"]).then(|| Printed::exact(0.0, "0"))
    })?;
    let pooled = has(text, POOLED).then(|| pooled_freedom(text, n)).flatten();
    // How many series are behind a pooled s, its words may leave to the column of degrees of freedom.
    let own = n.filter(|_| pooled.is_some() || !has(text, POOLED));
    // `repeatability, mean of 5`, with u as it stands: it is not said that the figure is that of single readings.
    let m = behind(text, e, n);
    let of_all = |m: f64| n.map_or(e.mean_of.is_none(), |n| n == m);
    let unsaid = !has(text, OF_SINGLE) && m.is_none_or(of_all);
    // `s/√n, s = 0.013, n = 4` says what is computed, and s is of single readings.
    let computed = has(text, OF_ROOT) && has(text, &["s =", "s="]);
    let of_mean = has(text, OF_THE_MEAN) || has(text, OF_ROOT) && !computed;
    // A root as divisor says that it is, whatever was made of it.
    let is_divided = e.divisor.and_then(readings_of_divisor).is_some();
    let of_mean = of_mean || unsaid && e.u_is_used() && !is_divided;
    // `s/√3, pooled s = 0.0087` says it with its figure.
    let by_root = || count_after(text, OF_ROOT).filter(|_| computed);
    let m = m.or_else(by_root).or(n.filter(|_| computed));
    let by_u = || e.u.map(|u| s.value / u.value).filter(|d| d.is_finite());
    // `s/√n, pooled s = 12` of how many is not said, beside u that was used undivided: that of the mean.
    let divisor = match computed && e.u_is_used() {
        true => by_u(),
        false => e.divisor.or_else(by_u),
    };
    let squared = divisor.and_then(readings_of_divisor);
    // Whoever divides by the number of readings itself means their mean as well.
    let by_count = || n.filter(|n| *n > 1.0 && divisor.is_some_and(|d| (d - n).abs() < 0.03 * n));
    // Nothing is stated of how many readings are behind the value: the laboratory's own divisor is all there is, where it
    // is the root of a number of readings that there were.
    let unsaid = !reports_single(text);
    let possible = |m: &f64| n.is_none_or(|n| n == *m);
    let m = of_mean
        .then_some(1.0)
        .or(m)
        .or(e.mean_of)
        .or_else(|| squared.filter(|_| unsaid).filter(possible))
        .or_else(|| by_count().filter(|_| unsaid))
        .unwrap_or(1.0);
    Some(Stated::Deviation {
        s,
        n: own,
        m,
        pooled,
    })
}

/// The number of readings that a divisor is the root of.
fn readings_of_divisor(divisor: f64) -> Option<f64> {
    let square = divisor * divisor;
    let is_whole = square > 1.2 && (square - libm::round(square)).abs() < 0.03 * square;
    is_whole.then(|| libm::round(square))
}

/// Whether a row that is called a repeatability states limits: neither s nor a number of readings, and in the columns of the
/// laboratory a distribution between limits with its divisor.
pub(super) fn are_limits(e: &Evidence<'_>, text: &str) -> bool {
    let shape = shape(&e.columns.to_lowercase());
    let divided = shape.zip(e.divisor);
    let fits =
        divided.is_some_and(|(shape, divisor)| (divisor / shape.divisor() - 1.0).abs() < 0.01);
    fits && !has(text, OF_SINGLE) && !has(text, POOLED) && count(text, e).is_none()
}

pub(super) fn range(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    let n = count(text, e)?;
    let range = e.figure_or_used(&["range method", "range r", "range", "极差法", "极差"])?;
    // Where words leave open whether the mean is reported, the laboratory's own u says it: R/C of one reading, R/(C√n) of n.
    let s = range.value / range_factor(n).0;
    let is_u = |u: &&Printed| {
        u.unit == range.unit && (s / libm::sqrt(n) - u.value).abs() <= u.half_of_digits()
    };
    let by_u = || {
        e.u.filter(is_u)
            .filter(|_| !reports_single(text))
            .map(|_| n)
    };
    let m = behind(text, e, Some(n)).or_else(by_u).unwrap_or(1.0);
    Some(Stated::Range { range, n, m })
}

/// No scatter: what is left is the step of the indication, which the words have.
pub(super) fn alike() -> Stated {
    Stated::Deviation {
        s: Printed::exact(0.0, "0"),
        n: None,
        m: 1.0,
        pooled: None,
    }
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
pub(super) fn count(text: &str, e: &Evidence<'_>) -> Option<f64> {
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
    let mean = MEAN.iter().filter_map(|key| find(text, key, 0)).min();
    let before_mean = mean.map_or(text, |at| &text[..at]);
    let direct = count_after(text, &["n =", "n="]).or_else(|| bare_count(text));
    let each = || count_after(text, &["series of", "sets of", "每组", "组各"]).filter(|n| *n > 1.0);
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

/// `n 10`, and not `0.13 N (7 groups, …)`: behind a figure it is the newton.
fn bare_count(text: &str) -> Option<f64> {
    let mut from = 0;
    while let Some(at) = find(text, "n", from) {
        from = at + 1;
        let is_unit = text[..at]
            .trim_end()
            .ends_with(|c: char| c.is_ascii_digit());
        if let Some(n) = count_after(&text[at..], &["n"]).filter(|_| !is_unit) {
            return Some(n);
        }
    }
    None
}

/// `mean of 5 readings; s from 10 readings`: a count behind that of the mean.
fn after_mean(text: &str, mean: Option<usize>) -> Option<f64> {
    let rest = text.get(mean?..)?;
    let clause = rest.find([';', ',', '。', '('])?;
    count_before(&rest[clause..], READINGS)
}

/// Readings behind the reported value: as many as are said, or all where it is their mean.
fn behind(text: &str, e: &Evidence<'_>, n: Option<f64>) -> Option<f64> {
    let is_mean = has(text, AVERAGE) && !reports_single(text);
    mean(text, e).or(n.filter(|_| is_mean))
}

/// Whether a single reading is what is reported: one whose deviation is stated (`s of a single reading`, `单次 s = …`) is
/// not.
fn reports_single(text: &str) -> bool {
    let deviation = ["deviation", "s of", "标准差", "标准偏差"];
    let is_of_s = |clause: &str| {
        let behind = clause
            .split_once("单次")
            .map(|(_, behind)| behind.trim_start());
        let symbol = behind.map(|behind| behind.trim_start_matches("测量").trim_start());
        symbol.is_some_and(|symbol| symbol.starts_with("s=") || symbol.starts_with("s "))
    };
    text.split([',', ';', '。', '、', '(']).any(|clause| {
        has(clause, &["single", "单次"]) && !has(clause, &deviation) && !is_of_s(clause)
    })
}

/// Readings behind the reported value, where their number is said.
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
            .next_back()
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
        .or_else(|| {
            count_after(
                text,
                &[
                    "实际测量",
                    "日常测量",
                    "实际",
                    "只测",
                    "仅测",
                    "只测量",
                    "仅测量",
                ],
            )
        })
        .or(single)
        .or(e.mean_of)
}
