//! Layouts of sheets: pages, blocks of types A and B, reports in sentences.

use super::{answer, first, is_sound};
use crate::Verdict;

/// The head stands again on every page; between the pages is their number, and the title again.
#[test]
fn tables_go_on_on_the_next_page() {
    let sheet = |number: u8, between: &str, u_c: &str| {
        let head = "序号,不确定度来源,类别,半宽/mm,分布,包含因子k,标准不确定度/mm";
        format!(
            "游标卡尺示值误差测量不确定度评定\n{head}\n1,测量重复性,A,0.005,正态,1,0.005\n2,量块,B,0.0008,均匀,√3,0.00046\n\
             3,线膨胀系数差,B,0.0006,三角,√6,0.00024\n{between}{head}\n{number},温度差,B,0.0018,均匀,√3,0.00104\n\
             5,数显分辨力 0.01,B,0.005,均匀,√3,0.00289\n合成标准不确定度 uc,,,,,,{u_c}\n扩展不确定度 U (k=2),,,,,,0.012\n第2页 共2页\n"
        )
    };
    for between in [
        "",
        "\n",
        "第1页 共2页\n\n（续表）\n",
        "第1页 共2页\n\n\n\n游标卡尺示值误差测量不确定度评定\n",
    ] {
        is_sound("sheet.csv", &sheet(4, between, "0.0059"));
    }
    let linear = first(
        "sheet.csv",
        &sheet(4, "\n", "0.0096").replace("0.012\n第", "0.019\n第"),
    );
    assert_eq!(linear, "linear-sum");
}

/// Two budgets under heads that are alike are two.
#[test]
fn rows_that_are_counted_from_one_are_another_budget() {
    let budget = |u: &str| {
        format!(
            "No.,Source,Limits / V,Distribution,Divisor,u / V\n1,standard,{u},normal,2,0.010\n2,drift,0.010,rectangular,√3,0.0058\n"
        )
    };
    let text = format!(
        "{}\n{}U (k = 2),,,,,0.023\n",
        budget("0.020"),
        budget("0.020")
    );
    let grids = crate::sheet::grids("two.csv", text.as_bytes()).unwrap();
    assert_eq!(
        crate::read::budgets(&grids, &crate::read::Mapping::default()).len(),
        2
    );
}

/// Contributions of type A with their subtotal, those of type B with theirs, and the whole.
#[test]
fn blocks_of_types_are_one_budget() {
    let sheet = |total: &str, expanded: &str| {
        format!(
            "Type A contributions\nSymbol,Description,s,n,u\nuA1,repeatability,0.042,6,0.0171\nuA2,reproducibility,0.030,4,0.0150\n\
             ,Combined Type A,,,0.0228\n\nType B contributions\nSymbol,Description,a,Divisor,u\nuB1,standard weight,0.05,2 (k),0.025\n\
             uB2,display,0.05,√3,0.0289\n,Combined Type B,,,0.0382\n\nTotal uc,,,,{total}\n\"U = k uc, k=2\",,,,{expanded}\nall in mg\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.0445", "0.089"));
    assert_eq!(first("sheet.csv", &sheet("0.0860", "0.17")), "linear-sum");
}

/// `6 次, 单次 s`: s is that of single readings, and their mean is what is reported.
#[test]
fn s_of_single_readings_is_no_single_reading() {
    let sheet = |words: &str| {
        format!(
            "符号,不确定度来源,输入值,分布,k,不确定度分量\nu1,标准流量计 U=0.2 % k=2,0.2%,正态,2,0.10%\n\
             u2,{words},0.12%,正态,√6,0.049%\n,合成相对标准不确定度,ucrel＝0.111％\n,扩展相对不确定度,\"Urel＝0.22％，k＝２\"\n"
        )
    };
    is_sound("sheet.csv", &sheet("重复性（6次，单次s＝0.12％）"));
    is_sound("sheet.csv", &sheet("重复性（6次，单次测量 s＝0.12％）"));
    let single = first("sheet.csv", &sheet("重复性（6次 s＝0.12％，单次测量）"));
    assert!(single.starts_with("s-wrong-m@"), "{single}");
}

