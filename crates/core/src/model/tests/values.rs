//! Values, units, printed form, hints.

use super::*;
use crate::model::Notice;
use crate::model::catalogue::{find, functions};
use crate::model::operation::{BINARY, UNARY};
use std::f64::consts::PI;

#[test]
fn arithmetic_follows_the_usual_precedence() {
    for (text, expected) in [
        ("1 + 2 * 3", 7.0),
        ("-2^2", -4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("(2^3)^2", 64.0),
        ("8 / 2 / 2", 2.0),
        ("7 - 2 - 1", 4.0),
        ("-3 * -2", 6.0),
        ("2 * -3^2", -18.0),
        ("1 - -1", 2.0),
        ("if(1 < 2 and not 2 < 1, 5, 6)", 5.0),
        ("if 1 > 2 or 3 >= 3 then 5 else 6", 5.0),
        ("if (1 > 2) or (2 > 3) then 5 else 6", 6.0),
        ("a = 2 ; b = a² × 3 − 1 \n b", 11.0),
        ("f(x, y) = x - y # difference\nf(5, 2)", 3.0),
        ("max(1, 4, 2) + min([3, 2])", 6.0),
        ("len([1, 2, 3]) * pi / π", 3.0),
        ("(1 +\n 2) *\n 3", 9.0),
        ("quantize(0.37, 0.1)", 0.4),
        ("median([5, 1, 4, 2, 3]) + median([4, 1, 3, 2])", 5.5),
        ("sd([2, 4, 4, 4, 5, 5, 7, 9])^2 * 7", 32.0),
        ("slope([1, 2, 3], [2, 4, 7]) * 2", 5.0),
        ("intercept([1, 2, 3], [2, 4, 6])", 0.0),
        ("slope_through_origin([1, 2], [2, 4])", 2.0),
        ("dot([1, 2], [3, 4]) + prod([2, 3]) + norm([3, 4])", 22.0),
        ("sum([1, 2] * 3 + [1, 1])", 11.0),
        ("[7, 8, 9][2]", 8.0),
        ("mean(1, 2, 6)", 3.0),
        ("1e-3 * 1_000", 1.0),
        ("pow(2, 10)", 1024.0),
    ] {
        close(value("", text, "", &[]), expected, 1e-14, text);
    }
}

#[test]
fn units_are_converted_where_they_meet() {
    for (inputs, text, wanted, x, expected) in [
        ("a:mm b:m", "a + b", "mm", vec![1.0, 2.0], 2001.0),
        ("a:mm b:m", "a * b", "mm^2", vec![3.0, 2.0], 6000.0),
        ("a:mm", "a + 25 'µm'", "mm", vec![1.0], 1.025),
        ("x:%", "1 + x", "", vec![5.0], 1.05),
        ("x:%", "x + 1", "%", vec![5.0], 105.0),
        ("x:ppm y:%", "x + y", "ppm", vec![5.0, 1.0], 10005.0),
        ("phi:°", "sin(phi)", "", vec![30.0], 0.5),
        ("y:mm x:m", "atan2(y, x)", "°", vec![1000.0, 1.0], 45.0),
        ("a:mm", "max(a, 0)", "mm", vec![-1.0], 0.0),
        ("a:mm b:cm", "if(a > b, a, b)", "mm", vec![11.0, 1.0], 11.0),
        ("a:mm^2", "sqrt(a)", "m", vec![4.0], 0.002),
        ("a:m", "a^1.5", "m^1.5", vec![4.0], 8.0),
        ("T:°C", "T - 20 '°C'", "K", vec![23.0], 3.0),
        ("T:°C", "T - -5 '°C'", "K", vec![23.0], 28.0),
        (
            "T:°C",
            "kelvin(-40 '°C') + (T - 0 '°C')",
            "K",
            vec![1.0],
            234.15,
        ),
        (
            "T:°C",
            "solve(x == T - 60 'K', x, -50 '°C')",
            "°C",
            vec![1.0],
            -59.0,
        ),
        (
            "T:°C",
            "if(T < -5 '°F', T, -(6 '°C'))",
            "°C",
            vec![1.0],
            -6.0,
        ),
        ("T:°C d:mK", "T + d", "°C", vec![20.0, 500.0], 20.5),
        ("T:°C d:K", "d + T", "°C", vec![20.0, 0.5], 20.5),
        ("T:°C", "kelvin(T)", "K", vec![20.0], 293.15),
        ("T:°C F:°F", "T - F", "K", vec![20.0, 50.0], 10.0),
        ("T[2]:°C", "mean(T)", "°C", vec![20.0, 21.0], 20.5),
        ("T[2]:°C", "sd(T) * sqrt(2)", "K", vec![20.0, 22.0], 2.0),
        ("a:mm", "value_in(a, 'µm') + 1", "", vec![2.0], 2001.0),
        (
            "t[3]:°C L[3]:µm",
            "slope(t, L)",
            "µm/K",
            vec![20.0, 21.0, 22.0, 1.0, 3.0, 5.0],
            2.0,
        ),
        ("a:%", "exp(a)", "", vec![100.0], std::f64::consts::E),
        ("I:mA R:kohm", "I * R", "V", vec![2.0, 3.0], 6.0),
        ("a:mm", "floor(value_in(a, 'cm'))", "", vec![25.0], 2.0),
        ("a:mm", "quantize(a, 1 'cm')", "mm", vec![27.0], 30.0),
        ("a:mm", "2 * [a, 1 'cm', 0][2]", "mm", vec![1.0], 20.0),
    ] {
        close(value(inputs, text, wanted, &x), expected, 1e-12, text);
    }
}

#[test]
fn implicit_equations_have_their_known_roots() {
    // d exp(d/h) = a: d = h W(a/h), and W(1) is the omega constant.
    let d = value(
        "a:mm h:mm",
        "d = solve(d * exp(d / h) == a, d, 1 'mm') ; d",
        "mm",
        &[2.0, 2.0],
    );
    close(d, 2.0 * 0.567_143_290_409_783_8, 1e-15, "Lambert W");
    // Kepler's equation, far start.
    let e = value("M", "solve(E - 0.9 * sin(E) == M, E, 3)", "", &[0.1]);
    close(e - 0.9 * e.sin(), 0.1, 1e-14, "Kepler");
    // Cardano: x³ + 3x - 4 = 0 has x = 1.
    close(
        value("a", "solve(x^3 + 3*x - a, x, 10)", "", &[4.0]),
        1.0,
        1e-15,
        "Cardano",
    );
    // A root at exactly zero, and none at all.
    assert_eq!(value("a", "solve(x^3 + x == a, x, 1)", "", &[0.0]), 0.0);
    assert!(value("a", "solve(x^2 + a == 0, x, 1)", "", &[1.0]).is_nan());
    // One equation inside another.
    let nested = value(
        "a",
        "solve(solve(z^3 == y, z, 1) + y == a, y, 4)",
        "",
        &[10.0],
    );
    close(nested, 8.0, 1e-14, "nested");
}

#[test]
fn blocks_agree_with_scalars_for_every_operation() {
    let points: Vec<(f64, f64)> = (0..LANES)
        .map(|i| (0.013 + i as f64 / 260.0, 1.9 - i as f64 / 160.0))
        .collect();
    let check = |text: &str| {
        let model = model("x y", text, "");
        let inputs = [
            Block(std::array::from_fn(|i| points[i].0)),
            Block(std::array::from_fn(|i| points[i].1)),
        ];
        let mut out = [Block::ZERO];
        BlockRunner::new(&model).run(&inputs, &mut out);
        for (lane, (x, y)) in points.iter().enumerate() {
            let scalar = model.values(&[*x, *y])[0];
            close(
                out[0].0[lane],
                scalar,
                1e-14,
                &format!("{text} at {x}, {y}"),
            );
        }
    };
    for row in UNARY.iter().filter(|row| find(row.name).is_some()) {
        let shift = if row.name == "acosh" { "1 + x" } else { "x" };
        check(&format!("{}({shift})", row.name));
    }
    for row in BINARY {
        let name = row.name;
        if find(name).is_some() {
            check(&format!("{name}(x, y)"));
            check(&format!("{name}(x, 0.3)"));
            check(&format!("{name}(0.3, x)"));
        } else if row.rule == crate::model::operation::Rule::Constant {
            let (a, b) = if matches!(name, "and" | "or") {
                ("x > 0.5", "y > 0.5")
            } else {
                ("x", "y")
            };
            check(&format!("if({a} {name} {b}, 1, x)"));
        } else {
            check(&format!("x {name} y"));
            check(&format!("x {name} 0.3"));
            check(&format!("0.3 {name} x"));
        }
    }
    for text in [
        "-x",
        "if(not x > 0.5, x, y)",
        "x^2",
        "x^5",
        "x^-3",
        "x^0.3",
        "(x + y) * (x + y) - x / 3",
        "x + y * y - 3 * x + x * y - exp(x) * y + x^2",
        "y - (x - y * x) + (x + y) - (x^2 + sin(x) * x)",
        "x + (y + (x^2 + (y - x * y)))",
    ] {
        check(text);
    }
    // Outputs that are also operands, and one of them twice.
    let model = model("x y", "[x + y, x * y + (x + y), x, x + y]", "");
    let blocks = [Block([2.0; LANES]), Block([5.0; LANES])];
    let mut out = [Block::ZERO; 4];
    BlockRunner::new(&model).run(&blocks, &mut out);
    assert_eq!(out.map(|block| block.0[LANES - 1]), [7.0, 17.0, 2.0, 7.0]);
    check("solve(z + exp(z) == x, z, y)");
}

#[test]
fn sums_over_vectors_need_few_registers() {
    let model = model("x[2000]", "sum(x^2)", "");
    assert!(format!("{:?}", BlockRunner::new(&model)).len() < 3_000_000);
    let x: Vec<f64> = (0..2000).map(f64::from).collect();
    let start = std::time::Instant::now();
    let gradient = model.gradients(&x);
    let along = model.along(&x, &x);
    assert!(start.elapsed().as_millis() < 200);
    for i in 0..2000 {
        assert_eq!(gradient[(0, i)], 2.0 * x[i]);
        assert_eq!(along[0].second[i], 2.0 * x[i]);
        assert_eq!(along[0].third[i], 0.0);
    }
}

#[test]
fn equations_are_printed_as_written_but_tidy() {
    for (text, expected) in [
        ("((a*b))/(c+1)", "Y = a * b / (c + 1)"),
        ("a-(b-c)", "Y = a - (b - c)"),
        ("(a-b)-c", "Y = a - b - c"),
        ("a/(b*c)", "Y = a / (b * c)"),
        ("(-a)**2 × b^-c", "Y = (-a)^2 * b^-c"),
        ("-(a^2)", "Y = -a^2"),
        ("-(a+b)", "Y = -(a + b)"),
        ("a^(b^c)", "Y = a^b^c"),
        ("(a^b)^c", "Y = (a^b)^c"),
        ("R=a/b\nY=R*cos( c )", "R = a / b\nY = R * cos(c)"),
        (
            "f(x)=x^2; z = f(a) + b*c",
            "f(x) = x^2\nz = f(a) + b * c\nY = z",
        ),
        (
            "if a<b and not (b<c or a<c) then a else b+2.50e-3*c",
            "Y = if a < b and not (b < c or a < c) then a else b + 2.50e-3 * c",
        ),
        ("a + (-b) + c * [a, b][1]", "Y = a + (-b) + c * [a, b][1]"),
    ] {
        let made = model("a b c", text, "");
        assert_eq!(made.outputs()[0].equation, expected);
        // The printed form means the same.
        let x = [1.25, 0.5, 2.0];
        let again = model("a b c", expected, "");
        assert_eq!(made.values(&x), again.values(&x), "{text}");
    }
}

#[test]
fn several_measurands_share_statements() {
    let units = UnitTable::default();
    let mut symbols = symbols("U:V I:A phi:° spare");
    symbols.push(Symbol {
        name: "c".into(),
        unit: unit("1"),
        role: Role::Constant(2.0),
    });
    let measurands = [
        MeasurandSource {
            name: "R",
            model: None,
            unit: Some(unit("ohm")),
        },
        MeasurandSource {
            name: "P",
            model: Some("U * I * cos(phi)"),
            unit: Some(unit("mW")),
        },
        MeasurandSource {
            name: "X",
            model: Some("Z = R / c\nZ * I"),
            unit: Some(unit("V")),
        },
    ];
    let request = Request {
        symbols: &symbols,
        shared: Some("Z0 = U / I; R = Z0 * cos(phi)"),
        measurands: &measurands,
        units: &units,
    };
    let model = compile(&request).unwrap();
    let y = model.values(&[10.0, 2.0, 60.0, 0.0]);
    close(y[0], 2.5, 1e-14, "R");
    close(y[1], 10_000.0, 1e-14, "P");
    close(y[2], 2.5, 1e-14, "X");
    assert_eq!(model.unused_symbols(), [3]);
    assert_eq!(model.inputs(), 4);
    assert_eq!(model.outputs()[0].equation, "Z0 = U / I\nR = Z0 * cos(phi)");
    assert_eq!(model.outputs()[1].equation, "P = U * I * cos(phi)");
    assert_eq!(
        model.outputs()[2].equation,
        "Z0 = U / I\nR = Z0 * cos(phi)\nZ = R / c\nX = Z * I"
    );
    // Sensitivity in output unit per input unit: dR/dphi in ohm per degree.
    close(
        model.gradients(&[10.0, 2.0, 60.0, 0.0])[(0, 2)],
        -5.0 * (PI / 3.0).sin() * PI / 180.0,
        1e-14,
        "dR/dphi",
    );
}

#[test]
fn hints_name_kinks_steps_and_poles() {
    let m = model(
        "x a",
        "abs(x - a) + min(x, a) + round(x) + if(x > a, x, a)",
        "",
    );
    let words = |notices: Vec<Notice>| notices.iter().map(Notice::said).collect::<Vec<_>>();
    assert_eq!(
        words(m.irregularities(&[2.0, 2.0])),
        [
            "abs(x - a) has a kink where x - a is 0, which is just here",
            // min(x, a) has its kink there too.
            "round(x) is a step function: its derivative is 0 although it jumps",
            "the condition x > a changes just here",
        ]
    );
    assert_eq!(m.irregularities(&[2.0, 3.0]).len(), 1);
    let m = model(
        "a b c",
        "max(a, b) - min(b, a) + abs(b - a) + max(a, c)",
        "",
    );
    assert_eq!(
        words(m.near_corners(&[1.0, 1.1, 1.2], &[0.1; 3], 4.0)),
        [
            "max(a, b) has a kink or jump 0.7 u from the estimates",
            "max(a, c) has a kink or jump 1.4 u from the estimates"
        ]
    );
    let m = model(
        "x1 x2",
        "x1 / x2 + ln(x1 - 1) + sqrt(x1) + quantize(x1, 0.1)",
        "",
    );
    assert_eq!(
        words(m.near_singular(&[3.0, 0.7], &[1.0, 0.5], 2.0)),
        [
            "x2 (divisor) is 1.4 u from 0",
            "x1 - 1 (argument of ln) is 2.0 u from 0"
        ]
    );
    assert_eq!(m.near_singular(&[3.0, 0.7], &[0.1, 0.01], 2.0), Vec::new());
    assert_eq!(
        model("a b c d", "a + 2 * b - c / 3 + d^2", "").nonlinear_inputs(),
        [false, false, false, true]
    );
    assert_eq!(
        model("a b c", "exp(2 * a) + b * c", "").nonlinear_inputs(),
        [true, true, true]
    );
    let blocks = |names, text| {
        let found = model(names, text, "").interactions();
        let mut order: Vec<usize> = Vec::new();
        let number = |block: Option<usize>| {
            let block = block?;
            if !order.contains(&block) {
                order.push(block);
            }
            order.iter().position(|known| *known == block)
        };
        found.into_iter().map(number).collect::<Vec<_>>()
    };
    assert_eq!(
        blocks("a b c d e", "a^2 + b * c / 2 - 3 * d + exp(2 * e)"),
        [Some(0), Some(1), Some(1), None, Some(2)]
    );
    // What is summed first and then squared interacts; a common constant joins nothing.
    assert_eq!(blocks("a b", "(a + b)^2"), [Some(0), Some(0)]);
    assert_eq!(blocks("a b", "2 / a + 2 / b"), [Some(0), Some(1)]);
    assert_eq!(blocks("a b", "ln(a^2 + b^2)"), [Some(0), Some(0)]);
    assert_eq!(
        blocks("a b c", "s = a + b\ns * c + a^2"),
        [Some(0), Some(0), Some(0)]
    );
    assert_eq!(
        model("a b", "if(a > 0, 1 / b, b)", "").irregularities(&[1.0, 0.0]),
        Vec::new()
    );
}

#[test]
fn every_function_is_documented() {
    for f in functions() {
        assert!(f.signature.starts_with(f.name), "{}", f.name);
        assert!(!f.doc.is_empty() && !f.dimension.is_empty());
    }
    for row in UNARY
        .iter()
        .map(|r| r.name)
        .chain(BINARY.iter().map(|r| r.name))
    {
        let callable = row.chars().all(|c| c.is_alphanumeric() || c == '_')
            && !matches!(row, "not" | "and" | "or");
        assert_eq!(find(row).is_some(), callable, "{row}");
    }
}

/// The power through which alone an output depends on an input.
#[test]
fn exponents_of_inputs() {
    let exponent = |text: &str| model("a b c", text, "").exponent_of(0, 0);
    let cases = [
        ("sqrt(b + c*(a/2)^0.45)", Some((0.45, false))),
        ("b*sqrt(a)*c", Some((0.5, true))),
        ("b/a/cbrt(a)", Some((-4.0 / 3.0, true))),
        ("b - c*a^2", Some((2.0, false))),
        ("-a^3*exp(b)", Some((3.0, true))),
        ("exp(-(a/b)^2) + a*a", Some((2.0, false))),
        ("b + c*a", Some((1.0, false))),
        ("b*(a + 273.15)^4", Some((1.0, false))),
        ("b*a + c*a^2", None),
        ("b*a^c", Some((1.0, false))),
        ("b + c", None),
    ];
    for (text, wanted) in cases {
        assert_eq!(exponent(text), wanted, "{text}");
    }
}

/// The degree in some inputs together while the others are held.
#[test]
fn degrees_of_polynomials() {
    let degree = |text: &str, of: &[usize]| model("a b c", text, "").degree_in(of);
    for (text, of, wanted) in [
        ("a^2 + b * c", &[0][..], Some(2)),
        ("a^2 + b * c", &[1], Some(1)),
        ("a^2 + b * c", &[0, 1, 2], Some(2)),
        ("a * b * c", &[0, 1], Some(2)),
        ("a * b * c", &[0, 1, 2], None),
        ("(a + 2 * b) / c - b", &[0, 1], Some(1)),
        ("(a + 2 * b) / c - b", &[2], None),
        ("a * exp(b) + c", &[0, 2], Some(1)),
        ("a * exp(b) + c", &[1], None),
        ("(a * b)^2", &[0], Some(2)),
        ("(a * b)^2", &[0, 1], None),
        ("a^3 + b", &[1], Some(1)),
        ("a^3 + b", &[0], None),
        ("b", &[0], Some(0)),
    ] {
        assert_eq!(degree(text, of), wanted, "{text} in {of:?}");
    }
}
