//! What the words of a sheet show.

use gumption_core::calendar::Day;

use crate::read::{has, lowered};

use super::{Hit, Seen};

/// Whether the sheet speaks of something, in its rows or beside its tables.
fn speaks(seen: &Seen<'_>, keys: &[&str]) -> bool {
    let has = |text: &str| {
        let lower = text.to_lowercase();
        keys.iter().any(|key| lower.contains(key))
    };
    let rows = &seen.claimed.rows;
    has(&seen.claimed.words)
        || has(&seen.claimed.title)
        || rows.iter().any(|row| has(&row.words) || has(&row.name))
}

/// Whether a row speaks of something.
fn rows_speak(seen: &Seen<'_>, keys: &[&str]) -> bool {
    let rows = &seen.claimed.rows;
    rows.iter().any(|row| {
        // A short Chinese name may stand where symbols do.
        let lower = format!("{} {} {}", row.words, row.name, row.symbol).to_lowercase();
        keys.iter().any(|key| lower.contains(key))
    })
}

fn missing(so: bool) -> Vec<Hit> {
    if so {
        vec![Hit::of(None, String::new())]
    } else {
        Vec::new()
    }
}

/// A budget of a calibration: it has a certificate in it.
fn is_calibration(seen: &Seen<'_>) -> bool {
    use crate::claim::Stated;
    let rows = &seen.claimed.rows;
    rows.iter()
        .any(|row| matches!(row.stated, Stated::Certificate { .. }))
}

pub(super) fn no_resolution(seen: &Seen<'_>) -> Vec<Hit> {
    use crate::claim::Stated;
    let rows = &seen.claimed.rows;
    let step = rows
        .iter()
        .any(|row| matches!(row.stated, Stated::Step { .. }));
    let words = [
        "resolution",
        "digital step",
        "increment",
        "readability",
        "quantis",
        "scale",
        "分辨",
        "步进",
        "分度",
        "量化",
        "估读",
        "auflösung",
        "ablesung",
        "résolution",
        "échelon",
        "quantification",
    ];
    missing(is_calibration(seen) && !step && !rows_speak(seen, &words))
}

pub(super) fn no_repeatability(seen: &Seen<'_>) -> Vec<Hit> {
    let type_a = seen.claimed.rows.iter().any(|row| row.stated.is_type_a());
    let words = [
        "repeatab",
        "scatter",
        "type a",
        "standard deviation",
        "重复性",
        "标准偏差",
        "a类",
        "wiederhol",
        "streuung",
        "standardabweichung",
        "répétabilité",
        "fidélité",
        "écart-type",
    ];
    missing(is_calibration(seen) && !type_a && !rows_speak(seen, &words))
}

pub(super) fn no_drift(seen: &Seen<'_>) -> Vec<Hit> {
    let words = [
        "drift",
        "stabil",
        "ageing",
        "aging",
        "since last",
        "漂移",
        "稳定性",
        "年变化",
        "老化",
        "alterung",
        "dérive",
        "vieillissement",
    ];
    missing(is_calibration(seen) && !rows_speak(seen, &words))
}

/// A quantity that depends on temperature, as its unit or the title says, without a row for it.
pub(super) fn no_temperature(seen: &Seen<'_>) -> Vec<Hit> {
    let depends = [
        "length",
        "gauge block",
        "volume",
        "flask",
        "pipette",
        "resist",
        "density",
        "量块",
        "长度",
        "容量",
        "电阻",
        "密度",
    ];
    let words = [
        "temperature",
        "thermal",
        "expansion",
        "温度",
        "膨胀",
        "温差",
        "temperatur",
        "ausdehnung",
        "température",
        "dilatation",
    ];
    let title = seen.claimed.title.to_lowercase();
    let thermal = depends.iter().any(|word| title.contains(word));
    missing(thermal && !rows_speak(seen, &words))
}

pub(super) fn known_bias(seen: &Seen<'_>) -> Vec<Hit> {
    let words = [
        "not corrected",
        "uncorrected",
        "without correction",
        "correction is not applied",
        "correction not applied",
        "bias is included",
        "未修正",
        "不作修正",
        "不修正",
        "未作修正",
    ];
    missing(speaks(seen, &words))
}

