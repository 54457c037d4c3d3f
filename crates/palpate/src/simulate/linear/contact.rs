//! A contact whose layer relaxes by a linear law, and what its memory is of.

use serde::{Deserialize, Serialize};

use crate::contact::{Layer, Specimen, carried_at};
use crate::simulate::{LinearLaw, Separation};

/// What a linear law remembers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Memory {
    /// Strain: ε = ∫ G(t − s) dε_e(s), F = S(u) ε, as the latency law has it; the area is that of the moment.
    #[default]
    Strain,
    /// Force: F = ∫ G(t − s) dF_e(s) with the equilibrium force F_e(u) = S(u) u/depth, Fung's quasi-linear viscoelasticity. Of a body of
    /// constant section it is the same.
    Force,
}

/// A soft body whose contact layer relaxes by a linear law.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearContact {
    /// Shape and modulus, the relaxed one.
    pub specimen: Specimen,
    /// The law.
    pub law: LinearLaw,
    /// What it remembers.
    pub memory: Memory,
    /// Whether the jaw can pull.
    pub separation: Separation,
}

/// The quantity q that the law remembers, strain u/depth or equilibrium force F_e(u), at a contact displacement.
impl LinearContact {
    /// q at contact displacement `u` (m). Beyond first touch, where a body whose contact grows carries nothing, the equilibrium force would
    /// pull as it pushes on this side: a jaw that cannot pull is off.
    pub(super) fn value(&self, u: f64) -> f64 {
        let strain = self.specimen.equilibrium_strain(u);
        match self.memory {
            Memory::Strain => strain,
            Memory::Force if u < 0.0 && !self.specimen.has_constant_section() => -self.specimen.force(-strain, -u),
            Memory::Force => self.specimen.force(strain, u),
        }
    }

    /// dq/du, in units of q per m.
    pub(super) fn slope(&self, u: f64) -> f64 {
        let depth = self.specimen.depth();
        match self.memory {
            Memory::Strain => 1.0 / depth,
            Memory::Force => {
                let u = if self.specimen.has_constant_section() { u } else { u.abs() };
                let (stiffness, growth) = self.specimen.stiffness(u);
                (stiffness + growth * u) / depth
            }
        }
    }

    /// The contact displacement (m) at which q is `value`; `None` beyond what the body takes.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        match self.memory {
            Memory::Strain => {
                let u = value * self.specimen.depth();
                self.fits(u).then_some(u)
            }
            Memory::Force => carried_at(&self.specimen, Layer::Excess(0.0), value, self.is_bonded()),
        }
    }

    /// Force per (q + Σ x_k) at contact displacement `u` (m), and its slope.
    pub(super) fn stiffness(&self, u: f64) -> (f64, f64) {
        match self.memory {
            Memory::Strain => self.specimen.stiffness(u),
            Memory::Force => (1.0, 0.0),
        }
    }

    /// Excess strain of the contact layer at `u` (m) that stands for Σ x_k. Where there is no area yet, nothing but rounding is left of a
    /// memory of force, unless the body is bonded to the jaw.
    pub(super) fn excess_strain(&self, sum: f64, u: f64) -> f64 {
        let per = self.per_strain(u);
        if sum == 0.0 || (per == 0.0 && !self.is_bonded()) { 0.0 } else { sum / per }
    }

    /// What q + Σ x_k is of the strain of the contact layer at `u` (m): 1, or S.
    pub(super) fn per_strain(&self, u: f64) -> f64 {
        match self.memory {
            Memory::Strain => 1.0,
            Memory::Force => self.specimen.stiffness(u).0,
        }
    }

    /// The contact displacement (m) that a force (N) asks for at once, with Σ(x_k − g_k q) at `behind`.
    pub(super) fn carried(&self, force: f64, behind: f64) -> Option<f64> {
        self.carried_by(1.0 + self.law.overshoot(), force, behind)
    }

    /// The contact displacement (m) at which `whole` q + `behind` carries a force (N).
    pub(super) fn carried_by(&self, whole: f64, force: f64, behind: f64) -> Option<f64> {
        let depth = self.specimen.depth();
        match self.memory {
            // ε = whole u/depth + behind
            Memory::Strain => {
                let layer = Layer::Behind {
                    behind: -behind * depth / whole,
                    thickness: depth / whole,
                };
                carried_at(&self.specimen, layer, force, self.is_bonded())
            }
            Memory::Force => self.place((force - behind) / whole),
        }
    }

    pub(super) fn fits(&self, u: f64) -> bool {
        self.specimen.check_contact_displacement(u, self.is_bonded()).is_ok()
    }

    pub(in crate::simulate) fn is_bonded(&self) -> bool {
        self.separation == Separation::Bonded
    }
}
