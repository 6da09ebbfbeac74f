//! The components of a budget: stated width, divisor, u, c, contribution, ν; and their correlations.

use gumption_format::document::{Bars, Entry, Held, address};
use gumption_gum::budget::{Component, Evaluation as Kind};
use gumption_gum::propagate::Gum;

use super::writer::{self, SENSITIVITY, U_BELOW, Writer};
use crate::{Report, symbol};

/// Columns.
const STATED: usize = 3;
const DIVISOR: usize = 4;
const U: usize = 6;
const C: usize = 7;
const CONTRIBUTION: usize = 8;
const DOF: usize = 9;
const SIZE: usize = 11;
const WELCH: usize = 12;
/// Columns of the correlations.
const R: usize = 2;
const PRODUCT: usize = 3;

/// Where the components of one measurand stand.
pub(super) struct Components<'a> {
    report: &'a Report<'a>,
    gum: &'a Gum,
    /// Row of the head.
    at: usize,
    /// Those that act, each in its row.
    shown: Vec<usize>,
    /// Correlated pairs of places in `shown`, with r.
    pairs: Vec<(usize, usize, f64)>,
}

impl<'a> Components<'a> {
    pub(super) fn new(writer: &Writer<'a>, at: usize) -> Self {
        let report = writer.report;
        let gum = &report.evaluation.results[writer.measurand].gum;
        let acts = |t: &usize| {
            let mut inputs = writer.inputs.iter().map(|(i, _)| &report.budget.inputs[*i]);
            inputs.any(|input| input.terms.iter().any(|term| term.component == *t))
        };
        let shown: Vec<usize> = (0..report.budget.components.len()).filter(acts).collect();
        let place = |t: usize| shown.iter().position(|s| *s == t);
        let mut pairs = Vec::new();
        for group in &report.budget.groups {
            for (i, a) in group.members.iter().enumerate() {
                for (j, b) in group.members.iter().enumerate().skip(i + 1) {
                    let r = group.correlation[(i, j)];
                    if let (true, Some(a), Some(b)) = (r != 0.0, place(*a), place(*b)) {
                        pairs.push((a, b, r));
                    }
                }
            }
        }
        Components {
            report,
            gum,
            at,
            shown,
            pairs,
        }
    }

    fn row(&self, n: usize) -> usize {
        self.at + 1 + n
    }

    fn pair_row(&self, n: usize) -> usize {
        self.row(self.shown.len()) + 3 + n
    }

    /// The first row below.
    pub(super) fn end(&self) -> usize {
        match self.pairs.len() {
            0 => self.row(self.shown.len()),
            pairs => self.pair_row(pairs),
        }
    }

    /// u of an input: of its components, with their correlations.
    pub(super) fn of_input(&self, input: usize) -> String {
        let terms = &self.report.budget.inputs[input].terms;
        let parts: Vec<(usize, String)> = terms
            .iter()
            .filter_map(|term| {
                let n = self.shown.iter().position(|t| *t == term.component)?;
                let u = address(U, self.row(n));
                Some((n, times(term.coefficient, &u)))
            })
            .collect();
        let mut squares: Vec<String> = parts.iter().map(|(_, u)| format!("({u})^2")).collect();
        for (n, (a, b, _)) in self.pairs.iter().enumerate() {
            let part = |m: &usize| parts.iter().find(|(n, _)| n == m);
            if let (Some((_, a)), Some((_, b))) = (part(a), part(b)) {
                let r = address(R, self.pair_row(n));
                squares.push(format!("2*{r}*({a})*({b})"));
            }
        }
        format!("SQRT({})", squares.join("+"))
    }

    /// u(y) by the law of propagation of uncertainty (GUM 5.1.2, 5.2.2).
    pub(super) fn combined(&self) -> String {
        let contributions = self.column(CONTRIBUTION);
        match self.pairs.len() {
            0 => format!("SQRT(SUMSQ({contributions}))"),
            pairs => format!(
                "SQRT(SUMSQ({contributions})+SUM({}:{}))",
                address(PRODUCT, self.pair_row(0)),
                address(PRODUCT, self.pair_row(pairs - 1))
            ),
        }
    }

    /// ν_eff by Welch and Satterthwaite (GUM G.4.1), for this u(y).
    pub(super) fn welch_satterthwaite(&self, u: &str) -> String {
        let parts = self.column(WELCH);
        format!("IF(SUM({parts})=0,\"∞\",{u}^4/SUM({parts}))")
    }

    fn column(&self, column: usize) -> String {
        let last = self.row(self.shown.len().max(1) - 1);
        format!("{}:{}", address(column, self.row(0)), address(column, last))
    }

