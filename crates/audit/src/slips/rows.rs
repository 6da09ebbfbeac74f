//! Slips in a row: from what is stated to its contribution.

use crate::calculate::{Case, Combined};
use crate::claim::{Figure, RANGE, Relative, Row, Shape, Stated, range_factor};
use crate::printed::{Printed, leading};
use crate::read::{RESOLUTION, has};
use crate::units;

use super::slip::{Act, Change, Reporting, Slip, Weight::*};

/// What a slip makes of one row; nothing where it cannot act.
type InRow = fn(&Row) -> Vec<f64>;

fn each(case: &Case<'_>, act: impl Fn(usize, &Row) -> Vec<Change>) -> Vec<(Option<usize>, Change)> {
    let rows = case.claimed.rows.iter().enumerate();
    rows.flat_map(|(i, row)| act(i, row).into_iter().map(move |change| (Some(i), change)))
        .collect()
}

/// Slips that give another standard uncertainty, in the unit of what is stated.
fn u(case: &Case<'_>, wrong: InRow) -> Vec<(Option<usize>, Change)> {
    each(case, |_, row| {
        wrong(row)
            .into_iter()
            .map(|u| Change::U(u * row.relative_factor()))
            .collect()
    })
}

/// What the reading of a row with a full scale may be: its estimate; without one, the amounts in its unit that the title names.
fn readings(case: &Case<'_>, row: &Row) -> Vec<f64> {
    let named = || {
        let named = crate::read::figures_with_units(&case.claimed.title);
        named
            .filter_map(|figure| Some(figure.value * units::factor(&figure.unit, &row.unit)?))
            .collect()
    };
    let own = row.value.as_ref().map(|value| vec![value.value.abs()]);
    own.unwrap_or_else(named)
}

fn certificate(row: &Row, wrong: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    match &row.stated {
        Stated::Certificate { expanded, k, .. } => vec![wrong(expanded.value, *k)],
        _ => Vec::new(),
    }
}

/// Half-width and shape of limits; that of a step and of a full width, too.
fn limits(row: &Row) -> Option<(f64, Shape)> {
    match &row.stated {
        Stated::Limits {
            half_width, shape, ..
        } => Some((half_width.value, *shape)),
        Stated::FullWidth { width, shape } => Some((width.value / 2.0, *shape)),
        Stated::Step { step } => Some((step.value / 2.0, Shape::Rectangular)),
        _ => None,
    }
}

fn of_limits(
    row: &Row,
    fits: impl Fn(Shape) -> bool,
    wrong: impl Fn(f64, Shape) -> f64,
) -> Vec<f64> {
    limits(row)
        .filter(|(_, shape)| fits(*shape))
        .map(|(a, shape)| wrong(a, shape))
        .into_iter()
        .collect()
}

fn any(_: Shape) -> bool {
    true
}

fn deviation(row: &Row, wrong: impl Fn(f64, Option<f64>, f64) -> Vec<f64>) -> Vec<f64> {
    match &row.stated {
        Stated::Deviation { s, n, m, .. } if s.value > 0.0 => wrong(s.value, *n, *m),
        _ => Vec::new(),
    }
}

fn root3() -> f64 {
    libm::sqrt(3.0)
}

fn ratios(row: &Row) -> Vec<f64> {
    let is_ratio = row.relative != Relative::No
        || row
            .stated
            .figure()
            .is_some_and(|f| units::fraction(&f.unit).is_some());
    if is_ratio {
        units::MISSED.to_vec()
    } else {
        Vec::new()
    }
}

/// Whether U is an amount below rows in percent or ppm, or the other way round, so that it was converted by what it is a part of.
fn is_part_of_amount(case: &Case<'_>) -> bool {
    let expanded = case.claimed.footer.expanded.as_ref();
    // `1.5 mV/10 V`
    let called = expanded.and_then(|expanded| expanded.shown.as_deref());
    let behind = called.and_then(leading).map(|(_, behind)| behind);
    let own = behind.and_then(|behind| behind.split_once(['/', '·']));
    let is_ratio = |unit: &str| units::fraction(unit).is_some();
    own.is_some_and(|(own, _)| {
        units::parse(own).is_some() && is_ratio(own.trim()) != is_ratio(&case.claimed.unit)
    })
}

/// Digits next to one another exchanged.
fn exchanged(figure: f64, text: &str) -> Vec<f64> {
    super::whole::exchanged_digits(text)
        .into_iter()
        .filter_map(|(_, x)| (x.abs() != figure.abs() && x > 0.0).then_some(x))
        .collect()
}

