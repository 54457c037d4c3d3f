//! A figure once drawn: as a document of its own, and as a page shows it.

use super::legend::{self, Entry};
use super::svg::{document, element};
use crate::figure::content::{Arrangement, Figure};
use crate::figure::layout::Rect;

/// Picture elements of a page for each point of a figure, where there is room: tick labels are then as large as captions.
const SCALE: f64 = 1.75;

/// A figure as a page shows it: panels that stand beside each other flow into as many columns as there is room for.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// SVG elements: one a panel, or one with all panels below each other.
    pub(crate) panels: Vec<String>,
    /// The same panels for a narrow page, where those below each other would be too small to read.
    pub(crate) narrow: Option<String>,
    /// Columns where there is room.
    pub(crate) columns: usize,
    /// Entries of the legend of all panels, each with its sample.
    pub(crate) legend: Vec<(String, String)>,
}

/// A figure once drawn.
pub(crate) struct Drawn {
    /// A document of its own.
    pub(crate) svg: String,
    /// What a page shows.
    pub(crate) view: View,
}

impl Drawn {
    /// From what was drawn: the common legend with its entries, and each panel with the room that it takes.
    pub(super) fn new(
        figure: &Figure,
        size: (f64, f64),
        (legend, entries): (&str, &[Entry]),
        panels: &[(Rect, String)],
    ) -> Self {
        let body: String = std::iter::once(legend).chain(panels.iter().map(|(_, body)| body.as_str())).collect();
        let columns = figure.columns();
        let views = if columns > 1 {
            let described = figure.panels.iter().map(|panel| panel.title.as_deref().unwrap_or(&figure.caption));
            panels
                .iter()
                .zip(described)
                .map(|((cell, body), text)| element(*cell, SCALE, Some(text), body))
                .collect()
        } else {
            vec![element(Rect::new(0.0, 0.0, size.0, size.1), SCALE, Some(&figure.caption), &body)]
        };
        let view = View {
            panels: views,
            narrow: None,
            columns,
            legend: legend::samples(entries, SCALE),
        };
        Self {
            svg: document(size, &figure.caption, &body),
            view,
        }
    }
}

impl Figure {
    /// Whether a narrow page needs another drawing.
    pub(super) fn is_wide(&self) -> bool {
        self.arrangement == Arrangement::Stacked && self.size_points().0 > WIDE
    }
}

/// Points beyond which a drawing that does not flow is too small on a narrow page: labels of 7 points have 8.5 of its 388 picture elements.
const WIDE: f64 = 319.0;

/// Width of a drawing for a narrow page, mm.
pub(super) const NARROW_MM: f64 = 92.0;
