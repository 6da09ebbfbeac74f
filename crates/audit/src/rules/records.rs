//! What records that stand on a sheet show: readings, series, dates, ranges, fits, and checks of other kinds.

use gumption_core::calendar::Day;
use gumption_core::special::{chi_squared_upper_quantile, f_quantile};
use gumption_core::statistics::mean_and_squares;

use crate::claim::Stated;
use crate::printed::{Printed, leading};
use crate::read::{MONTE_CARLO, count_before, figure_after, listed, series};
use crate::units;

use super::{Hit, Seen, shown};

/// Every line of words: those beside the tables, and those of the rows, each with its row.
fn texts<'s>(seen: &'s Seen<'_>) -> impl Iterator<Item = (Option<usize>, &'s str)> {
    let rows = seen.claimed.rows.iter().enumerate();
    let lines = seen.claimed.words.lines().map(|line| (None, line));
    lines.chain(rows.map(|(i, row)| (Some(i), row.words.as_str())))
}

fn has(text: &str, keys: &[&str]) -> bool {
    let lower = text.to_lowercase();
    keys.iter().any(|key| lower.contains(key))
}

/// Variances that were pooled, of which the largest is an outlier of Cochran's test at 1 % (ISO 5725-2, 7.3.3).
pub(super) fn unequal_variances(seen: &Seen<'_>) -> Vec<Hit> {
    let rows = seen.claimed.rows.iter().enumerate();
    let hit = |(i, row): (usize, &crate::claim::Row)| {
        let Stated::Deviation {
            n: Some(n),
            pooled: Some(_),
            ..
        } = row.stated
        else {
            return None;
        };
        let variances: Vec<f64> = listed(&row.words).iter().map(|s| s * s).collect();
        // The largest of two is that of an F test, and one reading has no variance.
        if variances.len() < 3 || n < 2.0 {
            return None;
        }
        let (count, total) = (variances.len() as f64, variances.iter().sum::<f64>());
        let largest = variances.iter().copied().fold(0.0, f64::max);
        let share = largest / total;
        let by_f = f_quantile(1.0 - 0.01 / count, n - 1.0, (n - 1.0) * (count - 1.0));
        let critical = 1.0 / (1.0 + (count - 1.0) / by_f);
        let is_out = total > 0.0 && share > critical;
        is_out.then(|| Hit::of(Some(i), format!("C = {share:.3} > {critical:.3}")))
    };
    rows.filter_map(hit).collect()
}

/// Readings of which each is like the one before: the correlation at lag 1 is beyond two of its standard deviations.
pub(super) fn autocorrelation(seen: &Seen<'_>) -> Vec<Hit> {
    /// Of fewer the correlation at lag 1 cannot be so large, or only by a step from one level to another.
    const FEWEST: usize = 8;
    let of = |readings: Vec<f64>| {
        let n = readings.len() as f64;
        let (mean, square) = mean_and_squares(&readings);
        let apart: Vec<f64> = readings.iter().map(|x| x - mean).collect();
        let lagged: f64 = apart.windows(2).map(|two| two[0] * two[1]).sum();
        let (r, bound) = (lagged / square, 2.0 / libm::sqrt(n));
        let is_like = readings.len() >= FEWEST && square > 0.0 && r > bound;
        is_like.then(|| Hit::of(None, format!("r₁ = {r:.2} > 2/√{n} = {bound:.2}")))
    };
    let told = texts(seen).map(|(_, text)| text);
    let all = series(told, &seen.claimed.words).into_iter();
    all.filter_map(of).take(1).collect()
}

/// Terms of second order in the model at the estimates, against the variance of first order.
pub(super) fn second_order(seen: &Seen<'_>) -> Vec<Hit> {
    /// A twentieth of u_c² is a fortieth of u_c, half a unit in the second of its digits where that is 20.
    const SHARE: f64 = 0.05;
    let share = seen.case.second_order.filter(|share| *share > SHARE);
    let hit = share.map(|share| Hit::of(None, format!("{:.0} % u_c²", 100.0 * share)));
    hit.into_iter().collect()
}

