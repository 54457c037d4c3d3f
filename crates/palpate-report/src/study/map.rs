//! A quantity over the positions of many curves.

use palpate::units::suited;

use crate::figure::{Axis, Figure, Layer, Map, Panel};
use crate::number::counted;

/// A curve of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPoint {
    /// Where it was measured, m.
    pub position: [f64; 2],
    /// What was found; `None` where nothing was.
    pub value: Option<f64>,
}

/// Share of the spacing that curves may lie beside the lines of a grid: stages do not return exactly.
const BESIDE: f64 = 0.3;
/// Share of the cells that hold a curve at least where positions are a grid.
const FILLED: f64 = 0.25;
/// Most lines of a grid in one direction.
const MOST_LINES: usize = 2000;

/// The values of curves as colours at their positions: cells where the positions form a grid along the axes, otherwise points.
///
/// A cell without a value is grey; of several curves in a cell it shows the mean. The two directions have one scale.
#[must_use]
pub fn map_figure(name: &str, caption: &str, (quantity, unit): (&str, &str), points: &[MapPoint]) -> Figure {
    let mut found: Vec<f64> = points.iter().filter_map(|point| point.value).collect();
    found.sort_by(f64::total_cmp);
    let (shown, factor) = suited(unit, found.get(found.len() / 2).copied().unwrap_or(0.0));
    let (low, high, beyond) = colour_range(&found);
    let mut colours = Axis::linear(quantity, if shown == "1" { "" } else { shown });
    let mut caption = format!("{caption} {} of {} have a value.", found.len(), counted(points.len(), "curve"));
    if beyond > 0 {
        colours = colours.range(low * factor, high * factor);
        caption.push_str(&format!(" The colours end at the 2nd and the 98th percentile; {beyond} values lie beyond."));
    }
    let value = |value: Option<f64>| value.map_or(f64::NAN, |value| value * factor);
    let (mut x_axis, mut y_axis) = (Axis::linear("x", "m"), Axis::linear("y", "m"));
    let layer = match grid(points) {
        Some(Grid { x, y, values }) => {
            caption.push_str(" Grey: no value.");
            let values = values.into_iter().map(value).collect();
            Layer::map(Map { x, y, values, colours })
        }
        None => {
            // Points at the border are whole.
            let room = |along: usize| {
                let (low, high) = extent(points, along);
                (low - 0.06 * (high - low), high + 0.06 * (high - low))
            };
            (x_axis.range, y_axis.range) = (Some(room(0)), Some(room(1)));
            let [x, y] = [0, 1].map(|along| points.iter().map(|point| point.position[along]).collect());
            Layer::spots(x, y, points.iter().map(|point| value(point.value)).collect(), colours)
        }
    };
    let panel = Panel::new(x_axis, y_axis).layer(layer).empty_note("No curve has a value");
    Figure::new(name, caption).panel(panel).width_mm(WIDTH_MM).height_mm(height_mm(points))
}

/// Width of the figure, and what captions and the bar of colours take of it, mm.
const WIDTH_MM: f64 = 110.0;
const BESIDE_MM: f64 = 36.0;
/// What captions take of the height, mm.
const BELOW_MM: f64 = 17.0;

/// The height at which both directions have one scale.
fn height_mm(points: &[MapPoint]) -> f64 {
    let long = |along: usize| {
        let (low, high) = extent(points, along);
        high - low
    };
    let shape = Some(long(1) / long(0)).filter(|shape| shape.is_finite()).unwrap_or(1.0);
    (BELOW_MM + (WIDTH_MM - BESIDE_MM) * shape).clamp(45.0, 220.0)
}

/// The least and the greatest coordinate.
fn extent(points: &[MapPoint], along: usize) -> (f64, f64) {
    let values = || points.iter().map(|point| point.position[along]);
    (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
}

/// The values at the ends of the colours, and how many lie beyond: a few failed curves do not take the colours from all others.
fn colour_range(sorted: &[f64]) -> (f64, f64, usize) {
    /// Fewer values have no percentiles to speak of.
    const ENOUGH: usize = 50;
    /// The range of all values, relative to that between the percentiles, beyond which a few decide it.
    const FAR: f64 = 3.0;
    let (Some(first), Some(last)) = (sorted.first().copied(), sorted.last().copied()) else {
        return (0.0, 1.0, 0);
    };
    let at = |share: f64| sorted[((sorted.len() - 1) as f64 * share).round() as usize];
    let (low, high) = (at(0.02), at(0.98));
    if sorted.len() < ENOUGH || last - first <= FAR * (high - low) {
        return (first, last, 0);
    }
    (low, high, sorted.iter().filter(|value| **value < low || **value > high).count())
}

/// Curves in columns and rows, row after row.
struct Grid {
    x: Vec<f64>,
    y: Vec<f64>,
    values: Vec<Option<f64>>,
}

/// The grid that the positions form; `None` where they form none along the axes.
fn grid(points: &[MapPoint]) -> Option<Grid> {
    let spacing = spacing(points)?;
    let lines = |along: usize| lines(points.iter().map(|point| point.position[along]).collect(), spacing);
    let (x, y) = (lines(0)?, lines(1)?);
    if (x.len() * y.len()) as f64 * FILLED > points.len() as f64 {
        return None;
    }
    let nearest = |lines: &[f64], at: f64| {
        (0..lines.len()).min_by(|a, b| (lines[*a] - at).abs().total_cmp(&(lines[*b] - at).abs()))
    };
    let mut sums = vec![(0.0, 0_u32); x.len() * y.len()];
    for point in points {
        let cell = nearest(&y, point.position[1])? * x.len() + nearest(&x, point.position[0])?;
        if let Some(value) = point.value {
            sums[cell] = (sums[cell].0 + value, sums[cell].1 + 1);
        }
    }
    let values = sums.into_iter().map(|(sum, count)| (count > 0).then(|| sum / f64::from(count))).collect();
    Some(Grid { x, y, values })
}

/// Median distance of a curve to the nearest one at another place.
fn spacing(points: &[MapPoint]) -> Option<f64> {
    /// Curves whose neighbours are sought.
    const MOST: usize = 500;
    let apart = |a: &MapPoint, b: &MapPoint| (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1]);
    let step = points.len().div_ceil(MOST).max(1);
    let nearest = |one: &MapPoint| {
        let distances = points.iter().map(|other| apart(one, other)).filter(|distance| *distance > 0.0);
        distances.min_by(f64::total_cmp)
    };
    let mut found: Vec<f64> = points.iter().step_by(step).filter_map(nearest).collect();
    found.sort_by(f64::total_cmp);
    found.get(found.len() / 2).copied()
}

