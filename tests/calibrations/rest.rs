//! A triad that is turned by hand, without a table: its rests are found in the samples.

use gumption::calibrate::{calibrate, read};
use gumption::experiment::Purpose;

/// Directions of gravity that are no multiples of one another.
const ATTITUDES: [[f64; 3]; 12] = [
    [1.0, 0.1, 0.0],
    [-1.0, 0.0, 0.2],
    [0.1, 1.0, 0.0],
    [0.0, -1.0, 0.1],
    [0.2, 0.0, 1.0],
    [0.0, 0.1, -1.0],
    [1.0, 1.0, 0.3],
    [1.0, -0.2, 1.0],
    [0.1, 1.0, 1.0],
    [-1.0, 1.0, -0.3],
    [0.2, -1.0, 1.0],
    [-1.0, 0.1, -1.0],
];

/// Fifty samples at rest in each attitude, with ten on the way to it.
fn recording() -> String {
    let (k, b) = ([1.01, 0.99, 1.005], [0.1, -0.2, 0.15]);
    let mut csv = "time,ax [m/s2],ay [m/s2],az [m/s2]\n".to_owned();
    let mut row = 0_u32;
    for direction in ATTITUDES {
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        for sample in 0..60_u32 {
            let moving = if sample < 10 { 1.0 } else { 0.002 };
            let a: [f64; 3] = std::array::from_fn(|axis| {
                let noise = f64::from((row * 7919 + axis as u32 * 104_729) % 1009) / 1009.0 - 0.5;
                k[axis] * 9.8 * direction[axis] / length + b[axis] + moving * noise
            });
            let (minutes, seconds) = (row / 600, f64::from(row % 600) / 10.0);
            csv += &format!(
                "14:{minutes:02}:{seconds:04.1},{},{},{}\n",
                a[0], a[1], a[2]
            );
            row += 1;
        }
    }
    csv
}

#[test]
fn rests_are_found_and_calibrated() {
    let folder = crate::common::folder("rest");
    folder.put("phone.csv", recording());
    let toml = "procedure = \"accelerometer-norm\"\n[constant]\ng = \"9.8 m/s^2\"\n\
        [recording]\nfile = \"phone.csv\"\nstill = 30\nsettle = \"0.5 s\"\n\
        [columns]\ntime = \"time\"\nUx = { column = \"ax\" }\nUy = { column = \"ay\" }\nUz = { column = \"az\" }\n\
        [parameter]\nKx = { start = 1 }\nKy = { start = 1 }\nKz = { start = 1 }\n\
        bx = { start = 0 }\nby = { start = 0 }\nbz = { start = 0 }\n";
    let campaign = |toml: &str| {
        read(toml, "phone.toml", &folder, Purpose::Calibrate)
            .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)))
    };
    let rests = campaign(toml);
    assert_eq!(rests.points.len(), ATTITUDES.len());
    let found = calibrate(&rests).expect("coefficients");
    let value = |name: &str| {
        let found = found
            .figures
            .coefficients
            .iter()
            .find(|one| one.name == name);
        found.expect("a coefficient").value
    };
    for (name, truth) in [
        ("Kx", 1.01),
        ("Ky", 0.99),
        ("Kz", 1.005),
        ("bx", 0.1),
        ("by", -0.2),
        ("bz", 0.15),
    ] {
        assert!(
            (value(name) - truth).abs() < 1e-3,
            "{name} = {}",
            value(name)
        );
    }
    // Without a word on rests each row would be a point: that is said.
    let rows = campaign(&toml.replace("still = 30\nsettle = \"0.5 s\"\n", ""));
    let said = rows
        .points
        .findings
        .iter()
        .map(|finding| finding.said().to_string());
    assert!(
        said.collect::<String>()
            .contains("each of the 720 rows counts as a point")
    );
}
