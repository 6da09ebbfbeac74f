//! Pages that fill from top to bottom.

use super::fonts::{Fonts, Style};
use super::text::{self, Letter, Missing};

/// A4 in points.
pub(super) const PAGE: [f32; 2] = [595.28, 841.89];
/// Left and right of the text.
const SIDE: f32 = 51.0;
const TOP: f32 = 51.0;
const BOTTOM: f32 = 60.0;
/// Width of the text.
pub(super) const WIDTH: f32 = PAGE[0] - 2.0 * SIDE;

/// Colours, as red, green and blue.
pub(super) type Colour = [u8; 3];
pub(super) const BLACK: Colour = [0, 0, 0];
pub(super) const GREY: Colour = [85, 85, 85];
pub(super) const PALE: Colour = [200, 200, 200];
pub(super) const BLUE: Colour = [0, 114, 178];

/// Something drawn on a page. Places are in points from its upper left corner.
#[derive(Debug, Clone)]
pub(super) enum Op {
    /// Letters from a place of the base line.
    Letters {
        at: [f32; 2],
        letters: Vec<Letter>,
        colour: Colour,
    },
    /// A path.
    Path {
        parts: Vec<Step>,
        fill: Option<(Colour, f32)>,
        stroke: Option<Pen>,
    },
}

/// A step of a path.
#[derive(Debug, Clone, Copy)]
pub(super) enum Step {
    Move([f32; 2]),
    Line([f32; 2]),
    Curve([f32; 2], [f32; 2], [f32; 2]),
    Close,
}

/// How a line is drawn.
#[derive(Debug, Clone)]
pub(super) struct Pen {
    pub colour: Colour,
    pub width: f32,
    pub dashes: Vec<f32>,
}

/// The pages so far.
pub(super) struct Flow<'f> {
    pub fonts: &'f Fonts,
    pub missing: Missing,
    pub pages: Vec<Vec<Op>>,
    /// How far the page is filled.
    pub y: f32,
}

impl<'f> Flow<'f> {
    /// One empty page.
    pub fn new(fonts: &'f Fonts) -> Self {
        Flow {
            fonts,
            missing: Missing::default(),
            pages: vec![Vec::new()],
            y: TOP,
        }
    }

    /// Left edge of the text.
    pub fn left(&self) -> f32 {
        SIDE
    }

    /// Draws on the page.
    pub fn draw(&mut self, op: Op) {
        if let Some(page) = self.pages.last_mut() {
            page.push(op);
        }
    }

    /// Makes sure that so much fits below one another; says whether a page was begun for it.
    pub fn room(&mut self, height: f32) -> bool {
        let begun = self.y > TOP && self.y + height > PAGE[1] - BOTTOM;
        if begun {
            self.begin_page();
        }
        begun
    }

    /// Goes on with a new page.
    pub(super) fn begin_page(&mut self) {
        self.pages.push(Vec::new());
        self.y = TOP;
    }

    /// Goes down, except at the top of a page.
    pub fn skip(&mut self, height: f32) {
        if self.y > TOP {
            self.y += height;
        }
    }

    /// Glyphs of a text.
    pub fn set(&mut self, text: &str, style: Style, size: f32) -> Vec<Letter> {
        text::set(text, style, size, self.fonts, &mut self.missing)
    }

    /// Glyphs of a text as it is.
    pub fn plain(&mut self, text: &str, style: Style, size: f32) -> Vec<Letter> {
        text::plain(text, style, size, self.fonts, &mut self.missing)
    }

    /// Lines of letters, one below the other, in a column of the text. No line stands alone at the foot of a page or at
    /// the head of the next.
    pub fn lines(&mut self, letters: &[Letter], column: [f32; 2], leading: f32, colour: Colour) {
        let [left, width] = column;
        let lines = text::lines(letters, width);
        let many = lines.len();
        for (at, line) in lines.into_iter().enumerate() {
            let together = match at {
                0 => at_least(many),
                _ if at + 2 == many => 2,
                _ => 1,
            };
            self.room(together as f32 * leading);
            let at = [left, self.y + 0.78 * leading];
            self.draw(Op::Letters {
                at,
                letters: line,
                colour,
            });
            self.y += leading;
        }
    }

    /// A line across the text.
    pub fn rule(&mut self, from: [f32; 2], to: [f32; 2], colour: Colour, width: f32) {
        self.draw(Op::Path {
            parts: vec![Step::Move(from), Step::Line(to)],
            fill: None,
            stroke: Some(Pen {
                colour,
                width,
                dashes: Vec::new(),
            }),
        });
    }

    /// A filled rectangle.
    pub fn rectangle(&mut self, [x, y]: [f32; 2], [width, height]: [f32; 2], colour: Colour) {
        self.draw(Op::Path {
            parts: rectangle([x, y], [width, height]),
            fill: Some((colour, 1.0)),
            stroke: None,
        });
    }
}

/// How many of so many lines stand together where they begin: three are not parted, of more the last two go together.
pub(super) fn at_least(lines: usize) -> usize {
    match lines {
        0..=3 => lines,
        _ => 2,
    }
}

/// The path of a rectangle.
pub(super) fn rectangle([x, y]: [f32; 2], [width, height]: [f32; 2]) -> Vec<Step> {
    vec![
        Step::Move([x, y]),
        Step::Line([x + width, y]),
        Step::Line([x + width, y + height]),
        Step::Line([x, y + height]),
        Step::Close,
    ]
}
