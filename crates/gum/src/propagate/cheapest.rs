//! What U would need at the least cost: the inputs improved together, each as far as it pays.
//!
//! To make u(x_i) x times what it is costs w_i (1/x − 1): its halving w_i, another halving twice as much again. Under a given
//! u_c² = Σ a_i² x_i² the sum of these costs is least where x_i³ = t³ w_i/a_i² (Lagrange), or x_i = 1 where that is more. U follows at
//! every t from the evaluation itself, and a bisection ends where it passes what is wished for. a_i² are the shares of u_c² as it is:
//! where inputs correlate, or k changes with ν_eff, the cost is near the least one, and U is what was wished for all the same.

use super::error::EvaluationError;
use super::evaluate::evaluate;
use super::options::{MonteCarloChoice, Options};
use super::requirements::HALVINGS;
use crate::budget::Budget;
use gumption_core::special::roots::try_last;

/// What all inputs together would have to be.
#[derive(Debug, Clone, PartialEq)]
pub enum Together {
    /// U is not above what is wished for as it is.
    Reached,
    /// Those that become better, the largest cost first.
    Improved(Vec<Improvement>),
    /// This is left of U where everything that may become better is known exactly.
    Floor(f64),
}

/// An input that becomes better.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Improvement {
    /// Index of the input.
    pub input: usize,
    /// Its standard uncertainty.
    pub u: f64,
    /// What it has to be.
    pub needed: f64,
    /// What that costs, in the unit of the costs.
    pub cost: f64,
}

