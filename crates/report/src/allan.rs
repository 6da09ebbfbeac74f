//! The Allan deviation of a recording at rest, and the noises that it shows.

use gumption_fault::say;
use serde_json::Value;

use crate::language::Language;
use crate::number::{TABLE_DIGITS, aligned, freedom, grouped, in_unit, probability, significant};
use crate::symbol;
use gumption_core::quantity::Unit;
use gumption_format::document::{Axis, Block, Document, Layer, Marks, Panel, Plot, Tone};
use gumption_format::document::{ColumnKind, Table};
use gumption_format::machine::{self, Machine, Number, record};
use gumption_lab::recording::{Allan, Coefficient, Noises, PowerLaw};

/// An Allan deviation, ready to be shown.
#[derive(Debug, Clone, Copy)]
pub struct AllanReport<'a> {
    /// The recording and the column.
    pub title: &'a str,
    /// Unit of the readings.
    pub unit: &'a Unit,
    /// Unit of the time.
    pub time: &'a Unit,
    /// The deviations.
    pub allan: &'a Allan,
    /// The noises that they show; `None` where there are too few averaging times, or nothing varies.
    pub noises: Option<&'a Noises>,
    /// Language of the sentences and headings.
    pub language: Language,
}

/// The document of an Allan deviation: numbers in the units that stand beside them.
pub fn allan(report: &AllanReport<'_>) -> Document {
    Document::new(&form(report), report.language, blocks(report))
}

/// JSON Schema of the output of `gumption allan --json`.
pub fn allan_schema() -> Value {
    machine::schema::<AllanJson<'_>>("gumption allan --json")
}

record! {
    /// The Allan deviation of a recording.
    AllanJson<'a> {
        /// The recording and the column.
        title: &'a str,
        /// Unit of the readings.
        unit: &'a str,
        /// Unit of the time.
        time_unit: &'a str,
        /// Number of readings.
        readings: usize,
        /// Time from one reading to the next.
        reading_interval: Number,
        /// Coverage probability of the intervals.
        coverage_probability: Number,
        /// The deviation at each averaging time.
        points: Vec<PointJson>,
        /// The noises that the deviations show; null where they are too few, or nothing varies.
        noises: Option<NoisesJson>,
    }

    /// The deviation at one averaging time.
    PointJson {
        /// Averaging time.
        tau: Number,
        /// Allan deviation.
        deviation: Number,
        /// Its standard uncertainty.
        u: Number,
        /// Its degrees of freedom.
        dof: Number,
        /// Its confidence interval.
        interval: [Number; 2],
        /// The noise that prevails: white, flicker, random walk.
        noise: &'static str,
    }

    /// White noise, bias instability and random walk of the rate, fitted to the deviations.
    NoisesJson {
        /// White noise.
        white: CoefficientJson,
        /// Bias instability.
        bias_instability: CoefficientJson,
        /// Random walk of the readings.
        rate_random_walk: CoefficientJson,
        /// χ² of the fit.
        chi_squared: Number,
        /// Its degrees of freedom.
        dof: usize,
        /// Probability of a larger χ².
        p_value: Number,
    }

    /// A coefficient of a noise, or its limit where the recording does not show it.
    CoefficientJson {
        /// The coefficient.
        #[serde(skip_serializing_if = "Option::is_none")]
        value: Option<Number>,
        /// Its standard uncertainty.
        #[serde(skip_serializing_if = "Option::is_none")]
        u: Option<Number>,
        /// What the coefficient is below with about 95 % probability.
        #[serde(skip_serializing_if = "Option::is_none")]
        limit_95: Option<Number>,
        /// Unit of all three.
        unit: String,
    }
}

impl Machine for AllanJson<'_> {
    const KIND: &'static str = "allan";
    const VERSION: u32 = 1;
}

