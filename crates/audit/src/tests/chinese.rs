//! Sheets as laboratories in China write them.

use gumption_fault::language::Language;

use super::{answer, first, imported, is_sound, understood};
use crate::rules::findings;
use crate::{Verdict, audit};

/// A row in 千帕 and one in 帕, whose power of ten is that of the names.
#[test]
fn units_are_known_by_their_chinese_names() {
    let sheet = |unit: [&str; 2]| {
        let [large, small] = unit;
        format!(
            "模型：y = a - b\n\n符号,来源,估计值,半宽,分布,除数,标准不确定度,灵敏系数,分量\n\
             a,示值,2500 {large},5 {large},均匀,√3,2.89 {large},1,2.89 {large}\n\
             b,标准,2500 {large},1250 {small},均匀,√3,722 {small},-1,0.722 {large}\n\
             合成标准不确定度,,,,,,,,2.98 {large}\n扩展不确定度 U (k=2),,,,,,,,6.0 {large}\n"
        )
    };
    is_sound("sheet.csv", &sheet(["kPa", "Pa"]));
    is_sound("sheet.csv", &sheet(["千帕", "帕"]));
    let file = imported(&sheet(["千帕", "帕"]));
    assert!(
        file.contains("unit = \"kPa\"") && file.contains("half_width = 1.25"),
        "{file}"
    );
}

/// Also in words, and in the heads of columns.
#[test]
fn chinese_names_of_units_stand_in_words_and_heads() {
    is_sound(
        "sheet.csv",
        "不确定度来源,极限值,分布,包含因子,标准不确定度（帕）,灵敏系数,分量（千帕）\n\
         被检表,±5千帕,均匀,√3,2890,1,2.89\n标准器,\"最大允许误差 ±1.25千帕\",均匀,√3,722,-1,0.722\n\
         合成标准不确定度,,,,,,2.98\n扩展不确定度 U (k=2),,,,,,6.0\n",
    );
}

/// A unit that is not known is told, and not left out without a word.
#[test]
fn an_unknown_unit_is_told() {
    let sheet = "符号,来源,半宽,分布,除数,标准不确定度,灵敏系数,分量\n\
        a,示值,5 斛,均匀,√3,2.89 斛,1,2.89 斛\nb,标准,1.25 斛,均匀,√3,0.722 斛,-1,0.722 斛\n\
        合成标准不确定度,,,,,,,2.98 斛\n扩展不确定度 U (k=2),,,,,,,6.0 斛\n";
    let claimed = understood("sheet.csv", sheet).remove(0);
    let unread: Vec<String> = claimed
        .unplaced
        .iter()
        .map(|one| format!("{} {}", one.at.a1(), one.text))
        .collect();
    assert_eq!(unread, ["C2 斛"]);
    assert_eq!(answer("sheet.csv", sheet).0, Verdict::Sound);
    assert!(imported(sheet).contains("`斛`"));
}

/// π is no input that the table lacks.
#[test]
fn pi_is_a_number() {
    for pi in ["π", "pi"] {
        is_sound(
            "sheet.csv",
            &format!(
                "测量模型：V = {pi}*D^2*h/4\n\n输入量,估计值,半宽,分布,除数,标准不确定度,灵敏系数,分量\n\
                 D,10.08 mm,0.010 mm,均匀,√3,0.00577 mm,160.10 mm2,0.924 mm3\n\
                 h,10.11 mm,0.010 mm,均匀,√3,0.00577 mm,79.80 mm2,0.461 mm3\n\
                 合成标准不确定度 uc = 1.03 mm3,,,,,,,\n扩展不确定度 U = 2.1 mm3 (k = 2),,,,,,,\n"
            ),
        );
    }
}

