//! Cases and recordings as users write them: units that follow from the model, angles, headers, times and
//! encodings, and names in Chinese.

use std::f64::consts::PI;
use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{diagnosed, diagnosed_with, folder, gumption, json};

/// A platinum thermometer beside conditions that its model does not use.
fn thermometer() -> String {
    let mut noise = Noise(3);
    let mut text = "t [s],T [°C],R [ohm],humidity [%],depth [mm]\n".to_owned();
    for row in 0..30 {
        let at = 5.0 * f64::from(row);
        let ohms = 100.0 * (1.0 + 3.9083e-3 * at - 5.775e-7 * at * at) + 5e-4 * noise.normal();
        let humidity = 40.0 + noise.normal();
        let depth = 250.0 + noise.normal();
        let _ = writeln!(text, "{},{at},{ohms:.5},{humidity:.2},{depth:.2}", 60 * row);
    }
    text
}

const THERMOMETER: &str = "[columns]\nR = \"output\"\nT = \"stimulus\"\nt = \"time\"\nhumidity = \"covariate\"\ndepth = \"covariate\"\n";

/// Name, unit and value of the parameters of the declared model.
fn parameters(found: &Value) -> Vec<(String, String, f64)> {
    let list = found["parameters"].as_array().into_iter().flatten();
    list.map(|one| {
        let text = |key: &str| one[key].as_str().unwrap_or_default().to_owned();
        let value = one["declared"]["value"].as_f64().or(one["value"].as_f64());
        (text("name"), text("unit"), value.expect("a value"))
    })
    .collect()
}

fn units(found: &Value) -> Vec<String> {
    let units = parameters(found).into_iter().map(|(_, unit, _)| unit);
    units.collect()
}

#[test]
fn units_follow_from_the_columns_of_the_model_alone() {
    let case = format!("equations = \"R = R0*(1 + A*T + B*T^2)\"\n{THERMOMETER}");
    let found = diagnosed_with("polynomial", &thermometer(), &case);
    assert_eq!(units(&found), ["Ω", "1/K", "1/K²"], "{found:#}");
}

/// An equation that leaves the unit of its parameter open takes the one that the start is written in.
#[test]
fn a_start_with_a_unit_says_the_unit_of_its_parameter() {
    let mut noise = Noise(4);
    let mut rows = "L [m],T [s]\n".to_owned();
    for row in 0..24 {
        let length = 0.3 + 0.05 * f64::from(row);
        let period = 2.0 * PI * (length / 9.81).sqrt() + 5e-4 * noise.normal();
        let _ = writeln!(rows, "{length:.2},{period:.4}");
    }
    let case = "equations = \"T = 2*pi*sqrt(L/g)\"\n[columns]\nT = \"output\"\nL = \"stimulus\"\n[parameter]\ng = { start = \"980 cm/s^2\" }\n";
    let found = diagnosed_with("pendulum", &rows, case);
    let (name, unit, value) = &parameters(&found)[0];
    assert_eq!((name.as_str(), unit.as_str()), ("g", "cm/s²"), "{found:#}");
    assert!((value - 981.0).abs() < 1.0, "{value}");
}

#[test]
fn the_first_error_asks_for_the_units_that_are_open() {
    let folder = folder("open-units");
    std::fs::write(folder.join("recording.csv"), thermometer()).expect("written");
    let case =
        format!("recording = \"recording.csv\"\nequations = \"R = a*b*c*d*T\"\n{THERMOMETER}");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let (good, told) = gumption(&folder, &["diagnose", "case.toml"]);
    assert!(!good && told.contains("[parameter] a = { unit"), "{told}");
}

/// A tumble of an accelerometer whose zero is off by 0.02°.
fn tumble() -> String {
    let mut noise = Noise(5);
    let mut text = "head [deg],out [mV]\n".to_owned();
    for row in 0..36 {
        let head = 30.0 * f64::from(row % 12);
        let out = 1.8 + 251.3 * libm::sin((head + 0.02) * PI / 180.0) + 4e-3 * noise.normal();
        let _ = writeln!(text, "{head},{out:.4}");
    }
    text
}

const TUMBLE: &str = "[columns]\nhead = \"angle\"\nout = \"output\"\n[noise]\nu = \"0.004 mV\"\n";

