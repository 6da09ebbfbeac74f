//! The languages that the program speaks to its users.

/// The language of a report, and of the words around a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// Simplified Chinese.
    Chinese,
}

impl Language {
    /// The form for this language of a text that exists in both.
    pub fn pick<T>(self, english: T, chinese: T) -> T {
        match self {
            Language::English => english,
            Language::Chinese => chinese,
        }
    }
}

impl std::str::FromStr for Language {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "en" => Ok(Language::English),
            "zh" => Ok(Language::Chinese),
            other => Err(format!(
                "`{other}` is not a language of the report: write `en` or `zh`"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn languages_are_chosen_by_their_code() {
        assert_eq!("zh".parse(), Ok(Language::Chinese));
        assert!("de".parse::<Language>().is_err());
    }
}
