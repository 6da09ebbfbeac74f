//! What 256 evaluations have of first order: lengths, degrees of freedom, intervals; and the marks of those of which more has to
//! be known. A lane that is marked is marked by 1, and never unmarked; of its figures nobody asks.

use fearless_simd::{Level, dispatch};

use crate::bounds::Bounds;
use crate::twice::{KnownBlock, select};
use crate::{Block, LANES};

/// `largest` ← |c·u|, where that is larger.
pub fn raise(level: Level, coefficient: f64, u: &Block, largest: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        let (size, before) = ((coefficient * u.0[lane]).abs(), largest.0[lane]);
        largest.0[lane] = if size > before { size } else { before };
    })
}

/// `sum` ← sum + (c·u/largest)².
pub fn add_square(level: Level, coefficient: f64, u: &Block, largest: &Block, sum: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        let part = coefficient * u.0[lane] / largest.0[lane];
        sum.0[lane] += part * part;
    })
}

/// `sum` ← the length of the vector whose largest entry this is, and whose others are such parts of it.
pub fn length(level: Level, largest: &Block, sum: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        let (largest, root) = (largest.0[lane], sum.0[lane].sqrt());
        sum.0[lane] = if largest == 0.0 { 0.0 } else { largest * root };
    })
}

/// `weight` ← the derivative times the coefficient times u; `largest` ← its size, where that is larger or not a number: of what
/// is none the length is none.
pub fn weigh(
    level: Level,
    [derivative, u]: [&Block; 2],
    coefficient: f64,
    weight: &mut Block,
    largest: &mut Block,
) {
    dispatch!(level, _ => for lane in 0..LANES {
        let one = (derivative.0[lane] * coefficient) * u.0[lane];
        weight.0[lane] = one;
        let (size, before) = (one.abs(), largest.0[lane]);
        let larger = (before < size) | size.is_nan();
        largest.0[lane] = if larger { size } else { before };
    })
}

/// `sum` ← sum + (weight/u)⁴/ν: what a component adds to 1/ν_eff (Welch and Satterthwaite).
pub fn add_freedom(level: Level, [weight, u, dof]: [&Block; 3], sum: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        let part = weight.0[lane].abs() / u.0[lane];
        let square = part * part;
        sum.0[lane] += square * square / dof.0[lane];
    })
}

/// `x` ← 1/x.
pub fn invert(level: Level, x: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        x.0[lane] = 1.0 / x.0[lane];
    })
}

/// ν cut to a whole number, where it is rounded to two decimals before; what is below one or beyond all tables stays.
#[inline(always)]
pub fn cut(dof: f64) -> f64 {
    let whole = ((100.0 * dof).round() / 100.0).floor();
    select((1.0..1e9).contains(&dof), whole, dof)
}

/// `entered` ← ν, [`cut`].
pub fn cut_all(level: Level, dof: &Block, entered: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        entered.0[lane] = cut(dof.0[lane]);
    })
}

/// What second-order terms may add.
#[derive(Debug, Clone, Copy)]
pub struct Tolerated {
    /// Factors of the bounds of second derivatives, of their squares, and of third derivatives, in what they add to u².
    pub factors: [f64; 3],
    /// Of u, in the estimate.
    pub shift: f64,
    /// Of u², in u².
    pub added: f64,
}

/// Marks where second-order terms may be more than is tolerated, or u is none.
pub fn bends(level: Level, bounds: &Bounds, u: &Block, most: Tolerated, doubt: &mut Block) {
    let [third, curved, drifting] = most.factors;
    dispatch!(level, _ => for lane in 0..LANES {
        let u = u.0[lane];
        let (bend, drift) = (bounds.second.0[lane] / u, bounds.third.0[lane] / u);
        let added = third * bend + curved * bend * bend + drifting * drift;
        let little = (0.5 * (bounds.diagonal.0[lane] / u) <= most.shift)
            & (added <= most.added)
            & (u > 0.0)
            & (u < f64::MAX);
        doubt.0[lane] = if little { doubt.0[lane] } else { 1.0 };
    })
}

/// `sum` ← sum + |a|·b.
pub fn add_size(level: Level, a: &Block, b: &Block, sum: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        sum.0[lane] += a.0[lane].abs() * b.0[lane];
    })
}

/// The inputs of a result beside each other.
#[derive(Debug)]
pub struct Contest {
    /// The largest part of u(y).
    largest: Block,
    /// All others together.
    others: Block,
    /// Whether an input has u beyond its value.
    exceeds: Block,
}

/// An input in a result.
#[derive(Debug, Clone, Copy)]
pub struct Entrant<'a> {
    /// Its value.
    pub x: &'a Block,
    /// Its standard uncertainty.
    pub own: &'a Block,
    /// The derivative to it.
    pub derivative: &'a Block,
    /// How far that moves within the uncertainties.
    pub bend: &'a Block,
    /// u(y).
    pub u: &'a Block,
}

