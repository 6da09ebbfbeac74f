//! Every published case that needs only inputs, a model and the two methods is a budget of the library. The
//! cases lie beside the project where it is developed; elsewhere this test has nothing to read and says so.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use gumption::budget;
use gumption::propagate::{self, Evaluation, MonteCarloChoice, Options};
use toml::{Table, Value};

/// Case and the budgets that hold it, below `budgets/`.
const BUDGETS: &[(&str, &[&str])] = &[
    (
        "bevington_t6_1",
        &["calibration-lines/voltage-bevington-6-1"],
    ),
    (
        "gum_h3_systematic",
        &["temperature/thermometer-systematic-gum-h3"],
    ),
    (
        "gum_h3_thermometer",
        &["temperature/thermometer-calibration-gum-h3"],
    ),
    (
        "iso28037_gdr1",
        &["calibration-lines/both-uncertain-iso28037-7"],
    ),
    (
        "iso28037_wls1",
        &["calibration-lines/equal-weights-iso28037-6"],
    ),
    (
        "natrella_young_modulus",
        &["calibration-lines/young-modulus-natrella"],
    ),
    ("pearson_york_wtls", &["calibration-lines/pearson-york"]),
    ("ea402_s2_mass", &["mass/weight-10kg-ea402-s2"]),
    (
        "ea402_s4_gauge_block",
        &["length/gauge-block-50mm-ea402-s4"],
    ),
    ("ea402_s5_1_furnace", &["temperature/furnace-ea402-s5"]),
    ("ea402_s5_2_emf", &["temperature/thermocouple-emf-ea402-s5"]),
    (
        "ea402_s7_attenuator",
        &["electrical/attenuator-30db-ea402-s7"],
    ),
    ("ea402_s9_dmm", &["electrical/dmm-100v-ea402-s9"]),
    ("gum5_01_ph", &["chemistry/ph-interpolation-gum5-1"]),
    (
        "gum5_03_glucose",
        &["chemistry/glucose-molecular-mass-gum5-3"],
    ),
    ("gum5_15_wire_rope", &["force/wire-rope-gum5-15"]),
    ("gum_4_3_type_b", &["statistics/type-b-conversions-gum-4-3"]),
    ("gum_5_1_5_dmm", &["electrical/voltmeter-gum-5-1-5"]),
    (
        "gum_5_2_2_ten_resistors",
        &[
            "electrical/resistors-in-series-gum-5-2-2",
            "electrical/resistors-in-series-matrix",
        ],
    ),
    ("gum_amd1_2026_bias", &["statistics/second-order-bias-amd1"]),
    ("gum_g4_welch", &["statistics/product-gum-g4"]),
    (
        "gum_h1_d_component",
        &["length/end-gauge-difference-gum-h1-3-2"],
    ),
    ("gum_h1_end_gauge", &["length/end-gauge-gum-h1"]),
    ("gum_h1_full_nine_inputs", &["length/end-gauge-nine-inputs"]),
    ("gum_h2_impedance", &["electrical/impedance-gum-h2"]),
    (
        "gum_h2_rounded_inputs",
        &["electrical/impedance-rounded-inputs"],
    ),
    (
        "gum_h2_uncorrelated",
        &["electrical/impedance-correlation-ignored"],
    ),
    (
        "gum_h4_radon",
        &["radiation/radon-gum-h4", "radiation/radon-gum-h4-ratios"],
    ),
    ("gum_h6_hardness", &["force/rockwell-hardness-gum-h6"]),
    // The estimate and u; decision threshold and detection limit are of a later kind.
    (
        "iso11929_2010_ex1a",
        &["radiation/alpha-activity-iso11929-1a"],
    ),
    ("iso11929_4_ex6", &["radiation/net-count-iso11929-4-6"]),
    ("kessel2006_1_mass", &["mass/weight-10kg-kessel"]),
    ("kessel2006_2b_lead", &["chemistry/lead-molar-mass-kessel"]),
    ("num_stefan_boltzmann", &["temperature/radiation-constant"]),
    ("quam_a1_cadmium", &["chemistry/cadmium-standard-quam-a1"]),
    ("quam_a2_naoh", &["chemistry/sodium-hydroxide-quam-a2"]),
    (
        "s1_6_4_pdf_moments",
        &["statistics/distributions-gum-s1-6-4"],
    ),
    (
        "s1_9_2_2_normal",
        &["statistics/sum-of-normals-gum-s1-9-2-2"],
    ),
    (
        "s1_9_2_3_rect",
        &["statistics/sum-of-rectangles-gum-s1-9-2-3"],
    ),
    (
        "s1_9_2_4_rect_unequal",
        &["statistics/sum-of-unequal-rectangles-gum-s1-9-2-4"],
    ),
    ("s1_9_3_mass", &["mass/weight-100g-gum-s1-9-3"]),
    (
        "s1_9_4_loss_x000_r00",
        &["statistics/comparison-loss-gum-s1-9-4-x000-r00"],
    ),
    (
        "s1_9_4_loss_x000_r09",
        &["statistics/comparison-loss-gum-s1-9-4-x000-r09"],
    ),
    (
        "s1_9_4_loss_x010_r00",
        &["statistics/comparison-loss-gum-s1-9-4-x010-r00"],
    ),
    (
        "s1_9_4_loss_x050_r09",
        &["statistics/comparison-loss-gum-s1-9-4-x050-r09"],
    ),
    ("s1_9_5_gauge_block", &["length/gauge-block-gum-s1-9-5"]),
    (
        "s2_9_2_additive_normal",
        &["statistics/two-outputs-gum-s2-9-2"],
    ),
    (
        "s2_9_3_polar_x001_r00",
        &["statistics/polar-gum-s2-9-3-x001-r00"],
    ),
    (
        "s2_9_3_polar_x001_r09",
        &["statistics/polar-gum-s2-9-3-x001-r09"],
    ),
    (
        "s2_9_3_polar_x010_r09",
        &["statistics/polar-gum-s2-9-3-x010-r09"],
    ),
    (
        "s2_9_3_polar_x100_r00",
        &["statistics/polar-gum-s2-9-3-x100-r00"],
    ),
    ("suncal_xrf", &["radiation/film-thickness-xrf"]),
    (
        "tn1900_e13_thermal_expansion",
        &["temperature/thermal-expansion-tn1900-e13"],
    ),
    (
        "tn1900_e2_surface_temperature",
        &["temperature/surface-temperature-tn1900-e2"],
    ),
    (
        "willink2008_line_dof",
        &["statistics/line-value-willink-2008"],
    ),
    (
        "willink_hall_ex1_complex",
        &["statistics/complex-difference-willink-hall"],
    ),
    ("wuebbeler_ex2_ohm", &["electrical/resistance-from-limits"]),
];

