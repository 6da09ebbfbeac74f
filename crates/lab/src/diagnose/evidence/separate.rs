//! Which extra measurement tells rivals apart.

use nalgebra::DMatrix;

use super::directions::left;
use super::findings::ALONE;
use super::fit::reached;
use super::look_alikes::stays;

/// A rival explanation in a design, as it is seen beside the fitted parameters
/// ([`Baseline::project`](super::Baseline::project)).
#[derive(Debug, Clone)]
pub struct Standing {
    /// What it does if it is the truth: first with its most probable size and shape, then with others that the
    /// recording at hand allows, each as probable as the others.
    pub effects: DMatrix<f64>,
    /// Columns of each of its variants: with these it takes up what another does.
    pub variants: Vec<DMatrix<f64>>,
    /// Whether several of its variants may act at once, so that mixtures of them say nothing.
    pub repeats: bool,
}

impl Standing {
    /// Whether a rival with such variants stays on its list whatever the odds say.
    pub fn keeps(&self, variants: &[DMatrix<f64>]) -> bool {
        let widths = self.variants.iter().map(DMatrix::ncols);
        let own = widths.min().unwrap_or(0);
        stays(&self.effects.column(0).into_owned(), own, variants)
    }
}

/// How far rival explanations are apart in a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Separability {
    /// What the second leaves of the first, for each of the effects that this may have.
    left: Vec<Vec<Vec<f64>>>,
    /// Whether the second stays on the list of the first whatever the odds say.
    stays: Vec<Vec<bool>>,
    /// Lengths of the effects.
    whole: Vec<Vec<f64>>,
}

/// What a further measurement is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Worth {
    /// Separability of the two contenders that stay most alike, at their most probable sizes.
    pub kappa: f64,
    /// Probability that the truth then stands alone, with a posterior of 99 %.
    pub resolved: f64,
    /// How often it has to be done for κ = 5; ∞ if it never helps.
    pub repeats: f64,
}

/// Separability with which rivals are told apart nearly always.
pub const SEPARATED: f64 = 5.0;
/// No number of repetitions helps below this separability.
const NOTHING: f64 = 1e-6;
/// Explanations are the same where less than this share of either is left.
const SAME: f64 = 0.01;

/// Holds explanations against one another in a design; nothing of fewer than two, or of those that have different numbers of
/// sizes.
pub fn apart(contenders: &[Standing]) -> Option<Separability> {
    let first = contenders.first().filter(|_| contenders.len() > 1)?;
    let draws = first.effects.ncols();
    if draws == 0 || contenders.iter().any(|one| one.effects.ncols() != draws) {
        return None;
    }
    let lengths = |one: &Standing| one.effects.column_iter().map(|e| e.norm()).collect();
    let effects: Vec<DMatrix<f64>> = contenders.iter().map(|one| one.effects.clone()).collect();
    let columns: Vec<_> = effects.iter().flat_map(|e| e.column_iter()).collect();
    let all = DMatrix::from_columns(&columns);
    // What each leaves of all effects, then by effect.
    let by_rival: Vec<Vec<f64>> = contenders
        .iter()
        .map(|rival| left(&all, rival.variants.iter().cloned()))
        .collect();
    let of = |a: usize| -> Vec<Vec<f64>> {
        let own = |left: &Vec<f64>| left[a * draws..(a + 1) * draws].to_vec();
        by_rival.iter().map(own).collect()
    };
    let stays = |own: &Standing| -> Vec<bool> {
        let rivals = contenders.iter();
        rivals
            .map(|rival| !rival.repeats && own.keeps(&rival.variants))
            .collect()
    };
    Some(Separability {
        left: (0..contenders.len()).map(of).collect(),
        stays: contenders.iter().map(stays).collect(),
        whole: contenders.iter().map(lengths).collect(),
    })
}

impl Separability {
    /// Whether two explanations say the same here.
    pub fn alike(&self, a: usize, b: usize) -> bool {
        self.left[a][b][0] <= SAME * self.whole[a][0]
            && self.left[b][a][0] <= SAME * self.whole[b][0]
    }

