//! A plot as lines of characters: enough to see where things lie.

use unicode_width::UnicodeWidthStr;

use crate::document::{Axis, Layer, Marks, Panel, Plot, Scale, Tone};

/// Lines of a panel between its axes.
const HEIGHT: usize = 12;
const NARROWEST: usize = 20;
const WIDEST: usize = 72;

/// Panels one below the other, a blank line between.
pub(in crate::render) fn lines(plot: &Plot, width: usize) -> Vec<String> {
    let panels = plot.panels.iter().map(|panel| drawn(panel, width));
    panels.collect::<Vec<_>>().join(&[String::new()][..])
}

/// Characters in a rectangle, the top line first.
struct Grid {
    cells: Vec<Vec<char>>,
    width: usize,
    limits: [[f64; 2]; 2],
}

/// A line for each bar, on one scale.
fn bars(panel: &Panel, page: usize) -> Vec<String> {
    const WIDEST_NAME: usize = 36;
    let names = panel.bars().map(|bar| bar.name.width());
    let names = names.max().unwrap_or(0).min(WIDEST_NAME);
    let width = page.saturating_sub(names + 8).clamp(NARROWEST, WIDEST);
    let [limits, _] = panel.limits();
    let mut lines = vec![format!("  {}", panel.title)];
    for group in panel.groups() {
        for (at, (layer, bar)) in group.into_iter().enumerate() {
            let (Some(from), Some(to)) = (panel.x.place(bar.from), panel.x.place(bar.to)) else {
                continue;
            };
            let [from, to] = [from, to].map(|place| nearest(place, limits, width));
            let (start, end) = (from.min(to), from.max(to));
            let sign = if to < from { '-' } else { sign(layer) };
            let name = if at == 0 { bar.name.as_str() } else { "" };
            let space = " ".repeat(names.saturating_sub(name.width()));
            let drawn = sign.to_string().repeat((end - start).max(1));
            lines.push(format!("  {name}{space} |{}{drawn}", " ".repeat(start)));
        }
    }
    let [left, right] = edges(&panel.x, limits);
    let name = panel.x.label();
    let space = width.saturating_sub(left.width() + name.width() + right.width());
    let (before, after) = (
        " ".repeat((space / 2).max(1)),
        " ".repeat((space - space / 2).max(1)),
    );
    lines.push(format!("  {} +{}", " ".repeat(names), "-".repeat(width)));
    let blank = " ".repeat(names + 3);
    lines.push(format!("{blank} {left}{before}{name}{after}{right}"));
    if panel.layers.len() > 1 {
        lines.extend(legend(panel, &blank));
    }
    lines
}

/// What each sign stands for.
fn legend(panel: &Panel, blank: &str) -> Vec<String> {
    let named = panel.layers.iter().filter(|layer| !layer.name.is_empty());
    named
        .map(|layer| format!("{blank} {} {}", sign(layer), layer.name))
        .collect()
}

fn drawn(panel: &Panel, page: usize) -> Vec<String> {
    if panel.bars().next().is_some() {
        return bars(panel, page);
    }
    let limits = panel.limits();
    let [low, high] = edges(&panel.y, limits[1]);
    let margin = low.width().max(high.width());
    let width = page.saturating_sub(margin + 6).clamp(NARROWEST, WIDEST);
    let mut grid = Grid {
        cells: vec![vec![' '; width]; HEIGHT],
        width,
        limits,
    };
    for layer in &panel.layers {
        grid.draw(panel, layer);
    }
    let mut lines = vec![format!("  {}", panel.title)];
    lines.push(format!("  {}", panel.y.label()));
    for (h, row) in grid.cells.iter().enumerate() {
        let label = match h {
            0 => high.as_str(),
            _ if h + 1 == HEIGHT => low.as_str(),
            _ => "",
        };
        let row: String = row.iter().collect();
        lines.push(format!("  {label:>margin$} |{row}").trim_end().to_string());
    }
    let blank = " ".repeat(margin + 3);
    lines.push(format!("{blank}+{}", "-".repeat(width)));
    let [left, right] = edges(&panel.x, limits[0]);
    let name = panel.x.label();
    let space = width.saturating_sub(left.width() + name.width() + right.width());
    let (before, after) = (
        " ".repeat((space / 2).max(1)),
        " ".repeat((space - space / 2).max(1)),
    );
    lines.push(format!("{blank} {left}{before}{name}{after}{right}"));
    lines.extend(legend(panel, &blank));
    lines
}

/// The character of a layer.
fn sign(layer: &Layer) -> char {
    match (&layer.marks, layer.tone) {
        (Marks::Band(_), _) => ':',
        (Marks::Upright(_) | Marks::Whiskers(_), _) => '|',
        (Marks::Bars(_), Tone::Main) => '=',
        (Marks::Bars(_), _) => '~',
        (Marks::Level(_), _) => '-',
        (Marks::Line(_), Tone::Quiet) => '.',
        (Marks::Line(_), _) => '*',
        (Marks::Points(_), Tone::Contrast) => 'x',
        (Marks::Points(_), _) => 'o',
    }
}

