//! Ends of the range and dead zones of a column: saturation, a change of slope, a band around zero in which
//! nothing happens.

use std::collections::BTreeSet;
use std::ops::Range;

use super::building::{HIGHER, added, form, on_node, on_output, plain, scoped_label};
use super::fitted::{FittedModel, Node, varies};
use super::modifiers::{
    amount, figure, figure_to, five_digits, flag, largest, levels_of, map, range, rounded,
};
use super::readout::{beside, moves_on};
use super::sets::sets;
use super::sharp::{best, sharpened};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Response;

/// Rounding of knees in formulas, as a share of the range: whoever writes the formula into a model has the
/// fit again.
const KNEE: f64 = 1e-6;
/// Rounding of knees in labels, which tell them apart.
const LABEL: f64 = 1e-4;

/// Cells of one column that is an input.
pub(super) fn cells(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    /// Fewer values show no bend.
    const VALUES: usize = 6;
    let x = fitted.numbers(column);
    let mut cells = Vec::new();
    if fitted.passes_zero(column) {
        cells.push(dead_band(fitted, column));
    }
    if levels_of(x).len() < VALUES {
        return cells;
    }
    let ends = plateaus(fitted, column);
    if ends.is_empty() {
        if fitted.passes_zero(column) {
            cells.push(soft_limit(fitted, column));
        }
        cells.push(kink(fitted, column));
        cells.extend(transitions(fitted, column));
    } else {
        let (id, name) = (EffectId::Saturation, fitted.label(column));
        cells.push(plain(fitted, id, name, ends));
    }
    cells
}

/// Limits of the outputs themselves, whatever the model makes them of: the largest or the smallest readings are the same to the
/// last digit although the model moves on, and what it gives beyond them is missing. Where they pile up along one of the
/// `columns`, that limit is a limit of the column.
pub(super) fn of_outputs(fitted: &FittedModel<'_>, columns: &[usize]) -> Vec<Cell> {
    let has_plateau = |column: &usize| !plateaus(fitted, *column).is_empty();
    if columns.iter().any(has_plateau) {
        return Vec::new();
    }
    let responses = 0..fitted.case().responses.len();
    let explicit = responses.filter(|response| !fitted.is_implicit(*response));
    let cells = explicit.filter_map(|response| {
        let name = &fitted.case().responses[response].name;
        let ends = ceilings(fitted, response);
        (!ends.is_empty()).then(|| plain(fitted, EffectId::Saturation, name, ends))
    });
    cells.collect()
}

/// Where readings of a response end.
struct Pile {
    /// 1 at the upper end, −1 at the lower one.
    sign: f64,
    level: f64,
}

impl Pile {
    fn of(observed: &[f64], sign: f64) -> Option<Pile> {
        /// Two readings are alike by chance.
        const ROWS: usize = 3;
        let most = observed.iter().map(|y| sign * y);
        let level = sign * most.fold(f64::NEG_INFINITY, f64::max);
        let pile = Pile { sign, level };
        (pile.rows(observed).count() >= ROWS).then_some(pile)
    }

    fn rows<'p>(&self, observed: &'p [f64]) -> impl Iterator<Item = usize> + 'p {
        let level = self.level;
        (0..observed.len()).filter(move |row| observed[*row] == level)
    }
}

/// The limit at either end of the readings of a response, and at both: where a converter ends on one side, readings that pile up on
/// the other need not be of several stimuli.
fn ceilings(fitted: &FittedModel<'_>, response: usize) -> Vec<Variation> {
    let observed = fitted.design.observed(response);
    if observed.len() < fitted.rows() {
        return Vec::new();
    }
    let piles = [1.0, -1.0].map(|sign| Pile::of(&observed, sign));
    let certain = |pile: &&Pile| moves_on(fitted, response, &observed, pile.rows(&observed));
    let ends: Vec<&Pile> = piles.iter().flatten().filter(certain).collect();
    let each = ends.iter().map(|end| vec![*end]);
    let both = match (&piles, ends.is_empty()) {
        ([Some(upper), Some(lower)], false) => Some(vec![upper, lower]),
        _ => None,
    };
    let all = each.chain(both);
    all.map(|piles| ceiling(fitted, response, &observed, &piles))
        .collect()
}

