//! What a sheet states and nothing contradicts: factors without a rule, degrees of freedom of a table, quantities that the model has and
//! no row; and what was taken for something else.

use super::{answer, first, is_sound, understood};
use crate::Verdict;

/// A factor without a rule is taken where U is the product, and nothing tells degrees of freedom.
#[test]
fn a_factor_without_a_rule_is_taken() {
    let sheet = |k: &str, u: &str| {
        format!("Source,u (mV)\nA,0.30\nB,0.40\nC,0.20\nu_c,0.539\nU (k={k}),{u}\n")
    };
    for (k, u) in [("1.73", "0.93"), ("1.83", "0.99"), ("2.13", "1.15")] {
        let (verdict, sets) = answer("sheet.csv", &sheet(k, u));
        let is_long = sets == ["too-many-digits"];
        assert!(verdict == Verdict::Sound || is_long, "{k}: {sets:?}");
    }
    assert_eq!(
        answer("sheet.csv", &sheet("1.73", "1.1")).0,
        Verdict::Unexplained
    );
    // EA-4/02 M:2022, S10: two rectangles make a trapezoid.
    is_sound(
        "sheet.csv",
        "Größe;Schätzwert;Halbweite;Verteilung;Teiler;Sensitivitätskoeffizient;Unsicherheitsbeitrag / µm\n\
         l_S;150,0001 mm;0,8 µm;Rechteck;1,732;1;0,46\nΔt;0 K;2 K;Rechteck;1,732;1,7 µm/K;1,96\n\
         δl_iX;0;25 µm;Rechteck;1,732;1;14,4\nδl_M;0;50 µm;Rechteck;1,732;1;28,9\nE_X;0,10 mm;;;;;32,3\n\
         U;;;;k=1,83;;0,06 mm\n",
    );
    is_sound(
        "sheet.csv",
        "输入量,估计值,标准不确定度,分布,灵敏系数,不确定度分量\nE_x,0.10 mm,,,,\nδ1,0,14 μm,均匀,1,14 μm\nδ2,0,29 μm,均匀,1,29 μm\n\
         合成标准不确定度,,,,,32 μm\n扩展不确定度 U95,,,,k=1.83（梯形分布）,0.059 mm\n",
    );
}

/// ν_eff = 47.3 is looked up at 45, and 51.1 at 50: the next lower row of the table.
#[test]
fn degrees_of_freedom_of_the_table() {
    let sheet = |nu: &str, k: &str| {
        format!(
            "No,Source,Value,Dist,Div,ui ppm,vi\n1,Standard cal k=2,8 ppm,N,2,4.0,100\n2,Drift,5 ppm,R,1.7321,2.9,100\n\
             3,Repeatability,3 ppm,N,1,3.0,4\n,Combined uc,,,,5.8,\n,veff,,,,,{nu}\n,Expanded k={k},,,,12,\n"
        )
    };
    is_sound("sheet.csv", &sheet("45", "2.06"));
    is_sound("sheet.csv", &sheet("47", "2.05"));
    assert_ne!(answer("sheet.csv", &sheet("30", "2.09")).0, Verdict::Sound);
}

/// A quantity of the model without a row may be a number, or exact: that is asked, and no slip.
#[test]
fn a_quantity_without_a_row_is_no_slip() {
    for model in [
        "Model: y = x + d + C",
        "Model: y = x + d - L_0",
        "y = x + d + 0.5 mm",
        "测量模型：y = x + d − N（N 为标称值）",
        "Model: E = x + d - x_ref, where x_ref is exact",
        "Model: y = (x + d)·(1 + αΔt)",
    ] {
        is_sound(
            "sheet.csv",
            &format!(
                "\"{model}\",,\nQuantity,u (mm),Distribution\nx,0.15,normal\nd,0.08,normal\nuc,0.170,\nU (k=2),0.34,\n"
            ),
        );
    }
}

/// Quantities called A, B and C are rows of a table of letters, and no heads of one on its side.
#[test]
fn capital_letters_are_quantities() {
    for head in ["Quantity", "Symbol", "符号"] {
        let sheet = |u: &str| {
            format!("{head},u (mΩ),c\nA,0.10,1\nB,0.20,-1\nC,0.15,1\nu_c,0.269,\nU (k=2),{u},\n")
        };
        is_sound("sheet.csv", &sheet("0.54"));
        assert_eq!(first("sheet.csv", &sheet("0.81")), "k-other");
    }
}

