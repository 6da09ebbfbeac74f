//! What cells and columns state: estimates that rows share, degrees of freedom, types, units.

use super::{answer, first, is_sound};
use crate::claim::Stated;
use crate::read::Mapping;
use crate::{Verdict, claims};

/// Two reasons to doubt one input: its estimate, in another unit than u, stands in one of their rows.
#[test]
fn rows_of_one_symbol_share_their_estimate() {
    is_sound(
        "sheet.csv",
        "Gauge\nModel: e = p_x - p_s\n\
         Symbol,Source,Estimate,Half-width / U,Distribution,Divisor,u(x_i) (mbar),c_i,u_i(y) (mbar)\n\
         p_s,Standard,9.9990 bar,1.0 mbar,normal,2,0.500,-1,0.500\n\
         p_x,Resolution 5 mbar,10.0050 bar,2.5 mbar,rectangular,√3,1.443,1,1.443\n\
         p_x,Hysteresis,,1.0 mbar,rectangular,√3,0.577,1,0.577\n\
         e,,6.0 mbar,,,,,,1.633\nU (k = 2) = 3.3 mbar\n",
    );
}

/// Nobody writes the unit of a correction that is zero.
#[test]
fn a_zero_has_the_unit_of_its_uncertainty() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "# Flow meter\n\n| Quantity | Estimate | u(x) | c | u(y) L/min |\n|---|---|---|---|---|\n\
             | V volume | 50.000 L | 0.010 L | 2 1/min | 0.020 |\n\
             | t time | 30.00 s | 0.02 s | -3.3333 L/(min·s) | 0.067 |\n\
             | d_T temp | 0 | 0.05 L/min | 1 | 0.050 |\n\n\
             q = V/t + d_T\n\nu_c = {u_c} L/min\n\nU = {expanded} L/min (k = 2)\n"
        )
    };
    is_sound("sheet.md", &sheet("0.086", "0.17"));
    assert_eq!(first("sheet.md", &sheet("0.137", "0.27")), "linear-sum");
}

/// A bound of the degrees of freedom is the number to compute with, and words that are none are listed.
#[test]
fn degrees_of_freedom_have_bounds() {
    let sheet = |dof: &str| {
        format!(
            "Source,Value (g),Distribution,Divisor,u (g),Degrees of freedom\n\
             Repeatability s=0.5 g n=5,0.5,normal,√5,0.2236,4\n\
             Standard,0.2,normal,1,0.2000,{dof}\n\
             Combined standard uncertainty,,,,0.3000,\n\
             Effective degrees of freedom,,,,12,\nk (t 95 %),,,,2.18,\nU,,,,0.65,\n"
        )
    };
    for dof in ["50", "50+", ">50", "≥ 50", "~50", "ca. 50"] {
        is_sound("sheet.csv", &sheet(dof));
    }
    let said = claims("sheet.csv", sheet("plenty").as_bytes(), &Mapping::default()).unwrap();
    let mut lines = said[0].unplaced.iter();
    assert!(lines.any(|line| line.text == "plenty"));
}

/// Heads of types that say u are of standard uncertainties, in any language, and a mapping has them as they stand.
#[test]
fn types_have_standard_uncertainties() {
    for [a, b] in [
        ["Type A u (µm)", "Type B u (µm)"],
        [
            "Standard uncertainty type A (µm)",
            "Standard uncertainty type B (µm)",
        ],
        ["A类标准不确定度 (µm)", "B类标准不确定度 (µm)"],
        ["Typ A (µm)", "Typ B (µm)"],
    ] {
        let sheet = format!(
            "Component,{a},{b}\nReference,,0.30\nRepeatability,0.40,\nResolution,,0.29\nTemperature,,0.20\n\
             Combined standard uncertainty,,0.61\nExpanded uncertainty (k=2),,1.2\n"
        );
        is_sound("sheet.csv", &sheet);
        let claims = claims("sheet.csv", sheet.as_bytes(), &Mapping::default()).unwrap();
        let template = Mapping::template(&claims);
        assert!(template.contains(&format!("{a:?} = \"u\"")), "{template}");
        assert!(!template.contains("Type\""), "{template}");
    }
}

