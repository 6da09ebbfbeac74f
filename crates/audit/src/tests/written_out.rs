//! Cells that say more than one figure: coefficients as products, estimates with their ±, parts of a division, relative columns.

use super::{answer, first, is_sound, understood};
use crate::{Verdict, audit};

/// A coefficient may be a product of numbers with units, or a formula that is not understood: then the contribution shows it.
#[test]
fn coefficients_are_written_out() {
    let sheet = |c: &str, made: &str| {
        format!(
            "来源,标准不确定度,灵敏系数,不确定度分量/μm\nu(L),0.30 μm,1,0.30\nu(t),0.29 ℃,{c},{made}\n\
             uc,,,0.58\nU (k=2),,,1.2\n"
        )
    };
    for c in [
        "L·α=150 mm×11.5×10⁻⁶/℃",
        "150 mm×11.5×10⁻⁶/℃",
        "Lα=1.725 μm/℃",
        "L·α = 1.725",
        "150×11.5×10⁻³",
        "L·α",
        "-L×α",
    ] {
        is_sound("sheet.csv", &sheet(c, "0.50"));
    }
    // A product that is read has to give the contribution.
    let (verdict, _) = answer("sheet.csv", &sheet("150 mm×11.5×10⁻⁶/℃", "0.70"));
    assert_ne!(verdict, Verdict::Sound);
    // What was not understood is listed.
    let claims = understood("sheet.csv", &sheet("L·α", "0.50"));
    assert!(claims[0].unplaced.iter().any(|line| line.text == "L·α"));
}

/// Halves, with and without contributions; a formula without a contribution leaves the claim open, and is not taken for 1.
#[test]
fn halves_are_coefficients() {
    for c in ["1/2", "-1/2", "½", "0.5"] {
        is_sound(
            "sheet.csv",
            &format!(
                "Source,u (mV),Sensitivity\nReference,0.150,1\nMean of two,0.16,{c}\nuc,0.170,\nU (k=2),0.34,\n"
            ),
        );
    }
    let open = "Source,u (mV),Sensitivity\nReference,0.150,1\nMean of two,0.16,a·b\nuc,0.170,\nU (k=2),0.34,\n";
    assert_eq!(answer("sheet.csv", open).0, Verdict::NotRecomputed);
}

/// The estimate stands in front of the ± in one cell: the divisor says which kind of ± it is, as it does without the estimate.
#[test]
fn an_estimate_may_stand_in_front_of_its_limits() {
    let sheet = |distribution: &str, u: &str| {
        format!(
            "Source,Value ± a,Distribution,Divisor,u (mV)\nReference,100.00 mV ± 0.30 mV,{distribution},2,{u}\n\
             Temperature,± 0.20 mV,rectangular,√3,0.115\nRepeatability,0.08 mV,normal,1,0.080\n\
             Combined standard uncertainty,,,,0.206\nExpanded uncertainty,,,k = 2,0.41\n"
        )
    };
    is_sound("sheet.csv", &sheet("normal", "0.150"));
    is_sound("sheet.csv", &sheet("normal (k = 2)", "0.150"));
    let claims = understood("sheet.csv", &sheet("normal", "0.150"));
    assert_eq!(
        claims[0].rows[0].value.as_ref().map(|x| x.value),
        Some(100.0)
    );
    assert_ne!(
        answer("sheet.csv", &sheet("normal", "0.300")).0,
        Verdict::Sound
    );
}

/// A part of a division may be the half-width or the whole width: the ± of the row says which; so it says what a class is of.
#[test]
fn the_limits_of_the_row_say_what_words_mean() {
    let sheet = |source: &str, a: &str, u: &str, [u_c, expanded]: [&str; 2]| {
        format!(
            "Source,a (kPa),Distribution,Divisor,u (kPa)\n\"Reference, k = 2\",5.0,normal,2,2.50\n\
             {source},{a},rectangular,√3,{u}\nNoise,1.0,normal,1,1.00\nu_c,,,,{u_c}\nU (k=2),,,,{expanded}\n"
        )
    };
    for source in [
        "\"Scale interval 30 kPa, estimated to 1/5\"",
        "\"分度值30 kPa，估读1/5\"",
        "\"Accuracy class 0.5, 600 kPa\"",
        "\"最大允许误差 0.5级 600 kPa\"",
    ] {
        is_sound("sheet.csv", &sheet(source, "3.0", "1.73", ["3.20", "6.4"]));
    }
    // The part as the half-width.
    let whole = "\"Scale interval 30 kPa, estimated to 1/5\"";
    is_sound("sheet.csv", &sheet(whole, "6.0", "3.46", ["4.39", "8.8"]));
}