fn form<'a>(report: &AllanReport<'a>) -> AllanJson<'a> {
    let allan = report.allan;
    let points = allan.points.iter().map(|point| PointJson {
        tau: Number(point.tau),
        deviation: Number(point.deviation),
        u: Number(point.u),
        dof: Number(point.dof),
        interval: point.interval.map(Number),
        noise: name(point.noise, Language::English),
    });
    let coefficient = |found, law| {
        let (value, u, limit_95) = match found {
            Coefficient::Identified { value, u } => (Some(value), Some(u), None),
            Coefficient::Hidden { limit } => (None, None, Some(limit)),
        };
        CoefficientJson {
            value: value.map(Number),
            u: u.map(Number),
            limit_95: limit_95.map(Number),
            unit: unit_of(report, law),
        }
    };
    AllanJson {
        title: report.title,
        unit: &report.unit.symbol,
        time_unit: &report.time.symbol,
        readings: allan.readings,
        reading_interval: Number(allan.interval),
        coverage_probability: Number(allan.probability),
        points: points.collect(),
        noises: report.noises.map(|noises| NoisesJson {
            white: coefficient(noises.white, PowerLaw::White),
            bias_instability: coefficient(noises.bias_instability, PowerLaw::Flicker),
            rate_random_walk: coefficient(noises.rate_random_walk, PowerLaw::RandomWalk),
            chi_squared: Number(noises.chi_squared),
            dof: noises.dof,
            p_value: Number(noises.p_value),
        }),
    }
}

fn blocks(report: &AllanReport<'_>) -> Vec<Block> {
    let l = report.language;
    let mut blocks = vec![
        Block::Title(say!("Allan deviation of {}", report.title).in_language(l)),
        Block::Paragraph(data(report)),
        Block::Section(l.pick("Noises", "噪声").into()),
    ];
    match report.noises {
        Some(noises) => {
            blocks.push(Block::Formula(vec![
                "σ²(τ) = N²/τ + B²·2 ln 2/π + K²·τ/3".into(),
            ]));
            blocks.push(Block::Table(coefficients(report, noises)));
            blocks.push(Block::Paragraph(quality(l, noises)));
        }
        None => blocks.push(Block::Paragraph(
            say!(
                "The deviations are too few to tell the noises apart, or the readings do not vary."
            )
            .in_language(l),
        )),
    }
    blocks.push(Block::Section(
        l.pick("Deviations", "各平均时间的偏差").into(),
    ));
    blocks.push(Block::Table(points(report)));
    blocks.push(Block::Plot(plot(report)));
    blocks
}

/// The deviations with their intervals, the noises drawn over them.
fn plot(report: &AllanReport<'_>) -> Plot {
    let l = report.language;
    let points = &report.allan.points;
    let intervals = points.iter().map(|p| [p.tau, p.interval[0], p.interval[1]]);
    let deviations = points.iter().map(|p| [p.tau, p.deviation]);
    let mut layers = vec![Layer::new(
        format!(
            "{} {}",
            l.pick("confidence interval", "置信区间"),
            probability(report.allan.probability)
        ),
        Tone::Quiet,
        Marks::Band(intervals.collect()),
    )];
    if let Some(noises) = report.noises {
        layers
            .extend(slopes(report, noises).map(|(name, line)| Layer::new(name, Tone::Quiet, line)));
        let curve = points.iter().map(|p| [p.tau, noises.deviation(p.tau)]);
        let name = l.pick("the noises together", "各噪声之和");
        layers.push(Layer::new(
            name,
            Tone::Contrast,
            Marks::Line(curve.collect()),
        ));
    }
    let name = l.pick("Allan deviation", "阿伦偏差");
    layers.push(Layer::new(
        name,
        Tone::Main,
        Marks::Points(deviations.collect()),
    ));
    Plot {
        id: "allan".into(),
        panels: vec![Panel {
            title: say!("Allan deviation over averaging time").in_language(l),
            x: Axis::logarithmic("τ", symbol(report.time)),
            y: Axis::logarithmic("σ(τ)", symbol(report.unit)),
            layers,
        }],
    }
}

/// The noises one by one, as far down as there are deviations.
fn slopes<'n>(
    report: &AllanReport<'n>,
    noises: &'n Noises,
) -> impl Iterator<Item = (&'static str, Marks)> {
    let l = report.language;
    let points = &report.allan.points;
    let lowest = points.iter().map(|p| p.interval[0]);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    let all = [
        (noises.white, l.pick("N, slope −½", "N，斜率 −½")),
        (noises.bias_instability, l.pick("B, slope 0", "B，斜率 0")),
        (noises.rate_random_walk, l.pick("K, slope +½", "K，斜率 +½")),
    ];
    let named = all.into_iter().zip(PowerLaw::ALL);
    named.filter_map(move |((found, name), law)| {
        let value = found.value()?;
        let line = points.iter().map(|p| {
            let deviation = value * libm::sqrt(law.allan_variance(p.tau));
            [p.tau, deviation]
        });
        let seen: Vec<[f64; 2]> = line.filter(|[_, y]| *y >= lowest).collect();
        (seen.len() > 1).then_some((name, Marks::Line(seen)))
    })
}

