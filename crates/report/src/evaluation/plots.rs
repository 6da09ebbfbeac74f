//! The pictures of an evaluation, as data: what makes u large, the distribution of the result, curves, series.

use gumption_core::special::student_t_pdf;
use gumption_fault::say;
use gumption_format::document::{Axis, Bar, Layer, Marks, Panel, Plot, Tone};
use gumption_gum::budget::Fit;
use gumption_gum::propagate::{Gum, MonteCarlo};

use crate::figures::Figures;
use crate::{Report, symbol};

/// Measurands that have pictures of their own.
const MOST_MEASURANDS: usize = 6;
/// Bars that a reader takes in.
const MOST_BARS: usize = 16;
/// Points of a curve.
const POINTS: i32 = 160;

/// The pictures of one evaluation.
pub(super) fn plots(report: &Report<'_>) -> Vec<Plot> {
    let mut plots = Vec::new();
    let row = report
        .label
        .map(|label| format!("_{label}"))
        .unwrap_or_default();
    let results = &report.evaluation.results;
    for (m, result) in results.iter().enumerate().take(MOST_MEASURANDS) {
        let name = format!("{}{row}", report.measurand(m).0);
        if result.gum.u > 0.0 && result.gum.u.is_finite() && largest(&result.gum).len() > 1 {
            let panels = vec![contributions(report, m), waterfall(report, m)];
            plots.push(Plot::new(&format!("budget_{name}"), panels));
        }
        if let Some(found) = &result.monte_carlo
            && found.histogram.counts.iter().any(|count| *count > 0)
        {
            let panels = vec![distribution(report, m, found)];
            plots.push(Plot::new(&format!("distribution_{name}"), panels));
        }
    }
    for fit in &report.budget.fits {
        if fit.columns.len() == 2 {
            let id = format!("fit_{}{row}", fit.name);
            plots.push(Plot::new(&id, curve(report, fit)));
        }
    }
    plots
}

/// Indices of the inputs that contribute most, the largest first.
fn largest(gum: &Gum) -> Vec<usize> {
    let mut order: Vec<usize> = (0..gum.inputs.len()).collect();
    let size = |i: &usize| gum.inputs[*i].contribution.abs();
    order.retain(|i| size(i) > 0.0);
    order.sort_by(|a, b| size(b).total_cmp(&size(a)));
    order.truncate(MOST_BARS);
    order
}

/// |c·u| of the inputs, and u(y).
fn contributions(report: &Report<'_>, m: usize) -> Panel {
    let l = report.language;
    let (name, unit) = report.measurand(m);
    let gum = &report.evaluation.results[m].gum;
    let bar = |name: &str, to: f64| Bar {
        name: name.to_string(),
        from: 0.0,
        to,
    };
    let mut bars: Vec<Bar> = largest(gum)
        .into_iter()
        .map(|i| {
            bar(
                &report.budget.inputs[i].name,
                gum.inputs[i].contribution.abs(),
            )
        })
        .collect();
    bars.push(bar(&format!("u({name})"), gum.u));
    Panel {
        title: say!("Contributions to u({name})").in_language(l),
        x: Axis::linear("|c·u|", symbol(unit)),
        y: Axis::linear("", ""),
        layers: vec![Layer::new("|c·u|", Tone::Main, Marks::Bars(bars))],
    }
}

