//! What the sections of decisions have in common: rows, and probabilities in words.

use crate::number::{at_place, print, significant};
use gumption_format::document::Block;

/// Rows of a section: label and text.
#[derive(Default)]
pub(super) struct Rows(Vec<(String, String)>);

impl Rows {
    pub fn add(&mut self, label: &str, text: String) {
        self.0.push((label.to_string(), text));
    }

    /// The section with this title.
    pub fn under(self, title: String) -> Vec<Block> {
        vec![Block::Section(title), Block::Fields(self.0)]
    }
}

/// A probability in percent with two digits of whichever is smaller, it or its complement.
pub(super) fn chance(p: f64) -> String {
    /// Nearer to one than anybody can vouch for.
    const CERTAIN: f64 = 1e-6;
    let complement = 1.0 - p;
    if p > 0.5 && complement < CERTAIN {
        return "> 99.9999 %".to_string();
    }
    if p < CERTAIN {
        return "< 0.0001 %".to_string();
    }
    if p <= 0.5 {
        return format!("{} %", significant(100.0 * p, 2));
    }
    let place = libm::log10(100.0 * complement).floor() as i32 - 1;
    format!("{} %", print(&at_place(100.0 * p, place.min(0))))
}

/// `p_c = 92 %`, or `p_c > 99.9999 %`.
pub(super) fn related(symbol: &str, chance: &str) -> String {
    if chance.starts_with(['<', '>']) {
        format!("{symbol} {chance}")
    } else {
        format!("{symbol} = {chance}")
    }
}

#[cfg(test)]
mod tests {
    use super::{chance, related};

    #[test]
    fn probabilities_show_what_is_rare() {
        assert_eq!(chance(0.009_878), "0.99 %");
        assert_eq!(chance(0.113_340), "11 %");
        assert_eq!(chance(0.919_243), "91.9 %");
        assert_eq!(chance(0.989_01), "98.9 %");
        assert_eq!(chance(0.662_63), "66 %");
        assert_eq!(chance(1.0 - 1e-9), "> 99.9999 %");
        assert_eq!(chance(0.0), "< 0.0001 %");
        assert_eq!(related("p_c", &chance(1.0)), "p_c > 99.9999 %");
        assert_eq!(related("p_c", &chance(0.5)), "p_c = 50 %");
    }
}
