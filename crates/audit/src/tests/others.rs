//! Sheets of laboratories that nobody here knew: what each of them had in common with none before.

use super::{answer, first, is_sound, understood};
use crate::Verdict;
use crate::read::{self, Mapping};
use crate::{audit, sheet};

/// u_c of the first budget, as it is right.
fn u_c(name: &str, sheet: &str) -> f64 {
    let grids = sheet::grids(name, sheet.as_bytes()).unwrap();
    audit(&read::budgets(&grids, &Mapping::default())[0])
        .found
        .right
        .u_c
}

fn near(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
}

/// A sum of one row and two limits: the row is what is tested.
fn summary(row: &str, statement: &str) -> String {
    format!(
        "Input,Information,c\n{row}\nb,limits ±0.3 mm,1\nc,\"certificate B-7: U = 0.2 mm, k = 2\",1\n{statement}\n"
    )
}

fn of_row(row: &str) -> f64 {
    let all = u_c("sheet.csv", &summary(row, "u_c = 1 mm"));
    (all * all - 0.09 / 3.0 - 0.01).sqrt()
}

#[test]
fn the_mean_of_all_readings_may_be_said_in_many_words() {
    let root = 5_f64.sqrt();
    for (row, u) in [
        (
            "a,\"5 readings, range 1.2 mm, C from the range table; their mean is reported\",1",
            1.2 / 2.33 / root,
        ),
        ("a,\"极差法:R=1.2 mm,n=5,取平均值\",1", 1.2 / 2.33 / root),
        (
            "a,\"range R = 1.2 mm of 5 readings (range method), a single reading is reported\",1",
            1.2 / 2.33,
        ),
        (
            "a,\"5 次测量,单次实验标准差 s=1.2 mm;以平均值报告\",1",
            1.2 / root,
        ),
        (
            "a,\"experimental standard deviation of a single reading s = 1.2 mm (n = 5); the mean of these is the result\",1",
            1.2 / root,
        ),
        (
            "a,\"示值平均;贝塞尔公式,n = 5,单次测量标准差 s = 1.2 mm;校准时只测 1 次\",1",
            1.2,
        ),
        (
            "a,\"6 组各 5 次,s_p=1.2 mm;报告 3 次平均值\",1",
            1.2 / 3_f64.sqrt(),
        ),
    ] {
        near(of_row(row), u);
    }
}

#[test]
fn readings_that_are_equal_leave_the_step() {
    for row in [
        "a,\"all 5 readings equal, resolution 0.5 mm\",1",
        "a,\"5 次示值相同（s = 0）,数字分辨力 0.5 mm\",1",
        "a,\"3 次读数全部相同,分辨力 0.5 mm\",1",
    ] {
        near(of_row(row), 0.25 / 3_f64.sqrt());
    }
    let table = "Symbol,Source,Value ±,Distribution,Divisor,c_i,u_i / mm,ν\n\
        a,\"all 5 readings equal, resolution 0.5 mm\",0 mm,normal,1,1,0,4\n\
        b,limits ±0.3 mm,0.3 mm,rectangular,√3,1,0.173,∞\n\
        c,\"certificate B-7: U = 0.2 mm, k = 2\",0.2 mm,normal,2,1,0.100,∞\n\
        u_c,Combined standard uncertainty,,,,,0.200,\n\
        U,Expanded uncertainty,,normal (k = 2),,,0.40,\n";
    assert_eq!(first("sheet.csv", table), "zero-scatter@a");
}

#[test]
fn a_row_is_not_the_one_that_contains_it() {
    let slip = summary(
        "a,\"MPE ±0.5 mm, already contained in the certificate of c, not counted\",1",
        "u_c = 0.351 mm\n\"U = 0.70 mm, k = 2\"",
    );
    assert_eq!(first("sheet.csv", &slip), "counted-twice@a");
}

#[test]
fn the_number_of_a_certificate_is_no_coverage_factor() {
    near(
        of_row("a,\"certificate K-8497: U = 0.5 mm (coverage factor 2.28)\",1"),
        0.5 / 2.28,
    );
}

/// 0.95 %RH is no level of confidence, and %RH no percentage.
#[test]
fn units_that_look_like_percent() {
    let humidity =
        "Input,Information,c\na,bounds of ±0.95 %RH,1\nb,limits ±0.3 %RH,1\nu_c = 1 %RH\n";
    near(
        u_c("sheet.csv", humidity),
        ((0.95_f64.powi(2) + 0.09) / 3.0).sqrt(),
    );
    let percent =
        "Input,Estimate,Information,c\na,50 mm,±0.4%×读数,1\nb,0 mm,limits ±0.3 mm,1\nu_c = 1 mm\n";
    near(u_c("sheet.csv", percent), ((0.04 + 0.09) / 3.0_f64).sqrt());
}

