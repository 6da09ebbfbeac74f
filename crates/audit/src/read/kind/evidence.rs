//! What a row says of what is known.

use crate::printed::Printed;
use crate::read::words::{named_figure, only_figure};
use crate::units;

/// Everything that a row says of what is known.
#[derive(Debug, Clone, Copy, Default)]
pub struct Evidence<'a> {
    /// Name, remarks and notes: true.
    pub words: &'a str,
    /// The title of the sheet.
    pub title: &'a str,
    /// The laboratory's columns of distribution and type.
    pub columns: &'a str,
    /// The ± column.
    pub used: Option<&'a Printed>,
    /// Words in the head of the ± column.
    pub used_head: &'a str,
    /// The column of the standard uncertainty.
    pub u: Option<&'a Printed>,
    /// The divisor.
    pub divisor: Option<f64>,
    /// Whether the head of its column calls it a coverage factor.
    pub divisor_is_factor: bool,
    /// The number of readings in a column of its own.
    pub readings: Option<f64>,
    /// Whether the ± column is what was used, and not what is stated.
    pub full: bool,
    /// Readings behind the reported value, where a note says it for all rows.
    pub mean_of: Option<f64>,
}

impl Evidence<'_> {
    /// The figure of the words for one of these keys. Beside a ± column, a figure that the words give to no key counts
    /// only where it looks like the one that was used.
    pub(super) fn figure(&self, keys: &[&str]) -> Option<Printed> {
        let used = self.used.filter(|_| self.full);
        let meant = |figure: &Printed| used.is_none_or(|used| resemble(figure.value, used.value));
        // `temperature ±0.5 °C` beside 0.6 µm is what the ± column was computed from. Where only u has a unit, what was
        // divided for it has the same.
        let unit_of_u = self.u.map_or("", |u| u.unit.as_str());
        let fits = |figure: &Printed| {
            let open = figure.unit.is_empty() || units::fraction(&figure.unit).is_some();
            let of = |used: &Printed| {
                let unit = match used.unit.as_str() {
                    "" => unit_of_u,
                    unit => unit,
                };
                unit.is_empty() || units::factor(&figure.unit, unit).is_some()
            };
            open || used.is_none_or(of)
        };
        named_figure(self.words, keys)
            .filter(&fits)
            .or_else(|| only_figure(self.words, keys).filter(fits).filter(meant))
    }

    /// The same, or else what was used.
    pub(super) fn figure_or_used(&self, keys: &[&str]) -> Option<Printed> {
        self.figure(keys).or_else(|| self.used.cloned())
    }

    /// Whether the standard uncertainty is the figure that was used, undivided.
    pub(super) fn u_is_used(&self) -> bool {
        let same = |(u, used): (&Printed, &Printed)| u.unit == used.unit && u.value == used.value;
        self.u.zip(self.used).is_some_and(same) || self.used.is_some() && self.divisor == Some(1.0)
    }
}

/// Whether two figures may be one that was copied: the same digits but for their order, a power of ten, or a factor of two.
fn resemble(a: f64, b: f64) -> bool {
    let digits = |x: f64| {
        let mut digits: Vec<u8> = format!("{:.5e}", x.abs())
            .bytes()
            .take_while(|c| *c != b'e')
            .collect();
        digits.retain(|c| c.is_ascii_digit() && *c != b'0');
        digits.sort_unstable();
        digits
    };
    [1.0, 2.0, 0.5]
        .iter()
        .any(|factor| digits(factor * a) == digits(b))
}
