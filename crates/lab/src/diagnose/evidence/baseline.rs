//! Whitening, projection, and what the data say of the declared parameters.

use std::sync::Arc;

use gumption_core::least_squares::products;
use nalgebra::{DMatrix, DVector};

use super::noise::{Covariance, Factor, Noise};
use super::refusal::Refusal;

/// What is known of the parameters beforehand: rows of unit variance, each saying that a combination
/// of the parameters has a value. u⁻¹ in the column of a parameter and u⁻¹(x − x₀) as its residual
/// states x ± u.
#[derive(Debug, Clone, PartialEq)]
pub struct Prior {
    /// k × p.
    pub jacobian: DMatrix<f64>,
    /// k values, as the differences from those at which the residuals were formed.
    pub residuals: DVector<f64>,
}

/// A recording before any effect is added: what its declared parameters explain and what they leave.
#[derive(Debug, Clone)]
pub struct Baseline {
    rows: usize,
    /// W = L⁻¹.
    whitener: Factor,
    /// Factors of the draws of the covariance matrix.
    draws: Vec<Arc<Factor>>,
    scale_dof: f64,
    tails: Vec<f64>,
    /// Q of WJ, (n + k) × p.
    absorbed: DMatrix<f64>,
    /// R⁻¹ of WJ, p × p.
    inverse: DMatrix<f64>,
    /// QᵀWr.
    explained: DVector<f64>,
    /// PWr, n + k.
    left: DVector<f64>,
}

/// How well parameters are known that are fitted with weights which the noise need not have.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// Variances of the parameters.
    pub variances: DVector<f64>,
    /// Expectation of χ².
    pub expected: f64,
    /// Degrees of freedom of χ²: of a multiple of a χ² with its expectation and variance.
    pub dof: f64,
}

/// A column of WJ whose length falls by this factor when the columns before it are projected out says
/// nothing of its own.
const DEPENDENT: f64 = 1e-9;

impl Prior {
    /// Nothing is known beforehand of the p parameters.
    pub fn none(parameters: usize) -> Prior {
        Prior {
            jacobian: DMatrix::zeros(0, parameters),
            residuals: DVector::zeros(0),
        }
    }
}

impl Baseline {
    /// Whitens and projects n residuals (observed less modelled, at the values of the p parameters
    /// where the n × p Jacobian of the modelled output was taken).
    ///
    /// # Errors
    ///
    /// Numbers that are not finite, a covariance matrix that is none, parameters that the recording does
    /// not determine, and recordings without a degree of freedom.
    pub fn new(
        jacobian: &DMatrix<f64>,
        residuals: &DVector<f64>,
        noise: &Noise,
        prior: &Prior,
    ) -> Result<Baseline, Refusal> {
        let (rows, parameters) = jacobian.shape();
        check_finite(jacobian, residuals, prior)?;
        let whitener = Factor::whitening(&noise.covariance)?;
        let draws = factors(&noise.draws)?;
        let total = rows + prior.residuals.len();
        if total <= parameters {
            return Err(Refusal::NoFreedom {
                rows: total,
                parameters,
            });
        }
        let whitened = stacked(whitener.times(jacobian), &prior.jacobian);
        let column = |of: &DVector<f64>| DMatrix::from_columns(std::slice::from_ref(of));
        let response = stacked(
            whitener.times(&column(residuals)),
            &column(&prior.residuals),
        );
        let lengths: Vec<f64> = whitened.column_iter().map(|c| c.norm()).collect();
        let qr = whitened.qr();
        let (absorbed, triangle) = (qr.q(), qr.r());
        for (parameter, length) in lengths.iter().enumerate() {
            if !(triangle[(parameter, parameter)].abs() > DEPENDENT * length) {
                return Err(Refusal::Dependent { parameter });
            }
        }
        let inverse = triangle
            .solve_upper_triangular(&DMatrix::identity(parameters, parameters))
            .ok_or(Refusal::Dependent { parameter: 0 })?;
        let explained = absorbed.tr_mul(&response);
        let left = response - &absorbed * &explained;
        Ok(Baseline {
            rows,
            whitener,
            draws,
            scale_dof: noise.scale_dof,
            tails: noise.tails.clone(),
            explained: explained.column(0).into_owned(),
            left: left.column(0).into_owned(),
            absorbed,
            inverse,
        })
    }

