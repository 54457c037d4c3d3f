//! File formats of palpate: from bytes on a disk to columns of numbers with names and units.
//!
//! [`text`] reads delimited text: it finds out how a file is written ([`text::detect`]) and
//! streams chosen columns out of it ([`text::read_columns`]).

pub mod text;
