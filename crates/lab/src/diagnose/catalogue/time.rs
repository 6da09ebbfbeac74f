//! Laws of time: drift, ageing, warm-up, season, steps.

use std::collections::BTreeSet;
use std::ops::Range;

use nalgebra::DVector;

use super::angles::runs;
use super::building::{HIGHER, decay, form, of_the_whole, on_node, on_output, timed, wave};
use super::fitted::{FittedModel, Node};
use super::modifiers::{five_digits, flag, grid, map, range};
use super::sharp::{self, nearly_all, sharpened};
use super::{Cell, EffectId, Modifier, Term, Variation};
use gumption_core::quantity::Unit;

/// The label of what begins anew in each run, as after it was zeroed.
const ANEW: &str = "anew in each run";
/// What it follows.
const SINCE_START: &str = "(time since the start of the run)";
/// More steps than that are not scanned.
const MOST_STEPS: usize = 80;

/// Cells of the time, or of the order of the rows.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let t = &fitted.clock.values;
    let span = fitted.clock.span();
    if fitted.design.blocks.len() < 6 || span <= 0.0 || !fitted.is_ordered() {
        return Vec::new();
    }
    let along = fitted.along_time();
    let start = began_at(fitted);
    let since = map(t, |t| t - start);
    let began = fitted.time_less(start);
    let nodes = fitted.offset_and_scale();
    let stretches = nodes
        .iter()
        .zip([EffectId::Stretch, EffectId::StretchScale]);
    let stretches = stretches.filter_map(|(node, id)| stretch(fitted, &along, *node, id));
    let mut cells: Vec<Cell> = stretches.collect();
    let mut add = |ids: &[EffectId], forms: Vec<Variation>| {
        for (node, id) in nodes.iter().zip(ids) {
            cells.push(on_node(fitted, *id, &along, *node, forms.clone()));
        }
    };
    let least = (span * 3e-3).max(fitted.clock.interval);
    let scales = grid(least, span / 3.0, 2.2, 7);
    let mut drifts = vec![form("", vec![fitted.centred_time()])];
    let is_recorded = fitted.clock.column.is_some();
    if is_recorded {
        let slowing = |scale: f64| {
            let modifier = map(&since, |t| libm::log1p(t / scale));
            on_output(Modifier::unnamed(modifier))
        };
        let scales = sharpened(fitted, scales.clone(), &slowing);
        drifts.extend(curved(fitted, &since, &began, &fitted.finer.times(scales)));
    }
    add(&[EffectId::Drift, EffectId::DriftScale], drifts);
    let steps = steps(fitted, &along);
    add(&[EffectId::Step, EffectId::StepScale], steps);
    if is_recorded {
        let dying = |since: &[f64], began: &str, tau: f64| {
            on_output(decay(since, began, tau, &fitted.duration(tau)))
        };
        let once = |tau: f64| dying(&since, &began, tau);
        let scales = sharpened(fitted, scales, &once);
        let singles = fitted.finer.times(scales.clone());
        let single = singles
            .iter()
            .map(|tau| timed(fitted, &[five_digits(*tau)], vec![once(*tau)]));
        // A small body warms in a large one.
        let double = scales.iter().step_by(2).map(|tau| {
            let terms = vec![once(*tau), once(4.0 * tau)];
            timed(fitted, &[*tau, 4.0 * tau], terms)
        });
        let since_start = started(fitted);
        let anew = since_start.iter().flat_map(|since| {
            scales.iter().map(|tau| {
                let term = dying(since, SINCE_START, *tau);
                let mut form = timed(fitted, &[five_digits(*tau)], vec![term]);
                form.label = format!("{}, {ANEW}", form.label);
                form
            })
        });
        let decays = single.chain(double).chain(anew).collect();
        add(&[EffectId::WarmUp, EffectId::WarmUpScale], decays);
        for (id, name, period) in cycles(fitted) {
            let phase = map(&since, |t| std::f64::consts::TAU * t / period);
            let pair = wave(&phase, &format!("2*pi*{began}/({name})"));
            add(&[id], vec![form("", pair)]);
        }
        return cells;
    }
    let undeclared = cells.into_iter().map(|cell| Cell {
        odds: HIGHER * cell.odds,
        ..cell
    });
    undeclared.collect()
}

/// When the recording began.
fn began_at(fitted: &FittedModel<'_>) -> f64 {
    range(&fitted.clock.values).0
}