    /// Rows of the recording, n.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Free parameters, p.
    pub fn parameters(&self) -> usize {
        self.inverse.nrows()
    }

    /// Degrees of freedom of the residuals, m.
    pub fn dof(&self) -> usize {
        self.left.len() - self.parameters()
    }

    /// Sum of the squares of the whitened residuals.
    pub fn chi_squared(&self) -> f64 {
        self.left.norm_squared()
    }

    /// Degrees of freedom with which the scale of the noise is known.
    pub fn scale_dof(&self) -> f64 {
        self.scale_dof
    }

    /// Whitened residuals z with the parameters fitted; rows of prior knowledge stand at the end.
    pub fn residuals(&self) -> &DVector<f64> {
        &self.left
    }

    /// What has to be added to the values of the parameters to fit the recording.
    pub fn correction(&self) -> DVector<f64> {
        &self.inverse * &self.explained
    }

    /// Covariance matrix of the fitted parameters.
    pub fn covariance(&self) -> DMatrix<f64> {
        &self.inverse * self.inverse.transpose()
    }

    /// The same where whitened rows are weighted alike but have this correlation.
    pub fn covariance_with(&self, correlation: &DMatrix<f64>) -> DMatrix<f64> {
        let gain = &self.inverse * self.absorbed.transpose();
        let (rows, known) = (
            gain.columns(0, self.rows).into_owned(),
            gain.columns_range(self.rows..).into_owned(),
        );
        &rows * correlation * rows.transpose() + &known * known.transpose()
    }

    /// How well the parameters are known where the rows have another covariance matrix Σ than the one that weights them.
    ///
    /// With C = WΣWᵀ the parameters have the covariance matrix R⁻¹QᵀCQR⁻ᵀ, and χ² = zᵀz is a quadratic form of normal
    /// errors with the expectation tr PC and the variance 2 tr PCPC; a multiple of a χ² with as much of both has
    /// (tr PC)²/tr PCPC degrees of freedom (Satterthwaite 1941).
    pub fn spread(&self, covariance: &Covariance) -> Spread {
        let known = self.left.len() - self.rows;
        let own = self.absorbed.rows(0, self.rows).into_owned();
        let (colored, trace, square) = match (&self.whitener, covariance) {
            (Factor::Diagonal(weights), Covariance::Diagonal(variances)) => {
                let own_variances = weights.component_mul(weights).component_mul(variances);
                let mut colored = own;
                for mut column in colored.column_iter_mut() {
                    column.component_mul_assign(&own_variances);
                }
                (colored, own_variances.sum(), own_variances.norm_squared())
            }
            _ => {
                let half = self.whitener.times(&covariance.to_dense());
                let whole = self.whitener.times(&half.transpose());
                (&whole * own, whole.trace(), whole.norm_squared())
            }
        };
        let colored = stacked(colored, &self.absorbed.rows(self.rows, known).into_owned());
        let along = products(&self.absorbed, &colored);
        let expected = trace + known as f64 - along.trace();
        let of_square = square + known as f64 - 2.0 * colored.norm_squared() + along.norm_squared();
        let gain = &self.inverse * along;
        let variance = |at: usize| gain.row(at).dot(&self.inverse.row(at));
        Spread {
            variances: DVector::from_fn(self.parameters(), |at, _| variance(at)),
            expected,
            dof: expected * expected / of_square,
        }
    }

    /// Errors of the predictions of some whitened rows by a fit without them, (1 − QQᵀ)⁻¹z in these rows; a direction that
    /// only they determine is predicted as it is.
    pub fn left_out(&self, rows: &[usize]) -> DVector<f64> {
        /// Part of a direction that the other rows determine at least.
        const DETERMINED: f64 = 1e-9;
        let own = self.absorbed.select_rows(rows);
        let kept = DMatrix::identity(rows.len(), rows.len()) - &own * own.transpose();
        let axes = kept.symmetric_eigen();
        let along = axes.eigenvectors.tr_mul(&self.left.select_rows(rows));
        let errors = along.zip_map(&axes.eigenvalues, |left, kept| match kept > DETERMINED {
            true => left / kept,
            false => 0.0,
        });
        axes.eigenvectors * errors
    }

