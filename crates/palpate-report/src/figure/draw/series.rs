//! Lines, points and bands on the page.

use std::fmt::Write as _;

use super::svg::{Svg, polyline, short};
use super::{decimate, heatmap};
use crate::figure::content::{Axis, Mark, Marker, Role, Style};
use crate::figure::layout::{Frame, Occupancy, Position, colour_limits};

/// Beyond this many points, simple dots replace the marker shapes.
pub(crate) const CROWD: usize = 60;

pub(crate) fn line_attributes(style: Style) -> String {
    let dash = if style.dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", style.dash) };
    format!(
        "stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{dash}",
        style.colour,
        short(style.width)
    )
}

pub(crate) fn band_attributes(style: Style) -> String {
    format!("fill=\"{}\" fill-opacity=\"0.22\"", style.colour)
}

/// Draws the lines of a panel and notes where they run.
pub(crate) fn draw_line(svg: &mut Svg, frame: &Frame<'_>, line: (&[f64], &[f64]), role: Role) {
    let d: String = line_pieces(frame, line).iter().map(|piece| polyline(piece, false)).collect();
    let mut attributes = line_attributes(role.style());
    if d.contains("h0") {
        attributes.push_str(" stroke-linecap=\"round\"");
    }
    svg.path(&d, &attributes);
}

fn line_pieces(frame: &Frame<'_>, (x, y): (&[f64], &[f64])) -> Vec<Vec<Position>> {
    decimate::line(x.len(), frame.area.w, |i| (frame.x.at(x[i]), frame.y.at(y[i])))
}

pub(crate) fn draw_band(svg: &mut Svg, frame: &Frame<'_>, (x, low, high): (&[f64], &[f64], &[f64]), role: Role) {
    let pieces = decimate::band(x.len(), |i| {
        // On a logarithmic axis a band that reaches zero goes down to the frame.
        let floor = if low[i] <= 0.0 { low[i].max(frame.y.low) } else { low[i] };
        (frame.x.at(x[i]), frame.y.at(floor), frame.y.at(high[i]))
    });
    let outline = |piece: &Vec<(f64, f64, f64)>| {
        let low = piece.iter().map(|(x, low, _)| (*x, *low));
        let high = piece.iter().rev().map(|(x, _, high)| (*x, *high));
        polyline(&low.chain(high).collect::<Vec<Position>>(), true)
    };
    let d: String = pieces.iter().map(outline).collect();
    svg.path(&d, &band_attributes(role.style()));
}

/// Page positions of the points that lie within the axes.
fn visible(frame: &Frame<'_>, x: &[f64], y: &[f64]) -> Vec<Position> {
    let inside = x.iter().zip(y).filter(|(x, y)| frame.x.contains(**x) && frame.y.contains(**y));
    decimate::points(inside.map(|(x, y)| (frame.x.at(*x), frame.y.at(*y))).collect())
}

/// Draws points, with error bars where half-lengths are given.
pub(crate) fn draw_points(
    svg: &mut Svg,
    frame: &Frame<'_>,
    (x, y): (&[f64], &[f64]),
    error: Option<(&[f64], &[f64])>,
    role: Role,
) {
    let style = role.style();
    if let Some((low, high)) = error.filter(|_| x.len() <= CROWD) {
        draw_error_bars(svg, frame, (x, low, high), style);
    }
    let positions = visible(frame, x, y);
    if positions.len() > CROWD {
        draw_dots(svg, &positions, style);
    } else {
        draw_markers(svg, &positions, style, 2.0);
    }
}

/// Draws points with their values as colours, as large as they can be beside each other.
pub(crate) fn draw_spots(
    svg: &mut Svg,
    frame: &Frame<'_>,
    (x, y): (&[f64], &[f64]),
    (values, colours): (&[f64], &Axis),
) {
    let (low, high) = colour_limits(values, colours);
    let room = (frame.area.w * frame.area.h / x.len().max(1) as f64).sqrt();
    let radius = (0.3 * room).clamp(1.0, 5.0);
    for ((x, y), value) in x.iter().zip(y).zip(values) {
        if !(value.is_finite() && frame.x.contains(*x) && frame.y.contains(*y)) {
            continue;
        }
        let [r, g, b] = heatmap::colour((value - low) / (high - low));
        let mut d = String::new();
        marker(&mut d, Marker::Circle, (frame.x.at(*x), frame.y.at(*y)), radius);
        svg.path(&d, &format!("fill=\"#{r:02x}{g:02x}{b:02x}\""));
    }
}

