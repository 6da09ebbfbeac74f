//! The published examples that the program carries with it: every file below `budgets/` but the index.
//!
//! Generated: `GUMPTION_UPDATE=1 cargo test --test verify` renews the list, and without it that test tells when
//! the list is out of date.

macro_rules! library {
    ($($name:literal,)*) => {
        &[$(($name, include_bytes!(concat!("../../budgets/", $name)))),*]
    };
}

/// Path below `budgets/`, and content.
pub const LIBRARY: &[(&str, &[u8])] = library![
    "chemistry/cadmium-standard-quam-a1.toml",
    "chemistry/glucose-molecular-mass-gum5-3.toml",
    "chemistry/lead-molar-mass-kessel.toml",
    "chemistry/ph-interpolation-gum5-1.toml",
    "chemistry/sodium-hydroxide-quam-a2.toml",
    "electrical/attenuator-30db-ea402-s7.toml",
    "electrical/dmm-100v-ea402-s9.toml",
    "electrical/impedance-correlation-ignored.toml",
    "electrical/impedance-gum-h2.toml",
    "electrical/impedance-rounded-inputs.toml",
    "electrical/resistance-from-limits.toml",
    "electrical/resistors-in-series-gum-5-2-2.toml",
    "electrical/resistors-in-series-matrix.toml",
    "electrical/voltmeter-gum-5-1-5.toml",
    "force/rockwell-hardness-gum-h6.toml",
    "force/wire-rope-gum5-15.toml",
    "inertial/four-point-tumble-runs.toml",
    "inertial/four-point-tumble.toml",
    "inertial/mimu-accelerometer-rate-sensitivity.toml",
    "inertial/mimu-gyro-bias.toml",
    "inertial/mimu-gyro-cross-coupling.toml",
    "inertial/mimu-gyro-g-sensitivity.toml",
    "inertial/mimu-gyro-scale-factor-from-model.toml",
    "inertial/mimu-gyro-scale-factor.toml",
    "length/end-gauge-difference-gum-h1-3-2.toml",
    "length/end-gauge-gum-h1.toml",
    "length/end-gauge-nine-inputs.toml",
    "length/gauge-block-50mm-ea402-s4.toml",
    "length/gauge-block-gum-s1-9-5.toml",
    "mass/weight-100g-gum-s1-9-3.toml",
    "mass/weight-10kg-ea402-s2.toml",
    "mass/weight-10kg-kessel.toml",
    "radiation/alpha-activity-iso11929-1a.toml",
    "radiation/film-thickness-xrf.toml",
    "radiation/net-count-iso11929-4-6.toml",
    "radiation/radon-gum-h4-ratios.toml",
    "radiation/radon-gum-h4.toml",
    "statistics/comparison-loss-gum-s1-9-4-x000-r00.toml",
    "statistics/comparison-loss-gum-s1-9-4-x000-r09.toml",
    "statistics/comparison-loss-gum-s1-9-4-x010-r00.toml",
    "statistics/comparison-loss-gum-s1-9-4-x050-r09.toml",
    "statistics/complex-difference-willink-hall.toml",
    "statistics/distributions-gum-s1-6-4.toml",
    "statistics/line-value-willink-2008.toml",
    "statistics/polar-gum-s2-9-3-x001-r00.toml",
    "statistics/polar-gum-s2-9-3-x001-r09.toml",
    "statistics/polar-gum-s2-9-3-x010-r09.toml",
    "statistics/polar-gum-s2-9-3-x100-r00.toml",
    "statistics/product-gum-g4.toml",
    "statistics/second-order-bias-amd1.toml",
    "statistics/sum-of-normals-gum-s1-9-2-2.toml",
    "statistics/sum-of-rectangles-gum-s1-9-2-3.toml",
    "statistics/sum-of-unequal-rectangles-gum-s1-9-2-4.toml",
    "statistics/two-outputs-gum-s2-9-2.toml",
    "statistics/type-b-conversions-gum-4-3.toml",
    "temperature/furnace-ea402-s5.toml",
    "temperature/radiation-constant.toml",
    "temperature/surface-temperature-tn1900-e2.toml",
    "temperature/thermal-expansion-tn1900-e13.toml",
    "temperature/thermocouple-emf-ea402-s5.toml",
];
