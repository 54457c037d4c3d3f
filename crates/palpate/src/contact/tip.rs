//! Rigid tips of indenters, pressed into a flat sample: a half space, or a layer on a rigid base.

use core::f64::consts::PI;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;
use serde::{Deserialize, Serialize};

/// A rigid, frictionless tip. Its force on an elastic half space is F = E/(1 − ν²) C uᵖ with u the indentation.
///
/// A is the projected contact area, π a² with the contact radius a = F′(u) (1 − ν²)/(2 E), which holds for every frictionless body of
/// revolution (Pharr, Oliver and Brotzen, J. Mater. Res. 7, 1992): √(R u), 2/π u tan α, and the radius of a punch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "alloc",
    derive(Serialize, Deserialize),
    serde(rename_all = "snake_case", tag = "kind")
)]
pub enum Tip {
    /// A sphere: F = 4/3 E/(1 − ν²) √R u^(3/2) (Hertz 1881, a paraboloid). Sneddon's exact force of a sphere (Int. J. Engng Sci. 3, 1965) is
    /// 1 % lower at u = R/10 and 5 % at R/2.
    Sphere {
        /// Radius R in m.
        radius: f64,
    },
    /// A cone: F = 2/π E/(1 − ν²) tan α u² (Sneddon 1965). For u well above the radius of the apex.
    Cone {
        /// Half angle α in rad, between axis and surface; above 0 and below π/2.
        half_angle: f64,
    },
    /// A regular four-sided pyramid: F = 0.7453 E/(1 − ν²) tan α u² (Bilodeau, J. Appl. Mech. 59, 1992, an approximation); π a² approximates
    /// its contact area. For u well above the radius of the apex.
    Pyramid {
        /// Half angle α in rad, between axis and face; above 0 and below π/2.
        half_angle: f64,
    },
    /// The flat end of a cylinder: F = 2 E/(1 − ν²) R u (Sneddon 1965).
    Punch {
        /// Radius R in m.
        radius: f64,
    },
}

/// How the far side of a layer meets its rigid base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Base {
    /// It adheres: cells on glass, a gel that was cast on its dish, cartilage on bone.
    #[default]
    Bonded,
    /// It slides without friction.
    Sliding,
}

/// The sample under a tip, where it is not a half space.
///
/// A base makes the layer stiffer than a half space by the factor c(τ) = 1 + c₁ τ + c₂ τ² + c₃ τ³ + c₄ τ⁴ of the ratio τ = a/h of the contact
/// radius on a half space to the thickness. The coefficients follow from the power p of the tip and two moments of the kernel of the layer
/// (Hayes et al., J. Biomech. 5, 1972; Dimitriadis et al., Biophys. J. 82, 2002: k₀ = −α₀, k₂ = 4 β₀):
///
/// ```text
/// k_j = ∫ w^j (1 − L(w)) dw,  e = 2 k₀/(π p),  g = k₂/(3π) (4p − 2)/(3p − 2)
/// c₁ = p e,  c₂ = p (3p − 1)/2 e²,  c₃ = C(4p, 3)/4 e³ − g,  c₄ = C(5p, 4)/5 e⁴ − (5p − 3) g e
/// ```
///
/// with C(x, n) the binomial coefficient. c₁ to c₃ are those of a paraboloid, a cone and a punch of Garcia and Garcia (Biophys. J. 114, 2018)
/// for ν = 1/2, the cone after Gavara and Chadwick (Nat. Nanotechnol. 7, 2012). A pyramid takes those of a cone.
/// For τ up to 1/2 the factor is within 2 % of the exact one (the integral equation of the layer, `validation/tips.py`); deeper is refused.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ThinLayer {
    /// Thickness h in m.
    pub thickness: f64,
    /// How it meets its base.
    pub base: Base,
}

/// Largest ratio of contact radius to thickness: half of it, where the contact is as wide as the layer is thick.
const WIDEST: f64 = 0.5;

/// (1 − ν) k₀ and (1 − ν) k₂ of a bonded layer by powers of ν: fits to their integrals, within 0.1 %.
const BONDED: [[f64; 5]; 2] =
    [[1.21123, -0.99269, 0.56581, -0.39998, 1.25598], [1.87973, -0.83742, 1.73459, -2.81338, 5.93585]];

/// k₀ and k₂ of a layer that slides on its base, whatever ν.
const SLIDING: [f64; 2] = [1.16758, 1.58153];

