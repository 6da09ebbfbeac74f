//! Which address does what.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use hyper::body::Bytes;
use hyper::{Method, StatusCode};
use serde::Deserialize;
use serde_json::json;

use gumption_export::{FORMATS, Page};
use gumption_fault::language::Language;
use gumption_fault::say;
use gumption_format::files::Files;
use gumption_gum::budget;
use gumption_lab::experiment::procedure::{PROCEDURES, procedure_named};
use gumption_lab::experiment::proposal;
use gumption_lab::recording::text_of;
use gumption_report::certificate_template;

use super::exchange::{Contents, Reply, opened};
use super::exercises::Shown;
use super::forms::{self, Edit};
use super::lessons::LESSONS;
use super::page;
use super::pages::{Ended, Job, Pages};
use super::shelf::{MOST_TEXT, Shelf, Unsaved};
use super::vocabulary::vocabulary;
use super::work::{self, Found, Task, Tongue, Wish};

/// Nobody waits longer for what answers while they type.
const PATIENCE: Duration = Duration::from_secs(60);

/// Nobody waits longer for what they have started.
const LONGEST: Duration = Duration::from_secs(3600);

/// What the server can be asked for.
#[derive(Debug)]
pub(crate) struct Routes {
    shelf: Arc<Shelf>,
    /// Exercises of which the truth was shown.
    shown: Arc<Shown>,
    pages: Pages,
}

/// About a file, or a page.
#[derive(Debug, Deserialize)]
struct About {
    #[serde(default)]
    path: String,
    #[serde(default)]
    page: String,
    language: Tongue,
    /// Whether the file is to be new.
    #[serde(default)]
    new: bool,
    /// Edits that a form makes.
    #[serde(default)]
    edits: Vec<Edit>,
    /// The procedure that an experiment is to follow.
    procedure: Option<String>,
}

impl Routes {
    /// For the files of a folder.
    pub fn new(root: PathBuf) -> Routes {
        Routes {
            shelf: Arc::new(Shelf::new(root)),
            shown: Arc::default(),
            pages: Pages::new(),
        }
    }

    /// Answers a request of somebody who was let in.
    pub async fn answer(&self, method: &Method, path: &str, body: Bytes) -> Reply {
        match (method, path.strip_prefix("api/")) {
            (&Method::GET, None) => {
                page::file(path).unwrap_or_else(|| Reply::status(StatusCode::NOT_FOUND))
            }
            (&Method::POST, Some("work")) => self.work(&body).await,
            (&Method::POST, Some(asked)) => self.about(asked, &body),
            (&Method::GET, Some(_)) => Reply::status(StatusCode::METHOD_NOT_ALLOWED),
            _ => Reply::status(StatusCode::NOT_FOUND),
        }
    }

    fn about(&self, asked: &str, body: &[u8]) -> Reply {
        let (about, contents): (About, Contents) = match opened(body) {
            Ok(request) => request,
            Err(reply) => return reply,
        };
        match asked {
            "files" => {
                let mut list = self.shelf.list();
                let formats = FORMATS.iter().map(|format| (format.name, format.ending));
                list["formats"] = json!(formats.collect::<Vec<_>>());
                let lessons = LESSONS
                    .iter()
                    .map(|lesson| (lesson.name, lesson.title, lesson.counts.is_some()));
                list["lessons"] = json!(lessons.collect::<Vec<_>>());
                let procedures = PROCEDURES.iter().map(|procedure| procedure.name);
                list["procedures"] = json!(procedures.collect::<Vec<_>>());
                Reply::json(&list)
            }
            "vocabulary" => Reply::json(&vocabulary(about.language.into())),
            "open" => self.open(&about),
            "form" => form(&about, &contents),
            "propose" => propose(&about, &contents),
            "template" => Reply::json(&json!({
                "budget": budget::template(about.language.into()), "certificate": certificate_template(about.language.into()),
            })),
            "save" => self.save(&about, &contents),
            "forget" => {
                self.shelf.forget(&about.path);
                Reply::json(&json!({}))
            }
            "progress" => {
                let job = self.pages.of(&about.page);
                let done = job.map(
                    |job| json!({ "share": job.share(), "trials": job.trials.trials_drawn() }),
                );
                Reply::json(&done.unwrap_or_default())
            }
            "stop" => {
                if let Some(job) = self.pages.of(&about.page) {
                    job.trials.stop();
                }
                Reply::json(&json!({}))
            }
            _ => Reply::status(StatusCode::NOT_FOUND),
        }
    }

    fn open(&self, about: &About) -> Reply {
        let language = about.language.into();
        let path = &about.path;
        self.shelf.open(path).map_or_else(
            |error| {
                let (status, why) = match error.kind() {
                    // Nor is a folder one, or a name that no file can have.
                    ErrorKind::NotFound | ErrorKind::IsADirectory | ErrorKind::InvalidInput => (
                        StatusCode::NOT_FOUND,
                        say!("there is no file {path} in the folder"),
                    ),
                    ErrorKind::InvalidData => (
                        StatusCode::UNPROCESSABLE_ENTITY,
                        say!("{path} is no text in UTF-8"),
                    ),
                    ErrorKind::FileTooLarge => (
                        StatusCode::PAYLOAD_TOO_LARGE,
                        say!("{path} is too large to be edited here"),
                    ),
                    _ => (
                        StatusCode::INTERNAL_SERVER_ERROR,
                        say!("{path} cannot be read: {error}"),
                    ),
                };
                Reply::because(status, &why, language)
            },
            |file| Reply::json(&file),
        )
    }

