//! Every table of the budget file, as the user writes it.

use super::distributions::DistributionEntry;
use super::table::{Stated, table, words};
use super::values::{Amount, Cell, Date, Dof, Named, OneOrMany};
use super::variants::{
    Amounts, ConstantEntry, FitParameters, Groups, Numbers, ReadingsOf, RowLabel, Sources,
    TrialsEntry,
};

type List<T> = Vec<Stated<T>>;

table! {
    /// A budget of measurement uncertainty.
    FileTable "the file" {
        /// What is measured, as a heading.
        title: String,
        /// The procedure by which it is measured.
        method: String,
        /// The item that is measured or calibrated.
        object: String,
        /// Who evaluated the measurement.
        author: String,
        /// Date of the measurement; certificates past due on it are remarked on.
        date: Date,
        /// Where the figures come from.
        reference: String,
        /// Causes of uncertainty that several inputs share.
        source: Sources,
        /// Anything the reader should know.
        note: String,
        /// Conventions on which guides differ: GUM (default), EA, JJF, JJF-up, NIST, UKAS or S1.
        profile: String,
        /// Statements that every measurand sees: intermediate quantities, functions, measurands themselves.
        model: String,
        /// Changes to single conventions of the profile.
        conventions: ConventionsTable,
        /// How the Monte Carlo method is run.
        monte_carlo: MonteCarloTable,
        /// Units of the file's own: `div = "0.5 mV"`.
        unit: Named<String>,
        /// Exactly known quantities.
        constant: Named<ConstantEntry>,
        /// The quantities to be evaluated.
        measurand: Named<MeasurandTable>,
        /// The quantities on which they depend.
        input: Named<InputTable>,
        /// Curves fitted to data by least squares; their parameters are inputs.
        fit: Named<FitTable>,
        /// Correlation coefficients for which no cause is known.
        correlation: OneOrMany<CorrelationTable>,
        /// Inputs measured together, or given with a covariance matrix.
        joint: OneOrMany<JointTable>,
        /// Whether a measurand conforms to a tolerance.
        conformity: OneOrMany<ConformityTable>,
        /// Decision threshold and detection limit of a measurand that is not negative.
        detection: OneOrMany<DetectionTable>,
        /// What somebody's certificate says; compared, never used.
        claim: OneOrMany<ClaimTable>,
        /// The same budget for a table of values.
        series: SeriesTable,
    }
}

table! {
    /// Changes to single conventions of the profile.
    ConventionsTable "[conventions]" {
        /// Coverage probability p of the coverage interval: 0.95, 0.9545, 0.99.
        coverage_probability: f64,
        /// A fixed coverage factor k.
        coverage_factor: f64,
        /// The rule from which the coverage factor follows.
        coverage_factor_from: FactorWord,
        /// What is taken for the output's distribution where one or two components dominate it.
        output_distribution: ShapeWord,
        /// How effective degrees of freedom that are no whole number enter t.
        degrees_of_freedom: FreedomWord,
        /// Significant digits of the expanded uncertainty: 1 or 2.
        digits: u64,
        /// How numbers are rounded.
        rounding: RoundingWord,
        /// What the stated u of a t-distributed input is in the Monte Carlo method.
        t_scale: TScaleWord,
        /// Resolution and repeatability of the same input: both, or only the larger.
        resolution: ResolutionWord,
    }
}

words! {
    /// Where the coverage factor comes from.
    FactorWord {
        /// t, or the output distribution when a non-normal component dominates.
        Output "output",
        /// t at the effective degrees of freedom.
        StudentT "t",
        /// The normal quantile.
        Normal "normal",
    }
}

words! {
    /// The distribution of an output that one or two components dominate.
    ShapeWord {
        /// The dominant components and a normal remainder together.
        Convolution "convolution",
        /// The dominant components alone, as in EA-4/02 S9 and S10.
        Dominant "dominant",
    }
}

words! {
    /// Effective degrees of freedom that are no whole number.
    FreedomWord {
        /// Cut to the next lower whole number.
        Truncated "truncated",
        /// Used as they are.
        Real "real",
    }
}

words! {
    /// How digits are dropped.
    RoundingWord {
        /// To nearest, ties to even.
        HalfEven "half-even",
        /// To nearest, ties away from zero.
        HalfUp "half-up",
        /// Always away from zero.
        Up "up",
    }
}

