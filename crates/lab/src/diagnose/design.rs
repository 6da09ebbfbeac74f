//! The rows of a case as numbers: which parameters act in which row, blocks of rows, the model at any
//! values of the parameters.
//!
//! An observation is a response in a block of rows; observations are ordered by response, then block.
//! Everything is computed row by row and then averaged over blocks, so that histories and lags are
//! those of the full recording.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::blocks::blocks;
use super::case::{Case, Observed, Role, interval};
use super::catalogue::modifiers::{mean, range, usual};
use crate::recording::resolution::{Steps, resolution, stated_steps, steps};
use gumption_core::quantity::Unit;

/// The numbers of a case.
#[derive(Debug)]
pub struct Design<'c> {
    /// The case.
    pub case: &'c Case,
    /// Rows of each block.
    pub blocks: Vec<Vec<usize>>,
    /// All unknowns: parameters, one for each label where they have several, and common errors.
    pub unknowns: Vec<Unknown>,
    /// Place of the first unknown of each parameter.
    first: Vec<usize>,
    /// Where rows are means of those of a recording.
    pub whole: Option<Whole<'c>>,
}

/// The recording of which the rows of a design are means.
#[derive(Debug, Clone)]
pub struct Whole<'c> {
    /// The recording.
    pub case: &'c Case,
    /// Its rows behind each mean; every row is in one.
    pub rows: Vec<Range<usize>>,
}

/// Something that is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Its name, with the label where its parameter has several values.
    pub name: String,
    /// What it is.
    pub kind: UnknownKind,
    /// Where the search begins.
    pub start: Option<f64>,
    /// What is known beforehand: value and standard uncertainty.
    pub prior: Option<(f64, f64)>,
}

/// What an unknown is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnknownKind {
    /// A parameter of the model, or its value for one label.
    Parameter(usize),
    /// The error of a column that all rows share.
    CommonError(usize),
}

/// The model at some values of the unknowns, row by row.
#[derive(Debug, Clone)]
pub struct Linear {
    /// f for each response and row.
    pub values: Vec<Vec<f64>>,
    /// ∂f/∂symbol for each response: rows × symbols.
    pub slopes: Vec<DMatrix<f64>>,
}

impl Unknown {
    /// What is stated of it: where the search begins, or its value beforehand.
    pub fn stated(&self) -> Option<f64> {
        self.start.or(self.prior.map(|(value, _)| value))
    }
}

impl<'c> Design<'c> {
    /// Numbers the unknowns and forms the blocks.
    pub fn new(case: &'c Case) -> Design<'c> {
        let mut unknowns = Vec::new();
        let mut first = Vec::new();
        for (index, parameter) in case.parameters.iter().enumerate() {
            first.push(unknowns.len());
            let labels = (parameter.per).and_then(|column| case.columns[column].labels());
            let levels = labels.map_or(1, |labels| labels.levels.len());
            for level in 0..levels {
                let name = match labels {
                    Some(labels) => format!("{}[{}]", parameter.name, labels.levels[level]),
                    None => parameter.name.clone(),
                };
                unknowns.push(Unknown {
                    name,
                    kind: UnknownKind::Parameter(index),
                    start: parameter.start,
                    prior: parameter.prior,
                });
            }
        }
        for (index, column) in case.columns.iter().enumerate() {
            if let Some(u) = column.u_common {
                unknowns.push(Unknown {
                    name: format!("common error of {}", column.name),
                    kind: UnknownKind::CommonError(index),
                    start: Some(0.0),
                    prior: Some((0.0, u)),
                });
            }
        }
        Design {
            case,
            blocks: blocks(case),
            unknowns,
            first,
            whole: None,
        }
    }

    /// A design whose rows are means of those of a recording, in these blocks.
    pub fn of_means(case: &'c Case, blocks: Vec<Vec<usize>>, whole: Whole<'c>) -> Design<'c> {
        Design {
            blocks,
            whole: Some(whole),
            ..Design::new(case)
        }
    }

