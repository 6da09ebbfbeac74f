//! Whether residuals are as large as the known errors of the readings let expect.
//!
//! By generalised least squares, whatever the weights of the fit are: of a reading with the variance v by itself and of errors e of unit
//! variance that it shares with others, the sum Σ(y − f − Ue)²/v + Σe² has at its least, over the parameters and over e, the distribution
//! of χ². Errors that the parameters absorb have no part in it.

use nalgebra::{DMatrix, DVector};

use super::campaign::Scatter;
use super::errors::OfDoubt;
use super::stack::{Row, Stack};
use gumption_core::least_squares::{span, without};
use gumption_core::special::{chi_squared_sf, f_sf, student_t_score};

/// Whether residuals are as large as the known errors of the readings let expect.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ScatterTest {
    /// The residual standard deviation s to expect, in the unit of the response.
    pub expected: f64,
    /// The least Σ(r/u)² over the parameters and the errors that readings share; of a u with finite ν the normal deviation of the same
    /// probability in place of r/u.
    pub chi_squared: f64,
    /// ν: the readings and what is known of parameters, less the directions that the parameters take.
    pub dof: f64,
    /// The probability of a larger χ²; of F where readings share a u with finite ν.
    pub p_value: f64,
    /// What that says of the errors.
    pub misfit: Option<Misfit>,
}

impl ScatterTest {
    /// None where residuals tell the scatter and no samples do: stated errors are a part of it then, and only residuals that
    /// are smaller say something of them.
    pub(super) fn of(
        found: &Agreement,
        expected: f64,
        way: Scatter,
        sampled: bool,
    ) -> Option<ScatterTest> {
        let p_value = found.p_value();
        let misfit = Misfit::of(p_value, way, sampled);
        let partial = way == Scatter::Residuals && !sampled;
        (misfit.is_some() || !partial).then_some(ScatterTest {
            expected,
            chi_squared: found.chi_squared,
            dof: found.dof,
            p_value,
            misfit,
        })
    }

    /// χ²/ν, 1 where the residuals are as large as expected.
    pub fn reduced(&self) -> f64 {
        self.chi_squared / self.dof
    }
}

/// What residuals say of the known errors of their readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misfit {
    /// They are larger than the samples of the dwells let expect, and tell the scatter themselves: something changes
    /// from dwell to dwell.
    BetweenDwells,
    /// They are larger than the errors that make the uncertainties: these are too small.
    Larger,
    /// They are smaller than the errors of the readings.
    Smaller,
}

/// Probability of a statistic as far out, below which residuals are said to be no scatter of the stated size or order.
pub(super) const RARE: f64 = 0.005;

impl Misfit {
    /// From the probability of a larger χ². Where residuals tell the scatter, they may be larger than stated errors.
    fn of(p_value: f64, way: Scatter, sampled: bool) -> Option<Misfit> {
        let large = p_value < RARE;
        match way {
            Scatter::Residuals if large && sampled => Some(Misfit::BetweenDwells),
            Scatter::Dwells | Scatter::Stated if large => Some(Misfit::Larger),
            _ if p_value > 1.0 - RARE => Some(Misfit::Smaller),
            _ => None,
        }
    }
}

/// Readings of one response beside what is known of the parameters, in units of standard uncertainties, as least squares.
pub(super) struct Rows {
    /// Places of the readings, and of what is known of parameters.
    places: Vec<usize>,
    /// How many of them are readings.
    readings: usize,
    /// The standard uncertainty of each row by itself.
    u: Vec<f64>,
    /// What the parameters leave of the residuals.
    left: DVector<f64>,
    /// The directions that the parameters take.
    taken: DMatrix<f64>,
}

/// What parameters take along a direction of unit length that is no longer than this is rounding.
const FLAT: f64 = 1e-10;

impl Rows {
    /// Of readings with these standard uncertainties, by the residuals of a fit and the slopes of its equations.
    pub fn of(
        stack: &Stack<'_>,
        readings: &[usize],
        u: &[f64],
        (residuals, jacobian): (&[f64], &DMatrix<f64>),
    ) -> Rows {
        let known = stack.rows.iter().enumerate();
        let known: Vec<(usize, f64)> = known
            .filter_map(|(row, of)| match of {
                Row::Prior { parameter } => {
                    let prior = stack.campaign.experiment.parameters[*parameter].known?;
                    Some((row, prior.u))
                }
                Row::Reading { .. } => None,
            })
            .collect();
        let places: Vec<usize> = readings
            .iter()
            .copied()
            .chain(known.iter().map(|one| one.0))
            .collect();
        let u: Vec<f64> = u
            .iter()
            .copied()
            .chain(known.iter().map(|one| one.1))
            .collect();
        let slopes = DMatrix::from_fn(places.len(), jacobian.ncols(), |at, parameter| {
            jacobian[(places[at], parameter)] / u[at]
        });
        let all = DVector::from_fn(places.len(), |at, _| residuals[places[at]] / u[at]);
        let taken = span(slopes, FLAT);
        let left = &all - &taken * taken.tr_mul(&all);
        Rows {
            readings: readings.len(),
            places,
            u,
            left,
            taken,
        }
    }

    /// Rows less the directions that parameters take.
    pub fn dof(&self) -> usize {
        self.places.len() - self.taken.ncols()
    }

    /// The sum of squares that the parameters leave.
    pub fn sum(&self) -> f64 {
        self.left.norm_squared()
    }

    /// What is left of each reading over its standard deviation, √(sum/ν · (1 − h)); NaN where the parameters leave it nothing.
    pub fn standardised(&self) -> Vec<f64> {
        let s = (self.sum() / self.dof() as f64).sqrt();
        let of_row = |row: usize| {
            let free = 1.0 - self.taken.row(row).norm_squared();
            match free > LEAST_FREE && s > 0.0 {
                true => self.left[row] / (s * free.sqrt()),
                false => f64::NAN,
            }
        };
        (0..self.readings).map(of_row).collect()
    }

