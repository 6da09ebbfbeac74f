//! What U would need: the standard uncertainty that one input has to have, all others as they are.
//!
//! U is found by the evaluation itself, at every size of the input's uncertainty that is tried: k follows ν_eff, and
//! correlated inputs do not add in squares. A bisection then ends where U passes what is wished for.

use super::error::EvaluationError;
use super::evaluate::evaluate;
use super::options::{MonteCarloChoice, Options};
use crate::budget::Budget;
use gumption_core::special::roots::try_last;

/// What U of a measurand would need.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirements {
    /// Index of the measurand.
    pub measurand: usize,
    /// U as it is, by the law of propagation of uncertainty.
    pub expanded: f64,
    /// U that is wished for.
    pub wished: f64,
    /// Inputs that contribute, the largest contribution first.
    pub inputs: Vec<Requirement>,
}

/// What U would need of one input alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Requirement {
    /// Index of the input.
    pub input: usize,
    /// Its standard uncertainty.
    pub u: f64,
    /// What it would have to be.
    pub needed: Needed,
}

/// The standard uncertainty that an input would have to have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Needed {
    /// At most this.
    Below(f64),
    /// U stays above what is wished for even where the input is known exactly: this is left of it.
    Floor(f64),
    /// U stays below what is wished for with more than [`MOST`] times the uncertainty.
    Any,
}

/// Largest multiple of a standard uncertainty that is looked at.
pub const MOST: f64 = 1024.0;

/// Most inputs that are asked for; the others contribute less.
const MOST_INPUTS: usize = 40;

/// Halvings: what is looked for is found to 10⁻⁹ of itself.
pub(super) const HALVINGS: usize = 30;

/// What every input would have to be, alone, so that U of a measurand is not above `wished`; `None` if that is no
/// positive number or there is no such measurand.
///
/// # Errors
/// As [`evaluate`] without Monte Carlo.
pub fn requirements(
    budget: &Budget,
    measurand: usize,
    wished: f64,
) -> Result<Option<Requirements>, EvaluationError> {
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let found = evaluate(budget, &options)?;
    let Some(gum) = found.results.get(measurand).map(|result| &result.gum) else {
        return Ok(None);
    };
    if !(wished > 0.0 && wished.is_finite()) {
        return Ok(None);
    }
    let expanded = |input: usize, factor: f64| {
        let budget = budget.with_uncertainty(input, factor);
        evaluate(&budget, &options).map(|found| found.results[measurand].gum.coverage.expanded)
    };
    let size = |input: &usize| gum.inputs[*input].contribution.abs();
    let mut order: Vec<usize> = (0..gum.inputs.len()).filter(|i| size(i) > 0.0).collect();
    order.sort_by(|a, b| size(b).total_cmp(&size(a)));
    order.truncate(MOST_INPUTS);
    let inputs = order
        .into_iter()
        .map(|input| -> Result<Requirement, EvaluationError> {
            let u = gum.inputs[input].u;
            let needed = needed(u, wished, |factor| expanded(input, factor))?;
            Ok(Requirement { input, u, needed })
        });
    Ok(Some(Requirements {
        measurand,
        expanded: gum.coverage.expanded,
        wished,
        inputs: inputs.collect::<Result<_, _>>()?,
    }))
}

