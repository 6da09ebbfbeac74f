//! How files state a distribution: with all of its parameters, or by its name beside a width.

use std::fmt;

use gumption_fault::{Said, say};

/// A parameter that a file may state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParameterRule {
    /// The key.
    pub key: &'static str,
    /// What it says, as a sentence.
    pub meaning: &'static str,
    /// What it may be set to.
    pub takes: Takes,
}

/// What a parameter may be set to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// A number.
    Number,
    /// Degrees of freedom: a number, or infinity.
    Freedom,
    /// A list of numbers.
    Numbers,
}

impl ParameterRule {
    /// A parameter that is a number.
    pub(super) const fn number(key: &'static str, meaning: &'static str) -> ParameterRule {
        ParameterRule {
            key,
            meaning,
            takes: Takes::Number,
        }
    }

    /// A parameter that is a list of numbers.
    pub(super) const fn numbers(key: &'static str, meaning: &'static str) -> ParameterRule {
        ParameterRule {
            key,
            meaning,
            takes: Takes::Numbers,
        }
    }
}

pub(super) const LOWER: ParameterRule = ParameterRule::number("lower", "Lower limit.");
pub(super) const UPPER: ParameterRule = ParameterRule::number("upper", "Upper limit.");
pub(super) const HALF_WIDTH: ParameterRule = ParameterRule::number(
    "half_width",
    "Half-width about the value, in place of the limits.",
);
pub(super) const ORIGIN: ParameterRule = ParameterRule::number("origin", "Lower end (default 0).");

/// What to write for the variance of a distribution that is stated by a standard deviation.
pub(super) fn in_place_of_variance(parameter: &str) -> Option<Said> {
    ["variance", "var"]
        .contains(&parameter)
        .then(|| say!("state its square root, the standard deviation"))
}

/// The parameters that a file states.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Given {
    /// Numbers by their keys.
    pub numbers: Vec<(&'static str, f64)>,
    /// Lists of numbers by their keys.
    pub lists: Vec<(&'static str, Vec<f64>)>,
}

impl Given {
    /// A number, if it is stated.
    pub fn optional(&self, key: &str) -> Option<f64> {
        let found = self.numbers.iter().find(|(name, _)| *name == key);
        found.map(|(_, number)| *number)
    }

    /// A number that has to be stated.
    ///
    /// # Errors
    /// It is missing.
    pub fn number(&self, key: &'static str) -> Result<f64, ParameterError> {
        self.optional(key).ok_or(ParameterError::Missing { key })
    }

    /// A list, if it is stated.
    pub fn list(&self, key: &str) -> Option<&[f64]> {
        let found = self.lists.iter().find(|(name, _)| *name == key);
        found.map(|(_, list)| list.as_slice())
    }

    /// A distribution between limits: `lower` and `upper` say where it is, `half_width` is about the value.
    ///
    /// # Errors
    /// They are missing, doubled or not ascending; what `make` finds.
    pub fn between<D>(
        &self,
        make: impl FnOnce(f64, f64) -> Result<D, ParameterError>,
    ) -> Result<Parametric<D>, ParameterError> {
        let (lower, upper) = (self.optional("lower"), self.optional("upper"));
        let (lower, upper, located) = match (self.optional("half_width"), lower, upper) {
            (Some(a), None, None) => {
                positive("half_width", a)?;
                (-a, a, false)
            }
            (None, Some(lower), Some(upper)) => (lower, upper, true),
            (Some(_), lower, _) => {
                let key = if lower.is_some() { "lower" } else { "upper" };
                return Err(ParameterError::TwoWidths { key });
            }
            (None, _, _) => return Err(ParameterError::NoLimits),
        };
        ascending(lower, upper)?;
        let how = if located {
            format!("{lower} … {upper}")
        } else {
            format!("a = {upper}")
        };
        Ok(Parametric {
            distribution: make(lower, upper)?,
            located,
            limits: located.then_some([lower, upper]),
            how,
        })
    }
}

/// A fully stated distribution, and whether its location is stated too.
#[derive(Debug, Clone, PartialEq)]
pub struct Parametric<D> {
    /// The distribution; about zero where no location was stated.
    pub distribution: D,
    /// Whether its parameters say where the quantity is (they then determine the estimate).
    pub located: bool,
    /// The limits between which it lies, where the file states them.
    pub limits: Option<[f64; 2]>,
    /// Its parameters in words.
    pub how: String,
}

impl<D> Parametric<D> {
    /// One whose parameters say where it is.
    pub(super) fn located(distribution: D, how: String) -> Self {
        Parametric {
            distribution,
            located: true,
            limits: None,
            how,
        }
    }

    /// The same with the distribution in another form.
    pub(super) fn map<E>(self, f: impl FnOnce(D) -> E) -> Parametric<E> {
        Parametric {
            distribution: f(self.distribution),
            located: self.located,
            limits: self.limits,
            how: self.how,
        }
    }
}

/// Whether the name of a distribution alone, beside a width, says everything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Word {
    /// It does not.
    None,
    /// It has no limits: a half-width needs its coverage probability.
    Bell(Bell),
    /// A half-width is that of its limits.
    Limits,
    /// As that, with another parameter.
    LimitsAnd(ParameterRule),
}

