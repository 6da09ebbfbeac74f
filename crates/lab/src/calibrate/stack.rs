//! All readings of an experiment under one another, as a problem of least squares.

use nalgebra::{DMatrix, DVector};

use super::campaign::Campaign;
use super::identify::undetermined;
use super::trouble::Trouble;
use crate::experiment::Words;
use crate::experiment::{Observed, Target};
use gumption_core::least_squares::{
    Errors, Failure, Problem, Response, Scale, Solution, Spread, singular, solve,
};

/// One observed value: a response in a point, or what is known of a parameter beforehand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Row {
    /// An equation in a point.
    Reading { point: usize, response: usize },
    /// A parameter that is partly known.
    Prior { parameter: usize },
}

/// The readings of an experiment.
pub(super) struct Stack<'e> {
    pub campaign: &'e Campaign,
    pub rows: Vec<Row>,
    /// Observed values; empty for a plan.
    pub observed: Vec<f64>,
    /// Readings that were left out, because a value is missing.
    pub left_out: usize,
    linear: bool,
    /// The values of the columns of the equations; `None` where the points lack one.
    columns: Vec<Option<&'e [f64]>>,
    /// Where each response was observed.
    sources: Vec<Source<'e>>,
    /// The symbols that a stated error or a scatter of samples acts on.
    doubted: Vec<usize>,
}

/// The columns and inputs of the equations that a stated error or a scatter of samples acts on, as symbols.
pub(super) fn doubted(campaign: &Campaign) -> Vec<usize> {
    let experiment = &campaign.experiment;
    let doubts = experiment.doubts.iter().flat_map(|doubt| &doubt.acts);
    let stated: Vec<&Target> = doubts.map(|act| &act.on).collect();
    let is_sampled = |name: &str| {
        let column = campaign.points.column(name);
        column.is_some_and(|column| !column.averages.is_empty())
    };
    let is_doubted = |target: &Target| match target {
        Target::Reading(name) => stated.contains(&target) || is_sampled(name),
        Target::Input(_) => stated.contains(&target),
    };
    let columns = experiment.columns.iter().enumerate();
    let columns = columns.map(|(place, column)| (place, Target::Reading(column.name.clone())));
    let inputs = experiment.input_places().zip(0..experiment.inputs.len());
    let inputs = inputs.map(|(place, input)| (place, Target::Input(input)));
    columns
        .chain(inputs)
        .filter(|(_, target)| is_doubted(target))
        .map(|(place, _)| place)
        .collect()
}

/// Where a response was observed.
enum Source<'e> {
    Column(Option<&'e [f64]>),
    Value(f64),
}

impl Source<'_> {
    fn at(&self, point: usize) -> f64 {
        match self {
            Source::Column(values) => value_in(*values, point),
            Source::Value(value) => *value,
        }
    }
}

fn value_in(column: Option<&[f64]>, point: usize) -> f64 {
    let value = column.and_then(|values| values.get(point));
    value.copied().unwrap_or(f64::NAN)
}

