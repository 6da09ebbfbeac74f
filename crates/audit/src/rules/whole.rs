//! What the figures of the whole show.

use crate::calculate::{Factor, Freedom, are_possible, t};
use crate::claim::{Correlation, Coverage, Stated};
use crate::printed::Printed;
use crate::read::Whole;

use super::{Hit, Seen};

fn one(numbers: String) -> Vec<Hit> {
    vec![Hit::of(None, numbers)]
}

fn when(so: bool, numbers: impl FnOnce() -> String) -> Vec<Hit> {
    if so { one(numbers()) } else { Vec::new() }
}

fn far(figure: &Printed, x: f64, open: f64) -> bool {
    (figure.value - x).abs() > figure.half_of_digits() * (1.0 + 1e-6) + (open + 1e-9) * x.abs()
}

/// u_c of the contributions that the sheet prints, and what their digits leave open.
fn of_printed(seen: &Seen<'_>) -> Option<(f64, f64)> {
    let lines = &seen.case.right.lines;
    let rows = seen.claimed.rows.iter().zip(lines);
    let mut parts = Vec::new();
    let mut open: f64 = 0.0;
    for (row, line) in rows {
        let contribution = row.contribution.as_ref().filter(|_| line.counted);
        if line.counted && contribution.is_none() {
            return None;
        }
        parts.push(contribution.map_or(0.0, |c| c.value.abs().copysign(line.contribution())));
        open += contribution.map_or(0.0, |c| c.half_of_digits());
    }
    let products = seen.claimed.correlations.iter();
    let products: f64 = products
        .map(|&Correlation { a, b, r, .. }| 2.0 * r * parts[a] * parts[b])
        .sum();
    let squares: f64 = parts.iter().map(|part| part * part).sum();
    Some((libm::sqrt((squares + products).max(0.0)), open))
}

pub(super) fn sum(seen: &Seen<'_>) -> Vec<Hit> {
    let Some((claimed, (u_c, open))) = seen.claimed.footer.u_c.as_ref().zip(of_printed(seen))
    else {
        return Vec::new();
    };
    let differs = (claimed.value - u_c).abs() > claimed.half_of_digits() + open;
    when(differs, || {
        format!("u_c = {}, √Σ = {u_c:.4}", claimed.as_read())
    })
}

pub(super) fn product(seen: &Seen<'_>) -> Vec<Hit> {
    let footer = &seen.claimed.footer;
    let (Some(u_c), Some(k), Some(expanded)) = (&footer.u_c, &footer.k, &footer.expanded) else {
        return Vec::new();
    };
    let product = u_c.value * k.value;
    let floor = seen.claimed.cmc.as_ref().map_or(0.0, |cmc| cmc.value);
    // U may be rounded up.
    let open = 2.0 * expanded.half_of_expanded() + u_c.half_of_digits() * k.value;
    when(!expanded.is_met_within(product.max(floor), open), || {
        format!("U = {}, k·u_c = {product:.4}", expanded.as_read())
    })
}

pub(super) fn shares(seen: &Seen<'_>) -> Vec<Hit> {
    let shares: Vec<&Printed> = seen
        .claimed
        .rows
        .iter()
        .filter(|row| row.not_counted.is_none())
        .filter_map(|row| row.share.as_ref())
        .collect();
    let counted = seen.claimed.rows.iter();
    let counted = counted.filter(|row| row.not_counted.is_none()).count();
    let total: f64 = shares.iter().map(|share| share.value).sum();
    let open: f64 = shares.iter().map(|share| share.half).sum();
    let whole = if total > 2.0 { 100.0 } else { 1.0 };
    if shares.len() < 2 || shares.len() != counted || !seen.claimed.correlations.is_empty() {
        return Vec::new();
    }
    match (total - whole).abs() > (open + 1e-9).max(0.01 * whole) {
        true => one(format!("Σ = {total:.4}")),
        false => other_share(seen, whole).into_iter().collect(),
    }
}

