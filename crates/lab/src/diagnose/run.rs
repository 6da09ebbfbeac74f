//! A diagnosis from end to end: fit, candidates, examination, location, adoption, confirmation.

use std::ops::ControlFlow;

use super::accounts::{self, Account};
use super::adopted::{Adopted, adopt_named};
use super::candidates::{Candidates, baseline};
use super::case::Case;
use super::catalogue::{Cell, Pattern};
use super::coarse::Coarse;
use super::confirm::{self, Estimated, Quality, estimates};
use super::design::Design;
use super::evidence::{self, Examination, Likeness, Located, Slot};
use super::explanation::{self, Separating};
use super::failure::Failure;
use super::fit::{Fit, ModelVersion, Trouble, Unsettled};
use super::held_out::{self, HeldOutQuality};
use super::inquiry::{Answer, Declared, IfIndependent, Inquiry};
use super::noise::Claimed;
use super::noise_outputs;
use super::omitted::{self, Omitted};
use super::prolonged::{Known, Recorded};
use super::settled;
use super::size;

/// Everything that a diagnosis found.
#[derive(Debug)]
pub struct Diagnosis {
    /// All candidates, in the order of the catalogue.
    pub cells: Vec<Cell>,
    /// Cell and variation of each atom.
    pub atoms: Vec<(usize, usize)>,
    /// What the statistics found.
    pub examination: Examination,
    /// Where the mismatch sits, the most conspicuous first.
    pub located: Vec<(evidence::Cell, Located)>,
    /// Whether the readings hardly vary: effects on the output and on the scale are then one.
    pub steady: bool,
    /// What is found in place of noise that wanders if the errors of rows are independent; `None` where that is no matter, or out of
    /// the question.
    pub if_independent: Option<IfIndependent>,
    /// The noise that was used.
    pub noise: Claimed,
    /// Names and values of the unknowns of the declared model, with their standard uncertainties.
    pub unknowns: Vec<Estimated>,
    /// The declared model.
    pub before: Quality,
    /// Its fit, with what it leaves observation by observation.
    pub fit: Fit,
    /// The model with the effects in it.
    pub adopted: Option<Adopted>,
    /// Number of means (blocks) and of rows in the recording.
    pub blocks: Vec<Vec<usize>>,
    /// What effects cost that were not adopted and may be there all the same, the dearest first.
    pub omitted: Vec<Omitted>,
    /// How well the held-out recording is predicted, if the case names one.
    pub held_out: Option<HeldOutQuality>,
    /// Why names that stand alone say no more than what their effects act like, although nothing else does.
    pub likened: Option<Likeness>,
    /// For each slot, where something is adopted, what it costs each unknown that the slot has several
    /// explanations.
    pub choices: Vec<Vec<f64>>,
    /// Fits on which a reader should not rely.
    pub unsettled: Vec<Unsettled>,
    /// Explanations that the recording cannot tell apart, with the measurements that would.
    pub separating: Vec<Separating>,
    /// Why effects that were asked about are not the answer.
    pub accounts: Vec<Account>,
}

impl Diagnosis {
    /// The standard uncertainties of the unknowns with everything that may be there unseen, and with the
    /// choice between explanations: of the declared model, or of the one with the adopted physics in it.
    pub fn u_with_unseen(&self) -> Vec<f64> {
        let of = self.estimates().iter().enumerate().map(|(at, estimate)| {
            let lines = self.omitted.iter().map(|line| line.after.u.get(at));
            let choices = self.choices.iter().map(|choice| choice.get(at));
            let squares = lines.chain(choices).flatten().map(|u| u * u);
            (estimate.u * estimate.u + squares.sum::<f64>()).sqrt()
        });
        of.collect()
    }
}