/// What is seen of an input.
#[derive(Debug, Clone, Copy)]
pub struct Sight {
    /// The part of u(y) below which nothing is seen.
    pub least: f64,
    /// The part of the bend below which a derivative may vanish,
    pub vanished: f64,
    /// unless the bend is less than this part of u(y).
    pub negligible: f64,
}

impl Contest {
    /// Before the first input.
    pub const OPEN: Contest = Contest {
        largest: Block::ZERO,
        others: Block::ZERO,
        exceeds: Block::ZERO,
    };

    /// Adds an input; marks where it may not be seen although it has an uncertainty, or its derivative is none.
    pub fn add(&mut self, level: Level, one: Entrant<'_>, sight: Sight, doubt: &mut Block) {
        let Contest {
            largest,
            others,
            exceeds,
        } = self;
        let least = sight.least;
        dispatch!(level, _ => for lane in 0..LANES {
            let (u, own, x) = (one.u.0[lane], one.own.0[lane], one.x.0[lane].abs());
            let derivative = one.derivative.0[lane];
            let (part, bend) = ((derivative * own).abs() / u, one.bend.0[lane] / u);
            let seen = (part > least)
                & ((part >= sight.vanished * bend) | (bend <= sight.negligible));
            let fine = (seen | (own == 0.0)) & derivative.is_finite();
            doubt.0[lane] = if fine { doubt.0[lane] } else { 1.0 };
            let before = largest.0[lane];
            let larger = part > before;
            others.0[lane] += if larger { before } else { part };
            largest.0[lane] = if larger { part } else { before };
            let beyond = (own > x) & (x > 0.0);
            exceeds.0[lane] = if beyond { 1.0 } else { exceeds.0[lane] };
        })
    }

    /// Marks where one exceeds so many times `part` of the sum of all others: the first limit, or the second where an input has u
    /// beyond its value.
    pub fn end(&self, level: Level, part: f64, limits: [f64; 2], doubt: &mut Block) {
        let Contest {
            largest,
            others,
            exceeds,
        } = self;
        dispatch!(level, _ => for lane in 0..LANES {
            let others = part * others.0[lane];
            let limit = if exceeds.0[lane] == 0.0 { limits[0] } else { limits[1] };
            let exceeds = (others > 0.0) & (largest.0[lane] > limit * others);
            doubt.0[lane] = if exceeds { 1.0 } else { doubt.0[lane] };
        })
    }
}

/// Marks where what is known of values is off by more than `tolerated` of u; marks in `lossy` where doubles may be off by more
/// than `harmless` of the value, and tells whether that is so anywhere without doubt.
pub fn resolves(
    level: Level,
    known: &KnownBlock,
    u: &Block,
    [tolerated, harmless]: [f64; 2],
    doubt: &mut Block,
    lossy: &mut Block,
) -> bool {
    let mut any = 0u64;
    dispatch!(level, _ => for lane in 0..LANES {
        let (limit, doubles) = (tolerated * u.0[lane], known.doubles.0[lane]);
        let resolved = (known.error.0[lane] <= limit) & (doubles <= limit);
        let before = doubt.0[lane];
        doubt.0[lane] = if resolved { before } else { 1.0 };
        let sure = resolved & (before == 0.0);
        let fine = doubles <= harmless * known.value[0].0[lane].abs();
        let loses = sure & !fine;
        lossy.0[lane] = if loses { 1.0 } else { 0.0 };
        any |= u64::from(loses);
    });
    any != 0
}

/// The value by twice the precision, where doubles are off by more than a unit in the last place.
#[inline(always)]
pub fn settled(value: f64, resolved: f64, error: f64) -> f64 {
    let off = (value - resolved).abs();
    if (off > f64::EPSILON * resolved.abs()) & (error < off) {
        resolved
    } else {
        value
    }
}

/// `value` ← [`settled`]; marks where it is no number before or after.
pub fn settle(level: Level, value: &mut Block, known: &KnownBlock, doubt: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        let before = value.0[lane];
        let after = settled(before, known.value[0].0[lane], known.error.0[lane]);
        value.0[lane] = after;
        let fine = before.is_finite() & after.is_finite();
        doubt.0[lane] = if fine { doubt.0[lane] } else { 1.0 };
    })
}

/// `expanded` ← k·u, `ends` ← y ∓ k·u; marks where it is none.
pub fn intervals(
    level: Level,
    [y, u, k]: [&Block; 3],
    expanded: &mut Block,
    ends: &mut [Block; 2],
    doubt: &mut Block,
) {
    let [lower, upper] = ends;
    dispatch!(level, _ => for lane in 0..LANES {
        let (y, half) = (y.0[lane], k.0[lane] * u.0[lane]);
        expanded.0[lane] = half;
        lower.0[lane] = y - half;
        upper.0[lane] = y + half;
        let fine = (half > 0.0) & half.is_finite();
        doubt.0[lane] = if fine { doubt.0[lane] } else { 1.0 };
    })
}

