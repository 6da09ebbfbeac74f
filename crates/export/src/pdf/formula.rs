//! Formulas as they are set in mathematics: boxes side by side, above and below one another.

use gumption_format::document::Math;

use super::flow::{BLACK, Flow, Op, Pen, Step, WIDTH};
use super::fonts::Style;
use super::text;

/// Size of a formula, and the smallest that parts of it have.
const SIZE: f32 = 10.0;
const LEAST: f32 = 6.0;
/// Parts of the size, as faces without a table for mathematics have them: how far letters reach above the line and below it, where
/// the strokes of signs and of fractions lie, how thick these are.
const ASCENT: f32 = 0.76;
const DESCENT: f32 = 0.22;
const AXIS: f32 = 0.31;
const STROKE: f32 = 0.06;
/// Of the size: exponents and indices, the room about a sign of relation, about a sum's or product's.
const SMALLER: f32 = 0.7;
const ABOUT_RELATIONS: f32 = 0.28;
const ABOUT_SIGNS: f32 = 0.18;
/// Further lines of one formula stand to the right.
const INDENT: f32 = 24.0;

/// Draws one formula, on several lines where it is wider than the text; says whether it could.
pub(super) fn draw(flow: &mut Flow<'_>, formula: &Math) -> bool {
    const LEFT: f32 = 10.0;
    let lines = lines(flow, formula, WIDTH - LEFT);
    let fits = |line: &Set| line.width <= WIDTH - LEFT;
    if !lines.iter().all(fits) {
        return false;
    }
    for (number, line) in lines.into_iter().enumerate() {
        let indent = if number == 0 { 0.0 } else { INDENT };
        flow.room(line.ascent + line.descent + 4.0);
        let base = flow.y + line.ascent;
        let left = flow.left() + LEFT + indent;
        flow.y = base + line.descent + 4.0;
        for op in line.ops {
            flow.draw(moved(op, [left, base]));
        }
    }
    true
}

/// What is set, from the left end of its base line.
#[derive(Default)]
struct Set {
    ops: Vec<Op>,
    width: f32,
    ascent: f32,
    descent: f32,
}

impl Set {
    /// Puts another so far to the right and above the line.
    fn put(&mut self, other: Set, [x, above]: [f32; 2]) {
        self.width = self.width.max(x + other.width);
        self.ascent = self.ascent.max(other.ascent + above);
        self.descent = self.descent.max(other.descent - above);
        let moved = other.ops.into_iter().map(|op| moved(op, [x, -above]));
        self.ops.extend(moved);
    }

    /// Puts another behind the end.
    fn add(&mut self, other: Set) {
        let end = self.width;
        self.put(other, [end, 0.0]);
    }

    fn rule(&mut self, points: &[[f32; 2]], thickness: f32) {
        let steps = points.iter().enumerate();
        let steps = steps.map(|(at, point)| match at {
            0 => Step::Move(*point),
            _ => Step::Line(*point),
        });
        self.ops.push(Op::Path {
            parts: steps.collect(),
            fill: None,
            stroke: Some(Pen {
                colour: BLACK,
                width: thickness,
                dashes: Vec::new(),
            }),
        });
    }
}

fn moved(op: Op, [x, y]: [f32; 2]) -> Op {
    let at = |[a, b]: [f32; 2]| [a + x, b + y];
    match op {
        Op::Letters {
            at: place,
            letters,
            colour,
        } => Op::Letters {
            at: at(place),
            letters,
            colour,
        },
        Op::Path {
            parts,
            fill,
            stroke,
        } => {
            let step = |step| match step {
                Step::Move(a) => Step::Move(at(a)),
                Step::Line(a) => Step::Line(at(a)),
                Step::Curve(a, b, c) => Step::Curve(at(a), at(b), at(c)),
                Step::Close => Step::Close,
            };
            Op::Path {
                parts: parts.into_iter().map(step).collect(),
                fill,
                stroke,
            }
        }
    }
}

/// The lines of a formula: as many parts of its outermost sum on each as fit.
fn lines(flow: &mut Flow<'_>, formula: &Math, room: f32) -> Vec<Set> {
    let mut parts = Vec::new();
    flatten(formula, &mut parts);
    let (mut lines, mut line, mut indent) = (Vec::new(), Set::default(), 0.0);
    let mut from = 0;
    for end in 1..=parts.len() {
        if end < parts.len() && !is_between(&parts, end) {
            continue;
        }
        let mut piece = Set::default();
        (from..end).for_each(|at| piece.add(part(flow, &parts, at, SIZE)));
        if line.width > 0.0 && indent + line.width + piece.width > room {
            lines.push(std::mem::take(&mut line));
            indent = INDENT;
        }
        line.add(piece);
        from = end;
    }
    lines.push(line);
    lines
}

/// Parts side by side, whatever rows they were in.
fn flatten<'m>(math: &'m Math, parts: &mut Vec<&'m Math>) {
    match math {
        Math::Row(inner) => inner.iter().for_each(|one| flatten(one, parts)),
        other => parts.push(other),
    }
}

