//! Figures of many panels, and panels of many figures.

use crate::figure::{Arrangement, Figure, Layer, MOST_PANELS, Panel, Role};

/// Panels in rows of `columns`, each row as high; none where there is no panel.
pub(super) fn grid(name: &str, caption: String, panels: Vec<Panel>, columns: usize, row_mm: f64) -> Option<Figure> {
    let rows = panels.len().div_ceil(columns.max(1)) as f64;
    let figure = Figure::new(name, caption).arrangement(Arrangement::Grid(columns)).height_mm(row_mm * rows);
    let figure = if panels.len() == 1 { figure.width_mm(120.0) } else { figure };
    (!panels.is_empty()).then(|| figure.panels(panels))
}

/// Columns for so many panels.
pub(super) fn columns(panels: usize) -> usize {
    match panels {
        0 | 1 => 1,
        2 | 4 => 2,
        _ => 3,
    }
}

/// A panel for each hold, all of them, in rows of this height; a hold that is alone has another one. More than a figure holds go on in
/// further figures, in the units of the first: `name`, `name_2`, …
pub(super) fn by_hold<T>(
    name: &str,
    caption: impl Into<String>,
    (alone_mm, row_mm): (f64, f64),
    (holds, what): (&[T], &str),
    panel: impl Fn(&T) -> Panel,
) -> Vec<Figure> {
    let (caption, count) = (caption.into(), holds.len());
    let all = Figure::new(name, "").panels(holds.iter().map(panel)).in_suited_units();
    let columns = columns(count);
    let pages = all.panels.chunks(MOST_PANELS).enumerate();
    let figure = |(page, panels): (usize, &[Panel])| {
        let (first, last) = (page * MOST_PANELS + 1, page * MOST_PANELS + panels.len());
        let which = format!("{what} {first} to {last} of {count}");
        let whole = if count > MOST_PANELS { format!("{caption} Shown: {which}.") } else { caption.clone() };
        let row_mm = if columns == 1 { alone_mm } else { row_mm };
        let name = if page == 0 { name.to_owned() } else { format!("{name}_{}", page + 1) };
        let mut figure = grid(&name, whole, panels.to_vec(), columns, row_mm)?.without_letters();
        figure.has_suited_units = true;
        let figure = if page == 0 { figure } else { figure.continues(format!("Continued: {which}")) };
        Some(if columns == 1 { figure } else { figure.common_legend() })
    };
    pages.filter_map(figure).collect()
}

/// How far the jaw went, from metres.
pub(super) fn displacement_panel(time: &[f64], displacement: &[f64], role: Role) -> Panel {
    let millimetres = displacement.iter().map(|d| 1e3 * d).collect();
    Panel::over_time("Displacement", "mm").layer(Layer::line(time.to_vec(), millimetres, role))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 24 holds 12 were shown.
    #[test]
    fn all_holds_have_a_panel_in_the_units_of_the_first() {
        let holds: Vec<f64> = (1..=30).map(|hold| if hold == 3 { 5.0 } else { 0.02 * f64::from(hold) }).collect();
        let panel = |force: &f64| {
            Panel::over_time("Force", "N").layer(Layer::line(vec![0.0, 1.0], vec![0.0, *force], Role::Measured))
        };
        let figures = by_hold("holds", "Holds.", (60.0, 50.0), (&holds, "holds"), panel);
        assert_eq!(figures.iter().map(|figure| figure.panels.len()).collect::<Vec<_>>(), [12, 12, 6]);
        assert_eq!(figures[2].name, "holds_3");
        assert_eq!(figures[2].caption, "Holds. Shown: holds 25 to 30 of 30.");
        for figure in &figures {
            let svg = figure.to_svg().unwrap();
            assert_eq!((svg.matches(">Force (N)<").count(), svg.contains("mN")), (figure.panels.len(), false));
        }
        assert!(by_hold("none", "", (60.0, 50.0), (&[] as &[f64], "holds"), panel).is_empty());
    }
}
