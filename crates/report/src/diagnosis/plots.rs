//! Residual plots as SVG: before and after, over the time or the rows and over each stimulus.

use std::fmt::Write;

use nalgebra::DVector;

use crate::diagnose::Diagnosis;
use crate::diagnose::case::{Case, Role};
use crate::language::Language;
use crate::number::{in_unit, significant};
use crate::symbol;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 260.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 44.0;
const BEFORE: &str = "#c0392b";
const AFTER: &str = "#1f618d";

/// Names of files and their contents.
pub fn plots(case: &Case, diagnosis: &Diagnosis, language: Language) -> Vec<(String, String)> {
    let mut axes: Vec<(String, String, Vec<f64>)> = Vec::new();
    let reduced = |numbers: &[f64]| -> Vec<f64> {
        let mean = |rows: &Vec<usize>| {
            rows.iter().map(|row| numbers[*row]).sum::<f64>() / rows.len() as f64
        };
        diagnosis.blocks.iter().map(mean).collect()
    };
    for column in &case.columns {
        let shown = matches!(
            column.role,
            Role::Time | Role::Order | Role::Stimulus | Role::Angle | Role::Covariate
        );
        if let (true, Some(numbers)) = (shown, column.numbers()) {
            axes.push((
                column.name.clone(),
                in_unit(&column.name, &symbol(&column.unit)),
                reduced(numbers),
            ));
        }
    }
    if case.with_role(Role::Time).next().is_none() {
        let numbers: Vec<f64> = (1..=case.rows).map(|row| row as f64).collect();
        axes.insert(
            0,
            (
                "row".into(),
                language.pick("row", "行").into(),
                reduced(&numbers),
            ),
        );
    }
    axes.into_iter()
        .map(|(file, label, x)| {
            (
                format!("residuals_{}.svg", safe(&file)),
                figure(case, diagnosis, &label, &x, language),
            )
        })
        .collect()
}

/// A name for a file.
fn safe(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_alphanumeric() { c } else { '_' })
        .collect()
}

/// The panels of one figure, one below the other: responses, each before and after.
fn figure(
    case: &Case,
    diagnosis: &Diagnosis,
    label: &str,
    x: &[f64],
    language: Language,
) -> String {
    let mut panels = Vec::new();
    for (response, declared) in case.responses.iter().enumerate() {
        let own = |residuals: &DVector<f64>| {
            residuals
                .rows(response * x.len(), x.len())
                .iter()
                .copied()
                .collect::<Vec<f64>>()
        };
        let unit = symbol(&declared.unit);
        let title = |which: &str| in_unit(&format!("{}: {which}", declared.name), &unit);
        let before = language.pick("residuals of the declared model", "声明的模型的残差");
        panels.push(panel(
            &title(before),
            label,
            x,
            &own(&diagnosis.residuals),
            BEFORE,
        ));
        if let Some(adopted) = &diagnosis.adopted {
            let after = language.pick(
                "residuals with the physics in the model",
                "加入遗漏效应后的残差",
            );
            panels.push(panel(
                &title(after),
                label,
                x,
                &own(&adopted.residuals),
                AFTER,
            ));
        }
    }
    let height = HEIGHT * panels.len() as f64;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (at, panel) in panels.iter().enumerate() {
        let _ = writeln!(
            svg,
            "<g transform=\"translate(0 {})\">\n{panel}</g>",
            HEIGHT * at as f64
        );
    }
    svg + "</svg>\n"
}

