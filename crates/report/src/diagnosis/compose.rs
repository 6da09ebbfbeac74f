//! A diagnosis as blocks: verdict, where, what, the improvement, what remains open.

use crate::diagnose::Diagnosis;
use crate::diagnose::case::Case;
use crate::diagnose::evidence::{Alternative, Slot, State};

use crate::document::Block;
use crate::document::{ColumnKind, Table};
use crate::language::Language;
use crate::number::{NONE, aligned, significant};

use super::labels::spoken;
use super::statement::{tentative, verdict, weighs};
use super::words::{
    amplitude, chance, fitted, formula, name, name_of_atom, noise, orders, p_found, probability,
    prose, quantity, unsettled as unsettled_fit,
};
use super::{improvement, open};

/// Cells of the scan that are shown.
const PLACES: usize = 5;

/// The whole report.
pub(super) fn blocks(case: &Case, diagnosis: &Diagnosis, language: Language) -> Vec<Block> {
    let mut blocks = vec![
        Block::Title(case.title.clone()),
        Block::Statement(vec![verdict(diagnosis, language)]),
    ];
    let unsettled = diagnosis.unsettled.iter();
    blocks.extend(unsettled.map(|one| Block::Paragraph(unsettled_fit(case, one, language))));
    blocks.push(Block::Fields(fields(case, diagnosis, language)));
    blocks.extend(located(diagnosis, language));
    blocks.extend(slots(case, diagnosis, language));
    blocks.extend(improvement::blocks(case, diagnosis, language));
    blocks.extend(improvement::parameters(diagnosis, language));
    blocks.extend(open::lines(diagnosis, language));
    blocks.extend(open::rivals(diagnosis, language));
    blocks.push(Block::Footer(vec![footer(case, diagnosis, language)]));
    blocks
}

fn fields(case: &Case, diagnosis: &Diagnosis, language: Language) -> Vec<(String, String)> {
    let rows = diagnosis.blocks.iter().map(Vec::len).sum::<usize>();
    let recorded = if rows == diagnosis.blocks.len() {
        language.pick(format!("{rows} rows"), format!("{rows} 行"))
    } else {
        let means = diagnosis.blocks.len();
        language.pick(
            format!("{rows} rows, in {means} means"),
            format!("{rows} 行，取 {means} 个平均值"),
        )
    };
    let left_out = match case.left_out {
        0 => String::new(),
        n => language.pick(
            format!("; {n} rows without a value are left out"),
            format!("；略去 {n} 行缺值"),
        ),
    };
    let differences = as_differences(case, language);
    let alarm = diagnosis.examination.levels.first();
    let p = alarm.map_or(NONE.to_owned(), |level| p_found(level.p, level.draws));
    vec![
        (
            language.pick("Declared model", "声明的模型").into(),
            case.model.join("; "),
        ),
        (
            language.pick("Recording", "记录").into(),
            recorded + &left_out + &differences,
        ),
        (
            language.pick("Noise", "噪声").into(),
            noise(&diagnosis.noise, language),
        ),
        (
            language.pick("Test for a mismatch", "不一致检验").into(),
            language.pick(
                format!(
                    "{p} over all {} explanations together (alarm below {})",
                    diagnosis.cells.len(),
                    significant(case.settings.alpha, 2)
                ),
                format!(
                    "{p}（同时考虑全部 {} 种解释；低于 {} 报警）",
                    diagnosis.cells.len(),
                    significant(case.settings.alpha, 2)
                ),
            ),
        ),
    ]
}

/// Columns whose temperatures count from 0 °C.
fn as_differences(case: &Case, language: Language) -> String {
    let names = case.columns.iter().filter(|column| column.as_difference);
    let names: Vec<&str> = names.map(|column| column.name.as_str()).collect();
    if names.is_empty() {
        return String::new();
    }
    let names = names.join(language.pick(", ", "、"));
    language.pick(
        format!("; {names} count from 0 of their scale"),
        format!("；{names} 以其温标零点为起点"),
    )
}

fn located(diagnosis: &Diagnosis, language: Language) -> Vec<Block> {
    let shown: Vec<_> = diagnosis
        .located
        .iter()
        .filter(|(_, located)| located.p < 0.05)
        .take(PLACES)
        .collect();
    if shown.is_empty() {
        return Vec::new();
    }
    let mut table = Table::new([
        (language.pick("quantity", "量"), ColumnKind::Names),
        (language.pick("where", "位置"), ColumnKind::Names),
        (language.pick("disturbance", "扰动"), ColumnKind::Numbers),
        ("u", ColumnKind::Numbers),
        ("Δχ²", ColumnKind::Numbers),
        ("p", ColumnKind::Numbers),
    ]);
    for (cell, located) in shown {
        table.push(vec![
            quantity(&cell.node, language).into(),
            format!(
                "{} {}",
                spoken(&cell.factor, language),
                spoken(&cell.level, language)
            )
            .into(),
            aligned(located.size, located.u, 2).into(),
            significant(located.u, 2).into(),
            significant(located.chi_squared, 3).into(),
            probability(located.p).into(),
        ]);
    }
    vec![
        Block::Section(
            language
                .pick("Where the mismatch sits", "不一致所在")
                .into(),
        ),
        Block::Table(table),
    ]
}

