//! Hand-made evaluations, one for each branch of the renderers. Units are of dimension one with the
//! symbol that is to be seen, since nothing here is computed with them.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::budget::{
    Budget, Certificate, Claim, ClaimedFigure, ClaimedMethod, Component, Confidence, CoverageRule,
    Evaluation as Kind, Figure, Group, Heading, Input, Law, Measurand, MonteCarloSettings, Owner,
    PROFILES, Points, Remark, Term, Trials,
};
use crate::distribution::Distribution;
use crate::model::{MeasurandSource, Model, Notice, Office, Request, Role, Symbol, compile};
use crate::propagate::{
    Basis, Clause8, Consequence, Contribution, Coverage, CoverageBasis, Evaluation, Finding,
    FindingKind, Freedom, Gum, Histogram, JointResult, MeasurandResult, MissingMoments, MonteCarlo,
    Regions, Run, SecondOrder, Side, Validation,
};
use crate::quantity::{Dimension, Factor, Unit, UnitTable};

use super::{Language, Report};

/// A budget and its evaluation.
pub(super) struct Case {
    pub(super) budget: Budget,
    pub(super) evaluation: Evaluation,
}

impl Case {
    pub(super) fn report(&self, language: Language) -> Report<'_> {
        Report {
            budget: &self.budget,
            evaluation: &self.evaluation,
            label: None,
            language,
        }
    }
}

pub(super) fn unit(symbol: &str) -> Unit {
    let factor = Factor {
        numerator: 1.0,
        denominator: 1.0,
        ten: 0,
        pi: 0,
    };
    Unit {
        dimension: Dimension::default(),
        factor,
        origin: None,
        symbol: symbol.to_string(),
    }
}

fn model(inputs: &[Input], measurands: &[(&str, &str, &str)]) -> Model {
    let symbols: Vec<Symbol> = inputs
        .iter()
        .enumerate()
        .map(|(i, input)| Symbol {
            name: input.name.clone(),
            unit: input.unit.clone(),
            role: Role::Input(i),
        })
        .collect();
    let sources: Vec<MeasurandSource<'_>> = measurands
        .iter()
        .map(|(name, model, symbol)| MeasurandSource {
            name,
            model: Some(model),
            unit: Some(unit(symbol)),
        })
        .collect();
    let units = UnitTable::default();
    compile(&Request {
        symbols: &symbols,
        shared: None,
        measurands: &sources,
        units: &units,
    })
    .expect("the fixture's model is right")
}

/// Inputs and components that grow together.
#[derive(Default)]
struct Bench {
    inputs: Vec<Input>,
    components: Vec<Component>,
}

impl Bench {
    fn input(&mut self, name: &str, estimate: f64, symbol: &str) {
        let (name, unit) = (name.to_string(), unit(symbol));
        self.inputs.push(Input {
            name,
            description: None,
            group: None,
            unit,
            estimate,
            terms: Vec::new(),
        });
    }

    /// A component of the latest input.
    fn component(&mut self, label: &str, u: f64, dof: f64, distribution: Distribution, how: &str) {
        let i = self.inputs.len() - 1;
        let input = &mut self.inputs[i];
        input.terms.push(Term {
            component: self.components.len(),
            coefficient: 1.0,
        });
        let name = if label.is_empty() {
            input.name.clone()
        } else {
            format!("{}.{label}", input.name)
        };
        self.components.push(Component {
            name,
            label: if label.is_empty() {
                input.name.clone()
            } else {
                label.to_string()
            },
            owner: Owner::Input(i),
            unit: input.unit.clone(),
            distribution,
            u,
            dof,
            evaluation: if dof.is_finite() {
                Kind::TypeA
            } else {
                Kind::TypeB
            },
            how: how.to_string(),
            certificate: None,
            reference: None,
        });
    }

    fn budget(self, title: &str, measurands: &[(&str, &str, &str)]) -> Budget {
        let model = model(&self.inputs, measurands);
        Budget {
            heading: Heading {
                title: title.to_string(),
                ..Heading::default()
            },
            conventions: PROFILES[0].conventions(),
            monte_carlo: MonteCarloSettings {
                points: Points::Random,
                indices: false,
                seed: 1,
                trials: Trials::Fixed(1_000_000),
            },
            model,
            inputs: self.inputs,
            constants: Vec::new(),
            measurands: measurands
                .iter()
                .map(|(name, _, _)| Measurand {
                    name: (*name).to_string(),
                    description: None,
                })
                .collect(),
            components: self.components,
            groups: Vec::new(),
            following: Vec::new(),
            conformity: Vec::new(),
            detection: Vec::new(),
            fits: Vec::new(),
            claims: Vec::new(),
            analyses: Vec::new(),
            figures: Vec::new(),
            remarks: Vec::new(),
            chain: Default::default(),
        }
    }
}

