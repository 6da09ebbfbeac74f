//! A case as files: the recording, the held-out campaign, the recording at rest, and the experiment
//! that says how they were made and nothing of what is concealed.

use rand::RngExt;

use super::further::Further;
use super::random::{Stream, source};
use super::rig::Rig;
use super::scenario::{Class, Drawn, NoiseKnowledge};
use super::schedule::Campaign;
use super::simulate::{Readings, at_rest, duration, simulate, simulate_longer};
use super::world::Row;

/// Name of the experiment.
pub(super) const CASE: &str = "CASE.toml";
/// Name of the recording.
pub(super) const RECORDING: &str = "recording.csv";
/// Name of the held-out campaign.
pub(super) const HELD_OUT: &str = "held-out.csv";
/// Name of the recording at rest.
pub(super) const AT_REST: &str = "at-rest.csv";

/// A file of a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseFile {
    /// Its name.
    pub name: &'static str,
    /// Its text.
    pub text: String,
}

/// A column of a recording: heading, digits after the point, value.
type Column = (&'static str, usize, fn(&Row) -> f64);

/// The recordings of a drawn case; the calibration with a further measurement behind it, if there is one.
pub(super) fn recordings(drawn: &Drawn, further: Option<Further>) -> Vec<CaseFile> {
    let effects = drawn.concealed();
    let columns = columns(drawn);
    let rows = |campaign| simulate(&drawn.setup, campaign, &effects, Readings::Real);
    let calibration = match further {
        Some(what) => simulate_longer(&drawn.setup, what, &effects),
        None => rows(Campaign::Calibration),
    };
    let table = |rows: &[Row]| table(&columns, rows, drawn.setup.rig);
    let rig = drawn.setup.rig;
    let length = 3.0 * duration(rig, Campaign::Calibration, drawn.setup.seed);
    let mut rest = format!(
        "time [h],{}\n",
        outputs(rig).map(heading).collect::<Vec<_>>().join(",")
    );
    for (time, output) in at_rest(&drawn.setup, length) {
        let values: Vec<String> = outputs(rig)
            .zip(output)
            .map(|((_, _, digits), y)| format!("{:.digits$}", y * rig.sensitivity()))
            .collect();
        rest += &format!("{:.5},{}\n", time / 3600.0, values.join(","));
    }
    vec![
        CaseFile {
            name: RECORDING,
            text: table(&calibration),
        },
        CaseFile {
            name: HELD_OUT,
            text: table(&rows(Campaign::HeldOut)),
        },
        CaseFile {
            name: AT_REST,
            text: rest,
        },
    ]
}

/// Name, unit and digits of the outputs of a rig.
pub(super) fn outputs(rig: Rig) -> impl Iterator<Item = (&'static str, &'static str, usize)> {
    let rows: &[(&str, &str, usize)] = match rig {
        Rig::Tumble | Rig::Remount => &[("U", "mV", 5)],
        Rig::Triad => &[("ax", "gn", 8), ("ay", "gn", 8), ("az", "gn", 8)],
        Rig::RateTable => &[("wx", "°/s", 6), ("wy", "°/s", 6), ("wz", "°/s", 6)],
    };
    rows.iter().copied()
}

fn heading((name, unit, _): (&'static str, &'static str, usize)) -> String {
    format!("{name} [{unit}]")
}

/// A thermometer is there unless the scenario hides it; now and then it is missing where that does
/// no harm, so that its absence tells nothing.
fn has_thermometer(drawn: &Drawn) -> bool {
    let mut random = source(drawn.setup.seed, Stream::Case, 1);
    let missing = random.random_bool(0.12);
    let needed = drawn
        .concealed()
        .iter()
        .any(|effect| effect.physics.name().starts_with("temp"));
    drawn.scenario.class != Class::Hidden && (needed || !missing)
}

/// The columns before the outputs.
fn columns(drawn: &Drawn) -> Vec<Column> {
    let mut columns: Vec<Column> = vec![
        ("time [h]", 5, |row| row.time / 3600.0),
        ("run", 0, |row| (row.run + 1) as f64),
    ];
    match drawn.setup.rig {
        Rig::Tumble | Rig::Remount => columns.extend([MOUNT, HEAD]),
        Rig::Triad => columns.extend([
            ("azimuth [°]", 2, |row| row.pose.outer.to_degrees()),
            ("elevation [°]", 2, |row| row.pose.inner.to_degrees()),
        ] as [Column; 2]),
        Rig::RateTable => columns.extend([
            ("mount", 0, |row| (row.pose.mount + 1) as f64),
            ("rate [°/s]", 3, |row| row.pose.rate),
            ("table [°]", 1, |row| row.pose.table.to_degrees()),
            ("cx", 0, |row| Rig::table_axis(row.pose.mount)[0]),
            ("cy", 0, |row| Rig::table_axis(row.pose.mount)[1]),
            ("cz", 0, |row| Rig::table_axis(row.pose.mount)[2]),
        ] as [Column; 6]),
    }
    if has_thermometer(drawn) {
        columns.push(("temperature [°C]", 3, |row| row.shown.temperature));
    }
    let rest: [Column; 4] = [
        ("humidity [%]", 2, |row| row.shown.humidity),
        ("pressure [hPa]", 2, |row| row.shown.pressure),
        ("supply [V]", 4, |row| row.shown.supply),
        ("vibration [gn]", 4, |row| row.shown.vibration),
    ];
    columns.extend(rest);
    columns
}

const HEAD: Column = ("head [°]", 2, |row| row.pose.outer.to_degrees());
const MOUNT: Column = ("mount [°]", 0, |row| {
    Rig::mount_angle(row.pose.mount).to_degrees()
});

fn table(columns: &[Column], rows: &[Row], rig: Rig) -> String {
    let mut text = columns
        .iter()
        .map(|(name, ..)| (*name).to_string())
        .collect::<Vec<_>>();
    text.extend(outputs(rig).map(heading));
    let mut text = text.join(",") + "\n";
    for row in rows {
        let mut fields: Vec<String> = columns
            .iter()
            .map(|(_, digits, value)| number(value(row), *digits))
            .collect();
        let outputs = outputs(rig).zip(row.output);
        fields.extend(outputs.map(|((_, _, digits), y)| number(y * rig.sensitivity(), digits)));
        text += &(fields.join(",") + "\n");
    }
    text
}

/// Decimal digits without a negative zero.
pub(super) fn number(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_string(),
        _ => text,
    }
}

