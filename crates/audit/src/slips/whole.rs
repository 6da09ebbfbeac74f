//! Slips between the rows and the statement.

use crate::calculate::{Case, Combined, Factor, Freedom, Printout, Ties};
use crate::claim::{Coverage, Stated};
use crate::printed::Printed;

use super::slip::{Act, Change, Reporting, Slip, Weight::*};

fn one(change: Change) -> Vec<(Option<usize>, Change)> {
    vec![(None, change)]
}

/// The slip of rounding on the way, where u_c was this one.
pub(crate) fn rounded(u_c: f64) -> Option<Act> {
    Some(Act {
        slip: super::slip(ROUNDED)?,
        row: None,
        change: Change::Combined(Combined::Typed(u_c)),
    })
}

pub(super) const UNIT_OF_U: &str = "U-unit";
const ROUNDED: &str = "intermediates-rounded";

fn report(reporting: Reporting) -> Vec<(Option<usize>, Change)> {
    one(Change::Report(reporting))
}

/// The sum of what the blocks of a sheet come to, each the root of its sum of squares.
fn sum_of_subtotals(case: &Case<'_>) -> Option<f64> {
    let ends = &case.claimed.subtotals;
    let starts = [0].into_iter().chain(ends.iter().copied());
    let blocks = starts.zip(ends).map(|(start, end)| {
        let lines = case.right.lines.get(start..*end)?;
        let counted = lines.iter().filter(|line| line.counted);
        let squares = counted.map(|line| line.contribution() * line.contribution());
        Some(libm::sqrt(squares.sum()))
    });
    let blocks: Vec<f64> = blocks.collect::<Option<_>>()?;
    let is_all = ends.last() == Some(&case.claimed.rows.len());
    (is_all && blocks.len() >= 2).then(|| blocks.iter().sum())
}

/// Where correlations are stated.
fn correlated(case: &Case<'_>, change: Change) -> Vec<(Option<usize>, Change)> {
    if case.right.correlations.is_empty() {
        Vec::new()
    } else {
        one(change)
    }
}

/// Where k is to be looked up at ν_eff: probability.
fn by_t(case: &Case<'_>) -> Option<f64> {
    match case.right.factor {
        Factor::StudentT(p) => Some(p),
        _ => None,
    }
}

/// The usual whole factor, other than the one that is stated, by which U and u_c are apart as they are printed.
fn other_multiple(case: &Case<'_>) -> Option<f64> {
    let footer = &case.claimed.footer;
    let is_stated = footer.k.is_some() || case.claimed.coverage != Coverage::Unstated;
    let (expanded, u_c) = footer.expanded.as_ref().zip(footer.u_c.as_ref())?;
    let stated = match case.right.factor {
        Factor::Fixed(k) => Some(k).filter(|_| is_stated)?,
        _ => return None,
    };
    let open =
        expanded.half_of_expanded() / u_c.value + expanded.value / u_c.value * u_c.relative_half();
    let is_apart = |k: &f64| (expanded.value / u_c.value - k).abs() <= open;
    let mut others = [2.0, 3.0].into_iter();
    others.find(|k| libm::round(stated) != *k && is_apart(k))
}

/// Whether the degrees of freedom of a row may be those of readings: it is made of some, or nothing but its u is told.
fn may_be_type_a(stated: &Stated) -> bool {
    stated.is_type_a() || matches!(stated, Stated::Standard { .. } | Stated::Nothing)
}

/// Degrees of freedom of the rows evaluated from readings.
fn type_a_freedom(case: &Case<'_>) -> Vec<f64> {
    let rows = case
        .claimed
        .rows
        .iter()
        .zip(&case.right.lines)
        .filter(|(row, _)| may_be_type_a(&row.stated));
    let own = rows.map(|(_, line)| line.dof).filter(|dof| dof.is_finite());
    // Those of a range are no whole number, and may be cut to one.
    let mut all: Vec<f64> = own
        .flat_map(|dof| [dof, libm::floor(dof).max(1.0)])
        .collect();
    all.dedup();
    all
}

