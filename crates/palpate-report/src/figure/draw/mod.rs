//! Marks on the page: a figure in, SVG, PNG or PDF out.
//!
//! | file | what |
//! |---|---|
//! | `svg.rs` | a small writer of SVG elements |
//! | `axes.rs` | frames, ticks, captions, colour bars |
//! | `series.rs`, `decimate.rs` | lines, points and bands; long ones reduced to what a page shows |
//! | `heatmap.rs` | heat maps as embedded pictures |
//! | `reference.rs` | reference lines and shaded stretches with their names |
//! | `legend.rs` | legends, and where they cover nothing |
//! | `drawn.rs` | a figure once drawn: a document, or what a page shows |
//! | `tree.rs` | a drawn figure as renderers understand it |
//! | `raster.rs`, `pdf/` | SVG to PNG, and to PDF |

mod axes;
mod decimate;
mod drawn;
mod heatmap;
mod legend;
#[cfg(feature = "png")]
mod pdf;
#[cfg(feature = "png")]
mod raster;
mod reference;
mod series;
mod svg;
#[cfg(feature = "png")]
mod tree;

pub(crate) use drawn::Drawn;
use drawn::NARROW_MM;
pub use drawn::View;
use palpate::watch::{Cancelled, Progress, Unwatched, Watch};
use svg::Svg;

use super::content::{Figure, FigureError, Mark, PictureFormat};
use super::layout::{Frame, INSET, LEGEND_ROW, Occupancy, Rect, arrange};

#[cfg(not(feature = "png"))]
const NOT_IN_THIS_BUILD: &str =
    "this build draws SVG; build palpate with its feature `png`, or name the figure FILE.svg";

impl Figure {
    /// The figure as an SVG document with real text and no ids, fit for a file or for a page.
    ///
    /// # Errors
    ///
    /// When the columns of a layer differ in length, or a heat map cannot be encoded.
    pub fn to_svg(&self) -> Result<String, FigureError> {
        self.to_svg_watched(&mut Unwatched)
    }

    /// [`Self::to_svg`] with a watch, which hears of every layer: one of millions of samples takes a tenth of a second.
    ///
    /// # Errors
    ///
    /// As for [`Self::to_svg`], and [`FigureError::Cancelled`].
    pub fn to_svg_watched(&self, watch: &mut dyn Watch) -> Result<String, FigureError> {
        Ok(self.drawing(watch)?.svg)
    }

    /// The figure once drawn, as a document and for a page.
    ///
    /// # Errors
    ///
    /// As for [`Self::to_svg_watched`].
    pub(crate) fn drawing(&self, watch: &mut dyn Watch) -> Result<Drawn, FigureError> {
        for layer in self.panels.iter().flat_map(|panel| &panel.layers) {
            layer.check(&self.name)?;
        }
        look(watch)?;
        let figure = self.in_suited_units();
        let mut drawn = figure.drawn(watch)?;
        if figure.is_wide() {
            drawn.view.narrow = figure.width_mm(NARROW_MM).drawn(watch)?.view.panels.pop();
        }
        Ok(drawn)
    }

    fn drawn(&self, watch: &mut dyn Watch) -> Result<Drawn, FigureError> {
        let common = if self.has_common_legend { legend::entries(&self.panels) } else { Vec::new() };
        let own = |panel| if self.has_common_legend { Vec::new() } else { legend::entries([panel]) };
        let legends: Vec<_> = self.panels.iter().map(own).collect();
        let (width, height) = self.size_points();
        let strip = legend::rows(&common, width - 2.0 * INSET) as f64 * LEGEND_ROW;
        let frames = self.frames(strip, &legends, watch)?;
        let mut panels = Vec::with_capacity(frames.len());
        for (frame, legend) in frames.iter().zip(&legends) {
            let mut svg = Svg::default();
            svg.open_group(&axes::readable(frame));
            self.draw_panel(&mut svg, frame, watch)?;
            draw_inner_text(&mut svg, frame, legend);
            svg.close_group();
            panels.push((frame.cell, svg.into_body()));
        }
        let mut svg = Svg::default();
        legend::draw_rows(&mut svg, &common, (INSET, INSET), width - 2.0 * INSET);
        Ok(Drawn::new(self, (width, height + strip), (&svg.into_body(), &common), &panels))
    }

    /// The figure as a PNG picture with `dpi` picture elements per inch.
    ///
    /// # Errors
    ///
    /// As for [`Self::to_svg`], and when the picture would be empty or far too large, or without the feature `png`.
    pub fn to_png(&self, dpi: f64) -> Result<Vec<u8>, FigureError> {
        self.to_png_of(&self.to_svg()?, dpi)
    }

    /// The bytes of a file with the figure.
    ///
    /// # Errors
    ///
    /// As for [`Self::to_svg`]; of a PNG also when the picture would be far too large; of PNG and PDF without the feature `png`.
    pub fn to_file(&self, format: PictureFormat) -> Result<Vec<u8>, FigureError> {
        self.to_file_of(self.to_svg()?, format)
    }

