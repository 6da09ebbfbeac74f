//! The trials themselves, kept for order statistics.

use super::moments::Moments;

/// Keeps every model value, one column per output, in trial order.
#[derive(Debug, Default)]
pub(super) struct Store {
    columns: Vec<Vec<f64>>,
    /// Per chunk, per output.
    moments: Vec<Vec<Moments>>,
}

impl Store {
    /// An empty store for some outputs.
    pub(super) fn new(outputs: usize) -> Self {
        Store {
            columns: vec![Vec::new(); outputs],
            moments: Vec::new(),
        }
    }

    /// Makes room for so many further trials and gives the new places of every column.
    pub(super) fn extend(&mut self, trials: usize) -> Vec<&mut [f64]> {
        let add = |column: &mut Vec<f64>| {
            let before = column.len();
            if before == 0 {
                // Memory that the system hands out as zeros need not be written here.
                *column = vec![0.0; trials];
            } else {
                column.resize(before + trials, 0.0);
            }
            before
        };
        let extended = self.columns.iter_mut().map(|column| {
            let before = add(column);
            &mut column[before..]
        });
        extended.collect()
    }

    /// Adds the moments of the next chunks.
    pub(super) fn add_moments(&mut self, chunks: Vec<Vec<Moments>>) {
        self.moments.extend(chunks);
    }

    /// Trials so far, failed ones included.
    pub(super) fn trials(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// The model values in trial order, failed ones as they came.
    pub(super) fn columns(&self) -> &[Vec<f64>] {
        &self.columns
    }

    /// Moments of one output over all chunks, merged in chunk order; `None` before the first chunk.
    pub(super) fn moments(&self, output: usize) -> Option<Moments> {
        self.moments_of_chunks(output, 0, self.moments.len())
    }

    /// Moments of one output over the chunks `from..to`.
    pub(super) fn moments_of_chunks(
        &self,
        output: usize,
        from: usize,
        to: usize,
    ) -> Option<Moments> {
        let chunks = self.moments.get(from..to)?;
        chunks
            .iter()
            .map(|chunk| chunk[output])
            .reduce(|a, b| a.merge(&b))
    }

    /// Forgets all but the first `chunks` chunks, which hold `trials` trials.
    pub(super) fn truncate(&mut self, chunks: usize, trials: usize) {
        self.moments.truncate(chunks);
        for column in &mut self.columns {
            column.truncate(trials);
        }
    }

    /// Gives the columns away.
    pub(super) fn into_columns(self) -> Vec<Vec<f64>> {
        self.columns
    }
}
