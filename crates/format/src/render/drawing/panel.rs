//! One pair of axes with what is drawn in it: title, quantity and legend above, numbers and quantity below.

use super::ticks::ticks;
use super::{Anchor, Colour, Fill, Point, SIZE, Shape, Step, Stroke, WIDTH, letters, rectangle};
use crate::document::{Bar, Layer, Marks, Panel, Tone};

/// Height of the axes of a panel without bars.
const HEIGHT: f64 = 184.0;
/// Room left of the axes, for numbers.
const LEFT: f64 = 84.0;
const RIGHT: f64 = 16.0;
const BOTTOM: f64 = 48.0;
/// From line to line.
const LINE: f64 = 17.0;
/// A bar, and the space to the next.
const BAR: f64 = 14.0;
const BETWEEN: f64 = 8.0;
/// The mark beside a word of the legend.
const SAMPLE: f64 = 22.0;
/// Between the entries of a legend.
const APART: f64 = 14.0;

const FRAME: Colour = [0x88, 0x88, 0x88];
const GRID: Colour = [0xdd, 0xdd, 0xdd];

/// Draws a panel below `above`; says where it ends.
pub(super) fn draw(panel: &Panel, above: f64, shapes: &mut Vec<Shape>) -> f64 {
    let mut frame = Frame::new(panel, above, shapes);
    frame.head(above);
    frame.axes();
    for layer in &panel.layers {
        frame.layer(layer);
    }
    frame.bars();
    frame.bottom + BOTTOM
}

/// A panel with the limits of its axes, in places and in pixels.
struct Frame<'a> {
    panel: &'a Panel,
    x: [f64; 2],
    y: [f64; 2],
    groups: Vec<Vec<(&'a Layer, &'a Bar)>>,
    /// Edges of the axes; the names of bars need room at the left.
    left: f64,
    top: f64,
    bottom: f64,
    shapes: &'a mut Vec<Shape>,
}

/// What stands above the axes.
struct Head<'a> {
    title: Vec<String>,
    /// The quantity upwards.
    quantity: Vec<String>,
    /// Whether the legend begins beside the last line of the quantity.
    shared: bool,
    legend: Vec<Vec<&'a Layer>>,
}

impl Head<'_> {
    fn lines(&self) -> usize {
        let all = self.title.len() + self.quantity.len() + self.legend.len();
        all - usize::from(self.shared)
    }
}

fn head(panel: &Panel, room: f64) -> Head<'_> {
    let named = panel.layers.iter().filter(|layer| !layer.name.is_empty());
    let named: Vec<&Layer> = named.collect();
    let mut legend: Vec<Vec<&Layer>> = Vec::new();
    // One kind of marks needs no words.
    if named.len() > 1 {
        for layer in named {
            match legend.last_mut() {
                Some(row) if length(row) + APART + length(&[layer]) <= room => row.push(layer),
                _ => legend.push(vec![layer]),
            }
        }
    }
    let quantity = match panel.y.label() {
        none if none.is_empty() => Vec::new(),
        label => letters::lines(&label, room / SIZE, false),
    };
    let last = quantity.last().zip(legend.first());
    Head {
        title: letters::lines(&panel.title, room / SIZE, true),
        shared: last.is_some_and(|(words, row)| wide(words) + 2.0 * APART + length(row) <= room),
        quantity,
        legend,
    }
}

/// Room that entries of a legend take beside each other.
fn length(row: &[&Layer]) -> f64 {
    let entries = row.iter().map(|layer| SAMPLE + 5.0 + wide(&layer.name));
    entries.sum::<f64>() + APART * row.len().saturating_sub(1) as f64
}

/// Room that a group of bars takes.
fn thick(group: &[(&Layer, &Bar)]) -> f64 {
    BAR * group.len() as f64 + BETWEEN
}

/// Room that words take.
fn wide(words: &str) -> f64 {
    SIZE * letters::width(words, false)
}

