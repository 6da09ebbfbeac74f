//! The declared model fitted to the recording by weighted least squares: the search of
//! [`crate::least_squares`], begun at several places.

use std::fmt::{self, Display};

use nalgebra::{DMatrix, DVector};

use super::catalogue::modifiers::largest;
use super::design::{Design, Linear};
use super::evidence::Correlation;
use gumption_core::least_squares::{self, Minimum, Residuals, Stuck, glance, minimise};

/// The model at its best.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Values of the unknowns.
    pub unknowns: DVector<f64>,
    /// The model there.
    pub linear: Linear,
    /// ∂f/∂unknown of the observations.
    pub jacobian: DMatrix<f64>,
    /// Observed less modelled.
    pub residuals: DVector<f64>,
    /// The steps of a search that did not end in a minimum: none improved χ² any more, or there was no end of them.
    pub lost: Option<usize>,
}

/// A model that a diagnosis fits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelVersion {
    /// The model of the case.
    Declared,
    /// The model with the adopted effects in it.
    Improved,
}

/// A fit on which a reader should not rely.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unsettled {
    /// What was fitted.
    pub model: ModelVersion,
    /// What went wrong.
    pub trouble: Trouble,
}

/// What went wrong with a fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Trouble {
    /// The values are not those of a minimum of χ².
    NoMinimum {
        /// Steps of the search.
        steps: usize,
    },
    /// There are no values.
    NoFit(NoFit),
}

impl Fit {
    /// What is to be said of this fit of a model, if anything.
    pub fn unsettled(&self, model: ModelVersion) -> Option<Unsettled> {
        let trouble = self.lost.map(|steps| Trouble::NoMinimum { steps });
        trouble.map(|trouble| Unsettled { model, trouble })
    }
}

/// How well observations are known.
#[derive(Debug, Clone, Copy)]
pub struct Weights<'w> {
    /// Standard uncertainty of each.
    pub u: &'w DVector<f64>,
    /// How they are correlated, where they are.
    pub correlation: Option<&'w Correlation>,
}

impl<'w> Weights<'w> {
    /// Of independent observations.
    pub fn of(u: &'w DVector<f64>) -> Weights<'w> {
        Weights {
            u,
            correlation: None,
        }
    }

    /// A column in units of the noise.
    fn weighted(&self, column: &DVector<f64>) -> DVector<f64> {
        let own = column.component_div(self.u);
        let whitened = self
            .correlation
            .map(|correlation| correlation.whitened(&own));
        whitened.and_then(Result::ok).unwrap_or(own)
    }
}

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoFit {
    /// The model has no finite value where the search begins.
    NoStart,
    /// Nothing depends on any unknown where the search begins.
    NoMinimum,
    /// This unknown is not determined by the recording.
    Undetermined(String),
    /// Fewer observations than unknowns.
    TooFew {
        /// Observations.
        observations: usize,
        /// Unknowns.
        unknowns: usize,
    },
}

impl Display for NoFit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoFit::NoStart => f.write_str("the model has no finite value where the search begins"),
            NoFit::NoMinimum => f.write_str("the search for the parameters found no minimum"),
            NoFit::Undetermined(name) => {
                write!(f, "the recording does not determine the parameter {name}")
            }
            NoFit::TooFew {
                observations,
                unknowns,
            } => write!(f, "{observations} observations for {unknowns} unknowns"),
        }
    }
}

impl std::error::Error for NoFit {}

/// Fits the model with the given standard uncertainties of the observations.
///
/// # Errors
/// When the recording does not determine the parameters, or the search fails.
pub fn fit(design: &Design<'_>, u: &DVector<f64>) -> Result<Fit, NoFit> {
    let count = design.unknowns.len();
    if design.observations() + design.priors() <= count {
        return Err(NoFit::TooFew {
            observations: design.observations(),
            unknowns: count,
        });
    }
    let problem = Problem::new(design, Weights::of(u));
    let parameters: Vec<usize> = (0..design.case.parameters.len()).collect();
    let is_linear = design.case.equations.are_affine_in(&parameters);
    let mut best: Option<(f64, Fit)> = None;
    let mut failure = NoFit::NoStart;
    for start in starts(design) {
        let is_better =
            |sum: f64| (best.as_ref()).is_none_or(|(least, _): &(f64, Fit)| sum < 0.999 * least);
        let is_lost = best.as_ref().is_some_and(|(_, fit)| fit.lost.is_some());
        // Where a search came to no end, others have to show first that they get further.
        let from = match is_lost {
            true => (problem.glance(&start))
                .filter(|(sum, _)| is_better(*sum))
                .map(|(_, fit)| fit.unknowns),
            false => Some(start),
        };
        match from.map(|from| problem.search(from)) {
            Some(Ok((sum, fit))) if is_better(sum) => best = Some((sum, fit)),
            Some(Err(why)) => failure = why,
            _ => {}
        }
        // A model that is linear in its parameters has one minimum.
        if best.is_some() && is_linear {
            break;
        }
    }
    best.map(|(_, fit)| without_turns(design, fit))
        .ok_or(failure)
}

