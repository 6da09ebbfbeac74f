//! Which part of the trials decides an order statistic, told from counts.
//!
//! Counts of a partition of the number line tell the rank of every value up to its cell. A quantile
//! needs the values of one cell only. For the shortest interval, cells bound the width of every
//! candidate from both sides, and only those cells matter that could hold the shortest one.

use super::interval::Ranks;

/// Values that lie side by side: those of ranks `below` + 1 … `below` + `count`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// No value is smaller.
    pub(super) low: f64,
    /// No value is larger.
    pub(super) high: f64,
    pub(super) below: u64,
    pub(super) count: u64,
}

impl Cell {
    /// The largest rank.
    pub(super) fn end(&self) -> u64 {
        self.below + self.count
    }

    /// Whether all values are the same, so that nothing more is to be known.
    pub(super) fn is_known(&self) -> bool {
        self.low == self.high
    }
}

/// What is asked of the order of some values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wanted {
    /// First and last rank of stretches that are wanted.
    pub(super) ranks: Vec<[u64; 2]>,
    /// For the shortest interval.
    pub(super) shortest: Option<Ranks>,
    /// How many values there are.
    pub(super) count: u64,
}

/// By how much one candidate for the shortest interval may be longer than another and yet turn out to be the
/// shorter one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slack {
    pub(super) fixed: f64,
    /// Over the root of the number of ranks between the two.
    pub(super) per_root_of_ranks: f64,
}

impl Slack {
    /// All values are there.
    pub(super) const NONE: Slack = Slack {
        fixed: 0.0,
        per_root_of_ranks: 0.0,
    };
}

/// Standard errors by which a plan made from part of the values is widened. Should they not do, which happens
/// once in ten thousand runs, values are drawn again.
pub(super) const ERRORS: f64 = 4.5;

impl Wanted {
    /// The same where the values are the first of more: ranks move in proportion, and
    /// by chance.
    pub(super) fn widened(&self) -> Wanted {
        let widen = |[first, last]: &[u64; 2]| {
            let first = first.saturating_sub(self.reach(*first)).max(1);
            [first, (last + self.reach(*last)).min(self.count)]
        };
        Wanted {
            ranks: self.ranks.iter().map(widen).collect(),
            ..self.clone()
        }
    }

    /// The first and the last rank between which no candidate for the shortest interval ends, nor
    /// will when more values have come.
    pub(super) fn middle(&self) -> [u64; 2] {
        match self.shortest {
            Some(ranks) => {
                let [last, covered] = [ranks.last as u64, ranks.covered as u64];
                let [above, below] = [last, covered].map(|rank| self.reach(rank));
                [last + above, covered.saturating_sub(below)]
            }
            None => [0, self.count],
        }
    }

    /// By how much a rank of now may differ from that of the same share of more values.
    fn reach(&self, rank: u64) -> u64 {
        let n = self.count as f64;
        let share = rank as f64 / n;
        (ERRORS * (n * share * (1.0 - share)).max(1.0).sqrt()).ceil() as u64 + 2
    }

    /// Which of the cells (ascending, none empty, perhaps with gaps) decide what is wanted.
    /// Candidates for the shortest interval count unless they are longer than one that exists by
    /// more than the slack.
    pub(super) fn cells(&self, cells: &[Cell], slack: Slack) -> Vec<bool> {
        let mut needed = vec![false; cells.len()];
        for [first, last] in &self.ranks {
            let from = cell_of(cells, *first);
            for (cell, needed) in cells.iter().zip(&mut needed).skip(from) {
                if cell.below >= *last {
                    break;
                }
                *needed = true;
            }
        }
        if let Some(ranks) = self.shortest {
            let (mut shortest, mut place) = (f64::INFINITY, 0);
            for_each_pair(cells, ranks, |low, high| {
                let width = cells[high].high - cells[low].low;
                if width < shortest {
                    (shortest, place) = (width, cells[low].below);
                }
            });
            for_each_pair(cells, ranks, |low, high| {
                let away = cells[low].below.abs_diff(place) + cells[low].count;
                let limit = shortest + slack.fixed + slack.per_root_of_ranks * (away as f64).sqrt();
                // NaN, of infinite ends, is no proof either.
                let longer = cells[high].low - cells[low].high > limit;
                if !longer {
                    needed[low] = true;
                    needed[high] = true;
                }
            });
        }
        needed
    }
}

