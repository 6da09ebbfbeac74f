//! What a row shows.

use crate::claim::{Row, Shape, Stated};
use crate::printed::Printed;
use crate::read::{has, shape};
use crate::units;

use super::{Hit, Seen};
use crate::calculate::Line;

/// Every row that is counted, with its right line.
fn rows<'s>(seen: &'s Seen<'_>) -> impl Iterator<Item = (usize, &'s Row, &'s Line)> {
    let rows = seen.claimed.rows.iter().zip(&seen.case.right.lines);
    rows.enumerate()
        .map(|(i, (row, line))| (i, row, line))
        .filter(|(_, row, line)| line.counted && !row.is_absent)
}

fn each(seen: &Seen<'_>, numbers: impl Fn(&Row, &Line) -> Option<String>) -> Vec<Hit> {
    rows(seen)
        .filter_map(|(i, row, line)| Some(Hit::of(Some(i), numbers(row, line)?)))
        .collect()
}

/// Half of the last digits of a product of printed figures, relative.
fn open(figures: &[&Printed]) -> f64 {
    figures
        .iter()
        .map(|figure| figure.relative_half().min(0.05))
        .sum()
}

fn far(figure: &Printed, x: f64, open: f64) -> bool {
    (figure.value.abs() - x.abs()).abs()
        > figure.half_of_digits() * (1.0 + 1e-6) + (open + 1e-9) * x.abs()
}

pub(super) fn contribution(seen: &Seen<'_>) -> Vec<Hit> {
    each(seen, |row, line| {
        let (contribution, c, u) = (row.contribution.as_ref()?, row.c.as_ref()?, row.u.as_ref()?);
        let product = c.value * u.value * line.to_y;
        let differs = far(contribution, product, open(&[c, u]));
        differs.then(|| format!("u_i(y) = {}, c·u = {product:.4}", contribution.as_read()))
    })
}

pub(super) fn quotient(seen: &Seen<'_>) -> Vec<Hit> {
    let divided = rows(seen).any(|(_, row, _)| {
        let pair = row.used.as_ref().zip(row.u.as_ref());
        pair.is_some_and(|(used, u)| used.unit == u.unit && u.value < used.value)
    });
    let mut hits = of_divisors(seen);
    if divided {
        hits.extend(undivided(seen));
    }
    hits
}

/// A ± that is u to every digit, among others which were divided, where nothing says that it is a standard uncertainty.
fn undivided(seen: &Seen<'_>) -> Vec<Hit> {
    each(seen, |row, _| {
        let (used, u) = row.used.as_ref().zip(row.u.as_ref())?;
        let words = format!("{} {}", row.words, row.distribution).to_lowercase();
        let is_said = [
            "standard uncertainty",
            "标准不确定度",
            "normal",
            "正态",
            "gauss",
        ]
        .iter()
        .any(|word| words.contains(word));
        let is_copied = used.value == u.value && used.unit == u.unit && used.value > 0.0;
        let is_open = matches!(row.stated, Stated::Standard { .. }) && row.divisor.is_none();
        (is_copied && is_open && !is_said).then(|| format!("u = ± = {}", u.as_read()))
    })
}

fn of_divisors(seen: &Seen<'_>) -> Vec<Hit> {
    each(seen, |row, _| {
        let (u, used, divisor) = (row.u.as_ref()?, row.used.as_ref()?, row.divisor.as_ref()?);
        // In per cent, and u is not: a part of the estimate.
        let is_share = |figure: &Printed| units::fraction(&figure.unit).is_some();
        let part = match is_share(used) && !is_share(u) {
            true => row.relative_factor(),
            false => 1.0,
        };
        let quotient = used.value / divisor.value * part;
        // A power of ten is missed in the conversion, and not in the division (rule 47).
        let missed = units::MISSED.iter().filter(|_| part != 1.0);
        let mut ways = [1.0].iter().chain(missed);
        let differs = ways.all(|ten| far(u, quotient * ten, open(&[used, divisor])));
        differs.then(|| {
            format!(
                "u = {}, {}/{} = {quotient:.4}",
                u.as_read(),
                used.as_read(),
                divisor.as_read()
            )
        })
    })
}

pub(super) fn derivative(seen: &Seen<'_>) -> Vec<Hit> {
    let Some(derivatives) = &seen.case.derivatives else {
        return Vec::new();
    };
    let coefficients = || rows(seen).filter_map(|(_, row, _)| row.c.as_ref());
    let signed = coefficients().any(|c| c.value < 0.0);
    rows(seen)
        .filter_map(|(i, row, line)| {
            let c = row.c.as_ref()?;
            // A coefficient may hold a conversion to the unit of the result.
            let right = [derivatives[i], derivatives[i] * line.to_y, line.c];
            // Sheets print amounts, too: a sign is only held against one that has signs, or where it turns a correlation.
            let mut pairs = seen.claimed.correlations.iter();
            let signs_count =
                signed || pairs.any(|pair| pair.r != 0.0 && [pair.a, pair.b].contains(&i));
            let is_turned = |x: f64| signs_count && x * c.value < 0.0;
            let wrong = right.iter().all(|x| far(c, *x, 0.01) || is_turned(*x));
            wrong.then(|| {
                Hit::of(
                    Some(i),
                    format!("c = {}, ∂f/∂x = {:.5}", c.as_read(), line.c),
                )
            })
        })
        .collect()
}

