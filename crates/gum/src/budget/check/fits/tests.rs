//! Fits against closed forms.

use std::path::Path;

use crate::budget::{Budget, Files, FitDoubt, Law, Rejection, load_from, read};

fn budget(text: &str) -> Result<Budget, Rejection> {
    let mut loaded = read(text, "test.toml", Path::new(""))?;
    Ok(loaded.rows.remove(0).budget)
}

fn accepted(text: &str) -> Budget {
    budget(text).unwrap_or_else(|rejection| panic!("{}", rejection.render(false)))
}

fn close(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() <= 1e-12 * expected.abs().max(1.0),
        "{found} is not {expected}"
    );
}

/// x is centred, so that both parameters are independent: a = mean of y, b = Σxy/Σx².
const CENTRED: &str = r#"
[fit.line]
model = "y = a + b*x"
[fit.line.data]
x = { values = [-1, 0, 1], unit = "s" }
y = { values = [1.0, 2.5, 3.0], unit = "m", COMPONENTS }
"#;

fn centred(errors: &str) -> Budget {
    accepted(&CENTRED.replace("COMPONENTS", errors))
}

#[test]
fn residuals_tell_the_scatter() {
    let budget = accepted(&CENTRED.replace(", COMPONENTS", ""));
    let fit = &budget.fits[0];
    // Residuals -1/6, 1/3, -1/6.
    close(fit.chi_squared, 1.0 / 6.0);
    close(budget.inputs[0].estimate, 6.5 / 3.0);
    close(budget.inputs[1].estimate, 1.0);
    close(fit.parameters[0].u, (1.0_f64 / 18.0).sqrt());
    close(fit.parameters[1].u, (1.0_f64 / 12.0).sqrt());
    assert_eq!(fit.parameters[1].unit.symbol, "m/s");
    assert_eq!(budget.groups[0].dof, Some(1.0));
    assert!(matches!(budget.groups[0].law, Law::StudentT { .. }));
    let names: Vec<&str> = budget.measurands.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["a", "b"]);
}

#[test]
fn stated_uncertainties_are_known() {
    let budget = centred("u = 0.3");
    let fit = &budget.fits[0];
    close(fit.parameters[0].u, 0.3 / 3.0_f64.sqrt());
    close(fit.parameters[1].u, 0.3 / 2.0_f64.sqrt());
    assert_eq!(budget.groups[0].law, Law::Normal);
    assert_eq!(budget.components[0].dof, f64::INFINITY);
}

#[test]
fn common_causes_shift_the_parameters() {
    let budget = centred(
        r#"components = [{ u = 0.3 }, { name = "zero", u = 0.1, common = true }, { name = "gain", u = 0.01, relative = true, common = true }]"#,
    );
    let action = |input: usize, name: &str| {
        let component = budget.components.iter().position(|c| c.name == name);
        let terms = &budget.inputs[input].terms;
        let term = terms.iter().find(|term| Some(term.component) == component);
        term.map_or(0.0, |term| {
            term.coefficient * budget.components[term.component].u
        })
    };
    close(action(0, "line.y.zero"), 0.1);
    close(action(1, "line.y.zero"), 0.0);
    // A common gain error multiplies the whole line.
    close(action(0, "line.y.gain"), 0.01 * 6.5 / 3.0);
    close(action(1, "line.y.gain"), 0.01 * 1.0);
    let combined = budget.fits[0].parameters[0].combined_u;
    close(combined.powi(2), 0.03 + 0.01 + (0.065_f64 / 3.0).powi(2));
}

#[test]
fn further_readings_scatter_alike() {
    let text = CENTRED.replace(", COMPONENTS", "")
        + r#"
[input.y0]
value = "2.0 m"
unit = "m"
residual_of = "line"
of = 4
[measurand.x0]
model = "(y0 - a)/b"
unit = "s"
"#;
    let budget = accepted(&text);
    let own = budget.inputs[2].terms[0].component;
    close(budget.components[own].u, (1.0_f64 / 6.0).sqrt() / 2.0);
    let group = &budget.groups[0];
    assert_eq!(group.members.len(), 3);
    assert_eq!(group.dof, Some(1.0));
    close(group.correlation[(0, 2)], 0.0);
}

