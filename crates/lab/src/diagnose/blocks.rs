//! Blocks of consecutive rows: of each, the mean is one observation.

use super::case::{Blocks, Case, Role};
use super::catalogue::modifiers::{mean, successive};
use crate::recording::Labels;

/// Prolonged recordings in time are averaged in blocks, unless the case says otherwise.
const MOST_BLOCKS: usize = 400;

/// The most observations of which matrices for laws of the noise are compared: larger ones take too long.
pub(super) const MOST_COMPARED: usize = 600;

/// The most observations of which matrices with what outputs have in common are compared. They fall apart into rows, so that their
/// room alone is a bound: 400 blocks of three outputs take 12 MB for each.
pub(super) const MOST_IN_COMMON: usize = 1200;

/// So are recordings without a time that have more rows: work and memory grow with their square.
const MOST_ROWS: usize = 1000;

/// Means keep at least this share of the variance of every stimulus and angle that the equations use: what they lose would
/// have made effects stronger by 5 % at most.
const KEPT: f64 = 0.9;

/// The blocks of a case, without the rows before each has settled. Where columns move so fast that means over blocks that
/// cover the recording would lose them, shorter blocks are spread over it.
pub(super) fn blocks(case: &Case) -> Vec<Vec<usize>> {
    let size = match &case.averaging.blocks {
        Blocks::Rows => 1,
        Blocks::Dwells(_) => usize::MAX,
        Blocks::AtMost(most) => case.rows.div_ceil((*most).max(1)),
        Blocks::Auto => chosen(case),
    };
    let mut blocks = cut(case, size);
    let most = MOST_BLOCKS.max(MOST_COMPARED / case.responses.len().max(1));
    let is_fast = size < case.rows.div_ceil(MOST_BLOCKS);
    if case.averaging.blocks == Blocks::Auto && is_long(case) && is_fast && blocks.len() > most {
        blocks = spread(blocks, most);
    }
    for block in &mut blocks {
        let settle = case.averaging.settle.min(block.len() - 1);
        block.drain(..settle);
    }
    blocks
}

/// Whether rows are averaged unless the case says otherwise.
fn is_long(case: &Case) -> bool {
    case.rows > MOST_ROWS || case.with_role(Role::Time).next().is_some()
}

/// As many rows as blocks of a long recording may have.
fn chosen(case: &Case) -> usize {
    if !is_long(case) {
        return 1;
    }
    let mut size = case.rows.div_ceil(MOST_BLOCKS);
    // What was applied: effects that are added to a model as columns leave its blocks as they are.
    let used = (0..case.columns.len()).filter(|column| {
        let role = case.columns[*column].role;
        matches!(role, Role::Stimulus | Role::Angle) && case.uses(*column)
    });
    let used: Vec<&[f64]> = used.filter_map(|c| case.columns[c].numbers()).collect();
    while size > 1 && !used.iter().all(|numbers| kept(numbers, size) >= KEPT) {
        size = size.div_ceil(2);
    }
    size
}

/// Share of the variance of a column that means of so many rows keep.
fn kept(numbers: &[f64], size: usize) -> f64 {
    let about = |values: &[f64], middle: f64| -> f64 {
        values.iter().map(|x| (x - middle) * (x - middle)).sum()
    };
    let whole = about(numbers, mean(numbers));
    let within: f64 = numbers.chunks(size).map(|own| about(own, mean(own))).sum();
    if whole > 0.0 {
        1.0 - within / whole
    } else {
        1.0
    }
}

/// Successive rows with the same labels, so many at most.
fn cut(case: &Case, size: usize) -> Vec<Vec<usize>> {
    let labels: Vec<&Labels> = match &case.averaging.blocks {
        Blocks::Dwells(columns) => (columns.iter())
            .filter_map(|column| case.columns[*column].labels())
            .collect(),
        _ => case.labels().collect(),
    };
    let same = |a: usize, b: usize| labels.iter().all(|l| l.of_row[a] == l.of_row[b]);
    let blocks = successive(case.rows, size, same).into_iter();
    blocks.map(Iterator::collect).collect()
}

/// Some of many blocks, one in each of equal parts of the recording; where in it is shifted by the golden ratio from part to
/// part, so that no period of a stimulus meets them all alike.
fn spread(blocks: Vec<Vec<usize>>, most: usize) -> Vec<Vec<usize>> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let part = blocks.len() as f64 / most as f64;
    let at = |number: usize| ((number as f64 + (number as f64 * GOLDEN).fract()) * part) as usize;
    let chosen: std::collections::BTreeSet<usize> = (0..most).map(at).collect();
    let all = blocks.into_iter().enumerate();
    all.filter(|(number, _)| chosen.contains(number))
        .map(|(_, block)| block)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_lose_what_moves_within_them() {
        let slow: Vec<f64> = (0..4000).map(|row| libm::sin(row as f64 / 300.0)).collect();
        let fast: Vec<f64> = (0..4000).map(|row| libm::sin(row as f64)).collect();
        assert!(kept(&slow, 10) > 0.999);
        assert!(kept(&fast, 10) < 0.2);
        assert_eq!(kept(&[3.0; 50], 10), 1.0);
    }

    #[test]
    fn blocks_are_spread_evenly() {
        let all: Vec<Vec<usize>> = (0..50_000).map(|row| vec![row]).collect();
        let some = spread(all, 1000);
        assert_eq!(some.len(), 1000);
        let gaps = some.windows(2).map(|pair| pair[1][0] - pair[0][0]);
        assert!(gaps.clone().all(|gap| (1..=100).contains(&gap)));
        // No remainder of a period is preferred.
        let phases = some.iter().filter(|block| block[0] % 10 < 5).count();
        assert!((450..550).contains(&phases));
    }
}
