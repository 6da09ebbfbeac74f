//! The statistics of a fleet for machines.

use gumption_fleet::{
    Apart, Component, Consistency, Course, Drift, Drifting, Fleet, Group, GroupDrift, GroupResult,
    Measurand, SIGNIFICANCE,
};
use gumption_format::form;
use gumption_format::machine::{Machine, Number};

form! {
    /// What the results of many devices say together.
    FleetJson of (table: &str, fleet: &Fleet) {
        /// The table.
        table: String = table.to_owned(),
        /// Its rows.
        rows: usize = fleet.rows,
        /// The columns by which they are grouped.
        grouped_by: Vec<String> = fleet.by.clone(),
        /// Probability below which, over all tests, chance does not explain what is seen.
        significance: Number = Number(SIGNIFICANCE),
        /// Number of all E_n, by which their probabilities are multiplied.
        tests: usize = fleet.tests,
        /// The groups, in order.
        groups: Vec<GroupJson> = fleet.groups.iter().map(GroupJson::of).collect(),
        /// The measurands.
        measurands: Vec<MeasurandJson> = fleet.measurands.iter().map(MeasurandJson::of).collect(),
    }

    /// A group of rows.
    GroupJson of (group: &Group) {
        /// Its values in the columns by which rows are grouped.
        key: Vec<String> = group.key.clone(),
        /// Its rows.
        rows: usize = group.rows,
        /// Rows without a result, by the codes of their faults.
        faulty: Vec<CountJson> = counts(&group.faulty),
        /// Findings, and how many rows have them.
        findings: Vec<CountJson> = counts(&group.findings),
        /// Verdicts of the assessments of conformity.
        verdicts: Vec<VerdictsJson> = group.verdicts.iter().map(VerdictsJson::of).collect(),
    }

    /// How many rows have a code.
    CountJson of (counted: &(String, usize)) {
        /// The code.
        code: String = counted.0.clone(),
        /// How many rows.
        rows: usize = counted.1,
    }

    /// The verdicts of an assessment.
    VerdictsJson of (verdicts: &(String, Vec<(String, usize)>)) {
        /// The assessment.
        assessment: String = verdicts.0.clone(),
        /// How often which.
        verdicts: Vec<CountJson> = counts(&verdicts.1),
    }

    /// What was found of a measurand.
    MeasurandJson of (one: &Measurand) {
        /// Its name.
        name: String = one.name.clone(),
        /// Its unit; that of all figures without a statement of their own.
        unit: String = one.unit.symbol.clone(),
        /// The column of its reference; null where rows are held against the others of their group.
        reference: Option<String> = one.reference.clone(),
        /// Of each group, in the order of `groups`.
        groups: Vec<GroupResultJson> = one.groups.iter().map(GroupResultJson::of).collect(),
        /// Rows whose E_n was formed.
        tested: usize = one.agreement.tested,
        /// Those with |E_n| > 1.
        beyond: usize = one.agreement.beyond,
        /// How many of them chance lets expect.
        expected_beyond: Number = Number(one.agreement.expected),
        /// Those that chance does not explain.
        named: usize = one.agreement.named,
        /// Rows with |E_n| > 1, the least probable first; at most 100.
        apart: Vec<ApartJson> = one.agreement.apart.iter().map(ApartJson::of).collect(),
        /// Counts of the deviations from the others in standard deviations, 0.25 wide from −5 to 5; what lies beyond is in the
        /// first and the last.
        deviations: Vec<usize> = one.deviations.counts.to_vec(),
        /// The drift; null without dates.
        drift: Option<DriftJson> = one.drift.as_ref().map(DriftJson::of),
    }

    /// What was found of a measurand in a group.
    GroupResultJson of (group: &GroupResult) {
        /// Rows with an estimate.
        values: usize = group.values,
        /// Rows without an estimate, though no fault says why: an empty field, or an overload.
        without_estimate: usize = group.missing,
        /// Rows with an estimate and without a u above zero: they count in the mean and its standard deviation, and nowhere else.
        without_u: usize = group.unweighed,
        /// Mean of the estimates.
        mean: Number = Number(group.mean),
        /// Their experimental standard deviation; null of one.
        s: Option<Number> = group.s.map(Number),
        /// The smallest of them.
        smallest: Option<Number> = (group.values > 0).then_some(Number(group.range[0])),
        /// The largest of them.
        largest: Option<Number> = (group.values > 0).then_some(Number(group.range[1])),
        /// The claimed standard uncertainty, root mean square.
        u: Number = Number(group.u),
        /// The expanded uncertainty, root mean square.
        #[serde(rename = "U")]
        expanded: Number = Number(group.expanded),
        /// Whether they scatter as u says; null where fewer than two have an uncertainty.
        consistency: Option<ConsistencyJson> = group.consistency.as_ref().map(ConsistencyJson::of),
        /// The inputs, where the table has their shares.
        components: Vec<ComponentJson> = group.components.iter().map(ComponentJson::of).collect(),
        /// Rows whose E_n was formed.
        tested: usize = group.tested,
        /// Those with |E_n| > 1.
        beyond: usize = group.beyond,
        /// How many of them chance lets expect.
        expected_beyond: Number = Number(group.expected),
    }

    /// The scatter of estimates beside that which u lets expect.
    ConsistencyJson of (one: &Consistency) {
        /// Rows with an uncertainty.
        values: usize = one.count,
        /// Mean with the weights 1/u².
        weighted_mean: Number = Number(one.mean),
        /// Its standard uncertainty.
        u: Number = Number(one.u),
        /// χ² of the estimates about it.
        chi_squared: Number = Number(one.chi_squared),
        /// Degrees of freedom of χ².
        dof: usize = one.dof,
        /// The Birge ratio, √(χ²/ν).
        birge: Number = Number(one.birge),
        /// Probability of a larger χ².
        p_value: Number = Number(one.p_larger),
    }

    /// An input in the budgets of a group.
    ComponentJson of (one: &Component) {
        /// Its name.
        name: String = one.name.clone(),
        /// Rows in which its share of u² is the largest.
        dominates: usize = one.dominates,
        /// Median of its share.
        median_share: Number = Number(one.median_share),
    }

    /// A row with |E_n| > 1.
    ApartJson of (one: &Apart) {
        /// Its number in the table, the first being 1.
        row: usize = one.row,
        /// Its device.
        device: String = one.device.clone(),
        /// The place of its group in `groups`, the first being 0.
        group: usize = one.group,
        /// Its estimate.
        estimate: Number = Number(one.estimate),
        /// What it is held against.
        other: Number = Number(one.other),
        /// E_n.
        en: Number = Number(one.en),
        /// Probability of such a difference, times `tests`.
        probability: Number = Number(one.probability),
        /// Whether chance does not explain it.
        named: bool = one.is_named(),
    }

    /// The drift of a measurand between calibrations; rates per year of 365.25 days.
    DriftJson of (drift: &Drift) {
        /// Devices with a rate.
        devices: usize = drift.devices,
        /// Those whose rate is beyond its U.
        beyond: usize = drift.beyond,
        /// How many of them chance lets expect.
        expected_beyond: Number = Number(drift.expected),
        /// Those whose drift chance does not explain.
        named: usize = drift.named,
        /// Of each group, in the order of `groups`.
        groups: Vec<GroupDriftJson> = drift.groups.iter().map(GroupDriftJson::of).collect(),
        /// Devices whose rate is beyond its U, the least probable first; at most 100.
        apart: Vec<DriftingJson> = drift.apart.iter().map(DriftingJson::of).collect(),
        /// The courses of those that are least probable, as they are drawn.
        courses: Vec<CourseJson> = drift.courses.iter().map(CourseJson::of).collect(),
    }

    /// The drift of the devices of a group.
    GroupDriftJson of (one: &GroupDrift) {
        /// Devices with a rate.
        devices: usize = one.devices,
        /// Mean of their rates.
        mean: Number = Number(one.mean),
        /// Standard deviation of the rates; null of one.
        s: Option<Number> = one.s.map(Number),
        /// Standard uncertainty of a rate, root mean square.
        u: Number = Number(one.u),
        /// Devices whose rate is beyond its U.
        beyond: usize = one.beyond,
        /// How many of them chance lets expect.
        expected_beyond: Number = Number(one.expected),
        /// Pairs of successive calibrations.
        pairs: usize = one.pairs,
        /// Those of them with |E_n| > 1.
        pairs_beyond: usize = one.pairs_beyond,
    }

    /// A device whose rate is beyond its U.
    DriftingJson of (one: &Drifting) {
        /// Its name.
        device: String = one.device.clone(),
        /// The place of its group in `groups`.
        group: usize = one.group,
        /// Its calibrations.
        calibrations: usize = one.calibrations,
        /// Rate per year.
        rate: Number = Number(one.rate),
        /// Its standard uncertainty.
        u: Number = Number(one.u),
        /// Its expanded uncertainty.
        #[serde(rename = "U")]
        expanded: Number = Number(one.expanded),
        /// The largest E_n of successive calibrations, with sign.
        en: Number = Number(one.en),
        /// Probability of such a rate, times the number of devices with one.
        probability: Number = Number(one.probability),
        /// Whether chance does not explain it.
        named: bool = one.is_named(),
    }

    /// The calibrations of a device.
    CourseJson of (one: &Course) {
        /// Its name.
        device: String = one.device.clone(),
        /// Days since 1970-01-01, difference from the weighted mean of the device, U.
        points: Vec<[Number; 3]> = one.points.iter().map(|point| point.map(Number)).collect(),
    }
}

fn counts(all: &[(String, usize)]) -> Vec<CountJson> {
    all.iter().map(CountJson::of).collect()
}

impl Machine for FleetJson {
    const KIND: &'static str = "fleet";
    const VERSION: u32 = 1;
}
