//! Every fault: its code, the marked text and the mend.

use super::*;
use crate::model::Place;
use crate::model::faults::CODES;

/// Inputs of the cases below.
const INPUTS: &str = "a b n L:mm t:s phi:° T:°C v[3] w[2] p:bar g:g Q:C";

/// Text, unit of the measurand, code, marked text, part of the help.
#[rustfmt::skip] // A table reads by lines.
const CASES: &[(&str, &str, &str, &str, &str)] = &[
    ("a + * b", "", "M0101", "*", ""),
    ("a + ", "", "M0101", "", ""),
    ("a\n+ b", "", "M0101", "+", "end that line with `+`"),
    ("if a > 0 else b", "", "M0101", "else", "write `if condition then a else b`"),
    ("(a + b / n", "", "M0102", "(", "add `)`"),
    ("c = f(a, [b, n\nd = a", "", "M0102", "[", "add `]`"),
    ("if(a = b, 1, 2)", "", "M0103", "=", "write `==`"),
    ("2a", "", "M0104", "a", "write `2 * a`"),
    ("2e-3a", "", "M0104", "a", "write `2e-3 * a`"),
    ("a * 1 000", "", "M0104", "000", "`1000`"),
    ("25 mm", "", "M0104", "mm", "`25 'mm'` if mm is the unit"),
    ("a b", "", "M0104", "b", "write `a * b`"),
    ("a ? b", "", "M0105", "?", "`if(condition, a, b)`"),
    ("a : b", "", "M0105", ":", "`/` for a ratio"),
    ("a ± b", "", "M0105", "±", "at its input"),
    ("= a / b", "", "M0101", "=", "leave out the `=`"),
    ("a * 1,05", "", "M0101", ",", "write a decimal point: 1.05"),
    ("atan2(a; b)", "", "M0102", "(", "write `,` in place of `;`"),
    ("'1 mm'", "", "M0113", "'1 mm'", "write `1 'mm'`"),
    ("5 °", "", "M0105", "°", "`5 '°'`"),
    ("1.2.3 + a", "", "M0106", "1.2.3", "1.5e-3"),
    ("1e999", "", "M0106", "1e999", ""),
    ("if(0 < a < 1, a, b)", "", "M0107", "<", "a < b and b < c"),
    ("a + b ; a * b", "", "M0109", "a + b", "give it a name"),
    ("", "", "M0110", "", "formula"),
    ("f(x) = x^2", "", "M0110", "f", "last line"),
    ("a + b = n", "", "M0111", "a + b", "`name = expression`"),
    ("mean([a, b)]", "", "M0112", ")", "write `]`"),
    ("a + b)", "", "M0112", ")", "remove `)`"),
    ("a 'mm'", "", "M0113", "'mm'", "value_in(x, 'mm')"),
    ("'mm'", "", "M0113", "'mm'", "write `1 'mm'`"),
    ("25 'mm", "", "M0113", "'mm", "`25 'mm'`"),
    ("aa + bb1", "", "M0201", "aa", "did you mean `a`?"),
    ("omega * a", "", "M0201", "omega", "[input.omega]"),
    ("a / U_a", "", "M0201", "U_a", "[constant.U_a]"),
    ("ba + 1", "", "M0201", "ba", "a product has its sign: b * a"),
    ("sine(a)", "", "M0202", "sine", "did you mean `sin`?"),
    ("S(a - 7)", "", "M0202", "S", "`S * (…)`"),
    ("sqr(a)", "", "M0202", "sqr", "the square is `x^2`, the square root `sqrt(x)`"),
    ("а + b", "", "M0201", "а", "a letter of `а` is U+0430 of Unicode, that of `a` U+0061"),
    ("log(a)", "", "M0202", "log", "`ln` for the natural"),
    ("atan2(a)", "", "M0203", "atan2(a)", "atan2(y, x)"),
    ("f(x, y) = x; f(a)", "", "M0203", "f(a)", "f(x, y)"),
    ("c = a; c = b; c", "", "M0204", "c", "choose another name"),
    ("a = b", "", "M0204", "a", "choose another name"),
    ("min = a; a", "", "M0205", "min", "min_1"),
    ("sqrt / 2", "", "M0206", "sqrt", "write `sqrt(x)`"),
    ("a(b + n)", "", "M0207", "a", "write `a * (b + n)`"),
    ("c = d; d = a; c", "", "M0208", "d", "above this line"),
    ("d = a - d * n", "", "M0208", "d", "solve(equation, d, start)"),
    ("f(x) = f(x - 1); f(a)", "", "M0208", "f", "cannot call themselves"),
    ("sum(v + w)", "", "M0301", "w", "equal lengths"),
    ("mean(a)", "", "M0302", "a", "[a, …]"),
    ("if(v > 0, a, v)[1] + [v[1]][1] + a[1]", "", "M0302", "a", "remove the index"),
    ("v[0]", "", "M0303", "0", "counted from 1"),
    ("v[4]", "", "M0303", "4", "counted from 1"),
    ("v[a]", "", "M0303", "a", "counted from 1"),
    ("a * linspace(0, 1, 101)", "m", "M0304", "a * linspace(0, 1, 101)", "mean(a * linspace(0, 1, 101))"),
    ("t_quantile(0.95, n)", "", "M0504", "n", "[constant]"),
    ("sum([v, w])", "", "M0302", "v", "mean(v)"),
    ("sum([[1, 2], [3, 4]])", "", "M0305", "[1, 2]", "one pair of brackets"),
    ("(a < b) * n", "", "M0306", "(a < b)", "if(a < b, 1, 0)"),
    ("if(a, b, n)", "", "M0307", "a", "a > 0"),
    ("L + 5", "mm", "M0401", "5", "`5 'mm'`"),
    ("T - 20°C", "K", "M0105", "°", "`20 '°C'`"),
    ("T - 20℃", "K", "M0105", "℃", "`20 '℃'`"),
    ("L + t", "mm", "M0401", "t", "dimension"),
    ("L + a * b", "mm", "M0401", "a * b", "if `a` has a unit, state it: `unit = \"mm\"`"),
    ("if(L > t, a, b)", "", "M0401", "t", ""),
    ("sum([L, t])", "mm", "M0401", "t", ""),
    ("value_in(L, 's')", "", "M0401", "s", "value_in(L, 'mm')"),
    ("L + a * t", "mm", "M0401", "a * t", "if `a` has a unit, state it: `unit = \"mm/s\"`"),
    ("1 + a * t", "", "M0401", "a * t", "if `a` has a unit, state it: `unit = \"1/s\"`"),
    ("1 - L / t", "", "M0401", "L / t", "must cancel"),
    ("T - a", "K", "M0401", "a", "`unit = \"°C\"` for a temperature"),
    ("√(L) + t", "mm", "M0105", "√", "sqrt(x)"),
    ("\\frac{L}{t}", "mm/s", "M0105", "\\", "not in LaTeX"),
    ("100 * a / b", "%", "M0410", "100 * a / b", "leave 100 out"),
    ("2 * a + 20 * exp(b)", "°C", "M0405", "2 * a + 20 * exp(b)", "`0 '°C' + 1 'K' * "),
    ("value_in(L, 'mm') / value_in(t, 's')", "mm/s", "M0405", "value_in(L, 'mm') / value_in(t, 's')", "multiplied by `1 'mm/s'`"),
    ("exp(-t / a)", "", "M0402", "-t / a", "`a` has no unit; if it was forgotten, state it where it has its value (`unit = \"s\"` would fit)"),
    ("Q + 5", "C", "M0401", "5", "`C` is the coulomb"),
    ("Q - 23 '°C'", "K", "M0401", "23 '°C'", "`C` is the coulomb (charge); degrees Celsius are `°C`"),
    ("1 + Q / (1 'K')", "", "M0401", "Q / (1 'K')", "`C` is the coulomb"),
    ("1 'K' / a", "°C", "M0404", "1 'K' / a", "`0 '°C' + (1 'K' / a - 273.15 'K')`"),
    ("sin(L)", "", "M0402", "L", "value_in(L, 'mm')"),
    ("round(L)", "", "M0402", "L", "value_in(L, 'mm')"),
    ("L^n", "mm", "M0403", "n", "(L / (1 'mm'))^n"),
    ("a^L", "", "M0403", "L", "same kind"),
    ("a * T", "", "M0404", "T", "T - 20 '°C'"),
    ("T + T", "°C", "M0404", "T", "kelvin(T)"),
    ("T", "K", "M0404", "T", "kelvin(T)"),
    ("T - 20 '°C'", "°C", "M0404", "T - 20 '°C'", "unit = \"K\""),
    ("T + 273.15", "K", "M0404", "273.15", "`kelvin(T)`"),
    ("kelvin(T + 273.15 'K')", "K", "M0404", "273.15 'K'", "`kelvin(T)`"),
    ("-T", "°C", "M0404", "T", "kelvin(T)"),
    ("value_in(L / (1 'mm') * 1 'K', '°C')", "", "M0401", "°C", "value_in(L / 1 'mm' * 1 'K', 'K')"),
    ("T - 20", "K", "M0401", "20", "the difference from 20 °C is `T - 20 '°C'`"),
    ("17.62 * T / (243.12 + T)", "", "M0404", "T", "`value_in(T, '°C')`"),
    ("243.12 + T", "°C", "M0401", "243.12", "`T + 243.12 'K'`"),
    ("T - 20 'K'", "K", "M0404", "T - 20 'K'", "`T - 20 '°C'`"),
    ("n * 1 'r/min'", "Hz", "M0409", "n * 1 'r/min'", "/ (1 'r')"),
    ("n * 1 'r/min' + 1 'Hz'", "Hz", "M0409", "1 'Hz'", "* (1 'r')"),
    ("n * 1 'Hz' - 1 'rpm'", "Hz", "M0409", "1 'rpm'", "/ (1 'r')"),
    ("n * 1 'r/min' + 1 '1/min'", "1/min", "M0409", "1 '1/min'", "* (1 'r')"),
    ("1 - n * 1 'r/min' / (n * 1 'Hz')", "%", "M0407", "1", "`n * 1 'r/min' / (n * 1 'Hz') / (1 'r')`"),
    ("L / t", "mm", "M0405", "L / t", "unit = \"mm/s\""),
    ("phi + 90", "°", "M0407", "90", "`90 '°'`"),
    ("L * cos(30)", "mm", "M0407", "30", "`30 '°'`"),
    ("L * cos(-45)", "mm", "M0407", "45", "`45 'rad'`"),
    ("sin(phi * pi / 180)", "", "M0408", "phi * pi / 180", "write `phi` without"),
    ("sin(n * phi / n * pi / 180)", "", "M0408", "n * phi / n * pi / 180", "write `n * phi / n` without the factor, or `value_in(n * phi / n, '°')`"),
    ("sin(pi / 180 / t * (phi * t))", "", "M0408", "pi / 180 / t * (phi * t)", "write `phi * t / t` without the factor"),
    ("a + cos(phi - 0.01745 * phi)", "", "M0408", "0.01745 * phi", "value_in(phi, '°')"),
    ("cos(a - 0.01745 * phi)", "", "M0410", "0.01745 * phi", "leave 0.01745 out"),
    ("solve(a == b, d, 1)", "", "M0502", "a == b", "contains `d`"),
    ("solve(a == b, a, 1)", "", "M0502", "a", "new name"),
    ("solve(d == b, 2, 1)", "", "M0502", "2", "new name"),
    ("a / (1 + b * Y)", "", "M0201", "Y", "`solve(Y == …, Y, start)`"),
];