    /// The case with all rows of the recording.
    pub fn recording(&self) -> &Case {
        self.whole.as_ref().map_or(self.case, |whole| whole.case)
    }

    /// The rows of the recording behind a row of the design.
    pub fn recorded(&self, row: usize) -> Range<usize> {
        let whole = self.whole.as_ref();
        whole.map_or(row..row + 1, |whole| whole.rows[row].clone())
    }

    /// What reports call some rows: by their numbers in the recording.
    pub fn called(&self, first: usize, last: usize) -> String {
        match (self.recorded(first).start + 1, self.recorded(last).end) {
            (first, last) if first == last => format!("row {first}"),
            (first, last) => format!("rows {first} to {last}"),
        }
    }

    /// Values of the rows of the design for all rows of the recording.
    pub fn spread(&self, values: &[f64]) -> Vec<f64> {
        let rows = values.iter().enumerate();
        rows.flat_map(|(row, value)| std::iter::repeat_n(*value, self.recorded(row).len()))
            .collect()
    }

    /// Number of observations.
    pub fn observations(&self) -> usize {
        self.case.responses.len() * self.blocks.len()
    }

    /// The unknown of a name.
    pub fn named(&self, name: &str) -> Option<usize> {
        self.unknowns
            .iter()
            .position(|unknown| unknown.name == name)
    }

    /// Values of its unknowns for another design; a label that is new there has the mean of those that were seen.
    pub fn carried(&self, values: &DVector<f64>, to: &Design<'_>) -> DVector<f64> {
        let stem = |name: &str| name.split('[').next().map(str::to_owned);
        let value = |name: &str| {
            let alike = |at: &usize| stem(&self.unknowns[*at].name) == stem(name);
            let alike = (0..values.len()).filter(alike).map(|at| values[at]);
            (self.named(name)).map_or_else(|| mean(&alike.collect::<Vec<f64>>()), |at| values[at])
        };
        let values = to.unknowns.iter().map(|unknown| value(&unknown.name));
        DVector::from_vec(values.collect())
    }

    /// What is stated of the unknowns, and another value for those of which nothing is.
    pub fn stated_or(&self, value: f64) -> DVector<f64> {
        let stated = (self.unknowns.iter()).map(|unknown| unknown.stated().unwrap_or(value));
        DVector::from_vec(stated.collect())
    }

    /// Number of unknowns of which something is known beforehand.
    pub fn priors(&self) -> usize {
        self.unknowns
            .iter()
            .filter(|unknown| unknown.prior.is_some())
            .count()
    }

    /// The unknown that stands for a parameter in a row.
    pub fn unknown_of(&self, parameter: usize, row: usize) -> usize {
        let first = self.first[parameter];
        let column = self.case.parameters[parameter].per;
        let labels = column.and_then(|column| self.case.columns[column].labels());
        first + labels.map_or(0, |labels| labels.of_row[row] as usize)
    }

    fn unit_of(&self, unknown: &Unknown) -> &Unit {
        match unknown.kind {
            UnknownKind::Parameter(parameter) => &self.case.parameters[parameter].unit,
            UnknownKind::CommonError(column) => &self.case.columns[column].unit,
        }
    }

    /// A full turn in the unit of an unknown; nothing for what cannot be an angle.
    pub fn turn_of(&self, unknown: &Unknown) -> Option<f64> {
        let radian = Unit::one().conversion_to(self.unit_of(unknown))?;
        Some(radian.apply(std::f64::consts::TAU))
    }

    /// The unit of an unknown as text.
    pub fn unit(&self, unknown: usize) -> String {
        self.unit_of(&self.unknowns[unknown]).after_number()
    }

