//! Recordings of the rigs with known truth, examined.

use std::ops::ControlFlow;

use gumption::diagnose::evidence::{
    Atom, Baseline, Covariance, Examination, Noise, Prior, Question, Settings, Shape, examine,
};
use gumption_lanes::sampler::gamma_block;
use gumption_lanes::{Block, Generator, level};
use nalgebra::{DMatrix, DVector};

use super::rigs::{Rig, normals, rate, triad, tumble};

/// A rig with what all of its recordings share.
pub struct Bench {
    pub rig: Rig,
    pub settings: Settings,
    /// L of the true covariance matrix.
    lower: DMatrix<f64>,
    /// With the true covariance matrix, for λ and κ.
    truth: Baseline,
    /// Visible directions of every named atom.
    directions: Vec<Option<DMatrix<f64>>>,
}

/// One effect that was put into a recording.
pub struct Hidden {
    pub candidate: usize,
    pub effect: DVector<f64>,
    /// What is left of it after the nearest other candidate, over the noise.
    pub kappa: f64,
}

impl Bench {
    pub fn new(rig: Rig) -> Bench {
        let lower = rig
            .covariance
            .to_dense()
            .cholesky()
            .expect("a covariance matrix")
            .unpack();
        let zero = DVector::zeros(rig.jacobian.nrows());
        let prior = Prior::none(rig.jacobian.ncols());
        let noise = Noise::known(rig.covariance.clone());
        let truth = Baseline::new(&rig.jacobian, &zero, &noise, &prior).expect("a design");
        let directions = rig
            .atoms
            .iter()
            .map(|atom| match &atom.shape {
                Shape::Columns(columns) => directions(&truth, &lower, columns),
                Shape::Smooth { .. } | Shape::Scatter => None,
            })
            .collect();
        Bench {
            rig,
            settings: Settings {
                draws: 2048,
                ..Settings::default()
            },
            lower,
            truth,
            directions,
        }
    }

    /// The four rigs, with covariates of this seed.
    pub fn all(seed: u64) -> Vec<Bench> {
        [
            tumble(seed, &[0.0]),
            tumble(seed, &[0.0, 90.0]),
            triad(seed),
            rate(seed),
        ]
        .map(Bench::new)
        .into()
    }

    /// No effect.
    pub fn nothing(&self) -> DVector<f64> {
        DVector::zeros(self.rig.jacobian.nrows())
    }

    pub fn name(&self, candidate: usize) -> &str {
        &self.rig.candidates[candidate].name
    }

    /// A visible effect of physics, drawn at random: the candidate, then its variant, then the direction
    /// of its coefficients. Decoys are none.
    pub fn hide(&self, lambda: f64, seed: u64, stream: u64) -> Hidden {
        let visible = |atom: &usize| {
            let name = self.name(self.rig.atoms[*atom].candidate);
            self.directions[*atom].is_some() && !["HUMIDITY", "PRESSURE"].contains(&name)
        };
        let atoms: Vec<usize> = (0..self.rig.atoms.len()).filter(visible).collect();
        let candidate_of = |atom: usize| self.rig.atoms[atom].candidate;
        let mut names: Vec<usize> = atoms.iter().map(|a| candidate_of(*a)).collect();
        names.dedup();
        let mut block = Block::ZERO;
        Generator::new(seed, 79, stream).uniforms(level(), &mut block);
        let candidate = names[(block.0[0] * names.len() as f64) as usize];
        let own: Vec<usize> = atoms
            .into_iter()
            .filter(|a| candidate_of(*a) == candidate)
            .collect();
        let atom = own[(block.0[1] * own.len() as f64) as usize];
        let Shape::Columns(columns) = &self.rig.atoms[atom].shape else {
            unreachable!("only named atoms have directions");
        };
        let size = DVector::from_vec(normals(seed, stream, columns.ncols()));
        let effect = columns * size;
        let effect = &effect * (lambda / self.visible(&effect).norm());
        let kappa = self.kappa(&effect, candidate);
        Hidden {
            candidate,
            effect,
            kappa,
        }
    }

    fn visible(&self, effect: &DVector<f64>) -> DVector<f64> {
        let column = DMatrix::from_columns(std::slice::from_ref(effect));
        self.truth.project(&column).column(0).into_owned()
    }

    fn kappa(&self, effect: &DVector<f64>, own: usize) -> f64 {
        let seen = self.visible(effect);
        self.rig
            .atoms
            .iter()
            .zip(&self.directions)
            .filter(|(atom, _)| atom.candidate != own)
            .filter_map(|(_, directions)| directions.as_ref())
            .map(|u| (&seen - u * u.tr_mul(&seen)).norm())
            .fold(seen.norm(), f64::min)
    }

    /// All atoms but those of one candidate.
    pub fn without(&self, candidate: usize) -> Vec<Atom> {
        let others = self.rig.atoms.iter().filter(|a| a.candidate != candidate);
        others.cloned().collect()
    }

    /// Asks about a recording that holds this effect; the scale of the noise is told as well as the rig
    /// knows it.
    pub fn ask<T>(
        &self,
        effect: &DVector<f64>,
        atoms: &[Atom],
        seed: u64,
        stream: u64,
        answer: impl Fn(&Question) -> T,
    ) -> T {
        let noise = DVector::from_vec(normals(seed, stream, effect.len()));
        let residuals = &self.lower * noise + effect;
        let nu = self.rig.scale_dof;
        let told = if nu.is_finite() {
            let mut draw = Block::ZERO;
            gamma_block(
                level(),
                &mut Generator::new(seed, 78, stream),
                0.5 * nu,
                &mut draw,
            );
            2.0 * draw.0[0] / nu
        } else {
            1.0
        };
        let covariance = Covariance::Dense(self.rig.covariance.to_dense() * told);
        let baseline = Baseline::new(
            &self.rig.jacobian,
            &residuals,
            &Noise::with_scale_dof(covariance, nu),
            &Prior::none(self.rig.jacobian.ncols()),
        )
        .expect("a design");
        answer(&Question {
            baseline: &baseline,
            candidates: &self.rig.candidates,
            atoms,
            settings: Settings {
                seed: seed ^ (stream << 20),
                ..self.settings.clone()
            },
        })
    }

    pub fn examine(
        &self,
        effect: &DVector<f64>,
        atoms: &[Atom],
        seed: u64,
        stream: u64,
    ) -> Examination {
        self.ask(effect, atoms, seed, stream, |question| {
            examine(question, &|_| ControlFlow::Continue(())).expect("an answer")
        })
    }
}

/// Orthonormal directions of what is visible of the columns; `None` if less than a thousandth of their
/// squares is.
fn directions(
    truth: &Baseline,
    lower: &DMatrix<f64>,
    columns: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let seen = truth.project(columns);
    let whole = lower.solve_lower_triangular(columns)?.norm_squared();
    if seen.norm_squared() <= 1e-3 * whole {
        return None;
    }
    let svd = seen.svd(true, false);
    let limit = 1e-6 * svd.singular_values.max();
    let kept: Vec<usize> = (0..svd.singular_values.len())
        .filter(|k| svd.singular_values[*k] > limit)
        .collect();
    Some(svd.u?.select_columns(&kept))
}
