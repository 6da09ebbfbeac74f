//! The model with the effects in it: its fit, its coefficients, how well it does.

use super::adopt::Extended;
use super::candidates::{Candidates, baseline};
use super::confirm::{self, Estimated, Quality, estimates};
use super::design::Design;
use super::evidence::{Alternative, Baseline, Examination};
use super::fit::{Fit, NoFit};
use super::noise::Claimed;
use super::parts::{self, Confirmation};
use super::shapes::{Shapes, shapes};

/// The model with the effects in it.
#[derive(Debug)]
pub struct Adopted {
    /// Atoms that were adopted.
    pub atoms: Vec<usize>,
    /// Coefficients, in the order of the atoms and their terms.
    pub coefficients: Vec<Estimated>,
    /// The unknowns of the declared model, now.
    pub unknowns: Vec<Estimated>,
    /// What the effects have beside sizes.
    pub shapes: Shapes,
    /// The improved case.
    pub extended: Extended,
    /// How well it describes the recording.
    pub quality: Quality,
    /// The fit of it, with what it leaves.
    pub fit: Fit,
    /// Further checks.
    pub confirmation: Confirmation,
}

/// The model with the named effects, and how well it does.
pub(super) fn adopt_named(
    candidates: &Candidates<'_>,
    examination: &mut Examination,
    claimed: &Claimed,
) -> Result<Option<Adopted>, NoFit> {
    let refit = candidates.adopted_fit(examination, claimed)?;
    let (Some(found), Some((extended, fit))) = (examination.fitted.clone(), refit) else {
        return Ok(None);
    };
    let design = Design::new(&extended.case);
    let quality = confirm::quality(&design, &fit, claimed);
    let shapes = shapes(
        candidates,
        &found.atoms,
        &extended,
        (&design, &fit),
        claimed,
    );
    let all = shapes.widened(estimates(&design, &fit, claimed));
    let added = extended.additions.len();
    let confirmation = parts::confirmation(&design, &fit, claimed, added, &found);
    let (mut coefficients, unknowns): (Vec<Estimated>, Vec<Estimated>) =
        (all.into_iter()).partition(|estimated| extended.adds(&estimated.name));
    let atoms = found.atoms.clone();
    for (estimated, addition) in coefficients.iter_mut().zip(&extended.additions) {
        let (atom, coefficient) = (atoms[addition.effect], addition.coefficient);
        restate(examination, atom, coefficient, estimated);
    }
    drop(design);
    Ok(Some(Adopted {
        atoms,
        coefficients,
        unknowns,
        shapes,
        quality,
        confirmation,
        fit,
        extended,
    }))
}

impl Adopted {
    /// The recording reduced to what it leaves, its unknowns in the order of the declared ones and then the adopted
    /// coefficients.
    pub(super) fn baseline(&self, claimed: &Claimed) -> Option<Baseline> {
        let mut design = Design::new(&self.extended.case);
        let is_added = |at: &usize| self.extended.adds(&design.unknowns[*at].name);
        let (added, declared): (Vec<usize>, Vec<usize>) =
            (0..design.unknowns.len()).partition(is_added);
        let order = [declared, added].concat();
        design.unknowns = (order.iter())
            .map(|at| design.unknowns[*at].clone())
            .collect();
        let fit = Fit {
            jacobian: self.fit.jacobian.select_columns(&order),
            unknowns: self.fit.unknowns.select_rows(&order),
            ..self.fit.clone()
        };
        baseline(&design, &fit, claimed).ok()
    }
}

/// The size of an effect is that of the adopted model, wherever it is stated. Its uncertainty has what the fit does not know
/// beside it: that other effects may have other explanations, and that weak ones are found where they come out large.
fn restate(examination: &mut Examination, atom: usize, coefficient: usize, fitted: &mut Estimated) {
    let is_it = |one: &&mut Alternative| one.variants.first().is_some_and(|v| v.atom == atom);
    let mut firsts = (examination.slots.iter_mut()).filter_map(|slot| slot.named.first_mut());
    let Some(first) = firsts.find(is_it) else {
        return;
    };
    if first.estimate.len() > coefficient {
        let factor = fitted.u / first.covariance[(coefficient, coefficient)].sqrt();
        if factor.is_finite() && factor > 0.0 {
            first.estimate[coefficient] = fitted.value;
            first.dof = fitted.dof;
            first.covariance.row_mut(coefficient).scale_mut(factor);
            first.covariance.column_mut(coefficient).scale_mut(factor);
        }
    }
    let choice = first.choice.get(coefficient).copied();
    let choice = choice.filter(|choice| choice.is_finite()).unwrap_or(0.0);
    fitted.u = first.widened(fitted.u, choice);
}
