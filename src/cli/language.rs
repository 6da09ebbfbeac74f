//! The language of the user.

use std::sync::LazyLock;

use gumption::fault::say;
use gumption::language::Language;

/// The languages of a document.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Languages {
    /// This one.
    One(Language),
    /// Each beside the other, that of the system first.
    Both,
}

impl std::str::FromStr for Languages {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match (text, text.parse()) {
            ("both", _) => Ok(Languages::Both),
            (_, Ok(language)) => Ok(Languages::One(language)),
            (other, Err(_)) => Err(say!(
                "`{other}` is not a language of the report: write `en`, `zh` or `both`"
            )
            .in_language(spoken())),
        }
    }
}

/// The code of the language that the system is set to, by the first of LC_ALL, LC_MESSAGES and LANG that says something
/// (POSIX, 8.2); English where the program does not speak it.
pub(super) fn system_language() -> &'static str {
    let settings = ["LC_ALL", "LC_MESSAGES", "LANG"];
    let said = |name: &&str| {
        let setting = std::env::var(name).ok();
        setting.filter(|setting| !setting.is_empty())
    };
    code_of_locale(&settings.iter().find_map(said).unwrap_or_default())
}

fn code_of_locale(locale: &str) -> &'static str {
    match locale.split(['_', '-', '.', '@']).next() {
        Some(code) if code.eq_ignore_ascii_case("zh") => "zh",
        _ => "en",
    }
}

/// The language in which a command speaks where no document, file or argument is at hand: that of `--lang` if it is
/// among the arguments, else the system's.
pub(super) fn spoken() -> Language {
    static SPOKEN: LazyLock<Language> = LazyLock::new(|| {
        let mut arguments = std::env::args_os().map(|a| a.to_string_lossy().into_owned());
        let stated = arguments.find_map(|argument| match argument.strip_prefix("--lang") {
            Some("") => Some(None),
            Some(joined) => joined.strip_prefix('=').map(|code| Some(code.to_owned())),
            None => None,
        });
        let code = stated.and_then(|code| code.or_else(|| arguments.next()));
        let system = || system_language().parse().ok();
        let stated = code.and_then(|code| code.parse().ok());
        stated.or_else(system).unwrap_or_default()
    });
    *SPOKEN
}

#[cfg(test)]
mod tests {
    use super::{Language, Languages, code_of_locale};

    #[test]
    fn a_document_speaks_one_language_or_both() {
        assert_eq!("zh".parse(), Ok(Languages::One(Language::Chinese)));
        assert_eq!("both".parse(), Ok(Languages::Both));
        assert!("de".parse::<Languages>().is_err());
    }

    #[test]
    fn the_system_says_its_language() {
        for (locale, code) in [
            ("zh_CN.UTF-8", "zh"),
            ("zh", "zh"),
            ("C", "en"),
            ("de_DE", "en"),
        ] {
            assert_eq!(code_of_locale(locale), code, "{locale}");
        }
    }
}