/// What the model gives beyond the ends, taken away.
fn ceiling(
    fitted: &FittedModel<'_>,
    response: usize,
    observed: &[f64],
    piles: &[&Pile],
) -> Variation {
    let is_there = |row: usize| piles.iter().any(|pile| pile.level == observed[row]);
    let model = beside(fitted, response, observed, &is_there);
    let within = |y: f64| {
        let ends = piles.iter();
        ends.fold(y, |y, Pile { sign, level, .. }| {
            sign * (sign * y).min(sign * level)
        })
    };
    let modifier = map(&model, |y| within(y) - y);
    let Response { name, unit, .. } = &fitted.case().responses[response];
    let (mut text, mut labels) = (name.clone(), Vec::new());
    for Pile { sign, level, .. } in piles {
        let shown = amount(*level, &unit.after_number());
        let [least, end] = match *sign > 0.0 {
            true => ["min", "above"],
            false => ["max", "below"],
        };
        text = format!("{least}({text}, {shown})");
        labels.push(format!("{end} {shown}"));
    }
    let term = added(fitted, response, modifier, format!("({text} - {name})"));
    Variation::one(labels.join(", "), term)
}

/// A step at zero, and bands of several widths around it.
fn dead_band(fitted: &FittedModel<'_>, column: usize) -> Cell {
    let (x, name) = (fitted.numbers(column), fitted.label(column));
    let unit = fitted.unit(column);
    let most = largest(x);
    let sign = map(x, |x| if x == 0.0 { 0.0 } else { x.signum() });
    let step = form("", vec![Modifier::number(sign, format!("sign({name})"))]);
    let band = |width: f64| {
        let within = |x: f64| (x / width).clamp(-1.0, 1.0);
        let text = format!("clamp({name}/({}), -1, 1)", fitted.figure(column, width));
        on_output(Modifier::number(map(x, within), text))
    };
    let widths = [0.05, 0.1, 0.2].map(|share| share * most);
    let widths = fitted.finer.times(sharpened(fitted, widths.into(), &band));
    let bands = widths.into_iter().map(five_digits).map(|width| {
        let label = format!("within {}", amount(width, &unit));
        Variation::one(label, band(width)).shaped("w", width, &unit)
    });
    let forms = [step].into_iter().chain(bands);
    on_node(fitted, EffectId::ZeroStep, name, Node::Output, forms)
}

/// Both ends bend alike.
fn soft_limit(fitted: &FittedModel<'_>, column: usize) -> Cell {
    let name = fitted.label(column);
    let unit = fitted.unit(column);
    let most = largest(fitted.numbers(column));
    let beyond = |limit: f64| {
        let shown = fitted.figure(column, rounded(limit, KNEE * most));
        let text = format!("-sign({name})*max(abs({name}) - {shown}, 0)");
        let beyond = |x: f64| -(x.abs() - limit).max(0.0) * x.signum();
        on_output(fitted.by(column, text, beyond))
    };
    let limits = [0.5, 0.6, 0.7, 0.8, 0.9].map(|share| share * most);
    let limits = sharpened(fitted, limits.into(), &beyond);
    let limits = fitted.finer.levels(limits);
    let variants = limits.into_iter().map(|limit| {
        let label = format!("above {} {unit}", figure(limit));
        Variation::one(label, beyond(limit)).shaped("x₀", limit, &unit)
    });
    plain(fitted, EffectId::Saturation, name, variants.collect())
}

