//! Every published case is a budget of the library. The cases lie beside the project where it is developed; elsewhere
//! this test has nothing to read and says so.

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
    (
        "gum5_10_tspm",
        &["conformity/suspended-particulate-gum5-10"],
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
    ("gum_g2_t_table", &["statistics/t-quantiles-gum-table-g2"]),
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
        "gum_h3_systematic",
        &["temperature/thermometer-systematic-gum-h3"],
    ),
    (
        "gum_h3_thermometer",
        &["temperature/thermometer-calibration-gum-h3"],
    ),
    (
        "gum_h4_radon",
        &["radiation/radon-gum-h4", "radiation/radon-gum-h4-ratios"],
    ),
    (
        "gum_h5_zener_anova",
        &["electrical/zener-gum-h5", "electrical/zener-gum-h5-pooled"],
    ),
    ("gum_h6_hardness", &["force/rockwell-hardness-gum-h6"]),
    (
        "iso11929_2010_ex1a",
        &["radiation/alpha-activity-iso11929-1a"],
    ),
    ("iso11929_4_ex6", &["radiation/net-count-iso11929-4-6"]),
    (
        "iso28037_gdr1",
        &["calibration-lines/both-uncertain-iso28037-7"],
    ),
    (
        "iso28037_wls1",
        &["calibration-lines/equal-weights-iso28037-6"],
    ),
    (
        "j106_resistor_global",
        &["conformity/resistor-global-risk-jcgm106"],
    ),
    (
        "j106_specific_examples",
        &["conformity/specific-examples-jcgm106"],
    ),
    (
        "j106_speed_guard_band",
        &["conformity/speed-guard-band-jcgm106"],
    ),
    ("kessel2006_1_mass", &["mass/weight-10kg-kessel"]),
    ("kessel2006_2b_lead", &["chemistry/lead-molar-mass-kessel"]),
    (
        "natrella_young_modulus",
        &["calibration-lines/young-modulus-natrella"],
    ),
    ("num_stefan_boltzmann", &["temperature/radiation-constant"]),
    ("pearson_york_wtls", &["calibration-lines/pearson-york"]),
    ("quam_a1_cadmium", &["chemistry/cadmium-standard-quam-a1"]),
    ("quam_a2_naoh", &["chemistry/sodium-hydroxide-quam-a2"]),
    ("rp19_global_risk", &["conformity/global-risk-rp19"]),
    (
        "s1_6_4_pdf_moments",
        &["statistics/distributions-gum-s1-6-4"],
    ),
    (
        "s1_7_9_2_tolerance",
        &["statistics/numerical-tolerance-gum-s1-7-9-2"],
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
    (
        "s2_coverage_factors",
        &[
            "statistics/coverage-factor-1-measurand-gum-s2-6-5",
            "statistics/coverage-factor-2-measurands-gum-s2-6-5",
            "statistics/coverage-factor-3-measurands-gum-s2-6-5",
            "statistics/coverage-factor-4-measurands-gum-s2-6-5",
            "statistics/coverage-factor-5-measurands-gum-s2-6-5",
        ],
    ),
    ("strd_anova_atmwtag", &["statistics/strd-atmwtag"]),
    ("strd_anova_sirstv", &["statistics/strd-sirstv"]),
    ("strd_anova_smls01", &["statistics/strd-smls01"]),
    ("strd_anova_smls02", &["statistics/strd-smls02"]),
    ("strd_anova_smls03", &["statistics/strd-smls03"]),
    ("strd_anova_smls04", &["statistics/strd-smls04"]),
    ("strd_anova_smls05", &["statistics/strd-smls05"]),
    ("strd_anova_smls07", &["statistics/strd-smls07"]),
    ("strd_anova_smls08", &["statistics/strd-smls08"]),
    ("strd_lin_filip", &["fits/polynomial-degree-10-strd-filip"]),
    ("strd_lin_noint1", &["fits/line-through-origin-strd-noint1"]),
    (
        "strd_lin_noint2",
        &["fits/line-through-origin-three-points-strd-noint2"],
    ),
    ("strd_lin_norris", &["fits/line-ozone-monitors-strd-norris"]),
    (
        "strd_lin_pontius",
        &["fits/parabola-load-cell-strd-pontius"],
    ),
    (
        "strd_lin_wampler1",
        &["fits/polynomial-exact-strd-wampler1"],
    ),
    (
        "strd_lin_wampler2",
        &["fits/polynomial-exact-strd-wampler2"],
    ),
    (
        "strd_lin_wampler3",
        &["fits/polynomial-small-scatter-strd-wampler3"],
    ),
    (
        "strd_lin_wampler4",
        &["fits/polynomial-large-scatter-strd-wampler4"],
    ),
    (
        "strd_nls_chwirut1",
        &["fits/ultrasonic-calibration-strd-chwirut1"],
    ),
    (
        "strd_nls_chwirut2",
        &["fits/ultrasonic-calibration-strd-chwirut2"],
    ),
    ("strd_nls_danwood", &["fits/power-law-lamp-strd-danwood"]),
    ("strd_nls_enso", &["fits/periods-air-pressure-strd-enso"]),
    ("strd_nls_gauss1", &["fits/two-peaks-strd-gauss1"]),
    ("strd_nls_kirby2", &["fits/rational-line-width-strd-kirby2"]),
    (
        "strd_nls_lanczos3",
        &["fits/three-exponentials-strd-lanczos3"],
    ),
    (
        "strd_nls_mgh09",
        &["fits/rational-reaction-rate-strd-mgh09"],
    ),
    ("strd_nls_mgh17", &["fits/two-exponentials-strd-mgh17"]),
    (
        "strd_nls_misra1a",
        &["fits/saturation-adsorption-strd-misra1a"],
    ),
    (
        "strd_nls_misra1b",
        &["fits/saturation-adsorption-strd-misra1b"],
    ),
    ("strd_nls_rat42", &["fits/logistic-growth-strd-rat42"]),
    (
        "strd_nls_roszman1",
        &["fits/arctangent-iodine-strd-roszman1"],
    ),
    ("strd_uni_lew", &["statistics/strd-lew"]),
    ("strd_uni_lottery", &["statistics/strd-lottery"]),
    ("strd_uni_mavro", &["statistics/strd-mavro"]),
    ("strd_uni_michelso", &["statistics/strd-michelso"]),
    ("strd_uni_numacc1", &["statistics/strd-numacc1"]),
    ("strd_uni_numacc2", &["statistics/strd-numacc2"]),
    ("strd_uni_numacc3", &["statistics/strd-numacc3"]),
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
        match budgets {
            Some((_, files)) => compared += compare(id, &case, files, &mut wrong),
            None => wrong.push(format!("{id}: no budget")),
        }
    }
    wrong.extend(
        BUDGETS
            .iter()
            .filter(|(id, _)| !ids.contains(*id))
            .map(|(id, _)| format!("{id}: no such case")),
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(compared >= 80, "only {compared} figures compared");
}

