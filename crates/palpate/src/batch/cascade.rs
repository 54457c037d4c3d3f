//! All layers of a group of contacts, through a stretch in which every jaw keeps its speed.
//!
//! In units of the depth, w = u/depth, with m layers and 1 − (i − 1)/m of the depth behind node i:
//!
//! ẇᵢ₊₁ = (v/m) sgn(xᵢ)|xᵢ|ⁿ,  xᵢ = m (wᵢ − wᵢ₊₁) − wᵢ/(1 − (i − 1)/m),  w₁ imposed, w_{m+1} = 0.
//!
//! Steps follow the fastest layer of each contact. In a hold that slows down as 1/t, so that steps grow with the time since the ramp.

use fearless_simd::Simd;

use crate::latency::lanes::{BLOCK, Power, block, by_power, each, signed_power};
use crate::ode::Lanes;

/// Contacts that go through together; their layers are vectors enough.
pub(super) const GROUP: usize = BLOCK;

/// Most relaxation times of a layer near rest that a motion may last, for n < 1: as for the strain wave.
const STIFFEST: f64 = 1e5;

/// What the layers of a group are made of.
#[derive(Debug)]
pub(super) struct Stack {
    pub(super) power: Power,
    exponent: [f64; GROUP],
    layers: [f64; GROUP],
    /// Excess strain below which the law is taken as linear; zero for n ≥ 1.
    rest: [f64; GROUP],
    /// v/m of layer i in lane l at `i * GROUP + l`; 0 where a contact has no such node.
    rate: Vec<f64>,
    /// 1/(1 − i/m), depth over what is left of it behind the node.
    over_left: Vec<f64>,
}

impl Stack {
    /// Layers of contacts with these exponents, rate coefficients (1/s), numbers of layers and durations (s) of their motions.
    pub(super) fn new(
        exponent: [f64; GROUP],
        rate_coefficient: [f64; GROUP],
        layers: [f64; GROUP],
        duration: [f64; GROUP],
    ) -> Self {
        let nodes = layers.iter().fold(1.0, |most: f64, m| most.max(*m)) as usize - 1;
        let (mut rate, mut over_left) = (vec![0.0; nodes * GROUP], vec![0.0; nodes * GROUP]);
        let mut rest = [0.0; GROUP];
        for lane in 0..GROUP {
            let (n, v, m) = (exponent[lane], rate_coefficient[lane], layers[lane]);
            if n < 1.0 {
                rest[lane] = (STIFFEST / (v * duration[lane])).powf(1.0 / (n - 1.0)).clamp(1e-12, 1e-5);
            }
            for node in 0..m as usize - 1 {
                rate[node * GROUP + lane] = v / m;
                over_left[node * GROUP + lane] = m / (m - node as f64);
            }
        }
        Self {
            power: Power::of(&exponent),
            exponent,
            layers,
            rest,
            rate,
            over_left,
        }
    }

    /// Nodes behind the surface of the contact with the most layers.
    pub(super) fn nodes(&self) -> usize {
        self.rate.len() / GROUP
    }

    /// ẇ₂ … of every lane with the surfaces at `surface`.
    #[inline(always)]
    fn speeds(&self, surface: &[f64; GROUP], nodes: &[f64], out: &mut [f64]) {
        by_power!(self.power, power => {
            let mut outer = *surface;
            let (layers, exponent, rest) = (self.layers, self.exponent, self.rest);
            let all = nodes.chunks_exact(GROUP).zip(out.chunks_exact_mut(GROUP));
            let known = self.rate.chunks_exact(GROUP).zip(self.over_left.chunks_exact(GROUP));
            for ((inner, out), (rate, over_left)) in all.zip(known) {
                let (inner, rate, over_left) = (block(inner, 0), block(rate, 0), block(over_left, 0));
                let speeds = each(
                    #[inline(always)]
                    |lane| {
                        let excess = layers[lane] * (outer[lane] - inner[lane]) - outer[lane] * over_left[lane];
                        rate[lane] * signed_power(power, excess, exponent[lane], rest[lane])
                    },
                );
                out.copy_from_slice(&speeds);
                outer = inner;
            }
        });
    }
}

/// The layers of a group on their way.
#[derive(Debug)]
pub(super) struct Cascade {
    nodes: Lanes<GROUP>,
}

impl Cascade {
    /// Relaxed layers with the surface at `surface`, followed to within `tolerance` a step (both in units of the depth).
    pub(super) fn new(stack: &Stack, tolerance: [f64; GROUP], surface: [f64; GROUP]) -> Self {
        let mut nodes = Lanes::new(stack.nodes());
        let all = nodes.state.chunks_exact_mut(GROUP).zip(stack.over_left.chunks_exact(GROUP)).enumerate();
        for (node, (all, over_left)) in all {
            for lane in 0..GROUP {
                // 1 − i/m of the travel of the surface; the node behind layer i has i layers before it.
                let left = 1.0 - (node as f64 + 1.0) / stack.layers[lane];
                all[lane] = if over_left[lane] > 0.0 { surface[lane] * left } else { 0.0 };
            }
        }
        nodes.tolerance = tolerance;
        Self { nodes }
    }

    /// Displacements of the nodes behind the surface over the depth, node by node.
    pub(super) fn nodes(&self) -> &[f64] {
        &self.nodes.state
    }

    /// Goes on for `elapsed` (s) with the surfaces going from `surface` at `speed` (1/s), both over the depth. `width` are first steps (s),
    /// a new piece of motion having begun.
    #[inline(always)]
    pub(super) fn advance<S: Simd>(
        &mut self,
        simd: S,
        stack: &Stack,
        (surface, speed): (&[f64; GROUP], &[f64; GROUP]),
        elapsed: &[f64; GROUP],
        width: [f64; GROUP],
    ) {
        self.nodes.restart(width);
        while (0..GROUP).any(|lane| self.nodes.time[lane] < elapsed[lane]) {
            self.nodes.step(
                simd,
                elapsed,
                #[inline(always)]
                |time, nodes, out| {
                    let mut now = [0.0; GROUP];
                    for lane in 0..GROUP {
                        now[lane] = surface[lane] + speed[lane] * time[lane];
                    }
                    stack.speeds(&now, nodes, out);
                },
            );
        }
    }

    /// Width of the next step of every lane, s.
    pub(super) fn width(&self) -> [f64; GROUP] {
        self.nodes.width
    }
}
