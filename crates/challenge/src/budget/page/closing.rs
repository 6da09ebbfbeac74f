//! The claim: u_c, ν_eff, k and U, in the ways in which sheets close.

use super::super::words::{plain, typed};
use super::cell::{Cell, Page, claimed, text};
use super::layout::{Column, Form};
use super::writer::Writer;

impl Writer<'_> {
    /// The row of the result, as EA-4/02 has it.
    pub(super) fn result_row(&self, page: &mut Page) {
        let y = format!(
            "{} {}",
            typed(libm::round(self.budget.y() * 1e6) / 1e6),
            self.budget.field.unit
        );
        let u_c = claimed(&self.u_c());
        page.rows.push(vec![
            text(self.budget.field.measurand),
            text(y),
            Cell::Empty,
            Cell::Empty,
            Cell::Empty,
            u_c,
        ]);
    }

    /// u_c and U as rows of the table of M3003, each figure in the column of its kind.
    pub(super) fn inside_footer(&self, page: &mut Page, columns: &[Column]) {
        let mut row = |cell: &dyn Fn(Column) -> Cell| {
            page.rows
                .push(columns.iter().map(|column| cell(*column)).collect());
        };
        row(&|column| match column {
            Column::Symbol => text("u_c"),
            Column::Name => text(self.pick("Combined standard uncertainty", "合成标准不确定度")),
            Column::Distribution => text(self.pick("normal", "正态")),
            Column::Contribution => claimed(&self.u_c()),
            Column::Nu if self.has_nu() => self.nu_eff(),
            _ => Cell::Empty,
        });
        let k = plain(self.figures.k, 3);
        let reported = &self.figures.reported;
        row(&|column| match column {
            Column::Symbol => text("U"),
            Column::Name => text(self.pick("Expanded uncertainty", "扩展不确定度")),
            Column::Distribution => text(format!("k = {k}")),
            Column::Contribution if self.working.wrong_unit => {
                text(format!("{reported} {}", self.expanded_unit()))
            }
            Column::Contribution => claimed(reported),
            _ => Cell::Empty,
        });
    }

    /// The claim in one of several forms.
    pub(super) fn claims(&self, page: &mut Page) {
        let style = if self.manner.form == Form::Prose {
            1 + self.manner.variant % 2
        } else {
            self.manner.variant % 4
        };
        page.rows.push(Vec::new());
        page.rows.extend(match style {
            0 => self.labelled(),
            1 => self.assigned(),
            2 => self.sentences(),
            _ => self.side_by_side(),
        });
    }

    fn k(&self) -> String {
        if self.figures.k == 2.0 {
            "2".into()
        } else {
            plain(self.figures.k, 3)
        }
    }

    fn nu(&self) -> String {
        if self.figures.nu_eff.is_finite() {
            self.figures.nu_eff.to_string()
        } else {
            "∞".into()
        }
    }

    /// A label, its figure and its unit in each row.
    fn labelled(&self) -> Vec<Vec<Cell>> {
        let row = |words: &str, figure: Cell, unit: &str| vec![text(words), figure, text(unit)];
        let unit = self.budget.field.unit;
        let mut rows = vec![row(
            self.pick("Combined standard uncertainty u_c", "合成标准不确定度 u_c"),
            claimed(&self.u_c()),
            unit,
        )];
        if self.has_nu() {
            rows.push(row(
                self.pick("Effective degrees of freedom", "有效自由度 ν_eff"),
                self.nu_eff(),
                "",
            ));
        }
        rows.push(row(
            self.pick("Coverage factor k", "包含因子 k"),
            claimed(&self.k()),
            "",
        ));
        rows.push(row(
            self.pick("Expanded uncertainty U", "扩展不确定度 U"),
            claimed(&self.figures.reported),
            self.expanded_unit(),
        ));
        rows
    }

    /// `u_c = …`, a line each.
    fn assigned(&self) -> Vec<Vec<Cell>> {
        let mut lines = vec![format!("u_c = {} {}", self.u_c(), self.budget.field.unit)];
        if self.has_nu() {
            lines.push(format!("ν_eff = {}", self.nu()));
        }
        lines.push(format!("k = {}", self.k()));
        lines.push(format!(
            "U = {} {}",
            self.figures.reported,
            self.expanded_unit()
        ));
        lines.into_iter().map(|line| vec![text(line)]).collect()
    }

    /// Two sentences.
    fn sentences(&self) -> Vec<Vec<Cell>> {
        let (measurand, unit) = (self.budget.field.measurand, self.budget.field.unit);
        let (u_c, u, k) = (self.u_c(), &self.figures.reported, self.k());
        let y = typed(libm::round(self.budget.y() * 1e6) / 1e6);
        let nu = if self.has_nu() {
            format!(", ν_eff = {}", self.nu())
        } else {
            String::new()
        };
        let result = if self.working.wrong_unit {
            let expanded_unit = self.expanded_unit();
            format!("{measurand} = {y} {unit}, U = {u} {expanded_unit}, k = {k}")
        } else {
            format!("{measurand} = ({y} ± {u}) {unit}, k = {k}")
        };
        let lead = self.pick("Result: ", "测量结果：");
        vec![
            vec![text(format!("u_c({measurand}) = {u_c} {unit}{nu}"))],
            vec![text(format!("{lead}{result}"))],
        ]
    }

    /// Labels side by side, and their figures below.
    fn side_by_side(&self) -> Vec<Vec<Cell>> {
        let mut heads = vec![text("u_c"), text("k"), text("U")];
        let mut cells = vec![
            text(format!("{} {}", self.u_c(), self.budget.field.unit)),
            claimed(&self.k()),
            text(format!(
                "{} {}",
                self.figures.reported,
                self.expanded_unit()
            )),
        ];
        if self.has_nu() {
            heads.insert(1, text("ν_eff"));
            cells.insert(1, self.nu_eff());
        }
        vec![heads, cells]
    }
}