/// The share that departs most from that of the square of its contribution.
fn other_share(seen: &Seen<'_>, whole: f64) -> Option<Hit> {
    let lines = &seen.laboratory.lines;
    let square = |i: usize| lines[i].contribution() * lines[i].contribution();
    let counted = (0..lines.len()).filter(|i| lines[*i].counted);
    let total: f64 = counted.clone().map(square).sum();
    let departs = |i: usize| {
        let row = &seen.claimed.rows[i];
        let (share, right) = (row.share.as_ref()?, whole * square(i) / total);
        // Shares may have been computed from parts as they are printed.
        let part = row.contribution.as_ref().or(row.u.as_ref())?;
        let open = share.half + 2.0 * part.relative_half() * right + 0.01 * whole;
        let far = (share.value - right).abs();
        let numbers = format!("{} ≠ {right:.3}", share.as_read());
        (far > open).then_some((far, Hit::of(Some(i), numbers)))
    };
    let found = counted.filter_map(departs);
    found.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, hit)| hit)
}

pub(super) fn result(seen: &Seen<'_>) -> Vec<Hit> {
    let y = seen.claimed.footer.y.as_ref();
    let Some((y, right)) = y.zip(crate::slips::other_result(seen.case)) else {
        return Vec::new();
    };
    when(far(y, right, 1e-6), || {
        format!("y = {}, f(x) = {right:.9}", y.as_read())
    })
}

/// Coverage of k = 2 at few degrees of freedom is below 95 %.
pub(super) fn two_at_few(seen: &Seen<'_>) -> Vec<Hit> {
    let nu = seen.case.right.figures(&[], None).nu_eff;
    let few = seen.laboratory.factor == Factor::Fixed(2.0) && nu < 10.0;
    let Some(mut hit) = when(few, || {
        format!(
            "ν_eff = {nu:.1}, t₉₅ = {:.2}",
            t(0.95, libm::floor(nu).max(1.0))
        )
    })
    .pop() else {
        return Vec::new();
    };
    let mut right = seen.case.right.clone();
    right.factor = Factor::StudentT(0.95);
    hit.corrected = Some(right.figures(&[], None).expanded);
    vec![hit]
}

/// ν_eff of independent inputs is between the smallest ν and the sum of all.
pub(super) fn freedom(seen: &Seen<'_>) -> Vec<Hit> {
    let nu = seen.claimed.footer.nu_eff.as_ref();
    let Some(nu) = nu.filter(|_| seen.case.right.freedom == Freedom::Welch) else {
        return Vec::new();
    };
    let counted = seen
        .case
        .right
        .lines
        .iter()
        .filter(|line| line.counted && line.contribution() != 0.0);
    let all: Vec<f64> = counted.map(|line| line.dof).collect();
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    let most: f64 = all.iter().sum();
    let outside = nu.value < libm::floor(least) - nu.half || nu.value > most + nu.half;
    when(outside && seen.claimed.correlations.is_empty(), || {
        format!("ν_eff = {}, {least} … {most}", nu.as_read())
    })
}

pub(super) fn freedom_of_correlated(seen: &Seen<'_>) -> Vec<Hit> {
    let claimed = seen.claimed;
    let correlated = claimed.correlations.iter().any(|pair| pair.r != 0.0);
    let nu = claimed
        .footer
        .nu_eff
        .as_ref()
        .filter(|nu| nu.value.is_finite());
    nu.filter(|_| correlated)
        .map_or_else(Vec::new, |nu| one(format!("ν_eff = {}", nu.as_read())))
}

pub(super) fn rectangle(seen: &Seen<'_>) -> Vec<Hit> {
    let right = &seen.case.right;
    let u_c = right.figures(&[], None).u_c;
    let two = seen.laboratory.factor == Factor::Fixed(2.0);
    let rows = seen.claimed.rows.iter().zip(&right.lines).enumerate();
    let dominant = rows.filter(|(_, (row, line))| {
        let shape = crate::calculate::shape_of(&row.stated);
        let dominates = crate::calculate::dominates(line.contribution().abs(), u_c);
        line.counted && dominates && shape == Some(crate::claim::Shape::Rectangular)
    });
    let hits = dominant.map(|(i, (_, line))| {
        let part = line.contribution() / u_c;
        Hit {
            row: Some(i),
            numbers: format!("{:.0} % u_c²", 100.0 * part * part),
            corrected: Some(crate::claim::K_OF_RECTANGLE * u_c),
        }
    });
    hits.filter(|_| two && u_c > 0.0).collect()
}

