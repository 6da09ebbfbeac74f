//! Drift between calibrations: the same device at several dates.

use crate::agreement::{LISTED, of_difference};
use crate::deviation::{SIGNIFICANCE, Weights};
use crate::parallel::in_order;
use crate::results::Values;
use gumption_core::special::student_t_sf;
use gumption_core::statistics::{effective_freedom, norm, root_mean_square};

/// Days of a year (Julian year, unit a of ISO 80000-3).
pub const DAYS_OF_A_YEAR: f64 = 365.25;

/// Devices whose course is drawn.
pub const DRAWN: usize = 24;

/// The drift of a measurand.
#[derive(Debug, Clone, Default)]
pub struct Drift {
    /// Each group.
    pub groups: Vec<GroupDrift>,
    /// Devices with a rate.
    pub devices: usize,
    /// Devices whose rate is beyond its expanded uncertainty.
    pub beyond: usize,
    /// How many of them chance lets expect.
    pub expected: f64,
    /// Devices whose drift chance does not explain.
    pub named: usize,
    /// Those beyond, the least probable first; the first of them, where there are very many.
    pub apart: Vec<Drifting>,
    /// The courses of some devices, the least probable first.
    pub courses: Vec<Course>,
}

/// The drift of the devices of a group.
#[derive(Debug, Clone, Default)]
pub struct GroupDrift {
    /// Devices with a rate.
    pub devices: usize,
    /// Mean of their rates, per year.
    pub mean: f64,
    /// Standard deviation of the rates; of one there is none.
    pub s: Option<f64>,
    /// The standard uncertainty of a rate: root mean square.
    pub u: f64,
    /// Devices whose rate is beyond its expanded uncertainty.
    pub beyond: usize,
    /// How many of them chance lets expect.
    pub expected: f64,
    /// Pairs of successive calibrations.
    pub pairs: usize,
    /// Those of them with |E_n| > 1.
    pub pairs_beyond: usize,
}

/// A device that drifts by more than its U allows.
#[derive(Debug, Clone, PartialEq)]
pub struct Drifting {
    /// Its name.
    pub device: String,
    /// Its group.
    pub group: usize,
    /// Its calibrations.
    pub calibrations: usize,
    /// Rate per year, by least squares with the weights 1/u².
    pub rate: f64,
    /// Its standard uncertainty.
    pub u: f64,
    /// Its expanded uncertainty, √Σ(c U)², c being how the rate follows each estimate.
    pub expanded: f64,
    /// E_n of successive calibrations, the largest with its sign.
    pub en: f64,
    /// Probability of such a rate by chance, times the number of all devices with a rate (Bonferroni), at most 1.
    pub probability: f64,
}

impl Drifting {
    /// Whether chance does not explain it: only then is a device named.
    pub fn is_named(&self) -> bool {
        self.probability < SIGNIFICANCE
    }
}

/// The calibrations of one device: days since 1970-01-01, difference from their weighted mean, U.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Its name.
    pub device: String,
    /// Whether chance does not explain its drift.
    pub is_named: bool,
    /// Its calibrations.
    pub points: Vec<[f64; 3]>,
}

/// A device at its dates.
struct Device {
    group: usize,
    /// Its rows by date.
    rows: Vec<usize>,
    rate: f64,
    u: f64,
    expanded: f64,
    dof: f64,
    en: f64,
}

impl Device {
    /// Of rows in the order of their dates; nothing where all of them have one.
    fn of(values: &Values, dates: &[f64], rows: Vec<usize>, group: usize) -> Option<Device> {
        let weights = Weights::of(values, rows.iter().copied());
        let sum = weights.sum(&rows, |_| 1.0);
        let years = |row: usize| (dates[row] - dates[rows[0]]) / DAYS_OF_A_YEAR;
        let mean = weights.sum(&rows, years) / sum;
        let spread = weights.sum(&rows, |row| (years(row) - mean).powi(2));
        let spread = Some(spread).filter(|spread| *spread > 0.0)?;
        let origin = values.estimate[rows[0]];
        // How the rate follows each estimate.
        let c = |row: usize| weights.of_row(row) * (years(row) - mean) / spread;
        let parts =
            |of: &[f64]| -> Vec<f64> { rows.iter().map(|row| c(*row) * of[*row]).collect() };
        let [u, expanded] = [&values.u, &values.expanded].map(|of| parts(of));
        let dofs = rows.iter().map(|row| values.dof[*row]);
        let differences = rows
            .iter()
            .map(|row| c(*row) * (values.estimate[*row] - origin));
        let mut device = Device {
            group,
            rate: differences.sum(),
            u: norm(u.iter().copied()),
            expanded: norm(expanded.iter().copied()),
            dof: effective_freedom(u.iter().copied().zip(dofs)),
            en: 0.0,
            rows,
        };
        let largest = |one: f64, other: f64| if other.abs() > one.abs() { other } else { one };
        device.en = device.successive(values).fold(0.0, largest);
        Some(device)
    }

