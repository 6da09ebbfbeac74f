//! Every procedure of the library, on the recordings of `experiments/`: estimates against another algorithm,
//! uncertainties and covariances against the scatter of simulated calibrations and against written budgets.

use crate::common::{self, evaluation};
use std::collections::BTreeSet;

use gumption::calibrate::{
    Calibration, Campaign, Origin, Scatter, budget, calibrate, estimates, read,
};
use gumption::distribution::Distribution as Shape;
use gumption::experiment::procedure::PROCEDURES;
use gumption::experiment::{Doubt, Purpose, Scope, Target};
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal, Uniform};

/// A file of `experiments/` and what comes of it.
struct Example {
    name: String,
    campaign: Campaign,
    found: Calibration,
}

fn example(name: &str, toml: &str) -> Example {
    let folder = common::root().join("experiments");
    let campaign = read(toml, name, &folder, Purpose::Calibrate)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let found = calibrate(&campaign).expect("coefficients");
    Example {
        name: name.to_owned(),
        campaign,
        found,
    }
}

/// All calibrations, and the two procedures of 7.2.5 that have no file of their own.
fn examples() -> Vec<Example> {
    let mut all = Vec::new();
    for path in common::calibrations() {
        let toml = std::fs::read_to_string(&path).expect("a file");
        if !toml.contains("[recording]") {
            continue;
        }
        let name = path.file_name().expect("a name").to_string_lossy();
        all.push(example(&name, &toml));
        if toml.contains("rate-sensitivity-both") {
            for other in ["rate-sensitivity", "rate-sensitivity-squared"] {
                let toml = toml.replace("rate-sensitivity-both", other);
                all.push(example(&format!("{name} by {other}"), &toml));
            }
        }
    }
    let of_example = |one: &Example| one.campaign.experiment.heading.procedure.clone();
    let seen: BTreeSet<String> = all.iter().filter_map(of_example).collect();
    let names = PROCEDURES.iter().map(|one| one.name.to_owned());
    assert_eq!(seen, names.collect(), "every procedure of the library");
    all
}

/// An estimator that shares nothing with the program's but the equations: numerical derivatives, columns of
/// length one, and the pseudoinverse by singular values.
struct Other<'e> {
    campaign: &'e Campaign,
    /// Point and response of each reading.
    rows: Vec<(usize, usize)>,
    /// Partly known parameters: place, value, standard uncertainty.
    priors: Vec<(usize, f64, f64)>,
    /// Standard deviation of a reading of each response, for its weight.
    weight: Vec<f64>,
    /// Where derivatives are taken.
    at: Vec<f64>,
    /// Changes of the parameters by the observed values.
    gain: DMatrix<f64>,
}

