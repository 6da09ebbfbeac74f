//! Inputs, and the components that doubt them.

use std::sync::Arc;

use gumption_format::toml::words;
use nalgebra::DMatrix;
use smol_str::SmolStr;

use gumption_core::distribution::Distribution;
use gumption_core::quantity::Unit;

/// An input quantity X_i.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// `V`, or `U[3]` for an element of a vector (counted from 1).
    pub name: SmolStr,
    /// What it is.
    pub description: Option<String>,
    /// For subtotals in the budget table.
    pub group: Option<String>,
    /// Unit of the estimate.
    pub unit: Unit,
    /// The best estimate x_i (expectation).
    pub estimate: f64,
    /// The components that act on it.
    pub terms: Vec<Term>,
}

/// How a component enters an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// Index into [`Budget::components`](super::Budget::components).
    pub component: usize,
    /// Change of the input per unit of the component (1 for the input's own components).
    pub coefficient: f64,
}

/// Who has a component.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Owner {
    /// Input index.
    Input(usize),
    /// A `[source.NAME]` that several inputs share.
    Source(String),
}

/// One reason to doubt an input: a zero-mean elementary random variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Unique and stable: `V.calibration`, `V` when it is the only one, `table` for a source.
    pub name: SmolStr,
    /// Without the owner: `calibration`.
    pub label: SmolStr,
    /// Who has it.
    pub owner: Owner,
    /// Unit of the deviation (K for an input in °C).
    pub unit: Unit,
    /// Zero-mean distribution of the deviation, used by Monte Carlo.
    pub distribution: Distribution,
    /// Standard uncertainty as GUM propagates it. Differs from the distribution's standard deviation
    /// only for t (u = s/√n against the larger standard deviation of the scaled t).
    pub u: f64,
    /// Degrees of freedom ν; infinite for most Type B.
    pub dof: f64,
    /// Type A or Type B.
    pub evaluation: Evaluation,
    /// How u was obtained from what the file states, for the reader: `U/k = 4.0e-5/2`, `a/√3`.
    pub how: SmolStr,
    /// The certificate behind it.
    pub certificate: Option<Box<Certificate>>,
    /// Where the number comes from.
    pub reference: Option<String>,
}

/// Where a value comes from.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// Its number.
    pub number: Option<String>,
    /// Who issued it.
    pub laboratory: Option<String>,
    /// Date of the calibration.
    pub date: Option<String>,
    /// Date when the next calibration is due.
    pub due: Option<String>,
    /// k of its U, where it states one.
    #[serde(default)]
    pub k: Option<f64>,
}

/// Components that are correlated with one another.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Indices into [`Budget::components`](super::Budget::components).
    pub members: Vec<usize>,
    /// Product-moment correlation of the members (GUM: r(x_i, x_j)); positive semidefinite.
    /// It may have millions of elements, and copies share it.
    pub correlation: Arc<DMatrix<f64>>,
    /// How the members are distributed together.
    pub law: Law,
    /// ν shared by all members when they come from one set of simultaneous readings, or all state the
    /// same ν: a linear combination of them then has exactly this ν (Willink 2007).
    pub dof: Option<f64>,
}

/// The joint distribution of a group, for Monte Carlo.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// Multivariate normal (JCGM 101 6.4.8).
    Normal,
    /// Multivariate t: u_i T with T ~ t_ν(0, R) (JCGM 102 5.3.2). `scale[i]` multiplies member i.
    StudentT {
        /// ν of all members.
        dof: f64,
        /// Multiplies each member's standard t variable.
        scale: Vec<f64>,
    },
    /// Margins as stated, joined by a Gaussian copula whose correlation `latent` was solved so that
    /// the members have the stated product-moment correlation.
    GaussianCopula {
        /// Correlation of the latent standard normal variables.
        latent: DMatrix<f64>,
    },
}

words! {
    /// How a standard uncertainty was found (GUM 2.3.2, 2.3.3).
    Evaluation {
        /// From a statistical analysis of readings.
        TypeA "A",
        /// By other means.
        TypeB "B",
    }
}
