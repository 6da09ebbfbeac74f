//! Second-order terms of a formula with many inputs each of which interacts with few.
//!
//! A sweep along several directions gives Σ_l h_kl and Σ_l t_kll for every input k. Where no input interacts
//! with two of the directions, these sums have one term each, and nothing is lost (the colouring of sparse
//! Hessians: Coleman and Moré, *Estimation of sparse Hessian matrices and graph coloring problems*,
//! Mathematical Programming 28, 1984).

use super::direction::{Direction, movers};
use super::sums::{SecondOrderOutcome, Sums, unit};
use crate::budget::Budget;
use crate::propagate::gum::Linear;
use gumption_core::model::Neighbours;

/// The outcomes of all measurands, where inputs are independent and interact with few others.
pub(super) fn outcomes(
    budget: &Budget,
    linear: &Linear,
    directions: &[Direction],
) -> Option<Vec<SecondOrderOutcome>> {
    let movers = movers(directions, linear.x.len())?;
    let neighbours = budget.model.neighbours()?;
    let units: Vec<f64> = linear.measurands.iter().map(|m| unit(m.u)).collect();
    let mut sums: Vec<Sums> = linear
        .measurands
        .iter()
        .zip(&units)
        .map(|(measurand, unit)| Sums::new(measurand, *unit, linear.x.len(), 0))
        .collect();
    let moved = (0..linear.x.len()).filter(|input| movers[*input].is_some());
    for sweep in sweeps(moved, &neighbours) {
        let sweep: Vec<&Direction> = sweep
            .into_iter()
            .filter_map(|input| movers[input])
            .collect();
        let mut whole = vec![0.0; linear.x.len()];
        for (input, change) in sweep.iter().flat_map(|l| &l.steps) {
            whole[*input] = *change;
        }
        let all = budget.model.along(&linear.x, &whole);
        for ((sums, mut along), unit) in sums.iter_mut().zip(all).zip(&units) {
            along.second.iter_mut().for_each(|s| *s /= unit);
            along.third.iter_mut().for_each(|t| *t /= unit);
            sums.add_slopes(&along);
            for l in &sweep {
                for k in near(l, &neighbours).filter_map(|input| movers[input]) {
                    for &(input, change) in &k.steps {
                        let terms = [along.second[input] * change, along.third[input] * change];
                        sums.add_terms(k, l, terms);
                    }
                }
            }
        }
    }
    let outcomes = sums.into_iter().zip(units);
    Some(outcomes.map(|(sums, unit)| sums.outcome(unit)).collect())
}

/// The inputs with which those of a direction interact.
fn near<'a>(
    direction: &'a Direction,
    neighbours: &'a Neighbours,
) -> impl Iterator<Item = usize> + 'a {
    let moved = direction.steps.iter();
    moved.flat_map(|(input, _)| neighbours.of(*input).iter().copied())
}

/// Inputs that share a sweep: each goes into the first one in which nothing moves that it has a neighbour in
/// common with.
pub(super) fn sweeps(
    inputs: impl Iterator<Item = usize>,
    neighbours: &Neighbours,
) -> Vec<Vec<usize>> {
    let mut sweeps: Vec<Vec<usize>> = Vec::new();
    // Per input the sweeps in which something moves that it interacts with.
    let mut taken: Vec<Vec<usize>> = vec![Vec::new(); neighbours.inputs()];
    let mut refused = Vec::new();
    for input in inputs {
        refused.resize(sweeps.len(), usize::MAX);
        for sweep in neighbours.of(input).iter().flat_map(|near| &taken[*near]) {
            refused[*sweep] = input;
        }
        let free = refused.iter().position(|last| *last != input);
        let sweep = free.unwrap_or(sweeps.len());
        if sweep == sweeps.len() {
            sweeps.push(Vec::new());
        }
        sweeps[sweep].push(input);
        for near in neighbours.of(input) {
            taken[*near].push(sweep);
        }
    }
    sweeps
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Terms, directions, over};
    use super::*;
    use crate::propagate::gum::linearise;

    /// A chain of twelve inputs with formulas that overlap.
    fn chain(term: impl Fn(usize) -> String) -> Budget {
        let model: Vec<String> = (0..12).map(term).collect();
        let mut text = format!(
            "title = \"T\"\n[measurand.Y]\nmodel = \"{}\"\n",
            model.join("+")
        );
        for i in 0..12 {
            let u = ["u = 0.2", "half_width = 0.4", "plus = 0.3\nminus = 0.1"][i % 3];
            let value = 1.0 + 0.1 * i as f64;
            text += &format!("[input.x{i}]\nvalue = {value}\n{u}\n");
        }
        let loaded = crate::budget::read(&text, "t", Path::new("")).unwrap();
        loaded.rows.into_iter().next().unwrap().budget
    }

    #[test]
    fn few_sweeps_give_what_one_for_each_input_does() {
        let near =
            |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * (a.abs() + b.abs()), "{a} {b}");
        type Term = fn(usize) -> String;
        let cases: [(Term, usize); 3] = [
            (|i| format!("x{i} * exp(x{} / 3)", (i + 1) % 12), 4),
            (
                |i| format!("x{i}^2 * x{} / x{}", (i + 1) % 12, (i + 2) % 12),
                7,
            ),
            (|i| format!("hypot(x{i}, x{})", (i + 6) % 12), 2),
        ];
        for (term, most) in cases {
            let budget = chain(term);
            let linear = linearise(&budget).unwrap();
            let blocks = budget.model.interactions();
            let (components, inputs) = (&budget.components, &budget.inputs);
            let directions = directions(&linear.covariance, inputs, components, &blocks);
            let neighbours = budget.model.neighbours().unwrap();
            let count = sweeps(0..12, &neighbours).len();
            assert!(count <= most, "{count}");
            let all = over(&budget, &linear, &blocks).remove(0);
            let few = outcomes(&budget, &linear, &directions).unwrap().remove(0);
            near(few.shift, all.shift);
            near(few.curvature, all.curvature);
            for (few, all) in few.slope_deviation.iter().zip(&all.slope_deviation) {
                near(*few, *all);
            }
            let (Terms::Found(few), Terms::Found(all)) = (few.terms, all.terms) else {
                panic!("the chain bends");
            };
            near(few.u, all.u);
        }
    }

    #[test]
    fn where_all_interact_nothing_is_listed() {
        let names: Vec<String> = (0..200)
            .map(|i| format!("[input.x{i}]\nvalue = 1\nu = 0.1\n"))
            .collect();
        let sum: Vec<String> = (0..200).map(|i| format!("x{i}")).collect();
        let text = format!(
            "title = \"T\"\n[measurand.Y]\nmodel = \"exp({})\"\n{}",
            sum.join("+"),
            names.concat()
        );
        let loaded = crate::budget::read(&text, "t", Path::new("")).unwrap();
        assert!(loaded.rows[0].budget.model.neighbours().is_none());
    }
}