/// Another slope from one value on; where the parameters do not take up a line, below one value as well, which is then something else.
fn kink(fitted: &FittedModel<'_>, column: usize) -> Cell {
    let (id, name) = (EffectId::Kink, fitted.label(column));
    let above = |at: f64| {
        let text = format!("max({}, 0)", fitted.beyond(column, at));
        on_output(fitted.by(column, text, |x| (x - at).max(0.0)))
    };
    let below = |at: f64| {
        let text = format!("max({} - {name}, 0)", fitted.figure(column, at));
        on_output(fitted.by(column, text, |x| (at - x).max(0.0)))
    };
    let is_left = |law: fn(f64) -> f64| {
        let part = on_output(fitted.by(column, "", law));
        fitted.leaves(&part)
    };
    let mut variants = knees(fitted, column, "at", &above);
    if fitted.is_line(column) && (is_left(|_| 1.0) || is_left(|x| x)) {
        // What the model is declared for holds at half of the values at least.
        let values = levels_of(fitted.numbers(column));
        let middle = values[values.len() / 2];
        let mut low = knees(fitted, column, "below", &below);
        low.retain(|one| one.shape.as_ref().is_some_and(|knee| knee.value <= middle));
        variants.extend(low);
    }
    plain(fitted, id, name, variants)
}

/// A term with its knee at values over all of the range.
fn knees(
    fitted: &FittedModel<'_>,
    column: usize,
    word: &str,
    term: &dyn Fn(f64) -> Term,
) -> Vec<Variation> {
    /// Parts into which the range is divided.
    const PARTS: usize = 16;
    let x = fitted.numbers(column);
    let unit = fitted.unit(column);
    let (least, most) = range(x);
    let parts = (1..PARTS).map(|part| part as f64 / PARTS as f64 * (most - least));
    // Beyond the last value but one there is one reading: wrong, or the only one on another slope. Beside a model that is no line
    // it is a straight background.
    let values = levels_of(x);
    let ends = [values[1], values[values.len() - 2]].map(|end| end - least);
    let ends = ends.into_iter().filter(|_| fitted.is_line(column));
    let mut distances: Vec<f64> = parts.chain(ends).collect();
    distances.sort_by(f64::total_cmp);
    let term = |at: f64| term(rounded(at, KNEE * (most - least)));
    let distances = sharpened(fitted, distances, &|distance| term(least + distance));
    let knees = map(&distances, |distance| least + distance);
    let variants = fitted.finer.levels(knees).into_iter().map(|at| {
        let shown = figure_to(at, LABEL * (most - least));
        Variation::one(format!("{word} {shown} {unit}"), term(at)).shaped("x₀", at, &unit)
    });
    variants.collect()
}

/// The output or its scale is another one from one value on, the scale where the column has both signs beyond it on either side.
/// Where the sign changes, the step is one at zero.
fn transitions(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let (x, label) = (fitted.numbers(column), fitted.label(column));
    let by_size = fitted.passes_zero(column);
    // Ranges are switched by the size of a quantity that has both signs.
    let (size, name): (fn(f64) -> f64, String) = match by_size {
        true => (f64::abs, format!("abs({label})")),
        false => (|x| x, label.to_owned()),
    };
    let by_sign = by_size.then(|| steps(fitted, x, (|x| x, label), Node::Output));
    let of_ranges = steps(fitted, x, (size, &name), Node::Output);
    let own = by_sign.into_iter().flatten().chain(of_ranges);
    let output = on_node(fitted, EffectId::Transition, label, Node::Output, own);
    let scale = fitted.offset_and_scale().contains(&Node::Gain).then(|| {
        let own = steps(fitted, x, (size, &name), Node::Gain);
        on_node(fitted, EffectId::TransitionScale, label, Node::Gain, own)
    });
    let cells = [output].into_iter().chain(scale);
    let odds = HIGHER;
    cells.map(|cell| Cell { odds, ..cell }).collect()
}

