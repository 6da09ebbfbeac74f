//! The truth of a case, and its seal.

use std::collections::BTreeMap;

use rand::RngExt;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::effect::{Concealed, Physics};
use super::files::outputs;
use super::names::{Accepted, names, share_a_name};
use super::random::{Stream, source};
use super::scenario::{Class, Drawn, NoiseKnowledge};
use super::schedule::Campaign;
use super::simulate::{Readings, duration, simulate};
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
    /// The rig or instrument.
    pub bench: String,
    /// What kind of case it is.
    pub class: Class,
    /// How the noise is claimed.
    pub noise: NoiseKnowledge,
    /// How it behaves.
    pub noise_form: String,
    /// Root mean square of the noise of a row of the fresh recording, for each equation, in units of the recording.
    pub sigma: Vec<f64>,
    /// Names of outputs that belong to an axis each; empty where there is one axis.
    pub outputs: Vec<String>,
    /// What is concealed.
    pub effects: Vec<TrueEffect>,
    /// SHA-256 of the other files of the case.
    pub files: BTreeMap<String, String>,
}

/// The format that this version writes.
pub(super) const FORMAT: &str = "gumption truth 2";

/// One concealed effect.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TrueEffect {
    /// What it is.
    pub physics: String,
    /// How it looks.
    pub look: String,
    /// Its size: a fraction of full scale per unit of what it follows, or radians.
    pub size: f64,
    /// Largest minus smallest of what it leaves in the residuals of the declared model, in the unit of the output on which
    /// it shows most.
    #[serde(default)]
    pub in_residuals: f64,
    /// Whether a diagnosis can be expected to name it.
    pub nameable: bool,
    /// Names that are right.
    pub names: Vec<Accepted>,
    /// Names of other effects that would have given the same recording.
    pub aliases: Vec<Accepted>,
    /// Visible strength λ: length of what it adds, in standard deviations.
    pub lambda: f64,
    /// What is left of λ beside the other effects of the case.
    pub lambda_beside: f64,
    /// Separability κ: what is left of `lambda_beside` after the nearest rival.
    pub kappa: f64,
    /// The nearest rivals with what they leave.
    pub rivals: Vec<(String, f64)>,
    /// Axes of the sensor on which it acts, from 0; empty where it acts on the rig.
    pub axes: Vec<usize>,
    /// When it happened, hours since power-on, where that is one moment of the recording.
    pub happened_h: Option<f64>,
    /// Whether it happens once, so that nobody can predict it.
    pub once: bool,
}

/// A rival of an effect.
pub(super) struct Known {
    pub name: String,
    /// Names that would be right for it.
    pub names: Vec<Accepted>,
    /// What it leaves of the effect.
    pub left: f64,
}

/// How many rivals the truth lists.
const LISTED: usize = 4;
/// Rivals that leave less than this share of an effect are the same in this recording.
pub const ALIAS: f64 = 0.05;

impl TrueEffect {
    /// With κ and what else would have given the same recording.
    pub(super) fn beside(mut self, mut rivals: Vec<Known>) -> TrueEffect {
        rivals.sort_by(|a, b| a.left.total_cmp(&b.left));
        self.kappa = rivals
            .first()
            .map_or(self.lambda_beside, |rival| rival.left);
        let same = rivals
            .iter()
            .filter(|rival| rival.left < ALIAS * self.lambda_beside);
        self.aliases = same.flat_map(|rival| rival.names.clone()).collect();
        let nearest = rivals.into_iter().take(LISTED);
        self.rivals = nearest.map(|rival| (rival.name, rival.left)).collect();
        self
    }
}

impl Truth {
    /// The truth of a drawn case of a rig, without its files.
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
        let rig = drawn.scenario.rig;
        let fresh = simulate(&drawn.setup, Campaign::HeldOut, &[], Readings::Ideal);
        let times: Vec<f64> = fresh.iter().map(|row| row.time).collect();
        let sigma = drawn.setup.noise.rms(&times, rig.samples() as f64) * rig.sensitivity();
        let outputs = outputs(rig).map(|(name, ..)| name.to_owned());
        Truth {
            format: FORMAT.into(),
            salt: salt.into(),
            seed: drawn.setup.seed,
            scenario: drawn.scenario.name(),
            bench: rig.name().into(),
            class: drawn.scenario.class,
            noise: drawn.knowledge,
            noise_form: format!("{:?}", drawn.setup.noise),
            sigma: vec![sigma; rig.axes()],
            outputs: outputs.filter(|_| rig.axes() > 1).collect(),
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
    let known: Vec<Physics> = others.iter().map(|other| other.physics).collect();
    // What bears the same name is no rival.
    let rivals = visible.rivals(effect.physics, &trace, &rest).into_iter();
    let rivals = rivals.filter(|rival| {
        !known.contains(&rival.physics) && !share_a_name(rival.physics, effect.physics)
    });
    let happened_h = (effect.physics == Physics::Knock).then(|| {
        let end = duration(drawn.setup.rig, Campaign::Calibration, drawn.setup.seed);
        end * (0.12 + 0.76 * effect.shape.moment) / 3600.0
    });
    let gains = &effect.shape.gains[..drawn.setup.rig.axes()];
    let axes = (0..gains.len()).filter(|axis| gains[*axis] != 0.0);
    TrueEffect {
        physics: effect.physics.name(),
        look: format!("{:?}", effect.shape),
        size: effect.size,
        in_residuals: visible.height(effect, others) * drawn.setup.rig.sensitivity(),
        nameable: effect.physics.nameable() && drawn.scenario.class != Class::Hidden,
        names: if drawn.scenario.class == Class::Hidden {
            vec![Accepted {
                id: "unrecorded-temperature".into(),
                along: Vec::new(),
            }]
        } else {
            names(effect.physics)
        },
        lambda: strength,
        lambda_beside: visible.beside(&trace, &rest),
        axes: if effect.physics.of_the_rig() {
            Vec::new()
        } else {
            axes.collect()
        },
        happened_h,
        once: matches!(effect.physics, Physics::Knock | Physics::SwappedLabel),
        ..TrueEffect::default()
    }
    .beside(
        rivals
            .map(|rival| Known {
                name: rival.physics.name(),
                names: names(rival.physics),
                left: rival.left,
            })
            .collect(),
    )
}

/// Salt from a seed and from the moment, so that the same seed gives the same case but not a truth
/// that can be guessed. Without a moment the salt follows from the seed alone.
pub(super) fn salt(seed: u64, entropy: u64) -> String {
    let mut random = source(seed ^ entropy, Stream::Salt, entropy);
    format!("{:032x}", random.random::<u128>())
}

/// SHA-256 of a text or a file, as 64 hexadecimal digits.
pub fn seal(content: impl AsRef<[u8]>) -> String {
    Sha256::digest(content)
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