/// The evenly spaced lines on which values lie, also those without any; `None` where they lie on none, or on one only.
fn lines(mut values: Vec<f64>, spacing: f64) -> Option<Vec<f64>> {
    values.sort_by(f64::total_cmp);
    let groups: Vec<&[f64]> = values.chunk_by(|a, b| b - a <= BESIDE * spacing).collect();
    if groups.iter().any(|group| group[group.len() - 1] - group[0] > 2.0 * BESIDE * spacing) {
        return None;
    }
    let centres: Vec<f64> = groups.iter().map(|group| group.iter().sum::<f64>() / group.len() as f64).collect();
    let steps = || centres.windows(2).map(|pair| pair[1] - pair[0]);
    let step = steps().min_by(f64::total_cmp)?;
    let mut lines = vec![centres[0]];
    for (pair, distance) in centres.windows(2).zip(steps()) {
        let count = (distance / step).round();
        if (distance - count * step).abs() > BESIDE * step || lines.len() as f64 + count > MOST_LINES as f64 {
            return None;
        }
        lines.extend((1..=count as usize).map(|line| pair[0] + distance * line as f64 / count));
    }
    Some(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, y: f64, value: f64) -> MapPoint {
        MapPoint {
            position: [x, y],
            value: Some(value),
        }
    }

    /// A grid of columns and rows 1 µm apart with a jitter, in a scrambled order, without the curves that `lost` says.
    fn scanned(columns: usize, rows: usize, lost: impl Fn(usize, usize) -> bool) -> Vec<MapPoint> {
        let mut points = Vec::new();
        for j in 0..rows {
            for i in 0..columns {
                let jitter = 1e-7 * ((i * 7 + j * 3) as f64).sin();
                if !lost(i, j) {
                    points.push(point(1e-6 * i as f64 + jitter, 1e-6 * j as f64 - jitter, (10 * j + i) as f64));
                }
            }
        }
        points.reverse();
        points
    }

    #[test]
    fn a_jittered_grid_keeps_its_places_and_what_is_missing_stays_empty() {
        let found = grid(&scanned(6, 5, |i, j| (i, j) == (2, 3) || j == 1)).expect("a grid");
        assert_eq!((found.x.len(), found.y.len()), (6, 5));
        for (cell, value) in found.values.iter().enumerate() {
            let (i, j) = (cell % 6, cell / 6);
            let expected = (j != 1 && (i, j) != (2, 3)).then_some((10 * j + i) as f64);
            assert_eq!(*value, expected, "{i}, {j}");
        }
    }

    #[test]
    fn positions_without_an_order_are_no_grid() {
        let irregular: Vec<MapPoint> = (0..40)
            .map(|i| {
                let i = f64::from(i);
                point((i * 12.9898).sin().abs(), (i * 78.233).cos().abs(), i)
            })
            .collect();
        assert!(grid(&irregular).is_none());
        // A turned grid, a line and a single curve have no columns and rows.
        let turned =
            |p: &MapPoint| point(p.position[0] - 0.4 * p.position[1], p.position[1] + 0.4 * p.position[0], 0.0);
        assert!(grid(&scanned(8, 8, |_, _| false).iter().map(turned).collect::<Vec<_>>()).is_none());
        assert!(grid(&scanned(8, 1, |_, _| false)).is_none());
        assert!(grid(&[point(0.0, 0.0, 1.0)]).is_none());
    }

    #[test]
    fn repeated_curves_are_averaged_and_a_stray_one_does_not_take_the_colours() {
        let mut points = scanned(8, 8, |_, _| false);
        points.push(point(0.0, 0.0, 1e6));
        let figure = map_figure("map", "Values.", ("Modulus", "Pa"), &points);
        let svg = figure.to_svg().expect("a drawing");
        assert!(
            figure.caption.contains("65 of 65 curves have a value") && figure.caption.contains("2 values lie beyond"),
            "{}",
            figure.caption
        );
        assert!(svg.contains(">Modulus (Pa)<") && svg.contains(">x (µm)<") && svg.contains(">y (µm)<"), "{svg}");
        let found = grid(&points).expect("a grid");
        assert_eq!(found.values[0], Some(5e5));
    }

    #[test]
    fn irregular_positions_are_points_of_their_colours() {
        let points =
            [point(0.0, 0.0, 0.0), point(3e-6, 1e-6, 1.0), point(7e-6, 5e-6, f64::NAN), point(1e-6, 8e-6, 2.0)];
        let svg = map_figure("map", "", ("Exponent", "1"), &points).to_svg().expect("a drawing");
        assert!(svg.contains("#440154") && svg.contains("#fde725") && svg.contains(">Exponent<"), "{svg}");
        assert!(!svg.contains("NaN") && !svg.contains("<image"));
    }
}
