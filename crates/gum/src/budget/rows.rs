//! Budgets that differ in numbers alone, as columns.

use super::Budget;
use gumption_lanes::{Block, LANES};

/// 256 rows: what differs between them.
#[derive(Debug, Clone)]
pub struct Rows {
    /// x of each input.
    pub estimates: Vec<Block>,
    /// u of each component.
    pub u: Vec<Block>,
    /// ν of each component.
    pub dof: Vec<Block>,
}

impl Rows {
    /// The numbers of a budget in every row.
    pub fn of(budget: &Budget) -> Rows {
        let all = |x: f64| Block([x; LANES]);
        Rows {
            estimates: budget.inputs.iter().map(|one| all(one.estimate)).collect(),
            u: budget.components.iter().map(|one| all(one.u)).collect(),
            dof: budget.components.iter().map(|one| all(one.dof)).collect(),
        }
    }
}
