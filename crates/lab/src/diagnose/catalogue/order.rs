//! Whether the order of the rows says something.

use gumption_core::special::ln_gamma;

use super::fitted::FittedModel;
use crate::diagnose::case::{Column, Data, Observed, Role};

impl FittedModel<'_> {
    /// Whether the order of the rows says something that no column says: it was recorded, or the rows are neither
    /// sorted by a column nor those of runs and factors, which may stand in any order.
    pub fn is_ordered(&self) -> bool {
        let is_label = |role: Role| matches!(role, Role::Run | Role::Factor);
        let labelled = || (self.case().columns.iter()).any(|column| is_label(column.role));
        let sorted = |column: usize| is_sorted(&self.design.reduced(self.numbers(column)));
        let by_column = || self.numeric().into_iter().any(sorted);
        self.clock.column.is_some() || !(labelled() || by_column() || self.is_sorted_by_reading())
    }

    /// Whether rows of equal inputs are sorted by what was read, as a spreadsheet sorts them, by more than chance would: then a
    /// row has nothing to do with the next one.
    pub fn is_sorted_by_reading(&self) -> bool {
        let mut outputs = (self.case().responses.iter()).filter_map(|of| match of.observed {
            Observed::Column(column) => Some(column),
            Observed::Constant(_) => None,
        });
        let level = libm::log(self.case().settings.alpha);
        self.clock.column.is_none()
            && outputs.any(|column| self.log_sorted_by_chance(column) <= level)
    }

    /// Logarithm of the probability that readings stand in an ascending or a descending order under equal inputs by chance; 0 where
    /// they do not.
    fn log_sorted_by_chance(&self, output: usize) -> f64 {
        let readings = self.numbers(output);
        let inputs = self.case().columns.iter();
        let inputs: Vec<&Column> = inputs.filter(|column| is_input(column.role)).collect();
        let is_alike = |row: usize| inputs.iter().all(|column| is_as_before(column, row));
        // Where the rows of other inputs begin.
        let mut begins: Vec<usize> = (0..readings.len())
            .filter(|row| *row == 0 || !is_alike(*row))
            .collect();
        begins.push(readings.len());
        let groups = begins.windows(2).map(|pair| &readings[pair[0]..pair[1]]);
        let [rising, falling] = [f64::le, f64::ge].map(|is_next| {
            let in_order = |group: &[f64]| group.windows(2).all(|pair| is_next(&pair[0], &pair[1]));
            groups.clone().all(in_order)
        });
        match rising || falling {
            true => libm::log(2.0) - groups.map(log_orders).sum::<f64>(),
            false => 0.0,
        }
    }
}

fn is_sorted(numbers: &[f64]) -> bool {
    numbers.is_sorted() || numbers.iter().rev().is_sorted()
}

/// Whether it is neither what was read nor a property of that.
fn is_input(role: Role) -> bool {
    !matches!(role, Role::Output | Role::Uncertainty | Role::Count)
}

/// Whether a column holds the same as in the row before.
fn is_as_before(column: &Column, row: usize) -> bool {
    match &column.data {
        Data::Numbers(numbers) => numbers[row] == numbers[row - 1],
        Data::Labels(labels) => labels.of_row[row] == labels.of_row[row - 1],
        Data::Absent => true,
    }
}

/// Logarithm of the number of orders of sorted numbers, some of which may be equal: n!/∏mᵢ!.
fn log_orders(sorted: &[f64]) -> f64 {
    let ln_factorial = |n: usize| ln_gamma(n as f64 + 1.0);
    let equal = sorted.chunk_by(|a, b| a == b);
    ln_factorial(sorted.len()) - equal.map(|run| ln_factorial(run.len())).sum::<f64>()
}
