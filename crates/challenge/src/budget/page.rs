//! A working on paper: the layouts in which laboratories keep their sheets.

use rand::RngExt;
use rand::seq::IndexedRandom;

use super::laboratory::{Budget, Item, Rounding, Rule};
use super::quantity::Divisor;
use super::statement::said;
use super::words::{Said, plain, typed};
use super::working::{Figures, Working};
use crate::random::Random;

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cell {
    Empty,
    Text(String),
    /// As it is shown, its value, and the formula behind it with `{row}` for the row's number.
    Figure(String, f64, Option<String>),
}

/// A page of cells.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Page {
    pub name: String,
    pub rows: Vec<Vec<Cell>>,
}

/// Layouts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Form {
    Ea,
    M3003,
    Jjf,
    Free,
    Squares,
    TwoHeads,
    Turned,
    TwoPages,
    Short,
    Groups,
    Summary,
    Prose,
}

impl Form {
    pub(super) const ALL: [Form; 12] = [
        Form::Ea,
        Form::M3003,
        Form::Jjf,
        Form::Free,
        Form::Squares,
        Form::TwoHeads,
        Form::Turned,
        Form::TwoPages,
        Form::Short,
        Form::Groups,
        Form::Summary,
        Form::Prose,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Form::Ea => "EA-4/02",
            Form::M3003 => "M3003",
            Form::Jjf => "JJF 1059.1",
            Form::Free => "free",
            Form::Squares => "squares and shares",
            Form::TwoHeads => "head of two lines",
            Form::Turned => "rows and columns exchanged",
            Form::TwoPages => "two tables",
            Form::Short => "no inputs",
            Form::Groups => "grouped rows",
            Form::Summary => "summary",
            Form::Prose => "sentences",
        }
    }

    /// Whether the estimates stand in it.
    pub(super) fn has_estimates(self) -> bool {
        !matches!(
            self,
            Form::M3003 | Form::Free | Form::Squares | Form::Short | Form::Groups
        )
    }
}

/// How a page is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Manner {
    pub form: Form,
    pub chinese: bool,
    /// Digits of u and contributions.
    pub digits: usize,
    /// Which of several ways to say things.
    pub variant: usize,
    /// Formulas beside the figures.
    pub formulas: bool,
}

/// A manner that suits a budget.
pub(super) fn manner(random: &mut Random) -> Manner {
    let form = *Form::ALL.choose(random).unwrap_or(&Form::Ea);
    Manner {
        form,
        chinese: form == Form::Jjf || form != Form::M3003 && random.random_bool(0.3),
        digits: random.random_range(2..5),
        variant: random.random_range(0..60),
        formulas: false,
    }
}

fn text(text: impl Into<String>) -> Cell {
    Cell::Text(text.into())
}

fn figure(x: f64, digits: usize) -> Cell {
    Cell::Figure(plain(x, digits), x, None)
}

fn exact(x: f64) -> Cell {
    Cell::Figure(typed(x), x, None)
}

/// What columns hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Number,
    Symbol,
    Name,
    Estimate,
    Unit,
    Type,
    Used,
    Distribution,
    Divisor,
    U,
    C,
    Contribution,
    Square,
    Share,
    Nu,
    Known,
}

use Column::*;

struct Writer<'a> {
    budget: &'a Budget,
    working: &'a Working,
    figures: &'a Figures,
    manner: Manner,
}

/// The pages of a working.
pub(super) fn pages(budget: &Budget, working: &Working, manner: Manner) -> Vec<Page> {
    let figures = working.figures();
    let writer = Writer {
        budget,
        working,
        figures: &figures,
        manner,
    };
    writer.pages()
}

