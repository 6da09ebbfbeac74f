//! What each cause of doubt does to the coefficients.

use nalgebra::DMatrix;

use super::cause::{Cause, Origin};
use super::gain::Gain;
use super::scatter::Scatters;
use super::stack::{Row, Stack};
use crate::experiment::{Doubt, Scope, Target};
use gumption_gum::budget::Evaluation;

/// All causes that act on any coefficient.
pub(super) fn causes(stack: &Stack<'_>, gain: &Gain, scatters: &Scatters, u: &[f64]) -> Vec<Cause> {
    let mut all = scatters.causes(stack, gain, u);
    for (index, row) in stack.rows.iter().enumerate() {
        if let Row::Prior { parameter } = row {
            all.extend(prior(stack, gain, index, *parameter));
        }
    }
    // The independent parts of correlated errors bear one name, and are one cause.
    let doubts = &stack.campaign.experiment.doubts;
    all.extend(
        doubts
            .chunk_by(|a, b| a.name == b.name)
            .filter_map(|parts| {
                let causes = parts.iter().map(|doubt| stated(stack, gain, doubt));
                causes.reduce(Cause::beside)
            }),
    );
    all.retain(|cause| cause.effects.iter().any(|effect| *effect != 0.0));
    all
}

fn prior(stack: &Stack<'_>, gain: &Gain, row: usize, parameter: usize) -> Option<Cause> {
    let one = &stack.campaign.experiment.parameters[parameter];
    let prior = one.known?;
    let effects = gain.by_observed.column(row) * prior.u;
    Some(Cause {
        origin: Origin::Prior {
            parameter: one.name.clone(),
        },
        effects: DMatrix::from_columns(&[effects]),
        dof: vec![prior.dof],
        distribution: None,
        evaluation: Evaluation::TypeB,
        how: String::new(),
    })
}

fn stated(stack: &Stack<'_>, gain: &Gain, doubt: &Doubt) -> Cause {
    let mut effects: Option<DMatrix<f64>> = None;
    for act in &doubt.acts {
        let own = gain.by_errors(stack, &act.on, &doubt.scope) * (act.coefficient * doubt.u);
        effects = Some(match effects {
            Some(sum) => sum + own,
            None => own,
        });
    }
    let effects = effects.unwrap_or_else(|| DMatrix::zeros(gain.coefficients(), 0));
    Cause {
        origin: Origin::Stated {
            name: doubt.name.clone(),
            scope: doubt.scope.clone(),
        },
        effects,
        dof: vec![doubt.dof],
        distribution: Some(doubt.distribution.clone()),
        evaluation: doubt.evaluation,
        how: doubt.how.clone(),
    }
}

impl Doubt {
    /// Standard uncertainty of a reading of a column by errors that each reading has for itself.
    pub(super) fn of_each_reading(&self, column: &str) -> f64 {
        if self.scope != Scope::Each {
            return 0.0;
        }
        let acts = self.acts.iter();
        let own = acts.filter(|act| act.on == Target::Reading(column.to_owned()));
        own.map(|act| act.coefficient * self.u).sum::<f64>().abs()
    }
}
