//! Which extra measurement tells rivals apart.

use nalgebra::{DMatrix, DVector};

use super::baseline::Baseline;
use super::fit::{least_squares, resolved};
use super::question::Refusal;

/// An experiment with extra rows: the recording at hand together with a measurement that may follow.
#[derive(Debug, Clone)]
pub struct Action<'a> {
    /// What is done: "remount +90°".
    pub name: String,
    /// What it costs, in any unit; 1 if costs do not matter.
    pub cost: f64,
    /// The design with the extra rows; its residuals do not matter.
    pub baseline: &'a Baseline,
    /// The effects of the contenders on all rows, in the order of the contenders.
    pub columns: Vec<DMatrix<f64>>,
}

/// What an action is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Worth {
    /// Index of the action.
    pub action: usize,
    /// Separability of the two contenders that stay most alike.
    pub kappa: f64,
    /// These two.
    pub pair: (usize, usize),
    /// Probability that the truth of the two then reaches a posterior of 95 %.
    pub resolved: f64,
    /// How often the action has to be done for κ = 5; ∞ if it never helps.
    pub repeats: f64,
}

/// Separability with which rivals are told apart nearly always.
const SEPARATED: f64 = 5.0;

/// Actions, the most useful for its cost first: by the separability of the pair that stays most alike,
/// up to 5, over the cost. `contenders` holds the estimated coefficients of each rival explanation;
/// coefficients that are not finite count as zero.
///
/// # Errors
///
/// Fewer than two contenders, or columns that do not fit their baseline.
pub fn separate(contenders: &[DVector<f64>], actions: &[Action]) -> Result<Vec<Worth>, Refusal> {
    if contenders.len() < 2 {
        return Err(Refusal::Sizes { what: "contenders" });
    }
    let mut worths = actions
        .iter()
        .enumerate()
        .map(|(index, action)| worth(index, contenders, action))
        .collect::<Result<Vec<Worth>, Refusal>>()?;
    let value = |worth: &Worth| worth.kappa.min(SEPARATED) / actions[worth.action].cost;
    worths.sort_by(|a, b| value(b).total_cmp(&value(a)));
    Ok(worths)
}

fn worth(index: usize, contenders: &[DVector<f64>], action: &Action) -> Result<Worth, Refusal> {
    let fits = |columns: &DMatrix<f64>, size: &DVector<f64>| {
        columns.nrows() == action.baseline.rows() && columns.ncols() == size.len()
    };
    let sizes = action.columns.len() == contenders.len()
        && action
            .columns
            .iter()
            .zip(contenders)
            .all(|(c, s)| fits(c, s));
    if !sizes {
        return Err(Refusal::Sizes { what: "action" });
    }
    let seen: Vec<DMatrix<f64>> = action
        .columns
        .iter()
        .map(|columns| action.baseline.project(columns))
        .collect();
    let mut nearest = (f64::INFINITY, (0, 1));
    for (a, size) in contenders.iter().enumerate() {
        let size = size.map(|x| if x.is_finite() { x } else { 0.0 });
        let effect = &seen[a] * size;
        for (b, rival) in seen.iter().enumerate().filter(|(b, _)| *b != a) {
            let (coefficients, _) = least_squares(rival, &effect);
            let kappa = (&effect - rival * coefficients).norm();
            if kappa < nearest.0 {
                nearest = (kappa, (a, b));
            }
        }
    }
    let kappa = nearest.0;
    Ok(Worth {
        action: index,
        kappa,
        pair: nearest.1,
        resolved: resolved(kappa),
        repeats: if kappa > ALIKE {
            (SEPARATED / kappa).powi(2).max(1.0)
        } else {
            f64::INFINITY
        },
    })
}

/// No number of repetitions helps below this separability.
const ALIKE: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::super::baseline::Prior;
    use super::super::noise::{Covariance, Noise};
    use super::*;

    /// Twelve positions in each mount: the baseline, and K2 and encoder eccentricity (1/rev cosine).
    fn design(mounts: &[f64]) -> (Baseline, Vec<DMatrix<f64>>) {
        let mut angles = Vec::new();
        for mount in mounts {
            angles.extend((0..12).map(|k| {
                let head = f64::from(k) * std::f64::consts::PI / 6.0;
                (head + mount.to_radians(), head)
            }));
        }
        let n = angles.len();
        let column =
            |f: &dyn Fn(f64, f64) -> f64| DVector::from_fn(n, |i, _| f(angles[i].0, angles[i].1));
        let jacobian = DMatrix::from_columns(&[
            column(&|_, _| 1.0),
            column(&|a, _| a.sin()),
            column(&|a, _| a.cos()),
        ]);
        let noise = Noise::known(Covariance::Diagonal(DVector::from_element(n, 1.0)));
        let baseline =
            Baseline::new(&jacobian, &DVector::zeros(n), &noise, &Prior::none(3)).unwrap();
        let effects = [
            column(&|a, _| a.sin().powi(2)),
            column(&|a, h| a.cos() * h.cos()),
        ];
        let columns = effects
            .iter()
            .map(|e| DMatrix::from_columns(std::slice::from_ref(e)));
        (baseline, columns.collect())
    }

    #[test]
    fn a_remount_separates_what_repetition_does_not() {
        let designs = [
            ("repeat", design(&[0.0, 0.0])),
            ("+45", design(&[0.0, 45.0])),
            ("+90", design(&[0.0, 90.0])),
            ("+180", design(&[0.0, 180.0])),
        ];
        let actions: Vec<Action> = designs
            .iter()
            .map(|(name, (baseline, columns))| Action {
                name: (*name).into(),
                cost: 1.0,
                baseline,
                columns: columns.clone(),
            })
            .collect();
        let contenders = [DVector::from_element(1, 1.0), DVector::from_element(1, 1.0)];
        let worths = separate(&contenders, &actions).unwrap();
        let order: Vec<&str> = worths
            .iter()
            .map(|w| actions[w.action].name.as_str())
            .collect();
        assert_eq!(order, ["+180", "+90", "+45", "repeat"]);
        let last = worths.last().unwrap();
        assert!(last.kappa < 1e-6 && last.repeats == f64::INFINITY && last.resolved < 1e-3);
        // Half of the rows turn their sign: with signals of ½cos 2α each, 24 rows and the fit of the
        // common part κ² = 24/8.
        assert!(
            (worths[0].kappa - 3.0_f64.sqrt()).abs() < 1e-9,
            "{}",
            worths[0].kappa
        );
    }
}
