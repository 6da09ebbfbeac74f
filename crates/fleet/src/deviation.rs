//! A value beside others that should agree with it: their weighted mean without it, the difference, and how probable that is.

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
        let mut sums = Sums {
            weights,
            origin,
            count: 0,
            weight: 0.0,
            first: 0.0,
            looseness: 0.0,
            scatter: 0.0,
        };
        for row in rows {
            let weight = weights.of_row(row);
            sums.count += 1;
            sums.weight += weight;
            sums.first += weight * (values.estimate[row] - origin);
            sums.looseness += weight / values.dof[row];
            sums.scatter += weight * weight / values.dof[row];
        }
        sums
    }

    fn without(&self, row: usize) -> Sums<'v> {
        let values = self.weights.values;
        let weight = self.weights.of_row(row);
        Sums {
            weights: self.weights,
            origin: self.origin,
            count: self.count - 1,
            weight: self.weight - weight,
            first: self.first - weight * (values.estimate[row] - self.origin),
            looseness: self.looseness - weight / values.dof[row],
            scatter: self.scatter - weight * weight / values.dof[row],
        }
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

/// Each of these rows beside the weighted mean of the others among them.
#[derive(Debug)]
pub(crate) struct Others<'v> {
    values: &'v Values,
    sums: Sums<'v>,
    /// The row that weighs more than all others together: a difference of sums would leave nothing of these.
    heaviest: Option<(usize, Sums<'v>)>,
}

impl<'v> Others<'v> {
    pub fn of(values: &'v Values, rows: &[usize], origin: f64) -> Others<'v> {
        let sums = Sums::of(values, rows.iter().copied(), origin);
        let heavy = |row: &&usize| 2.0 * sums.weights.of_row(**row) > sums.weight;
        let heaviest = rows.iter().find(heavy).map(|heavy| {
            let others = rows.iter().copied().filter(|row| row != heavy);
            (*heavy, Sums::of(values, others, origin))
        });
        Others {
            values,
            sums,
            heaviest,
        }
    }

    /// All of them together.
    pub fn sums(&self) -> &Sums<'v> {
        &self.sums
    }

    /// A row beside the mean of the others, of which it is one or not; nothing where there are no others.
    pub fn deviation(&self, row: usize, is_one: bool) -> Option<Deviation> {
        let others = match &self.heaviest {
            _ if !is_one => self.sums,
            Some((heavy, others)) if *heavy == row => *others,
            _ => self.sums.without(row),
        };
        let other = (others.count > 0).then(|| (others.mean(), others.u(), others.dof()));
        other.map(|other| Deviation::of(self.values, row, other))
    }
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