/// The case file, with the seal of the truth.
pub(super) fn case_file(drawn: &Drawn, further: Option<Further>, seal: &str) -> CaseFile {
    let rig = drawn.setup.rig;
    let thermometer = if has_thermometer(drawn) {
        "temperature = \"covariate\"\n"
    } else {
        ""
    };
    let text = format!(
        r#"# Diagnose with: gumption diagnose CASE.toml
title = "{title}"
note = """
{prose}
The true causes are sealed in truth.json, which has the SHA-256
{seal}"""
recording = "{RECORDING}"

{model}
[columns]
time = "time"
run = "run"
{columns}{thermometer}humidity = "covariate"
pressure = "covariate"
supply = "covariate"
vibration = "covariate"
{outputs}
{noise}

[held_out]
file = "{HELD_OUT}"
"#,
        title = title(rig),
        prose = prose(rig).to_owned() + &further.map_or_else(String::new, |what| then(rig, what)),
        model = model(rig),
        columns = stimulus(rig),
        outputs = outputs(rig)
            .map(|(name, ..)| format!("{name} = \"output\"\n"))
            .collect::<String>(),
        noise = noise(drawn),
    );
    CaseFile { name: CASE, text }
}

fn title(rig: Rig) -> &'static str {
    match rig {
        Rig::Tumble => "Accelerometer on a dividing head",
        Rig::Remount => "Accelerometer on a dividing head, two mounts",
        Rig::Triad => "Accelerometer triad on a stand with two axes",
        Rig::RateTable => "Gyroscope triad on a rate table",
    }
}

fn prose(rig: Rig) -> &'static str {
    match rig {
        Rig::Tumble | Rig::Remount => {
            "A quartz accelerometer, read as the voltage across its resistor, on a dividing head with a
horizontal axis. Each row is the mean of 60 readings in one position; odd runs turn forwards, even
runs backwards. Time counts from power-on."
        }
        Rig::Triad => {
            "Three accelerometers in one housing on a stand with two axes. Each row is the mean of 60
readings in one orientation; all orientations were measured twice. Time counts from power-on."
        }
        Rig::RateTable => {
            "Three gyroscopes in one housing on a rate table with a vertical axis, in six mounts; cx, cy, cz
is the direction of the table's axis in the sensor, and so also that of gravity, downwards negative.
Each row is the mean of the readings while the table passes a gate at the table angle. Time counts
from power-on."
        }
    }
}

/// What is said of a further measurement.
fn then(rig: Rig, what: Further) -> String {
    let runs = rig.runs();
    let (first, last) = (runs + 1, 2 * runs);
    format!(
        "\nRuns {first} to {last} were measured after a pause, each like one of the runs before: {}.",
        what.in_words()
    )
}

fn model(rig: Rig) -> String {
    match rig {
        Rig::Tumble => "equations = \"U = K0 + K1*sin(head + mount) + Kd*cos(head + mount)\"\n".into(),
        Rig::Remount => "equations = \"U = K0 + K1*sin(head + mount) + Kd*cos(head + mount) + Ks*sin(mount)*cos(head + mount)\"\n".into(),
        Rig::Triad => {
            let row = |a: char| format!(
                "    \"a{a} = b{a} + M{a}x*cos(elevation)*cos(azimuth) + M{a}y*cos(elevation)*sin(azimuth) + M{a}z*sin(elevation)\",\n"
            );
            format!("equations = [\n{}]\n", ['x', 'y', 'z'].map(row).concat())
        }
        Rig::RateTable => {
            let row = |a: char| format!(
                "    \"w{a} = b{a} + S{a}x*rate*cx + S{a}y*rate*cy + S{a}z*rate*cz\",\n"
            );
            format!("equations = [\n{}]\n", ['x', 'y', 'z'].map(row).concat())
        }
    }
}

fn stimulus(rig: Rig) -> &'static str {
    match rig {
        Rig::Tumble | Rig::Remount => "mount = \"stimulus\"\nhead = \"angle\"\n",
        Rig::Triad => "azimuth = \"angle\"\nelevation = \"angle\"\n",
        Rig::RateTable => {
            "mount = \"position\"\nrate = \"stimulus\"\ntable = \"angle\"\ncx = \"stimulus\"\ncy = \"stimulus\"\ncz = \"stimulus\"\n"
        }
    }
}

fn noise(drawn: &Drawn) -> String {
    let rig = drawn.setup.rig;
    match drawn.knowledge {
        NoiseKnowledge::AtRest => format!("[noise]\nat_rest = {{ file = \"{AT_REST}\" }}"),
        NoiseKnowledge::Stated | NoiseKnowledge::StatedCorrelated => {
            // Without a walk every row has the same.
            let u = drawn.setup.noise.rms(&[0.0], rig.samples() as f64) * rig.sensitivity();
            let unit = outputs(rig).next().map_or("", |(_, unit, _)| unit);
            format!("[noise]\nu = \"{u} {unit}\"")
        }
        NoiseKnowledge::Estimated | NoiseKnowledge::EstimatedCorrelated => String::new(),
    }
}
