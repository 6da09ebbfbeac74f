//! Sheets with a budget for each calibration point.

use super::answer;
use crate::read::{Mapping, are_several};
use crate::verdict::{Verdict, audit};
use crate::{claims, sheet};

/// Titles and verdicts.
fn verdicts(text: &str) -> Vec<(String, Verdict)> {
    let claims = claims("points.csv", text.as_bytes(), &Mapping::default()).expect("a sheet");
    let judged = claims
        .iter()
        .map(|claim| (claim.title.clone(), audit(claim).verdict));
    judged.collect()
}

fn all_sound(text: &str, titles: &[&str]) {
    let expected: Vec<_> = titles
        .iter()
        .map(|title| ((*title).to_owned(), Verdict::Sound))
        .collect();
    assert_eq!(verdicts(text), expected, "{text}");
}

#[test]
fn points_in_columns_of_standard_uncertainties() {
    all_sound(
        "Frequency counter\nContribution,Distribution,Divisor,1 MHz / Hz,10 MHz / Hz\n\
         GPSDO,normal,2,0.0005,0.005\nResolution,rectangular,1.7321,0.000289,0.00289\n\
         Trigger noise,normal,1,0.0002,0.002\nuc,,,0.000611,0.00611\nU (k = 2),,,0.0012,0.012\n",
        &["Frequency counter: 1 MHz", "Frequency counter: 10 MHz"],
    );
    all_sound(
        "压力表\n不确定度分量,分布,0.1 MPa,0.5 MPa,1.0 MPa\n标准器 / kPa,正态,0.025,0.125,0.25\n分辨力 / kPa,均匀,0.029,0.029,0.029\n\
         重复性 / kPa,正态,0.05,0.06,0.08\n合成标准不确定度 / kPa,,0.063,0.142,0.264\n扩展不确定度 U (k=2) / kPa,,0.13,0.28,0.53\n",
        &["压力表: 0.1 MPa", "压力表: 0.5 MPa", "压力表: 1.0 MPa"],
    );
}

#[test]
fn points_in_columns_of_half_widths() {
    all_sound(
        "Force\nSource,Distribution,Divisor,10 N / N,50 N / N\nReference,normal,2,0.02,0.06\nResolution,rectangular,√3,0.05,0.05\n\
         Repeatability,normal,1,0.02,0.03\nu_c,,,0.0365,0.0513\nU (k=2),,,0.073,0.10\n",
        &["Force: 10 N", "Force: 50 N"],
    );
}

#[test]
fn points_with_two_columns_each() {
    all_sound(
        "Force\nSource,Distribution,Divisor,± at 10 N / N,u at 10 N / N,± at 50 N / N,u at 50 N / N\n\
         Reference,normal,2,0.02,0.010,0.06,0.030\nReadout,rectangular,√3,0.05,0.0289,0.05,0.0289\n\
         Repeatability,normal,1,0.02,0.020,0.03,0.030\nu_c,,,,0.0365,,0.0513\nU (k=2),,,,0.073,,0.10\n",
        &["Force: 10 N", "Force: 50 N"],
    );
}

/// A point that spans its columns stands above them.
#[test]
fn points_above_two_columns_each() {
    all_sound(
        "Force\nSource,Distribution,Divisor,10 N,,50 N,\n,,,± (N),u (N),± (N),u (N)\n\
         Reference,normal,2,0.02,0.010,0.06,0.030\nReadout,rectangular,√3,0.05,0.0289,0.05,0.0289\n\
         Repeatability,normal,1,0.02,0.020,0.03,0.030\nu_c,,,,0.0365,,0.0513\nU (k=2),,,,0.073,,0.10\n",
        &["Force: 10 N", "Force: 50 N"],
    );
}

