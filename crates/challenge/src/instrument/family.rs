//! What can be concealed in an instrument: families of effects, each in several forms. Forms are wider than any catalogue's:
//! other saturations, plays and relays, relaxations with one, two or many time constants, several laws of ageing.

use std::f64::consts::TAU;

use rand::RngExt;

use super::history::{bouc_wen, lacking, lagged, play, plays, relays};
use crate::random::{Stream, normal, sign, source};

/// What an effect follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Drive {
    /// A stimulus that starts at zero or above.
    OneSided,
    /// A stimulus that goes to both sides of zero.
    TwoSided,
    /// A stimulus of either kind.
    Stimulus,
    /// A stimulus that goes on in its direction.
    Path,
    /// A stimulus that moves while it is read.
    Moving,
    /// The first condition, a temperature.
    Temperature,
    /// Any other condition.
    Condition,
    Time,
    /// Time, in recordings of two days and more.
    Days,
    Run,
    /// The reading itself, where it is that of a converter with bits.
    Code,
    /// The other axes of a triad.
    Axes,
}

/// Where an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// Adds to the reading, as a part of its full scale.
    Offset,
    /// Multiplies what the reading has above its zero.
    Scale,
    /// Changes what is applied, as a part of its range.
    Input,
    /// Adds what another axis reads.
    Axis,
    /// Rounds the reading to a step that is a part of full scale.
    Rounding,
    /// Holds the reading below full scale, less a part of it.
    Clip,
}

/// What a form is made of, on the fine grid of a campaign.
pub(super) struct View<'a> {
    pub hours: &'a [f64],
    /// Part of the campaign that has passed.
    pub share: &'a [f64],
    /// What is followed: a stimulus over its largest value, a condition from its middle over its usual reach, the code.
    pub drive: &'a [f64],
    /// What the reading has above its zero, over its largest value.
    pub signal: &'a [f64],
    pub run: &'a [usize],
    /// Two numbers from 0 to 1 that shape the form.
    pub a: f64,
    pub b: f64,
    /// For forms that draw.
    pub seed: u64,
}

type Form = fn(&View<'_>) -> Vec<f64>;

/// A family of effects.
pub(super) struct Family {
    pub name: &'static str,
    pub drive: Drive,
    pub place: Place,
    /// Identifiers of the catalogue that are right, and whether they have to follow the column of the drive; none =
    /// no catalogue has a name for it.
    pub names: &'static [(&'static str, bool)],
    pub forms: &'static [Form],
}

impl Family {
    /// Whether its column is kept back.
    pub(super) fn is_hidden(&self) -> bool {
        self.name == "hidden-temperature"
    }

    /// Whether it happens once, so that a fresh recording need not have it.
    pub(super) fn happens_once(&self) -> bool {
        let accidents = ["step", "step-scale", "outlier"];
        self.drive == Drive::Time && self.names.iter().any(|(id, _)| accidents.contains(id))
    }

    pub(super) fn is_nameable(&self) -> bool {
        // A name for what was not recorded is right where one is given, but none can be expected.
        !self.names.is_empty() && !self.is_hidden()
    }
}

