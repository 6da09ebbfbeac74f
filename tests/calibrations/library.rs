//! The calibrations of `experiments/`: every file evaluates, and finds the values that its readings were made
//! with; procedures against the formulas of their clauses; what schedules can and cannot tell.

use crate::common;
use std::path::Path;

use gumption::calibrate::{Calibration, Campaign, Coefficient, Plan, calibrate, load, plan, read};
use gumption::experiment::Purpose;

fn campaign(file: &str, purpose: Purpose) -> Campaign {
    let path = common::root().join("experiments").join(file);
    load(&path, purpose).unwrap_or_else(|rejection| panic!("{}", rejection.render(false)))
}

fn calibrated(file: &str) -> Calibration {
    calibrate(&campaign(file, Purpose::Calibrate)).unwrap_or_else(|why| panic!("{file}: {why:?}"))
}

fn planned(toml: &str) -> Plan {
    let campaign = read(toml, "plan.toml", Path::new(""), Purpose::Plan)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    plan(&campaign).expect("a plan")
}

fn coefficient<'a>(found: &'a Calibration, name: &str) -> &'a Coefficient {
    let coefficients = &found.figures.coefficients;
    let named = coefficients.iter().find(|c| c.name == name);
    named.unwrap_or_else(|| panic!("no coefficient {name}"))
}

fn near(obtained: f64, expected: f64, tolerance: f64) {
    assert!(
        (obtained - expected).abs() <= tolerance * expected.abs(),
        "{obtained} instead of {expected}"
    );
}

/// `NAME = NUMBER` in the comments of a recording: what its readings were made with.
fn truths(csv: &str) -> Vec<(String, f64)> {
    let comments: Vec<&str> = csv.lines().filter(|line| line.starts_with('#')).collect();
    let words: Vec<String> = comments
        .join(" ")
        .split_whitespace()
        .map(|word| word.trim_end_matches([',', ';', ':', '.']).to_owned())
        .collect();
    words
        .windows(3)
        .filter(|words| words[1] == "=")
        .filter_map(|words| Some((words[0].clone(), words[2].parse().ok()?)))
        .collect()
}

#[test]
fn every_simulated_calibration_finds_what_its_readings_were_made_with() {
    let mut checked = 0;
    for path in common::calibrations() {
        let Ok(csv) = std::fs::read_to_string(path.with_extension("csv")) else {
            continue;
        };
        if !csv.contains("Illustrative") {
            continue;
        }
        let file = path.file_name().expect("a file").to_string_lossy();
        let found = calibrated(&file);
        let truths = truths(&csv);
        for found in &found.figures.coefficients {
            let Some((name, truth)) = truths.iter().find(|(name, _)| *name == found.name) else {
                continue;
            };
            checked += 1;
            // Twice the expanded uncertainty: one of 10⁴ would be farther off.
            assert!(
                (found.value - truth).abs() < 2.0 * found.k * found.u,
                "{file}: {name} = {} ± {} for {truth}",
                found.value,
                found.u
            );
        }
    }
    assert!(checked > 90, "{checked} coefficients only");
}

/// Columns of numbers of a recording, without comments and names.
fn column(file: &str, place: usize) -> Vec<f64> {
    let path = common::root().join("experiments").join(file);
    let text = std::fs::read_to_string(path).expect("a recording");
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| {
        let field = row.split(',').nth(place).expect("a field");
        field.parse().expect("a number")
    })
    .collect()
}

#[test]
fn the_scale_factor_is_the_slope_of_clause_7_2_1() {
    let (x, u) = (
        column("gyro-scale-factor.csv", 0),
        column("gyro-scale-factor.csv", 1),
    );
    let n = x.len() as f64;
    let (mx, mu) = (x.iter().sum::<f64>() / n, u.iter().sum::<f64>() / n);
    let products: f64 = x.iter().zip(&u).map(|(x, u)| (x - mx) * (u - mu)).sum();
    let squares: f64 = x.iter().map(|x| (x - mx) * (x - mx)).sum();
    let found = calibrated("gyro-scale-factor.toml");
    let k = products / squares;
    near(coefficient(&found, "K").value, k, 1e-12);
    near(coefficient(&found, "b").value, mu - k * mx, 1e-9);
    // The certificate of the table acts on all rates alike and does not average: u(K) ≥ K·1e-4.
    assert!(coefficient(&found, "K").u > k * 1e-4);
    // Earth's rate is the same in every point: it shifts b by K·Ω, and K not at all.
    let earth = found.aliases.iter().find(|alias| alias.name == "earth");
    let earth = earth.expect("an omitted effect");
    assert!(earth.visible < 1e-9 && earth.shifts[0].abs() < 1e-12);
    near(earth.shifts[1], k / 3600.0, 1e-9);
}

