//! The distributions that a component of an input may have (JCGM 101:2008, 6.4, and others).
//!
//! One file says everything about a distribution: its words, its parameters and how a file states them, its moments,
//! quantiles and draws. It implements [`Univariate`], and one line of `distributions!` below registers it; reader,
//! schema, reference, reports, saved results and both methods of propagation follow from there.
//!
//! | chapter | holds |
//! |---|---|
//! | this file | the registry, and [`Distribution`], which is any one of them |
//! | `univariate` | what a distribution says of itself, with defaults |
//! | `stating` | parameters and widths as files state them, and what is wrong with them |
//! | `symmetric`, `finite` | what the bounded symmetric kinds and those of finitely many values share |
//! | `score` | quantiles as tabulated functions of the normal score |
//! | `copula` | the latent correlation that gives two margins a stated correlation |
//! | `extended` | numbers that may be infinite, in JSON |
//! | the others | one distribution each; `poisson` and `binomial` are counts, which say a gamma or a beta distribution |
//!
//! ```
//! use gumption_core::distribution::{Distribution, Normal};
//!
//! let reading = Distribution::from(Normal { mean: 20.0, sd: 0.5 });
//! assert_eq!(reading.mean(), Some(20.0));
//! assert!((reading.quantile(0.975) - 20.98).abs() < 1e-3);
//! ```

mod copula;
pub mod extended;
mod finite;
pub mod score;
pub mod stating;
mod symmetric;
#[cfg(test)]
mod tests;
pub mod univariate;

use gumption_fault::{Said, say};
use gumption_lanes::Sampler;
use gumption_lanes::quantile::{OfScore, Quantile};

pub use copula::{CopulaError, latent_correlation};
use stating::{Given, ParameterError, ParameterRule, Parametric, Spread, Width, Word};
pub use univariate::{Kind, Latent, Parameter, Univariate};

/// The fields of a distribution as its parameters.
macro_rules! numbers {
    ($self:ident: $($field:ident),+) => {
        vec![ $( (stringify!($field), Parameter::Number($self.$field)) ),+ ]
    };
}

/// Makes the registry: a module for each file, the enumeration of all distributions, what it passes on to them, and
/// the table [`REGISTRY`].
macro_rules! distributions {
    (
        $( $file:ident: $Type:ident $key:literal, )+
        ;
        $( $count:ident, )+
    ) => {
        $( pub mod $file; pub use $file::$Type; )+
        $( pub mod $count; )+

        /// A univariate distribution, fully specified.
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(tag = "name")]
        #[non_exhaustive]
        pub enum Distribution {
            $(
                #[doc = concat!("See [`", stringify!($Type), "`].")]
                #[serde(rename = $key)]
                $Type($Type),
            )+
        }

        $(
            impl From<$Type> for Distribution {
                fn from(of: $Type) -> Distribution {
                    Distribution::$Type(of)
                }
            }

            /// Draws one by one, through the quantile; [`Univariate::sampler`] draws blocks, much faster.
            impl rand::distr::Distribution<f64> for $Type {
                fn sample<R: rand::Rng + ?Sized>(&self, rng: &mut R) -> f64 {
                    univariate::at_uniform(self, open_unit(rng.next_u64()))
                }
            }
        )+

        /// Every distribution, in the order of JCGM 101 Table 1 and then the others.
        pub static REGISTRY: &[Entry] = &[ $( Entry::new::<$Type>() ),+ ];

        /// The words about every distribution, and about what counts say.
        pub static KINDS: &[&Kind] = &[ $( &<$Type as Univariate>::KIND, )+ $( &$count::KIND, )+ ];

        /// Passes a question on to whichever distribution it is.
        macro_rules! each {
            ($any:expr, $of:ident => $answer:expr) => {
                match $any { $( Distribution::$Type($of) => $answer, )+ }
            };
        }

        impl Distribution {
            /// The closed form of [`Univariate::latent_correlation`] for two of one kind.
            fn latent_correlation(&self, other: &Distribution) -> Option<Latent> {
                match (self, other) {
                    $( (Self::$Type(a), Self::$Type(b)) => a.latent_correlation(b), )+
                    _ => None,
                }
            }
        }
    };
}

distributions! {
    rectangular: Uniform "uniform",
    curvilinear_trapezoid: CurvilinearTrapezoid "curvilinear-trapezoid",
    trapezoidal: Trapezoidal "trapezoidal",
    triangular: Triangular "triangular",
    arcsine: Arcsine "arcsine",
    normal: Normal "normal",
    student_t: StudentT "t",
    exponential: Exponential "exponential",
    gamma: Gamma "gamma",
    log_normal: LogNormal "lognormal",
    beta: Beta "beta",
    discrete: Discrete "discrete",
    empirical: Empirical "empirical",
    // What counts say, in terms of the others.
    ;
    poisson,
    binomial,
}

