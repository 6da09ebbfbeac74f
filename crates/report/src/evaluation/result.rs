//! The result of one measurand by each method.

use crate::Report;
use gumption_format::machine::record;
use gumption_format::machine::{Number, numbers};
use gumption_gum::propagate::{
    Basis, Clause8, Contribution, Coverage, CoverageBasis, Freedom, Gum, MeasurandResult,
    MonteCarlo, Reason, Reported, ReportedUncertainty, StatedProbability, Validation,
};

record! {
    /// Both methods for one measurand.
    MeasurandJson<'a> {
        /// Name.
        name: &'a str,
        /// Unit.
        unit: &'a str,
        /// Description.
        description: Option<&'a str>,
        /// Defining statements, one per line.
        equation: &'a str,
        /// Method that the statement uses: gum, monte_carlo.
        basis: &'a str,
        /// Law of propagation of uncertainty, first order.
        gum: GumJson<'a>,
        /// Second-order terms.
        second_order: Option<SecondOrderJson>,
        /// Propagation of distributions.
        monte_carlo: Option<MonteCarloJson>,
        /// What is reported on a certificate.
        reported: ReportedJson,
        /// Clause 8 of JCGM 101 for two and for one digit of u.
        validation: Option<Vec<ValidationJson>>,
    }

    /// GUM result.
    GumJson<'a> {
        /// Estimate y.
        estimate: Number,
        /// Combined standard uncertainty.
        standard_uncertainty: Number,
        /// Effective degrees of freedom as the formula gives them.
        effective_degrees_of_freedom: Number,
        /// How they were found: infinite, welch-satterthwaite, ensembles, refused.
        degrees_of_freedom_from: &'a str,
        /// Coverage factor k.
        coverage_factor: Number,
        /// Where k came from: normal, t, output, fixed.
        coverage_factor_from: &'a str,
        /// Degrees of freedom of the t-distribution that gave k.
        coverage_factor_degrees_of_freedom: Option<Number>,
        /// Shape of the output's distribution that gave k.
        output_shape: Option<&'a str>,
        /// Components that dominate that distribution.
        dominant: Vec<&'a str>,
        /// Coverage probability of k.
        coverage_probability: Number,
        /// Expanded uncertainty U.
        expanded_uncertainty: Number,
        /// Half-width of the interval for the profile's p, which clause 8 compares.
        half_width_for_p: Number,
        /// Contribution of each input.
        inputs: Vec<ContributionJson>,
        /// Contribution of each component.
        components: Vec<ContributionJson>,
    }

    /// What is reported on a certificate; its method is `basis`.
    ReportedJson {
        /// Estimate; the median where the distribution has no mean.
        estimate: Number,
        /// Standard uncertainty; null where the distribution has none.
        standard_uncertainty: Option<Number>,
        /// Why this method: not-checked, validated, undecided, moments-agree, few-readings, not-validated, not-validated-few-readings, moments-differ, not-negative.
        reason: &'static str,
        /// Coverage factor, where U is a multiple of u.
        coverage_factor: Option<Number>,
        /// Degrees of freedom that gave the coverage factor; null where it follows from none.
        degrees_of_freedom: Option<Number>,
        /// Expanded uncertainty; null where the interval stands in its place, and where there is none.
        expanded_uncertainty: Option<Number>,
        /// The interval, where it is not symmetric about the estimate.
        interval: Option<Vec<Number>>,
        /// Coverage probability, where one is stated.
        coverage_probability: Option<Number>,
    }

    /// A line of the budget table.
    ContributionJson {
        /// Sensitivity coefficient.
        sensitivity: Number,
        /// Standard uncertainty, in the unit of the input or component.
        standard_uncertainty: Number,
        /// Sensitivity times standard uncertainty, with sign, in the unit of the measurand.
        contribution: Number,
        /// Share of the variance of y; shares sum to 1 also under correlation.
        share: Number,
        /// Degrees of freedom.
        degrees_of_freedom: Number,
    }

    /// Second-order terms (JCGM 100, note to 5.1.2).
    SecondOrderJson {
        /// To be added to the estimate.
        shift: Number,
        /// Standard uncertainty with second-order terms.
        standard_uncertainty: Number,
        /// Whether they matter at the digits reported.
        matters: bool,
    }

    /// Monte Carlo result.
    MonteCarloJson {
        /// Mean; null when it does not exist.
        estimate: Option<Number>,
        /// Standard deviation; null when it does not exist.
        standard_uncertainty: Option<Number>,
        /// Median.
        median: Number,
        /// Probabilistically symmetric coverage interval.
        symmetric_interval: Vec<Number>,
        /// Shortest coverage interval.
        shortest_interval: Vec<Number>,
        /// Skewness.
        skewness: Option<Number>,
        /// Excess kurtosis.
        excess_kurtosis: Option<Number>,
        /// Standard errors of estimate, standard uncertainty, and both ends of the symmetric interval.
        standard_errors: Vec<Number>,
        /// Trials without a finite value.
        failed_trials: u64,
        /// Counts over the central range.
        histogram: HistogramJson,
    }

    /// Counts in equal bins.
    HistogramJson {
        /// Left edge of the first bin.
        start: Number,
        /// Width of a bin.
        width: Number,
        /// Counts.
        counts: Vec<u64>,
    }

    /// JCGM 101 clause 8.
    ValidationJson {
        /// Significant digits of u regarded as meaningful.
        digits: u64,
        /// Numerical tolerance δ.
        delta: Number,
        /// Difference of the lower ends.
        d_low: Number,
        /// Difference of the upper ends.
        d_high: Number,
        /// Standard error of the Monte Carlo ends, the larger of the two.
        standard_error: Number,
        /// validated, not-validated, or undecided (the ends scatter too much for a verdict).
        verdict: &'static str,
        /// Whether both differences are within δ beyond doubt.
        validated: bool,
    }
}