#[test]
fn a_misalignment_is_an_angle_like_the_one_it_is_added_to() {
    let case = format!("equations = \"out = K0 + K1*sin(head + d0)\"\n{TUMBLE}");
    let found = diagnosed_with("misalignment", &tumble(), &case);
    assert_eq!(units(&found), ["mV", "mV", "°"], "{found:#}");
    let values = parameters(&found);
    assert!((values[1].2 - 251.3).abs() < 0.02, "{values:?}");
    assert!((values[2].2 - 0.02).abs() < 0.005, "{values:?}");
}

#[test]
fn angles_are_told_without_full_turns() {
    // With these units the search starts a thousand turns away from the minimum.
    let stated = "[parameter]\nK1 = { unit = \"mV·°\" }\nd0 = { unit = \"rad\" }\n";
    let case = format!("equations = \"out = K0 + K1*sin(head + d0)\"\n{TUMBLE}{stated}");
    let found = diagnosed_with("turns", &tumble(), &case);
    let values = parameters(&found);
    assert!(values[2].2.abs() < PI, "{values:?}");
}

#[test]
fn an_angle_is_converted_once() {
    let folder = folder("twice");
    std::fs::write(folder.join("recording.csv"), tumble()).expect("written");
    let case = format!(
        "recording = \"recording.csv\"\nequations = \"out = K0 + K1*sin(head*pi/180)\"\n{TUMBLE}"
    );
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let (good, told) = gumption(&folder, &["diagnose", "case.toml"]);
    assert!(!good && told.contains("M0408"), "{told}");
}

#[test]
fn an_improved_case_takes_its_recording_at_rest_with_it() {
    let folder = folder("improved-rest");
    let mut noise = Noise(11);
    let mut text = "time [s],rate_dps,gyro_dps\n".to_owned();
    for row in 0..60 {
        let rate = 10.0 * f64::from(row % 7) - 30.0;
        let gyro = 0.1 + rate + 1e-3 * rate * rate + 1e-3 * noise.normal();
        let _ = writeln!(text, "{row},{rate},{gyro:.5}");
    }
    std::fs::write(folder.join("recording.csv"), text).expect("written");
    let rest: Vec<String> = (0..200)
        .map(|_| format!("{:.5}", 1e-3 * noise.normal()))
        .collect();
    let rest = format!("gyro_dps\n{}\n", rest.join("\n"));
    std::fs::write(folder.join("rest.csv"), &rest).expect("written");
    let case = "recording = \"recording.csv\"\nequations = \"w = bias + k*rate\"\n[columns]\ntime = \"time\"\nrate = \"stimulus\"\nw = { role = \"output\", column = \"gyro_dps\" }\n[noise]\nat_rest = { file = \"rest.csv\", column = \"gyro_dps\" }\n";
    assert_ne!(diagnosed(&folder, case)["verdict"], "none");
    let arguments = ["diagnose", "case.toml", "--improved", "improved"];
    assert!(gumption(&folder, &arguments).0);
    // It has no time.
    for (language, words) in [("en", "as white noise"), ("zh", "按白噪声处理")] {
        let (good, page) = gumption(&folder, &["diagnose", "case.toml", "--lang", language]);
        assert!(good && page.contains(words), "{page}");
    }
    let copy = std::fs::read_to_string(folder.join("improved/at_rest.csv")).expect("a copy");
    assert_eq!(copy, rest);
    let again = json(&folder, &["diagnose", "improved/case.toml", "--json"]);
    assert_eq!(again["verdict"], "none", "{again:#}");
}

/// Two outputs that wander, at rest or not: rows of the time and both readings.
fn wandering(noise: &mut Noise, rows: usize, reading: impl Fn(f64, f64) -> f64) -> String {
    let mut levels = [0.0; 2];
    let row = |row: usize| {
        let mut text = format!("{}", 20 * row);
        for (level, gain) in levels.iter_mut().zip([1.0, 2.0]) {
            *level += 2e-3 * noise.normal();
            let shown = reading(gain, row as f64) + *level + 1e-3 * noise.normal();
            let _ = write!(text, ",{shown:.5}");
        }
        text + "\n"
    };
    (0..rows).map(row).collect()
}

