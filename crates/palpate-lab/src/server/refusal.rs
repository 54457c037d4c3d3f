//! Errors as answers.

use std::sync::Arc;

use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use palpate_jobs::{ErrorKind, JobError, RefusalDocument};

use super::Server;
use crate::folder::Folder;
use crate::refusal::refusal;

/// Why there is no answer.
pub(super) struct Refusal(pub(super) StatusCode, RefusalDocument);

impl Refusal {
    /// Nothing by that name.
    pub(super) fn unknown(what: &str) -> Self {
        let message = format!("no such {what}");
        Self(StatusCode::NOT_FOUND, RefusalDocument { message, hint: None })
    }

    /// An error, about files of the folder by their names there.
    pub(super) fn of(error: &JobError, folder: &Folder) -> Self {
        let status = match error.kind {
            ErrorKind::File(std::io::ErrorKind::NotFound) => StatusCode::NOT_FOUND,
            ErrorKind::File(std::io::ErrorKind::StorageFull) => StatusCode::INSUFFICIENT_STORAGE,
            ErrorKind::File(_) => StatusCode::INTERNAL_SERVER_ERROR,
            _ => StatusCode::UNPROCESSABLE_ENTITY,
        };
        Self(status, refusal(error, folder))
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.0, Json(self.1)).into_response()
    }
}

/// Does what takes a while, or waits for a disk, on a thread of its own.
pub(super) async fn aside<T: Send + 'static>(
    server: &Arc<Server>,
    work: impl FnOnce(&Server) -> Result<T, JobError> + Send + 'static,
) -> Result<T, Refusal> {
    let broken = |_| JobError::new(ErrorKind::Record, "the computation ended unexpectedly", None);
    let own = Arc::clone(server);
    let done = tokio::task::spawn_blocking(move || work(&own)).await.map_err(broken).flatten();
    done.map_err(|error| Refusal::of(&error, &server.folder))
}
