//! Sheets as laboratories of several countries lay them out, right and with one slip.

use super::{answer, first, is_sound, understood};
use crate::read::{self, Mapping};
use crate::sheet::Grid;
use crate::{Verdict, audit};

/// Two sources and a repeatability with ν = 4, in the form of worksheets in America.
fn worksheet(factor: &str, expanded: &str) -> String {
    format!(
        "Contributor,Type,Magnitude,Units,Distribution,Divisor,Std Uncertainty (g),Deg. of Freedom\n\
         Repeatability,A,0.00031,g,Normal,1,0.000310,4\n\
         Linearity,B,0.00030,g,Rectangular,1.732,0.000173,Infinite\n\
         Reference weight,B,0.00010,g,Normal k=2,2,0.000050,Infinite\n\
         Combined uncertainty (k=1),,,,,,0.000359,\n\
         Effective degrees of freedom,,,,,,7.2,\n\
         Coverage factor (95 %),,,,,,{factor},\n\
         Expanded uncertainty,,,,,,{expanded},\n"
    )
}

#[test]
fn the_factor_of_a_standard_uncertainty_is_no_coverage_factor() {
    is_sound("sheet.csv", &worksheet("2.36", "0.00085"));
    // Said to have 95 %, which 2 does not have at ν = 7 (91 %; JCGM 100, table G.2).
    let two = worksheet("2", "0.00072");
    assert_eq!(first("sheet.csv", &two), "k2-low-dof");
    is_sound("sheet.csv", &two.replace(" (95 %)", ""));
    let indexed = two
        .replace(" (95 %)", "")
        .replace("Expanded uncertainty", "Expanded uncertainty U95");
    assert_eq!(first("sheet.csv", &indexed), "k2-low-dof");
}

/// The label of u_c stands behind its figure, in the column of the sources.
#[test]
fn u_c_may_have_its_label_on_the_right() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "u_i(y) [g],c_i,Uncertainty contribution from,Given as,Distribution\n\
             0.25,1,Certificate,\"U = 0.50 g (k=2)\",normal\n\
             0.1155,1,Drift,±0.20 g,rectangular\n\
             0.0577,1,Resolution,±0.10 g,rectangular\n\
             {u_c},,u_c,,\n\"U = {expanded} g (k = 2)\",,,,\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.281", "0.56"));
    assert_eq!(
        answer("sheet.csv", &sheet("0.251", "0.56")).0,
        Verdict::Unexplained
    );
}

#[test]
fn figures_below_a_turned_table_are_those_of_their_labels() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "Dial gauge\n\
             Quantity,Standard,Resolution,Alignment,Repeatability,Result\n\
             Half-width or U / µm,0.04,0.05,0.03,0.012,\n\
             Distribution,normal,rectangular,rectangular,normal,\n\
             Divisor,2,√3,√3,1,\n\
             u_i / µm,0.0200,0.0289,0.0173,0.0120,{u_c}\n\
             ν_i,∞,∞,∞,9,\n\
             k,,,,,2\n\
             U / µm,,,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.0410", "0.082"));
    let dropped = first("sheet.csv", &sheet("0.0371", "0.074"));
    assert_eq!(dropped, "row-dropped@Alignment");
}