words! {
    /// What u is for a t distribution.
    TScaleWord {
        /// The scale parameter.
        Scale "scale",
        /// The standard deviation.
        StandardDeviation "standard-deviation",
    }
}

words! {
    /// Treatment of resolution beside repeatability.
    ResolutionWord {
        /// Both count.
        Add "add",
        /// Only the larger counts.
        Largest "largest",
    }
}

table! {
    /// How the Monte Carlo method is run.
    MonteCarloTable "[monte_carlo]" {
        /// Number of trials, or "adaptive". When left out 1000000, or 10000000 where these leave the verdict of JCGM 101 clause 8 open.
        trials: TrialsEntry,
        /// Adaptive procedure.
        procedure: ProcedureWord,
        /// Adaptive: significant digits of u to be stable (1 or 2).
        digits: u64,
        /// Adaptive: give up after so many trials.
        max_trials: u64,
        /// Seed of the random numbers; the same seed gives the same result everywhere.
        seed: u64,
        /// What trials are made of. Quasi-random points are run until the results are stable, as adaptive trials are, and give way to random ones where they are not far more accurate.
        points: PointsWord,
        /// Give Sobol' sensitivity indices, too: the part of the variance that each input makes alone, and takes part in.
        indices: bool,
    }
}

words! {
    /// What trials are made of.
    PointsWord {
        /// Random numbers (JCGM 101).
        Random "random",
        /// Scrambled Sobol' points.
        QuasiRandom "quasi-random",
    }
}

words! {
    /// The adaptive procedures.
    ProcedureWord {
        /// Two-stage procedure of Stein.
        Stein "stein",
        /// JCGM 101 7.9.4.
        Jcgm101 "jcgm101",
    }
}

table! {
    /// An exactly known quantity.
    ConstantTable "[constant]" {
        /// Its value, in its unit.
        value: Amount,
        /// Several values: a vector.
        values: List<f64>,
        /// Its unit; dimension one when left out.
        unit: String,
        /// What it is.
        description: String,
        /// Where it comes from.
        reference: String,
    }
}

table! {
    /// A quantity to be evaluated.
    MeasurandTable "[measurand]" {
        /// Its formula; several statements on several lines. May be left out if the shared model defines it.
        model: String,
        /// The unit in which the result is wanted; dimension one when left out.
        unit: String,
        /// What it is.
        description: String,
    }
}

table! {
    /// A quantity on which measurands depend: its estimate and its reasons for doubt.
    InputTable "[input]" {
        /// Its estimate, in its unit.
        value: Amount,
        /// Estimates of a vector.
        values: List<f64>,
        /// Its unit; dimension one when left out.
        unit: String,
        /// What it is.
        description: String,
        /// Heading under which the budget table sums it up.
        group: String,
        /// Result of another budget, or a saved result, in place of a value and its uncertainty.
        from: FromTable,
        /// Several reasons to doubt the input; with a single one its keys may stand in the input itself.
        components: List<ComponentTable>,
        with component: ComponentTable
    }
}

table! {
    /// A result of another file, with everything that makes it uncertain.
    FromTable "`from`" {
        /// Path of another budget, from the folder of this one; its formulas and components become part of this budget.
        budget: String,
        /// Path of a file that `gumption eval --save` wrote; the result is taken over in linear form.
        result: String,
        /// Which of its measurands; may be left out where it has only one.
        measurand: String,
        /// Which row of its series, by label or by number.
        row: RowLabel,
    }
}

table! {
    /// A cause of uncertainty that several inputs share; its value is zero.
    SourceTable "[source]" {
        /// Its unit; dimension one when left out.
        unit: String,
        /// What it is.
        description: String,
        /// Several reasons for doubt; with a single one its keys may stand in the table itself.
        components: List<ComponentTable>,
        with component: ComponentTable
    }
}