/// The interval of Monte Carlo that the sheet states, beyond the numerical tolerance of two digits of u_c (JCGM 101, 7.9.2
/// and 8.1.3) from y ± U.
pub(super) fn not_validated(seen: &Seen<'_>) -> Vec<Hit> {
    let footer = &seen.claimed.footer;
    let (Some(y), Some(expanded)) = (&footer.y, &footer.expanded) else {
        return Vec::new();
    };
    let u_c = footer
        .u_c
        .as_ref()
        .map_or(seen.case.right.figures(&[], None).u_c, |u| u.value);
    let to_y = units::factor(&seen.claimed.unit, &y.unit).unwrap_or(1.0);
    let tolerance = 0.5 * libm::exp10(libm::floor(libm::log10(u_c * to_y)) - 1.0);
    let ends = [
        y.value - expanded.value * to_y,
        y.value + expanded.value * to_y,
    ];
    // A row has what other tables say of it, too: only the sentence that names the method tells its interval.
    let sentences =
        texts(seen).flat_map(|(row, text)| sentences(text).into_iter().map(move |one| (row, one)));
    let lines = sentences.filter(|(_, text)| has(text, &MONTE_CARLO));
    let hit = |(row, text): (Option<usize>, &str)| {
        let (low, high) = interval(text)?;
        let apart = (low.value - ends[0])
            .abs()
            .max((high.value - ends[1]).abs());
        // The ends are printed, and so are y and U.
        let open = tolerance + low.half + y.half + expanded.half * to_y;
        let numbers = || {
            let [a, b] = ends.map(shown);
            format!("[{}, {}] ≠ [{a}, {b}]", low.text, high.text)
        };
        (apart > open).then(|| Hit::of(row, numbers()))
    };
    lines.filter_map(hit).take(1).collect()
}

/// The parts of a text between its full stops; the point of a number is none.
fn sentences(text: &str) -> Vec<&str> {
    let is_stop = |(at, c): &(usize, char)| {
        let next = text[at + c.len_utf8()..].chars().next();
        *c == '。' || *c == '.' && !next.is_some_and(|next| next.is_ascii_digit())
    };
    let stops = text.char_indices().filter(is_stop);
    let ends = stops.map(|(at, c)| at + c.len_utf8());
    let mut from = 0;
    let cut = ends.chain([text.len()]).map(|end| {
        let part = &text[from..end];
        from = end;
        part
    });
    cut.collect()
}

/// `[9.98, 10.02]`, `9.98 to 10.02 V`, `(0~100) °C`, `200 g to 5 kg`: two figures with a mark or a word for a range between
/// them, in the unit of the second.
fn interval(text: &str) -> Option<(Printed, Printed)> {
    const MARKS: [&str; 8] = [",", "~", "…", "至", "到", "to ", "and ", "- "];
    // A comma may have parted the cells of a bracket; elsewhere two cells are two figures.
    let parting = |at: usize, rest: &'_ str| {
        let in_bracket = text[..at].ends_with(['[', '(']);
        let cells = in_bracket.then_some("; ");
        let mut marks = MARKS.into_iter().chain(cells);
        marks.find(|mark| rest.starts_with(mark)).map(str::len)
    };
    let starts = text.char_indices().filter(|(at, c)| {
        let before = text[..*at].chars().next_back();
        let free = before.is_none_or(|b| !b.is_ascii_alphanumeric() && !"._-".contains(b));
        free && (c.is_ascii_digit() || *c == '-')
    });
    let pair = |(at, _): (usize, char)| {
        let (low, behind) = leading(&text[at..])?;
        let blank = behind.trim_start();
        let word = blank.split_once(' ');
        let word = word.filter(|(word, _)| units::parse(word).is_some());
        let (unit, rest) = word.map_or(("", blank), |(unit, rest)| (unit, rest.trim_start()));
        let rest = &rest[parting(at, rest)?..];
        let (high, behind) = leading(rest.trim_start())?;
        let end = behind.trim_start_matches([')', ']', ' ']);
        let stop = end.find(|c: char| c.is_whitespace() || ",;)。".contains(c));
        let own = end[..stop.unwrap_or(end.len())].to_string();
        let factor = units::factor(unit, &own).filter(|_| !unit.is_empty());
        let low = low.scaled(factor.unwrap_or(1.0));
        (low.value < high.value).then_some((low, Printed { unit: own, ..high }))
    };
    starts.filter_map(pair).next()
}

/// χ²/ν that the sheet states of a fit, beyond what chance gives once in twenty.
pub(super) fn lack_of_fit(seen: &Seen<'_>) -> Vec<Hit> {
    const NAMES: [&str; 10] = [
        "χ^2/ν",
        "χ^2/dof",
        "χ^2/n",
        "chi^2/dof",
        "chi^2/ν",
        "reduced chi-square",
        "reduced chi-squared",
        "reduced χ^2",
        "chi-squared per degree of freedom",
        "约化卡方",
    ];
    const FREEDOM: [&str; 4] = ["ν =", "ν=", "degrees of freedom", "自由度"];
    let hit = |(row, text): (Option<usize>, &str)| {
        let ratio = figure_after(text, &NAMES)?.value;
        // With one degree of freedom, where none are stated, the most is left to chance.
        let others = text.replace("/ν", "/n");
        let behind = figure_after(&others, &FREEDOM).map(|dof| dof.value);
        let dof = behind.or_else(|| count_before(&others.to_lowercase(), &["degrees of freedom"]));
        let dof = dof.unwrap_or(1.0).max(1.0);
        let bound = chi_squared_upper_quantile(0.05, dof) / dof;
        (ratio > bound).then(|| Hit::of(row, format!("χ²/ν = {ratio} > {bound:.2}")))
    };
    texts(seen).filter_map(hit).collect()
}

