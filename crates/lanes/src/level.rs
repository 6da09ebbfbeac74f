//! The instruction set that the kernels run on.
//!
//! [`level`] is what programs use; [`levels`] lets a test run a kernel on every instruction set
//! that this processor has and compare the bits.

use std::sync::OnceLock;

pub use fearless_simd::Level;

/// Names an instruction set that is to be used instead of the best one, as [`name`] does: `AVX2`, say. Results
/// are the same with each; a name that this processor does not know is passed over.
pub const CHOICE: &str = "GUMPTION_INSTRUCTION_SET";

/// The best instruction set of this processor, or the one that [`CHOICE`] asks for; found on the first
/// call.
pub fn level() -> Level {
    static FOUND: OnceLock<Level> = OnceLock::new();
    *FOUND.get_or_init(|| {
        let wanted = std::env::var(CHOICE).unwrap_or_default();
        let chosen = levels().into_iter().find(|level| name(*level) == wanted);
        chosen.unwrap_or_else(Level::new)
    })
}

/// Every instruction set that this processor has, from the plainest to the best.
pub fn levels() -> Vec<Level> {
    let best = Level::new();
    // The list is empty on processors with a single level, hence the push of `best` at the end.
    #[allow(unused_mut)]
    let mut plainer: Vec<Level> = Vec::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if best.as_sse4_2().is_some() {
            plainer.extend(best.as_sse2().map(Level::Sse2));
        }
        if best.as_avx2().is_some() {
            plainer.extend(best.as_sse4_2().map(Level::Sse4_2));
        }
        if best.as_avx512().is_some() {
            plainer.extend(best.as_avx2().map(Level::Avx2));
        }
    }
    plainer.push(best);
    plainer
}

/// The name of an instruction set, as processors' makers write it.
pub fn name(level: Level) -> &'static str {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if level.as_avx512().is_some() {
            return "AVX-512";
        }
        if level.as_avx2().is_some() {
            return "AVX2";
        }
        if level.as_sse4_2().is_some() {
            return "SSE4.2";
        }
        if level.as_sse2().is_some() {
            return "SSE2";
        }
    }
    #[cfg(target_arch = "aarch64")]
    if level.as_neon().is_some() {
        return "NEON";
    }
    let _ = level;
    "portable"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_level_is_the_best_one_and_none_occurs_twice() {
        let names: Vec<String> = levels().iter().map(|l| format!("{l:?}")).collect();
        assert_eq!(names.last(), Some(&format!("{:?}", Level::new())));
        let mut unique = names.clone();
        unique.dedup();
        assert_eq!(names, unique);
        let mut called: Vec<&str> = levels().into_iter().map(name).collect();
        called.dedup();
        assert_eq!(called.len(), names.len());
    }
}