/// A standard uncertainty in the unit of another quantity than the result, which is its contribution as it stands: kelvins
/// in a sum of nanometres.
pub(super) fn without_coefficient(seen: &Seen<'_>) -> Vec<Hit> {
    let mut hits = printed_as_it_stands(seen);
    hits.extend(summed_as_it_stands(seen));
    hits
}

/// The same where u_c alone shows it: it is the root of the sum of squares of the figures, whatever they are in.
fn summed_as_it_stands(seen: &Seen<'_>) -> Vec<Hit> {
    let u_c = seen.laboratory.figures(&[], None).u_c;
    let claimed = seen.claimed.footer.u_c.as_ref();
    if claimed.is_none_or(|claimed| far(claimed, u_c, 0.01)) {
        return Vec::new();
    }
    let hit = |i: usize| {
        let (row, of_result) = (&seen.claimed.rows[i], &seen.claimed.unit);
        let u = seen.laboratory.lines[i].u;
        let numbers = format!("u = {u:.3} {}, u_c = {u_c:.4} {of_result}", row.unit);
        Hit::of(Some(i), numbers.trim_end().to_owned())
    };
    seen.case.without_way().into_iter().map(hit).collect()
}

fn printed_as_it_stands(seen: &Seen<'_>) -> Vec<Hit> {
    let of_result = &seen.claimed.unit;
    let Some(result) = units::parse(of_result) else {
        return Vec::new();
    };
    each(seen, |row, line| {
        let contribution = row.contribution.as_ref()?;
        // Without a column of u it is what is stated that has been divided.
        let (u, unit) = match &row.u {
            Some(u) => (u.value, &u.unit),
            None => (line.u, &row.unit),
        };
        let own = units::parse(unit)?;
        let is_bare = row
            .c
            .as_ref()
            .is_none_or(|c| c.value.abs() == 1.0 && c.unit.is_empty());
        let is_other = own.dimension != result.dimension && units::fraction(unit).is_none();
        let is_summed = contribution.value != 0.0 && contribution.is_met_by(u);
        (is_bare && is_other && is_summed).then(|| {
            let u = match &row.u {
                Some(u) => u.with_unit(),
                None => format!("{u:.3} {unit}"),
            };
            let contribution = contribution.as_read();
            format!("u = {u}, u_i(y) = {contribution} {of_result}")
        })
    })
}

/// The divisor that belongs to the distribution which the laboratory itself names; how wide the top of a trapezoid is, its name does
/// not say.
fn named_divisor(distribution: &str) -> Option<f64> {
    let named = shape(&distribution.to_lowercase())?;
    (!matches!(named, Shape::Trapezoidal(_))).then(|| named.divisor())
}

pub(super) fn distribution(seen: &Seen<'_>) -> Vec<Hit> {
    each(seen, |row, _| {
        let divisor = row.divisor.as_ref()?;
        let named = named_divisor(&row.distribution)?;
        // A step q is divided by twice the root.
        let right = [named, 2.0 * named];
        let near = |x: &f64| (divisor.value / x - 1.0).abs() < 0.01;
        let wrong = !right.iter().any(near);
        wrong.then(|| format!("{}: {} ≠ {named:.4}", row.distribution, divisor.as_read()))
    })
}

pub(super) fn certificate_without_k(seen: &Seen<'_>) -> Vec<Hit> {
    each(seen, |row, _| match &row.stated {
        Stated::Certificate {
            expanded,
            k_stated: false,
            ..
        } => Some(format!("U = {}", expanded.as_read())),
        _ => None,
    })
}

pub(super) fn rectangle_for_certificate(seen: &Seen<'_>) -> Vec<Hit> {
    each(seen, |row, _| match &row.stated {
        Stated::Certificate {
            k, k_stated: true, ..
        } if named_divisor(&row.distribution).is_some() => {
            Some(format!("k = {k}; {}", row.distribution))
        }
        _ => None,
    })
}

/// Relative standard deviation of an experimental standard deviation (JCGM 100, E.4.3, table E.1).
fn doubt_of_s(n: f64) -> f64 {
    // (2(n − 1))^−1/2 is 10 % low at n = 3; the exact one has Γ functions.
    let c4 = libm::sqrt(2.0 / (n - 1.0))
        * libm::exp(libm::lgamma(n / 2.0) - libm::lgamma((n - 1.0) / 2.0));
    libm::sqrt(1.0 / (c4 * c4) - 1.0)
}

