//! Forms of budgets that are no plain table: subtotals, columns for each type, sentences over several lines, and what is left
//! open.

use super::{answer, first};
use crate::read::{self, Mapping};
use crate::rules::{self, Finding};
use crate::{Verdict, audit, sheet};

fn is_sound(name: &str, sheet: &str) {
    assert_eq!(answer(name, sheet), (Verdict::Sound, Vec::new()), "{sheet}");
}

fn findings(name: &str, text: &str) -> Vec<Finding> {
    let grids = sheet::grids(name, text.as_bytes()).unwrap();
    let claims = read::budgets(&grids, &Mapping::default());
    rules::findings(&audit(&claims[0]).found)
}

/// √(0.150² + 0.0577² + 0.289² + 0.2²) = 0.386: what the blocks come to is no further source.
#[test]
fn subtotals_are_no_sources() {
    for (name, combined) in [
        ("Subtotal", "Combined standard uncertainty"),
        ("小计", "合成标准不确定度"),
    ] {
        is_sound(
            "sheet.csv",
            &format!(
                "Source of uncertainty,Value ±,Unit,Divisor,u(x) / µm\nGauge block certificate,0.30,µm,2,0.150\n\
                 Drift of gauge block,0.10,µm,1.732,0.058\n{name},,,,0.161\nResolution,0.50,µm,1.732,0.289\n\
                 Repeatability,0.20,µm,1,0.200\n{name},,,,0.351\n{combined},,,,0.386\nExpanded uncertainty k=2,,,,0.77\n"
            ),
        );
    }
    // √(0.2² + 0.1² + 0.15² + 0.289²) = 0.395
    is_sound(
        "sheet.csv",
        "Source of uncertainty,Value ±,Unit,Divisor,u(x) / µm\nRepeatability,0.20,µm,1,0.200\nReproducibility,0.10,µm,1,0.100\n\
         Total type A,,,,0.224\nGauge block certificate,0.30,µm,2,0.150\nResolution,0.50,µm,1.732,0.289\nTotal type B,,,,0.325\n\
         Combined standard uncertainty,,,,0.395\nExpanded uncertainty k=2,,,,0.79\n",
    );
}

#[test]
fn a_source_that_stands_twice_is_asked_about() {
    let sheet = |second: &str| {
        format!(
            "Source,Value ±,Unit,Divisor,u(x) / µm\nGauge block,0.30,µm,2,0.150\nTemperature,0.50,µm,1.732,0.289\n\
             Repeatability,0.20,µm,1,0.200\n{second},0.50,µm,1.732,0.289\nCombined standard uncertainty,,,,0.479\n"
        )
    };
    let again = |second: &str| {
        let found = findings("sheet.csv", &sheet(second)).into_iter();
        let again: Vec<Finding> = found.filter(|one| one.rule == 32).collect();
        again
    };
    let found = again("Temperature");
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].row, Some(3));
    // 2·√(0.15² + 0.5²/3 + 0.2²) = 0.7638
    let corrected = found[0].corrected.unwrap();
    assert!((corrected - 0.7638).abs() < 1e-4, "{corrected}");
    assert!(again("Geometry").is_empty());
}

/// Type A and type B in columns of their own: one figure in a row, or both.
#[test]
fn types_may_have_columns_of_their_own() {
    for (a, b) in [("Type A (µm)", "Type B (µm)"), ("A类 (µm)", "B类 (µm)")] {
        is_sound(
            "sheet.md",
            &format!(
                "| Source | {a} | {b} |\n|---|---|---|\n| Repeatability | 0.32 | |\n\
                 | Gauge block, certificate U = 0.30 µm, k = 2 | | 0.15 |\n| Setting | 0.10 | 0.20 |\n\
                 | Resolution 1 µm | | 0.29 |\n\nCombined standard uncertainty: 0.51 µm\nExpanded uncertainty, k = 2: 1.0 µm\n"
            ),
        );
    }
    let sheet = "Source,Type A / mV,Type B / mV,Divisor,u / mV\nReadings,0.12,,1,0.12\nCalibrator (U; k = 2),,0.50,2,0.25\n\
                 Display ±0.3 mV,,0.30,2,0.15\nCombined,,,,0.315\nExpanded (k = 2),,,,0.63\n";
    assert_eq!(first("sheet.csv", sheet), "half-width-by-2@Display ±0.3 mV");
}

