//! The rigs: how they point the sensor, what the sensor is, and the textbook model that the case
//! declares.

use serde::{Deserialize, Serialize};

use super::noise::NoiseLaw;
use super::world::{Input, Matrix, Pose, Vector, about_x, about_y, about_z, apply, product};

/// A rig with a sensor on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rig {
    /// Quartz accelerometer on a dividing head, one mount, three runs of twelve positions.
    Tumble,
    /// The same with two mounts at right angles, four runs.
    Remount,
    /// Triad of MEMS accelerometers on a stand with two axes, eighteen orientations twice.
    Triad,
    /// Triad of MEMS gyroscopes on a rate table, six mounts, eight rates, three table angles.
    RateTable,
}

impl Rig {
    /// All rigs.
    pub const ALL: [Rig; 4] = [Rig::Tumble, Rig::Remount, Rig::Triad, Rig::RateTable];

    /// The name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Rig::Tumble => "tumble",
            Rig::Remount => "remount",
            Rig::Triad => "triad",
            Rig::RateTable => "rate-table",
        }
    }

    /// Number of runs of a calibration.
    pub(super) fn runs(self) -> usize {
        match self {
            Rig::Tumble => 3,
            Rig::Remount => 4,
            Rig::Triad => 2,
            Rig::RateTable => 6,
        }
    }

    /// Number of axes that are recorded.
    pub(super) fn axes(self) -> usize {
        match self {
            Rig::Tumble | Rig::Remount => 1,
            Rig::Triad | Rig::RateTable => 3,
        }
    }

    /// Input that counts as full scale: multiples of g, or degrees per second.
    pub(super) fn full_scale(self) -> f64 {
        match self {
            Rig::RateTable => 160.0,
            _ => 1.0,
        }
    }

    /// Output per unit of input: mV per g for the quartz accelerometer over its resistor; the MEMS
    /// parts state their readings in the unit of the input.
    pub(super) fn sensitivity(self) -> f64 {
        match self {
            Rig::Tumble | Rig::Remount => 1300.0,
            _ => 1.0,
        }
    }

    /// Step of the readout, in units of the input.
    pub(super) fn lattice(self) -> f64 {
        match self {
            Rig::Tumble | Rig::Remount => 1e-7,
            Rig::Triad => 2e-5,
            Rig::RateTable => 1e-3,
        }
    }

    /// Samples in a row of the recording.
    pub(super) fn samples(self) -> usize {
        match self {
            Rig::RateTable => 20,
            _ => 60,
        }
    }

    /// Noise in units of the input: what a data sheet would state.
    pub(super) fn noise(self) -> NoiseLaw {
        let (of_average, walk) = match self {
            Rig::Tumble | Rig::Remount => (1e-6, 0.4e-6),
            Rig::Triad => (2e-5, 0.6e-5),
            Rig::RateTable => (1.2e-3, 0.3e-3),
        };
        NoiseLaw::plain(of_average * libm::sqrt(self.samples() as f64), walk)
    }

    /// The mount of the dividing head at a right angle to the first.
    pub(super) const SQUARE: usize = 2;

    /// Angle of a mount of the dividing head, radians: pins hold it at every eighth of a turn.
    pub(super) fn mount_angle(mount: usize) -> f64 {
        mount as f64 * std::f64::consts::FRAC_PI_4
    }

    /// Part of the squareness of the mounts that an angle of the head has in a mount: all of it at a right
    /// angle, as the declared model has it. With one mount there is nothing to be square to.
    pub(super) fn out_of_square(self, mount: usize) -> f64 {
        match self {
            Rig::Remount => libm::sin(Rig::mount_angle(mount)),
            _ => 0.0,
        }
    }

    /// What the sensor meets in a pose.
    pub(super) fn input(self, pose: &Pose) -> Input {
        let attitude = self.attitude(pose);
        Input {
            force: apply(&attitude, &[0.0, 0.0, 1.0]),
            rate: apply(&attitude, &[0.0, 0.0, pose.rate]),
            attitude,
        }
    }

    fn attitude(self, pose: &Pose) -> Matrix {
        use std::f64::consts::{FRAC_PI_2, PI};
        match self {
            // The head's axis points north; the input axis lies horizontal at zero.
            Rig::Tumble | Rig::Remount => {
                let alpha = pose.outer + Rig::mount_angle(pose.mount);
                let (s, c) = (libm::sin(alpha), libm::cos(alpha));
                [[c, 0.0, s], [-s, 0.0, c], [0.0, -1.0, 0.0]]
            }
            Rig::Triad => product(&about_z(-pose.outer), &about_y(pose.inner - FRAC_PI_2)),
            Rig::RateTable => {
                let mount = match pose.mount {
                    0 => about_x(0.0),
                    1 => about_x(PI),
                    2 => about_y(-FRAC_PI_2),
                    3 => about_y(FRAC_PI_2),
                    4 => about_x(FRAC_PI_2),
                    _ => about_x(-FRAC_PI_2),
                };
                product(&mount, &about_z(pose.table))
            }
        }
    }

    /// The table's axis in the sensor, for a mount: exactly ±1 and 0, as a protocol states it.
    pub(super) fn table_axis(mount: usize) -> Vector {
        let mut axis = [0.0; 3];
        axis[[2, 2, 0, 0, 1, 1][mount.min(5)]] = if mount.is_multiple_of(2) { 1.0 } else { -1.0 };
        axis
    }

    /// The input as the declared model has it: from commanded angles and rates alone.
    pub(super) fn declared_input(self, pose: &Pose) -> Vector {
        match self {
            Rig::RateTable => Rig::table_axis(pose.mount).map(|c| c * pose.rate),
            _ => self.input(pose).force,
        }
    }

    /// What multiplies the parameters of the declared model for one axis, in units of the input: it
    /// is linear in them, bias first.
    pub(super) fn declared_terms(self, pose: &Pose) -> Vec<f64> {
        let [x, y, z] = self.declared_input(pose);
        match self {
            Rig::Tumble => vec![1.0, x, y],
            // The second mount may be out of square.
            Rig::Remount => vec![1.0, x, y, y * self.out_of_square(pose.mount)],
            Rig::Triad | Rig::RateTable => vec![1.0, x, y, z],
        }
    }
}