impl Tip {
    /// C (m^(2 − p)) and p.
    pub(super) fn power(self) -> (f64, f64) {
        match self {
            Self::Sphere { radius } => (4.0 / 3.0 * radius.sqrt(), 1.5),
            Self::Cone { half_angle } => (2.0 / PI * half_angle.tan(), 2.0),
            Self::Pyramid { half_angle } => (0.7453 * half_angle.tan(), 2.0),
            Self::Punch { radius } => (2.0 * radius, 1.0),
        }
    }

    /// Its own length, m; a cone and a pyramid look the same at any depth and have none.
    pub(super) fn length(self) -> Option<f64> {
        match self {
            Self::Sphere { radius } | Self::Punch { radius } => Some(radius),
            Self::Cone { .. } | Self::Pyramid { .. } => None,
        }
    }

    /// Projected contact area A in m² and its slope dA/du in m at indentation `u` (m).
    pub(super) fn area(self, u: f64) -> (f64, f64) {
        let (coefficient, p) = self.power();
        power(PI * (0.5 * p * coefficient).powi(2), 2.0 * (p - 1.0), u)
    }

    /// (1 − ν²) F/(E u) in m and its slope at indentation `u` (m) of a half space, or of `layer`.
    pub(super) fn stiffness(self, layer: Option<&ThinLayer>, poisson_ratio: f64, u: f64) -> (f64, f64) {
        let (coefficient, p) = self.power();
        let (force, growth) = power(coefficient, p - 1.0, u);
        let Some(layer) = layer else {
            return (force, growth);
        };
        let (ratio, widening) = power(0.5 * p * coefficient / layer.thickness, p - 1.0, u);
        let (factor, stiffening) = layer.factor(p, poisson_ratio, ratio);
        (force * factor, growth * factor + force * stiffening * widening)
    }

    /// The deepest indentation (m) for which the factor of a layer is known; infinite for a punch that is narrow enough, 0 for one that is not.
    pub(super) fn deepest(self, layer: &ThinLayer) -> f64 {
        let (coefficient, p) = self.power();
        // a/h of an indentation of 1 m.
        let ratio = 0.5 * p * coefficient / layer.thickness;
        if p > 1.0 {
            (WIDEST / ratio).powf(1.0 / (p - 1.0))
        } else if ratio <= WIDEST {
            f64::INFINITY
        } else {
            0.0
        }
    }

    /// c in M = c μ N a, the torsion at which a contact of radius a slips all over: π/4 for a punch, and that of the punches as which a
    /// growing contact builds up, whose radius goes with the force like F^((p − 1)/p).
    #[cfg(feature = "std")]
    pub(crate) fn torsional_share(self) -> f64 {
        let (_, p) = self.power();
        core::f64::consts::FRAC_PI_4 * p / (2.0 * p - 1.0)
    }
}

impl Base {
    /// k₀ and k₂.
    fn moments(self, poisson_ratio: f64) -> [f64; 2] {
        let sum =
            |by_power: [f64; 5]| by_power.iter().rev().fold(0.0, |sum, coefficient| sum * poisson_ratio + coefficient);
        match self {
            Self::Bonded => BONDED.map(|by_power| sum(by_power) / (1.0 - poisson_ratio)),
            Self::Sliding => SLIDING,
        }
    }
}

impl ThinLayer {
    /// c and dc/dτ for a tip of power `p` at τ = `ratio`.
    fn factor(&self, p: f64, poisson_ratio: f64, ratio: f64) -> (f64, f64) {
        let [k0, k2] = self.base.moments(poisson_ratio);
        let (e, g) = (2.0 * k0 / (PI * p), k2 / (3.0 * PI) * (4.0 * p - 2.0) / (3.0 * p - 2.0));
        let coefficients = [
            1.0,
            p * e,
            binomial(3.0 * p, 2) / 3.0 * e.powi(2),
            binomial(4.0 * p, 3) / 4.0 * e.powi(3) - g,
            binomial(5.0 * p, 4) / 5.0 * e.powi(4) - (5.0 * p - 3.0) * g * e,
        ];
        coefficients
            .iter()
            .rev()
            .fold((0.0, 0.0), |(value, slope), coefficient| (value * ratio + coefficient, slope * ratio + value))
    }
}