fn normal(sd: f64) -> Distribution {
    Distribution::Normal { mean: 0.0, sd }
}

fn uniform(half: f64) -> Distribution {
    Distribution::Uniform {
        lower: -half,
        upper: half,
    }
}

/// Contributions of independent components under these sensitivities of the inputs.
fn gum(
    budget: &Budget,
    estimate: f64,
    c: &[f64],
    freedom: Freedom,
    k: f64,
    basis: CoverageBasis,
) -> Gum {
    let mut of_component = vec![0.0; budget.components.len()];
    for (input, c) in budget.inputs.iter().zip(c) {
        for term in &input.terms {
            of_component[term.component] += c * term.coefficient;
        }
    }
    let parts: Vec<f64> = of_component
        .iter()
        .zip(&budget.components)
        .map(|(c, e)| c * e.u)
        .collect();
    let u = parts.iter().map(|p| p * p).sum::<f64>().sqrt();
    let share = |x: f64| if u > 0.0 { x / (u * u) } else { 0.0 };
    let components = budget.components.iter().zip(&of_component).zip(&parts);
    let inputs = budget.inputs.iter().zip(c).map(|(input, c)| {
        let ux = input
            .terms
            .iter()
            .map(|t| (t.coefficient * budget.components[t.component].u).powi(2))
            .sum::<f64>()
            .sqrt();
        let covariance: f64 = input
            .terms
            .iter()
            .map(|t| c * t.coefficient * budget.components[t.component].u * parts[t.component])
            .sum();
        let dof = input
            .terms
            .iter()
            .map(|t| budget.components[t.component].dof)
            .fold(f64::INFINITY, f64::min);
        Contribution {
            sensitivity: *c,
            u: ux,
            contribution: c * ux,
            share: share(covariance),
            dof,
        }
    });
    Gum {
        estimate,
        u,
        inputs: inputs.collect(),
        components: components
            .map(|((e, c), part)| Contribution {
                sensitivity: *c,
                u: e.u,
                contribution: *part,
                share: share(part * part),
                dof: e.dof,
            })
            .collect(),
        freedom,
        coverage: Coverage {
            k,
            basis,
            probability: 0.95,
            expanded: k * u,
            half_width_for_p: k * u,
        },
    }
}

fn monte_carlo(estimate: f64, u: f64, symmetric: [f64; 2], shortest: [f64; 2]) -> MonteCarlo {
    MonteCarlo {
        estimate: Some(estimate),
        u: Some(u),
        median: estimate,
        symmetric,
        shortest,
        skewness: Some(0.01),
        excess_kurtosis: Some(0.2),
        standard_errors: [u / 1000.0; 4],
        failed: 0,
        histogram: Histogram {
            start: symmetric[0],
            width: u / 16.0,
            counts: vec![1, 2, 1],
        },
    }
}

fn run() -> Run {
    Run {
        trials: 1_000_000,
        seed: 1,
        coverage_probability: 0.95,
        adaptive: None,
        quasi: None,
    }
}

fn validations(delta: f64, d_low: f64, d_high: f64) -> [Validation; 2] {
    [(2, delta), (1, 10.0 * delta)].map(|(digits, delta)| Validation {
        digits,
        delta,
        d_low,
        d_high,
        error: 0.01 * delta,
        verdict: if d_low <= delta && d_high <= delta {
            Clause8::Validated
        } else {
            Clause8::NotValidated
        },
    })
}

fn alone(gum: Gum) -> Evaluation {
    let result = MeasurandResult {
        gum,
        second_order: None,
        monte_carlo: None,
        validation: None,
        basis: Basis::Gum,
    };
    Evaluation {
        results: vec![result],
        joint: None,
        run: None,
        conformity: Vec::new(),
        detection: Vec::new(),
        indices: None,
        findings: Vec::new(),
        figures: Vec::new(),
    }
}