/// 1.732 for √3 in cells that hold all digits: what nobody prints is no rounding.
#[test]
fn digits_that_are_not_printed_are_no_slip() {
    let row = |name: &str, a: f64, divisor: f64| format!("{name},{a},{divisor},{}\n", a / divisor);
    let u_c = libm::sqrt(
        [0.1 / 2.0, 0.05 / 1.732, 0.06 / 1.732]
            .map(|u| u * u)
            .iter()
            .sum(),
    );
    let sheet = format!(
        "Source,± / mg,Divisor,u / mg\n{}{}{}uc,,,{u_c}\nk,,,2\nU,,,{}\n",
        row("\"Reference weight, certificate k = 2\"", 0.1, 2.0),
        row("Readability limits", 0.05, 1.732),
        row("Eccentricity limits", 0.06, 1.732),
        2.0 * u_c
    );
    is_sound("sheet.csv", &sheet);
}

/// ν_eff that nothing is looked up with is rounded as other figures are.
#[test]
fn degrees_of_freedom_that_are_not_used_may_be_rounded() {
    let sheet = |nu: &str, rule: &str| {
        format!(
            "Source,± / mK,Distribution,Divisor,u / mK,νi\n\"s = 7.0711 of 5 readings, mean of 5\",7.0711,normal,√5,3.1623,4\n\
             \"PRT, certificate U = 10, k = 2\",10,normal,2,5,∞\nbath,12,rectangular,√3,6.9282,∞\nuc,,,,9.1104,\nν_eff,,,,,{nu}\n{rule}\n"
        )
    };
    // ν_eff = 275.6, and 2.01 is the factor for 275 as for 276.
    is_sound("sheet.csv", &sheet("276", "U (k = 2),,,,18,"));
    is_sound("sheet.csv", &sheet("276", "U (95 %, k = 1.97),,,,18,"));
}

/// A report in sentences: every contribution is one, and what is not understood is no reason to doubt the rest.
#[test]
fn reports_are_read_as_sentences() {
    let report = |scatter: &str, u_c: &str, expanded: &str| {
        format!(
            "Measurement uncertainty of the torque wrench calibration at 100 N·m\n\n\
             The expanded uncertainty of the reference transducer is 0.20 N·m (k = 2), giving a standard uncertainty of 0.10 N·m.\n\
             The resolution of the wrench is 0.5 N·m; half of it, 0.25 N·m, divided by √3 gives 0.144 N·m.\n\
             The standard deviation of five readings is 0.30 N·m; {scatter}\n\
             The reproducibility has a half-width of 0.20 N·m, u = 0.115 N·m.\n\n\
             The combined standard uncertainty is {u_c} N·m.\nThe expanded uncertainty is U = {expanded} N·m with k = 2.\n"
        )
    };
    let mean = "the standard uncertainty of the mean is 0.134 N·m.";
    is_sound("report.txt", &report(mean, "0.249", "0.50"));
    // A sentence that is not understood states an uncertainty: nothing is said of the rest.
    let unread = report(
        "about as much is the deviation of 0.20 N·m at the other end.",
        "0.249",
        "0.50",
    );
    let lost = unread.replace(
        "The standard deviation of five readings is 0.30 N·m; ",
        "Much is new: ",
    );
    let grids = crate::sheet::grids("report.txt", lost.as_bytes()).unwrap();
    assert!(crate::read::budgets(&grids, &crate::read::Mapping::default()).is_empty());
    assert_eq!(
        first("report.txt", &report(mean, "0.494", "0.99")),
        "linear-sum"
    );
}

