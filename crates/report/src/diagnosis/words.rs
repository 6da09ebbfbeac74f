//! Names and phrases of a diagnosis.

use std::collections::BTreeMap;

use crate::diagnose::case::{Case, NoiseClaim};
use crate::diagnose::catalogue::{Cell, Term, Variation, Words};
use crate::diagnose::evidence::{Alternative, Refusal};
use crate::diagnose::{
    Claimed, Diagnosis, Estimated, Failure, Measure, ModelVersion, NoFit, Origin, Trouble,
    Unsettled,
};

use super::labels::{formula_in, spoken};
use crate::language::Language;
use crate::number::{aligned, freedom, percent, significant};

/// The name of a candidate with its columns in it.
pub(super) fn name(cell: &Cell, language: Language) -> String {
    words(cell, language).fill(cell.effect.name.of(language))
}

/// What an effect is, with the columns of the case.
pub(super) fn prose(cell: &Cell, language: Language) -> String {
    words(cell, language).fill(cell.effect.prose.of(language))
}

/// What the texts of a cell speak of, in a language: offset, scale and signal have words, columns and
/// parameters keep their names.
fn words(cell: &Cell, language: Language) -> Words {
    let mut words = cell.words.clone();
    words.p = quantity(&words.p, language);
    if words.x == "row" {
        words.x = language.pick("row", "行号").to_owned();
    }
    if let Some(of) = words.x.strip_prefix("signal(") {
        words.x = language.pick(format!("signal({of}"), format!("信号({of}"));
    }
    words
}

/// What distinguishes a variant; numbers without a unit stand alone.
pub(super) fn label(variation: &Variation, language: Language) -> String {
    let label = variation.short_label();
    spoken(label.strip_suffix(" 1").unwrap_or(&label), language)
}

/// A quantity of the model in a language: offset and scale, of one output or of all, have words, others their
/// names.
pub(super) fn quantity(node: &str, language: Language) -> String {
    if let Some((part, output)) = node.split_once(" of ") {
        let part = quantity(part, language);
        return language.pick(format!("{part} of {output}"), format!("{output} 的{part}"));
    }
    match node {
        "offset" => language.pick("offset", "零位"),
        "scale" => language.pick("scale", "标度"),
        other => other,
    }
    .to_owned()
}

/// What was fitted, in a language: a parameter by its name, or the error that all values of a column share.
pub(super) fn unknown(name: &str, language: Language) -> String {
    match name.strip_prefix("common error of ") {
        Some(column) => language.pick(name.to_owned(), format!("{column} 的共同误差")),
        None => name.to_owned(),
    }
}

/// The value of what was fitted; what its rounding leaves of zero is zero.
pub(super) fn estimate(fitted: &Estimated) -> String {
    /// Part of the standard uncertainty.
    const NOTHING: f64 = 1e-9;
    let is_zero = fitted.value.abs() < NOTHING * fitted.u;
    aligned(if is_zero { 0.0 } else { fitted.value }, fitted.u, 2)
}

/// The name, and what distinguishes a cell whose only variant has a label: the harmonic of an angle.
pub(super) fn full_name(cell: &Cell, language: Language) -> String {
    let name = name(cell, language);
    match cell.variants.as_slice() {
        [only] if !only.label.is_empty() => distinguished(&name, &label(only, language), language),
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
        label => distinguished(&name, &label, language),
    }
}

