//! What a sheet says of what is known.

use super::quantity::Known;
use super::words::{plain, typed};

/// What a sheet says of what is known; `variant` chooses among several ways to say it.
pub(super) fn said(known: Known, unit: &str, chinese: bool, variant: usize) -> String {
    let f = |x: f64| plain(x, 2);
    let of = |ways: &[String]| ways[variant % ways.len()].clone();
    let mean = |n: u32, m: u32| match (chinese, m) {
        (false, 1) => "a single reading is reported".to_string(),
        (true, 1) => "报告单次测量值".to_string(),
        (false, m) if m == n => format!("the mean of all {m} readings is reported"),
        (false, m) => of(&[
            format!("mean of {m} readings reported"),
            format!("the result is the mean of {m} readings"),
            format!("m = {m} readings are averaged for the customer"),
        ]),
        (true, m) => of(&[
            format!("取 {m} 次测量的平均值作为结果"),
            format!("以{m}次平均值报告"),
        ]),
    };
    match (known, chinese) {
        (Known::Certificate(x, k), false) => of(&[
            format!("calibration certificate: U = {} {unit}, k = {k}", f(x)),
            format!(
                "certificate no. 2024-117, expanded uncertainty {} {unit} (k = {k})",
                f(x)
            ),
            format!(
                "U = {} {unit} with coverage factor k = {k} from the calibration certificate",
                f(x)
            ),
        ]),
        (Known::Certificate(x, k), true) => of(&[
            format!("校准证书给出 U = {} {unit}，k = {k}", f(x)),
            format!("由上级证书，扩展不确定度为 {} {unit}（k={k}）", f(x)),
        ]),
        (Known::Limits(a), false) => of(&[
            format!("limits ±{} {unit}, nothing else known", f(a)),
            format!("maximum permissible error ± {} {unit}", f(a)),
            format!(
                "manufacturer's specification {} {unit}, no level of confidence given",
                f(a)
            ),
            format!("may lie anywhere within ±{} {unit}", f(a)),
        ]),
        (Known::Limits(a), true) => of(&[
            format!("最大允许误差 ±{} {unit}", f(a)),
            format!("变化不超过 ±{} {unit}，服从均匀分布", f(a)),
            format!("说明书给出误差限 ±{} {unit}", f(a)),
        ]),
        (Known::Triangle(a), false) => of(&[
            format!("triangular distribution with limits ±{} {unit}", f(a)),
            format!(
                "within ±{} {unit}, values near the centre likelier: triangle",
                f(a)
            ),
        ]),
        (Known::Triangle(a), true) => format!("在 ±{} {unit} 内，服从三角分布", f(a)),
        (Known::Cycle(a), false) => of(&[
            format!("cycles with an amplitude of {} {unit}", f(a)),
            format!(
                "sinusoidal variation of amplitude {} {unit} (arcsine distribution)",
                f(a)
            ),
        ]),
        (Known::Cycle(a), true) => of(&[
            format!("周期性波动，幅值 {} {unit}", f(a)),
            format!("按正弦变化，振幅 {} {unit}，反正弦分布", f(a)),
        ]),
        (Known::Width(w), false) => of(&[
            format!("total width of the interval {} {unit}", f(w)),
            format!("stays in a band of full width {} {unit}", f(w)),
            format!("{} {unit} peak to peak", f(w)),
        ]),
        (Known::Width(w), true) => of(&[
            format!("区间全宽 {} {unit}", f(w)),
            format!("峰峰值 {} {unit}", f(w)),
        ]),
        (Known::Step(q), false) => of(&[
            format!("digital step {} {unit}", typed(q)),
            format!("resolution of the display {} {unit}", typed(q)),
            format!("digital indication, increments of {} {unit}", typed(q)),
        ]),
        (Known::Step(q), true) => of(&[
            format!("数显分辨力 {} {unit}", typed(q)),
            format!("示值的数字步进为 {} {unit}", typed(q)),
        ]),
        (Known::Uneven(plus, minus), false) => of(&[
            format!("limits +{} {unit} / −{} {unit}", f(plus), f(minus)),
            format!("between −{} {unit} and +{} {unit}", f(minus), f(plus)),
        ]),
        (Known::Uneven(plus, minus), true) => format!("允差 +{}/−{} {unit}", f(plus), f(minus)),
        (Known::Scatter(s, n, m), false) => of(&[
            format!(
                "standard deviation s = {} {unit} of {n} readings, {}",
                f(s),
                mean(n, m)
            ),
            format!("{n} readings gave s = {} {unit}; {}", f(s), mean(n, m)),
            format!(
                "repeatability study with n = {n}: s = {} {unit} (single reading); {}",
                f(s),
                mean(n, m)
            ),
        ]),
        (Known::Scatter(s, n, m), true) => of(&[
            format!(
                "重复测量 {n} 次，实验标准偏差 s = {} {unit}，{}",
                f(s),
                mean(n, m)
            ),
            format!("{n}次测量的单次标准偏差为 {} {unit}，{}", f(s), mean(n, m)),
        ]),
        (Known::Pooled(s, series, n, m), false) => of(&[
            format!(
                "pooled standard deviation s_p = {} {unit} from {series} series of {n} readings, {}",
                f(s),
                mean(0, m)
            ),
            format!(
                "s_p = {} {unit}, pooled over {series} series of {n} readings each; {}",
                f(s),
                mean(0, m)
            ),
        ]),
        (Known::Pooled(s, series, n, m), true) => {
            format!(
                "合并样本标准偏差 s_p = {} {unit}（{series} 组，每组 {n} 次），{}",
                f(s),
                mean(0, m)
            )
        }
        (Known::Spread(r, n, m), false) => format!(
            "range method: range R = {} {unit} of {n} readings, {}",
            f(r),
            mean(n, m)
        ),
        (Known::Spread(r, n, m), true) => format!(
            "极差法：{n} 次读数的极差 R = {} {unit}，{}",
            f(r),
            mean(n, m)
        ),
        (Known::Alike(q, n), false) => format!(
            "all {n} readings were equal; digital step {} {unit}",
            typed(q)
        ),
        (Known::Alike(q, n), true) => format!("{n} 次读数完全相同，示值步进 {} {unit}", typed(q)),
        (Known::OfReading(p), false) => of(&[
            format!("limits ±{} % of the reading", f(p)),
            format!("specification {} % of value, limits", f(p)),
        ]),
        (Known::OfReading(p), true) => format!("最大允许误差 ±{} %（读数的）", f(p)),
        (Known::OfScale(p, scale), false) => format!(
            "accuracy ±{} % of full scale, full scale {} {unit}",
            f(p),
            typed(scale)
        ),
        (Known::OfScale(p, scale), true) => {
            format!("准确度为满量程 {} {unit} 的 ±{} %", typed(scale), f(p))
        }
    }
}
