//! Why an experiment gives no coefficients, and combinations of parameters in words.

use gumption_lab::calibrate::{Combination, Trouble};

use crate::language::Language;
use crate::number::significant;

/// What is wrong and what to do about it.
pub(super) fn sentences(trouble: &Trouble, l: Language) -> String {
    match trouble {
        Trouble::TooFew { readings, parameters } => l.pick(
            format!("{} cannot determine {parameters} parameters; measure at more points, or list fewer parameters.", counted(*readings)),
            format!("{readings} 个读数不能确定 {parameters} 个参数；请增加测量点或减少参数。"),
        ),
        Trouble::NoScatter { response, readings, parameters } => l.pick(
            format!("The scatter of {response} is not known: {} and {parameters} parameters leave no residuals. Measure at more points, or state the errors of the readings in [reading.{response}] and write noise.from = \"stated\".", counted(*readings)),
            format!("{response} 的分散性未知：{readings} 个读数、{parameters} 个参数，没有残差。请增加测量点，或在 [reading.{response}] 中给出读数误差并写 noise.from = \"stated\"。"),
        ),
        Trouble::NoSamples => l.pick(
            "noise.from = \"dwells\" needs the samples of each dwell, and every row of this recording is one point. Name the columns that tell dwells apart, dwells = […], or write noise.from = \"residuals\".".into(),
            "noise.from = \"dwells\" 需要每个驻留段的采样，而本记录每行即一个点。请用 dwells = […] 指明区分驻留段的列，或写 noise.from = \"residuals\"。".into(),
        ),
        Trouble::NoWeights { response } => l.pick(
            format!("weights = \"readings\" needs the standard uncertainty of every reading of {response}: state it in [reading.{response}], average samples in dwells, or write weights = \"equal\"."),
            format!("weights = \"readings\" 需要 {response} 每个读数的标准不确定度：请在 [reading.{response}] 中给出，或对驻留段的采样取平均，或写 weights = \"equal\"。"),
        ),
        Trouble::Undetermined { combinations } => {
            let head = l.pick(
                "The readings do not tell the parameters apart:".to_owned(),
                "读数不能区分以下参数：".to_owned(),
            );
            let tail = l.pick(
                "Add points where their effects differ, or take one of them as known ([input.NAME] instead of [parameter.NAME]).",
                "请增加使其影响不同的测量点，或将其中之一作为已知量（用 [input.NAME] 代替 [parameter.NAME]）。",
            );
            let list: Vec<String> = combinations.iter().map(|c| format!("  • {}", in_words(c, l))).collect();
            format!("{head}\n{}\n  {tail}", list.join("\n"))
        }
        Trouble::NoStart { parameters } => {
            let names = parameters.join(", ");
            l.pick(
                format!("The equations are not linear in {names}, and the search needs a place to begin: state roughly [parameter.{}] start = ….", parameters[0]),
                format!("方程对 {names} 非线性，搜索需要初值：请给出 [parameter.{}] start = …。", parameters[0]),
            )
        }
        Trouble::Undefined { point, response } => l.pick(
            format!("The equation of {response} has no value in {}: check the start values, and the columns for zeros and signs.", point.en),
            format!("{response} 的方程在 {} 处无定义：请检查初值以及各列中的零值和符号。", point.zh),
        ),
        Trouble::NoConvergence { iterations } => l.pick(
            format!("The search found no minimum in {iterations} steps: begin nearer to the solution, or check that each parameter matters."),
            format!("经 {iterations} 步搜索未找到最小值：请给出更接近解的初值，或检查每个参数是否都有影响。"),
        ),
        Trouble::TooLarge { readings, bytes, most } => {
            let gib = |bytes: u64| bytes.div_ceil(1 << 30);
            let (needed, most) = (gib(*bytes), gib(*most));
            l.pick(
                format!("A calibration of {readings} readings takes about {needed} GiB of memory, and at most {most} GiB are taken. Average the samples of each state first: [recording] dwells = [\"position\"], steps = \"omega\" or still = 50; or take every tenth row of the recording."),
                format!("对 {readings} 个读数进行校准约需 {needed} GiB 内存，最多使用 {most} GiB。请先对同一状态的采样取平均：[recording] 中写 dwells = [\"position\"]、steps = \"omega\" 或 still = 50；或只取记录的十分之一行。"),
            )
        }
        Trouble::Unsolvable => l.pick(
            "The least-squares problem cannot be solved as it is stated.".into(),
            "该最小二乘问题无法求解。".into(),
        ),
        Trouble::InPart { label, trouble } => {
            let inner = sentences(trouble, l);
            l.pick(format!("In \"{label}\": {inner}"), format!("在 \"{label}\" 中：{inner}"))
        }
    }
}

pub(super) fn counted(readings: usize) -> String {
    match readings {
        1 => "1 reading".to_owned(),
        _ => format!("{readings} readings"),
    }
}

/// What may change without a change of the readings.
pub(super) fn in_words(combination: &Combination, l: Language) -> String {
    match combination.changes.as_slice() {
        [(name, ..)] => l.pick(
            format!("{name} changes no reading"),
            format!("{name} 不影响任何读数"),
        ),
        _ => l.pick(
            format!("{} together change no reading", changes(combination)),
            format!("{} 同时变化时读数不变", changes(combination)),
        ),
    }
}

/// The changes of a combination: `K3 + 1, K1 − 0.75 mA/gn`.
pub(super) fn changes(combination: &Combination) -> String {
    let change = |(name, change, unit): &(String, f64, String)| {
        let sign = if *change < 0.0 { '−' } else { '+' };
        let unit = if unit == "1" {
            String::new()
        } else {
            format!(" {unit}")
        };
        format!("{name} {sign} {}{unit}", significant(change.abs(), 3))
    };
    let changes: Vec<String> = combination.changes.iter().map(change).collect();
    changes.join(", ")
}
