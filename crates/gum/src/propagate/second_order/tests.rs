use nalgebra::DMatrix;

use super::direction::{Moments, NORMAL, moments};
use super::*;
use crate::budget::{Group, Input, Law, Term};
use crate::propagate::covariance::Covariance;
use crate::propagate::result::SecondOrder;
use gumption_core::distribution::{Distribution, StudentT, Uniform};
use gumption_core::quantity::Unit;

const INF: f64 = f64::INFINITY;

fn input(component: usize) -> Input {
    Input {
        name: format!("x{component}").into(),
        description: None,
        group: None,
        unit: Unit::one(),
        estimate: 0.0,
        terms: vec![Term {
            component,
            coefficient: 1.0,
        }],
    }
}

/// One pass through a formula that uses every input once gives what sweeps give.
#[test]
fn a_formula_of_single_uses_by_both_ways() {
    for (model, nonlinear) in [
        ("a * b * c * d * e", true),
        ("a / (b + exp(c * d)) - e", true),
        ("sqrt(a^2 + b^2) * sin(c) + atan2(d, e)", true),
        ("(a - b)^3 * hypot(c, d)^1.5 / e", true),
        ("a + 2 * b - c + d - e", false),
    ] {
        let text = format!(
            "title = \"T\"\n[measurand.Y]\nmodel = \"{model}\"\n[input]\na = {{ value = 1.5, u = 0.1 }}\nb = {{ value = -0.7, half_width = 0.2 }}\nc = {{ value = 0.4, limits = [0, 1], distribution = \"triangular\" }}\nd = {{ value = 1.1, u = 0.05, dof = 5 }}\ne = {{ value = 2, u = 0.3 }}\n"
        );
        let loaded = crate::budget::read(&text, "t", std::path::Path::new("")).unwrap();
        let budget = &loaded.rows[0].budget;
        let linear = super::super::gum::linearise(budget).unwrap();
        let blocks = budget.model.interactions();
        let directions = directions(
            &linear.covariance,
            &budget.inputs,
            &budget.components,
            &blocks,
        );
        let swept = over(budget, &linear, &blocks).remove(0);
        let passed = single_use(budget, &linear, &directions).unwrap().remove(0);
        let near = |a: f64, b: f64| {
            assert!(
                (a - b).abs() <= 1e-12 * (a.abs() + b.abs()),
                "{model}: {a} {b}"
            )
        };
        near(swept.shift, passed.shift);
        near(swept.curvature, passed.curvature);
        for (a, b) in swept.slope_deviation.iter().zip(&passed.slope_deviation) {
            near(*a, *b);
        }
        match (swept.terms, passed.terms) {
            (Terms::Found(a), Terms::Found(b)) => near(a.u, b.u),
            (a, b) => assert_eq!((a, b, nonlinear), (Terms::Linear, Terms::Linear, false)),
        }
    }
}

/// y = g·d + ½ d'Hd + ⅙ Σ t_i d_i³ around the estimates.
struct Cubic {
    g: Vec<f64>,
    h: DMatrix<f64>,
    t: Vec<f64>,
}

impl Cubic {
    fn outcome(
        &self,
        u: &[f64],
        groups: &[Group],
        of: impl Fn(usize) -> Moments,
    ) -> SecondOrderOutcome {
        self.outcome_in(u, groups, of, &vec![Some(0); self.g.len()])
            .0
    }

    /// The outcome, and how many sweeps it took.
    fn outcome_in(
        &self,
        u: &[f64],
        groups: &[Group],
        of: impl Fn(usize) -> Moments,
        blocks: &[Option<usize>],
    ) -> (SecondOrderOutcome, usize) {
        let n = self.g.len();
        let covariance = Covariance::from_parts(u.to_vec(), vec![INF; n], groups);
        let inputs: Vec<Input> = (0..n).map(input).collect();
        let gradient = DMatrix::from_row_slice(1, n, &self.g);
        let linear = Linear::new(vec![0.0; n], vec![0.0], gradient, covariance, &inputs);
        let mut steps = vec![Vec::new(); linear.covariance.coordinates()];
        for (i, input) in linear.inputs.iter().enumerate() {
            for (k, change) in linear.covariance.standard(&input.form) {
                steps[k].push((i, change));
            }
        }
        let directions: Vec<Direction> = steps
            .into_iter()
            .enumerate()
            .map(|(coordinate, steps)| Direction {
                coordinate,
                steps,
                moments: of(coordinate),
            })
            .collect();
        let along = |d: &[f64]| {
            let second = (0..n)
                .map(|i| (0..n).map(|j| self.h[(i, j)] * d[j]).sum())
                .collect();
            let third = (0..n).map(|i| self.t[i] * d[i] * d[i]).collect();
            vec![Along {
                gradient: self.g.clone(),
                second,
                third,
            }]
        };
        let plan = Plan::new(&directions, blocks);
        let outcome = accumulate(&linear, &directions, &plan, along).remove(0);
        (outcome, plan.sweeps.len())
    }

