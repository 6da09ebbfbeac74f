//! One measurand in one group of rows: where the estimates lie, whether they scatter as their u says, what makes u large.

use gumption_core::special::{chi_squared_sf, f_cdf, f_sf};
use gumption_core::statistics::{median, root_mean_square};

use crate::deviation::{Others, SIGNIFICANCE};
use crate::parallel::in_order;
use crate::results::{MeasurandValues, Values};

/// What is found of a measurand in a group.
#[derive(Debug, Clone)]
pub struct GroupResult {
    /// Rows with an estimate.
    pub values: usize,
    /// Rows without one, though no fault says why: the field is empty, or holds what instruments write of an overload.
    pub missing: usize,
    /// Rows with an estimate of which no u above zero is known: they have no weight, and no test.
    pub unweighed: usize,
    /// Mean of the estimates.
    pub mean: f64,
    /// Their experimental standard deviation (GUM 4.2.2); of one there is none.
    pub s: Option<f64>,
    /// The smallest and the largest of them.
    pub range: [f64; 2],
    /// The claimed standard uncertainty: root mean square.
    pub u: f64,
    /// The expanded uncertainty: root mean square.
    pub expanded: f64,
    /// Whether the estimates scatter as u says; nothing where fewer than two have an uncertainty.
    pub consistency: Option<Consistency>,
    /// The inputs, where their shares of u² are given.
    pub components: Vec<Component>,
    /// Rows whose E_n was formed.
    pub tested: usize,
    /// Of these, those with |E_n| > 1.
    pub beyond: usize,
    /// How many of them chance lets expect beyond 1.
    pub expected: f64,
}

/// The scatter of estimates beside that which their u lets expect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Consistency {
    /// Rows with an uncertainty.
    pub count: usize,
    /// Mean with the weights 1/u².
    pub mean: f64,
    /// Its standard uncertainty from the claimed ones, (Σ 1/u²)^(-1/2), larger where these have few degrees of freedom (Meier 1953).
    pub u: f64,
    /// Σ (x − mean)²/u².
    pub chi_squared: f64,
    /// Its degrees of freedom, one less than there are rows.
    pub dof: usize,
    /// The Birge ratio √(χ²/ν) (Birge 1932): how many times the scatter is what u says.
    pub birge: f64,
    /// Probability of a larger χ², where u is right and the items do not differ; where u has finite degrees of freedom, each deviation
    /// counts for it as a normal one of the same probability.
    pub p_larger: f64,
    /// Degrees of freedom of the claimed u, the median.
    pub dof_of_u: f64,
}

/// How estimates scatter, beside what their u claims.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scatter {
    /// More than chance explains.
    More,
    /// Less than chance explains.
    Less,
    /// As it lets expect.
    AsClaimed,
}

impl Consistency {
    /// Whether chance explains the scatter, where so many groups were looked at (Bonferroni).
    ///
    /// The u of all rows may be one estimate, as it is where a budget gives them the same: χ²/(n − 1) is a ratio of two variances then, F
    /// of n − 1 and ν, which no number of rows makes more certain than ν does. For infinite ν that is χ² again.
    pub fn scatter(&self, groups: usize) -> Scatter {
        let (ratio, dof) = (self.birge * self.birge, self.dof as f64);
        let [larger, smaller] = [f_sf, f_cdf].map(|p| p(ratio, dof, self.dof_of_u));
        let improbable = |p: f64| groups as f64 * p < SIGNIFICANCE;
        match () {
            () if improbable(larger) => Scatter::More,
            () if improbable(smaller) => Scatter::Less,
            () => Scatter::AsClaimed,
        }
    }
}

/// An input in the budgets of a group.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Its name.
    pub name: String,
    /// Rows in which its share of u² is the largest.
    pub dominates: usize,
    /// The median of its share.
    pub median_share: f64,
}

/// Rows of a group, with what several chapters need of them.
#[derive(Debug)]
pub(crate) struct Members {
    /// How many have a result without an estimate.
    pub missing: usize,
    /// Those with an estimate.
    pub valued: Vec<usize>,
    /// Those of them with an uncertainty that weighs them.
    pub weighed: Vec<usize>,
    /// The median of the estimates of these.
    pub median: f64,
}

