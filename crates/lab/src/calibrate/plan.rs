//! What a schedule would tell, before anything is measured.

use super::calibration::{Figures, aliases, beside_known_values, figures};
use super::campaign::{Campaign, Weights};
use super::causes::causes;
use super::gain::Gain;
use super::identify::{Alias, Identifiability};
use super::scatter::{Scatters, stated_u, weights};
use super::stack::{Readings, Row, Stack};
use super::trouble::Trouble;

/// What a schedule would tell.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What it would tell apart.
    pub identifiability: Identifiability,
    /// Coefficients with the uncertainties to expect, at the values that were assumed; none where the
    /// schedule does not determine all of them, or nothing states an uncertainty.
    pub figures: Option<Figures>,
    /// What each omitted effect would shift; empty where the schedule does not determine everything.
    pub aliases: Vec<Alias>,
    /// Number of readings.
    pub readings: usize,
    /// Parameters whose value is not stated and was taken as zero, although effects depend on it.
    pub assumed: Vec<String>,
}

/// Examines a schedule.
///
/// # Errors
/// Parameters of equations that are not linear in them have no start value.
pub fn plan(campaign: &Campaign) -> Result<Plan, Trouble> {
    campaign.fits_into_memory()?;
    let stack = Stack::new(campaign, Readings::Planned);
    let open: Vec<String> = campaign
        .experiment
        .parameters
        .iter()
        .filter(|parameter| parameter.start.is_none())
        .map(|parameter| parameter.name.clone())
        .collect();
    if !stack.is_linear() && !open.is_empty() {
        return Err(Trouble::NoStart { parameters: open });
    }
    if stack.rows.is_empty() {
        return Err(Trouble::TooFew {
            readings: 0,
            parameters: campaign.experiment.parameters.len(),
        });
    }
    let values: Vec<f64> = campaign
        .experiment
        .parameters
        .iter()
        .map(|parameter| parameter.start.unwrap_or(0.0))
        .collect();
    let u = expected_u(&stack);
    let jacobian = stack.jacobian(&values, &u);
    let identifiability = Identifiability::of(&jacobian, &campaign.experiment.parameters);
    let complete = identifiability.rank == campaign.experiment.parameters.len();
    let gain = Gain::linear(&stack, &values, &u).filter(|_| complete);
    let expected = gain.map(|gain| {
        let causes = causes(&stack, &gain, &Scatters::stated(), &u);
        figures(campaign, &values, causes)
    });
    Ok(Plan {
        // Where nothing is in doubt there is nothing to expect, and no uncertainty of 0.
        figures: expected.filter(|figures| figures.coefficients.iter().any(|one| one.u > 0.0)),
        aliases: if complete {
            aliases(&stack, &values, &u)
        } else {
            Vec::new()
        },
        identifiability,
        readings: stack.readings(),
        assumed: open,
    })
}

/// The standard uncertainties by which the fit of the readings will weight them: the plan is that of the estimator which the file asks
/// for, and not of a better one. All alike where not all have a stated error, of which nothing can be told before.
fn expected_u(stack: &Stack<'_>) -> Vec<f64> {
    let alike = || vec![1.0; stack.rows.len()];
    let is_reading = |row: &Row| matches!(row, Row::Reading { .. });
    let mut stated = stack.rows.iter().zip(stated_u(stack));
    if stated.any(|(row, u)| is_reading(row) && u <= 0.0) {
        return alike();
    }
    match (weights(stack), stack.campaign.weights) {
        // What is known of parameters counts by its own u, beside readings that count by that which they have in the mean.
        (Ok(u), Weights::Equal) if !stack.rows.iter().all(is_reading) => {
            beside_known_values(stack, u)
        }
        (Ok(u), _) => u,
        (Err(_), _) => alike(),
    }
}
