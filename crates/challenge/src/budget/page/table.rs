//! The table of a page: heads and cells.

use super::super::laboratory::Item;
use super::super::quantity::Divisor;
use super::super::words::{plain, typed};
use super::cell::{Cell, Page, exact, figure, text};
use super::layout::{Column, Form};
use super::writer::Writer;
use Column::*;

impl Writer<'_> {
    pub(super) fn table(&self, page: &mut Page, columns: &[Column]) {
        page.rows.push(
            columns
                .iter()
                .map(|column| text(self.head(*column)))
                .collect(),
        );
        if self.manner.form == Form::TwoHeads {
            let unit = self.budget.field.unit;
            page.rows.push(
                columns
                    .iter()
                    .map(|column| match column {
                        Contribution => text(format!("({unit})")),
                        Nu | C | Divisor => text("-"),
                        _ => Cell::Empty,
                    })
                    .collect(),
            );
        }
        let groups = self.manner.form == Form::Groups;
        let mut group = None;
        for (i, item) in self.budget.items.iter().enumerate() {
            if !self.working.lines[i].listed {
                continue;
            }
            if groups && group != Some(item.known.is_type_a()) {
                group = Some(item.known.is_type_a());
                let (en, zh) = if item.known.is_type_a() {
                    ("Type A evaluation", "A 类评定")
                } else {
                    ("Type B evaluation", "B 类评定")
                };
                page.rows.push(vec![text(self.pick(en, zh))]);
            }
            let row = page.rows.len() + 1;
            page.rows.push(
                columns
                    .iter()
                    .map(|column| self.cell(*column, columns, i, item, row))
                    .collect(),
            );
        }
    }

    fn head(&self, column: Column) -> String {
        let zh = self.manner.chinese;
        let unit = self.budget.field.unit;
        let one = |en: &[&str], cn: &[&str]| self.either(if zh { cn } else { en }).to_string();
        let with_unit = self.manner.variant.is_multiple_of(2) && self.manner.form != Form::TwoHeads;
        let unit_of = |name: String| {
            if with_unit {
                self.either(&["{} / {u}", "{} ({u})", "{} [{u}]"])
                    .replace("{}", &name)
                    .replace("{u}", unit)
            } else {
                name
            }
        };
        match column {
            Number => one(&["No."], &["序号"]),
            Symbol => one(
                &["Quantity X_i", "Symbol", "Quantity"],
                &["输入量", "符号", "量的符号"],
            ),
            Name => one(
                &["Source of uncertainty", "Component", "Description"],
                &["不确定度来源", "名称", "影响量"],
            ),
            Estimate => one(
                &["Estimate x_i", "Value", "Nominal value"],
                &["估计值 x_i", "估计值", "输入量的值"],
            ),
            Unit => one(&["Unit"], &["单位"]),
            Type => one(&["Type", "Type A/B"], &["评定方法", "类别"]),
            Used => one(
                &["Value ±", "Half-width", "± a"],
                &["半宽 a", "区间半宽", "误差限"],
            ),
            Distribution => one(
                &["Probability distribution", "Distribution", "Distr."],
                &["概率分布", "分布"],
            ),
            Divisor => one(
                &["Divisor", "Divisor k", "Div."],
                &["包含因子 k", "除数", "k"],
            ),
            U => one(
                &["Standard uncertainty u(x_i)", "u(x_i)", "Std. uncertainty"],
                &["标准不确定度 u(x_i)", "标准不确定度"],
            ),
            C => one(
                &["Sensitivity coefficient c_i", "c_i", "Sensitivity"],
                &["灵敏系数 c_i", "灵敏系数"],
            ),
            Contribution => unit_of(one(
                &[
                    "Uncertainty contribution u_i(y)",
                    "u_i(y)",
                    "c_i·u(x_i)",
                    "|c_i| u(x_i)",
                ],
                &[
                    "不确定度分量 u_i(y)",
                    "标准不确定度分量 |c_i|u(x_i)",
                    "分量",
                ],
            )),
            Square => one(&["u_i²(y)", "(c·u)²"], &["u_i²(y)"]),
            Share => one(&["Share %", "Index", "Contribution %"], &["贡献率 %"]),
            Nu => one(
                &["Degrees of freedom ν_i", "ν_i", "dof"],
                &["自由度 ν_i", "自由度"],
            ),
            Known => one(
                &["What is known", "Information", "Remarks"],
                &["已知信息", "依据", "说明"],
            ),
        }
    }

    fn cell(&self, column: Column, columns: &[Column], i: usize, item: &Item, row: usize) -> Cell {
        let line = &self.working.lines[i];
        let zh = self.manner.chinese;
        let digits = self.manner.digits;
        let counted = !item.contained || line.summed;
        let letter = |column: Column| {
            columns
                .iter()
                .position(|c| *c == column)
                .map(|at| char::from(b'A' + at as u8))
        };
        let with_formula = |x: f64, formula: Option<String>| {
            Cell::Figure(
                plain(x, digits),
                x,
                formula.filter(|_| self.manner.formulas),
            )
        };
        match column {
            Number => text((i + 1).to_string()),
            Symbol => text(item.blank.symbol),
            Name => text(item.blank.name.of(zh)),
            Estimate => {
                let shown = typed(item.blank.estimate);
                let with_unit = item.blank.unit != "1" && self.manner.form != Form::Jjf;
                if with_unit && !columns.contains(&Unit) {
                    text(format!("{shown} {}", item.blank.unit))
                } else {
                    exact(item.blank.estimate)
                }
            }
            Unit => text(item.blank.unit),
            Type => text(if item.known.is_type_a() { "A" } else { "B" }),
            Used => Cell::Figure(significant(line.step.used), line.step.used, None),
            Distribution => text(item.known.distribution().of(zh)),
            Divisor => match line.step.divisor {
                Divisor::Root(1.0) => exact(1.0),
                Divisor::Root(n) if !self.manner.formulas => text(format!("√{n}")),
                Divisor::Root(n) => Cell::Figure(
                    plain(libm::sqrt(n), 4),
                    libm::sqrt(n),
                    Some(format!("SQRT({n})")),
                ),
                Divisor::Number(n) => Cell::Figure(typed(libm::round(n * 1e4) / 1e4), n, None),
            },
            U => with_formula(
                self.figures.u[i],
                letter(Used)
                    .zip(letter(Divisor))
                    .map(|(a, b)| format!("{a}{row}/{b}{row}")),
            ),
            C => {
                if (line.c.abs() - 1.0).abs() < 1e-9 {
                    exact(libm::round(line.c))
                } else {
                    figure(line.c, 5)
                }
            }
            Contribution if !counted => text(self.either(&["-", "—", "(not counted)"])),
            Contribution => {
                let x = self.figures.contributions[i];
                let x = if self.manner.variant.is_multiple_of(3) {
                    x
                } else {
                    x.abs()
                };
                let formula = letter(U)
                    .zip(letter(C))
                    .map(|(a, b)| format!("ABS({a}{row}*{b}{row})"));
                with_formula(
                    x,
                    formula
                        .filter(|_| line.stale.is_none() && !self.manner.variant.is_multiple_of(3)),
                )
            }
            Square => figure(
                self.figures.contributions[i] * self.figures.contributions[i],
                digits,
            ),
            Share => {
                let part = self.figures.contributions[i] / self.figures.u_c;
                text(format!("{:.1} %", 100.0 * part * part))
            }
            Nu => {
                if line.step.nu.is_finite() {
                    exact(line.step.nu)
                } else {
                    text(self.either(&["∞", "inf", "infinity"]))
                }
            }
            Known => text(self.said(item, i)),
        }
    }
}

/// A figure with the digits that it has, up to five.
fn significant(x: f64) -> String {
    let long = plain(x, 5);
    let short = typed(x);
    if short.len() < long.len() {
        short
    } else {
        long
    }
}
