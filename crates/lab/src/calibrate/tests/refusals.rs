//! What is wrong is said, and where.

use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

use super::super::{Trouble, calibrate};
use super::{campaign, rejected};
use crate::experiment::{Purpose, Words};

const RATE: &str = r#"
equations = ["U = K*omega + b"]
[parameter]
K = {}
b = {}
[recording]
file = "run.csv"
"#;

fn message(toml: &str, csv: &str) -> String {
    match rejected(toml, csv, Purpose::Calibrate) {
        Ok(_) => panic!("accepted"),
        Err(rejection) => {
            let mut all = rejection.render(false);
            for other in &rejection.others {
                all += &other.render(false);
            }
            all
        }
    }
}

fn trouble(toml: &str, csv: &str) -> Trouble {
    calibrate(&campaign(toml, csv)).expect_err("trouble")
}

#[track_caller]
fn says(toml: &str, csv: &str, words: &[&str]) {
    let said = message(toml, csv);
    for word in words {
        assert!(said.contains(word), "{word:?} is not in\n{said}");
    }
}

/// An effect whose term has another coefficient is called as that.
#[test]
fn omitted_effects_are_called_as_their_coefficients() {
    let csv = "omega [deg/s],U [mV]\n0,1\n1,2\n2,3\n";
    let term = |term: &str| format!("{RATE}[omitted.bend]\nterm = \"{term}\"\n");
    says(&term("h*omega^2"), csv, &["[omitted.h]"]);
    says(&term("omega^2"), csv, &["bend*(omega^2)"]);
}

/// What an effect adds is its size times something, and a size has no sign.
#[test]
fn omitted_effects_are_linear_and_of_a_size() {
    let csv = "omega [deg/s],U [mV]\n0,1\n1,2\n2,3\n";
    let of = |lines: &str| format!("{RATE}[omitted.bend]\n{lines}\n");
    for term in ["bend^2*omega", "exp(bend*omega)", "omega/bend"] {
        let said = of(&format!("term = \"{term} * 1 'mV'\""));
        says(&said, csv, &["not linear in bend", "\"bend*x^2\""]);
    }
    for size in ["-1e-3", "0", "\"-1 µV*s^2/deg^2\""] {
        let said = of(&format!("term = \"bend*omega^2\"\ntypical = {size}"));
        says(
            &said,
            csv,
            &["`typical` of the omitted effect bend", "without sign"],
        );
    }
}

/// Temperatures that were measured are no labels.
#[test]
fn numbers_that_hardly_repeat_are_no_labels() {
    let of = |by: &str, csv: &str| {
        let toml = RATE.replace("+ b\"]", "+ b + d\"]").replace("[recording]", &format!("[input.d]\nunit = \"mV\"\nu = 0.1\nby = \"{by}\"\n[columns]\nU = \"output\"\nomega = \"stimulus\"\n{by} = \"covariate\"\n[recording]\naverage = \"none\""));
        let remarks = campaign(&toml, csv).experiment.remarks;
        remarks.iter().any(|remark| {
            remark
                .to_string()
                .contains("5 different numbers in 6 points")
        })
    };
    let csv = |name: &str, values: [&str; 6]| {
        let rows = values
            .iter()
            .enumerate()
            .map(|(i, value)| format!("{i},{}.0{i},{value}\n", i + 1));
        format!("omega [deg/s],U [mV],{name}\n{}", rows.collect::<String>())
    };
    assert!(of(
        "T",
        &csv("T", ["20.1", "20.3", "20.2", "20.1", "20.5", "20.6"])
    ));
    assert!(!of("day", &csv("day", ["1", "2", "3", "4", "4", "5"])));
    assert!(!of(
        "T",
        &csv("T", ["20.5", "20.5", "20.5", "30.5", "30.5", "30.5"])
    ));
}