/// What files and pages want to know of one distribution.
#[derive(Debug)]
pub struct Entry {
    /// Its words.
    pub kind: &'static Kind,
    /// The parameters that a file states.
    pub parameters: &'static [ParameterRule],
    /// Whether its name goes beside a width.
    pub word: Word,
    /// What to write for a parameter that others give it, and it has not.
    pub in_place_of: fn(parameter: &str) -> Option<Said>,
    stated: fn(&Given) -> Result<Parametric<Distribution>, ParameterError>,
    of_width: fn(Width, f64, &str) -> Result<Spread<Distribution>, ParameterError>,
    between: fn(f64, f64) -> Option<SpreadAndShift>,
}

/// A spread, and how far its expectation lies above the value of the quantity.
type SpreadAndShift = (Spread<Distribution>, f64);

impl Entry {
    const fn new<D: Univariate>() -> Entry
    where
        Distribution: From<D>,
    {
        Entry {
            kind: &D::KIND,
            parameters: D::PARAMETERS,
            word: D::WORD,
            in_place_of: D::in_place_of,
            stated: |given| {
                let found = D::stated(given)?;
                found.distribution.validate()?;
                Ok(found.map(Distribution::from))
            },
            of_width: |width, modifier, how| {
                Ok(D::of_width(width, modifier, how)?.map(Distribution::from))
            },
            between: |minus, plus| {
                D::between(minus, plus)
                    .map(|(spread, shift)| (spread.map(Distribution::from), shift))
            },
        }
    }

    /// The entry of this key or alias, whatever its case, hyphens and spaces.
    pub fn named(name: &str) -> Option<&'static Entry> {
        let kind = kind_named(name)?;
        REGISTRY.iter().find(|entry| entry.kind.key == kind.key)
    }

    /// The entry of a distribution that is known.
    pub fn of<D: Univariate>() -> &'static Entry
    where
        Distribution: From<D>,
    {
        const { &Entry::new::<D>() }
    }

    /// The parameters that a file states, in words.
    pub fn parameters_in_words(&self) -> Said {
        let limits = self.parameters.iter().any(|rule| rule.key == "half_width");
        let own = self.parameters.iter().map(|rule| rule.key);
        let own = own.filter(|key| !limits || !["lower", "upper", "half_width"].contains(key));
        let own: Vec<&str> = own.collect();
        match (limits, &own[..]) {
            (true, []) => say!("lower and upper, or half_width"),
            (true, _) => say!("lower and upper, or half_width, {}", own.join(", ")),
            (false, _) => own.join(", ").into(),
        }
    }

    /// The distribution with these parameters.
    ///
    /// # Errors
    /// Parameters are missing, contradict one another or are not allowed.
    pub fn stated(&self, given: &Given) -> Result<Parametric<Distribution>, ParameterError> {
        (self.stated)(given)
    }

    /// The distribution about zero of this width; see [`Univariate::of_width`].
    ///
    /// # Errors
    /// The modifier does not fit.
    pub fn of_width(
        &self,
        width: Width,
        modifier: f64,
        how: &str,
    ) -> Result<Spread<Distribution>, ParameterError> {
        (self.of_width)(width, modifier, how)
    }

    /// The distribution about zero between unequal limits; see [`Univariate::between`].
    pub fn between(&self, minus: f64, plus: f64) -> Option<(Spread<Distribution>, f64)> {
        (self.between)(minus, plus)
    }
}

/// Draws one by one, through the quantile; [`Distribution::sampler`] draws blocks, much faster.
impl rand::distr::Distribution<f64> for Distribution {
    fn sample<R: rand::Rng + ?Sized>(&self, rng: &mut R) -> f64 {
        each!(self, d => d.sample(rng))
    }
}

/// A random word as a number of (0, 1), an odd multiple of 2⁻⁵³.
fn open_unit(word: u64) -> f64 {
    ((word >> 12) as f64 + 0.5) * f64::EPSILON
}

/// The kind with this key or alias, whatever its case, hyphens and spaces.
pub fn kind_named(name: &str) -> Option<&'static Kind> {
    let name = name.to_lowercase().replace([' ', '_'], "-");
    KINDS.iter().copied().find(|kind| kind.is_named(&name))
}

