//! Where a body carries a given force.

use super::{Layers, Specimen};

/// What a contact displacement has to satisfy, as the strain of the contact layer that goes with it.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Layer {
    /// The node behind the layer stands at this displacement (m); the layer has this thickness (m): ε = (u − behind)/thickness.
    Behind { behind: f64, thickness: f64 },
    /// The layer has this excess strain: ε = x + u/depth.
    Excess(f64),
}

impl Layer {
    /// Strain of the layer at contact displacement `u` (m), and its slope (1/m).
    fn strain(self, u: f64, depth: f64) -> (f64, f64) {
        match self {
            Self::Behind { behind, thickness } => {
                let per_thickness = 1.0 / thickness;
                ((u - behind) * per_thickness, per_thickness)
            }
            Self::Excess(excess) => (excess + u / depth, 1.0 / depth),
        }
    }

    /// Contact displacement at which the layer is free of strain, m.
    fn unstrained(self, depth: f64) -> f64 {
        match self {
            Self::Behind { behind, .. } => behind,
            Self::Excess(excess) => -excess * depth,
        }
    }
}

/// The contact displacement u (m) at which the force E ε A(u) of a specimen is `force` (N); `None` if no displacement that the
/// specimen can take carries it.
///
/// The force rises with u from zero where the layer is free of strain, so that there is one answer at most; Newton's method kept inside
/// a bracket finds it to rounding.
pub(crate) fn carried_at(specimen: &Specimen, layer: Layer, force: f64, bonded: bool) -> Option<f64> {
    let depth = specimen.depth();
    let free = layer.unstrained(depth);
    let fits = |u: &f64| specimen.check_contact_displacement(*u, bonded).is_ok();
    if force == 0.0 {
        return Some(free).filter(fits);
    }
    let excess_force = |u: f64| {
        let (strain, slope) = layer.strain(u, depth);
        let (stiffness, growth) = specimen.stiffness(u);
        (stiffness * strain - force, growth * strain + stiffness * slope)
    };
    if specimen.has_constant_section() {
        let (at_zero, slope) = excess_force(0.0);
        return Some(-at_zero / slope).filter(fits);
    }
    if force < 0.0 {
        return None;
    }
    let (mut low, mut high) = (free.max(0.0), specimen.limit().at);
    if excess_force(high).0 <= 0.0 {
        return None;
    }
    let mut u = 0.5 * (low + high);
    for _ in 0..100 {
        let (off, slope) = excess_force(u);
        if off > 0.0 {
            high = u;
        } else {
            low = u;
        }
        let newton = u - off / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - u).abs() <= f64::EPSILON * next || next <= low || next >= high {
            return Some(next);
        }
        u = next;
    }
    Some(u)
}

/// The share K of the law's rate that the excess strain keeps under a force, and Q (N/m), the stiffness against a change of force, at contact
/// displacement `u` (m): see `forced.rs`.
pub(crate) fn share(specimen: &Specimen, layers: Layers, u: f64, excess: f64) -> (f64, f64) {
    let depth = specimen.depth();
    let (stiffness, growth) = specimen.stiffness(u);
    let bend = growth * (excess + u / depth) * depth;
    let whole = bend + layers.count() * stiffness;
    // At first touch of a ball there is no area yet: the limit along the way there, with all of u on the contact layer.
    let share = if whole > 0.0 { (bend + stiffness) / whole } else { 1.0 / layers.count() };
    (share, (bend + stiffness) / depth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Shape, Sides};

    #[test]
    fn the_displacement_found_carries_the_force() {
        let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap();
        for force in [1e-12, 1e-3, 1.0, 10.0, 60.0] {
            for layer in [
                Layer::Behind {
                    behind: 0.004,
                    thickness: 0.035 / 8.0,
                },
                Layer::Excess(0.1),
                Layer::Excess(-0.05),
                Layer::Excess(0.0),
            ] {
                let u = carried_at(&ball, layer, force, false).unwrap();
                let (strain, _) = layer.strain(u, 0.035);
                let carried = ball.force(strain, u);
                // u is one of the doubles beside the place; the force between two of them is what rounding leaves.
                let between = 4.0 * f64::EPSILON * ball.stiffness(u).0;
                assert!((carried - force).abs() < 1e-12 * force + between, "{layer:?} {force}: {carried}");
            }
        }
        // E A(r) · 1 = 28 kPa · π (35 mm)² = 107.8 N
        assert!(carried_at(&ball, Layer::Excess(0.0), 107.0, false).is_some());
        assert!(carried_at(&ball, Layer::Excess(0.0), 108.0, false).is_none());
        assert!(carried_at(&ball, Layer::Excess(0.0), -1.0, true).is_none());
        assert_eq!(carried_at(&ball, Layer::Excess(-0.1), 0.0, false), Some(0.1 * 0.035));
    }

    #[test]
    fn a_strip_in_grips_carries_tension() {
        let shape = Shape::Prism {
            area: 1e-4,
            length: 0.1,
        };
        let strip = Specimen::new(shape, 1e6, Sides::One).unwrap();
        let u = carried_at(&strip, Layer::Excess(0.0), -20.0, true).unwrap();
        assert!((u + 0.02).abs() < 1e-15);
        assert!(carried_at(&strip, Layer::Excess(0.0), 120.0, false).is_none());
    }
}
