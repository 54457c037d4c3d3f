//! The drawing as marks on a page.

use pdf_writer::types::{LineCapStyle, LineJoinStyle, TextRenderingMode};
use pdf_writer::{Content, Name, Str};
use resvg::tiny_skia::{Path as Outline, PathSegment, Point, Transform};
use resvg::usvg::{
    Fill, FillRule, Group, Image, ImageKind, LineCap, LineJoin, Node, Paint, PaintOrder, Path, Stroke, Text,
};

use super::font::Fonts;

/// Pixels of a picture inside the figure, red, green and blue.
pub(super) struct Pixels {
    pub(super) width: i32,
    pub(super) height: i32,
    pub(super) rgb: Vec<u8>,
}

/// The marks of a page and what they refer to by number: fonts `F0`, pictures `I0`, opacities `A0`.
pub(super) struct Page {
    pub(super) marks: Content,
    pub(super) fonts: Fonts,
    pub(super) images: Vec<Pixels>,
    /// Opacities of fill and stroke that are used together.
    pub(super) alphas: Vec<[f32; 2]>,
}

impl Page {
    /// A page whose coordinates become those of the paper by this matrix.
    pub(super) fn new(matrix: [f32; 6]) -> Self {
        let mut marks = Content::new();
        marks.transform(matrix);
        Self {
            marks,
            fonts: Fonts::default(),
            images: Vec::new(),
            alphas: Vec::new(),
        }
    }