#[test]
fn points_in_blocks_of_rows() {
    let blocks = |second: &str| {
        format!(
            "数字多用表\n校准点,不确定度来源,分布,半宽/V,包含因子,标准不确定度 u_i/V\n1 V,校准器,均匀,0.000012,√3,0.0000069\n\
             ,零位,均匀,0.000005,√3,0.0000029\n,重复性,正态,,,0.0000030\n,u_c,,,,0.0000081\n,U (k=2),,,,0.000016\n\
             {second},校准器,均匀,0.00010,√3,0.000058\n,零位,均匀,0.00005,√3,0.000029\n,重复性,正态,,,0.000030\n\
             ,u_c,,,,0.000071\n,U (k=2),,,,0.00014\n"
        )
    };
    all_sound(&blocks("10 V"), &["数字多用表: 1 V", "数字多用表: 10 V"]);
    // Figures of the whole in columns, once for each point.
    all_sound(
        "Meter\nCalibration point,Source,± (V),Distribution,Divisor,u (V),uc (V),k,U (V)\n\
         1 V,Calibrator,0.000012,rectangular,1.732,0.0000069,0.0000081,2,0.000016\n1 V,Zero,0.000005,rectangular,1.732,0.0000029,,,\n\
         1 V,Repeatability,0.000003,normal,1,0.000003,,,\n10 V,Calibrator,0.00010,rectangular,1.732,0.000058,0.000071,2,0.00014\n\
         10 V,Zero,0.00005,rectangular,1.732,0.000029,,,\n10 V,Repeatability,0.00003,normal,1,0.00003,,,\n",
        &["Meter: 1 V", "Meter: 10 V"],
    );
}

/// A summary without a column of u, whose resolution is half a step by its head and its divisor.
#[test]
fn the_row_of_an_expanded_uncertainty_is_no_source() {
    all_sound(
        "Force\nSource,Distribution,Divisor,± / N\nReference,normal,2,0.02\nResolution,rectangular,√3,0.05\n\
         Repeatability,normal,1,0.02\nu_c,,,0.0365\nU (k=2),,,0.073\n",
        &["Force"],
    );
}

/// A blank line parts the sources from their totals; the row of a resolution has its ± itself; `Expanded U` is no source.
#[test]
fn totals_of_points_behind_a_blank_line() {
    all_sound(
        "Clamp meter\nContributor,Distribution,Divisor,50 A (mA),500 A (mA)\nCalibrator,rectangular,1.732,60,550\n\
         Coil uncertainty (k=2),normal,2,100,1000\nResolution ±,rectangular,1.732,50,50\nRepeatability,normal,1,20,110\n\n\
         Combined u,,,70.2,603\nExpanded U (k=2),,,140,1200\n",
        &["Clamp meter: 50 A", "Clamp meter: 500 A"],
    );
}

/// A wrong point among right ones is found, and it alone.
#[test]
fn one_point_is_wrong() {
    let found = verdicts(
        "Force\nSource,Distribution,Divisor,10 N / N,50 N / N,100 N / N\nReference,normal,2,0.02,0.06,0.10\n\
         Readout,rectangular,√3,0.05,0.05,0.05\nRepeatability,normal,1,0.02,0.03,0.04\nu_c,,,0.0365,0.0513,0.1141\nU (k=2),,,0.073,0.10,0.23\n",
    );
    let verdicts: Vec<Verdict> = found.into_iter().map(|(_, verdict)| verdict).collect();
    assert_eq!(verdicts[..2], [Verdict::Sound; 2]);
    assert_ne!(verdicts[2], Verdict::Sound);
}

/// Components of two inputs have the same names, and one u_c.
#[test]
fn inputs_with_the_same_components_are_one_budget() {
    let (verdict, _) = answer(
        "ohm.csv",
        "Quantity,Source,± (V),Distribution,Divisor,u (V)\nV1,calibration,0.02,normal,2,0.010\n,resolution,0.005,rectangular,1.732,0.0029\n\
         V2,calibration,0.03,normal,2,0.015\n,resolution,0.005,rectangular,1.732,0.0029\nu_c,,,,,0.0185\nU (k=2),,,,,0.037\n",
    );
    assert_eq!(verdict, Verdict::Sound);
}

/// A row for each point: each is a budget, whose cells are those of the file.
#[test]
fn a_row_for_each_point() {
    let table = |u_c: &str| {
        format!(
            "Thermometer\nNominal / °C,u_ref / °C,u_res / °C,u_c / °C,k,U / °C\n0,0.010,0.003,0.0104,2,0.021\n50,0.015,0.003,{u_c},2,0.031\n\
             100,0.020,0.003,0.0202,2,0.040\n"
        )
    };
    all_sound(
        &table("0.0153"),
        &[
            "Thermometer: 0 °C",
            "Thermometer: 50 °C",
            "Thermometer: 100 °C",
        ],
    );
    let text = table("0.0153");
    let claims = claims("points.csv", text.as_bytes(), &Mapping::default()).expect("a sheet");
    let u_c = claims[1].footer.u_c.as_ref().expect("u_c");
    assert_eq!(
        (u_c.at.a1(), claims[1].rows[1].at.a1()),
        ("D4".into(), "C2".into())
    );
}

