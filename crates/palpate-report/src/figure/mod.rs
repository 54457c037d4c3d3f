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

mod axes;
mod decimate;
mod error;
mod heatmap;
mod layer;
mod layout;
mod legend;
mod panel;
mod raster;
mod reference;
mod role;
mod scale;
mod series;
mod svg;
mod text;
mod ticks;

pub use error::FigureError;
pub use layer::{Layer, Map};
pub use panel::{Axis, Panel, Scale};
pub use role::Role;

use layout::Frame;
use legend::Occupancy;
use svg::{Rect, Svg};

/// How the panels of a figure stand to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// Below each other; panels that show the same quantity share the horizontal axis.
    Stacked,
    /// Beside each other.
    SideBySide,
    /// In rows of this many.
    Grid(usize),
}

/// A figure with its caption.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Name of the figure, fit for a file name without extension.
    pub name: String,
    /// Caption; also what a reader who cannot see the figure is told.
    pub caption: String,
    pub(crate) panels: Vec<Panel>,
    pub(crate) arrangement: Arrangement,
    pub(crate) letters: bool,
    width_mm: Option<f64>,
    height_mm: Option<f64>,
}

impl Figure {
    /// A figure without panels, stacked unless told otherwise.
    #[must_use]
    pub fn new(name: impl Into<String>, caption: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            caption: caption.into(),
            panels: Vec::new(),
            arrangement: Arrangement::Stacked,
            letters: true,
            width_mm: None,
            height_mm: None,
        }
    }

    /// Adds a panel.
    #[must_use]
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
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

    /// Leaves the letters (a), (b), … away that figures of several panels carry.
    #[must_use]
    pub fn without_letters(mut self) -> Self {
        self.letters = false;
        self
    }

    /// The figure as an SVG document with real text and no ids, fit for a file or for a page.
    ///
    /// # Errors
    ///
    /// When the columns of a layer differ in length, or a heat map cannot be encoded.
    pub fn to_svg(&self) -> Result<String, FigureError> {
        for layer in self.panels.iter().flat_map(|panel| &panel.layers) {
            layer.check(&self.name)?;
        }
        let legends: Vec<_> = self.panels.iter().map(legend::entries).collect();
        let frames = self.frames(&legends);
        let mut svg = Svg::default();
        for (frame, legend) in frames.iter().zip(&legends) {
            self.draw_panel(&mut svg, frame)?;
            draw_inner_text(&mut svg, frame, legend);
        }
        let (width, height) = self.size_points();
        Ok(svg.finish(width, height, &self.caption))
    }

    /// The figure as a PNG picture with `dpi` picture elements per inch.
    ///
    /// # Errors
    ///
    /// As for [`Self::to_svg`], and when the picture would be empty or far too large.
    pub fn to_png(&self, dpi: f64) -> Result<Vec<u8>, FigureError> {
        raster::png(&self.name, &self.to_svg()?, self.size_points(), dpi)
    }

    /// Places the panels; legends that would cover data get rows of their own above the axes.
    fn frames(&self, legends: &[Vec<legend::Entry>]) -> Vec<Frame<'_>> {
        let mut rows = vec![0; self.panels.len()];
        loop {
            let frames = layout::arrange(self, &rows);
            let before = rows.clone();
            for ((rows, frame), legend) in rows.iter_mut().zip(&frames).zip(legends) {
                if *rows == 0 && !legend.is_empty() && inner_text(frame, legend).1.is_none() {
                    *rows = legend::rows(legend, frame.area.w);
                }
            }
            if rows == before {
                return frames;
            }
        }
    }

    fn draw_panel(&self, svg: &mut Svg, frame: &Frame<'_>) -> Result<(), FigureError> {
        reference::draw_spans(svg, frame);
        let empty = frame.panel.is_empty();
        svg.open_clip(frame.area);
        if !empty {
            self.draw_map(svg, frame)?;
        }
        for layer in &frame.panel.layers {
            if let Layer::Band { x, low, high, role, .. } = layer {
                series::draw_band(svg, frame, (x, low, high), *role);
            }
        }
        reference::draw_references(svg, frame);
        svg.close_clip();
        for layer in &frame.panel.layers {
            match layer {
                Layer::Line { x, y, role, .. } => {
                    svg.open_clip(frame.area);
                    series::draw_line(svg, frame, (x, y), *role);
                    svg.close_clip();
                }
                Layer::Points { x, y, error, role, .. } => {
                    series::draw_points(svg, frame, (x, y), error.as_deref(), *role);
                }
                _ => {}
            }
        }
        if empty {
            axes::draw_empty(svg, frame);
        } else {
            axes::draw_colour_bar(svg, frame);
        }
        axes::draw_axes(svg, frame);
        reference::draw_span_names(svg, frame);
        Ok(())
    }

    fn draw_map(&self, svg: &mut Svg, frame: &Frame<'_>) -> Result<(), FigureError> {
        if let Some(map) = frame.panel.map() {
            let picture = heatmap::picture(map, frame.area, |x| frame.x.at(x), |y| frame.y.at(y));
            let data = picture.map_err(|reason| FigureError::Image {
                figure: self.name.clone(),
                reason,
            })?;
            svg.image(frame.area, &data);
        }
        Ok(())
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

/// Names of reference lines, and where the legend fits inside the axes without covering anything.
fn inner_text<'a>(frame: &'a Frame<'_>, legend: &[legend::Entry]) -> (Vec<reference::Name<'a>>, Option<Rect>) {
    let mut taken = Occupancy::new(frame.area);
    series::occupy(frame, &mut taken);
    let names = reference::reference_names(frame, &mut taken);
    let place = legend::free_place(legend, &taken);
    (names, place)
}

fn draw_inner_text(svg: &mut Svg, frame: &Frame<'_>, legend: &[legend::Entry]) {
    let (names, place) = inner_text(frame, legend);
    reference::draw_reference_names(svg, &names);
    if frame.legend_rows > 0 {
        let rise = frame.span_strip() + frame.legend_rows as f64 * layout::LEGEND_ROW + 1.0;
        let start = (frame.area.x, frame.area.y - rise);
        legend::draw_rows(svg, legend, start, frame.area.w);
    } else if let Some(place) = place {
        legend::draw_block(svg, legend, place);
    }
}
