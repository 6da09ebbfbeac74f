//! What is wrong in a user's file: a stable code, the place, what was expected, the mend.
//!
//! A [`Fault`] is plain data, its texts are [`Said`] in the language they are drawn in; a [`Rejection`] draws all faults of a file under the user's own lines. Spans are
//! byte ranges into *the text that the faulty module was given*: the model module is given the
//! text of a formula, and the budget module moves its spans to the place of that formula in the
//! file.

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

extern crate self as gumption_fault;

pub mod catalogue;
pub mod language;
pub mod libraries;
pub mod said;

mod harmless;
mod rejection;
mod system;

use std::ops::Range;

pub use harmless::{harmless, is_obeyed};
pub use rejection::Rejection;
pub use said::{Between, Said, say};
pub use system::of_system;

/// A stable error code with its explanation (`gumption explain CODE`).
///
/// Every module lists its codes in a `pub const CODES: &[Code]` (`budget::faults::CODES`,
/// `model::faults::CODES`, …).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Code {
    /// `B…` for the budget file, `C…` for calibration files, `D…` for case files, `E…` for evaluation, `F…` for fleets, `M…` for the
    /// model language, `Q…` for measurement equations, `R…` for recordings, `U…` for units.
    pub id: &'static str,
    /// One line: what is wrong.
    pub title: &'static str,
    /// The same in Chinese, in the terms of JJF 1001 and JJF 1059.1.
    pub title_zh: &'static str,
    /// A paragraph: why it is refused and what to do, with a small example.
    pub explanation: &'static str,
}

impl Code {
    /// The title, in either language.
    pub fn said(&self) -> Said {
        Said::pair(self.title, self.title_zh)
    }
}

/// Defines the codes of a module, `NAME = "id", "title", "title in Chinese", "explanation";`, and the list of them.
#[macro_export]
macro_rules! codes {
    ($($name:ident = $id:literal, $title:literal, $title_zh:literal, $explanation:literal;)*) => {
        $(
            #[doc = $title]
            pub const $name: $crate::Code = $crate::Code {
                id: $id,
                title: $title,
                title_zh: $title_zh,
                explanation: $explanation,
            };
        )*

        /// Every code of this module, for `gumption explain`.
        pub const CODES: &[$crate::Code] = &[$($name),*];
    };
}

/// One fault in one text.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Which kind of fault.
    pub code: Code,
    /// One sentence without a final stop, with the user's own names and numbers in it.
    pub message: Said,
    /// Where, as bytes of the text.
    pub span: Range<usize>,
    /// Short text under the marked place: what was expected there.
    pub label: Said,
    /// Other places that matter ("first stated here").
    pub related: Vec<(Range<usize>, Said)>,
    /// The mend, in the imperative ("write `half_width`", "add `unit = \"mm\"`").
    pub help: Option<Said>,
}

impl Fault {
    /// A fault with its place and message; add the rest with the builder methods.
    pub fn new(code: Code, span: Range<usize>, message: impl Into<Said>) -> Self {
        Fault {
            code,
            message: message.into(),
            span,
            label: Said::default(),
            related: Vec::new(),
            help: None,
        }
    }

    /// Sets the text under the marked place.
    #[must_use]
    pub fn label(mut self, label: impl Into<Said>) -> Self {
        self.label = label.into();
        self
    }

    /// Marks another place.
    #[must_use]
    pub fn related(mut self, span: Range<usize>, label: impl Into<Said>) -> Self {
        self.related.push((span, label.into()));
        self
    }