#[test]
fn faults_of_files_are_told_at_their_places() {
    let csv = "omega [deg/s],U [mV]\n0,1\n1,2\n2,3\n";
    says(
        &RATE.replace("omega", "omga"),
        csv,
        &["omga", "did you mean `omega`?"],
    );
    says(
        &RATE.replace("b = {}", "b = {}\nc = {}"),
        csv,
        &["no equation uses the parameter c"],
    );
    says("title = \"x\"", csv, &["no equations"]);
    says("procedure = \"gyro\"", csv, &["no procedure \"gyro\""]);
    says(
        "procedure = \"accelerometer-tumble-4\"\n[recording]\nfile = \"run.csv\"",
        "theta [deg],E [V]\n0,1\n90,2\n180,1\n270,0\n",
        &["needs R", "[input.R]"],
    );
    says(
        &RATE.replace("K = {}", "K = { unit = \"mV\" }"),
        csv,
        &["mV"],
    );
    says(
        &RATE.replace("K = {}", "K = { strat = 3 }"),
        csv,
        &["did you mean `start`?"],
    );
    says(
        &(RATE.to_owned() + "[input.e]\nu = 1\n"),
        csv,
        &["no equation uses the input e"],
    );
    says(&RATE.replace("run.csv", "other.csv"), csv, &["other.csv"]);
    says(RATE, "omega [deg/s],U [mV]\n0,1\n1,x\n2,3\n", &["x"]);
}

#[test]
fn faults_of_procedures_with_this_recording_are_told_at_their_name() {
    let toml = "procedure = \"accelerometer-tumble-4\"\n[constant]\ng = \"1 gn\"\n[input.R]\nvalue = 500\nu = 1\n[recording]\nfile = \"run.csv\"";
    says(
        toml,
        "theta [s],E [V]\n0,1\n90,2\n180,1\n270,0\n",
        &["theta"],
    );
    let wrong = toml.replace("value = 500", "value = 500\nunit = \"V\"");
    says(
        &wrong,
        "theta [deg],E [V]\n0,1\n90,2\n180,1\n270,0\n",
        &["in the procedure", "procedure ="],
    );
}

const POSITIONS: &str = r#"
equations = ["U = K*n + b"]
[parameter]
K = {}
b = {}
[positions]
column = "position"
gives = ["n"]
at = { "up" = [1], "down" = [-1], "level" = [0] }
[recording]
file = "run.csv"
"#;

#[test]
fn positions_must_be_known_and_complete() {
    let good = "position,U [mV]\nup,1\ndown,-1\nlevel,0\n";
    assert!(rejected(POSITIONS, good, Purpose::Calibrate).is_ok());
    says(
        POSITIONS,
        "position,U [mV]\nup,1\ndown,-1\n",
        &["never is \"level\""],
    );
    says(
        POSITIONS,
        "position,U [mV]\nup,1\ndwn,-1\nlevel,0\n",
        &["did you mean \"down\"?"],
    );
    says(
        &POSITIONS.replace("\"up\" = [1]", "\"up\" = [1, 2]"),
        good,
        &["2 values"],
    );
}

#[test]
fn times_must_go_forward() {
    let toml = RATE.to_owned() + "[columns]\nt = \"time\"\n";
    says(
        &toml,
        "t [s],omega [deg/s],U [mV]\n0,0,1\n2,1,2\n1,2,3\n",
        &["goes back"],
    );
}

#[test]
fn times_need_a_column_of_times() {
    let toml = RATE.to_owned() + "steps = \"omega\"\nsettle = \"2 s\"\n";
    says(
        &toml,
        "t [s],omega [deg/s],U [mV]\n0,0,1\n1,0,2\n2,1,3\n3,1,3\n",
        &["this is a number of rows", "\"t [s]\" = \"time\""],
    );
}

#[test]
fn what_cannot_be_found_is_said() {
    let two = "omega [deg/s],U [mV]\n0,1\n";
    assert_eq!(
        trouble(RATE, two),
        Trouble::TooFew {
            readings: 1,
            parameters: 2
        }
    );
    let same = "omega [deg/s],U [mV]\n5,1\n5,2\n5,3\n";
    let Trouble::Undetermined { combinations, .. } = trouble(RATE, same) else {
        panic!("undetermined");
    };
    assert_eq!(combinations.len(), 1);
    let no_start = RATE
        .replace("K*omega + b", "K*omega/b")
        .replace("K = {}", "K = { unit = \"mV·s/deg\" }");
    let csv = "omega [deg/s],U [mV]\n0,1\n1,2\n2,3\n";
    let found = trouble(&no_start, csv);
    assert!(matches!(found, Trouble::NoStart { .. }), "{found:?}");
    let dwells = format!("noise.from = \"dwells\"\n{RATE}");
    assert_eq!(trouble(&dwells, csv), Trouble::NoSamples);
}

