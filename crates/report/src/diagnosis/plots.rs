//! Residuals before and after, over the time or the rows and over each stimulus.

use nalgebra::DVector;

use crate::language::Language;
use crate::symbol;
use gumption_format::document::{Axis, Layer, Marks, Panel, Plot, Tone};
use gumption_lab::diagnose::Diagnosis;
use gumption_lab::diagnose::case::{Case, Response, Role};

/// One plot for each column that the residuals may follow.
pub(super) fn plots(case: &Case, diagnosis: &Diagnosis, l: Language) -> Vec<Plot> {
    let mut plots = Vec::new();
    let mut over = |name: &str, axis: Axis, numbers: &[f64]| {
        let means = diagnosis.blocks.iter().map(|rows| {
            let sum: f64 = rows.iter().map(|row| numbers[*row]).sum();
            sum / rows.len() as f64
        });
        let panels = panels(case, diagnosis, &axis, &means.collect::<Vec<_>>(), l);
        plots.push(Plot::new(&format!("residuals_{name}"), panels));
    };
    if case.with_role(Role::Time).next().is_none() {
        let numbers: Vec<f64> = (1..=case.rows).map(|row| row as f64).collect();
        over("row", Axis::linear(l.pick("row", "行"), ""), &numbers);
    }
    for column in &case.columns {
        let shown = matches!(
            column.role,
            Role::Time | Role::Order | Role::Stimulus | Role::Angle | Role::Covariate
        );
        if let (true, Some(numbers)) = (shown, column.numbers()) {
            let axis = Axis::linear(column.name.as_str(), symbol(&column.unit));
            over(&column.name, axis, numbers);
        }
    }
    plots
}

/// A panel for each response: what is left before and after, on one scale.
fn panels(case: &Case, diagnosis: &Diagnosis, x: &Axis, at: &[f64], l: Language) -> Vec<Panel> {
    let adopted = diagnosis.adopted.as_ref();
    let panel = |(response, declared): (usize, &Response)| {
        let points = |residuals: &DVector<f64>| {
            let own = residuals.rows(response * at.len(), at.len());
            let points = at.iter().zip(own.iter()).map(|(x, y)| [*x, *y]);
            Marks::data(points.collect())
        };
        let before = l.pick("with the declared model", "声明的模型");
        let after = l.pick("with the physics that was left out", "加入遗漏效应后");
        let mut layers = vec![Layer::new("", Tone::Quiet, Marks::Level(0.0))];
        layers.push(Layer::new(
            before,
            Tone::Contrast,
            points(&diagnosis.fit.residuals),
        ));
        layers.extend(adopted.map(|one| Layer::new(after, Tone::Main, points(&one.fit.residuals))));
        Panel {
            title: match adopted {
                Some(_) => l.pick("Residuals before and after", "加入效应前后的残差"),
                None => l.pick("Residuals of the declared model", "声明的模型的残差"),
            }
            .to_owned(),
            x: x.clone(),
            y: Axis::linear(declared.name.as_str(), symbol(&declared.unit)),
            layers,
        }
    };
    case.responses.iter().enumerate().map(panel).collect()
}
