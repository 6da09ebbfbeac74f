//! The form of a document: its format, language and width, and where it goes.

use std::io::{IsTerminal, stdout};

use super::language::{Languages, spoken, system_language};
use super::output::{Beside, Complaint, Target};
use super::{Outcome, output};
use clap::{Arg, ArgAction, ArgMatches, Command};
use gumption::document::Document;
use gumption::fault::say;
use gumption::files::write::Output;
use gumption::render::{self, FORMATS, Format, Page};
use gumption::report::Language;

#[derive(Debug, clap::Args)]
pub(super) struct Form {
    #[command(flatten)]
    format: Choice,
    /// Language of the report: en, zh, or both side by side [default: that of the system]
    #[arg(long, value_name = "LANG", default_value = system_language(), hide_default_value = true)]
    lang: Languages,
    /// Columns of the text [default: those of the terminal, else 100]
    #[arg(long, value_name = "N", value_parser = parse_width)]
    width: Option<usize>,
    #[command(flatten)]
    target: Target,
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
    /// The language in which the command speaks about what it does.
    pub fn language(&self) -> Language {
        match self.lang {
            Languages::One(language) => language,
            Languages::Both => spoken(),
        }
    }

    /// A document in the languages that are asked for.
    pub fn compose(&self, compose: impl Fn(Language) -> Document) -> Document {
        let first = compose(self.language());
        match self.lang {
            Languages::One(_) => first,
            Languages::Both => first.beside_the_words_of(compose(self.language().other())),
        }
    }

    /// Likewise, where there may be none.
    pub fn compose_some(&self, compose: impl Fn(Language) -> Option<Document>) -> Option<Document> {
        let first = compose(self.language())?;
        Some(match self.lang {
            Languages::One(_) => first,
            Languages::Both => first.beside_the_words_of(compose(self.language().other())?),
        })
    }

    /// Makes sure, before any work is done, that the document can be written as it is asked for, and these files
    /// beside it.
    pub fn is_possible(&self, beside: &[Beside]) -> Result<(), Outcome> {
        let format = self.format().map_err(output::complain)?;
        if !format.is_text() && self.target.file().is_none() && stdout().is_terminal() {
            let name = format.name;
            return Err(output::complain(self.language().pick(
                format!(
                    "--{name} is not for terminals; write it to a file with -o FILE.{0}",
                    format.ending
                ),
                format!(
                    "--{name} 的内容不能显示在终端上，请用 -o 文件名.{0} 写入文件",
                    format.ending
                ),
            )));
        }
        self.target.is_allowed(beside)
    }

    /// Where the output goes that is no document, in a form of its own.
    ///
    /// # Errors
    /// A format is asked for, which it has not.
    pub fn target(&self) -> Result<&Target, Complaint> {
        match self.format.0 {
            None => Ok(&self.target),
            Some(format) => {
                Err(say!("the output is a table (CSV): leave out --{}", format.name).into())
            }
        }
    }

    /// Writes a document in the form that was asked for.
    pub fn write(&self, document: &Document) -> Outcome {
        self.write_with(document, Vec::new())
    }

    /// Writes a document and files beside it, all of them or none.
    pub fn write_with(&self, document: &Document, beside: Vec<Output>) -> Outcome {
        match self.format() {
            Ok(format) => match (format.render)(document, &self.page()) {
                Ok(bytes) => self.target.write(bytes, beside),
                Err(unfit) => output::complain(unfit.0),
            },
            Err(complaint) => output::complain(complaint),
        }
    }

    /// The format of the flag, else that of the file's ending.
    fn format(&self) -> Result<&'static Format, Complaint> {
        let Some(ending) = self.target.ending().filter(|_| self.format.0.is_none()) else {
            return Ok(self.format.0.unwrap_or(&FORMATS[0]));
        };
        if let Some(folder) = self.target.file().filter(|path| path.is_dir()) {
            let within = folder.join("report.md");
            return Err(say!(
                "{} is a folder; write the name of a file in it, such as {}",
                folder.display(),
                within.display()
            )
            .into());
        }
        render::with_ending(&ending).ok_or_else(|| {
            let endings: Vec<String> = FORMATS.iter().map(|f| format!(".{}", f.ending)).collect();
            let endings = endings.join(", ");
            let what = match ending.as_str() {
                "" => say!("the name of the output has no ending"),
                "pdf" => say!("this program was built without pages, which `cargo install --path . --features pdf` adds"),
                other => say!("there is no format with the ending .{other}"),
            };
            say!("{what}; the endings are {endings}, and --{} or another flag says the format of any other name", FORMATS[0].name).into()
        })
    }

    /// A file has neither the width nor the colours of the terminal.
    fn page(&self) -> Page {
        let (width, styled) = match self.target.file() {
            Some(_) => (output::USUAL_WIDTH, false),
            None => (output::page_width(), output::may_style(&stdout())),
        };
        Page {
            width: self.width.unwrap_or(width),
            styled,
        }
    }
}

fn parse_width(text: &str) -> Result<usize, Complaint> {
    /// Longer lines are hard to read.
    const WIDEST: usize = 200;
    const NARROWEST: usize = output::NARROWEST;
    let width: usize = text
        .parse()
        .map_err(|_| say!("write a number of columns, such as 100"))?;
    Ok(width.clamp(NARROWEST, WIDEST))
}
