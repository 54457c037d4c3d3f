//! Files that are cut off, overwritten, made up or mistaken: what is stated of each, and that none does harm.
//!
//! The files are in `tests/corpus`, in one folder a format; `tests/any_file/pack.rs` says what they are. Files called
//! `good…` are read; of all others `tests/corpus/messages.toml` holds the message and the hint. To write that table anew,
//! to read it over and commit it: `PALPATE_WRITE_MESSAGES=1 cargo test -p palpate-files --test hostile`.

#[path = "../any_file/mod.rs"]
mod any_file;
#[path = "../budget/mod.rs"]
mod budget;
mod corpus;
mod cost;
mod damage;
mod escape;
mod made;
mod messages;
