//! The prediction of a recording that the fit has not seen: by the declared model, and by the one with the
//! adopted physics in it.

use gumption_core::least_squares::axes;
use gumption_core::special::{chi_squared_sf, f_sf};
use nalgebra::{DMatrix, DVector};

use super::adopt::{Extended, Following};
use super::adopted::Adopted;
use super::candidates::Candidates;
use super::case::Data;
use super::catalogue::modifiers::{line_through, map, map2, range};
use super::catalogue::{self, Cell, FittedModel, Pattern, Term, Variation};
use super::coarse::Coarse;
use super::confirm;
use super::design::{Design, Unknown};
use super::evidence::{Alternative, Examination, Fitted, over_noise};
use super::explanation::CONTENDERS;
use super::fit::{self, Fit};
use super::noise::Claimed;
use super::prolonged::{Known, noise_of};

/// How well a recording is predicted.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldOutQuality {
    /// The file, as the case names it.
    pub file: String,
    /// Its rows, or means of rows.
    pub observations: usize,
    /// Root mean square of the claimed noise, for each response.
    pub expected: Vec<f64>,
    /// By the declared model.
    pub before: Prediction,
    /// With the adopted physics; `None` if nothing was adopted, or where its course in this recording does
    /// not follow from the columns: that of a jump does only in what was recorded after it.
    pub after: Option<Prediction>,
    /// By each explanation of a list, the adopted one first; of lists that are not too long.
    pub listed: Vec<Listed>,
}

/// How an explanation predicts the recording that stands in a list with others, in the place of the one that was adopted.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// Index of the slot in the examination.
    pub slot: usize,
    /// The candidate.
    pub candidate: usize,
    /// As [`HeldOutQuality::after`].
    pub prediction: Option<Prediction>,
}

/// A prediction against what was observed.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Root mean square of the errors, for each response.
    pub rms: Vec<f64>,
    /// The square of the errors over their covariance: of the noise, and of the parameters, whose errors all rows share.
    pub chi_squared: f64,
    /// Probability of errors that large by chance; `None` where successive rows are correlated, of which the law of
    /// the held-out rows is not known.
    pub p: Option<f64>,
}

impl HeldOutQuality {
    /// The prediction by the best model there is.
    pub fn best(&self) -> &Prediction {
        self.after.as_ref().unwrap_or(&self.before)
    }

    /// The candidate of a list that alone predicts the recording: at the level `alpha` its errors are not larger than chance allows,
    /// and those of all others are.
    pub fn speaks_for(&self, slot: usize, alpha: f64) -> Option<usize> {
        let of_slot: Vec<&Listed> = self.listed.iter().filter(|one| one.slot == slot).collect();
        let p = |one: &&Listed| one.prediction.as_ref().and_then(|prediction| prediction.p);
        let known: Option<Vec<f64>> = of_slot.iter().map(p).collect();
        let known = known?;
        let mut possible = (0..known.len()).filter(|at| known[*at] >= alpha);
        let only = possible.next().filter(|_| possible.next().is_none())?;
        (known.len() > 1).then(|| of_slot[only].candidate)
    }

    /// Whether what was adopted does not show here: the errors are no smaller than without it.
    pub(super) fn is_no_better(&self) -> bool {
        let squares = |prediction: &Prediction| -> f64 {
            let scaled = prediction.rms.iter().zip(&self.expected);
            scaled.map(|(rms, u)| (rms / u) * (rms / u)).sum()
        };
        (self.after.as_ref()).is_some_and(|after| squares(after) >= squares(&self.before))
    }

    /// Whether it is contradicted: the errors are larger than chance allows at the level `alpha` besides.
    pub(super) fn contradicts(&self, alpha: f64) -> bool {
        let after = self.after.as_ref().and_then(|after| after.p);
        after.is_some_and(|p| p < alpha) && self.is_no_better()
    }
}

/// Predicts the held-out recording of a case, if there is one.
pub(super) fn held_out(
    known: &Known<'_>,
    candidates: &Candidates<'_>,
    examination: &Examination,
    adopted: Option<&Adopted>,
) -> Option<HeldOutQuality> {
    let held = known.design.case.held_out.as_ref()?;
    let case = known.design.case.with(&held.rows);
    let design = Design::new(&case);
    let (fit, claimed) = known.at(&design);
    let model = |adopted: &Adopted| {
        improved(
            known,
            candidates,
            &adopted.atoms,
            (&adopted.extended, &adopted.fit),
        )
    };
    let after = adopted.and_then(model);
    let listed = adopted.map(|_| listed(known, candidates, examination, after.as_ref()));
    Some(HeldOutQuality {
        listed: listed.unwrap_or_default(),
        file: held.file.clone(),
        observations: design.observations(),
        expected: design.root_mean_squares(&claimed.u),
        before: known.prediction(&design, &fit, &claimed),
        after,
    })
}

