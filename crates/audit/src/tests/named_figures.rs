//! Figures of the whole whose labels say more than their names: the point, the factor, the result.

use super::{answer, first, is_sound, understood};
use crate::Verdict;
use crate::read;

/// Three sources in ppm, u_c, and a last line.
fn in_ppm(last: &str) -> String {
    format!(
        "Source,Limit (ppm),Dist,Div,u (ppm)\nStandard k=2,4,N,2,2.00\nDrift,3,R,√3,1.73\n\
         Repeat.,1.5,N,1,1.50\nRSS,,,,3.04\n{last}\n"
    )
}

/// Four sources in mV, and two last lines.
fn in_mv(u_c: &str, expanded: &str) -> String {
    format!(
        "Source,Half-width (mV),Distribution,Divisor,u (mV)\nReference,0.3,normal,2,0.150\n\
         Temperature,0.2,rectangular,√3,0.115\nResolution,0.05,rectangular,√3,0.0289\n\
         Repeatability,0.08,normal,1,0.0800\n{u_c}\n{expanded}\n"
    )
}

/// The point at which U holds is not U.
#[test]
fn a_label_may_name_the_point() {
    for label in [
        "Expanded uncertainty at 23 °C (k=2)",
        "Expanded uncertainty at 20 kN (k=2)",
        "Expanded uncertainty at 50 % load (k=2)",
        "Expanded uncertainty for 10 V range (k=2)",
        "扩展不确定度（20 kN 点，k=2）",
        "扩展不确定度（在 20 kN 处，k=2）",
        "\"U at -20 °C, k = 2\"",
    ] {
        is_sound("sheet.csv", &in_ppm(&format!("{label},,,,6.1")));
        let (verdict, sets) = answer("sheet.csv", &in_ppm(&format!("{label},,,,9.1")));
        let is_k = sets.iter().all(|set| set == "k-other");
        assert!(verdict != Verdict::Sound && is_k, "{label}: {sets:?}");
    }
}

/// U of a line, behind the conditions under which it holds; of other units than the rows at the one point that the line names.
#[test]
fn a_figure_stands_behind_its_conditions() {
    for (label, [right, wrong]) in [
        (
            "Expanded uncertainty at 23 °C: {} (k=2)",
            ["6.1 ppm", "9.9 ppm"],
        ),
        (
            "\"Expanded uncertainty, k = 2: {}\"",
            ["6.1 ppm", "9.9 ppm"],
        ),
        (
            "\"Expanded uncertainty, 95 %, k = 2: {}\"",
            ["6.1 ppm", "9.9 ppm"],
        ),
        (
            "\"Expanded uncertainty U (k=2) at 10 V: {}\"",
            ["61 µV", "99 µV"],
        ),
        (
            "Expanded uncertainty at 100 kΩ: {} (k=2)",
            ["0.61 Ω", "0.99 Ω"],
        ),
        ("U at 10 V,,,k=2,{}", ["61 µV", "99 µV"]),
        ("U = {} at 10 V (k = 2)", ["61 µV", "99 µV"]),
    ] {
        is_sound("sheet.csv", &in_ppm(&label.replace("{}", right)));
        let (verdict, _) = answer("sheet.csv", &in_ppm(&label.replace("{}", wrong)));
        assert_ne!(verdict, Verdict::Sound, "{label}");
    }
}

/// What is called U and not understood is told.
#[test]
fn a_line_of_which_u_is_lost_is_told() {
    let sheet = in_ppm("\"Expanded uncertainty (k=2) in full: see 9.9\"");
    let claims = understood("sheet.csv", &sheet);
    assert!(claims[0].footer.expanded.is_none());
    assert!(read::unread_expanded(&claims[0]).is_some());
}

/// u_c and U at a point, of so many standard deviations, as multiples, of the result: none of them is a source.
#[test]
fn figures_of_the_whole_are_no_sources() {
    for [u_c, expanded] in [
        ["u_c at 23 °C", "\"U at 23 °C, k=2\""],
        ["uc @20kN", "U @20kN k=2"],
        ["Uncertainty (1 sigma)", "Uncertainty (2 sigma)"],
        ["Uncertainty (1σ)", "Uncertainty (2σ)"],
        ["Result u_c at 20 kN", "Result U at 20 kN (k=2)"],
        ["u (k=1)", "u (k=2)"],
        ["u_c", "2u"],
        ["总不确定度", "U(k=2)"],
    ] {
        let sheet = |u: &str| in_mv(&format!("{u_c},,,,0.208"), &format!("{expanded},,,,{u}"));
        is_sound("sheet.csv", &sheet("0.42"));
        assert_eq!(first("sheet.csv", &sheet("0.62")), "k-other", "{expanded}");
    }
}

/// `扩展: U = …` is no source of a report in lines, and `u_A = …` is what the line above it comes to.
#[test]
fn lines_of_the_whole_and_of_rows() {
    let whole = "合成: uc = 0.0028 V\n扩展: U = 0.0056 V (k=2)\n";
    is_sound(
        "report.txt",
        &format!(
            "A类不确定度: s=0.0032 V, n=10, u_A = s/√10 = 0.00101 V\n\
             B类不确定度: 数字表最大允许误差 ±0.0045 V，均匀分布, u_B = 0.0045/√3 = 0.0026 V\n{whole}"
        ),
    );
    is_sound(
        "report.txt",
        &format!(
            "A类不确定度: 重复测量10次 s=0.0032 V\nu_A = s/√10 = 0.00101 V\n\
             B类不确定度: 数字表最大允许误差 ±0.0045 V，均匀分布\nu_B = 0.0045/√3 = 0.0026 V\n{whole}"
        ),
    );
}

/// Formulas of Markdown in heads and sentences.
#[test]
fn formulas_of_markdown_are_read() {
    let sheet = |u: &str| {
        format!(
            "| Source | Value | Divisor | Distribution | $c_i$ | $u_i$ / mg | $\\nu_i$ |\n|:--|--:|--:|:--|--:|--:|--:|\n\
             | Reference mass, k = 2 | 0.10 mg | 2 | Normal | 1 | 0.050 | ∞ |\n\
             | Drift of mass | 0.05 mg | $\\sqrt{{3}}$ | Rect. | 1 | 0.029 | ∞ |\n\
             | Repeatability | 0.09 mg | 1 | Normal | 1 | 0.090 | 5 |\n\
             | **Combined** | | | | | **0.107** | **9** |\n| **Expanded** | | | k = 2.26 | | **{u}** | |\n"
        )
    };
    is_sound("sheet.md", &sheet("0.24"));
    let product = "| Source | a | k | u (mV) |\n|---|---|---|---|\n| Reference | 0.30 | 2 | 0.150 |\n\
        | Temperature | 0.20 | √3 | 0.115 |\n| Repeatability | — | — | 0.080 |\n\nu_c = 0.206 mV\n\n\
        $U=k u_c=2\\times 0.206=0.41$ mV\n";
    is_sound("sheet.md", product);
    assert_eq!(
        understood("sheet.md", product)[0]
            .footer
            .expanded
            .as_ref()
            .map(|u| u.value),
        Some(0.41)
    );
}
