//! Lines that may state U, of a sheet of which none is understood.

use crate::claim::{Claimed, Unplaced};

use super::{footer, prose};

/// The first line that was not used and may state U, where no U is understood: it calls an uncertainty, or stands right below
/// u_c.
pub fn expanded(claimed: &Claimed) -> Option<&Unplaced> {
    if claimed.footer.expanded.is_some() {
        return None;
    }
    let u_c = claimed.footer.u_c.as_ref().map(|u_c| u_c.at);
    let is_below = |line: &Unplaced| {
        u_c.is_some_and(|u_c| {
            let rows = u_c.row + 1..=u_c.row + footer::ROWS_TO_EXPANDED;
            line.at.sheet == u_c.sheet && rows.contains(&line.at.row)
        })
    };
    let has_figure = |line: &&Unplaced| line.text.contains(|c: char| c.is_ascii_digit());
    let may_state = |line: &&Unplaced| {
        let is_called =
            || footer::may_be_expanded(line.text.split(" ; ").next().unwrap_or_default());
        is_below(line) || prose::states_uncertainty(&line.text) || is_called()
    };
    claimed.unplaced.iter().filter(has_figure).find(may_state)
}
