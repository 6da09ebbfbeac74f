//! Points that are averages of rows: what is stated of one row counts for each of them.

use super::super::{Campaign, calibrate};
use super::{campaign, near};

const DWELLS: usize = 4;
const ROWS: usize = 9;

/// Rows of U = 2 x + 0.5 at four positions, with errors that are known and alternate, so that they have no serial correlation;
/// `u` is the standard uncertainty of each row.
fn csv() -> String {
    let rows = (0..DWELLS).flat_map(|dwell| (0..ROWS).map(move |row| (dwell, row)));
    let lines = rows.map(|(dwell, row)| {
        let (x, error) = (
            dwell as f64,
            0.01 * ((row * 5 + dwell) % ROWS) as f64 - 0.04,
        );
        format!("{x},P{dwell},{},0.03\n", 2.0 * x + 0.5 + error)
    });
    format!("x,pos,U,uu\n{}", lines.collect::<String>())
}

fn line(recording: &str, rest: &str) -> Campaign {
    let toml = format!(
        "title = \"Line\"\nequations = [\"U = K*x + b\"]\n[parameter]\nK = {{}}\nb = {{}}\n\
         [recording]\nfile = \"run.csv\"\n{recording}\n[columns]\nx = \"stimulus\"\npos = \"label\"\nU = \"output\"\n{rest}\n"
    );
    campaign(&toml, &csv())
}

/// u and ν of the slope.
fn slope(recording: &str, rest: &str) -> (f64, f64) {
    let found = calibrate(&line(recording, rest)).expect("coefficients");
    let slope = &found.figures.coefficients[0];
    (slope.u, slope.dof)
}

/// u of the slope of 36 rows with σ each: σ/√Σ(x − x̄)², Σ = 9·5.
fn expected(sigma: f64) -> f64 {
    sigma / (ROWS as f64 * 5.0).sqrt()
}

const WAYS: [&str; 3] = [
    "average = \"none\"",
    "average = \"none\"\ntogether = [\"pos\"]",
    "dwells = [\"pos\"]",
];

#[test]
fn noise_of_a_row_averages() {
    for way in WAYS {
        let (u, _) = slope(way, "[noise]\nu = 0.03");
        near(u, expected(0.03), 1e-9);
    }
}

/// The residuals are held against the noise that is stated, whether rows are averaged or not: samples show the same once more.
#[test]
fn stated_noise_is_expected_once() {
    for way in WAYS {
        let found = calibrate(&line(way, "[noise]\nu = 0.03")).expect("coefficients");
        let test = found.responses[0].test.expect("a test");
        let rows = if way == WAYS[0] { 1.0 } else { ROWS as f64 };
        near(test.expected, 0.03 / rows.sqrt(), 1e-9);
    }
}

#[test]
fn errors_of_each_reading_average_where_points_do() {
    for way in &WAYS[..2] {
        let (u, _) = slope(way, "[noise]\nfrom = \"stated\"\n[reading.U]\nu = 0.03");
        near(u, expected(0.03), 1e-9);
        let (u, _) = slope(way, "uu = \"u\"");
        near(u, expected(0.03), 1e-9);
    }
}

#[test]
fn replicates_are_the_rows_before_they_are_averaged() {
    let scatter: f64 = (0..ROWS).map(|k| (0.01 * k as f64 - 0.04).powi(2)).sum();
    let s = (scatter / (ROWS as f64 - 1.0)).sqrt();
    for way in &WAYS[..2] {
        let (u, dof) = slope(way, "[noise]\nreplicates = [\"pos\"]");
        near(u, expected(s), 1e-9);
        near(dof, (DWELLS * (ROWS - 1)) as f64, 1e-9);
    }
}

#[test]
fn rows_without_a_label_belong_to_no_average() {
    let toml = "title = \"Line\"\nequations = [\"U = K*x\"]\n[parameter]\nK = {}\n[recording]\nfile = \"run.csv\"\naverage = \"none\"\n\
                together = [\"pos\"]\n[columns]\nx = \"stimulus\"\npos = \"label\"\nU = \"output\"\n[noise]\nu = 0.1\n";
    let found = campaign(toml, "x,pos,U\n1,A,2\n1,A,2\n2,,9\n4,,9\n3,B,6\n");
    assert_eq!(found.points.len(), 2);
    assert_eq!(found.points.merged, [2, 1]);
}

/// Points with a label share an error of that label; those without share none.
#[test]
fn rows_without_a_label_share_no_error() {
    let toml = "title = \"Mean\"\nequations = [\"U = b\"]\n[parameter]\nb = {}\n[recording]\nfile = \"run.csv\"\naverage = \"none\"\n\
                [columns]\nrun = \"label\"\nU = \"output\"\n[noise]\nfrom = \"stated\"\n[reading.U]\nu = 1\nby = \"run\"\n";
    let u = |csv: &str| {
        let found = calibrate(&campaign(toml, csv)).expect("coefficients");
        found.figures.coefficients[0].u
    };
    // The mean of four: errors of A twice, and of two rows by themselves.
    near(u("run,U\nA,1\nA,2\n,1\n,2\n"), 6f64.sqrt() / 4.0, 1e-12);
    near(u("run,U\nA,1\nA,2\nB,1\nB,2\n"), 8f64.sqrt() / 4.0, 1e-12);
}

