//! Small questions for tests: courses as candidates, beside a constant.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};

use super::baseline::{Baseline, Prior};
use super::examine::examine;
use super::findings::Examination;
use super::noise::{Covariance, Noise};
use super::question::{Atom, Candidate, Question, Settings, Shape};

/// Independent rows with a standard deviation of one.
pub(in crate::diagnose) fn white(rows: usize) -> Noise {
    Noise::known(Covariance::Diagonal(DVector::from_element(rows, 1.0)))
}

/// The same where nobody says how large the noise is.
pub(in crate::diagnose) fn estimated(rows: usize) -> Noise {
    Noise::with_scale_dof(white(rows).covariance, 0.0)
}

/// Residuals to which parameters with these slopes were fitted, nothing being known of them beforehand.
pub(super) fn beside(slopes: &DMatrix<f64>, residuals: &DVector<f64>, noise: &Noise) -> Baseline {
    Baseline::new(slopes, residuals, noise, &Prior::none(slopes.ncols())).unwrap()
}

/// Residuals to which a constant was fitted, with such a noise.
pub(in crate::diagnose) fn beside_constant(residuals: &DVector<f64>, noise: &Noise) -> Baseline {
    beside(
        &DMatrix::from_element(residuals.len(), 1, 1.0),
        residuals,
        noise,
    )
}

/// What is asked of some residuals.
pub(super) struct Asked {
    baseline: Baseline,
    candidates: Vec<Candidate>,
    atoms: Vec<Atom>,
}

impl Asked {
    /// Of residuals to which a constant was fitted, with such a noise.
    pub(super) fn of(residuals: &DVector<f64>, noise: &Noise) -> Asked {
        Asked {
            baseline: beside_constant(residuals, noise),
            candidates: Vec::new(),
            atoms: Vec::new(),
        }
    }

    /// With a candidate whose variants are these shapes.
    pub(super) fn with(mut self, candidate: Candidate, variants: Vec<Shape>) -> Asked {
        let own = self.candidates.len();
        let variants = variants.into_iter().enumerate();
        self.atoms.extend(variants.map(|(variant, shape)| Atom {
            candidate: own,
            variant,
            shape,
            share: 1.0,
        }));
        self.candidates.push(candidate);
        self
    }

    /// With a usual candidate for each of these courses.
    pub(super) fn with_each(self, courses: impl IntoIterator<Item = DVector<f64>>) -> Asked {
        courses.into_iter().fold(self, |asked, course| {
            let usual = Candidate::plain("", asked.candidates.len());
            asked.with(usual, vec![shape(course)])
        })
    }

    pub(super) fn question(&self) -> Question<'_> {
        Question {
            baseline: &self.baseline,
            candidates: &self.candidates,
            atoms: &self.atoms,
            settings: Settings::default(),
        }
    }

    pub(super) fn examined(&self) -> Examination {
        examine(&self.question(), &|_| ControlFlow::Continue(())).unwrap()
    }
}

/// An effect with this course.
pub(super) fn shape(course: DVector<f64>) -> Shape {
    Shape::Columns(DMatrix::from_columns(&[course]))
}

/// A course over the time from 0 to 1, without its mean.
pub(super) fn course(rows: usize, f: impl Fn(f64) -> f64) -> DVector<f64> {
    let column = DVector::from_fn(rows, |row, _| f(row as f64 / rows as f64));
    let mean = column.mean();
    column.add_scalar(-mean)
}

/// Positions on a head in each of some mountings of a sensor, whose offset, scale and misalignment are fitted.
pub(super) struct Tumble {
    /// Angles of the sensor and of the head.
    angles: Vec<(f64, f64)>,
}

impl Tumble {
    pub(super) fn new(positions: u32, mounts: &[f64]) -> Tumble {
        let step = std::f64::consts::TAU / f64::from(positions);
        let heads = |mount: &f64| {
            let mount = mount.to_radians();
            (0..positions).map(move |k| (f64::from(k) * step + mount, f64::from(k) * step))
        };
        Tumble {
            angles: mounts.iter().flat_map(heads).collect(),
        }
    }

    /// A function of both angles. Rounding of cos 90° is removed.
    pub(super) fn column(&self, f: impl Fn(f64, f64) -> f64) -> DVector<f64> {
        DVector::from_fn(self.angles.len(), |i, _| {
            let value = f(self.angles[i].0, self.angles[i].1);
            if value.abs() < 1e-9 { 0.0 } else { value }
        })
    }

    /// Of a recording that is what the parameters say.
    pub(super) fn baseline(&self) -> Baseline {
        self.baseline_of(&DVector::zeros(self.angles.len()))
    }

    pub(super) fn baseline_of(&self, residuals: &DVector<f64>) -> Baseline {
        let columns = [
            self.column(|_, _| 1.0),
            self.column(|a, _| a.sin()),
            self.column(|a, _| a.cos()),
        ];
        beside(
            &DMatrix::from_columns(&columns),
            residuals,
            &white(residuals.len()),
        )
    }
}