impl<'e> Other<'e> {
    fn new(example: &'e Example) -> Other<'e> {
        let (campaign, found) = (&example.campaign, &example.found);
        let count = campaign.experiment.parameters.len();
        let coefficients = &found.figures.coefficients[..count];
        let priors: Vec<(usize, f64, f64)> = campaign
            .experiment
            .parameters
            .iter()
            .enumerate()
            .filter_map(|(place, p)| p.known.map(|known| (place, known.value, known.u)))
            .collect();
        let responses = &found.responses;
        let deviation =
            |r: usize| responses[r].rms * (responses[r].readings as f64 / responses[r].dof).sqrt();
        let weight = |r: usize| if priors.is_empty() { 1.0 } else { deviation(r) };
        let mut other = Other {
            campaign,
            rows: rows(campaign),
            weight: (0..responses.len()).map(weight).collect(),
            priors,
            at: coefficients.iter().map(|one| one.value).collect(),
            gain: DMatrix::zeros(0, 0),
        };
        let steps: Vec<f64> = coefficients.iter().map(|one| one.u).collect();
        other.gain = other.gain_at(&steps);
        other
    }

    fn nominal(&self) -> Vec<f64> {
        let inputs = self.campaign.experiment.inputs.iter();
        inputs.map(|input| input.value).collect()
    }

    fn value(&self, row: usize, parameters: &[f64], columns: &[f64], inputs: &[f64]) -> f64 {
        let symbols: Vec<f64> = [columns, parameters, inputs].concat();
        self.campaign
            .experiment
            .equations
            .value(self.rows[row].1, &symbols)
    }

    fn columns(&self, row: usize) -> Vec<f64> {
        let columns = self.campaign.experiment.columns.iter();
        let value = |name: &str| {
            let column = self.campaign.points.column(name);
            column.map_or(f64::NAN, |column| column.values[self.rows[row].0])
        };
        columns.map(|column| value(&column.name)).collect()
    }

    /// The equations of all rows, then the parameters that are partly known.
    fn model(&self, parameters: &[f64]) -> DVector<f64> {
        let inputs = self.nominal();
        let readings = (0..self.rows.len())
            .map(|row| self.value(row, parameters, &self.columns(row), &inputs));
        let priors = self.priors.iter().map(|(place, ..)| parameters[*place]);
        DVector::from_iterator(self.rows.len() + self.priors.len(), readings.chain(priors))
    }

    fn weights(&self) -> Vec<f64> {
        let readings = self.rows.iter().map(|(_, response)| self.weight[*response]);
        readings
            .chain(self.priors.iter().map(|(.., u)| *u))
            .collect()
    }

    fn gain_at(&self, steps: &[f64]) -> DMatrix<f64> {
        let weights = self.weights();
        let column = |place: usize| {
            let moved = |by: f64| {
                let mut parameters = self.at.clone();
                parameters[place] += by * steps[place];
                self.model(&parameters)
            };
            let mut slope = (moved(1.0) - moved(-1.0)) / (2.0 * steps[place]);
            for (slope, weight) in slope.iter_mut().zip(&weights) {
                *slope /= weight;
            }
            slope
        };
        let columns: Vec<DVector<f64>> = (0..steps.len()).map(column).collect();
        let lengths: Vec<f64> = columns.iter().map(|column| column.norm()).collect();
        let scaled: Vec<DVector<f64>> = columns.iter().map(|c| c / c.norm()).collect();
        let inverse = DMatrix::from_columns(&scaled)
            .pseudo_inverse(1e-12)
            .expect("singular values");
        DMatrix::from_fn(inverse.nrows(), inverse.ncols(), |i, j| {
            inverse[(i, j)] / (lengths[i] * weights[j])
        })
    }

    /// Parameters from observed values, by steps with the derivatives at [`Other::at`].
    fn solve(&self, observed: &DVector<f64>, start: Vec<f64>, steps: usize) -> Vec<f64> {
        let mut parameters = start;
        for _ in 0..steps {
            let change = &self.gain * (observed - self.model(&parameters));
            for (parameter, change) in parameters.iter_mut().zip(change.iter()) {
                *parameter += change;
            }
        }
        parameters
    }

    /// Parameters, then results.
    fn with_results(&self, parameters: Vec<f64>) -> Vec<f64> {
        let symbols = [parameters.as_slice(), &self.nominal()].concat();
        let results = self.campaign.results.iter();
        let results: Vec<f64> = results
            .map(|result| result.equation.value(0, &symbols))
            .collect();
        [parameters, results].concat()
    }
}

/// Point and response of every reading that is there.
fn rows(campaign: &Campaign) -> Vec<(usize, usize)> {
    let responses = campaign.experiment.equations.responses().len();
    (0..campaign.points.len())
        .flat_map(|point| (0..responses).map(move |response| (point, response)))
        .collect()
}

/// What was observed, and what is known of parameters.
fn observed(example: &Example, other: &Other<'_>) -> DVector<f64> {
    let readings = example.found.residuals.iter().map(|one| one.observed);
    let priors = other.priors.iter().map(|(_, value, _)| *value);
    DVector::from_iterator(
        other.rows.len() + other.priors.len(),
        readings.chain(priors),
    )
}

#[test]
fn estimates_are_those_of_another_algorithm() {
    for example in examples() {
        let other = Other::new(&example);
        assert_eq!(
            example.found.residuals.len(),
            other.rows.len(),
            "{}",
            example.name
        );
        let coefficients = &example.found.figures.coefficients;
        let start = other
            .at
            .iter()
            .zip(coefficients)
            .map(|(value, one)| value + 3.0 * one.u);
        let parameters = other.solve(&observed(&example, &other), start.collect(), 20);
        for (value, one) in other.with_results(parameters).iter().zip(coefficients) {
            assert!(
                (value - one.value).abs() < 1e-4 * one.u,
                "{}: {} is {} and {value}, u = {}",
                example.name,
                one.name,
                one.value,
                one.u
            );
        }
    }
}

/// Simulated calibrations of each example.
const TRIALS: usize = 10_000;

/// Five standard errors: some thousand figures are compared.
const ALLOWED: f64 = 5.0;

/// The errors of a doubt in every point.
fn drawn(doubt: &Doubt, campaign: &Campaign, random: &mut StdRng) -> Vec<f64> {
    let one = |random: &mut StdRng| match &doubt.distribution {
        Shape::Uniform(limits) => Uniform::new_inclusive(limits.lower, limits.upper)
            .expect("a width")
            .sample(random),
        _ => Normal::new(0.0, doubt.u).expect("a width").sample(random),
    };
    let points = campaign.points.len();
    match &doubt.scope {
        Scope::Common => vec![one(random); points],
        Scope::Each => (0..points).map(|_| one(random)).collect(),
        Scope::By(name) => {
            let labels = campaign.points.labels(name).expect("labels");
            let of_level: Vec<f64> = labels.levels.iter().map(|_| one(random)).collect();
            let levels = labels.of_row.iter();
            levels.map(|level| of_level[*level as usize]).collect()
        }
    }
}

/// Observed values of a calibration whose true coefficients are the estimates of the example, with errors as
/// the file states them and the scatter that was found.
fn simulated(example: &Example, other: &Other<'_>, random: &mut StdRng) -> DVector<f64> {
    let campaign = &example.campaign;
    let points = campaign.points.len();
    let mut inputs = vec![other.nominal(); points];
    let mut columns: Vec<Vec<f64>> = (0..other.rows.len())
        .map(|row| other.columns(row))
        .collect();
    let mut added = vec![0.0; other.rows.len()];
    // What acts at all: of an output of which all residuals count, these contain the errors of each reading.
    let acts = |doubt: &&Doubt| {
        let mut causes = example.found.figures.causes.iter();
        causes.any(
            |cause| matches!(&cause.origin, Origin::Stated { name, .. } if *name == doubt.name),
        )
    };
    for doubt in campaign.experiment.doubts.iter().filter(acts) {
        let errors = drawn(doubt, campaign, random);
        for act in &doubt.acts {
            if let Target::Input(place) = act.on {
                for (inputs, error) in inputs.iter_mut().zip(&errors) {
                    inputs[place] += act.coefficient * error;
                }
            }
            for (row, (point, response)) in other.rows.iter().enumerate() {
                let error = act.coefficient * errors[*point];
                let response = &campaign.experiment.equations.responses()[*response].name;
                match &act.on {
                    Target::Input(place)
                        if campaign.experiment.inputs[*place].name == *response =>
                    {
                        added[row] += error
                    }
                    Target::Reading(name) if name == response => added[row] += error,
                    Target::Reading(name) => {
                        let place = campaign
                            .experiment
                            .columns
                            .iter()
                            .position(|c| c.name == *name);
                        columns[row][place.expect("a column")] -= error;
                    }
                    Target::Input(_) => {}
                }
            }
        }
    }
    let scatter = |response: usize| match example.found.scatter {
        Scatter::Residuals => example.found.responses[response].own,
        _ => 0.0,
    };
    let readings: Vec<f64> = (0..other.rows.len())
        .map(|row| {
            let (point, response) = other.rows[row];
            let noise: f64 = Normal::new(0.0, scatter(response))
                .expect("a width")
                .sample(random);
            other.value(row, &other.at, &columns[row], &inputs[point]) + added[row] + noise
        })
        .collect();
    let priors: Vec<f64> = other
        .priors
        .iter()
        .map(|(place, _, u)| {
            other.at[*place] + Normal::new(0.0, *u).expect("a width").sample(random)
        })
        .collect();
    DVector::from_vec([readings, priors].concat())
}

/// The example with other observed values, for the program itself.
fn replaced(example: &Example, other: &Other<'_>, observed: &DVector<f64>) -> Option<Campaign> {
    let mut campaign = example.campaign.clone();
    for ((point, response), value) in other.rows.iter().zip(observed.iter()) {
        let name = &campaign.experiment.equations.responses()[*response].name;
        let mut columns = campaign.points.columns.iter_mut();
        columns.find(|column| column.name == *name)?.values[*point] = *value;
    }
    let readings = other.rows.len();
    for ((place, ..), value) in other.priors.iter().zip(observed.iter().skip(readings)) {
        campaign.experiment.parameters[*place].known.as_mut()?.value = *value;
    }
    Some(campaign)
}

fn scatters_as_predicted(example: &Example) {
    let other = Other::new(example);
    let name = &example.name;
    let mut random = StdRng::seed_from_u64(2003);
    let steps = if example.found.linear { 1 } else { 2 };
    let predicted = &example.found.figures.covariance;
    let count = predicted.nrows();
    let centre = other.with_results(other.at.clone());
    let mut sums = DVector::zeros(count);
    let mut products = DMatrix::zeros(count, count);
    for trial in 0..TRIALS {
        let observed = simulated(example, &other, &mut random);
        let found = other.with_results(other.solve(&observed, other.at.clone(), steps));
        if trial < 5
            && let Some(campaign) = replaced(example, &other, &observed)
        {
            // The program itself; with partly known parameters its weights follow the scatter of the trial.
            let own = estimates(&campaign).expect("coefficients");
            let allowed = if other.priors.is_empty() { 1e-3 } else { 0.5 };
            for (i, (a, b)) in own.iter().zip(&found).enumerate() {
                let u = predicted[(i, i)].sqrt();
                assert!((a - b).abs() < allowed * u, "{name}: {a} and {b}, u = {u}");
            }
        }
        let off = DVector::from_vec(found) - DVector::from_column_slice(&centre);
        sums += &off;
        products += &off * off.transpose();
    }
    let n = TRIALS as f64;
    let mean = sums / n;
    let covariance = products / n - &mean * mean.transpose();
    let coefficients = &example.found.figures.coefficients;
    for i in 0..count {
        let ratio = (covariance[(i, i)] / predicted[(i, i)]).sqrt();
        assert!(
            (ratio - 1.0).abs() < ALLOWED / (2.0 * n).sqrt(),
            "{name}: u({}) is {ratio} of what was predicted",
            coefficients[i].name
        );
        for j in 0..i {
            let r = predicted[(i, j)] / (predicted[(i, i)] * predicted[(j, j)]).sqrt();
            let found = covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
            assert!(
                (found - r).abs() < ALLOWED * (1.0 - r * r + 0.02) / n.sqrt(),
                "{name}: r({}, {}) is {found}, predicted {r}",
                coefficients[i].name,
                coefficients[j].name
            );
        }
    }
}

#[test]
fn ten_thousand_calibrations_scatter_as_predicted() {
    let examples = examples();
    let next = std::sync::atomic::AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(one) =
                    examples.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed))
                {
                    scatters_as_predicted(one);
                }
            });
        }
    });
}