    /// PWH, and the lengths of the columns of WH.
    pub(super) fn visible(&self, columns: &DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
        let whitened = self.whiten(columns);
        let lengths = whitened.column_iter().map(|c| c.norm()).collect();
        let along = products(&self.absorbed, &whitened);
        (whitened - &self.absorbed * along, lengths)
    }

    /// PWH: what columns of output units leave in the space of z.
    pub fn project(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        self.visible(columns).0
    }

    /// Share of the whitened length of each column that the parameters cannot absorb, ‖PWh‖²/‖Wh‖²; zero
    /// for a column of zeros.
    pub fn visibilities(&self, columns: &DMatrix<f64>) -> Vec<f64> {
        let (seen, lengths) = self.visible(columns);
        shares(&seen, &lengths)
    }

    /// The least of them.
    pub fn visibility(&self, columns: &DMatrix<f64>) -> f64 {
        self.visibilities(columns).into_iter().fold(1.0, f64::min)
    }

    /// Change of the fitted parameters per unit of each column's coefficient when it is adopted, p × d:
    /// −(JᵀΣ⁻¹J)⁻¹JᵀΣ⁻¹H.
    pub fn gain(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        -(&self.inverse * self.absorbed.tr_mul(&self.whiten(columns)))
    }

    /// W H, with zeros in the rows of prior knowledge.
    pub(super) fn whiten(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let prior_rows = self.left.len() - self.rows;
        stacked(
            self.whitener.times(columns),
            &DMatrix::zeros(prior_rows, columns.ncols()),
        )
    }

    /// Logarithm of |Σ|^(−½)·|JᵀΣ⁻¹J|^(−½): what a restricted likelihood has beside the residuals.
    pub(super) fn log_determinant(&self) -> f64 {
        let diagonal = self.inverse.diagonal();
        let of_parameters = diagonal.iter().map(|x| libm::log(x.abs()));
        self.whitener.log_determinant() + of_parameters.sum::<f64>()
    }

    /// Degrees of freedom that the errors of some simulated recordings have; ∞ where they are normal.
    pub(super) fn tails(&self) -> &[f64] {
        &self.tails
    }

    /// Q of WJ.
    pub(super) fn absorbed(&self) -> &DMatrix<f64> {
        &self.absorbed
    }

    /// Draws of the covariance matrix, as L with Σ = LLᵀ.
    pub(super) fn noise_draws(&self) -> &[Arc<Factor>] {
        &self.draws
    }

    /// Standard normal columns of n + k rows, given a covariance matrix Σ = LLᵀ and whitened with the best estimate.
    pub(super) fn recolor(&self, lower: &Factor, normals: &DMatrix<f64>) -> DMatrix<f64> {
        let colored = lower.times(&normals.rows(0, self.rows).into_owned());
        let prior_rows = self.left.len() - self.rows;
        stacked(
            self.whitener.times(&colored),
            &normals.rows(self.rows, prior_rows).into_owned(),
        )
    }
}

/// Factors of covariance matrices; those that follow their like share its factor.
pub(super) fn factors(draws: &[Covariance]) -> Result<Vec<Arc<Factor>>, Refusal> {
    let mut found: Vec<Arc<Factor>> = Vec::new();
    for (at, draw) in draws.iter().enumerate() {
        let like = found.last().filter(|_| draws[at - 1] == *draw);
        let factor = match like {
            Some(factor) => Arc::clone(factor),
            None => Arc::new(Factor::of(draw)?),
        };
        found.push(factor);
    }
    Ok(found)
}

fn check_finite(
    jacobian: &DMatrix<f64>,
    residuals: &DVector<f64>,
    prior: &Prior,
) -> Result<(), Refusal> {
    let bad = |jacobian: &DMatrix<f64>, residuals: &DVector<f64>| {
        let is_finite = |row: usize| {
            residuals[row].is_finite() && jacobian.row(row).iter().all(|x| x.is_finite())
        };
        (0..residuals.len()).find(|row| !is_finite(*row))
    };
    let of_prior = || Some(residuals.len() + bad(&prior.jacobian, &prior.residuals)?);
    match bad(jacobian, residuals).or_else(of_prior) {
        Some(row) => Err(Refusal::NotFinite { row }),
        None => Ok(()),
    }
}