/// A row that is the mean of n readings has 1/n of the variance of one.
#[test]
fn the_noise_of_one_reading_is_less_in_rows_of_many() {
    let rows = [(0.0, 1.0), (1.0, 4.0), (2.0, 9.0), (3.0, 16.0)];
    let lines = rows.map(|(x, count)| format!("{x},{count},{}\n", 2.0 * x + 0.5));
    let csv = format!("x,n,U\n{}", lines.concat());
    let toml = "title = \"Counts\"\nequations = [\"U = K*x + b\"]\nweights = \"readings\"\nnoise.u = 0.3\n[parameter]\nK = {}\nb = {}\n\
                [recording]\nfile = \"run.csv\"\n[columns]\nn = \"count\"\n";
    let found = calibrate(&campaign(toml, &csv)).expect("coefficients");
    let weight: f64 = rows.iter().map(|(_, n)| n).sum();
    let mean = rows.iter().map(|(x, n)| n * x).sum::<f64>() / weight;
    let sxx: f64 = rows.iter().map(|(x, n)| n * (x - mean).powi(2)).sum();
    let stated = (found.figures.causes.iter()).position(|cause| cause.dof == [f64::INFINITY]);
    let cause = &found.figures.causes[stated.expect("the noise")];
    near(cause.contribution(0), 0.3 / sxx.sqrt(), 1e-9);
}

/// A table that jitters, and is recorded, moves the output with it: neither is uncertain for that.
#[test]
fn an_output_that_follows_the_samples_of_the_stimulus_is_no_doubt() {
    let rows = (0..DWELLS).flat_map(|dwell| (0..ROWS).map(move |row| (dwell, row)));
    let lines = rows.map(|(dwell, row)| {
        let jitter = 0.03 * (((row * 4 + dwell) % ROWS) as f64 - 4.0);
        let noise = 0.001 * (((row * 5 + dwell) % ROWS) as f64 - 4.0);
        let x = dwell as f64 + jitter;
        format!("{x:?},P{dwell},{:?},0.03\n", 2.0 * x + 0.5 + noise)
    });
    let csv = format!("x,pos,U,uu\n{}", lines.collect::<String>());
    let toml = "title = \"Jitter\"\nequations = [\"U = K*x + b\"]\nnoise.from = \"dwells\"\n[parameter]\nK = {}\nb = {}\n\
                [recording]\nfile = \"run.csv\"\ndwells = [\"pos\"]\n[columns]\nx = \"stimulus\"\npos = \"label\"\nU = \"output\"\n";
    let found = calibrate(&campaign(toml, &csv)).expect("coefficients");
    // The same of the output without what the stimulus does: s of −4 … 4 thousandths is √7.5·10⁻³.
    let alone = 1e-3 * 7.5_f64.sqrt() / (ROWS as f64 * 5.0).sqrt();
    near(found.figures.coefficients[0].u, alone, 1e-2);
    let test = found.responses[0].test.expect("a test");
    // The serial correlation of samples is an estimate, column by column.
    near(test.expected, 1e-3 * 7.5_f64.sqrt() / 3.0, 0.1);
}

/// What cancels in all readings has no u of rounding errors, and what the uncertainties leave out is said.
#[test]
fn an_error_without_effect_has_none() {
    let csv = csv();
    let toml = "title = \"Scale\"\nequations = [\"U = K*x*(1 + e) + b\"]\nnoise.from = \"stated\"\n[parameter]\nK = {}\nb = {}\n[input.e]\nu = 1e-4\n\
                [recording]\nfile = \"run.csv\"\n[columns]\nx = \"stimulus\"\npos = \"label\"\nU = \"output\"\n";
    let campaign = campaign(toml, &csv);
    let found = calibrate(&campaign).expect("coefficients");
    assert_eq!(found.figures.coefficients[1].u, 0.0);
    let mut remarks = campaign.experiment.remarks.iter().map(ToString::to_string);
    assert!(remarks.any(|said| said.contains("none is stated of each reading of U")));
}

/// Where the output follows the samples of its stimulus exactly there is no scatter, and nothing to hold residuals against.
#[test]
fn rounding_is_no_scatter_of_samples() {
    let rows = (0..DWELLS).flat_map(|dwell| (0..ROWS).map(move |row| (dwell, row)));
    let lines = rows.map(|(dwell, row)| {
        let x = dwell as f64 + 0.25 * (((row * 4 + dwell) % ROWS) as f64 - 4.0);
        format!("{x},P{dwell},{},0.03\n", 2.0 * x + 0.5)
    });
    let csv = format!("x,pos,U,uu\n{}", lines.collect::<String>());
    let toml = "title = \"Exact\"\nequations = [\"U = K*x + b\"]\nnoise.from = \"dwells\"\n[parameter]\nK = {}\nb = {}\n\
                [recording]\nfile = \"run.csv\"\ndwells = [\"pos\"]\n[columns]\nx = \"stimulus\"\npos = \"label\"\nU = \"output\"\n";
    let found = calibrate(&campaign(toml, &csv)).expect("coefficients");
    assert!(found.figures.coefficients.iter().all(|one| one.u < 1e-9));
    assert_eq!(found.responses[0].test, None);
}
