//! Where panels, axes and their captions lie.

use super::rect::Rect;
use super::scale::{Direction, Transform, colour_limits, limits};
use super::text::width;
use super::ticks::Ticks;
use crate::figure::content::{Arrangement, Figure, Layer, Mark, Panel, Scale};

/// Font size of captions, panel titles and legends.
pub(crate) const CAPTION: f64 = 8.0;
/// Font size of tick labels.
pub(crate) const TICK: f64 = 7.0;
/// Length of a major tick.
pub(crate) const TICK_LENGTH: f64 = 3.0;
/// Width of a colour bar.
pub(crate) const BAR: f64 = 8.0;
/// Distance of a colour bar from its map.
pub(crate) const BAR_GAP: f64 = 7.0;
/// Height of one legend row.
pub(crate) const LEGEND_ROW: f64 = 10.5;
/// Distance of a legend from the axes, and of one above all panels from the border.
pub(crate) const INSET: f64 = 4.0;
/// Height of the strip that names shaded stretches.
pub(crate) const SPAN_STRIP: f64 = 9.5;
/// Height of the line with the panel letter and title.
pub(crate) const TITLE_STRIP: f64 = 13.0;

/// Distance of panels from each other and from the border.
const GAP: f64 = 5.0;

/// A panel with its place and its axes.
#[derive(Debug)]
pub(crate) struct Frame<'a> {
    pub(crate) panel: &'a Panel,
    pub(crate) area: Rect,
    pub(crate) x: Transform,
    pub(crate) y: Transform,
    pub(crate) x_ticks: Ticks,
    pub(crate) y_ticks: Ticks,
    /// Ticks of the colour bar.
    pub(crate) bar: Option<(Transform, Ticks)>,
    /// Whether the horizontal axis is written below this panel.
    pub(crate) names_x: bool,
    pub(crate) letter: Option<char>,
    /// Legend rows above the panel.
    pub(crate) legend_rows: usize,
    /// Left border of the room that belongs to this panel.
    pub(crate) left: f64,
    /// The room that belongs to this panel, with everything written around its axes.
    pub(crate) cell: Rect,
}

#[derive(Debug, Clone, Copy, Default)]
struct Margins {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// Places all panels below a strip of this height; `legend_rows` tells how many legend rows stand above each.
pub(crate) fn arrange<'a>(figure: &'a Figure, strip: f64, legend_rows: &[usize]) -> Vec<Frame<'a>> {
    let columns = figure.columns();
    let rows = figure.panels.len().div_ceil(columns);
    let shared = figure.shares_x();
    let last_row = |i: usize| i + columns >= figure.panels.len();
    let (page_w, page_h) = figure.size_points();
    let all: Vec<&Panel> = figure.panels.iter().collect();
    let mut frames: Vec<Frame<'a>> = figure
        .panels
        .iter()
        .enumerate()
        .map(|(i, panel)| {
            let group = if shared { all.clone() } else { vec![panel] };
            let axis = group.iter().map(|p| &p.x).find(|axis| axis.range.is_some());
            let x_limits = limits(axis.unwrap_or(&panel.x), &group, Direction::Horizontal);
            let y_limits = limits(&panel.y, &[panel], Direction::Vertical);
            Frame {
                panel,
                area: Rect::default(),
                x: Transform::new(panel.x.scale, x_limits, 0.0, 1.0),
                y: Transform::new(panel.y.scale, y_limits, 1.0, 0.0),
                x_ticks: Ticks::default(),
                y_ticks: Ticks::default(),
                bar: None,
                names_x: !shared || last_row(i),
                letter: figure.letter(i),
                legend_rows: legend_rows.get(i).copied().unwrap_or(0),
                left: 0.0,
                cell: Rect::default(),
            }
        })
        .collect();
    let (w, h) = (page_w / columns as f64 - 60.0, page_h / rows.max(1) as f64 - 40.0);
    for frame in &mut frames {
        frame.settle(Rect::new(0.0, 0.0, w.max(20.0), h.max(20.0)));
    }
    // Tick labels decide the margins, and margins the ticks: twice is enough to agree.
    for _ in 0..2 {
        let margins: Vec<Margins> = frames.iter().map(Frame::margins).collect();
        place(&mut frames, &margins, columns, (page_w, page_h), strip);
    }
    frames
}

