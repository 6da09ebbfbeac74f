//! Numbers that convert what units convert already, and revolutions that would be counted as radians.

use super::*;

/// A model as its inputs, its text and the unit of the measurand.
type Case = (&'static str, &'static str, &'static str);

/// The code and the mend of the first fault.
fn refused((inputs, text, wanted): Case) -> Option<(&'static str, String)> {
    let faults = try_model(inputs, text, wanted).err()?;
    let fault = &faults[0].fault;
    let help = fault.help.clone().unwrap_or_default();
    Some((fault.code.id, help.to_string()))
}

fn all_refused(code: &str, cases: &[(Case, &str)]) {
    for (case, mend) in cases {
        let (found, help) = refused(*case).unwrap_or_else(|| panic!("{case:?} is accepted"));
        assert!(
            found == code && help.contains(mend),
            "{case:?}: {found} {help}"
        );
    }
}

fn none_refused(cases: &[Case]) {
    for case in cases {
        assert_eq!(refused(*case), None, "{case:?}");
    }
}

#[test]
fn counts_and_angles_are_not_mixed_in_silence() {
    all_refused(
        "M0409",
        &[
            (("N t:min", "N / t", "r/min"), "`N / t * (1 'r')`"),
            (("T:ms", "1 / T", "r/min"), "1 / T * (1 'r')"),
            (("T:s", "1 / T", "r/min"), "1 / T * (1 'r')"),
            (("n:1/min", "n", "r/min"), "n * (1 'r')"),
            (("n:1/min", "n", "rad/s"), "n * (1 'r')"),
            (("w:rad/s", "w", "Hz"), "w / (1 'r')"),
            (("f:Hz", "f", "rad/s"), "f * (1 'r')"),
            (("f:Hz w:rad/s", "w - f", "rad/s"), "f * (1 'r')"),
            (("f:Hz p", "g = f / p; g", "r/min"), "g * (1 'r')"),
            (("Q:L/min n:r/min", "Q / n", "mL"), "Q / n * (1 'r')"),
        ],
    );
    none_refused(&[
        ("N t:min", "N / t * (1 'r')", "r/min"),
        ("T:ms", "1 / T * (1 'r')", "r/min"),
        ("w:rad/s", "w / (1 'r')", "Hz"),
        ("w:rad/s", "w / (2 * pi)", "Hz"),
        ("w:rad/s", "w", "1/s"),
        ("f:Hz", "f * (1 'r')", "rad/s"),
        ("f:Hz", "2 * pi * f", "rad/s"),
        ("f:Hz", "6.2832 * f", "rad/s"),
        ("f:Hz", "w = 2 * pi * f; w", "rad/s"),
        ("f:Hz w:rad/s", "w - 2 * pi * f", "rad/s"),
        ("T:s", "2 * pi / T", "r/min"),
        ("n:r/min", "n / (2 * pi)", "Hz"),
        ("v:m/s R:m", "v / R", "r/min"),
        ("v:m/min R:m", "v / R", "rad/s"),
        ("R:ohm C:F", "1 / (R * C)", "rad/s"),
        ("k:N/m m:kg", "sqrt(k / m)", "r/min"),
        ("y x t:s", "atan2(y, x) / t", "°/s"),
        ("phi:rad t:s", "phi / t", "r/min"),
        ("Q:L/min n:r/min", "Q / n", "mL/r"),
        ("Q:L/min n:r/min", "Q / n * (1 'r')", "mL"),
        ("n:r/min", "n", "rad/s"),
        ("n:r/min R:m", "n * R", "m/s"),
    ]);
}

#[test]
fn the_turn_of_a_revolution_is_not_taken_twice() {
    all_refused(
        "M0409",
        &[
            (
                ("n:r/min M:N*m", "2 * pi * n * M", "W"),
                "`(n / (1 'r'))` in place of `n`",
            ),
            (("n:rpm M:N*m", "6.2832 * n * M", "W"), "(n / (1 'r'))"),
            (("n:r/min", "2 * pi * n", "rad/s"), "(n / (1 'r'))"),
            (("n:r/min", "pi * n / 30", "rad/s"), "(n / (1 'r'))"),
            (("n:r/min d:mm", "pi * d * n", "m/min"), "(n / (1 'r'))"),
            (
                ("n:r/min d:mm", "pi * d * n / 1000", "m/min"),
                "(n / (1 'r'))",
            ),
            (("n:r/min P:W", "P / (2 * pi * n)", "N*m"), "(n / (1 'r'))"),
            (("n:r/min P:W", "P / 2 / pi / n", "N*m"), "(n / (1 'r'))"),
            (
                ("n:r/min r:m", "(2 * pi * n)^2 * r", "m/s^2"),
                "(n / (1 'r'))",
            ),
            (
                ("n:r/min F:N l:m", "2 * pi * n * F * l", "W"),
                "(n / (1 'r'))",
            ),
            (
                ("n:r/min V:mL", "n * V", "L/min"),
                "`(n / (1 'r'))` in place of `n` if `V`",
            ),
            (("n:r/min V:mL e", "n * V * e", "L/min"), "(n / (1 'r'))"),
            (("n:r/min V:mL p:bar", "p * V * n", "W"), "(V / (1 'rad'))"),
            (("n:r/min m:g", "n * m", "kg/h"), "(n / (1 'r'))"),
        ],
    );
    none_refused(&[
        ("n:r/min M:N*m", "n * M", "W"),
        ("n:r/min M:N*m", "2 * pi * (n / (1 'r')) * M", "W"),
        ("n:r/min M:N*m", "2 * pi * n / (1 'r') * M", "W"),
        ("n:1/min M:N*m", "2 * pi * n * M", "W"),
        ("w:rad/s M:N*m", "2 * pi * w * M", "W"),
        ("n:r/min d:m", "n * d / 2", "m/s"),
        ("n:r/min J:kg*m^2", "J * n^2 / 2", "J"),
        (
            "n:r/min d:m L:m rho:kg/m^3",
            "pi / 64 * rho * L * d^4 * n^2",
            "J",
        ),
        (
            "n:r/min M:N*m h:m r:m R:m",
            "M / (4 * pi * h * n) * (1 / r^2 - 1 / R^2)",
            "Pa*s",
        ),
        (
            "n:r/min M:N*m h:m R:m",
            "2 * M * h / (pi * R^4 * n)",
            "Pa*s",
        ),
        ("n:r/min V:mL/r", "n * V", "L/min"),
        ("n:r/min V:mL", "(n / (1 'r')) * V", "L/min"),
        ("n:r/min V:mL", "n * (V / (1 'rad'))", "L/min"),
        ("n:r/min A:m^2 r:m", "A * n * r", "m^3/s"),
        ("n:r/min rho:kg/m^3 A:m^2 r:m", "rho * A * n * r", "kg/s"),
        ("n:r/min m:kg r:m", "m * r * n^2", "N"),
        ("phi:° R:m", "R * phi", "m"),
    ]);
}

#[test]
fn numbers_that_convert_are_found_in_terms_and_factors() {
    all_refused(
        "M0410",
        &[
            (
                ("L:mm d:µm", "L + d / 1000", "mm"),
                "leave 0.001 out of `d / 1000`",
            ),
            (("L:mm d:µm", "d / 1000 + L", "mm"), "leave 0.001 out"),
            (("L:mm d:µm", "L - d * 1e-3 - L", "mm"), "leave 0.001 out"),
            (
                ("x:V p:%", "x * (1 - p / 100)", "V"),
                "leave 0.01 out of `p / 100`",
            ),
            (
                ("R:ohm a:ppm/K t:K", "R * (1 + a * 1e-6 * t)", "ohm"),
                "leave 0.000001 out",
            ),
            (("x:V p:%", "c = 1 + p / 100; x * c", "V"), "leave 0.01 out"),
            (("h:%RH e:hPa", "h / 100 * e", "Pa"), "leave 0.01 out"),
            (("h:%RH e:hPa", "e * 100 / h", "Pa"), "leave 100 out"),
            (("I:mA R:kohm", "I / 1000 * R", "V"), "leave 0.001 out"),
            (("m:psi", "m * 6.895", "kPa"), "leave 6.895 out"),
            (("m:kgf", "m * 9.81", "N"), "leave 9.81 out"),
            (("m:lb", "0.4536 * m", "kg"), "leave 0.4536 out"),
            (("p:mmHg", "133.322 * p", "Pa"), "leave 133.322 out"),
            (("a", "57.2958 * a", "°"), "leave 57.2958 out"),
            (("a", "a * 206265", "\""), "leave 206265 out"),
            (
                ("n:r/min M:N*m", "M * n / 9550", "kW"),
                "out of `M * n / 9550`",
            ),
            (
                ("R:m a:°", "R * a * pi / 180", "mm"),
                "out of `R * a * pi / 180`",
            ),
        ],
    );
    none_refused(&[
        ("L:mm d:µm", "L + d", "mm"),
        ("L:mm d:µm", "L + d / 10", "mm"),
        ("L:mm d:µm k", "L + d / k", "mm"),
        ("L:mm d:µm", "L + d / (1000 '1')", "mm"),
        ("L:mm d:mm", "L + d / 1000", "mm"),
        ("x:V p:%", "x * (1 - p)", "V"),
        ("x:V p", "x * (1 - p / 100)", "V"),
        ("p:hPa q:hPa", "100 * p / q", ""),
        ("m:kg", "m * 9.8 'm/s^2'", "N"),
        ("m:kg", "m * 9.81 'm/s^2'", "N"),
        ("a:mm b:mm", "(a + b) / 2", "m"),
        ("m:psi", "m * 6.9", "psi"),
        ("m:psi", "m * 2.54", "kPa"),
    ]);
}
