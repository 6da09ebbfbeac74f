//! The declared model fitted to the recording by weighted least squares (Levenberg–Marquardt).

use nalgebra::{DMatrix, DVector};

use super::frame::{Frame, Linear};

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
}

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoFit {
    /// The model has no finite value where the search begins.
    NoStart,
    /// The search went nowhere.
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

/// Fits the model with the given standard uncertainties of the observations.
///
/// # Errors
/// When the recording does not determine the parameters, or the search fails.
pub fn fit(frame: &Frame<'_>, u: &DVector<f64>) -> Result<Fit, NoFit> {
    let count = frame.unknowns.len();
    let priors = frame
        .unknowns
        .iter()
        .filter(|unknown| unknown.prior.is_some())
        .count();
    if frame.observations() + priors <= count {
        return Err(NoFit::TooFew {
            observations: frame.observations(),
            unknowns: count,
        });
    }
    let problem = Problem {
        frame,
        observed: frame.observed_column(|response| frame.observed(response)),
        u,
    };
    let mut best: Option<(f64, Fit)> = None;
    let mut failure = NoFit::NoStart;
    for start in starts(frame) {
        match problem.search(start) {
            Ok((sum, fit)) if best.as_ref().is_none_or(|(least, _)| sum < 0.999 * least) => {
                best = Some((sum, fit))
            }
            Ok(_) => {}
            Err(why) => failure = why,
        }
        // A model that is linear in its parameters has one minimum.
        if best.is_some() && problem.is_linear() {
            break;
        }
    }
    best.map(|(_, fit)| without_turns(frame, fit))
        .ok_or(failure)
}

/// Angles that the search left whole turns away from zero, within half a turn of it. Where a start or a
/// value is stated, that chooses the turn.
fn without_turns(frame: &Frame<'_>, mut fit: Fit) -> Fit {
    for (place, unknown) in frame.unknowns.iter().enumerate() {
        let stated = unknown.start.is_some() || unknown.prior.is_some();
        let Some(turn) = frame.turn_of(unknown).filter(|_| !stated) else {
            continue;
        };
        let turns = (fit.unknowns[place] / turn).round();
        if turns == 0.0 {
            continue;
        }
        let mut unwound = fit.unknowns.clone();
        unwound[place] -= turns * turn;
        let unwound = at(frame, unwound);
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
        let largest = (one.iter()).fold(0.0_f64, |most, value| most.max(value.abs()));
        let near = (UNSEEN * rms).min(1e-9 * largest).max(ROUNDING * largest);
        one.iter().zip(other).all(|(a, b)| (a - b).abs() <= near)
    })
}

/// Fits the model from one starting point.
///
/// # Errors
/// As [`fit`].
pub fn from(frame: &Frame<'_>, u: &DVector<f64>, start: DVector<f64>) -> Result<Fit, NoFit> {
    let problem = Problem {
        frame,
        observed: frame.observed_column(|response| frame.observed(response)),
        u,
    };
    problem.search(start).map(|(_, fit)| fit)
}

/// The model at given unknowns, without a search.
pub fn at(frame: &Frame<'_>, unknowns: DVector<f64>) -> Fit {
    let linear = frame.linear(&unknowns);
    let modelled = frame.observed_column(|response| linear.values[response].clone());
    let observed = frame.observed_column(|response| frame.observed(response));
    Fit {
        jacobian: frame.jacobian(&linear),
        residuals: observed - modelled,
        unknowns,
        linear,
    }
}

/// Points from which the search begins: what is stated, and orders of magnitude for the rest.
fn starts(frame: &Frame<'_>) -> Vec<DVector<f64>> {
    let observed = frame.observed_column(|response| frame.observed(response));
    let mean = observed.mean();
    let fill = |value: f64| {
        let of = frame.unknowns.iter().map(|unknown| {
            let known = unknown.start.or(unknown.prior.map(|(value, _)| value));
            known.unwrap_or(value)
        });
        DVector::from_iterator(frame.unknowns.len(), of)
    };
    let open = frame
        .unknowns
        .iter()
        .filter(|unknown| unknown.start.is_none() && unknown.prior.is_none());
    let mut starts = vec![fill(1.0)];
    if open.count() > 0 {
        starts.extend([0.1, 0.01, 10.0, mean, -1.0].map(fill));
    }
    starts
}

struct Problem<'f, 'c> {
    frame: &'f Frame<'c>,
    observed: DVector<f64>,
    u: &'f DVector<f64>,
}

impl Problem<'_, '_> {
    fn is_linear(&self) -> bool {
        let parameters: Vec<usize> = (0..self.frame.case.parameters.len()).collect();
        self.frame.case.equations.are_affine_in(&parameters)
    }

    /// Weighted residuals, prior rows at the end.
    fn weighted(&self, unknowns: &DVector<f64>, linear: &Linear) -> DVector<f64> {
        let modelled = self
            .frame
            .observed_column(|response| linear.values[response].clone());
        let rows = (&self.observed - modelled).component_div(self.u);
        let priors = self.frame.unknowns.iter().zip(unknowns.iter());
        let priors =
            priors.filter_map(|(unknown, now)| unknown.prior.map(|(value, u)| (value - now) / u));
        DVector::from_iterator(
            rows.len() + priors.clone().count(),
            rows.iter().copied().chain(priors),
        )
    }

