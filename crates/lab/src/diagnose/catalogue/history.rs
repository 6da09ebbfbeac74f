//! What depends on the way by which a value was reached: hysteresis and backlash.

use super::building::{form, on_output, plain};
use super::fitted::{FittedModel, Node, varies};
use super::modifiers::{
    Start, direction, figure, five_digits, grid, map, map2, mean_of, onward, play, range,
    typical_step,
};
use super::sharp::sharpened;
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Role;

/// Cells of one column that is an input.
pub(super) fn cells(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let (x, label) = (fitted.numbers(column), fitted.label(column));
    if !comes_back(&fitted.clock.values, x) {
        return Vec::new();
    }
    let way = direction(&fitted.clock.values, x);
    let loops = loops(fitted, column, &way);
    let mut cells = vec![plain(fitted, EffectId::Hysteresis, label, loops)];
    let (least, most) = range(x);
    let unit = fitted.unit(column);
    let step = typical_step(x);
    let widths = grid((most - least) * 1e-3, (most - least) * 0.3, 3.0, 6);
    let widths = widths.into_iter().map(five_digits);
    let widths = widths.filter(|width| *width < 2.0 * step || step == 0.0);
    // Below the least step a play follows every reversal at once: such gaps act like one another.
    let steps = x.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let least_step = (steps.filter(|step| *step > 0.0)).fold(f64::INFINITY, f64::min);
    let told_apart = (widths.enumerate()).filter(|(at, width)| *at == 0 || *width > least_step);
    let begun = told_apart.flat_map(|(_, width)| Start::ALL.map(|start| (width, start)));
    let variants = begun.map(|(width, start)| {
        let played = play(&fitted.clock.values, x, width, start);
        let modifier = map2(&played, x, |played, x| (played - x) / width);
        let shown = fitted.figure(column, width);
        let text = format!(
            "({} - {label})/({shown})",
            played_text(label, &shown, start)
        );
        let term = Term::new(Node::Column(column), Modifier::number(modifier, text));
        // A gap that no step tells from a narrower one has its size alone.
        let gap = match width > least_step {
            true => format!("gap {} {unit}", figure(width)),
            false => String::new(),
        };
        begun_at(start, Variation::one(gap, term))
    });
    // A gap far below the steps is the direction alone.
    let wide: Vec<Variation> = variants
        .filter(|v| varies(&v.terms[0].modifier.values))
        .collect();
    if step < 0.3 * (most - least)
        && fitted.case().columns[column].role == Role::Stimulus
        && !wide.is_empty()
    {
        cells.push(plain(fitted, EffectId::Play, label, wide));
    }
    cells
}

/// Shapes of a loop: a constant offset between both ways, a loop that is closed at both ends of the range
/// and widest between them, and the same on one of the ways only.
fn loops(fitted: &FittedModel<'_>, column: usize, way: &[f64]) -> Vec<Variation> {
    let (x, label) = (fitted.numbers(column), fitted.label(column));
    let (least, most) = range(x);
    let half = five_digits((most - least) / 2.0);
    let wide = map(x, |x| (x - least) * (most - x) / (half * half));
    let shape = format!(
        "{}*({} - {label})/({})^2",
        fitted.less(column, least),
        fitted.figure(column, most),
        fitted.figure(column, half)
    );
    let direction = format!("direction({label})");
    // Falling values with the opposite sign: no mixture of the two with sizes of one sign is a parabola
    // without a loop.
    type Side = fn(f64) -> f64;
    let loops: [(&str, &str, Side); 3] = [
        ("", &direction, |way| way),
        ("on rising values only, ", "[rising]", |way| {
            (1.0 + way) / 2.0
        }),
        ("on falling values only, ", "-[falling]", |way| {
            (way - 1.0) / 2.0
        }),
    ];
    let constant = form("", vec![Modifier::number(way.to_vec(), direction.as_str())]);
    // The end of the range, read once more in the series that leads away from it.
    let onward = onward(&fitted.clock.values, x);
    let turned = (onward != way).then(|| {
        let modifier = Modifier::number(onward, format!("next_{direction}"));
        form("of the next movement at rest", vec![modifier])
    });
    let closed = loops.into_iter().map(|(on, side, of)| {
        let modifier = map2(&wide, way, |wide, way| wide * of(way));
        let modifier = Modifier::number(modifier, format!("{side}*{shape}"));
        form(format!("{on}widest in the middle"), vec![modifier])
    });
    let simple = [constant].into_iter().chain(turned).chain(closed);
    simple.chain(plays(fitted, column)).collect()
}

