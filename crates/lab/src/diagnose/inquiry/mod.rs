//! What a recording answers when it is asked for effects: with the noise that is claimed; with noise and effects in turn,
//! where the noise is open; more closely, where the parameter of an effect lies between two values of its grid; and where
//! nothing is found, whether the noise itself changes.

mod by_label;
mod noise;
mod slopes;

use std::cell::OnceCell;
use std::cmp::Ordering;
use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};

use super::candidates::{Candidates, baseline, settings};
use super::case::Case;
use super::catalogue::{Finer, FittedModel};
use super::coarse::Coarse;
use super::design::Design;
use super::evidence::{self, Baseline, Examination, Located, Settings, TRACE, Verdict};
use super::failure::Failure;
use super::fit::Fit;
use super::further;
use super::noise::Claimed;
use super::noise_correlation::Courses;
use super::noise_outputs;
use super::noise_scale::Scales;
use super::possible;
use super::regions;
use super::settled;

/// So often the values about the parameter of an effect are brought closer together.
const REFINEMENTS: u8 = 3;
/// Of so many effects that are the likeliest to be alone, or explain most under one label, more is asked.
const BEST: usize = 10;
/// Two tests of what the noise is, each with half of the probability of a false alarm.
const OF_NOISE: f64 = 0.5;
/// So often noise and effects are estimated in turn.
const TURNS: u8 = 3;

/// The declared model of a case at its best.
#[derive(Clone, Copy)]
pub(super) struct Declared<'d> {
    pub case: &'d Case,
    pub design: &'d Design<'d>,
    pub fit: &'d Fit,
    /// Both as the catalogue sees them.
    pub coarse: &'d Coarse<'d>,
    pub seen: &'d Design<'d>,
    /// Room for the model beside what was found, as the catalogue sees it: where slopes are taken anew.
    pub beside: &'d [OnceCell<Fit>; 3],
    /// The residuals with the noise of that fit.
    pub white: &'d Baseline,
}

/// What was found, and with which noise.
#[derive(Clone)]
pub(super) struct Answer {
    /// The noise.
    pub claimed: Claimed,
    /// The residuals with it.
    pub baseline: Baseline,
    /// What they show.
    pub examination: Examination,
}

/// What is found if the errors of rows are independent of each other, where noise that wanders stands in the answer.
#[derive(Debug)]
pub struct IfIndependent {
    /// What is found then.
    pub examination: Examination,
    /// How many times as likely its likeliest explanation is as all noise that remembers.
    pub odds: f64,
}

/// A recording that has answered.
pub(super) struct Inquiry<'i> {
    pub candidates: Candidates<'i>,
    pub answer: Answer,
    pub settings: Settings,
    declared: Declared<'i>,
    /// The declared model where its slopes were taken, as the catalogue sees it.
    fit: &'i Fit,
    /// What is found in place of noise that wanders if rows are independent.
    pub if_independent: Option<IfIndependent>,
    /// What the noise may be, where it is open how it is correlated or whether it grows.
    courses: Option<Courses>,
    /// Where they hold scales that wander: probability at most of noise that looks as much like one.
    scale_by_chance: Option<f64>,
    progress: &'i dyn Fn(f64) -> ControlFlow<()>,
}

