//! The page, its style and its scripts: all of it is in the program.

use axum::extract::Path;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use palpate_report::page::{SCRIPT, STYLE};

use super::access::POLICY;
use super::refusal::Refusal;

/// Names of what belongs to the page, with its type and content. Figures have the style and the script that they have in reports.
const ASSETS: [(&str, &str, &str); 10] = [
    ("report.css", "text/css", STYLE),
    ("report.js", "text/javascript", SCRIPT),
    ("lab.css", "text/css", include_str!("../../assets/lab.css")),
    ("lab.js", "text/javascript", include_str!("../../assets/lab.js")),
    ("api.js", "text/javascript", include_str!("../../assets/api.js")),
    ("dom.js", "text/javascript", include_str!("../../assets/dom.js")),
    ("number.js", "text/javascript", include_str!("../../assets/number.js")),
    ("record.js", "text/javascript", include_str!("../../assets/record.js")),
    ("study.js", "text/javascript", include_str!("../../assets/study.js")),
    ("grip.js", "text/javascript", include_str!("../../assets/grip.js")),
];

pub(super) async fn index() -> Response {
    let page = include_str!("../../assets/index.html");
    (
        [(header::CONTENT_TYPE, "text/html; charset=utf-8"), (header::CONTENT_SECURITY_POLICY, POLICY)],
        page,
    )
        .into_response()
}

pub(super) async fn asset(Path(name): Path<String>) -> Result<Response, Refusal> {
    let found = ASSETS.iter().find(|(own, ..)| *own == name);
    let (_, kind, content) = found.ok_or_else(|| Refusal::unknown("part of the page"))?;
    Ok(([(header::CONTENT_TYPE, format!("{kind}; charset=utf-8"))], *content).into_response())
}
