//! Budgets as laboratories have them, right ones.

use rand::RngExt;
use rand::seq::IndexedRandom;

use super::quantity::Known;
use super::words::Said;
use crate::random::{Random, log_between};

/// A budget.
#[derive(Debug, Clone)]
pub(super) struct Budget {
    pub field: &'static Field,
    pub items: Vec<Item>,
    /// Two rows and their coefficient.
    pub correlation: Option<(usize, usize, f64)>,
    pub rule: Rule,
    pub rounding: Rounding,
    pub cmc: Option<f64>,
}

/// One row.
#[derive(Debug, Clone)]
pub(super) struct Item {
    pub blank: &'static Blank,
    pub known: Known,
    /// ∂f/∂x at the estimates.
    pub slope: f64,
    /// A row that is in another already.
    pub contained: bool,
}

/// A field of measurement.
#[derive(Debug)]
pub(super) struct Field {
    pub title: Said,
    pub measurand: &'static str,
    pub unit: &'static str,
    pub model: &'static str,
    pub f: fn(&[f64]) -> f64,
    /// About the combined standard uncertainty.
    pub u: f64,
    pub blanks: &'static [Blank],
}

/// A quantity of a field.
#[derive(Debug)]
pub(super) struct Blank {
    pub symbol: &'static str,
    pub name: Said,
    pub estimate: f64,
    pub unit: &'static str,
    pub kinds: &'static [Kind],
}

/// Kinds of knowledge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Certificate,
    Limits,
    Triangle,
    Cycle,
    Width,
    Step,
    Uneven,
    Readings,
    Alike,
    OfReading,
    OfScale,
}

/// How k is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Rule {
    Two,
    Student(f64),
    Rectangle,
}

/// How U is rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rounding {
    Unsaid,
    Nearest,
    Up,
}

use Kind::*;

const fn blank(
    symbol: &'static str,
    en: &'static str,
    zh: &'static str,
    estimate: f64,
    unit: &'static str,
    kinds: &'static [Kind],
) -> Blank {
    Blank {
        symbol,
        name: Said(en, zh),
        estimate,
        unit,
        kinds,
    }
}

