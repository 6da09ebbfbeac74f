//! The form of a report: text, Markdown or JSON, its language, and where it goes.

use std::io::stdout;
use std::path::PathBuf;

use gumption::report::{Language, Page};
use serde_json::Value;

use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Form {
    /// Print JSON: exact numbers, stable names
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Print Markdown
    #[arg(long)]
    markdown: bool,
    /// Language of the report: en or zh
    #[arg(long, value_name = "LANG", default_value = "en")]
    pub lang: Language,
    /// Write to this file instead of standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Form {
    /// Draws the report in the form that was asked for, and writes it.
    pub fn write(
        &self,
        json: impl FnOnce() -> Value,
        markdown: impl FnOnce() -> String,
        text: impl FnOnce(Page) -> String,
    ) -> Outcome {
        let report = if self.json {
            format!("{:#}\n", json())
        } else if self.markdown {
            markdown()
        } else {
            text(self.page())
        };
        match &self.output {
            Some(path) => output::replace(path, &report),
            None => output::print(&report),
        }
    }

    /// A file has neither the width nor the colours of the terminal.
    fn page(&self) -> Page {
        match &self.output {
            Some(_) => Page {
                width: output::USUAL_WIDTH,
                styled: false,
            },
            None => Page {
                width: output::page_width(),
                styled: output::may_style(&stdout()),
            },
        }
    }
}
