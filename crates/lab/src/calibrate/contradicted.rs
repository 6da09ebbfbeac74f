//! What is known of parameters beforehand, beside what the readings give without it.

use super::apart::RARE;
use super::campaign::Campaign;
use super::coefficient::Coefficient;
use gumption_core::special::student_t_sf;
use gumption_core::statistics::{effective_freedom, norm};

/// A parameter of which the readings say something else than what is stated of it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Contradicted {
    /// The parameter.
    pub parameter: String,
    /// What is stated of it, and its standard uncertainty.
    pub stated: [f64; 2],
    /// What the readings give without that, and its standard uncertainty.
    pub found: [f64; 2],
    /// Probability of a difference as large, were both right; times the number of parameters that are compared (Bonferroni), at most 1.
    pub p_value: f64,
}

/// Readings that count by their own scatter give way to what is stated of a parameter, however far away they are, and their scatter
/// grows to what that leaves: nothing in the residuals says so. Without it they say where they lie. They may need what is stated of
/// one parameter to tell another: then each is left out by itself. `coefficients` are those of a campaign, where it determines all.
pub(super) fn contradicted(
    campaign: &Campaign,
    coefficients: impl Fn(&Campaign) -> Option<Vec<Coefficient>>,
) -> Vec<Contradicted> {
    let parameters = campaign.experiment.parameters.iter().enumerate();
    let known: Vec<usize> = parameters
        .filter(|(_, one)| one.known.is_some())
        .map(|(place, _)| place)
        .collect();
    if known.is_empty() {
        return Vec::new();
    }
    let without = |left_out: &[usize]| {
        let mut campaign = campaign.clone();
        campaign.separately = None;
        for place in left_out {
            campaign.experiment.parameters[*place].known = None;
        }
        coefficients(&campaign)
    };
    let compare = |place: usize, found: &[Coefficient]| {
        let one = &campaign.experiment.parameters[place];
        let (stated, found) = (one.known?, &found[place]);
        let parts = [(stated.u, stated.dof), (found.u, found.dof)];
        let u = norm(parts.iter().map(|(u, _)| *u));
        let dof = effective_freedom(parts.into_iter());
        let t = (stated.value - found.value).abs() / u;
        let p_value = (2.0 * known.len() as f64 * student_t_sf(t, dof)).min(1.0);
        (p_value < RARE).then(|| Contradicted {
            parameter: one.name.clone(),
            stated: [stated.value, stated.u],
            found: [found.value, found.u],
            p_value,
        })
    };
    if let Some(found) = without(&known) {
        let all = known.iter().filter_map(|place| compare(*place, &found));
        return all.collect();
    }
    let alone = |place: &usize| compare(*place, &without(&[*place])?);
    known.iter().filter_map(alone).collect()
}
