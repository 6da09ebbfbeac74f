//! Reading, with its faults, and checks.

use crate::recording::{Checks, Content, Finding, Problem, Recording, Request, Severity, check};
use gumption_core::quantity::UnitTable;
use gumption_fault::Fault;
use gumption_fault::language::Language;
use gumption_format::csv::faults::*;

const NO_CHECKS: Checks = Checks {
    time: None,
    outputs: &[],
    ranges: &[],
    dwells: &[],
    expected: None,
    fewest: 0,
};

fn all(text: &str) -> Recording {
    match Recording::read_all("test.csv", text, &UnitTable::default()) {
        Ok(recording) => recording,
        Err(rejection) => panic!("{}", rejection.render(false)),
    }
}

fn faults(text: &str, requests: &[Request]) -> Vec<Fault> {
    Recording::read("test.csv", text, requests, &UnitTable::default())
        .expect_err("faults")
        .faults
}

fn only(text: &str, request: Request) -> Fault {
    let mut faults = faults(text, &[request]);
    assert_eq!(faults.len(), 1);
    faults.remove(0)
}

fn unit(symbol: &str) -> gumption_core::quantity::Unit {
    UnitTable::default().parse(symbol).expect("a unit")
}

#[test]
fn units_may_stand_in_a_line_of_their_own() {
    for text in [
        "t90,R,run\n°C,Ω,\n-40,84.3,a\n0,100.0,b\n",
        "t90;R;run\n[degC];[ohm];-\n-40;84,3;a\n0;100,0;b\n",
    ] {
        let recording = all(text);
        assert_eq!(recording.rows(), 2, "{text}");
        assert_eq!(recording.line(0), 3);
        let resistance = recording.column("R").expect("R");
        assert_eq!(resistance.values_in(&unit("mΩ")), Some(vec![84.3e3, 100e3]));
        let temperature = recording.column("t90").expect("t90");
        assert_eq!(temperature.values_in(&unit("K")).unwrap()[1], 273.15);
    }
    // Labels that look like units, above others; and a number among units.
    assert_eq!(all("part,U\nA,\nB,1\n").rows(), 2);
    assert_eq!(all("part,U\nA,2\nB,1\n").rows(), 2);
}

#[test]
fn columns_by_role_in_their_units() {
    let text = "time [ms];U_mV;pos\n0;1.5;a\n10;;a\n20;-2e1;b\n";
    let requests = [
        Request::numbers("output", "U").like(unit("V")),
        Request::numbers("time", "time [ms]").like(unit("s")),
        Request::labels("position", "pos"),
    ];
    let recording =
        Recording::read("test.csv", text, &requests, &UnitTable::default()).expect("no fault");
    assert_eq!(recording.rows(), 3);
    assert_eq!(recording.line(2), 4);
    let output = recording.numbers("output").expect("numbers");
    assert!(output[0] == 1.5 && output[1].is_nan() && output[2] == -20.0);
    let seconds = recording
        .column("time")
        .and_then(|time| time.values_in(&unit("s")));
    assert_eq!(seconds, Some(vec![0.0, 0.01, 0.02]));
    assert_eq!(
        recording.labels("position").map(|labels| labels.text(2)),
        Some("b")
    );
    assert!(recording.numbers("position").is_none() && recording.column("time").is_some());
}

#[test]
fn kinds_of_columns_are_told() {
    let recording = all("a,b,c,d\n1,x,,2020-01-01\n2,3,nan,2020-01-02\n");
    assert!(recording.numbers("a").is_some());
    assert!(recording.labels("b").is_some());
    assert!(recording.labels("c").is_some() && recording.labels("d").is_some());
    let twice = all("T [°C],T [K]\n1,2\n");
    assert!(twice.numbers("T [°C]").is_some() && twice.numbers("T [K]").is_some());
}

/// One row in another spelling makes no column of another decimal sign.
#[test]
fn a_row_with_another_decimal_sign_is_told_at_its_place() {
    let text = "t [s];F [kN]\n0,1;5,25\n0.2;5.3\n0,3;5,35\n";
    let requests = [
        Request::numbers("t", "t [s]"),
        Request::numbers("F", "F [kN]"),
    ];
    let told = faults(text, &requests);
    let told: Vec<&str> = told.iter().map(|fault| &text[fault.span.clone()]).collect();
    assert_eq!(told, ["0.2", "5.3"]);
}