    /// Separability of the two that are most alike, at their most probable sizes.
    pub fn least(&self) -> f64 {
        let pairs = (0..self.left.len()).flat_map(|a| (0..a).flat_map(move |b| [(a, b), (b, a)]));
        pairs
            .map(|(a, b)| self.left[a][b][0])
            .fold(f64::INFINITY, f64::min)
    }

    /// What the measurement is worth with which explanations are as far apart as this, and `before` it as far as that. Of each,
    /// `probabilities` has the posterior one, `classes` a number, which those share that no measurement tells apart and that are
    /// not asked to be, and `outside` the probability that something comes to stand beside it that is none of them ([`doubt`]).
    pub fn worth(
        &self,
        before: &Separability,
        probabilities: &[f64],
        classes: &[usize],
        outside: &[f64],
    ) -> Worth {
        let mut kappa = f64::INFINITY;
        let (mut resolved, mut whole) = (0.0, 0.0);
        for a in 0..self.left.len() {
            let mut doubts = vec![outside[a]; self.whole[a].len()];
            for b in (0..self.left.len()).filter(|b| classes[a] != classes[*b]) {
                kappa = kappa.min(self.left[a][b][0]);
                let odds = log_odds(probabilities[a], probabilities[b]);
                let kappas = self.left[a][b].iter().zip(&before.left[a][b]);
                for (doubt, (after, before)) in doubts.iter_mut().zip(kappas) {
                    *doubt += if self.stays[a][b] {
                        1.0
                    } else {
                        1.0 - decided(odds, after * after - before * before)
                    };
                }
            }
            let sure: f64 = doubts.iter().map(|doubt| (1.0 - doubt).max(0.0)).sum();
            resolved += probabilities[a] * sure / doubts.len() as f64;
            whole += probabilities[a];
        }
        Worth {
            kappa,
            resolved: if whole > 0.0 { resolved / whole } else { 0.0 },
            repeats: match kappa > NOTHING {
                true => (SEPARATED / kappa).powi(2).max(1.0),
                false => f64::INFINITY,
            },
        }
    }
}

/// Probability that an explanation which is not in the list comes to stand beside one of it, if this is the
/// truth: from what it leaves of it in the recording and in the longer one. That it is not in the list is
/// either by what it leaves, or by chance; then at least it was left out.
pub fn doubt(before: f64, after: f64) -> f64 {
    let by_what_is_left = decided(0.0, after * after);
    let left_out = match after > before {
        true => decided(alone(), after * after - before * before),
        false => 0.0,
    };
    1.0 - by_what_is_left.max(left_out)
}

/// Log odds of a name that stands alone.
fn alone() -> f64 {
    libm::log(ALONE / (1.0 - ALONE))
}

/// Finite even where one of both is as good as excluded.
fn log_odds(a: f64, b: f64) -> f64 {
    const LEAST: f64 = 1e-4;
    libm::log(a.max(LEAST) / b.max(LEAST))
}

/// Probability that the truth comes to stand alone, from its log odds and what κ² gains.
fn decided(odds: f64, gain: f64) -> f64 {
    reached(odds, gain, alone())
}

#[cfg(test)]
mod tests {
    use super::super::fixture::Tumble;
    use super::*;

    /// Twelve positions in each mount: K2 and encoder eccentricity (1/rev cosine), seen beside the baseline.
    fn design(mounts: &[f64]) -> [DMatrix<f64>; 2] {
        let tumble = Tumble::new(12, mounts);
        let effects = [
            tumble.column(|a, _| a.sin().powi(2)),
            tumble.column(|a, h| a.cos() * h.cos()),
        ];
        let baseline = tumble.baseline();
        effects.map(|effect| baseline.project(&DMatrix::from_columns(&[effect])))
    }

    fn standing(column: &DMatrix<f64>, sizes: &[f64]) -> Standing {
        Standing {
            effects: column * DMatrix::from_row_slice(1, sizes.len(), sizes),
            variants: vec![column.clone()],
            repeats: false,
        }
    }

    fn held(columns: &[DMatrix<f64>], sizes: &[f64]) -> Separability {
        let each = columns.iter().map(|column| standing(column, sizes));
        apart(&each.collect::<Vec<_>>()).unwrap()
    }

    fn worth(mounts: &[f64], sizes: &[f64], probabilities: [f64; 2]) -> Worth {
        let before = held(&design(&mounts[..1]), sizes);
        judged(
            &held(&design(mounts), sizes),
            &before,
            &probabilities,
            &[0, 1],
        )
    }

