//! Layers that go through the integrator side by side.
//!
//! Those that the wave has not reached yet are left out.

use std::ops::Range;

use fearless_simd::{Simd, SimdBase, f64x8};

use super::path::{Knot, Path};
use crate::latency::lanes::{Power, block, by_power, each, signed_power};
use crate::ode::{Column, Slopes, WIDTH};
use crate::simulate::{ContactModel, Latency, SimulationWork, Stretch, StretchState};
use crate::vector::Aligned;

/// Nodes in a tile: enough to keep vectors busy, few enough to share a step and to stay in the nearest cache.
pub(super) const TILE: usize = 128;

/// Most relaxation times of a layer near rest that a motion may last, for n < 1.
///
/// There the rate has no derivative at x = 0, where layers come to rest in finite time, and an explicit method would shrink
/// its steps to nothing. The law made linear below `rest` follows the same path to within `rest`.
const STIFFEST: f64 = 1e5;

/// Most steps through one stretch: a second for a few layers. A law so fast that it takes more is out of reach of an explicit method.
const MOST_STEPS: u64 = 300_000;

/// Steps times the rate n v |x|ⁿ⁻¹ at which the fastest layer takes up a disturbance. From 3 on disturbances grow on their way from layer to
/// layer, which the error of a step tells too late: it wavers between far too small and too large, and the layers behind see the waves.
const STABLE: f64 = 2.6;

/// Part of the tolerance that nodes not reached yet may move in all.
const UNSEEN: f64 = 1e-6;

/// What all nodes have in common.
pub(super) struct Chain {
    power: Power,
    exponent: f64,
    /// ℓ, m.
    pub(super) thickness: f64,
    /// ℓ v, m/s.
    speed: f64,
    /// Excess strain below which the law is taken as linear; zero for n ≥ 1.
    rest: f64,
    /// Displacement below which a node moves the one behind it by nothing that matters, m.
    still: f64,
    /// Largest error of a step, m, over all nodes.
    tolerance: f64,
    nodes: usize,
}

impl Chain {
    /// For `nodes` nodes that are followed for `duration` (s), with an error of `tolerance` (m) a step.
    pub(super) fn new(model: &ContactModel, nodes: usize, tolerance: f64, duration: f64) -> Self {
        let (n, v) = (model.law.exponent(), model.law.rate_coefficient());
        let thickness = model.layers.thickness(model.specimen.depth());
        Self {
            power: Power::of(&[n]),
            exponent: n,
            thickness,
            speed: thickness * v,
            rest: if n < 1.0 { (STIFFEST / (v * duration)).powf(1.0 / (n - 1.0)).clamp(1e-12, 1e-5) } else { 0.0 },
            still: thickness * (UNSEEN * tolerance / (thickness * v * duration)).powf(1.0 / n),
            tolerance,
            nodes,
        }
    }

    /// The longest step that keeps small disturbances of layers of at most this excess strain from growing, s.
    ///
    /// For n < 1 they die out fastest where the strain is least, and it is left to the error of a step to tell.
    fn longest_step(&self, excess: f64) -> f64 {
        let n = self.exponent;
        if n < 1.0 {
            f64::INFINITY
        } else {
            STABLE / (n * (self.speed / self.thickness) * excess.powf(n - 1.0))
        }
    }
}

/// What moves the first node of a tile.
pub(super) enum Outer<'a, 'm> {
    /// The surface.
    Surface(&'a Stretch<Latency<'m>>),
    /// The last node of the tile before.
    Node(Path),
}

/// Nodes next to each other.
pub(super) struct Tile {
    nodes: Column,
    is_innermost: bool,
    /// 1/Lᵢ of the layer that moves node i, 1/m; 0 behind the last node.
    over_left: Aligned,
    /// 1 for a node, 0 behind the last one.
    is_node: Aligned,
}

impl Tile {
    /// The nodes of `range`, relaxed with the surface at `surface` (m).
    pub(super) fn new(model: &ContactModel, range: Range<usize>, surface: f64, chain: &Chain) -> Self {
        let (depth, count) = (model.specimen.depth(), range.len());
        let column = |of: &dyn Fn(f64) -> f64| {
            let mut column = Aligned::zeros(count.next_multiple_of(WIDTH));
            column.iter_mut().zip(range.clone()).for_each(|(slot, node)| *slot = of(node as f64));
            column
        };
        let mut nodes = Column::new(count, chain.nodes, chain.tolerance);
        if surface != 0.0 {
            let layers = (chain.nodes + 1) as f64;
            nodes.start_at(range.clone().map(|node| surface * (1.0 - (node + 1) as f64 / layers)));
        }
        Self {
            nodes,
            is_innermost: range.end == chain.nodes,
            over_left: column(&|node| 1.0 / (depth - node * chain.thickness)),
            is_node: column(&|_| 1.0),
        }
    }

