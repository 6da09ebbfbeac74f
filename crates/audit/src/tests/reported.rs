//! Which of its figures a sheet reports, where they stand, and what its columns were made by.

use super::{answer, first, is_sound, understood};
use crate::{Verdict, audit};

fn names_no_slip(sheet: &str) {
    assert_eq!(
        answer("sheet.csv", sheet),
        (Verdict::Unexplained, Vec::new())
    );
}

/// The figures of the whole may stand in front of what they are called.
#[test]
fn labels_stand_behind_their_figures() {
    let sheet = |u: &str| {
        format!(
            "u_i(y),c,Standard uncertainty,Divisor,Distribution,Limits,Source\n15 µV,1,15 µV,2,normal,30 µV,Calibrator certificate (k=2)\n\
             28.9 µV,1,28.9 µV,1.732,rectangular,50 µV,Drift of calibrator\n2.89 µV,1,2.89 µV,1.732,rectangular,5 µV,Resolution (half digit)\n\
             32.7 µV,,,,,,Combined standard uncertainty\n{u} µV,,,,,,Expanded uncertainty (k = 2)\n"
        )
    };
    is_sound("sheet.csv", &sheet("65"));
    assert_eq!(first("sheet.csv", &sheet("33")), "k-forgotten");
    let of_few = |nu: &str, k: &str, u: &str| {
        format!(
            "Type;Half-width or U / mg;Distribution;Divisor;u / mg;ν;Source\nB;1.9;normal;2;0.950;∞;Calibration of the reference\n\
             A;1.1;normal;1;1.10;5;Repeatability (mean of 6)\nB;0.64;rectangular;√3;0.370;∞;Reference drift\n\
             ;;;;1.50;{nu};Combined standard uncertainty\n;;;;{k};;Coverage factor k (95 %)\n;;;;{u};;Expanded uncertainty U\n"
        )
    };
    is_sound("sheet.csv", &of_few("17", "2.11", "3.2"));
    assert_eq!(
        first("sheet.csv", &of_few("5", "2.57", "3.9")),
        "veff-wrong"
    );
}

/// U is what is reported, and not what the sheet computes above it.
#[test]
fn what_is_reported_is_the_claim() {
    let sheet = |label: &str, u: &str| {
        format!(
            "Source,Value,Dist,Divisor,u / bar\nDeadweight tester (k = 2),0.0020,normal,2,0.0010\nHysteresis,0.0060,rect,√3,0.0035\n\
             Repeatability,0.0020,normal,1,0.0020\nCombined,,,,0.0041\nExpanded uncertainty k=2,,,,0.00825\n{label},,,,{u}\n"
        )
    };
    for label in ["Reported U (k=2)", "Reported", "Rounded", "报告值 U"] {
        is_sound("sheet.csv", &sheet(label, "0.0083"));
        assert_eq!(
            first("sheet.csv", &sheet(label, "0.016")),
            "k-twice",
            "{label}"
        );
    }
}

/// `U = 63 %` is an uncertainty, and no probability.
#[test]
fn an_uncertainty_in_percent_is_no_probability() {
    is_sound(
        "sheet.txt",
        "Source                        Half-width or U / %   Distribution   Divisor   u / %\n\
         Calibration (k = 2)           43                    normal         2         21.5\n\
         Repeatability of the mean     23                    normal         1         23.0\n\
         Reference drift               28                    rectangular    √3        16.2\n\n\
         u_c = 35.4 %\nk = 2\nU = 71 %\n",
    );
}

/// The 9 of `U99 = 9 %` is the uncertainty, and the 99 its probability.
#[test]
fn a_level_stays_beside_an_uncertainty_in_percent() {
    is_sound(
        "sheet.txt",
        "Source                        Half-width or U / %   Distribution   Divisor   u / %\n\
         Calibration (k = 2)           4.0                   normal         2         2.0\n\
         Repeatability of the mean     2.5                   normal         1         2.5\n\
         Reference drift               2.2                   rectangular    √3        1.27\n\n\
         u_c = 3.44 %\nU99 = 9 %\n",
    );
}

