//! The model in cells: one row for each step of the calculation, one column at the estimates and two for each input, at
//! which it is a little larger and smaller. The slopes between these are the sensitivity coefficients (GUM 5.1.4).

use gumption_core::model::{Operand, Steps};
use gumption_format::document::{Entry, address};

use super::writer::{ESTIMATE, INPUT_U, Writer};

/// Columns of formulas are read while there are so many inputs.
const MOST_INPUTS: usize = 40;
/// And so many steps.
const MOST_STEPS: usize = 200;

/// By which part of u an input is made larger and smaller. Slopes are then wrong by a few parts of 10⁻⁵·(u/x)² for smooth
/// functions, and by 10⁻¹⁴·y/(c·u) by the digits that a spreadsheet keeps.
const PART: f64 = 0.01;

/// Slopes may differ from the derivatives by this part of u(y), which no figure shows.
const TOLERANCE: f64 = 1e-6;

/// The model of a measurand in cells.
pub(super) struct Model {
    at: usize,
    /// Inputs, each with the row of its estimate and the values at all points.
    inputs: Vec<(usize, usize)>,
    names: Vec<String>,
    points: Vec<Vec<f64>>,
    steps: Steps,
}

impl Model {
    /// Where every step has a formula, and its slopes are the derivatives.
    pub(super) fn new(writer: &Writer<'_>, at: usize) -> Option<Model> {
        let report = writer.report;
        let gum = &report.evaluation.results[writer.measurand].gum;
        if writer.inputs.len() > MOST_INPUTS {
            return None;
        }
        let centre: Vec<f64> = report.budget.inputs.iter().map(|i| i.estimate).collect();
        let mut points = vec![centre.clone()];
        for (i, _) in &writer.inputs {
            for sign in [1.0, -1.0] {
                let mut point = centre.clone();
                point[*i] += sign * PART * gum.inputs[*i].u;
                points.push(point);
            }
        }
        let steps = report.budget.model.steps(writer.measurand, &points)?;
        let short = (1..=MOST_STEPS).contains(&steps.steps.len());
        let model = Model {
            at,
            inputs: writer.inputs.clone(),
            names: report
                .budget
                .inputs
                .iter()
                .map(|i| i.name.to_string())
                .collect(),
            points,
            steps,
        };
        let values = model.values()?;
        let right = model.inputs.iter().enumerate().all(|(n, (i, _))| {
            let (u, c) = (gum.inputs[*i].u, gum.inputs[*i].sensitivity);
            let difference = values[2 * n + 1] - values[2 * n + 2];
            // Where u is zero there is no slope to be found; c is shown as nothing then.
            let effect = (difference / (2.0 * PART) - c * u).abs();
            u > 0.0 && effect <= TOLERANCE * gum.u
        });
        (short && right).then_some(model)
    }

    /// The result at every point.
    fn values(&self) -> Option<&[f64]> {
        match self.steps.result {
            Operand::Step(last) => Some(&self.steps.steps[last].values),
            _ => None,
        }
    }

    fn input_row(&self, n: usize) -> usize {
        self.at + 3 + n
    }

    fn step_row(&self, n: usize) -> usize {
        self.input_row(self.inputs.len()) + n
    }

    fn operand(&self, of: Operand, column: usize) -> String {
        match of {
            Operand::Input(i) => {
                let n = self.inputs.iter().position(|(input, _)| *input == i);
                address(column, self.input_row(n.unwrap_or(0)))
            }
            Operand::Step(n) => address(column, self.step_row(n)),
            Operand::Number(x) if x < 0.0 => format!("({x:?})"),
            Operand::Number(x) => format!("{x:?}"),
        }
    }

    /// The cell of the value at the estimates.
    pub(super) fn result(&self) -> String {
        self.operand(self.steps.result, 1)
    }

    /// The slope along the n-th input.
    pub(super) fn slope(&self, n: usize) -> String {
        let column = 2 + 2 * n;
        let [above, below] = [column, column + 1].map(|c| self.operand(self.steps.result, c));
        let row = self.input_row(n);
        let [right, left] = [column, column + 1].map(|c| address(c, row));
        format!("IF({right}={left},0,({above}-{below})/({right}-{left}))")
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>) {
        writer.title("The model, step by step", "测量模型的逐步计算");
        let mut heads = vec![
            Entry::Head(writer.word("step", "步骤")),
            Entry::Head(writer.word("at the estimates", "在估计值处")),
        ];
        for (i, _) in &self.inputs {
            for sign in ["+", "−"] {
                heads.push(Entry::Head(format!("{} {sign} u/100", self.names[*i])));
            }
        }
        writer.sheet.push(heads);
        for (n, (i, row)) in self.inputs.iter().enumerate() {
            let (x, u) = (address(ESTIMATE, *row), address(INPUT_U, *row));
            let mut cells = vec![Entry::Words(self.names[*i].clone())];
            for (column, point) in self.points.iter().enumerate() {
                let formula = match column {
                    c if c == 2 * n + 1 => format!("{x}+{u}/100"),
                    c if c == 2 * n + 2 => format!("{x}-{u}/100"),
                    _ => x.clone(),
                };
                cells.push(Entry::formula(formula, point[*i]));
            }
            writer.sheet.push(cells);
        }
        for (n, step) in self.steps.steps.iter().enumerate() {
            let mut cells = vec![Entry::Words(self.said(n))];
            for (column, value) in step.values.iter().enumerate() {
                let formula = step.written(|of| self.operand(of, column + 1));
                cells.push(Entry::formula(formula, *value));
            }
            writer.sheet.push(cells);
        }
    }

    /// A step in the names of the inputs and of earlier steps.
    fn said(&self, n: usize) -> String {
        let said = self.steps.steps[n].written(|of| match of {
            Operand::Input(i) => self.names[i].clone(),
            Operand::Step(step) => format!("[{}]", step + 1),
            Operand::Number(x) => format!("{x}"),
        });
        format!("[{}] {said}", n + 1)
    }
}
