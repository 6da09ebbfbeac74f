//! A picture as an enhanced metafile (MS-EMF): lines and words rather than pixels, which every word processor has read for
//! decades, prints sharply, and lets users edit; a picture of pixels would need a rasteriser and the fonts of this machine.

use gumption_format::render::drawing::{
    self, Anchor, Colour, Drawing, Fill, SIZE, Shape, Step, Stroke,
};

/// Logical units of a pixel.
const UNITS: f64 = 20.0;
/// Logical units of a millimetre on the device that the picture is made for.
const PER_MILLIMETRE: i32 = 80;
/// Size of that device in millimetres.
const DEVICE: [i32; 2] = [320, 240];

/// Handles of the objects that are drawn with.
const PEN: u32 = 1;
const BRUSH: u32 = 2;
const FONT: u32 = 3;
/// Objects that are always there.
const NO_BRUSH: u32 = 0x8000_0005;
const NO_PEN: u32 = 0x8000_0008;
const USUAL_FONT: u32 = 0x8000_000d;

/// The bytes of the file.
pub(super) fn emf(drawing: &Drawing) -> Vec<u8> {
    let mut file = Metafile::default();
    let [width, height] = drawing.size.map(units);
    file.record(17, |r| r.long(8)); // its own scale for each axis
    for (origin, extent) in [(10, 9), (12, 11)] {
        file.record(origin, |r| r.longs([0, 0]));
        file.record(extent, |r| r.longs([width, height]));
    }
    file.record(18, |r| r.long(1)); // nothing behind words
    file.record(22, |r| r.long(24)); // words stand on their base line
    for shape in &drawing.shapes {
        file.shape(shape);
    }
    file.record(14, |r| r.longs([0, 16, 20]));
    file.finished([width, height])
}

/// Pixels as logical units.
fn units(pixels: f64) -> i32 {
    (pixels * UNITS).round() as i32
}

/// Records, one behind the other, with what is selected at the end of them.
#[derive(Default)]
struct Metafile {
    records: Record,
    count: i32,
    pen: Option<Stroke>,
    brush: Option<Colour>,
    font: Option<bool>,
}

/// Numbers as they stand in the file.
#[derive(Default)]
struct Record(Vec<u8>);

impl Record {
    fn long(&mut self, number: i32) {
        self.0.extend(number.to_le_bytes());
    }

    fn longs<const N: usize>(&mut self, numbers: [i32; N]) {
        numbers.into_iter().for_each(|number| self.long(number));
    }

    /// A handle, colour or length.
    fn natural(&mut self, number: u32) {
        self.0.extend(number.to_le_bytes());
    }

    fn colour(&mut self, [red, green, blue]: Colour) {
        self.0.extend([red, green, blue, 0]);
    }

    /// UTF-16, with zeros up to so many units.
    fn words(&mut self, words: &[u16], length: usize) {
        let zeros = std::iter::repeat(&0);
        for unit in words.iter().chain(zeros).take(length) {
            self.0.extend(unit.to_le_bytes());
        }
    }
}

impl Metafile {
    fn record(&mut self, kind: u32, fill: impl FnOnce(&mut Record)) {
        let mut inside = Record::default();
        fill(&mut inside);
        self.records.natural(kind);
        self.records.natural(inside.0.len() as u32 + 8);
        self.records.0.extend(inside.0);
        self.count += 1;
    }

    fn select(&mut self, object: u32) {
        self.record(37, |r| r.natural(object));
    }

    /// Takes an object away, where there was one, and something else up before.
    fn replace(&mut self, object: u32, was: bool, usual: u32) {
        if was {
            self.select(usual);
            self.record(40, |r| r.natural(object));
        }
    }

    fn take_pen(&mut self, stroke: Option<Stroke>) {
        let Some(stroke) = stroke else {
            return self.select(NO_PEN);
        };
        if self.pen != Some(stroke) {
            self.replace(PEN, self.pen.is_some(), NO_PEN);
            // A geometric pen with flat ends: solid, of dashes, of dots.
            let style = 0x0001_0200
                | match stroke.dashes {
                    None => 0,
                    Some([dash, gap]) if dash > gap => 1,
                    Some(_) => 2,
                };
            self.record(95, |r| {
                r.natural(PEN);
                r.longs([0; 4]);
                r.longs([style, units(stroke.width), 0]);
                r.colour(stroke.colour);
                r.longs([0, 0]);
            });
            self.pen = Some(stroke);
        }
        self.select(PEN);
    }

    fn take_brush(&mut self, fill: Option<Fill>) {
        let Some(fill) = fill else {
            return self.select(NO_BRUSH);
        };
        // The ground is white, and nothing is drawn below what is filled but lines of the grid.
        let paler = |part: u8| (255.0 - (255.0 - f64::from(part)) * fill.opacity).round() as u8;
        let colour = fill.colour.map(paler);
        if self.brush != Some(colour) {
            self.replace(BRUSH, self.brush.is_some(), NO_BRUSH);
            self.record(39, |r| {
                r.natural(BRUSH);
                r.long(0);
                r.colour(colour);
                r.long(0);
            });
            self.brush = Some(colour);
        }
        self.select(BRUSH);
    }

    fn take_font(&mut self, bold: bool) {
        if self.font != Some(bold) {
            self.replace(FONT, self.font.is_some(), USUAL_FONT);
            self.record(82, |r| {
                r.natural(FONT);
                let weight = if bold { 700 } else { 400 };
                r.longs([-units(SIZE), 0, 0, 0, weight]);
                r.0.extend([0, 0, 0, 1, 0, 0, 0, 0]);
                let name: Vec<u16> = "Arial".encode_utf16().collect();
                // The name, and what such a record has room for beside it.
                r.words(&name, (320 - 28) / 2);
            });
            self.font = Some(bold);
        }
        self.select(FONT);
    }

