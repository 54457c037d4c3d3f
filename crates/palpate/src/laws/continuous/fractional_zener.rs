//! The fractional Zener solid: a spring beside a spring and a springpot in series.
//!
//! y(t) = y_e + Δ E_α(−(t/τ)^α), E_α the Mittag-Leffler function; in creep y₀ + Δ (1 − E_α(−(t/τ)^α)).
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | equilibrium y_e, or instantaneous y₀ | of y | any | end, or start in creep |
//! | amplitude Δ | of y | any | what relaxes |
//! | time τ | s | above 0 | between the two powers, t^α before and t^(−α) after |
//! | order α | 1 | 0.05 to 1 | 1: standard linear solid |

use crate::laws::{BasisFunction, Composition, Description, Kernel, LawDefinition, ShapeParameter, TIME, two};
use crate::special::{mittag_leffler_decay_many, mittag_leffler_decay_value_many};

const FORM: Composition = Composition::with_constant(&[BasisFunction::MittagLeffler]);

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "fractional-zener",
    description: Description {
        title: "fractional Zener",
        equation: "y_e + Δ E_α(−(t/τ)^α)",
        source: "Bagley and Torvik 1983; Mainardi, Fractional Calculus and Waves in Linear Viscoelasticity, chapter 3",
    },
    relaxation: Some(FORM),
    creep: Some(FORM),
    contains_exponential: true,
};

/// E_α(−(λt)^α).
pub(in crate::laws) struct MittagLeffler;

impl Kernel for MittagLeffler {
    fn parameters(&self) -> &'static [ShapeParameter] {
        const COARSE: [f64; 10] = [0.05, 0.1, 0.18, 0.27, 0.38, 0.5, 0.63, 0.77, 0.9, 1.0];
        const { &[TIME, ShapeParameter::pure("order", 0.05, 1.0, &COARSE)] }
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        mittag_leffler_decay_value_many(times, theta[0].exp(), theta[1], value);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        let [by_rate, by_order] = two(derivatives);
        mittag_leffler_decay_many(times, theta[0].exp(), theta[1], value, by_rate, by_order);
    }
}