#[rustfmt::skip]
pub(super) const SLIPS: &[Slip] = &[
    Slip { id: "cert-undivided", rule: "4/10", weight: Error,
        en: "the expanded uncertainty of the certificate was taken as a standard uncertainty, not divided by its k",
        zh: "把证书的扩展不确定度当作标准不确定度，未除以其包含因子 k",
        acts: |case| u(case, |row| certificate(row, |expanded, _| expanded)) },
    Slip { id: "cert-by-root3", rule: "11", weight: Error,
        en: "U of the certificate, whose k is stated, was divided by √3 as if it were a limit",
        zh: "证书的 U（已给出 k）被当作极限除以 √3",
        acts: |case| u(case, |row| certificate(row, |expanded, _| expanded / root3())) },
    Slip { id: "cert-k-2", rule: "15", weight: Warning,
        en: "the certificate states a k other than 2, and 2 was used as divisor",
        zh: "证书给出的 k 不是 2，却除以 2",
        acts: |case| u(case, |row| certificate(row, |expanded, _| expanded / 2.0)) },
    Slip { id: "half-width-by-2", rule: "12", weight: Error,
        en: "limits without a level of confidence were divided by 2 instead of √3",
        zh: "未给置信水平的极限除以 2，而不是 √3",
        acts: |case| u(case, |row| of_limits(row, |shape| shape == Shape::Rectangular, |a, _| a / 2.0)) },
    Slip { id: "root3-missing", rule: "4/13", weight: Error,
        en: "the half-width itself was used as standard uncertainty; the divisor of the distribution is missing",
        zh: "直接把半宽当作标准不确定度，漏除 √3",
        acts: |case| u(case, |row| of_limits(row, any, |a, _| a)) },
    Slip { id: "full-width", rule: "14", weight: Error,
        en: "the full width, or the whole digital step, was used as half-width",
        zh: "把全宽（或整个数字步进）当作半宽",
        acts: |case| u(case, |row| of_limits(row, any, |a, shape| 2.0 * a / shape.divisor())) },
    Slip { id: "half-again", rule: "14", weight: Error,
        en: "the ± limits were halved once more, as if they were a full width",
        zh: "把 ± 极限当作全宽又除以 2",
        acts: |case| u(case, |row| of_limits(row, any, |a, shape| a / 2.0 / shape.divisor())) },
    Slip { id: "triangle", rule: "18", weight: Information,
        en: "a triangle (√6) was taken for limits of which nothing but the limits is known",
        zh: "只知极限，却按三角分布除以 √6",
        acts: |case| u(case, |row| of_limits(row, |shape| shape == Shape::Rectangular, |a, _| a / libm::sqrt(6.0))) },
    Slip { id: "tri-by-root3", rule: "13", weight: Error,
        en: "limits of a triangular distribution were divided by √3",
        zh: "三角分布的极限除以了 √3",
        acts: |case| u(case, |row| of_limits(row, |shape| matches!(shape, Shape::Triangular | Shape::Trapezoidal(_)), |a, _| a / root3())) },
    Slip { id: "arcsine-as-rect", rule: "20", weight: Warning,
        en: "a cycling influence (arcsine) was divided by √3 instead of √2",
        zh: "周期性影响（反正弦分布）除以 √3，而不是 √2",
        acts: |case| u(case, |row| of_limits(row, |shape| shape == Shape::Arcsine, |a, _| a / root3())) },
    Slip { id: "asym-max", rule: "19", weight: Warning,
        en: "unequal limits were treated as ± the larger one",
        zh: "不对称极限按较大者作对称处理",
        acts: |case| u(case, |row| match &row.stated {
            Stated::Unequal { plus, minus } => vec![plus.value.max(minus.value) / root3()],
            _ => Vec::new(),
        }) },
    Slip { id: "s-not-mean", rule: "21", weight: Error,
        en: "the standard deviation of single readings was used although a mean is reported",
        zh: "报告的是平均值，却用了单次测量的标准偏差",
        acts: |case| u(case, |row| match &row.stated {
            Stated::Range { range, n, .. } => vec![range.value / range_factor(*n).0],
            _ => deviation(row, |s, _, _| vec![s]),
        }) },
    Slip { id: "s-over-n", rule: "21", weight: Error,
        en: "s was divided by the number of readings instead of its root",
        zh: "s 除以次数 n，而不是 √n",
        acts: |case| u(case, |row| deviation(row, |s, n, m| [Some(m), n].into_iter().flatten().map(|n| s / n).collect())) },
    Slip { id: "s-wrong-m", rule: "21", weight: Error,
        en: "s was divided by the root of the number of readings of the study, not of those behind the reported value",
        zh: "s 除以研究时读数次数的平方根，而不是报告值所用次数的平方根",
        acts: |case| u(case, |row| deviation(row, |s, n, _| n.map(|n| s / libm::sqrt(n)).into_iter().collect())) },
    Slip { id: "population-sd", rule: "25", weight: Warning,
        en: "s was computed with the divisor n instead of n − 1",
        zh: "计算 s 时用了 n，而不是 n − 1",
        acts: |case| u(case, |row| deviation(row, |s, n, m| n.map(|n| s * libm::sqrt((n - 1.0) / n) / libm::sqrt(m)).into_iter().collect())) },
    Slip { id: "range-C", rule: "26", weight: Warning,
        en: "the range factor C of another number of readings was used",
        zh: "极差法用了其他次数的极差系数 C",
        acts: |case| u(case, |row| match &row.stated {
            Stated::Range { range, m, n } => {
                // A neighbour in the table, or another row of it.
                let own = range_factor(*n).0;
                RANGE.iter().filter(|(c, _)| *c != own).map(|(c, _)| range.value / c / libm::sqrt(*m)).collect()
            }
            _ => Vec::new(),
        }) },
    Slip { id: "input-transposed", rule: "81", weight: Warning,
        en: "digits were exchanged when the figure was copied",
        zh: "抄录数值时相邻数字颠倒",
        acts: |case| each(case, |_, row| match row.stated.figure() {
            Some(figure) if figure.value > 0.0 && !matches!(row.stated, Stated::Standard { .. }) =>
                exchanged(figure.value, &figure.text).into_iter().map(|x| Change::Scaled(x / own(figure))).collect(),
            _ => Vec::new(),
        }) },
    Slip { id: "zero-scatter", rule: "27", weight: Warning,
        en: "equal readings were taken as no uncertainty; the step of the indication is missing",
        zh: "读数全相同便认为无不确定度，漏计示值步进",
        acts: |case| each(case, |i, row| match &row.stated {
            Stated::Deviation { s, .. } if s.value == 0.0 && case.right.lines[i].u > 0.0 => vec![Change::U(0.0)],
            _ => Vec::new(),
        }) },
    Slip { id: "percent-ppm", rule: "47", weight: Error,
        en: "percent or ppm was converted with a wrong power of ten",
        zh: "百分数或 ppm 换算错了 10 的幂",
        acts: |case| {
            let of_rows = each(case, |_, row| ratios(row).into_iter().map(Change::Scaled).collect());
            let of_whole = units::MISSED.into_iter().filter(|_| is_part_of_amount(case));
            let of_whole = of_whole.map(|ratio| (None, Change::Report(Reporting::Scale(ratio))));
            of_rows.into_iter().chain(of_whole).collect()
        } },
    Slip { id: "rel-abs", rule: "47", weight: Error,
        en: "a relative figure was put among absolute ones as it stood",
        zh: "把相对量直接当作绝对量",
        acts: |case| each(case, |i, row| {
            let u = case.right.lines[i].u;
            match row.relative {
                // As the percentage it is written as, and as the fraction that it is.
                Relative::OfValue(fraction) => vec![Change::U(u / row.relative_factor()), Change::U(u / row.relative_factor() * fraction)],
                Relative::OfFullScale(fraction, _) => vec![Change::U(u / row.relative_factor()), Change::U(u / row.relative_factor() * fraction)],
                Relative::No => Vec::new(),
            }
        }) },
    Slip { id: "fs-reading", rule: "50", weight: Warning,
        en: "percent of full scale was applied to the reading",
        zh: "满量程的百分数被用于读数",
        acts: |case| each(case, |_, row| match row.relative {
            Relative::OfFullScale(_, scale) if scale > 0.0 => readings(case, row).into_iter().filter(|reading| *reading != scale).map(|reading| Change::Scaled(reading / scale)).collect(),
            _ => Vec::new(),
        }) },
    Slip { id: "prefix", rule: "46", weight: Error,
        en: "a factor of 1000 between units was lost or made twice",
        zh: "单位换算漏乘或多乘了 1000",
        // In the standard uncertainty, in a coefficient that is printed with it, or between the two and their product.
        acts: |case| each(case, |i, row| {
            let c = case.right.lines[i].c;
            let has = |factor: &f64| row.c.as_ref().is_some_and(|claimed| ((claimed.value / (factor * c)).abs() - 1.0).abs() < 0.01);
            let of_c = [1e3, 1e-3].into_iter().filter(has).map(|factor| Change::C(factor * c));
            let of_contribution = behind_u(row, case.right.lines[i]).into_iter().map(Change::Typed);
            [Change::Scaled(1e3), Change::Scaled(1e-3)].into_iter().chain(of_c).chain(of_contribution).collect()
        }) },
    Slip { id: "c-one", rule: "3/6", weight: Error,
        en: "the sensitivity coefficient was left out (taken as 1)",
        zh: "漏乘灵敏系数（当作 1）",
        acts: |case| each(case, |i, row| {
            let line = case.right.lines[i];
            // The column of coefficients may have it, and the contributions not.
            let both = row.c.is_some() && row.contribution.is_some();
            let unused = both.then_some(Change::Typed(line.u * line.to_y));
            let acts = unused.into_iter().chain([Change::C(1.0)]);
            acts.filter(|_| line.c.abs() != 1.0).collect()
        }) },
    Slip { id: "degrees", rule: "48", weight: Warning,
        en: "degrees were used where the derivative needs radians",
        zh: "导数需用弧度处用了度",
        acts: |case| each(case, |i, row| {
            let radian = 180.0 / std::f64::consts::PI;
            let c = case.right.lines[i].c;
            let text = case.claimed.model.as_deref().unwrap_or_default();
            let angle = ["°", "deg", "度", "rad"].iter().any(|unit| row.unit.contains(unit)) && !row.unit.contains('C')
                || ["sin(", "cos(", "tan("].iter().any(|function| {
                    text.split(function).skip(1).any(|rest| crate::read::has_symbol(rest.split(')').next().unwrap_or_default(), &row.symbol))
                });
            if angle { vec![Change::C(c * radian), Change::C(c / radian)] } else { Vec::new() }
        }) },
    Slip { id: "c-wrong", rule: "6", weight: Warning,
        en: "the sensitivity coefficient is not the derivative of the model",
        zh: "灵敏系数不是模型的偏导数",
        acts: |case| each(case, |i, row| {
            let c = case.right.lines[i].c;
            let claimed = row.c.as_ref().filter(|_| case.derivatives.is_some()).map(|c| c.value);
            // Where none is claimed: a factor 2, its half, the reciprocal.
            let usual = || if c.abs() == 1.0 || case.derivatives.is_none() { Vec::new() } else { vec![2.0 * c, 0.5 * c, 1.0 / c] };
            claimed.map_or_else(usual, |c| vec![c]).into_iter().map(Change::C).collect()
        }) },
    Slip { id: "pooled-dof", rule: "22", weight: Error,
        en: "the degrees of freedom n − 1 of one series were given to a pooled s",
        zh: "合并样本标准偏差却用了单组的自由度 n − 1",
        acts: |case| each(case, |_, row| match row.stated {
            Stated::Deviation { n: Some(n), pooled: Some(_), .. } => vec![Change::Dof(n - 1.0)],
            _ => Vec::new(),
        }) },
    Slip { id: "dof-n", rule: "30/40", weight: Warning,
        en: "degrees of freedom n were used instead of n − 1",
        zh: "自由度用了 n，而不是 n − 1",
        acts: |case| each(case, |_, row| match row.stated {
            Stated::Deviation { n: Some(n), pooled: None, .. } => vec![Change::Dof(n)],
            Stated::Range { n, .. } => vec![Change::Dof(n)],
            _ => Vec::new(),
        }) },
    Slip { id: "row-dropped", rule: "1/82", weight: Error,
        en: "the row stands in the table but is not in the sum",
        zh: "该行列在表中，但未计入合成",
        acts: |case| each(case, |i, _| if case.right.lines[i].counted && !case.claimed.rows[i].is_absent { vec![Change::Counted(false)] } else { Vec::new() }) },
    Slip { id: "ref-missing", rule: "77", weight: Warning,
        en: "the uncertainty of the reference itself is not in the budget",
        zh: "漏计标准器本身的不确定度",
        // Of what nothing is known but that the model has it, that is asked (rule 60): it may be a number, or exact.
        acts: |case| each(case, |_, row| if row.is_absent && row.stated != Stated::Nothing { vec![Change::Counted(false)] } else { Vec::new() }) },
    Slip { id: HARD_CODED, rule: "82", weight: Warning,
        en: "a number stands where a formula belongs, or its formula was not computed again",
        zh: "应为公式的单元格中是固定数值，或公式修改后未重新计算",
        acts: |case| {
            let is_old = |u_c: &&Printed| case.claimed.typed || case.claimed.is_stale(u_c);
            let total = case.claimed.footer.u_c.as_ref().filter(is_old).map(|u_c| (None, Change::Combined(Combined::Typed(u_c.value))));
            each(case, |i, _| typed(case, i)).into_iter().chain(total).chain(old_product(case)).collect()
        } },
    Slip { id: "res-and-rep", rule: "31", weight: Warning,
        en: "the resolution was counted beside a repeatability that already contains it",
        zh: "重复性已包含分辨力，又重复计入分辨力",
        acts: |case| each(case, |i, row| {
            if !case.right.lines[i].counted && is_resolution(row) { vec![Change::Counted(true)] } else { Vec::new() }
        }) },
    Slip { id: "counted-twice", rule: "32/33", weight: Error,
        en: "the row is contained in another one and was counted again",
        zh: "该项已包含在另一项中，被重复计入",
        acts: |case| each(case, |i, row| {
            if !case.right.lines[i].counted && !is_resolution(row) { vec![Change::Counted(true)] } else { Vec::new() }
        }) },
];

