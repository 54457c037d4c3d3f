//! Figures of many panels, and panels of many figures.

use crate::figure::{Arrangement, Figure, Layer, MOST_PANELS, Panel, Role};

/// Panels in rows of `columns`, each row as high; none where there is no panel.
pub(super) fn grid(name: &str, caption: String, panels: Vec<Panel>, columns: usize, row_mm: f64) -> Option<Figure> {
    let rows = panels.len().div_ceil(columns.max(1)) as f64;
    let figure = Figure::new(name, caption).arrangement(Arrangement::Grid(columns)).height_mm(row_mm * rows);
    (!panels.is_empty()).then(|| figure.panels(panels))
}

/// A figure of one panel a hold, all of them or the first, in rows of this height; a hold that is alone has another one.
pub(super) fn by_hold<T>(
    name: &str,
    caption: impl Into<String>,
    (alone_mm, row_mm): (f64, f64),
    (holds, what): (&[T], &str),
    panel: impl Fn(&T) -> Panel,
) -> Option<Figure> {
    let panels: Vec<Panel> = holds.iter().take(MOST_PANELS).map(panel).collect();
    let columns = match panels.len() {
        0 | 1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    let caption = caption.into() + &first_of(panels.len(), holds.len(), what);
    grid(name, caption, panels, columns, if columns == 1 { alone_mm } else { row_mm })
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