#[test]
fn faults_mark_their_place_and_say_the_mend() {
    let mut wrong = Vec::new();
    for (text, wanted, code, marked, help) in CASES {
        let faults = try_model(INPUTS, text, wanted)
            .err()
            .unwrap_or_else(|| panic!("{text} is accepted"));
        let ModelFault { place, fault } = &faults[0];
        let found = text.get(fault.span.clone()).unwrap_or("no text").trim();
        let fits = *place == Place::Measurand(0)
            && fault.code.id == *code
            && found == *marked
            && fault
                .help
                .clone()
                .unwrap_or_default()
                .to_string()
                .contains(help)
            && !fault.message.is_empty()
            && !fault.message.to_string().ends_with('.');
        if !fits {
            wrong.push(format!(
                "{text}: `{found}` {} {} help: {:?}",
                fault.code.id, fault.message, fault.help
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn unit_texts_are_marked_inside_the_quotes() {
    let text = "L + 2 'm/xyz'";
    let faults = try_model(INPUTS, text, "mm").unwrap_err();
    assert_eq!(&text[faults[0].fault.span.clone()], "xyz");
    assert_eq!(faults[0].fault.code.id.chars().next(), Some('U'));
}

#[test]
fn several_faults_are_found_in_one_pass() {
    let text = "c = a + * 2\nd = (L + t) * sin(L)\ne = c + unknown\nd * e";
    let faults = try_model(INPUTS, text, "").unwrap_err();
    let codes: Vec<&str> = faults.iter().map(|f| f.fault.code.id).collect();
    assert_eq!(codes, ["M0101", "M0401", "M0402", "M0201"]);
}

#[test]
fn faults_in_functions_are_shown_at_the_call() {
    let text = "f(x) = x + L ; f(t)";
    let fault = &try_model(INPUTS, text, "mm").unwrap_err()[0].fault;
    assert_eq!(&text[fault.span.clone()], "f(t)");
    assert_eq!(&text[fault.related[0].0.clone()], "L");
    assert!(fault.message.to_string().starts_with("in `f`: "));
}

#[test]
fn entries_are_blamed_for_what_they_lack() {
    let units = UnitTable::default();
    let symbols = symbols("U:V I:A max");
    let measurands = [
        MeasurandSource {
            name: "P",
            model: Some("U * I"),
            unit: None,
        },
        MeasurandSource {
            name: "Q",
            model: None,
            unit: None,
        },
    ];
    let request = Request {
        symbols: &symbols,
        shared: Some("U / I"),
        measurands: &measurands,
        units: &units,
    };
    let faults = compile(&request).unwrap_err();
    let found: Vec<(Place, &str)> = faults.iter().map(|f| (f.place, f.fault.code.id)).collect();
    assert_eq!(
        found,
        [
            (Place::Symbol(2), "M0205"),
            (Place::Shared, "M0109"),
            (Place::Entry(0), "M0406"),
            (Place::Entry(1), "M0209"),
        ]
    );
}

#[test]
fn limits_are_faults_not_crashes() {
    let first = |text: &str| {
        try_model("a v[3000]", text, "").unwrap_err()[0]
            .fault
            .code
            .id
    };
    assert_eq!(
        first(&format!("{}a{}", "(".repeat(5000), ")".repeat(5000))),
        "M0108"
    );
    assert_eq!(first(&format!("{}a", "-".repeat(5000))), "M0108");
    assert_eq!(first(&format!("{}a", "2^".repeat(5000))), "M0108");
    let doubling: String = (1..40)
        .map(|k| format!("f{k}(x) = f{}(x) * f{}(x + 1)\n", k - 1, k - 1))
        .collect();
    assert_eq!(first(&format!("f0(x) = x\n{doubling}f39(a)")), "M0501");
    let wide = "w = v".to_string() + &" + sum(v * a) * v".repeat(2000);
    assert_eq!(first(&format!("{wide}\nsum(w)")), "M0501");
    // A long sum is no deep one.
    let long = "a".to_string() + &" + a * 2".repeat(5000);
    close(
        model("a", &long, "").values(&[1.0])[0],
        10_001.0,
        1e-15,
        "long sum",
    );
    // Functions within functions.
    let tower: String = (1..200)
        .map(|k| format!("f{k}(x) = f{}(x) + 1\n", k - 1))
        .collect();
    assert_eq!(first(&format!("f0(x) = x\n{tower}f199(a)")), "M0108");
}

#[test]
fn every_code_is_explained_and_tested() {
    let mut tested: Vec<&str> = CASES.iter().map(|c| c.2).collect();
    // M0503 needs estimates: the gallery of mistakes has it (division_by_zero).
    tested.extend(["M0108", "M0209", "M0406", "M0501", "M0503"]);
    for code in CODES {
        assert!(tested.contains(&code.id), "{} is not tested", code.id);
        assert!(
            code.explanation.contains("\n\n    "),
            "{} has no example",
            code.id
        );
    }
}

#[test]
fn a_measurand_has_a_name_of_its_own() {
    let units = UnitTable::default();
    let symbols = symbols("P:W U:V");
    let measurands = [
        MeasurandSource {
            name: "P",
            model: Some("2 * P"),
            unit: Some(unit("W")),
        },
        MeasurandSource {
            name: "Q",
            model: Some("U + x"),
            unit: Some(unit("V")),
        },
        MeasurandSource {
            name: "R",
            model: Some("2 * Q"),
            unit: Some(unit("V")),
        },
    ];
    let request = Request {
        symbols: &symbols,
        shared: None,
        measurands: &measurands,
        units: &units,
    };
    let faults = compile(&request).unwrap_err();
    let found: Vec<(Place, &str)> = faults.iter().map(|f| (f.place, f.fault.code.id)).collect();
    // R is not blamed for the fault of Q.
    assert_eq!(
        found,
        [(Place::Entry(0), "M0204"), (Place::Measurand(1), "M0201")]
    );
}
