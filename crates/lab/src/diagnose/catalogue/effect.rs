//! Entries of the catalogue: what is said of an effect, and the properties by which the rest of the program
//! tells effects apart.

use std::fmt::{self, Display};
use std::sync::LazyLock;

use serde::Deserialize;

use gumption_fault::language::Language;

// `EffectId`, with a variant for each entry, in their order.
include!(concat!(env!("OUT_DIR"), "/effect_id.rs"));

/// An entry of the catalogue.
#[derive(Debug, Clone, Deserialize)]
pub struct Effect {
    /// Stable identifier.
    pub id: EffectId,
    /// Effects of one family are next of kin.
    pub family: String,
    /// Its name; `{x}`, `{y}`, `{z}`, `{p}` stand for columns and quantities.
    pub name: Text,
    /// One paragraph.
    pub prose: Text,
    /// What it adds to the model.
    pub formula: String,
    /// Sizes that are usual, in words; none where they depend on the instrument.
    pub typical: Option<Text>,
    /// The upper end of these, where it can be put into a number.
    pub usual: Option<Usual>,
    /// The size that it must have if it is there at all.
    pub exact: Option<f64>,
    /// The effects of which this is another order, each where the other is: the cause is the same.
    #[serde(default)]
    pub order_of: Vec<EffectId>,
    /// The same on the scale: where the readings hardly vary the two are one.
    pub on_scale: Option<EffectId>,
    /// Whether it is of a higher order in what it follows, or goes with its rate: less likely beforehand.
    #[serde(default)]
    pub is_higher: bool,
    /// How the recording looks, where the entry says that and not why.
    pub pattern: Option<Pattern>,
    /// Several of its variants may act at once: bad rows, jumps.
    #[serde(default)]
    pub repeats: bool,
    /// What kind of explanation it is.
    #[serde(default)]
    pub kind: Kind,
    /// Whether it is a mistake in one recording, which says nothing of another.
    #[serde(default)]
    pub is_slip: bool,
}

/// A text in both languages.
#[derive(Debug, Clone, Deserialize)]
pub struct Text {
    /// English.
    pub en: String,
    /// Simplified Chinese.
    pub zh: String,
}

/// What kind of explanation an entry is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Physics with a name.
    #[default]
    Physics,
    /// Something about the record, not about the instrument: a slip, rounding.
    Record,
    /// An explanation of the user's own.
    Own,
    /// A competitor without a name.
    Unnamed,
}

/// How a recording looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pattern {
    /// A single row is off.
    Row,
    /// The output jumps at some time.
    Jump,
    /// The scale jumps at some time.
    ScaleJump,
    /// A level of a factor differs from the others.
    Level,
    /// The scale of a level of a factor differs from the others.
    ScaleLevel,
    /// A wave of any period.
    Wave,
}

impl Pattern {
    /// Whether another recording has it as well: what happens once, and what runs draw anew, it need not have.
    pub fn recurs(self) -> bool {
        self == Pattern::Wave
    }
}

/// The upper end of the sizes that are usual.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Usual {
    /// The largest shift of the output as a share of full scale.
    Share(f64),
    /// The same for each kelvin of the column that the effect follows.
    PerKelvin(f64),
    /// The same for each square kelvin.
    PerSquareKelvin(f64),
    /// The coefficient, as an angle or a length, whichever the disturbed column is.
    Geometric {
        /// In rad.
        angle: f64,
        /// In m.
        length: f64,
    },
}

impl EffectId {
    /// Its entry in the catalogue.
    pub fn entry(self) -> &'static Effect {
        &effects()[self as usize]
    }
}

impl Display for EffectId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl PartialEq<&str> for EffectId {
    fn eq(&self, other: &&str) -> bool {
        self.as_str() == *other
    }
}

impl Effect {
    /// Whether its name is not complete without the place of its variant: a bad row, a jump, a slip.
    pub fn has_place(&self) -> bool {
        self.repeats || self.exact.is_some()
    }

