//! Figures, tables and self-contained report pages.
//!
//! Three layers know nothing of the mechanics they show:
//!
//! * [`figure`] draws panels of lines, points, bands and heat maps as SVG and PNG,
//! * [`table`] holds named columns once and writes them as CSV, plain text or HTML,
//! * [`page`] gathers both into one HTML file that opens without a network.
//!
//! [`number`] decides how a value reads for a person and how it is stored for a machine.
//!
//! On top of them, [`document`] holds results as JSON and [`study`] says which figures, tables and sections a study has.

pub mod calibrated;
pub mod compared;
pub mod document;
mod escape;
pub mod figure;
pub mod gripped;
pub mod page;
mod script;
pub mod sparkline;
pub mod study;
pub mod table;

pub use palpate::number;