/// Figures with two different digits next to one another exchanged: which pair, and the figure. Who writes a figure does not begin it
/// with a zero, `01` for `10`.
pub(crate) fn exchanged_digits(text: &str) -> Vec<(usize, f64)> {
    let clean = crate::printed::clean(text);
    let digits: Vec<usize> = clean
        .char_indices()
        .take_while(|(_, c)| !matches!(c, 'e' | 'E' | '×'))
        .filter(|(_, c)| c.is_ascii_digit())
        .map(|(at, _)| at)
        .collect();
    let mut found = Vec::new();
    for (pair, two) in digits.windows(2).enumerate() {
        let (a, b) = (&clean[two[0]..=two[0]], &clean[two[1]..=two[1]]);
        if a == b || pair == 0 && b == "0" {
            continue;
        }
        let mut swapped = clean.clone();
        swapped.replace_range(two[1]..=two[1], a);
        let b = b.to_string();
        swapped.replace_range(two[0]..=two[0], &b);
        if let Some(figure) = Printed::parse(&swapped) {
            found.push((pair, figure.value.abs()));
        }
    }
    found
}

fn exchanges(figure: Option<&Printed>, which: Printout) -> Vec<(Option<usize>, Change)> {
    let pairs = figure
        .map(|figure| exchanged_digits(&figure.text))
        .unwrap_or_default();
    pairs
        .into_iter()
        .flat_map(|(pair, _)| report(Reporting::Exchanged(which, pair)))
        .collect()
}