table! {
    /// One reason to doubt a quantity.
    ComponentTable "a component" {
        /// Its name in the budget table: `calibration`.
        name: String,
        /// Way: standard uncertainty; of a vector or of the data of a fit, one for all elements, a list or a column of a CSV file.
        u: Amounts,
        /// Way: half-width a of symmetric limits ±a (rectangular unless `distribution` says otherwise); of a vector or of the data of a fit, one for all elements, a list or a column of a CSV file.
        half_width: Amounts,
        /// Way: lower and upper limit of the quantity itself.
        limits: List<Amount>,
        /// Way, with `minus`: upper limit above the value.
        plus: Amount,
        /// Way, with `plus`: lower limit below the value, as a positive number.
        minus: Amount,
        /// Way: expanded uncertainty from a certificate; without `U`, the certificate behind another way.
        certificate: CertificateTable,
        /// Whether a stated u was evaluated from readings (Type A) or otherwise.
        kind as "type": TypeWord,
        /// Way: repeated readings, in the unit of the input, as a list or from a CSV file; of a vector, one list for each element.
        readings: Numbers,
        /// Way: readings in groups (days, laboratories), one list for each; in subgroups of groups, lists of lists; or from a CSV file.
        groups: Groups,
        /// Way: means, standard deviations and numbers of readings of groups.
        group_summary: GroupSummaryTable,
        /// With `groups`: what is done with a difference between them.
        between: BetweenWord,
        /// Level of significance of the F test of `groups` or of the `outlier_test` (default 0.05).
        significance: f64,
        /// With `readings`: tests the most outlying one; reported, never removed.
        outlier_test: OutlierWord,
        /// Way: accuracy specification of an instrument.
        specification: SpecificationTable,
        /// Way: resolution q of an indication; half-width q/2.
        step: Amount,
        /// Way, with `range`: number of bits of a quantiser.
        bits: u64,
        /// Lower and upper end of the quantiser's range: `[0, 10]`, `[-5, 5]`.
        range: List<Amount>,
        /// Way: a `[source.NAME]` cause; its name.
        source: String,
        /// Way: the scatter of the data about a `[fit.NAME]`; its name. `of` says of how many readings the value is the mean (default 1).
        residual_of: String,
        /// Way: a sample of the distribution itself, as a list or from a CSV file.
        sample: Numbers,
        /// Shape that goes with another way (`"uniform"`), or a way of its own: `{ NAME = { parameters } }`.
        distribution: DistributionEntry,
        /// Way: number of counted events (Poisson).
        count: u64,
        /// Way, with `trials`: number of successes (binomial).
        successes: u64,
        /// Number of attempts.
        trials: u64,
        /// Prior of `count` or `successes`.
        prior: PriorWord,
        /// Trapezoid: ratio of the top to the base, between 0 and 1.
        beta: f64,
        /// Curvilinear trapezoid: half-width of the doubt about the limits.
        d: Amount,
        /// Coverage probability of a normal half-width.
        p: f64,
        /// Degrees of freedom of the standard uncertainty.
        dof: Dof,
        /// Relative uncertainty Δu/u of the standard uncertainty; gives ν = ½(Δu/u)^-2.
        reliability: f64,
        /// Numbers are fractions of the value: `u = 0.001`, `u = "0.1 %"`. With `source`: the cause acts in proportion.
        relative: bool,
        /// With `readings`: whether the estimate is their mean (default), a single reading, or the mean of so many.
        of: ReadingsOf,
        /// Standard deviation from earlier work in place of that of the readings.
        pooled: PooledTable,
        /// With `readings`: correct u for serial correlation.
        autocorrelated: bool,
        /// Vector inputs: one error shared by all elements (default: one for each).
        common: bool,
        /// With `source`: change of the input per unit of the cause.
        sensitivity: Amount,
        /// Standard uncertainty for the GUM method only, where a published table uses another one than that of the distribution.
        gum_u: Amount,
        /// Where the number comes from.
        reference: String,
    }
}

words! {
    /// How a standard uncertainty was evaluated.
    TypeWord {
        /// By a statistical analysis of readings.
        A "A",
        /// By other means.
        B "B",
    }
}

words! {
    /// What is done with a difference between groups of readings.
    BetweenWord {
        /// Its variance is part of u.
        Include "include",
        /// As "include" if an F test finds the difference, else as "none".
        Test "test",
        /// All readings are taken for one population.
        None "none",
    }
}

words! {
    /// Tests for outliers.
    OutlierWord {
        /// Grubbs: largest deviation in units of s.
        Grubbs "grubbs",
        /// Dixon: gap beside the outermost reading over the range.
        Dixon "dixon",
        /// Dixon's Q: gap over the whole range for any number of readings.
        Q "dixon-q",
        /// Four mean deviations of the other readings.
        FourD "4d",
        /// Three standard deviations.
        ThreeS "3s",
    }
}

