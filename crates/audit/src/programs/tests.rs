//! Files of other programs, from their text to figures.

use crate::read::Mapping;
use crate::{Verdict, audit, budget_files, claims};
use gumption_fault::language::Language;

const SUNCAL: &str = include_str!("../../tests/programs/power.yaml");
const NIST: &str = include_str!("../../tests/programs/expansion.um");
const WORKBENCH: &str = include_str!("../../tests/programs/weighing.smu");
const RADIO: &str = include_str!("../../tests/programs/activity.txp");

const FILES: [(&str, &str); 4] = [
    ("power.yaml", SUNCAL),
    ("expansion.um", NIST),
    ("weighing.smu", WORKBENCH),
    ("activity.txp", RADIO),
];

/// y, u_c and ν_eff of every result.
fn figures(name: &str, text: &str) -> Vec<(f64, f64, f64)> {
    let claims = claims(name, text.as_bytes(), &Mapping::default()).unwrap();
    let figures = claims.iter().map(|claimed| {
        let found = audit(claimed).found;
        (found.case.y.unwrap(), found.right.u_c, found.right.nu_eff)
    });
    figures.collect()
}

fn close(found: (f64, f64, f64), expected: (f64, f64, f64), digits: f64) {
    let near = |a: f64, b: f64| a == b || (a / b - 1.0).abs() < digits;
    assert!(
        near(found.0, expected.0) && near(found.1, expected.1) && near(found.2, expected.2),
        "{found:?} instead of {expected:?}"
    );
}

/// What suncal 1.7.1 itself prints for this project, which it wrote.
#[test]
fn suncal_prints_the_same() {
    let figures = figures("power.yaml", SUNCAL);
    close(
        figures[0],
        (1.00570913, 0.00135645052, 33240.211094214596),
        1e-8,
    );
    close(
        figures[1],
        (0.100109978, 2.45187329e-5, 571.976227254211),
        1e-8,
    );
}

/// By hand: c(L_1) = 1/(L_0 ΔT), c(L_0) = −L_1/(L_0² ΔT), c(T) = ∓α/ΔT; u(L_1) = 0.0002 √(3/1), r = 0.5.
#[test]
fn distributions_of_the_uncertainty_machine() {
    let (l0, l1, dt): (f64, f64, f64) = (1.4999, 1.5021, 373.10 - 288.15);
    let alpha = (l1 - l0) / (l0 * dt);
    let a = 0.0002 * 3f64.sqrt() / (l0 * dt);
    let b = -0.0001 * l1 / (l0 * l0 * dt);
    let t = alpha / dt * (0.02f64.powi(2) + 0.05f64.powi(2)).sqrt();
    let u = (a * a + b * b + a * b + t * t).sqrt();
    let found = figures("expansion.um", NIST)[0];
    close((found.0, found.1, 1.0), (alpha, u, 1.0), 1e-9);
    // The same with another ending is known by its keys.
    assert_eq!(figures("config.txt", NIST).len(), 1);
}

#[test]
fn what_gum_workbench_kept_is_a_claim() {
    let found = figures("weighing.smu", WORKBENCH);
    let square = (0.02f64.powi(2) + 0.002f64.powi(2)) / 3.0 + 2.0 * 0.003f64.powi(2);
    close(
        (found[0].0, found[0].1, 1.0),
        (100.012, square.sqrt(), 1.0),
        1e-9,
    );
    let verdict = |text: &str| {
        let claims = claims("weighing.smu", text.as_bytes(), &Mapping::default()).unwrap();
        audit(&claims[0]).verdict
    };
    assert_eq!(verdict(WORKBENCH), Verdict::Sound);
    assert_ne!(
        verdict(&WORKBENCH.replace("Ustd=0.0124", "Ustd=0.0208")),
        Verdict::Sound
    );
}

#[test]
fn names_of_uncertradio_are_the_same_in_all_cases() {
    let found = figures("activity.txp", RADIO)[0];
    let (w, rn) = (1.0 / (0.25 * 0.5), 0.8);
    // Half-width 4 % of the efficiency.
    let relative = (0.04 / 3f64.sqrt()).powi(2) + (0.015f64.powi(2) + 0.005f64.powi(2)) / (rn * rn);
    close(
        found,
        (w * rn, w * rn * relative.sqrt(), f64::INFINITY),
        1e-9,
    );
    let file = budget_files(
        "activity.txp",
        RADIO.as_bytes(),
        &Mapping::default(),
        Language::English,
    )
    .unwrap();
    assert!(
        file[0].contains("[constant.V]") && file[0].contains("coverage_factor = 2.0"),
        "{}",
        file[0]
    );
    assert!(file[0].contains("(N + x) rule"), "{}", file[0]);
}

#[test]
fn a_file_that_claims_nothing_is_not_called_sound() {
    let claims = claims("power.yaml", SUNCAL.as_bytes(), &Mapping::default()).unwrap();
    let audited = audit(&claims[0]);
    assert_eq!(audited.verdict, Verdict::NotRecomputed);
}

