//! What is known as limits, steps and certificates.

use gumption_core::special::normal_two_sided_quantile;

use crate::claim::{Shape, Stated};
use crate::printed::{Printed, leading};
use crate::read::family::*;
use crate::read::words::{figure_after, figures_with_units, has, named_probability, signed_pair};
use crate::units;

use super::evidence::Evidence;

pub(super) fn limits(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    let of_class = e.used.filter(|used| e.full && is_of_class(e.words, used));
    let half_width = match of_class {
        Some(used) => used.clone(),
        None => e.figure_or_used(&[LIMITS, &["误差"]].concat())?,
    };
    let level = (is_95(text) || has(text, &["confidence of", "level of confidence", "置信"]))
        && !has(
            text,
            &[
                "no level",
                "without a level",
                "nothing else",
                "without level",
                "未给出置信",
                "无置信",
            ],
        );
    // A column of distributions that makes u larger than nothing but limits would (arcsine) needs no reason; one that makes
    // it smaller does.
    let cautious = || {
        let of_column = shape(&e.columns.to_lowercase());
        of_column.filter(|shape| shape.divisor() < Shape::Rectangular.divisor())
    };
    // The reason is known of volumes of glassware, which are made to their nominal value (QUAM:2012, A1).
    let to_nominal = || {
        let of_column = shape(&e.columns.to_lowercase());
        of_column.filter(|shape| *shape == Shape::Triangular && is_of_glassware(e, text))
    };
    // `accuracy, 99 %`, divided by 2.58.
    let of_probability = || {
        let k = normal_two_sided_quantile(named_probability(text)?);
        let divisor = e.divisor?;
        ((divisor / k - 1.0).abs() < 0.01).then_some(Shape::Normal(k))
    };
    let shape = shape(text)
        .or_else(of_probability)
        .or_else(|| level.then(|| Shape::Normal(normal_factor(e, text))))
        .or_else(cautious)
        .or_else(to_nominal);
    Some(Stated::Limits {
        half_width,
        shape: shape.unwrap_or(Shape::Rectangular),
        shape_stated: shape.is_some(),
    })
}

/// Whether limits are those of the capacity of glassware, which the row says, or the title where the row is about a volume.
fn is_of_glassware(e: &Evidence<'_>, text: &str) -> bool {
    const OF_VOLUME: &[&str] = &[
        "calibration",
        "volume",
        "capacity",
        "tolerance",
        "nominal",
        "容量",
        "体积",
        "校准",
        "允差",
    ];
    let is_titled = || has(&e.title.to_lowercase(), GLASSWARE);
    has(text, GLASSWARE) || has(text, OF_VOLUME) && is_titled()
}

/// Whether a text speaks of 95 %, and not of 0.95 % or 95 %RH.
fn is_95(text: &str) -> bool {
    ["95 %", "95%"].iter().any(|level| {
        text.match_indices(level).any(|(at, _)| {
            let inside = text[..at].ends_with(|c: char| c.is_ascii_digit() || ".,".contains(c));
            let of_a_unit = text[at + level.len()..].starts_with(char::is_alphabetic);
            !inside && !of_a_unit
        })
    })
}

/// The factor that limits at 95 % stand for: as stated, else 1.96 or 2, as the laboratory has it.
fn normal_factor(e: &Evidence<'_>, text: &str) -> f64 {
    let stated = figure_after(text, &["k"])
        .map(|k| k.value)
        .filter(|k| (1.0..5.0).contains(k));
    stated.unwrap_or(if e.divisor == Some(2.0) { 2.0 } else { 1.96 })
}

pub(super) fn step(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    const HALF: &[&str] = &["±", "+/-", "half", "半宽"];
    if let Some(step) = e.figure(STEP) {
        // `resolution ± 0.005` is half of it, and so are `estimated to a fifth of a division (half-width 0.005)` and `a = 0.005` (JCGM 100,
        // 4.3.7).
        let named = figure_after(text, &["half-width", "half width", "半宽", "a =", "a="]);
        let half = named.is_some_and(|half| half.value == step.value)
            || step.text.trim_start().starts_with('±')
            || text.contains(&format!("± {}", step.text))
            || text.contains(&format!("±{}", step.text));
        // `estimated to 1/10 of a division of 20 kPa`
        let part = part_of_division(text).filter(|_| !half);
        if let Some(half_width) = part.and_then(|part| half_of_part(e, &step, part)) {
            return Some(Stated::Limits {
                half_width,
                shape: Shape::Rectangular,
                shape_stated: true,
            });
        }
        if half || part.is_some() {
            return Some(Stated::Limits {
                half_width: step.scaled(part.unwrap_or(1.0)),
                shape: Shape::Rectangular,
                shape_stated: true,
            });
        }
        let twice = e.u.filter(|u| is_of_difference(u, &step));
        return Some(match twice {
            Some(_) => Stated::Limits {
                half_width: step,
                shape: Shape::Triangular,
                shape_stated: false,
            },
            None => Stated::Step { step },
        });
    }
    let used = e.used?.clone();
    // A difference of two indications, of which each may be off by half a step, has a triangle (ISO 376, annex C; M3003,
    // K2): the divisor is all that says so.
    let triangle = Shape::Triangular;
    let by_root6 = e
        .divisor
        .is_some_and(|d| (d / triangle.divisor() - 1.0).abs() < 0.01);
    let of_column = shape(&e.columns.to_lowercase()).unwrap_or(triangle);
    if by_root6 && shape(text).is_none() && of_column == triangle {
        return Some(Stated::Limits {
            half_width: used,
            shape: triangle,
            shape_stated: false,
        });
    }
    let by_twice_root3 = e
        .divisor
        .is_some_and(|d| (d - 2.0 * libm::sqrt(3.0)).abs() < 0.02);
    // A summary states what is known: the whole step, unless its words, of column or row, and its divisor both say half of it.
    let by_root3 = e
        .divisor
        .is_some_and(|d| (d - libm::sqrt(3.0)).abs() < 0.01);
    let head = e.used_head.to_lowercase();
    // Forms that call the distribution itself `resolution` mean the whole step by it, u = step/√12.
    let of_steps = !by_root3 && has(&e.columns.to_lowercase(), &["resolution", "分辨力"]);
    let half = by_root3 && [head.as_str(), text].iter().any(|words| has(words, HALF));
    let whole = by_twice_root3 || of_steps || !e.full && !half;
    Some(if whole {
        Stated::Step { step: used }
    } else {
        Stated::Step {
            step: used.scaled(2.0),
        }
    })
}