pub(super) fn few_readings(seen: &Seen<'_>) -> Vec<Hit> {
    let fixed = matches!(seen.laboratory.factor, crate::calculate::Factor::Fixed(_));
    each(seen, |row, line| match row.stated {
        Stated::Deviation {
            n: Some(n),
            pooled: None,
            ..
        }
        | Stated::Range { n, .. }
            if fixed && n < 10.0 && line.contribution() != 0.0 =>
        {
            Some(format!("n = {n}: s ± {:.0} %", 100.0 * doubt_of_s(n)))
        }
        _ => None,
    })
}

pub(super) fn freedom_of_readings(seen: &Seen<'_>) -> Vec<Hit> {
    let has_column = seen.claimed.rows.iter().any(|row| row.dof.is_some());
    each(seen, |row, _| {
        let type_a = row.stated.is_type_a();
        match &row.dof {
            Some(dof) if type_a && dof.value.is_infinite() => {
                Some(format!("ν = {}", dof.as_read()))
            }
            None if type_a && has_column => Some("ν = ?".into()),
            _ => None,
        }
    })
}

pub(super) fn dominant(seen: &Seen<'_>) -> Vec<Hit> {
    let u_c = seen.case.right.figures(&[], None).u_c;
    let share = |line: &Line| {
        let part = line.contribution() / u_c;
        part * part
    };
    if !seen.claimed.correlations.is_empty() {
        return Vec::new();
    }
    each(seen, |_, line| {
        let share = share(line);
        (share > 0.8 && u_c > 0.0).then(|| format!("{:.0} % u_c²", 100.0 * share))
    })
}

pub(super) fn negligible(seen: &Seen<'_>) -> Vec<Hit> {
    let u_c = seen.case.right.figures(&[], None).u_c;
    let small: Vec<&str> = rows(seen)
        .filter(|(_, _, line)| {
            let part = line.contribution() / u_c;
            part * part < 0.01
        })
        .map(|(_, row, _)| row.label())
        .collect();
    // Beside an infinite u_c everything is small.
    if small.len() < 2 || !u_c.is_finite() || !seen.claimed.correlations.is_empty() {
        return Vec::new();
    }
    vec![Hit::of(None, small.join(", "))]
}

pub(super) fn near_singular(seen: &Seen<'_>) -> Vec<Hit> {
    let Some(model) = &seen.claimed.model else {
        return Vec::new();
    };
    each(seen, |row, line| {
        let value = row.value.as_ref()?.value;
        let behind = crate::read::symbol_at(model, &row.symbol, 0)?;
        let front = model[..behind].trim_end();
        let divides = front.ends_with('/') || front.ends_with("/(");
        let relative = line.u / value.abs();
        (divides && relative > 0.2).then(|| format!("u/|x| = {relative:.2}"))
    })
}

/// A sensitivity that vanishes at the estimate although the quantity matters: the sine at 90°, a square at 0.
pub(super) fn no_sensitivity(seen: &Seen<'_>) -> Vec<Hit> {
    let Some(derivatives) = &seen.case.derivatives else {
        return Vec::new();
    };
    rows(seen)
        .filter_map(|(i, _, line)| {
            let in_model =
                seen.claimed.model.as_deref().is_some_and(|model| {
                    crate::read::has_symbol(model, &seen.claimed.rows[i].symbol)
                });
            let nothing = derivatives[i] == 0.0 && line.u > 0.0 && in_model;
            nothing.then(|| Hit::of(Some(i), format!("c = 0, u = {:.3e}", line.u)))
        })
        .collect()
}

pub(super) fn hidden(seen: &Seen<'_>) -> Vec<Hit> {
    let rows = seen.claimed.rows.iter().enumerate();
    let hidden = rows
        .filter(|(_, row)| row.is_hidden)
        .map(|(i, row)| Hit::of(Some(i), row.at.a1()));
    let stale = seen.claimed.stale.iter().map(|cell| {
        let (at, formula, gives) = (cell.at.a1(), &cell.formula, super::shown(cell.gives));
        Hit::of(None, format!("{at}: {formula} = {gives}"))
    });
    hidden.chain(stale).collect()
}

/// A step of indication that stands in an earlier row already, where neither row says that it is of another reading or
/// instrument.
fn step_again(seen: &Seen<'_>) -> Vec<Hit> {
    let steps: Vec<(usize, &Row, &Printed)> = rows(seen)
        .filter_map(|(at, row, _)| match &row.stated {
            Stated::Step { step } if !has(&row.words.to_lowercase(), APART) => {
                Some((at, row, step))
            }
            _ => None,
        })
        .collect();
    let again = steps
        .iter()
        .enumerate()
        .filter_map(|(later, (at, row, step))| {
            let same = |other: &Printed| other.value == step.value && other.unit == step.unit;
            let (_, first, _) = steps[..later].iter().find(|(_, _, other)| same(other))?;
            let numbers = format!("{}, {}: {}", first.label(), row.label(), step.as_read());
            Some(Hit::of(Some(*at), numbers))
        });
    again.collect()
}