#[test]
fn missing_readings_are_left_out_and_counted() {
    let csv = "omega [deg/s],U [mV]\n0,1\n1,\n2,3\n3,4.1\n";
    let found = calibrate(&campaign(RATE, csv)).expect("coefficients");
    assert_eq!((found.readings, found.left_out), (3, 1));
}

#[test]
fn exchanged_labels_are_found() {
    let good = "position,U [mV]\nup,1.001\ndown,-0.999\nlevel,0.002\nup,1.000\ndown,-1.001\nlevel,-0.001\nup,0.999\ndown,-1.002\n";
    assert_eq!(
        calibrate(&campaign(POSITIONS, good))
            .expect("figures")
            .swapped,
        Vec::<[Words; 2]>::new()
    );
    let bad = good
        .replacen("up,", "x,", 1)
        .replacen("down,", "up,", 1)
        .replacen("x,", "down,", 1);
    let found = calibrate(&campaign(POSITIONS, &bad)).expect("figures");
    assert_eq!(
        found.swapped,
        [[2, 3].map(|line| Words::new(format!("line {line}"), format!("第 {line} 行")))]
    );
}

#[test]
fn saturated_samples_are_warned_of() {
    let mut csv = String::from("position,U [mV]\n");
    for position in ["up", "down", "level"] {
        for sample in 0..30 {
            let value = match position {
                "up" => 10.0,
                "down" => -7.0 + 0.01 * f64::from(sample * sample % 7),
                _ => 0.01 * f64::from(sample * sample % 11),
            };
            csv += &format!("{position},{value}\n");
        }
    }
    let toml =
        POSITIONS.to_owned() + "dwells = [\"position\"]\n[columns]\nU = { range = [-10, 10] }\n";
    let campaign = campaign(&toml, &csv);
    assert!(
        campaign
            .points
            .findings
            .iter()
            .any(|f| f.said().to_string().contains("saturated")),
        "{:?}",
        campaign.points.findings
    );
}

#[test]
fn correlated_errors_must_act_on_the_same_points() {
    let toml = RATE.replace("b\"]", "b + e\"]")
        + "[input.e]\nunit = \"mV\"\nu = 1\n[reading.U]\nu = 1\n[[correlation]]\nbetween = [\"e\", \"U\"]\nr = 0.5\n";
    let csv = "omega [deg/s],U [mV]\n0,1\n1,2\n2,3\n";
    says(
        &toml,
        csv,
        &["acts on other points", "the same `scope` or `by`"],
    );
    let common = toml.replace("[reading.U]\n", "[reading.U]\nscope = \"common\"\n");
    assert!(rejected(&common, csv, Purpose::Calibrate).is_ok());
    let unknown = toml.replace("\"U\"]", "\"W\"]");
    says(&unknown, csv, &["W"]);
}

#[test]
fn a_partly_known_parameter_shares_no_error() {
    let toml = RATE.replace("b\"]", "b + e\"]")
        + "[input.b]\nunit = \"mV\"\nsource = \"dvm\"\n[input.e]\nunit = \"mV\"\nsource = \"dvm\"\n[source.dvm]\nunit = \"mV\"\nu = 0.1\n";
    let csv = "omega [deg/s],U [mV]\n0,1\n1,2\n2,3\n";
    says(&toml, csv, &["what is known of it shares an error"]);
}

/// Two rates at which the output stays at its limit.
#[test]
fn averages_at_a_limit_are_told() {
    let csv = "omega [deg/s],U [mV]\n-200,-2000\n-100,-1000.2\n0,0.3\n100,1000.1\n200,2000.2\n300,2500\n400,2500\n";
    let found = calibrate(&campaign(RATE, csv)).expect("coefficients");
    let [limit] = found.limits.as_slice() else {
        panic!("one limit: {:?}", found.limits);
    };
    assert_eq!((limit.value, limit.points.len()), (2500.0, 2));
    let good = csv
        .replace("300,2500", "300,3000.3")
        .replace("400,2500", "400,4000.2");
    assert_eq!(
        calibrate(&campaign(RATE, &good))
            .expect("coefficients")
            .limits,
        []
    );
    // Equal readings of equal points are no limit.
    let again = "omega [deg/s],U [mV]\n-1,-2\n-1,-2\n0,0.01\n0,-0.01\n1,2\n1,2\n1,2\n";
    assert_eq!(
        calibrate(&campaign(RATE, again))
            .expect("coefficients")
            .limits,
        []
    );
}