impl Known<'_> {
    /// On other rows, with the noise that these have.
    fn at(&self, design: &Design<'_>) -> (Fit, Claimed) {
        let fit = fit::at(design, self.design.carried(&self.fit.unknowns, design));
        let claimed = noise_of(self, design, &fit, 0);
        (fit, claimed)
    }

    fn prediction(&self, design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> Prediction {
        let own = confirm::covariance(self.design, self.fit, self.claimed);
        let place = |unknown: &Unknown| self.design.named(&unknown.name);
        let places: Vec<Option<usize>> = design.unknowns.iter().map(place).collect();
        let covariance = |a: usize, b: usize| match (places[a], places[b]) {
            (Some(a), Some(b)) => own[(a, b)],
            _ => 0.0,
        };
        let covariance = DMatrix::from_fn(places.len(), places.len(), covariance);
        let slopes = over_noise(&fit.jacobian, &claimed.u);
        let errors = fit.residuals.component_div(&claimed.u);
        let chi_squared = chi_squared(&errors, slopes, &covariance);
        Prediction {
            rms: design.root_mean_squares(&fit.residuals),
            chi_squared,
            p: self.chance(chi_squared, design.observations() as f64),
        }
    }

    /// Probability of a χ² of so many observations by chance, with noise that was estimated Fisher's; of correlated noise nobody
    /// knows how the single rows scatter.
    fn chance(&self, chi_squared: f64, observations: f64) -> Option<f64> {
        let dof = match self.claimed.is_estimated() {
            true => confirm::degrees(self.design),
            false => self.claimed.dof,
        };
        let p = match dof.is_finite() {
            true => f_sf(chi_squared / observations, observations, dof.max(1.0)),
            false => chi_squared_sf(chi_squared, observations),
        };
        self.claimed.correlated.is_none().then_some(p)
    }
}

/// The square of errors over their covariance, which is 1 and what parameters of this covariance do to the rows with these
/// slopes; all over the noise.
fn chi_squared(errors: &DVector<f64>, mut slopes: DMatrix<f64>, covariance: &DMatrix<f64>) -> f64 {
    let count = covariance.nrows();
    let u = covariance
        .diagonal()
        .map(|variance| variance.max(0.0).sqrt());
    let scale = u.map(|u| if u > 0.0 { 1.0 / u } else { 0.0 });
    for (mut column, u) in slopes.column_iter_mut().zip(&u) {
        column *= *u;
    }
    let correlation = DMatrix::from_fn(count, count, |a, b| {
        covariance[(a, b)] * scale[a] * scale[b]
    });
    let Some(axes) = axes(correlation) else {
        return errors.norm_squared();
    };
    let lengths = axes.eigenvalues.map(|variance| variance.max(0.0).sqrt());
    let shared = slopes * axes.eigenvectors * DMatrix::from_diagonal(&lengths);
    // (1 + AAᵀ)⁻¹ = 1 − A (1 + AᵀA)⁻¹ Aᵀ
    let along = shared.tr_mul(errors);
    let inner = DMatrix::identity(count, count) + shared.tr_mul(&shared);
    let taken = (inner.cholesky()).map_or(0.0, |inner| along.dot(&inner.solve(&along)));
    (errors.norm_squared() - taken).max(0.0)
}

/// By each of several explanations of an effect; `after` is by the first.
fn listed(
    known: &Known<'_>,
    candidates: &Candidates<'_>,
    examination: &Examination,
    after: Option<&Prediction>,
) -> Vec<Listed> {
    let Some(found) = &examination.fitted else {
        return Vec::new();
    };
    let slots = examination.slots.iter().enumerate();
    // Of a longer list nothing is said, as nothing can be said of what is not looked at.
    let several = slots.filter(|(_, slot)| (2..=CONTENDERS).contains(&slot.named.len()));
    let adopted = several.filter_map(|(at, slot)| {
        let first = slot.named.first()?.variants.first()?.atom;
        found.atoms.contains(&first).then_some((at, slot, first))
    });
    let of = adopted.flat_map(|(at, slot, first)| {
        let named = slot.named.iter().enumerate();
        named.map(move |(place, alternative)| Listed {
            slot: at,
            candidate: alternative.candidate,
            prediction: match place {
                0 => after.cloned(),
                _ => in_place(known, candidates, (found, first), alternative),
            },
        })
    });
    of.collect()
}