table! {
    /// What is known of groups of readings.
    GroupSummaryTable "group_summary" {
        /// Mean of each group.
        means: List<Amount>,
        /// Experimental standard deviation of each group.
        s: List<Amount>,
        /// Number of readings of each group, or one number for all.
        n: OneOrMany<u64>,
    }
}

table! {
    /// A column of a CSV file whose rows belong to groups.
    GroupColumnTable "a CSV column in groups" {
        /// Path of the file.
        file: String,
        /// Name of the column with the readings.
        column: String,
        /// Name of the column that tells the group; two names for groups and subgroups.
        group: OneOrMany<String>,
    }
}

words! {
    /// What is known of a rate or proportion before counting.
    PriorWord {
        /// Constant density.
        Uniform "uniform",
        /// Jeffreys' prior.
        Jeffreys "jeffreys",
        /// Reciprocal of the rate.
        Reciprocal "reciprocal",
    }
}

table! {
    /// Expanded uncertainty from a certificate.
    CertificateTable "certificate" {
        /// Expanded uncertainty U.
        U: Amount,
        /// Coverage factor k.
        k: f64,
        /// Coverage probability p, in place of k.
        p: f64,
        /// Effective degrees of freedom ν_eff.
        dof: Dof,
        /// Number of the certificate.
        number: String,
        /// Who issued it.
        laboratory: String,
        /// Date of the calibration.
        date: Date,
        /// Date when the next calibration is due.
        due: Date,
    }
}

table! {
    /// Accuracy specification: half-width = reading part + range part + counts + fixed part.
    SpecificationTable "specification" {
        /// Part of the value: `"0.002 %"`.
        reading: Amount,
        /// Part of the range: `"0.0006 %"`; needs `span`.
        range: Amount,
        /// The range of which `range` is a part.
        span: Amount,
        /// Number of counts (digits); needs `step`.
        counts: f64,
        /// Value of one count.
        step: Amount,
        /// A constant part.
        fixed: Amount,
    }
}

table! {
    /// Standard deviation from earlier work.
    PooledTable "pooled" {
        /// Pooled standard deviation of a single reading.
        s: Amount,
        /// Its degrees of freedom.
        dof: Dof,
        /// In place of both: earlier series of readings, one list for each.
        readings: List<List<f64>>,
    }
}

table! {
    /// A column of a CSV file; the file is looked up from the folder of the budget.
    ColumnTable "a CSV column" {
        /// Path of the file.
        file: String,
        /// Name of the column in its first line.
        column: String,
    }
}

table! {
    /// A curve fitted to data by least squares; its parameters are inputs under their own names.
    FitTable "[fit]" {
        /// What is fitted.
        description: String,
        /// The formula: the response column on the left, other columns, parameters and constants on the right.
        model: String,
        /// In place of `model`: degree of a polynomial.
        polynomial: u64,
        /// With `polynomial`: the column on the left.
        response: String,
        /// With `polynomial`: the column of which it is a polynomial.
        predictor: String,
        /// With `polynomial`: false for a curve through the origin.
        intercept: bool,
        /// The observed data: one column for each quantity of the formula.
        data: Named<FitColumnTable>,
        /// The parameters with unit and start value, or a list of their names; without it every name of the formula that is no column and no constant.
        parameters: FitParameters,
        /// Whether the uncertainties of the data are used as stated, or known only up to a factor that follows from the residuals.
        scale: ScaleWord,
        /// Correlation coefficients of the errors of predictor and response, one for each point.
        correlation: List<f64>,
        /// Where the data come from.
        reference: String,
    }
}

table! {
    /// A column of data: its values, and why they are in doubt. Without doubt it is exact; where no column has any, the residuals tell the scatter of the response.
    FitColumnTable "[fit.NAME.data]" {
        /// The observed values, as a list or from a CSV file.
        values: Numbers,
        /// Their unit; dimension one when left out.
        unit: String,
        /// What it is.
        description: String,
        /// Covariance matrix of the values in the square of their unit, row by row.
        covariance: List<List<f64>>,
        /// Weights of the values, 1/u², as a list or from a CSV file.
        weights: Numbers,
        /// Several reasons to doubt the values; those with `common = true` and shared causes act on all points together.
        components: List<ComponentTable>,
        with component: ComponentTable
    }
}

table! {
    /// A parameter of a fit.
    FitParameterTable "[fit.NAME.parameters]" {
        /// Its unit; where it is left out, the one that follows from the formula if that is linear in the parameters.
        unit: String,
        /// Where the search begins; needed for formulas that are not linear in the parameters.
        start: Amount,
        /// What it is.
        description: String,
    }
}

