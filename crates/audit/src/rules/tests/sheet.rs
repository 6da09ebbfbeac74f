//! A sheet that is right, as it is computed, and changes of it.

use super::super::findings;
use crate::read::Mapping;
use crate::{audit, read, sheet};

/// A row: symbol, estimate, what is known, what was used, divisor, c, ν, distribution.
#[derive(Clone)]
pub(super) struct Line {
    pub(super) symbol: &'static str,
    pub(super) estimate: &'static str,
    pub(super) known: &'static str,
    pub(super) used: f64,
    pub(super) divisor: f64,
    pub(super) c: f64,
    pub(super) nu: &'static str,
    pub(super) distribution: &'static str,
    pub(super) counted: bool,
}

/// Symbol, estimate, what is known, ν and distribution; what was used, divisor and c.
pub(super) fn line(texts: [&'static str; 5], [used, divisor, c]: [f64; 3]) -> Line {
    let [symbol, estimate, known, nu, distribution] = texts;
    Line {
        symbol,
        estimate,
        known,
        used,
        divisor,
        c,
        nu,
        distribution,
        counted: true,
    }
}

/// A sheet as it is computed, with everything that a right one has.
pub(super) struct Sheet {
    pub(super) title: &'static str,
    pub(super) notes: Vec<&'static str>,
    pub(super) lines: Vec<Line>,
    pub(super) y: &'static str,
    pub(super) linear: bool,
    pub(super) r: Option<(usize, usize, f64)>,
    pub(super) k: f64,
    pub(super) power: i32,
    pub(super) more: &'static str,
    /// Texts that are replaced in the finished sheet.
    pub(super) replaced: Vec<(&'static str, &'static str)>,
}

pub(super) fn right() -> Sheet {
    let root3 = libm::sqrt(3.0);
    Sheet {
        title: "Calibration of a 100 g weight",
        notes: vec![
            "Model: m = m_S + dm + dr + dd",
            "Coverage factor k = 2 for a coverage probability of 95 %",
        ],
        lines: vec![
            line(
                [
                    "m_S",
                    "100.0005 g",
                    "certificate M-12: U = 0.0400 g and k = 2",
                    "inf",
                    "normal",
                ],
                [0.04, 2.0, 1.0],
            ),
            line(
                [
                    "dm",
                    "0.0021 g",
                    "standard deviation s = 0.0200 g of 10 readings; mean of 5 reported",
                    "9",
                    "normal",
                ],
                [0.02, libm::sqrt(5.0), 1.0],
            ),
            line(
                [
                    "dr",
                    "0 g",
                    "digital step of the indication 0.010 g",
                    "inf",
                    "rectangular",
                ],
                [0.005, root3, 1.0],
            ),
            line(
                [
                    "dd",
                    "0 g",
                    "drift of the standard; limits ±0.0300 g",
                    "inf",
                    "rectangular",
                ],
                [0.03, root3, 1.0],
            ),
        ],
        y: "100.003 g",
        linear: false,
        r: None,
        k: 2.0,
        power: 1,
        more: "",
        replaced: Vec::new(),
    }
}

fn printed(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    let places = (3 - libm::floor(libm::log10(x.abs())) as i32).max(0) as usize;
    format!("{x:.places$}")
}

impl Sheet {
    pub(super) fn text(&self) -> String {
        let parts: Vec<f64> = self
            .lines
            .iter()
            .map(|l| {
                if l.counted {
                    l.c * l.used / l.divisor
                } else {
                    0.0
                }
            })
            .collect();
        let mut squares: f64 = parts.iter().map(|x| x * x).sum();
        if let Some((a, b, r)) = self.r {
            squares += 2.0 * r * parts[a] * parts[b];
        }
        let u_c = if self.linear {
            parts.iter().map(|x| x.abs()).sum()
        } else {
            libm::sqrt(squares)
        };
        let expanded = libm::pow(self.k, f64::from(self.power)) * u_c;
        let mut text = format!(
            "{}\n{}\nSymbol|Estimate|What is known|± a|Distribution|Divisor|u(x_i)|c_i|u_i(y) / g|ν_i|Share %\n",
            self.title,
            self.notes.join("\n")
        );
        for (line, part) in self.lines.iter().zip(&parts) {
            let u = line.used / line.divisor;
            text += &format!(
                "{}|{}|{}|{}|{}|{:.4}|{}|{}|{}|{}|{:.1} %\n",
                line.symbol,
                line.estimate,
                line.known,
                line.used,
                line.distribution,
                line.divisor,
                printed(u),
                line.c,
                printed(line.c * u),
                line.nu,
                100.0 * part * part / (u_c * u_c)
            );
        }
        let digits = (1 - libm::floor(libm::log10(expanded)) as i32).max(0) as usize;
        text += &format!(
            "u_c = {} g\nk = {}\nU = {expanded:.digits$} g\nResult: m = {}\n{}\n",
            printed(u_c),
            self.k,
            self.y,
            self.more
        );
        for (from, to) in &self.replaced {
            assert!(text.contains(from), "{from} in\n{text}");
            text = text.replacen(from, to, 1);
        }
        text
    }

    pub(super) fn rules(&self) -> Vec<u8> {
        let text = self.text();
        let grids = sheet::grids("sheet.txt", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        assert_eq!(claims.len(), 1, "{text}");
        let found = audit(&claims[0]).found;
        findings(&found)
            .iter()
            .map(|finding| finding.rule)
            .collect()
    }
}

pub(super) fn with(change: impl FnOnce(&mut Sheet)) -> Sheet {
    let mut sheet = right();
    change(&mut sheet);
    sheet
}

pub(super) fn replaced(from: &'static str, to: &'static str) -> Sheet {
    with(|sheet| sheet.replaced = vec![(from, to)])
}

pub(super) fn row(place: usize, change: impl FnOnce(&mut Line)) -> Sheet {
    with(|sheet| change(&mut sheet.lines[place]))
}

/// The row of the drift with another knowledge.
pub(super) fn known(
    known: &'static str,
    used: f64,
    divisor: f64,
    distribution: &'static str,
) -> Sheet {
    row(3, |line| {
        (line.known, line.used, line.divisor, line.distribution) =
            (known, used, divisor, distribution)
    })
}

/// A right sheet with a line more.
pub(super) fn noted(note: &'static str) -> Sheet {
    with(|sheet| sheet.notes.push(note))
}