static FIELDS: &[Field] = &[
    Field {
        title: Said(
            "Calibration of a 100 g weight",
            "100 g 砝码折算质量测量结果的不确定度评定",
        ),
        measurand: "m_X",
        unit: "g",
        model: "m_S + dm + dB + dE",
        u: 3e-4,
        f: |x| x[0] + x[1] + x[2] + x[3],
        blanks: &[
            blank(
                "m_S",
                "mass of the standard",
                "标准砝码质量",
                100.0005,
                "g",
                &[Certificate],
            ),
            blank(
                "dm",
                "mass difference",
                "质量差值",
                0.0021,
                "g",
                &[Readings],
            ),
            blank(
                "dB",
                "air buoyancy",
                "空气浮力修正",
                0.0,
                "g",
                &[Limits, Triangle, Cycle, Width],
            ),
            blank(
                "dE",
                "eccentric load",
                "偏载影响",
                0.0,
                "g",
                &[Limits, Width, Uneven, Step],
            ),
        ],
    },
    Field {
        title: Said("Voltmeter at 10 V", "数字电压表 10 V 点示值误差校准"),
        measurand: "E_x",
        unit: "V",
        model: "V_x + dV_r - V_s - dV_d - dV_t",
        u: 2e-3,
        f: |x| x[0] + x[1] - x[2] - x[3] - x[4],
        blanks: &[
            blank(
                "V_x",
                "indication of the instrument",
                "被校表示值",
                10.012,
                "V",
                &[Readings, Alike],
            ),
            blank(
                "dV_r",
                "resolution of the instrument",
                "被校表分辨力",
                0.0,
                "V",
                &[Step],
            ),
            blank(
                "V_s",
                "voltage of the calibrator",
                "标准源输出电压",
                10.0003,
                "V",
                &[Certificate],
            ),
            blank(
                "dV_d",
                "drift of the calibrator",
                "标准源漂移",
                0.0,
                "V",
                &[Limits, OfScale, Width],
            ),
            blank(
                "dV_t",
                "influence of temperature",
                "温度影响",
                0.0,
                "V",
                &[Cycle, Limits, Triangle, Uneven],
            ),
        ],
    },
    Field {
        title: Said("Resistance by comparison", "电阻比较法测量"),
        measurand: "R_x",
        unit: "Ω",
        model: "R_s * r + dR",
        u: 4e-3,
        f: |x| x[0] * x[1] + x[2],
        blanks: &[
            blank(
                "R_s",
                "standard resistor",
                "标准电阻",
                100.0021,
                "Ω",
                &[Certificate, OfReading],
            ),
            blank(
                "r",
                "ratio of the bridge",
                "电桥比值",
                2.50034,
                "1",
                &[Readings, Limits],
            ),
            blank(
                "dR",
                "leads and contacts",
                "引线与接触电阻",
                0.0,
                "Ω",
                &[Limits, Width, Cycle, Step],
            ),
        ],
    },
    Field {
        title: Said("Pressure by a liquid column", "液柱式压力计压力测量"),
        measurand: "p",
        unit: "Pa",
        model: "rho * g * h + dp",
        u: 6.0,
        f: |x| x[0] * x[1] * x[2] + x[3],
        blanks: &[
            blank(
                "rho",
                "density of the liquid",
                "液体密度",
                998.2,
                "kg/m^3",
                &[Limits, Certificate, OfReading],
            ),
            blank(
                "g",
                "local acceleration of free fall",
                "当地重力加速度",
                9.8012,
                "m/s^2",
                &[Certificate, Limits],
            ),
            blank(
                "h",
                "height of the column",
                "液柱高度",
                0.7514,
                "m",
                &[Readings, Step, Uneven],
            ),
            blank(
                "dp",
                "pressure variation",
                "压力波动",
                0.0,
                "Pa",
                &[Cycle, Width, Triangle, Limits],
            ),
        ],
    },
    Field {
        title: Said("Gauge block by comparison", "量块比较测量"),
        measurand: "L",
        unit: "mm",
        model: "L_s + dL + L_s * alpha * dT",
        u: 8e-5,
        f: |x| x[0] + x[1] + x[0] * x[2] * x[3],
        blanks: &[
            blank(
                "L_s",
                "length of the standard",
                "标准量块长度",
                50.00012,
                "mm",
                &[Certificate],
            ),
            blank(
                "dL",
                "length difference",
                "长度差",
                0.00043,
                "mm",
                &[Readings],
            ),
            blank(
                "alpha",
                "coefficient of expansion",
                "线膨胀系数",
                1.15e-5,
                "1/K",
                &[Limits, Triangle],
            ),
            blank(
                "dT",
                "deviation from 20 °C",
                "对 20 °C 的温度偏差",
                0.3,
                "K",
                &[Limits, Cycle, Width],
            ),
        ],
    },
    Field {
        title: Said(
            "Accelerometer at a dividing head",
            "分度头上加速度计标度因数",
        ),
        measurand: "K_1",
        unit: "mV/g",
        model: "E / (a * cos(theta))",
        u: 0.3,
        f: |x| x[0] / (x[1] * libm::cos(x[2].to_radians())),
        blanks: &[
            blank(
                "E",
                "output",
                "输出电压",
                980.4,
                "mV",
                &[Readings, Certificate, OfReading],
            ),
            blank(
                "a",
                "specific force",
                "比力",
                0.99953,
                "g",
                &[Limits, Certificate],
            ),
            blank(
                "theta",
                "angle of the head",
                "分度头角度",
                30.0,
                "°",
                &[Limits, Step, Certificate, Width],
            ),
        ],
    },
    Field {
        title: Said("Thermometer in a bath", "恒温槽中温度计示值误差"),
        measurand: "dt",
        unit: "°C",
        model: "t_x - t_s + dt_g + dt_z",
        u: 0.02,
        f: |x| x[0] - x[1] + x[2] + x[3],
        blanks: &[
            blank(
                "t_x",
                "reading of the thermometer",
                "被校温度计读数",
                50.12,
                "°C",
                &[Readings],
            ),
            blank(
                "t_s",
                "reference thermometer",
                "标准温度计",
                50.035,
                "°C",
                &[Certificate],
            ),
            blank(
                "dt_g",
                "gradients of the bath",
                "恒温槽均匀性",
                0.0,
                "°C",
                &[Limits, Width, Triangle],
            ),
            blank(
                "dt_z",
                "setting of zero, an indication of its own",
                "零位设定，独立示值",
                0.0,
                "°C",
                &[Step],
            ),
        ],
    },
    Field {
        title: Said("Torque of a lever arm", "杠杆力矩"),
        measurand: "M",
        unit: "N·m",
        model: "F * l",
        u: 0.05,
        f: |x| x[0] * x[1],
        blanks: &[
            blank(
                "F",
                "force",
                "力值",
                200.4,
                "N",
                &[Certificate, OfReading, OfScale, Readings],
            ),
            blank(
                "l",
                "length of the arm",
                "力臂长度",
                0.5002,
                "m",
                &[Limits, Certificate, Readings, Step],
            ),
        ],
    },
];