/// The recordings have other names than the model, and the one at rest has other units.
#[test]
fn an_improved_case_has_the_noise_of_the_first_one() {
    let folder = folder("improved-wander");
    let mut noise = Noise(17);
    let load = |row: f64| 10.0 * (row % 7.0) - 30.0;
    let rest = wandering(&mut noise, 200, |_, _| 0.0);
    let rest = format!("clock [s],left [V],right [V]\n{rest}");
    std::fs::write(folder.join("rest.csv"), rest).expect("written");
    let loaded = wandering(&mut noise, 60, |gain, row| {
        gain * load(row) + 1e-3 * load(row).powi(2)
    });
    let rows = loaded.lines().enumerate();
    let rows = rows.map(|(row, text)| format!("{text},{}\n", load(row as f64)));
    let recording = format!("clock,left [V],right [V],kN\n{}", rows.collect::<String>());
    std::fs::write(folder.join("recording.csv"), recording).expect("written");
    let case = r#"
recording = "recording.csv"
equations = ["l = a + b*load", "r = c + d*load"]

[columns]
t = { role = "time", column = "clock", unit = "s" }
load = { role = "stimulus", column = "kN", unit = "kN" }
l = { role = "output", column = "left" }
r = { role = "output", column = "right" }

[noise]
at_rest = { file = "rest.csv" }
"#;
    let found = diagnosed(&folder, case);
    assert_ne!(found["verdict"], "none", "{found:#}");
    let origin = found["noise"]["origin"].as_str().unwrap_or_default();
    assert!(!origin.contains("white"), "{origin}");
    let arguments = ["diagnose", "case.toml", "--improved", "improved"];
    assert!(gumption(&folder, &arguments).0);
    let again = json(&folder, &["diagnose", "improved/case.toml", "--json"]);
    assert_eq!(again["verdict"], "none", "{again:#}");
    let misfit = |quality: &Value| quality["chi_squared"].as_f64().expect("noise is claimed");
    let (before, after) = (misfit(&again["before"]), misfit(&found["after"]));
    assert!((before / after - 1.0).abs() < 1e-9, "{before} {after}");
}

/// A line over columns with Chinese names, the units in the brackets of a Chinese keyboard.
fn chinese() -> String {
    let mut noise = Noise(7);
    let mut text = "时间（min）,位移（mm）,室温 [°C],电压（mV）\n".to_owned();
    for row in 0..40 {
        let shift = f64::from(row % 8);
        let room = 23.0 + libm::sin(0.7 * f64::from(row));
        let volt = 0.5 + 2.0 * shift + 0.05 * (room - 23.0) + 1e-3 * noise.normal();
        let _ = writeln!(text, "{row},{shift},{room:.3},{volt:.4}");
    }
    text
}

#[test]
fn reports_in_chinese_are_in_chinese() {
    let folder = folder("chinese");
    std::fs::write(folder.join("recording.csv"), chinese()).expect("written");
    let case = "recording = \"recording.csv\"\nequations = \"电压 = a + b*位移\"\n[columns]\n\"时间\" = \"time\"\n\"位移\" = \"stimulus\"\n\"室温\" = \"covariate\"\n\"电压\" = \"output\"\n[noise]\nu = \"1 µV\"\n";
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let (good, page) = gumption(&folder, &["diagnose", "case.toml", "--lang", "zh"]);
    assert!(good, "{page}");
    for english in ["scale", "offset", "model", "mean", "signal", " 或 "] {
        assert!(!page.contains(english), "{english} in\n{page}");
    }
    assert!(page.contains("模型"), "{page}");
}

