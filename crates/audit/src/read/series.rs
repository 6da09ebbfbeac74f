//! Readings that a sheet lists beside its table, and what it says of them.

use gumption_core::quantity::{Decimal, Rounding};
use gumption_core::statistics::mean_and_deviation;

use crate::claim::{Row, Stated};
use crate::printed::{Printed, leading};
use crate::units;

use super::counts::count_after;
use super::family::AVERAGE;
use super::kind;
use super::words::{figure_after, has};

/// Numbers behind one another in a text, with nothing but marks, `and` and one unit between them; the longest such run.
pub(crate) fn listed(text: &str) -> Vec<f64> {
    let mut longest: Vec<f64> = Vec::new();
    let mut run: Vec<f64> = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let signed = rest[..start].ends_with('-');
        let start = start - usize::from(signed);
        let between =
            rest[..start].trim_matches(|c: char| c.is_whitespace() || ",;、[(".contains(c));
        let joins = between.is_empty()
            || matches!(between, "and" | "和" | "及")
            || units::parse(between.trim_end_matches([',', ';', '、', ' '])).is_some();
        let Some((figure, behind)) = leading(&rest[start..]) else {
            break;
        };
        if !joins {
            run.clear();
        }
        run.push(figure.value);
        if run.len() > longest.len() {
            longest.clone_from(&run);
        }
        // A number has at least its first digit.
        let used = rest.len() - behind.len();
        rest = &rest[used.max(start + 1)..];
    }
    longest
}

/// Readings that a text lists, or that stand in lines below one another.
pub(crate) fn series<'t>(texts: impl Iterator<Item = &'t str>, lines: &str) -> Vec<Vec<f64>> {
    const READINGS: [&str; 6] = [
        "reading",
        "raw data",
        "observations",
        "读数",
        "测得值",
        "测量值",
    ];
    let is_of_readings = |text: &str| {
        READINGS
            .iter()
            .any(|word| text.to_lowercase().contains(word))
    };
    let told = texts.filter(|text| is_of_readings(text));
    let mut all: Vec<Vec<f64>> = told.map(listed).collect();
    let (mut below, mut open) = (Vec::new(), false);
    for line in lines.lines() {
        let last = line.rsplit(" ; ").next().and_then(Printed::parse);
        match last.filter(|_| open && line.starts_with(|c: char| c.is_ascii_digit() || c == '-')) {
            Some(figure) => below.push(figure.value),
            None => {
                all.push(std::mem::take(&mut below));
                open = is_of_readings(line);
            }
        }
    }
    all.push(below);
    all
}

/// What has nothing to do with a figure is known to a factor of two, as far as the search looks for accidents: nearer ones are about the
/// same.
const LIKE: f64 = 2.0;

/// What the lines of a sheet say of one series of readings.
struct Series {
    /// Standard deviation of a single one.
    s: Printed,
    /// How many they are.
    n: f64,
    /// Whether their mean is spoken of.
    has_mean: bool,
    /// Whether no other readings are listed, nor others than those that are counted.
    is_alone: bool,
}

impl Series {
    fn of(words: &str) -> Option<Series> {
        let lines: Vec<String> = words.lines().map(|line| line.replace(" ; ", " ")).collect();
        let mut stated = lines.iter().filter_map(|line| deviation(line));
        let first = stated.next();
        // Of two series it is not said which is behind a row.
        if stated.any(|other| Some(other.value) != first.as_ref().map(|s| s.value)) {
            return None;
        }
        let mut all = series(lines.iter().map(String::as_str), words);
        all.retain(|readings| readings.len() >= 3);
        all.dedup();
        let readings = all.iter().max_by_key(|readings| readings.len());
        let counted = lines.iter().find_map(|line| count(line));
        let n = counted.or_else(|| readings.map(|all| all.len() as f64))?;
        let is_alone = all.len() <= 1 && readings.is_none_or(|all| all.len() as f64 == n);
        let of_readings = readings.and_then(|readings| computed(readings));
        // An s that its own readings do not give is none of them.
        let follows = |s: &Printed| {
            let own = of_readings.as_ref().filter(|_| is_alone);
            own.is_none_or(|own| s.is_met_within(own.value, s.half_of_digits()))
        };
        let s = first.filter(follows).or_else(|| of_readings.clone())?;
        Some(Series {
            s,
            n,
            has_mean: has(&words.to_lowercase(), AVERAGE),
            is_alone,
        })
    }

    /// What is known of a row, where its u shows that it is made of these readings: s, s/√n as that of the mean, or s/n.
    fn stated(&self, row: &Row) -> Option<Stated> {
        let u = row.u.as_ref().or(row.contribution.as_ref())?;
        let to_u = units::factor(&self.s.unit, &u.unit).unwrap_or(1.0);
        let is_met = |way: f64| {
            let x = self.s.value * to_u * way;
            u.is_met_within(x, u.half_of_digits() + self.s.half * to_u * way)
        };
        let of_mean = is_met(1.0 / libm::sqrt(self.n));
        let of_other = || self.has_mean && (is_met(1.0) || is_met(1.0 / self.n));
        (self.n >= 2.0 && (of_mean || of_other())).then(|| Stated::Deviation {
            s: self.s.clone(),
            n: Some(self.n),
            m: self.n,
            pooled: None,
        })
    }