/// A budget of a field.
pub(super) fn draw(random: &mut Random) -> Budget {
    let Some(field) = FIELDS.choose(random) else {
        unreachable!("there are fields")
    };
    let estimates: Vec<f64> = field.blanks.iter().map(|blank| blank.estimate).collect();
    let items = field.blanks.iter().enumerate().map(|(i, blank)| {
        let slope = slope(field.f, &estimates, i);
        let kind = *blank.kinds.choose(random).unwrap_or(&Limits);
        let size = field.u * log_between(random, 0.25, 1.0) / slope.abs();
        Item {
            blank,
            known: known(kind, random, blank).sized(size, blank.estimate),
            slope,
            contained: false,
        }
    });
    let mut budget = Budget {
        field,
        items: items.collect(),
        correlation: None,
        rule: Rule::Two,
        rounding: Rounding::Unsaid,
        cmc: None,
    };
    budget.rule = *[
        Rule::Two,
        Rule::Two,
        Rule::Student(0.95),
        Rule::Student(0.9545),
        Rule::Rectangle,
    ]
    .choose(random)
    .unwrap_or(&Rule::Two);
    budget.rounding = *[Rounding::Unsaid, Rounding::Nearest, Rounding::Up]
        .choose(random)
        .unwrap_or(&Rounding::Unsaid);
    if random.random_bool(0.25) {
        budget.correlation = Some((
            0,
            1 + random.random_range(0..budget.items.len() - 1),
            *[0.3, 0.5, 0.6, -0.4].choose(random).unwrap_or(&0.5),
        ));
    }
    // A resolution below the scatter of the same indication is in it already.
    let scatter = budget
        .items
        .iter()
        .position(|item| matches!(item.known, Known::Scatter(..)));
    if let Some(at) = scatter.filter(|_| random.random_bool(0.4))
        && let Known::Scatter(s, ..) = budget.items[at].known
        && let Some(step) = budget.items.iter().position(|item| {
            matches!(item.known, Known::Step(_))
                && item.blank.unit == budget.items[at].blank.unit
                && !item.blank.name.0.contains("own")
        })
        && step != at
    {
        budget.items[step].known = Known::Step(1.0).sized(1.2 * s / libm::sqrt(12.0), 0.0);
        budget.items[step].contained = true;
        budget.correlation = None;
    }
    budget
}

fn known(kind: Kind, random: &mut Random, blank: &Blank) -> Known {
    let n = *[5, 6, 8, 10, 10, 12, 20].choose(random).unwrap_or(&10);
    let m = *[1, 2, 3, 4, 5, n].choose(random).unwrap_or(&1);
    match kind {
        Certificate => Known::Certificate(
            1.0,
            *[2.0, 2.0, 2.0, 2.13, 2.2, 3.0]
                .choose(random)
                .unwrap_or(&2.0),
        ),
        Limits => Known::Limits(1.0),
        Triangle => Known::Triangle(1.0),
        Cycle => Known::Cycle(1.0),
        Width => Known::Width(1.0),
        Step => Known::Step(1.0),
        Uneven => Known::Uneven(1.0, *[0.2, 0.5, 0.7].choose(random).unwrap_or(&0.5)),
        Alike => Known::Alike(1.0, n),
        OfReading => Known::OfReading(1.0),
        OfScale => Known::OfScale(1.0, 2.0 * blank.estimate.abs().max(10.0)),
        Readings => match random.random_range(0..4) {
            0 => Known::Pooled(
                1.0,
                random.random_range(3..9),
                *[3, 4, 5, 6].choose(random).unwrap_or(&5),
                m.min(4),
            ),
            1 => Known::Spread(1.0, random.random_range(3..9), m.min(3)),
            _ => Known::Scatter(1.0, n, m),
        },
    }
}

/// ∂f/∂x by a central difference with one step of Richardson's extrapolation.
fn slope(f: fn(&[f64]) -> f64, at: &[f64], i: usize) -> f64 {
    let step = 1e-3 * at[i].abs().max(1e-3);
    let difference = |h: f64| {
        let moved = |by: f64| {
            let mut x = at.to_vec();
            x[i] += by;
            f(&x)
        };
        (moved(h) - moved(-h)) / (2.0 * h)
    };
    (4.0 * difference(step / 2.0) - difference(step)) / 3.0
}

impl Budget {
    pub(super) fn estimates(&self) -> Vec<f64> {
        self.items.iter().map(|item| item.blank.estimate).collect()
    }

    pub(super) fn y(&self) -> f64 {
        (self.field.f)(&self.estimates())
    }

    /// Whether contributions need coefficients.
    pub(super) fn is_sum(&self) -> bool {
        self.items
            .iter()
            .all(|item| (item.slope.abs() - 1.0).abs() < 1e-6)
    }
}
