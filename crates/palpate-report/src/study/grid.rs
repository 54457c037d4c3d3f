//! Figures of many panels, and panels of many figures.

use crate::figure::{Arrangement, Figure, Layer, Panel, Role};

/// Panels in rows of `columns`, each row as high; none where there is no panel.
pub(super) fn grid(name: &str, caption: String, panels: Vec<Panel>, columns: usize, row_mm: f64) -> Option<Figure> {
    let rows = panels.len().div_ceil(columns.max(1)) as f64;
    let figure = Figure::new(name, caption).arrangement(Arrangement::Grid(columns)).height_mm(row_mm * rows);
    (!panels.is_empty()).then(|| figure.panels(panels))
}

/// What a caption says where only the first have a panel.
pub(super) fn first_of(shown: usize, all: usize, what: &str) -> String {
    if shown < all { format!(" Shown: the first {shown} of {all} {what}.") } else { String::new() }
}

/// How far the jaw went, from metres.
pub(super) fn displacement_panel(time: &[f64], displacement: &[f64], role: Role) -> Panel {
    let millimetres = displacement.iter().map(|d| 1e3 * d).collect();
    Panel::over_time("Displacement", "mm").layer(Layer::line(time.to_vec(), millimetres, role))
}

/// How many columns that many panels are read best in.
pub(super) fn columns(panels: usize) -> usize {
    match panels {
        0 | 1 => 1,
        2 | 4 => 2,
        _ => 3,
    }
}
