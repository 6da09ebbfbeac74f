//! The slopes of the model taken anew beside effects that bend its fit.

use std::cell::OnceCell;

use nalgebra::DVector;

use super::{Answer, BEST, Declared, Inquiry, ask, part};
use crate::diagnose::candidates::{Candidates, baseline};
use crate::diagnose::catalogue::modifiers::known;
use crate::diagnose::catalogue::{FittedModel, Variation};
use crate::diagnose::confirm::along;
use crate::diagnose::design::Design;
use crate::diagnose::evidence::{self, Atom, Fitted, Question, Shape};
use crate::diagnose::failure::Failure;
use crate::diagnose::fit::{self, Fit};
use crate::diagnose::noise::Claimed;
use crate::diagnose::settled;

/// The declared model at the parameters of a fit with effects in it, as the catalogue sees it.
pub(super) struct Beside {
    /// What that fit leaves and what its effects do along their slopes are the residuals: the whole is as good as it is when it is
    /// fitted.
    base: Fit,
    /// The noise that the fit leaves.
    claimed: Claimed,
}

impl<'i> Inquiry<'i> {
    /// Takes the slopes of the model anew beside what was found in it, and beside the effect that alone explains most, where the
    /// model departs from its slopes by more than the noise in all: an effect that bends the fit of a nonlinear model is seen
    /// there as it is, and beside the declared fit as several.
    pub(super) fn linearise_again(&mut self) -> Result<(), Failure> {
        let found = self.answer.examination.fitted.as_ref();
        let found = found.and_then(|found| self.beside(found));
        let mut besides: Vec<Beside> = found.into_iter().collect();
        if !self.found_nothing() && !self.is_linear() {
            besides.extend(self.beside_one());
        }
        let [found, one, _] = self.declared.beside;
        for (room, beside) in [found, one].into_iter().zip(besides) {
            self.linearise_beside(room, beside)?;
        }
        Ok(())
    }

    /// Takes what is found with the slopes beside effects, if it is better.
    pub(super) fn linearise_beside(
        &mut self,
        room: &'i OnceCell<Fit>,
        Beside { base, claimed }: Beside,
    ) -> Result<(), Failure> {
        let base = room.get_or_init(|| base);
        let finer = self.candidates.fitted.finer.clone();
        let fitted = FittedModel::new(self.declared.seen, base).refined(finer);
        let mut candidates = Candidates::new(fitted, &claimed, self.declared.white);
        let part = part(self.progress, 0.7, 0.7);
        let answer = ask(&mut candidates, claimed, &self.settings, &part)?;
        match answer.beats(&self.answer) {
            true => self.take(candidates, answer, base),
            false => Ok(()),
        }
    }

    /// Whether the slopes of the model by its parameters and by its columns are the same everywhere.
    fn is_linear(&self) -> bool {
        /// Change of a slope over its largest: rounding.
        const NOTHING: f64 = 1e-9;
        let Declared {
            design, fit, white, ..
        } = self.declared;
        let u = white.covariance().diagonal().map(f64::sqrt);
        let there = fit::at(design, &fit.unknowns + u).jacobian;
        let slopes = fit.jacobian.column_iter().zip(there.column_iter());
        let mut slopes = slopes.map(|(here, there)| (there - here).amax() <= NOTHING * here.amax());
        slopes.all(|same| same) && self.candidates.fitted.is_straight()
    }

    /// Takes what is found with other slopes, if it is better with the noise that is left there as well.
    fn take(
        &mut self,
        candidates: Candidates<'i>,
        answer: Answer,
        base: &'i Fit,
    ) -> Result<(), Failure> {
        let old = (
            std::mem::replace(&mut self.candidates, candidates),
            self.fit,
        );
        self.fit = base;
        let found = match self.is_open() {
            true => self.in_turn(answer, 0.7, 0.7)?,
            false => answer,
        };
        match found.beats(&self.answer) {
            true => self.answer = found,
            false => (self.candidates, self.fit) = old,
        }
        Ok(())
    }

    /// Beside the effect that is the likeliest to be alone, each with the noise that it leaves where it is fitted; of those that are
    /// the likeliest by the slopes so far. `None` where that is what was found.
    fn beside_one(&self) -> Option<Beside> {
        let question = self
            .candidates
            .question(&self.answer.baseline, &self.settings);
        let singles = evidence::singles(&question);
        let fits = singles.iter().take(BEST).filter_map(|(_, one)| {
            let beside = self.beside(one)?;
            Some((self.alone(*one.atoms.first()?, &beside)?, one, beside))
        });
        let (_, one, beside) = fits.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let found = self.answer.examination.fitted.as_ref();
        let is_new = found.is_none_or(|found| found.atoms != one.atoms);
        is_new.then_some(beside)
    }

