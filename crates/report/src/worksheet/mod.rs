//! The budget of a measurand as a sheet that calculates: a reader changes a cell and sees U change.
//!
//! Estimates, stated widths, divisors, ν and correlation coefficients may be changed. The value and the sensitivity
//! coefficients follow by the model itself where spreadsheets know its functions ([`model`]), and linearly elsewhere.

mod components;
mod model;
mod outcome;
mod writer;

use gumption_format::document::{Entry, Sheet, address};

use crate::{Report, symbol};
use writer::{ESTIMATE, EVALUATED, SENSITIVITY, Writer};

/// Sheets with more rows than this are read by nobody.
const MOST: usize = 200;

/// One sheet for each measurand that has an uncertainty and a budget of a readable size.
pub(super) fn sheets(report: &Report<'_>) -> Vec<Sheet> {
    let budget = report.budget;
    if budget.components.len() > MOST || budget.inputs.len() > MOST {
        return Vec::new();
    }
    let results = report.evaluation.results.iter().enumerate();
    results
        .filter(|(_, result)| result.gum.u > 0.0 && result.gum.u.is_finite())
        .map(|(m, _)| Writer::new(report, m).written())
        .collect()
}

impl<'a> Writer<'a> {
    fn written(mut self) -> Sheet {
        self.heading();
        let first = self.sheet.rows.len() + 3;
        let acting = self.report.budget.model.inputs_of(self.measurand);
        let acting = acting.iter().enumerate().filter(|(_, acts)| **acts);
        self.inputs = acting.map(|(i, _)| i).zip(first..).collect();
        // Rows refer to one another; their places are settled before any is written.
        let components_at = first + self.inputs.len() + 2;
        let components = components::Components::new(&self, components_at);
        let model_at = components.end() + outcome::rows(&self) + 2;
        let model = model::Model::new(&self, model_at);
        self.write_inputs(&components, model.as_ref());
        components.write(&mut self);
        let value = match &model {
            Some(model) => model.result(),
            None => self.linear_value(),
        };
        outcome::write(&mut self, &components, value);
        if let Some(model) = model {
            self.sheet.rows.resize(model_at, Vec::new());
            model.write(&mut self);
        }
        self.sheet
    }

    fn heading(&mut self) {
        let report = self.report;
        self.sheet.push(vec![Entry::Title(report.title())]);
        let note = self.words(
            "Cells on a coloured ground may be changed; the others follow.",
            "有底色的单元格可以修改，其余单元格随之变化。",
        );
        self.sheet.push(vec![note]);
        if !report.budget.following.is_empty() {
            let note = self.words(
                "Uncertainties that were stated relative to an estimate stay as evaluated when the estimate is changed.",
                "按估计值的相对值给出的不确定度不随估计值的修改而变化。",
            );
            self.sheet.push(vec![note]);
        }
        let equation = &report.budget.model.outputs()[self.measurand].equation;
        for line in equation.lines() {
            self.sheet.push(vec![Entry::Words(line.to_string())]);
        }
    }

    fn write_inputs(&mut self, components: &components::Components, model: Option<&model::Model>) {
        self.title("Inputs", "输入量");
        self.heads(&[
            ("quantity", "输入量"),
            ("estimate x", "估计值 x"),
            ("unit", "单位"),
            ("u(x)", "u(x)"),
            ("c = ∂y/∂x", "灵敏系数 c"),
            ("x as evaluated", "评定时的 x"),
            ("description", "说明"),
        ]);
        let gum = &self.report.evaluation.results[self.measurand].gum;
        for (n, (i, row)) in self.inputs.clone().into_iter().enumerate() {
            let (input, line) = (&self.report.budget.inputs[i], &gum.inputs[i]);
            let sensitivity = match model {
                Some(model) => Entry::formula(model.slope(n), line.sensitivity),
                None => Entry::Fixed(line.sensitivity),
            };
            let at = self.sheet.push(vec![
                Entry::Words(input.name.to_string()),
                Entry::Given(input.estimate),
                Entry::Words(symbol(&input.unit)),
                Entry::formula(components.of_input(i), line.u),
                sensitivity,
                Entry::Fixed(input.estimate),
                Entry::Words(input.description.clone().unwrap_or_default()),
            ]);
            debug_assert_eq!(at, row, "rows are where they were counted");
        }
    }

    /// y + Σ c·(x − x as evaluated).
    fn linear_value(&self) -> String {
        let (Some((_, first)), Some((_, last))) = (self.inputs.first(), self.inputs.last()) else {
            return String::new();
        };
        let y = self.report.evaluation.results[self.measurand].gum.estimate;
        let column = |c| format!("{}:{}", address(c, *first), address(c, *last));
        format!(
            "{y:?}+SUMPRODUCT({},{}-{})",
            column(SENSITIVITY),
            column(ESTIMATE),
            column(EVALUATED)
        )
    }
}
