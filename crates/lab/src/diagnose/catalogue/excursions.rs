//! A deviation about one value of a column, which is none away from it.

use super::building::{HIGHER, on_node, on_output};
use super::fitted::{FittedModel, Node};
use super::modifiers::{amount, five_digits, levels_of, map, range, rounded};
use super::sharp::{best, sharpest};
use super::{Cell, EffectId, Modifier, Term, Variation};

/// A bell over the values of a column, exp(−(x − x₀)²/(2w²)), for several places and widths. Where it has risen to half of its height
/// there are two values at least: what one value does alone has no width. The best one may be twice as wide as the widest of the grid: a
/// bell over most of the range is what a change of slope has to be told from.
pub(super) fn cell(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    /// A line and a bell have five coefficients: six values leave one to say that it is a bell.
    const VALUES: usize = 7;
    /// Parts into which the range is divided for the places: resolution, the best one is made sharp.
    const PARTS: usize = 16;
    /// Widths in units of the range, each half of the one before: resolution. A bell is 0.135 of its height at 2w on either side, which
    /// is half of the range for an eighth.
    const WIDTHS: [f64; 3] = [0.125, 0.0625, 0.03125];
    let x = fitted.numbers(column);
    let levels = levels_of(x);
    let is_clock = fitted.clock.column == Some(column);
    if is_clock || fitted.is_angle(column) || levels.len() < VALUES {
        return None;
    }
    let (least, most) = range(x);
    let bell = Bell { fitted, column };
    let widths = WIDTHS.map(|part| five_digits(part * (most - least)));
    let all = (1..PARTS).flat_map(|part| {
        let place = least + part as f64 / PARTS as f64 * (most - least);
        widths.map(|width| (bell.place(place, widths[2]), width))
    });
    let mut shapes: Vec<(f64, f64)> = all.collect();
    let seen = |(place, width): &(f64, f64)| is_seen(&levels, *place, *width);
    shapes.retain(seen);
    // The best one with other widths at its place, of which it takes its uncertainty.
    let sharp = bell.sharpest(&shapes);
    let about = sharp.into_iter().flat_map(|(place, width)| {
        let own = fitted.finer.times([&widths[..], &[width]].concat());
        own.into_iter()
            .map(move |width| (place, five_digits(width)))
    });
    shapes.extend(about.filter(seen));
    let (id, name) = (EffectId::Excursion, fitted.label(column));
    shapes.extend(fitted.finer.places(id, name));
    let variants = shapes
        .iter()
        .map(|(place, width)| bell.form(*place, *width));
    Some(Cell {
        odds: HIGHER,
        ..on_node(fitted, id, name, Node::Output, variants)
    })
}

/// Whether two values at least are where a bell is more than half as high as at its top.
fn is_seen(levels: &[f64], place: f64, width: f64) -> bool {
    /// exp(−z²/2) = 1/2 for z = √(2·ln 2).
    const HALF: f64 = 1.177_410_022_515_474_7;
    let near = |x: &&f64| (*x - place).abs() <= HALF * width;
    levels.iter().filter(near).count() > 1
}

/// Bells over the values of a column.
struct Bell<'f, 'c> {
    fitted: &'f FittedModel<'c>,
    column: usize,
}

impl Bell<'_, '_> {
    fn term(&self, place: f64, width: f64) -> Term {
        let (fitted, column) = (self.fitted, self.column);
        let bell = |x: f64| {
            let z = (x - place) / width;
            libm::exp(-0.5 * z * z)
        };
        let (along, over) = (fitted.less(column, place), self.width(width));
        let text = format!("exp(-({along}/({over}))^2/2)");
        on_output(Modifier::number(map(fitted.numbers(column), bell), text))
    }

    fn form(&self, place: f64, width: f64) -> Variation {
        let shown = self.fitted.figure(self.column, place);
        let label = format!("about {shown}, w = {}", self.width(width));
        let unit = self.fitted.step_unit(self.column).after_number();
        Variation::one(label, self.term(place, width))
            .shaped("w", width, &unit)
            .about(place)
    }

    /// A width with its unit, which for a temperature is that of a difference.
    fn width(&self, width: f64) -> String {
        amount(width, &self.fitted.step_unit(self.column).after_number())
    }

    /// A place as it is told for bells of a width: to a thousandth of it, which changes nothing that noise would not hide.
    fn place(&self, x: f64, width: f64) -> f64 {
        rounded(x, 1e-3 * width)
    }

    /// The bell that explains the residuals best near the best of some, where an effect of this kind shows at all.
    fn sharpest(&self, shapes: &[(f64, f64)]) -> Option<(f64, f64)> {
        /// Widths of the grid differ by this factor.
        const RATIO: f64 = 2.0;
        let fitted = self.fitted;
        let mut terms = (shapes.iter()).map(|(place, width)| self.term(*place, *width));
        let (place, width) = shapes[best(fitted, &mut terms)?];
        // Within a width on either side.
        let moved = |by: f64| self.place(place + width * libm::log2(by), width);
        let by = sharpest(fitted, (1.0, RATIO), &|by| self.term(moved(by), width));
        let place = moved(by);
        let width = sharpest(fitted, (width, RATIO), &|width| self.term(place, width));
        Some((place, five_digits(width)))
    }
}