    fn weighted_jacobian(&self, linear: &Linear) -> DMatrix<f64> {
        let mut jacobian = self.frame.jacobian(linear);
        for mut column in jacobian.column_iter_mut() {
            column.component_div_assign(self.u);
        }
        let (rows, columns) = jacobian.shape();
        let known: Vec<(usize, f64)> = self
            .frame
            .unknowns
            .iter()
            .enumerate()
            .filter_map(|(at, unknown)| Some((at, unknown.prior?.1)))
            .collect();
        let mut jacobian = jacobian.resize(rows + known.len(), columns, 0.0);
        for (row, (at, u)) in known.iter().enumerate() {
            jacobian[(rows + row, *at)] = 1.0 / u;
        }
        jacobian
    }

    fn search(&self, start: DVector<f64>) -> Result<(f64, Fit), NoFit> {
        const STEPS: usize = 200;
        let mut unknowns = start;
        let mut linear = self.frame.linear(&unknowns);
        let mut residuals = self.weighted(&unknowns, &linear);
        let mut sum = residuals.norm_squared();
        if !sum.is_finite() {
            return Err(NoFit::NoStart);
        }
        let mut damping = if self.is_linear() { 0.0 } else { 1e-3 };
        let mut settled = false;
        for _ in 0..STEPS {
            let jacobian = self.weighted_jacobian(&linear);
            let Some(step) = self.step(&jacobian, &residuals, damping)? else {
                damping = (damping * 10.0).max(1e-6);
                if damping > 1e12 {
                    break;
                }
                continue;
            };
            let next = &unknowns + &step;
            let next_linear = self.frame.linear(&next);
            let next_residuals = self.weighted(&next, &next_linear);
            let next_sum = next_residuals.norm_squared();
            if next_sum.is_finite() && next_sum <= sum * (1.0 + 1e-14) {
                // The size of a step in standard uncertainties of the fitted values.
                let moved = (&jacobian * &step).norm();
                settled = moved <= 1e-9 * (1.0 + sum.sqrt())
                    || sum - next_sum <= 1e-13 * sum && damping <= 1e-6;
                (unknowns, linear, residuals, sum) = (next, next_linear, next_residuals, next_sum);
                damping = if damping > 1e-9 { damping * 0.2 } else { 0.0 };
                if settled {
                    break;
                }
            } else {
                damping = (damping * 10.0).max(1e-6);
                if damping > 1e12 {
                    break;
                }
            }
        }
        let _ = settled;
        let unknowns_at = unknowns;
        self.determined(&linear)?;
        Ok((sum, at(self.frame, unknowns_at)))
    }

    /// (JᵀJ + λ diag)⁻¹Jᵀr by QR of scaled columns; nothing if the columns depend on one another here.
    fn step(
        &self,
        jacobian: &DMatrix<f64>,
        residuals: &DVector<f64>,
        damping: f64,
    ) -> Result<Option<DVector<f64>>, NoFit> {
        let (rows, columns) = jacobian.shape();
        if columns == 0 {
            return Ok(Some(DVector::zeros(0)));
        }
        if jacobian.iter().any(|x| !x.is_finite()) {
            return Err(NoFit::NoMinimum);
        }
        let lengths: Vec<f64> = jacobian.column_iter().map(|c| c.norm()).collect();
        if lengths.iter().all(|length| *length == 0.0) {
            return Err(NoFit::NoMinimum);
        }
        let mut scaled = jacobian.clone().resize(rows + columns, columns, 0.0);
        for (at, length) in lengths.iter().enumerate() {
            let scale = if *length > 0.0 { 1.0 / length } else { 0.0 };
            scaled.column_mut(at).scale_mut(scale);
            scaled[(rows + at, at)] = if *length > 0.0 { damping.sqrt() } else { 1.0 };
        }
        let right = residuals.clone().resize_vertically(rows + columns, 0.0);
        let qr = scaled.qr();
        let target = qr.q().tr_mul(&right);
        let r = qr.r();
        if (0..columns).any(|i| r[(i, i)].abs() < 1e-13) {
            return Ok(None);
        }
        let Some(mut step) = r.solve_upper_triangular(&target) else {
            return Ok(None);
        };
        for (value, length) in step.iter_mut().zip(&lengths) {
            *value = if *length > 0.0 { *value / length } else { 0.0 };
        }
        Ok(Some(step))
    }

    /// Whether every unknown has an effect of its own on the fitted values.
    fn determined(&self, linear: &Linear) -> Result<(), NoFit> {
        const DEPENDENT: f64 = 1e-9;
        let jacobian = self.weighted_jacobian(linear);
        if jacobian.ncols() == 0 {
            return Ok(());
        }
        let lengths: Vec<f64> = jacobian.column_iter().map(|c| c.norm()).collect();
        let r = jacobian.qr().r();
        for (at, length) in lengths.iter().enumerate() {
            let own = r[(at, at)].abs();
            if own.is_nan() || own <= DEPENDENT * length {
                return Err(NoFit::Undetermined(self.frame.unknowns[at].name.clone()));
            }
        }
        Ok(())
    }
}