    /// Says how to mend it.
    #[must_use]
    pub fn help(mut self, help: impl Into<Said>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Moves every span through `place`, which maps a range of the inner text to the outer one.
    #[must_use]
    pub fn moved(mut self, place: impl Fn(Range<usize>) -> Range<usize>) -> Self {
        self.span = place(self.span);
        for (span, _) in &mut self.related {
            *span = place(span.clone());
        }
        self
    }
}

/// The known name nearest to a misspelt one, if any is near enough to be meant.
///
/// Damerau–Levenshtein distance at most a third of the length (at least one edit), compared
/// without regard to case. Names that have no character in common are never near: `V` is not a
/// misspelt `I`.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = name.to_lowercase();
    let letters = Letters::of(name);
    let mut best: Option<(usize, &str)> = None;
    for known in known {
        let others = Letters::of(known);
        let length = letters.count.max(others.count);
        // Of names that are equally near, the first.
        let nearer = |distance: usize| {
            distance <= (length / 3).max(1)
                && distance < length
                && best.is_none_or(|(least, _)| distance < least)
        };
        if !nearer(letters.least_distance(others)) {
            continue;
        }
        let distance = strsim::damerau_levenshtein(&wanted, &known.to_lowercase());
        if nearer(distance) {
            best = Some((distance, known));
        }
    }
    best.map(|(_, known)| known)
}

/// What tells at a glance that two names are far from each other: of thousands, few are compared letter by letter.
#[derive(Clone, Copy)]
struct Letters {
    /// How many.
    count: usize,
    /// How many without regard to case.
    lower: usize,
    /// Which, by their remainders without regard to case.
    set: u64,
}

impl Letters {
    fn of(name: &str) -> Letters {
        let mut letters = Letters {
            count: 0,
            lower: 0,
            set: 0,
        };
        for letter in name.chars() {
            letters.count += 1;
            for lower in letter.to_lowercase() {
                letters.lower += 1;
                letters.set |= 1 << (u32::from(lower) % u64::BITS);
            }
        }
        letters
    }

    /// No fewer edits make one name of the other: each adds or takes away one letter at most.
    fn least_distance(self, other: Letters) -> usize {
        let only = |one: u64, other: u64| (one & !other).count_ones() as usize;
        let missing = only(self.set, other.set).max(only(other.set, self.set));
        missing.max(self.lower.abs_diff(other.lower))
    }
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn near_names_share_something() {
        assert_eq!(
            nearest("half_widht", ["value", "half_width"]),
            Some("half_width")
        );
        assert_eq!(nearest("i_0", ["V", "I_0"]), Some("I_0"));
        assert_eq!(nearest("r", ["P", "R"]), Some("R"));
        assert_eq!(nearest("J", ["V", "I"]), None);
        assert_eq!(nearest("δ", ["V", "I"]), None);
        assert_eq!(nearest("", ["V"]), None);
    }

    /// What is left out at a glance would not have been near.
    #[test]
    fn the_nearest_is_the_one_that_all_distances_give() {
        let all = |name: &str, known: &[&'static str]| {
            let wanted = name.to_lowercase();
            let distances = known.iter().filter_map(|known| {
                let distance = strsim::damerau_levenshtein(&wanted, &known.to_lowercase());
                let length = name.chars().count().max(known.chars().count());
                let is_near = distance <= (length / 3).max(1) && distance < length;
                is_near.then_some((distance, *known))
            });
            distances
                .min_by_key(|(distance, _)| *distance)
                .map(|(_, known)| known)
        };
        let known = [
            "value",
            "half_width",
            "unit",
            "u",
            "U",
            "dof",
            "İstanbul",
            "Ångström",
            "half_life",
            "µm",
            "readings",
            "reading",
            "",
            "电阻",
            "电压",
        ];
        for name in known {
            let letters: Vec<char> = name.chars().collect();
            for at in 0..=letters.len() {
                let around = |middle: &[char], rest: usize| -> String {
                    letters[..at]
                        .iter()
                        .chain(middle)
                        .chain(&letters[rest.min(letters.len())..])
                        .collect()
                };
                for misspelt in [
                    around(&[], at + 1),
                    around(&['x'], at),
                    around(&['X', 'Y'], at + 1),
                    around(&['é'], at + 2).to_uppercase(),
                ] {
                    assert_eq!(
                        nearest(&misspelt, known),
                        all(&misspelt, &known),
                        "{misspelt}"
                    );
                }
            }
        }
    }
}