impl<'i> Inquiry<'i> {
    /// Asks for every effect of the catalogue; `claimed` is the noise to begin with.
    ///
    /// # Errors
    /// When the recording does not determine the parameters, or the work was stopped.
    pub(super) fn of(
        declared: Declared<'i>,
        claimed: Claimed,
        progress: &'i dyn Fn(f64) -> ControlFlow<()>,
    ) -> Result<Inquiry<'i>, Failure> {
        let settings = settings(declared.case);
        let (design, fit) = (declared.seen, &declared.coarse.fit);
        let fitted = FittedModel::new(design, fit);
        let mut candidates = Candidates::new(fitted, &claimed, declared.white);
        let claimed = of_each_output(&candidates, claimed, &settings)?;
        if claimed.is_of_arithmetic() {
            // What numbers are rounded by has a form as well, and no physics.
            candidates.retain(|_, _| false);
        }
        let part = part(progress, 0.0, 0.4);
        let answer = ask(&mut candidates, claimed.clone(), &settings, &part)?;
        // What the model leaves out may look like noise that grows.
        let plain = settled::plain(design, fit, &claimed);
        let fitted = &candidates.fitted;
        let in_common = noise_outputs::laws(design, fit, &claimed.u);
        let is_open = claimed.is_estimated() || !in_common.is_empty();
        let courses = Courses::of(fitted)
            .or_else(|| is_open.then(|| Courses::white(design.observations())))
            .filter(|_| claimed.correlated.is_none() && !claimed.is_of_arithmetic());
        let scales = Scales::of(fitted).zip(courses.as_ref());
        let of_scale = match scales.filter(|_| claimed.is_estimated() && claimed.rounding.is_none())
        {
            Some((scales, shifts)) => {
                let laws = scales.laws();
                let p = scales.by_chance(&laws, design, fit, &claimed, shifts)?;
                Some((p, laws))
            }
            None => None,
        };
        let of_scale = of_scale.filter(|(p, _)| *p <= OF_NOISE * settings.alpha);
        let (scale_by_chance, scales) = of_scale.unzip();
        let others = scales.unwrap_or_default().into_iter().chain(in_common);
        let courses = courses.map(|courses| courses.or(others.collect()));
        let mut inquiry = Inquiry {
            candidates,
            answer,
            settings,
            declared,
            fit,
            if_independent: None,
            courses,
            scale_by_chance,
            progress,
        };
        // So may the rounding of the readings, where the claim is without it.
        let alpha = inquiry.of_rounding();
        let rounded = claimed.with_rounding(declared.design, declared.fit, alpha);
        let rounded = rounded.filter(|_| !inquiry.found_nothing());
        let starts = [claimed].into_iter().chain(plain).chain(rounded);
        let starts: Vec<Claimed> = starts.collect();
        inquiry.begin(starts.clone())?;
        inquiry.look_under_labels(starts)?;
        inquiry.linearise_again()?;
        inquiry.split_by_label()?;
        inquiry.sharpen()?;
        let is_noise = inquiry.found_nothing();
        inquiry.look_for_unsteady_noise()?;
        let claimed = &inquiry.answer.claimed;
        let is_told = inquiry.found_nothing() || claimed.is_of_scale();
        let wanders = is_noise && is_told && claimed.wanders();
        inquiry.if_independent.take_if(|_| !wanders);
        inquiry.tell_rounding();
        Ok(inquiry)
    }

    /// Settles the noise, with one of these to begin with.
    fn begin(&mut self, starts: Vec<Claimed>) -> Result<(), Failure> {
        if let [_, plain] = starts.as_slice()
            && self.found_nothing()
        {
            self.answer = self.asked(plain.clone(), 0.4, 0.4)?;
        }
        match &self.courses {
            // Beside what outputs have in common, what one of them shows alone stands out.
            Some(courses) if self.found_nothing() && !courses.are_of_outputs() => {
                let Declared { design, fit, .. } = self.declared;
                let answer = &mut self.answer;
                answer.claimed = settled::refined(design, fit, &starts[0], Some(courses));
                answer.baseline = baseline(design, fit, &answer.claimed)?;
                Ok(())
            }
            _ if self.is_open() || starts.len() > 1 => self.compete(starts),
            _ => Ok(()),
        }
    }

    /// Noise and effects are estimated in turn: what an effect explains is no noise. Where noise may explain as well what an
    /// effect does, the two are begun with in turn, and the likelier end stays.
    fn compete(&mut self, mut starts: Vec<Claimed>) -> Result<(), Failure> {
        let mut of_noise = None;
        if let Some(courses) = &self.courses {
            let found = self.answer.examination.score;
            let noise = (self.candidates).against(courses, &starts, &self.settings, found)?;
            self.settings.by_noise.insert(0, noise.chance);
            of_noise = Some(noise.log_posterior);
            match noise.chance.p > self.settings.alpha {
                true => starts = vec![noise.likeliest],
                false if noise.likeliest.correlated.is_some() => starts.push(noise.likeliest),
                false => {}
            }
        }
        let by_noise = self.settings.by_noise.get(&0).copied();
        let stands = by_noise.is_none_or(|by| by.p <= self.settings.alpha);
        let (begun, share) = (self.answer.clone(), 0.3 / starts.len() as f64);
        let (mut best, mut atoms) = (f64::NEG_INFINITY, self.candidates.atoms.len());
        for (at, start) in starts.into_iter().enumerate() {
            let from = 0.4 + share * at as f64;
            let first = match stands && start == begun.claimed {
                true => begun.clone(),
                false => self.asked(start, from, from + share)?,
            };
            let found = self.in_turn(first, from, from + share)?;
            let score = found.log_posterior();
            if score > best {
                (best, atoms) = (score, self.candidates.atoms.len());
                self.answer = found;
            }
        }
        if atoms != self.candidates.atoms.len() {
            // What cannot have its size with one noise was left out: atoms have other numbers now.
            self.answer = self.asked(self.answer.claimed.clone(), 0.7, 0.7)?;
        } else if let Some(of_noise) = of_noise {
            self.if_independent = begun.instead_of(of_noise, self.settings.alpha);
        }
        if let Some(by_noise) = by_noise {
            self.answer.examination.doubted(by_noise);
        }
        Ok(())
    }

    /// What is found when noise and effects are estimated in turn.
    fn in_turn(&mut self, mut answer: Answer, from: f64, to: f64) -> Result<Answer, Failure> {
        let atoms = |of: &Examination| of.fitted.as_ref().map(|fitted| fitted.atoms.clone());
        for _ in 0..TURNS {
            let then = self.noise_beside(&answer);
            if then == answer.claimed {
                break;
            }
            let before = atoms(&answer.examination);
            answer = self.asked_as_likely(then, &answer, from, to)?;
            if atoms(&answer.examination) == before {
                break;
            }
        }
        Ok(answer)
    }

    /// What is found with the noise that effects leave. Where that is fewer, and less likely than what was found before, further
    /// ones are held against the noise beside these: with doubt about the noise they stand out less than they gain.
    fn asked_as_likely(
        &mut self,
        noise: Claimed,
        before: &Answer,
        from: f64,
        to: f64,
    ) -> Result<Answer, Failure> {
        let mut then = self.asked(noise.clone(), from, to)?;
        while let Some(courses) = &self.courses
            && then.found() < before.found()
            && then.log_posterior() < before.log_posterior()
            && !self.settings.by_noise.contains_key(&then.found())
        {
            let gain = before.examination.score - then.examination.score;
            let beside = (&then.examination, &then.claimed);
            let chance =
                further::by_chance(&self.candidates, beside, courses, &self.settings, gain)?;
            let Some(chance) = chance.filter(|chance| chance.p <= self.settings.alpha) else {
                break;
            };
            self.settings.by_noise.insert(then.found(), chance);
            then = self.asked(noise.clone(), from, to)?;
        }
        Ok(then)
    }

    /// Shapes that lie between the steps of a grid: closer and closer.
    fn sharpen(&mut self) -> Result<(), Failure> {
        let mut finer = self.candidates.fitted.finer.clone();
        for round in 0..REFINEMENTS {
            if !(self.candidates).refine(&mut finer, &self.answer.examination) {
                break;
            }
            self.candidates = self.beside_finer(finer.clone());
            let from = 0.7 + 0.1 * f64::from(round);
            self.answer = self.asked_again(from, from + 0.1)?;
        }
        Ok(())
    }

    /// What is asked beside the grids as well.
    fn beside_finer(&self, finer: Finer) -> Candidates<'i> {
        let fitted = FittedModel::new(self.declared.seen, self.fit).refined(finer);
        Candidates::new(fitted, &self.answer.claimed, self.declared.white)
    }

    /// With the noise of the answer so far, and with that which is left beside what is found then.
    fn asked_again(&mut self, from: f64, to: f64) -> Result<Answer, Failure> {
        let half = (from + to) / 2.0;
        let answer = self.asked(self.answer.claimed.clone(), from, half)?;
        if !self.is_open() {
            return Ok(answer);
        }
        let then = self.noise_beside(&answer);
        match then.weighs_alike(&answer.claimed) {
            true => Ok(answer),
            false => self.asked(then, half, to),
        }
    }

    /// Where the mismatch sits, the most conspicuous first.
    pub(super) fn located(&self) -> Vec<(evidence::Cell, Located)> {
        if self.found_nothing() {
            return Vec::new();
        }
        let mut levels = regions::cells(&self.candidates.fitted);
        let columns: Vec<DVector<f64>> = levels.iter().map(|cell| cell.column.clone()).collect();
        if !columns.is_empty() {
            let shares = (self.declared.white).visibilities(&DMatrix::from_columns(&columns));
            let mut shares = shares.into_iter();
            levels.retain(|_| shares.next().is_some_and(|share| share > TRACE));
        }
        let found = evidence::locate(&self.answer.baseline, &levels, &self.settings);
        let with_cell = |located: Located| (levels[located.cell].clone(), located);
        found.into_iter().map(with_cell).collect()
    }

    /// Whether the noise depends on what is found beside it.
    fn is_open(&self) -> bool {
        let claimed = &self.answer.claimed;
        claimed.is_estimated() || claimed.rounding.is_some() || self.courses.is_some()
    }

    fn found_nothing(&self) -> bool {
        self.answer.examination.verdict == Verdict::None
    }

    fn asked(&mut self, claimed: Claimed, from: f64, to: f64) -> Result<Answer, Failure> {
        let part = part(self.progress, from, to);
        ask(&mut self.candidates, claimed, &self.settings, &part)
    }

    /// The noise that is left when what was found is in the model.
    fn noise_beside(&self, answer: &Answer) -> Claimed {
        let (claimed, courses) = (&answer.claimed, self.courses.as_ref());
        (self.candidates).of_adopted(&answer.examination, claimed, |design, fit| {
            settled::refined(design, fit, claimed, courses)
        })
    }
}

