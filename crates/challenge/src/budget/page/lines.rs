//! Lines above and below a table: rules, equipment, what is known of each row.

use super::super::laboratory::{Rounding, Rule};
use super::super::words::{plain, typed};
use super::cell::{Cell, Page, text};
use super::layout::Form;
use super::writer::Writer;

impl Writer<'_> {
    /// Title, model and rules.
    pub(super) fn opening(&self) -> Page {
        let mut page = Page {
            name: self.pick("Budget", "不确定度").into(),
            rows: vec![vec![text(self.budget.field.title.of(self.manner.chinese))]],
        };
        if self.manner.variant % 4 == 1 {
            self.procedure(&mut page);
        }
        page.rows.push(Vec::new());
        if self.manner.variant % 3 != 2 || !self.has_slopes() {
            let lead = if self.manner.chinese {
                "测量模型："
            } else {
                self.either(&["Model: ", "", "Measurement equation: "])
            };
            page.rows.push(vec![text(format!(
                "{lead}{} = {}",
                self.budget.field.measurand, self.budget.field.model
            ))]);
        }
        self.rules(&mut page);
        if self.manner.variant % 5 == 3 {
            self.equipment(&mut page);
        }
        page.rows.push(Vec::new());
        page
    }

    fn procedure(&self, page: &mut Page) {
        page.rows.push(vec![
            text(self.pick("Procedure", "依据")),
            text("QP-17 rev. 3"),
            Cell::Empty,
            text(self.pick("Prepared by", "编制")),
            text("J. Li"),
            text("2026-03-14"),
        ]);
    }

    fn rules(&self, page: &mut Page) {
        let mut say = |line: String| page.rows.push(vec![text(line)]);
        let items = &self.budget.items;
        if let Some((a, b, r)) = self.budget.correlation {
            let (a, b) = (items[a].blank.symbol, items[b].blank.symbol);
            say(match self.manner.chinese {
                true => format!("{a} 与 {b} 的相关系数 r = {r}，其余互不相关"),
                false => self.either(&["Correlation: r({a}, {b}) = {r}", "{a} and {b} are correlated with a coefficient of {r}; all other inputs are independent."])
                    .replace("{a}", a).replace("{b}", b).replace("{r}", &r.to_string()),
            });
        }
        match (self.budget.rule, self.manner.chinese) {
            (Rule::Two, false) => say(self
                .either(&[
                    "Coverage factor: k = 2",
                    "U = k·u_c with k = 2",
                    "The expanded uncertainty is stated with k = 2.",
                ])
                .into()),
            (Rule::Two, true) => say("取包含因子 k = 2".into()),
            (Rule::Student(p), false) => say(format!(
                "{} {} %",
                self.either(&[
                    "k from the t-distribution at ν_eff for",
                    "k is Student's t for the effective degrees of freedom, coverage probability"
                ]),
                100.0 * p
            )),
            (Rule::Student(p), true) => say(format!(
                "包含因子按有效自由度由 t 分布得到，p = {} %",
                100.0 * p
            )),
            (Rule::Rectangle, false) => {
                say("k = 1.65 where one rectangular contribution dominates, otherwise k = 2".into())
            }
            (Rule::Rectangle, true) => {
                say("若某一矩形分布分量占优，取 k = 1.65，否则 k = 2".into())
            }
        }
        match (self.budget.rounding, self.manner.chinese) {
            (Rounding::Unsaid, _) => {}
            (Rounding::Nearest, false) => say(self
                .either(&[
                    "U is rounded to the nearest value of two digits.",
                    "Rounding: to nearest, two significant digits",
                ])
                .into()),
            (Rounding::Nearest, true) => say("U 按四舍五入修约至两位有效数字".into()),
            (Rounding::Up, false) => say(self
                .either(&[
                    "U is always rounded up, to two digits.",
                    "Rounding: upwards only",
                ])
                .into()),
            (Rounding::Up, true) => say("U 只进不舍，保留两位有效数字".into()),
        }
        if let Some(cmc) = self.budget.cmc {
            say(format!("CMC: {} {}", plain(cmc, 2), self.budget.field.unit));
        }
    }

    fn equipment(&self, page: &mut Page) {
        let zh = self.manner.chinese;
        let cells = |said: [&str; 4]| said.into_iter().map(text).collect::<Vec<_>>();
        page.rows.push(Vec::new());
        page.rows.push(cells(if zh {
            ["设备名称", "型号", "编号", "有效期"]
        } else {
            ["Instrument", "Model", "Serial no.", "Valid until"]
        }));
        page.rows.push(cells(if zh {
            ["标准器", "XK-3", "0417", "2027-01-31"]
        } else {
            ["Standard", "XK-3", "0417", "2027-01-31"]
        }));
        page.rows.push(cells(if zh {
            ["温湿度计", "TH-9", "1188", "2026-11-30"]
        } else {
            ["Hygrometer", "TH-9", "1188", "2026-11-30"]
        }));
    }

    /// What is known of each row, below the table.
    pub(super) fn notes(&self, page: &mut Page) {
        page.rows.push(Vec::new());
        for (i, item) in self.budget.items.iter().enumerate() {
            let symbol = item.blank.symbol;
            let estimate = typed(item.blank.estimate);
            let unit = if item.blank.unit == "1" {
                ""
            } else {
                item.blank.unit
            };
            let lead = match (self.manner.form, self.manner.chinese) {
                (Form::Prose, false) => {
                    format!("{symbol} = {estimate} {unit}: {}, ", item.blank.name.0)
                }
                (Form::Prose, true) => {
                    format!("{symbol} = {estimate} {unit}：{}，", item.blank.name.1)
                }
                (_, false) => self
                    .either(&["{}: ", "Note to {}: ", "{} - "])
                    .replace("{}", symbol),
                (_, true) => format!("{symbol}："),
            };
            page.rows
                .push(vec![text(format!("{lead}{}", self.said(item, i)))]);
        }
    }

    /// Note and signature at the end of a sheet.
    pub(super) fn approval(&self, page: &mut Page) {
        page.rows.push(Vec::new());
        page.rows.push(vec![text(self.pick(
            "Note: rounding only after the calculation; valid for the range of the scope.",
            "注：本评定适用于认可范围内的测量。",
        ))]);
        page.rows.push(vec![
            text(self.pick("Approved", "批准")),
            text("M. Wagner"),
            text("2026-03-15"),
        ]);
    }
}