/// A row that says that it is not counted, in the words that are usual.
#[test]
fn the_smaller_of_resolution_and_repeatability_is_not_counted() {
    let sheet = |resolution: &str, part: &str, whole: [&str; 2]| {
        let [u_c, expanded] = whole;
        format!(
            "输入量,标准不确定度来源,标准不确定度,灵敏系数,分量\nIx,天平重复性,0.0800 mg,1,0.0800 mg\n\
             Ix,{resolution},0.0290 mg,1,{part}\nms,标准砝码,0.0500 mg,-1,0.0500 mg\nδB,空气浮力,0.0300 mg,-1,0.0300 mg\n\
             uc,,,,{u_c} mg\nU(k=2),,,,{expanded} mg\n"
        )
    };
    let left_out = ["0.0990", "0.20"];
    for said in [
        "不计入",
        "取大者不计入",
        "取大者，舍去",
        "包含于重复性",
        "重复性已包含分辨力",
        "小于重复性，忽略不计",
        "取较大者",
        "与重复性取其大者",
        "已并入重复性",
    ] {
        is_sound(
            "sheet.csv",
            &sheet(&format!("天平分辨力（{said}）"), "", left_out),
        );
    }
    // Two of one quantity: the smaller one, though it has a contribution.
    is_sound(
        "sheet.csv",
        &sheet("天平分辨力（取较大者）", "0.0290 mg", left_out),
    );
    // What contains another one is counted, and so is the larger.
    let counted = ["0.103", "0.21"];
    for said in ["已包含零点漂移", "与读数误差取较大者"] {
        let sheet = sheet(&format!("天平分辨力（{said}）"), "0.0290 mg", counted);
        is_sound(
            "sheet.csv",
            &sheet.replace("Ix,天平重复性", "Iy,天平重复性"),
        );
    }
}

/// What the program remarks about readings that alternate states no limits of their quantity.
#[test]
fn limits_of_an_autocorrelation_are_none_of_its_quantity() {
    let sheet = |remark: &str| {
        format!(
            "输入量,估计值,标准不确定度,自由度,灵敏系数,分量\nt_d,80.0 ℃,0.0289 ℃,∞,1,0.0289 ℃\n\
             t_s,79.83 ℃,0.00435 ℃,14,-1,0.00435 ℃\nδ_s,0.03 ℃,0.0577 ℃,∞,-1,0.0577 ℃\n\
             合成标准不确定度 u_c,,,,,0.0647 ℃\n扩展不确定度 U (k=2),,,,,0.13 ℃\n\n{remark}\n"
        )
    };
    is_sound("sheet.csv", &sheet(""));
    is_sound(
        "sheet.csv",
        &sheet(
            "t_s：相邻读数相关（一阶自相关系数 -0.58，超出 ±0.52；GUM 4.2.7）。读数交替变化，请检查是否存在周期性干扰。",
        ),
    );
}

/// Of n readings the column of divisors says how many are behind the value, also where nothing was divided by it.
#[test]
fn a_stated_root_that_was_not_taken_is_missed() {
    let sheet = |name: &str, divisor: u8, u: &str, whole: [&str; 2]| {
        let ([u_c, expanded], nu) = (whole, divisor - 1);
        format!(
            "输入量,不确定度来源,类型,数值,分布,除数,标准不确定度,灵敏系数,不确定度分量,自由度\n\
             F,{name},A,0.040 kN,正态,√{divisor},{u} kN,1,{u} kN,{nu}\n\
             F_s,标准测力仪,B,0.24 kN,正态,2,0.12 kN,1,0.12 kN,∞\n合成标准不确定度 uc,,,,,,,,{u_c} kN,\n\
             包含因子 k,,,,,,,,2,\n扩展不确定度 U,,,,,,,,{expanded} kN,\n"
        )
    };
    for (divisor, u, whole) in [
        (3, "0.0231", ["0.122", "0.24"]),
        (5, "0.0179", ["0.121", "0.24"]),
    ] {
        for name in ["重复性", "测量重复性"] {
            is_sound("sheet.csv", &sheet(name, divisor, u, whole));
            let undivided = sheet(name, divisor, "0.040", ["0.126", "0.25"]);
            assert_eq!(
                first("sheet.csv", &undivided),
                "s-not-mean@F",
                "{undivided}"
            );
        }
    }
    let said = sheet("测量重复性（5次平均值）", 5, "0.040", ["0.126", "0.25"]);
    assert_eq!(first("sheet.csv", &said), "s-not-mean@F");
}