/// `Uncertainty` behind a divisor is u, whatever the figures are called of which it was made, and also by multipliers.
#[test]
fn an_uncertainty_is_what_the_divisor_makes() {
    let sheet = |value: &str, [divisor, root, one]: [&str; 3], flat: &str, whole: [&str; 2]| {
        format!(
            "Component,{value},Distribution,{divisor},Uncertainty (µm)\nGauge blocks limits ±0.14 µm,0.14 µm,rectangular,{root},0.081\n\
             Play of the anvil,0.5 µm,rectangular,{root},0.289\nFlatness and parallelism,0.6 µm,rectangular,{root},{flat}\n\
             Repeatability of the mean,0.26 µm,normal,{one},0.260\nCombined,,,,{}\nU (k = 2),,,,{}\n",
            whole[0], whole[1]
        )
    };
    for (value, divisors) in [
        ("Value", ["Divisor", "√3", "1"]),
        ("Specification", ["Divisor", "√3", "1"]),
        ("Limits", ["Divisor", "1.732", "1"]),
        ("Value ±", ["Factor", "0.577", "1"]),
    ] {
        is_sound(
            "sheet.csv",
            &sheet(value, divisors, "0.346", ["0.527", "1.1"]),
        );
        let undivided = first(
            "sheet.csv",
            &sheet(value, divisors, "0.6", ["0.720", "1.4"]),
        );
        assert_eq!(
            undivided, "root3-missing@Flatness and parallelism",
            "{value}"
        );
    }
}

/// A U of one digit has a second one, which is zero: that the contributions were added is no matter of rounding.
#[test]
fn ten_has_two_digits() {
    let sheet = |u: &str| {
        format!(
            "Source,Limits (mg),Distribution,Divisor,u (mg)\nReference certificate (k = 2),8,normal,2,4\nRepeatability of the mean,5,normal,1,5\n\
             Drift,5,rectangular,√3,2.89\nCombined,,,,7.02\nU (k = 2),,,,{u}\n"
        )
    };
    is_sound("sheet.csv", &sheet("14"));
    names_no_slip(&sheet("10"));
}

/// `Prob. dist.` beside `Factor k`, and a sum that was made with the divisor as it stands.
#[test]
fn rounded_divisors_are_those_of_the_sheet() {
    let sheet = |k: &str, u: &str, whole: [&str; 2]| {
        format!(
            "Contribution,Prob. dist.,Limits (mg),Factor k,ui(y) (mg)\nReference certificate (k = 2),Normal,1.9,{k},{u}\nRepeatability of the mean,Normal,1.6,1,1.60\n\
             Linearity,Rectangular,1.4,1.73,0.809\nHysteresis,rect.,4.4,1.73,2.54\nAmbient temperature,rect.,1.2,1.73,0.694\nZero stability,rect.,3.2,1.73,1.85\n\
             Total,,,,{}\nExpanded uncertainty (k = 2),,,,{}\n",
            whole[0], whole[1]
        )
    };
    is_sound("sheet.csv", &sheet("2", "0.950", ["3.81", "7.6"]));
    let undivided = first("sheet.csv", &sheet("1", "1.90", ["4.15", "8.3"]));
    assert_eq!(undivided, "cert-undivided@Reference certificate (k = 2)");
}

/// A plain number in a relative column is a ratio, and an amount beside it a part of what the title names.
#[test]
fn amounts_beside_plain_ratios_are_parts_of_the_title() {
    let sheet = |u: &str, whole: [&str; 2]| {
        format!(
            "频率计数器校准 10 MHz\n不确定度来源,评定方法,相对标准不确定度(×10⁻⁹),分布\n铷钟频率准确度 a=5E-11,B,0.029,均匀\n晶振稳定度,A,0.120,正态\n\
             分辨力 0.1 Hz,B,{u},均匀\n合成相对标准不确定度,,{},\n扩展不确定度 k=2,,{},\n",
            whole[0], whole[1]
        )
    };
    is_sound("sheet.csv", &sheet("2.887", ["2.89", "5.8"]));
    assert_ne!(
        answer("sheet.csv", &sheet("5.77", ["5.77", "11.5"])).0,
        Verdict::Sound
    );
}