/// Maps the drive.
macro_rules! of_drive {
    ($($f:expr),* $(,)?) => { &[$(|v: &View<'_>| { let f: fn(f64, f64, f64) -> f64 = $f; v.drive.iter().map(|x| f(*x, v.a, v.b)).collect() }),*] };
}

/// Maps the part of the campaign that has passed.
macro_rules! of_time {
    ($($f:expr),* $(,)?) => { &[$(|v: &View<'_>| { let f: fn(f64, f64, f64) -> f64 = $f; v.share.iter().map(|x| f(*x, v.a, v.b)).collect() }),*] };
}

const ANY: bool = false;
const OWN: bool = true;

fn power(x: f64, exponent: f64) -> f64 {
    x.signum() * libm::pow(x.abs(), exponent)
}

/// The largest exponent before e to it is no number of use.
fn soft_plus(x: f64) -> f64 {
    if x > 40.0 {
        x
    } else {
        libm::log1p(libm::exp(x))
    }
}

const AGEING: &[Form] = of_time![
    |s, _, _| s,
    |s, _, _| libm::sqrt(s),
    |s, a, _| libm::log1p(s / (0.01 + 0.3 * a)),
    |s, a, _| power(s, 0.6 + a),
    |s, a, _| -libm::expm1(-s * (0.4 + a)),
];

const STEPS: &[Form] = of_time![
    |s, a, _| f64::from(s > 0.12 + 0.76 * a),
    |s, a, b| 1.0 / (1.0 + libm::exp(-(s - 0.12 - 0.76 * a) / (0.001 + 0.01 * b))),
    |s, a, b| {
        if s > 0.12 + 0.76 * a {
            -libm::expm1(-(s - 0.12 - 0.76 * a) / (0.002 + 0.02 * b))
        } else {
            0.0
        }
    },
];

const LEVELS: &[Form] = &[
    |v| levels(v, |_, random| normal(random)),
    |v| {
        let one = number(v, v.a);
        v.run.iter().map(|run| f64::from(*run == one)).collect()
    },
    |v| {
        let one = number(v, v.a).max(1);
        v.run.iter().map(|run| f64::from(*run >= one)).collect()
    },
];

const WARM: &[Form] = of_time![
    |s, a, _| libm::exp(-s / (0.03 + 0.15 * a)),
    |s, a, b| 0.65 * libm::exp(-s / (0.02 + 0.06 * a)) + 0.35 * libm::exp(-s / (0.12 + 0.25 * b)),
    |s, a, b| libm::exp(-power(s / (0.04 + 0.12 * a), 0.6 + 0.35 * b)),
];

const WARMTH: &[Form] = &[
    |v| lagged(v.drive, v.hours, span(v) * (0.004 + 0.03 * v.a)),
    |v| {
        let quick = lagged(v.drive, v.hours, span(v) * (0.003 + 0.01 * v.a));
        let slow = lagged(v.drive, v.hours, span(v) * (0.02 + 0.05 * v.b));
        quick
            .iter()
            .zip(slow)
            .map(|(q, s)| 0.6 * q + 0.4 * s)
            .collect()
    },
    |v| {
        v.drive
            .iter()
            .map(|x| x + (0.1 + 0.1 * v.a) * x * x)
            .collect()
    },
];

const FOLLOWED: &[Form] = of_drive![
    |x, _, _| x,
    |x, a, _| libm::tanh((0.2 + 0.4 * a) * x) / (0.2 + 0.4 * a),
    |x, a, _| x + (0.1 + 0.15 * a) * x * x
];

const SCREW: &[Form] = &[
    |v| turns(v).map(libm::sin).collect(),
    |v| turns(v).map(|x| libm::asin(libm::sin(x))).collect(),
    |v| {
        let harmonic = |x: f64| libm::sin(x) + 0.25 * libm::sin(2.0 * x + 0.2);
        turns(v).map(harmonic).collect()
    },
];

const CREEP: &[Form] = &[
    |v| lacking(v.drive, v.hours, &[(1.0, pace(v, v.a))]),
    |v| {
        lacking(
            v.drive,
            v.hours,
            &[(0.65, pace(v, v.a)), (0.35, 4.0 * pace(v, v.a))],
        )
    },
    |v| {
        let rungs = [0.3, 1.0, 3.0, 9.0, 27.0].map(|k| (0.2, k * pace(v, 0.5 * v.a)));
        lacking(v.drive, v.hours, &rungs)
    },
];

/// All families; the last ones no catalogue names.
pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "curvature",
        drive: Drive::OneSided,
        place: Place::Offset,
        names: &[
            ("quadratic", ANY),
            ("cubic", ANY),
            ("exponent", ANY),
            ("saturation", ANY),
            ("tempco-quadratic", OWN),
        ],
        forms: of_drive![
            |x, a, _| power(x, 1.6 + 1.2 * a),
            |x, a, _| -libm::expm1(-(0.5 + 2.0 * a) * x),
            |x, a, _| libm::tanh((0.6 + 0.9 * a) * x),
            |x, a, _| x / (1.0 + (0.3 + 1.5 * a) * x),
        ],
    },
    Family {
        name: "even-curvature",
        drive: Drive::TwoSided,
        place: Place::Offset,
        names: &[("quadratic", ANY), ("axis-quadratic", ANY)],
        forms: of_drive![
            |x, _, _| x * x,
            |x, a, _| libm::cosh((0.5 + a) * x) - 1.0,
            |x, a, _| -libm::expm1(-(0.3 + a) * x * x),
        ],
    },
    Family {
        name: "odd-curvature",
        drive: Drive::TwoSided,
        place: Place::Offset,
        names: &[("cubic", ANY), ("axis-cubic", ANY), ("saturation", ANY)],
        forms: of_drive![
            |x, _, _| x * x * x,
            |x, a, _| libm::tanh((0.8 + a) * x),
            |x, a, _| x / (1.0 + (0.3 + a) * x.abs()),
            |x, a, _| libm::atan((0.8 + 1.5 * a) * x),
        ],
    },
    Family {
        name: "asymmetry",
        drive: Drive::TwoSided,
        place: Place::Offset,
        names: &[("asymmetry", ANY), ("axis-asymmetry", ANY)],
        forms: of_drive![|x, _, _| x.abs(), |x, a, _| (0.01 + 0.04 * a)
            * soft_plus(x / (0.01 + 0.04 * a)),],
    },
    Family {
        name: "knee",
        drive: Drive::Stimulus,
        place: Place::Offset,
        names: &[("kink", ANY), ("saturation", ANY), ("clip", ANY)],
        forms: of_drive![|x, a, _| (x - 0.3 - 0.5 * a).max(0.0), |x, a, b| (0.01
            + 0.02 * b)
            * soft_plus((x - 0.3 - 0.5 * a) / (0.01 + 0.02 * b)),],
    },
    Family {
        name: "screw",
        drive: Drive::Stimulus,
        place: Place::Offset,
        names: &[("wave", ANY), ("periodic", ANY)],
        forms: SCREW,
    },
    Family {
        name: "temperature",
        drive: Drive::Temperature,
        place: Place::Offset,
        names: &[("tempco-bias", OWN), ("tempco-quadratic", OWN)],
        forms: WARMTH,
    },
    Family {
        name: "temperature-scale",
        drive: Drive::Temperature,
        place: Place::Scale,
        names: &[("tempco-scale", OWN), ("sensitivity-scale-quadratic", OWN)],
        forms: WARMTH,
    },
    Family {
        name: "condition",
        drive: Drive::Condition,
        place: Place::Offset,
        names: &[("sensitivity", OWN), ("sensitivity-quadratic", OWN)],
        forms: FOLLOWED,
    },
    Family {
        name: "condition-scale",
        drive: Drive::Condition,
        place: Place::Scale,
        names: &[
            ("sensitivity-scale", OWN),
            ("sensitivity-scale-quadratic", OWN),
        ],
        forms: FOLLOWED,
    },
    Family {
        name: "drift",
        drive: Drive::Time,
        place: Place::Offset,
        names: &[("drift", ANY)],
        forms: AGEING,
    },
    Family {
        name: "scale-drift",
        drive: Drive::Time,
        place: Place::Scale,
        names: &[("drift-scale", ANY)],
        forms: AGEING,
    },
    Family {
        name: "warm-up",
        drive: Drive::Time,
        place: Place::Offset,
        names: &[("warm-up", ANY)],
        forms: WARM,
    },
    Family {
        name: "creep",
        drive: Drive::Path,
        place: Place::Offset,
        names: &[("lag", ANY), ("temperature-lag", OWN)],
        forms: CREEP,
    },
    Family {
        name: "hysteresis",
        drive: Drive::Path,
        place: Place::Offset,
        names: &[("hysteresis", ANY)],
        forms: &[
            |v| plays(v.drive, 0.15 + 0.3 * v.a),
            |v| relays(v.drive, &mut source(v.seed, Stream::Effect, 77)),
            |v| bouc_wen(v.drive, 0.15 + 0.25 * v.a),
        ],
    },
    Family {
        name: "play",
        drive: Drive::Path,
        place: Place::Input,
        names: &[("play", ANY), ("hysteresis", ANY)],
        forms: &[|v| play(v.drive, 0.04 + 0.08 * v.a)],
    },
    Family {
        name: "delay",
        drive: Drive::Moving,
        place: Place::Input,
        names: &[("timing-skew", ANY), ("lag", ANY), ("temperature-lag", OWN)],
        forms: &[|v| {
            let delay = 1 + (v.a * 8.0) as usize;
            (0..v.drive.len())
                .map(|k| v.drive[k.saturating_sub(delay)] - v.drive[k])
                .collect()
        }],
    },
    Family {
        name: "run-shift",
        drive: Drive::Run,
        place: Place::Offset,
        names: &[("level-shift", OWN), ("step", ANY)],
        forms: LEVELS,
    },
    Family {
        name: "run-scale",
        drive: Drive::Run,
        place: Place::Scale,
        names: &[("level-scale", OWN), ("step-scale", ANY)],
        forms: LEVELS,
    },
    // A jump between two runs is a shift of the runs, whatever made it.
    Family {
        name: "step",
        drive: Drive::Time,
        place: Place::Offset,
        names: &[("step", ANY), ("level-shift", ANY)],
        forms: STEPS,
    },
    Family {
        name: "scale-step",
        drive: Drive::Time,
        place: Place::Scale,
        names: &[("step-scale", ANY), ("level-scale", ANY)],
        forms: STEPS,
    },
    Family {
        name: "daily",
        drive: Drive::Days,
        place: Place::Offset,
        names: &[("daily", ANY), ("wave", ANY)],
        forms: &[
            |v| {
                v.hours
                    .iter()
                    .map(|h| libm::sin(TAU * (h / 24.0 + v.a)))
                    .collect()
            },
            |v| {
                v.hours
                    .iter()
                    .map(|h| {
                        libm::sin(TAU * (h / 24.0 + v.a)) + 0.2 * libm::sin(TAU * (h / 12.0 + v.b))
                    })
                    .collect()
            },
        ],
    },
    Family {
        name: "self-heating",
        drive: Drive::Stimulus,
        place: Place::Scale,
        names: &[
            ("self-heating", ANY),
            ("cubic", ANY),
            ("quadratic", ANY),
            ("saturation", ANY),
            ("exponent", ANY),
        ],
        forms: &[|v| {
            let power: Vec<f64> = v.signal.iter().map(|x| x * x).collect();
            lagged(&power, v.hours, 0.2 * pace(v, v.a))
        }],
    },
    Family {
        name: "coarse-digits",
        drive: Drive::Stimulus,
        place: Place::Rounding,
        names: &[("quantisation", ANY)],
        forms: &[|v| vec![1.0; v.share.len()]],
    },
    Family {
        name: "limit",
        drive: Drive::Stimulus,
        place: Place::Clip,
        names: &[
            ("saturation", ANY),
            ("kink", ANY),
            ("clip", ANY),
            ("stuck", ANY),
        ],
        forms: &[|v| vec![1.0; v.share.len()]],
    },
    Family {
        name: "wrong-reading",
        drive: Drive::Time,
        place: Place::Offset,
        names: &[("outlier", ANY)],
        forms: &[|v| {
            let rows = v.share.len() / 6;
            let one = (v.a * rows as f64) as usize;
            (0..v.share.len())
                .map(|k| f64::from(k / 6 == one))
                .collect()
        }],
    },
    Family {
        name: "bits",
        drive: Drive::Code,
        place: Place::Offset,
        names: &[
            ("bit-weight", ANY),
            ("bit-weights", ANY),
            ("converter", ANY),
            ("converter-nonlinearity", ANY),
            ("transition", ANY),
        ],
        forms: &[
            |v| bits(v, |bit, chosen, _| f64::from(bit == chosen)),
            |v| bits(v, |_, _, random| normal(random)),
        ],
    },
    Family {
        name: "cross-axis",
        drive: Drive::Axes,
        place: Place::Axis,
        names: &[("cross-axis", ANY)],
        forms: &[|v| vec![1.0; v.share.len()]],
    },
    Family {
        name: "local-bump",
        drive: Drive::Stimulus,
        place: Place::Offset,
        names: &[("excursion", OWN)],
        forms: of_drive![
            |x, a, b| libm::exp(-0.5 * libm::pow((x - 0.2 - 0.6 * a) / (0.05 + 0.05 * b), 2.0)),
            |x, a, b| 1.0 / (1.0 + libm::pow((x - 0.2 - 0.6 * a) / (0.05 + 0.05 * b), 2.0)),
            |x, a, b| (1.0 - (x - 0.2 - 0.6 * a).abs() / (0.12 + 0.12 * b)).max(0.0),
        ],
    },
    // What no catalogue names.
    Family {
        name: "dispersion",
        drive: Drive::Stimulus,
        place: Place::Offset,
        names: &[],
        forms: of_drive![|x, a, b| {
            let z = (x - 0.2 - 0.6 * a) / (0.04 + 0.04 * b);
            z / (1.0 + z * z)
        }],
    },
    Family {
        name: "chirp",
        drive: Drive::Stimulus,
        place: Place::Offset,
        names: &[],
        forms: of_drive![|x, a, b| libm::sin((9.0 + 8.0 * a) * x * x + TAU * b)],
    },
    Family {
        name: "ranges",
        drive: Drive::Stimulus,
        place: Place::Offset,
        names: &[("transition", ANY)],
        forms: of_drive![
            |x, a, b| libm::sin((9.0 + 6.0 * a) * power(x.abs(), 1.7) + TAU * b).signum()
        ],
    },
    Family {
        name: "popcorn",
        drive: Drive::Time,
        place: Place::Offset,
        names: &[],
        forms: &[|v| {
            let random = &mut source(v.seed, Stream::Effect, 78);
            let (mut state, mut until) = (sign(random), 0.0);
            let level = |s: &f64| {
                while *s > until {
                    state = -state;
                    until += 0.04 + 0.16 * random.random::<f64>();
                }
                state
            };
            v.share.iter().map(level).collect()
        }],
    },
    Family {
        name: "wandering-scale",
        drive: Drive::Time,
        place: Place::Scale,
        names: &[],
        forms: &[|v| {
            let random = &mut source(v.seed, Stream::Effect, 79);
            let waves: Vec<[f64; 2]> = (0..5)
                .map(|_| [2.0 + 7.0 * random.random::<f64>(), random.random()])
                .collect();
            v.share
                .iter()
                .map(|s| {
                    waves
                        .iter()
                        .map(|[turns, phase]| libm::sin(TAU * (turns * s + phase)))
                        .sum()
                })
                .collect()
        }],
    },
    Family {
        name: "ringing",
        drive: Drive::Time,
        place: Place::Offset,
        names: &[],
        forms: of_time![|s, a, b| {
            let since = s - 0.15 - 0.5 * a;
            if since > 0.0 {
                libm::exp(-since / 0.12) * libm::sin(TAU * since * (12.0 + 10.0 * b))
            } else {
                0.0
            }
        }],
    },
    Family {
        name: "teeth",
        drive: Drive::Time,
        place: Place::Offset,
        names: &[],
        forms: of_time![|s, a, b| {
            let phase = (2.5 + 2.0 * a) * power(s, 1.5) + b;
            phase - phase.floor()
        }],
    },
    // A temperature that was not recorded: the file is written without its column.
    Family {
        name: "hidden-temperature",
        drive: Drive::Temperature,
        place: Place::Offset,
        names: &[("unrecorded-temperature", ANY)],
        forms: WARMTH,
    },
];

/// Length of the campaign, hours.
fn span(v: &View<'_>) -> f64 {
    v.hours.last().unwrap_or(&1.0) - v.hours.first().unwrap_or(&0.0)
}

/// A time constant from half a row to a dozen rows.
fn pace(v: &View<'_>, a: f64) -> f64 {
    let row = span(v) / (v.hours.len() as f64 / 6.0);
    row * 0.7 * libm::pow(12.0, a)
}

/// Angle of a screw that turns three to five times over the range, as few as can be told to be periodic.
fn turns<'a>(v: &'a View<'_>) -> impl Iterator<Item = f64> + 'a {
    let least = v.drive.iter().copied().fold(0.0, f64::min);
    let rate = (3.2 + 1.5 * v.a) / if least < -0.5 { 2.0 } else { 1.0 };
    v.drive.iter().map(move |x| TAU * (rate * x + v.b))
}

/// A run by a number from 0 to 1.
fn number(v: &View<'_>, part: f64) -> usize {
    let runs = v.run.last().map_or(1, |last| last + 1);
    ((part * runs as f64) as usize).min(runs - 1)
}

/// A value for each run.
fn levels(v: &View<'_>, draw: impl Fn(usize, &mut crate::random::Random) -> f64) -> Vec<f64> {
    let random = &mut source(v.seed, Stream::Effect, 80);
    let values: Vec<f64> = (0..=number(v, 1.0)).map(|run| draw(run, random)).collect();
    v.run.iter().map(|run| values[*run]).collect()
}

/// Errors of the weights of bits, as a part of the least bit's weight for each.
fn bits(v: &View<'_>, weigh: impl Fn(u32, u32, &mut crate::random::Random) -> f64) -> Vec<f64> {
    const BITS: u32 = 12;
    let random = &mut source(v.seed, Stream::Effect, 81);
    let chosen = BITS - 1 - (v.a * 4.0) as u32;
    let weights: Vec<f64> = (0..BITS).map(|bit| weigh(bit, chosen, random)).collect();
    let error = |code: &f64| {
        let code = (code * f64::from(1_u32 << BITS)) as u32;
        (0..BITS)
            .filter(|bit| code >> bit & 1 == 1)
            .map(|bit| weights[bit as usize])
            .sum()
    };
    v.drive.iter().map(error).collect()
}
