//! A description as it is written: its text, the quantities in it, and what is wrong with it in plain words.
//!
//! | file | what |
//! |---|---|
//! | `source.rs` | the text, and saying where in it something is wrong |
//! | `places.rs` | from a place in the text to the path of a key, and back |
//! | `quantity.rs` | a quantity as written |
//! | `words.rs` | what the reader of TOML says, in plain words |
//! | `kind.rs` | test description, protocol or material ([`DescriptionKind`]) |
//! | `error.rs` | why a description cannot be used, and what would help ([`DescriptionError`]) |

pub(super) mod error;
pub(super) mod kind;
pub(super) mod places;
pub(super) mod quantity;
pub(super) mod source;
pub(super) mod words;

pub use error::{DescriptionError, KeyPosition, KeyProblem};
pub use kind::DescriptionKind;
pub use source::read_text;

/// A text as TOML writes it.
pub(crate) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
