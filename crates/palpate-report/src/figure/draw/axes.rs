//! Frames, ticks and what is written around them.

use std::fmt::Write as _;

use super::heatmap;
use super::svg::{Anchor, BOLD, Svg, font, short};
use crate::escape::escape;
use crate::figure::content::{Axis, Scale};
use crate::figure::layout::{
    BAR, BAR_GAP, CAPTION, Frame, LEGEND_ROW, Rect, TICK, TICK_LENGTH, Ticks, Transform, width,
};

const FRAME: &str = "stroke=\"#222\" stroke-width=\"0.7\"";

/// What a page needs to read values off a panel: place, limits and names of its axes, with the power of ten that its labels leave out.
pub(crate) fn readable(frame: &Frame<'_>) -> String {
    let Rect { x, y, w, h } = frame.area;
    let axis = |along: &str, transform: &Transform, ticks: &Ticks, axis: &Axis, labelled: bool| {
        let scale = if transform.scale == Scale::Log { "log" } else { "linear" };
        format!(
            " data-{along}=\"{scale} {:.7e} {:.7e} {} {}\" data-{along}-name=\"{}\" data-{along}-unit=\"{}\"",
            transform.low,
            transform.high,
            ticks.exponent,
            u8::from(labelled),
            escape(&axis.label),
            escape(&axis.unit)
        )
    };
    let area = [x, y, w, h].map(short).join(" ");
    let across = axis("x", &frame.x, &frame.x_ticks, &frame.panel.x, frame.names_x);
    let up = axis("y", &frame.y, &frame.y_ticks, &frame.panel.y, true);
    format!("class=\"panel\" data-area=\"{area}\"{across}{up}")
}

/// The frame, its ticks and everything written around it.
pub(crate) fn draw_axes(svg: &mut Svg, frame: &Frame<'_>) {
    svg.rect(frame.area, FRAME);
    svg.open_group("class=\"ticks\"");
    draw_ticks(svg, frame);
    draw_labels(svg, frame);
    svg.close_group();
    draw_captions(svg, frame);
    draw_heading(svg, frame);
}

fn draw_ticks(svg: &mut Svg, frame: &Frame<'_>) {
    let Frame { area, .. } = frame;
    let mut d = String::new();
    let minor = |v: &f64| (*v, TICK_LENGTH * 0.55);
    let x_minor = frame.x_ticks.minor.iter().map(minor);
    let x_major = frame.x_ticks.major.iter().map(|(v, _)| (*v, TICK_LENGTH));
    for (value, length) in x_major.chain(x_minor).filter(|(v, _)| frame.x.contains(*v)) {
        let _ = write!(d, "M{} {}v{}", short(frame.x.at(value)), short(area.bottom()), short(length));
    }
    let y_minor = frame.y_ticks.minor.iter().map(minor);
    let y_major = frame.y_ticks.major.iter().map(|(v, _)| (*v, TICK_LENGTH));
    for (value, length) in y_major.chain(y_minor).filter(|(v, _)| frame.y.contains(*v)) {
        let _ = write!(d, "M{} {}h-{}", short(area.x), short(frame.y.at(value)), short(length));
    }
    svg.path(&d, "stroke=\"#222\" stroke-width=\"0.6\"");
}

fn draw_labels(svg: &mut Svg, frame: &Frame<'_>) {
    let Frame { area, .. } = frame;
    if frame.names_x {
        let y = area.bottom() + TICK_LENGTH + 2.0 + 0.78 * TICK;
        let labels = frame.x_ticks.major.iter().filter(|(v, _)| frame.x.contains(*v));
        svg.texts(Anchor::Middle, font(TICK), labels.map(|(value, label)| (frame.x.at(*value), y, label.as_str())));
    }
    let x = area.x - TICK_LENGTH - 2.0;
    let labels = frame.y_ticks.major.iter().filter(|(v, _)| frame.y.contains(*v));
    let at = |value: f64| frame.y.at(value) + 0.36 * TICK;
    svg.texts(Anchor::End, font(TICK), labels.map(|(value, label)| (x, at(*value), label.as_str())));
}