pub(super) fn conformity_without_rule(seen: &Seen<'_>) -> Vec<Hit> {
    let verdict = [
        "conforms",
        "conformity",
        "complies",
        "in tolerance",
        "within specification",
        "passed",
        "合格",
        "符合要求",
    ];
    let rule = [
        "decision rule",
        "guard band",
        "simple acceptance",
        "ilac-g8",
        "14253",
        "jjf 1094",
        "jjf1094",
        "判定规则",
        "判据",
        "接受限",
    ];
    missing(speaks(seen, &verdict) && !speaks(seen, &rule))
}

/// Slope and intercept of one fit, as independent inputs.
pub(super) fn fit_without_covariance(seen: &Seen<'_>) -> Vec<Hit> {
    let of = |keys: &[&str]| {
        let rows = seen.claimed.rows.iter();
        rows.enumerate()
            .find(|(_, row)| {
                let lower = format!("{} {}", row.words, row.name).to_lowercase();
                keys.iter().any(|key| lower.contains(key))
            })
            .map(|(i, _)| i)
    };
    let (Some(slope), Some(intercept)) = (of(&["slope", "斜率"]), of(&["intercept", "截距"]))
    else {
        return Vec::new();
    };
    let pairs = &seen.claimed.correlations;
    let given = pairs.iter().any(|pair| {
        (pair.a, pair.b) == (slope, intercept) || (pair.b, pair.a) == (slope, intercept)
    });
    if given || slope == intercept {
        return Vec::new();
    }
    let label = |i: usize| seen.claimed.rows[i].label().to_string();
    vec![Hit::of(
        Some(slope),
        format!("r({}, {}) = 0", label(slope), label(intercept)),
    )]
}

/// A reading that was left out, without a test for outliers or a reason.
pub(super) fn left_out(seen: &Seen<'_>) -> Vec<Hit> {
    const LEFT_OUT: [&str; 8] = [
        "outlier removed",
        "outlier was removed",
        "outlier rejected",
        "reading was left out",
        "reading was discarded",
        "reading discarded",
        "剔除",
        "舍弃",
    ];
    const REASONS: [&str; 12] = [
        "because",
        "reason",
        "cause",
        "record",
        "grubbs",
        "dixon",
        "criterion",
        "原因",
        "记录",
        "准则",
        "格拉布斯",
        "狄克逊",
    ];
    let rows = seen
        .claimed
        .rows
        .iter()
        .flat_map(|row| row.words.split(';'));
    let said = seen.claimed.words.lines().chain(rows);
    let has = |text: &str, keys: &[&str]| {
        let lower = text.to_lowercase();
        keys.iter().any(|key| lower.contains(key))
    };
    let mut said = said.filter(|text| has(text, &LEFT_OUT) && !has(text, &REASONS));
    let hit = said.next().map(|text| Hit::of(None, text.trim().into()));
    hit.into_iter().collect()
}

/// The CMC with a coverage factor that is not that of about 95 %.
pub(super) fn cmc_level(seen: &Seen<'_>) -> Vec<Hit> {
    let cmc = seen.claimed.cmc.as_ref().map(|cmc| cmc.at);
    let line = seen
        .claimed
        .understood
        .iter()
        .find(|line| Some(line.at) == cmc);
    let k = line.and_then(|line| crate::read::figure_after(&line.text, &["k =", "k="]));
    // Two decimals of a factor of t at 95 %: from 1.96 to what ten degrees of freedom give.
    let usual = 1.96..=2.23;
    let other = k.filter(|k| !usual.contains(&k.value));
    let hit = other.map(|k| Hit::of(None, format!("k = {}", k.text)));
    hit.into_iter().collect()
}

/// |E_n| above one that the sheet itself states.
pub(super) fn comparison(seen: &Seen<'_>) -> Vec<Hit> {
    const NAMES: [&str; 4] = ["e_n =", "e_n=", "en =", "en="];
    let lines = seen.claimed.words.lines();
    let stated = lines.filter_map(|line| crate::read::figure_after(line, &NAMES));
    let failed = stated.filter(|ratio| ratio.value.abs() > 1.0);
    failed
        .map(|ratio| Hit::of(None, format!("E_n = {}", ratio.text)))
        .collect()
}

