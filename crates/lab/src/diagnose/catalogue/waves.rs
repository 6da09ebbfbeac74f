//! Waves of a constant period over a stimulus, the time or the order of the rows: the pitch of a lead screw,
//! a grating, interference, hum, a beat with the sampling; and over an angle, as many whole ones per turn as a
//! graduation or a gear has lines or teeth.

use std::f64::consts::TAU;

use super::angles::harmonics;
use super::building::{form, on_node, wave};
use super::fitted::{FittedModel, Node};
use super::modifiers::{correlation, figure, in_unit, levels_of, map, mean, range, rounded};
use super::sharp::summit;
use super::{Cell, EffectId};
use crate::diagnose::case::Role;
use crate::diagnose::evidence::LIKENESS;
use gumption_core::special::chi_squared_upper_quantile;

/// A wave with fewer periods is the business of drifts and smooth curves.
const FEWEST_PERIODS: f64 = 3.0;

/// What is free in a wave: its period, its height, its phase.
const FREE: usize = 3;

/// Up to so many values the frequencies are half a period per range apart, beyond it a whole one.
const FINE: usize = 130;

/// Highest peaks of the residuals' spectrum, to which the nearest frequency is moved.
const PEAKS: usize = 3;

/// One cell for each course.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let courses = courses(fitted).into_iter();
    let of_courses = courses.filter_map(|(column, words)| periods(fitted, column, words));
    let turning = super::angles::angles(fitted).into_iter();
    let of_angles = turning.filter_map(|column| lines(fitted, column));
    of_courses.chain(of_angles).collect()
}

/// What a wave may follow, a column or the time, and what reports call it: where a stimulus went on with the time, both.
fn courses(fitted: &FittedModel<'_>) -> Vec<(Option<usize>, String)> {
    let case = fitted.case();
    // Where a stimulus or an angle went on with the time, a wave is one over that.
    let goes_on = |column: &usize| {
        matches!(case.columns[*column].role, Role::Stimulus | Role::Angle)
            && correlation(fitted.numbers(*column), &fitted.clock.values).abs() > 0.999
    };
    let called = |column: usize| {
        let name = fitted.label(column).to_owned();
        match fitted.is_timed() && goes_on(&column) {
            true => format!("{name} ({})", fitted.along_time()),
            false => name,
        }
    };
    let stimuli = fitted.used(Role::Stimulus);
    let stimuli = stimuli.map(|column| (Some(column), called(column)));
    let time = fitted.is_ordered() && !(0..case.columns.len()).any(|column| goes_on(&column));
    let time = time.then(|| (None, fitted.along_time()));
    stimuli.chain(time).collect()
}

fn periods(fitted: &FittedModel<'_>, column: Option<usize>, words: String) -> Option<Cell> {
    let (name, course) = fitted.course(column);
    let unit = column.map_or_else(|| fitted.time_unit(), |column| fitted.unit(column));
    let blocks = fitted.design.reduced(course);
    let (least, most) = range(&blocks);
    let distinct = levels_of(&blocks);
    let span = most - least;
    let values = match column {
        Some(_) => set_points(&distinct),
        None => distinct.len(),
    };
    // Beside what is declared and a wave, as many values have to be left that could refute it as it has free.
    if values < fitted.design.unknowns.len() + 2 * FREE || span <= 0.0 {
        return None;
    }
    let step = if values <= FINE { 0.5 } else { 1.0 };
    let highest = (values - 1) as f64 / 2.0;
    if highest <= FEWEST_PERIODS {
        return None;
    }
    let count = ((highest - FEWEST_PERIODS) / step).floor() as usize;
    let mut frequencies: Vec<f64> = (0..=count)
        .map(|k| (FEWEST_PERIODS + step * k as f64) / span)
        .collect();
    let peaks = to_peaks(fitted, &blocks, &mut frequencies, step / span);
    let grid: Vec<f64> = (frequencies.iter().map(|frequency| 1.0 / frequency)).collect();
    let mut periods = fitted.finer.times(grid.clone());
    if column.is_none() {
        let calendar = of_the_calendar(fitted, &blocks, &peaks, span);
        periods.retain(|period| !calendar.iter().any(|own| is_near(*period, *own, span)));
        let rounds = rounds(fitted);
        periods.retain(|period| {
            !rounds
                .iter()
                .any(|groups| goes_round(&blocks, groups, *period))
        });
    }
    let least = rounded(least, 1e-4 * span);
    let began = match column {
        Some(column) => fitted.less(column, least),
        None => fitted.time_less(least),
    };
    // What repeats need not be a sine: screws and gears have a course of their own in each turn. Over the time, where stimuli go
    // round as well, it would be whatever these do.
    let is_found = |period: &f64| !grid.contains(period) || peaks.contains(period);
    let has_half =
        |period: &&f64| column.is_some() && 2.0 * span <= highest * **period && is_found(period);
    let bent = periods.iter().filter(has_half);
    let bent = bent.map(|period| (*period, 2, ", with its half"));
    let pure = periods.iter().map(|period| (*period, 1, ""));
    let forms = pure.chain(bent).map(|(period, most, bent)| {
        let shown = in_unit(&figure(period), &unit);
        let waves = (1..=most).flat_map(|turns| {
            let phase = map(course, |x| f64::from(turns) * TAU * (x - least) / period);
            wave(&phase, &format!("{}*pi*{began}/({shown})", 2 * turns))
        });
        let label = format!("period {shown}{bent}");
        form(label, waves.collect()).shaped("P", period, &unit)
    });
    let mut cell = on_node(fitted, EffectId::Wave, &name, Node::Output, forms);
    cell.words.x = words;
    Some(cell)
}

