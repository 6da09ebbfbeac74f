//! Sheets in forms that are met in laboratories: heads merged over two lines, full-width marks, units that stand elsewhere,
//! workbooks that were not computed again.

use super::{answer, first, is_sound};
use crate::{Verdict, audit, read, rules, sheet};
use gumption_fault::language::Language;

/// The report of a verification: a head merged over distribution and factor, and U in MPa of rows in kPa.
#[test]
fn a_merged_head_stands_above_several_columns() {
    let report = |u: &str, u_c: &str, expanded: &str| {
        format!(
            "JJG 52-2013 一般压力表检定结果的测量不确定度评定,,,,,,,,\n\
             序号,不确定度来源,评定方法,分布及包含因子,,区间半宽 /kPa,标准不确定度 u(xi) /kPa,灵敏系数 ci,贡献 |ci|u(xi) /kPa\n\
             ,,,分布,包含因子 k,,,,\n\
             1,标准压力表 0.25级 MPE ±4 kPa,B,均匀,√3,4,2.3,-1,2.3\n\
             2,示值估读：分度值的1/5的一半（半宽 5 kPa）,B,均匀,√3,5,{u},1,{u}\n\
             3,测量重复性 n=10；s=2.4 kPa；单次测量,A,正态,1,2.4,2.4,1,2.4\n\
             4,两表受压点高度差,B,均匀,√3,0.5,0.29,1,0.29\n\
             合成标准不确定度 uc /kPa,,,,,,,,{u_c}\n扩展不确定度 U (k=2) /MPa,,,,,,,,{expanded}\n"
        )
    };
    is_sound("report.csv", &report("2.9", "4.4", "0.0088"));
    let slip = first("report.csv", &report("5.0", "6.0", "0.012"));
    assert_eq!(slip, "root3-missing@示值估读");
    // The report calls the figure with its unit, since that of the rows is another.
    let grids = sheet::grids("report.csv", report("2.9", "4.4", "0.0088").as_bytes()).unwrap();
    let claims = read::budgets(&grids, &read::Mapping::default());
    let expanded = claims[0].footer.expanded.as_ref().unwrap();
    assert_eq!((expanded.as_read(), expanded.value), ("0.0088 MPa", 8.8));
}

/// Fields that an input method for Chinese has parted, and sentences that it has not.
#[test]
fn full_width_marks_part_fields() {
    let sheet = |expanded: &str| {
        format!(
            "游标卡尺示值误差校准结果的不确定度评定\n\
             序号，来源，评定方法，分布，包含因子，标准不确定度（μｍ），灵敏系数，贡献（μｍ）\n\
             １，“量块：三等、Ｕ＝０．３μｍ、ｋ＝２．５８”，Ｂ，正态，２．５８，０．１２，１，０．１２\n\
             ２，“分度值 ０．０２ｍｍ、半宽 １０μｍ”，Ｂ，均匀，√３，５．８，１，５．８\n\
             ３，“重复性：ｓ＝２．５μｍ（ｎ＝１０）、单次测量”，Ａ，正态，１，２．５，１，２．５\n\
             ４，“温度差 ±１．０℃、半宽 １．７μｍ”，Ｂ，均匀，√３，０．９８，１，０．９８\n\
             合成标准不确定度　ｕｃ＝６．４ μｍ\n扩展不确定度　Ｕ＝{expanded} μｍ（ｋ＝２）\n"
        )
    };
    is_sound("sheet.txt", &sheet("１３"));
    assert_eq!(first("sheet.txt", &sheet("６．４")), "k-forgotten");
    is_sound(
        "list.txt",
        "电子天平示值误差的不确定度评定\n\
         ①标准砝码：证书给出U=0.3 mg（k=2），u1=0.15 mg\n\
         ②天平分辨力引入：分度值d=1 mg，区间半宽0.5 mg，均匀分布，u2=0.5/√3=0.29 mg\n\
         ③重复性：6次测量s=0.41 mg，单次测量，u3=0.41 mg\n\
         合成标准不确定度 uc=0.52 mg\n扩展不确定度：取k=2，U=2×0.52=1.0 mg\n",
    );
}

