//! What a reader wants to know about each kind of distribution, in one table.
//!
//! The keys are the names that a budget file uses. Poisson and binomial stand for counts: what the
//! count says about the quantity is a gamma or a beta distribution, so that they have no variant
//! of their own in [`Distribution`].

use super::Distribution;

/// One kind of distribution, for `explain` and for reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kind {
    /// Name in the budget file.
    pub key: &'static str,
    /// Other names that the file may use.
    pub aliases: &'static [&'static str],
    /// Name in English.
    pub name_en: &'static str,
    /// Name in Chinese.
    pub name_zh: &'static str,
    /// Symbol with its parameters.
    pub parameters: &'static str,
    /// Formula of the expectation.
    pub expectation: &'static str,
    /// Formula of the variance.
    pub variance: &'static str,
    /// Where the formulas stand.
    pub source: &'static str,
    /// When a component has this distribution.
    pub use_when: &'static str,
}

impl Kind {
    /// Everything in one line.
    pub fn describe(&self) -> String {
        format!(
            "{} {}: expectation {}, variance {} ({}); use when {}",
            self.name_en,
            self.parameters,
            self.expectation,
            self.variance,
            self.source,
            self.use_when
        )
    }
}

/// Every kind, in the order of JCGM 101 Table 1 and then the others.
pub const KINDS: &[Kind] = &[
    Kind {
        key: "uniform",
        aliases: &["rectangular", "rectangle", "矩形", "均匀"],
        name_en: "rectangular",
        name_zh: "矩形分布(均匀分布)",
        parameters: "R(a, b), limits a < b",
        expectation: "(a + b)/2",
        variance: "(b - a)²/12",
        source: "JCGM 101:2008, 6.4.2",
        use_when: "only a lower and an upper limit are known (digital resolution, tolerance)",
    },
    Kind {
        key: "curvilinear-trapezoid",
        aliases: &["curvilinear-trapezoidal", "ctrap"],
        name_en: "curvilinear trapezoid",
        name_zh: "曲线梯形分布",
        parameters: "CTrap(a, b, d), limits a ± d and b ± d",
        expectation: "(a + b)/2",
        variance: "(b - a)²/12 + d²/9",
        source: "JCGM 101:2008, 6.4.3",
        use_when: "the limits themselves are known only to within ±d",
    },
    Kind {
        key: "trapezoidal",
        aliases: &["trapezoid", "梯形"],
        name_en: "trapezoidal",
        name_zh: "梯形分布",
        parameters: "Trap(a, b, β), top width β·(b - a)",
        expectation: "(a + b)/2",
        variance: "(b - a)²(1 + β²)/24",
        source: "JCGM 101:2008, 6.4.4",
        use_when: "two independent rectangular effects add up, or values near the limits are less \
                   likely than values near the middle",
    },
    Kind {
        key: "triangular",
        aliases: &["triangle", "三角"],
        name_en: "triangular",
        name_zh: "三角分布",
        parameters: "T(a, c, b), mode c, symmetric when c = (a + b)/2",
        expectation: "(a + b + c)/3, symmetric: (a + b)/2",
        variance: "(a² + b² + c² - ab - ac - bc)/18, symmetric: (b - a)²/24",
        source: "JCGM 101:2008, 6.4.5",
        use_when: "two independent rectangular effects of equal width add up, or the middle is \
                   clearly the most probable value",
    },
    Kind {
        key: "arcsine",
        aliases: &["u-shaped", "arc-sine", "arcsin", "反正弦"],
        name_en: "arc sine (U-shaped)",
        name_zh: "反正弦分布",
        parameters: "U(a, b)",
        expectation: "(a + b)/2",
        variance: "(b - a)²/8",
        source: "JCGM 101:2008, 6.4.6",
        use_when: "the quantity swings sinusoidally between the limits (temperature control, \
                   mismatch of unknown phase)",
    },
    Kind {
        key: "normal",
        aliases: &["gaussian", "gauss", "正态"],
        name_en: "normal (Gaussian)",
        name_zh: "正态分布",
        parameters: "N(x, u²)",
        expectation: "x",
        variance: "u²",
        source: "JCGM 101:2008, 6.4.7",
        use_when: "an estimate and its standard uncertainty are known and nothing more, or many \
                   small effects add up",
    },
    Kind {
        key: "t",
        aliases: &[
            "student-t",
            "student",
            "students-t",
            "student's-t",
            "t-distribution",
        ],
        name_en: "scaled and shifted t",
        name_zh: "t分布",
        parameters: "t_ν(x, s²), ν degrees of freedom",
        expectation: "x, for ν > 1",
        variance: "s²·ν/(ν - 2), for ν > 2",
        source: "JCGM 101:2008, 6.4.9",
        use_when: "the estimate is a mean of repeated readings, or a certificate states U, p and ν",
    },
    Kind {
        key: "exponential",
        aliases: &[],
        name_en: "exponential",
        name_zh: "指数分布",
        parameters: "Ex(1/x), values above zero",
        expectation: "x",
        variance: "x²",
        source: "JCGM 101:2008, 6.4.10",
        use_when: "a quantity cannot be negative and only its estimate is known",
    },
    Kind {
        key: "gamma",
        aliases: &[],
        name_en: "gamma",
        name_zh: "伽马分布",
        parameters: "G(α, θ), shape α, scale θ",
        expectation: "α·θ",
        variance: "α·θ²",
        source: "JCGM 101:2008, 6.4.11",
        use_when: "the quantity is the expectation of a count, or positive with a long upper tail",
    },
    Kind {
        key: "lognormal",
        aliases: &["log-normal", "对数正态"],
        name_en: "lognormal",
        name_zh: "对数正态分布",
        parameters: "LN(µ, σ²), normal logarithm",
        expectation: "exp(µ + σ²/2)",
        variance: "(exp(σ²) - 1)·exp(2µ + σ²)",
        source: "ISO 3534-1:2006, 2.52",
        use_when: "many small factors multiply, or a positive quantity is known to within a factor",
    },
    Kind {
        key: "beta",
        aliases: &[],
        name_en: "beta",
        name_zh: "贝塔分布",
        parameters: "Be(α, β) on a … b",
        expectation: "a + (b - a)·α/(α + β)",
        variance: "(b - a)²·αβ/((α + β)²(α + β + 1))",
        source: "ISO 3534-1:2006, 2.59",
        use_when: "limits and a shape between them are known, or the quantity is a proportion",
    },
    Kind {
        key: "discrete",
        aliases: &[],
        name_en: "discrete",
        name_zh: "离散分布",
        parameters: "values x_i with probabilities p_i",
        expectation: "Σ p_i x_i",
        variance: "Σ p_i (x_i - x)²",
        source: "ISO 3534-1:2006, 2.22",
        use_when: "only some values are possible",
    },
    Kind {
        key: "empirical",
        aliases: &["sample"],
        name_en: "empirical",
        name_zh: "经验分布",
        parameters: "draws with replacement from a sample x_1 … x_n",
        expectation: "Σ x_i/n",
        variance: "Σ (x_i - x)²/n",
        source: "JCGM 101:2008, 6.5",
        use_when: "the sample itself is the knowledge, such as the result of an earlier Monte \
                   Carlo evaluation",
    },
    Kind {
        key: "poisson",
        aliases: &[],
        name_en: "count (Poisson), giving a gamma distribution",
        name_zh: "泊松分布(计数)",
        parameters: "n events counted; G(n + 1, 1) for a uniform prior, G(n + 1/2, 1) Jeffreys, \
                     G(n, 1) reciprocal",
        expectation: "n + 1, n + 1/2 or n",
        variance: "n + 1, n + 1/2 or n",
        source: "JCGM 101:2008, 6.4.11",
        use_when: "independent events were counted (radioactive decay, particles)",
    },
    Kind {
        key: "binomial",
        aliases: &[],
        name_en: "count out of trials (binomial), giving a beta distribution",
        name_zh: "二项分布(计数)",
        parameters: "k successes in n trials; Be(k + 1, n - k + 1) for a uniform prior, \
                     Be(k + 1/2, n - k + 1/2) Jeffreys",
        expectation: "α/(α + β)",
        variance: "αβ/((α + β)²(α + β + 1))",
        source: "ISO 3534-1:2006, 2.46 and 2.59",
        use_when: "a proportion is estimated from successes in independent trials",
    },
];

