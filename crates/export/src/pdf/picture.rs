//! Pictures: the plots as they are drawn for screens, their lines and words taken over.

use roxmltree::{Document, Node};

use super::flow::{BLACK, Colour, Flow, Op, Pen, Step, WIDTH, rectangle};
use super::fonts::Style;
use super::text;

/// Draws a picture over the width of the text.
pub(super) fn draw(flow: &mut Flow<'_>, svg: &str) {
    let Ok(document) = Document::parse(svg) else {
        return;
    };
    let root = document.root_element();
    let (Some(width), Some(height)) = (number(root, "width"), number(root, "height")) else {
        return;
    };
    let scale = WIDTH / width;
    flow.room(height * scale + 8.0);
    let origin = [flow.left(), flow.y];
    let panels = root
        .children()
        .filter(|child| child.has_tag_name(("http://www.w3.org/2000/svg", "g")));
    for panel in panels {
        let down = panel.attribute("transform").and_then(|text| {
            let inside = text.strip_prefix("translate(0 ")?.strip_suffix(')')?;
            inside.parse::<f32>().ok()
        });
        let place = Place {
            origin: [origin[0], origin[1] + scale * down.unwrap_or(0.0)],
            scale,
        };
        for mark in panel.children().filter(Node::is_element) {
            place.mark(flow, mark);
        }
    }
    flow.y = origin[1] + height * scale + 8.0;
}

/// Where the coordinates of a panel are on the page.
struct Place {
    origin: [f32; 2],
    scale: f32,
}

impl Place {
    fn at(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        [
            self.origin[0] + self.scale * x,
            self.origin[1] + self.scale * y,
        ]
    }

    fn mark(&self, flow: &mut Flow<'_>, mark: Node<'_, '_>) {
        let get = |name| number(mark, name).unwrap_or(0.0);
        let parts = match mark.tag_name().name() {
            "text" => return self.words(flow, mark),
            "rect" => rectangle(
                self.at([get("x"), get("y")]),
                [get("width"), get("height")].map(|length| self.scale * length),
            ),
            "line" => vec![
                Step::Move(self.at([get("x1"), get("y1")])),
                Step::Line(self.at([get("x2"), get("y2")])),
            ],
            "circle" => self.circle([get("cx"), get("cy")], get("r")),
            "polyline" => self.points(mark, false),
            "polygon" => self.points(mark, true),
            "path" => self.path(mark.attribute("d").unwrap_or_default()),
            _ => return,
        };
        let opacity = number(mark, "fill-opacity").unwrap_or(1.0);
        let pen = colour(mark, "stroke").map(|colour| Pen {
            colour,
            width: self.scale * number(mark, "stroke-width").unwrap_or(1.0),
            dashes: dashes(mark)
                .iter()
                .map(|length| self.scale * length)
                .collect(),
        });
        flow.draw(Op::Path {
            parts,
            fill: colour(mark, "fill").map(|colour| (colour, opacity)),
            stroke: pen,
        });
    }

    fn words(&self, flow: &mut Flow<'_>, mark: Node<'_, '_>) {
        let style = match mark.attribute("font-weight") {
            Some("bold") => Style::Bold,
            _ => Style::Regular,
        };
        /// As the picture has it.
        const SIZE: f32 = 12.0;
        let letters = flow.set(mark.text().unwrap_or_default(), style, SIZE * self.scale);
        let width = text::width(&letters);
        let shift = match mark.attribute("text-anchor") {
            Some("middle") => width / 2.0,
            Some("end") => width,
            _ => 0.0,
        };
        let get = |name| number(mark, name).unwrap_or(0.0);
        let [x, y] = self.at([get("x"), get("y")]);
        flow.draw(Op::Letters {
            at: [x - shift, y],
            letters,
            colour: BLACK,
        });
    }

    fn points(&self, mark: Node<'_, '_>, closed: bool) -> Vec<Step> {
        let words = mark.attribute("points").unwrap_or_default();
        let mut numbers = words
            .split([' ', ','])
            .filter_map(|word| word.parse::<f32>().ok());
        let mut steps = Vec::new();
        while let (Some(x), Some(y)) = (numbers.next(), numbers.next()) {
            let at = self.at([x, y]);
            steps.push(match steps.is_empty() {
                true => Step::Move(at),
                false => Step::Line(at),
            });
        }
        if closed {
            steps.push(Step::Close);
        }
        steps
    }

    fn circle(&self, [x, y]: [f32; 2], radius: f32) -> Vec<Step> {
        /// Of the four curves that come closest to a circle.
        const HANDLE: f32 = 0.552_284_8;
        let (r, h) = (radius, radius * HANDLE);
        let at = |dx: f32, dy: f32| self.at([x + dx, y + dy]);
        vec![
            Step::Move(at(r, 0.0)),
            Step::Curve(at(r, h), at(h, r), at(0.0, r)),
            Step::Curve(at(-h, r), at(-r, h), at(-r, 0.0)),
            Step::Curve(at(-r, -h), at(-h, -r), at(0.0, -r)),
            Step::Curve(at(h, -r), at(r, -h), at(r, 0.0)),
            Step::Close,
        ]
    }

    /// A path of the steps that the plots are made of: M, H, V, l, z.
    fn path(&self, words: &str) -> Vec<Step> {
        let mut steps = Vec::new();
        let mut here = [0.0f32; 2];
        let starts: Vec<usize> = words
            .char_indices()
            .filter(|(_, c)| c.is_ascii_alphabetic())
            .map(|(at, _)| at)
            .collect();
        for (n, start) in starts.iter().enumerate() {
            let end = starts.get(n + 1).copied().unwrap_or(words.len());
            let numbers: Vec<f32> = words[start + 1..end]
                .split([' ', ','])
                .filter_map(|word| word.parse().ok())
                .collect();
            let moved = |at: usize| numbers.get(at).copied().unwrap_or(0.0);
            match &words[*start..start + 1] {
                "M" => {
                    here = [moved(0), moved(1)];
                    steps.push(Step::Move(self.at(here)));
                    continue;
                }
                "H" => here[0] = moved(0),
                "V" => here[1] = moved(0),
                "L" => here = [moved(0), moved(1)],
                "l" => here = [here[0] + moved(0), here[1] + moved(1)],
                _ => {
                    steps.push(Step::Close);
                    continue;
                }
            }
            steps.push(Step::Line(self.at(here)));
        }
        steps
    }
}

fn number(node: Node<'_, '_>, name: &str) -> Option<f32> {
    node.attribute(name)?.parse().ok()
}

/// `#0072b2`, `#888`, `white`; nothing of none.
fn colour(node: Node<'_, '_>, name: &str) -> Option<Colour> {
    let text = node.attribute(name)?;
    let digits = match text {
        "none" => return None,
        "white" => "ffffff".to_owned(),
        text => text.trim_start_matches('#').to_owned(),
    };
    let digits = match digits.len() {
        3 => digits.chars().flat_map(|c| [c, c]).collect(),
        _ => digits,
    };
    let part = |at: usize| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    Some([part(0)?, part(2)?, part(4)?])
}

fn dashes(node: Node<'_, '_>) -> Vec<f32> {
    let text = node.attribute("stroke-dasharray").unwrap_or("none");
    text.split(' ')
        .filter_map(|word| word.parse().ok())
        .collect()
}