/// scale · u^exponent and its slope; nothing before first touch, unless it is a constant. Where the slope has no bound, right at first
/// touch, it counts as 0: there is no force yet either.
fn power(scale: f64, exponent: f64, u: f64) -> (f64, f64) {
    if exponent <= 0.0 {
        return (scale, 0.0);
    }
    if u > 0.0 {
        // A square root is rounded the same everywhere, a power is not.
        let value = scale * if exponent == 0.5 { u.sqrt() } else { u.powf(exponent) };
        return (value, exponent * value / u);
    }
    let is_straight = u >= 0.0 && (1.0..2.0).contains(&exponent);
    (0.0, if is_straight { scale } else { 0.0 })
}

/// x (x − 1) … (x − n + 1)/n!
fn binomial(x: f64, n: u8) -> f64 {
    (0..n).map(f64::from).fold(1.0, |product, i| product * (x - i) / (i + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(thickness: f64, base: Base) -> ThinLayer {
        ThinLayer { thickness, base }
    }

    /// Garcia and Garcia (2018), equations for ν = 1/2 on a rigid base, in τ of the radius on a half space; their moments are those of
    /// Dimitriadis et al., half a percent above the integrals.
    #[test]
    fn factors_are_the_published_ones() {
        let per_cone = core::f64::consts::FRAC_PI_2;
        let published = [
            (1.5, [1.133, 1.497, 1.469]),
            (2.0, [0.721 * per_cone, 0.650 * per_cone.powi(2), 0.491 * per_cone.powi(3)]),
            (1.0, [1.133, 1.283, 0.598]),
        ];
        for (p, [c1, c2, c3]) in published {
            for ratio in [0.01, 0.05, 0.1] {
                let expected = 1.0 + ratio * (c1 + ratio * (c2 + ratio * c3));
                let found = layer(1.0, Base::Bonded).factor(p, 0.5, ratio).0;
                assert!((found / expected - 1.0).abs() < 0.006, "{p}, {ratio}: {found}, {expected}");
            }
        }
    }

    #[test]
    fn moments_are_the_integrals_of_the_kernel() {
        #[derive(Deserialize)]
        struct Reference {
            moments: Vec<(Base, f64, f64, f64)>,
        }
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/reference/tips.json");
        let reference: Reference = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        assert_eq!(reference.moments.len(), 22);
        for (base, poisson_ratio, k0, k2) in reference.moments {
            let [found_k0, found_k2] = base.moments(poisson_ratio);
            assert!(
                (found_k0 / k0 - 1.0).abs() < 1e-3 && (found_k2 / k2 - 1.0).abs() < 1e-3,
                "{base:?} {poisson_ratio}"
            );
        }
    }

    #[test]
    fn slopes_are_those_of_the_values() {
        let tips = [
            Tip::Sphere { radius: 5e-6 },
            Tip::Cone { half_angle: 0.6 },
            Tip::Pyramid { half_angle: 0.3 },
            Tip::Punch { radius: 2e-6 },
        ];
        for tip in tips {
            for (layer, poisson_ratio) in
                [(None, 0.5), (Some(layer(6e-6, Base::Bonded)), 0.5), (Some(layer(6e-6, Base::Sliding)), 0.3)]
            {
                for u in [1e-8, 3e-7, 1e-6] {
                    let step = 1e-5 * u;
                    let stiffness = |u| tip.stiffness(layer.as_ref(), poisson_ratio, u);
                    let slope = (stiffness(u + step).0 - stiffness(u - step).0) / (2.0 * step);
                    assert!((stiffness(u).1 - slope).abs() < 1e-6 * stiffness(u).0 / u, "{tip:?} {layer:?}");
                    let slope = (tip.area(u + step).0 - tip.area(u - step).0) / (2.0 * step);
                    assert!((tip.area(u).1 - slope).abs() < 1e-6 * tip.area(u).0 / u, "{tip:?}");
                }
            }
        }
    }

    #[test]
    fn the_range_ends_where_the_contact_is_as_wide_as_the_layer_is_thick() {
        let thin = layer(6e-6, Base::Bonded);
        for tip in [Tip::Sphere { radius: 5e-6 }, Tip::Cone { half_angle: 0.6 }] {
            let (area, _) = tip.area(tip.deepest(&thin));
            assert!(((area / PI).sqrt() / 3e-6 - 1.0).abs() < 1e-12);
        }
        assert_eq!(Tip::Punch { radius: 2.9e-6 }.deepest(&thin), f64::INFINITY);
        assert_eq!(Tip::Punch { radius: 3.1e-6 }.deepest(&thin), 0.0);
    }
}
