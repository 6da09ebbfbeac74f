//! Published budgets as laboratories would hand them in: sound as they stand, and each slip that is put in is found.

use std::fmt::Write as _;

use gumption::audit::read::Mapping;
use gumption::audit::rules::{Bearing, findings};
use gumption::audit::slips::{Act, Weight};
use gumption::audit::{Audit, Verdict, audit, claims};
use gumption::budget::{self, Budget, Component, Figure, Owner};
use gumption::files::Files;
use gumption::propagate::{MonteCarloChoice, Options, evaluate};
use gumption::quantity::{Decimal, PowerStyle, Rounding, Unit};
use gumption::verify::LIBRARY;

/// A published budget with one measurand, as a calculation in rows.
#[derive(Debug, Clone)]
struct Sheet {
    title: String,
    unit: String,
    /// The equation, where every row is an input of it.
    model: Option<String>,
    /// Quantities of the model that are exact: symbol, value, unit.
    exact: Vec<(String, f64, String)>,
    rows: Vec<Row>,
    correlations: Vec<(usize, usize, f64)>,
    k: f64,
    /// What the whole is changed by.
    whole: Whole,
}

#[derive(Debug, Clone)]
struct Row {
    symbol: String,
    /// Value and unit of the estimate.
    estimate: Option<(f64, String)>,
    unit: String,
    known: Known,
    /// What was used, and what it was divided by.
    used: f64,
    divisor: f64,
    c: f64,
    nu: f64,
    /// Whether it is in the sum.
    summed: bool,
}

