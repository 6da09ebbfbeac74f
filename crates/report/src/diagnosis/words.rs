//! Phrases of a diagnosis: measurements, probabilities, why there is none.

use crate::language::Language;
use crate::number::{percent, significant};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::evidence::Refusal;
use gumption_lab::diagnose::{Failure, Measure, ModelVersion, NoFit, Trouble, Unsettled};

/// A further measurement as a phrase.
pub(super) fn measure(measure: &Measure, l: Language) -> String {
    match measure {
        Measure::Own(name) => name.clone(),
        Measure::Again => l.pick("the same once more", "原样重复一次").to_owned(),
        Measure::Reversed => l
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
            l.pick(
                format!("the same once more with {column} at {value}"),
                format!("将 {column} 设为 {value} 后重复一次"),
            )
        }
        Measure::Between(column) => l.pick(
            format!("the same once more with {column} half way between its values"),
            format!("将 {column} 取在原有各值的中间后重复一次"),
        ),
        Measure::Opposite(column) => l.pick(
            format!("the same once more while {column} varies twice as much in the opposite sense"),
            format!("使 {column} 反向并以两倍幅度变化时重复一次"),
        ),
        Measure::Exchanged(column) => l.pick(
            format!("the same once more with each {column} in the place of the next"),
            format!("将各 {column} 依次互换后重复一次"),
        ),
    }
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
pub(super) fn unsettled(case: &Case, found: &Unsettled, l: Language) -> String {
    let model = match found.model {
        ModelVersion::Declared => l.pick("the declared model", "所声明的模型"),
        ModelVersion::Improved => l.pick("the model with the effects in it", "含上述效应的模型"),
    };
    match &found.trouble {
        Trouble::NoMinimum { steps } => l.pick(
            format!("Not settled: the search for the parameters of {model} ended after {steps} steps in a place that is no minimum of χ². Values, uncertainties and names that follow from it may be wrong; state starts nearer to the truth: [parameter] NAME = {{ start = … }}"),
            format!("未收敛：{model}的参数搜索在 {steps} 步后停在并非 χ² 极小值之处。由此得到的数值、不确定度和名称可能有误；请给出更接近的起始值：[parameter] 名称 = {{ start = … }}"),
        ),
        Trouble::NoFit(why) => {
            let why = failure(case, &Failure::Fit(why.clone()), l);
            l.pick(
                format!("Not settled: {model} could not be fitted, so nothing is adopted: {why}"),
                format!("未收敛：{model}无法拟合，故未采纳任何效应：{why}"),
            )
        }
    }
}

/// Why a case could not be diagnosed.
pub fn failure(case: &Case, failure: &Failure, l: Language) -> String {
    match failure {
        Failure::Fit(NoFit::NoStart) => l.pick(
            "the model has no finite value where the search for its parameters begins; state starts: [parameter] NAME = { start = … }".to_owned(),
            "模型在搜索起点处没有有限值；请给出起始值：[parameter] 名称 = { start = … }".to_owned(),
        ),
        Failure::Fit(NoFit::NoMinimum) => l.pick(
            "the search for the parameters found no minimum; state starts nearer to the truth: [parameter] NAME = { start = … }".to_owned(),
            "未找到参数的极小值；请给出更接近的起始值：[parameter] 名称 = { start = … }".to_owned(),
        ),
        Failure::Fit(NoFit::Undetermined(name)) => l.pick(
            format!("the recording does not determine the parameter {name}: other parameters do the same to every row (`gumption calibrate` says which). Remove it, make it a [constant], or state what is known of it: value and u"),
            format!("记录不能确定参数 {name}：其他参数对每一行的作用与之相同（`gumption calibrate` 指出是哪些）。请删除它、改为 [constant]，或给出先验 value 和 u"),
        ),
        Failure::Fit(NoFit::TooFew { observations, unknowns }) => l.pick(
            format!("{observations} observations leave nothing to examine beside {unknowns} unknown parameters"),
            format!("{observations} 个观测值减去 {unknowns} 个未知参数后没有剩余可供检验"),
        ),
        Failure::Refused(Refusal::Dependent { parameter }) => {
            let name = case.parameters.get(*parameter).map_or("", |p| p.name.as_str());
            l.pick(format!("the recording does not determine the parameter {name}"), format!("记录不能确定参数 {name}"))
        }
        Failure::TooLarge { rows, bytes, most } => {
            let gib = |bytes: u64| bytes.div_ceil(1 << 30);
            let (needed, most) = (gib(*bytes), gib(*most));
            l.pick(
                format!("A diagnosis of {rows} rows takes about {needed} GiB of memory as they are averaged now, and at most {most} GiB are taken. Average them in fewer blocks: [recording] average = 400 or dwells = [\"position\"]; or take a part of the recording."),
                format!("按目前的平均方式诊断 {rows} 行约需 {needed} GiB 内存，最多使用 {most} GiB。请减少平均后的块数：[recording] 中写 average = 400 或 dwells = [\"position\"]；或只取记录的一部分。"),
            )
        }
        Failure::Refused(Refusal::Cancelled) => l.pick("stopped".to_owned(), "已中断".to_owned()),
        Failure::Refused(other) => other.to_string(),
    }
}
