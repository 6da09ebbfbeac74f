//! Sentences and names of a diagnosis.

use std::collections::BTreeMap;

use crate::diagnose::case::Case;
use crate::diagnose::catalogue::{Cell, Text, Variation, Words};
use crate::diagnose::evidence::{Alternative, Refusal, Slot, State, Verdict};
use crate::diagnose::{Claimed, Diagnosis, Failure, Measure, NoFit, Origin};

use super::labels::{formula_in, spoken};
use crate::report::language::Language;
use crate::report::number::{freedom, percent, significant};

impl Language {
    /// The text of this language.
    pub(super) fn of(self, text: &Text) -> &str {
        self.pick(&text.en, &text.zh)
    }
}

/// The name of a candidate with its columns in it.
pub(super) fn name(cell: &Cell, language: Language) -> String {
    words(cell, language).fill(language.of(&cell.effect.name))
}

/// What an effect is, with the columns of the case.
pub(super) fn prose(cell: &Cell, language: Language) -> String {
    words(cell, language).fill(language.of(&cell.effect.prose))
}

/// What the texts of a cell speak of, in a language: offset, scale and signal have words, columns and
/// parameters keep their names.
fn words(cell: &Cell, language: Language) -> Words {
    let mut words = cell.words.clone();
    words.p = quantity(&words.p, language).to_owned();
    if let Some(of) = words.x.strip_prefix("signal(") {
        words.x = language.pick(format!("signal({of}"), format!("信号({of}"));
    }
    words
}

/// What distinguishes a variant; numbers without a unit stand alone.
pub(super) fn label(variation: &Variation, language: Language) -> String {
    let label = variation.label.as_str();
    spoken(label.strip_suffix(" 1").unwrap_or(label), language)
}

/// A quantity of the model in a language: offset and scale have words, others their names.
pub(super) fn quantity(node: &str, language: Language) -> &str {
    match node {
        "offset" => language.pick("offset", "零位"),
        "scale" => language.pick("scale", "标度"),
        other => other,
    }
}

/// The name, and what distinguishes a cell whose only variant has a label: the harmonic of an angle.
pub(super) fn full_name(cell: &Cell, language: Language) -> String {
    let name = name(cell, language);
    match cell.variants.as_slice() {
        [only] if !only.label.is_empty() => format!("{name} ({})", label(only, language)),
        _ => name,
    }
}

/// The name, and what distinguishes the variant.
pub(super) fn name_of_atom(diagnosis: &Diagnosis, atom: usize, language: Language) -> String {
    let (cell, variation) = diagnosis.atoms[atom];
    let cell = &diagnosis.cells[cell];
    let name = name(cell, language);
    match label(&cell.variants[variation], language) {
        label if label.is_empty() => name,
        label => format!("{name} ({label})"),
    }
}

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
    let id = diagnosis.cells[one.candidate].effect.id.as_str();
    matches!(id, "outlier" | "step" | "step-scale" | "wave")
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
    let p = percent(first.probability);
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
            let (first, p) = (first.as_str(), percent(leading.probability));
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

/// That the order of a cause is open, where it is: what else than the name may hold.
pub(super) fn orders(
    diagnosis: &Diagnosis,
    alternative: &Alternative,
    language: Language,
) -> String {
    /// Orders of less than this share are out of the question.
    const SHARE: f64 = 0.01;
    let mut shares: BTreeMap<usize, f64> = BTreeMap::new();
    for variant in &alternative.variants {
        *shares.entry(diagnosis.atoms[variant.atom].0).or_default() += variant.share;
    }
    shares.remove(&alternative.candidate);
    let others = shares.into_iter().filter(|(_, share)| *share >= SHARE);
    let others: Vec<String> = others
        .map(|(cell, share)| {
            let name = name(&diagnosis.cells[cell], language);
            format!("{name} {} %", percent(share))
        })
        .collect();
    if others.is_empty() {
        return String::new();
    }
    let others = others.join(language.pick(", ", "，"));
    language.pick(
        format!(" (its order is open: {others})"),
        format!("（阶次未定：{others}）"),
    )
}

