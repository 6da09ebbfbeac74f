//! The verdict of a diagnosis in one sentence, and which names are in it.

use crate::diagnose::Diagnosis;
use crate::diagnose::evidence::{Alternative, Slot, State, Verdict};

use super::words::{chance, full_name, name, name_of_atom, orders};
use crate::language::Language;

/// The verdict in one sentence.
pub(super) fn verdict(diagnosis: &Diagnosis, language: Language) -> String {
    let slots = diagnosis.examination.slots.iter();
    let named = slots.filter(|slot| slot.state != State::Unexplained);
    let (open, told): (Vec<&Slot>, Vec<&Slot>) = named.partition(|slot| is_open(slot));
    let list = |slots: &[&Slot]| {
        let names = slots
            .iter()
            .map(|slot| slot_name(diagnosis, slot, language));
        names.collect::<Vec<_>>().join(language.pick("; ", "；"))
    };
    match diagnosis.examination.verdict {
        Verdict::None => language
            .pick(
                "Model and recording agree within what is claimed: nothing is left out that this recording can show.",
                "模型与记录在所声明的范围内一致：记录未显示模型有遗漏。",
            )
            .to_owned(),
        Verdict::Identified | Verdict::Ambiguous => {
            let (told, open) = (list(&told), list(&open));
            match (told.is_empty(), open.is_empty()) {
                (_, true) => language.pick(format!("The model leaves out: {told}."), format!("模型遗漏了：{told}。")),
                (true, false) => language.pick(
                    format!("The model leaves out something that this recording cannot tell apart: {open}."),
                    format!("模型有遗漏，但本记录无法区分：{open}。"),
                ),
                (false, false) => language.pick(
                    format!("The model leaves out: {told}; and something that this recording cannot tell apart: {open}."),
                    format!("模型遗漏了：{told}；另有遗漏，但本记录无法区分：{open}。"),
                ),
            }
        }
        Verdict::Partly | Verdict::Contested | Verdict::Unexplained => {
            let all: Vec<&Slot> = told.into_iter().chain(open).collect();
            incomplete(diagnosis, &list(&all), language)
        }
    }
}

/// Whether no explanation of a list is far likelier than the others.
fn is_open(slot: &Slot) -> bool {
    /// Probability of a first one that leads.
    const LEADS: f64 = 0.95;
    let first = slot.named.first();
    slot.state == State::Ambiguous && first.is_none_or(|first| first.probability < LEADS)
}

/// The verdict where not all has a certain name; `list` are those that are.
fn incomplete(diagnosis: &Diagnosis, list: &str, language: Language) -> String {
    let (semicolon, colon) = (language.pick("; ", "；"), language.pick(": ", "："));
    let tentative = tentatives(diagnosis, language).join(semicolon);
    let places = places(diagnosis, language).join(semicolon);
    let nameless = tentative.is_empty() || !places.is_empty();
    let contested = diagnosis.examination.verdict == Verdict::Contested;
    if list.is_empty()
        && tentative.is_empty()
        && let Some(named) = undecided(diagnosis, language)
    {
        return language.pick(
            format!(
                "Model and recording disagree, and it is not decided why: {places}, or {named}."
            ),
            format!("模型与记录不一致，原因未能判定：{places}，或 {named}。"),
        );
    }
    if list.is_empty() && tentative.is_empty() {
        let places = if places.is_empty() {
            places
        } else {
            colon.to_owned() + &places
        };
        return language.pick(
            format!(
                "Model and recording disagree, and nothing in the catalogue explains it{places}."
            ),
            format!("模型与记录不一致，且目录中没有可解释的原因{places}。"),
        );
    }
    if list.is_empty() {
        let besides = match places.is_empty() {
            true => String::new(),
            false => language.pick(
                format!(" Unexplained besides: {places}."),
                format!("此外未能解释：{places}。"),
            ),
        };
        return language.pick(
            format!(
                "Model and recording disagree. Tentatively, the model leaves out: {tentative}."
            ),
            format!("模型与记录不一致。模型可能（未确定）遗漏了：{tentative}。"),
        ) + &besides;
    }
    let mut sentence = match (contested && nameless, nameless) {
        (true, _) => language.pick(
            format!("The model leaves out: {list}; or else something unknown that varies smoothly, which explains the recording as well."),
            format!("模型遗漏了：{list}；但某种平滑变化的未知影响同样可以解释本记录。"),
        ),
        (false, true) => language.pick(
            format!("The model leaves out: {list}. Something without a name remains."),
            format!("模型遗漏了：{list}。此外还有无法命名的部分。"),
        ),
        (false, false) => {
            language.pick(format!("The model leaves out: {list}."), format!("模型遗漏了：{list}。"))
        }
    };
    if !tentative.is_empty() {
        sentence += &language.pick(
            format!(" Tentatively also: {tentative}."),
            format!("可能（未确定）还有：{tentative}。"),
        );
    }
    sentence
}