/// The heads of such a table are called as they stand in the file, and one point is a table as well.
#[test]
fn heads_of_points_are_those_of_the_file() {
    let text =
        "Point / bar,u_ref / bar,u_res / bar,u_c / bar,U / bar\np1,0.010,0.003,0.0104,0.021\n";
    all_sound(text, &["p1 bar"]);
    let claims = claims("points.csv", text.as_bytes(), &Mapping::default()).expect("a sheet");
    let heads = claims[0]
        .understood
        .iter()
        .map(|head| (head.at.a1(), head.text.as_str(), head.role));
    let heads: Vec<_> = heads.take(2).collect();
    assert_eq!(
        heads,
        [
            ("B1".into(), "u_ref / bar", "u"),
            ("C1".into(), "u_res / bar", "u")
        ]
    );
}

/// Where neither the heads nor the sums show what the columns are, the form is told; where the heads do, wrong sums are found.
#[test]
fn a_row_for_each_point_without_sums_is_told() {
    let text = "Nominal / °C,u_ref / °C,u_res / °C,u_c / °C,k,U / °C\n0,0.010,0.003,0.0204,2,0.041\n50,0.015,0.003,0.0353,2,0.071\n";
    let found = verdicts(text).into_iter().map(|(_, verdict)| verdict);
    assert_eq!(found.collect::<Vec<_>>(), [Verdict::Unexplained; 2]);
    let text = &text
        .replace("u_ref", "Reference")
        .replace("u_res", "Display");
    assert_eq!(verdicts(text), []);
    let grids = sheet::grids("a.csv", text.as_bytes()).expect("a sheet");
    assert!(grids.iter().any(are_several));
}

/// Figures of the whole that follow a turned table without a gap are none of its heads.
#[test]
fn a_turned_table_ends_before_its_sum() {
    let text = "Budget\nSource,Reference,Readout,Repeatability\n± / N,0.02,0.05,0.02\nDivisor,2,√3,1\nu / N,0.010,0.0289,0.020\nu_c,0.0365\nU (k=2),0.073\n";
    all_sound(text, &["Budget"]);
    let claims = claims("turned.csv", text.as_bytes(), &Mapping::default()).expect("a sheet");
    let u = claims[0].rows[1].u.as_ref().expect("u");
    assert_eq!(u.at.a1(), "C5");
}

/// The names of sources alone are heads of standard uncertainties where the sums of the rows show it.
#[test]
fn points_in_rows_below_the_names_of_sources() {
    let sheet = |second: &str, third: &str| {
        format!(
            "Platinum thermometers\nTemperature,Reference,Bath,Repeatability,u_c,U (k = 2)\n\
             20 °C,0.010,0.006,0.012,0.0167,0.033\n50 °C,0.012,0.006,0.012,{second}\n100 °C,0.015,0.008,0.014,{third}\n"
        )
    };
    let titles =
        ["20 °C", "50 °C", "100 °C"].map(|point| format!("Platinum thermometers: {point}"));
    let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
    all_sound(&sheet("0.0180,0.036", "0.0220,0.044"), &titles);
    let added = verdicts(&sheet("0.0300,0.060", "0.0220,0.044"));
    assert_eq!(added[1].1, Verdict::WithEffect);
    // No row follows: nothing says that these are figures of u.
    let none = sheet("0.0300,0.060", "0.0370,0.074").replace("0.0167", "0.0280");
    assert_eq!(verdicts(&none).len(), 0);
}

/// One head, with the unit, above the names of the sources in a second line, as merged cells leave it.
#[test]
fn points_in_rows_below_a_head_of_two_lines() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "数字温度计校准不确定度一览表\n校准点 / ℃,标准不确定度分量 u_i / ℃,,,,合成标准不确定度 u_c / ℃,k,扩展不确定度 U / ℃\n\
             ,标准铂电阻,恒温槽均匀性,被检分辨力,重复性,,,\n\
             0,0.005,0.0058,0.029,0.011,0.032,2,0.06\n50,0.006,0.0087,0.029,0.012,{u_c},2,{expanded}\n\
             100,0.008,0.0115,0.029,0.014,0.035,2,0.07\n"
        )
    };
    let titles =
        ["0 °C", "50 °C", "100 °C"].map(|point| format!("数字温度计校准不确定度一览表: {point}"));
    let titles: Vec<&str> = titles.iter().map(String::as_str).collect();
    all_sound(&sheet("0.033", "0.07"), &titles);
    let added = verdicts(&sheet("0.056", "0.11"));
    assert_eq!(added[1].1, Verdict::WithEffect);
}

