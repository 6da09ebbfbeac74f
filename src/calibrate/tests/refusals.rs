//! What is wrong is said, and where.

use super::super::{Purpose, Trouble, Words, calibrate};
use super::{experiment, rejected};

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

#[track_caller]
fn says(toml: &str, csv: &str, words: &[&str]) {
    let said = message(toml, csv);
    for word in words {
        assert!(said.contains(word), "{word:?} is not in\n{said}");
    }
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
    let toml = RATE.to_owned() + "time = \"t\"\n";
    says(
        &toml,
        "t [s],omega [deg/s],U [mV]\n0,0,1\n2,1,2\n1,2,3\n",
        &["goes back"],
    );
}

#[test]
fn what_cannot_be_found_is_said() {
    let trouble = |toml: &str, csv: &str| calibrate(&experiment(toml, csv)).expect_err("trouble");
    let two = "omega [deg/s],U [mV]\n0,1\n";
    assert_eq!(
        trouble(RATE, two),
        Trouble::TooFew {
            readings: 1,
            parameters: 2
        }
    );
    let same = "omega [deg/s],U [mV]\n5,1\n5,2\n5,3\n";
    let Trouble::Undetermined { combinations } = trouble(RATE, same) else {
        panic!("undetermined");
    };
    assert_eq!(combinations.len(), 1);
    let no_start = RATE
        .replace("K*omega + b", "K*omega/b")
        .replace("K = {}", "K = { unit = \"mV·s/deg\" }");
    let csv = "omega [deg/s],U [mV]\n0,1\n1,2\n2,3\n";
    let found = trouble(&no_start, csv);
    assert!(matches!(found, Trouble::NoStart { .. }), "{found:?}");
    let dwells = format!("scatter = \"dwells\"\n{RATE}");
    assert_eq!(trouble(&dwells, csv), Trouble::NoSamples);
}

#[test]
fn missing_readings_are_left_out_and_counted() {
    let csv = "omega [deg/s],U [mV]\n0,1\n1,\n2,3\n3,4.1\n";
    let found = calibrate(&experiment(RATE, csv)).expect("coefficients");
    assert_eq!((found.readings, found.left_out), (3, 1));
}

#[test]
fn exchanged_labels_are_found() {
    let good = "position,U [mV]\nup,1.001\ndown,-0.999\nlevel,0.002\nup,1.000\ndown,-1.001\nlevel,-0.001\nup,0.999\ndown,-1.002\n";
    assert_eq!(
        calibrate(&experiment(POSITIONS, good))
            .expect("figures")
            .swapped,
        None
    );
    let bad = good
        .replacen("up,", "x,", 1)
        .replacen("down,", "up,", 1)
        .replacen("x,", "down,", 1);
    let found = calibrate(&experiment(POSITIONS, &bad)).expect("figures");
    assert_eq!(
        found.swapped,
        Some([2, 3].map(|line| Words::new(format!("line {line}"), format!("第 {line} 行"))))
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
    let toml = POSITIONS.to_owned() + "dwells = [\"position\"]\nranges = { U = [-10, 10] }\n";
    let experiment = experiment(&toml, &csv);
    assert!(
        experiment
            .points
            .findings
            .iter()
            .any(|f| f.message().contains("saturated")),
        "{:?}",
        experiment.points.findings
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
    let found = calibrate(&experiment(RATE, csv)).expect("coefficients");
    let [limit] = found.limits.as_slice() else {
        panic!("one limit: {:?}", found.limits);
    };
    assert_eq!((limit.value, limit.points.len()), (2500.0, 2));
    let good = csv
        .replace("300,2500", "300,3000.3")
        .replace("400,2500", "400,4000.2");
    assert_eq!(
        calibrate(&experiment(RATE, &good))
            .expect("coefficients")
            .limits,
        []
    );
    // Equal readings of equal points are no limit.
    let again = "omega [deg/s],U [mV]\n-1,-2\n-1,-2\n0,0.01\n0,-0.01\n1,2\n1,2\n1,2\n";
    assert_eq!(
        calibrate(&experiment(RATE, again))
            .expect("coefficients")
            .limits,
        []
    );
}

/// Six positions, each twice, half a turn apart: the averages do not see what the turn cancels.
#[test]
fn positions_are_averaged_together() {
    let toml = POSITIONS.replace("file =", "together = [\"position\"]\nfile =");
    let csv = "position,turned,U [mV]\nup,no,1.5\nup,yes,0.5\ndown,no,-1.3\ndown,yes,-0.7\nlevel,no,0.5\nlevel,yes,-0.5\n";
    let found = calibrate(&experiment(&toml, csv)).expect("coefficients");
    assert_eq!(found.readings, 3);
    assert!(found.responses[0].rms < 1e-12, "{}", found.responses[0].rms);
    let lost = csv.replace("down,yes,-0.7\n", "");
    let experiment = experiment(&toml, &lost);
    let [finding] = experiment.points.findings.as_slice() else {
        panic!("{:?}", experiment.points.findings);
    };
    assert!(
        finding.message().contains("\"down\" has 1 point "),
        "{}",
        finding.message()
    );
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
        calibrate(&experiment(POSITIONS, csv))
            .expect("coefficients")
            .swapped
    };
    assert_eq!(of(good), None);
    let labels = of(&swapped).expect("exchanged labels");
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
    assert!(experiment(&toml, &csv).points.findings.is_empty());
    let mut lines: Vec<&str> = csv.lines().collect();
    lines[250] = "down,3";
    let hurt = experiment(&toml, &lines.join("\n"));
    let [spike] = hurt.points.findings.as_slice() else {
        panic!("{:?}", hurt.points.findings);
    };
    assert_eq!((spike.line, spike.count), (251, 1));
    assert!(
        spike.message().contains("is 3 where its dwell"),
        "{}",
        spike.message()
    );
}