    fn judged(after: &Separability, before: &Separability, p: &[f64], classes: &[usize]) -> Worth {
        after.worth(before, p, classes, &vec![0.0; p.len()])
    }

    #[test]
    fn a_remount_separates_what_repetition_does_not() {
        let kappa = |mount: f64| worth(&[0.0, mount], &[1.0], [0.5, 0.5]).kappa;
        assert!(kappa(180.0) > kappa(90.0) && kappa(90.0) > kappa(45.0) && kappa(45.0) > 0.1);
        let again = worth(&[0.0, 0.0], &[1.0], [0.5, 0.5]);
        assert!(again.kappa < 1e-6 && again.repeats == f64::INFINITY && again.resolved < 1e-3);
        // Half of the rows turn their sign: with signals of ½cos 2α each, 24 rows and the fit of the
        // common part κ² = 24/8.
        assert!((kappa(180.0) - 3.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn a_size_that_is_hardly_known_promises_less() {
        let promised = |sizes: &[f64]| worth(&[0.0, 180.0], sizes, [0.5, 0.5]).resolved;
        assert!(promised(&[4.0]) > 0.95);
        assert!(promised(&[4.0, 0.5, 7.5]) < 0.7);
    }

    #[test]
    fn what_is_nearly_sure_needs_little_more() {
        let promised = |p: f64| worth(&[0.0, 180.0], &[1.6], [p, 1.0 - p]).resolved;
        assert!(promised(0.98) > 0.8 && promised(0.5) < 0.7);
    }

    #[test]
    fn a_rival_with_more_variants_is_nearer() {
        let [own, other] = design(&[0.0, 180.0]);
        let left = |variants: Vec<DMatrix<f64>>| {
            let rival = Standing {
                variants,
                ..standing(&other, &[5.0])
            };
            apart(&[standing(&own, &[5.0]), rival]).unwrap().left[0][1][0]
        };
        let mixed = &own + 0.05 * &other;
        assert!(left(vec![other.clone()]) > 5.0);
        assert!(left(vec![other.clone(), mixed]) < 1.0);
    }

    #[test]
    fn what_stays_on_the_list_by_rule_is_not_decided_against() {
        let [own, other] = design(&[0.0, 180.0]);
        // A rival that differs by a share of the other effect, with a size that leaves five standard deviations.
        let resolved = |share: f64, size: f64| {
            let rival = &own + &other * share;
            let columns = [own.clone(), rival];
            let before = held(&columns, &[0.01 * size]);
            let apart = held(&columns, &[size]);
            let worth = judged(&apart, &before, &[0.5, 0.5], &[0, 1]);
            (apart.left[0][1][0], worth.resolved)
        };
        let (kappa, promised) = resolved(0.5, 15.0);
        assert!(kappa > 8.0 && promised > 0.99, "{kappa} {promised}");
        // As far apart, but of a much stronger effect of which they share all but a trace.
        let (kappa, promised) = resolved(0.03, 60.0);
        assert!((4.0..8.0).contains(&kappa), "{kappa}");
        assert_eq!(promised, 0.0);
    }

    #[test]
    fn what_is_not_listed_may_come_to_stand_beside_it() {
        // Far away it does not; near, and no further away than before, it does; what was left out is likely
        // to stay out.
        assert!(doubt(6.0, 9.0) < 1e-3 && doubt(4.0, 3.0) > 0.4);
        assert!(doubt(2.0, 4.0) < doubt(4.0, 4.0));
    }

    #[test]
    fn one_class_is_not_asked_to_be_told_apart() {
        let [own, other] = design(&[0.0, 180.0]);
        let three = [own.clone(), -&own, other];
        let apart = held(&three, &[4.0]);
        assert!(apart.alike(0, 1) && !apart.alike(0, 2));
        let [own, other] = design(&[0.0]);
        let before = held(&[own.clone(), -&own, other], &[4.0]);
        let resolved =
            |classes: &[usize]| judged(&apart, &before, &[0.3, 0.3, 0.4], classes).resolved;
        assert!(resolved(&[0, 1, 2]) < 0.5 && resolved(&[0, 0, 2]) > 0.9);
    }
}
