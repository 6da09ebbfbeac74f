//! Sizes of what was left out: the printed formula is the one that was fitted, and the size has the unit of
//! what it changes divided by that of what it multiplies.

use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::diagnosed_with as diagnosed;

/// What the first size multiplies, its unit and its value.
fn first(found: &Value) -> (&str, &str, f64) {
    let improved = &found["improved"];
    let size = &improved["coefficients"][0];
    let text = improved["additions"][0]["modifier"].as_str();
    let unit = size["unit"].as_str();
    let value = size["value"].as_f64();
    (
        text.expect("a formula"),
        unit.expect("a unit"),
        value.expect("a size"),
    )
}

fn parameter(found: &Value, at: usize) -> f64 {
    found["improved"]["parameters"][at]["value"]
        .as_f64()
        .expect("a parameter")
}

#[test]
fn the_power_of_a_current_is_not_divided_by_its_largest_value() {
    let mut noise = Noise(21);
    let mut rows = "bath [K],I [mA],R [Ω]\n".to_owned();
    for row in 0..36 {
        let (bath, current) = (
            f64::from(row % 6) * 20.0,
            [0.5, 1.0, 2.5][row as usize / 12],
        );
        let resistance = 100.0 + 0.39 * bath + 0.002 * current * current + 5e-4 * noise.normal();
        let _ = writeln!(rows, "{bath},{current},{resistance:.6}");
    }
    let case = "equations = \"R = R0 + k*bath\"\n[columns]\nR = \"output\"\nbath = \"stimulus\"\nI = \"stimulus\"\n[noise]\nu = \"0.0005 Ω\"\n[diagnosis]\ncatalogue = [\"self-heating\"]\n";
    let found = diagnosed("heated", &rows, case);
    let improved = &found["improved"];
    let (text, unit, size) = first(&found);
    assert_eq!(text, "I^2", "{improved}");
    // On the offset in Ω, on the scale as a part of about 120 Ω.
    let expected = match unit {
        "Ω/mA²" => 0.002,
        "1/mA²" => 0.002 / 139.0,
        other => panic!("{other}"),
    };
    assert!((size / expected - 1.0).abs() < 0.3, "{improved}");
}

#[test]
fn a_square_is_about_the_zero_of_the_declared_model() {
    let mut noise = Noise(23);
    let mut rows = "a [gn],U [mV]\n".to_owned();
    for row in 0..40 {
        let a = 1.0 + f64::from(row % 20);
        let output = 2.7 + 131.0 * a + 0.002 * a * a + 2e-3 * noise.normal();
        let _ = writeln!(rows, "{a},{output:.6}");
    }
    for (model, zero, text) in [
        ("U = K0 + K1*a", 0.0, "a^2"),
        ("U = K0 + K1*(a - 5 'gn')", 5.0, "(a - 5 gn)^2"),
    ] {
        let case = format!(
            "equations = \"{model}\"\n[columns]\nU = \"output\"\na = \"stimulus\"\n[noise]\nu = \"0.002 mV\"\n[diagnosis]\ncatalogue = [\"quadratic\"]\n"
        );
        let found = diagnosed("centrifuge", &rows, &case);
        let (found_text, unit, size) = first(&found);
        assert_eq!((found_text, unit), (text, "mV/gn²"), "{found}");
        assert!((size - 0.002).abs() < 1e-4, "{size}");
        let offset = 2.7 + 131.0 * zero + 0.002 * zero * zero;
        assert!((parameter(&found, 0) - offset).abs() < 5e-3, "{found}");
        let slope = 131.0 + 2.0 * 0.002 * zero;
        assert!((parameter(&found, 1) - slope).abs() < 1e-3, "{found}");
    }
}

#[test]
fn a_law_of_time_counts_from_the_first_row_in_the_users_column() {
    let mut noise = Noise(25);
    let mut rows = "age [d],x [V],y [V]\n".to_owned();
    for row in 0..60 {
        let (age, x) = (1.87 + 0.5 * f64::from(row), f64::from(row * 7 % 11));
        let y = 0.1 + 2.0 * x + 0.05 * libm::exp(-(age - 1.87) / 3.0) + 5e-4 * noise.normal();
        let _ = writeln!(rows, "{age},{x},{y:.6}");
    }
    let case = "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nage = \"time\"\n[noise]\nu = \"0.0005 V\"\n[diagnosis]\ncatalogue = [\"warm-up\"]\n";
    let found = diagnosed("warming", &rows, case);
    let (text, unit, _) = first(&found);
    assert!(text.starts_with("exp(-(age - 1.87 d)/("), "{text}");
    assert_eq!(unit, "V");
}