/// Published figures that their budgets do not claim: (case, item, why).
const NOT_CLAIMED: &[(&str, &str, &str)] = &[
    (
        "ea402_s2_mass",
        "u",
        "of a file of another program; EA-4/02 is held",
    ),
    (
        "ea402_s4_gauge_block",
        "u:dadT",
        "a product of two inputs of the budget",
    ),
    (
        "ea402_s5_1_furnace",
        "u",
        "of a file of another program; EA-4/02 is held",
    ),
    ("gum_4_3_type_b", "u uV", "an intermediate result: a/√3"),
    (
        "gum_4_3_type_b",
        "factor 1.48",
        "an intermediate result: the u that it gives is held",
    ),
    ("gum_5_1_5_dmm", "u_rel", "u is held"),
    ("gum_5_1_5_dmm", "u2", "u is held"),
    (
        "gum_5_2_2_ten_resistors",
        "u_if_uncorrelated",
        "what the example warns of",
    ),
    (
        "gum_h2_impedance",
        "r",
        "correlation of inputs; those of the measurands are held",
    ),
    (
        "gum_h4_radon",
        "r",
        "correlation of inputs; the result is held",
    ),
    (
        "s1_9_5_gauge_block",
        "nu_eff",
        "16.98 enters t as 16; k is held",
    ),
    (
        "tn1900_e2_surface_temperature",
        "s",
        "an intermediate result: u = s/√n is held",
    ),
    ("willink_hall_ex1_complex", "cov", "the correlation is held"),
    ("j106_speed_guard_band", "z", "an intermediate result"),
];

/// Every published number is claimed by a budget of its case, be it in another decimal multiple of the unit, as a
/// standard deviation in place of a variance, or with fewer digits than a case computed here states.
#[test]
fn every_published_figure_is_claimed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/reference/cases");
    if !folder.is_dir() {
        eprintln!("skipped: no reference cases at {}", folder.display());
        return;
    }
    let mut missing = Vec::new();
    for (id, files) in BUDGETS {
        let text = std::fs::read_to_string(folder.join(format!("{id}.toml"))).expect("a case");
        let case: Table = text.parse().expect("a case is TOML");
        let claimed: Vec<f64> = files.iter().flat_map(|file| claimed(file)).collect();
        for expected in case["expected"].as_array().into_iter().flatten() {
            let item = expected["item"].as_str().unwrap_or_default();
            let excused = NOT_CLAIMED.iter().any(|(c, i, _)| (*c, *i) == (*id, item));
            let Some(published) = number(expected, "published") else {
                continue;
            };
            if !excused && !claimed.iter().any(|claim| is_claim_of(*claim, published)) {
                missing.push(format!("{id} {item}: {published}"));
            }
        }
    }
    assert!(
        missing.is_empty(),
        "not claimed:\n  {}",
        missing.join("\n  ")
    );
}

/// Every figure that a budget claims, in all of its rows.
fn claimed(file: &str) -> Vec<f64> {
    let loaded = budget::load(&path_of(file))
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let claims = loaded.rows.iter().flat_map(|row| &row.budget.claims);
    claims
        .flat_map(|claim| claim.figures.iter().map(|figure| figure.value))
        .collect()
}

fn is_claim_of(claim: f64, published: f64) -> bool {
    if published == 0.0 || claim == 0.0 {
        return published == claim;
    }
    [claim, claim * claim].into_iter().any(|claim| {
        let decades = (claim / published).log10();
        (decades - decades.round()).abs() < 1e-5
    })
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
