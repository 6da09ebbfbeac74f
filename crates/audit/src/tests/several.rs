//! Files with several results, and the notes of a report beside its tables.

use super::answer;
use crate::claim::{Claimed, Correlation};
use crate::read::{self, Mapping};
use crate::{Verdict, audit, sheet};

fn claims(text: &str) -> Vec<Claimed> {
    let grids = sheet::grids("sheet.txt", text.as_bytes()).unwrap();
    read::budgets(&grids, &Mapping::default())
}

fn is_sound(text: &str) {
    for claimed in claims(text) {
        let audited = audit(&claimed);
        assert_eq!(
            audited.verdict,
            Verdict::Sound,
            "{:?}\n{text}",
            audited.found.gaps
        );
    }
}

/// JCGM 100, H.2: R = V/I·cos φ and X = V/I·sin φ of the same readings, with the correlations of table H.2 below both budgets.
#[test]
fn a_table_is_of_the_result_that_it_names() {
    let table = |y: &str, cv: &str, ci: &str, cphi: &str, value: &str, u: &str| {
        format!(
            "Uncertainty budget of {y}\n  quantity   estimate   unit  u         distribution  c       c·u\n\
             \x20 V          4.9990     V     0.00321   t             {cv}\n\
             \x20 I          0.019661   A     0.00000947  t           {ci}\n\
             \x20 phi        1.04446    rad   0.000752  t             {cphi}\n\
             \x20 {y}          {value}     Ω     {u}                           {u}\n\n"
        )
    };
    let text = [
        "Impedance\nZ = V / I\nR = Z * cos(phi)\nX = Z * sin(phi)\n\n".to_owned(),
        table(
            "R",
            "25.55   0.0820",
            "-6497   -0.0615",
            "-219.8  -0.165",
            "127.73",
            "0.0711",
        ),
        table(
            "X",
            "43.98   0.141",
            "-11180  -0.106",
            "127.7  0.0961",
            "219.85",
            "0.296",
        ),
        "r(V, I) = -0.36\nr(V, phi) = 0.86\nr(I, phi) = -0.65\n".to_owned(),
    ]
    .concat();
    let found = claims(&text);
    let named: Vec<&str> = found.iter().map(|one| one.measurand.as_str()).collect();
    assert_eq!(named, ["R", "X"]);
    assert_eq!(found[0].model.as_deref(), Some("(V / I) * cos(phi)"));
    assert!(found.iter().all(|one| one.correlations.len() == 3));
    is_sound(&text);
}

/// A pair that is said twice has one correlation: 0.4² + 0.3² + 2·0.5·0.4·0.3 = 0.37.
#[test]
fn a_correlation_that_is_said_again_is_one() {
    let text = "Source  Symbol  u / mm  c  u_i / mm\nOne     a1      0.40    1  0.40\nOther   b1      0.30    1  0.30\n\n\
                r(a1, b1) = 0.5\nThe correlation coefficient is r(a1, b1) = 0.5\nu_c = 0.608 mm\nU = 1.2 mm (k = 2)\n";
    let found = claims(text);
    assert_eq!(
        found[0].correlations,
        [Correlation {
            a: 0,
            b: 1,
            r: 0.5,
            open: 0.0
        }]
    );
    is_sound(text);
}

#[test]
fn a_kelvin_is_no_coverage_factor() {
    let text = "quantity  estimate  unit  u     distribution  c  c·u\nT_m       509.7     K     8.60  normal        1  8.60\n\
                d         0.0       K     2.00  normal        1  2.00\nT_c       509.7     K     8.83                   8.83\n\n\
                U = 18 K (k = 2)\n";
    assert_eq!(
        claims(text)[0].footer.k.as_ref().map(|k| k.value),
        Some(2.0)
    );
    is_sound(text);
}

