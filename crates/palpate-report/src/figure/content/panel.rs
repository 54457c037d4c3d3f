//! One set of axes and what is drawn in it.

use super::axis::Axis;
use super::layer::{Layer, Map, Mark};
use super::role::Role;

/// One set of axes with its layers.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    pub(crate) title: Option<String>,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) layers: Vec<Layer>,
    pub(crate) share: f64,
    pub(crate) empty_note: String,
}

impl Panel {
    /// Empty axes.
    #[must_use]
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            title: None,
            x,
            y,
            layers: Vec::new(),
            share: 1.0,
            empty_note: "No data to show".to_owned(),
        }
    }

    /// A quantity over time in seconds.
    #[must_use]
    pub fn over_time(quantity: &str, unit: &str) -> Self {
        Self::new(Axis::linear("Time", "s"), Axis::linear(quantity, unit))
    }

    /// Sets the heading above the axes.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = Some(title.into());
        self
    }

    /// Adds one layer; lines and points are drawn in the order in which they are added.
    #[must_use]
    pub fn layer(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// Adds several layers.
    #[must_use]
    pub fn layers(mut self, layers: impl IntoIterator<Item = Layer>) -> Self {
        self.layers.extend(layers);
        self
    }

    /// Height relative to the other rows of the figure (1 unless set); 0.4 suits residuals.
    #[must_use]
    pub fn share(mut self, share: f64) -> Self {
        self.share = if share.is_finite() { share.clamp(0.05, 20.0) } else { 1.0 };
        self
    }

    /// Sets what is written in the panel when no layer has anything to draw.
    #[must_use]
    pub fn empty_note(mut self, note: impl Into<String>) -> Self {
        self.empty_note = note.into();
        self
    }

    /// A dashed line at zero, as residual panels want it.
    #[must_use]
    pub fn zero_line(self) -> Self {
        self.layer(Layer::horizontal(0.0, Role::Reference))
    }

    /// Whether any layer holds a value that can be drawn.
    pub(crate) fn is_empty(&self) -> bool {
        self.layers.iter().all(|layer| layer.is_empty(self.x.scale, self.y.scale))
    }

    /// The values that are shown as colours, with their quantity.
    pub(crate) fn colours(&self) -> Option<(&[f64], &Axis)> {
        self.layers.iter().find_map(|layer| match &layer.mark {
            Mark::Map(map) => Some((&map.values[..], &map.colours)),
            Mark::Spots { values, colours, .. } => Some((&values[..], colours)),
            _ => None,
        })
    }

    pub(crate) fn map(&self) -> Option<&Map> {
        self.layers.iter().find_map(|layer| match &layer.mark {
            Mark::Map(map) => Some(map),
            _ => None,
        })
    }
}