impl Distribution {
    /// What is known about distributions of this kind.
    pub fn kind(&self) -> &'static Kind {
        fn of<D: Univariate>(_: &D) -> &'static Kind {
            &D::KIND
        }
        each!(self, d => of(d))
    }

    /// See [`Univariate::validate`].
    ///
    /// # Errors
    /// Which parameter is not allowed, and what is.
    pub fn validate(&self) -> Result<(), ParameterError> {
        each!(self, d => d.validate())
    }

    /// See [`Univariate::parameters`].
    pub fn parameters(&self) -> Vec<(&'static str, Parameter<'_>)> {
        each!(self, d => d.parameters())
    }

    /// See [`Univariate::half_width`].
    pub fn half_width(&self) -> Option<f64> {
        each!(self, d => d.half_width())
    }

    /// Distribution of X + `by`.
    #[must_use]
    pub fn shifted(&self, by: f64) -> Self {
        each!(self, d => d.shifted(by).into())
    }

    /// Distribution of X·`by`.
    ///
    /// `None` when it has no place among the distributions: for a factor that is zero or not finite, and for the
    /// mirror image of the one-sided kinds.
    pub fn scaled(&self, by: f64) -> Option<Self> {
        if by == 0.0 || !by.is_finite() {
            return None;
        }
        if by > 0.0 {
            Some(each!(self, d => d.stretched(by).into()))
        } else {
            each!(self, d => d.mirrored().map(|d| d.stretched(-by).into()))
        }
    }

    /// See [`Univariate::of_counts`].
    pub fn of_counts(&self, counts: f64) -> Option<Self> {
        each!(self, d => d.of_counts(counts).map(Self::from))
    }

    /// Whether it is a normal distribution (t with infinite ν is one).
    pub fn is_normal(&self) -> bool {
        each!(self, d => d.is_normal())
    }

    /// Expectation; `None` when it does not exist (t with ν ≤ 1).
    pub fn mean(&self) -> Option<f64> {
        each!(self, d => d.mean())
    }

    /// Variance; `None` when it does not exist (t with ν ≤ 2).
    pub fn variance(&self) -> Option<f64> {
        each!(self, d => d.variance())
    }

    /// Standard deviation; `None` when it does not exist.
    pub fn standard_deviation(&self) -> Option<f64> {
        self.variance().map(f64::sqrt)
    }

    /// E(X − E X)³; `None` when it does not exist (t with ν ≤ 3).
    pub fn third_central_moment(&self) -> Option<f64> {
        each!(self, d => d.third_central_moment())
    }

    /// E(X − E X)⁴; `None` when it does not exist (t with ν ≤ 4).
    pub fn fourth_central_moment(&self) -> Option<f64> {
        each!(self, d => d.fourth_central_moment())
    }

    /// Probability of a value of at most x.
    pub fn cdf(&self, x: f64) -> f64 {
        each!(self, d => d.cdf(x))
    }

    /// Probability of a value above x.
    pub fn sf(&self, x: f64) -> f64 {
        each!(self, d => d.sf(x))
    }

    /// The x below which a fraction p lies; for the kinds with finitely many values the smallest
    /// value x with P(X ≤ x) ≥ p. NaN for p outside 0 … 1.
    pub fn quantile(&self, p: f64) -> f64 {
        if !(0.0..=1.0).contains(&p) {
            return f64::NAN;
        }
        each!(self, d => d.quantile(p))
    }

    /// The x above which a fraction q lies, exact also for very small q. NaN for q outside 0 … 1.
    pub fn upper_quantile(&self, q: f64) -> f64 {
        if !(0.0..=1.0).contains(&q) {
            return f64::NAN;
        }
        each!(self, d => d.upper_quantile(q))
    }

    /// Smallest and largest possible value; may be infinite.
    pub fn support(&self) -> (f64, f64) {
        each!(self, d => d.support())
    }

    /// Where a density has kinks.
    pub fn kinks(&self) -> Vec<f64> {
        each!(self, d => d.kinks())
    }

    /// See [`Univariate::sum`].
    pub fn sum(&self, g: &dyn Fn(f64) -> f64) -> Option<f64> {
        each!(self, d => d.sum(g))
    }

    /// See [`Univariate::steps`].
    pub fn steps(&self) -> Vec<[f64; 2]> {
        each!(self, d => d.steps())
    }

    /// See [`Univariate::fits_cells`].
    pub fn fits_cells(&self) -> bool {
        each!(self, d => d.fits_cells())
    }

    /// Draws in blocks.
    pub fn sampler(&self) -> Sampler {
        each!(self, d => d.sampler())
    }

    /// The quantile function on blocks; `None` for the kinds with finitely many values, on which points that fill an
    /// interval evenly gain nothing.
    pub fn block_quantile(&self) -> Option<Quantile> {
        let own = each!(self, d => d.block_quantile());
        own.or_else(|| self.of_score().map(Quantile::OfScore))
    }

    /// The value as a function of the normal score; `None` as for [`Distribution::block_quantile`].
    pub fn of_score(&self) -> Option<OfScore> {
        each!(self, d => d.of_score())
    }
}