/// The unit behind a point may stand in brackets.
#[test]
fn points_in_columns_with_units_in_brackets() {
    let sheet = "Clamp meter\nContributor,Distribution,Divisor,50 A (mA),500 A (mA)\nCalibrator,rectangular,1.732,60,550\n\
                 \"Coil (k=2)\",normal,2,100,1000\nResolution ±,rectangular,1.732,50,50\nRepeatability,normal,1,20,110\n\
                 Combined u,,,70.2,603\n\"Expanded U (k=2)\",,,140,1206\n";
    let found = verdicts(sheet);
    let titles: Vec<&str> = found.iter().map(|(title, _)| title.as_str()).collect();
    assert_eq!(titles, ["Clamp meter: 50 A", "Clamp meter: 500 A"]);
}

/// What stands above the columns of a point may have a word beside the amount: 0.0077² = 0.0050² + 0.0035² + 0.0023² + 0.0029² +
/// 0.0030², and likewise 0.0153.
#[test]
fn titles_of_points_may_have_words() {
    let sheet = |[first, second]: [&str; 2], u_c: &str, expanded: &str| {
        format!(
            "Thermometer with two points\n,,,{first},,{second},\nSource,Distribution,Divisor,± / mV,u / mV,± / mV,u / mV\n\
             \"Reference, certificate (k=2)\",normal,2,0.010,0.0050,0.020,0.0100\nDrift of reference,rectangular,√3,0.006,0.0035,0.010,0.0058\n\
             Bath,rectangular,√3,0.004,0.0023,0.015,0.0087\nResolution,rectangular,√3,0.005,0.0029,0.005,0.0029\n\
             Repeatability,normal,1,0.003,0.0030,0.004,0.0040\nCombined,,,,0.0077,,{u_c}\nExpanded (k=2),,,,0.015,,{expanded}\n"
        )
    };
    for titles in [
        ["0 °C", "100 °C"],
        ["at 0 °C", "at 100 °C"],
        ["10 V range", "100 V range"],
    ] {
        for (u_c, expanded, verdict) in [
            ("0.0153", "0.031", Verdict::Sound),
            // The amounts added.
            ("0.0314", "0.063", Verdict::WithEffect),
        ] {
            let found = verdicts(&sheet(titles, u_c, expanded));
            let found: Vec<Verdict> = found.into_iter().map(|(_, verdict)| verdict).collect();
            assert_eq!(found, [Verdict::Sound, verdict], "{titles:?}");
        }
    }
}

/// Heads that say what the figures are need no sums: of wrong ones the slips are found.
#[test]
fn points_with_wrong_sums_are_read() {
    let beside = |[first, second]: [&str; 2]| {
        format!(
            "Source,u at 10 N (mN),u at 100 N (mN)\nReference,0.50,1.20\nRepeatability of mean,0.20,0.40\nResolution,0.29,0.29\n\
             u_c,{first}\nU (k=2),{second}\n"
        )
    };
    let below = |[first, second, third]: [&str; 3]| {
        format!(
            "Point / kPa,u_ref / kPa,u_res / kPa,u_rep / kPa,u_c / kPa,U (k=2) / kPa\n10,0.050,0.030,0.020,{first}\n\
             50,0.080,0.030,0.040,{second}\n100,0.120,0.030,0.060,{third}\n"
        )
    };
    all_sound(&beside(["0.61,1.30", "1.2,2.6"]), &["10 N", "100 N"]);
    let sums = ["0.0616,0.12", "0.0943,0.19", "0.137,0.27"];
    all_sound(&below(sums), &["10 kPa", "50 kPa", "100 kPa"]);
    // The resolution is left out; the amounts are added.
    for text in [
        beside(["0.54,1.26", "1.1,2.5"]),
        below(["0.100,0.20", "0.150,0.30", "0.210,0.42"]),
    ] {
        let found = verdicts(&text);
        let is_wrong = |(_, verdict): &(String, Verdict)| *verdict == Verdict::WithEffect;
        assert!(found.len() >= 2 && found.iter().all(is_wrong), "{found:?}");
    }
}