#[test]
fn bias_and_acceleration_sensitivity_are_those_of_clause_7_2_2() {
    // Rows: x up, x down, y up, y down, z up, z down.
    let found = calibrated("gyro-bias.toml");
    for (place, gyro) in [(1, "x"), (2, "y"), (3, "z")] {
        let u = column("gyro-bias.csv", place);
        let bias = coefficient(&found, &format!("Bg{gyro}")).value;
        near(bias, u.iter().sum::<f64>() / 6.0, 1e-9);
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            let g = coefficient(&found, &format!("G{gyro}{name}")).value;
            near(g, (u[2 * axis] - u[2 * axis + 1]) / 2.0, 1e-9);
        }
    }
    // u(B) = s/√6 and u(G) = s/√2, of one s with two degrees of freedom.
    let (b, g) = (coefficient(&found, "Bgx"), coefficient(&found, "Gxx"));
    near(g.u / b.u, 3f64.sqrt(), 1e-9);
    near(g.dof, 2.0, 1e-9);
    // The vertical component of the Earth's rate goes into Gxx in full and is not seen.
    let earth = found.aliases.iter().find(|alias| alias.name == "earth_x");
    let earth = earth.expect("an omitted effect");
    assert!(earth.visible < 1e-9);
    near(earth.shifts[3], 1.0, 1e-9);
}

#[test]
fn installation_errors_are_those_of_whole_turns() {
    // (E_y1 − E_y2)/(2 M E_1y), with two turns each way.
    let found = calibrated("gyro-installation.toml");
    let y = column("gyro-installation.csv", 3);
    let mean = |from: usize| 0.5 * (y[from] + y[from + 1]);
    let scale = (mean(4) - mean(6)) / 720.0;
    near(coefficient(&found, "Sy").value, scale, 1e-9);
    near(
        coefficient(&found, "Eyx").value,
        (mean(0) - mean(2)) / (720.0 * scale),
        1e-9,
    );
}

#[test]
fn the_scale_factor_without_a_level() {
    // K1 = √[((E90 − E270)/2)² + ((E0 − E180)/2)²]/(g R), but for K2·δ², which is 5e-11 here.
    let found = calibrated("tumble-level-unknown.toml");
    let [e0, e90, e180, e270] = [0.0601, 99.9047, -0.1018, -99.9304_f64];
    let k1 = ((e90 - e270) / 2.0).hypot((e0 - e180) / 2.0) / 500.0;
    near(coefficient(&found, "K1").value, k1, 1e-9);
    let angle = ((e0 - e180) / (e90 - e270)).atan();
    near(coefficient(&found, "theta0").value, angle, 1e-3);
}

#[test]
fn four_positions_hide_what_they_cannot_tell() {
    let found = plan(&campaign("tumble-plan.toml", Purpose::Plan)).expect("a plan");
    assert_eq!(found.identifiability.rank, 4);
    let shifts = |name: &str| {
        let alias = found.aliases.iter().find(|alias| alias.name == name);
        let alias = alias.unwrap_or_else(|| panic!("no {name}"));
        assert!(alias.visible < 1e-9, "{name}");
        alias.shifts.clone()
    };
    // K0, K1, K2, delta_o. sin³ = sin: K3 is in K1.
    near(shifts("K3")[1], 0.2, 1e-9);
    // cos² = 1 − sin²: Kpp has the contrast of the bias, and the opposite one of K2.
    near(shifts("Kpp")[0], 1.0, 1e-9);
    near(shifts("Kpp")[2], -1.0, 1e-9);
    // |sin| = sin²: the asymmetry is in K2.
    near(shifts("asymmetry")[2], 1.0, 1e-9);
    // The level angle is in the misalignment.
    near(shifts("levelling")[3], -1.0, 1e-9);
}

/// A plan of N positions for the general tumble.
fn tumble(positions: usize, more: &str) -> Plan {
    let angles: Vec<String> = (0..positions)
        .map(|i| format!("{}", 360.0 * i as f64 / positions as f64))
        .collect();
    let angles = angles.join(", ");
    planned(&format!(
        "procedure = \"accelerometer-tumble\"\n[schedule]\n\"theta [deg]\" = [{angles}]\n[columns.E]\nunit = \"mV\"\n\
         [constant]\ng = \"1 gn\"\n[parameter.K1]\nstart = 250\n[reading.E]\nu = 0.001\n{more}"
    ))
}