#[test]
fn sizes_are_per_unit_of_what_they_multiply() {
    let mut noise = Noise(27);
    let mut rows = "T [°C],x [V],y [mV]\n".to_owned();
    for row in 0..60 {
        let (t, x) = (
            20.0 + 0.1 * f64::from(row * 13 % 29),
            f64::from(row * 7 % 11),
        );
        let y = 1.0 + 2.0 * x * (1.0 + 0.01 * (t - 20.0)) + 1e-3 * noise.normal();
        let _ = writeln!(rows, "{t},{x},{y:.6}");
    }
    let case = "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nT = \"covariate\"\n[noise]\nu = \"0.001 mV\"\n[diagnosis]\ncatalogue = [\"tempco-scale\", \"tempco-bias\"]\n";
    let found = diagnosed("warm-scale", &rows, case);
    let (text, unit, size) = first(&found);
    assert!(
        text.starts_with("(T - 21.") && text.ends_with(" °C)"),
        "{text}"
    );
    assert_eq!(unit, "1/K");
    assert!((size - 0.01).abs() < 1e-3, "{size}");
    let term = &found["effects"][0]["named"][0]["terms"][0];
    assert_eq!(
        (&term["multiplies"], &term["unit"]),
        (&text.into(), &"1/K".into())
    );
}

/// Where a column is far from zero, as pressures about that of the air are, knees are found all the same, and the
/// formula that is printed has the digits that the fit has.
#[test]
fn a_knee_far_from_zero_is_found_and_written_as_it_was_fitted() {
    let mut noise = Noise(31);
    let mut rows = "p [Pa],U [V]\n".to_owned();
    for row in 0..80 {
        let p = 0.125 * f64::from(row * 7 % 80);
        let bent = 0.05 * (p - 6.2837f64).max(0.0);
        let u = 1.0 + 2.0 * p + bent + 1e-3 * noise.normal();
        let _ = writeln!(rows, "{},{u:.6}", 101_320.0 + p);
    }
    let case = "equations = \"U = a + b*p\"\n[columns]\nU = \"output\"\np = \"stimulus\"\n[noise]\nu = \"0.001 V\"\n";
    let found = diagnosed("barometer", &rows, case);
    let (text, _, size) = first(&found);
    let knee = text
        .strip_prefix("max(p - ")
        .and_then(|rest| rest.strip_suffix(" Pa, 0)"));
    let knee: f64 = knee.and_then(|knee| knee.parse().ok()).expect(text);
    assert!(
        (knee - 101_326.283_7).abs() < 0.02 && (size - 0.05).abs() < 1e-3,
        "{found:#}"
    );
    let model =
        format!("equations = \"U = a + b*(p - 101325 'Pa') + c*max(p - {knee} 'Pa', 0 'Pa')\"\n");
    let again = diagnosed(
        "barometer-written",
        &rows,
        &case.replace("equations = \"U = a + b*p\"\n", &model),
    );
    let misfit = |quality: &Value| quality["chi_squared"].as_f64().expect("a misfit");
    let (written, fitted) = (misfit(&again["before"]), misfit(&found["after"]));
    assert!((written - fitted).abs() < 1e-3, "{written} {fitted}");
}

/// A formula of the user's own whose parts fit together has a unit; one of bare numbers is a number.
#[test]
fn sizes_of_own_formulas_have_the_unit_that_is_left() {
    let mut noise = Noise(33);
    let mut rows = "F [kN],T [°C],U [mV]\n".to_owned();
    for row in 0..60 {
        let (force, t) = (
            f64::from(row % 12) + 1.0,
            20.0 + 0.1 * f64::from(row * 13 % 29),
        );
        let u = 0.1 + 2.0 * force + 0.02 * force * libm::sqrt(force) + 5e-4 * noise.normal();
        let _ = writeln!(rows, "{force},{t},{u:.6}");
    }
    let case = |formula: &str| {
        format!(
            "equations = \"U = a + b*F\"\n[columns]\nU = \"output\"\nF = \"stimulus\"\nT = \"covariate\"\n[noise]\nu = \"0.0005 mV\"\n[diagnosis]\ncatalogue = [\"user\"]\n[omitted.yielding]\nformula = \"{formula}\"\n"
        )
    };
    for (formula, unit) in [
        ("F^1.5", "mV/kN^(3/2)"),
        ("F^1.5*T/T", "mV/kN^(3/2)"),
        ("F^1.5 + 1e-9*T", "mV"),
    ] {
        let found = diagnosed("own-formula", &rows, &case(formula));
        let (text, found_unit, size) = first(&found);
        assert_eq!(
            (text, found_unit),
            (format!("({formula})").as_str(), unit),
            "{found:#}"
        );
        assert!((size - 0.02).abs() < 1e-3, "{found:#}");
    }
}

