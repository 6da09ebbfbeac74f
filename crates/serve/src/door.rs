//! Who is let in.
//!
//! The address of the page holds a random token, which other programs and other users of the machine do not know. Pages of
//! others that a browser shows at the same time do not know it either; what they send all the same says where it comes
//! from (`Origin`, `Sec-Fetch-Site`), and a name that they have pointed at this machine is not the name of this server
//! (`Host`; DNS rebinding).

use std::net::SocketAddr;

use hyper::HeaderMap;
use hyper::header::{HOST, ORIGIN};

/// Bytes of the token: nobody tries 2¹²⁸ addresses.
const TOKEN_BYTES: usize = 16;

/// The token, and where the server is.
#[derive(Debug)]
pub(crate) struct Door {
    token: String,
    place: SocketAddr,
}

/// Why somebody is not let in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turned {
    /// The address has no token, or a wrong one.
    Token,
    /// The request is for another server, or comes from another page.
    Stranger,
}

impl Door {
    /// A door for a server that listens here.
    ///
    /// # Errors
    /// The system has no random numbers.
    pub fn new(place: SocketAddr) -> std::io::Result<Door> {
        let mut bytes = [0; TOKEN_BYTES];
        getrandom::fill(&mut bytes)?;
        Ok(Door {
            token: bytes.iter().map(|byte| format!("{byte:02x}")).collect(),
            place,
        })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        let (place, token) = (self.place, &self.token);
        match place.ip().is_unspecified() {
            // Every address of the machine; this is the one that it has for itself.
            true => format!("http://localhost:{}/{token}/", place.port()),
            false => format!("http://{place}/{token}/"),
        }
    }

    /// Whether a request is for this server: by its address, which no name of others can stand for.
    fn is_own(&self, host: &str) -> bool {
        let (ip, port) = (self.place.ip(), self.place.port());
        // Browsers leave the usual port out.
        let portless = host.ends_with(']') || !host.contains(':');
        let host = match portless {
            true => format!("{host}:80"),
            false => host.to_owned(),
        };
        if host == format!("localhost:{port}") {
            return ip.is_loopback() || ip.is_unspecified();
        }
        let asked: Option<SocketAddr> = host.parse().ok();
        asked.is_some_and(|asked| asked.port() == port && (asked.ip() == ip || ip.is_unspecified()))
    }

    /// What is asked for behind the token.
    ///
    /// # Errors
    /// Whoever asks is not let in.
    pub fn enter<'p>(&self, path: &'p str, head: &HeaderMap) -> Result<&'p str, Turned> {
        let text = |name: &str| head.get(name).map(|value| value.to_str().unwrap_or("?"));
        let host = text(HOST.as_str()).unwrap_or_default();
        let same_origin = match text(ORIGIN.as_str()) {
            Some(origin) => origin.strip_prefix("http://") == Some(host),
            None => true,
        };
        let from = text("sec-fetch-site").unwrap_or("none");
        if !self.is_own(host) || !same_origin || !["same-origin", "none"].contains(&from) {
            return Err(Turned::Stranger);
        }
        let path = path.strip_prefix('/').unwrap_or(path);
        let (token, rest) = path.split_once('/').unwrap_or((path, ""));
        match alike(token, &self.token) {
            true => Ok(rest),
            false => Err(Turned::Token),
        }
    }
}

/// Whether two texts are the same; the time that it takes does not tell how much of them is.
fn alike(one: &str, other: &str) -> bool {
    let pairs = one.bytes().zip(other.bytes());
    let differing = pairs.fold(0, |differing, (a, b)| differing | (a ^ b));
    one.len() == other.len() && differing == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(pairs: &[(&'static str, &str)]) -> HeaderMap {
        let pairs = pairs.iter().map(|(name, value)| {
            let name = hyper::header::HeaderName::from_static(name);
            (name, value.parse().expect("a value"))
        });
        pairs.collect()
    }

    #[test]
    fn only_the_page_itself_is_let_in() {
        let door = Door::new(([127, 0, 0, 1], 8000).into()).expect("random numbers");
        let token = door.token.clone();
        let page = format!("/{token}/api/files");
        let enter = |path: &str, pairs: &[(&'static str, &str)]| {
            door.enter(path, &head(pairs)).map(str::to_owned)
        };
        let host = ("host", "127.0.0.1:8000");
        assert_eq!(enter(&page, &[host]).as_deref(), Ok("api/files"));
        let own = ("origin", "http://127.0.0.1:8000");
        assert!(enter(&page, &[host, own, ("sec-fetch-site", "same-origin")]).is_ok());
        assert!(enter(&page, &[("host", "localhost:8000")]).is_ok());
        for path in ["/", "/api/files", "/0123/api/files", ""] {
            assert_eq!(enter(path, &[host]), Err(Turned::Token), "{path}");
        }
        for strange in [
            &[("host", "evil.example:8000")][..],
            &[],
            &[host, ("origin", "http://evil.example")],
            &[host, ("origin", "null")],
            &[host, ("origin", "http://localhost:8000")],
            &[host, ("sec-fetch-site", "cross-site")],
            &[host, ("sec-fetch-site", "same-site")],
        ] {
            assert_eq!(enter(&page, strange), Err(Turned::Stranger), "{strange:?}");
        }
        let everywhere = Door::new(([0, 0, 0, 0], 80).into()).expect("random numbers");
        for own in ["192.0.2.7", "192.0.2.7:80", "localhost"] {
            assert!(everywhere.is_own(own), "{own}");
        }
        for strange in ["evil.example", "192.0.2.7:8000"] {
            assert!(!everywhere.is_own(strange), "{strange}");
        }
        let other = Door::new(([127, 0, 0, 1], 8000).into()).expect("random numbers");
        assert_ne!(token, other.token);
    }
}
