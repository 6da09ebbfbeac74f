//! The faults of a budget file, each with its stable code and its explanation.

use gumption_fault::codes;

codes! {
MISSING_KEY = "B0109", "a required key is missing", "缺少必需的键",
"The table says too little to be understood without the key.";

UNIT = "B0111", "a unit is not known", "无法识别的单位",
"Units are SI units with their prefixes and the usual others, combined by `*`, `/` and `^`: `mA/V`, \
`m/s^2`, `µm/m`, `°C`, `ppm`, `%`. A file may define its own in `[unit]`: `div = \"0.5 mV\"`.";

UNIT_CLASH = "B0112", "a unit does not fit", "单位不合适",
"The unit is of another dimension than the quantity it is used for, for example a half-width in mA for an \
input in V. The number of a dimension-one amount such as `50 ppm` is taken relative to the value. `°C` is a point \
on a scale where a value or limit is meant, and a difference in uncertainties: of a quantity in K, a limit in °C \
is refused, because 1 °C may be 1 K or 274.15 K. Revolutions are an angle of 2π in r/min and °/s, and counted in \
Hz and seconds: amounts are not carried from one to the other.";

RELATIVE_UNCLEAR = "B0113", "it is not clear of what a percentage is taken", "相对量的含义不明确",
"For a quantity that itself has dimension one, `\"0.1 %\"` could be 0.001 of the unit or 0.1 % of the value. \
Write a plain number in the unit of the quantity; for an input, `relative = true` makes it a fraction of the value, \
and `relative = false` an amount as it stands.";

BAD_NAME = "B0114", "a name cannot be used in a formula", "名称不能用于公式",
"Names of inputs, constants, measurands and sources begin with a letter and go on with letters, digits and \
underscores; letters of every script are welcome.";

NAME_TWICE = "B0115", "a name is used twice", "名称重复使用",
"Inputs, constants and measurands share one space of names; the components of an input need different names.";

CSV = "B0116", "a CSV file does not hold what is asked for", "CSV 文件中没有所需的数据",
"The file needs a first line of column names, and a number in every row of the chosen column.";

NO_DOUBT = "B0201", "an input has no uncertainty", "输入量未给出不确定度",
"Every input needs at least one component of uncertainty. A number that is exact by definition belongs into \
`[constant]`, so that the reader sees the intention.";

TWO_WAYS = "B0202", "an uncertainty is stated in two ways", "不确定度以不止一种方式给出",
"A component states its uncertainty in exactly one way: `u`, `half_width`, `limits`, `plus` and `minus`, \
`certificate`, `readings`, … Two reasons to doubt one input are two entries of `components`.";

NOT_POSITIVE = "B0203", "a number must be greater than zero", "数值必须大于零",
"Standard uncertainties, half-widths, coverage factors, steps and scales are greater than zero.";

PROBABILITY = "B0204", "a probability is not between 0 and 1", "概率不在 0 与 1 之间",
"Coverage probabilities are numbers between 0 and 1: `p = 0.95`, not 95.";

NO_COVERAGE_FACTOR = "B0205", "an expanded uncertainty without coverage factor", "扩展不确定度未注明包含因子或包含概率",
"From U alone no standard uncertainty follows: it is U/k, and k may be 2, 1.96, 2.58, 3 or 1.65. Write the k of \
the certificate, or its coverage probability p. It is never guessed.";

K_AND_P = "B0206", "coverage factor and coverage probability contradict each other", "包含因子与包含概率相互矛盾",
"With both k and p stated they must belong together for the stated degrees of freedom, to the digits that \
certificates print. Leave out the one that is not on the certificate.";

MODIFIER = "B0207", "a key does not go with the way the uncertainty is stated", "该键与不确定度的给出方式不相配",
"Some keys only make sense together with others: `beta` with a trapezoidal distribution, `d` with a \
curvilinear trapezoid, `of` and `autocorrelated` with readings, `p` with a normal half-width, `sensitivity` with `source`.";

TOO_FEW_READINGS = "B0208", "too few readings", "读数太少",
"A standard deviation needs at least two readings. With one reading state `pooled = { s = …, dof = … }` from \
earlier work, or a resolution and a repeatability of other origin (GUM 4.2.4).";

NO_SCATTER = "B0209", "all readings are the same", "读数没有分散性",
"Equal readings do not mean that there is no uncertainty, but that it is below the resolution. State the \
resolution as another component: `{ step = … }`; the scatter is then left to it.";

DOF = "B0210", "degrees of freedom are not usable", "自由度不可用",
"Degrees of freedom are greater than zero (or `inf`). State them once: as `dof`, or as the reliability Δu/u of \
the standard uncertainty, from which ν = ½(Δu/u)^-2 (GUM G.4.2). To scale a t distribution to its standard \
deviation it must have one, which takes ν > 2.";

LIMITS = "B0211", "limits are in the wrong order or do not contain the value", "上下限颠倒或不包含估计值",
"`limits` are the lower and upper limit of the quantity itself. For limits of a deviation write `half_width`, or \
`plus` and `minus`.";

NO_ESTIMATE = "B0212", "an input has no value", "输入量或常数没有给出值",
"The estimate is `value`, or follows from readings or from a distribution with a stated location. Limits of \
deviations and certificate uncertainties say nothing about it.";

TWO_ESTIMATES = "B0213", "the value is stated in two ways", "估计值以不止一种方式给出",
"The expectation of the stated distribution, or the mean of the readings, is another number than `value`. Leave \
out one, or make the deviation an input of its own in the model.";

RELATIVE_TO_ZERO = "B0214", "an uncertainty relative to zero", "对零值给出了相对不确定度",
"A relative uncertainty of an input whose value is zero is zero. State it absolutely.";

DISTRIBUTION = "B0215", "parameters of a distribution are missing or do not fit", "概率分布的参数缺失或不合适",
"See `gumption explain` with the name of the distribution for its parameters.";

COUNT = "B0216", "a count is not usable", "计数值不可用",
"Counts are whole numbers, successes do not exceed trials, and with the prior `reciprocal` the count must not be 0.";

VECTOR = "B0217", "numbers and elements of a vector do not match", "数值与向量的元素不对应",
"An input with `values` is a vector: lists per element need as many entries as there are values, `value` and \
`values` exclude each other, and ways that also determine the estimate are for scalar inputs.";

SERIAL = "B0218", "readings cannot be corrected for autocorrelation", "读数无法作自相关修正",
"The correction estimates the autocorrelation from the readings themselves and needs at least ten of them, which \
must not drift so much that less than two independent ones remain.";

GROUPS = "B0219", "groups of readings are not usable", "分组读数不能用于方差分析",
"An analysis of variance compares groups: two or more of them, one of which at least has two readings that \
differ. In nested groups one group at least has two subgroups. A difference between groups is not seen in a \
single group; state its readings as `readings`.";

OUTLIER_TEST = "B0220", "a test for outliers cannot say anything", "离群值检验无法作出判断",
"Dixon's test is for 3 to 30 readings, that of Grubbs for 3 or more. Four mean deviations need 4 readings, and three \
standard deviations need 11: with fewer no reading can be so far from the mean. `significance` is for the tests of Grubbs \
and Dixon.";

TWO_TURNS = "B0225", "readings of a direction are written on two turns", "方向读数跨越整圈的起点",
"359.8° and 0.1° are 0.3° apart, and their arithmetic mean of 180° points the other way. Readings of one direction, all \
within half a turn of one another, are written on one turn: -0.2 in place of 359.8, or 360.1 in place of 0.1.";

COVERAGE_FACTOR = "B0226", "a number is no coverage factor", "该数值不可能是包含因子",
"Coverage factors are mostly 2, or 1.65 to 3; a t distribution of few degrees of freedom has larger ones, at most 14 for \
95.45 %. What is between 0.68 and 1, or between 50 and 100, is a coverage probability: `p = 0.95` in a certificate, \
`coverage_probability = 0.95` in the conventions.";

UNKNOWN_NAME = "B0301", "a name is not known", "所引用的名称未知",
"A correlation, a joint input, a claim or a series refers to an input, source or component that the file does not have.";

NOT_A_CORRELATION = "B0302", "a correlation coefficient is not between -1 and 1", "相关系数不在 -1 与 1 之间",
"Correlation coefficients lie between -1 and 1; a covariance belongs into `[[joint]]` with `covariance`.";

PAIR_TWICE = "B0303", "a pair is correlated twice", "同一对量的相关性重复给出",
"The correlation of two quantities is stated once; `between = [\"a\", \"b\"]` and `[\"b\", \"a\"]` are the same pair.";

SELF_PAIR = "B0304", "a quantity is correlated with itself", "给出了量与其自身的相关系数",
"The correlation of a quantity with itself is 1 and cannot be stated.";

NOT_SEMIDEFINITE = "B0305", "the correlations contradict one another", "各相关系数相互矛盾",
"No quantities can have these correlation coefficients together: a combination of them would have a negative \
variance (the matrix has a negative eigenvalue). Often a sign is wrong, or coefficients were rounded: three \
quantities with r = 0.9, 0.9 and -0.9 cannot exist.";

JOINT = "B0306", "a joint input is not usable", "联合输入量的数据不可用",
"`[[joint]]` names inputs whose readings were taken together (equally many for each), or states their covariance \
or correlation matrix: symmetric, with one row for each input.";

UNATTAINABLE = "B0307", "a correlation cannot be attained with these distributions", "这些概率分布达不到所给的相关系数",
"Two quantities of different distributions cannot have every correlation coefficient: an exponential and a normal \
variable, for example, reach at most 0.90. The Monte Carlo method needs a joint distribution that exists.";

CORRELATION_TWICE = "B0308", "a quantity is in two joint statements", "同一个量的相关性在两处给出",
"A component is correlated by `[[correlation]]` or by one `[[joint]]`, not by both.";

UNUSED = "B0401", "something is stated and not used", "给出的内容未被使用",
"An input, a constant or a source that no measurand depends on is a sign that the formula or a name is wrong.";

NO_MEASURAND = "B0402", "there is nothing to evaluate", "文件中没有可评定的内容",
"A budget needs at least one `[measurand.NAME]` with its `model`, and the inputs that the model names.";

CLAIM = "B0403", "a claim says too little, too much or contradicts itself", "声称值不完整、多余或自相矛盾",
"A `[claim]` states at least one number of somebody's certificate. With several measurands it names its own.";

SERIES = "B0404", "a series is not usable", "系列数据不可用",
"`[series]` has `columns`, the names of inputs (and `label`, `claim.value`, `claim.U` …), and `rows`, each with one \
entry per column. In the results of a batch all rows have the columns of the first: one that leaves a component out has no place \
below its contributions.";

CONVENTIONS = "B0405", "conventions contradict one another", "约定不可用或相互矛盾",
"State `coverage_factor` (a number) or `coverage_factor_from` (a rule), not both.";

TRIALS = "B0406", "the settings of the Monte Carlo method do not fit", "蒙特卡洛法的设置不合适",
"`trials` is a whole number of at least 1000, or \"adaptive\"; `procedure`, `digits` and `max_trials` belong to \
\"adaptive\".";

TOLERANCE = "B0501", "a tolerance is not usable", "容许限不可用",
"`[conformity]` states a lower or an upper tolerance limit, or both with the lower one first; acceptance limits are as \
many. Two assessments of one measurand have a `name` each.";

DECISION_RULE = "B0502", "a decision rule is missing or contradicts itself", "判定规则缺失或自相矛盾",
"A statement of conformity needs the rule by which uncertainty was taken into account (ISO/IEC 17025 7.8.6): `rule`, or \
`acceptance` limits, or the probabilities or risks from which they follow. A guard band is an amount or a multiple of U. A global \
risk is an average over all items and needs `process`, what is known of them before one is measured (JCGM 106 clause 9).";

PROCESS = "B0503", "the knowledge of the process is not usable", "过程信息不可用",
"`process` states a distribution with its parameters, located where the items are, or `in_tolerance_probability`, which \
needs both tolerance limits.";

DETECTION = "B0504", "characteristic limits cannot be found from this", "由所给信息无法求得特征限",
"`[detection]` names in `gross` the input that carries the value of the measurand, such as the gross counts; `alpha` and \
`beta` are probabilities below one half, or `k_alpha` and `k_beta` the quantiles that belong to them.";

FIT = "B0601", "a fit says too little or too much", "拟合的描述不完整或有多余",
"`[fit.NAME]` needs `data` and one formula: `model = \"y = a + b*x\"` with a column of the data on the left, or \
`polynomial` with `response` and `predictor`. Every name of the formula that is neither a column nor a constant is a \
parameter; with a table of parameters, only those that it lists.";

FIT_COLUMNS = "B0602", "the columns of a fit do not match", "拟合数据的各列不对应",
"A point of a fit has one value in every column, and one in every list of uncertainties, weights or correlation coefficients.";

FIT_ERRORS = "B0603", "the uncertainties of the data of a fit are not usable", "拟合数据的不确定度不可用",
"Where uncertainties are stated, those of the response must be greater than zero, unless the predictor has one that can take \
up the distance of the point from the curve. `scale = \"stated\"` takes them as known, so that some must be stated; \
`scale = \"residuals\"` takes them as known up to a factor.";

FIT_START = "B0604", "a nonlinear fit has no start values", "非线性拟合缺少起始值",
"A formula that is not linear in its parameters, such as `y = a*exp(-x/tau)`, is solved by a search. It begins at the `start` \
of each parameter, which must be roughly right: `tau = { start = 2, unit = \"s\" }`.";

FIT_POINTS = "B0605", "a fit has too few points", "拟合的数据点太少",
"There must be at least as many points as parameters; more where the residuals are to tell the uncertainty.";

FIT_INDISTINCT = "B0606", "the data do not tell the parameters apart", "数据不能区分各拟合参数",
"Some parameters can be changed together without any change of the curve at the points: two columns are proportional, all \
values of a predictor are the same, or the formula has one parameter too many. Leave out one of them, or add points.";

FIT_FAILED = "B0607", "a fit was not found", "拟合未求得解",
"The search for the parameters ended without a minimum, or the formula has no finite value at its start. Choose other start \
values, and check that the formula can describe the data.";

RESIDUAL_OF = "B0608", "the scatter of a fit cannot be used here", "此处不能使用拟合的残差标准差",
"`residual_of` is the scatter of a further reading as seen from the residuals of a fit. The fit must leave the scatter of its \
response to the residuals, without stated uncertainties; else the uncertainty of the reading is known already.";

FROM = "B0701", "where an input comes from is not clear", "输入量的来源不明确",
"`from` names another `budget`, or the file of a saved `result`, and the `measurand` in it. The value and its \
uncertainty are stated there; beside `from` an input may only state `unit`, `description` and `group`. A further \
reason for doubt, such as the drift since then, is an input of its own that the model adds.";

FROM_REFUSED = "B0702", "a budget that this one uses has faults of its own", "所引用的评定文件有错误",
"The other file is checked like this one; its own faults are shown after those of this file.";

FROM_CIRCLE = "B0703", "budgets use one another in a circle", "评定文件循环引用",
"A result cannot depend on itself. The message lists the files of the circle.";

FROM_MEASURAND = "B0704", "the other file has no such result", "不能确定所引用文件中的结果",
"`measurand` is the name of a measurand in the other file, `row` the label (or the number) of a row of its series.";

SAVED_RESULT = "B0705", "a file does not hold saved results", "该文件不是保存的结果文件",
"`from = { result = … }` reads what `gumption eval FILE --save saved.json` wrote (`gumption schema result`). Another \
budget is read with `from = { budget = … }`.";

SAVED_STALE = "B0706", "a file has changed since results were saved", "结果保存后文件已被修改",
"A saved result and another file state the same component (the same file and name) differently, so that their \
correlation is not known. Evaluate the changed budget again and save its results anew.";

FROM_DEEP = "B0707", "too many budgets use one another", "评定文件逐层引用过深",
"A chain of budgets may be 32 files deep. Save the result of one in between (`gumption eval FILE --save saved.json`) and go \
on from it with `from = { result = … }`.";

DIGITAL_CERTIFICATE = "B0708", "a digital certificate is not usable", "数字校准证书不可用",
"A certificate named by `dcc` is XML in the form of the DCC 2.x or 3.x, with quantities of the D-SI: numbers with a decimal \
point, units such as `\\milli\\volt`, lists of one length, k of at least 1, p between 0 and 1, and an uncertainty of the \
result that is wanted.";
}

#[cfg(test)]
mod tests {
    use super::CODES;

    #[test]
    fn codes_are_unique_and_ascending() {
        assert!(CODES.windows(2).all(|pair| pair[0].id < pair[1].id));
    }
}
