//! Figures of many panels.

use crate::figure::{Arrangement, Figure, Panel};

/// Panels in rows of `columns`, each row as high; none where there is no panel.
pub(super) fn grid(name: &str, caption: String, panels: Vec<Panel>, columns: usize, row_mm: f64) -> Option<Figure> {
    let rows = panels.len().div_ceil(columns.max(1)) as f64;
    let figure = Figure::new(name, caption).arrangement(Arrangement::Grid(columns)).height_mm(row_mm * rows);
    (!panels.is_empty()).then(|| panels.into_iter().fold(figure, Figure::panel))
}

/// How many columns that many panels are read best in.
pub(super) fn columns(panels: usize) -> usize {
    match panels {
        0 | 1 => 1,
        2 | 4 => 2,
        _ => 3,
    }
}
