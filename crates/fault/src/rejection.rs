//! A refused file: all of its faults, drawn under the user's own lines.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use super::{Fault, Said};
use crate::harmless::{harmless, harmless_in_place};
use crate::language::Language;

/// Faults of a file that are shown.
const SHOWN: usize = 25;

/// A file that was refused, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Rejection {
    /// Name of the file as the user gave it.
    pub name: String,
    /// Its text (empty when it could not be read).
    pub text: String,
    /// All faults, in the order of the file.
    pub faults: Vec<Fault>,
    /// Other files that it uses and that have faults themselves.
    pub others: Vec<Rejection>,
}

impl Rejection {
    /// What is said first, for a sentence about the file.
    pub fn said(&self) -> Said {
        let first = self.faults.first();
        first.map_or_else(Said::default, |fault| fault.message.clone())
    }

    /// The faults that are shown: nobody mends more at once.
    pub fn shown(&self) -> &[Fault] {
        &self.faults[..self.faults.len().min(SHOWN)]
    }

    /// Sorts the faults by place and drops repeated ones.
    pub fn new(name: &str, text: &str, mut faults: Vec<Fault>) -> Self {
        faults.sort_by(|a, b| {
            (a.span.start, a.span.end, a.code.id).cmp(&(b.span.start, b.span.end, b.code.id))
        });
        faults.dedup();
        Rejection {
            name: name.into(),
            text: text.into(),
            faults,
            others: Vec::new(),
        }
    }

    /// Draws every fault, and counts them, in English.
    pub fn render(&self, color: bool) -> String {
        self.render_in(Language::English, color)
    }