/// Ohm's law: several components, finite ν, correlation, a claim, a validated Monte Carlo run.
pub(super) fn resistor() -> Case {
    let mut bench = Bench::default();
    bench.input("V", 1.00015, "V");
    bench.component(
        "repeatability",
        6.455e-5,
        3.0,
        Distribution::StudentT {
            location: 0.0,
            scale: 6.455e-5,
            dof: 3.0,
        },
        "s/√n = 1.291e-4/√4",
    );
    bench.component(
        "calibration",
        2.0e-5,
        f64::INFINITY,
        normal(2e-5),
        "U/k = 4.0e-5/2",
    );
    bench.component(
        "resolution",
        2.887e-6,
        f64::INFINITY,
        uniform(5e-6),
        "q/(2√3) = 1.0e-5/(2√3)",
    );
    bench.input("R", 100.02, "ohm");
    bench.component("", 0.005774, f64::INFINITY, uniform(0.01), "a/√3 = 0.01/√3");
    bench.inputs[0].description = Some("Voltmeter reading".to_string());
    bench.inputs[1].description = Some("Standard resistor".to_string());
    bench.components[1].certificate = Some(Certificate {
        number: Some("V-2026-118".to_string()),
        laboratory: Some("Metrology Institute".to_string()),
        date: None,
        due: Some("2027-03-01".to_string()),
    });
    let mut budget = bench.budget("Current through a resistor", &[("I", "V / R", "mA")]);
    budget.heading.method = Some("In-house procedure 12".to_string());
    budget.heading.date = Some("2026-11-20".to_string());
    budget.groups.push(Group {
        members: vec![1, 3],
        correlation: DMatrix::from_row_slice(2, 2, &[1.0, 0.3, 0.3, 1.0]),
        law: Law::Normal,
        dof: None,
    });
    let figure = |what, value, tolerance| ClaimedFigure {
        what,
        value,
        tolerance,
    };
    budget.claims.push(Claim {
        measurand: 0,
        method: ClaimedMethod::Unstated,
        figures: vec![
            figure(Figure::Estimate, 9.9995, 0.00005),
            figure(Figure::ExpandedUncertainty, 0.0019, 0.00005),
            figure(Figure::CoverageFactor, 2.0, 0.005),
            figure(Figure::Lower, 9.998, 0.0005),
            figure(Figure::Upper, 10.001, 0.0005),
        ],
        confidence: Confidence::High,
        digits: None,
        reference: Some("Certificate 17".to_string()),
        note: None,
    });
    budget.remarks.push(Remark {
        en: "The certificate V-2026-118 ends in three months.".to_string(),
        zh: "证书 V-2026-118 三个月后到期。".to_string(),
    });
    let first = gum(
        &budget,
        9.999500,
        &[9.998000, -0.0999750],
        Freedom::WelchSatterthwaite(11.42),
        2.20,
        CoverageBasis::StudentT { dof: 11.0 },
    );
    let u = first.u;
    let mut evaluation = alone(first);
    let result = &mut evaluation.results[0];
    result.monte_carlo = Some(monte_carlo(
        9.99950,
        1.06 * u,
        [9.9995 - 2.19 * u, 9.9995 + 2.21 * u],
        [9.9995 - 2.2 * u, 9.9995 + 2.19 * u],
    ));
    result.validation = Some(validations(5e-6, 8.7e-6, 8.9e-6));
    evaluation.run = Some(run());
    Case { budget, evaluation }
}

/// One measurand with one normal input and a normal k.
pub(super) fn plain() -> Case {
    let mut bench = Bench::default();
    bench.input("x", 1.2345678, "kg");
    bench.component(
        "",
        0.00042,
        f64::INFINITY,
        normal(0.00042),
        "U/k = 0.00084/2",
    );
    let mut budget = bench.budget("Mass", &[("m", "x", "kg")]);
    budget.conventions.coverage_probability = 0.9545;
    let first = gum(
        &budget,
        1.2345678,
        &[1.0],
        Freedom::Infinite,
        2.0,
        CoverageBasis::Normal,
    );
    let mut evaluation = alone(first);
    evaluation.results[0].gum.coverage.probability = 0.9545;
    Case { budget, evaluation }
}

/// JJF 1059.1: k = 2 by convention, p not stated.
pub(super) fn fixed_factor() -> Case {
    let mut case = plain();
    case.budget.conventions.profile = "JJF".to_string();
    case.budget.conventions.coverage_factor = CoverageRule::Fixed(2.0);
    case.budget.conventions.state_probability = false;
    case.evaluation.results[0].gum.coverage.basis = CoverageBasis::Fixed;
    case
}