/// Half the part of a division to which an indication is estimated, where the laboratory takes the part for the whole width: so its ± says,
/// or else its u.
fn half_of_part(e: &Evidence<'_>, step: &Printed, part: f64) -> Option<Printed> {
    let width = |unit: &str| part * step.value * units::factor(&step.unit, unit).unwrap_or(1.0);
    let half = |unit: &str| width(unit) / 2.0;
    match (e.used.filter(|_| e.full), e.u) {
        (Some(used), _) => used
            .is_met_within(half(&used.unit), used.half)
            .then(|| used.clone()),
        (None, Some(u)) => {
            let root3 = libm::sqrt(3.0);
            let is_met = |limit: f64| u.is_met_within(limit / root3, u.half_of_digits());
            let is_half = is_met(half(&u.unit)) && !is_met(width(&u.unit));
            is_half.then(|| step.clone().scaled(part / 2.0))
        }
        _ => None,
    }
}

/// Whether what was used is a class, or a percentage, of an amount that the words name: 3.0 kPa of `accuracy class 0.5, 600 kPa`.
fn is_of_class(words: &str, used: &Printed) -> bool {
    let mut amounts =
        figures_with_units(words).filter(|amount| units::fraction(&amount.unit).is_none());
    let classes: Vec<f64> = numbers(words).collect();
    amounts.any(|amount| {
        let factor = match (amount.unit.as_str(), used.unit.as_str()) {
            (_, "") => Some(1.0),
            (own, unit) => units::factor(own, unit),
        };
        let parts = classes
            .iter()
            .filter(|class| (0.001..=10.0).contains(*class));
        let mut limits =
            parts.map(|class| class / 100.0 * amount.value.abs() * factor.unwrap_or(0.0));
        factor.is_some() && limits.any(|limit| used.is_met_within(limit, used.half))
    })
}

/// The numbers of a text that are no part of a word.
fn numbers(text: &str) -> impl Iterator<Item = f64> {
    let starts = text.char_indices().filter(|(at, c)| {
        let before = text[..*at].chars().next_back();
        let joined = |c: char| c.is_ascii_alphanumeric() || ".,_/^-".contains(c);
        c.is_ascii_digit() && !before.is_some_and(joined)
    });
    let places: Vec<usize> = starts.map(|(at, _)| at).collect();
    places
        .into_iter()
        .filter_map(|at| Some(leading(&text[at..])?.0.value))
}

/// Whether u is that of a difference of two indications with this step, √2 times that of one (OIML R 111-1, C.6.4.3).
fn is_of_difference(u: &Printed, step: &Printed) -> bool {
    let met = |divisor: f64| {
        let factor = units::factor(&step.unit, &u.unit).unwrap_or(1.0);
        (factor * step.value / divisor - u.value).abs() <= u.half_of_digits()
    };
    met(Shape::Triangular.divisor()) && !met(libm::sqrt(12.0))
}

/// The part of a division to which an indication is estimated: `1/10 of a division`, `分度值的 1/5`.
fn part_of_division(text: &str) -> Option<f64> {
    let parts = text.match_indices("1/").filter(|(at, _)| {
        let before = text[..*at].chars().next_back();
        !before.is_some_and(|c| c.is_ascii_digit() || ".,/".contains(c))
    });
    let of = |(at, lead): (usize, &str)| {
        let rest = &text[at + lead.len()..];
        let behind = rest.trim_start_matches(|c: char| c.is_ascii_digit());
        let n: f64 = rest[..rest.len() - behind.len()].parse().ok()?;
        // `1/10/2026` is a day.
        let is_part = (3.0..=20.0).contains(&n) && !behind.starts_with('/');
        is_part.then(|| 1.0 / n)
    };
    parts.filter_map(of).next()
}