/// Points in front of what their columns hold: none is left out.
#[test]
fn points_stand_in_front_of_their_columns() {
    let sheet = |drift: &str, whole: [&str; 2]| {
        format!(
            "Source,Distribution,Divisor,1 V: ±,1 V: u,10 V: ±,10 V: u\nCalibrator (k = 2),normal,2,8 µV,4 µV,50 µV,25 µV\n\
             Drift,rectangular,√3,5 µV,2.9 µV,40 µV,{drift} µV\nRepeatability of the mean,normal,1,1.5 µV,1.5 µV,6 µV,6 µV\n\
             u_c,,,,5.2 µV,,{} µV\nU (k=2),,,,10 µV,,{} µV\n",
            whole[0], whole[1]
        )
    };
    let verdicts = |text: &str| -> Vec<Verdict> {
        let claims = understood("sheet.csv", text);
        claims.iter().map(|claim| audit(claim).verdict).collect()
    };
    assert_eq!(
        verdicts(&sheet("23.1", ["34.6", "69"])),
        [Verdict::Sound; 2]
    );
    assert_eq!(
        verdicts(&sheet("40", ["47.6", "95"])),
        [Verdict::Sound, Verdict::WithEffect]
    );
}

/// `Repeatability of 10` tells how many readings there were, and no s beside u.
#[test]
fn a_count_is_no_standard_deviation() {
    is_sound(
        "sheet.csv",
        "Source,u,unit,c,c unit,contribution / µL\nBalance,0.05,mg,1.003,µL/mg,0.050\nWater temperature,0.2,K,0.021,µL/K,0.004\n\
         Repeatability of 10,0.12,µL,1,,0.12\nu_c,,,,,0.130\nU (k=2),,,,,0.26\n",
    );
}

/// The units of the sensitivity coefficients may stand in a column of their own.
#[test]
fn coefficients_have_units_beside_them() {
    let sheet = |big_u: &str| {
        format!(
            "Density of a liquid by pycnometer\nSymbol,Quantity,Value,Unit,u,c_i,c_i unit,u_i / (kg/m3)\nm1,Mass empty,25.1034,g,0.0003,-0.020,1/cm3,-0.0060\n\
             m2,Mass filled,75.0213,g,0.0003,0.020,1/cm3,0.0060\nV,Volume,50.010,cm3,0.010,-0.01996,g/cm6,-0.20\nrho,Density,998.16,kg/m3,0.20,,,\n\
             \"U = {big_u} kg/m3 (k = 2)\",,,,,,,\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.40"));
    assert_eq!(first("sheet.csv", &sheet("0.20")), "k-forgotten");
}

/// A German form calls the arc sine by its shape.
#[test]
fn a_u_form_is_an_arc_sine() {
    let sheet = |divisor: &str, u: &str, whole: [&str; 2]| {
        format!(
            "Einflussgröße;Halbweite;Verteilung;Teiler;ui in %\nKalibrierfaktor (k = 2);1,0 %;Normal;2;0,50\nFehlanpassung;0,7 %;U-Form;{divisor};{u}\n\
             Wiederholbarkeit des Mittelwerts;0,15 %;Normal;1;0,15\nkombinierte Standardmessunsicherheit;;;;{}\nerweiterte Messunsicherheit k=2;;;;{}\n",
            whole[0], whole[1]
        )
    };
    is_sound("sheet.csv", &sheet("√2", "0,49", ["0,72", "1,4"]));
    assert_ne!(
        answer("sheet.csv", &sheet("√3", "0,40", ["0,66", "1,3"])).0,
        Verdict::Sound
    );
}

/// A result that is called a sum is one, and no u_c.
#[test]
fn a_result_may_be_called_a_sum() {
    is_sound(
        "sheet.csv",
        "Two resistors in series calibrated against one standard\nModel: R = R1 + R2\nSymbol,Quantity,Estimate,Standard uncertainty,Sensitivity,Contribution\n\
         R1,Resistor 1,100.01 ohm,0.010 ohm,1,0.010 ohm\nR2,Resistor 2,200.02 ohm,0.020 ohm,1,0.020 ohm\nR,Sum,300.03 ohm,0.022 ohm,,\n\
         \"U = 0.045 ohm, k = 2\",,,,,\n",
    );
}

/// A total below quantities is u_c, also where their column is one of symbols and it is no root of the sum of squares.
#[test]
fn a_total_is_no_source() {
    let sheet = |u_c: &str, big_u: &str| {
        format!(
            "Quantity,Value,PDF,Divisor,Uncertainty\n\"Reference standard, certificate (k = 2)\",0.24 °C,Gaussian,2,0.120 °C\n\
             Zero stability,0.13 °C,rect.,SQRT(3),0.0751 °C\nHysteresis,0.19 °C,rect.,SQRT(3),0.110 °C\nTotal,,,,{u_c} °C\nU (k=2),,,,{big_u} °C\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.179", "0.36"));
    assert_eq!(first("sheet.csv", &sheet("0.305", "0.61")), "linear-sum");
}
