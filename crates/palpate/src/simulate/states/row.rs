//! Blocks of closed contacts one after the other, three of them under way at a time.
//!
//! A root of a root and a quotient take most of the time of a step of n = 5, each behind the other. A processor finds other work meanwhile within
//! a few hundred instructions, and those of a block are so many that it does not see the next but one: here it stands beside.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdMask, f64x8, mask64x8};

use super::block::{Block, FARTHEST};
use super::lanes::Lanes;
use crate::latency::lanes::Power;

/// Whether a decay with this power is a root, whose steps can be three under way.
pub(super) fn is_root(power: Power) -> bool {
    matches!(power, Power::Two | Power::Three | Power::Five)
}

/// Contacts on their way to `to`.
#[derive(Clone, Copy)]
struct Pressed<S: Simd> {
    to: f64x8<S>,
    /// Half of the excess strain that the step brings.
    kick: f64x8<S>,
    /// The excess strain after the first half of it, and what it is divided by, as yet without the roots of it.
    excess: f64x8<S>,
    decay: f64x8<S>,
    is_right: mask64x8<S>,
}

impl<S: Simd> Pressed<S> {
    /// With the first of two roots, or the second.
    #[inline(always)]
    fn rooted(self, power: Power, is_first: bool) -> Self {
        let is_taken = match power {
            Power::Five => true,
            Power::Three => is_first,
            _ => false,
        };
        let decay = if is_taken { self.decay.sqrt() } else { self.decay };
        Self { decay, ..self }
    }
}

/// Lanes as a vector.
#[derive(Clone, Copy)]
struct Loader<S: Simd>(S);

impl<S: Simd> Loader<S> {
    #[inline(always)]
    fn load(self, lanes: &Lanes) -> f64x8<S> {
        f64x8::from_slice(self.0, lanes)
    }
}

impl Block {
    /// Steps blocks one after the other as long as all of their contacts stay in contact and have this power, a [root](is_root); returns how many.
    ///
    /// To the last bit what [`moved_in_row`](Self::moved_in_row) does with steps of one part.
    #[inline(always)]
    pub(super) fn pressed_in_row<'a, S: Simd>(
        simd: S,
        block: impl Fn(usize) -> &'a Self,
        power: Power,
        (jaws, behinds, forces): (&mut [Lanes], &mut [Lanes], &mut [Lanes]),
        step: impl Fn(usize) -> (Lanes, Lanes),
    ) -> usize {
        let count = jaws.len().min(behinds.len()).min(forces.len());
        let (jaws, behinds, forces) = (&mut jaws[..count], &mut behinds[..count], &mut forces[..count]);
        let one = f64x8::splat(simd, 1.0);
        let none = Pressed {
            to: one,
            kick: one,
            excess: one,
            decay: one,
            is_right: one.simd_eq(one),
        };
        let (mut first, mut second) = (none, none);
        for index in 0..count + 2 {
            let ready = second.rooted(power, false);
            second = first.rooted(power, true);
            if index < count {
                let block = block(index);
                first = block.begun(simd, power, (&jaws[index], &behinds[index]), step(index));
                if block.power != power {
                    first.is_right = one.simd_lt(one);
                }
            }
            if index >= 2 {
                let place = index - 2;
                let (behind, force, is_right) = block(place).ended(simd, &ready);
                if !is_right {
                    return place;
                }
                ready.to.store_slice(&mut jaws[place]);
                behind.store_slice(&mut behinds[place]);
                force.store_slice(&mut forces[place]);
            }
        }
        count
    }

    /// The part of a step before the roots.
    #[inline(always)]
    fn begun<S: Simd>(
        &self,
        simd: S,
        power: Power,
        (jaw, behind): (&Lanes, &Lanes),
        (dt, to): (Lanes, Lanes),
    ) -> Pressed<S> {
        let of = Loader(simd);
        let (bodies, dt) = (&self.bodies, of.load(&dt));
        let (u, from) = (of.load(&to) * of.load(&bodies.share), of.load(jaw));
        let kick = (u - from) * of.load(&self.half_drive);
        let gap = from - of.load(behind);
        let excess = gap * of.load(&self.per_thickness) - from * of.load(&bodies.per_depth) + kick;
        let square = excess * excess;
        let a = match power {
            Power::Two => excess.abs(),
            Power::Three => square,
            _ => square * square,
        };
        // A state beyond all measure has an excess strain beyond it, unless both of its numbers hide that from each other.
        let is_near = square.simd_lt(f64x8::splat(simd, FARTHEST * FARTHEST));
        let fits = u.simd_lt(of.load(&bodies.limit)) & u.simd_ge(of.load(&bodies.lowest));
        let is_step = dt.simd_ge(f64x8::splat(simd, 0.0)) & dt.simd_le(f64x8::splat(simd, f64::MAX));
        Pressed {
            to: u,
            kick,
            excess,
            decay: of.load(&self.rate) * a * dt + 1.0,
            is_right: gap.simd_ge(of.load(&bodies.slack)) & is_near & fits & is_step,
        }
    }

    /// The part behind them: displacements of the nodes (m), forces (N), and whether all contacts were closed all along.
    #[inline(always)]
    fn ended<S: Simd>(&self, simd: S, begun: &Pressed<S>) -> (f64x8<S>, f64x8<S>, bool) {
        let of = Loader(simd);
        let (bodies, u) = (&self.bodies, begun.to);
        let excess = begun.excess / begun.decay + begun.kick;
        let node = u - of.load(&self.thickness) * (excess + u * of.load(&bodies.per_depth));
        let gap = u - node;
        let is_right = begun.is_right & gap.simd_ge(of.load(&bodies.slack));
        let (none, diameter) = (f64x8::splat(simd, 0.0), of.load(&bodies.diameter));
        let inside = u.simd_gt(none).select(u, none);
        let round = inside * std::f64::consts::PI * (diameter - inside);
        let area = diameter.simd_gt(none).select(round, of.load(&bodies.section));
        let force = of.load(&bodies.modulus) * (gap * of.load(&self.per_thickness)) * area;
        (node, force, is_right.all_true())
    }
}