#[test]
fn all_faults_at_once_at_their_places() {
    let text = "time_s,U_mV\n0,1\n1,\"1,5\"\n2,abc\n3\n";
    let requests = [
        Request::numbers("time", "tme"),
        Request::numbers("output", "U_mV").like(unit("A")),
    ];
    let faults = faults(text, &requests);
    let told: Vec<(&str, &str)> = faults
        .iter()
        .map(|fault| (fault.code.id, &text[fault.span.clone()]))
        .collect();
    assert_eq!(
        told,
        [
            (NO_COLUMN.id, "time_s,U_mV"),
            (UNIT_CLASH.id, "U_mV"),
            (NOT_A_NUMBER.id, "\"1,5\""),
            (NOT_A_NUMBER.id, "abc"),
            (ROW_LENGTH.id, "3"),
        ]
    );
    let help = |i: usize| faults[i].help.clone().unwrap_or_default().to_string();
    assert!(help(0).starts_with("did you mean \"time\"?"), "{}", help(0));
    assert_eq!(help(2), "write 1.5, with a decimal point");
    assert_eq!(
        faults[3].message,
        "line 4, column \"U_mV\": \"abc\" is not a number"
    );
}

#[test]
fn a_rejection_shows_line_and_column() {
    let text = "# logger\ntime_s,U_mV\n0,1\n1, 1.5V\n";
    let request = [Request::numbers("output", "U")];
    let rejection = Recording::read("test.csv", text, &request, &UnitTable::default());
    let shown = rejection.expect_err("a fault").render(false);
    assert!(shown.contains("test.csv:4:4"), "{shown}");
    assert!(shown.contains("write the number alone"), "{shown}");
}

#[test]
fn units_that_are_missing_or_contradict() {
    let fault = only(
        "acc_x_g\n1\n",
        Request::numbers("acceleration", "acc_x_g").like(unit("m/s^2")),
    );
    assert_eq!(fault.code, NO_UNIT);
    let fault = only(
        "a [g]\n1\n",
        Request::numbers("acceleration", "a").like(unit("m/s^2")),
    );
    assert_eq!(fault.code, UNIT_CLASH);
    assert!(fault.help.unwrap_or_default().to_string().contains("`gn`"));
    let fault = only(
        "U_mV\n1\n",
        Request::numbers("output", "U").in_unit(unit("V")),
    );
    assert_eq!(fault.code, UNIT_CLASH);
    let fault = only("U [mw/q]\n1\n", Request::numbers("output", "U"));
    assert_eq!(fault.code, UNIT);
    let stated = [Request::numbers("output", "U").in_unit(unit("V"))];
    let read = |text| Recording::read("t", text, &stated, &UnitTable::default());
    assert!(read("U [mw/q]\n1\n").is_ok() && read("U\n1\n").is_ok() && read("U [V]\n1\n").is_ok());
}

#[test]
fn columns_that_are_not_told_apart() {
    let fault = only("T_degC,T_K\n1,2\n", Request::numbers("temperature", "T"));
    assert_eq!(fault.code, SAME_NAME);
    let fault = only("a,a\n1,2\n", Request::numbers("x", "a"));
    assert_eq!(fault.code, SAME_NAME);
}

#[test]
fn long_lists_of_faults_are_cut_and_counted() {
    let of = |text: &str| faults(text, &[Request::numbers("a", "a")]);
    let some = of(&format!("a\n1\n{}", "x\n".repeat(12)));
    assert_eq!(some.len(), 5);
    let last = some[4].message.to_string();
    assert!(last.ends_with("7 more fields of the column are no numbers"));
    // A column of nothing but words is told once, with what it may be.
    let all = of(&format!("a\n{}", "x\n".repeat(12)));
    assert_eq!(all.len(), 1);
    let only = all[0].message.to_string();
    assert!(only.ends_with("11 more fields of the column are no numbers"));
    let help = all[0].help.as_ref().map(ToString::to_string);
    assert!(help.is_some_and(|help| help.contains("[columns] a = \"run\"")));
}

#[test]
fn overloads_and_words_are_missing_numbers() {
    let text = "a\n9.9E37\n-inf\nN/A\n1\n\"\"\n";
    let request = Request {
        content: Content::Numbers,
        ..Request::numbers("a", "a")
    };
    let recording =
        Recording::read("t", text, &[request], &UnitTable::default()).expect("no fault");
    let values = recording.numbers("a").expect("numbers");
    assert_eq!(values.iter().filter(|value| value.is_nan()).count(), 4);
    let findings = check(&recording, &NO_CHECKS);
    assert_eq!(
        (findings[0].problem.clone(), findings[0].line),
        (Problem::Missing, 2)
    );
}