/// A display of whole digits shows points within a digit of each other alike, at the ends of the range as well.
#[test]
fn digits_are_no_limit() {
    let csv = "omega [deg/s],U [mV]\n0,0\n0.4,0\n1,1\n2,2\n3,3\n4,4\n5,5\n6,6\n7,7\n8,8\n9,9\n9.6,10\n10,10\n";
    let found = calibrate(&campaign(RATE, csv)).expect("coefficients");
    assert_eq!(found.limits, []);
    let stuck =
        "omega [deg/s],U [mV]\n0,0\n1.1,1\n2,2\n3,3\n3.9,4\n5,5\n6,6\n7,7\n8,7\n9,7\n10,7\n";
    let found = calibrate(&campaign(RATE, stuck)).expect("coefficients");
    assert_eq!((found.limits.len(), found.limits[0].value), (1, 7.0));
}

/// Four points, two coefficients: two degrees of freedom, in which noise alone often leaves another order a hundredth of the squares.
/// At the level of 0.001 more than 3 of 400 have a probability of 0.0008.
#[test]
fn noise_is_no_exchange() {
    let mut random = StdRng::seed_from_u64(4);
    let noise = Normal::new(0.0, 1.0).expect("a spread");
    let is_accused = |_: &i32| {
        let line = |x: i32| {
            let reading = f64::from(x) + noise.sample(&mut random);
            format!("{x},{reading}\n")
        };
        let rows: String = (0..4).map(line).collect();
        let csv = format!("omega [deg/s],U [mV]\n{rows}");
        let found = calibrate(&campaign(RATE, &csv)).expect("coefficients");
        !found.swapped.is_empty()
    };
    assert!((0..400).filter(is_accused).count() <= 3);
}

/// Six positions, each twice, half a turn apart: the averages do not see what the turn cancels.
#[test]
fn positions_are_averaged_together() {
    let toml = POSITIONS.replace("file =", "together = [\"position\"]\nfile =");
    let csv = "position,turned,U [mV]\nup,no,1.5\nup,yes,0.5\ndown,no,-1.3\ndown,yes,-0.7\nlevel,no,0.5\nlevel,yes,-0.5\n";
    let found = calibrate(&campaign(&toml, csv)).expect("coefficients");
    assert_eq!(found.readings, 3);
    assert!(found.responses[0].rms < 1e-12, "{}", found.responses[0].rms);
    let lost = csv.replace("down,yes,-0.7\n", "");
    let campaign = campaign(&toml, &lost);
    let [finding] = campaign.points.findings.as_slice() else {
        panic!("{:?}", campaign.points.findings);
    };
    assert!(
        finding.said().to_string().contains("\"down\" has 1 point "),
        "{}",
        finding.said()
    );
}

/// Where settling leaves no point, the dwells are what is told.
#[test]
fn nothing_is_averaged_together_of_no_points() {
    let toml = POSITIONS.replace(
        "file =",
        "dwells = [\"position\"]\ntogether = [\"position\"]\nsettle = \"1000 s\"\nfile =",
    );
    let csv = "t [s],position,U [mV]\n0,up,1\n1,up,1\n2,down,-1\n3,down,-1\n4,level,0\n5,level,0\n";
    assert!(rejected(&toml, csv, Purpose::Calibrate).is_err());
}

/// Residuals that are zero have all their degrees of freedom.
#[test]
fn an_exact_fit_has_degrees_of_freedom() {
    let csv = "omega [deg/s],U [mV]\n-2,-4\n-1,-2\n0,0\n1,2\n2,4\n";
    let found = calibrate(&campaign(RATE, csv)).expect("coefficients");
    assert!((found.responses[0].own_dof - 3.0).abs() < 1e-12);
}