pub(super) fn certificate(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    const KEYS: &[&str] = &[
        "expanded uncertainty",
        "扩展不确定度",
        "u =",
        "u=",
        "u(k=2)",
        "u95",
        "u",
        "uncertainty",
        "不确定度",
    ];
    let quotient = quotient(e.words);
    let of_quotient = quotient.as_ref().map(|(expanded, _)| expanded.clone());
    let expanded = of_quotient.or_else(|| e.figure_or_used(KEYS))?;
    let below = quotient.map(|(_, k)| k);
    let in_words = below.or_else(|| coverage_factor(text));
    let in_words = in_words.or_else(|| coverage_factor(&e.columns.to_lowercase()));
    let head = figure_after(&e.used_head.to_lowercase(), &["k"])
        .map(|k| k.value)
        .filter(|k| (1.0..5.0).contains(k));
    let by_divisor = e
        .divisor
        .filter(|d| (1.6..3.5).contains(d) && (d - libm::sqrt(3.0)).abs() > 0.01);
    let in_column = by_divisor.filter(|_| e.divisor_is_factor);
    let stated = in_words.or(head).or(in_column);
    let k = stated.or(by_divisor).unwrap_or(2.0);
    // A coverage probability says as much (JCGM 100, 7.2.3).
    Some(Stated::Certificate {
        expanded,
        k,
        k_stated: stated.is_some() || named_probability(text).is_some(),
    })
}

/// U and k of a calculation that states both, `u(V_s) = U/k = 0.06 mV/2`.
fn quotient(words: &str) -> Option<(Printed, f64)> {
    let (_, behind) = words.split_once("U/k")?;
    let (expanded, behind) = leading(behind.trim_start().strip_prefix('=')?.trim_start())?;
    let (unit, behind) = behind.split_once('/')?;
    let (k, behind) = leading(behind.trim_start())?;
    // Behind the result stands the unit of both.
    let result = || {
        behind
            .trim_start()
            .strip_prefix('=')
            .and_then(|rest| leading(rest.trim_start()))
    };
    let unit = match unit.trim() {
        "" => result().map_or("", |(_, unit)| {
            unit.split_whitespace().next().unwrap_or_default()
        }),
        unit => unit,
    };
    let unit = Some(unit).filter(|unit| units::parse(unit).is_some());
    let unit = unit.unwrap_or_default().to_string();
    (1.0..5.0)
        .contains(&k.value)
        .then_some((Printed { unit, ..expanded }, k.value))
}

/// The k that a text in small letters states.
fn coverage_factor(text: &str) -> Option<f64> {
    // The number of a certificate may begin with a K, too.
    let keys = ["k =", "k=", "coverage factor", "包含因子", "k"];
    let figures = keys.iter().filter_map(|key| figure_after(text, &[key]));
    figures.map(|k| k.value).find(|k| (1.0..5.0).contains(k))
}

pub(super) fn full_width(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    // The ± column of a full table holds the half that was used.
    let widths = if e.full { 2.0 } else { 1.0 };
    let used = || e.used.map(|used| used.clone().scaled(widths));
    let keys = [FULL_WIDTH, &["width", "宽度", "span"]].concat();
    let width = e.figure(&keys).or_else(used)?;
    let shape = shape(text).unwrap_or(Shape::Rectangular);
    Some(Stated::FullWidth { width, shape })
}

pub(super) fn cycling(e: &Evidence<'_>) -> Option<Stated> {
    const KEYS: &[&str] = &[
        "amplitude",
        "±",
        "幅值",
        "振幅",
        "cycling",
        "within",
        "limits",
    ];
    Some(Stated::Limits {
        half_width: e.figure_or_used(KEYS)?,
        shape: Shape::Arcsine,
        shape_stated: true,
    })
}

/// `+0.03 / −0.01`, as positive numbers; limits where both are the same.
pub(super) fn unequal(text: &str) -> Option<Stated> {
    let (plus, minus) = signed_pair(text)?;
    Some(if plus.value == minus.value {
        let shape = shape(text);
        Stated::Limits {
            half_width: plus,
            shape: shape.unwrap_or(Shape::Rectangular),
            shape_stated: shape.is_some(),
        }
    } else {
        Stated::Unequal { plus, minus }
    })
}

/// The distribution that a text in small letters names.
pub(crate) fn shape(text: &str) -> Option<Shape> {
    let beta = || figure_after(text, &["β", "beta"]).map_or(0.5, |b| b.value);
    if has(text, TRIANGULAR) {
        Some(Shape::Triangular)
    } else if has(text, TRAPEZOID) {
        Some(Shape::Trapezoidal(beta()))
    } else if has(text, ARCSINE) {
        Some(Shape::Arcsine)
    } else if has(text, TWO_POINT) {
        Some(Shape::TwoPoint)
    } else {
        has(text, RECTANGULAR).then_some(Shape::Rectangular)
    }
}