/// What a heading says of the rows below it: the drift is in all of them.
#[test]
fn rows_below_a_heading_may_be_contained() {
    let text = |heading: &str| {
        format!(
            "quantity  estimate  unit  u      distribution  c      c·u\nR1        100.0     Ω     0.100  normal        1.000  0.100\n\
             R2        100.0     Ω     0.200  normal        1.000  0.200\n-------------------------------------------------\n\
             {heading}\ndrift               Ω     0.050  normal        1.000  0.050\nR         200.0     Ω     0.224                       0.224\n\n\
             U = 0.45 Ω (k = 2)\n"
        )
    };
    is_sound(&text(
        "Shared sources (already contained in the inputs above)",
    ));
    let (verdict, _) = answer("sheet.txt", &text("Further sources"));
    assert_ne!(verdict, Verdict::Sound);
}

/// A remark says how well u is known (JCGM 100, E.4.3), or what a function of the input has: neither is u of the input.
#[test]
fn remarks_of_a_report_are_no_inputs() {
    for remark in [
        "Only 9 effective degrees of freedom: u itself is uncertain by about 24 %, which a k from t allows for. More readings of dm would help.",
        "dm: u itself is uncertain by about 24 %.",
        "The direction is hardly known: atan2(dm, m_S) has a standard uncertainty of 10 g.",
    ] {
        is_sound(&format!(
            "Source     Symbol  u / g  c  u_i / g\nStandard   m_S     0.04   1  0.04\nReadings   dm      0.03   1  0.03\n\n{remark}\nu_c = 0.05 g\n"
        ));
    }
}

/// Welch and Satterthwaite's formula is for independent inputs (JCGM 100, G.4.1).
#[test]
fn degrees_of_freedom_of_correlated_readings_are_taken() {
    let text = |r: &str| {
        format!(
            "Source  Symbol  u / mm  c  u_i / mm  ν\nOne     a1      0.40    1  0.40      4\nOther   b1      0.30    1  0.30      4\n\n\
             {r}\nu_c = 0.608 mm\nν_eff = 4\nk = 2.78\nU = 1.7 mm\n"
        )
    };
    is_sound(&text("r(a1, b1) = 0.5"));
    let (verdict, _) = answer(
        "sheet.txt",
        &text("").replace("0.608", "0.50").replace("1.7", "1.4"),
    );
    assert_ne!(verdict, Verdict::Sound);
}

#[test]
fn a_matrix_below_a_rule_is_no_budget() {
    let text = "Source  u / mm\nOne     0.40\nOther   0.30\n\nu_c = 0.50 mm\n\n\
                Correlation coefficients  a     b     y\n---------------------------------------\n\
                a                         1.00  0.10  0.53\nb                         0.10  1.00  0.88\n\
                y                         0.53  0.88  1.00\n";
    assert_eq!(claims(text).len(), 1);
}

/// A table whose columns are one blank apart, with rules: a sum of 0.3 mm and of 0.4 mm with c = 2.
#[test]
fn tables_with_rules_may_have_narrow_columns() {
    is_sound(
        "Length of a bar, with commas, as sentences have them\n\n\
         quantity         estimate unit     u distribution ν     c  c·u     %\n\
         ----------------------------------------------------------------------\n\
         length              400.0 mm   0.300 normal (B)   ∞ 1.000 0.30  36.0 #\n\
         position of the stop  0.0 mm   0.200 uniform (B)  ∞ 2.000 0.40  64.0 ##\n\
         ----------------------------------------------------------------------\n\
         L                   400.0 mm   0.500              ∞       0.50 100.0\n\n\
         U = 1.0 mm, k = 2\n",
    );
}

/// A correlation below the second point is of the second point, where the first has none in its sum.
#[test]
fn points_have_correlations_of_their_own() {
    let point = |statement: &str| {
        format!(
            "Source  Symbol  u / mm  c  u_i / mm\nOne     a1      0.40    1  0.40\nOther   b1      0.30    1  0.30\n\n{statement}\n\n\n"
        )
    };
    is_sound(
        &[
            point("u_c = 0.50 mm\nU = 1.0 mm (k = 2)"),
            point("r(a1, b1) = 0.5\nu_c = 0.608 mm\nU = 1.2 mm (k = 2)"),
        ]
        .concat(),
    );
}