pub(super) fn factor_alone(seen: &Seen<'_>) -> Vec<Hit> {
    let footer = &seen.claimed.footer;
    let by_t = matches!(
        seen.claimed.coverage,
        Coverage::StudentT(_) | Coverage::Rectangle | Coverage::OfRectangle
    );
    // `U (k = 2, 95 %)` says it beside the figure, a note below the table.
    let of_whole = [Whole::Factor, Whole::Expanded].map(Whole::name);
    let labels = seen.claimed.understood.iter();
    let labels = labels.filter(|one| of_whole.contains(&one.role));
    let text = labels.fold(seen.claimed.words.to_lowercase(), |text, one| {
        text + "\n" + &one.text.to_lowercase()
    });
    let level = [
        "95",
        "99",
        "68",
        "包含概率",
        "置信",
        "probability",
        "confidence",
    ];
    let said = by_t || level.iter().any(|word| text.contains(word));
    match (&footer.expanded, &footer.k) {
        (Some(_), Some(k)) if !said => one(format!("k = {}, p = ?", k.as_read())),
        (Some(expanded), None) if seen.claimed.coverage == Coverage::Unstated => {
            one(format!("U = {}, k = ?", expanded.as_read()))
        }
        _ => Vec::new(),
    }
}

pub(super) fn not_a_matrix(seen: &Seen<'_>) -> Vec<Hit> {
    let pairs = &seen.claimed.correlations;
    let beyond = pairs.iter().find(|pair| pair.r.abs() > 1.0);
    if let Some(pair) = beyond {
        return one(format!("r = {}", pair.r));
    }
    when(!are_possible(pairs), || "r".into())
}

/// Rows that name the same certificate, and are not correlated; rows of which one says that it rests on the same standard as another,
/// or a line that says of its inputs that they are correlated, in a sheet that states no correlation that is read.
pub(super) fn common_reference(seen: &Seen<'_>) -> Vec<Hit> {
    let mut hits = common_certificate(seen);
    if hits.is_empty() && seen.claimed.correlations.is_empty() {
        hits.extend(told_correlation(seen));
    }
    if hits.is_empty() && seen.claimed.correlations.is_empty() {
        let rows = seen.claimed.rows.iter().enumerate();
        hits.extend(rows.filter_map(|(at, row)| {
            let lower = row.words.to_lowercase();
            let said = SAME.iter().find(|words| lower.contains(**words))?;
            Some(Hit::of(Some(at), format!("{}: {said}", row.label())))
        }));
    }
    hits
}

/// A line that speaks of correlation, of which rows it is not understood, and does not deny it.
fn told_correlation(seen: &Seen<'_>) -> Option<Hit> {
    const DENIED: [&str; 7] = [
        "uncorrelated",
        "not correlated",
        "no correlation",
        "independent",
        "不相关",
        "无相关",
        "独立",
    ];
    let is_told = |text: &&str| {
        let lower = text.to_lowercase();
        let is_denied = DENIED.iter().any(|word| lower.contains(word));
        !is_denied && ["correlat", "相关"].iter().any(|word| lower.contains(word))
    };
    let mut lines = seen.claimed.unplaced.iter().map(|line| line.text.as_str());
    let line = lines.find(is_told)?;
    Some(Hit::of(None, line.to_owned()))
}

/// What says that two rows have a cause in common.
const SAME: &[&str] = &[
    "same standard",
    "same reference",
    "same certificate",
    "same instrument",
    "same gauge",
    "同一标准",
    "同一台标准",
    "同一块标准",
    "同一参考",
    "同一证书",
];

