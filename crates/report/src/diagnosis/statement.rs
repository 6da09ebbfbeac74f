//! The verdict of a diagnosis in one sentence.

use crate::language::Language;
use crate::number::significant;
use gumption_fault::say;
use gumption_lab::diagnose::evidence::{Alternative, Slot};
use gumption_lab::diagnose::{Conclusion, Diagnosis};

use super::names::Names;
use super::words::{chance, is_below_all_shown};

/// The verdict, with what else it may be where noise that wanders stands in it.
pub(super) fn statement(diagnosis: &Diagnosis, l: Language) -> String {
    let names = Names::of_diagnosis(diagnosis, l);
    let verdict = verdict(diagnosis, l);
    let Some(found) = &diagnosis.if_independent else {
        return verdict;
    };
    let slots = found.examination.slots.iter();
    let list = joined(slots.map(|slot| slot_name(diagnosis, slot, names)), l);
    let odds = significant(found.odds, 2);
    say!("{verdict} Or successive rows are independent, and the model leaves out, {odds} times as likely: {list}.").in_language(l)
}

/// The verdict in one sentence.
fn verdict(diagnosis: &Diagnosis, l: Language) -> String {
    let names = Names::of_diagnosis(diagnosis, l);
    let list = |slots: &[&Slot]| {
        let names = slots.iter().map(|slot| slot_name(diagnosis, slot, names));
        names.collect::<Vec<_>>().join(l.semicolon())
    };
    let told = |list: &[&Alternative]| joined(list.iter().map(|one| names.told(diagnosis, one)), l);
    let at =
        |places: &[&Alternative]| joined(places.iter().map(|one| names.plain(one.candidate)), l);
    let behind = |places: &[&Alternative]| match at(places) {
        none if none.is_empty() => none,
        places => l.with_head("", &places),
    };
    match diagnosis.conclusion() {
        Conclusion::Agreement if diagnosis.noise.is_estimated() && diagnosis.noise.wanders() => say!("Nothing in the catalogue is seen beside noise that wanders from row to row. No noise is claimed that it could be held against: something left out that changes with time would look the same.").in_language(l),
        Conclusion::Agreement if diagnosis.noise.is_estimated() => say!("Model and recording agree: nothing is left out that this recording can show. No noise is claimed that its scatter could be held against.").in_language(l),
        Conclusion::Agreement => say!("Model and recording agree within what is claimed: nothing is left out that this recording can show.").in_language(l),
        Conclusion::Exact => say!("The model meets every reading exactly: nothing is left out, and there is no noise that it could be told from. Readings of an instrument scatter; were these computed?").in_language(l),
        Conclusion::Untested => {
            let (observations, unknowns) = (diagnosis.before.observations, diagnosis.unknowns.len());
            say!("The recording cannot test the model: an effect beside its {unknowns} parameters would leave none of {observations} observations to tell it from noise. More rows would.").in_language(l)
        }
        Conclusion::LeavesOut { told, open } => {
            let verdict = left_out(&list(&told), &list(&open), l);
            match diagnosis.noise.wanders() {
                true => say!("{verdict} What is left wanders from row to row, as something else would that is left out and changes with time.").in_language(l),
                false => verdict,
            }
        }
        Conclusion::AndMore {
            named,
            tentative,
            places,
        } => and_more([&list(&named), &told(&tentative), &behind(&places)], l),
        Conclusion::Tentative { names, places } => {
            let names = told(&names);
            let besides = match at(&places) {
                none if none.is_empty() => none,
                places => say!(" Unexplained besides: {places}.").in_language(l),
            };
            say!("Model and recording disagree. Tentatively, the model leaves out: {names}.{besides}").in_language(l)
        }
        Conclusion::Undecided { name, places } => {
            let (places, p) = (at(&places), chance(name.probability));
            let name = names.told(diagnosis, name);
            say!("Model and recording disagree, and it is not decided why: {places}, or {name} ({p} %).").in_language(l)
        }
        Conclusion::Unexplained { places } => {
            let places = behind(&places);
            say!("Model and recording disagree, and nothing in the catalogue explains it{places}.").in_language(l)
        }
    }
}

fn left_out(told: &str, open: &str, l: Language) -> String {
    match (told.is_empty(), open.is_empty()) {
        (_, true) => say!("The model leaves out: {told}.").in_language(l),
        (true, false) => say!("The model leaves out something that this recording cannot tell apart: {open}.").in_language(l),
        (false, false) => say!("The model leaves out: {told}; and something that this recording cannot tell apart: {open}.").in_language(l),
    }
}

/// The verdict where something has no name.
fn and_more([list, tentative, places]: [&str; 3], l: Language) -> String {
    let sentence = say!("The model leaves out: {list}. Something without a name remains{places}.")
        .in_language(l);
    match tentative {
        "" => sentence,
        _ => say!("{sentence} Tentatively also: {tentative}.").in_language(l),
    }
}

/// Each text once, in the order of their first places.
fn joined(texts: impl Iterator<Item = String>, l: Language) -> String {
    let mut kept: Vec<String> = Vec::new();
    for text in texts {
        if !kept.contains(&text) {
            kept.push(text);
        }
    }
    kept.join(l.semicolon())
}

/// The names of a slot: joined by "or", unless one of them leads.
fn slot_name(diagnosis: &Diagnosis, slot: &Slot, names: Names<'_>) -> String {
    let list = names.slot(diagnosis, slot);
    if slot.acts_like() {
        let name = names.l.either(&shortened(list, names.l));
        return say!("something that acts like {name}").in_language(names.l);
    }
    match slot.named.as_slice() {
        [leading, others @ ..] if list.len() > 1 && !slot.is_open() => {
            let aside = not_excluded(diagnosis, leading, others, names);
            names.l.with_aside(&list[0], &aside)
        }
        _ => names.l.either(&shortened(list, names.l)),
    }
}

/// How likely the name is that leads a list, and what else stands on it: by its probability, or because it could have the same
/// shape, as two of its forms together have, or an alias.
fn not_excluded(
    diagnosis: &Diagnosis,
    leading: &Alternative,
    others: &[Alternative],
    names: Names<'_>,
) -> String {
    let l = names.l;
    let (alike, likely): (Vec<&Alternative>, Vec<&Alternative>) =
        (others.iter()).partition(|one| !one.jointly && is_below_all_shown(one.probability));
    let list = |some: &[&Alternative]| names.several(diagnosis, some).join(l.list_comma());
    let mut parts = vec![format!("{} %", chance(leading.probability))];
    if !likely.is_empty() {
        let others = list(&likely);
        parts.push(say!("not excluded: {others}").in_language(l));
    }
    if !alike.is_empty() {
        let others = list(&alike);
        parts.push(say!("of a shape that can be nearly the same: {others}").in_language(l));
    }
    parts.join(l.semicolon())
}

/// A list that can be read in a sentence: what is further down stands below it, by its probability.
fn shortened(mut list: Vec<String>, l: Language) -> Vec<String> {
    /// Names in a sentence.
    const MOST: usize = 5;
    if list.len() > MOST {
        let others = list.split_off(MOST - 1).len();
        list.push(say!("one of {others} others, listed below").in_language(l));
    }
    list
}
