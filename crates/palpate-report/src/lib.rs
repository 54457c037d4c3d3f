//! Figures, tables and self-contained report pages.
//!
//! A module uses only those above it:
//!
//! | module | what |
//! |---|---|
//! | [`number`] | how a value reads for a person and how it is stored for a machine |
//! | [`sparkline`], `wrap`, `script`, `escape`, `word` | lines of a terminal; characters of SVG and HTML; words for variants |
//! | [`spelling`] | options that messages name |
//! | [`table`] | named columns once, written as CSV, plain text, Markdown or HTML |
//! | [`figure`] | panels of lines, points, bands and heat maps as SVG and PNG |
//! | [`page`] | both in one HTML file that opens without a network |
//! | [`result`] | results of the library with where they come from and what they say in words |
//! | [`document`] | results as JSON |
//! | [`study`] | which figures, tables and sections a study has |
//!
//! Those down to [`page`] know nothing of the mechanics they show.

pub mod document;
mod escape;
pub mod figure;
pub mod page;
pub mod result;
mod script;
pub mod sparkline;
pub mod spelling;
pub mod study;
pub mod table;
mod word;
mod wrap;

pub use palpate::number;
pub use wrap::{set_width, wrapped};
