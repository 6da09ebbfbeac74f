//! What the grader reads of a diagnosis: a part of what `gumption diagnose --json` prints.

use serde::Deserialize;

/// A diagnosis.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Answer {
    /// `none` or `agrees`, else something was noticed.
    pub verdict: String,
    /// Effects that were found.
    #[serde(default)]
    pub effects: Vec<AnsweredEffect>,
    /// The declared model.
    pub before: Option<Quality>,
    /// The model with the effects in it.
    pub after: Option<Quality>,
    /// The prediction of the held-out recording.
    #[serde(default)]
    pub held_out: Option<HeldOut>,
}

impl Answer {
    /// Whether it says that model and recording disagree.
    pub fn has_noticed(&self) -> bool {
        !matches!(self.verdict.as_str(), "none" | "agrees")
    }
}

/// How well the held-out recording is predicted.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct HeldOut {
    /// By the declared model.
    pub before: Prediction,
    /// With the effects.
    pub after: Option<Prediction>,
}

/// A prediction against what was observed.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Prediction {
    /// Root mean square of the errors of each output.
    pub rms: Vec<f64>,
}

/// One effect that was found.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct AnsweredEffect {
    /// What is said of it.
    pub state: State,
    /// Names, most probable first.
    #[serde(default)]
    pub named: Vec<Name>,
    /// How large it is, as a reader of the residuals says: their largest minus their smallest, as far as it makes them.
    #[serde(default)]
    pub in_residuals: Option<f64>,
}

/// What is said of an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum State {
    /// It has one name, and a departure from its shape would have been seen.
    Identified,
    /// It has one name, and is too weak to show a departure from its shape.
    #[serde(alias = "like")]
    ActsLike,
    /// It has one of several names.
    #[serde(alias = "ambiguous")]
    OneOf,
    /// It has no name; names in the list are tentative.
    Unexplained,
}

/// A name that an effect may have.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Name {
    /// Stable identifier of the catalogue.
    pub id: String,
    /// What it acts on.
    #[serde(default)]
    pub node: String,
    /// What it follows: time, where it is what it acts on that was before.
    #[serde(default)]
    pub along: String,
    /// Variants with their shares, most probable first.
    #[serde(default)]
    pub variants: Vec<Variant>,
    /// The effect on the scale that would be the same, because the readings hardly vary.
    #[serde(default)]
    pub on_scale: Option<String>,
    /// Estimates of its coefficients.
    #[serde(default)]
    pub size: Vec<Option<f64>>,
    /// Their standard uncertainties.
    #[serde(default)]
    pub u: Vec<Option<f64>>,
    /// Coverage factor of their 95 % intervals.
    #[serde(default)]
    pub coverage_factor: Option<f64>,
}

/// A variant of a name.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Variant {
    /// Identifier of its effect: that of the name, or of the same cause in another order.
    #[serde(default)]
    pub id: String,
    /// What distinguishes it.
    pub label: String,
    /// Share of the probability.
    pub share: f64,
}

/// How well a model describes the recording.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Quality {
    /// χ² with the claimed noise.
    pub chi_squared: f64,
    /// Its degrees of freedom.
    pub dof: f64,
    /// Root mean square of the claimed noise, for each output.
    pub expected_noise: Vec<f64>,
    /// Root mean square of the errors of predictions, for each output.
    pub held_out_rms: Vec<f64>,
}

impl Quality {
    /// χ² per degree of freedom.
    pub fn reduced(&self) -> f64 {
        self.chi_squared / self.dof.max(1.0)
    }

    /// Prediction error over noise, all outputs together.
    pub fn held_out(&self) -> Option<f64> {
        if self.held_out_rms.is_empty() || self.held_out_rms.len() != self.expected_noise.len() {
            return None;
        }
        let ratios = self.held_out_rms.iter().zip(&self.expected_noise);
        let mean = ratios
            .map(|(rms, noise)| (rms / noise) * (rms / noise))
            .sum::<f64>()
            / self.held_out_rms.len() as f64;
        Some(libm::sqrt(mean))
    }
}
