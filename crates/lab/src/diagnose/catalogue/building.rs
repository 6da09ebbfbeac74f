//! What the forms are built of: cells on the offset or on a node, their words, grids of time constants.

use super::course::Course;
use super::fitted::{FittedModel, Node};
use super::modifiers::{figure, grid, in_unit, map};
use super::sharp::best;
use super::{Cell, EffectId, Modifier, Term, Variation, Words};
use crate::diagnose::evidence::Place;

/// Odds beforehand of what is not first order: a square, a rate of change, a product of conditions or labels, an exponential; of what
/// comes at one value, or under some labels only; of a slip of a line where the rows may stand in any order, and of what goes on
/// from row to row where no column says that time does.
pub(super) const HIGHER: f64 = 0.3;

/// A variation by what its terms follow, to be put on a node.
pub(super) fn form(label: impl Into<String>, modifiers: Vec<Modifier>) -> Variation {
    Variation::of(label, modifiers.into_iter().map(on_output).collect())
}

/// A cell whose forms act on a node along something: on all responses, and on each of them alone.
pub(super) fn on_node(
    fitted: &FittedModel<'_>,
    id: EffectId,
    along: &str,
    node: Node,
    forms: impl IntoIterator<Item = Variation>,
) -> Cell {
    let each = |form: Variation| {
        let on = |response: Option<usize>| -> Vec<Term> {
            let terms = form.terms.iter().cloned();
            let on = terms.map(|term| Term {
                node,
                response,
                ..term
            });
            on.collect()
        };
        let responses = fitted.case().responses.len();
        // An error of a column reaches all responses through the model.
        if matches!(node, Node::Column(_)) || form.terms.is_empty() || responses == 1 {
            let terms = on(None);
            return vec![Variation { terms, ..form }];
        }
        let parts = (0..responses).map(|response| (response, on(Some(response))));
        scoped(fitted, &form, parts.collect())
    };
    let all = forms.into_iter().flat_map(each).collect();
    cell(fitted, id, node, along, all)
}

/// Forms of the scale as forms of all that is read, constant terms as well, as where readings were written in another unit; none
/// where the model has no constant terms.
pub(super) fn of_the_whole<'v>(
    fitted: &FittedModel<'_>,
    forms: impl IntoIterator<Item = &'v Variation>,
) -> Vec<Variation> {
    let mut responses = 0..fitted.case().responses.len();
    if !responses.any(|one| !fitted.is_implicit(one) && !fitted.constant_terms(one).is_empty()) {
        return Vec::new();
    }
    let whole = |form: &Variation| {
        let terms = form.terms.iter().cloned();
        let terms = terms.map(|term| Term {
            node: Node::Reading,
            ..term
        });
        Variation {
            label: format!("{}, of the whole reading", form.label),
            terms: terms.collect(),
            // Where both say the same, the simpler one is meant.
            weight: HIGHER * form.weight,
            ..form.clone()
        }
    };
    forms.into_iter().map(whole).collect()
}

/// What a form is on some responses: on each of them alone, if there are others, and on all together.
pub(super) fn scoped(
    fitted: &FittedModel<'_>,
    form: &Variation,
    parts: Vec<(usize, Vec<Term>)>,
) -> Vec<Variation> {
    let responses = &fitted.case().responses;
    let with = |scope: &str, terms: Vec<Term>| {
        let times = terms.len() / form.terms.len().max(1);
        Variation {
            label: scoped_label(scope, form),
            terms,
            spectrum: form.spectrum.as_ref().map(|own| own.repeat(times)),
            ..form.clone()
        }
    };
    let all = || parts.iter().flat_map(|(_, terms)| terms.clone()).collect();
    let together = (responses.len() == 1 || parts.len() > 1).then(|| with("", all()));
    let own = parts.iter().filter(|_| responses.len() > 1);
    let own = own.map(|(response, terms)| with(&responses[*response].name, terms.clone()));
    let every = own.chain(together);
    every.filter(|one| !one.terms.is_empty()).collect()
}

/// The label of a form on some quantity.
pub(super) fn scoped_label(scope: &str, form: &Variation) -> String {
    let words = [scope, &form.label].into_iter();
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join(", ")
}

/// Sine and cosine of a phase, each with a size of its own.
pub(super) fn wave(phase: &[f64], argument: &str) -> Vec<Modifier> {
    let (sine, cosine) = phase.iter().map(|phase| libm::sincos(*phase)).unzip();
    vec![
        Modifier::number(sine, format!("sin({argument})")),
        Modifier::number(cosine, format!("cos({argument})")),
    ]
}

pub(super) fn on_output(modifier: Modifier) -> Term {
    Term::new(Node::Output, modifier)
}

/// What dies away over a time or a length, both also as formulas show them.
pub(super) fn decay(since: &[f64], began: &str, over: f64, shown: &str) -> Modifier {
    let values = map(since, |since| libm::exp(-since / over));
    Modifier::number(values, format!("exp(-{began}/({shown}))"))
}