#[test]
fn formulas_add_where_an_origin_is_below_zero() {
    let mut noise = Noise(35);
    let mut rows = "x [V],y [V]\n".to_owned();
    for row in 0..60 {
        let x = 0.2 * f64::from(row * 7 % 60) - 6.0;
        let bent = 0.05 * (x + 2.137f64).max(0.0);
        let _ = writeln!(
            rows,
            "{x:.1},{:.6}",
            1.0 + 2.0 * x + bent + 5e-4 * noise.normal()
        );
    }
    let case = "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\n[noise]\nu = \"0.5 mV\"\n";
    let found = diagnosed("below-zero", &rows, case);
    let (text, _, _) = first(&found);
    assert!(
        text.starts_with("max(x + 2.1") && text.ends_with(" V, 0)"),
        "{text}"
    );
}

/// A term whose parts fit together is one of quantities: the sine is that of the angle, whatever unit it is recorded in.
#[test]
fn an_own_term_is_one_of_quantities() {
    let mut noise = Noise(35);
    let mut rows = "phi [°],U [mV]\n".to_owned();
    for row in 0..48 {
        let phi = f64::from(row % 24) * 15.0;
        let wave = libm::sin((phi + 30.0).to_radians());
        let _ = writeln!(
            rows,
            "{phi},{:.6}",
            0.1 + 0.02 * wave + 5e-4 * noise.normal()
        );
    }
    let case = "equations = \"U = a\"\n[columns]\nU = \"output\"\nphi = \"covariate\"\n[noise]\nu = \"0.0005 mV\"\n[diagnosis]\ncatalogue = [\"user\"]\n[omitted.wave]\nterm = \"wave * sin(phi + 30 '°')\"\n";
    let found = diagnosed("own-term", &rows, case);
    let (text, unit, size) = first(&found);
    assert_eq!((text, unit), ("(sin(phi + 30 '°'))", "mV"), "{found:#}");
    assert!((size - 0.02).abs() < 1e-3, "{found:#}");
}

/// A usual size is an amount: the same in every unit, that of its own `unit` among them.
#[test]
fn a_usual_size_is_converted() {
    let mut noise = Noise(36);
    let mut rows = "omega [deg/s],U [mV]\n".to_owned();
    for row in 0..20 {
        let omega = f64::from(row % 5) * 50.0 - 100.0;
        let _ = writeln!(
            rows,
            "{omega},{:.6}",
            0.3 + 2.0 * omega + 0.1 * noise.normal()
        );
    }
    let shift = |typical: &str| {
        let case = format!(
            "equations = \"U = K*omega + b\"\n[columns]\nU = \"output\"\nomega = \"stimulus\"\n[omitted.k2]\nterm = \"k2*omega^2\"\n{typical}\n"
        );
        let found = diagnosed("usual-size", &rows, &case);
        let lines = found["omitted"]
            .as_array()
            .expect("effects that may be there");
        let own = lines.iter().find(|line| line["id"] == "user");
        own.expect("the own effect")["usual_shift"]
            .as_f64()
            .expect("a shift")
    };
    // 10⁻⁶ mV/(°/s)² at 100 °/s; a radian is 180/π degrees.
    let in_radians = 1e-6 * (180.0 / std::f64::consts::PI).powi(2);
    for typical in [
        "typical = 1e-6".to_owned(),
        "typical = \"1e-3 µV*s^2/deg^2\"".to_owned(),
        "unit = \"µV*s^2/deg^2\"\ntypical = 1e-3".to_owned(),
        format!("typical = \"{in_radians} mV*s^2/rad^2\""),
    ] {
        let found = shift(&typical);
        assert!((found - 0.01).abs() < 1e-9, "{typical}: {found}");
    }
}