/// The contribution with a factor of 1000 that u and c, as the row prints them, do not have.
fn behind_u(row: &Row, line: crate::calculate::Line) -> Vec<f64> {
    let Some((u, made)) = row.u.as_ref().zip(row.contribution.as_ref()) else {
        return Vec::new();
    };
    let c = row.c.as_ref().map_or(line.c, |c| c.value);
    let product = (c * u.value * line.to_y).abs();
    let open = u.relative_half() + made.relative_half();
    let is_made = |factor: &f64| (made.value.abs() / (factor * product) - 1.0).abs() <= open;
    let factors = [1e3, 1e-3].into_iter().filter(is_made);
    factors.map(|factor| factor * line.contribution()).collect()
}

/// U that its formula does not give, as a multiple of the right u_c.
fn old_product(case: &Case<'_>) -> Option<(Option<usize>, Change)> {
    let footer = &case.claimed.footer;
    let expanded = footer
        .expanded
        .as_ref()
        .filter(|own| case.claimed.is_stale(own))?;
    let factor = expanded.value / case.right.figures(&[], None).u_c;
    Some((None, Change::Report(Reporting::Factor(factor))))
}

/// Whether a slip is that a cell holds another figure than its formula gives, which the workbook itself shows.
pub(crate) fn is_shown_by_formula(case: &Case<'_>, act: &Act) -> bool {
    let footer = &case.claimed.footer;
    let row = act.row.map(|row| &case.claimed.rows[row]);
    let figure = match (row, act.change) {
        (Some(row), Change::U(_)) => &row.u,
        (Some(row), _) => &row.contribution,
        (None, Change::Report(_)) => &footer.expanded,
        (None, _) => &footer.u_c,
    };
    let is_old = |figure: &Printed| case.claimed.is_stale(figure);
    act.slip.id == HARD_CODED && figure.as_ref().is_some_and(is_old)
}