/// How the squares of the contributions, correlation and second order add up to u².
fn waterfall(report: &Report<'_>, m: usize) -> Panel {
    /// Per cent of u² that a bar can show.
    const SEEN: f64 = 0.05;
    let l = report.language;
    let name = report.measurand(m).0;
    let result = &report.evaluation.results[m];
    let gum = &result.gum;
    let part = |i: usize| 100.0 * (gum.inputs[i].contribution / gum.u).powi(2);
    let mut order = largest(gum);
    order.retain(|i| part(*i) > SEEN);
    let mut at = 0.0;
    let mut bars = Vec::new();
    let mut step = |name: String, change: f64| {
        bars.push(Bar {
            name,
            from: at,
            to: at + change,
        });
        at += change;
    };
    for i in &order {
        step(report.budget.inputs[*i].name.to_string(), part(*i));
    }
    let all: f64 = (0..gum.inputs.len()).map(part).sum();
    let shown: f64 = order.iter().map(|i| part(*i)).sum();
    if all - shown > SEEN {
        step(l.pick("all others", "其余输入量").to_string(), all - shown);
    }
    if (100.0 - all).abs() > SEEN {
        step(l.pick("correlation", "相关").to_string(), 100.0 - all);
    }
    if let Some(second) = &result.second_order {
        let more = 100.0 * ((second.u / gum.u).powi(2) - 1.0);
        if more.abs() > SEEN {
            step(l.pick("second order", "二阶项").to_string(), more);
        }
    }
    let title = say!("Why u({name}) is this large: the squares add up").in_language(l);
    Panel {
        title,
        x: Axis::linear(l.pick("part of u²", "占 u² 之比"), "%"),
        y: Axis::linear("", ""),
        layers: vec![Layer::new("", Tone::Main, Marks::Bars(bars))],
    }
}

/// The histogram of the trials, the density of the GUM, both intervals, limits of tolerance.
fn distribution(report: &Report<'_>, m: usize, found: &MonteCarlo) -> Panel {
    let l = report.language;
    let (name, unit) = report.measurand(m);
    let result = &report.evaluation.results[m];
    let gum = &result.gum;
    let histogram = &found.histogram;
    let all: u64 = histogram.counts.iter().sum();
    let mut steps = Vec::new();
    for (bin, count) in histogram.counts.iter().enumerate() {
        let left = histogram.start + bin as f64 * histogram.width;
        let density = *count as f64 / all as f64 / histogram.width;
        steps.push([left, 0.0, density]);
        steps.push([left + histogram.width, 0.0, density]);
    }
    let trials = l.pick("Monte Carlo", "蒙特卡洛法");
    let mut layers = vec![Layer::new(trials, Tone::Main, Marks::Band(steps))];
    if gum.u > 0.0 && gum.u.is_finite() {
        let (low, dof) = (histogram.start, gum.freedom.value());
        let width = histogram.width * histogram.counts.len() as f64;
        let curve = (0..=POINTS).map(|n| {
            let x = low + width * f64::from(n) / f64::from(POINTS);
            [x, student_t_pdf((x - gum.estimate) / gum.u, dof) / gum.u]
        });
        let name = l.pick("GUM", "GUM 法");
        layers.push(Layer::new(
            name,
            Tone::Contrast,
            Marks::Line(curve.collect()),
        ));
        let half = gum.coverage.half_width_for_p;
        for end in [gum.estimate - half, gum.estimate + half] {
            layers.push(Layer::new("", Tone::Contrast, Marks::Upright(end)));
        }
    }
    for end in found.symmetric {
        layers.push(Layer::new("", Tone::Main, Marks::Upright(end)));
    }
    let [left, right] = [
        histogram.start,
        histogram.start + histogram.width * histogram.counts.len() as f64,
    ];
    let limits = report.budget.conformity.iter().filter(|c| c.measurand == m);
    for limit in limits.flat_map(|c| [c.tolerance.lower, c.tolerance.upper]) {
        // A limit far away would leave nothing to be seen of the distribution.
        let near = (left - 2.0 * (right - left)..=right + 2.0 * (right - left)).contains(&limit);
        if near {
            // One of them is named for all.
            let words = l.pick("limits of tolerance", "容许限");
            let first = layers.iter().all(|one| one.name != words);
            let name = if first { words } else { "" };
            layers.push(Layer::new(name, Tone::Quiet, Marks::Upright(limit)));
        }
    }
    let per = match symbol(unit) {
        none if none.is_empty() => none,
        compound if compound.contains(['/', '·', ' ']) => format!("1/({compound})"),
        simple => format!("1/{simple}"),
    };
    Panel {
        title: say!("Distribution of {name}, with the ends of the intervals").in_language(l),
        x: Axis::linear(name, symbol(unit)),
        y: Axis::linear(l.pick("density", "概率密度"), per),
        layers,
    }
}

