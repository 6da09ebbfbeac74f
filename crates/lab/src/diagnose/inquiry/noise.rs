//! What the noise itself is beside what was found: whether it changes, and whether the readings are rounded.

use super::{Inquiry, OF_NOISE};
use crate::diagnose::candidates::baseline;
use crate::diagnose::catalogue::{Cell, generics, readout};
use crate::diagnose::evidence;
use crate::diagnose::failure::Failure;
use crate::diagnose::noise_rounding::is_coarse;
use crate::recording::resolution::u_of_step;

impl<'i> Inquiry<'i> {
    /// What nobody claims may be anything: where nothing was found, whether the noise is of the scale, or changes.
    pub(super) fn look_for_unsteady_noise(&mut self) -> Result<(), Failure> {
        let claimed = &self.answer.claimed;
        let is_unclaimed = claimed.wanders() || claimed.is_estimated();
        let is_ordered = self.candidates.fitted.clock.column.is_some();
        let is_asked = self.found_nothing() && is_unclaimed && is_ordered;
        let courses = self.courses.as_ref();
        let Some(courses) = courses.filter(|all| is_asked && all.remember()) else {
            return Ok(());
        };
        let (design, fit) = (self.declared.seen, self.fit);
        if let Some(p) = self.scale_by_chance {
            let cell = generics::wandering_scale(&self.candidates.fitted);
            self.answer.claimed = claimed.of_scale(design, fit, courses)?;
            self.answer.baseline = baseline(design, fit, &self.answer.claimed)?;
            self.unnamed(cell, p / OF_NOISE);
            return Ok(());
        }
        let laws = claimed.laws(design, fit, courses);
        // The test is one of normal errors.
        if claimed.rounding.is_some() || laws.may_jump() || is_coarse(design, fit) {
            return Ok(());
        }
        let seen = claimed.seen_with(design, fit, &laws)?;
        let noise = claimed.noise(design, fit);
        let alpha = OF_NOISE * self.settings.alpha;
        let p = evidence::unsteadiness(&seen, &noise, self.settings.seed, alpha)?;
        if p <= alpha {
            let cell = generics::unsteady(&self.candidates.fitted);
            self.unnamed(cell, p / OF_NOISE);
        }
        Ok(())
    }

    /// Something is there, with this probability of as much by chance, of which no more is known than this.
    fn unnamed(&mut self, cell: Cell, p: f64) {
        let cells = &mut self.candidates.cells;
        self.answer.examination.unnamed(cells.len(), p);
        cells.push(cell);
    }

    /// Whether something that was found may be an effect.
    fn names(&self, cell: &Cell) -> bool {
        let slots = self.answer.examination.slots.iter();
        let mut named = slots.flat_map(|slot| &slot.named);
        named.any(|named| self.candidates.cells[named.candidate].is(cell))
    }

    /// The level of the test for rounding, which is one of its own beside that of all effects.
    pub(super) fn of_rounding(&self) -> f64 {
        0.5 * self.settings.alpha
    }

    /// Names the rounding of the readings where what is left beside everything that was found shows it: that they come in steps is
    /// seen without any model.
    pub(super) fn tell_rounding(&mut self) {
        let claimed = &self.answer.claimed;
        let rounding = claimed.rounding.clone();
        let Some(rounding) = rounding.filter(|rounding| !rounding.is_stated) else {
            return;
        };
        let alpha = self.of_rounding();
        let examination = &self.answer.examination;
        let chances = (self.candidates).of_adopted(examination, claimed, |design, fit| {
            claimed.unrounded_by_chance(design, fit, &rounding)
        });
        let blocks = rounding.without.u.len() / rounding.steps.len();
        for (response, step) in rounding.steps.iter().enumerate() {
            let Some(step) = *step else { continue };
            let cell = readout::rounding_of(&self.candidates.fitted, response, step);
            let p = chances[response];
            if p <= alpha && !self.names(&cell) {
                let u = rounding.without.u.rows(response * blocks, blocks);
                let lambda = u.map(|u| u_of_step(step) / u).norm();
                let variant = self.candidates.add(cell);
                self.answer.examination.named(variant, lambda, 2.0 * p);
            }
        }
    }
}
