//! Two methods in common use, on the same candidates, to be compared with: forward selection by the
//! Bayesian information criterion, and the detection, identification and adaptation of geodesy with
//! Baarda's w-test. Neither knows of effects without a name, nor of lists.

use nalgebra::{DMatrix, DVector};

use super::evidence::{Question, Shape};
use gumption_core::special::{chi_squared_sf, f_sf};

/// A direction with less than this share (squared) of its length left counts as dependent.
const DEPENDENT: f64 = 1e-6;
/// From here on the scale of the noise counts as known.
const EXACT: f64 = 1e8;

/// Candidates in the order in which forward selection by BIC adopts them: at each step the atom that
/// lowers m·ln(RSS/m) + d·ln m most, until none does. At most `max_effects` of the settings.
pub fn forward_bic(question: &Question) -> Vec<usize> {
    let mut path = Path::new(question);
    let m = question.baseline.dof() as f64;
    path.follow(|step, rss| {
        let left = (rss - step.fit).max(f64::MIN_POSITIVE);
        let gain = m * libm::log(left / rss) + step.directions as f64 * libm::log(m);
        (gain < 0.0).then_some(-gain)
    })
}

/// Candidates in the order in which the w-test adopts them: at each step the atom with the least
/// probability under the null hypothesis, as long as that is less than α shared among all atoms (Šidák).
/// Effects of several coefficients are tested by χ², or by F where the scale of the noise is estimated.
pub fn w_test(question: &Question) -> Vec<usize> {
    let mut path = Path::new(question);
    let (m, nu) = (
        question.baseline.dof() as f64,
        question.baseline.scale_dof(),
    );
    let count = path.atoms.len().max(1) as f64;
    let limit = -libm::expm1(libm::log1p(-question.settings.alpha) / count);
    path.follow(|step, rss| {
        let d = step.directions as f64;
        let p = if nu >= EXACT {
            chi_squared_sf(step.fit, d)
        } else {
            let rest = m + nu - d;
            let ratio = (step.fit / d) / ((rss + nu - step.fit) / rest);
            f_sf(ratio, d, rest)
        };
        // Probabilities too small for a number are ordered by the fit.
        (p < limit).then(|| -libm::log(p.max(f64::MIN_POSITIVE)) + step.fit * 1e-9)
    })
}

/// Named atoms and what is adopted of them so far.
struct Path<'a> {
    question: &'a Question<'a>,
    /// Index of each visible named atom, with its columns in the space of z.
    atoms: Vec<(usize, DMatrix<f64>)>,
    left: DVector<f64>,
}

/// What one atom would add.
struct Step {
    fit: f64,
    directions: usize,
}

impl<'a> Path<'a> {
    fn new(question: &'a Question<'a>) -> Path<'a> {
        let visible = |(index, columns): (usize, &DMatrix<f64>)| {
            let seen = question.baseline.project(columns);
            let scale = columns_scale(question, columns, &seen);
            let basis = orthonormal(seen, scale);
            (basis.ncols() > 0).then_some((index, basis))
        };
        Path {
            question,
            atoms: question
                .atoms
                .iter()
                .enumerate()
                .filter_map(|(index, atom)| match &atom.shape {
                    Shape::Columns(columns) => Some((index, columns)),
                    Shape::Smooth { .. } | Shape::Scatter => None,
                })
                .filter_map(visible)
                .collect(),
            left: question.baseline.residuals().clone(),
        }
    }

    /// Adopts the atom of the greatest merit, as long as one has any.
    fn follow(&mut self, merit: impl Fn(&Step, f64) -> Option<f64>) -> Vec<usize> {
        let mut adopted = Vec::new();
        while adopted.len() < self.question.settings.max_effects {
            let rss = self.left.norm_squared();
            let mut best: Option<(f64, usize)> = None;
            for (place, (_, basis)) in self.atoms.iter().enumerate() {
                let step = Step {
                    fit: basis.tr_mul(&self.left).norm_squared(),
                    directions: basis.ncols(),
                };
                if let Some(value) = merit(&step, rss)
                    && best.is_none_or(|(other, _)| value > other)
                {
                    best = Some((value, place));
                }
            }
            let Some((_, place)) = best else { break };
            let (atom, basis) = self.atoms.swap_remove(place);
            let candidate = self.question.atoms[atom].candidate;
            adopted.push(candidate);
            self.left -= &basis * basis.tr_mul(&self.left);
            self.take_out(candidate, &basis);
        }
        adopted
    }

    /// Projects everything on what is not along the adopted directions.
    fn take_out(&mut self, candidate: usize, basis: &DMatrix<f64>) {
        let question = self.question;
        let repeats = question.candidates[candidate].repeats;
        self.atoms = std::mem::take(&mut self.atoms)
            .into_iter()
            .filter(|(atom, _)| repeats || question.atoms[*atom].candidate != candidate)
            .map(|(atom, other)| {
                let along = basis.tr_mul(&other);
                (atom, orthonormal(&other - basis * along, 1.0))
            })
            .filter(|(_, other)| other.ncols() > 0)
            .collect();
    }
}