/// The formula of an explanation, without the lag where its best variant has none.
pub(super) fn formula(
    diagnosis: &Diagnosis,
    alternative: &Alternative,
    language: Language,
) -> String {
    let cell = &diagnosis.cells[alternative.candidate];
    let fill = |text: &str| words(cell, language).fill(&formula_in(text, language));
    let lags = alternative.variants.first().is_none_or(|variant| {
        let (cell, variation) = diagnosis.atoms[variant.atom];
        let cell = &diagnosis.cells[cell];
        let mut terms = cell.variants[variation].terms.iter();
        terms.any(|term| term.modifier.text.contains("lag("))
    });
    let general = &cell.effect.formula;
    match general.split_once("lag(") {
        Some((before, rest)) if !lags => match rest.split_once(", τ)") {
            Some((within, after)) => fill(&format!("{before}({within}){after}")),
            None => fill(general),
        },
        _ => fill(general),
    }
}

/// What the sizes of the best variant multiply, as it was fitted; nothing where there are too many terms to
/// read, none has a formula, or the size stands alone.
pub(super) fn fitted(diagnosis: &Diagnosis, alternative: &Alternative) -> Option<String> {
    /// More are in the table of the improved model.
    const MOST: usize = 3;
    let (cell, variation) = diagnosis.atoms[alternative.variants.first()?.atom];
    let terms = &diagnosis.cells[cell].variants[variation].terms;
    let texts = terms.iter().filter(|term| !term.tied);
    let mut texts: Vec<&str> = texts.map(|term| term.written().text.as_str()).collect();
    texts.dedup();
    let readable = texts.len() <= MOST && texts.iter().all(|text| !text.is_empty() && *text != "1");
    (readable && !texts.is_empty()).then(|| texts.join("; "))
}

/// Where the noise comes from.
pub(super) fn noise(claimed: &Claimed, language: Language) -> String {
    let dof = if claimed.dof.is_finite() && claimed.dof > 0.0 {
        format!(", ν = {}", freedom(claimed.dof))
    } else {
        String::new()
    };
    let text = match &claimed.origin {
        Origin::Estimated => {
            language
                .pick("estimated from the residuals", "由残差估计")
                .to_owned()
                + &growth(claimed, language)
        }
        Origin::Case => language.pick(
            "as stated in the case".to_owned(),
            "由案例文件给出".to_owned(),
        ),
        Origin::Column(name) => {
            language.pick(format!("from the column {name}"), format!("取自 {name} 列"))
        }
        Origin::Replicates => {
            language
                .pick("from replicates", "由重复测量得到")
                .to_owned()
                + &growth(claimed, language)
        }
        Origin::AtRest(file) => language.pick(
            format!("from the recording at rest {file}"),
            format!("取自静态记录 {file}"),
        ),
        Origin::Budget(file) => language.pick(
            format!("from the budget {file}"),
            format!("取自不确定度评定文件 {file}"),
        ),
    };
    text + &dof + &uneven(claimed, language)
}

/// That replicates scatter otherwise than the claim says.
fn uneven(claimed: &Claimed, language: Language) -> String {
    let Some(p) = claimed.uneven else {
        return String::new();
    };
    let p = p_is(p);
    language.pick(
        format!("; replicates scatter unevenly from group to group (Bartlett's test, {p}): this noise does not describe them, state u for each row"),
        format!("；各组重复测量的分散性不一致（Bartlett 检验，{p}）：上述模型不能描述，请逐行给出 u"),
    )
}

