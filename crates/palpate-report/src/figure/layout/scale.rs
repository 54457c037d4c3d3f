//! From values to positions on the page, and the limits of an axis.

use crate::figure::content::{Axis, Layer, Mark, Panel, Scale, shows};

/// Positions beyond the plot are held to this, so that every number stays short.
const FAR: f64 = 20_000.0;

/// Values beyond this size have no place on an axis, so that sums of them stay finite.
const LARGEST: f64 = 1e300;

/// Which of the two axes is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Direction {
    Horizontal,
    Vertical,
}

/// Limits of one axis and where they lie on the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Transform {
    pub(crate) scale: Scale,
    pub(crate) low: f64,
    pub(crate) high: f64,
    start: f64,
    per_unit: f64,
}

impl Transform {
    pub(crate) fn new(scale: Scale, (low, high): (f64, f64), start: f64, end: f64) -> Self {
        let per_unit = (end - start) / (stretch(scale, high) - stretch(scale, low));
        Self {
            scale,
            low,
            high,
            start,
            per_unit,
        }
    }

    /// Position of a value; not a number where the axis has no place for it.
    pub(crate) fn at(&self, value: f64) -> f64 {
        if !shows(value, self.scale) {
            return f64::NAN;
        }
        let along = stretch(self.scale, value) - stretch(self.scale, self.low);
        (self.start + along * self.per_unit).clamp(-FAR, FAR)
    }

    pub(crate) fn contains(&self, value: f64) -> bool {
        let slack = 1e-9 * (self.high - self.low);
        shows(value, self.scale) && value >= self.low - slack && value <= self.high + slack
    }
}

fn stretch(scale: Scale, value: f64) -> f64 {
    match scale {
        Scale::Linear => value,
        Scale::Log => value.log10(),
    }
}

/// Limits of one axis shared by some panels.
pub(crate) fn limits(axis: &Axis, panels: &[&Panel], direction: Direction) -> (f64, f64) {
    if let Some(range) = axis.range.filter(|r| usable(*r) && r.0.min(r.1) > lowest(axis.scale)) {
        return range;
    }
    let mut extent = Extent {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
        fit: Fit::Plain,
    };
    for layer in panels.iter().flat_map(|panel| &panel.layers) {
        extent.include(layer, direction, axis.scale);
    }
    if extent.low > extent.high {
        return if axis.scale == Scale::Log { (0.1, 10.0) } else { (0.0, 1.0) };
    }
    extent.padded(axis.scale, direction)
}

fn lowest(scale: Scale) -> f64 {
    if scale == Scale::Log { 1.0 / LARGEST } else { -LARGEST }
}

/// Whether the limits are apart by an amount that a drawing can resolve.
pub(crate) fn usable((low, high): (f64, f64)) -> bool {
    let size = high.abs().max(low.abs());
    size <= LARGEST && high - low > (size * 1e-9).max(1.0 / LARGEST)
}

/// Limits around a value that does not vary.
pub(crate) fn around(value: f64) -> (f64, f64) {
    let room = if value.abs() > 1e-200 { value.abs() * 0.1 } else { 1.0 };
    (value - room, value + room)
}

struct Extent {
    low: f64,
    high: f64,
    fit: Fit,
}

/// How closely the frame may follow the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Fit {
    /// Room above and below, none at the sides.
    Plain,
    /// Room on all sides, because marks at the border would be cut.
    Loose,
    /// No room, because a map fills the frame.
    Tight,
}

impl Extent {
    fn take(&mut self, values: &[f64], scale: Scale) {
        for value in values.iter().filter(|v| **v > lowest(scale) && **v < LARGEST) {
            self.low = self.low.min(*value);
            self.high = self.high.max(*value);
        }
    }

    fn include(&mut self, layer: &Layer, direction: Direction, scale: Scale) {
        let vertical = direction == Direction::Vertical;
        match &layer.mark {
            Mark::Line { x, y } => self.take(if vertical { y } else { x }, scale),
            Mark::Points { x, y, error } => {
                self.fit = self.fit.max(Fit::Loose);
                self.take(if vertical { y } else { x }, scale);
                if let (true, Some((low, high))) = (vertical, error) {
                    self.take(low, scale);
                    self.take(high, scale);
                }
            }
            Mark::Spots { x, y, .. } => {
                self.fit = self.fit.max(Fit::Loose);
                self.take(if vertical { y } else { x }, scale);
            }
            Mark::Band { x, .. } if !vertical => self.take(x, scale),
            Mark::Band { low, high, .. } => {
                self.take(low, scale);
                self.take(high, scale);
            }
            Mark::Span(from, to) if !vertical => self.take(&[*from, *to], scale),
            Mark::Horizontal(at) if vertical => self.take(&[*at], scale),
            Mark::Vertical(at) if !vertical => self.take(&[*at], scale),
            Mark::Map(map) => {
                self.fit = Fit::Tight;
                let edges = edges(if vertical { &map.y } else { &map.x }, scale);
                self.take(&edges, scale);
            }
            Mark::Span(..) | Mark::Horizontal(_) | Mark::Vertical(_) => {}
        }
    }