/// k = 2 by convention, with the p that it happens to have.
pub(super) fn fixed_with_probability() -> Case {
    let mut case = fixed_factor();
    case.budget.conventions.profile = "NIST".to_string();
    case.budget.conventions.state_probability = true;
    case.evaluation.results[0].gum.coverage.probability = 0.9545;
    case
}

/// JJF 1059.1 with a k found for p: U_95, k_95 and ν_eff are stated.
pub(super) fn apart_with_probability() -> Case {
    let mut case = resistor();
    case.budget.conventions.profile = "JJF".to_string();
    case
}

/// JJF 1059.1 where a rectangle dominates, stated as U_95.
pub(super) fn apart_rectangular() -> Case {
    let mut bench = Bench::default();
    bench.input("t", 20.03, "K");
    bench.component("", 0.0577, f64::INFINITY, uniform(0.1), "a/√3 = 0.1/√3");
    let mut budget = bench.budget("Temperature", &[("t_90", "t", "K")]);
    budget.conventions.profile = "JJF".to_string();
    let basis = CoverageBasis::Output {
        dominant: vec!["t".to_string()],
        shape: "rectangular",
    };
    let first = gum(&budget, 20.03, &[1.0], Freedom::Infinite, 1.65, basis);
    Case {
        budget,
        evaluation: alone(first),
    }
}

/// Correlated components with different ν.
pub(super) fn refused_freedom() -> Case {
    let mut case = plain();
    let members = vec!["x".to_string(), "z".to_string()];
    case.evaluation.results[0].gum.freedom = Freedom::Refused {
        lower_bound: 4.0,
        members: members.clone(),
    };
    case.evaluation.results[0].gum.coverage.basis = CoverageBasis::StudentT { dof: 4.0 };
    case.evaluation.results[0].gum.coverage.k = 2.87;
    let find = |kind| Finding {
        measurand: Some(0),
        kind,
    };
    case.evaluation.findings = vec![
        find(FindingKind::FreedomRefused {
            members,
            lower_bound: 4.0,
        }),
        find(FindingKind::FewDegreesOfFreedom { dof: 4.0 }),
        find(FindingKind::NeedsMonteCarlo),
        find(FindingKind::NotConverged {
            trials: 100_000_000,
        }),
    ];
    case
}

/// A rectangle dominates; small numbers, so that a power of ten is needed.
pub(super) fn rectangular() -> Case {
    let mut bench = Bench::default();
    bench.input("K", 2.61234e-3, "A/g");
    bench.component(
        "",
        1.4434e-8,
        f64::INFINITY,
        uniform(2.5e-8),
        "a/√3 = 2.5e-8/√3",
    );
    let mut budget = bench.budget("Scale factor", &[("K1", "K", "A/g")]);
    budget.conventions.profile = "EA".to_string();
    let basis = CoverageBasis::Output {
        dominant: vec!["K".to_string()],
        shape: "rectangular",
    };
    let first = gum(&budget, 2.61234e-3, &[1.0], Freedom::Infinite, 1.65, basis);
    Case {
        budget,
        evaluation: alone(first),
    }
}

/// A vanishing sensitivity: only Monte Carlo and second order see it, and the output is one-sided.
pub(super) fn asymmetric() -> Case {
    let mut bench = Bench::default();
    bench.input("theta", 0.0, "rad");
    bench.component("", 0.001, f64::INFINITY, normal(0.001), "stated");
    bench.input("g", 9.8, "m/s^2");
    bench.component("", 1e-7, f64::INFINITY, normal(1e-7), "stated");
    let budget = bench.budget("Tilt", &[("a", "g * cos(theta)", "m/s^2")]);
    let first = gum(
        &budget,
        9.8,
        &[0.0, 1.0],
        Freedom::Infinite,
        1.96,
        CoverageBasis::Normal,
    );
    let mut evaluation = alone(first);
    let result = &mut evaluation.results[0];
    result.second_order = Some(SecondOrder {
        shift: -4.9e-6,
        u: 6.93e-6,
        matters: true,
    });
    let mut mc = monte_carlo(
        9.7999951,
        6.94e-6,
        [9.7999754, 9.8000000],
        [9.7999812, 9.8000002],
    );
    mc.skewness = Some(-2.83);
    mc.excess_kurtosis = Some(12.0);
    result.monte_carlo = Some(mc);
    result.validation = Some(validations(5e-9, 2.44e-5, 2.0e-7));
    result.basis = Basis::MonteCarlo;
    evaluation.run = Some(run());
    let find = |kind| Finding {
        measurand: Some(0),
        kind,
    };
    evaluation.findings = vec![
        find(FindingKind::VanishingSensitivity {
            inputs: vec!["theta".to_string()],
            shift: -4.9e-6,
            u_effect: 6.93e-6,
            matters: true,
        }),
        find(FindingKind::SecondOrderMatters {
            shift: -4.9e-6,
            u_first: 1e-7,
            u_second: 6.93e-6,
        }),
        find(FindingKind::NotValidated),
        find(FindingKind::Asymmetric),
    ];
    Case { budget, evaluation }
}