impl<'a> Frame<'a> {
    fn new(panel: &'a Panel, above: f64, shapes: &'a mut Vec<Shape>) -> Self {
        const WIDEST_NAME: f64 = 300.0;
        let [x, y] = panel.limits();
        let groups = panel.groups();
        let names = panel.bars().map(|bar| wide(&bar.name));
        let numbers = ticks(y, panel.y.scale).into_iter();
        let numbers = numbers.map(|(_, number)| wide(&number));
        let (widest, height) = match groups.is_empty() {
            false => (
                names.fold(0.0, f64::max),
                groups.iter().map(|group| thick(group)).sum(),
            ),
            true => (numbers.fold(0.0, f64::max), HEIGHT),
        };
        let left = (widest.min(WIDEST_NAME) + 12.0).max(LEFT);
        let lines = head(panel, WIDTH - left - RIGHT).lines() as f64;
        let top = above + LINE * lines + 12.0;
        let from_zero = x[0] < 0.0 && panel.bars().all(|bar| bar.from.min(bar.to) >= 0.0);
        Frame {
            panel,
            // Bars begin at an edge, where they begin at zero.
            x: match !groups.is_empty() && from_zero {
                true => [0.0, x[1]],
                false => x,
            },
            y,
            groups,
            left,
            top,
            bottom: top + height,
            shapes,
        }
    }

    fn right(&self) -> f64 {
        WIDTH - RIGHT
    }

    fn head(&mut self, above: f64) {
        let (panel, left) = (self.panel, self.left);
        let head = head(panel, self.right() - left);
        let mut y = above + 2.0;
        for (lines, bold) in [(&head.title, true), (&head.quantity, false)] {
            for line in lines {
                y += LINE;
                self.words([left, y], Anchor::Start, bold, line.clone());
            }
        }
        if head.shared {
            y -= LINE;
        }
        for row in &head.legend {
            y += LINE;
            let mut x = self.right() - length(row);
            for layer in row {
                self.sample(layer, [x, y - 4.0]);
                x += SAMPLE + 5.0;
                self.words([x, y], Anchor::Start, false, layer.name.clone());
                x += wide(&layer.name) + APART;
            }
        }
    }

    /// What marks look like, beside their name.
    fn sample(&mut self, layer: &Layer, [x, y]: Point) {
        let look = Look::of(layer.tone);
        let shape = match &layer.marks {
            Marks::Points(_) => look.point([x + SAMPLE / 2.0, y]),
            Marks::Line(_) | Marks::Level(_) | Marks::Upright(_) | Marks::Whiskers(_) => {
                look.line([[x, y], [x + SAMPLE, y]])
            }
            Marks::Band(_) => look.area(rectangle([x, y - 5.0], [SAMPLE, 10.0]), PALE),
            Marks::Bars(_) => look.area(rectangle([x, y - 5.0], [SAMPLE, 10.0]), look.ground()),
        };
        self.shapes.push(shape);
    }

    fn words(&mut self, at: Point, anchor: Anchor, bold: bool, words: String) {
        self.shapes.push(Shape::Words {
            at,
            anchor,
            bold,
            words,
        });
    }