/// A purity has no unit where a mass and a volume have theirs, and an estimate that is not stated hides no ratio.
#[test]
fn models_with_units_and_without_estimates() {
    let cadmium = |c: &str| {
        format!(
            "Model: w = m*P/V\nQuantity,Estimate,Information,c\nm,100.28 mg,limits ±0.34 mg,{c}\nP,0.9999,limits ±0.001,1002.8\n\
             V,100 mL,limits ±0.2 mL,-10.027\n\"w = 1002.7 mg/L, u_c = 2.35 mg/L, U = 4.7 mg/L, k = 2\"\n"
        )
    };
    is_sound("sheet.csv", &cadmium("9.999"));
    let piston = "Model: p = m*g/A\nSymbol,Source,Value ±,Distribution,Divisor,c_i,u_i(y) / kPa,ν\n\
        m,\"certificate 1: U = 0.00097 kg, k = 2.28\",0.00097 kg,normal,2.28,100.02,0.0426,∞\n\
        g,\"certificate 2: U = 0.0012 m/s², k = 3\",0.0012 m/s²,normal,3,50.996,0.0204,∞\n\
        A,limits ±0.0047 mm²,0.0047 mm²,rectangular,√3,-5.1005,0.0138,∞\n\
        u_c,Combined standard uncertainty,,,,,0.0492,\nU,Expanded uncertainty,,normal (k = 2),,,0.098,\n";
    is_sound("sheet.csv", piston);
}

/// Rows have units of their own and no estimates: the coefficients of the sheet convert them.
#[test]
fn units_of_rows_without_estimates() {
    let table = "Model: E = V_i - V_S + d\nSymbol,Source,Value ±,Distribution,Divisor,c_i,u_i(y) / mV,ν\n\
        V_i,limits ±0.000064 V,0.000064 V,rectangular,√3,1000,0.0370,∞\n\
        V_S,\"certificate 1: U = 0.000062 V, k = 2\",0.000062 V,normal,2,-1000,0.0310,∞\n\
        d,limits ±74 µV,74 µV,rectangular,√3,0.001,0.0427,∞\n\
        u_c,Combined standard uncertainty,,,,,0.0644,\nU,Expanded uncertainty,,normal (k = 2),,,0.13,\n";
    is_sound("sheet.csv", table);
}

#[test]
fn the_probability_may_be_an_index_of_t() {
    let sheet = |rule: &str| {
        let row = "a,\"s = 0.5 mm of 9 readings, a single reading is reported\",1";
        summary(
            row,
            &format!("{rule}\n\"u_c = 0.539 mm, ν_eff = 10, k = 2.28, U = 1.2 mm\""),
        )
    };
    is_sound("sheet.csv", &sheet("k = t_95.45(ν_eff)"));
    assert_eq!(first("sheet.csv", &sheet("k = t_95(ν_eff)")), "k-level");
}

/// That one rectangle dominates is stated as a fact, whatever it would be without a slip.
#[test]
fn a_rule_that_states_its_reason() {
    let sheet = |k: &str, u: &str| {
        format!(
            "Input,Information,c\na,limits ±3 mm,1\nb,limits ±0.3 mm,1\n一个均匀分布分量占优势，取 k = 1.65\n\"u_c = 1.74 mm, k = {k}, U = {u} mm\"\n"
        )
    };
    is_sound("sheet.csv", &sheet("1.65", "2.9"));
    assert_eq!(first("sheet.csv", &sheet("2.00", "3.5")), "k2-rect");
}

/// A list in words with its coefficients and uncertainties; the title and a note on the reference stand in front of it.
#[test]
fn lists_have_titles_notes_and_coefficients() {
    let list = "Calibration of a weight, nominal 100 g\n\nModel: m_X = m_S + d + e\n\n\
        m_S = 100000.05 mg: reference weight, certificate M-1: U = 0.13 mg, k = 2 -> u = 0.0650 mg\n\
        d = 0.12 mg: weighing difference, 10 readings, s = 0.042 mg, their mean reported -> u = 0.0133 mg\n\
        e = 0 µg: air buoyancy, limits ±60 µg; c = 0.001 -> u = 34.6 µg\n\n\
        The combined standard uncertainty is u_c = 0.0748 mg; the expanded uncertainty is U = 0.15 mg with k = 2.\n";
    is_sound("sheet.txt", list);
    let without = list.replace(
        "m_S = 100000.05 mg: reference weight, certificate M-1: U = 0.13 mg, k = 2 -> u = 0.0650 mg\n",
        "Reference used: m_S (reference weight), certificate K-8: U = 0.13 mg (k = 2)\n",
    );
    let without = without
        .replace("u_c = 0.0748 mg", "u_c = 0.0371 mg")
        .replace("U = 0.15 mg", "U = 0.074 mg");
    assert_eq!(first("sheet.txt", &without), "ref-missing@m_S");
}