/// Not validated, but symmetric: U is half the width of the Monte Carlo interval.
pub(super) fn from_trials() -> Case {
    let mut case = plain();
    let half = 0.00074;
    let interval = [1.2345678 - half, 1.2345678 + half];
    let result = &mut case.evaluation.results[0];
    result.monte_carlo = Some(monte_carlo(1.2345678, 0.00042, interval, interval));
    result.validation = Some(validations(5e-6, 1e-4, 1e-4));
    result.basis = Basis::MonteCarlo;
    case.evaluation.run = Some(run());
    case.evaluation.findings = vec![Finding {
        measurand: Some(0),
        kind: FindingKind::NotValidated,
    }];
    case
}

/// The same in the manner of JJF 1059.1.
pub(super) fn from_trials_apart() -> Case {
    let mut case = from_trials();
    case.budget.conventions.profile = "JJF".to_string();
    case.budget.conventions.state_probability = false;
    case
}

/// A fixed k whose probability Monte Carlo does not confirm, though it confirms y and u.
pub(super) fn fixed_unconfirmed() -> Case {
    let mut case = from_trials();
    case.budget.conventions.profile = "NIST".to_string();
    case.budget.conventions.coverage_factor = CoverageRule::Fixed(2.0);
    let result = &mut case.evaluation.results[0];
    result.gum.coverage.k = 2.0;
    result.gum.coverage.basis = CoverageBasis::Fixed;
    result.basis = Basis::Gum;
    case
}

/// A ratio whose moments do not exist.
pub(super) fn without_moments() -> Case {
    let mut bench = Bench::default();
    bench.input("a", 1.0, "1");
    bench.component("", 0.1, f64::INFINITY, normal(0.1), "stated");
    bench.input("b", 0.2, "1");
    bench.component("", 0.1, f64::INFINITY, normal(0.1), "stated");
    let budget = bench.budget("Ratio", &[("y", "a / b", "1")]);
    let first = gum(
        &budget,
        5.0,
        &[5.0, -25.0],
        Freedom::Infinite,
        1.96,
        CoverageBasis::Normal,
    );
    let mut evaluation = alone(first);
    let result = &mut evaluation.results[0];
    let mut mc = monte_carlo(0.0, 1.0, [-23.4, 41.7], [-18.2, 44.1]);
    (
        mc.estimate,
        mc.u,
        mc.skewness,
        mc.excess_kurtosis,
        mc.median,
    ) = (None, None, None, None, 4.93);
    mc.failed = 3;
    result.monte_carlo = Some(mc);
    result.basis = Basis::MonteCarlo;
    evaluation.run = Some(run());
    let find = |kind| Finding {
        measurand: Some(0),
        kind,
    };
    evaluation.findings = vec![
        find(FindingKind::MomentsMissing {
            reason: MissingMoments::Tail {
                side: Side::Upper,
                index: 1.0,
                consequence: Consequence::NoMean,
            },
        }),
        find(FindingKind::FailedTrials {
            failed: 3,
            trials: 1_000_000,
        }),
        find(FindingKind::NearSingular {
            what: Notice::Near {
                argument: "b".to_string(),
                role: Office::Divisor,
                distance: 2.0,
                edge: 0.0,
            },
        }),
    ];
    Case { budget, evaluation }
}

