//! Local searches where terms of a series merge, or all but imitate each other.
//!
//! | file | what |
//! |---|---|
//! | `valley.rs` | where a search ended |
//! | `confluent.rs` | divided differences in place of columns that imitate each other |
//! | `apart.rs` | merged rates taken apart as far as doubles need |
//! | `exact.rs` | the search |

pub(crate) mod apart;
mod confluent;
pub(crate) mod exact;
pub(crate) mod valley;