/// A certificate's U of one digit that was taken as u: the digits do not tell it from half of it, and the slip is named all the
/// same.
#[test]
fn a_certificate_of_one_digit_that_was_not_divided_is_named() {
    for certificate in ["0.10", "0.1"] {
        let sheet = format!(
            "来源,数值,单位,分布,除数,ui,ci,ci·ui\n标准器证书 U (k=2),{certificate},mV,正态,2,{certificate},1,{certificate}\n\
             重复性,0.08,mV,正态,1,0.08,1,0.08\nuc,,,,,,,0.13\nU (k=2),,,,,,,0.26\n"
        );
        assert!(
            first("sheet.csv", &sheet).starts_with("cert-undivided@"),
            "{sheet}"
        );
    }
}

/// A k of 2.02 in the place of 2.03 does not make 0.00029 of 0.00023: what the printed sum does is told, too.
#[test]
fn another_k_is_no_explanation_of_what_rounding_does() {
    let sheet = "项目,不确定度来源,数值,单位,分布,除数,ui,ci,ci·ui,νi\n1,标准砝码,0.0001,g,正态,2,0.0001,1,0.0001,∞\n\
                 2,重复性,0.00008,g,正态,1,0.00008,1,0.00008,9\n3,分辨力,0.00005,g,均匀,1.732,0.000029,1,0.000029,∞\n\
                 4,偏载,0.00010,g,均匀,1.732,0.000058,1,0.000058,∞\n合成,,,,,,,,0.000144,\nνeff,,,,,,,,38,\n\
                 k95,,,,,,,,2.02,\nU95,,,,,,,,0.00029,\n";
    let (_, sets) = answer("sheet.csv", sheet);
    assert!(
        !sets
            .iter()
            .any(|set| set == "veff-up" || set == "veff-wrong"),
        "{sets:?}"
    );
}

/// The u of a quantity and of its parts, each rounded by itself.
#[test]
fn parts_are_known_by_their_root_as_it_is_printed() {
    is_sound(
        "sheet.csv",
        "输入量,估计值,单位,u,灵敏系数 c,c·u\nV_x,10.208,mV,0.0407,1.000,0.0407\n重复性,,mV,0.0288,,0.0288\n\
         分辨力,,mV,0.0289,,0.0289\nV_s,10.000,mV,0.0100,-1.000,-0.0100\n合成标准不确定度 u_c,,mV,,,0.0420\n\
         扩展不确定度 U (k=2),,mV,,,0.084\n",
    );
}

/// Of rows of which nothing is stated nothing is recomputed, and nothing is told as 0.
#[test]
fn what_is_not_recomputed_has_no_figures() {
    let sheet = "模型：t_r = sqrt(t_m^2 - t_g^2)\n\n输入量,估计值,分布,灵敏系数,分量\nt_m,360.8 ps,正态,1.02,\n\
                 t_g,70.0 ps,均匀,-0.9,\n合成标准不确定度,,,,3.7 ps\n扩展不确定度 U (k=2),,,,7.4 ps\n";
    let claims = understood("sheet.csv", sheet);
    let audited = audit(&claims[0]);
    assert_eq!(audited.verdict, Verdict::NotRecomputed);
    assert!(audited.recomputed().is_none());
    assert!(audited.found.explanations.is_empty() && audited.found.gaps.is_empty());
}

