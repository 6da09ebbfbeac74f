//! Words of the trade that `gumption explain` knows, besides what the library lists itself.

/// A concept and its explanation.
pub(super) struct Concept {
    pub(super) name: &'static str,
    pub(super) aliases: &'static [&'static str],
    pub(super) title: &'static str,
    pub(super) text: &'static str,
}

/// All concepts, in alphabetical order.
pub(super) const CONCEPTS: &[Concept] = &[
    Concept {
        name: "adaptive",
        aliases: &["stein", "trials", "tolerance"],
        title: "how many Monte Carlo trials are enough",
        text: "With `trials = \"adaptive\"` (or `--trials adaptive`) Monte Carlo runs until its results are stable to a numerical tolerance δ, which is half a unit of the last of the digits of u(y) that are asked for (JCGM 101, 7.9.2).\n\nTwo procedures exist. `stein` (the default) estimates from a first set of trials how many are needed and then runs them once; the tolerance is reached with the stated confidence (Wübbeler, Harris, Cox, Elster 2010). `jcgm101` adds batches until twice the standard error of every result is below δ (7.9.4); it may stop too early by chance.",
    },
    Concept {
        name: "claim",
        aliases: &["certificate"],
        title: "figures that somebody states, compared and never used",
        text: "A `[claim]` holds what a certificate or a paper says: value, u, U, k, dof, interval. The report puts each figure beside the one obtained and says whether they agree when the obtained one is rounded to the last digit claimed. A claimed U with its own k is compared with that k times u, so that a difference in U shows a difference in u and not in the convention for k.",
    },
    Concept {
        name: "correlation",
        aliases: &["shared source", "source", "joint"],
        title: "inputs that err together",
        text: "Say it by its cause where you can: a `[source.NAME]` that several inputs share makes them correlated, in GUM and in Monte Carlo alike. Readings taken at the same time go into `[[joint]]`. A bare coefficient goes into `[[correlation]]`; the whole matrix must be positive semidefinite, or no quantities can have these correlations.\n\nUnder correlation the share of an input is c_i Σ_j c_j u(x_i, x_j) / u²(y). Shares sum to 100 %; a negative one means that the input compensates others.",
    },
    Concept {
        name: "coverage-factor",
        aliases: &["k", "expanded uncertainty", "U"],
        title: "where k comes from",
        text: "U = k·u_c. With `coverage_factor_from = \"t\"` k is the quantile of the t-distribution with ν_eff degrees of freedom, and of the normal one when ν_eff is infinite. With `\"output\"` the distribution of the linearised result is used where one or two rectangles, or another component that is not normal, dominate: k is 1.65 for a rectangle and p = 95 %. With `\"normal\"` the normal quantile is used always. `coverage_factor = 2` fixes k; p is then what it happens to be.",
    },
    Concept {
        name: "degrees-of-freedom",
        aliases: &["welch-satterthwaite", "dof", "effective degrees of freedom"],
        title: "how well u itself is known",
        text: "n readings give ν = n − 1; a component with a reliability Δu/u has ν = ½(Δu/u)^-2; most Type B components have ν = ∞.\n\nν_eff of u(y) follows from the Welch–Satterthwaite formula, u⁴(y) / Σ u_i⁴(y)/ν_i. It holds for independent terms only. Correlated components that share their ν (joint readings) count as one term with that ν. For correlated components with different finite ν no formula is valid: gumption says so and takes k for the smallest ν, which is on the safe side.",
    },
    Concept {
        name: "exit-codes",
        aliases: &["exit"],
        title: "what the program returns to the shell",
        text: "0: everything was evaluated. 1: a budget was read but gives no result (the model has no value at the estimates, every trial failed). 2: a file or an argument is wrong. With several files the others are still printed, and the worst code is returned.",
    },
    Concept {
        name: "interval",
        aliases: &["shortest", "symmetric", "coverage interval"],
        title: "probabilistically symmetric and shortest coverage interval",
        text: "Both hold the result with probability p. The symmetric one leaves (1 − p)/2 on either side; the shortest one is the narrowest of all. For a symmetric distribution with one peak they are equal. Where they differ, the result should be stated as an interval and not as estimate ± U. The report gives both always.",
    },
    Concept {
        name: "monte-carlo",
        aliases: &["mc", "propagation of distributions", "seed"],
        title: "propagation of distributions (JCGM 101)",
        text: "Every input is drawn from its distribution, the model is evaluated, and this is repeated a million times or more. Mean, standard deviation and coverage intervals of the results need neither derivatives nor degrees of freedom.\n\nThe same seed gives the same result to the last bit, whatever the number of threads.",
    },
    Concept {
        name: "rounding",
        aliases: &["digits"],
        title: "how printed figures are rounded",
        text: "U is rounded to one or two significant digits, and the estimate to the same last place (GUM 7.2.6). Rounding starts from the decimal digits, never from the binary number, and happens once, at the end. `half-even` (default) takes ties to the even digit, `half-up` away from zero, `up` raises U always. JSON output is never rounded.",
    },
    Concept {
        name: "second-order",
        aliases: &["nonlinear", "vanishing sensitivity"],
        title: "terms that first-order propagation leaves out",
        text: "First order takes the model for a plane at the estimates. Where the model bends over the width of the uncertainties, the second-order terms (note to GUM 5.1.2) add to u²(y), and ½ ΣΣ f_ij u(x_i, x_j) moves the estimate. They are computed always and shown when they change a digit that is reported.\n\nA sensitivity coefficient of exactly zero hides an input from first order altogether: cos θ at θ = 0 is the classical case. The report warns of it.",
    },
    Concept {
        name: "shares",
        aliases: &["contribution", "kessel", "index"],
        title: "which input matters",
        text: "The column % is the share of u²(y). Halving the u of an input with a share of 80 % lowers u(y) by 37 %; halving that of one with 5 % lowers it by 2 %. Under correlation see `gumption explain correlation`.",
    },
    Concept {
        name: "type-a",
        aliases: &["type-b", "readings", "evaluation"],
        title: "two ways to find a standard uncertainty",
        text: "Type A: from a statistical analysis of readings, u = s/√n with ν = n − 1. Type B: by any other means, such as a certificate (u = U/k), limits with a distribution (u = a/√3 for a rectangle), a resolution (u = q/(2√3)). Both are standard deviations and are combined alike.\n\nIn Monte Carlo the mean of n readings is a scaled and shifted t-distribution (JCGM 101, 6.4.9), whose standard deviation is larger than s/√n: the two methods therefore differ a little for few readings. `t_scale` in `[conventions]` changes that.",
    },
    Concept {
        name: "validation",
        aliases: &["clause 8", "validated"],
        title: "whether GUM agrees with Monte Carlo (JCGM 101, clause 8)",
        text: "The GUM interval y ± U_p is compared with the Monte Carlo interval, end by end: d_low and d_high are the absolute differences. GUM is validated when both are at most δ, half a unit of the last significant digit of u(y), where u(y) is taken with two digits (strict) or one.\n\nWhere GUM is not validated, the statement uses the Monte Carlo result.",
    },
];
