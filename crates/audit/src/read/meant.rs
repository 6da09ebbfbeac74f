//! What figures are of which the head of their column leaves it open: what makes the sums of the sheet come true.

use crate::claim::{Claimed, Row};

use super::columns::Role;
use super::words::has;

/// u_c as the sheet states it, or as its U and k do, and half a unit of its last digit.
fn stated_sum(claimed: &Claimed) -> Option<(f64, f64)> {
    let footer = &claimed.footer;
    let stated = footer.u_c.as_ref().map(|u_c| (u_c.value, u_c.half));
    stated.or_else(|| {
        let (expanded, k) = (footer.expanded.as_ref()?, footer.k.as_ref()?);
        Some((expanded.value / k.value, expanded.half / k.value))
    })
}

/// Figures behind the coefficients, of which the head says no more than `u_i`, are u where u_c is the sum of their squares
/// with the coefficients, and not without.
pub fn u_by_sum(claimed: &mut Claimed) {
    let Some((u_c, half)) = stated_sum(claimed) else {
        return;
    };
    let sum = |with_c: bool| {
        let square = |row: &Row| {
            let c = row.c.as_ref().filter(|_| with_c).map_or(1.0, |c| c.value);
            let part = row.contribution.as_ref().map_or(0.0, |u| c * u.value);
            part * part
        };
        libm::sqrt(claimed.rows.iter().map(square).sum())
    };
    let near = |sum: f64| (sum - u_c).abs() <= half + 0.01 * u_c;
    if near(sum(true)) && !near(sum(false)) {
        for row in &mut claimed.rows {
            row.u = row.contribution.take();
        }
    }
}

/// What says of a figure that it is no standard uncertainty.
const DIVIDED: &[&str] = &[
    "±",
    "+/-",
    "limit",
    "half-width",
    "half width",
    "tolerance",
    "mpe",
    "permissible",
    "expanded",
    "k=",
    "k =",
    "95 %",
    "95%",
    "full width",
    "半宽",
    "极限",
    "允差",
    "允许",
    "扩展",
    "置信",
];

/// The same claim, where the figures below a head that says no more than `Uncertainty` are standard uncertainties, but for
/// rows whose words say that they are not.
pub fn with_standard(claimed: &Claimed, head: &str) -> Claimed {
    let mut other = claimed.clone();
    for row in &mut other.rows {
        let is_open = !has(&row.words.to_lowercase(), DIVIDED);
        if is_open && row.used.is_some() {
            row.u = row.used.take();
        }
    }
    for one in &mut other.understood {
        if one.role == Role::Used.name() && one.text == head {
            one.role = BY_SUM;
        }
    }
    other
}

/// As what such a column was taken.
const BY_SUM: &str = "u, since u_c follows from it";

/// Of two readings of one sheet the one with which its u_c follows, or does but for a row or a root: the first where both do,
/// or neither.
pub fn better(first: Claimed, second: Claimed) -> Claimed {
    match misses(&second) < misses(&first) {
        true => second,
        false => first,
    }
}

/// How many slips it takes for u_c to follow, of the two that are the most usual in a sum: a row left out, and amounts added
/// as they are; two where it is none of them. And how far from its printed digits it then is.
fn misses(claimed: &Claimed) -> (usize, f64) {
    let Some((u_c, half)) = stated_sum(claimed) else {
        return (2, 0.0);
    };
    let square = |row: &Row| {
        let (u, _) = row.stated.standard()?;
        let part = row.c.as_ref().map_or(1.0, |c| c.value) * u * row.relative_factor();
        row.not_counted.is_none().then_some(part * part)
    };
    let squares: Vec<f64> = claimed.rows.iter().filter_map(square).collect();
    let sum: f64 = squares.iter().sum();
    let near = |square: f64| {
        let beyond = (libm::sqrt(square) - u_c).abs() - half;
        (beyond <= 0.01 * u_c).then_some(beyond.max(0.0))
    };
    let added: f64 = squares.iter().map(|own| libm::sqrt(*own)).sum();
    let slipped = squares.iter().map(|own| sum - own).chain([added * added]);
    let nearest = || slipped.filter_map(near).min_by(f64::total_cmp);
    near(sum)
        .map(|beyond| (0, beyond))
        .or_else(|| nearest().map(|beyond| (1, beyond)))
        .unwrap_or((2, 0.0))
}