    /// Takes the nodes through a stretch, appending where they are at the times `elapsed` to `columns`; returns the way of the last one. How far
    /// it came (s) if that takes too many steps.
    #[inline(always)]
    pub(super) fn pass<S: Simd>(
        &mut self,
        simd: S,
        chain: &Chain,
        outer: &Outer<'_, '_>,
        (duration, elapsed): (f64, &[f64]),
        columns: &mut [Vec<f64>],
        work: &mut SimulationWork,
    ) -> Result<Path, f64> {
        let nodes = &mut self.nodes;
        let along = Along {
            chain,
            outer,
            over_left: &self.over_left,
            is_node: &self.is_node,
        };
        let (steps, evaluations) = (nodes.steps, nodes.evaluations);
        let (mut knots, mut next, mut inside) = (Vec::new(), 0, Vec::new());
        let before = nodes.numbers().last().copied().unwrap_or(0.0);
        nodes.restart(duration / 64.0);
        while outer.moves() && nodes.time < duration {
            if nodes.steps - steps == MOST_STEPS {
                return Err(nodes.time);
            }
            nodes.cap(chain.longest_step(along.steepest(simd, nodes)));
            nodes.step(simd, duration, &along);
            if nodes.is_valid() && !self.is_innermost {
                let ends = nodes.ends_of_last().map(|(time, value, slope)| Knot { time, value, slope });
                knots.extend_from_slice(if knots.is_empty() { &ends } else { &ends[1..] });
            }
            let mut looked = false;
            while let Some(&time) = elapsed.get(next).filter(|time| **time <= nodes.time) {
                if time == nodes.time {
                    inside.clear();
                    inside.extend_from_slice(nodes.numbers());
                } else {
                    if !looked {
                        nodes.look(simd, &along);
                        looked = true;
                    }
                    nodes.at(simd, time, &mut inside);
                }
                columns.iter_mut().zip(&inside).for_each(|(column, number)| column.push(*number));
                next += 1;
            }
            nodes.leave();
        }
        // A tile that nothing moves stays where it is.
        for (column, number) in columns.iter_mut().zip(nodes.numbers()) {
            column.resize(column.len() + elapsed.len() - next, *number);
        }
        work.steps += nodes.steps - steps;
        work.evaluations += nodes.evaluations - evaluations;
        Ok(Path::new(before, knots))
    }
}

impl Outer<'_, '_> {
    fn moves(&self) -> bool {
        match self {
            Self::Surface(_) => true,
            Self::Node(path) => path.moves(),
        }
    }
}

/// The nodes of a tile along one stretch.
struct Along<'a, 'm> {
    chain: &'a Chain,
    outer: &'a Outer<'a, 'm>,
    over_left: &'a [f64],
    is_node: &'a [f64],
}

impl Along<'_, '_> {
    /// Largest excess strain of the nodes that are followed.
    #[inline(always)]
    fn steepest<S: Simd>(&self, simd: S, nodes: &Column) -> f64 {
        let mut most = f64x8::splat(simd, 0.0);
        nodes.scan(
            simd,
            |first| self.mover(nodes.time, first),
            #[inline(always)]
            |at, outer, inner| {
                // Behind the last node there is no layer.
                let is_node = f64x8::from_slice(simd, &self.is_node[at..at + WIDTH]);
                most = most.max((self.excess(simd, at, outer, inner) * is_node).abs());
            },
        );
        let most: [f64; WIDTH] = most.into();
        most.into_iter().fold(0.0, f64::max)
    }

    /// Displacement of what moves the first node, m; `first` is that of the node.
    fn mover(&self, time: f64, first: f64) -> f64 {
        match self.outer {
            Outer::Surface(stretch) => surface(stretch, time, first),
            Outer::Node(path) => path.at(time),
        }
    }

    /// xᵢ = (uᵢ − uᵢ₊₁)/ℓ − uᵢ/Lᵢ
    #[inline(always)]
    fn excess<S: Simd>(&self, simd: S, at: usize, outer: f64x8<S>, inner: f64x8<S>) -> f64x8<S> {
        let over_left = f64x8::from_slice(simd, &self.over_left[at..at + WIDTH]);
        (outer - inner) * f64x8::splat(simd, 1.0 / self.chain.thickness) - outer * over_left
    }
}

impl<S: Simd> Slopes<S> for Along<'_, '_> {
    fn input(&self, time: f64, first: f64) -> f64 {
        self.mover(time, first)
    }

    /// u̇₂ … u̇_m.
    ///
    /// Without a jaw the surface is the first inner node: no stress in the outermost layer, its excess is −u/depth.
    #[inline(always)]
    fn of(&self, simd: S, at: usize, outer: f64x8<S>, inner: f64x8<S>) -> f64x8<S> {
        let excess: [f64; WIDTH] = self.excess(simd, at, outer, inner).into();
        let (is_node, speed) = (block(self.is_node, at), self.chain.speed);
        let (n, rest) = (self.chain.exponent, self.chain.rest);
        let slopes = by_power!(self.chain.power, power => each(
            #[inline(always)]
            |lane| is_node[lane] * speed * signed_power(power, excess[lane], n, rest),
        ));
        f64x8::from_slice(simd, &slopes)
    }

    #[inline(always)]
    fn passes_on(&self, last: f64) -> bool {
        last.abs() > self.chain.still
    }
}

/// Displacement of the surface: the jaw's share while it touches, the first inner node once it is free of stress.
pub(super) fn surface(stretch: &Stretch<Latency<'_>>, elapsed: f64, first: f64) -> f64 {
    match stretch.state {
        StretchState::Touching(_) | StretchState::Forced(_) => stretch.jaw_at(stretch.start + elapsed),
        StretchState::Free { .. } => first,
    }
}