/// Share of the squared length of each column that is left of it; zero for a column of zeros.
pub(super) fn shares(left: &DMatrix<f64>, lengths: &[f64]) -> Vec<f64> {
    let both = left.column_iter().zip(lengths);
    let share = |(left, length): (nalgebra::DVectorView<'_, f64>, &f64)| match *length > 0.0 {
        true => left.norm_squared() / (length * length),
        false => 0.0,
    };
    both.map(share).collect()
}

/// One matrix above the other.
fn stacked(above: DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    if below.nrows() == 0 {
        return above;
    }
    let mut out = DMatrix::zeros(above.nrows() + below.nrows(), above.ncols());
    out.rows_mut(0, above.nrows()).copy_from(&above);
    out.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    out
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{beside, white};
    use super::*;

    fn line(prior: &Prior, residuals: &[f64]) -> Result<Baseline, Refusal> {
        let n = residuals.len();
        let jacobian = DMatrix::from_fn(n, 2, |i, j| if j == 0 { 1.0 } else { i as f64 });
        let noise = Noise::known(Covariance::Diagonal(DVector::from_element(n, 4.0)));
        let residuals = DVector::from_row_slice(residuals);
        Baseline::new(&jacobian, &residuals, &noise, prior)
    }

    #[test]
    fn a_line_is_absorbed_and_a_bend_is_left() {
        let baseline = line(&Prior::none(2), &[1.0, 3.0, 5.0, 7.0]).unwrap();
        assert!((baseline.correction() - DVector::from_row_slice(&[1.0, 2.0])).norm() < 1e-12);
        assert!(baseline.chi_squared() < 1e-20);
        assert_eq!(baseline.dof(), 2);
        let bend = DMatrix::from_column_slice(4, 1, &[1.0, -1.0, -1.0, 1.0]);
        assert!((baseline.visibility(&bend) - 1.0).abs() < 1e-12);
        // An effect that is a slope: adopting it takes all of it from the parameter.
        let slope = DMatrix::from_column_slice(4, 1, &[0.0, 1.0, 2.0, 3.0]);
        assert!(baseline.project(&slope).norm() < 1e-12);
        let gain = baseline.gain(&slope);
        assert!((gain[(1, 0)] + 1.0).abs() < 1e-12 && gain[(0, 0)].abs() < 1e-12);
    }

    #[test]
    fn rows_are_predicted_by_the_others() {
        let baseline = line(&Prior::none(2), &[0.0, 0.0, 0.0, 6.0]).unwrap();
        // The line through the first three says zero; σ = 2.
        assert!((baseline.left_out(&[3])[0] - 3.0).abs() < 1e-9);
        // Without three of four rows there is no line: one of two directions is told by nothing else.
        let alone = baseline.left_out(&[1, 2, 3]);
        assert!(alone.iter().all(|error| error.abs() < 6.0));
    }

    #[test]
    fn knowledge_beforehand_counts_as_rows() {
        let prior = Prior {
            jacobian: DMatrix::from_row_slice(1, 2, &[0.0, 1e6]),
            residuals: DVector::zeros(1),
        };
        let baseline = line(&prior, &[0.0, 2.0, 4.0]).unwrap();
        // The slope is held at zero, and the recording disagrees.
        assert!(baseline.correction()[1].abs() < 1e-9);
        assert!((baseline.chi_squared() - 2.0).abs() < 1e-6);
        assert_eq!(baseline.dof(), 2);
    }

    /// Correlation φ^|i−j| of n rows.
    fn remembering(n: usize, phi: f64) -> DMatrix<f64> {
        DMatrix::from_fn(n, n, |i, j| libm::pow(phi, i.abs_diff(j) as f64))
    }

    fn slopes(n: usize) -> DMatrix<f64> {
        DMatrix::from_fn(n, 2, |i, j| libm::pow(i as f64 / n as f64, j as f64))
    }

    fn long_line(n: usize, residuals: &DVector<f64>) -> Baseline {
        let noise = Noise::with_scale_dof(Covariance::Diagonal(DVector::from_element(n, 4.0)), 0.0);
        beside(&slopes(n), residuals, &noise)
    }

    #[test]
    fn the_spread_with_the_weights_own_noise_is_the_usual_one() {
        let baseline = long_line(20, &DVector::zeros(20));
        let own = baseline.spread(&Covariance::Diagonal(DVector::from_element(20, 4.0)));
        assert!((own.variances - baseline.covariance().diagonal()).norm() < 1e-12);
        assert!((own.expected - 18.0).abs() < 1e-12 && (own.dof - 18.0).abs() < 1e-12);
    }

    /// Traces of PC and PCPC with the matrices written out, and the variances of (JᵀJ)⁻¹Jᵀr.
    #[test]
    fn the_spread_with_other_noise_is_that_of_the_matrices() {
        let (n, matrix) = (12, remembering(12, 0.7));
        let spread = long_line(n, &DVector::zeros(n)).spread(&Covariance::Dense(&matrix * 4.0));
        let jacobian = slopes(n);
        let solve = (jacobian.tr_mul(&jacobian)).try_inverse().unwrap() * jacobian.transpose();
        let variances = (&solve * &matrix * solve.transpose()).diagonal() * 4.0;
        assert!((spread.variances - &variances).norm() < 1e-9 * variances.norm());
        let left = (DMatrix::identity(n, n) - &jacobian * solve) * &matrix;
        let (once, twice) = (left.trace(), (&left * &left).trace());
        assert!((spread.expected - once).abs() < 1e-9);
        assert!((spread.dof - once * once / twice).abs() < 1e-9);
    }

    /// Intervals of a slope under noise that remembers and whose size the residuals tell: as many hold it as they should;
    /// by the usual formula for independent rows far too few do.
    #[test]
    fn intervals_under_correlated_noise_hold_what_they_should() {
        use gumption_core::special::{normal_quantile, student_t_two_sided_quantile};
        use gumption_lanes::{Block, Generator, level};
        let (n, draws) = (40, 2000);
        let matrix = remembering(n, 0.8);
        let lower = matrix.clone().cholesky().unwrap().unpack();
        let mut held = [0, 0];
        for draw in 0..draws {
            let (mut generator, mut block) = (Generator::new(7, draw, 0), Block::ZERO);
            generator.uniforms(level(), &mut block);
            let noise = DVector::from_fn(n, |i, _| normal_quantile(block.0[i]));
            let baseline = long_line(n, &(&lower * noise * 2.0));
            let slope = baseline.correction()[1].abs();
            let chi_squared = baseline.chi_squared();
            let own = baseline.spread(&Covariance::Dense(&matrix * 4.0));
            let white = baseline.spread(&Covariance::Diagonal(DVector::from_element(n, 4.0)));
            for (held, spread) in held.iter_mut().zip([own, white]) {
                let u = (spread.variances[1] * chi_squared / spread.expected).sqrt();
                let k = student_t_two_sided_quantile(0.95, spread.dof);
                *held += u32::from(slope <= k * u);
            }
        }
        let [own, white] = held.map(|held| f64::from(held) / draws as f64);
        assert!((0.93..0.98).contains(&own), "{own}");
        assert!(white < 0.65, "{white}");
    }

    #[test]
    fn what_cannot_be_answered_is_refused() {
        let short = line(&Prior::none(2), &[1.0, 2.0]);
        assert_eq!(
            short.err(),
            Some(Refusal::NoFreedom {
                rows: 2,
                parameters: 2
            })
        );
        let bad = line(&Prior::none(2), &[1.0, f64::NAN, 2.0]);
        assert_eq!(bad.err(), Some(Refusal::NotFinite { row: 1 }));
        let jacobian = DMatrix::from_element(4, 2, 1.0);
        let noise = white(4);
        let twice = Baseline::new(&jacobian, &DVector::zeros(4), &noise, &Prior::none(2));
        assert_eq!(twice.err(), Some(Refusal::Dependent { parameter: 1 }));
    }
}
