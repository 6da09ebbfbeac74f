//! Places of a claim, where the table that it was read from had been rearranged.

use crate::claim::{Claimed, Row, Stated};
use crate::printed::{Place, Printed};

impl Claimed {
    /// Calls every cell by its place in the file.
    pub(crate) fn relocate(&mut self, to: impl Fn(Place) -> Place) {
        let figure = |figure: &mut Printed| figure.at = to(figure.at);
        let footer = &mut self.footer;
        let whole = [
            &mut footer.y,
            &mut footer.u_c,
            &mut footer.nu_eff,
            &mut footer.k,
            &mut footer.expanded,
            &mut self.cmc,
        ];
        whole.into_iter().flatten().for_each(figure);
        for row in self.rows.iter_mut().chain(&mut self.absent) {
            row.at = to(row.at);
            row.figures().for_each(figure);
        }
        let stale = self.stale.iter_mut().map(|one| &mut one.at);
        let understood = self.understood.iter_mut().map(|one| &mut one.at);
        let unread = self.rows.iter_mut().flat_map(|row| {
            let unread = [
                &mut row.unread_unit,
                &mut row.unread_distribution,
                &mut row.unread_used,
            ];
            unread.into_iter().flatten()
        });
        let unplaced = self.unplaced.iter_mut().chain(unread);
        let unplaced = unplaced.map(|one| &mut one.at);
        for at in stale.chain(understood).chain(unplaced) {
            *at = to(*at);
        }
    }
}

impl Row {
    /// All its figures.
    fn figures(&mut self) -> impl Iterator<Item = &mut Printed> {
        let own = [
            &mut self.value,
            &mut self.used,
            &mut self.divisor,
            &mut self.u,
            &mut self.c,
            &mut self.contribution,
            &mut self.dof,
            &mut self.share,
        ];
        let (first, second) = match &mut self.stated {
            Stated::Nothing => (None, None),
            Stated::Certificate { expanded: one, .. }
            | Stated::Limits {
                half_width: one, ..
            }
            | Stated::FullWidth { width: one, .. }
            | Stated::Step { step: one }
            | Stated::Deviation { s: one, .. }
            | Stated::Range { range: one, .. }
            | Stated::Standard { u: one, .. } => (Some(one), None),
            Stated::Unequal { plus, minus } => (Some(plus), Some(minus)),
        };
        own.into_iter().flatten().chain(first).chain(second)
    }
}
