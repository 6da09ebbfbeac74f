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

    /// The other one.
    pub fn other(self) -> Self {
        self.pick(Language::Chinese, Language::English)
    }

    /// What stands between the parts of a sentence.
    pub fn comma(self) -> &'static str {
        self.pick(", ", "，")
    }

    /// What stands between the members of a list.
    pub fn list_comma(self) -> &'static str {
        self.pick(", ", "、")
    }

    /// What stands between sentences that belong together.
    pub fn semicolon(self) -> &'static str {
        self.pick("; ", "；")
    }

    /// A name and what is said of it: `name: text`.
    pub fn with_head(self, head: &str, text: &str) -> String {
        [head, text].join(self.pick(": ", "："))
    }

    /// A word that something else is put beside: `text (aside)`.
    pub fn with_aside(self, text: &str, aside: &str) -> String {
        self.pick(format!("{text} ({aside})"), format!("{text}（{aside}）"))
    }

    /// Joins names: `a, b and c`.
    pub fn list(self, names: &[String]) -> String {
        match (self, names) {
            (_, []) => String::new(),
            (_, [one]) => one.clone(),
            (Language::English, [front @ .., last]) => format!("{} and {last}", front.join(", ")),
            (Language::Chinese, [front @ .., last]) => in_chinese(front, "和", last),
        }
    }

    /// Joins names, of which it gives the first ones and a count where they are many: the machine form has all.
    pub fn first_of(self, names: &[String]) -> String {
        /// Most names that are read, and those that are given of more.
        const MOST: usize = 16;
        const FIRST: usize = 8;
        if names.len() <= MOST {
            return self.list(names);
        }
        let (first, others) = (&names[..FIRST], names.len() - FIRST);
        match self {
            Language::English => format!("{} and {others} others", first.join(", ")),
            Language::Chinese => format!("{} 等 {} 项", first.join("、"), names.len()),
        }
    }

    /// Joins names of which one holds: `a or b or c`. Names may have commas in them, so that English has none
    /// between them.
    pub fn either(self, names: &[String]) -> String {
        match (self, names) {
            (Language::Chinese, [front @ .., last]) if !front.is_empty() => {
                in_chinese(front, "或", last)
            }
            _ => names.join(" or "),
        }
    }
}

/// Names with a word in front of the last one, with blanks between it and Latin letters.
fn in_chinese(front: &[String], word: &str, last: &str) -> String {
    let beside = |c: Option<char>| c.is_some_and(|c| c.is_ascii_alphanumeric());
    let blank = |c| if beside(c) { " " } else { "" };
    let front = front.join("、");
    let around = (front.chars().last(), last.chars().next());
    format!("{front}{}{word}{}{last}", blank(around.0), blank(around.1))
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
