//! What can go wrong while drawing.

use palpate::watch::Cancelled;

/// Why a figure could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// The columns of one layer do not belong together.
    #[error("figure {figure:?}: {what} has {found} values, expected {expected}")]
    Length {
        /// Name of the figure.
        figure: String,
        /// The column at fault.
        what: &'static str,
        /// How many values it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// A picture inside the figure could not be encoded.
    #[error("figure {figure:?}: the heat map could not be encoded: {reason}")]
    Image {
        /// Name of the figure.
        figure: String,
        /// What the encoder stated.
        reason: String,
    },
    /// The figure could not be turned into pixels.
    #[error("figure {figure:?} could not be rasterised: {reason}")]
    Raster {
        /// Name of the figure.
        figure: String,
        /// What the renderer stated.
        reason: String,
    },
    /// The figure could not be written as PDF.
    #[error("figure {figure:?} could not be written as PDF: {reason}")]
    Pdf {
        /// Name of the figure.
        figure: String,
        /// What it contains that a PDF of ours does not.
        reason: String,
    },
    /// The watch ended it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