/// What is added to one response, in its unit.
pub(super) fn added(
    fitted: &FittedModel<'_>,
    response: usize,
    values: Vec<f64>,
    text: impl Into<String>,
) -> Term {
    let unit = fitted.case().responses[response].unit.difference();
    on_output(Modifier::new(values, text, unit)).on(response)
}

/// Variants of several kinds, each kind as likely beforehand as the others however many variants it has.
pub(super) fn kinds(kinds: impl IntoIterator<Item = Vec<Variation>>) -> Vec<Variation> {
    let weighted = |kind: Vec<Variation>| {
        let weight = 1.0 / kind.len() as f64;
        let own = kind.into_iter();
        own.map(move |variation| Variation {
            weight,
            ..variation
        })
    };
    kinds.into_iter().flat_map(weighted).collect()
}

/// A cell on a node along something, with its variants as they are.
pub(super) fn cell(
    fitted: &FittedModel<'_>,
    id: EffectId,
    node: Node,
    along: &str,
    variants: Vec<Variation>,
) -> Cell {
    let words = Words {
        x: along.to_owned(),
        y: fitted.output(),
        p: fitted.name(node),
        ..Words::default()
    };
    Cell::new(id, words, Place::new(fitted.name(node), along), variants)
}

/// A cell whose forms act on a node along two columns.
pub(super) fn pair(
    fitted: &FittedModel<'_>,
    id: EffectId,
    columns: [usize; 2],
    node: Node,
    forms: impl IntoIterator<Item = Variation>,
) -> Cell {
    let mut cell = on_node(fitted, id, &fitted.names(&columns), node, forms);
    [cell.words.x, cell.words.z] = columns.map(|column| fitted.label(column).to_owned());
    cell
}

/// A cell on the offset, alike on all responses.
pub(super) fn plain(
    fitted: &FittedModel<'_>,
    id: EffectId,
    along: &str,
    variants: Vec<Variation>,
) -> Cell {
    cell(fitted, id, Node::Output, along, variants)
}

/// A cell of what is made of neighbouring rows: likely where they follow each other in time, and not where a table is sorted; nothing
/// where readings sorted it.
pub(super) fn slip(
    fitted: &FittedModel<'_>,
    id: EffectId,
    variants: Vec<Variation>,
) -> Option<Cell> {
    (!fitted.is_sorted_by_reading()).then(|| Cell {
        odds: if fitted.is_ordered() { 1.0 } else { HIGHER },
        ..plain(fitted, id, "row", variants)
    })
}

/// A form by its time constants, of which a single one is its shape.
pub(super) fn timed(fitted: &FittedModel<'_>, scales: &[f64], terms: Vec<Term>) -> Variation {
    let unit = fitted.time_unit();
    let shown: Vec<String> = scales.iter().map(|tau| figure(*tau)).collect();
    let shown = in_unit(&shown.join(" and "), &unit);
    let form = Variation::of(format!("τ = {shown}"), terms);
    match scales {
        [tau] => form.shaped("τ", *tau, &unit),
        _ => form,
    }
}

/// Time constants from a fraction of the interval of the blocks to a fraction of the recording; none where rows have no
/// times.
pub(super) fn time_constants(fitted: &FittedModel<'_>) -> Vec<f64> {
    let blocks = fitted.design.blocks.len().max(2) as f64;
    let least = (fitted.clock.span() / blocks).max(fitted.clock.interval);
    time_constants_from(fitted, 0.5 * least)
}

/// The same for what follows an input, which is known within blocks as well: from a fraction of the interval of their pieces on.
pub(super) fn time_constants_of_input(fitted: &FittedModel<'_>) -> Vec<f64> {
    match fitted.rows() > fitted.design.blocks.len() {
        true => time_constants_from(fitted, 0.5 * fitted.clock.interval),
        false => time_constants(fitted),
    }
}

/// The same from another one on.
pub(super) fn time_constants_from(fitted: &FittedModel<'_>, least: f64) -> Vec<f64> {
    match fitted.is_timed() {
        true => grid(least, fitted.clock.span() / 3.0, 1.7, 12),
        false => Vec::new(),
    }
}

/// The course between the rows of which a lag explains the residuals best, where the rows leave more than one possible; by
/// default the likelier one.
pub(super) fn course(
    fitted: &FittedModel<'_>,
    x: &[f64],
    late: &dyn Fn(Course, f64) -> Term,
) -> Course {
    let possible = Course::possible(&fitted.clock.values, x);
    if possible.len() == 1 {
        return possible[0];
    }
    let scales = time_constants(fitted);
    let each = possible
        .iter()
        .flat_map(|course| scales.iter().map(|tau| (*course, *tau)));
    let tried: Vec<(Course, f64)> = each.collect();
    let mut terms = tried.iter().map(|(course, tau)| late(*course, *tau));
    let best = best(fitted, &mut terms);
    best.map_or(possible[0], |at| tried[at].0)
}
