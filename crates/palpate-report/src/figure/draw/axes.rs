//! Frames, ticks and what is written around them.

use std::fmt::Write as _;

use super::heatmap;
use super::svg::{Anchor, BOLD, Svg, font, short};
use crate::figure::layout::{BAR, BAR_GAP, CAPTION, Frame, LEGEND_ROW, Rect, TICK, TICK_LENGTH, width};

const FRAME: &str = "stroke=\"#222\" stroke-width=\"0.7\"";

/// The frame, its ticks and everything written around it.
pub(crate) fn draw_axes(svg: &mut Svg, frame: &Frame<'_>) {
    svg.rect(frame.area, FRAME);
    draw_ticks(svg, frame);
    draw_labels(svg, frame);
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
        for (value, label) in frame.x_ticks.major.iter().filter(|(v, _)| frame.x.contains(*v)) {
            svg.text(frame.x.at(*value), y, Anchor::Middle, font(TICK), label);
        }
    }
    let x = area.x - TICK_LENGTH - 2.0;
    for (value, label) in frame.y_ticks.major.iter().filter(|(v, _)| frame.y.contains(*v)) {
        svg.text(x, frame.y.at(*value) + 0.36 * TICK, Anchor::End, font(TICK), label);
    }
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
    let mut x = frame.area.x;
    if let Some(letter) = frame.letter {
        let letter = format!("({letter})");
        svg.text(x, y, Anchor::Start, font(CAPTION + 0.5).with(BOLD), &letter);
        x += width(&letter, CAPTION + 0.5) + 5.0;
    }
    if let Some(title) = &frame.panel.title {
        svg.text(x, y, Anchor::Start, font(CAPTION + 0.5), title);
    }
}

/// The bar that explains the colours of a map.
pub(crate) fn draw_colour_bar(svg: &mut Svg, frame: &Frame<'_>) {
    let (Some((bar, ticks)), Some(map)) = (&frame.bar, frame.panel.map()) else {
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
    let caption = map.colours.caption(ticks.exponent);
    let x = area.right() + TICK_LENGTH + 2.0 + Frame::widest(ticks) + 3.0 + CAPTION;
    svg.upward_text(x, area.y + area.h / 2.0, font(CAPTION), &caption);
}

/// What stands in a panel without data.
pub(crate) fn draw_empty(svg: &mut Svg, frame: &Frame<'_>) {
    let Rect { x, y, w, h } = frame.area;
    let grey = font(CAPTION).in_colour("#777");
    svg.text(x + w / 2.0, y + h / 2.0 + 3.0, Anchor::Middle, grey, &frame.panel.empty_note);
}