/// The least cost at which U of a measurand is not above `wished`, with what it costs to halve the uncertainty of each input; one without a
/// positive finite cost stays as it is. `None` if what is wished for is no positive number, or there is no such measurand.
///
/// # Errors
/// As [`evaluate`] without Monte Carlo.
pub fn cheapest(
    budget: &Budget,
    measurand: usize,
    wished: f64,
    costs: &[f64],
) -> Result<Option<Together>, EvaluationError> {
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let found = evaluate(budget, &options)?;
    let gum = found.results.get(measurand).map(|result| &result.gum);
    let Some(gum) = gum.filter(|_| wished > 0.0 && wished.is_finite()) else {
        return Ok(None);
    };
    if gum.coverage.expanded <= wished {
        return Ok(Some(Together::Reached));
    }
    let payable = |input: usize| {
        let (cost, share) = (costs.get(input).copied()?, gum.inputs[input].share);
        let may = cost > 0.0 && cost.is_finite() && share > 0.0;
        may.then(|| (input, cost, libm::cbrt(cost / share)))
    };
    let payable: Vec<(usize, f64, f64)> = (0..gum.inputs.len()).filter_map(payable).collect();
    let expanded = |t: f64| {
        let better = |budget: Budget, (input, _, rate): &(usize, f64, f64)| {
            budget.with_uncertainty(*input, (t * rate).min(1.0))
        };
        let better = payable.iter().fold(budget.clone(), better);
        evaluate(&better, &options).map(|found| found.results[measurand].gum.coverage.expanded)
    };
    let floor = expanded(0.0)?;
    if floor > wished {
        return Ok(Some(Together::Floor(floor)));
    }
    // At the upper end all are as they are.
    let rates = payable.iter().map(|(.., rate)| 1.0 / rate);
    let above = rates.fold(0.0, f64::max);
    let reaches = |t| expanded(t).map(|found| found <= wished);
    let [below, _] = try_last(0.0, above, HALVINGS, reaches)?;
    let improved = payable.iter().filter(|(.., rate)| below * rate < 1.0);
    let improved = improved.map(|(input, cost, rate)| {
        let (u, times) = (gum.inputs[*input].u, below * rate);
        Improvement {
            input: *input,
            u,
            needed: u * times,
            cost: cost * (1.0 / times - 1.0),
        }
    });
    let mut improved: Vec<Improvement> = improved.collect();
    improved.sort_by(|a, b| b.cost.total_cmp(&a.cost));
    Ok(Some(Together::Improved(improved)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const THREE: &str = "model = \"a + b - c\"\n[conventions]\ncoverage_factor = 2\n[input]\n\
        a = { value = 1, u = 3 }\nb = { value = 1, u = 4 }\nc = { value = 1, u = 1 }\n";

    fn budget(text: &str) -> Budget {
        let text = format!("title = \"T\"\n[measurand.Y]\nunit = \"1\"\n{text}");
        let loaded = crate::budget::read(&text, "t.toml", Path::new("")).expect("a budget");
        loaded.rows.into_iter().next().expect("a row").budget
    }

    fn needs(budget: &Budget, wished: f64, costs: &[f64]) -> Vec<[f64; 3]> {
        let found = cheapest(budget, 0, wished, costs).expect("a value");
        let Some(Together::Improved(mut improved)) = found else {
            panic!("{found:?}")
        };
        improved.sort_by_key(|one| one.input);
        let shown = improved.into_iter();
        shown
            .map(|one| [one.input as f64, one.needed, one.cost])
            .collect()
    }

    /// Two inputs of equal cost, the third as it is: u = t·a^⅓ with t² (3^⅔ + 4^⅔) = (U/2)² − 1.
    #[test]
    fn equal_costs_bring_contributions_together() {
        let budget = budget(THREE);
        let t = ((3.5_f64.powi(2) - 1.0) / (libm::cbrt(9.0) + libm::cbrt(16.0))).sqrt();
        let found = needs(&budget, 7.0, &[1.0, 1.0, 0.0]);
        for ([input, needed, cost], (index, u)) in found.iter().zip([(0.0, 3.0), (1.0, 4.0)]) {
            assert_eq!(*input, index);
            assert!((needed - t * libm::cbrt(u)).abs() < 1e-7, "{found:?}");
            assert!((cost - (u / needed - 1.0)).abs() < 1e-9, "{found:?}");
        }
        assert_eq!(found.len(), 2);
    }

    /// No neighbour that keeps u_c costs less.
    #[test]
    fn nothing_near_costs_less() {
        let budget = budget(THREE);
        let (costs, a) = ([5.0, 1.0, 0.2], [3.0, 4.0, 1.0]);
        let found = needs(&budget, 5.0, &costs);
        let mut times = [1.0; 3];
        for [input, needed, _] in &found {
            times[*input as usize] = needed / a[*input as usize];
        }
        let square = |x: &[f64; 3]| -> f64 { (0..3).map(|i| (a[i] * x[i]).powi(2)).sum() };
        let cost = |x: &[f64; 3]| -> f64 { (0..3).map(|i| costs[i] * (1.0 / x[i] - 1.0)).sum() };
        assert!((square(&times).sqrt() - 2.5).abs() < 1e-7);
        for (i, j) in [(0, 1), (1, 2), (0, 2)] {
            for step in [0.02, -0.02] {
                let mut near = times;
                near[i] *= 1.0 + step;
                let rest = square(&times) - square(&near) + (a[j] * near[j]).powi(2);
                near[j] = rest.sqrt() / a[j];
                let is_allowed = near.iter().all(|x| *x <= 1.0);
                assert!(!is_allowed || cost(&near) > cost(&times), "{near:?}");
            }
        }
    }

    #[test]
    fn what_is_found_reaches_the_wish() {
        let budget = budget(
            "model = \"a*b - c\"\n[input]\na = { value = 2, u = 0.3, dof = 4 }\n\
             b = { value = 3, u = 0.2, dof = 9 }\nc = { value = 1, half_width = 0.5 }\n\
             [[correlation]]\nbetween = [\"a\", \"b\"]\nr = 0.4\n",
        );
        let Ok(Some(Together::Improved(improved))) = cheapest(&budget, 0, 1.5, &[1.0; 3]) else {
            panic!("improvements")
        };
        let better = improved.iter().fold(budget, |budget, one| {
            budget.with_uncertainty(one.input, one.needed / one.u)
        });
        let Ok(Some(Together::Reached)) = cheapest(&better, 0, 1.5 * (1.0 + 1e-9), &[1.0; 3])
        else {
            panic!("reached")
        };
    }

    #[test]
    fn what_cannot_be_is_said() {
        let budget = budget(THREE);
        let all = [1.0; 3];
        let found = |wished, costs: &[f64]| cheapest(&budget, 0, wished, costs);
        assert_eq!(found(100.0, &all), Ok(Some(Together::Reached)));
        assert_eq!(found(-1.0, &all), Ok(None));
        assert_eq!(found(f64::NAN, &all), Ok(None));
        assert_eq!(cheapest(&budget, 1, 1.0, &all), Ok(None));
        assert_eq!(
            found(1.0, &[f64::INFINITY, 1.0, 1.0]),
            Ok(Some(Together::Floor(6.0)))
        );
    }
}