/// What is known of a component. Figures are in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Known {
    /// U and k.
    Certificate(f64, f64),
    Rectangle(f64),
    Triangle(f64),
    Arcsine(f64),
    /// s and n, of which the mean is reported.
    Readings(f64, f64),
    Standard(f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Whole {
    Right,
    Linear,
    Squares,
    Forgotten,
    Twice,
    Long,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Layout {
    /// Every column of M3003, in English.
    Full,
    /// The same in Chinese, with semicolons and decimal commas.
    Chinese,
    /// EA-4/02: no ± and divisors, what is known in notes below.
    Notes,
}

const LAYOUTS: [Layout; 3] = [Layout::Full, Layout::Chinese, Layout::Notes];

fn digits(x: f64, digits: u8) -> String {
    let rounded = Decimal::from_f64(x).round_to_significant(digits, Rounding::HalfEven);
    rounded.print(PowerStyle::Caret)
}

fn symbol(unit: &Unit) -> String {
    if unit.is_one() {
        String::new()
    } else {
        unit.symbol.clone()
    }
}

/// A figure as it was typed: with the digits that it has, up to six.
fn typed(x: f64) -> String {
    let (short, long) = (format!("{x}"), digits(x, 6));
    if short.len() < long.len() {
        short
    } else {
        long
    }
}

fn whole_or(dof: f64, infinite: &str) -> String {
    if dof.is_finite() {
        typed(dof)
    } else {
        infinite.into()
    }
}

impl Known {
    fn of(component: &Component) -> Known {
        let quotient = |how: &str| -> Option<(f64, f64)> {
            let (stated, divisor) = how.rsplit_once(" = ")?.1.split_once('/')?;
            Some((stated.parse().ok()?, divisor.parse().ok()?))
        };
        let u = component.u;
        let near = |x: f64| (x / u - 1.0).abs() < 1e-9;
        if let Some((expanded, k)) = quotient(&component.how)
            && component.how.starts_with("U/k")
            && near(expanded / k)
        {
            return Known::Certificate(expanded, k);
        }
        let after = |key: &str| -> Option<f64> {
            let rest = component.how.split_once(key)?.1;
            rest.split([',', ' ']).next()?.parse().ok()
        };
        if let (true, Some(n)) = (component.how.starts_with("s/√n,"), after(" n = "))
            && component.dof == n - 1.0
        {
            return Known::Readings(u * n.sqrt(), n);
        }
        let distribution = &component.distribution;
        let limits = distribution.half_width().zip(distribution.variance());
        match limits {
            Some((a, _)) if near(a / 3_f64.sqrt()) => Known::Rectangle(a),
            Some((a, _)) if near(a / 6_f64.sqrt()) => Known::Triangle(a),
            Some((a, _)) if near(a / 2_f64.sqrt()) => Known::Arcsine(a),
            _ => Known::Standard(u),
        }
    }

    fn used(self) -> f64 {
        let (Known::Certificate(x, _)
        | Known::Rectangle(x)
        | Known::Triangle(x)
        | Known::Arcsine(x)
        | Known::Readings(x, _)
        | Known::Standard(x)) = self;
        x
    }

    fn divisor(self) -> f64 {
        match self {
            Known::Certificate(_, k) => k,
            Known::Rectangle(_) => 3_f64.sqrt(),
            Known::Triangle(_) => 6_f64.sqrt(),
            Known::Arcsine(_) => 2_f64.sqrt(),
            Known::Readings(_, n) => n.sqrt(),
            Known::Standard(_) => 1.0,
        }
    }

    /// In words, English or Chinese.
    fn said(self, unit: &str, chinese: bool) -> String {
        let x = format!("{} {unit}", typed(self.used()));
        let x = x.trim_end();
        match (self, chinese) {
            (Known::Certificate(_, k), false) => format!("certificate: U = {x}, k = {}", typed(k)),
            (Known::Certificate(_, k), true) => {
                format!("校准证书给出 U = {x}，k = {}", typed(k))
            }
            (Known::Rectangle(_), false) => format!("limits ±{x}, nothing else known"),
            (Known::Rectangle(_), true) => format!("最大允许误差 ±{x}"),
            (Known::Triangle(_), false) => format!("triangular distribution with limits ±{x}"),
            (Known::Triangle(_), true) => format!("在 ±{x} 内，服从三角分布"),
            (Known::Arcsine(_), false) => format!("cycles with an amplitude of {x}"),
            (Known::Arcsine(_), true) => format!("周期性波动，幅值 {x}，反正弦分布"),
            (Known::Readings(_, n), false) => {
                format!("s = {x} of {n} readings, the mean of all {n} readings is reported")
            }
            (Known::Readings(_, n), true) => {
                format!("{n} 次测量的实验标准偏差 s = {x}，以{n}次平均值报告")
            }
            (Known::Standard(_), false) => format!("standard uncertainty {x}"),
            (Known::Standard(_), true) => format!("标准不确定度 {x}"),
        }
    }

    fn distribution(self, chinese: bool) -> &'static str {
        match (self, chinese) {
            (Known::Rectangle(_), false) => "rectangular",
            (Known::Rectangle(_), true) => "均匀",
            (Known::Triangle(_), false) => "triangular",
            (Known::Triangle(_), true) => "三角",
            (Known::Arcsine(_), false) => "U-shaped",
            (Known::Arcsine(_), true) => "反正弦",
            (_, false) => "normal",
            (_, true) => "正态",
        }
    }
}

impl Row {
    fn u(&self) -> f64 {
        self.used / self.divisor
    }

    fn contribution(&self) -> f64 {
        self.c * self.u()
    }

    fn divisor_in_words(&self) -> String {
        let square = self.divisor * self.divisor;
        let whole = (square - square.round()).abs() < 1e-9 && self.divisor.fract().abs() > 1e-9;
        if whole {
            format!("√{}", square.round())
        } else {
            typed(self.divisor)
        }
    }
}

impl Sheet {
    /// The sheet of a budget with one measurand that is a plain calculation in rows: each component in one input, and u_c
    /// of first order the root of their sum.
    fn of(budget: &Budget) -> Option<Sheet> {
        let [output] = budget.model.outputs() else {
            return None;
        };
        let options = Options {
            monte_carlo: MonteCarloChoice::Off,
            ..Options::default()
        };
        let evaluation = evaluate(budget, &options).ok()?;
        let gum = &evaluation.results[0].gum;
        let claim = |what: Figure| {
            let mut claims = budget.claims.iter();
            claims.find_map(|claim| claim.figure(&what))
        };
        let used = budget.model.inputs_of(0);
        let is_used = |owner: &Owner| match owner {
            Owner::Input(input) => used[*input],
            Owner::Source(_) => true,
        };
        let acting: Vec<usize> = (0..budget.components.len())
            .filter(|t| is_used(&budget.components[*t].owner) && budget.components[*t].u > 0.0)
            .collect();
        let mut rows = Vec::new();
        for t in &acting {
            let (component, line) = (&budget.components[*t], &gum.components[*t]);
            let Owner::Input(input) = component.owner else {
                return None;
            };
            let known = Known::of(component);
            let input = &budget.inputs[input];
            let alone = component.name == input.name;
            rows.push(Row {
                symbol: component.name.replace(['.', '['], "_").replace(']', ""),
                estimate: alone.then(|| (input.estimate, symbol(&input.unit))),
                unit: symbol(&component.unit),
                known,
                used: known.used(),
                divisor: known.divisor(),
                // The cosine of a right angle is no coefficient that anybody prints.
                c: if line.contribution.abs() < 1e-9 * gum.u {
                    0.0
                } else {
                    line.sensitivity
                },
                nu: component.dof,
                summed: true,
            });
        }
        let place = |t: usize| acting.iter().position(|s| *s == t);
        let mut correlations = Vec::new();
        for group in &budget.groups {
            for (i, a) in group.members.iter().enumerate() {
                for (j, b) in group.members.iter().enumerate().skip(i + 1) {
                    if let Some((a, b)) = place(*a).zip(place(*b)) {
                        correlations.push((a, b, group.correlation[(i, j)]));
                    }
                }
            }
        }
        let alone = rows.iter().all(|row| row.estimate.is_some());
        // `mean(U)` of a vector names none of its rows.
        let mut names = rows.iter().map(|row| row.symbol.as_str());
        let words = |c: char| !c.is_alphanumeric() && c != '_';
        let is_named = names.all(|name| output.equation.split(words).any(|word| word == name));
        let is_one = alone && is_named && !output.equation.contains('\n');
        let model = is_one.then(|| output.equation.clone());
        let certain = budget
            .inputs
            .iter()
            .zip(&used)
            .filter(|(input, used)| **used && input.terms.is_empty());
        let mut exact: Vec<(String, f64, String)> = certain
            .map(|(input, _)| (input.name.to_string(), input.estimate, symbol(&input.unit)))
            .collect();
        for constant in &budget.constants {
            let [value] = constant.values.as_slice() else {
                return None;
            };
            exact.push((constant.name.clone(), *value, symbol(&constant.unit)));
        }
        let sheet = Sheet {
            exact,
            title: budget.heading.title.clone(),
            unit: symbol(&output.unit),
            model,
            rows,
            correlations,
            k: claim(Figure::CoverageFactor).unwrap_or(2.0),
            whole: Whole::Right,
        };
        let same = (sheet.u_c() / gum.u - 1.0).abs() < 1e-6;
        (same && sheet.rows.len() >= 2).then_some(sheet)
    }

    /// Root of the sum of squares and products, or what is done in its place.
    fn u_c(&self) -> f64 {
        let part = |row: &Row| if row.summed { row.contribution() } else { 0.0 };
        let parts: Vec<f64> = self.rows.iter().map(part).collect();
        let products = self
            .correlations
            .iter()
            .map(|(a, b, r)| 2.0 * r * parts[*a] * parts[*b]);
        let square: f64 = parts.iter().map(|x| x * x).sum::<f64>() + products.sum::<f64>();
        match self.whole {
            Whole::Linear => parts.iter().map(|x| x.abs()).sum(),
            Whole::Squares => square,
            _ => square.sqrt(),
        }
    }

    fn expanded(&self) -> String {
        let power = match self.whole {
            Whole::Forgotten => 0,
            Whole::Twice => 2,
            _ => 1,
        };
        let long = self.whole == Whole::Long;
        digits(self.k.powi(power) * self.u_c(), if long { 4 } else { 2 })
    }

    fn nu_eff(&self) -> f64 {
        let part = |row: &Row| row.contribution().powi(4) / row.nu;
        let below: f64 = self.rows.iter().filter(|row| row.summed).map(part).sum();
        self.u_c().powi(4) / below
    }

    fn text(&self, layout: Layout) -> String {
        let chinese = layout == Layout::Chinese;
        let pick = |en: &'static str, zh: &'static str| if chinese { zh } else { en };
        let separator = if chinese { ';' } else { ',' };
        let cell = |text: &str| {
            let comma = chinese && text.starts_with(|c: char| c.is_ascii_digit() || c == '-');
            let text = if comma {
                text.replace('.', ",")
            } else {
                text.into()
            };
            match text.contains([separator, '"']) {
                true => format!("\"{}\"", text.replace('"', "\"\"")),
                false => text,
            }
        };
        let mut out = format!("{}\n", cell(&self.title));
        if let Some(equation) = &self.model {
            let _ = writeln!(
                out,
                "{}",
                cell(&format!("{}{equation}", pick("Model: ", "测量模型：")))
            );
        }
        if self.k != 2.0 {
            let _ = writeln!(
                out,
                "{}{}",
                pick("Coverage factor k = ", "包含因子取 k = "),
                cell(&typed(self.k))
            );
        }
        for (a, b, r) in &self.correlations {
            let (a, b) = (&self.rows[*a].symbol, &self.rows[*b].symbol);
            let _ = writeln!(out, "{}", cell(&format!("r({a}, {b}) = {}", typed(*r))));
        }
        let in_unit = |text: &str| match self.unit.as_str() {
            "" => text.to_string(),
            unit => format!("{text} / {unit}"),
        };
        let head: Vec<String> = match layout {
            Layout::Notes => [
                "Quantity X_i",
                "Estimate x_i",
                "Standard uncertainty u(x_i)",
                "Probability distribution",
                "Sensitivity coefficient c_i",
            ]
            .map(String::from)
            .into_iter()
            .chain([in_unit("Uncertainty contribution u_i(y)")])
            .collect(),
            _ => [
                pick("Symbol", "符号"),
                pick("Source of uncertainty", "不确定度来源"),
                pick("Estimate x_i", "估计值 x_i"),
                pick("Value ±", "半宽 a"),
                pick("Unit", "单位"),
                pick("Probability distribution", "概率分布"),
                pick("Divisor", "除数"),
                pick("Standard uncertainty u(x_i)", "标准不确定度 u(x_i)"),
                pick("Sensitivity coefficient c_i", "灵敏系数 c_i"),
            ]
            .map(String::from)
            .into_iter()
            .chain([
                in_unit(pick("u_i(y)", "不确定度分量 u_i(y)")),
                pick("ν_i", "自由度 ν_i").into(),
            ])
            .collect(),
        };
        let line = |cells: &[String]| {
            let cells: Vec<String> = cells.iter().map(|text| cell(text)).collect();
            cells.join(&separator.to_string()) + "\n"
        };
        out += &line(&head);
        for row in &self.rows {
            let estimate = row
                .estimate
                .as_ref()
                .map(|(x, unit)| format!("{x} {unit}").trim_end().to_string());
            let estimate = estimate.unwrap_or_default();
            let u = digits(row.u(), 4);
            let (c, part) = (digits(row.c, 6), digits(row.contribution(), 4));
            let distribution = row.known.distribution(chinese).to_string();
            let with_unit = format!("{u} {}", row.unit).trim_end().to_string();
            out += &match layout {
                Layout::Notes => line(&[
                    row.symbol.clone(),
                    estimate,
                    with_unit,
                    distribution,
                    c,
                    part,
                ]),
                _ => line(&[
                    row.symbol.clone(),
                    row.known.said(&row.unit, chinese),
                    estimate,
                    typed(row.used),
                    row.unit.clone(),
                    distribution,
                    row.divisor_in_words(),
                    u,
                    c,
                    part,
                    whole_or(row.nu, "∞"),
                ]),
            };
        }
        for (name, value, unit) in self.exact.iter().filter(|_| self.model.is_some()) {
            let estimate = format!("{value} {unit}").trim_end().to_string();
            out += &match layout {
                Layout::Notes => line(&[name.clone(), estimate]),
                _ => line(&[name.clone(), pick("exact", "准确值").into(), estimate]),
            };
        }
        let unit = self.unit.as_str();
        let u_c = pick("Combined standard uncertainty u_c", "合成标准不确定度 u_c");
        let mut closing = vec![(u_c, digits(self.u_c(), 4), unit)];
        if self.nu_eff() < 1e5 && layout != Layout::Notes {
            let nu_eff = format!("{:.0}", self.nu_eff().floor().max(1.0));
            closing.push((
                pick("Effective degrees of freedom", "有效自由度 ν_eff"),
                nu_eff,
                "",
            ));
        }
        closing.push((pick("Coverage factor k", "包含因子 k"), typed(self.k), ""));
        let expanded = pick("Expanded uncertainty U", "扩展不确定度 U");
        closing.push((expanded, self.expanded(), unit));
        out.push('\n');
        for (label, figure, unit) in closing {
            out += &line(&[label.to_string(), figure, unit.to_string()]);
        }
        if layout == Layout::Notes {
            out.push('\n');
            for row in &self.rows {
                let freedom = if row.nu.is_finite() && matches!(row.known, Known::Standard(_)) {
                    format!(", {} degrees of freedom", typed(row.nu))
                } else {
                    String::new()
                };
                out += &line(&[format!(
                    "{}: {}{freedom}",
                    row.symbol,
                    row.known.said(&row.unit, false)
                )]);
            }
        }
        out
    }

    /// Whether the digits of U tell it from what has nothing to do with it: the zero of `20` may be no digit.
    fn is_told(&self) -> bool {
        let expanded = self.expanded();
        let digits = expanded.trim_start_matches(['0', '.']);
        let whole = !expanded.contains('.');
        let said = if whole {
            digits.trim_end_matches('0')
        } else {
            digits
        };
        said.len() >= 2 && self.u_c() > 0.0
    }

    /// The sheet with a slip of each kind that can happen to it, and its name.
    fn spoilt(&self) -> Vec<(String, Sheet)> {
        let mut all = Vec::new();
        for (i, row) in self.rows.iter().enumerate() {
            let mut add = |id: &str, change: &dyn Fn(&mut Row)| {
                let mut sheet = self.clone();
                change(&mut sheet.rows[i]);
                all.push((format!("{id}@{}", row.symbol), sheet));
            };
            match row.known {
                Known::Certificate(_, k) => {
                    add("cert-undivided", &|row| row.divisor = 1.0);
                    add("cert-by-root3", &|row| row.divisor = 3_f64.sqrt());
                    if k != 2.0 {
                        add("cert-k-2", &|row| row.divisor = 2.0);
                    }
                }
                Known::Rectangle(_) => {
                    add("root3-missing", &|row| row.divisor = 1.0);
                    add("half-width-by-2", &|row| row.divisor = 2.0);
                    add("half-again", &|row| row.used /= 2.0);
                    add("triangle", &|row| row.divisor = 6_f64.sqrt());
                }
                Known::Triangle(_) => add("tri-by-root3", &|row| row.divisor = 3_f64.sqrt()),
                Known::Arcsine(_) => add("arcsine-as-rect", &|row| row.divisor = 3_f64.sqrt()),
                Known::Readings(_, n) => {
                    add("s-not-mean", &|row| row.divisor = 1.0);
                    if n != 4.0 {
                        add("s-over-n", &|row| row.divisor = n);
                    }
                    add("population-sd", &|row| row.used *= ((n - 1.0) / n).sqrt());
                }
                Known::Standard(_) => {}
            }
            add("row-dropped", &|row| row.summed = false);
            if self.model.is_some() && (row.c.abs() - 1.0).abs() > 0.02 {
                add("c-one", &|row| row.c = 1.0);
            }
        }
        for (id, whole) in [
            ("linear-sum", Whole::Linear),
            ("squares-not-rooted", Whole::Squares),
            ("k-forgotten", Whole::Forgotten),
            ("k-twice", Whole::Twice),
            ("too-many-digits", Whole::Long),
        ] {
            let sheet = Sheet {
                whole,
                ..self.clone()
            };
            all.push((id.into(), sheet));
        }
        all
    }
}

/// The published budgets that are calculations in rows.
fn sheets() -> Vec<(&'static str, Sheet)> {
    let mut all = Vec::new();
    for (name, _) in LIBRARY.iter().filter(|(name, _)| name.ends_with(".toml")) {
        let loaded = budget::load_from(Files::Library(LIBRARY), name.as_ref(), None);
        let loaded = loaded.unwrap_or_else(|r| panic!("{}", r.render(false)));
        all.extend(Sheet::of(&loaded.rows[0].budget).map(|sheet| (*name, sheet)));
    }
    all
}

fn audited<T>(text: &str, of: impl FnOnce(&Audit<'_>) -> T) -> T {
    let all = claims("sheet.csv", text.as_bytes(), &Mapping::default());
    let all = all.unwrap_or_else(|_| panic!("{text}"));
    let [claimed] = all.as_slice() else {
        panic!("{} budgets in\n{text}", all.len())
    };
    of(&audit(claimed))
}

#[test]
fn published_budgets_are_sound() {
    let all = sheets();
    assert!(all.len() >= 30, "{}", all.len());
    let mut wrong = String::new();
    for (name, sheet) in &all {
        for layout in LAYOUTS {
            let text = sheet.text(layout);
            audited(&text, |audit| {
                let blamed: Vec<u8> = findings(&audit.found)
                    .iter()
                    .filter(|finding| {
                        finding.bearing == Bearing::Figures
                            && finding.rule().weight == Weight::Error
                    })
                    .map(|finding| finding.rule)
                    .collect();
                if audit.verdict != Verdict::Sound || !blamed.is_empty() {
                    let _ = writeln!(wrong, "{name} {layout:?}: {:?} {blamed:?}", audit.verdict);
                }
            });
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Where a slip stands among the explanations of an audit: first, in the list, or nowhere. An error in a row that the
/// printed digits hide is listed as one that cannot be told.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Named {
    First,
    Listed,
    Not,
}

impl Named {
    fn of(audit: &Audit<'_>, id: &str) -> Named {
        let found = &audit.found;
        let is_it = |act: &Act| act.id(&found.case) == id;
        let sets = &found.explanations;
        let place = sets
            .iter()
            .position(|set| matches!(set.acts.as_slice(), [act] if is_it(act)));
        match place {
            Some(0) => Named::First,
            Some(_) => Named::Listed,
            None if audit.verdict == Verdict::Sound && found.untold.iter().any(is_it) => {
                Named::Listed
            }
            None => Named::Not,
        }
    }
}

/// Each slip of each budget in one layout, in turn.
#[test]
fn slips_in_published_budgets_are_found() {
    let (mut first, mut all) = (0, 0);
    let mut missed = String::new();
    for (name, sheet) in sheets() {
        for (n, (id, spoilt)) in sheet.spoilt().into_iter().enumerate() {
            let layout = LAYOUTS[n % LAYOUTS.len()];
            let text = spoilt.text(layout);
            // What changes no printed figure cannot be seen, and one digit is met by anything.
            if text == sheet.text(layout) || !spoilt.is_told() {
                continue;
            }
            let (named, verdict) = audited(&text, |audit| (Named::of(audit, &id), audit.verdict));
            all += 1;
            first += usize::from(named == Named::First);
            if named == Named::Not {
                let _ = writeln!(missed, "{name} {layout:?} {id}: {verdict:?}");
            }
        }
    }
    assert!(missed.is_empty(), "{missed}");
    assert!(
        all > 700 && 100 * first >= 90 * all,
        "{first} of {all} first"
    );
}
