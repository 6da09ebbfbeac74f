//! A diagnosis as blocks: verdict, where, what, the improvement, what remains open.

use crate::figures::with_unit;
use crate::language::Language;
use crate::number::{NONE, aligned, significant};
use crate::phrase::{section, table};
use gumption_fault::say;
use gumption_format::document::{
    Block,
    ColumnKind::{Names as NamesColumn, Numbers},
};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::evidence::{Alternative, Likeness, Slot, State};
use gumption_lab::diagnose::{Diagnosis, Doubt};

use super::names::{Names, quantity};
use super::noise::{noise, quieter};
use super::statement::statement;
use super::words::{chance, p_found, probability, unsettled};
use super::{accounts, improvement, listed, open};

/// The whole report.
pub(super) fn blocks(case: &Case, diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    let mut blocks = vec![
        Block::Title(case.title.clone()),
        Block::Statement(vec![statement(diagnosis, l)]),
    ];
    let doubtful = diagnosis.unsettled.iter();
    blocks.extend(doubtful.map(|one| Block::Paragraph(unsettled(case, one, l))));
    blocks.push(Block::Fields(fields(case, diagnosis, l)));
    blocks.extend(located(diagnosis, l));
    blocks.extend(slots(case, diagnosis, l));
    blocks.extend(if_independent(case, diagnosis, l));
    blocks.extend(improvement::blocks(case, diagnosis, l));
    blocks.extend(improvement::parameters(diagnosis, l));
    blocks.extend(open::lines(diagnosis, l));
    blocks.extend(open::rivals(diagnosis, l));
    blocks.extend(accounts::blocks(case, diagnosis, l));
    blocks.push(Block::Footer(vec![footer(case, diagnosis, l)]));
    blocks
}

fn fields(case: &Case, diagnosis: &Diagnosis, l: Language) -> Vec<(String, String)> {
    let rows = diagnosis.blocks.iter().map(Vec::len).sum::<usize>();
    let taken = match case.rows {
        all if all == rows => say!("{rows} rows").in_language(l),
        all => say!("{rows} of {all} rows").in_language(l),
    };
    let recorded = match diagnosis.blocks.len() {
        means if means == rows => taken,
        means => say!("{taken}, in {means} means").in_language(l),
    };
    let left_out = match case.left_out {
        0 => String::new(),
        n => say!("; {n} rows without a value are left out").in_language(l),
    };
    let alarm = diagnosis.examination.levels.first();
    let p = alarm.map_or(NONE.to_owned(), |level| p_found(level.p, level.draws));
    let (count, alpha) = (diagnosis.cells.len(), significant(case.settings.alpha, 2));
    let test =
        say!("{p} over all {count} explanations together (alarm below {alpha})").in_language(l);
    let held_out = listed::told(case, diagnosis, l);
    let held_out = held_out.map(|told| (l.pick("Held out", "留出记录").to_owned(), told));
    let mut fields = vec![
        (
            l.pick("Declared model", "声明的模型").into(),
            case.model_lines().join("; "),
        ),
        (
            l.pick("Recording", "记录").into(),
            recorded + &left_out + &as_differences(case, l),
        ),
        (
            l.pick("Noise", "噪声").into(),
            noise(case, &diagnosis.noise, l) + &quieter(diagnosis, l),
        ),
        (l.pick("Test for a mismatch", "不一致检验").into(), test),
    ];
    fields.extend(held_out);
    fields
}

/// Columns whose temperatures count from 0 °C.
fn as_differences(case: &Case, l: Language) -> String {
    let names = case.columns.iter().filter(|column| column.as_difference);
    let names: Vec<&str> = names.map(|column| column.name.as_str()).collect();
    if names.is_empty() {
        return String::new();
    }
    let names = names.join(l.list_comma());
    say!("; {names} as differences from 0 of the scale").in_language(l)
}

fn located(diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    /// More are in the JSON.
    const PLACES: usize = 5;
    let mut table = table(
        l,
        [
            ("quantity", "量", NamesColumn),
            ("where", "位置", NamesColumn),
            ("disturbance", "扰动", Numbers),
            ("u", "u", Numbers),
            ("Δχ²", "Δχ²", Numbers),
            ("p", "p", Numbers),
        ],
    );
    for (cell, located) in diagnosis.conspicuous().take(PLACES) {
        table.push(vec![
            quantity(&cell.node, l).into(),
            say!("{} {}", cell.factor, cell.level).in_language(l).into(),
            aligned(located.size, located.u, 2).into(),
            significant(located.u, 2).into(),
            significant(located.chi_squared, 3).into(),
            probability(located.p).into(),
        ]);
    }
    if table.rows.is_empty() {
        return Vec::new();
    }
    vec![
        section(l, "Where the mismatch sits", "不一致所在"),
        Block::Table(table),
    ]
}

