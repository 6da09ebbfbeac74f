//! How strong a concealed effect is in a recording, and how far from its rivals: from twin runs that
//! differ in nothing but the effect.
//!
//! Twins have the same room, the same moves and neither noise nor digits. Their difference, whitened
//! by the true covariance of the noise and projected on what the declared parameters cannot absorb,
//! has the length λ. What is left of it when a rival may take all it can is κ for that rival. Rivals
//! are twins of every other effect that can occur on the rig, at several time constants and moments,
//! with free shares of the axes and free phase.

use nalgebra::DVector;

use super::effect::{Concealed, Member, Physics, Shape};
use super::geometry::{Geometry, height, left, span};
use super::schedule::Campaign;
use super::simulate::{Readings, Setup, simulate};
use super::world::Row;

/// The geometry of a campaign: what noise and declared parameters leave visible.
pub(super) struct Visible<'a> {
    setup: &'a Setup,
    without: Vec<Row>,
    /// Of one axis.
    geometry: Geometry,
}

/// A rival, and how much of an effect it leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rival {
    pub physics: Physics,
    /// κ for this rival.
    pub left: f64,
}

impl<'a> Visible<'a> {
    /// The geometry of the calibration campaign of a setup.
    pub(super) fn new(setup: &'a Setup) -> Visible<'a> {
        let without = simulate(setup, Campaign::Calibration, &[], Readings::Ideal);
        let times: Vec<f64> = without.iter().map(|row| row.time).collect();
        let covariance = setup.noise.covariance(&times, setup.rig.samples() as f64);
        let terms: Vec<Vec<f64>> = without
            .iter()
            .map(|row| setup.rig.declared_terms(&row.pose))
            .collect();
        let columns = terms.first().map_or(0, Vec::len);
        let tangent: Vec<DVector<f64>> = (0..columns)
            .map(|j| DVector::from_fn(terms.len(), |i, _| terms[i][j]))
            .collect();
        Visible {
            setup,
            without,
            geometry: Geometry::new(covariance, &tangent),
        }
    }

    /// What the effects add to the readings that is visible: axis after axis.
    pub(super) fn trace(&self, effects: &[Concealed]) -> DVector<f64> {
        self.differences(effects, &[])
    }

    /// What an effect adds when the others are there already.
    pub(super) fn trace_beside(&self, effect: &Concealed, others: &[Concealed]) -> DVector<f64> {
        let mut all = others.to_vec();
        all.push(*effect);
        self.differences(&all, others)
    }

    /// What an effect adds to the readings when the others are there already, as it is: rows of the
    /// recording for each axis, one axis after the other.
    pub(super) fn added(&self, effect: &Concealed, others: &[Concealed]) -> DVector<f64> {
        let mut all = others.to_vec();
        all.push(*effect);
        self.raw(&all, others)
    }

    /// Largest minus smallest of what an effect leaves in the residuals when the others are there already, on the axis
    /// where that is most.
    pub(super) fn height(&self, effect: &Concealed, others: &[Concealed]) -> f64 {
        let (added, rows) = (self.added(effect, others), self.without.len());
        let axes = (0..self.setup.rig.axes()).map(|axis| {
            let own = added.rows(axis * rows, rows).clone_owned();
            height(&self.geometry.residuals(&own))
        });
        axes.fold(0.0, f64::max)
    }

    fn differences(&self, with: &[Concealed], without: &[Concealed]) -> DVector<f64> {
        let mut trace = self.raw(with, without);
        let rows = self.without.len();
        for axis in 0..self.setup.rig.axes() {
            let mut own = trace.rows_mut(axis * rows, rows);
            let visible = self.geometry.visible(&own.clone_owned());
            own.copy_from(&visible);
        }
        trace
    }

    fn raw(&self, with: &[Concealed], without: &[Concealed]) -> DVector<f64> {
        let run = |effects: &[Concealed]| {
            simulate(self.setup, Campaign::Calibration, effects, Readings::Ideal)
        };
        let with = run(with);
        let base = if without.is_empty() {
            self.without.clone()
        } else {
            run(without)
        };
        let axes = 0..self.setup.rig.axes();
        let values = axes.flat_map(|axis| {
            let pairs = with.iter().zip(&base);
            pairs.map(move |(w, b)| self.residual(w, axis) - self.residual(b, axis))
        });
        DVector::from_vec(values.collect())
    }

    /// Reading less the declared input: a wrong label counts as well as a wrong reading.
    fn residual(&self, row: &Row, axis: usize) -> f64 {
        row.output[axis] - self.setup.rig.declared_input(&row.pose)[axis]
    }

    /// The size at which an effect has the strength `target`, and the strength it really has: some
    /// cannot be made strong within `limit`, because the declared parameters absorb them.
    pub(super) fn sized(&self, mut effect: Concealed, target: f64, limit: f64) -> (Concealed, f64) {
        let mut strength = self.trace(&[effect]).norm();
        for _ in 0..6 {
            if !effect.physics.scalable() || strength <= 0.0 {
                break;
            }
            let ratio = (target / strength).clamp(1e-3, 1e3);
            if (ratio - 1.0).abs() < 0.005 {
                break;
            }
            effect.size = (effect.size * ratio).max(-limit).min(limit);
            strength = self.trace(&[effect]).norm();
        }
        (effect, strength)
    }

    /// Length of what is left of a trace beside others that are known to be there.
    pub(super) fn beside(&self, trace: &DVector<f64>, others: &[DVector<f64>]) -> f64 {
        left(trace, &span(others, trace.len())).norm()
    }

    /// What every rival leaves of a trace beside others that are known to be there, the nearest first.
    pub(super) fn rivals(
        &self,
        physics: Physics,
        trace: &DVector<f64>,
        others: &[DVector<f64>],
    ) -> Vec<Rival> {
        let candidates = Physics::ALL
            .iter()
            .copied()
            .filter(|p| *p != physics && p.occurs(self.setup.rig) && *p != Physics::SwappedLabel);
        let mut rivals: Vec<Rival> = candidates
            .map(|rival| Rival {
                physics: rival,
                left: self.left_by(rival, trace, others),
            })
            .collect();
        rivals.sort_by(|a, b| a.left.total_cmp(&b.left));
        rivals
    }

    fn left_by(&self, rival: Physics, trace: &DVector<f64>, others: &[DVector<f64>]) -> f64 {
        let depends = rival.depends();
        let paces: &[f64] = if depends == Member::Pace {
            &[0.1, 0.35, 0.5, 0.65, 0.9]
        } else {
            &[0.5]
        };
        let moments: &[f64] = if depends == Member::Moment {
            &[0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95]
        } else {
            &[0.5]
        };
        let phases: &[f64] = if depends == Member::Phase {
            &[0.0, std::f64::consts::FRAC_PI_2]
        } else {
            &[0.0]
        };
        let mut least = f64::INFINITY;
        for &pace in paces {
            for &moment in moments {
                let mut columns = others.to_vec();
                for &phase in phases {
                    let shape = Shape {
                        gains: [1.0; 3],
                        phase,
                        pace,
                        moment,
                    };
                    let effect = Concealed {
                        physics: rival,
                        size: rival.usual_size(),
                        shape,
                    };
                    columns.extend(self.by_axis(&self.trace(&[effect]), rival));
                }
                least = least.min(left(trace, &span(&columns, trace.len())).norm());
            }
        }
        least
    }

    /// A column for each axis where the axes are free, one for all where the rig ties them.
    fn by_axis(&self, trace: &DVector<f64>, rival: Physics) -> Vec<DVector<f64>> {
        if rival.of_the_rig() {
            return vec![trace.clone()];
        }
        let rows = trace.len() / self.setup.rig.axes();
        (0..self.setup.rig.axes())
            .map(|axis| {
                let mut column = DVector::zeros(trace.len());
                let range = trace.rows(axis * rows, rows);
                column.rows_mut(axis * rows, rows).copy_from(&range);
                column
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Rig;

    fn setup(rig: Rig) -> Setup {
        Setup {
            rig,
            seed: 11,
            noise: rig.noise(),
        }
    }

    fn effect(physics: Physics) -> Concealed {
        let shape = Shape {
            gains: [1.0, 0.0, 0.0],
            phase: 0.4,
            pace: 0.3,
            moment: 0.4,
        };
        Concealed {
            physics,
            size: physics.usual_size(),
            shape,
        }
    }

    #[test]
    fn what_the_declared_model_holds_is_invisible() {
        // A magnetic field, seen by a sensor that tumbles in it, is a misalignment: only where the
        // angle comes back in another mount could it differ, and it does not.
        let setup = setup(Rig::Remount);
        let visible = Visible::new(&setup);
        let magnetic = visible.trace(&[effect(Physics::Magnetic)]).norm();
        let curved = visible.trace(&[effect(Physics::SecondOrder)]).norm();
        assert!(magnetic < 1e-3 * curved, "{magnetic} {curved}");
    }

    #[test]
    fn sizes_reach_the_strength_asked_for() {
        for (rig, physics) in [
            (Rig::Tumble, Physics::SecondOrder),
            (Rig::Remount, Physics::Backlash),
            (Rig::Triad, Physics::ElevationEccentricity),
            (Rig::RateTable, Physics::Saturation),
        ] {
            let setup = setup(rig);
            let (sized, strength) = Visible::new(&setup).sized(effect(physics), 9.0, 0.05);
            assert!(
                (strength - 9.0).abs() < 0.1,
                "{physics:?}: {strength}, {sized:?}"
            );
        }
    }

    #[test]
    fn exact_aliases_leave_nothing() {
        // s² + c² = 1: in a single-axis tumble a cross-axis square is a negative square.
        let setup = setup(Rig::Tumble);
        let visible = Visible::new(&setup);
        let (sized, _) = visible.sized(effect(Physics::CrossSquare), 20.0, 0.05);
        let trace = visible.trace(&[sized]);
        let rivals = visible.rivals(Physics::CrossSquare, &trace, &[]);
        let square = rivals.iter().find(|r| r.physics == Physics::SecondOrder);
        // Not quite nothing, because the simulated square is not quite a square.
        assert!(square.is_some_and(|r| r.left < 1.0), "{square:?}");
    }

    #[test]
    fn a_second_mount_separates_the_third_order_from_an_elliptic_circle() {
        let left = |rig| {
            let setup = setup(rig);
            let visible = Visible::new(&setup);
            let (sized, _) = visible.sized(effect(Physics::ThirdOrder), 20.0, 0.05);
            visible.left_by(Physics::Ellipticity, &visible.trace(&[sized]), &[])
        };
        assert!(left(Rig::Tumble) < 2.0);
        assert!(left(Rig::Remount) > 8.0);
    }
}
