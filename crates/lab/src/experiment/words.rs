//! Texts in both languages.

use gumption_format::toml::Slot;

/// A text in both languages; Chinese is the English one where nobody has translated it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Words {
    /// English.
    pub en: String,
    /// Chinese.
    pub zh: String,
}

impl Words {
    /// In both languages.
    pub fn new(en: String, zh: String) -> Words {
        Words { en, zh }
    }

    /// The same in both languages.
    pub fn plain(text: &str) -> Words {
        Words {
            en: text.to_owned(),
            zh: text.to_owned(),
        }
    }
}

/// The text that the file states in both languages.
pub(crate) fn words(en: &Slot<String>, zh: &Slot<String>) -> Option<Words> {
    let en = en.as_ref()?.value.clone();
    let zh = zh
        .as_ref()
        .map_or_else(|| en.clone(), |zh| zh.value.clone());
    Some(Words { en, zh })
}