#[test]
fn polynomials_and_formulas_agree() {
    let data = r#"
[fit.curve.data]
x = { values = [0, 1, 2, 3, 4], unit = "s" }
y = { values = [1.02, 2.11, 5.04, 9.97, 17.05], unit = "m" }
"#;
    let head = "[fit.curve]\npolynomial = 2\nresponse = \"y\"\npredictor = \"x\"\n";
    let polynomial = accepted(&format!("{head}{data}"));
    let formula = accepted(&format!(
        "[fit.curve]\nmodel = \"y = a + b*x + c*x^2\"\n{data}"
    ));
    for (one, other) in polynomial.inputs.iter().zip(&formula.inputs) {
        close(one.estimate, other.estimate);
        assert_eq!(one.unit.dimension, other.unit.dimension);
    }
    assert_eq!(polynomial.inputs[2].name, "curve_2");
    assert_eq!(polynomial.inputs[2].unit.symbol, "m/s^2");
}

#[test]
fn figures_have_names() {
    let budget = centred("u = 0.3");
    let figure = |name: &str| {
        let found = budget.figures.iter().find(|figure| figure.name == name);
        found.map_or(f64::NAN, |figure| figure.value)
    };
    close(figure("line.cov(a, b)"), 0.0);
    close(figure("line.chi_squared"), 1.0 / 6.0 / 0.09);
    close(figure("line.dof"), 1.0);
    assert!(figure("line.lack_of_fit.p") > 0.05);
}

/// Data on the curve to the last digit leave nothing to be uncertain of.
#[test]
fn exact_data_give_exact_parameters() {
    let budget = accepted(
        r#"
[fit.line]
model = "y = a + b*x"
[fit.line.data]
x = { values = [0, 1, 2, 3] }
y = { values = [1, 3, 5, 7] }
[claim]
figures = { "line.rss" = 0, "line.r" = 1 }
"#,
    );
    close(budget.inputs[0].estimate, 1.0);
    close(budget.inputs[1].estimate, 2.0);
    close(budget.fits[0].chi_squared, 0.0);
    assert!(budget.fits[0].parameters.iter().all(|p| p.u < 1e-14));
    assert!(budget.fits[0].lack_of_fit.is_none());
}

/// As many points as parameters: the curve goes through all, and stated uncertainties go over to it.
#[test]
fn two_points_tell_a_line() {
    let budget = accepted(
        r#"
[fit.line]
model = "y = a + b*x"
[fit.line.data]
x = { values = [0, 2] }
y = { values = [1, 4], u = 0.1 }
"#,
    );
    let fit = &budget.fits[0];
    assert_eq!((fit.dof, fit.residual_sd), (0, None));
    close(budget.inputs[1].estimate, 1.5);
    close(fit.parameters[1].u, 0.1 / 2.0_f64.sqrt());
    close(fit.covariance[(0, 1)], -0.005);
}

/// Errors of x and y of one point with r, against the minimum of Σ (y − a − bx)²/(u_y² + b²u_x² − 2br u_x u_y), found
/// by bisection with 50 digits.
#[test]
fn errors_of_a_point_may_be_correlated() {
    let budget = accepted(
        r#"
[fit.l]
model = "y = a + b*x"
correlation = [0.5, 0.5, 0.5, -0.2, 0.9]
[fit.l.data]
x = { values = [1, 2, 3, 4, 5], u = 0.3 }
y = { values = [1.3, 4.1, 6.9, 7.5, 10.2], u = [0.2, 0.2, 0.2, 0.4, 0.4] }
"#,
    );
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-11, "{found}");
    near(budget.inputs[0].estimate, -0.470384178928737);
    near(budget.inputs[1].estimate, 2.162226195640728);
    near(budget.fits[0].chi_squared, 3.852305674022382);
}

