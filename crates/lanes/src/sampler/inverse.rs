//! Draws through a quantile function.

use std::fmt;
use std::sync::Arc;

/// A quantile function: the value below which a fraction u lies.
#[derive(Clone)]
pub struct Inverse {
    quantile: Arc<dyn Fn(f64) -> f64 + Send + Sync>,
}

impl Inverse {
    pub(super) fn new(quantile: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Inverse {
        Inverse {
            quantile: Arc::new(quantile),
        }
    }

    pub(super) fn at(&self, u: f64) -> f64 {
        (self.quantile)(u)
    }
}

impl fmt::Debug for Inverse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Inverse")
    }
}

/// Equal where it is the same function.
impl PartialEq for Inverse {
    fn eq(&self, other: &Inverse) -> bool {
        Arc::ptr_eq(&self.quantile, &other.quantile)
    }
}
