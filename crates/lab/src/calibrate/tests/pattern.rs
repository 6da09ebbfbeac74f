//! Residuals that are no scatter.

use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

use super::super::{Pattern, PatternTest, calibrate};
use super::{campaign, near};

const RATE: &str = "title = \"Rate\"\nequations = [\"U = K*omega*(1 + e) + b\"]\n[parameter]\nK = {}\nb = {}\n[recording]\nfile = \"run.csv\"\n";

/// What is found of readings, with what the file states of errors.
fn found(errors: &str, readings: &[(f64, f64)]) -> Vec<Pattern> {
    let lines = readings.iter().map(|(omega, u)| format!("{omega},{u}\n"));
    let csv = format!("omega [deg/s],U [mV]\n{}", lines.collect::<String>());
    let campaign = campaign(&format!("{RATE}{errors}"), &csv);
    calibrate(&campaign).expect("coefficients").patterns
}

const EXACT: &str = "[input.e]\nvalue = 0\n";

/// Two series, of which readings at the same rate differ by ±d, on a parabola of height a.
fn parabola(a: f64, d: f64) -> Vec<(f64, f64)> {
    let series = |sign: f64| {
        (-2..=2).map(move |i| {
            let x = f64::from(i);
            (x, 2.0 * x + a * (x * x - 2.0) + sign * d)
        })
    };
    series(1.0).chain(series(-1.0)).collect()
}

/// How many of 400 calibrations with honest errors say that residuals do not fit them: the level is 0.5 % on either side, 4 of 400,
/// and more than 12 would come in one of a thousand such trials.
fn misfits(toml: &str, mut csv: impl FnMut(&mut StdRng) -> (String, String)) -> usize {
    let mut random = StdRng::seed_from_u64(11);
    let mut is_misfit = || {
        let (errors, csv) = csv(&mut random);
        let campaign = campaign(&format!("{toml}{errors}"), &csv);
        let responses = calibrate(&campaign).expect("coefficients").responses;
        responses
            .iter()
            .any(|one| one.test.is_some_and(|test| test.misfit.is_some()))
    };
    (0..400).filter(|_| is_misfit()).count()
}

#[test]
fn an_uncertainty_from_few_samples_is_no_certain_one() {
    let toml = "equations = \"U = K*omega + b\"\nnoise.from = \"dwells\"\n[parameter]\nK = {}\nb = {}\n[recording]\nfile = \"run.csv\"\nsteps = \"omega\"\n";
    let noise = Normal::new(0.0, 1.0_f64).expect("a scatter");
    let found = misfits(toml, |random| {
        let lines =
            (0..60).map(|i| format!("{},{:.6}\n", i / 4, f64::from(i / 4) + noise.sample(random)));
        (
            String::new(),
            format!("omega [deg/s],U [mV]\n{}", lines.collect::<String>()),
        )
    });
    assert!(found <= 12, "{found} of 400");
}

#[test]
fn an_uncertainty_with_few_degrees_of_freedom_is_no_certain_one() {
    let toml = "equations = \"U = K*omega + b\"\nnoise.from = \"stated\"\n[parameter]\nK = {}\nb = {}\n[recording]\nfile = \"run.csv\"\naverage = \"none\"\n";
    let noise = Normal::new(0.0, 1.0_f64).expect("a scatter");
    let found = misfits(toml, |random| {
        let squares: f64 = (0..4).map(|_| noise.sample(random).powi(2)).sum();
        let lines = (0..15).map(|i| format!("{i},{:.6}\n", f64::from(i) + noise.sample(random)));
        let csv = format!("omega [deg/s],U [mV]\n{}", lines.collect::<String>());
        (
            format!("[reading.U]\nu = {}\ndof = 4\n", (squares / 4.0).sqrt()),
            csv,
        )
    });
    assert!(found <= 12, "{found} of 400");
}