/// The bells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bell {
    /// Normal.
    Normal,
    /// t.
    StudentT,
}

/// A width that is stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Width {
    /// Standard uncertainty.
    U(f64),
    /// Half-width.
    Half(f64),
}

/// A distribution about zero that has a stated width.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread<D> {
    /// The distribution.
    pub distribution: D,
    /// Its standard uncertainty.
    pub u: f64,
    /// How that came about.
    pub how: String,
}

impl<D> Spread<D> {
    /// A symmetric distribution with the variance a²/`divisor`; `shown` is how the divisor is written.
    pub(super) fn symmetric(
        width: Width,
        (divisor, shown): (f64, &str),
        how: &str,
        make: impl Fn(f64) -> D,
    ) -> Self {
        match width {
            Width::Half(a) => Spread {
                distribution: make(a),
                u: a / divisor.sqrt(),
                how: format!("a/√{shown}, {how}"),
            },
            Width::U(u) => Spread {
                distribution: make(u * divisor.sqrt()),
                u,
                how: how.to_string(),
            },
        }
    }

    /// The same with the distribution in another form.
    pub(super) fn map<E>(self, f: impl FnOnce(D) -> E) -> Spread<E> {
        Spread {
            distribution: f(self.distribution),
            u: self.u,
            how: self.how,
        }
    }
}

/// Why there is no distribution with these parameters.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ParameterError {
    /// A parameter is missing.
    Missing {
        /// Which.
        key: &'static str,
    },
    /// The limits are missing.
    NoLimits,
    /// Limits and a half-width.
    TwoWidths {
        /// One of the limits.
        key: &'static str,
    },
    /// A parameter has a value that is not allowed.
    NotAllowed {
        /// Which.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        must: Said,
    },
    /// The lower limit is not below the upper one.
    Descending {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// Anything else.
    Unusable {
        /// What is wrong, as a sentence without its stop.
        message: Said,
        /// What to do.
        help: Said,
    },
}

impl ParameterError {
    /// What is wrong, as a sentence without its stop.
    pub fn said(&self) -> Said {
        match self {
            Self::Missing { key } => say!("`{key}` is missing"),
            Self::NoLimits => say!("the limits are missing"),
            Self::TwoWidths { key } => say!("`{key}` is stated beside `half_width`"),
            Self::NotAllowed { key, value, must } => {
                say!("`{key}` is {value}, but must be {must}")
            }
            Self::Descending { lower, upper } => {
                say!("the lower limit {lower} must be below the upper limit {upper}")
            }
            Self::Unusable { message, .. } => message.clone(),
        }
    }
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.said(), f)
    }
}

impl std::error::Error for ParameterError {}

pub(super) fn finite(key: &'static str, value: f64) -> Result<(), ParameterError> {
    allowed(key, value, value.is_finite(), || say!("a finite number"))
}

pub(super) fn positive(key: &'static str, value: f64) -> Result<(), ParameterError> {
    let allows = value > 0.0 && value.is_finite();
    allowed(key, value, allows, || say!("greater than zero"))
}

pub(super) fn within(
    key: &'static str,
    value: f64,
    [low, high]: [f64; 2],
) -> Result<(), ParameterError> {
    allowed(key, value, (low..=high).contains(&value), || {
        say!("from {low} to {high}")
    })
}

pub(super) fn allowed(
    key: &'static str,
    value: f64,
    allows: bool,
    must: impl FnOnce() -> Said,
) -> Result<(), ParameterError> {
    if allows {
        Ok(())
    } else {
        let must = must();
        Err(ParameterError::NotAllowed { key, value, must })
    }
}

pub(super) fn ascending(lower: f64, upper: f64) -> Result<(), ParameterError> {
    finite("lower", lower)?;
    finite("upper", upper)?;
    if lower < upper {
        Ok(())
    } else {
        Err(ParameterError::Descending { lower, upper })
    }
}
