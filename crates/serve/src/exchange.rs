//! What is asked and answered.
//!
//! A request is one line of JSON, and behind it the contents of the files that it names, one after the other. So texts and
//! spreadsheets travel alike.

use http_body_util::Full;
use hyper::body::Bytes;
use hyper::header::{CACHE_CONTROL, CONTENT_TYPE, HeaderName, HeaderValue};
use hyper::{Response, StatusCode};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use gumption_fault::Said;
use gumption_fault::language::Language;

/// What the page may do: nothing that comes from elsewhere, no script within a text. Documents have their style in them.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; \
    img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A file that travels with a request.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Parcel {
    path: String,
    bytes: usize,
}

/// Names and contents of files.
pub(crate) type Contents = Vec<(String, Vec<u8>)>;

/// Line and contents of a request.
///
/// # Errors
/// It is not written like that.
pub(crate) fn opened<T: DeserializeOwned>(body: &[u8]) -> Result<(T, Contents), Reply> {
    #[derive(Deserialize)]
    struct Parcels {
        #[serde(default)]
        files: Vec<Parcel>,
    }
    let malformed = || Reply::status(StatusCode::BAD_REQUEST);
    let end = body.iter().position(|byte| *byte == b'\n');
    let (line, mut rest) = body.split_at(end.unwrap_or(body.len()));
    rest = rest.get(1..).unwrap_or_default();
    let head = serde_json::from_slice(line).map_err(|_| malformed())?;
    let parcels: Parcels = serde_json::from_slice(line).map_err(|_| malformed())?;
    let mut contents = Vec::new();
    for parcel in parcels.files {
        let (content, others) = rest.split_at_checked(parcel.bytes).ok_or_else(malformed)?;
        contents.push((parcel.path, content.to_vec()));
        rest = others;
    }
    match rest.is_empty() {
        true => Ok((head, contents)),
        false => Err(malformed()),
    }
}

/// An answer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Reply {
    pub status: StatusCode,
    media_type: &'static str,
    body: Bytes,
}

impl Reply {
    /// Bytes of a kind.
    pub fn content(media_type: &'static str, body: impl Into<Bytes>) -> Reply {
        Reply {
            status: StatusCode::OK,
            media_type,
            body: body.into(),
        }
    }

    /// Values.
    pub fn json(value: &Value) -> Reply {
        Reply::content("application/json", value.to_string())
    }

    /// Nothing but a status.
    pub fn status(status: StatusCode) -> Reply {
        Reply::json(&json!({})).with(status)
    }

    /// A status with the reason that a reader is told.
    pub fn because(status: StatusCode, why: &Said, language: Language) -> Reply {
        Reply::json(&json!({ "message": why.in_language(language) })).with(status)
    }

    /// The same with another status.
    pub fn with(mut self, status: StatusCode) -> Reply {
        self.status = status;
        self
    }

    /// As it is sent.
    pub fn response(self) -> Response<Full<Bytes>> {
        let mut response = Response::new(Full::new(self.body));
        *response.status_mut() = self.status;
        let fixed = [
            (CONTENT_TYPE, self.media_type),
            (CACHE_CONTROL, "no-store"),
            (HeaderName::from_static("content-security-policy"), POLICY),
            (HeaderName::from_static("referrer-policy"), "same-origin"),
            (HeaderName::from_static("x-content-type-options"), "nosniff"),
            (
                HeaderName::from_static("cross-origin-resource-policy"),
                "same-origin",
            ),
            (
                HeaderName::from_static("cross-origin-opener-policy"),
                "same-origin",
            ),
        ];
        for (name, value) in fixed {
            let head = response.headers_mut();
            head.insert(name, HeaderValue::from_static(value));
        }
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_a_line_and_contents() {
        let body = b"{\"files\":[{\"path\":\"a\",\"bytes\":3},{\"path\":\"b\",\"bytes\":0}]}\nx\ny";
        let (_, contents) = opened::<Value>(body).expect("a request");
        assert_eq!(
            contents,
            [("a".into(), b"x\ny".to_vec()), ("b".into(), vec![])]
        );
        assert!(opened::<Value>(b"{}").expect("a request").1.is_empty());
        for broken in [
            &b"{\"files\":[{\"path\":\"a\",\"bytes\":4}]}\nx"[..],
            b"{}\nmore",
            b"",
            b"[",
            b"{\"files\":[{\"path\":\"a\",\"bytes\":-1}]}\n",
        ] {
            let refused = opened::<Value>(broken).expect_err("broken");
            assert_eq!(refused.status, StatusCode::BAD_REQUEST);
        }
    }
}