#[rustfmt::skip]
pub(super) const SLIPS: &[Slip] = &[
    Slip { id: "linear-sum", rule: "8", weight: Error,
        en: "the contributions were added, not their squares",
        zh: "各分量直接相加，而不是方和根",
        acts: |case| {
            let of_subtotals = sum_of_subtotals(case).map(Combined::Typed);
            let sums = [Some(Combined::Linear), of_subtotals].into_iter().flatten();
            sums.map(|sum| (None, Change::Combined(sum))).collect()
        } },
    Slip { id: "squares-not-rooted", rule: "8", weight: Error,
        en: "the sum of squares was given as u_c; the root was not taken",
        zh: "平方和未开方就作为 u_c",
        acts: |_| one(Change::Combined(Combined::Squares)) },
    Slip { id: ROUNDED, rule: "9", weight: Warning,
        en: "figures were rounded before they were used further: contributions before they were combined, or u_c before it was multiplied by k",
        zh: "中间数值先修约再使用：各分量在合成前，或 u_c 在乘以 k 前",
        acts: |_| [Ties::Up, Ties::Down].map(|ties| (None, Change::Combined(Combined::Rounded(ties)))).into() },
    Slip { id: "sign-lost", rule: "3", weight: Error,
        en: "the signs of the sensitivity coefficients were lost in the correlation term",
        zh: "相关项中丢失了灵敏系数的符号",
        acts: |case| correlated(case, Change::Combined(Combined::Unsigned)) },
    Slip { id: "corr-ignored", rule: "56", weight: Warning,
        en: "a correlation that the sheet itself states was left out",
        zh: "漏计了表中已说明的相关性",
        acts: |case| correlated(case, Change::Correlation(None)) },
    Slip { id: "corr-one", rule: "58", weight: Warning,
        en: "full correlation was assumed where the sheet states less",
        zh: "表中给出的相关系数较小，却按完全相关处理",
        acts: |case| correlated(case, Change::Correlation(Some(1.0))) },
    Slip { id: "veff-up", rule: "41", weight: Warning,
        en: "the effective degrees of freedom were rounded up",
        zh: "有效自由度向上取整",
        acts: |_| one(Change::Freedom(Freedom::Up)) },
    Slip { id: "veff-wrong", rule: "40", weight: Error,
        en: "the effective degrees of freedom are not those of Welch and Satterthwaite",
        zh: "有效自由度不符合 Welch–Satterthwaite 公式",
        acts: |case| case.claimed.footer.nu_eff.as_ref().map(|nu| (None, Change::Freedom(Freedom::Given(nu.value)))).into_iter().collect() },
    Slip { id: "k-of-typeA", rule: "40", weight: Error,
        en: "k was taken for the degrees of freedom of the readings instead of the effective ones",
        zh: "k 按 A 类自由度而不是有效自由度取值",
        acts: |case| by_t(case).map_or_else(Vec::new, |p| type_a_freedom(case).into_iter().map(|dof| (None, Change::Factor(Factor::At(p, dof)))).collect()) },
    Slip { id: "k2-low-dof", rule: "39", weight: Error,
        en: "k = 2 was used although the effective degrees of freedom are few",
        zh: "有效自由度小，却取 k = 2",
        acts: |case| if by_t(case).is_some() { one(Change::Factor(Factor::Fixed(2.0))) } else { Vec::new() } },
    Slip { id: "k-level", rule: "44", weight: Warning,
        en: "k belongs to another coverage probability (of 95, 95.45, 99 and 99.73 %) than the one stated",
        zh: "k 对应的包含概率（95 %、95.45 %、99 %、99.73 % 之一）与所述不一致",
        acts: |case| match case.right.factor {
            Factor::StudentT(p) => [0.95, 0.9545, 0.99, 0.9973].into_iter().filter(|q| (q - p).abs() > 1e-3).flat_map(|q| one(Change::Factor(Factor::StudentT(q)))).collect(),
            Factor::Fixed(2.0) => one(Change::Factor(Factor::Fixed(1.96))),
            _ => Vec::new(),
        } },
    Slip { id: "k2-rect", rule: "43", weight: Warning,
        en: "k = 2 was used although one rectangle dominates and the rule asks for 1.65",
        zh: "矩形分布占优、规则要求 k = 1.65，却取 k = 2",
        acts: |case| if matches!(case.claimed.coverage, Coverage::Rectangle | Coverage::OfRectangle) { one(Change::Factor(Factor::Fixed(2.0))) } else { Vec::new() } },
    Slip { id: "k-twice", rule: "10", weight: Error,
        en: "the coverage factor was applied twice",
        zh: "包含因子乘了两次",
        acts: |_| report(Reporting::Power(2)) },
    Slip { id: "k-forgotten", rule: "2", weight: Error,
        en: "u_c was reported as U; the coverage factor is missing",
        zh: "把 u_c 当作 U 报告，漏乘包含因子",
        acts: |_| report(Reporting::Power(0)) },
    Slip { id: "k-other", rule: "2", weight: Error,
        en: "U is another multiple of u_c than the coverage factor that is stated",
        zh: "U 是 u_c 的另一倍数，与所述包含因子不符",
        acts: |case| other_multiple(case).map_or_else(Vec::new, |k| report(Reporting::Factor(k))) },
    Slip { id: UNIT_OF_U, rule: "69", weight: Warning,
        en: "U is printed in a unit to which its figure does not belong",
        zh: "U 的数值与所标单位不符",
        acts: |case| {
            let unit = case.claimed.footer.expanded.as_ref().map_or("", |figure| figure.unit.as_str());
            let factor = crate::units::factor(unit, &case.claimed.unit).filter(|f| (f - 1.0).abs() > 1e-9);
            [factor, factor.map(|f| 1.0 / f), Some(1e3), Some(1e-3)].into_iter().flatten().flat_map(|scale| report(Reporting::Scale(scale))).collect()
        } },
    Slip { id: "below-cmc", rule: "70", weight: Error,
        en: "U is smaller than the CMC",
        zh: "U 小于 CMC",
        acts: |case| if case.claimed.cmc.is_some() { report(Reporting::BelowCmc) } else { Vec::new() } },
    Slip { id: "rounded-down", rule: "66", weight: Warning,
        en: "U was rounded down against the stated rule",
        zh: "U 违反所述规则被舍去修约",
        acts: |case| if case.claimed.footer.expanded.is_some() { report(Reporting::Down) } else { Vec::new() } },
    Slip { id: "too-many-digits", rule: "63", weight: Error,
        en: "U is printed with more than two significant digits",
        zh: "U 的有效数字多于两位",
        acts: |case| if case.claimed.footer.expanded.as_ref().is_some_and(Printed::is_long) { report(Reporting::Long) } else { Vec::new() } },
    Slip { id: "digits-transposed", rule: "2", weight: Error,
        en: "two digits of the final figure are exchanged",
        zh: "最终数值中有两个数字颠倒",
        acts: |case| {
            let footer = &case.claimed.footer;
            let mut acts = exchanges(footer.expanded.as_ref(), Printout::Expanded);
            acts.extend(exchanges(footer.u_c.as_ref(), Printout::Combined));
            acts
        } },
];
