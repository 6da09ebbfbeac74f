//! JJF 2003-2022, annex A: its five evaluations as published, recomputed, and through the least squares.

use gumption::budget;
use gumption::calibrate::Figures;
use gumption::propagate::{self, MonteCarloChoice, Options};

use super::page::{Page, powers};
use super::{common, contribution, fresh, named, planned};

/// Full scale that is assumed, in °/s; all figures are relative to it.
const FULL_SCALE: f64 = 300.0;
/// Standard uncertainty of one averaged output by repeatability, relative to full scale: u3 of A.1 and A.4.
const REPEATABILITY: f64 = 1.22e-4;

fn hypot(parts: &[f64]) -> f64 {
    parts.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// u of the only measurand of a budget of `budgets/inertial`.
fn as_published(file: &str) -> f64 {
    let path = common::root().join("budgets/inertial").join(file);
    let loaded =
        budget::load(&path).unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let found = propagate::evaluate(&loaded.rows[0].budget, &options).expect("a result");
    found.results[0].gum.u
}

/// Where the rates of a scale-factor calibration lie.
#[derive(Clone, Copy)]
enum Span {
    Both,
    One,
}

/// Equally spaced rates up to `reach` times full scale.
fn rates(count: usize, span: Span, reach: f64) -> String {
    let step = |i: usize| match span {
        Span::Both => 2.0 * i as f64 / (count - 1) as f64 - 1.0,
        Span::One => i as f64 / (count - 1) as f64,
    };
    let rates: Vec<String> = (0..count)
        .map(|i| format!("{}", FULL_SCALE * reach * step(i)))
        .collect();
    rates.join(", ")
}

/// The errors of a reading: repeatability, and quantisation over plus and minus full scale.
fn reading(name: &str, repeatability: f64, bits: u32, full_scale: f64) -> String {
    format!(
        "[reading.{name}]\ncomponents = [{{ name = \"repeatability\", u = {} }}, {{ name = \"quantisation\", bits = {bits}, range = [-{full_scale}, {full_scale}] }}]\n",
        repeatability * full_scale
    )
}

/// 7.2.1 for one gyro.
fn scale_factor(rates: &str, bits: u32) -> Figures {
    let toml = format!(
        "procedure = \"gyro-scale-factor\"\n[schedule]\n\"omega [deg/s]\" = [{rates}]\n[columns.U]\nunit = \"deg/s\"\n\
         [parameter]\nK = {{ start = 1 }}\nb = {{ start = 0 }}\n[input.e_rate]\ncertificate = {{ U = 2e-4, k = 2 }}\n{}",
        reading("U", REPEATABILITY, bits, FULL_SCALE)
    );
    planned(&toml)
        .figures
        .expect("two parameters are determined")
}

/// 7.2.2: the mean outputs of six positions, u of one output as annex A has it.
fn bias(repeatability: f64) -> Figures {
    let mut toml = String::from(
        "procedure = \"gyro-bias\"\n[schedule]\nposition = [\"x up\", \"x down\", \"y up\", \"y down\", \"z up\", \"z down\"]\n\
         [columns]\nUgx = { unit = \"deg/s\" }\nUgy = { unit = \"deg/s\" }\nUgz = { unit = \"deg/s\" }\n",
    );
    for axis in ["x", "y", "z"] {
        toml += &reading(&format!("Ug{axis}"), repeatability, 12, 1.0);
    }
    planned(&toml)
        .figures
        .expect("twelve parameters are determined")
}

/// 7.2.3: eleven rates about each axis.
fn cross_coupling() -> Figures {
    let rates = rates(11, Span::Both, 1.0);
    let axes: Vec<String> = ["x", "y", "z"]
        .iter()
        .flat_map(|axis| std::iter::repeat_n(format!("\"{axis}\""), 11))
        .collect();
    let mut toml = format!(
        "procedure = \"gyro-scale-factor-triad\"\n[schedule]\naxis = [{}]\n\"omega [deg/s]\" = [{rates}, {rates}, {rates}]\n\
         [columns]\nUx = {{ unit = \"deg/s\" }}\nUy = {{ unit = \"deg/s\" }}\nUz = {{ unit = \"deg/s\" }}\n\
         [input.e_rate]\ncertificate = {{ U = 2e-4, k = 2 }}\n\
         [input.f_yx]\ncomponents = [{{ name = \"fixture\", half_width = \"10″\" }}, {{ name = \"axes\", half_width = \"10″\" }}]\n\
         [parameter]\nKxx = {{ start = 1 }}\nKyy = {{ start = 1 }}\nKzz = {{ start = 1 }}\n",
        axes.join(", ")
    );
    for name in ["Kxy", "Kxz", "Kyx", "Kyz", "Kzx", "Kzy"] {
        toml += &format!("{name} = {{ start = 0.001 }}\n");
    }
    for (a, b) in ["x", "y", "z"]
        .iter()
        .flat_map(|a| ["x", "y", "z"].map(|b| (*a, b)))
    {
        toml += &format!("b{a}{b} = {{ start = 0 }}\n");
    }
    for axis in ["x", "y", "z"] {
        toml += &reading(&format!("U{axis}"), REPEATABILITY, 12, FULL_SCALE);
    }
    planned(&toml)
        .figures
        .expect("eighteen parameters are determined")
}

/// 7.2.5 at rest and at one rate (rad/s); u of one output as annex A has it, p taken as 0.01.
fn rate_sensitivity(procedure: &str, omega: f64) -> Figures {
    let mut toml = format!(
        "procedure = \"{procedure}\"\n[schedule]\naxis = [\"x\", \"x\", \"y\", \"y\", \"z\", \"z\"]\n\
         \"omega [rad/s]\" = [0, {omega}, 0, {omega}, 0, {omega}]\n\
         [columns]\nUax = {{ unit = \"m/s^2\" }}\nUay = {{ unit = \"m/s^2\" }}\nUaz = {{ unit = \"m/s^2\" }}\n\
         [input.e_rate]\ncertificate = {{ U = 2e-4, k = 2 }}\n[parameter]\n"
    );
    for name in ["pxy", "pxz", "pyx", "pyz", "pzx", "pzy"] {
        toml += &format!("{name} = {{ start = 0.01 }}\n");
    }
    for (a, b) in ["x", "y", "z"]
        .iter()
        .flat_map(|a| ["x", "y", "z"].map(|b| (*a, b)))
    {
        toml += &format!("o{a}{b} = {{ start = 0 }}\n");
    }
    for axis in ["x", "y", "z"] {
        toml += &reading(&format!("Ua{axis}"), 3.55e-3, 12, 1.0);
    }
    planned(&toml)
        .figures
        .expect("fifteen parameters are determined")
}

#[test]
fn the_report_of_annex_a_is_fresh() {
    let mut page = Page::new("JJF 2003-2022, annex A, three times");
    page.paragraph(
        "Annex A evaluates five results by adding three components: u1 of the turntable (certificate U = 2×10⁻⁴, k = 2), u2 of the data acquisition (half-width 1/2ᴺ, N = 12, uniform), \
         u3 of repeatability. Here each stands as published, as published and recomputed (`gumption eval` on the budgets of [`budgets/inertial`](../budgets/inertial)), and from the measurement \
         equations of chapter 7 through the least squares themselves (`gumption plan`), where every error goes to the coefficient as the equations say. All figures are relative to full scale, or in the unit of the output where annex A states none.",
    );
    summary(&mut page);
    page.section("Assumptions, where the text states none");
    page.list(&[
        format!("Full scale ±{FULL_SCALE} °/s; K = 1 (output in °/s); eleven rates from −full scale to full scale in equal steps. All results are relative to full scale, so its value does not enter; the number and the reach of the rates do, see below."),
        "The table's relative error is the same at all rates (its certificate states one); it acts on rates only, not on positions at rest.".into(),
        "Quantisation: 12 bits over ±full scale, uniform within a step, independent from point to point, not reduced by averaging samples (conservative where noise dithers the steps). That is a half-width of 1/2¹² of full scale as annex A has it.".into(),
        format!("Repeatability: u3 = {REPEATABILITY:e} (A.1, A.4) is taken as that of one averaged output; the row “in full” takes it as that of the coefficient. For A.2 u(Ugx) = 5.01×10⁻⁴ and for A.3 7.095×10⁻³, which the published sums imply; for A.5 3.55×10⁻³ = 5.02×10⁻³/√2."),
        "A.4: k = 0.001; the direction of the axis of rotation against the sensor's axes, 10″ (uniform) from the fixture and 10″ from the table (6.2 and 6.3 of the specification).".into(),
        "A.5: outputs in m/s², p = 0.01, one rate; ω = 1 rad/s in the summary, others below.".into(),
    ]);
    reasons(&mut page);
    dependence(&mut page);
    fresh("jjf-2003-annex-a.md", &page.finish());
}

fn summary(page: &mut Page) {
    let scale = scale_factor(&rates(11, Span::Both, 1.0), 12);
    let bias_figures = bias(5.01e-4);
    let sensitivity = bias(7.095e-3);
    let cross = cross_coupling();
    let squared = rate_sensitivity("accelerometer-rate-sensitivity-squared", 1.0);
    let linear = rate_sensitivity("accelerometer-rate-sensitivity", 1.0);
    let row =
        |clause: &str, result: &str, published: &str, file: &str, figures: &Figures, name: &str| {
            let table = contribution(figures, name, "e_rate");
            let axes = contribution(figures, name, "f_");
            vec![
                clause.to_string(),
                result.to_string(),
                published.to_string(),
                powers(as_published(file), 3),
                powers(named(&figures.coefficients, name).u, 3),
                powers(hypot(&[table, axes]), 2),
                powers(contribution(figures, name, "quantisation"), 2),
                powers(contribution(figures, name, "repeatability"), 2),
            ]
        };
    page.section("Standard uncertainties");
    page.table(
        &[
            "clause",
            "result",
            "published u_c:",
            "recomputed:",
            "through the least squares:",
            "of it table, axes:",
            "quantisation:",
            "repeatability:",
        ],
        &[
            row(
                "A.1",
                "scale factor K",
                "2.12e-4",
                "mimu-gyro-scale-factor.toml",
                &scale,
                "K",
            ),
            row(
                "A.2",
                "bias B",
                "2.68e-4",
                "mimu-gyro-bias.toml",
                &bias_figures,
                "Bgx",
            ),
            row(
                "A.3",
                "sensitivity g_xx",
                "5.02e-3",
                "mimu-gyro-g-sensitivity.toml",
                &sensitivity,
                "Gxx",
            ),
            row(
                "A.4",
                "cross-coupling k_yx",
                "2.12e-4",
                "mimu-gyro-cross-coupling.toml",
                &cross,
                "Kyx",
            ),
            row(
                "A.5",
                "p_yx by (12), ω = 1 rad/s",
                "[lost]",
                "mimu-accelerometer-rate-sensitivity.toml",
                &squared,
                "pyx",
            ),
            row(
                "A.5",
                "p_yx linear, ω = 1 rad/s",
                "[lost]",
                "mimu-accelerometer-rate-sensitivity.toml",
                &linear,
                "pyx",
            ),
        ],
    );
    let in_full = |figures: &Figures, name: &str| {
        let u = named(&figures.coefficients, name).u;
        let own = contribution(figures, name, "repeatability");
        powers(
            hypot(&[(u * u - own * own).max(0.0).sqrt(), REPEATABILITY]),
            3,
        )
    };
    page.paragraph(&format!(
        "With u3 taken in full as the repeatability of the coefficient: A.1 {}, A.4 {}.",
        in_full(&scale, "K"),
        in_full(&cross, "Kyx")
    ));
}

fn reasons(page: &mut Page) {
    let scale = scale_factor(&rates(11, Span::Both, 1.0), 12);
    let each = contribution(&scale, "K", "quantisation");
    let cross = cross_coupling();
    page.section("Reasons for the differences");
    page.list(&[
        format!(
            "A.1: the table's error is common to all rates and goes to K in full ({}), as published. Quantisation and repeatability of single points average in the slope: u(K) = u(U)/√Σ(ω − ω̄)², which is {} instead of 1.41e-4 for quantisation.",
            powers(contribution(&scale, "K", "e_rate"), 2),
            powers(each, 2)
        ),
        "A.2: at rest the table turns at no rate, so that its relative rate error contributes nothing; published is 1.0e-4. Six outputs average: quantisation contributes 1.41e-4/√6, published in full. What does act on the bias at rest is not in annex A: the Earth's rate, whose horizontal component the half turns of annex C cancel.".into(),
        "A.3: half the difference of two outputs, dominated by repeatability; the difference to the published value is in the third digit. But the vertical component of the Earth's rate (15.04 °/h·sin latitude, 2.7×10⁻³ °/s at 40°) is an exact alias of g_xx, g_yy and g_zz in this procedure: for outputs in °/s that is half of the published u_c, common to all three. The procedure `gyro-drift` has it in the model.".into(),
        format!(
            "A.4: the output across the axis is small, and so is what a relative rate error does to it ({}); published is 1.0e-4. Instead the direction of the axis of rotation counts in full ({} for 10″ and 10″), which annex A does not mention.",
            powers(contribution(&cross, "Kyx", "e_rate"), 2),
            powers(contribution(&cross, "Kyx", "f_"), 2)
        ),
        "A.5: (12) divides by ω², model (2) of 5.2 is linear in ω. The unit check tells them apart: by (2) p has the unit output/(rad/s), by (12) output/(rad/s)². What goes with ω² is the centripetal acceleration at the distance of the sensor from the axis (an output in m/s² makes p a length); \
         what goes with ω is a true rate sensitivity, as of a vibrating element. One rate cannot tell them apart, both senses of rotation can: procedure `accelerometer-rate-sensitivity-both`. Published is the sum of components without the factor 1/ω² (or 1/ω), which holds for ω = 1 in the unit used only.".into(),
        "Printed expanded uncertainties are rounded up (4.24 → 4.3, 10.04 → 11); so are those of the budgets with the profile JJF-up.".into(),
    ]);
}

fn dependence(page: &mut Page) {
    page.section("How A.1 depends on rates and bits");
    let mut rows = Vec::new();
    for (span, text) in [(Span::Both, "−1 to 1"), (Span::One, "0 to 1")] {
        for count in [7, 9, 11] {
            for reach in [1.0, 0.5] {
                let rates = rates(count, span, reach);
                let mut row = vec![text.to_string(), count.to_string(), format!("{reach}")];
                for bits in [10, 12, 14, 16] {
                    let figures = scale_factor(&rates, bits);
                    row.push(powers(named(&figures.coefficients, "K").u, 3));
                }
                rows.push(row);
            }
        }
    }
    page.table(
        &[
            "rates / full scale",
            "points:",
            "times:",
            "10 bits:",
            "12 bits:",
            "14 bits:",
            "16 bits:",
        ],
        &rows,
    );
    page.paragraph(
        "u(K) through the least squares. The certificate of the table (1.0e-4) is the floor: neither bits nor points pass it.",
    );
    page.section("How A.5 depends on the rate");
    let rows: Vec<Vec<String>> = [1.0, 2.0, 5.0, 10.0, 20.0]
        .into_iter()
        .map(|omega| {
            let u = |procedure: &str| {
                let figures = rate_sensitivity(procedure, omega);
                powers(named(&figures.coefficients, "pyx").u, 3)
            };
            vec![
                format!("{omega}"),
                u("accelerometer-rate-sensitivity-squared"),
                u("accelerometer-rate-sensitivity"),
            ]
        })
        .collect();
    page.table(
        &[
            "ω / (rad/s):",
            "by (12), per (rad/s)²:",
            "linear, per rad/s:",
        ],
        &rows,
    );
}
