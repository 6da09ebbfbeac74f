//! A plot as SVG.

use std::fmt::Write;

use super::drawing::{Anchor, Colour, Drawing, SIZE, Shape, Step, width};
use crate::document::Plot;

/// A plot as the text of an SVG file.
pub fn svg(plot: &Plot) -> String {
    let Drawing {
        title,
        size: [width, height],
        shapes,
    } = Drawing::of(plot);
    let title = escaped(&title);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{title}\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"Arial, Helvetica, 'Liberation Sans', 'Noto Sans CJK SC', 'Microsoft YaHei', sans-serif\" font-size=\"{SIZE}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for shape in &shapes {
        element(&mut svg, shape);
    }
    svg + "</svg>\n"
}

fn element(svg: &mut String, shape: &Shape) {
    // Writing to a text does not fail.
    let _ = match shape {
        Shape::Path {
            steps,
            fill,
            stroke,
        } => {
            let fill = match fill {
                None => "fill=\"none\"".to_owned(),
                Some(fill) => filled(fill.colour, fill.opacity),
            };
            let stroke = stroke.map_or(String::new(), |stroke| {
                let dashes = stroke.dashes.map_or(String::new(), |[dash, gap]| {
                    format!(" stroke-dasharray=\"{dash} {gap}\"")
                });
                let (colour, width) = (hex(stroke.colour), stroke.width);
                format!(" stroke=\"{colour}\" stroke-width=\"{width}\"{dashes}")
            });
            writeln!(svg, "<path d=\"{}\" {fill}{stroke}/>", path(steps))
        }
        Shape::Disc {
            centre: [x, y],
            radius,
            fill,
        } => {
            let fill = filled(fill.colour, fill.opacity);
            writeln!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" {fill}/>"
            )
        }
        Shape::Words {
            at: [x, y],
            anchor,
            bold,
            words,
        } => {
            let anchor = match anchor {
                Anchor::Start => "",
                Anchor::Middle => " text-anchor=\"middle\"",
                Anchor::End => " text-anchor=\"end\"",
            };
            let weight = if *bold { " font-weight=\"bold\"" } else { "" };
            // The room that the drawing left for them, in whatever font the reader has.
            let room = SIZE * width(words, *bold);
            let words = escaped(words);
            writeln!(
                svg,
                "<text x=\"{x:.1}\" y=\"{y:.1}\"{anchor}{weight} textLength=\"{room:.1}\" lengthAdjust=\"spacingAndGlyphs\">{words}</text>"
            )
        }
    };
}

fn path(steps: &[Step]) -> String {
    let steps = steps.iter().map(|step| match step {
        Step::Move([x, y]) => format!("M{x:.1} {y:.1}"),
        Step::Line([x, y]) => format!("L{x:.1} {y:.1}"),
        Step::Close => "z".to_owned(),
    });
    steps.collect()
}

fn filled(colour: Colour, opacity: f64) -> String {
    format!("fill=\"{}\" fill-opacity=\"{opacity}\"", hex(colour))
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Text between tags, or in the quotes of an attribute.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}
