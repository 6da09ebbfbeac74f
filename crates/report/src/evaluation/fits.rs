//! Least-squares fits in the machine form.

use gumption_gum::budget::{Fit, FitVerdict, LackOfFitTest};

use super::matrix::matrix;
use gumption_format::machine::record;
use gumption_format::machine::{Number, numbers};

record! {
    /// A least-squares fit whose parameters are inputs.
    FitJson<'a> {
        /// Name.
        name: &'a str,
        /// Description.
        description: Option<&'a str>,
        /// Source of the data.
        reference: Option<&'a str>,
        /// Formula, one statement per line.
        equation: &'a str,
        /// Whether the formula is linear in its parameters.
        linear: bool,
        /// What the uncertainties of the data are worth: stated, residuals.
        scale: &'static str,
        /// Columns of data: the response, then the predictors.
        columns: Vec<FitColumnJson<'a>>,
        /// Parameters.
        parameters: Vec<FitParameterJson<'a>>,
        /// Covariance matrix of the parameters from the fit alone, without causes common to all points.
        covariance: Vec<Vec<Number>>,
        /// Their correlation matrix.
        correlation: Vec<Vec<Number>>,
        /// Number of points less number of parameters.
        degrees_of_freedom: u64,
        /// Weighted sum of squares; plain where no uncertainties are stated.
        chi_squared: Number,
        /// Sum of the squares of the residuals.
        residual_sum_of_squares: Number,
        /// Square root of chi_squared per degree of freedom.
        residual_standard_deviation: Option<Number>,
        /// Coefficient of determination.
        r_squared: Number,
        /// Whether the curve describes the data, where that can be tested.
        lack_of_fit: Option<LackOfFitJson>,
        /// Values on the curve.
        fitted: Vec<Number>,
        /// Response less value on the curve.
        residuals: Vec<Number>,
        /// Distances from the curve in their standard uncertainties or in the residual standard deviation.
        normalised_residuals: Option<Vec<Number>>,
        /// Estimates of the true predictors, one list for each point.
        adjusted_predictors: Vec<Vec<Number>>,
        /// Steps of the search; 0 for a direct solution.
        iterations: u64,
        /// Condition number of the scaled design.
        condition: Number,
    }

    /// A column of observed data.
    FitColumnJson<'a> {
        /// Name.
        name: &'a str,
        /// Description.
        description: Option<&'a str>,
        /// Unit.
        unit: &'a str,
        /// Observed values.
        values: Vec<Number>,
        /// Standard uncertainties of the single values.
        standard_uncertainties: Option<Vec<Number>>,
        /// Components that act on all points together.
        common_components: Vec<&'a str>,
    }

    /// A parameter of a fit.
    FitParameterJson<'a> {
        /// Name.
        name: &'a str,
        /// Description.
        description: Option<&'a str>,
        /// Unit.
        unit: &'a str,
        /// Estimate.
        estimate: Number,
        /// Standard uncertainty from the fit alone.
        standard_uncertainty: Number,
        /// Standard uncertainty with the causes common to all points.
        combined_standard_uncertainty: Number,
        /// Index into inputs.
        input: u64,
    }

    /// A test of the curve.
    LackOfFitJson {
        /// Which test: chi-squared, replicates.
        test: &'static str,
        /// Statistic: χ² or F.
        statistic: Number,
        /// Degrees of freedom of the statistic or of its numerator.
        degrees_of_freedom: Number,
        /// Degrees of freedom of the denominator of F.
        denominator_degrees_of_freedom: Option<Number>,
        /// Probability of a statistic at least as large if the curve is right.
        p: Number,
        /// Verdict at the 5 % level: accepted, rejected, too-small.
        verdict: &'static str,
    }
}

/// A fit as a record.
pub(super) fn fit(fit: &Fit) -> FitJson<'_> {
    FitJson {
        name: &fit.name,
        description: fit.description.as_deref(),
        reference: fit.reference.as_deref(),
        equation: &fit.equation,
        linear: fit.linear,
        scale: if fit.stated { "stated" } else { "residuals" },
        columns: fit
            .columns
            .iter()
            .map(|column| FitColumnJson {
                name: &column.name,
                description: column.description.as_deref(),
                unit: &column.unit.symbol,
                values: numbers(&column.values),
                standard_uncertainties: column.u.as_deref().map(numbers),
                common_components: column.common.iter().map(String::as_str).collect(),
            })
            .collect(),
        parameters: fit
            .parameters
            .iter()
            .map(|parameter| FitParameterJson {
                name: &parameter.name,
                description: parameter.description.as_deref(),
                unit: &parameter.unit.symbol,
                estimate: Number(parameter.estimate),
                standard_uncertainty: Number(parameter.u),
                combined_standard_uncertainty: Number(parameter.combined_u),
                input: parameter.input as u64,
            })
            .collect(),
        covariance: matrix(&fit.covariance),
        correlation: matrix(&fit.correlation),
        degrees_of_freedom: fit.dof as u64,
        chi_squared: Number(fit.chi_squared),
        residual_sum_of_squares: Number(fit.rss()),
        residual_standard_deviation: fit.residual_sd.map(Number),
        r_squared: Number(fit.r_squared),
        lack_of_fit: fit.lack_of_fit.as_ref().map(|test| LackOfFitJson {
            test: match test.test {
                LackOfFitTest::ChiSquared => "chi-squared",
                LackOfFitTest::Replicates => "replicates",
            },
            statistic: Number(test.statistic),
            degrees_of_freedom: Number(test.dof),
            denominator_degrees_of_freedom: test.denominator.map(Number),
            p: Number(test.p),
            verdict: match test.verdict() {
                FitVerdict::Accepted => "accepted",
                FitVerdict::Rejected => "rejected",
                FitVerdict::TooSmall => "too-small",
            },
        }),
        fitted: numbers(&fit.fitted),
        residuals: numbers(&fit.residuals),
        normalised_residuals: fit.normalised.as_deref().map(numbers),
        adjusted_predictors: matrix(&fit.adjusted),
        iterations: fit.iterations as u64,
        condition: Number(fit.condition),
    }
}
