//! A plot as SVG: its panels one below the other.

use std::fmt::Write;

use crate::document::{Bar, Layer, Marks, Panel, Plot, Scale, Tone};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 260.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 44.0;

/// A plot as the text of an SVG file.
pub fn svg(plot: &Plot) -> String {
    let heights: Vec<f64> = plot
        .panels
        .iter()
        .map(|panel| Frame::new(panel).height)
        .collect();
    let height: f64 = heights.iter().sum();
    let titles: Vec<String> = plot.panels.iter().map(|p| escaped(&p.title)).collect();
    let titles = titles.join("; ");
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{titles}\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    let mut top = 0.0;
    for (panel, height) in plot.panels.iter().zip(heights) {
        let drawn = Frame::new(panel).drawn();
        let _ = writeln!(svg, "<g transform=\"translate(0 {top})\">\n{drawn}</g>");
        top += height;
    }
    svg + "</svg>\n"
}

/// A panel with the limits of its axes, in places.
struct Frame<'a> {
    panel: &'a Panel,
    x: [f64; 2],
    y: [f64; 2],
    /// Left edge of the axes: names of bars need room.
    left: f64,
    height: f64,
    out: String,
}

impl<'a> Frame<'a> {
    fn new(panel: &'a Panel) -> Self {
        let [x, y] = panel.limits();
        let bars = panel.bars().count() as f64;
        if bars == 0.0 {
            return Frame {
                panel,
                x,
                y,
                left: LEFT,
                height: HEIGHT,
                out: String::new(),
            };
        }
        /// A bar with the space to the next.
        const LINE: f64 = 22.0;
        const WIDEST_NAME: f64 = 300.0;
        let widest = panel.bars().map(|bar| width(&bar.name)).fold(0.0, f64::max);
        Frame {
            panel,
            // Bars begin at an edge, where they begin at zero.
            x: match x[0] < 0.0 && panel.bars().all(|bar| bar.from.min(bar.to) >= 0.0) {
                true => [0.0, x[1]],
                false => x,
            },
            y: [bars - 0.5, -0.5],
            left: (widest.min(WIDEST_NAME) + 12.0).max(LEFT),
            height: TOP + BOTTOM + LINE * bars,
            out: String::new(),
        }
    }