fn distinguished(name: &str, label: &str, language: Language) -> String {
    language.pick(format!("{name} ({label})"), format!("{name}（{label}）"))
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

/// The amplitude of what repeats with the sine and the cosine of one argument.
pub(super) fn amplitude(
    case: &Case,
    diagnosis: &Diagnosis,
    alternative: &Alternative,
    language: Language,
) -> Option<String> {
    let (cell, variation) = diagnosis.atoms[alternative.variants.first()?.atom];
    let terms = &diagnosis.cells[cell].variants[variation].terms;
    let terms: Vec<&Term> = terms.iter().filter(|term| !term.tied).collect();
    let [sine, cosine] = terms.as_slice() else {
        return None;
    };
    let argument = sine.written().text.strip_prefix("sin(")?;
    if cosine.written().text.strip_prefix("cos(") != Some(argument) {
        return None;
    }
    let size = alternative.estimate.norm();
    let gradient = &alternative.estimate / size;
    let of_noise = gradient.dot(&(&alternative.covariance * &gradient)).sqrt();
    let of_choice = gradient.component_mul(&alternative.choice).norm();
    let u = alternative.widened(of_noise, of_choice);
    let unit = sine.unit_of_size(case).typeset();
    let text = format!("{} ± {} {unit}", aligned(size, u, 2), significant(u, 2));
    let text = text.trim_end();
    u.is_finite()
        .then(|| language.pick(format!("amplitude {text}"), format!("幅值 {text}")))
}

/// The noise that was assumed, and why, where it needs outputs that are not recorded.
pub fn assumed_noise(case: &Case, claimed: &Claimed, language: Language) -> String {
    if claimed.origin != Origin::Unknown {
        return noise(claimed, language);
    }
    let why = match case.noise {
        NoiseClaim::Replicates(_) => language.pick(
            "replicates show it once their outputs are recorded",
            "重复测量须待输出记录后才能给出噪声",
        ),
        _ => language.pick(
            "not claimed, and no outputs are recorded",
            "未声明，且输出尚未记录",
        ),
    };
    language.pick(
        format!("not known ({why}): taken as 1 for one row, in the unit of the output; `[noise] u` states it"),
        format!("未知（{why}）：单行标准不确定度以 1 计（输出的单位）；可用 `[noise] u` 声明"),
    )
}

/// Where the noise comes from.
pub(super) fn noise(claimed: &Claimed, language: Language) -> String {
    let dof = if claimed.dof.is_finite() && claimed.dof > 0.0 {
        format!(", ν = {}", freedom(claimed.dof))
    } else {
        String::new()
    };
    let text = match &claimed.origin {
        Origin::Unknown => language.pick("not known", "未知").to_owned(),
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
            format!(
                "from the recording at rest {file}{}",
                white(claimed, language)
            ),
            format!("取自静态记录 {file}{}", white(claimed, language)),
        ),
        Origin::Budget(file) => language.pick(
            format!("from the budget {file}"),
            format!("取自不确定度评定文件 {file}"),
        ),
    };
    text + &dof + &uneven(claimed, language)
}

/// That a recording at rest tells nothing of the course of the noise.
fn white(claimed: &Claimed, language: Language) -> &'static str {
    match claimed.correlated {
        Some(_) => "",
        None => language.pick(
            ", as white noise (its course needs the time, by one name in both recordings, and 20 readings)",
            "，按白噪声处理（计入其时间相关性需要两份记录有同名时间列，且至少 20 个读数）",
        ),
    }
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

/// A probability in percent: nothing that is tested is certain.
pub(super) fn chance(p: f64) -> String {
    if p > 0.9995 {
        return ">99.9".to_owned();
    }
    percent(p)
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

/// A fit on which a reader should not rely.
pub(super) fn unsettled(case: &Case, found: &Unsettled, language: Language) -> String {
    let model = match found.model {
        ModelVersion::Declared => language.pick("the declared model", "所声明的模型"),
        ModelVersion::Improved => {
            language.pick("the model with the effects in it", "含上述效应的模型")
        }
    };
    match &found.trouble {
        Trouble::NoMinimum { steps } => language.pick(
            format!("Not settled: the search for the parameters of {model} ended after {steps} steps in a place that is no minimum of χ². Values, uncertainties and names that follow from it may be wrong; state starts nearer to the truth: [parameter] NAME = {{ start = … }}"),
            format!("未收敛：{model}的参数搜索在 {steps} 步后停在并非 χ² 极小值之处。由此得到的数值、不确定度和名称可能有误；请给出更接近的起始值：[parameter] 名称 = {{ start = … }}"),
        ),
        Trouble::NoFit(why) => {
            let why = failure(case, &Failure::Fit(why.clone()), language);
            language.pick(
                format!("Not settled: {model} could not be fitted, so nothing is adopted: {why}"),
                format!("未收敛：{model}无法拟合，故未采纳任何效应：{why}"),
            )
        }
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