#[test]
fn positions_that_the_coefficients_of_a_tumble_need() {
    // Harmonics 0 to 3 of the angle: six positions alias sin 3θ with sin(−3θ), seven and more do not.
    assert_eq!(tumble(4, "").identifiability.rank, 4);
    assert_eq!(tumble(6, "").identifiability.rank, 5);
    let names: Vec<&str> = tumble(6, "")
        .identifiability
        .undetermined
        .iter()
        .flat_map(|combination| combination.changes.iter().map(|change| change.0.clone()))
        .map(|name| if name == "K3" { "K3" } else { "other" })
        .collect();
    assert!(names.contains(&"K3"), "{names:?}");
    assert_eq!(tumble(8, "").identifiability.rank, 6);
    let twelve = tumble(12, "");
    let figures = twelve.figures.expect("all is determined");
    let u = |name: &str| {
        let found = figures.coefficients.iter().find(|c| c.name == name);
        found.unwrap_or_else(|| panic!("no {name}")).u
    };
    // Orthogonal harmonics: u(δ) = s/K1·√(2/N); K2 = −2·(cosine of 2θ): 2·√(2/N).
    let s = 0.001 / 250.0;
    near(u("delta_o"), s * (2.0 / 12.0_f64).sqrt(), 1e-9);
    near(u("K2"), 2.0 * s * (2.0 / 12.0_f64).sqrt(), 1e-9);
    near(u("Kip"), 2.0 * s * (2.0 / 12.0_f64).sqrt(), 1e-9);
    near(u("K3"), 4.0 * s * (2.0 / 12.0_f64).sqrt(), 1e-9);
}

#[test]
fn an_unknown_level_and_a_misalignment_are_one_parameter() {
    let both = tumble(12, "[parameter.theta0]\nstart = 0\n");
    assert_eq!(
        (both.identifiability.rank, both.identifiability.parameters),
        (6, 7)
    );
    let names: Vec<String> = both.identifiability.undetermined[0]
        .changes
        .iter()
        .map(|change| change.0.clone())
        .collect();
    assert!(
        names.contains(&"theta0".to_owned()) && names.contains(&"delta_o".to_owned()),
        "{names:?}"
    );
    // Partly known, both can be found: the prior of the level is what tells them apart.
    let partly = tumble(
        12,
        "[parameter.theta0]\nstart = 0\n[input.theta0]\nvalue = 0\nu = 1e-5\n",
    );
    assert_eq!(partly.identifiability.rank, 7);
    let figures = partly.figures.expect("all is determined");
    let delta = figures.coefficients.iter().find(|c| c.name == "delta_o");
    near(
        delta.expect("a coefficient").u,
        1e-5_f64.hypot(4e-6 * (2.0 / 12.0_f64).sqrt()),
        1e-3,
    );
}