/// Words below a merged head that name limits say more than the head, and free its role for the column that has it.
#[test]
fn limits_below_a_merged_head_are_limits() {
    let sheet = |part: &str, whole: [&str; 2]| {
        format!(
            "序号,不确定度来源,不确定度分量,,分布,包含因子,灵敏系数,标准不确定度分量\n\
             ,,半宽/值,单位,,,|ci|,ui / mm\n\
             1,量块的长度误差,1.2,µm,均匀,√3,1,0.000693\n\
             2,卡尺与量块的温度差,1.0,℃,均匀,√3,0.00575 mm/℃,{part}\n\
             3,卡尺分辨力 0.01 mm,0.005,mm,均匀,√3,1,0.00289\n\
             4,测量重复性（单次测量的标准偏差，10次）,0.004,mm,正态,1,1,0.004\n\
             合成标准不确定度 uc,,,,,,,{}\n扩展不确定度 U（k=2）,,,,,,,{}\n",
            whole[0], whole[1]
        )
    };
    let sound = sheet("0.00332", ["0.0060", "0.012"]);
    assert_eq!(answer("sheet.csv", &sound), (Verdict::Sound, Vec::new()));
    let bare = sheet("0.577", ["0.577", "1.2"]);
    assert!(first("sheet.csv", &bare).starts_with("c-one@"), "{bare}");
}

/// The table of QUAM:2012, A1 without a line that states the model: relative uncertainties say that it is a product.
#[test]
fn relative_uncertainties_show_a_product() {
    let sheet = |model: &str, own: &str, u: &str, expanded: &str| {
        format!(
            "Preparation of a calibration standard\n{model}\nSymbol,Quantity,Value,Unit,u(x),u(x)/x\nP,Purity,0.9999,,0.000058,0.000058\n\
             m,Mass,100.28,mg,0.05,0.00050\nV,Volume,100,mL,0.07,0.00070\n{own},Concentration,1002.7,mg/L,{u},0.00086\n\n\
             U (k=2),,,mg/L,{expanded}\n"
        )
    };
    for model in ["", "c_Cd = 1000*m*P/V", "Model: c_Cd = 1000·m·P/V  [mg/L]"] {
        let found = answer("sheet.csv", &sheet(model, "c_Cd", "0.864", "1.7"));
        assert_eq!(found, (Verdict::Sound, Vec::new()), "{model}");
    }
    assert_eq!(
        first("sheet.csv", &sheet("", "c_Cd", "0.864", "0.86")),
        "k-forgotten"
    );
}

/// What closes a table may be called by its words alone, and be wrong.
#[test]
fn a_standard_uncertainty_below_the_rows_is_that_of_the_whole() {
    let sheet = |label: &str, u: &str, expanded: &str| {
        format!(
            "| Quelle | Wert | Verteilung | Teiler | u in % |\n|---|---|---|---|---|\n| Bezugsnormal | 0,20 % | Normal | 2 | 0,1000 |\n\
             | Reproduzierbarkeit | 0,30 % | Rechteck | √12 | 0,0866 |\n| Wiederholbarkeit | 0,12 % | Normal | 1 | 0,1200 |\n\
             | **{label}** | | | | {u} |\n\nErweiterte Messunsicherheit W (k = 2): {expanded} %\n"
        )
    };
    for label in [
        "Standardunsicherheit w",
        "Standard uncertainty",
        "标准不确定度",
    ] {
        let sound = answer("sheet.md", &sheet(label, "0,1786", "0,36"));
        assert_eq!(sound, (Verdict::Sound, Vec::new()), "{label}");
        assert_eq!(
            first("sheet.md", &sheet(label, "0,1323", "0,26")),
            "row-dropped@Wiederholbarkeit",
            "{label}"
        );
    }
}

/// Kelvins in a sum of micrometres are seen where only the limits have a unit, too.
#[test]
fn limits_of_another_quantity_need_a_coefficient() {
    let rules = |limits: &str, c: &str, u: &str, u_c: &str| -> Vec<u8> {
        let sheet = format!(
            "Gauge block 50 mm\nSource,Limits,Divisor,c,u (µm)\n\"Reference (U, k=2)\",0.040 µm,2,1,0.0200\nTemperature,{limits},1.732,{c},{u}\n\
             Repeatability,0.030 µm,1,1,0.0300\nCombined standard uncertainty,,,,{u_c}\n"
        );
        let grids = crate::sheet::grids("sheet.csv", sheet.as_bytes()).expect("a sheet");
        let claims = crate::read::budgets(&grids, &crate::read::Mapping::default());
        let found = crate::rules::findings(&crate::audit(&claims[0]).found);
        found.into_iter().map(|one| one.rule).collect()
    };
    assert!(rules("0.5 K", "1", "0.2887", "0.291").contains(&86));
    assert!(!rules("0.5 K", "0.575 µm/K", "0.1660", "0.170").contains(&86));
    assert!(!rules("0.5 µm", "1", "0.2887", "0.291").contains(&86));
}

