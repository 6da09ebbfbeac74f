//! Recordings that others have published, of other fields than ours: what was left out of the model is known from their discussions.

use crate::common::cases::{diagnosed_with as diagnosed, first_names, named_apart};

/// Distance in miles, climb in feet and record time in minutes of the Scottish hill races of 1984 (A. C. Atkinson, Statistical
/// Science 1 (1986) 397): the time of row 18 is an hour too long in the records, and the climb belongs into the model.
const HILL_RACES: &str = "dist,climb,time
2.5,650,16.083\n6,2500,48.35\n6,900,33.65\n7.5,800,45.6\n8,3070,62.267\n8,2866,73.217\n16,7500,204.617
6,800,36.367\n5,800,29.75\n6,650,39.75\n28,2100,192.667\n5,2000,43.05\n9.5,2200,65\n6,500,44.133
4.5,1500,26.933\n10,3000,72.25\n14,2200,98.417\n3,350,78.65\n4.5,1000,17.417\n5.5,600,32.567\n3,300,15.95
3.5,1500,27.9\n6,2200,47.633\n2,900,17.933\n3,600,18.683\n4,2000,26.217\n6,800,34.433\n5,950,28.567
6.5,1750,50.5\n5,500,20.95\n10,4400,85.583\n6,600,32.383\n18,5200,170.25\n4.5,850,28.1\n20,5000,159.833
";

/// Neither the climb, of which three races have most, nor the wrong time stands out beside such scatter: both together do.
#[test]
fn a_condition_beside_a_wild_reading_is_named() {
    let case = "equations = \"time = a + b*dist\"\n[columns]\ndist = \"stimulus\"\nclimb = \"covariate\"\ntime = \"output\"\n";
    let found = diagnosed("hills", HILL_RACES, case);
    let named = &found["effects"][0]["named"];
    for name in named.as_array().into_iter().flatten() {
        assert_eq!(name["along"], "climb", "{found}");
    }
    assert!(first_names(&found)[0].starts_with("sensitivity"), "{found}");
}

/// Four recordings of one line, one scatter and one correlation (F. J. Anscombe, The American Statistician 27 (1973) 17).
#[test]
fn recordings_of_one_line_are_told_apart() {
    const X: [u32; 11] = [10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5];
    const OF_ONE: u32 = 8;
    let noise = [
        8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68,
    ];
    let parabola = [
        9.14, 8.14, 8.74, 8.77, 9.26, 8.10, 6.13, 3.10, 9.13, 7.26, 4.74,
    ];
    let wild = [
        7.46, 6.77, 12.74, 7.11, 7.81, 8.84, 6.08, 5.39, 8.15, 6.42, 5.73,
    ];
    let alone = [
        6.58, 5.76, 7.71, 8.84, 8.47, 7.04, 5.25, 12.50, 5.56, 7.91, 6.89,
    ];
    let mut one = [OF_ONE; 11];
    one[7] = 19;
    let case = "equations = \"y = a + b*x\"\n[columns]\nx = \"stimulus\"\ny = \"output\"\n";
    let one_name = |id: &'static str| vec![id];
    let cases = [
        ("noise", X, noise, Vec::new()),
        ("parabola", X, parabola, one_name("quadratic")),
        ("wild", X, wild, one_name("outlier")),
        ("alone", one, alone, Vec::new()),
    ];
    for (name, x, y, expected) in cases {
        let rows = x.iter().zip(y).map(|(x, y)| format!("{x},{y:.2}\n"));
        let rows: String = std::iter::once("x,y\n".to_owned()).chain(rows).collect();
        let found = diagnosed(&format!("anscombe-{name}"), &rows, case);
        assert_eq!(first_names(&found), expected, "{name} {found}");
    }
}

/// The boiling point of water in °F and the barometer in inches of mercury in the Alps and in Scotland (J. D. Forbes, Transactions of
/// the Royal Society of Edinburgh 21 (1857) 135): one of seventeen does not belong to the others.
#[test]
fn a_wrong_reading_of_a_barometer_is_found() {
    let rows = "T [degF],p\n194.5,20.79\n194.3,20.79\n197.9,22.4\n198.4,22.67\n199.4,23.15\n199.9,23.35\n200.9,23.89\n201.1,23.99\n201.4,24.02\n201.3,24.01\n203.6,25.14\n204.6,26.57\n209.5,28.49\n208.6,27.76\n210.7,29.04\n211.9,29.88\n212.2,30.06\n";
    let case = "equations = \"p = a*exp(b*(T - T0))\"\n[columns]\nT = \"stimulus\"\np = \"output\"\n[constant]\nT0 = \"203 degF\"\n[parameter]\na = { start = 25 }\nb = { start = \"0.02 1/K\" }\n";
    let found = diagnosed("forbes", rows, case);
    assert_eq!(first_names(&found), ["outlier"], "{found}");
    let label = &found["effects"][0]["named"][0]["variants"][0]["label"];
    assert_eq!(label, "row 12", "{found}");
}

/// The rate of an enzyme in counts/min² over the concentration in ppm, with cells treated with puromycin and without (M. A. Treloar 1974,
/// in Bates and Watts 1988, table A1.3): the largest rate differs, the constant of Michaelis does not show that it does.
#[test]
fn a_treatment_changes_the_largest_rate() {
    const CONCENTRATIONS: [f64; 12] = [
        0.02, 0.02, 0.06, 0.06, 0.11, 0.11, 0.22, 0.22, 0.56, 0.56, 1.10, 1.10,
    ];
    let treated = [76, 47, 97, 107, 123, 139, 159, 152, 191, 201, 207, 200];
    let untreated = [67, 51, 84, 86, 98, 115, 131, 124, 144, 158, 160];
    let of = |rates: &[i32], state: &str| {
        let both = CONCENTRATIONS.iter().zip(rates.to_vec());
        let rows = both.map(|(c, rate)| format!("{c},{rate},{state}\n"));
        rows.collect::<String>()
    };
    let rows = format!(
        "conc,rate,state\n{}{}",
        of(&treated, "treated"),
        of(&untreated, "untreated")
    );
    let case = "equations = \"rate = Vm*conc/(K + conc)\"\n[columns]\nconc = \"stimulus\"\nrate = \"output\"\nstate = \"factor\"\n[parameter]\nVm = { start = 200 }\nK = { start = 0.06 }\n";
    let found = diagnosed("puromycin", &rows, case);
    assert_eq!(named_apart(&found)[0][0], "level-scale", "{found}");
}
