//! Sobol' sensitivity indices: which part of the variance of a measurand comes from which input, linear or not.
//!
//! With V = var(Y), the first-order index of an input is S = var(E(Y|X_i))/V, what X_i does alone; the total
//! index S_T = E(var(Y|all others))/V also counts what it does together with others. Both are expectations over two
//! independent trials A and B, and a third one that takes X_i from B and the rest from A:
//!
//! | index | numerator |
//! |---|---|
//! | first-order | mean of f(B)·(f(A with X_i of B) − f(A)), Saltelli et al., Comput. Phys. Commun. 181 (2010) |
//! | total | half the mean of (f(A with X_i of B) − f(A))², Jansen, Comput. Phys. Commun. 117 (1999) |
//!
//! Inputs that are correlated, or share a component, have no indices of their own: the decomposition of the
//! variance needs independent factors. They count as one factor together.

use gumption_lanes::{Block, LANES};

use super::engine::CHUNK;
use super::joint_draw::JointDraw;
use super::outcome::{FirstOrder, Outcome};
use super::thread_pool::parallel_map;
use crate::budget::Budget;
use crate::propagate::result::{SensitivityIndices, SobolIndex};
use gumption_core::model::BlockRunner;

/// Trials of A and of B, where the model is quick.
const TRIALS: u64 = 1 << 20;

/// Fewest trials.
const FEWEST: u64 = 16 * CHUNK / 4;

/// Values of inputs that are computed in all, about; bounds the time for thousands of inputs.
const EFFORT: u64 = 1 << 34;

/// Pieces whose scatter tells the errors.
const PIECES: u64 = 64;

/// Streams of A and B are those of chunks that no run reaches.
const FIRST_CHUNK: u64 = 1 << 50;

/// The indices of all measurands, on `threads` threads; the result does not depend on their number.
pub(crate) fn indices(
    budget: &Budget,
    seed: u64,
    gum: &[FirstOrder],
    outcome: Option<&Outcome>,
    threads: usize,
) -> SensitivityIndices {
    let factors = factors(budget);
    let draw = JointDraw::new(&budget.inputs, &budget.components, &budget.groups, seed);
    let outputs = budget.model.outputs().len();
    let blocks = blocks_per_piece(budget.inputs.len().max(1) as u64, factors.len() as u64);
    let question = Question {
        budget,
        draw,
        factors: &factors,
        centres: gum.iter().map(|g| g.estimate).collect(),
    };
    let (pieces, _) = parallel_map(
        (0..PIECES).collect(),
        threads,
        || (),
        |(), piece| question.piece(piece, blocks),
        |()| (),
    );
    let measurands = (0..outputs).map(|output| {
        let exists = outcome.is_none_or(|mc| mc.outputs[output].u.is_some());
        let of: Vec<&Sums> = pieces.iter().map(|piece| &piece[output]).collect();
        exists.then(|| {
            (0..factors.len())
                .map(|factor| index(&of, factor))
                .collect()
        })
    });
    SensitivityIndices {
        trials: PIECES * blocks * LANES as u64,
        measurands: measurands.collect(),
        factors: factors.clone(),
    }
}

fn blocks_per_piece(inputs: u64, factors: u64) -> u64 {
    let trials = (EFFORT / (inputs * (factors + 2))).clamp(FEWEST, TRIALS);
    (trials / PIECES / LANES as u64).max(1)
}

/// Inputs that are uncertain, those together that share a component or have correlated ones.
fn factors(budget: &Budget) -> Vec<Vec<usize>> {
    // Components of one group are one node, every other component is its own.
    let mut node: Vec<usize> = (0..budget.components.len()).collect();
    for group in &budget.groups {
        if let Some(first) = group.members.first() {
            group
                .members
                .iter()
                .for_each(|member| node[*member] = *first);
        }
    }
    let mut owner: Vec<Option<usize>> = vec![None; node.len()];
    let mut factors: Vec<Vec<usize>> = Vec::new();
    for (input, of) in budget.inputs.iter().enumerate() {
        let terms = of.terms.iter().filter(|term| term.coefficient != 0.0);
        let nodes: Vec<usize> = terms.map(|term| node[term.component]).collect();
        if nodes.is_empty() {
            continue;
        }
        let mut joined = vec![input];
        let mut met: Vec<usize> = nodes.iter().filter_map(|node| owner[*node]).collect();
        met.sort_unstable();
        met.dedup();
        for factor in &met {
            joined.append(&mut factors[*factor]);
        }
        joined.sort_unstable();
        for place in owner
            .iter_mut()
            .filter(|place| place.is_some_and(|factor| met.contains(&factor)))
        {
            *place = Some(factors.len());
        }
        nodes
            .iter()
            .for_each(|node| owner[*node] = Some(factors.len()));
        factors.push(joined);
    }
    factors.retain(|factor| !factor.is_empty());
    factors.sort_by_key(|factor| factor[0]);
    factors
}

