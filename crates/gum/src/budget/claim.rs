//! Claims: the figures that somebody's certificate or publication states, each with the tolerance that its
//! digits imply.

use gumption_format::toml::words;

use gumption_core::quantity::Unit;

/// What somebody states about one measurand; compared, never used.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Claim {
    /// Index of the measurand.
    pub measurand: usize,
    /// Which method the figures are about.
    pub method: ClaimedMethod,
    /// The figures, in a fixed order.
    pub figures: Vec<ClaimedFigure>,
    /// How well the claimed figures are known.
    pub confidence: Confidence,
    /// Correct significant digits that the claim asks for, in place of tolerances.
    pub digits: Option<u8>,
    /// Who says so.
    pub reference: Option<String>,
    /// Anything to know about it.
    pub note: Option<String>,
}

impl Claim {
    /// The claimed value of a figure, if it is among them.
    pub fn figure(&self, what: &Figure) -> Option<f64> {
        self.figures
            .iter()
            .find(|figure| figure.what == *what)
            .map(|figure| figure.value)
    }
}

/// The method that a claim is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum ClaimedMethod {
    /// The file does not say: GUM is held against it, Monte Carlo is shown beside.
    Unstated,
    /// Law of propagation of uncertainty, first order.
    Gum,
    /// The same with second-order terms.
    SecondOrder,
    /// Propagation of distributions.
    MonteCarlo,
}

/// One claimed figure.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ClaimedFigure {
    /// Which figure.
    pub what: Figure,
    /// The number, in the unit of the measurand (or of the input, for the figures of an input).
    pub value: f64,
    /// Largest difference that still agrees: half a unit of the last digit stated, or what the file says.
    pub tolerance: f64,
}

/// A figure that can be claimed.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub enum Figure {
    /// The estimate y.
    Estimate,
    /// u(y).
    StandardUncertainty,
    /// U.
    ExpandedUncertainty,
    /// u(y)/|y|.
    RelativeUncertainty,
    /// U/|y|.
    RelativeExpanded,
    /// u²(y).
    Variance,
    /// u(y, y′) with another measurand (index).
    Covariance(usize),
    /// k.
    CoverageFactor,
    /// ν_eff.
    DegreesOfFreedom,
    /// Coverage probability p.
    CoverageProbability,
    /// Lower limit of the coverage interval (probabilistically symmetric for Monte Carlo).
    Lower,
    /// Upper limit of it.
    Upper,
    /// Lower limit of the shortest coverage interval.
    ShortestLower,
    /// Upper limit of it.
    ShortestUpper,
    /// The limit that the quantity is not below with the coverage probability: that of a one-sided interval.
    AtLeast,
    /// The limit that it is not above with that probability.
    AtMost,
    /// Second-order shift of the estimate.
    Shift,
    /// Correlation coefficient with another measurand (index).
    Correlation(usize),
    /// Coverage factor of the elliptical region.
    Ellipsoid,
    /// Coverage factor of the rectangular region.
    Rectangle,
    /// Effective degrees of freedom of the covariance matrix of the measurands.
    RegionFreedom,
    /// Verdict of JCGM 101 clause 8 at these significant digits: 1 = validated, 0 = not.
    Validated(u8),
    /// A figure of an input.
    Input(usize, Part),
    /// A figure of a component.
    Component(usize, Part),
    /// A figure of an analysis, by its name: see [`NamedFigure`].
    Named(String),
}

/// A figure that an analysis found, such as the residual standard deviation of a fit, under the name by which
/// claims and machines refer to it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct NamedFigure {
    /// `OWNER.figure`, such as `calibration.residual_sd`.
    pub name: String,
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: Unit,
}

impl NamedFigure {
    /// The smallest integer J ≥ 100/(1 − p) of an adaptive run (JCGM 101, 7.9.4 b).
    pub(crate) const LEAST_BATCH: &str = "monte_carlo.J";

    /// M, the trials in a batch of an adaptive run: J, and at least 10 000 (JCGM 101, 7.9.4 b).
    pub(crate) const BATCH: &str = "monte_carlo.M";

    /// The name of the numerical tolerance δ of a measurand when this many digits of u(y) are meaningful
    /// (JCGM 101, 7.9.2).
    pub fn tolerance(measurand: &str, digits: u8) -> String {
        format!("{measurand}.delta({digits})")
    }
}

/// Which figure of an input or component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Part {
    /// Its estimate.
    Estimate,
    /// Its standard uncertainty.
    StandardUncertainty,
    /// Its degrees of freedom.
    DegreesOfFreedom,
    /// Its sensitivity coefficient.
    Sensitivity,
    /// |c|·u, in the unit of the measurand.
    Contribution,
}

words! {
    /// How well the source of a claim is known.
    #[derive(serde::Serialize)]
    Confidence {
        /// Inputs and figures stand in a source that was read.
        High "high",
        /// Recalled, or quoted by a third party.
        Medium "medium",
        /// Recalled in part: shown, but no verdict depends on it.
        Low "low",
    }
}
