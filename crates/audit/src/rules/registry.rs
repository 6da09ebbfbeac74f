//! The rules, one entry each.

use crate::slips::Weight::{self, Error, Information, Warning};

use super::How::{self, Look, Slip};
use super::{Rule, records, rows, whole, words};

/// What is against a rule, where it stands, why it may be right after all; each in English and Chinese.
struct Texts {
    what: [&'static str; 2],
    clause: &'static str,
    fine: [&'static str; 2],
}

const fn rule(number: u8, weight: Weight, id: &'static str, texts: Texts, how: How) -> Rule {
    Rule {
        number,
        id,
        weight,
        en: texts.what[0],
        zh: texts.what[1],
        clause: texts.clause,
        fine_en: texts.fine[0],
        fine_zh: texts.fine[1],
        how,
    }
}

const fn t(
    en: &'static str,
    zh: &'static str,
    clause: &'static str,
    fine_en: &'static str,
    fine_zh: &'static str,
) -> Texts {
    Texts {
        what: [en, zh],
        clause,
        fine: [fine_en, fine_zh],
    }
}

/// All of them, by number.
#[rustfmt::skip]
pub const RULES: &[Rule] = &[
    rule(1, Error, "sum", t("u_c is not the root of the sum of squares and products of the contributions", "u_c 不等于各分量的方和根（含相关项）", "JCGM 100, 5.1.2 and 5.2.2", "the sheet computes with more digits than it prints", "表格用未修约的数值计算"), Look(whole::sum)),
    rule(2, Error, "product", t("U is not k times u_c", "U 不等于 k 乘 u_c", "JCGM 100, 6.2.1", "U was raised to the CMC, or rounded up", "U 已提高到 CMC 或只进不舍"), Look(whole::product)),
    rule(3, Error, "contribution", t("a contribution is not c times u", "分量不等于灵敏系数乘标准不确定度", "JCGM 100, 5.1.3", "a conversion of units is in it", "其中含单位换算"), Look(rows::contribution)),
    rule(4, Error, "quotient", t("u is not the value divided by the divisor", "标准不确定度不等于数值除以除数", "JCGM 100, 4.3", "the value stands in another unit, or is a percentage of the estimate", "数值所用单位不同，或为估计值的百分数"), Look(rows::quotient)),
    rule(5, Error, "shares", t("the shares do not total 100 %, or are not those of the squares", "贡献率之和不是 100 %，或不是方差的贡献率", "JCGM 100, 5.1", "correlated inputs have shares of their products, too", "相关的输入量另有相关项的份额"), Look(whole::shares)),
    rule(6, Warning, "derivative", t("a sensitivity coefficient is not the derivative of the model at the estimates", "灵敏系数不是模型在估计值处的偏导数", "JCGM 100, 5.1.3", "it was measured by changing the quantity (5.1.4)", "由实验测得（5.1.4）"), Look(rows::derivative)),
    rule(7, Error, "result", t("y is not the value of the model at the estimates", "y 不等于模型在估计值处的值", "JCGM 100, 4.1.4", "a correction that is no row was applied", "另作了未列入表中的修正"), Look(whole::result)),
    rule(8, Error, "linear-sum", t("uncertainties or variances were added where squares belong", "直接相加了不确定度，而不是平方", "JCGM 100, 5.1.2; E.3.2", "all inputs are fully correlated with the same sign (5.2.2, note 1)", "所有输入量完全正相关（5.2.2 注 1）"), Slip),
    rule(9, Warning, "rounded-early", t("intermediate figures were rounded so far that U changes by more than 1 %", "中间结果修约过早，U 变化超过 1 %", "JCGM 100, 7.2.6", "the digits that are printed are not those that were used", "表中显示的位数并非计算所用位数"), Slip),
    rule(10, Error, "k-twice", t("a coverage factor was applied twice, or never removed", "包含因子乘了两次，或从未除去", "JCGM 100, 4.3.3", "the figure was a standard uncertainty after all", "该数值本来就是标准不确定度"), Slip),
    rule(11, Error, "certificate-as-limit", t("U of a certificate whose k is stated was divided by √3", "已知 k 的证书不确定度却除以 √3", "JCGM 100, 4.3.3", "the figure is a limit of error after all", "该数值实为误差限"), Slip),
    rule(12, Error, "limit-by-2", t("limits without a level of confidence were divided by 2", "未给置信水平的极限除以 2", "JCGM 100, 4.3.7", "the maker states them at 95 %", "厂家声明为 95 % 水平"), Slip),
    rule(13, Error, "divisor", t("the divisor is not that of the distribution which is named", "除数与所写分布不符", "JCGM 100, 4.3.4–4.3.9", "a trapezoid or another probability is meant", "实指梯形分布或其他包含概率"), Look(rows::distribution)),
    rule(14, Error, "full-width", t("a full width was used as half-width, or a half-width halved again", "全宽当作半宽，或半宽又减半", "JCGM 100, F.2.2.1", "2^-N of full scale is the half-width of a bipolar converter", "满量程的 2^-N 正是双极性转换器的半宽"), Slip),
    rule(15, Warning, "k-not-2", t("a certificate states another k than 2, and was divided by 2", "证书的 k 不是 2，却除以 2", "JCGM 100, 4.3.3", "none if k is stated", "证书已给出 k 时不成立"), Slip),
    rule(16, Warning, "certificate-without-k", t("U of a certificate is quoted without its k", "引用证书的 U 而未注明 k", "JCGM 100, 7.2.3; ILAC-P14, 5.4", "the certificate says k = 2 for all of its figures", "证书对全部数值统一注明 k = 2"), Look(rows::certificate_without_k)),
    rule(17, Warning, "rectangle-for-certificate", t("a certificate with k was given a rectangular distribution", "已知 k 的证书却取均匀分布", "JCGM 100, 4.3.3", "the certificate says that its distribution is rectangular", "证书注明分布为均匀分布"), Look(rows::rectangle_for_certificate)),
    rule(18, Information, "triangle", t("a triangle was chosen without a reason that is given", "取三角分布而未说明理由", "JCGM 100, 4.3.9", "values near the middle are known to be likelier", "已知接近中间值的可能性更大"), Slip),
    rule(19, Warning, "unequal-limits", t("unequal limits were treated as ± the larger one", "不对称极限按较大者作对称处理", "JCGM 100, 4.3.8", "it is on the safe side, and is said to be", "偏保守且已说明"), Slip),
    rule(20, Warning, "cycle-as-rectangle", t("a cycling influence was entered as a rectangle", "周期性影响按均匀分布处理", "JCGM 101, 6.4.6", "readings were taken at random over many cycles", "读数随机取自多个周期"), Slip),
    rule(21, Error, "mean", t("s was not divided by the root of the number of readings behind the reported value", "s 未除以报告值所用测量次数的平方根", "JCGM 100, 4.2.3", "readings of one series are not independent", "同一组读数并不独立"), Slip),
    rule(22, Error, "pooled-freedom", t("a pooled s was given the degrees of freedom of one series", "合并样本标准偏差却用单组的自由度", "JCGM 100, H.3.6; JJF 1059.1, 4.3.2.4", "the series were not pooled after all", "实际并未合并"), Slip),
    rule(23, Warning, "unequal-variances", t("variances that differ were pooled", "合并了不相等的方差", "JCGM 100, 4.2.4", "differences are within chance (Bartlett, Cochran)", "差异在随机范围内"), Look(records::unequal_variances)),
    rule(24, Warning, "few-readings", t("s of fewer than ten readings was used with a fixed k", "测量次数少于 10，却取固定的 k", "JCGM 100, E.4.3, table E.1; G.3", "the contribution is small, or s comes from longer experience", "该分量很小，或 s 来自长期经验"), Look(rows::few_readings)),
    rule(25, Warning, "divisor-n", t("s was computed with the divisor n instead of n − 1", "计算 s 时除以 n，而不是 n − 1", "JCGM 100, 4.2.2", "n is so large that it does not matter", "n 很大，差别可忽略"), Slip),
    rule(26, Warning, "range-factor", t("the range factor is not that of the number of readings", "极差系数与测量次数不符", "JJF 1059.1-2012, 4.3.2.3", "another table was used", "采用了其他表"), Slip),
    rule(27, Warning, "no-scatter", t("equal readings were taken for no uncertainty", "读数相同便认为无不确定度", "JCGM 100, F.2.2.1", "the step of the indication is another row", "示值步进另列一行"), Slip),
    rule(28, Warning, "autocorrelation", t("readings follow one another or drift", "读数自相关或漂移", "JCGM 100, 4.2.7", "they were taken far enough apart", "测量间隔足够长"), Look(records::autocorrelation)),
    rule(29, Warning, "outlier", t("a reading was left out without a record", "剔除异常值而无记录", "JCGM 100, 4.2; JJF 1059.1, 4.3.2", "a cause is known and recorded elsewhere", "原因已知并另有记录"), Look(words::left_out)),
    rule(30, Warning, "freedom-missing", t("degrees of freedom of readings are missing, or infinite", "A 类自由度缺失或取无穷大", "JCGM 100, G.6.4", "s is that of very many readings", "s 来自大量读数"), Look(rows::freedom_of_readings)),
    rule(31, Warning, "resolution-and-scatter", t("resolution and a repeatability that contains it are both counted", "重复性已含分辨力，又计入分辨力", "JJF 1033-2016, C.2; JCGM 100, H.6, F.2.2.1", "the profile keeps both, or s is below half a step", "所用规范两者都保留，或 s 小于半个步进"), Slip),
    rule(32, Error, "counted-twice", t("something that is contained in another row is counted again", "已含于另一项的影响被重复计入", "JCGM 100, 4.3.10", "the rows are about different indications", "两行针对不同的示值"), Look(rows::counted_again)),
    rule(33, Warning, "specification-parts", t("parts of a specification were added to the specification", "技术指标之外又计其组成部分", "JCGM 100, 4.3.10", "the specification excludes them in words", "技术指标明确不包括"), Slip),
    rule(34, Error, "no-resolution", t("the resolution of the calibrated instrument is in no row", "未计被校仪器的分辨力", "ILAC-P14:09/2020, 4.3", "the repeatability contains it", "重复性已包含分辨力"), Look(words::no_resolution)),
    rule(35, Error, "no-repeatability", t("the repeatability of the calibrated instrument is in no row", "未计被校仪器的重复性", "ILAC-P14:09/2020, 4.3", "it is below the resolution, and that is shown", "小于分辨力且已证明"), Look(words::no_repeatability)),
    rule(36, Warning, "no-drift", t("drift of the reference since its calibration is in no row", "未计标准器的漂移或稳定性", "JCGM 100, 4.3.1; EA-4/02, 4", "its certificate covers the interval", "证书不确定度已含稳定性"), Look(words::no_drift)),
    rule(37, Warning, "no-temperature", t("temperature matters to the quantity and is in no row", "被测量随温度变化而未计温度影响", "JCGM 100, F.2.4", "it was corrected, and the rest is negligible", "已修正且剩余可忽略"), Look(words::no_temperature)),
    rule(38, Warning, "bias-kept", t("a correction is known and not applied", "已知修正值而未修正", "JCGM 100, 3.2.4, F.2.4.5", "U was enlarged in a way that is stated", "已按说明扩大 U"), Look(words::known_bias)),
    rule(39, Error, "few-degrees", t("k = 2 at fewer than ten effective degrees of freedom", "有效自由度小于 10 却取 k = 2", "JCGM 100, G.4.2, table G.2", "the laboratory states k and not a probability", "只声明 k 而不声明包含概率"), Look(whole::two_at_few)),
    rule(40, Error, "freedom-wrong", t("ν_eff is outside the range between the smallest ν and the sum of all", "有效自由度超出最小自由度与总和之间的范围", "JCGM 100, G.4.1", "inputs are correlated, and another formula was used", "输入量相关，采用了其他公式"), Look(whole::freedom)),
    rule(41, Warning, "freedom-up", t("ν_eff was rounded up", "有效自由度向上取整", "JCGM 100, G.4.1, note 1", "k was interpolated", "k 由内插得到"), Slip),
    rule(42, Warning, "freedom-correlated", t("Welch–Satterthwaite was used with correlated inputs", "输入量相关却用 Welch–Satterthwaite 公式", "JCGM 100, G.4.1", "the correlation is negligible", "相关性可忽略"), Look(whole::freedom_of_correlated)),
    rule(43, Warning, "rectangle-dominates", t("one rectangle dominates, and k = 2 was used", "单一矩形分布占优却取 k = 2", "EA-4/02 M:2022, S9.14; JJF 1059.1-2012, 4.5", "k = 2 is usual under JJF 1059.1, where no probability is then stated", "JJF 1059.1 允许取 k = 2，此时不声明包含概率"), Look(whole::rectangle)),
    rule(44, Warning, "level-mixed", t("k and the stated coverage probability do not belong together", "k 与所述包含概率不相符", "JCGM 100, G.3.2; EA-4/02, E", "the difference does not reach the printed digits", "差别不影响所报告的数字"), Slip),
    rule(45, Warning, "k-alone", t("k is stated without a probability, or U without k", "只有 k 而无包含概率，或 U 无 k", "JCGM 100, 7.2.3; ILAC-P14, 5.4", "JJF 1059.1 asks for k alone where it is 2 or 3", "JJF 1059.1 对 k = 2 或 3 只要求注明 k"), Look(whole::factor_alone)),
    rule(46, Error, "unit-of-contribution", t("a factor of units is lost between c·u and y", "分量与 y 的单位换算有误", "JCGM 100, 5.1.3", "the unit is printed for another column", "单位属于另一栏"), Slip),
    rule(47, Error, "relative-and-absolute", t("relative and absolute figures are mixed in one sum", "相对量与绝对量混合合成", "JCGM 100, 5.1.6", "the estimate is one, so that both are the same", "估计值为 1，两者相同"), Slip),
    rule(48, Warning, "angle-unit", t("degrees stand where radians belong", "应为弧度处用了度", "JCGM 100, 5.1.3", "the coefficient holds the conversion", "灵敏系数已含换算"), Slip),
    rule(49, Error, "relative-sum", t("relative uncertainties were added in squares although the model is no product of powers", "模型不是幂积，却按相对不确定度合成", "JCGM 100, 5.1.6", "the sum in the model is a small correction", "模型中的和项只是小修正"), Look(whole::relative_sum)),
    rule(50, Warning, "of-full-scale", t("percent of full scale and percent of reading are exchanged", "混淆满量程百分数与读数百分数", "JCGM 100, 4.3", "the reading is full scale", "读数即满量程"), Slip),
    rule(51, Warning, "no-sensitivity", t("a sensitivity is zero at the estimate though the quantity matters", "估计值处灵敏系数为零，但该量有影响", "JCGM 100, 5.1.2, note; F.2.4.4; JCGM 101, 5.6", "the second order is negligible", "二阶项可忽略"), Look(rows::no_sensitivity)),
    rule(52, Warning, "second-order", t("terms of second order are more than 5 % of u_c²", "二阶项超过 u_c² 的 5 %", "JCGM 100, 5.1.2, note", "a Monte Carlo calculation validates the result", "已用蒙特卡洛法验证"), Look(records::second_order)),
    rule(53, Warning, "not-validated", t("the interval of Monte Carlo is another one", "与蒙特卡洛区间不一致", "JCGM 101, 8", "the tolerance δ was chosen too small", "δ 取得过小"), Look(records::not_validated)),
    rule(54, Warning, "uncertain-divisor", t("a divisor is uncertain by more than a fifth of itself", "除数的相对不确定度超过 20 %", "JCGM 101, 5.11", "the result is not linear in it anyway, and Monte Carlo was used", "已用蒙特卡洛法"), Look(rows::near_singular)),
    rule(55, Warning, "beyond-a-limit", t("y ± U goes beyond a physical limit", "y ± U 超出物理极限", "JCGM 100, F.2.4; JCGM 101, 8.1", "the quantity may be negative, as a difference may", "该量可为负，如差值"), Look(whole::below_zero)),
    rule(56, Warning, "correlation-ignored", t("inputs that share a certificate or an instrument are taken as independent", "共用证书或仪器的输入量按不相关处理", "JCGM 100, 5.2.4", "what they share is negligible in their uncertainties", "共同部分可忽略"), Look(whole::common_reference)),
    rule(57, Error, "correlation-impossible", t("the correlations are impossible together", "相关系数不可能同时成立", "JCGM 100, 5.2.2", "they were rounded", "经过修约"), Look(whole::not_a_matrix)),
    rule(58, Warning, "cancelled", t("full correlation cancels the uncertainty of a difference", "差值中取完全相关而相互抵消", "JCGM 100, 5.2.4", "both come from one standard, and that is recorded", "两者来自同一标准且有记录"), Look(whole::common_in_a_difference)),
    rule(59, Warning, "correlation-of-a-difference", t("a positive correlation in a difference is left out, which makes U too large", "差值中漏计正相关，U 偏大", "JCGM 100, 5.2.2", "it is on the safe side", "偏保守"), Look(whole::left_out_of_a_difference)),
    rule(60, Warning, "not-in-the-model", t("the model has an input that no row has, or the table a row that the model lacks", "模型与表中的输入量不一致", "JCGM 100, 4.1.2", "the row adds a doubt to another input", "该行是另一输入量的影响因素"), Look(whole::not_in_the_model)),
    rule(61, Warning, "fit-without-covariance", t("coefficients of a fit are used without their covariance", "使用拟合系数而未计协方差", "JCGM 100, H.3", "the fit is centred where it is used", "拟合已在使用点处中心化"), Look(words::fit_without_covariance)),
    rule(62, Warning, "lack-of-fit", t("a fitted model does not describe its data, and has no term for that", "拟合不足而未计入", "JCGM 100, H.3.6", "χ²/ν is near one", "χ²/ν 接近 1"), Look(records::lack_of_fit)),
    rule(63, Error, "digits", t("U has more than two significant digits", "U 的有效数字多于两位", "JCGM 100, 7.2.6; ILAC-P14, 5.5", "the figure is used in a further calculation", "该数值用于后续计算"), Look(whole::digits)),
    rule(64, Warning, "one-digit", t("U has one digit, and that is 1 or 2", "U 只有一位且首位为 1 或 2", "JJF 1059.1-2012, 5.3.8.1", "other guides allow one digit", "其他规范允许一位"), Look(whole::one_digit)),
    rule(65, Error, "last-places", t("the last places of y and U differ", "y 与 U 的末位未对齐", "JCGM 100, 7.2.6; JJF 1059.1-2012, 5.3.8.3", "U is relative, or y is quoted from elsewhere", "U 为相对值，或 y 引自他处"), Look(whole::last_places)),
    rule(66, Warning, "rounded-down", t("rounding lowered U by more than 5 %, or against the stated rule", "修约使 U 减小超过 5 %，或违反所述修约规则", "EA-4/02 M:2022, 6.3", "the printed u_c is rounded itself", "所列 u_c 本身已修约"), Look(whole::rounded_down)),
    rule(67, Warning, "rounded-twice", t("U follows from rounding twice", "U 经连续修约得到", "GB/T 8170-2008, 3.3; ISO 80000-1, B.3", "U was computed from the rounded u_c", "U 由修约后的 u_c 计算"), Look(whole::twice_rounded)),
    rule(68, Warning, "sign", t("a lone U has a ± before it", "单独的 U 前加了 ±", "JJF 1059.1-2012, 5.3.7", "other guides allow it", "其他规范允许"), Look(words::sign_before_u)),
    rule(69, Warning, "unit-of-U", t("U is in percent, or another unit than y, without saying of what", "U 的单位与 y 不同，或为百分数而未说明", "JCGM 100, 7.2.4", "it is relative to y, which is said elsewhere", "为相对 y 的值，另有说明"), Look(whole::units_of_result)),
    rule(70, Error, "below-cmc", t("U is smaller than the CMC", "U 小于 CMC", "ILAC-P14:09/2020, 5.4", "the CMC is that of another range", "该 CMC 属于其他量程"), Look(whole::below_cmc)),
    rule(71, Warning, "equals-cmc", t("U equals the CMC although the instrument adds to it", "U 恰等于 CMC，而被校仪器另有贡献", "ILAC-P14:09/2020, 5.4", "U was raised to the CMC, as it must be", "U 按规定提高到 CMC"), Look(whole::equals_cmc)),
    rule(72, Warning, "cmc-level", t("the CMC is stated for another k or range", "CMC 的 k 或量程不同", "ILAC-P14:09/2020, 4.2", "the scope says so", "认可范围已说明"), Look(words::cmc_level)),
    rule(73, Error, "no-decision-rule", t("conformity is stated without a decision rule", "作出符合性判定而未注明判定规则", "ISO/IEC 17025:2017, 7.8.6", "the rule is in the standard that is cited", "所引标准已规定判据"), Look(words::conformity_without_rule)),
    rule(74, Warning, "test-ratio", t("the tolerance is less than three or four times U", "允差与 U 之比小于 3（或 4）", "JJF 1094-2002, 5.3; ILAC-G8:09/2019", "a guard band is used", "采用了保护带"), Look(whole::test_ratio)),
    rule(75, Information, "one-dominates", t("one contribution is more than 80 % of u_c²", "单个分量占 u_c² 的 80 % 以上", "JCGM 100, G.2", "it cannot be improved", "无法改进"), Look(rows::dominant)),
    rule(76, Information, "negligible", t("several contributions are each less than 1 % of u_c²", "多个分量各不足 u_c² 的 1 %", "JCGM 100, 3.4.4", "together they may be more than 5 %", "合计可能超过 5 %"), Look(rows::negligible)),
    rule(77, Warning, "below-reference", t("U is smaller than the uncertainty of the reference in it", "U 小于标准器的不确定度", "JCGM 100, 4.3.3; ILAC-P14", "the reference enters with a small coefficient", "标准器的灵敏系数很小"), Look(whole::below_reference)),
    rule(78, Warning, "beyond-belief", t("U relative to y is below 1e-9 or above 100 %", "相对不确定度小于 1e-9 或大于 100 %", "JCGM 100, 7.2", "y is a difference near zero", "y 为接近零的差值"), Look(whole::beyond_belief)),
    rule(79, Warning, "out-of-range", t("a standard was used outside its calibrated range", "在标准器校准范围之外使用", "ISO/IEC 17025:2017, 6.4", "an extrapolation with its uncertainty is in the budget", "已计入外推的不确定度"), Look(records::out_of_range)),
    rule(80, Error, "expired", t("a certificate had expired on the day of measurement", "测量时证书已过期", "ISO/IEC 17025:2017, 6.4.7", "the interval was extended, and that is recorded", "复校间隔已延长并有记录"), Look(words::expired)),
    rule(81, Warning, "other-value", t("a figure is not that of the certificate which it cites", "数值与所引证书不符", "ISO/IEC 17025:2017, 7.5", "it was corrected for conditions", "已按条件修正"), Slip),
    rule(82, Warning, "typed-in", t("a number stands where a formula belongs, or a row is hidden", "应为公式处为固定数值，或行被隐藏", "ISO/IEC 17025:2017, 7.11", "it was frozen on purpose", "有意固定"), Look(rows::hidden)),
    rule(83, Warning, "old-budget", t("the budget is older than its method or its standards", "评定早于方法修订或标准器复校", "ISO/IEC 17025:2017, 7.6", "nothing in it has changed", "内容未受影响"), Look(records::old_budget)),
    rule(84, Warning, "comparison", t("|E_n| is above one in a comparison with this U", "比对结果 |E_n| 大于 1", "ISO/IEC 17043; ISO 13528", "the transfer standard was unstable", "传递标准不稳定"), Look(words::comparison)),
    rule(85, Warning, "check-standard", t("the check standard scatters more than twice as much as predicted", "核查标准的标准偏差超过预期两倍", "ISO/IEC 17025:2017, 7.7", "the check standard itself is poor", "核查标准本身较差"), Look(records::check_standard)),
    rule(86, Error, "no-coefficient", t("u in the unit of another quantity is summed without a sensitivity coefficient", "单位属于另一种量的标准不确定度未乘灵敏系数便参与合成", "JCGM 100, 5.1.2, 5.1.3", "the coefficient is one in the units of the table", "按表中单位灵敏系数恰为 1"), Look(rows::without_coefficient)),
];