fn slots(case: &Case, diagnosis: &Diagnosis, language: Language) -> Vec<Block> {
    let slots = &diagnosis.examination.slots;
    if slots.is_empty() {
        return Vec::new();
    }
    let mut blocks = vec![Block::Section(
        language.pick("What was left out", "遗漏的物理效应").into(),
    )];
    let mut before = None;
    for slot in slots {
        let introduction = introduction(diagnosis, slot, language);
        if introduction != before {
            blocks.extend(introduction.clone().map(Block::Paragraph));
            before = introduction;
        }
        blocks.extend(names(case, diagnosis, slot, language));
    }
    blocks
}

/// What is to be said before the names of a slot that is not explained.
fn introduction(diagnosis: &Diagnosis, slot: &Slot, language: Language) -> Option<String> {
    if slot.state != State::Unexplained {
        return None;
    }
    let places = slot.generic.iter().filter(|one| weighs(one)).map(|a| {
        let name = name(&diagnosis.cells[a.candidate], language);
        let p = chance(a.probability);
        language.pick(format!("{name} ({p} %)"), format!("{name}（{p} %）"))
    });
    let places: Vec<String> = places.collect();
    let has_names = slot.named.iter().any(weighs);
    let text = match (places.is_empty(), has_names) {
        (true, false) => language.pick(
            "Something remains that has neither a name nor a place.",
            "还有既无名称也无法定位的部分。",
        ),
        (true, true) => certain_not(language),
        (false, _) if tentative(diagnosis, slot).is_some() => certain_not(language),
        (false, true) => &language.pick(
            format!("Unexplained: {}. Tentative names:", places.join("; ")),
            format!("未能解释：{}。仅供参考的名称：", places.join("；")),
        ),
        (false, false) => &language.pick(
            format!("Unexplained: {}.", places.join("; ")),
            format!("未能解释：{}。", places.join("；")),
        ),
    };
    Some(text.to_owned())
}

fn certain_not(language: Language) -> &'static str {
    language.pick(
        "Named, but not with certainty: the name may be the shape of another effect.",
        "有名称但不确定：它可能只是另一影响的形态。",
    )
}

fn names(case: &Case, diagnosis: &Diagnosis, slot: &Slot, language: Language) -> Vec<Block> {
    let explained = slot.state != State::Unexplained;
    let mut blocks = Vec::new();
    let mut said: Vec<String> = Vec::new();
    for alternative in slot.named.iter().filter(|one| explained || weighs(one)) {
        blocks.push(Block::Paragraph(headline(
            diagnosis,
            alternative,
            slot,
            language,
        )));
        let cell = &diagnosis.cells[alternative.candidate];
        if explained {
            let prose = match &cell.description {
                Some(own) => own.clone(),
                None => prose(cell, language),
            };
            if !said.contains(&prose) {
                blocks.push(Block::Paragraph(prose.clone()));
                said.push(prose);
            }
            let multiplied = fitted(diagnosis, alternative).map(|terms| {
                language.pick(format!("β multiplies {terms}"), format!("β 乘以 {terms}"))
            });
            let lines = [formula(diagnosis, alternative, language)].into_iter();
            let amplitude = amplitude(case, diagnosis, alternative, language);
            let lines = lines.chain(multiplied).chain(amplitude);
            blocks.push(Block::Formula(lines.collect()));
        }
    }
    blocks
}

/// Name, probability, size, strength of one alternative.
fn headline(
    diagnosis: &Diagnosis,
    alternative: &Alternative,
    slot: &Slot,
    language: Language,
) -> String {
    let title = match alternative.variants.first() {
        Some(variant) => name_of_atom(diagnosis, variant.atom, language),
        None => name(&diagnosis.cells[alternative.candidate], language),
    } + &orders(diagnosis, alternative, language);
    let posterior = chance(alternative.probability);
    let separate = match &alternative.nearest {
        Some(rival) => {
            let other = name(&diagnosis.cells[rival.candidate], language);
            let kappa = significant(rival.kappa, 2);
            language.pick(
                format!("; nearest rival {other}, κ = {kappa}"),
                format!("；最接近的竞争解释：{other}，κ = {kappa}"),
            )
        }
        None => String::new(),
    };
    let lambda = significant(alternative.lambda, 2);
    let only = slot.named.len() == 1;
    let probability = if only && alternative.probability > 0.999 {
        String::new()
    } else {
        format!("{posterior} %{}", language.pick(", ", "，"))
    };
    language.pick(
        format!("▸ {title}: {probability}strength λ = {lambda}{separate}"),
        format!("▸ {title}：{probability}强度 λ = {lambda}{separate}"),
    )
}

fn footer(case: &Case, diagnosis: &Diagnosis, language: Language) -> String {
    let draws = diagnosis
        .examination
        .levels
        .first()
        .map_or(0, |level| level.draws);
    language.pick(
        format!(
            "gumption {}, seed {}, {draws} simulated recordings.",
            env!("CARGO_PKG_VERSION"),
            case.settings.seed
        ),
        format!(
            "gumption {}，随机种子 {}，模拟记录 {draws} 次。",
            env!("CARGO_PKG_VERSION"),
            case.settings.seed
        ),
    )
}
