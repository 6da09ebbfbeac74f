//! What a sheet says of k and its probability, in audits and imports.

use super::{answer, first};
use crate::read::Mapping;
use crate::{Verdict, budget_files};
use gumption_fault::language::Language;

fn is_sound(sheet: &str) {
    assert_eq!(
        answer("sheet.csv", sheet),
        (Verdict::Sound, Vec::new()),
        "{sheet}"
    );
}

/// The conventions of the budget file that a sheet is imported as.
fn conventions(sheet: &str) -> String {
    let files = budget_files(
        "sheet.csv",
        sheet.as_bytes(),
        &Mapping::default(),
        Language::English,
    );
    let file = files.unwrap().remove(0);
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
        is_sound(&sheet);
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
        is_sound(&sheet);
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
        is_sound(&of_many(expanded));
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
        is_sound(&of_many(&format!("U (k = 2) = 0.75 g\n{remark}")));
    }
}