/// Angles that the search left whole turns away from zero, within half a turn of it. Where a start or a
/// value is stated, that chooses the turn.
fn without_turns(design: &Design<'_>, mut fit: Fit) -> Fit {
    for (place, unknown) in design.unknowns.iter().enumerate() {
        let is_open = unknown.stated().is_none();
        let Some(turn) = design.turn_of(unknown).filter(|_| is_open) else {
            continue;
        };
        let turns = (fit.unknowns[place] / turn).round();
        if turns == 0.0 {
            continue;
        }
        let mut unwound = fit.unknowns.clone();
        unwound[place] -= turns * turn;
        let unwound = Fit {
            lost: fit.lost,
            ..at(design, unwound)
        };
        if same_values(&fit, &unwound) {
            fit = unwound;
        }
    }
    fit
}

/// Whether a model has the same values, but for rounding and what nobody would see beside the residuals.
fn same_values(one: &Fit, other: &Fit) -> bool {
    /// Sines of some thousand turns lose this much.
    const ROUNDING: f64 = 1e-12;
    /// Share of the residuals that does not show.
    const UNSEEN: f64 = 1e-3;
    let rms = one.residuals.norm() / (one.residuals.len().max(1) as f64).sqrt();
    let values = one.linear.values.iter().zip(&other.linear.values);
    values.into_iter().all(|(one, other)| {
        let largest = largest(one);
        let near = (UNSEEN * rms).min(1e-9 * largest).max(ROUNDING * largest);
        one.iter().zip(other).all(|(a, b)| (a - b).abs() <= near)
    })
}

/// Fits the model from one starting point.
///
/// # Errors
/// As [`fit`].
pub fn from(design: &Design<'_>, u: &DVector<f64>, start: DVector<f64>) -> Result<Fit, NoFit> {
    let found = Problem::new(design, Weights::of(u)).search(start);
    found.map(|(_, fit)| fit)
}

/// Fits the model from a place that should be near; where that leads to no minimum, from elsewhere, where a good start shows soon.
///
/// # Errors
/// As [`fit`].
pub fn near(design: &Design<'_>, weights: Weights<'_>, start: DVector<f64>) -> Result<Fit, NoFit> {
    let problem = Problem::new(design, weights);
    match problem.search(start) {
        Ok((_, found)) if found.lost.is_none() => Ok(found),
        first => {
            let starts = starts(design).into_iter();
            let others = starts.filter_map(|start| problem.glance(&start));
            let best = others.min_by(|a, b| a.0.total_cmp(&b.0));
            match best {
                Some((_, fit)) => Ok(without_turns(design, fit)),
                None => first.map(|(_, fit)| fit),
            }
        }
    }
}

/// The model at given unknowns, without a search.
pub fn at(design: &Design<'_>, unknowns: DVector<f64>) -> Fit {
    let linear = design.linear(&unknowns);
    let modelled = design.observed_column(|response| linear.values[response].clone());
    let observed = design.observed_column(|response| design.observed(response));
    Fit {
        jacobian: design.jacobian(&linear),
        residuals: observed - modelled,
        unknowns,
        linear,
        lost: None,
    }
}

/// Points from which the search begins: what is stated, and orders of magnitude for the rest.
fn starts(design: &Design<'_>) -> Vec<DVector<f64>> {
    let observed = design.observed_column(|response| design.observed(response));
    let mean = observed.mean();
    let fill = |value: f64| design.stated_or(value);
    let mut starts = vec![fill(1.0)];
    let mut unknowns = design.unknowns.iter();
    if unknowns.any(|unknown| unknown.stated().is_none()) {
        starts.extend([0.1, 0.01, 10.0, mean, -1.0].map(fill));
    }
    starts
}

