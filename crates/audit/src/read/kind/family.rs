//! Families of words that say what is known.

#[rustfmt::skip]
pub(super) const RANGE: &[&str] = &["range method", "range of the readings", "range of readings", "range r", "range of", "range table", "极差", "max-min", "max - min"];
#[rustfmt::skip]
pub(super) const ALIKE: &[&str] = &["equal", "alike", "identical", "the same", "no scatter", "相同", "一致"];
#[rustfmt::skip]
pub(super) const POOLED: &[&str] = &["pooled", "合并样本", "合并标准", "合并实验", "合并", "s_p", "sp ="];
#[rustfmt::skip]
pub(super) const DEVIATION: &[&str] = &["standard deviation", "repeatability", "type a", "标准偏差", "标准差", "重复性", "s of", "s =", "s=", "s_p", "a类", "experimental", "scatter", "readings agree", "readings are equal", "equal readings", "贝塞尔", "bessel", "次测量", "repeated", "wiederholbarkeit", "standardabweichung"];
#[rustfmt::skip]
pub(super) const CERTIFICATE: &[&str] = &["certificate", "calibration certificate", "expanded", "证书", "扩展不确定度", "cert.", "calibration of", "calibrated", "u(k", "u (k", "k=2", "k = 2", "kalibrierschein"];
#[rustfmt::skip]
pub(super) const FULL_WIDTH: &[&str] = &["full width", "total width", "whole width", "full range", "full interval", "peak-to-peak", "peak to peak", "全宽", "总宽", "全区间", "峰峰", "峰-峰", "区间宽度", "区间全", "width of the interval", "total span", "interval of width", "overall width", "全范围"];
#[rustfmt::skip]
pub(super) const STEP: &[&str] = &["resolution", "digital step", "step", "increment", "scale interval", "scale division", "division", "graduation", "least significant", "last digit", "digit", "分辨力", "分辨率", "步进", "分度值", "末位", "lsb", "量化", "quantisation", "quantization", "least count", "readability", "最小分度", "数字化", "刻度", "auflösung"];
#[rustfmt::skip]
pub(super) const CYCLING: &[&str] = &["cycling", "cyclic", "cycles", "amplitude", "sinusoid", "arcsine", "u-shaped", "u shaped", "oscillat", "幅值", "振幅", "周期", "正弦", "反正弦", "u形", "循环"];
#[rustfmt::skip]
pub(super) const LIMITS: &[&str] = &["limit", "limits", "maximum permissible", "mpe", "tolerance", "specification", "accuracy", "within", "bound", "允许误差", "允差", "误差限", "极限", "最大允许", "界限", "半宽", "half-width", "half width", "rectang", "rechteck", "uniform", "均匀", "矩形", "spec.", "±", "不超过", "at most", "准确度", "误差范围", "范围"];
#[rustfmt::skip]
pub(super) const STANDARD: &[&str] = &["standard uncertainty", "标准不确定度"];
#[rustfmt::skip]
pub(super) const GLASSWARE: &[&str] = &["pipet", "flask", "buret", "glassware", "移液管", "吸量管", "容量瓶", "滴定管", "玻璃量器"];
#[rustfmt::skip]
pub(super) const TRIANGULAR: &[&str] = &["triang", "dreieck", "三角"];
#[rustfmt::skip]
pub(super) const TRAPEZOID: &[&str] = &["trapez", "梯形"];
#[rustfmt::skip]
pub(super) const NORMAL: &[&str] = &["normal", "gauss", "正态"];
#[rustfmt::skip]
pub(super) const TWO_POINT: &[&str] = &["two-point", "two point", "dirac", "两点"];
#[rustfmt::skip]
pub(super) const RECTANGULAR: &[&str] = &["rect", "rectang", "rechteck", "gleichverteil", "uniform", "均匀", "矩形"];
#[rustfmt::skip]
pub(super) const READINGS: &[&str] = &["reading", "measurement", "observation", "repeat", "determination", "indications", "values", "runs", "cycle", "weighing", "deliver", "dispens", "injection", "replicate", "indentation", "impact", "shots", "comparisons", "loadings", "mountings", "aliquots", "次", "messungen", "ablesungen"];
#[rustfmt::skip]
pub(super) const MEAN: &[&str] = &["mean of", "average of", "averages of", "means of", "mean over", "m =", "m=", "reported as mean of", "averaged over", "取平均", "mittelwert von", "mittelwert aus"];
#[rustfmt::skip]
pub(super) const AS_STATED: &[&str] = &["u as stated", "直接给出 u"];
pub(super) const FIT: &[&str] = &[
    "least squares",
    "regression",
    "analysis of variance",
    "最小二乘",
    "回归",
    "方差分析",
];