    fn found(&self, u: &[f64], groups: &[Group], of: Moments) -> SecondOrder {
        match self.outcome(u, groups, |_| of).terms {
            Terms::Found(found) => found,
            other => panic!("{other:?}"),
        }
    }
}

fn close(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-12, "{a} is not {b}");
}

fn correlated(r: f64) -> [Group; 1] {
    let correlation = DMatrix::from_row_slice(2, 2, &[1.0, r, r, 1.0]);
    [Group {
        members: vec![0, 1],
        correlation: correlation.into(),
        law: Law::Normal,
        dof: None,
    }]
}

#[test]
fn s1_9_4_comparison_loss() {
    // x1² + x2² at 0 with u = 0.005: twice u² times chi-square of 2 degrees of freedom.
    let model = Cubic {
        g: vec![0.0, 0.0],
        h: DMatrix::identity(2, 2) * 2.0,
        t: vec![0.0, 0.0],
    };
    let found = model.found(&[0.005, 0.005], &[], NORMAL);
    close(found.shift, 5e-5);
    close(found.u, 5e-5);
    assert!(found.matters);
    // At x1 = 0.010, r = 0.9: mean 1.5e-4, variance 4x1²u² + 2(1 + r²)·2·u⁴.
    let model = Cubic {
        g: vec![0.02, 0.0],
        ..model
    };
    let found = model.found(&[0.005, 0.005], &correlated(0.9), NORMAL);
    close(found.shift, 5e-5);
    close(found.u, (1e-8 + 4.0 * 1.81 * 6.25e-10_f64).sqrt());
}

#[test]
fn amendment_2026_bias() {
    // u = 0.1, 0.2, r = 0.5: a² moves by u², ab by the covariance.
    let square = Cubic {
        g: vec![4.0, 0.0],
        h: DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 0.0, 0.0]),
        t: vec![0.0; 2],
    };
    close(
        square.found(&[0.1, 0.2], &correlated(0.5), NORMAL).shift,
        0.01,
    );
    let product = Cubic {
        g: vec![3.0, 2.0],
        h: DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 1.0, 0.0]),
        t: vec![0.0; 2],
    };
    let found = product.found(&[0.1, 0.2], &correlated(0.5), NORMAL);
    close(found.shift, 0.01);
    // Exact: var(ab) = first order + u_a²u_b² (1 + r²).
    let first = 9.0 * 0.01 + 4.0 * 0.04 + 2.0 * 3.0 * 2.0 * 0.01;
    close(found.u, (first + 0.01 * 0.04 * 1.25_f64).sqrt());
}

#[test]
fn gum_h_1_7() {
    // l = ls + d − ls(δα·θ + αs·δθ) with the u of Table H.1: 32 nm becomes 34 nm.
    let (ls, theta, alpha) = (50_000_623.0, -0.1, 1.15e-5);
    let u = [25.0, 9.7, 5.8e-7, 0.41, 1.2e-6, 0.029];
    let mut h = DMatrix::zeros(6, 6);
    let pairs = [(0, 2, -theta), (0, 5, -alpha), (2, 3, -ls), (4, 5, -ls)];
    for (i, j, value) in pairs {
        h[(i, j)] = value;
        h[(j, i)] = value;
    }
    let g = vec![1.0, 1.0, -ls * theta, 0.0, 0.0, -ls * alpha];
    let model = Cubic {
        g,
        h,
        t: vec![0.0; 6],
    };
    let outcome = model.outcome(&u, &[], |_| NORMAL);
    let Terms::Found(found) = outcome.terms else {
        panic!()
    };
    assert!((found.u - 33.9111).abs() < 1e-3, "{}", found.u);
    assert!(found.matters);
    assert_eq!(found.shift, 0.0);
    // The two coefficients that vanish vary by ls·u of their partners.
    close(outcome.slope_deviation[3], ls * 5.8e-7);
    close(outcome.slope_deviation[4], ls * 0.029);
}

