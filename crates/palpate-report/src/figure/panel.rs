//! One set of axes and what is drawn in it.

use super::{Layer, Role};

/// How an axis spaces its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences take equal room.
    Linear,
    /// Equal ratios take equal room; values at or below zero are left out.
    Log,
}

/// One axis: what it shows, in which unit, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name of the quantity.
    pub label: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// Spacing of the values.
    pub scale: Scale,
    /// Limits to show; found from the data when absent or unusable.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// An axis with equal spacing.
    #[must_use]
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            unit: unit.into(),
            scale: Scale::Linear,
            range: None,
        }
    }

    /// An axis with logarithmic spacing.
    #[must_use]
    pub fn log(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label, unit)
        }
    }

    /// The same axis with fixed limits.
    #[must_use]
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// `Time (s)`, or `Strain rate (10⁻³ s⁻¹)` when the tick labels leave a power of ten out.
    pub(crate) fn caption(&self, exponent: i32) -> String {
        let power = (exponent != 0).then(|| format!("10{}", crate::number::superscript(exponent)));
        match (power, self.unit.as_str()) {
            (None, "") => self.label.clone(),
            (None, unit) => format!("{} ({unit})", self.label),
            (Some(power), "") => format!("{} ({power})", self.label),
            (Some(power), unit) => format!("{} ({power} {unit})", self.label),
        }
    }
}

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
        self.layer(Layer::Horizontal {
            at: 0.0,
            role: Role::Reference,
            label: None,
        })
    }

    /// Whether any layer holds a value that can be drawn.
    pub(crate) fn is_empty(&self) -> bool {
        self.layers.iter().all(|layer| layer.is_empty(self.x.scale, self.y.scale))
    }

    pub(crate) fn map(&self) -> Option<&super::Map> {
        self.layers.iter().find_map(|layer| match layer {
            Layer::Map(map) => Some(map),
            _ => None,
        })
    }
}