/// Inner friction (Prandtl, Ishlinskii): the output stays behind by a play, or by several of growing width
/// together. The first way from rest has no loop yet, which a direction alone cannot say.
fn plays(fitted: &FittedModel<'_>, column: usize) -> Vec<Variation> {
    /// Widths as parts of the range.
    const WIDTHS: [f64; 5] = [0.05, 0.15, 0.3, 0.5, 0.75];
    let (x, label) = (fitted.numbers(column), fitted.label(column));
    let (least, most) = range(x);
    let unit = fitted.unit(column);
    let widths = WIDTHS.map(|part| five_digits(part * (most - least)));
    let all = widths.map(|width| fitted.figure(column, width)).join(", ");
    let begun = |start: Start| {
        let behind = |width: f64| {
            let played = play(&fitted.clock.values, x, width, start);
            let modifier = map2(x, &played, |x, played| x - played);
            let shown = fitted.figure(column, width);
            let text = format!("({label} - {})", played_text(label, &shown, start));
            Modifier::new(modifier, text, fitted.step_unit(column))
        };
        let term = |width: f64| on_output(behind(width));
        let single = fitted
            .finer
            .times(sharpened(fitted, widths.into(), &term))
            .into_iter();
        let single = single.map(five_digits).map(|width| {
            let share = figure(100.0 * width / (most - least));
            let label = format!("width {share} % of the range");
            Variation::one(label, term(width)).shaped("w", width, &unit)
        });
        let mean = mean_of(&widths.map(|width| behind(width).values.to_vec()));
        let played = played_text(label, "w", start);
        let text = format!("mean of ({label} - {played}) over w = {all}");
        let mean = Modifier::new(mean, text, fitted.step_unit(column));
        let even = Variation::one("several widths", on_output(mean));
        let apart = widths.into_iter().skip(1).step_by(2);
        let apart = apart.map(|width| on_output(behind(width)));
        let uneven = Variation::of("two widths", apart.collect());
        let all = single.chain([even, uneven]);
        all.map(|form| begun_at(start, form))
            .collect::<Vec<Variation>>()
    };
    Start::ALL.into_iter().flat_map(begun).collect()
}

/// A play in a formula.
fn played_text(label: &str, width: &str, start: Start) -> String {
    match start {
        Start::Middle => format!("play({label}, {width})"),
        start => format!("play({label}, {width}, {})", start.label()),
    }
}

/// A variant whose play begins so: wherever it does is as likely, and together they are one form.
fn begun_at(start: Start, form: Variation) -> Variation {
    let parts = [form.label.as_str(), start.label()];
    let told = parts.into_iter().filter(|part| !part.is_empty());
    Variation {
        label: told.collect::<Vec<&str>>().join(", "),
        weight: form.weight / Start::ALL.len() as f64,
        ..form
    }
}

/// Whether a course goes both ways, more than by returning to where a series begins: enough of its values are reached rising and
/// falling. Of series that only rise, falling leads to the first value alone.
pub(super) fn comes_back(t: &[f64], x: &[f64]) -> bool {
    /// Rows of the rarer way, one in so many.
    const ONE_IN: usize = 8;
    let way = direction(t, x);
    let reached = |falling: bool| {
        let each = way.iter().zip(x);
        let own = each.filter(|(way, _)| (**way < 0.0) == falling);
        own.map(|(_, x)| *x).collect::<Vec<f64>>()
    };
    let (rising, falling) = (reached(false), reached(true));
    let among = |own: &[f64], others: &[f64]| {
        let (least, most) = range(others);
        own.iter().filter(|x| (least..=most).contains(*x)).count()
    };
    let both = among(&rising, &falling).min(among(&falling, &rising));
    both * ONE_IN >= way.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_that_only_rise_do_not_come_back() {
        let course = |series: &[&[f64]]| {
            let x: Vec<f64> = series.concat();
            let t: Vec<f64> = (0..x.len()).map(|row| row as f64).collect();
            comes_back(&t, &x)
        };
        let (up, down) = ([3.0, 5.0, 10.0, 15.0, 25.0], [20.0, 12.0, 8.0, 4.0]);
        let again = [3.2, 5.0, 10.0, 15.0, 24.0];
        assert!(!course(&[&up, &again, &up, &again]));
        assert!(!course(&[&up, &up, &up]));
        assert!(course(&[&up, &down]));
        assert!(course(&[&up, &down, &again, &down]));
        assert!(course(&[&[5.0, 25.0, 3.0, 10.0, 15.0, 8.0, 20.0, 12.0]]));
    }
}
