//! What is contained in what: rows in rows, amounts in units, subtotals in sums.

use super::{answer, first, is_sound, understood};
use crate::Verdict;

use crate::audit;
use crate::rules::findings;

/// The row that says that it contains another one is counted, and the other one is not missed in the sum.
#[test]
fn a_row_that_contains_something_is_counted() {
    let sheet = |name: &str| {
        format!(
            "Thermometer\nSource,Half-width,Unit,Distribution,Divisor,c,u (K)\n\
             \"Standard, certificate U = 0.02 K, k = 2\",0.02,K,normal,2,1,0.010\n{name},0.012,K,normal,1,1,0.012\n\
             Bath gradient,0.015,K,rectangular,1.732,1,0.0087\nCombined standard uncertainty,,,,,,0.0179\n\
             Expanded uncertainty (k=2),,,,,,0.036\n"
        )
    };
    for name in [
        "重复性（已包含分辨力）",
        "Repeatability (resolution already included)",
        "\"Repeatability, resolution is included in it\"",
    ] {
        is_sound("sheet.csv", &sheet(name));
    }
    for name in [
        "Resolution (already included in the repeatability)",
        "分辨力（已包含在重复性中）",
        "\"Resolution, its effect is contained in the scatter\"",
    ] {
        assert_eq!(
            answer("sheet.csv", &sheet(name)).0,
            Verdict::WithEffect,
            "{name}"
        );
    }
}

#[test]
fn what_a_row_includes_is_counted_again_beside_it() {
    let text = "Thermometer\nSource,Half-width,Unit,Distribution,Divisor,c,u (K)\n\
                \"Repeatability incl. resolution, s = 0.012 K of 10 readings, single reading\",0.012,K,normal,1,1,0.012\n\
                Resolution of the display 0.01 K,0.005,K,rectangular,1.732,1,0.0029\n\
                Bath gradient ±0.015 K,0.015,K,rectangular,1.732,1,0.0087\n\
                Combined standard uncertainty,,,,,,0.0151\nExpanded uncertainty (k=2),,,,,,0.030\n";
    let claims = understood("sheet.csv", text);
    let audited = audit(&claims[0]);
    assert_eq!(audited.verdict, Verdict::Sound);
    let found = findings(&audited.found);
    let again = found.iter().find(|one| one.rule == 32).expect("rule 32");
    assert_eq!(again.row, Some(1));
}

/// U in metres below rows and a sum in millimetres.
#[test]
fn u_may_be_in_a_multiple_of_the_unit_of_the_sum() {
    is_sound(
        "sheet.csv",
        "Length of a string; result 5.027 m\nSource,Value ±,Unit,Distribution,Divisor,Std uncertainty\n\
         Calibration of the tape (k = 2),5.0,mm,normal,2,2.5\nResolution half division,0.5,mm,rectangular,1.732,0.29\n\
         String not straight,10,mm,rectangular,1.732,5.8\nRepeatability s of mean,0.7,mm,normal,1,0.7\n\
         Combined standard uncertainty,,,,,6.4\nExpanded uncertainty (k=2),,,,,0.013 m\n",
    );
}

/// 15.3 ppm of 10 V are 0.15 mV.
#[test]
fn u_may_be_converted_with_a_wrong_power_of_ten() {
    let sheet = |expanded: &str| {
        format!(
            "Calibration of a DMM at 10 V\nSource,Value,Unit,Distribution,Divisor,c,u (ppm)\n\
             Calibrator specification,12,ppm,rectangular,1.732,1,6.93\nDrift,5,ppm,rectangular,1.732,1,2.89\n\
             Repeatability s of mean,1.5,ppm,normal,1,1,1.5\nCombined,,,,,,7.66\nExpanded U (k=2) = {expanded},,,,,,\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.15 mV"));
    assert_eq!(first("sheet.csv", &sheet("1.5 mV")), "percent-ppm");
    assert_eq!(first("sheet.csv", &sheet("0.015 mV")), "percent-ppm");
}

/// 0.500 mg of type A and 0.494 mg of type B come to 0.70 mg, and not to 0.99 mg.
#[test]
fn subtotals_are_no_terms_of_a_plain_sum() {
    let sheet = |whole: &str| {
        format!(
            "Mass of a weight\nSource,Value ±,Unit,Distribution,Divisor,u (mg)\nType A\nRepeatability s/√n,0.30,mg,normal,1,0.30\n\
             Reproducibility,0.40,mg,normal,1,0.40\nSubtotal type A,,,,,0.50\nType B\n\"Standard U = 0.8 mg, k = 2\",0.8,mg,normal,2,0.40\n\
             Balance ±0.5 mg,0.5,mg,rectangular,1.732,0.29\nSubtotal type B,,,,,0.49\n{whole}\n"
        )
    };
    is_sound("sheet.csv", &sheet("u_c,,,,,0.70\nU (k=2),,,,,1.4"));
    assert_eq!(
        first("sheet.csv", &sheet("u_c,,,,,0.99\nU (k=2),,,,,2.0")),
        "linear-sum"
    );
}
