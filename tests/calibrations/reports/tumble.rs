//! Table 1 of the four-point tumble: sixteen runs of two accelerometers.

use super::page::{Page, fixed, powers, statistics};
use super::{calibrated, common, fresh, named};

/// A run of the table.
struct Run {
    unit: String,
    name: String,
    /// Outputs at 0°, 90°, 180° and 270°, in mV.
    outputs: Vec<f64>,
    /// K1 as printed, in mA/gn.
    printed: f64,
    /// K0 in gn, K1 in mA/gn, K2 in 1/gn, δ in rad.
    found: [f64; 4],
}

impl Run {
    /// K1 without the level angle: √[((E90 − E270)/2)² + ((E0 − E180)/2)²]/R.
    fn without_level(&self) -> f64 {
        let e = &self.outputs;
        ((e[1] - e[3]) / 2.0).hypot((e[0] - e[2]) / 2.0) / 500.0
    }

    /// In 10⁻⁶ mA/gn.
    fn difference(&self) -> f64 {
        (self.printed - self.found[1]) * 1e6
    }
}

fn runs() -> Vec<Run> {
    let found = calibrated("tumble-table-1.toml");
    let path = common::root().join("experiments/tumble-table-1.csv");
    let text = std::fs::read_to_string(path).expect("the table");
    let mut runs: Vec<Run> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |place: usize| -> f64 { fields[place].parse().expect("a number") };
        if runs.last().is_none_or(|run| run.name != fields[1]) {
            let (_, part) = found
                .parts
                .iter()
                .find(|(label, _)| label == fields[1])
                .expect("each run is evaluated");
            let value = |name: &str| named(&part.figures.coefficients, name).value;
            runs.push(Run {
                unit: fields[0].to_owned(),
                name: fields[1].to_owned(),
                outputs: Vec::new(),
                printed: number(4),
                found: ["K0", "K1", "K2", "delta_o"].map(value),
            });
        }
        let run = runs.last_mut().expect("just pushed");
        run.outputs.push(number(3));
    }
    runs
}

/// K1 in powers of ten, the others in 10⁻⁶.
fn spread(x: f64, place: usize) -> String {
    if place == 1 {
        powers(x, 2)
    } else {
        fixed(x, 1)
    }
}

fn correlation(pairs: &[(f64, f64)]) -> f64 {
    let n = pairs.len() as f64;
    let (mx, my) = (
        pairs.iter().map(|p| p.0).sum::<f64>() / n,
        pairs.iter().map(|p| p.1).sum::<f64>() / n,
    );
    let sum = |f: fn(f64, f64) -> f64| -> f64 { pairs.iter().map(|p| f(p.0 - mx, p.1 - my)).sum() };
    sum(|x, y| x * y) / (sum(|x, _| x * x) * sum(|_, y| y * y)).sqrt()
}

#[test]
fn the_report_of_table_1_is_fresh() {
    let runs = runs();
    assert_eq!(runs.len(), 16);
    let mut page = Page::new("Four-point tumble: the sixteen runs of Table 1");
    page.paragraph(
        "Metrology and Measurement Technology (China) 38 (2018) no. 2, Table 1: two accelerometers, eight runs each, outputs in mV over R = 500 Ω at 0°, 90°, 180° and 270°. \
         Each run gives four readings for the four coefficients of E = R·K1·(K0 + a_i + K2·a_i² + δ·a_p) with a_i = g sin θ, a_p = −g cos θ and g = 1 gn; \
         `gumption calibrate experiments/tumble-table-1.toml` finds them run by run. The level angle cannot be told from δ: what is called δ is their difference.",
    );
    page.section("Run by run");
    let rows: Vec<Vec<String>> = runs
        .iter()
        .map(|run| {
            vec![
                run.name.clone(),
                fixed(run.found[0] * 1e6, 1),
                fixed(run.found[1], 7),
                fixed(run.found[2] * 1e6, 1),
                fixed(run.found[3] * 1e6, 1),
                fixed(run.without_level(), 7),
                fixed(run.printed, 6),
                fixed(run.difference(), 1),
            ]
        })
        .collect();
    page.table(
        &[
            "run",
            "K0 / µgn:",
            "K1 / (mA/gn):",
            "K2 / (10⁻⁶/gn):",
            "δ / µrad:",
            "K1 without level:",
            "K1 printed:",
            "printed − recomputed / 10⁻⁶:",
        ],
        &rows,
    );
    page.paragraph(
        "“K1 without level” is √[((E90 − E270)/2)² + ((E0 − E180)/2)²]/(g R): the scale factor if what δ shows is the level of the base rather than a misalignment. \
         It is greater than K1 by δ²/2.",
    );
    page.section("Scatter between runs");
    let mut rows = Vec::new();
    for unit in ["001", "002"] {
        let own: Vec<&Run> = runs.iter().filter(|run| run.unit == unit).collect();
        let quantities: [(&str, usize, f64, usize); 4] = [
            ("K0 / µgn", 0, 1e6, 2),
            ("K1 / (mA/gn)", 1, 1.0, 7),
            ("K2 / (10⁻⁶/gn)", 2, 1e6, 2),
            ("δ / µrad", 3, 1e6, 2),
        ];
        for (name, place, scale, decimals) in quantities {
            let values: Vec<f64> = own.iter().map(|run| run.found[place] * scale).collect();
            let (mean, s, range) = statistics(&values);
            rows.push(vec![
                unit.into(),
                name.into(),
                fixed(mean, decimals),
                spread(s, place),
                spread(range, place),
                spread(s / 8_f64.sqrt(), place),
            ]);
        }
        let printed: Vec<f64> = own.iter().map(|run| run.printed).collect();
        let (mean, s, range) = statistics(&printed);
        rows.push(vec![
            unit.into(),
            "K1 as printed".into(),
            fixed(mean, 7),
            powers(s, 2),
            powers(range, 2),
            powers(s / 8_f64.sqrt(), 2),
        ]);
    }
    page.table(
        &[
            "accelerometer",
            "coefficient",
            "mean:",
            "s of a run:",
            "range:",
            "s of the mean:",
        ],
        &rows,
    );
    // What the next section says of the source's own figures.
    for (unit, published_s, published_range) in [("001", 3.0e-6, 1.0e-5), ("002", 4.3e-6, 1.2e-5)] {
        let own = runs.iter().filter(|run| run.unit == unit);
        let (_, s, range) = statistics(&own.map(|run| run.printed).collect::<Vec<_>>());
        let of_all = s * (7.0_f64 / 8.0).sqrt();
        assert!(
            (of_all - published_s).abs() < 5e-8 && (range - published_range).abs() < 1e-9,
            "{s}"
        );
    }
    page.section("Where the printed and the recomputed figures differ");
    page.list(&differences(&runs));
    page.section("The uncertainty of K1");
    page.list(&uncertainty());
    fresh("tumble-table-1.md", &page.finish());
}

