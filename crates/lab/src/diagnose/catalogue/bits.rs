//! Weights of the bits of a converter: where the output has a bit of its code set, it is off by the error of that bit.

use super::building::{HIGHER, added, plain};
use super::fitted::FittedModel;
use super::modifiers::{figure, five_digits, map, range};
use super::sharp::best;
use super::{Cell, EffectId, Variation};
use crate::diagnose::case::Observed;
use crate::diagnose::resolution::{Steps, steps};

/// Cells of the outputs that may be those of converters.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let responses = 0..fitted.case().responses.len();
    responses
        .filter_map(|response| cell(fitted, response))
        .collect()
}

/// Each bit by itself, and all that can be seen, each with an error of its own.
fn cell(fitted: &FittedModel<'_>, response: usize) -> Option<Cell> {
    if fitted.is_implicit(response) || fitted.design.blocks.len() < fitted.rows() {
        return None;
    }
    let weights = weights(fitted, response);
    let alone = weights.iter().filter(|bit| bit.edges > 1);
    let mut variants: Vec<Variation> = alone.map(|bit| bit.variation(fitted, response)).collect();
    if variants.is_empty() {
        return None;
    }
    if weights.len() > 1 {
        let each = weights.iter().map(|bit| bit.variation(fitted, response));
        let terms = each.flat_map(|variation| variation.terms).collect();
        variants.push(Variation::of("each bit its own", terms));
    }
    let name = &fitted.case().responses[response].name;
    let mut cell = plain(fitted, EffectId::BitWeight, name, variants);
    cell.words.y.clone_from(name);
    cell.odds = HIGHER;
    Some(cell)
}

/// A bit by its weight, in the unit of the output.
struct Bit {
    weight: f64,
    /// How far before a multiple of its weight it changes.
    before: f64,
    /// How often it changes over the values of the output.
    edges: usize,
}

impl Bit {
    fn variation(&self, fitted: &FittedModel<'_>, response: usize) -> Variation {
        let model = &fitted.fit.linear.values[response];
        let (weight, before) = (self.weight, self.before);
        let is_set = map(model, |y| ((y + before) / weight).floor().rem_euclid(2.0));
        let output = &fitted.case().responses[response];
        let name = match before {
            0.0 => output.name.clone(),
            ..0.0 => format!("({} - {})", output.name, figure(-before)),
            _ => format!("({} + {})", output.name, figure(before)),
        };
        let (one, two) = (figure(weight), figure(2.0 * weight));
        let text = format!("(floor({name}/{one}) - 2*floor({name}/{two}))");
        let label = format!("bit of {one} {}", output.unit.after_number());
        Variation::one(label, added(fitted, response, is_set, text))
    }
}

/// The bits that the recording can show: they change within the values of the output, and between two changes there are rows.
/// One change is a step at one value, whatever makes it.
fn weights(fitted: &FittedModel<'_>, response: usize) -> Vec<Bit> {
    /// Fewer rows on average from one change to the next are those of anything.
    const ROWS: f64 = 4.0;
    let model = &fitted.fit.linear.values[response];
    let (least, most) = range(model);
    let Some(base) = base(fitted, response).filter(|_| most > least) else {
        return Vec::new();
    };
    let span = libm::log2((most - least) / base.weight);
    let rows = fitted.rows() as f64;
    // From the bit that changes once or twice down to the one whose changes follow one another too closely.
    let highest = span.ceil() as i32;
    let lowest = (span - libm::log2(rows / ROWS)).ceil() as i32;
    let lowest = if base.is_least { lowest.max(0) } else { lowest };
    let bits = |before: f64| -> Vec<Bit> {
        let bit = |power: i32| {
            let weight = five_digits(base.weight * libm::exp2(f64::from(power)));
            let place = |y: f64| ((y + before) / weight).floor();
            Bit {
                weight,
                before,
                edges: (place(most) - place(least)) as usize,
            }
        };
        let bits = (lowest..=highest).rev().map(bit);
        bits.filter(|bit| bit.edges > 0).collect()
    };
    let lattices: Vec<Vec<Bit>> = base.zeros().into_iter().map(bits).collect();
    let tried = lattices.iter().enumerate();
    let tried = tried.flat_map(|(at, bits)| bits.iter().map(move |bit| (at, bit)));
    let tried: Vec<(usize, &Bit)> = tried.collect();
    let mut terms = tried
        .iter()
        .flat_map(|(_, bit)| bit.variation(fitted, response).terms);
    let best = best(fitted, &mut terms).map_or(0, |best| tried[best].0);
    lattices.into_iter().nth(best).unwrap_or_default()
}

/// A weight of which those of all bits are powers of two.
struct Base {
    weight: f64,
    /// Whether no bit is less.
    is_least: bool,
}

impl Base {
    /// How far before a multiple of their weights bits may change, the likeliest first. A code holds for half a step about it;
    /// errors of a few steps move the zero that is fitted as well.
    fn zeros(&self) -> Vec<f64> {
        let steps: &[f64] = match self.is_least {
            true => &[0.5, 1.5, -0.5, 2.5, -1.5],
            false => &[0.0],
        };
        steps.iter().map(|steps| steps * self.weight).collect()
    }
}

/// Codes count from 1; other outputs say their resolution, show it, or say their full scale.
fn base(fitted: &FittedModel<'_>, response: usize) -> Option<Base> {
    let case = fitted.case();
    let output = &case.responses[response];
    let least = |weight: f64| Base {
        weight,
        is_least: true,
    };
    if output.unit.is_one() {
        return Some(least(1.0));
    }
    let Observed::Column(column) = output.observed else {
        return None;
    };
    let stated = case.columns[column].resolution.map(least);
    let full = || {
        case.columns[column].full_scale.map(|weight| Base {
            weight,
            is_least: false,
        })
    };
    let shown = || {
        let Steps { step, .. } = steps(&fitted.design.observed(response))?;
        (!is_decimal(step)).then(|| least(step))
    };
    stated.or_else(shown).or_else(full)
}

/// Whether a step is one of those of displays: 1, 2 or 5 in a decimal place.
fn is_decimal(step: f64) -> bool {
    let digits = format!("{step:e}");
    let mantissa = digits.split('e').next().unwrap_or_default();
    matches!(mantissa, "1" | "2" | "5")
}