/// By an explanation in the place of an atom that was adopted.
fn in_place(
    known: &Known<'_>,
    candidates: &Candidates<'_>,
    (found, first): (&Fitted, usize),
    alternative: &Alternative,
) -> Option<Prediction> {
    let other = alternative.variants.first()?.atom;
    let mut sizes = found.coefficients.as_slice();
    let mut all: Vec<f64> = Vec::new();
    for atom in &found.atoms {
        let (own, rest) = sizes.split_at_checked(candidates.variation(*atom).coefficients())?;
        all.extend(if *atom == first {
            alternative.estimate.as_slice()
        } else {
            own
        });
        sizes = rest;
    }
    let atoms = found.atoms.iter();
    let instead = Fitted {
        atoms: atoms
            .map(|atom| if *atom == first { other } else { *atom })
            .collect(),
        coefficients: DVector::from_vec(all),
        ..found.clone()
    };
    let (extended, fit) = candidates.refitted(&instead, known.claimed).ok()??;
    improved(known, candidates, &instead.atoms, (&extended, &fit))
}

/// By a model with effects in it.
fn improved(
    known: &Known<'_>,
    candidates: &Candidates<'_>,
    atoms: &[usize],
    (extended, fit): (&Extended, &Fit),
) -> Option<Prediction> {
    let held = known.design.case.held_out.as_ref()?;
    let both = known.design.case.followed_by(&held.rows);
    let design = Design::new(&both);
    let declared = fit::at(&design, known.design.carried(&known.fit.unknowns, &design));
    let coarse = Coarse::of(&design, &declared);
    let seen = coarse.design();
    let mut finer = candidates.fitted.finer.clone();
    for atom in atoms {
        finer.keep(candidates.cell(*atom), candidates.variation(*atom));
    }
    let wide = FittedModel::new(&seen, &coarse.fit).refined(finer);
    let others = catalogue::cells(&wide);
    let numeric = wide.numeric();
    let columns = (numeric.iter()).map(|column| seen.spread(wide.numbers(*column)));
    let columns: Vec<Vec<f64>> = columns.collect();
    let cells = atoms.iter().map(|atom| candidates.cell(*atom));
    let mut patterns = cells.filter_map(|cell| cell.effect.pattern);
    let jumps = patterns.any(|pattern| matches!(pattern, Pattern::Jump | Pattern::ScaleJump));
    if jumps && !follows(&wide, known.design.case.rows) {
        return None;
    }
    let mut rows = held.rows.clone();
    for Following { effect, term, .. } in &extended.columns {
        // Both recordings together may have other effects than the first: the same course by another name is the same course.
        let cell = candidates.cell(atoms[*effect]);
        let alike: Vec<&Cell> = others.iter().filter(|other| other.is(cell)).collect();
        let all: Vec<&Cell> = others.iter().collect();
        let designs = [candidates.fitted.design, &seen];
        let modifier = moved(term, &alike, &columns, designs)
            .or_else(|| continued(term, &alike, designs, LIKE))
            .or_else(|| continued(term, &all, designs, SAME))?;
        rows.data.push(Data::Numbers(modifier));
    }
    let model = Known {
        design: &Design::new(&extended.case),
        fit,
        claimed: known.claimed,
    };
    let case = extended.case.with(&rows);
    let design = Design::new(&case);
    let (fit, claimed) = model.at(&design);
    Some(model.prediction(&design, &fit, &claimed))
}

/// Whether the rows behind the first ones were recorded after them: what jumped stays where it is. At another time nobody knows
/// whether it has happened.
fn follows(both: &FittedModel<'_>, rows: usize) -> bool {
    let times = &both.clock.values;
    let (own, rest) = times.split_at(rows.min(times.len()));
    range(own).1 <= range(rest).0
}

/// What another variant of an effect may leave of a modifier, as a share of its variance.
const LIKE: f64 = 0.05;
/// What a modifier leaves of another that has the same course, as a share of its variance: rounding.
const SAME: f64 = 1e-9;