/// What is asked, and how trials are drawn.
struct Question<'b> {
    budget: &'b Budget,
    draw: JointDraw<'b>,
    factors: &'b [Vec<usize>],
    /// Values near the means, per measurand: products of centred values lose no digits.
    centres: Vec<f64>,
}

/// Sums over the trials of one piece that have finite values.
#[derive(Debug, Clone, Default)]
struct Sums {
    count: f64,
    sum: f64,
    squares: f64,
    /// Numerators of each factor, first-order and total.
    factors: Vec<[f64; 2]>,
}

impl Question<'_> {
    /// Per measurand the sums over some blocks.
    fn piece(&self, piece: u64, blocks: u64) -> Vec<Sums> {
        let model = &self.budget.model;
        let mut runner = BlockRunner::new(model);
        let mut scratch = [self.draw.scratch(), self.draw.scratch()];
        for (side, scratch) in (0..).zip(&mut scratch) {
            self.draw.start(scratch, FIRST_CHUNK + 2 * piece + side);
        }
        let fresh = || vec![Block::ZERO; model.inputs()];
        let (mut a, mut b) = (fresh(), fresh());
        let values = || vec![Block::ZERO; model.outputs().len()];
        let (mut of_a, mut of_b, mut of_mixed) = (values(), values(), values());
        let mut sums = vec![
            Sums {
                factors: vec![[0.0; 2]; self.factors.len()],
                ..Sums::default()
            };
            of_a.len()
        ];
        for _ in 0..blocks {
            self.draw.next(&mut scratch[0], &mut a);
            self.draw.next(&mut scratch[1], &mut b);
            runner.run(&a, &mut of_a);
            runner.run(&b, &mut of_b);
            for (output, sums) in sums.iter_mut().enumerate() {
                sums.values(&of_a[output], &of_b[output], self.centre(output));
            }
            for (place, factor) in self.factors.iter().enumerate() {
                let exchange = |a: &mut [Block], b: &mut [Block]| {
                    factor
                        .iter()
                        .for_each(|input| std::mem::swap(&mut a[*input], &mut b[*input]));
                };
                exchange(&mut a, &mut b);
                runner.run(&a, &mut of_mixed);
                exchange(&mut a, &mut b);
                for (output, sums) in sums.iter_mut().enumerate() {
                    let of = [&of_a[output], &of_b[output], &of_mixed[output]];
                    sums.factors[place] = numerators(of, self.centre(output), sums.factors[place]);
                }
            }
        }
        sums
    }

    fn centre(&self, output: usize) -> f64 {
        self.centres
            .get(output)
            .copied()
            .filter(|centre| centre.is_finite())
            .unwrap_or(0.0)
    }
}

impl Sums {
    fn values(&mut self, a: &Block, b: &Block, centre: f64) {
        for value in
            a.0.iter()
                .chain(&b.0)
                .map(|value| value - centre)
                .filter(|value| value.is_finite())
        {
            self.count += 1.0;
            self.sum += value;
            self.squares += value * value;
        }
    }
}

/// Adds the trials of a block whose three values are finite.
fn numerators(
    [a, b, mixed]: [&Block; 3],
    centre: f64,
    [mut first, mut total]: [f64; 2],
) -> [f64; 2] {
    for lane in 0..LANES {
        let change = mixed.0[lane] - a.0[lane];
        let term = (b.0[lane] - centre) * change;
        if term.is_finite() {
            first += term;
            total += 0.5 * change * change;
        }
    }
    [first, total]
}