fn common_certificate(seen: &Seen<'_>) -> Vec<Hit> {
    let number = |words: &str| {
        let lower = words.to_lowercase();
        let at = [
            "certificate no.",
            "certificate number",
            "cert. no.",
            "证书编号",
            "证书号",
            "serial no.",
            "s/n",
        ]
        .iter()
        .find_map(|key| lower.find(key).map(|at| at + key.len()))?;
        let word = lower[at..].trim_start_matches([' ', ':', '：']);
        let word = word
            .split([' ', ',', ';', ')', '，', '；'])
            .next()?
            .to_string();
        word.contains(|c: char| c.is_ascii_digit()).then_some(word)
    };
    let rows = &seen.claimed.rows;
    let numbers: Vec<Option<String>> = rows.iter().map(|row| number(&row.words)).collect();
    let mut hits = Vec::new();
    for a in 0..rows.len() {
        for b in a + 1..rows.len() {
            let alike = numbers[a].is_some() && numbers[a] == numbers[b];
            let given = seen
                .claimed
                .correlations
                .iter()
                .any(|pair| (pair.a, pair.b) == (a, b) || (pair.b, pair.a) == (a, b));
            if alike && !given && rows[a].symbol != rows[b].symbol {
                let what = numbers[a].clone().unwrap_or_default();
                hits.push(Hit::of(
                    Some(b),
                    format!("{}, {}: {what}", rows[a].label(), rows[b].label()),
                ));
            }
        }
    }
    hits
}

pub(super) fn common_in_a_difference(seen: &Seen<'_>) -> Vec<Hit> {
    let lines = &seen.case.right.lines;
    let other_signs = |pair: &&Correlation| lines[pair.a].c * lines[pair.b].c < 0.0;
    let full = seen
        .claimed
        .correlations
        .iter()
        .filter(|pair| pair.r >= 1.0);
    full.filter(other_signs)
        .map(|pair| Hit::of(Some(pair.b), format!("r = {}", pair.r)))
        .collect()
}

/// A stated positive correlation of a difference that the laboratory left out.
pub(super) fn left_out_of_a_difference(seen: &Seen<'_>) -> Vec<Hit> {
    let lines = &seen.case.right.lines;
    let left_out = seen.laboratory.correlations.is_empty();
    let pairs = seen.claimed.correlations.iter().filter(|_| left_out);
    let cancels = |pair: &&Correlation| pair.r * lines[pair.a].c * lines[pair.b].c < 0.0;
    let hit = |pair: &Correlation| Hit {
        row: Some(pair.b),
        numbers: format!("r = {}", pair.r),
        corrected: Some(seen.case.right.figures(&[], None).expanded),
    };
    pairs.filter(cancels).map(hit).collect()
}

pub(super) fn not_in_the_model(seen: &Seen<'_>) -> Vec<Hit> {
    let Some(model) = &seen.claimed.model else {
        return Vec::new();
    };
    let rows = seen.claimed.rows.iter().enumerate();
    rows.filter(|(_, row)| {
        let absent = row.is_absent;
        let strange = !row.symbol.is_empty()
            && !crate::read::has_symbol(model, &row.symbol)
            && row.not_counted.is_none();
        absent || strange
    })
    .map(|(i, row)| Hit::of(Some(i), row.label().to_string()))
    .collect()
}

pub(super) fn digits(seen: &Seen<'_>) -> Vec<Hit> {
    let expanded = seen.claimed.footer.expanded.as_ref().map(Printed::read);
    let long = expanded.filter(|figure| figure.digits > 2);
    long.map_or_else(Vec::new, |figure| one(format!("U = {}", figure.as_read())))
}

pub(super) fn one_digit(seen: &Seen<'_>) -> Vec<Hit> {
    let leading = |figure: &Printed| {
        let ten = libm::exp10(libm::floor(libm::log10(figure.value)));
        figure.value / ten
    };
    let expanded = seen.claimed.footer.expanded.as_ref().map(Printed::read);
    let short =
        expanded.filter(|figure| figure.digits == 1 && figure.value > 0.0 && leading(figure) < 2.5);
    short.map_or_else(Vec::new, |figure| one(format!("U = {}", figure.as_read())))
}

pub(super) fn last_places(seen: &Seen<'_>) -> Vec<Hit> {
    let footer = &seen.claimed.footer;
    let (Some(y), Some(expanded)) = (&footer.y, &footer.expanded) else {
        return Vec::new();
    };
    let (y, expanded) = (y.read(), expanded.read());
    let known = y.half > 0.0 && expanded.half > 0.0 && y.half < 0.5 && expanded.half < 0.5;
    let same_unit = y.unit == expanded.unit || y.unit.is_empty() || expanded.unit.is_empty();
    let differ = (y.half / expanded.half - 1.0).abs() > 1e-6;
    when(known && same_unit && differ, || {
        format!("y = {}, U = {}", y.as_read(), expanded.as_read())
    })
}

