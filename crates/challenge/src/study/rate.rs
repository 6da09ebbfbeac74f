//! How often something happened.

use gumption_core::special::inverse_beta_regularized;

/// Successes out of a number of trials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rate {
    /// How often it happened.
    pub hits: usize,
    /// How often it could have.
    pub of: usize,
}

impl Rate {
    /// Counts items for which a condition holds.
    pub fn count<T>(items: impl IntoIterator<Item = T>, holds: impl Fn(&T) -> bool) -> Rate {
        let mut rate = Rate::default();
        for item in items {
            rate.of += 1;
            rate.hits += usize::from(holds(&item));
        }
        rate
    }

    /// The share; NaN without trials.
    pub fn share(self) -> f64 {
        self.hits as f64 / self.of as f64
    }

    /// The exact 95 % interval of Clopper and Pearson (1934).
    pub fn interval(self) -> (f64, f64) {
        let (hits, misses) = (self.hits as f64, (self.of - self.hits.min(self.of)) as f64);
        let low = if self.hits == 0 {
            0.0
        } else {
            inverse_beta_regularized(hits, misses + 1.0, 0.025)
        };
        let high = if self.hits >= self.of {
            1.0
        } else {
            inverse_beta_regularized(hits + 1.0, misses, 0.975)
        };
        (low, high)
    }
}

impl std::fmt::Display for Rate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.of == 0 {
            return f.write_str("–");
        }
        let (low, high) = self.interval();
        write!(
            f,
            "{:.1} % ({}/{}; {:.1}–{:.1})",
            100.0 * self.share(),
            self.hits,
            self.of,
            100.0 * low,
            100.0 * high
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_tables() {
        // Clopper–Pearson at 95 %: 0 of 10 → (0, 0.3085), 5 of 10 → (0.1871, 0.8129).
        let (low, high) = Rate { hits: 0, of: 10 }.interval();
        assert!(low == 0.0 && (high - 0.3085).abs() < 1e-4);
        let (low, high) = Rate { hits: 5, of: 10 }.interval();
        assert!((low - 0.1871).abs() < 1e-4 && (high - 0.8129).abs() < 1e-4);
        assert_eq!(Rate { hits: 3, of: 3 }.interval().1, 1.0);
        assert_eq!(Rate::default().to_string(), "–");
    }
}
