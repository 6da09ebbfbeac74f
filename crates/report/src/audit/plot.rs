//! The picture of an audit: recomputed beside claimed, with a mark where a slip sits.

use gumption_audit::Audit;
use gumption_audit::printed::Printed;
use gumption_fault::say;
use gumption_format::document::{Axis, Bar, Layer, Marks, Panel, Plot, Tone};

use super::{is_marked, words};
use crate::language::Language;

/// Rows that a reader takes in.
const MOST_ROWS: usize = 20;
/// As in the table of the rows.
const MARK: &str = " ◀";

/// A quantity twice: as it follows from what is stated, and as it is claimed.
struct Pair {
    name: String,
    recomputed: f64,
    claimed: Option<f64>,
}

impl Pair {
    fn size(&self) -> f64 {
        self.recomputed.max(self.claimed.unwrap_or(0.0))
    }
}

/// Contributions, u_c and U; nothing where there is no calculation.
pub(super) fn contributions(number: usize, audit: &Audit<'_>, l: Language) -> Option<Plot> {
    let right = audit.found.right;
    if !(right.u_c > 0.0 && right.u_c.is_finite()) {
        return None;
    }
    let mut pairs = rows(audit);
    pairs.extend(whole(audit));
    let bars = |end: &dyn Fn(&Pair) -> f64| {
        let bars = pairs.iter().map(|pair| Bar {
            name: pair.name.clone(),
            from: 0.0,
            to: end(pair),
        });
        Marks::Bars(bars.collect())
    };
    let mut layers = vec![Layer::new(
        l.pick("recomputed", "重新计算"),
        Tone::Main,
        bars(&|pair| pair.recomputed),
    )];
    if pairs.iter().any(|pair| pair.claimed.is_some()) {
        let claimed = bars(&|pair| pair.claimed.unwrap_or(f64::NAN));
        layers.push(Layer::new(
            l.pick("claimed", "声称"),
            Tone::Contrast,
            claimed,
        ));
    }
    let title = say!("Contributions, u_c and U: recomputed and as claimed").in_language(l);
    Some(Plot {
        id: format!("audit_{number}"),
        panels: vec![Panel {
            title,
            x: Axis::linear("|c·u|, u_c, U", audit.found.case.claimed.unit.as_str()),
            y: Axis::linear("", ""),
            layers,
        }],
    })
}

/// The largest rows, and those that are marked, in the order of the sheet.
fn rows(audit: &Audit<'_>) -> Vec<Pair> {
    let case = &audit.found.case;
    let pair = |i: usize| {
        let (row, line) = (&case.claimed.rows[i], &case.right.lines[i]);
        let factor = (line.c * line.to_y).abs();
        let claimed = row.contribution.as_ref().map(|claimed| claimed.value.abs());
        let mark = if is_marked(audit, i) { MARK } else { "" };
        Pair {
            name: format!("{}{mark}", words::short(row)),
            recomputed: if line.counted {
                line.contribution().abs()
            } else {
                0.0
            },
            // Without a column of contributions the claimed u stands for what it contributes.
            claimed: claimed.or(row.u.as_ref().map(|u| u.value.abs() * factor)),
        }
    };
    let all = 0..case.claimed.rows.len().min(case.right.lines.len());
    let mut pairs: Vec<(usize, Pair)> = all.map(|i| (i, pair(i))).collect();
    pairs.retain(|(i, pair)| pair.size() > 0.0 || is_marked(audit, *i));
    pairs.sort_by(|(i, a), (j, b)| {
        let marked = is_marked(audit, *j).cmp(&is_marked(audit, *i));
        marked.then(b.size().total_cmp(&a.size()))
    });
    pairs.truncate(MOST_ROWS);
    pairs.sort_by_key(|(i, _)| *i);
    pairs.into_iter().map(|(_, pair)| pair).collect()
}

/// u_c and U. A slip that sits in no row is marked at the first of them that departs.
fn whole(audit: &Audit<'_>) -> [Pair; 2] {
    let (right, footer) = (audit.found.right, &audit.found.case.claimed.footer);
    let best = audit.found.explanations.first();
    let mut is_open = best.is_some_and(|best| best.acts.iter().any(|act| act.row.is_none()));
    [
        ("u_c", right.u_c, &footer.u_c),
        ("U", right.expanded, &footer.expanded),
    ]
    .map(|(name, recomputed, claimed): (_, _, &Option<Printed>)| {
        let departs = claimed
            .as_ref()
            .is_some_and(|own| !own.is_met_by(recomputed));
        let mark = if is_open && departs { MARK } else { "" };
        is_open &= !departs;
        Pair {
            name: format!("{name}{mark}"),
            recomputed,
            claimed: claimed.as_ref().map(|own| own.value),
        }
    })
}