#[test]
fn a_file_that_cannot_be_read() {
    use gumption_format::files::Files;
    let library = Files::Library(&[("a/b.csv", b"x\n\xff\xff"), ("c.csv", b"x\n1")]);
    let open = |path: &str| {
        Recording::open(library, path.as_ref(), &[], &UnitTable::default())
            .map_err(|rejection| rejection.faults[0].code.id)
    };
    assert_eq!(open("none.csv").err(), Some(UNREADABLE.id));
    assert_eq!(open("a").err(), Some(UNREADABLE.id));
    assert_eq!(open("a/b.csv").err(), Some(NOT_UTF8.id));
    assert_eq!(open("c.csv").map(|recording| recording.rows()), Ok(1));
}

fn column(header: &str, values: &[f64]) -> Recording {
    let lines: Vec<String> = values.iter().map(f64::to_string).collect();
    all(&format!("{header}\n{}\n", lines.join("\n")))
}

fn told(recording: &Recording, checks: &Checks) -> Vec<Finding> {
    let findings = check(recording, checks);
    for finding in &findings {
        for text in [finding.said(), finding.mend()] {
            assert!(!text.to_string().is_empty());
            assert!(!text.in_language(Language::Chinese).is_ascii());
        }
    }
    findings
}

#[test]
fn times() {
    let checks = Checks {
        time: Some("time"),
        ..NO_CHECKS
    };
    let findings = told(&column("time_s", &[0.0, 1.0, 1.0, 2.0, 1.5, 3.0]), &checks);
    let back = Problem::TimeBackwards { from: 2.0, to: 1.5 };
    assert_eq!((&findings[0].problem, findings[0].line), (&back, 6));
    assert_eq!(findings[0].severity(), Severity::Error);
    assert_eq!(findings[1].problem, Problem::TimeRepeated { time: 1.0 });
    let mut even: Vec<f64> = (0..40).map(f64::from).collect();
    assert_eq!(told(&column("time_s", &even), &checks), []);
    even.remove(7);
    let findings = told(&column("time_s", &even), &checks);
    let gap = Problem::TimeGap {
        longest: 2.0,
        usual: 1.0,
    };
    assert_eq!((&findings[0].problem, findings[0].line), (&gap, 9));
}

fn saturated(values: &[f64]) -> Vec<f64> {
    let checks = Checks {
        outputs: &["x"],
        ..NO_CHECKS
    };
    told(&column("x", values), &checks)
        .iter()
        .filter_map(|finding| match finding.problem {
            Problem::Saturated { limit } => Some(limit),
            _ => None,
        })
        .collect()
}

#[test]
fn saturation_is_told_from_quiet_and_coarse_readings() {
    let noise = super::normals(5, 3000);
    let quantised =
        |step: f64| -> Vec<f64> { noise.iter().map(|x| (x / step).round() * step).collect() };
    let clipped = |limit: f64| -> Vec<f64> { noise.iter().map(|x| x.min(limit)).collect() };
    assert!(saturated(&noise).is_empty());
    assert!(saturated(&quantised(0.1)).is_empty());
    assert!(saturated(&quantised(1.0)).is_empty());
    assert!(saturated(&quantised(2.0)).is_empty());
    assert_eq!(saturated(&clipped(0.0)), [0.0]);
    assert_eq!(saturated(&clipped(2.5)), [2.5]);
    // Levels of a stimulus, each held as long as the others.
    let stairs: Vec<f64> = (0..300).map(|i| f64::from(i / 50)).collect();
    assert!(saturated(&stairs).is_empty());
    // One dwell of several lies beyond the range.
    let dwells: Vec<f64> = (0..)
        .zip(&noise)
        .map(|(i, x)| ((f64::from(i / 500) + 0.1 * x).min(4.0) * 100.0).round())
        .collect();
    assert_eq!(saturated(&dwells), [400.0]);
    // A quantised sine lingers at its crest.
    let sine: Vec<f64> = (0..3000)
        .map(|i| (500.0 * (f64::from(i) * 0.01).sin()).round())
        .collect();
    assert!(saturated(&sine).is_empty());
    let checks = Checks {
        outputs: &["x"],
        ranges: &[("x", [-2.0, 2.0])],
        ..NO_CHECKS
    };
    let limits = told(&column("x", &noise), &checks);
    assert_eq!(limits.len(), 2);
}