    fn drawn(mut self) -> String {
        self.axes();
        for layer in &self.panel.layers {
            self.layer(layer);
        }
        self.legend();
        let label = escaped(&self.panel.x.label());
        self.line(format_args!(
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
            (self.left + WIDTH - RIGHT) / 2.0,
            self.height - 8.0
        ));
        self.out
    }

    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        let _ = writeln!(self.out, "{line}");
    }

    fn axes(&mut self) {
        let left = self.left;
        let title = match self.panel.y.label() {
            none if none.is_empty() => self.panel.title.clone(),
            label => format!("{}: {label}", self.panel.title),
        };
        self.line(format_args!(
            "<text x=\"{left}\" y=\"20\" font-weight=\"bold\">{}</text>",
            escaped(&title)
        ));
        self.line(format_args!(
            "<rect x=\"{left}\" y=\"{TOP}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888\"/>",
            WIDTH - self.left - RIGHT,
            self.height - TOP - BOTTOM
        ));
        for (tick, written) in ticks(self.x, self.panel.x.scale) {
            let at = self.across(tick);
            self.line(format_args!(
                "<line x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{0:.1}\" y2=\"{1:.1}\" stroke=\"#888\"/><text x=\"{at:.1}\" y=\"{2:.1}\" text-anchor=\"middle\">{written}</text>",
                self.height - BOTTOM,
                self.height - BOTTOM + 4.0,
                self.height - BOTTOM + 17.0,
            ));
        }
        if self.panel.bars().count() > 0 {
            return;
        }
        for (tick, written) in ticks(self.y, self.panel.y.scale) {
            let at = self.up(tick);
            self.line(format_args!(
                "<line x1=\"{left}\" x2=\"{0}\" y1=\"{at:.1}\" y2=\"{at:.1}\" stroke=\"#ddd\"/><text x=\"{1}\" y=\"{2:.1}\" text-anchor=\"end\">{written}</text>",
                WIDTH - RIGHT,
                self.left - 6.0,
                at + 4.0,
            ));
        }
    }

    fn layer(&mut self, layer: &Layer) {
        let left = self.left;
        let look = Look::of(layer.tone);
        match &layer.marks {
            Marks::Points(points) => {
                for (x, y) in self.points(points) {
                    self.line(format_args!("{}", look.point(x, y)));
                }
            }
            Marks::Line(points) => {
                let (path, stroke) = (self.path(points), look.stroke());
                self.line(format_args!(
                    "<polyline points=\"{path}\" fill=\"none\" {stroke}/>"
                ));
            }
            Marks::Band(band) => {
                let low = band.iter().map(|[x, low, _]| [*x, *low]);
                let high = band.iter().rev().map(|[x, _, high]| [*x, *high]);
                let path = self.path(&low.chain(high).collect::<Vec<_>>());
                self.line(format_args!(
                    "<polygon points=\"{path}\" fill=\"{}\" fill-opacity=\"0.2\"/>",
                    look.colour
                ));
            }
            Marks::Whiskers(bars) => {
                for [x, low, high] in bars {
                    let ends = self.points(&[[*x, *low], [*x, *high]]);
                    let [(x, low), (_, high)] = ends.as_slice() else {
                        continue;
                    };
                    let (before, after) = (x - 4.0, x + 4.0);
                    self.line(format_args!(
                        "<path d=\"M{before:.1} {low:.1}H{after:.1}M{x:.1} {low:.1}V{high:.1}M{before:.1} {high:.1}H{after:.1}\" fill=\"none\" {}/>",
                        look.stroke()
                    ));
                }
            }
            Marks::Upright(x) => {
                let Some(x) = self.panel.x.place(*x).map(|x| self.across(x)) else {
                    return;
                };
                self.line(format_args!(
                    "<line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{TOP}\" y2=\"{:.1}\" {}/>",
                    self.height - BOTTOM,
                    look.stroke()
                ));
            }
            Marks::Bars(bars) => {
                for (at, bar) in bars.iter().enumerate() {
                    self.bar(at, bar, &look);
                }
            }
            Marks::Level(y) => {
                let Some(y) = self.panel.y.place(*y).map(|y| self.up(y)) else {
                    return;
                };
                self.line(format_args!(
                    "<line x1=\"{left}\" x2=\"{}\" y1=\"{y:.1}\" y2=\"{y:.1}\" {}/>",
                    WIDTH - RIGHT,
                    look.stroke()
                ));
            }
        }
    }

    /// A bar with its name at the left edge; one that goes back is hatched by its paler ground.
    fn bar(&mut self, at: usize, bar: &Bar, look: &Look) {
        let (Some(from), Some(to)) = (self.panel.x.place(bar.from), self.panel.x.place(bar.to))
        else {
            return;
        };
        let (from, to, y) = (self.across(from), self.across(to), self.up(at as f64));
        let (left, name) = (self.left - 6.0, escaped(&bar.name));
        let fill = if to < from { 0.25 } else { 0.75 };
        let (colour, start, length) = (look.colour, from.min(to), (to - from).abs().max(0.5));
        let (line, top) = (y + 4.0, y - 7.0);
        self.line(format_args!(
            "<text x=\"{left:.1}\" y=\"{line:.1}\" text-anchor=\"end\">{name}</text><rect x=\"{start:.1}\" y=\"{top:.1}\" width=\"{length:.1}\" height=\"14\" fill=\"{colour}\" fill-opacity=\"{fill}\" stroke=\"{colour}\"/>"
        ));
    }

    /// What the marks stand for, above the panel at its right end; one kind of marks needs no words.
    fn legend(&mut self) {
        const SAMPLE: f64 = 22.0;
        let named = self
            .panel
            .layers
            .iter()
            .filter(|layer| !layer.name.is_empty());
        let named: Vec<&Layer> = named.collect();
        if named.len() < 2 {
            return;
        }
        let mut right = WIDTH - RIGHT;
        for layer in named.into_iter().rev() {
            let look = Look::of(layer.tone);
            let width = width(&layer.name);
            let (text, left) = (right - width, right - width - SAMPLE - 4.0);
            let sample = match &layer.marks {
                Marks::Points(_) => look.point(left + SAMPLE / 2.0, 16.0),
                Marks::Line(_) | Marks::Level(_) | Marks::Upright(_) | Marks::Whiskers(_) => {
                    format!(
                        "<line x1=\"{left:.1}\" x2=\"{:.1}\" y1=\"16\" y2=\"16\" {}/>",
                        left + SAMPLE,
                        look.stroke()
                    )
                }
                Marks::Band(_) | Marks::Bars(_) => format!(
                    "<rect x=\"{left:.1}\" y=\"11\" width=\"{SAMPLE}\" height=\"10\" fill=\"{}\" fill-opacity=\"0.2\"/>",
                    look.colour
                ),
            };
            let name = escaped(&layer.name);
            self.line(format_args!(
                "{sample}<text x=\"{text:.1}\" y=\"20\" textLength=\"{width:.1}\" lengthAdjust=\"spacingAndGlyphs\">{name}</text>"
            ));
            right = left - 12.0;
        }
    }

    fn path(&self, points: &[[f64; 2]]) -> String {
        let points = self.points(points).into_iter();
        let points = points.map(|(x, y)| format!("{x:.1},{y:.1}"));
        points.collect::<Vec<_>>().join(" ")
    }

    /// The points that have a place.
    fn points(&self, points: &[[f64; 2]]) -> Vec<(f64, f64)> {
        let axes = self.panel;
        let places = points
            .iter()
            .filter_map(|[x, y]| axes.x.place(*x).zip(axes.y.place(*y)));
        places.map(|(x, y)| (self.across(x), self.up(y))).collect()
    }

    fn across(&self, place: f64) -> f64 {
        self.left + (place - self.x[0]) / (self.x[1] - self.x[0]) * (WIDTH - self.left - RIGHT)
    }

    fn up(&self, place: f64) -> f64 {
        let share = (place - self.y[0]) / (self.y[1] - self.y[0]);
        self.height - BOTTOM - share * (self.height - TOP - BOTTOM)
    }
}