impl Writer<'_> {
    fn pick(&self, en: &'static str, zh: &'static str) -> &'static str {
        Said(en, zh).of(self.manner.chinese)
    }

    fn either<'b>(&self, ways: &[&'b str]) -> &'b str {
        ways[self.manner.variant % ways.len()]
    }

    fn pages(&self) -> Vec<Page> {
        let mut page = Page {
            name: self.pick("Budget", "不确定度").into(),
            rows: Vec::new(),
        };
        page.rows
            .push(vec![text(self.budget.field.title.of(self.manner.chinese))]);
        if self.manner.variant % 4 == 1 {
            let (a, b) = (
                self.pick("Procedure", "依据"),
                self.pick("Prepared by", "编制"),
            );
            page.rows.push(vec![
                text(a),
                text("QP-17 rev. 3"),
                Cell::Empty,
                text(b),
                text("J. Li"),
                text("2026-03-14"),
            ]);
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
        match self.manner.form {
            Form::Ea => {
                self.table(
                    &mut page,
                    &[Symbol, Estimate, U, Distribution, C, Contribution],
                );
                self.result_row(&mut page);
                self.claims(&mut page);
                self.notes(&mut page, |_| true);
            }
            Form::M3003 => {
                self.table(
                    &mut page,
                    &[
                        Symbol,
                        Name,
                        Known,
                        Used,
                        Distribution,
                        Divisor,
                        C,
                        Contribution,
                        Nu,
                    ],
                );
                self.inside_footer(&mut page, 9, 7, 8);
            }
            Form::Jjf => {
                self.table(
                    &mut page,
                    &[
                        Number,
                        Symbol,
                        Name,
                        Estimate,
                        Type,
                        Distribution,
                        Used,
                        Divisor,
                        U,
                        C,
                        Contribution,
                        Nu,
                        Known,
                    ],
                );
                self.claims(&mut page);
            }
            Form::Free => {
                self.table(
                    &mut page,
                    &[
                        Name,
                        Symbol,
                        Known,
                        Type,
                        Used,
                        Unit,
                        Divisor,
                        U,
                        C,
                        Contribution,
                    ],
                );
                self.claims(&mut page);
            }
            Form::Squares => {
                self.table(
                    &mut page,
                    &[
                        Symbol,
                        Known,
                        Used,
                        Divisor,
                        U,
                        C,
                        Contribution,
                        Square,
                        Share,
                        Nu,
                    ],
                );
                self.claims(&mut page);
            }
            Form::TwoHeads => {
                self.table(
                    &mut page,
                    &[
                        Symbol,
                        Name,
                        Estimate,
                        Used,
                        Divisor,
                        U,
                        C,
                        Contribution,
                        Nu,
                    ],
                );
                self.claims(&mut page);
                self.notes(&mut page, |_| true);
            }
            Form::Turned => {
                self.claims(&mut page);
                page.rows.push(Vec::new());
                let mut upright = Page::default();
                self.table(
                    &mut upright,
                    &[
                        Symbol,
                        Known,
                        Estimate,
                        Used,
                        Divisor,
                        U,
                        C,
                        Contribution,
                        Nu,
                    ],
                );
                page.rows.extend(turned(&upright.rows));
            }
            Form::TwoPages => {
                self.table(&mut page, &[Symbol, Name, Estimate, Known]);
                page.name = self.pick("Inputs", "输入量").into();
                let mut second = Page {
                    name: self.pick("Evaluation", "评定").into(),
                    rows: Vec::new(),
                };
                second.rows.push(vec![text(
                    self.pick("Evaluation of the uncertainty", "不确定度合成"),
                )]);
                second.rows.push(Vec::new());
                self.table(&mut second, &[Symbol, U, C, Contribution, Nu]);
                self.claims(&mut second);
                return vec![page, second];
            }
            Form::Short => {
                self.table(&mut page, &[Symbol, Known, Nu, C, Contribution]);
                self.claims(&mut page);
            }
            Form::Groups => {
                self.table(
                    &mut page,
                    &[
                        Symbol,
                        Name,
                        Used,
                        Distribution,
                        Divisor,
                        U,
                        C,
                        Contribution,
                    ],
                );
                self.claims(&mut page);
                self.notes(&mut page, |_| true);
            }
            Form::Summary => {
                let columns: &[Column] = if self.budget.is_sum() {
                    &[Symbol, Estimate, Known]
                } else {
                    &[Name, Symbol, Estimate, Known, C]
                };
                self.table(&mut page, columns);
                self.claims(&mut page);
            }
            Form::Prose => {
                self.notes(&mut page, |_| true);
                page.rows.push(Vec::new());
                self.claims(&mut page);
            }
        }
        if self.manner.variant % 6 == 2 {
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
        vec![page]
    }

    /// Whether the page has a column of coefficients.
    fn has_slopes(&self) -> bool {
        self.manner.form != Form::Prose
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

    fn table(&self, page: &mut Page, columns: &[Column]) {
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

    fn said(&self, item: &Item, i: usize) -> String {
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

    /// What is known of each row, below the table.
    fn notes(&self, page: &mut Page, of: impl Fn(usize) -> bool) {
        page.rows.push(Vec::new());
        for (i, item) in self.budget.items.iter().enumerate().filter(|(i, _)| of(*i)) {
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

    fn u_c(&self) -> String {
        let text = || plain(self.figures.u_c, self.manner.digits.max(3));
        self.figures.u_c_text.clone().unwrap_or_else(text)
    }

    fn has_nu(&self) -> bool {
        matches!(self.budget.rule, Rule::Student(_)) || self.manner.variant % 7 == 1
    }

    fn nu_eff(&self) -> Cell {
        if self.figures.nu_eff.is_finite() {
            exact(self.figures.nu_eff)
        } else {
            text("∞")
        }
    }

    fn expanded_unit(&self) -> &'static str {
        if self.working.wrong_unit {
            wrong(self.budget.field.unit)
        } else {
            self.budget.field.unit
        }
    }

    fn claim_figure(&self, shown: &str) -> Cell {
        Cell::Figure(shown.into(), shown.parse().unwrap_or(0.0), None)
    }

    /// The row of the result, as EA-4/02 has it.
    fn result_row(&self, page: &mut Page) {
        let y = format!(
            "{} {}",
            typed(libm::round(self.budget.y() * 1e6) / 1e6),
            self.budget.field.unit
        );
        let u_c = self.claim_figure(&self.u_c());
        page.rows.push(vec![
            text(self.budget.field.measurand),
            text(y),
            Cell::Empty,
            Cell::Empty,
            Cell::Empty,
            u_c,
        ]);
    }

    fn inside_footer(&self, page: &mut Page, width: usize, at: usize, nu: usize) {
        let mut row = |symbol: &str,
                       words: &str,
                       column: usize,
                       cell: Cell,
                       distribution: &str,
                       nu_cell: Option<Cell>| {
            let mut cells = vec![Cell::Empty; width];
            cells[0] = text(symbol);
            cells[1] = text(words);
            cells[4] = text(distribution);
            cells[column] = cell;
            if let Some(cell) = nu_cell {
                cells[nu] = cell;
            }
            page.rows.push(cells);
        };
        let k = plain(self.figures.k, 3);
        row(
            "u_c",
            self.pick("Combined standard uncertainty", "合成标准不确定度"),
            at,
            self.claim_figure(&self.u_c()),
            self.pick("normal", "正态"),
            self.has_nu().then(|| self.nu_eff()),
        );
        let unit = self.expanded_unit();
        let u = if self.working.wrong_unit {
            text(format!("{} {unit}", self.figures.reported))
        } else {
            self.claim_figure(&self.figures.reported)
        };
        row(
            "U",
            self.pick("Expanded uncertainty", "扩展不确定度"),
            at,
            u,
            &format!("k = {k}"),
            None,
        );
    }

    /// The claim in one of several forms.
    fn claims(&self, page: &mut Page) {
        let unit = self.budget.field.unit;
        let (u_c, u, k) = (self.u_c(), &self.figures.reported, plain(self.figures.k, 3));
        let k = if self.figures.k == 2.0 { "2".into() } else { k };
        let expanded_unit = self.expanded_unit();
        let y = typed(libm::round(self.budget.y() * 1e6) / 1e6);
        let nu = if self.figures.nu_eff.is_finite() {
            format!("{}", self.figures.nu_eff)
        } else {
            "∞".into()
        };
        let style = if self.manner.form == Form::Prose {
            1 + self.manner.variant % 2
        } else {
            self.manner.variant % 4
        };
        page.rows.push(Vec::new());
        match style {
            0 => {
                let mut row = |words: &str, figure: Cell, unit: &str| {
                    page.rows.push(vec![text(words), figure, text(unit)])
                };
                row(
                    self.pick("Combined standard uncertainty u_c", "合成标准不确定度 u_c"),
                    self.claim_figure(&u_c),
                    unit,
                );
                if self.has_nu() {
                    row(
                        self.pick("Effective degrees of freedom", "有效自由度 ν_eff"),
                        self.nu_eff(),
                        "",
                    );
                }
                row(
                    self.pick("Coverage factor k", "包含因子 k"),
                    self.claim_figure(&k),
                    "",
                );
                row(
                    self.pick("Expanded uncertainty U", "扩展不确定度 U"),
                    self.claim_figure(u),
                    expanded_unit,
                );
            }
            1 => {
                page.rows.push(vec![text(format!("u_c = {u_c} {unit}"))]);
                if self.has_nu() {
                    page.rows.push(vec![text(format!("ν_eff = {nu}"))]);
                }
                page.rows.push(vec![text(format!("k = {k}"))]);
                page.rows
                    .push(vec![text(format!("U = {u} {expanded_unit}"))]);
            }
            2 => {
                let nu = if self.has_nu() {
                    format!(", ν_eff = {nu}")
                } else {
                    String::new()
                };
                page.rows.push(vec![text(format!(
                    "u_c({}) = {u_c} {unit}{nu}",
                    self.budget.field.measurand
                ))]);
                let result = if self.working.wrong_unit {
                    format!(
                        "{} = {y} {unit}, U = {u} {expanded_unit}, k = {k}",
                        self.budget.field.measurand
                    )
                } else {
                    format!(
                        "{} = ({y} ± {u}) {unit}, k = {k}",
                        self.budget.field.measurand
                    )
                };
                page.rows.push(vec![text(if self.manner.chinese {
                    format!("测量结果：{result}")
                } else {
                    format!("Result: {result}")
                })]);
            }
            _ => {
                let mut heads = vec![text("u_c"), text("k"), text("U")];
                let mut cells = vec![
                    text(format!("{u_c} {unit}")),
                    self.claim_figure(&k),
                    text(format!("{u} {expanded_unit}")),
                ];
                if self.has_nu() {
                    heads.insert(1, text("ν_eff"));
                    cells.insert(1, self.nu_eff());
                }
                page.rows.push(heads);
                page.rows.push(cells);
            }
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

fn turned(rows: &[Vec<Cell>]) -> Vec<Vec<Cell>> {
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    (0..width)
        .map(|column| {
            rows.iter()
                .map(|row| row.get(column).cloned().unwrap_or(Cell::Empty))
                .collect()
        })
        .collect()
}
