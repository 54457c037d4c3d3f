//! Shaded stretches, reference lines, and their names.

use super::series;
use super::svg::{Anchor, HALO, Svg, font, polyline};
use crate::figure::content::{Mark, Role};
use crate::figure::layout::{Frame, Occupancy, Rect, TICK, width};

/// Height of a name.
const HEIGHT: f64 = TICK + 1.5;

/// Both ends of a reference line.
type Ends = [(f64, f64); 2];

/// A name with its place.
pub(crate) type Name<'a> = (Rect, &'a str);

/// Shaded stretches, below everything else.
pub(crate) fn draw_spans(svg: &mut Svg, frame: &Frame<'_>) {
    let Rect { y, .. } = frame.area;
    let bottom = frame.area.bottom();
    svg.open_series("mark", None);
    for (from, to, role, _) in spans(frame) {
        let attributes = format!("fill=\"{}\" fill-opacity=\"0.12\"", role.style().colour);
        svg.path(&polyline(&[(from, y), (to, y), (to, bottom), (from, bottom)], true), &attributes);
    }
    svg.close_group();
}

/// Names of shaded stretches above the frame; a name without room is left out.
pub(crate) fn draw_span_names(svg: &mut Svg, frame: &Frame<'_>) {
    let mut named: Vec<_> = spans(frame).filter_map(|(from, to, _, label)| Some((from, to, label?))).collect();
    // Wide stretches have the first claim to their name.
    named.sort_by(|a, b| (b.1 - b.0).total_cmp(&(a.1 - a.0)));
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for (from, to, label) in named {
        let half = width(label, TICK) / 2.0;
        let leftmost = frame.area.x + half;
        let rightmost = leftmost.max(frame.area.right() - half);
        let place = [0.0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9].into_iter().find_map(|shift| {
            let middle = (f64::midpoint(from, to) + shift * half).clamp(leftmost, rightmost);
            let (left, right) = (middle - half - 1.5, middle + half + 1.5);
            let free = taken.iter().all(|(l, r)| right <= *l || left >= *r);
            free.then_some((middle, left, right))
        });
        if let Some((middle, left, right)) = place {
            taken.push((left, right));
            svg.text(middle, frame.area.y - 3.0, Anchor::Middle, font(TICK).in_colour("#555"), label);
        }
    }
}

/// Borders on the page, role and name of the stretches that reach into the panel.
fn spans<'a>(frame: &'a Frame<'_>) -> impl Iterator<Item = (f64, f64, Role, Option<&'a str>)> {
    frame.panel.layers.iter().filter_map(|layer| {
        let Mark::Span(from, to) = layer.mark else { return None };
        let (a, b) = (frame.x.at(from.min(to)), frame.x.at(from.max(to)));
        let (a, b) = (a.max(frame.area.x), b.min(frame.area.right()));
        (a < b).then_some((a, b, layer.role, layer.label.as_deref()))
    })
}

/// Levels and positions across the panel.
pub(crate) fn draw_references(svg: &mut Svg, frame: &Frame<'_>) {
    svg.open_series("mark", None);
    for (ends, role, _) in references(frame) {
        svg.path(&polyline(&ends, false), &series::line_attributes(role.style()));
    }
    svg.close_group();
}

/// Ends, role and name of the reference lines within the axes.
fn references<'a>(frame: &'a Frame<'_>) -> impl Iterator<Item = (Ends, Role, Option<&'a str>)> {
    let area = frame.area;
    frame.panel.layers.iter().filter_map(move |layer| {
        let ends = match layer.mark {
            Mark::Horizontal(at) if frame.y.contains(at) => {
                let y = frame.y.at(at);
                [(area.x, y), (area.right(), y)]
            }
            Mark::Vertical(at) if frame.x.contains(at) => {
                let x = frame.x.at(at);
                [(x, area.y), (x, area.bottom())]
            }
            _ => return None,
        };
        Some((ends, layer.role, layer.label.as_deref()))
    })
}

/// Names beside their reference lines, at the end and on the side that cover least.
pub(crate) fn reference_names<'a>(frame: &'a Frame<'_>, taken: &mut Occupancy) -> Vec<Name<'a>> {
    for (ends, ..) in references(frame) {
        taken.mark_line(&ends);
    }
    let mut names = Vec::new();
    for (ends, _, label) in references(frame) {
        let Some(label) = label else { continue };
        let places = places(frame.area, ends, width(label, TICK));
        let covered = |place: &Rect| taken.covered(*place);
        let Some(place) = places.into_iter().min_by_key(covered) else {
            continue;
        };
        taken.mark_rect(place);
        names.push((place, label));
    }
    names
}

/// Places for a name of width `w` along a reference line, the usual ones first.
fn places(area: Rect, [start, end]: Ends, w: f64) -> Vec<Rect> {
    let horizontal = start.1 == end.1;
    let (near, far) = if horizontal {
        ([start.1 - HEIGHT - 0.8, start.1 + 1.6], [1.0, 0.0, 0.75, 0.5, 0.25])
    } else {
        ([start.0 + 3.0, start.0 - w - 3.0], [0.0, 1.0, 0.25, 0.5, 0.75])
    };
    let mut places = Vec::new();
    for along in far {
        for beside in near {
            let (x, y) = if horizontal {
                (area.x + 3.0 + along * (area.w - w - 6.0), beside)
            } else {
                (beside, area.y + 2.0 + along * (area.h - HEIGHT - 4.0))
            };
            let inside = x >= area.x && x + w <= area.right() && y >= area.y;
            if inside && y + HEIGHT <= area.bottom() {
                places.push(Rect::new(x, y, w, HEIGHT));
            }
        }
    }
    places
}

/// Draws the names of reference lines.
pub(crate) fn draw_reference_names(svg: &mut Svg, names: &[Name<'_>]) {
    for (place, label) in names {
        let font = font(TICK).in_colour("#555").with(HALO);
        svg.text(place.x, place.bottom() - 1.5, Anchor::Start, font, label);
    }
}