    pub(super) fn write(&self, writer: &mut Writer<'a>) {
        writer.title("Components", "不确定度分量");
        writer.heads(&[
            ("component", "不确定度分量"),
            ("type", "类别"),
            ("distribution", "概率分布"),
            ("half-width, or U, s, u", "区间半宽，或 U、s、u"),
            ("divisor", "除数"),
            ("unit", "单位"),
            ("u", "标准不确定度 u"),
            ("c", "灵敏系数 c"),
            ("c·u", "分量 c·u"),
            ("ν", "自由度 ν"),
            ("share of u²(y)", "占 u²(y) 之比"),
            ("|c·u|", "|c·u|"),
            ("(c·u)⁴/ν", "(c·u)⁴/ν"),
        ]);
        let u_of_y = address(1, self.end() + U_BELOW);
        for n in 0..self.shown.len() {
            let row = self.component(writer, n, &u_of_y);
            writer.sheet.push(row);
        }
        if !self.pairs.is_empty() {
            writer.title("Correlation", "相关");
            writer.heads(&[
                ("component", "不确定度分量"),
                ("and", "与"),
                ("r", "相关系数 r"),
                ("2·r·c·u·c·u", "2·r·c·u·c·u"),
            ]);
        }
        for (a, b, r) in &self.pairs {
            let name = |n: &usize| {
                let component = &self.report.budget.components[self.shown[*n]];
                Entry::Words(component.name.to_string())
            };
            let contribution = |n: &usize| self.gum.components[self.shown[*n]].contribution;
            let [left, right] = [a, b].map(|n| address(CONTRIBUTION, self.row(*n)));
            let at = writer.sheet.rows.len();
            writer.sheet.push(vec![
                name(a),
                name(b),
                Entry::Given(*r),
                Entry::formula(
                    format!("2*{}*{left}*{right}", address(R, at)),
                    2.0 * r * contribution(a) * contribution(b),
                ),
            ]);
        }
        writer.sheet.bars = Some(Bars {
            title: writer.word("Contributions |c·u|", "各分量的 |c·u|"),
            rows: [self.row(0), self.row(self.shown.len().max(1) - 1)],
            names: 0,
            lengths: SIZE,
        });
    }

    fn component(&self, sheet: &Writer<'a>, n: usize, u_of_y: &str) -> Vec<Entry> {
        let l = self.report.language;
        let t = self.shown[n];
        let component = &self.report.budget.components[t];
        let line = &self.gum.components[t];
        let row = self.row(n);
        let cell = |column| address(column, row);
        let (stated, divisor, by) = stated(component);
        let welch = match component.dof.is_finite() {
            true => line.contribution.powi(4) / component.dof,
            false => 0.0,
        };
        let dof = match writer::freedom(component.dof) {
            Held::Number(dof) => Entry::Given(dof),
            Held::Words(words) => Entry::Words(words),
        };
        let share = match self.products(n) {
            products if products.is_empty() => format!("{}^2/{u_of_y}^2", cell(CONTRIBUTION)),
            products => {
                let c = cell(CONTRIBUTION);
                format!("({c}^2+({products})/2)/{u_of_y}^2")
            }
        };
        vec![
            Entry::Words(component.name.to_string()),
            Entry::Words(match component.evaluation {
                Kind::TypeA => "A".to_string(),
                Kind::TypeB => "B".to_string(),
            }),
            Entry::Words(component.distribution.kind().short(l).replace('\u{AD}', "")),
            Entry::Given(stated),
            match by {
                Some(formula) => Entry::formula(formula, divisor),
                None => Entry::Given(divisor),
            },
            Entry::Words(symbol(&component.unit)),
            Entry::formula(format!("{}/{}", cell(STATED), cell(DIVISOR)), component.u),
            Entry::formula(self.sensitivity(sheet, t), line.sensitivity),
            Entry::formula(format!("{}*{}", cell(C), cell(U)), line.contribution),
            dof,
            Entry::formula(share, line.share),
            Entry::formula(
                format!("ABS({})", cell(CONTRIBUTION)),
                line.contribution.abs(),
            ),
            Entry::formula(
                format!(
                    "IF(ISNUMBER({0}),{1}^4/{0},0)",
                    cell(DOF),
                    cell(CONTRIBUTION)
                ),
                welch,
            ),
        ]
    }

    /// Σ over the correlations of a component.
    fn products(&self, n: usize) -> String {
        let of = |(_, (a, b, _)): &(usize, &(usize, usize, f64))| *a == n || *b == n;
        let pairs = self.pairs.iter().enumerate().filter(of);
        let cells: Vec<String> = pairs
            .map(|(at, _)| address(PRODUCT, self.pair_row(at)))
            .collect();
        cells.join("+")
    }

    /// Σ over the inputs on which the component acts.
    fn sensitivity(&self, writer: &Writer<'a>, t: usize) -> String {
        let mut parts = Vec::new();
        for (i, row) in &writer.inputs {
            let terms = self.report.budget.inputs[*i].terms.iter();
            for term in terms.filter(|term| term.component == t) {
                parts.push(times(term.coefficient, &address(SENSITIVITY, *row)));
            }
        }
        parts.join("+")
    }
}

/// A cell times an exact number.
fn times(coefficient: f64, cell: &str) -> String {
    match coefficient {
        1.0 => cell.to_string(),
        other => format!("({other:?})*{cell}"),
    }
}

/// What the uncertainty was stated by: a width, and the divisor that makes u of it, as a formula where it is none of a
/// certificate's.
fn stated(component: &Component) -> (f64, f64, Option<String>) {
    let u = component.u;
    let of_limits = || {
        let distribution = &component.distribution;
        let (a, variance) = (distribution.half_width()?, distribution.variance()?);
        // 3, 6 and 2 exactly, where the last digits of the limits make it a little more or less.
        let square = a * a / variance;
        let whole = square.round();
        let square = if (square - whole).abs() < 1e-9 * whole {
            whole
        } else {
            square
        };
        Some((a, square.sqrt(), Some(format!("SQRT({square:?})"))))
    };
    let of_quotient = || quotient(&component.how).map(|(stated, divisor)| (stated, divisor, None));
    let (half_width, divisor, formula) = of_limits().or_else(of_quotient).unwrap_or((u, 1.0, None));
    // Where u was stated otherwise than by this width, it stands for itself.
    match (half_width / divisor - u).abs() <= 1e-9 * u {
        true => (half_width, divisor, formula),
        false => (u, 1.0, None),
    }
}

/// Numerator and divisor of `U/k = 0.002/2`; the caller holds them against u.
fn quotient(how: &str) -> Option<(f64, f64)> {
    let (stated, divisor) = how.rsplit_once(" = ")?.1.split_once('/')?;
    Some((stated.parse().ok()?, divisor.parse().ok()?))
}
