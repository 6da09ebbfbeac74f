//! A refused file: all of its faults, drawn under the user's own lines.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use super::Fault;

/// Nobody mends more at once.
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

    /// Draws every fault, and counts them.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let mut out = String::new();
        for fault in self.faults.iter().take(SHOWN) {
            out += &self.draw(fault, &renderer);
            out += "\n\n";
        }
        let count = self.faults.len();
        let plural = if count == 1 { "" } else { "s" };
        let rest = if count > SHOWN {
            format!("; the first {SHOWN} are shown")
        } else {
            String::new()
        };
        let file = if self.name.is_empty() {
            "the file"
        } else {
            &self.name
        };
        out += &format!("{count} error{plural} in {file}{rest}\n");
        for other in &self.others {
            out += "\n";
            out += &other.render(color);
        }
        out
    }

    fn draw(&self, fault: &Fault, renderer: &Renderer) -> String {
        let title = Level::ERROR
            .primary_title(fault.message.as_str())
            .id(fault.code.id);
        let mut group = annotate_snippets::Group::with_title(title);
        if self.text.is_empty() {
            group = group.element(annotate_snippets::Origin::path(self.name.as_str()));
        } else {
            let primary = AnnotationKind::Primary.span(self.clamp(&fault.span));
            let mut snippet = Snippet::source(self.text.as_str())
                .path(self.name.as_str())
                .annotation(if fault.label.is_empty() {
                    primary
                } else {
                    primary.label(fault.label.as_str())
                });
            for (span, label) in &fault.related {
                snippet = snippet.annotation(
                    AnnotationKind::Context
                        .span(self.clamp(span))
                        .label(label.as_str()),
                );
            }
            group = group.element(snippet);
        }
        if let Some(help) = &fault.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        renderer.render(&[group])
    }

    /// The range inside the text, at character boundaries, and never behind its end.
    fn clamp(&self, span: &Range<usize>) -> Range<usize> {
        let start = self
            .text
            .floor_char_boundary(span.start.min(self.text.len()));
        let end = self
            .text
            .ceil_char_boundary(span.end.clamp(start, self.text.len()));
        start..end
    }
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Rejection {}
