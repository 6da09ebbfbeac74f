//! A value beside others that should agree with it: their weighted mean without it, the difference, and how probable that is.

use std::collections::HashMap;

use gumption_core::special::{normal_sf, student_t_score, student_t_sf};
use gumption_core::statistics::{effective_freedom, norm, power_of_two};

use crate::results::Values;

/// Below this probability chance does not explain what is seen, over all that was tested: the 5 % of a test at 95 %, at which
/// certificates state their coverage, too.
pub const SIGNIFICANCE: f64 = 0.05;

/// Weights 1/u², of u in a unit of their own: u⁻² in that of the table leaves the range of doubles long before u does.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights<'v> {
    values: &'v Values,
    /// A power of two near the smallest u of the rows: a division by it is exact.
    pub unit: f64,
}

impl<'v> Weights<'v> {
    pub fn of(values: &'v Values, rows: impl Iterator<Item = usize>) -> Weights<'v> {
        let smallest = rows.map(|row| values.u[row]).fold(f64::INFINITY, f64::min);
        Weights {
            values,
            unit: power_of_two(smallest),
        }
    }

    /// 1/u² of a row.
    pub fn of_row(&self, row: usize) -> f64 {
        let u = self.u(row);
        1.0 / (u * u)
    }

    /// The u of a row, in the unit of the weights.
    pub fn u(&self, row: usize) -> f64 {
        self.values.u[row] / self.unit
    }

    /// Σ w f over some rows.
    pub fn sum(&self, rows: &[usize], of_row: impl Fn(usize) -> f64) -> f64 {
        rows.iter()
            .map(|row| self.of_row(*row) * of_row(*row))
            .sum()
    }
}

/// Sums of values with the weights 1/u², from which one may be taken away again.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sums<'v> {
    weights: Weights<'v>,
    /// What is near the values: differences from it keep their digits.
    origin: f64,
    pub count: usize,
    /// Σ w
    pub weight: f64,
    /// Σ w (x − origin)
    first: f64,
    /// Σ w/ν
    looseness: f64,
    /// Σ w²/ν
    scatter: f64,
}

/// The difference of two values that have nothing in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deviation {
    pub other: f64,
    pub difference: f64,
    pub u: f64,
    /// Its degrees of freedom (Welch–Satterthwaite, GUM G.4.1).
    pub dof: f64,
}

impl<'v> Sums<'v> {
    pub fn of(
        values: &'v Values,
        rows: impl Iterator<Item = usize> + Clone,
        origin: f64,
    ) -> Sums<'v> {
        let weights = Weights::of(values, rows.clone());
        Sums::empty(weights, origin).with(rows)
    }

    fn empty(weights: Weights<'v>, origin: f64) -> Sums<'v> {
        Sums {
            weights,
            origin,
            count: 0,
            weight: 0.0,
            first: 0.0,
            looseness: 0.0,
            scatter: 0.0,
        }
    }

    fn with(mut self, rows: impl Iterator<Item = usize>) -> Sums<'v> {
        let values = self.weights.values;
        for row in rows {
            let weight = self.weights.of_row(row);
            self.count += 1;
            self.weight += weight;
            self.first += weight * (values.estimate[row] - self.origin);
            self.looseness += weight / values.dof[row];
            self.scatter += weight * weight / values.dof[row];
        }
        self
    }

    /// Without some of its rows, of which these are the sums in the same unit.
    fn without(&self, own: &Sums<'_>) -> Sums<'v> {
        Sums {
            count: self.count - own.count,
            weight: self.weight - own.weight,
            first: self.first - own.first,
            looseness: self.looseness - own.looseness,
            scatter: self.scatter - own.scatter,
            ..*self
        }
    }

    /// Those of one row in the unit of these.
    fn of_row(&self, row: usize) -> Sums<'v> {
        Sums::empty(self.weights, self.origin).with(std::iter::once(row))
    }

    /// What a row has of the weights of all.
    pub fn share(&self, row: usize) -> f64 {
        self.weights.of_row(row) / self.weight
    }

    pub fn mean(&self) -> f64 {
        self.origin + self.first / self.weight
    }

    /// Its standard uncertainty, (1/W · (1 + 4 Σ h (1 − h)/ν))^(1/2) with h = w/W: where u itself is estimated, small ones weigh too
    /// much (Meier, Biometrics 9 (1953) 59).
    pub fn u(&self) -> f64 {
        let loose = self.looseness / self.weight - self.scatter / (self.weight * self.weight);
        self.weights.unit * ((1.0 + 4.0 * loose.max(0.0)) / self.weight).sqrt()
    }

    /// Degrees of freedom of the mean, whose terms are w x/W: W²/Σ(w²/ν).
    fn dof(&self) -> f64 {
        match self.scatter > 0.0 {
            true => self.weight * self.weight / self.scatter,
            false => f64::INFINITY,
        }
    }
}