    fn padded(&self, scale: Scale, direction: Direction) -> (f64, f64) {
        let (low, high) = (self.low, self.high);
        if scale == Scale::Log {
            if high / low < 1.0 + 1e-9 {
                return (low / 2.0, high * 2.0);
            }
            let share = if self.has_room(direction) { 0.05 } else { 0.0 };
            let room = (high / low).powf(share);
            return (low / room, high * room);
        }
        if !usable((low, high)) {
            return around(f64::midpoint(low, high));
        }
        if !self.has_room(direction) {
            return (low, high);
        }
        let room = 0.05 * (high - low);
        let bottom = if low > 0.0 && low < 0.3 * high { 0.0 } else { low - room };
        let top = if high < 0.0 && high > 0.3 * low { 0.0 } else { high + room };
        (bottom, top)
    }

    fn has_room(&self, direction: Direction) -> bool {
        match self.fit {
            Fit::Plain => direction == Direction::Vertical,
            Fit::Loose => true,
            Fit::Tight => false,
        }
    }
}

/// Borders between cells whose centres are given.
pub(crate) fn edges(centres: &[f64], scale: Scale) -> Vec<f64> {
    let logarithmic = scale == Scale::Log;
    let to = |v: f64| if logarithmic { v.ln() } else { v };
    let from = |v: f64| if logarithmic { v.exp() } else { v };
    let c: Vec<f64> = centres.iter().copied().filter(|v| shows(*v, scale)).map(to).collect();
    let (Some(&first), Some(&last)) = (c.first(), c.last()) else {
        return Vec::new();
    };
    if c.len() == 1 {
        let half = if scale == Scale::Linear && first != 0.0 { first.abs() * 0.05 } else { 0.5 };
        return vec![from(first - half), from(first + half)];
    }
    let start = first - (c[1] - first) / 2.0;
    let end = last + (last - c[c.len() - 2]) / 2.0;
    let middle = c.windows(2).map(|pair| f64::midpoint(pair[0], pair[1]));
    std::iter::once(start).chain(middle).chain([end]).map(from).collect()
}

/// Values at the two ends of the colours.
pub(crate) fn colour_limits(values: &[f64], colours: &Axis) -> (f64, f64) {
    if let Some(range) = colours.range.filter(|range| usable(*range)) {
        return range;
    }
    let finite = values.iter().copied().filter(|v| v.abs() < 1e300);
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    match (low, high) {
        (low, high) if low > high => (0.0, 1.0),
        range if usable(range) => range,
        _ => around(f64::midpoint(low, high)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::content::Role;

    fn range(y: Vec<f64>, axis: &Axis) -> (f64, f64) {
        let x = (0..y.len()).map(|i| i as f64).collect();
        let panel = Panel::new(Axis::linear("x", ""), axis.clone()).layer(Layer::line(x, y, Role::Fitted));
        limits(axis, &[&panel], Direction::Vertical)
    }

    #[test]
    fn degenerate_data_still_give_a_range() {
        let linear = Axis::linear("y", "");
        for y in [vec![], vec![f64::NAN], vec![3.0], vec![0.0, 0.0], vec![-1e300, 1e300]] {
            let (low, high) = range(y, &linear);
            assert!(low < high && low.is_finite() && high.is_finite());
        }
        let (low, high) = range(vec![-1.0, 0.0, 5.0], &Axis::log("y", ""));
        assert!(0.0 < low && low < 5.0 && high > 5.0);
    }

    #[test]
    fn fixed_limits_win_unless_they_make_no_sense() {
        assert_eq!(range(vec![3.0], &Axis::linear("y", "").range(0.0, 9.0)), (0.0, 9.0));
        assert_ne!(range(vec![3.0], &Axis::linear("y", "").range(9.0, 0.0)), (9.0, 0.0));
    }

    #[test]
    fn borders_lie_between_centres() {
        assert_eq!(edges(&[1.0, 2.0, 4.0], Scale::Linear), [0.5, 1.5, 3.0, 5.0]);
        let log = edges(&[1.0, 100.0], Scale::Log);
        assert!((log[1] - 10.0).abs() < 1e-9);
        assert_eq!(edges(&[3.0], Scale::Linear).len(), 2);
        assert!(edges(&[f64::NAN], Scale::Linear).is_empty());
    }
}