/// Steps of what a column is in some sense, between values of which two at least lie on either side: all of them, or some evenly, those
/// in the widest gaps, since values that were measured lie about those that were set, and the best of all. Where the residuals show several, also these together: an instrument with several ranges has a step at each of
/// their ends.
fn steps(
    fitted: &FittedModel<'_>,
    x: &[f64],
    (size, name): (fn(f64) -> f64, &str),
    node: Node,
) -> Vec<Variation> {
    /// More are not scanned.
    const MOST: usize = 40;
    /// Gaps of more than this times the mean one are between set points; in an even series there are none.
    const WIDE: f64 = 2.0;
    /// More are not tried, of which the best is scanned as well.
    const MOST_TRIED: usize = 1000;
    let values = map(&levels_of(x), size);
    let x = &map(x, size);
    let levels = levels_of(x);
    let (least, most) = (levels[0], levels[levels.len() - 1]);
    let shown = |x: f64| figure_to(x, LABEL * (most - least));
    let between = |upper: usize| [levels[upper - 1], levels[upper]];
    let mut ascending = values.clone();
    ascending.sort_by(f64::total_cmp);
    let below = |upper: usize| ascending.partition_point(|value| *value < levels[upper]);
    let parts = |upper: &usize| below(*upper).min(values.len() - below(*upper)) > 1;
    let of_one_sign = |upper: &usize| between(*upper)[0] > 0.0 || between(*upper)[1] < 0.0;
    let gaps = (1..levels.len()).filter(|upper| parts(upper) && of_one_sign(upper));
    let gaps: Vec<usize> = gaps.collect();
    let step = |upper: usize| {
        let [below, above] = between(upper);
        let after = map(x, |x| flag(x >= above));
        Modifier::number(after, format!("[{name} > {}]", shown(below)))
    };
    let one = |upper: usize| {
        let [below, above] = between(upper).map(shown);
        form(
            format!("{name} between {below} and {above}"),
            vec![step(upper)],
        )
    };
    let on = |upper: &usize| Term::new(node, step(*upper));
    let scanned = match gaps.len() > MOST {
        false => gaps,
        true => {
            // Each takes the time of a pass through all rows.
            let closer = gaps.len().div_ceil(MOST_TRIED);
            let tried = gaps.iter().step_by(closer).map(on);
            let best = best(fitted, &mut { tried }).map(|at| gaps[at * closer]);
            let evenly = gaps.iter().step_by(gaps.len().div_ceil(MOST)).copied();
            let width = |upper: &usize| between(*upper)[1] - between(*upper)[0];
            let mean = (most - least) / (levels.len() - 1) as f64;
            let wide = gaps.iter().filter(|upper| width(upper) > WIDE * mean);
            let mut widest: Vec<usize> = wide.copied().collect();
            widest.sort_by(|a, b| width(b).total_cmp(&width(a)));
            widest.truncate(MOST);
            let all: BTreeSet<usize> = evenly.chain(widest).chain(best).collect();
            all.into_iter().collect()
        }
    };
    let terms: Vec<Term> = scanned.iter().map(on).collect();
    let several = sets(fitted, &terms, scanned.clone())
        .into_iter()
        .map(|set| {
            let uppers = set.members.iter().map(|at| scanned[*at]);
            let uppers: Vec<usize> = uppers.collect();
            let lower = uppers.iter().map(|upper| shown(between(*upper)[0]));
            let lower: Vec<String> = lower.collect();
            let modifiers = uppers.iter().map(|upper| step(*upper)).collect();
            Variation {
                // One more is as much less likely as any further order; each set of as many is as likely as any other.
                weight: scanned.len() as f64 * set.share * HIGHER.powi(uppers.len() as i32 - 1),
                is_set: true,
                ..form(format!("{name} above {}", lower.join(", ")), modifiers)
            }
        });
    let single = scanned.iter().map(|upper| one(*upper));
    single.chain(several).collect()
}

