//! Effects whose size differs from one label to another: a delay of one run, a drift of one instrument. Offset and scale by label are
//! effects of their own (`levels`); of all others this is asked once something was found.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::absorbed::Absorbed;
use super::building::HIGHER;
use super::fitted::FittedModel;
use super::levels::{Factor, of_instruments};
use super::sharp::{best_form, leading, may_have_its_size};
use super::{Cell, Forms, Modifier, Term, Variation, cells};
use crate::diagnose::evidence::over_noise;

/// Whether there are labels under which sizes may differ.
pub fn may_split(fitted: &FittedModel<'_>) -> bool {
    !splitting(fitted).is_empty()
}

/// The effects by what they explain under one label alone of what columns leave, with these standard uncertainties of the observations;
/// that which explains most is the first.
pub fn under_one_label<'c>(
    fitted: &FittedModel<'_>,
    cells: &'c [Cell],
    (columns, u): (&DMatrix<f64>, &DVector<f64>),
) -> Vec<&'c Cell> {
    let beside = Absorbed::by_columns(columns, &fitted.fit.residuals, u);
    let factors = splitting(fitted);
    let labels = factors.iter().flat_map(|factor| {
        let levels = factor.levels.iter();
        levels.map(|level| factor.modifier(*level))
    });
    let labels: Vec<Modifier> = labels.collect();
    let power = |cell: &Cell| {
        let forms = cell.variants.iter().filter(|form| form.of_labels.is_none());
        let each = forms.flat_map(|form| labels.iter().map(move |label| (form, label)));
        let power = |(form, label): (&Variation, &Modifier)| {
            let columns = Variation::of("", under(form, label)).columns(fitted);
            beside.power_of_all(&over_noise(&columns, u))
        };
        each.map(power).fold(0.0, f64::max)
    };
    let usual = cells.iter().filter(|cell| Forms::may_be(cell));
    let mut powers: Vec<(f64, &Cell)> = usual.map(|cell| (power(cell), cell)).collect();
    powers.sort_by(|a, b| b.0.total_cmp(&a.0));
    powers.into_iter().map(|(_, cell)| cell).collect()
}

/// Where the sizes of effects may differ by label: values between those of the grids, about the forms that explain the residuals best
/// under each label. Grids are moved onto what explains all rows.
pub fn closer_by_label(mut fitted: FittedModel<'_>) -> FittedModel<'_> {
    /// So often the values are brought closer together.
    const ROUNDS: u8 = 3;
    for _ in 0..ROUNDS {
        let mut finer = fitted.finer.clone();
        for cell in cells(&fitted) {
            let shaped = cell.variants.iter().filter(|form| form.shape.is_some());
            let mut under: BTreeMap<&str, Vec<&Variation>> = BTreeMap::new();
            for form in shaped {
                if let Some(words) = &form.of_labels {
                    under.entry(words).or_default().push(form);
                }
            }
            let best = under.into_values();
            for form in best.filter_map(|forms| best_form(&fitted, forms)) {
                finer.add(&cell, form);
            }
        }
        fitted = fitted.refined(finer);
    }
    fitted
}

/// Puts beside each form of which the size may differ those with a size of its own under each label of a column, and under one of them
/// alone. What has another size over all rows than it is made for may have it under one label, and is left out after that.
pub(super) fn split(fitted: &FittedModel<'_>, cells: &mut [Cell]) {
    let asked = &fitted.finer.by_label;
    let factors = match asked.is_empty() {
        true => Vec::new(),
        false => splitting(fitted),
    };
    for cell in cells {
        let forms: Vec<&Variation> = match asked.has(cell) {
            true => cell.variants.iter().collect(),
            false => Vec::new(),
        };
        let mut split: Vec<Vec<Variation>> = factors
            .iter()
            .flat_map(|factor| under_labels(fitted, &forms, factor))
            .collect();
        (cell.variants).retain(|form| may_have_its_size(fitted, form, &form.terms));
        let weight = |forms: &[Variation]| forms.iter().map(|form| form.weight).sum::<f64>();
        // All of them together, beside the forms that are the same everywhere.
        let all: f64 = split.iter().map(|forms| weight(forms)).sum();
        let share = HIGHER * weight(&cell.variants) / all;
        for form in split.iter_mut().flatten() {
            form.weight *= share;
        }
        let split = split.into_iter();
        // A form with a parameter may lead when that is found more closely.
        let kinds = split.flat_map(|forms| -> [Vec<Variation>; 2] {
            forms
                .into_iter()
                .partition(|form| form.shape.is_some())
                .into()
        });
        (cell.variants).extend(kinds.flat_map(|forms| leading(fitted, forms)));
    }
}

/// Forms with a size of its own under each label, and for each label those with a size under it alone.
fn under_labels(
    fitted: &FittedModel<'_>,
    forms: &[&Variation],
    factor: &Factor<'_>,
) -> Vec<Vec<Variation>> {
    let every = forms.iter().filter_map(|form| each(fitted, form, factor));
    let single = |level: &u32| {
        let under = |form: &&Variation| single(fitted, form, factor, *level);
        forms.iter().filter_map(under).collect()
    };
    let singles = factor.levels.iter().map(single);
    std::iter::once(every.collect()).chain(singles).collect()
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
fn each(fitted: &FittedModel<'_>, form: &Variation, factor: &Factor<'_>) -> Option<Variation> {
    let words = format!("another size in each {}", factor.column.name);
    let levels = factor.levels.iter();
    let parts = levels.map(|level| under(form, &factor.modifier(*level)));
    let parts: Vec<Vec<Term>> = parts.collect();
    let may_be = (parts.iter()).all(|terms| may_have_its_size(fitted, form, terms));
    may_be.then(|| Variation {
        shape: None,
        ..labelled(form, words, parts.concat())
    })
}

/// Under one label alone, as likely as under any other.
fn single(
    fitted: &FittedModel<'_>,
    form: &Variation,
    factor: &Factor<'_>,
    level: u32,
) -> Option<Variation> {
    let words = format!("only in {} {}", factor.column.name, factor.text(level));
    let terms = under(form, &factor.modifier(level));
    may_have_its_size(fitted, form, &terms).then(|| Variation {
        weight: form.weight / factor.levels.len() as f64,
        ..labelled(form, words, terms)
    })
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
        exact: None,
        ..term.clone()
    });
    terms.collect()
}
