//! Draws from lists of values.

use std::sync::Arc;

/// Element number ⌊u·n⌋.
pub(super) fn element<T: Copy>(list: &[T], u: f64) -> Option<T> {
    // u·n may round up to n.
    let last = list.len().checked_sub(1)?;
    list.get(((u * list.len() as f64) as usize).min(last))
        .copied()
}

/// Walker's alias method: one uniform number chooses a column and, within it, one of two values.
#[derive(Debug, Clone, PartialEq)]
pub struct AliasTable {
    columns: Arc<[Column]>,
}

/// Column i of n covers the uniform numbers i/n … (i + 1)/n.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Column {
    /// Taken below the split.
    value: f64,
    /// Taken above.
    alias: f64,
    /// The place of the split within the column, 0 … 1.
    split: f64,
}

impl AliasTable {
    /// Vose's construction: columns below the average are filled up from those above it.
    pub(super) fn new(values: &[f64], probabilities: &[f64]) -> AliasTable {
        let total: f64 = probabilities.iter().sum();
        let count = values.len() as f64;
        let mut shares: Vec<f64> = probabilities.iter().map(|p| p * count / total).collect();
        let mut columns: Vec<Column> = values
            .iter()
            .map(|&value| Column {
                value,
                alias: value,
                split: 1.0,
            })
            .collect();
        let (mut poor, mut rich): (Vec<usize>, Vec<usize>) =
            (0..columns.len().min(shares.len())).partition(|&i| shares[i] < 1.0);
        while let (Some(&giver), Some(taker)) = (rich.last(), poor.pop()) {
            columns[taker].alias = columns[giver].value;
            columns[taker].split = shares[taker];
            shares[giver] -= 1.0 - shares[taker];
            if shares[giver] < 1.0 {
                rich.pop();
                poor.push(giver);
            }
        }
        AliasTable {
            columns: columns.into(),
        }
    }

    pub(super) fn at(&self, u: f64) -> f64 {
        let Some(column) = element(&self.columns, u) else {
            return f64::NAN;
        };
        let scaled = u * self.columns.len() as f64;
        if scaled - scaled.floor() < column.split {
            column.value
        } else {
            column.alias
        }
    }
}
