//! The token, and which requests are answered.
//!
//! The lab answers whoever knows its address: the address holds 128 random bits, is shown only in the terminal and to the browser, and is sent
//! nowhere (`Referrer-Policy`). Pages of other sites and other users of the machine reach the port, but not the token. Against pages that
//! try all the same: the host must be this one (no name of another site may lead here), the origin must be this page, and nothing may be
//! framed or read across origins.

use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use palpate_jobs::{ErrorKind, JobError};
use subtle::ConstantTimeEq;

use super::Server;

/// What a page of the lab may do: its own scripts and style, and nothing from anywhere else.
pub(super) const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; \
                                 frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Who may use the lab.
pub(crate) struct Access {
    token: String,
    port: u16,
}

impl Access {
    /// A new token.
    ///
    /// # Errors
    /// [`JobError`] where the operating system has no random numbers.
    pub(crate) fn new(port: u16) -> Result<Self, JobError> {
        let mut bytes = [0u8; 16];
        let failed = |error| {
            JobError::new(ErrorKind::File(std::io::ErrorKind::Other), format!("no random numbers: {error}"), None)
        };
        getrandom::fill(&mut bytes).map_err(failed)?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { token, port })
    }

    pub(super) fn token(&self) -> &str {
        &self.token
    }

    /// The address of the page.
    pub(crate) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// Why a request is not answered; `None` where it is.
    fn refusal(&self, path: &str, headers: &HeaderMap) -> Option<(StatusCode, &'static str)> {
        let text = |name| headers.get(name).map(|value: &HeaderValue| value.to_str().unwrap_or("?"));
        let hosts = ["127.0.0.1", "localhost"].map(|host| format!("{host}:{}", self.port));
        if !text(header::HOST).is_some_and(|host| hosts.iter().any(|own| own == host)) {
            return Some((StatusCode::FORBIDDEN, "expected a request to this machine by its loopback address\n"));
        }
        let token = path.trim_start_matches('/').split('/').next().unwrap_or_default();
        if !bool::from(token.as_bytes().ct_eq(self.token.as_bytes())) {
            return Some((StatusCode::NOT_FOUND, "not found: open the address that `palpate lab` printed\n"));
        }
        let is_own = |origin: &str| hosts.iter().any(|own| origin.strip_prefix("http://") == Some(own));
        if text(header::ORIGIN).is_some_and(|origin| !is_own(origin)) {
            return Some((
                StatusCode::FORBIDDEN,
                "expected a request of the page of the lab, found one of another page\n",
            ));
        }
        // A person may come to the page from anywhere, by the address, and to a report from another one, which is a page of no site; nothing
        // else is for other sites.
        let is_page = path.trim_matches('/') == self.token;
        let is_report = path.contains("/files/") && path.ends_with(".html");
        let site = text(header::HeaderName::from_static("sec-fetch-site")).unwrap_or("none");
        if !is_page && !is_report && !matches!(site, "same-origin" | "none") {
            return Some((
                StatusCode::FORBIDDEN,
                "expected a request of the page of the lab, found one of another site\n",
            ));
        }
        None
    }
}

/// Answers those who may use the lab, and tells browsers what they may do with the answer.
pub(super) async fn guard(State(server): State<Arc<Server>>, request: Request, next: Next) -> Response {
    let refusal = server.access.refusal(request.uri().path(), request.headers());
    let mut answer = match refusal {
        Some(refusal) => refusal.into_response(),
        None => next.run(request).await,
    };
    let headers = answer.headers_mut();
    for (name, value) in [
        ("x-content-type-options", "nosniff"),
        ("referrer-policy", "no-referrer"),
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-resource-policy", "same-origin"),
        ("cache-control", "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    headers
        .entry(header::CONTENT_SECURITY_POLICY)
        .or_insert(HeaderValue::from_static("default-src 'none'; frame-ancestors 'none'"));
    answer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_page_with_the_token_is_answered() {
        let access = Access::new(4000).unwrap();
        assert_eq!(access.token().len(), 32);
        assert_ne!(access.token(), Access::new(4000).unwrap().token());
        let (page, api) = (format!("/{}/", access.token()), format!("/{}/api/folder", access.token()));
        let status = |path: &str, headers: &[(&'static str, &'static str)]| {
            let mut map = HeaderMap::new();
            for (name, value) in headers {
                map.insert(*name, HeaderValue::from_static(value));
            }
            access.refusal(path, &map).map(|(status, _)| status.as_u16())
        };
        let host = ("host", "127.0.0.1:4000");
        assert_eq!(status(&page, &[host]), None);
        assert_eq!(status(&api, &[("host", "localhost:4000"), ("origin", "http://localhost:4000")]), None);
        // The name of another site that leads to this machine, or no name.
        assert_eq!(status(&api, &[("host", "evil.example:4000")]), Some(403));
        assert_eq!(status(&api, &[]), Some(403));
        // Without the token, or with a part of it.
        assert_eq!(status("/api/folder", &[host]), Some(404));
        assert_eq!(status(&page[..20], &[host]), Some(404));
        // Pages of other sites, and pages without an origin.
        for origin in ["https://evil.example", "null", "http://127.0.0.1:4001", "http://127.0.0.1:4000.evil.example"] {
            assert_eq!(status(&api, &[host, ("origin", origin)]), Some(403), "{origin}");
        }
        assert_eq!(status(&api, &[host, ("sec-fetch-site", "cross-site")]), Some(403));
        assert_eq!(status(&api, &[host, ("sec-fetch-site", "same-origin")]), None);
        // A person may follow a link to the page.
        assert_eq!(status(&page, &[host, ("sec-fetch-site", "cross-site")]), None);
    }
}