#[test]
fn one_sense_of_rotation_does_not_tell_rate_from_its_square() {
    let schedule = |rates: &str, axes: &str| {
        planned(&format!(
            "procedure = \"accelerometer-rate-sensitivity-both\"\n[schedule]\naxis = [{axes}]\n\"omega [rad/s]\" = [{rates}]\n\
             [columns]\nUax = {{ unit = \"m/s^2\" }}\nUay = {{ unit = \"m/s^2\" }}\nUaz = {{ unit = \"m/s^2\" }}\n"
        ))
    };
    let one = schedule("0, 10, 0, 10, 0, 10", r#""x", "x", "y", "y", "z", "z""#);
    assert_eq!(one.identifiability.rank, 15);
    assert_eq!(one.identifiability.undetermined.len(), 6);
    let both = schedule(
        "0, 10, -10, 0, 10, -10, 0, 10, -10",
        r#""x", "x", "x", "y", "y", "y", "z", "z", "z""#,
    );
    assert_eq!(both.identifiability.rank, 21);
}

#[test]
fn the_unit_check_tells_model_2_from_formula_12() {
    // p of model (2) is an output per rate, p of (12) an output per square of the rate.
    let unit_of = |procedure: &str| {
        let toml = format!(
            "procedure = \"{procedure}\"\n[schedule]\naxis = [\"x\", \"x\", \"y\", \"y\", \"z\", \"z\"]\n\
             \"omega [rad/s]\" = [0, 10, 0, 10, 0, 10]\n\
             [columns]\nUax = {{ unit = \"m/s^2\" }}\nUay = {{ unit = \"m/s^2\" }}\nUaz = {{ unit = \"m/s^2\" }}\n\
             [noise]\nu = \"0.01 m/s^2\"\n"
        );
        let figures = planned(&toml).figures.expect("all is determined");
        let p = figures.coefficients.iter().find(|c| c.name == "pyx");
        p.expect("a coefficient").unit.clone()
    };
    let metre = gumption::quantity::UnitTable::default();
    let like = |text: &str| metre.parse(text).expect("a unit");
    let linear = unit_of("accelerometer-rate-sensitivity");
    let squared = unit_of("accelerometer-rate-sensitivity-squared");
    assert!(linear.conversion_to(&like("m/s")).is_some());
    assert!(squared.conversion_to(&like("m")).is_some());
    // (12) with the p of model (2): the dimensions do not fit.
    let mixed = "equations = [\"Uay = o - p*omega^2\"]\n[parameter]\no = { unit = \"m/s^2\" }\np = { unit = \"m/s\" }\n\
                 [schedule]\n\"omega [rad/s]\" = [0, 10]\n[columns.Uay]\nunit = \"m/s^2\"\n";
    let Err(rejection) = read(mixed, "mixed.toml", Path::new(""), Purpose::Plan) else {
        panic!("a speed times a rate squared is no acceleration");
    };
    let text = rejection.render(false);
    assert!(text.contains("omega^2") && text.contains("m/s"), "{text}");
}

/// σ·√(M⁻¹)_ii of the 65 positions, with K1 = 1: computed by another program from numerical derivatives of
/// rotation matrices.
const GIMBALS: [(&str, f64); 19] = [
    ("K0x", 0.1543),
    ("K0y", 0.1459),
    ("K0z", 0.1563),
    ("K1x", 0.2087),
    ("K1y", 0.2357),
    ("K1z", 0.2041),
    ("K2x", 0.2596),
    ("K2y", 0.2772),
    ("K2z", 0.2571),
    ("m_xz", 0.2041),
    ("m_yx", 0.2086),
    ("m_yz", 0.2041),
    ("m_zx", 0.2087),
    ("m_zy", 0.2357),
    ("psi", 0.1241),
    ("phi_x0", 0.1241),
    ("phi_y0", 0.2041),
    ("eta_xy", 0.1562),
    ("eta_yz", 0.1241),
];

#[test]
fn the_65_positions_as_predicted_and_as_found() {
    let path = common::root().join("experiments/gimbals-65-positions.toml");
    let toml = std::fs::read_to_string(&path).expect("a file")
        + "\n[parameter]\nK1x = { start = 1000 }\nK1y = { start = 1000 }\nK1z = { start = 1000 }\n\
           [reading]\nAx = { u = 0.005 }\nAy = { u = 0.005 }\nAz = { u = 0.005 }\n";
    let folder = path.parent().expect("a folder");
    let planned = read(&toml, "gimbals.toml", folder, Purpose::Plan)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let planned = plan(&planned).expect("a plan");
    assert_eq!(planned.identifiability.rank, 19);
    let figures = planned.figures.expect("all is determined");
    for (name, expected) in GIMBALS {
        let found = figures.coefficients.iter().find(|c| c.name == name);
        let scale = if name.starts_with("K1") { 0.005 } else { 5e-6 };
        near(found.expect(name).u, expected * scale, 2e-3);
    }
    // Found from readings of that scatter: 195 readings, 19 coefficients.
    let found = calibrated("gimbals-65-positions.toml");
    for (name, expected) in GIMBALS {
        let scale = if name.starts_with("K1") { 0.005 } else { 5e-6 };
        near(coefficient(&found, name).u, expected * scale, 0.25);
    }
}

/// The blocks of a page that are calibration files whose recordings are in `experiments/`.
fn examples(page: &str) -> Vec<String> {
    page.split("```toml calibration\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .map(str::to_owned)
        .collect()
}

#[test]
fn every_example_of_the_page_of_procedures_is_a_file_that_evaluates() {
    let path = common::root().join("docs/procedures.md");
    let examples = examples(&std::fs::read_to_string(path).expect("the page"));
    let mut files: Vec<String> = common::calibrations()
        .iter()
        .map(|path| std::fs::read_to_string(path).expect("a file"))
        .collect();
    for example in examples {
        let Some(place) = files.iter().position(|file| *file == example) else {
            panic!("no file of experiments/ is\n{example}");
        };
        files.remove(place);
        let folder = common::root().join("experiments");
        let purpose = match example.contains("[recording]") {
            true => Purpose::Calibrate,
            false => Purpose::Plan,
        };
        let campaign = read(&example, "docs/procedures.md", &folder, purpose)
            .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
        match purpose {
            Purpose::Calibrate => drop(calibrate(&campaign).expect("coefficients")),
            Purpose::Plan => drop(plan(&campaign).expect("a plan")),
        }
    }
    assert!(files.is_empty(), "not in docs/procedures.md:\n{files:?}");
}

#[test]
fn the_list_of_procedures_is_fresh() {
    let mut page = String::from(
        "# Procedures of the library\n\nMade from the procedures themselves. [procedures.md](../procedures.md) says how to use them, with an example of each.\n",
    );
    for procedure in gumption::experiment::procedure::PROCEDURES {
        page += &listed(procedure.name, procedure.text);
    }
    let path = common::root().join("docs/reference/procedures.md");
    let stale: Vec<String> = common::stale(&path, &page).into_iter().collect();
    common::assert_fresh(&stale);
}

/// A procedure as a section.
fn listed(name: &str, text: &str) -> String {
    let table: toml::Table = text.parse().expect("a procedure is TOML");
    let word = |table: &toml::Table, key: &str| -> String {
        let value = table.get(key).and_then(toml::Value::as_str);
        value.unwrap_or_default().trim().to_owned()
    };
    let mut section = format!(
        "\n## {name}\n\n{} / {}. {}\n\n{}\n\n```text\n",
        word(&table, "title"),
        word(&table, "title_zh"),
        word(&table, "reference"),
        word(&table, "description"),
    );
    let statements = word(&table, "model");
    let equations = table.get("equations").and_then(toml::Value::as_array);
    let equations = equations
        .into_iter()
        .flatten()
        .filter_map(toml::Value::as_str);
    for line in statements.lines().chain(equations) {
        section += line;
        section.push('\n');
    }
    section += "```\n\n| kind | name | unit | what it is |\n|---|---|---|---|\n";
    for (kind, key) in [
        ("column", "columns"),
        ("parameter", "parameter"),
        ("input", "input"),
        ("result", "result"),
        ("omitted effect", "omitted"),
    ] {
        let entries = table.get(key).and_then(toml::Value::as_table);
        for (name, entry) in entries.into_iter().flatten() {
            let entry = entry.as_table().expect("an entry is a table");
            let unit = match (word(entry, "unit"), word(entry, "like")) {
                (unit, like) if unit.is_empty() && !like.is_empty() => format!("like `{like}`"),
                (unit, _) if unit.is_empty() => String::new(),
                (unit, _) => format!("`{unit}`"),
            };
            let mut what = format!(
                "{} / {}",
                word(entry, "description"),
                word(entry, "description_zh")
            );
            let scope = (word(entry, "scope"), word(entry, "by"));
            match scope {
                (scope, _) if scope == "each" => what += " (one error for each point)",
                (_, by) if !by.is_empty() => what += &format!(" (one error for each {by})"),
                _ => {}
            }
            if entry.get("required").and_then(toml::Value::as_bool) == Some(true) {
                what += " (must be stated)";
            }
            let term = word(entry, "term");
            if !term.is_empty() {
                what += &format!(": `{term}`");
            }
            section += &format!("| {kind} | `{name}` | {unit} | {what} |\n");
        }
    }
    if let Some(positions) = table.get("positions").and_then(toml::Value::as_table) {
        let labels = positions.get("at").and_then(toml::Value::as_table);
        let labels: Vec<String> = labels
            .into_iter()
            .flatten()
            .map(|(label, _)| format!("`{label}`"))
            .collect();
        section += &format!(
            "\nLabels of `{}`: {}.\n",
            word(positions, "column"),
            labels.join(", ")
        );
    }
    section
}

#[test]
fn the_example_of_the_page_of_recordings_evaluates() {
    let path = common::root().join("docs/recordings.md");
    let page = std::fs::read_to_string(path).expect("the page");
    let block = |opening: &str| {
        let rest = page.split(opening).nth(1).expect("a block");
        rest.split("```").next().expect("its end").to_owned()
    };
    let folder = common::folder("recordings");
    folder.put("samples.csv", block("```text\n"));
    let toml = block("```toml calibration-file\n");
    let campaign = read(&toml, "docs/recordings.md", &folder, Purpose::Calibrate)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let found = calibrate(&campaign).expect("coefficients");
    // The first sample of each dwell is left out: means of 1001.1, 1001.2, 1001.3 and −998.9, −998.7, −998.9.
    let means = [1001.2, -2996.5 / 3.0];
    near(
        coefficient(&found, "K").value,
        (means[0] - means[1]) / 2.0,
        1e-12,
    );
    assert!(coefficient(&found, "K").u > 0.0);
}
