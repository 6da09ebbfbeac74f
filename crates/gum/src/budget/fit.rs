//! A curve fitted to data by least squares, as the budget and its report see it.

use nalgebra::DMatrix;

use super::claim::NamedFigure;
use gumption_core::least_squares::Observed;
use gumption_core::quantity::Unit;

/// A `[fit.NAME]` with its solution. Its parameters are inputs of the budget.
#[derive(Debug, Clone)]
pub struct Fit {
    /// As the file calls it.
    pub name: String,
    /// What is fitted.
    pub description: Option<String>,
    /// Where the data come from.
    pub reference: Option<String>,
    /// The formula in printed form, one statement per line.
    pub equation: String,
    /// The data; the response first, then the predictors.
    pub columns: Vec<FitColumn>,
    /// The parameters in the order of the file.
    pub parameters: Vec<FitParameter>,
    /// Covariance matrix of the parameters from the fit alone, without causes common to all points.
    pub covariance: DMatrix<f64>,
    /// Their correlation coefficients.
    pub correlation: DMatrix<f64>,
    /// Whether the stated uncertainties of the data were used as they are.
    pub stated: bool,
    /// Whether any column has an uncertainty of its own, so that χ² is weighted by it.
    pub weighted: bool,
    /// ν = n − p.
    pub dof: usize,
    /// Weighted sum of squares at the minimum; plain where no uncertainties are stated.
    pub chi_squared: f64,
    /// √(χ²/ν), in the unit of the response where the sum is plain; `None` for ν = 0.
    pub residual_sd: Option<f64>,
    /// Share of the scatter of the response that the curve describes; not a number where there is no predictor.
    pub r_squared: f64,
    /// f at the adjusted predictors, for every point.
    pub fitted: Vec<f64>,
    /// Response − fitted, in the unit of the response.
    pub residuals: Vec<f64>,
    /// Distance of every point from the curve, in its standard uncertainty (or in the residual standard
    /// deviation where no uncertainties are known); `None` where that is zero.
    pub normalised: Option<Vec<f64>>,
    /// Estimates of the true predictors, one row for each point; the observed ones where exact.
    pub adjusted: DMatrix<f64>,
    /// Whether the formula is linear in its parameters.
    pub linear: bool,
    /// Steps of the search; zero for a direct solution.
    pub iterations: usize,
    /// Condition number of the weighted and scaled design.
    pub condition: f64,
    /// Whether the curve describes the data, where that can be tested.
    pub lack_of_fit: Option<LackOfFit>,
    /// What speaks against it.
    pub doubts: Vec<FitDoubt>,
}

/// What speaks against a fit that was found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub enum FitDoubt {
    /// The residuals keep their signs for longer than by chance.
    Pattern {
        /// Runs of residuals of one sign, along the predictor.
        runs: usize,
        /// Residuals that are not zero.
        points: usize,
        /// Probability of so few runs or fewer.
        p: f64,
    },
    /// The curve has a pole, or is not defined, between two points.
    Pole {
        /// The divisor or argument, as the formula has it.
        argument: String,
        /// Name of the predictor.
        predictor: String,
        /// The two points.
        between: [f64; 2],
        /// Its unit.
        unit: Unit,
    },
    /// Another start leads to a better minimum.
    BetterMinimum {
        /// The parameters there, with their names.
        parameters: Vec<(String, f64)>,
        /// Root mean square of the residuals there, as a fraction of that of the fit.
        residuals: f64,
    },
}

impl FitDoubt {
    /// Significance level of the pattern, which is looked for in every fit: one false alarm in a hundred, at most.
    pub const LEVEL: f64 = 0.01;
}

/// A column of observed data.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FitColumn {
    /// As the formula calls it.
    pub name: String,
    /// What it is.
    pub description: Option<String>,
    /// Unit of the values.
    pub unit: Unit,
    /// Observed values.
    pub values: Vec<f64>,
    /// Standard uncertainties of the single values, without causes common to all; `None` where exact or
    /// unknown.
    pub u: Option<Vec<f64>>,
    /// Names of the components that act on all points together.
    pub common: Vec<String>,
}

/// A parameter of a fit.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FitParameter {
    /// As the formula calls it.
    pub name: String,
    /// What it is.
    pub description: Option<String>,
    /// Its unit.
    pub unit: Unit,
    /// Its estimate.
    pub estimate: f64,
    /// Standard uncertainty from the fit alone.
    pub u: f64,
    /// Standard uncertainty with the causes common to all points.
    pub combined_u: f64,
    /// Its place among the inputs of the budget.
    pub input: usize,
}

/// Whether the data could have come from the curve.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct LackOfFit {
    /// Which test.
    pub test: LackOfFitTest,
    /// χ², or F.
    pub statistic: f64,
    /// ν of the statistic, or of its numerator.
    pub dof: f64,
    /// ν of the denominator of F.
    pub denominator: Option<f64>,
    /// Probability of a statistic at least as large if the curve is right.
    pub p: f64,
}

/// A test of the curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum LackOfFitTest {
    /// χ² of the residuals against the stated uncertainties.
    ChiSquared,
    /// Scatter of the means of repeated points about the curve against the scatter of the repetitions.
    Replicates,
}

