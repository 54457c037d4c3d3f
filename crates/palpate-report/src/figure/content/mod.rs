//! What a figure shows, without a position on the page.
//!
//! The public types come in from the reports; `layout` and `draw` read them and never change them.
//!
//! | file | what |
//! |---|---|
//! | `figure.rs` | the figure, how its panels are arranged |
//! | `panel.rs` | one set of axes and its layers |
//! | `axis.rs` | quantity, unit, spacing and limits of an axis |
//! | `layer.rs` | lines, points, bands, spans, reference lines and heat maps |
//! | `print.rs` | formats of files, widths of journals |
//! | `role.rs` | what a layer stands for, and its colour, dash and marker |
//! | `units.rs` | the figure in units that suit its sizes |
//! | `error.rs` | why a figure cannot be drawn |

mod axis;
mod error;
mod figure;
mod layer;
mod panel;
mod print;
mod role;
mod units;

pub(super) use axis::shows;
pub use axis::{Axis, Scale};
pub use error::FigureError;
pub use figure::{Arrangement, Figure, MOST_PANELS};
pub use layer::{Layer, Map, Mark};
pub use panel::Panel;
pub use print::{Column, PictureFormat};
pub use role::Role;
pub(super) use role::{Marker, Style};