fn slots(case: &Case, diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    let slots = &diagnosis.examination.slots;
    if slots.is_empty() {
        return Vec::new();
    }
    let names = Names::of_diagnosis(diagnosis, l);
    let mut blocks = vec![section(l, "What was left out", "遗漏的物理效应")];
    let mut before = None;
    for slot in slots {
        let introduction = diagnosis
            .doubt(slot)
            .map(|doubt| introduction(&doubt, names));
        if introduction != before {
            blocks.extend(introduction.clone().map(Block::Paragraph));
            before = introduction;
        }
        blocks.extend(named(case, diagnosis, slot, names));
    }
    blocks
}

/// What stands in place of noise that wanders if rows are independent.
fn if_independent(case: &Case, diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    let Some(found) = &diagnosis.if_independent else {
        return Vec::new();
    };
    let names = Names::of_diagnosis(diagnosis, l);
    let mut blocks = vec![
        section(
            l,
            "What it is if successive rows are independent",
            "若相邻各行相互独立，则为何者",
        ),
        match diagnosis.noise.is_of_scale() {
            true => Block::Paragraph(say!("This recording does not tell it from a scale that wanders. The same settings again in another order would, or a recording of one large input that is held still, which shows whether the scale wanders.").in_language(l)),
            false => Block::Paragraph(say!("This recording does not tell it from noise that wanders. The same settings again in another order would, or a recording at rest below [noise] at_rest, which shows whether the noise wanders.").in_language(l)),
        },
    ];
    for slot in &found.examination.slots {
        for alternative in &slot.named {
            let title = headline(diagnosis, alternative, slot, names);
            blocks.push(Block::Paragraph(title));
            let formula = names.formula(case, diagnosis, alternative);
            blocks.push(Block::Formula(vec![formula]));
        }
    }
    blocks
}

/// What is to be said before the names of a slot that is not explained.
fn introduction(doubt: &Doubt<'_>, names: Names<'_>) -> String {
    let l = names.l;
    let (places, resembles) = match doubt {
        Doubt::Nothing => {
            return say!("Something remains that has neither a name nor a place.").in_language(l);
        }
        Doubt::Uncertain => {
            return say!(
                "Named, but not with certainty: the name may be the shape of another effect."
            )
            .in_language(l);
        }
        Doubt::At { places, resembles } => (places, *resembles),
    };
    let places = places.iter().map(|one| {
        let (name, p) = (names.plain(one.candidate), chance(one.probability));
        // What a test of the noise shows has no rivals that share a probability with it.
        match one.variants.is_empty() {
            true => name,
            false => l.with_aside(&name, &format!("{p} %")),
        }
    });
    let places = places.collect::<Vec<_>>().join(l.semicolon());
    let tentative = match resembles {
        true => l.pick(" Tentative names:", "仅供参考的名称："),
        false => "",
    };
    say!("Unexplained: {places}.{tentative}").in_language(l)
}

fn named(case: &Case, diagnosis: &Diagnosis, slot: &Slot, names: Names<'_>) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut said: Vec<String> = Vec::new();
    for alternative in slot.told() {
        blocks.push(Block::Paragraph(headline(
            diagnosis,
            alternative,
            slot,
            names,
        )));
        if !slot.is_explained() {
            continue;
        }
        let prose = names.prose(alternative.candidate);
        if !said.contains(&prose) {
            blocks.push(Block::Paragraph(prose.clone()));
            said.push(prose);
        }
        if slot.state == State::Like {
            let text = only_like(diagnosis.likeness(slot), names.l);
            blocks.push(Block::Paragraph(text));
        }
        let lines = [names.formula(case, diagnosis, alternative)].into_iter();
        let lines = lines.chain(multiplied(diagnosis, alternative, names.l));
        let lines = lines.chain(amplitude(case, diagnosis, alternative, names.l));
        blocks.push(Block::Formula(lines.collect()));
    }
    blocks.extend(unlisted(slot, names).map(Block::Paragraph));
    blocks
}