/// A fit of one predictor: points with the curve, and what is left.
fn curve(report: &Report<'_>, fit: &Fit) -> Vec<Panel> {
    let l = report.language;
    let [response, predictor] = [0, 1].map(|column| &fit.columns[column]);
    let axis = |column: &gumption_gum::budget::FitColumn| {
        Axis::linear(column.name.as_str(), symbol(&column.unit))
    };
    let observed: Vec<[f64; 2]> = pairs(&predictor.values, &response.values);
    let mut fitted = pairs(&predictor.values, &fit.fitted);
    fitted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let whiskers = |middle: &[f64]| {
        let u = response.u.as_ref()?;
        let bars = predictor.values.iter().zip(middle).zip(u);
        let bars = bars.map(|((x, y), u)| [*x, y - u, y + u]);
        Some(Layer::new(
            "±u",
            Tone::Quiet,
            Marks::Whiskers(bars.collect()),
        ))
    };
    let data = l.pick("data", "数据");
    let curve = l.pick("fitted curve", "拟合曲线");
    let mut above: Vec<Layer> = whiskers(&response.values).into_iter().collect();
    above.push(Layer::new(curve, Tone::Contrast, Marks::Line(fitted)));
    above.push(Layer::new(data, Tone::Main, Marks::data(observed)));
    let mut below = Vec::new();
    if let Some(s) = fit.residual_sd.filter(|_| !fit.weighted) {
        let ends = predictor
            .values
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
                [a.min(*x), b.max(*x)]
            });
        let band = ends.map(|x| [x, -s, s]).to_vec();
        below.push(Layer::new("±s", Tone::Quiet, Marks::Band(band)));
    }
    below.extend(whiskers(&fit.residuals));
    below.push(Layer::new("", Tone::Quiet, Marks::Level(0.0)));
    let left = pairs(&predictor.values, &fit.residuals);
    below.push(Layer::new(
        l.pick("residuals", "残差"),
        Tone::Main,
        Marks::data(left),
    ));
    vec![
        Panel {
            title: say!("Fit {}", fit.name).in_language(l),
            x: axis(predictor),
            y: axis(response),
            layers: above,
        },
        Panel {
            title: l.pick("Residuals", "残差").to_string(),
            x: axis(predictor),
            y: axis(response),
            layers: below,
        },
    ]
}

fn pairs(x: &[f64], y: &[f64]) -> Vec<[f64; 2]> {
    x.iter().zip(y).map(|(x, y)| [*x, *y]).collect()
}

/// The results of a series with what they may be off, and limits of tolerance that all rows have in common.
pub(super) fn series(rows: &[Report<'_>]) -> Vec<Plot> {
    let Some(first) = rows.first() else {
        return Vec::new();
    };
    let l = first.language;
    let measurands = 0..first.evaluation.results.len().min(MOST_MEASURANDS);
    let plot = |m: usize| {
        let (name, unit) = first.measurand(m);
        let (mut values, mut bars) = (Vec::new(), Vec::new());
        for (row, at) in rows.iter().zip(1u32..) {
            let figures = Figures::new(row, m);
            let (x, y) = (f64::from(at), figures.reported.estimate);
            values.push([x, y]);
            let half = figures.reported.half_width();
            bars.push([x, y - half, y + half]);
        }
        let limits_of = |row: &Report<'_>| -> Vec<f64> {
            let of = row.budget.conformity.iter().filter(|c| c.measurand == m);
            of.flat_map(|c| [c.tolerance.lower, c.tolerance.upper])
                .filter(|limit| limit.is_finite())
                .collect()
        };
        let limits = limits_of(first);
        let mut layers = Vec::new();
        if rows.iter().all(|row| limits_of(row) == limits) {
            let levels = limits.iter();
            layers.extend(levels.map(|y| Layer::new("", Tone::Contrast, Marks::Level(*y))));
        }
        layers.push(Layer::new("±U", Tone::Quiet, Marks::Whiskers(bars)));
        layers.push(Layer::new(name, Tone::Main, Marks::Points(values)));
        let panel = Panel {
            title: say!("{name} with U").in_language(l),
            x: Axis::linear(l.pick("row", "行"), ""),
            y: Axis::linear(name, symbol(unit)),
            layers,
        };
        Plot::new(&format!("series_{name}"), vec![panel])
    };
    measurands.map(plot).collect()
}