/// Room that a text takes.
fn width(text: &str) -> f64 {
    /// That of one letter of the Latin alphabet; a Chinese one takes twice as much.
    const LETTER: f64 = 6.5;
    LETTER * unicode_width::UnicodeWidthStr::width(text) as f64
}

/// How marks of a tone look: told apart by shape and dashes as well as by colour, in grey print too. The colours are
/// Okabe and Ito's blue and vermilion, which differ for colour-blind readers.
struct Look {
    colour: &'static str,
    dashes: &'static str,
    tone: Tone,
}

impl Look {
    fn of(tone: Tone) -> Self {
        let (colour, dashes) = match tone {
            Tone::Main => ("#0072b2", "none"),
            Tone::Contrast => ("#d55e00", "7 3"),
            Tone::Quiet => ("#444", "2 3"),
        };
        Look {
            colour,
            dashes,
            tone,
        }
    }

    fn stroke(&self) -> String {
        let Look { colour, dashes, .. } = self;
        format!("stroke=\"{colour}\" stroke-width=\"1.5\" stroke-dasharray=\"{dashes}\"")
    }

    /// A disc, a hollow diamond, or a dot.
    fn point(&self, x: f64, y: f64) -> String {
        let colour = self.colour;
        match self.tone {
            Tone::Main => format!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.4\" fill=\"{colour}\" fill-opacity=\"0.7\"/>"
            ),
            Tone::Contrast => format!(
                "<path d=\"M{x:.1} {:.1}l3.2 3.2l-3.2 3.2l-3.2 -3.2z\" fill=\"none\" stroke=\"{colour}\"/>",
                y - 3.2
            ),
            Tone::Quiet => {
                format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"1.4\" fill=\"{colour}\"/>")
            }
        }
    }
}

/// Places inside the limits with their labels: four to eight round numbers, or powers of ten.
fn ticks([low, high]: [f64; 2], scale: Scale) -> Vec<(f64, String)> {
    /// Fewer powers of ten need numbers between them, which a linear scale of places would not give.
    const POWERS: f64 = 8.0;
    let rough = (high - low) / 5.0;
    let decade = libm::pow(10.0, libm::log10(rough).floor());
    let step = match scale {
        Scale::Logarithmic => ((high - low) / POWERS).ceil(),
        Scale::Linear => [1.0, 2.0, 5.0, 10.0]
            .map(|m| m * decade)
            .into_iter()
            .find(|step| *step >= rough)
            .unwrap_or(rough),
    };
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    let places = (first..=last).map(|k| k as f64 * step);
    places
        .map(|tick| match scale {
            Scale::Linear => (tick, tick_label(tick, step)),
            Scale::Logarithmic => (tick, raised("10", tick as i32)),
        })
        .collect()
}

/// A multiple of the step with no more digits than the step needs.
fn tick_label(tick: f64, step: f64) -> String {
    let exponent = |x: f64| libm::log10(x.abs() * (1.0 + 1e-9)).floor() as i32;
    let last_place = exponent(step);
    if tick == 0.0 {
        "0".to_owned()
    } else if tick.abs() < 1e5 && last_place >= -5 {
        let decimals = usize::try_from(-last_place).unwrap_or(0);
        format!("{tick:.decimals$}")
    } else {
        let power = exponent(tick);
        let digits = usize::try_from(power - last_place).unwrap_or(0);
        let mantissa = tick / libm::pow(10.0, f64::from(power));
        raised(&format!("{mantissa:.digits$}×10"), power)
    }
}

/// A power as it is printed in a figure: `1×10⁶`.
fn raised(base: &str, exponent: i32) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let exponent = exponent.to_string();
    let raised = exponent.chars().map(|c| match c.to_digit(10) {
        Some(digit) => RAISED[digit as usize],
        None => '⁻',
    });
    base.chars().chain(raised).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
