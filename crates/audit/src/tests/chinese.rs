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