fn data(report: &AllanReport<'_>) -> String {
    let allan = report.allan;
    let n = grouped(allan.readings as u64);
    let interval = format!("{} {}", significant(allan.interval, 6), symbol(report.time));
    say!("{n} readings, one every {interval}; overlapping estimates at averaging times of 1, 2, 4 … intervals.").in_language(report.language)
}

fn coefficients(report: &AllanReport<'_>, noises: &Noises) -> Table {
    let l = report.language;
    let mut table = Table::new([
        (l.pick("noise", "噪声"), ColumnKind::Names),
        (l.pick("symbol", "符号"), ColumnKind::Words),
        (l.pick("value", "值"), ColumnKind::Numbers),
        ("u", ColumnKind::Numbers),
        (l.pick("unit", "单位"), ColumnKind::Words),
    ]);
    let rows = [
        (
            l.pick(
                "white noise, random walk of the integral",
                "白噪声（积分量的随机游走）",
            ),
            "N",
            noises.white,
            PowerLaw::White,
        ),
        (
            l.pick("bias instability (flicker)", "零偏不稳定性（闪烁噪声）"),
            "B",
            noises.bias_instability,
            PowerLaw::Flicker,
        ),
        (
            l.pick(
                "random walk of the readings",
                "读数的随机游走（速率随机游走）",
            ),
            "K",
            noises.rate_random_walk,
            PowerLaw::RandomWalk,
        ),
    ];
    for (name, letter, found, law) in rows {
        let (value, u) = match found {
            Coefficient::Identified { value, u } => (
                aligned(value, u, TABLE_DIGITS),
                significant(u, TABLE_DIGITS),
            ),
            Coefficient::Hidden { limit } => {
                (format!("< {}", significant(limit, 2)), String::new())
            }
        };
        table.push(vec![
            name.to_string().into(),
            letter.to_string().into(),
            value.into(),
            u.into(),
            unit_of(report, law).into(),
        ]);
    }
    table
}

/// Units of N, B and K.
fn unit_of(report: &AllanReport<'_>, law: PowerLaw) -> String {
    let (unit, time) = (report.unit.typeset(), report.time.typeset());
    let bracketed = match unit.contains(['/', '·', ' ']) {
        true => format!("({unit})"),
        false => unit.clone(),
    };
    match law {
        PowerLaw::White => format!("{bracketed}·√{time}"),
        PowerLaw::Flicker => symbol(report.unit),
        PowerLaw::RandomWalk => format!("{bracketed}/√{time}"),
    }
}

fn quality(l: Language, noises: &Noises) -> String {
    let limits = say!("Where the recording does not show a noise, “<” says below what it is with about 95 % probability: the limit is approximate, since Allan variances of few degrees of freedom are not normal.").in_language(l);
    let p = significant(noises.p_value, 2);
    match noises.explain() {
        false => say!("{limits} These noises do not explain the deviations (p = {p}): something else is in the recording, such as a drift, a period or quantisation.").in_language(l),
        true => say!("{limits} They explain the deviations (p = {p}).").in_language(l),
    }
}

fn points(report: &AllanReport<'_>) -> Table {
    let l = report.language;
    let p = probability(report.allan.probability);
    let (unit, time) = (symbol(report.unit), symbol(report.time));
    let mut table = Table::new([
        (&*in_unit("τ", &time), ColumnKind::Numbers),
        (&*in_unit("σ(τ)", &unit), ColumnKind::Numbers),
        ("u", ColumnKind::Numbers),
        (
            &*format!("{} {p}", l.pick("from", "下限")),
            ColumnKind::Numbers,
        ),
        (
            &*format!("{} {p}", l.pick("to", "上限")),
            ColumnKind::Numbers,
        ),
        ("ν", ColumnKind::Numbers),
        (l.pick("noise", "噪声"), ColumnKind::Words),
    ]);
    for point in &report.allan.points {
        let number = |x: f64| significant(x, TABLE_DIGITS);
        table.push(vec![
            significant(point.tau, 4).into(),
            aligned(point.deviation, point.u, 2).into(),
            significant(point.u, 2).into(),
            number(point.interval[0]).into(),
            number(point.interval[1]).into(),
            freedom(point.dof).into(),
            name(point.noise, l).to_string().into(),
        ]);
    }
    table
}

fn name(law: PowerLaw, l: Language) -> &'static str {
    match law {
        PowerLaw::White => l.pick("white", "白噪声"),
        PowerLaw::Flicker => l.pick("flicker", "闪烁"),
        PowerLaw::RandomWalk => l.pick("random walk", "随机游走"),
    }
}
