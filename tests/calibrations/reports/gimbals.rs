//! The schedule of 65 positions in three gimbals: predicted, and as found.

use super::page::{Page, fixed, powers};
use super::{calibrated, common, fresh};
use gumption::calibrate::{load, plan};
use gumption::experiment::Purpose;

/// A coefficient and its standard uncertainty with the same number of decimals.
fn shown(value: f64, u: f64) -> String {
    let decimals = (2.0 - u.log10().ceil()).max(0.0) as usize;
    fixed(value, decimals)
}

/// `NAME = NUMBER` in the comments of the recording.
fn truth(name: &str) -> f64 {
    let path = common::root().join("experiments/gimbals-65-positions.csv");
    let text = std::fs::read_to_string(path).expect("the recording");
    let rest = text
        .split(&format!("{name} = "))
        .nth(1)
        .expect("a true value");
    let number = rest.split([',', ';']).next().expect("its end");
    number.parse().expect("a number")
}

#[test]
fn the_report_of_65_positions_is_fresh() {
    let path = common::root().join("experiments/gimbals-65-plan.toml");
    let schedule = load(&path, Purpose::Plan)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let planned = plan(&schedule).expect("a plan");
    let predicted = planned.figures.expect("all is determined");
    let found = calibrated("gimbals-65-positions.toml");
    let mut page = Page::new("Accelerometer triad in three gimbals: a schedule of 65 positions");
    page.paragraph(
        "The list of positions of CN 108982918 B is lost. This one is a design of our own: multiples of 45° of the three gimbal angles, chosen by exchange for the greatest determinant of the \
         information; `experiments/gimbals-65-positions.csv` has them. `gumption plan experiments/gimbals-65-plan.toml` predicts what they tell, for readings of 1000 pulses/s per gn \
         with a standard deviation of 0.005 pulses/s; `gumption calibrate experiments/gimbals-65-positions.toml` evaluates simulated readings of that scatter, which do not state it. All nineteen parameters, \
         those of the base and the gimbals among them, are found together by iterated least squares.",
    );
    page.paragraph(&format!(
        "Rank {} of {} parameters, condition number of the scaled equations {}; 195 readings.",
        planned.identifiability.rank,
        planned.identifiability.parameters,
        fixed(planned.identifiability.condition, 2),
    ));
    page.section("Predicted and found");
    let coefficients = &found.figures.coefficients;
    let rows: Vec<Vec<String>> = coefficients
        .iter()
        .zip(&predicted.coefficients)
        .map(|(one, predicted)| {
            let truth = truth(&one.name);
            vec![
                one.name.clone(),
                one.unit.typeset(),
                powers(predicted.u, 3),
                powers(one.u, 3),
                shown(one.value, one.u),
                shown(truth, one.u),
                fixed((one.value - truth) / one.u, 1),
                match one.p_value < 1e-4 {
                    true => "yes, p < 0.0001".to_owned(),
                    false => format!("p = {}", fixed(one.p_value, 4)),
                },
            ]
        })
        .collect();
    page.table(
        &[
            "coefficient",
            "unit",
            "u predicted:",
            "u found:",
            "value found:",
            "true value:",
            "(found − true)/u:",
            "significant?",
        ],
        &rows,
    );
    page.section("Covariance");
    page.paragraph("Predicted correlation coefficients beyond ±0.05; all others are smaller:");
    let v = &predicted.covariance;
    let mut pairs = Vec::new();
    for i in 0..v.nrows() {
        for j in 0..i {
            let r = v[(i, j)] / (v[(i, i)] * v[(j, j)]).sqrt();
            if r.abs() > 0.05 {
                let name = |place: usize| &predicted.coefficients[place].name;
                pairs.push(format!("r({}, {}) = {}", name(j), name(i), fixed(r, 2)));
            }
        }
    }
    page.list(&pairs);
    page.section("What gravity does not show");
    page.paragraph(
        "The azimuth of the base turns the triad about the vertical and changes no reading; it is no parameter. The tilt of the base about the outer axis and the zero of that axis' angle are one \
         parameter, `phi_x0`; the zero of the platform's angle is a turn of the triad against its accelerometer x, which defines the axes.",
    );
    fresh("gimbals-65-positions.md", &page.finish());
    assert_eq!(coefficients.len(), 19);
}