fn draw_captions(svg: &mut Svg, frame: &Frame<'_>) {
    let Frame { area, panel, .. } = frame;
    if frame.names_x {
        let y = area.bottom() + TICK_LENGTH + 2.0 + TICK + 3.0 + CAPTION;
        let caption = panel.x.caption(frame.x_ticks.exponent);
        svg.text(area.x + area.w / 2.0, y, Anchor::Middle, font(CAPTION), &caption);
    }
    let caption = panel.y.caption(frame.y_ticks.exponent);
    svg.upward_text(frame.left + CAPTION, area.y + area.h / 2.0, font(CAPTION), &caption);
}

fn draw_heading(svg: &mut Svg, frame: &Frame<'_>) {
    let rise = 2.0 + frame.span_strip() + frame.legend_rows as f64 * LEGEND_ROW;
    let y = frame.area.y - rise - 2.5;
    // A title that is wider than its axes begins to their left.
    let written = frame.panel.title.as_ref().map_or(0.0, |title| width(title, CAPTION + 0.5));
    let letter = if frame.letter.is_some() { width("(a)", CAPTION + 0.5) + 5.0 } else { 0.0 };
    let mut x = frame.area.x.min(frame.cell.right() - letter - written - 1.0).max(frame.cell.x + 1.0);
    if let Some(letter) = frame.letter {
        let letter = format!("({letter})");
        svg.text(x, y, Anchor::Start, font(CAPTION + 0.5).with(BOLD), &letter);
        x += width(&letter, CAPTION + 0.5) + 5.0;
    }
    if let Some(title) = &frame.panel.title {
        let title = shortened(title, frame.cell.right() - x - 1.0);
        svg.text(x, y, Anchor::Start, font(CAPTION + 0.5), &title);
    }
}

/// A title that would be wider than its room, without its end.
fn shortened(title: &str, room: f64) -> String {
    let fits = |text: &str| width(text, CAPTION + 0.5) <= room;
    if fits(title) {
        return title.to_owned();
    }
    let ends = title.char_indices().map(|(end, _)| format!("{}…", &title[..end]));
    ends.take_while(|text| fits(text)).last().unwrap_or_default()
}

/// The bar that explains the colours of a map.
pub(crate) fn draw_colour_bar(svg: &mut Svg, frame: &Frame<'_>) {
    let (Some((bar, ticks)), Some((_, colours))) = (&frame.bar, frame.panel.colours()) else {
        return;
    };
    let area = Rect::new(frame.area.right() + BAR_GAP, frame.area.y, BAR, frame.area.h);
    let steps = 64;
    for i in 0..steps {
        let share = f64::from(i) / f64::from(steps - 1);
        let [r, g, b] = heatmap::colour(share);
        let h = area.h / f64::from(steps);
        let y = area.bottom() - h * f64::from(i + 1);
        let attributes = format!("fill=\"#{r:02x}{g:02x}{b:02x}\" shape-rendering=\"crispEdges\"");
        svg.rect(Rect { y, h: h + 0.2, ..area }, &attributes);
    }
    svg.rect(area, FRAME);
    let mut d = String::new();
    for (value, label) in ticks.major.iter().filter(|(v, _)| bar.contains(*v)) {
        let y = bar.at(*value);
        let _ = write!(d, "M{} {}h{}", short(area.right()), short(y), short(TICK_LENGTH));
        let x = area.right() + TICK_LENGTH + 2.0;
        svg.text(x, y + 0.36 * TICK, Anchor::Start, font(TICK), label);
    }
    svg.path(&d, "stroke=\"#222\" stroke-width=\"0.6\"");
    let caption = colours.caption(ticks.exponent);
    let x = area.right() + TICK_LENGTH + 2.0 + Frame::widest(ticks) + 3.0 + CAPTION;
    svg.upward_text(x, area.y + area.h / 2.0, font(CAPTION), &caption);
}

/// What stands in a panel without data.
pub(crate) fn draw_empty(svg: &mut Svg, frame: &Frame<'_>) {
    let Rect { x, y, w, h } = frame.area;
    let grey = font(CAPTION).in_colour("#777");
    svg.text(x + w / 2.0, y + h / 2.0 + 3.0, Anchor::Middle, grey, &frame.panel.empty_note);
}
