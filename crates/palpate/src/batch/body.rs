//! The bodies of a group: force from excess strain and displacement.

use std::f64::consts::PI;

use super::contacts::Batch;
use super::stops::Stops;

/// What makes the force of the contacts of a group.
#[derive(Debug)]
pub(super) struct Bodies<const L: usize> {
    modulus: [f64; L],
    depth: [f64; L],
    section: [f64; L],
    round: [f64; L],
    is_round: [f64; L],
}

impl<const L: usize> Bodies<L> {
    pub(super) fn new(batch: &Batch, stops: &Stops<'_, L>) -> Self {
        Self {
            modulus: stops.column(&batch.modulus),
            depth: stops.column(&batch.depth),
            section: stops.column(&batch.section),
            round: stops.column(&batch.round),
            is_round: stops.column(&batch.is_round),
        }
    }

    /// F = E (x + u/depth) A(u) in N, equation (11), from excess strains and contact displacements (m).
    #[inline(always)]
    pub(super) fn forces(&self, excess: &[f64; L], u: &[f64; L]) -> [f64; L] {
        let mut force = [0.0; L];
        for lane in 0..L {
            let indentation = if u[lane] > 0.0 { u[lane] } else { 0.0 };
            let round = PI * indentation * (self.round[lane] - indentation);
            let area = self.section[lane] + self.is_round[lane] * round;
            force[lane] = self.modulus[lane] * (excess[lane] + u[lane] / self.depth[lane]) * area;
        }
        force
    }
}
