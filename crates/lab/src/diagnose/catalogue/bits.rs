//! Weights of the bits of a converter: where the output has a bit of its code set, it is off by the error of that bit.

use super::building::{HIGHER, on_node, on_output, plain};
use super::fitted::{FittedModel, Node};
use super::modifiers::{figure, five_digits, levels_of, map, range};
use super::sharp::best;
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::{Observed, Role};
use crate::recording::resolution::{Steps, steps};

/// Codes of the smallest converters, of eight bits: numbers without unit over fewer may be anything else.
const CODES: f64 = 255.0;

/// Cells of the outputs that may be those of converters, and of stimuli that are their codes.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let responses = 0..fitted.case().responses.len();
    let explicit = responses.filter(|response| !fitted.is_implicit(*response));
    let outputs = explicit.filter_map(|response| of_output(fitted, response));
    let stimuli = fitted.used(Role::Stimulus);
    let codes = stimuli.filter_map(|column| of_codes(fitted, column));
    outputs.chain(codes).collect()
}

fn of_output(fitted: &FittedModel<'_>, response: usize) -> Option<Cell> {
    let output = &fitted.case().responses[response];
    let codes = Codes {
        name: &output.name,
        unit: output.unit.after_number(),
        values: &fitted.fit.linear.values[response],
        base: base(fitted, response)?,
    };
    let added = |modifier: Modifier| on_output(modifier).on(response);
    let mut cell = plain(
        fitted,
        EffectId::BitWeight,
        &output.name,
        codes.variants(fitted, &added),
    );
    cell.odds = HIGHER;
    Some(cell)
}

/// Where the codes are the stimulus, as in a table of the errors of a converter.
fn of_codes(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    let (values, label) = (fitted.numbers(column), fitted.label(column));
    let is_code = |x: &f64| *x >= 0.0 && x.fract() == 0.0;
    let recorded = &fitted.design.recording().columns[column];
    let numbers = recorded.numbers()?;
    let (least, most) = range(numbers);
    if !recorded.unit.is_one() || !numbers.iter().all(is_code) || most - least < CODES {
        return None;
    }
    let codes = Codes {
        name: label,
        unit: String::new(),
        values,
        base: Base::least(1.0),
    };
    let variants = codes.variants(fitted, &on_output);
    let (id, node) = (EffectId::BitWeight, Node::Output);
    let mut cell = on_node(fitted, id, label, node, variants);
    cell.odds = HIGHER;
    Some(cell)
}

/// What is taken for codes.
struct Codes<'c> {
    name: &'c str,
    unit: String,
    values: &'c [f64],
    base: Base,
}

impl Codes<'_> {
    /// Each bit by itself, and all that can be seen, each with an error of its own; but for the uppermost: all of them in
    /// proportion to their weights are the code, so that its error is one of the scale and of the others.
    fn variants(
        &self,
        fitted: &FittedModel<'_>,
        term: &dyn Fn(Modifier) -> Term,
    ) -> Vec<Variation> {
        let bits = self.bits(fitted, term);
        let alone = bits.iter().filter(|bit| bit.edges > 1);
        let mut variants: Vec<Variation> = alone
            .map(|bit| Variation::one(bit.label(self), term(bit.modifier(self))))
            .collect();
        if bits.len() > 2 {
            let terms = bits.iter().skip(1).map(|bit| term(bit.modifier(self)));
            variants.push(Variation::of("each bit its own", terms.collect()));
        }
        variants
    }

    /// The bits that the recording can show: they change within the codes, and between two changes there are codes. One change is
    /// a step at one value, whatever makes it.
    fn bits(&self, fitted: &FittedModel<'_>, term: &dyn Fn(Modifier) -> Term) -> Vec<Bit> {
        /// Codes from one change to the next, at least: of fewer, a mean of rows on both sides of a change may be the only one, and
        /// a bit that changes more often than the codes is as good as any other choice among few of them.
        const FEWEST: f64 = 2.0;
        let (least, most) = range(self.values);
        if most <= least {
            return Vec::new();
        }
        let base = &self.base;
        let span = libm::log2((most - least) / base.weight);
        let codes = levels_of(self.values).len() as f64;
        // From the bit that changes once or twice down to the one whose changes follow one another too closely.
        let highest = span.ceil() as i32;
        let lowest = (span - libm::log2(codes / FEWEST)).ceil() as i32;
        let lowest = if base.is_least { lowest.max(0) } else { lowest };
        let lattice = |before: f64| -> Vec<Bit> {
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
        let lattices: Vec<Vec<Bit>> = base.zeros().into_iter().map(lattice).collect();
        let tried = lattices.iter().enumerate();
        let tried = tried.flat_map(|(at, bits)| bits.iter().map(move |bit| (at, bit)));
        let tried: Vec<(usize, &Bit)> = tried.collect();
        let mut terms = tried.iter().map(|(_, bit)| term(bit.modifier(self)));
        let best = best(fitted, &mut terms).map_or(0, |best| tried[best].0);
        lattices.into_iter().nth(best).unwrap_or_default()
    }
}

/// A bit by its weight, in the unit of the codes.
struct Bit {
    weight: f64,
    /// How far before a multiple of its weight it changes.
    before: f64,
    /// How often it changes over the codes.
    edges: usize,
}

impl Bit {
    fn label(&self, codes: &Codes<'_>) -> String {
        format!("bit of {} {}", figure(self.weight), codes.unit)
    }

    /// 1 where it is set.
    fn modifier(&self, codes: &Codes<'_>) -> Modifier {
        let (weight, before) = (self.weight, self.before);
        let is_set = map(codes.values, |y| {
            ((y + before) / weight).floor().rem_euclid(2.0)
        });
        let name = match before {
            0.0 => codes.name.to_owned(),
            ..0.0 => format!("({} - {})", codes.name, figure(-before)),
            _ => format!("({} + {})", codes.name, figure(before)),
        };
        let (one, two) = (figure(weight), figure(2.0 * weight));
        Modifier::number(
            is_set,
            format!("(floor({name}/{one}) - 2*floor({name}/{two}))"),
        )
    }
}

/// A weight of which those of all bits are powers of two.
struct Base {
    weight: f64,
    /// Whether no bit is less.
    is_least: bool,
}

impl Base {
    fn least(weight: f64) -> Base {
        Base {
            weight,
            is_least: true,
        }
    }

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

/// Codes have steps of 1; other outputs say their step, show it, or say their full scale.
fn base(fitted: &FittedModel<'_>, response: usize) -> Option<Base> {
    let case = fitted.case();
    let output = &case.responses[response];
    // Codes, or means of them.
    let (least, most) = range(&fitted.design.observed(response));
    if output.unit.is_one() && most - least >= CODES {
        return Some(Base::least(1.0));
    }
    let Observed::Column(column) = output.observed else {
        return None;
    };
    let stated = case.columns[column].resolution.map(Base::least);
    let full = || {
        case.columns[column].full_scale.map(|weight| Base {
            weight,
            is_least: false,
        })
    };
    let shown = || {
        let Steps { step, .. } = steps(&fitted.design.observed(response))?;
        (!is_decimal(step)).then(|| Base::least(step))
    };
    stated.or_else(shown).or_else(full)
}

/// Whether a step is one of those of displays: 1, 2 or 5 in a decimal place.
fn is_decimal(step: f64) -> bool {
    let digits = format!("{step:e}");
    let mantissa = digits.split('e').next().unwrap_or_default();
    matches!(mantissa, "1" | "2" | "5")
}