/// A certificate that had expired on the day of measurement, or of the budget where no other is named.
pub(super) fn expired(seen: &Seen<'_>) -> Vec<Hit> {
    let lines = seen.claimed.words.lines();
    let all: Vec<(Dated, Day)> = lines.flat_map(dated).collect();
    let of = |kind: Dated| all.iter().filter(move |one| one.0 == kind).map(|one| one.1);
    let Some(measured) = of(Dated::Measured).max().or_else(|| of(Dated::Made).max()) else {
        return Vec::new();
    };
    let old = of(Dated::Valid).filter(|date| *date < measured);
    old.map(|date| Hit::of(None, format!("{date} < {measured}")))
        .collect()
}

/// What a date is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Dated {
    /// The measurement.
    Measured,
    /// The budget.
    Made,
    /// The end of what a certificate is good for.
    Valid,
    /// Another one: when a standard was calibrated.
    Other,
}

/// What stands in front of dates.
const DATED: &[(Dated, &[&str])] = &[
    (
        Dated::Measured,
        &[
            "measured on",
            "date of measurement",
            "measurement date",
            "date of calibration",
            "calibration date",
            "校准日期",
            "测量日期",
        ],
    ),
    (
        Dated::Valid,
        &[
            "valid until",
            "valid to",
            "expires",
            "expired",
            "expiry",
            "due",
            "有效期至",
            "有效期",
        ],
    ),
    (
        Dated::Made,
        &[
            "date of this budget",
            "date of budget",
            "date of the budget",
            "budget date",
            "date:",
        ],
    ),
    (Dated::Other, &["calibrated on", "certificate of", "dated"]),
];

/// The dates of a line, each as what was named last in front of it.
fn dated(line: &str) -> Vec<(Dated, Day)> {
    let lower = lowered(line);
    let is_end = |c: Option<char>| !c.is_some_and(|c| c.is_ascii_alphabetic());
    let is_word = |at: usize, word: &str| {
        let behind = &lower[at + word.len()..];
        // `due to the temperature`
        let is_cause = behind.trim_start().starts_with("to ");
        let in_front = &lower[..at];
        // `due date: ` is named already.
        let parted = match word.ends_with(':') {
            true => {
                in_front.trim_end().is_empty() || in_front.trim_end().ends_with([';', '.', ','])
            }
            false => is_end(in_front.chars().next_back()),
        };
        parted && (word.ends_with(':') || is_end(behind.chars().next())) && !is_cause
    };
    let mut named: Vec<(usize, Dated)> = Vec::new();
    for (kind, words) in DATED {
        for word in *words {
            let found = lower.match_indices(word).map(|(at, _)| at);
            let found = found.filter(|at| is_word(*at, word));
            named.extend(found.map(|at| (at, *kind)));
        }
    }
    named.sort_by_key(|(at, _)| *at);
    let ends = |i: usize| named.get(i + 1).map_or(line.len(), |next| next.0);
    // A standard was calibrated on a day, and so was the device.
    let is_of_standard = has(&lower, &["standard", "reference", "标准"])
        || named.iter().any(|one| one.1 == Dated::Valid);
    let date = |(i, (at, kind)): (usize, &(usize, Dated))| {
        let text = &lower[*at..ends(i)];
        let is_measured = text.starts_with("calibrated on") && !is_of_standard;
        let kind = if is_measured { Dated::Measured } else { *kind };
        super::records::dates(text).first().map(|day| (kind, *day))
    };
    named.iter().enumerate().filter_map(date).collect()
}

/// `U = ±0.2 mm`: a lone uncertainty has no sign (JJF 1059.1).
pub(super) fn sign_before_u(seen: &Seen<'_>) -> Vec<Hit> {
    let footer = &seen.claimed.footer;
    let text = footer
        .expanded
        .as_ref()
        .map(|figure| figure.text.trim().to_string());
    let in_words = seen.claimed.words.lines().find(|line| {
        let compact: String = line.split_whitespace().collect();
        compact.contains("U=±") || compact.contains("U:±")
    });
    let of_cell = text.filter(|text| text.starts_with('±'));
    of_cell
        .or(in_words.map(str::to_string))
        .map(|text| Hit::of(None, text))
        .into_iter()
        .collect()
}