const HARD_CODED: &str = "hard-coded";

/// The computed figures of a row that are numbers, where those of most rows are formulas, or other figures than their
/// formulas give.
fn typed(case: &Case<'_>, i: usize) -> Vec<Change> {
    let rows = &case.claimed.rows;
    let row = &rows[i];
    let stands_out = |figure: Figure| {
        let is_formula = |row: &Row| row.formulas.iter().any(|(of, _)| *of == figure);
        let others = rows.iter().filter(|row| is_formula(row)).count();
        !is_formula(row) && 2 * others >= rows.len()
    };
    let is_old = |figure: &&Printed| case.claimed.is_stale(figure);
    let u = row.u.as_ref();
    let u = u.filter(|u| stands_out(Figure::U) || is_old(u));
    let contribution = row.contribution.as_ref();
    let contribution = contribution.filter(|c| stands_out(Figure::Contribution) || is_old(c));
    let u = u.map(|figure| Change::U(figure.value));
    let contribution = contribution.map(|figure| Change::Typed(figure.value));
    u.into_iter().chain(contribution).collect()
}

fn is_resolution(row: &Row) -> bool {
    let is_step = matches!(row.stated, Stated::Step { .. });
    is_step || has(&row.words.to_lowercase(), RESOLUTION)
}

/// The number that the text of a figure shows, in the unit in which it is written.
fn own(figure: &Printed) -> f64 {
    Printed::parse(&figure.text).map_or(figure.value, |p| p.value.abs())
}
