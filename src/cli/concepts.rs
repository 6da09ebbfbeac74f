//! Words of the trade that `gumption explain` knows, besides what the library lists itself.

/// A concept and its explanation.
pub(super) struct Concept {
    pub(super) name: &'static str,
    pub(super) aliases: &'static [&'static str],
    pub(super) title: &'static str,
    pub(super) text: &'static str,
}

/// All concepts, in alphabetical order.
#[rustfmt::skip] // Texts read better unbroken.
pub(super) const CONCEPTS: &[Concept] = &[
    Concept {
        name: "adaptive",
        aliases: &["stein", "jcgm101", "procedure", "adaptive Monte Carlo", "numerical tolerance", "not_converged", "自适应"],
        title: "how many Monte Carlo trials are enough",
        text: "With trials = \"adaptive\" (or --trials adaptive) Monte Carlo runs until estimate, standard uncertainty and both ends of the symmetric interval are stable to a numerical tolerance δ: half a unit of the last of the one or two digits of u(y) that are asked for by `digits` (JCGM 101, 7.9.2).\n\nTrials are run in batches of at least 10 000. procedure = \"stein\" (the default) takes the scatter between the first ten batches, computes from it once how many batches are needed, and runs them; all results are then within δ with a probability of at least 95 % (Wübbeler, Harris, Cox, Elster 2010). procedure = \"jcgm101\" adds batch after batch until twice the standard error of every result is at most δ (7.9.4). Because it looks again after each batch, a scatter that is small by chance ends it too early, and it promises no probability. That is why it is not the default.\n\nThe run stops in any case at `max_trials` (100 million if not stated); the report then says that the tolerance was not reached.",
    },
    Concept {
        name: "anova",
        aliases: &["analysis of variance", "groups", "between", "nested", "reproducibility", "方差分析"],
        title: "readings in groups: days, operators, laboratories (GUM H.5)",
        text: "Readings of one day may lie closer together than those of different days. `groups` takes one list for each group, `group_summary` their means, standard deviations and numbers of readings; a CSV file names the group of each row. The estimate is the mean of all readings.\n\nbetween = \"include\" (default): the variance between groups, (MS_between − MS_within)/n₀ with n₀ = (N − Σn²/N)/(J − 1), is part of u. Of equally many readings in J groups this is s(group means)/√J with ν = J − 1; of other numbers u² is a combination of both mean squares, and ν follows from Welch–Satterthwaite. Where the variance comes out negative it is zero, and the readings are pooled. \"none\": all readings are of one population, ν = N − 1. \"test\": as \"include\" if the F test at the level `significance` (0.05) finds a difference, else as \"none\". An F test that finds nothing does not prove that there is nothing: \"include\" is the cautious choice.\n\nof = \"single\" gives the reproducibility of one later reading in any group, of = 3 that of the mean of three in one group.\n\nLists in lists of lists, or two group columns, are nested: readings in subgroups of groups, with the expected mean squares of unbalanced designs. A difference that is not there simplifies the design, and its sum of squares is pooled.\n\nFigures for claims: V.anova.ss_between, df_, ms_, the same of within, F, p, F_critical, F(0.95), F(0.975), F(0.99), n_0, s_means, s_a and s_b (roots of the mean squares), s_B (between groups), s_R (reproducibility), r_squared, residual_sd; of nested groups ss_groups, ss_subgroups, F_groups, F_subgroups, s_groups, s_subgroups, s_within and so on.",
    },
    Concept {
        name: "bias",
        aliases: &["systematic error", "systematic effect", "correction", "offset", "zero offset", "zero-rate output", "偏倚", "偏移", "零偏", "零位", "系统误差", "系统影响", "修正值"],
        title: "a systematic error, its correction, and the output of a sensor at zero (VIM 2.17, 2.18, 4.20)",
        text: "A systematic error that is known is corrected (GUM 3.2.3), and what remains of it is the uncertainty of the correction: an input of its own in the model, y = x + d, with the correction as its `value` and with its own u. Where nothing is known of it but limits, its value is 0 and the limits are a `half_width`. A known bias that is left in y cannot be made up for by a larger u (GUM F.2.4.5 says what a report then states).\n\nAn error that several inputs share, such as that of one standard, is a `source`: see `gumption explain shared-source`.\n\nThe bias of a gyro or an accelerometer is its output at zero rate or acceleration: a coefficient like the scale factor, which a calibration finds from turned positions. `gumption new FILE --procedure gyro-bias`, or accelerometer-six-positions, begins such an experiment; `gumption allan` tells its instability from a recording at rest.",
    },
    Concept {
        name: "chain",
        aliases: &["from", "result", "saved result", "save", "traceability", "溯源", "引用结果"],
        title: "results of other budgets as inputs",
        text: "from = { budget = \"other.toml\", measurand = \"Y\" } takes the formulas and the components of another budget into this one, so that both methods see the whole chain. A component is known by the file that states it and by its name there: what two inputs take from one file, or two budgets from a third, is one component, and the inputs are correlated as they must be. Components of two files are never taken for the same.\n\nfrom = { result = \"saved.json\", measurand = \"Y\" } takes a result that `gumption eval FILE --save saved.json` wrote: y + Σ c·E over the same components. Correlations survive saving; the curvature of the model does not, and a remark says so where Monte Carlo did not validate the result. A saved result that the budget beside it has outrun is refused.\n\nCoverage probability, profile and Monte Carlo settings are those of the file that is evaluated.",
    },
    Concept {
        name: "claim",
        aliases: &["claims"],
        title: "figures that somebody states, compared and never used",
        text: "A [claim] holds what a certificate or a paper says: value, u, U, k, dof, intervals, correlations, figures of single inputs. The report puts each figure beside the one obtained. They agree when they differ by at most half a unit of the last digit claimed, or by the `tolerance` that the file states.\n\nA claimed U with its own k is compared with that k times u, so that a difference in U shows a difference in u and not in the convention for k. `method` says which result a claim is about; without it GUM is judged and Monte Carlo is shown beside.",
    },
    Concept {
        name: "complex-quantities",
        aliases: &["complex", "cmul", "cdiv", "polar", "S-parameters", "复数", "复量"],
        title: "quantities with a real and an imaginary part (JCGM 102)",
        text: "A complex quantity is a vector of two elements, the real and the imaginary part. Sums, differences and real factors work as for every vector; cmul, cdiv, conj, csqrt and cexp are the complex operations, cabs and carg give modulus and phase, polar(r, phi) makes a quantity of them.\n\nA measurand that is a vector is reported element by element, with the correlation of the elements and their joint coverage region. Real and imaginary part of one reading are correlated: state it by [[correlation]] or [[joint]].\n\nModulus and phase are poor measurands where the modulus is not several times its u: the modulus is then biased, and the phase goes round. Report real and imaginary part there (JCGM 102, 9.3).",
    },
    Concept {
        name: "conformity",
        aliases: &["risk", "decision rule", "mpe", "maximum permissible error", "guard band", "tolerance", "符合性", "合格判定"],
        title: "decision rules and risks (JCGM 106, ISO/IEC 17025 7.8.6)",
        text: "[conformity] states the tolerance and the decision rule. The acceptance limits follow from the rule: on the tolerance limits (simple), inside by a guard band w (guarded-acceptance; ILAC-G8 with w = U), outside (guarded-rejection), or both, undecided between (non-binary; ISO 14253-1 with 95 %; JJF 1094 where U > MPEV/3).\n\np_c is the probability that the measured item conforms, from the result alone or, where `process` says what is known of the items, by Bayes' theorem. Its complement is the specific consumer's risk of an accepted item; p_c itself the specific producer's risk of a rejected one.\n\nR_C and R_P are probabilities over all items of the process: that an item does not conform and is accepted, and that it conforms and is rejected. cpfa is R_C over the probability of acceptance. C_m = T/(4u); TUR = T/(2U) = MPEV/U.\n\nA permissible risk may take the place of a rule: specific_consumer_risk and specific_producer_risk hold for an item measured just at the limit, global_consumer_risk and global_producer_risk for R_C and R_P, with the least guard band that keeps them (none where simple acceptance does).",
    },
    Concept {
        name: "copula",
        aliases: &["gaussian copula", "latent correlation"],
        title: "how Monte Carlo correlates inputs that are not normal",
        text: "A correlation coefficient and the distributions of two inputs do not determine their joint distribution. For normal inputs gumption draws from the multivariate normal distribution (JCGM 101, 6.4.8), for simultaneous readings from the multivariate t distribution (JCGM 102, 5.3.2), and for all other margins from a Gaussian copula: correlated normal variables, each transformed to the distribution of its input.\n\nThe transformation changes the correlation coefficient. The latent one is therefore solved for, so that the inputs themselves have the coefficient that the file states (the r of the GUM). Two distributions of different shape cannot reach every coefficient up to ±1; error B0307 names the limit.",
    },
    Concept {
        name: "correlation",
        aliases: &["correlated inputs", "correlation coefficient", "covariance", "相关"],
        title: "inputs that err together (GUM 5.2)",
        text: "Say it by its cause where you can: see `gumption explain shared-source`. Readings taken at the same time go into [[joint]]; the covariance of their means follows from them (GUM 5.2.3). A bare coefficient goes into [[correlation]], a matrix into [[joint]]. All coefficients together must be possible: the matrix must be positive semidefinite.\n\nu²(y) is then ΣΣ c_i c_j u(x_i, x_j) (GUM 5.2.2). Monte Carlo draws the inputs jointly: see `gumption explain copula`.",
    },
    Concept {
        name: "coverage-factor",
        aliases: &["k", "expanded uncertainty", "confidence", "confidence level", "level of confidence", "包含因子", "扩展不确定度", "包含概率", "置信概率", "置信水平"],
        title: "where k comes from (GUM 6 and annex G)",
        text: "U = k·u_c(y). coverage_factor_from in [conventions] names the rule:\n\n\"t\": the quantile of the t distribution with ν_eff degrees of freedom, of the normal distribution when ν_eff is infinite. ν_eff is cut to the next lower integer (GUM G.4.1) after rounding to two decimals, so that rounding errors take none away; degrees_of_freedom = \"real\" uses it as it is.\n\n\"output\" (the default of most profiles): as \"t\", unless one component that is neither normal nor t, or two rectangles together, make up nearly all of u(y) (the others at most 0.3 of it; or, for two rectangles, each of them more than all others together) and ν_eff is at least 50. Then k comes from the distribution of the linearised output, the dominant components convolved with a normal remainder: 1.65 for a rectangle alone and p = 95 %, where the normal factor 1.96 would reach beyond the rectangle. The profile EA takes the dominant components alone, as EA-4/02 does in its examples S9, S10 and S11.\n\n\"normal\": the normal quantile always.\n\ncoverage_factor = 2 fixes k; p is then whatever that k happens to cover, and the report says how much.",
    },
    Concept {
        name: "coverage-region",
        aliases: &["several measurands", "multivariate", "region", "ellipsoid", "jcgm102", "包含区域"],
        title: "several measurands and their joint region (JCGM 102)",
        text: "A file with several [measurand.NAME] gives, besides each result, the covariance and the correlation of all of them.\n\nTwo factors describe the joint coverage region for the GUM result: k_p of the ellipsoid, and k_q for simultaneous intervals y_j ± k_q·u_j (JCGM 102, 6.5). Neither is smaller than the k of a single measurand. For finite degrees of freedom k_q takes each measurand with its own ν_eff, and multiplies the probabilities of those that have no component in common. The ellipsoid follows from Hotelling's T² with the ν of the covariance matrix by Willink and Hall (2002), measurands of one kind in one unit, or from the ν_eff of each measurand where these ask for more. Monte Carlo gives the same factors from its trials and, for two or three measurands, the area or volume of the smallest region (7.7).\n\nWhere one measurand is a linear function of the others there is no such region, and the report says so.",
    },
    Concept {
        name: "degrees-of-freedom",
        aliases: &["welch-satterthwaite", "ws", "nu_eff", "ν_eff", "dof", "ν", "effective degrees of freedom", "freedom_refused", "few_degrees_of_freedom", "自由度", "有效自由度"],
        title: "how well u itself is known (GUM G.4)",
        text: "n readings give ν = n − 1. A component whose u is uncertain by Δu/u (`reliability`) has ν = ½(Δu/u)^-2 (GUM G.4.2). Most Type B components have ν = ∞.\n\nν_eff of u(y) follows from the Welch–Satterthwaite formula, u⁴(y) / Σ u_i⁴(y)/ν_i (GUM G.4.1), which holds for independent terms. Correlated components that share one ν, such as joint readings, count as one term with that ν (Willink 2007). For correlated components with different finite ν no formula is valid: gumption refuses to invent one, says which components it concerns, and takes the smallest ν for k.\n\nThe elements of a vector whose uncertainty is one statement share its ν: they are one term, too.\n\nMonte Carlo needs no ν_eff: readings and stated standard uncertainties with finite ν are drawn from t distributions, elements that share one ν from a multivariate one. Limits with a shape (a rectangle, say) and finite ν are drawn as they are stated; their ν counts for the GUM method only, and a remark says so.",
    },
    Concept {
        name: "detection-limit",
        aliases: &["detection", "not_recognised", "limit of detection", "lod", "decision threshold", "characteristic limits", "iso 11929", "探测限", "检出限", "判断阈", "判断限"],
        title: "decision threshold and detection limit (ISO 11929)",
        text: "A net effect that cannot be negative is recognised where y is above the decision threshold y* = k_{1−α}·u(0), which is exceeded with probability α where there is none. The detection limit y# = y* + k_{1−β}·u(y#) is the smallest value that is recognised with probability 1 − β. Both need u of a measurement that finds another value: the input that `gross` names takes the estimate that gives it, counts follow as their square root, relative uncertainties in proportion. Where u grows as fast as the value there is no detection limit.\n\nBest estimate and coverage interval are those of the normal distribution of the result, cut off at zero. With Monte Carlo, threshold and limit are also found from the quantiles of the simulated results (ISO 11929-2).",
    },
    Concept {
        name: "exit-codes",
        aliases: &["exit", "exit code"],
        title: "what the program returns to the shell",
        text: "0: everything was evaluated. 1: a budget was read but gives no result (the model has no value at the estimates, or every trial failed), or a conformity assessment finds an item not conforming, or an example of `gumption verify` failed. 2: a file or an argument is wrong. With several files the others are still printed, and the worst code is returned.",
    },
    Concept {
        name: "findings",
        aliases: &["warnings", "remark", "vanishing_sensitivity", "second_order_matters", "not_validated", "undecided", "needs_monte_carlo", "failed_trials", "irregular", "near_singular", "phase_wraps", "phase_unknown", "unseen", "few_readings", "large_uncertainty", "below_reference", "error_meant", "indication_meant", "coarse_step", "extrapolated", "lack_of_fit", "residuals_too_small", "exact_fit", "asymmetric"],
        title: "what the report warns of",
        text: "They stand in the report under \"What to know before using these figures\" and in JSON under `findings`, where `kind` is one of:\n\n  vanishing_sensitivity    c = 0 although the input matters; see second-order\n  second_order_matters     the model bends over the uncertainties; see second-order\n  not_validated            the intervals of GUM and Monte Carlo disagree; see validation\n  undecided                too few trials for a verdict; see validation\n  needs_monte_carlo        first order is doubtful and Monte Carlo was not run\n  moments_missing          no mean or standard deviation to state; see moments-missing\n  failed_trials            in some trials the model had no finite value\n  not_converged            the adaptive run stopped at max_trials; see adaptive\n  freedom_refused          ν_eff is not defined; see degrees-of-freedom\n  few_degrees_of_freedom   ν_eff below 10: u itself is poorly known\n  irregular                the model has a kink, a step or a branch at the estimates\n  near_singular            a divisor or argument comes within 4 u of a pole or of its domain's end\n  phase_wraps              the distribution of a phase reaches ±π; trials are taken around the estimate\n  phase_unknown            the distribution of a phase reaches all round the circle\n  unseen                   no Monte Carlo, and the model has a kink or jump within 4 u\n  few_readings             Monte Carlo takes few readings for less certain than s/√n\n  large_uncertainty        one contribution exceeds all others so far that its unit may be wrong\n  below_reference          U is smaller than that of the certificate of a reference\n  falling_carrier          `gross` of [detection] is the background: the result falls where it rises\n  error_meant              not conforming with nominal ± mpe, and nearer to zero: an error of indication?\n  indication_meant         compared with zero, and far larger than the permissible error: an indication?\n  rounded_down             rounding makes U smaller by more than 5 %\n  coarse_step              a rounding step exceeds u, and Monte Carlo was not run\n  extrapolated             a table is used beyond its ends\n  lack_of_fit              the curve of a fit does not describe its data; see least-squares\n  residuals_too_small      data lie closer to the curve than their stated u let expect\n  exact_fit                a curve passes through all its points, which tells no uncertainty\n  residual_pattern         the residuals of a fit keep their signs for longer than by chance\n  pole_between_points      a fitted curve has a pole between two points\n  better_minimum           from another start a fit finds a better minimum\n  asymmetric               symmetric and shortest interval differ; see interval",
    },
    Concept {
        name: "interval",
        aliases: &["shortest", "symmetric", "coverage interval", "包含区间"],
        title: "probabilistically symmetric and shortest coverage interval (JCGM 101, 7.7)",
        text: "Both hold the quantity with probability p. The symmetric one leaves (1 − p)/2 on either side; the shortest one is the narrowest of all. For a symmetric distribution with one peak they are equal. Where they differ, the result should be stated as an interval and not as estimate ± U. The report gives both always; a statement that rests on Monte Carlo gives the shortest one where the distribution is asymmetric.",
    },
    Concept {
        name: "least-squares",
        aliases: &["fit", "fits", "regression", "calibration line", "polynomial", "errors in variables", "lack of fit", "residual_of", "最小二乘", "拟合", "回归", "校准曲线"],
        title: "parameters fitted to data: calibration lines, polynomials, curves",
        text: "[fit.NAME] fits a formula of the model language, or a polynomial, to columns of data. Its parameters are inputs of the budget under their own names, with their full covariance matrix. A file that has fits and no [measurand] reports the parameters.\n\nWhat is known of the errors decides the weights. Nothing stated: equal weights, the residuals tell the scatter, ν = n − p, and Monte Carlo draws a multivariate t. u of the response stated: weights 1/u², taken as known, ν = ∞. u of a predictor stated: errors in both coordinates (ISO/TS 28037). scale = \"residuals\": the stated u are right up to a factor, which the residuals tell. Causes common to all points (common = true, [source.NAME]) change no weight: they reach the parameters through their derivatives with respect to the data, and are not averaged away.\n\nFormulas that are linear in their parameters are solved directly; others need a `start` for each parameter, and are solved with exact derivatives.\n\nThe curve is tested by χ² where uncertainties are stated, by the scatter of repeated points where they are not. residual_of = \"NAME\" gives the scatter about the curve to a further reading, as the inverse use of a calibration line needs.\n\nFigures for claims: NAME.PARAMETER, NAME.u(a), NAME.cov(a, b), NAME.r(a, b), NAME.residual_sd, rss, chi_squared, chi_squared_per_dof, dof, r_squared, lack_of_fit.p and others; `--json` lists them under `figures`.",
    },
    Concept {
        name: "moments-missing",
        aliases: &["no standard uncertainty", "no mean", "heavy tails", "cauchy"],
        title: "when there is no mean or no standard deviation",
        text: "The t distribution has a standard deviation only for ν > 2 and an expectation only for ν > 1, so three readings are too few for Monte Carlo to give u (JCGM 101, 6.4.9). A quotient whose divisor can come near zero has no moments either. Averages of such trials do not settle, however many are run: they would be random numbers with many digits.\n\ngumption looks for both, in the budget and in the tails of the trials, and then prints no Monte Carlo estimate or u. Median and coverage intervals exist always and are given instead. The mend is in the measurement: more readings, a pooled standard deviation, or limits for the divisor.",
    },
    Concept {
        name: "monte-carlo",
        aliases: &["mc", "mcm", "propagation of distributions", "蒙特卡洛"],
        title: "propagation of distributions (JCGM 101)",
        text: "Every input is drawn from its distribution, the model is evaluated, and this is repeated, a million times unless the file says otherwise. Mean and standard deviation of the results are estimate and u (7.6); their order gives the coverage intervals (7.7). Neither derivatives nor degrees of freedom are needed.\n\nThe same seed gives the same result to the last bit, whatever the number of threads.",
    },
    Concept {
        name: "outliers",
        aliases: &["outlier", "grubbs", "dixon", "outlier_test", "离群值", "粗大误差", "格拉布斯", "狄克逊"],
        title: "readings that do not belong to the others",
        text: "outlier_test beside `readings` examines the most outlying of them, on either side, and reports. It never removes: that is for somebody who knows what happened when the reading was taken.\n\n\"grubbs\": largest deviation from the mean in units of s, two-sided at the level `significance` (0.05); three readings or more (ISO 5725-2, GB/T 4883). \"dixon\": gap beside the outermost reading over the range: r10 for 3 to 7 readings, r11 to 10, r21 to 13, r22 to 30; two-sided, critical values from the exact distribution. \"dixon-q\": r10, gap over the whole range, for 3 to 30 readings, as in the Q test of chemists. \"4d\": four mean deviations of the other readings. \"3s\": three standard deviations, for 11 readings or more, because fewer cannot reach that far.\n\nFigures for claims: V.outlier.place, value, statistic, critical, p.",
    },
    Concept {
        name: "propagation",
        aliases: &["combined standard uncertainty", "u_c", "sensitivity coefficient", "sensitivity coefficients", "sensitivity", "law of propagation", "uncertainty budget", "合成标准不确定度", "灵敏系数", "不确定度传播律"],
        title: "how the inputs make up u_c (GUM 5)",
        text: "The combined standard uncertainty of y = f(x_1, x_2, …) is u_c with u_c² = Σ c_i²·u²(x_i) where the inputs are independent; correlated ones add 2·c_i·c_j·u(x_i, x_j) for each pair (GUM 5.1.2, 5.2.2). The sensitivity coefficient c_i = ∂f/∂x_i says by how much y changes for one unit of x_i. gumption differentiates the formulas exactly, and takes c_i in unit of the measurand per unit of the input.\n\nThe budget table has a row for each input: estimate, u, distribution, ν, c, the contribution c·u and its share of u_c². See `gumption explain shares` for which input matters, `second-order` for what this leaves out, and `coverage-factor` for the way from u_c to U.",
    },
    Concept {
        name: "resolution",
        aliases: &["quantisation", "digitisation", "分辨力"],
        title: "what a display or a converter does not show",
        text: "An indication with the step q may come from any value within ±q/2: a rectangle with u = q/(2√3) = 0.29 q (GUM F.2.2.1). Write `step = q`, or `bits` with `range` for a converter, whose step is the range divided by 2^bits.\n\nReadings through a coarse display contain its steps in their scatter. Both are counted by default; resolution = \"largest\" in [conventions] keeps the larger of the two only, as some guides do. Readings that are all equal show that the scatter is below the resolution: state the resolution beside them, and the scatter is left to it.",
    },
    Concept {
        name: "rounding",
        aliases: &["significant digits", "significant figures", "修约", "有效数字"],
        title: "how printed figures are rounded (GUM 7.2.6)",
        text: "U is rounded to one or two significant digits, and the estimate to the same last place. Rounding starts from the shortest decimal digits of the number, never from its binary tail, and happens once, at the end. `half-even` (default, as GB/T 8170) takes ties to the even digit, `half-up` away from zero, `up` raises U always. The profile EA rounds up where rounding would lower U by more than 5 %. JSON output is never rounded.",
    },
    Concept {
        name: "second-order",
        aliases: &["nonlinear", "nonlinearity", "vanishing sensitivity", "higher-order terms"],
        title: "terms that first-order propagation leaves out (GUM 5.1.2, note)",
        text: "First order takes the model for a plane at the estimates. Where the model bends over the width of the uncertainties, higher-order terms change u²(y); for independent normal inputs they are ΣΣ [½ f_ij² + f_i f_ijj] u_i² u_j². And ½ ΣΣ f_ij u(x_i, x_j) moves the estimate. gumption computes both always, with the third and fourth moments of the actual distributions, and shows them when they change a digit that is reported.\n\nA sensitivity coefficient of exactly zero hides an input from first order altogether: cos θ at θ = 0 is the classical case. The report warns of it.",
    },
    Concept {
        name: "shared-source",
        aliases: &["common source", "common cause"],
        title: "one cause of error that acts on several inputs (GUM F.1.2.3)",
        text: "One standard, one instrument or one temperature used for several inputs correlates them. Declare it once as [source.NAME] with its own uncertainty, and let it act on each input by a component { source = \"NAME\" }, with `sensitivity` where the input does not change by 1 per unit of the source, or relative = true where it changes in proportion to its value. Covariances follow, in GUM and in Monte Carlo alike, whatever the distributions, and nobody has to guess a coefficient.\n\n`reference` is the key for where a figure comes from.",
    },
    Concept {
        name: "shares",
        aliases: &["contribution", "kessel", "kessel shares", "index", "share"],
        title: "which input matters",
        text: "The column % of the budget table is the share of u²(y). Halving the u of an input with a share of 80 % lowers u(y) by 37 %; halving that of one with 5 % lowers it by 2 %.\n\nUnder correlation the share of an input is c_i Σ_j c_j u(x_i, x_j) / u²(y) (Kessel, Kacker, Berglund 2006). Shares always sum to 100 %; a negative one means that the input compensates others.",
    },
    Concept {
        name: "statement",
        aliases: &["certificate sentence", "result", "basis"],
        title: "the sentence for the certificate, and the method behind it",
        text: "The statement gives the GUM result, y ± U with k and p, as long as Monte Carlo validates it at the number of digits that the profile reports (`digits`, 2 by default), or was not run. Otherwise it gives the Monte Carlo result and says so: y ± U with U half the width of the interval where that lies evenly about y, else y, u and the interval. Where there is no u it is y ± half the interval, or median and interval where that is lopsided: lopsided means that its ends lie on both sides of y at distances that differ by more than δ and by more than 2 % of U. An asymmetric output is one whose interval is lopsided while the shortest interval is shorter than the symmetric one by more than 1 %, and by more than three standard errors of each end; the statement then gives the shortest. In JSON, `reported` has the figures of the statement, and `reason` says why they are those.\n\nEA-4/02 and a fixed k (JJF 1059.1, NIST) claim y and k·u only. The GUM result then stands as soon as Monte Carlo confirms y and u within δ, and no probability is named for a fixed k unless the intervals agree too. Means of few readings have u = s/√n there, for n = 2 and more and in whatever formula: where Monte Carlo, which draws them from t, disagrees, it is run once more with s/√n for their standard deviation, and that decides. If the model is too nonlinear even so, its y and u are stated with the k of the profile.",
    },
    Concept {
        name: "type-a",
        aliases: &["standard uncertainty", "standard deviation", "pooled standard deviation", "repeatability", "autocorrelation", "type a evaluation", "bessel", "A类", "A类评定", "A类评定方法", "贝塞尔", "贝塞尔公式", "标准不确定度", "标准偏差", "重复性"],
        title: "standard uncertainty from readings (GUM 4.2)",
        text: "n readings with the experimental standard deviation s: u = s/√n for their mean, with ν = n − 1. of = \"single\" takes u = s, for one later reading; of = 3 takes s/√3, for the mean of three. `pooled` replaces s and its ν by those of earlier work. `type = \"A\"` says of a stated `u` that it was evaluated from readings.\n\nReadings that follow each other may be correlated (GUM 4.2.7). The report gives the lag-1 coefficient of ten readings or more, with a remark where independent readings would hardly show it (beyond 2/√n). `autocorrelated` divides by the effective number of independent readings, n/F with F = 1 + 2 Σ (1 − k/n) ρ_k: the mean takes up F·σ²/n of every product of deviations, so that ρ_k is estimated as (n − F)·r_k/(n − k) + F/n, and the sum ends with the first lag of four correlation times, 4·F/2 (Sokal 1997), or with n/4. Then u = σ/√n_eff with σ² = Σ (x − x̄)²/(n − F), and ν = n_eff − 1 at most: F is an estimate, which scatters by √(2(2W + 1)/n) of itself when W lags are summed (Madras and Sokal 1988), and leaves ν = n/(2W + 1) where it is well above 1, more where it is cut off at 1.\n\nAll sums are formed with twice the digits of a double, and a reading is the decimal that is written: readings that agree in their first twelve digits lose nothing. See `gumption explain anova` for readings in groups and `gumption explain outliers` for tests.\n\nIn Monte Carlo the mean of n readings has a scaled and shifted t distribution (JCGM 101, 6.4.9), whose standard deviation is √(ν/(ν − 2)) times s/√n: the two methods therefore differ a little for few readings. t_scale = \"standard-deviation\" in [conventions] gives the t distribution the standard deviation s/√n instead.",
    },
    Concept {
        name: "type-b",
        aliases: &["standard uncertainty", "divisor", "type b evaluation", "B类", "标准不确定度", "除数", "半宽", "最大允许误差"],
        title: "standard uncertainty from other knowledge (GUM 4.3)",
        text: "From a certificate: u = U/k; with p and ν stated, k is the quantile of the t distribution. From limits ±a: a/√3 for a rectangle, a/√6 for a triangle, a/√2 for the arc sine of a quantity that swings between them, a/k_p for a normal distribution of which the limits hold the part p. From a resolution q: q/(2√3). From an accuracy specification: its parts are added to one half-width.\n\nType A and Type B differ in how u was found and in nothing else: both are standard deviations and are combined alike (GUM 3.3.4). `gumption explain distributions` lists the shapes.",
    },
    Concept {
        name: "units",
        aliases: &["dimension", "dimensions", "单位"],
        title: "how units are checked and converted",
        text: "The dimensions of every formula are checked before a number is computed; where two units of one kind meet, they are converted. Figures stay in the units in which the file states them, and sensitivity coefficients are in unit of the measurand per unit of the input.\n\nTemperatures in °C are points on a scale: their differences and uncertainties are in K. `g` is the gram; the acceleration is `gn`. The page docs/units.md lists all units.",
    },
    Concept {
        name: "validation",
        aliases: &["clause 8", "validated", "open verdict", "d_low", "d_high", "验证"],
        title: "whether Monte Carlo confirms GUM (JCGM 101, clause 8)",
        text: "The GUM interval y ± U_p is compared with the probabilistically symmetric Monte Carlo interval, end by end: d_low and d_high are the absolute differences. GUM is validated when both are at most δ, half a unit of the last significant digit of u(y), taken with two digits and with one. The verdict at the digits that the profile reports decides which result the statement uses.\n\nThe ends of the Monte Carlo interval scatter themselves; where a difference is within two standard errors of δ the verdict is open, and the report says how many trials would settle it. JCGM 101, 8.2 recommends a run that is stable to δ/5, so a verdict with two digits may need trials = \"adaptive\" or 10⁷ trials. As long as it is open the statement uses the GUM result. With k fixed (JJF, NIST) the interval compared is not ± U but the one for the p of the profile; see `gumption explain statement` for what follows.",
    },
    Concept {
        name: "verification",
        aliases: &["verify", "17025", "ISO/IEC 17025", "dossier", "software validation", "验证报告"],
        title: "published examples held against their figures (ISO/IEC 17025, 7.11.2)",
        text: "`gumption verify` evaluates the published examples that the program carries with it and puts each published figure beside the one obtained, with the tolerance and the verdict; the last line is `N passed, M failed`. `--report DIR` writes verification.md and verification.json for the file of the laboratory: version, platform, seeds, date, every figure, its source and how it was compared.\n\nWith files or folders it does the same for your own budgets with claims. A claim with confidence = \"low\" is shown and decides nothing.",
    },
];