/// What stands below a head keeps its column in plain text, too, where others of its line are blank.
#[test]
fn gaps_in_plain_text_keep_their_columns() {
    let text = "Quantity  Estimate  Standard uncertainty  Sensitivity coefficient  Contribution  Degrees of freedom\n\
                a         0 mm      0.300 mm              1                        0.300 mm      9\n\
                b         0 mm      0.173 mm              1                        0.173 mm      ∞\n\
                长度      0 mm                                                     0.346 mm      15\n\
                k = t_95(ν_eff)\nU = 0.74 mm (k = 2.13)\n";
    let grids = sheet::grids("sheet.txt", text.as_bytes()).unwrap();
    let row = |i: usize| {
        grids[0].rows[i]
            .iter()
            .map(|cell| cell.text.as_str())
            .collect::<Vec<_>>()
    };
    assert_eq!(row(3), ["长度", "0 mm", "", "", "0.346 mm", "15"]);
    let claims = read::budgets(&grids, &Mapping::default());
    assert_eq!(
        claims[0].footer.nu_eff.as_ref().map(|nu| nu.value),
        Some(15.0)
    );
}

/// The unit behind the comma is the whole of it, and a row of the area A is no second head.
#[test]
fn heads_and_what_looks_like_them() {
    let table = "Symbol,Source,Estimate,Value,Units,Distribution,Divisor,ci,\"ui(y), m/s²\",Remarks\n\
        g,gravity,9.8015,0.0036,m/s²,Normal,3,1,0.00120,\"certificate 1: U = 0.0036 m/s², k=3\"\n\
        A,area,0,0.05,m/s²,Rect.,1.7321,1,0.0289,within ±0.05 m/s²\n\
        u_c,Combined uncertainty,,,,,,,0.0289,\nU,Expanded uncertainty,,,,Normal k=2,,,0.058,\n";
    let claims = understood("sheet.csv", table);
    assert_eq!(
        (claims[0].rows.len(), claims[0].unit.as_str()),
        (2, "m/s^2")
    );
    is_sound("sheet.csv", table);
}

/// What belongs to a second budget stands behind the widest gap, and its CMC has a unit with a power.
#[test]
fn a_second_budget_begins_behind_the_widest_gap() {
    let budget = |cmc: &str, rounding: &str, u: &str| {
        format!(
            "Title\n\nModel: y = a + b\nThe expanded uncertainty is given with k = 2\n{rounding}\n{cmc}\n\n\
             Symbol,Source,Value ±,Distribution,Divisor,c_i,u_i / (m/s²)\na,limits ±0.3 m/s²,0.3 m/s²,rectangular,√3,1,0.173\n\
             b,limits ±0.2 m/s²,0.2 m/s²,rectangular,√3,1,0.115\nu_c,Combined,,,,,0.208\nU,Expanded uncertainty,,,,,{u}\n"
        )
    };
    let both = budget("", "U is always rounded up", "0.42")
        + "\n\n"
        + &budget("CMC of the laboratory: 0.31 m/s²", "U to nearest", "0.42");
    let claims = understood("sheet.csv", &both);
    let known: Vec<_> = claims
        .iter()
        .map(|one| (one.model.is_some(), one.cmc.as_ref().map(|cmc| cmc.value)))
        .collect();
    assert_eq!(known, [(true, None), (true, Some(0.31))]);
}

/// A standard uncertainty that was typed where the others are computed.
#[test]
fn a_factor_of_a_thousand_may_sit_in_the_coefficient() {
    let table = "Model: y = a + b\nSymbol,Source,Estimate,Value ±,Distribution,Divisor,u(x_i),c_i,u_i(y) / mm\n\
        a,limits ±30 µm,0 µm,30 µm,rectangular,√3,17.3 µm,1,17.3\n\
        b,limits ±0.2 mm,0 mm,0.2 mm,rectangular,√3,0.115 mm,1,0.115\n\
        u_c,Combined,,,,,,,17.3\nU,Expanded uncertainty (k = 2),,,,,,,35\n";
    let slip = first("sheet.csv", table);
    assert!(slip == "c-one@a" || slip == "prefix@a", "{slip}");
}

