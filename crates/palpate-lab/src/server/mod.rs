//! The addresses of the lab, and who may use them.
//!
//! | file | what |
//! |---|---|
//! | `access.rs` | the token, and which requests are answered |
//! | `page.rs` | the page, its style and its scripts |
//! | `files.rs` | records, descriptions and materials of the folder |
//! | `tasks.rs` | tasks, what changed, what they made |
//! | `refusal.rs` | errors as answers |
//! | `zipped.rs` | several files as one |

mod access;
mod files;
mod page;
mod refusal;
mod tasks;
mod zipped;

use std::sync::Arc;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::middleware::from_fn_with_state;
use axum::response::Redirect;
use axum::routing::{delete, get, post, put};

pub(crate) use access::Access;

use crate::folder::Folder;
use crate::tasks::Tasks;

/// Largest body of a request that is no upload, in bytes: descriptions are texts.
const LARGEST_BODY: usize = 2 << 20;

/// What the addresses work on.
pub(crate) struct Server {
    pub(crate) access: Access,
    pub(crate) folder: Arc<Folder>,
    pub(crate) tasks: Arc<Tasks>,
}

type Lab = axum::extract::State<Arc<Server>>;

/// All addresses, behind the guard.
pub(crate) fn routes(server: Arc<Server>) -> Router {
    let own = Router::new()
        .route("/", get(page::index))
        .route("/assets/{name}", get(page::asset))
        .route("/api/vocabulary", get(files::vocabulary))
        .route("/api/folder", get(files::folder))
        .route("/api/files/{name}", put(files::upload).layer(DefaultBodyLimit::disable()))
        .route("/api/described", post(files::described))
        .route("/api/edit", post(files::edit))
        .route("/api/state", post(files::state))
        .route("/api/materials/{name}", get(files::material).put(files::keep_material))
        .route("/api/try/{material}", post(tasks::try_squeeze))
        .route("/api/changes", get(tasks::changes))
        .route("/api/tasks", post(tasks::start))
        .route("/api/tasks/{id}", get(tasks::find))
        .route("/api/tasks/{id}", delete(tasks::cancel))
        .route("/api/tasks/{id}/rows", get(tasks::rows))
        .route("/api/tasks/{id}/rows.csv", get(tasks::rows_csv))
        .route("/api/tasks/{id}/map", get(tasks::map))
        .route("/api/tasks/{id}/pictures.zip", get(tasks::pictures))
        .route("/api/tasks/{id}/files/{*path}", get(tasks::file))
        .layer(DefaultBodyLimit::max(LARGEST_BODY))
        .with_state(Arc::clone(&server));
    let root = format!("/{}", server.access.token());
    let page = Redirect::permanent(&format!("{root}/"));
    Router::new()
        .route(&root, get(page))
        .nest(&format!("{root}/"), own)
        .layer(from_fn_with_state(server, access::guard))
}