/// The cycles of the calendar that the recording can show, in more phases than a wave beside a constant has sizes: what each is, its
/// name, and its period in the unit of the time.
pub(super) fn cycles(fitted: &FittedModel<'_>) -> Vec<(EffectId, &'static str, f64)> {
    /// A period is told from so much of it on, and up to so many.
    const MOST: f64 = 60.0;
    /// Sizes of a sine, a cosine and a constant.
    const SIZES: usize = 3;
    /// Phases are apart by a thousandth of a cycle or more.
    const APART: f64 = 1e3;
    let span = fitted.clock.span();
    let phases = |period: f64| {
        let phase = |t: &f64| (APART * (t / period).rem_euclid(1.0)).round() as u32 % APART as u32;
        let phases = fitted.clock.values.iter().map(phase);
        phases.collect::<BTreeSet<u32>>().len()
    };
    let shown = |(id, name, seconds, least): (EffectId, &'static str, f64, f64)| {
        let period = seconds / fitted.seconds()?;
        let is_shown = (least * period..=MOST * period).contains(&span) && phases(period) > SIZES;
        is_shown.then_some((id, name, period))
    };
    let all = [
        (EffectId::Season, "1 year", 365.2422 * 86_400.0, 0.75),
        (EffectId::Daily, "24 h", 86_400.0, 1.0),
    ];
    all.into_iter().filter_map(shown).collect()
}

/// The time since the start of each run, where the instrument was off before it for longer than it then was on; nothing where it was
/// not, or where there is one run.
fn started(fitted: &FittedModel<'_>) -> Option<Vec<f64>> {
    let (t, runs) = (&fitted.clock.values, runs(fitted));
    let rested = |pair: &[Range<usize>]| {
        let (start, last, next) = (t[pair[0].start], t[pair[0].end - 1], t[pair[1].start]);
        next - last > last - start
    };
    (runs.len() > 1 && runs.windows(2).all(rested)).then(|| since_start(fitted, &runs))
}

/// The time since the start of each run.
fn since_start(fitted: &FittedModel<'_>, runs: &[Range<usize>]) -> Vec<f64> {
    let t = &fitted.clock.values;
    let since = runs
        .iter()
        .flat_map(|run| map(&t[run.clone()], |own| own - t[run.start]));
    since.collect()
}

/// A stretch of rows that alone is nearly all that is left.
fn stretch(fitted: &FittedModel<'_>, along: &str, node: Node, id: EffectId) -> Option<Cell> {
    /// Of fewer blocks, rows are wrong one by one.
    const LEAST: usize = 3;
    let blocks = &fitted.design.blocks;
    if blocks.len() > MOST_STEPS || fitted.case().responses.len() != 1 {
        return None;
    }
    let ends = |first: usize| (first + LEAST..blocks.len() - 1).map(move |end| (first, end));
    let all: Vec<(usize, usize)> = (2..blocks.len().saturating_sub(LEAST + 1))
        .flat_map(ends)
        .collect();
    // What the node does in all blocks, of which a stretch has some.
    let everywhere = Modifier::number(vec![1.0; fitted.rows()], "1");
    let whole = fitted.column(&Term::new(node, everywhere));
    let mut columns = all.iter().map(|(first, end)| {
        let inside = |block: usize| (*first..*end).contains(&block);
        DVector::from_fn(
            whole.len(),
            |block, _| if inside(block) { whole[block] } else { 0.0 },
        )
    });
    let (first, end) = all[nearly_all(fitted, &mut columns)?];
    let (from, to) = (blocks[first][0], blocks[end][0]);
    let inside = (0..fitted.rows()).map(|row| flag((from..to).contains(&row)));
    let label = fitted.design.called(from, to - 1);
    let within = Modifier::number(inside.collect(), format!("[{label}]"));
    let mut cell = on_node(fitted, id, along, node, [form(label, vec![within])]);
    if id == EffectId::StretchScale {
        let whole = of_the_whole(fitted, &cell.variants);
        cell.variants.extend(whole);
    }
    Some(cell)
}