/// Each line of a file spoilt in one way: refused at that line, with what was expected.
#[test]
fn what_is_not_understood_is_refused_at_its_place() {
    for (name, text, from, to, said) in [
        (
            "a.yaml",
            SUNCAL,
            "dist: arcsine",
            "dist: cauchy",
            "line 27, column 13 of this file of suncal: the distribution `cauchy`",
        ),
        (
            "a.yaml",
            SUNCAL,
            "expr: V/R",
            "expr: V/Q",
            "line 11, column 13 of this file of suncal: `Q` is in the formula",
        ),
        ("a.yaml", SUNCAL, "a: 0.02%", "a: 2 parts", "`2 parts`"),
        (
            "a.yaml",
            SUNCAL,
            "    - 10.015\n    - 10.011\n    - 10.014\n    - 10.013\n",
            "",
            "a standard deviation takes two readings",
        ),
        (
            "a.yaml",
            SUNCAL,
            "conf: 0.95",
            "conf: 95",
            "line 94, column 13 of this file of suncal: a probability between 0 and 1",
        ),
        (
            "a.yaml",
            SUNCAL,
            "mode: uncertainty",
            "mode: risk",
            "no component has the mode `uncertainty`",
        ),
        (
            "a.yaml",
            SUNCAL,
            "units: ohm\n    uncerts",
            "units: furlong\n    uncerts",
            "the unit `furlong` is not known",
        ),
        (
            "a.um",
            NIST,
            "L.0;7;",
            "L.0;23;",
            "line 5, column 15 of this file of the NIST Uncertainty Machine: the distribution of type 23",
        ),
        (
            "a.um",
            NIST,
            "nbVar=4",
            "nbVar=5",
            "5 variables are announced, and 4 stand in the file",
        ),
        (
            "a.um",
            NIST,
            "dL/(L.0*dT)",
            "ifelse(dL, 1)",
            "the function `ifelse` has no counterpart",
        ),
        (
            "a.um",
            NIST,
            "0.5;0;0;0;0;0",
            "0.5;0",
            "6 coefficients were expected",
        ),
        (
            "a.smu",
            WORKBENCH,
            "Corr=0",
            "Corr=1",
            "how this program writes correlations is not known",
        ),
        (
            "a.smu",
            WORKBENCH,
            "Type=TypASum",
            "Type=TypAMess",
            "line 41, column 6 of this file of GUM Workbench: the type `TypAMess`",
        ),
        ("a.smu", WORKBENCH, "Hlim=2\n", "", "needs the key `Hlim`"),
        (
            "a.txp",
            RADIO,
            "Rn = Rg - R0",
            "Rn = Linfit(1)",
            "line 6, column 6 of this file of UncertRadio: the function `Linfit`",
        ),
        (
            "a.txp",
            RADIO,
            "@Sonstige",
            "2 # 3 # 1 # # 0.5 #\n@Sonstige",
            "covariances of this program are not read",
        ),
        (
            "a.txp",
            RADIO,
            "# 0.015 #",
            "# -999 #",
            "the standard uncertainty that this formula gives is missing",
        ),
    ] {
        let spoilt = text.replacen(from, to, 1);
        assert_ne!(spoilt, text, "{from}");
        let why = claims(name, spoilt.as_bytes(), &Mapping::default())
            .unwrap_err()
            .0
            .to_string();
        assert!(why.contains(said), "{from} -> {to}: {why}");
    }
}

/// Equations that need one another are an error, and no endless way.
#[test]
fn circles_are_refused() {
    let circle = SUNCAL
        .replace("expr: V/R", "expr: V/P")
        .replace("expr: V**2*", "expr: I*V**2*");
    let why = claims("a.yaml", circle.as_bytes(), &Mapping::default())
        .unwrap_err()
        .0;
    assert!(why.to_string().contains("in a circle"), "{why}");
}

/// Whatever is cut off or out: an answer or an error. What either says, other tests hold; both come about, and nothing else does.
#[test]
fn smoke_of_cut_files() {
    let (mut answered, mut refused) = (0, 0);
    for (name, text) in FILES {
        for at in (0..text.len()).step_by(3) {
            let cut = text.get(..at).unwrap_or_default();
            let without = format!("{cut}{}", text.get(at + 7..).unwrap_or_default());
            for text in [cut, &without] {
                let _ = budget_files(
                    name,
                    text.as_bytes(),
                    &Mapping::default(),
                    Language::English,
                );
                let Ok(claims) = claims(name, text.as_bytes(), &Mapping::default()) else {
                    refused += 1;
                    continue;
                };
                answered += 1;
                for claimed in claims {
                    let _ = crate::calculate::Case::of(&claimed);
                }
            }
        }
    }
    assert!(
        answered > 100 && refused > 100,
        "{answered} answers, {refused} refusals"
    );
}
