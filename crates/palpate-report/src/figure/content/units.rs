//! Figures in the units that suit the size of what they show, by the rule that tables follow too.

use palpate::units::suited;

use super::axis::{Axis, Scale};
use super::figure::Figure;
use super::layer::{Layer, Mark};

/// Which axis of a panel.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Along {
    X,
    Y,
}

impl Figure {
    /// The same figure with linear axes in nN to kN, nm to m, Pa to GPa, s to days; axes of one quantity share a unit, and so do the two axes
    /// of a panel that have the same. Logarithmic axes keep theirs: they show many sizes at once.
    pub(crate) fn in_suited_units(&self) -> Self {
        let mut figure = self.clone();
        if std::mem::replace(&mut figure.has_suited_units, true) {
            return figure;
        }
        for (index, panel) in figure.panels.iter_mut().enumerate() {
            for along in [Along::X, Along::Y] {
                let axis = self.axis(index, along);
                if axis.scale == Scale::Log || axis.unit.is_empty() {
                    continue;
                }
                let (unit, factor) = suited(&axis.unit, self.largest(axis));
                if factor == 1.0 {
                    continue;
                }
                let own = if along == Along::X { &mut panel.x } else { &mut panel.y };
                *own = Axis {
                    unit: unit.to_owned(),
                    range: axis.range.map(|(low, high)| (low * factor, high * factor)),
                    ..axis.clone()
                };
                panel.layers.iter_mut().for_each(|layer| layer.scale(along, factor));
            }
        }
        figure
    }

    fn axis(&self, panel: usize, along: Along) -> &Axis {
        let panel = &self.panels[panel];
        if along == Along::X { &panel.x } else { &panel.y }
    }

    /// The largest size on all axes of this quantity, in their limits where they have any.
    fn largest(&self, like: &Axis) -> f64 {
        let mut largest: f64 = 0.0;
        for (index, panel) in self.panels.iter().enumerate() {
            for along in [Along::X, Along::Y] {
                let axis = self.axis(index, along);
                let is_plane = panel.x.unit == panel.y.unit;
                if (&axis.unit, axis.scale) != (&like.unit, like.scale) || (axis.label != like.label && !is_plane) {
                    continue;
                }
                let of_data = || panel.layers.iter().map(|layer| layer.largest(along)).fold(0.0, f64::max);
                let shown = axis.range.map_or_else(of_data, |(low, high)| low.abs().max(high.abs()));
                largest = largest.max(shown);
            }
        }
        largest
    }
}

impl Layer {
    /// The columns of a layer along an axis.
    fn columns(&mut self, along: Along) -> Vec<&mut [f64]> {
        match (&mut self.mark, along) {
            (
                Mark::Line { x, .. } | Mark::Points { x, .. } | Mark::Band { x, .. } | Mark::Spots { x, .. },
                Along::X,
            ) => vec![x],
            (Mark::Map(map), Along::X) => vec![&mut map.x],
            (Mark::Map(map), Along::Y) => vec![&mut map.y],
            (Mark::Span(from, to), Along::X) => vec![std::slice::from_mut(from), std::slice::from_mut(to)],
            (Mark::Vertical(at), Along::X) | (Mark::Horizontal(at), Along::Y) => vec![std::slice::from_mut(at)],
            (Mark::Line { y, .. } | Mark::Spots { y, .. }, Along::Y) => vec![y],
            (Mark::Points { y, error, .. }, Along::Y) => {
                let ends = error.iter_mut().flat_map(|(low, high)| [low.as_mut_slice(), high.as_mut_slice()]);
                std::iter::once(y.as_mut_slice()).chain(ends).collect()
            }
            (Mark::Band { low, high, .. }, Along::Y) => vec![low, high],
            (Mark::Span(..) | Mark::Vertical(_), Along::Y) | (Mark::Horizontal(_), Along::X) => Vec::new(),
        }
    }

    fn scale(&mut self, along: Along, factor: f64) {
        self.columns(along).into_iter().flatten().for_each(|value| *value *= factor);
    }

    fn largest(&self, along: Along) -> f64 {
        let most = |values: &[f64]| values.iter().filter(|v| v.is_finite()).fold(0.0, |most: f64, v| most.max(v.abs()));
        match (&self.mark, along) {
            (
                Mark::Line { x, .. } | Mark::Points { x, .. } | Mark::Band { x, .. } | Mark::Spots { x, .. },
                Along::X,
            ) => most(x),
            (Mark::Line { y, .. } | Mark::Points { y, .. } | Mark::Spots { y, .. }, Along::Y) => most(y),
            (Mark::Band { low, high, .. }, Along::Y) => most(low).max(most(high)),
            (Mark::Map(map), Along::X) => most(&map.x),
            (Mark::Map(map), Along::Y) => most(&map.y),
            // Marks that refer to data do not decide the unit of them.
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::figure::{Axis, Figure, Layer, Panel, Role};

    #[test]
    fn nanonewtons_and_hours_are_drawn_as_such() {
        let panel = |label: &str| {
            Panel::new(Axis::linear("Time", "s"), Axis::linear(label, "N")).layer(Layer::line(
                vec![0.0, 36_000.0],
                vec![0.0, 4e-9],
                Role::Measured,
            ))
        };
        let svg = Figure::new("f", "").panel(panel("Force")).panel(panel("Residual")).to_svg().unwrap();
        assert!(svg.contains("Force (nN)") && svg.contains("Residual (nN)") && svg.contains("Time (h)"), "{svg}");
        assert!(!svg.contains("(N)") && !svg.contains("(s)"));
    }
}
