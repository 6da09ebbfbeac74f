//! What inputs have to do with one another.

use super::list::List;
use gumption_format::toml::{Dof, Matrix, table};

table! {
    /// Correlation of two quantities.
    CorrelationTable "[[correlation]]" {
        /// Two inputs, shared causes, or components such as `"V.calibration"`; of more names, every pair.
        between: List<String>,
        /// Correlation coefficient.
        r: f64,
        /// How it is known.
        reference: String,
    }
}

table! {
    /// Inputs that were measured together.
    JointTable "[[joint]]" {
        /// The inputs. Without a matrix, their readings were taken simultaneously.
        inputs: List<String>,
        /// Covariance matrix in the units of the inputs, row by row.
        covariance: Matrix,
        /// Correlation matrix, row by row; the inputs state their own uncertainties.
        correlation: Matrix,
        /// Degrees of freedom of the covariance matrix.
        dof: Dof,
        /// Where the matrix comes from.
        reference: String,
    }
}