impl Answer {
    /// What a bent form leaves is taken for further effects, or for what has no name: the slopes that need fewer are the better
    /// ones, and where they need as many those with which the answer is likelier.
    fn beats(&self, other: &Answer) -> bool {
        let likelier = self.log_posterior() > other.log_posterior();
        self.examination.fitted.is_some()
            && match self.unexplained().cmp(&other.unexplained()) {
                Ordering::Less => true,
                Ordering::Equal => likelier,
                Ordering::Greater => false,
            }
    }

    /// With forms that bend more easily: needs no more effects, and is the likelier one.
    fn replaces(&self, other: &Answer) -> bool {
        let is_likelier = self.log_posterior() > other.log_posterior();
        self.examination.fitted.is_some()
            && is_likelier
            && self.unexplained() <= other.unexplained()
    }

    /// How many effects with names are in the model that was found.
    fn found(&self) -> usize {
        let fitted = self.examination.fitted.as_ref();
        fitted.map_or(0, |fitted| fitted.atoms.len())
    }

    /// How many effects have no explanation, and how many there are.
    fn unexplained(&self) -> (usize, usize) {
        let slots = &self.examination.slots;
        let open = slots.iter().filter(|slot| !slot.is_explained());
        (open.count(), slots.len())
    }

    /// What is found with independent errors, in place of noise alone with this logarithm of its probability: where every effect has
    /// a name that holds, and is at least `alpha` times as likely. If it is what made the recording, noise alone is likelier than that
    /// by chance in a share of `alpha` at most (Markov's inequality).
    fn instead_of(self, of_noise: f64, alpha: f64) -> Option<IfIndependent> {
        let odds = libm::exp(self.log_posterior() - of_noise);
        let is_named = match self.examination.verdict {
            Verdict::Identified | Verdict::Like | Verdict::Ambiguous => true,
            Verdict::None | Verdict::Partly | Verdict::Unexplained => false,
        };
        (is_named && odds >= alpha).then_some(IfIndependent {
            examination: self.examination,
            odds,
        })
    }