#[test]
fn numbers_of_a_model_may_have_units_that_nobody_wrote() {
    let sheet = |c: &str, part: &str, u_c: &str, expanded: &str| {
        format!(
            "p = m * g / (A * (1 + 2.2e-5 * (t - 20)))\n\
             Symbol,Quantity,Estimate,Unit,u(x_i),Unit,c_i,u_i(y) / Pa\n\
             m,Mass,10.000,kg,0.025,g,{c},{part}\n\
             A,Area,100.00,mm²,0.0020,mm²,9810 Pa/mm²,19.62\n\
             g,Gravity,9.8100,m/s²,0.0000289,m/s²,100000 Pa/(m/s²),2.89\n\
             t,Temperature,20.0,°C,0.289,°C,21.582 Pa/°C,6.24\n\
             p,Pressure,981000,Pa,,,,{u_c}\n\
             U,k = 2,,,,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("98100 Pa/kg", "2.45", "20.93", "42"));
    let wrong = first("sheet.csv", &sheet("49050 Pa/kg", "1.23", "20.83", "42"));
    assert_eq!(wrong, "c-wrong@m");
}

#[test]
fn who_says_95_45_does_not_mean_95() {
    let sheet = |level: &str, k: &str, expanded: &str| {
        format!(
            "Block calibrator\n\
             Symbol,Source,u °C,dof\n\
             Rep,Repeatability,0.4200,5\nRef,Reference,0.2500,∞\nUni,Uniformity,0.1732,∞\n\
             ,Combined standard uncertainty,0.5185,\n\
             ,Effective degrees of freedom,11,\n\
             ,Coverage factor k ({level}),{k},\n\
             ,Expanded uncertainty,{expanded},\n"
        )
    };
    is_sound("sheet.csv", &sheet("95.45 %", "2.25", "1.2"));
    is_sound("sheet.csv", &sheet("95 %", "2.20", "1.1"));
    // 95 % may be rounded.
    is_sound("sheet.csv", &sheet("95 %", "2.25", "1.2"));
    let other = first("sheet.csv", &sheet("95.45 %", "2.20", "1.1"));
    assert_eq!(other, "k-level");
}

#[test]
fn a_factor_that_was_looked_up_is_claimed() {
    let sheet = |k: &str, expanded: &str| {
        format!(
            "来源,类别,u(xi)/μm,自由度\n重复性,A,0.50,4\n标准器,B,0.20,∞\n分辨力,B,0.12,∞\n\
             uc = 0.55 μm；νeff = 5.9\n\
             p = 95 %；k = t95(νeff) = {k}\n\
             U95 = {k} × 0.55 μm = {expanded} μm\n"
        )
    };
    is_sound("sheet.csv", &sheet("2.57", "1.4"));
    let other = first("sheet.csv", &sheet("2.78", "1.5"));
    assert_eq!(other, "k-of-typeA");
}

#[test]
fn degrees_of_freedom_beside_a_bare_u_may_be_those_of_k() {
    let sheet = "Source,Type,Standard uncertainty (mΩ),Degrees of freedom\n\
         Between-day,A,0.41,7\nReference,B,0.35,inf\nLeads,B,0.20,inf\n\
         Combined standard uncertainty,,0.575,27\n\
         Coverage factor t(95 %),,2.36,\n\
         Expanded uncertainty,,1.4,\n";
    assert_eq!(first("sheet.csv", sheet), "k-of-typeA");
}

#[test]
fn the_result_may_stand_on_a_sheet_of_its_own() {
    let rows = Grid::of_rows(&[
        "Component|Limits (Pa)|Distribution|Divisor|u (Pa)",
        "Reference|0.20|normal, k=2|2|0.1000",
        "Resolution|0.05|rectangular|√3|0.0289",
        "Stability|0.15|rectangular|√3|0.0866",
    ]);
    let verdict = |u_c: &str, expanded: &str| {
        let result = Grid::of_rows(&[
            &format!("Combined standard uncertainty|{u_c}|Pa"),
            "Coverage factor|2",
            &format!("Expanded uncertainty|{expanded}|Pa"),
        ]);
        let claims = read::budgets(&[rows.clone(), result], &Mapping::default());
        assert!(claims[0].unplaced.is_empty());
        audit(&claims[0]).verdict
    };
    assert_eq!(verdict("0.135", "0.27"), Verdict::Sound);
    assert_eq!(verdict("0.215", "0.43"), Verdict::WithEffect);
}

#[test]
fn what_stands_in_front_of_u_is_no_contribution() {
    is_sound(
        "sheet.csv",
        "标准不确定度分量,评定方法,分量值,单位,分布,k,u(xi)/mg,|ci|,|ci|·u(xi)/mg\n\
         重复性,A,0.12,mg,-,1,0.120,1,0.120\n\
         标准砝码,B,0.10,mg,正态,2,0.050,1,0.050\n\
         稳定性,B,0.05,mg,均匀,√3,0.029,1,0.029\n\
         uc = 0.133 mg\nU = 2 × 0.133 = 0.27 mg；k = 2\n",
    );
}

#[test]
fn sums_and_u_have_german_names() {
    is_sound(
        "sheet.csv",
        "Einflussgröße;Unsicherheit in %;Divisor;Std.-Unsicherheit in %;u²\n\
         Referenz;0,060;2;0,0300;0,000900\nTemperatur;0,030;1,732;0,0173;0,000300\n\
         Summe;;;;0,001200\n\
         Kombinierte Standardunsicherheit;;;0,0346;\nErweiterte Unsicherheit (k=2);;;0,069;\n",
    );
}

#[test]
fn points_in_rows_have_chinese_heads() {
    let sheet = "校准点,标准器u1/℃,稳定性u2/℃,分辨力u3/℃,合成uc/℃,U(k=2)/℃\n\
         0,0.02,0.03,0.029,0.046,0.09\n50,0.02,0.04,0.029,0.053,0.11\n100,0.03,0.06,0.029,0.073,0.15\n";
    let claims = understood("sheet.csv", sheet);
    let verdicts: Vec<Verdict> = claims.iter().map(|claim| audit(claim).verdict).collect();
    assert_eq!(verdicts, [Verdict::Sound; 3]);
}

#[test]
fn percent_of_full_scale_at_the_reading_of_the_title() {
    let sheet = |u: &str, u_c: &str, expanded: &str| {
        format!(
            "Pressure gauge, range 0 to 100 bar, point 80 bar\n\
             Contribution,Specification,Distribution,Divisor,u / bar\n\
             Accuracy,±0.05 % of full scale (100 bar),rectangular,√3,{u}\n\
             Reading,±0.01 bar,rectangular,√3,0.00577\n\
             uc,,,,{u_c}\nU (k=2),,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.02887", "0.0294", "0.059"));
    let wrong = first("sheet.csv", &sheet("0.02309", "0.0238", "0.048"));
    assert_eq!(wrong, "fs-reading@Accuracy");
}

#[test]
fn a_sum_of_squares_is_open_by_its_own_digits() {
    for said in ["= 0.8", "is 0.8", "≈ 0.8"] {
        let sheet = format!(
            "E = V1 - V2 + d\nSymbol,u(xi) / mV,ci,ui(E) / mV\n\
             V1,0.3,1,0.3\nV2,0.25,-1,0.25\nd,0.1,1,0.1\nE,,,0.4031\nU,k = 2,,0.81\n\
             \"The correlation coefficient r(V1, V2) {said}.\"\n"
        );
        assert_eq!(answer("sheet.csv", &sheet).1, ["corr-ignored"], "{said}");
    }
}
