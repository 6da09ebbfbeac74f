//! A recording together with a further measurement: its rows, its noise, and how explanations stand in it.

use nalgebra::{DMatrix, DVector};

use super::candidates::{Candidates, baseline};
use super::case::Extra;
use super::case::NoiseClaim;
use super::catalogue::{self, Cell, FittedModel, Variation};
use super::coarse::Coarse;
use super::design::Design;
use super::evidence::Baseline;
use super::fit::{self, Fit};
use super::noise::Claimed;
use super::settled;

/// What is known of a case before a further measurement: a model, fitted to its recording, and the noise.
pub(super) struct Known<'k> {
    pub design: &'k Design<'k>,
    pub fit: &'k Fit,
    pub claimed: &'k Claimed,
}

/// A recording with what its residuals are examined by.
pub(super) struct Recorded<'r> {
    pub known: &'r Known<'r>,
    pub candidates: &'r Candidates<'r>,
    pub baseline: &'r Baseline,
}

/// The recording together with a further measurement.
pub(super) struct Prolonged<'l> {
    pub fitted: FittedModel<'l>,
    pub cells: Vec<Cell>,
    pub baseline: Baseline,
}

/// Examines the recording together with a further measurement; nothing where the model has no values there.
pub(super) fn examined<R>(
    recorded: &Recorded<'_>,
    extra: &Extra,
    examine: impl FnOnce(&Prolonged<'_>) -> R,
) -> Option<R> {
    let known = recorded.known;
    let case = known.design.case.followed_by(&extra.rows);
    let mut design = Design::new(&case);
    design.blocks = blocks(known, extra);
    let fit = fit::at(&design, known.design.carried(&known.fit.unknowns, &design));
    if !fit.jacobian.iter().all(|x| x.is_finite()) {
        return None;
    }
    let fit = Fit {
        residuals: DVector::zeros(design.observations()),
        ..fit
    };
    let coarse = Coarse::of(&design, &fit);
    let seen = coarse.design();
    let fitted =
        FittedModel::new(&seen, &coarse.fit).refined(recorded.candidates.fitted.finer.clone());
    let cells = catalogue::cells(&fitted);
    let noise = noise_of(known, &design, &fit, known.design.blocks.len());
    let baseline = baseline(&design, &fit, &noise).ok()?;
    Some(examine(&Prolonged {
        fitted,
        cells,
        baseline,
    }))
}

impl Recorded<'_> {
    /// Columns of a variation, as they are seen beside the parameters.
    pub(super) fn seen(&self, variation: &Variation) -> DMatrix<f64> {
        let columns = variation.columns(&self.candidates.fitted);
        self.baseline.project(&columns)
    }
}

impl Prolonged<'_> {
    /// Share of a variation that the parameters do not absorb. A grid that follows the rows may have another step here: what is
    /// nearest to it, or else its middle, then stands for it.
    pub(super) fn visibility(&self, cell: &Cell, own: &Variation) -> Option<f64> {
        let variants = &self.cells.iter().find(|other| other.is(cell))?.variants;
        let same = variants.iter().find(|other| other.label == own.label);
        let nearest = || {
            let own = own.shape.as_ref()?.value;
            let far = |other: &Variation| Some((other.shape.as_ref()?.value - own).abs());
            let shaped = variants
                .iter()
                .filter_map(|other| Some((far(other)?, other)));
            let nearest = shaped.min_by(|a, b| a.0.total_cmp(&b.0));
            nearest.map(|(_, other)| other)
        };
        let middle = || variants.get(variants.len() / 2);
        let found = same.or_else(nearest).or_else(middle)?;
        let columns = found.columns(&self.fitted);
        let finite = columns.iter().all(|x| x.is_finite());
        finite.then(|| self.baseline.visibility(&columns))
    }
    /// The observations of the recording alone.
    pub(super) fn recorded(&self, recorded: &Recorded<'_>, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let design = self.fitted.design;
        let (own, all) = (recorded.known.design.blocks.len(), design.blocks.len());
        let places: Vec<usize> = (0..design.case.responses.len())
            .flat_map(|response| (0..own).map(move |block| response * all + block))
            .collect();
        columns.select_rows(&places)
    }
}

/// The blocks of the recording, and after them those that the further rows have by themselves.
fn blocks(known: &Known<'_>, extra: &Extra) -> Vec<Vec<usize>> {
    let alone = known.design.case.with(&extra.rows);
    let behind = |row: usize| row + known.design.case.rows;
    let further = Design::new(&alone).blocks.into_iter();
    let further = further.map(|rows| rows.into_iter().map(behind).collect());
    known.design.blocks.iter().cloned().chain(further).collect()
}

/// The noise of another design, of which so many blocks at the beginning are those of the recording: what is
/// claimed, or for each response what the rows at hand have.
pub(super) fn noise_of(
    known: &Known<'_>,
    design: &Design<'_>,
    fit: &Fit,
    recorded: usize,
) -> Claimed {
    match &known.design.case.noise {
        NoiseClaim::Stated { .. } | NoiseClaim::AtRest { .. } | NoiseClaim::PerRow { .. } => {
            let planned = settled::planned(design, fit);
            planned.rounded_like(design, fit, known.claimed)
        }
        NoiseClaim::Estimated | NoiseClaim::Replicates(_) => {
            let own = known.design.blocks.len();
            let rounding = known.claimed.rounding.as_ref();
            let before = rounding.map_or(&known.claimed.u, |rounding| &rounding.without.u);
            let rms = known.design.root_mean_squares(before);
            let u = DVector::from_fn(design.observations(), |at, _| {
                let (response, block) = design.place(at);
                if block < recorded {
                    before[response * own + block]
                } else {
                    rms[response]
                }
            });
            let planned = Claimed {
                u,
                correlated: None,
                draws: Vec::new(),
                rounding: None,
                ..known.claimed.clone()
            };
            planned.rounded_like(design, fit, known.claimed)
        }
    }
}