    /// What an error that each reading has for itself lets expect of the sum of squares.
    pub fn expected(&self, error: &OfDoubt<'_>) -> f64 {
        let free = |row: usize| 1.0 - self.taken.row(row).norm_squared();
        self.expected_of(error, free)
    }

    /// The same where so much of the deviation of each row is left free.
    fn expected_of(&self, error: &OfDoubt<'_>, free: impl Fn(usize) -> f64) -> f64 {
        let share = |row: usize| (error.changes[self.places[row]] / self.u[row]).powi(2);
        (0..self.readings).map(|row| free(row) * share(row)).sum()
    }

    /// The same rows where errors that readings share take their directions, however large they are; `None` where the parameters take
    /// all of these.
    pub fn beside(&self, errors: &[OfDoubt<'_>]) -> Option<Rows> {
        let (shared, _) = self.shared(errors);
        let columns: Vec<_> = self
            .taken
            .column_iter()
            .chain(shared.column_iter())
            .collect();
        let taken = match columns.is_empty() {
            true => return None,
            false => span(DMatrix::from_columns(&columns), FLAT),
        };
        (taken.ncols() > self.taken.ncols()).then(|| Rows {
            places: self.places.clone(),
            readings: self.readings,
            u: self.u.clone(),
            left: &self.left - &taken * taken.tr_mul(&self.left),
            taken,
        })
    }

    /// What the errors that readings share do to the rows, and to which of the stated ones each belongs.
    fn shared(&self, errors: &[OfDoubt<'_>]) -> (DMatrix<f64>, Vec<usize>) {
        let shared = errors.iter().enumerate().filter(|(_, one)| one.is_shared());
        let each = shared.flat_map(|(at, one)| {
            let columns = one.columns(&self.places, &self.u).into_iter();
            columns.map(move |column| (column, at))
        });
        let (columns, of): (Vec<DVector<f64>>, Vec<usize>) = each.unzip();
        let matrix = match columns.is_empty() {
            true => DMatrix::zeros(self.places.len(), 0),
            false => DMatrix::from_columns(&columns),
        };
        (matrix, of)
    }
}

/// What is known of a reading by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Itself {
    /// Its standard uncertainty, of samples what those of all readings tell.
    pub u: f64,
    /// That over what its own samples tell.
    pub factor: f64,
    /// Degrees of freedom of what its own samples tell; infinite without any.
    pub dof: f64,
}

impl Itself {
    /// Without samples.
    pub fn certain(u: f64) -> Itself {
        Itself {
            u,
            factor: 1.0,
            dof: f64::INFINITY,
        }
    }

    /// (r/u)². A u from few samples is now too small and now too large: r/u has the tails of t, and counts as the normal
    /// deviation of the same probability, which leaves the sum the distribution of χ².
    fn square(&self, ratio: f64, free: f64) -> f64 {
        if self.dof.is_infinite() || free <= LEAST_FREE {
            return ratio.powi(2);
        }
        student_t_score(ratio * self.factor / free.sqrt(), self.dof).powi(2) * free
    }
}

/// Of a row that the equations leave less free its residual says nothing.
const LEAST_FREE: f64 = 1e-6;

/// Residuals held against the errors that are known.
pub(super) struct Agreement {
    pub chi_squared: f64,
    pub dof: f64,
    /// Of the estimate of one u for many readings.
    stated_dof: f64,
}

impl Agreement {
    /// Of rows in units of what `each` reading has by itself, all certain where there are none.
    pub fn of(rows: &Rows, errors: &[OfDoubt<'_>], each: &[Itself]) -> Option<Agreement> {
        let (columns, of) = rows.shared(errors);
        let shared = without(&columns, &rows.taken);
        let count = shared.ncols();
        let known = DMatrix::identity(count, count) + shared.tr_mul(&shared);
        let inverse = known.cholesky()?.inverse();
        let found = &inverse * shared.tr_mul(&rows.left);
        let left = &rows.left - &shared * &found;
        let by_shared = &shared * &inverse;
        let free = |row: usize| {
            let taken = rows.taken.row(row).norm_squared();
            1.0 - taken - by_shared.row(row).dot(&shared.row(row))
        };
        let square = |row: usize| match each.get(row) {
            Some(own) => own.square(left[row], free(row)),
            None => left[row].powi(2),
        };
        let sum: f64 = (0..left.len()).map(square).sum();
        let dof = rows.dof() as f64;
        // Mean square of what each stated error makes of it (Welch and Satterthwaite).
        let of_doubt = |(at, one): (usize, &OfDoubt<'_>)| {
            let part: f64 = match one.is_shared() {
                true => (0..count)
                    .filter(|error| of[*error] == at)
                    .map(|error| 1.0 - inverse[(error, error)])
                    .sum(),
                false => rows.expected_of(one, free),
            };
            (part / dof).powi(2) / one.doubt.dof
        };
        let finite = errors
            .iter()
            .enumerate()
            .filter(|(_, one)| one.doubt.dof.is_finite());
        let fourth: f64 = finite.map(of_doubt).sum();
        (dof > 0.0).then_some(Agreement {
            chi_squared: sum + found.norm_squared(),
            dof,
            stated_dof: 1.0 / fourth,
        })
    }

    /// The probability of a larger χ²; of F where readings share a u with finite ν.
    fn p_value(&self) -> f64 {
        match self.stated_dof.is_finite() {
            true => f_sf(self.chi_squared / self.dof, self.dof, self.stated_dof),
            false => chi_squared_sf(self.chi_squared, self.dof),
        }
    }
}