#[test]
fn sentences_go_on_in_the_next_line() {
    let table = "Source              u / mm\nStandard            0.030\nReadings            0.040\nScale               0.020\n\n";
    for statement in [
        "The combined standard uncertainty is u_c =\n0.054 mm. The expanded uncertainty is U = 0.11 mm\n(k = 2).",
        "The expanded uncertainty is\nU = 0.11 mm\n(k = 2).",
    ] {
        is_sound("sheet.txt", &format!("{table}{statement}\n"));
    }
    // √(0.005² + 0.02²/12 + 0.004²) = 0.0086
    let story = "The standard has an expanded\nuncertainty of U = 0.010 kPa (k = 2). The resolution of the gauge is\n\
                 0.02 kPa. The standard deviation of the mean of ten readings is\n0.004 kPa. The combined standard uncertainty is therefore\n\
                 u_c = 0.0086 kPa, and the expanded\nuncertainty is U = 0.017 kPa\n(k = 2).\n";
    is_sound("sheet.txt", story);
}

#[test]
fn a_multiple_of_u_is_no_mass() {
    let rows = "| Quantity | u / mg | c | u_i(y) / mg |\n|---|---|---|---|\n| m_S | 0.05 | 1 | 0.05 |\n| dm | 0.40 | 1 | 0.40 |\n\
                | buoyancy | 0.50 | 1 | 0.50 |\n\nm = 100.0017 g, ";
    is_sound("sheet.md", &format!("{rows}U = 2 u = 1.3 mg\n"));
    is_sound("sheet.md", &format!("{rows}U = 3 u = 1.9 mg\n"));
}

/// U in µV below rows in ppm is a part of the 10 V that are measured; in percent above rows in mV the other way round.
#[test]
fn relative_rows_may_have_an_absolute_result() {
    let sheet = |expanded: &str| {
        format!(
            "Calibration of a 10 V source\nSource,Value ±,Unit,Divisor,u(x) / ppm\nReference,5,ppm,2,2.5\nTransfer,4,ppm,1.732,2.31\n\
             Readings,1.2,ppm,1,1.2\nCombined standard uncertainty,,,,3.61\nExpanded uncertainty U (k = 2),{expanded},,,\n"
        )
    };
    is_sound("sheet.csv", &sheet("72 µV"));
    assert_eq!(first("sheet.csv", &sheet("36 µV")), "k-forgotten");
    let absolute = |expanded: &str| {
        format!(
            "Calibration at 50 mV\nSource,Value ±,Unit,Divisor,u(x) / mV\nReference,0.05,mV,2,0.025\nTransfer,0.04,mV,1.732,0.0231\n\
             Combined standard uncertainty,,,,0.0340\nExpanded uncertainty U (k = 2),{expanded},,,\n"
        )
    };
    is_sound("sheet.csv", &absolute("0.14 %"));
    assert_eq!(first("sheet.csv", &absolute("0.068 %")), "k-forgotten");
}

/// Grams and millilitres come to no density without the coefficients of both.
#[test]
fn rows_of_several_quantities_need_coefficients() {
    let table = |heads: &str, cells: [&str; 3], u_c: &str| {
        format!(
            "Source,± a,Unit,Divisor,u{heads}\nMass,0.02,g,2,0.01{}\nVolume,0.05,mL,1.732,0.0289{}\nTemperature,0.5,°C,1.732,0.289{}\n\n\
             u_c = {u_c} g/mL\nU = 0.0042 g/mL (k = 2)\n",
            cells[0], cells[1], cells[2]
        )
    };
    let bare = table("", [""; 3], "0.0021");
    assert_eq!(
        answer("sheet.csv", &bare),
        (Verdict::NotRecomputed, Vec::new())
    );
    let grids = sheet::grids("sheet.csv", bare.as_bytes()).unwrap();
    let claims = read::budgets(&grids, &Mapping::default());
    let audited = audit(&claims[0]);
    assert_eq!(audited.missing, [0, 1, 2]);
    assert!(audited.recomputed().is_none());
    // 0.1·0.01, 0.06·0.0289, 0.002·0.289: √(1² + 1.73² + 0.58²)·10⁻³ = 0.00208
    is_sound(
        "sheet.csv",
        &table(",c", [",0.1", ",0.06", ",0.002"], "0.0021"),
    );
    // √(0.01² + 0.0289² + 0.289²) = 0.290: summed as they stand.
    let summed = table("", [""; 3], "0.290").replace("0.0042", "0.58");
    let rows = findings("sheet.csv", &summed)
        .into_iter()
        .filter(|one| one.rule == 86);
    assert_eq!(
        rows.map(|one| one.row).collect::<Vec<_>>(),
        [Some(0), Some(1), Some(2)]
    );
}
