//! Libraries that give up by a panic: it ends neither the program nor the pages of others, and nothing is printed.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether a panic of this thread is nobody's business.
    static IS_CONTAINED: Cell<bool> = const { Cell::new(false) };
}

/// What is computed; nothing where that ends in a panic. What is computed from is not used afterwards.
pub fn contained<T>(compute: impl FnOnce() -> T) -> Option<T> {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_CONTAINED.get() {
                usual(panic);
            }
        }));
    });
    let before = IS_CONTAINED.replace(true);
    let computed = catch_unwind(AssertUnwindSafe(compute));
    IS_CONTAINED.set(before);
    computed.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_no_value() {
        assert_eq!(contained(|| 1), Some(1));
        let numbers: Vec<u8> = Vec::new();
        assert_eq!(contained(|| numbers[numbers.len()]), None);
        assert!(!IS_CONTAINED.get());
    }
}
