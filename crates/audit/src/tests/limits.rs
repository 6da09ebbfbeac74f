//! Limits that a cell writes out, and those that are not understood.

use super::{answer, first, imported, is_sound, understood};
use crate::Verdict;

/// A drift of 0.1 V: u is 0.0577 V.
fn drift(limit: &str, [u, u_c, expanded]: [&str; 3]) -> String {
    format!(
        "Voltage at 10 V\nSource;± value;Distribution;Divisor;u / V\nStandard (k=2);0.02 V;normal;2;0.0100\n\
         Drift;{limit};rectangular;√3;{u}\nRepeatability of mean;0.02 V;normal;1;0.0200\nu_c;;;;{u_c}\nU (k=2);;;;{expanded}\n"
    )
}

const RIGHT: [&str; 3] = ["0.0577", "0.0619", "0.12"];
const HALVED: [&str; 3] = ["0.0289", "0.0365", "0.073"];

#[test]
fn limits_may_be_written_out() {
    for limit in [
        "0.1 V",
        "1 % of 10 V",
        "10000 ppm of 10 V",
        "1 % × 10 V",
        "±1 %×10 V",
        "a = 0.1 V",
        "≤ 0.1 V",
        "<0.1 V",
        "max. 0.1 V",
        "(0.1) V",
        "0.1 (a)",
        "[-0.1, 0.1] V",
        "0.2/2 V",
        "0.2 V/2",
        "2×0.05 V",
        "0.1 V, k=√3",
        "U95=0.1 V",
        "±(0.5%×10 V+0.05 V)",
    ] {
        let (verdict, _) = answer("sheet.csv", &drift(limit, RIGHT));
        assert_eq!(verdict, Verdict::Sound, "{limit}");
        let (verdict, slips) = answer("sheet.csv", &drift(limit, HALVED));
        assert_eq!(verdict, Verdict::WithEffect, "{limit}: {slips:?}");
    }
}

/// What is not understood is told, and no u is sound for that.
#[test]
fn limits_that_are_not_understood_are_told() {
    for limit in ["see sheet 4: 0.1", "class 1 of table 3"] {
        for figures in [RIGHT, HALVED] {
            let sheet = drift(limit, figures);
            assert_eq!(
                answer("sheet.csv", &sheet).0,
                Verdict::NotRecomputed,
                "{limit}"
            );
            let claimed = &understood("sheet.csv", &sheet)[0];
            assert!(claimed.unplaced.iter().any(|cell| cell.text == limit));
        }
    }
    // A row without any figure: nothing is known of it.
    let sheet = |used: &str, u: &str| {
        format!(
            "Source,Half-width / Ω,Distribution,Divisor,u / Ω\nStandard (k=2),1.2,normal,2,0.600\nDrift,{used},rectangular,1.732,{u}\n\
             Repeatability of mean,0.8,normal,1,0.800\nu_c,,,,1.000\nU (k=2),,,,2.0\n"
        )
    };
    assert_eq!(
        answer("sheet.csv", &sheet("see cert", "n/a")).0,
        Verdict::NotRecomputed
    );
    let told = "`see cert` stands in the place of its limits";
    assert!(imported(&sheet("see cert", "n/a")).contains(told));
    assert!(!imported(&sheet("0", "0")).contains("in the place of its limits"));
    is_sound("sheet.csv", &sheet("negligible", "-"));
    is_sound("sheet.csv", &sheet("0", "0"));
}

/// Shares of amounts in the words of a row are what its limits come to.
#[test]
fn shares_of_amounts_in_words_are_limits() {
    let gauge = |limit: &str, u: &str, u_c: &str, expanded: &str| {
        format!(
            "压力表 不确定度评定\n来源,标准不确定度/MPa\n标准器允许误差{limit},{u}\n测量重复性,0.00100\n估读,0.00060\nuc,{u_c}\n\
             U（k=2）,{expanded}\n"
        )
    };
    for limit in ["±0.05%×2.5 MPa，均匀分布", "2.5 MPa×0.05%，均匀分布"] {
        is_sound("sheet.csv", &gauge(limit, "0.00072", "0.00137", "0.0027"));
        let undivided = first("sheet.csv", &gauge(limit, "0.00125", "0.00171", "0.0034"));
        assert!(undivided.starts_with("root3-missing@"), "{undivided}");
    }
    let meter = |limits: &str, u: &str, u_c: &str, expanded: &str| {
        format!(
            "Measuring point 10 V\nContribution,Limits,Distribution,Divisor,u / µV\n\
             0.0035 % of reading (10 V) + 0.0006 % of range (100 V),{limits},rectangular,1.7321,{u}\n\
             Repeatability of mean,4.100 µV,normal,1,4.100\nu_c,,,,{u_c}\nU (k=2),,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &meter("950 µV", "548.5", "548.5", "1.1e+03"));
    assert_ne!(
        answer("sheet.csv", &meter("410 µV", "236.7", "236.7", "4.7e+02")).0,
        Verdict::Sound
    );
}
