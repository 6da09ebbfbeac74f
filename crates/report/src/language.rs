//! Words of headings, table heads and labels, which are short enough to stand in both languages side by side; sentences
//! are templates of `say!`. Chinese terms are those of JJF 1059.1.

pub use gumption_fault::language::Language;

/// Words of headings, table heads and row labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    Author,
    Claim,
    Claimed,
    Component,
    Contribution,
    CorrelatedComponents,
    CombinedUncertainty,
    Correlation,
    CoverageFactor,
    Date,
    Distribution,
    Ellipsoid,
    Estimate,
    Exact,
    ExpandedUncertainty,
    FreedomShort,
    FreedomEffective,
    Groups,
    Expanded,
    Factor,
    Gum,
    Hyperrectangle,
    InputGroup,
    Interval,
    Joint,
    Kurtosis,
    Measurand,
    Median,
    Method,
    Model,
    MonteCarlo,
    Note,
    Object,
    Obtained,
    Origin,
    Quantity,
    Remarks,
    Row,
    SecondOrderShift,
    SecondOrderU,
    Sensitivity,
    Share,
    Shared,
    SideBySide,
    Skewness,
    Source,
    Sources,
    StandardUncertainty,
    Statement,
    Trials,
    TypeShort,
    Unit,
    Where,
}

impl Word {
    /// The word in a language.
    pub(super) fn of(self, language: Language) -> &'static str {
        let (english, chinese) = match self {
            Word::Author => ("Author", "编制"),
            Word::Claim => ("Comparison with the claim", "与声称值的比较"),
            Word::Claimed => ("claimed", "声称值"),
            Word::Component => ("component", "不确定度分量"),
            Word::Contribution => ("c·u", "c·u"),
            Word::CorrelatedComponents => ("Correlated components", "相关的不确定度分量"),
            Word::CombinedUncertainty => ("combined standard uncertainty", "合成标准不确定度"),
            Word::Expanded => ("expanded uncertainty", "扩展不确定度"),
            Word::Factor => ("coverage factor", "包含因子"),
            Word::Correlation => ("Correlation coefficients", "相关系数"),
            Word::CoverageFactor => ("coverage factor k", "包含因子 k"),
            Word::Date => ("Date", "日期"),
            Word::Distribution => ("distri\u{AD}bution", "概率分布"),
            Word::Ellipsoid => ("ellipsoid", "椭球区域"),
            Word::Estimate => ("estimate", "估计值"),
            Word::Exact => ("Exactly known", "精确已知的量"),
            Word::ExpandedUncertainty => ("expanded uncertainty U", "扩展不确定度 U"),
            Word::FreedomShort => ("ν", "ν"),
            Word::FreedomEffective => ("effective degrees of freedom", "有效自由度"),
            Word::Groups => ("Subtotals by group", "分组小计"),
            Word::Gum => ("GUM", "GUM 法"),
            Word::Hyperrectangle => ("hyper-rectangle", "超矩形区域"),
            Word::InputGroup => ("group", "组"),
            Word::Interval => ("coverage interval", "包含区间"),
            Word::Joint => ("Joint result", "多输出量的联合结果"),
            Word::Kurtosis => ("excess kurtosis", "超额峰度"),
            Word::Measurand => ("Measurand", "被测量"),
            Word::Median => ("median", "中位数"),
            Word::Method => ("Method", "方法"),
            Word::Model => ("Measurement model", "测量模型"),
            Word::MonteCarlo => ("Monte Carlo", "蒙特卡洛法"),
            Word::Note => ("Note", "备注"),
            Word::Object => ("Object", "被校对象"),
            Word::Obtained => ("obtained", "计算值"),
            Word::Origin => (
                "Where the standard uncertainties come from",
                "标准不确定度的来源与评定",
            ),
            Word::Quantity => ("quantity", "输入量"),
            Word::Remarks => ("What to know before using these figures", "使用结果前须知"),
            Word::Row => ("row", "行"),
            Word::SecondOrderShift => ("estimate with second-order terms", "计入二阶项的估计值"),
            Word::SecondOrderU => ("u with second-order terms", "计入二阶项的标准不确定度"),
            Word::Sensitivity => ("c", "灵敏系数 c"),
            Word::Share => ("%", "占比 %"),
            Word::Shared => (
                "Shared sources (already contained in the inputs above)",
                "共同来源（已计入上列各输入量）",
            ),
            Word::SideBySide => ("GUM and Monte Carlo side by side", "GUM 法与蒙特卡洛法对照"),
            Word::Skewness => ("skewness", "偏度"),
            Word::Source => ("Source of the figures", "数据来源"),
            Word::Sources => ("certificate, source", "证书、来源"),
            Word::StandardUncertainty => ("standard uncertainty", "标准不确定度"),
            Word::Statement => ("Statement for the certificate", "证书用语"),
            Word::Trials => ("trials", "试验次数"),
            Word::TypeShort => ("type", "类别"),
            Word::Unit => ("unit", "单位"),
            Word::Where => ("how u was found", "评定方式"),
        };
        language.pick(english, chinese)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_read_naturally() {
        let names: Vec<String> = ["a", "b", "c"].map(String::from).to_vec();
        assert_eq!(Language::English.list(&names), "a, b and c");
        assert_eq!(Language::Chinese.list(&names), "a、b 和 c");
        assert_eq!(Language::English.either(&names), "a or b or c");
        assert_eq!(Language::Chinese.either(&names), "a、b 或 c");
        assert_eq!(Language::Chinese.either(&names[..1]), "a");
        assert_eq!(Language::English.list(&names[..1]), "a");
    }

    #[test]
    fn long_lists_are_counted() {
        let names: Vec<String> = (0..17).map(|i| format!("x{i}")).collect();
        let language = Language::English;
        assert_eq!(language.first_of(&names[..16]), language.list(&names[..16]));
        let shortened = language.first_of(&names);
        assert_eq!(shortened, "x0, x1, x2, x3, x4, x5, x6, x7 and 9 others");
        let shortened = Language::Chinese.first_of(&names);
        assert!(shortened.ends_with("x7 等 17 项"), "{shortened}");
    }
}