/// Two outputs, each with a stimulus of its own, one of which takes part in the other.
#[test]
fn reports_on_several_outputs_are_in_chinese_too() {
    let folder = folder("chinese-axes");
    let mut noise = Noise(13);
    let mut text = "gx [gn],gy [gn],ax [V],ay [V]\n".to_owned();
    for row in 0..36 {
        let phi = f64::from(row % 12) * PI / 6.0;
        let (gx, gy) = (libm::sin(phi), libm::cos(phi));
        let ax = 0.01 + 2.0 * gx + 0.003 * gy + 2e-4 * noise.normal();
        let ay = -0.02 + 1.98 * gy + 2e-4 * noise.normal();
        let _ = writeln!(text, "{gx:.6},{gy:.6},{ax:.5},{ay:.5}");
    }
    std::fs::write(folder.join("recording.csv"), text).expect("written");
    let case = "recording = \"recording.csv\"\nequations = [\"ax = bx + Sx*gx\", \"ay = by + Sy*gy\"]\n[columns]\nax = \"output\"\nay = \"output\"\ngx = { role = \"stimulus\", u_common = \"0.1 mgn\" }\ngy = \"stimulus\"\n[noise]\nu = \"0.2 mV\"\n";
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let (good, page) = gumption(&folder, &["diagnose", "case.toml", "--lang", "zh"]);
    assert!(good, "{page}");
    for english in ["offset of", "scale of", " with ", "common error", "half"] {
        assert!(!page.contains(english), "{english} in\n{page}");
    }
    for chinese in ["ax 的零位", "gx 的共同误差", "前半段："] {
        assert!(page.contains(chinese), "{chinese} is missing in\n{page}");
    }
}

#[test]
fn uncertainties_in_celsius_are_differences() {
    let folder = folder("celsius");
    let mut noise = Noise(17);
    let mut text = "T [°C],R [Ω]\n".to_owned();
    for row in 0..40 {
        let t = 20.0 + 0.5 * f64::from(row);
        let r = 100.0 * (1.0 + 0.0039 * (t - 30.0)) + 0.002 * noise.normal();
        let _ = writeln!(text, "{t:.2},{r:.4}");
    }
    std::fs::write(folder.join("recording.csv"), text).expect("written");
    let page = |unit: &str| {
        let case = format!(
            "recording = \"recording.csv\"\nequations = \"R = R30 * (1 + alpha * (T - 30 '°C'))\"\n[columns]\nR = \"output\"\nT = {{ role = \"stimulus\", u_common = \"0.05 {unit}\" }}\n[noise]\nu = \"2 mΩ\"\n"
        );
        std::fs::write(folder.join("case.toml"), case).expect("written");
        gumption(&folder, &["diagnose", "case.toml"])
    };
    let (good, celsius) = page("°C");
    assert!(good, "{celsius}");
    assert_eq!(celsius, page("K").1);
}

#[test]
fn a_recording_in_a_code_page_is_refused_as_such() {
    let folder = folder("latin1");
    let mut bytes = b"x [mm],y [mV],T (".to_vec();
    bytes.extend([0xb0, b'C', b')', b'\n']);
    bytes.extend(b"1,2,20\n2,3,20\n3,4,21\n");
    std::fs::write(folder.join("recording.csv"), bytes).expect("written");
    let case = "recording = \"recording.csv\"\nequations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nT = \"covariate\"\n";
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let (good, told) = gumption(&folder, &["diagnose", "case.toml"]);
    assert!(
        !good && told.contains("neither UTF-8, UTF-16 nor GBK") && told.contains("CSV UTF-8"),
        "{told}"
    );
}

#[test]
fn dates_with_the_month_in_doubt_are_refused_once() {
    let folder = folder("dates");
    let row = |row: usize, clock: &str| format!("{clock},{row},{}\n", 2 * row);
    let head = "t,x [mm],y [mV]\n";
    let case = "recording = \"recording.csv\"\nequations = \"y = a + b*x\"\n[columns]\nt = \"time\"\ny = \"output\"\nx = \"stimulus\"\n";
    std::fs::write(folder.join("case.toml"), case).expect("written");
    for (date, mend) in [
        ("3/4/2026 08:41:00 AM", "write 2026-03-04, or 2026-04-03"),
        ("03.13.2026", "write 2026-03-13"),
        ("01.03.26", "write the year first, with its four digits"),
    ] {
        let rows: String = (0..9).map(|i| row(i, date)).collect();
        std::fs::write(folder.join("recording.csv"), format!("{head}{rows}")).expect("written");
        let (good, told) = gumption(&folder, &["diagnose", "case.toml"]);
        assert!(!good && told.matches("error[").count() == 1, "{told}");
        assert!(told.contains("8 more fields"), "{told}");
        assert!(told.contains(mend), "{told}");
    }
}

