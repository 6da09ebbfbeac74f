//! Effects whose size differs from one label to another: a delay of one run, a drift of one instrument. Offset and scale by label are
//! effects of their own (`levels`); of all others this is asked once something was found.

use super::building::{HIGHER, kinds};
use super::fitted::FittedModel;
use super::levels::{Factor, of_instruments};
use super::{Cell, Modifier, Term, Variation};

/// Whether there are labels under which sizes may differ.
pub fn may_split(fitted: &FittedModel<'_>) -> bool {
    !splitting(fitted).is_empty()
}

/// Puts beside each form of which the size may differ those with a size of its own under each label of a column, and under one of them
/// alone.
pub(super) fn split(fitted: &FittedModel<'_>, cells: &mut [Cell]) {
    let asked = &fitted.finer.by_label;
    if asked.is_empty() {
        return;
    }
    let factors = splitting(fitted);
    for cell in cells {
        let forms = cell.variants.iter().filter(|form| asked.has(cell, form));
        let of = |form| {
            factors
                .iter()
                .flat_map(move |factor| [vec![each(form, factor)], single(form, factor)])
        };
        let split = kinds(forms.flat_map(of));
        let all: f64 = split.iter().map(|form| form.weight).sum();
        let whole: f64 = cell.variants.iter().map(|form| form.weight).sum();
        // All of them together, beside the forms that are the same everywhere.
        let share = HIGHER * whole / all;
        let split = split.into_iter().map(|form| Variation {
            weight: form.weight * share,
            ..form
        });
        let split: Vec<Variation> = split.collect();
        cell.variants.extend(split);
    }
}

/// Columns of labels that have more rows each than the root of all, on average: what fewer carry looks like single wild readings. Where
/// a recording is held out, those of which it has no other labels: of a size in a run to come it would tell nothing.
fn splitting<'f>(fitted: &FittedModel<'f>) -> Vec<Factor<'f>> {
    let rows = fitted.design.blocks.len();
    let held_out = fitted.case().held_out.as_ref();
    let mut factors = of_instruments(fitted, (1, 2));
    factors.retain(|factor| {
        let held_out = held_out.and_then(|held_out| held_out.rows.data.get(factor.index));
        factor.levels.len().pow(2) <= rows && held_out.is_none_or(|other| factor.has_all(other))
    });
    factors
}

/// A size of its own under each label.
fn each(form: &Variation, factor: &Factor<'_>) -> Variation {
    let words = format!("another size in each {}", factor.column.name);
    let parts = factor
        .levels
        .iter()
        .map(|level| under(form, &factor.modifier(*level)));
    let terms = parts.flatten().collect();
    Variation {
        shape: None,
        ..labelled(form, words, terms)
    }
}

/// Under one label alone.
fn single(form: &Variation, factor: &Factor<'_>) -> Vec<Variation> {
    let of = |level: &u32| {
        let words = format!("only in {} {}", factor.column.name, factor.text(*level));
        labelled(form, words, under(form, &factor.modifier(*level)))
    };
    factor.levels.iter().map(of).collect()
}

fn labelled(form: &Variation, words: String, terms: Vec<Term>) -> Variation {
    let label = match form.label.as_str() {
        "" => words.clone(),
        label => format!("{label}, {words}"),
    };
    Variation {
        label,
        terms,
        of_labels: Some(words),
        ..form.clone()
    }
}

/// The terms of a form in some rows only.
fn under(form: &Variation, rows: &Modifier) -> Vec<Term> {
    let terms = form.terms.iter().map(|term| Term {
        modifier: term.modifier.times(rows),
        written: term.written.as_ref().map(|written| written.times(rows)),
        ..term.clone()
    });
    terms.collect()
}