    pub(super) fn group(&mut self, group: &Group) -> Result<(), String> {
        if group.mask().is_some() || !group.filters().is_empty() || group.opacity().get() < 1.0 {
            return Err("a group with a mask, a filter or an opacity of its own".to_owned());
        }
        self.marks.save_state();
        if let Some(clip) = group.clip_path() {
            let place = group.abs_transform().pre_concat(clip.transform());
            self.clip(clip.root(), place);
        }
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group)?,
                Node::Path(path) => self.path(path)?,
                Node::Text(text) => self.text(text)?,
                Node::Image(image) => self.image(image)?,
            }
        }
        self.marks.restore_state();
        Ok(())
    }

    /// Leaves only what lies inside the outlines of a group.
    fn clip(&mut self, group: &Group, place: Transform) {
        for node in group.children() {
            match node {
                Node::Path(path) => {
                    let outline = path.data().clone().transform(place.pre_concat(path.abs_transform()));
                    outline.iter().for_each(|outline| self.trace(outline));
                }
                Node::Group(group) => self.clip(group, place),
                Node::Text(_) | Node::Image(_) => {}
            }
        }
        self.marks.clip_nonzero().end_path();
    }

    fn path(&mut self, path: &Path) -> Result<(), String> {
        if !path.is_visible() {
            return Ok(());
        }
        self.marks.save_state().transform(matrix(path.abs_transform()));
        self.set_paint(path.fill(), path.stroke())?;
        self.trace(path.data());
        match (path.fill(), path.stroke()) {
            (Some(fill), Some(_)) if fill.rule() == FillRule::EvenOdd => self.marks.fill_even_odd_and_stroke(),
            (Some(_), Some(_)) => self.marks.fill_nonzero_and_stroke(),
            (Some(fill), None) if fill.rule() == FillRule::EvenOdd => self.marks.fill_even_odd(),
            (Some(_), None) => self.marks.fill_nonzero(),
            (None, Some(_)) => self.marks.stroke(),
            (None, None) => self.marks.end_path(),
        };
        self.marks.restore_state();
        Ok(())
    }

    fn text(&mut self, text: &Text) -> Result<(), String> {
        self.marks.save_state().transform(matrix(text.abs_transform()));
        for span in text.layouted().iter().filter(|span| span.visible) {
            let (fill, stroke) = (span.fill.as_ref(), span.stroke.as_ref());
            self.set_paint(fill, stroke)?;
            let painted = [fill.map(|_| TextRenderingMode::Fill), stroke.map(|_| TextRenderingMode::Stroke)];
            let order = if span.paint_order == PaintOrder::FillAndStroke { [0, 1] } else { [1, 0] };
            for mode in order.into_iter().filter_map(|which| painted[which]) {
                self.marks.begin_text().set_text_rendering_mode(mode);
                for glyph in &span.positioned_glyphs {
                    let (font, code) = self.fonts.code(glyph)?;
                    let upright = glyph.outline_transform();
                    // The transform is for outlines in units of the font; text of size 1 is that many of them wide.
                    let em = glyph.font_size() / upright.sx.hypot(upright.ky);
                    self.marks.set_font(Name(format!("F{font}").as_bytes()), 1.0);
                    self.marks.set_text_matrix(matrix(upright.pre_scale(em, em)));
                    self.marks.show(Str(&code.to_be_bytes()));
                }
                self.marks.end_text();
            }
        }
        self.marks.restore_state();
        Ok(())
    }

    fn image(&mut self, image: &Image) -> Result<(), String> {
        let ImageKind::PNG(bytes) = image.kind() else {
            return Err("a picture inside that is no PNG".to_owned());
        };
        self.images.push(decoded(bytes).map_err(|error| error.to_string())?);
        let (width, height) = (image.size().width(), image.size().height());
        self.marks.save_state().transform(matrix(image.abs_transform()));
        // A picture fills the unit square, whose second axis goes up.
        self.marks.transform([width, 0.0, 0.0, -height, 0.0, height]);
        self.marks.x_object(Name(format!("I{}", self.images.len() - 1).as_bytes()));
        self.marks.restore_state();
        Ok(())
    }

    /// Colours, opacities and the pen.
    fn set_paint(&mut self, fill: Option<&Fill>, stroke: Option<&Stroke>) -> Result<(), String> {
        let alpha =
            [fill.map_or(1.0, |fill| fill.opacity().get()), stroke.map_or(1.0, |stroke| stroke.opacity().get())];
        let index = self.alphas.iter().position(|known| *known == alpha).unwrap_or_else(|| {
            self.alphas.push(alpha);
            self.alphas.len() - 1
        });
        self.marks.set_parameters(Name(format!("A{index}").as_bytes()));
        if let Some(fill) = fill {
            let [red, green, blue] = colour(fill.paint())?;
            self.marks.set_fill_rgb(red, green, blue);
        }
        if let Some(stroke) = stroke {
            let [red, green, blue] = colour(stroke.paint())?;
            self.marks.set_stroke_rgb(red, green, blue);
            self.marks.set_line_width(stroke.width().get()).set_miter_limit(stroke.miterlimit().get());
            self.marks.set_line_cap(match stroke.linecap() {
                LineCap::Butt => LineCapStyle::ButtCap,
                LineCap::Round => LineCapStyle::RoundCap,
                LineCap::Square => LineCapStyle::ProjectingSquareCap,
            });
            self.marks.set_line_join(match stroke.linejoin() {
                LineJoin::Miter | LineJoin::MiterClip => LineJoinStyle::MiterJoin,
                LineJoin::Round => LineJoinStyle::RoundJoin,
                LineJoin::Bevel => LineJoinStyle::BevelJoin,
            });
            let dashes = stroke.dasharray().unwrap_or_default();
            self.marks.set_dash_pattern(dashes.iter().copied(), stroke.dashoffset());
        }
        Ok(())
    }

    fn trace(&mut self, outline: &Outline) {
        let mut at = Point::default();
        for segment in outline.segments() {
            match segment {
                PathSegment::MoveTo(to) => {
                    self.marks.move_to(to.x, to.y);
                    at = to;
                }
                PathSegment::LineTo(to) => {
                    self.marks.line_to(to.x, to.y);
                    at = to;
                }
                PathSegment::QuadTo(by, to) => {
                    // The cubic curve of the same course.
                    let towards = |end: Point| (end.x + 2.0 / 3.0 * (by.x - end.x), end.y + 2.0 / 3.0 * (by.y - end.y));
                    let ((x1, y1), (x2, y2)) = (towards(at), towards(to));
                    self.marks.cubic_to(x1, y1, x2, y2, to.x, to.y);
                    at = to;
                }
                PathSegment::CubicTo(first, second, to) => {
                    self.marks.cubic_to(first.x, first.y, second.x, second.y, to.x, to.y);
                    at = to;
                }
                PathSegment::Close => {
                    self.marks.close_path();
                }
            }
        }
    }
}

fn matrix(transform: Transform) -> [f32; 6] {
    [transform.sx, transform.ky, transform.kx, transform.sy, transform.tx, transform.ty]
}

fn colour(paint: &Paint) -> Result<[f32; 3], String> {
    match paint {
        Paint::Color(colour) => Ok([colour.red, colour.green, colour.blue].map(|part| f32::from(part) / 255.0)),
        _ => Err("a gradient or a pattern".to_owned()),
    }
}

fn decoded(bytes: &[u8]) -> Result<Pixels, png::DecodingError> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let mut rgb = vec![0; reader.output_buffer_size().unwrap_or_default()];
    let info = reader.next_frame(&mut rgb)?;
    rgb.truncate(info.buffer_size());
    let side = |length: u32| i32::try_from(length).unwrap_or(i32::MAX);
    Ok(Pixels {
        width: side(info.width),
        height: side(info.height),
        rgb,
    })
}
