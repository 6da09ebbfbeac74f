//! Delays of a column: the output follows what it was, or will be.

use super::earlier::{delayed, is_smooth, smoothly_delayed};
use super::fitted::{FittedModel, Node};
use super::modifiers::{grid, map, map2, range};
use super::sharp::sharpened;
use super::{Modifier, Term, Variation};

/// Delays: small ones by the rate of change, and those of more than an interval, in which a course bends, by the course as it
/// was then less that of now, over the delay. The size is the delay itself.
pub(super) fn of(fitted: &FittedModel<'_>, column: usize) -> Vec<Variation> {
    let instant = Term::new(Node::Column(column), fitted.rate(column).negated());
    // Between the rows the course may have corners or none.
    let interval = fitted.clock.interval;
    let (law, shortest): (Between, f64) =
        match is_smooth(&fitted.clock.values, fitted.numbers(column)) {
            true => (smoothly_delayed, interval / 4.0),
            false => (delayed, interval),
        };
    let longer = longer(fitted, column, law, shortest);
    let alone = longer
        .iter()
        .map(|(by, late)| by_about(fitted, *by, vec![late.clone()]));
    // The output follows what the column was before the recording began, of which this says nothing but where it led to.
    let bent = longer.iter().filter_map(|(by, late)| {
        let beyond = beyond(fitted, column, *by)?;
        let mut form = by_about(fitted, *by, vec![late.clone(), beyond]);
        form.label += ", bent beyond the recording";
        Some(form)
    });
    let instant = Variation::one("", instant);
    std::iter::once(instant).chain(alone).chain(bent).collect()
}

/// The course at an earlier time, from times and values and that time.
type Between = fn(&[f64], &[f64], f64) -> Vec<f64>;

/// Delays from the shortest one on, with their terms.
fn longer(
    fitted: &FittedModel<'_>,
    column: usize,
    between: Between,
    shortest: f64,
) -> Vec<(f64, Term)> {
    let (x, label) = (fitted.numbers(column), fitted.label(column));
    let t = &fitted.clock.values;
    let longest = (20.0 * fitted.clock.interval).min(fitted.clock.span() / 20.0);
    let sizes = grid(shortest, longest, 1.6, 8);
    let late = |by: f64| {
        let then = between(t, x, by);
        let modifier = map2(&then, x, |then, now| (then - now) / by);
        let shown = fitted.duration(by.abs());
        let (sign, over) = match by < 0.0 {
            true => ('+', format!("(-{shown})")),
            false => ('-', format!("({shown})")),
        };
        let text = format!("({label}(t {sign} {shown}) - {label})/{over}");
        let modifier = Modifier::new(modifier, text, fitted.rate(column).unit);
        Term::new(Node::Column(column), modifier)
    };
    let of_sign = |sign: f64| {
        let sizes = sharpened(fitted, sizes.clone(), &|size| late(sign * size));
        let sizes = fitted.finer.times(sizes).into_iter();
        let each = sizes.map(|size| (sign * size, late(sign * size)));
        each.collect::<Vec<(f64, Term)>>()
    };
    [1.0, -1.0].into_iter().flat_map(of_sign).collect()
}

fn by_about(fitted: &FittedModel<'_>, by: f64, terms: Vec<Term>) -> Variation {
    let label = format!("by about {}", fitted.duration(by));
    let form = Variation::of(label, terms).shaped("δ", by.abs(), &fitted.time_unit());
    form.sized(by)
}

/// How far a column bends away from the line of its ends before the recording, or after it where the output goes before: the square
/// of the time beyond. `None` where several recordings begin.
fn beyond(fitted: &FittedModel<'_>, column: usize, by: f64) -> Option<Term> {
    let t = &fitted.clock.values;
    let goes_back = t.windows(2).any(|pair| pair[1] < pair[0]);
    let (first, last) = range(t);
    let left = |t: f64| if by > 0.0 { t - first } else { last - t };
    let shown = fitted.duration(by.abs());
    let text = match by > 0.0 {
        true => format!("max({shown} - {}, 0)^2", fitted.time_less(first)),
        false => format!("max({shown} + {}, 0)^2", fitted.time_less(last)),
    };
    let values = map(t, |t| (by.abs() - left(t)).max(0.0).powi(2));
    let unit = fitted.clock_unit();
    let modifier = Modifier::new(values, text, unit.product(&unit));
    (!goes_back).then(|| Term::new(Node::Column(column), modifier))
}