#[test]
fn moments_of_other_distributions_are_used() {
    // (x + ½x²) with rectangular x of unit variance: var = 1 + ¼(9/5 − 1).
    let model = Cubic {
        g: vec![1.0],
        h: DMatrix::from_element(1, 1, 1.0),
        t: vec![0.0],
    };
    let rectangular = Moments {
        third: 0.0,
        fourth: 1.8,
    };
    close(model.found(&[1.0], &[], rectangular).u, 1.2_f64.sqrt());
    // Exponential (μ3 = 2, μ4 = 9): 1 + 2 + ¼·8.
    let exponential = Moments {
        third: 2.0,
        fourth: 9.0,
    };
    close(model.found(&[1.0], &[], exponential).u, 5.0_f64.sqrt());
    let uniform = Distribution::Uniform(Uniform {
        lower: -2.0,
        upper: 2.0,
    });
    assert!((moments(&uniform).fourth - 1.8).abs() < 1e-14);
    let t = Distribution::StudentT(StudentT {
        location: 0.0,
        scale: 1.0,
        dof: 5.0,
    });
    assert_eq!(moments(&t), NORMAL);
}

#[test]
fn third_derivatives_can_make_the_series_fail() {
    // x − 0.1·x³: variance 1 − 0.6 to this order; with −x³ it would be negative.
    let cubic = |t: f64| Cubic {
        g: vec![1.0],
        h: DMatrix::zeros(1, 1),
        t: vec![t],
    };
    close(cubic(-0.6).found(&[1.0], &[], NORMAL).u, 0.4_f64.sqrt());
    assert_eq!(
        cubic(-6.0).outcome(&[1.0], &[], |_| NORMAL).terms,
        Terms::Divergent
    );
}

#[test]
fn rotation_of_a_group_changes_nothing() {
    // A group of correlation zero is the same as independent components.
    let h = DMatrix::from_row_slice(2, 2, &[1.0, 0.3, 0.3, -2.0]);
    let model = Cubic {
        g: vec![0.5, 1.5],
        h,
        t: vec![0.2, 0.1],
    };
    let alone = model.found(&[0.3, 0.2], &[], NORMAL);
    let grouped = model.found(&[0.3, 0.2], &correlated(0.0), NORMAL);
    close(alone.u, grouped.u);
    close(alone.shift, grouped.shift);
}

#[test]
fn blocks_that_do_not_interact_share_sweeps() {
    // Blocks {0, 1}, {2}, {3, 4}; the correlation of 1 and 2 lies across two of them.
    let mut h = DMatrix::from_diagonal_element(5, 5, 0.7);
    for (i, j) in [(0, 1), (3, 4)] {
        h[(i, j)] = -0.4;
        h[(j, i)] = -0.4;
    }
    let model = Cubic {
        g: vec![1.0, -0.5, 2.0, 0.3, 0.0],
        h,
        t: vec![0.1, 0.2, -0.3, 0.4, 0.5],
    };
    let u = [0.5, 0.6, 0.7, 0.8, 0.9];
    let groups = [Group {
        members: vec![1, 2],
        ..correlated(0.6)[0].clone()
    }];
    let blocks = [Some(7), Some(7), Some(2), Some(4), Some(4)];
    let (whole, all) = model.outcome_in(&u, &groups, |_| NORMAL, &[Some(0); 5]);
    let (parts, shared) = model.outcome_in(&u, &groups, |_| NORMAL, &blocks);
    assert_eq!((all, shared), (5, 3));
    let (Terms::Found(whole_terms), Terms::Found(terms)) = (&whole.terms, &parts.terms) else {
        panic!()
    };
    close(terms.u, whole_terms.u);
    close(terms.shift, whole_terms.shift);
    for (a, b) in parts.slope_deviation.iter().zip(&whole.slope_deviation) {
        close(*a, *b);
    }
}

#[test]
fn a_linear_model_has_no_second_order() {
    let model = Cubic {
        g: vec![1.0],
        h: DMatrix::zeros(1, 1),
        t: vec![0.0],
    };
    assert_eq!(model.outcome(&[1.0], &[], |_| NORMAL).terms, Terms::Linear);
}

#[test]
fn two_digits_decide_whether_it_matters() {
    assert!(matters(31.7, 33.9, 0.0));
    assert!(!matters(31.7, 32.1, 0.0));
    assert!(matters(31.7, 31.7, 0.6));
    assert!(!matters(31.7, 31.7, 0.4));
    assert!(matters(0.0, 5e-5, 5e-5));
}
