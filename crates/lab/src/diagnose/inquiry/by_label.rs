//! Effects that were found, with sizes that differ from one label to another.

use super::{Answer, BEST, Inquiry, OF_NOISE};
use crate::diagnose::candidates::Candidates;
use crate::diagnose::catalogue::{
    Finer, FittedModel, Forms, closer_by_label, may_split, under_one_label,
};
use crate::diagnose::confirm::{self, Quality};
use crate::diagnose::evidence;
use crate::diagnose::failure::Failure;
use crate::diagnose::noise::Claimed;

impl<'i> Inquiry<'i> {
    /// Noise that differs from label to label may be an effect that acts under one of them, or has another size under each; and so may a
    /// scale that wanders, beside which nothing is found; and so may estimated noise beside what was found that wanders, or has heavier
    /// tails than normal errors. What is found stands instead if it stands beside such noise, among all effects that may do so.
    pub(super) fn look_under_labels(&mut self, starts: Vec<Claimed>) -> Result<(), Failure> {
        let Answer { claimed, .. } = &self.answer;
        let may_be_effects = match self.found_nothing() {
            true => self.scale_by_chance.is_some(),
            false => claimed.is_estimated() && (claimed.wanders() || claimed.tails.heavy.is_some()),
        };
        let differs = claimed.by_label.iter().any(Option::is_some);
        if !(differs || may_be_effects) || !may_split(&self.candidates.fitted) {
            return Ok(());
        }
        let mut forms = Forms::default();
        self.candidates
            .cells
            .iter()
            .for_each(|cell| forms.add(cell));
        let fitted = FittedModel::new(self.declared.seen, self.fit).refined(Finer::by_label(forms));
        let under = Candidates::new(fitted, &starts[0], self.declared.white);
        let candidates = std::mem::replace(&mut self.candidates, under);
        let answer = self.answer.clone();
        let settings = self.settings.clone();
        let if_independent = self.if_independent.take();
        // A test of its own.
        self.settings.alpha *= OF_NOISE;
        self.settings.by_noise.clear();
        self.answer = self.asked(starts[0].clone(), 0.7, 0.7)?;
        self.begin(starts)?;
        self.settings.alpha = settings.alpha;
        let is_less_likely = self.answer.log_posterior() < answer.log_posterior();
        let [open, before] = [&self.answer, &answer].map(|one| one.unexplained().0);
        let leaves_no_more = answer.found() == 0 || open <= before;
        let is_better = self.answer.found() > 0 && !is_less_likely && leaves_no_more;
        if !is_better {
            self.candidates = candidates;
            self.answer = answer;
            self.settings = settings;
            self.if_independent = if_independent;
        }
        Ok(())
    }

    /// Sizes by label of the effects that were found. They may take the place of what was found, and do not add to it: of how many
    /// effects they were taken no test knows.
    pub(super) fn split_by_label(&mut self) -> Result<(), Failure> {
        if self.found_nothing() || !may_split(&self.candidates.fitted) {
            return Ok(());
        }
        let forms = self.by_label();
        if forms.is_empty() {
            return Ok(());
        }
        let fitted = FittedModel::new(self.declared.seen, self.fit).refined(Finer::by_label(forms));
        let other = Candidates::new(
            closer_by_label(fitted),
            &self.answer.claimed,
            self.declared.white,
        );
        let old = std::mem::replace(&mut self.candidates, other);
        let answer = self.asked_again(0.7, 0.7)?;
        let predicts_worse =
            || quality(&self.candidates, &answer).predicts_worse(&quality(&old, &self.answer));
        if !answer.replaces(&self.answer) || predicts_worse() {
            self.candidates = old;
            return Ok(());
        }
        self.answer = answer;
        // The slopes so far may have been taken beside what was replaced.
        let [.., by_label] = self.declared.beside;
        let found = self.answer.examination.fitted.as_ref();
        match found.and_then(|found| self.beside(found)) {
            Some(beside) => self.linearise_beside(by_label, beside),
            None => Ok(()),
        }
    }

    /// The effects that were found. Where these are several, or leave something open, also those that explain most under one label,
    /// of all that the recording shows and of what is left beside these: what only one run has may be any other effect over all.
    fn by_label(&self) -> Forms {
        let mut forms = Forms::default();
        let Candidates { fitted, cells, .. } = &self.candidates;
        let slots = self.answer.examination.slots.iter();
        for named in slots.flat_map(|slot| &slot.named) {
            forms.add(&cells[named.candidate]);
        }
        if self.answer.unexplained() > (0, 1) {
            let found = self.answer.examination.fitted.iter();
            let found = found.flat_map(|found| &found.atoms);
            let columns = found.map(|atom| self.candidates.variation(*atom).columns(fitted));
            let slopes = &self.fit.jacobian;
            let with_found = evidence::all(std::iter::once(slopes.clone()).chain(columns));
            for known in [slopes, &with_found] {
                let likeliest = under_one_label(fitted, cells, (known, &self.answer.claimed.u));
                for cell in likeliest.into_iter().take(BEST) {
                    forms.add(cell);
                }
            }
        }
        forms
    }
}

/// How well the model describes the recording with what was found in it.
fn quality(candidates: &Candidates<'_>, answer: &Answer) -> Quality {
    candidates.of_adopted(&answer.examination, &answer.claimed, |design, fit| {
        confirm::quality(design, fit, &answer.claimed)
    })
}
