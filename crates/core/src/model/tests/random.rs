//! Random expressions: derivatives against num-dual, printing and reading again, no panic on any text.

use super::*;
use num_dual::{Dual3, DualNum};
use proptest::prelude::*;

type Third = Dual3<f64>;

/// An expression with its third-order dual value at the test point.
#[derive(Debug, Clone)]
enum Tree {
    X,
    Y,
    Number(f64),
    Unary(usize, Box<Tree>),
    Binary(usize, Box<Tree>, Box<Tree>),
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        Just(Tree::X),
        Just(Tree::Y),
        (0.25..3.0f64).prop_map(Tree::Number)
    ];
    leaf.prop_recursive(5, 24, 2, |inner| {
        prop_oneof![
            (0..8usize, inner.clone()).prop_map(|(k, a)| Tree::Unary(k, Box::new(a))),
            (0..6usize, inner.clone(), inner).prop_map(|(k, a, b)| Tree::Binary(
                k,
                Box::new(a),
                Box::new(b)
            )),
        ]
    })
}

impl Tree {
    fn text(&self) -> String {
        match self {
            Tree::X => "x".into(),
            Tree::Y => "y".into(),
            Tree::Number(c) => format!("{c}"),
            Tree::Unary(k, a) => {
                let name = [
                    "sin",
                    "cos",
                    "tanh",
                    "atan",
                    "exp",
                    "-",
                    "sqrt(1 + sq",
                    "ln(2 + sq",
                ][*k];
                match k {
                    5 => format!("(-{})", a.text()),
                    6 => format!("sqrt(1 + ({})^2)", a.text()),
                    7 => format!("ln(2 + ({})^2)", a.text()),
                    4 => format!("exp(sin({}))", a.text()),
                    _ => format!("{name}({})", a.text()),
                }
            }
            Tree::Binary(k, a, b) => {
                let (a, b) = (a.text(), b.text());
                match k {
                    0 => format!("({a} + {b})"),
                    1 => format!("({a} - {b})"),
                    2 => format!("{a} * {b}"),
                    3 => format!("({a}) / (2 + sin({b}))"),
                    4 => format!("(2 + cos({a}))^({b})"),
                    _ => format!("hypot(1 + ({a})^2, {b})"),
                }
            }
        }
    }

    fn value(&self, x: Third, y: Third) -> Third {
        match self {
            Tree::X => x,
            Tree::Y => y,
            Tree::Number(c) => Dual3::from(*c),
            Tree::Unary(k, a) => {
                let a = a.value(x, y);
                match k {
                    0 => a.sin(),
                    1 => a.cos(),
                    2 => tanh(a),
                    3 => a.atan(),
                    4 => a.sin().exp(),
                    5 => -a,
                    6 => (a * a + 1.0).sqrt(),
                    _ => (a * a + 2.0).ln(),
                }
            }
            Tree::Binary(k, a, b) => {
                let (a, b) = (a.value(x, y), b.value(x, y));
                match k {
                    0 => a + b,
                    1 => a - b,
                    2 => a * b,
                    3 => a / (b.sin() + 2.0),
                    4 => ((a.cos() + 2.0).ln() * b).exp(),
                    _ => {
                        let c = a * a + 1.0;
                        (c * c + b * b).sqrt()
                    }
                }
            }
        }
    }
}

/// Where it is 1 its slopes are nothing; of sinh over cosh they would be what rounding leaves of large numbers.
fn tanh(a: Third) -> Third {
    let fall = (a * -2.0 * a.re.signum()).exp();
    (-fall + 1.0) / (fall + 1.0) * a.re.signum()
}

proptest! {
    #[test]
    fn derivatives_equal_those_of_dual_numbers(tree in tree(), x in 0.2..1.5f64, y in 0.2..1.5f64, d in -1.0..1.0f64) {
        let text = tree.text();
        let model = model("x y", &text, "");
        let truth = tree.value(Dual3::new(x, 1.0, 0.0, 0.0), Dual3::new(y, d, 0.0, 0.0));
        let along = &model.along(&[x, y], &[1.0, d])[0];
        let dot = |v: &[f64]| v[0] + v[1] * d;
        let found = [model.values(&[x, y])[0], dot(&along.gradient), dot(&along.second), dot(&along.third)];
        let wanted = [truth.re, truth.v1, truth.v2, truth.v3];
        let size = wanted.iter().fold(1.0f64, |m, v| m.max(v.abs()));
        prop_assume!(size < 1e8);
        for (f, w) in found.iter().zip(wanted) {
            prop_assert!((f - w).abs() <= 1e-9 * size, "{} : {:?} instead of {:?}", text, found, wanted);
        }
    }

    #[test]
    fn printed_equations_mean_the_same(tree in tree(), x in 0.2..1.5f64, y in 0.2..1.5f64) {
        let first = model("x y", &tree.text(), "");
        let printed = first.outputs()[0].equation.clone();
        let second = model("x y", &printed, "");
        prop_assert_eq!(first.values(&[x, y]), second.values(&[x, y]));
        prop_assert_eq!(&second.outputs()[0].equation, &printed);
    }

    #[test]
    fn no_text_is_too_strange(text in "[ab2().,;\\[\\]^*/=<>' \n#if°µ²⁻-]{0,40}") {
        if let Err(faults) = try_model("a b:mm", &text, "") {
            for fault in faults {
                prop_assert!(text.get(fault.fault.span.clone()).is_some(), "{:?}", fault);
            }
        }
    }
}
