//! The files of the page.

use super::exchange::Reply;

/// Name, kind and content; the first is the page itself.
const FILES: [(&str, &str, &str); 9] = [
    (
        "",
        "text/html; charset=utf-8",
        include_str!("page/index.html"),
    ),
    (
        "workbench.css",
        "text/css; charset=utf-8",
        include_str!("page/workbench.css"),
    ),
    (
        "words.js",
        "text/javascript; charset=utf-8",
        include_str!("page/words.js"),
    ),
    (
        "workbench.js",
        "text/javascript; charset=utf-8",
        include_str!("page/workbench.js"),
    ),
    (
        "exercises.js",
        "text/javascript; charset=utf-8",
        include_str!("page/exercises.js"),
    ),
    (
        "complete.js",
        "text/javascript; charset=utf-8",
        include_str!("page/complete.js"),
    ),
    (
        "form.js",
        "text/javascript; charset=utf-8",
        include_str!("page/form.js"),
    ),
    (
        "residuals.js",
        "text/javascript; charset=utf-8",
        include_str!("page/residuals.js"),
    ),
    (
        "start.js",
        "text/javascript; charset=utf-8",
        include_str!("page/start.js"),
    ),
];

/// A file of the page.
pub(crate) fn file(name: &str) -> Option<Reply> {
    let file = FILES.iter().find(|(known, ..)| *known == name);
    file.map(|(_, media_type, content)| Reply::content(media_type, *content))
}