/// The largest uncertainty at which U, as it follows from a multiple of `u`, is not above `wished`.
fn needed(
    u: f64,
    wished: f64,
    expanded: impl Fn(f64) -> Result<f64, EvaluationError>,
) -> Result<Needed, EvaluationError> {
    let floor = expanded(0.0)?;
    if floor > wished {
        return Ok(Needed::Floor(floor));
    }
    let (mut below, mut above) = (0.0, 1.0);
    while expanded(above)? <= wished {
        below = above;
        above *= 2.0;
        if above > MOST {
            return Ok(Needed::Any);
        }
    }
    let reaches = |factor| expanded(factor).map(|found| found <= wished);
    let [below, _] = try_last(below, above, HALVINGS, reaches)?;
    Ok(Needed::Below(below * u))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn budget(text: &str) -> Budget {
        let text = format!("title = \"T\"\n[measurand.Y]\nunit = \"1\"\n{text}");
        let loaded = crate::budget::read(&text, "t.toml", Path::new("")).expect("a budget");
        loaded.rows.into_iter().next().expect("a row").budget
    }

    fn needs(budget: &Budget, wished: f64) -> Vec<Needed> {
        let found = requirements(budget, 0, wished).expect("a value");
        let inputs = found.expect("a wish").inputs;
        inputs.into_iter().map(|one| one.needed).collect()
    }

    /// U = 2√(a² + b²), solved for a and for b.
    #[test]
    fn squares_are_taken_from_one_another() {
        let budget = budget(
            "model = \"a + b\"\n[conventions]\ncoverage_factor = 2\n[input]\n\
             a = { value = 1, u = 3 }\nb = { value = 1, u = 4 }\n",
        );
        let close = |found: Needed, expected: f64| {
            assert!(
                matches!(found, Needed::Below(u) if (u - expected).abs() < 1e-7),
                "{found:?}"
            );
        };
        let [b, a] = needs(&budget, 9.0)[..] else {
            panic!("two inputs")
        };
        close(b, (20.25_f64 - 9.0).sqrt());
        close(a, (20.25_f64 - 16.0).sqrt());
        let [b, a] = needs(&budget, 7.0)[..] else {
            panic!("two inputs")
        };
        close(b, (12.25_f64 - 9.0).sqrt());
        assert!(
            matches!(a, Needed::Floor(floor) if (floor - 8.0).abs() < 1e-12),
            "{a:?}"
        );
        // More than it is: 2√(a² + 16) = 20.
        close(needs(&budget, 20.0)[1], 84.0_f64.sqrt());
        assert_eq!(requirements(&budget, 0, 0.0), Ok(None));
        assert_eq!(requirements(&budget, 1, 1.0), Ok(None));
    }

    /// What is found gives the U that was wished for, also where k follows ν_eff and inputs correlate.
    #[test]
    fn what_is_found_reaches_the_wish() {
        let budget = budget(
            "model = \"a*b - c\"\n[conventions]\ndegrees_of_freedom = \"real\"\n[input]\na = { value = 2, u = 0.3, dof = 4 }\n\
             b = { value = 3, u = 0.2, dof = 9 }\nc = { value = 1, half_width = 0.5 }\n\
             [[correlation]]\nbetween = [\"a\", \"b\"]\nr = 0.4\n",
        );
        let now = requirements(&budget, 0, 1.0)
            .expect("a value")
            .expect("a wish")
            .expanded;
        let found = requirements(&budget, 0, 0.85 * now)
            .expect("a value")
            .expect("a wish");
        // Of u² = 0.9² + 0.4² + 2·0.4·0.9·0.4 + 0.5²/3 = 1.341 a wish for 85 % of U leaves 72 %, where k stays: nothing without b, 67 %,
        // or without a, 18 %, both of which raise ν_eff; but not without c, 94 %.
        let mut reached = 0;
        for one in found.inputs {
            if let Needed::Below(u) = one.needed {
                let changed = budget.with_uncertainty(one.input, u / one.u);
                let then = requirements(&changed, 0, 1.0)
                    .expect("a value")
                    .expect("a wish");
                let ratio = then.expanded / found.wished;
                assert!((ratio - 1.0).abs() < 1e-6 && ratio <= 1.0 + 1e-9, "{one:?}");
                reached += 1;
            }
        }
        assert_eq!(reached, 2);
    }

    #[test]
    fn what_was_stopped_has_no_result() {
        let budget = budget("model = \"a\"\n[input]\na = { value = 1, u = 3 }\n");
        let options = Options::default();
        options.progress.stop();
        assert_eq!(
            evaluate(&budget, &options).err(),
            Some(EvaluationError::Stopped)
        );
    }
}