#[test]
fn repeats_that_agree_better_than_the_equation_tell() {
    let all = found(EXACT, &parabola(1.0, 0.001));
    let [Pattern { by, .. }] = all.as_slice() else {
        panic!("{all:?}")
    };
    let PatternTest::Repeats { within, between, f } = by else {
        panic!("{by:?}")
    };
    // Ten readings at five rates, two parameters: ν = 5 and 3. Σ(x² − 2)² = 2·14; readings differ by no less than
    // 0.002, which may be their resolution.
    let apart = (10.0 * 0.001_f64.powi(2) / 5.0).sqrt();
    near(*within, apart, 1e-6);
    near(
        *between,
        ((28.0 - 10.0 * 0.001_f64.powi(2)) / 3.0).sqrt(),
        1e-6,
    );
    near(*f, (between / within).powi(2), 1e-12);
}

#[test]
fn what_is_stated_or_read_so_coarsely_explains_residuals() {
    let curved = parabola(0.02, 0.001);
    assert_eq!(found(EXACT, &curved).len(), 1);
    let each = "[reading.U]\nu = 0.03\n";
    assert_eq!(found(&format!("{EXACT}{each}"), &curved), []);
    // A digit of 1 mV makes the same errors at the same rates.
    let coarse: Vec<(f64, f64)> = (0..40)
        .map(|i| {
            let x = f64::from(i % 10) * 1.37;
            (x, (2.0 * x + if i == 7 { 0.6 } else { 0.0 }).round())
        })
        .collect();
    assert_eq!(found(EXACT, &coarse), []);
}

#[test]
fn signs_that_stay_tell() {
    // A wave over the readings, at rates that do not come back.
    let wave = |i: usize| {
        let x = ((i * 37) % 40) as f64;
        (x, 2.0 * x + (i as f64 / 5.0).sin())
    };
    let all = found(EXACT, &(0..40).map(wave).collect::<Vec<_>>());
    let [Pattern { by, p_value, .. }] = all.as_slice() else {
        panic!("{all:?}")
    };
    assert!(
        matches!(by, PatternTest::Runs { readings: 40, .. }),
        "{by:?}"
    );
    assert!(*p_value < 0.005);
}

#[test]
fn scatter_is_scatter() {
    let noise = Normal::new(0.0, 1.0).expect("a distribution");
    let mut random = StdRng::seed_from_u64(1);
    let mut alarms = 0;
    for _ in 0..400 {
        let reading = |i: usize| {
            let x = (i % 8) as f64;
            (x, 2.0 * x + noise.sample(&mut random))
        };
        alarms += found(EXACT, &(0..24).map(reading).collect::<Vec<_>>()).len();
    }
    // Two tests at 0.5 %: four are expected at most, and eleven come about in fewer than one of a thousand cases.
    assert!(alarms < 11, "{alarms}");
}

/// A circle that stays in the time: what its radius leaves follows nothing more often than by chance.
#[test]
fn what_is_known_and_stays_has_no_scale_to_follow() {
    const CIRCLE: &str = "title = \"Norm\"\nequations = \"r = sqrt((x - bx)^2 + (y - by)^2)\"\n\
        recording = \"run.csv\"\nconstant.r = 1\n[parameter]\nbx = { start = 0 }\nby = { start = 0 }\n\
        [columns]\nt = \"covariate\"\n";
    let noise = Normal::new(0.0, 0.001).expect("a distribution");
    let mut random = StdRng::seed_from_u64(2);
    let mut alarms = 0;
    for _ in 0..400 {
        let lines = (0..24).map(|i| {
            let angle = f64::from(i * 7 % 24) * std::f64::consts::TAU / 24.0;
            let [x, y] = [angle.cos(), angle.sin()].map(|x| x + noise.sample(&mut random));
            format!("{i},{x},{y}\n")
        });
        let csv = format!("t,x,y\n{}", lines.collect::<String>());
        let found = calibrate(&campaign(CIRCLE, &csv)).expect("coefficients");
        let follows = |one: &&Pattern| matches!(one.by, PatternTest::Follows { .. });
        alarms += found.patterns.iter().filter(follows).count();
    }
    // Two are expected at 0.5 %, and eight come about in one of a thousand cases.
    assert!(alarms < 8, "{alarms}");
}

