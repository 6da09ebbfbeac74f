//! What a distribution says of itself: everything that the rest of the program wants to know.
//!
//! A file of this folder implements [`Univariate`] for one distribution. What it does not say has a default that is
//! right for every distribution, if slower: draws come from the quantile, a quantile on blocks from a table.

use std::fmt;
use std::sync::Arc;

use gumption_fault::language::Language;
use gumption_fault::{Said, say};
use gumption_lanes::Sampler;
use gumption_lanes::quantile::{OfScore, Quantile};

use super::score;
use super::stating::{Given, ParameterError, ParameterRule, Parametric, Spread, Width, Word};

/// The words about one distribution, for `explain`, reports and the reference.
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
    /// The key of a component that states it in a way of its own (`sample`, `count`).
    pub stated_by: Option<&'static str>,
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

    /// Whether this is its key or one of its aliases.
    pub fn is_named(&self, name: &str) -> bool {
        self.key == name || self.aliases.contains(&name)
    }

    /// Name within a sentence.
    pub fn name(&self, language: Language) -> &'static str {
        language.pick(self.name_en, self.first_name_zh())
    }

    /// The word for a column of a table, which has no room for second names and for the word distribution in every row.
    pub fn short(&self, language: Language) -> &'static str {
        language.pick(self.key, self.first_name_zh().trim_end_matches("分布"))
    }

    /// The Chinese name without the second one in brackets.
    fn first_name_zh(&self) -> &'static str {
        self.name_zh.split('(').next().unwrap_or_default()
    }
}

/// As its name in English.
impl serde::Serialize for Kind {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name_en)
    }
}

/// A parameter as machines read it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Parameter<'d> {
    /// One number.
    Number(f64),
    /// Several.
    Numbers(&'d [f64]),
}

/// How the correlation of two quantities depends on that of the normal variables behind them.
pub struct Latent {
    /// Correlation of the two when one falls while the other rises.
    pub smallest: f64,
    /// Correlation of the two when they rise together.
    pub largest: f64,
    /// The latent correlation of one between these.
    pub of: Box<dyn Fn(f64) -> f64>,
}