/// What no catalogue lists, in place of names that hold.
fn unlisted(slot: &Slot, names: Names<'_>) -> Option<String> {
    let share = slot.doubted()?;
    let (p, place) = (chance(share), names.plain(slot.generic.first()?.candidate));
    Some(match share > 0.5 {
        true => say!("A form that no catalogue lists is likelier ({p} %): {place}.")
            .in_language(names.l),
        false => say!("A form that no catalogue lists is not excluded either ({p} %): {place}.")
            .in_language(names.l),
    })
}

/// Why a name says no more than what the effect acts like.
fn only_like(likeness: Likeness, l: Language) -> String {
    match likeness {
        Likeness::Weak => say!("Nothing else in the catalogue acts like this. Something unlisted of similar shape would look the same at this strength.").in_language(l),
        Likeness::Open => say!("Something without a name is left beside it, and may have a part of what it explains.").in_language(l),
        Likeness::Piece => say!("Together with the other effects it may be a piece of one course that the catalogue does not have.").in_language(l),
        Likeness::Form => say!("Nothing else in the catalogue acts like this. The recording departs a little from the form given here: more than noise does, less than would make it another effect.").in_language(l),
        Likeness::Uneven => say!("Nothing else in the catalogue acts like this, but parts of the recording differ in its size by more than noise does: it changed, or its form is another one.").in_language(l),
        Likeness::Absent => say!("Nothing else in the catalogue acts like this in the recording, but the recording held out is predicted no better with it than by the declared model.").in_language(l),
    }
}

/// What the sizes of the best variant multiply, as it was fitted; nothing where there are too many terms to
/// read, none has a formula, or the size stands alone.
fn multiplied(diagnosis: &Diagnosis, alternative: &Alternative, l: Language) -> Option<String> {
    /// More are in the table of the improved model.
    const MOST: usize = 3;
    let terms = diagnosis.terms(alternative).into_iter();
    let mut texts: Vec<&str> = terms.map(|term| term.written().text.as_str()).collect();
    texts.dedup();
    let readable = texts.len() <= MOST && texts.iter().all(|text| !text.is_empty() && *text != "1");
    let terms = texts.join("; ");
    (readable && !texts.is_empty()).then(|| say!("β multiplies {terms}").in_language(l))
}

fn amplitude(
    case: &Case,
    diagnosis: &Diagnosis,
    alternative: &Alternative,
    l: Language,
) -> Option<String> {
    let size = diagnosis.amplitude(case, alternative)?;
    let (value, u) = (aligned(size.value, size.u, 2), significant(size.u, 2));
    let text = with_unit(&format!("{value} ± {u}"), &size.unit);
    Some(say!("amplitude {text}").in_language(l))
}

/// Name, probability, size, strength of one alternative.
fn headline(
    diagnosis: &Diagnosis,
    alternative: &Alternative,
    slot: &Slot,
    names: Names<'_>,
) -> String {
    let l = names.l;
    let title = match alternative.variants.first() {
        Some(variant) => names.variant(diagnosis.atoms[variant.atom]),
        None => names.plain(alternative.candidate),
    } + &names.open(diagnosis, alternative);
    let rival = alternative.nearest.as_ref().map_or(String::new(), |rival| {
        let (other, kappa) = (names.plain(rival.candidate), significant(rival.kappa, 2));
        say!("; nearest rival {other}, κ = {kappa}").in_language(l)
    });
    let lambda = significant(alternative.lambda, 2);
    let probability = match slot.named.as_slice() {
        [only] if only.is_sure() => String::new(),
        _ => {
            let p = chance(alternative.probability);
            let p = match alternative.jointly {
                true => say!("{p} % together with others of the list").in_language(l),
                false => format!("{p} %"),
            };
            format!("{p}{}", l.comma())
        }
    };
    say!("▸ {title}: {probability}strength λ = {lambda}{rival}").in_language(l)
}

fn footer(case: &Case, diagnosis: &Diagnosis, l: Language) -> String {
    let alarm = diagnosis.examination.levels.first();
    let draws = alarm.map_or(0, |level| level.draws);
    let (version, seed) = (env!("CARGO_PKG_VERSION"), case.settings.seed);
    say!("gumption {version}, seed {seed}, {draws} simulated recordings.").in_language(l)
}
