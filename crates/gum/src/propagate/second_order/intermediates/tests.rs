//! Against one sweep for every direction.

use std::path::Path;

use super::super::{Terms, among, over};
use super::*;
use crate::propagate::gum::linearise;

const COUNT: usize = 21;

fn budget(text: &str) -> Budget {
    let loaded = crate::budget::read(text, "t", Path::new(""));
    let mut loaded = loaded.unwrap_or_else(|rejection| panic!("{text}\n{rejection}"));
    loaded.rows.remove(0).budget
}

/// A formula of many inputs, V, of which every third has another distribution, and of `a`.
fn independent(model: &str) -> Budget {
    let names: Vec<String> = (0..COUNT).map(|i| format!("x{i}")).collect();
    let model = model.replace('V', &format!("[{}]", names.join(", ")));
    let mut text = format!(
        "title = \"T\"\n[measurand.Y]\nmodel = \"{model}\"\n[input.a]\nvalue = 1.5\nu = 0.2\n"
    );
    for (i, name) in names.iter().enumerate() {
        let u = ["u = 0.2", "half_width = 0.4", "plus = 0.3\nminus = 0.1"][i % 3];
        let value = 1.0 + 0.1 * i as f64;
        text += &format!("[input.{name}]\nvalue = {value}\n{u}\n");
    }
    budget(&text)
}

/// The same with inputs that are correlated, and have a component of their own besides.
fn correlated(model: &str) -> Budget {
    let values: Vec<String> = (0..COUNT)
        .map(|i| format!("{}", 1.0 + 0.1 * i as f64))
        .collect();
    let row = |i: usize| {
        let row: Vec<String> = (0..COUNT)
            .map(|j| format!("{}", 0.5_f64.powi(i.abs_diff(j) as i32)))
            .collect();
        format!("[{}]", row.join(", "))
    };
    let rows: Vec<String> = (0..COUNT).map(row).collect();
    budget(&format!(
        "title = \"T\"\n[measurand.Y]\nmodel = \"{}\"\n[input.a]\nvalue = 1.5\nhalf_width = 0.2\n[input.x]\nvalues = [{}]\nu = 0.2\n[[joint]]\ninputs = [\"x\"]\ncorrelation = [{}]\n",
        model.replace('V', "x"),
        values.join(", "),
        rows.join(", ")
    ))
}

fn near(found: f64, expected: f64, size: f64, what: &str) {
    assert!(
        (found - expected).abs() <= 1e-11 * size.abs(),
        "{what}: {found:e}, not {expected:e}"
    );
}

fn agrees(budget: &Budget, model: &str) {
    let linear = linearise(budget).unwrap();
    let all = over(budget, &linear, &budget.model.interactions()).remove(0);
    let found = outcomes(budget, &linear, &vec![true; linear.x.len()])
        .unwrap_or_else(|| panic!("{model}: many intermediates"))
        .remove(0);
    let u = linear.measurands[0].u;
    near(found.shift, all.shift, u, model);
    near(found.curvature, all.curvature, all.curvature, model);
    for (found, all) in found.slope_deviation.iter().zip(&all.slope_deviation) {
        near(*found, *all, u, model);
    }
    match (found.terms, all.terms) {
        (Terms::Found(found), Terms::Found(all)) => near(found.u, all.u, all.u, model),
        (found, all) => assert_eq!(found, all, "{model}"),
    }
}

const MODELS: [&str; 12] = [
    "a * sd(V)",
    "a * norm(V)",
    "a * mean(V)^2",
    "exp(mean(V) / 3) - a",
    "sum(V * V^3) / sum(V^3) - a",
    "sd(V) / mean(V) - a",
    "a * sum(V^2) + sqrt(sum(V))",
    "a * sum(V^2)",
    "sum(sin(V * a) + V)",
    "sum((V - mean(V))^3) / sd(V)^3 - a",
    "norm(V - a) * norm(V + mean(V))",
    "ln(sum(exp(V))) + sum(V) - a",
];