/// Ends of the range at which the readings pile up at one value although the model moves on: what is
/// missing there is the whole of the signal beyond the knee. Where they do so at both, both are of one limiter.
fn plateaus(fitted: &FittedModel<'_>, column: usize) -> Vec<Variation> {
    let x = fitted.numbers(column);
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
    let mut variants = Vec::new();
    for response in 0..fitted.case().responses.len() {
        let missing = |knees: &[Knee]| missing(fitted, column, response, knees);
        let upper = End::of(fitted, column, response, &order);
        order.reverse();
        let lower = End::of(fitted, column, response, &order);
        order.reverse();
        for end in upper.iter().chain(&lower) {
            let knees = end.knees(fitted, &|knee| missing(&[knee]));
            variants.extend(knees.into_iter().map(|knee| missing(&[knee])));
        }
        if let (Some(upper), Some(lower)) = (upper, lower) {
            let both = both(fitted, [&upper, &lower], &missing);
            variants.extend(both.iter().map(|knees| missing(knees)));
        }
    }
    variants.retain(|v| varies(&v.terms[0].modifier.values));
    variants
}

/// Where readings stop to follow a column.
#[derive(Clone, Copy)]
struct Knee {
    /// 1 for what lies above, −1 for what lies below.
    sign: f64,
    at: f64,
}

/// The end of a column on which readings pile up: the values before and behind the knee.
struct End {
    inside: f64,
    outside: f64,
}

impl End {
    /// Of an order of the rows that ends with the plateau; nothing if there is none.
    fn of(
        fitted: &FittedModel<'_>,
        column: usize,
        response: usize,
        order: &[usize],
    ) -> Option<End> {
        let x = fitted.numbers(column);
        let (observed, signal) = (fitted.design.observed(response), fitted.signal(response));
        let begin = plateau(&observed, signal, x, order)?;
        let (inside, outside) = (x[order[begin.start - 1]], x[order[begin.end]]);
        Some(End { inside, outside })
    }

    /// A knee at a share of the way onto the plateau.
    fn knee(&self, share: f64) -> Knee {
        let step = self.outside - self.inside;
        Knee {
            sign: step.signum(),
            at: self.inside + step * share,
        }
    }

    /// Knees on the way onto the plateau, with the one between them that explains the residuals best.
    fn knees(&self, fitted: &FittedModel<'_>, form: &dyn Fn(Knee) -> Variation) -> Vec<Knee> {
        /// Knees that are tried without looking at the residuals.
        const KNEES: usize = 8;
        let shares = (1..=KNEES).map(|step| step as f64 / KNEES as f64);
        let term = |share: f64| form(self.knee(share)).terms.swap_remove(0);
        let shares = sharpened(fitted, shares.collect(), &term);
        shares.into_iter().map(|share| self.knee(share)).collect()
    }
}

/// Knees at both ends: all pairs of those of either, each beside the best one of the other end.
fn both(
    fitted: &FittedModel<'_>,
    ends: [&End; 2],
    missing: &dyn Fn(&[Knee]) -> Variation,
) -> Vec<[Knee; 2]> {
    /// How often each end is looked for beside the other: they act on rows of their own, and meet in the parameters alone.
    const ROUNDS: usize = 4;
    let [mut upper, mut lower] = ends.map(|end| vec![end.knee(0.5)]);
    let best = |pairs: &[[Knee; 2]]| {
        let mut terms = pairs.iter().flat_map(|pair| missing(pair).terms);
        best(fitted, &mut terms).map_or([pairs[0][0], pairs[0][1]], |at| pairs[at])
    };
    let mut found = [upper[0], lower[0]];
    for _ in 0..ROUNDS {
        upper = ends[0].knees(fitted, &|knee| missing(&[knee, found[1]]));
        found = best(&pairs(&upper, &found[1..]));
        lower = ends[1].knees(fitted, &|knee| missing(&[found[0], knee]));
        found = best(&pairs(&found[..1], &lower));
    }
    pairs(&upper, &lower)
}

fn pairs(upper: &[Knee], lower: &[Knee]) -> Vec<[Knee; 2]> {
    let pairs = upper
        .iter()
        .flat_map(|upper| lower.iter().map(|lower| [*upper, *lower]));
    pairs.collect()
}