/// Accelerometer triad, two points of each position. One response sees the exchange; the others, which see
/// nothing of it, do not hide it. Which of two pairs it was the readings do not tell: the scale factor is
/// positive with the one, negative with the other.
#[test]
fn exchanged_labels_are_found_by_the_response_that_sees_them() {
    const TRIAD: &str = "procedure = \"accelerometer-six-positions\"\nconstant.g = \"1 gn\"\n[recording]\nfile = \"run.csv\"\naverage = \"none\"\n";
    let mut lines = vec!["position,Uax [V],Uay [V],Uaz [V]".to_owned()];
    for turn in 0..2 {
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            for (sign, way) in [(1.0, "up"), (-1.0, "down")] {
                let noise = |response: usize| {
                    1e-4 * ((turn * 7 + axis * 5 + response * 3) as f64 + sign).sin()
                };
                let value =
                    |response: usize| noise(response) + if response == axis { sign } else { 0.0 };
                let row = [0, 1, 2].map(|response| format!("{:.6}", value(response)));
                lines.push(format!("{name} {way},{}", row.join(",")));
            }
        }
    }
    let of = |lines: &[String]| {
        let found = calibrate(&campaign(TRIAD, &lines.join("\n"))).expect("coefficients");
        assert_eq!(found.apart, []);
        found.swapped
    };
    assert_eq!(of(&lines), Vec::<[Words; 2]>::new());
    lines[1] = lines[1].replace("up", "down");
    lines[2] = lines[2].replace("down", "up");
    let said: Vec<[String; 2]> = of(&lines)
        .into_iter()
        .map(|pair| pair.map(|words| words.en))
        .collect();
    let pair = |lines: [usize; 2]| lines.map(|line| format!("line {line}"));
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(
        said.contains(&pair([2, 3])) && said.contains(&pair([8, 9])),
        "{said:?}"
    );
}

/// Two ways of one axis exchanged throughout: no residual shows it, the sign of the scale factor does.
#[test]
fn a_sign_unlike_the_others_is_told() {
    const TRIAD: &str = "procedure = \"accelerometer-six-positions\"\nconstant.g = \"1 gn\"\n[recording]\nfile = \"run.csv\"\naverage = \"none\"\n";
    let good = "position,Uax [V],Uay [V],Uaz [V]\nx up,1.001,0,0\nx down,-1,0.001,0\ny up,0,1,0.001\ny down,0,-1,0\nz up,0,0,1\nz down,0.001,0,-1\n";
    let of = |csv: &str| {
        calibrate(&campaign(TRIAD, csv))
            .expect("coefficients")
            .reversed
    };
    assert_eq!(of(good), Vec::<String>::new());
    let exchanged = good
        .replace("y up", "?")
        .replace("y down", "y up")
        .replace('?', "y down");
    assert_eq!(of(&exchanged), ["Kyy"]);
    let all = good
        .replace("up", "?")
        .replace("down", "up")
        .replace('?', "down");
    assert_eq!(of(&all), Vec::<String>::new());
    says(
        &format!("same_sign = [\"L\"]\n{RATE}"),
        "omega [deg/s],U [mV]\n0,1\n1,2\n2,3\n",
        &["L is no parameter"],
    );
}

/// What a procedure says of an input holds of the parameter that the file makes of it, and the other way round.
#[test]
fn inputs_and_parameters_that_change_places_keep_their_units() {
    let toml = "procedure = \"accelerometer-tumble\"\nconstant.g = \"9.8 m/s^2\"\n[parameter.theta0]\n[input.delta_o]\nu = 1e-5\n[input.K2]\nvalue = 1e-5\nu = 1e-6\n[recording]\nfile = \"run.csv\"\naverage = \"none\"\n";
    let rows: String = (0..12)
        .map(|i| {
            let angle = f64::from(30 * i);
            format!(
                "{angle},{}\n",
                2.0 * angle.to_radians().sin() + 1e-5 * f64::from(i % 5)
            )
        })
        .collect();
    let toml = &format!("title = \"Mine\"\n{toml}");
    let campaign = campaign(toml, &format!("theta [deg],E [V]\n{rows}"));
    // In Chinese too, which the procedure has a title in and the file has not.
    assert_eq!(campaign.experiment.heading.title.zh, "Mine");
    let theta0 = campaign
        .experiment
        .parameters
        .iter()
        .find(|one| one.name == "theta0");
    let theta0 = theta0.expect("a parameter");
    assert_eq!(theta0.unit.symbol, "rad");
    let description = theta0.description.as_ref().expect("what it is");
    assert!(description.en.contains("Level angle"), "{}", description.en);
    let k2 = campaign
        .experiment
        .inputs
        .iter()
        .find(|one| one.name == "K2");
    let of = campaign.experiment.units.parse("s^2/m").expect("a unit");
    assert_eq!(k2.expect("an input").unit.dimension, of.dimension);
}

