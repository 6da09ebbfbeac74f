//! Where a condition ceases to hold, by halving.

use std::convert::Infallible;

/// The last value for which a condition holds that holds at `from` and mostly not at `to`, to the last bit; `to` where it holds there
/// too, or that is infinite.
pub fn last(from: f64, to: f64, mut holds: impl FnMut(f64) -> bool) -> f64 {
    if to.is_infinite() || holds(to) {
        return to;
    }
    let each = |x| Ok::<bool, Infallible>(holds(x));
    match try_last(from, to, usize::MAX, each) {
        Ok([yes, _]) => yes,
        Err(never) => match never {},
    }
}

/// Two values between which a condition ceases to hold that holds at `from` and not at `to`, after so many halvings; or next to each
/// other, where so many are not needed.
///
/// # Errors
/// Those of the condition.
pub fn try_last<E>(
    from: f64,
    to: f64,
    halvings: usize,
    mut holds: impl FnMut(f64) -> Result<bool, E>,
) -> Result<[f64; 2], E> {
    let (mut yes, mut no) = (from, to);
    for _ in 0..halvings {
        // Of ends without a middle there is none, and a difference of halves is no longer than any number.
        let middle = yes + (no / 2.0 - yes / 2.0);
        if middle == yes || middle == no || middle.is_nan() {
            break;
        }
        match holds(middle)? {
            true => yes = middle,
            false => no = middle,
        }
    }
    Ok([yes, no])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_bit_is_found_either_way() {
        let root = 2.0_f64.sqrt();
        assert_eq!(last(0.0, 1e300, |x| x <= root), root);
        assert_eq!(last(7.0, -7.0, |x| x >= root), root);
        assert_eq!(last(0.0, f64::INFINITY, |_| false), f64::INFINITY);
        assert_eq!(last(0.0, 3.0, |_| true), 3.0);
        assert_eq!(last(1.0, 2.0, |x| x == 1.0), 1.0);
    }

    #[test]
    fn halvings_are_counted_and_faults_handed_on() {
        let mut asked = 0;
        let found = try_last(0.0, 1.0, 10, |x| {
            asked += 1;
            Ok::<bool, ()>(x < 0.3)
        });
        let [yes, no] = found.expect("no fault");
        assert_eq!((asked, no - yes), (10, 2.0_f64.powi(-10)));
        assert!(yes < 0.3 && no >= 0.3);
        assert_eq!(try_last(0.0, 1.0, 10, |_| Err(5)), Err(5));
    }
}