/// What is said of a column that is not there is listed with what was not used.
#[test]
fn mappings_of_nothing_are_listed() {
    let mapping = Mapping::parse("[columns]\n\"Foo\" = \"u\"\nSource = \"source\"\n").unwrap();
    let sheet = "Source,u / bar\nReference,0.007\nResolution,0.003\nu_c,0.0076\nU (k = 2),0.015\n";
    let claims = claims("sheet.csv", sheet.as_bytes(), &mapping).unwrap();
    let lines: Vec<&str> = claims[0]
        .unplaced
        .iter()
        .map(|line| line.text.as_str())
        .collect();
    assert_eq!(lines, ["[columns] \"Foo\""]);
}

/// What gives u by the divisor was divided, whether its unit stands in a column of its own or it is itself called u.
#[test]
fn divisors_tell_what_was_divided() {
    let sheet = "Source,Value,Unit,Distribution,Divisor,u (mK)\n\
        Reference U k=2,0.010,K,normal,2,5.00\nBath,0.020,K,rectangular,√3,11.55\n\
        Repeatability,3,mK,normal,1,3.00\nu_c,,,,,12.94\nU (k=2),,,,,26\n";
    is_sound("sheet.csv", sheet);
    let claims = claims("sheet.csv", sheet.as_bytes(), &Mapping::default()).unwrap();
    assert!(matches!(
        claims[0].rows[0].stated,
        Stated::Certificate { .. }
    ));
    is_sound(
        "sheet.csv",
        "Quantity,Estimate,u,Distribution,Divisor,c,Contribution\n\
         A,10,0.1,normal,1,1,0.1\nB,5,0.2,rectangular,1.732,1,0.115\nu_c,,,,,,0.153\nU,,,,2,,0.31\n",
    );
}

/// U of points below one another may stand below a head with its k.
#[test]
fn u_of_points_has_its_factor_in_the_head() {
    let sheet = "Nominal (N),uref (N),ures (N),urep (N),u_c (N),U k=2 (N)\n\
        10,0.05,0.02,0.03,0.0616,0.12\n50,0.1,0.02,0.06,0.1183,0.24\n100,0.2,0.02,0.12,0.2341,0.47\n";
    let claims = claims("sheet.csv", sheet.as_bytes(), &Mapping::default()).unwrap();
    assert_eq!(claims.len(), 3);
    for claimed in &claims {
        assert_eq!(crate::audit(claimed).verdict, Verdict::Sound);
    }
}

/// Of many rows each slip is tried alone: pairs would take minutes, and match anything.
#[test]
fn many_rows_are_searched_soon() {
    let rows: String = (0..500).map(|i| format!("A{i},10,0.1,1,0.1\n")).collect();
    let sheet =
        format!("Quantity,Estimate,u,c,Contribution\n{rows}u_c,,,,2.236\nk,2,,,\nU,,,,6.7\n");
    assert_eq!(first("sheet.csv", &sheet), "k-other");
}

/// Readings above the table, of which s is 0.001871 mm, and 0.000764 mm that of their mean: a row of as many has s and u of them.
#[test]
fn readings_are_held_against_their_row() {
    let sheet = |row: &str, u_c: &str, expanded: &str| {
        format!(
            "Calibration of a micrometer\nReadings / mm: 10.012 10.015 10.011 10.014 10.013 10.016\n\n\
             Source,Value / mm,Distribution,Divisor,u / mm\n{row}\nGauge block U (k=2),0.002,normal,2,0.00100\n\
             Resolution,0.0005,rectangular,1.732,0.000289\nu_c,,,,{u_c}\nU (k=2),,,,{expanded}\n"
        )
    };
    let words = "\"Repeatability, 6 readings, mean reported\"";
    for row in [
        &format!("{words},0.001871,normal (A),√6,0.000764"),
        "Repeatability,0.000764,normal (A),1,0.000764",
    ] {
        is_sound("sheet.csv", &sheet(row, "0.001291", "0.0026"));
    }
    let population = sheet(
        &format!("{words},0.001708,normal (A),√6,0.000697"),
        "0.001253",
        "0.0025",
    );
    assert!(first("sheet.csv", &population).starts_with("population-sd@"));
    for row in [
        &format!("{words},0.0025,normal (A),√6,0.00102"),
        "Repeatability,0.00102,normal (A),1,0.00102",
    ] {
        let (verdict, _) = answer("sheet.csv", &sheet(row, "0.001457", "0.0029"));
        assert_ne!(verdict, Verdict::Sound, "{row}");
    }
    // Readings of something else have nothing to do with the row.
    let other = "\"Repeatability, s of 6 readings, mean reported\",0.0100,normal (A),√6,0.00408";
    is_sound("sheet.csv", &sheet(other, "0.004213", "0.0084"));
}