pub(super) fn rounded_down(seen: &Seen<'_>) -> Vec<Hit> {
    let footer = &seen.claimed.footer;
    let (Some(expanded), Some(u_c)) = (&footer.expanded, &footer.u_c) else {
        return Vec::new();
    };
    let expanded = expanded.read();
    let k = footer
        .k
        .as_ref()
        .map_or_else(|| seen.laboratory.figures(&[], None).k, |k| k.value);
    let product = k * u_c.value;
    // EA-4/02 M:2022, 6.3: what lowers U by more than 5 % is rounded up.
    let lowered = (product - expanded.value) / product;
    let by_digits = 0.05..0.5;
    let rounding = (product - expanded.value) <= 2.0 * expanded.half;
    when(rounding && by_digits.contains(&lowered), || {
        format!("U = {}, k·u_c = {product:.4}", expanded.as_read())
    })
}

/// U that follows from rounding twice, and not from rounding once.
pub(super) fn twice_rounded(seen: &Seen<'_>) -> Vec<Hit> {
    use gumption_core::quantity::{Decimal, Rounding};
    let Some(expanded) = &seen.claimed.footer.expanded else {
        return Vec::new();
    };
    if expanded.digits == 0 || expanded.digits > 2 {
        return Vec::new();
    }
    let exact = seen.laboratory.figures(&[], None).expanded;
    let round = |x: f64, digits: u8| {
        Decimal::from_f64(x)
            .round_to_significant(digits, Rounding::HalfUp)
            .to_f64()
    };
    let digits = expanded.digits as u8;
    let (once, twice) = (
        round(exact, digits),
        round(round(exact, digits + 1), digits),
    );
    let same = |x: f64| (x / expanded.value - 1.0).abs() < 1e-9;
    when(same(twice) && !same(once), || {
        format!("{exact:.5} → {twice}")
    })
}

pub(super) fn units_of_result(seen: &Seen<'_>) -> Vec<Hit> {
    let Some(expanded) = &seen.claimed.footer.expanded else {
        return Vec::new();
    };
    // `0.06 %·100 g`: as it is printed, and of what the audit took it.
    let printed = expanded.as_read().split('·').next();
    let printed = printed.and_then(Printed::parse).map(|figure| figure.unit);
    let is_percent = |unit: &str| crate::units::fraction(unit).is_some();
    let percent = is_percent(&expanded.unit) || printed.is_some_and(|unit| is_percent(&unit));
    let other = percent && crate::units::fraction(&seen.claimed.unit).is_none();
    when(other, || {
        format!("U = {}, y: {}", expanded.as_read(), seen.claimed.unit)
    })
}

pub(super) fn below_cmc(seen: &Seen<'_>) -> Vec<Hit> {
    let claimed = seen.claimed;
    let pair = claimed.footer.expanded.as_ref().zip(claimed.cmc.as_ref());
    let below = pair
        .filter(|(expanded, cmc)| expanded.value + expanded.half * 1e-6 < cmc.value * (1.0 - 1e-9));
    below.map_or_else(Vec::new, |(expanded, cmc)| {
        vec![Hit {
            row: None,
            numbers: format!("U = {}, CMC = {}", expanded.as_read(), cmc.as_read()),
            corrected: Some(cmc.value),
        }]
    })
}

pub(super) fn equals_cmc(seen: &Seen<'_>) -> Vec<Hit> {
    let claimed = seen.claimed;
    let pair = claimed.footer.expanded.as_ref().zip(claimed.cmc.as_ref());
    let alike = pair.filter(|(expanded, cmc)| (expanded.value / cmc.value - 1.0).abs() < 1e-9);
    alike.map_or_else(Vec::new, |(expanded, _)| {
        one(format!("U = CMC = {}", expanded.as_read()))
    })
}

