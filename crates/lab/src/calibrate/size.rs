//! What a calibration takes of the machine, before it takes it.

use super::campaign::Campaign;
use super::stack::doubted;
use super::trouble::Trouble;
use crate::experiment::Scope;

/// No calibration takes more memory than this: half of what a machine of a laboratory has.
const MOST_BYTES: u64 = 8 << 30;

impl Campaign {
    /// Its readings, as far as the points have all of them.
    pub fn readings(&self) -> u64 {
        self.points.len() as u64 * self.experiment.equations.responses().len() as u64
    }

    /// About how many bytes its evaluation takes. For each reading there are its row of the equations, orthogonal and
    /// in twice the precision, and what follows from an error of it: for each coefficient, by what is observed and by
    /// each symbol that an error acts on, and once more as a cause; and the same for the omitted effects.
    pub fn bytes(&self) -> u64 {
        /// Values of a reading that do not depend on the equations: lines, rows, weights, residuals.
        const VALUES: usize = 24;
        /// Copies of a row of the equations.
        const ROWS: usize = 8;
        let parameters = self.experiment.parameters.len();
        let coefficients = parameters + self.results.len();
        let doubts = self.experiment.doubts.iter();
        let own = doubts.filter(|doubt| doubt.scope != Scope::Common).count();
        let responses = self.experiment.equations.responses().len();
        let gains = 2 * coefficients * (1 + doubted(self).len());
        let evaluations = match self.omitted.is_empty() {
            true => 1,
            false => 2,
        };
        let each =
            VALUES + coefficients * (own + responses) + evaluations * (ROWS * parameters + gains);
        self.readings() * each as u64 * size_of::<f64>() as u64
    }

    /// # Errors
    /// It takes more memory than a calibration may.
    pub(super) fn fits_into_memory(&self) -> Result<(), Trouble> {
        let bytes = self.bytes();
        match bytes <= MOST_BYTES {
            true => Ok(()),
            false => Err(Trouble::TooLarge {
                readings: self.readings(),
                bytes,
                most: MOST_BYTES,
            }),
        }
    }
}
