//! What speaks against a fit that was found: residuals that are no chance, a pole between the points, a better minimum.

use super::columns::Column;
use super::formula::Formula;
use crate::budget::fit::FitDoubt;
use gumption_core::least_squares::{self, Elsewhere, Problem, Runs, Solution};
use gumption_core::model::Notice;

/// Parts of the stretches between points in which a pole is looked for, all together.
const MOST_CELLS: usize = 4096;

/// Parts of one stretch.
const CELLS: usize = 16;

/// All doubts about a solution. The columns are in the order of the solver: response first.
pub(super) fn of(
    formula: &Formula,
    columns: &[&Column<'_>],
    problem: &Problem<'_>,
    solution: &Solution,
) -> Vec<FitDoubt> {
    let better = better_minimum(formula, problem, solution);
    // Without residuals there is no pattern in them.
    let scatters = solution.residual_sd > 0.0;
    let pattern =
        runs(problem, solution).filter(|runs| scatters && runs.probability < FitDoubt::LEVEL);
    let pattern = pattern.map(|runs| FitDoubt::Pattern {
        runs: runs.runs,
        points: runs.above + runs.below,
        p: runs.probability,
    });
    let pole = pole(formula, problem, &solution.parameters).map(|pole| FitDoubt::Pole {
        argument: pole.argument,
        predictor: columns[1].name.to_string(),
        between: pole.between,
        unit: columns[1].unit.clone(),
    });
    [better, pole, pattern].into_iter().flatten().collect()
}

/// Runs of the residuals along the only predictor; where it repeats, of their means.
fn runs(problem: &Problem<'_>, solution: &Solution) -> Option<Runs> {
    let order = sorted(problem)?;
    let groups = order.chunk_by(|a, b| problem.x[*a] == problem.x[*b]);
    least_squares::runs(groups.map(|group| group.iter().map(|i| solution.residuals[*i]).sum()))
}

/// The points in the order of the only predictor.
fn sorted(problem: &Problem<'_>) -> Option<Vec<usize>> {
    if problem.x.ncols() != 1 {
        return None;
    }
    let mut order: Vec<usize> = (0..problem.points()).collect();
    order.sort_by(|a, b| problem.x[*a].total_cmp(&problem.x[*b]));
    Some(order)
}

/// A divisor, or an argument of a function, that comes to the end of its range between two points.
struct Pole {
    argument: String,
    between: [f64; 2],
}

/// A pole of the curve between two neighbouring points.
fn pole(formula: &Formula, problem: &Problem<'_>, parameters: &[f64]) -> Option<Pole> {
    let model = formula.model.as_ref()?;
    let order = sorted(problem)?;
    let gaps = order
        .windows(2)
        .map(|pair| [problem.x[pair[0]], problem.x[pair[1]]]);
    let cells = (MOST_CELLS / order.len()).min(CELLS);
    let mut u = vec![0.0; parameters.len() + 1];
    let mut at = [parameters, &[0.0]].concat();
    let last = parameters.len();
    gaps.filter(|[low, high]| low < high).find_map(|between| {
        let half = (between[1] - between[0]) / (2 * cells) as f64;
        (0..cells).find_map(|cell| {
            at[last] = between[0] + half * (2 * cell + 1) as f64;
            u[last] = half;
            // The points themselves, at the ends of the outer cells, have values.
            let near = model.near_singular(&at, &u, 1.0 - 1e-9);
            near.into_iter().find_map(|notice| match notice {
                Notice::Near { argument, .. } => Some(Pole { argument, between }),
                _ => None,
            })
        })
    })
}

/// A better minimum that another start leads to, and whose curve has no pole between the points.
fn better_minimum(
    formula: &Formula,
    problem: &Problem<'_>,
    solution: &Solution,
) -> Option<FitDoubt> {
    // What is left of a curve through all points cannot be improved upon.
    if solution.chi_squared.is_nan() || solution.residual_sd == 0.0 {
        return None;
    }
    let below = solution.chi_squared * (1.0 - Elsewhere::DIFFERENT);
    let mut others = least_squares::elsewhere(problem).into_iter();
    let better = others.find(|other| {
        other.chi_squared < below && pole(formula, problem, &other.parameters).is_none()
    })?;
    let names = formula.parameters.iter().map(|p| p.name.clone());
    Some(FitDoubt::BetterMinimum {
        parameters: names.zip(better.parameters).collect(),
        residuals: (better.chi_squared / solution.chi_squared).sqrt(),
    })
}