/// Confronts the declared model of a case with its recording.
///
/// `progress` is told the share of the work that is done, and may stop it.
///
/// # Errors
/// When the model cannot be fitted, or the work was stopped.
pub fn diagnose(
    case: &Case,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<Diagnosis, Failure> {
    size::fits_into_memory(case)?;
    let design = Design::new(case);
    let (fit, claimed) = settled::settle_spread_out(&design)?;
    let white = baseline(&design, &fit, &claimed)?;
    let coarse = Coarse::of(&design, &fit);
    let declared = Declared {
        case,
        design: &design,
        fit: &fit,
        coarse: &coarse,
        seen: &coarse.design(),
        beside: &Default::default(),
        white: &white,
    };
    let inquiry = Inquiry::of(declared, claimed, progress)?;
    let located = inquiry.located();
    let Inquiry {
        candidates,
        answer,
        settings,
        if_independent,
        ..
    } = inquiry;
    let Answer {
        claimed,
        baseline,
        mut examination,
    } = answer;
    let known = Known {
        design: &design,
        fit: &fit,
        claimed: &claimed,
    };
    let before = confirm::quality(&design, &fit, &claimed);
    let unknowns = estimates(&design, &fit, &claimed);
    let Adoption {
        adopted,
        no_fit,
        held_out,
        likened,
    } = Adoption::of(
        &known,
        &candidates,
        &mut examination,
        &before,
        settings.alpha,
    );
    let of_improved = |adopted: &Adopted| adopted.fit.unsettled(ModelVersion::Improved);
    let own = adopted.iter().filter_map(of_improved);
    let unsettled = fit.unsettled(ModelVersion::Declared).into_iter();
    let unsettled = unsettled.chain(no_fit).chain(own).collect();
    let listed = examination.slots.iter().filter(|_| adopted.is_some());
    let named = listed.clone().flat_map(|slot| &slot.named);
    let named: Vec<usize> = named.map(|named| named.candidate).collect();
    let choices = listed.map(|slot| omitted::choice(&candidates, &baseline, slot));
    let choices = choices.collect();
    let improved = (adopted.as_ref()).and_then(|adopted| adopted.baseline(&claimed));
    let u: Vec<f64> = unknowns.iter().map(|unknown| unknown.u).collect();
    let omitted = omitted::lines(&candidates, &baseline, improved.as_ref(), &named, &u);
    let recorded = Recorded {
        known: &known,
        candidates: &candidates,
        baseline: &baseline,
    };
    let separating = explanation::separating(&recorded, &examination);
    let accounts = accounts::accounts(&candidates, &baseline, &settings, &examination);
    let atoms = candidates.atoms.iter();
    let atoms = atoms.map(|atom| (atom.candidate, atom.variant)).collect();
    let last = adopted.as_ref().map_or(&fit, |adopted| &adopted.fit);
    let together = noise_outputs::together(&design, last, &claimed.u);
    let together = together.filter(|_| claimed.in_common().is_none());
    let claimed = Claimed {
        together,
        ..claimed
    };
    Ok(Diagnosis {
        examination,
        if_independent,
        located,
        unknowns,
        before,
        adopted,
        blocks: design.blocks.clone(),
        omitted,
        unsettled,
        separating,
        accounts,
        held_out,
        likened,
        choices,
        steady: candidates.fitted.is_steady(),
        cells: candidates.cells,
        atoms,
        fit,
        noise: claimed,
    })
}

/// The model with the named effects in it, held against the declared one.
struct Adoption {
    adopted: Option<Adopted>,
    /// Why the named effects could not be fitted.
    no_fit: Option<Unsettled>,
    held_out: Option<HeldOutQuality>,
    likened: Option<Likeness>,
}

impl Adoption {
    /// Fits the named effects, and takes from the examination what neither the fit nor the recording held out bears out.
    fn of(
        known: &Known<'_>,
        candidates: &Candidates<'_>,
        examination: &mut Examination,
        before: &Quality,
        alpha: f64,
    ) -> Self {
        let (adopted, no_fit) = match adopt_named(candidates, examination, known.claimed) {
            Ok(adopted) => (adopted, None),
            Err(why) => {
                let (model, trouble) = (ModelVersion::Improved, Trouble::NoFit(why));
                (None, Some(Unsettled { model, trouble }))
            }
        };
        let worse =
            (adopted.as_ref()).is_some_and(|adopted| adopted.quality.predicts_worse(before));
        // Of what has no name nothing is adopted.
        let has_name = examination.slots.iter().any(Slot::has_likely_name);
        let adopted = adopted.filter(|_| !worse && has_name);
        let held_out = held_out::held_out(known, candidates, examination, adopted.as_ref());
        let recurs = (adopted.as_ref()).is_some_and(|adopted| recurs(adopted, candidates));
        let against = held_out.as_ref().filter(|_| recurs);
        let contradicted = against.is_some_and(|held| held.contradicts(alpha));
        let absent = against.is_some_and(HeldOutQuality::is_no_better);
        let uneven = (adopted.as_ref()).is_some_and(|adopted| adopted.confirmation.differs());
        let faint = (adopted.as_ref()).is_some_and(|adopted| has_faint_steps(adopted, candidates));
        let likened = match (absent, uneven, faint) {
            (true, ..) => Some(Likeness::Absent),
            (_, true, _) => Some(Likeness::Uneven),
            (.., true) => Some(Likeness::Weak),
            _ => None,
        };
        if worse || contradicted {
            examination.withdraw();
        } else if likened.is_some() {
            examination.only_likens();
        }
        Adoption {
            adopted,
            no_fit,
            held_out,
            likened,
        }
    }
}

/// Whether something else than one of the steps of an adopted staircase would not have been seen: steps enough follow any course.
fn has_faint_steps(adopted: &Adopted, candidates: &Candidates<'_>) -> bool {
    let forms = adopted.atoms.iter().map(|atom| candidates.variation(*atom));
    let in_set = forms.flat_map(|form| std::iter::repeat_n(form.is_set, form.coefficients()));
    let mut steps = in_set.zip(&adopted.coefficients);
    steps.any(|(in_set, step)| in_set && !evidence::is_severe(step.value.abs() / step.u))
}

/// Whether every effect that is adopted would be there in another recording.
fn recurs(adopted: &Adopted, candidates: &Candidates<'_>) -> bool {
    let mut effects = (adopted.atoms.iter()).map(|atom| candidates.cell(*atom).effect);
    effects.all(|effect| !effect.is_slip && effect.pattern.is_none_or(Pattern::recurs))
}