words! {
    /// What the stated uncertainties of the data of a fit are worth.
    ScaleWord {
        /// Used as they are.
        Stated "stated",
        /// Known up to a common factor, which the residuals tell.
        Residuals "residuals",
    }
}

table! {
    /// Correlation of two quantities.
    CorrelationTable "[[correlation]]" {
        /// Two inputs, shared causes, or components such as `"V.calibration"`; of more names, every pair.
        between: List<String>,
        /// Correlation coefficient.
        r: f64,
        /// How it is known.
        reference: String,
    }
}

table! {
    /// Inputs that were measured together.
    JointTable "[[joint]]" {
        /// The inputs. Without a matrix, their readings were taken simultaneously.
        inputs: List<String>,
        /// Covariance matrix in the units of the inputs, row by row.
        covariance: List<List<f64>>,
        /// Correlation matrix, row by row; the inputs state their own uncertainties.
        correlation: List<List<f64>>,
        /// Degrees of freedom of the covariance matrix.
        dof: Dof,
        /// Where the matrix comes from.
        reference: String,
    }
}

table! {
    /// What somebody's certificate says; compared, never used.
    ClaimTable "[claim]" {
        /// Measurand, where there are several.
        measurand: String,
        /// Which result the figures are about; without it GUM is judged and Monte Carlo shown beside.
        method: MethodWord,
        /// Stated value.
        value: Amount,
        /// Stated standard uncertainty.
        u: Amount,
        /// Stated expanded uncertainty.
        U: Amount,
        /// Stated coverage factor.
        k: f64,
        /// Stated degrees of freedom.
        dof: f64,
        /// Stated coverage probability.
        p: f64,
        /// Stated coverage interval: lower and upper limit.
        interval: List<Amount>,
        /// Stated shortest coverage interval: lower and upper limit.
        shortest: List<Amount>,
        /// Stated second-order shift of the estimate.
        shift: Amount,
        /// Stated correlation coefficients with other measurands, by name.
        correlation: Named<f64>,
        /// Stated joint coverage region of the measurands.
        region: RegionClaimTable,
        /// Stated verdict of the validation of JCGM 101 clause 8.
        validated: VerdictTable,
        /// Stated figures of inputs (`V`) and components (`V.calibration`), by name.
        inputs: Named<InputClaimTable>,
        /// Stated figures of analyses, by name: `"line.residual_sd" = 0.0035`.
        figures: Named<f64>,
        /// Correct significant digits that every figure of the claim must have, in place of tolerances.
        digits: u64,
        /// How well the stated figures are known; with "low" they are shown and decide nothing.
        confidence: ConfidenceWord,
        /// Largest differences that still agree, where half a unit of the last stated digit is too little.
        tolerance: ToleranceTable,
        /// Who says so.
        reference: String,
        /// Anything to know about it.
        note: String,
    }
}

words! {
    /// The result that a claim is about.
    MethodWord {
        /// Law of propagation of uncertainty, first order.
        Gum "GUM",
        /// The same with second-order terms.
        SecondOrder "second-order",
        /// Propagation of distributions.
        MonteCarlo "Monte Carlo",
    }
}

words! {
    /// How well the figures of a claim are known.
    ConfidenceWord {
        /// Inputs and figures stand in a source that was read.
        High "high",
        /// Recalled, or quoted by a third party.
        Medium "medium",
        /// Recalled in part.
        Low "low",
    }
}

table! {
    /// A stated joint coverage region.
    RegionClaimTable "`region`" {
        /// Coverage factor of the ellipsoid.
        ellipsoid: f64,
        /// Coverage factor of the hyper-rectangle.
        rectangle: f64,
        /// Effective degrees of freedom of the covariance matrix.
        dof: f64,
    }
}

table! {
    /// A stated verdict of the validation.
    VerdictTable "`validated`" {
        /// Significant digits of u(y): 1 or 2.
        digits: u64,
        /// Whether the GUM result is validated.
        verdict: bool,
    }
}

table! {
    /// Stated figures of an input or component.
    InputClaimTable "a claim about an input" {
        /// Its estimate.
        value: Amount,
        /// Its standard uncertainty.
        u: Amount,
        /// Its degrees of freedom.
        dof: f64,
        /// Its sensitivity coefficient.
        sensitivity: f64,
        /// Its contribution |c|·u, in the unit of the measurand.
        contribution: f64,
    }
}