#[test]
fn uncertainties_stand_in_a_csv_file() {
    let text = |u: &str| {
        CENTRED
            .replace("\"m\", COMPONENTS", "\"m\", U")
            .replace('U', u)
    };
    let folder = tempfile::tempdir().expect("a folder for the test");
    std::fs::write(folder.path().join("u.csv"), "u,short\n0.1,1\n0.2,1\n0.3,\n").expect("a file");
    let read = |u: &str| read(&text(u), "test.toml", folder.path());
    let from_file = read(r#"u = { file = "u.csv", column = "u" }"#).expect("a budget");
    let listed = centred("u = [0.1, 0.2, 0.3]");
    let of = |budget: &Budget| budget.fits[0].covariance.clone();
    assert_eq!(of(&from_file.rows[0].budget), of(&listed));
    let component = r#"components = [{ half_width = { file = "u.csv", column = "u" } }]"#;
    let halves = read(component).expect("a budget");
    close(
        halves.rows[0].budget.fits[0].covariance[(0, 0)] * 3.0,
        of(&listed)[(0, 0)],
    );
    let refused = |u: &str| match read(u) {
        Err(rejection) => rejection.render(false),
        Ok(_) => panic!("{u} is accepted"),
    };
    let message = refused(r#"u = { file = "u.csv", column = "short" }"#);
    assert!(
        message.contains("line 4, column \"short\": \"\" is not a number"),
        "{message}"
    );
    // One in the table, and where the budget asks for it.
    assert_eq!(message.matches("error[").count(), 2, "{message}");
}

/// A fit of one predictor in the file's words.
fn fit_of(model: &str, x: &[f64], y: &[f64], starts: &str) -> String {
    format!(
        "[fit.f]\nmodel = \"{model}\"\n[fit.f.data]\nx = {{ values = {x:?} }}\ny = {{ values = {y:?} }}\n{starts}"
    )
}

/// Errors that look like chance and are always the same: a golden-section sequence about zero.
fn errors(n: usize, size: f64) -> Vec<f64> {
    let place = |i: usize| (i as f64 * 0.618_033_988_749_894_9).fract() - 0.5;
    (1..=n).map(|i| size * place(i * i)).collect()
}

fn noisy(x: &[f64], size: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let pairs = x.iter().zip(errors(x.len(), size));
    pairs.map(|(x, error)| f(*x) + error).collect()
}

fn steps(n: usize, step: f64) -> Vec<f64> {
    (0..n).map(|i| step * i as f64).collect()
}

#[test]
fn a_frequency_far_off_ends_in_a_minimum_that_is_not_the_best() {
    let x = steps(40, 0.25);
    let y = noisy(&x, 0.1, |x| 1.3 * (2.1 * x + 0.4).sin());
    let from = |w: f64| {
        let starts = format!(
            "[fit.f.parameters]\nA = {{ start = 1 }}\nw = {{ start = {w} }}\np = {{ start = 0.1 }}\n"
        );
        accepted(&fit_of("y = A*sin(w*x + p)", &x, &y, &starts))
    };
    let good = from(2.0);
    assert!((good.inputs[1].estimate - 2.1).abs() < 0.01);
    assert_eq!(good.fits[0].doubts, []);
    let bad = from(5.0);
    assert!((bad.inputs[1].estimate - 2.1).abs() > 0.5);
    let better = bad.fits[0].doubts.iter().find_map(|doubt| match doubt {
        FitDoubt::BetterMinimum {
            parameters,
            residuals,
        } => Some((parameters.clone(), *residuals)),
        _ => None,
    });
    let (parameters, residuals) = better.expect("a better minimum");
    close_to(parameters[1].1.abs(), good.inputs[1].estimate, 1e-5);
    let ratio = (good.fits[0].chi_squared / bad.fits[0].chi_squared).sqrt();
    close_to(residuals, ratio, 1e-6);
}

fn close_to(found: f64, expected: f64, relative: f64) {
    assert!(
        (found / expected - 1.0).abs() < relative,
        "{found} is not {expected}"
    );
}

#[test]
fn a_pole_between_the_points_is_found_where_it_is() {
    let x = steps(7, 1.0);
    let y = noisy(&x, 0.001, |x| 1.0 / (1.0 - 0.3 * x));
    let starts = "[fit.f.parameters]\na = { start = 1 }\nb = { start = -0.3 }\n";
    let budget = accepted(&fit_of("y = a/(1 + b*x)", &x, &y, starts));
    let pole = &budget.fits[0].doubts[0];
    assert!(
        matches!(pole, FitDoubt::Pole { argument, between: [3.0, 4.0], .. } if argument == "1 + b * x"),
        "{pole:?}"
    );
    // The same curve where it has none.
    let far = noisy(&x, 0.001, |x| 1.0 / (1.0 + 0.3 * x));
    let starts = "[fit.f.parameters]\na = { start = 1 }\nb = { start = 0.3 }\n";
    let budget = accepted(&fit_of("y = a/(1 + b*x)", &x, &far, starts));
    assert_eq!(budget.fits[0].doubts, []);
}

#[test]
fn residuals_of_a_line_through_a_curve_follow_a_pattern() {
    let x = steps(20, 0.5);
    let bent = noisy(&x, 0.01, |x| 1.0 + x + 0.1 * x * x);
    let budget = accepted(&fit_of("y = a + b*x", &x, &bent, ""));
    // Above, below, above: three runs of twenty points.
    let [
        FitDoubt::Pattern {
            runs: 3,
            points: 20,
            p,
        },
    ] = budget.fits[0].doubts[..]
    else {
        panic!("{:?}", budget.fits[0].doubts);
    };
    assert!(p < 1e-3);
    let straight = noisy(&x, 0.01, |x| 1.0 + x);
    let budget = accepted(&fit_of("y = a + b*x", &x, &straight, ""));
    assert_eq!(budget.fits[0].doubts, []);
}

/// A fit does not depend on the unit of its response, however large or small that makes the numbers.
#[test]
fn a_response_of_any_size() {
    let x = [1.0, 2.0, 3.0, 4.0, 5.0];
    let y = [1.01, 2.02, 3.98, 8.01, 16.03];
    let sized = |model: &str, exponent: i32| {
        let size = 10f64.powi(exponent);
        let y = y.map(|y| y * size);
        let starts = match model.contains("exp") {
            true => format!(
                "[fit.f.parameters]\na = {{ start = 1e{exponent} }}\nb = {{ start = 0.5 }}\n"
            ),
            false => String::new(),
        };
        let budget = accepted(&fit_of(model, &x, &y, &starts));
        let fit = &budget.fits[0];
        let parts = fit.parameters.iter().map(|p| (p.estimate, p.u));
        let s = fit.residual_sd.expect("residuals");
        (parts.collect::<Vec<_>>(), s, fit.correlation[(0, 1)])
    };
    for exponent in [160, 250, -160, -250] {
        let size = 10f64.powi(exponent);
        let (one, s, r) = sized("y = a*exp(b*x)", 0);
        let (far, s_far, r_far) = sized("y = a*exp(b*x)", exponent);
        close_to(far[0].0 / size, one[0].0, 1e-9);
        close_to(far[0].1 / size, one[0].1, 1e-6);
        close_to(far[1].0, one[1].0, 1e-9);
        close_to(far[1].1, one[1].1, 1e-6);
        close_to(s_far / size, s, 1e-9);
        close_to(r_far, r, 1e-6);
        let (one, s, r) = sized("y = a + b*x", 0);
        let (far, s_far, r_far) = sized("y = a + b*x", exponent);
        for (far, one) in far.iter().zip(&one) {
            close_to(far.0 / size, one.0, 1e-12);
            close_to(far.1 / size, one.1, 1e-12);
        }
        close_to(s_far / size, s, 1e-12);
        close_to(r_far, r, 1e-12);
    }
}

#[test]
fn a_bad_start_is_called_that() {
    let x = steps(7, 1.0);
    let y = noisy(&x, 0.01, |x| (0.5 * x).exp());
    let starts = "[fit.f.parameters]\na = { start = 1 }\nb = { start = 300 }\n";
    let refused = budget(&fit_of("y = a*exp(b*x)", &x, &y, starts)).map(|_| ());
    let text = refused.expect_err("e^1800").render(false);
    assert!(text.contains("these start values are bad ones"), "{text}");
    assert!(text.contains("b = 0.5"), "{text}");
}

/// Weights of a file are in the unit of their column, and in 1/unit² of the values where it has none; in another unit they are none.
#[test]
fn weights_have_a_unit() {
    let budget = "[fit.line]\nmodel = \"y = a + b*x\"\n[fit.line.data]\n\
        x = { values = [-1, 0, 1], unit = \"s\" }\n\
        y = { values = [1.0, 2.5, 3.0], unit = \"m\", weights = { file = \"w.csv\", column = \"w\" } }\n";
    let with = |table: &str| {
        let library = [("b.toml", budget.as_bytes()), ("w.csv", table.as_bytes())];
        load_from(Files::Library(&library), Path::new("b.toml"), None)
    };
    for table in ["w\n4\n4\n4\n", "w [1/cm^2]\n4e-4\n4e-4\n4e-4\n"] {
        let mut loaded = with(table).unwrap_or_else(|refused| panic!("{}", refused.render(false)));
        let fit = &loaded.rows.remove(0).budget.fits[0];
        close(fit.parameters[0].u, 0.5 / 3.0_f64.sqrt());
        close(fit.parameters[1].u, 0.5 / 2.0_f64.sqrt());
    }
    let refused = with("w [1/cm]\n4\n4\n4\n").expect_err("no unit of weights");
    assert!(
        refused.render(false).contains("no unit like"),
        "{}",
        refused.render(false)
    );
}