/// What is missing of a response beyond each of some knees.
fn missing(fitted: &FittedModel<'_>, column: usize, response: usize, knees: &[Knee]) -> Variation {
    let (name, unit) = (fitted.label(column), fitted.unit(column));
    let (least, most) = range(fitted.numbers(column));
    let beyond = |Knee { sign, at }: &Knee| {
        let at = rounded(*at, KNEE * (most - least));
        match *sign > 0.0 {
            true => format!("max({}, 0)", fitted.beyond(column, at)),
            false => format!("max({} - {name}, 0)", fitted.figure(column, at)),
        }
    };
    let text = match knees {
        [upper, lower] => format!("({} - {})", beyond(lower), beyond(upper)),
        [lower @ Knee { sign, .. }] if *sign < 0.0 => beyond(lower),
        upper => upper
            .iter()
            .map(|knee| format!("-{}", beyond(knee)))
            .collect(),
    };
    let labels = knees.iter().map(|Knee { sign, at }| {
        let side = if *sign > 0.0 { "above" } else { "below" };
        format!("{side} {} {unit}", figure_to(*at, LABEL * (most - least)))
    });
    let labels: Vec<String> = labels.collect();
    let law = |x: f64| -> f64 {
        let beyond = |Knee { sign, at }: &Knee| -sign * (sign * (x - at)).max(0.0);
        knees.iter().map(beyond).sum()
    };
    let mut form = Variation::one(labels.join(", "), on_output(fitted.by(column, text, law)));
    if let [knee] = knees {
        form = form.shaped("x₀", knee.at, &unit);
    }
    if let responses @ [_, _, ..] = &fitted.case().responses[..] {
        form.label = scoped_label(&responses[response].name, &form);
        form.terms[0].response = Some(response);
    }
    form
}

/// Where a plateau begins in an order of the rows that ends with it, between the row before and the end of what is given: its first
/// rows may still be on the way to it, as far as readings may move. Nothing if there is none. In one pass from the end, since a
/// recording may have a million rows.
fn plateau(observed: &[f64], signal: &[f64], x: &[f64], order: &[usize]) -> Option<Range<usize>> {
    /// Rows and values that a plateau has at least.
    const ROWS: usize = 4;
    const VALUES: usize = 3;
    /// The readings move by less than this part of what the model says.
    const STILL: f64 = 0.1;
    // The longest; the line before it needs rows of its own.
    let shortest = order.len().checked_sub(ROWS)?;
    let nothing = (f64::INFINITY, f64::NEG_INFINITY);
    let wider = |(least, most): (f64, f64), y: f64| (least.min(y), most.max(y));
    let (mut seen, mut expected, mut values) = (nothing, nothing, 0);
    let mut longest = None;
    for first in (order.len() / 4 + 1..order.len()).rev() {
        let row = order[first];
        (seen, expected) = (wider(seen, observed[row]), wider(expected, signal[row]));
        // The order is that of the values.
        values += usize::from(order.get(first + 1).is_none_or(|next| x[*next] != x[row]));
        // Readings that are still to be recorded have no range.
        let still = 0.0..STILL * (expected.1 - expected.0);
        if first <= shortest && values >= VALUES && still.contains(&(seen.1 - seen.0)) {
            longest = Some(first);
        }
    }
    let first = longest?;
    let way = |row: &usize| (signal[*row] - signal[order[first]]).abs();
    let way_of_readings = STILL * order[first..].iter().map(way).fold(0.0, f64::max);
    let is_on = |place: &usize| way(&order[*place]) > way_of_readings;
    Some(first..(first..order.len()).find(is_on)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plateau_begins_where_readings_stay() {
        let x: Vec<f64> = (0..40).map(f64::from).collect();
        let order: Vec<usize> = (0..40).collect();
        let clipped: Vec<f64> = x
            .iter()
            .map(|x| x.min(29.5) + 0.01 * libm::sin(7.0 * x))
            .collect();
        assert_eq!(plateau(&clipped, &x, &x, &order), Some(29..31));
        let straight: Vec<f64> = x.iter().map(|x| 2.0 * x).collect();
        assert_eq!(plateau(&straight, &straight, &x, &order), None);
        assert_eq!(plateau(&[f64::NAN; 40], &x, &x, &order), None);
    }
}
