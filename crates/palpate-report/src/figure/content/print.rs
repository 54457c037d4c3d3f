//! A figure for print: its file format, and its width in a journal.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::figure::{Arrangement, Figure};
use super::panel::Panel;

/// Format of the file of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PictureFormat {
    /// Vectors with text as text, in the typeface of the reader.
    Svg,
    /// Pixels, 300 per inch.
    Png,
    /// Vectors with the typeface embedded.
    Pdf,
}

impl PictureFormat {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Svg, Self::Png, Self::Pdf];

    /// The ending of a file's name.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
        }
    }

    /// The format that the name of a file states.
    ///
    /// ```
    /// use palpate_report::figure::PictureFormat;
    ///
    /// assert_eq!(PictureFormat::of("holds.pdf".as_ref()), Some(PictureFormat::Pdf));
    /// assert_eq!(PictureFormat::of("holds.jpg".as_ref()), None);
    /// ```
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|format| path.extension().is_some_and(|ending| ending == format.ending()))
    }
}

/// Width of a figure in a journal whose pages have two columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Column {
    /// One column, 85 mm.
    Single,
    /// Both columns, 174 mm.
    Double,
}

/// Largest height of a figure on a page with its caption, mm.
const PAGE_MM: f64 = 225.0;
/// Most height of a legend above all panels, mm.
const LEGEND_MM: f64 = 15.0;
/// Least height of a row of panels in which ticks, captions and a legend have room, mm.
const ROW_MM: f64 = 45.0;

impl Column {
    /// Width of the column, mm: the least of the widths that journals ask for, so that a figure fits into any of them.
    #[must_use]
    pub fn width_mm(self) -> f64 {
        match self {
            Self::Single => 85.0,
            Self::Double => 174.0,
        }
    }

    /// Most panels beside each other in which ticks and legends have room.
    fn most_beside(self) -> usize {
        match self {
            Self::Single => 1,
            Self::Double => 2,
        }
    }
}

impl Figure {
    /// The same figure as wide as a column of a journal and no higher than its page, with text of the same size (7 and 8 pt): panels that
    /// stood beside each other go below each other where the column is narrow, and to further figures where the page is full.
    ///
    /// ```
    /// use palpate_report::figure::{Axis, Column, Figure, Layer, Panel, Role};
    ///
    /// let panel = Panel::over_time("Force", "N").layer(Layer::line(vec![0.0, 1.0], vec![2.0, 1.0], Role::Measured));
    /// let figures = Figure::new("force", "").panel(panel).for_column(Column::Single);
    /// let svg = figures[0].to_svg()?;
    /// assert!(svg.contains("width=\"85mm\" height=\"65.65mm\""), "{svg}");
    /// # Ok::<(), palpate_report::figure::FigureError>(())
    /// ```
    #[must_use]
    pub fn for_column(&self, column: Column) -> Vec<Self> {
        let [width, height] = <[f64; 2]>::from(self.size_points()).map(|points| points * 25.4 / 72.0);
        let (panels, before) = (self.panels.len().max(1), self.columns());
        let beside = before.min(column.most_beside());
        // Narrower panels become lower, by half as much: text keeps its size.
        let narrower = (column.width_mm() / beside as f64) / (width / before as f64);
        let height = height * narrower.sqrt();
        if self.arrangement == Arrangement::Stacked {
            return vec![self.clone().width_mm(column.width_mm()).height_mm(height.min(PAGE_MM))];
        }
        let page = if self.has_common_legend { PAGE_MM - LEGEND_MM } else { PAGE_MM };
        let highest = if panels == 1 { page } else { page / 4.0 };
        let row = (height / panels.div_ceil(before) as f64).clamp(ROW_MM, highest);
        let rows = (page / row).floor() as usize;
        let parts = self.panels.chunks(rows * beside);
        let several = parts.len() > 1;
        let part = |(index, panels): (usize, &[Panel])| {
            let mut figure = self.clone();
            figure.panels = panels.to_vec();
            if several {
                figure.name = format!("{}_part_{}", self.name, index + 1);
            }
            let height = row * panels.len().div_ceil(beside) as f64;
            figure.arrangement(Arrangement::Grid(beside)).width_mm(column.width_mm()).height_mm(height)
        };
        parts.enumerate().map(part).collect()
    }
}
