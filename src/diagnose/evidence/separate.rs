//! Which extra measurement tells rivals apart.

use nalgebra::DMatrix;

use super::baseline::Baseline;
use super::fit::resolved;
use super::question::Refusal;

/// An experiment with extra rows: the recording at hand together with a measurement that may follow.
#[derive(Debug, Clone)]
pub struct Action<'a> {
    /// What it costs, in any unit; 1 if costs do not matter.
    pub cost: f64,
    /// The design with the extra rows; its residuals do not matter.
    pub baseline: &'a Baseline,
    /// The rival explanations in this design.
    pub contenders: Vec<Standing>,
}

/// An explanation in a design.
#[derive(Debug, Clone)]
pub struct Standing {
    /// What it does to all rows if it is the truth: first with its most probable size and shape, then with
    /// others that the recording at hand allows, each as probable as the others.
    pub effects: DMatrix<f64>,
    /// Columns of each of its variants: with these it takes up what another does.
    pub variants: Vec<DMatrix<f64>>,
}

/// What an action is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Worth {
    /// Index of the action.
    pub action: usize,
    /// Separability of the two contenders that stay most alike, at their most probable sizes.
    pub kappa: f64,
    /// These two.
    pub pair: (usize, usize),
    /// Probability that the truth then reaches a posterior of 95 %, for the contender that has most to fear:
    /// the mean over the sizes and shapes that it may have.
    pub resolved: f64,
    /// How often the action has to be done for κ = 5; ∞ if it never helps.
    pub repeats: f64,
}

/// Separability with which rivals are told apart nearly always.
const SEPARATED: f64 = 5.0;

/// Actions, the most useful for its cost first: by the separability of the pair that stays most alike,
/// up to 5, over the cost.
///
/// # Errors
///
/// Fewer than two contenders, or columns that do not fit their baseline.
pub fn separate(actions: &[Action]) -> Result<Vec<Worth>, Refusal> {
    let mut worths = actions
        .iter()
        .enumerate()
        .map(|(index, action)| worth(index, action))
        .collect::<Result<Vec<Worth>, Refusal>>()?;
    let value = |worth: &Worth| worth.kappa.min(SEPARATED) / actions[worth.action].cost;
    worths.sort_by(|a, b| value(b).total_cmp(&value(a)));
    Ok(worths)
}

fn worth(index: usize, action: &Action) -> Result<Worth, Refusal> {
    if action.contenders.len() < 2 {
        return Err(Refusal::Sizes { what: "contenders" });
    }
    let rows = action.baseline.rows();
    let fits = |one: &Standing| {
        let mut columns = one.variants.iter().chain([&one.effects]);
        columns.all(|columns| columns.nrows() == rows) && one.effects.ncols() > 0
    };
    if !action.contenders.iter().all(fits) {
        return Err(Refusal::Sizes { what: "action" });
    }
    let spans: Vec<Vec<DMatrix<f64>>> = action
        .contenders
        .iter()
        .map(|one| {
            let seen = one.variants.iter().map(|v| action.baseline.project(v));
            seen.map(basis).collect()
        })
        .collect();
    let mut nearest = (f64::INFINITY, (0, 1));
    let mut least = 1.0_f64;
    for (a, truth) in action.contenders.iter().enumerate() {
        let seen = action.baseline.project(&truth.effects);
        // What the nearest of all rivals leaves of each effect.
        let mut kappas = vec![f64::INFINITY; seen.ncols()];
        for (b, variants) in spans.iter().enumerate().filter(|(b, _)| *b != a) {
            let left = left(&seen, variants);
            if left[0] < nearest.0 {
                nearest = (left[0], (a, b));
            }
            for (kappa, left) in kappas.iter_mut().zip(left) {
                *kappa = kappa.min(left);
            }
        }
        let sum: f64 = kappas.iter().map(|kappa| resolved(*kappa)).sum();
        least = least.min(sum / kappas.len() as f64);
    }
    let kappa = nearest.0;
    Ok(Worth {
        action: index,
        kappa,
        pair: nearest.1,
        resolved: least,
        repeats: if kappa > ALIKE {
            (SEPARATED / kappa).powi(2).max(1.0)
        } else {
            f64::INFINITY
        },
    })
}

/// Length of what the best of some variants leaves of each effect.
fn left(effects: &DMatrix<f64>, variants: &[DMatrix<f64>]) -> Vec<f64> {
    let mut least: Vec<f64> = effects.column_iter().map(|e| e.norm_squared()).collect();
    for basis in variants {
        let rest = effects - basis * basis.tr_mul(effects);
        for (least, rest) in least.iter_mut().zip(rest.column_iter()) {
            *least = least.min(rest.norm_squared());
        }
    }
    least.into_iter().map(f64::sqrt).collect()
}

/// Orthonormal columns of the same span.
fn basis(mut columns: DMatrix<f64>) -> DMatrix<f64> {
    /// Directions that columns of unit length reach no further have none.
    const FLAT: f64 = 1e-7;
    for mut column in columns.column_iter_mut() {
        let length = column.norm();
        if length > 0.0 {
            column /= length;
        }
    }
    let svd = columns.svd(true, false);
    let kept: Vec<usize> = (0..svd.singular_values.len())
        .filter(|k| svd.singular_values[*k] > FLAT)
        .collect();
    svd.u.unwrap_or_default().select_columns(&kept)
}

/// No number of repetitions helps below this separability.
const ALIKE: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::super::baseline::Prior;
    use super::super::noise::{Covariance, Noise};
    use super::*;
    use nalgebra::DVector;

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
            .map(|(_, (baseline, columns))| Action {
                cost: 1.0,
                baseline,
                contenders: (columns.iter())
                    .map(|column| Standing {
                        effects: column.clone(),
                        variants: vec![column.clone()],
                    })
                    .collect(),
            })
            .collect();
        let worths = separate(&actions).unwrap();
        let order: Vec<&str> = worths.iter().map(|w| designs[w.action].0).collect();
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

    #[test]
    fn a_size_that_is_hardly_known_promises_less() {
        let (baseline, columns) = design(&[0.0, 180.0]);
        let promised = |sizes: &[f64]| {
            let contenders = columns.iter().map(|column| Standing {
                effects: DMatrix::from_fn(column.nrows(), sizes.len(), |i, j| {
                    column[(i, 0)] * sizes[j]
                }),
                variants: vec![column.clone()],
            });
            let action = Action {
                cost: 1.0,
                baseline: &baseline,
                contenders: contenders.collect(),
            };
            separate(&[action]).unwrap()[0].resolved
        };
        assert!(promised(&[4.0]) > 0.99);
        assert!(promised(&[4.0, 0.5, 7.5]) < 0.7);
    }

    #[test]
    fn a_rival_with_more_variants_is_nearer() {
        let (baseline, columns) = design(&[0.0, 180.0]);
        let alone = |variants: Vec<DMatrix<f64>>| {
            let standing = |at: usize, variants: Vec<DMatrix<f64>>| Standing {
                effects: 5.0 * &columns[at],
                variants,
            };
            let contenders = vec![standing(0, vec![columns[0].clone()]), standing(1, variants)];
            let action = Action {
                cost: 1.0,
                baseline: &baseline,
                contenders,
            };
            separate(&[action]).unwrap()[0].kappa
        };
        let mixed = &columns[0] + 0.1 * &columns[1];
        assert!(alone(vec![columns[1].clone()]) > 5.0);
        assert!(alone(vec![columns[1].clone(), mixed]) < 1.0);
    }
}