fn panel(title: &str, label: &str, x: &[f64], y: &[f64], colour: &str) -> String {
    let (x_low, x_high) = limits(x);
    let (y_low, y_high) = limits(y);
    let place_x = |value: f64| LEFT + (value - x_low) / (x_high - x_low) * (WIDTH - LEFT - RIGHT);
    let place_y =
        |value: f64| HEIGHT - BOTTOM - (value - y_low) / (y_high - y_low) * (HEIGHT - TOP - BOTTOM);
    let mut out = String::new();
    let _ = writeln!(
        out,
        "<text x=\"{LEFT}\" y=\"20\" font-weight=\"bold\">{}</text>",
        escaped(title)
    );
    let _ = writeln!(
        out,
        "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888\"/>",
        WIDTH - LEFT - RIGHT,
        HEIGHT - TOP - BOTTOM
    );
    for (tick, written) in ticks(x_low, x_high) {
        let at = place_x(tick);
        let _ = writeln!(
            out,
            "<line x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{0:.1}\" y2=\"{1:.1}\" stroke=\"#888\"/><text x=\"{at:.1}\" y=\"{2:.1}\" text-anchor=\"middle\">{3}</text>",
            HEIGHT - BOTTOM,
            HEIGHT - BOTTOM + 4.0,
            HEIGHT - BOTTOM + 17.0,
            written
        );
    }
    for (tick, written) in ticks(y_low, y_high) {
        let at = place_y(tick);
        let _ = writeln!(
            out,
            "<line x1=\"{LEFT}\" x2=\"{0}\" y1=\"{at:.1}\" y2=\"{at:.1}\" stroke=\"#ddd\"/><text x=\"{1}\" y=\"{2:.1}\" text-anchor=\"end\">{3}</text>",
            WIDTH - RIGHT,
            LEFT - 6.0,
            at + 4.0,
            written
        );
    }
    let zero = place_y(0.0);
    let _ = writeln!(
        out,
        "<line x1=\"{LEFT}\" x2=\"{}\" y1=\"{zero:.1}\" y2=\"{zero:.1}\" stroke=\"#444\" stroke-dasharray=\"4 3\"/>",
        WIDTH - RIGHT
    );
    for (x, y) in x.iter().zip(y) {
        let _ = writeln!(
            out,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.4\" fill=\"{colour}\" fill-opacity=\"0.7\"/>",
            place_x(*x),
            place_y(*y)
        );
    }
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
        (LEFT + WIDTH - RIGHT) / 2.0,
        HEIGHT - 8.0,
        escaped(label)
    );
    out
}

/// A little more than the range; zero is inside for residuals, whose range has both signs.
fn limits(values: &[f64]) -> (f64, f64) {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let margin = if high > low {
        0.05 * (high - low)
    } else {
        0.5 * high.abs().max(1.0)
    };
    (low - margin, high + margin)
}

/// Round numbers inside the limits, four to eight of them, with their labels.
fn ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let rough = (high - low) / 5.0;
    let decade = libm::pow(10.0, libm::log10(rough).floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|m| m * decade)
        .into_iter()
        .find(|step| *step >= rough)
        .unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last)
        .map(|k| k as f64 * step)
        .map(|tick| (tick, tick_label(tick, step)))
        .collect()
}

/// A multiple of the step with no more digits than the step needs.
fn tick_label(tick: f64, step: f64) -> String {
    let exponent = |x: f64| libm::log10(x.abs()).floor() as i32;
    let last_place = exponent(step * (1.0 + 1e-9));
    if tick == 0.0 {
        "0".to_owned()
    } else if tick.abs() < 1e5 && last_place >= -5 {
        let decimals = usize::try_from(-last_place).unwrap_or(0);
        format!("{tick:.decimals$}")
    } else {
        let digits = exponent(tick * (1.0 + 1e-9)) - last_place + 1;
        raised(&significant(tick, u8::try_from(digits).unwrap_or(1).max(1)))
    }
}

/// A power of ten as it is printed in a figure: `1×10⁶`.
fn raised(text: &str) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let Some((number, exponent)) = text.split_once('^') else {
        return text.to_owned();
    };
    let exponent = exponent.chars().map(|c| match c.to_digit(10) {
        Some(digit) => RAISED[digit as usize],
        None => '⁻',
    });
    number.chars().chain(exponent).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
