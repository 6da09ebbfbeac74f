//! Single rows: wrong readings, rows in exchanged order, rows with the wrong sign.

use super::ground::{Ground, Node};
use super::response::{on_output, plain};
use super::{Cell, Modifier, Term, Variation, tied};
use crate::diagnose::evidence::Place;

/// Longer recordings are not searched row by row.
const MOST: usize = 800;

/// Cells of single rows; where rows are averaged, of single means.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let blocks = &ground.frame.blocks;
    if blocks.len() > MOST || blocks.len() < 5 {
        return Vec::new();
    }
    let outliers = blocks.iter().map(|rows| {
        let terms = (0..ground.case().responses.len()).map(|response| {
            on_output(Modifier::number(
                only(ground, rows, 1.0),
                format!("[{}]", named(rows)),
            ))
            .on(response)
        });
        Variation::of(named(rows), terms.collect())
    });
    let mut cells = vec![plain(ground, "outlier", "row", outliers.collect())];
    if blocks.iter().all(|rows| rows.len() == 1) && ground.has_signal() && blocks.len() <= MOST / 2
    {
        cells.push(swapped(ground));
        cells.push(reversed(ground));
    }
    cells
}

fn named(rows: &[usize]) -> String {
    match rows {
        [row] => format!("row {}", row + 1),
        _ => format!("rows {} to {}", rows[0] + 1, rows[rows.len() - 1] + 1),
    }
}

fn only(ground: &Ground<'_>, rows: &[usize], value: f64) -> Vec<f64> {
    let mut modifier = vec![0.0; ground.rows()];
    for row in rows {
        modifier[*row] = value;
    }
    modifier
}

/// Successive rows with each other's output.
fn swapped(ground: &Ground<'_>) -> Cell {
    let variants = (0..ground.rows() - 1).map(|row| {
        let terms = (0..ground.case().responses.len()).map(|response| {
            let model = &ground.fit.linear.values[response];
            let step = model[row + 1] - model[row];
            let mut modifier = vec![0.0; ground.rows()];
            modifier[row] = step;
            modifier[row + 1] = -step;
            (response, modifier)
        });
        let label = format!("rows {} and {}", row + 1, row + 2);
        // All responses of a row are exchanged together: one coefficient.
        let terms = terms.map(|(response, modifier)| {
            let unit = ground.case().responses[response].unit.difference();
            let text = format!("exchange of {label}");
            on_output(Modifier::new(modifier, text, unit)).on(response)
        });
        Variation::of(label.clone(), tied(terms.collect()))
    });
    plain(ground, "swapped", "row", variants.collect())
}

/// Labels for which the whole signal may have the wrong sign.
fn reversed(ground: &Ground<'_>) -> Cell {
    let mut variants = Vec::new();
    for column in &ground.case().columns {
        let Some(labels) = column.labels() else {
            continue;
        };
        let levels = super::levels::present(labels);
        if levels.len() < 2 || levels.len() * 3 > 2 * ground.frame.blocks.len() {
            continue;
        }
        for level in levels {
            let own = super::levels::indicator(labels, level);
            let label = format!("{} {}", column.name, labels.levels[level as usize]);
            let term = Term::new(
                Node::Gain,
                Modifier::number(
                    own.iter().map(|x| -2.0 * x).collect(),
                    format!("-2*[{label}]"),
                ),
            );
            variants.push(Variation::one(label, term));
        }
    }
    Cell::new(
        "polarity",
        super::response::words(ground, "polarity"),
        Place {
            node: ground.name(Node::Gain),
            along: "level".into(),
        },
        variants,
    )
}