impl<'e> Stack<'e> {
    /// The readings; without `readings`, those that the schedule will give.
    pub fn new(campaign: &'e Campaign, readings: Readings) -> Stack<'e> {
        let of_column = |name: &str| {
            let column = campaign.points.column(name);
            column.map(|column| column.values.as_slice())
        };
        let experiment = &campaign.experiment;
        let source = |observed: &Observed| match observed {
            Observed::Column(name) => Source::Column(of_column(name)),
            Observed::Constant(value) => Source::Value(*value),
            Observed::Input(place) => Source::Value(experiment.inputs[*place].value),
        };
        let columns = experiment.columns.iter();
        let mut stack = Stack {
            campaign,
            columns: columns.map(|column| of_column(&column.name)).collect(),
            sources: experiment.observed.iter().map(source).collect(),
            doubted: doubted(campaign),
            rows: Vec::new(),
            observed: Vec::new(),
            left_out: 0,
            linear: campaign
                .experiment
                .equations
                .are_affine_in(&campaign.experiment.parameter_places().collect::<Vec<_>>()),
        };
        for point in 0..campaign.points.len() {
            for response in 0..campaign.experiment.equations.responses().len() {
                let complete = campaign
                    .experiment
                    .equations
                    .uses(response)
                    .iter()
                    .filter_map(|place| stack.columns.get(*place))
                    .all(|column| value_in(*column, point).is_finite());
                let observed = match readings {
                    Readings::Taken => stack.sources[response].at(point),
                    Readings::Planned => 0.0,
                };
                if complete && observed.is_finite() {
                    stack.rows.push(Row::Reading { point, response });
                    stack.observed.push(observed);
                } else {
                    stack.left_out += 1;
                }
            }
        }
        for (parameter, one) in campaign.experiment.parameters.iter().enumerate() {
            if let Some(prior) = one.known {
                stack.rows.push(Row::Prior { parameter });
                stack.observed.push(prior.value);
            }
        }
        stack
    }

    /// Number of rows that are readings; those of partly known parameters follow them.
    pub fn readings(&self) -> usize {
        let reading = |row: &&Row| matches!(row, Row::Reading { .. });
        self.rows.iter().filter(reading).count()
    }

    /// The rows that are readings of a response.
    pub fn rows_of(&self, response: usize) -> Vec<usize> {
        let of = |row: &usize| matches!(self.rows[*row], Row::Reading { response: own, .. } if own == response);
        (0..self.rows.len()).filter(of).collect()
    }

    /// The least difference of two readings in some rows: not less than the resolution. Zero where all are the same.
    pub fn step(&self, rows: &[usize]) -> f64 {
        let mut observed: Vec<f64> = rows.iter().map(|row| self.observed[*row]).collect();
        observed.sort_by(f64::total_cmp);
        let steps = observed.windows(2).map(|pair| pair[1] - pair[0]);
        let least = steps.filter(|step| *step > 0.0).reduce(f64::min);
        least.unwrap_or(0.0)
    }

    /// The symbols that an error acts on.
    pub fn doubted(&self) -> &[usize] {
        &self.doubted
    }

    /// Whether the equations are linear in the parameters.
    pub fn is_linear(&self) -> bool {
        self.linear
    }

    /// The values of all symbols in a row, at these parameters.
    pub fn symbols(&self, row: usize, parameters: &[f64]) -> Vec<f64> {
        let point = match self.rows[row] {
            Row::Reading { point, .. } => point,
            Row::Prior { .. } => 0,
        };
        let columns = self.columns.iter().map(|values| value_in(*values, point));
        let inputs = self
            .campaign
            .experiment
            .inputs
            .iter()
            .map(|input| input.value);
        columns
            .chain(parameters.iter().copied())
            .chain(inputs)
            .collect()
    }

    /// What the equation of a response takes from the columns in a row.
    pub fn stimuli(&self, row: usize, response: usize) -> Vec<f64> {
        let symbols = self.symbols(row, &[]);
        let uses = self.campaign.experiment.equations.uses(response);
        let columns = uses.iter().filter(|place| **place < self.columns.len());
        // −0 and 0 are the same stimulus.
        columns.map(|place| symbols[*place] + 0.0).collect()
    }

    /// ∂f/∂parameter, row by row; with `u` in units of the standard uncertainty of each row.
    pub fn jacobian(&self, parameters: &[f64], u: &[f64]) -> DMatrix<f64> {
        let places = self.campaign.experiment.parameter_places();
        let mut jacobian = DMatrix::zeros(self.rows.len(), parameters.len());
        let mut slopes = vec![0.0; self.campaign.experiment.symbols()];
        for (index, row) in self.rows.iter().enumerate() {
            match *row {
                Row::Reading { response, .. } => {
                    let symbols = self.symbols(index, parameters);
                    self.campaign
                        .experiment
                        .equations
                        .at(response, &symbols, &mut slopes);
                    for (column, place) in places.clone().enumerate() {
                        jacobian[(index, column)] = slopes[place] / u[index];
                    }
                }
                Row::Prior { parameter } => jacobian[(index, parameter)] = 1.0 / u[index],
            }
        }
        jacobian
    }

    /// Change of each row's misfit by a unit error of a target: of what is observed there, less that of
    /// its equation.
    pub fn misfit_by(&self, target: &Target, parameters: &[f64]) -> Vec<f64> {
        let campaign = self.campaign;
        let place = match target {
            Target::Input(place) => Some(campaign.experiment.input_places().start + place),
            Target::Reading(name) => campaign
                .experiment
                .columns
                .iter()
                .position(|c| c.name == *name),
        };
        let mut slopes = vec![0.0; campaign.experiment.symbols()];
        let mut of_row = |(index, row): (usize, &Row)| {
            let Row::Reading { response, .. } = row else {
                return 0.0;
            };
            let symbols = self.symbols(index, parameters);
            campaign
                .experiment
                .equations
                .at(*response, &symbols, &mut slopes);
            let observed = match (&campaign.experiment.observed[*response], target) {
                (Observed::Column(name), Target::Reading(column)) => name == column,
                (Observed::Input(own), Target::Input(place)) => own == place,
                _ => false,
            };
            f64::from(u8::from(observed)) - place.map_or(0.0, |place| slopes[place])
        };
        self.rows.iter().enumerate().map(&mut of_row).collect()
    }

    /// The parameters of least squares, with rows of these standard uncertainties.
    ///
    /// # Errors
    /// Too few rows, parameters that the rows do not tell apart, no minimum.
    pub fn solve(&self, u: &[f64], start: Option<Vec<f64>>) -> Result<Solution, Trouble> {
        let mut x = DMatrix::zeros(self.rows.len(), 1 + self.doubted.len());
        let zeros = vec![0.0; self.campaign.experiment.parameters.len()];
        for index in 0..self.rows.len() {
            x[(index, 0)] = index as f64;
            let symbols = self.symbols(index, &zeros);
            for (predictor, place) in self.doubted.iter().enumerate() {
                // Equations of other responses need not have all columns.
                let value = symbols[*place];
                x[(index, 1 + predictor)] = if value.is_finite() { value } else { 0.0 };
            }
        }
        let problem = Problem {
            response: self,
            y: DVector::from_column_slice(&self.observed),
            errors: Errors {
                y: Spread::Each(u.to_vec()),
                x: vec![Spread::Exact; x.ncols()],
                correlation: None,
                scale: Scale::Stated,
            },
            x,
            start,
        };
        solve(&problem).map_err(|failure| self.trouble(failure))
    }

    /// Why least squares refuses these readings.
    fn trouble(&self, failure: Failure) -> Trouble {
        match failure {
            Failure::TooFewPoints { points, parameters } => Trouble::TooFew {
                readings: points,
                parameters,
            },
            Failure::Indistinct { .. } => {
                let ones = vec![1.0; self.rows.len()];
                let at = self
                    .start()
                    .unwrap_or_else(|_| vec![1.0; self.campaign.experiment.parameters.len()]);
                let jacobian = self.jacobian(&at, &ones);
                let parameters = &self.campaign.experiment.parameters;
                let combinations = undetermined(&jacobian, parameters);
                let changes = combinations.iter().flat_map(|one| &one.changes);
                let is_open = |name: &str| changes.clone().any(|(open, ..)| open == name);
                let begun = parameters.iter().enumerate();
                let begun = begun.filter(|(place, one)| {
                    one.start.is_some()
                        && is_open(&one.name)
                        && self.affine_with(*place, &[]).is_empty()
                });
                Trouble::Undetermined {
                    begun: begun.map(|(_, one)| one.name.clone()).collect(),
                    combinations,
                }
            }
            Failure::Undefined { point } | Failure::NotFinite { point, .. } => {
                let (point, response) = match self.rows.get(point) {
                    Some(Row::Reading { point, response }) => (
                        self.campaign.points.names.of(*point),
                        self.campaign.experiment.equations.responses()[*response]
                            .name
                            .clone(),
                    ),
                    _ => (Words::default(), String::new()),
                };
                Trouble::Undefined { point, response }
            }
            Failure::NoConvergence { iterations, .. } => Trouble::NoConvergence { iterations },
            _ => Trouble::Unsolvable,
        }
    }

    /// Where the search begins: stated values, zero for some of the others, and for the rest, which enter
    /// linearly once these are held, the linear solution. Of the ways to divide the parameters without a
    /// stated start into these two, the one that describes the readings best.
    ///
    /// # Errors
    /// No such way has a solution.
    pub fn start(&self) -> Result<Vec<f64>, Trouble> {
        let parameters = &self.campaign.experiment.parameters;
        let stated: Vec<f64> = parameters.iter().map(|p| p.start.unwrap_or(0.0)).collect();
        let open: Vec<usize> = (0..parameters.len())
            .filter(|place| parameters[*place].start.is_none())
            .collect();
        if open.is_empty() {
            return Ok(stated);
        }
        let mut tried: Vec<Vec<usize>> = Vec::new();
        for first in &open {
            let set = self.affine_with(*first, &open);
            if !set.is_empty() && !tried.contains(&set) {
                tried.push(set);
            }
        }
        let found = tried
            .iter()
            .filter_map(|set| self.linear_start(&stated, set));
        let best = found.min_by(|a, b| a.1.total_cmp(&b.1));
        best.map(|(start, _)| start).ok_or_else(|| {
            // Those need one that never enter linearly; where all do, as in products of them, any may be held.
            let bent = |place: &usize| self.affine_with(*place, &[]).is_empty();
            let of_these: Vec<usize> = open.iter().copied().filter(bent).collect();
            let named = if of_these.is_empty() {
                &open
            } else {
                &of_these
            };
            let name = |place: &usize| parameters[*place].name.clone();
            Trouble::NoStart {
                parameters: named.iter().map(name).collect(),
            }
        })
    }

    /// A largest set of open parameters with this one in which the equations are affine.
    fn affine_with(&self, first: usize, open: &[usize]) -> Vec<usize> {
        let offset = self.campaign.experiment.parameter_places().start;
        let affine = |set: &[usize]| {
            let places: Vec<usize> = set.iter().map(|place| offset + place).collect();
            self.campaign.experiment.equations.are_affine_in(&places)
        };
        let mut set = vec![first];
        if !affine(&set) {
            return Vec::new();
        }
        for place in open.iter().filter(|place| **place != first) {
            set.push(*place);
            if !affine(&set) {
                set.pop();
            }
        }
        set.sort_unstable();
        set
    }

    /// The linear solution for some parameters while the others are held, and the sum of squares that it
    /// leaves; nothing where it is not finite.
    fn linear_start(&self, held: &[f64], free: &[usize]) -> Option<(Vec<f64>, f64)> {
        let mut start = held.to_vec();
        let ones = vec![1.0; self.rows.len()];
        let jacobian = self.jacobian(&start, &ones).select_columns(free);
        let misfit: Vec<f64> = (0..self.rows.len())
            .map(|row| self.observed[row] - self.value(row, &start))
            .collect();
        if !jacobian
            .iter()
            .chain(&misfit)
            .all(|value| value.is_finite())
        {
            return None;
        }
        // Columns of length one: the units of the parameters must not decide what counts as zero.
        let lengths: Vec<f64> = jacobian
            .column_iter()
            .map(|column| column.norm().max(f64::MIN_POSITIVE))
            .collect();
        let mut scaled = jacobian.clone();
        for (mut column, length) in scaled.column_iter_mut().zip(&lengths) {
            column /= *length;
        }
        let misfit = DVector::from_vec(misfit);
        let solution = singular(scaled.clone())?.solve(&misfit, 1e-10).ok()?;
        for ((place, value), length) in free.iter().zip(solution.iter()).zip(&lengths) {
            start[*place] = value / length;
        }
        Some((start, (misfit - scaled * solution).norm_squared()))
    }

    /// The value of a row's equation.
    pub fn value(&self, row: usize, parameters: &[f64]) -> f64 {
        match self.rows[row] {
            Row::Reading { response, .. } => {
                let symbols = self.symbols(row, parameters);
                self.campaign.experiment.equations.value(response, &symbols)
            }
            Row::Prior { parameter } => parameters[parameter],
        }
    }
}

/// Whether there are readings yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Readings {
    Taken,
    Planned,
}

