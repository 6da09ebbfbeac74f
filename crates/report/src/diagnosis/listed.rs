//! What a recording held out says of explanations that the recording cannot tell apart.

use gumption_fault::say;
use gumption_format::document::{
    Block,
    ColumnKind::{Numbers, Wrapped},
};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::{Diagnosis, HeldOutQuality, Listed};

use super::names::Names;
use super::words::{below_p, p_is};
use crate::language::Language;
use crate::number::significant;
use crate::phrase::table;

/// Which explanations it speaks for, where it does.
pub(super) fn told(case: &Case, diagnosis: &Diagnosis, l: Language) -> Option<String> {
    let held = diagnosis.held_out.as_ref()?;
    let names = Names::of_diagnosis(diagnosis, l);
    let lists = held.listed.chunk_by(|a, b| a.slot == b.slot);
    let alone = lists.filter_map(|list| held.speaks_for(list[0].slot, case.settings.alpha));
    let alone: Vec<String> = alone.map(|candidate| names.plain(candidate)).collect();
    let (file, list) = (&held.file, alone.join(l.semicolon()));
    let told = say!("{file} is predicted within the noise only by: {list}");
    (!alone.is_empty()).then(|| told.in_language(l))
}

/// How each explanation of a list predicts the recording.
pub(super) fn blocks(diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    let Some(held) = diagnosis.held_out.as_ref() else {
        return Vec::new();
    };
    let names = Names::of_diagnosis(diagnosis, l);
    let lists = held.listed.chunk_by(|a, b| a.slot == b.slot);
    lists.flat_map(|list| of_list(held, list, names)).collect()
}

fn of_list(held: &HeldOutQuality, list: &[Listed], names: Names<'_>) -> Vec<Block> {
    let (l, file) = (names.l, &held.file);
    let mut table = table(
        l,
        [
            ("explanation", "解释", Wrapped),
            ("χ²/n", "χ²/n", Numbers),
            ("p", "p", Numbers),
        ],
    );
    for one in list {
        let prediction = one.prediction.as_ref();
        let reduced = prediction.map(|found| found.chi_squared / held.observations as f64);
        let p = prediction.and_then(|found| found.p);
        table.push(vec![
            names.plain(one.candidate).into(),
            reduced.map_or("–".to_owned(), |x| significant(x, 3)).into(),
            p.map_or(String::new(), |p| below_p(&p_is(p))).into(),
        ]);
    }
    let before = say!("{file}, predicted by each explanation of the list as it was fitted:");
    vec![
        Block::Paragraph(before.in_language(l)),
        Block::Table(table.without_empty_columns()),
    ]
}