#[test]
fn written_budgets_give_the_same_uncertainties() {
    for example in examples() {
        let name = &example.name;
        let figures = &example.found.figures;
        let all: Vec<usize> = (0..figures.coefficients.len()).collect();
        let text = budget(
            &example.campaign,
            &example.found,
            &all,
            gumption::report::Language::English,
        ) + "\n[monte_carlo]\ntrials = 20000\n";
        let evaluated = evaluation::evaluate(&text);
        assert_eq!(evaluated.results.len(), all.len(), "{name}");
        assert_eq!(evaluated.joint.is_some(), all.len() > 1, "{name}");
        // Errors with degrees of freedom of their own have the least of the coefficients together.
        let is_one = figures.causes.iter().all(|cause| cause.dof.len() == 1);
        for (one, result) in figures.coefficients.iter().zip(&evaluated.results) {
            let u = result.gum.u;
            assert!(
                (u / one.u - 1.0).abs() < 1e-6,
                "{name}: u({}) {u} for {}",
                one.name,
                one.u
            );
            let dof = result.gum.freedom.value();
            let ratio = match one.dof.is_infinite() && dof.is_infinite() {
                true => 1.0,
                false => dof / one.dof,
            };
            assert!(
                ratio > 0.0 && ratio < 1.0 + 1e-6 && (!is_one || ratio > 1.0 - 1e-6),
                "{name}: ν({}) {dof} for {}",
                one.name,
                one.dof
            );
        }
        if let Some(joint) = &evaluated.joint {
            let scale = |i: usize, j: usize| figures.coefficients[i].u * figures.coefficients[j].u;
            for i in all.clone() {
                for j in all.clone() {
                    let off = (joint.covariance[(i, j)] - figures.covariance[(i, j)]) / scale(i, j);
                    assert!(
                        off.abs() < 1e-6,
                        "{name}: covariance {i}, {j} is off by {off} u·u"
                    );
                }
            }
        }
    }
}