#[test]
fn sums_over_pairs_are_found_without_pairs() {
    for model in MODELS {
        agrees(&independent(model), model);
    }
}

#[test]
fn correlated_inputs_too() {
    for model in MODELS {
        agrees(&correlated(model), model);
    }
}

/// What part of the inputs adds follows from the second derivatives of all.
#[test]
fn part_of_the_inputs_by_the_derivatives_of_all() {
    for model in MODELS {
        for budget in [independent(model), correlated(model)] {
            let linear = linearise(&budget).unwrap();
            let changing: Vec<bool> = (0..linear.x.len()).map(|input| input % 4 != 1).collect();
            let all = outcomes(&budget, &linear, &vec![true; linear.x.len()])
                .unwrap()
                .remove(0);
            assert!(all.hessian.is_some(), "{model}");
            let (shift, curvature) = among(&budget, &linear, 0, &all, &changing);
            let blocks = budget.model.interactions().into_iter().zip(&changing);
            let blocks: Vec<_> = blocks
                .map(|(block, changes)| block.filter(|_| *changes))
                .collect();
            let expected = over(&budget, &linear, &blocks).remove(0);
            let u = linear.measurands[0].u;
            near(shift, expected.shift, u, model);
            near(curvature, expected.curvature, expected.curvature, model);
        }
    }
}

/// All at zero, where second derivatives may vanish and third ones not.
#[test]
fn third_derivatives_alone_are_seen() {
    for model in [
        "sin(sum(V)) + a",
        "mean(V) + mean(V)^3 + a",
        "sum(sinh(V)) * a",
    ] {
        let values = vec!["0"; COUNT].join(", ");
        let text = format!(
            "title = \"T\"\n[measurand.Y]\nmodel = \"{}\"\n[input.a]\nvalue = 1\nu = 0.1\n[input.x]\nvalues = [{values}]\nhalf_width = 0.1\n",
            model.replace('V', "x")
        );
        agrees(&budget(&text), model);
    }
}

/// A intermediate of inputs that rest has no derivatives that matter, also where they do not exist.
#[test]
fn inputs_that_rest_move_nothing() {
    let zeros = vec!["0"; COUNT].join(", ");
    let values: Vec<String> = (0..COUNT)
        .map(|i| format!("{}", 1.0 + 0.1 * i as f64))
        .collect();
    let budget = budget(&format!(
        "title = \"T\"\n[measurand.Y]\nmodel = \"sd(x) + norm(z) * mean(x)^2\"\n[input.x]\nvalues = [{}]\nhalf_width = 0.2\n[input.z]\nvalues = [{zeros}]\nu = 0.1\n",
        values.join(", ")
    ));
    let linear = linearise(&budget).unwrap();
    let changing: Vec<bool> = (0..2 * COUNT).map(|input| input < COUNT).collect();
    let blocks = budget.model.interactions().into_iter().zip(&changing);
    let blocks: Vec<_> = blocks
        .map(|(block, changes)| block.filter(|_| *changes))
        .collect();
    let all = over(&budget, &linear, &blocks).remove(0);
    let found = outcomes(&budget, &linear, &changing).unwrap().remove(0);
    near(found.shift, all.shift, all.shift, "shift");
    near(found.curvature, all.curvature, all.curvature, "curvature");
}

#[test]
fn what_has_many_intermediates_is_left_alone() {
    let factors: Vec<String> = (0..300)
        .map(|i| format!("(1 + x[{}] * x[{}])", i + 1, (7 * i) % 300 + 1))
        .collect();
    let values = vec!["1"; 300].join(", ");
    let budget = budget(&format!(
        "title = \"T\"\n[measurand.Y]\nmodel = \"{}\"\n[input.x]\nvalues = [{values}]\nu = 0.1\n",
        factors.join(" * ")
    ));
    let linear = linearise(&budget).unwrap();
    assert!(outcomes(&budget, &linear, &[true; 300]).is_none());
}
