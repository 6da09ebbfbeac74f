//! Who writes a page: the budget, the working, and the manner of it.

use super::super::laboratory::{Budget, Item, Rule};
use super::super::statement::said;
use super::super::words::{Said, plain};
use super::super::working::{Figures, Working};
use super::cell::{Cell, exact, text};
use super::layout::{Form, Manner};

pub(super) struct Writer<'a> {
    pub budget: &'a Budget,
    pub working: &'a Working,
    pub figures: &'a Figures,
    pub manner: Manner,
}

impl Writer<'_> {
    pub(super) fn pick(&self, en: &'static str, zh: &'static str) -> &'static str {
        Said(en, zh).of(self.manner.chinese)
    }

    pub(super) fn either<'b>(&self, ways: &[&'b str]) -> &'b str {
        ways[self.manner.variant % ways.len()]
    }

    /// Whether the page has a column of coefficients.
    pub(super) fn has_slopes(&self) -> bool {
        self.manner.form != Form::Prose
    }

    /// What a row says of what is known.
    pub(super) fn said(&self, item: &Item, i: usize) -> String {
        let zh = self.manner.chinese;
        let unit = if item.blank.unit == "1" {
            ""
        } else {
            item.blank.unit
        };
        let words = said(item.known, unit, zh, self.manner.variant + i);
        let words = words
            .replace("  ", " ")
            .replace(" ,", ",")
            .replace(" ;", ";");
        if item.contained {
            let why = self.pick(
                "already contained in the repeatability (s ≥ half a step), not counted",
                "已包含在重复性中（s 大于半个步进），不再计入",
            );
            format!("{}; {why}", words.trim())
        } else {
            words.trim().to_string()
        }
    }

    pub(super) fn u_c(&self) -> String {
        let text = || plain(self.figures.u_c, self.manner.digits.max(3));
        self.figures.u_c_text.clone().unwrap_or_else(text)
    }

    pub(super) fn has_nu(&self) -> bool {
        matches!(self.budget.rule, Rule::Student(_)) || self.manner.variant % 7 == 1
    }

    pub(super) fn nu_eff(&self) -> Cell {
        if self.figures.nu_eff.is_finite() {
            exact(self.figures.nu_eff)
        } else {
            text("∞")
        }
    }

    pub(super) fn expanded_unit(&self) -> &'static str {
        if self.working.wrong_unit {
            wrong(self.budget.field.unit)
        } else {
            self.budget.field.unit
        }
    }
}

/// A unit a thousand times as large or small.
fn wrong(unit: &str) -> &'static str {
    match unit {
        "g" => "mg",
        "V" => "mV",
        "Ω" => "mΩ",
        "Pa" => "kPa",
        "mm" => "µm",
        "mV/g" => "V/g",
        "°C" => "mK",
        _ => "mN·m",
    }
}