    /// The value of every symbol in a row: parameters, then columns.
    pub fn symbols(&self, row: usize, unknowns: &DVector<f64>) -> Vec<f64> {
        let parameters = (0..self.case.parameters.len()).map(|p| unknowns[self.unknown_of(p, row)]);
        let number = |numbers: &[f64]| numbers[row];
        let columns = self.case.columns.iter();
        let columns = columns.map(|column| column.numbers().map_or(f64::NAN, number));
        let mut values: Vec<f64> = parameters.chain(columns).collect();
        let parameters = self.case.parameters.len();
        for (unknown, value) in self.unknowns.iter().zip(unknowns.iter()) {
            if let UnknownKind::CommonError(column) = unknown.kind {
                values[parameters + column] += value;
            }
        }
        values
    }

    /// Whether a response is read in a column.
    fn reads(&self, response: usize, column: usize) -> bool {
        matches!(self.case.responses[response].observed, Observed::Column(own) if own == column)
    }

    /// The error that all readings of a response share: what the equation gives is its reading with the error taken away, as a
    /// stimulus is.
    fn common_error(&self, response: usize, unknowns: &DVector<f64>) -> f64 {
        let known = self.unknowns.iter().zip(unknowns.iter());
        let own = known.filter(|(unknown, _)| match unknown.kind {
            UnknownKind::CommonError(column) => self.reads(response, column),
            UnknownKind::Parameter(_) => false,
        });
        own.map(|(_, value)| value).sum()
    }

    /// The model and its slopes in every row.
    pub fn linear(&self, unknowns: &DVector<f64>) -> Linear {
        let (rows, symbols) = (self.case.rows, self.case.symbols());
        let responses = self.case.responses.len();
        let mut linear = Linear {
            values: vec![vec![0.0; rows]; responses],
            slopes: vec![DMatrix::zeros(rows, symbols); responses],
        };
        let mut slopes = vec![0.0; symbols];
        for row in 0..rows {
            let values = self.symbols(row, unknowns);
            for response in 0..responses {
                let given = self.case.equations.at(response, &values, &mut slopes);
                linear.values[response][row] = given - self.common_error(response, unknowns);
                for used in self.case.equations.uses(response) {
                    linear.slopes[response][(row, *used)] = slopes[*used];
                }
            }
        }
        linear
    }

    /// ∂f/∂unknown of every observation.
    pub fn jacobian(&self, linear: &Linear) -> DMatrix<f64> {
        let mut jacobian = DMatrix::zeros(self.observations(), self.unknowns.len());
        let parameters = self.case.parameters.len();
        for (response, slopes) in linear.slopes.iter().enumerate() {
            for (block, rows) in self.blocks.iter().enumerate() {
                let at = response * self.blocks.len() + block;
                let weight = 1.0 / rows.len() as f64;
                for row in rows {
                    for parameter in 0..parameters {
                        jacobian[(at, self.unknown_of(parameter, *row))] +=
                            weight * slopes[(*row, parameter)];
                    }
                    for (index, unknown) in self.unknowns.iter().enumerate() {
                        if let UnknownKind::CommonError(column) = unknown.kind {
                            let of_reading = f64::from(u8::from(self.reads(response, column)));
                            let slope = slopes[(*row, parameters + column)] - of_reading;
                            jacobian[(at, index)] += weight * slope;
                        }
                    }
                }
            }
        }
        jacobian
    }

    /// Averages a column of rows over the blocks.
    pub fn reduced(&self, rows: &[f64]) -> Vec<f64> {
        let mean = |block: &Vec<usize>| {
            block.iter().map(|row| rows[*row]).sum::<f64>() / block.len() as f64
        };
        self.blocks.iter().map(mean).collect()
    }

    /// A column of observations from one column of rows for each response.
    pub fn observed_column(&self, of_response: impl Fn(usize) -> Vec<f64>) -> DVector<f64> {
        let parts = (0..self.case.responses.len())
            .flat_map(|response| self.reduced(&of_response(response)));
        DVector::from_vec(parts.collect())
    }

    /// Root mean square of a column of observations, for each response.
    pub fn root_mean_squares(&self, column: &DVector<f64>) -> Vec<f64> {
        let blocks = self.blocks.len();
        let rms = |response: usize| {
            (column.rows(response * blocks, blocks).norm_squared() / blocks as f64).sqrt()
        };
        (0..self.case.responses.len()).map(rms).collect()
    }