/// What parts one reading, or one instrument, from another.
const APART: &[&str] = &[
    "standard",
    "reference",
    "zero",
    "tare",
    "initial",
    "final",
    "first",
    "second",
    "before",
    "after",
    "标准",
    "参考",
    "零",
    "初",
    "末",
    "起",
    "止",
];

pub(super) fn counted_again(seen: &Seen<'_>) -> Vec<Hit> {
    let mut hits = listed_again(seen);
    let steps = step_again(seen).into_iter().chain(included_again(seen));
    let others = steps.filter(|step| hits.iter().all(|hit| hit.row != step.row));
    let others: Vec<Hit> = others.collect();
    hits.extend(others);
    hits
}

/// A source that stands in the list again, by its name and with every figure.
fn listed_again(seen: &Seen<'_>) -> Vec<Hit> {
    let is_again = |(i, row): (usize, &Row)| {
        let mut above = rows(seen).take_while(|(j, ..)| *j < i);
        above.any(|(_, other, _)| is_repeated(row, other))
    };
    let again = rows(seen).filter(|(i, row, _)| is_again((*i, row)));
    let hit = |(i, row, line): (usize, &Row, &Line)| {
        let part = line.contribution().abs();
        without(seen, i, format!("{}: u_i(y) = {part:.3}", row.label()))
    };
    again.map(hit).collect()
}

/// A row beside another one that says to include it: `resolution 0.01 K` beside `repeatability incl. resolution`.
fn included_again(seen: &Seen<'_>) -> Vec<Hit> {
    let said = rows(seen).flat_map(|(i, row, _)| {
        let parts = included(&row.words).into_iter();
        parts.map(move |part| (i, row.label(), part))
    });
    let said: Vec<(usize, &str, String)> = said.collect();
    let hit = |(i, row, _): (usize, &Row, &Line)| {
        let name = row.name.to_lowercase();
        let mut wholes = said.iter().filter(|(whole, ..)| *whole != i);
        let (_, whole, _) = wholes.find(|(.., part)| name.contains(part.as_str()))?;
        Some(without(seen, i, format!("{whole}: {}", row.label())))
    };
    rows(seen).filter_map(hit).collect()
}

/// What words say that something includes.
fn included(words: &str) -> Vec<String> {
    const INCLUDES: [&str; 10] = [
        "incl. ",
        "incl ",
        "including ",
        "includes ",
        "inclusive of ",
        "已包含",
        "已含",
        "包含了",
        "包括",
        "含有",
    ];
    let lower = words.to_lowercase();
    let part = |key: &&str| {
        let (_, behind) = lower.split_once(*key)?;
        let ends =
            |c: char| matches!(c, '(' | ')' | ',' | ';' | '）' | '，' | '。') || c.is_ascii_digit();
        let part = behind.split(ends).next().unwrap_or_default();
        let part = part.trim().trim_start_matches("the ");
        (part.chars().count() >= 3).then(|| part.to_owned())
    };
    INCLUDES.iter().filter_map(part).collect()
}

/// A row that should not be counted, with the U without it.
fn without(seen: &Seen<'_>, i: usize, numbers: String) -> Hit {
    let mut without = seen.laboratory.clone();
    without.lines[i].counted = false;
    let cmc = seen.claimed.cmc.as_ref().map(|cmc| cmc.value);
    Hit {
        row: Some(i),
        numbers,
        corrected: Some(without.figures(&[], cmc).expanded),
    }
}

/// Whether two rows have one name and the same figures, and some uncertainty among them.
fn is_repeated(row: &Row, other: &Row) -> bool {
    let called = |row: &Row| [&row.symbol, &row.name].map(|name| name.trim().to_lowercase());
    let figures = |row: &Row| {
        let figures = [
            &row.value,
            &row.used,
            &row.divisor,
            &row.u,
            &row.c,
            &row.contribution,
        ];
        figures.map(|figure| {
            figure
                .as_ref()
                .map(|figure| (figure.value, figure.unit.clone()))
        })
    };
    let is_nothing = |figure: &Option<Printed>| figure.as_ref().is_none_or(|f| f.value == 0.0);
    let is_uncertain = [&row.used, &row.u, &row.contribution]
        .into_iter()
        .any(|f| !is_nothing(f));
    is_uncertain
        && !row.label().is_empty()
        && called(row) == called(other)
        && figures(row) == figures(other)
}
