//! The form of a document: its format, language and width, and where it goes.

use std::io::stdout;
use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command};
use gumption::document::Document;
use gumption::render::{self, FORMATS, Format, Page};
use gumption::report::Language;

use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Form {
    #[command(flatten)]
    format: Choice,
    /// Language of the report: en or zh
    #[arg(long, value_name = "LANG", default_value = "en")]
    pub lang: Language,
    /// Columns of the text [default: those of the terminal, else 100]
    #[arg(long, value_name = "N", value_parser = parse_width)]
    width: Option<usize>,
    /// Write to this file instead of standard output; its ending says the format where no flag does
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The format that a flag asks for; every format has one.
#[derive(Debug)]
struct Choice(Option<&'static Format>);

impl clap::Args for Choice {
    fn augment_args(command: Command) -> Command {
        FORMATS.iter().fold(command, |command, format| {
            let others = FORMATS.iter().map(|other| other.name);
            let flag = Arg::new(format.name)
                .long(format.name)
                .help(format.about)
                .action(ArgAction::SetTrue)
                .conflicts_with_all(others.filter(|other| *other != format.name));
            command.arg(flag)
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Choice::augment_args(command)
    }
}

impl clap::FromArgMatches for Choice {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut formats = FORMATS.iter();
        Ok(Choice(formats.find(|format| matches.get_flag(format.name))))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Choice::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Form {
    /// Writes a document in the form that was asked for.
    pub fn write(&self, document: &Document) -> Outcome {
        let bytes = (self.format().render)(document, &self.page());
        match &self.output {
            Some(path) => output::replace(path, bytes),
            None => output::print(&bytes),
        }
    }

    fn format(&self) -> &'static Format {
        let ending = self.output.as_ref().and_then(|path| path.extension());
        let by_ending = || render::with_ending(ending?.to_str()?);
        self.format.0.or_else(by_ending).unwrap_or(&FORMATS[0])
    }

    /// A file has neither the width nor the colours of the terminal.
    fn page(&self) -> Page {
        let (width, styled) = match &self.output {
            Some(_) => (output::USUAL_WIDTH, false),
            None => (output::page_width(), output::may_style(&stdout())),
        };
        Page {
            width: self.width.unwrap_or(width),
            styled,
        }
    }
}

fn parse_width(text: &str) -> Result<usize, &'static str> {
    /// Longer lines are hard to read.
    const WIDEST: usize = 200;
    let width: usize = text
        .parse()
        .map_err(|_| "write a number of columns, such as 100")?;
    Ok(width.clamp(output::NARROWEST, WIDEST))
}
