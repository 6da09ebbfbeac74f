//! What is tried beside the grids once something was found. Variants step through time constants and knees: the values about the one
//! that was found, in that effect alone. An effect has one size in all rows: some are asked for with a size for each label, too
//! (`by_label`).

use super::modifiers::range;
use super::{Cell, EffectId, ShapeParameter, Variation, Words};

/// Parts into which the distance from a value to its neighbours is divided.
const PARTS: usize = 4;
/// Values are the same if they differ by no more than labels round off, as a share of the values or of the
/// grid that they span.
const ROUNDED: f64 = 1e-4;

/// What is tried beside the grids.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Finer {
    around: Vec<Around>,
    /// Of which effects the size may differ from one label to another.
    pub(super) by_label: Forms,
}

/// All forms of some effects.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Forms(Vec<(EffectId, Words)>);

/// Values about one that was found.
#[derive(Debug, Clone, PartialEq)]
struct Around {
    /// The effect, and what it follows.
    id: EffectId,
    along: String,
    is_time: bool,
    values: Vec<f64>,
    span: f64,
    /// Wherever they lie: the grid of another recording may end before them.
    is_kept: bool,
    /// Where along the column.
    about: Option<f64>,
}

impl Forms {
    /// Whether an effect may be one of them: not what happens once, or under a label.
    pub(super) fn may_be(cell: &Cell) -> bool {
        cell.effect.pattern.is_none() && cell.variants.iter().all(|form| form.spectrum.is_none())
    }

