//! The lab: a page in the browser over the jobs of palpate, served on the loopback interface of this machine.
//!
//! The page drops files into a folder, describes them, and starts tasks; a task runs one job of `palpate-jobs` on a thread of its own, tells
//! how far it is, and keeps what it made until newer tasks take its place. All other state is the folder: records, a description beside each
//! that was described (`ball.csv.test.toml`), and materials (`ball.material.toml`). Without a folder the records lie in a temporary one,
//! which goes when the lab ends.
//!
//! | file | what |
//! |---|---|
//! | `lib.rs` | [`Lab`]: folder, port, browser |
//! | `folder/` | the files of the folder, and nothing outside it |
//! | `tasks/` | tasks: the jobs that they run, their queue, what they made |
//! | `lines.rs` | the command line and the lines of Python that do the same |
//! | `refusal.rs` | errors in the words of the page |
//! | `server/` | addresses of the page, and who may use them |
//! | `browser.rs` | opening the page without showing its address to other users |

mod browser;
mod folder;
mod lines;
mod refusal;
mod server;
mod tasks;

use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;

use palpate_jobs::{ErrorKind, JobError};

use crate::folder::Folder;
use crate::server::{Access, Server};
use crate::tasks::Tasks;

/// The lab as it is to be started.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Lab {
    /// Folder of the records; a temporary one if not given.
    pub folder: Option<PathBuf>,
    /// Port of the loopback interface; a free one if not given.
    pub port: Option<u16>,
    /// Whether to open the page in a browser.
    pub open: bool,
}

/// A lab that listens.
pub struct Listening {
    listener: std::net::TcpListener,
    server: Arc<Server>,
    open: bool,
}

impl Lab {
    /// Listens on the loopback interface.
    ///
    /// # Errors
    /// [`JobError`] where the folder cannot be used, or the port is taken.
    pub fn listen(&self) -> Result<Listening, JobError> {
        let folder = Folder::open(self.folder.as_deref())?;
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, self.port.unwrap_or(0)));
        let failed = |error: io::Error| {
            let hint = match (error.kind(), self.port) {
                (io::ErrorKind::AddrInUse, Some(_)) => "choose another ⟨port⟩, or leave it out for a free one",
                _ => "",
            };
            JobError::new(
                ErrorKind::File(error.kind()),
                format!("cannot listen on {address}: {error}"),
                hint.to_owned(),
            )
        };
        let listener = std::net::TcpListener::bind(address).map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        let port = listener.local_addr().map_err(failed)?.port();
        let access = Access::new(port)?;
        let folder = Arc::new(folder);
        let server = Server {
            access,
            tasks: Tasks::start(Arc::clone(&folder)),
            folder,
        };
        Ok(Listening {
            listener,
            server: Arc::new(server),
            open: self.open,
        })
    }
}

impl Listening {
    /// The address of the page. Whoever has it can use the lab.
    #[must_use]
    pub fn address(&self) -> String {
        self.server.access.address()
    }

    /// The folder of the records.
    #[must_use]
    pub fn folder(&self) -> PathBuf {
        self.server.folder.path().to_owned()
    }

    /// Whether that folder goes when the lab ends.
    #[must_use]
    pub fn is_temporary(&self) -> bool {
        self.server.folder.is_temporary()
    }

    /// Serves the page until the process ends.
    ///
    /// # Errors
    /// [`JobError`] where the operating system ends it; `reported` hears that no browser could be opened.
    pub fn serve(self, reported: impl FnOnce(&str)) -> Result<(), JobError> {
        let failed =
            |error: io::Error| JobError::new(ErrorKind::File(error.kind()), format!("the lab ended: {error}"), None);
        let runtime =
            tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build().map_err(failed)?;
        // Kept until the end: the browser may be slow to read it.
        let _way = if self.open {
            browser::open(&self.address())
                .map_err(|error| reported(&format!("no browser was opened: {error}")))
                .ok()
        } else {
            None
        };
        let (listener, server) = (self.listener, self.server);
        runtime
            .block_on(async move {
                let listener = tokio::net::TcpListener::from_std(listener)?;
                axum::serve(listener, server::routes(server)).await
            })
            .map_err(failed)
    }
}