    /// E_n of each calibration against the one before.
    fn successive<'d>(&'d self, values: &'d Values) -> impl Iterator<Item = f64> + 'd {
        self.rows.windows(2).map(|pair| {
            let difference = values.estimate[pair[1]] - values.estimate[pair[0]];
            difference / of_difference(values.expanded[pair[0]], values.expanded[pair[1]])
        })
    }

    fn beyond(&self, rate: f64) -> f64 {
        2.0 * student_t_sf(rate / self.u, self.dof)
    }
}

/// The drift of the devices of all groups: `groups` are rows that weigh, `device` compares and names devices of rows.
pub(crate) fn drift<'n>(
    values: &Values,
    dates: &[f64],
    groups: impl Iterator<Item = &'n [usize]>,
    threads: usize,
    device: impl Fn(usize) -> &'n str,
) -> Drift {
    let mut found = Drift::default();
    let mut devices = Vec::new();
    for (group, rows) in groups.enumerate() {
        let dated = rows.iter().copied().filter(|row| {
            dates[*row].is_finite() && values.expanded[*row].is_finite() && !device(*row).is_empty()
        });
        let mut dated: Vec<usize> = dated.collect();
        dated.sort_by(|a, b| {
            let name = device(*a).cmp(device(*b));
            name.then(dates[*a].total_cmp(&dates[*b])).then(a.cmp(b))
        });
        let same = dated.chunk_by(|a, b| device(*a) == device(*b));
        let several = same.filter(|rows| rows.len() > 1);
        let first = devices.len();
        devices.extend(several.filter_map(|rows| Device::of(values, dates, rows.to_vec(), group)));
        found
            .groups
            .push(GroupDrift::of(values, &devices[first..], threads));
    }
    found.devices = devices.len();
    found.beyond = found.groups.iter().map(|group| group.beyond).sum();
    found.expected = found.groups.iter().map(|group| group.expected).sum();
    let tests = devices.len() as f64;
    let probability = |one: &Device| (tests * one.beyond(one.rate.abs())).min(1.0);
    let all: Vec<&Device> = devices.iter().collect();
    let mut order: Vec<(f64, &Device)> = Vec::with_capacity(all.len());
    in_order(&all, threads, probability, |one, probability| {
        order.push((probability, one));
    });
    order.sort_by(|(p, one), (q, other)| {
        let size = |one: &Device| one.rate.abs() / one.expanded;
        let worse = p.total_cmp(q).then(size(other).total_cmp(&size(one)));
        worse.then(one.rows[0].cmp(&other.rows[0]))
    });
    found.named = order.iter().filter(|(p, _)| *p < SIGNIFICANCE).count();
    let beyond = order
        .iter()
        .filter(|(_, one)| one.rate.abs() > one.expanded);
    let drifting = beyond.take(LISTED).map(|(probability, one)| Drifting {
        device: device(one.rows[0]).to_owned(),
        group: one.group,
        calibrations: one.rows.len(),
        rate: one.rate,
        u: one.u,
        expanded: one.expanded,
        en: one.en,
        probability: *probability,
    });
    found.apart = drifting.collect();
    let courses = order.iter().take(DRAWN).map(|(probability, one)| {
        let weights = Weights::of(values, one.rows.iter().copied());
        let origin = values.estimate[one.rows[0]];
        let from_origin = |row: usize| values.estimate[row] - origin;
        let mean = weights.sum(&one.rows, from_origin) / weights.sum(&one.rows, |_| 1.0);
        let point = |row: &usize| [dates[*row], from_origin(*row) - mean, values.expanded[*row]];
        Course {
            device: device(one.rows[0]).to_owned(),
            is_named: *probability < SIGNIFICANCE,
            points: one.rows.iter().map(point).collect(),
        }
    });
    found.courses = courses.collect();
    found
}

impl GroupDrift {
    fn of(values: &Values, devices: &[Device], threads: usize) -> GroupDrift {
        let count = devices.len() as f64;
        let mean = devices.iter().map(|one| one.rate).sum::<f64>() / count;
        let deviations = || devices.iter().map(|one| one.rate - mean);
        let all: Vec<&Device> = devices.iter().collect();
        let outside = |one: &Device| one.beyond(one.expanded);
        let mut expected = 0.0;
        in_order(&all, threads, outside, |_, outside| expected += outside);
        let pairs = || devices.iter().flat_map(|one| one.successive(values));
        GroupDrift {
            devices: devices.len(),
            mean,
            s: (devices.len() > 1).then(|| root_mean_square(deviations(), count - 1.0)),
            u: root_mean_square(devices.iter().map(|one| one.u), count),
            beyond: devices
                .iter()
                .filter(|one| one.rate.abs() > one.expanded)
                .count(),
            expected,
            pairs: pairs().count(),
            pairs_beyond: pairs().filter(|en| en.abs() > 1.0).count(),
        }
    }
}