table! {
    /// Largest differences that still agree, in the unit of the figure.
    ToleranceTable "`tolerance`" {
        /// Of the value.
        value: f64,
        /// Of the standard uncertainty.
        u: f64,
        /// Of the expanded uncertainty.
        U: f64,
        /// Of the coverage factor.
        k: f64,
        /// Of the degrees of freedom.
        dof: f64,
        /// Of the coverage probability.
        p: f64,
        /// Of the limits of the interval.
        interval: f64,
        /// Of the limits of the shortest interval.
        shortest: f64,
        /// Of the shift.
        shift: f64,
        /// Of correlation coefficients.
        correlation: f64,
        /// Of the factors of the joint region.
        region: f64,
        /// Of contributions of inputs.
        contribution: f64,
        /// Of sensitivity coefficients of inputs.
        sensitivity: f64,
        /// Of figures of analyses.
        figures: f64,
    }
}

table! {
    /// Whether a measurand conforms to a tolerance (JCGM 106).
    ConformityTable "[conformity]" {
        /// Measurand, where there are several.
        measurand: String,
        /// Name of this assessment, where a measurand has several.
        name: String,
        /// Lower tolerance limit.
        lower: Amount,
        /// Upper tolerance limit.
        upper: Amount,
        /// Decision rule.
        rule: RuleWord,
        /// Distance of the acceptance limits from the tolerance limits; U when left out.
        guard_band: Amount,
        /// The same as a multiple of U.
        guard_band_factor: f64,
        /// Guarded acceptance: least conformance probability of an accepted item.
        conformance_probability: f64,
        /// Guarded rejection: least probability that a rejected item does not conform.
        nonconformance_probability: f64,
        /// Acceptance limits: one for every tolerance limit.
        acceptance: List<Amount>,
        /// What is known of the items before one is measured.
        process: ProcessTable,
        /// Input that carries the measurand's value, where u depends on that value.
        carrier: String,
        /// Nothing is measured yet: only limits and risks are wanted.
        planning: bool,
    }
}

words! {
    /// Decision rules.
    RuleWord {
        /// Acceptance interval = tolerance interval (shared risk).
        Simple "simple",
        /// Acceptance limits inside the tolerance by the guard band.
        GuardedAcceptance "guarded-acceptance",
        /// Acceptance limits outside the tolerance by the guard band.
        GuardedRejection "guarded-rejection",
        /// Undecided within the guard band on both sides of a tolerance limit.
        NonBinary "non-binary",
        /// Guarded acceptance with w = U.
        IlacG8 "ILAC-G8",
        /// Conformance and non-conformance each to be shown with 95 %.
        Iso14253 "ISO 14253-1",
        /// Simple where U is at most a third of MPEV, else undecided within U of the limits.
        Jjf1094 "JJF 1094",
    }
}

table! {
    /// What is known of the items before one is measured.
    ProcessTable "`process`" {
        /// Distribution of the property over the items: `{ NAME = { parameters } }`, in the unit of the measurand.
        distribution: DistributionEntry,
        /// Fraction of the items that conform; a normal distribution centred between both limits follows from it.
        in_tolerance_probability: f64,
    }
}

table! {
    /// Characteristic limits of a measurand that is not negative (ISO 11929).
    DetectionTable "[detection]" {
        /// Measurand, where there are several.
        measurand: String,
        /// Input that carries the measurand's value: the gross counts or the gross indication.
        gross: String,
        /// Probability of recognising an effect that is not there (default 0.05).
        alpha: f64,
        /// Probability of missing an effect at the detection limit (default 0.05).
        beta: f64,
        /// Quantile for α in its place, as the source rounds it: 1.645 for 5 %.
        k_alpha: f64,
        /// Quantile for β in its place, as the source rounds it.
        k_beta: f64,
        /// Coverage probability of the limits of the coverage interval; that of the conventions when left out.
        coverage_probability: f64,
        /// Guideline value that the detection limit must not exceed.
        guideline: Amount,
    }
}

table! {
    /// The same budget for a table of values.
    SeriesTable "[series]" {
        /// Names of inputs or constants, `label`, or numbers of the claim such as `claim.value`.
        columns: List<String>,
        /// One list per evaluation, with an entry for every column.
        rows: List<List<Cell>>,
    }
}