/// The predictors of a row are its index and the doubted symbols, so that the solver gives the derivatives of the
/// parameters by each of them.
impl Response for Stack<'_> {
    fn parameters(&self) -> usize {
        self.campaign.experiment.parameters.len()
    }

    fn is_linear(&self) -> bool {
        self.linear
    }

    fn is_asked_for(&self, predictor: usize) -> bool {
        predictor > 0
    }

    fn at(
        &self,
        predictors: &[f64],
        parameters: &[f64],
        by_parameter: &mut [f64],
        by_predictor: &mut [f64],
    ) -> f64 {
        by_parameter.fill(0.0);
        by_predictor.fill(0.0);
        let index = predictors[0] as usize;
        match self.rows.get(index) {
            Some(Row::Prior { parameter }) => {
                by_parameter[*parameter] = 1.0;
                parameters[*parameter]
            }
            Some(Row::Reading { response, .. }) => {
                let mut symbols = self.symbols(index, parameters);
                for (place, value) in self.doubted.iter().zip(&predictors[1..]) {
                    symbols[*place] = *value;
                }
                let mut slopes = vec![0.0; symbols.len()];
                let value = self
                    .campaign
                    .experiment
                    .equations
                    .at(*response, &symbols, &mut slopes);
                by_parameter.copy_from_slice(&slopes[self.campaign.experiment.parameter_places()]);
                for (slope, place) in by_predictor[1..].iter_mut().zip(&self.doubted) {
                    *slope = slopes[*place];
                }
                value
            }
            None => f64::NAN,
        }
    }
}