/// Marks where `k` times the size of a weight is more than `expanded`.
pub fn covers(level: Level, weight: &Block, k: f64, expanded: &Block, doubt: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        let covered = k * weight.0[lane].abs() <= expanded.0[lane];
        doubt.0[lane] = if covered { doubt.0[lane] } else { 1.0 };
    })
}

/// Takes the numbers of a column; marks those that are infinite, none, or −0.
pub fn take(level: Level, column: &[f64], cells: &mut Block, doubt: &mut Block) {
    let rows = column.iter().zip(&mut cells.0).zip(&mut doubt.0);
    dispatch!(level, _ => for ((x, cell), doubt) in rows {
        *cell = *x;
        let fine = x.is_finite() & (x.to_bits() != (-0.0f64).to_bits());
        *doubt = if fine { *doubt } else { 1.0 };
    })
}

/// Marks what is not greater than a limit.
pub fn exceed(level: Level, x: &Block, limit: f64, doubt: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        doubt.0[lane] = if x.0[lane] > limit { doubt.0[lane] } else { 1.0 };
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels;

    /// Numbers of all kinds.
    fn numbers(shift: usize) -> Block {
        let mut block = Block::ZERO;
        for (lane, x) in block.0.iter_mut().enumerate() {
            *x = match (lane + shift) % 9 {
                0 => f64::INFINITY,
                1 => -0.0,
                2 => f64::NAN,
                at => ((lane * 7 + shift) % 97) as f64 * 0.37 * if at > 6 { -1e9 } else { 1.0 },
            };
        }
        block
    }

    #[test]
    fn degrees_of_freedom_are_cut_alike_one_by_one_and_together() {
        let dof = Block(std::array::from_fn(|lane| lane as f64 * 0.0999 - 3.0));
        for level in levels() {
            let mut entered = Block::ZERO;
            cut_all(level, &dof, &mut entered);
            for (dof, entered) in dof.0.iter().zip(&entered.0) {
                assert_eq!(*entered, cut(*dof));
            }
        }
        // Two decimals are rounded before the rest is cut; a half is rounded away from zero.
        assert_eq!(
            [cut(6.994), cut(6.995), cut(0.9), cut(1e9)],
            [6.0, 7.0, 0.9, 1e9]
        );
        assert_eq!(cut(f64::INFINITY), f64::INFINITY);
    }

    #[test]
    fn marks_are_the_same_on_every_instruction_set() {
        let [a, b, c] = [0, 3, 5].map(numbers);
        let marked = |level| {
            let mut doubts = [Block::ZERO; 6];
            let bounds = Bounds {
                diagonal: a,
                second: b,
                third: c,
                ..Bounds::ZERO
            };
            let most = Tolerated {
                factors: [0.1, 0.5, 1.0],
                shift: 0.1,
                added: 0.2,
            };
            bends(level, &bounds, &c, most, &mut doubts[0]);
            let (mut contest, unit) = (Contest::OPEN, Block([1.0; LANES]));
            let sight = Sight {
                least: 1e-9,
                vanished: 0.01,
                negligible: 1e-3,
            };
            for [x, own, derivative] in [[&a, &unit, &b], [&unit, &unit, &unit], [&b, &c, &a]] {
                let one = Entrant {
                    x,
                    own,
                    derivative,
                    bend: &b,
                    u: &unit,
                };
                contest.add(level, one, sight, &mut doubts[1]);
            }
            contest.end(level, 0.5, [0.2, 0.1], &mut doubts[2]);
            let known = KnownBlock {
                value: [a, Block::ZERO],
                error: b,
                doubles: c,
            };
            let mut lossy = Block::ZERO;
            let any = resolves(level, &known, &a, [0.01, 0.02], &mut doubts[3], &mut lossy);
            let mut value = a;
            settle(level, &mut value, &known, &mut doubts[4]);
            take(level, &a.0, &mut value, &mut doubts[5]);
            (doubts, lossy, any)
        };
        let all = levels();
        let expected = marked(all[0]);
        for (at, doubt) in expected.0.iter().enumerate() {
            assert!(doubt.0.contains(&1.0), "nothing is marked in {at}");
        }
        all.iter()
            .for_each(|level| assert_eq!(marked(*level), expected));
        // Infinite, none and −0 are marked, and nothing else.
        let marks = expected.0[5].0.iter().zip(&a.0);
        for (mark, x) in marks {
            let fine = x.is_finite() && (*x != 0.0 || x.is_sign_positive());
            assert_eq!(*mark == 0.0, fine, "{x}");
        }
    }

    #[test]
    fn a_length_is_that_of_its_entries() {
        for level in levels() {
            let [x, y] = [Block([3e200; LANES]), Block([-2e200; LANES])];
            let [mut largest, mut sum] = [Block::ZERO; 2];
            raise(level, 1.0, &x, &mut largest);
            raise(level, 2.0, &y, &mut largest);
            add_square(level, 1.0, &x, &largest, &mut sum);
            add_square(level, 2.0, &y, &largest, &mut sum);
            length(level, &largest, &mut sum);
            assert!((sum.0[17] / 5e200 - 1.0).abs() < 1e-15);
        }
    }
}
