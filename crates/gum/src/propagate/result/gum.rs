//! What the law of propagation of uncertainty finds.

use gumption_core::distribution::Kind;

/// Law of propagation of uncertainty, first order (GUM 5.1.2, 5.2.2).
#[derive(Debug, Clone, serde::Serialize)]
pub struct Gum {
    /// y = f(x).
    pub estimate: f64,
    /// u_c(y).
    pub u: f64,
    /// One per input, in the order of the budget.
    pub inputs: Vec<Contribution>,
    /// One per component, in the order of the budget: coefficient = Σ over inputs of c_i·a_ij.
    pub components: Vec<Contribution>,
    /// ν_eff.
    pub freedom: Freedom,
    /// k, U and the interval.
    pub coverage: Coverage,
}

/// A line of the budget table.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Contribution {
    /// Sensitivity coefficient c = ∂f/∂x.
    pub sensitivity: f64,
    /// u(x) in the unit of the input or component.
    pub u: f64,
    /// c·u(x), with sign, in the unit of the measurand.
    pub contribution: f64,
    /// Share of u²(y), also under correlation (Kessel): c_i Σ_j c_j u(x_i, x_j) / u²(y); sums to 1.
    pub share: f64,
    /// ν of the input or component.
    #[serde(serialize_with = "gumption_core::distribution::extended::serialize")]
    pub dof: f64,
}

/// Effective degrees of freedom of u(y).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub enum Freedom {
    /// Every component has infinite ν (or u is zero).
    Infinite,
    /// Welch–Satterthwaite (GUM G.4.1) over independent terms.
    WelchSatterthwaite(f64),
    /// As above, where correlated components of equal ν count as one term (Willink 2007).
    Ensembles(f64),
    /// Not defined: `members` are correlated and have different ν. `lower_bound` is ν_eff with the
    /// smallest of their ν for all of them, used for a conservative k.
    Refused {
        /// A substitute for ν_eff, no bound where the members cancel one another.
        lower_bound: f64,
        /// Names of the components.
        members: Vec<String>,
    },
}

impl Freedom {
    /// ν_eff to be used for k.
    pub fn value(&self) -> f64 {
        match self {
            Freedom::Infinite => f64::INFINITY,
            Freedom::WelchSatterthwaite(v) | Freedom::Ensembles(v) => *v,
            Freedom::Refused { lower_bound, .. } => *lower_bound,
        }
    }
}

/// k, U and the interval of the GUM.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Coverage {
    /// Coverage factor.
    pub k: f64,
    /// Where k came from.
    pub basis: CoverageBasis,
    /// p for which k was found; for a fixed k the p that it has for the output's distribution.
    pub probability: f64,
    /// U = k·u.
    pub expanded: f64,
    /// Half-width of the interval for the profile's p (equal to `expanded` unless k is fixed): what
    /// clause 8 compares.
    pub half_width_for_p: f64,
}

/// Where k came from.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub enum CoverageBasis {
    /// Normal distribution, ν_eff is infinite or plays no part.
    Normal,
    /// t with these degrees of freedom, truncated or not as the conventions say.
    StudentT {
        /// ν as it entered t.
        dof: f64,
    },
    /// Distribution of the linearised output: the named components dominate.
    Output {
        /// Names of the components, the largest first.
        dominant: Vec<String>,
        /// Their distribution.
        shape: &'static Kind,
    },
    /// The profile or file fixes it.
    Fixed,
}

/// Second-order terms (note to GUM 5.1.2; JCGM 100:2008/Amd.1:2026 for the estimate).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SecondOrder {
    /// ½ ΣΣ f_ij u(x_i, x_j), to be added to the estimate.
    pub shift: f64,
    /// u(y) with the second-order terms.
    pub u: f64,
    /// Whether shift or u matter at the digits that are reported.
    pub matters: bool,
}
