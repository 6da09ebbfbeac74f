//! A diagnosis from end to end: fit, candidates, examination, location, adoption, confirmation.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};

use super::adopted::{Adopted, adopt_named};
use super::candidates::{Candidates, baseline, settings};
use super::case::Case;
use super::catalogue::{Cell, Finer, FittedModel, Pattern, generics};
use super::coarse::Coarse;
use super::confirm::{self, Estimated, Quality, estimates};
use super::design::Design;
use super::evidence::{self, Examination, Located, TRACE, Verdict};
use super::failure::Failure;
use super::fit::{Fit, ModelVersion, Trouble, Unsettled};
use super::held_out::{self, HeldOutQuality};
use super::noise::{self, Claimed};
use super::noise_correlation::Courses;
use super::omitted::{self, Omitted};
use super::prolonged::{Known, Recorded};
use super::regions;
use super::separation::{self, Separating};
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
    /// For each slot, where something is adopted, what it costs each unknown that the slot has several
    /// explanations.
    pub choices: Vec<Vec<f64>>,
    /// Fits on which a reader should not rely.
    pub unsettled: Vec<Unsettled>,
    /// Explanations that the recording cannot tell apart, with the measurements that would.
    pub separating: Vec<Separating>,
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
    let (fit, mut claimed) = noise::settle_spread_out(&design)?;
    let white = baseline(&design, &fit, &claimed)?;
    let coarse = Coarse::of(&design, &fit);
    let seen = coarse.design();
    let mut settings = settings(case);
    let mut candidates = Candidates::new(FittedModel::new(&seen, &coarse.fit), &claimed, &white);
    let part = |from: f64, to: f64| move |share: f64| progress(from + (to - from) * share);
    let (mut baseline, mut examination) = candidates.ask(&claimed, &settings, &part(0.0, 0.4))?;
    // What the model leaves out may look like noise that grows.
    let plain = noise::plain(&seen, &coarse.fit, &claimed);
    let courses = Courses::of(&candidates.fitted)
        .or_else(|| plain.is_some().then(Courses::white))
        .filter(|_| claimed.correlated.is_none());
    let is_open = claimed.is_estimated() || courses.is_some();
    let mut begun = claimed.clone();
    if let Some(plain) = (plain.as_ref()).filter(|_| examination.verdict == Verdict::None) {
        begun = plain.clone();
        (baseline, examination) = candidates.ask(&begun, &settings, &part(0.4, 0.4))?;
    }
    if let Some(courses) = courses
        .as_ref()
        .filter(|_| examination.verdict == Verdict::None)
    {
        claimed = noise::refined(&design, &fit, &claimed, Some(courses));
        baseline = self::baseline(&design, &fit, &claimed)?;
    } else if is_open {
        let mut starts: Vec<Claimed> = [claimed.clone()].into_iter().chain(plain).collect();
        if let Some(courses) = &courses {
            let (p, likeliest) = candidates.against(courses, &starts, &settings)?;
            settings.by_noise = p;
            match p > settings.alpha {
                true => starts = vec![likeliest],
                false if likeliest.correlated.is_some() => starts.push(likeliest),
                false => {}
            }
        }
        // Noise and effects are estimated in turn: what an effect explains is no noise. Where noise may explain as well what
        // an effect does, the two are begun with in turn, and the likelier end stays.
        let (mut best, mut atoms) = (f64::NEG_INFINITY, candidates.places.len());
        let share = 0.3 / starts.len() as f64;
        let begun = (begun, baseline.clone(), examination.clone());
        let stands = settings.by_noise <= settings.alpha;
        for (at, start) in starts.into_iter().enumerate() {
            let from = 0.4 + share * at as f64;
            let part = part(from, from + share);
            let first = match stands && start == begun.0 {
                true => (begun.1.clone(), begun.2.clone()),
                false => candidates.ask(&start, &settings, &part)?,
            };
            let found = candidates.in_turn(start, first, &settings, courses.as_ref(), &part)?;
            let score = found.1.score + found.0.log_likelihood() + found.2.log_prior();
            if score > best {
                (best, atoms) = (score, candidates.places.len());
                (baseline, examination, claimed) = found;
            }
        }
        if atoms != candidates.places.len() {
            // What cannot have its size with one noise was left out: atoms have other numbers now.
            (baseline, examination) = candidates.ask(&claimed, &settings, &part(0.7, 0.7))?;
        }
        examination.doubted(settings.by_noise);
    }
    // Shapes that lie between the steps of a grid: closer and closer.
    let mut finer = Finer::default();
    for round in 0..REFINEMENTS {
        if !candidates.refine(&mut finer, &examination) {
            break;
        }
        candidates = Candidates::new(
            FittedModel::new(&seen, &coarse.fit).refined(finer.clone()),
            &claimed,
            &white,
        );
        let from = 0.7 + 0.1 * f64::from(round);
        (baseline, examination) = candidates.ask(&claimed, &settings, &part(from, from + 0.05))?;
        if is_open {
            let then = candidates.noise(&examination, &claimed, courses.as_ref());
            if then.weighs_alike(&claimed) {
                continue;
            }
            claimed = then;
            let part = part(from + 0.05, from + 0.1);
            (baseline, examination) = candidates.ask(&claimed, &settings, &part)?;
        }
    }
    // What nobody claims may be anything.
    let is_unclaimed = claimed.wanders() || claimed.is_estimated();
    let is_open = examination.verdict == Verdict::None && is_unclaimed;
    let ordered = courses.filter(|_| is_open && candidates.fitted.clock.column.is_some());
    if let Some(courses) = ordered {
        let with = |correlated| claimed.noise_with(correlated);
        let seen = courses.seen(&seen, &coarse.fit, &with)?;
        // Two tests, each with half of the probability of a false alarm.
        let alpha = 0.5 * settings.alpha;
        let p = evidence::unsteadiness(&seen, &claimed.noise(), settings.seed, alpha)?;
        if p <= alpha {
            examination.unnamed(candidates.cells.len(), 2.0 * p);
            candidates
                .cells
                .push(generics::unsteady(&candidates.fitted));
        }
    }
    let located = if examination.verdict == Verdict::None {
        Vec::new()
    } else {
        let mut levels = regions::cells(&candidates.fitted);
        let columns: Vec<DVector<f64>> = levels.iter().map(|cell| cell.column.clone()).collect();
        if !columns.is_empty() {
            let shares = white.visibilities(&DMatrix::from_columns(&columns));
            let mut shares = shares.into_iter();
            levels.retain(|_| shares.next().is_some_and(|share| share > TRACE));
        }
        let found = evidence::locate(&baseline, &levels, &settings).into_iter();
        let with_cell = found.map(|located| (levels[located.cell].clone(), located));
        with_cell.collect()
    };
    let before = confirm::quality(&design, &fit, &claimed);
    let mut unsettled: Vec<Unsettled> = fit.unsettled(ModelVersion::Declared).into_iter().collect();
    let mut adopted = match adopt_named(&candidates, &mut examination, &claimed) {
        Ok(adopted) => adopted,
        Err(why) => {
            unsettled.push(Unsettled {
                model: ModelVersion::Improved,
                trouble: Trouble::NoFit(why),
            });
            None
        }
    };
    if (adopted.as_ref()).is_some_and(|adopted| adopted.predicts_worse(&before)) {
        examination.withdraw();
        adopted = None;
    }
    let unknowns = estimates(&design, &fit, &claimed);
    let known = Known {
        design: &design,
        fit: &fit,
        claimed: &claimed,
    };
    let held_out = held_out::held_out(&known, &candidates, adopted.as_ref());
    let recurs = |adopted: &Adopted| {
        let mut patterns = (adopted.atoms.iter()).map(|atom| candidates.cell(*atom).effect.pattern);
        patterns.all(|pattern| pattern.is_none_or(Pattern::recurs))
    };
    if adopted.as_ref().is_some_and(recurs)
        && (held_out.as_ref()).is_some_and(|held| held.contradicts(settings.alpha))
    {
        examination.withdraw();
    }
    let of_improved = |adopted: &Adopted| adopted.fit.unsettled(ModelVersion::Improved);
    unsettled.extend(adopted.iter().filter_map(of_improved));
    let improved = (adopted.as_ref()).and_then(|adopted| adopted.baseline(&claimed));
    let listed = examination.slots.iter().filter(|_| adopted.is_some());
    let named: Vec<usize> = listed
        .clone()
        .flat_map(|slot| slot.named.iter().map(|named| named.candidate))
        .collect();
    let choices = listed
        .map(|slot| omitted::choice(&candidates, &baseline, slot))
        .collect();
    let u: Vec<f64> = unknowns.iter().map(|unknown| unknown.u).collect();
    let omitted = omitted::lines(&candidates, &baseline, improved.as_ref(), &named, &u);
    let recorded = Recorded {
        known: &known,
        candidates: &candidates,
        baseline: &baseline,
    };
    let separating = separation::separating(&recorded, &examination);
    Ok(Diagnosis {
        examination,
        located,
        unknowns,
        before,
        fit,
        adopted,
        blocks: design.blocks.clone(),
        omitted,
        unsettled,
        separating,
        held_out,
        choices,
        steady: candidates.fitted.is_steady(),
        cells: candidates.cells,
        atoms: candidates.places,
        noise: claimed,
    })
}

/// So often the values about the parameter of an effect are brought closer together.
const REFINEMENTS: u8 = 3;