impl Members {
    pub fn of(values: &Values, rows: &[usize], has_result: impl Fn(usize) -> bool) -> Members {
        let is_valued = |row: &usize| values.estimate[*row].is_finite();
        let (valued, without): (Vec<usize>, Vec<usize>) = rows.iter().copied().partition(is_valued);
        let weighed = valued.iter().copied().filter(|row| values.weighs(*row));
        let weighed: Vec<usize> = weighed.collect();
        let median = median(weighed.iter().map(|row| values.estimate[*row]).collect());
        Members {
            missing: without.into_iter().filter(|row| has_result(*row)).count(),
            valued,
            weighed,
            median,
        }
    }
}

impl GroupResult {
    /// Without E_n, which takes all groups; `scores` gets the deviation of each row from the others, in standard deviations.
    pub(crate) fn of(
        measurand: &MeasurandValues,
        members: &Members,
        threads: usize,
        scores: impl FnMut(f64),
    ) -> GroupResult {
        let values = &measurand.values;
        let count = members.valued.len();
        let estimates = || members.valued.iter().map(|row| values.estimate[*row]);
        let origin = estimates().next().unwrap_or(f64::NAN);
        let mean = origin + estimates().map(|x| x - origin).sum::<f64>() / count as f64;
        let deviations = || estimates().map(|x| x - mean);
        let known = |all: &[f64]| {
            let known = members.weighed.iter().map(|row| all[*row]);
            let known: Vec<f64> = known.filter(|x| x.is_finite()).collect();
            root_mean_square(known.iter().copied(), known.len() as f64)
        };
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        GroupResult {
            values: count,
            missing: members.missing,
            unweighed: count - members.weighed.len(),
            mean,
            s: (count > 1).then(|| root_mean_square(deviations(), (count - 1) as f64)),
            range: estimates().fold(ends, |[low, high], x| [low.min(x), high.max(x)]),
            u: known(&values.u),
            expanded: known(&values.expanded),
            consistency: Consistency::of(values, members, threads, scores),
            components: components(measurand, &members.valued),
            tested: 0,
            beyond: 0,
            expected: 0.0,
        }
    }
}

impl Consistency {
    /// With each row beside the weighted mean of all others: d_i of variance u_i²/(1 − h_i), h_i = w_i/W, so that
    /// Σ (x_i − x̄)²/u_i² = Σ (1 − h_i) z_i² with z_i = d_i/u(d_i).
    fn of(
        values: &Values,
        members: &Members,
        threads: usize,
        mut scores: impl FnMut(f64),
    ) -> Option<Consistency> {
        let rows = &members.weighed;
        let others = Others::of(values, rows, members.median, None);
        let sums = others.sums();
        let dof = rows.len().checked_sub(1).filter(|dof| *dof > 0)?;
        let (mut chi_squared, mut of_scores) = (0.0, 0.0);
        let of_row = |row| {
            others
                .deviation(row, true)
                .map(|one| (one.difference, one.score()))
        };
        in_order(rows, threads, of_row, |row, found| {
            if let Some((difference, score)) = found {
                scores(score);
                // x − x̄ = (1 − h) d
                let others = 1.0 - sums.share(row);
                let deviation = others * difference / values.u[row];
                chi_squared += deviation * deviation;
                of_scores += others * score * score;
            }
        });
        let dofs = rows.iter().map(|row| values.dof[*row]).collect();
        Some(Consistency {
            count: rows.len(),
            mean: sums.mean(),
            u: sums.u(),
            chi_squared,
            dof,
            birge: (chi_squared / dof as f64).sqrt(),
            p_larger: chi_squared_sf(of_scores, dof as f64),
            dof_of_u: median(dofs),
        })
    }
}

fn components(measurand: &MeasurandValues, rows: &[usize]) -> Vec<Component> {
    let shares = &measurand.shares;
    let mut dominates = vec![0; shares.len()];
    for row in rows {
        let of_row = shares.iter().map(|(_, shares)| shares[*row]).enumerate();
        let known = of_row.filter(|(_, share)| share.is_finite());
        // Of equal ones the first.
        let largest = known.reduce(|one, other| if other.1 > one.1 { other } else { one });
        if let Some((input, _)) = largest {
            dominates[input] += 1;
        }
    }
    let all = shares.iter().zip(dominates);
    let component = |((name, shares), dominates): (&(String, Vec<f64>), usize)| Component {
        name: name.clone(),
        dominates,
        median_share: median(rows.iter().map(|row| shares[*row]).collect()),
    };
    all.map(component).collect()
}