impl Grid {
    fn draw(&mut self, panel: &Panel, layer: &Layer) {
        let sign = sign(layer);
        match &layer.marks {
            Marks::Points(points) => {
                for [x, y] in points {
                    if let Some((x, y)) = panel.x.place(*x).zip(panel.y.place(*y)) {
                        self.set(self.column(x), self.row(y), sign);
                    }
                }
            }
            Marks::Line(points) => {
                let path = points.iter().map(|[x, y]| [*x, *y, *y]).collect::<Vec<_>>();
                self.fill(panel, &path, sign);
            }
            Marks::Band(band) => self.fill(panel, band, sign),
            Marks::Whiskers(bars) => {
                for bar in bars {
                    self.fill(panel, &[*bar, *bar], sign);
                }
            }
            Marks::Upright(x) => {
                if let Some(x) = panel.x.place(*x) {
                    (0..HEIGHT).for_each(|row| self.set(self.column(x), row, sign));
                }
            }
            Marks::Bars(_) => {}
            Marks::Level(y) => {
                if let Some(y) = panel.y.place(*y) {
                    (0..self.width).for_each(|column| self.set(column, self.row(y), sign));
                }
            }
        }
    }

    /// Fills what lies between the lower and the upper curve, column by column.
    fn fill(&mut self, panel: &Panel, band: &[[f64; 3]], sign: char) {
        let place = |[x, low, high]: &[f64; 3]| {
            Some([
                panel.x.place(*x)?,
                panel.y.place(*low)?,
                panel.y.place(*high)?,
            ])
        };
        let places: Vec<[f64; 3]> = band.iter().filter_map(place).collect();
        for pair in places.windows(2) {
            let [from, to] = [self.column(pair[0][0]), self.column(pair[1][0])];
            for column in from.min(to)..=from.max(to) {
                let part = match to.abs_diff(from) {
                    0 => 0.0,
                    all => column.abs_diff(from) as f64 / all as f64,
                };
                let between = |i: usize| pair[0][i] + part * (pair[1][i] - pair[0][i]);
                let (top, bottom) = (self.row(between(2)), self.row(between(1)));
                (top..=bottom).for_each(|row| self.set(column, row, sign));
            }
        }
    }

    fn set(&mut self, column: usize, row: usize, sign: char) {
        if let Some(cell) = self.cells.get_mut(row).and_then(|row| row.get_mut(column)) {
            *cell = sign;
        }
    }

    fn column(&self, x: f64) -> usize {
        nearest(x, self.limits[0], self.width)
    }

    fn row(&self, y: f64) -> usize {
        HEIGHT - 1 - nearest(y, self.limits[1], HEIGHT).min(HEIGHT - 1)
    }
}

/// The nearest of `count` places between the limits.
fn nearest(place: f64, [low, high]: [f64; 2], count: usize) -> usize {
    ((place - low) / (high - low) * (count - 1) as f64).round() as usize
}

/// The values at both edges, with the digits that matter, and those that tell one from the other.
fn edges(axis: &Axis, [low, high]: [f64; 2]) -> [String; 2] {
    let value = |place: f64| match axis.scale {
        Scale::Linear => place,
        Scale::Logarithmic => libm::pow(10.0, place),
    };
    let [low, high] = [value(low), value(high)];
    let line = (high - low).abs() / (2 * HEIGHT) as f64;
    [low, high].map(|value| label(value, line))
}

/// A value to a part of a line.
fn label(value: f64, line: f64) -> String {
    let places = |unit: f64| match -libm::floor(libm::log10(line / unit)) {
        places if places.is_finite() => places.clamp(0.0, 15.0) as usize,
        _ => 0,
    };
    match value.abs() {
        0.0 => "0".to_string(),
        size if !(1e-3..1e5).contains(&size) => {
            let of_one = libm::exp10(libm::floor(libm::log10(size)));
            format!("{value:.*e}", places(of_one).max(1))
        }
        size if size >= 100.0 => format!("{value:.*}", places(1.0)),
        size if size >= 1.0 => format!("{value:.*}", places(1.0).max(2)),
        _ => format!("{value:.*}", places(1.0).max(4)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_told_apart() {
        let axis = Axis {
            quantity: "R".into(),
            unit: String::new(),
            scale: Scale::Linear,
        };
        let of = |limits| edges(&axis, limits);
        assert_eq!(of([9.9965, 10.0045]), ["9.9965", "10.0045"]);
        assert_eq!(of([120_000.0, 120_010.0]), ["1.200000e5", "1.200100e5"]);
        assert_eq!(of([0.0, 40.0]), ["0", "40.00"]);
        assert_eq!(of([-3.0, 250.0]), ["-3.00", "250"]);
    }
}