/// Whether an explanation without a name is likely enough to say a place.
pub(super) fn weighs(alternative: &Alternative) -> bool {
    const LEAST: f64 = 0.005;
    alternative.probability >= LEAST
}

/// The name of a slot that is not certain, but far likelier than everything without a name.
pub(super) fn tentative<'s>(diagnosis: &Diagnosis, slot: &'s Slot) -> Option<&'s Alternative> {
    /// What has no name is out of question below this …
    const UNLIKELY: f64 = 0.05;
    /// … and a name is tentative from here on.
    const LIKELY: f64 = 0.5;
    let unlikely = slot.generic.iter().all(|one| one.probability < UNLIKELY);
    let first = slot.named.first().filter(|one| one.probability > LIKELY);
    let first = first.filter(|one| !describes(diagnosis, one));
    first.filter(|_| slot.state == State::Unexplained && unlikely)
}

/// Whether a name only tells how the recording looks, which is no name beside something unexplained. A shift from
/// one level of a factor to another tells more: where to look.
fn describes(diagnosis: &Diagnosis, one: &Alternative) -> bool {
    diagnosis.cells[one.candidate].effect.only_describes()
}

/// Names that are tentative, over all slots.
fn tentatives(diagnosis: &Diagnosis, language: Language) -> Vec<String> {
    let slots = diagnosis.examination.slots.iter();
    let names = slots
        .filter_map(|slot| tentative(diagnosis, slot))
        .map(|one| told(diagnosis, one, language));
    distinct(names.collect())
}

/// The first name of the first slot, if it is not much less likely than what has no name.
fn undecided(diagnosis: &Diagnosis, language: Language) -> Option<String> {
    const LEAST: f64 = 0.2;
    let slot = diagnosis.examination.slots.first()?;
    let first = slot.named.first().filter(|one| one.probability >= LEAST);
    let first = first.filter(|one| !describes(diagnosis, one))?;
    let p = chance(first.probability);
    slot.generic.first()?;
    let name = told(diagnosis, first, language);
    Some(language.pick(format!("{name} ({p} %)"), format!("{name}（{p} %）")))
}

/// Where what is unexplained sits: what is likely enough; else, where no name is tentative either, the best
/// there is.
fn places(diagnosis: &Diagnosis, language: Language) -> Vec<String> {
    let slots = diagnosis.examination.slots.iter();
    let unexplained =
        slots.filter(|s| s.state == State::Unexplained && tentative(diagnosis, s).is_none());
    let found: Vec<&Alternative> = unexplained.filter_map(|s| s.generic.first()).collect();
    let likely = found.iter().copied().filter(|one| weighs(one));
    let mut likely: Vec<&Alternative> = likely.collect();
    if likely.is_empty() {
        likely = found;
    }
    let names = likely
        .iter()
        .map(|one| name(&diagnosis.cells[one.candidate], language));
    distinct(names.collect())
}

/// Each text once, in the order of their first places.
fn distinct(texts: Vec<String>) -> Vec<String> {
    let mut kept: Vec<String> = Vec::new();
    for text in texts {
        if !kept.contains(&text) {
            kept.push(text);
        }
    }
    kept
}

/// The names of a slot: joined by "or", unless one of them leads.
fn slot_name(diagnosis: &Diagnosis, slot: &Slot, language: Language) -> String {
    let names = slot_names(diagnosis, slot, language);
    match (names.as_slice(), slot.named.first()) {
        ([first, others @ ..], Some(leading)) if !others.is_empty() && !is_open(slot) => {
            let (first, p) = (first.as_str(), chance(leading.probability));
            let others = others.join(language.pick(", ", "、"));
            language.pick(
                format!("{first} ({p} %; not excluded: {others})"),
                format!("{first}（{p} %；不能排除：{others}）"),
            )
        }
        _ => language.either(&names),
    }
}

/// What a slot may be, most probable first.
pub(super) fn slot_names(diagnosis: &Diagnosis, slot: &Slot, language: Language) -> Vec<String> {
    let full = |one| told(diagnosis, one, language) + &orders(diagnosis, one, language);
    slot.named.iter().map(full).collect()
}

/// The name of an alternative in a sentence; of bad rows, jumps and the like with their place.
fn told(diagnosis: &Diagnosis, alternative: &Alternative, language: Language) -> String {
    let cell = &diagnosis.cells[alternative.candidate];
    let has_place = cell.effect.repeats || cell.effect.exact.is_some();
    match alternative.variants.first().filter(|_| has_place) {
        Some(variant) => name_of_atom(diagnosis, variant.atom, language),
        None => full_name(cell, language),
    }
}
