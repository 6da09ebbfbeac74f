//! Fits against closed forms.

use std::path::Path;

use crate::budget::{Budget, Law, Rejection, read};

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
    let folder = std::env::temp_dir().join(format!("gumption-fit-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    std::fs::write(folder.join("u.csv"), "u,short\n0.1,1\n0.2,1\n0.3,\n").expect("a file");
    let read = |u: &str| read(&text(u), "test.toml", &folder);
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
    std::fs::remove_dir_all(&folder).expect("the folder of the test");
}