/// Parameters without a start enter linearly once what is stated of the others holds: a known error that two scale factors share
/// asks for none, and leaves them where straight lines have them.
#[test]
fn a_known_error_asks_for_no_start_of_the_others() {
    let mut noise = Noise(41);
    let mut rows = "omega [deg/s],U [mV],V [mV]\n".to_owned();
    let (mut squares, mut products) = (0.0, [0.0; 2]);
    for row in 0..15 {
        let omega = f64::from(row % 5) * 50.0 - 100.0;
        let (u, v) = (
            2.0 * omega + 0.3 + 0.02 * noise.normal(),
            1.5 * omega - 0.2 + 0.02 * noise.normal(),
        );
        let _ = writeln!(rows, "{omega},{u:.9},{v:.9}");
        squares += omega * omega;
        products = [products[0] + omega * u, products[1] + omega * v];
    }
    let case = "equations = [\"U = K*omega*(1 + e) + b\", \"V = L*omega*(1 + e) + c\"]\n[columns]\nU = \"output\"\nV = \"output\"\nomega = \"stimulus\"\n[input.e]\nu = 1e-4\n[noise]\nu = \"0.02 mV\"\n";
    let found = diagnosed_with("shared-scale", &rows, case);
    for (name, sum) in ["K", "L"].into_iter().zip(products) {
        let all = parameters(&found);
        let own = all.iter().find(|(own, ..)| own == name);
        let slope = own.expect("a scale factor").2;
        assert!((slope - sum / squares).abs() < 1e-7, "{name} = {slope}");
    }
}

/// An error that all readings of an output share is in the parameters: its zero is that of the voltmeter.
#[test]
fn a_common_error_of_an_output_is_in_the_parameters() {
    let mut noise = Noise(43);
    let mut rows = "omega [deg/s],U [mV]\n".to_owned();
    for row in 0..20 {
        let omega = f64::from(row % 5) * 50.0 - 100.0;
        let _ = writeln!(
            rows,
            "{omega},{:.9}",
            2.0 * omega + 0.3 + 0.02 * noise.normal()
        );
    }
    let case = "equations = \"U = K*omega + b\"\n[columns]\nU = \"output\"\nomega = \"stimulus\"\n[reading.U]\ncomponents = [ { u = 0.02 }, { name = \"zero\", source = \"zero\" } ]\n[source.zero]\nunit = \"µV\"\nu = 30\n[noise]\nfrom = \"stated\"\n";
    let found = diagnosed_with("common-of-output", &rows, case);
    let all = found["parameters"].as_array().expect("parameters");
    let u = |name: &str| {
        let own = all.iter().find(|one| one["name"] == name);
        own.expect("a parameter")["u"].as_f64().expect("u")
    };
    // σ²/n beside the common error; the scale factor has none of it, σ²/Σω².
    let expected = (0.02_f64.powi(2) / 20.0 + 0.03_f64.powi(2)).sqrt();
    assert!((u("b") / expected - 1.0).abs() < 0.02, "{found:#}");
    let expected = 0.02 / 100_000.0_f64.sqrt();
    assert!((u("K") / expected - 1.0).abs() < 0.02, "{found:#}");
}

/// A standard that was recalibrated every quarter, and repaired in July 2023.
#[test]
fn moments_of_the_calendar_are_told_by_the_calendar() {
    let mut noise = Noise(3);
    let mut rows = "date,U [V]\n".to_owned();
    let quarters =
        (2019..2027).flat_map(|year| ["01-15", "04-17", "07-20", "10-16"].map(|day| (year, day)));
    for (year, day) in quarters {
        let repaired = (year, day) >= (2023, "07-20");
        let jump = if repaired { 1.5e-4 } else { 0.0 };
        let _ = writeln!(
            rows,
            "{year}-{day},{:.6}",
            10.0 + jump + 2e-5 * noise.normal()
        );
    }
    let case = "equations = \"U = U0\"\n[columns]\nU = \"output\"\ndate = \"time\"\n";
    let found = diagnosed_with("calendar", &rows, case);
    let statement = found["statement"].as_str().unwrap_or_default();
    assert!(statement.contains("at date = 2023-07-20"), "{statement}");
    let place = found["located"][0]["level"].as_str().unwrap_or_default();
    assert!(
        place.starts_with("20") && place.contains(" to 20"),
        "{found}"
    );
}