/// What is minimised: squares of the weighted residuals, and of what is known beforehand.
struct Problem<'f, 'c> {
    design: &'f Design<'c>,
    observed: DVector<f64>,
    weights: Weights<'f>,
    /// Unknowns of which something is known beforehand: place, value and standard uncertainty.
    priors: Vec<(usize, f64, f64)>,
}

impl<'f, 'c> Problem<'f, 'c> {
    fn new(design: &'f Design<'c>, weights: Weights<'f>) -> Problem<'f, 'c> {
        let known = design.unknowns.iter().enumerate();
        let known = known.filter_map(|(place, unknown)| {
            let (value, u) = unknown.prior?;
            Some((place, value, u))
        });
        Problem {
            design,
            observed: design.observed_column(|response| design.observed(response)),
            weights,
            priors: known.collect(),
        }
    }

    /// The fit to which a start leads, with its χ².
    fn search(&self, start: DVector<f64>) -> Result<(f64, Fit), NoFit> {
        let first = self.at(start.as_slice(), None).ok_or(NoFit::NoStart)?;
        if start.is_empty() {
            return Ok((first.chi_squared(), at(self.design, start)));
        }
        let (unknowns, linear, lost) = match minimise(self, start.as_slice()) {
            Ok(minimum) => (minimum.parameters, minimum.linear, None),
            Err(Stuck::Lost {
                iterations,
                parameters,
            }) => {
                let linear = self.at(&parameters, None).ok_or(NoFit::NoMinimum)?;
                (parameters, linear, Some(iterations))
            }
            Err(Stuck::Start) => return Err(NoFit::NoStart),
            Err(Stuck::Flat { parameters }) => {
                let nothing = first.jacobian.iter().flatten().all(|slope| *slope == 0.0);
                let name = |place: &usize| self.design.unknowns[*place].name.clone();
                return Err(match parameters.first().map(name) {
                    Some(name) if !nothing => NoFit::Undetermined(name),
                    _ => NoFit::NoMinimum,
                });
            }
        };
        self.determined(&linear)?;
        let fit = Fit {
            lost,
            ..at(self.design, DVector::from_vec(unknowns))
        };
        Ok((linear.chi_squared(), fit))
    }

    /// The fit to which a short search leads, with its χ².
    fn glance(&self, start: &DVector<f64>) -> Option<(f64, Fit)> {
        let Minimum {
            parameters, linear, ..
        } = glance(self, start.as_slice())?;
        self.determined(&linear).ok()?;
        let fit = at(self.design, DVector::from_vec(parameters));
        Some((linear.chi_squared(), fit))
    }

    /// Whether every unknown has an effect of its own on the fitted values.
    fn determined(&self, linear: &least_squares::Linear) -> Result<(), NoFit> {
        const DEPENDENT: f64 = 1e-9;
        let columns = linear.jacobian.iter().cloned().map(DVector::from_vec);
        let columns: Vec<DVector<f64>> = columns.collect();
        let r = DMatrix::from_columns(&columns).qr().r();
        for (place, column) in columns.iter().enumerate() {
            let own = r[(place, place)].abs();
            if own.is_nan() || own <= DEPENDENT * column.norm() {
                let name = &self.design.unknowns[place].name;
                return Err(NoFit::Undetermined(name.clone()));
            }
        }
        Ok(())
    }
}

impl Residuals for Problem<'_, '_> {
    /// Rows of the observations, then those of what is known beforehand.
    fn at(
        &self,
        unknowns: &[f64],
        _near: Option<&least_squares::Linear>,
    ) -> Option<least_squares::Linear> {
        let fit = at(self.design, DVector::from_column_slice(unknowns));
        let rows = |column: &DVector<f64>, known: &dyn Fn(&(usize, f64, f64)) -> f64| {
            let own = self.weights.weighted(column);
            let own = own.iter().copied();
            own.chain(self.priors.iter().map(known))
                .collect::<Vec<f64>>()
        };
        let column = |place: usize| {
            let slope = |(at, _, u): &(usize, f64, f64)| if *at == place { 1.0 / u } else { 0.0 };
            rows(&fit.jacobian.column(place).into_owned(), &slope)
        };
        let linear = least_squares::Linear::new(
            rows(&fit.residuals, &|(at, value, u)| {
                (value - unknowns[*at]) / u
            }),
            (0..unknowns.len()).map(column).collect(),
            rows(&self.observed, &|(_, value, u)| value / u),
        );
        let mut slopes = linear.jacobian.iter().flatten();
        let finite = linear.chi_squared().is_finite() && slopes.all(|slope| slope.is_finite());
        finite.then_some(linear)
    }
}
