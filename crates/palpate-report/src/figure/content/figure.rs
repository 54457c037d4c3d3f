//! A figure: its panels, their arrangement and its size.

use super::panel::Panel;

/// Panels of one figure that can still be read.
pub const MOST_PANELS: usize = 12;

/// How the panels of a figure stand to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Arrangement {
    /// Below each other; panels that show the same quantity share the horizontal axis.
    #[default]
    Stacked,
    /// Beside each other.
    SideBySide,
    /// In rows of this many.
    Grid(usize),
}

/// A figure with its caption.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figure {
    /// Name of the figure, fit for a file name without extension.
    pub name: String,
    /// Caption; also what a reader who cannot see the figure is given.
    pub caption: String,
    pub(crate) panels: Vec<Panel>,
    pub(crate) arrangement: Arrangement,
    pub(crate) without_letters: bool,
    pub(crate) has_common_legend: bool,
    pub(crate) continues: Option<String>,
    /// Whether its panels are in the units that suit all panels of several figures.
    pub(crate) has_suited_units: bool,
    width_mm: Option<f64>,
    height_mm: Option<f64>,
}

impl Figure {
    /// A figure without panels, stacked unless stated otherwise.
    #[must_use]
    pub fn new(name: impl Into<String>, caption: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            caption: caption.into(),
            ..Self::default()
        }
    }

    /// Adds a panel.
    #[must_use]
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// Adds panels.
    #[must_use]
    pub fn panels(mut self, panels: impl IntoIterator<Item = Panel>) -> Self {
        self.panels.extend(panels);
        self
    }

    /// Sets how panels stand to each other.
    #[must_use]
    pub fn arrangement(mut self, arrangement: Arrangement) -> Self {
        self.arrangement = arrangement;
        self
    }

    /// Sets the width in millimetres; journals take about 85 for one column and 174 for two.
    #[must_use]
    pub fn width_mm(mut self, width: f64) -> Self {
        self.width_mm = Some(width);
        self
    }

    /// Sets the height in millimetres.
    #[must_use]
    pub fn height_mm(mut self, height: f64) -> Self {
        self.height_mm = Some(height);
        self
    }

    /// One legend for all panels, above them, in place of one in each.
    #[must_use]
    pub fn common_legend(mut self) -> Self {
        self.has_common_legend = true;
        self
    }

    /// States that the figure goes on where another one ends, with what it shows: a page folds it below that one.
    #[must_use]
    pub fn continues(mut self, title: impl Into<String>) -> Self {
        self.continues = Some(title.into());
        self
    }

    /// Leaves the letters (a), (b), … away that figures of several panels carry.
    #[must_use]
    pub fn without_letters(mut self) -> Self {
        self.without_letters = true;
        self
    }

    /// Width and height in points.
    pub(crate) fn size_points(&self) -> (f64, f64) {
        let rows = match self.arrangement {
            Arrangement::Stacked => self.panels.iter().map(|p| p.share).sum::<f64>().max(0.5),
            Arrangement::SideBySide => 1.0,
            Arrangement::Grid(columns) => self.panels.len().div_ceil(columns.max(1)).max(1) as f64,
        };
        let (width, height) = match self.arrangement {
            Arrangement::Stacked if self.panels.len() <= 1 => (120.0, 78.0),
            Arrangement::Stacked => (150.0, 16.0 + 52.0 * rows),
            Arrangement::SideBySide | Arrangement::Grid(_) => (174.0, 64.0 * rows),
        };
        let usable = |given: Option<f64>, otherwise: f64| {
            given.filter(|v| v.is_finite()).unwrap_or(otherwise).clamp(20.0, 2000.0) * 72.0 / 25.4
        };
        (usable(self.width_mm, width), usable(self.height_mm, height))
    }
}