    fn axes(&mut self) {
        let (left, right, top, bottom) = (self.left, self.right(), self.top, self.bottom);
        let thin = |colour| Stroke {
            colour,
            width: 1.0,
            dashes: None,
        };
        let line = |from, to, colour| Shape::Path {
            steps: vec![Step::Move(from), Step::Line(to)],
            fill: None,
            stroke: Some(thin(colour)),
        };
        if self.groups.is_empty() {
            for (tick, number) in ticks(self.y, self.panel.y.scale) {
                let y = self.up(tick);
                self.shapes.push(line([left, y], [right, y], GRID));
                self.words([left - 6.0, y + 4.0], Anchor::End, false, number);
            }
        }
        for (tick, number) in ticks(self.x, self.panel.x.scale) {
            let x = self.across(tick);
            self.shapes
                .push(line([x, bottom], [x, bottom + 4.0], FRAME));
            self.words([x, bottom + 17.0], Anchor::Middle, false, number);
        }
        self.shapes.push(Shape::Path {
            steps: rectangle([left, top], [right - left, bottom - top]),
            fill: None,
            stroke: Some(thin(FRAME)),
        });
        let label = letters::shortened(&self.panel.x.label(), (WIDTH - RIGHT) / SIZE, false);
        let room = wide(&label) / 2.0;
        let middle = (f64::midpoint(left, right))
            .min(WIDTH - RIGHT - room)
            .max(room);
        self.words([middle, bottom + 35.0], Anchor::Middle, false, label);
    }

    fn layer(&mut self, layer: &Layer) {
        let (left, right) = (self.left, self.right());
        let look = Look::of(layer.tone);
        match &layer.marks {
            Marks::Points(points) => {
                let points = self.points(points).into_iter();
                self.shapes.extend(points.map(|at| look.point(at)));
            }
            Marks::Line(points) => {
                let path = path(self.points(points));
                self.shapes.push(look.drawn(path));
            }
            Marks::Band(band) => {
                let low = band.iter().map(|[x, low, _]| [*x, *low]);
                let high = band.iter().rev().map(|[x, _, high]| [*x, *high]);
                let mut path = path(self.points(&low.chain(high).collect::<Vec<_>>()));
                path.push(Step::Close);
                self.shapes.push(Shape::Path {
                    steps: path,
                    fill: Some(look.fill(PALE)),
                    stroke: None,
                });
            }
            Marks::Whiskers(bars) => {
                for [x, low, high] in bars {
                    if let [low, high] = self.points(&[[*x, *low], [*x, *high]])[..] {
                        let end =
                            |[x, y]: Point| [Step::Move([x - 4.0, y]), Step::Line([x + 4.0, y])];
                        let upright = [Step::Move(low), Step::Line(high)];
                        let steps = [end(low), upright, end(high)].concat();
                        self.shapes.push(look.drawn(steps));
                    }
                }
            }
            Marks::Upright(x) => {
                if let Some(x) = self.panel.x.place(*x).map(|x| self.across(x)) {
                    let line = look.line([[x, self.top], [x, self.bottom]]);
                    self.shapes.push(line);
                }
            }
            Marks::Level(y) => {
                if let Some(y) = self.panel.y.place(*y).map(|y| self.up(y)) {
                    self.shapes.push(look.line([[left, y], [right, y]]));
                }
            }
            // Drawn group by group.
            Marks::Bars(_) => {}
        }
    }

    /// Bars, and the name of each group at the left edge.
    fn bars(&mut self) {
        let mut top = self.top;
        for group in std::mem::take(&mut self.groups) {
            let thick = thick(&group);
            let name = group.first().map_or("", |(_, bar)| bar.name.as_str());
            let name = letters::shortened(name, (self.left - 10.0) / SIZE, false);
            let middle = [self.left - 6.0, top + thick / 2.0 + 4.0];
            self.words(middle, Anchor::End, false, name);
            for (at, (layer, bar)) in group.into_iter().enumerate() {
                let above = top + BETWEEN / 2.0 + BAR * at as f64;
                self.bar(bar, above, &Look::of(layer.tone));
            }
            top += thick;
        }
    }

    /// A bar; one that goes back has a paler ground.
    fn bar(&mut self, bar: &Bar, above: f64, look: &Look) {
        let (Some(from), Some(to)) = (self.panel.x.place(bar.from), self.panel.x.place(bar.to))
        else {
            return;
        };
        let (from, to) = (self.across(from), self.across(to));
        let opacity = if to < from { PALE } else { look.ground() };
        let length = (to - from).abs().max(0.5);
        let bar = rectangle([from.min(to), above], [length, BAR]);
        self.shapes.push(look.area(bar, opacity));
    }