/// A univariate distribution, fully specified, and how files state it.
///
/// Parameters are in the unit of the component. Moments and quantiles follow from them exactly.
pub trait Univariate: fmt::Debug + Clone + Send + Sync + Sized + 'static {
    /// Its names, formulas and use.
    const KIND: Kind;

    /// The parameters that a file states in `distribution = { NAME = { … } }`; none where it cannot be stated so.
    const PARAMETERS: &'static [ParameterRule] = &[];

    /// What to write for a parameter that others give this distribution, and it has not.
    fn in_place_of(_parameter: &str) -> Option<Said> {
        None
    }

    /// Whether its name alone goes beside a width that is stated in another way.
    const WORD: Word = Word::None;

    /// The distribution that a file states.
    ///
    /// # Errors
    /// Parameters are missing or contradict one another. What [`Univariate::validate`] refuses need not be refused
    /// here.
    fn stated(_: &Given) -> Result<Parametric<Self>, ParameterError> {
        Err(ParameterError::Unusable {
            message: say!("{} has no parameters to state", Self::KIND.key),
            help: say!("state it in its own way"),
        })
    }

    /// The distribution about zero of this width, for the kinds with [`Word::Limits`] or [`Word::LimitsAnd`]; `how` is
    /// how the width came about.
    ///
    /// # Errors
    /// The modifier does not fit.
    fn of_width(_: Width, _modifier: f64, _how: &str) -> Result<Spread<Self>, ParameterError> {
        Err(ParameterError::Unusable {
            message: say!("{} has no width", Self::KIND.key),
            help: say!("state it with its parameters"),
        })
    }

    /// The distribution about zero with limits that lie `minus` below and `plus` above the value of the quantity, and
    /// how far its expectation lies above that value; `None` where such limits move a symmetric distribution.
    fn between(_minus: f64, _plus: f64) -> Option<(Spread<Self>, f64)> {
        None
    }

    /// The half-width with which the name alone states this distribution.
    fn half_width(&self) -> Option<f64> {
        None
    }

    /// Whether the parameters are allowed; the other methods may give NaN where they are not.
    ///
    /// # Errors
    /// Which is not, and what is allowed.
    fn validate(&self) -> Result<(), ParameterError>;

    /// The parameters by name, as in saved results.
    fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)>;

    /// Distribution of X + `by`.
    #[must_use]
    fn shifted(&self, by: f64) -> Self;

    /// Distribution of X·`by` for a positive factor.
    #[must_use]
    fn stretched(&self, by: f64) -> Self;

    /// Distribution of −X; `None` when it has none of the same kind.
    fn mirrored(&self) -> Option<Self> {
        None
    }

    /// What so many counts say, where the distribution is about a number of counts (JCGM 101 6.4.11).
    fn of_counts(&self, _counts: f64) -> Option<Self> {
        None
    }

    /// Whether it is a normal distribution.
    fn is_normal(&self) -> bool {
        false
    }

    /// Correlation of two quantities of this kind, where it follows from that of the normal variables behind them in
    /// closed form.
    fn latent_correlation(&self, _other: &Self) -> Option<Latent> {
        None
    }

    /// Expectation; `None` when it does not exist.
    fn mean(&self) -> Option<f64>;

    /// Variance; `None` when it does not exist.
    fn variance(&self) -> Option<f64>;

    /// E(X − E X)³; `None` when it does not exist.
    fn third_central_moment(&self) -> Option<f64>;

    /// E(X − E X)⁴; `None` when it does not exist.
    fn fourth_central_moment(&self) -> Option<f64>;

    /// Probability of a value of at most x.
    fn cdf(&self, x: f64) -> f64;

    /// Probability of a value above x.
    fn sf(&self, x: f64) -> f64 {
        1.0 - self.cdf(x)
    }

    /// The x below which a fraction p lies, 0 ≤ p ≤ 1; for finitely many values the smallest x with P(X ≤ x) ≥ p.
    fn quantile(&self, p: f64) -> f64;

    /// The x above which a fraction q lies, exact also for very small q.
    fn upper_quantile(&self, q: f64) -> f64;

    /// Smallest and largest possible value; may be infinite.
    fn support(&self) -> (f64, f64);

    /// Where a density has kinks.
    fn kinks(&self) -> Vec<f64> {
        Vec::new()
    }

    /// E g(X) of the kinds with finitely many values.
    fn sum(&self, _g: &dyn Fn(f64) -> f64) -> Option<f64> {
        None
    }

    /// Of the kinds with finitely many values, ascending: the probability of what lies below a step of the quantile,
    /// and how high the step is.
    fn steps(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// Whether the probabilities of equal cells between the limits tell the distribution: both limits are finite, the
    /// density has no pole, and any jump is at the limits of a rectangle.
    fn fits_cells(&self) -> bool {
        false
    }

    /// Draws in blocks.
    fn sampler(&self) -> Sampler {
        let own = self.clone();
        Sampler::inverse(move |u| at_uniform(&own, u))
    }

    /// The quantile function on blocks, where it has a form of its own that is no function of the normal score.
    fn block_quantile(&self) -> Option<Quantile> {
        None
    }

    /// The value as a function of the normal score; `None` for the kinds with finitely many values, on which points
    /// that fill an interval evenly gain nothing.
    fn of_score(&self) -> Option<OfScore> {
        Some(OfScore::Tabulated {
            table: Arc::new(score::of_score(
                |p| self.quantile(p),
                |q| self.upper_quantile(q),
            )),
            location: 0.0,
            scale: 1.0,
        })
    }
}

/// The value below which a fraction u lies, 0 < u < 1, from the nearer end.
pub(super) fn at_uniform<D: Univariate>(of: &D, u: f64) -> f64 {
    if u <= 0.5 {
        of.quantile(u)
    } else {
        of.upper_quantile(1.0 - u)
    }
}
