//! What each cause of doubt does to the coefficients.

use nalgebra::DMatrix;

use super::campaign::{Campaign, Scatter};
use super::cause::{Cause, Origin};
use super::gain::Gain;
use super::points::Points;
use super::scatter::Scatters;
use super::stack::{Row, Stack};
use crate::experiment::{Act, Doubt, Experiment, Scope, Target};
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
    let doubts = stack.campaign.experiment.doubts.iter();
    let doubts: Vec<&Doubt> = doubts
        .filter(|doubt| !scatters.contain(stack, doubt))
        .collect();
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

impl Campaign {
    /// What may make the coefficients uncertain, whatever a recording shows of it: the origins of all causes, in their order.
    pub fn origins(&self) -> Vec<Origin> {
        let Experiment {
            equations,
            parameters,
            doubts,
            ..
        } = &self.experiment;
        let responses = equations.responses().iter();
        let residuals = responses.map(|response| Origin::Residuals {
            response: response.name.clone(),
        });
        let columns = self.points.columns.iter();
        let samples = columns.filter(|column| !column.averages.is_empty());
        let samples = samples.map(|column| Origin::Samples {
            column: column.name.clone(),
        });
        // Where the file does not say what tells the scatter, the number of readings does.
        let scatter = self.scatter;
        let residuals = residuals.filter(|_| scatter.is_none_or(|way| way == Scatter::Residuals));
        let samples = samples.filter(|_| scatter.is_none_or(|way| way == Scatter::Dwells));
        let known = parameters.iter().filter(|one| one.known.is_some());
        let priors = known.map(|one| Origin::Prior {
            parameter: one.name.clone(),
        });
        let stated = doubts.chunk_by(|a, b| a.name == b.name);
        let stated = stated.map(|parts| Origin::Stated {
            name: parts[0].name.clone(),
            scope: parts[0].scope.clone(),
        });
        let all = residuals.chain(samples).chain(priors).chain(stated);
        all.collect()
    }
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
    let points = &stack.campaign.points;
    let mut effects: Option<DMatrix<f64>> = None;
    for act in &doubt.acts {
        let share = |point| doubt.share(points, point) * act.share(points, point);
        let own = gain.by_errors(stack, &act.on, &doubt.scope, share) * (act.coefficient * doubt.u);
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
    /// What multiplies the error at a point: 1 unless a column does, or unless each of the points has its own that were averaged
    /// to this one.
    pub(super) fn share(&self, points: &Points, point: usize) -> f64 {
        let column = self.by.as_ref().and_then(|name| points.column(name));
        let by = column.map_or(1.0, |column| {
            column.values.get(point).copied().unwrap_or(0.0)
        });
        match self.scope {
            Scope::Each => by * points.averaging(point),
            Scope::Common | Scope::By(_) => by,
        }
    }

    /// Whether each reading of a column has an error of this kind for itself.
    pub(super) fn is_of_each(&self, column: &str) -> bool {
        let acts = self.acts.iter();
        self.scope == Scope::Each
            && self.u > 0.0
            && acts.map(|act| &act.on).any(|on| on.is_reading_of(column))
    }

    /// Standard uncertainty of the reading of a column at a point by errors that each reading has for itself.
    pub(super) fn of_reading(&self, column: &str, points: &Points, point: usize) -> f64 {
        if !self.is_of_each(column) {
            return 0.0;
        }
        let own = self.acts.iter().filter(|act| act.on.is_reading_of(column));
        let own = own.map(|act| act.coefficient * act.share(points, point) * self.u);
        (own.sum::<f64>() * self.share(points, point)).abs()
    }
}

impl Target {
    fn is_reading_of(&self, column: &str) -> bool {
        matches!(self, Target::Reading(name) if name == column)
    }
}

impl Act {
    /// What multiplies it at a point: 1 unless it is a part of what is read there.
    pub(super) fn share(&self, points: &Points, point: usize) -> f64 {
        let (Some(growth), Target::Reading(name)) = (self.growth, &self.on) else {
            return 1.0;
        };
        let reading = points
            .column(name)
            .and_then(|column| column.values.get(point));
        reading.map_or(0.0, |reading| growth.factor(*reading))
    }
}