/// Which rows are of one device: of each row of a table the number of its device.
pub(crate) type Devices = [u32];

/// Each of these rows beside the weighted mean of the others among them: of those of other devices, where a device has several.
#[derive(Debug)]
pub(crate) struct Others<'v> {
    values: &'v Values,
    sums: Sums<'v>,
    /// What weighs more than all others together, a row or a device: a difference of sums would leave nothing of these.
    heaviest: Option<(usize, Sums<'v>)>,
    /// The devices of rows, and the sums of the rows that each has among these.
    of_device: Option<(&'v Devices, HashMap<u32, Sums<'v>>)>,
}

impl<'v> Others<'v> {
    /// With `devices`, other rows of its device are none of the others of a row: what is wrong with it is wrong with them.
    pub fn of(
        values: &'v Values,
        rows: &[usize],
        origin: f64,
        devices: Option<&'v Devices>,
    ) -> Others<'v> {
        let sums = Sums::of(values, rows.iter().copied(), origin);
        let of_device = devices.map(|devices| {
            let mut of_device: HashMap<u32, Sums<'v>> = HashMap::new();
            for row in rows {
                let empty = Sums::empty(sums.weights, origin);
                let own = of_device.entry(devices[*row]).or_insert(empty);
                *own = own.with(std::iter::once(*row));
            }
            (devices, of_device)
        });
        let is_heavy = |weight: f64| 2.0 * weight > sums.weight;
        let heavy = match &of_device {
            None => {
                let mut all = rows.iter().copied();
                all.find(|row| is_heavy(sums.weights.of_row(*row)))
            }
            Some((_, of_device)) => {
                let mut all = of_device.iter();
                let heavy = all.find(|(_, own)| is_heavy(own.weight));
                heavy.map(|(device, _)| *device as usize)
            }
        };
        let heaviest = heavy.map(|heavy| {
            let others = rows.iter().copied();
            let others = others.filter(|row| key(*row, devices) != heavy);
            (heavy, Sums::of(values, others, origin))
        });
        Others {
            values,
            sums,
            heaviest,
            of_device,
        }
    }

    /// All of them together.
    pub fn sums(&self) -> &Sums<'v> {
        &self.sums
    }

    /// A row beside the mean of the others, of which it is one or not; nothing where there are no others.
    pub fn deviation(&self, row: usize, is_one: bool) -> Option<Deviation> {
        let devices = self.of_device.as_ref();
        let own = match devices {
            None => is_one.then(|| self.sums.of_row(row)),
            Some((devices, of_device)) => of_device.get(&devices[row]).copied(),
        };
        let key = key(row, devices.map(|(devices, _)| *devices));
        let others = match (own, &self.heaviest) {
            (None, _) => self.sums,
            (Some(_), Some((heavy, others))) if *heavy == key => *others,
            (Some(own), _) => self.sums.without(&own),
        };
        let other = (others.count > 0).then(|| (others.mean(), others.u(), others.dof()));
        other.map(|other| Deviation::of(self.values, row, other))
    }
}

/// What a row is one of: its device, or nothing but itself.
fn key(row: usize, devices: Option<&Devices>) -> usize {
    devices.map_or(row, |devices| devices[row] as usize)
}

impl Deviation {
    /// Of the value of a row from another with its u and ν.
    pub fn of(values: &Values, row: usize, (other, u_other, dof): (f64, f64, f64)) -> Deviation {
        let u = values.u[row];
        Deviation {
            other,
            difference: values.estimate[row] - other,
            u: norm([u, u_other].into_iter()),
            dof: effective_freedom([(u, values.dof[row]), (u_other, dof)].into_iter()),
        }
    }

    /// Probability of a difference of that size or more, either way, where both values are what they claim to be.
    pub fn probability(&self) -> f64 {
        self.beyond(self.difference.abs())
    }

    /// What that probability is at least: that of a normal distribution, whose tails are shorter.
    pub fn least_probability(&self) -> f64 {
        2.0 * normal_sf(self.difference.abs() / self.u)
    }

    /// Probability of a difference beyond this one.
    pub fn beyond(&self, difference: f64) -> f64 {
        let size = difference / self.u;
        2.0 * match self.dof.is_finite() {
            true => student_t_sf(size, self.dof),
            false => normal_sf(size),
        }
    }

    /// The difference in standard deviations of a normal distribution in which it were as improbable.
    pub fn score(&self) -> f64 {
        student_t_score(self.difference / self.u, self.dof)
    }
}