pub(super) fn below_reference(seen: &Seen<'_>) -> Vec<Hit> {
    let Some(claimed) = &seen.claimed.footer.expanded else {
        return Vec::new();
    };
    let right = &seen.case.right;
    // A reference that is stated with a larger k is held against U with that of U.
    let own = right.figures(&[], None).k;
    let rows = seen.claimed.rows.iter().zip(&right.lines).enumerate();
    rows.filter_map(|(i, (row, line))| match &row.stated {
        Stated::Certificate { k, .. } => {
            let reference = line.contribution().abs() * k.min(own);
            (claimed.value < reference * (1.0 - 1e-9)).then(|| {
                Hit::of(
                    Some(i),
                    format!(
                        "U = {}, |c|·U({}) = {reference:.3}",
                        claimed.as_read(),
                        row.label()
                    ),
                )
            })
        }
        _ => None,
    })
    .collect()
}

pub(super) fn beyond_belief(seen: &Seen<'_>) -> Vec<Hit> {
    let footer = &seen.claimed.footer;
    let (Some(y), Some(expanded)) = (&footer.y, &footer.expanded) else {
        return Vec::new();
    };
    // Of a result that is a difference near zero a ratio says nothing.
    let sum = seen
        .case
        .derivatives
        .as_ref()
        .is_none_or(|all| all.iter().all(|c| c.abs() == 1.0));
    let relative = (expanded.value / y.value).abs();
    let strange = y.value != 0.0 && !sum && !(1e-9..=1.0).contains(&relative);
    when(strange, || format!("U/|y| = {relative:.2e}"))
}

/// Quantities that cannot be negative.
pub(super) fn below_zero(seen: &Seen<'_>) -> Vec<Hit> {
    const POSITIVE: [&str; 12] = [
        "g", "kg", "mg", "µg", "mL", "L", "mol", "mol/L", "mg/L", "kg/m^3", "K", "mg/kg",
    ];
    let footer = &seen.claimed.footer;
    let (Some(y), Some(expanded)) = (&footer.y, &footer.expanded) else {
        return Vec::new();
    };
    let positive = POSITIVE.contains(&y.unit.as_str()) && y.value > 0.0;
    let title = seen.claimed.title.to_lowercase();
    let difference = ["error", "difference", "correction", "误差", "差", "修正"]
        .iter()
        .any(|word| title.contains(word));
    when(positive && !difference && expanded.value > y.value, || {
        format!("y − U = {:.4}", y.value - expanded.value)
    })
}

/// Relative contributions in a sum of squares, where the model is a sum.
pub(super) fn relative_sum(seen: &Seen<'_>) -> Vec<Hit> {
    let Some(model) = &seen.claimed.model else {
        return Vec::new();
    };
    let relative = |unit: &str| crate::units::fraction(unit).is_some();
    let of_y = seen
        .claimed
        .footer
        .y
        .as_ref()
        .map_or("", |y| y.unit.as_str());
    let is_relative = relative(&seen.claimed.unit) && !relative(of_y);
    let inner = model.trim_start_matches(['-', '+', '(']);
    let is_sum = inner.contains([' ', '+', '-']) && inner.contains(['+', '-']);
    when(is_relative && is_sum && !of_y.is_empty(), || model.clone())
}

/// The tolerance of a statement of conformity, less than three times U.
pub(super) fn test_ratio(seen: &Seen<'_>) -> Vec<Hit> {
    let Some(expanded) = &seen.claimed.footer.expanded else {
        return Vec::new();
    };
    let keys = [
        "tolerance",
        "mpev",
        "mpe of the instrument",
        "permissible error of the instrument",
        "被校仪器最大允许误差",
        "允许误差限",
    ];
    let lines = seen.claimed.words.lines();
    let tolerance = lines
        .filter_map(|line| crate::read::figure_after(line, &keys))
        .next();
    let Some(tolerance) = tolerance else {
        return Vec::new();
    };
    let factor = crate::units::factor(&tolerance.unit, &seen.claimed.unit).unwrap_or(1.0);
    let ratio = tolerance.value * factor / expanded.value;
    when(ratio < 3.0, || format!("T/U = {ratio:.2}"))
}