/// A standard whose words name the range in which it was calibrated, and another value at which it was used.
pub(super) fn out_of_range(seen: &Seen<'_>) -> Vec<Hit> {
    const RANGES: [&str; 10] = [
        "calibrated from",
        "calibrated range",
        "calibration range",
        "range of calibration",
        "calibrated in the range",
        "calibrated between",
        "校准范围",
        "检定范围",
        "校准区间",
        "证书范围",
    ];
    const USED: [&str; 8] = [
        "used at",
        "measured at",
        "applied at",
        "read at",
        "使用点",
        "测量点",
        "校准点",
        "使用于",
    ];
    let hit = |(row, text): (Option<usize>, &str)| {
        let lower = text.to_lowercase();
        let at = RANGES
            .iter()
            .find_map(|key| Some(lower.find(key)? + key.len()))?;
        let (low, high) = interval(lower.get(at..)?)?;
        let own = row.and_then(|row| seen.claimed.rows[row].value.clone());
        let used = figure_after(text, &USED).or(own)?;
        let factor = units::factor(&used.unit, &high.unit);
        let x = used.value * factor.or(used.unit.is_empty().then_some(1.0))?;
        let outside = x < low.value || x > high.value;
        outside.then(|| {
            Hit::of(
                row,
                format!("{} ∉ [{}, {}]", used.text, low.text, high.text),
            )
        })
    };
    texts(seen).filter_map(hit).collect()
}

/// A budget that was made before its method was revised, or one of its standards calibrated.
pub(super) fn old_budget(seen: &Seen<'_>) -> Vec<Hit> {
    const MADE: [&str; 8] = [
        "prepared",
        "budget of",
        "date of the budget",
        "evaluated on",
        "编制",
        "评定日期",
        "评定于",
        "budget date",
    ];
    const LATER: [&str; 12] = [
        "revised",
        "revision of",
        "in force",
        "effective from",
        "recalibrated",
        "certificate dated",
        "certificate of",
        "修订",
        "实施",
        "换版",
        "复校",
        "证书日期",
    ];
    // `prepared by ; J. Li ; 2026-03-14`: a date belongs to the last that its line has named.
    let dated_in = |text: &str, keys: &[&str]| -> Vec<Day> {
        let mut about = false;
        let mut found = Vec::new();
        for part in text.split([';', ',', '。', '、']) {
            let named = has(part, &MADE) || has(part, &LATER);
            about = if named { has(part, keys) } else { about };
            found.extend(dates(part).into_iter().filter(|_| about));
        }
        found
    };
    let dated = |keys: &[&str]| -> Vec<Day> {
        let all = texts(seen).flat_map(|(_, text)| dated_in(text, keys));
        all.collect()
    };
    let Some(made) = dated(&MADE).into_iter().max() else {
        return Vec::new();
    };
    let later = dated(&LATER).into_iter().filter(|date| *date > made).max();
    let hit = later.map(|later| Hit::of(None, format!("{made} < {later}")));
    hit.into_iter().collect()
}

/// Days of the calendar in a text, written as `2026-01-31`, `2026/1/31`, `2026年1月31日`, `31.01.2026` or `31 January 2026`. Of
/// `1/2/2026` nobody can say which is the month.
pub(super) fn dates(text: &str) -> Vec<Day> {
    let mut found = of_figures(text);
    found.extend(with_month(text));
    found
}

/// Days whose month is a word: `31 January 2026`, `Jan. 31, 2026`, `31-Jan-2026`.
fn with_month(text: &str) -> Vec<Day> {
    const MONTHS: [&str; 12] = [
        "jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec",
    ];
    const NAMES: [&str; 12] = [
        "january",
        "february",
        "march",
        "april",
        "may",
        "june",
        "july",
        "august",
        "september",
        "october",
        "november",
        "december",
    ];
    let lower = text.to_lowercase();
    let words = lower.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let month = |word: &str| {
        let is_it =
            |i: &usize| word == NAMES[*i] || word == MONTHS[*i] || word == "sept" && *i == 8;
        (0..12).find(is_it).map(|i| i as u64 + 1)
    };
    let day = |word: &str| {
        let figures = word.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let is_ordinal = ["", "st", "nd", "rd", "th"].contains(&&word[figures.len()..]);
        figures.parse::<u64>().ok().filter(|_| is_ordinal)
    };
    let year = |word: &str| word.parse::<u64>().ok().filter(|_| word.len() == 4);
    let of = |three: &[&str]| {
        let (a, b, c) = (three[0], three[1], three[2]);
        let by_day = || Some((day(a)?, month(b)?));
        let by_month = || Some((day(b)?, month(a)?));
        let (day, month) = by_day().or_else(by_month)?;
        Day::of(year(c)?, month, day)
    };
    words.windows(3).filter_map(of).collect()
}