fn differences(runs: &[Run]) -> Vec<String> {
    let mut items = Vec::new();
    for unit in ["001", "002"] {
        let own: Vec<&Run> = runs.iter().filter(|run| run.unit == unit).collect();
        let differences: Vec<f64> = own.iter().map(|run| run.difference()).collect();
        let (mean, s, _) = statistics(&differences);
        let least = differences.iter().copied().fold(f64::INFINITY, f64::min);
        let most = differences
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        let pairs: Vec<(f64, f64)> = own.iter().map(|run| (run.found[1], run.printed)).collect();
        let (_, s_found, _) = statistics(&own.iter().map(|run| run.found[1]).collect::<Vec<_>>());
        let (_, s_printed, _) = statistics(&own.iter().map(|run| run.printed).collect::<Vec<_>>());
        items.push(format!(
            "Accelerometer {unit}: printed less recomputed K1 is {mean:.1}×10⁻⁶ mA/gn on the mean (from {least:.1} to {most:.1}, s = {s:.1}); \
             the correlation of both columns is {:.2}; the scatter of a run is {s_found:.1e} mA/gn recomputed, {s_printed:.1e} from the printed column.",
            correlation(&pairs)
        ));
    }
    let rounding = 0.5;
    let far = runs
        .iter()
        .filter(|run| run.difference().abs() > rounding)
        .count();
    items.push(format!(
        "{far} of the 16 printed values differ from the recomputed ones by more than the rounding of the printed digits (0.5×10⁻⁶). \
         A different R or g would multiply all K1 alike; the difference changes its size from run to run, and its sign between runs of 002, so neither explains it."
    ));
    let most = runs
        .iter()
        .map(|run| (run.without_level() - run.found[1]).abs())
        .fold(0.0, f64::max);
    items.push(format!(
        "Nor does the level angle: K1 with and without it differ by at most {most:.1e} mA/gn. \
         K2, K0 and δ do not enter K1 at all at these four angles. The printed K1 must come from other readings than the printed outputs (more digits, another average, or other runs)."
    ));
    items.push(
        "The source prints ranges of 1.0e-5 and 1.2e-5 mA/gn and standard deviations of 3.0e-6 and 4.3e-6 mA/gn. Both follow from its printed K1 column, not from its outputs; the standard deviations with the divisor n = 8, where the table above has n − 1."
            .into(),
    );
    items
}

fn uncertainty() -> Vec<String> {
    let found = calibrated("tumble-four-points.toml");
    let k1 = found
        .figures
        .coefficients
        .iter()
        .position(|c| c.name == "K1")
        .expect("K1");
    let u = found.figures.coefficients[k1].u;
    let parts: Vec<String> = found
        .figures
        .causes
        .iter()
        .map(|cause| (super::title(cause), cause.contribution(k1)))
        .filter(|(_, u)| *u > 1e-10)
        .map(|(name, u)| format!("{name} {u:.1e}"))
        .collect();
    vec![
        format!(
            "From the standard uncertainties that the source states (its section 3), through the least squares: u(K1) = {u:.2e} mA/gn ({}).",
            parts.join(", ")
        ),
        "The source gives u_c(K1) = 2.6e-5 mA/gn. Its formulas are lost; at these angles K1 = (E90 − E270)/(2 g R) depends on no angle to first order, and two voltmeter readings and the resistor alone make it up.".into(),
        "The error of the resistor is the same in all runs: it does not show in the scatter between runs, and no number of runs makes it smaller.".into(),
    ]
}