pub(super) fn measurand<'a>(
    report: &Report<'a>,
    m: usize,
    result: &'a MeasurandResult,
) -> MeasurandJson<'a> {
    let (name, unit) = report.measurand(m);
    let given = result.reported(&report.budget.conventions);
    MeasurandJson {
        name,
        unit: &unit.symbol,
        description: report
            .budget
            .measurands
            .get(m)
            .and_then(|m| m.description.as_deref()),
        equation: &report.budget.model.outputs()[m].equation,
        basis: match given.basis {
            Basis::Gum => "gum",
            Basis::MonteCarlo => "monte_carlo",
        },
        gum: gum(&result.gum),
        second_order: result.second_order.as_ref().map(|s| SecondOrderJson {
            shift: Number(s.shift),
            standard_uncertainty: Number(s.u),
            matters: s.matters,
        }),
        monte_carlo: result.monte_carlo.as_ref().map(monte_carlo),
        reported: reported(&given),
        validation: result
            .validation
            .as_ref()
            .map(|both| both.iter().map(validation).collect()),
    }
}

fn reported(of: &Reported) -> ReportedJson {
    let interval = match of.uncertainty {
        ReportedUncertainty::Interval { ends, .. } => Some(numbers(&ends)),
        _ => None,
    };
    let probability = match of.probability {
        StatedProbability::Of(p) => Some(p),
        StatedProbability::Unnamed | StatedProbability::Refuted => None,
    };
    ReportedJson {
        estimate: Number(of.estimate),
        standard_uncertainty: of.u.map(Number),
        reason: match of.reason {
            Reason::NotChecked => "not-checked",
            Reason::Validated => "validated",
            Reason::Undecided => "undecided",
            Reason::MomentsAgree => "moments-agree",
            Reason::FewReadings => "few-readings",
            Reason::NotValidated => "not-validated",
            Reason::NotValidatedFewReadings => "not-validated-few-readings",
            Reason::MomentsDiffer => "moments-differ",
            Reason::NotNegative => "not-negative",
        },
        coverage_factor: of.coverage_factor().map(Number),
        degrees_of_freedom: of.dof.map(Number),
        expanded_uncertainty: of.expanded().map(Number),
        interval,
        coverage_probability: probability.map(Number),
    }
}

fn gum(gum: &Gum) -> GumJson<'_> {
    let Coverage {
        k,
        basis,
        probability,
        expanded,
        half_width_for_p,
    } = &gum.coverage;
    let (from, dof, shape, dominant) = match basis {
        CoverageBasis::Normal => ("normal", None, None, &[][..]),
        CoverageBasis::StudentT { dof } => ("t", Some(Number(*dof)), None, &[][..]),
        CoverageBasis::Output { dominant, shape } => {
            ("output", None, Some(shape.name_en), dominant.as_slice())
        }
        CoverageBasis::Fixed => ("fixed", None, None, &[][..]),
    };
    GumJson {
        estimate: Number(gum.estimate),
        standard_uncertainty: Number(gum.u),
        effective_degrees_of_freedom: Number(gum.freedom.value()),
        degrees_of_freedom_from: match gum.freedom {
            Freedom::Infinite => "infinite",
            Freedom::WelchSatterthwaite(_) => "welch-satterthwaite",
            Freedom::Ensembles(_) => "ensembles",
            Freedom::Refused { .. } => "refused",
        },
        coverage_factor: Number(*k),
        coverage_factor_from: from,
        coverage_factor_degrees_of_freedom: dof,
        output_shape: shape,
        dominant: dominant.iter().map(String::as_str).collect(),
        coverage_probability: Number(*probability),
        expanded_uncertainty: Number(*expanded),
        half_width_for_p: Number(*half_width_for_p),
        inputs: gum.inputs.iter().map(contribution).collect(),
        components: gum.components.iter().map(contribution).collect(),
    }
}

fn contribution(c: &Contribution) -> ContributionJson {
    ContributionJson {
        sensitivity: Number(c.sensitivity),
        standard_uncertainty: Number(c.u),
        contribution: Number(c.contribution),
        share: Number(c.share),
        degrees_of_freedom: Number(c.dof),
    }
}

fn monte_carlo(mc: &MonteCarlo) -> MonteCarloJson {
    MonteCarloJson {
        estimate: mc.estimate.map(Number),
        standard_uncertainty: mc.u.map(Number),
        median: Number(mc.median),
        symmetric_interval: numbers(&mc.symmetric),
        shortest_interval: numbers(&mc.shortest),
        skewness: mc.skewness.map(Number),
        excess_kurtosis: mc.excess_kurtosis.map(Number),
        standard_errors: numbers(&mc.standard_errors),
        failed_trials: mc.failed,
        histogram: HistogramJson {
            start: Number(mc.histogram.start),
            width: Number(mc.histogram.width),
            counts: mc.histogram.counts.clone(),
        },
    }
}

fn validation(v: &Validation) -> ValidationJson {
    ValidationJson {
        digits: u64::from(v.digits),
        delta: Number(v.delta),
        d_low: Number(v.d_low),
        d_high: Number(v.d_high),
        standard_error: Number(v.error),
        verdict: match v.verdict {
            Clause8::Validated => "validated",
            Clause8::NotValidated => "not-validated",
            Clause8::Undecided => "undecided",
        },
        validated: v.is_validated(),
    }
}
