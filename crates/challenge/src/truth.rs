//! The truth of a case, and its seal.

use std::collections::BTreeMap;

use rand::RngExt;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::effect::{Concealed, Physics, Shape};
use super::names::share_a_name;
use super::random::{Stream, source};
use super::rig::Rig;
use super::scenario::{Class, Drawn, NoiseKnowledge};
use super::schedule::Campaign;
use super::simulate::duration;
use super::strength::Visible;

/// What `truth.json` holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Name and version of this format.
    pub format: String,
    /// Random, so that nobody finds the truth by trying.
    pub salt: String,
    /// The seed of the challenge.
    pub seed: u64,
    /// The scenario by name.
    pub scenario: String,
    /// The rig.
    pub rig: Rig,
    /// What kind of case it is.
    pub class: Class,
    /// How the noise is claimed.
    pub noise: NoiseKnowledge,
    /// What is concealed.
    pub effects: Vec<TrueEffect>,
    /// SHA-256 of the other files of the case.
    pub files: BTreeMap<String, String>,
}

/// The format that this version writes.
const FORMAT: &str = "gumption truth 1";

/// One concealed effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrueEffect {
    /// What it is.
    pub physics: Physics,
    /// Its size: a fraction of full scale per unit of what it follows, or radians.
    pub size: f64,
    /// Its coefficient in units of the recording, where that is one number and not a matter of form.
    pub coefficient: Option<f64>,
    /// How it looks.
    pub shape: Shape,
    /// Whether a diagnosis can be expected to name it.
    pub nameable: bool,
    /// Visible strength λ: length of what it adds, in standard deviations.
    pub lambda: f64,
    /// What is left of λ beside the other effects of the case.
    pub lambda_beside: f64,
    /// Separability κ: what is left of `lambda_beside` after the nearest rival.
    pub kappa: f64,
    /// The nearest rivals with what they leave.
    pub rivals: Vec<(Physics, f64)>,
    /// Axes of the sensor on which it acts, from 0; empty where it acts on the rig.
    pub axes: Vec<usize>,
    /// When it happened, hours since power-on, for what happens once.
    pub happened_h: Option<f64>,
}

/// How many rivals the truth lists.
const LISTED: usize = 4;

impl Truth {
    /// The truth of a drawn case, without its files.
    pub(super) fn of(drawn: &Drawn, salt: &str) -> Truth {
        let visible = Visible::new(&drawn.setup);
        let all = drawn.concealed();
        let effects = drawn
            .effects
            .iter()
            .enumerate()
            .map(|(index, (effect, strength))| {
                let mut others = all.clone();
                others.remove(index);
                true_effect(drawn, &visible, effect, *strength, &others)
            })
            .collect();
        Truth {
            format: FORMAT.into(),
            salt: salt.into(),
            seed: drawn.setup.seed,
            scenario: drawn.scenario.name(),
            rig: drawn.scenario.rig,
            class: drawn.scenario.class,
            noise: drawn.knowledge,
            effects,
            files: BTreeMap::new(),
        }
    }

    /// The text of `truth.json`: what the seal is taken of.
    pub fn text(&self) -> String {
        // A struct of numbers and strings can always be written.
        serde_json::to_string_pretty(self).map_or_else(|_| String::new(), |text| text + "\n")
    }
}

fn true_effect(
    drawn: &Drawn,
    visible: &Visible<'_>,
    effect: &Concealed,
    strength: f64,
    others: &[Concealed],
) -> TrueEffect {
    let trace = visible.trace_beside(effect, others);
    let rest: Vec<_> = others
        .iter()
        .map(|other| visible.trace(&[*other]))
        .collect();
    let beside = visible.beside(&trace, &rest);
    let known: Vec<Physics> = others.iter().map(|other| other.physics).collect();
    let mut rivals = visible.rivals(effect.physics, &trace, &rest);
    // What bears the same name is no rival.
    rivals.retain(|rival| {
        !known.contains(&rival.physics) && !share_a_name(rival.physics, effect.physics)
    });
    let happened_h = (effect.physics == Physics::Knock).then(|| {
        let end = duration(drawn.setup.rig, Campaign::Calibration, drawn.setup.seed);
        end * (0.12 + 0.76 * effect.shape.moment) / 3600.0
    });
    let gains = &effect.shape.gains[..drawn.setup.rig.axes()];
    let axes = (0..gains.len()).filter(|axis| gains[*axis] != 0.0);
    TrueEffect {
        physics: effect.physics,
        size: effect.size,
        coefficient: coefficient(drawn.setup.rig, effect),
        shape: effect.shape,
        nameable: effect.physics.nameable() && drawn.scenario.class != Class::Hidden,
        lambda: strength,
        lambda_beside: beside,
        kappa: rivals.first().map_or(beside, |rival| rival.left),
        rivals: rivals
            .iter()
            .take(LISTED)
            .map(|r| (r.physics, r.left))
            .collect(),
        axes: if effect.physics.of_the_rig() {
            Vec::new()
        } else {
            axes.collect()
        },
        happened_h,
    }
}

/// Output per volt of a single sensor.
fn coefficient(rig: Rig, effect: &Concealed) -> Option<f64> {
    (effect.physics == Physics::Supply && rig.axes() == 1)
        .then(|| effect.size * effect.shape.gains[0] * rig.full_scale() * rig.sensitivity())
}

/// Salt from a seed and from the moment, so that the same seed gives the same case but not a truth
/// that can be guessed. Without a moment the salt follows from the seed alone.
pub(super) fn salt(seed: u64, entropy: u64) -> String {
    let mut random = source(seed ^ entropy, Stream::Salt, entropy);
    format!("{:032x}", random.random::<u128>())
}

/// SHA-256 of a text, as 64 hexadecimal digits.
pub fn seal(text: &str) -> String {
    Sha256::digest(text.as_bytes())
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_seal_is_sha_256() {
        // FIPS 180-4, the example of one block.
        assert_eq!(
            seal("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }

    #[test]
    fn salt_depends_on_both() {
        assert_eq!(salt(1, 0), salt(1, 0));
        assert_ne!(salt(1, 0), salt(1, 1));
        assert_ne!(salt(1, 0), salt(2, 0));
    }
}
