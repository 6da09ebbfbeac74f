//! Widths of the columns of a table on a page.

/// Widths between the least and the most that columns need, and whether no word is broken: as wide as their texts where
/// there is room for them.
pub(crate) fn widths(least: &[f32], most: &[f32], room: f32) -> (Vec<f32>, bool) {
    let (low, high): (f32, f32) = (least.iter().sum(), most.iter().sum());
    if high <= room {
        return (most.to_vec(), true);
    }
    if low <= room {
        let share = (room - low) / (high - low);
        let widths = least.iter().zip(most);
        return (widths.map(|(a, b)| a + share * (b - a)).collect(), true);
    }
    (
        least.iter().map(|width| width * room / low).collect(),
        false,
    )
}