/// A budget of a product in percent, with the absolute figures beside it.
#[test]
fn relative_columns_are_what_contributions_are_made_of() {
    let chinese = |u_c: &str, expanded: &str| {
        format!(
            "量,数值,标准不确定度,相对标准不确定度,灵敏系数（指数）,相对分量(%)\nm,154.32 g,0.02 g,0.013%,1,0.013\n\
             d,25.02 mm,0.01 mm,0.040%,-2,0.080\nh,40.05 mm,0.02 mm,0.050%,-1,0.050\n\
             相对合成标准不确定度,,,,,{u_c}\n相对扩展不确定度(k=2),,,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &chinese("0.095", "0.19"));
    assert_eq!(first("sheet.csv", &chinese("0.143", "0.29")), "linear-sum");
    is_sound(
        "sheet.md",
        "Density of a cylinder  ρ = 4 m/(π d² h), relative budget\n\n\
         | Quantity | Value | u(x) | u_rel (%) | Exponent | Contribution (%) |\n|---|---|---|---|---|---|\n\
         | m | 154.32 g | 0.02 g | 0.013 | 1 | 0.013 |\n| d | 25.02 mm | 0.01 mm | 0.040 | -2 | 0.080 |\n\
         | h | 40.05 mm | 0.02 mm | 0.050 | -1 | 0.050 |\n\nρ = 7.837 g/cm³, U = 0.015 g/cm³ (k = 2)\n",
    );
}

/// The contributions are used, also where a row in another unit has none of its own: it is in that of another row.
#[test]
fn contributions_stand_for_what_leads_nowhere() {
    is_sound(
        "sheet.csv",
        "分量,a,k,u(x),u(y)/nm\n标准块 U=40nm k=2,40 nm,2,20 nm,20\n膨胀系数 ±1×10⁻⁶/℃,1×10⁻⁶ /℃,√3,0.58×10⁻⁶ /℃,17\n\
         温度 ±0.3℃,0.3 ℃,√3,0.17 ℃,\n测量重复性,,,12 nm,12\nuc,,,,29\nU(k=2),,,,58\n",
    );
}

/// Heads that say how a figure is known hold what was divided, too; sources may be called by any of their names.
#[test]
fn remarks_may_be_figures() {
    let sheet = |u: &str, [u_c, expanded]: [&str; 2]| {
        format!(
            "不确定度来源,半宽/信息,分布,k,标准不确定度/mV,灵敏系数,分量/mV\n标准源证书,U=0.30 mV k=2,正态,2,0.15,1,0.15\n\
             漂移,0.12 mV,均匀,√3,{u},1,{u}\n重复性,0.08 mV,正态,1,0.08,1,0.08\nuc,,,,,,{u_c}\nU,,,k=2,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.069", ["0.184", "0.37"]));
    let wrong = sheet("0.096", ["0.195", "0.39"]);
    let claims = understood("sheet.csv", &wrong);
    assert_eq!(audit(&claims[0]).verdict, Verdict::Unexplained);
    is_sound(
        "sheet.csv",
        "Contribution,How,u (°C)\nReference thermometer,\"U = 0.02 °C, k = 2\",0.0100\n\
         Resolution,\"d/(2√3), d = 0.01 °C\",0.00289\nRepeatability,\"s = 0.008 °C\",0.00800\nuc,,0.0131\nU,k = 2,0.026\n",
    );
    is_sound(
        "sheet.csv",
        "不确定度分项,标准不确定度 (mV)\n标准器,0.150\n温度,0.115\nuc,0.189\nU (k=2),0.38\n",
    );
}
