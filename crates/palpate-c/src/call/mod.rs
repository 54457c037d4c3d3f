//! What all calls share.
//!
//! | file | content |
//! |---|---|
//! | `status.rs` | codes and their texts |
//! | `message.rs` | messages into a buffer of the caller |
//! | `guard.rs` | what no panic passes |
//! | `pointer.rs` | pointers of the caller, checked for null |

mod guard;
mod message;
mod pointer;
mod status;

pub use status::{Status, palpate_status_text};
pub(crate) use {
    guard::guarded,
    message::Message,
    pointer::{exclusive, shared, write},
};
