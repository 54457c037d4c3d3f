//! Room inside the axes that is taken already.

use super::rect::{Position, Rect};

/// Edge of the cells in which covered room is counted.
const CELL: f64 = 2.5;

/// Room inside the axes that data, bars and reference lines take.
#[derive(Debug)]
pub(crate) struct Occupancy {
    pub(crate) area: Rect,
    columns: usize,
    rows: usize,
    taken: Vec<bool>,
}

impl Occupancy {
    pub(crate) fn new(area: Rect) -> Self {
        let count = |length: f64| (length / CELL).ceil().max(1.0) as usize;
        let (columns, rows) = (count(area.w), count(area.h));
        Self {
            area,
            columns,
            rows,
            taken: vec![false; columns * rows],
        }
    }

    pub(crate) fn mark(&mut self, (x, y): Position) {
        let (c, r) = ((x - self.area.x) / CELL, (y - self.area.y) / CELL);
        if c >= 0.0 && r >= 0.0 && (c as usize) < self.columns && (r as usize) < self.rows {
            self.taken[r as usize * self.columns + c as usize] = true;
        }
    }

    pub(crate) fn mark_line(&mut self, line: &[Position]) {
        for pair in line.windows(2) {
            let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            let steps = (dx.abs().max(dy.abs()) / CELL * 1.5).ceil().clamp(1.0, 20_000.0);
            for i in 0..=steps as usize {
                let part = i as f64 / steps;
                self.mark((pair[0].0 + part * dx, pair[0].1 + part * dy));
            }
        }
        if let [single] = line {
            self.mark(*single);
        }
    }

    pub(crate) fn mark_rect(&mut self, area: Rect) {
        let mut y = area.y;
        while y <= area.bottom() {
            self.mark_line(&[(area.x, y), (area.right(), y)]);
            y += CELL;
        }
    }

    /// How many cells of `area` are taken.
    pub(crate) fn covered(&self, area: Rect) -> usize {
        let cell = |v: f64, most: usize| ((v / CELL).floor().max(0.0) as usize).min(most - 1);
        let columns = cell(area.x - self.area.x, self.columns)..=cell(area.right() - self.area.x, self.columns);
        let rows = cell(area.y - self.area.y, self.rows)..=cell(area.bottom() - self.area.y, self.rows);
        let hits = |r: usize| columns.clone().filter(|c| self.taken[r * self.columns + c]).count();
        rows.map(hits).sum()
    }
}
