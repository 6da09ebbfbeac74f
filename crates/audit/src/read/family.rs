//! Families of words that say what is known.
//!
//! The same words say what a row is and where its figure stands. A figure is looked for behind the first word of a list, then the
//! second: what is said in more words, or names nothing else, comes first.

#[rustfmt::skip]
pub(crate) const RANGE: &[&str] = &["range method", "range of the readings", "range of readings", "range r", "range of", "range table", "极差", "max-min", "max - min"];
#[rustfmt::skip]
pub(crate) const ALIKE: &[&str] = &["equal", "alike", "identical", "the same", "no scatter", "相同", "一致"];
#[rustfmt::skip]
pub(crate) const POOLED: &[&str] = &["pooled", "合并样本", "合并标准", "合并实验", "合并", "s_p", "sp ="];
#[rustfmt::skip]
pub(crate) const DEVIATION: &[&str] = &["standard deviation", "repeatability", "type a", "标准偏差", "标准差", "重复性", "s of", "s =", "s=", "s_p", "a类", "experimental", "scatter", "readings agree", "readings are equal", "equal readings", "贝塞尔", "bessel", "次测量", "repeated", "wiederholbarkeit", "standardabweichung"];
#[rustfmt::skip]
pub(crate) const CERTIFICATE: &[&str] = &["certificate", "calibration certificate", "expanded", "证书", "扩展不确定度", "cert.", "calibration of", "calibrated", "u(k", "u (k", "k=2", "k = 2", "kalibrierschein"];
#[rustfmt::skip]
pub(crate) const FULL_WIDTH: &[&str] = &["full width", "total width", "whole width", "overall width", "width of the interval", "interval of width", "full interval", "full range", "peak-to-peak", "peak to peak", "全宽", "总宽", "全区间", "区间宽度", "区间全", "全范围", "峰峰值", "峰-峰值", "峰峰", "峰-峰", "total span"];
#[rustfmt::skip]
pub(crate) const STEP: &[&str] = &["digital step", "resolution", "scale interval", "scale division", "graduation", "readability", "least count", "最小分度", "最小刻度", "分辨力", "分辨率", "auflösung", "步进", "分度值", "lsb", "step", "increment", "division", "刻度", "末位", "量化单位", "least significant", "last digit", "digit", "量化", "quantisation", "quantization", "数字化"];
/// Those of [`STEP`] that name nothing else: there are digital instruments and steps of a procedure.
pub(crate) const RESOLUTION: &[&str] = STEP.split_at(15).0;
#[rustfmt::skip]
pub(crate) const CYCLING: &[&str] = &["cycling", "cyclic", "cycles", "amplitude", "sinusoid", "arcsine", "u-shaped", "u shaped", "u-form", "u-verteilung", "oscillat", "幅值", "振幅", "周期", "正弦", "反正弦", "u形", "循环"];
#[rustfmt::skip]
pub(crate) const LIMITS: &[&str] = &["±", "+/-", "limits", "limit", "mpe", "maximum permissible error", "maximum permissible", "tolerance", "accuracy", "within", "at most", "half-width", "half width", "允许误差", "最大允差", "最大允许", "允差", "误差限", "误差范围", "极限", "界限", "半宽", "不超过", "specification", "spec.", "bound", "准确度", "范围"];
#[rustfmt::skip]
pub(crate) const STANDARD: &[&str] = &["standard uncertainty", "标准不确定度"];
#[rustfmt::skip]
pub(crate) const GLASSWARE: &[&str] = &["pipet", "flask", "buret", "glassware", "移液管", "吸量管", "容量瓶", "滴定管", "玻璃量器"];
#[rustfmt::skip]
pub(crate) const TRIANGULAR: &[&str] = &["triang", "dreieck", "三角"];
#[rustfmt::skip]
pub(crate) const TRAPEZOID: &[&str] = &["trapez", "梯形"];
#[rustfmt::skip]
pub(crate) const NORMAL: &[&str] = &["normal", "gauss", "正态"];
#[rustfmt::skip]
pub(crate) const TWO_POINT: &[&str] = &["two-point", "two point", "dirac", "两点"];
#[rustfmt::skip]
pub(crate) const RECTANGULAR: &[&str] = &["rect", "rectang", "rechteck", "gleichverteil", "uniform", "均匀", "矩形"];
#[rustfmt::skip]
pub(crate) const READINGS: &[&str] = &["reading", "measurement", "observation", "repeat", "determination", "indications", "values", "runs", "cycle", "weighing", "deliver", "dispens", "injection", "replicate", "indentation", "impact", "shots", "comparisons", "loadings", "mountings", "aliquots", "次", "messungen", "ablesungen"];
#[rustfmt::skip]
pub(crate) const MEAN: &[&str] = &["mean of", "average of", "averages of", "means of", "mean over", "m =", "m=", "reported as mean of", "averaged over", "取平均", "mittelwert von", "mittelwert aus"];
#[rustfmt::skip]
pub(crate) const AS_STATED: &[&str] = &["u as stated", "直接给出 u"];
pub(crate) const FIT: &[&str] = &[
    "least squares",
    "regression",
    "analysis of variance",
    "最小二乘",
    "回归",
    "方差分析",
];
/// What a percentage may be of that is not the value.
#[rustfmt::skip]
pub(crate) const FULL_SCALE: &[&str] = &["full scale", "full-scale", "fs =", "f.s.", "fs", "满量程", "满度", "量程"];
/// What says that a row is in another one.
#[rustfmt::skip]
pub(crate) const CONTAINED: &[&str] = &["contained in", "included in", "已包含", "包含在", "包含于", "含于", "并入", "已含", "已计入"];
#[rustfmt::skip]
pub(crate) const ARCSINE: &[&str] = &["arcsin", "u-shape", "u shape", "反正弦", "u形"];
/// How ν_eff is written.
#[rustfmt::skip]
pub(crate) const NU_EFF: &[&str] = &["ν_eff", "νeff", "v_eff", "veff", "nu_eff", "ν eff", "νₑff", "ν_{eff}"];
/// How k is written.
pub(crate) const FACTOR: &[&str] = &["k", "kp", "k_p", "k95", "k_95", "k99", "k_99"];
/// What calls a figure that of a mean, or the value one.
pub(crate) const AVERAGE: &[&str] = &["mean", "average", "平均", "均值", "mittelwert"];
/// What calls a calibration and measurement capability.
#[rustfmt::skip]
pub(crate) const CMC: &[&str] = &["cmc", "校准和测量能力", "校准测量能力", "best measurement capability", "最佳测量能力"];