    /// What was observed, row by row; NaN for an output that was not recorded yet.
    pub fn observed(&self, response: usize) -> Vec<f64> {
        match self.case.responses[response].observed {
            Observed::Constant(value) => vec![value; self.case.rows],
            Observed::Column(column) => (self.case.columns[column].numbers())
                .map_or_else(|| vec![f64::NAN; self.case.rows], <[f64]>::to_vec),
        }
    }

    /// The equal steps in which a response is read, as they are stated, or as coarse ones show themselves.
    pub fn steps(&self, response: usize) -> Option<Steps> {
        let observed = self.observed(response);
        let stated = self.stated_step(response);
        stated.map_or_else(
            || steps(&observed),
            |step| Some(stated_steps(step, &observed)),
        )
    }

    /// The step to which the readings of a response are rounded: as it is stated, or as they show it themselves.
    pub fn resolution(&self, response: usize) -> Option<f64> {
        let stated = self.stated_step(response);
        stated.or_else(|| resolution(&self.observed(response)))
    }

    fn stated_step(&self, response: usize) -> Option<f64> {
        match self.case.responses[response].observed {
            Observed::Column(column) => self.case.columns[column].resolution,
            Observed::Constant(_) => None,
        }
    }

    /// How much of a constant that it should give, such as a known field, a model gives in each row; `None` where an output is
    /// recorded. What is added to a constant is a part of this, or the scale of the readings could go to zero and leave all to
    /// what is added.
    pub fn over_constant(&self, linear: &Linear, response: usize) -> Option<Vec<f64>> {
        let Observed::Constant(constant) = self.case.responses[response].observed else {
            return None;
        };
        let ratios = linear.values[response].iter().map(|value| value / constant);
        let ratios: Vec<f64> = ratios.collect();
        let is_scale = |ratio: &f64| *ratio > 0.0 && ratio.is_finite();
        ratios.iter().all(is_scale).then_some(ratios)
    }

    /// Response and block of an observation.
    pub fn place(&self, observation: usize) -> (usize, usize) {
        let blocks = self.blocks.len();
        (observation / blocks, observation % blocks)
    }

    /// The time of each row, or its number in the recording where no time was recorded, from zero; of a mean, the mean of its rows.
    pub fn time(&self) -> Clock {
        let middle = |rows: Range<usize>| (rows.start + rows.end - 1) as f64 / 2.0;
        let of = |role: Role| {
            let column = self.case.with_role(role).next()?;
            let numbers = self.case.columns[column].numbers()?;
            Some((Some(column), numbers.to_vec()))
        };
        let recorded = of(Role::Time).or_else(|| of(Role::Order));
        let (column, values) = recorded.unwrap_or_else(|| {
            let rows = 0..self.case.rows;
            (None, rows.map(|row| middle(self.recorded(row))).collect())
        });
        Clock {
            interval: self.interval(&values),
            values,
            column,
        }
    }

    /// The usual distance of successive rows of the blocks: what lies between blocks may have been put together.
    fn interval(&self, times: &[f64]) -> f64 {
        let mut is_seen = vec![false; times.len()];
        for row in self.blocks.iter().flatten() {
            is_seen[*row] = true;
        }
        let pairs = times.windows(2).zip(is_seen.windows(2));
        let seen = pairs.filter(|(_, seen)| seen[0] && seen[1]);
        usual(seen.map(|(pair, _)| pair[1] - pair[0])).unwrap_or_else(|| interval(times))
    }
}

/// When rows were recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Clock {
    /// One value for each row.
    pub values: Vec<f64>,
    /// The column that it comes from; `None` for the number of the row.
    pub column: Option<usize>,
    /// Median of the positive differences of successive rows.
    pub interval: f64,
}

impl Clock {
    /// From the first to the last.
    pub fn span(&self) -> f64 {
        let (least, most) = range(&self.values);
        (most - least).max(0.0)
    }
}