    /// Logarithm of the probability that an effect is all there is, where it is fitted, but for a constant.
    fn alone(&self, atom: usize, Beside { base, claimed }: &Beside) -> Option<f64> {
        let fitted = FittedModel::new(self.declared.seen, base);
        let columns = self.candidates.variation(atom).columns(&fitted);
        let residuals = baseline(self.declared.seen, base, claimed).ok()?;
        let question = Question {
            atoms: &[Atom {
                shape: Shape::Columns(columns),
                ..self.candidates.atoms[atom].clone()
            }],
            ..self.candidates.question(&residuals, &self.settings)
        };
        let (score, _) = *evidence::singles(&question).first()?;
        Some(score + residuals.log_likelihood() + claimed.log_prior())
    }

    /// The declared model beside effects as they are fitted. `None` where the slopes so far tell as much.
    pub(super) fn beside(&self, found: &Fitted) -> Option<Beside> {
        let claimed = &self.answer.claimed;
        let (extended, refit) = self.candidates.refitted(found, claimed).ok()??;
        let Declared { design, seen, .. } = self.declared;
        let with_effects = Design::new(&extended.case);
        let values = with_effects.carried(&refit.unknowns, design);
        let moved = self.declared.coarse.at(&fit::at(design, values));
        let atoms = found.atoms.iter();
        let beside = FittedModel::new(seen, &moved);
        let effects = atoms.map(|atom| self.candidates.variation(*atom).columns(&beside));
        let slopes = evidence::all(std::iter::once(moved.jacobian.clone()).chain(effects));
        if !slopes.iter().all(|slope| slope.is_finite()) {
            return None;
        }
        let done = &moved.residuals - &refit.residuals;
        let turned = self.turned(found, &beside).component_div(&claimed.u);
        let base = Fit {
            residuals: &refit.residuals + along(&slopes, &done, &claimed.u),
            ..moved
        };
        let told = &self.fit.residuals - &self.fit.jacobian * (&base.unknowns - &self.fit.unknowns);
        let bent = (&base.residuals - told).component_div(&claimed.u);
        let changes = [&bent, &turned].into_iter();
        if !changes.clone().all(is_finite) || !changes.into_iter().any(is_seen) {
            return None;
        }
        let claimed = match self.is_open() {
            true => settled::refined(&with_effects, &refit, claimed, self.courses.as_ref()),
            false => claimed.clone(),
        };
        Some(Beside { base, claimed })
    }

    /// By how much the effects that were found, were they on another node of the model, would act otherwise beside the fit with
    /// them in it: with constant terms that were far off, a factor of the reading looks like one of the signal.
    fn turned(&self, found: &Fitted, beside: &FittedModel<'_>) -> DVector<f64> {
        let (fit, claimed) = (beside.fit, &self.answer.claimed);
        let mut most = DVector::zeros(fit.residuals.len());
        let mut sizes = found.coefficients.iter().copied().map(known);
        for atom in &found.atoms {
            let own = self.candidates.variation(*atom);
            let sizes: Vec<f64> = sizes.by_ref().take(own.coefficients()).collect();
            let is_elsewhere = |other: &&Variation| {
                let nodes = own.terms.iter().zip(&other.terms);
                other.coefficients() == own.coefficients()
                    && nodes.clone().any(|(own, other)| own.node != other.node)
            };
            let others = self.candidates.cell(*atom).variants.iter();
            for other in others.filter(is_elsewhere) {
                let acts = other.columns(beside) * DVector::from_column_slice(&sizes);
                let so_far = other.columns(&self.candidates.fitted);
                let slopes = evidence::all([fit.jacobian.clone(), so_far].into_iter());
                let missing = &acts - along(&slopes, &acts, &claimed.u);
                if missing.norm_squared() > most.norm_squared() {
                    most = missing;
                }
            }
        }
        most
    }
}

/// Whether a change of the residuals, in units of the noise, is more than noise in all.
fn is_seen(change: &DVector<f64>) -> bool {
    change.norm() > 1.0
}

fn is_finite(change: &DVector<f64>) -> bool {
    change.iter().all(|x| x.is_finite())
}
