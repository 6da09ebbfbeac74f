//! What is known of a quantity, from the words that a sheet has for it.
//!
//! | chapter | holds |
//! |---|---|
//! | `evidence` | what a row says |
//! | `subject` | what its words are about |
//! | `readings` | what is known from readings |
//! | `limits` | limits, steps and certificates |
//! | `abbreviated` | distributions that a letter stands for |

mod abbreviated;
mod evidence;
mod limits;
mod readings;
mod subject;

use crate::claim::{Relative, Shape, Stated};
use crate::printed::Printed;
use crate::units;

use super::converter;
use super::family::*;
use super::words::{figure_after, has, named_probability, with_units_inside};

pub(crate) use abbreviated::spelled;
pub use evidence::Evidence;
pub(crate) use limits::shape;
use limits::{certificate, cycling, full_width, limits, step, unequal};
use readings::{alike, deviation, range};
use subject::{Subject, subject};

/// What is stated, and whether it is relative.
pub fn stated(e: &Evidence<'_>) -> (Stated, Relative) {
    let own = with_units_inside(&own_words(e.words));
    let e = &Evidence { words: &own, ..*e };
    let text = e.words.to_lowercase();
    let columns = e.columns.to_lowercase();
    let stated = by_words(e, &text).or_else(|| by_columns(e, &columns));
    let stated = stated.unwrap_or_else(|| match e.u {
        Some(u) => Stated::Standard {
            u: u.clone(),
            dof: None,
        },
        None => e.used.map_or(Stated::Nothing, |used| Stated::Standard {
            u: used.clone(),
            dof: None,
        }),
    });
    let stated = match stated {
        Stated::Standard { u, dof: None }
            if is_of_type(&columns, "b") || shape(&columns).is_some() =>
        {
            let dof = Some(f64::INFINITY);
            Stated::Standard { u, dof }
        }
        stated => stated,
    };
    let relative = relative(&stated, &text);
    (stated, relative)
}

/// Whether the laboratory's columns call the evaluation one of type A or B: `A`, `B 类`.
pub(crate) fn is_of_type(columns: &str, letter: &str) -> bool {
    let mut words = columns.split(|c: char| !c.is_alphanumeric());
    words.any(|word| word.strip_suffix('类').unwrap_or(word) == letter)
}

/// Whether a word names a distribution, or the type of evaluation in front of it.
pub(crate) fn names_distribution(word: &str) -> bool {
    let lower = word.to_lowercase();
    let of_type = ["a", "b", "a类", "b类"].contains(&lower.as_str());
    of_type || lower == "t" || shape(&lower).is_some() || has(&lower, NORMAL) || lower == "t分布"
}

/// Words without the clause that says in which other row this one is contained: what that one is, is not said of this.
fn own_words(words: &str) -> String {
    let ends = |c: char| matches!(c, ';' | ',' | '(');
    let clause = CONTAINED
        .iter()
        .filter_map(|key| words.find(key))
        .min()
        .and_then(|at| {
            let start = words[..at].rfind(ends)?;
            let end = words[at..].find(';').map_or(words.len(), |end| at + end);
            Some(start..end)
        });
    let mut own = words.to_string();
    if let Some(clause) =
        clause.filter(|clause| own[..clause.start].contains(|c: char| c.is_ascii_digit()))
    {
        own.replace_range(clause, "");
    }
    own
}

/// What the words state. What the heads and the laboratory's columns call a distribution is its own; words decide.
fn by_words(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    let stepped = || converter::step(e.words).map(|step| Stated::Step { step });
    let of_subject = || match subject(e, text)? {
        Subject::Range => range(e, text),
        Subject::FullWidth => full_width(e, text),
        Subject::Alike => Some(alike()),
        Subject::Step => step(e, text),
        Subject::Certificate => certificate(e, text),
        Subject::Readings => deviation(e, text),
        Subject::Cycling => cycling(e),
        Subject::Limits => limits(e, text),
        Subject::Standard => standard(e, text),
    };
    unequal(e.words).or_else(stepped).or_else(of_subject)
}

fn standard(e: &Evidence<'_>, text: &str) -> Option<Stated> {
    // Of what fitted a parameter, or analysed readings, no other figure is u.
    let is_u = has(text, FIT) || has(text, AS_STATED);
    let analysed = || e.u.filter(|_| is_u).cloned();
    let u = analysed().or_else(|| e.figure_or_used(STANDARD));
    let u = u.or_else(|| e.u.cloned())?;
    Some(Stated::Standard { u, dof: None })
}