/// Drifts that are not steady: bent, and slowing down with the logarithm of time, as where many processes
/// relax, or with its root, as where something diffuses.
fn curved(fitted: &FittedModel<'_>, since: &[f64], began: &str, scales: &[f64]) -> Vec<Variation> {
    /// Moments at which a drift may begin, evenly over the recording.
    const BEGINNINGS: usize = 16;
    let logarithms = scales.iter().map(|scale| {
        let shown = fitted.duration(*scale);
        let slowing = Modifier::number(
            map(since, |t| libm::log1p(t / scale)),
            format!("ln(1 + {began}/({shown}))"),
        );
        let form = form(format!("slowing down, t₀ = {shown}"), vec![slowing]);
        form.shaped("t₀", five_digits(*scale), &fitted.time_unit())
    });
    let per_root = fitted.clock_unit().powr(1, 2).unwrap_or_else(Unit::one);
    let root = Modifier::new(map(since, libm::sqrt), format!("sqrt({began})"), per_root);
    let root = form("with the root of time", vec![root]);
    let linear = fitted.centred_time();
    let square = linear.square();
    let bent = form("bent", vec![linear, square]);
    let zeroed = runs(fitted);
    let anew = (zeroed.len() > 1).then(|| {
        let since = since_start(fitted, &zeroed);
        let since = Modifier::new(since, SINCE_START, fitted.clock_unit());
        form(ANEW, vec![since])
    });
    let span = fitted.clock.span();
    let beginnings = (1..BEGINNINGS).map(|part| part as f64 / BEGINNINGS as f64 * span);
    let later = sharpened(fitted, beginnings.collect(), &|from| {
        on_output(later(fitted, since, from))
    });
    let later = fitted.finer.levels(later);
    let weight = 1.0 / later.len() as f64;
    let later = later.into_iter().map(|from| Variation {
        weight,
        ..begun(fitted, since, from)
    });
    logarithms
        .chain([root, bent])
        .chain(anew)
        .chain(later)
        .collect()
}

/// A drift that begins so long after the start.
fn begun(fitted: &FittedModel<'_>, since: &[f64], from: f64) -> Variation {
    let unit = fitted.time_unit();
    let label = format!("from {} on", fitted.moment(began_at(fitted) + from));
    form(label, vec![later(fitted, since, from)]).shaped("x₀", from, &unit)
}

/// The time since so long after the start.
fn later(fitted: &FittedModel<'_>, since: &[f64], from: f64) -> Modifier {
    let text = format!("max({}, 0)", fitted.time_less(began_at(fitted) + from));
    let values = map(since, |t| (t - from).max(0.0));
    Modifier::new(values, text, fitted.clock_unit())
}

/// Steps before each block, or before some of them evenly.
fn steps(fitted: &FittedModel<'_>, along: &str) -> Vec<Variation> {
    let blocks = &fitted.design.blocks;
    let stride = blocks.len().div_ceil(MOST_STEPS);
    let scanned = (stride.max(2)..blocks.len().saturating_sub(1)).step_by(stride);
    let scanned = scanned.map(|block| step(fitted, along, blocks[block][0]));
    scanned.chain(between(fitted, along, stride)).collect()
}

/// A step from a row on.
fn step(fitted: &FittedModel<'_>, along: &str, row: usize) -> Variation {
    let number = fitted.design.recorded(row).start + 1;
    // A count that begins anew in each run names no moment.
    let names_moments = fitted.clock.column.is_some() && fitted.clock.values.is_sorted();
    let label = match names_moments {
        true => {
            let time = fitted.moment(fitted.clock.values[row]);
            format!("at {along} = {time}")
        }
        false => format!("at row {number}"),
    };
    let after = (0..fitted.rows()).map(|at| flag(at >= row));
    let after = Modifier::number(after.collect(), format!("[row >= {number}]"));
    form(label, vec![after])
}

/// The best row for a step, where blocks are skipped or hold several rows; nothing where the others have it.
fn between(fitted: &FittedModel<'_>, along: &str, stride: usize) -> Option<Variation> {
    let blocks = &fitted.design.blocks;
    let whole = blocks.iter().all(|rows| rows.len() == 1);
    if whole && stride == 1 || blocks.len() < 4 {
        return None;
    }
    let terms = |row: usize| step(fitted, along, row).terms;
    let starts = blocks[2..blocks.len() - 1].iter();
    let starts: Vec<usize> = starts.map(|rows| rows[0]).collect();
    let middle = sharp::best(fitted, &mut starts.iter().flat_map(|row| terms(*row)))?;
    let near = starts[middle.saturating_sub(1)]..starts[(middle + 1).min(starts.len() - 1)];
    let row = near.start + sharp::best(fitted, &mut near.flat_map(terms))?;
    Some(step(fitted, along, row))
}