/// Two measurands of one table, with a shared source, groups of inputs, and an input that acts on one.
pub(super) fn joint() -> Case {
    let mut bench = Bench::default();
    bench.input("E1", 1.0021, "V");
    bench.component(
        "noise",
        0.0004,
        9.0,
        Distribution::StudentT {
            location: 0.0,
            scale: 0.0004,
            dof: 9.0,
        },
        "s/√n = 1.26e-3/√10",
    );
    bench.input("E2", -0.9979, "V");
    bench.component(
        "noise",
        0.0004,
        9.0,
        Distribution::StudentT {
            location: 0.0,
            scale: 0.0004,
            dof: 9.0,
        },
        "s/√n = 1.26e-3/√10",
    );
    bench.input("t", 20.0, "K");
    bench.component("", 0.1, f64::INFINITY, uniform(0.1732), "a/√3 = 0.1732/√3");
    bench.components.push(Component {
        name: "voltmeter".to_string(),
        label: "voltmeter".to_string(),
        owner: Owner::Source("voltmeter".to_string()),
        unit: unit("V"),
        distribution: Distribution::Empirical {
            sample: Arc::from([-0.0003, 0.0, 0.0003]),
        },
        u: 0.0002,
        dof: f64::INFINITY,
        evaluation: Kind::TypeB,
        how: "sample of 3".to_string(),
        certificate: None,
        reference: Some("Manual, p. 12".to_string()),
    });
    for i in 0..2 {
        bench.inputs[i].terms.push(Term {
            component: 3,
            coefficient: 1.0,
        });
        bench.inputs[i].group = Some("readings".to_string());
    }
    bench.inputs[2].group = Some("environment".to_string());
    let mut budget = bench.budget(
        "Two positions",
        &[
            ("K0", "(E1 + E2) / 2", "V"),
            ("K1", "(E1 - E2) / 2 + 0.001 * t", "V"),
        ],
    );
    budget.measurands[0].description = Some("Bias".to_string());
    let welch = |v| Freedom::WelchSatterthwaite(v);
    let student = |dof| CoverageBasis::StudentT { dof };
    let bias = gum(
        &budget,
        0.0021,
        &[0.5, 0.5, 0.0],
        welch(31.6),
        2.04,
        student(31.0),
    );
    let scale = gum(
        &budget,
        1.02,
        &[0.5, -0.5, 0.001],
        welch(20.8),
        2.09,
        student(20.0),
    );
    let mut evaluation = alone(bias);
    evaluation.results.push(MeasurandResult {
        gum: scale,
        ..evaluation.results[0].clone()
    });
    let correlation = DMatrix::from_row_slice(2, 2, &[1.0, -0.042, -0.042, 1.0]);
    evaluation.joint = Some(JointResult {
        covariance: DMatrix::from_row_slice(2, 2, &[1.2e-7, -4e-9, -4e-9, 0.9e-7]),
        correlation: correlation.clone(),
        monte_carlo_covariance: Some(DMatrix::from_row_slice(
            2,
            2,
            &[1.3e-7, -4e-9, -4e-9, 0.95e-7],
        )),
        monte_carlo_correlation: Some(correlation),
        dof: Freedom::WelchSatterthwaite(18.2),
        k_ellipsoid: 2.73,
        k_rectangle: 2.41,
        regions: Some(Regions {
            k_ellipsoid: 2.75,
            k_rectangle: 2.43,
            ellipsoid_volume: 2.6e-6,
            smallest_volume: Some(2.55e-6),
            smallest_cells: Some(812),
        }),
        degenerate: false,
    });
    for (m, result) in evaluation.results.iter_mut().enumerate() {
        let (y, u) = (result.gum.estimate, result.gum.u);
        result.monte_carlo = Some(monte_carlo(
            y,
            u,
            [y - 2.05 * u, y + 2.05 * u],
            [y - 2.05 * u, y + 2.04 * u],
        ));
        result.validation = Some(validations(5e-6, if m == 0 { 3e-6 } else { 4e-6 }, 3e-6));
    }
    evaluation.run = Some(run());
    evaluation.findings.push(Finding {
        measurand: Some(1),
        kind: FindingKind::Irregular {
            what: Notice::Kink {
                call: "abs(t)".to_string(),
                argument: "t".to_string(),
            },
        },
    });
    Case { budget, evaluation }
}

/// A thousand inputs, forty of which matter.
pub(super) fn long() -> Case {
    let mut bench = Bench::default();
    for i in 0..1000 {
        bench.input(&format!("x[{}]", i + 1), 0.0, "mm");
        let u = if i % 50 == 0 { 1.0 } else { 0.01 };
        bench.component("", u, f64::INFINITY, normal(u), "stated");
    }
    let budget = bench.budget(
        "A thousand",
        &[("y", "x[1] + x[2]", "mm")].map(|(n, _, u)| (n, "1 + 1", u)),
    );
    let first = gum(
        &budget,
        0.0,
        &vec![1.0; 1000],
        Freedom::Infinite,
        1.96,
        CoverageBasis::Normal,
    );
    Case {
        budget,
        evaluation: alone(first),
    }
}
