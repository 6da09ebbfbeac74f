//! What a sheet says of k and its probability, in audits and imports.

use super::{first, imported, is_sound};

/// The conventions of the budget file that a sheet is imported as.
fn conventions(sheet: &str) -> String {
    let file = imported(sheet);
    let (_, behind) = file.split_once("[conventions]\n").unwrap();
    let (conventions, _) = behind.split_once("\n\n").unwrap();
    conventions.to_string()
}

fn of_few_readings(k: &str) -> String {
    format!(
        "Source,Value (g),Distribution,Divisor,u (g),Degrees of freedom\n\
         Repeatability s=0.5 g n=3,0.5,normal,√3,0.2887,2\n\
         Calibration U=0.2 g k=2,0.2,normal,2,0.1000,∞\n\
         Combined standard uncertainty,,,,0.3055,2\n\
         {k},,,,4.30,\nExpanded uncertainty U,,,,1.3,\n"
    )
}

fn of_many(expanded: &str) -> String {
    format!(
        "Source,Value (g),Distribution,Divisor,u (g)\n\
         Repeatability (mean),0.3,normal,1,0.3000\n\
         Calibration U=0.2 g k=2,0.2,normal,2,0.1000\n\
         Linearity,0.3464,rectangular,√3,0.2000\n\
         Combined standard uncertainty,,,,0.3742\n{expanded}\n"
    )
}

/// An import goes on with the rule for k by which the sheet is sound.
#[test]
fn an_import_has_the_rule_of_the_audit() {
    for label in ["Coverage factor k (95 %)", "k = t_0.95(ν_eff)"] {
        let sheet = of_few_readings(label);
        is_sound("sheet.csv", &sheet);
        let by_t = "coverage_probability = 0.95\ncoverage_factor_from = \"t\"";
        assert_eq!(conventions(&sheet), by_t, "{label}");
    }
    for (expanded, k) in [
        ("Expanded uncertainty (k=3),,,,1.1", "3.0"),
        (
            "Expanded uncertainty (k=1.65; 95 %; rectangular),,,,0.62",
            "1.65",
        ),
        ("Expanded uncertainty; coverage factor 3,,,,1.1", "3.0"),
    ] {
        let sheet = of_many(expanded);
        is_sound("sheet.csv", &sheet);
        assert_eq!(
            conventions(&sheet),
            format!("coverage_factor = {k}"),
            "{expanded}"
        );
    }
    // Nothing is said where nothing is known.
    let silent = conventions(&of_many("Expanded uncertainty U,,,,0.75"));
    assert_eq!(
        silent,
        "# The sheet states no rule for k.\ncoverage_factor = 2.0"
    );
}

/// The probability stands in the name of U, or behind its figure; the factor in a product that comes to U.
#[test]
fn other_probabilities_than_95_percent_are_read() {
    for expanded in [
        "Expanded uncertainty U99,,,,0.96",
        "Expanded uncertainty (k=2.58),,,,0.96",
        "U_99 = 0.96 g",
        "U = 0.96 g (99 %)",
        "U(99 %) = 0.96 g",
        "U = 3 × 0.3742 g = 1.1 g",
        "U = k × u(m) = 1.65 × 0.3742 g ≅ 0.62 g",
    ] {
        is_sound("sheet.csv", &of_many(expanded));
    }
    let by_two = of_many("U = 0.75 g (99 %)");
    assert_eq!(first("sheet.csv", &by_two), "k-level");
}

/// Beside U with its own factor, a remark about another time or case states no rule.
#[test]
fn a_remark_is_no_rule() {
    for remark in [
        "Remark: U of the previous year was 3.1 g; k = 3.",
        "k = 2.87 would apply at 99 %",
        "In 2023 we used k = 3",
    ] {
        is_sound(
            "sheet.csv",
            &of_many(&format!("U (k = 2) = 0.75 g\n{remark}")),
        );
    }
}

/// Degrees of freedom of a row of type B are imported, and a row without uncertainty is a constant.
#[test]
fn an_import_keeps_degrees_of_freedom_and_constants() {
    let rated = imported(
        "Source,Value (g),Distribution,Divisor,u (g),Degrees of freedom\n\
         Calibration U=0.6 g k=2,0.6,normal,2,0.300,50\nLinearity ±0.2 g,0.2,rectangular,√3,0.115,12\n\
         u_c,,,,0.321,\nU (k=2),,,,0.64,\n",
    );
    assert!(
        rated.contains("certificate = { U = 0.6, k = 2.0, dof = 50 }"),
        "{rated}"
    );
    assert!(rated.contains("half_width = 0.2\ndof = 12\n"), "{rated}");
    let exact = imported(
        "Multimeter\nE_X = V_iX - V_S + d_V\n\
         quantity,estimate,standard uncertainty,probability distribution,sensitivity coefficient,uncertainty contribution\n\
         V_iX,100.1 V,-,-,-,-\nV_S,100.0 V,0.001 V,normal,-1.0,-0.001 V\nd_V,0.0 V,0.029 V,rectangular,1.0,0.029 V\n\
         E_X,0.1 V,,,,0.029 V\nU = 2 × 0.029 V = 0.058 V\n",
    );
    assert!(
        exact.contains("[constant.V_iX]\n") && !exact.contains("u = 0\n"),
        "{exact}"
    );
}

/// The result may stand above u_c with the same figure, or apart from it.
#[test]
fn a_result_above_the_sum_is_no_source() {
    for between in ["", "\n"] {
        is_sound(
            "sheet.csv",
            &format!(
                "Quantity,Nominal value,Std. uncertainty,Distr.,Sensitivity,u_i(y)\n\
             E,980.4 mV,0.091,normal,1.1552,0.105\ntheta,30 °,0.020,rectangular,11.413,0.228\n\
             K_1,1132.60 mV/g,,,,0.251\n{between}u_c,,,,,0.251\nU (k = 2),,,,,0.50\n"
            ),
        );
    }
}

/// An import says of which readings s is, and which estimate it leaves behind where it has no model.
#[test]
fn an_import_says_what_it_takes_and_leaves() {
    let sheet = |words: &str| {
        format!(
            "Größe;Bezeichnung;Schätzwert;Halbweite / Unsicherheit;Verteilung;Teiler;Empfindlichkeitskoeffizient;Beitrag;Freiheitsgrade\n\
             ;;bar;bar;;;;bar;\np_N;Normal, Kalibrierschein (U, k=2);5,000;0,060;normal;2;1;0,030;∞\n\
             δp_W;{words};0;0,024;normal;1;1;0,024;9\n\n;Kombinierte Standardunsicherheit;;;;;;0,038;\n;Erweiterte Unsicherheit U (k = 2);;;;;;0,077;\n"
        )
    };
    let file = imported(&sheet("Wiederholbarkeit (Mittelwert aus 10 Messungen)"));
    let of_mean = "# Of the mean, as the sheet states it.\nu = 0.024\n";
    let left =
        "# Its estimate 5,000 bar is left out: the result is not computed here.\nvalue = 0\n";
    for text in [of_mean, left] {
        assert!(file.contains(text), "{file}");
    }
    let single = imported(&sheet("Wiederholbarkeit"));
    assert!(
        single.contains("# Of a single reading.\nu = 0.024\n"),
        "{single}"
    );
}
