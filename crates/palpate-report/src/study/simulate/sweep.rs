//! A sweep as a figure: a curve, a heat map, heat maps side by side, or points.

use crate::figure::{Arrangement, Axis, Figure, Layer, MOST_PANELS, Map, Panel, Role};
use crate::number::significant;
use crate::study::grid::grid;

/// A swept number, or a result of the runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Swept {
    /// The axis that it is shown on.
    pub axis: Axis,
    /// Of a number its values: of a grid each one once, of points one a run. Of a result one value a run, NaN where there is none; of a
    /// grid with the last number changing from run to run.
    pub values: Vec<f64>,
}

impl Swept {
    /// Places of the values in rising order.
    fn rising(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
        order
    }
}

/// A grid: a curve over one axis, a heat map over two, and a heat map for each value of a third.
///
/// The first axis runs across, the second up. `None` for no axis, for more than three, for more than [`MOST_PANELS`] values of the third,
/// and where the results are not one for each run.
#[must_use]
pub fn sweep_grid_figure(name: &str, caption: &str, axes: &[Swept], result: &Swept) -> Option<Figure> {
    let runs: usize = axes.iter().map(|axis| axis.values.len()).product();
    if runs != result.values.len() {
        return None;
    }
    let figure = Figure::new(name, caption);
    match axes {
        [x] => {
            let order = x.rising();
            let pick = |values: &[f64]| order.iter().map(|i| values[*i]).collect::<Vec<f64>>();
            let (across, up) = (pick(&x.values), pick(&result.values));
            let line = Layer::line(across.clone(), up.clone(), Role::Series(0));
            let mut panel = panel(&x.axis, &result.axis).layer(line);
            if across.len() <= 60 {
                panel = panel.layer(Layer::points(across, up, Role::Series(0)));
            }
            Some(figure.panel(panel))
        }
        [x, y] => Some(figure.panel(heat_map((x, y), result, |i, j| i * y.values.len() + j, None))),
        [x, y, z] if z.values.len() <= MOST_PANELS => {
            // All maps have the same colours.
            let finite = result.values.iter().filter(|value| value.is_finite());
            let range = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
            let columns = if z.values.len() <= 4 { 2 } else { 3 };
            let panels = z.rising().into_iter().map(|k| {
                let at = |i: usize, j: usize| (i * y.values.len() + j) * z.values.len() + k;
                let unit = if z.axis.unit.is_empty() { String::new() } else { format!(" {}", z.axis.unit) };
                let title = format!("{} = {}{unit}", z.axis.label, short(z.values[k]));
                heat_map((x, y), result, at, Some(range)).title(title)
            });
            grid(name, caption.to_owned(), panels.collect(), columns, 62.0)
        }
        _ => None,
    }
}

/// Runs without an order: a panel of points for every swept number.
#[must_use]
pub fn sweep_points_figure(name: &str, caption: &str, axes: &[Swept], result: &Swept) -> Figure {
    let mut figure = Figure::new(name, caption);
    if axes.len() != 1 {
        let rows = axes.len().div_ceil(2) as f64;
        figure = figure.arrangement(Arrangement::Grid(2)).height_mm(62.0 * rows);
    }
    axes.iter().fold(figure, |figure, axis| {
        let points = Layer::points(axis.values.clone(), result.values.clone(), Role::Series(0));
        figure.panel(panel(&axis.axis, &result.axis).layer(points))
    })
}

fn panel(x: &Axis, y: &Axis) -> Panel {
    Panel::new(x.clone(), y.clone()).empty_note("Every run was refused")
}

/// The values at column i and row j stand at `at(i, j)`.
fn heat_map(
    (x, y): (&Swept, &Swept),
    result: &Swept,
    at: impl Fn(usize, usize) -> usize,
    range: Option<(f64, f64)>,
) -> Panel {
    let (across, up) = (x.rising(), y.rising());
    let values = up.iter().flat_map(|j| across.iter().map(|i| result.values[at(*i, *j)]).collect::<Vec<f64>>());
    let map = Map {
        x: across.iter().map(|i| x.values[*i]).collect(),
        y: up.iter().map(|j| y.values[*j]).collect(),
        values: values.collect(),
        colours: Axis {
            range,
            ..result.axis.clone()
        },
    };
    panel(&x.axis, &y.axis).layer(Layer::map(map))
}

/// A value as people write it in a title: 2 and not 2.00.
fn short(value: f64) -> String {
    let text = significant(value, 3);
    let decimal = text.contains('.') && !text.contains('×');
    if decimal { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(label: &str, values: &[f64]) -> Swept {
        Swept {
            axis: Axis::linear(label, "mm"),
            values: values.to_vec(),
        }
    }

    fn result(values: Vec<f64>) -> Swept {
        Swept {
            axis: Axis::linear("Force", "N"),
            values,
        }
    }

    fn maps(figure: &Figure) -> Vec<&Map> {
        figure.panels.iter().filter_map(Panel::map).collect()
    }

    #[test]
    fn the_first_number_runs_across_and_the_second_up_in_rising_order() {
        // Values of x fall in the file; the result says its own place, x + 10 y.
        let (x, y) = (axis("x", &[3.0, 1.0, 2.0]), axis("y", &[5.0, 4.0]));
        let values = x.values.iter().flat_map(|x| y.values.iter().map(move |y| x + 10.0 * y)).collect();
        let figure = sweep_grid_figure("f", "", &[x, y], &result(values)).unwrap();
        let map = maps(&figure)[0];
        assert_eq!((map.x.as_slice(), map.y.as_slice()), ([1.0, 2.0, 3.0].as_slice(), [4.0, 5.0].as_slice()));
        assert_eq!(map.values, [41.0, 42.0, 43.0, 51.0, 52.0, 53.0]);
    }

    #[test]
    fn panels_share_their_colours() {
        let axes = [axis("x", &[1.0, 2.0]), axis("y", &[1.0, 2.0]), axis("z", &[7.0, 6.0, 8.0])];
        let mut values: Vec<f64> = (0..12).map(f64::from).collect();
        values[4] = f64::NAN;
        let figure = sweep_grid_figure("f", "", &axes, &result(values)).unwrap();
        let maps = maps(&figure);
        assert_eq!(maps.len(), 3);
        assert!(maps.iter().all(|map| map.colours.range == Some((0.0, 11.0))));
        // z = 6 stands second in the file and first in the figure.
        assert_eq!(maps[0].values[0], 1.0);
        assert!(figure.to_svg().unwrap().contains("z = 6 mm"));
    }

    #[test]
    fn grids_that_cannot_be_drawn() {
        let x = || axis("x", &[1.0, 2.0]);
        assert_eq!(sweep_grid_figure("f", "", &[], &result(vec![1.0])), None);
        assert_eq!(sweep_grid_figure("f", "", &[x()], &result(vec![1.0])), None);
        assert_eq!(sweep_grid_figure("f", "", &[x(), x(), x(), x()], &result(vec![1.0; 16])), None);
        let many: Vec<f64> = (0..13).map(f64::from).collect();
        assert_eq!(sweep_grid_figure("f", "", &[x(), x(), axis("z", &many)], &result(vec![1.0; 52])), None);
        let refused = sweep_grid_figure("f", "", &[x(), x()], &result(vec![f64::NAN; 4])).unwrap();
        assert!(refused.to_svg().unwrap().contains("refused"));
    }
}