/// Days in figures, of which the year has four.
fn of_figures(text: &str) -> Vec<Day> {
    // `31.01.2026` is a day; with a solidus it may as well begin with the month.
    let dotted = text.split(|c: char| !(c.is_ascii_digit() || c == '.'));
    let of_dotted = |word: &str| {
        let figures: Vec<&str> = word.trim_matches('.').split('.').collect();
        let [day, month, year] = figures.as_slice() else {
            return None;
        };
        let year = Some(year).filter(|year| year.len() == 4)?;
        Day::of(year.parse().ok()?, month.parse().ok()?, day.parse().ok()?)
    };
    let first: Vec<Day> = dotted.filter_map(of_dotted).collect();
    let plain = text.replace(['年', '月', '/', '.'], "-").replace('日', " ");
    let words = plain.split(|c: char| !(c.is_ascii_digit() || c == '-'));
    let date = |word: &str| {
        let figures: Vec<&str> = word.trim_matches('-').split('-').collect();
        let [year, month, day] = figures.as_slice() else {
            return None;
        };
        let year = Some(year).filter(|year| year.len() == 4)?;
        Day::of(year.parse().ok()?, month.parse().ok()?, day.parse().ok()?)
    };
    first.into_iter().chain(words.filter_map(date)).collect()
}

/// The standard deviation of a check standard that a line states, beside the one that it predicts.
pub(super) fn check_standard(seen: &Seen<'_>) -> Vec<Hit> {
    const STANDARD: [&str; 4] = ["check standard", "control chart", "核查标准", "控制图"];
    const SCATTER: [&str; 6] = [
        "s =",
        "s=",
        "standard deviation",
        "scatter",
        "标准偏差",
        "标准差",
    ];
    const PREDICTED: [&str; 5] = ["predicted", "expected", "prediction", "预期", "预计"];
    let hit = |(row, text): (Option<usize>, &str)| {
        if !has(text, &STANDARD) {
            return None;
        }
        let s = figure_after(text, &SCATTER)?;
        let predicted = figure_after(text, &PREDICTED)?;
        let factor = units::factor(&predicted.unit, &s.unit).unwrap_or(1.0);
        let ratio = s.value / (predicted.value * factor);
        (ratio > 2.0).then(|| {
            Hit::of(
                row,
                format!("s = {}, {} × {}", s.text, shown(ratio), predicted.text),
            )
        })
    };
    texts(seen).filter_map(hit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_and_dates_are_read() {
        let ends = |text: &str| interval(text).map(|(a, b)| (a.value, b.value, b.unit));
        assert_eq!(
            ends("[99.98, 100.02]"),
            Some((99.98, 100.02, String::new()))
        );
        assert_eq!(ends("from 0 °C to 100 °C"), Some((0.0, 100.0, "°C".into())));
        assert_eq!(ends("(10~50) kPa"), Some((10.0, 50.0, "kPa".into())));
        assert_eq!(ends("[99.98 ; 100.02] g").map(|(a, ..)| a), Some(99.98));
        assert_eq!(ends("200 g to 5 kg"), Some((0.2, 5.0, "kg".into())));
        assert_eq!(ends("M-12"), None);
        let days = dates(
            "2026-01-31, 2026/2/3 and 2026年3月14日; 17.4.5; 2026-02-31, 2026-13-01, 2024-02-29",
        );
        assert_eq!(
            days.iter().map(Day::to_string).collect::<Vec<_>>(),
            ["2026-01-31", "2026-02-03", "2026-03-14", "2024-02-29"]
        );
        let days = dates(
            "15.01.2020, 4 March 2026, Sept. 30, 2025, 2nd Feb 2024, 7-May-2023; 1/2/2026; 31.02.2026; 1.0.2026",
        );
        assert_eq!(
            days.iter().map(Day::to_string).collect::<Vec<_>>(),
            [
                "2020-01-15",
                "2026-03-04",
                "2025-09-30",
                "2024-02-02",
                "2023-05-07"
            ]
        );
    }
}