/// Cases without inputs: Table G.2, the coverage factors of JCGM 102 6.5 and the tolerances of JCGM 101 7.9.2
/// are unit tests of `special::student_t`, `propagate::joint` and `propagate::validation`.
const WITHOUT_BUDGET: [&str; 3] = [
    "gum_g2_t_table",
    "s2_coverage_factors",
    "s1_7_9_2_tolerance",
];

/// Regression, analysis of variance, conformity.
const LATER_KINDS: [&str; 6] = [
    "gum5_10_tspm",
    "gum_h5_zener_anova",
    "j106_resistor_global",
    "j106_specific_examples",
    "j106_speed_guard_band",
    "rp19_global_risk",
];

/// The certified data sets of NIST StRD are for regression and analysis of variance.
const LATER_PREFIX: &str = "strd_";

/// Figures that no budget can have, or that other figures of the case contradict: (case, item, why).
const NOT_HELD: &[(&str, &str, &str)] = &[(
    "s1_9_5_gauge_block",
    "nu_eff",
    "16.98 enters t as 16; k is held",
)];

#[test]
fn every_reference_case_is_covered() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/reference/cases");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        eprintln!("skipped: no reference cases at {}", folder.display());
        return;
    };
    let mut ids = BTreeSet::new();
    let mut compared = 0;
    let mut wrong = Vec::new();
    for entry in entries {
        let path = entry.expect("an entry of that folder").path();
        let text = std::fs::read_to_string(&path).expect("a case is text");
        let case: Table = text.parse().expect("a case is TOML");
        let id = case["case"]["id"].as_str().expect("a case has an id");
        ids.insert(id.to_string());
        let budgets = BUDGETS.iter().find(|(covered, _)| *covered == id);
        let later = LATER_KINDS.contains(&id) || id.starts_with(LATER_PREFIX);
        match budgets {
            Some((_, files)) => compared += compare(id, &case, files, &mut wrong),
            None if later || WITHOUT_BUDGET.contains(&id) => {}
            None => wrong.push(format!("{id}: no budget, and not of a later kind")),
        }
    }
    let known = BUDGETS
        .iter()
        .map(|(id, _)| id)
        .chain(&WITHOUT_BUDGET)
        .chain(&LATER_KINDS);
    wrong.extend(
        known
            .filter(|id| !ids.contains(**id))
            .map(|id| format!("{id}: no such case")),
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(compared >= 80, "only {compared} figures compared");
}