/// What a test of the curve says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Verdict {
    /// The data contradict the curve at the 5 % level.
    Rejected,
    /// Nothing is wrong.
    Accepted,
    /// The residuals are smaller than the stated uncertainties let expect, at the 5 % level.
    TooSmall,
}

impl LackOfFit {
    /// Significance level of the verdicts.
    pub const LEVEL: f64 = 0.05;

    /// What follows.
    pub fn verdict(&self) -> Verdict {
        if self.p < Self::LEVEL {
            Verdict::Rejected
        } else if self.test == LackOfFitTest::ChiSquared && 1.0 - self.p < Self::LEVEL {
            Verdict::TooSmall
        } else {
            Verdict::Accepted
        }
    }
}

impl Fit {
    /// The response.
    pub fn response(&self) -> &FitColumn {
        &self.columns[0]
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.residuals.len()
    }

    /// χ²/ν; `None` for ν = 0.
    pub fn chi_squared_per_dof(&self) -> Option<f64> {
        (self.dof > 0).then(|| self.chi_squared / self.dof as f64)
    }

    /// Number and normalised residual of the point farthest from the curve.
    pub fn farthest(&self) -> Option<(usize, f64)> {
        self.normalised.as_ref().and_then(|normalised| {
            normalised
                .iter()
                .copied()
                .enumerate()
                .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        })
    }

    /// The figures of the fit by name, as claims compare them: `line.residual_sd`, `line.cov(a, b)` …
    pub fn figures(&self) -> Vec<NamedFigure> {
        let one = Unit::one();
        let response = self.response().unit.difference();
        let squared = response.product(&response);
        let (of_residual, of_sum) = if self.weighted {
            (&one, &one)
        } else {
            (&response, &squared)
        };
        let mut figures = Vec::new();
        let mut push = |figure: String, value: f64, unit: &Unit| {
            // Squares of 10¹⁶⁰ are no numbers.
            if value.is_finite() {
                figures.push(NamedFigure {
                    name: format!("{}.{figure}", self.name),
                    value,
                    unit: unit.clone(),
                });
            }
        };
        push("points".into(), self.points() as f64, &one);
        push("dof".into(), self.dof as f64, &one);
        push("rss".into(), self.rss(), &squared);
        push("chi_squared".into(), self.chi_squared, of_sum);
        push("r_squared".into(), self.r_squared, &one);
        push("condition".into(), self.condition, &one);
        let optional = [
            ("r", self.correlation_of_data(), &one),
            ("residual_sd", self.residual_sd, of_residual),
            ("chi_squared_per_dof", self.chi_squared_per_dof(), of_sum),
            ("largest_residual", self.farthest().map(|(_, r)| r), &one),
        ];
        for (name, value, unit) in optional {
            if let Some(value) = value {
                push(name.into(), value, unit);
            }
        }
        if let Some(test) = &self.lack_of_fit {
            let statistic = match test.test {
                LackOfFitTest::ChiSquared => "chi_squared",
                LackOfFitTest::Replicates => "F",
            };
            push(format!("lack_of_fit.{statistic}"), test.statistic, &one);
            push("lack_of_fit.p".into(), test.p, &one);
        }
        for (i, a) in self.parameters.iter().enumerate() {
            push(a.name.clone(), a.estimate, &a.unit);
            push(format!("u({})", a.name), a.u, &a.unit.difference());
            for (j, b) in self.parameters.iter().enumerate() {
                if i != j {
                    let pair = format!("({}, {})", a.name, b.name);
                    let unit = a.unit.product(&b.unit);
                    push(format!("cov{pair}"), self.covariance[(i, j)], &unit);
                    push(format!("r{pair}"), self.correlation[(i, j)], &one);
                }
            }
        }
        figures
    }

    /// Correlation coefficient of the data of an unweighted straight line.
    fn correlation_of_data(&self) -> Option<f64> {
        let [y, x] = self.columns.as_slice() else {
            return None;
        };
        let line = self.linear && !self.weighted && self.parameters.len() == 2;
        let sum = |f: &dyn Fn(usize) -> f64| (0..self.points()).map(f).sum::<f64>();
        let n = self.points() as f64;
        let mean_x = sum(&|i| x.values[i]) / n;
        let mean_y = sum(&|i| y.values[i]) / n;
        let xy = sum(&|i| (x.values[i] - mean_x) * (y.values[i] - mean_y));
        let xx = sum(&|i| (x.values[i] - mean_x).powi(2));
        let yy = sum(&|i| (y.values[i] - mean_y).powi(2));
        (line && xx * yy > 0.0).then(|| xy / (xx.sqrt() * yy.sqrt()))
    }

    /// Sum of the squares of response − fitted.
    pub fn rss(&self) -> f64 {
        if self.weighted {
            self.residuals
                .iter()
                .map(|residual| residual * residual)
                .sum()
        } else {
            // The sum that the solver formed with more digits.
            self.chi_squared
        }
    }
}

/// The column of a fit that the solver speaks of: the response is the first.
pub(super) fn column_of(observed: Observed) -> usize {
    match observed {
        Observed::Y => 0,
        Observed::X(predictor) => predictor + 1,
    }
}
