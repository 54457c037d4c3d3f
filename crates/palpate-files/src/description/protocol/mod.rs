//! A protocol: a body, its law, and the steps of the jaw, for a simulation.
//!
//! | file | what |
//! |---|---|
//! | `tables.rs`, `sweep_schema.rs` | the tables as they stand, and as editors know them |
//! | `named_body.rs` | the body of a material file that a protocol names |
//! | `steps.rs` | the steps, and the motion that they make |
//! | `convert.rs` | tables to a [`Protocol`] |
//! | `numbers.rs` | the numbers of a protocol that can be replaced |

pub(super) mod convert;
pub(super) mod named_body;
pub(super) mod numbers;
mod steps;
pub(super) mod sweep_schema;
pub(super) mod tables;

pub use convert::{
    Protocol, law_named, parse_protocol, parse_protocol_of, parse_scene, read_protocol, read_protocol_of,
    read_protocol_text, read_scene, self_contained,
};