    /// Adds all forms of an effect that may be one of them.
    pub fn add(&mut self, cell: &Cell) {
        if Forms::may_be(cell) {
            self.0.push((cell.effect.id, cell.words.clone()));
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether the forms of an effect are.
    pub(super) fn has(&self, cell: &Cell) -> bool {
        let is_it = |one: &(EffectId, Words)| one.0 == cell.effect.id && one.1 == cell.words;
        self.0.iter().any(is_it)
    }
}

impl Finer {
    /// Sizes that may differ by label.
    pub fn by_label(by_label: Forms) -> Finer {
        Finer {
            by_label,
            ..Finer::default()
        }
    }

    /// Adds the values between the parameter of a variation that was found and its neighbours in the cell, under labels as well where
    /// it is one of them. Whether there are any: a variation without a parameter has none.
    pub fn add(&mut self, cell: &Cell, found: &Variation) -> bool {
        let Some(shape) = &found.shape else {
            return false;
        };
        if found.of_labels.is_some() {
            self.by_label.add(cell);
        }
        let shapes = cell
            .variants
            .iter()
            .filter_map(|other| other.shape.as_ref());
        let of_kind = shapes.filter(|other| other.symbol == shape.symbol);
        let all: Vec<f64> = of_kind.map(|other| other.value).collect();
        let (own, is_time) = (shape.value, is_time(shape));
        let span = span(&all, is_time);
        let other = |x: &f64| !same(*x, own, span);
        let below = all.iter().copied().filter(|x| *x < own && other(x));
        let above = all.iter().copied().filter(|x| *x > own && other(x));
        let neighbours = [below.reduce(f64::max), above.reduce(f64::min)];
        let between =
            |next: f64| (1..PARTS).map(move |part| own + (next - own) * part as f64 / PARTS as f64);
        let values: Vec<f64> = neighbours.into_iter().flatten().flat_map(between).collect();
        let known =
            |x: &f64| (self.around.iter()).any(|around| around.is_of(cell) && around.has(*x));
        let new = !values.iter().all(known);
        self.around.push(Around::of(cell, is_time, values, span));
        new
    }

    /// Keeps the parameter of a variation for another recording, whose grid has others.
    pub fn keep(&mut self, cell: &Cell, found: &Variation) {
        let around = |shape: &ShapeParameter| Around {
            is_kept: true,
            about: shape.about,
            ..Around::of(cell, is_time(shape), vec![shape.value], f64::INFINITY)
        };
        self.around.extend(found.shape.as_ref().map(around));
    }

    /// Places of an effect that were kept, each with its shape.
    pub(super) fn places(&self, id: EffectId, along: &str) -> Vec<(f64, f64)> {
        let own = |around: &&Around| around.id == id && around.along == along;
        let kept = self.around.iter().filter(own);
        let places = kept.filter_map(|around| Some((around.about?, *around.values.first()?)));
        places.collect()
    }

    /// A grid of times with those between.
    pub(super) fn times(&self, grid: Vec<f64>) -> Vec<f64> {
        self.with(grid, true)
    }

    /// A grid of values of a column with those between.
    pub(super) fn levels(&self, grid: Vec<f64>) -> Vec<f64> {
        self.with(grid, false)
    }

    fn with(&self, mut grid: Vec<f64>, is_time: bool) -> Vec<f64> {
        let (low, high) = range(&grid);
        let span = span(&grid, is_time);
        let around = self
            .around
            .iter()
            .filter(|around| around.is_time == is_time);
        grid.extend(around.flat_map(|around| {
            let inside = |x: &f64| around.is_kept || (low..=high).contains(x);
            around.values.iter().copied().filter(inside)
        }));
        grid.sort_by(f64::total_cmp);
        grid.dedup_by(|a, b| same(*a, *b, span));
        grid
    }

    /// Takes the values between away from effects that were not found.
    pub(super) fn prune(&self, cells: &mut [Cell]) {
        for cell in cells {
            let (own, others): (Vec<&Around>, Vec<&Around>) =
                self.around.iter().partition(|around| around.is_of(cell));
            let has = |all: &[&Around], x: f64| all.iter().any(|around| around.has(x));
            cell.variants.retain(|variation| {
                let value = variation.shape.as_ref().map(|shape| shape.value);
                value.is_none_or(|x| has(&own, x) || !has(&others, x))
            });
        }
    }
}

impl Around {
    fn of(cell: &Cell, is_time: bool, values: Vec<f64>, span: f64) -> Around {
        Around {
            id: cell.effect.id,
            along: cell.place.along.clone(),
            is_time,
            values,
            span,
            is_kept: false,
            about: None,
        }
    }

    fn is_of(&self, cell: &Cell) -> bool {
        self.id == cell.effect.id && self.along == cell.place.along
    }

    fn has(&self, x: f64) -> bool {
        self.values.iter().any(|value| same(*value, x, self.span))
    }
}

/// Whether a parameter is a time, or something else that is told apart by ratios.
fn is_time(shape: &ShapeParameter) -> bool {
    shape.symbol != "x₀"
}

/// What a grid spans; times are told apart by their ratios alone.
fn span(grid: &[f64], is_time: bool) -> f64 {
    if is_time {
        return f64::INFINITY;
    }
    let (low, high) = range(grid);
    high - low
}

fn same(a: f64, b: f64, span: f64) -> bool {
    (a - b).abs() <= ROUNDED * a.abs().max(b.abs()).min(span)
}

#[cfg(test)]
mod tests {
    use super::super::{Modifier, Node, Term, Words};
    use super::*;
    use crate::diagnose::evidence::Place;

    fn cell(id: EffectId, grid: &[f64]) -> Cell {
        let one = |tau: &f64| {
            let term = Term::new(Node::Output, Modifier::unnamed(vec![*tau]));
            Variation::one("", term).shaped("τ", *tau, "s")
        };
        let variants = grid.iter().map(one).collect();
        Cell::new(id, Words::default(), Place::default(), variants)
    }

    #[test]
    fn values_lie_between_neighbours_and_close_in() {
        let mut finer = Finer::default();
        let lag = cell(EffectId::Lag, &[1.0, 2.0, 4.0]);
        assert!(finer.add(&lag, &lag.variants[1]));
        let grid = finer.times(vec![1.0, 2.0, 4.0]);
        assert_eq!(grid, [1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0]);
        let lag = cell(EffectId::Lag, &grid);
        assert!(finer.add(&lag, &lag.variants[1]));
        assert_eq!(finer.times(vec![1.0, 1.5])[1..4], [1.0625, 1.125, 1.1875]);
        assert_eq!(finer.levels(vec![1.0, 2.0]), [1.0, 2.0]);
    }

    #[test]
    fn what_is_kept_may_lie_beyond_the_grid_of_another_recording() {
        let lag = cell(EffectId::Lag, &[1.0, 2.0, 4.0]);
        let (mut added, mut kept) = (Finer::default(), Finer::default());
        added.add(&lag, &lag.variants[2]);
        kept.keep(&lag, &lag.variants[2]);
        assert_eq!(added.times(vec![0.5, 1.0, 2.0]), [0.5, 1.0, 2.0]);
        assert_eq!(kept.times(vec![0.5, 1.0, 2.0]), [0.5, 1.0, 2.0, 4.0]);
    }

    #[test]
    fn values_far_from_zero_are_told_apart() {
        let grid: Vec<f64> = (0..15).map(|knee| 101_320.0 + f64::from(knee)).collect();
        assert_eq!(Finer::default().levels(grid.clone()), grid);
        let mut finer = Finer::default();
        let mut kink = cell(EffectId::Kink, &grid);
        for variant in &mut kink.variants {
            variant.shape.as_mut().unwrap().symbol = "x₀";
        }
        assert!(finer.add(&kink, &kink.variants[6]));
        assert_eq!(
            finer.levels(grid)[6..9],
            [101_325.25, 101_325.5, 101_325.75]
        );
    }

    #[test]
    fn other_effects_keep_their_grids() {
        let mut finer = Finer::default();
        let lag = cell(EffectId::Lag, &[1.0, 2.0, 4.0]);
        finer.add(&lag, &lag.variants[1]);
        let grid = finer.times(vec![1.0, 2.0, 4.0]);
        let mut cells = [cell(EffectId::Lag, &grid), cell(EffectId::WarmUp, &grid)];
        finer.prune(&mut cells);
        assert_eq!(cells[0].variants.len(), 9);
        assert_eq!(cells[1].variants.len(), 3);
    }

    #[test]
    fn what_has_no_parameter_has_no_neighbours() {
        let mut plain = cell(EffectId::Lag, &[1.0, 2.0]);
        plain.variants[0].shape = None;
        assert!(!Finer::default().add(&plain, &plain.variants[0]));
    }
}
