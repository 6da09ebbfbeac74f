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