/// A temperature is a point of its scale, and what errors do to it is a difference.
#[test]
fn a_written_budget_of_a_temperature_can_be_evaluated() {
    let readings = [
        (1.0, 20.3),
        (2.0, 20.5),
        (3.0, 20.8),
        (4.0, 20.9),
        (5.0, 21.2),
    ];
    let rows = readings.map(|(p, t)| format!("{p},{t},{t}\n"));
    let folder = common::cases::folder("temperature-budget");
    std::fs::write(
        folder.join("run.csv"),
        format!("P [W],T [°C],T_2 [°C]\n{}", rows.concat()),
    )
    .expect("written");
    let toml = "title = \"Warmth\"\nequations = [\"T = T_0 + R*P + error\"]\nrecording = \"run.csv\"\n[parameter]\nT_0 = {}\nR = {}\n\
                [input.error]\nunit = \"K\"\nu = 0.05\n";
    let campaign = read(toml, "case.toml", &folder, Purpose::Calibrate)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let found = calibrate(&campaign).expect("coefficients");
    let text = budget(
        &campaign,
        &found,
        &[0, 1],
        gumption::report::Language::English,
    );
    let evaluated = evaluation::evaluate(&format!("{text}\n[monte_carlo]\ntrials = 20000\n"));
    for (one, result) in found.figures.coefficients.iter().zip(&evaluated.results) {
        assert!((result.gum.u / one.u - 1.0).abs() < 1e-9, "{}", one.name);
    }
}