/// Length that columns of an atom have before the parameters absorb a part: that of the longest.
fn columns_scale(question: &Question, columns: &DMatrix<f64>, seen: &DMatrix<f64>) -> f64 {
    let shares = question.baseline.visibilities(columns);
    let whole = seen.column_iter().zip(shares).map(|(seen, share)| {
        if share > DEPENDENT {
            seen.norm() / share.sqrt()
        } else {
            0.0
        }
    });
    whole.fold(0.0, f64::max)
}

/// Orthonormal directions of the columns; those with little left are dropped.
fn orthonormal(columns: DMatrix<f64>, scale: f64) -> DMatrix<f64> {
    let mut kept: Vec<DVector<f64>> = Vec::new();
    for column in columns.column_iter() {
        let mut direction = column.into_owned();
        for other in &kept {
            let along = other.dot(&direction);
            direction.axpy(-along, other, 1.0);
        }
        let length = direction.norm();
        if scale > 0.0 && length * length > DEPENDENT * scale * scale {
            kept.push(direction / length);
        }
    }
    if kept.is_empty() {
        return DMatrix::zeros(columns.nrows(), 0);
    }
    DMatrix::from_columns(&kept)
}

#[cfg(test)]
mod tests {
    use super::super::evidence::{Atom, Baseline, Candidate, Covariance, Noise, Prior, Settings};
    use super::*;

    /// A constant is fitted; a slope, a step and a wave are on offer.
    fn ask(residuals: &DVector<f64>, method: impl Fn(&Question) -> Vec<usize>) -> Vec<String> {
        let rows = residuals.len();
        type Course = fn(f64) -> f64;
        let columns: [(&str, Course); 3] = [
            ("slope", |t| t),
            ("jump", |t| f64::from(t > 0.3)),
            ("sine", |t| (12.0 * t).sin()),
        ];
        let candidates: Vec<Candidate> = columns
            .iter()
            .enumerate()
            .map(|(index, (name, _))| Candidate::plain(name, index))
            .collect();
        let atoms: Vec<Atom> = columns
            .iter()
            .enumerate()
            .map(|(candidate, (_, f))| Atom {
                candidate,
                variant: String::new(),
                shape: Shape::Columns(DMatrix::from_fn(rows, 1, |r, _| f(r as f64 / rows as f64))),
                share: 1.0,
            })
            .collect();
        let noise = Noise::known(Covariance::Diagonal(DVector::from_element(rows, 1.0)));
        let ones = DMatrix::from_element(rows, 1, 1.0);
        let baseline = Baseline::new(&ones, residuals, &noise, &Prior::none(1)).unwrap();
        let question = Question {
            baseline: &baseline,
            candidates: &candidates,
            atoms: &atoms,
            settings: Settings::default(),
        };
        method(&question)
            .into_iter()
            .map(|candidate| candidates[candidate].name.clone())
            .collect()
    }

    #[test]
    fn both_find_a_strong_wave_and_a_strong_slope() {
        let residuals = DVector::from_fn(60, |r, _| {
            let t = r as f64 / 60.0;
            let noise = (r as f64 * 37.7).sin() * 1.2;
            6.0 * (12.0 * t).sin() + 12.0 * t + noise
        });
        assert_eq!(ask(&residuals, w_test), ["sine", "slope"]);
        assert_eq!(ask(&residuals, forward_bic)[..2], ["sine", "slope"]);
    }

    #[test]
    fn the_w_test_finds_nothing_in_noise() {
        let residuals = DVector::from_fn(60, |r, _| (r as f64 * 37.7).sin() * 1.2);
        assert!(ask(&residuals, w_test).is_empty());
    }
}
