//! Pictures: the plots as every format draws them, over the width of the text.

use gumption_format::document::Plot;
use gumption_format::render::drawing::{self, Anchor, Drawing, SIZE, Shape};

use super::flow::{BLACK, Flow, Op, PAGE, Pen, Step, WIDTH};
use super::fonts::Style;
use super::text;

/// Draws a plot; pages end between its panels.
pub(super) fn draw(flow: &mut Flow<'_>, plot: &Plot) {
    for drawing in Drawing::of_panels(plot) {
        // A panel of very many bars is higher than a page.
        let most = [WIDTH, 0.8 * PAGE[1]];
        let [wide, high] = [0, 1].map(|side| most[side] / drawing.size[side] as f32);
        let scale = wide.min(high);
        let height = drawing.size[1] as f32 * scale + 6.0;
        flow.room(height);
        let place = Place {
            origin: [flow.left(), flow.y],
            scale,
            size: SIZE as f32 * scale * narrowed(flow, &drawing.shapes),
        };
        for shape in &drawing.shapes {
            place.shape(flow, shape);
        }
        flow.y += height;
    }
}

/// How much smaller the letters have to be where those of the font are wider than those that the picture was made for.
fn narrowed(flow: &mut Flow<'_>, shapes: &[Shape]) -> f32 {
    let words = shapes.iter().filter_map(|shape| match shape {
        Shape::Words { words, bold, .. } => Some((words, *bold)),
        _ => None,
    });
    let ratios = words.map(|(words, bold)| {
        let planned = drawing::width(words, bold) as f32;
        let width = text::width(&flow.plain(words, style(bold), 1.0));
        if width > planned {
            planned / width
        } else {
            1.0
        }
    });
    /// Smaller ones would be hard to read.
    const LEAST: f32 = 0.8;
    ratios.fold(1.0, f32::min).max(LEAST)
}

fn style(bold: bool) -> Style {
    if bold { Style::Bold } else { Style::Regular }
}

/// Where the pixels of a picture are on the page.
struct Place {
    origin: [f32; 2],
    scale: f32,
    /// Size of the letters in points.
    size: f32,
}

impl Place {
    fn at(&self, [x, y]: drawing::Point) -> [f32; 2] {
        [
            self.origin[0] + self.scale * x as f32,
            self.origin[1] + self.scale * y as f32,
        ]
    }

    fn shape(&self, flow: &mut Flow<'_>, shape: &Shape) {
        match shape {
            Shape::Path {
                steps,
                fill,
                stroke,
            } => flow.draw(Op::Path {
                parts: steps.iter().map(|step| self.step(*step)).collect(),
                fill: fill.map(|fill| (fill.colour, fill.opacity as f32)),
                stroke: stroke.map(|stroke| Pen {
                    colour: stroke.colour,
                    width: self.scale * stroke.width as f32,
                    dashes: stroke.dashes.map_or(Vec::new(), |dashes| {
                        dashes.map(|length| self.scale * length as f32).to_vec()
                    }),
                }),
            }),
            Shape::Disc {
                centre,
                radius,
                fill,
            } => flow.draw(Op::Path {
                parts: self.circle(self.at(*centre), self.scale * *radius as f32),
                fill: Some((fill.colour, fill.opacity as f32)),
                stroke: None,
            }),
            Shape::Words {
                at,
                anchor,
                bold,
                words,
            } => {
                let letters = flow.plain(words, style(*bold), self.size);
                let width = text::width(&letters);
                let shift = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => width / 2.0,
                    Anchor::End => width,
                };
                let [x, y] = self.at(*at);
                flow.draw(Op::Letters {
                    at: [x - shift, y],
                    letters,
                    colour: BLACK,
                });
            }
        }
    }

    fn step(&self, step: drawing::Step) -> Step {
        match step {
            drawing::Step::Move(at) => Step::Move(self.at(at)),
            drawing::Step::Line(at) => Step::Line(self.at(at)),
            drawing::Step::Close => Step::Close,
        }
    }

    fn circle(&self, [x, y]: [f32; 2], radius: f32) -> Vec<Step> {
        /// Of the four curves that come closest to a circle.
        const HANDLE: f32 = 0.552_284_8;
        let (r, h) = (radius, radius * HANDLE);
        let at = |dx: f32, dy: f32| [x + dx, y + dy];
        vec![
            Step::Move(at(r, 0.0)),
            Step::Curve(at(r, h), at(h, r), at(0.0, r)),
            Step::Curve(at(-h, r), at(-r, h), at(-r, 0.0)),
            Step::Curve(at(-r, -h), at(-h, -r), at(0.0, -r)),
            Step::Curve(at(h, -r), at(r, -h), at(r, 0.0)),
            Step::Close,
        ]
    }
}