/// A recording that was taken for a budget is refused in a time that grows with its length, not with the square of it: ten times
/// the lines of which each was once held against all below it for half a minute.
#[test]
fn a_long_recording_is_refused_soon() {
    let recording = format!("a,b\n{}", "1,2\n".repeat(100_000));
    let grids = sheet::grids("recording.csv", recording.as_bytes()).unwrap();
    let start = std::time::Instant::now();
    assert!(read::budgets(&grids, &read::Mapping::default()).is_empty());
    assert!(start.elapsed().as_secs() < 300, "{:?}", start.elapsed());
}

/// Names of the quantities side by side below an empty corner, and below them what is known of each.
#[test]
fn a_turned_table_may_have_an_empty_corner() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            ",Reference,Resolution,Repeatability,u_c,U (k=2)\nLimits / Pa,0.50,0.208,0.09,,\n\
             Divisor,2,1.732,1,,\nu / Pa,0.25,0.12,0.09,{u_c},{expanded}\n"
        )
    };
    is_sound("turned.csv", &sheet("0.29", "0.58"));
    assert_eq!(
        first("turned.csv", &sheet("0.28", "0.56")),
        "row-dropped@Repeatability"
    );
}

/// `Total type A` is no source.
#[test]
fn a_total_of_a_type_is_a_subtotal() {
    let sheet = |total_a: &str, total_b: &str| {
        format!(
            "Type A evaluation,,\nSource,Details,u (mm)\nRepeatability,10 readings,0.030\n\
             Reproducibility,3 operators,0.020\n{total_a},,0.036\n\
             Type B evaluation,,\nSource,Details,u (mm)\nRing gauge,U=0.05 mm k=2,0.025\n\
             Temperature,±0.04 mm rect.,0.023\n{total_b},,0.034\n\
             Combined standard uncertainty,,0.050\nExpanded uncertainty k=2,,0.099\n"
        )
    };
    is_sound("blocks.csv", &sheet("Total type A", "Total type B"));
    is_sound("blocks.csv", &sheet("Type A total", "Type B total"));
}

/// Forms whose list of distributions has one called `Resolution` mean u = step/√12 by it.
#[test]
fn a_distribution_called_resolution_is_of_the_whole_step() {
    let sheet = |u: &str, u_c: &str, expanded: &str| {
        format!(
            "Uncertainty Contributor\tTolerance\tDistribution\tStd Unc\tUnits\n\
             Reference Standard\t0.80\tNormal, k=2\t0.400\tg\nTemperature\t0.40\tRectangular\t0.231\tg\n\
             UUT Resolution\t0.5\tResolution\t{u}\tg\n\nCombined Uncertainty\t{u_c}\tg\n\
             Coverage Factor\t2.00\nExpanded Uncertainty\t{expanded}\tg\n"
        )
    };
    is_sound("form.tsv", &sheet("0.144", "0.484", "0.97"));
    let slip = first("form.tsv", &sheet("0.289", "0.545", "1.1"));
    assert_eq!(slip, "full-width@UUT Resolution");
}

/// A line below the table that speaks of one of its rows is no further input.
#[test]
fn a_line_about_a_row_is_none_of_its_own() {
    let sheet = |expanded: &str| {
        format!(
            "Quantity;Estimate;Standard uncertainty;Distribution;Sensitivity;Contribution\n\
             t_ref;100,02 °C;0,0600 °C;normal;1;0,0600 °C\n\
             δt_drift;0 °C;0,0289 °C;rectangular;1;0,0289 °C\n\
             δt_res;0 °C;0,00577 °C;rectangular;1;0,00577 °C\n\
             t_x;100,02 °C;;;;0,067 °C\nExpanded uncertainty U (k = 2);;;;;{expanded} °C\n\n\
             Known: t_ref certificate U = 0,12 °C (k = 2); drift ±0,05 °C; resolution 0,02 °C\n"
        )
    };
    is_sound("known.csv", &sheet("0,13"));
    assert_eq!(first("known.csv", &sheet("0,067")), "k-forgotten");
}

