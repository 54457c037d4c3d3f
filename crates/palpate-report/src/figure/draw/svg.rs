//! A small writer of SVG elements.

use std::fmt::Write as _;

use crate::escape::escape;
use crate::figure::layout::{Rect, markup};

/// Where a text is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Font {
    size: f64,
    colour: &'static str,
    /// Further attributes, each behind a blank.
    more: &'static str,
}

/// What makes a text bold.
pub(crate) const BOLD: &str = " font-weight=\"bold\"";
/// What sets a text off from lines that it lies on.
pub(crate) const HALO: &str = " stroke=\"#fff\" stroke-width=\"2\" stroke-linejoin=\"round\" paint-order=\"stroke\"";

/// Plain text of that size.
pub(crate) fn font(size: f64) -> Font {
    Font {
        size,
        colour: "#222",
        more: "",
    }
}

impl Font {
    pub(crate) fn in_colour(self, colour: &'static str) -> Self {
        Self { colour, ..self }
    }

    pub(crate) fn with(self, more: &'static str) -> Self {
        Self { more, ..self }
    }

    fn attributes(self, anchor: Anchor) -> String {
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        format!("font-size=\"{}\" fill=\"{}\"{anchor}{}", short(self.size), self.colour, self.more)
    }
}

/// The inside of an SVG element under construction; lengths are points.
#[derive(Debug, Default)]
pub(crate) struct Svg {
    body: String,
}

/// An SVG document of its own: `body` on a white page.
pub(crate) fn document((width, height): (f64, f64), description: &str, body: &str) -> String {
    let mm = |points: f64| short(points * 25.4 / 72.0);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{}\" \
         width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\" \
         font-family=\"Arimo, Arial, Helvetica, 'Liberation Sans', sans-serif\" fill=\"none\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{body}</svg>\n",
        escape(description),
        mm(width),
        mm(height),
        short(width),
        short(height),
    )
}

/// An SVG element of a page that shows `area` of what `body` draws, `scale` picture elements to a point where there is room.
///
/// Without a description it is an ornament.
pub(crate) fn element(area: Rect, scale: f64, description: Option<&str>, body: &str) -> String {
    let [x, y, w, h] = [area.x, area.y, area.w, area.h].map(short);
    let [width, height] = [area.w, area.h].map(|length| (length * scale).round());
    let role = description
        .map_or("aria-hidden=\"true\"".to_owned(), |text| format!("role=\"img\" aria-label=\"{}\"", escape(text)));
    format!("<svg {role} width=\"{width}\" height=\"{height}\" viewBox=\"{x} {y} {w} {h}\">\n{body}</svg>\n")
}

/// A number with at most two decimals and nothing superfluous.
pub(crate) fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

impl Svg {
    /// What was drawn.
    pub(crate) fn into_body(self) -> String {
        self.body
    }

    /// Opens a group; `attributes` are escaped.
    pub(crate) fn open_group(&mut self, attributes: &str) {
        let _ = writeln!(self.body, "<g {attributes}>");
    }

    /// Opens a group of what a series draws: a page reads values from it, and switches it by the label.
    pub(crate) fn open_series(&mut self, kind: &str, label: Option<&str>) {
        let label = label.map(|label| format!(" data-series=\"{}\"", escape(label))).unwrap_or_default();
        self.open_group(&format!("class=\"{kind}\"{label}"));
    }

    /// Closes the group opened last.
    pub(crate) fn close_group(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// Texts of one look, held in one way.
    pub(crate) fn texts<'a>(
        &mut self,
        anchor: Anchor,
        font: Font,
        texts: impl IntoIterator<Item = (f64, f64, &'a str)>,
    ) {
        self.open_group(&font.attributes(anchor));
        for (x, y, content) in texts {
            let _ = writeln!(
                self.body,
                "<text x=\"{}\" y=\"{}\">{}</text>",
                short(x),
                short(y),
                markup(content, font.size)
            );
        }
        self.close_group();
    }

    /// Opens an area that hides what reaches beyond it.
    pub(crate) fn open_clip(&mut self, area: Rect) {
        let Rect { x, y, w, h } = area;
        let [x, y, w, h] = [x, y, w, h].map(short);
        let _ = writeln!(
            self.body,
            "<svg x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\" \
             overflow=\"hidden\">"
        );
    }

    /// Closes the area opened last.
    pub(crate) fn close_clip(&mut self) {
        self.body.push_str("</svg>\n");
    }

    pub(crate) fn rect(&mut self, area: Rect, attributes: &str) {
        let [x, y, w, h] = [area.x, area.y, area.w, area.h].map(short);
        let _ = writeln!(self.body, "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" {attributes}/>");
    }

    pub(crate) fn path(&mut self, d: &str, attributes: &str) {
        if !d.is_empty() {
            let _ = writeln!(self.body, "<path d=\"{d}\" {attributes}/>");
        }
    }

    pub(crate) fn image(&mut self, area: Rect, data: &str) {
        let [x, y, w, h] = [area.x, area.y, area.w, area.h].map(short);
        let _ = writeln!(
            self.body,
            "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" \
             preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" href=\"data:image/png;base64,{data}\"/>"
        );
    }

    pub(crate) fn text(&mut self, x: f64, y: f64, anchor: Anchor, font: Font, content: &str) {
        self.turned_text((x, y), anchor, font, content, false);
    }

    /// Text that reads upwards.
    pub(crate) fn upward_text(&mut self, x: f64, y: f64, font: Font, content: &str) {
        self.turned_text((x, y), Anchor::Middle, font, content, true);
    }

    fn turned_text(&mut self, (x, y): (f64, f64), anchor: Anchor, font: Font, content: &str, upward: bool) {
        if content.is_empty() {
            return;
        }
        let (x, y) = (short(x), short(y));
        let place = if upward {
            format!("transform=\"translate({x} {y}) rotate(-90)\"")
        } else {
            format!("x=\"{x}\" y=\"{y}\"")
        };
        let _ = writeln!(self.body, "<text {place} {}>{}</text>", font.attributes(anchor), markup(content, font.size));
    }
}

/// Path data through positions; `close` joins the ends.
pub(crate) fn polyline(positions: &[(f64, f64)], close: bool) -> String {
    let mut d = String::with_capacity(positions.len() * 12);
    for (i, (x, y)) in positions.iter().enumerate() {
        d.push(match i {
            0 => 'M',
            1 => 'L',
            _ => ' ',
        });
        let _ = write!(d, "{} {}", short(*x), short(*y));
    }
    if positions.len() == 1 {
        d.push_str("h0");
    }
    if close {
        d.push('Z');
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(1.0), "1");
        assert_eq!(short(-0.001), "0");
        assert_eq!(short(12.345), "12.35");
        assert_eq!(short(100.0), "100");
    }

    #[test]
    fn one_position_is_a_dot() {
        assert_eq!(polyline(&[(1.0, 2.5)], false), "M1 2.5h0");
        assert_eq!(polyline(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)], true), "M0 0L1 0 1 1Z");
    }
}
