//! Random linear models with random correlation: both methods must give c·V·cᵀ.

use proptest::prelude::*;

use crate::common::evaluation::{evaluate, only, sampled};

const TRIALS: f64 = 20_000.0;

#[derive(Debug, Clone)]
struct Linear {
    /// Sensitivity coefficients, values and standard uncertainties.
    inputs: Vec<(f64, f64, f64)>,
    /// Loadings whose products are the correlation matrix.
    loadings: Vec<[f64; 4]>,
    rectangular: bool,
}

fn linear() -> impl Strategy<Value = Linear> {
    let input = (-3.0..3.0f64, -10.0..10.0f64, 0.01..2.0f64);
    let loading = prop::array::uniform4(-1.0..1.0f64);
    (2..6usize, any::<bool>()).prop_flat_map(move |(n, rectangular)| {
        (
            prop::collection::vec(input.clone(), n),
            prop::collection::vec(loading.clone(), n),
        )
            .prop_map(move |(inputs, loadings)| Linear {
                inputs,
                loadings,
                rectangular,
            })
    })
}

impl Linear {
    /// Half of independence keeps every correlation matrix one that rectangles can have too.
    fn correlation(&self, i: usize, j: usize) -> f64 {
        let dot =
            |a: &[f64; 4], b: &[f64; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() + 0.01;
        let (a, b) = (&self.loadings[i], &self.loadings[j]);
        if i == j {
            1.0
        } else {
            0.5 * dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
        }
    }

    fn text(&self) -> String {
        let n = self.inputs.len();
        let names: Vec<String> = (0..n).map(|k| format!("'x{k}'")).collect();
        let terms: Vec<String> = (0..n)
            .map(|k| format!("({:?}) * x{k}", self.inputs[k].0))
            .collect();
        let inputs: String = self
            .inputs
            .iter()
            .enumerate()
            .map(|(k, (_, value, u))| {
                let shape = if self.rectangular && k % 2 == 0 {
                    "distribution = 'uniform'"
                } else {
                    ""
                };
                format!("[input.x{k}]\nvalue = {value:?}\nu = {u:?}\n{shape}\n")
            })
            .collect();
        let rows: Vec<Vec<f64>> = (0..n)
            .map(|i| (0..n).map(|j| self.correlation(i, j)).collect())
            .collect();
        format!(
            "[monte_carlo]\ntrials = {TRIALS}\n[measurand.y]\nmodel = '{}'\n{inputs}[[joint]]\ninputs = [{}]\ncorrelation = {rows:?}\n",
            terms.join(" + "),
            names.join(", "),
        )
    }

    /// Estimate and u by the definition.
    fn result(&self) -> (f64, f64) {
        let estimate = self.inputs.iter().map(|(c, value, _)| c * value).sum();
        let mut variance = 0.0;
        for (i, (ci, _, ui)) in self.inputs.iter().enumerate() {
            for (j, (cj, _, uj)) in self.inputs.iter().enumerate() {
                variance += ci * cj * ui * uj * self.correlation(i, j);
            }
        }
        (estimate, variance.sqrt())
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn both_methods_agree_with_the_definition(model in linear()) {
        let (estimate, u) = model.result();
        prop_assume!(u > 1e-3);
        let found = evaluate(&model.text());
        let gum = &only(&found).gum;
        prop_assert!((gum.estimate - estimate).abs() < 1e-9);
        prop_assert!((gum.u / u - 1.0).abs() < 1e-9);
        let shares: f64 = gum.inputs.iter().map(|line| line.share).sum();
        prop_assert!((shares - 1.0).abs() < 1e-9);
        // Six standard errors.
        let mc = sampled(&found);
        let mean = mc.estimate.expect("a linear model has moments");
        prop_assert!((mean - estimate).abs() < 6.0 * u / TRIALS.sqrt());
        let scatter = mc.u.expect("a linear model has moments");
        prop_assert!((scatter / u - 1.0).abs() < 6.0 / (2.0 * TRIALS).sqrt());
    }
}
