//! The workbench: a server on the user's own machine, and the page that it serves.
//!
//! Whoever knows the address of the page may do with the files of one folder what the page offers: see, edit, evaluate,
//! and replace a file whose content they have seen. Nobody else may do anything.
//!
//! | chapter | holds |
//! |---|---|
//! | `server` | sockets: how many connections, how long, how large |
//! | `door` | who is let in: token, host, origin |
//! | `exchange` | what is asked and answered, as bytes |
//! | `routes` | which address does what |
//! | `shelf` | the files of the folder: listed, read, saved, and what was typed and is not saved |
//! | `pages` | what is computed for whom: of each page the newest wish, which may be stopped |
//! | `work` | evaluations, audits, calibrations, diagnoses: a document, or what is wrong |
//! | `lessons` | samples that a class watches, and what they show |
//! | `exercises` | budgets and recordings in which something is concealed, handed out and graded |
//! | `forms` | the form beside the text: its entries, and edits of one of them |
//! | `movable` | what if: the numbers of a text that the page moves |
//! | `vocabulary` | what an editor completes |
//! | `page` | the files of the page |

mod door;
mod exchange;
mod exercises;
mod forms;
mod lessons;
mod movable;
mod page;
mod pages;
mod routes;
mod server;
mod shelf;
mod vocabulary;
mod work;

pub use server::Workbench;