/// A blunder in one of seven points, and none in good readings.
#[test]
fn a_reading_that_stands_apart_is_told() {
    let csv =
        "omega [deg/s],U [mV]\n-3,-6.01\n-2,-3.99\n-1,-2.00\n0,0.01\n1,1.99\n2,4.01\n3,6.00\n";
    let of = |csv: &str| calibrate(&campaign(RATE, csv)).expect("coefficients").apart;
    assert_eq!(of(csv), []);
    let bad = of(&csv.replace("1,1.99", "1,1.49"));
    let [one] = bad.as_slice() else {
        panic!("one point: {bad:?}");
    };
    assert_eq!(
        (one.point.en.as_str(), one.response.as_str()),
        ("line 6", "U")
    );
    // The line of the others, and its residual there.
    let (x, y) = (
        [-3.0, -2.0, -1.0, 0.0, 2.0, 3.0],
        [-6.01, -3.99, -2.0, 0.01, 4.01, 6.0],
    );
    let mean = |v: &[f64; 6]| v.iter().sum::<f64>() / 6.0;
    let (mx, my) = (mean(&x), mean(&y));
    let xx: f64 = x.iter().map(|x| (x - mx).powi(2)).sum();
    let slope = x
        .iter()
        .zip(&y)
        .map(|(x, y)| (x - mx) * (y - my))
        .sum::<f64>()
        / xx;
    let left = |x: f64, y: f64| y - my - slope * (x - mx);
    let s2 = x
        .iter()
        .zip(&y)
        .map(|(x, y)| left(*x, *y).powi(2))
        .sum::<f64>()
        / 4.0;
    let t = left(1.0, 1.49).abs() / (s2 * (1.0 + 1.0 / 6.0 + (1.0 - mx).powi(2) / xx)).sqrt();
    assert!((one.t / t - 1.0).abs() < 1e-9, "{} {t}", one.t);
}

/// As many readings as parameters, and nothing said of their errors: no uncertainty of zero.
#[test]
fn unknown_scatter_is_refused() {
    let csv = "omega [deg/s],U [mV]\n0,1\n1,2\n";
    let found = calibrate(&campaign(RATE, csv));
    assert!(matches!(found, Err(Trouble::NoScatter { .. })), "{found:?}");
    let stated = RATE.to_owned() + "[reading.U]\nu = 0.1\n";
    let found = calibrate(&campaign(&stated, csv)).expect("coefficients");
    let b = found
        .figures
        .coefficients
        .iter()
        .find(|one| one.name == "b");
    assert!((b.expect("b").u - 0.1).abs() < 1e-12);
}

/// Labels exchanged throughout, in all their points.
#[test]
fn labels_exchanged_throughout_are_found() {
    let good = "position,turned,U [mV]\nup,no,1.001\nup,yes,0.999\ndown,no,-0.999\ndown,yes,-1.001\nlevel,no,0.002\nlevel,yes,-0.001\n";
    let swapped = good
        .replace("up", "x")
        .replace("level", "up")
        .replace('x', "level");
    let of = |csv: &str| {
        calibrate(&campaign(POSITIONS, csv))
            .expect("coefficients")
            .swapped
    };
    assert_eq!(of(good), Vec::<[Words; 2]>::new());
    let [labels] = &of(&swapped)[..] else {
        panic!("one pair of labels: {:?}", of(&swapped));
    };
    assert!(
        labels.contains(&Words::plain("up")) && labels.contains(&Words::plain("level")),
        "{labels:?}"
    );
}