#[test]
fn every_budget_of_the_table_exists() {
    for file in BUDGETS.iter().flat_map(|(_, files)| *files) {
        let path = path_of(file);
        assert!(path.is_file(), "{}", path.display());
    }
}

/// Holds the first- and second-order figures of a case that is one budget with one measurand against the
/// evaluation itself, so that a claim copied wrongly does not stay unseen; returns how many.
fn compare(id: &str, case: &Table, files: &[&str], wrong: &mut Vec<String>) -> usize {
    let [file] = files else { return 0 };
    let path = path_of(file);
    let loaded = match budget::load(&path) {
        Ok(loaded) => loaded,
        Err(rejection) => {
            wrong.push(rejection.render(false));
            return 0;
        }
    };
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let found = propagate::evaluate(&loaded.rows[0].budget, &options).expect("a value");
    if found.results.len() != 1 {
        return 0;
    }
    let mut compared = 0;
    for expected in case["expected"].as_array().into_iter().flatten() {
        let item = expected["item"].as_str().unwrap_or_default();
        if NOT_HELD.iter().any(|(c, i, _)| (*c, *i) == (id, item)) {
            continue;
        }
        let (Some(obtained), Some(published), Some(tolerance)) = (
            obtained(&found, expected),
            number(expected, "published"),
            number(expected, "tol"),
        ) else {
            continue;
        };
        compared += 1;
        if (obtained - published).abs() > tolerance * (1.0 + 1e-9) {
            wrong.push(format!(
                "{id} {item}: {obtained} is not {published} ± {tolerance}"
            ));
        }
    }
    compared
}

fn number(expected: &Value, key: &str) -> Option<f64> {
    let value = expected.get(key)?;
    value.as_float().or(value.as_integer().map(|i| i as f64))
}

fn obtained(found: &Evaluation, expected: &Value) -> Option<f64> {
    let result = &found.results[0];
    let second = result.second_order.as_ref();
    let text = |key: &str| {
        expected
            .get(key)
            .and_then(Value::as_str)
            .unwrap_or_default()
    };
    if text("method").starts_with("GUM2") {
        let second = second?;
        return match text("item") {
            "y" => Some(result.gum.estimate + second.shift),
            "u" => Some(second.u),
            _ => None,
        };
    }
    if text("method") != "GUM" {
        return None;
    }
    match text("item") {
        "y" => Some(result.gum.estimate),
        "u" => Some(result.gum.u),
        "k" => Some(result.gum.coverage.k),
        "U" => Some(result.gum.coverage.expanded),
        "nu_eff" => Some(result.gum.freedom.value()),
        _ => None,
    }
}

fn path_of(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("budgets/{file}.toml"))
}
