//! Measurements that may follow a recording: those that the case names, and those that any experiment
//! allows: once more, in the other order, at other angles, between the levels, with conditions that vary
//! otherwise, with specimens exchanged.

use super::case::{Case, Column, Data, Extra, Measure, Role, Rows, repeated};
use super::catalogue::modifiers::{largest, levels_of, map, mean};
use gumption_core::quantity::UnitTable;

/// A column of angles with at most so many values is a mounting.
const MOUNTS: usize = 4;
/// Columns with more values are not set to levels.
const LEVELS: usize = 100;

/// All further measurements of a case.
pub fn extras(case: &Case) -> Vec<Extra> {
    let mut extras = case.actions.clone();
    let recorded = Rows::of(&case.columns, case.rows);
    let again = |measure: Measure, cost: f64, reversed: bool| Extra {
        measure,
        cost,
        rows: repeated(&recorded, &case.columns, reversed),
    };
    extras.push(again(Measure::Again, 1.0, false));
    extras.push(again(Measure::Reversed, 1.0, true));
    for (index, column) in case.columns.iter().enumerate() {
        let mut changed = |measure: Measure, cost: f64, data: Data| {
            let mut extra = again(measure, cost, false);
            extra.rows.data[index] = data;
            extras.push(extra);
        };
        let name = column.name.clone();
        match (&column.data, column.role) {
            (Data::Numbers(numbers), Role::Angle | Role::Stimulus) if case.uses(index) => {
                let levels = levels(numbers);
                if is_angle(column) && levels.len() <= MOUNTS {
                    for value in mountings(column, &levels) {
                        let measure = Measure::Set {
                            column: name.clone(),
                            value,
                            unit: column.unit.typeset(),
                        };
                        changed(measure, 2.0, Data::Numbers(vec![value; numbers.len()]));
                    }
                } else if (3..=LEVELS).contains(&levels.len()) {
                    let turn = turn(column);
                    let between = Data::Numbers(map(numbers, |x| between(x, &levels, turn)));
                    changed(Measure::Between(name), 1.0, between);
                }
            }
            (Data::Numbers(numbers), Role::Covariate) if levels(numbers).len() > 1 => {
                let mean = mean(numbers);
                let opposite = Data::Numbers(map(numbers, |x| mean - 2.0 * (x - mean)));
                changed(Measure::Opposite(name), 1.5, opposite);
            }
            (Data::Labels(labels), Role::Factor) if (2..=LEVELS).contains(&labels.levels.len()) => {
                let count = labels.levels.len() as u32;
                let exchanged = labels.of_row.iter().map(|l| (l + 1) % count);
                let exchanged = Data::labels(labels, exchanged.collect());
                changed(Measure::Exchanged(name), 1.0, exchanged);
            }
            _ => {}
        }
    }
    extras
}

/// Whether a column holds angles, by its role or its unit.
fn is_angle(column: &Column) -> bool {
    column.role == Role::Angle || column.unit.full_turn().is_some()
}

/// Different values in ascending order.
fn levels(numbers: &[f64]) -> Vec<f64> {
    let mut levels = levels_of(numbers);
    let size = largest(&levels);
    levels.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * size);
    levels
}

/// Half way to the next level. The last goes on likewise on a circle of levels, and else a quarter back, so
/// that no two become the same.
fn between(x: f64, levels: &[f64], turn: Option<f64>) -> f64 {
    let at = levels.iter().position(|level| *level >= x).unwrap_or(0);
    if let Some(next) = levels.get(at + 1) {
        return 0.5 * (levels[at] + next);
    }
    let before = levels[at.saturating_sub(1)];
    let step = levels[at] - before;
    let closing = turn.map(|turn| levels[0] + turn - levels[at]);
    match closing.filter(|closing| *closing > 0.0 && *closing < 1.5 * step) {
        Some(closing) => levels[at] + 0.5 * closing,
        None => levels[at] - 0.25 * step,
    }
}

/// A whole turn in the unit of a column of angles.
fn turn(column: &Column) -> Option<f64> {
    let degree = UnitTable::default().parse("°").ok()?;
    let turn = degree.conversion_to(&column.unit)?.apply(360.0);
    is_angle(column).then_some(turn)
}

/// Mountings that were not used: turned by an eighth, a quarter, half a turn.
fn mountings(column: &Column, levels: &[f64]) -> Vec<f64> {
    let of_turn = |turn: f64| {
        let turned = [0.125, 0.25, 0.5].map(|part| levels[0] + part * turn);
        let near = |value: &f64| {
            levels
                .iter()
                .any(|level| (level - value).abs() < 1e-6 * turn)
        };
        turned.into_iter().filter(|value| !near(value)).collect()
    };
    turn(column).map_or_else(Vec::new, of_turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_between_levels() {
        let levels = levels(&[20.0, 0.0, 10.0, 10.0]);
        assert_eq!(levels, [0.0, 10.0, 20.0]);
        assert_eq!(between(0.0, &levels, None), 5.0);
        assert_eq!(between(20.0, &levels, None), 17.5);
        let circle = [0.0, 90.0, 180.0, 270.0];
        assert_eq!(between(270.0, &circle, Some(360.0)), 315.0);
        assert_eq!(between(20.0, &levels, Some(360.0)), 17.5);
    }
}
