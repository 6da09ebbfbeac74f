//! A measurement that follows the calibration in the same life of the device: the one that a diagnosis asks
//! for to tell its explanations apart.

use std::fmt;
use std::str::FromStr;

use super::rig::Rig;
use super::world::Pose;

/// What is measured after the calibration, run by run as there but for what is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Further {
    /// The same.
    Again,
    /// The last row first.
    Reversed,
    /// With the sensor turned in its mount.
    Mount(Mount),
    /// Half way between the values of a setting.
    Between(Setting),
}

/// A mount of the dividing head other than the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Mount {
    eighths: usize,
}

/// What a rig is set to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Setting {
    /// Angle of the dividing head.
    Head,
    /// Angle about the vertical axis of the stand.
    Azimuth,
    /// Angle about its other axis.
    Elevation,
    /// Rate of the table.
    Rate,
}

/// Degrees from one mount to the next.
const EIGHTH: usize = 45;

impl Mount {
    /// The mount at an angle in degrees: a multiple of 45 below 360, and not 0.
    pub fn at(degrees: f64) -> Option<Mount> {
        let eighths = degrees / EIGHTH as f64;
        let whole = eighths.fract() == 0.0 && (1.0..8.0).contains(&eighths);
        whole.then_some(Mount {
            eighths: eighths as usize,
        })
    }

    /// Its number in a pose.
    pub(super) fn number(self) -> usize {
        self.eighths
    }
}

impl Setting {
    const ALL: [Setting; 4] = [
        Setting::Head,
        Setting::Azimuth,
        Setting::Elevation,
        Setting::Rate,
    ];

    /// The column of the recording.
    fn column(self) -> &'static str {
        match self {
            Setting::Head => "head",
            Setting::Azimuth => "azimuth",
            Setting::Elevation => "elevation",
            Setting::Rate => "rate",
        }
    }

    /// Whether a calibration goes all the way round.
    pub(super) fn is_circle(self) -> bool {
        matches!(self, Setting::Head | Setting::Azimuth)
    }

    /// Its place in a pose.
    pub(super) fn of(self, pose: &mut Pose) -> &mut f64 {
        match self {
            Setting::Head | Setting::Azimuth => &mut pose.outer,
            Setting::Elevation => &mut pose.inner,
            Setting::Rate => &mut pose.rate,
        }
    }
}

impl Further {
    /// Whether a rig can do it.
    pub fn is_possible(self, rig: Rig) -> bool {
        let head = matches!(rig, Rig::Tumble | Rig::Remount);
        match self {
            Further::Again | Further::Reversed => true,
            Further::Mount(_) | Further::Between(Setting::Head) => head,
            Further::Between(Setting::Azimuth | Setting::Elevation) => rig == Rig::Triad,
            Further::Between(Setting::Rate) => rig == Rig::RateTable,
        }
    }

    /// What is said of it in an experiment.
    pub(super) fn in_words(self) -> String {
        match self {
            Further::Again => "the same once more".to_owned(),
            Further::Reversed => "the same in reversed order, the other way round".to_owned(),
            Further::Mount(mount) => format!(
                "the same with the sensor mounted at {}°",
                EIGHTH * mount.eighths
            ),
            Further::Between(setting) => {
                format!(
                    "the same with {} half way between its values",
                    setting.column()
                )
            }
        }
    }
}

impl fmt::Display for Further {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Further::Again => f.write_str("again"),
            Further::Reversed => f.write_str("reversed"),
            Further::Mount(mount) => write!(f, "mount={}", EIGHTH * mount.eighths),
            Further::Between(setting) => write!(f, "{} between", setting.column()),
        }
    }
}

impl FromStr for Further {
    type Err = String;

    fn from_str(text: &str) -> Result<Further, String> {
        let unknown = || {
            format!(
                "`{text}` is no further measurement: write again, reversed, \"mount=90\" (a multiple of \
                 {EIGHTH}), \"head between\", \"azimuth between\", \"elevation between\" or \"rate between\""
            )
        };
        let setting = |name: &str| Setting::ALL.into_iter().find(|s| s.column() == name.trim());
        match text.trim() {
            "again" => Ok(Further::Again),
            "reversed" => Ok(Further::Reversed),
            other => {
                let mount = other.strip_prefix("mount").and_then(|rest| {
                    let angle = rest.trim_start().strip_prefix('=')?.trim();
                    Mount::at(angle.trim_end_matches('°').trim_end().parse().ok()?)
                });
                let between = || other.strip_suffix("between").and_then(setting);
                mount
                    .map(Further::Mount)
                    .or_else(|| between().map(Further::Between))
                    .ok_or_else(unknown)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_further_measurement_are_read_as_they_are_written() {
        for word in [
            "again",
            "reversed",
            "mount=45",
            "mount=180",
            "head between",
            "rate between",
        ] {
            assert_eq!(word.parse::<Further>().unwrap().to_string(), word);
        }
        assert_eq!("mount = 90 °".parse::<Further>(), "mount=90".parse());
        for wrong in [
            "mount=30",
            "mount=360",
            "mount=0",
            "mount",
            "table between",
            "",
        ] {
            assert!(wrong.parse::<Further>().is_err(), "{wrong}");
        }
    }
}
