//! Responses written as formulas, differentiated automatically.

use gumption::least_squares::Gradient;
use nalgebra::Const;
use num_dual::{DualNum, DualSVec64};

/// Parameters first, then predictors.
pub type Number = DualSVec64<16>;

/// A response written as a formula, differentiated automatically.
pub struct Formula {
    pub parameters: usize,
    pub linear: bool,
    pub f: fn(&[Number], &[Number]) -> Number,
}

impl Formula {
    /// With its slopes.
    pub fn response(&self) -> Gradient<impl Fn(&[f64], &mut [f64]) -> f64 + use<>> {
        let (parameters, f) = (self.parameters, self.f);
        Gradient {
            parameters,
            linear: self.linear,
            function: move |point: &[f64], slopes: &mut [f64]| {
                let seeded = point.iter().enumerate();
                let point: Vec<Number> = seeded
                    .map(|(place, value)| Number::from_re(*value).derivative(place))
                    .collect();
                let value = f(&point[..parameters], &point[parameters..]);
                let gradient = value.eps.unwrap_generic(Const::<16>, Const::<1>);
                slopes.copy_from_slice(&gradient.as_slice()[..slopes.len()]);
                value.re
            },
        }
    }
}

/// A formula that is not linear in its parameters.
pub const fn formula(parameters: usize, f: fn(&[Number], &[Number]) -> Number) -> Formula {
    Formula {
        parameters,
        linear: false,
        f,
    }
}

/// A constant.
pub fn c(value: f64) -> Number {
    Number::from_re(value)
}

/// Peaks on an exponential baseline.
pub fn gauss(b: &[Number], x: &[Number]) -> Number {
    let peak = |height: Number, centre: Number, width: Number| {
        height * (-(((x[0] - centre) / width).powi(2))).exp()
    };
    b[0] * (-b[1] * x[0]).exp() + peak(b[2], b[3], b[4]) + peak(b[5], b[6], b[7])
}

pub fn lanczos(b: &[Number], x: &[Number]) -> Number {
    b[0] * (-b[1] * x[0]).exp() + b[2] * (-b[3] * x[0]).exp() + b[4] * (-b[5] * x[0]).exp()
}

fn enso(b: &[Number], x: &[Number]) -> Number {
    let turn = x[0] * (2.0 * std::f64::consts::PI);
    b[0] + b[1] * (turn / 12.0).cos()
        + b[2] * (turn / 12.0).sin()
        + b[4] * (turn / b[3]).cos()
        + b[5] * (turn / b[3]).sin()
        + b[7] * (turn / b[6]).cos()
        + b[8] * (turn / b[6]).sin()
}

pub fn rational_cubic(b: &[Number], x: &[Number]) -> Number {
    let x = x[0];
    (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (x * (b[4] + x * (b[5] + x * b[6])) + 1.0)
}

/// Of the data sets that are read from files.
pub const FORMULAS: &[(&str, Formula)] = &[
    (
        "chwirut1",
        formula(3, |b, x| (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])),
    ),
    (
        "chwirut2",
        formula(3, |b, x| (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])),
    ),
    (
        "danwood",
        formula(2, |b, x| b[0] * (b[1] * x[0].ln()).exp()),
    ),
    ("enso", formula(9, enso)),
    ("gauss1", formula(8, gauss)),
    (
        "kirby2",
        formula(5, |b, x| {
            let x = x[0];
            (b[0] + x * (b[1] + x * b[2])) / (x * (b[3] + x * b[4]) + 1.0)
        }),
    ),
    ("lanczos3", formula(6, lanczos)),
    (
        "mgh09",
        formula(4, |b, x| {
            let x = x[0];
            b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3])
        }),
    ),
    (
        "mgh17",
        formula(5, |b, x| {
            b[0] + b[1] * (-x[0] * b[3]).exp() + b[2] * (-x[0] * b[4]).exp()
        }),
    ),
    (
        "misra1a",
        formula(2, |b, x| b[0] * (c(1.0) - (-b[1] * x[0]).exp())),
    ),
    (
        "misra1b",
        formula(2, |b, x| {
            b[0] * (c(1.0) - (b[1] * x[0] / 2.0 + 1.0).powi(-2))
        }),
    ),
    (
        "rat42",
        formula(3, |b, x| b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0)),
    ),
    (
        "roszman1",
        formula(4, |b, x| {
            b[0] - b[1] * x[0] - (b[2] / (x[0] - b[3])).atan() / std::f64::consts::PI
        }),
    ),
];
