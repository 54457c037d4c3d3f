//! How the rate coefficient of the latency law depends on where the contact layer stands.

use serde::{Deserialize, Serialize};

use crate::latency::LatencyLaw;

/// How the rate coefficient v depends on the state of the contact layer.
///
/// Fitted hold by hold, v comes out different from hold to hold: it has a trend with the equilibrium strain (the paper's Table I), and
/// another level where the body was let go than where it was squeezed (Table II). Either is one more number.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RateDependence {
    /// Constant v: the law as published.
    #[default]
    Constant,
    /// On the equilibrium strain: v(ε_e) = v f^(ε_e/0.1), with v that of a body at first touch.
    Strain {
        /// f, the factor by which v changes with every 0.1 of equilibrium strain.
        factor: f64,
    },
    /// On the direction: v while the strain falls to equilibrium (x > 0, after loading), f v while it rises to it (x < 0, after unloading).
    Direction {
        /// f.
        factor: f64,
    },
}

impl RateDependence {
    /// The equilibrium strain over which v changes by the factor of [`Strain`](Self::Strain).
    pub const PER_STRAIN: f64 = 0.1;

    /// Whether its factor is a finite number above zero.
    #[must_use]
    pub fn is_sound(self) -> bool {
        match self {
            Self::Constant => true,
            Self::Strain { factor } | Self::Direction { factor } => factor.is_finite() && factor > 0.0,
        }
    }

    /// How many times v the rate coefficient is at excess strain `excess` and equilibrium strain `equilibrium`.
    ///
    /// ```
    /// use palpate::contact::RateDependence;
    /// let slower = RateDependence::Strain { factor: 0.25 };
    /// assert_eq!(slower.times(0.03, 0.05), 0.5);
    /// assert_eq!(RateDependence::Direction { factor: 3.0 }.times(-0.03, 0.05), 3.0);
    /// ```
    #[must_use]
    pub fn times(self, excess: f64, equilibrium: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Strain { factor } => factor.powf(equilibrium / Self::PER_STRAIN),
            Self::Direction { factor } => {
                if excess < 0.0 {
                    factor
                } else {
                    1.0
                }
            }
        }
    }

    /// The law there; a coefficient that would run out of the range of doubles stays at its end.
    #[must_use]
    pub fn law(self, law: LatencyLaw, excess: f64, equilibrium: f64) -> LatencyLaw {
        match self {
            Self::Constant => law,
            _ => law.times(self.times(excess, equilibrium)),
        }
    }

    /// By how much ln v changes with the equilibrium strain.
    pub(crate) fn slope(self) -> f64 {
        match self {
            Self::Strain { factor } => factor.ln() / Self::PER_STRAIN,
            Self::Constant | Self::Direction { .. } => 0.0,
        }
    }
}