    /// Contents are the new text and, unless the file is to be new, the one that was edited.
    fn save(&self, about: &About, contents: &Contents) -> Reply {
        let language: Language = about.language.into();
        let path = &about.path;
        let mut texts = contents.iter().map(|(_, bytes)| std::str::from_utf8(bytes));
        let (text, base) = match (texts.next(), texts.next(), about.new) {
            (Some(Ok(text)), None, true) => (text, None),
            (Some(Ok(text)), Some(Ok(base)), false) => (text, Some(base)),
            _ => return Reply::status(StatusCode::BAD_REQUEST),
        };
        match self.shelf.save(path, text, base) {
            Ok(()) => Reply::json(&json!({})),
            Err(Unsaved::Conflict(there)) => {
                let why = match (&there, base) {
                    (None, Some(_)) => say!("{path} has been removed since it was opened"),
                    (_, None) => say!("there is a file {path} already"),
                    _ => say!("{path} has been changed by somebody else since it was opened"),
                };
                let conflict = json!({ "message": why.in_language(language), "there": there });
                Reply::json(&conflict).with(StatusCode::CONFLICT)
            }
            Err(Unsaved::Outside) => {
                let why = say!(
                    "{path} is no name of a file in this folder; it ends in .toml, and its folder exists"
                );
                Reply::because(StatusCode::FORBIDDEN, &why, language)
            }
            Err(Unsaved::Unwritten(unwritten)) => {
                let why = unwritten.said(None);
                Reply::because(StatusCode::INTERNAL_SERVER_ERROR, &why, language)
            }
        }
    }

    async fn work(&self, body: &[u8]) -> Reply {
        let (wish, contents): (Wish, Contents) = match opened(body) {
            Ok(request) => request,
            Err(reply) => return reply,
        };
        let Some(format) = work::format(&wish) else {
            return Reply::status(StatusCode::BAD_REQUEST);
        };
        self.keep(&contents);
        let language: Language = wish.language.into();
        let (handed_over, page) = (wish.format.is_some(), wish.page.clone());
        let most = match wish.task {
            Task::See | Task::Require | Task::Versions | Task::Lesson | Task::Exercise => PATIENCE,
            Task::Diagnose | Task::Plan | Task::Audit => LONGEST,
        };
        let (shelf, shown) = (Arc::clone(&self.shelf), Arc::clone(&self.shown));
        let work = move |job: &Job| {
            let found = work::done(&wish, &contents, (&shelf, &shown), job);
            match (&found, handed_over) {
                (Found::Document(document, _), true) => {
                    match (format.render)(document, &Page::default()) {
                        Ok(bytes) => Reply::content(format.media_type, bytes),
                        Err(unfit) => {
                            Reply::because(StatusCode::UNPROCESSABLE_ENTITY, &unfit.0, language)
                        }
                    }
                }
                (_, true) => Reply::json(&work::shown(&found, language))
                    .with(StatusCode::UNPROCESSABLE_ENTITY),
                (_, false) => Reply::json(&work::shown(&found, language)),
            }
        };
        match self.pages.compute(page, most, work).await {
            Ok(reply) => reply,
            Err(Ended::Stopped) => Reply::json(&json!({ "stopped": true })),
            Err(Ended::Late) => {
                let seconds = most.as_secs();
                let why = say!(
                    "this takes longer than {seconds} s and was stopped; the command line takes its time"
                );
                Reply::because(StatusCode::REQUEST_TIMEOUT, &why, language)
            }
            Err(Ended::Crowded) => {
                let why = say!("too many pages wait for this server");
                Reply::because(StatusCode::SERVICE_UNAVAILABLE, &why, language)
            }
        }
    }

    /// Keeps the texts of files of the folder that are being edited.
    fn keep(&self, contents: &Contents) {
        for (path, bytes) in contents {
            let is_text = path.ends_with(".toml") && bytes.len() as u64 <= MOST_TEXT;
            if let (true, Ok(text)) = (is_text, std::str::from_utf8(bytes)) {
                self.shelf.keep(path, text);
            }
        }
    }
}

/// The experiment that the recording may be of.
fn propose(about: &About, contents: &Contents) -> Reply {
    let language: Language = about.language.into();
    let Some((name, bytes)) = contents.first() else {
        return Reply::status(StatusCode::BAD_REQUEST);
    };
    let files: &[(&str, &[u8])] = &[(name, bytes)];
    let procedure = about.procedure.as_deref().and_then(procedure_named);
    let proposed = text_of(Files::Library(files), Path::new(name), name)
        .and_then(|text| proposal(name, &text, procedure, language));
    match proposed {
        Ok(text) => Reply::json(&json!({ "text": text })),
        Err(rejection) => {
            let why = rejection
                .faults
                .into_iter()
                .next()
                .map(|fault| fault.message);
            Reply::because(
                StatusCode::UNPROCESSABLE_ENTITY,
                &why.unwrap_or_default(),
                language,
            )
        }
    }
}

/// The text that is sent, with the edits of a form, and what it states.
fn form(about: &About, contents: &Contents) -> Reply {
    let texts = contents
        .first()
        .map(|(_, bytes)| std::str::from_utf8(bytes));
    let Some(Ok(text)) = texts else {
        return Reply::status(StatusCode::BAD_REQUEST);
    };
    match forms::edited(text, &about.edits) {
        Ok(text) => Reply::json(&json!({ "text": text, "form": forms::view(&text) })),
        Err(why) => Reply::because(
            StatusCode::UNPROCESSABLE_ENTITY,
            &why,
            about.language.into(),
        ),
    }
}
