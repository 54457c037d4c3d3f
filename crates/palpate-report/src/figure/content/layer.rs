//! What can be drawn in a panel.

use super::axis::{Axis, Scale, shows};
use super::error::FigureError;
use super::role::Role;

/// One thing drawn in a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// What is drawn.
    pub mark: Mark,
    /// What it stands for.
    pub role: Role,
    /// Text in the legend; of a shaded stretch above the panel, of a level or position at its end.
    pub label: Option<String>,
}

/// Marks of a layer. Values that are not finite leave a gap.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Mark {
    /// A line through points in the given order.
    Line {
        /// Horizontal positions.
        x: Vec<f64>,
        /// Vertical positions.
        y: Vec<f64>,
    },
    /// Separate points.
    Points {
        /// Horizontal positions.
        x: Vec<f64>,
        /// Vertical positions.
        y: Vec<f64>,
        /// Lower and upper ends of vertical error bars, if there are any.
        error: Option<(Vec<f64>, Vec<f64>)>,
    },
    /// The area between two lines.
    Band {
        /// Horizontal positions.
        x: Vec<f64>,
        /// Lower edge.
        low: Vec<f64>,
        /// Upper edge.
        high: Vec<f64>,
    },
    /// A shaded stretch of the horizontal axis from start to end, named above the panel; its role decides the tint.
    Span(f64, f64),
    /// A level across the panel.
    Horizontal(f64),
    /// A position on the horizontal axis.
    Vertical(f64),
    /// Values over two coordinates, as colours.
    Map(Map),
    /// Separate points with their values as colours; a point without a value is left out.
    Spots {
        /// Horizontal positions.
        x: Vec<f64>,
        /// Vertical positions.
        y: Vec<f64>,
        /// Values.
        values: Vec<f64>,
        /// The quantity, as for a [`Map`].
        colours: Axis,
    },
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
    /// The quantity and what stands at the two ends of the colours; without a usable range its smallest and its largest value do. Colours
    /// are always spaced linearly.
    pub colours: Axis,
}

impl Layer {
    fn of(role: Role, mark: Mark) -> Self {
        let label = None;
        Self { mark, role, label }
    }

    /// A line without a legend entry.
    #[must_use]
    pub fn line(x: Vec<f64>, y: Vec<f64>, role: Role) -> Self {
        Self::of(role, Mark::Line { x, y })
    }

    /// Points without error bars and legend entry.
    #[must_use]
    pub fn points(x: Vec<f64>, y: Vec<f64>, role: Role) -> Self {
        Self::of(role, Mark::Points { x, y, error: None })
    }

    /// A band without a legend entry.
    #[must_use]
    pub fn band(x: Vec<f64>, low: Vec<f64>, high: Vec<f64>, role: Role) -> Self {
        Self::of(role, Mark::Band { x, low, high })
    }

    /// A shaded stretch of the horizontal axis without a name.
    #[must_use]
    pub fn span(from: f64, to: f64, role: Role) -> Self {
        Self::of(role, Mark::Span(from, to))
    }

    /// A level across the panel.
    #[must_use]
    pub fn horizontal(at: f64, role: Role) -> Self {
        Self::of(role, Mark::Horizontal(at))
    }

    /// A position on the horizontal axis.
    #[must_use]
    pub fn vertical(at: f64, role: Role) -> Self {
        Self::of(role, Mark::Vertical(at))
    }

    /// A heat map.
    #[must_use]
    pub fn map(map: Map) -> Self {
        Self::of(Role::Measured, Mark::Map(map))
    }

    /// Points with their values as colours.
    #[must_use]
    pub fn spots(x: Vec<f64>, y: Vec<f64>, values: Vec<f64>, colours: Axis) -> Self {
        Self::of(Role::Measured, Mark::Spots { x, y, values, colours })
    }

    /// The same layer with a label; layers of one panel with equal labels share a legend entry.
    #[must_use]
    pub fn label(mut self, text: impl Into<String>) -> Self {
        self.label = Some(text.into());
        self
    }

    /// The same points with vertical error bars of these half-lengths; other layers stay as they are.
    #[must_use]
    pub fn error_bars(self, half_lengths: &[f64]) -> Self {
        let Mark::Points { y, .. } = &self.mark else {
            return self;
        };
        let end = |sign: f64| y.iter().zip(half_lengths).map(|(y, half)| y + sign * half).collect();
        let (low, high) = (end(-1.0), end(1.0));
        self.intervals(low, high)
    }

    /// The same points with vertical error bars between these ends; other layers stay as they are.
    #[must_use]
    pub fn intervals(mut self, low: Vec<f64>, high: Vec<f64>) -> Self {
        if let Mark::Points { error, .. } = &mut self.mark {
            *error = Some((low, high));
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
        match &self.mark {
            Mark::Line { x, y } => need("y of a line", y.len(), x.len()),
            Mark::Points { x, y, error } => {
                need("y of points", y.len(), x.len())?;
                let ends = error.as_ref().map_or([x.len(); 2], |(low, high)| [low.len(), high.len()]);
                ends.into_iter().try_for_each(|found| need("error of points", found, x.len()))
            }
            Mark::Band { x, low, high } => {
                need("lower edge of a band", low.len(), x.len())?;
                need("upper edge of a band", high.len(), x.len())
            }
            Mark::Map(map) => need("values of a map", map.values.len(), map.x.len() * map.y.len()),
            Mark::Spots { x, y, values, .. } => {
                need("y of points", y.len(), x.len())?;
                need("values of points", values.len(), x.len())
            }
            Mark::Span(..) | Mark::Horizontal(_) | Mark::Vertical(_) => Ok(()),
        }
    }

    /// Whether nothing of the layer can be drawn; spans and reference lines alone do not count.
    pub(crate) fn is_empty(&self, x_scale: Scale, y_scale: Scale) -> bool {
        let none = |x: &[f64], y: &[f64]| !x.iter().zip(y).any(|(x, y)| shows(*x, x_scale) && shows(*y, y_scale));
        match &self.mark {
            Mark::Line { x, y } | Mark::Points { x, y, .. } => none(x, y),
            Mark::Band { x, low, high } => none(x, low) && none(x, high),
            Mark::Spots { x, y, values, .. } => none(x, y) || !values.iter().any(|v| v.is_finite()),
            Mark::Map(map) => {
                !map.values.iter().any(|v| v.is_finite())
                    || !map.x.iter().any(|v| shows(*v, x_scale))
                    || !map.y.iter().any(|v| shows(*v, y_scale))
            }
            Mark::Span(..) | Mark::Horizontal(_) | Mark::Vertical(_) => true,
        }
    }
}
