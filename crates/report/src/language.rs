//! Words of headings, table heads and labels, which are short enough to stand in both languages side by side; sentences
//! are templates of `say!`. Chinese terms are those of JJF 1059.1.

pub use gumption_fault::language::Language;

macro_rules! words {
    ($($name:ident $english:literal $chinese:literal,)*) => {
        /// Words of headings, table heads and row labels.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(super) enum Word {
            $($name),*
        }

        impl Word {
            /// The word in a language.
            pub(super) fn of(self, language: Language) -> &'static str {
                match self {
                    $(Word::$name => language.pick($english, $chinese)),*
                }
            }
        }
    };
}

words! {
    Author "Author" "编制",
    Claim "Comparison with the claim" "与声称值的比较",
    Claimed "claimed" "声称值",
    Component "component" "不确定度分量",
    Contribution "c·u" "c·u",
    CorrelatedComponents "Correlated components" "相关的不确定度分量",
    CombinedUncertainty "combined standard uncertainty" "合成标准不确定度",
    Correlation "Correlation coefficients" "相关系数",
    CoverageFactor "coverage factor k" "包含因子 k",
    Date "Date" "日期",
    Distribution "distri\u{AD}bution" "概率分布",
    Ellipsoid "ellipsoid" "椭球区域",
    Estimate "estimate" "估计值",
    Exact "Exactly known" "精确已知的量",
    ExpandedUncertainty "expanded uncertainty U" "扩展不确定度 U",
    FreedomShort "ν" "ν",
    FreedomEffective "effective degrees of freedom" "有效自由度",
    Groups "Subtotals by group" "分组小计",
    Expanded "expanded uncertainty" "扩展不确定度",
    Factor "coverage factor" "包含因子",
    Gum "GUM" "GUM 法",
    Hyperrectangle "hyper-rectangle" "超矩形区域",
    InputGroup "group" "组",
    Interval "coverage interval" "包含区间",
    Joint "Joint result" "多输出量的联合结果",
    Kurtosis "excess kurtosis" "超额峰度",
    Measurand "Measurand" "被测量",
    Median "median" "中位数",
    Method "Method" "方法",
    Model "Measurement model" "测量模型",
    MonteCarlo "Monte Carlo" "蒙特卡洛法",
    Note "Note" "备注",
    Object "Object" "被校对象",
    Obtained "obtained" "计算值",
    Origin "Where the standard uncertainties come from" "标准不确定度的来源与评定",
    Quantity "quantity" "输入量",
    Remarks "What to know before using these figures" "使用结果前须知",
    Row "row" "行",
    SecondOrderShift "estimate with second-order terms" "计入二阶项的估计值",
    SecondOrderU "u with second-order terms" "计入二阶项的标准不确定度",
    Sensitivity "c" "灵敏系数 c",
    Share "%" "占比 %",
    Shared "Shared sources (already contained in the inputs above)" "共同来源（已计入上列各输入量）",
    SideBySide "GUM and Monte Carlo side by side" "GUM 法与蒙特卡洛法对照",
    Skewness "skewness" "偏度",
    Source "Source of the figures" "数据来源",
    Sources "certificate, source" "证书、来源",
    StandardUncertainty "standard uncertainty" "标准不确定度",
    Statement "Statement for the certificate" "证书用语",
    Trials "trials" "试验次数",
    TypeShort "type" "类别",
    Unit "unit" "单位",
    Where "how u was found" "评定方式",
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