/// Where words say nothing, the laboratory's own columns are what there is.
fn by_columns(e: &Evidence<'_>, columns: &str) -> Option<Stated> {
    let used = e.used?.clone();
    let says_probability = named_probability(&e.words.to_lowercase()).is_some();
    if let Some(shape) = shape(columns) {
        // A divisor of twice the root belongs to a full width.
        let twice = |divisor: f64| (divisor / (2.0 * shape.divisor()) - 1.0).abs() < 0.01;
        if e.divisor.is_some_and(twice) {
            return Some(Stated::FullWidth { width: used, shape });
        }
        return Some(Stated::Limits {
            half_width: used,
            shape,
            shape_stated: true,
        });
    }
    if is_of_type(columns, "a") || is_of_type(columns, "t") {
        return deviation(e, "");
    }
    if has(columns, NORMAL) {
        let k = figure_after(columns, &["k"]).map(|k| k.value);
        let k_stated = k.is_some() || e.divisor_is_factor || says_probability;
        // What is not divided, or by 1, under a normal distribution is a standard uncertainty.
        let undivided = e.u_is_used().then_some(1.0);
        let k = k.or(e.divisor).or(undivided).unwrap_or(2.0);
        return Some(match k {
            1.0 => Stated::Standard { u: used, dof: None },
            k => Stated::Certificate {
                expanded: used,
                k,
                k_stated,
            },
        });
    }
    let divisor = e.divisor?;
    let close = |x: f64| (divisor - x).abs() < 0.01 * x;
    let limits = |shape| {
        Some(Stated::Limits {
            half_width: used.clone(),
            shape,
            shape_stated: false,
        })
    };
    match () {
        () if close(libm::sqrt(3.0)) => limits(Shape::Rectangular),
        () if close(libm::sqrt(6.0)) => limits(Shape::Triangular),
        () if close(2.0 * libm::sqrt(3.0)) => Some(Stated::Step { step: used }),
        () if close(libm::sqrt(2.0)) => limits(Shape::Arcsine),
        () if close(1.0) => Some(Stated::Standard { u: used, dof: None }),
        () => Some(Stated::Certificate {
            expanded: used,
            k: divisor,
            k_stated: e.divisor_is_factor || says_probability,
        }),
    }
}

fn relative(stated: &Stated, text: &str) -> Relative {
    let unit = stated.figure().map_or("", |figure| figure.unit.as_str());
    let Some(fraction) = units::fraction(unit) else {
        return Relative::No;
    };
    let full_scale = figure_after(text, &[FULL_SCALE, &["range of"]].concat());
    let of_full_scale = has(text, FULL_SCALE) || has(text, &["of range", "of the range"]);
    match full_scale {
        Some(scale) if of_full_scale => Relative::OfFullScale(fraction, scale.value),
        _ => Relative::OfValue(fraction),
    }
}

impl Stated {
    /// The figure that is stated; the larger one of unequal limits.
    pub fn figure(&self) -> Option<&Printed> {
        match self {
            Stated::Nothing => None,
            Stated::Certificate { expanded, .. } => Some(expanded),
            Stated::Limits { half_width, .. } => Some(half_width),
            Stated::FullWidth { width, .. } => Some(width),
            Stated::Step { step } => Some(step),
            Stated::Unequal { plus, minus } => Some(if plus.value >= minus.value {
                plus
            } else {
                minus
            }),
            Stated::Deviation { s, .. } => Some(s),
            Stated::Range { range, .. } => Some(range),
            Stated::Standard { u, .. } => Some(u),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(words: &str, used: Option<f64>, full: bool) -> Stated {
        let used = used.map(|x| Printed::parse(&x.to_string()).unwrap());
        let e = Evidence {
            words,
            used: used.as_ref(),
            full,
            ..Evidence::default()
        };
        stated(&e).0
    }

    #[test]
    fn kinds_in_english_and_chinese() {
        let certificate = |words: &str| match read(words, None, true) {
            Stated::Certificate { expanded, k, .. } => (expanded.value, k),
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(
            certificate("certificate M-12: U = 0.05 g, k = 2"),
            (0.05, 2.0)
        );
        assert_eq!(
            certificate("标准砝码证书给出扩展不确定度 U=0.05 g，k=2.13"),
            (0.05, 2.13)
        );
        let step = |words: &str, used| match read(words, used, false) {
            Stated::Step { step } => step.value,
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(step("digital step 0.01 mm", None), 0.01);
        assert_eq!(step("数显分辨力", Some(0.01)), 0.01);
        let deviation = |words: &str| match read(words, Some(0.012), true) {
            Stated::Deviation { s, n, m, pooled } => (s.value, n, m, pooled),
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(
            deviation("s of 10 readings, mean of 4 reported"),
            (0.012, Some(10.0), 4.0, None)
        );
        assert_eq!(
            deviation("repeatability: standard deviation of 10 readings, the mean is reported"),
            (0.012, Some(10.0), 10.0, None)
        );
        assert_eq!(
            deviation("重复测量10次的实验标准偏差，取4次平均值"),
            (0.012, Some(10.0), 4.0, None)
        );
        assert_eq!(
            deviation("pooled s from 6 series of 5 readings, mean of 3 readings"),
            (0.012, Some(5.0), 3.0, Some(24.0))
        );
        let shape = |words: &str| match read(words, Some(0.3), true) {
            Stated::Limits {
                half_width, shape, ..
            } => (half_width.value, shape),
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(shape("limits ±0.5 °C"), (0.5, Shape::Rectangular));
        assert_eq!(
            shape("cycling of the air conditioning, amplitude 0.4 °C"),
            (0.4, Shape::Arcsine)
        );
        assert_eq!(shape("最大允许误差 ±0.2 mV"), (0.2, Shape::Rectangular));
        assert_eq!(
            shape("within the limits, triangular"),
            (0.3, Shape::Triangular)
        );
        assert!(matches!(
            read("tolerance +0.03/-0.01 mm", None, true),
            Stated::Unequal { .. }
        ));
        assert!(matches!(
            read("total width 0.4 K", None, true),
            Stated::FullWidth { .. }
        ));
        assert!(matches!(
            read("极差法，n=4", Some(0.3), true),
            Stated::Range { n: 4.0, .. }
        ));
    }
}