    /// [`Self::to_file`] of the figure once drawn.
    pub(crate) fn to_file_of(&self, svg: String, format: PictureFormat) -> Result<Vec<u8>, FigureError> {
        /// Print quality at the width of a journal's page.
        const DPI: f64 = 300.0;
        match format {
            PictureFormat::Svg => Ok(svg.into_bytes()),
            PictureFormat::Png => self.to_png_of(&svg, DPI),
            PictureFormat::Pdf => self.to_pdf_of(&svg),
        }
    }

    #[cfg(feature = "png")]
    fn to_png_of(&self, svg: &str, dpi: f64) -> Result<Vec<u8>, FigureError> {
        raster::png(&self.name, svg, dpi)
    }

    #[cfg(feature = "png")]
    fn to_pdf_of(&self, svg: &str) -> Result<Vec<u8>, FigureError> {
        pdf::pdf(&self.name, svg)
    }

    #[cfg(not(feature = "png"))]
    fn to_png_of(&self, _svg: &str, _dpi: f64) -> Result<Vec<u8>, FigureError> {
        Err(FigureError::Raster {
            figure: self.name.clone(),
            reason: NOT_IN_THIS_BUILD.to_owned(),
        })
    }

    #[cfg(not(feature = "png"))]
    fn to_pdf_of(&self, _svg: &str) -> Result<Vec<u8>, FigureError> {
        Err(FigureError::Pdf {
            figure: self.name.clone(),
            reason: NOT_IN_THIS_BUILD.to_owned(),
        })
    }

    /// Places the panels; legends that would cover data get rows of their own above the axes.
    fn frames(
        &self,
        strip: f64,
        legends: &[Vec<legend::Entry>],
        watch: &mut dyn Watch,
    ) -> Result<Vec<Frame<'_>>, Cancelled> {
        let mut rows = vec![0; self.panels.len()];
        loop {
            let frames = arrange(self, strip, &rows);
            let before = rows.clone();
            for ((rows, frame), legend) in rows.iter_mut().zip(&frames).zip(legends) {
                look(watch)?;
                if *rows == 0 && !legend.is_empty() && inner_text(frame, legend).1.is_none() {
                    *rows = legend::rows(legend, frame.area.w);
                }
            }
            if rows == before {
                return Ok(frames);
            }
        }
    }

    fn draw_panel(&self, svg: &mut Svg, frame: &Frame<'_>, watch: &mut dyn Watch) -> Result<(), FigureError> {
        reference::draw_spans(svg, frame);
        let empty = frame.panel.is_empty();
        svg.open_clip(frame.area);
        if let Some(map) = frame.panel.map().filter(|_| !empty) {
            let data = heatmap::picture(map, frame).map_err(|reason| FigureError::Image {
                figure: self.name.clone(),
                reason,
            })?;
            svg.image(frame.area, &data);
        }
        let drawn = || {
            let (x, y) = (frame.panel.x.scale, frame.panel.y.scale);
            frame.panel.layers.iter().filter(move |layer| !layer.is_empty(x, y))
        };
        for layer in drawn() {
            if let Mark::Band { x, low, high } = &layer.mark {
                svg.open_series("band", layer.label.as_deref());
                series::draw_band(svg, frame, (x, low, high), layer.role);
                svg.close_group();
            }
        }
        reference::draw_references(svg, frame);
        svg.close_clip();
        for layer in drawn() {
            look(watch)?;
            match &layer.mark {
                Mark::Line { x, y } => {
                    svg.open_clip(frame.area);
                    svg.open_series("line", layer.label.as_deref());
                    series::draw_line(svg, frame, (x, y), layer.role);
                    svg.close_group();
                    svg.close_clip();
                }
                Mark::Points { x, y, error } => {
                    svg.open_series("points", layer.label.as_deref());
                    let ends = error.as_ref().map(|(low, high)| (low.as_slice(), high.as_slice()));
                    series::draw_points(svg, frame, (x, y), ends, layer.role);
                    svg.close_group();
                }
                Mark::Spots { x, y, values, colours } => series::draw_spots(svg, frame, (x, y), (values, colours)),
                _ => {}
            }
        }
        if empty {
            axes::draw_empty(svg, frame);
        } else {
            axes::draw_colour_bar(svg, frame);
        }
        axes::draw_axes(svg, frame);
        svg.open_group("class=\"names\"");
        reference::draw_span_names(svg, frame);
        svg.close_group();
        Ok(())
    }
}

fn look(watch: &mut dyn Watch) -> Result<(), Cancelled> {
    watch.report(Progress::open("drawing figures", 0))
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
    svg.open_group("class=\"names\"");
    reference::draw_reference_names(svg, &names);
    svg.close_group();
    if frame.legend_rows > 0 {
        let rise = frame.span_strip() + frame.legend_rows as f64 * LEGEND_ROW + 1.0;
        let start = (frame.area.x, frame.area.y - rise);
        legend::draw_rows(svg, legend, start, frame.area.w);
    } else if let Some(place) = place {
        legend::draw_block(svg, legend, place);
    }
}