    fn shape(&mut self, shape: &Shape) {
        match shape {
            Shape::Path {
                steps,
                fill,
                stroke,
            } => {
                self.take_brush(*fill);
                self.take_pen(*stroke);
                for part in parts(steps) {
                    self.corners(&part.0, part.1);
                }
            }
            Shape::Disc {
                centre: [x, y],
                radius,
                fill,
            } => {
                self.take_brush(Some(*fill));
                self.take_pen(None);
                let box_of = [x - radius, y - radius, x + radius, y + radius];
                self.record(42, |r| r.longs(box_of.map(units)));
            }
            Shape::Words {
                at,
                anchor,
                bold,
                words,
            } => self.words(*at, *anchor, *bold, words),
        }
    }

    /// A line through places, or the area between them.
    fn corners(&mut self, places: &[drawing::Point], closed: bool) {
        let places: Vec<[i32; 2]> = places.iter().map(|place| place.map(units)).collect();
        let side = |at: usize| places.iter().map(move |place| place[at]);
        let ends = [side(0).min(), side(1).min(), side(0).max(), side(1).max()];
        self.record(if closed { 3 } else { 4 }, |r| {
            r.longs(ends.map(Option::unwrap_or_default));
            r.natural(places.len() as u32);
            places.iter().for_each(|place| r.longs(*place));
        });
    }

    fn words(&mut self, [x, y]: drawing::Point, anchor: Anchor, bold: bool, words: &str) {
        self.take_font(bold);
        let width = SIZE * drawing::width(words, bold);
        let start = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - width / 2.0,
            Anchor::End => x - width,
        };
        let text: Vec<u16> = words.encode_utf16().collect();
        let even = text.len().next_multiple_of(2);
        /// Where the text begins in the record.
        const TEXT: u32 = 76;
        self.record(84, |r| {
            r.longs([0, 0, -1, -1]);
            r.long(2);
            r.0.extend([1.0f32.to_le_bytes(), 1.0f32.to_le_bytes()].concat());
            r.longs([units(start), units(y)]);
            r.natural(text.len() as u32);
            r.natural(TEXT);
            r.longs([0, 0, 0, -1, -1]);
            r.natural(TEXT + 2 * even as u32);
            r.words(&text, even);
            for character in words.chars() {
                r.long(units(SIZE * drawing::advance(character, bold)));
                // The second half of a pair takes no room of its own.
                (1..character.len_utf16()).for_each(|_| r.long(0));
            }
        });
    }

    /// The file with its head.
    fn finished(self, [width, height]: [i32; 2]) -> Vec<u8> {
        const HEAD: u32 = 88;
        let hundredths = |length: i32| length * 100 / PER_MILLIMETRE;
        let mut file = Record::default();
        file.natural(1);
        file.natural(HEAD);
        file.longs([0, 0, width - 1, height - 1]);
        file.longs([0, 0, hundredths(width), hundredths(height)]);
        file.0.extend(*b" EMF");
        file.long(0x0001_0000);
        file.natural(HEAD + self.records.0.len() as u32);
        file.long(self.count + 1);
        file.long(4); // handles, with the one that is none
        file.longs([0, 0, 0]);
        file.longs(DEVICE.map(|length| length * PER_MILLIMETRE));
        file.longs(DEVICE);
        file.0.extend(self.records.0);
        file.0
    }
}

/// The parts of a path, and whether each is closed.
fn parts(steps: &[Step]) -> Vec<(Vec<drawing::Point>, bool)> {
    let mut parts: Vec<(Vec<drawing::Point>, bool)> = Vec::new();
    for step in steps {
        match (step, parts.last_mut()) {
            (Step::Move(at), _) | (Step::Line(at), None) => parts.push((vec![*at], false)),
            (Step::Line(at), Some(part)) => part.0.push(*at),
            (Step::Close, Some(part)) => part.1 = true,
            (Step::Close, None) => {}
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_format::document::{Axis, Layer, Marks, Panel, Plot, Tone};

    #[test]
    fn records_follow_one_another_to_the_end() {
        let layer = |tone, marks| Layer {
            name: "名字 𝛼".into(),
            tone,
            marks,
        };
        let panel = Panel {
            title: "Series".into(),
            x: Axis::linear("t", "s"),
            y: Axis::logarithmic("σ", "V"),
            layers: vec![
                layer(Tone::Quiet, Marks::Whiskers(vec![[1.0, 2.0, 3.0]])),
                layer(Tone::Main, Marks::Points(vec![[1.0, 2.5], [2.0, 4.0]])),
                layer(Tone::Contrast, Marks::Line(vec![[1.0, 2.0], [2.0, 4.0]])),
            ],
        };
        let plot = Plot {
            id: "series".into(),
            panels: vec![panel],
        };
        let file = emf(&Drawing::of(&plot));
        let number = |at: usize| {
            let bytes = file[at..at + 4].try_into().expect("four bytes");
            u32::from_le_bytes(bytes) as usize
        };
        assert_eq!(number(48), file.len());
        let (mut at, mut count, mut last) = (0, 0, 0);
        while at < file.len() {
            assert_eq!(at % 4, 0);
            last = number(at);
            at += number(at + 4);
            count += 1;
        }
        assert_eq!((at, count, last), (file.len(), number(52), 14));
    }
}