/// The kind with this key or alias.
pub fn kind_named(name: &str) -> Option<&'static Kind> {
    KINDS
        .iter()
        .find(|kind| kind.key == name || kind.aliases.contains(&name))
}

impl Distribution {
    /// What is known about distributions of this kind.
    pub fn kind(&self) -> &'static Kind {
        let key = match self {
            Self::Normal { .. } => "normal",
            Self::StudentT { .. } => "t",
            Self::Uniform { .. } => "uniform",
            Self::Triangular { .. } => "triangular",
            Self::Trapezoidal { .. } => "trapezoidal",
            Self::CurvilinearTrapezoid { .. } => "curvilinear-trapezoid",
            Self::Arcsine { .. } => "arcsine",
            Self::Exponential { .. } => "exponential",
            Self::Gamma { .. } => "gamma",
            Self::LogNormal { .. } => "lognormal",
            Self::Beta { .. } => "beta",
            Self::Discrete { .. } => "discrete",
            Self::Empirical { .. } => "empirical",
        };
        kind_named(key).expect("every variant has its line in the table")
    }

    /// Name in English, as the field says it.
    pub fn name(&self) -> &'static str {
        self.kind().name_en
    }

    /// Name in Chinese.
    pub fn name_zh(&self) -> &'static str {
        self.kind().name_zh
    }

    /// Name, parameters, expectation, variance, clause and use in one line.
    pub fn describe(&self) -> String {
        self.kind().describe()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        let mut names: Vec<&str> = KINDS
            .iter()
            .flat_map(|kind| kind.aliases.iter().copied().chain([kind.key]))
            .collect();
        let all = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all);
        assert_eq!(
            kind_named("rectangular").map(|kind| kind.key),
            Some("uniform")
        );
        assert_eq!(kind_named("u-shaped").map(|kind| kind.key), Some("arcsine"));
        assert_eq!(kind_named("cauchy"), None);
    }
}