/// Draws a crowd of points: in tenths of a point, each from the one before it, which takes half the characters of positions.
pub(crate) fn draw_dots(svg: &mut Svg, positions: &[Position], style: Style) {
    let mut d = String::new();
    let mut last = (0, 0);
    for (x, y) in positions {
        let here = ((10.0 * x).round() as i64, (10.0 * y).round() as i64);
        let _ = write!(d, "m{} {}h0", here.0 - last.0, here.1 - last.1);
        last = here;
    }
    let size = if positions.len() > 4 * CROWD { 12 } else { 16 };
    let attributes = format!(
        "transform=\"scale(.1)\" stroke=\"{}\" stroke-width=\"{size}\" stroke-linecap=\"round\"",
        style.colour
    );
    svg.path(&d, &attributes);
}

fn draw_error_bars(svg: &mut Svg, frame: &Frame<'_>, (x, low, high): (&[f64], &[f64], &[f64]), style: Style) {
    let mut d = String::new();
    for ((x, low), high) in x.iter().zip(low).zip(high) {
        let px = frame.x.at(*x);
        let (bottom, top) = (frame.y.at(low.max(frame.y.low)), frame.y.at(*high));
        if !(frame.x.contains(*x) && bottom.is_finite() && top.is_finite()) {
            continue;
        }
        let _ = write!(
            d,
            "M{x} {b}V{t}M{x} {b}m-1.5 0h3M{x} {t}m-1.5 0h3",
            x = short(px),
            b = short(bottom.min(frame.area.bottom())),
            t = short(top.max(frame.area.y))
        );
    }
    svg.path(&d, &format!("stroke=\"{}\" stroke-width=\"0.7\"", style.colour));
}

pub(crate) fn draw_markers(svg: &mut Svg, positions: &[Position], style: Style, radius: f64) {
    let mut d = String::new();
    for position in positions {
        marker(&mut d, style.marker, *position, radius);
    }
    let colour = style.colour;
    let attributes = if style.marker == Marker::Cross {
        format!("stroke=\"{colour}\" stroke-width=\"1\"")
    } else if style.filled {
        format!("fill=\"{colour}\"")
    } else {
        format!("stroke=\"{colour}\" stroke-width=\"0.8\"")
    };
    svg.path(&d, &attributes);
}

/// A marker drawn from its centre, where its path begins.
fn marker(d: &mut String, shape: Marker, (x, y): Position, r: f64) {
    let _ = write!(d, "M{} {}", short(x), short(y));
    let _ = match shape {
        Marker::Circle => {
            let (r, across) = (short(r), short(2.0 * r));
            write!(d, "m-{r} 0a{r} {r} 0 1 0 {across} 0a{r} {r} 0 1 0 -{across} 0Z")
        }
        Marker::Square => {
            let (half, side) = (short(0.9 * r), short(1.8 * r));
            write!(d, "m-{half} -{half}h{side}v{side}h-{side}Z")
        }
        Marker::Triangle | Marker::TriangleDown => {
            let up = if shape == Marker::Triangle { 1.2 * r } else { -1.2 * r };
            let half = 1.15 * r;
            write!(d, "m0 {}l{} {}h-{}Z", short(-up), short(half), short(1.8 * up), short(2.0 * half))
        }
        Marker::Diamond => {
            let s = short(1.35 * r);
            write!(d, "m0 -{s}l{s} {s}l-{s} {s}l-{s} -{s}Z")
        }
        Marker::Cross => {
            let (half, side) = (short(0.95 * r), short(1.9 * r));
            write!(d, "m-{half} -{half}l{side} {side}m-{side} 0l{side} -{side}")
        }
    };
}

/// Notes where the data of a panel lie, so that text can keep away.
pub(crate) fn occupy(frame: &Frame<'_>, taken: &mut Occupancy) {
    for layer in &frame.panel.layers {
        match &layer.mark {
            Mark::Line { x, y } => {
                for piece in line_pieces(frame, (x, y)) {
                    taken.mark_line(&piece);
                }
            }
            Mark::Points { x, y, .. } | Mark::Spots { x, y, .. } => {
                for (x, y) in visible(frame, x, y) {
                    taken.mark_line(&[(x - 2.0, y), (x + 2.0, y)]);
                    taken.mark_line(&[(x, y - 2.0), (x, y + 2.0)]);
                }
            }
            Mark::Band { x, low, high } => {
                let at = |i: usize| (frame.x.at(x[i]), frame.y.at(low[i]), frame.y.at(high[i]));
                for (x, low, high) in decimate::band(x.len(), at).into_iter().flatten() {
                    taken.mark_line(&[(x, low), (x, high)]);
                }
            }
            Mark::Map(_) => taken.mark_rect(frame.area),
            Mark::Span(..) | Mark::Horizontal(_) | Mark::Vertical(_) => {}
        }
    }
}