/// Whether a part is a sign between two others; else it belongs to what follows.
fn is_between(parts: &[&Math], at: usize) -> bool {
    let is_sign = |part: &Math| matches!(part, Math::Sign(_));
    at > 0 && is_sign(parts[at]) && !is_sign(parts[at - 1])
}

/// A part of a row, with the room about it.
fn part(flow: &mut Flow<'_>, parts: &[&Math], at: usize, size: f32) -> Set {
    let alone = set(flow, parts[at], size);
    let about = match parts[at] {
        Math::Sign(",") => [0.0, ABOUT_SIGNS],
        Math::Sign(_) if !is_between(parts, at) => [0.0; 2],
        Math::Sign("+" | "−" | "·") => [ABOUT_SIGNS; 2],
        Math::Sign(_) => [ABOUT_RELATIONS; 2],
        _ => [0.0; 2],
    };
    let [before, after] = about.map(|part| part * size);
    let mut spaced = Set::default();
    spaced.put(alone, [before, 0.0]);
    spaced.width += after;
    spaced
}

fn set(flow: &mut Flow<'_>, math: &Math, size: f32) -> Set {
    let size = size.max(LEAST);
    match math {
        Math::Name(name, index) => {
            let mut whole = words(flow, name, size);
            if let Some(index) = index {
                let index = words(flow, index, (SMALLER * size).max(LEAST));
                let end = whole.width;
                whole.put(index, [end, -0.18 * size]);
            }
            whole
        }
        Math::Number(number) => words(flow, number, size),
        Math::Sign(sign) => words(flow, sign, size),
        Math::Words(upright) => words(flow, upright, size),
        Math::Row(_) => {
            let mut parts = Vec::new();
            flatten(math, &mut parts);
            let mut whole = Set::default();
            (0..parts.len()).for_each(|at| whole.add(part(flow, &parts, at, size)));
            whole
        }
        Math::Group(open, inside, close) => {
            let inside = set(flow, inside, size);
            let mut whole = bracket(flow, open, &inside, size);
            let closing = bracket(flow, close, &inside, size);
            whole.add(inside);
            whole.add(closing);
            whole
        }
        Math::Fraction(above, below) => {
            fraction(set(flow, above, size), set(flow, below, size), size)
        }
        Math::Power(base, exponent) => {
            let mut whole = set(flow, base, size);
            let exponent = set(flow, exponent, SMALLER * size);
            let (end, top) = (whole.width, whole.ascent);
            // Its lower end is where small letters end, of tall parts near their top.
            let above = (top - 0.5 * exponent.ascent).max(0.36 * size) + exponent.descent * 0.3;
            whole.put(exponent, [end + 0.04 * size, above]);
            whole
        }
        Math::Root(inside) => root(set(flow, inside, size), size),
    }
}

fn words(flow: &mut Flow<'_>, text: &str, size: f32) -> Set {
    let letters = flow.plain(text, Style::Regular, size);
    Set {
        width: text::width(&letters),
        ascent: ASCENT * size,
        descent: DESCENT * size,
        ops: vec![Op::Letters {
            at: [0.0; 2],
            letters,
            colour: BLACK,
        }],
    }
}

/// A bracket as high as what it holds.
fn bracket(flow: &mut Flow<'_>, sign: &str, inside: &Set, size: f32) -> Set {
    let height = inside.ascent + inside.descent;
    let own = (height / (ASCENT + DESCENT)).max(size);
    let mut placed = Set::default();
    let middle = |up: f32, down: f32| (up - down) / 2.0;
    let above = middle(inside.ascent, inside.descent) - middle(ASCENT * own, DESCENT * own);
    placed.put(words(flow, sign, own), [0.0, above]);
    placed
}

fn fraction(above: Set, below: Set, size: f32) -> Set {
    const BESIDE: f32 = 0.12;
    let (side, axis, gap) = (BESIDE * size, AXIS * size, 0.16 * size);
    let width = above.width.max(below.width) + 2.0 * side;
    let mut whole = Set::default();
    whole.rule(
        &[[side / 2.0, -axis], [width - side / 2.0, -axis]],
        STROKE * size,
    );
    let (up, down) = (axis + gap + above.descent, axis - gap - below.ascent);
    let middle = |part: &Set| (width - part.width) / 2.0;
    let [x_above, x_below] = [middle(&above), middle(&below)];
    whole.put(above, [x_above, up]);
    whole.put(below, [x_below, down]);
    whole.width = width;
    whole
}

fn root(inside: Set, size: f32) -> Set {
    let (top, bottom) = (inside.ascent + 0.14 * size, inside.descent);
    let (sign, end) = (0.62 * size, inside.width);
    let mut whole = Set::default();
    let points = [
        [0.06 * size, -0.34 * size],
        [0.2 * size, -0.42 * size],
        [0.36 * size, bottom],
        [sign - 0.06 * size, -top],
        [sign + end + 0.06 * size, -top],
    ];
    whole.put(inside, [sign, 0.0]);
    whole.rule(&points, STROKE * size);
    whole.ascent = whole.ascent.max(top + 0.06 * size);
    whole.width = sign + end + 0.1 * size;
    whole
}
