//! Markdown pages.

use std::fmt::Write;

/// A page that grows.
#[derive(Default)]
pub struct Page {
    text: String,
}

impl Page {
    pub fn new(title: &str) -> Page {
        Page {
            text: format!("# {title}\n"),
        }
    }

    pub fn section(&mut self, head: &str) {
        let _ = write!(self.text, "\n## {head}\n");
    }

    pub fn paragraph(&mut self, text: &str) {
        let _ = write!(self.text, "\n{text}\n");
    }

    /// A table; columns whose head ends with `:` are aligned right.
    pub fn table(&mut self, head: &[&str], rows: &[Vec<String>]) {
        let names: Vec<&str> = head.iter().map(|name| name.trim_end_matches(':')).collect();
        let rules: Vec<&str> = head
            .iter()
            .map(|name| if name.ends_with(':') { "---:" } else { "---" })
            .collect();
        let _ = write!(
            self.text,
            "\n| {} |\n| {} |\n",
            names.join(" | "),
            rules.join(" | ")
        );
        for row in rows {
            assert_eq!(row.len(), head.len(), "{row:?}");
            let _ = writeln!(self.text, "| {} |", row.join(" | "));
        }
    }

    pub fn list(&mut self, items: &[String]) {
        self.text.push('\n');
        for item in items {
            let _ = writeln!(self.text, "- {item}");
        }
    }

    pub fn finish(self) -> String {
        self.text
    }
}

/// With a number of decimals.
pub fn fixed(x: f64, decimals: usize) -> String {
    format!("{x:.decimals$}")
}

/// With a number of significant digits, in powers of ten: `1.41e-4`.
pub fn powers(x: f64, digits: usize) -> String {
    format!("{x:.*e}", digits - 1)
}

/// Mean, experimental standard deviation and range.
pub fn statistics(values: &[f64]) -> (f64, f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    (mean, (squares / (n - 1.0)).sqrt(), most - least)
}

/// An estimate to the second digit of its uncertainty.
pub fn estimate(x: f64, u: f64) -> String {
    let place = u.log10().floor() as i32 - 1;
    match place {
        0.. => format!("{x:.0}"),
        -7..0 => fixed(x, place.unsigned_abs() as usize),
        _ => {
            let leading = x.abs().log10().floor() as i32;
            powers(x, (leading - place).max(0) as usize + 1)
        }
    }
}