    /// These readings, where the figure that a row has of its own is like s or s/√n, and follows from neither.
    fn against(&self, row: &Row) -> Option<Stated> {
        let own = row.stated.figure()?;
        let to_own = units::factor(&self.s.unit, &own.unit).unwrap_or(1.0);
        let of_mean = 1.0 / libm::sqrt(self.n);
        let distance = |way: f64| libm::log(own.value / (self.s.value * to_own * way)).abs();
        let is_met = |way: f64| {
            let open = own.half_of_digits() + self.s.half * to_own * way;
            own.is_met_within(self.s.value * to_own * way, open)
        };
        let is_like = distance(1.0).min(distance(of_mean)) <= libm::log(LIKE);
        let departs = self.is_alone && is_like && !is_met(1.0) && !is_met(of_mean);
        let m = match row.stated {
            Stated::Deviation { m, .. } if distance(1.0) < distance(of_mean) => m,
            _ if distance(1.0) < distance(of_mean) => 1.0,
            _ => self.n,
        };
        departs.then(|| Stated::Deviation {
            s: self.s.clone(),
            n: Some(self.n),
            m,
            pooled: None,
        })
    }
}

/// The only row of type A that says no more of its readings takes what the lines beside the table say of them; each row comes with
/// its columns of distribution and type.
pub(super) fn settle<'r>(rows: impl Iterator<Item = (&'r str, &'r mut Row)>, words: &str) {
    let Some(series) = Series::of(words) else {
        return;
    };
    let is_of_type_a = |columns: &str, row: &Row| {
        kind::is_of_type(&columns.to_lowercase(), "a")
            || has(
                &row.words.to_lowercase(),
                &["repeatab", "type a", "重复性", "a类"],
            )
    };
    let mut of_type = rows.filter(|(columns, row)| is_of_type_a(columns, row));
    let (Some((_, row)), None) = (of_type.next(), of_type.next()) else {
        return;
    };
    let is_open = matches!(
        row.stated,
        Stated::Standard { .. }
            | Stated::Deviation {
                n: None,
                pooled: None,
                ..
            }
    );
    let is_counted =
        matches!(row.stated, Stated::Deviation { n: Some(n), pooled: None, .. } if n == series.n);
    let freedom = row.dof.as_ref().map_or(series.n - 1.0, |dof| dof.value);
    if (is_open || is_counted) && (freedom - (series.n - 1.0)).abs() <= 1.0 {
        let stated = series.stated(row).filter(|_| is_open);
        row.stated = (stated.or_else(|| series.against(row))).unwrap_or_else(|| row.stated.clone());
    }
}

/// The standard deviation of single readings that a line states.
fn deviation(line: &str) -> Option<Printed> {
    const NAMES: &[&str] = &["standard deviation", "标准偏差", "标准差", "s"];
    const OTHERS: [&str; 6] = [
        "of the mean",
        "of mean",
        "平均值的",
        "uncertainty",
        "不确定度",
        "pooled",
    ];
    let lower = line.to_lowercase();
    let is_named = has(&lower, &["standard deviation", "标准偏差", "标准差", "s ="]);
    let figure = (is_named && !has(&lower, &OTHERS)).then(|| figure_after(line, NAMES))?;
    figure.filter(|s| s.value > 0.0)
}

/// How many readings a line says there are.
fn count(line: &str) -> Option<f64> {
    count_after(
        &line.to_lowercase(),
        &["n", "number of readings", "测量次数"],
    )
}

/// The experimental standard deviation (JCGM 100, 4.2.2), called by four digits.
fn computed(readings: &[f64]) -> Option<Printed> {
    let (_, s) = mean_and_deviation(readings);
    let shown = Decimal::from_f64(s).round_to_significant(4, Rounding::HalfEven);
    (s > 0.0).then(|| Printed::exact(s, &shown.print_plain()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_read() {
        assert_eq!(
            listed("5 series: 0.10, 0.12 and 0.45 mV"),
            [0.10, 0.12, 0.45]
        );
        assert_eq!(listed("s of 10 readings, mean of 4"), [10.0]);
    }

    #[test]
    fn a_series_has_s_and_n() {
        let of = |words: &str| Series::of(words).map(|series| (series.s.value, series.n));
        assert_eq!(
            of("Mean ; 10.1 mm\nStandard deviation ; 0.5 mm\nn ; 6"),
            Some((0.5, 6.0))
        );
        // 1, 2, 3: s = 1.
        assert_eq!(of("Readings: 1.0, 2.0, 3.0 mm"), Some((1.0, 3.0)));
        assert_eq!(of("s = 0.5 mm, n = 6\ns = 0.7 mm, n = 6"), None);
        assert_eq!(of("Standard deviation of the mean 0.5 mm"), None);
    }
}