/// How many values tell waves apart: readings that scatter about set points are no more than these. A wave
/// from one set point to the next would follow their scatter.
fn set_points(ascending: &[f64]) -> usize {
    /// Values belong together that are closer than this part of the mean distance.
    const TOGETHER: f64 = 0.2;
    let (least, most) = range(ascending);
    let near = TOGETHER * (most - least) / ascending.len() as f64;
    let apart = ascending.windows(2).filter(|pair| pair[1] - pair[0] > near);
    let points = 1 + apart.count();
    // Values that lie anywhere come close to one another by chance.
    if 2 * points <= ascending.len() {
        points
    } else {
        ascending.len()
    }
}

/// Whole numbers of waves per turn, beyond those of wobble and eccentricity, as far as the positions on the
/// circle tell them apart.
fn lines(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    /// Fewer positions are those of a test in steps, not of a scan of a graduation.
    const POSITIONS: usize = 64;
    let positions = super::angles::positions(&super::angles::radians(fitted, column));
    if positions < POSITIONS || fitted.design.blocks.len() < fitted.rows() {
        return None;
    }
    let last = u32::try_from((positions - 1) / 2).ok()?;
    let orders = super::angles::HIGHEST + 1..=last;
    let forms = harmonics(fitted, column, orders, FEWEST_PERIODS * TAU);
    let (id, name) = (EffectId::Wave, fitted.label(column));
    Some(on_node(fitted, id, name, Node::Output, forms))
}

/// Moves the frequencies next to the highest peaks of the residuals' spectrum onto them: a line between two
/// frequencies of the grid would leave a part of itself to further explanations. The periods of these peaks.
fn to_peaks(fitted: &FittedModel<'_>, x: &[f64], frequencies: &mut [f64], step: f64) -> Vec<f64> {
    const SIDES: [f64; 8] = [-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0];
    let power = |frequency: f64| power(fitted, x, frequency);
    let heights: Vec<f64> = frequencies.iter().map(|f| power(*f)).collect();
    let is_peak = |k: &usize| {
        (*k == 0 || heights[*k] >= heights[*k - 1])
            && heights.get(*k + 1).is_none_or(|next| heights[*k] >= *next)
    };
    let mut peaks: Vec<usize> = (0..heights.len()).filter(is_peak).collect();
    peaks.sort_by(|a, b| heights[*b].total_cmp(&heights[*a]));
    let peaks = peaks.into_iter().take(PEAKS);
    let moved = peaks.map(|peak| {
        let (start, reach) = (frequencies[peak], step / 2.0);
        frequencies[peak] = summit(power, start, (6, reach), &SIDES, |centre, by| centre + by);
        1.0 / frequencies[peak]
    });
    moved.collect()
}