    /// Logarithm of its probability, but for a constant.
    fn log_posterior(&self) -> f64 {
        self.examination.score + self.baseline.log_likelihood() + self.claimed.log_prior()
    }
}

/// Asks for every candidate. Effects that are seen with a size which they cannot have are something else: without them, again, or
/// where deviations bound no size; and so are forms of another size than they say.
fn ask(
    candidates: &mut Candidates<'_>,
    claimed: Claimed,
    settings: &Settings,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<Answer, Failure> {
    let baseline = baseline(candidates.fitted.design, candidates.fitted.fit, &claimed)?;
    loop {
        let question = candidates.question(&baseline, settings);
        let examination = evidence::examine(&question, progress)?;
        let missized = possible::missized(candidates, &examination, &claimed);
        let others = possible::of_another_size(candidates, &examination, &claimed, settings.alpha);
        if missized.is_empty() && others.is_empty() {
            return Ok(Answer {
                claimed,
                baseline,
                examination,
            });
        }
        candidates.leave_out_atoms(&others);
        if !missized.is_empty() && !candidates.free() {
            candidates.leave_out(&missized);
        }
    }
}

/// Noise that is estimated, of outputs of which each is tried by itself: what one of them shows alone is no noise of it.
fn of_each_output(
    candidates: &Candidates<'_>,
    claimed: Claimed,
    settings: &Settings,
) -> Result<Claimed, Failure> {
    let design = candidates.fitted.design;
    let (outputs, each) = (design.case.responses.len(), design.blocks.len());
    if outputs < 2 || !claimed.is_estimated() {
        return Ok(claimed);
    }
    let baseline = baseline(design, candidates.fitted.fit, &claimed)?;
    let question = candidates.question(&baseline, settings);
    let rows = (0..outputs).map(|output| output * each..(output + 1) * each);
    let rows: Vec<_> = rows.collect();
    let factors = evidence::shrunk(&question, &rows, OF_NOISE * settings.alpha);
    let of = |observation: usize| factors[design.place(observation).0];
    Ok(claimed.times(of))
}

/// Progress between two shares of the whole.
fn part<'p>(
    progress: &'p dyn Fn(f64) -> ControlFlow<()>,
    from: f64,
    to: f64,
) -> impl Fn(f64) -> ControlFlow<()> + 'p {
    move |share| progress(from + (to - from) * share)
}
