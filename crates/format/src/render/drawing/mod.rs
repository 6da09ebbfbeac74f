//! A plot as shapes at places: what every format that draws takes its picture from, panels one below the other.

mod letters;
mod panel;
mod ticks;

pub use letters::{advance, width};

use crate::document::{Panel, Plot};

/// Size of the words in pixels.
pub const SIZE: f64 = 12.0;
/// Width of every picture in pixels.
const WIDTH: f64 = 760.0;

/// A place in pixels from the upper left corner.
pub type Point = [f64; 2];
/// Red, green and blue.
pub type Colour = [u8; 3];

/// A picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// What it shows, for those who do not see it.
    pub title: String,
    /// Width and height in pixels.
    pub size: Point,
    /// What is drawn, the first below the others.
    pub shapes: Vec<Shape>,
}

/// Something drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A line or an area.
    Path {
        /// Its corners.
        steps: Vec<Step>,
        /// What it is filled with.
        fill: Option<Fill>,
        /// What it is drawn with.
        stroke: Option<Stroke>,
    },
    /// A filled circle.
    Disc {
        /// Its centre.
        centre: Point,
        /// Its radius in pixels.
        radius: f64,
        /// What it is filled with.
        fill: Fill,
    },
    /// A line of words.
    Words {
        /// Where it stands, on its base line.
        at: Point,
        /// Which of its points that is.
        anchor: Anchor,
        /// Whether its letters are bold.
        bold: bool,
        /// What it says.
        words: String,
    },
}

/// A step of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Begins at a place.
    Move(Point),
    /// Goes straight to a place.
    Line(Point),
    /// Goes back to where it began.
    Close,
}

/// How an area is filled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fill {
    /// The colour.
    pub colour: Colour,
    /// 1 where nothing below is seen.
    pub opacity: f64,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// The colour.
    pub colour: Colour,
    /// Width in pixels.
    pub width: f64,
    /// Lengths of dashes and of the gaps between them; none of a line without gaps.
    pub dashes: Option<[f64; 2]>,
}

/// Which point of a line of words is placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The first letter.
    Start,
    /// The middle.
    Middle,
    /// The last letter.
    End,
}

impl Drawing {
    /// The picture of a plot.
    #[must_use]
    pub fn of(plot: &Plot) -> Drawing {
        drawn(&plot.panels)
    }

    /// A picture of each panel, where pages may end between them.
    #[must_use]
    pub fn of_panels(plot: &Plot) -> Vec<Drawing> {
        plot.panels.chunks(1).map(drawn).collect()
    }
}

fn drawn(panels: &[Panel]) -> Drawing {
    let titles: Vec<&str> = panels.iter().map(|panel| panel.title.as_str()).collect();
    let mut drawing = Drawing {
        title: titles.join("; "),
        size: [WIDTH, 0.0],
        shapes: Vec::new(),
    };
    for panel in panels {
        drawing.size[1] = panel::draw(panel, drawing.size[1], &mut drawing.shapes);
    }
    drawing
}

/// The corners of a rectangle.
#[must_use]
pub fn rectangle([x, y]: Point, [width, height]: Point) -> Vec<Step> {
    vec![
        Step::Move([x, y]),
        Step::Line([x + width, y]),
        Step::Line([x + width, y + height]),
        Step::Line([x, y + height]),
        Step::Close,
    ]
}