/// Rows of Markdown are called by their lines in the file, of which one is the rule below the head.
#[test]
fn rows_of_markdown_stand_in_lines_of_the_file() {
    let sheet =
        "# Budget\n\n| Source | u / mm |\n|---|---|\n| A | 0.03 |\n| B | 0.04 |\n\nu_c = 0.05 mm\n";
    let grids = crate::sheet::grids("sheet.md", sheet.as_bytes()).expect("a sheet");
    let claims = crate::read::budgets(&grids, &crate::read::Mapping::default());
    let lines: Vec<usize> = claims[0].rows.iter().map(|row| row.at.row + 1).collect();
    assert_eq!(lines, [5, 6]);
    let u_c = claims[0].footer.u_c.as_ref().expect("u_c");
    assert_eq!(u_c.at.row + 1, 8);
}

/// A quantity of the model that a line gives a value to is none that the table lacks.
#[test]
fn nominal_values_beside_the_table_are_no_missing_rows() {
    for nominal in ["nominal: 1 kg", "nominal = 1 kg", "nominal,1,kg"] {
        is_sound(
            "sheet.csv",
            &format!(
                "Reference weight\nm_R = nominal + c + drift\n{nominal}\nquantity,estimate,unit,u,distribution,c,c·u\n\
                 c,0.32,mg,0.200,normal,0.001,0.000200\ndrift,0,mg,0.0866,rectangular,0.001,0.0000866\n\
                 m_R,1000.00032,g,,,,0.000218\n\nU = 0.00044 g (k = 2)\n"
            ),
        );
    }
}

/// Names of functions are no inputs that the table lacks.
#[test]
fn functions_are_no_missing_rows() {
    is_sound(
        "sheet.csv",
        "Sine bar\ntheta = asin(h/L)\nquantity,estimate,unit,u,c,c·u\nh,50,mm,0.01,0.011547,0.00011547\nL,100,mm,0.01,-0.0057735,-0.000057735\n\
         u_c,0.00012910,rad\nU (k = 2),0.00026,rad\n",
    );
}

/// The calculation of a row with the k of its certificate states no rule for that of the result.
#[test]
fn a_quotient_by_k_is_no_rule() {
    is_sound(
        "sheet.csv",
        "Error of a voltmeter\nE = V_x - V_s\nquantity,estimate,unit,u,distribution,c,c·u\nV_x,1000.4,mV,0.50,normal,1,0.50\n\
         V_s,1000.0,mV,1.20,normal,-1,-1.20\nE,0.4,mV,,,,1.30\n\nV_s,B,U/k = 2.4/2\nU = 2.6 mV (k = 2)\n",
    );
}

/// u_c, k and U in two further columns beside the table, each behind its label.
#[test]
fn totals_may_stand_beside_the_table() {
    let sheet = |[combined, expanded]: [&str; 2], u_c: &str| {
        format!(
            "Source,± / µV,Divisor,u / µV,,,\nStandard U (k=2),1.0,2,0.500,,{combined},{u_c}\nDrift,0.5,1.732,0.289,,k,2\n\
             Repeatability of mean,0.2,1,0.200,,{expanded},1.2\n"
        )
    };
    for labels in [
        ["u_c", "U"],
        [
            "Combined standard uncertainty / µV",
            "Expanded uncertainty / µV",
        ],
    ] {
        is_sound("sheet.csv", &sheet(labels, "0.611"));
        let dropped = first("sheet.csv", &sheet(labels, "0.578"));
        assert_eq!(dropped, "row-dropped@Repeatability of mean");
    }
}
