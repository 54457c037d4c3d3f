//! Errors as answers.

use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use palpate_jobs::{ErrorKind, JobError, RefusalDocument};

use crate::refusal::page_words;

/// Why there is no answer.
pub(super) struct Refusal(pub(super) StatusCode, RefusalDocument);

impl Refusal {
    /// Nothing by that name.
    pub(super) fn unknown(what: &str) -> Self {
        let message = format!("no such {what}");
        Self(StatusCode::NOT_FOUND, RefusalDocument { message, hint: None })
    }
}

impl From<JobError> for Refusal {
    fn from(error: JobError) -> Self {
        let status = match error.kind {
            ErrorKind::File(std::io::ErrorKind::NotFound) => StatusCode::NOT_FOUND,
            ErrorKind::File(std::io::ErrorKind::StorageFull) => StatusCode::INSUFFICIENT_STORAGE,
            ErrorKind::File(_) => StatusCode::INTERNAL_SERVER_ERROR,
            _ => StatusCode::UNPROCESSABLE_ENTITY,
        };
        Self(status, page_words(&error))
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.0, Json(self.1)).into_response()
    }
}

/// Does what takes a while, or waits for a disk, on a thread of its own.
pub(super) async fn aside<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, JobError> + Send + 'static,
) -> Result<T, Refusal> {
    let broken = |_| JobError::new(ErrorKind::Record, "the computation ended unexpectedly", None);
    Ok(tokio::task::spawn_blocking(work).await.map_err(broken).flatten()?)
}
