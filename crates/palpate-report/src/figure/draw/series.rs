//! Lines, points and bands on the page.

use std::fmt::Write as _;

use super::decimate;
use super::svg::{Svg, polyline, short};
use crate::figure::content::{Mark, Marker, Role, Style};
use crate::figure::layout::{Frame, Occupancy, Position};

/// Beyond this many points, simple dots replace the marker shapes.
pub(crate) const CROWD: usize = 250;

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
    error: Option<&[f64]>,
    role: Role,
) {
    let style = role.style();
    if let Some(error) = error.filter(|_| x.len() <= CROWD) {
        draw_error_bars(svg, frame, (x, y, error), style);
    }
    let positions = visible(frame, x, y);
    if positions.len() > CROWD {
        draw_dots(svg, &positions, style);
    } else {
        let radius = if positions.len() > 80 { 1.6 } else { 2.0 };
        draw_markers(svg, &positions, style, radius);
    }
}

/// Draws a crowd of points.
pub(crate) fn draw_dots(svg: &mut Svg, positions: &[Position], style: Style) {
    let mut d = String::new();
    for (x, y) in positions {
        let _ = write!(d, "M{} {}h0", short(*x), short(*y));
    }
    let attributes = format!("stroke=\"{}\" stroke-width=\"1.7\" stroke-linecap=\"round\"", style.colour);
    svg.path(&d, &attributes);
}

fn draw_error_bars(svg: &mut Svg, frame: &Frame<'_>, (x, y, error): (&[f64], &[f64], &[f64]), style: Style) {
    let mut d = String::new();
    for ((x, y), error) in x.iter().zip(y).zip(error) {
        let px = frame.x.at(*x);
        let low = (y - error).max(frame.y.low);
        let (bottom, top) = (frame.y.at(low), frame.y.at(y + error));
        if !(frame.x.contains(*x) && bottom.is_finite() && top.is_finite()) {
            continue;
        }
        let _ = write!(
            d,
            "M{x} {b}V{t}M{l} {b}h3M{l} {t}h3",
            x = short(px),
            l = short(px - 1.5),
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
        format!("fill=\"{colour}\" stroke=\"#fff\" stroke-width=\"0.3\"")
    } else {
        format!("fill=\"#fff\" stroke=\"{colour}\" stroke-width=\"0.8\"")
    };
    svg.path(&d, &attributes);
}

fn marker(d: &mut String, shape: Marker, (x, y): Position, r: f64) {
    let _ = match shape {
        Marker::Circle => write!(
            d,
            "M{} {y}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0Z",
            short(x - r),
            short(2.0 * r),
            short(-2.0 * r),
            y = short(y),
            r = short(r)
        ),
        Marker::Square => {
            let s = 0.9 * r;
            let (left, top, side) = (short(x - s), short(y - s), short(2.0 * s));
            write!(d, "M{left} {top}h{side}v{side}h-{side}Z")
        }
        Marker::Triangle | Marker::TriangleDown => {
            let up = if shape == Marker::Triangle { 1.2 * r } else { -1.2 * r };
            let (apex, base, half) = (short(y - up), short(1.8 * up), 1.15 * r);
            write!(d, "M{} {apex}l{} {base}h-{}Z", short(x), short(half), short(2.0 * half))
        }
        Marker::Diamond => {
            let s = short(1.35 * r);
            write!(d, "M{} {}l{s} {s}l-{s} {s}l-{s} -{s}Z", short(x), short(y - 1.35 * r))
        }
        Marker::Cross => {
            let (s, side) = (0.95 * r, short(1.9 * r));
            let (left, top, bottom) = (short(x - s), short(y - s), short(y + s));
            write!(d, "M{left} {top}l{side} {side}M{left} {bottom}l{side} -{side}")
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
            Mark::Points { x, y, .. } => {
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