/// Ratios of all sums, and their errors from the scatter of the pieces about them.
fn index(pieces: &[&Sums], factor: usize) -> SobolIndex {
    let count: f64 = pieces.iter().map(|sums| sums.count).sum();
    let mean = pieces.iter().map(|sums| sums.sum).sum::<f64>() / count;
    // Each trial of A has one of B: numerators have half as many terms as there are values.
    let variance =
        |sums: &Sums| 0.5 * (sums.squares - 2.0 * mean * sums.sum + mean * mean * sums.count);
    let all: f64 = pieces.iter().map(|sums| variance(sums)).sum();
    let n = pieces.len() as f64;
    let ratio = |which: usize| {
        let numerator = |sums: &Sums| sums.factors[factor][which];
        let value = pieces.iter().map(|sums| numerator(sums)).sum::<f64>() / all;
        let residual = |sums: &Sums| numerator(sums) - value * variance(sums);
        let squares: f64 = pieces
            .iter()
            .map(|sums| residual(sums) * residual(sums))
            .sum();
        (value, (squares * n / (n - 1.0)).sqrt() / all)
    };
    let ((first, first_error), (total, total_error)) = (ratio(0), ratio(1));
    SobolIndex {
        first,
        first_error,
        total,
        total_error,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::budget;
    use crate::propagate::evaluate;
    use crate::propagate::options::{MonteCarloChoice, Options};

    fn of(text: &str, threads: usize) -> SensitivityIndices {
        let loaded = budget::read(text, "budget", Path::new(""))
            .unwrap_or_else(|r| panic!("{}", r.render(false)));
        let budget = &loaded.rows[0].budget;
        let options = Options {
            monte_carlo: MonteCarloChoice::Off,
            threads,
            ..Options::default()
        };
        let gum = &evaluate(budget, &options).unwrap().results;
        let gum: Vec<FirstOrder> = gum
            .iter()
            .map(|r| FirstOrder {
                estimate: r.gum.estimate,
                u: r.gum.u,
            })
            .collect();
        indices(budget, 1, &gum, None, threads)
    }

    fn expect(found: &[SobolIndex], exact: &[[f64; 2]]) {
        for (found, [first, total]) in found.iter().zip(exact) {
            assert!(
                found.first_error < 0.01 && found.total_error < 0.01,
                "{found:?}"
            );
            assert!(
                (found.first - first).abs() < 4.0 * found.first_error + 1e-6,
                "{found:?} {first}"
            );
            assert!(
                (found.total - total).abs() < 4.0 * found.total_error + 1e-6,
                "{found:?} {total}"
            );
        }
        assert_eq!(found.len(), exact.len());
    }

    /// Ishigami and Homma (1990): sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ on (−π, π)³.
    #[test]
    fn the_function_of_ishigami() {
        let x = "{ value = 0, half_width = 3.141592653589793 }";
        let text = format!(
            "title = \"T\"\n[measurand.Y]\nmodel = \"sin(x1) + 7 * sin(x2)^2 + 0.1 * x3^4 * sin(x1)\"\n[input]\nx1 = {x}\nx2 = {x}\nx3 = {x}\n"
        );
        let pi = std::f64::consts::PI;
        let (a, b) = (7.0_f64, 0.1_f64);
        let v1 = 0.5 * (1.0 + b * pi.powi(4) / 5.0).powi(2);
        let v2 = a * a / 8.0;
        let v13 = b * b * pi.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
        let v = v1 + v2 + v13;
        let found = of(&text, 2);
        expect(
            found.measurands[0].as_ref().unwrap(),
            &[[v1 / v, (v1 + v13) / v], [v2 / v, v2 / v], [0.0, v13 / v]],
        );
        assert_eq!(found, of(&text, 1));
    }

    /// Saltelli and Sobol' (1995): Π (|4x_i − 2| + a_i)/(1 + a_i).
    #[test]
    fn the_g_function() {
        let text = "title = \"T\"\n[measurand.Y]\nmodel = \"abs(4*x1 - 2) * (abs(4*x2 - 2) + 1)/2 * (abs(4*x3 - 2) + 9)/10\"\n[input]\nx1 = { value = 0.4, limits = [0, 0.8], distribution = \"uniform\" }\n".replace(
            "x1 = { value = 0.4, limits = [0, 0.8], distribution = \"uniform\" }",
            "x1 = { limits = [0, 1] }\nx2 = { limits = [0, 1] }\nx3 = { limits = [0, 1] }",
        );
        let of_one = |a: f64| 1.0 / (3.0 * (1.0 + a) * (1.0 + a));
        let parts = [of_one(0.0), of_one(1.0), of_one(9.0)];
        let v = parts.iter().map(|v| 1.0 + v).product::<f64>() - 1.0;
        let exact = [0, 1, 2].map(|i| {
            let others: f64 = (0..3).filter(|j| *j != i).map(|j| 1.0 + parts[j]).product();
            [parts[i] / v, parts[i] * others / v]
        });
        expect(of(&text, 2).measurands[0].as_ref().unwrap(), &exact);
    }

    /// In a linear model both indices are the shares of the variance; correlated inputs and those with a
    /// common source are one factor.
    #[test]
    fn a_linear_model_with_correlated_inputs() {
        let text = "title = \"T\"\n[measurand.Y]\nmodel = \"a + 2*b - c + d + e\"\n[input]\na = { value = 1e6, u = 1 }\nb = { value = 0, u = 1 }\nc = { value = 0, u = 2 }\nd = { value = 0, source = \"S\" }\ne = { value = 0, source = \"S\" }\n[source.S]\nu = 1\n[[correlation]]\nbetween = [\"b\", \"c\"]\nr = 0.5\n";
        let found = of(text, 2);
        assert_eq!(found.factors, [vec![0], vec![1, 2], vec![3, 4]]);
        // 1; 4 + 4 − 4; 4.
        let share = [1.0 / 9.0, 4.0 / 9.0, 4.0 / 9.0];
        expect(
            found.measurands[0].as_ref().unwrap(),
            &share.map(|s| [s, s]),
        );
    }

    #[test]
    fn effort_is_bounded() {
        assert_eq!(blocks_per_piece(9, 9) * PIECES * LANES as u64, TRIALS);
        assert!(blocks_per_piece(1000, 1000) * PIECES * LANES as u64 >= FEWEST / 2);
    }
}