/// A sample that is no reading, in a dwell of many.
#[test]
fn spikes_are_told_at_their_line() {
    let mut csv = "position,U [mV]\n".to_owned();
    for (label, level) in [("up", 1.0), ("down", -1.0), ("level", 0.0)] {
        for i in 0..200 {
            let noise = 0.01 * f64::from(i * 7919 % 101) / 101.0;
            csv += &format!("{label},{}\n", level + noise);
        }
    }
    let toml = POSITIONS.replace("file =", "dwells = [\"position\"]\nfile =");
    assert!(campaign(&toml, &csv).points.findings.is_empty());
    let mut lines: Vec<&str> = csv.lines().collect();
    lines[250] = "down,3";
    let hurt = campaign(&toml, &lines.join("\n"));
    let [spike] = hurt.points.findings.as_slice() else {
        panic!("{:?}", hurt.points.findings);
    };
    assert_eq!((spike.line, spike.count), (251, 1));
    assert!(
        spike.said().to_string().contains("is 3 where its dwell"),
        "{}",
        spike.said()
    );
}

/// What is left out is as if it had not been recorded, and the report says why; nothing else may be left out.
#[test]
fn rows_are_left_out_with_a_reason() {
    let rows = ["0,1.1", "1,1.9", "2,3.2", "3,9", "4,4.9", "5,6.2", "6,70"];
    let csv = |rows: &[&str]| format!("omega [deg/s],U [mV]\n{}\n", rows.join("\n"));
    let left_out = |lines: &str, reason: &str| {
        let rate = RATE.replace(
            "file = \"run.csv\"",
            "file = \"run.csv\"\naverage = \"none\"",
        );
        format!("{rate}[[left_out]]\nlines = {lines}\n{reason}")
    };
    let found = |toml: &str, rows: &[&str]| {
        let campaign = campaign(toml, &csv(rows));
        let found = calibrate(&campaign).expect("a calibration");
        let values = found.figures.coefficients.iter().map(|c| (c.value, c.u));
        (campaign, values.collect::<Vec<_>>())
    };
    let fewer: Vec<&str> = [0, 1, 2, 4, 5].map(|at: usize| rows[at]).to_vec();
    let plain = RATE.replace(
        "file = \"run.csv\"",
        "file = \"run.csv\"\naverage = \"none\"",
    );
    let (_, without) = found(&plain, &fewer);
    let door = "reason = \"the door was open\"";
    for lines in ["[5, 8]", "[5, \"8-8\"]", "[\"5\", 8]"] {
        let (campaign, left) = found(&left_out(lines, door), &rows);
        assert_eq!(left, without, "{lines}");
        let remarks = &campaign.experiment.remarks;
        assert!(
            remarks
                .iter()
                .any(|remark| remark.to_string().contains("the door was open"))
        );
    }
    let all = csv(&rows);
    says(
        &left_out("[5]", ""),
        &all,
        &["without a reason", "`reason` is missing"],
    );
    says(
        &left_out("[1]", door),
        &all,
        &["has no such rows", "lines 2 to 8"],
    );
    says(&left_out("[\"7-9\"]", door), &all, &["has no such rows"]);
    says(&left_out("[\"2-8\"]", door), &all, &["all rows of"]);
}

/// A parameter that enters linearly once the others are held needs no start, and one that begins where nothing changes a better one.
#[test]
fn a_start_is_asked_of_what_needs_one() {
    let rows = (0..8).map(|x| format!("{x},{}\n", 3.0 * libm::exp(-f64::from(x) / 2.5)));
    let csv = format!("x,y\n{}", rows.collect::<String>());
    let decay = |parameters: &str| {
        format!(
            "title = \"Decay\"\nequations = [\"y = a*exp(-x/b)\"]\nrecording = \"run.csv\"\n[parameter]\na = {{}}\n{parameters}\n"
        )
    };
    match trouble(&decay("b = {}"), &csv) {
        Trouble::NoStart { parameters } => assert_eq!(parameters, ["b"]),
        other => panic!("{other:?}"),
    }
    match trouble(&decay("b = { start = 1e-6 }"), &csv) {
        Trouble::Undetermined { begun, .. } => assert_eq!(begun, ["b"]),
        other => panic!("{other:?}"),
    }
}