/// Three days of eight readings on a line, with an offset and a scale of their own.
fn on_three_days(offset: f64, scale: f64, errors: &str) -> Vec<Pattern> {
    let mut generator = StdRng::seed_from_u64(5);
    let scatter = Normal::new(0.0, 0.1).expect("a distribution");
    let days = [("mon", -1.0), ("tue", 1.0), ("wed", 0.0)];
    let lines = days
        .iter()
        .flat_map(|(day, sign)| (0..8).map(move |i| (day, *sign, f64::from((i * 5) % 8) - 3.5)));
    let lines = lines.map(|(day, sign, rate)| {
        let u = (2.0 + sign * scale) * rate + sign * offset + scatter.sample(&mut generator);
        format!("{rate},{day},{u}\n")
    });
    let csv = format!("omega [deg/s],day,U [mV]\n{}", lines.collect::<String>());
    let file = RATE.replace("b\"]", "b + shift\"]\nseparately = \"day\"");
    calibrate(&campaign(&format!("{file}{EXACT}{errors}"), &csv))
        .expect("coefficients")
        .patterns
}

#[test]
fn parts_that_differ_by_more_than_their_readings_scatter_tell() {
    let exact = "[input.shift]\nvalue = 0\nunit = \"mV\"\n";
    assert_eq!(on_three_days(0.0, 0.0, exact), []);
    for (offset, scale) in [(0.3, 0.0), (0.0, 0.1)] {
        let all = on_three_days(offset, scale, exact);
        let [Pattern { by, p_value, .. }] = all.as_slice() else {
            panic!("{all:?}")
        };
        let PatternTest::Parts { column, f } = by else {
            panic!("{by:?}")
        };
        assert_eq!(column, "day");
        assert!(*f > 10.0 && *p_value < 1e-4, "{f} {p_value}");
    }
    let stated = "[input.shift]\nu = 0.3\nunit = \"mV\"\nby = \"day\"\n";
    assert_eq!(on_three_days(0.3, 0.0, stated), []);
}

/// Twenty readings on a line, with a temperature that acts so much on the output and on the scale.
fn in_the_cold(output: f64, scale: f64) -> Vec<Pattern> {
    let mut generator = StdRng::seed_from_u64(11);
    let scatter = Normal::new(0.0, 0.1).expect("a distribution");
    let lines = (0..20).map(|i| {
        let (rate, t) = (f64::from(i % 5), f64::from((i * 7) % 20) / 10.0);
        let u = 2.0 * rate * (1.0 + scale * t) + output * t + scatter.sample(&mut generator);
        format!("{rate},{t},{u}\n")
    });
    let csv = format!("omega [deg/s],T [°C],U [mV]\n{}", lines.collect::<String>());
    let file = format!("{RATE}{EXACT}[columns]\nT = \"covariate\"\n");
    calibrate(&campaign(&file, &csv))
        .expect("coefficients")
        .patterns
}

#[test]
fn residuals_that_follow_what_no_equation_has_tell() {
    assert_eq!(in_the_cold(0.0, 0.0), []);
    // In the last the two cancel in the mean of the readings.
    for (output, scale) in [(0.5, 0.0), (0.0, 0.1), (-0.4, 0.1)] {
        let all = in_the_cold(output, scale);
        let [
            Pattern {
                by: PatternTest::Follows { column },
                p_value,
                ..
            },
        ] = all.as_slice()
        else {
            panic!("{all:?}")
        };
        assert_eq!(column, "T");
        assert!(*p_value < 1e-3, "{p_value}");
    }
}