/// A correlation behind the model in its line, and one that is called ρ.
#[test]
fn correlations_stand_in_lines_of_models() {
    let sheet = |lines: &str| {
        format!(
            "{lines},,\n,,\nQuantity,u (mΩ),c\nR1,0.10,1\nR2,0.20,1\ndR,0.15,1\nu_c,0.335,\nU (k=2),0.67,\n"
        )
    };
    for lines in [
        "\"R = R1 + R2 + dR; R1 and R2 were calibrated with the same standard: r(R1, R2) = 1\"",
        "\"R = R1 + R2 + dR\",,\n\"ρ(R1,R2)=1\"",
        "电阻串联,,\n\"ρ(R1,R2)=1\"",
    ] {
        is_sound("sheet.csv", &sheet(lines));
        assert_eq!(
            understood("sheet.csv", &sheet(lines))[0].correlations.len(),
            1
        );
    }
}

/// U95 with k = 3: the factor is that of another probability.
#[test]
fn the_factor_of_another_probability_is_named() {
    let sheet = "Source,Half-width (mV),Distribution,Divisor,u (mV)\nReference,0.3,normal,2,0.150\n\
        Temperature,0.2,rectangular,√3,0.115\nResolution,0.05,rectangular,√3,0.0289\n\
        Repeatability,0.08,normal,1,0.0800\nu_c,,,,0.208\nU95,,,,0.62\n";
    assert_eq!(first("sheet.csv", sheet), "k-level");
    let slip = crate::slips::slip("k-level").unwrap();
    assert!(slip.en.contains("99.73"));
}

/// Sources that several inputs share count once, and what is their own in each input counts there.
#[test]
fn shared_sources_count_once() {
    let sheet = |u_c: &str, u: &str| {
        format!(
            "# src\n\n| quantity | estimate | unit | u | distribution | ν | c | c·u | % |\n| :--- | ---: | :--- | ---: | :--- | ---: | ---: | ---: | ---: |\n\
             | a | -1.000 | V | 0.0112 |  | ∞ | 1.000 | 0.0112 | 34.2 |\n| &emsp;s |  | V | 0.0100 | normal (B) | ∞ |  | -0.0100 | — |\n\
             | &emsp;own |  | V | 0.00500 | normal (B) | ∞ |  | 0.00500 | 2.6 |\n| b | 2.000 | V | 0.0206 |  | ∞ | -1.000 | -0.0206 | 65.8 |\n\
             | &emsp;s |  | V | 0.0200 | normal (B) | ∞ |  | -0.0200 | — |\n| &emsp;own |  | V | 0.00500 | normal (B) | ∞ |  | -0.00500 | 2.6 |\n\
             | *Shared sources (already contained in the inputs above)* |  |  |  |  |  |  |  |  |\n\
             | s |  |  | 0.0100 | normal (B) | ∞ | -3.000 | -0.0300 | 94.7 |\n| z | -3.000 | V | {u_c} |  | ∞ |  | {u_c} | 100.0 |\n\n\
             - **combined standard uncertainty**: u_c = {u_c} V\n- **coverage factor**: k = 2\n- **expanded uncertainty**: U = {u} V\n"
        )
    };
    is_sound("report.md", &sheet("0.0308", "0.062"));
    assert_ne!(
        answer("report.md", &sheet("0.0234", "0.047")).0,
        Verdict::Sound
    );
}

/// k = 2 without a probability claims none, whatever interval stands elsewhere on the sheet; terms of a formula are no limits.
#[test]
fn what_formulas_and_rules_are_not() {
    is_sound(
        "report.md",
        "| quantity | estimate | unit | u | distribution | ν | c | c·u |\n| :--- | ---: | :--- | ---: | :--- | ---: | ---: | ---: |\n\
         | x | 10.0030 | mm | 0.00291 | t (A) | 2.7 | 1.000 | 0.00291 |\n| y | 10.0030 | mm | 0.00291 |  | 2.7 |  | 0.00291 |\n\n\
         - **combined standard uncertainty**: u_c = 0.0029 mm\n- **effective degrees of freedom**: ν_eff = 2.7\n\
         - **coverage factor**: k = 2 (fixed, no probability stated)\n- **expanded uncertainty**: U = 0.0058 mm\n\n\
         - 95 % coverage interval, symmetric: 9.99047 to 10.01553\n",
    );
    is_sound(
        "sheet.csv",
        "Quantity,u,c,Contribution\nRe,300,0.001,0.30\neps,0.4,1,0.40\nu_c,,,0.50\nU (k=2),,,1.0\n\
         Solved: Re enters as x + 2*log10(eps/3.7 + 2.51/(Re*x)) - 2\n",
    );
}
