//! Legends: what they list and where they cover nothing.

use super::series;
use super::svg::{Anchor, Svg, element, font, polyline};
use crate::figure::content::{Mark, Panel, Style};
use crate::figure::layout::{CAPTION, INSET, LEGEND_ROW, Occupancy, Position, Rect, width};

/// Width of the sample beside a legend text.
const SAMPLE: f64 = 18.0;
/// Distance between sample and text, and between neighbours in a row.
const SPACE: f64 = 4.0;
/// How much wider a text may be in a browser that has none of the named fonts: DejaVu Sans beside Arimo.
const OTHER_FONT: f64 = 1.17;

/// One line of a legend.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Entry {
    label: String,
    line: Option<Style>,
    /// Of points also whether they are so many that they are drawn as dots.
    points: Option<(Style, bool)>,
    band: Option<Style>,
}

impl Entry {
    /// Width of the sample and the text, in whatever font there is.
    fn room(&self) -> f64 {
        SAMPLE + SPACE + OTHER_FONT * width(&self.label, CAPTION)
    }
}

/// The entries of panels; layers with equal labels share one.
pub(crate) fn entries<'a>(panels: impl IntoIterator<Item = &'a Panel>) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for (panel, layer) in panels.into_iter().flat_map(|panel| panel.layers.iter().map(move |layer| (panel, layer))) {
        let drawn = matches!(layer.mark, Mark::Line { .. } | Mark::Points { .. } | Mark::Band { .. });
        let Some(label) = layer.label.as_ref().filter(|_| drawn && !layer.is_empty(panel.x.scale, panel.y.scale))
        else {
            continue;
        };
        let index = entries.iter().position(|e| &e.label == label).unwrap_or_else(|| {
            let label = label.clone();
            entries.push(Entry {
                label,
                ..Entry::default()
            });
            entries.len() - 1
        });
        let style = layer.role.style();
        match &layer.mark {
            Mark::Line { .. } => entries[index].line = Some(style),
            Mark::Points { x, .. } => entries[index].points = Some((style, x.len() > series::CROWD)),
            _ => entries[index].band = Some(style),
        }
    }
    entries
}

/// How many rows the entries need when set one after the other.
pub(crate) fn rows(entries: &[Entry], room: f64) -> usize {
    row_positions(entries, room).last().map_or(0, |(row, _)| row + 1)
}

fn row_positions(entries: &[Entry], room: f64) -> Vec<(usize, f64)> {
    let (mut row, mut x) = (0, 0.0);
    entries
        .iter()
        .map(|entry| {
            let needed = entry.room();
            if x > 0.0 && x + needed > room {
                row += 1;
                x = 0.0;
            }
            let here = (row, x);
            x += needed + 3.0 * SPACE;
            here
        })
        .collect()
}

/// A place for the legend inside the axes that covers nothing, corners first.
pub(crate) fn free_place(entries: &[Entry], taken: &Occupancy) -> Option<Rect> {
    let widest = entries.iter().map(Entry::room).fold(0.0, f64::max);
    let (w, h) = (widest + 4.0, entries.len() as f64 * LEGEND_ROW + 2.0);
    let area = taken.area;
    let (room_x, room_y) = (area.w - w - 2.0 * INSET, area.h - h - 2.0 * INSET);
    if room_x < 0.0 || room_y < 0.0 || w > 0.7 * area.w {
        return None;
    }
    let at = |along: f64, down: f64| Rect::new(area.x + INSET + along * room_x, area.y + INSET + down * room_y, w, h);
    let corners = [(1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let steps = || (1..20).map(|i| f64::from(i) / 20.0);
    let edges = steps()
        .map(|s| (1.0, s))
        .chain(steps().map(|s| (1.0 - s, 0.0)))
        .chain(steps().map(|s| (1.0 - s, 1.0)))
        .chain(steps().map(|s| (0.0, s)));
    let free = |place: &Rect| taken.covered(Rect::new(place.x - 3.0, place.y - 3.0, w + 6.0, h + 6.0)) == 0;
    corners.into_iter().chain(edges).map(|(along, down)| at(along, down)).find(free)
}

/// Draws the entries below each other.
pub(crate) fn draw_block(svg: &mut Svg, entries: &[Entry], place: Rect) {
    for (i, entry) in entries.iter().enumerate() {
        let middle = place.y + 1.0 + (i as f64 + 0.5) * LEGEND_ROW;
        draw_entry(svg, entry, place.x + 2.0, middle);
    }
}

/// Draws the entries in rows that start at a corner.
pub(crate) fn draw_rows(svg: &mut Svg, entries: &[Entry], (x, y): Position, room: f64) {
    for (entry, (row, offset)) in entries.iter().zip(row_positions(entries, room)) {
        draw_entry(svg, entry, x + offset, y + (row as f64 + 0.5) * LEGEND_ROW);
    }
}

/// The entries for a legend beside a drawing: text, and a sample as an SVG element.
pub(crate) fn samples(entries: &[Entry], scale: f64) -> Vec<(String, String)> {
    let sample = |entry: &Entry| {
        let mut svg = Svg::default();
        draw_sample(&mut svg, entry, 0.0, LEGEND_ROW / 2.0);
        let area = Rect::new(0.0, 0.0, SAMPLE, LEGEND_ROW);
        (entry.label.clone(), element(area, scale, None, &svg.into_body()))
    };
    entries.iter().map(sample).collect()
}

fn draw_entry(svg: &mut Svg, entry: &Entry, x: f64, middle: f64) {
    svg.open_series("entry", Some(&entry.label));
    // What a page answers to lies around the text too.
    svg.rect(
        Rect::new(x, middle - LEGEND_ROW / 2.0, entry.room(), LEGEND_ROW),
        "fill=\"#fff\" fill-opacity=\"0\"",
    );
    draw_sample(svg, entry, x, middle);
    let baseline = middle + 0.36 * CAPTION;
    svg.text(x + SAMPLE + SPACE, baseline, Anchor::Start, font(CAPTION), &entry.label);
    svg.close_group();
}

fn draw_sample(svg: &mut Svg, entry: &Entry, x: f64, middle: f64) {
    if let Some(style) = entry.band {
        svg.rect(Rect::new(x, middle - 3.5, SAMPLE, 7.0), &series::band_attributes(style));
    }
    if let Some(style) = entry.line {
        let d = polyline(&[(x, middle), (x + SAMPLE, middle)], false);
        svg.path(&d, &series::line_attributes(style));
    }
    let centre = x + SAMPLE / 2.0;
    match entry.points {
        Some((style, true)) => series::draw_dots(svg, &[-4.5, 0.0, 4.5].map(|along| (centre + along, middle)), style),
        Some((style, false)) => series::draw_markers(svg, &[(centre, middle)], style, 2.0),
        None => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_stays_in_its_panel_where_the_browser_has_a_wider_font() {
        /// Width of "latency law, n estimated" in DejaVu Sans at 10 points, as a browser sets it.
        const WIDE: f64 = 123.22;
        let entry = Entry {
            label: "latency law, n estimated".to_owned(),
            ..Entry::default()
        };
        let area = Rect::new(0.0, 0.0, 200.0, 100.0);
        let place = free_place(std::slice::from_ref(&entry), &Occupancy::new(area)).expect("there is room");
        let end = place.x + 2.0 + SAMPLE + SPACE + WIDE * CAPTION / 10.0;
        assert!(end <= area.right(), "ends at {end}");
    }
}