/// 0.02 % of 10 V is 2 mV, whatever the unit of the estimate is.
#[test]
fn a_percentage_is_in_the_unit_of_its_row() {
    let sheet = |u: &str, u_c: &str, expanded: &str| {
        format!(
            "Voltage 10.000 V\nContribution;Estimate;Value;Divisor;u_i/mV;c_i;u_i(y)/mV\n\
             Reference multimeter, certificate U = 0.8 mV (k = 2);10.000 V;0.8 mV;2;0.40;1;0.40\n\
             Stability of source, 0.02 % of reading, rectangular;10.000 V;0.02 %;√3;{u};1;{u}\n\
             Repeatability s = 0.6 mV, mean of 9;10.000 V;0.6 mV;3;0.20;1;0.20\n\
             ;;;;;u_c;{u_c}\n;;;;;U (k=2);{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("1.2", "1.2", "2.5"));
    let slip = first("sheet.csv", &sheet("0.012", "0.45", "0.89"));
    assert!(slip.starts_with("rel-abs@"), "{slip}");
}

/// `1000` is the length that the title names, and ppm of it are micrometres.
#[test]
fn a_bare_coefficient_may_be_a_length() {
    is_sound(
        "sheet.csv",
        "\"Laser interferometer, 1000 mm\"\nSource,Value,Unit,Divisor,u(xi),c_i,u_i(y) / µm\n\
         \"Laser wavelength, certificate 0.10 ppm (k=2)\",0.10,ppm,2,0.050,1000,0.050\n\
         Air refractive index ±0.20 ppm,0.20,ppm,√3,0.12,1000,0.12\n\
         Resolution 0.1 µm step,0.05,µm,√3,0.029,1,0.029\n\
         u_c,,,,,,0.13\nU (k=2),,,,,,0.26\n",
    );
}

/// A factor of a thousand between u and its contribution.
#[test]
fn a_prefix_may_be_lost_between_u_and_contribution() {
    let sheet = "Gauge\nSource;Value;Divisor;u(x_i);c_i;u_i(y) in µm\n\
        Standard, certificate U = 60 nm, k = 2;60 nm;2;30 nm;1;0.030\n\
        Thermal expansion ±0.08 µm;0.08 µm;√3;0.046 µm;1;0.046\n\
        Cosine error ±20 nm;20 nm;√3;12 nm;1;12\n\
        Combined;;;;;11.5\nExpanded, k=2;;;;;23 µm\n";
    assert_eq!(first("sheet.csv", sheet), "prefix@Cosine error ±20 nm");
}

/// Rows without units, whose words have them, are in grams also where U is printed in milligrams.
#[test]
fn the_unit_of_u_is_not_that_of_the_rows() {
    let sheet = |unit: &str| {
        format!(
            "Calibration of a weight\nm_X = m_S + dm + dB\nU = k·u_c with k = 2\n\
             Symbol,Information,Half-width,Distribution,Divisor k,c_i,u_i(y)\n\
             m_S,expanded uncertainty 0.00037 g (k = 2.13),0.00037,normal,2.13,1,0.000174\n\
             dm,s = 0.00020 g of 10 readings; a single reading is reported,0.00020,normal,1,1,0.000200\n\
             dB,resolution of the display 0.0005 g,0.00025,rectangular,√3,1,0.000144\n\
             u_c,,,,,,0.000302\nU,,,,,,0.00060 {unit}\n"
        )
    };
    is_sound("sheet.csv", &sheet("g"));
    assert_eq!(first("sheet.csv", &sheet("mg")), "U-unit");
}

/// `0.13 N(7 组,每组 4 次)`: the newton counts no readings, and `s of 10: 0.12 µm` does.
#[test]
fn newtons_count_nothing() {
    let sheet = "杠杆力矩\n测量模型：M = F * l\n取包含因子 k = 2\n\
        符号,名称,估计值,半宽 a,包含因子 k,标准不确定度,灵敏系数,分量 u_i(y),自由度,已知信息\n\
        F,力值,200.4,0.13,√3,0.0751,0.5002,0.0375,21,\"合并样本标准偏差 s_p = 0.13 N（7 组，每组 4 次），以3次平均值报告\"\n\
        l,力臂长度,0.5002,0.00041,3,0.000137,200.40,0.0274,∞,\"校准证书给出 U = 0.00041 m，k = 3\"\n\
        u_c,,,,,,,0.0465,,\nU,,,,,,,0.093,,\n";
    is_sound("sheet.csv", sheet);
    is_sound(
        "sheet.csv",
        "Ring\nInput,Half-width or U,Divisor,Std unc. µm,ci,Contribution µm\n\
         Setting ring certificate U = 0.40 µm k=2,0.40 µm,2,0.200,1,0.200\n\
         \"Repeatability, s of 10: 0.12 µm, one reading\",0.12 µm,1,0.120,1,0.120\n\
         Probe ±0.25 µm,0.25 µm,1.732,0.144,1,0.144\n\
         Combined standard uncertainty,,,,,0.274 µm\nExpanded uncertainty k=2,,,,,0.55 µm\n",
    );
}

/// Contributions of 0.0055 and 0.0065 are rounded to one digit either way.
#[test]
fn ties_are_rounded_either_way() {
    let sheet = |u_c: &str, expanded: &str| {
        format!(
            "Thermometer\nk = 2\nSymbol,Information,Half-width,Divisor k,u(x_i),c_i,u_i(y)\n\
             t_x,s = 0.017 °C of 10 readings; the mean of 5 is reported,0.017,√5,0.00760,1,0.00760\n\
             t_s,certificate U = 0.011 °C; k = 2,0.011,2,0.00550,-1,0.00550\n\
             dt_g,\"limits ±0.039 °C, triangle\",0.039,√6,0.0159,1,0.0159\n\
             dt_z,resolution of the display 0.05 °C,0.025,√3,0.0144,1,0.0144\n\
             u_c,,,,,,{u_c}\nU,,,,,,{expanded}\n"
        )
    };
    for (u_c, expanded) in [("0.0243", "0.049"), ("0.0245", "0.049")] {
        assert_eq!(
            first("sheet.csv", &sheet(u_c, expanded)),
            "intermediates-rounded"
        );
    }
}

/// A ± that is u to every digit, and of which nothing says what it is, is asked about.
#[test]
fn an_undivided_half_width_is_asked_about() {
    let sheet = "Torque wrench\nSource,±,Unit,Standard uncertainty,ci,ui(y)\n\
        \"Transducer certificate, k = 2\",0.50,N·m,0.25,1,0.25\nAlignment,0.30,N·m,0.30,1,0.30\n\
        Resolution of wrench,0.25,N·m,0.14,1,0.14\n\
        Combined,,,,,0.42\nExpanded (k = 2),,,,,0.83\n";
    let asked = |text: &str| -> Vec<String> {
        let grids = sheet::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &read::Mapping::default());
        let found = audit(&claims[0]).found;
        let all = rules::findings(&found).into_iter();
        all.filter(|one| one.rule == 4)
            .map(|one| one.numbers)
            .collect()
    };
    assert_eq!(asked(sheet), ["u = ± = 0.30"]);
    let said = sheet.replace("Alignment", "\"Alignment, standard uncertainty\"");
    assert_eq!(asked(&said), Vec::<String>::new());
}

/// The half-width of a row was changed, and the workbook keeps what its formulas gave before.
#[test]
fn a_workbook_that_was_not_computed_again() {
    let text = "Mass\nk = 2\nSymbol,± limit / U,Distribution,Divisor,u(xi),ci,ui(y)\n\
        m_S,48,normal,2,24,1,24\ndm_D,20,rectangular,1.7320508075688772,8.660254037844387,1,8.660254037844387\n\
        dm_C,10,rectangular,1.7320508075688772,5.773502691896258,1,5.773502691896258\n\
        u_c,,,,,,26.15976\nU,,,,,,52\n";
    let mut grids = sheet::grids("sheet.csv", text.as_bytes()).unwrap();
    for (row, number) in [(3, 4), (4, 5), (5, 6)] {
        grids[0].rows[row][4].formula = Some(format!("B{number}/D{number}"));
        grids[0].rows[row][6].formula = Some(format!("E{number}*F{number}"));
    }
    sheet::mark_stale(&mut grids);
    let claims = read::budgets(&grids, &read::Mapping::default());
    let audited = audit(&claims[0]);
    let best = &audited.found.explanations[0];
    let ids: Vec<String> = best
        .acts
        .iter()
        .map(|act| act.id(&audited.found.case))
        .collect();
    assert_eq!(
        (audited.verdict, ids),
        (Verdict::WithEffect, vec!["hard-coded@dm_D".to_string()])
    );
    let cells: Vec<String> = claims[0].stale.iter().map(|cell| cell.at.a1()).collect();
    assert_eq!(cells, ["E5"]);
}

/// Contributions are differences: two points of the Celsius scale have no sum.
#[test]
fn contributions_in_degrees_are_imported_as_differences() {
    let text = "Bath at 0 °C\nSource,Value,Unit,Distribution,Divisor,u(xi),ci,ui(y) / °C\n\
        Bath uniformity limits ±,0.015,°C,rectangular,1.732,0.00866,1,0.00866\n\
        Bath stability limits ±,0.012,°C,rectangular,1.732,0.00693,1,0.00693\n\
        Combined standard uncertainty,,,,,,,0.0111\nExpanded uncertainty k = 2,,,,,,,0.022\n";
    let files = crate::budget_files(
        "sheet.csv",
        text.as_bytes(),
        &read::Mapping::default(),
        Language::English,
    );
    let files = files.unwrap();
    let units: Vec<&str> = files[0]
        .lines()
        .filter(|line| line.starts_with("unit"))
        .collect();
    assert_eq!(units, ["unit = \"K\""; 3]);
}

/// That U has three digits is read off it: it makes no pair of the slip beside it, which its figures show.
#[test]
fn the_length_of_u_is_no_second_slip_to_ask_for() {
    let sheet = |expanded: &str| {
        format!(
            "Source,u / bar\nReference,0.00700\nResolution,0.00290\nRepeatability,0.00200\nHysteresis,0.00400\nTemperature,0.00250\n\
             u_c,0.00823\nU (k = 2),{expanded}\n"
        )
    };
    assert_eq!(
        first("sheet.csv", &sheet("0.016")),
        "row-dropped@Hysteresis"
    );
    let both = first("sheet.csv", &sheet("0.0165"));
    assert_eq!(both, "too-many-digits+row-dropped@Hysteresis");
}

/// A list of sources with their standard uncertainties is a table.
#[test]
fn two_columns_are_a_table() {
    for head in [
        "Source,u / bar",
        "Component,Standard uncertainty u_i (bar)",
        "来源,标准不确定度/bar",
    ] {
        let sheet = |u_c: &str, expanded: &str| {
            format!(
                "{head}\nReference,0.00700\nResolution,0.00290\nRepeatability,0.00200\nu_c,{u_c}\nU (k = 2),{expanded}\n"
            )
        };
        is_sound("sheet.csv", &sheet("0.00784", "0.016"));
        assert_eq!(first("sheet.csv", &sheet("0.0119", "0.024")), "linear-sum");
    }
}

/// `k (t, 95 %)` says how k is found, and has no unit.
#[test]
fn the_label_of_k_may_state_its_rule() {
    let sheet = |label: &str, k: &str, expanded: &str| {
        format!(
            "Source,u_i (HRC),c_i,u_i(y) (HRC),ν_i\nRepeatability,0.25,1,0.25,4\nReference block,0.15,1,0.15,∞\nResolution,0.029,1,0.029,∞\n\
             u_c,,,0.293,\nν_eff,,,7,\n\"{label}\",,,{k},\nU,,,{expanded},\n"
        )
    };
    for label in ["k (95 %, t)", "k (t)", "包含因子 k（t分布）"] {
        is_sound("sheet.csv", &sheet(label, "2.36", "0.69"));
        assert_eq!(
            first("sheet.csv", &sheet(label, "2.00", "0.59")),
            "k2-low-dof"
        );
    }
    is_sound("sheet.csv", &sheet("k", "2.00", "0.59"));
}

/// A percentage is of the amount that the sheet names, where its own figures show it; else what was used of it is all there is.
#[test]
fn a_percentage_is_of_the_named_amount() {
    let sheet = |title: &str, u: &str, u_c: &str, expanded: &str| {
        format!(
            "{title}\nContribution,Uncertainty,Divisor,Std uncertainty (mV)\n\"Standard DMM, certificate U (k=2)\",20 ppm,2,{u}\n\
             Resolution of DUT 1 mV,0.5 mV,√3,0.289\n\"Repeatability, mean\",0.12 mV,1,0.12\nTemperature effect,5 ppm,√3,0.0289\n\
             Combined u_c (mV),,,{u_c}\n\"Expanded uncertainty U, k=2 (mV)\",,,{expanded}\n"
        )
    };
    let calibrator = "Calibration of a process calibrator at 10 V DC";
    is_sound("sheet.csv", &sheet(calibrator, "0.100", "0.330", "0.66"));
    is_sound("sheet.csv", &sheet("Calibrator", "0.100", "0.330", "0.66"));
    let (verdict, _) = answer("sheet.csv", &sheet(calibrator, "0.200", "0.373", "0.75"));
    assert_eq!(verdict, Verdict::WithEffect);
}

/// A sheet from a German spreadsheet, in the code page of its system.
#[test]
fn sheets_in_the_code_page_of_western_europe_are_read() {
    let text = "Messunsicherheitsbilanz Bügelmessschraube\n\nEinflussgröße;Wert ± (mm);Verteilung;Divisor;Standardunsicherheit (mm);Sensitivitätskoeffizient;Beitrag (mm)\n\
        Referenznormal;0,010;normal;2;0,005;1;0,005\nAuflösung;0,01;Rechteck;1,732;0,00577;1;0,00577\nWiederholbarkeit;0,003;normal;1;0,003;1;0,003\n\
        Kombinierte Standardunsicherheit;;;;;;0,0082\nErweiterte Messunsicherheit (k=2);;;;;;0,016\n";
    let bytes: Vec<u8> = text
        .chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect();
    let grids = sheet::grids("sheet.csv", &bytes).unwrap();
    let claims = read::budgets(&grids, &read::Mapping::default());
    assert_eq!(audit(&claims[0]).verdict, Verdict::Sound);
    assert_eq!(claims[0].rows[1].label(), "Auflösung");
}

/// A budget in percent of a product: its coefficients are the exponents, and rows that the model does not name keep theirs.
#[test]
fn relative_budgets_have_exponents_for_coefficients() {
    let sheet = |c: &str, u_rho: &str, u_c: &str, expanded: &str| {
        format!(
            "\"Flow, gravimetric: q = m/(rho*t^2)\"\nQuantity,Estimate,Unit,Rel. expanded uncertainty (%),k,Rel. std uncertainty (%),Sens. coeff.,Contribution (%)\n\
             mass m,100.02,kg,0.02,2,0.01,1,0.01\ndensity rho,998.2,kg/m3,0.03,2,{u_rho},-1,{u_rho}\ntime t,60.0,s,0.02,2,0.01,{c},0.02\n\
             repeatability,,,,,0.015,1,0.015\nCombined standard uncertainty,,,,,,,{u_c}\n\"Expanded uncertainty, k = 2\",,,,,,,{expanded}\n"
        )
    };
    is_sound("sheet.csv", &sheet("-2", "0.015", "0.0308", "0.062"));
    let undivided = first("sheet.csv", &sheet("-2", "0.030", "0.0403", "0.081"));
    assert_eq!(undivided, "cert-undivided@rho");
}
