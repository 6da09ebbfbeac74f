//! What the integration tests share: finding files, and keeping generated files fresh.

#![allow(dead_code, unused_imports, reason = "every test uses its own part")]

pub mod cases;
pub mod evaluation;
mod files;

pub use files::{assert_fresh, files, relative, root, stale};

/// Numbers that look random and are the same everywhere: sums of twelve uniform ones, less six.
pub struct Noise(pub u64);

impl Noise {
    /// Uniform between 0 and 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}