    /// Draws every fault, and counts them.
    pub fn render_in(&self, language: Language, color: bool) -> String {
        let renderer = if color {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let mut out = String::new();
        for fault in self.shown() {
            out += &self.draw(fault, language, &renderer);
            out += "\n\n";
        }
        out += &self.count(language);
        for other in &self.others {
            out += "\n";
            out += &other.render_in(language, color);
        }
        out
    }

    /// The closing line: how many faults there are, and whether all of them are shown.
    fn count(&self, language: Language) -> String {
        let count = self.faults.len();
        let rest = if count > SHOWN {
            language.pick(
                format!("; the first {SHOWN} are shown"),
                format!("；仅列出前 {SHOWN} 处"),
            )
        } else {
            String::new()
        };
        let name = harmless(&self.name);
        match (language, name.is_empty()) {
            (Language::English, unnamed) => {
                let plural = if count == 1 { "" } else { "s" };
                let file = if unnamed { "the file" } else { &name };
                format!("{count} error{plural} in {file}{rest}\n")
            }
            (Language::Chinese, true) => format!("文件中有 {count} 处错误{rest}\n"),
            (Language::Chinese, false) => format!("{name} 中有 {count} 处错误{rest}\n"),
        }
    }

    fn draw(&self, fault: &Fault, language: Language, renderer: &Renderer) -> String {
        let show = |said: &Said| shortened(&harmless(&said.in_language(language)));
        let title = Level::ERROR
            .with_name(language.pick("error", "错误"))
            .primary_title(show(&fault.message))
            .id(fault.code.id);
        let mut group = annotate_snippets::Group::with_title(title);
        if self.text.is_empty() {
            group = group.element(annotate_snippets::Origin::path(harmless(&self.name)));
        } else {
            let primary = AnnotationKind::Primary.span(self.inside(&fault.span));
            let mut snippet = Snippet::source(harmless_in_place(&self.text))
                .path(harmless(&self.name))
                .annotation(if fault.label.is_empty() {
                    primary
                } else {
                    primary.label(show(&fault.label))
                });
            for (span, label) in &fault.related {
                snippet = snippet.annotation(
                    AnnotationKind::Context
                        .span(self.inside(span))
                        .label(show(label)),
                );
            }
            group = group.element(snippet);
        }
        if let Some(help) = &fault.help {
            let level = Level::HELP.with_name(language.pick("help", "提示"));
            group = group.element(level.message(show(help)));
        }
        renderer.render(&[group])
    }

    /// The range inside the text, at character boundaries, and never behind its end; of a line that is too long to be read,
    /// its beginning.
    fn inside(&self, span: &Range<usize>) -> Range<usize> {
        /// More of a line is not drawn.
        const MOST: usize = 200;
        let start = self
            .text
            .floor_char_boundary(span.start.min(self.text.len()));
        let end = self
            .text
            .ceil_char_boundary(span.end.max(start).min(self.text.len()));
        let is_long = |line: &str| line.len() > MOST;
        match self.text[start..end].split('\n').any(is_long) {
            true => start..self.text.floor_char_boundary(end.min(start + MOST)),
            false => start..end,
        }
    }
}

/// A text that quotes more of a file than anybody reads, without its middle.
fn shortened(text: &str) -> String {
    /// Characters that are left at either end.
    const LEFT: usize = 500;
    let count = text.chars().count();
    if count <= 2 * LEFT {
        return text.to_owned();
    }
    let from = |start: usize, length: usize| text.chars().skip(start).take(length);
    from(0, LEFT)
        .chain(" … ".chars())
        .chain(from(count - LEFT, LEFT))
        .collect()
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Rejection {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Code;

    const TEXT: &str = "[input.\"电压\"]\nunit = \"V\"\nhalf_width = \"0.1 mA\"\n";

    const UNIT_CLASH: Code = Code {
        id: "B0112",
        title: "a unit does not fit",
        title_zh: "单位不合适",
        explanation: "",
    };

    const UNREADABLE_FILE: Code = Code {
        id: "B0101",
        title: "a file cannot be read",
        title_zh: "文件无法读取",
        explanation: "",
    };

    /// One fault, at the unit of the half-width.
    fn clash() -> Fault {
        let start = TEXT.find("\"0.1").expect("an amount");
        Fault::new(
            UNIT_CLASH,
            start..start + 8,
            Said::pair(
                "mA does not fit 电压, which is in V",
                "mA 与单位为 V 的电压不符",
            ),
        )
        .label(Said::pair("a current", "电流"))
        .help(Said::pair("write the half-width in V", "请以 V 给出半宽"))
    }

    #[test]
    fn english_has_the_message_as_its_headline() {
        let rejection = Rejection::new("budget.toml", TEXT, vec![clash()]);
        insta::assert_snapshot!(rejection.render(false), @r#"
        error[B0112]: mA does not fit 电压, which is in V
         --> budget.toml:3:14
          |
        3 | half_width = "0.1 mA"
          |              ^^^^^^^^ a current
          |
          = help: write the half-width in V

        1 error in budget.toml
        "#);
        assert_eq!(rejection.render(false), rejection.to_string());
    }

    #[test]
    fn chinese_is_chinese_throughout() {
        let rejection = Rejection::new("budget.toml", TEXT, vec![clash()]);
        insta::assert_snapshot!(rejection.render_in(Language::Chinese, false), @r#"
        错误[B0112]: mA 与单位为 V 的电压不符
         --> budget.toml:3:14
          |
        3 | half_width = "0.1 mA"
          |              ^^^^^^^^ 电流
          |
          = 提示: 请以 V 给出半宽

        budget.toml 中有 1 处错误
        "#);
    }

    #[test]
    fn a_file_without_text_and_the_files_below_are_drawn_in_the_same_language() {
        let fault = Fault::new(
            UNREADABLE_FILE,
            0..0,
            Said::pair("other.toml does not exist", "没有 other.toml"),
        );
        let mut rejection = Rejection::new("budget.toml", TEXT, vec![clash()]);
        rejection.others = vec![Rejection::new("other.toml", "", vec![fault])];
        let shown = rejection.render_in(Language::Chinese, false);
        let (_, other) = shown
            .split_once("budget.toml 中有 1 处错误\n")
            .expect("a count");
        insta::assert_snapshot!(other.trim_start(), @r"
        错误[B0101]: 没有 other.toml
        --> other.toml

        other.toml 中有 1 处错误
        ");
    }

    #[test]
    fn more_faults_than_are_shown_are_counted() {
        let faults = (0..=SHOWN).map(|place| Fault::new(UNIT_CLASH, place..place + 1, "no"));
        let mut rejection = Rejection::new("", TEXT, faults.collect());
        let last = |rejection: &Rejection, language| {
            let shown = rejection.render_in(language, false);
            shown.lines().last().map(String::from)
        };
        assert_eq!(
            last(&rejection, Language::English).as_deref(),
            Some("26 errors in the file; the first 25 are shown")
        );
        assert_eq!(
            last(&rejection, Language::Chinese).as_deref(),
            Some("文件中有 26 处错误；仅列出前 25 处")
        );
        rejection.faults.truncate(1);
        assert_eq!(
            last(&rejection, Language::English).as_deref(),
            Some("1 error in the file")
        );
    }

    #[test]
    fn what_nobody_reads_is_not_drawn() {
        let text = format!("unit = \"{}\"\nvalue = 1", "电".repeat(100_000));
        for span in [8..text.len() - 12, 0..text.len()] {
            let fault = Fault::new(UNIT_CLASH, span, &*text)
                .label(&*text)
                .help(&*text);
            let shown = Rejection::new("budget.toml", &text, vec![fault]).render(false);
            assert!(shown.chars().count() < 10_000, "{}", shown.len());
            assert!(
                shown.contains(" … ") && shown.contains("budget.toml:1:"),
                "{shown}"
            );
        }
    }

    /// What a file says is quoted; it does not command the terminal, wherever it stands.
    #[test]
    fn nothing_that_is_drawn_is_obeyed() {
        for evil in [
            "\u{1b}[31m",
            "\u{9b}2J",
            "\u{202e}",
            "\u{200f}",
            "\r",
            "\u{e0041}",
            "\0",
        ] {
            let said = format!("a {evil} name");
            let text = format!("title = \"{evil}\"\nunit = \"{evil}V\"\n");
            let fault = Fault::new(UNIT_CLASH, 9..text.len(), &*said)
                .label(&*said)
                .related(0..5, &*said)
                .help(&*said);
            let mut rejection = Rejection::new(&said, &text, vec![fault.clone()]);
            rejection.others = vec![Rejection::new(&said, "", vec![fault])];
            for language in [Language::English, Language::Chinese] {
                let shown = rejection.render_in(language, false);
                assert!(!shown.chars().any(crate::is_obeyed), "{shown:?}");
            }
        }
    }
}