/// `k = 2.31 (t, 95 %)`: the bracket says where k comes from, and 1.96 does not come from there.
#[test]
fn a_bracket_behind_k_is_its_rule() {
    let sheet = |k: &str, expanded: &str| {
        format!(
            "Quantity X_i | Estimate | u(x_i) | ν_i | c_i | u_i(y)\n\
             Repeatability, s = 0.054 mm, n = 5 | 12.413 mm | 0.024 mm | 4 | 1 | 0.024 mm\n\
             Standard | 0 mm | 0.015 mm | ∞ | 1 | 0.015 mm\n\
             Resolution ±0.01 mm | 0 mm | 0.0058 mm | ∞ | 1 | 0.0058 mm\n\n\
             u_c = 0.029 mm, ν_eff = 8, k = {k} (t, 95 %), U = {expanded} mm\n"
        )
    };
    is_sound("t.txt", &sheet("2.31", "0.067"));
    assert_eq!(
        answer("t.txt", &sheet("1.96", "0.057")).0,
        Verdict::Unexplained
    );
}

/// `u_c / N` in the column of sources, its figure below the limits, is the whole and no further source.
#[test]
fn a_combined_uncertainty_may_have_its_unit_behind_it() {
    let sheet = |label: &str, drift: &str| {
        format!(
            "Source,Divisor,± (N)\nReference transducer,2,0.006\nRepeatability,1,0.004\n\
             Resolution,√3,{drift}\n{label},,0.0058\nU (k = 2) / N,,0.012\n"
        )
    };
    for label in ["u_c / N", "u_c (N)", "u_c", "uc [N]"] {
        is_sound("sheet.csv", &sheet(label, "0.005"));
    }
    // A voltage U and a stiffness k are sources.
    let voltage = "Source,± (V),Divisor,u (V)\nU / V,0.2,2,0.10\nDrift,0.12,√3,0.069\nCombined,,,0.12\nExpanded (k = 2),,,0.24\n";
    is_sound("voltage.csv", voltage);
}

/// QUAM:2012, 8.2.6, without the result: u/x side by side with u of grams and millilitres, and u_c in percent of them.
#[test]
fn relative_uncertainties_are_combined_where_u_c_is_relative() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "Source,Value,u(x),Relative standard uncertainty (%)\nPurity,0.9999,0.000058,0.0058\n\
             Mass,10.028 mg,0.005 mg,0.050\nVolume,50.0 mL,0.035 mL,0.070\n\
             Combined relative standard uncertainty,,,{u_c}\n\
             Expanded relative uncertainty (k=2),,,{expanded}\n"
        )
    };
    is_sound("relative.csv", &sheet("0.086", "0.17"));
    assert_eq!(first("relative.csv", &sheet("0.12", "0.24")), "linear-sum");
    assert_eq!(
        first("relative.csv", &sheet("0.086", "0.086")),
        "k-forgotten"
    );
    let fraction = sheet("0.00086", "0.0017")
        .replace(" (%)", "")
        .replace("0.0058\n", "0.000058\n")
        .replace("0.050\n", "0.00050\n")
        .replace("0.070\n", "0.00070\n");
    is_sound("relative.csv", &fraction);
}

/// `U = 2 · u = 1.3 mg`: however the product is written, U is what it comes to.
#[test]
fn expanded_uncertainty_is_the_end_of_its_chain() {
    for chain in [
        "U = 2 · u = 1.5 mg",
        "U = 2·u_c = 1.5 mg",
        "U = 2 x u = 1.5 mg",
        "U = 2 times u_c = 1.5 mg",
        "U = 2u = 1.5 mg",
        r"$U = 2 \cdot u = 1.5$ mg",
        r"$U = 2 \times u_c = 1.5$ mg",
    ] {
        let sheet = format!(
            "| Quantity | u(x_i) | c_i | u_i(y) |\n|---|---|---|---|\n| m_s | 0.60 mg | 1 | 0.60 mg |\n\
             | Δm | 0.35 mg | 1 | 0.35 mg |\n| δm_b | 0.29 mg | -1 | -0.29 mg |\n\nu_c = 0.75 mg\n\n{chain}\n"
        );
        is_sound("chain.md", &sheet);
        assert_eq!(
            first("chain.md", &sheet.replace("1.5", "0.75")),
            "k-forgotten",
            "{chain}"
        );
    }
}

/// A row of the result whose figure is the plain sum of the contributions is that of the result, and no further source.
#[test]
fn a_result_may_be_the_sum_of_its_contributions() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "| Quantity | u(x_i) | c_i | u_i(y) |\n|---|---|---|---|\n| m_s | 0.60 mg | 1 | 0.60 mg |\n\
             | Δm | 0.35 mg | 1 | 0.35 mg |\n| δm_b | 0.29 mg | -1 | -0.29 mg |\n\
             | m | | | {u_c} mg |\n\nU = {expanded} mg (k = 2)\n"
        )
    };
    is_sound("result.md", &sheet("0.75", "1.5"));
    assert_eq!(first("result.md", &sheet("1.24", "2.5")), "linear-sum");
}
