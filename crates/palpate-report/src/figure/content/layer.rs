//! What can be drawn in a panel.

use super::axis::{Scale, shows};
use super::error::FigureError;
use super::role::Role;

/// One thing drawn in a panel. Values that are not finite leave a gap.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Layer {
    /// A line through points in the given order.
    Line {
        /// Horizontal positions.
        x: Vec<f64>,
        /// Vertical positions.
        y: Vec<f64>,
        /// What the line stands for.
        role: Role,
        /// Text in the legend.
        label: Option<String>,
    },
    /// Separate points.
    Points {
        /// Horizontal positions.
        x: Vec<f64>,
        /// Vertical positions.
        y: Vec<f64>,
        /// Half-length of the vertical error bars, if there are any.
        error: Option<Vec<f64>>,
        /// What the points stand for.
        role: Role,
        /// Text in the legend.
        label: Option<String>,
    },
    /// The area between two lines.
    Band {
        /// Horizontal positions.
        x: Vec<f64>,
        /// Lower edge.
        low: Vec<f64>,
        /// Upper edge.
        high: Vec<f64>,
        /// What the band stands for.
        role: Role,
        /// Text in the legend.
        label: Option<String>,
    },
    /// A shaded stretch of the horizontal axis, named above the panel.
    Span {
        /// Start.
        from: f64,
        /// End.
        to: f64,
        /// Decides the tint.
        role: Role,
        /// Name of the stretch.
        label: Option<String>,
    },
    /// A level across the panel.
    Horizontal {
        /// Where.
        at: f64,
        /// What it stands for.
        role: Role,
        /// Text at its right end.
        label: Option<String>,
    },
    /// A position on the horizontal axis.
    Vertical {
        /// Where.
        at: f64,
        /// What it stands for.
        role: Role,
        /// Text at its upper end.
        label: Option<String>,
    },
    /// Values over two coordinates, as colours.
    Map(Map),
}

/// A heat map with its colour bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Horizontal positions of the columns, ascending.
    pub x: Vec<f64>,
    /// Vertical positions of the rows, ascending.
    pub y: Vec<f64>,
    /// Row after row: the value of row `j` and column `i` is at `j * x.len() + i`.
    pub values: Vec<f64>,
    /// Name of the quantity.
    pub label: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// Values at the two ends of the colours; found from the data when absent or unusable.
    pub range: Option<(f64, f64)>,
}

impl Layer {
    /// A line without a legend entry.
    #[must_use]
    pub fn line(x: Vec<f64>, y: Vec<f64>, role: Role) -> Self {
        Self::Line {
            x,
            y,
            role,
            label: None,
        }
    }

    /// Points without error bars and legend entry.
    #[must_use]
    pub fn points(x: Vec<f64>, y: Vec<f64>, role: Role) -> Self {
        Self::Points {
            x,
            y,
            error: None,
            role,
            label: None,
        }
    }

    /// A band without a legend entry.
    #[must_use]
    pub fn band(x: Vec<f64>, low: Vec<f64>, high: Vec<f64>, role: Role) -> Self {
        Self::Band {
            x,
            low,
            high,
            role,
            label: None,
        }
    }

    /// A shaded stretch of the horizontal axis without a name.
    #[must_use]
    pub fn span(from: f64, to: f64, role: Role) -> Self {
        Self::Span {
            from,
            to,
            role,
            label: None,
        }
    }

    /// A level across the panel.
    #[must_use]
    pub fn horizontal(at: f64, role: Role) -> Self {
        Self::Horizontal { at, role, label: None }
    }

    /// A position on the horizontal axis.
    #[must_use]
    pub fn vertical(at: f64, role: Role) -> Self {
        Self::Vertical { at, role, label: None }
    }

    /// A heat map coloured from its smallest to its largest value.
    #[must_use]
    pub fn map(x: Vec<f64>, y: Vec<f64>, values: Vec<f64>, label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self::Map(Map {
            x,
            y,
            values,
            label: label.into(),
            unit: unit.into(),
            range: None,
        })
    }

    /// The same layer with a label; layers of one panel with equal labels share a legend entry.
    #[must_use]
    pub fn label(mut self, text: impl Into<String>) -> Self {
        match &mut self {
            Self::Line { label, .. }
            | Self::Points { label, .. }
            | Self::Band { label, .. }
            | Self::Span { label, .. }
            | Self::Horizontal { label, .. }
            | Self::Vertical { label, .. } => *label = Some(text.into()),
            Self::Map(map) => map.label = text.into(),
        }
        self
    }

    /// The same points with vertical error bars; other layers stay as they are.
    #[must_use]
    pub fn error_bars(mut self, half_lengths: Vec<f64>) -> Self {
        if let Self::Points { error, .. } = &mut self {
            *error = Some(half_lengths);
        }
        self
    }

    /// Checks that the columns belong together.
    pub(crate) fn check(&self, figure: &str) -> Result<(), FigureError> {
        let need = |what, found, expected| {
            if found == expected {
                return Ok(());
            }
            Err(FigureError::Length {
                figure: figure.to_owned(),
                what,
                found,
                expected,
            })
        };
        match self {
            Self::Line { x, y, .. } => need("y of a line", y.len(), x.len()),
            Self::Points { x, y, error, .. } => {
                need("y of points", y.len(), x.len())?;
                need("error of points", error.as_ref().map_or(x.len(), Vec::len), x.len())
            }
            Self::Band { x, low, high, .. } => {
                need("lower edge of a band", low.len(), x.len())?;
                need("upper edge of a band", high.len(), x.len())
            }
            Self::Map(map) => need("values of a map", map.values.len(), map.x.len() * map.y.len()),
            Self::Span { .. } | Self::Horizontal { .. } | Self::Vertical { .. } => Ok(()),
        }
    }

    /// Whether nothing of the layer can be drawn; spans and reference lines alone do not count.
    pub(crate) fn is_empty(&self, x_scale: Scale, y_scale: Scale) -> bool {
        let none = |x: &[f64], y: &[f64]| !x.iter().zip(y).any(|(x, y)| shows(*x, x_scale) && shows(*y, y_scale));
        match self {
            Self::Line { x, y, .. } | Self::Points { x, y, .. } => none(x, y),
            Self::Band { x, low, high, .. } => none(x, low) && none(x, high),
            Self::Map(map) => {
                !map.values.iter().any(|v| v.is_finite())
                    || !map.x.iter().any(|v| shows(*v, x_scale))
                    || !map.y.iter().any(|v| shows(*v, y_scale))
            }
            Self::Span { .. } | Self::Horizontal { .. } | Self::Vertical { .. } => true,
        }
    }
}