/// The cell that holds a rank, or the next one above.
pub(super) fn cell_of(cells: &[Cell], rank: u64) -> usize {
    cells.partition_point(|cell| cell.end() < rank)
}

/// All pairs of cells such that some interval reaches from one to the other.
pub(super) fn for_each_pair(cells: &[Cell], ranks: Ranks, mut visit: impl FnMut(usize, usize)) {
    let (covered, last) = (ranks.covered as u64, ranks.last as u64);
    let first = cells.first().map_or(0, |cell| cell.below);
    let (mut low, mut high) = (0, cell_of(cells, first + 1 + covered));
    while let (Some(from), Some(to)) = (cells.get(low), cells.get(high)) {
        if from.below >= last {
            break;
        }
        let end = from.end().min(last) + covered;
        if from.below + covered < to.end() && to.below < end {
            visit(low, high);
        }
        // What ends first has no further partner. Which it is cannot be foreseen, so there is no branch.
        low += usize::from(end <= to.end());
        high += usize::from(to.end() <= end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten values in each of the cells 0–1, 1–2, … 9–10, but a gap between 4 and 5.
    fn cells() -> Vec<Cell> {
        let cell = |i: u64| Cell {
            low: i as f64,
            high: (i + 1) as f64,
            below: 10 * i,
            count: 10,
        };
        (0..10).filter(|i| *i != 4).map(cell).collect()
    }

    #[test]
    fn ranks_need_their_cells() {
        let wanted = Wanted {
            ranks: vec![[1, 1], [30, 31], [100, 100]],
            shortest: None,
            count: 100,
        };
        let needed = wanted.cells(&cells(), Slack::NONE);
        let indices: Vec<_> = (0..9).filter(|i| needed[*i]).collect();
        assert_eq!(indices, [0, 2, 3, 8]);
        assert_eq!(cell_of(&cells(), 45), 4);
    }

    #[test]
    fn pairs_leave_out_what_a_gap_hides() {
        let ranks = Ranks {
            covered: 40,
            symmetric: 30,
            last: 60,
        };
        let mut pairs = Vec::new();
        for_each_pair(&cells(), ranks, |low, high| pairs.push((low, high)));
        // Cell 5 – 6 is the fifth in the list.
        assert_eq!(pairs, [(1, 4), (2, 5), (3, 6), (4, 8)]);
    }

    #[test]
    fn long_candidates_are_left_out() {
        let mut cells = cells();
        // A wide cell at the upper end.
        cells[8].high = 30.0;
        cells[8].low = 25.0;
        let wanted = Wanted {
            ranks: vec![],
            shortest: Some(Ranks {
                covered: 90,
                symmetric: 5,
                last: 10,
            }),
            count: 100,
        };
        assert_eq!(
            wanted
                .cells(&cells, Slack::NONE)
                .iter()
                .filter(|n| **n)
                .count(),
            2
        );
    }

    #[test]
    fn widening_stays_inside() {
        let wanted = Wanted {
            ranks: vec![[1, 10], [500, 501]],
            shortest: None,
            count: 1000,
        };
        let wide = wanted.widened();
        assert_eq!(wide.ranks[0][0], 1);
        // 10 + 4.5·√(1000·0.01·0.99) + 2, 500 ∓ 4.5·√250 ∓ 2.
        assert_eq!(wide.ranks[0][1], 27);
        assert_eq!(wide.ranks[1], [500 - 74, 501 + 74]);
    }
}