fn place(frames: &mut [Frame<'_>], margins: &[Margins], columns: usize, page: (f64, f64), strip: f64) {
    let rows = frames.len().div_ceil(columns);
    let most = |pick: fn(&Margins) -> f64, keep: &dyn Fn(usize) -> bool| {
        let kept = margins.iter().enumerate().filter(|(i, _)| keep(*i));
        kept.map(|(_, m)| pick(m)).fold(0.0, f64::max)
    };
    // Alike in all columns, so that panels have one size wherever they stand.
    let (left, right) = (most(|m| m.left, &|_| true), most(|m| m.right, &|_| true));
    let heights: Vec<(f64, f64, f64)> = (0..rows)
        .map(|r| {
            let here = |i: usize| i / columns == r;
            let members = &frames[r * columns..frames.len().min((r + 1) * columns)];
            let share = members.iter().map(|f| f.panel.share).fold(0.0, f64::max);
            (most(|m| m.top, &here), most(|m| m.bottom, &here), share)
        })
        .collect();
    let w = ((page.0 - GAP * (columns + 1) as f64) / columns as f64 - left - right).max(10.0);
    let used: f64 = heights.iter().map(|(t, b, _)| t + b).sum();
    let shares: f64 = heights.iter().map(|h| h.2).sum();
    let room = page.1 - used - GAP * (rows + 1) as f64;
    let mut y = GAP + strip;
    for (r, (top, bottom, share)) in heights.iter().enumerate() {
        let h = (room * share / shares).max(10.0);
        let mut x = GAP;
        for c in 0..columns {
            if let Some(frame) = frames.get_mut(r * columns + c) {
                frame.left = x;
                frame.cell = Rect::new(x - GAP / 2.0, y - GAP / 2.0, left + w + right + GAP, top + h + bottom + GAP);
                frame.settle(Rect::new(x + left, y + top, w, h));
            }
            x += left + w + right + GAP;
        }
        y += top + h + bottom + GAP;
    }
}

impl Frame<'_> {
    /// Moves the axes to `area` and finds their ticks.
    fn settle(&mut self, area: Rect) {
        let (x, y) = (self.x, self.y);
        self.area = area;
        self.x = Transform::new(x.scale, (x.low, x.high), area.x, area.right());
        self.y = Transform::new(y.scale, (y.low, y.high), area.bottom(), area.y);
        self.x_ticks = Ticks::new(x.scale, x.low, x.high, (area.w / 38.0).clamp(2.0, 9.0));
        self.y_ticks = Ticks::new(y.scale, y.low, y.high, (area.h / 15.0).clamp(2.0, 8.0));
        self.x_ticks.thin_out(area.w);
        self.y_ticks.thin_out(area.h);
        self.bar = self.panel.colours().map(|(values, colours)| {
            let range = colour_limits(values, colours);
            let bar = Transform::new(Scale::Linear, range, area.bottom(), area.y);
            let count = (area.h / 15.0).clamp(2.0, 8.0);
            (bar, Ticks::new(Scale::Linear, range.0, range.1, count))
        });
    }

    /// Widest label of some ticks.
    pub(crate) fn widest(ticks: &Ticks) -> f64 {
        ticks.major.iter().map(|(_, label)| width(label, TICK)).fold(0.0, f64::max)
    }

    /// Height of the strip above the axes that names shaded stretches.
    pub(crate) fn span_strip(&self) -> f64 {
        let named = |l: &Layer| l.label.is_some() && matches!(l.mark, Mark::Span(..));
        if self.panel.layers.iter().any(named) { SPAN_STRIP } else { 0.0 }
    }

    fn margins(&self) -> Margins {
        let caption = CAPTION + 4.0;
        let mut margins = Margins {
            left: TICK_LENGTH + 2.0 + Self::widest(&self.y_ticks) + 3.0 + caption,
            right: 3.0,
            top: 2.0 + self.span_strip() + self.legend_rows as f64 * LEGEND_ROW,
            bottom: 1.0,
        };
        if self.letter.is_some() || self.panel.title.is_some() {
            margins.top += TITLE_STRIP;
        }
        if self.names_x {
            margins.bottom = TICK_LENGTH + 2.0 + TICK + 3.0 + caption;
            if let Some((value, label)) = self.x_ticks.major.last() {
                let beyond = self.x.at(*value) + width(label, TICK) / 2.0 - self.area.right();
                margins.right = margins.right.max(beyond);
            }
        }
        if let Some((_, ticks)) = &self.bar {
            margins.right = BAR_GAP + BAR + TICK_LENGTH + 2.0 + Self::widest(ticks) + 3.0 + caption;
        }
        margins
    }
}

impl Figure {
    /// How many panels stand beside each other.
    pub(in crate::figure) fn columns(&self) -> usize {
        match self.arrangement {
            Arrangement::Stacked => 1,
            Arrangement::SideBySide => self.panels.len().max(1),
            Arrangement::Grid(columns) => columns.clamp(1, self.panels.len().max(1)),
        }
    }

    /// Whether stacked panels show the same quantity on their horizontal axis.
    fn shares_x(&self) -> bool {
        self.arrangement == Arrangement::Stacked
            && self.panels.windows(2).all(|pair| {
                let (a, b) = (&pair[0].x, &pair[1].x);
                (&a.label, &a.unit, a.scale) == (&b.label, &b.unit, b.scale)
            })
    }

    fn letter(&self, index: usize) -> Option<char> {
        let letter = u8::try_from(index).ok().filter(|i| *i < 26).map(|i| char::from(b'a' + i));
        letter.filter(|_| !self.without_letters && self.panels.len() > 1)
    }
}