    /// Whether it only says how the recording looks, which is no name beside something unexplained. What happened once, to a
    /// row or from one on, tells where to look.
    pub fn only_describes(&self) -> bool {
        self.pattern.is_some_and(Pattern::recurs)
    }

    /// Whether a fitted size may belong to this effect: any, unless its size is known.
    pub fn admits(&self, size: f64, u: f64) -> bool {
        /// Standard uncertainties that a fitted size may differ by.
        const FAR: f64 = 4.0;
        /// Part of the size that it may differ by: a slip is hardly ever alone.
        const PART: f64 = 0.2;
        self.exact.is_none_or(|exact| {
            let differs = (size - exact).abs();
            differs.is_nan() || differs <= (FAR * u).max(PART * exact.abs())
        })
    }
}

impl Text {
    /// The text in a language.
    pub fn of(&self, language: Language) -> &str {
        language.pick(&self.en, &self.zh)
    }
}

/// All effects, in the order of the catalogue.
pub fn effects() -> &'static [Effect] {
    #[derive(Deserialize)]
    struct File {
        effect: Vec<Effect>,
    }
    static EFFECTS: LazyLock<Vec<Effect>> = LazyLock::new(|| {
        let file: File = toml::from_str(include_str!("effects.toml"))
            .expect("the catalogue is part of the program");
        file.effect
    });
    &EFFECTS
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::path::Path;

    use super::*;

    #[test]
    fn a_reversal_is_complete() {
        let reversed = EffectId::Polarity.entry();
        assert!(reversed.admits(0.99, 1e-4) && reversed.admits(0.5, 0.2));
        assert!(!reversed.admits(0.002, 1e-4));
        assert!(EffectId::Cubic.entry().admits(0.002, 1e-4));
    }

    #[test]
    fn identifiers_are_unique_and_texts_complete() {
        let all = effects();
        for (at, effect) in all.iter().enumerate() {
            assert_eq!(effect.id as usize, at, "{}", effect.id);
            for text in [
                &effect.name.en,
                &effect.name.zh,
                &effect.prose.en,
                &effect.prose.zh,
                &effect.formula,
            ] {
                assert!(!text.is_empty(), "{}", effect.id);
            }
        }
    }

    /// All source files below a folder, with what is in them.
    fn sources(folder: &Path, found: &mut BTreeMap<String, String>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                sources(&path, found);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let name = path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap();
                found.insert(name.to_string_lossy().replace('\\', "/"), text);
            }
        }
    }

    #[test]
    fn an_effect_is_its_entry_and_its_forms() {
        #[derive(Deserialize)]
        struct Entry {
            id: EffectId,
            forms: Vec<String>,
        }
        #[derive(Deserialize)]
        struct File {
            effect: Vec<Entry>,
        }
        const FOLDER: &str = "src/diagnose/catalogue/";
        let entries: File = toml::from_str(include_str!("effects.toml")).unwrap();
        let mut files = BTreeMap::new();
        let own = Path::new(env!("CARGO_MANIFEST_DIR"));
        sources(&own.join("src"), &mut files);
        for Entry { id, forms } in entries.effect {
            let quoted = format!("\"{id}\"");
            let typed = format!("EffectId::{id:?}");
            // The name itself, not the beginning of a longer one.
            let names = |text: &str| {
                let code = text.split("#[cfg(test)]").next().unwrap_or_default();
                let mut rests = code.split(&typed).skip(1);
                rests.any(|rest| !rest.starts_with(|c: char| c.is_alphanumeric()))
            };
            let mut found = Vec::new();
            for (name, text) in &files {
                // There a word is a key of the user's file.
                if name.starts_with("src/experiment/") {
                    continue;
                }
                assert!(!text.contains(&quoted), "{name} has {id} as a text");
                if names(text) {
                    let form = name.strip_prefix(FOLDER).unwrap_or(name);
                    found.push(form.trim_end_matches(".rs").to_owned());
                }
            }
            assert_eq!(found, forms, "files that name {id}");
        }
    }
}