/// A report of the program: rows of an input and of its components, with the shares of both; cells beside each other, which are no
/// interval; and a result that follows from estimates of more digits than are printed.
#[test]
fn rows_and_their_parts_are_held_against_the_rules_once() {
    let sheet = "# 示波器上升时间\n\n```text\nt_r = sqrt(t_m^2 - t_g^2)\n```\n\n\
        | 输入量 | 估计值 | 单位 | u | 概率分布 | ν | 灵敏系数 c | c·u | 占比 % |\n|---|---|---|---|---|---|---|---|---|\n\
        | t_m | 360.8 | ps | 3.61 |  | 803 | 1.019 | 3.68 | 95.6 |\n| &emsp;重复性 |  | ps | 1.01 | t (A) | 5 |  | 1.03 | 7.5 |\n\
        | &emsp;时基 |  | ps | 3.46 | 矩形 (B) | ∞ |  | 3.53 | 88.0 |\n\
        | t_g | 70.0 | ps | 4.00 | 正态 (B) | ∞ | -0.1978 | -0.791 | 4.4 |\n\
        | t_r | 354.0 | ps | 3.76 |  | 879 |  | 3.76 | 100.0 |\n\n\
        - **估计值**: t_r = 354.0 ps\n- **合成标准不确定度**: u_c = 3.76 ps\n- **有效自由度**: ν_eff = 879\n\
        - **包含因子**: k = 2（约定值，不注明包含概率）\n- **扩展不确定度**: U = 7.5 ps\n\n\
        | 不确定度分量 | n | 平均值 | s | 单位 | 最小值 | 最大值 |\n|---|---|---|---|---|---|---|\n\
        | t_m.重复性 | 6 | 360.8 | 2.48 | ps | 358 | 365 |\n\n\
        - 自由度小：蒙特卡洛法取 t 分布，其标准差大于 u：`t_m.重复性` 的自由度为 5，标准差为 u 的 1.29 倍。\n";
    is_sound("report.md", sheet);
    let claims = understood("report.md", sheet);
    let audited = audit(&claims[0]);
    let rules: Vec<u8> = findings(&audited.found)
        .iter()
        .map(|one| one.rule)
        .collect();
    for rule in [5, 7, 53] {
        assert!(!rules.contains(&rule), "rule {rule} of {rules:?}");
    }
}

/// What is computed from readings has more digits than are printed: 0.0168 K is 0.01682 K, of which 0.00434 K and 0.00435 K follow.
#[test]
fn figures_follow_from_an_s_with_more_digits_than_are_printed() {
    let sheet = |s: &str, u: &str| {
        format!(
            "输入量,不确定度来源,类型,半宽/U/s,分布,除数,标准不确定度,灵敏系数,|ci|u(xi),自由度\n\
             t_d,分辨力,B,0.05 ℃,均匀,√3,0.0289 ℃,1.000,0.0289 K,∞\nt_s,重复性,A,{s} ℃,正态,√15,{u} ℃,-1.000,0.00435 K,14\n\
             δ_s,修正值,B,0.04 K,正态,2,0.0200 K,-1.000,0.0200 K,∞\nδ_s,稳定性,B,0.1 K,均匀,√3,0.0577 K,-1.000,0.0577 K,∞\n\
             uc,,,,,,,,0.068 K,\nU (k=2),,,,,,,,0.14 K,\n"
        )
    };
    is_sound("sheet.csv", &sheet("0.0168", "0.00434"));
    is_sound("sheet.csv", &sheet("0.0168", "0.004345"));
    // A digit more is none that rounding leaves open.
    assert_ne!(
        answer("sheet.csv", &sheet("0.0168", "0.00444")).0,
        Verdict::Sound
    );
}

/// Why a model was not used is said in the language of the reader.
#[test]
fn why_a_model_is_not_used_is_said_in_chinese() {
    let sheet = "模型：y = a * b\n\n输入量,标准不确定度,灵敏系数,分量\na,0.10 g,1,0.10 g\nb,0.20 g,1,0.20 g\n\
                 合成标准不确定度,,,0.22 g\n扩展不确定度 U (k=2),,,0.45 g\n";
    let claims = understood("sheet.csv", sheet);
    let audited = audit(&claims[0]);
    let trouble = audited
        .found
        .case
        .trouble
        .clone()
        .expect("a model that is not used");
    let said = trouble.in_language(Language::Chinese);
    assert!(said.contains("估计值") && !said.contains("model"), "{said}");
}

/// A repeatability that is stated as limits is imported as such.
#[test]
fn a_repeatability_between_limits_is_imported_as_limits() {
    let file = imported(
        "模型：Δt = td - ts\n\n符号,来源,估计值,半宽,分布,除数,标准不确定度,灵敏系数,分量\n\
         td,分辨力,80.0 °C,0.05 K,均匀,√3,0.029 K,1,0.029 K\nts,重复性,79.83 °C,0.01 K,均匀,√3,0.0058 K,-1,0.0058 K\n\
         合成标准不确定度,,,,,,,,0.030 K\n扩展不确定度 U (k=2),,,,,,,,0.059 K\n",
    );
    let (_, row) = file.split_once("[input.ts]").expect("a row");
    assert!(
        row.contains("half_width = 0.01") && !row.contains("type = \"A\""),
        "{file}"
    );
    assert!(!file.contains("of 3 readings"), "{file}");
}

