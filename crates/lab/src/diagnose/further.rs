//! Whether a further effect, beside some that were found, gains more than noise alone gives it.

use super::candidates::{Candidates, baseline};
use super::catalogue::FittedModel;
use super::design::Design;
use super::evidence::{Chance, Examination, Refusal, Settings};
use super::noise::Claimed;
use super::noise_correlation::Courses;
use super::settled;

/// How likely it is that noise alone, beside the effects of an examination, gives a further one as much as it gains: the model with these
/// in it is held against its noise as the declared one is. `gain` is the logarithm of the evidence for all further effects.
/// `None` where the model with the effects cannot be fitted.
///
/// # Errors
/// When the recording does not determine the parameters.
pub(super) fn by_chance(
    candidates: &Candidates<'_>,
    (found, claimed): (&Examination, &Claimed),
    courses: &Courses,
    settings: &Settings,
    gain: f64,
) -> Result<Option<Chance>, Refusal> {
    let Ok(Some((extended, fit))) = candidates.adopted_fit(found, claimed) else {
        return Ok(None);
    };
    let design = Design::new(&extended.case);
    let own = match claimed.is_estimated() {
        true => settled::spread_out(&design, &fit),
        false => claimed.uncorrelated(),
    };
    let plain = settled::plain(&design, &fit, &own);
    let white = baseline(&design, &fit, &own)?;
    let beside = Candidates::new(FittedModel::new(&design, &fit), &own, &white);
    let spreads: Vec<Claimed> = std::iter::once(own).chain(plain).collect();
    Ok(Some(
        beside.against(courses, &spreads, settings, gain)?.chance,
    ))
}