    /// The points that have a place.
    fn points(&self, points: &[[f64; 2]]) -> Vec<Point> {
        let axes = self.panel;
        let places = points
            .iter()
            .filter_map(|[x, y]| axes.x.place(*x).zip(axes.y.place(*y)));
        places.map(|(x, y)| [self.across(x), self.up(y)]).collect()
    }

    fn across(&self, place: f64) -> f64 {
        self.left + (place - self.x[0]) / (self.x[1] - self.x[0]) * (self.right() - self.left)
    }

    fn up(&self, place: f64) -> f64 {
        let share = (place - self.y[0]) / (self.y[1] - self.y[0]);
        self.bottom - share * (self.bottom - self.top)
    }
}

fn path(points: Vec<Point>) -> Vec<Step> {
    let steps = points.into_iter().enumerate();
    steps
        .map(|(at, point)| match at {
            0 => Step::Move(point),
            _ => Step::Line(point),
        })
        .collect()
}

/// Of areas: those that are seen through, and those that are not.
const PALE: f64 = 0.2;
const FULL: f64 = 0.75;

/// How marks of a tone look: told apart by shape and dashes as well as by colour, in grey print too. The colours are
/// Okabe and Ito's blue and vermilion, which differ for colour-blind readers.
struct Look {
    colour: Colour,
    dashes: Option<[f64; 2]>,
    tone: Tone,
}

impl Look {
    fn of(tone: Tone) -> Self {
        let (colour, dashes) = match tone {
            Tone::Main => ([0x00, 0x72, 0xb2], None),
            Tone::Contrast => ([0xd5, 0x5e, 0x00], Some([7.0, 3.0])),
            Tone::Quiet => ([0x44, 0x44, 0x44], Some([2.0, 3.0])),
        };
        Look {
            colour,
            dashes,
            tone,
        }
    }

    fn fill(&self, opacity: f64) -> Fill {
        Fill {
            colour: self.colour,
            opacity,
        }
    }

    fn drawn(&self, steps: Vec<Step>) -> Shape {
        let stroke = Stroke {
            colour: self.colour,
            width: 1.5,
            dashes: self.dashes,
        };
        Shape::Path {
            steps,
            fill: None,
            stroke: Some(stroke),
        }
    }

    fn line(&self, [from, to]: [Point; 2]) -> Shape {
        self.drawn(vec![Step::Move(from), Step::Line(to)])
    }

    fn area(&self, steps: Vec<Step>, opacity: f64) -> Shape {
        Shape::Path {
            steps,
            fill: Some(self.fill(opacity)),
            stroke: Some(self.outline()),
        }
    }

    /// How far bars are seen through: in grey print two tones beside each other differ by their ground.
    fn ground(&self) -> f64 {
        match self.tone {
            Tone::Main => FULL,
            Tone::Contrast | Tone::Quiet => PALE,
        }
    }

    fn outline(&self) -> Stroke {
        Stroke {
            colour: self.colour,
            width: 1.0,
            dashes: None,
        }
    }

    /// A disc, a hollow diamond, or a dot.
    fn point(&self, [x, y]: Point) -> Shape {
        let disc = |radius, opacity| Shape::Disc {
            centre: [x, y],
            radius,
            fill: self.fill(opacity),
        };
        match self.tone {
            Tone::Main => disc(2.4, 0.7),
            Tone::Contrast => Shape::Path {
                steps: vec![
                    Step::Move([x, y - 3.2]),
                    Step::Line([x + 3.2, y]),
                    Step::Line([x, y + 3.2]),
                    Step::Line([x - 3.2, y]),
                    Step::Close,
                ],
                fill: None,
                stroke: Some(self.outline()),
            },
            Tone::Quiet => disc(1.4, 1.0),
        }
    }
}