/// A further measurement as a phrase.
pub(super) fn measure(measure: &Measure, language: Language) -> String {
    match measure {
        Measure::Own(name) => name.clone(),
        Measure::Again => language
            .pick("the same once more", "原样重复一次")
            .to_owned(),
        Measure::Reversed => language
            .pick(
                "the same once more, in reversed order",
                "按相反顺序重复一次",
            )
            .to_owned(),
        Measure::Set {
            column,
            value,
            unit,
        } => {
            // Five digits, and not more of them than there are.
            let value: f64 = format!("{value:.4e}").parse().unwrap_or(*value);
            let value = format!("{value} {unit}");
            let value = value.trim_end();
            language.pick(
                format!("the same once more with {column} at {value}"),
                format!("将 {column} 设为 {value} 后重复一次"),
            )
        }
        Measure::Between { column } => language.pick(
            format!("the same once more with {column} half way between its values"),
            format!("将 {column} 取在原有各值的中间后重复一次"),
        ),
        Measure::Opposite { column } => language.pick(
            format!("the same once more while {column} varies twice as much in the opposite sense"),
            format!("使 {column} 反向并以两倍幅度变化时重复一次"),
        ),
        Measure::Exchanged { column } => language.pick(
            format!("the same once more with each {column} in the place of the next"),
            format!("将各 {column} 依次互换后重复一次"),
        ),
    }
}

/// How noise that was estimated, or that replicates show, grows with the reading, if it does for any response.
fn growth(claimed: &Claimed, language: Language) -> String {
    let grows: Vec<String> = claimed
        .growth
        .iter()
        .flatten()
        .map(|growth| {
            let constant = significant(growth.constant, 2);
            let proportional = significant(100.0 * growth.proportional, 2);
            match growth.unit.as_str() {
                "" | "1" => format!("u² = {constant}² + ({proportional} % · y)²"),
                unit => format!("u² = ({constant} {unit})² + ({proportional} % · y)²"),
            }
        })
        .collect();
    if grows.is_empty() {
        return String::new();
    }
    language
        .pick(", growing with the reading: ", "，随示值增大：")
        .to_owned()
        + &grows.join("; ")
}

/// A probability as an equation or inequality.
pub(super) fn p_is(p: f64) -> String {
    if p < 0.001 {
        "p < 0.001".to_owned()
    } else {
        format!("p = {}", significant(p, 2))
    }
}

/// A probability found from so many simulated recordings: the least that they can show is a bound.
pub(super) fn p_found(p: f64, draws: usize) -> String {
    let least = 1.0 / (draws + 1) as f64;
    if p > least {
        p_is(p)
    } else {
        p_is(p).replace("p = ", "p ≤ ")
    }
}

/// Probability of a false alarm in a table.
pub(super) fn probability(p: f64) -> String {
    if p < 0.001 {
        "<0.001".to_owned()
    } else {
        significant(p, 2)
    }
}

/// Why a case could not be diagnosed.
pub fn failure(case: &Case, failure: &Failure, language: Language) -> String {
    match failure {
        Failure::Fit(NoFit::NoStart) => language.pick(
            "the model has no finite value where the search for its parameters begins; state starts: [parameter] NAME = { start = … }".to_owned(),
            "模型在搜索起点处没有有限值；请给出起始值：[parameter] 名称 = { start = … }".to_owned(),
        ),
        Failure::Fit(NoFit::NoMinimum) => language.pick(
            "the search for the parameters found no minimum; state starts nearer to the truth: [parameter] NAME = { start = … }".to_owned(),
            "未找到参数的极小值；请给出更接近的起始值：[parameter] 名称 = { start = … }".to_owned(),
        ),
        Failure::Fit(NoFit::Undetermined(name)) => language.pick(
            format!("the recording does not determine the parameter {name}: other parameters do the same to every row. Remove it, make it a [constant], or state what is known of it: value and u"),
            format!("记录不能确定参数 {name}：其他参数对每一行的作用与之相同。请删除它、改为 [constant]，或给出先验 value 和 u"),
        ),
        Failure::Fit(NoFit::TooFew { observations, unknowns }) => language.pick(
            format!("{observations} observations leave nothing to examine beside {unknowns} unknown parameters"),
            format!("{observations} 个观测值减去 {unknowns} 个未知参数后没有剩余可供检验"),
        ),
        Failure::Refused(Refusal::Dependent { parameter }) => {
            let name = case.parameters.get(*parameter).map_or("", |p| p.name.as_str());
            language.pick(format!("the recording does not determine the parameter {name}"), format!("记录不能确定参数 {name}"))
        }
        Failure::Refused(Refusal::Cancelled) => language.pick("stopped".to_owned(), "已中断".to_owned()),
        Failure::Refused(other) => other.to_string(),
    }
}