/// Periods of the calendar of which no peak of the residuals' spectrum nearby can be told: what repeats with them is the day or
/// the year, and not a wave of a period that only happens to be that long. A peak is told where the likelihood ratio speaks
/// against the calendar's period at the level of all alarms.
fn of_the_calendar(fitted: &FittedModel<'_>, x: &[f64], peaks: &[f64], span: f64) -> Vec<f64> {
    let apart = chi_squared_upper_quantile(fitted.case().settings.alpha, 1.0);
    let residuals = &fitted.fit.residuals;
    let (count, whole) = (residuals.len() as f64, residuals.norm_squared());
    let power = |period: f64| power(fitted, x, 1.0 / period);
    let cycles = super::time::cycles(fitted).into_iter();
    let cycles = cycles.map(|(_, _, period)| period);
    let is_told = |own: &f64| {
        peaks.iter().any(|peak| {
            let left = whole - power(*peak);
            let gained = power(*peak) - power(*own);
            is_near(*peak, *own, span) && gained * count > apart * left
        })
    };
    cycles.filter(|own| !is_told(own)).collect()
}

/// The rows at each value, for each stimulus or angle whose values come again and again, whether the model takes it in or not.
fn rounds(fitted: &FittedModel<'_>) -> Vec<Vec<Vec<usize>>> {
    let of_column = |column: usize| {
        let x = fitted.design.reduced(fitted.numbers(column));
        let values = levels_of(&x);
        let at = |value: &f64| (0..x.len()).filter(|row| x[*row] == *value).collect();
        (2 * values.len() <= x.len()).then(|| values.iter().map(at).collect())
    };
    let columns = fitted.case().columns.iter().enumerate();
    let go_round = columns.filter(|(_, column)| {
        matches!(column.role, Role::Stimulus | Role::Angle) && column.numbers().is_some()
    });
    go_round.filter_map(|(index, _)| of_column(index)).collect()
}

/// Whether a wave over the time is a value of its own at each value of a stimulus, which goes round with it: but for less than
/// makes an effect another.
fn goes_round(t: &[f64], groups: &[Vec<usize>], period: f64) -> bool {
    let phases = map(t, |t| TAU * t / period);
    let [between, whole] = [libm::sin, libm::cos]
        .map(|wave: fn(f64) -> f64| {
            let wave = map(&phases, wave);
            let mean = mean(&wave);
            let of_group = |rows: &Vec<usize>| {
                let sum = rows.iter().map(|row| wave[*row] - mean).sum::<f64>();
                sum * sum / rows.len() as f64
            };
            let whole = wave.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
            [groups.iter().map(of_group).sum::<f64>(), whole]
        })
        .into_iter()
        .fold([0.0; 2], |sums, of| [sums[0] + of[0], sums[1] + of[1]]);
    whole - between < LIKENESS * LIKENESS * whole
}

/// Whether two periods are less than half a wave apart over the whole span.
fn is_near(one: f64, other: f64, span: f64) -> bool {
    (1.0 / one - 1.0 / other).abs() * span < 0.5
}

/// Power of the residuals at a frequency: the sum of squares that a sine and a cosine take away (Lomb and
/// Scargle), over all responses.
fn power(fitted: &FittedModel<'_>, x: &[f64], frequency: f64) -> f64 {
    let first = x[0];
    let wave = |x: &f64| {
        let phase = TAU * frequency * (x - first);
        libm::sincos(phase)
    };
    let waves: Vec<(f64, f64)> = x.iter().map(wave).collect();
    let sum = |f: &dyn Fn(&(f64, f64)) -> f64| waves.iter().map(f).sum::<f64>();
    let (ss, cc, sc) = (
        sum(&|w| w.0 * w.0),
        sum(&|w| w.1 * w.1),
        sum(&|w| w.0 * w.1),
    );
    let determinant = ss * cc - sc * sc;
    if determinant <= 1e-6 * ss * cc {
        return 0.0;
    }
    let of_response = |residuals: &[f64]| {
        let along = |f: fn(&(f64, f64)) -> f64| -> f64 {
            waves.iter().zip(residuals).map(|(w, r)| f(w) * r).sum()
        };
        let (s, c) = (along(|w| w.0), along(|w| w.1));
        (cc * s * s - 2.0 * sc * s * c + ss * c * c) / determinant
    };
    let residuals = fitted.fit.residuals.as_slice();
    residuals.chunks(x.len()).map(of_response).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_of_the_round_is_that_of_the_stimulus() {
        let times: Vec<f64> = (0..80).map(|row| 4.0 * f64::from(row)).collect();
        let groups: Vec<Vec<usize>> = (0..8).map(|at| (at..80).step_by(8).collect()).collect();
        // A round takes 32; a half and a quarter of it go round as well.
        for period in [32.0, 16.0, 32.2] {
            assert!(goes_round(&times, &groups, period), "{period}");
        }
        for period in [36.0, 29.0, 20.0] {
            assert!(!goes_round(&times, &groups, period), "{period}");
        }
    }
}