/// Several rows of one symbol are components of one input, and the model stays.
#[test]
fn rows_of_one_symbol_are_imported_as_components() {
    let sheet = "模型：Δt = td - ts\n\n符号,来源,估计值,半宽,分布,除数,标准不确定度,灵敏系数,分量\n\
        td,分辨力,80.0 °C,0.05 K,均匀,√3,0.029 K,1,0.029 K\nts,重复性,79.83 °C,0.01 K,均匀,√3,0.0058 K,-1,0.0058 K\n\
        ts,\"证书 U=0.04 K, k=2\",,0.04 K,正态,2,0.020 K,-1,0.020 K\n合成标准不确定度,,,,,,,,0.036 K\n\
        扩展不确定度 U (k=2),,,,,,,,0.071 K\n";
    is_sound("sheet.csv", sheet);
    let file = imported(sheet);
    assert!(
        file.contains("model = \"td - ts\"") && file.contains("value = 79.83"),
        "{file}"
    );
    assert_eq!(file.matches("[input.ts]").count(), 1, "{file}");
    assert!(
        file.contains("{ name = \"重复性\", half_width = 0.01 }"),
        "{file}"
    );
    assert!(
        file.contains("certificate = { U = 0.04, k = 2.0 }"),
        "{file}"
    );
}

/// `uc = 0.0033`, `U = 2×0.0033 = 0.0066`: u_c was rounded before it was multiplied, and no rule of rounding is stated.
#[test]
fn a_rounded_u_c_is_named_before_a_rule_that_nobody_states() {
    let text = "压力表示值误差的不确定度评定\n\n1 测量模型\nδ = p − ps\n\n2 标准不确定度分量\n\
        2.1 测量重复性引入的标准不确定度 u1\n对 10 次测量，s = 0.0048 MPa，取 10 次平均值，u1 = 0.0048/√10 = 0.0015 MPa\n\
        2.2 估读引入的标准不确定度 u2\n分度值 0.05 MPa，按 1/10 估读，半宽 0.005 MPa，均匀分布，u2 = 0.005/√3 = 0.0029 MPa\n\
        2.3 标准器引入的标准不确定度 u3\n最大允许误差 ±0.00125 MPa，均匀分布，u3 = 0.00125/√3 = 0.00072 MPa\n\n\
        3 合成标准不确定度\nuc = √(u1²+u2²+u3²) = 0.0033 MPa\n\n4 扩展不确定度\nU = k·uc = 2×0.0033 = 0.0066 MPa (k=2)\n";
    assert_eq!(first("text.txt", text), "intermediates-rounded");
}

/// The conditions of a calibration have a U of their own, and are no input.
#[test]
fn conditions_are_no_inputs() {
    is_sound(
        "sheet.csv",
        "环境条件,\"环境温度：23.0 °C，U = 0.5 K，k = 2\"\n\n输入量,标准不确定度,灵敏系数,分量\nV_x,0.0407 mV,1,0.0407 mV\n\
         V_s,0.0100 mV,-1,0.0100 mV\n合成标准不确定度 u_c,,,0.0420 mV\n扩展不确定度 U (k=2),,,0.084 mV\n",
    );
}

/// A sheet whose rows are components of the inputs of its equation: what the equation gives is no input that the table lacks.
#[test]
fn what_an_equation_gives_is_no_input() {
    is_sound(
        "sheet.csv",
        "Δ = V_x - V_s\n\n输入量,标准不确定度,灵敏系数,分量\nV_x.重复性,0.0407 mV,1,0.0407 mV\nV_s.证书,0.0100 mV,-1,0.0100 mV\n\
         合成标准不确定度 u_c,,,0.0420 mV\n扩展不确定度 U (k=2),,,0.084 mV\n\n\
         \"Δ = 0.0012 mV; U_95 = 0.084 mV, k_95 = 2.00。扩展不确定度为包含区间的半宽。\"\n",
    );
}
