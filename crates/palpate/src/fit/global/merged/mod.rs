//! Local searches where terms of a series merge, or all but imitate each other.
//!
//! | file | what |
//! |---|---|
//! | `confluent.rs` | divided differences in place of columns that imitate each other |
//! | `apart.rs` | where a search ended, merged rates taken apart as far as doubles need |
//! | `exact.rs` | the search |

pub(crate) mod apart;
mod confluent;
pub(crate) mod exact;

pub(super) use apart::{Valley, rounding};
pub(super) use exact::{exact, inflation, local};