impl std::str::FromStr for Rig {
    type Err = String;

    fn from_str(text: &str) -> Result<Rig, String> {
        Rig::ALL
            .into_iter()
            .find(|rig| rig.name() == text)
            .ok_or_else(|| {
                let names: Vec<&str> = Rig::ALL.iter().map(|rig| rig.name()).collect();
                format!("`{text}` is no rig: write {}", names.join(", "))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_force_at_rest_is_one_g() {
        for rig in Rig::ALL {
            let pose = Pose {
                outer: 0.7,
                inner: 0.4,
                table: 1.9,
                mount: 1,
                rate: 20.0,
            };
            let input = rig.input(&pose);
            let length: f64 = input.force.iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_tumble_follows_sine_and_cosine() {
        let pose = Pose {
            outer: 0.5,
            mount: Rig::SQUARE,
            ..Pose::default()
        };
        let force = Rig::Remount.input(&pose).force;
        let alpha = 0.5 + std::f64::consts::FRAC_PI_2;
        assert!((force[0] - alpha.sin()).abs() < 1e-15 && (force[1] - alpha.cos()).abs() < 1e-15);
    }

    #[test]
    fn the_stand_points_by_azimuth_and_elevation() {
        let (azimuth, elevation) = (0.8_f64, -0.3_f64);
        let pose = Pose {
            outer: azimuth,
            inner: elevation,
            ..Pose::default()
        };
        let expected = [
            elevation.cos() * azimuth.cos(),
            elevation.cos() * azimuth.sin(),
            elevation.sin(),
        ];
        for (x, y) in Rig::Triad.input(&pose).force.into_iter().zip(expected) {
            assert!((x - y).abs() < 1e-15);
        }
    }

    #[test]
    fn mounts_put_the_table_axis_where_the_protocol_says() {
        for mount in 0..6 {
            let pose = Pose {
                mount,
                rate: 3.0,
                table: 0.9,
                ..Pose::default()
            };
            let input = Rig::RateTable.input(&pose);
            for (x, y) in input
                .rate
                .into_iter()
                .zip(Rig::RateTable.declared_input(&pose))
            {
                assert!((x - y).abs() < 1e-14);
            }
        }
    }
}