/// The course of a modifier in the rows that follow its own in the design of both recordings: of the term of the same effect that
/// is, but for its origin and its unit, the same in the first rows. Origins and units (the mean of a column,
/// the start of the recording) belong to the recording in which the effect was found.
fn continued(
    term: &Term,
    cells: &[&Cell],
    [own, both]: [&Design<'_>; 2],
    most: f64,
) -> Option<Vec<f64>> {
    let sought = own.spread(&term.written().values);
    let variants = cells.iter().flat_map(|cell| &cell.variants);
    let like = variants.flat_map(|variation| courses_of(variation, term, both));
    let found = like.filter_map(|course| combined(&sought, [course]));
    let (left, rest) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (left < most).then_some(rest)
}

/// The same where the origin of what is squared or multiplied is another, of which the first powers tell: what follows from
/// all terms of a variant and from the columns.
fn moved(
    term: &Term,
    cells: &[&Cell],
    columns: &[Vec<f64>],
    [own, both]: [&Design<'_>; 2],
) -> Option<Vec<f64>> {
    let sought = own.spread(&term.written().values);
    let mut variants = cells.iter().flat_map(|cell| &cell.variants);
    variants.find_map(|variation| {
        let courses = courses_of(variation, term, both).chain(columns.iter().cloned());
        let (left, rest) = combined(&sought, courses)?;
        (left < SAME).then_some(rest)
    })
}

/// The courses of those terms of a variant that act where another acts.
fn courses_of<'v>(
    variation: &'v Variation,
    term: &'v Term,
    both: &'v Design<'_>,
) -> impl Iterator<Item = Vec<f64>> + 'v {
    let like = |other: &&Term| other.node == term.node && other.response == term.response;
    (variation.terms.iter().filter(like)).map(|other| both.spread(&other.written().values))
}

/// The combination of courses that comes nearest to what is sought in the first rows, in the rows behind them; and what
/// it leaves of the variance. Each course counts with what the ones before it leave of it.
fn combined(
    sought: &[f64],
    courses: impl IntoIterator<Item = Vec<f64>>,
) -> Option<(f64, Vec<f64>)> {
    let own = sought.len();
    let beside = |course: &[f64], other: &[f64]| {
        let (factor, offset, left) = line_through(other.get(..own)?, course.get(..own)?);
        let rest = map2(course, other, |x, z| x - (factor * z + offset));
        Some((left, rest))
    };
    let mut others: Vec<Vec<f64>> = Vec::new();
    let mut rest: Vec<f64> = Vec::new();
    let mut share = 1.0;
    for mut course in courses {
        let mut own_share = 1.0;
        for other in &others {
            let (left, new) = beside(&course, other)?;
            (course, own_share) = (new, own_share * left);
        }
        if own_share < SAME {
            continue;
        }
        if others.is_empty() {
            rest = sought.to_vec();
            rest.resize(course.len(), 0.0);
        }
        let (left, new) = beside(&rest, &course)?;
        (rest, share) = (new, share * left);
        others.push(course);
    }
    let behind = rest.get(own..)?;
    Some((share, map(behind, |x| -x)))
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::{chi_squared, combined};

    #[test]
    fn a_square_goes_on_about_the_origin_that_it_had() {
        let x = |row: i32| f64::from(row * row % 11);
        let sought: Vec<f64> = (0..12).map(|row| (x(row) - 4.0) * (x(row) - 4.0)).collect();
        let both = |of: &dyn Fn(f64) -> f64| (0..20).map(|row| of(x(row))).collect::<Vec<_>>();
        let square = both(&|x| 3.0 * (x - 5.5) * (x - 5.5));
        let (alone, _) = combined(&sought, [square.clone()]).unwrap();
        assert!(alone > 1e-3, "{alone}");
        // The line, said twice.
        let courses = [square, both(&|x| x), both(&|x| 7.0 - 2.0 * x)];
        let (left, rest) = combined(&sought, courses).unwrap();
        assert!(left < 1e-12 && rest.len() == 8, "{left}");
        for (row, value) in (12..20).zip(rest) {
            assert!((value - (x(row) - 4.0) * (x(row) - 4.0)).abs() < 1e-9);
        }
    }

    #[test]
    fn rows_share_the_errors_of_parameters() {
        // An offset that is known to 3 only, beside a slope in another unit: an error of all rows alike is one error.
        let slopes = DMatrix::from_columns(&[
            DVector::from_element(50, 1.0),
            DVector::from_fn(50, |row, _| 1e9 * (row as f64 - 24.5)),
        ]);
        let covariance = DMatrix::from_diagonal(&DVector::from_vec(vec![9.0, 1e-20]));
        let alike = DVector::from_element(50, 3.0);
        let found = chi_squared(&alike, slopes.clone(), &covariance);
        // 50·9/(1 + 50·9), by hand.
        assert!((found - 450.0 / 451.0).abs() < 1e-9, "{found}");
        let turns = DVector::from_fn(50, |row, _| if row % 2 == 0 { 1.0 } else { -1.0 });
        let direct = {
            let shared = &slopes * &covariance * slopes.transpose();
            let whole = DMatrix::identity(50, 50) + shared;
            turns.dot(&whole.lu().solve(&turns).unwrap())
        };
        let found = chi_squared(&turns, slopes, &covariance);
        assert!((found - direct).abs() < 1e-9 * direct, "{found} {direct}");
    }
}
