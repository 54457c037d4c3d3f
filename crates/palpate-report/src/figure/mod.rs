//! Figures: panels of lines, points, bands, shaded stretches and heat maps.
//!
//! A figure is described by what it shows, not by how: layers name their [`Role`], axes their
//! quantity and unit, and the drawing decides colours, dashes, ticks and the place of legends.
//! The same description always gives the same bytes.
//!
//! ```
//! use palpate_report::figure::{Axis, Figure, Layer, Panel, Role};
//!
//! let time = vec![0.0, 1.0, 2.0];
//! let figure = Figure::new("record", "Force over time.").panel(
//!     Panel::new(Axis::linear("Time", "s"), Axis::linear("Force", "N"))
//!         .layer(Layer::line(time, vec![0.0, 2.5, 1.9], Role::Measured).label("recorded")),
//! );
//! assert!(figure.to_svg()?.starts_with("<svg"));
//! # Ok::<(), palpate_report::figure::FigureError>(())
//! ```
//!
//! | room | what |
//! |---|---|
//! | `content/` | what is shown: figure, panels, axes, layers, roles |
//! | `layout/` | where it stands: frames, scales, ticks, widths of text, room that is taken |
//! | `draw/` | the marks on the page: SVG, PNG, PDF |

mod content;
mod draw;
mod layout;

pub use content::{
    Arrangement, Axis, Column, Figure, FigureError, Layer, MOST_PANELS, Map, Mark, Panel, PictureFormat, Role, Scale,
};
pub(crate) use draw::Drawn;
pub use draw::View;