#[test]
fn constants_labels_and_length() {
    let recording = all("x,p\n3,up\n3,down\n3,up\n3,\n3,donw\n");
    let checks = Checks {
        outputs: &["x"],
        dwells: &["p"],
        expected: Some(("p", &["up", "down", "left"])),
        fewest: 6,
        ..NO_CHECKS
    };
    let problems: Vec<Problem> = told(&recording, &checks)
        .into_iter()
        .map(|finding| finding.problem)
        .collect();
    let near = Some("down".to_owned());
    for problem in [
        Problem::TooFew { needed: 6 },
        Problem::LabelAbsent {
            label: "left".into(),
        },
        Problem::LabelUnknown {
            label: "donw".into(),
            near,
        },
        Problem::Constant { value: 3.0 },
        Problem::Unlabelled,
        Problem::LabelAgain { label: "up".into() },
    ] {
        assert!(problems.contains(&problem), "{problem:?} in {problems:?}");
    }
    assert_eq!(problems.len(), 6);
}

#[test]
fn time_may_jump_between_dwells_and_labels_come_back_together() {
    let mut text = "t,p,q\n".to_owned();
    for (dwell, labels) in ["up,no", "up,yes", "down,no", "down,yes", "up,no"]
        .iter()
        .enumerate()
    {
        for sample in 0..10 {
            // One sample of the third dwell is lost.
            if (dwell, sample) != (2, 5) {
                text += &format!("{},{labels}\n", 100 * dwell + sample);
            }
        }
    }
    let recording = all(&text);
    let checks = Checks {
        time: Some("t"),
        dwells: &["p", "q"],
        ..NO_CHECKS
    };
    let findings = told(&recording, &checks);
    assert_eq!(findings.len(), 2, "{findings:?}");
    let gap = Problem::TimeGap {
        longest: 2.0,
        usual: 1.0,
    };
    assert_eq!((&findings[0].problem, findings[0].line), (&gap, 27));
    let again = Problem::LabelAgain {
        label: "up, no".into(),
    };
    assert_eq!((&findings[1].problem, findings[1].line), (&again, 41));
}

#[test]
fn decimal_commas_and_times_as_instruments_write_them() {
    let recording = all(
        "time;U [mV];n\r\n2026-03-01 09:00:00,0;1,5;1\r\n2026-03-01 09:00:00,5;-2;2\r\n2026-03-01 09:00:02,0;;3\r\n",
    );
    assert_eq!(
        recording.labels("time").map(|labels| labels.levels.len()),
        Some(3)
    );
    let text =
        "time;U [mV]\n2026-03-01T09:00:00;1,5\n2026-03-01T09:00:00.5;-2\n2026-03-01T09:00:02Z;\n";
    let requests = [Request::numbers("t", "time"), Request::numbers("U", "U")];
    let read = |text: &str| Recording::read("t.csv", text, &requests, &UnitTable::default());
    let recording = read(text).expect("a recording");
    assert_eq!(recording.numbers("t"), Some([0.0, 0.5, 2.0].as_slice()));
    let unit = recording.column("t").and_then(|column| column.unit.clone());
    assert_eq!(unit.map(|unit| unit.symbol.clone()), Some("s".to_owned()));
    assert_eq!(
        recording.numbers("U").map(|u| [u[0], u[1]]),
        Some([1.5, -2.0])
    );
    let findings = check(&recording, &NO_CHECKS);
    assert!(
        findings
            .iter()
            .any(|finding| finding.problem == Problem::DecimalComma)
    );
    // One column is written in one way.
    for wrong in [
        "1,5\n1.5",
        "1.5\n1,5",
        "3\n09:00:01",
        "09:00:01\n3",
        "1,234,567\n1",
    ] {
        let text = format!("time\tU\n{}\n", wrong.replace('\n', "\t1\n") + "\t1");
        let only = [Request::numbers("t", "time")];
        let read = Recording::read("t.csv", &text, &only, &UnitTable::default());
        let rejection = read.expect_err(wrong);
        assert_eq!(rejection.faults[0].code, NOT_A_NUMBER, "{wrong}");
    }
    let in_hours = text.replace("time", "time [h]");
    assert_eq!(
        read(&in_hours).expect_err("hours").faults[0].code,
        UNIT_CLASH
    );
}

#[test]
fn g_in_a_header_is_free_fall_where_that_is_stated() {
    let request = [Request::numbers("a", "a").in_unit(unit("gn"))];
    let read = Recording::read("t.csv", "a [g]\n1\n", &request, &UnitTable::default());
    let read = read.expect("a recording");
    let symbol = read.column("a").and_then(|column| column.unit.clone());
    assert_eq!(
        symbol.map(|unit| unit.symbol.clone()),
        Some("gn".to_owned())
    );
}
